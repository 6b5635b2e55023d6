"""Cos-theta shadows on height fields, from the length of light rays inside the solid."""

from __future__ import annotations

import contextlib
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, Protocol, get_args

import numpy as np

from vizlight import _check, _compiled, _pool
from vizlight.geometry.relief import height_field, strips, sweeping, walks
from vizlight.model import kernels

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices, VectorLike
    from vizlight.geometry.relief.height_field import Border, Field


__all__ = ["inside_length", "shadow"]

Method = Literal["fast", "exact"]

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
    method: Method = "fast",
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
        there in vertical walls, and likewise at each cell that lacks a corner. Walls are part of
        the solid: a ray that runs in the plane of one is inside below the wall's upper edge.
    method : {"fast", "exact"}
        Method of following the rays. "exact": cells are crossed one by one, or 2^l x 2^l at once
        where all of them are above or below the ray. "fast": the same for a light with a position
        and, with the extra ``fast``, for every light; without it the field is resampled, for a
        light at infinity, in profiles along the light's azimuth.

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
        If a shape is wrong, there is only one row or no height at all, the light is inside the
        solid, or both or neither of direction and position are given.

    Notes
    -----
    The surface is bilinear, not triangulated. It has no diagonals to choose, so a mirrored field
    has the mirrored shadow. Along a ray its height is a quadratic in each cell, whose roots are
    found in closed form. The error of "exact" is at most ``3 eps`` times the size of the field for
    each time that a ray crosses the surface without grazing it. The error of profiles decreases
    with the square of the spacing, as does the error of the bilinear surface for a smooth one; on
    ground that is rough from node to node it does not: the mean error of t is 1e-3 on smooth hills,
    2e-2 on rough mountains and up to 8e-2 on noise, where single points are off by up to 0.94. The
    cost is O(log N) squares, or steps of a profile, for each time that a ray crosses the surface.
    Per ray, with a sun from 40 to 5 degrees high over 512 x 512 or 1024 x 1024 nodes, compiled code
    takes 0.2 to 0.6 microseconds of processor time, profiles 0.7 to 2, "exact" without the extra
    ``fast`` 3 to 20: without it neither of the two replaces the other.
    Source: cos-theta, section 2.

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
    ray = toward(field, direction=direction, position=position)

    def start(rays: Indices, _quick: bool = False, /) -> Array:
        return flat.take(rays, axis=0).T

    length = lengths(field, start, len(flat), ray, method)
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
    method: Method = "fast",
) -> Array:
    """Return the cos-theta shadow of a height field at its nodes.

    Parameters
    ----------
    x, y, z, direction, position, border, method
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
    On a plane t is the cosine of the angle between n and the direction from p' to the light, for
    every d. The error of "exact" there is at most ``(8 + S/d) eps``, where S is the size of the
    field, and 8 eps at depth 0. As d goes to 0, t goes to the clamped cosine where nothing occludes
    the light and to 0 elsewhere; depth 0 gives this limit. Where d is much less than the spacing, t
    depends on the slope of the cell on the side of a node that faces the light. The source prints
    ``t = r/d`` once; the correct ratio is d/r. Source: cos-theta, sections 2 and 3.
    """
    field = height_field.make(x, y, z, border=border)
    depth = _check.number("depth", depth, low=0.0)
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
    ray = toward(field, direction=direction, position=position)
    t = ratio(field, normal, depth, ray, method=method)
    t[dark] = 0
    return t


class Start(Protocol):
    """Starts of rays by their indices, shape (3, rays); if ``quick`` by compiled code."""

    def __call__(self, rays: Indices, quick: bool = False, /) -> Array: ...


class Ray:
    """Directions from positions toward one light, relative to a field's origin."""

    def __init__(self, direction: Array | None, position: Array | None) -> None:
        self.direction, self.position = direction, position

    def from_places(self, start: Array) -> tuple[Array, Array]:
        """Return unit directions (3, N) and lengths (N,) of the rays from positions (3, N)."""
        if self.direction is not None:
            way = np.repeat(self.direction[:, np.newaxis], start.shape[1], axis=1)
            return way, np.full(start.shape[1], walks.FAR)
        assert self.position is not None
        way = self.position[:, np.newaxis] - start
        size = kernels.length(way)
        unit = way / np.where(size > 0, size, 1)
        unit[np.abs(unit) < ROUNDING] = 0
        return unit, np.minimum(size, walks.FAR)


