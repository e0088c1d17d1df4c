"""A rule set as a LaTeX table in the form of the paper's Tables 1 and 2.

The document compiles as it is; a paper takes what stands from `table` to `table`. Where there are
more rules than fit on a page, the table is a `longtable`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from geswarm.rules.elements import format_probability
from geswarm.rules.model import Action, Precondition, Rule, RuleSet, format_value

_COMMANDS = {
    "\\": r"\textbackslash{}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "`": r"\textasciigrave{}",
    "'": r"{'}",
    "-": r"{-}",
    **{character: f"\\{character}" for character in "#$%&_{}"},
}
_KNOWN = {*map(chr, range(0xA0, 0x180)), *"–—‘’“”‚„‹›†‡•…‰€™←↑→↓"} - {*"¸ĦħĸĿŀŉŦŧſ"}
"""Beyond ASCII, what pdfLaTeX's T1 and TS1 fonts have."""

_COLUMNS = r"|l@{\quad}lll|"
_STYLE = r"\footnotesize\setlength{\tabcolsep}{3pt}\renewcommand{\arraystretch}{1.1}"
_LINES_PER_PAGE, _CHARACTERS_PER_LINE = 50, 70
"""What is sure to fit; the lines that part the rules are counted as if they were text."""


_SIGNS = {"!=": r"\neq", ">=": r"\geq", "<=": r"\leq"} | {sign: sign for sign in ("==", "<", ">")}


def format_latex(rule_set: RuleSet) -> str:
    """A complete document with the table; comments may hold any character."""
    return "\n".join(_document(rule_set)) + "\n"


def _document(rule_set: RuleSet) -> Iterator[str]:
    texts = [rule_set.name, rule_set.comment, *(rule.comment for rule in rule_set.rules)]
    rows = [row for at, rule in enumerate(rule_set.rules, start=1) for row in _rule(at, rule)]
    lines = len(rows) + sum(len(text) // _CHARACTERS_PER_LINE for text in texts)
    caption = ": ".join(part for part in (rule_set.name, rule_set.comment) if part)
    yield r"\documentclass{article}"
    yield r"\usepackage[utf8]{inputenc}"
    yield r"\usepackage[T1]{fontenc}"
    yield r"\usepackage{textcomp}"
    yield from [] if lines <= _LINES_PER_PAGE else [r"\usepackage{longtable}"]
    yield from _declarations("".join(texts))
    yield r"\begin{document}"
    yield from (_table if lines <= _LINES_PER_PAGE else _long_table)(
        rows, rf"\caption{{{latex_text(caption or 'Rule set')}}}"
    )
    yield r"\end{document}"


def _table(rows: Sequence[str], caption: str) -> Iterator[str]:
    yield r"\begin{table}"
    yield rf"  \centering{_STYLE}"
    yield rf"  \begin{{tabular}}{{{_COLUMNS}}}"
    yield r"    \hline"
    yield from (f"    {row}" for row in rows)
    yield r"  \end{tabular}"
    yield f"  {caption}"
    yield r"\end{table}"


def _long_table(rows: Sequence[str], caption: str) -> Iterator[str]:
    """One that goes on from page to page, but not after the first line of a part of a rule."""
    yield rf"{{{_STYLE}"
    yield rf"  \begin{{longtable}}{{{_COLUMNS}}}"
    yield rf"    {caption} \\"
    yield r"    \hline \endfirsthead"
    yield r"    \hline \endhead"
    yield r"    \hline \endfoot"
    yield r"    \endlastfoot"
    yield from (f"    {row}*" if row.startswith("$") else f"    {row}" for row in rows)
    yield r"  \end{longtable}}"


def _declarations(text: str) -> Iterator[str]:
    """Characters that pdfLaTeX does not know are shown by their number instead of stopping it."""
    strange = sorted({character for character in text if ord(character) > 126} - _KNOWN)
    if strange:
        yield r"\ifdefined\DeclareUnicodeCharacter"
        for code in (f"{ord(character):04X}" for character in strange):
            yield rf"  \DeclareUnicodeCharacter{{{code}}}{{\texttt{{[U+{code}]}}}}"
        yield r"\fi"


def _rule(number: int, rule: Rule) -> Iterator[str]:
    off = "" if rule.enabled else r"\textit{(off)} "
    comment = rf"\raggedright {off}{latex_text(rule.comment)}".rstrip()
    yield rf"$R_{{{number}}}$: & \multicolumn{{3}}{{p{{0.86\textwidth}}|}}{{{comment}}} \\"
    holds = [_precondition(entry) for entry in rule.preconditions]
    executing = [f"$B_{{{_name(str(entry))}}}$" for entry in rule.behaviours]
    yield from _rows("P", number, _in_threes(holds or [r"$\varepsilon$"]))
    yield from _rows("B", number, _in_threes(executing or [r"$\varepsilon$"]))
    actions = [_action(entry) for entry in rule.actions]
    yield from _rows("A", number, actions or [[r"$\varepsilon$"]])
    yield r"\hline"


def _precondition(entry: Precondition) -> str:
    sign, value = _SIGNS[entry.comparison], _word(format_value(entry.value))
    return f"$P_{{{_name(str(entry.percept))}}} {sign} {value}$"


def _in_threes(cells: Sequence[str]) -> list[Sequence[str]]:
    return [cells[at : at + 3] for at in range(0, len(cells), 3)]


def _rows(letter: str, number: int, rows: Sequence[Sequence[str]]) -> Iterator[str]:
    for at, cells in enumerate(rows):
        first = rf"$\mathcal{{{letter}}}_{{{number}}}$" if at == 0 else ""
        padded = [*cells, *[""] * (3 - len(cells))]
        yield rf"{' & '.join([first, *padded])} \\"


def _action(action: Action) -> list[str]:
    probability = f"$p = {_number(action.p)}$"
    if not action.target:
        return ["$A_B$", probability, rf"$B \leftarrow B_{{{_name(action.becomes)}}}$"]
    state = f"IS_{{{_name(action.target)}}}"
    becomes = _word(action.becomes.removeprefix(action.target).strip())
    counted = f"{state} " if action.becomes.startswith(f"{action.target} ") else ""
    return ["$A_{IS}$", probability, rf"${state} \leftarrow {counted}{becomes}$"]


def _number(p: float) -> str:
    """A probability, with a power of ten instead of an e."""
    mantissa, _, exponent = format_probability(p).partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}" if exponent else mantissa


def _name(name: str) -> str:
    """A name as text: in a formula, its letters would stand apart."""
    plain = name.replace("_", r"\_").replace("-", "{-}")
    return rf"\mbox{{\scriptsize\itshape {plain}}}"


def _word(word: str) -> str:
    return rf"\mathit{{{word}}}"


def latex_text(text: str) -> str:
    """Free text with nothing that means something to LaTeX; line ends become spaces."""
    return "".join(_COMMANDS.get(character, character) for character in text.replace("\n", " "))
