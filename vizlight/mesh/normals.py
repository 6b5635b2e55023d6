"""Normals of a mesh: those that stay with it, and points that are split at its sharp edges.

Faces with points of their own are welded first; then sharp edges are those of the surface.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from typing import Literal, TypeVar

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, FeatureAngle, Foreign, Indices, Raw
from vizlight.geometry.lines.simplices import Simplices
from vizlight.mesh import blocks, records
from vizlight.model import kernels
from vizlight.scene import Scene, View
from vizlight.shading.inputs import ArraySource
from vizlight.shading.options import LightOptions
from vizlight.vtk import normals as vtk_normals
from vizlight.vtk.batches import SMALL, batches
from vizlight.vtk.cells import (
    cell_arrays,
    connectivity,
    faces_only,
    first_twins,
    has_faces,
    n_points,
    places,
    point_data,
    renumber_corners,
    triangles,
)
from vizlight.vtk.corners import MANY_SHARP, SHARP, numbered, split_faces
from vizlight.vtk.parts import Part
from vizlight.vtk.topology import coincident, place_numbers

MeshT = TypeVar("MeshT", bound=pv.DataSet)
SurfaceT = TypeVar("SurfaceT")

#: Name of the point array in which normals that had to be computed stay with a result: three
#: components of the normal, its lean, and its number of ``Sided.open``.
KEPT = "vizlight_normals"
#: Share of sharp edges from which normals that a mesh has smear it, as they do a box.
SMEARED = 0.25
#: Share of the spacing between points to which they may be rounded without a warning.
ROUNDED = 0.05
#: Number of points from which normals are kept. Normals of smaller meshes are computed for many at
#: once, sooner than what is kept is checked.
FEWEST = 256
#: Numbers of meshes, and of triangles of each, whose normals are compared with the faces, and share
#: of the area from which they contradict them.
MOST_MESHES, MOST_FACES, CONTRADICT = 16, 4096, 0.25
#: Kinds of meshes that normals stay with.
_KINDS = pv.PolyData | pv.UnstructuredGrid


def are_computed(mesh: pv.DataSet, options: LightOptions) -> bool:
    """Return whether the normals of a mesh are computed from its surface, not an array."""
    return options.normals is None and mesh.point_data.active_normals is None


def compute_ahead(meshes: Iterable[pv.DataSet]) -> None:
    """Compute the normals of small surfaces together, which are then known where each needs them.

    See :mod:`vizlight.vtk.batches`.
    """
    surfaces = {
        i: mesh
        for i, mesh in enumerate(meshes)
        if isinstance(mesh, pv.PolyData) and point_data(mesh).GetNormals() is None
    }
    for batch in batches(surfaces, (), (KEPT,)):
        if not has_faces(surfaces[batch.numbers[0]]):
            continue
        sided = vtk_normals.computed_normals(batch.mesh, block=batch.block, owner=batch.owner)
        for i, number in enumerate(batch.numbers):
            vtk_normals.remember(surfaces[number], sided.of_block(i, slice(*batch.ends[i : i + 2])))


def normals_of(
    mesh: pv.DataSet, value: object, n: int, view: View | None, *, warn: bool = False
) -> Array:
    """Return normals that agree on a side: those in ``value``, of the mesh, or of its surface.

    Normals of the surface point outward on closed and nearly closed pieces, else as a whole to the
    eye and away from the centroid. With ``warn`` a warning is given if they were averaged across
    many sharp edges.
    """
    given = vtk_normals.given_normals(mesh, value, n)
    if given is not None:
        return given
    # Those of a surface without a view are kept, and closed pieces have the same ones.
    surface = mesh if isinstance(mesh, pv.PolyData) else None
    sided = None if surface is None or view is None else vtk_normals.known_normals(surface)
    if sided is None or (view is not None and sided.any_open):
        sided = vtk_normals.computed_normals(mesh, view=view, sides=warn or surface is not None)
        if surface is not None and not sided.any_open:
            vtk_normals.remember(surface, sided)
    if warn:
        warn_of_edges(float(sided.sharp), surface is not None)
    return sided.vectors


def warn_of_edges(share: float, splits: bool) -> None:
    """Warn if a share of the edges is sharp and large; ``splits``: whether points can be split."""
    if share > MANY_SHARP:
        first = "" if splits else "take the extract_surface() of the mesh and "
        _check.warn(
            f"{share:.0%} of the edges are sharper than {SHARP:g} degrees, and light is averaged "
            f"across them; {first}pass feature_angle={SHARP:g} to split the points there"
        )


def warn_of_rounding(worst: float) -> None:
    """Warn if float32 points so far from the origin are rounded that computed normals suffer."""
    if worst > ROUNDED:
        _check.warn(
            f"the float32 points lie so far from the origin that they are rounded to {worst:.0%} "
            "of the spacing between them, and normals computed from them are off by as much; "
            "subtract an origin from them before they become float32, or keep them in float64"
        )


def rounding(points: ArraySource, ends: Sequence[int] | Indices = ()) -> float:
    """Return the largest rounding of float32 points, as a share of the spacing between them.

    ``ends`` are the first point of each of several meshes, and the end of the last.
    """
    if not isinstance(points, np.ndarray) or points.dtype != np.float32 or not points.size:
        return 0.0
    ends = np.asarray(ends if len(ends) else (0, len(points)))
    # VTK takes as long for the bounds of a small mesh as the light of its points does.
    low = np.fmin.reduceat(points, ends[:-1]).astype(np.float64)
    high = np.fmax.reduceat(points, ends[:-1]).astype(np.float64)
    for i in np.flatnonzero(~np.isfinite(low).all(axis=1) | ~np.isfinite(high).all(axis=1)):
        finite = points[slice(*ends[i : i + 2])]
        finite = finite[np.isfinite(finite).all(axis=1)]
        low[i], high[i] = (finite.min(axis=0), finite.max(axis=0)) if len(finite) else (0, 0)
    side, far = np.max(high - low, axis=1), np.maximum(-low, high).max(axis=1)
    # Distance of neighbouring float32 numbers there, against the mean spacing of points on a
    # surface; one of no size has none.
    spacing = np.where(side > 0, side, 1.0) / np.sqrt(np.diff(ends))
    return float(np.max(np.spacing(far.astype(np.float32)) / spacing, initial=0.0))


def warn_of_contradiction(meshes: Sequence[pv.DataSet], value: object, angle: FeatureAngle) -> None:
    """Warn once if normals that surfaces have are none of their faces, or smear their creases.

    A sign is no contradiction: light takes the side that is seen. Creases that an ``angle`` would
    split are left to :func:`warn_of_idle`.
    """
    sharp = 0.0
    for mesh in meshes[:MOST_MESHES]:
        if not isinstance(mesh, pv.PolyData) or not has_faces(mesh):
            continue
        rows = vtk_normals.given_normals(mesh, value, 3)
        if rows is None:
            continue
        share, leaning = _lean_shares(mesh, rows)
        if share > CONTRADICT:
            _check.warn(
                f"the mesh has normals that lean from its faces by more than 60 degrees on "
                f"{share:.0%} of the surface, and is lit by them; if they are wrong, clear them: "
                "mesh.point_data.active_normals_name = None"
            )
            return
        # On a coarse mesh of a smooth shape they lean too, but no edge of it is a crease; the faces
        # of points that are rounded are none of theirs.
        split = isinstance(angle, float | int)
        if leaning > MANY_SHARP and not split and rounding(places(mesh)) <= ROUNDED:
            sharp = max(sharp, vtk_normals.creases(mesh, has_normals=True))
    # A coarse mesh of a smooth shape has sharp edges too, but fewer.
    if sharp > SMEARED:
        _check.warn(
            f"the mesh has normals that are averaged across its sharp edges, {sharp:.0%} of all, "
            "and faces beside these are shaded as if they were round; clear them: "
            f"mesh.point_data.active_normals_name = None, and pass feature_angle={SHARP:g}"
        )


def _lean_shares(mesh: pv.PolyData, normals: Raw) -> tuple[float, float]:
    """Return the share of a surface 60 degrees off its normals, and of corners SHARP degrees off.

    The sign is left out, as light takes the side that is seen.
    """
    corners = triangles(mesh)
    # A sample: the test is for a mesh as a whole, not for each of its points.
    corners = corners[:: max(len(corners) // MOST_FACES, 1)]
    a, b, c = np.asarray(places(mesh)[corners], np.float64).transpose(1, 0, 2)
    with np.errstate(all="ignore"):
        face, area = kernels.unit(np.cross(b - a, c - a).T)
        at_corners = np.asarray(normals[corners], np.float64)
        # cos 60 degrees is 1/2.
        off = np.abs(kernels.dot(kernels.unit(at_corners.mean(axis=1).T)[0], face)) < 1 / 2
        cosine = np.abs(np.einsum("ij,jki->jk", face, kernels.unit_rows(at_corners)))
        leaning = np.count_nonzero(cosine < np.cos(np.radians(SHARP))) / max(cosine.size, 1)
        return float(np.sum(area, where=off) / np.sum(area)), leaning


def onlooker(scene: Scene) -> View | None:
    """Return the view that an open surface faces: the scene's, or one from its first light."""
    if scene.view is not None:
        return scene.view
    # Without a view an open surface faces its first lamp, so that it is not dark.
    light = next((light for light in scene.lights if not light.follows_view), None)
    if light is None:
        return None
    return View(position=light.position, direction=light.direction)


