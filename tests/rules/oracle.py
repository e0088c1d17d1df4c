"""What the paper says a rule set does in one step, enumerated draw by draw, without matrices."""

from collections import defaultdict
from dataclasses import replace
from fractions import Fraction

import numpy as np

from geswarm.rules import FORAGING, BehaviourChange, ControlTable


def outcomes(rule_set, percepts, behaviour, states):
    """{(behaviour, states as frozenset of true names, restarted): exact probability}."""
    found = defaultdict(Fraction)
    rules = [rule for rule in rule_set.rules if rule.enabled]
    _rules(rules, percepts, (behaviour, frozenset(states), False), Fraction(1), found)
    return {outcome: probability for outcome, probability in found.items() if probability}


def _rules(rules, percepts, now, probability, found):
    if not rules:
        found[now] += probability
        return
    rule, later = rules[0], rules[1:]
    executing = not rule.behaviours or now[0] in map(str, rule.behaviours)
    actions = rule.actions if executing else ()
    _preconditions(rule.preconditions, actions, later, percepts, now, probability, found)


def _preconditions(preconditions, actions, later, percepts, now, probability, found):
    """A percept is true, false, or a Fraction: the chance that it is true, drawn for each rule."""
    if not preconditions:
        _actions(actions, later, percepts, now, probability, found)
        return
    entry, rest = preconditions[0], preconditions[1:]
    chance = Fraction(percepts[str(entry.percept)])
    if not entry.value:
        chance = 1 - chance
    if chance > 0:
        _preconditions(rest, actions, later, percepts, now, probability * chance, found)
    if chance < 1:
        _rules(later, percepts, now, probability * (1 - chance), found)


def _actions(actions, later, percepts, now, probability, found):
    if not actions:
        _rules(later, percepts, now, probability, found)
        return
    action, rest = actions[0], actions[1:]
    p = Fraction(action.p)
    if p < 1:
        _actions(rest, later, percepts, now, probability * (1 - p), found)
    if p > 0:
        _actions(rest, later, percepts, _done(action, now), probability * p, found)


def _done(action, now):
    behaviour, states, restarted = now
    if isinstance(action, BehaviourChange):
        target = str(action.behaviour)
        if target != behaviour:
            restarts = {entry.name: entry.restarts for entry in FORAGING.behaviours}
            restarted = restarts[target]
        return target, states, restarted
    others = states - {action.state}
    return behaviour, others | {action.state} if action.value else others, restarted


def effects(rule_set, percepts, behaviour, states):
    """`outcomes` by what a robot comes to: where none is held, dropping an object does nothing."""
    found = defaultdict(Fraction)
    for (after, true_states, restarted), p in outcomes(
        rule_set, percepts, behaviour, states
    ).items():
        left = true_states if percepts["HAS_OBJECT"] else true_states - {"DROP_OBJECT"}
        found[after, left, restarted] += p
    return dict(found)


def reachable(rule_set):
    """All situations (percepts, behaviour, true states) that a run can come to, by search."""
    found, waiting = [], [(False, "RANDOM_WALK", frozenset({"WANT_OBJECT"}))]
    seen = set(waiting)
    while waiting:
        holding, behaviour, states = waiting.pop()
        for on_nest, on_source in ((False, False), (True, False), (False, True)):
            percepts = {"ON_NEST": on_nest, "ON_SOURCE": on_source, "HAS_OBJECT": holding}
            found.append((percepts, behaviour, states))
            for after, true_states, _ in outcomes(rule_set, percepts, behaviour, states):
                still = holding and "DROP_OBJECT" not in true_states
                for holds in (False, True):
                    if holds != still and not (holds and "WANT_OBJECT" in true_states):
                        continue
                    body = (holds, after, true_states - {"DROP_OBJECT"})
                    if body not in seen:
                        seen.add(body)
                        waiting.append(body)
    return found


def differs(a, b):
    """Whether two rule sets act differently in a situation that a run under `a` can come to.

    From the control tables, which other tests hold against `outcomes`: enumeration takes too long.
    """
    one, two = (ControlTable.compile(each).probabilities for each in (a, b))
    seen, waiting = set(), [(False, 2 * 4 + 1)]
    while waiting:
        holding, inner = body = waiting.pop()
        if body in seen:
            continue
        seen.add(body)
        for percepts in (4, 5, 6) if holding else (0, 1, 2):
            row = percepts * 12 + inner
            difference = (one[row] - two[row]).reshape(3, 2, 4)  # behaviour, DROP_OBJECT, the rest
            if not holding:
                difference = difference.sum(axis=1)
            if np.abs(difference).max() > 1e-12:
                return True
            for outcome in np.flatnonzero(one[row]):
                after, states = divmod(int(outcome) // 2, 4)
                still = holding and not states & 2
                waiting += [(still, after * 4 + states % 2)]
                waiting += [(True, after * 4 + 1)] if states & 1 else []
    return False


def without_pieces(rule_set):
    """(rule number, element, the rule set without it) for every enabled rule and its pieces."""
    for at, rule in enumerate(rule_set.rules):
        if not rule.enabled:
            continue

        def with_rule(*rules, at=at):
            return replace(
                rule_set, rules=(*rule_set.rules[:at], *rules, *rule_set.rules[at + 1 :])
            )

        yield at + 1, "", with_rule()
        for part in ("preconditions", "behaviours", "actions"):
            elements = getattr(rule, part)
            for index in range(len(elements)):
                rest = elements[:index] + elements[index + 1 :]
                if rest or part != "behaviours":
                    changed = replace(rule, **{part: rest})
                    yield at + 1, f"{part[:-1]} {index + 1}", with_rule(changed)
        if rule.behaviours:
            yield at + 1, "behaviours", with_rule(replace(rule, behaviours=()))
