"""A triangle mesh lit with the normals of its points, interpolated over each triangle."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.geometry import _bands, _contours

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vizlight.geometry._bands import Bands
    from vizlight.geometry._levels import Steps

    Array = NDArray[np.floating[Any]]
    Index = NDArray[np.intp]
    Bools = NDArray[np.bool_]
    Luminance = Callable[[Array, Array], Array]


class Facets:
    """Triangles for :func:`vizlight.geometry._contours.refine`.

    Parameters
    ----------
    points : ndarray, shape (P, 6)
        Positions, and unit normals beside them: what is linear along an edge.
    triangles : ndarray of int, shape (T, 3)
    luminance : callable
        ``luminance(points, normals)``; the normals need not be unit vectors.
    lit : ndarray of bool, shape (P,)
        Points that could be lit: the light of others jumps, and is not refined.
    """

    def __init__(self, points: Array, triangles: Index, luminance: Luminance, lit: Bools) -> None:
        self.points, self.triangles, self.lit = points, triangles, lit
        self._light = luminance

    def light(self, points: Array) -> Array:
        """Return the luminance of some of its points."""
        return np.asarray(self._light(points[:, :3], points[:, 3:]), dtype=np.float64)

    def corners(self) -> Array:
        """Return the luminance at the corners of all triangles."""
        used, place = np.unique(self.triangles, return_inverse=True)
        return np.asarray(self.light(self.points[used])[place.reshape(-1, 3)])

    def cut(self, values: Array, steps: Steps, halvings: int) -> tuple[Bands, Index]:
        """Return the bands, and the triangle that each polygon was cut from."""

        def along(a: Index, b: Index, share: Array, _: Index) -> Array:
            t = share[:, np.newaxis]
            return self.light(self.points[a] * (1 - t) + self.points[b] * t)

        return _bands.cut(
            self.points, self.triangles, values, steps, luminance=along, halvings=halvings
        )

    def measure(self, bands: Bands, triangle: Index) -> Array:
        """Return the largest error of each polygon at its middle and along its edges."""
        worst = np.zeros(len(bands.values))
        for places, of in _contours.within(bands):
            miss = np.abs(self.light(places) - bands.values[of])
            worst = np.maximum(worst, _contours.largest(bands, miss))
        worst[_contours.slivers(bands, triangle, len(self.triangles))] = 0
        worst[~np.all(self.lit[self.triangles], axis=1)[triangle]] = 0
        return worst

    def peaks(self, values: Array, bound: float) -> Index:
        """Return triangles in which the luminance rises above that of all corners by more."""
        if len(self.triangles) > _contours.ASKED:
            return np.empty(0, np.intp)
        top = values.max(axis=1) + bound
        found = np.zeros(len(self.triangles), np.bool_)
        for row in _contours.grid():
            found |= self.light(np.einsum("i,tij->tj", row, self.points[self.triangles])) > top
        return np.flatnonzero(found & np.all(self.lit[self.triangles], axis=1))

    def split(self, chosen: Index) -> None:
        """Halve the edges of some triangles; their neighbours are cut to fit."""
        start, stop = self.triangles, np.roll(self.triangles, -1, axis=1)
        count = len(self.points)
        codes = np.minimum(start, stop) * count + np.maximum(start, stop)
        marked = np.unique(codes[chosen])
        a, b = np.divmod(marked, count)
        place = np.minimum(np.searchsorted(marked, codes), len(marked) - 1)
        number = np.where(marked[place] == codes, count + place, -1)
        self.triangles, _ = _contours.split(self.triangles, number)
        self.points = np.concatenate([self.points, self.points[a] / 2 + self.points[b] / 2])
        self.lit = np.concatenate([self.lit, self.lit[a] & self.lit[b]])
