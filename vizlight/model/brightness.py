"""Mean brightness of a k-manifold in n-space, and the exponent that makes it equal for all."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array

__all__ = ["exponent", "mean_intensity"]

#: Mean brightness of a surface in 3-space, which the exponent gives to all other manifolds.
STANDARD = 0.5

#: Coefficients B(2j) / (2j (2j - 1)) of Stirling's series, highest order first.
_STIRLING = (1 / 156, -691 / 360360, 1 / 1188, -1 / 1680, 1 / 1260, -1 / 360, 1 / 12)
_SERIES_FROM = 8.0


def mean_intensity(k: int, n: int, p: ArrayLike = 1.0) -> float | Array:
    """Return the mean of sin(a)^p over all directions of light in n-space.

    Parameters
    ----------
    k, n : int
        Dimensions of the manifold and of the space, 0 < k < n (tested up to 1e6).
    p : array_like, default: 1.0
        Exponents of 0 or more, unitless.

    Returns
    -------
    float or ndarray
        I(k, n, p), of the shape of p.

    Raises
    ------
    TypeError
        If k or n is not an integer.
    ValueError
        If not 0 < k < n <= 1e9, or an exponent is not from 0 to 1e18.

    Notes
    -----
    ``I = G(n/2) G((c+p)/2) / (G(c/2) G((n+p)/2))``, where G is the gamma function and c = n - k.
    This is the closed form of the integrals in Banks' appendix. The four log-gammas would cancel
    for large n, so their leading parts are combined analytically into three log1p terms. The
    relative error is at most ``32 eps (1 + |ln I|)`` up to n = 1e6 and p = 4e6, where I is a normal
    number. Banks 3.3 prints I(1, 2) = 2/pi as 0.673; the correct value is 0.6366.
    """
    k, n = dimensions(k, n)
    powers = _check.floats_in("p", p, 0.0, _check.LARGEST**2, "finite exponents").astype(np.float64)
    result = np.exp(_log_mean(k, n, powers))
    return float(result) if result.ndim == 0 else result


def exponent(k: int, n: int) -> float:
    """Return p(k, n), the exponent that gives a k-manifold in n-space a mean brightness of 1/2.

    Parameters
    ----------
    k, n : int
        Dimensions of the manifold and of the space, 0 < k < n (tested up to 1e6).

    Returns
    -------
    float
        p(k, n), unitless; p(2, 3) = 1, p(1, 3) = 4.7635, p(1, 4) = 7.6737, p(2, 4) = 2.

    Raises
    ------
    TypeError
        If k or n is not an integer.
    ValueError
        If not 0 < k < n.

    Notes
    -----
    The root of ``I(k, n, p) = 1/2`` (Banks 3.4 and table 1), found by secants of ln I and cached.
    It is exactly 2 for k = c and exactly c for k = 2. The relative error is at most ``2e-14`` up
    to n = 1e6.
    """
    return _exponent(*dimensions(k, n))


@functools.lru_cache(maxsize=4096)
def _exponent(k: int, n: int) -> float:
    # The mean of sin^2 is c / n, which is 1/2 for k = c.
    if k == n - k:
        return 2.0
    if k == 2:  # I = c / (c + p)
        return float(n - k)

    def excess(p: float) -> float:
        return float(_log_mean(k, n, np.asarray(p))) - math.log(STANDARD)

    # ln I falls and is convex: the secant through two points before the root meets zero between
    # the second of them and the root, so that the points rise to it.
    last, p = 0.0, 1.0
    # Powers of two that hold the root between p and 2 p, so that the secant starts below it.
    while excess(p) < 0:
        p /= 2
    while excess(2 * p) > 0:
        p *= 2
    above, here = excess(last), excess(p)
    while 0 < here < above:
        last, p = p, p + here * (p - last) / (above - here)
        above, here = here, excess(p)
    return p


def dimensions(k: int, n: int) -> tuple[int, int]:
    """Validate the dimension k of a manifold and n of its space, 0 < k < n."""
    most = int(_check.LARGEST)
    k, n = _check.integer("k", k, low=1, high=most), _check.integer("n", n, low=2, high=most)
    if k >= n:
        raise _check.value_error("k", f"a dimension less than n = {n}", k)
    return k, n


def _log_mean(k: int, n: int, p: Array) -> Array:
    """Return ln I as a mixed second difference of log-gamma at a = c/2, d = p/2, h = k/2.

    With lnG(x) = (x - 1/2) ln x - x + ln(2 pi)/2 + R(x), the first part of the difference is the
    sum of three log1p terms of similar size and R is small, so no large terms cancel.
    """
    a, d, h = (n - k) / 2, p / 2, k / 2
    # Differences of x ln x as log1p of the ratios, which are small where the terms are large.
    leading = (
        (a - 0.5) * np.log1p(d / a * (h / (a + d + h)))
        - d * np.log1p(h / (a + d))
        - h * np.log1p(d / (a + h))
    )
    return leading + _remainder(a + d) - _remainder(a) - _remainder(a + d + h) + _remainder(a + h)


def _remainder(x: ArrayLike) -> Array:
    """Return R(x), the remainder of Stirling's formula; up to x = 8 by steps to x + 8.

    ``R(x) = R(x + 1) + (x + 1/2) ln(1 + 1/x) - 1``, from ``G(x + 1) = x G(x)``.
    """
    x = np.asarray(x, dtype=np.float64)
    small = x < _SERIES_FROM
    steps = np.zeros_like(x)
    if np.any(small):
        near = np.minimum(x, _SERIES_FROM)
        steps = sum(((near + j + 0.5) * np.log1p(1 / (near + j)) - 1 for j in range(8)), steps)
        x = np.where(small, x + 8, x)
    # Horner's rule: Stirling's series has odd powers of 1 / x alone.
    y = 1 / (x * x)
    series = functools.reduce(lambda total, term: total * y + term, _STIRLING) / x
    return np.asarray(np.where(small, series + steps, series))
