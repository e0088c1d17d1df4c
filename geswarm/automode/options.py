"""Command lines as options with numbers, and everything that is wrong with them, with its place.

AutoMoDe looks for the options of a state or node only between that and the next one; what stands
elsewhere it does not find. So that is an error here.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from string import ascii_letters
from typing import TypeAlias

from geswarm.automode.modules import Module, Numeral, Parameter
from geswarm.plain_text import tidy
from geswarm.rules.findings import Finding, Place, shown
from geswarm.rules.limits import MAX_CHARACTERS

_WORD = re.compile(r"""[^\s"']+""")
_MOST_HINTS = 40
"""Names among which the nearest to a wrong one is looked for."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)

Path: TypeAlias = tuple[int, ...]
"""Of a part of a controller: (state, transition), or the way to a node."""


class AutoMoDeError(ValueError):
    """A text is no controller of AutoMoDe.

    Attributes:
        findings: Every reason, with line and column.
    """

    def __init__(self, findings: Sequence[Finding]) -> None:
        self.findings = tuple(findings)
        super().__init__("\n".join(str(finding) for finding in self.findings))


@dataclass(frozen=True)
class Word:
    """A word of a text; lines and columns count from 1."""

    text: str
    line: int
    column: int


@dataclass(frozen=True)
class _Given:
    """An option as it is given.

    Attributes:
        at: Its place among the options of its line.
        option: Its name.
        value: What stands behind it, if anything does.
    """

    at: int
    option: Word
    value: Word | None


def lines_of_words(text: str) -> Iterator[list[Word]]:
    """The words of each line that has any; `#` begins a comment, quotes are left out."""
    for number, line in enumerate(tidy(text[: MAX_CHARACTERS + 1]).split("\n"), start=1):
        code = line.partition("#")[0]
        words = [Word(found[0], number, found.start() + 1) for found in _WORD.finditer(code)]
        if words:
            yield words


@dataclass
class Options:
    """The options of one controller; what is read from them, and what is wrong.

    Attributes:
        words: Of its line, without the option that names the whole.
        source: Where they come from, for messages.
        findings: What is wrong, so far.
    """

    words: Sequence[Word]
    source: str = ""
    findings: list[Finding] = field(default_factory=list)
    _given: dict[str, _Given] = field(default_factory=dict)
    _asked: dict[str, Path] = field(default_factory=dict)
    _heads: dict[Path, str] = field(default_factory=dict)
    _refused: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        words = list(self.words)
        while words:
            option = words.pop(0)
            if not option.text.startswith("--"):
                self.error(option, f"expected an option such as --n0, got {shown(option.text)}")
                continue
            value = words.pop(0) if words and not words[0].text.startswith("--") else None
            if value is None:
                follows = shown(words[0].text) if words else "nothing"
                self.error(option, f"{option.text}: expected a number behind it, got {follows}")
            if before := self._given.get(option.text):
                where = f"line {before.option.line}, column {before.option.column}"
                self.error(option, f"{option.text} is given twice, first in {where}")
                continue
            self._given[option.text] = _Given(len(self._given), option, value)

    def error(self, word: Word, message: str) -> None:
        """Note what is wrong at a word."""
        place = Place(self.source, word.line, element=f"column {word.column}")
        self.findings.append(Finding(place, message))

    @property
    def names(self) -> tuple[str, ...]:
        """The options that are given, in their order."""
        return tuple(self._given)

    def opens(self, name: str, path: Path) -> None:
        """Note the option with which a part begins."""
        self._heads[path] = name

    def refuse(self, name: str, reason: str) -> None:
        """Note why an option cannot be there."""
        self._refused.setdefault(name, reason)

    def ignore(self, name: str) -> None:
        """An option of which cannot be told whether it is right."""
        self._asked.setdefault(name, ())

    def ignore_node(self, suffix: str) -> None:
        """A node of a tree, and those below it, of which cannot be told whether they are right."""
        for name in self._given:
            node = name.lstrip("-").lstrip(ascii_letters)
            if node.startswith(suffix) and node.isdigit():
                self.ignore(name)

    def error_at(self, name: str, message: str) -> None:
        """Note what is wrong with an option, if it is given."""
        if given := self._given.get(name):
            self.error(given.option, f"{name}: {message}")

    def has(self, name: str) -> bool:
        """Whether an option is given."""
        return name in self._given

    def whole(
        self, name: str, high: int, means: str, path: Path = (), low: int = 0, needed_by: str = ""
    ) -> int | None:
        """A whole number from `low` to `high`; None if there is none, which is noted.

        Args:
            name: Of the option.
            high: The greatest.
            means: What it is, for messages.
            path: Of the part that it belongs to.
            low: The least.
            needed_by: The option that makes it necessary, where a message points.
        """
        expected = f"expected a whole number from {low} to {high} ({means})"
        given = self._take(name, path, needed_by, means)
        if given is None or given.value is None:
            return None
        text = given.value.text
        if not re.fullmatch(r"\d{1,9}", text, re.ASCII) or not low <= int(text) <= high:
            self.error(given.value, f"{name}: {expected}, got {shown(text)}")
            return None
        return int(text)

    def module(
        self, name: str, known: Mapping[int, Module], path: Path = (), needed_by: str = ""
    ) -> Module | None:
        """A module by its number; None if there is none, which is noted."""
        kinds = ", ".join(f"{number} {each.name}" for number, each in known.items())
        number = self.whole(name, max(known), kinds, path, needed_by=needed_by)
        return None if number is None else known[number]

    def number(
        self, suffix: str, parameter: Parameter, path: Path, needed_by: str
    ) -> Numeral | None:
        """A parameter; None if there is none that can be used, which is noted."""
        name = f"--{parameter.name}{suffix}"
        given = self._take(name, path, needed_by, parameter.means)
        if given is None or given.value is None:
            return None
        text = given.value.text
        if _NUMBER.fullmatch(text) and parameter.admits(found := Numeral(text)):
            return found
        expected = f"{parameter.expected} ({parameter.means})"
        self.error(given.value, f"{name}: expected {expected}, got {shown(text)}")
        return None

    def _take(self, name: str, path: Path, needed_by: str, means: str) -> _Given | None:
        self._asked[name] = path
        if name not in self._given:
            here = self._given.get(needed_by)
            word = here.option if here else self.words[0]
            why = f" for {needed_by}" if here else ""
            self.error(word, f"expected {name}{why} ({means}), found none")
            return None
        return self._given[name]

    def finish(self) -> None:
        """Note options that nothing asks for, and those where AutoMoDe does not look for them."""
        for name, given in self._given.items():
            if name not in self._asked:
                self.error(given.option, self._unknown(name))
            elif problem := self._misplaced(given, self._asked[name]):
                self.error(given.option, problem)
        self.findings.sort(key=_position)

    def _unknown(self, name: str) -> str:
        if reason := self._refused.get(name):
            return f"{name}: {reason}"
        missing = [each for each in self._asked if each not in self._given]
        few = missing if len(missing) <= _MOST_HINTS else []
        near = difflib.get_close_matches(name, few, n=1)
        hint = f"did you mean {near[0]}?" if near else "nothing here has such an option"
        return f"unknown option {shown(name)}; {hint}"

    def _misplaced(self, given: _Given, path: Path) -> str | None:
        """Why AutoMoDe would not find an option, or None."""
        for depth in range(1, len(path) + 1):
            begin = self._heads.get(path[:depth], "")
            end = self._heads.get((*path[: depth - 1], path[depth - 1] + 1), "")
            late = begin in self._given and given.at < self._given[begin].at
            early = end in self._given and given.at > self._given[end].at
            if late or early:
                where = f"behind {begin}" if late else f"before {end}"
                return f"{given.option.text}: expected {where}, where AutoMoDe looks for it"
        return None


def _position(finding: Finding) -> tuple[int, int]:
    return finding.place.line or 0, int(finding.place.element.rpartition(" ")[2] or 0)
