"""What kernels are assembled to, and from other components than the built-in ones."""

import dataclasses
import importlib
from pathlib import Path

import numpy as np
import pytest

from geswarm.sim.assembly import loading
from geswarm.sim.assembly.kernel import assemble, source_of
from geswarm.sim.assembly.records import GROUP, OBJECT, robot_type
from geswarm.sim.assembly.source import Layout
from geswarm.sim.controllers.encoding import numbers_by_name
from geswarm.sim.library.vocabulary import parts_of
from geswarm.sim.scenario.model import load_scenario
from geswarm.sim.terms.parts import PartsError
from tests.sim.assembly import gathering

FORAGING = parts_of(load_scenario("paper"))
LAYOUTS = [Layout(), Layout(swarm=True, rules=True)]


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda layout: layout.name)
def test_the_papers_kernel_reads_as_it_did(layout):
    """To write it anew: python -m tests.sim.assembly.test_source."""
    text, _ = source_of(FORAGING, layout)
    assert text == golden(layout).read_text()


def golden(layout):
    return Path(__file__).with_name(f"foraging_{layout.name}.txt")


def test_what_no_one_names_is_not_computed():
    text, numbers = source_of(gathering.ALONE, Layout())
    assert "is_near" not in text
    assert "rab_range" not in numbers
    assert "near" in source_of(gathering.GATHERING, Layout())[0]


def run_gathering(steps):
    layout = Layout()
    kernel = assemble(gathering.GATHERING, layout)
    scenario = load_scenario("paper").with_changes(robots=3, width=6.0, length=6.0)
    robots = np.zeros(3, dtype=robot_type(gathering.GATHERING, layout))
    robots["cos"], robots["x"] = 1.0, np.array([-0.2, 0.0, 2.0])[:, None]
    robots["behaviour"] = 1
    table = np.zeros(1, dtype=GROUP)[0]
    outcomes = np.full(2, gathering.STAY << 1 | 8 << 22 | 7 << 29, dtype=np.uint32)
    kernel.run(
        numbers_by_name(scenario, kernel.numbers, gathering.GATHERING),
        robots,
        np.zeros(0, dtype=OBJECT),
        table,
        np.zeros(8, dtype=np.uint16),
        np.zeros(16, dtype=np.uint32),
        np.zeros(1, dtype=np.uint32),
        outcomes,
        np.array([0, 1], dtype=np.int32),
        np.array([[0.0], [2.0]], dtype=np.float32),
        64,
        0,
        steps,
    )
    return robots


def test_counts_vectors_arguments_and_measures_of_others():
    robots = run_gathering(1)
    assert robots["near"][:, 0].tolist() == [1, 1, 0]
    np.testing.assert_allclose(robots["apart_x"][:, 0], [-1, 1, 0], atol=1e-4)
    # Attraction by an argument of 2: the two go towards each other, the third one stays.
    assert robots["together"][:, 7].tolist() == [1, 1, 0]
    robots = run_gathering(5)
    assert robots["together"][:, 7].tolist() == [5, 5, 0]
    assert robots["at_the_end"][:, 63].tolist() == [1, 1, 0]


def test_components_that_do_not_fit_are_named():
    with pytest.raises(PartsError, match=r"phototaxis \(.*, line \d+\): the name is taken"):
        dataclasses.replace(FORAGING, behaviours=(*FORAGING.behaviours, gathering.phototaxis))
    kernel = assemble(gathering.WRONG, Layout())
    message = r"gathering.py, line \d+: goes_nowhere names hither, which is neither a field of"
    with pytest.raises(PartsError, match=message):
        numbers_by_name(load_scenario("paper"), kernel.numbers, gathering.WRONG)


def test_a_module_is_written_once_and_found_again(tmp_path, monkeypatch):
    monkeypatch.setattr(loading.cache, "folder", lambda: tmp_path)
    one = loading.load("mine", "answer = 42\n", [])
    (file,) = tmp_path.glob("*.py")
    written = file.stat().st_mtime_ns
    assert loading.load("mine", "answer = 42\n", []).answer == one.answer == 42
    assert file.stat().st_mtime_ns == written
    assert loading.load("mine", "answer = 43\n", []).answer == 43
    assert len(list(tmp_path.glob("*.py"))) == 2
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.parametrize("damage", [b"", b"\0", b"answer = 1\n"])
def test_a_module_that_is_damaged_is_written_anew(tmp_path, monkeypatch, damage):
    monkeypatch.setattr(loading.cache, "folder", lambda: tmp_path)
    loading.load("mine", "answer = 42\n", [])
    (file,) = tmp_path.glob("*.py")
    file.write_bytes(damage)
    assert loading.load("mine", "answer = 42\n", []).answer == 42


def test_a_module_that_cannot_be_written_is_in_memory(tmp_path, monkeypatch):
    monkeypatch.setattr(loading.cache, "folder", lambda: tmp_path / ("long" * 100))
    assert loading.load("mine", "answer = 42\n", []).answer == 42


def test_another_text_of_a_component_is_another_module(tmp_path, monkeypatch):
    (tmp_path / "own_terms.py").write_text("gain = 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    importlib.import_module("own_terms")
    before = loading._checksum("", ["own_terms"])
    (tmp_path / "own_terms.py").write_text("gain = 2\n")
    assert loading._checksum("", ["own_terms"]) != before


def test_where_nothing_can_be_written_it_compiles_in_memory(monkeypatch):
    monkeypatch.setattr(loading.cache, "folder", lambda: Path("/proc/nowhere"))
    text = (
        "from geswarm.sim.kernels.jit import kernel\n\n\n"
        "@kernel\ndef run(number):\n    return 2 * number\n"
    )
    assert loading.load("nowhere", text, []).run(21) == 42


if __name__ == "__main__":
    for each in LAYOUTS:
        golden(each).write_text(source_of(FORAGING, each)[0])
