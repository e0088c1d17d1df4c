"""Counts of simulations side by side as they were before kernels were assembled of components."""

import json
from pathlib import Path

import pytest

from geswarm.rules import ControlTable, load_preset, parse_text
from geswarm.sim import evaluate, load_scenario

GOLDEN = json.loads(Path(__file__).with_name("golden.json").read_text())
CROWDED = load_scenario("paper").with_changes(
    robots=6, width=1.4, length=1.6, nest=0.7, source=0.7, objects=4, duration=200.0
)
RULES = {
    "many": parse_text(
        "rule do p = 0.1, PHOTOTAXIS do p = 0.1, RANDOM_WALK do p = 0.1, ANTI-PHOTOTAXIS "
        "do p = 0.5, DROP_OBJECT = true do p = 0.1, WANT_OBJECT = false "
        "do p = 0.1, WANT_OBJECT = true"
    ),
    **{name: load_preset(name) for name in ("hand-coded", "evo8", "evolved")},
}


@pytest.mark.parametrize(
    "form", [ControlTable.compile, lambda rules: rules], ids=["table", "rules"]
)
@pytest.mark.parametrize("case", GOLDEN, ids=str)
def test_histories_are_what_they_were(case, form):
    name, rules = case.rsplit(maxsplit=1)
    scenario = CROWDED if name == "crowded" else load_scenario(name).with_changes(duration=600.0)
    result = evaluate([form(RULES[rules])], scenario, [(0, 5, 1, run) for run in range(6)])
    found = [result.measures[name].tolist() for name in ("picked", "collected", "lost")]
    assert found == GOLDEN[case]
    assert result.fitness.tolist() == found[1]
