"""The experiments page and the session (see app/protocol/experiments.py)."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

from geswarm.analysis.reproduction import CampaignError
from geswarm.rules import RuleSetError

from ..protocol import experiments as wire
from ..server.gate import MadeFile
from ..state.comparison import ChoiceError
from ..state.session import Session
from . import experiments_messages as messages
from .page import RequestError, Sources, WatchedPage

_REPORT = "report/"


class ExperimentsPage(WatchedPage):
    """Carries out what pages ask for and keeps all of them up to date."""

    refusals = (RequestError, ChoiceError, CampaignError, RuleSetError)
    typed = (wire.ChoiceMessage, wire.DraftMessage)

    def __init__(self, session: Session) -> None:
        super().__init__(session, "experiments")
        comparison, campaigns = session.comparison, session.campaigns
        self.carry_out = {
            wire.ChooseCase: lambda message: comparison.choose(
                message.what, message.name, message.on
            ),
            wire.SetChoice: self._choice,
            wire.AddFile: lambda message: comparison.add_file(message.name, message.text),
            wire.CompareChosen: lambda _: comparison.start(
                session.document.rule_set, session.scenario
            ),
            wire.CancelComparison: lambda _: comparison.cancel(),
            wire.ChooseSize: lambda message: campaigns.set_size(message.name),
            wire.SetDraft: lambda message: campaigns.set_value(message.name, message.value),
            wire.StartCampaign: lambda _: campaigns.start(),
            wire.StopCampaign: lambda _: campaigns.thread.stop(0.0),
            wire.ResumeCampaign: lambda message: campaigns.resume(message.name),
            wire.OpenCampaign: lambda message: campaigns.open(message.name),
        }

    def made_file(self, name: str) -> MadeFile | None:
        """A file to open or to keep; None if there is none of that name. From any thread.

        Args:
            name: `comparison` with .html, .csv or .json, or `report/` and the name of
                a campaign.
        """
        if name.startswith(_REPORT):
            try:
                report = self.session.campaigns.folder.report(name.removeprefix(_REPORT))
                return MadeFile(".html", report.read_bytes())
            except (CampaignError, OSError):
                return None
        progress = self.session.comparison.progress
        if progress is None or not progress.compared.samples:
            return None
        compared, document = progress.compared, progress.document
        make: dict[str, Callable[[], str]] = {
            "comparison.html": compared.page,
            "comparison.csv": compared.csv,
            "comparison.json": lambda: json.dumps(document),
        }
        return MadeFile(Path(name).suffix, make[name]().encode()) if name in make else None

    def refresh(self) -> None:
        """Look at the campaigns and runs that are kept."""
        self.session.campaigns.refresh()
        self.session.comparison.look_for_runs()

    def sources(self) -> Sources:
        """What the page is told."""
        session, comparison = self.session, self.session.comparison
        campaigns, thread = session.campaigns, session.campaigns.thread
        table, arena = session.document.rule_set.name, session.scenario.name
        offered = tuple(comparison.rules_offered())
        return {
            wire.ChoiceMessage: (
                (comparison.choice, offered, table, arena),
                lambda: messages.choice_message(comparison, table, arena),
            ),
            wire.ComparedMessage: (
                (comparison.progress,),
                lambda: messages.compared_message(comparison.progress),
            ),
            wire.DraftMessage: (
                (campaigns.draft, campaigns.rate),
                lambda: messages.draft_message(campaigns),
            ),
            wire.CampaignStatusMessage: (
                (thread.phase, thread.directory, thread.doing),
                lambda: messages.status_message(campaigns),
            ),
            wire.CampaignsMessage: (
                (campaigns.kept, campaigns.shown),
                lambda: messages.campaigns_message(campaigns),
            ),
            wire.CampaignMessage: (
                (campaigns.look, campaigns.problem),
                lambda: messages.campaign_message(campaigns.look, campaigns.problem),
            ),
        }

    def _choice(self, message: wire.SetChoice) -> None:
        """Another number of runs, seed, or rule set to compare with."""
        comparison, value = self.session.comparison, message.value
        if message.name == "runs":
            comparison.change(runs=value)
        elif message.name == "seed":
            comparison.change(seed=value)
        elif isinstance(value, str):
            comparison.change(against=value)
        else:
            raise RequestError(f"against: expected a name, got {value!r}")
