"""The formulas of the exact line light, on component-first arrays: see :mod:`._kernels`.

With ``a = |wi_N|``, ``b = |wo_N|``, alpha the angle between the two normal parts, beta and gamma
those from the half vector's normal part to wo_N and to wi_N (alpha = beta + gamma)::

    diffuse   a (sin alpha + (pi - alpha) cos alpha) / 4
    specular  |h_N|^s / 2 times the integral of cos(x - beta)^s cos(x) over [alpha - pi/2, pi/2]
              = |h_N|^s / 2 (cos beta (G(cos beta) + G(cos gamma))
                             + sin beta (sin^(s+1) beta - sin^(s+1) gamma) / (s + 1))

with ``G(z)`` the integral of ``(1 - u^2)^(s/2)`` from 0 to z.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy import special

from vizlight.model import kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import DTypeLike

    from vizlight._types import Array

#: A direction whose part across the line is at most this many eps counts as along the line:
#: which way round the line it points is then rounding alone.
ALONG = 8.0
#: From this shininess on G is smooth enough at its end to be tabulated to 16 digits.
TABLE_FROM = 8.0
#: Cells of the table for each standard deviation of the highlight, degree in a cell, and how many
#: deviations it reaches: beyond, the integrand is less than 3e-18.
CELLS, DEGREE, REACH = 64, 5, 9.0


class Meeting(NamedTuple):
    """How light and eye meet across a line: the parts of both in its normal plane.

    Attributes
    ----------
    a, b : ndarray, shape (B,)
        |wi_N| and |wo_N|.
    dot, cross : ndarray, shape (B,)
        wi_N . wo_N and |wi_N x wo_N|.
    light, eye : ndarray, shape (3, B)
        wi_N and wo_N.
    """

    a: Array
    b: Array
    dot: Array
    cross: Array
    light: Array
    eye: Array


def across(x: Array, tangent: Array) -> tuple[Array, Array, Array]:
    """Return a unit direction's coefficient along a unit tangent, and its normal part and length.

    Normal parts are kept as vectors: the angle between two that are short would lose digits if
    it were taken from dot products of the whole directions.
    """
    along = kernels.dot(tangent, x)
    rest = x - along * tangent
    return along, rest, kernels.length(rest)


def meet(rest_i: Array, a: Array, rest_o: Array, b: Array, tangent: Array) -> Meeting:
    """Return the meeting of two normal parts and their lengths."""
    cross = (
        (rest_i[1] * rest_o[2] - rest_i[2] * rest_o[1]) * tangent[0]
        + (rest_i[2] * rest_o[0] - rest_i[0] * rest_o[2]) * tangent[1]
        + (rest_i[0] * rest_o[1] - rest_i[1] * rest_o[0]) * tangent[2]
    )
    return Meeting(a, b, kernels.dot(rest_i, rest_o), np.abs(cross), rest_i, rest_o)


def diffuse(met: Meeting) -> Array:
    """Return the mean of Lambert's law over the visible half of a thin cylinder."""
    a, b, dot, cross, _, _ = met
    value = np.arctan2(cross, -dot)
    value *= dot
    value += cross
    lost = b <= _least(b)
    value /= np.where(lost, 1, 4 * b)
    if lost.any():
        # Seen end on, all of the round is seen alike: the mean over it.
        value = np.where(lost, a / a.dtype.type(np.pi), value)
    return value


def specular(met: Meeting, tangential: Array, shininess: float) -> Array:
    """Return the mean of Blinn's law over the visible half; ``tangential`` is |(wi + wo)_T|^2."""
    a, b, _, cross, light, eye = met
    number = a.dtype.type
    # Cosines to the half vector from the sum itself, which is exact where wi_N is near -wo_N.
    whole = light + eye
    normal = kernels.length(whole)
    value = kernels.blinn(tangential, normal * normal, shininess)
    end_on, dark = b <= _least(b), a <= _least(a)
    poor = end_on | dark | (normal == 0)
    spoiled = bool(poor.any())
    to_eye, to_light = b * normal, a * normal
    if spoiled:
        to_eye, to_light = np.where(poor, 1, to_eye), np.where(poor, 1, to_light)
    cos_b = np.clip(kernels.dot(eye, whole) / to_eye, -1, 1)
    cos_c = np.clip(kernels.dot(light, whole) / to_light, -1, 1)
    sin_b, sin_c = np.minimum(cross / to_eye, 1), np.minimum(cross / to_light, 1)
    integral = half_integral(shininess, a.dtype)
    mean = integral(cos_b)
    mean += integral(cos_c)
    mean *= cos_b
    ends = _gentle_power(sin_b, shininess + 1) - _gentle_power(sin_c, shininess + 1)
    ends *= sin_b
    ends /= number(shininess + 1)
    mean += ends
    mean /= 2
    np.clip(mean, 0, 1, out=mean)
    if spoiled:
        mean = np.where(end_on, number(round_mean(shininess)), mean)
        mean[np.broadcast_to(dark, mean.shape)] = 0
    return value * mean


