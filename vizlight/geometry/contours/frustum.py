"""Isoluminance contours of a generalised truncus: cone, frustum, cylinder, disc or rod.

The source calls a conical frustum and its limits a truncus.
"""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from vizlight import _check
from vizlight.geometry import axial
from vizlight.geometry.contours import refinement, spacing
from vizlight.geometry.contours.banding import Bands, Laminae
from vizlight.geometry.solids import primitives, triangle_mesh
from vizlight.model import kernels

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Foreign, Indices, VectorLike
    from vizlight.geometry.contours.refinement import Luminance
    from vizlight.geometry.contours.spacing import Levels, Steps

Form = Literal["bands", "laminae"]
Method = Literal["rulings", "curves"]


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
    form: Form = "bands",
    method: Method | None = None,
) -> Foreign:
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
        Light and reflection, as for :func:`vizlight.geometry.contours.isoluminance.sphere`.
    levels : int, float or sequence of float, default: 16
        Steps of luminance of the side, as for
        :func:`vizlight.geometry.contours.isoluminance.sphere`. Under a light
        at infinity each end has one exact value.
    segments : int, optional
        Smallest number of points on the circle of an end, 3 or more. Default: 36.
    form : {"bands", "laminae"}
        Form of the result. Bands are a closed surface; laminae are quadrilaterals and the two
        ends, to be painted by :meth:`Laminae.order`.
    method : {"rulings", "curves"}, optional
        Treatment of a near light. Rulings replace it by a light at infinity in its direction from
        the centre, which is the source's approximation. Curves are found by halving edges and are
        right for the position of the light, also on the ends. Default: curves for bands, rulings
        for laminae.

    Returns
    -------
    Bands or Laminae
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

    The source's laminae for ``0 <= i < N`` begin with a lamina without area and never close the
    far side; here they are the chords through both rulings of each contour, on both sides.

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
    segments = axial.options(segments, form, get_args(Form)) or axial.FEWEST
    if method is None:
        method = "curves" if position is not None and form == "bands" else "rulings"
    _check.choice("method", method, get_args(Method))
    if method == "curves" and form == "laminae":
        remedy = "use form='bands' or method='rulings'"
        raise ValueError(_check.message("method", "'rulings' with laminae", "'curves'", remedy))
    spacing.check(levels)
    # A near lamp has another direction at each point: no ruling has one luminance any more.
    if method == "curves":
        return refinement.draw(
            triangle_mesh.mesh(solid, segments), shade(light, solid.center), levels, low=light.low
        )
    # A near light fades with its distance from the centre.
    # The source's approximation: one direction and one fading for the whole solid.
    near = dataclasses.replace(light, attenuation=(1.0, 0.0, 0.0))
    if math.isfinite(light.distance):
        fading = light.luminance(np.array(1.0), light.distance) - light.low
        near = dataclasses.replace(near, scale=float(fading), distance=math.inf)
    side = _Rulings(near, solid)
    steps = side.steps(levels)
    if form == "laminae":
        return _laminae(side, steps, segments)
    return _bands(side, steps, segments)


def shade(light: axial.Source, center: Array) -> Luminance:
    """Return the function of points and normals that gives the luminance under one light."""

    def luminance(points: Array, normals: Array) -> Array:
        if math.isinf(light.distance):
            return light.luminance(normals @ light.toward)
        toward = light.toward * light.distance - (points - center)
        size = kernels.length(np.ascontiguousarray(toward.T))
        cosine = np.einsum("ij,ij->i", toward, normals) / np.where(size > 0, size, 1)
        return light.luminance(cosine, size)

    return luminance


class _Rulings:
    """Luminance of the side of a frustum as a function of the angle around its axis."""

    def __init__(self, light: axial.Source, solid: primitives.Frustum) -> None:
        self.light, self.solid = light, solid
        self.first, self.second = axial.frame(solid.axis, light.toward)
        slope = solid.radii[1] - solid.radii[0]
        size = math.hypot(solid.height, slope) or 1.0
        # A side without area (equal radii, height 0) has normals perpendicular to the axis.
        # The side's normal: across the axis by the height, along it by the difference of the
        # radii.
        across, along = (solid.height / size, slope / size) if slope or solid.height else (1.0, 0.0)
        self.a = across * max(float(self.first @ light.toward), 0.0)
        self.b = along * float(solid.axis @ light.toward)

    def cosine(self, angle: ArrayLike) -> Array:
        """Return N . L at angles from the light."""
        # Half angles avoid cancellation at small angles.
        return np.asarray((self.a + self.b) - 2 * self.a * np.sin(np.asarray(angle) / 2) ** 2)

    def luminance(self, angle: ArrayLike) -> Array:
        """Return the luminance at angles from the light."""
        return self.light.luminance(self.cosine(angle))

    def steps(self, wanted: Levels) -> Steps:
        """Return the steps of the side."""
        ends = self.luminance(np.array([0.0, np.pi]))
        return spacing.steps(wanted, float(ends.min()), float(ends.max()), exact=True)

    def contours(self, steps: Steps) -> Array:
        """Return the angle of each contour, in [0, pi]; the lowest level is the terminator."""
        return axial.reached(self.luminance, steps.edges[:-1], np.pi)

    def end(self, first: bool) -> float:
        """Return the luminance of an end."""
        cosine = self.solid.axis @ self.light.toward * (1 if first else -1)
        return float(self.light.luminance(np.array(cosine)))

    def place(self, angle: Array, first: bool) -> Array:
        """Return points on the circle of an end."""
        radius = self.solid.radii[0 if first else 1]
        half = (0.5 if first else -0.5) * self.solid.height * self.solid.axis
        # The circle in the frame whose first axis is the light's part across the axis.
        ring = (
            np.cos(angle)[:, np.newaxis] * self.first + np.sin(angle)[:, np.newaxis] * self.second
        )
        return np.asarray(self.solid.center + half + radius * ring)


