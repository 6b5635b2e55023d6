"""Triangles that rays meet, and closed meshes as solids: the length of rays inside them.

Embree, if the package embreex is installed, finds the first hit of all rays in one call, in
float32; else VTK finds one after the other. The next hits are the first hits of rays that start
just behind the previous ones. Distances are computed from the triangles in float64.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from vizlight import _check
from vizlight._types import Array, Bools, Foreign, Indices
from vizlight.geometry.solids import parallel_rays
from vizlight.mesh import blocks
from vizlight.vtk.cells import faces_only, triangles
from vizlight.vtk.topology import coincident

if TYPE_CHECKING:
    from embreex.rtcore_scene import EmbreeScene

#: Number of rays whose hits are in memory at once.
BLOCK = 1 << 17
#: Tolerance, as a share of the size of the solid: a ray this near to a triangle hits it, and two
#: hits this near to each other are merged.
NEAR = 1e-10
#: Cosine between a ray and the normal of a triangle below which the triangle is along the ray.
STEEP = 1e-4
#: Distance from a hit to the start of the next ray, as a share of the size of the mesh: what
#: float32 resolves.
STEP = 1e-6
#: Largest number of hits of a ray: a ray with more is in a mesh that float32 cannot resolve.
MOST = 10_000


def embree_tree(corners: Array) -> EmbreeScene | None:
    """Return Embree's search tree of triangles, shape (T, 3, 3); None without embreex."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    # In float32, as Embree has it: callers move and scale the triangles to size 1 beforehand.
    scene = EmbreeScene()
    TriangleMesh(scene, np.ascontiguousarray(corners, dtype=np.float32))
    return scene


class Tracer:
    """Finds triangles, shape (T, 3, 3) and about 1 in size and place, on rays."""

    def __init__(self, corners: Array) -> None:
        self._scene = embree_tree(corners) if len(corners) else None
        self.name = "rays by VTK" if self._scene is None else "rays by Embree"
        if self._scene is None:
            self._tree = vtkStaticCellLocator()
            numbers = np.arange(3 * len(corners)).reshape(-1, 3)
            self._tree.SetDataSet(blocks.polydata(corners.reshape(-1, 3), numbers))
            self._tree.BuildLocator()

    def first(self, start: Array, way: Array, reach: Array | float) -> Indices:
        """Return the first triangle on each ray, -1 for none; Embree looks beyond its end."""
        if self._scene is not None:
            rays = np.asarray(start, np.float32), np.asarray(way, np.float32)
            return np.asarray(self._scene.run(*rays), dtype=np.intp)
        # VTK writes its results into these; only the number of the cell is used.
        t, part, cell = mutable(0.0), mutable(0), mutable(0)
        place, weights = [0.0] * 3, [0.0] * 3
        find: Foreign = self._tree.IntersectWithLine
        hits_by_ray = np.full(len(start), -1)
        ends = start + np.reshape(reach, (-1, 1)) * way
        for row, (a, b) in enumerate(zip(start.tolist(), ends.tolist(), strict=True)):
            if find(a, b, NEAR, t, place, weights, part, cell):
                hits_by_ray[row] = int(cell)
        return hits_by_ray

    def free(self, start: Array, way: Array, reach: float) -> Bools:
        """Return whether rays meet no triangle."""
        if self._scene is None:
            return self.first(start, way, reach) < 0
        # Any hit is enough here, which is faster than the first one; Embree marks it by 0.
        hit: Indices = np.asarray(self._scene.run(start, way, query="OCCLUDED"))
        return np.asarray(hit != 0)


class Body:
    """Triangles of a closed surface in float64, relative to an origin and in a unit."""

    def __init__(
        self, vertices: Array, triangles: Indices, origin: Array | float = 0.0, unit: float = 1.0
    ) -> None:
        self.vertices, self.triangles = (vertices - origin) / unit, triangles
        self.corners = self.vertices[triangles]
        a, b, c = self.corners.transpose(1, 0, 2)
        # As long as twice the area: signs and quotients of products do not need a unit length.
        self.normals = np.cross(b - a, c - a)
        self.size = float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @cached_property
    def tracer(self) -> Tracer:
        """Search tree of the triangles, which parallel rays do not need."""
        return Tracer(self.corners)


