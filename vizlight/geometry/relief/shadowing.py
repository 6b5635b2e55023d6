"""Cos-theta shadows on height fields, from the length of light rays inside the solid.

Rays go from square to square of cells on a hierarchy of their heights: :func:`march` follows many
at once by NumPy, :func:`walk` one after the other by compiled code. Both cross squares of 2^l x 2^l
cells at once where all of them are above or below a ray, and find the crossings with the bilinear
surface of a cell in closed form.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check, _compiled, _pool
from vizlight._types import Array, Bools, Indices, Slice, VectorLike
from vizlight.geometry.relief import height_field
from vizlight.geometry.relief.height_field import Border, Bounds, Field
from vizlight.model import kernels

#: Represents infinity on a ray; unlike infinity it gives 0 when multiplied by 0.
FAR = 1e300
#: Processor time that a compiled ray saves compared with one of :func:`march`, in seconds.
SAVED = 5e-6


def march(
    start: Array, way: Array, reach: Array, x: Array, y: Array, corners: Array, bounds: Bounds,
    walls: bool, out: Array,
) -> None:  # fmt: skip
    """Write the length of rays inside the solid; infinity where it is unbounded.

    ``start`` is relative to the field's origin, ``way`` has unit directions, both (3, N) in
    float64; ``reach`` is at most FAR. ``x``, ``y``, ``corners`` and ``bounds`` are those of a
    :class:`~vizlight.geometry.relief.height_field.Field`; ``walls``: some cells have no solid.
    """
    out[:] = 0
    top = bounds.largest[-1]
    # Above the highest node there is nothing to meet. With a rise near 0 its distance exceeds FAR.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        place = (top - start[2]) / way[2]
    # A falling ray begins where it comes down to that height, a rising one ends where it reaches
    # it.
    first = np.where(way[2] < 0, np.maximum(place, 0.0), 0.0)
    end = np.where(way[2] > 0, np.minimum(place, reach), reach)
    # A level ray never reaches that height: above all nodes it is left out.
    row = np.flatnonzero((first < end) & ~((way[2] == 0) & (start[2] >= top)))
    rays = _MarchingRays(
        start[:, row], way[:, row], first[row], end[row], (x, y), corners, bounds, walls
    )
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        while len(row):
            # Each ray has its own row, so no addition is lost.
            out[row] += rays.step()
            going = rays.s < rays.end
            # To drop rays copies all that is kept of the others, so it waits until a fifth is done.
            if np.count_nonzero(going) < 0.8 * len(row):
                rays.keep(going)
                row = row[going]
    out[out >= 0.5 * FAR] = np.inf


class _MarchingRays:
    """Rays in progress, each in a square of 2^l x 2^l cells; every step advances all of them."""

    def __init__(
        self, start: Array, way: Array, s: Array, end: Array, edges: tuple[Array, Array],
        corners: Array, bounds: Bounds, walls: bool,
    ) -> None:  # fmt: skip
        self.start, self.way, self.s, self.end = start, way, s, end
        self.edges, self.corners, self.bounds = edges, corners, bounds
        self.top = len(bounds.offset) - 1
        self.level = np.zeros(len(s), np.int32)
        place = start[:2] + s * way[:2]
        # The outermost edges are infinite; the number of inner ones before a place is its cell.
        inner = [np.searchsorted(edges[a][1:-1], place[a], side="right") for a in (0, 1)]
        self.cell = np.stack(inner).astype(np.int32)
        #: Whether rays run in a plane of nodes, and so beside two cells, one of them perhaps empty.
        at = np.stack([edges[a][self.cell[a]] for a in (0, 1)])
        self.beside = walls & (way[:2] == 0) & (start[:2] == at)

    def keep(self, going: Bools) -> None:
        """Drop the rays that have reached their end."""
        for name in ("start", "way", "cell", "s", "end", "level", "beside"):
            setattr(self, name, getattr(self, name)[..., going])

    def step(self) -> Array:
        """Move each ray through its square or into a quarter of it; return the length inside."""
        (x, y), (i, j), level, s = self.way[:2], self.cell, self.level, self.s
        cross_x, cross_y = self._cross(0), self._cross(1)
        by_x = cross_x <= cross_y
        # Never backwards: rounding may put an edge just behind the ray that has crossed it.
        leave = np.minimum(np.maximum(np.where(by_x, cross_x, cross_y), s), self.end)
        z0 = self.start[2] + s * self.way[2]
        z1 = self.start[2] + leave * self.way[2]
        square = self._own_cell()
        at = self.bounds.offset[level] + square[1] * self.bounds.columns[level] + square[0]
        # A ray is straight, so that its heights at both ends of the way are its bounds.
        below = np.maximum(z0, z1) <= self.bounds.least[at]
        clear = below | (np.minimum(z0, z1) >= self.bounds.largest[at])
        inside = np.where(below, leave - s, 0.0)
        # A single cell that the ray is neither above nor below: its surface itself is looked at.
        leaf = np.flatnonzero(~clear & (level == 0))
        inside[leaf] = self._in_cell(leaf, square[:, leaf], leave[leaf])

        descend = ~clear & (level > 0)
        onward = ~descend & (leave < self.end)
        # Rays move on into the next square of their level ...
        i += np.where(by_x & onward, np.where(x >= 0, 1, -1), 0).astype(np.int32)
        j += np.where(onward & ~by_x, np.where(y >= 0, 1, -1), 0).astype(np.int32)
        np.copyto(s, leave, where=~descend)
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
        cells: Indices = self.cell.astype(np.intp)
        rows = np.flatnonzero(self.beside.any(axis=0))
        # Up to four cells meet at a vertical ray through a node; they are tried until one has a
        # solid.
        for back in ((0, 0), (1, 0), (0, 1), (1, 1)):
            i, j = cells[:, rows]
            empty = np.isneginf(self.bounds.largest[j * self.bounds.columns[0] + i])
            allowed = np.all(np.array(back, np.bool_) <= self.beside[:, rows].T, axis=1)
            other = rows[empty & allowed]
            cells[:, other] = self.cell[:, other] - np.array(back)[:, np.newaxis]
        return cells

    def _cross(self, axis: int) -> Array:
        """Return the distances at which rays leave their square along an axis."""
        way, edges = self.way[axis], self.edges[axis]
        # The number of an edge of a wide square, in cells; the last square may reach past the
        # field.
        out = np.minimum((self.cell[axis] + (way >= 0)) << self.level, len(edges) - 1)
        return np.where(way == 0, np.inf, (edges[out] - self.start[axis]) / way)

    def _descend(self, which: Indices) -> None:
        level = self.level[which] - 1
        for axis in (0, 1):
            edges = self.edges[axis]
            place = self.start[axis, which] + self.s[which] * self.way[axis, which]
            left = self.cell[axis, which] << 1
            # Where a square reaches past the field its middle may be infinite: the first half has
            # the ray.
            middle = edges[np.minimum((left + 1) << level, len(edges) - 1)]
            self.cell[axis, which] = left + (place >= middle)
        self.level[which] = level

    def _in_cell(self, which: Indices, square: Indices, leave: Array) -> Array:
        """Return the length below the bilinear surface of one cell, where f = h - z > 0."""
        (i, j), s, corners = square, self.s[which], self.corners
        z00, z10 = corners[j, i], corners[j + 1, i]
        (u, du), (v, dv) = (self._share(axis, square[axis], which, s) for axis in (0, 1))
        # h = z00 + u a + v b + u v c, where u and v are linear in the distance along the ray.
        a, b = corners[j, i + 1] - z00, z10 - z00
        c = (corners[j + 1, i + 1] - z10) - a
        z = self.start[2, which] + s * self.way[2, which]
        # With s from the place where the ray enters the cell, h - z is f0 + f1 s + f2 s^2.
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
    # Both roots without cancellation; where f2 is 0 one of them is infinite. The sum makes -0 to 0.
    q = -0.5 * (f1 + np.copysign(np.sqrt(np.maximum(square, 0)), f1))
    first, second = (np.minimum(np.maximum(root, 0), end) for root in (f0 / q, q / (f2 + 0.0)))
    between = np.abs(first - second)
    # A parabola that opens upward is positive outside its roots, any other between them.
    length = np.where(f2 >= 0, end - between, between)
    # Without a root, or for a constant f, the sign is the same everywhere.
    whole = (square < 0) | (q == 0)
    return np.where(whole, np.where(np.maximum(f0, f0 + f2) > 0, end, 0.0), length)


@_compiled.kernel(inline=True)
def positive(f0: float, f1: float, f2: float, end: float) -> float:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0."""
    square = f1 * f1 - 4 * f0 * f2
    # Both terms have one sign, so that no digits cancel; the roots are f0 / q and q / f2.
    q = -0.5 * (f1 + math.copysign(math.sqrt(max(square, 0.0)), f1))
    if (square < 0) | (q == 0):
        return end if max(f0, f0 + f2) > 0 else 0.0
    first, second = min(max(f0 / q, 0.0), end), min(max(q / (f2 + 0.0), 0.0), end)
    between = abs(first - second)
    return end - between if f2 >= 0 else between


