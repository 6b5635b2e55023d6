"""Depth maps: the heights of triangles seen from above by an eye at infinity, for a bas-relief."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Bools, Indices

__all__ = ["depth_map"]

#: Number of pairs of a triangle and a node that are tested together.
BLOCK = 1 << 20


def depth_map(
    x: ArrayLike,
    y: ArrayLike,
    points: ArrayLike,
    triangles: ArrayLike,
    /,
    *,
    progress: Callable[[int, int], None] | None = None,
) -> Array:
    """Return the largest z of triangles above the nodes of a grid.

    Parameters
    ----------
    x, y : array_like, shapes (nx,), (ny,)
        Nodes, evenly spaced and rising.
    points : array_like, shape (N, 3)
        Vertices of the triangles.
    triangles : array_like of int, shape (T, 3)
        Indices of the vertices of each triangle.
    progress : callable, optional
        Function that is called as ``progress(pairs done, pairs)`` after each block of pairs of a
        triangle and a node.

    Returns
    -------
    ndarray, shape (ny, nx)
        Heights; NaN where no triangle covers the node.

    Raises
    ------
    TypeError, ValueError
        If an argument is invalid.

    Notes
    -----
    A node on an edge belongs to both triangles. The error is at most ``4 eps (|z| + D L S / A)``,
    where D is the height difference of a triangle, L its longest edge and A twice its area, both in
    projection, and S is the size of the grid. Steep triangles and slivers lose digits.
    """
    axes = [_check.floats(name, a).astype(np.float64) for name, a in (("x", x), ("y", y))]
    for name, axis in zip("xy", axes, strict=True):
        step = np.diff(axis) if axis.ndim == 1 else np.zeros(1)
        if axis.ndim != 1 or len(axis) < 2 or not np.allclose(step, step[0]) or step[0] <= 0:
            raise _check.value_error(name, "rising nodes of equal spacing", axis)
    _check.function("progress", progress, optional=True)
    vertices = _check.vectors("points", points, n=3).astype(np.float64)
    # A triangle with a vertex that is not finite, or too far for float64, covers no node.
    vertices[~np.all(np.abs(vertices) < _check.FARTHEST, axis=-1)] = np.nan
    faces = _check.cells("triangles", triangles, len(vertices), (3,))
    # Positions are in units of the grid's spacing, from its first node.
    first = np.array([axis[0] for axis in axes])
    step = np.array([axis[1] - axis[0] for axis in axes])
    places = (vertices[:, :2] - first) / step
    shape = (len(axes[1]), len(axes[0]))
    height = np.full(shape[0] * shape[1], -np.inf)

    corners = places[faces]
    # A node on the border of the box is tested, whatever rounding does to its place.
    low = np.maximum(np.ceil(corners.min(axis=1) - 1e-9), 0)
    high = np.minimum(np.floor(corners.max(axis=1) + 1e-9), [shape[1] - 1, shape[0] - 1])
    # NaN, of a vertex without a place, and a box between two nodes make 0 nodes.
    size = np.nan_to_num(high - low + 1).clip(min=0).astype(np.intp)
    count = size[:, 0] * size[:, 1]
    over = np.flatnonzero(count)
    total = np.cumsum(count[over])
    begin = 0
    while begin < len(over):
        done = total[begin - 1] if begin else 0
        # A triangle that covers more nodes than a block has pairs is a block of its own.
        end = max(int(np.searchsorted(total, done + BLOCK, side="right")), begin + 1)
        some = over[begin:end]
        # All nodes in the bounding box of each triangle.
        which = np.repeat(some, count[some])
        place = np.arange(len(which)) - np.repeat(np.cumsum(count[some]) - count[some], count[some])
        node = low[which].astype(np.intp)
        node[:, 0] += place % size[which, 0]
        node[:, 1] += place // size[which, 0]
        inside, z = _over(corners[which], vertices[:, 2][faces[which]], node)
        flat = node[inside, 1] * shape[1] + node[inside, 0]
        # The eye above sees the highest of all triangles; several of a block may lie over one node.
        np.maximum.at(height, flat, z)
        begin = end
        if progress is not None:
            progress(int(total[end - 1]), int(total[-1]))
    height[np.isneginf(height)] = np.nan
    return height.reshape(shape)


def _over(corners: Array, z: Array, node: Indices) -> tuple[Bools, Array]:
    """Return a mask of the nodes inside their triangles, and the triangles' heights at them."""
    a, b, c = (corners[:, k] - node for k in range(3))
    # Twice the areas between the node and each side: barycentric weights before the division.
    weights = np.stack([_cross(b, c), _cross(c, a), _cross(a, b)], axis=1)
    area = weights.sum(axis=1)
    # Triangles are seen however they are wound.
    weights *= np.sign(area)[:, np.newaxis]
    area = np.abs(area)
    # A tolerance for rounding: else a node on a common edge could be in neither triangle.
    inside = (area > 0) & np.all(weights >= -1e-9 * area[:, np.newaxis], axis=1)
    height = np.einsum("ij,ij->i", weights[inside], z[inside]) / area[inside]
    return inside, height


def _cross(a: Array, b: Array) -> Array:
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
