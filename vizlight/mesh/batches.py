"""Small meshes of like arrays, joined to one mesh, so that many are lit at the cost of one."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkUnstructuredGrid
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkAppendPolyData

from vizlight.mesh import normals, splitting
from vizlight.vtk import parts, polylines
from vizlight.vtk.cells import (
    GHOSTS,
    POLYDATA,
    as_numpy,
    cell_data,
    connectivity,
    point_count,
    point_data,
    vtk_points,
)

if TYPE_CHECKING:
    Key: TypeAlias = tuple[object, ...]
    from collections.abc import Iterable, Sequence

    from vizlight._types import Foreign, Indices
    from vizlight.scene import Scene
    from vizlight.shading.inputs import ShadingInputs
    from vizlight.shading.options import LightOptions
    from vizlight.vtk.normals import Sided, Told
    from vizlight.vtk.parts import Part


#: Largest number of points of a mesh that is joined with others, and of what they are joined to.
SMALL, LARGEST = 1 << 12, 1 << 18
#: Arrays that an earlier result keeps with a mesh; what they hold is of that mesh alone.
_KEPT = (normals.KEPT, splitting.TANGENTS)

#: Types of the cells of grids that are joined: all linear ones but lines and polyhedra.
_JOINED = frozenset(range(1, 17)) - polylines.LINES


class Batch(NamedTuple):
    """One mesh that is lit in place of some.

    Attributes
    ----------
    mesh : pyvista.DataSet
        Mesh that is lit; without ``starts`` the only member itself.
    members : list of int
        Numbers of the meshes.
    starts : ndarray of int, shape (len(members) + 1,), or None
        First point of each member in the mesh, followed by the number of its points.
    """

    mesh: pv.DataSet
    members: list[int]
    starts: Indices | None = None


def parts_of(
    meshes: Sequence[pv.DataSet],
    paths: Sequence[str],
    scene: Scene,
    options: LightOptions,
    *,
    join: bool,
    known: Sequence[Sided | None] = (),
    told: Told | None = None,
) -> tuple[list[Batch], list[Part]]:
    """Return what meshes are lit by, small ones joined; an error names the path of a mesh.

    ``known`` are the normals of their surfaces, of those where they were computed already, and
    ``told`` is what the whole decides of the sides of a single mesh that is a part of it.
    """
    # A thousand small blocks cost a thousand calls of VTK; joined they cost one.
    groups = _batches(meshes, options) if join else _alone(meshes, range(len(meshes)))
    made, parts = [], []
    while groups:
        group = groups.pop()
        first = group.members[0]
        own = known[first] if known and group.starts is None else None
        try:
            part = part_of(group.mesh, paths[first], scene, options, group.starts, own, told)
        except (TypeError, ValueError):
            if group.starts is None:
                raise
            # One by one they tell which of them is wrong.
            groups += _alone(meshes, group.members)
            continue
        sided = part.sided
        # Some of the meshes may have two sides, which only counts without a view.
        differ = sided is not None and sided.any_open and not np.all(sided.open)
        # Without a view open and closed surfaces are lit differently: each must be asked alone.
        if group.starts is not None and scene.view is None and differ:
            groups += _alone(meshes, group.members)
            continue
        made.append(group)
        parts.append(part)
    return made, parts


def _alone(meshes: Sequence[pv.DataSet], members: Iterable[int]) -> list[Batch]:
    """Return some meshes as batches of one, the last one first."""
    return [Batch(meshes[i], [i]) for i in reversed(list(members))]


def split(groups: Sequence[Batch], of_groups: Sequence[Foreign]) -> list[Foreign]:
    """Return what belongs to each mesh, from what belongs to each batch.

    Its ``part`` takes the number of a member in the batch, and its points.
    """
    found: dict[int, Foreign] = {}
    for group, whole in zip(groups, of_groups, strict=True):
        if group.starts is None or whole is None:
            found |= dict.fromkeys(group.members, whole)
            continue
        ends = group.starts.tolist()
        for i, (member, start, stop) in enumerate(
            zip(group.members, ends[:-1], ends[1:], strict=True)
        ):
            found[member] = whole.part(i, slice(start, stop))
    return [found[i] for i in range(len(found))]


def _batches(meshes: Sequence[pv.DataSet], options: LightOptions) -> list[Batch]:
    """Return small meshes of like arrays joined, and all others by themselves, the last one first.

    Points of two meshes stay apart, also at one place: what depends on neighbours is to be told
    of ``starts``.
    """
    found: dict[Key, list[int]] = {}
    size: dict[Key, int] = {}
    alone, made = [], []
    # Values that are passed without a name belong to one mesh and cannot be joined.
    names = _names(options) if len(meshes) > 1 else None
    for i, mesh in enumerate(meshes):
        key = None if names is None else _key(mesh, names)
        if key is None:
            alone.append(i)
            continue
        count = point_count(mesh)
        size[key] = size.get(key, 0) + count
        # A full batch is closed and a new one begun.
        if size[key] > LARGEST:
            made.append(_joined(meshes, found.pop(key), names or ()))
            size[key] = count
        found.setdefault(key, []).append(i)
    made += [_joined(meshes, members, names or ()) for members in found.values()]
    return made + _alone(meshes, alone)


def _names(options: LightOptions) -> list[str] | None:
    """Return the names of the arrays that light depends on, None if one of them has no name."""
    conditioned = options.conditioned if isinstance(options.conditioned, str) else None
    given = [
        options.tangents, options.positions, options.normals, conditioned, options.occlusion
    ]  # fmt: skip
    given = [name for name in given if name is not None]
    names = [name for name in given if isinstance(name, str)]
    return names if len(names) == len(given) else None


def _key(mesh: pv.DataSet, names: Sequence[str]) -> Key | None:
    """Return what a mesh must have in common with those it is joined with, None for no others."""
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid):
        return None
    if not 0 < point_count(mesh) <= SMALL:
        return None
    data = point_data(mesh)
    if any(data.HasArray(name) for name in _KEPT):
        return None
    kinds = _kinds(mesh)
    arrays = [data.GetArray(name) for name in names]
    if kinds is None or any(array is None for array in arrays):
        return None
    arrays += [vtk_points(mesh).GetData()]
    if (carried := data.GetNormals()) is not None:
        arrays.append(carried)
    # VTK appends arrays only if name, type and number of components agree.
    forms = ((a.GetName(), a.GetDataType(), a.GetNumberOfComponents()) for a in arrays)
    return (*kinds, *forms)


def _kinds(mesh: pv.PolyData | pv.UnstructuredGrid) -> Key | None:
    """Return the kinds of the cells of a mesh, None for a mesh that cannot be joined."""
    if isinstance(mesh, pv.PolyData):
        verts, lines, polys, strips = (count(mesh) > 0 for count, _ in POLYDATA)
        if strips:
            return None
        # Where there are segments, lines are joined at their ends.
        segments = lines and 2 in np.diff(connectivity(mesh.GetLines())[1])
        return ("polydata", verts, lines, polys, segments)
    if cell_data(mesh).HasArray(GHOSTS) or point_data(mesh).HasArray(GHOSTS):
        return None
    kinds = as_numpy(vtkUnstructuredGrid.GetDistinctCellTypesArray(mesh)).tolist()
    return ("grid", *kinds) if kinds and _JOINED.issuperset(kinds) else None


def _joined(meshes: Sequence[pv.DataSet], members: list[int], names: Iterable[str]) -> Batch:
    """Return some meshes of one key as one mesh."""
    if len(members) == 1:
        return Batch(meshes[members[0]], members)
    own: list[Foreign] = [meshes[i] for i in members]
    starts = np.concatenate([[0], np.cumsum([point_count(mesh) for mesh in own])])
    surfaces = isinstance(own[0], pv.PolyData)
    append = vtkAppendPolyData() if surfaces else vtkAppendFilter()
    for mesh in own:
        # Only what light depends on is copied.
        bare = vtkPolyData() if surfaces else vtkUnstructuredGrid()
        bare.CopyStructure(mesh)
        for name in names:
            bare.GetPointData().AddArray(point_data(mesh).GetArray(name))
        bare.GetPointData().SetNormals(point_data(mesh).GetNormals())
        append.AddInputData(bare)
    append.Update()
    return Batch(pv.wrap(append.GetOutput()), members, starts)


def inputs_of(mesh: pv.DataSet, path: str, scene: Scene, options: LightOptions) -> ShadingInputs:
    """Return the inputs of the engine from one mesh; see :func:`part_of`."""
    return part_of(mesh, path, scene, options).inputs


def part_of(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    starts: Indices | None = None,
    known: Sided | None = None,
    told: Told | None = None,
) -> Part:
    """Return what one mesh is lit by; see :func:`vizlight.vtk.parts.part_of`.

    ``known`` are normals of its surface that were computed already, and ``told`` is what a whole
    decides of its sides.
    """
    part = parts.part_of(
        mesh,
        path,
        scene,
        options,
        kept_normals=normals.kept if known is None else lambda _: known,
        kept_tangents=splitting.kept_tangents,
        starts=starts,
        told=told,
    )
    cells = lambda: splitting.simplices(mesh)  # noqa: E731
    return part._replace(inputs=dataclasses.replace(part.inputs, cells=cells))
