import json
import random
from dataclasses import replace

import pytest

from geswarm.evolution import rule_grammar
from geswarm.ge.engine import CallOrderError, CheckpointError, Engine, FitnessError
from geswarm.ge.evolve import Stopped, evolve
from geswarm.ge.grammar import Grammar
from geswarm.ge.settings import Settings, SettingsError
from geswarm.rules import FORAGING

SMALL = Settings(population=20, generations=12)


def count_true(generation, individuals):
    """A toy objective that depends on everything an evaluator may use."""
    noise = [random.Random(f"{generation} {one.key}").random() for one in individuals]
    return [one.phenotype.count("true") + x for one, x in zip(individuals, noise, strict=True)]


def without_seconds(records):
    return [record.csv_row().rsplit(",", 1)[0] for record in records]


def test_the_defaults_are_the_papers():
    paper = Settings()
    assert (paper.population, paper.generations, paper.evaluations) == (100, 1000, 3)
    assert (paper.crossover, paper.mutation, paper.elites, paper.max_wraps) == (0.3, 0.05, 5, 3)


def test_settings_name_every_mistake():
    with pytest.raises(SettingsError) as caught:
        Settings(population=1, crossover=1.5, mutation="high", elitism=1.0, max_wraps=-1)
    assert list(caught.value.findings) == [
        "population: expected a whole number >= 2, got 1",
        "crossover: expected a probability in [0, 1], got 1.5",
        "mutation: expected a probability in [0, 1], got 'high'",
        "elitism: expected a fraction of the population in [0, 1), got 1.0",
        "max_wraps: expected a whole number >= 0, got -1",
    ]


@pytest.mark.parametrize(
    ("population", "elitism", "elites"),
    [(100, 0, 0), (10, 0.05, 1), (10, 0.99, 9), (100, 0.29, 29)],
)
def test_number_of_elites(population, elitism, elites):
    assert Settings(population=population, elitism=elitism).elites == elites


@pytest.mark.parametrize("seed", [-1, 1.5, True, "1"])
def test_seed_is_a_whole_number(grammar, seed):
    with pytest.raises(ValueError, match="seed: expected a whole number >= 0"):
        Engine(grammar, SMALL, seed)


def test_call_order(grammar):
    engine = Engine(grammar, SMALL)
    with pytest.raises(CallOrderError, match=r"tell\(\) without ask\(\)"):
        engine.tell([])
    asked = engine.ask()
    with pytest.raises(CallOrderError, match="20 fitness values for generation 1"):
        engine.ask()
    engine.tell([1.0] * len(asked))
    with pytest.raises(CallOrderError):
        engine.tell([1.0] * len(asked))


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -float("inf"), None, "x"])
def test_bad_fitness_changes_nothing(grammar, bad):
    engine = Engine(grammar, SMALL)
    asked = engine.ask()
    with pytest.raises(FitnessError, match="individual 3: expected a finite number, got"):
        engine.tell([1.0, 2.0, 3.0, bad] + [0.0] * 16)
    with pytest.raises(FitnessError, match="expected 20 values, one per asked individual, got 19"):
        engine.tell([1.0] * 19)
    assert engine.generation == 0
    engine.tell([1.0] * len(asked))
    assert engine.generation == 1


def test_withdrawn_individuals_are_asked_again(grammar):
    engine = Engine(grammar, SMALL, seed=4)
    engine.tell(count_true(1, engine.ask()))
    asked = engine.ask()
    engine.withdraw()
    assert engine.ask() == asked


def test_individuals_are_numbered_and_invalid_ones_are_not_asked():
    # Every second codon value goes on for ever if it is the only one: many mappings do not end.
    grammar = Grammar.parse("<s> ::= <s> <s> x | y")
    engine = Engine(grammar, Settings(population=30, generations=40, mutation=0.5, max_wraps=0), 2)
    invalid = 0
    while not engine.finished:
        asked = engine.ask()
        keys = [one.key for one in asked]
        assert keys == sorted(set(keys))
        assert set(keys) <= set(range(30))
        assert all(one.generation == engine.generation + 1 for one in asked)
        assert all(one.phenotype is not None for one in asked)
        record = engine.tell([1.0] * len(asked))
        assert record.invalid == 30 - len(asked)
        assert record.mean == pytest.approx(len(asked) / 30)
        assert len(engine.population) == 30
        assert all(one.fitness == (one.phenotype is not None) for one in engine.population)
        invalid += record.invalid
    assert invalid > 0


