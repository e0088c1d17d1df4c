"""A rule set as a controller script for ARGoS 3's foot-bot, complete in one Lua file.

The rules are written out one by one, with their comments; all else stands in `footbot.lua` beside
this module. Semantics and parameters are those of the model (paper, section 3.1.1).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from textwrap import wrap

from geswarm.exports.counterparts import require_counterparts
from geswarm.rules.elements import format_probability
from geswarm.rules.english import describe_rule
from geswarm.rules.model import Action, Precondition, Rule, RuleSet, format_value
from geswarm.rules.names import require_known_names
from geswarm.rules.vocabulary import FORAGING, Vocabulary
from geswarm.sim import Scenario, vocabulary_of

_TEMPLATE = Path(__file__).parent / "footbot.lua"
_WIDTH = 94
"""Characters of a line of a comment, without the dashes."""
_KNOWN = (*FORAGING.behaviour_names, *FORAGING.percepts, *FORAGING.state_names)


def format_argos_lua(rule_set: RuleSet, scenario: Scenario) -> str:
    """The controller script.

    Raises:
        RuleSetError: A p is outside [0, 1].
        CounterpartError: It mentions a term that is none of foraging's.
    """
    require_counterparts(rule_set, "the controller script", _KNOWN)
    require_known_names(replace(rule_set, rules=rule_set.active_rules))
    parts = {
        "HEADER": _header(rule_set),
        "PARAMETERS": _parameters(scenario),
        "RULES": _rules(rule_set, vocabulary_of(scenario)),
        "START": _start(scenario),
        "CLEAR": _clear(),
    }
    lines: list[str] = []
    for line in _TEMPLATE.read_text(encoding="utf-8").splitlines():
        lines += parts[line.strip("@")] if line.startswith("@") else [line]
    return "\n".join(lines) + "\n"


def _header(rule_set: RuleSet) -> Iterator[str]:
    yield from _comment(rule_set.name or "Rule set", "")
    if rule_set.comment:
        yield from ("--", *_comment(rule_set.comment, ""))
    yield "--"
    yield "-- Controller of a foot-bot in ARGoS 3, written by GESwarm."
    yield "--"


def _parameters(scenario: Scenario) -> Iterator[str]:
    shortest, longest = scenario.random_walk
    yield from _comment(f"Scenario: {scenario.name}", "")
    for name, value, meaning in (
        ("ZONE_MISS", scenario.zone_miss, "probability per step to perceive neither zone"),
        ("WALK_MIN", shortest, "s, shortest time for which a random heading is kept"),
        ("WALK_MAX", longest, "s, longest"),
        ("MAX_SPEED", scenario.max_speed, "m/s, of a wheel"),
        ("TURN_GAIN", scenario.turn_gain, "1/s, turning speed per angle"),
        ("PROXIMITY_RANGE", scenario.proximity_range, "m, at which a wall is avoided"),
        (
            "RAB_RANGE",
            scenario.avoidance_range or scenario.rab_range,
            "m, at which another robot is avoided",
        ),
        ("AVOIDANCE_GAIN", scenario.avoidance_gain, "weight of avoidance"),
    ):
        yield f"{f'local {name} = {format_probability(value)}':<34} -- {meaning}"


def _start(scenario: Scenario) -> Iterator[str]:
    yield f'  BEHAVIOUR = "{scenario.initial_behaviour}"'
    for state in FORAGING.internal_states:
        yield f"  {state.name} = {format_value(state.initially)}"


def _clear() -> Iterator[str]:
    for state in FORAGING.internal_states:
        if state.momentary:
            yield f"  {state.name} = false"


def _rules(rule_set: RuleSet, vocabulary: Vocabulary) -> Iterator[str]:
    for number, rule in enumerate(rule_set.rules, start=1):
        if number > 1:
            yield ""
        yield from _comment(f"R{number}: {rule.comment or describe_rule(rule, vocabulary)}", "  ")
        if rule.enabled:
            yield from _rule(rule)
        else:
            yield "  -- (switched off)"


def _rule(rule: Rule) -> Iterator[str]:
    conditions = [_precondition(entry) for entry in rule.preconditions]
    executing = [f'BEHAVIOUR == "{name}"' for name in rule.behaviours]
    if len(executing) > 1:
        conditions.append(f"({' or '.join(executing)})")
    else:
        conditions += executing
    yield f"  if {' and '.join(conditions) or 'true'} then"
    for action in rule.actions:
        yield f"    if chance({format_probability(action.p)}) then {_deed(action)} end"
    yield "  end"


def _precondition(precondition: Precondition) -> str:
    percept = precondition.percept.name.lower()
    return percept if FORAGING.holds(precondition, True) else f"not {percept}"


def _deed(action: Action) -> str:
    if action.target:
        return f"{action.target} = {action.becomes}"
    return f'change_to("{action.becomes}")'


def _comment(text: str, indent: str) -> Iterator[str]:
    """Free text as comment lines; the space keeps `[[` from opening a long comment."""
    for line in text.split("\n"):
        for part in wrap(line, _WIDTH - len(indent)) or [""]:
            yield f"{indent}-- {part}".rstrip()