@_compiled.kernel(inline=True)
def locate(edges: Array, place: float) -> int:
    """Return the index of the interval of rising edges, the first and last unbounded."""
    low, high = 0, len(edges) - 1
    while high - low > 1:
        middle = (low + high) >> 1
        if edges[middle] <= place:
            low = middle
        else:
            high = middle
    return low


@_compiled.kernel(inline=True)
def relative(edges: Array, cell: int, place: float, way: float) -> tuple[float, float]:
    """Return a relative position in a cell and its rate of change; 0 in an unbounded cell."""
    width = edges[cell + 1] - edges[cell]
    return ((place - edges[cell]) / width, way / width) if width < math.inf else (0.0, 0.0)


@_compiled.kernel(inline=True)
def crossing(edges: Array, cell: int, level: int, start: float, way: float) -> float:
    """Return the distance at which a ray leaves its square along one axis."""
    if way == 0:
        return math.inf
    out = min((cell + (1 if way > 0 else 0)) << level, len(edges) - 1)
    distance: float = (edges[out] - start) / way
    return distance


@_compiled.kernel(inline=True)
def child(edges: Array, cell: int, level: int, place: float) -> int:
    """Return the half of a square, along one axis, that contains a position."""
    left = cell << 1
    return left + (1 if place >= edges[min((left + 1) << level, len(edges) - 1)] else 0)