def triangles_of(surface: object, name: str) -> tuple[Array, Indices]:
    """Return the vertices and triangles of a surface; coincident vertices are merged."""
    return _merged(surface, name)[:2]


def _merged(surface: object, name: str) -> tuple[Array, Indices, Indices, Indices]:
    """Return vertices, triangles, the points that faces use, and the vertex of each such point."""
    surface = blocks.surface(surface, name)
    corners = np.asarray(triangles(faces_only(surface)), dtype=np.intp)
    points = np.asarray(surface.points, dtype=np.float64)
    if not np.all(np.isfinite(points[corners])):
        raise _check.value_error(name, "faces with finite points", "NaN or infinite points")
    # Zeros are added, because -0 is 0.
    first = coincident(points + 0.0)
    there = np.zeros(len(points), np.bool_)
    there[corners] = True
    used = np.flatnonzero(there)
    kept, same = np.unique(used if first is None else first[used], return_inverse=True)
    corners = same.reshape(-1)[(np.cumsum(there) - 1)[corners]]
    a, b, c = corners.T
    # A triangle that is an edge once its corners are merged has no side of its own.
    return points[kept], corners[(a != b) & (b != c) & (c != a)], used, same.reshape(-1)


def closed(surface: object, name: str = "mesh") -> tuple[Array, Indices]:
    """Return the vertices and the consistently oriented triangles of a closed surface."""
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
        raise _check.value_error(name, "a closed surface", got, remedy)
    # Each edge has its faces by pairs, but some faces are turned over: VTK turns all outward.
    oriented = blocks.polydata(vertices, triangles).compute_normals(
        cell_normals=False, split_vertices=False, auto_orient_normals=True
    )
    # VTK drops points without faces, which changes the indices.
    vertices = np.asarray(oriented.points, dtype=np.float64)
    triangles = np.asarray(oriented.regular_faces, dtype=np.intp)
    if len(_open_edges(triangles, directed=True)):
        got = "one that cannot be oriented"
        raise _check.value_error(name, "a surface with an inside", got)
    return vertices, triangles


def shell(surface: object, thickness: float, normals: Array) -> tuple[Array, Indices]:
    """Return a closed shell: an open surface, its copy along -normals, and walls between them."""
    vertices, triangles, used, same = _merged(surface, "mesh")
    # Merged points share the sum of their normals.
    total = np.zeros_like(vertices)
    np.add.at(total, same, normals[used])
    size = np.linalg.norm(total, axis=1, keepdims=True)
    # Where normals cancel there is no direction: the copy stays at the place.
    under = vertices - thickness * total / np.where(size > 0, size, 1)
    n = len(vertices)
    a, b = _open_edges(triangles, directed=True).T
    # Two triangles for each open edge, wound against its face, so that every edge is used both
    # ways.
    walls = [np.stack([b, a, a + n], axis=1), np.stack([b, a + n, b + n], axis=1)]
    faces = np.concatenate([triangles, triangles[:, ::-1] + n, *walls])
    if len(_open_edges(faces, directed=True)):
        expected, got = "a surface of consistently oriented faces", "faces of both orientations"
        remedy = "call mesh.compute_normals(consistent_normals=True)"
        raise _check.value_error("mesh", expected, got, remedy)
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
    # An edge of four faces, as where two cubes touch, is closed: an even number is enough.
    if not directed:
        return np.asarray(pairs[times % 2 == 1])
    forward = 2 * np.add.reduceat(keys & 1, first)
    return np.concatenate([pairs[forward > times], pairs[forward < times][:, ::-1]])


