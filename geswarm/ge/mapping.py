"""Genotype-to-phenotype mapping of grammatical evolution (O'Neill & Ryan 2001), as GEVA does it.

The leftmost non-terminal is always expanded first. A codon is read only where there is a choice:
alternative number `codon mod n`. When the genome is used up it is read again from its beginning
(wrapping); a mapping that is unfinished after the last pass is invalid. A pass begins when a codon
is needed; GEVA begins it at a non-terminal without a choice already, which comes to the same
wherever such a non-terminal leads to a choice, as everywhere in the GESwarm grammar.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import chain, repeat
from typing import NamedTuple, TypeAlias

from geswarm.ge.grammar import Alternative, Grammar, NonTerminal

CODON_LIMIT = 1 << 31
"""Codons are integers in [0, CODON_LIMIT)."""

_SPACES = re.compile(r"(?<![ \n])  +")
"""Several spaces, but not at the beginning of a line."""

Genome: TypeAlias = tuple[int, ...]


class Derivation(NamedTuple):
    """What a genome maps to.

    Attributes:
        phenotype: The sentence, or None if the mapping did not finish.
        used: Codons read, those of further passes included.
    """

    phenotype: str | None
    used: int


# A choice is the list of its expansions: the text that comes first, then what is still to be done,
# last first, so that it can be pushed onto a stack; a str is text to emit between choices.
_Choice: TypeAlias = "list[tuple[str, tuple[_Choice | str, ...]]]"


class Mapper:
    """Maps genomes with one grammar; the grammar is compiled to tables once.

    Only choices are left in the tables: what expands without a choice is expanded in advance, and
    the text before a choice is merged into its alternatives.
    """

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self._choices: dict[tuple[str, str], _Choice] = {}
        unfinished: list[tuple[str, str]] = []
        start = (NonTerminal(grammar.start),)
        self._start = self._expansion("", start, unfinished)
        while unfinished:
            lead, name = key = unfinished.pop()
            self._choices[key] += [
                self._expansion(lead, alternative, unfinished)
                for alternative in grammar.rules[name]
            ]

    def map(self, genome: Sequence[int], max_wraps: int = 3) -> Derivation:
        """The phenotype of a genome.

        It ends for every genome: each codon that is read expands to a bounded number of symbols.

        Args:
            genome: Codons, non-negative integers.
            max_wraps: Passes over the genome after the first one.
        """
        text, rest = self._start
        parts = [text]
        emit = parts.append
        stack: list[_Choice | str] = list(rest)
        pop, push = stack.pop, stack.extend
        read = chain.from_iterable(repeat(genome, max_wraps + 1)).__next__
        used = 0
        try:
            while stack:
                choice = pop()
                if isinstance(choice, str):
                    emit(choice)
                    continue
                text, rest = choice[read() % len(choice)]
                used += 1
                emit(text)
                if rest:
                    push(rest)
        except StopIteration:
            return Derivation(None, used)
        return Derivation(_single_spaced("".join(parts)), used)

    def _expansion(
        self, lead: str, alternative: Alternative, unfinished: list[tuple[str, str]]
    ) -> tuple[str, tuple[_Choice | str, ...]]:
        """One table entry; choices met for the first time are appended to `unfinished`."""
        first: str | None = None
        todo: list[_Choice | str] = []
        text = lead
        waiting = list(reversed(alternative))
        while waiting:
            symbol = waiting.pop()
            if isinstance(symbol, str):
                text += symbol
            elif self.grammar.choices(symbol.name) == 1:
                waiting.extend(reversed(self.grammar.rules[symbol.name][0]))
            else:
                if first is None:
                    first, text = text, ""
                key = (text, symbol.name)
                if key not in self._choices:
                    self._choices[key] = []
                    unfinished.append(key)
                todo.append(self._choices[key])
                text = ""
        if first is None:
            return text, ()
        if text:
            todo.append(text)
        return first, tuple(reversed(todo))


def _single_spaced(text: str) -> str:
    """One space for several, none at the ends; indentation is kept."""
    if "\n" in text:
        return _SPACES.sub(" ", text).strip(" ")
    return " ".join(filter(None, text.split(" ")))  # the same, and faster
