"""How a manifold reflects a direction of light: surfaces by their normal, frames, thin cylinders.

Each has three methods: ``split`` a unit direction at the manifold, the ``diffuse`` factor D, and
the ``specular`` factor S. They are written with the dot products of an algebra ``w`` and the
formulas of :mod:`vizlight.model.formulas`, and take arrays (:class:`ArrayAlgebra`) and symbols
alike: the public functions of :mod:`~vizlight.model.reflection` and
:mod:`~vizlight.model.cylinder` and the engine's terms all call them.

x_T and x_N are the tangential and the normal part of x. Numbers in brackets are those of Banks.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce
from operator import add
from typing import NamedTuple, Protocol

import numpy as np
from numpy import absolute, maximum, minimum, sqrt

from vizlight._types import FloatType, Value, Vector
from vizlight.model import formulas, highlight_integral, kernels
from vizlight.model.formulas import clamp, only, power, where

#: A direction whose part across the line is at most this many eps counts as along the line: its
#: azimuth about the line is then rounding error alone.
ALONG = 8.0


class Highlight(NamedTuple):
    """The highlight of one light.

    ``shininess`` is the power of the model that is computed, "phong", "blinn" or "cylinder";
    ``half`` is the unit half vector, where it is the same at all points and used as such.
    """

    model: str
    shininess: float
    half: Vector | None = None


class Vectors(Protocol):
    """The operations of an algebra that manifolds need."""

    #: |x_N| up to which a direction is along a line.
    least: float

    def dot(self, a: Value, b: Value, /) -> Value:
        """Return the dot product of two vectors."""

    def number(self, value: float, /) -> Value:
        """Return a number in the precision of the work."""

    def way(self, direction: Vector, /) -> Value:
        """Return the unit vector of a direction."""

    def integral(self, z: Value, shininess: float, /) -> Value:
        """Return the integral G(z) of :mod:`vizlight.model.highlight_integral`."""


class ArrayAlgebra:
    """The algebra of component-first arrays of one type."""

    def __init__(self, kind: FloatType) -> None:
        self.type = kind.type
        self.least = ALONG * float(np.finfo(kind).eps)

    def dot(self, a: Value, b: Value) -> Value:
        """Return dot products."""
        return kernels.dot(a, b)

    def number(self, value: float) -> Value:
        """Return a number in the type of the arrays."""
        return self.type(value)

    def way(self, direction: Vector) -> Value:
        """Return the unit vector of a direction, which broadcasts."""
        return kernels.unit(np.array(direction, np.float64)[:, np.newaxis])[0].astype(self.type)

    def integral(self, z: Value, shininess: float) -> Value:
        """Return G(z)."""
        return highlight_integral.half_integral(shininess, z.dtype)(z)


class Split(NamedTuple):
    """A direction at a manifold: itself, its tangential coefficients, its normal part and size.

    ``up`` is N.x of a surface.
    """

    vector: Value
    along: Sequence[Value] = ()
    rest: Value = None
    size: Value = None
    up: Value = None


def square(numbers: Iterable[Value]) -> Value:
    """Return the sum of squares."""
    return reduce(add, (a * a for a in numbers))


def triple(a: Value, b: Value, c: Value) -> Value:
    """Return a x b . c in 3-space."""
    first, second, third = (
        # Component by component, since symbols of a program have no cross product.
        (a[i] * b[j] - a[j] * b[i]) * c[k]
        for i, j, k in ((1, 2, 0), (2, 0, 1), (0, 1, 2))
    )
    return first + second + third


class Surface:
    """An (n - 1)-manifold by its normal, lit on its outer side or, with ``both``, on both."""

    def __init__(self, w: Vectors, normal: Value, exponent: float, *, both: bool = False) -> None:
        self.w, self.normal, self.exponent, self.both = w, normal, exponent, both

    def split(self, x: Value) -> Split:
        """Split a unit direction."""
        return Split(x, up=self.w.dot(self.normal, x))

    def side(self, cosine: Value) -> Value:
        """Return N.wi on the lit side or sides."""
        return absolute(cosine) if self.both else maximum(cosine, 0.0)

    def diffuse(self, lit: Split, eye: Split | None) -> Value:  # noqa: ARG002 - it has no part
        """Return (N.wi)^p."""
        side, p = self.side(lit.up), self.exponent
        return side if p == 1 else power(side, 1.0 - side, p)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return the highlight on the side that the light reaches."""
        w = self.w
        if h.half is not None:
            # Lamp and eye at infinity: one half vector for all points, a constant of the plan.
            half = w.way(h.half)
            up = w.dot(self.normal, half)
            if h.shininess <= kernels.DEFICIT_FROM:
                # Up to this shininess N.H to the power s loses no digits that matter; above, 1 -
                # (N.H)^2 is taken from the tangential residual, since near 1 the cosine itself has
                # lost them.
                value = power(self.side(up), None, h.shininess)
            else:
                value = formulas.blinn_of_unit(self._along(half, up), h.shininess)
                value = value if self.both else only(up > 0.0, value)
        else:
            assert eye is not None
            # Not normalised: Phong and Blinn need ratios of its parts alone, and its length may
            # vanish.
            half = lit.vector + eye.vector
            up = w.dot(self.normal, half)
            along = self._along(half, up)
            if h.model == "phong":
                sides = (lit.up, eye.up)
                sides = tuple(map(absolute, sides)) if self.both else sides
                value = formulas.phong(along, *sides, h.shininess)
            else:
                up = self.side(up)
                value = formulas.blinn(along, up * up, h.shininess)
        # No highlight where the lamp is below the horizon, whatever the half vector says.
        return value if self.both else only(lit.up > 0.0, value)

    def _along(self, half: Value, up: Value) -> Value:
        """Return the squared length of the tangential part, which is a residual."""
        rest = half - up * self.normal
        return self.w.dot(rest, rest)


