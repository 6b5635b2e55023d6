"""Cheaper powers: their error in closed form is what a search finds."""

from __future__ import annotations

import numpy as np
import pytest

from studies import brightness as study
from vizlight.model import brightness, kernels


@pytest.mark.parametrize(("p", "q"), [(4.7635, 5.0), (4.7635, 1.0), (0.5, 1.0), (19.57, 20.0)])
def test_power_error_against_a_search(p, q):
    x = np.linspace(0, 1, 2_000_001)
    assert kernels.power_error(p, q) == pytest.approx(np.abs(x**p - x**q).max(), rel=1e-6)
    assert kernels.power_error(p, q) == kernels.power_error(q, p)


def test_power_error_at_its_ends():
    assert kernels.power_error(3, 3) == 0
    assert kernels.power_error(0, 2) == 1


def test_roots_are_the_power():
    x = np.linspace(0, 1, 1001)
    for quarters in range(17):
        np.testing.assert_allclose(study.by_roots(x, quarters), x ** (quarters / 4), atol=1e-15)


@pytest.mark.parametrize(("k", "n"), study.SPACES)
def test_mean_by_quadrature(k, n):
    p = brightness.exponent(k, n)
    assert study.mean_by_quadrature(k, n, p) == pytest.approx(0.5, abs=1e-10)
    assert study.mean_by_quadrature(k, n, 1.0) == pytest.approx(
        brightness.mean_intensity(k, n), abs=1e-10
    )


def test_rows():
    rows = {row.way: row for row in study.measure(1, 3, 1000, repeats=1)}
    assert rows["exact p"].error == 0
    assert rows["nearest integer, by multiplication"].error == pytest.approx(0.0178, abs=1e-4)


def test_a_mean_that_is_off_is_not_relied_on():
    rows = study.measure(1, 3, 1000, repeats=1)
    assert "; keep it; " in study.verdict(rows)
    off = [row._replace(more={**row.more, "mean - 1/2": 0.2}) for row in rows]
    assert study.verdict(off).startswith(
        "p(k, n) gives a mean of 1/2 with an error of 0.2; do not rely on it"
    )
