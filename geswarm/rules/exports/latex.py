"""A rule set as a LaTeX table in the form of the paper's Tables 1 and 2.

The document compiles as it is; a paper takes what stands from `table` to `table`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from geswarm.rules.elements import format_boolean, format_probability
from geswarm.rules.model import Action, BehaviourChange, Rule, RuleSet

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


def format_latex(rule_set: RuleSet) -> str:
    """A complete document with the table; comments may hold any character."""
    return "\n".join(_document(rule_set)) + "\n"


def _document(rule_set: RuleSet) -> Iterator[str]:
    texts = [rule_set.name, rule_set.comment, *(rule.comment for rule in rule_set.rules)]
    yield r"\documentclass{article}"
    yield r"\usepackage[utf8]{inputenc}"
    yield r"\usepackage[T1]{fontenc}"
    yield r"\usepackage{textcomp}"
    yield from _declarations("".join(texts))
    yield r"\begin{document}"
    yield r"\begin{table}"
    yield r"  \centering\footnotesize\setlength{\tabcolsep}{3pt}"
    yield r"  \begin{tabular}{|l@{\quad}lll|}"
    yield r"    \hline"
    for number, rule in enumerate(rule_set.rules, start=1):
        yield from _rule(number, rule)
        yield r"    \hline"
    yield r"  \end{tabular}"
    caption = ": ".join(part for part in (rule_set.name, rule_set.comment) if part)
    yield rf"  \caption{{{latex_text(caption or 'Rule set')}}}"
    yield r"\end{table}"
    yield r"\end{document}"


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
    yield rf"    $R_{{{number}}}$: & \multicolumn{{3}}{{p{{0.86\textwidth}}|}}{{{comment}}} \\"
    holds = [
        f"$P_{{{_name(entry.name)}}} == {_word(format_boolean(entry.holds))}$"
        for entry in rule.preconditions
    ]
    executing = [f"$B_{{{_name(name)}}}$" for name in rule.behaviours]
    yield from _rows("P", number, _in_threes(holds or [r"$\varepsilon$"]))
    yield from _rows("B", number, _in_threes(executing or [r"$\varepsilon$"]))
    actions = [_action(entry) for entry in rule.actions]
    yield from _rows("A", number, actions or [[r"$\varepsilon$"]])


def _in_threes(cells: Sequence[str]) -> list[Sequence[str]]:
    return [cells[at : at + 3] for at in range(0, len(cells), 3)]


def _rows(letter: str, number: int, rows: Sequence[Sequence[str]]) -> Iterator[str]:
    for at, cells in enumerate(rows):
        first = rf"$\mathcal{{{letter}}}_{{{number}}}$" if at == 0 else ""
        padded = [*cells, *[""] * (3 - len(cells))]
        yield rf"    {' & '.join([first, *padded])} \\"


def _action(action: Action) -> list[str]:
    probability = f"$p = {_number(action.p)}$"
    if isinstance(action, BehaviourChange):
        return ["$A_B$", probability, rf"$B \leftarrow B_{{{_name(action.behaviour)}}}$"]
    target = rf"$IS_{{{_name(action.state)}}} \leftarrow {_word(format_boolean(action.value))}$"
    return ["$A_{IS}$", probability, target]


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
