"""Random numbers: the kernels' are those of the oracle, and they are random."""

import numpy as np
import pytest
from numba import njit
from scipy import stats

from geswarm.sim.kernels import draws
from geswarm.sim.kernels.linking import KernelCompiler
from tests.sim import oracle


@njit(pipeline_class=KernelCompiler)
def grid(seed, robots, steps, purposes):
    numbers = np.empty((robots, steps, purposes))
    for robot in range(robots):
        key = draws.make_key(seed, 3, 1, robot)
        for step in range(steps):
            for purpose in range(purposes):
                numbers[robot, step, purpose] = draws.draw(key, step, purpose)
    return numbers


@njit(pipeline_class=KernelCompiler)
def keys_of(seeds, individuals, replicates, robots):
    keys = np.empty((seeds, individuals, replicates, robots), dtype=np.uint64)
    for index in np.ndindex(keys.shape):
        keys[index] = draws.make_key(index[0], index[1], index[2], index[3])
    return keys


@pytest.fixture(scope="module")
def numbers():
    return grid(42, 32, 256, 32)


def test_the_oracle_draws_the_same():
    numbers = grid(2**40 + 7, 3, 5, 20)
    for robot in range(3):
        key = oracle.make_key(2**40 + 7, 3, 1, robot)
        for step in range(5):
            expected = [oracle.draw(key, step, purpose) for purpose in range(20)]
            assert numbers[robot, step].tolist() == expected


def test_purposes_are_all_different():
    purposes = [
        value for name, value in vars(draws).items() if name.isupper() and isinstance(value, int)
    ]
    assert len(set(purposes)) == len(purposes) == 17
    # Above the first action come all others, far fewer than lie below the e-pucks' purposes.
    above = sorted(value for value in purposes if value > draws.FIRST_ACTION)
    assert above == [draws.E_PUCK, draws.MESSAGE, draws.FIRST_CHANCE]
    assert draws.E_PUCK - draws.FIRST_ACTION > 1_000_000


def test_numbers_are_uniform(numbers):
    assert numbers.min() >= 0
    assert numbers.max() < 1
    counts = np.histogram(numbers, bins=1024, range=(0, 1))[0]
    assert stats.chisquare(counts).pvalue > 1e-4
    low_bits = (numbers * 2**32).astype(np.uint64) % np.uint64(256)
    assert stats.chisquare(np.bincount(low_bits.ravel().astype(int))).pvalue > 1e-4


@pytest.mark.parametrize("axis", [0, 1, 2], ids=["robots", "steps", "purposes"])
@pytest.mark.parametrize("lag", [1, 2, 3, 8])
def test_neighbours_are_independent(numbers, axis, lag):
    moved = np.moveaxis(numbers, axis, 0)
    one, other = moved[:-lag].ravel(), moved[lag:].ravel()
    counts = np.histogram2d(one, other, bins=16, range=((0, 1), (0, 1)))[0]
    assert stats.chisquare(counts.ravel()).pvalue > 1e-4
    assert abs(np.corrcoef(one, other)[0, 1]) < 4.5 / np.sqrt(one.size)


def test_rare_events_are_as_frequent_as_they_should_be_in_each_robot():
    numbers = grid(1, 8, 100_000, 1)[:, :, 0]
    for p in (0.001, 0.08):
        counts = (numbers < p).sum(axis=1)
        assert np.all(np.abs(counts - p * 1e5) < 5 * np.sqrt(1e5 * p))
        gaps = np.diff(np.flatnonzero(numbers[0] < p))
        assert stats.ks_1samp(gaps + 0.0, stats.geom(p).cdf).pvalue > 1e-6 or p > 0.01


def test_no_two_robots_share_a_key():
    keys = keys_of(20, 20, 10, 20)
    assert len(np.unique(keys)) == keys.size
    assert len(np.unique(keys & np.uint64(0xFFFFFFFF))) > 0.9999 * keys.size
    assert len(np.unique(keys >> np.uint64(32))) > 0.9999 * keys.size


def test_large_seeds_count_in_full():
    assert grid(5, 1, 1, 1) != grid(5 + 2**32, 1, 1, 1)
