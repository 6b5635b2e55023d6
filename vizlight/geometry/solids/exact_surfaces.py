"""Surfaces of solids: signed distance and outward normal."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Bools, Indices
from vizlight.model import kernels


@dataclass(frozen=True)
class Ball:
    """The surface of a sphere."""

    center: Array
    radius: float

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        return _sizes(points - self.center) - self.radius

    def normal(self, points: Array) -> Array:
        """Return outward unit normals."""
        return kernels.unit_rows(points - self.center)

    def key(self, sign: float) -> tuple[float, ...]:
        """Return numbers that are equal for equal surfaces with equal normals times ``sign``."""
        # The first number tells the kinds apart, and zeros fill up ten, so that all keys are rows
        # of one array.
        return (0, sign, *self.center, self.radius, 0, 0, 0, 0)


@dataclass(frozen=True)
class Plane:
    """The plane of a flat face."""

    center: Array
    outward: Array

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        return np.asarray((points - self.center) @ self.outward)

    def normal(self, points: Array) -> Array:
        """Return the outward unit normal for each point."""
        return np.broadcast_to(self.outward, points.shape)

    def key(self, sign: float) -> tuple[float, ...]:
        """Return numbers that are equal for equal surfaces with equal normals times ``sign``."""
        # The sign is in the normal: one plane with solids on both sides of it has two keys.
        normal = sign * self.outward
        return (1, *normal, float(normal @ self.center), 0, 0, 0, 0, 0)


@dataclass(frozen=True)
class Cone:
    """The side of a frustum, as an infinite cone or cylinder."""

    center: Array
    axis: Array
    height: float
    radii: tuple[float, float]

    @property
    def slope(self) -> float:
        """Growth of the radius along the axis."""
        return (self.radii[0] - self.radii[1]) / self.height

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        along, size, _ = _cylindrical(self.center, self.axis, points)
        # Across the axis so far; times the cosine of the cone's half angle it is the distance from
        # the side. Beyond the apex the radius is negative, and all points there are outside.
        away = size - (sum(self.radii) / 2 + self.slope * along)
        return np.asarray(away / math.hypot(1, self.slope))

    def normal(self, points: Array) -> Array:
        """Return outward unit normals; at the apex the normal is parallel to the axis."""
        _, _, unit = _cylindrical(self.center, self.axis, points)
        # The gradient of the distance, but for its length.
        return kernels.unit_rows(unit - self.slope * self.axis)

    def key(self, sign: float) -> tuple[float, ...]:
        """Return numbers that are equal for equal surfaces with equal normals times ``sign``."""
        # A cone is the same for an axis and its opposite: the largest component is made positive.
        up = math.copysign(1, self.axis[np.abs(self.axis).argmax()])
        along = float(self.center @ self.axis)
        # Frustums of one infinite cone have different centres; the point of the axis that is
        # nearest to the origin is the same for all.
        foot = self.center - along * self.axis
        radius = sum(self.radii) / 2 - self.slope * along
        return (2, sign, *(up * self.axis), *foot, radius, up * self.slope)


@dataclass(frozen=True)
class Ring:
    """The surface of a torus."""

    center: Array
    axis: Array
    ring: float
    tube: float

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        along, size, _ = _cylindrical(self.center, self.axis, points)
        # In a half plane that ends at the axis the surface is a circle about the point (ring, 0).
        return np.asarray(np.hypot(size - self.ring, along) - self.tube)

    def normal(self, points: Array) -> Array:
        """Return outward unit normals; on the axis the normal is parallel to it."""
        along, size, unit = _cylindrical(self.center, self.axis, points)
        out = (size - self.ring)[:, np.newaxis] * unit
        return kernels.unit_rows(out + along[:, np.newaxis] * self.axis)

    def key(self, sign: float) -> tuple[float, ...]:
        """Return numbers that are equal for equal surfaces with equal normals times ``sign``."""
        # A torus is the same for an axis and its opposite: the largest component is made positive.
        up = math.copysign(1, self.axis[np.abs(self.axis).argmax()])
        return (3, sign, *(up * self.axis), *self.center, self.ring, self.tube)


Surface = Ball | Plane | Cone | Ring


class Surfaces(tuple[Surface, ...]):
    """Surfaces of a solid, with distances and normals of points on different ones."""

    @functools.cached_property
    def _planes(self) -> tuple[Bools, Array, Array]:
        """Return which surfaces are planes, and their centres and normals."""
        flat = np.array([isinstance(surface, Plane) for surface in self], np.bool_)
        # Curved surfaces get zeros, so that all can be picked by one array of numbers.
        planes = [(s.center, s.outward) if isinstance(s, Plane) else np.zeros((2, 3)) for s in self]
        center, outward = np.array(planes, np.float64).reshape(-1, 2, 3).transpose(1, 0, 2)
        return flat, center, outward

    def _curved(self, which: Indices) -> Iterator[tuple[Surface, Bools]]:
        """Yield each surface that is not a plane, and the mask of its points."""
        curved = ~self._planes[0][which]
        for i in np.unique(which[curved]) if curved.any() else ():
            yield self[i], which == i

    def distance(self, points: Array, which: Indices) -> Array:
        """Return the signed distance of each point from one surface, negative inside."""
        _, center, outward = self._planes
        # All as planes first, without a loop: a polyhedron may have thousands. Those on curved
        # surfaces are then replaced.
        distances = np.einsum("ij,ij->i", points - center[which], outward[which])
        for surface, rows in self._curved(which):
            distances[rows] = surface.distance(points[rows])
        return np.asarray(distances)

    def normal(self, points: Array, which: Indices) -> Array:
        """Return the outward unit normal of one surface at each point."""
        normals = self._planes[2][which]
        for surface, rows in self._curved(which):
            normals[rows] = surface.normal(points[rows])
        return np.asarray(normals)

    @property
    def apexes(self) -> Iterator[tuple[int, Array]]:
        """The index of each cone that ends in a point, and the point."""
        for i, surface in enumerate(self):
            if isinstance(surface, Cone) and min(surface.radii) == 0:
                # The first end is the one that the axis points to.
                side = 1 if surface.radii[0] == 0 else -1
                yield i, surface.center + side * (surface.height / 2 * surface.axis)


#: Sum of distances below which a point is on all its surfaces, and rounds of Newton's method where
#: more than that remains.
NEAR, MORE = 1e-10, 40
#: Largest step of a point that is moved onto several surfaces, and largest distance in all, in
#: units of its distance from them.
STEP, WIDE = 50, 200


def _cylindrical(center: Array, axis: Array, points: Array) -> tuple[Array, Array, Array]:
    """Return the height of points along an axis, their distance from it, and the way outward."""
    rel = points - center
    along = rel @ axis
    across = rel - along[:, np.newaxis] * axis
    size = _sizes(across)
    # On the axis no way leads outward, and the zero vector stays, without a division by zero.
    return along, size, across / np.where(size > 0, size, 1)[:, np.newaxis]


def _sizes(vectors: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def onto(surfaces: Surfaces, points: Array, both: Indices, rounds: int = 4) -> Array:
    """Return nearby points that are on all the surfaces that each row of ``both`` names.

    The method is Newton's with the shortest step; each round squares the error. Where surfaces
    nearly touch it needs more rounds. A point is on the first surface only, if they do not meet
    near it.
    """
    points = points.copy()
    # Rows that name one surface only need no system of equations.
    single = np.all(both == both[:, :1], axis=1)
    on = np.flatnonzero(~single)
    if len(on):
        # Without a round of Newton's method: the distances at the start, with which the way is
        # compared.
        _, before = _onto_all(surfaces, points[on], both[on], 0)
        crossing, off = _onto_all(surfaces, points[on], both[on], rounds)
        far = np.flatnonzero(off > NEAR)
        if len(far):
            crossing[far], off[far] = _onto_all(surfaces, crossing[far], both[on[far]], MORE)
        moved = _sizes(crossing - points[on])
        # A point that went far has found another crossing than its own, or none: it stays on one
        # surface.
        met = (off <= NEAR) & (moved <= WIDE * before)
        points[on[met]] = crossing[met]
        single[on] = ~met
    rows = np.flatnonzero(single)
    for _ in range(rounds if len(rows) else 0):
        distance = surfaces.distance(points[rows], both[rows, 0])
        # At the rounding of normalised points.
        if not np.abs(distance).max(initial=0) > 1e-15:
            break
        normal = surfaces.normal(points[rows], both[rows, 0])
        points[rows] -= distance[:, np.newaxis] * normal
    return points


def _onto_all(
    surfaces: Surfaces, points: Array, which: Indices, rounds: int
) -> tuple[Array, Array]:
    """Return the points, and the sum of their distances from the surfaces."""
    count = which.shape[1]
    pairs = [(j, k) for j in range(count) for k in range(j)]
    # A surface that a row names twice counts once: its second column is left blank below.
    same = [(j, which[:, j] == which[:, k]) for j, k in pairs]
    for last in (*[False] * rounds, True):
        distance = np.zeros(which.shape)
        normal = np.zeros((*which.shape, 3))
        for j in range(count):
            distance[:, j] = surfaces.distance(points, which[:, j])
            if not last:
                normal[:, j] = surfaces.normal(points, which[:, j])
        for j, rows in same:
            distance[rows, j] = 0
            normal[rows, j] = 0
        if last or not np.abs(distance).max(initial=0) > 1e-15:
            break
        gram = normal @ normal.transpose(0, 2, 1)
        # Keeps the system solvable where normals are parallel.
        gram += 1e-14 * np.eye(count)
        # A blank column would make the system singular: with a 1 its equation is that its weight is
        # 0.
        gram += np.eye(count) * (np.einsum("nii->ni", gram) < 0.5)[:, :, np.newaxis]
        weight = np.linalg.solve(gram, distance[:, :, np.newaxis])
        # The shortest step s with N s = d, for normals N and distances d, is N^T (N N^T)^-1 d.
        step = np.einsum("nji,nj->ni", normal, weight[:, :, 0])
        size = _sizes(step)
        # Where normals are nearly parallel the step to where their planes meet is far too long.
        limit = STEP * np.abs(distance).sum(axis=1)
        step *= np.minimum(1, limit / np.where(size > 0, size, 1))[:, np.newaxis]
        points = points - step
    return points, np.abs(distance).sum(axis=1)
