"""The evolution page and the session (see app/protocol/evolution.py)."""

from __future__ import annotations

from geswarm.evolution import InjectionError
from geswarm.ge import STEERABLE, SettingsError, StoreError
from geswarm.rules import RuleSet, RuleSetError

from ..protocol import evolution as told
from ..protocol import evolution_requests as asked
from ..server.channel import Client
from ..state.look import Chosen
from ..state.plan import RunPlanError
from ..state.rival import CHOSEN
from ..state.run_folder import RunError
from ..state.session import Session
from . import evolution_messages as messages
from .page import RequestError, Sources, WatchedPage


class EvolutionPage(WatchedPage):
    """Carries out what pages ask for and keeps all of them up to date."""

    refusals = (
        RequestError,
        RunPlanError,
        RunError,
        InjectionError,
        RuleSetError,
        SettingsError,
        StoreError,
    )
    typed = (told.PlanMessage, told.EvolutionMessage, told.RunsMessage)

    def __init__(self, session: Session) -> None:
        super().__init__(session, "evolution")
        runs = session.runs
        self.carry_out = {
            asked.ChoosePreset: self._preset,
            asked.SetPlan: self._plan,
            asked.Freeze: lambda message: runs.freeze(message.rule, message.on),
            asked.StartRun: self._start,
            asked.PauseRun: lambda _: runs.evolution.pause(),
            asked.GoOn: lambda _: runs.evolution.go_on(),
            asked.StopRun: lambda _: runs.evolution.stop(0.0),
            asked.Steer: self._steer,
            asked.Inject: self._inject,
            asked.LoadBest: self._load_best,
            asked.ChooseIndividual: lambda message: runs.choose(message.generation, message.key),
            asked.Forget: lambda _: runs.forget(),
            asked.LoadChosen: self._load,
            asked.CompareWith: self._compare_with,
            asked.OpenRun: lambda message: runs.open(message.name),
            asked.CompareRun: lambda message: runs.compare(message.name, message.on),
            asked.ResumeRun: self._resume,
            asked.DeleteRun: self._delete,
        }

    def refresh(self) -> None:
        """Look at the runs that are kept."""
        self.session.runs.refresh()

    def sources(self) -> Sources:
        """What the page is told."""
        session, runs = self.session, self.session.runs
        evolution, look, plan = runs.evolution, runs.look, runs.plan
        rule_set, scenario = session.document.rule_set, session.scenario
        progress = (evolution.phase, evolution.error, evolution.settings, len(evolution.history))
        compared = tuple(runs.compared.items())
        return {
            told.PlanMessage: (
                (plan, rule_set, scenario),
                lambda: messages.plan_message(plan, scenario, rule_set),
            ),
            told.EvolutionMessage: (
                (*progress, evolution.generations, runs.shown, runs.problem, look, runs.kept),
                lambda: messages.status_message(runs),
            ),
            told.CurvesMessage: (
                (look, len(runs.references)),
                lambda: messages.curves_message(runs),
            ),
            told.ComparedRunsMessage: (
                (compared, runs.kept, evolution.phase, runs.done),
                lambda: messages.compared_message(runs),
            ),
            told.PopulationMessage: ((look,), lambda: messages.population_message(look)),
            told.AncestorsMessage: ((look,), lambda: messages.ancestors_message(look)),
            told.RunsMessage: (
                (compared, runs.kept, evolution.phase, runs.done),
                lambda: messages.runs_message(runs),
            ),
            told.ChosenMessage: (
                (runs.chosen,),
                lambda: messages.chosen_message(runs.chosen),
            ),
        }

    def _greet(self, client: Client) -> None:
        self.channel.send(client, messages.form_message())
        super()._greet(client)

    # --- what a page can ask for; what is returned is told to it --------------------------------

    def _preset(self, message: asked.ChoosePreset) -> None:
        runs = self.session.runs
        runs.plan = runs.plan.with_preset(message.name, self.session.scenario)

    def _plan(self, message: asked.SetPlan) -> None:
        runs = self.session.runs
        runs.plan = runs.plan.with_value(message.name, message.value)

    def _start(self, message: asked.StartRun) -> None:
        self._require_rest(message.instead)
        self.session.runs.start(self.session.scenario)

    def _resume(self, message: asked.ResumeRun) -> None:
        self._require_rest(message.instead)
        self.session.runs.resume(message.name, message.generations)

    def _require_rest(self, instead: bool) -> None:
        if self.session.evolution.active and not instead:
            raise RequestError("an evolution is under way: stop it first")
        if self.session.campaigns.thread.active:
            raise RequestError("a campaign is under way: stop it first, on the page Experiments")

    def _steer(self, message: asked.Steer) -> None:
        name, value = message.name, message.value
        if name not in STEERABLE:
            known = ", ".join(STEERABLE)
            raise RequestError(f"expected a number for {known}, got {name} {value!r}")
        self.session.evolution.steer(**{name: value})

    def _inject(self, _: asked.Inject) -> str:
        rule_set = self.session.document.rule_set
        self.session.evolution.inject(rule_set)
        return f"{rule_set.name or 'The rules of the table'}: enters with the next generation"

    def _load_best(self, _: asked.LoadBest) -> str:
        best = self.session.runs.best
        if best is None:
            raise RequestError("there is no best rule set yet")
        return self._put_in_place(best)

    def _load(self, _: asked.LoadChosen) -> str:
        return self._put_in_place(self._chosen.rule_set)

    def _put_in_place(self, rule_set: RuleSet) -> str:
        self.session.load(rule_set)
        return f"{rule_set.name}: now in the table and in the arena; undo takes it out again"

    def _compare_with(self, _: asked.CompareWith) -> str:
        rule_set = self._chosen.rule_set
        self.session.require_offered(rule_set)
        self.session.compare_with(CHOSEN)
        return f"{rule_set.name}: runs in the arena beside the rules of the table"

    @property
    def _chosen(self) -> Chosen:
        chosen = self.session.runs.chosen
        if chosen is None:
            raise RequestError("expected an individual that was clicked")
        return chosen

    def _delete(self, message: asked.DeleteRun) -> str:
        left = self.session.runs.delete(message.name)
        return f"{message.name} was deleted, except for {left}" if left else ""
