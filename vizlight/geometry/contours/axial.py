"""What shapes of revolution share: frames, checked sources of light, the law of a term."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight import _check
from vizlight.model import falloff

if TYPE_CHECKING:
    from vizlight._types import Array


#: Segments of a circle: as few as look round, and the most that are tried.
FEWEST, MOST = 36, 1 << 13


@dataclass(frozen=True)
class Source:
    """One light and the law by which a surface gives it back: ``low + scale c^power fading``.

    ``toward`` is a unit vector to a light at infinity, or to a near one from the shape's
    centre; ``distance`` is infinite, or that of the near light from the centre.
    """

    toward: Array
    distance: float
    low: float
    scale: float
    power: float
    attenuation: tuple[float, float, float]

    def luminance(self, cosine: Array, distance: Any = math.inf) -> Array:
        """Return the luminance for the cosine of incidence and the distance to the light."""
        lit = np.maximum(cosine, 0)
        with np.errstate(under="ignore"):
            value = np.where(lit > 0, lit**self.power, 0)
            if math.isfinite(self.distance):
                value = value * falloff.fading(np.asarray(distance, float), self.attenuation)
            return np.asarray(self.low + self.scale * value)


def source(
    center: Array, *, direction: Any, position: Any, ambient: float, diffuse: float,
    power: float, attenuation: Any,
) -> Source:  # fmt: skip
    """Check what lights a shape and return it as seen from the shape's centre."""
    if (direction is None) == (position is None):
        raise ValueError(
            _check.message(
                "direction", "either direction= (toward the light) or position=",
                "neither" if direction is None else "both",
            )
        )  # fmt: skip
    low = _check.number("ambient", ambient, low=0.0, high=_check.LARGEST)
    scale = _check.number("diffuse", diffuse, low=0.0, high=_check.LARGEST)
    power = _check.number("power", power, low=0.0, high=_check.LARGEST)
    fading = falloff.attenuation("attenuation", attenuation)
    if direction is not None:
        if fading != (1.0, 0.0, 0.0):
            raise ValueError(
                _check.message("attenuation", "a position= beside it", "a light at infinity")
            )
        return Source(unit("direction", direction), math.inf, low, scale, power, fading)
    offset = triple("position", position) - center
    size = length(offset)
    toward = offset / size if size > 0 else np.array([0.0, 0, 1])
    return Source(toward, size, low, scale, power, fading)


def length(vector: Any) -> float:
    """Return the length of a vector, without overflow or underflow."""
    return math.hypot(*(float(x) for x in vector))


def triple(name: str, value: Any) -> Array:
    """Return a finite vector of 3 components."""
    found = _check.vector(name, value)
    if len(found) != 3:
        raise ValueError(_check.message(name, "3 components", len(found)))
    return np.array(found)


def unit(name: str, value: Any) -> Array:
    """Return a unit vector of 3 components."""
    found = triple(name, value)
    top = np.abs(found).max()
    if not top > 0:
        raise ValueError(
            _check.message(name, "a direction of non-zero length", _check.describe(value))
        )
    found = found / top
    return np.asarray(found / length(found))


def frame(axis: Array, toward: Array | None = None) -> tuple[Array, Array]:
    """Return two unit vectors across a unit axis and each other, the first rather ``toward``.

    Where ``toward`` runs along the axis to rounding, the first is arbitrary.
    """
    first = None
    if toward is not None:
        across = toward - (toward @ axis) * axis
        across = across - (across @ axis) * axis
        if length(across) > 8 * np.finfo(np.float64).eps:
            first = across / length(across)
    if first is None:
        least = np.zeros(3)
        least[np.abs(axis).argmin()] = 1
        across = np.cross(axis, least)
        first = across / length(across)
    return first, np.cross(axis, first)


def options(segments: Any, form: Any, forms: tuple[str, ...]) -> int | None:
    """Check how finely a circle is drawn, and the form of the result."""
    if form not in forms:
        raise ValueError(_check.message("form", " or ".join(map(repr, forms)), repr(form)))
    return None if segments is None else _check.integer("segments", segments, low=3)
