"""Common parts of shapes of revolution: frames, validated lights and their reflection."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vizlight import _check
from vizlight._types import Array, VectorLike
from vizlight.model import falloff

#: Segments of a circle: the fewest that look round, and the most that are tried.
FEWEST, MOST = 36, 1 << 13


@dataclass(frozen=True)
class ShapeLight:
    """One light and its reflection, of luminance ``low + scale cosine^power fading``.

    ``toward`` is the unit vector from the shape's centre to the light, at the ``distance``,
    infinite for a light at infinity; ``attenuation`` has the coefficients of the fading.
    """

    toward: Array
    distance: float
    low: float
    scale: float
    power: float
    attenuation: tuple[float, float, float]

    def luminance(self, cosine: Array, distance: Array | float = math.inf) -> Array:
        """Return the luminance for the cosine of incidence and the distance to the light."""
        lit = np.maximum(cosine, 0)
        # A high power of a small cosine underflows to 0, which is right.
        with np.errstate(under="ignore"):
            # With a power of 0 the unlit side would be lit, since 0^0 is 1.
            value = np.where(lit > 0, lit**self.power, 0)
            if math.isfinite(self.distance):
                value = value * falloff.fading(np.asarray(distance, float), self.attenuation)
            return np.asarray(self.low + self.scale * value)


def source(
    center: Array, *, direction: VectorLike | None, position: VectorLike | None, ambient: float,
    diffuse: float, power: float, attenuation: VectorLike,
) -> ShapeLight:  # fmt: skip
    """Validate the light of a shape and return it relative to the shape's centre."""
    if (direction is None) == (position is None):
        expected = "either direction= (toward the light) or position="
        got = "neither" if direction is None else "both"
        raise _check.value_error("direction", expected, got, "pass one of them")
    low = _check.number("ambient", ambient, low=0.0, high=_check.LARGEST)
    scale = _check.number("diffuse", diffuse, low=0.0, high=_check.LARGEST)
    power = _check.number("power", power, low=0.0, high=_check.LARGEST)
    fading = falloff.attenuation("attenuation", attenuation)
    if direction is not None:
        if fading != (1.0, 0.0, 0.0):
            expected = "a light with position="
            raise _check.value_error("attenuation", expected, "a light at infinity")
        return ShapeLight(_check.unit("direction", direction), math.inf, low, scale, power, fading)
    offset = triple("position", position) - center
    size = math.hypot(*offset)
    # A light in the centre is in no direction; any will do.
    toward = offset / size if size > 0 else np.array([0.0, 0, 1])
    return ShapeLight(toward, size, low, scale, power, fading)


def triple(name: str, value: object) -> Array:
    """Return a finite vector of 3 components."""
    return np.array(_check.vector(name, value, n=3))


def frame(axis: Array, toward: Array | None = None) -> tuple[Array, Array]:
    """Return two unit vectors normal to a unit axis and to each other.

    The first is along the part of ``toward`` that is normal to the axis. It is arbitrary without
    ``toward``, and where ``toward`` is parallel to the axis to rounding.
    """
    across = np.zeros(3)
    if toward is not None:
        # Once more: the first difference leaves a rounded part along the axis where little is left
        # of it.
        across = toward - (toward @ axis) * axis
        across = across - (across @ axis) * axis
    if math.hypot(*across) <= 8 * np.finfo(np.float64).eps:
        # The coordinate axis that is farthest from the axis gives the longest product.
        across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
    first = across / math.hypot(*across)
    return first, np.cross(axis, first)


def circle(angle: Array, first: Array, second: Array) -> Array:
    """Return unit vectors at angles from the first of two unit vectors toward the second."""
    return np.asarray(np.cos(angle)[:, np.newaxis] * first + np.sin(angle)[:, np.newaxis] * second)


def reached(luminance: Callable[[Array], Array], levels: Array, end: float) -> Array:
    """Return the places from 0 to an end where a falling luminance is at each level, by halving."""
    low, high = np.zeros(len(levels)), np.full(len(levels), end)
    while True:
        middle = (low + high) / 2
        # No number lies between the two ends any more.
        if np.all((middle == low) | (middle == high)):
            return high
        bright = luminance(middle) > levels
        low, high = np.where(bright, middle, low), np.where(bright, high, middle)
