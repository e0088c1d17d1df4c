"""What a rule set never does: decided on its exact outcome distributions, not guessed.

Every statement is about the situations that `geswarm.rules.reachability` cannot rule out. A piece
has no effect if robots do the same with the same probabilities without it in all of them. Each
piece gets one finding, the most specific that is true.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence, Set
from dataclasses import replace
from typing import Any

import numpy as np

from geswarm.rules.control_table import active_part, apply_action
from geswarm.rules.elements import format_probability
from geswarm.rules.findings import Finding, Place, Severity
from geswarm.rules.model import Action, Precondition, Rule, RuleSet
from geswarm.rules.reachability import TOLERANCE, Trace, is_nothing, no_change
from geswarm.rules.space import FloatArray, Space
from geswarm.rules.vocabulary import FORAGING, Vocabulary

NO_EFFECT = "no effect: the robots do the same without it"
NOTHING_HELD = "there is no object to drop"


def diagnose(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> list[Finding]:
    """Warnings and hints, in the order of the rules, then those about the rule set as a whole.

    Rules that are switched off are not looked at.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    trace = Trace.of(rule_set, vocabulary)
    if not trace.rules:
        reason = "there is no rule that is switched on: robots only walk"
        return [Finding(Place(), reason, "warning")]
    numbers = [number for number, rule in enumerate(rule_set.rules, start=1) if rule.enabled]
    findings = [
        finding for at in range(len(trace.rules)) for finding in _rule_findings(trace, at, numbers)
    ]
    return findings + list(_whole_set_findings(trace))


def _finding(number: int, element: str, message: str, severity: Severity = "hint") -> Finding:
    return Finding(Place(rule=number, element=element), message, severity)


def _rule_findings(trace: Trace, at: int, numbers: Sequence[int]) -> Iterator[Finding]:
    """Findings about one rule, `at` among the enabled ones; `numbers` are those on the screen."""
    rule, number = trace.rules[at], numbers[at]
    impossible = list(_impossible_preconditions(rule, trace.space))
    yield from (_finding(number, *reason, "warning") for reason in impossible)
    if not rule.actions:
        yield _finding(number, "actions", "no action: this rule does nothing", "warning")
    if impossible or not rule.actions:
        return
    if (active := _when_active(trace, at)) is None:
        yield _finding(number, *_why_never(trace, at), "warning")
        return
    for index, action in enumerate(rule.actions, start=1):
        if action.p <= TOLERANCE:
            message = f"p = {format_probability(action.p)}: this action never happens"
            yield _finding(number, f"action {index}", message, "warning")
    if trace.matters(at, None):
        drawn = filter(trace.space.vocabulary.is_drawn, rule.preconditions)  # each time anew
        yield from _repeated(number, "precondition", rule.preconditions, frozenset(drawn))
        yield from _repeated(number, "behaviour", rule.behaviours)
        yield from _idle_preconditions(trace, at, number)
        yield from _idle_behaviours(trace, at, number)
        yield from _idle_actions(trace, at, numbers, active)
    elif any(action.p > TOLERANCE for action in rule.actions):
        yield _finding(number, "", f"no effect: {_why_idle_rule(trace, at, numbers, active)}")


def _impossible_preconditions(rule: Rule, space: Space) -> Iterator[tuple[str, str]]:
    """Element and reason of each precondition that no percept can meet together with the others."""
    for index, precondition in enumerate(rule.preconditions):
        if not space.can_hold([precondition]):
            reason = f"{precondition} never holds"
            yield f"precondition {index + 1}", f"{reason}: this rule never fires"
            continue
        for earlier, other in enumerate(rule.preconditions[:index], start=1):
            if space.can_hold([precondition, other]):
                continue
            if other.percept == precondition.percept:
                reason = f"contradicts precondition {earlier} ({other})"
            else:
                names = f"{_plain(precondition)} and {_plain(other)}"
                reason = f"{names} are never true together"
            yield f"precondition {index + 1}", f"{reason}: this rule never fires"
            break


def _plain(precondition: Precondition) -> str:
    """A precondition in few words: `ON_NEST` for `ON_NEST == true`."""
    return str(precondition.percept) if precondition.value is True else str(precondition)