@_compiled.kernel(inline=True)
def beside(largest: Array, at: int, before_x: int, before_y: int) -> tuple[int, int]:
    """Return steps back to a cell that is not empty, of those at both sides of a ray's planes."""
    if largest[at] > -math.inf or before_x + before_y == 0:
        return 0, 0
    if before_x > 0 and largest[at - 1] > -math.inf:
        return 1, 0
    if before_y > 0 and largest[at - before_y] > -math.inf:
        return 0, 1
    # Of the four cells at a vertical ray through a node the one across is left.
    return (1, 1) if before_x > 0 and before_y > 0 else (0, 0)


@_compiled.kernel()
def walk(
    start: Array, way: Array, reach: Array, x: Array, y: Array, corners: Array, bounds: Bounds,
    walls: bool, out: Array,
) -> None:  # fmt: skip
    """Write the lengths of rays inside the solid, as :func:`march` does."""
    largest, least, offset, columns = bounds
    top = largest[-1]
    for ray in range(len(out)):
        px, py, pz = start[0, ray], start[1, ray], start[2, ray]
        wx, wy, wz = way[0, ray], way[1, ray], way[2, ray]
        # Above the highest node there is nothing to meet.
        place = (top - pz) / wz if wz != 0 else 0.0
        s, end = max(place, 0.0) if wz < 0 else 0.0, reach[ray]
        # A level ray above all nodes ends at 0, so that nothing is walked.
        if wz > 0 or (wz == 0 and pz >= top):
            end = min(end, place)
        # A ray begins in its own cell and climbs to larger squares as it goes.
        i, j, level, length = locate(x, px + s * wx), locate(y, py + s * wy), 0, 0.0
        # Steps back to the cell before a plane of nodes, in the flat array of level 0: 1 along x,
        # and a whole row along y.
        before_x = 1 if walls and wx == 0 and px == x[i] else 0
        before_y = columns[0] if walls and wy == 0 and py == y[j] else 0
        # A ray in a plane of nodes goes from cell to cell.
        highest = len(offset) - 1 if before_x + before_y == 0 else 0
        while s < end:
            # The nearer of the two edges of the square is where the ray leaves it.
            cross_x, cross_y = crossing(x, i, level, px, wx), crossing(y, j, level, py, wy)
            # Never backwards: rounding may put an edge just behind the ray that has crossed it.
            leave = min(max(min(cross_x, cross_y), s), end)
            z, last = pz + s * wz, pz + leave * wz
            at = offset[level] + j * columns[level] + i
            back_x, back_y = beside(largest, at, before_x, before_y)
            at -= back_x + back_y * columns[0]
            # Wholly below the square: all of the way is inside, without a look at its cells.
            if max(z, last) <= least[at]:
                length += leave - s
            # Neither below nor above: into the quarter that contains the ray, down to a single
            # cell.
            elif min(z, last) < largest[at]:
                if level > 0:
                    level -= 1
                    i = child(x, i, level, px + s * wx)
                    j = child(y, j, level, py + s * wy)
                    continue
                # The crossing with the bilinear surface of a single cell, as for many rays at once.
                column, row = i - back_x, j - back_y
                u, du = relative(x, column, px + s * wx, wx)
                v, dv = relative(y, row, py + s * wy, wy)
                z00, z10 = corners[row, column], corners[row + 1, column]
                a, b = corners[row, column + 1] - z00, z10 - z00
                c = (corners[row + 1, column + 1] - z10) - a
                f0 = (z00 - z) + u * a + v * (b + u * c)
                f1 = du * (a + v * c) + dv * (b + u * c) - wz
                length += positive(f0, f1, du * dv * c, leave - s)
            if leave >= end:
                break
            s = leave
            # On into the next square, or one twice as wide if both begin at the same place.
            if cross_x <= cross_y:
                i += 1 if wx > 0 else -1
                # A ray that goes forward enters a pair of squares at its even number, another at
                # its odd one.
                rise = (i ^ int(wx < 0)) & 1 == 0
            else:
                j += 1 if wy > 0 else -1
                rise = (j ^ int(wy < 0)) & 1 == 0
            if rise and level < highest:
                i, j, level = i >> 1, j >> 1, level + 1
        # A way that has grown to FAR has never left the solid.
        out[ray] = length if length < 0.5 * FAR else math.inf


