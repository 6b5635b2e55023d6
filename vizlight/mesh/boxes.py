"""The sides of images and rectilinear grids, whose normals and sharp edges need no search."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.mesh import normals, point_arrays
from vizlight.mesh.creases import cell_array
from vizlight.reading.arrays import GridPoints
from vizlight.reading.cells import GHOSTS
from vizlight.reading.normals import Sided

if TYPE_CHECKING:
    from vizlight._types import Indices


def box(mesh: pv.DataSet) -> pv.PolyData | None:
    """Return the six sides of a grid as a surface with its normals and arrays, None for others.

    Points on the edges of the box are there once for each side.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh; an image or a rectilinear grid of two or more points along each axis has sides.
    """
    if not isinstance(mesh, pv.ImageData | pv.RectilinearGrid) or min(mesh.dimensions) < 2:
        return None
    if GHOSTS in mesh.point_data or GHOSTS in mesh.cell_data:
        return None
    size = np.array(mesh.dimensions)
    steps, cell_steps = (np.cumprod([1, *n[:2]]) for n in (size, size - 1))
    source, middle = GridPoints(mesh), np.asarray(mesh.center)
    origin, cells, quads, vectors, count = [], [], [], [], 0
    for side in range(6):
        axis, end = side // 2, int(size[side // 2] - 1) * (side % 2)
        u, v = (axis + 1) % 3, (axis + 2) % 3
        own = end * steps[axis] + _sheet(size, steps, u, v)
        a, b, c = source.at(own[:2, :2].ravel()[:3])
        normal = np.cross(c - a, b - a)
        inward = normal @ (a - middle) < 0
        normal /= np.linalg.norm(normal) * (-1 if inward else 1)
        at = count + np.arange(own.size).reshape(own.shape)
        corners = [at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]]
        quads.append(np.stack(corners[::-1] if inward else corners, axis=-1).reshape(-1, 4))
        inner = min(end, size[axis] - 2) * cell_steps[axis]
        cells.append((inner + _sheet(size - 1, cell_steps, u, v)).ravel())
        origin.append(own.ravel())
        vectors.append(np.broadcast_to(normal.astype(np.float32), (own.size, 3)))
        count += own.size
    ids, of_cells = np.concatenate(origin), np.concatenate(cells)
    found = pv.PolyData()
    found.SetPoints(pv.vtk_points(np.asarray(source.at(ids), dtype=float)))
    corners_of = np.concatenate(quads)
    found.SetPolys(cell_array(corners_of.ravel(), np.arange(0, corners_of.size + 1, 4)))
    for key, array in mesh.point_data.items():
        point_arrays.attach_rows(found, key, np.asarray(array)[ids])
    for key, array in mesh.cell_data.items():
        found.cell_data[key] = np.asarray(array)[of_cells]
    point_arrays.carry_active(mesh, found)
    lean = np.zeros(count, dtype=np.float32)
    normals.keep(found, Sided(np.concatenate(vectors), lean, computed=True))
    return found


def _sheet(size: Indices, steps: Indices, u: int, v: int) -> Indices:
    """Return numbers of the places of a grid along two axes, from the first one."""
    found: Indices = np.add.outer(np.arange(size[u]) * steps[u], np.arange(size[v]) * steps[v])
    return found
