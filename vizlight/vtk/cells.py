"""Cells of VTK's datasets as indices of points."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util import numpy_support
from vtkmodules.vtkCommonCore import (
    vtkAbstractArray,
    vtkDataArray,
    vtkPoints,
    vtkStringArray,
    vtkUnsignedCharArray,
    vtkVersion,
)
from vtkmodules.vtkCommonDataModel import (
    VTK_POLYHEDRON,
    vtkCellArray,
    vtkCellData,
    vtkDataObject,
    vtkDataSet,
    vtkExplicitStructuredGrid,
    vtkFieldData,
    vtkGenericCell,
    vtkImageData,
    vtkPointData,
    vtkPointSet,
    vtkPolyData,
    vtkRectilinearGrid,
    vtkStructuredGrid,
    vtkUnstructuredGrid,
)
from vtkmodules.vtkFiltersCore import vtkTriangleFilter

from vizlight import _check, _pool
from vizlight._types import AnyArray, Array, Bools, Foreign, Indices, Raw, RawType
from vizlight.model import kernels

#: Array in which VTK marks cells and points of other pieces, and hidden ones.
GHOSTS = "vtkGhostType"
#: Marks of cells that are of another piece, and of those that are refined or hidden; mark of a
#: hidden point.
DUPLICATE, BLANK, HIDDEN, HIDDEN_POINT = 1, 32, 8 | 32, 2
#: Methods of the classes: on a mesh of PyVista the look-up of one takes longer than the call.
point_data: Callable[[Foreign], vtkPointData] = vtkDataSet.GetPointData
cell_data: Callable[[Foreign], vtkCellData] = vtkDataSet.GetCellData
field_data: Callable[[Foreign], vtkFieldData] = vtkDataObject.GetFieldData
grid_cells: Callable[[Foreign], vtkCellArray] = vtkUnstructuredGrid.GetCells
vtk_points: Callable[[Foreign], vtkPoints] = vtkPointSet.GetPoints
#: Returns the types of the cells of an unstructured grid; its name changed in VTK 9.6.
types_of_cells: Callable[[Foreign], vtkDataArray] = (
    vtkUnstructuredGrid.GetCellTypes
    if (vtkVersion.GetVTKMajorVersion(), vtkVersion.GetVTKMinorVersion()) >= (9, 6)
    else vtkUnstructuredGrid.GetCellTypesArray
)
#: Has no types.
_SUPPORT: Foreign = numpy_support
#: Meshes with points along axes.
GRIDS = (vtkImageData, vtkRectilinearGrid, vtkStructuredGrid, vtkExplicitStructuredGrid)
#: VTK's type of a cell by its dimension and the number of its points.
TYPES = {
    (0, 1): 1, (1, 2): 3, (1, 3): 21, (2, 3): 5, (2, 4): 9, (2, 6): 22, (2, 8): 23, (2, 9): 28,
    (3, 4): 10, (3, 5): 14, (3, 6): 13, (3, 8): 12, (3, 10): 24, (3, 15): 26, (3, 20): 25,
}  # fmt: skip
#: Number of an array of VTK by the type of its values, which VTK looks for in a list.
_vtk_type: Callable[[RawType], int] = functools.cache(_SUPPORT.get_vtk_array_type)


def n_points(mesh: Foreign) -> int:
    """Return the number of points of a dataset."""
    # Of a class's method VTK takes that class's own code, which only a surface has here.
    if isinstance(mesh, vtkPolyData):
        return vtkPolyData.GetNumberOfPoints(mesh)
    return int(mesh.GetNumberOfPoints())


def as_numpy(array: vtkAbstractArray) -> AnyArray:
    """Return the values of an array of VTK, without a copy where its memory has their order."""
    if isinstance(array, vtkStringArray):
        return np.array([array.GetValue(i) for i in range(array.GetNumberOfValues())], dtype=str)
    dense: Foreign = array
    # Variants and the like have no type in NumPy; their shape is enough, since whoever asks for
    # numbers refuses the type object.
    if not isinstance(array, vtkDataArray):
        return np.empty((array.GetNumberOfTuples(), array.GetNumberOfComponents()), dtype=object)
    if array.IsA("vtkBitArray"):
        # VTK packs bits eight to a byte, in which NumPy cannot index.
        dense = vtkUnsignedCharArray()
        dense.DeepCopy(array)
    elif not array.HasStandardMemoryLayout():
        # Components that are stored apart, or values that are computed, are no rows in memory.
        dense = vtkDataArray.CreateDataArray(array.GetDataType())
        dense.DeepCopy(array)
    # As VTK's own function does, in a third of its time.
    kind = _SUPPORT.get_numpy_array_type(dense.GetDataType())
    size = dense.GetNumberOfTuples(), dense.GetNumberOfComponents()
    values: AnyArray = np.frombuffer(dense, kind) if size[0] else np.empty(0, kind)
    return values if size[1] == 1 else values.reshape(size)


def as_vtk(rows: AnyArray, name: str = "") -> vtkDataArray:
    """Return an array of VTK with a copy of some values."""
    # VTK has no truth values of one byte.
    plain = rows.view(np.uint8) if rows.dtype == np.bool_ else rows
    # Values in the byte order of another machine are swapped as they are assigned below.
    kind = plain.dtype.newbyteorder("=")
    # Twice as fast as VTK's own way, which counts where there are many small meshes.
    array: Foreign = vtkDataArray.CreateDataArray(_vtk_type(kind))
    array.SetName(name)
    array.SetNumberOfComponents(1 if plain.ndim == 1 else plain.shape[1])
    array.SetNumberOfTuples(len(plain))
    if plain.size:
        values: AnyArray = np.frombuffer(array, dtype=kind)
        values.reshape(plain.shape)[...] = plain
    result: vtkDataArray = array
    return result


def places(mesh: Foreign) -> AnyArray:
    """Return the points that a dataset stores."""
    # A dataset that never got any points has no vtkPoints at all.
    points = mesh.GetPoints()
    return np.zeros((0, 3), np.float32) if points is None else as_numpy(points.GetData())


def connectivity(cells: vtkCellArray) -> tuple[Indices, Indices]:
    """Return the points of all cells, and the offset of each cell in them."""
    # VTK holds these numbers in 32 or in 64 bits, as the file or the filter made them.
    return (
        as_numpy(cells.GetConnectivityArray()).astype(np.intp, copy=False),
        as_numpy(cells.GetOffsetsArray()).astype(np.intp, copy=False),
    )


def has_marks(mesh: Foreign) -> bool:
    """Return whether VTK's marks stand at the cells or the points of a dataset."""
    return any(data(mesh).HasArray(GHOSTS) for data in (cell_data, point_data))


