"""An evolutionary run in its directory."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path

import yaml

from geswarm import __version__
from geswarm.evolution.composition import Composition
from geswarm.evolution.fitness import ScenarioFitness
from geswarm.evolution.population import Population
from geswarm.ge import (
    Engine,
    GenerationRecord,
    Injection,
    Result,
    RunStore,
    Settings,
    SettingsChange,
    SettingsError,
    Steering,
    StoredIndividual,
    StoredSteering,
    StoreError,
    evolve,
)
from geswarm.rules import (
    FORAGING,
    Origin,
    Rule,
    RuleSet,
    format_text,
    format_yaml,
    parse_text,
    plain_yaml,
)
from geswarm.rules.library import write_whole
from geswarm.sim import Scenario, Stop, parse_scenario, vocabulary_of


class RunConfigError(ValueError):
    """The config.yaml of a run cannot be used."""


@dataclass(frozen=True)
class RunConfig:
    """Everything that decides how an evolutionary run goes.

    Attributes:
        scenario: Where the rules are evaluated.
        settings: Of the evolutionary algorithm, at the beginning.
        seed: Of all random numbers.
        frozen: Rules that stand before the evolved ones and never change.
        version: Of GESwarm, with which the run began.
    """

    scenario: Scenario
    settings: Settings
    seed: int = 0
    frozen: tuple[Rule, ...] = ()
    version: str = field(default=__version__, compare=False)

    @property
    def composition(self) -> Composition:
        """What a phenotype becomes."""
        return Composition.of(self.scenario, self.frozen)

    def to_yaml(self) -> str:
        """The text of config.yaml, everything resolved."""
        document = {
            "geswarm": self.version,
            "seed": self.seed,
            "evolution": asdict(self.settings),
            "frozen": format_text(RuleSet(self.frozen)) if self.frozen else "",
            "scenario_name": self.scenario.name,
            "scenario": yaml.safe_load(self.scenario.to_yaml()),
        }
        return yaml.safe_dump(document, sort_keys=False, default_flow_style=None)

    @classmethod
    def from_yaml(cls, text: str, with_code: bool = False) -> RunConfig:
        """Read what `to_yaml` wrote; `with_code`: whether it may name terms of one's own.

        Raises:
            RunConfigError: It is something else.
        """
        began = ""
        try:
            document = plain_yaml.load(text)
            match document:
                case {
                    "geswarm": str(version),
                    "seed": int(seed),
                    "evolution": dict(settings),
                    "frozen": str(frozen),
                    "scenario_name": str(name),
                    "scenario": dict(scenario),
                } if 0 <= seed < 2**63:
                    if version != __version__:
                        began = f" (of GESwarm {version}; this is {__version__})"
                    if unknown := [str(key) for key in document if key not in _CONFIG_KEYS]:
                        raise ValueError(f"unknown: {', '.join(unknown)}")
                    folder = Path() if with_code else None
                    where = parse_scenario(yaml.safe_dump(scenario), name, folder)
                    known = vocabulary_of(where)
                    return cls(
                        scenario=where,
                        settings=Settings.of(**{str(key): settings[key] for key in settings}),
                        seed=seed,
                        frozen=parse_text(frozen, vocabulary=known).rules if frozen else (),
                        version=version,
                    )
            raise ValueError(f"expected {', '.join(_CONFIG_KEYS)}")
        except (TypeError, ValueError) as error:
            raise RunConfigError(f"not the configuration of a run{began}: {error}") from error


_CONFIG_KEYS = ("geswarm", "seed", "evolution", "frozen", "scenario_name", "scenario")


class EvolutionRun:
    """An evolutionary run in its directory: config.yaml, run.db, history.csv and best.yaml.

    `inject`, `steer`, `population` and `genealogy` may be called from any thread while `run` works
    in another.

    Attributes:
        config: How it began; `generations` are those of now.
        directory: Where it is kept.
        remarks: What whoever continues it should know: sentences, usually none.
        history: One record per generation finished, those before a resume included.
        steering: What was changed on the way, with the generation from which on.
    """

    def __init__(self, config: RunConfig, store: RunStore, engine: Engine) -> None:
        self.config = config
        self.directory = store.directory
        self.remarks = tuple(_remarks(config, store))
        self.history: list[GenerationRecord] = store.history()
        self.steering: list[StoredSteering] = store.steering()
        self._store = store
        self._engine = engine
        self._requests: deque[Steering] = deque()

    @classmethod
    def create(
        cls, config: RunConfig, directory: str | Path, first: RuleSet | None = None
    ) -> EvolutionRun:
        """Begin a run in a directory that holds none.

        Args:
            config: Of the run.
            directory: Where it is kept.
            first: Rules that enter the first generation, on disk with the rest.

        Raises:
            InjectionError: The grammar does not derive `first`; says why.
            StoreError: The directory holds a run already or cannot be written.
        """
        composition = config.composition
        enters = [] if first is None else [Injection(composition.phenotype(first))]
        store = RunStore.create(directory, config.to_yaml())
        engine = Engine(composition.grammar, config.settings, config.seed, composition.behaviour)
        try:
            for each in enters:
                store.record_steering(engine.generation + 1, each)
                each.apply(engine)
        except StoreError:
            store.close()
            raise
        return cls(config, store, engine)

    @classmethod
    def resume(
        cls, directory: str | Path, generations: int | None = None, with_code: bool = False
    ) -> EvolutionRun:
        """Continue a run exactly where its last complete generation ended.

        Args:
            directory: Where it is kept.
            with_code: Whether its configuration may name code, the terms of one's own; without it
                only what a scenario's file has named before.
            generations: How many it is to have from now on, at least as many as are done; as many
                as it was to have unless given. They decide nothing before its end.

        Raises:
            StoreError: There is no run, or it cannot be used; or another process is at work on it.
            SettingsError: So many generations cannot be.
        """
        run = cls._open(directory, with_code=with_code)
        try:
            if generations is not None:
                run.extend(generations)
            run._save_best()  # a run killed before it wrote best.yaml has it now
        except (StoreError, SettingsError):
            run.close()
            raise
        return run

    @classmethod
    def read(cls, directory: str | Path) -> EvolutionRun:
        """Look at a run, which another process may continue meanwhile; it cannot be run.

        Raises:
            StoreError: There is no run, or it cannot be used.
        """
        return cls._open(directory, read_only=True)

    @classmethod
    def _open(
        cls, directory: str | Path, read_only: bool = False, with_code: bool = False
    ) -> EvolutionRun:
        store = RunStore.open(directory, read_only)
        try:
            config = RunConfig.from_yaml(store.config, with_code)
            state = store.checkpoint()
            identity = config.composition.behaviour
            parameters = config.composition.grammar, config.settings, config.seed
            if state is None:
                engine = Engine(*parameters, identity)
            else:
                engine = Engine.restore(*parameters, state, identity)
            for change in store.steering():
                if change.generation > engine.generation:  # of the generation that was lost
                    change.what.apply(engine)
            return cls(config, store, engine)
        except (ValueError, StoreError) as error:
            store.close()
            raise StoreError(f"{directory}: {error}") from error

    def extend(self, generations: int) -> None:
        """Have another number of generations, on disk first; see `resume`.

        Raises:
            StoreError: It cannot be written.
            SettingsError: So many generations cannot be.
        """
        settings = replace(self.config.settings, generations=generations)
        if generations < (done := len(self.history)):
            raise SettingsError(
                [f"generations: {done} are done, expected as many or more, got {generations}"]
            )
        if settings != self.config.settings:
            self.config = replace(self.config, settings=settings)
            self._store.change_config(self.config.to_yaml())
            self._engine.settings = replace(self._engine.settings, generations=generations)

    @property
    def finished(self) -> bool:
        """All generations are done."""
        return self._engine.finished

    @property
    def settings(self) -> Settings:
        """The settings as they are now; those of the beginning are in `config`."""
        return self._engine.settings

    @property
    def best(self) -> RuleSet | None:
        """The best rule set so far, with its origin; None before the first generation."""
        best = self._engine.best
        if best is None or best.phenotype is None:
            return None
        fitness = self.config.scenario.objective.gain(best.value)
        origin = Origin(run=str(self.directory), generation=best.generation, fitness=fitness)
        name = f"Evolved, seed {self.config.seed}, generation {best.generation}"
        composition = self.config.composition
        scenario = "" if composition.vocabulary is FORAGING else self.config.scenario.name
        rule_set = composition.rule_set(best.phenotype)
        return replace(rule_set, name=name, origin=origin, scenario=scenario)

    def population(self) -> Population:
        """The individuals of the last finished generation and how they differ."""
        return Population.of(self._engine.population, self.config.composition)

    def genealogy(self) -> list[StoredIndividual]:
        """The best individual and everyone it descends from, oldest first."""
        best = self._store.best()
        return self._store.ancestors((best.generation, best.key)) if best else []

    def bred(self, generation: int) -> list[StoredIndividual]:
        """Who was bred for a generation, with the fitness of then; the injected come last."""
        return self._store.individuals(generation)

    def inject(self, rule_set: RuleSet) -> None:
        """Have a rule set enter the population with the next generation that is bred.

        It is evaluated with that generation and takes the place of the worst.

        Raises:
            InjectionError: The grammar does not derive it; says why.
        """
        self._requests.append(Injection(self.config.composition.phenotype(rule_set)))

    def steer(self, **changes: float) -> None:
        """Change `crossover`, `mutation`, `scaling` or `tournament` from the next generation on.

        Raises:
            SettingsError: Another setting, or a value that cannot be used.
        """
        self._engine.settings.steered(**changes)
        self._requests.append(SettingsChange(changes))

    def run(
        self,
        workers: int | None = None,
        on_generation: Callable[[GenerationRecord], None] | None = None,
        stop: Stop | None = None,
        executor: Executor | None = None,
    ) -> Result:
        """Evolve to the last generation or until `stop` returns True; can be called again.

        Args:
            workers: Threads that simulate; None for one per core.
            on_generation: Called after each generation.
            stop: Asked now and then.
            executor: Simulates in place of threads of this process; the history is the same.

        Raises:
            StoreError: A generation could not be written; those before it are safe.
            EvaluationError: The executor failed; the generations so far are safe.
        """
        saved = None

        def after_generation(record: GenerationRecord) -> None:
            nonlocal saved
            self.history.append(record)
            if self.best != saved:
                saved = self.best
                self._save_best()
            if on_generation:
                on_generation(record)

        fitness = ScenarioFitness(
            self.config.scenario,
            self.config.seed,
            self.config.settings.evaluations,
            workers,
            stop,
            self.config.settings.common_random_numbers,
            self.config.frozen,
            executor,
        )
        return evolve(
            self._engine, fitness, self._store, after_generation, stop, self._take_requests
        )

    def _take_requests(self) -> Iterator[Steering]:
        while self._requests:
            what = self._requests.popleft()
            yield what
            self.steering.append(StoredSteering(self._engine.generation + 1, what))

    def _save_best(self) -> None:
        if self.best is not None:
            try:
                path = self.directory / "best.yaml"
                write_whole(format_yaml(self.best), path, through_links=False)
            except OSError as error:
                raise StoreError(f"{self.directory}: cannot write best.yaml: {error}") from error

    def close(self) -> None:
        """Close the directory."""
        self._store.close()


def version_remarks(what: str, version: str) -> tuple[str, ...]:
    """What to know of something that is continued and that a version began: nothing if this did."""
    if version == __version__:
        return ()
    return (
        f"{what} began with GESwarm {version} and goes on with {__version__}: results may differ "
        "from those of one version.",
    )


def _remarks(config: RunConfig, store: RunStore) -> Iterator[str]:
    yield from version_remarks("This run", config.version)
    if store.config_differed:
        yield (
            "config.yaml had been changed; what counts is run.db, so it says again what it did. "
            "Only the number of generations can change when a run is resumed."
        )
