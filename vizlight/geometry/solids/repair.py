"""Flipped triangles, and needless points of creases, removed by local changes of edges."""

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
#: Distance from the chord between its neighbours below which a point of a crease is needless; it is
#: above the grid of coordinates.
STRAIGHT = 1e-9
#: Distance from the apex of a cone below which a point is at the apex.
APEX = 1e-9


def flipped(mesh: Mesh) -> Bools:
    """Return the triangles whose normal points into the solid."""
    return np.asarray(_upward(mesh, mesh.points[mesh.triangles], mesh.patch) < -FLAT)


def _across(corners: Array) -> Array:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _upward(mesh: Mesh, corners: Array, patch: Indices) -> Array:
    """Return twice the area of triangles, negative where their normal points into the solid."""
    normal = triangle_mesh.normals_of(mesh, corners.mean(axis=1), patch)
    return np.asarray(np.einsum("ij,ij->i", _across(corners), normal))


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
    for _ in range(PASSES):
        bad = np.flatnonzero(flipped(mesh))
        editor = _Editor(mesh)
        if not len(bad) or not editor.mend(bad.tolist()):
            break
        mesh = editor.mesh()
    return mesh


def straighten(mesh: Mesh) -> Mesh:
    """Return a mesh of plane facets without the points in the middle of a straight crease.

    Such a point is where a crease crosses a diagonal of a facet. On the exact surface it would be
    further out than the chord, through the opposite side of a thin wall.
    """
    count = len(mesh.points)
    start, stop = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    order = np.argsort(start * count + stop)
    twin = order[np.searchsorted((start * count + stop)[order], stop * count + start)]
    owner = np.repeat(mesh.patch, 3)
    crease = owner != owner[twin]
    start, stop = start[crease], stop[crease]
    ends = np.flatnonzero(np.bincount(start, minlength=count) == 2)
    order = np.argsort(start, kind="stable")
    first = np.searchsorted(start[order], ends)
    both = np.stack([stop[order[first]], stop[order[first + 1]]], axis=1)
    ways = mesh.points[both] - mesh.points[ends][:, np.newaxis]
    chord = ways[:, 0] - ways[:, 1]
    height = np.linalg.norm(np.cross(ways[:, 0], ways[:, 1]), axis=1)
    between = np.einsum("ij,ij->i", ways[:, 0], ways[:, 1]) < 0
    needless = between & (height < STRAIGHT * np.linalg.norm(chord, axis=1))
    if not needless.any():
        return mesh
    editor = _Editor(mesh)
    for v, pair in zip(ends[needless].tolist(), both[needless].tolist(), strict=True):
        editor.leave_out(v, pair)
    return editor.mesh()


