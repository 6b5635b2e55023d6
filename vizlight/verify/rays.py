"""t of cos-theta shadows along single rays, without the search structures of the engine."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from vizlight._types import Array, Indices, VectorLike


def relief_ratio(
    x: Array, y: Array, z: Array, place: Array, normal: Array, depth: float, *,
    way: VectorLike | None, end: VectorLike | None = None, wall: bool = False,
) -> float:  # fmt: skip
    """Return t of a node of a height field, its ray cut at every plane of nodes.

    Within the four cells around the node, where all of them have a surface and contain the ray's
    start, the solid is the space below the plane through the node. Elsewhere, between two cuts, the
    height of the surface above the ray is a quadratic, known from three places. The ray starts at a
    ``depth`` above 0 below the point, along ``way``, above the horizon, or to the position ``end``
    of the light; with ``wall`` the solid ends at the border of the field, otherwise it goes on
    beyond it. The ratio is exact to rounding where the ray does not graze the surface.
    """
    start = place - depth * normal
    toward = np.asarray(way if end is None else end, dtype=np.float64)
    along = toward - (start if end is not None else 0)
    # A sine or a cosine of a right angle is not 0 in a computer.
    along[np.abs(along) < 4 * np.finfo(float).eps * np.abs(along).max()] = 0
    near, flat = _beside(x, y, z, place, normal, start, along, endless=end is None, wall=wall)
    highest = max(float(np.nanmax(z) - start[2]), 0.0)
    if end is None or along[2] > highest:
        # No solid is above the highest node.
        cut = highest / along[2]
        along, near = along * cut, near / cut if cut else math.inf
    bounds = ((x, start[0], along[0]), (y, start[1], along[1]))
    # Shares of the ray at which it crosses a plane of nodes.
    cuts = [(np.asarray(at) - first) / step for at, first, step in bounds if step]
    shares = np.concatenate([[0.0, 1.0, near], *cuts])
    ends = np.unique(shares[(shares >= 0) & (shares <= 1)])
    low, high = ends[:-1], ends[1:]
    three = start + np.stack([low, (low + high) / 2, high])[..., np.newaxis] * along
    middle = three[1]
    f = np.full(low.shape, -np.inf)
    parts: Array = np.full((3, len(low)), -np.inf)
    # In a plane of nodes the cell at either side may be the one that has a surface.
    for back in ((0, 0), (1, 0), (0, 1), (1, 1)):
        cells = [
            np.clip(
                np.searchsorted(nodes, middle[:, axis], "right") - 1 - back[axis], 0, len(nodes) - 2
            )
            for axis, nodes in enumerate((x, y))
        ]
        above = _above(x, y, z, three, *cells, wall=wall)
        better = np.isfinite(above).all(axis=0) & ~np.isfinite(f)
        parts[:, better], f[better] = above[:, better], 0.0
    # Where no cell has a surface the ray is outside of the solid.
    share = _positive(*np.where(np.isfinite(f), parts, -1.0))
    # The part within the four cells is below the plane instead.
    share[high <= near] = 0
    inside = float(share @ (high - low)) * math.hypot(*along) + flat
    # t = d / r, and 1 where r is less than d (cos-theta, section 3).
    return float(depth / max(inside, depth))


def _beside(
    x: Array, y: Array, z: Array, place: Array, normal: Array, start: Array, along: Array, *,
    endless: bool, wall: bool,
) -> tuple[float, float]:  # fmt: skip
    """Return the place where a ray leaves the four cells around its node, as a share of it.

    Second comes the length below the node's plane before that place.
    """
    share = math.inf
    spans = []
    for nodes, at, first, step in zip((x, y), place, start, along, strict=False):
        k = int(np.argmin(np.abs(nodes - at)))
        last = len(nodes) - 1
        if wall and k in (0, last):
            return 0.0, 0.0
        spans.append(slice(max(k - 1, 0), k + 2))
        # Beyond the border a cell is as wide as the last one.
        low = nodes[k - 1] if k > 0 else 2 * nodes[0] - nodes[1]
        high = nodes[k + 1] if k < last else 2 * nodes[last] - nodes[last - 1]
        if not low <= first <= high:
            return 0.0, 0.0
        if step:
            share = min(share, ((high if step > 0 else low) - first) / step)
    if not np.isfinite(z[spans[1], spans[0]]).all():
        return 0.0, 0.0
    share = max(min(share, math.inf if endless else 1.0), 0.0)
    rise, gap = float(normal @ along), float(normal @ (place - start))
    # At the plane normal . (start + s along - place) is 0.
    below = min(share, gap / rise) if rise > 0 else share
    return share, below * math.hypot(*along)


def _above(
    x: Array, y: Array, z: Array, places: Array, i: Indices, j: Indices, *, wall: bool
) -> Array:
    """Return the height of the surface of some cells above places of shape (3, M, 3)."""
    across, up = places[..., 0], places[..., 1]
    # Without a wall the heights of the border go on beyond it.
    if not wall:
        across, up = np.clip(across, x[0], x[-1]), np.clip(up, y[0], y[-1])
    u, v = (across - x[i]) / (x[i + 1] - x[i]), (up - y[j]) / (y[j + 1] - y[j])
    low = (1 - u) * z[j, i] + u * z[j, i + 1]
    high = (1 - u) * z[j + 1, i] + u * z[j + 1, i + 1]
    # The middle of a part of the ray is within a cell; its ends may be on a border, beside it by
    # rounding.
    within = (np.abs(u[1] - 0.5) <= 0.5) & (np.abs(v[1] - 0.5) <= 0.5)
    return np.asarray(np.where(within, (1 - v) * low + v * high - places[..., 2], np.nan))


def _positive(first: Array, middle: Array, last: Array) -> Array:
    """Return the share of [0, 1] where the quadratics through three places are positive."""
    # The quadratic is first + b s + a s^2, through the values at s = 0, 1/2 and 1.
    a, b = 2 * (first - 2 * middle + last), 4 * middle - 3 * first - last
    # q / a and first / q are both roots, without the difference in which digits cancel.
    q = -0.5 * (b + np.copysign(np.sqrt(np.maximum(b * b - 4 * a * first, 0)), b))
    with np.errstate(all="ignore"):
        roots = np.clip(np.nan_to_num(np.stack([q / a, first / q]), nan=0.0), 0, 1)
    roots[:, b * b < 4 * a * first] = 0
    ends = np.sort(np.concatenate([np.zeros((1, len(b))), roots, np.ones((1, len(b)))]), axis=0)
    # Between two roots the sign in the middle is the sign throughout.
    at = (ends[:-1] + ends[1:]) / 2
    return np.asarray(np.sum(np.diff(ends, axis=0) * (first + at * (b + at * a) > 0), axis=0))


def solid_ratio(
    bodies: Sequence[Array], place: Array, normal: Array, depth: float, way: Array, reach: float
) -> float:
    """Return t of a point of closed surfaces: its ray against every triangle.

    Triangles (T, 3, 3) are oriented outward; the ray starts at ``depth`` below the point, and the
    light is at the distance ``reach``. The ratio is NaN where the ray meets an edge.
    """
    start = place - depth * normal
    inside: list[tuple[float, int]] = []
    for corners in bodies:
        # The test of Moeller and Trumbore: u and v are barycentric, and s is the distance along the
        # ray.
        a, e, f = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        p = np.cross(way, f)
        scale = np.einsum("ij,ij->i", e, p)
        with np.errstate(all="ignore"):
            u = np.einsum("ij,ij->i", start - a, p) / scale
            q = np.cross(start - a, e)
            v = q @ way / scale
            s = np.einsum("ij,ij->i", f, q) / scale
            near = np.minimum(np.minimum(u, v), 1 - u - v)
        ahead = (s > 0) & (s < reach)
        if np.any(ahead & (np.abs(near) < 1e-9)):
            return math.nan
        # The ray leaves where it runs with the outward normal e x f: where scale is negative.
        hit = ahead & (near > 0)
        inside += [
            (float(at), 1 if side < 0 else -1) for at, side in zip(s[hit], scale[hit], strict=True)
        ]
    # From the light, which is outside of all bodies, back to the start.
    length, depth_in, far = 0.0, 0, reach
    for at, change in sorted(inside, reverse=True):
        length += far - at if depth_in > 0 else 0.0
        depth_in, far = depth_in + change, at
    length += far if depth_in > 0 else 0.0
    return float(depth / max(length, depth))
