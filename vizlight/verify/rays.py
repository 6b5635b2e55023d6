"""t of cos-theta shadows along single rays, without the search structures of the engine."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, VectorLike

#: Number of places on a ray through a height field.
SAMPLES = 20_000


def relief_ratio(
    x: Array, y: Array, z: Array, place: Array, normal: Array, depth: float, *,
    way: VectorLike | None, end: VectorLike | None = None, base: float = -math.inf,
    wall: bool = False,
) -> float:  # fmt: skip
    """Return t of a point of a height field, by many samples along its ray.

    Parameters
    ----------
    x, y, z : ndarray, shapes (nx,), (ny,), (ny, nx)
        Coordinates of the nodes, and their heights.
    place, normal : ndarray, shape (3,)
        Point, and its unit normal.
    depth : float
        Depth of the ray's start below the point, above 0.
    way : vector of 3 components or None
        Direction toward the light, above the horizon.
    end : vector of 3 components, optional
        Position of the light, in place of ``way``.
    base : float
        Height at which the solid ends below.
    wall : bool
        Whether the solid ends at the border of the field; otherwise it goes on beyond it.

    Returns
    -------
    float
        t, to 1/20,000 of the ray over the depth.
    """
    start = place - depth * normal
    rise = max(float(np.nanmax(z) - start[2]), 0.0)
    if end is not None:
        along = np.asarray(end, dtype=np.float64) - start
        if along @ normal <= depth:
            return 0.0
        # There is no solid above the highest node.
        along = along * min(rise / along[2], 1.0) if along[2] > 0 else along
    else:
        toward = np.asarray(way, dtype=np.float64)
        along = rise / toward[2] * toward
    places = start + (np.arange(SAMPLES)[:, np.newaxis] + 0.5) / SAMPLES * along
    across, up = (np.clip(p, a[0], a[-1]) for p, a in ((places[:, 0], x), (places[:, 1], y)))
    i, j = (np.clip(np.searchsorted(a, p) - 1, 0, len(a) - 2) for a, p in ((x, across), (y, up)))
    u, v = (across - x[i]) / (x[i + 1] - x[i]), (up - y[j]) / (y[j + 1] - y[j])
    low = (1 - u) * z[j, i] + u * z[j, i + 1]
    high = (1 - u) * z[j + 1, i] + u * z[j + 1, i + 1]
    within = (places[:, 2] < (1 - v) * low + v * high) & (places[:, 2] > base)
    if wall:
        within &= (across == places[:, 0]) & (up == places[:, 1])
    inside = float(np.mean(within)) * math.hypot(*along)
    return float(depth / max(inside, depth))


def solid_ratio(
    bodies: Sequence[Array], place: Array, normal: Array, depth: float, way: Array, reach: float
) -> float:
    """Return t of a point of closed surfaces: its ray against every triangle.

    Parameters
    ----------
    bodies : sequence of ndarray, shape (T, 3, 3)
        Corners of triangles that are oriented outward.
    place, normal : ndarray, shape (3,)
        Point, and its unit normal.
    depth : float
        Depth of the ray's start below the point, above 0.
    way : ndarray, shape (3,)
        Unit direction toward the light.
    reach : float
        Distance of the light.

    Returns
    -------
    float
        t; NaN where the ray meets an edge.
    """
    start = place - depth * normal
    inside: list[tuple[float, int]] = []
    for corners in bodies:
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
    length, depth_in, far = 0.0, 0, reach
    for at, change in sorted(inside, reverse=True):
        length += far - at if depth_in > 0 else 0.0
        depth_in, far = depth_in + change, at
    length += far if depth_in > 0 else 0.0
    return float(depth / max(length, depth))
