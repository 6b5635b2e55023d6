"""Laminae: contours as plane polygons that are painted over one another, the farthest first.

Source: Isoluminance, Representing a Sphere and a Generalised Truncus. The laminae of a truncus for
``0 <= i < N`` begin there with one without area and never close the far side; here they are the
chords through both rulings of each contour, on both sides.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight.geometry import axial
from vizlight.geometry.contours import isoluminance, spacing
from vizlight.geometry.solids.primitives import Frustum, Sphere

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices

#: Options of the light that the closed forms take.
LIGHT = {
    "direction": None, "position": None, "ambient": 0.0, "diffuse": 1.0, "power": 1.0,
    "attenuation": (1.0, 0.0, 0.0),
}  # fmt: skip


@dataclass(frozen=True)
class Laminae:
    """Plane polygons that are painted over one another, the farthest first.

    Attributes
    ----------
    points : ndarray of float64, shape (P, 3)
        Positions.
    offsets : ndarray of int, shape (C + 1,)
        Start of each lamina in ``points``: lamina i has the points ``offsets[i]`` to
        ``offsets[i + 1]``, in cyclic order.
    values : ndarray of float64, shape (C,)
        Luminance of each lamina.
    """

    points: Array
    offsets: Indices
    values: Array

    def order(self, toward: ArrayLike) -> Indices:
        """Return the painter's order for a view: the farthest lamina first.

        Parameters
        ----------
        toward : array_like, shape (3,)
            Direction toward the eye of a parallel view.

        Returns
        -------
        ndarray of int, shape (C,)
            Indices of laminae, sorted by the depth of their centres. If the view direction lies
            in the planes of the laminae, each is seen as a line and no order is right: use bands.

        Raises
        ------
        TypeError, ValueError
            If the direction is not one finite vector of 3 components that is not 0.
        """
        size = np.diff(self.offsets)
        lamina = np.repeat(np.arange(len(size)), size)
        depth = self.points @ _check.unit("toward", toward)
        return np.argsort(np.bincount(lamina, depth, len(size)) / np.maximum(size, 1))


def sphere(center, radius, /, *, levels=16, segments=None, **light):
    """Return the contours of a sphere as filled circles."""
    solid = Sphere(center, radius)
    source = axial.source(solid.center, **(LIGHT | light))
    latitudes = isoluminance.Latitudes(source, solid)
    steps = spacing.steps(levels, source.low, float(latitudes.luminance(0.0)))
    places = axial.reached(latitudes.luminance, steps.edges[:-1], latitudes.dark)
    count, _ = isoluminance.roundness(latitudes, steps, places, levels, segments)
    return _circles(latitudes, steps, places, count)


def _circles(latitudes, steps, places, count):
    """Return filled circles of the lit side, and their mirror images for the unlit side."""
    inside = places > 0
    lit = places[inside]
    # The unlit side begins with a circle just behind the widest lit one, which it hides when seen
    # from behind; its other circles are as far apart as on the lit side.
    beyond = np.concatenate([[max(latitudes.dark, 0.5) + 1e-9], 1 - lit[lit < 0.5]])
    q = np.concatenate([lit, beyond])
    values = np.concatenate([steps.values[1:][inside], np.full(len(beyond), steps.edges[0])])
    if latitudes.solid.empty:
        q, values = q[:0], values[:0]
    return Laminae(
        points=latitudes.circles(q, count),
        offsets=np.arange(len(q) + 1) * count,
        values=values,
    )


def truncus(center, axis, radii, /, *, height=None, levels=16, segments=axial.FEWEST, **light):
    """Return the contours of a frustum in the light of a direction as quadrilaterals and ends."""
    solid = Frustum(center, axis, radii, height=height)
    side = isoluminance.Rulings(axial.source(solid.center, **(LIGHT | light)), solid)
    ends = side.luminance(np.array([0.0, np.pi]))
    steps = spacing.steps(levels, float(ends.min()), float(ends.max()), exact=True)
    places = axial.reached(side.luminance, steps.edges[:-1], np.pi)
    return _chords(side, steps, places, segments)


def _chords(side, steps, places, segments):
    """Return the chords through both rulings of each contour, and the two ends."""
    inside = (places > 0) & (places < np.pi)
    lit = places[inside]
    # Beyond the last contour the side has one value, with as many segments as on a circle.
    start = lit.max(initial=0.0)
    count = max(math.ceil((np.pi - start) * segments / (2 * np.pi)), 2)
    beyond = np.linspace(start, np.pi, count + 1)[:-1]
    # Just beyond the last contour, in the band after it.
    beyond[0] += 1e-9
    angle = np.concatenate([lit, beyond])
    far = np.full(len(beyond), float(side.luminance(np.pi)))
    values = np.concatenate([steps.values[1:][inside], far])
    quads = np.stack(
        # Both rulings of a contour are at plus and minus its angle from the light.
        [side.place(-angle, first=True), side.place(angle, first=True),
         side.place(angle, first=False), side.place(-angle, first=False)], axis=1,
    )  # fmt: skip
    if side.solid.empty:
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