def _when_active(trace: Trace, at: int) -> FloatArray | None:
    """The part of the distribution in which a rule is active; None if there is none."""
    active = trace.before[at] * active_part(trace.rules[at], trace.space)
    return active if active.any() else None


def _why_never(trace: Trace, at: int) -> tuple[str, str]:
    """Element and reason of a rule that is never active although percepts could be as it asks."""
    rule, objects = trace.rules[at], trace.space.vocabulary.objects
    for index in range(1, len(rule.preconditions) + 1):
        sensed = replace(rule, preconditions=rule.preconditions[:index], behaviours=())
        if (trace.before[at] * active_part(sensed, trace.space)).any():
            continue
        precondition = rule.preconditions[index - 1]
        holding = objects and precondition.percept.name == objects.holding
        reason = "no robot ever holds an object" if holding else f"{precondition} never holds"
        return f"precondition {index}", f"{reason}: this rule never fires"
    anywhere = replace(rule, preconditions=())
    elsewhere = (trace.before[at] * active_part(anywhere, trace.space)).any()
    behaviours = " or ".join(map(str, dict.fromkeys(rule.behaviours)))
    reason = _never_executed(behaviours, rule.preconditions if elsewhere else ())
    return "behaviours", f"{reason}: this rule never fires"


def _why_idle_rule(trace: Trace, at: int, numbers: Sequence[int], active: FloatArray) -> str:
    """Why a rule that fires does not matter: an earlier or later rule, or itself."""
    if (earlier := _made_idle_by(trace, at)) is not None:
        return f"rule {numbers[earlier]} makes it superfluous"
    actions, after = trace.rules[at].actions, active
    if not any(_changes(active, action, trace.space) for action in actions):
        already = _already_so(actions[0]) if len(actions) == 1 else "everything is already as set"
        return f"{already} whenever it fires"
    if not any(_has_effect(trace, active, action) for action in actions):
        return f"{NOTHING_HELD} whenever it fires"
    for action in actions:
        after = apply_action(after, action, trace.space)
    if is_nothing(after - active):
        return "its actions undo one another"
    return f"{_overriding_rule(trace, at, after - active, numbers)} overrides all that it changes"


def _changes(distribution: FloatArray, action: Action, space: Space) -> bool:
    """Whether there is anything that the action would change if it were drawn."""
    certain = _certain(action)
    return not np.array_equal(apply_action(distribution, certain, space), distribution)


def _has_effect(trace: Trace, distribution: FloatArray, action: Action) -> bool:
    """Whether the action would change anything that lasts if it were drawn and no rule followed."""
    done = apply_action(distribution, _certain(action), trace.space)
    return not is_nothing((done - distribution) @ trace.after[-1])


def _made_idle_by(trace: Trace, at: int) -> int | None:
    """The nearest earlier rule without which a rule would matter, on the reachable situations."""
    change = (trace.matrices[at] - no_change(trace.space)) @ trace.after[at + 1]
    for earlier in reversed(range(at)):
        if not is_nothing(trace.before[earlier] @ change):
            return earlier
        change = trace.matrices[earlier] @ change
    return None


def _overriding_rule(trace: Trace, at: int, difference: FloatArray, numbers: Sequence[int]) -> str:
    """The first later rule after which a difference is gone that does not last until the end."""
    later = at
    while not is_nothing(difference @ trace.after[-1]) and later + 1 < len(trace.rules):
        later += 1
        difference = difference @ trace.matrices[later]
    return f"rule {numbers[later]}"


def _repeated(
    number: int, kind: str, elements: Sequence[object], drawn: Set[object] = frozenset()
) -> Iterator[Finding]:
    for index, element in enumerate(elements, start=1):
        if element not in drawn and (first := elements.index(element) + 1) < index:
            yield _finding(number, f"{kind} {index}", f"no effect: the same as {kind} {first}")


