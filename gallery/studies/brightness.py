"""Cheap exponents near the compensating exponent p(k, n), compared with the exact one.

The exponent p(k, n) is the root of a closed form of the mean brightness; here the mean is computed
by quadrature as a check. The error of a cheaper exponent q is the largest error of a pixel,
``max |x^p - x^q|``, which also has a closed form.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy import integrate

from studies import PIXEL, Row, Study, cheapest, take_turns, words
from vizlight.model import brightness, kernels

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

SPACES = ((1, 3), (1, 4), (2, 4), (1, 5), (2, 5), (3, 5), (1, 8), (3, 8), (5, 8), (7, 8))


def mean_by_quadrature(k: int, n: int, p: float) -> float:
    """Return the mean of sin(a)^p over all directions in n-space, by quadrature over the angle."""
    c = n - k

    def density(a: float) -> float:
        return float(np.sin(a) ** (c - 1) * np.cos(a) ** (k - 1))

    above, _ = integrate.quad(lambda a: density(a) * np.sin(a) ** p, 0, np.pi / 2, epsabs=1e-14)
    whole, _ = integrate.quad(density, 0, np.pi / 2, epsabs=1e-14)
    return float(above / whole)


def by_roots(x: Array, quarters: int) -> Array:
    """Return ``x^(quarters / 4)`` by multiplications and square roots."""
    result = kernels.power(x, quarters // 4)
    root = np.sqrt(x)
    if quarters & 2:
        result = result * root
    if quarters & 1:
        result = result * np.sqrt(root)
    return result


def measure(k: int, n: int, count: int = 100_000, repeats: int = 5) -> list[Row]:
    """Return one row for each method of computing the power, for one k and n."""
    p = brightness.exponent(k, n)
    x = np.random.default_rng(4).random(count, dtype=np.float32)
    quarters, whole = round(4 * p), max(round(p), 1)
    ways: dict[str, tuple[float, Callable[[], Array]]] = {
        "exact p": (p, lambda: np.power(x, np.float32(p))),
        "nearest quarter, by square roots": (quarters / 4, lambda: by_roots(x, quarters)),
        "nearest integer, by multiplication": (whole, lambda: kernels.power(x, whole)),
        "p = 1": (1.0, x.copy),
    }
    seconds = take_turns({way: work for way, (_, work) in ways.items()}, repeats)
    return [
        Row(
            way, n - k, kernels.power_error(p, q), 1e9 * seconds[way] / count,
            {"k": k, "n": n, "p": q, "mean - 1/2": mean_by_quadrature(k, n, q) - 0.5},
        )
        for way, (q, _) in ways.items()
    ]  # fmt: skip


def verdict(rows: Sequence[Row]) -> str:
    """Return which power to use."""
    exact = [row for row in rows if row.way == "exact p"]
    others = []
    for way in dict.fromkeys(row.way for row in rows if row.way != "exact p"):
        own = [row for row in rows if row.way == way]
        cost = float(np.mean([row.cost for row in own]) / np.mean([row.cost for row in exact]))
        good = sum(cheapest([row]) is not None for row in own)
        worst = max(row.error for row in own)
        others.append(
            f"{way}: in {good} of {len(own)} cases, {words(cost)} times the time, largest error "
            f"{worst:.2g}"
        )
    off = max(abs(float(row.more["mean - 1/2"])) for row in exact)
    keep = "keep it" if off <= PIXEL else "do not rely on it"
    return (
        f"p(k, n) gives a mean of 1/2 with an error of {off:.1g}; {keep}; within 1/255 of it: "
        f"{'; '.join(others)}"
    )


STUDY = Study(
    approximates="compensated diffuse term sin(a)^p(k, n) by cheaper powers",
    reference="the exact p(k, n); for its mean brightness, quadrature",
    parameter="codimension",
    error="largest error of the term",
    cost="ns per point",
    steps=lambda quick: [partial(measure, k, n, repeats=5 if quick else 25) for k, n in SPACES],
    verdict=verdict,
    joined=False,
)
