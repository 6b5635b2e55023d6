"""Isoluminance contours of a generalised truncus: cone, frustum, cylinder, disc or rod."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from vizlight import _check
from vizlight.geometry.contours import axial, refinement, spacing
from vizlight.geometry.contours.banding import Bands, Laminae
from vizlight.geometry.solids import primitives, triangle_mesh
from vizlight.model import kernels

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.geometry.contours.spacing import Levels, Steps

Form = Literal["bands", "laminae"]
Method = Literal["rulings", "curves"]


def truncus(
    center: Any,
    axis: Any,
    radii: tuple[float, float],
    /,
    *,
    height: float | None = None,
    direction: Any = None,
    position: Any = None,
    ambient: float = 0.0,
    diffuse: float = 1.0,
    power: float = 1.0,
    attenuation: Any = (1.0, 0.0, 0.0),
    levels: Levels = 16,
    segments: int | None = None,
    form: Form = "bands",
    method: Method | None = None,
) -> Any:
    """Return the isoluminance contours of a truncus: its rulings, and its two ends.

    Parameters
    ----------
    center : vector of 3 components
        The middle of the axis.
    axis : vector of 3 components
        From the second end to the first; its length is the height unless that is given.
    radii : (float, float)
        R1 at the end ``center + axis / 2`` and R2 at the other, 0 or more: one of them 0 is a
        cone, equal ones a cylinder, disc or rod.
    height : float, optional
        0 or more. At height 0 the side is a flat ring, of no area where the radii are equal.
    direction, position, ambient, diffuse, power, attenuation
        Of the light, as for :func:`sphere`.
    levels : int, float or sequence of float, default: 16
        As for :func:`sphere`; the steps are those of the side. Each end has the one value that
        it has under a light at infinity, exactly.
    segments : int, optional
        Fewest points of an end's circle, 3 or more; default 36.
    form : {"bands", "laminae"}
        Bands are a closed surface; laminae are quadrilaterals and the two ends, for
        :meth:`Laminae.order`.
    method : {"rulings", "curves"}, optional
        Of a near light. Rulings take it as a light at infinity seen from the centre, the
        source's approximation. Curves (the default; for bands) are found by halving edges and
        are right for the light where it stands, on the ends too.

    Returns
    -------
    Bands or Laminae
        Patches 0, 1 and 2 are the side, the first and the second end.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Notes
    -----
    ``N`` along ``H rho + (R2 - R1) a``, rho the unit vector across the unit axis a and H the
    height: the source's ``p14 - (c - h a)`` with ``h = (R2^2 - R1^2) / (2 H)`` divided by
    ``(R1 + R2) / (2 H)``, so that neither height 0 nor two radii of 0 divide by zero. With phi
    the angle from the light around the axis ``N . L = A cos(phi) + B``: each level has two
    rulings, exact for a light at infinity.
    The source's laminae for ``0 <= i < N`` begin with one of no area and never close the far
    side; here they are the chords through both rulings of each contour, on both sides.
    The luminance at a ruling misses its level by at most ``(8 + 4 power) eps`` of ``diffuse``,
    and by what rounding of long thin shapes turns the rulings: ``H / max(R1, R2) eps``. For
    powers below 1, infinitely steep at the terminator, ``((8 + H / max(R1, R2)) eps)^power``.
    Source: Isoluminance, Representing a Generalised Truncus, and appendix.
    """
    solid = primitives.Truncus(center, axis, radii, height=height)
    light = axial.source(
        solid.center, direction=direction, position=position, ambient=ambient, diffuse=diffuse,
        power=power, attenuation=attenuation,
    )  # fmt: skip
    segments = axial.options(segments, form, get_args(Form)) or axial.FEWEST
    if method is None:
        method = "curves" if position is not None and form == "bands" else "rulings"
    if method not in get_args(Method):
        raise ValueError(_check.message("method", "'rulings' or 'curves'", repr(method)))
    if method == "curves" and form == "laminae":
        remedy = "take bands, or method='rulings'"
        raise ValueError(_check.message("method", "'rulings' with laminae", "'curves'", remedy))
    spacing.check(levels)
    if method == "curves":
        return refinement.draw(
            triangle_mesh.mesh(solid, segments), shade(light, solid.center), levels, low=light.low
        )
    # The distance of a near light is that of the centre.
    near = dataclasses.replace(light, attenuation=(1.0, 0.0, 0.0))
    if math.isfinite(light.distance):
        fading = light.luminance(np.array(1.0), light.distance) - light.low
        near = dataclasses.replace(near, scale=float(fading), distance=math.inf)
    law = _Rulings(near, solid)
    steps = law.steps(levels)
    if form == "laminae":
        return _laminae(law, steps, segments)
    return _bands(law, steps, segments)


def shade(light: axial.Source, center: Array) -> Any:
    """Return the luminance of points with normals under one light where it stands."""

    def luminance(points: Array, normals: Array) -> Array:
        if math.isinf(light.distance):
            return light.luminance(normals @ light.toward)
        toward = light.toward * light.distance - (points - center)
        size = kernels.length(np.ascontiguousarray(toward.T))
        cosine = np.einsum("ij,ij->i", toward, normals) / np.where(size > 0, size, 1)
        return light.luminance(cosine, size)

    return luminance


class _Rulings:
    """The luminance of a truncus' side over the angle from the light around its axis."""

    def __init__(self, light: axial.Source, solid: primitives.Truncus) -> None:
        self.light, self.solid = light, solid
        self.first, self.second = axial.frame(solid.axis, light.toward)
        slope = solid.radii[1] - solid.radii[0]
        size = math.hypot(solid.height, slope) or 1.0
        # A side without area (equal radii, height 0) faces across its axis.
        across, along = (solid.height / size, slope / size) if slope or solid.height else (1.0, 0.0)
        self.a = across * max(float(self.first @ light.toward), 0.0)
        self.b = along * float(solid.axis @ light.toward)

    def cosine(self, angle: Any) -> Array:
        """Return N . L at angles from the light."""
        # With half angles, so that small ones lose nothing.
        return np.asarray((self.a + self.b) - 2 * self.a * np.sin(np.asarray(angle) / 2) ** 2)

    def luminance(self, angle: Any) -> Array:
        """Return the luminance at angles from the light."""
        return self.light.luminance(self.cosine(angle))

    def steps(self, wanted: Levels) -> Steps:
        """Return the steps of the side."""
        ends = self.luminance(np.array([0.0, np.pi]))
        return spacing.steps(wanted, float(ends.min()), float(ends.max()), exact=True)

    def contours(self, steps: Steps) -> Array:
        """Return the angle of each contour, in [0, pi]; the lowest is the terminator."""
        edges = steps.edges[:-1]
        low, high = np.zeros(len(edges)), np.full(len(edges), np.pi)
        for _ in range(1080 if len(edges) else 0):
            middle = (low + high) / 2
            if np.all((middle == low) | (middle == high)):
                break
            bright = self.luminance(middle) > edges
            low, high = np.where(bright, middle, low), np.where(bright, high, middle)
        return high

    def end(self, first: bool) -> float:
        """Return the luminance of an end."""
        cosine = self.solid.axis @ self.light.toward * (1 if first else -1)
        return float(self.light.luminance(np.array(cosine)))

    def place(self, angle: Array, first: bool) -> Array:
        """Return points of an end's circle."""
        radius = self.solid.radii[0 if first else 1]
        half = (0.5 if first else -0.5) * self.solid.height * self.solid.axis
        ring = (
            np.cos(angle)[:, np.newaxis] * self.first + np.sin(angle)[:, np.newaxis] * self.second
        )
        return np.asarray(self.solid.center + half + radius * ring)


