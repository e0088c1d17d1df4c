"""The inverse of the mapping: from a sentence of the grammar to a genome that maps to it.

The sentence is parsed by Earley's algorithm (1970) with the nullable rule of Aycock and Horspool
(2002), straight on the characters: a word of the grammar may follow any white space, and commas may
touch words. Of an ambiguous sentence the derivation that is found first is taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from geswarm.ge.grammar import Alternative, Grammar, NonTerminal
from geswarm.ge.mapping import CODON_LIMIT, Genome

_SPACE = re.compile(r"\s*")
_WORD = re.compile(r"[^\s,]+|,")


class NotASentenceError(ValueError):
    """The grammar does not derive a text.

    Attributes:
        position: Characters from the beginning that the grammar understands.
        line: Line in which it stops, from 1.
        column: Column at which it stops, from 1.
        expected: Words that could have followed.
    """

    def __init__(self, text: str, position: int, expected: list[str]) -> None:
        self.position = position
        self.line = text.count("\n", 0, position) + 1
        self.column = position - (text.rfind("\n", 0, position) + 1) + 1
        self.expected = tuple(expected)
        found = _WORD.match(text, position)
        got = repr(found.group()) if found else "the end"
        before = " ".join(text[:position].split())
        after = (
            f" after {('...' + before[-40:] if len(before) > 40 else before)!r}" if before else ""
        )
        super().__init__(
            f"line {self.line}, column {self.column}: "
            f"expected {' or '.join(expected)}{after}, got {got}"
        )


def choices_of(grammar: Grammar, text: str) -> list[tuple[int, int]]:
    """The choices, depth first and leftmost first, by which the grammar derives a text.

    Returns:
        (alternative, number of alternatives) for every choice point, as the mapping meets them.

    Raises:
        NotASentenceError: The grammar does not derive the text.
    """
    return list(_Parser(grammar, text).choices())


def genome_of(grammar: Grammar, text: str, rng: np.random.Generator | None = None) -> Genome:
    """A genome that maps to a sentence, without wrapping and with every codon read.

    Args:
        grammar: The grammar.
        text: A sentence of it; white space does not matter.
        rng: If given, codons are drawn uniformly among those that make the right choice;
            otherwise they are the smallest.

    Returns:
        At least one codon, so that operators have something to work on.

    Raises:
        NotASentenceError: The grammar does not derive the text.
    """
    choices = choices_of(grammar, text) or [(0, 1)]
    if rng is None:
        return tuple(choice for choice, _ in choices)
    return tuple(
        choice + n * int(rng.integers((CODON_LIMIT - choice - 1) // n + 1)) for choice, n in choices
    )


class _Item(NamedTuple):
    """An alternative of a rule, parsed up to `dot`, that began at character `begin`."""

    name: str
    alternative: int
    dot: int
    begin: int


# How an item was reached: the end of the same item one symbol earlier, and what that symbol was: a
# completed item, the name of a non-terminal that stands for nothing, or None for a word.
_Step: TypeAlias = "tuple[int, _Item | str | None]"


class _Parser:
    """Earley chart: for every character position the items that end there."""

    def __init__(self, grammar: Grammar, text: str) -> None:
        self.rules = grammar.rules
        self.start = grammar.start
        self.text = text
        self.empty = _empty_alternatives(grammar)
        self.chart: list[dict[_Item, _Step | None]] = [{} for _ in range(len(text) + 1)]
        self.waiting: dict[tuple[int, str], list[_Item]] = {}
        begin = self._skip_space(0)
        self._predict(self.start, begin)
        furthest = begin
        for position in range(begin, len(text) + 1):
            if self.chart[position]:
                furthest = position
                self._process(position)
        self.begin = begin
        whole = self._whole(len(text))
        if whole is None:
            raise NotASentenceError(text, furthest, self._expected(furthest))
        self.root = whole

    def choices(self) -> Iterator[tuple[int, int]]:
        """Walk the derivation tree in preorder."""
        stack: list[tuple[int, _Item | str]] = [(len(self.text), self.root)]
        while stack:
            end, node = stack.pop()
            name = node if isinstance(node, str) else node.name
            chosen = self.empty[name] if isinstance(node, str) else node.alternative
            if len(self.rules[name]) > 1:
                yield chosen, len(self.rules[name])
            if isinstance(node, str):
                symbols = reversed(self.rules[name][chosen])
                stack += [(end, one.name) for one in symbols if isinstance(one, NonTerminal)]
            else:
                stack += self._children(end, node)

    def _children(self, end: int, item: _Item) -> Iterator[tuple[int, _Item | str]]:
        """The non-terminals below a completed item with their ends, last first."""
        while item.dot:
            step = self.chart[end][item]
            assert step is not None
            earlier, child = step
            if child is not None:
                yield end, child
            end, item = earlier, item._replace(dot=item.dot - 1)

    def _alternative(self, item: _Item) -> Alternative:
        return self.rules[item.name][item.alternative]

    def _process(self, position: int) -> None:
        """Complete, predict and scan at one position, until nothing is added."""
        items = self.chart[position]
        agenda = list(items)
        for item in agenda:  # grows while it is walked
            alternative = self._alternative(item)
            if item.dot == len(alternative):
                for parent in self.waiting.get((item.begin, item.name), ()):
                    self._advance(parent, item.begin, item, position, agenda)
                continue
            symbol = alternative[item.dot]
            if isinstance(symbol, str):
                self._scan(item, symbol, position)
                continue
            key = (position, symbol.name)
            if key not in self.waiting:
                self.waiting[key] = []
                agenda += self._predict(symbol.name, position)
            self.waiting[key].append(item)
            if symbol.name in self.empty:
                self._advance(item, position, symbol.name, position, agenda)

    def _predict(self, name: str, position: int) -> list[_Item]:
        predicted = [_Item(name, at, 0, position) for at in range(len(self.rules[name]))]
        fresh = [item for item in predicted if item not in self.chart[position]]
        self.chart[position].update(dict.fromkeys(fresh))
        return fresh

    def _advance(
        self, item: _Item, end: int, child: _Item | str, position: int, agenda: list[_Item]
    ) -> None:
        """Move an item that ends at `end` over a child that ends at `position`."""
        advanced = item._replace(dot=item.dot + 1)
        if advanced not in self.chart[position]:
            self.chart[position][advanced] = (end, child)
            agenda.append(advanced)

    def _scan(self, item: _Item, word: str, position: int) -> None:
        end = position + len(word)
        if not self.text.startswith(word, position):
            return
        if _is_part_of_name(word[-1]) and _is_part_of_name(self.text[end : end + 1]):
            return
        advanced = item._replace(dot=item.dot + 1)
        self.chart[self._skip_space(end)].setdefault(advanced, (position, None))

    def _skip_space(self, position: int) -> int:
        found = _SPACE.match(self.text, position)
        return found.end() if found else position

    def _whole(self, position: int) -> _Item | None:
        """The start symbol, completed from the beginning to a position."""
        for at, alternative in enumerate(self.rules[self.start]):
            item = _Item(self.start, at, len(alternative), self.begin)
            if item in self.chart[position]:
                return item
        return None

    def _expected(self, position: int) -> list[str]:
        words: dict[str, None] = {}
        for item in self.chart[position]:
            following = self._alternative(item)[item.dot : item.dot + 1]
            words.update({word: None for word in following if isinstance(word, str)})
        expected = [repr(word) for word in words]
        return [*expected, "the end"] if self._whole(position) else expected


def _is_part_of_name(character: str) -> bool:
    return character.isalnum() or character == "_"


def _empty_alternatives(grammar: Grammar) -> dict[str, int]:
    """For every non-terminal that can derive nothing: the alternative that does."""
    empty: dict[str, int] = {}
    grown = True
    while grown:
        grown = False
        for name, alternatives in grammar.rules.items():
            for at, alternative in enumerate(alternatives):
                if name not in empty and all(
                    isinstance(symbol, NonTerminal) and symbol.name in empty
                    for symbol in alternative
                ):
                    empty[name] = at
                    grown = True
    return empty
