"""The outer surface of a dataset, and the indices of its points in the dataset."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkGenericCell, vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter, vtkGeometryFilter

from vizlight.reading.arrays import points_of
from vizlight.reading.cells import as_numpy, as_vtk, places

if TYPE_CHECKING:
    from vizlight._types import Array, Dataset, Foreign, Indices

#: Name of a temporary point array, chosen not to clash with a user's array.
NUMBERS = "vizlight numbers"
#: Types of cells whose faces are flat or ruled: up to 20, convex point sets, polyhedra.
_LAST_LINEAR, _OTHER_LINEAR = 20, {41, 42}


def cell_types(mesh: vtkUnstructuredGrid) -> set[int]:
    """Return the types of the cells of a grid."""
    return set(np.unique(as_numpy(mesh.GetDistinctCellTypesArray())).tolist())


def dimension(mesh: Dataset) -> int:
    """Return the largest dimension of the cells of a dataset that is no vtkPolyData."""
    if not isinstance(mesh, vtkUnstructuredGrid):
        return int(mesh.GetDataDimension()) if hasattr(mesh, "GetDataDimension") else 3
    cell, found = vtkGenericCell(), 0
    for kind in cell_types(mesh):
        cell.SetCellType(kind)
        found = max(found, cell.GetCellDimension())
    return found


def is_curved(mesh: Dataset) -> bool:
    """Return whether a dataset has cells that are not linear."""
    if not isinstance(mesh, vtkUnstructuredGrid) or not mesh.GetNumberOfCells():
        return False
    return any(kind > _LAST_LINEAR and kind not in _OTHER_LINEAR for kind in cell_types(mesh))


def outer_surface(mesh: Dataset) -> tuple[vtkPolyData, Indices]:
    """Return the outer surface of a mesh, and the index of each of its points in the mesh.

    The index is -1 where the mesh has no such point. Each curved cell is replaced by a flat cell
    with the same nodes. Points without cells have a surface of all points without cells.
    """
    if not mesh.GetNumberOfCells():
        bare, points = vtkPolyData(), vtkPoints()
        points.SetData(as_vtk(points_of(mesh, None)[:]))
        bare.SetPoints(points)
        return bare, np.arange(mesh.GetNumberOfPoints())
    if not is_curved(mesh):
        plain = vtkGeometryFilter()
        # VTK's own name may be that of an array of the mesh, whose surface was taken before.
        plain.SetOriginalPointIdsName(NUMBERS)
        plain.PassThroughPointIdsOn()
        plain.SetInputData(mesh)
        plain.Update()
        surface = plain.GetOutput()
        ids = as_numpy(surface.GetPointData().GetArray(NUMBERS))
        surface.GetPointData().RemoveArray(NUMBERS)
        return surface, ids.astype(np.intp, copy=False)
    # VTK's ids of the nodes of curved cells are those within the cell, so the points of the mesh
    # are numbered here.
    numbered: Foreign = mesh.NewInstance()
    numbered.ShallowCopy(mesh)
    numbers = np.arange(mesh.GetNumberOfPoints(), dtype=np.float64)
    numbered.GetPointData().AddArray(as_vtk(numbers, NUMBERS))
    curved = vtkDataSetSurfaceFilter()
    curved.SetNonlinearSubdivisionLevel(1)
    curved.SetInputData(numbered)
    curved.Update()
    surface = curved.GetOutput()
    ids = np.rint(as_numpy(surface.GetPointData().GetArray(NUMBERS))).astype(np.intp)
    surface.GetPointData().RemoveArray(NUMBERS)
    # The control points of Bezier cells are not on the surface.
    skin = places(surface)
    off = np.abs(skin - places(mesh)[ids]).max(axis=1, initial=0)
    return surface, np.where(off <= 1e-5 * np.abs(skin).max(initial=0), ids, -1)


def scattered(rows: Array, origin: Indices, count: int) -> Array:
    """Return an array of all points of a mesh from one of its surface; other rows are zero."""
    found = np.zeros((count, *rows.shape[1:]), dtype=rows.dtype)
    there = origin >= 0
    found[origin[there]] = rows[there]
    return found
