import pytest
from hypothesis import given
from hypothesis import strategies as st

from geswarm.analysis import compare

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
