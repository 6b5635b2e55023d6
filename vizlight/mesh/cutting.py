"""The section of a mesh by a hyperplane of n-space, with its point arrays interpolated."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check, _pool
from vizlight.geometry.nspace import slices
from vizlight.mesh import blocks, point_arrays
from vizlight.reading import polylines
from vizlight.reading.cells import has_faces

if TYPE_CHECKING:
    from collections.abc import Mapping

    from vizlight._types import Array, Indices

_SIMPLICES = (pv.CellType.TETRA, pv.CellType.TRIANGLE, pv.CellType.LINE)
#: Six faces of a hexahedron, their corners in cyclic order.
_FACES = np.array(
    [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
)
#: Corners of a voxel in the order of a hexahedron's.
_VOXEL = [0, 1, 3, 2, 4, 5, 7, 6]
#: Number of frames that are interpolated at once: each takes about n k numbers.
BLOCK = 1 << 15


def cut(
    mesh: pv.DataSet, heights: Array, /, *, spaces: Mapping[str, int] | None = None
) -> pv.PolyData:
    """Return the part of a mesh where a function of its points is 0, with its point arrays.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of lines, faces or volumes; the cells of highest dimension are cut.
    heights : ndarray, shape (N,)
        Values of the function at the points.
    spaces : mapping of str to int, optional
        Names of point arrays whose rows span a space, and the number n of components of a row:
        the mean is one of spaces, independent of the basis at each point.

    Returns
    -------
    pyvista.PolyData
        Points, lines or triangles. Numeric point arrays are interpolated along the cut edges,
        cell arrays are left out. A hexahedron is cut as 12 tetrahedra around its mean point.
        Triangles are not consistently oriented.

    Raises
    ------
    ValueError
        If the mesh has neither lines nor faces nor volumes.
    """
    simplices, middles = _simplices(mesh)
    heights = np.concatenate([heights, heights[middles].mean(axis=1)])
    edges, weights, cells = slices.cut(heights, simplices)
    count, total = mesh.n_points, mesh.n_points + len(middles)
    parts = np.stack([1 - weights, weights], axis=1)
    between = _sparse(parts, edges, total)
    if len(middles):
        spread = _sparse(np.full(middles.shape, 1 / middles.shape[1]), middles, count)
        between = between[:, :count] + between[:, count:] @ spread
    # A point with weight 0 must not contribute a NaN.
    between.eliminate_zeros()
    out = blocks.polydata(between @ np.asarray(mesh.points, dtype=np.float64), cells)
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


def _sparse(parts: Array, columns: Indices, count: int) -> scipy.sparse.csr_array:
    """Return a sparse array of rows with equally many parts in given columns."""
    ends = np.arange(0, parts.size + 1, parts.shape[1])
    made = scipy.sparse.csr_array((parts.ravel(), columns.ravel(), ends), (len(parts), count))
    made.sum_duplicates()
    return made


def _mean_frames(array: Array, between: scipy.sparse.csr_array, n: int) -> Array:
    """Return weighted means of frames in n-space; a row of ``between`` has the weights of one."""
    found = np.empty((between.shape[0], array.shape[1]), dtype=array.dtype)
    for block in _pool.blocks(len(found), BLOCK):
        part = between[block]
        used, columns = np.unique(part.indices, return_inverse=True)
        near = scipy.sparse.csr_array(
            (part.data, columns.reshape(-1), part.indptr), (len(part.indptr) - 1, len(used))
        )
        rows = array[used].astype(np.float64).reshape(len(used), -1, n)
        found[block] = slices.mean_frame(rows, near).reshape(-1, array.shape[1])
    return found


def _triangles(mesh: pv.PolyData) -> Indices:
    """Return the triangles of faces."""
    if np.ptp(mesh.points, axis=0).any():
        return np.asarray(mesh.triangulate().regular_faces, dtype=np.intp)
    # A manifold that is not projected yet has all points in one place; VTK 9.4 finds nothing there.
    faces = np.asarray(mesh.regular_faces, dtype=np.intp)
    fan = [(0, i, i + 1) for i in range(1, faces.shape[1] - 1)]
    return faces[:, fan].reshape(-1, 3)


def _simplices(mesh: pv.DataSet) -> tuple[Indices, Indices]:
    """Return segments, triangles or tetrahedra, and the corners of the hexahedra that are split."""
    none = np.empty((0, 8), dtype=np.intp)
    if isinstance(mesh, pv.PolyData):
        if has_faces(mesh):
            return _triangles(mesh), none
        segments = polylines.segments(mesh.GetLines())
        if len(segments):
            return segments, none
    else:
        grid = mesh.cast_to_unstructured_grid()
        kinds = _cells(grid)
        whole = {pv.CellType.TETRA, pv.CellType.HEXAHEDRON, pv.CellType.VOXEL}
        if kinds and set(kinds) <= whole:
            return _tetrahedra(kinds, mesh.n_points)
        kinds = _cells(grid.triangulate()) if kinds else {}
        for kind in _SIMPLICES:
            if kind in kinds:
                return kinds[kind], none
    expected, got = "lines, faces or volumes to cut", "a mesh of points alone"
    remedy = "connect the points, for example by delaunay_3d()"
    raise ValueError(_check.message("mesh", expected, got, remedy))


def _cells(grid: pv.UnstructuredGrid) -> dict[int, Indices]:
    """Return the points of the cells of a grid, by the type of the cells."""
    kinds = grid.cells_dict if grid.n_cells else {}
    return {int(kind): np.asarray(cells, dtype=np.intp) for kind, cells in kinds.items()}


def _tetrahedra(kinds: Mapping[int, Indices], count: int) -> tuple[Indices, Indices]:
    """Return the tetrahedra of a mesh, 12 around the mean point of each hexahedron.

    Each face is split by the diagonal from its corner of the lowest index, so that both hexahedra
    at a face split it by the same diagonal and the section has no cracks.
    """
    none = np.empty((0, 8), dtype=np.intp)
    voxels = kinds.get(pv.CellType.VOXEL, none)[:, _VOXEL]
    corners = np.concatenate([kinds.get(pv.CellType.HEXAHEDRON, none), voxels])
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
    return np.concatenate([kinds.get(pv.CellType.TETRA, none[:, :4]), *found]), corners