def split_where_computed(mesh: SurfaceT, angle: FeatureAngle) -> SurfaceT | pv.PolyData:
    """Return a surface with points split at its sharp edges, if its normals will be computed.

    Anything but a surface, and one with active normals, is returned as it is; see
    :func:`split_edges`.
    """
    if angle is None or not isinstance(mesh, pv.PolyData):
        return mesh
    if mesh.point_data.active_normals is None:
        return split_edges(mesh, angle)
    warn_of_idle(mesh, angle)
    return mesh


def warn_of_idle(mesh: pv.DataSet, angle: FeatureAngle) -> None:
    """Warn if an angle would split a mesh at sharp edges, but its active normals keep it whole."""
    if not isinstance(angle, float | int) or not isinstance(mesh, pv.PolyData):
        return
    if mesh.point_data.active_normals is None or not has_faces(mesh):
        return
    # Only where the angle would have split something is there anything to tell.
    if split_edges(pv.PolyData(faces_only(mesh)), angle).n_points > mesh.n_points:
        _check.warn(
            "feature_angle has no effect on normals that the mesh has, and sharp edges look round; "
            "clear them by mesh.point_data.active_normals_name = None"
        )


def split_edges(mesh: pv.PolyData, angle: float | Literal["auto"]) -> pv.PolyData:
    """Return a surface with points split where faces meet at more than an angle in degrees.

    ``"auto"`` is 30 degrees on a surface whose sharp edges are creases. All arrays go with the
    points; the mesh itself is not changed, and one that is split shares no memory with it.
    """
    if not has_faces(mesh) or not mesh.n_points:
        return mesh
    if angle == "auto":
        # The share is 0 on a coarse mesh of a smooth shape, too, whose edges are no creases.
        known = kept(mesh)
        if not (vtk_normals.creases(mesh) if known is None else known.sharp):
            return mesh
        angle = SHARP
    # Not kept, as normals are: corners take more memory than a filter may.
    split = _split(mesh, angle)
    return mesh if split is None else _at(mesh, *split)


