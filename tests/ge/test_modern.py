"""What the preset `modern` adds: shared and repeated evaluations, and steering of any run."""

import json
import random

import numpy as np
import pytest

from geswarm.ge import (
    CallOrderError,
    Engine,
    Injection,
    NotASentenceError,
    RunStore,
    Settings,
    SettingsChange,
    SettingsError,
    Stopped,
    StoredSteering,
    evolve,
)
from geswarm.ge.engine import TRUSTED
from geswarm.ge.operators import tournament

MODERN = Settings.preset("modern", population=20, generations=12, elitism=0.2)
PAPER = Settings(population=20, generations=12)
SENTENCE = "rule if ON_NEST == true do p = 0.1, PHOTOTAXIS"


def rules_of(sentence):
    """A toy behaviour: the rules whatever their order."""
    return tuple(sorted(sentence.split("rule")))


def noisy(generation, individuals):
    return [
        one.phenotype.count("true") + random.Random(f"{generation} {one.phenotype}").random()
        for one in individuals
    ]


def without_seconds(records):
    return [record.csv_row().rsplit(",", 1)[0] for record in records]


def test_presets_are_named():
    assert Settings.preset("paper") == Settings()
    assert Settings.preset("modern", population=7).population == 7
    for name, message in (("fast", "preset: expected paper or modern, got 'fast'"),):
        with pytest.raises(SettingsError, match=message):
            Settings.preset(name)
    with pytest.raises(SettingsError, match="unknown setting 'colour'; expected population or"):
        Settings.preset("paper", colour=1)
    with pytest.raises(SettingsError) as caught:
        Settings(selection="luck", parsimony=1, tournament=0, scaling=-1)
    assert list(caught.value.findings) == [
        "selection: expected roulette or tournament, got 'luck'",
        "scaling: expected a power in [0, 100], got -1",
        "tournament: expected a whole number >= 1, got 0",
        "parsimony: expected True or False, got 1",
    ]


def test_those_that_behave_the_same_are_asked_once_and_have_one_fitness(grammar):
    engine = Engine(grammar, MODERN, 1, rules_of)
    while not engine.finished:
        asked = engine.ask()
        keys = [rules_of(one.phenotype) for one in asked]
        assert len(set(keys)) == len(keys)
        engine.tell(noisy(engine.generation + 1, asked))
        fitness = {}
        for one in engine.population:
            known = fitness.setdefault(rules_of(one.phenotype), (one.fitness, one.told))
            assert known == (one.fitness, one.told)
        assert len(engine.population) == 20


def test_elites_are_asked_again_and_ranked_by_the_mean_of_all(grammar):
    engine = Engine(grammar, MODERN, 2)
    told = {}
    for _ in range(6):
        asked = engine.ask()
        elites = engine.population[:4]
        assert {one.birth for one in elites} <= {one.birth for one in asked}
        values = noisy(engine.generation + 1, asked)
        for one, value in zip(asked, values, strict=True):
            told.setdefault(one.phenotype, []).append(value)
        engine.tell(values)
        for one in engine.population:
            values = told[one.phenotype]
            assert one.told <= len(values)
            if one.told == len(values):
                assert one.fitness == pytest.approx(sum(values) / len(values))


def test_luck_does_not_survive(grammar):
    engine = Engine(grammar, MODERN, 3)
    asked = engine.ask()
    lucky = asked[0].phenotype
    engine.tell([100.0, *[5.0] * (len(asked) - 1)])
    assert engine.best.phenotype == lucky
    for _ in range(5):
        asked = engine.ask()
        engine.tell([1.0 if one.phenotype == lucky else 30.0 for one in asked])
    assert engine.best.phenotype != lucky
    assert engine.best.told == max(one.told for one in engine.population) <= TRUSTED
    assert engine.best.fitness == pytest.approx(30.0, abs=10)


def test_parsimony_prefers_the_smaller_of_equals(grammar):
    engine = Engine(grammar, MODERN, 4)
    engine.tell([1.0] * len(engine.ask()))
    sizes = [one.used for one in engine.population]
    assert sizes == sorted(sizes)


@pytest.mark.parametrize("after", range(0, 13, 3))
def test_a_restored_modern_engine_continues_exactly(grammar, after):
    whole = Engine(grammar, MODERN, 9, rules_of)
    expected = evolve(whole, noisy)
    first = Engine(grammar, MODERN, 9, rules_of)
    begun = evolve(first, noisy, stop=lambda: first.generation == after)
    state = json.loads(json.dumps(first.state()))
    second = Engine.restore(grammar, MODERN, 9, state, rules_of)
    records = begun.records + evolve(second, noisy).records
    assert without_seconds(records) == without_seconds(expected.records)
    assert json.dumps(second.state()) == json.dumps(whole.state())


def test_tournament_prefers_the_better_placed():
    drawn = tournament(4, 40_000, 2, np.random.default_rng(1))
    shares = np.bincount(drawn, minlength=4) / 40_000
    # The best of two draws with replacement from four: 1 - (3/4)^2, (3/4)^2 - (2/4)^2 ...
    assert shares == pytest.approx([7 / 16, 5 / 16, 3 / 16, 1 / 16], abs=0.01)


