"""The directory of a campaign: carried out step by step, each kept as soon as it is done.

    campaign.yaml        what was asked for
    evolution/seed-N/    the evolutionary runs, each an ordinary run directory
    data/*.csv           every single run of every experiment
    rules/*.yaml         the rule sets
    report.html          figures, and every claim of the paper beside what was found

Whatever interrupts it, it goes on from the last generation or experiment that was finished. It can
get more runs and generations; the experiments with what they lead to are then made anew.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Executor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from geswarm import __version__
from geswarm.analysis.cases import Case, Samples, run_cases
from geswarm.analysis.reproduction import studies
from geswarm.analysis.reproduction.plan import Plan, PlanError, version_of
from geswarm.analysis.reproduction.progress import Meter, OnProgress, Part, works_of
from geswarm.analysis.reproduction.report import files_of
from geswarm.analysis.reproduction.results import Results, best_of, format_samples, parse_samples
from geswarm.analysis.reproduction.studies import EVO_8, HAND_CODED, evolved_name
from geswarm.evolution import EvolutionRun, version_remarks
from geswarm.ge import GenerationRecord, StoreError, locks
from geswarm.plain_text import NotTextError, decode, read_file
from geswarm.rules import RuleSet, load_preset
from geswarm.rules.library import write_whole
from geswarm.rules.limits import MAX_CHARACTERS
from geswarm.sim import EvaluationStopped


class CampaignError(RuntimeError):
    """A campaign cannot be begun or continued; says where, and what was expected."""


class Campaign:
    """A campaign in its directory.

    Attributes:
        directory: Where it is kept.
        plan: What was asked for.
    """

    def __init__(self, directory: Path, plan: Plan, version: str = __version__) -> None:
        self.directory = directory
        self.plan = plan
        self._version = version

    @classmethod
    def at(cls, directory: str | Path, **asked: int) -> Campaign:
        """Begin a campaign, or open the one of a directory.

        Args:
            directory: New, empty, with a campaign in it, or with evolutionary runs to adopt.
            asked: Attributes of `Plan`; the others are as in the directory, or the paper's. More
                runs or generations than there are extend the campaign.

        Raises:
            CampaignError: The directory holds another campaign or something else, or cannot be
                written; or the plan cannot be used.
        """
        directory = Path(directory)
        path = directory / "campaign.yaml"
        version = __version__
        try:
            if path.exists():
                text = read_file(path, MAX_CHARACTERS)
                plan, version = Plan.from_yaml(text), version_of(text)
            else:
                plan = Plan(**asked)
        except (PlanError, NotTextError, OSError) as error:
            where = f"{path}: " if path.exists() else ""
            raise CampaignError(f"{where}{_reason(error)}") from error
        campaign = cls(directory, plan, version)
        if not path.exists():
            campaign._begin()
        elif plan.differences(asked):
            campaign._extend(asked)
        return campaign

    @property
    def remarks(self) -> tuple[str, ...]:
        """What whoever continues it should know, of its runs too: sentences, usually none."""
        return version_remarks("This campaign", self._version) + tuple(self._remarks_of_runs())

    def _remarks_of_runs(self) -> Iterator[str]:
        for seed in self.plan.seeds:
            place = self.place_of(seed)
            with suppress(StoreError):  # there is none, or that is told when its turn comes
                run = EvolutionRun.read(place)
                if not run.finished:
                    yield from (f"{place.name}: {remark}" for remark in run.remarks)
                run.close()

    def run(
        self,
        workers: int | None = None,
        executor: Executor | None = None,
        on_progress: OnProgress | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> Results:
        """Do what is not done yet, and write the report.

        Args:
            workers: Threads that simulate; None for one per core.
            executor: Evolves in place of threads of this process; the results are the same.
            on_progress: Hears what is being done.
            stop: Asked now and then.

        Raises:
            EvaluationStopped: `stop` returned True; what is done is kept.
            CampaignError: A file cannot be written or is not what it was.
            StoreError: A run of the evolution cannot be continued.
            EvaluationError: The executor failed; what is done is kept.
        """
        meter = Meter(self.parts(), on_progress)
        histories: dict[str, list[GenerationRecord]] = {}
        rule_sets: dict[str, RuleSet] = {}
        for seed in self.plan.seeds:
            name = evolved_name(seed)
            histories[name], rule_sets[name] = self._evolve(seed, workers, executor, meter, stop)
        rule_sets |= {EVO_8: load_preset("evo8"), HAND_CODED: load_preset("hand-coded")}

        def carry_out(name: str, cases: list[Case]) -> Samples:
            return self._carry_out(name, cases, rule_sets, workers, meter, stop)

        performance = carry_out("performance", studies.performance(list(histories)))
        best = best_of(performance, list(histories))
        others = {name: carry_out(name, cases) for name, cases in studies.others(best).items()}
        results = Results(self.plan, histories, rule_sets, performance, **others)
        for path, text in files_of(results).items():
            self._write(path, text)
        return results

    def parts(self) -> list[Part]:
        """How far each part is, as the files say; another process may be at work on them."""
        generations = {evolved_name(seed): self._generations(seed) for seed in self.plan.seeds}
        return [
            Part(name, generations[name], self.plan.generations, work)
            if name in generations
            else Part(name, int(self._is_done(name)), 1, work)
            for name, work in works_of(self.plan).items()
        ]

    def _begin(self) -> None:
        try:
            with locks.new_directory(self.directory):
                found = {entry.name for entry in self.directory.iterdir() if entry.name[0] != "."}
                if strange := sorted(found - {"evolution"}):
                    raise CampaignError(
                        f"{self.directory}: expected an empty directory or a campaign, "
                        f"found {strange[0]}"
                    )
                locks.require_locks(self.directory)
                for seed in self.plan.seeds:
                    locks.require_short_path(self.place_of(seed))
        except StoreError as error:
            raise CampaignError(str(error)) from error
        except OSError as error:
            raise CampaignError(f"{self.directory}: {_reason(error)}") from error
        self._write("campaign.yaml", self.plan.to_yaml())

    def _extend(self, asked: Mapping[str, int]) -> None:
        """Have more runs or generations: what would be other figures then goes first."""
        try:
            plan = self.plan.extended(asked)
        except PlanError as error:
            raise CampaignError(
                f"{self.directory}: {error}; choose another directory, leave these options out to "
                "go on with it, or ask for more runs or generations"
            ) from error
        gone = [self.data_of(name) for name in studies.OF_THE_EVOLVED]
        for path in (self.directory / "report.html", *gone):
            try:
                path.unlink(missing_ok=True)
            except OSError as error:
                raise CampaignError(f"{path}: cannot be deleted: {_reason(error)}") from error
        self._write("campaign.yaml", plan.to_yaml(self._version))
        self.plan = plan

    def _evolve(
        self,
        seed: int,
        workers: int | None,
        executor: Executor | None,
        meter: Meter,
        stop: Callable[[], bool] | None,
    ) -> tuple[list[GenerationRecord], RuleSet]:
        """Evolve to the end; the history, and the best rule set."""
        place, config = self.place_of(seed), self.plan.run_config(seed)
        exists = (place / "run.db").exists()
        run = EvolutionRun.resume(place) if exists else EvolutionRun.create(config, place)
        try:
            present = run.config.settings.generations
            shorter = replace(config, settings=replace(config.settings, generations=present))
            if run.config != shorter or present > self.plan.generations or run.steering:
                raise CampaignError(
                    f"{place}: expected a run in the scenario paper with the preset paper, seed "
                    f"{seed}, at most {self.plan.generations} generations and no changes on the way"
                )
            run.extend(self.plan.generations)
            run.run(workers, lambda record: meter.evolved(seed, record), stop, executor)
            if not run.finished:
                raise EvaluationStopped("the campaign was stopped")
            if run.best is None:
                raise CampaignError(f"{place}: expected a valid individual, found none")
            named = replace(run.best.origin, run=f"evolution/seed-{seed}")
            return run.history, replace(run.best, origin=named)
        finally:
            run.close()

    def _carry_out(
        self,
        name: str,
        cases: list[Case],
        rule_sets: dict[str, RuleSet],
        workers: int | None,
        meter: Meter,
        stop: Callable[[], bool] | None,
    ) -> Samples:
        """Run an experiment, or read what it gave."""
        path = self.data_of(name)
        if self._is_done(name):
            try:
                return parse_samples(decode(path.read_bytes()), cases, self.plan.evaluations)
            except (OSError, ValueError, OverflowError) as error:
                raise CampaignError(
                    f"{path}: not the {name} runs of this campaign; delete it to have them anew"
                ) from error
        samples = run_cases(
            cases,
            rule_sets,
            self.plan.evaluations,
            self.plan.seed,
            workers,
            stop,
            meter.simulated(name),
        )
        self._write(str(path.relative_to(self.directory)), format_samples(samples))
        return samples

    def place_of(self, seed: int) -> Path:
        """The directory of an evolutionary run."""
        return self.directory / "evolution" / f"seed-{seed}"

    def data_of(self, name: str) -> Path:
        """The file with the runs of an experiment."""
        return self.directory / "data" / f"{name}.csv"

    def _generations(self, seed: int) -> int:
        """How many are evolved."""
        path = self.place_of(seed) / "history.csv"
        return max(0, len(path.read_bytes().splitlines()) - 1) if path.exists() else 0

    def _is_done(self, experiment: str) -> bool:
        return self.data_of(experiment).exists()

    def _write(self, name: str, text: str) -> None:
        path = self.directory / name
        try:
            path.parent.mkdir(exist_ok=True)
            write_whole(text, path, through_links=False)
        except OSError as error:
            raise CampaignError(f"{path}: cannot be written: {_reason(error)}") from error


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
