"""Evolution in the background: a thread that a session starts, pauses, stops and listens to."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from enum import Enum
from pathlib import Path

from geswarm.evaluation import evaluate_rule_sets
from geswarm.evolution import EvolutionRun, InjectionError, RunConfig
from geswarm.ge import GenerationRecord, Settings, SettingsError, StoreError
from geswarm.rules import RuleSet
from geswarm.sim import EvaluationStopped, Scenario

from .references import references_of

REFERENCE_RUNS = 50


class Phase(Enum):
    """What the evolution is doing."""

    IDLE = "not started"
    RUNNING = "running"
    PAUSED = "paused"
    STOPPED = "stopped"
    FINISHED = "finished"
    FAILED = "failed"


class EvolutionThread:
    """At most one evolutionary run at a time, off the loop's thread.

    Attributes are written by the evolution's thread and read by the loop; each is replaced as a
    whole, so a reader sees the old or the new value.

    Attributes:
        workers: Threads that evaluate; leave one core to the arena.
        phase: What it is doing.
        error: Why it failed, else empty.
        remarks: What there is to know of the run that was resumed, usually nothing.
        directory: Of the present or last run.
        run: The run under way, if there is one; see `EvolutionRun` for what threads may do with it.
        settings: The run's, as they will be in the next generation.
        generations: How many the run will have.
        history: Records of all generations so far.
        best: The best rule set so far.
        references: Mean gain of the references in the run's scenario, by title, once known.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self.phase = Phase.IDLE
        self.error = ""
        self.remarks: tuple[str, ...] = ()
        self.directory: Path | None = None
        self.run: EvolutionRun | None = None
        self.settings: Settings | None = None
        self.generations = 0
        self.history: tuple[GenerationRecord, ...] = ()
        self.best: RuleSet | None = None
        self.references: dict[str, float] = {}
        self._thread: threading.Thread | None = None
        self._go_on = threading.Event()
        self._stop = threading.Event()

    @property
    def active(self) -> bool:
        """A run is under way, paused or not."""
        return self.phase in (Phase.RUNNING, Phase.PAUSED)

    def start(self, config: RunConfig, directory: Path, first: RuleSet | None = None) -> None:
        """Begin a run in a new directory; any run under way is stopped first.

        Args:
            config: Of the run.
            directory: Where it is kept.
            first: Rules that enter the first generation.
        """
        self._launch(lambda: EvolutionRun.create(config, directory, first), directory)

    def resume(self, directory: Path, generations: int | None = None) -> None:
        """Continue the run of a directory; any run under way is stopped first.

        Args:
            directory: Where it is kept.
            generations: How many it is to have; as many as it was to have unless given.
        """
        self._launch(lambda: EvolutionRun.resume(directory, generations), directory)

    def pause(self) -> None:
        """Wait after the generation at work."""
        if self.phase is Phase.RUNNING:
            self._go_on.clear()
            self.phase = Phase.PAUSED

    def go_on(self) -> None:
        """Go on after a pause."""
        if self.phase is Phase.PAUSED:
            self.phase = Phase.RUNNING
            self._go_on.set()

    def steer(self, **changes: float) -> None:
        """Change settings of the run from the next generation on.

        Raises:
            SettingsError: There is no run, no such setting, or a value cannot be used.
        """
        if self.run is None or self.settings is None:
            raise SettingsError(["no evolution is running: start or resume one to steer it"])
        self.run.steer(**changes)
        self.settings = self.settings.steered(**changes)

    def inject(self, rule_set: RuleSet) -> None:
        """Have rules enter the run with the next generation.

        Raises:
            InjectionError: There is no run, or they cannot enter it.
        """
        if self.run is None:
            raise InjectionError("no evolution is running: start or resume one to inject rules")
        self.run.inject(rule_set)

    def stop(self, timeout: float = 10.0) -> None:
        """End the run; it can be resumed from its directory."""
        self._stop.set()
        self._go_on.set()
        if self._thread is not None:
            self._thread.join(timeout)

    def forget(self) -> None:
        """Know nothing of the last run, as before the first one."""
        self.error, self.remarks, self.directory = "", (), None
        self.history, self.best, self.references = (), None, {}
        self.generations, self.settings = 0, None
        self.phase = Phase.IDLE

    def _launch(self, open_run: Callable[[], EvolutionRun], directory: Path) -> None:
        self.stop()
        self._stop, self._go_on = threading.Event(), threading.Event()
        self._go_on.set()
        self.forget()
        self.directory, self.phase = directory, Phase.RUNNING
        self._thread = threading.Thread(
            target=self._work, args=(open_run,), name="evolution", daemon=True
        )
        self._thread.start()

    def _work(self, open_run: Callable[[], EvolutionRun]) -> None:
        run = None
        try:
            run = self.run = open_run()
            self.remarks = run.remarks
            self.history, self.best = tuple(run.history), run.best
            self.generations, self.settings = run.config.settings.generations, run.settings
            for name, mean in evaluate_references(
                run.config.scenario, self.workers, self._stop.is_set
            ):
                self.references = {**self.references, name: mean}
            self._evolve(run)
            self.phase = Phase.FINISHED if run.finished else Phase.STOPPED
        except EvaluationStopped:
            self.phase = Phase.STOPPED
        except StoreError as error:
            self.error = str(error)
            self.phase = Phase.FAILED
        except Exception as error:  # whatever it is: the arena goes on and the user is told
            self.error = f"{type(error).__name__}: {error}"
            self.phase = Phase.FAILED
        finally:
            self.run = None
            if run is not None:
                run.close()

    def _evolve(self, run: EvolutionRun) -> None:
        def after_generation(record: GenerationRecord) -> None:
            self.history = (*self.history, record)
            self.best = run.best
            self._go_on.wait()

        self._go_on.wait()
        run.run(self.workers, after_generation, self._stop.is_set)


def evaluate_references(
    scenario: Scenario, workers: int, stop: Callable[[], bool]
) -> Iterator[tuple[str, float]]:
    """What a scenario's references are worth: title and mean gain, one after the other.

    Raises:
        EvaluationStopped: `stop` returned True.
    """
    for reference in references_of(scenario).values():
        (evaluation,) = evaluate_rule_sets(
            [reference], scenario, REFERENCE_RUNS, workers=workers, stop=stop
        )
        yield reference.name, scenario.objective.gain(evaluation.mean)
