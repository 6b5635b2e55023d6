"""Triangle meshes lit with point normals that are interpolated over each triangle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.contours import banding, refinement
from vizlight.geometry.solids import triangle_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.contours.banding import Bands, Crossings
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
    placed : bool, default: True
        Whether the luminance depends on the positions.
    """

    def __init__(
        self, points: Array, triangles: Indices, luminance: Luminance, lit: Bools,
        placed: bool = True,
    ) -> None:  # fmt: skip
        self.points, self.triangles, self.lit = points, triangles, lit
        self._light = luminance
        self._first = 0 if placed else 3
        used = np.zeros(len(points), np.bool_)
        used[triangles] = True
        found = self.light(points[used])
        self._values = np.full(len(points), found.min(initial=np.inf))
        self._values[used] = found

    def light(self, points: Array) -> Array:
        """Return the luminance of rows of points."""
        return self._lit(points[:, self._first : 6])

    def _lit(self, rows: Array) -> Array:
        """Return the luminance of rows of positions and normals, or of normals alone."""
        normals = rows[:, -3:]
        places = np.broadcast_to(0.0, normals.shape) if self._first else rows[:, :3]
        return np.asarray(self._light(places, normals), dtype=np.float64)

    def corners(self) -> Array:
        """Return the luminance at the points."""
        return self._values

    def cut(
        self, values: Array, steps: Steps, known: Crossings, rows: Indices | None
    ) -> tuple[Bands, Indices]:
        """Return the bands, and the triangle that each polygon was cut from."""
        rows_of = self.points[:, self._first : 6]

        def along(a: Indices, b: Indices, share: Array, _: Indices) -> Array:
            start = rows_of[a]
            places = refinement.along(start, rows_of[b] - start, share)
            return self._lit(places).reshape(share.shape)

        if rows is None:
            return banding.cut(
                self.points, self.triangles, values, steps, luminance=along, known=known
            )
        made, triangle = banding.cut(
            self.points, self.triangles[rows], values, steps, luminance=along, known=known
        )
        return made, rows[triangle]

    def measure(self, bands: Bands, triangle: Indices, allowed: float) -> Array:
        """Return the largest error of each polygon at its centre and along its edges."""
        worst = refinement.measured(
            bands, triangle, lambda places, _: self._lit(places), allowed, slice(self._first, 6)
        )
        worst[~np.all(self.lit[self.triangles], axis=1)[triangle]] = 0
        return worst

    def peaks(self, rows: Indices) -> Array:
        """Return the highest luminance found at a grid of points inside some triangles."""
        places = refinement.searched(self.points[self.triangles[rows]])
        found = self.light(places.reshape(-1, places.shape[-1])).reshape(len(rows), -1)
        lit = np.all(self.lit[self.triangles[rows]], axis=1)
        return np.where(lit, found.max(axis=1), -np.inf)

    def split(self, chosen: Indices) -> Indices:
        """Halve the edges of chosen triangles, and split their neighbours to match."""
        start, stop = self.triangles, np.roll(self.triangles, -1, axis=1)
        count = len(self.points)
        codes = np.minimum(start, stop) * count + np.maximum(start, stop)
        marked = np.unique(codes[chosen])
        a, b = np.divmod(marked, count)
        place = np.minimum(np.searchsorted(marked, codes), len(marked) - 1)
        number = np.where(marked[place] == codes, count + place, -1)
        self.triangles, owner = triangle_mesh.split(self.triangles, number)
        new = self.points[a] / 2 + self.points[b] / 2
        self.points = np.concatenate([self.points, new])
        self._values = np.concatenate([self._values, self.light(new)])
        self.lit = np.concatenate([self.lit, self.lit[a] & self.lit[b]])
        return owner[: np.count_nonzero(np.all(number < 0, axis=1))]