def split_or_normals(
    mesh: pv.PolyData, angle: float | Literal["auto"]
) -> tuple[pv.PolyData, vtk_normals.Sided | None]:
    """Return the mesh of :func:`split_edges` and its normals, None where they are found later."""
    split = split_edges(mesh, angle)
    if not has_faces(mesh) or not mesh.n_points:
        return split, None
    # Normals of small surfaces are found together.
    if split is mesh and mesh.n_points <= SMALL:
        return mesh, None
    return split, kept(split) or vtk_normals.computed_normals(split, owner=mesh)


def _split(mesh: pv.PolyData, angle: float) -> tuple[Indices, Indices, Indices] | None:
    """Return corners and ends of faces at points that are split, and what each point was.

    None where nothing is split.
    """
    ids, ends = _corners(mesh)
    twins = first_twins(blocks.cell_array(ids, ends))
    corners, origin, turned = split_faces(places(mesh), ids, ends, angle, twins)
    if len(origin) == mesh.n_points:
        return None
    if turned.any():
        # Pieces that are taken apart would not know that they had a side in common.
        size = np.diff(ends)
        # A place of the face is subtracted from this, which runs through its corners backward.
        last = np.repeat(ends[:-1] + ends[1:] - 1, size)
        at = np.arange(len(ids))
        corners = corners[np.where(np.repeat(turned, size), last - at, at)]
    return corners, ends, origin


