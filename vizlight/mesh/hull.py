"""The outer surface of a mesh, and the indices of its points in the mesh."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: Name of a temporary point array, chosen not to clash with a user's array.
NUMBERS = "vizlight numbers"


def outer_surface(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices]:
    """Return the outer surface of a mesh, and the index of each of its points in the mesh.

    The index is -1 where the mesh has no such point. Each curved cell is replaced by a flat cell
    with the same nodes. Points without cells have a surface of all points without cells.
    """
    if not mesh.n_cells:
        bare = pv.PolyData()
        bare.SetPoints(pv.vtk_points(np.asarray(mesh.points), deep=False))
        return bare, np.arange(mesh.n_points)
    if not mesh.has_nonlinear_cells:
        surface = mesh.extract_surface(algorithm="geometry", pass_pointid=True, pass_cellid=False)
        ids = surface.point_data.pop("vtkOriginalPointIds")
        return surface, np.asarray(ids, dtype=np.intp)
    # VTK's ids of the nodes of curved cells are those within the cell, so the points of the mesh
    # are numbered here.
    numbered = mesh.copy(deep=False)
    numbered.point_data[NUMBERS] = np.arange(mesh.n_points, dtype=np.float64)
    surface = numbered.extract_surface(
        algorithm="dataset_surface", nonlinear_subdivision=1, pass_pointid=False, pass_cellid=False
    )
    ids = np.rint(np.asarray(surface.point_data.pop(NUMBERS))).astype(np.intp)
    # The control points of Bezier cells are not on the surface.
    off = np.abs(np.asarray(surface.points) - np.asarray(mesh.points)[ids]).max(axis=1, initial=0)
    return surface, np.where(off <= 1e-5 * np.abs(surface.points).max(initial=0), ids, -1)


def scattered(rows: Array, origin: Indices, count: int) -> Array:
    """Return an array of all points of a mesh from one of its surface; other rows are zero."""
    found = np.zeros((count, *rows.shape[1:]), dtype=rows.dtype)
    there = origin >= 0
    found[origin[there]] = rows[there]
    return found
