"""Isoluminance contours of a sphere and of a generalised truncus, in closed form."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from vizlight import _check
from vizlight.geometry.contours import axial, spacing
from vizlight.geometry.contours.banding import Bands, Laminae
from vizlight.geometry.contours.frustum import truncus

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.geometry.contours.spacing import Levels, Steps

__all__ = ["Bands", "Laminae", "sphere", "truncus", "virtual_light"]

Form = Literal["bands", "laminae"]


def sphere(
    center: Any,
    radius: float,
    /,
    *,
    direction: Any = None,
    position: Any = None,
    ambient: float = 0.0,
    diffuse: float = 1.0,
    power: float = 1.0,
    attenuation: Any = (1.0, 0.0, 0.0),
    levels: Levels = 16,
    segments: int | None = None,
    form: Form = "bands",
) -> Any:
    """Return the isoluminance contours of a sphere: circles of latitude about the light.

    Parameters
    ----------
    center : vector of 3 components
    radius : float
        0 or more, in the unit of the centre. A sphere of radius 0 has no surface: no cells.
    direction : vector of 3 components, optional
        Toward a light at infinity. For a highlight: toward the virtual light, with ``power=``.
    position : vector of 3 components, optional
        Of a near light. Within the sphere or on it no light reaches the outside.
    ambient, diffuse : float
        Luminance ``ambient + diffuse max(0, N . wi)^power``, unitless, from 0 to 1e9.
    power : float, default: 1.0
        1 is the cosine law; the shininess for a highlight.
    attenuation : (c1, c2, c3), default: (1, 0, 0)
        Of a near light: ``min(1, 1 / (c1 + c2 d + c3 d^2))``.
    levels : int, float or sequence of float, default: 16
        A count of equal steps, the allowed luminance error, or the values of the contours; see
        :func:`vizlight.geometry.contours.spacing.steps`.
    segments : int, optional
        Points of a circle, 3 or more. Default: so many that chords in place of circles add at
        most 5 % of half a step.
    form : {"bands", "laminae"}
        Bands are a closed surface; laminae are filled circles for :meth:`Laminae.order`.

    Returns
    -------
    Bands or Laminae

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    With q = sin^2 of half the angle to the light's axis and r = R/d, d the light's distance
    from the centre, ``N . wi = (1 - r - 2 q) / sqrt((1 - r)^2 + 4 r q)``: the terminator is at
    cos = R/d, and r = 0 is a light at infinity. The luminance falls with q, so each contour has
    one q, found by halving. The luminance at a contour's points misses its level by at most
    ``(16 + 4 power + 2 sqrt(power) R / (d - R)) eps`` of the range, for the points as they are in
    units of the radius: rounding of them turns the direction to a light close to the sphere. For
    powers below 1, infinitely steep at the terminator, ``((16 + 2 R / (d - R)) eps)^power``.
    Source: Isoluminance, Representing a Sphere; Specular Reflectors for ``power``.
    """
    middle = axial.triple("center", center)
    radius = _check.number("radius", radius, low=0.0)
    light = axial.source(
        middle, direction=direction, position=position, ambient=ambient, diffuse=diffuse,
        power=power, attenuation=attenuation,
    )  # fmt: skip
    segments = axial.options(segments, form, get_args(Form))
    law = _Latitudes(light, radius)
    steps = law.steps(levels)
    places = law.contours(steps)
    count, error = _round(law, steps, places, levels, segments)
    if form == "laminae":
        return _laminae(law, steps, places, count, middle, radius)
    return _bands(law, steps, places, count, error, middle, radius)


def virtual_light(center: Any, /, *, light: Any, eye: Any) -> Any:
    """Return the direction from a shape's centre to the virtual light that makes its highlight.

    Parameters
    ----------
    center : vector of 3 components
    light, eye : vizlight.Light and vizlight.View, or vector of 3 components
        A vector is a direction away from the shape. Of a light or view with a position, the
        direction from the centre counts.

    Returns
    -------
    ndarray, shape (3,)
        The unit vector half way between them.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or light and eye are opposite.

    Notes
    -----
    With both at infinity ``N . H`` of the highlight is exactly the diffuse cosine of a light
    along this vector. The mirror direction's ``R . E`` is approximated (Fisher-Woo:
    ``(N . H)^(4 s)`` for ``(R . E)^s``), and so is a near light or eye, for which H turns over
    the shape. Source: Isoluminance, Specular Reflectors.
    """
    middle = axial.triple("center", center)
    total = np.zeros(3)
    for name, given in (("light", light), ("eye", eye)):
        position = getattr(given, "position", None)
        if position is not None and not getattr(given, "parallel", False):
            total += axial.unit(name, axial.triple(name, position) - middle)
        else:
            total += axial.unit(name, getattr(given, "direction", given))
    if axial.length(total) < 1e-12:
        raise ValueError(
            _check.message("eye", "an eye that is not opposite the light", _check.describe(eye))
        )
    return total / axial.length(total)


class _Latitudes:
    """The luminance of a sphere over q, sin^2 of half the angle to the light."""

    def __init__(self, light: axial.Source, radius: float) -> None:
        self.light, self.radius = light, radius
        near = light.distance
        self.ratio = 0.0 if math.isinf(near) else (radius / near if near > radius else 1.0)
        self.dark = (1 - self.ratio) / 2
        if self.ratio == 0 and near == 0:
            self.dark = 0.0

    def luminance(self, q: Any) -> Array:
        """Return the luminance at some q."""
        q = np.asarray(q, dtype=np.float64)
        r = self.ratio
        far = np.sqrt((1 - r) ** 2 + 4 * r * q)
        cosine = np.where(q < self.dark, (1 - r - 2 * q) / np.where(far > 0, far, 1), 0)
        reach = math.inf
        if math.isfinite(self.light.distance):
            reach = np.maximum(far * self.light.distance, 0)
        # At a power of 0 the law is a step at the terminator.
        return np.where(q < self.dark, self.light.luminance(cosine, reach), self.light.low)

    def steps(self, wanted: Levels) -> Steps:
        """Return the steps between the dark side and the point below the light."""
        return spacing.steps(wanted, self.light.low, float(self.luminance(0.0)))

    def contours(self, steps: Steps) -> Array:
        """Return the q of each contour, the terminator first; none where all is dark."""
        edges = steps.edges[:-1]
        low, high = np.zeros(len(edges)), np.full(len(edges), self.dark)
        for _ in range(1080 if len(edges) else 0):
            middle = (low + high) / 2
            if np.all((middle == low) | (middle == high)):
                break
            bright = self.luminance(middle) > edges
            low, high = np.where(bright, middle, low), np.where(bright, high, middle)
        return high

    def chord(self, places: Array, segments: int) -> float:
        """Return the most that chords in place of circles change the luminance."""
        # With angles, so that small circles below a close light lose nothing.
        angle = 2 * np.arcsin(np.sqrt(places))
        within = np.arctan2(np.sin(angle) * math.cos(math.pi / segments), np.cos(angle))
        middle = np.sin(within / 2) ** 2
        return float(np.abs(self.luminance(middle) - self.luminance(places)).max(initial=0))


def _round(
    law: _Latitudes, steps: Steps, places: Array, wanted: Levels, segments: int | None
) -> tuple[int, float]:
    """Return the points of a circle, and the luminance error with them."""
    if segments is not None:
        return segments, steps.error + law.chord(places, segments)
    allowed = (1 + spacing.CHORDS) * steps.error
    wish = spacing.allowed(wanted)
    if wish is not None:
        allowed = max(wish, steps.error)
    count, error = axial.FEWEST, steps.error
    while count < axial.MOST:
        error = steps.error + law.chord(places, count)
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
    law: _Latitudes, steps: Steps, places: Array, count: int, error: float, middle: Array,
    radius: float,
) -> Bands:  # fmt: skip
    """Return the closed surface: caps at both poles and strips between circles."""
    q = np.concatenate([places, [0.0, 1.0]])
    contour = np.concatenate([np.arange(len(places)), [-1, -1]])
    inside = (q > 0) & (q < 1)
    q, contour = q[inside], contour[inside]
    order = np.argsort(q, kind="stable")
    q, contour = q[order], contour[order]
    # Circles between contours that are far apart keep the surface round; they are no contours.
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

    points = _circles(q, count, law.light.toward, radius, middle)
    poles = middle + radius * np.outer([1, -1], law.light.toward)
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
    # From the light outward each contour that is passed takes the band down by one.
    passed = np.concatenate([[0], np.cumsum(contour >= 0)])
    number = len(places) if np.any(law.luminance(0.0) > law.light.low) else 0
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
    law: _Latitudes, steps: Steps, places: Array, count: int, middle: Array, radius: float
) -> Laminae:
    """Return filled circles: those of the lit side, and their mirror images for the dark one."""
    lit = places[(places > 0) & (places < 1)]
    band = np.arange(1, len(steps.edges))[(places > 0) & (places < 1)]
    # The dark side is closed by a dark circle just behind the widest lit one, so that from
    # behind it covers that, and by circles as far apart as on the lit side.
    beyond = np.concatenate([[max(law.dark, 0.5) + 1e-9], 1 - lit[lit < 0.5]])
    q = np.concatenate([lit, beyond])
    values = np.concatenate([steps.values[band], np.full(len(beyond), steps.edges[0])])
    if radius == 0:
        q, values = q[:0], values[:0]
    return Laminae(
        points=_circles(q, count, law.light.toward, radius, middle),
        offsets=np.arange(len(q) + 1) * count,
        values=values,
    )