def hits(
    body: Body, start: Array, way: Array, reach: Array
) -> tuple[Indices, Indices, Array, bool]:
    """Return ray, triangle and distance of every hit, and whether shared edges may be hit twice.

    Parallel rays are projected along their direction. Other rays are followed by Embree, or, far
    more slowly, by VTK.
    """
    # Rays of a sun need no search tree, and where they meet an edge there are exact rules.
    if len(way) and np.all(way == way[0]):
        pairs = parallel_rays.hits(body.vertices, body.triangles, start, way[0])
        if pairs is not None:
            return *pairs, _distances(body, start, way, *pairs), False
    row, s = np.arange(len(start)), np.zeros(len(start))
    rays, cells, places = [], [], []
    for _ in range(MOST):
        begin = start[row] + s[row, np.newaxis] * way[row]
        cell = body.tracer.first(begin, way[row], reach[row] - s[row])
        row, cell = row[cell >= 0], cell[cell >= 0]
        place = _distances(body, start, way, row, cell)
        rays.append(row)
        cells.append(cell)
        places.append(place)
        # By rounding a hit may lie behind the start of its ray, which goes on all the same.
        s[row] = np.maximum(place, s[row]) + STEP * body.size
        row = row[s[row] < reach[row]]
        if not len(row):
            break
    return np.concatenate(rays), np.concatenate(cells), np.concatenate(places), True


def _distances(body: Body, start: Array, way: Array, ray: Indices, cell: Indices) -> Array:
    """Return the distances of hits along their rays."""
    normal, toward = body.normals[cell], way[ray]
    against = np.einsum("ij,ij->i", toward, normal)
    s: Array = np.einsum("ij,ij->i", body.corners[cell, 0] - start[ray], normal)
    s /= np.where(against == 0, 1, against)
    # Of a triangle along the ray the distance is ill-conditioned: it stays between the corners'.
    steep = np.flatnonzero(against**2 < STEEP**2 * np.einsum("ij,ij->i", normal, normal))
    corners = body.corners[cell[steep]] - start[ray[steep], np.newaxis]
    along = np.einsum("ijk,ik->ij", corners, toward[steep])
    s[steep] = np.clip(
        s[steep], along.min(axis=1, initial=np.inf), along.max(axis=1, initial=-np.inf)
    )
    return s


def inside_length(
    solids: list[Body],
    start: Array,
    way: Array,
    reach: Array,
    report: Callable[[int], None] = lambda _: None,
) -> Array:
    """Return the length of each ray inside the union of the solids.

    Rays have unit directions, and end outside all solids; ``report`` takes the number of rays that
    are done, after each block.

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


def _events(body: Body, start: Array, way: Array, reach: Array) -> tuple[Indices, Array, Indices]:
    """Return where rays enter (-1) and leave (+1) one solid: ray, distance and change.

    Events are in the order from the end of the ray to its start, where a last event at distance 0
    makes the sum of the changes 0.
    """
    # Farther away no ray can meet the solid.
    away = np.linalg.norm(start - body.vertices.mean(axis=0), axis=1)
    reach = np.minimum(reach, away + 2 * body.size)
    ray, cell, s, repeated = hits(body, start, way, reach)
    against = np.einsum("ij,ij->i", way[ray], body.normals[cell])
    good = (against != 0) & (s > 0) & (s < reach[ray])
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


def is_inside(body: Body, place: Array) -> bool:
    """Return whether a point is inside a solid: whether its faces fill the sphere around it.

    Source: Van Oosterom and Strackee, IEEE Transactions on Biomedical Engineering 30 (1983).
    """
    a, b, c = (body.corners - place).transpose(1, 0, 2)
    la, lb, lc = (np.linalg.norm(corner, axis=1) for corner in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", *two) for two in ((a, b), (b, c), (c, a)))
    angles = 2 * np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb)
    # On the surface it is half of the sphere.
    return bool(abs(angles.sum()) > 3 * np.pi)
