"""Outward normals of a mesh: those it carries, or those of its surface."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight import _check
from vizlight.mesh.hull import outer_surface, scattered
from vizlight.mesh.point_arrays import unit_rows, vectors_of
from vizlight.scene import View

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.scene import Scene

#: Largest share of the area of a piece's faces that their vectors add up to, where the piece is
#: nearly closed.
NEARLY_CLOSED = 0.2


def normals_of(mesh: pv.DataSet, value: Any, n: int, view: View | None) -> Array:
    """Return outward normals: those given, those the mesh carries, or those of its surface."""
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        raise ValueError(
            _check.message(
                "normals",
                f"a point array of {n} components for {n}-space",
                None,
                "where there are none, light by tangents=, "
                "conditioned by the name of the surface's tangents",
            )
        )
    carried = mesh.point_data.active_normals
    if carried is not None:
        return np.asarray(carried)
    return surface_normals(mesh, view)


def surface_normals(mesh: pv.DataSet, view: View | None) -> Array:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    A closed surface has them outward, and so has a connected piece that is nearly closed. Any
    other has no outside: it is turned as a whole, rather toward the eye.
    VTK computes them, in float32.

    Raises
    ------
    ValueError
        If the mesh has no surface.
    """
    if mesh.n_points == 0:
        return np.zeros((0, 3), dtype=np.float32)
    if isinstance(mesh, pv.PointSet):
        mesh = mesh.cast_to_polydata(deep=False)
    if isinstance(mesh, pv.PolyData):
        surface, origin = mesh, None
    else:
        surface, origin = outer_surface(mesh)
    if not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        raise ValueError(
            _check.message(
                "mesh",
                "a surface, whose normals decide where no tangents are named",
                f"a {type(mesh).__name__} without faces",
                "name its tangent vectors by tangents=",
            )
        )
    bare = pv.PolyData()
    bare.copy_structure(surface)
    closed = bare.n_open_edges == 0
    found = bare.compute_normals(
        cell_normals=False,
        split_vertices=False,
        consistent_normals=True,
        auto_orient_normals=closed,
        non_manifold_traversal=False,
    )
    computed = np.array(found.point_data["Normals"])
    used = np.zeros(len(computed), dtype=np.bool_)
    used[_corners(bare)[0]] = True
    computed[~used] = 0
    if not closed:
        _turn_open(computed, found, view)
    if origin is None:
        return computed
    return scattered(computed, origin, mesh.n_points)


def _turn_open(normals: Array, surface: pv.PolyData, view: View | None) -> None:
    """Turn over each connected piece whose normals rather point inward, or away from the eye.

    A piece is nearly closed where the vectors of its faces' areas add up to little of their area:
    then the volume it encloses decides. For a sheet or a bowl the mean of N toward the eye, which
    counts three times, and away from the piece's centroid. Points that are not finite have no say.
    """
    points = np.asarray(surface.points, dtype=np.float64)
    piece = _pieces(surface)
    good = np.all(np.isfinite(points), axis=1) & np.all(np.isfinite(normals), axis=1)
    points = np.where(good[:, np.newaxis], points, 0)
    size = np.maximum(np.bincount(piece, good), 1)
    centroids = np.stack([np.bincount(piece, axis * good) / size for axis in points.T], axis=1)
    away = points - centroids[piece]
    score = _dots(normals, unit_rows(away))
    if view is not None and len(view.position or view.direction or ()) == 3:
        toward = (
            np.broadcast_to(np.asarray(view.direction), points.shape)
            if view.parallel
            else np.asarray(view.position) - points
        )
        score += 3 * _dots(normals, unit_rows(toward))
    turned = np.bincount(piece, np.where(good, score, 0)) < 0

    faces = surface if surface.is_all_triangles else surface.triangulate()
    corners = np.asarray(faces.regular_faces, dtype=np.intp)
    corners = corners[good[corners].all(axis=1)]
    # Over their size, since products of tiny lengths vanish and those of huge ones overflow.
    a, b, c = (away[corners[:, i]] / (np.abs(away).max() or 1.0) for i in range(3))
    across, owner = np.cross(b - a, c - a), piece[corners[:, 0]]
    total = np.stack([np.bincount(owner, axis, len(size)) for axis in across.T], axis=1)
    area = np.bincount(owner, np.linalg.norm(across, axis=1), len(size))
    volume = np.bincount(owner, _dots(across, a), len(size))
    around = np.linalg.norm(total, axis=1) < NEARLY_CLOSED * area
    normals[np.where(around, volume < 0, turned)[piece]] *= -1


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def onlooker(scene: Scene) -> View | None:
    """Return the scene's view, or one from its first light, to which an open surface then turns."""
    if scene.view is not None:
        return scene.view
    light = next((light for light in scene.lights if not light.follows_view), None)
    if light is None:
        return None
    return View(position=light.position, direction=light.direction)


def _pieces(surface: pv.PolyData) -> Indices:
    """Return for each point the number of the connected piece it belongs to.

    Corners of one place belong together, so that separate triangles of one surface do too.
    """
    corners, last = _corners(surface)
    follows = np.flatnonzero(~last)
    points = np.asarray(surface.points)
    order = np.lexsort(points.T)
    same = np.flatnonzero(np.all(points[order[1:]] == points[order[:-1]], axis=1))
    a = np.concatenate([corners[follows], order[same]])
    b = np.concatenate([corners[follows + 1], order[same + 1]])
    graph = coo_array((np.ones(len(a), np.bool_), (a, b)), shape=(surface.n_points,) * 2)
    _, piece = connected_components(graph, directed=False)
    return np.asarray(piece, dtype=np.intp)


def _corners(surface: pv.PolyData) -> tuple[Indices, Bools]:
    """Return the corners of all faces, one after the other, and which are the last of a face."""
    corners, last = [], []
    for cells in (surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False)
        ends = np.zeros(len(ids), dtype=np.bool_)
        ends[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = True
        corners.append(ids)
        last.append(ends)
    return np.concatenate(corners), np.concatenate(last)
