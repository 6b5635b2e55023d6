"""Closed meshes as solids: are they closed, and how far does a ray run inside them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkIdList
from vtkmodules.vtkCommonDataModel import vtkStaticCellLocator

from vizlight import _check
from vizlight.mesh import embree_rays

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: Rays of which the hits are held at once.
BLOCK = 1 << 15
#: How near an edge, as a share of the solid, a triangle still counts as hit, and how near each
#: other two hits are one.
NEAR = 1e-10


@dataclass(frozen=True)
class Solid:
    """Triangles of a closed surface in float64, relative to an origin, and a search tree.

    The tree is Embree's where the package embreex is installed, else VTK's.
    """

    vertices: Array
    triangles: Indices
    normals: Array
    locator: Any
    embree: Any = None

    @property
    def size(self) -> float:
        """The diagonal of the box around it."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))


def triangles_of(surface: Any, name: str) -> tuple[Array, Indices]:
    """Return corners and triangles of a surface, corners of one place being one."""
    vertices, triangles, _, _ = _merged(surface, name)
    return vertices, triangles


def _merged(surface: Any, name: str) -> tuple[Array, Indices, Indices, Indices]:
    """Return corners, triangles, the points that faces use, and which corner each of them is."""
    if not isinstance(surface, pv.PolyData):
        remedy = "take the mesh's extract_surface()"
        raise TypeError(
            _check.message(name, "a pyvista.PolyData surface", type(surface).__name__, remedy)
        )
    if not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        raise ValueError(_check.message(name, "a surface with faces", "a mesh without"))
    faces = surface if surface.is_all_triangles else surface.triangulate()
    corners = np.asarray(faces.regular_faces, dtype=np.intp)
    points = np.asarray(faces.points, dtype=np.float64)
    if not np.all(np.isfinite(points[corners])):
        raise ValueError(_check.message(name, "faces with finite points", "others"))
    used, place = np.unique(corners, return_inverse=True)
    vertices, same = np.unique(points[used], axis=0, return_inverse=True)
    same = same.reshape(-1)
    corners = same[place].reshape(-1, 3)
    a, b, c = corners.T
    return vertices, corners[(a != b) & (b != c) & (c != a)], used, same


def closed(surface: Any, name: str = "mesh") -> tuple[Array, Indices]:
    """Return corners and triangles of a closed surface, turned alike.

    Raises
    ------
    TypeError, ValueError
        If it is not a surface, or not closed; the message says how to repair it.
    """
    vertices, triangles = triangles_of(surface, name)
    opened = _open_edges(triangles, directed=False)
    if len(opened):
        raise ValueError(
            _check.message(
                name,
                "a closed surface",
                f"one with {len(opened)} open edges",
                "mesh.clean(tolerance=) joins seams and mesh.fill_holes(size) closes holes; "
                "thickness= lights an open surface as a shell",
            )
        )
    if len(_open_edges(triangles, directed=True)):
        alike = _mesh_of(vertices, triangles).compute_normals(
            cell_normals=False, split_vertices=False, auto_orient_normals=True
        )
        # VTK drops points without faces, so the points are taken from it too.
        vertices = np.asarray(alike.points, dtype=np.float64)
        triangles = np.asarray(alike.regular_faces, dtype=np.intp)
        if len(_open_edges(triangles, directed=True)):
            raise ValueError(
                _check.message(name, "a surface with an inside", "one that cannot be oriented")
            )
    return vertices, triangles


def shell(surface: Any, thickness: float, normals: Array) -> tuple[Array, Indices]:
    """Return an open surface made closed: itself, its copy along -normals, walls between."""
    vertices, triangles, used, same = _merged(surface, "mesh")
    # Corners of one place are one here, so they share the sum of their normals.
    total = np.zeros_like(vertices)
    np.add.at(total, same, normals[used])
    size = np.linalg.norm(total, axis=1, keepdims=True)
    under = vertices - thickness * total / np.where(size > 0, size, 1)
    n = len(vertices)
    a, b = _open_edges(triangles, directed=True).T
    walls = [np.stack([b, a, a + n], axis=1), np.stack([b, a + n, b + n], axis=1)]
    faces = np.concatenate([triangles, triangles[:, ::-1] + n, *walls])
    if len(_open_edges(faces, directed=True)):
        remedy = "mesh.compute_normals(consistent_normals=True) turns faces alike"
        raise ValueError(
            _check.message("mesh", "a surface whose faces are turned alike", "another", remedy)
        )
    return np.concatenate([vertices, under]), faces


