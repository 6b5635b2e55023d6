"""The exact line light: the mean over the visible half of a thin cylinder, in closed form.

It is the reference for every cheaper line model. A thin cylinder has normals all around; the eye
sees the half that faces it, and the brightness of the line is the mean over that half, weighted
by projected width. For Lambert's and Blinn's reflection models, set to 0 where a normal faces away
from the light, this mean has a closed form. Source: Mallo, Peikert, Sigg and Sadlo, *Illuminated
Lines Revisited* (2005), who integrate the highlight numerically; here it is a finite expression in
the incomplete beta function. Lines are in 3-space.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array
from vizlight.model import frames, highlight_integral, kernels
from vizlight.model.manifolds import Cylinder, Highlight
from vizlight.model.reflection import Met

__all__ = ["Gradient", "diffuse", "diffuse_gradient", "specular", "specular_gradient"]


class Gradient(NamedTuple):
    """Derivatives by the three directions, each of shape (..., 3).

    The value depends on where a direction points, not on its length. Each derivative is therefore
    perpendicular to its direction and inversely proportional to the length.
    """

    wi: Array
    wo: Array
    tangent: Array


def diffuse(wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike, /) -> Array:
    """Return the mean of Lambert's reflection over the visible half of a thin cylinder.

    Parameters
    ----------
    wi, wo : array_like, shape (..., 3)
        Directions from the point toward the light and toward the eye; normalised here.
    tangent : array_like, shape (..., 3)
        Directions along the line, of either sign; normalised here.

    Returns
    -------
    ndarray, shape (...)
        Factor from 0 to pi / 4, to be multiplied by kd and the intensity of the light. It is 0
        where a vector is zero or not finite and where the light is along the line. For an eye along
        the line (``|wo_N|`` at most 8 eps) it is the mean over the full circle, ``|wi_N| / pi``.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If a vector does not have 3 components, or the shapes do not broadcast.

    Notes
    -----
    ``|wi_N| (sin alpha + (pi - alpha) cos alpha) / 4``, alpha the angle between wi_N and wo_N. For
    a headlight this is ``|wi_N| pi / 4``: Banks' model with p = 1 is exact up to that factor where
    light, line and eye are in one plane with light and eye on the same side of the line, and
    nowhere else. The absolute error is at most ``4 eps / |wo_N|``.
    """
    met = _Line(wi, wo, tangent)
    return frames.result(met.finish(met.line.diffuse(met.lit, met.eye)))


def specular(wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike, /, *, shininess: float) -> Array:
    """Return the mean of Blinn's reflection over the visible half of a thin cylinder.

    Parameters
    ----------
    wi, wo : array_like, shape (..., 3)
        Directions from the point toward the light and toward the eye; normalised here.
    tangent : array_like, shape (..., 3)
        Directions along the line, of either sign; normalised here.
    shininess : float
        Exponent s of N.H, from 0 to 1e9, unitless.

    Returns
    -------
    ndarray, shape (...)
        Factor from 0 to 1, to be multiplied by ks and the intensity of the light. It is 0 where a
        vector is zero or not finite, where wi = -wo and no half vector exists, and where the light
        is along the line, so that no normal faces it. For an eye along the line (``|wo_N|`` at most
        8 eps) it is the mean over the full circle.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If a vector does not have 3 components, the shapes do not broadcast, or shininess is out of
        range.

    Notes
    -----
    ``|h_N|^s / 2`` times the integral of ``max(0, cos(x - beta))^s cos(x)`` over
    ``[alpha - pi/2, pi/2]``, beta the angle from wo_N to h_N. The integral is a finite expression
    in the incomplete beta function; :mod:`vizlight.model.highlight_integral` says how it is
    evaluated. For a headlight Blinn's ``|h_N|^s`` is exact up to a factor, as Banks' diffuse
    term is.

    The absolute error is at most ``10 eps / d`` for every s, where d is the smallest of ``|wi_N|``,
    ``|wo_N|`` and ``|wi + wo|``, with ``|(wi + wo)_N|`` in place of the last for s below 1: near a
    light along the line the value depends on the azimuth of the light about the line.
    """
    shininess = _check.number("shininess", shininess, low=0.0, high=_check.LARGEST)
    met, highlight = _Line(wi, wo, tangent), Highlight("cylinder", shininess)
    return frames.result(met.finish(met.line.specular(met.lit, met.eye, highlight)))


def diffuse_gradient(wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike, /) -> Gradient:
    """Return the derivatives of :func:`diffuse` by light, eye and tangent.

    Parameters
    ----------
    wi, wo, tangent : array_like, shape (..., 3)
        Vectors as for :func:`diffuse`, of any length.

    Returns
    -------
    Gradient
        Derivatives; 0 where the value has none: light or eye along the line, or a vector that is
        zero or not finite. By tiny vectors they end at the largest number of their type.

    Raises
    ------
    TypeError, ValueError
        As :func:`diffuse`.

    Notes
    -----
    The value depends on ``wi.t``, ``wo.t`` and ``wi.wo`` alone; the chain rule gives the rest. For
    directions in general position the result is within 1e-8 of a complex step through quadrature.
    The derivatives and their errors grow as 1 over ``|wi_N|`` and ``|wo_N|``.
    """
    x = _Invariants(wi, wo, tangent)
    # With rest = pi - alpha and b = |wo_N| the mean is (rest dot + cross) / (4 b); by dot, what
    # comes from rest and from cross cancels.
    by_dot = x.rest / (4 * x.b)
    by_aa = x.cross / (8 * x.aa * x.b)
    by_bb = -x.rest * x.dot / (8 * x.b * x.bb)
    return x.chain(by_aa, by_bb, by_dot, np.zeros_like(by_dot))


def specular_gradient(
    wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike, /, *, shininess: float
) -> Gradient:
    """Return the derivatives of :func:`specular` by light, eye and tangent.

    Parameters
    ----------
    wi, wo, tangent : array_like, shape (..., 3)
        Vectors as for :func:`specular`, of any length.
    shininess : float
        Exponent s of N.H, from 0 to 1e9, unitless.

    Returns
    -------
    Gradient
        Derivatives; 0 where the value has none: light or eye along the line, or no half vector.
        By tiny vectors they end at the largest number of their type.

    Raises
    ------
    TypeError, ValueError
        As :func:`specular`.

    Notes
    -----
    For directions in general position the result is within 1e-8 of a complex step through
    quadrature. The derivatives and their errors grow as 1 over ``|wi_N|``, ``|wo_N|`` and
    ``|wi + wo|``.
    """
    s = _check.number("shininess", shininess, low=0.0, high=_check.LARGEST)
    x = _Invariants(wi, wo, tangent)
    # The square of |wi + wo| for unit vectors, and the length of its part across the line.
    size, root = 2 + 2 * x.m, np.sqrt(x.ww)
    to_eye, to_light = x.b * root, x.a * root
    cos_b, cos_c = (np.clip(u, -1, 1) for u in ((x.bb + x.dot) / to_eye, (x.aa + x.dot) / to_light))
    # wo_N x (wi_N + wo_N) is wo_N x wi_N: one product serves both angles.
    sin_b, sin_c = np.minimum(x.cross / to_eye, 1), np.minimum(x.cross / to_light, 1)
    integral = highlight_integral.half_integral(s, x.a.dtype)
    both = integral(cos_b) + integral(cos_c)
    power_b, power_c = kernels.power(sin_b, s), kernels.power(sin_c, s)
    # The bracket of the closed form at class Cylinder, by the powers that the derivatives need as
    # well.
    mean = cos_b * both + sin_b * (power_b * sin_b - power_c * sin_c) / (s + 1)
    # Both are divided by |wi_N x wo_N|, so they stay finite where wi_N and wo_N are parallel.
    by_beta = cos_b * (power_b / to_eye - power_c / to_light) / (s + 1) - both / to_eye
    by_gamma = -power_c / (x.a * x.b)
    # |h_N|^2, and its deficit below is the tangential share, in which nothing cancels.
    share = np.minimum(x.ww / size, 1)
    peak = kernels.power(share, s / 2, np.square(x.p + x.q) / size) / 2
    # Derivative by the logarithm of |h_N|^2, which is |(wi + wo)_N|^2 over |wi + wo|^2.
    slope = peak * mean * s / 2

    def angle(ee: Array, ll: Array) -> tuple[Array, Array, Array]:
        """Return derivatives by ee, ll and dot of the angle at the part with the square ee."""
        near = (ee + x.dot) / (ee * x.ww)
        cut = x.cross * x.cross / (ee * x.ww)
        return near * ll / 2 - cut, near * ee / 2, -near * x.dot - cut

    # Beta is the angle at the eye's part, gamma at the light's: one formula with the two exchanged.
    beta_b, beta_a, beta_d = angle(x.bb, x.aa)
    gamma_a, gamma_b, gamma_d = angle(x.aa, x.bb)
    return x.chain(
        slope / x.ww + peak * (by_beta * beta_a + by_gamma * gamma_a),
        slope / x.ww + peak * (by_beta * beta_b + by_gamma * gamma_b),
        2 * slope / x.ww + peak * (by_beta * beta_d + by_gamma * gamma_d),
        -2 * slope / size,
    )


class _Line(Met):
    """Directions to light and eye at lines."""

    def __init__(self, wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike) -> None:
        rows = _check.vectors("tangent", tangent, n=3)[..., np.newaxis, :]
        super().__init__("tangent", rows, wi=wi, wo=wo)
        unit, size = kernels.unit(self.rows[0])
        self.sizes.append(size)
        self.valid &= size > 0
        self.line = Cylinder(self.algebra, [unit])
        self.lit, self.eye = (self.line.split(way) for way in self.directions)


class _Invariants(_Line):
    """Dot products of unit wi, wo and tangent, and the chain rule from them to the vectors.

    ``aa`` and ``bb`` are |wi_N|^2 and |wo_N|^2, ``ww`` is |(wi + wo)_N|^2. Where a derivative is
    undefined they hold placeholders and the result is 0.
    """

    def __init__(self, wi: ArrayLike, wo: ArrayLike, tangent: ArrayLike) -> None:
        super().__init__(wi, wo, tangent)
        lit, eye, least = self.lit, self.eye, self.algebra.least
        # Of the sum of the parts, not of their squares: where they nearly cancel only this keeps
        # digits.
        w = kernels.length(lit.rest + eye.rest)
        self.valid &= (lit.size > least) & (eye.size > least) & (w > least)
        sizes = (np.where(self.valid, u, 1).astype(w.dtype) for u in (lit.size, eye.size, w))
        self.a, self.b, w = sizes
        self.aa, self.bb, self.ww = self.a**2, self.b**2, w**2
        self.p, self.q = lit.along[0], eye.along[0]
        self.m = np.where(self.valid, kernels.dot(*self.directions), 0)
        self.dot, self.cross = kernels.dot(lit.rest, eye.rest), self.line.cross(lit, eye)
        self.rest = np.arctan2(self.cross, -self.dot)

    def chain(self, by_aa: Array, by_bb: Array, by_dot: Array, by_m: Array) -> Gradient:
        """Return the gradient from the partial derivatives by aa, bb, dot and m."""
        (light, eye), line = self.directions, self.line.rows[0]
        # Of unit vectors aa = 1 - p^2, bb = 1 - q^2 and dot = m - p q.
        by_p = -2 * self.p * by_aa - self.q * by_dot
        by_q = -2 * self.q * by_bb - self.p * by_dot
        by_m = by_m + by_dot
        parts = (by_p * line + by_m * eye, by_q * line + by_m * light, by_p * light + by_q * eye)
        gradients, largest = [], np.finfo(light.dtype).max
        for part, way, size in zip(parts, (light, eye, line), self.sizes, strict=True):
            # The value does not depend on lengths: the part along the vector goes, and the rest is
            # over its length.
            across = part - kernels.dot(part, way) * way
            with np.errstate(over="ignore"):
                across = np.where(self.valid, across / np.where(self.valid, size, 1), 0)
            across = np.clip(across, -largest, largest)
            gradients.append(across.T.reshape(*self.shape, 3).astype(light.dtype, copy=False))
        return Gradient(*gradients)
