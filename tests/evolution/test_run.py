"""Evolving foraging rules: the whole way from genome to best.yaml."""

import threading
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest
import yaml
from hypothesis import given

from geswarm import __version__
from geswarm.evaluation import Evaluation, evaluate_rule_sets
from geswarm.evolution import (
    Composition,
    EvolutionRun,
    InjectionError,
    RunConfig,
    RunConfigError,
    ScenarioFitness,
    rule_grammar,
)
from geswarm.ge import Engine, Mapper, Settings, SettingsError, StoreError, genome_of
from geswarm.ge.ranking import CODON_COST
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
    grammar = rule_grammar()
    genome = genome_of(grammar, as_phenotype(rule_set))
    phenotype, _ = Mapper(grammar).map(genome, 0)
    assert parse_text(phenotype) == rule_set


def test_every_initial_phenotype_is_a_rule_set():
    individuals = Engine(rule_grammar(), Settings(), seed=1).ask()
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


@pytest.mark.parametrize("preset", ["paper", "modern"])
def test_a_run_that_is_extended_is_the_one_that_was_longer_from_the_start(tmp_path, preset):
    settings = Settings.preset(preset, population=12, generations=6, evaluations=2)
    whole = EvolutionRun.create(RunConfig(QUICK, settings, seed=5), tmp_path / "whole")
    whole.run()
    short = RunConfig(QUICK, replace(settings, generations=3), seed=5)
    part = EvolutionRun.create(short, tmp_path / "part")
    assert part.run().finished
    for run in (whole, part):
        run.close()
    longer = EvolutionRun.resume(part.directory, generations=6)
    assert not longer.finished
    longer.run()
    longer.close()
    assert rows(part.directory) == rows(whole.directory)
    for name in ("config.yaml", "best.yaml"):
        text = (whole.directory / name).read_text().replace(str(whole.directory), "")
        assert (part.directory / name).read_text().replace(str(part.directory), "") == text


def test_a_run_cannot_have_fewer_generations_than_are_done(tmp_path):
    run = evolved(tmp_path / "run")
    before = rows(run.directory)
    for wrong in (3, 0, 10**9):
        with pytest.raises(SettingsError, match=r"generations: .*expected"):
            EvolutionRun.resume(run.directory, wrong)
    same = EvolutionRun.resume(run.directory, 4)
    assert same.finished
    assert same.config == CONFIG
    same.close()
    assert rows(run.directory) == before


def test_what_there_is_to_know_of_a_run_is_said_when_it_is_resumed(tmp_path):
    began = replace(CONFIG, version="0.0.7")
    EvolutionRun.create(began, tmp_path / "run").close()
    config = tmp_path / "run" / "config.yaml"
    config.write_text(config.read_text().replace("generations: 4", "generations: 400"))
    run = EvolutionRun.resume(tmp_path / "run", 5)
    version, edited = run.remarks
    assert f"began with GESwarm 0.0.7 and goes on with {__version__}: results may" in version
    assert "config.yaml had been changed; what counts is run.db" in edited
    run.close()
    assert "generations: 5" in config.read_text()
    assert "geswarm: 0.0.7" in config.read_text()
    again = EvolutionRun.resume(tmp_path / "run")
    assert again.remarks == (version,)
    again.close()
    assert evolved(tmp_path / "own").remarks == ()


def test_links_in_a_run_of_somebody_else_are_not_followed(tmp_path):
    directory, outside = tmp_path / "run", tmp_path / "outside"
    run = EvolutionRun.create(CONFIG, directory)
    run.run(stop=lambda: len(run.history) == 1)
    run.close()
    outside.write_text("kept")
    for name in ("best.yaml", "config.yaml", "history.csv"):
        (directory / name).unlink()
        for link in (name, f"{name}.part", f".{name}.part"):
            (directory / link).symlink_to(outside)
    again = EvolutionRun.resume(directory)
    again.run()
    again.close()
    assert outside.read_text() == "kept"
    evolved(tmp_path / "whole")
    assert rows(directory) == rows(tmp_path / "whole")
    assert load_rule_set(str(directory / "best.yaml")).rules


def test_a_stop_within_a_generation_loses_only_that_one(tmp_path):
    calls = 0

    def stop():
        nonlocal calls
        calls += 1
        return calls > 3

    run = evolved(tmp_path / "run", stop=stop, workers=1)
    assert not run.finished
    assert len(rows(run.directory)) == 1 + len(run.history)


