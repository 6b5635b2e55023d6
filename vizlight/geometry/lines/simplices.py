"""Walks on triangles and tetrahedra: points that move from cell to cell, many at once."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _pool
from vizlight._types import Array, Bools, Indices, Rows

if TYPE_CHECKING:
    from typing_extensions import Self

#: Largest number of cells that one step crosses.
MOST_CROSSINGS = 300
#: Least number of edges that are looked at, or sorted, at once.
EDGES = 1 << 19


class Columns:
    """Base class of rows, with arrays or such rows themselves as fields; others are of all rows."""

    def __getitem__(self, rows: Rows) -> Self:
        """Return some of the rows."""
        part = copy.copy(self)
        for name, column in vars(self).items():
            if isinstance(column, np.ndarray | Columns):
                vars(part)[name] = column[rows]
        return part

    def joined(self, *others: Self) -> Self:
        """Return these rows and then others."""
        columns = zip(*(vars(part).values() for part in (self, *others)), strict=True)
        return type(self)(
            *(
                first.joined(*rest)
                if isinstance(first, Columns)
                else np.concatenate([first, *rest])
                for first, *rest in columns
            )
        )


@dataclass
class CellPlaces(Columns):
    """Places in cells.

    ``weights`` (N, k + 1) are barycentric coordinates in the ``cell`` of each.
    """

    cell: Indices
    weights: Array


def numbered(points: Array) -> Indices:
    """Return one number for each position, from 0 on, shape (N,)."""
    order = np.lexsort(points.T)
    ranked = points[order]
    fresh = np.ones(len(order), dtype=np.intp)
    # NaN differs from itself, so that a point without a place is merged with no other.
    fresh[1:] = np.any(ranked[1:] != ranked[:-1], axis=1)
    number = np.empty(len(order), dtype=np.intp)
    number[order] = np.cumsum(fresh) - 1
    return number


def components(a: Indices, b: Indices, count: int, *, kind: type = np.intp) -> Indices:
    """Return for each of some points the first of those that edges connect it with.

    Points are hooked to neighbours of lower numbers until all edges lie in one tree each.

    ``a`` and ``b`` are the ends of the edges, the lower one first.
    """
    root: Indices = np.arange(count, dtype=kind)
    # Roots have the lower numbers, so that no cycle can form; of several edges at one upper end the
    # last is taken, and the loop below meets the others again.
    root[b] = a
    while True:
        # Each step halves the depth of the trees, until every point names its root.
        while not np.array_equal(further := root[root], root):
            root = further
        left_a, left_b = [], []
        for block in _pool.blocks(len(a), EDGES):
            start, other = root[a[block]], root[b[block]]
            apart = start != other
            left_a.append(np.minimum(start[apart], other[apart]))
            left_b.append(np.maximum(start[apart], other[apart]))
        a, b = (np.concatenate([root[:0], *left]) for left in (left_a, left_b))
        if not len(a):
            return root
        # Roots are hooked, not points, so that whole trees join, each to the lowest of its
        # neighbours.
        np.minimum.at(root, b, a)


def _across(edges: Array) -> tuple[Array, Array]:
    """Return vectors across the sides of simplices, and the squares of their volumes.

    ``edges`` (M, k, 3) go from the first vertex of each to the others. The vectors are gradients of
    the weights 1 to k times the second result, in the planes of triangles.
    """
    a, b = edges[:, 0], edges[:, 1]
    normal = np.cross(a, b)
    if edges.shape[1] == 2:
        across = [np.cross(b, normal), np.cross(normal, a)]
        return np.stack(across, axis=1), np.einsum("mi,mi->m", normal, normal)
    c = edges[:, 2]
    volume = np.einsum("mi,mi->m", normal, c)
    across = [np.cross(b, c), np.cross(c, a), normal]
    return np.stack(across, axis=1) * volume[:, np.newaxis, np.newaxis], volume**2


class Simplices:
    """Triangles or tetrahedra in 3-space, and their neighbours across sides.

    ``cells`` (M, k + 1) has k = 2 for triangles and 3 for tetrahedra. Vertices at the same position
    count as one, on the same of two ``sheets`` that lie on one another; cells without extent have
    no neighbours.
    """

    def __init__(self, points: Array, cells: Indices, sheets: Bools | None = None) -> None:
        self.points, self.sheets = np.asarray(points, dtype=np.float64), sheets
        self.cells = np.asarray(cells, dtype=np.intp)
        self.k = self.cells.shape[1] - 1
        corners = self.points[self.cells]
        edges = corners[:, 1:] - corners[:, :1]
        with np.errstate(all="ignore"):
            size = np.einsum("mij,mij->m", edges, edges)
            # Relative to the size of the cell: slivers have no direction across, whatever their
            # unit.
            scale = np.where(size > 0, size, 1)[:, np.newaxis, np.newaxis]
            across, volume = _across(edges / np.sqrt(scale))
            self.good: Bools = np.isfinite(volume) & (volume > 1e-24)
            # Rows of the pseudoinverse are the gradients of the weights 1 to k; all sum to zero.
            rest = across / (volume[:, np.newaxis, np.newaxis] * np.sqrt(scale))
        rest[~self.good] = 0
        self.gradients = np.concatenate([-rest.sum(axis=1, keepdims=True), rest], axis=1)
        self._extents = np.linalg.norm(np.ptp(corners, axis=1), axis=1)

    @cached_property
    def merged(self) -> Indices:
        """Vertices of each cell with one number for each position, shape (M, k + 1)."""
        number = numbered(self.points)
        if self.sheets is not None:
            # Both sheets of a double cover have their own numbers: a walk never changes sheets by
            # itself.
            number = 2 * number + self.sheets
        return np.asarray(number[self.cells])

    @cached_property
    def neighbours(self) -> Indices:
        """Cell beyond the side opposite each vertex, shape (M, k + 1); -1 at a boundary.

        A side of three cells or more has no cell beyond.
        """
        k = self.k
        cells = np.flatnonzero(self.good)
        # The side opposite vertex i has all vertices but i; two equal sides make two cells
        # neighbours. Of sorted corners each side is sorted.
        corners = self.merged[cells]
        rank = np.argsort(corners, axis=1)
        corners = np.take_along_axis(corners, rank, axis=1)
        sides = np.stack([np.delete(corners, i, axis=1) for i in range(k + 1)], axis=1)
        sides = sides.reshape(-1, k)
        count = int(corners.max(initial=0)) + 1
        if count**k < 2**63:
            # One number for each side is sorted faster than k.
            sides = (sides @ count ** np.arange(k))[:, np.newaxis]
        order = np.lexsort(sides.T) if sides.shape[1] > 1 else np.argsort(sides[:, 0])
        ranked = sides[order]
        same = np.all(ranked[1:] == ranked[:-1], axis=1)
        before, after = np.append(False, same), np.append(same, False)
        # A run of exactly two: where three cells or more meet it is not clear which comes next.
        twice = np.flatnonzero(same & ~before[:-1] & ~after[1:])
        across = np.full((len(cells), k + 1), -1, dtype=np.intp)
        a, b = order[twice], order[twice + 1]
        # Each cell has k + 1 sides one after the other, so that a quotient tells the cell.
        across.ravel()[a] = cells[b // (k + 1)]
        across.ravel()[b] = cells[a // (k + 1)]
        neighbours = np.full(self.cells.shape, -1, dtype=np.intp)
        neighbours[cells] = np.take_along_axis(across, np.argsort(rank, axis=1), axis=1)
        return neighbours

    @cached_property
    def border(self) -> Array:
        """Ends of the sides of triangles without a cell beyond, shape (N, 2, 3)."""
        cell, opposite = np.nonzero((self.neighbours < 0) & self.good[:, np.newaxis])
        ends = [self.cells[cell, (opposite + i) % 3] for i in (1, 2)]
        return np.asarray(self.points[np.stack(ends, axis=1)])

    @cached_property
    def _sizes(self) -> Array:
        """Mean extent of the cells at each vertex of each cell, shape (M, k + 1)."""
        numbers = self.merged.ravel()
        total = np.bincount(numbers, np.repeat(self._extents, self.k + 1))
        return np.asarray((total / np.maximum(np.bincount(numbers), 1))[self.merged])

    def sizes(self, places: CellPlaces) -> Array:
        """Return the extent of cells near places, by which steps are chosen; it has no jumps."""
        return np.asarray(np.einsum("ni,ni->n", places.weights, self._sizes[places.cell]))

    @cached_property
    def measures(self) -> Array:
        """Area or volume of each cell, 0 where it has none."""
        corners = self.points[self.cells]
        edges = corners[:, 1:] - corners[:, :1]
        if self.k == 2:
            size = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
        else:
            size = np.abs(np.linalg.det(edges)) / 6
        return np.where(self.good & np.isfinite(size), size, 0)

    @property
    def extent(self) -> float:
        """Area or volume of all cells."""
        return float(self.measures.sum())

    def one_each(self) -> CellPlaces:
        """Return the middle of the largest cell of each connected part."""
        cells = np.flatnonzero(self.good)
        beyond = self.neighbours[cells]
        owner = np.broadcast_to(cells[:, np.newaxis], beyond.shape)
        # Neighbours name each other: each pair counts once, the lower one first.
        once = owner < beyond
        part = components(owner[once], beyond[once], len(self.cells))[cells]
        measures, largest = self.measures[cells], np.zeros(len(self.cells))
        np.maximum.at(largest, part, measures)
        chosen = np.flatnonzero(measures == largest[part])
        first = chosen[np.unique(part[chosen], return_index=True)[1]]
        share = np.full((len(first), self.k + 1), 1 / (self.k + 1))
        return CellPlaces(cells[first], share)

    def positions(self, places: CellPlaces) -> Array:
        """Return the positions of places, shape (N, 3)."""
        return self.interpolated(self.points, places)

    def interpolated(self, values: Array, places: CellPlaces) -> Array:
        """Return values of the vertices at places."""
        return np.asarray(
            np.einsum("ni,ni...->n...", places.weights, values[self.cells[places.cell]])
        )

    def locate(self, cell: Indices, positions: Array) -> CellPlaces:
        """Return the places of positions in given cells, or the nearest in each cell roughly."""
        first = self.points[self.cells[cell]]
        middle = first.mean(axis=1)
        share = 1 / (self.k + 1)
        # Weights are linear: those of the middle plus gradient times the way from there.
        weights = share + np.einsum("nij,nj->ni", self.gradients[cell], positions - middle)
        weights = np.maximum(weights, 0)
        return CellPlaces(cell, weights / weights.sum(axis=1, keepdims=True))

    def random(self, count: int, random: np.random.Generator) -> CellPlaces:
        """Return random places, uniform in area or volume; one in each of ``count`` equal parts."""
        total = np.cumsum(self.measures)
        # Stratified: one random place in each of equal shares, so there are no large holes.
        at = (np.arange(count) + random.random(count)) * (total[-1] / count)
        cell = np.minimum(np.searchsorted(total, at, side="right"), len(total) - 1)
        # Normalised exponentials are uniform in a simplex.
        weights = random.standard_exponential((count, self.k + 1))
        return CellPlaces(cell, weights / weights.sum(axis=1, keepdims=True))

    def walk(self, places: CellPlaces, steps: Array) -> tuple[CellPlaces, Bools]:
        """Return the ends of straight steps, and a mask of those that ended before a boundary.

        On triangles a step is laid into the plane of its first triangle with its length kept, and
        continues straight across edges, as if both triangles were unfolded. A step that would leave
        the mesh ends on the boundary.
        """
        # In barycentric coordinates a straight step changes each weight at a constant rate; the
        # first weight to reach 0 tells the side through which it leaves.
        cell, weights = places.cell.copy(), places.weights.copy()
        inside = np.ones(len(cell), dtype=np.bool_)
        ahead = self._laid(cell, steps)
        on = np.arange(len(cell))
        for _ in range(MOST_CROSSINGS):
            here, at = cell[on], weights[on]
            change = np.einsum("nij,nj->ni", self.gradients[here], ahead)
            with np.errstate(all="ignore"):
                # In units of the step: a side that is reached at 1 or later is not crossed.
                time = np.where(change < 0, -at / change, np.inf)
            side = np.argmin(time, axis=1)
            rows = np.arange(len(on))
            share = np.minimum(time[rows, side], 1.0)
            # Rounding may leave a weight just below 0.
            at = np.maximum(at + share[:, np.newaxis] * change, 0)
            through = time[rows, side] < 1
            at[rows[through], side[through]] = 0
            at /= at.sum(axis=1, keepdims=True)
            weights[on] = at
            beyond = self.neighbours[here, side]
            inside[on[through & (beyond < 0)]] = False
            go = through & (beyond >= 0)
            if not go.any():
                return CellPlaces(cell, weights), inside
            # The rest of the step goes on in the neighbour; steps that are done drop out of the
            # arrays.
            on, ahead = on[go], ahead[go] * (1 - share[go])[:, np.newaxis]
            cell[on], weights[on], ahead = self._crossed(
                here[go], side[go], at[go], beyond[go], ahead
            )
        # Steps that cross too many cells end where they are.
        inside[on] = False
        return CellPlaces(cell, weights), inside

    def _laid(self, cell: Indices, steps: Array) -> Array:
        """Return steps in the planes of their triangles, of the same length."""
        if self.k == 3:
            return steps
        # A weight's change times an edge, summed, is the part of a step in the plane.
        change = np.einsum("nij,nj->ni", self.gradients[cell], steps)
        flat = np.einsum("ni,nij->nj", change, self.points[self.cells[cell]])
        length, step_length = np.linalg.norm(flat, axis=1), np.linalg.norm(steps, axis=1)
        # A step at a right angle to the triangle has no direction in it and leads nowhere.
        scale = np.where(length > 0, step_length / np.where(length > 0, length, 1), 0)
        return np.asarray(flat * scale[:, np.newaxis])

    def _crossed(
        self, cell: Indices, side: Indices, weights: Array, beyond: Indices, ahead: Array
    ) -> tuple[Indices, Array, Array]:
        """Return cell, weights and the rest of the step beyond the side of a cell."""
        corners, next_corners = self.merged[cell], self.merged[beyond]
        # By number of the position: neighbours may have vertices of their own at the same place.
        shared = next_corners[:, :, np.newaxis] == corners[:, np.newaxis, :]
        # Where one triangle lies on the other even the vertex left behind has the place of one
        # beyond.
        shared[np.arange(len(cell)), :, side] = False
        # Weights move along with their vertices; the new one begins at 0, as the place is on the
        # side.
        moved_weights = np.einsum("nij,nj->ni", shared, weights)
        if self.k == 2:
            # On triangles the step is turned about the common edge as if both were unfolded into
            # one plane: its part along the edge stays, its part across points toward the new
            # triangle's third vertex.
            apex = np.argmin(shared.any(axis=2), axis=1)
            # The gradient of a weight points from the opposite side toward its vertex, at a right
            # angle.
            inward = self.gradients[beyond, apex]
            inward = inward / np.linalg.norm(inward, axis=1, keepdims=True)
            rows = np.arange(len(cell))
            a = self.points[self.cells[cell, (side + 1) % 3]]
            edge = self.points[self.cells[cell, (side + 2) % 3]] - a
            edge /= np.linalg.norm(edge, axis=1, keepdims=True)
            along = np.einsum("ni,ni->n", ahead, edge)
            across = ahead - along[rows, np.newaxis] * edge
            ahead = along[:, np.newaxis] * edge + (
                np.linalg.norm(across, axis=1, keepdims=True) * inward
            )
        return beyond, moved_weights, ahead
