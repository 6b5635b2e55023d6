"""Isoluminance contours of a sphere and of a frustum (generalised truncus), in closed form.

The source calls a conical frustum and its limits, cone, cylinder, disc and rod, a truncus.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Indices, VectorLike
from vizlight.geometry import axial
from vizlight.geometry.contours import banding, refinement, spacing
from vizlight.geometry.contours.banding import Bands
from vizlight.geometry.contours.refinement import Luminance
from vizlight.geometry.contours.spacing import Levels, LuminanceSteps
from vizlight.geometry.solids import primitives, triangle_mesh
from vizlight.geometry.solids.exact_surfaces import PROFILE
from vizlight.model import kernels

__all__ = ["Bands", "sphere", "truncus", "virtual_light"]

Method = Literal["rulings", "curves"]


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
) -> Bands:
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

    Returns
    -------
    Bands
        Contours, and the parts of the closed surface between them.

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
    solid = primitives.Sphere(center, radius)
    light = axial.source(
        solid.center, direction=direction, position=position, ambient=ambient, diffuse=diffuse,
        power=power, attenuation=attenuation,
    )  # fmt: skip
    segments = _checked(segments)
    latitudes = Latitudes(light, solid)
    # Between the unlit side and the point nearest to the light.
    steps = spacing.steps(levels, light.low, float(latitudes.luminance(0.0)))
    # The value of q of each contour, the terminator first.
    places = axial.reached(latitudes.luminance, steps.edges[:-1], latitudes.dark)
    count, error = roundness(latitudes, steps, places, levels, segments)
    return _bands(latitudes, steps, places, count, error)


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
    # A headlight is where the eye is.
    light = eye if getattr(light, "is_headlight", False) else light
    for name, light_or_eye in (("light", light), ("eye", eye)):
        position = getattr(light_or_eye, "position", None)
        if position is not None and not getattr(light_or_eye, "parallel", False):
            total += _check.unit(name, axial.triple(name, position) - middle)
        else:
            total += _check.unit(name, getattr(light_or_eye, "direction", light_or_eye))
    # Halfway between opposite directions there is no direction.
    if math.hypot(*total) < 1e-12:
        expected, remedy = "an eye that is not opposite the light", "move the eye or the light"
        raise _check.value_error("eye", expected, _check.describe(eye), remedy)
    return np.asarray(total / math.hypot(*total))


def _checked(segments: int | None) -> int | None:
    """Validate the number of segments of a circle."""
    return None if segments is None else _check.integer("segments", segments, low=3)


class Latitudes:
    """Luminance of a sphere as a function of q, sin^2 of half the angle to the light."""

    def __init__(self, light: axial.ShapeLight, solid: primitives.Sphere) -> None:
        self.light, self.solid = light, solid
        near, radius = light.distance, solid.radius
        # A light on or inside the sphere has all of its outside behind the horizon, as at R/d = 1.
        self.ratio = 0.0 if math.isinf(near) else (radius / near if near > radius else 1.0)
        # The terminator, cos = R/d, as a value of q.
        self.dark = (1 - self.ratio) / 2

    def luminance(self, q: ArrayLike) -> Array:
        """Return the luminance at values of q."""
        q = np.asarray(q, dtype=np.float64)
        r = self.ratio
        # Distance of the light from the point, in units of its distance from the centre.
        far = np.sqrt((1 - r) ** 2 + 4 * r * q)
        cosine = np.where(q < self.dark, (1 - r - 2 * q) / np.where(far > 0, far, 1), 0)
        lit = self.light.luminance(cosine, far * self.light.distance)
        # At a power of 0 the luminance is a step function at the terminator.
        return np.where(q < self.dark, lit, self.light.low)

    def chord(self, places: Array, segments: int) -> float:
        """Return the largest change of the luminance by chords instead of circles."""
        # Angles avoid cancellation for small circles below a close light.
        angle = 2 * np.arcsin(np.sqrt(places))
        # The middle of a chord is nearer to the axis of its circle by the cosine of half a segment.
        within = np.arctan2(np.sin(angle) * math.cos(math.pi / segments), np.cos(angle))
        middle = np.sin(within / 2) ** 2
        return float(np.abs(self.luminance(middle) - self.luminance(places)).max(initial=0))

    def circles(self, q: Array, count: int) -> Array:
        """Return points on circles of latitude, circle after circle."""
        axis = self.light.toward
        angle = 2 * np.pi * np.arange(count) / count
        ring = axial.circle(angle, *axial.frame(axis))
        # Sine and cosine of the angle to the light, by q.
        across, along = 2 * np.sqrt(q * (1 - q)), 1 - 2 * q
        points = across[:, np.newaxis, np.newaxis] * ring + along[:, np.newaxis, np.newaxis] * axis
        return np.asarray(self.solid.center + self.solid.radius * points.reshape(-1, 3))


def roundness(
    latitudes: Latitudes, steps: LuminanceSteps, places: Array, wanted: Levels, segments: int | None
) -> tuple[int, float]:
    """Return the number of points per circle and the resulting luminance error."""
    if segments is not None:
        return segments, steps.error + latitudes.chord(places, segments)
    wish = spacing.allowed(wanted)
    allowed = (1 + spacing.CHORDS) * steps.error if wish is None else max(wish, steps.error)
    count, error = axial.FEWEST, steps.error
    while count < axial.MOST:
        error = steps.error + latitudes.chord(places, count)
        if error <= allowed:
            break
        # Few more segments each time, so that not many more than needed are made.
        count = math.ceil(count * 1.2)
    return count, error


def _filled(places: Array, segments: int) -> tuple[Array, Indices]:
    """Return angles from 0 up to, but without, pi: those of contours, and others between them.

    Contours that are far apart get further angles between them, which keep a surface round with so
    many segments per turn. The contour of each angle, or -1, follows.
    """
    inside = np.flatnonzero((places > 0) & (places < np.pi))
    contour = np.concatenate([[-1], inside[np.argsort(places[inside], kind="stable")]])
    ends = np.concatenate([[0.0], places[contour[1:]], [np.pi]])
    # Rounding must not add a segment to a piece that is a whole number of them.
    pieces = np.maximum(np.ceil(np.diff(ends) * segments / (2 * np.pi) - 1e-9), 1).astype(int)
    piece, step = banding.ranges(np.zeros_like(pieces), pieces)
    angle = ends[piece] + step * (np.diff(ends) / pieces)[piece]
    return angle, np.where(step == 0, contour[piece], -1)


def _bands(
    latitudes: Latitudes, steps: LuminanceSteps, places: Array, count: int, error: float
) -> Bands:
    """Return the closed surface: strips between circles, of which the first and last are points."""
    if latitudes.solid.empty:
        return banding.none(steps, error)
    angle, contour = _filled(2 * np.arcsin(np.sqrt(places)), min(count, 400))
    q = np.append(np.sin(angle / 2) ** 2, 1.0)
    # The contours' own places, without the rounding of the way through angles.
    on = np.flatnonzero(contour >= 0)
    q[on] = places[contour[on]]
    number = np.arange(len(q) * count).reshape(len(q), count)
    number[[0, -1]] = number[[0, -1], :1]
    # Outward from the light each contour decreases the band by one; without any light the whole
    # sphere is in the lowest one.
    brightest = len(places) if np.any(latitudes.luminance(0.0) > latitudes.light.low) else 0
    band = (brightest - np.cumsum(contour >= 0))[:, np.newaxis]
    lines = np.stack([number[on], np.roll(number[on], -1, axis=1)], axis=-1).reshape(-1, 2)
    contours = lines, np.repeat(contour[on], count)
    return _around(latitudes.circles(q, count), number, band, contours, steps, error)


def _around(
    points: Array, number: Indices, band: Indices, contours: tuple[Indices, Indices],
    steps: LuminanceSteps, error: float, ends: Sequence[tuple[int, Indices, float]] = (),
) -> Bands:  # fmt: skip
    """Return the closed surface of a grid around an axis, and of polygons at its ends.

    The grid has the index of each point, in a row for each circle, and the band of each of its
    quadrilaterals; the contours have the indices of their ends, and those of their levels; the ends
    have their patches, corners and values.
    """
    after = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], number[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    cell = np.repeat(np.arange(len(quads)), 4)
    # Those with a corner twice are triangles, or none.
    sizes, corners, first = banding.polygons(cell, cell, quads.ravel())
    strips = np.broadcast_to(band, number[1:].shape).ravel()[cell[first]]
    patches, rings, values = zip(*ends, strict=True) if ends else ((), (), ())
    cells = (
        np.append(sizes, [len(ring) for ring in rings]).astype(np.intp),
        np.concatenate([corners, *rings]),
        np.append(strips, steps.band(np.array(values))),
        np.append(np.zeros_like(strips), patches).astype(np.intp),
    )
    lines = contours[0], steps.edges[contours[1]]
    bands = banding.assembled([points], cells, lines, steps, error)
    # The ends have their own luminance.
    return dataclasses.replace(bands, values=np.append(bands.values[: len(strips)], values))


def truncus(
    center: VectorLike,
    axis: VectorLike,
    radii: VectorLike,
    /,
    *,
    height: float | None = None,
    direction: VectorLike | None = None,
    position: VectorLike | None = None,
    ambient: float = 0.0,
    diffuse: float = 1.0,
    power: float = 1.0,
    attenuation: VectorLike = (1.0, 0.0, 0.0),
    levels: Levels = 16,
    segments: int | None = None,
    method: Method | None = None,
) -> Bands:
    """Return the isoluminance contours of a frustum: rulings of its side, and its two ends.

    Parameters
    ----------
    center : vector of 3 components
        Midpoint of the axis.
    axis : vector of 3 components
        Direction from the second end to the first. Its length is the height unless ``height``
        is given.
    radii : (float, float)
        Radii R1 at ``center + axis / 2`` and R2 at ``center - axis / 2``, 0 or more. With one
        radius of 0 the shape is a cone, with equal radii a cylinder, disc or rod.
    height : float, optional
        Height, 0 or more. At height 0 the side is a flat ring, without area if the radii are
        equal.
    direction, position, ambient, diffuse, power, attenuation
        Light and reflection, as for :func:`sphere`.
    levels : int, float or sequence of float, default: 16
        Steps of luminance of the side, as for :func:`sphere`. Under a light at
        infinity each end has one exact value.
    segments : int, optional
        Smallest number of points on the circle of an end, 3 or more. Default: 36.
    method : {"rulings", "curves"}, optional
        Treatment of a near light. Rulings replace it by a light at infinity in its direction from
        the centre, which is the source's approximation. Curves, the default, are found by halving
        edges and are right for the position of the light, also on the ends.

    Returns
    -------
    Bands
        Contours; patches 0, 1 and 2 are the side, the first end and the second end.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.

    Notes
    -----
    The normal ``N`` is parallel to ``H rho + (R2 - R1) a``, with rho the unit vector normal to the
    unit axis a, and H the height. This is the source's ``p14 - (c - h a)`` with
    ``h = (R2^2 - R1^2) / (2 H)``, divided by ``(R1 + R2) / (2 H)``, so that neither height 0 nor
    two radii of 0 lead to a division by zero. With phi the angle around the axis from the light,
    ``N . L = A cos(phi) + B``: each level has two rulings, which are exact for a light at infinity.

    The luminance at a ruling differs from its level by at most ``(8 + 4 power) eps`` of
    ``diffuse``, plus ``H / max(R1, R2) eps`` from the rotation of rulings by rounding of long thin
    shapes. For powers below 1, infinitely steep at the terminator, the bound is
    ``((8 + H / max(R1, R2)) eps)^power``.
    Source: Isoluminance, Representing a Generalised Truncus, and appendix.
    """
    solid = primitives.Frustum(center, axis, radii, height=height)
    light = axial.source(
        solid.center, direction=direction, position=position, ambient=ambient, diffuse=diffuse,
        power=power, attenuation=attenuation,
    )  # fmt: skip
    segments = _checked(segments) or axial.FEWEST
    if method is None:
        method = "rulings" if position is None else "curves"
    _check.choice("method", method, get_args(Method))
    # A near lamp has another direction at each point: no ruling has one luminance any more.
    if method == "curves":
        return refinement.draw(
            triangle_mesh.mesh(solid, segments), shade(light, solid.center), levels, low=light.low
        )
    # A near light fades with its distance from the centre.
    # The source's approximation: one direction and one fading for the whole solid.
    if math.isfinite(light.distance):
        fading = light.luminance(np.array(1.0), light.distance) - light.low
        light = dataclasses.replace(light, scale=float(fading), distance=math.inf)
    side = Rulings(light, solid)
    ends = side.luminance(np.array([0.0, np.pi]))
    steps = spacing.steps(levels, float(ends.min()), float(ends.max()), exact=True)
    # The angle of each contour, in [0, pi]; the lowest level is the terminator.
    places = axial.reached(side.luminance, steps.edges[:-1], np.pi)
    return _ruled_bands(side, steps, places, segments)


def shade(light: axial.ShapeLight, center: Array) -> Luminance:
    """Return the function of points and normals that gives the luminance under one light."""

    def luminance(points: Array, normals: Array) -> Array:
        if math.isinf(light.distance):
            return light.luminance(normals @ light.toward)
        # The light less the point, both seen from the centre.
        toward = light.toward * light.distance - (points - center)
        size = kernels.length(np.ascontiguousarray(toward.T))
        cosine = np.einsum("ij,ij->i", toward, normals) / np.where(size > 0, size, 1)
        return light.luminance(cosine, size)

    return luminance


class Rulings:
    """Luminance of the side of a frustum as a function of the angle around its axis."""

    def __init__(self, light: axial.ShapeLight, solid: primitives.Frustum) -> None:
        self.light, self.solid = light, solid
        self.first, self.second = axial.frame(solid.axis, light.toward)
        # The side's normal: across the axis by the height, along it by the difference of the radii.
        across, along = (float(x) for x in solid.surfaces().rows[0, PROFILE][:2])
        # A and B of N . L = A cos(phi) + B. Rounding could make A negative where the light is on
        # the axis.
        self.a = across * max(float(self.first @ light.toward), 0.0)
        self.b = along * float(solid.axis @ light.toward)

    def luminance(self, angle: ArrayLike) -> Array:
        """Return the luminance at angles from the light."""
        # Half angles avoid cancellation at small angles.
        cosine = (self.a + self.b) - 2 * self.a * np.sin(np.asarray(angle) / 2) ** 2
        return self.light.luminance(np.asarray(cosine))

    def end(self, first: bool) -> float:
        """Return the luminance of an end."""
        cosine = self.solid.axis @ self.light.toward * (1 if first else -1)
        return float(self.light.luminance(np.array(cosine)))

    def place(self, angle: Array, first: bool) -> Array:
        """Return points on the circle of an end."""
        radius = self.solid.radii[0 if first else 1]
        half = (0.5 if first else -0.5) * self.solid.height * self.solid.axis
        # The circle in the frame whose first axis is the light's part across the axis.
        ring = axial.circle(angle, self.first, self.second)
        return np.asarray(self.solid.center + half + radius * ring)


def _ruled_bands(side: Rulings, steps: LuminanceSteps, places: Array, segments: int) -> Bands:
    """Return the closed surface: strips between rulings, and one polygon per end."""
    radii = np.array(side.solid.radii)
    # Each contour is a pair of rulings, at plus and minus its angle from the light. The angles run
    # from the light to the far side and, mirrored, back.
    angle, contour = _filled(places, segments)
    angle = np.concatenate([angle, [np.pi], 2 * np.pi - angle[:0:-1]])
    contour = np.concatenate([contour, [-1], contour[:0:-1]])
    number = np.arange(2 * len(angle)).reshape(2, -1)
    # An apex is one point that all strips share.
    number[radii == 0] = number[radii == 0, :1]
    if side.solid.height == 0 and radii[0] == radii[1]:
        # Two discs back to back share one rim.
        number[1] = number[0]
    # No contour lies within a strip, so the band at its middle is the strip's.
    band = steps.band(side.luminance((angle + np.append(angle[1:], 2 * np.pi)) / 2))
    on = np.flatnonzero(contour >= 0)
    points = np.concatenate([side.place(angle, first=first) for first in (True, False)])
    # The second end is seen from below, and its rim runs the other way.
    rings = (1, number[0]), (2, number[1, ::-1])
    ends = [(i, ring, side.end(first=i == 1)) for i, ring in rings if radii[i - 1] > 0]
    contours = number[:, on].T, contour[on]
    return _around(points, number, band, contours, steps, steps.error, ends)