def test_fitness_is_the_mean_of_the_evaluations():
    engine = Engine(rule_grammar(), SMALL, seed=2)
    individuals = engine.ask()
    together = ScenarioFitness(QUICK, 2, 3)(1, individuals)
    alone = [ScenarioFitness(QUICK, 2, 3)(1, [one])[0] for one in individuals]
    assert together == alone


def test_evaluations_are_paired_and_keyed_by_seed():
    evo8 = load_preset("evo8")
    first, again = evaluate_rule_sets([evo8, evo8], QUICK, runs=5, seed=1)
    assert first.fitness.tolist() == again.fitness.tolist()
    (other,) = evaluate_rule_sets([evo8], QUICK, runs=60, seed=2)
    (more,) = evaluate_rule_sets([evo8], QUICK, runs=70, seed=2)
    assert more.fitness[:60].tolist() == other.fitness.tolist()
    (nothing,) = evaluate_rule_sets([RuleSet()], QUICK, runs=2)
    assert nothing.mean == 0.0


def test_config_round_trips_and_foreign_ones_are_refused(tmp_path):
    assert RunConfig.from_yaml(CONFIG.to_yaml()) == CONFIG
    for text in ("", "[]", "seed: 1", "a: [", CONFIG.to_yaml().replace("robots: 4", "robots: -4")):
        with pytest.raises(RunConfigError, match="not the configuration of a run"):
            RunConfig.from_yaml(text)
    for twice in (
        CONFIG.to_yaml() + "seed: 1\n",
        CONFIG.to_yaml().replace("{", "{crossover: 1, ", 1),
    ):
        with pytest.raises(RunConfigError, match=r"'(seed|crossover)' is given twice"):
            RunConfig.from_yaml(twice)
    with pytest.raises(StoreError, match=r"no run\.db"):
        EvolutionRun.resume(tmp_path)


def test_an_unknown_setting_is_named_and_the_version_that_knew_it():
    text = CONFIG.to_yaml().replace("parsimony", "parsimoni").replace(__version__, "0.0.7")
    words = f"of GESwarm 0.0.7; this is {__version__}.*unknown setting 'parsimoni'; "
    with pytest.raises(RunConfigError, match=f"{words}did you mean 'parsimony'"):
        RunConfig.from_yaml(text)
    with pytest.raises(RunConfigError, match="unknown: castes"):
        RunConfig.from_yaml(f"{CONFIG.to_yaml()}castes: 2")


MODERN = replace(CONFIG, settings=Settings.preset("modern", population=12, generations=4))
FROZEN = parse_text("rule if ON_NEST == true do p = 1, DROP_OBJECT = true").rules
MINE = parse_text("rule do p = 0.1, RANDOM_WALK  rule off do p = 0.3, PHOTOTAXIS")


@given(plain_rule_sets())
def test_a_composition_turns_rule_sets_into_phenotypes_and_back(rule_set):
    composition = Composition(FROZEN)
    whole = RuleSet((*FROZEN, *rule_set.rules))
    assert composition.rule_set(composition.phenotype(whole)) == whole
    assert Composition().phenotype(rule_set) == as_phenotype(rule_set)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rule do p = 0.15, RANDOM_WALK", r"rule 1: p = 0\.15 cannot evolve, .* nearest is 0\.1"),
        ("rule off do p = 1, RANDOM_WALK", "expected more than 0 rules switched on, got 0"),
        ("rule if ON_NEST == true", "the grammar does not derive"),
    ],
)
def test_what_cannot_be_injected_says_why(tmp_path, text, message):
    run = EvolutionRun.create(CONFIG, tmp_path / "run")
    with pytest.raises(InjectionError, match=message):
        run.inject(parse_text(text))
    run.close()


def test_frozen_rules_stay(tmp_path):
    config = replace(MODERN, frozen=FROZEN)
    assert RunConfig.from_yaml(config.to_yaml()) == config
    run = EvolutionRun.create(config, tmp_path / "run")
    with pytest.raises(InjectionError, match="rule 1 is frozen"):
        run.inject(MINE)
    run.inject(RuleSet((*FROZEN, *MINE.rules)))
    run.run()
    assert run.best.rules[: len(FROZEN)] == FROZEN
    assert all(one.rule_set.rules[: len(FROZEN)] == FROZEN for one in run.population().members)
    run.close()
    assert load_rule_set(str(tmp_path / "run" / "best.yaml")).rules[0] == FROZEN[0]


