"""Meshes and MultiBlocks: checks, iteration over blocks, bounding box, translation, constructor."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar, cast

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import (
    vtkCompositeDataSet,
    vtkHyperTreeGrid,
    vtkMultiBlockDataSet,
)

from vizlight import _check
from vizlight._types import Array, Foreign, Indices, Vector
from vizlight.mesh import joining
from vizlight.vtk import hull
from vizlight.vtk.cells import cell_data, check_whole, field_data, has_faces, point_data
from vizlight.vtk.topology import place_numbers

#: Type of a mesh that a filter takes and returns.
MeshT = TypeVar("MeshT", bound="pv.DataSet | pv.MultiBlock")
DataSetT = TypeVar("DataSetT", bound=pv.DataSet)
_NAME = vtkCompositeDataSet.NAME()
#: Dimension of the cells of a surface.
SURFACE = 2
#: Numbers of components of arrays that are neither complex nor tensors.
_PLAIN = {1, 3}


def check(mesh: object) -> list[tuple[pv.DataSet, str]]:
    """Return the datasets with their paths; raise TypeError for anything else."""
    if not isinstance(mesh, pv.DataSet | pv.MultiBlock):
        raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__, _way(mesh)))
    named = list(named_blocks(mesh))
    for block, path in named:
        check_whole(block, "mesh", f"block {path}: " if path else "")
    return named


def outer_surface(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices]:
    """Return the outer surface; see :func:`vizlight.vtk.hull.outer_surface`."""
    surface, ids = hull.outer_surface(mesh)
    return pv.PolyData(surface), ids


def plain_surface(mesh: pv.DataSet) -> pv.PolyData:
    """Return the outer faces by VTK, with the arrays of the mesh and no more."""
    options = {"pass_pointid": False, "pass_cellid": False}
    return mesh.extract_surface(algorithm="dataset_surface", **options)


def surface(mesh: object, name: str) -> pv.PolyData:
    """Return a mesh with faces, or the outer surface of another mesh or of its blocks."""
    if isinstance(mesh, pv.MultiBlock):
        mesh = one_grid(mesh)
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message(name, "a PyVista surface", type(mesh).__name__, _way(mesh)))
    check_whole(mesh, name)
    found = mesh if isinstance(mesh, pv.PolyData) else outer_surface(mesh)[0]
    if not has_faces(found):
        got = f"a {type(mesh).__name__} mesh without faces"
        raise _check.value_error(name, "a surface with faces", got)
    return found


def _way(mesh: object) -> str:
    """Return how what is no mesh becomes one."""
    if isinstance(mesh, pv.PartitionedDataSet):
        return "pass pyvista.MultiBlock(list(mesh))"
    if isinstance(mesh, vtkHyperTreeGrid):
        return "convert it by VTK's vtkHyperTreeGridToUnstructuredGrid, and wrap its output"
    return "read files by vizlight.read, wrap VTK objects by pyvista.wrap"


def each(mesh: pv.MultiBlock, make: Callable[[pv.DataSet], pv.DataSet]) -> pv.MultiBlock:
    """Return a MultiBlock of what is made of each dataset of another."""
    return like(mesh, (make(block) for block in all_blocks(mesh)))


def one_grid(mesh: pv.MultiBlock) -> pv.UnstructuredGrid:
    """Return the cells of the highest dimension of all blocks, without side sets of a volume."""
    return highest(mesh).grid


def highest(mesh: pv.MultiBlock) -> joining.Joined:
    """Return what :func:`one_grid` does, and what became of the arrays of the blocks."""
    found = joining.joined(joining.highest(named_blocks(mesh)))
    found.grid.field_data.update(mesh.field_data)
    return found


def joined(mesh: pv.MultiBlock) -> pv.UnstructuredGrid:
    """Return all datasets as one grid."""
    grid = joining.joined(named_blocks(mesh)).grid
    grid.field_data.update(mesh.field_data)
    return grid


def by_dimension(mesh: pv.MultiBlock) -> list[pv.MultiBlock]:
    """Return the blocks of each dimension of cells, the highest first.

    Surfaces without data are apart from others, since they may lie around them. Those at the points
    of volumes are mostly their walls, which would hide them, and are left out; so are lines between
    the points of a plane mesh, such as those of its inlet.
    """
    parts: dict[tuple[int, bool], pv.MultiBlock] = {}
    for block, path in named_blocks(mesh):
        if block.n_points:
            size = int(block.max_cell_dimensionality) if block.n_cells else 0
            is_bare = size == SURFACE and not _has_data(block)
            part = parts.setdefault((-size, is_bare), pv.MultiBlock())
            part.append(block, path.lstrip("/"))
    highest = max((-size for size, _ in parts), default=0)
    whole = pv.MultiBlock([it for key, part in parts.items() if -key[0] == highest for it in part])
    if highest > SURFACE or (highest == SURFACE and min(whole.bounds_size) == 0):
        for key in [key for key in parts if -key[0] == highest - 1]:
            parts[key] = _without_bounds(parts[key], whole)
    # A point beside others is a reference of a body.
    parts = {key: part for key, part in parts.items() if -key[0] == highest or part.length}
    for part in parts.values():
        part.field_data.update(mesh.field_data)  # such as the time of a step
    return [parts[key] for key in sorted(parts) if parts[key].n_blocks]


def _has_data(block: pv.DataSet) -> bool:
    """Return whether a block has an array that is no normals and no places in a texture."""
    data = block.point_data
    of_light = {data.active_normals_name, data.active_texture_coordinates_name}
    names = {*data, *block.cell_data} - of_light - {block.cell_data.active_normals_name}
    return any(not name.startswith("vtk") for name in names)


def _without_bounds(part: pv.MultiBlock, whole: pv.MultiBlock) -> pv.MultiBlock:
    """Return the blocks of a part without those that lie mostly at the points of another."""
    every = [np.asarray(block.points, np.float32) for block in [*whole, *part]]
    numbers = place_numbers(np.concatenate(every))
    of_blocks = np.split(numbers, np.cumsum([len(points) for points in every])[:-1])
    inner = np.concatenate(of_blocks[: whole.n_blocks])
    kept = pv.MultiBlock()
    for i, ids in enumerate(of_blocks[whole.n_blocks :]):
        if np.isin(ids, inner).mean() < 1 / 2:
            kept.append(part[i], part.get_block_name(i))
    return kept


def all_blocks(mesh: object) -> Iterator[pv.DataSet]:
    """Yield the datasets of a MultiBlock at every depth, or the dataset itself."""
    if not isinstance(mesh, pv.MultiBlock):
        yield from (block for block, _ in named_blocks(mesh))
        return
    # Without the names, which take as long as the blocks.
    for block in (_block(mesh, i) for i in range(mesh.n_blocks)):
        if isinstance(block, pv.DataSet):
            yield block
        elif block is not None:
            yield from all_blocks(block)


def named_blocks(mesh: object, path: str = "") -> Iterator[tuple[pv.DataSet, str]]:
    """Yield the datasets of a MultiBlock at every depth, each with its path."""
    if isinstance(mesh, pv.DataSet):
        yield mesh, path
        return
    if not isinstance(mesh, pv.MultiBlock):
        with _check.in_block(path):
            raise TypeError(_check.message("mesh", "a PyVista mesh", type(mesh).__name__))
    for i in range(mesh.n_blocks):
        if (block := _block(mesh, i)) is not None:
            # By the key: VTK's method of the information tries the types of all keys.
            own = f"{path}/{_NAME.Get(vtkMultiBlockDataSet.GetMetaData(mesh, i)) or i}"
            # Without a generator for each of many blocks.
            if isinstance(block, pv.DataSet):
                yield block, own
            else:
                yield from named_blocks(block, own)


def _block(mesh: pv.MultiBlock, i: int) -> object:
    """Return a block as PyVista does, without its look-up where it has wrapped the block."""
    block = vtkMultiBlockDataSet.GetBlock(mesh, i)
    return block if block is None or isinstance(block, pv.DataObject) else mesh[i]


def like(mesh: MeshT, made: Iterator[pv.DataSet]) -> MeshT:
    """Return the next of some datasets for a dataset, a MultiBlock of them for a MultiBlock."""
    if not isinstance(mesh, pv.MultiBlock):
        return cast("MeshT", next(made))
    out = type(mesh)()
    # Names and structure at once; one by one they take longer than the light of a small block.
    out.CopyStructure(mesh)
    for i in range(mesh.n_blocks):
        block = _block(mesh, i)
        if isinstance(block, pv.MultiBlock):
            out.SetBlock(i, like(block, made))
        elif block is not None:
            out.SetBlock(i, next(made))
    out.field_data.update(mesh.field_data)
    return out


def placed(
    mesh: MeshT, made: Sequence[pv.DataSet], *, inplace: bool
) -> tuple[MeshT, list[pv.DataSet]]:
    """Return a mesh of what was made of its datasets, and these.

    With ``inplace`` the mesh itself takes them; else those that are the mesh's own are copied.
    """
    own = list(all_blocks(mesh))
    if not inplace:
        lit = [_copied(new) if new is old else new for new, old in zip(made, own, strict=True)]
        return like(mesh, iter(lit)), lit
    for new, old in zip(made, own, strict=True):
        if new is not old:
            old.ShallowCopy(new)
    return mesh, own


def _copied(mesh: DataSetT) -> DataSetT:
    """Return a copy, by VTK alone where PyVista has nothing to remember beside the data.

    It remembers which arrays hold truth values or complex numbers, stored as bytes and pairs, and
    which of the points' and the cells' arrays are active.
    """
    bare = isinstance(mesh, pv.PolyData | pv.UnstructuredGrid)
    if not bare or cell_data(mesh).GetNumberOfArrays():
        return mesh.copy()
    for data in (point_data(mesh), field_data(mesh)):
        for i in range(data.GetNumberOfArrays()):
            array = data.GetAbstractArray(i)
            if array.GetNumberOfComponents() not in _PLAIN or array.GetDataTypeSize() == 1:
                return mesh.copy()
    made = type(mesh)()
    made.DeepCopy(mesh)
    return made


def isosurface(mesh: pv.DataSet, name: str, *levels: float) -> pv.PolyData:
    """Return isosurfaces where they belong: VTK forgets in which directions the rows run."""
    if not isinstance(mesh, pv.ImageData) or np.allclose(mesh.direction_matrix, np.eye(3)):
        found: pv.PolyData = mesh.contour(levels, scalars=name)
        return found
    turned = np.asarray(mesh.direction_matrix, dtype=np.float64)
    straight = mesh.copy(deep=False)
    straight.direction_matrix = np.eye(3)
    found = straight.contour(levels, scalars=name)
    if found.n_points:
        origin = np.asarray(mesh.origin)
        places = (np.asarray(found.points, dtype=np.float64) - origin) @ turned.T + origin
        found.points = places.astype(found.points.dtype)
    return found


def box(mesh: pv.DataSet) -> tuple[Array, float]:
    """Return the centre of the bounding box of a mesh and its longest side.

    Points that are not finite are ignored. The side is 1 if the mesh has no extent.
    """
    low, high = np.reshape(mesh.bounds, (3, 2)).T
    # VTK's bounds leave out NaN, but one infinite point spoils them.
    if not np.all(np.isfinite([low, high])) and isinstance(mesh, pv.PointSet | pv.PolyData):
        points = np.asarray(mesh.points, dtype=np.float64)
        points = points[np.all(np.isfinite(points), axis=1)]
        low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    # Halves first: the difference of two huge coordinates would be infinite.
    side = float(np.max(high / 2 - low / 2)) * 2
    if not (np.isfinite(side) and side > 0):
        return np.nan_to_num(low / 2 + high / 2, posinf=0.0, neginf=0.0), 1.0
    return low / 2 + high / 2, side


def near_origin(mesh: pv.DataSet) -> Vector:
    """Return an origin relative to which float32 resolves the points of a mesh.

    It is the centre of the mesh if that is farther from 0 than the longest side, else 0.
    """
    # float32 rounds by a share of the distance from 0: far away a small mesh has few digits.
    middle, side = box(mesh)
    far = np.abs(middle).max() > side
    return tuple(float(x) if far else 0.0 for x in middle)


def moved(mesh: DataSetT, offset: Array, scale: float | Array = 1.0) -> DataSetT:
    """Return a mesh with each point p at ``scale (p + offset)``, in float64."""
    out: Foreign = mesh.copy(deep=False)
    scale = np.broadcast_to(scale, 3)
    turned = isinstance(out, pv.ImageData) and not np.array_equal(out.direction_matrix, np.eye(3))
    if turned and np.ptp(scale):
        # The axes of a turned image that is stretched along one of space are at right angles no
        # more.
        out = out.cast_to_structured_grid()
    # Images and rectilinear grids stay such, since they have axes in place of points.
    if isinstance(out, pv.ImageData):
        out.origin = tuple(scale * (np.array(out.origin) + offset))
        out.spacing = tuple(scale * np.array(out.spacing))
    elif isinstance(out, pv.RectilinearGrid):
        for i, axis in enumerate("xyz"):
            ticks = np.asarray(getattr(out, axis), dtype=np.float64)
            setattr(out, axis, scale[i] * (ticks + offset[i]))
    else:
        points = scale * (np.asarray(mesh.points, dtype=np.float64) + offset)
        # Infinite points become NaN: all points without a place are alike.
        points[~np.isfinite(points)] = np.nan
        # Assigning to out.points would move the points that the shallow copy shares with the mesh.
        out.SetPoints(pv.vtk_points(points))
    return cast("DataSetT", out)


def structured(points: Array, dimensions: Sequence[int]) -> pv.StructuredGrid:
    """Return a grid with points in the order of VTK, along its first axis first."""
    grid = pv.StructuredGrid()
    grid.dimensions = dimensions
    grid.points = points
    return grid


def polydata(points: Array, cells: Indices) -> pv.PolyData:
    """Return a mesh of cells of 1 to 4 points each; a row of ``cells`` has the points of a cell."""
    mesh = pv.PolyData()
    mesh.points = points
    made = pv.CellArray.from_regular_cells(np.asarray(cells, dtype=int))
    (mesh.SetVerts, mesh.SetLines, mesh.SetPolys, mesh.SetPolys)[cells.shape[1] - 1](made)
    return mesh


def cell_array(ids: Indices, ends: Indices) -> pv.CellArray:
    """Return cells, given their corners, one cell after the other, and where each begins."""
    return pv.CellArray.from_arrays(np.asarray(ends, dtype=int), np.asarray(ids, dtype=int))


def is_too_far(mesh: pv.DataSet) -> bool:
    """Return whether a mesh has a coordinate beyond the largest."""
    low, high = np.reshape(mesh.bounds, (3, 2)).T
    # Points that are not finite have no bounds: the lower one is then above the upper one.
    return bool(np.any((low <= high) & (np.maximum(-low, high) > _check.FARTHEST)))