def split_values(mesh: pv.PolyData, name: str) -> tuple[pv.PolyData, Indices]:
    """Return a surface with points split where cells of different values meet, and the origins.

    The origin of a point is the point that it was. Values that are averaged from cells to points
    are then the cells' own.
    """
    # Cells are in the order of VTK's kinds: vertices and lines come before all faces.
    values = np.asarray(mesh.cell_data[name])[_rows(mesh)][mesh.n_verts + mesh.n_lines :]
    ids, ends = _corners(mesh)
    corners, origin = _apart(ids, ends, values, mesh.n_points)
    found = _at(mesh, corners, ends, origin)
    _keep_smooth(mesh, found, origin)
    return found, origin


def split_grid(mesh: pv.UnstructuredGrid, name: str) -> tuple[pv.UnstructuredGrid, Indices]:
    """Return a grid without polyhedra as :func:`split_values` returns a surface."""
    ids, ends = connectivity(mesh.GetCells())
    corners, origin = _apart(ids, ends, np.asarray(mesh.cell_data[name]), mesh.n_points)
    found = pv.UnstructuredGrid()
    found.SetPoints(pv.vtk_points(places(mesh)[origin]))
    found.SetCells(pv.convert_array(mesh.celltypes), blocks.cell_array(corners, ends))
    records.carry_rows(mesh, found, origin)
    records.carry(mesh, found)
    _keep_smooth(mesh, found, origin)
    return found, origin


def _apart(ids: Indices, ends: Indices, values: Raw, count: int) -> tuple[Indices, Indices]:
    """Return the corners of cells that share points only with cells of their value, and origins."""
    _, kind = np.unique(values, axis=0, return_inverse=True)
    # A point and a value of cells there make one new point.
    code = ids * (kind.max(initial=0) + 1) + np.repeat(kind.reshape(-1), np.diff(ends))
    _, first, number = np.unique(code, return_index=True, return_inverse=True)
    return numbered(first[number.reshape(-1)], ids, count)


def _keep_smooth(mesh: pv.DataSet, split: pv.DataSet, origin: Indices) -> None:
    """Keep the normals of a mesh with one whose points were split, which is as smooth as it was."""
    if (sided := kept(mesh)) is not None:
        keep(split, dataclasses.replace(sided.at(origin), kept=False))


def _corners(mesh: pv.PolyData) -> tuple[Indices, Indices]:
    """Return corners and ends of the polygons of a mesh, and of its strips as triangles."""
    ids, ends = connectivity(mesh.GetPolys())
    if not mesh.n_strips:
        return ids, ends
    strips = pv.PolyData()
    strips.SetPoints(mesh.GetPoints())
    strips.SetStrips(mesh.GetStrips())
    more = triangles(strips)
    more_ends = ends[-1] + 3 * np.arange(1, len(more) + 1)
    return np.concatenate([ids, more.ravel()]), np.concatenate([ends, more_ends])


def _at(mesh: pv.PolyData, corners: Indices, ends: Indices, origin: Indices) -> pv.PolyData:
    """Return a surface with other corners of its faces, at points that were points of it.

    Points that were split stand behind the mesh's own.
    """
    found = pv.PolyData()
    found.SetPoints(pv.vtk_points(places(mesh)[origin]))
    # Copies, for a result shares no memory with the mesh.
    for put, cells in ((found.SetVerts, mesh.GetVerts()), (found.SetLines, mesh.GetLines())):
        own = pv.CellArray()
        own.DeepCopy(cells)
        put(own)
    found.SetPolys(blocks.cell_array(corners, ends))
    records.carry_rows(mesh, found, origin, _rows(mesh))
    records.carry(mesh, found)
    return found