#: Number of rays in a block, whose arrays fit the cache.
BLOCK = 1 << 14
#: Depths below this share of the field's size use the limit for depth 0, since rounding dominates.
LEAST_DEPTH = 1e-9
#: Components of a direction below this share of the largest are taken for 0.
ROUNDING = 4 * np.finfo(np.float64).eps


def inside_length(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    points: ArrayLike,
    /,
    *,
    direction: VectorLike | None = None,
    position: VectorLike | None = None,
    border: Border = "extend",
) -> Array:
    """Return the length inside a height field of segments from points to a light.

    Parameters
    ----------
    x, y : array_like, shapes (nx,), (ny,)
        Nodes, rising and at any spacing, in the unit of the mesh.
    z : array_like, shape (ny, nx)
        Heights in the same unit, bilinear between the nodes; NaN in holes.
    points : array_like, shape (..., 3)
        Starts of the segments, inside or outside the solid.
    direction : vector of 3 components, optional
        Direction toward a light at infinity, of any length but 0.
    position : vector of 3 components, optional
        Position of a light outside the solid. Exactly one of direction and position is required.
    border : {"extend", "wall"}
        Shape of the solid beyond the outermost nodes. "extend": the heights of the border continue
        without end, and a hole has the height of the nearest node by index. "wall": the solid ends
        in vertical walls, and likewise at each cell that lacks a corner. Walls are part of the
        solid: a ray that runs in the plane of one is inside below the wall's upper edge.

    Returns
    -------
    ndarray, shape (...)
        Lengths in the unit of the mesh, float64; infinity where a ray never leaves the solid; NaN
        for a point that is not finite, or farther than 1e100 from the origin.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If a shape is wrong, a field has only one row or no height at all, the light is inside the
        solid, or both or neither of direction and position are given.

    Notes
    -----
    The surface is bilinear, not triangulated. It has no diagonals to choose, so a mirrored field
    has the mirrored shadow. Along a ray its height is a quadratic in each cell, with roots in
    closed form. The error is at most ``3 eps`` times the size of the field for each time that a ray
    crosses the surface without grazing it, where slopes are up to 100; in steeper ground it grows
    with the slope, to 1e-11 of the size in cells of a millionth. The cost is O(log N) squares for
    each time that a ray crosses the surface: the study ``relief`` prints its time. Source:
    cos-theta, section 2.

    Examples
    --------
    >>> flat, below = [[0, 0], [0, 0]], (0.5, 0.5, -1)
    >>> round(float(inside_length([0, 1], [0, 1], flat, below, direction=(0, 3, 4))), 12)
    1.25
    """
    field = height_field.make(x, y, z, border=border)
    starts = _check.vectors("points", points, n=3)
    # Relative to the field's first node and lowest height: digits of far places are not lost.
    flat = starts.reshape(-1, 3).astype(np.float64) - field.origin
    # Such rays are followed from 0 and get NaN at the end.
    odd = ~np.all(np.abs(flat) <= _check.FARTHEST, axis=1)
    flat[odd] = 0
    ways = toward(field, direction, position)
    length = _lengths(field, lambda rows: flat[rows].T, len(flat), ways)
    length[odd] = np.nan
    return length.reshape(starts.shape[:-1])