class FrameManifold:
    """A k-manifold by an orthonormal frame: |wi_N| stands for N.wi, and it has no sides."""

    def __init__(self, w: Vectors, rows: Sequence[Value], exponent: float = 1.0) -> None:
        self.w, self.rows, self.exponent = w, rows, exponent

    def split(self, x: Value) -> Split:
        """Return x = x_T + x_N; |x_N| comes from the residual: sqrt(1 - |x_T|^2) loses digits."""
        # Coefficients first, from the same x: rows are orthonormal, so the order does not matter.
        along, rest = [self.w.dot(t, x) for t in self.rows], x
        for a, t in zip(along, self.rows, strict=True):
            rest = rest - a * t
        return Split(x, along, rest, sqrt(self.w.dot(rest, rest)))

    def diffuse(self, lit: Split, eye: Split | None) -> Value:  # noqa: ARG002 - it has no part
        """Return sin(a)^p = |wi_N|^p: (1), and (5) with the exponent of table 1."""
        p = self.exponent
        return lit.size if p == 1 else power(lit.size * lit.size, square(lit.along), 0.5 * p)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return max(0, V.R)^s or |h_N|^s."""
        w = self.w
        if h.half is not None:
            half = w.way(h.half)
            return formulas.blinn_of_unit(square(w.dot(t, half) for t in self.rows), h.shininess)
        assert eye is not None
        if h.model == "phong":
            # V.R is |wi_N||wo_N| - wi_T.wo_T. Its distance from 1 comes from |wi_T + wo_T|, which
            # vanishes at the peak: nothing cancels there.
            return formulas.phong(self._both(lit, eye), lit.size, eye.size, h.shininess)
        # The half vector is split anew: the sum of two normal parts would lose digits where they
        # cancel.
        # wi + wo is not normalised, as Blinn's formula needs the ratio of its parts alone.
        both = self.split(lit.vector + eye.vector)
        return formulas.blinn(square(both.along), w.dot(both.rest, both.rest), h.shininess)

    def _both(self, lit: Split, eye: Split) -> Value:
        """Return |wi_T + wo_T|^2."""
        return square(a + b for a, b in zip(lit.along, eye.along, strict=True))


class Cylinder(FrameManifold):
    """A line in 3-space as a thin cylinder: Lambert and Blinn averaged over its visible half.

    With ``a = |wi_N|``, ``b = |wo_N|``, alpha the angle between the two normal parts, and beta and
    gamma the angles from the half vector's normal part to wo_N and to wi_N (alpha = beta + gamma)::

        diffuse   a (sin alpha + (pi - alpha) cos alpha) / 4
        specular  |h_N|^s / 2 times the integral of cos(x - beta)^s cos(x) over [alpha - pi/2, pi/2]
                  = |h_N|^s / 2 (cos beta (G(cos beta) + G(cos gamma))
                                 + sin beta (sin^(s+1) beta - sin^(s+1) gamma) / (s + 1))

    where ``G(z)`` is the integral of ``(1 - u^2)^(s/2)`` from 0 to z.
    """

    _met: tuple[Split | None, Value] = (None, None)

    def cross(self, lit: Split, eye: Split) -> Value:
        """Return |wi_N x wo_N|, which both terms need."""
        if self._met[0] is not lit:
            self._met = (lit, absolute(triple(lit.rest, eye.rest, self.rows[0])))
        return self._met[1]

    def diffuse(self, lit: Split, eye: Split | None) -> Value:
        """Return Lambert's mean; a cylinder that is seen end on has the mean of the full circle."""
        assert eye is not None
        # Across the line both directions are seen in a plane, at the angle atan2(cross, dot).
        dot, cross = self.w.dot(lit.rest, eye.rest), self.cross(lit, eye)
        seen = eye.size > self.w.least
        # atan2(cross, -dot) is pi - alpha. Dot and cross hold the factor |wi_N| |wo_N|, of which
        # |wo_N| is divided out.
        mean = (np.arctan2(cross, -dot) * dot + cross) / (4.0 * where(seen, eye.size, 1.0))
        return where(seen, mean, lit.size * 0.3183098861837907)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return Blinn's mean, which is 0 where the light comes along the line."""
        assert eye is not None
        w, s, cross = self.w, h.shininess, self.cross(lit, eye)
        # Of the sum wi_N + wo_N, which is exact where wi_N is near -wo_N: b and c are its angles to
        # the eye and to the lamp, seen along the line.
        whole = lit.rest + eye.rest
        normal_square = w.dot(whole, whole)
        normal = sqrt(normal_square)
        sizes = [eye.size * normal, lit.size * normal]
        parts = zip((eye.rest, lit.rest), sizes, strict=True)
        cosines = [
            clamp(w.dot(rest, whole) / where(size > 0.0, size, 1.0), -1.0, 1.0)
            for rest, size in parts
        ]
        sin_b, sin_c = (minimum(cross / where(size > 0.0, size, 1.0), 1.0) for size in sizes)
        # Along the line Blinn's lobe is a frame's; the integral over the arc is the mean
        # across.
        value = formulas.blinn(self._both(lit, eye), normal_square, s)
        integrals = w.integral(cosines[0], s) + w.integral(cosines[1], s)
        e = s + 1.0
        ends = sin_b * (power(sin_b, 1.0 - sin_b, e) - power(sin_c, 1.0 - sin_c, e)) / w.number(e)
        mean = only(normal > 0.0, clamp(0.5 * (cosines[0] * integrals + ends), 0.0, 1.0))
        end_on = w.number(highlight_integral.round_mean(s))
        return only(lit.size > w.least, value * where(eye.size > w.least, mean, end_on))
