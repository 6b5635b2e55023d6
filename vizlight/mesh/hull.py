"""The outer surface of a mesh, and where its points come from."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array, Indices

#: Name of a point array that no user has.
NUMBERS = "vizlight numbers"


def outer_surface(mesh: Any) -> tuple[pv.PolyData, Indices]:
    """Return the outer surface of a mesh and which of its points each is, -1 for none.

    Curved cells are taken as flat ones between their nodes.
    """
    if not mesh.has_nonlinear_cells:
        surface = mesh.extract_surface(algorithm="geometry", pass_pointid=True, pass_cellid=False)
        ids = surface.point_data.pop("vtkOriginalPointIds")
        return surface, np.asarray(ids, dtype=np.intp)
    # VTK numbers the nodes of curved cells by their places in the cell: numbers of our own tell.
    numbered = mesh.copy(deep=False)
    numbered.point_data[NUMBERS] = np.arange(mesh.n_points, dtype=np.float64)
    surface = numbered.extract_surface(
        algorithm="dataset_surface", nonlinear_subdivision=1, pass_pointid=False, pass_cellid=False
    )
    ids = np.rint(np.asarray(surface.point_data.pop(NUMBERS))).astype(np.intp)
    # Bezier's control points are not on the surface.
    off = np.abs(np.asarray(surface.points) - np.asarray(mesh.points)[ids]).max(axis=1, initial=0)
    return surface, np.where(off <= 1e-5 * np.abs(surface.points).max(initial=0), ids, -1)


def scattered(rows: Array, origin: Indices, count: int) -> Array:
    """Return the rows of a mesh's surface as rows of its points, zero where it has none."""
    found = np.zeros((count, *rows.shape[1:]), dtype=rows.dtype)
    there = origin >= 0
    found[origin[there]] = rows[there]
    return found
