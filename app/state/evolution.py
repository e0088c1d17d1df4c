"""Evolution in the background: a thread that a session starts, pauses, stops and listens to."""

from __future__ import annotations

import threading
from collections.abc import Callable
from enum import Enum
from pathlib import Path

from geswarm.experiment import EvolutionRun, RunConfig, evaluate_rule_sets
from geswarm.ge import GenerationRecord
from geswarm.rules import RuleSet, load_preset
from geswarm.sim import EvaluationStopped, Scenario

REFERENCES = ("hand-coded", "evo8")
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
        directory: Of the present or last run.
        generations: How many the run will have.
        history: Records of all generations so far.
        best: The best rule set so far.
        references: Mean collected of the presets in the run's scenario, by name, once known.
    """

    def __init__(self, workers: int) -> None:
        self.workers = workers
        self.phase = Phase.IDLE
        self.error = ""
        self.directory: Path | None = None
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

    def start(self, config: RunConfig, directory: Path) -> None:
        """Begin a run in a new directory; any run under way is stopped first."""
        self._launch(lambda: EvolutionRun.create(config, directory), directory)

    def resume(self, directory: Path) -> None:
        """Continue the run of a directory; any run under way is stopped first."""
        self._launch(lambda: EvolutionRun.resume(directory), directory)

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

    def stop(self, timeout: float = 10.0) -> None:
        """End the run; it can be resumed from its directory."""
        self._stop.set()
        self._go_on.set()
        if self._thread is not None:
            self._thread.join(timeout)

    def _launch(self, open_run: Callable[[], EvolutionRun], directory: Path) -> None:
        self.stop()
        self._stop, self._go_on = threading.Event(), threading.Event()
        self._go_on.set()
        self.error, self.directory = "", directory
        self.history, self.best, self.references = (), None, {}
        self.phase = Phase.RUNNING
        self._thread = threading.Thread(
            target=self._work, args=(open_run,), name="evolution", daemon=True
        )
        self._thread.start()

    def _work(self, open_run: Callable[[], EvolutionRun]) -> None:
        run = None
        try:
            run = open_run()
            self.generations = run.config.settings.generations
            self.history, self.best = tuple(run.history), run.best
            self._evaluate_references(run.config.scenario)
            self._evolve(run)
            self.phase = Phase.FINISHED if run.finished else Phase.STOPPED
        except EvaluationStopped:
            self.phase = Phase.STOPPED
        except Exception as error:  # whatever it is: the arena goes on and the user is told
            self.error = f"{type(error).__name__}: {error}"
            self.phase = Phase.FAILED
        finally:
            if run is not None:
                run.close()

    def _evaluate_references(self, scenario: Scenario) -> None:
        for name in REFERENCES:
            (evaluation,) = evaluate_rule_sets(
                [load_preset(name)],
                scenario,
                REFERENCE_RUNS,
                workers=self.workers,
                stop=self._stop.is_set,
            )
            self.references = {**self.references, name: evaluation.mean}

    def _evolve(self, run: EvolutionRun) -> None:
        def after_generation(record: GenerationRecord) -> None:
            self.history = (*self.history, record)
            self.best = run.best
            self._go_on.wait()

        self._go_on.wait()
        run.run(self.workers, after_generation, self._stop.is_set)
