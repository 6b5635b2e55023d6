"""Closed meshes as solids: whether they are closed, and the length of rays inside them.

Embree, if the package embreex is installed, finds the first hit of all rays in one call, in
float32. The next hits are the first hits of rays that start just behind the previous ones. Embree
gives the triangle that is hit; the distance is computed from the triangle in float64.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from vizlight import _check
from vizlight.geometry.solids import parallel_rays
from vizlight.mesh import blocks
from vizlight.vtk.cells import faces_only, triangles
from vizlight.vtk.topology import Owners, coincident

if TYPE_CHECKING:
    from collections.abc import Callable

    from embreex.rtcore_scene import EmbreeScene

    from vizlight._types import Array, Indices

#: Number of rays whose hits are in memory at once.
BLOCK = 1 << 17
#: Tolerance, as a share of the size of the solid: a ray this near to a triangle hits it, and two
#: hits this near to each other are merged.
NEAR = 1e-10
#: Cosine between a ray and the normal of a triangle below which the triangle is along the ray.
STEEP = 1e-4


@dataclass(frozen=True)
class Solid:
    """Triangles of a closed surface in float64, relative to an origin.

    Parallel rays are projected along their direction. Others need a search tree: Embree's if
    ``embree`` and the package embreex is installed, else VTK's.
    """

    vertices: Array
    triangles: Indices
    normals: Array
    embree: bool = True

    @cached_property
    def tree(self) -> vtkStaticCellLocator | EmbreeScene:
        """Search tree of the triangles."""
        found = embree_tree(self.vertices[self.triangles]) if self.embree else None
        if found is not None:
            return found
        made = vtkStaticCellLocator()
        made.SetDataSet(blocks.polydata(self.vertices, self.triangles))
        made.BuildLocator()
        return made

    @cached_property
    def size(self) -> float:
        """Diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))


def triangles_of(surface: object, name: str) -> tuple[Array, Indices]:
    """Return the vertices and triangles of a surface; coincident vertices are merged."""
    vertices, triangles, _, _ = _merged(surface, name)
    return vertices, triangles


def _merged(surface: object, name: str) -> tuple[Array, Indices, Indices, Indices]:
    """Return vertices, triangles, the points that faces use, and the vertex of each such point."""
    surface = blocks.surface(surface, name)
    corners = np.asarray(triangles(faces_only(surface)), dtype=np.intp)
    points = np.asarray(surface.points, dtype=np.float64)
    if not np.all(np.isfinite(points[corners])):
        raise ValueError(_check.message(name, "faces with finite points", "NaN or infinite points"))
    # Zeros are added, because -0 is 0.
    first = coincident(points + 0.0, Owners())
    there = np.zeros(len(points), np.bool_)
    there[corners] = True
    used = np.flatnonzero(there)
    kept, same = np.unique(used if first is None else first[used], return_inverse=True)
    corners = same.reshape(-1)[(np.cumsum(there) - 1)[corners]]
    a, b, c = corners.T
    return points[kept], corners[(a != b) & (b != c) & (c != a)], used, same.reshape(-1)


def closed(surface: object, name: str = "mesh") -> tuple[Array, Indices]:
    """Return the vertices and the consistently oriented triangles of a closed surface.

    Raises
    ------
    TypeError, ValueError
        If it is not a surface, or not closed; the message says how to repair it.
    """
    vertices, triangles = triangles_of(surface, name)
    if not len(_open_edges(triangles, directed=True)):
        return vertices, triangles
    opened = _open_edges(triangles, directed=False)
    if len(opened):
        remedy = (
            "mesh.clean(tolerance=) joins seams and mesh.fill_holes(size) closes holes; "
            "thickness= lights an open surface as a shell, raster= as a terrain"
        )
        got = f"one with {len(opened)} open edges"
        raise ValueError(_check.message(name, "a closed surface", got, remedy))
    oriented = blocks.polydata(vertices, triangles).compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=True
    )
    # VTK drops points without faces, which changes the indices.
    vertices = np.asarray(oriented.points, dtype=np.float64)
    triangles = np.asarray(oriented.regular_faces, dtype=np.intp)
    if len(_open_edges(triangles, directed=True)):
        got = "one that cannot be oriented"
        raise ValueError(_check.message(name, "a surface with an inside", got))
    return vertices, triangles


def shell(surface: object, thickness: float, normals: Array) -> tuple[Array, Indices]:
    """Return a closed shell: an open surface, its copy along -normals, and walls between them."""
    vertices, triangles, used, same = _merged(surface, "mesh")
    # Merged points share the sum of their normals.
    total = np.zeros_like(vertices)
    np.add.at(total, same, normals[used])
    size = np.linalg.norm(total, axis=1, keepdims=True)
    under = vertices - thickness * total / np.where(size > 0, size, 1)
    n = len(vertices)
    a, b = _open_edges(triangles, directed=True).T
    walls = [np.stack([b, a, a + n], axis=1), np.stack([b, a + n, b + n], axis=1)]
    faces = np.concatenate([triangles, triangles[:, ::-1] + n, *walls])
    if len(_open_edges(faces, directed=True)):
        expected, got = "a surface of consistently oriented faces", "faces of both orientations"
        remedy = "call mesh.compute_normals(consistent_normals=True)"
        raise ValueError(_check.message("mesh", expected, got, remedy))
    return np.concatenate([vertices, under]), faces


