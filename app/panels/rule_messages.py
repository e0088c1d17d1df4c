"""What the rule table page is told, made of the session's state."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict

import numpy as np
from msgspec import UNSET

from geswarm.rules import (
    Finding,
    RuleSet,
    Simplification,
    Vocabulary,
    describe,
    format_text,
)
from geswarm.rules.arguments import Argument
from geswarm.rules.text import format_rule
from geswarm.sim import Scenario, World, WorldState, vocabulary_of

from .. import palette
from ..protocol import rules as wire
from ..protocol.base import NoticeMessage
from ..state.document import RuleDocument
from ..state.insight import Insight
from ..state.journal import Unsaved
from ..state.rival import presets_of
from ..state.states import Activity, DrawnMachine
from ..state.verdict import RUNS, Answer
from ..state.worth import WorthAnswer


def vocabulary_message(scenario: Scenario) -> wire.VocabularyMessage:
    """The names that rules are made of, with their colours, the presets, and the objective."""
    vocabulary, objective = vocabulary_of(scenario), scenario.objective
    colours = palette.behaviour_colours(vocabulary)
    return wire.VocabularyMessage(
        preconditions=tuple(
            wire.PerceptOffer(
                name=entry.name,
                holds=entry.holds,
                fails=entry.fails,
                arguments=_arguments(entry.arguments),
                values=tuple(vocabulary.values_of(entry.name)),
                comparisons=tuple(vocabulary.comparisons_of(entry.name)),
            )
            for entry in vocabulary.percepts.values()
        ),
        behaviours=tuple(
            wire.BehaviourOffer(
                name=entry.name,
                doing=entry.doing,
                colour=palette.css(colour),
                arguments=_arguments(entry.arguments),
            )
            for entry, colour in zip(vocabulary.behaviours, colours, strict=True)
        ),
        internal_states=tuple(
            wire.StateOffer(
                name=entry.name,
                on=entry.on,
                off=entry.off,
                values=tuple(entry.values),
                counts=entry.counts,
            )
            for entry in vocabulary.internal_states
        ),
        probabilities=tuple(vocabulary.probabilities),
        presets=tuple(
            wire.PresetOffer(name, preset.name) for name, preset in presets_of(vocabulary).items()
        ),
        objective=wire.ObjectiveOffer(
            objective.expression, objective.unit, objective.label, objective.maximise
        ),
    )


def _arguments(arguments: Iterable[Argument]) -> tuple[wire.ArgumentOffer, ...]:
    return tuple(wire.ArgumentOffer(each.name, each.unit, each.offered) for each in arguments)


def rules_message(
    document: RuleDocument, insight: Insight | None, vocabulary: Vocabulary
) -> wire.RulesMessage:
    """The rules as they stand, in all their forms, with what is known of them so far."""
    rule_set = document.rule_set
    known = insight if insight is not None and insight.version == document.version else None
    return wire.RulesMessage(
        version=document.version,
        can_undo=document.can_undo,
        can_redo=document.can_redo,
        rule_set=rule_set,
        english=tuple(describe(rule_set, vocabulary)),
        text=format_text(rule_set),
        rule_texts=tuple(format_rule(rule) for rule in rule_set.rules),
        loaded=document.loaded,
        loaded_text=format_text(document.loaded),
        findings=placed(known.findings) if known else (),
        simpler=len(known.simplification.removed) if known else UNSET,
    )


def simplified_message(version: int, simplification: Simplification) -> wire.SimplifiedMessage:
    """The shortest rules that behave as those of a version, and what they leave out."""
    return wire.SimplifiedMessage(
        version=version,
        rule_set=simplification.rule_set,
        text=format_text(simplification.rule_set),
        removed=tuple(simplification.removed),
    )


def placed(findings: Iterable[Finding]) -> tuple[wire.RuleFinding, ...]:
    """Findings with their places; rules count from 1."""
    return tuple(
        wire.RuleFinding(
            line=finding.place.line,
            rule=finding.place.rule,
            element=finding.place.element,
            message=finding.message,
            severity=finding.severity,
        )
        for finding in findings
    )


def live_message(state: WorldState, vocabulary: Vocabulary) -> wire.LiveMessage:
    """What the swarm does now."""
    robots = np.bincount(state.behaviour, minlength=len(vocabulary.behaviours))
    return wire.LiveMessage(
        time=state.time,
        fired=tuple(state.rule_counts.tolist()),
        behaviours=tuple(robots.tolist()),
        robots=len(state.behaviour),
    )


def verdict_message(answer: Answer | None) -> wire.VerdictMessage:
    """What is known of the verdict."""
    if answer is None:
        return wire.VerdictMessage(version=0, busy=True)
    return wire.VerdictMessage(
        version=answer.question.version,
        busy=answer.busy,
        scenario=answer.question.scenario.name,
        runs=RUNS,
        samples=tuple(
            wire.RoleSample(sample.role, sample.name, tuple(sample.fitness.tolist()))
            for sample in answer.samples
        ),
        comparisons=tuple(
            wire.RoleComparison(role, **asdict(comparison))
            for role, comparison in answer.comparisons.items()
        ),
    )


def worth_message(answer: WorthAnswer) -> wire.WorthMessage:
    """What is known of the worth of each piece."""
    return wire.WorthMessage(
        version=answer.version,
        busy=answer.busy,
        done=len(answer.worths),
        total=answer.total,
        pieces=tuple(
            wire.WeighedPiece(**asdict(worth.piece), **asdict(worth.change))
            for worth in answer.worths
        ),
    )


def states_message(drawn: DrawnMachine) -> wire.StatesMessage:
    """The state machine of the rules and its picture."""
    machine = drawn.machine
    names = machine.space.vocabulary.behaviour_names
    return wire.StatesMessage(
        svg=drawn.svg,
        states=tuple(
            wire.DrawnState(
                label=state.label,
                behaviour=state.behaviour,
                means=", ".join(
                    [names[state.behaviour.name].says(state.behaviour)[0]]
                    + [f"{name} is {str(value).lower()}" for name, value in state.internal]
                ),
                initial=state.initial,
            )
            for state in machine.states
        ),
        transitions=tuple(
            wire.DrawnTransition(
                source=entry.source,
                target=entry.target,
                when=str(entry.condition),
                rate=entry.rate,
                effects=tuple(machine.effects(entry)),
                rules=tuple(entry.rules),
                words=machine.describe(entry),
            )
            for entry in machine.transitions
        ),
    )


def activity_message(activity: Activity, world: World) -> wire.ActivityMessage:
    """What the swarm does in the state machine that was sent last."""
    return wire.ActivityMessage(world.time, activity.robots, activity.taken, world.scenario.robots)


def journal_message(problem: str) -> NoticeMessage:
    """Why rules that are not saved are not kept; empty once they are."""
    words = f"If the dashboard is killed, rules that were not saved are lost: {problem}"
    return NoticeMessage("error", words if problem else "", about="journal")


def stale_message(version: int) -> wire.StaleMessage:
    """A change was not made: it was meant for a version that is no longer there."""
    words = "Somebody else changed the rules just then: look at them, and do it again."
    return wire.StaleMessage(version, words)


def unsaved_message(left: Iterable[Unsaved]) -> wire.UnsavedMessage:
    """Rules that killed dashboards left."""
    return wire.UnsavedMessage(
        tuple(
            wire.UnsavedRules(
                file=unsaved.path.name,
                name=unsaved.rule_set.name,
                rules=len(unsaved.rule_set.rules),
                edited=unsaved.edited,
            )
            for unsaved in left
        )
    )


def file_message(rule_set: RuleSet, text: str, suffix: str) -> wire.FileMessage:
    """A file to download, named after the rule set."""
    letters = "".join(char if char.isalnum() else "-" for char in rule_set.name.lower())
    stem = "-".join(filter(None, letters.split("-"))) or "rules"
    return wire.FileMessage(f"{stem}.{suffix}", text)
