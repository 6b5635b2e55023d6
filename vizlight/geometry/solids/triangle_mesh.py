"""Closed meshes of solids, in normalised lengths; each triangle belongs to one exact surface."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Indices
from vizlight.geometry.solids.exact_surfaces import Surfaces
from vizlight.geometry.solids.primitives import Frustum, Primitive


@dataclass(frozen=True)
class Mesh:
    """Triangles of a solid, each on one of its surfaces, in normalised lengths.

    ``points`` are ``(x - shift) / scale`` of points x, in the unit of the solid; triangles are
    counter-clockwise seen from outside, ``patch`` is the surface of each, and ``signs`` is -1 for a
    surface that the solid lies outside of, else 1. ``volume_error`` bounds the difference between
    this volume and the exact solid's, in normalised lengths.
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

    A disc without volume consists of its two faces; a shape without area has no triangles.
    """
    shift, scale = solid.box()
    # A shape without any extent would be divided by 0.
    scale = scale or 1.0
    unit = solid.moved(shift, scale)
    surfaces = unit.surfaces()
    points, triangles, patch = unit.facets(segments)
    if unit.empty and not isinstance(unit, Frustum):
        triangles, patch = triangles[:0], patch[:0]
    used, triangles = compact(triangles)
    hull = Mesh(points[used], triangles, patch, surfaces, np.ones(len(surfaces)), shift, scale)
    return dataclasses.replace(hull, volume_error=unit.missed(segments, hull.volume))


def compact(triangles: Indices) -> tuple[Indices, Indices]:
    """Return the indices of the points that are used, and triangles of these alone."""
    used, corners = np.unique(triangles, return_inverse=True)
    return used, corners.reshape(-1, 3).astype(np.intp)


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
