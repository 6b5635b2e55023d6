"""Isoluminance contours of a sphere and of a frustum (generalised truncus), in closed form."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from vizlight import _check
from vizlight.geometry import axial
from vizlight.geometry.contours import spacing
from vizlight.geometry.contours.banding import Bands, Laminae
from vizlight.geometry.contours.frustum import truncus

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Foreign, VectorLike
    from vizlight.geometry.contours.spacing import Levels, Steps

__all__ = ["Bands", "Laminae", "sphere", "truncus", "virtual_light"]

Form = Literal["bands", "laminae"]


def sphere(
    center: VectorLike,
    radius: float,
    /,
    *,
    direction: VectorLike | None = None,
    position: VectorLike | None = None,
    ambient: float = 0.0,
    diffuse: float = 1.0,
    power: float = 1.0,
    attenuation: VectorLike = (1.0, 0.0, 0.0),
    levels: Levels = 16,
    segments: int | None = None,
    form: Form = "bands",
) -> Foreign:
    """Return the isoluminance contours of a sphere: circles of latitude about the light.

    Parameters
    ----------
    center : vector of 3 components
        Centre of the sphere.
    radius : float
        Radius in the unit of the centre, 0 or more. A sphere of radius 0 has no polygons.
    direction : vector of 3 components, optional
        Direction toward a light at infinity; for a highlight, toward the virtual light.
    position : vector of 3 components, optional
        Position of a near light. A light on or inside the sphere does not reach its outside.
    ambient, diffuse : float, default: 0.0, 1.0
        Coefficients of the luminance ``ambient + diffuse max(0, N . wi)^power``, unitless, from 0
        to 1e9.
    power : float, default: 1.0
        Exponent of the cosine: 1 for Lambert's law, the shininess for a highlight.
    attenuation : (c1, c2, c3), default: (1, 0, 0)
        Coefficients of the factor ``min(1, 1 / (c1 + c2 d + c3 d^2))`` of a near light.
    levels : int, float or sequence of float, default: 16
        Number of equal steps, allowed luminance error, or luminance of the contours; see
        :func:`vizlight.geometry.contours.spacing.steps`.
    segments : int, optional
        Number of points per circle, 3 or more. Default: the number with which chords instead of
        circles add at most 5 % of half a step.
    form : {"bands", "laminae"}
        Form of the result. Bands are a closed surface; laminae are filled circles, to be painted
        by :meth:`Laminae.order`.

    Returns
    -------
    Bands or Laminae
        Contours, and the parts of the surface between them.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.

    Notes
    -----
    With q = sin^2 of half the angle to the light's axis and r = R/d, d the light's distance
    from the centre, ``N . wi = (1 - r - 2 q) / sqrt((1 - r)^2 + 4 r q)``: the terminator is at
    cos = R/d, and r = 0 is a light at infinity. The luminance decreases with q, so each contour
    has one q, found by halving.

    The luminance at the points of a contour differs from its level by at most
    ``(16 + 4 power + 2 sqrt(power) R / (d - R)) eps`` of the range, for the rounded points in
    units of the radius; their rounding changes the direction to a light close to the sphere. For
    powers below 1, infinitely steep at the terminator, the bound is
    ``((16 + 2 R / (d - R)) eps)^power``.
    Source: Isoluminance, Representing a Sphere; Specular Reflectors for ``power``.
    """
    middle = axial.triple("center", center)
    radius = _check.number("radius", radius, low=0.0)
    light = axial.source(
        middle, direction=direction, position=position, ambient=ambient, diffuse=diffuse,
        power=power, attenuation=attenuation,
    )  # fmt: skip
    segments = axial.options(segments, form, get_args(Form))
    latitudes = _Latitudes(light, radius)
    steps = latitudes.steps(levels)
    places = latitudes.contours(steps)
    count, error = _round(latitudes, steps, places, levels, segments)
    if form == "laminae":
        return _laminae(latitudes, steps, places, count, middle, radius)
    return _bands(latitudes, steps, places, count, error, middle, radius)


def virtual_light(center: VectorLike, /, *, light: object, eye: object) -> Array:
    """Return the direction from a shape's centre toward the virtual light of its highlight.

    Parameters
    ----------
    center : vector of 3 components
        Centre of the shape.
    light, eye : vizlight.Light and vizlight.View, or vector of 3 components
        Light and eye. A vector is a direction away from the shape; a light or view with a
        position counts with its direction from the centre.

    Returns
    -------
    ndarray, shape (3,)
        Unit vector half way between the directions toward the light and the eye.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, or if light and eye are in opposite directions.

    Notes
    -----
    With light and eye at infinity, ``N . H`` of the highlight is exactly the diffuse cosine of a
    light in this direction. It approximates ``R . E`` of the mirror direction (Fisher-Woo:
    ``(N . H)^(4 s)`` for ``(R . E)^s``) and a near light or eye, for which H varies over the
    shape. Source: Isoluminance, Specular Reflectors.
    """
    middle = axial.triple("center", center)
    total = np.zeros(3)
    for name, given in (("light", light), ("eye", eye)):
        position = getattr(given, "position", None)
        if position is not None and not getattr(given, "parallel", False):
            total += _check.unit(name, axial.triple(name, position) - middle)
        else:
            total += _check.unit(name, getattr(given, "direction", given))
    if axial.length(total) < 1e-12:
        raise ValueError(
            _check.message(
                "eye",
                "an eye that is not opposite the light",
                _check.describe(eye),
                "move the eye or the light",
            )
        )
    return np.asarray(total / axial.length(total))


class _Latitudes:
    """Luminance of a sphere as a function of q, sin^2 of half the angle to the light."""

    def __init__(self, light: axial.Source, radius: float) -> None:
        self.light, self.radius = light, radius
        near = light.distance
        self.ratio = 0.0 if math.isinf(near) else (radius / near if near > radius else 1.0)
        self.dark = (1 - self.ratio) / 2
        if self.ratio == 0 and near == 0:
            self.dark = 0.0

    def luminance(self, q: ArrayLike) -> Array:
        """Return the luminance at values of q."""
        q = np.asarray(q, dtype=np.float64)
        r = self.ratio
        far = np.sqrt((1 - r) ** 2 + 4 * r * q)
        cosine = np.where(q < self.dark, (1 - r - 2 * q) / np.where(far > 0, far, 1), 0)
        reach: Array | float = math.inf
        if math.isfinite(self.light.distance):
            reach = np.maximum(far * self.light.distance, 0)
        # At a power of 0 the luminance is a step function at the terminator.
        return np.where(q < self.dark, self.light.luminance(cosine, reach), self.light.low)

    def steps(self, wanted: Levels) -> Steps:
        """Return the steps between the unlit side and the point nearest to the light."""
        return spacing.steps(wanted, self.light.low, float(self.luminance(0.0)))

    def contours(self, steps: Steps) -> Array:
        """Return q of each contour, the terminator first; empty if no light reaches the sphere."""
        return axial.reached(self.luminance, steps.edges[:-1], self.dark)

    def chord(self, places: Array, segments: int) -> float:
        """Return the largest change of the luminance by chords instead of circles."""
        # Angles avoid cancellation for small circles below a close light.
        angle = 2 * np.arcsin(np.sqrt(places))
        within = np.arctan2(np.sin(angle) * math.cos(math.pi / segments), np.cos(angle))
        middle = np.sin(within / 2) ** 2
        return float(np.abs(self.luminance(middle) - self.luminance(places)).max(initial=0))


def _round(
    latitudes: _Latitudes, steps: Steps, places: Array, wanted: Levels, segments: int | None
) -> tuple[int, float]:
    """Return the number of points per circle and the resulting luminance error."""
    if segments is not None:
        return segments, steps.error + latitudes.chord(places, segments)
    allowed = (1 + spacing.CHORDS) * steps.error
    wish = spacing.allowed(wanted)
    if wish is not None:
        allowed = max(wish, steps.error)
    count, error = axial.FEWEST, steps.error
    while count < axial.MOST:
        error = steps.error + latitudes.chord(places, count)
        if error <= allowed:
            break
        count = math.ceil(count * 1.2)
    return count, error


def _circles(q: Array, count: int, axis: Array, radius: float, middle: Array) -> Array:
    """Return points on circles of latitude, circle after circle."""
    first, second = axial.frame(axis)
    angle = 2 * np.pi * np.arange(count) / count
    ring = np.cos(angle)[:, np.newaxis] * first + np.sin(angle)[:, np.newaxis] * second
    across = 2 * np.sqrt(q * (1 - q))
    points = (
        across[:, np.newaxis, np.newaxis] * ring + (1 - 2 * q)[:, np.newaxis, np.newaxis] * axis
    )
    return np.asarray(middle + radius * points.reshape(-1, 3))


def _bands(
    latitudes: _Latitudes, steps: Steps, places: Array, count: int, error: float, middle: Array,
    radius: float,
) -> Bands:  # fmt: skip
    """Return the closed surface: caps at both poles and strips between circles."""
    q = np.concatenate([places, [0.0, 1.0]])
    contour = np.concatenate([np.arange(len(places)), [-1, -1]])
    inside = (q > 0) & (q < 1)
    q, contour = q[inside], contour[inside]
    order = np.argsort(q, kind="stable")
    q, contour = q[order], contour[order]
    # Additional circles between distant contours keep the surface round.
    angle = 2 * np.arcsin(np.sqrt(np.concatenate([[0.0], q, [1.0]])))
    turn = min(count, 400) / (2 * np.pi)
    pieces = np.maximum(np.ceil(np.diff(angle) * turn - 1e-9), 1).astype(int)
    extra = np.concatenate(
        [
            np.linspace(a, b, n + 1)[1:-1]
            for a, b, n in zip(angle[:-1], angle[1:], pieces, strict=True)
        ]
    )
    q = np.concatenate([q, np.sin(extra / 2) ** 2])
    contour = np.concatenate([contour, np.full(len(extra), -1)])
    order = np.argsort(q, kind="stable")
    q, contour = q[order], contour[order]
    rings = len(q)
    if radius == 0:
        rings, q, contour = 0, q[:0], contour[:0]

    points = _circles(q, count, latitudes.light.toward, radius, middle)
    poles = middle + radius * np.outer([1, -1], latitudes.light.toward)
    points = np.concatenate([points, poles]) if rings else np.empty((0, 3))
    ring = np.arange(rings * count).reshape(rings, count)
    turned = np.roll(ring, -1, axis=1)
    top, bottom = rings * count, rings * count + 1
    if rings:
        strips = np.stack([ring[:-1], ring[1:], turned[1:], turned[:-1]], axis=-1).reshape(-1, 4)
        cap = np.stack([np.full(count, top), ring[0], turned[0]], axis=-1)
        floor = np.stack([np.full(count, bottom), turned[-1], ring[-1]], axis=-1)
    else:
        strips, cap, floor = np.empty((0, 4), int), np.empty((0, 3), int), np.empty((0, 3), int)
    corners = np.concatenate([cap.ravel(), strips.ravel(), floor.ravel()])
    sizes = np.repeat([3, 4, 3], [len(cap), len(strips), len(floor)])
    # Outward from the light, each contour decreases the band by one.
    passed = np.concatenate([[0], np.cumsum(contour >= 0)])
    number = len(places) if np.any(latitudes.luminance(0.0) > latitudes.light.low) else 0
    band = np.repeat(number - passed, count)[: len(sizes)] if rings else np.empty(0, int)
    on = contour >= 0
    lines = np.stack([ring[on], turned[on]], axis=-1).reshape(-1, 2)
    return Bands(
        points=points,
        offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp),
        corners=corners.astype(np.intp),
        band=band.astype(np.intp),
        values=steps.values[band],
        patch=np.zeros(len(sizes), np.intp),
        lines=lines.astype(np.intp),
        line_levels=np.repeat(steps.edges[contour[on]], count),
        steps=steps,
        error=error,
    )


def _laminae(
    latitudes: _Latitudes, steps: Steps, places: Array, count: int, middle: Array, radius: float
) -> Laminae:
    """Return filled circles of the lit side, and their mirror images for the unlit side."""
    lit = places[(places > 0) & (places < 1)]
    band = np.arange(1, len(steps.edges))[(places > 0) & (places < 1)]
    # The unlit side begins with a circle just behind the widest lit one, which it hides when seen
    # from behind; its other circles are as far apart as on the lit side.
    beyond = np.concatenate([[max(latitudes.dark, 0.5) + 1e-9], 1 - lit[lit < 0.5]])
    q = np.concatenate([lit, beyond])
    values = np.concatenate([steps.values[band], np.full(len(beyond), steps.edges[0])])
    if radius == 0:
        q, values = q[:0], values[:0]
    return Laminae(
        points=_circles(q, count, latitudes.light.toward, radius, middle),
        offsets=np.arange(len(q) + 1) * count,
        values=values,
    )
