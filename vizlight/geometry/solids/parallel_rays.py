"""All hits of parallel rays: points in triangles of the plane that is normal to the rays."""

from __future__ import annotations

import numpy as np

from vizlight._types import Array, Bools, Indices
from vizlight.geometry import axial

#: Largest number of pairs of a ray and a triangle that are tested at once.
PAIRS = 1 << 17
#: Number of pairs for each ray and triangle beyond which another method is faster.
MOST = 100
#: Largest number of cells along a side of the grid that finds the rays near a triangle.
CELLS = 1 << 11


def hits(
    vertices: Array, triangles: Indices, start: Array, way: Array, most: float = MOST
) -> tuple[Indices, Indices] | None:
    """Return the ray and the triangle of every hit of the lines through parallel rays.

    All rays have one unit direction, and hits are on both sides of their starts. None is returned
    where the boxes around the triangles hold more than ``most`` pairs for each ray and triangle: a
    search tree is faster then.

    A ray through an edge or a vertex hits as one that is displaced by an infinitesimal amount, the
    same for all triangles: through a closed surface each ray enters as often as it leaves.
    The side of an edge on which a ray is depends on nothing but the edge, and is computed from its
    nearer end.
    """
    across = np.stack(axial.frame(way), axis=1)
    # Coordinates far from the origin would round off what tells the sides of an edge.
    origin = vertices.mean(axis=0) if len(vertices) else np.zeros(3)
    place = np.ascontiguousarray(((vertices - origin) @ across).T)
    a, b, c = (place[:, triangles[:, i]] for i in range(3))
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    grid = _Grid(np.ascontiguousarray(((start - origin) @ across).T), low, high)
    begin, end, owner = grid.runs(low, high)
    size = end - begin
    # Boxes around slanted or huge triangles overlap many rays that miss them.
    if size.sum() > most * (len(start) + len(triangles)):
        return None
    # Each edge from its lower to its higher index.
    after = np.roll(triangles, -1, axis=1)
    ends = place[:, np.minimum(triangles, after).T], place[:, np.maximum(triangles, after).T]
    # Whether the triangle runs through the edge the other way.
    turned = (triangles > after).T.copy()
    rays, cells = [np.empty(0, np.intp)], [np.empty(0, np.intp)]
    total = np.cumsum(size)
    first = 0
    while first < len(size):
        # As many runs as have PAIRS pairs together, but at least one, however long it is.
        done = int(total[first - 1]) if first else 0
        last = max(int(np.searchsorted(total, done + PAIRS, side="right")), first + 1)
        count = size[first:last]
        # All numbers of the runs in one array, without a loop over the runs.
        step = np.repeat(begin[first:last] - (total[first:last] - count - done), count)
        pair = step + np.arange(len(step))
        cell = np.repeat(owner[first:last], count)
        # The cells of the grid are coarse: the boxes themselves leave out most pairs before edges
        # are tried.
        for axis in range(2):
            there = grid.points[axis, pair]
            near = np.flatnonzero((there >= low[axis, cell]) & (there <= high[axis, cell]))
            pair, cell = pair[near], cell[near]
        inside = _inside(*ends, turned, grid.points[:, pair], cell)
        rays.append(grid.order[pair[inside]])
        cells.append(cell[inside])
        first = last
    return np.concatenate(rays), np.concatenate(cells)


def _inside(start: Array, stop: Array, turned: Bools, point: Array, cell: Indices) -> Bools:
    """Return a mask of plane points that are inside their triangles, given by the edges."""
    left = []
    for i in range(3):
        begin, end = start[:, i, cell], stop[:, i, cell]
        x, y = end - begin
        (u, v), (far_u, far_v) = point - begin, point - end
        # Products of small differences have small rounding errors.
        nearer = np.abs(far_u) + np.abs(far_v) < np.abs(u) + np.abs(v)
        side = x * np.where(nearer, far_v, v) - y * np.where(nearer, far_u, u)
        # On the line of the edge: the side of the point that is displaced by (e, e^2).
        side = np.where(side == 0, np.where(y == 0, x, -y), side)
        left.append((side > 0) != turned[i, cell])
    # Triangles that face either way count: the point is on one side of all three edges.
    return np.asarray((left[0] == left[1]) & (left[1] == left[2]))


class _Grid:
    """Points of a plane sorted by the cells of a grid, row after row."""

    def __init__(self, points: Array, low: Array, high: Array) -> None:
        some = points.size and low.size
        # Only where points and triangles are both can there be hits.
        self.low = np.maximum(points.min(axis=1), low.min(axis=1)) if some else np.zeros(2)
        top = np.minimum(points.max(axis=1), high.max(axis=1)) if some else np.zeros(2)
        # About one point to a cell.
        self.count = min(max(int(np.sqrt(points.shape[1])), 1), CELLS)
        extent = top - self.low
        # Without an extent, all points share one row or column.
        self.scale = self.count / np.where(extent > 0, extent, 1)
        # Points outside all triangles are left out.
        x, y = points
        there = (x >= self.low[0]) & (x <= top[0]) & (y >= self.low[1]) & (y <= top[1])
        kept = np.flatnonzero(there)
        column, row = self._cell(points[:, kept])
        code = row * self.count + column
        order = np.argsort(code, kind="stable")
        self.order = kept[order]
        self.points = points[:, self.order]
        # One more than there are cells: the last is the end of the last cell.
        self.first = np.searchsorted(code[order], np.arange(self.count**2 + 1))

    def _cell(self, points: Array) -> Indices:
        cell = np.floor((points - self.low[:, np.newaxis]) * self.scale[:, np.newaxis])
        # Boxes may reach beyond the grid, whose outer cells stand for all that is there.
        return np.clip(cell, 0, self.count - 1).astype(np.intp)

    def runs(self, low: Array, high: Array) -> tuple[Indices, Indices, Indices]:
        """Return the points near boxes: runs of sorted points, and the box of each run."""
        (left, bottom), (right, top) = self._cell(low), self._cell(high)
        # A box has one run for each row of cells, for cells of a row follow one another.
        rows = top - bottom + 1
        owner = np.repeat(np.arange(len(rows)), rows)
        row = np.arange(len(owner)) - np.repeat(np.cumsum(rows) - rows, rows) + bottom[owner]
        begin = self.first[row * self.count + left[owner]]
        end = self.first[row * self.count + right[owner] + 1]
        filled = end > begin
        return begin[filled], end[filled], owner[filled]
