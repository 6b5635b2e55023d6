"""Small datasets of one kind as one dataset, since a call for each costs more than its points."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData, vtkUnstructuredGrid

from vizlight.vtk import hull, polylines
from vizlight.vtk.cells import (
    GHOSTS,
    POLYDATA,
    as_numpy,
    as_vtk,
    cell_data,
    connectivity,
    grid_cells,
    point_data,
    vtk_points,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from vizlight._types import Dataset, Foreign, Indices

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

    Attributes
    ----------
    mesh : vtkDataSet
        All of them, with the arrays that are needed.
    numbers : list of int
        Numbers of the datasets.
    ends : ndarray of int
        First point of each, and the end of the last.
    block : ndarray of int, shape (n_points,)
        Place in ``numbers`` of the dataset of each point.
    """

    mesh: Dataset
    numbers: list[int]
    ends: Indices
    block: Indices


def batches(
    meshes: Mapping[int, Dataset], names: Sequence[str], kept: Sequence[str] = ()
) -> list[Batch]:
    """Return those of some datasets, by their numbers, that go together.

    Parameters
    ----------
    meshes : dict of int to vtkDataSet
    names : sequence of str
        Names of the point arrays that are needed, beside the active normals.
    kept : sequence of str
        Names of point arrays with which a dataset stays alone.
    """
    groups: dict[object, list[list[int]]] = {}
    room: dict[object, int] = {}
    for number, mesh in meshes.items() if len(meshes) > 1 else ():
        kind = _kind(mesh, names, kept)
        if kind is None:
            continue
        size = mesh.GetNumberOfPoints()
        if room.get(kind, 0) < size:
            groups.setdefault(kind, []).append([])
            room[kind] = MOST
        groups[kind][-1].append(number)
        room[kind] -= size
    every = [numbers for group in groups.values() for numbers in group if len(numbers) > 1]
    made = [_joined(meshes, numbers, names) for numbers in every]
    return [batch for batch in made if batch is not None]


def _kind(mesh: Foreign, names: Sequence[str], kept: Sequence[str]) -> object:
    """Return what datasets that are joined have in common, None for one that stays alone."""
    if not 0 < mesh.GetNumberOfPoints() <= SMALL:
        return None
    data = point_data(mesh)
    if any(data.HasArray(name) for name in kept):
        return None
    if isinstance(mesh, vtkPolyData):
        cells: object = _of_surface(mesh)
    elif isinstance(mesh, vtkUnstructuredGrid):
        cells = _of_grid(mesh)
    else:
        cells = None
    arrays = [data.GetArray(name) for name in names]
    if cells is None or None in arrays:
        return None
    arrays += [vtk_points(mesh).GetData(), data.GetNormals()]
    forms = [a and (a.GetDataType(), a.GetNumberOfComponents()) for a in arrays]
    return (cells, *forms)


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
    hidden = any(data(mesh).HasArray(GHOSTS) for data in (point_data, cell_data))
    return None if hidden or len(kinds) != 1 or kind in thin or hull.is_curved(mesh) else kind


def _joined(
    every: Mapping[int, Foreign], numbers: list[int], names: Sequence[str]
) -> Batch | None:
    """Return datasets of one kind as one.

    None where their sizes differ too much, or some of their normals have no direction.
    """
    meshes = [every[number] for number in numbers]
    parts = [as_numpy(vtk_points(mesh).GetData()) for mesh in meshes]
    ends = np.cumsum([0, *map(len, parts)])
    points, first = np.concatenate(parts), ends[:-1]
    with np.errstate(all="ignore"):
        sizes = np.maximum.reduceat(points, first) - np.minimum.reduceat(points, first)
        size = sizes.max(axis=1).astype(np.float64)
        # Written so that NaN differs, too.
        alike = size.max() <= RATIO * np.min(size, where=size > 0, initial=np.inf)
    model = meshes[0]
    normals = point_data(model).GetNormals()
    rows = np.zeros((0, 3))
    if normals is not None:
        rows = np.concatenate([as_numpy(point_data(mesh).GetNormals()) for mesh in meshes])
    # Where some have no direction those of the faces stand in their place.
    if not alike or not np.isfinite(rows).all() or not rows.any(axis=1).all():
        return None
    whole: Foreign = vtkPolyData() if isinstance(model, vtkPolyData) else vtkUnstructuredGrid()
    own = vtkPoints()
    own.SetData(as_vtk(points))
    whole.SetPoints(own)
    if isinstance(model, vtkPolyData):
        puts = whole.SetVerts, whole.SetLines, whole.SetPolys, whole.SetStrips
        for (count, cells), put in zip(POLYDATA, puts, strict=True):
            if count(model):
                put(_cells([cells(mesh) for mesh in meshes], first))
    else:
        cells_of_all = _cells([grid_cells(mesh) for mesh in meshes], first)
        whole.SetCells(model.GetCellType(0), cells_of_all)
    for name in names:
        arrays = [as_numpy(point_data(mesh).GetArray(name)) for mesh in meshes]
        point_data(whole).AddArray(as_vtk(np.concatenate(arrays), name))
    if normals is not None:
        point_data(whole).SetNormals(as_vtk(rows, ACTIVE))
    return Batch(whole, numbers, ends, np.repeat(np.arange(len(meshes)), np.diff(ends)))


def _cells(parts: Sequence[vtkCellArray], first: Indices) -> vtkCellArray:
    """Return the cells of several datasets, whose points begin at some places, as one."""
    found = vtkCellArray()
    ids = [as_numpy(cells.GetConnectivityArray()) for cells in parts]
    start = np.repeat(first, [len(own) for own in ids])
    corners = as_vtk(np.concatenate(ids) + start)
    size, *others = {cells.IsHomogeneous() for cells in parts}
    if size > 0 and not others:
        found.SetData(size, corners)
        return found
    sizes = [np.diff(as_numpy(cells.GetOffsetsArray())) for cells in parts]
    found.SetData(as_vtk(np.cumsum(np.append(0, np.concatenate(sizes)))), corners)
    return found
