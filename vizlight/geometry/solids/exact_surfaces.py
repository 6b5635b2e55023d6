"""Exact surfaces of solids: signed distances, outward normals and points on several surfaces.

Each is a surface of revolution. In a half plane that ends at its axis its profile is a circle (of a
sphere or a torus) or a straight line (of a cone, a cylinder or a plane).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Indices
from vizlight.model import kernels

#: Columns of a surface: point of the axis, unit axis, profile, and whether that is a circle.
CENTER, AXIS, PROFILE, ROUND = slice(0, 3), slice(3, 6), slice(6, 9), 9


@dataclass(frozen=True)
class Surfaces:
    """Surfaces of a solid, with distances and normals of points on different ones.

    ``rows`` (S, 10) has a point of the axis, the unit axis, the profile, and 1 for a circle and 0
    for a line. With r the distance from the axis and h the height along it, a circle (R, 0, t) has
    its centre at r = R and the radius t, and a line (a, b, c) holds a r + b h = c, with a² + b² =
    1.
    """

    rows: Array

    @classmethod
    def round(cls, center: Array, axis: Array, ring: float, tube: float) -> Surfaces:
        """Return the surface of a torus, or of a sphere with a ring of radius 0."""
        return cls(np.array([[*center, *axis, ring, 0, tube, 1]]))

    @classmethod
    def cone(
        cls, center: Array, axis: Array, height: float, radii: tuple[float, float]
    ) -> Surfaces:
        """Return the side of a frustum, as an infinite cone or cylinder."""
        profile = np.array([height, radii[1] - radii[0], height * sum(radii) / 2])
        size = math.hypot(height, radii[1] - radii[0])
        # Without height and slope the side has no area, and is that of a cylinder.
        profile = profile / size if size > 0 else np.array([1, 0, radii[0]])
        return cls(np.array([[*center, *axis, *profile, 0]]))

    @classmethod
    def planes(cls, centers: Array, outward: Array) -> Surfaces:
        """Return planes through points."""
        line = np.tile([0.0, 1.0, 0.0, 0.0], (len(centers), 1))
        return cls(np.column_stack([centers, outward, line]))

    def __len__(self) -> int:
        return len(self.rows)

    def distance(self, points: Array, which: Indices | int) -> Array:
        """Return the signed distances of points from surfaces, negative inside."""
        rows = self.rows[which]
        _, r, h = _cylindrical(rows, points)
        a, b, c = np.moveaxis(rows[..., PROFILE], -1, 0)
        # Beyond the apex of a cone the radius is negative, and all points there are outside.
        return np.asarray(np.where(rows[..., ROUND] > 0, np.hypot(r - a, h), a * r + b * h) - c)

    def normal(self, points: Array, which: Indices | int) -> Array:
        """Return the outward unit normals of surfaces; on an axis they are parallel to it."""
        rows = self.rows[which]
        out, r, h = _cylindrical(rows, points)
        a, b, _ = np.moveaxis(rows[..., PROFILE], -1, 0)
        circle = rows[..., ROUND] > 0
        across, along = np.where(circle, r - a, a), np.where(circle, h, b)
        ways = across[..., np.newaxis] * out + along[..., np.newaxis] * rows[..., AXIS]
        return kernels.unit_rows(ways.reshape(-1, 3)).reshape(ways.shape)

    def keys(self, signs: Array) -> Array:
        """Return rows that are equal for equal surfaces with equal normals times signs."""
        center, axis, circle = self.rows[:, CENTER], self.rows[:, AXIS], self.rows[:, ROUND] > 0
        # An axis and its opposite are the same: the largest component is made positive.
        largest = np.take_along_axis(axis, np.abs(axis).argmax(axis=1)[:, np.newaxis], axis=1)
        up = np.copysign(1, largest)
        along = np.einsum("ij,ij->i", center, axis)[:, np.newaxis]
        a, b, c = self.rows[:, PROFILE].T[:, :, np.newaxis]
        # Frustums of one infinite cone have different centres; the point of the axis that is
        # nearest to the origin is the same for all. A plane has no axis of its own.
        foot = np.where(circle[:, np.newaxis], center, (a != 0) * (center - along * axis))
        profile = signs[:, np.newaxis] * np.hstack([a, up * b, c + b * along])
        return np.column_stack([up * axis, foot, profile, circle])

    @property
    def apexes(self) -> Iterator[tuple[int, Array]]:
        """The index of each cone, and the point in which it ends."""
        for i in np.flatnonzero(self.rows[:, 6] * self.rows[:, 7]):
            row = self.rows[i]
            yield int(i), row[CENTER] + row[8] / row[7] * row[AXIS]


#: Sum of distances below which a point is on all its surfaces, and rounds of Newton's method where
#: more than that remains.
NEAR, MORE = 1e-10, 40
#: Largest step of a point that is moved onto several surfaces, and largest distance in all, in
#: units of its distance from them.
STEP, WIDE = 50, 200


def _cylindrical(rows: Array, points: Array) -> tuple[Array, Array, Array]:
    """Return the ways outward from axes to points, with distances and heights."""
    axis, rel = rows[..., AXIS], points - rows[..., CENTER]
    height = np.einsum("...j,...j->...", rel, axis)
    across = rel - height[..., np.newaxis] * axis
    size = np.sqrt(np.einsum("...j,...j->...", across, across))
    # On the axis no way leads outward, and the zero vector stays, without a division by zero.
    return across / np.where(size > 0, size, 1)[..., np.newaxis], size, height


def onto(surfaces: Surfaces, points: Array, which: Indices, rounds: int = 4) -> Array:
    """Return nearby points that are on all the surfaces that each row of ``which`` names.

    The method is Newton's with the shortest step; each round squares the error. Where surfaces
    nearly touch it needs more rounds. A point is on the first surface only, if they do not meet
    near it.
    """
    # What all rows repeat is left out.
    several = np.any(which != which[:, :1], axis=0)
    several[0] = True
    which = which[:, several]
    _, before = _newton(surfaces, points, which, 0)
    moved, off = _newton(surfaces, points, which, rounds)
    far = np.flatnonzero(off > NEAR)
    if len(far):
        moved[far], off[far] = _newton(surfaces, moved[far], which[far], MORE)
    # A point that went far has found another crossing than its own, or none.
    failed = np.flatnonzero((off > NEAR) | (np.linalg.norm(moved - points, axis=1) > WIDE * before))
    if len(failed):
        moved[failed], _ = _newton(surfaces, points[failed], which[failed, :1], rounds)
    return moved


def _newton(surfaces: Surfaces, points: Array, which: Indices, rounds: int) -> tuple[Array, Array]:
    """Return the points, and the sum of their distances from the surfaces."""
    distance = surfaces.distance(points[:, np.newaxis], which)
    for _ in range(rounds):
        # At the rounding of normalised points.
        if not np.abs(distance).max(initial=0) > 1e-15:
            break
        normal = surfaces.normal(points[:, np.newaxis], which)
        # What is added keeps the system solvable where normals are parallel, as those of a surface
        # that is named twice.
        gram = normal @ normal.transpose(0, 2, 1) + 1e-14 * np.eye(which.shape[1])
        weight = np.linalg.solve(gram, distance[:, :, np.newaxis])
        # The shortest step s with N s = d, for normals N and distances d, is N^T (N N^T)^-1 d.
        step = np.einsum("nji,nj->ni", normal, weight[:, :, 0])
        size = np.sqrt(np.einsum("ij,ij->i", step, step))
        # Where normals are nearly parallel the step to where their planes meet is far too long.
        limit = STEP * np.abs(distance).sum(axis=1)
        points = points - step * np.minimum(1, limit / np.where(size > 0, size, 1))[:, np.newaxis]
        distance = surfaces.distance(points[:, np.newaxis], which)
    return points.copy(), np.abs(distance).sum(axis=1)
