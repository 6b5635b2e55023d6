"""Sample points on a combined solid: corners, curves where surfaces meet, and surfaces."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from vizlight import _check
from vizlight.geometry.contours import refinement
from vizlight.geometry.solids.exact_surfaces import Plane, fibonacci

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.solids.exact_surfaces import Surface
    from vizlight.geometry.solids.primitives import Primitive, Solid


#: Distance from a surface at which the inside test is made. Lengths are those of the unit solid.
PROBE = 1e-6
#: Largest distance at which a point counts as on a surface.
ON = 1e-9
#: Growth of the spacing per distance from a surface that needs a finer one.
GROWTH = 0.35
#: Largest number of candidate points of the finest spacing.
SEARCHED = 12_000_000
#: Largest number of points: with more, the tetrahedra fill gigabytes.
MOST = 400_000


class Unit:
    """A solid scaled to a unit ball: its surfaces and its inside test."""

    def __init__(self, solid: Solid, parts: list[Primitive], given: list[Primitive]) -> None:
        self.solid = solid
        moved = iter(parts)
        self.parts = [None if part.empty else next(moved) for part in given]
        self.surfaces: list[Surface] = []
        self.owners: list[Primitive] = []
        for part in parts:
            for surface in part.surfaces():
                # A face of size 0, such as the end at the apex of a cone, has no points.
                if not (isinstance(surface, Plane) and max(surface.extent) == 0):
                    self.surfaces.append(surface)
                    self.owners.append(part)
        #: Pairs of parallel planes, which have no curve in common.
        self.parallel = np.array([[_parallel(a, b) for b in self.surfaces] for a in self.surfaces])

    def inside(self, points: Array) -> Bools:
        """Return which points are inside the solid."""
        none = np.zeros(len(points), np.bool_)
        tests = [none if part is None else part.inside(points) for part in self.parts]
        return np.asarray(self.solid.combine(iter(tests)))

    def combine(self, sides: list[Bools]) -> Bools:
        """Return which points are inside the solid, given the same for each surface."""
        none = np.zeros(len(sides[0]), np.bool_)
        tests = [
            none if part is None
            else np.logical_and.reduce(
                [side for side, own in zip(sides, self.owners, strict=True) if own is part]
            )
            for part in self.parts
        ]  # fmt: skip
        return np.asarray(self.solid.combine(iter(tests)))

    def on(self, points: Array) -> Bools:
        """Return the surfaces that each point is on, as a Boolean array (points, surfaces)."""
        if not len(points):
            return np.zeros((0, len(self.surfaces)), np.bool_)
        return np.stack([np.abs(s.distance(points)) < 1e3 * ON for s in self.surfaces], axis=1)

    def edge(self, points: Array, which: Indices) -> Bools:
        """Return the points, on k surfaces each, at which all k surfaces bound the solid.

        The inside test is made in each of the 2^k sectors between the surfaces of a point: a
        surface bounds the solid where exactly one of its sides is inside.
        """
        k = which.shape[1]
        normal = np.zeros((len(points), k, 3))
        for j in range(k):
            for i in np.unique(which[:, j]):
                on = which[:, j] == i
                normal[on, j] = self.surfaces[i].normal(points[on])
        gram = normal @ normal.transpose(0, 2, 1) + 1e-9 * np.eye(k)
        signs = 2.0 * np.array(list(itertools.product((0, 1), repeat=k))).T - 1
        weight = np.linalg.solve(gram, np.broadcast_to(signs, (len(points), *signs.shape)))
        step = np.einsum("nji,njs->nsi", normal, weight)
        step /= np.sqrt(np.einsum("nsi,nsi->ns", step, step))[:, :, np.newaxis]
        places = (points[:, np.newaxis] + PROBE * step).reshape(-1, 3)
        inside = self.inside(places).reshape(-1, *(2,) * k)
        matter = np.ones(len(points), np.bool_)
        for axis in range(1, k + 1):
            differ = np.diff(inside, axis=axis)
            matter &= differ.any(axis=tuple(range(1, k + 1)))
        return matter


class Size:
    """Spacing of points as a function of position: finer toward surfaces of small radius.

    Parameters
    ----------
    unit : Unit
        Solid.
    coarse : float
        Spacing far from all surfaces that need a finer one.
    own : ndarray, shape (number of surfaces,)
        Spacing that each surface needs.
    """

    def __init__(self, unit: Unit, coarse: float, own: Array) -> None:
        self.coarse = coarse
        self.unit = unit
        small = np.flatnonzero(own < 0.99 * coarse)
        #: Surfaces of each primitive, and the spacing of those that need a finer one.
        self.small: dict[Primitive, tuple[list[int], dict[int, float]]] = {}
        for i in small:
            faces = [j for j, owner in enumerate(unit.owners) if owner is unit.owners[i]]
            _, needs = self.small.setdefault(unit.owners[i], (faces, {}))
            needs[int(i)] = float(own[i])
        finest = min([coarse, *own[small]])
        count = max(int(np.ceil(np.log2(coarse / finest))), 0) + 1
        self.levels = [coarse / 2**k for k in range(count)]

    def of(self, points: Array) -> Array:
        """Return the spacing at points."""
        found = np.full(len(points), self.coarse)
        for faces, needs in self.small.values():
            gaps = {i: self.unit.surfaces[i].distance(points) for i in faces}
            # The bounded piece of a surface is at least as far as its primitive.
            outside = np.max(list(gaps.values()), axis=0)
            for i, need in needs.items():
                far = np.maximum(np.abs(gaps[i]), outside)
                found = np.minimum(found, need + GROWTH * far)
        return found

    def samples(self, surface: Surface, share: float, random: np.random.Generator) -> Array:
        """Return points of a surface whose distance is a given share of their spacing."""
        found = []
        for k, level in enumerate(self.levels):
            # The spacing wanted within a finer level is up to twice that of the level.
            places = surface.samples((max(share, 0.8) if k else share) * level, random)
            if len(self.levels) > 1:
                size = self.of(places)
                own = size >= level if k < len(self.levels) - 1 else np.ones(len(size), np.bool_)
                places = places[own & (size < 2 * level) if k else own]
            found.append(places)
        return np.concatenate(found)


def _parallel(first: Surface, second: Surface) -> bool:
    if not (isinstance(first, Plane) and isinstance(second, Plane)):
        return False
    across = np.cross(first.outward, second.outward)
    return bool(across @ across <= 1e-12)


def estimate(surfaces: list[Surface], spacing: float) -> float:
    """Return the approximate number of points of the uncut surfaces at a spacing."""
    return sum(surface.area for surface in surfaces) / spacing**2


def points(unit: Unit, size: Size, random: np.random.Generator) -> tuple[Array, Bools]:
    """Return points at corners, on edges and on faces, and the surfaces that each is on."""
    finest = size.levels[-1]
    searched = 2 * estimate(unit.surfaces, finest) if len(size.levels) > 1 else 0
    if searched > SEARCHED or estimate(unit.surfaces, size.coarse) > MOST:
        raise ValueError(
            _check.message(
                "tolerance", f"a value that needs at most {MOST} points",
                f"one that needs a spacing of {finest:g} of the solid's size",
                "raise it, or leave out primitives that are tiny compared with the solid",
            )
        )  # fmt: skip
    fine = [size.samples(surface, 0.5, random) for surface in unit.surfaces]
    edges, pairs = _meetings(unit, fine, size)
    corners = _corners(unit, edges, pairs, size)
    lines, ends = _touching(unit, fine, size)
    edges, corners = np.concatenate([edges, lines]), np.concatenate([corners, ends])
    for surface in unit.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is None:
            continue
        # A sharp cone may lie between all directions, so its axis is tested too.
        down = surface.center - apex
        ways = np.concatenate([fibonacci(26), [down / np.sqrt(down @ down)]])
        ring = apex + PROBE * ways
        inside = unit.inside(ring)
        if inside.any() and not inside.all():
            corners = np.concatenate([corners, apex[np.newaxis]])
    # Each corner is found from many starting points: equal ones are merged before pairs are made.
    _, first = np.unique(np.round(corners, 7), axis=0, return_index=True)
    corners = _thin(corners[first], np.full(len(first), 1e-5), None)
    lines = _away(edges, corners, 0.5 * size.of(edges))
    lines = _thin(lines, 0.5 * size.of(lines), unit.on(lines), shared=2)
    faces: list[Array] = []
    for i, surface in enumerate(unit.surfaces):
        found = size.samples(surface, 1.0, random)
        found = found[unit.edge(found, np.full((len(found), 1), i))]
        found = _away(found, edges, 0.7 * size.of(found))
        faces.append(_away(found, corners, 0.7 * size.of(found)))
    # Where faces of two primitives coincide, each samples them.
    known = np.concatenate([corners, lines])
    found = np.concatenate(faces)
    found = _thin(found, 0.6 * size.of(found), unit.on(found))
    made = np.concatenate([known, found, _opposite(unit, found, edges, corners, size)])
    return made, unit.on(made)


def _opposite(unit: Unit, points: Array, edges: Array, corners: Array, size: Size) -> Array:
    """Return points opposite given points, on surfaces closer than the points' spacing.

    With them, tetrahedra span a thin wall or gap from side to side and do not cross it.
    """
    found: list[Array] = [np.empty((0, 3))]
    on, spacing = unit.on(points), size.of(points)
    for i, surface in enumerate(unit.surfaces):
        near = (np.abs(surface.distance(points)) < spacing) & ~on[:, i]
        if np.any(near):
            which = np.full((np.count_nonzero(near), 1), i)
            places = refinement.onto(tuple(unit.surfaces), points[near], which)
            found.append(places[unit.edge(places, which)])
    places = np.concatenate(found)
    for others, share in ((edges, 0.7), (corners, 0.7), (points, 1e-3)):
        places = _away(places, others, share * size.of(places))
    here = np.concatenate([points, places])
    kept = _thin(here, 0.3 * size.of(here), unit.on(here), first=len(points))
    return kept[len(points) :]


def _meetings(unit: Unit, fine: list[Array], size: Size) -> tuple[Array, Indices]:
    """Return dense points of the curves where two surfaces meet, and the two surfaces."""
    found: list[Array] = [np.empty((0, 3))]
    pairs: list[Indices] = [np.empty((0, 2), np.intp)]
    for i, first in enumerate(unit.surfaces):
        spacing = size.of(fine[i])
        for j, second in enumerate(unit.surfaces):
            if i == j or unit.parallel[i, j]:
                continue
            near = np.abs(second.distance(fine[i])) < spacing
            if not np.any(near):
                continue
            start = fine[i][near]
            places = refinement.onto(
                (first, second), start, np.tile([0, 1], (len(start), 1)), rounds=8
            )
            step = places - start
            good = np.abs(first.distance(places)) + np.abs(second.distance(places)) < ON
            good &= np.einsum("ij,ij->i", step, step) < (3 * spacing[near]) ** 2
            # Coincident surfaces do not cross in a curve.
            cross = np.cross(first.normal(places), second.normal(places))
            good &= np.einsum("ij,ij->i", cross, cross) > 1e-12
            places = places[good]
            both = np.tile([i, j], (len(places), 1))
            real = unit.edge(places, both)
            found.append(places[real])
            pairs.append(both[real])
    return np.concatenate(found), np.concatenate(pairs).astype(np.intp)


def _touching(unit: Unit, fine: list[Array], size: Size) -> tuple[Array, Array]:
    """Return points where two surfaces touch, and such points that are on a third surface."""
    lines: list[Array] = [np.empty((0, 3))]
    ends: list[Array] = [np.empty((0, 3))]
    for i, surface in enumerate(unit.surfaces):
        spacing = size.of(fine[i])
        for j, other in enumerate(unit.surfaces):
            if i == j or (isinstance(surface, Plane) and isinstance(other, Plane)):
                continue
            start = fine[i][np.abs(other.distance(fine[i])) < spacing]
            if not len(start):
                continue
            lean = _along(unit, start, (i,), j)
            lean = np.einsum("ij,ij->i", lean, lean)
            # Coincident surfaces do not touch along a line.
            start = start[(lean > 1e-12) & (lean < 0.5)]
            start = start[unit.edge(start, np.full((len(start), 1), i))]
            places = _touch(unit, start, (i,), j, size)
            if not len(places):
                continue
            lines.append(places)
            reach = 1.5 * size.of(places)
            for k, third in enumerate(unit.surfaces):
                if k not in (i, j):
                    near = places[np.abs(third.distance(places)) < reach]
                    ends.append(_touch(unit, near, (i, k), j, size))
    return np.concatenate(lines), np.concatenate(ends)


def _along(unit: Unit, points: Array, fixed: tuple[int, ...], moving: int) -> Array:
    """Return the part of the normals of one surface that is tangential to other surfaces."""
    normal = np.stack([unit.surfaces[i].normal(points) for i in fixed], axis=1)
    toward = unit.surfaces[moving].normal(points)
    gram = normal @ normal.transpose(0, 2, 1) + 1e-14 * np.eye(len(fixed))
    weight = np.linalg.solve(gram, normal @ toward[:, :, np.newaxis])
    return np.asarray(toward - np.einsum("nij,ni->nj", normal, weight[:, :, 0]))


def _touch(unit: Unit, start: Array, fixed: tuple[int, ...], moving: int, size: Size) -> Array:
    """Return the nearby points on fixed surfaces at which another surface touches them.

    The method is Newton's for a double root, whose steps have twice the length. Where the
    surfaces cross it oscillates, and the start is dropped after a few rounds.
    """
    if not len(start):
        return start
    surface, surfaces = unit.surfaces[moving], tuple(unit.surfaces[i] for i in fixed)
    places, far = start, 3 * size.of(start)
    for rounds, missing in ((3, 1e-4), (9, 1e-13)):
        for _ in range(rounds if len(places) else 0):
            along = _along(unit, places, fixed, moving)
            lean = np.maximum(np.einsum("ij,ij->i", along, along), 1e-16)
            along *= (2 * surface.distance(places) / lean)[:, np.newaxis]
            both = np.tile(np.arange(len(fixed)), (len(places), 1))
            places = refinement.onto(surfaces, places - along, both)
        step = places - start
        good = np.abs(surface.distance(places)) < missing
        good &= np.einsum("ij,ij->i", step, step) < far**2
        start, places, far = start[good], places[good], far[good]
    along = _along(unit, places, fixed, moving)
    return np.asarray(places[np.abs(along).max(axis=1, initial=0) < 1e-5])


def _corners(unit: Unit, edges: Array, pairs: Indices, size: Size) -> Array:
    """Return the points where three surfaces meet."""
    found: list[Array] = [np.empty((0, 3))]
    reach = 1.5 * size.of(edges)
    for k, third in enumerate(unit.surfaces):
        near = (np.abs(third.distance(edges)) < reach) & ~np.any(pairs == k, axis=1)
        near &= ~unit.parallel[pairs, k].any(axis=1)
        start = edges[near]
        which = np.column_stack([pairs[near], np.full(len(start), k)])
        if not len(start):
            continue
        places = refinement.onto(tuple(unit.surfaces), start, which, rounds=12)
        step = places - start
        good = np.einsum("ij,ij->i", step, step) < (4 * size.of(start)) ** 2
        missing = np.zeros(len(places))
        normal = np.zeros((len(places), 3, 3))
        for j in range(3):
            for i in np.unique(which[:, j]):
                rows = which[:, j] == i
                missing[rows] += np.abs(unit.surfaces[i].distance(places[rows]))
                normal[rows, j] = unit.surfaces[i].normal(places[rows])
        good &= (missing < ON) & (np.abs(np.linalg.det(normal)) > 1e-3)
        places, which = places[good], which[good]
        found.append(places[unit.edge(places, which)])
    return np.concatenate(found)


def _away(points: Array, others: Array, radius: Array) -> Array:
    """Return the points that are farther than their radius from all of ``others``."""
    if not len(points) or not len(others):
        return points
    gap, _ = cKDTree(others).query(points, distance_upper_bound=radius.max())
    return np.asarray(points[gap >= radius])


def _close(points: Array, radius: Array) -> Indices:
    """Return the pairs of points that are closer than the smaller of their radii."""
    if radius.min() == radius.max():
        return cKDTree(points).query_pairs(radius[0], output_type="ndarray")
    # By octaves of the radius: points of one octave against those of the same and larger ones.
    octave = np.floor(np.log2(radius)).astype(int)
    found = [np.empty((0, 2), np.intp)]
    for k in np.unique(octave):
        some, rest = np.flatnonzero(octave == k), np.flatnonzero(octave >= k)
        near = cKDTree(points[some]).sparse_distance_matrix(
            cKDTree(points[rest]), 2.0 ** (k + 1), output_type="ndarray"
        )
        pairs = np.stack([some[near["i"]], rest[near["j"]]], axis=1)
        kept = near["v"] < np.minimum(*radius[pairs.T])
        kept &= (octave[pairs[:, 1]] > k) | (pairs[:, 0] < pairs[:, 1])
        found.append(pairs[kept])
    return np.concatenate(found)


def _thin(
    points: Array, radius: Array, on: Bools | None, *, shared: int = 1, first: int = 0
) -> Array:
    """Return a maximal subset of points of which no two are close.

    Two points are close if their distance is less than the smaller of their radii and, with
    ``on`` (the surfaces of each point), if they have at least ``shared`` surfaces in common.
    The ``first`` points are always kept.
    """
    if not len(points):
        return points
    pairs = _close(points, radius)
    if on is not None:
        pairs = pairs[np.count_nonzero(on[pairs[:, 0]] & on[pairs[:, 1]], axis=1) >= shared]
    pairs = pairs[~(pairs < first).all(axis=1)]
    rank = np.random.default_rng(1990).permutation(len(points))
    rank[:first] = -1
    state = np.zeros(len(points), np.int8)
    state[:first] = 1
    state[pairs[(pairs[:, 0] < first), 1]] = 2
    state[pairs[(pairs[:, 1] < first), 0]] = 2
    while np.any(state == 0):
        # Of the undecided points, those that rank before all their neighbours are kept.
        live = (state[pairs] == 0).all(axis=1)
        pairs = pairs[live]
        a, b = pairs.T
        beaten = np.zeros(len(points), np.bool_)
        beaten[np.where(rank[a] > rank[b], a, b)] = True
        state[(state == 0) & ~beaten] = 1
        lost = state[pairs] == 1
        state[pairs[lost[:, 0], 1]] = 2
        state[pairs[lost[:, 1], 0]] = 2
    return np.asarray(points[state == 1])
