"""Evenly spaced curves: samples of those that grow, found by distance, and how even they are."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
import scipy

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.lines.simplices import CellPlaces, Columns
from vizlight.geometry.lines.tracing import Curves, Flow, Tracing, Walkers, passed

#: Samples of curves per spacing.
SAMPLES = 4
#: Cosine above which lines of a cross field are of one family.
PARALLEL = 0.7
#: Number of samples that are looked at in addition in a cross field, for curves that cross.
CROSSING = 24
#: Number of samples in the small tree, which is made again at every step.
RECENT = 1500


def parallel(a: Array, b: Array) -> Bools:
    """Return whether unit directions, shape (..., 3), are of one family of a cross field."""
    return np.asarray(np.abs(np.einsum("...i,...i->...", a, b)) > PARALLEL)


class CurveSamples:
    """Samples of the curves, found by distance."""

    def __init__(self) -> None:
        self.along = self.weights = self.embedded = np.empty((0, 3))
        self.sign = self.length = np.empty(0)
        self.curve = self.number = self.cell = np.empty(0, dtype=np.intp)
        self.used = np.empty(0, dtype=np.bool_)
        self._size = 0
        # Most samples are in a tree that is seldom made again, the rest in one that often is.
        self._old: scipy.spatial.cKDTree | None = None
        self._new: scipy.spatial.cKDTree | None = None
        self._rows: Indices = np.empty(0, dtype=np.intp)
        self._recent = self._rows
        self._whole, self._seen, self._stale = 0, 0, 0

    def add(self, walkers: Walkers, embedded: Array) -> None:
        """Add the present places of ends."""
        size, total = self._size, self._size + len(embedded)
        # Each field is a column of its own, the cell and the weights of a place among them.
        new = vars(walkers) | vars(walkers.places)
        new |= {"embedded": embedded, "used": np.ones(len(embedded), np.bool_)}
        del new["places"]
        for name, rows in new.items():
            column = getattr(self, name)
            if not size or total > len(column):
                # Capacity doubles, so that adding is cheap on the whole.
                column = np.zeros((max(4096, 2 * total), *rows.shape[1:]), rows.dtype)
                if size:
                    column[:size] = getattr(self, name)[:size]
                setattr(self, name, column)
            column[size:total] = rows
        self._size = total

    def drop(self, curve: int) -> None:
        """Forget the samples of a curve."""
        rows = np.flatnonzero(self.curve[: self._size] == curve)
        self.used[rows] = False
        # The small tree is made again; in the large one the rows are masked until too many are
        # stale.
        self._seen = -1
        self._stale += int(np.count_nonzero(rows < self._whole))

    def along_curves(self, curves: list[int]) -> tuple[CellPlaces, Array]:
        """Return the places of the samples of curves, and the directions at them."""
        rows = np.flatnonzero(np.isin(self.curve[: self._size], curves))
        # Two samples per spacing are enough to look beside a curve.
        rows = rows[np.argsort(self.curve[rows], kind="stable")][:: SAMPLES // 2]
        return CellPlaces(self.cell[rows], self.weights[rows]), self.along[rows]

    def near(
        self, embedded: Array, radius: float, count: int, along: Array | None = None
    ) -> tuple[Array, Indices]:
        """Return distances and rows of samples within a radius, shape (N, K); infinity for none.

        With directions ``along`` samples of curves that cross them do not count.
        """
        if along is not None:
            # Curves of the other family, which are not counted, can be nearer.
            count += CROSSING
        if self._size - self._whole > RECENT or self._stale > RECENT:
            self._rows = np.flatnonzero(self.used[: self._size])
            # A balanced tree would cost more to make than its queries save.
            self._old = scipy.spatial.cKDTree(self.embedded[self._rows], balanced_tree=False)
            self._whole, self._seen, self._stale = self._size, -1, 0
            self._recent, self._new = self._rows[:0], None
        if self._seen != self._size:
            self._recent = self._whole + np.flatnonzero(self.used[self._whole : self._size])
            self._new = scipy.spatial.cKDTree(self.embedded[self._recent], balanced_tree=False)
            self._seen = self._size
        distances: list[Array] = []
        numbers: list[Indices] = []
        for tree, rows in ((self._old, self._rows), (self._new, self._recent)):
            if tree is None or not len(rows):
                continue
            nearest = tree.query(embedded, k=count, distance_upper_bound=radius)
            distance = np.asarray(nearest[0]).reshape(-1, count)
            # For a missing neighbour the tree gives its number of points as row, and infinity as
            # distance.
            row = rows[np.minimum(np.asarray(nearest[1]).reshape(-1, count), len(rows) - 1)]
            counted = self.used[row]
            if along is not None:
                counted &= parallel(self.along[row], along[:, np.newaxis])
            distances.append(np.where(counted, distance, np.inf))
            numbers.append(row)
        if not distances:
            empty = np.zeros((len(embedded), 1))
            return empty + np.inf, empty.astype(np.intp)
        # Not merged in order: callers take the least distance, or any, of both trees.
        return np.concatenate(distances, axis=1), np.concatenate(numbers, axis=1)


#: Largest number of curves that grow at the same time.
CROWD = 128
#: Distances between seeds of the same moment, in spacings: at first, and at least.
APART, NEAR = 8.0, 1.0
#: Weight of the difference of normals in the distance of places on a surface, in spacings: two
#: sides of a thin sheet are a spacing apart.
NORMALS = 0.5
#: Distance to the side, in spacings, within which a curve that comes back to itself is closed.
CLOSED = 0.05
#: Number of places that are looked at as seeds at once.
QUEUE = 512
#: Number of random places per square or cube of the spacing that are looked at for gaps.
DENSE, MOST_PLACES = 8, 200_000
#: Share of the spacing at which a curve stops before another.
SEPARATION = 0.5
#: Length, in spacings, of the shortest curve that is kept where others cut it short.
SHORTEST = 2.0
#: Number of places per spacing along each axis that are looked at for the last gaps, which are
#: filled if they are wider than so many spacings, by curves of a share of the shortest length, or
#: half of that from a boundary.
DENSER, WIDE, SHARE = 4, 1.15, 0.7


def embedded(flow: Flow, spacing: float, places: CellPlaces | None = None) -> Array:
    """Return positions and, on a surface, scaled normals, in which distances are measured.

    Their shape is (M, 3) or (M, 6); places are by default the vertices.
    """
    rows = [flow.mesh.points] if flow.normals is None else [flow.mesh.points, flow.normals]
    if places is not None:
        rows = [flow.mesh.interpolated(values, places) for values in rows]
    if flow.normals is None:
        return rows[0]
    points, normals = rows
    # Opposite normals at the vertices of a cell may cancel between these.
    size = np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    return np.hstack([points, NORMALS * spacing / size * normals])


class Growth:
    """Curves while they grow; see :func:`evenly_spaced`."""

    def __init__(
        self, flow: Flow, spacing: float, how: Tracing, random: np.random.Generator
    ) -> None:
        self.flow, self.spacing, self.how, self.random = flow, spacing, how, random
        self.samples = CurveSamples()
        self.trail: list[Walkers] = []
        #: Whether there are two families of curves that do not stop each other.
        self.crossing = flow.mesh.sheets is not None
        #: Number of the last step that is kept, by curve and sign, where some are not.
        self.last: dict[tuple[int, int], int] = {}
        self.closed: set[int] = set()
        self.dropped: set[int] = set()
        #: Number of ends that were stopped by another curve or by their own, by curve.
        self.cut: Counter[int] = Counter()
        #: Number of ends that grow, and length of those that have stopped, by curve.
        self.growing: Counter[int] = Counter()
        self.lengths: defaultdict[int, float] = defaultdict(float)
        self.count, self.apart = 0, APART
        #: Whether only wide gaps are still filled.
        self.last_gaps = False
        nowhere = CellPlaces(np.empty(0, dtype=np.intp), np.empty((0, flow.mesh.k + 1)))
        # Every curve has two ends that grow, one along the field and one against it.
        self.walkers = Walkers.from_seeds(flow, nowhere, nowhere.cell)
        #: Of each end: step at which it came back beside its own curve, or -1; length at its last
        #: sample.
        self.returning, self.sampled = nowhere.cell, np.empty(0)
        #: Curves that are kept and were not looked beside yet.
        self.fresh: list[int] = []
        #: Places a spacing beside curves, from which others may start.
        self.beside = nowhere

    def distances(self, places: CellPlaces, radius: float) -> Array:
        """Return the distance of places from the nearest sample; infinite beyond a radius."""
        at = embedded(self.flow, self.spacing, places)
        along = self.flow.directions(places)[0] if self.crossing else None
        return np.asarray(self.samples.near(at, radius, 4, along)[0].min(axis=1))

    def start(self, seeds: CellPlaces) -> Bools:
        """Let curves grow from seeds that are apart from each other; return a mask of those taken.

        Seeds without a direction are taken too, and no curve grows from them.
        """
        at = embedded(self.flow, self.spacing, seeds)
        # Too many at once would grow into each other; too few waste the vectorised step.
        room = CROWD - len(self.growing)
        taken: Bools = ~self.flow.directions(seeds)[1]
        moving = np.flatnonzero(~taken)
        chosen = moving[_apart(at[moving], self.apart * self.spacing, room)]
        # Seeds start farther apart at first; where few of them fit, nearer.
        wide = len(chosen) >= room // 4
        self.apart = min(APART, 1.5 * self.apart) if wide else max(NEAR, self.apart / 1.5)
        taken[chosen] = True
        numbers = self.count + np.arange(len(chosen))
        self.count += len(chosen)
        walkers = Walkers.from_seeds(self.flow, seeds[chosen], numbers)
        # Each curve is there twice, by its two ends, and so it is counted.
        self.growing.update(walkers.curve.tolist())
        self.trail.append(walkers)
        self.samples.add(walkers, embedded(self.flow, self.spacing, walkers.places))
        self.walkers = self.walkers.joined(walkers)
        self.returning = np.append(self.returning, np.full(len(walkers.curve), -1))
        self.sampled = np.append(self.sampled, np.zeros(len(walkers.curve)))
        return taken

    def grow(self) -> None:
        """Let all ends make one step."""
        walkers, sample = self.walkers, self.spacing / SAMPLES
        # A step is at most the distance of samples, by which curves keep apart.
        size = np.minimum(self.how.step * self.flow.mesh.sizes(walkers.places), sample)
        ahead, stepped, inside = walkers.advanced(self.flow, size)
        at = embedded(self.flow, self.spacing, ahead.places)
        blocked, back, reached, losers = self._met(ahead, at)
        for curve in losers.tolist():
            self.samples.drop(curve)
            self.growing.pop(curve, None)
        self.dropped.update(losers.tolist())
        lost = np.isin(ahead.curve, losers)
        stepped &= ~blocked & ~lost
        self.trail.append(ahead[stepped])
        # Samples are set at even lengths; 0.999 absorbs the rounding of summed steps.
        due = stepped & ~back & (ahead.length - self.sampled >= 0.999 * sample)
        self.samples.add(ahead[due], at[due])
        self.sampled = np.where(due, ahead.length, self.sampled)
        for row in np.flatnonzero(stepped & (reached >= 0)).tolist():
            self._close(ahead, row, int(reached[row]))
        # An end stops at a boundary, at its longest, after its last step, or where its curve is
        # closed.
        going = stepped & inside & (ahead.length < self.how.max_length)
        going &= (ahead.number < self.how.max_steps) & ~np.isin(ahead.curve, [*self.closed])
        # Of an end that has come back beside its own curve: the last step before, up to which it is
        # kept.
        began = np.where(self.returning < 0, walkers.number, self.returning)
        for row in np.flatnonzero(~going & ~lost).tolist():
            # What runs beside the curve itself is taken back, unless that closes it.
            if blocked[row]:
                self.cut[int(ahead.curve[row])] += 1
            if self.returning[row] >= 0:
                key = int(ahead.curve[row]), int(ahead.sign[row])
                self.last.setdefault(key, int(self.returning[row]))
            self._stop(int(ahead.curve[row]), float(walkers.length[row]))
        self.returning = np.where(back, began, -1)[going]
        self.walkers, self.sampled = ahead[going], self.sampled[going]

    def _met(self, ahead: Walkers, at: Array) -> tuple[Bools, Bools, Indices, Indices]:
        """Return masks of blocked ends and of those that return to their curve, and two arrays.

        The third is the row of the sample at which the curve is closed, or -1; the fourth are the
        curves that give way.
        """
        samples, spacing = self.samples, self.spacing
        d = SEPARATION * spacing
        distance, row = samples.near(at, d, 16, ahead.along if self.crossing else None)
        sign = ahead.sign[:, np.newaxis]
        same_curve = samples.curve[row] == ahead.curve[:, np.newaxis]
        # The way along the curve between an end and a sample of its own: near ones are no
        # obstacle.
        between = np.abs(
            samples.sign[row] * samples.length[row] - sign * ahead.length[:, np.newaxis]
        )
        hit = np.isfinite(distance) & (~same_curve | (between > 3 * d))
        # A curve that started earlier goes on and a later one gives way, as if it had come first.
        later = samples.curve[row] > ahead.curve[:, np.newaxis]
        losers = np.unique(samples.curve[row[hit & later]])
        hit &= ~later
        # Split along and across the end's direction: what lies abreast is beside, not ahead.
        toward = samples.embedded[row][..., :3] - at[:, np.newaxis, :3]
        along = np.einsum("nkj,nj->nk", toward, ahead.along)
        lateral = np.linalg.norm(
            toward - along[..., np.newaxis] * ahead.along[:, np.newaxis], axis=2
        )
        seed = samples.number[row] == 0
        facing = np.einsum("nkj,nj->nk", samples.along[row], ahead.along)
        # Along an orbit the other end of the curve comes the opposite way.
        opposite = np.where(seed, np.abs(facing), -facing) > 0.8
        orbit = same_curve & (seed | (samples.sign[row] != sign)) & np.isfinite(distance)
        # Also a small circle, which is near all around, as soon as the other end is ahead.
        orbit &= opposite & (lateral < 0.3 * spacing) & (hit | (along > 0))
        # Of the samples of the other end the outermost is reached first.
        place = np.where(orbit, -samples.length[row], np.inf).argmin(axis=1)
        each = np.arange(len(place))
        back = orbit.any(axis=1)
        abreast = back & (along[each, place] <= spacing / SAMPLES)
        close = abreast & (lateral[each, place] <= CLOSED * spacing)
        blocked = (hit & ~orbit).any(axis=1) | (abreast & ~close)
        return blocked, back, np.where(close & ~blocked, row[each, place], -1), losers

    def _close(self, ahead: Walkers, row: int, sample: int) -> None:
        """Close the curve of an end that has reached a sample of the other end."""
        curve, sign = int(ahead.curve[row]), int(ahead.sign[row])
        if curve not in self.closed:
            self.closed.add(curve)
            # Both ends are cut where they meet; if each reaches the other in one step the first
            # closes.
            self.last[curve, -sign] = int(self.samples.number[sample])
            self.last[curve, sign] = int(ahead.number[row])

    def _stop(self, curve: int, length: float) -> None:
        """Note that an end has stopped; after the second keep the curve or drop it."""
        self.growing[curve] -= 1
        self.lengths[curve] += length
        if self.growing[curve]:
            return
        del self.growing[curve]
        # A curve that two others have cut short is dropped if it is too short to be read.
        cut = self.cut[curve]
        # In a gap there is room for half the length on either side of the seed.
        share = SHARE * cut / 2 if self.last_gaps else min(cut, 1)
        if self.lengths[curve] < share * SHORTEST * self.spacing:
            self.dropped.add(curve)
            self.samples.drop(curve)
        elif not self.last_gaps:
            self.fresh.append(curve)

    def _look_beside(self) -> None:
        """Queue places a spacing beside the curves that were kept since the last time."""
        places, along = self.samples.along_curves(self.fresh)
        self.fresh = []
        if self.flow.normals is not None:
            # On a surface the places beside a curve are to its left and right, across the normal.
            u: Array = np.cross(self.flow.mesh.interpolated(self.flow.normals, places), along)
            sides = np.concatenate([u, -u])
        else:
            # In a volume: four directions around it, turned at random.
            u = np.cross(along, self.random.normal(size=along.shape))
            v: Array = np.cross(along, u)
            sides = np.concatenate([u, -u, v, -v])
        size = np.linalg.norm(sides, axis=1, keepdims=True)
        step = self.spacing * sides / np.where(size > 0, size, 1)
        starts = places[np.arange(len(sides)) % len(along)]
        ends, inside = self.flow.mesh.walk(starts, step)
        # A step that ended at a boundary has not gone a whole spacing.
        self.beside = self.beside.joined(ends[inside])

    def refill(self, pool: CellPlaces) -> CellPlaces:
        """Start new curves in free space; return the places of the pool still to be tried."""
        spacing = self.spacing
        if not len(self.beside.cell) and self.fresh:
            self._look_beside()
        while len(self.growing) <= CROWD // 2 and len(self.beside.cell):
            first, rest = self.beside[:QUEUE], self.beside[QUEUE:]
            # 0.95: rounding on the way beside a curve must not count as crowded.
            first = first[self.distances(first, 0.95 * spacing) >= 0.95 * spacing]
            if len(first.cell):
                # Those for which there was no room stay first in the queue.
                self.beside = first[~self.start(first)].joined(rest)
                return pool
            self.beside = rest
        # Random places last: one that is free now may soon be beside a curve that still grows.
        if not self.growing:
            least = WIDE * spacing if self.last_gaps else spacing
            free = pool[:0]
            while len(free.cell) < QUEUE and len(pool.cell):
                first, pool = pool[:QUEUE], pool[QUEUE:]
                free = free.joined(first[self.distances(first, least) >= least])
            if len(free.cell):
                pool = free[~self.start(free)].joined(pool)
        return pool

    def widest(self, places: CellPlaces) -> CellPlaces:
        """Return the places in wide gaps, those farthest from all curves first."""
        least = WIDE * self.spacing
        wide = places[self.distances(places, least) >= least]
        # Those farther than the radius have an infinite distance and so come first.
        return wide[np.argsort(-self.distances(wide, 4 * least), kind="stable")]


def evenly_spaced(
    flow: Flow,
    spacing: float,
    how: Tracing,
    /,
    *,
    seeds: CellPlaces | None,
    report: Callable[[int], None] = lambda _: None,
) -> tuple[Curves, int]:
    """Return integral curves that are evenly spaced, on a whole surface or in a whole volume.

    The second result is the number of closed curves. ``spacing`` is the distance at which a curve
    starts beside another; the first curves start at the seeds, or at random places. ``report``
    takes the number of places of :func:`places_of` that are covered.

    Curves start a spacing beside others and stop where they come nearer than half a spacing to
    another or to themselves. Where no place beside a curve is free, random places that are a
    spacing from all curves are tried until none is left: so every part is reached. On the double
    cover of a cross field only curves that are nearly parallel count. Source: Jobard
    and Lefer, Creating evenly-spaced streamlines of arbitrary density (1997), with all curves
    growing at the same time.
    """
    random = np.random.default_rng(how.seed)
    # Random places all over find what is a spacing from all curves wherever no neighbour does.
    pool = places_of(flow, spacing, random)
    # Parts that are too small for a random place have one of their own.
    pool = pool[random.permutation(len(pool.cell))].joined(flow.mesh.one_each())
    growth = Growth(flow, spacing, how, random)
    total, covered, before = len(pool.cell), 0, -1
    if seeds is not None:
        # Tried like places beside a curve, and so before every random place.
        growth.beside = seeds
    while True:
        if len(growth.growing) <= CROWD // 2:
            pool = growth.refill(pool)
            covered = max(covered, total - len(pool.cell))
            report(covered)
        if len(growth.walkers.curve):
            growth.grow()
        elif not growth.growing and not len(growth.beside.cell) and not len(pool.cell):
            kept = growth.count - len(growth.dropped)
            # The search for gaps is repeated as long as a round has added a curve.
            if kept == before:
                break
            # Last, with denser places, the gaps that are wide but too small for a whole spacing.
            before, growth.last_gaps = kept, True
            pool = growth.widest(places_of(flow, spacing, random, DENSER**flow.mesh.k))
    report(total)
    curves = passed(growth.trail, growth.last, closed=growth.closed, dropped=growth.dropped)
    return curves, len(growth.closed - growth.dropped)


def places_of(
    flow: Flow, spacing: float, random: np.random.Generator, dense: int = DENSE
) -> CellPlaces:
    """Return random places all over a surface or a volume, some in each square of the spacing."""
    return flow.mesh.random(place_count(flow, spacing, dense), random)


def place_count(flow: Flow, spacing: float, dense: int = DENSE) -> int:
    """Return the number of places of :func:`places_of`."""
    count = dense * flow.mesh.extent / spacing**flow.mesh.k
    return int(np.clip(count, 1000, MOST_PLACES * dense // DENSE))


def _apart(embedded: Array, distance: float, most: int) -> Indices:
    """Return at most so many rows, the first ones first, at least a distance apart."""
    chosen: list[int] = []
    left = np.arange(len(embedded))
    while len(left) and len(chosen) < most:
        chosen.append(int(left[0]))
        # Greedy, in order: each row that is kept removes those near to it.
        gap = embedded[left] - embedded[left[0]]
        left = left[np.einsum("ij,ij->i", gap, gap) >= distance**2]
        # Where the square of the distance is 0 a row does not remove itself.
        if left.size and left[0] == chosen[-1]:
            left = left[1:]
    return np.array(chosen, dtype=np.intp)


#: Tolerance of a gap, in spacings.
TOLERANCE = 0.005
#: Side of the boxes, in spacings, in which one cell's distance bounds the distances of all.
BOX = 0.25
#: Number of parts of cells that are halved at once: at least so many, and one of so many, since the
#: others are copied each time.
BATCH, PART = 256, 4
#: Most halves that are smaller than boxes: along each axis per spacing, but at least so many.
MOST_PARTS, LEAST_PARTS = 4, 4000
#: Number of places from which the first distances are measured exactly.
FIRST = 64
#: Points of curves by whose segments a distance is measured, and most that are looked at for it.
NEIGHBOURS, MOST_NEIGHBOURS = 8, 4096
#: Number of places on curves at which the distance to others is measured.
ON_CURVES = 1000


class Distances:
    """Distances from curves, as :func:`~vizlight.geometry.lines.even.embedded`."""

    def __init__(self, flow: Flow, spacing: float, curves: Curves) -> None:
        self.flow, self.spacing = flow, spacing
        self.there, self.along = embedded(flow, spacing, curves.places), curves.along
        self.curve = np.repeat(np.arange(len(curves.offsets) - 1), np.diff(curves.offsets))
        self._tree = scipy.spatial.cKDTree(self.there)
        #: Whether there are two families of curves, each with gaps of its own.
        self.crossing = flow.mesh.sheets is not None

    def of_points(
        self, at: Array, along: Array, curve: Indices | None, count: int
    ) -> tuple[Array, Indices]:
        """Return distances from points of other curves of the same family, and these points.

        ``at`` and ``along`` are embedded places and their directions, ``curve`` the curve of each,
        which does not count itself, and ``count`` the number of points that are looked at first.
        Distances (N, K) are infinite for points that do not count.
        """
        count = min(count, len(self.there))
        distance = np.full((len(at), count), np.inf)
        row = np.zeros((len(at), count), dtype=np.intp)
        left, looked = np.arange(len(at)), count
        # Neighbours are looked for in larger and larger sets until one is of such a curve.
        while len(left) and looked:
            # A list of ranks, since for a single neighbour by number the tree drops an axis.
            neighbours = self._tree.query(at[left], k=np.arange(1, looked + 1))
            far, near = np.asarray(neighbours[0]), np.asarray(neighbours[1])
            if curve is not None:
                far[self.curve[near] == curve[left][:, np.newaxis]] = np.inf
            if self.crossing:
                far[~parallel(self.along[near], along[left][:, np.newaxis])] = np.inf
            # Of a larger set only the nearest are kept, so that all rows have one width.
            if looked > count:
                order = np.argsort(far, axis=1)[:, :count]
                far = np.take_along_axis(far, order, axis=1)
                near = np.take_along_axis(near, order, axis=1)
            distance[left], row[left] = far, near
            left = left[~np.isfinite(far.min(axis=1))]
            more = looked < min(len(self.there), MOST_NEIGHBOURS)
            looked = min(4 * looked, len(self.there), MOST_NEIGHBOURS) if more else 0
        return distance, row

    def of_lines(self, at: Array, along: Array) -> Array:
        """Return distances from the lines, segments between points; infinite if none is found."""
        count = NEIGHBOURS + (CROSSING if self.crossing else 0)
        distance, row = self.of_points(at, along, None, count)
        nearest = distance.min(axis=1)
        a = self.there[row]
        away = at[:, np.newaxis] - a
        for step in (-1, 1):
            # The segments on both sides of a point; at an end of the array it is its own neighbour.
            other = np.clip(row + step, 0, len(self.there) - 1)
            u = self.there[other] - a
            size = np.einsum("nki,nki->nk", u, u)
            share = np.einsum("nki,nki->nk", away, u) / np.where(size > 0, size, 1)
            # From the foot of the perpendicular, which is kept on the segment.
            rest = away - np.clip(share, 0, 1)[..., np.newaxis] * u
            # The next point in the array may begin another curve: no line runs there.
            counted = np.isfinite(distance) & (self.curve[other] == self.curve[row])
            far = np.where(counted, np.einsum("nki,nki->nk", rest, rest), np.inf)
            nearest = np.minimum(nearest, np.sqrt(far.min(axis=1)))
        return np.asarray(nearest)


@dataclass
class Parts(Columns):
    """Parts of cells: simplices in them, which are halved.

    ``weights`` (N, k + 1, k + 1) are barycentric coordinates of the corners, ``corners`` the
    embedded ones; ``far`` and ``radius`` are the distance of its middle from the curves, and the
    largest distance of its places from its middle.
    """

    cell: Indices
    weights: Array
    corners: Array
    far: Array
    radius: Array

    def halved(self, distances: Distances) -> tuple[Parts, Bools]:
        """Return both halves of each part, cut across its longest side, and which have curves.

        The field has no curve where it has no direction.
        """
        first, second = np.triu_indices(self.weights.shape[1], 1)
        side = self.corners[:, first] - self.corners[:, second]
        longest = np.einsum("nei,nei->ne", side, side).argmax(axis=1)
        count = len(self.cell)
        # Each part twice; in one copy one end of its longest side moves, in the other the other.
        both = self.joined(self)
        cell, weights, corners = both.cell, both.weights, both.corners
        rows, ends = np.arange(2 * count), np.concatenate([first[longest], second[longest]])
        # The two ends of a side are so many rows apart.
        opposite = np.roll(ends, count)
        weights[rows, ends] = (weights[rows, ends] + weights[rows, opposite]) / 2
        flow, spacing = distances.flow, distances.spacing
        # Embedded anew, since normals of length 1 are not linear along a side.
        corners[rows, ends] = embedded(flow, spacing, CellPlaces(cell, weights[rows, ends]))
        middles = CellPlaces(cell, weights.mean(axis=1))
        at = embedded(flow, spacing, middles)
        along, moving = flow.directions(middles)
        far = distances.of_lines(at, along)
        return Parts(cell, weights, corners, far, radii(np.swapaxes(corners, 0, 1), at)), moving


def radii(corners: Iterable[Array], middles: Array) -> Array:
    """Return the largest distance of corners, each of shape (N, m), from middles, shape (N, m)."""
    position, normal = np.zeros((2, len(middles)))
    for corner in corners:
        away = corner - middles
        # Farthest by position and by normal can be two different corners.
        np.maximum(position, np.einsum("ni,ni->n", away[:, :3], away[:, :3]), out=position)
        np.maximum(normal, np.einsum("ni,ni->n", away[:, 3:], away[:, 3:]), out=normal)
    return np.sqrt(position + normal)


def largest_gap(distances: Distances) -> float:
    """Return the largest distance of a place from the nearest curve.

    Branch and bound: no place of a part of a cell is farther than its middle is, and its radius.
    Parts that can hold a place farther by :data:`TOLERANCE` than the farthest one found so far are
    halved, the farthest first. The search ends after :data:`MOST_PARTS`, between very many parallel
    lines of one distance, with the gap found so far. In a cross field, where the lines that count
    change with the direction, the bound is not strict.
    """
    if not len(distances.there):
        return np.inf
    spacing, mesh = distances.spacing, distances.flow.mesh
    tolerance = TOLERANCE * spacing
    parts, gap = _first_parts(distances)
    # In squares of the spacing, or cubes.
    room = max(LEAST_PARTS, int(MOST_PARTS**mesh.k * (mesh.extent / spacing**mesh.k)))
    while len(parts.cell) and room > 0:
        # Large parts come first and are not counted: their contents are not measured yet.
        large = parts.radius > BOX * spacing
        first = np.where(large, np.inf, parts.far)
        batch = min(max(BATCH, len(first) // PART), len(first))
        order = np.argpartition(-first, batch - 1)
        halves, moving = parts[order[:batch]].halved(distances)
        room -= 0 if large.any() else len(halves.cell)
        # No curve passes where the field has no direction, and such a middle is no gap.
        gap = max(gap, float(halves.far[moving].max(initial=0)))
        # All places of a smaller part are as far as its middle, within the tolerance of the gap.
        parts = parts[order[batch:]].joined(halves[halves.radius > tolerance])
        parts = parts[parts.far + parts.radius > gap + tolerance]
    return gap


def _first_parts(distances: Distances) -> tuple[Parts, float]:
    """Return the cells that can hold the largest gap, and a lower bound of the gap."""
    flow, mesh, spacing = distances.flow, distances.flow.mesh, distances.spacing
    vertices, used = embedded(flow, spacing), mesh.measures > 0
    resting = ~np.any(flow.vectors, axis=1)
    if resting.any():
        # A cell at whose vertices nothing moves has no curves to be filled with.
        used &= ~resting[mesh.cells].all(axis=1)
    cell = np.flatnonzero(used)
    corners = [vertices[corner] for corner in mesh.cells[cell].T]
    middle = np.add(corners[0], corners[1])
    for corner in corners[2:]:
        middle += corner
    middle /= len(corners)
    radius = radii(corners, middle)
    # One cell of each box bounds the distances of the others.
    number = np.zeros(len(middle))
    for axis in middle[:, :3].T:
        # One number for each box, as for cells of a grid.
        box = np.floor((axis - axis.min(initial=0)) / (BOX * spacing))
        number = number * (box.max(initial=0) + 1) + box
    _, first, same = np.unique(number, return_index=True, return_inverse=True)
    share = np.full((len(first), mesh.k + 1), 1 / (mesh.k + 1))
    along, there = flow.directions(CellPlaces(cell[first], share))
    near = distances.of_points(middle[first], along, None, 1)[0].min(axis=1)
    away = middle - middle[first[same]]
    # The triangle inequality: no middle is farther than that of its box's first cell and the way.
    far = near[same] + np.sqrt(np.einsum("ni,ni->n", away, away))
    rows = np.flatnonzero(there)
    rows = rows[np.argsort(-near[rows], kind="stable")[:FIRST]]
    # The farthest few, measured exactly, set a bound that rules out most cells at once.
    gap = float(distances.of_lines(middle[first[rows]], along[rows]).max(initial=0))
    # Cells that cannot hold a larger gap than the one found are not halved at all.
    kept = np.flatnonzero(far + radius > gap + TOLERANCE * spacing)
    # The corners of a whole cell have the weight 1 at one vertex each.
    whole = np.tile(np.eye(mesh.k + 1), (len(kept), 1, 1))
    cell_corners = np.stack([corner[kept] for corner in corners], axis=1)
    return Parts(cell[kept], whole, cell_corners, far[kept], radius[kept]), gap


def evenness(flow: Flow, spacing: float, curves: Curves, /) -> tuple[float, float]:
    """Return how even curves are.

    They are the largest distance of a place from the nearest curve, see :func:`largest_gap`, and
    the distance of a curve's place to the nearest other curve that 5 % of the places fall below,
    infinite for a single curve; both in spacings.
    """
    distances = Distances(flow, spacing, curves)
    gap = largest_gap(distances)
    random, count = np.random.default_rng(1), len(distances.there)
    # The generator has a fixed seed, so the same curves have the same number.
    picked = random.choice(count, min(count, ON_CURVES), replace=False)
    nearest = distances.of_points(
        distances.there[picked], curves.along[picked], distances.curve[picked], 32
    )[0].min(axis=1, initial=np.inf)
    nearest = nearest[np.isfinite(nearest)]
    near = float(np.percentile(nearest, 5)) if len(nearest) else np.inf
    return gap / spacing, near / spacing