@pytest.mark.parametrize("config", [CONFIG, MODERN], ids=["paper", "modern"])
@pytest.mark.parametrize("until", [2, 3])
def test_a_steered_run_resumes_exactly(tmp_path, config, until):
    def steer(run, record):
        if record.generation == 2:
            run.inject(MINE)
            run.steer(mutation=0.4)

    def evolve_until(directory, last):
        run = EvolutionRun.create(config, directory)
        stop = threading.Event()

        def after(record):
            steer(run, record)
            if record.generation == last:
                stop.set()

        run.run(on_generation=after, stop=stop.is_set)
        return run

    whole, part = evolve_until(tmp_path / "whole", None), evolve_until(tmp_path / "part", until)
    part.close()
    again = EvolutionRun.resume(tmp_path / "part")
    again.run(on_generation=lambda record: None)
    if until > 2:  # it had begun when the run was stopped
        assert rows(again.directory) == rows(whole.directory)
        assert again.steering == whole.steering
        assert [one.generation for one in again.steering] == [3, 3]
        assert again.settings.mutation == 0.4
        assert again.config.settings == config.settings
    whole.close()
    again.close()


def test_the_population_and_its_genealogy_can_be_looked_at(tmp_path):
    run = EvolutionRun.create(MODERN, tmp_path / "run")
    assert run.population().members == ()
    assert run.genealogy() == []
    run.run()
    population = run.population()
    assert len(population.members) == 12
    firsts = {one.behaviour: one for one in reversed(population.members)}  # copies come last
    assert set(population.members[: len(firsts)]) == set(firsts.values())
    for told in {one.told for one in firsts.values()}:  # who is known equally well
        members = [one for one in population.members[: len(firsts)] if one.told == told]
        worth = [one.fitness / (1 + CODON_COST * one.codons) for one in members]
        assert worth == sorted(worth, reverse=True)
    assert population.behaviours == len({one.behaviour for one in population.members})
    assert 1 <= population.diversity <= population.behaviours
    line = run.genealogy()
    assert parse_text(line[-1].phenotype).rules == run.best.rules
    assert all(one.parents == () for one in line if one.generation == 1)
    run.close()


def test_equal_behaviours_have_one_key():
    behaviour = Composition().behaviour
    plain = "rule if ON_NEST == true do p = 0.1, PHOTOTAXIS"
    twice = plain.replace("if ON_NEST == true", "if ON_NEST == true and ON_NEST == true")
    never = plain + " rule if ON_NEST == true and ON_SOURCE == true do p = 1, RANDOM_WALK"
    assert behaviour(plain) == behaviour(twice) == behaviour(never)
    assert behaviour(plain) != behaviour(plain.replace("0.1", "0.05"))


def test_a_run_can_be_read_while_it_is_written(tmp_path):
    run = EvolutionRun.create(CONFIG, tmp_path / "run")
    looks = []

    def look(record):
        other = EvolutionRun.read(tmp_path / "run")
        looks.append((len(other.history), other.population(), other.genealogy(), other.best))
        assert looks[-1] == (record.generation, run.population(), run.genealogy(), run.best)
        other.close()

    run.inject(MINE)
    run.run(on_generation=look)
    assert len(looks) == 4
    assert [one.key for one in run.bred(1)] == list(range(13))
    run.close()
    other = EvolutionRun.read(tmp_path / "run")
    assert other.finished
    other.close()


def test_notebooks_show_the_figures_of_an_evaluation():
    fitness, lost = np.array([1.0, 2.0, 6.0]), np.array([0.0, 1.0, 1.0])
    evaluation = Evaluation(QUICK.objective, fitness, {"collected": fitness, "lost": lost})
    rows = list(ElementTree.fromstring(evaluation._repr_html_()))
    head, figures = ([cell.text for cell in row] for row in rows)
    assert dict(zip(head, figures, strict=True)) == {
        "runs": "3",
        "mean": "3",
        "sd": "2.6458",
        "median": "2",
        "lost, mean": "0.66667",
    }
