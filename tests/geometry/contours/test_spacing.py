"""Steps: the worst error is half a step, and no count below the one returned keeps it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import refusals

from vizlight.geometry.contours import spacing


@given(st.integers(1, 300), st.floats(-5, 5), st.floats(1e-3, 10), st.integers(0, 2**32 - 1))
def test_worst_error_is_half_a_step(count, low, span, seed):
    steps = spacing.steps(count, low, low + span)
    value = np.random.default_rng(seed).uniform(low, low + span, 500)
    error = np.abs(steps.values[steps.band(value)] - value)
    assert steps.error == pytest.approx(span / count / 2, rel=1e-9)
    assert error.max() <= steps.error * (1 + 1e-9)
    # The error is largest at every contour, from below and from above.
    k = np.arange(1, count + 1)
    np.testing.assert_allclose(np.abs(steps.values[k] - steps.edges[k]), steps.error, rtol=1e-6)


def test_the_lowest_luminance_is_exact():
    steps = spacing.steps(5, 0.1, 1.0)
    assert steps.band(np.array([0.1]))[0] == 0
    assert steps.values[0] == 0.1
    assert steps.band(np.nextafter([0.1], 1))[0] == 1


def test_explicit_values():
    steps = spacing.steps([0.5, 0.2, 0.2, 7.0, -1.0], 0.1, 0.9)
    np.testing.assert_allclose(steps.edges, [0.1, 0.2, 0.5, 0.9])
    np.testing.assert_allclose(steps.values, [0.1, 0.15, 0.35, 0.7])
    assert steps.error == pytest.approx(0.2)
    np.testing.assert_array_equal(spacing.steps([], 0.0, 1.0).edges, [0, 1])


def test_one_luminance_has_one_band():
    for given_levels in (5, 0.1, [0.3]):
        steps = spacing.steps(given_levels, 0.4, 0.4)
        np.testing.assert_array_equal(steps.edges, [0.4])
        np.testing.assert_array_equal(steps.values, [0.4])
        assert steps.error == 0


test_bad_levels = refusals(
    lambda value: spacing.steps(value, 0.0, 1.0),
    (0, "levels: expected a count from 1"),
    (-3, "levels: expected a count from 1"),
    (True, "levels: expected a count", TypeError),
    ("8", "levels: expected a count", TypeError),
    (None, "levels: expected a count", TypeError),
    (16.0, "write 16 for a count"),
    (0.0, "an allowed error above 0"),
    (-0.1, "an allowed error above 0"),
    (float("nan"), "an allowed error above 0"),
    ([0.1, float("nan")], "levels: expected finite values"),
    ([[0.1, 0.2]], "levels: expected finite values in one row"),
    (["a"], "levels: expected real numbers", TypeError),
    (1e-9, "levels: expected an error that"),
)


@pytest.mark.parametrize("value", [np.int32(4), np.float32(0.125), np.array([0.25, 0.5, 0.75])])
def test_numbers_of_numpy(value):
    assert spacing.steps(value, 0.0, 1.0, exact=True).error == pytest.approx(0.125)


@pytest.mark.parametrize("high", [0.97, 1.0, 7.3])
def test_the_count_is_the_smallest_that_keeps_the_error(high):
    """Against a search over all counts, with the error measured on dense samples."""
    light = np.linspace(0.1, high, 4001)
    for error in (high - 0.1) / np.array([2.5, 7.2, 19.4, 38.3, 80.1, 150.7]):
        smallest = 1
        while True:
            equal = spacing.steps(smallest, 0.1, high)
            if np.abs(equal.values[equal.band(light)] - light).max() <= error * (1 + 1e-9):
                break
            smallest += 1
        exact = len(spacing.steps(float(error), 0.1, high, exact=True).edges) - 1
        drawn = len(spacing.steps(float(error), 0.1, high).edges) - 1
        assert exact == smallest
        assert smallest <= drawn <= 1.05 * smallest
        assert spacing.steps(float(error), 0.1, high).error <= 0.99 * error * (1 + 1e-9)