def _open_edges(triangles: Indices, *, directed: bool) -> Indices:
    """Return edges that have no partner: none in the other sense, or an odd number in all."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forward = edges[:, 0] < edges[:, 1]
    pairs, which = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    if not directed:
        odd = np.bincount(which.reshape(-1), minlength=len(pairs)) % 2 == 1
        return np.asarray(pairs[odd])
    surplus = np.bincount(which.reshape(-1), np.where(forward, 1, -1), minlength=len(pairs))
    one = pairs[surplus > 0], pairs[surplus < 0][:, ::-1]
    return np.concatenate(one)


def solid(
    vertices: Array, triangles: Indices, origin: Array, unit: float = 1.0, *, embree: bool = True
) -> Solid:
    """Return a solid ready for rays, its corners less an origin and over a unit of length."""
    place = (vertices - origin) / unit
    a, b, c = (place[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    scene = embree_rays.tree(place[triangles]) if embree else None
    if scene is not None:
        return Solid(place, triangles, normals, None, scene)
    mesh = _mesh_of(place, triangles)
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    return Solid(place, triangles, normals, locator)


def _mesh_of(vertices: Any, triangles: Any) -> Any:
    return pv.PolyData.from_regular_faces(vertices, triangles)


def hits(body: Solid, start: Array, way: Array, reach: Array) -> tuple[Indices, Indices]:
    """Return which rays hit which triangles, all of them.

    VTK takes one ray a call, some 7 microseconds each; Embree takes all, some 0.8 each.
    """
    if body.embree is not None:
        corner = body.vertices[body.triangles[:, 0]]
        return embree_rays.hits(body.embree, corner, body.normals, body.size, start, way, reach)
    end = start + way * reach[:, np.newaxis]
    find, found = body.locator.IntersectWithLine, vtkIdList()
    tolerance = NEAR * body.size
    rays: list[int] = []
    cells: list[int] = []
    for ray, (a, b) in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
        find(a, b, tolerance, None, found)
        for k in range(found.GetNumberOfIds()):
            rays.append(ray)
            cells.append(found.GetId(k))
    return np.array(rays, dtype=np.intp), np.array(cells, dtype=np.intp)


def inside_length(solids: list[Solid], start: Array, way: Array, reach: Array) -> Array:
    """Return how far rays run inside any of the solids.

    Parameters
    ----------
    solids : list of Solid
    start, way : ndarray, shape (N, 3)
        Places and unit directions.
    reach : ndarray, shape (N,)
        Length of the rays; their ends are outside of all solids.

    Returns
    -------
    ndarray, shape (N,)

    Notes
    -----
    A hit on an edge that triangles share is found once for each of them: hits of one place and
    one sense are one. A place is inside where the hits beyond it do not balance.
    """
    length = np.zeros(len(start))
    for first in range(0, len(start), BLOCK):
        rows = slice(first, first + BLOCK)
        events = [_events(body, start[rows], way[rows], reach[rows]) for body in solids]
        ray, s, change = (np.concatenate(part) for part in zip(*events, strict=True))
        # From the far end, where all is outside, to the start.
        order = np.lexsort((-s, ray))
        ray, s, change = ray[order], s[order], change[order]
        ends = np.append(ray[1:] != ray[:-1], True)[: len(ray)]
        inside = np.cumsum(change) > 0
        nearer = np.where(ends, 0.0, np.append(s[1:], 0.0)[: len(s)])
        np.add.at(length[rows], ray, np.where(inside, s - nearer, 0.0))
    return length


def _events(body: Solid, start: Array, way: Array, reach: Array) -> tuple[Indices, Array, Indices]:
    """Return where rays enter (-1) and leave (+1) one solid, seen from their far end.

    Every ray has a last event at 0 that undoes what is still open.
    """
    reach = np.minimum(reach, _beyond(body, start))
    ray, cell = hits(body, start, way, reach)
    normal = body.normals[cell]
    against = np.einsum("ij,ij->i", way[ray], normal)
    corner = body.vertices[body.triangles[cell, 0]] - start[ray]
    flat = against == 0
    s = np.einsum("ij,ij->i", corner, normal) / np.where(flat, 1, against)
    good = ~flat & (s > 0) & (s < reach[ray])
    ray, s, sense = ray[good], s[good], np.sign(against[good]).astype(np.intp)

    order = np.lexsort((s, sense, ray))
    ray, s, sense = ray[order], s[order], sense[order]
    again = (ray[1:] == ray[:-1]) & (sense[1:] == sense[:-1]) & (np.diff(s) <= NEAR * body.size)
    once = np.append(True, ~again)[: len(ray)]
    ray, s, sense = ray[once], s[once], sense[once]

    order = np.lexsort((-s, ray))
    ray, s, sense = ray[order], s[order], sense[order]
    # How often the solid is around the ray just before each hit; the sum of a ray ends at 0.
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


def _beyond(body: Solid, start: Array) -> Array:
    """Return how far rays may run until they are past the solid."""
    centre = body.vertices.mean(axis=0)
    return np.asarray(np.linalg.norm(start - centre, axis=1) + 2 * body.size)


def is_inside(body: Solid, place: Array) -> bool:
    """Say whether a place is inside a solid."""
    if np.any(place < body.vertices.min(axis=0)) or np.any(place > body.vertices.max(axis=0)):
        return False
    for way in np.array([[0.6, 0.48, 0.64], [-0.48, 0.64, 0.6], [0.64, 0.6, -0.48]]):
        start = place[np.newaxis]
        ray, _, change = _events(body, start, way[np.newaxis], np.array([np.inf]))
        if not len(ray) or change[:-1].sum() <= 0:
            return False
    return True
