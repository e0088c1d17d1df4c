import os

import pytest

from geswarm.sim import cores
from geswarm.sim.cores import available_cores


@pytest.fixture
def root(tmp_path, monkeypatch):
    """A machine of 64 cores, of which a job has 8; where its control groups are."""
    monkeypatch.setattr(os, "cpu_count", lambda: 64)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: set(range(8)), raising=False)
    monkeypatch.setattr(cores, "_ROOT", tmp_path / "cgroup")
    monkeypatch.setattr(cores, "_OWN", tmp_path / "own")
    return tmp_path / "cgroup"


def allow(group, **files):
    """Write what a group says of its processor time."""
    group.mkdir(parents=True, exist_ok=True)
    for name, text in files.items():
        (group / f"cpu.{name}").write_text(text)


def test_cores_of_others_do_not_count(root):
    assert available_cores() == 8


def test_where_a_process_cannot_be_bound_all_cores_count(root, monkeypatch):
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
        ("200000 0", 8),
        ("", 8),
        ("something else", 8),
    ],
)
def test_a_container_has_its_share(root, said, number):
    allow(root, max=said)
    assert available_cores() == number


@pytest.mark.parametrize(
    ("quota", "period", "number"),
    [("-1", "100000", 8), ("300000\n", "100000\n", 3), ("5000", "100000", 1), ("", "", 8)],
)
@pytest.mark.parametrize("place", ["cpu", "cpu,cpuacct", "cpu/job/step"])
def test_a_container_of_version_1_too(root, quota, period, number, place):
    cores._OWN.write_text("5:memory:/else\n4:cpu,cpuacct:/job/step\n0::/\n")
    allow(root / place, cfs_quota_us=quota, cfs_period_us=period)
    assert available_cores() == number


def test_the_least_along_the_path_of_a_group_counts(root):
    cores._OWN.write_text("0::/user.slice/job ü/step\n")
    allow(root / "user.slice/job ü/step", max="700000 100000")
    assert available_cores() == 7
    allow(root / "user.slice/job ü", max="max 100000")
    allow(root / "user.slice", max="300000 100000")
    assert available_cores() == 3
    allow(root / "user.slice/others", max="100000 100000")
    assert available_cores() == 3


@pytest.mark.parametrize("path", ["/", "/../../elsewhere", "/docker/of the machine outside"])
def test_a_path_that_a_container_does_not_see(root, path):
    cores._OWN.write_text(f"0::{path}\n")
    allow(root, max="200000 100000")
    assert available_cores() == 2
