"""What the experiments page is told, as JSON values (see static/experiments/protocol.js)."""

from __future__ import annotations

from dataclasses import asdict

from ..server.channel import Message
from ..state.campaign_folder import CampaignLook, CampaignSummary
from ..state.campaigns import SIZES, Campaigns
from ..state.comparison import Comparison, Progress

MOST_CURVES = 30
"""Of a campaign; more cannot be told apart."""


def choice_message(comparison: Comparison, table: str, arena: str) -> Message:
    """What can be compared and what is chosen, with what is wrong with it.

    Args:
        comparison: Where it is kept.
        table: Name of the rules as they are edited.
        arena: Name of the arena's scenario.
    """
    choice = comparison.choice
    rules, scenarios = comparison.rules_offered(), comparison.scenarios_offered()
    return {
        "type": "choice",
        "rules": [{"name": name, "chosen": name in choice.rules} for name in rules],
        "scenarios": [{"name": name, "chosen": name in choice.scenarios} for name in scenarios],
        "table": table,
        "arena": arena,
        "against": choice.against,
        "runs": choice.runs,
        "seed": choice.seed,
        "findings": choice.findings(),
    }


def compared_message(progress: Progress | None) -> Message:
    """The newest comparison as far as it is made."""
    if progress is None:
        return {"type": "compared", "busy": False, "share": 0, "error": "", "scenarios": []}
    compared = progress.compared
    return {
        "type": "compared",
        "busy": progress.busy,
        "share": progress.share,
        "error": progress.error,
        "runs": compared.runs,
        "seed": compared.seed,
        "against": compared.against,
        "explanation": compared.explanation,
        "scenarios": _by_scenario(progress.document),
    }


def _by_scenario(document: Message) -> list[Message]:
    scenarios: dict[str, list[Message]] = {}
    for result in document["results"]:
        scenarios.setdefault(result["scenario"], []).append(result)
    return [{"name": name, "results": results} for name, results in scenarios.items()]


def draft_message(campaigns: Campaigns) -> Message:
    """The next campaign as planned, with what is wrong with it and how long it will take."""
    values = campaigns.draft.values
    return {
        "type": "draft",
        "values": dict(values),
        "findings": campaigns.draft.findings(),
        "sizes": [
            {"name": name, "chosen": {**values, **size, "seed": values["seed"]} == values}
            for name, size in SIZES.items()
        ],
        "seconds": campaigns.seconds,
    }


def status_message(campaigns: Campaigns) -> Message:
    """What the present or last campaign does now."""
    thread = campaigns.thread
    return {
        "type": "status",
        "phase": thread.phase.name,
        "name": thread.directory.name if thread.directory else None,
        "share": thread.share,
        "doing": thread.doing,
        "seconds_left": thread.seconds_left,
        "error": thread.error,
    }


def campaigns_message(campaigns: Campaigns) -> Message:
    """All campaigns that are kept, and which of them is looked at."""
    return {
        "type": "campaigns",
        "shown": campaigns.shown,
        "campaigns": [_summary(summary) for summary in campaigns.kept],
    }


def _summary(summary: CampaignSummary) -> Message:
    return {
        "name": summary.name,
        "problem": summary.problem,
        "plan": None if summary.plan is None else asdict(summary.plan),
        "reported": summary.reported,
        "written": summary.written,
    }


def campaign_message(look: CampaignLook | None, problem: str) -> Message:
    """The campaign looked at: how far its parts are, its curves so far, and its claims."""
    if look is None:
        return {"type": "campaign", "name": None, "problem": problem}
    return {
        "type": "campaign",
        "name": look.name,
        "problem": problem,
        "share": look.share,
        "reported": look.reported,
        "parts": [
            {"name": part.name, "done": part.done, "total": part.total} for part in look.parts
        ],
        "curves": [_curve(*curve) for curve in list(look.curves.items())[:MOST_CURVES]],
        "levels": [{"name": name, "mean": mean} for name, mean in look.levels.items()],
        "claims": [
            {
                "where": claim.where,
                "paper": claim.paper,
                "found": claim.found,
                "verdict": claim.verdict.name,
                "words": claim.verdict.value,
            }
            for claim in look.claims
        ],
    }


def _curve(name: str, values: tuple[float, ...]) -> Message:
    """Only where it rises: with the generation before, so that the steps are seen."""
    rises = [i for i in range(1, len(values)) if values[i] != values[i - 1]]
    at = sorted({0, *rises, *(i - 1 for i in rises), len(values) - 1}) if values else []
    return {
        "name": name,
        "generation": [i + 1 for i in at],
        "best_so_far": [round(values[i], 2) for i in at],
    }
