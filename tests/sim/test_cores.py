import os

import pytest

from geswarm.sim import cores
from geswarm.sim.cores import available_cores


@pytest.fixture
def quota(tmp_path, monkeypatch):
    """A machine of 64 cores, of which a job has 8, and the file that says what a container has."""
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(8)), raising=False)
    monkeypatch.setattr(cores, "_QUOTA", tmp_path / "cpu.max")
    return tmp_path / "cpu.max"


def test_cores_of_others_do_not_count(quota):
    assert available_cores() == 8


def test_where_a_process_cannot_be_bound_all_cores_count(quota, monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    assert available_cores() == 64


@pytest.mark.parametrize(
    ("said", "number"),
    [
        ("max 100000", 8),
        ("200000 100000", 2),
        ("150000 100000", 2),
        ("5000 100000", 1),
        ("1600000 100000", 8),
        ("", 8),
        ("something else", 8),
    ],
)
def test_a_container_has_its_share(quota, said, number):
    quota.write_text(said)
    assert available_cores() == number