def shadow(
    x: ArrayLike,
    y: ArrayLike,
    z: ArrayLike,
    /,
    *,
    depth: float,
    direction: VectorLike | None = None,
    position: VectorLike | None = None,
    normals: ArrayLike | None = None,
    border: Border = "extend",
) -> Array:
    """Return the cos-theta shadow of a height field at its nodes.

    Parameters
    ----------
    x, y, z, direction, position, border
        As for :func:`inside_length`.
    depth : float
        Depth d below the surface at which the light is collected, 0 or more, in the unit of the
        mesh. Larger depths give softer shadows and ridges.
    normals : array_like, shape (ny, nx, 3), optional
        Unit normals at the nodes. Default: the normals of the field.

    Returns
    -------
    ndarray, shape (ny, nx)
        ``t = d / r`` clamped to [0, 1], where r is the length inside the solid of the segment from
        ``p' = p - d n`` to the light; it is 1 where r is less than d. It is 0 at NaN heights, and
        where a normal is zero or not finite.

    Raises
    ------
    TypeError, ValueError
        As :func:`inside_length`; also if the depth is negative or more than 1e9 times the size of
        the field.

    Notes
    -----
    Within the four cells around a node the solid is the space below the plane through the node
    across its normal; elsewhere, and where p' is outside of these cells, it is the field. So t is
    the cosine of the angle between n and the direction from p' to the light where the ray leaves
    that plane within the cells and meets nothing behind them, and on a plane for every d. The
    error there is at most ``(8 + S/d) eps``, where S is the size of the field, and 8 eps at depth
    0. As d goes to 0, t goes to the clamped cosine where nothing behind the four cells occludes
    the light and to 0 elsewhere; depth 0 gives this limit. The source prints ``t = r/d`` once; the
    correct ratio is d/r. Source: cos-theta, sections 2 and 3.
    """
    field = height_field.make(x, y, z, border=border)
    depth = _check.number("depth", depth, low=0.0)
    # By the heights as given: the field itself may have filled its holes.
    dark = np.isnan(np.asarray(z, dtype=np.float64))
    if normals is None:
        normal = height_field.normals(field)
    else:
        normal = _check.vectors("normals", normals, n=3).astype(np.float64)
        if normal.shape != (*field.heights.shape, 3):
            raise _check.value_error("normals", f"shape {(*field.heights.shape, 3)}", normal)
        dark |= ~(np.any(normal, axis=-1) & np.all(np.isfinite(normal), axis=-1))
        normal[dark] = 0
    t = ratio(field, normal, depth, direction=direction, position=position)
    t[dark] = 0
    return t