def unseen(mesh: Foreign, cells: Indices, corners: Callable[[], tuple[Indices, Indices]]) -> Bools:
    """Return which faces of a grid are marked as none that is drawn.

    ``cells`` is the cell that each face is of, and ``corners`` returns the corners of the faces,
    and where each begins.
    """
    of_cells, of_points = (data(mesh).GetArray(GHOSTS) for data in (cell_data, point_data))
    faces = np.zeros(len(cells), dtype=np.bool_)
    if of_cells is not None:
        faces |= as_numpy(of_cells)[cells] & (DUPLICATE | HIDDEN) > 0
    if of_points is not None and len(faces):
        ids, ends = corners()
        faces |= np.logical_or.reduceat(as_numpy(of_points)[ids] & HIDDEN_POINT > 0, ends[:-1])
    return faces


def has_faces(mesh: vtkPolyData) -> bool:
    """Return whether a mesh has polygons or triangle strips."""
    return bool(mesh.GetNumberOfPolys() or mesh.GetNumberOfStrips())


def has_polyhedra(grid: vtkUnstructuredGrid) -> bool:
    """Return whether a grid has cells that name their faces, beside their points."""
    return bool(np.any(as_numpy(grid.GetDistinctCellTypesArray()) == VTK_POLYHEDRON))


def faces(surface: vtkPolyData) -> Iterator[tuple[Indices, Indices]]:
    """Yield the corners of all polygons, of all strips, and the end of each face in them."""
    for cells in (surface.GetPolys(), surface.GetStrips()):
        ids, offsets = connectivity(cells)
        if len(ids):
            yield ids, offsets[1:]


def faces_only(mesh: vtkPolyData) -> vtkPolyData:
    """Return the points and the faces of a mesh, but for polygons that it has again.

    VTK takes the faces of a mesh that has vertices or lines for others, and an edge of polygons
    that stand at one place twice for one where many faces meet.
    """
    first = first_twins(mesh.GetPolys())
    return bare_faces(mesh, None if first is None else first == np.arange(len(first)))