def toward(
    field: Field, *, direction: VectorLike | None = None, position: VectorLike | None = None
) -> Ray:
    """Return the :class:`Ray` toward a light, which must not be inside the solid."""
    if (direction is None) == (position is None):
        got = "neither" if direction is None else "both"
        raise ValueError(_check.message("direction, position", "one of them", got))
    name = "direction" if position is None else "position"
    value = direction if position is None else position
    vector = _check.vector(name, value, direction=position is None)
    if len(vector) != 3:
        raise ValueError(_check.message(name, "3 components", len(vector)))
    if position is None:
        way = np.array(vector) / max(abs(c) for c in vector)
        # The sine of 180 degrees is not 0 in a computer; a ray in a plane of nodes stays there.
        way[np.abs(way) < ROUNDING] = 0
        return Ray(way / np.linalg.norm(way), None)
    # A lamp may stand on the ground; 1e-9 of the size is rounding.
    place = np.array(vector) - field.origin
    height = float(field.height(place[:1], place[1:2])[0])
    size = max(field.x[-1], field.y[-1], field.top)
    if place[2] < height - 1e-9 * size:
        expected = f"a light outside the solid, above {height + field.origin[2]:.9g} there"
        raise ValueError(_check.message("position", expected, vector, "raise the light"))
    return Ray(None, place)


def ratio(
    field: Field,
    normal: Array,
    depth: float,
    ray: Ray,
    *,
    method: Method = "fast",
    report: Callable[[int], None] | None = None,
) -> Array:
    """Return :func:`shadow` for a validated field and its normals.

    ``report`` takes the number of rays that are done.
    """
    size = max(field.x[-1], field.y[-1], field.top)
    if depth * LEAST_DEPTH > size:
        expected = f"at most {size / LEAST_DEPTH:g}, 1e9 times the size of the field"
        raise ValueError(_check.message("depth", expected, depth))
    # At depth 0 t is a limit: the cosine where the ray leaves at once, else 0.
    limit = depth <= LEAST_DEPTH * size
    inset = 0.0 if limit else depth
    shape = field.heights.shape
    normals, heights = normal.reshape(-1, 3), field.heights.ravel()

    def start(rays: Indices, quick: bool = False, /) -> Array:
        if quick:
            place = np.empty((3, len(rays)))
            strips.inset(rays, field.x, field.y, heights, normals.ravel(), inset, place)
            return place
        row, column = np.divmod(rays, shape[1])
        place = np.stack([field.x.take(column), field.y.take(row), heights.take(rays)])
        return np.asarray(place - inset * normals.take(rays, axis=0).T)

    count = normal.shape[0] * normal.shape[1]
    t = lengths(field, start, count, ray, method, inset, report)
    if limit:
        step = min(np.diff(field.x).min(), np.diff(field.y).min())
        # A ray that grazes its own cell by rounding has not been occluded.
        free = t <= 1e-6 * step
        for rows in _pool.blocks(len(t), BLOCK):
            way, _ = ray.from_places(start(np.arange(rows.start, rows.stop)))
            cosine = np.einsum("ij,ji->i", normal.reshape(-1, 3)[rows], way)
            t[rows] = np.where(free[rows], np.clip(cosine, 0, 1), 0)
    else:
        # t = d / r in place; r of less than d, of a ray that leaves aside, counts as d.
        np.maximum(t, depth, out=t)
        np.divide(depth, t, out=t)
    return t.reshape(shape)


def lengths(
    field: Field,
    start: Start,
    count: int,
    ray: Ray,
    method: Method,
    below: float | None = None,
    report: Callable[[int], None] | None = None,
) -> Array:
    """Return the lengths inside the solid of rays that begin at ``start(rays)``, shape (3, rays).

    ``start`` is called for one block of indices at a time. ``below`` is the largest distance from
    the surface at which rays start; for None it is found from all of them.
    """
    _check.choice("method", method, get_args(Method))
    with contextlib.suppress(_compiled.FailedError):
        return _lengths(field, start, count, ray, method, below, report)
    # Compiled code is off from here on.
    return _lengths(field, start, count, ray, method, below, report)