@pytest.mark.parametrize("preset", ["paper", "modern"])
def test_fitness_may_have_any_sign(grammar, preset):
    """Where there is only loss, those who lose least are the fittest."""
    settings = Settings.preset(preset, population=30, generations=12)
    one, other = Engine(grammar, settings, seed=3), Engine(grammar, settings, seed=3)
    means = []
    while not one.finished:
        asked = one.ask()
        assert asked == other.ask()
        losses = [value - 100.0 for value in count_true(1, asked)]
        record = one.tell(losses)
        other.tell(losses)
        assert record.best_so_far == one.best.value < 0
        means.append(record.mean)
    assert one.state() == other.state()
    assert means[-1] > means[0]
    assert Engine.restore(grammar, settings, 3, one.state()).population == one.population


def test_the_invalid_are_worth_no_more_than_the_worst():
    grammar = Grammar.parse("<s> ::= <s> <s> x | y")
    engine = Engine(grammar, Settings(population=30, generations=5, mutation=0.5, max_wraps=0), 2)
    invalid = 0
    while not engine.finished:
        losses = {one.key: -5.0 - one.key for one in engine.ask()}
        known = [one.fitness for one in engine.population if one.phenotype is not None]
        engine.tell(list(losses.values()))
        worst = min([*losses.values(), *known])
        for one in engine.offspring:
            assert one.fitness == losses.get(one.key, worst)
            invalid += one.phenotype is None
    assert invalid > 0


def test_elites_survive_with_their_fitness_in_place_of_the_worst(grammar):
    engine = Engine(grammar, Settings(population=20, generations=5, elitism=0.1), 1)
    assert len(engine.ask()) == 20
    engine.tell([float(key) for key in range(20)])
    elites = engine.population[:2]
    assert [(one.generation, one.key, one.fitness) for one in elites] == [
        (1, 19, 19.0),
        (1, 18, 18.0),
    ]
    asked = engine.ask()
    told = [(one.key + 1) / 100 for one in asked]
    record = engine.tell(told)
    assert engine.population[:2] == elites
    offspring = sorted([*told, *[0.0] * (20 - len(asked))], reverse=True)
    assert [one.fitness for one in engine.population[2:]] == offspring[:18]
    assert all(one.generation == 2 for one in engine.population[2:])
    assert (record.best_so_far, record.best) == (19.0, max(told))
    assert engine.best == elites[0]


def test_without_elitism_the_best_so_far_is_remembered(grammar):
    engine = Engine(grammar, Settings(population=10, generations=2, elitism=0), 1)
    engine.tell([7.0] + [1.0] * (len(engine.ask()) - 1))
    record = engine.tell([2.0] * len(engine.ask()))
    assert (record.best_so_far, record.best) == (7.0, 2.0)
    assert (engine.best.generation, engine.best.key) == (1, 0)
    engine.tell([7.0] * len(engine.ask()))
    assert engine.best.generation == 1  # the first of equals
    engine.tell([7.5] * len(engine.ask()))
    assert engine.best.generation == 4


@pytest.mark.parametrize(
    ("crossover", "mutation", "least", "most"),
    [(0.0, 0.0, 0.0, 0.0), (0.3, 0.0, 0.2, 0.36), (1.0, 0.0, 0.8, 1.0), (0.0, 1.0, 1.0, 1.0)],
)
def test_how_many_are_new(grammar, crossover, mutation, least, most):
    settings = Settings(population=1001, generations=2, crossover=crossover, mutation=mutation)
    engine = Engine(grammar, settings)
    parents = engine.ask()
    engine.tell([1.0] * len(parents))
    known = {one.genome for one in parents}
    children = engine.ask()
    new = sum(one.genome not in known for one in children) + 1001 - len(children)
    assert least <= new / 1001 <= most


