"""Several datasets as one grid with all their arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple, cast

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkGenericCell
from vtkmodules.vtkFiltersCore import vtkAppendFilter

from vizlight._types import AnyArray, Bools, Foreign, RawType
from vizlight.shading.results import record_key
from vizlight.vtk.arrays import at_points, named, points_of
from vizlight.vtk.cells import GHOSTS, as_numpy, as_vtk, cell_data, field_data, point_data
from vizlight.vtk.hull import cell_types, dimension

#: Value of a colour of bytes where a dataset has none, mid grey.
GREY = 128
#: Beginning of the names of places in textures.
TEXTURES = "TEXCOORD_"
#: Number of names that a note lists.
LISTED = 6


class Joined(NamedTuple):
    """A grid of several datasets, with notes on their arrays.

    ``filled`` has, by the name of an array, the datasets that lack it and have NaN in its place;
    ``apart`` those with an array of another number of components than most, or of words for
    numbers, which is left out.
    """

    grid: pv.UnstructuredGrid
    filled: dict[str, list[str]]
    apart: dict[str, list[str]]

    def note(self) -> str:
        """Return what a reader should know of the arrays, an empty text if there is nothing."""
        parts = []
        if self.filled:
            parts.append("blocks lack arrays and have NaN in their place: " + _listed(self.filled))
        if self.apart:
            said = "arrays of one name differ in their components, and are left out: "
            parts.append(said + _listed(self.apart))
        return "; ".join(parts)


def _listed(names: dict[str, list[str]]) -> str:
    return ", ".join(f"{name!r} ({_some(every)})" for name, every in names.items())


def _some(names: Sequence[str]) -> str:
    more = len(names) - LISTED
    return ", ".join(names[:LISTED]) + (f" and {more} more" if more > 0 else "")


def some_cells(mesh: pv.DataSet, which: Bools) -> pv.DataSet:
    """Return some cells of a mesh with their points, of the same kind of mesh; itself for all."""
    if which.all():
        return mesh
    rest: Foreign = ~which
    part: pv.DataSet = mesh.remove_cells(rest, pass_point_ids=False, pass_cell_ids=False)
    return part


def without_ghosts(mesh: pv.DataSet) -> pv.DataSet:
    """Return a mesh without the duplicate cells that its writer marked."""
    if GHOSTS in mesh.point_data:
        del mesh.point_data[GHOSTS]
    if GHOSTS not in mesh.cell_data:
        return mesh
    # The lowest bit of VTK's flags marks duplicate cells; the others, as of hidden cells, mark no
    # copies.
    kept = (np.asarray(mesh.cell_data.pop(GHOSTS)) & 1) == 0
    # A structured grid keeps all of its cells.
    return some_cells(mesh, kept) if isinstance(mesh, pv.PolyData | pv.UnstructuredGrid) else mesh


def joined(parts: Iterable[tuple[pv.DataSet, str]]) -> Joined:
    """Return one grid of all cells of some datasets, with the union of their arrays.

    The points and the cells are in the order of the datasets, each with its name; points at one
    place stay apart. Types of arrays are promoted to one that holds all values. An array is of the
    points where it is in any dataset, and cells' values are then brought to the points; it is NaN
    where a dataset has none (colours of bytes grey, words empty, marks of ghosts 0). Attributes
    that all datasets agree upon are active.
    """
    every = list(parts)
    grid = _cells([mesh for mesh, _ in every])
    found = Joined(grid, {}, {})
    names = dict.fromkeys(
        name for mesh, _ in every for data in _data(mesh) for name in _names(data)
    )
    for name in names:
        _join(found, every, name)
    for data in (point_data, cell_data):
        _activate(data(grid), [data(mesh) for mesh, _ in every if data(mesh).GetNumberOfTuples()])
    _keep_fields(grid, [mesh for mesh, _ in every])
    return found


def highest(parts: Iterable[tuple[pv.DataSet, str]]) -> list[tuple[pv.DataSet, str]]:
    """Return the cells of the highest dimension of some datasets, without datasets of none.

    Each has its name; where none has cells all are returned.
    """
    every = list(parts)
    sizes = [_dimensions(mesh) for mesh, _ in every]
    most = max((size for of in sizes for size in of.values()), default=None)
    if most is None:
        return every
    found: list[tuple[pv.DataSet, str]] = []
    for (mesh, name), of in zip(every, sizes, strict=True):
        keep = [kind for kind, size in of.items() if size == most]
        if len(keep) == len(of) and keep:
            found.append((mesh, name))
        elif keep:
            # OpenFOAM, Exodus and meshers have sides and edges beside the cells that they bound.
            types = np.asarray(mesh.cast_to_unstructured_grid().celltypes)
            cells: Foreign = np.flatnonzero(np.isin(types, keep))
            kept = mesh.extract_cells(cells, pass_point_ids=False, pass_cell_ids=False)
            found.append((kept, name))
    return found


def _dimensions(mesh: pv.DataSet) -> dict[int, int]:
    """Return the dimension of each type of cells; all cells of an image or the like have one."""
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid):
        return {-1: dimension(mesh)} if mesh.GetNumberOfCells() else {}
    return {
        kind: vtkGenericCell.InstantiateCell(kind).GetCellDimension() for kind in cell_types(mesh)
    }


def _cells(meshes: Sequence[pv.DataSet]) -> pv.UnstructuredGrid:
    """Return a grid of the points and cells of some datasets, without arrays."""
    append = vtkAppendFilter()
    # Two blocks that meet keep their own values at the places that they share.
    append.MergePointsOff()
    meshes = [mesh for mesh in meshes if mesh.GetNumberOfPoints()]
    if not meshes:
        return pv.UnstructuredGrid()
    for mesh in meshes:
        bare: Foreign = mesh.NewInstance()
        bare.CopyStructure(mesh)
        # Structured grids keep the marks of hidden cells with their structure.
        bare.GetPointData().Initialize()
        bare.GetCellData().Initialize()
        append.AddInputData(bare)
    append.Update()
    grid: pv.UnstructuredGrid = pv.wrap(append.GetOutput())
    # The filter gives float32 even for places in float64.
    places = [points_of(mesh, None)[:] for mesh in meshes]
    kind = np.result_type(np.float32, *[rows.dtype for rows in places])
    grid.SetPoints(pv.vtk_points(np.concatenate(places).astype(kind, copy=False)))
    return grid


def _data(mesh: pv.DataSet) -> tuple[Foreign, Foreign]:
    return point_data(mesh), cell_data(mesh)


def _names(data: Foreign) -> list[str]:
    """Return the names of arrays; those that have none cannot be told from one another."""
    every = (data.GetArrayName(i) for i in range(data.GetNumberOfArrays()))
    return [name for name in every if name]


def _join(found: Joined, every: Sequence[tuple[pv.DataSet, str]], name: str) -> None:
    """Attach an array of some datasets to their grid."""
    of_points = [named(point_data(mesh), name) for mesh, _ in every]
    of_cells = [named(cell_data(mesh), name) for mesh, _ in every]
    marks = name == GHOSTS
    if any(rows is not None for rows in of_points):
        moved = [
            # Where places differ all values are brought to the points; marks stay where they are.
            at_points(mesh, cells) if rows is None and cells is not None and not marks else rows
            for (mesh, _), rows, cells in zip(every, of_points, of_cells, strict=True)
        ]
        counts = [mesh.GetNumberOfPoints() for mesh, _ in every]
        _attach(found, point_data(found.grid), every, name, moved, counts)
    # Readers of OpenFOAM give a field at both: then both are kept.
    lacking = [rows for rows, own in zip(of_points, of_cells, strict=True) if own is None]
    if len(lacking) < len(every) and (marks or all(rows is None for rows in lacking)):
        counts = [mesh.GetNumberOfCells() for mesh, _ in every]
        _attach(found, cell_data(found.grid), every, name, of_cells, counts)


def _attach(
    found: Joined,
    data: Foreign,
    every: Sequence[tuple[pv.DataSet, str]],
    name: str,
    rows: Sequence[AnyArray | None],
    counts: Sequence[int],
) -> None:
    """Attach the rows of all datasets one after the other, filled where a dataset has none."""
    votes: dict[tuple[bool, tuple[int, ...]], int] = {}
    for part, count in zip(rows, counts, strict=True):
        if part is not None:
            votes[_form(part)] = votes.get(_form(part), 0) + count
    form = max(votes, key=lambda key: votes[key])
    fitting = [
        None if part is None or _form(part) != form or part.dtype == object else part
        for part in rows
    ]
    present = [part for part in fitting if part is not None]
    if not present:
        return
    for (_, path), part, fits, count in zip(every, rows, fitting, counts, strict=True):
        if fits is None and count:
            kept = found.filled if part is None else found.apart
            kept.setdefault(name, []).append(path.lstrip("/") or "mesh")
    # Places in textures show nothing here, which draws none.
    if name == GHOSTS or name.startswith(TEXTURES):
        found.filled.pop(name, None)
    whole = all(part is not None or not n for part, n in zip(fitting, counts, strict=True))
    kind, gap = _filling(name, [part.dtype for part in present], form, whole=whole)
    shape = form[1]
    joint = np.concatenate(
        [
            np.full((count, *shape), gap, dtype=kind) if part is None else part.astype(kind)
            for part, count in zip(fitting, counts, strict=True)
        ]
    )
    if joint.dtype.kind == "U":
        words: Foreign = pv.convert_array(joint, name)
        data.AddArray(words)
    else:
        data.AddArray(as_vtk(joint, name))


def _form(rows: AnyArray) -> tuple[bool, tuple[int, ...]]:
    """Return whether rows are numbers, and their number of components."""
    return rows.dtype.kind in "biuf", rows.shape[1:]


def _filling(
    name: str, kinds: Sequence[RawType], form: tuple[bool, tuple[int, ...]], *, whole: bool
) -> tuple[RawType, object]:
    """Return the type that holds all rows and what stands where none are."""
    kind = np.result_type(*kinds)
    if not form[0]:
        return kind, ""
    if name == GHOSTS or whole:
        return kind, 0
    if kind == np.uint8 and form[1] in ((3,), (4,)):
        return kind, GREY
    # Whole numbers have no NaN.
    return np.result_type(kind, np.float32), np.nan


def _activate(data: Foreign, others: Sequence[Foreign]) -> None:
    """Make those arrays active that are so in the datasets."""
    for kind in range(data.NUM_ATTRIBUTES):
        active = [other.GetAbstractAttribute(kind) for other in others]
        names = {array.GetName() for array in active if array is not None}
        # Scalars and vectors may be NaN in places; normals, weights and the like may not.
        partly = kind in (data.SCALARS, data.VECTORS)
        # By "is": arrays of VTK compare their values by "==".
        if len(names) == 1 and (partly or all(array is not None for array in active)):
            data.SetActiveAttribute(names.pop() or "", kind)


def _keep_fields(grid: pv.UnstructuredGrid, meshes: Sequence[pv.DataSet]) -> None:
    """Attach the field data that all datasets have with equal values, such as a unit."""
    if not meshes:
        return
    first, *others = map(field_data, meshes)
    for name in _names(first):
        # A record tells of the points of one dataset.
        if name.endswith(record_key("")):
            continue
        rows = as_numpy(first.GetAbstractArray(name))
        same = [named(cast("Foreign", other), name) for other in others]
        if all(other is not None and np.array_equal(other, rows) for other in same):
            field_data(grid).AddArray(first.GetAbstractArray(name))
