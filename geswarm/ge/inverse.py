"""The inverse of the mapping: from a sentence of the grammar to a genome that maps to it.

The sentence is parsed by Earley's algorithm (1970), straight on the characters. Of an ambiguous
sentence the derivation that is found first is taken.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import numpy as np

from geswarm.ge.grammar import SPACE, Alternative, Grammar
from geswarm.ge.mapping import CODON_LIMIT, Genome

_SPACE = re.compile(r"\s*")
_WORD = re.compile(r"[^\s,]+|,")
_NAME = re.compile(r"[\w.]")


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
    for sentence in (text, " ".join(text.split())):
        exact = _Parser(grammar, sentence)
        if exact.root is not None:
            return list(exact.choices(exact.root))
    lenient = _Parser(grammar, text, lenient=True)
    if lenient.root is None:
        raise lenient.error()
    return list(lenient.choices(lenient.root))


def genome_of(grammar: Grammar, text: str, rng: np.random.Generator | None = None) -> Genome:
    """A genome that maps to a sentence, without wrapping and with every codon read.

    Args:
        grammar: The grammar.
        text: A sentence of it; white space between words may be left out or put in line breaks
            where the grammar has a space, and words stay apart.
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


# How an item was reached: the end of the same item one symbol earlier, and the completed item that
# this symbol was, or None for a terminal.
_Step: TypeAlias = "tuple[int, _Item | None]"


class _Parser:
    """Earley chart: for every character position the items that end there.

    Attributes:
        root: The start symbol, derived; None if the text is no sentence.
    """

    def __init__(self, grammar: Grammar, text: str, lenient: bool = False) -> None:
        self.rules = grammar.rules
        self.start = grammar.start
        self.text = text
        self.lenient = lenient
        self.begin = self._skip_space(0) if lenient else 0
        self.end = max(len(text.rstrip()), self.begin) if lenient else len(text)
        self.chart: list[dict[_Item, _Step | None]] = [{} for _ in range(len(text) + 1)]
        self.waiting: dict[tuple[int, str], list[_Item]] = {}
        self._predict(self.start, self.begin)
        self.furthest = self.begin
        for position in range(self.begin, len(text) + 1):
            if self.chart[position]:
                self.furthest = position
                self._process(position)
        self.root = self._whole(self.end)
        while self.root is None and self.end < len(text):  # it may end with a line break
            self.end += 1
            self.root = self._whole(self.end)

    def choices(self, root: _Item) -> Iterator[tuple[int, int]]:
        """Walk the derivation tree in preorder."""
        stack = [(self.end, root)]
        while stack:
            end, item = stack.pop()
            if len(self.rules[item.name]) > 1:
                yield item.alternative, len(self.rules[item.name])
            stack += self._children(end, item)

    def error(self) -> NotASentenceError:
        """Where the text stops being a sentence, at the beginning of a word if possible."""
        at = self.furthest
        if _NAME.match(self.text, at):
            word = at
            while word > self.begin and _NAME.match(self.text, word - 1):
                word -= 1
            at = word if self._expected(word) else at
        return NotASentenceError(self.text, at, self._expected(at))

    def _children(self, end: int, item: _Item) -> Iterator[tuple[int, _Item]]:
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
        agenda = list(self.chart[position])
        empty: dict[str, _Item] = {}  # what is complete here and began here
        for item in agenda:  # grows while it is walked
            alternative = self._alternative(item)
            if item.dot == len(alternative):
                if item.begin == position:
                    empty.setdefault(item.name, item)
                for parent in self.waiting.get((item.begin, item.name), ()):
                    self._advance(parent, item.begin, item, position, agenda)
                continue
            symbol = alternative[item.dot]
            if symbol == SPACE:
                self._scan_space(item, position, agenda)
            elif isinstance(symbol, str):
                if self.text.startswith(symbol, position):
                    self._advance(item, position, None, position + len(symbol), None)
            else:
                key = (position, symbol.name)
                if key not in self.waiting:
                    self.waiting[key] = []
                    agenda += self._predict(symbol.name, position)
                self.waiting[key].append(item)
                if symbol.name in empty:
                    self._advance(item, position, empty[symbol.name], position, agenda)

    def _predict(self, name: str, position: int) -> list[_Item]:
        predicted = [_Item(name, at, 0, position) for at in range(len(self.rules[name]))]
        fresh = [item for item in predicted if item not in self.chart[position]]
        self.chart[position].update(dict.fromkeys(fresh))
        return fresh

    def _advance(
        self, item: _Item, end: int, child: _Item | None, position: int, agenda: list[_Item] | None
    ) -> None:
        """Move an item that ends at `end` over a symbol that ends at `position`.

        The agenda is that of the position, if the item is to be looked at now.
        """
        advanced = item._replace(dot=item.dot + 1)
        if advanced not in self.chart[position]:
            self.chart[position][advanced] = (end, child)
            if agenda is not None:
                agenda.append(advanced)

    def _scan_space(self, item: _Item, position: int, agenda: list[_Item]) -> None:
        """A space; none is needed at the ends, after another one, or where words stay apart."""
        here, before = self.text[position : position + 1], self.text[position - 1 : position]
        if self.lenient:
            after = self._skip_space(position)
            apart = before.isspace() or not (_is_part_of_name(before) and _is_part_of_name(here))
        else:
            after = position + (here == SPACE)
            apart = before == SPACE and not self._is_indented(position)
        for end in range(position + 1, after + 1):
            self._advance(item, position, None, end, None)
        if after == position and (apart or position in (self.begin, self.end)):
            self._advance(item, position, None, position, agenda)

    def _is_indented(self, position: int) -> bool:
        """Whether there are only spaces before in a line that is not the first."""
        line = self.text.rfind("\n", 0, position) + 1
        return line > 0 and self.text[line:position].isspace()

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
            words.update(
                {word: None for word in following if isinstance(word, str) and word != SPACE}
            )
        expected = [repr(word) for word in words]
        ended = len(self.text[:position].rstrip())
        return [*expected, "the end"] if self._whole(ended) else expected


def _is_part_of_name(character: str) -> bool:
    return character.isalnum() or character == "_"
