"""Triangle meshes lit with point normals that are interpolated over each triangle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.contours import banding, refinement
from vizlight.geometry.solids import triangle_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.contours.banding import Bands
    from vizlight.geometry.contours.spacing import Steps

    Luminance = Callable[[Array, Array], Array]


class Facets:
    """Lit triangles for :func:`vizlight.geometry.contours.refinement.refine`.

    Parameters
    ----------
    points : ndarray, shape (P, 6) or (P, more)
        Positions, unit normals and other values, all interpolated linearly along edges.
    triangles : ndarray of int, shape (T, 3)
        Indices of corners.
    luminance : callable
        Function ``luminance(points, normals)``, which accepts normals of any length.
    lit : ndarray of bool, shape (P,)
        Mask of the points that could be lit. The luminance of other points is discontinuous, and
        their triangles are not refined.
    """

    def __init__(self, points: Array, triangles: Indices, luminance: Luminance, lit: Bools) -> None:
        self.points, self.triangles, self.lit = points, triangles, lit
        self._light = luminance

    def light(self, points: Array) -> Array:
        """Return the luminance of rows of positions and normals."""
        return np.asarray(self._light(points[:, :3], points[:, 3:6]), dtype=np.float64)

    def corners(self) -> Array:
        """Return the luminance at the corners of all triangles."""
        used, place = np.unique(self.triangles, return_inverse=True)
        return np.asarray(self.light(self.points[used])[place.reshape(-1, 3)])

    def cut(self, values: Array, steps: Steps, halvings: int) -> tuple[Bands, Indices]:
        """Return the bands, and the triangle that each polygon was cut from."""

        def along(a: Indices, b: Indices, share: Array, _: Indices) -> Array:
            t = share[:, np.newaxis]
            return self.light(self.points[a] * (1 - t) + self.points[b] * t)

        return banding.cut(
            self.points, self.triangles, values, steps, luminance=along, halvings=halvings
        )

    def measure(self, bands: Bands, triangle: Indices) -> Array:
        """Return the largest error of each polygon at its centre and along its edges."""
        worst = np.zeros(len(bands.values))
        for places, of in refinement.within(bands):
            miss = np.abs(self.light(places) - bands.values[of])
            worst = np.maximum(worst, refinement.largest(bands, miss))
        worst[refinement.slivers(bands, triangle, len(self.triangles))] = 0
        worst[~np.all(self.lit[self.triangles], axis=1)[triangle]] = 0
        return worst

    def peaks(self, values: Array, bound: float) -> Indices:
        """Return the triangles whose luminance exceeds that of their corners by over ``bound``."""
        if len(self.triangles) > refinement.ASKED:
            return np.empty(0, np.intp)
        top = values.max(axis=1) + bound
        found = np.zeros(len(self.triangles), np.bool_)
        for row in refinement.grid():
            found |= self.light(np.einsum("i,tij->tj", row, self.points[self.triangles])) > top
        return np.flatnonzero(found & np.all(self.lit[self.triangles], axis=1))

    def split(self, chosen: Indices) -> None:
        """Halve the edges of chosen triangles, and split their neighbours to match."""
        start, stop = self.triangles, np.roll(self.triangles, -1, axis=1)
        count = len(self.points)
        codes = np.minimum(start, stop) * count + np.maximum(start, stop)
        marked = np.unique(codes[chosen])
        a, b = np.divmod(marked, count)
        place = np.minimum(np.searchsorted(marked, codes), len(marked) - 1)
        number = np.where(marked[place] == codes, count + place, -1)
        self.triangles, _ = triangle_mesh.split(self.triangles, number)
        self.points = np.concatenate([self.points, self.points[a] / 2 + self.points[b] / 2])
        self.lit = np.concatenate([self.lit, self.lit[a] & self.lit[b]])
