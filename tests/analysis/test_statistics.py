import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.analysis import compare, holm, paired_difference

samples = st.lists(st.integers(0, 200), min_size=1, max_size=30)


@given(samples, samples)
def test_effect_is_the_share_of_pairs_won(a, b):
    won = sum((x > y) + 0.5 * (x == y) for x in a for y in b) / (len(a) * len(b))
    comparison = compare(a, b)
    assert comparison.effect == pytest.approx(won)
    assert 0 <= comparison.p_value <= 1
    assert compare(b, a).p_value == pytest.approx(comparison.p_value)


def test_clear_difference_is_significant_and_none_is_not():
    assert compare(range(100, 150), range(50, 100)).p_value < 1e-10
    assert compare([5] * 20, [5] * 20).p_value == 1.0


def test_empty_sample_is_refused():
    with pytest.raises(ValueError, match="got 0 and 1 values"):
        compare([], [1])


def test_paired_difference_sees_what_unpaired_tests_miss():
    base = list(range(0, 200, 10))
    better = [value + 2 + value % 3 for value in base]
    change = paired_difference(better, base)
    assert 2 <= change.low <= change.difference <= change.high <= 4
    assert change.p_value < 0.001
    assert compare(better, base).p_value > 0.5


def test_paired_difference_of_equals_is_nothing():
    assert paired_difference([3, 4], [3, 4]).p_value == 1.0
    with pytest.raises(ValueError, match="equal length"):
        paired_difference([1, 2, 3], [1, 2])


@given(st.lists(st.floats(0, 1), max_size=12))
def test_holm_is_the_sequentially_rejective_procedure(p_values):
    corrected = holm(p_values)
    assert all(p <= q <= 1 for p, q in zip(p_values, corrected, strict=True))
    for level in (0.001, 0.05, 0.5):
        rejected = 0
        for rank, p in enumerate(sorted(p_values)):
            if p > level / (len(p_values) - rank):
                break
            rejected += 1
        borderline = any(abs(q - level) < 1e-12 for q in corrected)
        assert borderline or sum(q <= level for q in corrected) == rejected


def test_holm_by_hand():
    assert holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert holm([]) == []


def test_the_winner_needs_significance():
    high, low = range(100, 150), range(50, 100)
    assert compare(high, low).winner == 1
    assert compare(low, high).winner == -1
    assert compare(high, range(101, 151)).winner == 0
