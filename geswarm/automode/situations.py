"""The states that rules over AutoMoDe's terms have, and what follows each of them."""

from __future__ import annotations

import re
import zlib
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from geswarm.automode.drawing import REGISTER, Doing, after_rules, neighbour_count
from geswarm.automode.machine import MOST_STATES
from geswarm.automode.modules import BEHAVIOURS, Behaviour
from geswarm.rules.findings import Finding, Place, RuleSetError
from geswarm.rules.model import Precondition, Rule, RuleSet, StateChange, Term
from geswarm.rules.vocabulary import Vocabulary

_VALUE = re.compile(r"(enter|in)(\d)([a-z]?)")
_BY_TERM = {each.term: each for each in BEHAVIOURS.values()}
_NOWHERE = Term("")
_AS_LIKELY = 1e-9


@dataclass(frozen=True)
class Situations:
    """What rules come to, state by state.

    Attributes:
        behaviours: Of each state; robots start in the first.
        rules: Those that are switched on.
        starts: What a robot does before a step in each state; each as probable as the others.
    """

    behaviours: tuple[Behaviour, ...]
    rules: tuple[Rule, ...]
    starts: tuple[tuple[Doing, ...], ...]

    def following(
        self, number: int, chance: Callable[[Precondition], float]
    ) -> Mapping[int, float]:
        """Probability of each state in the next step, for given chances of preconditions."""
        found: dict[int, float] = defaultdict(float)
        starts = self.starts[number]
        for start in starts:
            for then, p in after_rules(self.rules, start, chance).items():
                found[self._state_of(then)] += p / len(starts)
        return found

    def _state_of(self, doing: Doing) -> int:
        if match := _VALUE.fullmatch(doing.state):
            return int(match[2])
        return next(at for at, each in enumerate(self.starts) if doing in each)


def situations_of(rule_set: RuleSet, vocabulary: Vocabulary) -> Situations:
    """The states of rules: those of STATE if they change it, else the behaviours.

    Raises:
        RuleSetError: They mention what AutoMoDe does not have, or have too many states.
    """
    findings = list(_unknown(rule_set))
    rules = rule_set.active_rules
    if not findings:
        if any(each for rule in rules for each in _mentioning_state(rule)):
            found = _of_register(rules, vocabulary)
        else:
            found = _of_behaviours(rules, Term(vocabulary.initial_behaviour))
        if isinstance(found, Situations):
            return found
        findings.append(Finding(Place(), found))
    raise RuleSetError(findings, rule_set.scenario)


def _unknown(rule_set: RuleSet) -> Iterator[Finding]:
    """What AutoMoDe does not have."""
    for number, rule in enumerate(rule_set.rules, start=1):
        for element, problem in _in_rule(rule) if rule.enabled else ():
            if problem:
                yield Finding(Place(rule=number, element=element), problem)


def _in_rule(rule: Rule) -> Iterator[tuple[str, str | None]]:
    for at, precondition in enumerate(rule.preconditions, start=1):
        yield f"precondition {at}", _precondition_problem(precondition)
    for at, term in enumerate(rule.behaviours, start=1):
        yield f"behaviour {at}", _behaviour_problem(term)
    for at, action in enumerate(rule.actions, start=1):
        for term in action.behaviours:
            yield f"action {at}", _behaviour_problem(term)
        if action.target and action.target != REGISTER:
            yield f"action {at}", f"{action.target} has no counterpart in AutoMoDe"


def _precondition_problem(precondition: Precondition) -> str | None:
    if precondition.percept.name in ("FLOOR", REGISTER):
        return None
    try:
        known = neighbour_count(precondition)
    except ValueError as error:
        return f"{precondition.percept}: {error}"
    return None if known else f"{precondition.percept} has no counterpart in AutoMoDe"


def _behaviour_problem(term: Term) -> str | None:
    try:
        behaviour_of(term)
    except ValueError as error:
        return f"{term}: {error}"
    return None


def behaviour_of(term: Term) -> Behaviour:
    """The behaviour that rules call by a term.

    Raises:
        ValueError: AutoMoDe has none, or none with this argument.
    """
    if term.name not in _BY_TERM:
        raise ValueError("it has no counterpart in AutoMoDe")
    return Behaviour(_BY_TERM[term.name].number, *map(float, term.arguments))


