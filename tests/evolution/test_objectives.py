"""Evolution towards any objective: of negative values, or to be minimised."""

from dataclasses import replace

import pytest

from geswarm.evaluation import evaluate_rule_sets
from geswarm.evolution import EvolutionRun, RunConfig
from geswarm.ge import Settings
from geswarm.rules import RuleSet, load_rule_set
from geswarm.sim import Objective, load_scenario, vocabulary_of

AAC = load_scenario("aac").with_changes(duration=5.0)
OBJECTIVES = {
    "negative": Objective("-on_black / robots - 3"),
    "least": Objective("on_black / robots + 1", maximise=False),
    "either": Objective("on_black - 200"),
}
SETTINGS = [
    Settings.preset(preset, population=10, generations=2, evaluations=2)
    for preset in ("paper", "modern")
]


def evolved(directory, objective, settings, **options):
    config = RunConfig(AAC.with_changes(objective=objective), settings, seed=3)
    assert RunConfig.from_yaml(config.to_yaml()) == config
    run = EvolutionRun.create(config, directory)
    run.run(**options)
    run.close()
    return run


@pytest.mark.parametrize("settings", SETTINGS, ids=["paper", "modern"])
@pytest.mark.parametrize("name", OBJECTIVES)
def test_two_generations_of_any_objective(tmp_path, name, settings):
    objective = OBJECTIVES[name]
    one = evolved(tmp_path / "one", objective, settings, workers=1)
    other = evolved(tmp_path / "other", objective, settings, workers=3)
    assert replace(one.best, origin=other.best.origin) == other.best
    histories = [[replace(record, seconds=0.0) for record in run.history] for run in (one, other)]
    assert histories[0] == histories[1]
    for record in one.history:
        assert record.mean <= record.best
        if name != "either":
            assert max(record.best, record.best_so_far) < 0  # to be minimised: the gain
    best = load_rule_set(str(one.directory / "best.yaml"), vocabulary_of(AAC))
    assert best.rules == one.best.rules
    again = EvolutionRun.resume(one.directory)
    assert [replace(record, seconds=0.0) for record in again.history] == histories[0]
    again.close()


def test_gains_are_such_that_more_is_better():
    scenario = AAC.with_changes(objective=OBJECTIVES["least"], duration=30.0)
    (found,) = evaluate_rule_sets([RuleSet()], scenario, runs=5)
    on_black = found.measures["on_black"]
    assert found.fitness.tolist() == (on_black / scenario.robots + 1).tolist()
    assert found.gains.tolist() == (-found.fitness).tolist()
    assert found.fitness.min() >= 1
    assert found.summary()["fitness"] == found.fitness.tolist()
    assert "collected" not in found.summary()
    assert "lost_mean" not in found.summary()