@pytest.mark.parametrize("settings", [PAPER, MODERN])
def test_an_injected_sentence_enters_the_population(grammar, settings):
    engine = Engine(grammar, settings, 5)
    engine.tell(noisy(1, engine.ask()))
    engine.inject(SENTENCE)
    asked = engine.ask()
    assert asked[-1].phenotype == SENTENCE
    assert asked[-1].key == 20
    with pytest.raises(CallOrderError, match=r"inject\(\) after ask\(\)"):
        engine.inject(SENTENCE)
    engine.withdraw()
    assert engine.ask() == asked
    engine.tell([0.0 if one.phenotype == SENTENCE else 1.0 for one in asked])
    assert len(engine.population) == 20
    assert any(one.phenotype == SENTENCE for one in engine.population)
    assert all(one.key < 20 for one in engine.ask() if one.generation == 3)


def test_what_is_bred_competes_with_the_whole_population(grammar):
    engine = Engine(grammar, MODERN, 6)
    engine.tell(range(len(engine.ask())))
    best = {one.birth for one in engine.population}
    engine.tell([100.0 if one.generation == 1 else 0.0 for one in engine.ask()])
    assert {one.birth for one in engine.population} == best
    assert all(one.told == 2 for one in engine.population[:4])


def test_the_injected_do_not_stay_for_ever(grammar):
    engine = Engine(grammar, MODERN, 5)
    engine.tell([1.0] * len(engine.ask()))
    engine.inject(SENTENCE)
    for present in (True, False):
        asked = engine.ask()
        engine.tell([0.0 if one.phenotype == SENTENCE else 1.0 for one in asked])
        assert any(one.phenotype == SENTENCE for one in engine.population) is present


def test_what_is_no_sentence_is_not_injected(grammar):
    engine = Engine(grammar, PAPER, 5)
    with pytest.raises(NotASentenceError):
        engine.inject("rule rule")
    assert len(engine.ask()) == 20


def test_steering_changes_what_may_change(grammar):
    engine = Engine(grammar, PAPER, 5)
    engine.steer(mutation=0.5, scaling=3.0, tournament=4)
    assert engine.settings.steerable == {
        "crossover": 0.3,
        "mutation": 0.5,
        "scaling": 3.0,
        "tournament": 4,
    }
    with pytest.raises(SettingsError, match="population: expected crossover or mutation or"):
        engine.steer(population=5)
    with pytest.raises(SettingsError, match="mutation: expected a probability"):
        engine.steer(mutation=2.0)
    engine.ask()
    with pytest.raises(CallOrderError):
        engine.steer(mutation=0.1)


def steered(at, engine):
    """A steering callback: at each generation what is given for it."""
    return lambda: at.get(engine.generation + 1, ())


CHANGES = {
    3: [Injection(SENTENCE), SettingsChange({"mutation": 0.2})],
    6: [SettingsChange({"crossover": 0.9}), Injection(SENTENCE), Injection("rule " + SENTENCE[5:])],
}


@pytest.mark.parametrize("settings", [PAPER, MODERN])
@pytest.mark.parametrize("lost", [3, 4, 6, 7])
def test_a_steered_run_that_is_interrupted_resumes_exactly(grammar, tmp_path, settings, lost):
    def dies(generation, individuals):
        if generation == lost:
            raise Stopped
        return noisy(generation, individuals)

    with RunStore.create(tmp_path / "whole", "") as store:
        engine = Engine(grammar, settings, 7)
        evolve(engine, noisy, store, steering=steered(CHANGES, engine))
        expected = [store.checkpoint(), without_seconds(store.history()), store.steering()]
    with RunStore.create(tmp_path / "part", "") as store:
        engine = Engine(grammar, settings, 7)
        evolve(engine, dies, store, steering=steered(CHANGES, engine))
    with RunStore.open(tmp_path / "part") as store:
        engine = Engine.restore(grammar, settings, 7, store.checkpoint())
        later = {at: what for at, what in CHANGES.items() if at > engine.generation + 1}
        for one in store.steering():
            if one.generation > engine.generation:
                one.what.apply(engine)
        evolve(engine, noisy, store, steering=steered(later, engine))
        assert [store.checkpoint(), without_seconds(store.history()), store.steering()] == expected
        assert store.steering()[:2] == [StoredSteering(3, one) for one in CHANGES[3]]


def test_the_store_knows_everyone_and_their_ancestors(grammar, tmp_path):
    with RunStore.create(tmp_path, "") as store:
        engine = Engine(grammar, MODERN, 8)
        evolve(engine, noisy, store)
        for generation in range(1, 13):
            bred = store.individuals(generation)
            assert [one.key for one in bred] == list(range(20))
            assert all(len(one.parents) <= 2 for one in bred)
        best = store.best()
        line = store.ancestors((best.generation, best.key))
        assert (line[-1].generation, line[-1].key) == (best.generation, best.key)
        assert line[-1].phenotype == best.phenotype
        births = {(one.generation, one.key) for one in line}
        assert all(parent in births for one in line for parent in one.parents)
        assert any(one.generation == 1 for one in line)
