"""Small datasets of one kind as one dataset, since a call for each costs more than its points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from vizlight._types import Dataset, Foreign, Indices
from vizlight.vtk import hull, polylines
from vizlight.vtk.cells import (
    POLYDATA,
    as_numpy,
    as_vtk,
    connectivity,
    grid_cells,
    has_marks,
    n_points,
    new_points,
    point_data,
    vtk_points,
)

#: Number of points up to which a dataset is joined with others, and of all that are joined: the
#: directions of pieces are found from all normals only of so few.
SMALL, MOST = 1 << 12, 1 << 15
#: Largest ratio of sizes of datasets that are joined: their squares and cubes are numbers, too.
RATIO = 1e30
#: Number of points of a segment.
SEGMENT = 2
#: Name of the active normals of datasets that are joined, chosen not to clash with a user's array.
ACTIVE = "vizlight active normals"


class Batch(NamedTuple):
    """Several datasets as one.

    The mesh has the arrays that are needed, ``numbers`` are those of the datasets, ``ends`` has the
    first point of each and the end of the last, and ``block`` the place in ``numbers`` of the
    dataset of each point. Results of all may be kept as long as the points of ``owner``, the first
    dataset.
    """

    mesh: Dataset
    numbers: list[int]
    ends: Indices
    block: Indices
    owner: vtkPolyData | None


def batches(
    meshes: Mapping[int, Dataset], names: Sequence[str], kept: Sequence[str] = ()
) -> Iterator[Batch]:
    """Yield those of some datasets, by their numbers, that go together.

    ``names`` are the point arrays that are needed, beside the active normals; a dataset with an
    array of ``kept`` stays alone.
    """
    groups: dict[object, list[list[_Member]]] = {}
    room: dict[object, int] = {}
    for number, mesh in meshes.items() if len(meshes) > 1 else ():
        kind, member = _kind(number, mesh, names, kept)
        if member is None:
            continue
        size = n_points(mesh)
        if room.get(kind, 0) < size:
            groups.setdefault(kind, []).append([])
            room[kind] = MOST
        groups[kind][-1].append(member)
        room[kind] -= size
    every = [members for group in groups.values() for members in group if len(members) > 1]
    groups.clear()
    # One at a time, in the memory of the one before.
    while every:
        if (batch := _joined(every.pop(0), names)) is not None:
            yield batch


class _Member(NamedTuple):
    """A dataset, by its number, with the cells of each kind, its points, normals and arrays.

    Python's objects of arrays are made anew by each call that gives one, unless they are held.
    """

    number: int
    mesh: Foreign
    cells: list[vtkCellArray]
    points: Foreign
    normals: Foreign
    arrays: list[Foreign]


def _kind(
    number: int, mesh: Foreign, names: Sequence[str], kept: Sequence[str]
) -> tuple[object, _Member | None]:
    """Return the key that datasets to be joined have in common, None for one that stays alone."""
    data = point_data(mesh)
    bare = not data.GetNumberOfArrays()
    if not 0 < n_points(mesh) <= SMALL or not (bare or all(not data.HasArray(x) for x in kept)):
        return None, None
    if isinstance(mesh, vtkPolyData):
        cells = [get_cells(mesh) for count, get_cells in POLYDATA if count(mesh)]
        kind = _of_surface(mesh)
    elif isinstance(mesh, vtkUnstructuredGrid):
        cells, kind = [grid_cells(mesh)], _of_grid(mesh)
    else:
        return None, None
    arrays = [data.GetArray(name) for name in names]
    # Arrays of VTK compare value by value, also with None.
    if kind is None or any(array is None for array in arrays):
        return None, None
    points, normals = vtk_points(mesh).GetData(), data.GetNormals()
    forms = [
        None if array is None else (array.GetDataType(), array.GetNumberOfComponents())
        for array in (points, normals, *arrays)
    ]
    return (kind, *forms), _Member(number, mesh, cells, points, normals, arrays)


def _of_surface(mesh: vtkPolyData) -> object:
    """Return the sizes of the cells of a surface or of lines, None for several kinds of cells."""
    sizes = [cells(mesh).IsHomogeneous() if count(mesh) else 0 for count, cells in POLYDATA]
    verts, lines, *faces = sizes
    if any(faces):
        return None if verts or lines else tuple(sizes)
    # Segments are joined to lines where a dataset has some, so that all or none have some.
    if not lines or (lines < 0 and SEGMENT in np.diff(connectivity(mesh.GetLines())[1])):
        return None
    return verts > 0, lines == SEGMENT


def _of_grid(mesh: vtkUnstructuredGrid) -> object:
    """Return the type of the cells of a grid, None for several types, curved cells or lines."""
    kinds = hull.cell_types(mesh)
    kind = min(kinds, default=0)
    thin = polylines.LINES | polylines.POINTS
    others = len(kinds) != 1 or kind in thin or hull.is_curved(mesh)
    return None if others or has_marks(mesh) else kind


def _joined(members: Sequence[_Member], names: Sequence[str]) -> Batch | None:
    """Return datasets of one kind as one.

    None where their sizes differ too much, or some of their normals have no direction.
    """
    parts = [as_numpy(member.points) for member in members]
    ends = np.cumsum([0, *map(len, parts)])
    points, first = np.concatenate(parts), ends[:-1]
    with np.errstate(all="ignore"):
        sizes = np.maximum.reduceat(points, first) - np.minimum.reduceat(points, first)
        size = sizes.max(axis=1).astype(np.float64)
        # Written so that NaN differs, too.
        alike = size.max() <= RATIO * np.min(size, where=size > 0, initial=np.inf)
    model = members[0]
    rows = np.ones((1, 3))
    if model.normals is not None:
        rows = np.concatenate([as_numpy(member.normals) for member in members])
    # Where some have no direction those of the faces stand in their place.
    if not alike or not np.isfinite(rows).all() or not rows.any(axis=1).all():
        return None
    whole: Foreign = vtkPolyData() if isinstance(model.mesh, vtkPolyData) else vtkUnstructuredGrid()
    whole.SetPoints(new_points(points))
    by_kind = zip(*(member.cells for member in members), strict=True)
    cells = [_cells(of_kind, first) for of_kind in by_kind]
    if isinstance(model.mesh, vtkPolyData):
        puts = whole.SetVerts, whole.SetLines, whole.SetPolys, whole.SetStrips
        there = [put for (count, _), put in zip(POLYDATA, puts, strict=True) if count(model.mesh)]
        for put, of_kind in zip(there, cells, strict=True):
            put(of_kind)
    else:
        whole.SetCells(model.mesh.GetCellType(0), *cells)
    for i, name in enumerate(names):
        array = np.concatenate([as_numpy(member.arrays[i]) for member in members])
        point_data(whole).AddArray(as_vtk(array, name))
    if model.normals is not None:
        point_data(whole).SetNormals(as_vtk(rows, ACTIVE))
    numbers = [member.number for member in members]
    owner = model.mesh if isinstance(model.mesh, vtkPolyData) else None
    return Batch(whole, numbers, ends, np.repeat(np.arange(len(members)), np.diff(ends)), owner)


def _cells(parts: Sequence[vtkCellArray], first: Indices) -> vtkCellArray:
    """Return the cells of several datasets, with points that begin at some places, as one."""
    joined = vtkCellArray()
    ids = [as_numpy(cells.GetConnectivityArray()) for cells in parts]
    start = np.repeat(first, [len(each) for each in ids])
    corners = as_vtk(np.concatenate(ids) + start)
    size, *others = {cells.IsHomogeneous() for cells in parts}
    if size > 0 and not others:
        joined.SetData(size, corners)
        return joined
    sizes = [np.diff(as_numpy(cells.GetOffsetsArray())) for cells in parts]
    joined.SetData(as_vtk(np.cumsum(np.append(0, np.concatenate(sizes)))), corners)
    return joined
