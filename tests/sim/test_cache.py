import os
import stat
from pathlib import Path
from types import SimpleNamespace

import pytest

from geswarm.sim.kernels import cache
from geswarm.sim.kernels.jit import kernel


def adder(constant):
    @kernel
    def add(number):
        return number + constant

    return add


@pytest.fixture
def place(tmp_path, monkeypatch):
    """An empty folder for compiled code."""
    monkeypatch.setattr(cache, "folder", lambda: tmp_path / "place")
    monkeypatch.setattr(cache, "_not_kept", [])
    return tmp_path / "place"


def loads(constant=1):
    """Whether it comes from the disk."""
    add = adder(constant)
    assert add(1) == 1 + constant
    return bool(add.stats.cache_hits)


def test_what_is_compiled_is_kept_for_others(place):
    assert not loads()
    assert loads()
    assert not loads(2)  # a constant that differs, such as another version of the sources
    assert cache.trouble() is None
    assert len(list(place.iterdir())) == 2
    assert not loads(1.5)
    assert adder(1)(1.5) == 2.5


@pytest.mark.parametrize(
    "damage",
    [
        lambda code: b"",
        lambda code: code[:3],
        lambda code: code[: len(code) // 2],
        lambda code: code[:-1],
        lambda code: code[:1000] + bytes([code[1000] ^ 1]) + code[1001:],
        lambda code: b"something else",
        lambda code: cache._checksum(b"something else") + b"something else",
        lambda code: cache._checksum(b"N.") + b"N.",
    ],
)
def test_what_is_damaged_is_compiled_anew(place, damage):
    loads()
    (file,) = place.iterdir()
    file.write_bytes(damage(file.read_bytes()))
    assert not loads()
    assert loads()
    assert list(place.iterdir()) == [file]


def test_a_folder_in_the_place_of_the_file_is_trouble_but_no_error(place):
    loads()
    (file,) = place.iterdir()
    file.unlink()
    file.mkdir()
    assert not loads()
    assert cache.trouble() == f"{place}: Is a directory"
    assert list(place.iterdir()) == [file]


def test_with_no_place_it_runs_all_the_same_and_says_why(place):
    place.write_text("a file")
    assert not loads()
    assert not loads()
    assert cache.trouble() == f"{place}: File exists"


def test_on_a_full_disk_it_runs_all_the_same_and_leaves_nothing(place, monkeypatch):
    def write_bytes(path, data):
        path.touch()
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", write_bytes)
    assert cache.trouble() is None
    assert not loads()
    assert cache.trouble() == f"{place}: No space left on device"
    assert list(place.iterdir()) == []


def test_others_may_read_it_as_far_as_the_umask_says(place):
    loads()
    (file,) = place.iterdir()
    before = os.umask(0)
    os.umask(before)
    assert stat.S_IMODE(file.stat().st_mode) == 0o666 & ~before


def test_what_the_user_says_comes_first_then_the_sources_then_the_home(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "home"))
    monkeypatch.setattr(cache._config, "CACHE_DIR", str(tmp_path / "said"))
    said, sources, home = cache._folders()
    assert said.parent == tmp_path / "said"
    assert sources == Path(cache.__file__).parent / "__pycache__"
    assert home.parent == tmp_path / "home" / "numba"
    find = cache.folder.__wrapped__
    assert find() == said
    assert said.is_dir()
    (tmp_path / "a file").touch()
    monkeypatch.setattr(cache._config, "CACHE_DIR", str(tmp_path / "a file"))
    assert find() == sources
    monkeypatch.setattr(cache, "_can_be_written", lambda place: False)
    assert find().parent == tmp_path / "a file"


def test_without_a_home_no_folder_is_made_where_one_happens_to_be(tmp_path, monkeypatch):
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(os.path, "expanduser", lambda path: path)  # as where nobody knows the user
    monkeypatch.setattr(cache._config, "CACHE_DIR", "")
    assert list(cache._folders()) == [Path(cache.__file__).parent / "__pycache__"]


def test_what_cannot_be_kept_is_refused(place):
    compiled = SimpleNamespace(library=SimpleNamespace(has_dynamic_globals=True))
    with pytest.raises(ValueError, match="add: pointers and large global arrays cannot be kept"):
        adder(1)._cache.save_overload((), compiled)