def _around(side: _Rulings, steps: Steps, segments: int) -> tuple[Array, Indices]:
    """Return the angles of all rulings around the axis, and the contour of each, or -1."""
    # Each contour is a pair of rulings, at plus and minus its angle from the light.
    places = side.contours(steps) if len(steps.edges) > 1 else np.empty(0)
    inside = (places > 0) & (places < np.pi)
    contour = np.concatenate([np.flatnonzero(inside), [-1, -1]])
    half = np.concatenate([places[inside], [0.0, np.pi]])
    order = np.argsort(half, kind="stable")
    half, contour = half[order], contour[order]
    # Additional rulings between distant contours keep the side round.
    pieces = np.maximum(np.ceil(np.diff(half) * segments / (2 * np.pi) - 1e-9), 1).astype(int)
    angle = np.repeat(half[:-1], pieces)
    step = np.arange(len(angle)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    angle = angle + step * np.repeat(np.diff(half) / pieces, pieces)
    contour = np.where(step == 0, np.repeat(contour[:-1], pieces), -1)
    # The angles run from the light to the far side and, mirrored, back.
    full = np.concatenate([angle, [np.pi], 2 * np.pi - angle[:0:-1]])
    return full, np.concatenate([contour, [-1], contour[:0:-1]])


def _bands(side: _Rulings, steps: Steps, segments: int) -> Bands:
    """Return the closed surface: strips between rulings, and one polygon per end."""
    angle, contour = _around(side, steps, segments)
    (first, second), height, count = side.solid.radii, side.solid.height, len(angle)
    # An apex is one point that all strips share.
    top = np.arange(count) if first > 0 else np.zeros(count, int)
    shared = top.max() + 1
    bottom = shared + (np.arange(count) if second > 0 else np.zeros(count, int))
    upper = side.place(angle[:shared], first=True)
    points = np.concatenate([upper, side.place(angle[: bottom.max() + 1 - shared], first=False)])
    if height == 0 and first == second:
        # Two discs back to back share one rim.
        points, bottom = upper, top
    cells: list[Indices] = []
    parts: list[tuple[int, int, float]] = []
    on = np.empty(0, int)
    if max(first, second) > 0 and (height > 0 or first != second):
        quads = np.stack([top, bottom, np.roll(bottom, -1), np.roll(top, -1)], axis=1)
        # At an apex quadrilaterals become triangles.
        cells += list(quads[:, [0, 1, 2] if first == 0 else [0, 1, 3] if second == 0 else slice(4)])
        # No contour lies within a strip, so the band at its middle is the strip's.
        band = steps.band(side.luminance((angle + np.append(angle[1:], 2 * np.pi)) / 2))
        parts += [(0, int(k), float(steps.values[k])) for k in band]
        on = np.flatnonzero(contour >= 0)
    for patch, radius, ring in ((1, first, top), (2, second, bottom[::-1])):
        if radius > 0:
            value = side.end(first=patch == 1)
            cells.append(ring)
            parts.append((patch, int(steps.band(np.array(value))), value))
    return Bands(
        points=points if cells else np.empty((0, 3)),
        offsets=np.concatenate([[0], np.cumsum([len(cell) for cell in cells])]).astype(np.intp),
        corners=np.concatenate([*cells, np.empty(0, int)]).astype(np.intp),
        band=np.array([k for _, k, _ in parts], dtype=np.intp),
        values=np.array([value for _, _, value in parts], dtype=np.float64),
        patch=np.array([patch for patch, _, _ in parts], dtype=np.intp),
        lines=np.stack([top[on], bottom[on]], axis=1).astype(np.intp),
        line_levels=steps.edges[contour[on]],
        steps=steps,
        error=steps.error,
    )


def _laminae(side: _Rulings, steps: Steps, segments: int) -> Laminae:
    """Return the chords through both rulings of each contour, and the two ends."""
    places = side.contours(steps) if len(steps.edges) > 1 else np.empty(0)
    inside = (places > 0) & (places < np.pi)
    lit = places[inside]
    values = steps.values[1:][inside] if len(lit) else np.empty(0)
    # Beyond the last contour the side has one value, with as many segments as on a circle.
    start = lit.max(initial=0.0)
    count = max(math.ceil((np.pi - start) * segments / (2 * np.pi)), 2)
    beyond = np.linspace(start, np.pi, count + 1)[:-1]
    # Just beyond the last contour, in the band after it.
    beyond[0] += 1e-9
    angle = np.concatenate([lit, beyond])
    values = np.concatenate([values, np.full(len(beyond), float(side.luminance(np.pi)))])
    quads = np.stack(
        [side.place(-angle, first=True), side.place(angle, first=True),
         side.place(angle, first=False), side.place(-angle, first=False)], axis=1,
    )  # fmt: skip
    if not (side.solid.height > 0 and max(side.solid.radii) > 0):
        quads, values = quads[:0], values[:0]
    pieces, sizes = [quads.reshape(-1, 3)], [4] * len(quads)
    ring = 2 * np.pi * np.arange(segments) / segments
    for first in (True, False):
        if side.solid.radii[0 if first else 1] > 0:
            pieces.append(side.place(ring, first=first))
            sizes.append(segments)
            values = np.append(values, side.end(first=first))
    return Laminae(
        points=np.concatenate(pieces),
        offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp),
        values=values,
    )