def toward(
    field: Field, direction: VectorLike | None, position: VectorLike | None
) -> Callable[[Array, Array | float], tuple[Array, Array]]:
    """Return a function from starts (3, N) to the unit directions (3, N) and lengths (N,) of rays.

    Starts are relative to the field's origin. A second argument is the length of a unit of x at
    each start, which directions and lengths heed. A lamp must not be inside the solid.
    """
    if (direction is None) == (position is None):
        got = "neither" if direction is None else "both"
        raise _check.value_error("direction, position", "one of them", got)
    name = "direction" if position is None else "position"
    value = direction if position is None else position
    vector = _check.vector(name, value, direction=position is None, n=3)
    if position is None:
        # The largest component becomes 1 first, since squares of huge ones would leave float64.
        way = np.array(vector) / max(abs(c) for c in vector)
        # The sine of 180 degrees is not 0 in a computer; a ray in a plane of nodes stays there.
        way[np.abs(way) < ROUNDING] = 0
        way /= np.linalg.norm(way)
        return lambda start, _: (
            np.repeat(way[:, np.newaxis], start.shape[1], axis=1),
            np.full(start.shape[1], FAR),
        )
    lamp = np.array(vector) - field.origin
    # The length inside the solid of a ray straight up is the depth of the lamp below the surface.
    above, inside = np.array([[0.0], [0.0], [1.0]]), np.empty(1)
    _follow(field, lamp[:, np.newaxis], above, np.array([FAR]), inside)
    # A lamp may stand on the ground; 1e-9 of the size is rounding.
    if inside[0] > 1e-9 * field.size:
        height = lamp[2] + inside[0] + field.origin[2]
        expected = f"a light outside the solid, above {height:.9g} there"
        raise _check.value_error("position", expected, vector, "raise the light")

    def to_lamp(start: Array, stretch: Array | float) -> tuple[Array, Array]:
        way = lamp[:, np.newaxis] - start
        way[0] *= stretch
        size = kernels.length(way)
        # A start at the lamp has no direction, and a ray of length 0.
        unit = way / np.where(size > 0, size, 1)
        unit[np.abs(unit) < ROUNDING] = 0
        return unit, np.minimum(size, FAR)

    return to_lamp


def ratio(
    field: Field,
    normal: Array,
    depth: float,
    *,
    direction: VectorLike | None = None,
    position: VectorLike | None = None,
    report: Callable[[int], None] = lambda _: None,
) -> Array:
    """Return :func:`shadow` for a validated field and its normals.

    Each ray is straight in the frame of its own node, with x as long everywhere as in its row.
    ``report`` takes the number of rays that are done.
    """
    if depth * LEAST_DEPTH > field.size:
        expected = f"at most {field.size / LEAST_DEPTH:g}, 1e9 times the size of the field"
        raise _check.value_error("depth", expected, depth)
    ways = toward(field, direction, position)
    # At depth 0 t is a limit: the cosine where the ray leaves at once, else 0.
    limit = depth <= LEAST_DEPTH * field.size
    shape, normals, heights = field.heights.shape, normal.reshape(-1, 3), field.heights.ravel()

    # The length r, inside the solid, from which t is made below.
    t = np.empty(len(heights))
    around = _Around(field)
    # Decided once for the rays of all blocks, which are then all followed in one way.
    fast = walk.pays(SAVED * len(t))
    least = 1e-6 * min(np.diff(field.x).min(), np.diff(field.y).min())

    def work(rows: Slice) -> int:
        numbers = np.arange(rows.start, rows.stop)
        row, column = np.divmod(numbers, shape[1])
        stretch = field.stretch[row]
        start = np.stack([field.x[column], field.y[row], heights[rows]])
        # The source's p' is a depth below the node along its normal; for the limit it is the node.
        if not limit:
            below = depth * normals[rows].T
            below[0] /= stretch
            start -= below
        way, reach = ways(start, stretch)
        cosine = np.einsum("ij,ji->i", normals[rows], way)
        # From here on per unit of length, in the coordinates of the grid.
        way[0] /= stretch
        leave = np.minimum(around.leave(row, column, start, way), reach)
        # What is vertical never leaves the cells, and meets nothing behind them.
        _follow(field, start + np.where(leave < FAR, leave, 0.0) * way, way,
                reach - leave, t[rows], fast=fast)  # fmt: skip
        if limit:
            # A ray that grazes a cell by rounding has not been occluded.
            t[rows] = np.where(t[rows] <= least, np.clip(cosine, 0, 1), 0)
            return int(rows.stop)
        with np.errstate(divide="ignore"):
            plane = np.where(cosine > 0, depth / cosine, np.inf)
        inside = t[rows] + np.minimum(leave, plane)
        inside[inside >= 0.5 * FAR] = np.inf
        # r of less than d counts as d.
        t[rows] = depth / np.maximum(inside, depth)
        return int(rows.stop)

    for done in _pool.run(work, _pool.blocks(len(t), BLOCK)):
        report(done)
    return t.reshape(shape)


