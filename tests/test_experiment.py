"""Evolving foraging rules: the whole way from genome to best.yaml."""

import threading
from dataclasses import replace

import pytest
import yaml
from hypothesis import given

from geswarm.experiment import (
    EvolutionRun,
    ForagingFitness,
    RunConfig,
    RunConfigError,
    evaluate_rule_sets,
    foraging_grammar,
)
from geswarm.ge import Engine, Mapper, Settings, StoreError, genome_of
from geswarm.rules import RuleSet, format_text, load_preset, load_rule_set, parse_text
from geswarm.sim import load_scenario
from tests.strategies import plain_rule_sets

QUICK = load_scenario("paper").with_changes(duration=50.0)
SMALL = Settings(population=12, generations=4, evaluations=2)
CONFIG = RunConfig(QUICK, SMALL, seed=5)


def rows(directory):
    """history.csv without its last column, seconds."""
    lines = (directory / "history.csv").read_text().splitlines()
    return [line.rpartition(",")[0] for line in lines]


def evolved(directory, **options):
    run = EvolutionRun.create(CONFIG, directory)
    run.run(**options)
    run.close()
    return run


def as_phenotype(rule_set):
    """The sentence of a rule set without its name, which the grammar does not derive."""
    return " ".join(format_text(rule_set).removeprefix('name ""').split())


@given(plain_rule_sets())
def test_any_rule_set_of_the_grammar_has_a_genome_that_maps_back_to_it(rule_set):
    grammar = foraging_grammar()
    genome = genome_of(grammar, as_phenotype(rule_set))
    phenotype, _ = Mapper(grammar).map(genome, 0)
    assert parse_text(phenotype) == rule_set


def test_every_initial_phenotype_is_a_rule_set():
    individuals = Engine(foraging_grammar(), Settings(), seed=1).ask()
    for individual in individuals:
        rule_set = parse_text(individual.phenotype)
        assert rule_set.rules
        assert all(rule.actions for rule in rule_set.rules)


def test_a_run_directory_holds_everything(tmp_path):
    run = evolved(tmp_path / "run")
    assert sorted(path.name for path in run.directory.iterdir() if "-" not in path.name) == [
        "best.yaml",
        "config.yaml",
        "history.csv",
        "run.db",
    ]
    header, *lines = (run.directory / "history.csv").read_text().splitlines()
    assert header == "generation,best_so_far,best,mean,invalid,distinct,seconds"
    assert [line.split(",")[0] for line in lines] == ["1", "2", "3", "4"]
    config = yaml.safe_load((run.directory / "config.yaml").read_text())
    assert config["scenario"]["duration"] == 50.0
    assert config["evolution"]["population"] == 12
    best = load_rule_set(str(run.directory / "best.yaml"))
    assert best == run.best
    assert best.origin.run == str(run.directory)
    assert best.origin.fitness == run.history[-1].best_so_far


def test_same_seed_same_history_whatever_the_workers(tmp_path):
    one, three = evolved(tmp_path / "1", workers=1), evolved(tmp_path / "3", workers=3)
    assert rows(one.directory) == rows(three.directory)
    assert replace(one.best, origin=three.best.origin) == three.best


@pytest.mark.parametrize("generations_before", [0, 1, 3])
def test_a_stopped_run_goes_on_exactly(tmp_path, generations_before):
    whole = evolved(tmp_path / "whole")
    stop = threading.Event()
    if generations_before == 0:
        stop.set()

    def after(record):
        if record.generation == generations_before:
            stop.set()

    part = evolved(tmp_path / "part", on_generation=after, stop=stop.is_set)
    assert not part.finished
    resumed = EvolutionRun.resume(part.directory)
    assert len(resumed.history) == generations_before
    resumed.run()
    resumed.close()
    assert rows(part.directory) == rows(whole.directory)
    assert (part.directory / "best.yaml").exists()


def test_a_stop_within_a_generation_loses_only_that_one(tmp_path):
    calls = 0

    def stop():
        nonlocal calls
        calls += 1
        return calls > 12

    run = evolved(tmp_path / "run", stop=stop, workers=1)
    assert not run.finished
    assert len(rows(run.directory)) == 1 + len(run.history)


def test_fitness_is_the_mean_of_the_evaluations():
    engine = Engine(foraging_grammar(), SMALL, seed=2)
    individuals = engine.ask()
    together = ForagingFitness(QUICK, 2, 3)(1, individuals)
    alone = [ForagingFitness(QUICK, 2, 3)(1, [one])[0] for one in individuals]
    assert together == alone


def test_evaluations_are_paired_and_keyed_by_seed():
    evo8 = load_preset("evo8")
    first, again = evaluate_rule_sets([evo8, evo8], QUICK, runs=5, seed=1)
    assert first.collected.tolist() == again.collected.tolist()
    (other,) = evaluate_rule_sets([evo8], QUICK, runs=60, seed=2)
    (more,) = evaluate_rule_sets([evo8], QUICK, runs=70, seed=2)
    assert more.collected[:60].tolist() == other.collected.tolist()
    (nothing,) = evaluate_rule_sets([RuleSet()], QUICK, runs=2)
    assert nothing.mean == 0.0


def test_config_round_trips_and_foreign_ones_are_refused(tmp_path):
    assert RunConfig.from_yaml(CONFIG.to_yaml()) == CONFIG
    for text in ("", "[]", "seed: 1", "a: [", CONFIG.to_yaml().replace("robots: 4", "robots: -4")):
        with pytest.raises(RunConfigError, match="not the configuration of a run"):
            RunConfig.from_yaml(text)
    with pytest.raises(StoreError, match=r"no run\.db"):
        EvolutionRun.resume(tmp_path)
