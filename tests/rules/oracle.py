"""What the paper says a rule set does in one step, enumerated draw by draw, without matrices."""

from collections import defaultdict
from fractions import Fraction

from geswarm.rules import FORAGING, BehaviourChange


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
    holds = all(percepts[entry.name] == entry.holds for entry in rule.preconditions)
    executing = not rule.behaviours or now[0] in rule.behaviours
    actions = rule.actions if holds and executing else ()
    _actions(actions, later, percepts, now, probability, found)


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
        if action.behaviour != behaviour:
            restarts = {entry.name: entry.restarts for entry in FORAGING.behaviours}
            restarted = restarts[action.behaviour]
        return action.behaviour, states, restarted
    others = states - {action.state}
    return behaviour, others | {action.state} if action.value else others, restarted
