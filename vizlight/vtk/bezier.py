"""Cells of Bezier as cells of Lagrange, with nodes on the surface of the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_BEZIER_CURVE,
    VTK_BEZIER_WEDGE,
    VTK_LAGRANGE_CURVE,
    vtkDataSetAttributes,
    vtkUnstructuredGrid,
)

from vizlight.vtk.cells import as_numpy, as_vtk, connectivity, grid_cells, places, point_data

if TYPE_CHECKING:
    from vizlight._types import AnyArray, Array, Foreign

#: Attributes of rational cells: weights of points, and degrees of cells along their axes.
_WEIGHTS, _DEGREES = (
    vtkDataSetAttributes.RATIONALWEIGHTS,
    vtkDataSetAttributes.HIGHERORDERDEGREES,
)


def as_lagrange(grid: vtkUnstructuredGrid) -> vtkUnstructuredGrid:
    """Return a grid in which each cell of Bezier is that of Lagrange through the same surface.

    Point i of the result is the place of the surface at the parameters of control point i, of
    polynomial and of rational cells. Their error between nodes is that of the interpolation of a
    rational function by polynomials; polynomial cells stay as they are.

    Parameters
    ----------
    grid : vtkUnstructuredGrid
        Grid; one without such cells is returned itself.
    """
    # VTK has a number for pyramids, and no such cell.
    distinct = as_numpy(grid.GetDistinctCellTypesArray())
    if not np.any((distinct >= VTK_BEZIER_CURVE) & (distinct <= VTK_BEZIER_WEDGE)):
        return grid
    # The method that returns all of them has another name in each version of VTK.
    types = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
    curved = (types >= VTK_BEZIER_CURVE) & (types <= VTK_BEZIER_WEDGE)
    ids, ends = connectivity(grid_cells(grid))
    control = places(grid).astype(np.float64)
    of_points = point_data(grid).GetAttribute(_WEIGHTS)
    weights = np.ones(len(control)) if of_points is None else as_numpy(of_points).reshape(-1)
    points_out, plain = control.copy(), _without_weights(grid)
    for cells in _alike(grid, types, np.diff(ends), np.flatnonzero(curved)):
        shares = _shares(plain.GetCell(int(cells[0])))
        corners = ids[ends[cells][:, np.newaxis] + np.arange(len(shares))]
        shares_of = weights[corners][..., np.newaxis]
        # A rational point is the mean of the control points by weight times Bernstein polynomial.
        sums = np.einsum("ij,mjk->mik", shares, shares_of * control[corners])
        points_out[corners] = sums / np.einsum("ij,mjk->mik", shares, shares_of)
    out = vtkUnstructuredGrid()
    out.ShallowCopy(grid)
    points = vtkPoints()
    points.SetData(as_vtk(points_out))
    out.SetPoints(points)
    kinds = np.where(curved, types - VTK_BEZIER_CURVE + VTK_LAGRANGE_CURVE, types)
    out.SetCells(as_vtk(kinds.astype(np.uint8)), grid_cells(grid))
    return out


def _without_weights(grid: vtkUnstructuredGrid) -> vtkUnstructuredGrid:
    """Return a copy with the Bernstein polynomials alone as shape functions."""
    plain = vtkUnstructuredGrid()
    plain.ShallowCopy(grid)
    point_data(plain).SetActiveAttribute(-1, _WEIGHTS)
    return plain


def _alike(
    grid: vtkUnstructuredGrid, types: AnyArray, sizes: AnyArray, cells: AnyArray
) -> list[AnyArray]:
    """Return the numbers of cells of one type, size and degree, for each of these."""
    degrees = grid.GetCellData().GetAttribute(_DEGREES)
    columns = [types[cells], sizes[cells]]
    if degrees is not None:
        columns += [*as_numpy(degrees)[cells].T]
    _, kind = np.unique(np.column_stack(columns), axis=0, return_inverse=True)
    return [cells[kind.reshape(-1) == i] for i in range(int(kind.max()) + 1)]


def _shares(cell: Foreign) -> Array:
    """Return the shape functions of a cell, a column for each, at the parameters of its points."""
    count = cell.GetNumberOfPoints()
    at = np.reshape(cell.GetParametricCoords(), (-1, 3))[:count]
    rows = np.empty((count, count))
    for row, place in zip(rows, at, strict=True):
        values = [0.0] * count
        cell.InterpolateFunctions(place, values)
        row[:] = values
    return rows
