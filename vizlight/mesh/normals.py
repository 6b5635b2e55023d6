"""Outward normals of a mesh: an array that it carries, or the normals of its surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight import _check
from vizlight.mesh.blocks import has_faces
from vizlight.mesh.hull import outer_surface, scattered
from vizlight.mesh.point_arrays import unit_rows, vectors_of
from vizlight.scene import View

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.scene import Scene

#: A piece counts as nearly closed if the sum of the area vectors of its faces is shorter than this
#: share of its area.
NEARLY_CLOSED = 0.2


def normals_of(mesh: pv.DataSet, value: object, n: int, view: View | None) -> Array:
    """Return outward normals: those in ``value``, else those of the mesh or of its surface."""
    if value is not None:
        return vectors_of(mesh, "normals", value, n)
    if n != 3:
        expected = f"a point array of {n} components for {n}-space"
        remedy = "without one pass tangents=, conditioned by the name of the surface's tangents"
        raise ValueError(_check.message("normals", expected, None, remedy))
    carried = mesh.point_data.active_normals
    if carried is not None:
        return np.asarray(carried)
    return surface_normals(mesh, view)


def surface_normals(mesh: pv.DataSet, view: View | None) -> Array:
    """Return the normals of a mesh's outer surface, zero at points that are not on it.

    VTK computes them in float32 and orients them consistently. They point outward on a closed
    surface and on a connected piece that is nearly closed. Any other piece has no outside: its
    normals are flipped together if on average they point away from the eye, or toward the
    centroid of the piece.

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
    if not has_faces(surface):
        expected, got = "a surface, whose normals are lit", f"a {type(mesh).__name__} without faces"
        remedy = "name its tangent vectors by tangents="
        raise ValueError(_check.message("mesh", expected, got, remedy))
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
        _orient_open(computed, found, view)
    if origin is None:
        return computed
    return scattered(computed, origin, mesh.n_points)


def _orient_open(normals: Array, surface: pv.PolyData, view: View | None) -> None:
    """Flip the normals of each connected piece that point inward, or away from the eye.

    A piece is nearly closed if the area vectors of its faces almost cancel; then the sign of the
    enclosed volume decides. For a sheet or a bowl the sign of a sum over its points decides, of
    three times the cosine between N and the direction toward the eye plus the cosine between N and
    the direction away from the centroid of the piece. Points that are not finite are ignored.
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
    flipped = np.bincount(piece, np.where(good, score, 0)) < 0

    faces = surface if surface.is_all_triangles else surface.triangulate()
    corners = np.asarray(faces.regular_faces, dtype=np.intp)
    corners = corners[good[corners].all(axis=1)]
    # Lengths are scaled, because products of tiny ones underflow and of huge ones overflow.
    a, b, c = (away[corners[:, i]] / (np.abs(away).max() or 1.0) for i in range(3))
    across, owner = np.cross(b - a, c - a), piece[corners[:, 0]]
    total = np.stack([np.bincount(owner, axis, len(size)) for axis in across.T], axis=1)
    area = np.bincount(owner, np.linalg.norm(across, axis=1), len(size))
    volume = np.bincount(owner, _dots(across, a), len(size))
    around = np.linalg.norm(total, axis=1) < NEARLY_CLOSED * area
    normals[np.where(around, volume < 0, flipped)[piece]] *= -1


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))


def onlooker(scene: Scene) -> View | None:
    """Return the view that an open surface faces: the scene's, or one from its first light."""
    if scene.view is not None:
        return scene.view
    light = next((light for light in scene.lights if not light.follows_view), None)
    if light is None:
        return None
    return View(position=light.position, direction=light.direction)


def _pieces(surface: pv.PolyData) -> Indices:
    """Return for each point the number of its connected piece.

    Coincident points are connected, so that triangles that share no point can form one piece.
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
    """Return the corners of all faces, and a mask of those that are the last of their face."""
    corners, last = [], []
    for cells in (surface.GetPolys(), surface.GetStrips()):
        ids = pv.convert_array(cells.GetConnectivityArray()).astype(np.intp, copy=False)
        ends = np.zeros(len(ids), dtype=np.bool_)
        ends[pv.convert_array(cells.GetOffsetsArray())[1:] - 1] = True
        corners.append(ids)
        last.append(ends)
    return np.concatenate(corners), np.concatenate(last)
