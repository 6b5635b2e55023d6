"""The formulas of the exact line light on component-first arrays (see :mod:`.kernels`).

With ``a = |wi_N|``, ``b = |wo_N|``, alpha the angle between the two normal parts, and beta and
gamma the angles from the half vector's normal part to wo_N and to wi_N (alpha = beta + gamma)::

    diffuse   a (sin alpha + (pi - alpha) cos alpha) / 4
    specular  |h_N|^s / 2 times the integral of cos(x - beta)^s cos(x) over [alpha - pi/2, pi/2]
              = |h_N|^s / 2 (cos beta (G(cos beta) + G(cos gamma))
                             + sin beta (sin^(s+1) beta - sin^(s+1) gamma) / (s + 1))

where ``G(z)`` is the integral of ``(1 - u^2)^(s/2)`` from 0 to z.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import scipy

from vizlight.model import formulas, kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import DTypeLike

    from vizlight._types import Array

#: A direction whose part across the line is at most this many eps counts as along the line: its
#: azimuth about the line is then rounding error alone.
ALONG = 8.0
#: From this shininess on G is smooth enough at z = 1 to be tabulated to 16 digits.
TABLE_FROM = 8.0
#: Cells of the table per standard deviation of the highlight, degree of the polynomial in a cell,
#: and number of deviations covered: beyond them the integrand is less than 3e-18.
CELLS, DEGREE, REACH = 64, 5, 9.0


class NormalParts(NamedTuple):
    """Parts of the directions to light and eye in the normal plane of a line.

    Attributes
    ----------
    a, b : ndarray, shape (B,)
        Lengths |wi_N| and |wo_N|.
    dot, cross : ndarray, shape (B,)
        Products wi_N . wo_N and |wi_N x wo_N|.
    light, eye : ndarray, shape (3, B)
        Vectors wi_N and wo_N.
    """

    a: Array
    b: Array
    dot: Array
    cross: Array
    light: Array
    eye: Array


def across(x: Array, tangent: Array) -> tuple[Array, Array, Array]:
    """Return a unit direction's coefficient along a unit tangent, its normal part and that length.

    The normal parts are kept as vectors: dot products of the whole directions would lose digits of
    the angle between two short normal parts.
    """
    along = kernels.dot(tangent, x)
    rest = x - along * tangent
    return along, rest, kernels.length(rest)


def meet(rest_i: Array, a: Array, rest_o: Array, b: Array, tangent: Array) -> NormalParts:
    """Return the :class:`NormalParts` of two normal parts with the given lengths."""
    cross = np.abs(kernels.triple(rest_i, rest_o, tangent))
    return NormalParts(a, b, kernels.dot(rest_i, rest_o), cross, rest_i, rest_o)


def diffuse(met: NormalParts) -> Array:
    """Return the mean of Lambert's reflection over the visible half of a thin cylinder."""
    a, b, dot, cross, _, _ = met
    return np.asarray(formulas.cylinder_diffuse(a, b, dot, cross, _least(b)))


def specular(met: NormalParts, tangential: Array, shininess: float) -> Array:
    """Return the mean of Blinn's reflection over the visible half.

    ``tangential`` is |(wi + wo)_T|^2.
    """
    a, b, _, cross, light, eye = met
    # The cosines come from the sum wi_N + wo_N, which is exact where wi_N is near -wo_N.
    whole = light + eye
    normal = kernels.length(whole)
    to_eye, to_light = b * normal, a * normal
    cos_b = formulas.cylinder_cosine(kernels.dot(eye, whole), to_eye)
    cos_c = formulas.cylinder_cosine(kernels.dot(light, whole), to_light)
    sin_b, sin_c = (formulas.cylinder_sine(cross, size) for size in (to_eye, to_light))
    integral = half_integral(shininess, a.dtype)
    value = formulas.cylinder_specular(
        formulas.blinn(tangential, normal * normal, shininess),
        cos_b,
        integral(np.asarray(cos_b)) + integral(np.asarray(cos_c)),
        formulas.cylinder_ends(sin_b, sin_c, shininess) / (shininess + 1),
        a,
        b,
        normal,
        _least(b),
        round_mean(shininess),
    )
    return np.asarray(value)


def round_mean(shininess: float) -> float:
    """Return the mean of max(0, cos)^s over the full circle, for a cylinder that is seen end on."""
    log = scipy.special.gammaln(shininess / 2 + 0.5) - scipy.special.gammaln(shininess / 2 + 1)
    return float(np.exp(log) / (2 * np.sqrt(np.pi)))


def half_integral(shininess: float, dtype: DTypeLike = np.float64) -> Callable[[Array], Array]:
    """Return the function G of z in [-1, 1].

    Its error is at most 16 eps of its largest value in float64, 2 eps in float32. For a shininess
    below 8 it uses the regularised incomplete beta function, at some 160 ns per point; above it
    uses a table, which takes a tenth of that time and keeps the digits that the beta function
    loses for large powers (5e-10 at 1e6).
    """
    if shininess < TABLE_FROM:
        order = shininess / 2 + 1
        whole = scipy.special.beta(0.5, order) / 2

        def exact(z: Array) -> Array:
            size = scipy.special.betainc(0.5, order, np.square(z, dtype=np.float64)) * whole
            value: Array = np.copysign(size, z).astype(z.dtype, copy=False)
            return value

        return exact
    inverse, cells = table(float(shininess))
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
def table(shininess: float) -> tuple[float, Array]:
    """Return the cells per unit of z and the coefficients of G in each cell, shape (degree + 1, M).

    The integrand is interpolated at the Chebyshev nodes of a cell and the polynomial is integrated.
    G at the start of a cell is the sum of Gauss-Legendre quadratures over the cells before it.
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


def _least(x: Array) -> float:
    return float(ALONG * np.finfo(x.dtype).eps)