def _of_behaviours(rules: tuple[Rule, ...], initial: Term) -> Situations | str:
    """Every behaviour that can come from the first is a state.

    Where it makes no difference that robots do not start with another one, they do: rules leave the
    first behaviour for that one before a robot acts.
    """
    at_once = after_rules(rules, Doing(initial), _some_chance)
    if Doing(initial) not in at_once:
        alike = (each for each in at_once if _same(after_rules(rules, each, _some_chance), at_once))
        initial = next(alike, Doing(initial)).behaviour
    if problem := _behaviour_problem(initial):
        return f"initial behaviour {initial}: {problem.partition(': ')[2]}"
    found, at = [initial], 0
    while at < len(found):
        after = after_rules(rules, Doing(found[at]), lambda _: 0.5)
        found += [each.behaviour for each in after if each.behaviour not in found]
        at += 1
    if len(found) > MOST_STATES:
        names = ", ".join(map(str, found))
        return f"AutoMoDe: expected at most {MOST_STATES} behaviours, got {names}"
    return Situations(
        tuple(map(behaviour_of, found)), rules, tuple((Doing(each),) for each in found)
    )


def _some_chance(precondition: Precondition) -> float:
    """Another one for each precondition: what is equal then is equal whatever a robot senses."""
    return 0.25 + zlib.crc32(str(precondition).encode()) / 2**33


def _of_register(rules: tuple[Rule, ...], vocabulary: Vocabulary) -> Situations | str:
    """The states that STATE stands for, if rules use it as imported ones do."""
    values = dict.fromkeys(str(each.value) for rule in rules for each in _mentioning_state(rule))
    matches = [_VALUE.fullmatch(each) for each in values]
    if None in matches or vocabulary.state_names[REGISTER].initially != "enter0":
        return f"{REGISTER}: expected enter0, in0, enter1 and so on, the first at the start"
    numbers = sorted({int(each[2]) for each in matches if each})
    if numbers != list(range(len(numbers))) or len(numbers) > MOST_STATES:
        return f"{REGISTER}: expected states 0 to {MOST_STATES - 1}, got {numbers}"
    entered = [after_rules(rules, Doing(_NOWHERE, f"enter{k}"), lambda _: 0.5) for k in numbers]
    for number, after in enumerate(entered):
        if problem := _entering_problem(rules, number, after):
            return problem
    return Situations(
        tuple(behaviour_of(next(iter(after)).behaviour) for after in entered),
        rules,
        tuple(tuple(sorted(after, key=lambda each: each.state)) for after in entered),
    )


def _mentioning_state(rule: Rule) -> Iterator[Precondition | StateChange]:
    yield from (each for each in rule.preconditions if each.percept.name == REGISTER)
    yield from (each for each in rule.actions if isinstance(each, StateChange))


def _entering_problem(
    rules: tuple[Rule, ...], number: int, after: Mapping[Doing, float]
) -> str | None:
    """Why a state of STATE is none of AutoMoDe's, or None."""
    inside = [each for each in after if each.state.startswith(f"in{number}")]
    started = {each.behaviour for each in after}
    if len(inside) < len(after) or len(started) > 1 or _NOWHERE in started:
        return f"{REGISTER}: expected enter{number} to start one behaviour and become in{number}"
    for here in inside:
        then = after_rules(rules, here, lambda _: 0.5)
        if any(each.behaviour != here.behaviour for each in then):
            return f"{REGISTER}: expected {here.state} to keep its behaviour"
        for each in then:
            if each not in inside and (
                not each.state.startswith("enter") or each.state == f"enter{number}"
            ):
                return (
                    f"{REGISTER}: expected {here.state} to stay in{number} or to become the "
                    f"enter of another state, got {each.state}"
                )
        if not _as_likely([then.get(each, 0.0) for each in inside]):
            return f"{REGISTER}: expected {here.state} to keep or change its letter by chance"
    if not _as_likely(list(after.values())):
        return f"{REGISTER}: expected enter{number} to become each in{number} as probably"
    return None


def _same(one: Mapping[Doing, float], other: Mapping[Doing, float]) -> bool:
    found = one.keys() | other.keys()
    return all(_as_likely([one.get(each, 0.0), other.get(each, 0.0)]) for each in found)


def _as_likely(chances: Sequence[float]) -> bool:
    return max(chances) - min(chances) < _AS_LIKELY