def _bands(law: _Rulings, steps: Steps, segments: int) -> Bands:
    """Return the closed surface: strips between rulings, and the ends as one polygon each."""
    places = law.contours(steps) if len(steps.edges) > 1 else np.empty(0)
    inside = (places > 0) & (places < np.pi)
    contour = np.concatenate([np.flatnonzero(inside), [-1, -1]])
    half = np.concatenate([places[inside], [0.0, np.pi]])
    order = np.argsort(half, kind="stable")
    half, contour = half[order], contour[order]
    # Rulings between contours that are far apart keep the side round; they are no contours.
    pieces = np.maximum(np.ceil(np.diff(half) * segments / (2 * np.pi) - 1e-9), 1).astype(int)
    angle = np.repeat(half[:-1], pieces)
    step = np.arange(len(angle)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    angle = angle + step * np.repeat(np.diff(half) / pieces, pieces)
    contour = np.where(step == 0, np.repeat(contour[:-1], pieces), -1)
    # From the light to the far side and back: the mirror image has the same contours.
    full = np.concatenate([angle, [np.pi], 2 * np.pi - angle[:0:-1]])
    of_ruling = np.concatenate([contour, [-1], contour[:0:-1]])
    count = len(full)
    top = np.arange(count) if law.solid.radii[0] > 0 else np.zeros(count, int)
    shared = top.max() + 1
    bottom = shared + (np.arange(count) if law.solid.radii[1] > 0 else np.zeros(count, int))
    upper = law.place(full[:shared], first=True)
    lower = law.place(full[: bottom.max() + 1 - shared], first=False)
    points = np.concatenate([upper, lower])
    # No contour lies within a strip, so its middle tells its band.
    band = steps.band(law.luminance((full + np.append(full[1:], 2 * np.pi)) / 2))

    quads = np.stack([top, bottom, np.roll(bottom, -1), np.roll(top, -1)], axis=1)
    has_side = max(law.solid.radii) > 0 and (
        law.solid.height > 0 or law.solid.radii[0] != law.solid.radii[1]
    )
    if not has_side and law.solid.height == 0:
        # Two discs back to back have one rim.
        points, bottom = upper, top
    cells: list[Any] = []
    parts: list[tuple[int, int, float]] = []
    if has_side:
        if law.solid.radii[0] == 0:
            quads = quads[:, :3]
        elif law.solid.radii[1] == 0:
            quads = quads[:, [0, 1, 3]]
        cells += list(quads)
        parts += [(0, int(k), float(steps.values[k])) for k in band]
    for patch, radius, ring in (
        (1, law.solid.radii[0], top),
        (2, law.solid.radii[1], bottom[::-1]),
    ):
        if radius > 0:
            value = law.end(first=patch == 1)
            cells.append(ring)
            parts.append((patch, int(steps.band(np.array(value))), value))
    if not cells:
        points = np.empty((0, 3))
    on = np.flatnonzero(of_ruling >= 0) if has_side else np.empty(0, int)
    return Bands(
        points=points,
        offsets=np.concatenate([[0], np.cumsum([len(cell) for cell in cells])]).astype(np.intp),
        corners=np.concatenate([*cells, np.empty(0, int)]).astype(np.intp),
        band=np.array([k for _, k, _ in parts], dtype=np.intp),
        values=np.array([value for _, _, value in parts], dtype=np.float64),
        patch=np.array([patch for patch, _, _ in parts], dtype=np.intp),
        lines=np.stack([top[on], bottom[on]], axis=1).astype(np.intp),
        line_levels=steps.edges[of_ruling[on]],
        steps=steps,
        error=steps.error,
    )


def _laminae(law: _Rulings, steps: Steps, segments: int) -> Laminae:
    """Return the chords through both rulings of each contour, and the two ends."""
    places = law.contours(steps) if len(steps.edges) > 1 else np.empty(0)
    inside = (places > 0) & (places < np.pi)
    lit = places[inside]
    values = steps.values[1:][inside] if len(lit) else np.empty(0)
    # Beyond the last contour the side has one value; it is closed as finely as circles are.
    start = lit.max(initial=0.0)
    count = max(math.ceil((np.pi - start) * segments / (2 * np.pi)), 2)
    beyond = np.linspace(start, np.pi, count + 1)[:-1]
    beyond[0] += 1e-9
    angle = np.concatenate([lit, beyond])
    values = np.concatenate([values, np.full(len(beyond), float(law.luminance(np.pi)))])
    quads = np.stack(
        [law.place(-angle, first=True), law.place(angle, first=True),
         law.place(angle, first=False), law.place(-angle, first=False)], axis=1,
    )  # fmt: skip
    if not (law.solid.height > 0 and max(law.solid.radii) > 0):
        quads, values = quads[:0], values[:0]
    pieces, sizes = [quads.reshape(-1, 3)], [4] * len(quads)
    ring = 2 * np.pi * np.arange(segments) / segments
    for first in (True, False):
        if law.solid.radii[0 if first else 1] > 0:
            pieces.append(law.place(ring, first=first))
            sizes.append(segments)
            values = np.append(values, law.end(first=first))
    return Laminae(
        points=np.concatenate(pieces),
        offsets=np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp),
        values=values,
    )