def _open_edges(triangles: Indices, *, directed: bool) -> Indices:
    """Return the edges that are used an odd number of times, or unequally in the two directions."""
    start, end = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    count = triangles.max(initial=0) + 1
    # One integer per edge sorts much faster than rows; its last bit is the direction.
    keys = np.minimum(start, end) * count + np.maximum(start, end)
    keys = np.sort(2 * keys + (start < end))
    first = np.flatnonzero(np.diff(keys >> 1, prepend=-1))
    pairs = np.stack(np.divmod(keys[first] >> 1, count), axis=1)
    times = np.diff(first, append=len(keys))
    if not directed:
        return np.asarray(pairs[times % 2 == 1])
    forward = 2 * np.add.reduceat(keys & 1, first)
    return np.concatenate([pairs[forward > times], pairs[forward < times][:, ::-1]])


def solid(
    vertices: Array, triangles: Indices, origin: Array, unit: float = 1.0, *, embree: bool = True
) -> Solid:
    """Return a solid, its vertices relative to an origin and in a unit."""
    place = (vertices - origin) / unit
    a, b, c = (place[triangles[:, k]] for k in range(3))
    return Solid(place, triangles, np.cross(b - a, c - a), embree)


def hits(body: Solid, start: Array, way: Array, reach: Array) -> tuple[Indices, Indices, bool]:
    """Return the ray and the triangle of every hit, and whether hits on shared edges are repeated.

    Parallel rays take about 2 microseconds each. Of other rays VTK takes about 10 microseconds,
    one ray per call; Embree takes about 0.8, all in a call.
    """
    if len(way) and np.all(way == way[0]):
        found = parallel_rays.hits(body.vertices, body.triangles, start, way[0])
        if found is not None:
            return *found, False
    if not isinstance(body.tree, vtkStaticCellLocator):
        corner = body.vertices[body.triangles[:, 0]]
        ray, cell = _embree_hits(body.tree, corner, body.normals, body.size, start, way, reach)
        return ray, cell, True
    end = start + way * reach[:, np.newaxis]
    find, near = body.tree.IntersectWithLine, vtkIdList()
    tolerance = NEAR * body.size
    rays: list[int] = []
    cells: list[int] = []
    for row, (a, b) in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
        find(a, b, tolerance, None, near)
        for k in range(near.GetNumberOfIds()):
            rays.append(row)
            cells.append(near.GetId(k))
    return np.array(rays, dtype=np.intp), np.array(cells, dtype=np.intp), True


def inside_length(
    solids: list[Solid],
    start: Array,
    way: Array,
    reach: Array,
    report: Callable[[int], None] = lambda _: None,
) -> Array:
    """Return the length of each ray inside the union of the solids.

    Parameters
    ----------
    solids : list of Solid
    start, way : ndarray, shape (N, 3)
        Starting points and unit directions of the rays.
    reach : ndarray, shape (N,)
        Lengths of the rays; they end outside all solids.
    report : callable
        Function that takes the number of rays that are done, after each block.

    Returns
    -------
    ndarray, shape (N,)

    Notes
    -----
    A hit on a shared edge is found once for each of its triangles: coincident hits in the same
    direction are merged. A point is inside a solid if the ray beyond it leaves the solid more often
    than it enters it.
    """
    length = np.zeros(len(start))
    for first in range(0, len(start), BLOCK):
        rows = slice(first, first + BLOCK)
        events = [_events(body, start[rows], way[rows], reach[rows]) for body in solids]
        ray, s, change = (np.concatenate(part) for part in zip(*events, strict=True))
        if len(events) > 1:
            # From the end of a ray, which is outside, to its start.
            order = np.lexsort((-s, ray))
            ray, s, change = ray[order], s[order], change[order]
        ends = np.append(ray[1:] != ray[:-1], True)[: len(ray)]
        inside = np.cumsum(change) > 0
        nearer = np.where(ends, 0.0, np.append(s[1:], 0.0)[: len(s)])
        parts = np.where(inside, s - nearer, 0.0)
        length[rows] = np.bincount(ray, parts, minlength=len(length[rows]))
        report(min(rows.stop, len(start)))
    return length


