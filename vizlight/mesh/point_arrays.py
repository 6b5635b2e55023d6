"""Point arrays of a mesh: taken as rows that the engine slices, and attached."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.model import kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from vizlight._types import Array, Indices
    from vizlight.shading.inputs import ArraySource


class GridPoints:
    """The points of an image or a rectilinear grid, made by slice: none are kept."""

    dtype: np.dtype[Any] = np.dtype(np.float64)

    def __init__(self, grid: pv.ImageData | pv.RectilinearGrid) -> None:
        self.shape: tuple[int, ...] = (grid.n_points, 3)
        self._dimensions = grid.dimensions
        if isinstance(grid, pv.ImageData):
            matrix = np.asarray(grid.index_to_physical_matrix, dtype=np.float64)
            first = np.array(grid.extent[::2])
            self._place: Callable[[Indices], Array] = lambda ijk: (
                (ijk + first) @ matrix[:3, :3].T + matrix[:3, 3]
            )
        else:
            axes = [np.asarray(axis, dtype=np.float64) for axis in (grid.x, grid.y, grid.z)]
            self._place = lambda ijk: np.stack(
                [axis[i] for axis, i in zip(axes, ijk.T, strict=True)], axis=1
            )

    def __getitem__(self, rows: slice, /) -> Array:
        """Return some points, the first index running fastest."""
        flat = np.arange(*rows.indices(self.shape[0]))
        ijk = np.stack(np.unravel_index(flat, self._dimensions, order="F"), axis=1)
        return self._place(ijk)


def points_of(mesh: pv.DataSet, positions: str | None) -> ArraySource:
    """Return the points of a mesh, or a point array of positions in n-space."""
    if positions is not None:
        return array_of(mesh, "positions", positions)
    if isinstance(mesh, pv.ImageData | pv.RectilinearGrid):
        return GridPoints(mesh)
    return np.asarray(mesh.points)


def array_of(
    mesh: pv.DataSet, name: str, value: Any, *, average_cells: bool | None = None
) -> Array:
    """Return a point array by name, or an array given as such; two-dimensional, real.

    Cell data are averaged to the points, refused, or, where None, never averaged.

    Raises
    ------
    TypeError
        If it does not hold real numbers.
    ValueError
        If there is no such array, or it is cell data and may not be averaged.
    """
    if isinstance(value, str):
        array = _named(mesh, name, value, average_cells=average_cells)
        what = f"{value!r} with "
    else:
        array, what = _check.floats(name, value), ""
        if array.ndim == 3:
            array = array.reshape(len(array), -1)
        if array.ndim == 0 or len(array) != mesh.n_points:
            raise ValueError(
                _check.message(name, f"{mesh.n_points} rows, one a point", _check.describe(array))
            )
    if array.dtype.kind not in "iubf":
        raise TypeError(_check.message(name, "real numbers", f"{what}type {array.dtype}"))
    if array.ndim != 2:
        raise ValueError(
            _check.message(
                name,
                "vectors, an array of 2 or more components",
                f"{what}1 component" if array.ndim == 1 else f"{what}shape {array.shape}",
                "name another array",
            )
        )
    return array


def _named(mesh: pv.DataSet, name: str, value: str, *, average_cells: bool | None) -> Array:
    if value in mesh.point_data:
        return np.asarray(mesh.point_data[value])
    if value in mesh.cell_data:
        if average_cells:
            only = mesh.copy(deep=False)
            only.clear_data()
            only.cell_data[value] = np.asarray(mesh.cell_data[value])
            return np.asarray(only.cell_data_to_point_data().point_data[value])
        remedy = "call mesh.cell_data_to_point_data()"
        if average_cells is not None:
            remedy = f"pass average_cells=True or {remedy}"
        raise ValueError(_check.message(name, "a point array", f"the cell array {value!r}", remedy))
    there = ", ".join(repr(key) for key in mesh.point_data) or "none"
    raise ValueError(_check.message(name, f"the name of a point array ({there})", repr(value)))


def refuse_unnamed(name: str, value: Any) -> None:
    """Refuse anything but the name of an array, or None."""
    if value is not None and not isinstance(value, str):
        remedy = "attach it to the mesh and name it"
        raise TypeError(
            _check.message(name, "the name of a point array", _check.describe(value), remedy)
        )


def vectors_of(mesh: pv.DataSet, name: str, value: Any, n: int) -> Array:
    """Return a point array of n components, by name or given as such."""
    array = array_of(mesh, name, value)
    if array.shape[1] != n:
        what = f"{value!r} with {array.shape[1]}" if isinstance(value, str) else array.shape[1]
        raise ValueError(_check.message(name, f"{n} components", what))
    return array


def attach_rows(mesh: pv.DataSet, name: str, array: NDArray[np.generic]) -> None:
    """Attach a point array, also one of no rows, which PyVista refuses."""
    if len(array):
        mesh.point_data[name] = array
    else:
        mesh.GetPointData().AddArray(pv.convert_array(array, name))


def activate(mesh: pv.DataSet, name: str) -> None:
    """Make a point array the active scalars of a mesh, also where those of its cells were."""
    mesh.point_data.active_scalars_name = name
    if mesh.n_points:
        mesh.set_active_scalars(name, preference="point")


def tangents_of(
    mesh: pv.DataSet, value: Any, n: int, *, average_cells: bool, argument: str = "tangents"
) -> Array:
    """Return tangents as (n_points, k n), 0 < k < n."""
    array = array_of(mesh, argument, value, average_cells=average_cells)
    if array.shape[1] % n or not 0 < array.shape[1] // n < n:
        allowed = " or ".join(str(k * n) for k in range(1, min(n, 5)))
        what = f"{value!r} with {array.shape[1]}" if isinstance(value, str) else array.shape[1]
        raise ValueError(
            _check.message(
                argument,
                f"a point array of {allowed} components, rows of {n}",
                what,
                "name another array, or the points in n-space by positions=",
            )
        )
    return array


def unit_rows(vectors: Array) -> Array:
    """Return unit vectors in float64, of whatever length they were; zero without a direction."""
    columns = np.ascontiguousarray(np.asarray(vectors, dtype=np.float64).T)
    result: Array = kernels.unit(columns)[0].T
    return result
