import pytest

from geswarm.sim import startup


@pytest.fixture
def mark(tmp_path, monkeypatch):
    path = tmp_path / "mark"
    monkeypatch.setattr(startup, "_mark", lambda: path)
    return path


def test_compiling_is_announced_once(mark):
    assert not startup.is_compiled()
    said = []
    startup.warm_up(said.append)
    assert said == [startup.COMPILING]
    assert startup.is_compiled()
    startup.warm_up(said.append)
    assert len(said) == 1


def test_it_is_said_on_stderr(mark, capsys):
    startup.warm_up()
    out, err = capsys.readouterr()
    assert out == ""
    assert err == startup.COMPILING + "\n"


def test_without_a_place_for_a_cache(tmp_path, monkeypatch):
    monkeypatch.setattr(startup, "_mark", lambda: tmp_path / "missing" / "mark")
    said = []
    startup.warm_up(said.append)
    startup.warm_up(said.append)
    assert len(said) == 2


def test_another_version_or_machine_has_another_mark(monkeypatch):
    marks = {startup._mark()}
    with monkeypatch.context() as patch:
        patch.setattr(startup.compiled, "VERSION", 1)
        marks.add(startup._mark())
    with monkeypatch.context() as patch:
        patch.setattr(startup, "vector_settings", lambda: ("another", ""))
        marks.add(startup._mark())
    assert len(marks) == 3
