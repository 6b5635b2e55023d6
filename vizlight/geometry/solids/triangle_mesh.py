"""Coarse closed meshes of single primitives; each triangle belongs to one exact surface."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Indices
from vizlight.geometry import axial
from vizlight.geometry.solids.exact_surfaces import Surfaces
from vizlight.geometry.solids.polyhedra import HalfSpace, Polyhedron
from vizlight.geometry.solids.primitives import Block, Frustum, Primitive, Sphere, Torus

#: Corners of the faces of a block, x before y before z, the side of larger coordinates first.
_FACES = (
    (7, 5, 4, 6), (2, 0, 1, 3), (7, 6, 2, 3), (1, 0, 4, 5), (7, 3, 1, 5), (4, 0, 2, 6),
)  # fmt: skip


@dataclass(frozen=True)
class Mesh:
    """Triangles of a solid, each on one of its surfaces, in normalised lengths.

    Attributes
    ----------
    points : ndarray, shape (P, 3)
        Normalised points ``(x - shift) / scale`` of points x.
    triangles : ndarray of int, shape (T, 3)
        Indices of corners, counter-clockwise seen from outside.
    patch : ndarray of int, shape (T,)
        Index of the surface of each triangle.
    surfaces : Surfaces
        Exact surfaces, in normalised lengths.
    signs : ndarray, shape (number of surfaces,)
        -1 for a surface that the solid lies outside of, else 1.
    shift : ndarray, shape (3,)
        Origin of the normalised points, in the unit of the solid.
    scale : float
        Length of one normalised unit.
    volume_error : float
        Bound of the difference between this volume and the exact solid's, in normalised lengths.
    """

    points: Array
    triangles: Indices
    patch: Indices
    surfaces: Surfaces
    signs: Array
    shift: Array
    scale: float
    volume_error: float = 0.0

    def world(self, points: Array) -> Array:
        """Return points in the unit of the solid."""
        return np.asarray(self.shift + self.scale * points)

    @property
    def volume(self) -> float:
        """The volume inside the triangles, in normalised lengths."""
        corners = self.points[self.triangles]
        # The determinant of three corners is six times the volume of their tetrahedron with the
        # origin.
        return float(np.linalg.det(corners).sum()) / 6

    @property
    def volume_missing(self) -> float:
        """The estimated volume between triangles and exact surfaces, in normalised lengths.

        The height of the surface over a triangle is averaged over the middles of its edges, which
        is exact for a quadratic height.
        """
        corners = self.points[self.triangles]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        height = np.zeros(len(across))
        for j in range(3):
            middle = (corners[:, j] + corners[:, (j + 1) % 3]) / 2
            # The distance of a point inside is negative, and so the surface above it is at a
            # positive height.
            height -= self.signs[self.patch] * self.surfaces.distance(middle, self.patch) / 3
        area = np.sqrt(np.einsum("ij,ij->i", across, across)) / 2
        return abs(float(area @ height))

    def replace(self, points: Array, triangles: Indices, patch: Indices) -> Mesh:
        """Return a mesh of other triangles on the same surfaces."""
        return dataclasses.replace(self, points=points, triangles=triangles, patch=patch)


def mesh(solid: Primitive, segments: int) -> Mesh:
    """Return a coarse closed mesh of one primitive, with at least ``segments`` per circle.

    A flat shape without volume consists of its two faces; a shape without area has no triangles.
    """
    if isinstance(solid, HalfSpace):
        solid = solid.block()
    shift, scale = solid.box()
    # A shape without any extent would be divided by 0.
    scale = scale or 1.0
    unit = solid.moved(shift, scale)
    if isinstance(unit, Sphere) and not unit.empty:
        points, triangles, patch = _ball(unit, segments)
    elif isinstance(unit, Torus) and not unit.empty:
        points, triangles, patch = _torus(unit, segments)
    elif isinstance(unit, Frustum):
        points, triangles, patch = _frustum(unit, segments)
    elif isinstance(unit, Block):
        points, triangles, patch = _block(unit)
    elif isinstance(unit, Polyhedron):
        points, triangles, patch = unit.points, unit.triangles, unit.patch
    else:
        points, triangles, patch = np.empty((0, 3)), np.empty((0, 3), np.intp), np.empty(0, np.intp)
    faces = Surfaces(unit.surfaces())
    hull = Mesh(points, triangles, patch, faces, np.ones(len(faces)), np.asarray(shift), scale)
    return dataclasses.replace(hull, volume_error=missed(unit, segments, hull.volume))


def missed(unit: Primitive, segments: int, volume: float) -> float:
    """Return a bound of the volume between a primitive and its facets, of a given volume.

    The facets of a torus are inside and outside of it, within a shell about its surface.
    """
    if isinstance(unit, Torus):
        # Twice the area 4 pi^2 R r, times the distance, is the volume of the shell within it on
        # both sides.
        area = 4 * math.pi**2 * unit.ring_radius
        return 2 * area * unit.tube_radius * ring_error(unit, segments)
    # What planes bound is exact; the number left covers the rounding of sums.
    return 1e-14 if isinstance(unit, Polyhedron | HalfSpace) else abs(unit.volume - volume) + 1e-14


def _across_segments(unit: Torus, segments: int) -> int:
    """Return the number of segments of a torus's cross-section."""
    # The sagitta is r / n^2 but for a factor: it becomes the same around the tube as around the
    # ring.
    return max(12, math.ceil(segments * math.sqrt(unit.tube_radius / unit.roundness)))


