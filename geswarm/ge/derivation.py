"""Operators on the derivation tree (Whigham 1995; Fagan et al. 2016), worked on as codons.

A genome whose codons are all read in one pass is its derivation tree in preorder: one codon per
choice, and every sub-derivation is a contiguous stretch of codons. Cutting, replacing and inserting
such stretches therefore keeps every child a sentence of the grammar.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from geswarm.ge.grammar import Alternative, Grammar, NonTerminal
from geswarm.ge.mapping import CODON_LIMIT, Genome

Option = TypeVar("Option")

GROWTH_DEPTH = 12
"""Nested choices after which a sub-derivation that is grown afresh takes the shortest way out."""

GROWTH_CODONS = 150
"""Codons, read and still to come, after which it does so too: some grammars branch often."""


class Node(NamedTuple):
    """A non-terminal of a derivation tree.

    Attributes:
        name: The non-terminal.
        begin: Index of its first codon.
        end: Index behind the last codon of its sub-derivation; begin if it reads none.
        alternative: Which one was chosen.
        parent: Index, among the nodes, of the nearest choice above; -1 at the top.
        forced: There is no choice: it reads no codon of its own.
    """

    name: str
    begin: int
    end: int
    alternative: int
    parent: int
    forced: bool


def exact(genome: Genome, used: int) -> Genome:
    """The same derivation without wrapping and without unused codons."""
    passes = -(-used // len(genome))
    return (genome * passes)[:used]


class DerivationTrees:
    """Reads, grows and changes derivations of one grammar; all genomes must be `exact`."""

    def __init__(self, grammar: Grammar) -> None:
        self.grammar = grammar
        self._below = {
            name: [_children(alternative) for alternative in alternatives]
            for name, alternatives in grammar.rules.items()
        }
        depths = _least_depths(grammar)
        self._depths = {
            name: [1 + max((depths[child] for child in one), default=0) for one in alternatives]
            for name, alternatives in self._below.items()
        }
        self._recursive = {name for name in grammar.rules if name in _reached_from(grammar, name)}
        self._scales = {name for name, body in grammar.rules.items() if _is_scale(body)}

    def nodes(self, genome: Genome) -> list[Node]:
        """The derivation tree in preorder."""
        opened: list[tuple[str, int, int, int, bool]] = []
        ends: list[int] = []
        at = 0
        # To do, last first: (name, parent) to open a node, or its index to close it.
        stack: list[tuple[str, int] | int] = [(self.grammar.start, -1)]
        while stack:
            top = stack.pop()
            if isinstance(top, int):
                ends[top] = at
                continue
            name, parent = top
            alternatives = self._below[name]
            forced, index, chosen = len(alternatives) == 1, len(opened), 0
            if not forced:
                chosen = genome[at] % len(alternatives)
            opened.append((name, at, chosen, parent, forced))
            at += not forced
            ends.append(at)
            children = alternatives[chosen]
            if children:
                stack.append(index)
                below = parent if forced else index
                stack += [(child, below) for child in reversed(children)]
        return [
            Node(name, begin, end, chosen, parent, forced)
            for (name, begin, chosen, parent, forced), end in zip(opened, ends, strict=True)
        ]

    def swap(
        self, first: Genome, second: Genome, max_codons: int, rng: np.random.Generator
    ) -> Genome:
        """Put a sub-derivation of `second` in place of one of `first`, same non-terminal.

        The non-terminal is drawn among those that both have, then the places; so rare, large parts
        are exchanged as often as frequent, small ones. A child longer than `max_codons` is refused:
        `first` is returned.
        """
        places = [_by_name(self.nodes(genome)) for genome in (first, second)]
        shared = [name for name in places[0] if name in places[1]]
        if not shared:
            return first
        name = _draw(shared, rng)
        cut, graft = (_draw(place[name], rng) for place in places)
        child = first[: cut.begin] + second[graft.begin : graft.end] + first[cut.end :]
        return child if len(child) <= max_codons else first

    def edit(self, genome: Genome, max_codons: int, rng: np.random.Generator) -> Genome:
        """One local change: redraw a choice, cut a part out of a recursion, or put one in."""
        change = _draw((self.redraw, self.redraw, self.hoist, self.insert), rng)
        child = change(genome, rng)
        return child if len(child) <= max_codons else genome

    def redraw(self, genome: Genome, rng: np.random.Generator) -> Genome:
        """Choose differently at one place; sub-derivations that still fit there are kept.

        Of numbers in their order, every other time it is the next one up or down.
        """
        nodes = self.nodes(genome)
        choices = [index for index, node in enumerate(nodes) if not node.forced]
        if not choices:
            return genome
        index = _draw(choices, rng)
        node = nodes[index]
        n = self.grammar.choices(node.name)
        others = [(node.alternative + at) % n for at in range(1, n)]
        if node.name in self._scales and rng.integers(2):
            others = [at for at in others if abs(at - node.alternative) == 1]
        chosen = _draw(others, rng)
        kept = [one for one in nodes if one.parent == index and not one.forced]
        codons = [_codon(chosen, n, rng)]
        for name in self._choices_below(self._below[node.name][chosen]):
            same = next((one for one in kept if one.name == name), None)
            if same is None:
                codons += self.grow(name, GROWTH_DEPTH, rng)
            else:
                kept.remove(same)
                codons += genome[same.begin : same.end]
        return genome[: node.begin] + tuple(codons) + genome[node.end :]

    def hoist(self, genome: Genome, rng: np.random.Generator) -> Genome:
        """Replace a sub-derivation by the nearest one of the same non-terminal inside it.

        In a list this removes one element.
        """
        nodes = self.nodes(genome)
        pairs = []
        for index, node in enumerate(nodes):
            inside = (one for one in nodes[index + 1 :] if one.begin < node.end)
            inner = next((one for one in inside if one.name == node.name), None)
            if inner is not None and node.end - node.begin > inner.end - inner.begin:
                pairs.append((node, inner))
        if not pairs:
            return genome
        node, inner = _draw(pairs, rng)
        return genome[: node.begin] + genome[inner.begin : inner.end] + genome[node.end :]

    def insert(self, genome: Genome, rng: np.random.Generator) -> Genome:
        """Wrap a sub-derivation in a fresh one of the same non-terminal: the inverse of `hoist`.

        In a list this adds one element.
        """
        places = [
            (node, at)
            for node in self.nodes(genome)
            if not node.forced
            for at, children in enumerate(self._below[node.name])
            if node.name in children
        ]
        if not places:
            return genome
        node, at = _draw(places, rng)
        alternatives = self._below[node.name]
        codons = [_codon(at, len(alternatives), rng)]
        waiting = [genome[node.begin : node.end]]
        for name in alternatives[at]:
            if name == node.name and waiting:
                codons += waiting.pop()
            else:
                codons += self.grow(name, GROWTH_DEPTH, rng)
        return genome[: node.begin] + tuple(codons) + genome[node.end :]

    def grow(self, name: str, depth: int, rng: np.random.Generator) -> list[int]:
        """Codons of a random sub-derivation that is at most `depth` choices deep if possible."""
        codons: list[int] = []
        stack = [(name, depth)]
        while stack:
            name, left = stack.pop()
            alternatives = self._below[name]
            chosen = 0
            if len(codons) + len(stack) > GROWTH_CODONS:
                left = 0
            if len(alternatives) > 1:
                chosen = _draw(self._within(name, left), rng)
                codons.append(_codon(chosen, len(alternatives), rng))
                left -= 1
            stack += [(child, left) for child in reversed(alternatives[chosen])]
        return codons

    def grow_to(self, depth: int, rng: np.random.Generator) -> Genome:
        """A random derivation that reaches `depth` somewhere if it can (Fagan et al. 2016).

        Position-independent grow: open non-terminals are expanded in random order, so that no place
        of the sentence is favoured; the last one that can still get deep must.
        """
        codons: dict[tuple[int, ...], int] = {}  # by the path from the top: sorted, it is preorder
        waiting: list[tuple[tuple[int, ...], str, int]] = [((), self.grammar.start, depth)]
        deepest = 0
        while waiting:
            path, name, left = waiting.pop(int(rng.integers(len(waiting))))
            alternatives = self._below[name]
            chosen = 0
            if len(codons) + len(waiting) > GROWTH_CODONS:
                left, deepest = 0, depth
            if len(alternatives) > 1:
                allowed = self._within(name, left)
                if deepest < depth and not any(other in self._recursive for _, other, _ in waiting):
                    deep = self._recursive.intersection
                    allowed = [at for at in allowed if deep(alternatives[at])] or allowed
                chosen = _draw(allowed, rng)
                codons[path] = _codon(chosen, len(alternatives), rng)
                left -= 1
                deepest = max(deepest, depth - left)
            children = enumerate(alternatives[chosen])
            waiting += [((*path, number), child, left) for number, child in children]
        return tuple(codons[path] for path in sorted(codons)) or (0,)

    def _within(self, name: str, depth: int) -> list[int]:
        """The alternatives that can end within a depth, or else those that end soonest."""
        depths = self._depths[name]
        most = max(depth, min(depths))
        return [at for at, least in enumerate(depths) if least <= most]

    def _choices_below(self, children: list[str]) -> list[str]:
        """The non-terminals with a choice that some lead to first, in order."""
        names: list[str] = []
        for child in children:
            alternatives = self._below[child]
            names += [child] if len(alternatives) > 1 else self._choices_below(alternatives[0])
        return names


def _children(alternative: Alternative) -> list[str]:
    return [symbol.name for symbol in alternative if isinstance(symbol, NonTerminal)]


def _is_scale(alternatives: Sequence[Alternative]) -> bool:
    """Whether they are numbers in ascending order, two or more."""
    try:
        numbers = [float("".join(map(str, alternative))) for alternative in alternatives]
    except ValueError:
        return False
    return len(numbers) > 1 and numbers == sorted(numbers)


def _by_name(nodes: list[Node]) -> dict[str, list[Node]]:
    """The nodes that read codons; none has a name twice for the same stretch of codons."""
    places: dict[str, list[Node]] = {}
    for node in nodes:
        if node.begin < node.end:
            places.setdefault(node.name, []).append(node)
    return places


def _reached_from(grammar: Grammar, name: str) -> set[str]:
    """The non-terminals that a derivation from a non-terminal may contain below it."""
    reached: set[str] = set()
    waiting = [name]
    while waiting:
        for alternative in grammar.rules[waiting.pop()]:
            fresh = set(_children(alternative)) - reached
            reached |= fresh
            waiting += sorted(fresh)
    return reached


def _least_depths(grammar: Grammar) -> dict[str, int]:
    """For every non-terminal, how many nested choices its shallowest derivation has."""
    depths: dict[str, int] = {}
    grown = True
    while grown:  # a grammar that was checked: every non-terminal ends
        grown = False
        for name, alternatives in grammar.rules.items():
            ready = [
                max((depths[child] for child in _children(one)), default=0)
                for one in alternatives
                if all(child in depths for child in _children(one))
            ]
            if ready and depths.get(name) != (least := min(ready) + (len(alternatives) > 1)):
                depths[name] = least
                grown = True
    return depths


def _codon(choice: int, n: int, rng: np.random.Generator) -> int:
    """A codon drawn uniformly among those that make a choice."""
    return choice + n * int(rng.integers((CODON_LIMIT - choice - 1) // n + 1))


def _draw(options: Sequence[Option], rng: np.random.Generator) -> Option:
    return options[int(rng.integers(len(options)))]
