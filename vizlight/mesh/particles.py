"""Particles that are carried by vectors which change with time, and the lines that they draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkProbeFilter

from vizlight.geometry.lines.simplices import Columns
from vizlight.mesh import dates, georeference, meaning, polylines, records

if TYPE_CHECKING:
    from vizlight._types import Array, Foreign

#: Name of the array that is probed: the vectors at both ends of an interval.
BOTH = "vizlight vectors"
#: Largest number of steps in which an interval is crossed.
MOST_STEPS = 10_000


@dataclass
class Rows(Columns):
    """Particles at R times of release or of passage, for each of N seeds; NaN for none.

    Attributes
    ----------
    places : ndarray, shape (R, N, 3)
    vectors : ndarray, shape (R, N, 3)
        Vectors that carry them.
    times : ndarray, shape (R,)
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

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh; its arrays are not used.
    tangents : str
        Name of the vectors or of their components, for their unit.
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
