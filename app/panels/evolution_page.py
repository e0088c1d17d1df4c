"""The evolution page and the session, talking JSON (see static/evolution/protocol.js)."""

from __future__ import annotations

from collections.abc import Callable

from geswarm.evolution import InjectionError
from geswarm.ge import STEERABLE, SettingsError, StoreError
from geswarm.rules import RuleSet

from ..server.channel import Channel, Client, Message
from ..state.look import Chosen
from ..state.plan import PlanError
from ..state.rival import CHOSEN
from ..state.run_folder import RunError
from ..state.session import Session
from . import evolution_messages as messages

REFRESH_SECONDS = 0.5
WATCHED_SECONDS = 3.0
"""How long a page that said that it is in view is believed."""
MAX_NAME = 255


class RequestError(ValueError):
    """A message of a page that cannot be carried out as it is; says why."""


class EvolutionPage:
    """Carries out what pages ask for and keeps all of them up to date."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.channel = Channel(
            on_message=lambda client, message: session.post(
                lambda _: self._receive(client, message)
            ),
            on_connect=lambda client: session.post(lambda _: self._greet(client)),
        )
        self._watched = 0.0
        self._since_refresh = REFRESH_SECONDS
        self._seen: dict[str, tuple[object, ...]] = {}
        runs = session.runs
        self._carry_out: dict[str, Callable[[Message], str | None]] = {
            "watch": self._watch,
            "preset": self._preset,
            "plan": self._plan,
            "freeze": lambda message: runs.freeze(_whole(message, "rule"), _switch(message, "on")),
            "start": self._start,
            "pause": lambda _: runs.evolution.pause(),
            "go_on": lambda _: runs.evolution.go_on(),
            "stop": lambda _: runs.evolution.stop(0.0),
            "steer": self._steer,
            "inject": self._inject,
            "load_best": self._load_best,
            "choose": lambda message: runs.choose(
                _whole(message, "generation"), _whole(message, "key")
            ),
            "forget": lambda _: runs.forget(),
            "load": self._load,
            "compare_with": self._compare_with,
            "open": lambda message: runs.open(_name(message)),
            "compare": lambda message: runs.compare(_name(message), _switch(message, "on")),
            "resume": self._resume,
            "delete": self._delete,
        }

    def sync(self, elapsed: float) -> None:
        """Send what has changed to all pages; called by the loop once a frame."""
        if self._watched <= 0.0:
            return
        self._watched -= elapsed
        self._since_refresh += elapsed
        if self._since_refresh >= REFRESH_SECONDS:
            self._since_refresh = 0.0
            self.session.runs.refresh()
        for kind, (source, build) in self._sources().items():
            if self._seen.get(kind) != source:
                self._seen[kind] = source
                self.channel.broadcast(build(), live=True)

    def _sources(self) -> dict[str, tuple[tuple[object, ...], Callable[[], Message]]]:
        """By type of message: what it is made of, and how."""
        session, runs = self.session, self.session.runs
        evolution, look, plan = runs.evolution, runs.look, runs.plan
        rule_set, scenario = session.document.rule_set, session.scenario
        progress = (evolution.phase, evolution.error, evolution.settings, len(evolution.history))
        compared = tuple(runs.compared.items())
        return {
            "plan": (
                (plan, rule_set, scenario),
                lambda: messages.plan_message(plan, scenario, rule_set),
            ),
            "status": (
                (*progress, evolution.generations, runs.shown, runs.problem, look, runs.kept),
                lambda: messages.status_message(runs),
            ),
            "curves": (
                (look, len(runs.references)),
                lambda: messages.curves_message(runs),
            ),
            "compared": (
                (compared, runs.kept, evolution.phase, runs.done),
                lambda: messages.compared_message(runs),
            ),
            "population": ((look,), lambda: messages.population_message(look)),
            "ancestors": ((look,), lambda: messages.ancestors_message(look)),
            "runs": (
                (compared, runs.kept, evolution.phase, runs.done),
                lambda: messages.runs_message(runs),
            ),
            "chosen": (
                (runs.chosen,),
                lambda: messages.chosen_message(runs.chosen),
            ),
        }

    def _greet(self, client: Client) -> None:
        self.channel.send(client, messages.form_message())
        for _, build in self._sources().values():
            self.channel.send(client, build(), live=True)
        self.channel.welcome(client)
        self._watch({})

    def _watch(self, _message: Message) -> None:
        """A page is in view."""
        if self._watched <= 0.0:
            self._since_refresh = REFRESH_SECONDS
        self._watched = WATCHED_SECONDS

    def _receive(self, client: Client, message: Message) -> None:
        kind = str(message.get("type"))
        try:
            if kind not in self._carry_out:
                raise RequestError(f"unknown message {kind!r}")
            told = self._carry_out[kind](message)
        except _REFUSALS as error:
            self.channel.send(client, messages.notice_message(str(error)))
            for shown in ("plan", "status", "runs"):  # what was typed or ticked is not what holds
                self.channel.send(client, self._sources()[shown][1](), live=True)
        else:
            if told:
                self.channel.send(client, messages.notice_message(told, "info"))

    # --- what a page can ask for; what is returned is told to it --------------------------------

    def _preset(self, message: Message) -> None:
        runs = self.session.runs
        runs.plan = runs.plan.with_preset(_name(message))

    def _plan(self, message: Message) -> None:
        runs = self.session.runs
        runs.plan = runs.plan.with_value(_name(message), message.get("value"))

    def _start(self, message: Message) -> None:
        self._require_rest(message)
        self.session.runs.start(self.session.scenario)

    def _resume(self, message: Message) -> None:
        self._require_rest(message)
        name, generations = _name(message), message.get("generations")
        if generations is not None and type(generations) is not int:
            raise RequestError(f"generations: expected a whole number, got {str(generations)[:40]}")
        self.session.runs.resume(name, generations)

    def _require_rest(self, message: Message) -> None:
        if self.session.evolution.active and message.get("instead") is not True:
            raise RequestError("an evolution is under way: stop it first")
        if self.session.campaigns.thread.active:
            raise RequestError("a campaign is under way: stop it first, on the page Experiments")

    def _steer(self, message: Message) -> None:
        name, value = _name(message), message.get("value")
        if name not in STEERABLE or not isinstance(value, int | float):
            raise RequestError(
                f"expected a number for {', '.join(STEERABLE)}, got {name} {value!r}"
            )
        self.session.evolution.steer(**{name: value})

    def _inject(self, _message: Message) -> str:
        rule_set = self.session.document.rule_set
        self.session.evolution.inject(rule_set)
        return f"{rule_set.name or 'The rules of the table'}: enters with the next generation"

    def _load_best(self, _message: Message) -> str:
        best = self.session.runs.best
        if best is None:
            raise RequestError("there is no best rule set yet")
        return self._put_in_place(best)

    def _load(self, _message: Message) -> str:
        return self._put_in_place(self._chosen.rule_set)

    def _put_in_place(self, rule_set: RuleSet) -> str:
        self.session.load(rule_set)
        return f"{rule_set.name}: now in the table and in the arena; undo takes it out again"

    def _compare_with(self, _message: Message) -> str:
        name = self._chosen.rule_set.name
        self.session.compare_with(CHOSEN)
        return f"{name}: runs in the arena beside the rules of the table"

    @property
    def _chosen(self) -> Chosen:
        chosen = self.session.runs.chosen
        if chosen is None:
            raise RequestError("expected an individual that was clicked")
        return chosen

    def _delete(self, message: Message) -> str:
        left = self.session.runs.delete(_name(message))
        return f"{_name(message)} was deleted, except for {left}" if left else ""


_REFUSALS = (RequestError, PlanError, RunError, InjectionError, SettingsError, StoreError)


def _name(message: Message) -> str:
    name = message.get("name")
    if not isinstance(name, str) or len(name) > MAX_NAME:
        raise RequestError(f"name: expected a text of at most {MAX_NAME} characters")
    return name


def _whole(message: Message, key: str) -> int:
    value = message.get(key)
    if type(value) is not int or not 0 <= value < 2**53:
        raise RequestError(f"{key}: expected a whole number, got {value!r}")
    return value


def _switch(message: Message, key: str) -> bool:
    value = message.get(key)
    if not isinstance(value, bool):
        raise RequestError(f"{key}: expected true or false, got {value!r}")
    return value
