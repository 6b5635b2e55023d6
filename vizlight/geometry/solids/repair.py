"""Flipped triangles removed by flipping, collapsing and splitting edges."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.solids import triangle_mesh
from vizlight.geometry.solids.exact_surfaces import onto

if TYPE_CHECKING:
    from collections.abc import Iterator

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.solids.triangle_mesh import Mesh

    Triangle = tuple[int, int, int]
    #: Triangles to remove, and triangles to add with the surface of each.
    Change = tuple[list[int], list[Triangle], list[int]]

#: Passes over the triangles that are still flipped.
PASSES = 6
#: Twice the area below which a triangle has no side, to rounding of normalised points.
FLAT = 1e-14


def flipped(mesh: Mesh) -> Bools:
    """Return the triangles whose normal points into the solid."""
    return np.asarray(_upward(mesh, mesh.points[mesh.triangles], mesh.patch) < -FLAT)


def _upward(mesh: Mesh, corners: Array, patch: Indices) -> Array:
    """Return twice the area of triangles, negative where their normal points into the solid."""
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = triangle_mesh.normals_of(mesh, corners.mean(axis=1), patch)
    return np.asarray(np.einsum("ij,ij->i", across, normal))


def upright(mesh: Mesh) -> Mesh:
    """Return a mesh without flipped triangles, as far as changes of its edges allow.

    Parameters
    ----------
    mesh : Mesh
        Closed mesh with points on its surfaces.

    Returns
    -------
    Mesh
        Closed mesh with the same surfaces. An edge within a surface is flipped, an edge between
        surfaces is halved, or a point is moved along its surface or merged with a neighbour that is
        on all of its surfaces. If nothing else helps, a point is moved off its surface, onto the
        opposite edge of a flipped triangle.
    """
    bad = flipped(mesh)
    if not bad.any():
        return mesh
    editor = _Editor(mesh)
    for _ in range(PASSES):
        bad = flipped(mesh)
        if not bad.any() or not editor.mend(np.flatnonzero(bad).tolist()):
            break
        mesh = editor.mesh()
    return mesh


class _Editor:
    """Triangles of a mesh that are changed a few at a time."""

    def __init__(self, mesh: Mesh) -> None:
        self.source = mesh
        self._read()

    def _read(self) -> None:
        mesh = self.source
        self.triangles: list[Triangle | None] = [(a, b, c) for a, b, c in mesh.triangles.tolist()]
        self.patch: list[int] = mesh.patch.tolist()
        self.points = list(mesh.points)
        #: Points that are not on their surfaces.
        self.loose: set[int] = set()
        self.star: list[set[int]] = [set() for _ in self.points]
        for t, corners in enumerate(mesh.triangles.tolist()):
            for v in corners:
                self.star[v].add(t)

    def mesh(self) -> Mesh:
        """Return the mesh with all changes, and number its triangles and points anew."""
        kept = [t for t, corners in enumerate(self.triangles) if corners is not None]
        triangles = np.array([self.triangles[t] for t in kept], np.intp).reshape(-1, 3)
        used, place = np.unique(triangles, return_inverse=True)
        self.source = self.source.replace(
            np.array(self.points)[used],
            place.reshape(-1, 3).astype(np.intp),
            np.array([self.patch[t] for t in kept], np.intp),
        )
        self._read()
        return self.source

    def mend(self, bad: list[int]) -> bool:
        """Apply to each flipped triangle the change that leaves the fewest, if any does."""
        changed = False
        for t in bad:
            if self.triangles[t] is None or self._flips([self._corners(t)], [self.patch[t]]) == 0:
                continue
            best: tuple[float, ...] | None = None
            chosen: Change | None = None
            for change in self._changes(t):
                gone, new, patch = change
                before = self._flips([self._corners(i) for i in gone], [self.patch[i] for i in gone])
                after = self._flips(new, patch)
                if after < before:
                    off = any(not self.loose.isdisjoint(corners) for corners in new)
                    score = (off, after - before, self._longest(new))
                    if best is None or score < best:
                        best, chosen = score, change
            if chosen is not None:
                self._apply(chosen)
                changed = True
        return changed

    def _corners(self, t: int) -> Triangle:
        corners = self.triangles[t]
        assert corners is not None
        return corners

    def _places(self, triangles: list[Triangle]) -> Array:
        return np.array([[self.points[v] for v in corners] for corners in triangles])

    def _flips(self, triangles: list[Triangle], patch: list[int]) -> int:
        if not triangles:
            return 0
        height = _upward(self.source, self._places(triangles), np.array(patch))
        return int(np.count_nonzero(height < -FLAT))

    def _longest(self, triangles: list[Triangle]) -> float:
        if not triangles:
            return 0.0
        places = self._places(triangles)
        return float(np.abs(places - np.roll(places, 1, axis=1)).max())

    def _apply(self, change: Change) -> None:
        gone, new, patch = change
        for t in gone:
            for v in self._corners(t):
                self.star[v].discard(t)
            self.triangles[t] = None
        for corners, surface in zip(new, patch, strict=True):
            for v in corners:
                self.star[v].add(len(self.triangles))
            self.triangles.append(corners)
            self.patch.append(surface)

    def _neighbours(self, v: int) -> set[int]:
        return {u for t in self.star[v] for u in self._corners(t)} - {v}

    def _surfaces(self, v: int) -> set[int]:
        return {self.patch[t] for t in self.star[v]}

    def _changes(self, t: int) -> Iterator[Change]:
        """Yield the changes of the edges of a triangle that keep the mesh closed."""
        corners = self._corners(t)
        for i in range(3):
            a, b, c = corners[i], corners[(i + 1) % 3], corners[i - 1]
            sides = self.star[a] & self.star[b]
            if len(sides) != 2:
                continue
            (other,) = sides - {t}
            (d,) = set(self._corners(other)) - {a, b}
            smooth = self.patch[t] == self.patch[other]
            if smooth and d != c and d not in self._neighbours(c):
                yield [t, other], [(a, d, c), (d, b, c)], [self.patch[t]] * 2
            # Each end may go where the other is if no crease or corner moves.
            for v, u in ((a, b), (b, a)):
                own = self._surfaces(v)
                if own - self._surfaces(u) or (len(own) > 1 and smooth) or len(own) > 2:
                    continue
                if self._neighbours(v) & self._neighbours(u) != {c, d}:
                    continue
                moved = [i for i in self.star[v] if i not in sides]
                yield [*moved, *sides], self._renamed(moved, v, u), [self.patch[i] for i in moved]
            if not smooth:
                middle = (self.points[a] + self.points[b]) / 2
                m = self._add(middle, [self.patch[t], self.patch[other]])
                new = [(a, m, c), (m, b, c), (b, m, d), (m, a, d)]
                yield [t, other], new, [self.patch[t]] * 2 + [self.patch[other]] * 2
        for v in corners:
            if len(self._surfaces(v)) == 1:
                middle = np.mean([self.points[u] for u in self._neighbours(v)], axis=0)
                m = self._add(middle, [self.patch[t]])
                yield self._moved(v, m)
        for i in range(3):
            a, b, v = (self.points[corners[i - j]] for j in range(3))
            share = float((v - a) @ (b - a)) / max(float((b - a) @ (b - a)), FLAT**2)
            self.points.append(a + min(max(share, 0.0), 1.0) * (b - a))
            self.star.append(set())
            self.loose.add(len(self.points) - 1)
            yield self._moved(corners[i - 2], len(self.points) - 1)

    def _moved(self, old: int, new: int) -> Change:
        """Return the change that puts one point in place of another."""
        around = list(self.star[old])
        return around, self._renamed(around, old, new), [self.patch[i] for i in around]

    def _renamed(self, triangles: list[int], old: int, new: int) -> list[Triangle]:
        """Return triangles with one point in place of another."""
        found = [self._corners(t) for t in triangles]
        return [
            (new if a == old else a, new if b == old else b, new if c == old else c)
            for a, b, c in found
        ]

    def _add(self, place: Array, surfaces: list[int]) -> int:
        """Add a point near a place that is on surfaces, and return its number."""
        on = onto(self.source.surfaces, place[np.newaxis], np.array([surfaces]), 8)
        self.points.append(on[0])
        self.star.append(set())
        return len(self.points) - 1
