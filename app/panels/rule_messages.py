"""What the rule table page is told, as JSON values (see static/protocol.js)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict

import numpy as np

from geswarm.rules import (
    FORAGING,
    Finding,
    RuleSet,
    Simplification,
    describe,
    format_text,
    load_preset,
    preset_names,
)
from geswarm.rules.arguments import Argument
from geswarm.rules.as_json import rule_set_to_json
from geswarm.rules.text import format_rule
from geswarm.sim import World, WorldState

from .. import palette
from ..server.channel import Message
from ..state.document import RuleDocument
from ..state.insight import Insight
from ..state.journal import Unsaved
from ..state.states import Activity, DrawnMachine
from ..state.verdict import RUNS, Answer
from ..state.worth import WorthAnswer


def vocabulary_message() -> Message:
    """The names that rules are made of, with their colours, and the presets."""
    return {
        "type": "vocabulary",
        "preconditions": [
            {
                "name": entry.name,
                "holds": entry.holds,
                "fails": entry.fails,
                "arguments": _arguments_json(entry.arguments),
                "values": list(FORAGING.values_of(entry.name)),
                "comparisons": list(FORAGING.comparisons_of(entry.name)),
            }
            for entry in FORAGING.percepts.values()
        ],
        "behaviours": [
            {
                "name": entry.name,
                "doing": entry.doing,
                "colour": palette.css(palette.behaviour_colour(code)),
                "arguments": _arguments_json(entry.arguments),
            }
            for code, entry in enumerate(FORAGING.behaviours)
        ],
        "internal_states": [
            {
                "name": entry.name,
                "on": entry.on,
                "off": entry.off,
                "values": list(entry.values),
                "counts": entry.counts,
            }
            for entry in FORAGING.internal_states
        ],
        "probabilities": list(FORAGING.probabilities),
        "presets": [{"name": name, "title": load_preset(name).name} for name in preset_names()],
    }


def _arguments_json(arguments: Iterable[Argument]) -> list[Message]:
    return [
        {"name": each.name, "unit": each.unit, "offered": list(each.offered)} for each in arguments
    ]


def rules_message(document: RuleDocument, insight: Insight | None) -> Message:
    """The rules as they stand, in all their forms, with what is known of them so far."""
    rule_set = document.rule_set
    known: Message = {"findings": []}
    if insight is not None and insight.version == document.version:
        known = {
            "findings": findings_json(insight.findings),
            "simpler": len(insight.simplification.removed),
        }
    return {
        "type": "rules",
        "version": document.version,
        "can_undo": document.can_undo,
        "can_redo": document.can_redo,
        "rule_set": rule_set_to_json(rule_set),
        "english": describe(rule_set),
        "text": format_text(rule_set),
        "rule_texts": [format_rule(rule) for rule in rule_set.rules],
        "loaded": rule_set_to_json(document.loaded),
        "loaded_text": format_text(document.loaded),
        **known,
    }


def simplified_message(version: int, simplification: Simplification) -> Message:
    """The shortest rules that behave as those of a version, and what they leave out."""
    return {
        "type": "simplified",
        "version": version,
        "rule_set": rule_set_to_json(simplification.rule_set),
        "text": format_text(simplification.rule_set),
        "removed": list(simplification.removed),
    }


def findings_json(findings: Iterable[Finding]) -> list[Message]:
    """Findings with their places; rules count from 1."""
    return [
        {
            "line": finding.place.line,
            "rule": finding.place.rule,
            "element": finding.place.element,
            "message": finding.message,
            "severity": finding.severity,
        }
        for finding in findings
    ]


def live_message(state: WorldState) -> Message:
    """What the swarm does now."""
    robots = np.bincount(state.behaviour, minlength=len(FORAGING.behaviours))
    return {
        "type": "live",
        "time": state.time,
        "fired": state.rule_counts.tolist(),
        "behaviours": robots.tolist(),
        "robots": len(state.behaviour),
    }


def verdict_message(answer: Answer | None) -> Message:
    """What is known of the verdict."""
    if answer is None:
        return {"type": "verdict", "version": 0, "busy": True, "samples": [], "comparisons": []}
    return {
        "type": "verdict",
        "version": answer.question.version,
        "scenario": answer.question.scenario.name,
        "runs": RUNS,
        "busy": answer.busy,
        "samples": [
            {"role": sample.role, "name": sample.name, "collected": sample.collected.tolist()}
            for sample in answer.samples
        ],
        "comparisons": [
            {"role": role, **asdict(comparison)} for role, comparison in answer.comparisons.items()
        ],
    }


def worth_message(answer: WorthAnswer) -> Message:
    """What is known of the worth of each piece."""
    return {
        "type": "worth",
        "version": answer.version,
        "busy": answer.busy,
        "done": len(answer.worths),
        "total": answer.total,
        "pieces": [{**asdict(worth.piece), **asdict(worth.change)} for worth in answer.worths],
    }


def states_message(drawn: DrawnMachine) -> Message:
    """The state machine of the rules and its picture."""
    machine = drawn.machine
    names = machine.space.vocabulary.behaviour_names
    return {
        "type": "states",
        "svg": drawn.svg,
        "states": [
            {
                "label": state.label,
                "behaviour": asdict(state.behaviour),
                "means": ", ".join(
                    [names[state.behaviour.name].says(state.behaviour)[0]]
                    + [f"{name} is {str(value).lower()}" for name, value in state.internal]
                ),
                "initial": state.initial,
            }
            for state in machine.states
        ],
        "transitions": [
            {
                "source": entry.source,
                "target": entry.target,
                "when": str(entry.condition),
                "rate": entry.rate,
                "effects": list(machine.effects(entry)),
                "rules": list(entry.rules),
                "words": machine.describe(entry),
            }
            for entry in machine.transitions
        ],
    }


def activity_message(activity: Activity, world: World) -> Message:
    """What the swarm does in the state machine that was sent last."""
    return {
        "type": "activity",
        "time": world.time,
        "robots": list(activity.robots),
        "taken": list(activity.taken),
        "swarm": world.scenario.robots,
    }


def notice_message(text: str) -> Message:
    """Something that could not be done."""
    return {"type": "notice", "level": "error", "text": text}


def journal_message(problem: str) -> Message:
    """Why rules that are not saved are not kept; empty once they are."""
    words = f"If the dashboard is killed, rules that were not saved are lost: {problem}"
    return {**notice_message(words if problem else ""), "about": "journal"}


def stale_message(refused: Message) -> Message:
    """A change was not made: it was meant for a version that is no longer there."""
    return {
        "type": "stale",
        "version": refused.get("version"),
        "text": "Somebody else changed the rules just then: look at them, and do it again.",
    }


def unsaved_message(left: Iterable[Unsaved]) -> Message:
    """Rules that killed dashboards left; `edited` in seconds since 1970."""
    return {
        "type": "unsaved",
        "left": [
            {
                "file": unsaved.path.name,
                "name": unsaved.rule_set.name,
                "rules": len(unsaved.rule_set.rules),
                "edited": unsaved.edited,
            }
            for unsaved in left
        ],
    }


def file_message(rule_set: RuleSet, text: str, suffix: str) -> Message:
    """A file to download, named after the rule set."""
    letters = "".join(char if char.isalnum() else "-" for char in rule_set.name.lower())
    stem = "-".join(filter(None, letters.split("-"))) or "rules"
    return {"type": "file", "name": f"{stem}.{suffix}", "text": text}
