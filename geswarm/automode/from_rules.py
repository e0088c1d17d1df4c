"""Rule sets over AutoMoDe's terms as machines; where a machine cannot do the same, what differs.

Rules that keep the machine's state in STATE, as `to_rules` writes them, come to the same machine,
also where their probabilities were edited. In other rules each behaviour is a state; a machine
takes a transition a step later than such rules, and looks at nothing in its first step in a state.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product

from geswarm.automode.as_rules import COMMENT, to_rules
from geswarm.automode.departures import Departure, departures_of
from geswarm.automode.drawing import neighbour_count
from geswarm.automode.fitting import solved, ways_to_say
from geswarm.automode.machine import MOST_TRANSITIONS, Machine, State, Transition
from geswarm.automode.modules import FLOORS, Condition
from geswarm.automode.options import AutoMoDeError
from geswarm.automode.situations import Situations, situations_of
from geswarm.automode.text import read_machines
from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import COMPARISONS, Precondition, Rule, RuleSet
from geswarm.rules.vocabulary import Vocabulary

_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Expressed:
    """What became of a rule set.

    Attributes:
        machine: The nearest that there is.
        departures: Where it does something else, the greatest difference for each state and floor.
    """

    machine: Machine
    departures: tuple[Departure, ...]


def from_rules(rule_set: RuleSet, vocabulary: Vocabulary) -> Expressed:
    """Write rules as a machine: the one that their comment holds, if it comes to these rules.

    Args:
        rule_set: Rules that are switched off are not looked at.
        vocabulary: Says where robots start.

    Raises:
        RuleSetError: It mentions what AutoMoDe does not have, or has too many states.
    """
    if (unchanged := _unchanged(rule_set)) is not None:
        return unchanged
    situations = situations_of(rule_set, vocabulary)
    states: list[State] = []
    departures: list[Departure] = []
    for number in range(len(situations.behaviours)):
        state, differing = _State(situations, number, rule_set).nearest()
        states.append(state)
        departures += differing
    return Expressed(Machine(tuple(states)), tuple(departures))


def _unchanged(rule_set: RuleSet) -> Expressed | None:
    """The machine of which these are the rules, by their comment; its text comes back as it was."""
    for line in rule_set.comment.split("\n"):
        if line.startswith(COMMENT):
            with suppress(AutoMoDeError):
                (machine,) = read_machines(line.removeprefix(COMMENT))
                conversion = to_rules(machine)
                if _bare(conversion.rule_set) == _bare(rule_set):
                    return Expressed(machine, conversion.departures)
    return None


def _bare(rule_set: RuleSet) -> tuple[Rule, ...]:
    return tuple(replace(rule, comment="") for rule in rule_set.active_rules)


@dataclass(frozen=True)
class _State:
    """A state that is to be found."""

    situations: Situations
    number: int
    rule_set: RuleSet

    def nearest(self) -> tuple[State, tuple[Departure, ...]]:
        """The state that does most nearly what the rules do, and what it does else.

        Raises:
            RuleSetError: It would have too many transitions.
        """
        counts = list(self._counts())
        chances = {floor: solved(self._leaving(floor, None)) for floor in FLOORS}
        ways = ways_to_say(chances)
        fitting = [each for each in ways if len(counts) + len(each) <= MOST_TRANSITIONS]
        if not fitting:
            behaviour = self.situations.behaviours[self.number]
            found = len(counts) + len(ways[-1])
            message = f"expected at most {MOST_TRANSITIONS} transitions from {behaviour}"
            finding = Finding(Place(), f"AutoMoDe: {message}, got {found}")
            raise RuleSetError([finding], self.rule_set.scenario)
        tried = ((*led, *always) for always in fitting for led in self._led(counts))
        judged = ((each, self._departures(each)) for each in tried)
        best, departures = min(
            judged, key=lambda each: max((one.distance for one in each[1]), default=0.0)
        )
        return State(self.situations.behaviours[self.number], best), departures

    def _led(self, counts: Sequence[Condition]) -> Iterator[tuple[Transition, ...]]:
        """Every way in which neighbour counts can lead to other states, or nowhere."""
        others = [k for k in range(len(self.situations.behaviours)) if k != self.number]
        for targets in product((*others, None), repeat=len(counts)):
            pairs = zip(targets, counts, strict=True)
            yield tuple(Transition(target, each) for target, each in pairs if target is not None)

    def _counts(self) -> Iterator[Condition]:
        """The neighbour counts that make a difference here, in the order of the rules."""
        mentioned = dict.fromkeys(
            condition
            for rule in self.rule_set.active_rules
            for each in rule.preconditions
            if (condition := neighbour_count(each))
        )
        for condition in mentioned:
            if any(
                _differ(self._leaving(floor, condition), self._leaving(floor, None))
                for floor in FLOORS
            ):
                yield condition

    def _leaving(self, floor: str, holding: Condition | None) -> dict[int, float]:
        """Probability of each other state if one neighbour count is true, or none."""

        def chance(precondition: Precondition) -> float:
            count = neighbour_count(precondition)
            return _on(precondition, floor) if count is None else float(count == holding)

        found = self.situations.following(self.number, chance)
        return {state: p for state, p in found.items() if state != self.number}

    def _departures(self, transitions: Sequence[Transition]) -> tuple[Departure, ...]:
        """Where a state with these transitions does something else."""
        states = [State(behaviour) for behaviour in self.situations.behaviours]
        states[self.number] = State(states[self.number].behaviour, tuple(transitions))
        machine = Machine(tuple(states))
        return tuple(departures_of(machine, self.number, self._does))

    def _does(self, floor: str, neighbours: int) -> Mapping[int, float]:
        """What the rules do for a reading."""

        def chance(precondition: Precondition) -> float:
            count = neighbour_count(precondition)
            return _on(precondition, floor) if count is None else count.chance(floor, neighbours)

        return self.situations.following(self.number, chance)


def _on(precondition: Precondition, floor: str) -> float:
    """Whether a precondition on the floor holds."""
    return float(COMPARISONS[precondition.comparison](floor, precondition.value))


def _differ(one: Mapping[int, float], other: Mapping[int, float]) -> bool:
    found: dict[int, float] = defaultdict(float, one)
    for state, p in other.items():
        found[state] -= p
    return any(abs(p) > _TOLERANCE for p in found.values())
