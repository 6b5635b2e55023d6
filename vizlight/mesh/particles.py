"""Particles that are carried by vectors which change with time: their lines and strokes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkProbeFilter

from vizlight._types import Array, Foreign, Indices
from vizlight.geometry.lines.simplices import Columns
from vizlight.mesh import dates, georeference, meaning, polylines, records, strokes
from vizlight.vtk.cells import connectivity

#: Name of the array that is probed: the vectors at both ends of an interval.
BOTH = "vizlight vectors"
#: Largest number of steps in which an interval is crossed.
MOST_STEPS = 10_000


@dataclass
class Rows(Columns):
    """Particles at R times of release or of passage, for each of N seeds; NaN for none.

    Places and the vectors that carry them have the shape (R, N, 3).
    """

    places: Array
    vectors: Array
    times: Array

    def thinned(self, most: int) -> Rows:
        """Return the rows from the oldest present one on, without one that is close to others."""
        there = np.any(np.isfinite(self.places), axis=(1, 2))
        # Rows age in order: one whose particles have all left the mesh is dropped.
        kept = np.arange(np.argmax(there) if there.any() else len(there), len(there))
        if len(kept) > most:
            times = self.times[kept]
            # The row whose neighbours are nearest in time is missed least; the oldest and the
            # newest stay. One row is added at a time, so one less is enough.
            kept = np.delete(kept, 1 + np.argmin(times[2:] - times[:-2]))
        return self[kept]

    def lines(self, vectors: str, time: str) -> pv.PolyData:
        """Return one line for each seed, more where one is interrupted."""
        # Seed after seed, as lines are: each has all of its times in a row.
        places = np.swapaxes(self.places, 0, 1)
        there = np.all(np.isfinite(places), axis=2)
        # A gap before and behind each seed's row, so that no line runs into the next seed's.
        edge = np.zeros((len(there), 1), dtype=bool)
        before = np.concatenate([edge, there[:, :-1]], axis=1)
        after = np.concatenate([there[:, 1:], edge], axis=1)
        # A single point is no line.
        there &= before | after
        starts = (there & ~before)[there]
        out = polylines.polydata(places[there], np.append(np.flatnonzero(starts), there.sum()))
        records.attach_rows(out, vectors, np.swapaxes(self.vectors, 0, 1)[there])
        records.attach_rows(out, time, np.broadcast_to(self.times, there.shape)[there])
        return out


class Carrier:
    """Vectors between two times, linear in time, by VTK's interpolation in the cells.

    The arrays of the mesh are not used; ``tangents`` is the name of the vectors or of their
    components, for their unit.
    """

    def __init__(self, mesh: pv.DataSet, tangents: str = "") -> None:
        # VTK finds no place in a rectilinear grid of one layer along x or y.
        upright = isinstance(mesh, pv.RectilinearGrid) and 1 in mesh.dimensions[:2]
        self._mesh = mesh.cast_to_structured_grid() if upright else mesh.copy(deep=False)
        # Of a map vectors and times are in the units of its file, metres a second without one.
        size = dates.seconds(meaning.of(mesh).time) if georeference.is_map(mesh) else None
        self._seconds = 1.0 if size is None else size * meaning.speed(mesh, tangents)
        # The probe interpolates every array of its source, and all but the vectors in vain.
        self._mesh.clear_point_data()
        self._mesh.clear_cell_data()
        #: Lengths, areas or volumes of the cells.
        self.sizes = _sizes(mesh)
        extent = self.sizes[self.sizes > 0]
        # The side of a square or cube as large as the typical cell.
        side = 1 / mesh.GetMaxSpatialDimension()
        self._cell = float(np.median(extent)) ** side if len(extent) else 0.0

    def between(self, first: Array, second: Array) -> None:
        """Take the vectors of the points at both ends of an interval."""
        # Side by side: one search for the cell of a place serves both ends of the interval.
        self._mesh.point_data[BOTH] = np.concatenate([first, second], axis=1)
        self._probe = vtkProbeFilter()
        self._probe.SetSourceData(self._mesh)

    def at(self, places: Array, share: float) -> Array:
        """Return the vectors at places after a share of the interval; NaN outside the mesh."""
        both = self._both(places)
        return np.asarray((1 - share) * both[:, :3] + share * both[:, 3:])

    def _rates(self, places: Array) -> Array:
        """Return the factors that take vectors to motion in the coordinates of the mesh."""
        return self._seconds * georeference.rates(self._mesh, places)

    def motion(self, places: Array, share: float) -> Array:
        """Return the motion at places after a share of the interval, in the unit of the times."""
        return self.at(places, share) * self._rates(places)

    def _both(self, places: Array) -> Array:
        both = np.full((len(places), 6), np.nan)
        inside = np.flatnonzero(np.all(np.isfinite(places), axis=1))
        if len(inside):
            self._probe.SetInputData(pv.PolyData(places[inside]))
            self._probe.Update()
            probed: Foreign = pv.wrap(self._probe.GetOutput())
            # VTK gives zeros outside of the mesh: only its mask tells them from vectors at rest.
            valid = np.asarray(probed.point_data["vtkValidPointMask"], dtype=bool)
            both[inside[valid]] = np.asarray(probed.point_data[BOTH])[valid]
        return both

    def count(self, places: Array, duration: float, step: float) -> int:
        """Return the number of steps of an interval, each of at most ``step`` cell lengths."""
        both = self._both(places).reshape(len(places), 2, 3)
        speed = np.linalg.norm(both * self._rates(places)[:, np.newaxis], axis=2)
        # The fastest particle sets the step of all, which advance together.
        fastest = float(np.nanmax(speed)) if np.any(np.isfinite(speed)) else 0.0
        wanted = fastest * duration / (step * self._cell) if self._cell else 1.0
        return int(np.clip(np.ceil(wanted), 1, MOST_STEPS))

    def moved(self, places: Array, share: float, width: float, duration: float) -> Array:
        """Return places after a step by the method of Runge and Kutta; NaN beyond the mesh.

        The step is ``width`` of the interval, from ``share`` of it on; ``duration`` is its time.
        """
        middle = share + width / 2
        # A stage outside of the mesh is NaN, and so is the sum: the line ends before this step.
        a = self.motion(places, share)
        b = self.motion(places + duration / 2 * a, middle)
        c = self.motion(places + duration / 2 * b, middle)
        d = self.motion(places + duration * c, share + width)
        return np.asarray(places + duration / 6 * (a + 2 * b + 2 * c + d))


def _sizes(mesh: pv.DataSet) -> Array:
    """Return the length, the area or the volume of each cell, by the dimension of the mesh."""
    k = mesh.GetMaxSpatialDimension()
    sizes = mesh.compute_cell_sizes(length=k == 1, area=k == 2, volume=k == 3)
    # A cell that is turned inside out has a negative volume.
    return np.asarray(np.abs(sizes.cell_data[("Length", "Area", "Volume")[k - 1]]))


#: Percentile of the speeds at which a stroke is as long as asked for.
FAST = 75
#: Least and largest number of strokes.
FEWEST, MOST = 20, 3000
#: Points of a stroke, length of its head in space as a share of it, and largest step in cell
#: lengths.
ROWS, HEAD, STEP = 20, 0.13, 1.0
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

    ``spacing`` and ``length`` are the distance between neighbours and the length of fast strokes,
    in the unit of the mesh; ``duration`` is the time that a stroke shows, in the unit of the times.
    The mesh and ``tangents`` are as for :class:`vizlight.mesh.particles.Carrier`, and ``vectors``
    those before the first time.
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
