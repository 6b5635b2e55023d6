"""Strokes that a changing field carries: the last ways of particles that come and go."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.mesh import strokes
from vizlight.mesh.particles import Carrier, Rows
from vizlight.vtk.cells import connectivity

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array, Indices

#: Percentile of the speeds at which a stroke is as long as asked for.
FAST = 75
#: Least and largest number of strokes.
FEWEST, MOST = 20, 3000
#: Points of a stroke, length of its head in space as a share of it, and largest step in cell
#: lengths.
ROWS, HEAD, STEP = 16, 0.13, 1.0
#: Least and largest life of a particle, in the time that its stroke shows.
LIVES = 1.5, 4.0
#: Time for which the field runs before the first picture, in the same.
BEFORE = 1.25
#: Places in store for each particle, and places of which the emptiest is taken for a new one.
STORE, CANDIDATES = 40, 10
#: Point array of times at which the particle of a stroke was there.
WHEN = "vizlight when"


class Drift:
    """Strokes that move with vectors which change with time, spread evenly over a mesh.

    A stroke is the way of a particle in the time before: longer where the field is faster. It
    grows, moves, stops and shrinks; then its particle begins anew where strokes are farthest.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Flat sheet or volume, as for :class:`vizlight.mesh.particles.Carrier`.
    vectors : ndarray, shape (n_points, 3)
        Vectors before the first time.
    spacing, length : float
        Distance between neighbours and length of fast strokes, in the unit of the mesh.
    tangents : str
        Name of the vectors or of their components, for their unit.

    Attributes
    ----------
    duration : float
        Time that a stroke shows, in the unit of the times.
    """

    def __init__(
        self, mesh: pv.DataSet, vectors: Array, spacing: float, length: float, tangents: str = ""
    ) -> None:
        self._random = np.random.default_rng(0)
        self._carrier = Carrier(mesh, tangents)
        self._n_points, self._bounds = mesh.n_points, mesh.bounds
        # A particle passes few points within a head: in space it is longer than where strokes lie.
        tube = strokes.TUBE._replace(head=HEAD)
        self._arrow = tube if mesh.GetMaxSpatialDimension() == 3 else strokes.FLAT
        self._carrier.between(vectors, vectors)
        self._store = self._places(mesh, spacing, length)
        speeds = np.linalg.norm(self._carrier.motion(self._store, 0.0), axis=1)
        # Nothing moves in a field at rest.
        fast = np.percentile(speeds[speeds > 0], FAST) if np.any(speeds > 0) else 0.0
        self.duration = float(length / fast) if fast else np.inf
        count = len(self._store) // STORE
        empty = np.full((1, count, 3), np.nan)
        self._rows, self._time = Rows(empty, empty.copy(), np.zeros(1)), 0.0
        self._ends = np.zeros(count)
        self._begin(np.arange(count))
        # Lives of all ages at the first time, at which strokes are grown.
        self._ends = self._random.uniform(0, LIVES[1], count) * self.duration
        self.advance(0.0, 0.0, BEFORE * self.duration)

    def fits(self, mesh: pv.DataSet) -> bool:
        """Return whether a mesh has the points of that on which the strokes began."""
        return mesh.n_points == self._n_points and mesh.bounds == self._bounds

    def between(self, first: Array, after: Array) -> None:
        """Take the vectors of the points at both ends of an interval."""
        self._carrier.between(first, after)

    def advance(self, share: float, width: float, duration: float) -> None:
        """Carry the particles for a time, in vectors from ``share`` of the interval on.

        The vectors change by ``width`` of the interval meanwhile.
        """
        if not np.isfinite(self.duration):
            return
        count = self._carrier.count(self._rows.places[-1], duration, STEP)
        count = max(count, int(np.ceil(ROWS * duration / self.duration)))
        for j in range(count):
            here, start = self._rows.places[-1], share + width * j / count
            self._time += duration / count
            moved = self._carrier.moved(here, start, width / count, duration / count)
            moved[self._ends <= self._time] = np.nan
            vectors = self._carrier.at(moved, start + width / count)
            rows = self._rows.joined(Rows(moved[None], vectors[None], np.array([self._time])))
            self._rows = rows[rows.times >= self._time - self.duration]
            gone = ~np.any(np.isfinite(self._rows.places[..., 0]), axis=0)
            self._begin(np.flatnonzero(gone))

    def strokes(self, tangents: str) -> pv.PolyData:
        """Return the strokes with the point arrays of their vectors, and of their ``width``."""
        lines = self._rows.lines(tangents, WHEN)
        if not lines.n_points:
            return lines
        length = float(np.median(strokes.segments_of(lines).totals()))
        lines = strokes.fine(lines, length) if length > 0 else lines
        strokes.set_widths(lines, WHEN, self.duration, self._arrow)
        del lines.point_data[WHEN]
        return lines

    def _places(self, mesh: pv.DataSet, spacing: float, length: float) -> Array:
        """Return places in the cells of a mesh, at random with equal density."""
        sizes = self._carrier.sizes
        total = float(sizes.sum())
        room = spacing ** (mesh.GetMaxSpatialDimension() - 1) * length
        count = int(np.clip(total / room, FEWEST, MOST))
        cells = np.sort(self._random.choice(len(sizes), STORE * count, p=sizes / total))
        distinct, again = np.unique(cells, return_inverse=True)
        part = mesh.extract_cells(distinct.tolist())
        ids, starts = connectivity(part.GetCells())
        corners = np.diff(starts)[again]
        cell = np.repeat(np.arange(len(cells)), corners)
        nth = np.arange(len(cell)) - np.repeat(np.cumsum(corners) - corners, corners)
        weights = self._random.exponential(size=len(cell))
        sums = np.bincount(cell, weights=weights)
        points = np.asarray(part.points, dtype=np.float64)[ids[starts[again][cell] + nth]]
        places: Array = np.stack(
            [np.bincount(cell, weights=weights * column) for column in points.T], axis=1
        )
        return places / sums[:, np.newaxis]

    def _begin(self, particles: Indices) -> None:
        """Let particles begin, each at the emptiest of some places."""
        heads = self._rows.places[-1]
        present = heads[np.isfinite(heads[:, 0])]
        for particle in particles:
            tried = self._store[self._random.integers(len(self._store), size=CANDIDATES)]
            if len(present):
                apart = np.linalg.norm(tried[:, np.newaxis] - present, axis=2).min(axis=1)
                tried = tried[np.argmax(apart)][np.newaxis]
            heads[particle] = tried[0]
            present = np.concatenate([present, tried[:1]])
        self._rows.vectors[-1, particles] = self._carrier.at(heads[particles], 0.0)
        life = self._random.uniform(*LIVES, len(particles)) * self.duration
        self._ends[particles] = self._time + life