def _idle_preconditions(trace: Trace, at: int, number: int) -> Iterator[Finding]:
    rule = trace.rules[at]
    for precondition in dict.fromkeys(rule.preconditions):
        others = tuple(other for other in rule.preconditions if other != precondition)
        if not trace.matters(at, replace(rule, preconditions=others)):
            index = rule.preconditions.index(precondition) + 1
            yield _finding(number, f"precondition {index}", NO_EFFECT)


def _idle_behaviours(trace: Trace, at: int, number: int) -> Iterator[Finding]:
    rule = trace.rules[at]
    if not rule.behaviours:
        return
    if not trace.matters(at, replace(rule, behaviours=())):
        message = "no effect: the robots do the same if the rule holds for any behaviour"
        yield _finding(number, "behaviours", message)
        return
    for behaviour in dict.fromkeys(rule.behaviours):
        others = tuple(other for other in rule.behaviours if other != behaviour)
        if not trace.matters(at, replace(rule, behaviours=others)):
            index = rule.behaviours.index(behaviour) + 1
            alone = replace(rule, behaviours=(behaviour,))
            met = (trace.before[at] * active_part(alone, trace.space)).any()
            never = f"no effect: {_never_executed(str(behaviour), rule.preconditions)}"
            yield _finding(number, f"behaviour {index}", NO_EFFECT if met else never)


def _never_executed(behaviours: str, sensed: Sequence[Precondition]) -> str:
    sensing = f" with {' and '.join(map(str, sensed))}" if sensed else ""
    return f"the behaviour is never {behaviours} when this rule's turn comes{sensing}"


def _idle_actions(
    trace: Trace, at: int, numbers: Sequence[int], active: FloatArray
) -> Iterator[Finding]:
    """Actions without effect in a rule that has one; p near 0 is another finding."""
    rule, space = trace.rules[at], trace.space
    for index, action in enumerate(rule.actions, start=1):
        element, done = f"action {index}", apply_action(active, action, space)
        if action.p > TOLERANCE and not _changes(active, action, space):
            already = f"no effect: {_already_so(action)} whenever this rule fires"
            yield _finding(numbers[at], element, already)
        elif action.p > TOLERANCE and not _has_effect(trace, active, action):
            nothing_held = f"no effect: {NOTHING_HELD} whenever this rule fires"
            yield _finding(numbers[at], element, nothing_held)
        elif action.p > TOLERANCE:
            difference, overriding = done - active, ""
            for later, other in enumerate(rule.actions[index:], start=index + 1):
                difference = apply_action(difference, other, space)
                if is_nothing(difference @ trace.after[-1]):
                    overriding = f"action {later}"
                    break
            if is_nothing(difference @ trace.after[at + 1]):
                overriding = overriding or _overriding_rule(trace, at, difference, numbers)
                yield _finding(numbers[at], element, f"no effect: {overriding} overrides it")
        active = done


def _already_so(action: Action) -> str:
    return f"{action.target or 'the behaviour'} is already {action.becomes}"


def _certain(action: Action) -> Action:
    changes: dict[str, Any] = {"p": 1.0}
    return replace(action, **changes)  # type: ignore[type-var]


def _whole_set_findings(trace: Trace) -> Iterator[Finding]:
    space = trace.space
    met = trace.reachable.reshape(space.percepts, len(space.behaviours), space.states)
    for at, behaviour in enumerate(space.behaviours):
        if not met[:, at].any():
            yield Finding(Place(), f"no robot ever changes to {behaviour}", "hint")
    if (objects := space.vocabulary.objects) is None:
        return
    if not trace.reachable[space.held].any():
        reason = f"objects are never picked up: {objects.wanting} is false from the first step on"
        yield Finding(Place(), reason, "warning")
    elif not _ever_true(trace.before[-1][space.held], objects.dropping, space):
        reason = f"objects are never dropped: {objects.dropping} is never set while one is held"
        yield Finding(Place(), reason, "warning")


def _ever_true(distribution: FloatArray, state: str, space: Space) -> bool:
    """Whether any outcome has an internal state true; distribution of shape (..., outcomes)."""
    columns = [
        outcome
        for outcome in range(space.outcomes)
        if space.state(space.describe_outcome(outcome)[1], state)
    ]
    return bool(distribution[..., columns].any())