def finite_faces(surface: vtkPolyData, chosen: Bools | None = None) -> vtkPolyData:
    """Return a surface without its polygons that have a corner which is not finite.

    VTK would take such a corner, as of a hole in a terrain, into the normals of its neighbours.
    With ``chosen``, a mask of points, only the polygons that have one of them are left.
    """
    finite = finite_points(places(surface))
    polys = surface.GetPolys()
    if (finite.all() and chosen is None) or not polys.GetNumberOfCells():
        return surface
    ids, offsets = connectivity(polys)

    def some(points: Bools) -> Bools:
        # Prefix sums: their difference between two offsets counts the marked corners of one
        # polygon.
        return np.diff(np.concatenate([[0], np.cumsum(points[ids])])[offsets]) > 0

    return bare_faces(surface, ~some(~finite) if chosen is None else ~some(~finite) & some(chosen))


def finite_points(points: Raw) -> Bools:
    """Return which points have finite coordinates alone."""
    finite: Bools = np.isfinite(points)
    # One pass over all coordinates is faster than one by rows, which few meshes need.
    if finite.all():
        return np.ones(len(points), dtype=np.bool_)
    return np.asarray(finite.all(axis=1), dtype=np.bool_)


def new_points(rows: AnyArray) -> vtkPoints:
    """Return points with a copy of some rows."""
    points = vtkPoints()
    points.SetData(as_vtk(rows))
    return points


def new_cells(ids: AnyArray, ends: AnyArray) -> vtkCellArray:
    """Return cells by their corners, one cell after the other, and where each begins."""
    cells = vtkCellArray()
    cells.SetData(as_vtk(ends), as_vtk(ids))
    return cells


def result(take: Foreign, mesh: Foreign) -> Foreign:
    """Return the output of a filter of VTK for a mesh."""
    take.SetInputData(mesh)
    take.Update()
    return take.GetOutput()


def bare_faces(surface: vtkPolyData, kept: Bools | None = None) -> vtkPolyData:
    """Return the points and the strips of a surface, and all or some of its polygons."""
    polys = surface.GetPolys()
    if kept is not None:
        ids, offsets = connectivity(polys)
        size = np.diff(offsets)
        ends = np.concatenate([[0], np.cumsum(size[kept])])
        polys = new_cells(ids[np.repeat(kept, size)], ends)
    bare = vtkPolyData()
    bare.SetPoints(surface.GetPoints())
    bare.SetStrips(surface.GetStrips())
    bare.SetPolys(polys)
    return bare


def first_twins(cells: vtkCellArray) -> Indices | None:
    """Return the first cell of the same points as each cell, None if they all differ."""
    return firsts(mixed_corners(cells))


def mixed_corners(cells: vtkCellArray) -> NDArray[np.uint64]:
    """Return a number of each cell that those of the same points have in common."""
    ids, offsets = connectivity(cells)
    number = np.zeros(max(len(offsets) - 1, 0), dtype=np.uint64)
    with np.errstate(over="ignore"):
        for block in _pool.blocks(len(number), 1 << 16):
            ends = offsets[block.start : block.stop + 1]
            # Sums of mixed numbers do not depend on the order of the corners; from 1 on, as 0 is
            # mixed to 0 and the first point would not count.
            corners = mixed(ids[ends[0] : ends[-1]].astype(np.uint64) + np.uint64(1))
            # Sums wrap around at 2^64, which their differences undo.
            sums = np.concatenate([[np.uint64(0)], np.cumsum(corners, dtype=np.uint64)])
            number[block] = np.diff(sums[ends - ends[0]])
    return number


def firsts(numbers: NDArray[np.uint64]) -> Indices | None:
    """Return the first place at which each of some numbers stands, None if they all differ."""
    # Mostly all differ, which a plain sort tells without the indices that np.unique makes.
    ordered = np.sort(numbers)
    if not np.any(ordered[1:] == ordered[:-1]):
        return None
    del ordered
    _, first, inverse = np.unique(numbers, return_index=True, return_inverse=True)
    return np.asarray(first[inverse.reshape(-1)], dtype=np.intp)


