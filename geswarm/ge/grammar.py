r"""Context-free grammars in Backus-Naur form (O'Neill & Ryan 2001), read from `.bnf` files.

The subset that GEVA and PonyGE2 share: `<name> ::= a | b`, terminals quoted with " or ' or bare,
`#` comments, alternatives continued on following lines, `""` for the empty alternative. In quotes,
`\n` is a line break, `\t` a tab, and `\\`, `\"` and `\'` are the characters themselves.

Symbols that touch in the file touch in the sentence: `<digit><digit>.<digit>` gives 12.5. The white
space between others stays, as a single space if it is spaces: `<expr> + <expr>` gives x + y.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from geswarm.plain_text import read_file, tidy

MAX_CHARACTERS, MAX_RULES = 20_000, 1000
"""Of a grammar's text; they bound what has to be done to read it and to map with it."""

MAX_FORCED = 10_000
"""Most symbols that one choice may expand to without a further choice; bounds every mapping."""


@dataclass(frozen=True)
class NonTerminal:
    """A symbol that a production expands; written `<name>`."""

    name: str

    def __str__(self) -> str:
        return f"<{self.name}>"


Symbol: TypeAlias = str | NonTerminal
"""A terminal: SPACE, or text without spaces; or a non-terminal."""

SPACE = " "
"""One space, however many of them meet, and none at the ends of a sentence; at the beginning of a
line each of them counts."""

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
            text = read_file(path, MAX_CHARACTERS)
        except (OSError, ValueError) as error:
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
        text = tidy(text)
        if len(text) > MAX_CHARACTERS:
            raise GrammarError([f"{source}: expected at most {MAX_CHARACTERS} characters"])
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


_NAME = r"<[^\s<>|\"'\#\\]+>"
_SPACED = r"<(?=\S)[^<>|\"'\#\\\n]*[^\s<>|\"'\#\\]>"  # with white space in it, where _NAME is not
_TOKEN = re.compile(
    rf"""(?P<space>[ \t\n\f\v]+)
      | (?P<comment>\#[^\n]*)
      | (?P<define><[^<>\n]*>\s*::=)
      | (?P<name>(?!<GECodonValue){_NAME})
      | (?P<bar>\|)
      | (?P<quoted>"(?:[^"\\\n]|\\.)*" | '(?:[^'\\\n]|\\.)*')
      | (?P<unclosed>["'][^\n]*)
      | (?P<misplaced>::=)
      | (?P<codon><GECodonValue[^\n]*)
      | (?P<range>GE_RANGE:[^\n]*)
      | (?P<backslash>\\)
      | (?P<spaced>{_SPACED})
      | (?P<word>(?:(?!{_NAME}|{_SPACED}|<GECodonValue|::=)[^ \t\n\f\v|"'\#\\])+)""",
    re.VERBOSE,
)
_WHY_REFUSED = {
    "unclosed": "expected a closing {0} on the same line",
    "misplaced": "unexpected ::=, expected it only after a <name> that begins a line",
    "codon": "GECodonValue is not supported, expected the alternatives written out",
    "range": "GE_RANGE is not supported, expected the alternatives written out",
    "backslash": "unexpected backslash outside quotes, expected quoted or plain words",
    "spaced": "expected a name without white space, or quotes around what is no name",
}
_ESCAPED = {"n": "\n", "t": "\t", "r": "\r", "f": "\f", "v": "\v", "a": "\a", "b": "\b"} | {
    mark: mark for mark in "\\'\""
}
_WHY_ESCAPED = r"""in quotes, expected \\ for a backslash, or \n \t \r \f \v \a \b \' or \""""