def test_same_seed_same_run_other_seed_other_run(grammar):
    runs = [evolve(Engine(grammar, SMALL, seed), count_true) for seed in (5, 5, 6)]
    assert without_seconds(runs[0].records) == without_seconds(runs[1].records)
    assert runs[0].best == runs[1].best
    assert without_seconds(runs[0].records) != without_seconds(runs[2].records)


@pytest.mark.parametrize("after", range(SMALL.generations + 1))
def test_a_restored_engine_continues_exactly(grammar, after):
    whole = Engine(grammar, SMALL, 9)
    expected = evolve(whole, count_true)
    first = Engine(grammar, SMALL, 9)
    begun = evolve(first, count_true, stop=lambda: first.generation == after)
    state = json.loads(json.dumps(first.state()))
    second = Engine.restore(grammar, SMALL, 9, state)
    assert second.state() == first.state()
    continued = evolve(second, count_true)
    records = begun.records + continued.records
    assert without_seconds(records) == without_seconds(expected.records)
    assert json.dumps(second.state()) == json.dumps(whole.state())
    assert second.best == whole.best
    assert second.population == whole.population


@pytest.mark.parametrize("damage", ["generation", "population", "best"])
def test_a_damaged_state_is_refused(grammar, damage):
    engine = Engine(grammar, SMALL)
    evolve(engine, count_true, stop=lambda: engine.generation == 1)
    state = engine.state()
    with pytest.raises(CheckpointError, match="checkpoint: expected"):
        Engine.restore(grammar, SMALL, 0, {**state, damage: "?"})
    del state[damage]
    with pytest.raises(CheckpointError, match="checkpoint: expected"):
        Engine.restore(grammar, SMALL, 0, state)


def test_codons_out_of_range_are_refused(grammar):
    engine = Engine(grammar, SMALL)
    evolve(engine, count_true, stop=lambda: engine.generation == 1)
    state = engine.state()
    state["population"][2]["genome"][0] = 1 << 31
    with pytest.raises(CheckpointError, match="codons"):
        Engine.restore(grammar, SMALL, 0, state)


def test_a_state_of_another_grammar_is_refused(grammar):
    engine = Engine(grammar, SMALL)
    evolve(engine, count_true, stop=lambda: engine.generation == 2)
    other = rule_grammar(replace(FORAGING, probabilities=(0.5,)))
    with pytest.raises(CheckpointError, match="grammar and vocabulary of the run"):
        Engine.restore(other, SMALL, 0, engine.state())


def test_evolve_stops_between_generations_and_goes_on(grammar):
    engine = Engine(grammar, SMALL, 3)
    seen = []
    result = evolve(engine, count_true, on_generation=seen.append, stop=lambda: len(seen) == 4)
    assert not result.finished
    assert [record.generation for record in seen] == [1, 2, 3, 4]
    assert tuple(seen) == result.records
    rest = evolve(engine, count_true)
    assert rest.finished
    assert [record.generation for record in rest.records] == list(range(5, 13))
    assert without_seconds(result.records + rest.records) == without_seconds(
        evolve(Engine(grammar, SMALL, 3), count_true).records
    )


def test_an_objective_may_stop_within_a_generation(grammar):
    def stops(generation, individuals):
        if generation == 3:
            raise Stopped
        return count_true(generation, individuals)

    engine = Engine(grammar, SMALL, 3)
    result = evolve(engine, stops)
    assert (engine.generation, len(result.records), result.finished) == (2, 2, False)
    assert evolve(engine, count_true).finished


def test_an_objective_that_fails_leaves_the_engine_usable(grammar):
    engine = Engine(grammar, SMALL, 3)
    with pytest.raises(ZeroDivisionError):
        evolve(engine, lambda generation, individuals: 1 / 0)
    with pytest.raises(FitnessError):
        evolve(engine, lambda generation, individuals: [])
    assert evolve(engine, count_true).finished


def test_the_papers_preset_evolves_a_good_value(grammar):
    # Nine conditions in at most four rules: rare among random derivations.
    def objective(generation, individuals):
        texts = [one.phenotype.split() for one in individuals]
        return [max(0, t.count("==") + 5 - 3 * max(0, t.count("rule") - 4)) for t in texts]

    result = evolve(Engine(grammar, Settings(generations=40), seed=1), objective)
    assert result.records[0].best < 20
    assert result.best.fitness >= 30
