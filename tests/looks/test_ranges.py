"""Ranges of bars: all values, most of them, or decades."""

import numpy as np
import pytest

from vizlight.looks.ranges import Range, range_shown

RANDOM = np.random.default_rng(3)


@pytest.mark.parametrize("values", [
    RANDOM.normal(size=4000), RANDOM.uniform(size=4000), np.ones(5), np.array([0.0, 0, 0, 5.0]),
    np.array([2.0]),
])  # fmt: skip
@pytest.mark.parametrize("lengths", [True, False])
def test_values_without_outliers_take_all_of_the_bar(values, lengths):
    values = np.abs(values) if lengths else values
    shown = range_shown(values, lengths=lengths)
    assert shown.low <= values.min() <= values.max() <= shown.high
    # Round ends waste little of the bar.
    assert shown.high - shown.low <= 1.1 * np.ptp(values)
    assert shown == Range(shown.low, shown.high)


def test_few_values_far_outside_lie_beyond_the_ends():
    values = np.concatenate([RANDOM.uniform(10, 11, 4000), [-80.0, -70.0, -60.0]])
    shown = range_shown(values)
    assert shown.clipped == (True, False)
    assert not shown.apart
    assert 8.5 < shown.low < 10
    assert shown.high == values.max()
    assert f"from {shown.low:g} to" in shown.words("t")


def test_one_repeated_value_far_outside_is_a_region_apart():
    values = np.concatenate([RANDOM.normal(2.4, 0.4, 4000), np.zeros(200)])
    shown = range_shown(values)
    assert shown.apart
    assert 0.5 < shown.low < 1.5
    assert "grey" in shown.words("thickness")
    many = np.concatenate([values, np.zeros(2000)])
    assert not any(range_shown(many).clipped)


def test_lengths_that_are_skewed_have_decades():
    values = RANDOM.lognormal(0, 1.3, 4000)
    shown = range_shown(values, lengths=True)
    assert shown.logarithmic
    assert shown.high / shown.low == pytest.approx(100, rel=0.2)
    assert shown.clipped == (True, False)
    assert not range_shown(values).logarithmic
    assert "logarithmic" in shown.words("speed")
    assert Range(0, 1).words("x") == ""
