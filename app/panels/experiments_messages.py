"""What the experiments page is told, made of the session's state."""

from __future__ import annotations

from dataclasses import asdict
from typing import cast

from geswarm.analysis.compared import Compared
from geswarm.sim import Scenario

from ..protocol import experiments as wire
from ..state.campaign_folder import CampaignLook, CampaignSummary
from ..state.campaigns import SIZES, Campaigns
from ..state.comparison import Progress, RuleSetComparison

MOST_CURVES = 30
"""Of a campaign; more cannot be told apart."""


def choice_message(comparison: RuleSetComparison, table: str, arena: str) -> wire.ChoiceMessage:
    """What can be compared and what is chosen, with what is wrong with it.

    Args:
        comparison: Where it is kept.
        table: Name of the rules as they are edited.
        arena: Name of the arena's scenario.
    """
    choice = comparison.choice
    rules, scenarios = comparison.rules_offered(), comparison.scenarios_offered()
    return wire.ChoiceMessage(
        rules=tuple(wire.Offer(name, name in choice.rules) for name in rules),
        scenarios=tuple(wire.Offer(name, name in choice.scenarios) for name in scenarios),
        table=table,
        arena=arena,
        against=choice.against,
        runs=choice.runs,
        seed=choice.seed,
        findings=choice.findings(),
    )


def compared_message(progress: Progress | None) -> wire.ComparedMessage:
    """The newest comparison as far as it is made."""
    if progress is None:
        return wire.ComparedMessage()
    compared = progress.compared
    return wire.ComparedMessage(
        busy=progress.busy,
        share=progress.share,
        error=progress.error,
        runs=compared.runs,
        seed=compared.seed,
        against=compared.against,
        explanation=compared.explanation,
        scenarios=_by_scenario(compared),
    )


def _by_scenario(compared: Compared) -> tuple[wire.ScenarioResults, ...]:
    scenarios: dict[Scenario, list[wire.CaseResult]] = {}
    for case, evaluation in compared.samples.items():
        contrast = compared.contrasts.get(case)
        figures = evaluation.figures()
        scenarios.setdefault(case.scenario, []).append(
            wire.CaseResult(
                rules=case.rules,
                scenario=case.scenario.name,
                fitness=tuple(evaluation.fitness.tolist()),
                mean=figures["mean"],
                sd=figures["sd"],
                median=figures["median"],
                p_value=contrast.comparison.p_value if contrast else None,
                p_holm=contrast.p_holm if contrast else None,
                effect=contrast.comparison.effect if contrast else None,
            )
        )
    return tuple(
        wire.ScenarioResults(
            where.name, where.objective.label, where.objective.maximise, tuple(found)
        )
        for where, found in scenarios.items()
    )


def draft_message(campaigns: Campaigns) -> wire.DraftMessage:
    """The next campaign as planned, with what is wrong with it and how long it will take."""
    values = campaigns.draft.values
    return wire.DraftMessage(
        values=dict(values),
        findings=campaigns.draft.findings(),
        sizes=tuple(
            wire.Offer(name, {**values, **size, "seed": values["seed"]} == values)
            for name, size in SIZES.items()
        ),
        seconds=campaigns.seconds,
    )


def status_message(campaigns: Campaigns) -> wire.CampaignStatusMessage:
    """What the present or last campaign does now."""
    thread = campaigns.thread
    return wire.CampaignStatusMessage(
        phase=cast(wire.CampaignPhase, thread.phase.name),
        name=thread.directory.name if thread.directory else None,
        share=thread.share,
        doing=thread.doing,
        seconds_left=thread.seconds_left,
        error=thread.error,
    )


def campaigns_message(campaigns: Campaigns) -> wire.CampaignsMessage:
    """All campaigns that are kept, and which of them is looked at."""
    return wire.CampaignsMessage(campaigns.shown, tuple(map(_kept, campaigns.kept)))


def _kept(summary: CampaignSummary) -> wire.KeptCampaign:
    plan = summary.plan
    return wire.KeptCampaign(
        name=summary.name,
        problem=summary.problem,
        plan=None if plan is None else wire.PlannedCampaign(**asdict(plan)),
        reported=summary.reported,
        written=summary.written,
    )


def campaign_message(look: CampaignLook | None, problem: str) -> wire.CampaignMessage:
    """The campaign looked at: how far its parts are, its curves so far, and its claims."""
    if look is None:
        return wire.CampaignMessage(None, problem)
    return wire.CampaignMessage(
        name=look.name,
        problem=problem,
        share=look.share,
        reported=look.reported,
        parts=tuple(wire.CampaignPart(part.name, part.done, part.total) for part in look.parts),
        curves=tuple(_curve(*curve) for curve in list(look.curves.items())[:MOST_CURVES]),
        levels=tuple(wire.CurveLevel(name, mean) for name, mean in look.levels.items()),
        claims=tuple(
            wire.JudgedClaim(
                where=claim.where,
                paper=claim.paper,
                found=claim.found,
                verdict=cast(wire.ClaimVerdict, claim.verdict.name),
                words=claim.verdict.value,
            )
            for claim in look.claims
        ),
    )


def _curve(name: str, values: tuple[float, ...]) -> wire.SeedCurve:
    """Only where it rises: with the generation before, so that the steps are seen."""
    rises = [i for i in range(1, len(values)) if values[i] != values[i - 1]]
    at = sorted({0, *rises, *(i - 1 for i in rises), len(values) - 1}) if values else []
    best = tuple(round(values[i], 2) for i in at)
    return wire.SeedCurve(name, tuple(i + 1 for i in at), best)
