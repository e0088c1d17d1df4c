"""What the evolution page is told, made of the session's state."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, fields
from typing import cast

import numpy as np

from geswarm import __version__
from geswarm.evaluation import shown as figure
from geswarm.evolution import Member
from geswarm.ge import CHOICES, PRESETS, STEERABLE, Settings, StoredIndividual, fall_in_words
from geswarm.rules import RuleSet, describe
from geswarm.rules.text import format_rule
from geswarm.sim import Scenario, vocabulary_of

from .. import palette
from ..docstrings import explanations
from ..protocol import evolution as wire
from ..state.behaviours import Label
from ..state.evolution import Phase
from ..state.look import Chosen, Look, main_line
from ..state.plan import RunPlan, idle_settings, preset_of
from ..state.run_folder import RunSummary
from ..state.runs import MOST_COMPARED, Runs

MOST_POINTS = 600
"""Of a curve; more cannot be told apart on a screen."""
MOST_ROWS = 300
"""Individuals listed."""
_BINS = 24
_KINDS: dict[type, wire.FieldKind] = {
    bool: "switch",
    int: "whole",
    float: "number",
    str: "choice",
}


def form_message() -> wire.FormMessage:
    """All parameters that a run has: name, kind, explanation, and the presets that fill them."""
    explained = explanations(Settings)
    return wire.FormMessage(
        presets=tuple(PRESETS),
        most_compared=MOST_COMPARED,
        fields=tuple(
            wire.SettingField(
                name=field.name,
                kind=_KINDS[type(field.default)],
                choices=tuple(CHOICES.get(field.name, ())),
                help=explained.get(field.name, ""),
                steerable=field.name in STEERABLE,
            )
            for field in fields(Settings)
        ),
    )


def plan_message(plan: RunPlan, scenario: Scenario, rule_set: RuleSet) -> wire.PlanMessage:
    """The next run as planned, with what is wrong with it."""
    frozen = plan.frozen_rules(rule_set)
    moved = frozen != rule_set.active_rules[: len(frozen)]
    return wire.PlanMessage(
        preset=plan.preset,
        values=dict(plan.values),
        changed=tuple(plan.changed(scenario)),
        idle=tuple(idle_settings(plan.values)),
        findings=plan.findings(scenario, rule_set),
        seed=plan.seed,
        from_table=plan.from_table,
        scenario=scenario.name,
        table=rule_set.name,
        rules=tuple(
            wire.TableRule(rule.comment or sentence, rule in frozen, rule.enabled)
            for rule, sentence in zip(
                rule_set.rules, describe(rule_set, vocabulary_of(scenario)), strict=True
            )
        ),
        moved=moved,
    )


def status_message(runs: Runs) -> wire.EvolutionMessage:
    """What the evolution does now, and which run is looked at."""
    evolution, look = runs.evolution, runs.look
    shown, directory = runs.shown, evolution.directory
    settings = evolution.settings if evolution.active else None
    about = _about(look) if look and shown == look.directory else None
    return wire.EvolutionMessage(
        phase=_named(evolution.phase),
        active=evolution.active,
        error=evolution.error,
        run=directory.name if directory else None,
        remarks=tuple(evolution.remarks),
        resumable=_is_resumable(runs),
        done=len(evolution.history),
        generations=evolution.generations,
        shown=shown.name if shown else None,
        problem=runs.problem,
        about=about,
        settings={} if settings is None else settings.steerable,
        idle=() if settings is None else tuple(idle_settings(asdict(settings))),
    )


def _named(phase: Phase) -> wire.PhaseName:
    return cast(wire.PhaseName, phase.name)


def _is_resumable(runs: Runs) -> bool:
    """The run looked at can go on, perhaps with more generations than it was to have."""
    shown, evolution = runs.shown, runs.evolution
    if shown is None or runs.is_active(shown.name):
        return False
    if runs.shows_present and evolution.phase in (Phase.STOPPED, Phase.FAILED):
        return True
    return runs.shown_look is not None and not runs.is_elsewhere(shown.name)


def _about(look: Look) -> wire.AboutRun:
    config, last = look.config, look.history[-1] if look.history else None
    return wire.AboutRun(
        scenario=config.scenario.name,
        preset=_preset(look.config.settings),
        seed=config.seed,
        frozen=len(config.frozen),
        generations=config.settings.generations,
        done=len(look.history),
        finished=look.finished,
        version=config.version if config.version != __version__ else None,
        best=last.best_so_far if last else None,
        fall=fall_in_words([record.best_so_far for record in look.history], figure) if last else "",
        mean=last.mean if last else None,
    )


def _preset(settings: Settings) -> wire.NearestPreset:
    name, changed = preset_of(settings)
    return wire.NearestPreset(name, tuple(changed))


def curves_message(runs: Runs) -> wire.CurvesMessage:
    """The curves of the run looked at, the references, and what people did to it."""
    look = runs.look
    history = [] if look is None else [look.history[at] for at in thinned(len(look.history))]
    references = runs.references if look is runs.shown_look else {}
    return wire.CurvesMessage(
        run=look.directory.name if look else None,
        label=look.config.scenario.objective.gain_label if look else "",
        reevaluated=look is not None and look.config.settings.reevaluate_elites,
        generation=tuple(record.generation for record in history),
        best_so_far=tuple(_short(record.best_so_far) for record in history),
        best=tuple(_short(record.best) for record in history),
        mean=tuple(_short(record.mean) for record in history),
        references=tuple(
            wire.ReferenceLevel(name, _short(mean)) for name, mean in references.items()
        ),
        marks=tuple(wire.CurveMark(**asdict(mark)) for mark in look.marks) if look else (),
    )


def compared_message(runs: Runs) -> wire.ComparedRunsMessage:
    """The best so far of the runs that are compared, each with the number of its colour."""
    return wire.ComparedRunsMessage(
        tuple(_other_curve(summary, runs) for summary in runs.kept if summary.name in runs.compared)
    )


def _other_curve(summary: RunSummary, runs: Runs) -> wire.OtherCurve:
    values, config = runs.best_so_far(summary), summary.config
    at = thinned(len(values))
    return wire.OtherCurve(
        name=summary.name,
        colour=runs.compared[summary.name],
        reevaluated=config is not None and config.settings.reevaluate_elites,
        generation=tuple(i + 1 for i in at),
        best_so_far=tuple(_short(values[i]) for i in at),
    )


def thinned(length: int) -> list[int]:
    """Indices of at most `MOST_POINTS` of so many points, the first and the last among them."""
    points = np.linspace(0, length - 1, min(length, MOST_POINTS))
    return [int(at) for at in points.round()]


def population_message(look: Look | None) -> wire.PopulationMessage:
    """The individuals of the last generation, the best first, and how they differ."""
    members = look.population.members if look else ()
    labels = look.labels if look else {}
    counts = Counter(labels[one.behaviour] for one in members if one.behaviour is not None)
    coloured = [
        (label.number, counts[label], palette.css(palette.POPULATION[label.colour]))
        for label in counts
        if label.colour is not None
    ]
    fitness = [one.fitness for one in members]
    return wire.PopulationMessage(
        generation=len(look.history) if look else 0,
        size=len(members),
        invalid=sum(one.rule_set is None for one in members),
        behaviours=look.population.behaviours if look else 0,
        diversity=round(look.population.diversity, 2) if look else 0,
        coloured=tuple(sorted(coloured)),
        fitness=histogram(fitness),
        codons=histogram([one.codons for one in members]),
        members=tuple(_row(one, labels) for one in members[:MOST_ROWS]),
    )


def _row(one: Member, labels: Mapping[str, Label]) -> wire.IndividualRow:
    return wire.IndividualRow(
        generation=one.generation,
        key=one.key,
        fitness=_short(one.fitness),
        evaluations=one.told,
        codons=one.codons,
        rules=len(one.rule_set.rules) if one.rule_set else None,
        behaviour=None if one.behaviour is None else labels[one.behaviour].number,
    )


def histogram(values: Sequence[float]) -> wire.Histogram:
    """How many values lie in each of equally wide bins, and the mean of all."""
    if not values:
        return wire.Histogram(low=0, high=0, mean=0, counts=())
    low, high = min(values), max(values)
    counts, _ = np.histogram(values, _BINS, (low, high) if high > low else (low - 0.5, low + 0.5))
    return wire.Histogram(
        low=_short(low),
        high=_short(high),
        mean=_short(sum(values) / len(values)),
        counts=tuple(counts.tolist()),
    )


def ancestors_message(look: Look | None) -> wire.AncestorsMessage:
    """Whom the best descends from: all of them, and the line of first parents, newest first."""
    ancestors = look.ancestors[-MOST_ROWS:] if look else ()
    line = main_line(look.ancestors)[:MOST_ROWS] if look else []
    phenotypes = (
        {(one.generation, one.key): one.phenotype for one in look.ancestors} if look else {}
    )
    return wire.AncestorsMessage(
        all=tuple(wire.AncestorRow(*_place(one), one.parents) for one in ancestors),
        line=tuple(
            wire.DescentRow(*_place(one), how_bred(one, phenotypes), one.codons) for one in line
        ),
    )


def _place(one: StoredIndividual) -> tuple[int, int, float]:
    return one.generation, one.key, _short(one.fitness)


def how_bred(one: StoredIndividual, phenotypes: dict[tuple[int, int], str | None]) -> str:
    """By what an individual came about."""
    if not one.parents:
        return "initial" if one.generation == 1 else "injected"
    if one.phenotype == phenotypes.get(one.parents[0]):
        return "unchanged"
    return "crossover" if len(one.parents) > 1 else "mutation"


def runs_message(runs: Runs) -> wire.RunsMessage:
    """All runs that are kept."""
    return wire.RunsMessage(tuple(_run(summary, runs) for summary in runs.kept))


def _run(summary: RunSummary, runs: Runs) -> wire.KeptRun:
    """A run; of the one under way what its thread knows, which is newer than its directory."""
    active = runs.is_active(summary.name)
    config, evolution = summary.config, runs.evolution
    values = runs.best_so_far(summary)
    generations = config.settings.generations if config else None
    return wire.KeptRun(
        name=summary.name,
        colour=runs.compared.get(summary.name),
        elsewhere=runs.is_elsewhere(summary.name),
        problem=summary.problem,
        scenario=config.scenario.name if config else "",
        preset=_preset(config.settings) if config else None,
        seed=config.seed if config else None,
        done=len(values),
        generations=evolution.generations if active else generations,
        best=_short(values[-1]) if values else None,
        fall=fall_in_words(values, figure) if values else "",
        phase=_named(evolution.phase if active else _phase(summary)),
        written=summary.written,
    )


def _phase(summary: RunSummary) -> Phase:
    if summary.problem:
        return Phase.FAILED
    return Phase.FINISHED if summary.finished else Phase.STOPPED


def chosen_message(chosen: Chosen | None) -> wire.ChosenMessage:
    """The individual looked at and its rules, in the rule language and as sentences."""
    rule_set = chosen.rule_set if chosen else RuleSet()
    sentences = describe(rule_set, chosen.vocabulary) if chosen else []
    individual = None
    if chosen:
        place = (chosen.run, chosen.generation, chosen.key)
        individual = wire.ChosenIndividual(*place, chosen.fitness)
    rules = zip(rule_set.rules, sentences, strict=True)
    return wire.ChosenMessage(
        individual=individual,
        rules=tuple(wire.ReadRule(format_rule(rule), sentence) for rule, sentence in rules),
    )


def _short(value: float) -> float:
    """Four decimals: a mean of a few runs has no more to say."""
    return round(float(value), 4)
