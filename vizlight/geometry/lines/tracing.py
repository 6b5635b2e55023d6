"""Curves of a field, traced from cell to cell, many at once; also those of cross fields."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Bools, Indices
from vizlight.geometry.lines.simplices import CellPlaces, Columns, Simplices, numbered


def double_cover(points: Array, cells: Indices, pairs: Array) -> tuple[Simplices, Array]:
    """Return simplices on which a cross field is a line field.

    ``pairs`` (N, 2, 3) has two directions at each vertex, of length 1, or zero without a direction;
    their order and their signs may differ from vertex to vertex. Of the 2 N vertices and 2 M cells
    of the result, cell i + M lies on cell i, with corners in the same order, and vertex j + N on
    vertex j; the lines (2 N, 3) are the two of each pair.

    The directions at both ends of an edge are matched such that the sum of their ``|cos|`` is the
    larger one, and cells share a side where their matches agree. A curve that goes once around a
    singularity of index 1/4 so comes to the other cell over its place, as it continues along the
    other direction. In the cell of such a singularity no match fits all edges: one side of it is a
    boundary. Source: Kaelberer, Nieser and Polthier, QuadCover (2007), for the covering.
    """
    count = len(points)
    # Vertices at one position are compared with the first of them.
    number = numbered(points)
    first = np.unique(number, return_index=True)[1]
    # Copies of a vertex may list its pair in either order: the sheet tells which belong together.
    turned = _turned(pairs[first[number]], pairs)
    corners = pairs[cells]
    # Whether a corner continues the first direction of the cell's first corner as its second one.
    other = _turned(corners[:, :1], corners)
    # The same cell on either sheet: all its corners are exchanged for those on the other one.
    twice = np.concatenate([cells + count * other, cells + count * ~other])
    mesh = Simplices(np.concatenate([points, points]), twice, np.concatenate([turned, ~turned]))
    return mesh, np.concatenate([pairs[:, 0], pairs[:, 1]])


def _turned(a: Array, b: Array) -> Bools:
    """Return whether the first direction of each pair b continues the second one of a."""
    # Without sign, as the directions of a cross have none.
    cosine = np.abs(np.einsum("...ic,...jc->...ij", a, b))
    straight = cosine[..., 0, 0] + cosine[..., 1, 1]
    return np.asarray(straight < cosine[..., 0, 1] + cosine[..., 1, 0])


#: Speed below which a curve has come to rest.
AT_REST = 1e-6


@dataclass(frozen=True)
class Tracing:
    """Parameters of traced curves, in a mesh of size 1; see the options of streamlines.

    ``step`` is the largest length of a step in extents of its cell, ``max_length`` and
    ``max_steps`` hold on either side of a seed, and ``seed`` is that of random places.
    """

    step: float
    max_length: float
    max_steps: int
    seed: int


class Flow:
    """A field of directions on simplices.

    Vectors at the vertices are finite, of a median length near 1. Those of a ``line_field`` have no
    sign: in each cell they are aligned with the direction of the curve before they are
    interpolated. ``normals`` are of a surface; None in a volume.
    """

    def __init__(
        self,
        mesh: Simplices,
        vectors: Array,
        *,
        line_field: bool = False,
        normals: Array | None = None,
    ) -> None:
        self.mesh, self.line_field, self.normals = mesh, line_field, normals
        self.vectors = np.asarray(vectors, dtype=np.float64)

    def directions(
        self, places: CellPlaces, along: Array | None = None, sign: Array | None = None
    ) -> tuple[Array, Bools]:
        """Return unit directions, and a mask of the places that have one.

        Lines without sign are aligned with ``along``; where it does not decide, ``sign`` is 1 along
        the vectors, the default, or -1 against them.
        """
        sign = np.ones(len(places.cell)) if sign is None else sign
        corners = self.vectors[self.mesh.cells[places.cell]]
        if self.line_field:
            # The vertex that counts most gives the direction where there is none yet.
            most = np.argmax(places.weights, axis=1)
            first = corners[np.arange(len(most)), most] * sign[:, np.newaxis]
            turned = np.einsum("nij,nj->ni", corners, first if along is None else along) < 0
            corners = np.where(turned[:, :, np.newaxis], -corners, corners)
        vectors = np.einsum("ni,nij->nj", places.weights, corners)
        # Lines are aligned with a direction that has its sign already.
        if not self.line_field:
            vectors *= sign[:, np.newaxis]
        speed = np.linalg.norm(vectors, axis=1)
        moving = speed > AT_REST
        return vectors / np.where(moving, speed, 1)[:, np.newaxis], moving


@dataclass
class Walkers(Columns):
    """Ends of curves that grow.

    ``sign`` is 1 for the end of a ``curve`` that runs along the field from the seed, -1 for the
    other; ``along`` has the unit directions in which they go, ``number`` and ``length`` those of
    the steps so far.
    """

    curve: Indices
    sign: Array
    places: CellPlaces
    along: Array
    number: Indices
    length: Array

    @classmethod
    def from_seeds(cls, flow: Flow, seeds: CellPlaces, curves: Indices) -> Walkers:
        """Return both ends of the curves through seeds; none where the field has no direction."""
        count = len(curves)
        sign = np.repeat([1.0, -1.0], count)
        places = seeds.joined(seeds)
        along, moving = flow.directions(places, sign=sign)
        ends = cls(
            np.tile(curves, 2), sign, places, along,
            np.zeros(2 * count, dtype=np.intp), np.zeros(2 * count),
        )  # fmt: skip
        return ends[moving]

    def advanced(self, flow: Flow, step: Array) -> tuple[Walkers, Bools, Bools]:
        """Take one step by the midpoint rule.

        The masks are of ends that have gone a step, not where a curve comes to rest or turns back,
        and of ends that go on, not where they have reached a boundary.
        """
        # The direction half a step ahead carries the whole step, which makes its error of order 3.
        half, _ = flow.mesh.walk(self.places, self.along * (step / 2)[:, np.newaxis])
        middle, moving = flow.directions(half, self.along, self.sign)
        end, inside = flow.mesh.walk(self.places, middle * step[:, np.newaxis])
        last, still = flow.directions(end, middle, self.sign)
        # Where the field turns by a right angle within half a step no curve is followed any more.
        stepped = moving & still & (np.einsum("ni,ni->n", last, middle) > 0)
        number, length = self.number + 1, self.length + step
        return Walkers(self.curve, self.sign, end, last, number, length), stepped, inside


@dataclass
class Curves:
    """Curves as places, one curve after the other.

    Each curve runs in the direction of the field, which has the unit directions ``along``;
    ``offsets`` has the start of each, followed by the number of places.
    """

    places: CellPlaces
    along: Array
    offsets: Indices

    def joined(self, other: Curves) -> Curves:
        """Return these curves and then others."""
        offsets = np.concatenate([self.offsets, other.offsets[1:] + self.offsets[-1]])
        along = np.concatenate([self.along, other.along])
        return Curves(self.places.joined(other.places), along, offsets)

    def first(self, count: int) -> Curves:
        """Return the first curves."""
        offsets = self.offsets[: count + 1]
        return Curves(self.places[: offsets[-1]], self.along[: offsets[-1]], offsets)


def passed(
    trail: list[Walkers], last: dict[tuple[int, int], int], *, closed: set[int], dropped: set[int]
) -> Curves:
    """Return the curves along which ends have gone, in the order of their numbers.

    ``trail`` has the ends after each step, ``last`` the number of the last step that is kept, by
    curve and sign, where some are not. ``closed`` curves return from their last place to the first;
    ``dropped`` ones are left out.
    """
    all_ = trail[0].joined(*trail[1:])
    limit = np.full((int(all_.curve.max(initial=0)) + 1, 2), np.iinfo(np.intp).max)
    for (curve, sign), number in last.items():
        limit[curve, int(sign > 0)] = number
    # Numbers of steps begin at 0, so that nothing is kept of these.
    limit[[*dropped]] = -1
    kept = all_.number <= limit[all_.curve, (all_.sign > 0).astype(np.intp)]
    # From the last step against the field by the seed to the last one along it.
    order = np.lexsort((all_.sign * all_.number, all_.curve))
    order = order[kept[order]]
    # Both ends begin at the seed; one of them is enough.
    same = (all_.curve[order][1:] == all_.curve[order][:-1]) & (
        (all_.number[order][1:] == 0) & (all_.number[order][:-1] == 0)
    )
    order = order[np.append(True, ~same)] if len(order) else order
    names, starts, counts = np.unique(all_.curve[order], return_index=True, return_counts=True)
    runs = []
    for name, start, count in zip(names.tolist(), starts, counts, strict=True):
        run = order[start : start + count]
        # A single place is no line.
        if count > 1:
            runs.append(np.append(run, run[0]) if name in closed else run)
    rows = np.concatenate(runs) if runs else np.empty(0, dtype=np.intp)
    offsets = np.concatenate([[0], np.cumsum([len(run) for run in runs])]).astype(np.intp)
    # Ends go away from the seed, but a whole curve goes along the field.
    along = all_.along[rows] * all_.sign[rows][:, np.newaxis]
    return Curves(all_.places[rows], along, offsets)


def trace(
    flow: Flow,
    seeds: CellPlaces,
    how: Tracing,
    /,
    *,
    report: Callable[[int], None] = lambda _: None,
) -> Curves:
    """Return the integral curves through seeds, in both directions.

    Those that leave their seed are returned, in the order of the N seeds; ``report`` takes the
    number of ends that have stopped, out of 2 N.

    Midpoint rule: the error of a step is of order 3. A curve ends at a boundary, where the field
    is below a millionth, or where it turns by a right angle in one step.
    """
    walkers = Walkers.from_seeds(flow, seeds, np.arange(len(seeds.cell)))
    trail = [walkers]
    for _ in range(how.max_steps):
        if not len(walkers.curve):
            break
        # The last step is shorter, so that a curve is not longer than what was asked for.
        room = how.max_length - walkers.length
        size = np.minimum(how.step * flow.mesh.sizes(walkers.places), room)
        walkers, stepped, inside = walkers.advanced(flow, size)
        trail.append(walkers[stepped])
        # Lengths are sums of steps, whose rounding must not lead to one more step of almost
        # nothing.
        walkers = walkers[stepped & inside & (walkers.length < how.max_length * (1 - 1e-9))]
        report(2 * len(seeds.cell) - len(walkers.curve))
    return passed(trail, {}, closed=set(), dropped=set())