class _Around:
    """The four cells around each node of a field."""

    def __init__(self, field: Field) -> None:
        # Beyond the border a cell is as wide as the last one.
        self.x, self.y = (
            np.concatenate([[2 * axis[0] - axis[1]], axis, [2 * axis[-1] - axis[-2]]])
            for axis in (field.x, field.y)
        )
        count = (len(field.y) + 1) * (len(field.x) + 1)
        empty = np.isneginf(field.bounds.largest[:count]).reshape(len(field.y) + 1, -1)
        some = empty[:-1, :-1] | empty[:-1, 1:] | empty[1:, :-1] | empty[1:, 1:]
        #: Whether all four have a surface: no wall stands beside the node.
        self.whole: Bools = ~some

    def leave(self, row: Indices, column: Indices, start: Array, way: Array) -> Array:
        """Return distances at which rays leave these cells, 0 for those that start outside."""
        distance = np.full(len(row), np.inf)
        inside = self.whole[row, column]
        axes = (self.x, column, start[0], way[0]), (self.y, row, start[1], way[1])
        for nodes, at, place, step in axes:
            low, high = nodes[at], nodes[at + 2]
            inside &= (low <= place) & (place <= high)
            with np.errstate(divide="ignore", invalid="ignore"):
                out = (np.where(step > 0, high, low) - place) / step
            distance = np.minimum(distance, np.where(step == 0, np.inf, out))
        return np.where(inside, np.maximum(distance, 0.0), 0.0)


def _lengths(
    field: Field,
    start: Callable[[Slice], Array],
    count: int,
    ways: Callable[[Array, float], tuple[Array, Array]],
) -> Array:
    """Return the lengths inside the solid of rays; a function of rows gives their starts (3, N)."""
    length = np.empty(count)
    # Decided once for the rays of all blocks, which are then all followed in one way.
    fast = walk.pays(SAVED * count)

    def work(rows: Slice) -> int:
        places = start(rows)
        # A slice of an array is a view of it: the block writes into the result.
        _follow(field, places, *ways(places, 1.0), length[rows], fast=fast)
        return int(rows.stop)

    for _ in _pool.run(work, _pool.blocks(count, BLOCK)):
        pass
    return length


def _follow(
    field: Field, start: Array, way: Array, reach: Array, out: Array, *, fast: bool = False
) -> None:
    """Write the lengths inside the solid of rays, by compiled code where it is fast and works."""
    walls = field.border == "wall"
    rays = np.ascontiguousarray(start), np.ascontiguousarray(way), reach
    if fast:
        # Where compiling fails NumPy finds the lengths, only later.
        with contextlib.suppress(_compiled.FailedError):
            walk(*rays, *field.edges, field.corners, field.bounds, walls, out)
            return
    march(*rays, *field.edges, field.corners, field.bounds, walls, out)
