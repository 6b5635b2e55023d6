"""Samples of curves that grow, found by distance."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

from vizlight.geometry.lines.simplices import Places

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.lines.tracing import Walkers

#: Samples of curves per spacing.
SAMPLES = 4
#: Cosine above which lines of a cross field are of one family.
PARALLEL = 0.7
#: Number of samples that are looked at in addition in a cross field, for curves that cross.
CROSSING = 24
#: Number of samples in the small tree, which is made again at every step.
RECENT = 1500


def parallel(a: Array, b: Array) -> Bools:
    """Return whether unit directions, shape (..., 3), are of one family of a cross field."""
    return np.asarray(np.abs(np.einsum("...i,...i->...", a, b)) > PARALLEL)


class Samples:
    """Samples of the curves, found by distance."""

    def __init__(self) -> None:
        self.points: Array = np.empty((0, 3))
        self.along: Array = np.empty((0, 3))
        self.sign: Array = np.empty(0)
        self.length: Array = np.empty(0)
        self.curve: Indices = np.empty(0, dtype=np.intp)
        self.number: Indices = np.empty(0, dtype=np.intp)
        self._cell: Indices = np.empty(0, dtype=np.intp)
        self._weights: Array = np.empty((0, 3))
        self._embedded: Array = np.empty((0, 3))
        self._used: Bools = np.empty(0, dtype=np.bool_)
        self._size = 0
        # Most samples are in a tree that is seldom made again, the rest in one that often is.
        self._old: scipy.spatial.cKDTree | None = None
        self._new: scipy.spatial.cKDTree | None = None
        self._rows: Indices = np.empty(0, dtype=np.intp)
        self._recent = self._rows
        self._whole, self._seen, self._stale = 0, 0, 0

    def add(self, walkers: Walkers, points: Array, embedded: Array) -> None:
        """Add where ends are now."""
        count, size = len(points), self._size
        if not count:
            return
        if size + count > len(self.curve):
            columns = embedded.shape[1], walkers.places.weights.shape[1]
            self._grow(max(4096, 2 * (size + count)), *columns)
        rows = slice(size, size + count)
        self.points[rows], self._embedded[rows] = points, embedded
        self.curve[rows], self.sign[rows] = walkers.curve, walkers.sign
        self.along[rows] = walkers.along
        self.length[rows], self.number[rows] = walkers.length, walkers.number
        self._cell[rows], self._weights[rows] = walkers.places.cell, walkers.places.weights
        self._used[rows] = True
        self._size += count

    def _grow(self, room: int, dimension: int, corners: int) -> None:
        """Make room for more samples."""

        def larger(array: Array, *columns: int) -> Array:
            made = np.zeros((room, *columns))
            if self._size:
                made[: self._size] = array[: self._size]
            return made

        def longer(numbers: Indices) -> Indices:
            return np.resize(numbers, room) if len(numbers) else np.zeros(room, dtype=np.intp)

        self.points, self.along = larger(self.points, 3), larger(self.along, 3)
        self._embedded = larger(self._embedded, dimension)
        self._weights = larger(self._weights, corners)
        self.sign, self.length = larger(self.sign), larger(self.length)
        self.curve, self.number = longer(self.curve), longer(self.number)
        self._cell = longer(self._cell)
        used = np.zeros(room, dtype=np.bool_)
        used[: self._size] = self._used[: self._size]
        self._used = used

    def drop(self, curve: int) -> None:
        """Forget the samples of a curve."""
        rows = np.flatnonzero(self.curve[: self._size] == curve)
        self._used[rows] = False
        self._seen = -1
        self._stale += int(np.count_nonzero(rows < self._whole))

    def of(self, curve: int) -> tuple[Places, Array]:
        """Return the places of a curve's samples, and its directions there."""
        rows = np.flatnonzero(self.curve[: self._size] == curve)[:: SAMPLES // 2]
        return Places(self._cell[rows], self._weights[rows]), self.along[rows]

    def near(
        self, embedded: Array, radius: float, count: int, along: Array | None = None
    ) -> tuple[Array, Indices]:
        """Return distances and rows of samples within a radius, shape (N, K); infinity for none.

        With directions ``along`` samples of curves that cross them do not count.
        """
        if along is not None:
            # Curves of the other family, which are not counted, can be nearer.
            count += CROSSING
        if self._size - self._whole > RECENT or self._stale > RECENT:
            self._rows = np.flatnonzero(self._used[: self._size])
            self._old = scipy.spatial.cKDTree(self._embedded[self._rows], balanced_tree=False)
            self._whole, self._seen, self._stale = self._size, -1, 0
            self._recent, self._new = self._rows[:0], None
        if self._seen != self._size:
            self._recent = self._whole + np.flatnonzero(self._used[self._whole : self._size])
            self._new = scipy.spatial.cKDTree(self._embedded[self._recent], balanced_tree=False)
            self._seen = self._size
        distances: list[Array] = []
        numbers: list[Indices] = []
        for tree, rows in ((self._old, self._rows), (self._new, self._recent)):
            if tree is None or not len(rows):
                continue
            found = tree.query(embedded, k=count, distance_upper_bound=radius)
            distance = np.asarray(found[0]).reshape(-1, count)
            row = rows[np.minimum(np.asarray(found[1]).reshape(-1, count), len(rows) - 1)]
            counted = self._used[row]
            if along is not None:
                counted &= parallel(self.along[row], along[:, np.newaxis])
            distances.append(np.where(counted, distance, np.inf))
            numbers.append(row)
        if not distances:
            empty = np.zeros((len(embedded), 1))
            return empty + np.inf, empty.astype(np.intp)
        return np.concatenate(distances, axis=1), np.concatenate(numbers, axis=1)