def _events(body: Solid, start: Array, way: Array, reach: Array) -> tuple[Indices, Array, Indices]:
    """Return where rays enter (-1) and leave (+1) one solid: ray, distance and change.

    Events are in the order from the end of the ray to its start, where a last event at distance 0
    makes the sum of the changes 0.
    """
    # Farther away no ray can meet the solid.
    away = np.linalg.norm(start - body.vertices.mean(axis=0), axis=1)
    reach = np.minimum(reach, away + 2 * body.size)
    ray, cell, repeated = hits(body, start, way, reach)
    normal = body.normals[cell]
    against = np.einsum("ij,ij->i", way[ray], normal)
    corner = body.vertices[body.triangles[cell, 0]] - start[ray]
    flat = against == 0
    s = np.einsum("ij,ij->i", corner, normal) / np.where(flat, 1, against)
    # Of a triangle along the ray the distance is ill-conditioned: it stays between the corners'.
    steep = np.flatnonzero(against**2 < STEEP**2 * np.einsum("ij,ij->i", normal, normal))
    own = body.vertices[body.triangles[cell[steep]]] - start[ray[steep], np.newaxis]
    along = np.einsum("ijk,ik->ij", own, way[ray[steep]])
    s[steep] = np.clip(
        s[steep], along.min(axis=1, initial=np.inf), along.max(axis=1, initial=-np.inf)
    )
    good = ~flat & (s > 0) & (s < reach[ray])
    ray, s, sense = ray[good], s[good], np.sign(against[good]).astype(np.intp)

    if repeated:
        order = np.lexsort((s, sense, ray))
        ray, s, sense = ray[order], s[order], sense[order]
        again = (ray[1:] == ray[:-1]) & (sense[1:] == sense[:-1])
        again &= np.diff(s) <= NEAR * body.size
        once = np.append(True, ~again)[: len(ray)]
        ray, s, sense = ray[once], s[once], sense[once]

    # The event at 0 cancels the sum; the running sum is the winding number before each hit.
    rows = np.arange(len(start))
    rest = np.bincount(ray, sense, minlength=len(start)).astype(np.intp)
    ray = np.concatenate([ray, rows])
    s = np.concatenate([s, np.zeros(len(rows))])
    sense = np.concatenate([sense, -rest])
    order = np.lexsort((-s, ray))
    ray, s, sense = ray[order], s[order], sense[order]
    around = np.cumsum(sense)
    within = around != 0
    before = np.append(False, within[:-1])
    change = within.astype(np.intp) - before.astype(np.intp)
    return ray, s, change


def is_inside(body: Solid, place: Array) -> bool:
    """Return whether a point is inside a solid."""
    if np.any(place < body.vertices.min(axis=0)) or np.any(place > body.vertices.max(axis=0)):
        return False
    for way in np.array([[0.6, 0.48, 0.64], [-0.48, 0.64, 0.6], [0.64, 0.6, -0.48]]):
        start = place[np.newaxis]
        ray, _, change = _events(body, start, way[np.newaxis], np.array([np.inf]))
        if not len(ray) or change[:-1].sum() <= 0:
            return False
    return True


#: Distance from a hit to the start of the next ray, as a share of the size of the mesh: what
#: float32 resolves.
STEP = 1e-6
#: Largest number of hits of a ray: a ray with more is in a mesh that Embree cannot resolve.
MOST = 10_000


def embree_tree(corners: Array) -> EmbreeScene | None:
    """Return Embree's search tree of triangles, shape (T, 3, 3); None without embreex."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    scene = EmbreeScene()
    TriangleMesh(scene, np.ascontiguousarray(corners, dtype=np.float32))
    return scene


def _embree_hits(
    scene: EmbreeScene,
    corner: Array,
    normal: Array,
    size: float,
    start: Array,
    way: Array,
    reach: Array,
) -> tuple[Indices, Indices]:
    """Return the ray and the triangle of every hit.

    Parameters
    ----------
    scene : EmbreeScene
    corner, normal : ndarray, shape (T, 3)
        One corner and the normal of each triangle.
    size : float
        Size of the mesh.
    start, way : ndarray, shape (N, 3)
        Starting points and unit directions of the rays.
    reach : ndarray, shape (N,)
        Lengths of the rays.
    """
    row = np.arange(len(start))
    s = np.zeros(len(start))
    rays, cells = [], []
    for _ in range(MOST):
        begin = (start[row] + s[row, np.newaxis] * way[row]).astype(np.float32)
        found = scene.run(begin, way[row].astype(np.float32), output=True)
        there = found["primID"] >= 0
        row, cell = row[there], found["primID"][there].astype(np.intp)
        far = found["tfar"][there].astype(np.float64)
        rays.append(row)
        cells.append(cell)
        against = np.einsum("ij,ij->i", way[row], normal[cell])
        gap = np.einsum("ij,ij->i", corner[cell] - start[row], normal[cell])
        # Along the plane of a triangle there is no such distance, so Embree's is used.
        place = np.divide(gap, against, out=s[row] + far, where=against != 0)
        near = np.abs(place - s[row] - far) < 1e-3 * size
        s[row] = np.maximum(np.where(near, place, s[row] + far), s[row]) + STEP * size
        row = row[s[row] < reach[row]]
        if not len(row):
            break
    return np.concatenate(rays), np.concatenate(cells)