def _rows(mesh: pv.PolyData) -> Indices:
    """Return the cell of a mesh that each cell is once its strips are triangles."""
    size = np.diff(connectivity(mesh.GetStrips())[1])
    # A strip of n points, the last kind of cells, is n - 2 triangles.
    rows = np.repeat(np.arange(mesh.n_cells - len(size), mesh.n_cells), np.maximum(size - 2, 0))
    return np.concatenate([np.arange(mesh.n_cells - len(size)), rows])


def _stay(mesh: pv.DataSet, normals: vtk_normals.Sided, fewest: int = FEWEST) -> bool:
    """Return whether normals are kept with a mesh of this kind and size."""
    made = normals.computed and not normals.kept and normals.lean is not None
    return made and n_points(mesh) >= fewest and isinstance(mesh, _KINDS)


def to_keep(
    meshes: Sequence[pv.DataSet], part: Part
) -> Iterator[tuple[int, vtk_normals.Sided | None]]:
    """Yield the number and the normals of each mesh of a part.

    Without the rows of points where these do not stay with a mesh; ``sharp`` is then the largest.
    """
    normals = part.sided
    facts = normals and dataclasses.replace(
        normals, vectors=np.empty(0), lean=None, open=0, sharp=float(np.max(normals.sharp))
    )
    for i, number in enumerate(part.numbers):
        if normals is None or not _stay(meshes[number], normals):
            yield number, facts
        elif len(part.ends):
            yield number, normals.of_block(i, slice(*part.ends[i : i + 2]))
        else:
            yield number, normals


def keep(mesh: pv.DataSet, normals: vtk_normals.Sided, fewest: int = FEWEST) -> None:
    """Attach normals that were computed to a mesh of so many points; see :func:`records.keep`."""
    if not len(normals.vectors) or not _stay(mesh, normals, fewest):
        return
    rows = np.empty((len(normals.vectors), 5), dtype=np.float32)
    # One array, so that it travels with the mesh through files as a whole or not at all.
    rows[:, :3], rows[:, 3], rows[:, 4] = normals.vectors, normals.lean, normals.open
    records.keep(mesh, KEPT, "normals", rows, sharp=normals.sharp, inside=normals.inside)


def kept(mesh: pv.DataSet) -> vtk_normals.Sided | None:
    """Return the normals that an earlier result kept, if the mesh has not changed since."""
    found = records.kept(mesh, KEPT, 5)
    if found is None:
        return None
    rows, record = found
    return vtk_normals.Sided(
        np.ascontiguousarray(rows[:, :3], dtype=np.float32),
        rows[:, 3],
        rows[:, 4].astype(np.intp),
        records.share(record, "sharp"),
        kept=True,
        computed=True,
        inside=records.count(record, "inside", mesh.n_points),
    )


#: Name of the point array of normals, chosen not to clash with a user's array.
NORMALS = "vizlight normals"


def with_normals(surface: object, view: View | None, angle: FeatureAngle = None) -> pv.PolyData:
    """Return the triangles of a surface as a new mesh with the unit point normals ``NORMALS``.

    Points are split at edges sharper than the angle; without one a warning is given if normals
    were averaged across many sharp edges.
    """
    own = split_where_computed(blocks.surface(surface, "surface"), angle)
    # Vertices and lines are left out, because every cell must be a triangle.
    triangles = pv.PolyData(faces_only(own))
    for key, array in own.point_data.items():
        if np.asarray(array).dtype.kind in "biuf":
            triangles.point_data[key] = np.asarray(array)
    if vtk_normals.given_normals(own, None, 3) is None:
        found = normals_of(own, None, 3, view, warn=angle is None)
    else:
        # Closed surfaces have an outer side, whatever their normals say.
        found = vtk_normals.sided_normals(own, None, 3, "auto").vectors
    kind = np.result_type(found.dtype, np.float32)
    triangles.point_data[NORMALS] = kernels.unit_rows(found).astype(kind, copy=False)
    return triangles if triangles.is_all_triangles else triangles.triangulate()


