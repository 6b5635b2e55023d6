"""Rays through a height field, cell by cell or, where possible, through larger squares of cells."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.relief.height_field import Field

#: Represents infinity on a ray; unlike infinity it gives 0 when multiplied by 0.
FAR = 1e300


def march(field: Field, start: Array, way: Array, reach: Array, *, coarse: bool) -> Array:
    """Return the length of rays inside the solid; infinity where it is unbounded.

    Parameters
    ----------
    field : Field
        Height field.
    start : ndarray, shape (3, N)
        Start of each ray, relative to the field's origin, in float64.
    way : ndarray, shape (3, N)
        Unit directions.
    reach : ndarray, shape (N,)
        Lengths of the rays, at most FAR.
    coarse : bool
        Whether to cross 2^l x 2^l cells at once where all of them lie above or below the ray;
        otherwise rays go through every cell.
    """
    length = np.zeros(start.shape[1])
    first, end = _clip(field, start, way, reach)
    row = np.flatnonzero(first < end)
    rays = _Rays(field, start[:, row], way[:, row], first[row], end[row], coarse=coarse)
    with np.errstate(divide="ignore", invalid="ignore"):
        while len(row):
            # Each ray has its own row, so no addition is lost.
            length[row] += rays.step()
            going = rays.s < rays.end
            if np.count_nonzero(going) < 0.8 * len(row):
                rays.keep(going)
                row = row[going]
    length[length >= 0.5 * FAR] = np.inf
    return length


def _clip(field: Field, start: Array, way: Array, reach: Array) -> tuple[Array, Array]:
    """Return the distances between which rays are below the highest node."""
    rise, z = way[2], start[2]
    # With a rise near 0 the distance may exceed FAR.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place = (field.top - z) / rise
    first = np.where(rise < 0, place, 0.0)
    last = np.where(rise > 0, place, FAR)
    outside = (rise == 0) & (z >= field.top)
    return np.maximum(first, 0.0), np.where(outside, -1.0, np.minimum(last, reach))


class _Rays:
    """Rays in progress, each in a square of 2^l x 2^l cells; every step advances all of them."""

    def __init__(
        self, field: Field, start: Array, way: Array, s: Array, end: Array, *, coarse: bool
    ) -> None:
        levels = field.bounds if coarse else field.bounds[:1]
        self.top = len(levels) - 1
        self.columns = np.array([largest.shape[1] for largest, _ in levels], np.int32)
        self.offset = np.cumsum([0] + [largest.size for largest, _ in levels], dtype=np.int32)
        self.largest = np.concatenate([largest.ravel() for largest, _ in levels])
        self.least = np.concatenate([least.ravel() for _, least in levels])
        self.edges = field.edges
        self.corners = field.corners.ravel()
        self.stride = field.corners.shape[1]

        self.start, self.way, self.s, self.end = start, way, s, end
        self.level = np.zeros(len(s), np.int32)
        place = start[:2] + s * way[:2]
        self.cell = np.stack([field.cell(a, place[a]) for a in (0, 1)]).astype(np.int32)
        #: Whether rays run in a plane of nodes, and so beside cells of which one may be empty.
        self.beside = np.zeros((2, len(s)), np.bool_)
        if field.border == "wall":
            at = np.stack([self.edges[a][self.cell[a]] for a in (0, 1)])
            self.beside = (way[:2] == 0) & (start[:2] == at)

    def keep(self, going: Bools) -> None:
        """Drop the rays that have reached their end."""
        for name in ("start", "way", "cell", "s", "end", "level", "beside"):
            setattr(self, name, getattr(self, name)[..., going])

    def step(self) -> Array:
        """Move each ray through its square or into a quarter of it; return the length inside."""
        (x, y), (i, j), level, s = self.way[:2], self.cell, self.level, self.s
        cross_x, cross_y = self._cross(0), self._cross(1)
        by_x = cross_x <= cross_y
        leave = np.minimum(np.maximum(np.where(by_x, cross_x, cross_y), s), self.end)
        z0 = self.start[2] + s * self.way[2]
        z1 = self.start[2] + leave * self.way[2]
        own = self._own_cell()
        at = self.offset[level] + own[1] * self.columns[level] + own[0]
        above = np.minimum(z0, z1) >= self.largest[at]
        below = np.maximum(z0, z1) <= self.least[at]
        clear = above | below
        inside = np.where(below, leave - s, 0.0)
        leaf = np.flatnonzero(~clear & (level == 0))
        inside[leaf] = self._in_cell(leaf, own[:, leaf], leave[leaf])

        descend = ~clear & (level > 0)
        onward = ~descend & (leave < self.end)
        # Rays move on into the next square of their level ...
        i += np.where(by_x & onward, np.where(x >= 0, 1, -1), 0).astype(np.int32)
        j += np.where(onward & ~by_x, np.where(y >= 0, 1, -1), 0).astype(np.int32)
        np.copyto(s, leave, where=~descend)
        if self.top:
            # ... or into the square twice as wide, if both begin at the same place ...
            entry = np.where(by_x, i ^ (x < 0), j ^ (y < 0)) & 1
            low = (level < self.top) & ~self.beside.any(axis=0)
            ascend = (onward & (entry == 0) & low).astype(np.int32)
            i >>= ascend
            j >>= ascend
            level += ascend
            # ... or down into the quarter that contains the ray.
            self._descend(np.flatnonzero(descend))
        return inside

    def _own_cell(self) -> Indices:
        """Return the squares of rays; in a plane of nodes the one beside it that is not empty."""
        found: Indices = self.cell.astype(np.intp)
        rows = np.flatnonzero(self.beside.any(axis=0))
        if not len(rows):
            return found
        for back in ((0, 0), (1, 0), (0, 1), (1, 1)):
            i, j = found[:, rows]
            empty = np.isneginf(self.largest[j * self.columns[0] + i])
            allowed = np.all(np.array(back, np.bool_) <= self.beside[:, rows].T, axis=1)
            other = rows[empty & allowed]
            found[:, other] = self.cell[:, other] - np.array(back)[:, np.newaxis]
        return found

    def _cross(self, axis: int) -> Array:
        """Return the distances at which rays leave their square along an axis."""
        way, edges = self.way[axis], self.edges[axis]
        out = np.minimum((self.cell[axis] + (way >= 0)) << self.level, len(edges) - 1)
        with np.errstate(over="ignore"):
            return np.where(way == 0, np.inf, (edges[out] - self.start[axis]) / way)

    def _descend(self, which: Indices) -> None:
        if not len(which):
            return
        level = self.level[which] - 1
        for axis in (0, 1):
            edges = self.edges[axis]
            place = self.start[axis, which] + self.s[which] * self.way[axis, which]
            left = self.cell[axis, which] << 1
            middle = edges[np.minimum((left + 1) << level, len(edges) - 1)]
            self.cell[axis, which] = left + (place >= middle)
        self.level[which] = level

    def _in_cell(self, which: Indices, own: Indices, leave: Array) -> Array:
        """Return the length below the bilinear surface of one cell, where f = h - z > 0."""
        (i, j), s = own, self.s[which]
        at = j * self.stride + i
        z00, z01 = self.corners[at], self.corners[at + 1]
        z10, z11 = self.corners[at + self.stride], self.corners[at + self.stride + 1]
        (u, du), (v, dv) = (self._share(axis, own[axis], which, s) for axis in (0, 1))
        # h = z00 + u a + v b + u v c, where u and v are linear in the distance along the ray.
        a, b, c = z01 - z00, z10 - z00, (z11 - z10) - (z01 - z00)
        z = self.start[2, which] + s * self.way[2, which]
        f0 = (z00 - z) + u * a + v * (b + u * c)
        f1 = du * (a + v * c) + dv * (b + u * c) - self.way[2, which]
        return _positive(f0, f1, du * dv * c, leave - s)

    def _share(self, axis: int, cell: Indices, which: Indices, s: Array) -> tuple[Array, Array]:
        """Return relative positions of rays in their cells and their rates of change.

        Both are 0 in an unbounded cell.
        """
        edges, way = self.edges[axis], self.way[axis, which]
        low, width = edges[cell], edges[cell + 1] - edges[cell]
        place = self.start[axis, which] + s * way
        ends = np.isfinite(width)
        return np.where(ends, (place - low) / width, 0.0), np.where(ends, way / width, 0.0)


def _positive(f0: Array, f1: Array, f2: Array, end: Array) -> Array:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0."""
    square = f1 * f1 - 4 * f0 * f2
    root = np.sqrt(np.maximum(square, 0))
    # Both roots without cancellation; where f2 is 0 one of them is infinite.
    q = -0.5 * (f1 + np.copysign(root, f1))
    one, other = q / np.where(f2 == 0, 0.0, f2), f0 / q
    low, high = np.minimum(one, other), np.maximum(one, other)
    between = np.minimum(np.maximum(high, 0), end) - np.minimum(np.maximum(low, 0), end)
    length = np.where(f2 >= 0, end - between, between)
    # Without a root, or for a constant f, the sign is the same everywhere.
    whole = (square < 0) | (q == 0)
    return np.where(whole, np.where(np.maximum(f0, f0 + f2) > 0, end, 0.0), length)
