"""A mesh cut by a hyperplane of n-space: its simplices, and all its arrays between their points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array, csr_array

from vizlight import _check, _pool
from vizlight.geometry.nspace import slices
from vizlight.mesh import point_arrays, polylines

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vizlight._types import Array, Indices

_SIMPLICES = (pv.CellType.TETRA, pv.CellType.TRIANGLE, pv.CellType.LINE)
#: The six faces of a hexahedron, corners in a ring.
_FACES = np.array(
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
_VOXEL = [0, 1, 3, 2, 4, 5, 7, 6]
#: Frames between points are made block by block: each needs some n k numbers for each point.
BLOCK = 1 << 15


def cut(mesh: Any, heights: Array, /, *, spaces: Mapping[str, int] | None = None) -> Any:
    """Return the part of a mesh where a function of its points is 0, with its point arrays.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Of lines, faces or volumes; the cells of highest dimension are cut.
    heights : ndarray, shape (N,)
    spaces : mapping, optional
        Names of point arrays that stand for the space their rows span, and the components n of
        a row: their mean is that of spaces, whatever basis each point has.

    Returns
    -------
    pyvista.PolyData
        Points, lines or triangles. Point arrays of numbers are interpolated along the cut edges,
        cell arrays are left out; a hexahedron is cut as 12 tetrahedra around its mean point.
        Triangles go either way around.

    Raises
    ------
    ValueError
        If the mesh has only loose points.
    """
    simplices, middles = _simplices(mesh)
    heights = np.concatenate([heights, _mean(heights, middles)])
    edges, weights, cells = slices.cut(heights, simplices)
    count, total = mesh.n_points, mesh.n_points + len(middles)
    rows = np.repeat(np.arange(len(edges)), 2)
    parts = np.stack([1 - weights, weights], axis=1).ravel()
    between = coo_array((parts, (rows, edges.ravel())), shape=(len(edges), total)).tocsr()
    if len(middles):
        spread = coo_array(
            (
                np.full(middles.size, 1 / middles.shape[1]),
                (np.repeat(np.arange(len(middles)), middles.shape[1]), middles.ravel()),
            ),
            shape=(len(middles), count),
        ).tocsr()
        between = between[:, :count] + between[:, count:] @ spread
    # A zero weight must not bring in a point that is not finite.
    between.eliminate_zeros()
    out = pv.PolyData()
    out.points = between @ np.asarray(mesh.points, dtype=np.float64)
    made: Any = pv.CellArray.from_regular_cells(cells)
    (out.SetVerts, out.SetLines, out.SetPolys)[cells.shape[1] - 1](made)
    for key, value in mesh.point_data.items():
        array = np.asarray(value)
        if spaces and key in spaces:
            point_arrays.attach_rows(out, key, _mean_frames(array, between, spaces[key]))
        elif array.dtype.kind in "biuf":
            kind = array.dtype if array.dtype.kind == "f" else np.float64
            point_arrays.attach_rows(out, key, (between @ array.astype(np.float64)).astype(kind))
    for key, value in mesh.field_data.items():
        out.field_data[key] = value
    return out


def _mean_frames(array: Array, between: Any, n: int) -> Array:
    found = np.empty((between.shape[0], array.shape[1]), dtype=array.dtype)
    for block in _pool.blocks(len(found), BLOCK):
        part = between[block]
        used, columns = np.unique(part.indices, return_inverse=True)
        near = csr_array(
            (part.data, columns.reshape(-1), part.indptr), (len(part.indptr) - 1, len(used))
        )
        rows = array[used].astype(np.float64).reshape(len(used), -1, n)
        found[block] = slices.mean_frame(rows, near).reshape(-1, array.shape[1])
    return found


def _simplices(mesh: Any) -> tuple[Indices, Indices]:
    """Return segments, triangles or tetrahedra, and the 8 corners of each added mean point."""
    none = np.empty((0, 8), dtype=np.intp)
    if isinstance(mesh, pv.PolyData):
        if mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips():
            faces: Any = mesh.triangulate().regular_faces
            return np.asarray(faces, dtype=np.intp), none
        segments = polylines.segments(mesh.GetLines())
        if len(segments):
            return segments, none
    else:
        grid = mesh.cast_to_unstructured_grid()
        kinds = dict(grid.cells_dict) if grid.n_cells else {}
        whole = {pv.CellType.TETRA, pv.CellType.HEXAHEDRON, pv.CellType.VOXEL}
        if kinds and set(kinds) <= whole:
            return _tetrahedra(kinds, mesh.n_points)
        kinds = grid.triangulate().cells_dict if grid.n_cells else {}
        for kind in _SIMPLICES:
            if kind in kinds:
                return np.asarray(kinds[kind], dtype=np.intp), none
    raise ValueError(
        _check.message("mesh", "lines, faces or volumes to cut", "a mesh of points alone")
    )


def _tetrahedra(kinds: Any, count: int) -> tuple[Indices, Indices]:
    """Return tetrahedra around a mean point of each hexahedron.

    Each face is halved by the diagonal from its corner of the lowest number, so that both its
    hexahedra halve it alike and the cut has no cracks.
    """
    boxes = [np.asarray(kinds.get(pv.CellType.HEXAHEDRON, np.empty((0, 8))), dtype=np.intp)]
    voxels = np.asarray(kinds.get(pv.CellType.VOXEL, np.empty((0, 8))), dtype=np.intp)
    corners = np.concatenate([*boxes, voxels[:, _VOXEL]])
    faces = corners[:, _FACES]
    first = np.argmin(faces, axis=2)[..., np.newaxis]
    ring = np.take_along_axis(faces, (first + np.arange(4)) % 4, axis=2)
    middle = np.broadcast_to(
        count + np.arange(len(corners))[:, np.newaxis, np.newaxis], (len(corners), 6, 1)
    )
    found = [
        np.concatenate([ring[..., part], middle], axis=2).reshape(-1, 4)
        for part in ([0, 1, 2], [0, 2, 3])
    ]
    tetra = np.asarray(kinds.get(pv.CellType.TETRA, np.empty((0, 4))), dtype=np.intp)
    return np.concatenate([tetra, *found]), corners


def _mean(values: Array, groups: Indices) -> Array:
    mean: Array = values[groups].mean(axis=1) if len(groups) else np.empty(0)
    return mean
