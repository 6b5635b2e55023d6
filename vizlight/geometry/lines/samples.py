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
        self.points = self.along = self.weights = self.embedded = np.empty((0, 3))
        self.sign = self.length = np.empty(0)
        self.curve = self.number = self.cell = np.empty(0, dtype=np.intp)
        self.used = np.empty(0, dtype=np.bool_)
        self._size = 0
        # Most samples are in a tree that is seldom made again, the rest in one that often is.
        self._old: scipy.spatial.cKDTree | None = None
        self._new: scipy.spatial.cKDTree | None = None
        self._rows: Indices = np.empty(0, dtype=np.intp)
        self._recent = self._rows
        self._whole, self._seen, self._stale = 0, 0, 0

    def add(self, walkers: Walkers, points: Array, embedded: Array) -> None:
        """Add where ends are now."""
        size, total = self._size, self._size + len(points)
        new = vars(walkers) | vars(walkers.places)
        new |= {"points": points, "embedded": embedded, "used": np.ones(len(points), np.bool_)}
        del new["places"]
        for name, rows in new.items():
            known = getattr(self, name)
            if not size or total > len(known):
                # Capacity doubles, so that adding is cheap on the whole.
                known = np.zeros((max(4096, 2 * total), *rows.shape[1:]), rows.dtype)
                if size:
                    known[:size] = getattr(self, name)[:size]
                setattr(self, name, known)
            known[size:total] = rows
        self._size = total

    def drop(self, curve: int) -> None:
        """Forget the samples of a curve."""
        rows = np.flatnonzero(self.curve[: self._size] == curve)
        self.used[rows] = False
        self._seen = -1
        self._stale += int(np.count_nonzero(rows < self._whole))

    def of(self, curve: int) -> tuple[Places, Array]:
        """Return the places of a curve's samples, and its directions there."""
        rows = np.flatnonzero(self.curve[: self._size] == curve)[:: SAMPLES // 2]
        return Places(self.cell[rows], self.weights[rows]), self.along[rows]

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
            self._rows = np.flatnonzero(self.used[: self._size])
            # A balanced tree would cost more to make than its queries save.
            self._old = scipy.spatial.cKDTree(self.embedded[self._rows], balanced_tree=False)
            self._whole, self._seen, self._stale = self._size, -1, 0
            self._recent, self._new = self._rows[:0], None
        if self._seen != self._size:
            self._recent = self._whole + np.flatnonzero(self.used[self._whole : self._size])
            self._new = scipy.spatial.cKDTree(self.embedded[self._recent], balanced_tree=False)
            self._seen = self._size
        distances: list[Array] = []
        numbers: list[Indices] = []
        for tree, rows in ((self._old, self._rows), (self._new, self._recent)):
            if tree is None or not len(rows):
                continue
            found = tree.query(embedded, k=count, distance_upper_bound=radius)
            distance = np.asarray(found[0]).reshape(-1, count)
            row = rows[np.minimum(np.asarray(found[1]).reshape(-1, count), len(rows) - 1)]
            counted = self.used[row]
            if along is not None:
                counted &= parallel(self.along[row], along[:, np.newaxis])
            distances.append(np.where(counted, distance, np.inf))
            numbers.append(row)
        if not distances:
            empty = np.zeros((len(embedded), 1))
            return empty + np.inf, empty.astype(np.intp)
        return np.concatenate(distances, axis=1), np.concatenate(numbers, axis=1)
