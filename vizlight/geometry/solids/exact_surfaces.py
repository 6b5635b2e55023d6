"""Surfaces of solids: signed distance, outward normal and sample points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.contours import axial

if TYPE_CHECKING:
    from vizlight._types import Array


@dataclass(frozen=True)
class Ball:
    """The surface of a sphere."""

    center: Array
    radius: float

    @property
    def area(self) -> float:
        """The area of the sphere."""
        return 4 * math.pi * self.radius**2

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        return _sizes(points - self.center) - self.radius

    def normal(self, points: Array) -> Array:
        """Return outward unit normals."""
        return _unit_rows(points - self.center)

    def samples(self, spacing: float, _: np.random.Generator) -> Array:
        """Return points about ``spacing`` apart."""
        count = max(int(4 * np.pi * self.radius**2 / (0.85 * spacing**2)), 12)
        return np.asarray(self.center + self.radius * fibonacci(count))


@dataclass(frozen=True)
class Plane:
    """The plane of a face, which is a disc or a rectangle."""

    center: Array
    outward: Array
    extent: tuple[float, float]
    across: tuple[Array, Array]

    @property
    def area(self) -> float:
        """The area of the rectangle of half widths ``extent``."""
        return 4 * self.extent[0] * self.extent[1]

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        return np.asarray((points - self.center) @ self.outward)

    def normal(self, points: Array) -> Array:
        """Return the outward unit normal for each point."""
        return np.broadcast_to(self.outward, points.shape)

    def samples(self, spacing: float, random: np.random.Generator) -> Array:
        """Return points about ``spacing`` apart on the rectangle of half widths ``extent``."""
        rows = [
            np.arange(-s - spacing, s + spacing, f * spacing)
            for s, f in zip(self.extent, (1, 0.866), strict=True)
        ]
        u, v = np.meshgrid(*rows, indexing="ij")
        u = u + 0.5 * spacing * (np.arange(len(rows[1])) % 2)
        # No three points are collinear: tetrahedra along a line would have no volume.
        u, v = (x + spacing * random.uniform(-0.15, 0.15, x.shape) for x in (u, v))
        return np.asarray(
            self.center + u.reshape(-1, 1) * self.across[0] + v.reshape(-1, 1) * self.across[1]
        )


@dataclass(frozen=True)
class Cone:
    """The side of a frustum, as an infinite cone or cylinder."""

    center: Array
    axis: Array
    height: float
    radii: tuple[float, float]

    @property
    def area(self) -> float:
        """The area of the side between both ends."""
        slant = math.hypot(self.height, self.radii[0] - self.radii[1])
        return math.pi * sum(self.radii) * slant

    @property
    def apex(self) -> Array | None:
        """The apex of a cone; None for a frustum or a cylinder."""
        if min(self.radii) > 0:
            return None
        half = self.height / 2 * self.axis
        return self.center + half if self.radii[0] == 0 else self.center - half

    def _parts(self, points: Array) -> tuple[Array, Array, Array, float, float]:
        rel = points - self.center
        along = rel @ self.axis
        across = rel - along[:, np.newaxis] * self.axis
        slope = (self.radii[0] - self.radii[1]) / self.height
        return along, across, _sizes(across), slope, 1 / math.hypot(1, slope)

    def distance(self, points: Array) -> Array:
        """Return signed distances, negative inside."""
        along, _, size, slope, cosine = self._parts(points)
        return np.asarray((size - (sum(self.radii) / 2 + slope * along)) * cosine)

    def normal(self, points: Array) -> Array:
        """Return outward unit normals; at the apex the normal is parallel to the axis."""
        _, across, size, slope, cosine = self._parts(points)
        unit = across / np.where(size > 0, size, 1)[:, np.newaxis]
        return np.asarray(_unit_rows(cosine * (unit - slope * self.axis)))

    def samples(self, spacing: float, random: np.random.Generator) -> Array:
        """Return points about ``spacing`` apart."""
        slant = math.hypot(self.height, self.radii[0] - self.radii[1])
        rows = max(int(slant / (0.866 * spacing)), 1)
        share = (np.arange(rows) + 0.5) / rows
        radius = self.radii[1] + share * (self.radii[0] - self.radii[1])
        count = np.maximum((2 * np.pi * radius / spacing).astype(int), 5)
        row = np.repeat(np.arange(rows), count)
        turn = (np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)) / count[row]
        # No two points share a ruling: tetrahedra along it would have no volume.
        turn += random.uniform(-0.15, 0.15, len(row)) / count[row]
        angle = 2 * np.pi * (turn + 0.382 * row)
        first, second = axial.frame(self.axis)
        ring = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
        lift = ((share - 0.5) * self.height)[row]
        return np.asarray(self.center + lift[:, None] * self.axis + radius[row][:, None] * ring)


Surface = Ball | Plane | Cone


def fibonacci(count: int) -> Array:
    """Return ``count`` points spread evenly over the unit sphere."""
    i = np.arange(count) + 0.5
    z = 1 - 2 * i / count
    angle = i * np.pi * (3 - math.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1)


def _sizes(vectors: Array) -> Array:
    return np.asarray(np.sqrt(np.einsum("ij,ij->i", vectors, vectors)))


def _unit_rows(vectors: Array) -> Array:
    size = _sizes(vectors)[:, np.newaxis]
    return np.asarray(vectors / np.where(size > 0, size, 1))