#: Factors of the finaliser of splitmix64.
_MIX = tuple(np.uint64(x) for x in (0xBF58476D1CE4E5B9, 0x94D049BB133111EB))


def mixed(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return numbers of 64 bits in which each bit of the given ones changes half of the others."""
    x = (x ^ (x >> np.uint64(30))) * _MIX[0]
    x = (x ^ (x >> np.uint64(27))) * _MIX[1]
    return x ^ (x >> np.uint64(31))


def columns_at(rows: Raw, ids: Indices) -> Array:
    """Return some rows in float64, one component after the other, shape (components, n)."""
    # In the order of the rows each operation on them would take up to three times as long.
    return rows.take(ids, axis=0).T.astype(np.float64, order="C")


def used(surface: vtkPolyData) -> Bools:
    """Return whether each point is a corner of a face."""
    is_used = np.zeros(surface.GetNumberOfPoints(), dtype=np.bool_)
    for ids, _ in faces(surface):
        is_used[ids] = True
    return is_used


def triangles(surface: vtkPolyData) -> Indices:
    """Return the corners of the triangles of a surface."""
    polys = surface.GetPolys()
    ids = connectivity(polys)[0]
    # Number of corners of all polygons; 0 where there are none, -1 where they differ.
    size = -1 if surface.GetNumberOfStrips() else polys.IsHomogeneous()
    if size in (0, 3):
        return ids.reshape(-1, 3)
    if size == _QUAD and (halves := _halves(ids.reshape(-1, _QUAD), places(surface))) is not None:
        return halves
    split = vtkTriangleFilter()
    split.PassVertsOff()
    split.PassLinesOff()
    corners = connectivity(result(split, surface).GetPolys())[0].reshape(-1, 3)
    # VTK's are twice as long, and go with the filter.
    return corners.astype(np.int32 if surface.GetNumberOfPoints() < 2**31 else np.intp)


def _halves(quads: Indices, points: Raw) -> Indices | None:
    """Return the two triangles of each quadrilateral, those that VTK's filter makes.

    They have its shorter diagonal in common. None where the halves by one of its diagonals turn
    away from each other: such a quadrilateral is dented or folded.
    """
    corners = np.empty((len(quads), 6), dtype=np.int32 if len(points) < 2**31 else np.intp)
    columns = np.ascontiguousarray(points.T, dtype=np.float64)
    for block in _pool.blocks(len(quads), 1 << 15):
        at = np.ascontiguousarray(quads[block].T)
        a, b, c, d = (columns.take(corner, axis=1) for corner in at)
        sides = b - a, c - b, d - c, a - d
        dots = [kernels.dot(sides[i - 1], sides[i]) for i in range(_QUAD)]
        # Products of the area vectors of the halves, by Lagrange's identity.
        across = kernels.dot(sides[0], sides[2]) * kernels.dot(sides[1], sides[3])
        # First the halves by the diagonal from the second corner, then those by the other diagonal.
        if not (np.all(across > dots[1] * dots[3]) and np.all(across > dots[0] * dots[2])):
            return None
        diagonal, other = c - a, d - b
        shorter = kernels.dot(diagonal, diagonal) < kernels.dot(other, other)
        p, q, r, s = at
        halves = p, q, np.where(shorter, r, s), np.where(shorter, p, q), r, s
        for column, corner in zip(corners[block].T, halves, strict=True):
            column[:] = corner
    return corners.reshape(-1, 3)


#: Number of corners.
_QUAD = 4


#: Number of each kind of cells of a vtkPolyData, and those cells.
POLYDATA: tuple[tuple[Callable[[Foreign], int], Callable[[Foreign], vtkCellArray]], ...] = (
    (vtkPolyData.GetNumberOfVerts, vtkPolyData.GetVerts),
    (vtkPolyData.GetNumberOfLines, vtkPolyData.GetLines),
    (vtkPolyData.GetNumberOfPolys, vtkPolyData.GetPolys),
    (vtkPolyData.GetNumberOfStrips, vtkPolyData.GetStrips),
)


def cell_arrays(mesh: Foreign) -> list[vtkCellArray]:
    """Return the cells of a mesh by kind; none of a grid, since its cells name no points."""
    if isinstance(mesh, vtkPolyData):
        return [cells(mesh) for count, cells in POLYDATA if count(mesh)]
    cells = grid_cells(mesh) if isinstance(mesh, vtkUnstructuredGrid) else None
    return [] if cells is None else [cells]


def renumber_corners(mesh: Foreign, numbers: Indices) -> None:
    """Give the corners of all cells of a mesh, in VTK's own memory, the new numbers of points."""
    every = cell_arrays(mesh)
    # A polyhedron has the points of its faces in an array of its own.
    faces = mesh.GetPolyhedronFaces() if isinstance(mesh, vtkUnstructuredGrid) else None
    for cells in [*every, faces] if faces is not None else every:
        ids = as_numpy(cells.GetConnectivityArray())
        ids[:] = numbers[ids]
    mesh.Modified()


def dimensions(mesh: Foreign) -> tuple[int, ...]:
    """Return the number of points of a grid along each of its axes; none of other meshes."""
    # PyVista looks for attributes that a mesh lacks among the entry points of all packages.
    if not isinstance(mesh, GRIDS):
        return ()
    low, high = np.reshape(mesh.GetExtent(), (3, 2)).T
    return tuple((high - low + 1).tolist())


def check_whole(mesh: object, name: str, where: str = "") -> None:
    """Check that arrays have a row for each point or cell, and that cells have points that exist.

    VTK ends the process where they have not. Anything but a dataset passes.
    """
    if not isinstance(mesh, vtkDataSet):
        return
    count = n_points(mesh)
    if isinstance(mesh, vtkStructuredGrid):
        # Versions of VTK count by the points or by the extent.
        there = math.prod(dimensions(mesh))
        if len(places(mesh)) != there:
            expected = f"{there} points by the extent {tuple(mesh.GetExtent())}"
            raise ValueError(where + _check.message(name, expected, str(len(places(mesh)))))
    for of, data, rows in (
        ("point", point_data(mesh), count),
        ("cell", cell_data(mesh), mesh.GetNumberOfCells()),
    ):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(i)
            if array.GetNumberOfTuples() != rows:
                expected = f"{of} arrays of {rows} rows, one per {of}"
                got = f"{array.GetName()!r} with {array.GetNumberOfTuples()}"
                raise ValueError(where + _check.message(name, expected, got, "remove the array"))
    for cells in cell_arrays(mesh):
        if cells.GetNumberOfConnectivityIds():
            ids = as_numpy(cells.GetConnectivityArray())
            # Negative numbers are large ones without a sign.
            if int(ids.view(f"u{ids.itemsize}").max()) >= count:
                expected = f"cells of the points 0 to {count - 1}"
                remedy = "the file may be cut or damaged"
                got = f"{ids.min()} to {ids.max()}"
                raise ValueError(where + _check.message(name, expected, got, remedy))
    if isinstance(mesh, vtkUnstructuredGrid) and mesh.GetNumberOfCells():
        _check_types(mesh, name, where)


def _check_types(mesh: vtkUnstructuredGrid, name: str, where: str) -> None:
    """Check that cells have the points that their types need: VTK reads beyond their ends."""
    types = as_numpy(types_of_cells(mesh))
    offsets = as_numpy(mesh.GetCells().GetOffsetsArray())
    fewest: dict[int, int] = {}
    for block in _pool.blocks(len(types), 1 << 16):
        some, sizes = types[block], np.diff(offsets[block.start : block.stop + 1])
        for kind in np.flatnonzero(np.bincount(some)).tolist():
            size = int(sizes[some == kind].min())
            fewest[kind] = min(size, fewest.get(kind, size))
    for kind, there in sorted(fewest.items()):
        least = points_of_type(kind)
        if least is None or there < least:
            expected = f"cells of type {kind} with {least} points"
            if least is None:
                expected = "cells of types that VTK has"
            got = f"one of type {kind} with {there}"
            remedy = "the file may be cut or damaged"
            raise ValueError(where + _check.message(name, expected, got, remedy))


@functools.cache
def points_of_type(kind: int) -> int | None:
    """Return the least number of points of a cell of a type, None if VTK has no such type."""
    if not kind:
        return 0
    # VTK keeps them as bytes.
    if not 0 <= kind < 256:
        return None
    cell = vtkGenericCell.InstantiateCell(kind)
    # Cells of any number of points have none at first, those of any order the corners.
    return None if cell is None else cell.GetNumberOfPoints()
