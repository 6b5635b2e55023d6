"""Mean brightness and its exponent: the seed's table, 50 digits, Monte Carlo, quadrature."""

import math

import numpy as np
import pytest
from refusals import refusals

from vizlight.model import brightness

TABLE_1 = [(1, 2, 2.0), (1, 3, 4.7635), (1, 4, 7.6737), (2, 3, 1.0), (2, 4, 2.0)]
# 0.673 stands in the source for 2/pi.
SECTION_3 = [(2, 3, 1 / 2), (1, 3, math.pi / 4), (1, 4, 0.849), (1, 2, 2 / math.pi), (2, 4, 2 / 3)]


@pytest.mark.parametrize(("k", "n", "p"), TABLE_1)
def test_exponents_of_table_1(k, n, p):
    assert brightness.exponent(k, n) == pytest.approx(p, abs=5e-5)


@pytest.mark.parametrize(("k", "n", "mean"), SECTION_3)
def test_means_of_section_3(k, n, mean):
    assert brightness.mean_intensity(k, n) == pytest.approx(mean, abs=5e-4)


def test_whole_exponents_are_whole():
    assert brightness.exponent(2, 3) == 1.0
    for k in (1, 2, 5, 500_000):
        assert brightness.exponent(k, 2 * k) == 2.0
        assert brightness.exponent(2, k + 2) == k
    # Very nearly, but not, a whole number.
    assert brightness.exponent(6, 913_239) == pytest.approx(237369.00000006381, rel=2e-14)


def test_mean_falls_with_p_and_is_1_at_0():
    p = np.linspace(0, 30, 100)
    mean = brightness.mean_intensity(2, 5, p)
    assert mean.shape == p.shape
    assert mean[0] == 1
    assert np.all(np.diff(mean) < 0)


def test_result_is_a_float_for_a_number():
    assert isinstance(brightness.mean_intensity(1, 3), float)
    assert isinstance(brightness.exponent(1, 3), float)


DIMENSIONS = (
    (3, 3, "k: expected a dimension less than n = 3, got 3"),
    (0, 3, "k: expected an integer of at least 1"),
    (1, 1, "n: expected an integer of at least 2"),
    (1.0, 3, "k: expected an integer", TypeError),
    (True, 3, "k: expected an integer", TypeError),
)
test_bad_dimensions_of_a_mean = refusals(brightness.mean_intensity, *DIMENSIONS)
test_bad_dimensions_of_an_exponent = refusals(brightness.exponent, *DIMENSIONS)
test_bad_exponents = refusals(
    lambda p: brightness.mean_intensity(1, 3, p),
    *((p, "p: expected finite exponents from 0") for p in (-1.0, np.nan, np.inf, [1.0, -2.0])),
)
