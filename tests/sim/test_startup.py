import subprocess
import sys

import pytest

from geswarm.sim import load_scenario, startup

COMPILING = startup.COMPILING.format(seconds=startup.SECONDS)
PAPER = load_scenario("paper")


@pytest.fixture
def mark(tmp_path, monkeypatch):
    path = tmp_path / "mark"
    monkeypatch.setattr(startup, "_mark", lambda *_: path)
    return path


def test_compiling_is_announced_once(mark):
    assert not startup.is_compiled()
    said = []
    startup.warm_up(said.append)
    assert said == [COMPILING]
    assert startup.is_compiled()
    startup.warm_up(said.append)
    assert len(said) == 1


def test_it_is_said_on_stderr(mark, capsys):
    startup.warm_up()
    out, err = capsys.readouterr()
    assert out == ""
    assert err == COMPILING + "\n"


def test_where_nothing_can_be_kept_that_is_said_each_time(tmp_path, monkeypatch):
    place = tmp_path / "a file"
    place.touch()
    monkeypatch.setattr(startup.cache, "folder", lambda: place)
    for _ in range(2):
        said = []
        startup.warm_up(said.append)
        first, last = said
        assert first == startup.COMPILING_EACH_TIME.format(seconds=startup.SECONDS)
        assert "no folder that can be written" in last
        assert "compiles each time; NUMBA_CACHE_DIR can name another folder" in last
        assert not startup.is_compiled()


def test_on_a_disk_that_was_full_it_is_not_taken_for_compiled(mark, monkeypatch):
    monkeypatch.setattr(startup.cache, "_not_kept", [])
    monkeypatch.setattr(
        startup, "evaluate", lambda *_, **__: startup.cache._not_kept.append("full")
    )
    said = []
    startup.warm_up(said.append)
    assert said == [COMPILING, startup.NOT_KEPT.format(trouble="full")]
    assert not startup.is_compiled()


def test_another_version_or_machine_has_another_mark(monkeypatch):
    marks = {startup._mark(PAPER, False)}
    with monkeypatch.context() as patch:
        patch.setattr(startup.compiled, "VERSION", 1)
        marks.add(startup._mark(PAPER, False))
    with monkeypatch.context() as patch:
        patch.setattr(startup, "vector_settings", lambda: ("another", ""))
        marks.add(startup._mark(PAPER, False))
    marks.add(startup._mark(PAPER, True))
    assert len(marks) == 4


def test_what_a_world_needs_is_compiled_where_it_is_asked_for(tmp_path, monkeypatch):
    monkeypatch.setattr(startup, "_mark", lambda _, interactive: tmp_path / f"{interactive}")
    startup.warm_up([].append)
    assert startup.is_compiled()
    assert not startup.is_compiled(interactive=True)
    said = []
    startup.warm_up(said.append, interactive=True)
    assert said == [startup.COMPILING.format(seconds=startup.SECONDS_INTERACTIVE)]
    assert startup.is_compiled(interactive=True)


def test_starting_loads_no_library_that_few_need():
    names = ("scipy.optimize", "scipy.stats", "plotly", "viser")
    said = f"import sys, geswarm.sim.startup; print([n for n in {names} if n in sys.modules])"
    run = subprocess.run([sys.executable, "-c", said], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"