def closest_normals(surface: pv.PolyData, points: Array) -> Array:
    """Return the normals of a mesh of triangles, interpolated, at its places closest to points."""
    cells = Simplices(surface.points, np.asarray(surface.regular_faces, dtype=np.intp))
    nearest: Foreign = surface.find_closest_cell(points, return_closest_point=True)  # type: ignore[arg-type]
    places = cells.locate(np.atleast_1d(nearest[0]), np.atleast_2d(nearest[1]))
    return cells.interpolated(np.asarray(surface.point_data[NORMALS], dtype=np.float64), places)


def welded(mesh: MeshT) -> MeshT:
    """Return a mesh whose points at the same place are one, where all their arrays are equal.

    Points without a cell are left out. Normals that are computed are then those of the surface, not
    of each face; points that differ in a colour or a texture coordinate stay apart. Anything but a
    surface of polygons alone, or cells, is returned as it is.
    """
    is_grid = isinstance(mesh, pv.UnstructuredGrid)
    if not mesh.n_cells or not (is_grid or mesh.n_cells == mesh.GetNumberOfPolys()):
        return mesh
    # Adding 0 makes 0.0 of -0.0, so that equal places have equal bytes.
    parts = [np.asarray(mesh.points) + 0, *map(np.asarray, mesh.point_data.values())]
    if any(part.dtype.kind not in "biuf" for part in parts):
        return mesh
    first, places_in_order = np.arange(mesh.n_points), np.sort(place_numbers(parts[0]))
    if np.any(places_in_order[1:] == places_in_order[:-1]):
        # By bytes, in which NaN equals NaN: a vertex without a value is welded like any other.
        rows = [np.ascontiguousarray(part.reshape(len(part), -1)).view(np.uint8) for part in parts]
        table = np.ascontiguousarray(np.hstack([row.reshape(mesh.n_points, -1) for row in rows]))
        _, chosen, same = np.unique(
            table.view(f"V{table.shape[1]}"), return_index=True, return_inverse=True
        )
        first = chosen[same.reshape(-1)]
    kept = np.zeros(mesh.n_points, dtype=np.bool_)
    for cells in cell_arrays(mesh):
        kept[first[connectivity(cells)[0]]] = True
    if kept.all():
        return mesh
    out = mesh.copy()
    # Arrays have a row for each point.
    out.clear_data()
    renumber_corners(out, (np.cumsum(kept) - 1)[first])
    out.points = np.asarray(mesh.points)[kept]
    records.carry_rows(mesh, out, np.flatnonzero(kept))
    return out


def drop_empty(mesh: pv.DataSet) -> None:
    """Remove the active normals of a mesh that was just read if all are NaN or of no length.

    Programs write such normals of scans and surfaces where they know none.
    """
    rows = mesh.point_data.active_normals
    if rows is not None and not np.any(np.nan_to_num(rows)):
        del mesh.point_data[mesh.point_data.active_normals_name or ""]


def keep_normals(mesh: pv.PolyData) -> None:
    """Keep the normals of a surface without creases at points that only their arrays tell apart.

    Along the seam of a texture, or where colours differ, light is then as smooth as the surface.
    Where the surface has no sharp edge, its point normals are set.
    """
    if mesh.n_cells != mesh.GetNumberOfPolys() or mesh.n_points < FEWEST:
        return
    if not mesh.point_data or mesh.point_data.active_normals is not None:
        return
    first = coincident(np.asarray(mesh.points))
    if first is None:
        return
    ids, ends = connectivity(mesh.GetPolys())
    whole = pv.PolyData()
    whole.SetPoints(mesh.GetPoints())
    # By place alone: a seam of texture or colour is no edge of this surface.
    whole.SetPolys(blocks.cell_array(first[ids], ends))
    sided = vtk_normals.computed_normals(whole)
    if not sided.sharp:
        keep(mesh, sided.at(first))
