import json

import pytest

from geswarm import bench

KEYS = {
    "ns_per_robot_step",
    "scalar_ns_per_robot_step",
    "speedup_vs_scalar",
    "thread_scaling",
    "runs_per_second",
    "generation_seconds",
    "swarm",
    "epucks",
    "mapping_genomes_per_second",
    "cpu",
    "numba",
}


@pytest.fixture(scope="module")
def figures():
    """A bench of the same parts, each as short as can be."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bench, "_REPEATS", 1)
        patch.setattr(bench, "_GENERATIONS", 2)
        patch.setattr(bench, "_SWARMS", (100, 200))
        durations = {"paper": 50.0, "epuck-aac": 1.0}
        short = {
            name: bench.load_scenario(name).with_changes(duration=duration)
            for name, duration in durations.items()
        }
        patch.setattr(bench, "load_scenario", short.get)
        said = []
        yield bench.run_bench(said.append), said


def test_keys_and_values(figures):
    measured, said = figures
    assert measured.keys() == KEYS
    assert len(said) >= 5
    for name in KEYS - {"swarm", "epucks", "cpu", "numba", "thread_scaling"}:
        assert measured[name] > 0
    assert [set(swarm) for swarm in measured["swarm"]] == 2 * [
        {"robots", "ns_per_robot_step", "real_time_factor"}
    ]
    assert [each["rules"] for each in measured["epucks"]] == list(bench._EPUCK_RULES)
    assert all(each["ms_per_run"] > 0 for each in measured["epucks"])
    ratio = measured["scalar_ns_per_robot_step"] / measured["ns_per_robot_step"]
    assert measured["speedup_vs_scalar"] == pytest.approx(ratio)


def test_as_text_and_json(figures, monkeypatch):
    measured, _ = figures
    monkeypatch.setattr(bench, "run_bench", lambda _: measured)
    assert json.loads(bench.command(True, print)) == measured
    text = bench.command(False, print)
    assert len(text.splitlines()) == 12 + len(measured["swarm"])
    assert measured["cpu"] in text


def test_on_one_core_there_is_no_thread_scaling(figures):
    measured, _ = figures
    assert bench.format_bench({**measured, "thread_scaling": None})


def test_large_swarms_are_as_dense_as_the_papers():
    scenario = bench.swarm_scenario(10_000)
    assert scenario.robots / (scenario.width * scenario.length) == pytest.approx(4 / 4.2**2)
    assert scenario.objects == 12_500
    assert scenario.nest / scenario.length == pytest.approx(1.5 / 4.2)