class _Editor:
    """Triangles of a mesh that are changed a few at a time."""

    def __init__(self, mesh: Mesh) -> None:
        self.source = mesh
        self.points = list(mesh.points)
        #: Points that are not on their surfaces.
        self.loose: set[int] = set()
        self.gone: set[int] = set()
        self.new: list[Triangle] = []
        self.patch: list[int] = mesh.patch.tolist()
        self._order = np.argsort(mesh.triangles.ravel(), kind="stable") // 3
        self._start = np.searchsorted(
            mesh.triangles.ravel()[np.argsort(mesh.triangles.ravel(), kind="stable")],
            np.arange(len(mesh.points) + 1),
        )
        self._stars: dict[int, set[int]] = {}
        #: Points at the apexes of cones, which stay.
        self.fixed = {
            int(i)
            for surface in mesh.surfaces
            if (apex := getattr(surface, "apex", None)) is not None
            for i in np.flatnonzero(np.abs(mesh.points - apex).max(axis=1) < APEX)
        }

    def mesh(self) -> Mesh:
        """Return the mesh with all changes."""
        source = self.source
        triangles = np.concatenate([source.triangles, np.array(self.new, np.intp).reshape(-1, 3)])
        kept = np.ones(len(triangles), np.bool_)
        kept[list(self.gone)] = False
        used, place = np.unique(triangles[kept], return_inverse=True)
        return source.replace(
            np.array(self.points)[used],
            place.reshape(-1, 3).astype(np.intp),
            np.array(self.patch, np.intp)[kept],
        )

    def mend(self, bad: list[int]) -> bool:
        """Apply to each flipped triangle the change that leaves the fewest, if any does."""
        changed = False
        for t in bad:
            if t in self.gone or not self._flips([self._corners(t)], [self.patch[t]]):
                continue
            best: tuple[float, ...] | None = None
            chosen: Change | None = None
            for change in self._changes(t):
                gone, new, patch = change
                before = self._flips(
                    [self._corners(i) for i in gone], [self.patch[i] for i in gone]
                )
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

    def leave_out(self, v: int, ends: list[int]) -> None:
        """Merge a point with one of two neighbours if no plane facet is flipped by that."""
        for u in ends:
            change = self._merged(v, u)
            if change is None:
                continue
            gone, new, _ = change
            old = [self._corners(t) for t in gone if u not in self._corners(t)]
            was, now = (_across(self._places(t)) for t in (old, new)) if new else (0, 0)
            if not new or np.all(np.einsum("ij,ij->i", was, now) >= 0):
                self._apply(change)
                return

    def _corners(self, t: int) -> Triangle:
        count = len(self.source.triangles)
        if t >= count:
            return self.new[t - count]
        a, b, c = self.source.triangles[t].tolist()
        return a, b, c

    def _star(self, v: int) -> set[int]:
        """Return the triangles around a point."""
        if v not in self._stars:
            known = v + 1 < len(self._start)
            around = self._order[self._start[v] : self._start[v + 1]] if known else self._order[:0]
            self._stars[v] = set(around.tolist())
        return self._stars[v]

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
                self._star(v).discard(t)
        for corners in new:
            for v in corners:
                self._star(v).add(len(self.source.triangles) + len(self.new))
            self.new.append(corners)
        self.gone.update(gone)
        self.patch.extend(patch)

    def _neighbours(self, v: int) -> set[int]:
        return {u for t in self._star(v) for u in self._corners(t)} - {v}

    def _surfaces(self, v: int) -> set[int]:
        return {self.patch[t] for t in self._star(v)}

    def _changes(self, t: int) -> Iterator[Change]:
        """Yield the changes of the edges of a triangle that keep the mesh closed."""
        corners, patch = self._corners(t), self.patch[t]
        for i in range(3):
            a, b, c = corners[i], corners[(i + 1) % 3], corners[i - 1]
            sides = self._star(a) & self._star(b)
            if len(sides) != 2:
                continue
            (other,) = sides - {t}
            (d,) = set(self._corners(other)) - {a, b}
            if patch != self.patch[other]:
                m = self._add((self.points[a] + self.points[b]) / 2, [patch, self.patch[other]])
                new = [(a, m, c), (m, b, c), (b, m, d), (m, a, d)]
                yield [t, other], new, [patch] * 2 + [self.patch[other]] * 2
            elif d != c and d not in self._neighbours(c):
                yield [t, other], [(a, d, c), (d, b, c)], [patch] * 2
            for change in (self._merged(a, b), self._merged(b, a)):
                if change is not None:
                    yield change
            if len(self._surfaces(c)) == 1 and c not in self.fixed:
                middle = np.mean([self.points[u] for u in self._neighbours(c)], axis=0)
                yield self._moved(c, self._add(middle, [patch]))
            first, along = self.points[a], self.points[b] - self.points[a]
            share = float((self.points[c] - first) @ along) / max(float(along @ along), FLAT**2)
            if 0 < share < 1 and c not in self.fixed:
                m = self._add(first + share * along, [])
                self.loose.add(m)
                yield self._moved(c, m)

    def _merged(self, v: int, u: int) -> Change | None:
        """Return the change that merges a point with a neighbour on all of its surfaces.

        No crease or corner is moved: a point of a crease stays on it.
        """
        if v in self.fixed:
            return None
        own, sides = self._surfaces(v), self._star(v) & self._star(u)
        across = {self.patch[t] for t in sides}
        if own - self._surfaces(u) or len(own) > 2 or (own != across and len(own) > 1):
            return None
        opposite = {w for t in sides for w in self._corners(t)} - {u, v}
        if len(sides) != 2 or self._neighbours(v) & self._neighbours(u) != opposite:
            return None
        moved = [t for t in self._star(v) if t not in sides]
        return [*moved, *sides], self._renamed(moved, v, u), [self.patch[t] for t in moved]

    def _moved(self, old: int, new: int) -> Change:
        """Return the change that puts one point in place of another."""
        around = list(self._star(old))
        return around, self._renamed(around, old, new), [self.patch[t] for t in around]

    def _renamed(self, triangles: list[int], old: int, new: int) -> list[Triangle]:
        """Return triangles with one point in place of another."""
        found = [self._corners(t) for t in triangles]
        return [
            (new if a == old else a, new if b == old else b, new if c == old else c)
            for a, b, c in found
        ]

    def _add(self, place: Array, surfaces: list[int]) -> int:
        """Add a point near a place that is on surfaces, if any, and return its number."""
        if surfaces:
            place = onto(self.source.surfaces, place[np.newaxis], np.array([surfaces]), 8)[0]
        self.points.append(place)
        return len(self.points) - 1