def round_mean(shininess: float) -> float:
    """Return the mean of max(0, cos)^s over the whole round: of a cylinder seen end on."""
    log = special.gammaln(shininess / 2 + 0.5) - special.gammaln(shininess / 2 + 1)
    return float(np.exp(log) / (2 * np.sqrt(np.pi)))


def half_integral(shininess: float, dtype: DTypeLike = np.float64) -> Callable[[Array], Array]:
    """Return G of z in [-1, 1]: exact to 16 eps of float64 of its largest value, 2 of float32.

    Below a shininess of 8 by the regularised incomplete beta function, some 160 ns a point;
    above by a table, a tenth of that, which also keeps the digits that the beta function loses
    to large powers (5e-10 at 1e6).
    """
    if shininess < TABLE_FROM:
        order = shininess / 2 + 1
        whole = special.beta(0.5, order) / 2

        def exact(z: Array) -> Array:
            size = special.betainc(0.5, order, np.square(z, dtype=np.float64)) * whole
            value: Array = np.copysign(size, z).astype(z.dtype, copy=False)
            return value

        return exact
    inverse, cells = _table(float(shininess))
    rows, last = cells.astype(dtype, copy=False), cells.shape[1] - 1
    scale = rows.dtype.type(inverse)

    def look_up(z: Array) -> Array:
        place = np.abs(z)
        place *= scale
        with np.errstate(invalid="ignore"):
            cell = np.minimum(place.astype(np.int32), last)
        place -= cell
        np.minimum(place, 1, out=place)
        value: Array = rows[-1].take(cell)
        for row in rows[-2::-1]:
            value *= place
            value += row.take(cell)
        np.copysign(value, z, out=value)
        return value

    return look_up


@lru_cache(maxsize=16)
def _table(shininess: float) -> tuple[float, Array]:
    """Return cells a unit of z, and in each cell the coefficients of G, shape (degree + 1, M).

    The integrand is interpolated at Chebyshev nodes of a cell and the polynomial integrated; G at
    the start of a cell is the sum of Gauss-Legendre quadratures of those before.
    """
    reach = min(1.0, REACH / np.sqrt(shininess))
    count = int(np.ceil(CELLS * reach * np.sqrt(shininess)))
    edges = np.linspace(0.0, reach, count + 1)[:-1, np.newaxis]
    width = reach / count

    def integrand(t: Array) -> Array:
        u = edges + width * t
        value: Array = np.exp(shininess / 2 * np.log1p(-u * u))
        return value

    nodes, weights = np.polynomial.legendre.leggauss(12)
    sums = integrand((1 + nodes) / 2) @ weights * (width / 2)
    start = np.concatenate([[0.0], np.cumsum(sums)[:-1]])
    t = (1 + np.cos(np.pi * (np.arange(DEGREE) + 0.5) / DEGREE)) / 2
    powers = np.linalg.solve(np.vander(t, increasing=True), integrand(t).T)
    slopes = width * powers / np.arange(1, DEGREE + 1)[:, np.newaxis]
    return count / reach, np.concatenate([start[np.newaxis], slopes])


def _gentle_power(x: Array, exponent: float) -> Array:
    """Return x^e, e of 1 or more, to eps of 1: where digits of the exponent go, x^e is small."""
    if exponent == int(exponent) and exponent <= kernels.DEFICIT_FROM:
        return kernels.power(x, exponent)
    with np.errstate(divide="ignore", under="ignore"):
        result: Array = np.log(x)
        result *= x.dtype.type(exponent)
        return np.exp(result, out=result)


def _least(x: Array) -> Any:
    return x.dtype.type(ALONG * np.finfo(x.dtype).eps)
