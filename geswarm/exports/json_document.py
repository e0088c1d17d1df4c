"""A rule set and its state machine as one JSON document.

What it holds is described by `rule-set.schema.json` beside this module (JSON Schema 2020-12).
Reading such a document takes the rules; the state machine follows from them.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from geswarm.rules.as_json import SCHEMA, Json, rule_set_to_json
from geswarm.rules.model import CONTROL_STEP, RuleSet
from geswarm.rules.state_machine import StateMachine, Transition
from geswarm.rules.vocabulary import FORAGING, Vocabulary

SCHEMA_FILE = Path(__file__).parent / "rule-set.schema.json"


def format_json_document(rule_set: RuleSet, vocabulary: Vocabulary = FORAGING) -> str:
    """Rules and state machine as JSON text, with a line for each state and transition.

    Raises:
        RuleSetError: A name is not in the vocabulary or a probability is outside [0, 1].
    """
    rules = {"schema": SCHEMA, **rule_set_to_json(rule_set)}
    head = json.dumps(rules, indent=2, ensure_ascii=False).removesuffix("\n}")
    machine = machine_to_json(StateMachine.of(rule_set, vocabulary))
    parts = [
        f'"step_seconds": {machine["step_seconds"]}',
        *(f'"{key}": {_lines(machine[key])}' for key in ("states", "transitions")),
    ]
    body = ",\n    ".join(parts)
    return f'{head},\n  "state_machine": {{\n    {body}\n  }}\n}}\n'


def _lines(values: list[Json]) -> str:
    """A list with one value on each line."""
    if not values:
        return "[]"
    lines = ",\n      ".join(json.dumps(value) for value in values)
    return f"[\n      {lines}\n    ]"


def machine_to_json(machine: StateMachine) -> dict[str, Json]:
    """A state machine as plain JSON values."""
    return {
        "step_seconds": CONTROL_STEP,
        "states": [
            {
                "behaviour": asdict(state.behaviour),
                "internal": dict(state.internal),
                "initial": state.initial,
            }
            for state in machine.states
        ],
        "transitions": [_transition(entry) for entry in machine.transitions],
    }


def _transition(transition: Transition) -> dict[str, Json]:
    return {
        "source": transition.source,
        "target": transition.target,
        "condition": [dict(term) for term in transition.condition.terms],
        "when": str(transition.condition),
        "probability": transition.probability,
        **({"varies": transition.rate} if transition.chances.varies else {}),
        "mean_wait": transition.mean_wait,
        "effects": dict(transition.effects),
        "restarts": transition.restarts,
        "rules": list(transition.rules),
    }