def ring_error(unit: Torus, segments: int) -> float:
    """Return a bound of the distance of a torus's triangles from its surface.

    Linear interpolation of a function of two angles u and v misses at most
    ``(u^2 |f_uu| + 2 u v |f_uv| + v^2 |f_vv|) / 8`` for steps u and v.
    """
    u, v = 2 * math.pi / segments, 2 * math.pi / _across_segments(unit, segments)
    return (u * u * unit.roundness + (2 * u * v + v * v) * unit.tube_radius) / 8


def _torus(unit: Torus, segments: int) -> tuple[Array, Indices, Indices]:
    rows = _across_segments(unit, segments)
    first, second = axial.frame(unit.axis)
    u = 2 * np.pi * np.arange(segments)[:, np.newaxis] / segments
    v = 2 * np.pi * np.arange(rows) / rows
    out = unit.ring_radius + unit.tube_radius * np.cos(v)
    parts = ((np.cos(u) * out, first), (np.sin(u) * out, second))
    up = np.broadcast_to(unit.tube_radius * np.sin(v), (segments, rows))
    points = sum((x[..., np.newaxis] * way for x, way in parts), up[..., np.newaxis] * unit.axis)
    number = np.arange(segments * rows).reshape(segments, rows)
    # Both ways around are closed: the last row meets the first.
    right, above = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(right, -1, axis=1)
    cells = [
        np.stack(x, axis=-1).reshape(-1, 3) for x in ((number, right, both), (number, both, above))
    ]
    triangles = np.concatenate(cells).astype(np.intp)
    return unit.center + points.reshape(-1, 3), triangles, np.zeros(len(triangles), np.intp)


def _ball(unit: Sphere, segments: int) -> tuple[Array, Indices, Indices]:
    from scipy.spatial import ConvexHull

    # The points are spread evenly along a spiral of the golden angle.
    # The area 4 pi by the area per point: 0.85 of the square of a segment's angle.
    count = max(int(4 * np.pi / (0.85 * (2 * np.pi / segments) ** 2)), 12)
    i = np.arange(count) + 0.5
    # Equal steps of the height are equal areas of a sphere; half steps leave the poles free.
    z = 1 - 2 * i / count
    angle = i * np.pi * (3 - math.sqrt(5))
    r = np.sqrt(1 - z * z)
    points = np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)
    # The hull of points on a sphere is their Delaunay triangulation.
    faces = ConvexHull(points).simplices.astype(np.intp)
    a, b, c = (points[faces[:, i]] for i in range(3))
    # Qhull gives the corners of its triangles in any order.
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0
    faces[inward] = faces[inward][:, ::-1]
    return unit.center + unit.radius * points, faces, np.zeros(len(faces), np.intp)


