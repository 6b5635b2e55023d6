"""Points and point arrays of a dataset, read as rows for the engine."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence

import numpy as np
from vtkmodules.vtkCommonDataModel import (
    vtkDataSetAttributes,
    vtkImageData,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkCellDataToPointData

from vizlight import _check
from vizlight._types import AnyArray, Array, Dataset, Foreign, Indices, Rows
from vizlight.model import line_fields
from vizlight.shading.inputs import ArraySource
from vizlight.vtk import cells as vtk_cells


class MadePoints:
    """Points that are computed for each slice and not stored.

    ``at`` takes numbers of points to these.
    """

    dtype = np.dtype(np.float64)

    def __init__(self, count: int, at: Callable[[Indices], Array]) -> None:
        self.shape: tuple[int, ...] = (count, 3)
        #: Function that returns some of the points by their numbers.
        self.at = at

    def __getitem__(self, rows: Rows, /) -> Array:
        """Return a slice of the points."""
        return self.at(np.arange(*rows.indices(self.shape[0])))


class GridPoints(MadePoints):
    """Points of an image or a rectilinear grid; the first index varies fastest."""

    def __init__(self, grid: vtkImageData | vtkRectilinearGrid) -> None:
        super().__init__(grid.GetNumberOfPoints(), self._at)
        # The extent of a part of an image need not begin at 0, but its origin is the place of index
        # 0.
        low = np.array(grid.GetExtent()[::2])
        self._dimensions = vtk_cells.dimensions(grid)
        self._turn: Array | None = None
        if isinstance(grid, vtkImageData):
            # It has the directions of the axes too, as of a scanner, beside origin and spacing.
            place = grid.GetIndexToPhysicalMatrix()
            matrix = np.array([[place.GetElement(i, j) for j in range(4)] for i in range(3)])
            self._axes = [
                start + np.arange(n) for start, n in zip(low, self._dimensions, strict=True)
            ]
            size = np.diag(matrix)
            if np.array_equal(matrix[:, :3], np.diag(size)):
                # Faster than a product of matrices, whose threads wait for each other.
                self._axes = [
                    x * step + at
                    for x, step, at in zip(self._axes, size, matrix[:, 3], strict=True)
                ]
            else:
                self._turn = matrix
        else:
            # Coordinates are stored from the begin of the extent on.
            stored = (grid.GetXCoordinates(), grid.GetYCoordinates(), grid.GetZCoordinates())
            self._axes = [vtk_cells.as_numpy(axis).astype(np.float64) for axis in stored]

    def _at(self, ids: Indices) -> Array:
        ijk = np.unravel_index(ids, self._dimensions, order="F")
        places = np.stack([axis[i] for axis, i in zip(self._axes, ijk, strict=True)], axis=1)
        return places if self._turn is None else places @ self._turn[:, :3].T + self._turn[:, 3]


def points_of(mesh: Dataset, positions: str | None) -> ArraySource:
    """Return the points of a mesh, or a point array with positions in n-space."""
    if positions is not None:
        return array_of(mesh, "positions", positions)
    if isinstance(mesh, vtkImageData | vtkRectilinearGrid):
        return GridPoints(mesh)
    return vtk_cells.places(mesh)


def named(data: vtkDataSetAttributes, name: str) -> AnyArray | None:
    """Return an array of the points or the cells of a dataset, None if it has none of the name."""
    array = data.GetAbstractArray(name)
    return None if array is None else vtk_cells.as_numpy(array)


def array_of(mesh: Dataset, name: str, value: object, *, sizes: Collection[int] = ()) -> Array:
    """Return a point array of real numbers, from its name or from an array with those values.

    A cell array is an error. Errors name the arrays with a number of components among ``sizes``, if
    any.
    """
    if isinstance(value, str):
        _check.text(name, value, expected="the name of a point array")
        array = _named(mesh, name, value, sizes)
        what = f"{value!r} with "
    else:
        array, what = _check.floats(name, value), ""
        # Several tangents per point, one after the other, as a point array of VTK has them.
        if array.ndim == 3:
            array = array.reshape(len(array), -1)
        if array.ndim == 0 or len(array) != mesh.GetNumberOfPoints():
            expected = f"{mesh.GetNumberOfPoints()} rows, one per point"
            raise _check.value_error(name, expected, _check.describe(array))
    return _real_rows(name, array, what)


def _real_rows(name: str, array: Array, what: str) -> Array:
    """Return an array if it holds rows of real numbers; ``what`` names it in an error."""
    if array.dtype.kind not in "iubf":
        raise TypeError(_check.message(name, "real numbers", f"{what}type {array.dtype}"))
    if array.ndim != 2:
        expected = "vectors, an array of 2 or more components"
        got = f"{what}1 component" if array.ndim == 1 else f"{what}shape {array.shape}"
        raise _check.value_error(name, expected, got, "name another array")
    return array


def _named(mesh: Dataset, name: str, value: str, sizes: Collection[int]) -> Array:
    data = mesh.GetPointData()
    if (of_points := named(data, value)) is not None:
        return of_points
    if mesh.GetCellData().HasArray(value):
        remedy = "call mesh.cell_data_to_point_data()"
        raise _check.value_error(name, "a point array", f"the cell array {value!r}", remedy)
    there = [data.GetAbstractArray(i) for i in range(data.GetNumberOfArrays())]
    fitting = [
        repr(array.GetName())
        for array in there
        if (array.GetNumberOfComponents() in sizes if sizes else array.GetNumberOfComponents() > 1)
    ]
    names = ", ".join(fitting) or "none"
    raise _check.value_error(name, f"the name of a point array ({names})", repr(value))


def vectors_of(mesh: Dataset, name: str, value: object, n: int) -> Array:
    """Return a point array of n components, from its name or an array."""
    array = array_of(mesh, name, value, sizes=(n,))
    if array.shape[1] != n:
        got = _components(value, array)
        raise _check.value_error(name, f"{n} components", got, "pass another array")
    return array


def _components(value: object, array: Array) -> str:
    """Return the name of an array, if it has one, and its number of components, for a message."""
    return (f"{value!r} with " if isinstance(value, str) else "") + str(array.shape[1])


def tangents_of(mesh: Dataset, value: object, n: int, *, argument: str = "tangents") -> Array:
    """Return k tangents per point as an array of shape (n_points, k n), 0 < k < n.

    A cell array is averaged to the points, as lines without sign.
    """
    if isinstance(value, str):
        _check.text(argument, value, expected="the name of a point array")
        if without_sign(mesh, value):
            return _averaged_tangents(mesh, argument, value, n)
        if n == 3 and "," in value and not mesh.GetPointData().HasArray(value):
            return of_components(mesh, argument, value.split(","))
    array = array_of(mesh, argument, value, sizes=range(n, n * n, n))
    return _checked_tangents(argument, value, array, n)


def of_components(mesh: Dataset, argument: str, names: Sequence[str]) -> Array:
    """Return the vectors of two or three arrays of one component; of cells their means."""
    columns: list[AnyArray] = []
    for name in names:
        rows = named(mesh.GetPointData(), name)
        if rows is None and (of_cells := named(mesh.GetCellData(), name)) is not None:
            rows = at_points(mesh, of_cells)
        if rows is None or rows.ndim > 1 or rows.dtype.kind not in "iubf":
            got = "no such array" if rows is None else f"shape {rows.shape}, type {rows.dtype}"
            expected = "names of arrays of one component, real numbers"
            raise _check.value_error(argument, expected, f"{name!r}: {got}")
        columns.append(rows)
    if len(columns) not in (2, 3):
        raise _check.value_error(argument, "two or three components", f"{len(columns)}")
    return stacked(columns)


def stacked(columns: Sequence[AnyArray]) -> Array:
    """Return vectors of two or three components; NaN where one of them is not finite."""
    columns = [*columns, *[np.zeros_like(columns[0])] * (3 - len(columns))]
    rows = np.column_stack(columns).astype(np.result_type(np.float32, *(c.dtype for c in columns)))
    # Half a vector is no direction.
    rows[~np.isfinite(rows).all(axis=1)] = np.nan
    return rows


def is_of_cells(mesh: Dataset, name: str) -> bool:
    """Return whether a mesh has an array of this name at its cells alone."""
    return bool(mesh.GetCellData().HasArray(name) and not mesh.GetPointData().HasArray(name))


def without_sign(mesh: Dataset, value: object) -> bool:
    """Return whether tangents are those of a cell array, the means of which are lines."""
    return isinstance(value, str) and is_of_cells(mesh, value)


def _averaged_tangents(mesh: Dataset, argument: str, value: str, n: int) -> Array:
    """Return tangents of cells at the points: means of outer products, which have no sign."""
    of_cells = named(mesh.GetCellData(), value)
    assert of_cells is not None
    rows = _real_rows(argument, of_cells, f"{value!r} with ")
    k = _checked_tangents(argument, value, rows, n).shape[1] // n
    # Opposite tangents of two cells are one line, but would cancel in a mean of vectors.
    products = means(mesh, line_fields.outer(rows.reshape(-1, k, n)).reshape(-1, n * n))
    directions, _ = line_fields.principal(products.reshape(-1, n, n), k)
    kind = rows.dtype if rows.dtype in (np.float32, np.float64) else np.float64
    return directions.reshape(-1, k * n).astype(kind)


def means(mesh: Dataset, rows: AnyArray) -> AnyArray:
    """Return the means at the points of a mesh of the rows of the cells around each."""
    # Without the other arrays, which the filter would average too.
    only: Foreign = mesh.NewInstance()
    only.CopyStructure(mesh)
    # Beside hidden points of a structured grid VTK's means are what stood in memory.
    only.GetPointData().RemoveArray(vtk_cells.GHOSTS)
    only.GetCellData().AddArray(vtk_cells.as_vtk(rows, "rows"))
    averaged = vtk_cells.result(vtkCellDataToPointData(), only)
    return vtk_cells.as_numpy(averaged.GetPointData().GetArray("rows"))


def at_points(mesh: Dataset, rows: AnyArray) -> AnyArray | None:
    """Return values of cells at the points of a mesh, None for words.

    Numbers with a fraction and colours of bytes are means of the cells around a point; of whole
    numbers, which may be labels, it is the one that most of these cells have, the least of several.
    """
    if rows.dtype.kind not in "biuf":
        return None
    if rows.dtype.kind == "f":
        return means(mesh, rows)
    if are_colors(rows):
        return np.rint(means(mesh, rows)).astype(np.uint8)
    kinds, number = np.unique(rows, axis=0, return_inverse=True)
    values = np.zeros((mesh.GetNumberOfPoints(), *rows.shape[1:]), rows.dtype)
    pairs, cell = [], 0
    for cells in vtk_cells.cell_arrays(_explicit(mesh)):
        ids, ends = vtk_cells.connectivity(cells)
        of_cell = number.reshape(-1)[cell : cell + len(ends) - 1]
        pairs.append(ids * len(kinds) + np.repeat(of_cell, np.diff(ends)))
        cell += len(ends) - 1
    if pairs:
        both, count = np.unique(np.concatenate(pairs), return_counts=True)
        point, kind = np.divmod(both, len(kinds))
        # The last of each point is the most frequent, and the least number among those.
        order = np.lexsort((-kind, count, point))
        values[point[order]] = kinds[kind[order]]
    return values


def are_colors(rows: AnyArray) -> bool:
    """Return whether an array holds colours as bytes, not values."""
    return rows.ndim == 2 and rows.dtype == np.uint8 and rows.shape[1] in (3, 4)


def _explicit(mesh: Dataset) -> Dataset:
    """Return a dataset with cells that name their points, without arrays."""
    if isinstance(mesh, vtkPolyData | vtkUnstructuredGrid):
        return mesh
    only: Foreign = mesh.NewInstance()
    only.CopyStructure(mesh)
    explicit: vtkUnstructuredGrid = vtk_cells.result(vtkAppendFilter(), only)
    return explicit


def _checked_tangents(argument: str, value: object, array: Array, n: int) -> Array:
    """Return an array of k tangents per point, 0 < k < n."""
    if array.shape[1] % n or not 0 < array.shape[1] // n < n:
        allowed = " or ".join(str(k * n) for k in range(1, min(n, 5)))
        expected = f"a point array of {allowed} components, rows of {n}"
        remedy = "name another array, or name the positions in n-space by positions="
        raise _check.value_error(argument, expected, _components(value, array), remedy)
    return array
