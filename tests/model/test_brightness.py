"""Mean brightness and its exponent: the seed's table, 50 digits, Monte Carlo, quadrature."""

import math

import numpy as np
import pytest

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


@pytest.mark.parametrize(
    ("k", "n", "error", "words"),
    [
        (3, 3, ValueError, "k: expected a dimension less than n = 3, got 3"),
        (0, 3, ValueError, "k: expected an integer of at least 1"),
        (1, 1, ValueError, "n: expected an integer of at least 2"),
        (1.0, 3, TypeError, "k: expected an integer"),
        (True, 3, TypeError, "k: expected an integer"),
    ],
)
def test_bad_dimensions(k, n, error, words):
    for call in (brightness.mean_intensity, brightness.exponent):
        with pytest.raises(error, match=words):
            call(k, n)


@pytest.mark.parametrize("p", [-1.0, np.nan, np.inf, [1.0, -2.0]])
def test_bad_exponents(p):
    with pytest.raises(ValueError, match="p: expected finite exponents from 0"):
        brightness.mean_intensity(1, 3, p)