def _lengths(
    field: Field,
    start: Start,
    count: int,
    ray: Ray,
    method: Method,
    below: float | None,
    report: Callable[[int], None] | None,
) -> Array:
    length = np.empty(count)
    # A lamp below the horizon of ground without an end: no ray ever leaves it.
    if ray.direction is not None and ray.direction[2] < 0 and field.border == "extend":
        length[:] = np.inf
        return length
    if ray.direction is not None and count:
        if below is None:
            below = _largest_offset(field, start(np.arange(count)))
        if _compiled.active():
            # All rays of a lamp at infinity are parallel: sorted by strips they share what they
            # read.
            made = strips.strips(field, ray.direction, below, count)
            if made is not None and strips.lengths.pays(walks.SAVED * count):
                _by_strip(made, start, length, report)
                return length
        elif method == "fast":
            # Without a compiler a resampled field is several times faster than the exact walk.
            profiles = sweeping.profiles(field, ray.direction, below)
            if profiles is not None:
                _by_profile(profiles, start, length, report)
                return length
    fast = walks.walk.pays(walks.SAVED * count)
    # Asked for once, before threads need them.
    pyramid = field.bounds
    bounds = walks.levels(pyramid) if fast else None

    def work(rows: slice) -> int:
        places = start(np.arange(rows.start, rows.stop))
        way, reach = ray.from_places(places)
        if bounds is None:
            length[rows] = walks.march(field, places, way, reach)
        else:
            walks.walk(
                np.ascontiguousarray(places), np.ascontiguousarray(way), reach, *field.edges,
                field.corners, bounds, float(field.top),
                field.border == "wall", length[rows],
            )  # fmt: skip
        return int(rows.stop)

    _all(work, _pool.blocks(count, BLOCK), report)
    return length


def _by_strip(
    made: strips.Strips,
    start: Start,
    length: Array,
    report: Callable[[int], None] | None,
) -> None:
    """Fill in lengths by compiled code, one band of strips and its rays after the other."""
    width = made.width(len(length))
    band: Indices = np.empty(len(length), np.int32)

    def find(rows: slice) -> int:
        band[rows] = made.band(start(np.arange(rows.start, rows.stop), True), width)
        return int(rows.stop)

    _all(find, _pool.blocks(len(length), BLOCK))
    order, ends = made.order(band, width)

    def work(part: slice) -> int:
        made.write(start(order[part], True), order[part], length)
        return int(part.stop)

    parts = [slice(int(a), int(b)) for a, b in pairwise(ends)]
    _all(work, parts, report)


def _by_profile(
    profiles: sweeping.Profiles,
    start: Start,
    length: Array,
    report: Callable[[int], None] | None,
) -> None:
    """Fill in lengths, one band of profiles and its rays after the other."""
    count = len(length)
    # The number of a band fits 16 bits, because such integers are sorted fast.
    width = max(profiles.width(count), profiles.count >> 15)
    band = np.empty(count, np.uint16)

    def sort(rows: slice) -> int:
        band[rows] = profiles.profile_index(start(np.arange(rows.start, rows.stop))) // width
        return int(rows.stop)

    _all(sort, _pool.blocks(count, BLOCK))
    short = np.int32 if count < 1 << 31 else np.int64
    order: Indices = np.argsort(band, kind="stable").astype(short)
    ends = np.cumsum(np.bincount(band))
    parts = [slice(a, b) for a, b in zip([0, *ends[:-1]], ends, strict=True) if b > a]

    def work(part: slice) -> int:
        own = order[part]
        made = profiles.band(int(band[own[0]]) * width, width)
        for rows in _pool.blocks(len(own), 2 * sweeping.BAND):
            some = own[rows]
            length[some] = made.lengths(start(some))
        return int(part.stop)

    _all(work, parts, report)


def _all(
    work: Callable[[slice], int],
    parts: list[slice],
    report: Callable[[int], None] | None = None,
) -> None:
    for done in _pool.run(work, parts):
        if report is not None:
            report(done)


def _largest_offset(field: Field, places: Array) -> float:
    """Return the largest distance of positions from the field, sideways or downwards."""
    ends = [(0.0, field.x[-1]), (0.0, field.y[-1]), (0.0, np.inf)]
    out = [np.maximum(low - p, p - high) for p, (low, high) in zip(places, ends, strict=True)]
    return max(float(np.nanmax(np.stack(out), initial=0.0)), 0.0)