def _frustum(unit: Frustum, segments: int) -> tuple[Array, Indices, Indices]:
    ring = axial.circle(2 * np.pi * np.arange(segments) / segments, *axial.frame(unit.axis))
    half = unit.height / 2 * unit.axis
    parts, indices, start = [], [], 0
    for sign, radius in ((1, unit.radii[0]), (-1, unit.radii[1])):
        middle = unit.center + sign * half
        there = middle + radius * ring if radius > 0 else middle[np.newaxis]
        parts += [there, middle[np.newaxis]]
        # With one point for the whole end, all its segments have the same corner.
        indices.append((start + np.arange(segments) % len(there), start + len(there)))
        start += len(there) + 1
    (top, top_middle), (bottom, bottom_middle) = indices
    if unit.height == 0 and unit.radii[0] == unit.radii[1]:
        # Two discs back to back share one rim.
        bottom = top
    after, below = np.roll(top, -1), np.roll(bottom, -1)
    first, second = (radius > 0 for radius in unit.radii)
    side = unit.height > 0 or unit.radii[0] != unit.radii[1]
    # At an apex one of the two triangles of each segment has no area. The number is of the surface.
    faces = [
        (side and second, 0, (top, bottom, below)),
        (side and first, 0, (top, below, after)),
        (first, 1, (np.full(segments, top_middle), top, after)),
        (second, 2, (np.full(segments, bottom_middle), below, bottom)),
    ]
    cells = [np.stack(corners, axis=1) for there, _, corners in faces if there]
    patch = np.array([number for there, number, _ in faces if there], np.intp)
    triangles = np.concatenate([*cells, np.empty((0, 3), int)]).astype(np.intp)
    return np.concatenate(parts), triangles, np.repeat(patch, segments)


def _block(unit: Block) -> tuple[Array, Indices, Indices]:
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = unit.center + (signs * unit.size / 2) @ unit.axes
    faces = np.array(_FACES, np.intp)
    # Left-handed axes are a mirror image, which turns all faces inward.
    if np.linalg.det(unit.axes) < 0:
        faces = faces[:, ::-1]
    cells = faces[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
    # A block without thickness has its two wide faces, one of less than two sides none.
    flat = unit.size == 0
    there = np.repeat(flat if flat.any() else ~flat, 4) & (np.count_nonzero(flat) < 2)
    return points, cells[there], np.repeat(np.arange(6), 2)[there]


def split(triangles: Indices, middles: Indices) -> tuple[Indices, Indices]:
    """Return triangles with some edges halved, and the original triangle of each.

    ``middles`` holds the index of the midpoint of the edge that begins at each corner, or -1.
    """
    count = np.count_nonzero(middles >= 0, axis=1)
    rows = np.arange(len(triangles))
    # Rotate each triangle so that a single marked edge is first, or a single unmarked one last.
    first = np.where(count == 1, np.argmax(middles >= 0, axis=1), 0)
    first = np.where(count == 2, (np.argmax(middles < 0, axis=1) + 1) % 3, first)
    turn = (first[:, np.newaxis] + np.arange(3)) % 3
    a, b, c = triangles[rows[:, np.newaxis], turn].T
    p, q, r = middles[rows[:, np.newaxis], turn].T
    # By the number of halved edges: whole, in two, in three and in four.
    parts = [
        (0, (a, b, c)),
        (1, (a, p, c)), (1, (p, b, c)),
        (2, (p, b, q)), (2, (a, p, q)), (2, (a, q, c)),
        (3, (a, p, r)), (3, (p, b, q)), (3, (r, q, c)), (3, (p, q, r)),
    ]  # fmt: skip
    pieces = [np.stack([corner[count == n] for corner in corners], 1) for n, corners in parts]
    owner = [rows[count == n] for n, _ in parts]
    return np.concatenate(pieces), np.concatenate(owner)


def normals_of(mesh: Mesh, points: Array, patch: Indices) -> Array:
    """Return the outward normals of the solid at points on its surfaces."""
    return np.asarray(mesh.signs[patch][:, np.newaxis] * mesh.surfaces.normal(points, patch))
