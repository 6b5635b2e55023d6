"""Faces of a surface at points that are split where they meet at a sharp edge."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

from vizlight.reading.cells import around, as_numpy, as_vtk, connectivity, part_size

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from vizlight._types import Indices

_NUMBERS = "vizlight numbers"
#: Degrees by which an angle may be off by rounding: the edges of a cylinder of 12 sides, which are
#: those of 30 degrees, are split together or not at all.
ROUNDED = 0.01


def split(
    points: NDArray[np.generic], ids: Indices, ends: Indices, angle: float, size: int | None = None
) -> tuple[Indices, Indices]:
    """Return faces at points that are split, and the point that each point was.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        Points of the surface.
    ids : ndarray of int
        Corners of all faces, one face after the other.
    ends : ndarray of int, shape (M + 1,)
        Place in ``ids`` at which each face begins, and the end of the last.
    angle : float
        Angle in degrees between two faces from which their edge is sharp.
    size : int, optional
        Number of points around which faces are split at once.

    Returns
    -------
    ndarray of int
        Corners of the faces, which VTK turns over where they are not wound alike.
    ndarray of int
        Point that each point was: first all of the surface, then those that VTK adds.
    """
    count = len(points)
    size = part_size(count) if size is None else size
    new, added = ids.copy(), [np.arange(count)]
    total = count
    for block, part in around(points, ids, ends, size):
        used, at = part.used, part.corners
        found, origin = _by_vtk(part.surface, angle)
        was = used[origin[found]]
        if not np.array_equal(was, ids[at]):
            if size < count:
                # What is turned over depends on all faces.
                return split(points, ids, ends, angle, count)
            new[at] = was
        own = (found >= len(used)) & (was >= block.start) & (was < block.stop)
        made, number = np.unique(found[own], return_inverse=True)
        new[at[own]] = total + number.reshape(-1)
        added.append(used[origin[made]])
        total += len(made)
    return new, np.concatenate(added)


def cell_array(ids: Indices, ends: Indices) -> pv.CellArray:
    """Return cells, given their corners, one cell after the other, and where each begins."""
    return pv.CellArray.from_arrays(np.asarray(ends, dtype=int), np.asarray(ids, dtype=int))


def _by_vtk(surface: vtkPolyData, angle: float) -> tuple[Indices, Indices]:
    """Return corners of faces at points that VTK has split, and the point that each was."""
    numbers = as_vtk(np.arange(surface.GetNumberOfPoints()), _NUMBERS)
    surface.GetPointData().AddArray(numbers)
    normals = vtkPolyDataNormals()
    normals.SetFeatureAngle(angle + ROUNDED)
    normals.NonManifoldTraversalOff()
    normals.SetInputData(surface)
    normals.Update()
    found = normals.GetOutput()
    origin = as_numpy(found.GetPointData().GetArray(_NUMBERS))
    return connectivity(found.GetPolys())[0].copy(), np.array(origin)
