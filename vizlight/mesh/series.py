"""Meshes at rising times, from a list, a file, or a reader, one read at a time."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh import blocks, steps
from vizlight.mesh.steps import TIME
from vizlight.reading.arrays import vectors_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight._types import Foreign

__all__ = ["Series"]


class Series:
    """Meshes with the same points at rising times.

    Parameters
    ----------
    source : sequence of meshes, reader, or path
        Meshes; a reader of PyVista with ``time_values``; or the path of a file that has one.
    times : array_like, shape (S,), optional
        Times of a sequence. Default: the field array ``TimeValue`` of its meshes.

    Raises
    ------
    TypeError, ValueError
        If there are fewer than two meshes, or the times do not rise.
    """

    def __init__(self, source: object, times: object = None) -> None:
        self._meshes: Sequence[Foreign] | None = None
        self._reader: Foreign = None
        if isinstance(source, str | Path):
            path = _check.path("series", source)
            try:
                source = steps.reader_of(path)
            except OSError as error:
                expected, got = "the path of a file that PyVista reads", f"'{path}' ({error})"
                raise ValueError(_check.message("series", expected, got)) from error
            if source is None:
                expected, got = "the path of a file that PyVista reads", f"'{path}'"
                raise ValueError(_check.message("series", expected, got))
        if hasattr(source, "read"):
            if times is not None:
                remedy = "leave times= out"
                raise ValueError(_check.message("times", "the times of the reader", "both", remedy))
            self._reader, times = source, steps.times_of(source)
        elif isinstance(source, Sequence):
            self._meshes = source
            times = _own_times(source) if times is None else times
        else:
            expected = "meshes, a reader with time values, or the path of its file"
            raise TypeError(_check.message("series", expected, _check.describe(source)))
        #: Times of the steps, shape (S,).
        self.times = _check.floats("times", times).astype(np.float64)
        if self._meshes is not None and self.times.shape != (len(self._meshes),):
            expected = f"{len(self._meshes)} times, one for each mesh"
            raise ValueError(_check.message("times", expected, f"shape {self.times.shape}"))
        if len(self.times) < 2:
            raise ValueError(_check.message("series", "two steps or more", str(len(self.times))))
        falls = np.flatnonzero(~(np.diff(self.times) > 0) | ~np.isfinite(self.times[1:]))
        if len(falls):
            got = f"{self.times[falls[0]]:g} before {self.times[falls[0] + 1]:g}"
            raise ValueError(_check.message("times", "finite times that rise", got))
        self._first: pv.DataSet | None = None

    def mesh(self, step: int) -> pv.DataSet:
        """Return the mesh of a step, which has the points of the first.

        Raises
        ------
        TypeError, ValueError
            If it is no mesh with cells, or its points are others.
        """
        if self._meshes is not None:
            mesh = self._meshes[step]
        else:
            mesh = steps.at(self._reader, float(self.times[step]))
        if isinstance(mesh, pv.MultiBlock):
            mesh = mesh[0] if len(mesh) == 1 else blocks.joined(mesh)
        name = self.name(step)
        if not isinstance(mesh, pv.DataSet) or not mesh.n_cells:
            raise TypeError(_check.message(name, "a mesh with cells", _check.describe(mesh)))
        if self._first is None:
            self._first = mesh if step == 0 else self.mesh(0)
        first = self._first
        same = mesh.n_points == first.n_points and mesh.n_cells == first.n_cells
        if not same or not np.array_equal(mesh.points, first.points):
            expected = f"the {first.n_points} points of {self.name(0)}"
            remedy = "sample all steps to one mesh by mesh.sample(step)"
            got = f"{mesh.n_points} points" + (", others" if same else "")
            raise ValueError(_check.message(name, expected, got, remedy))
        return mesh

    def vectors(self, step: int, array: str) -> NDArray[np.float64]:
        """Return the vectors of a step, zero where they are not finite.

        Raises
        ------
        ValueError
            If the step has no such point array of 3 components.
        """
        mesh, name = self.mesh(step), f"vectors, {self.name(step)}"
        if array not in mesh.point_data:
            there = ", ".join(map(repr, mesh.point_data)) or "none"
            expected = f"the point array {array!r} ({there})"
            raise ValueError(_check.message(name, expected, "none of that name"))
        rows = vectors_of(mesh, name, array, 3)
        return np.where(np.isfinite(rows), rows, 0.0).astype(np.float64)

    def name(self, step: int) -> str:
        """Return the name of a step in messages."""
        return f"series[{step}] (time {self.times[step]:g})"


def _own_times(meshes: Sequence[Foreign]) -> list[float]:
    missing = [i for i, mesh in enumerate(meshes) if TIME not in getattr(mesh, "field_data", {})]
    if missing:
        expected = f"times=, or meshes with the field array {TIME!r}"
        raise ValueError(_check.message("times", expected, f"none at series[{missing[0]}]"))
    return [float(np.asarray(mesh.field_data[TIME]).ravel()[0]) for mesh in meshes]
