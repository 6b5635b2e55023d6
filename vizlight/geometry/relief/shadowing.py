"""Cos-theta shadows on height fields, from the length of light rays inside the solid."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check, _compiled, _pool
from vizlight.geometry.relief import height_field, walks
from vizlight.model import kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, Indices, Slice, VectorLike
    from vizlight.geometry.relief.height_field import Border, Field


__all__ = ["inside_length", "shadow"]

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
    crosses the surface without grazing it. The cost is O(log N) squares for each time that a ray
    crosses the surface: the study ``relief`` prints its time. Source: cos-theta, section 2.

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
            expected = f"shape {(*field.heights.shape, 3)}"
            raise ValueError(_check.message("normals", expected, normal))
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
        raise ValueError(_check.message("direction, position", "one of them", got))
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
            np.full(start.shape[1], walks.FAR),
        )
    lamp = np.array(vector) - field.origin
    # The length inside the solid of a ray straight up is the depth of the lamp below the surface.
    above, inside = np.array([[0.0], [0.0], [1.0]]), np.empty(1)
    _follow(field, lamp[:, np.newaxis], above, np.array([walks.FAR]), inside)
    # A lamp may stand on the ground; 1e-9 of the size is rounding.
    if inside[0] > 1e-9 * field.size:
        height = lamp[2] + inside[0] + field.origin[2]
        expected = f"a light outside the solid, above {height:.9g} there"
        raise ValueError(_check.message("position", expected, vector, "raise the light"))

    def to_lamp(start: Array, stretch: Array | float) -> tuple[Array, Array]:
        way = lamp[:, np.newaxis] - start
        way[0] *= stretch
        size = kernels.length(way)
        # A start at the lamp has no direction, and a ray of length 0.
        unit = way / np.where(size > 0, size, 1)
        unit[np.abs(unit) < ROUNDING] = 0
        return unit, np.minimum(size, walks.FAR)

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
        raise ValueError(_check.message("depth", expected, depth))
    ways = toward(field, direction, position)
    # At depth 0 t is a limit: the cosine where the ray leaves at once, else 0.
    limit = depth <= LEAST_DEPTH * field.size
    shape, normals, heights = field.heights.shape, normal.reshape(-1, 3), field.heights.ravel()

    # The length r, inside the solid, from which t is made below.
    t = np.empty(len(heights))
    around = _Around(field)
    # Decided once for the rays of all blocks, which are then all followed in one way.
    fast = walks.walk.pays(walks.SAVED * len(t))
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
        _follow(field, start + np.where(leave < walks.FAR, leave, 0.0) * way, way,
                reach - leave, t[rows], fast=fast)  # fmt: skip
        if limit:
            # A ray that grazes a cell by rounding has not been occluded.
            t[rows] = np.where(t[rows] <= least, np.clip(cosine, 0, 1), 0)
            return int(rows.stop)
        with np.errstate(divide="ignore"):
            plane = np.where(cosine > 0, depth / cosine, np.inf)
        inside = t[rows] + np.minimum(leave, plane)
        inside[inside >= 0.5 * walks.FAR] = np.inf
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
    fast = walks.walk.pays(walks.SAVED * count)

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
            walks.walk(*rays, *field.edges, field.corners, field.bounds, walls, out)
            return
    walks.march(*rays, *field.edges, field.corners, field.bounds, walls, out)