class _Reader:
    """Collects rules and findings (line, message), so that all errors are reported at once."""

    def __init__(self, source: str) -> None:
        self.source = source
        self.rules: dict[str, list[Alternative]] = {}
        self.lines: dict[str, int] = {}  # where each rule is defined
        self.uses: dict[str, int] = {}  # where each non-terminal is first used
        self.findings: list[tuple[int, str]] = []

    def read(self, text: str) -> None:
        """Read all rules of a file."""
        body: list[Alternative] | None = None
        symbols: list[Symbol] | None = None  # of the present alternative; None: nothing yet
        line = at = 1
        gap = ""  # white space and comments since the last symbol
        for match in _TOKEN.finditer(text):
            kind, token, at = match.lastgroup or "", match.group(), line
            line += token.count("\n")
            if kind in ("space", "comment"):
                gap += token
                continue
            if kind == "define":
                self._close(body, symbols, at)
                before = text[text.rfind("\n", 0, match.start()) + 1 : match.start()]
                body, symbols = self._define(token[1 : token.index(">")], before, at), None
            elif kind in _WHY_REFUSED:
                self._refuse(kind, token, at)
                symbols = symbols or []
            elif kind == "bar" and body is not None:
                self._close(body, symbols, at)
                symbols = None
            elif body is None:
                self.findings.append(
                    (at, f"expected <name> ::= to begin a rule, got {token[:40]!r}")
                )
                return
            else:
                between = [] if symbols is None else self._between(gap, token, at)
                symbols = symbols or []
                symbols += [*between, *self._symbols(kind, token, at)]
            gap = ""
        self._close(body, symbols, at)
        if not self.rules and not self.findings:
            self.findings.append((1, "there is no rule, expected <name> ::= a | b"))

    def _refuse(self, kind: str, token: str, line: int) -> None:
        why = _WHY_REFUSED[kind].format(token[0])
        self.findings.append((line, f"{why}, got {token.strip()[:40]!r}"))

    def _define(self, name: str, before: str, line: int) -> list[Alternative]:
        if not re.fullmatch(_NAME, f"<{name}>"):
            expected = "expected a name without white space, |, quotes, # and backslash"
            self.findings.append((line, f"{expected}, got <{name[:40]}>"))
        if before.strip():
            self.findings.append(
                (line, f"<{name}> ::= must begin a line, got it after {before[-40:]!r}")
            )
        if name in self.rules:
            message = f"<{name}> is already defined in line {self.lines[name]}"
            self.findings.append((line, message))
            return []
        self.lines[name] = line
        return self.rules.setdefault(name, [])

    def _close(
        self, body: list[Alternative] | None, symbols: list[Symbol] | None, line: int
    ) -> None:
        """End the present alternative."""
        if body is not None:
            if symbols is None:
                self.findings.append(
                    (line, 'expected an alternative, got nothing; write "" for it')
                )
            body.append(tuple(symbols or ()))

    def _between(self, gap: str, token: str, line: int) -> list[Symbol]:
        """What stands between two symbols of an alternative."""
        if "#" in gap:  # PonyGE2 begins another alternative here
            message = f"expected | or the end of the rule after a comment, got {token[:40]!r}"
            self.findings.append((line, message))
        return list(_terminals(re.sub(r" *(\n| ) *", r"\1", gap)))

    def _symbols(self, kind: str, token: str, line: int) -> list[Symbol]:
        if kind == "name":
            self.uses.setdefault(token[1:-1], line)
            return [NonTerminal(token[1:-1])]
        return list(_terminals(self._unquoted(token, line) if kind == "quoted" else token))

    def _unquoted(self, token: str, line: int) -> str:
        def character(match: re.Match[str]) -> str:
            if match[1] not in _ESCAPED:  # GEVA and PonyGE2 disagree about these
                self.findings.append((line, f"{_WHY_ESCAPED}, got {match[0]}"))
            return _ESCAPED.get(match[1], match[0])

        return re.sub(r"\\(.)", character, token[1:-1])

    def fill(self, vocabulary: Mapping[str, Sequence[str]]) -> None:
        """Define the non-terminals that the file leaves open."""
        for name, words in vocabulary.items():
            if name in self.rules:
                message = f"<{name}> is defined here, expected the vocabulary not to give it too"
                self.findings.append((self.lines[name], message))
            elif name not in self.uses:
                self.findings.append((1, f"the vocabulary gives <{name}>, which no rule uses"))
            elif not words:
                message = f"the vocabulary of <{name}> is empty, expected at least one word"
                self.findings.append((self.uses[name], message))
            else:
                self.lines[name] = self.uses[name]
            self.rules.setdefault(name, [_terminals(word) for word in words])

    def check(self) -> None:
        """Find what keeps the grammar from deriving sentences."""
        for name, line in self.uses.items():
            if name not in self.rules:
                message = (
                    f"<{name}> is not defined, expected <{name}> ::= or a vocabulary for it, "
                    "or quotes around it if it is a word"
                )
                self.findings.append((line, message))
        if len(self.rules) > MAX_RULES:
            message = f"expected at most {MAX_RULES} rules, got {len(self.rules)}"
            self.findings.append((1, message))
        if self.findings:
            return
        ending = self._terminating()
        for name in self.rules:
            if name not in ending:
                message = f"<{name}> never ends, expected an alternative without recursion"
                self.findings.append((self.lines[name], message))
        if not self.findings:
            self._check_forced()

    def _terminating(self) -> set[str]:
        """The non-terminals that can derive a sentence."""
        used = {name: [_names(one) for one in body] for name, body in self.rules.items()}
        ending: set[str] = set()
        grown = True
        while grown:
            grown = False
            for name, body in used.items():
                if name not in ending and any(names <= ending for names in body):
                    ending.add(name)
                    grown = True
        return ending

    def _check_forced(self) -> None:
        """Bound what expands without a choice: <a> ::= <b> <b>, <b> ::= <c> <c> ... doubles."""
        sizes: dict[str, int] = {name: 1 for name, body in self.rules.items() if len(body) > 1}
        used = {name: _names(body[0]) for name, body in self.rules.items() if len(body) == 1}
        while used:  # single alternatives that terminate have no cycle
            for name in [name for name, names in used.items() if names <= sizes.keys()]:
                sizes[name] = min(_size(self.rules[name][0], sizes), MAX_FORCED + 1)
                del used[name]
        for name, body in self.rules.items():
            if any(_size(one, sizes) > MAX_FORCED for one in body):
                message = f"<{name}> expands to more than {MAX_FORCED} symbols without a choice"
                self.findings.append((self.lines[name], message))

    def unreachable(self) -> Iterator[str]:
        """A warning for each rule that the start symbol never leads to."""
        reached: set[str] = set()
        waiting = [next(iter(self.rules))]
        while waiting:
            name = waiting.pop()
            if name not in reached:
                reached.add(name)
                waiting += [used for one in self.rules[name] for used in _names(one)]
        for name, line in self.lines.items():
            if name not in reached:
                yield f"{self.source}:{line}: <{name}> cannot be reached from the first rule"


def _terminals(text: str) -> tuple[str, ...]:
    """Text cut at its spaces."""
    return tuple(re.findall(r" |[^ ]+", text))


def _names(alternative: Alternative) -> set[str]:
    return {symbol.name for symbol in alternative if isinstance(symbol, NonTerminal)}


def _size(alternative: Alternative, sizes: Mapping[str, int]) -> int:
    """How many symbols an alternative expands to up to the next choices."""
    return sum(sizes[one.name] if isinstance(one, NonTerminal) else 1 for one in alternative)
