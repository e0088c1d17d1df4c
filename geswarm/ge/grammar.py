"""Context-free grammars in Backus-Naur form (O'Neill & Ryan 2001), read from `.bnf` files.

The subset that GEVA and PonyGE2 share: `<name> ::= a | b`, terminals quoted with " or ' or bare,
`#` comments, alternatives continued on following lines, `""` for the empty alternative. A terminal of
several words is a sequence of words: the language is whitespace-insensitive.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import TypeAlias

MAX_FORCED = 10_000
"""Most symbols that one choice may expand to without a further choice; bounds every mapping."""


@dataclass(frozen=True)
class NonTerminal:
    """A symbol that a production expands; written `<name>`."""

    name: str

    def __str__(self) -> str:
        return f"<{self.name}>"


Symbol: TypeAlias = str | NonTerminal
"""A terminal word, or a non-terminal."""

Alternative: TypeAlias = tuple[Symbol, ...]


class GrammarError(ValueError):
    """A grammar cannot be used; `findings` lists every reason as `file:line: reason`."""

    def __init__(self, findings: Iterable[str]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(self.findings))


@dataclass(frozen=True)
class Grammar:
    """A grammar that was checked: every non-terminal is defined and can terminate.

    Attributes:
        start: Name of the start symbol, the first rule of the file.
        rules: The alternatives of every non-terminal, in the order of the file; that order is
            what a codon chooses by.
        source: File name, or what the grammar was read from.
        warnings: What is odd but harmless, such as a rule that cannot be reached.
    """

    start: str
    rules: Mapping[str, tuple[Alternative, ...]]
    source: str = "grammar"
    warnings: tuple[str, ...] = ()

    @classmethod
    def load(
        cls, path: str | Path, vocabulary: Mapping[str, Sequence[str]] | None = None
    ) -> Grammar:
        """Read a `.bnf` file.

        Args:
            path: The file.
            vocabulary: Alternatives of the non-terminals that the file uses but leaves open,
                for example `{"B_name": ["PHOTOTAXIS", "RANDOM_WALK"]}`.

        Raises:
            GrammarError: The file cannot be read, or has errors: all of them, with file and line.
        """
        try:
            text = Path(path).read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise GrammarError([f"{path}: cannot be read as a grammar: {error}"]) from error
        return cls.parse(text, source=str(path), vocabulary=vocabulary)

    @classmethod
    def parse(
        cls,
        text: str,
        source: str = "grammar",
        vocabulary: Mapping[str, Sequence[str]] | None = None,
    ) -> Grammar:
        """Read a grammar from text; see `load`."""
        reader = _Reader(source)
        reader.read(text)
        reader.fill(vocabulary or {})
        reader.check()
        if reader.findings:
            in_order = sorted(reader.findings, key=lambda finding: finding[0])
            raise GrammarError(f"{source}:{line}: {message}" for line, message in in_order)
        rules = {name: tuple(alternatives) for name, alternatives in reader.rules.items()}
        return cls(next(iter(rules)), rules, source, tuple(reader.unreachable()))

    def choices(self, name: str) -> int:
        """How many alternatives a non-terminal has; a codon is read only for two or more."""
        return len(self.rules[name])


def geswarm_grammar(vocabulary: Mapping[str, Sequence[str]]) -> Grammar:
    """The GESwarm grammar (paper, section 2.2) over a vocabulary.

    Args:
        vocabulary: Words for `P_name` (preconditions), `B_name` (behaviours), `IS_name` (internal
            states) and `value` (probabilities, as text).
    """
    text = resources.files("geswarm.ge").joinpath("geswarm.bnf").read_text(encoding="utf-8")
    return Grammar.parse(text, source="geswarm.bnf", vocabulary=vocabulary)


_TOKEN = re.compile(
    r"""(?P<space>\s+ | \#[^\n]*)
      | (?P<define>(?m:^)[^\S\n]*<(?P<defined>[\w.:-]+)>\s*::=)
      | (?P<nonterminal><(?P<used>[\w.:-]+)>)
      | (?P<bar>\|)
      | (?P<quoted>"(?P<double>[^"\n]*)"|'(?P<single>[^'\n]*)')
      | (?P<broken>["'][^\n]* | ::= | <GECodonValue[^\n]* | \\.?)
      | (?P<word>(?:(?!<[\w.:-]+>|<GECodonValue|::=)[^\s|"'\#\\])+)""",
    re.VERBOSE,
)

_BROKEN = {
    '"': "a quoted terminal must end on its line, expected a closing \"",
    "'": "a quoted terminal must end on its line, expected a closing '",
    ":": "unexpected ::=, expected it only after a <name> at the beginning of a line",
    "<": "GECodonValue is not supported, expected <name> with its alternatives written out",
    "\\": "unexpected backslash, expected it only inside quotes",
}


class _Reader:
    """Collects rules and findings, (line, message), so that all errors are reported at once."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.rules: dict[str, list[Alternative]] = {}
        self.lines: dict[str, int] = {}
        self.uses: dict[str, int] = {}
        self.findings: list[tuple[int, str]] = []

    def read(self, text: str) -> None:
        """Read all rules of a file; what a duplicate rule says is read and ignored."""
        bodies: list[list[tuple[int, list[Symbol] | None]]] = []
        line = 1
        for match in _TOKEN.finditer(text):
            at = line + (match["define"] or "").rstrip().count("\n") * 0
            line += match.group().count("\n")
            if match["space"] is not None:
                continue
            if match["define"] is not None:
                self._define(match["defined"], at)
            elif match["broken"] is not None:
                self.findings.append((at, _BROKEN[match.group()[0]]))
            elif not self.rules:
                self.findings.append((at, f"expected <name> ::= first, got {match.group()!r}"))
                return
        del bodies
