"""Bands of luminance, the parts of a surface between contours."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Indices
    from vizlight.geometry.contours.spacing import Steps

    Luminance = Callable[[Indices, Indices, Array, Indices], Array]

#: Halvings of an edge in search of a contour; the remaining interval is below rounding.
HALVINGS = 48
#: Share of the edge below which a contour point is merged with the corner.
SNAP = 1e-11


@dataclass(frozen=True)
class Bands:
    """The surface between neighbouring contours, as polygons with one value per polygon.

    Attributes
    ----------
    points : ndarray of float64, shape (P, 3)
        Positions. Neighbouring polygons share points, so that a closed surface stays closed.
    offsets : ndarray of int, shape (C + 1,)
        Start of each polygon in ``corners``.
    corners : ndarray of int
        Indices of points: polygon i has the points ``corners[offsets[i]:offsets[i + 1]]``,
        counter-clockwise seen from outside.
    band : ndarray of int, shape (C,)
        Band of each polygon; band 0 holds the lowest luminance.
    values : ndarray of float64, shape (C,)
        Luminance of each polygon.
    patch : ndarray of int, shape (C,)
        Index of the smooth part of the surface that each polygon belongs to.
    lines : ndarray of int, shape (S, 2)
        Indices of the end points of contour segments.
    line_levels : ndarray of float64, shape (S,)
        Luminance of each contour segment.
    steps : Steps
        Luminance of contours and bands.
    error : float
        Largest luminance error: the bound of a closed form, else the error measured at the centre
        and along the edges of each polygon.
    """

    points: Array
    offsets: Indices
    corners: Indices
    band: Indices
    values: Array
    patch: Indices
    lines: Indices
    line_levels: Array
    steps: Steps
    error: float

    @property
    def levels(self) -> Array:
        """Luminance of the contours between the lowest and the highest luminance."""
        return self.steps.edges[1:-1]

    def middles(self) -> Array:
        """Return the mean of each polygon's corners."""
        size = np.diff(self.offsets)
        owner = np.repeat(np.arange(len(size)), size)
        columns = [np.bincount(owner, x, len(size)) for x in self.points[self.corners].T]
        return np.asarray(np.stack(columns, axis=1) / size[:, np.newaxis])

    def normals(self) -> Array:
        """Return the mean unit normal of each polygon, zero where it has no area."""
        corners, owner = self.triangles()
        a, b, c = (self.points[corners[:, i], :3] for i in range(3))
        # Relative to the extent: squares of tiny lengths underflow and those of huge ones overflow.
        unit = float(np.ptp(self.points[:, :3], axis=0).max(initial=0)) or 1.0
        across = np.cross((b - a) / unit, (c - a) / unit)
        total = np.stack([np.bincount(owner, x, len(self.values)) for x in across.T], axis=1)
        size = np.sqrt(np.einsum("ij,ij->i", total, total))[:, np.newaxis]
        return np.asarray(total / np.where(size > 0, size, 1))

    def triangles(self) -> tuple[Indices, Indices]:
        """Return the polygons as fans of triangles, and the polygon of each triangle."""
        size = np.diff(self.offsets)
        owner = np.repeat(np.arange(len(size)), size - 2)
        start = np.concatenate([[0], np.cumsum(size - 2)])[:-1]
        turn = np.arange(len(owner)) - start[owner]
        first = self.offsets[owner]
        parts = [self.corners[first + step] for step in (0 * turn, turn + 1, turn + 2)]
        return np.stack(parts, axis=1), owner


@dataclass(frozen=True)
class Laminae:
    """Plane polygons that are painted over one another, the farthest first.

    Attributes
    ----------
    points : ndarray of float64, shape (P, 3)
        Positions.
    offsets : ndarray of int, shape (C + 1,)
        Start of each lamina in ``points``: lamina i has the points ``offsets[i]`` to
        ``offsets[i + 1]``, in cyclic order.
    values : ndarray of float64, shape (C,)
        Luminance of each lamina.
    """

    points: Array
    offsets: Indices
    values: Array

    def order(self, toward: ArrayLike) -> Indices:
        """Return the painter's order for a view: the farthest lamina first.

        Parameters
        ----------
        toward : array_like, shape (3,)
            Direction toward the eye of a parallel view.

        Returns
        -------
        ndarray of int, shape (C,)
            Indices of laminae, sorted by the depth of their centres. If the view direction lies
            in the planes of the laminae, each is seen as a line and no order is right: use bands.
        """
        size = np.diff(self.offsets)
        lamina = np.repeat(np.arange(len(size)), size)
        depth = self.points @ np.asarray(toward, dtype=np.float64)
        return np.argsort(np.bincount(lamina, depth, len(size)) / np.maximum(size, 1))


def cut(
    points: Array,
    triangles: Indices,
    values: Array,
    steps: Steps,
    /,
    *,
    patch: Indices | None = None,
    place: Callable[[Indices, Indices, Array], Array] | None = None,
    luminance: Luminance | None = None,
    halvings: int = HALVINGS,
) -> tuple[Bands, Indices]:
    """Cut triangles along contours.

    Parameters
    ----------
    points : ndarray, shape (P, 3)
        Positions.
    triangles : ndarray of int, shape (T, 3)
        Indices of corners.
    values : ndarray, shape (T, 3)
        Luminance at the corners; it may differ between both sides of a crease.
    steps : Steps
        Luminance of contours and bands.
    patch : ndarray of int, shape (T,), optional
        Index of the smooth part that each triangle belongs to. The triangles at an edge that
        belong to one patch share their contour points. Default: one patch.
    place : callable, optional
        Function ``place(a, b, t)`` that returns the points on the surface at the fraction t of the
        edges from a to b. Default: points on the chord.
    luminance : callable, optional
        Function ``luminance(a, b, t, patch)`` that returns the luminance at these points. With it,
        contour points are found by halving the edge, else by linear interpolation.
    halvings : int, default: 48
        Number of halvings.

    Returns
    -------
    bands : Bands
        Bands, with NaN as the error.
    triangle : ndarray of int, shape (C,)
        Index of the triangle that each polygon was cut from.

    Notes
    -----
    A value in (edges[k-1], edges[k]] belongs to band k. Halving keeps the order of the levels
    along an edge even where the luminance is not monotone there, so that each triangle is cut
    into one polygon per band. All triangles at an edge have all its contour points as corners,
    whichever side they come from: a closed surface stays closed.
    """
    count = len(triangles)
    patch = np.zeros(count, np.intp) if patch is None else np.asarray(patch, np.intp)
    side, edge, ends, owner, side_values = _sides(triangles, values, patch)
    levels = steps.edges[: max(len(steps.edges) - 1, 1)]
    at = np.searchsorted(levels, side_values, side="left")
    first, last = at.min(axis=1), at.max(axis=1)
    of_side, level = _ranges(first, last)
    a, b = ends[edge[of_side]].T
    share = _shares(a, b, owner[of_side], side_values[of_side], levels[level], luminance, halvings)
    share[share < SNAP] = 0
    share[share > 1 - SNAP] = 1

    # Along each edge: by fraction, and for equal fractions in the order of a side's levels.
    rising = np.where(at[of_side, 0] <= at[of_side, 1], level, -level)
    order = np.lexsort((rising, share, edge[of_side]))
    of_side, level, share = of_side[order], level[order], share[order]
    a, b = a[order], b[order]
    between = (share > 0) & (share < 1)
    number = len(points) + np.cumsum(between) - 1
    vertex = np.where(between, number, np.where(share > 0.5, b, a))
    if place is None:
        t = share[between, np.newaxis]
        new = points[a[between]] * (1 - t) + points[b[between]] * t
    else:
        new = place(a[between], b[between], share[between])
    starts = np.searchsorted(edge[of_side], np.arange(len(ends) + 1))

    corner_band = np.searchsorted(levels, values, side="left")
    turn = np.argsort(corner_band, axis=1, kind="stable")
    rows = np.arange(count)[:, np.newaxis]
    flipped = ((turn[:, 1] - turn[:, 0]) % 3) == 2
    sorted_band, sorted_corner = corner_band[rows, turn], triangles[rows, turn]
    record = _walk(
        sorted_corner, sorted_band, turn, side, edge, ends, starts, of_side, level, vertex
    )
    triangle, band, position, corner, crossed = record
    position = np.where(flipped[triangle], -position, position)
    order = np.lexsort((position, band, triangle))
    offsets, corners, first_row = _polygons(triangle[order], band[order], corner[order])
    which = order[first_row]
    lines, line_level = _lines(triangle, crossed, corner)
    band = band[which]
    made = np.concatenate([points, new])
    used, corners = np.unique(corners, return_inverse=True)
    lookup = np.full(len(made), -1)
    lookup[used] = np.arange(len(used))
    lines = lookup[lines]
    kept = np.all(lines >= 0, axis=1) & (lines[:, 0] != lines[:, 1])
    cut_bands = Bands(
        points=made[used],
        offsets=offsets,
        corners=corners.reshape(-1),
        band=band,
        values=steps.values[band],
        patch=patch[triangle[which]],
        lines=lines[kept],
        line_levels=levels[line_level[kept]],
        steps=steps,
        error=float("nan"),
    )
    return cut_bands, triangle[which]


def weld(bands: Bands, clusters: Indices) -> Bands:
    """Return bands with the points of each cluster merged.

    Parameters
    ----------
    bands : Bands
        Bands to change; they are not modified.
    clusters : ndarray of int, shape (P,)
        Index of the point that replaces each point.

    Returns
    -------
    Bands
        Bands without the polygons that lose their area.
    """
    size = np.diff(bands.offsets)
    owner = np.repeat(np.arange(len(size)), size)
    offsets, corners, first = _polygons(owner, owner, clusters[bands.corners])
    cell = owner[first]
    used, corners = np.unique(corners, return_inverse=True)
    lookup = np.full(len(bands.points), -1)
    lookup[used] = np.arange(len(used))
    lines = lookup[clusters[bands.lines]]
    kept = lines[:, 0] != lines[:, 1]
    return dataclasses.replace(
        bands,
        points=bands.points[used],
        offsets=offsets,
        corners=corners.reshape(-1),
        band=bands.band[cell],
        values=bands.values[cell],
        patch=bands.patch[cell],
        lines=lines[kept],
        line_levels=bands.line_levels[kept],
    )


def _sides(
    triangles: Indices, values: Array, patch: Indices
) -> tuple[Indices, Indices, Indices, Indices, Array]:
    """Return the sides of each triangle, the edge of each side, and ends, patches and values.

    A side is an edge as part of one patch; edge i of a triangle begins at corner i. The ends are
    those of edges, patches and values those of sides.
    """
    start, stop = triangles, np.roll(triangles, -1, axis=1)
    low, high = np.minimum(start, stop), np.maximum(start, stop)
    size = int(triangles.max(initial=0)) + 1
    key = (low * size + high).ravel()
    codes, edge_of = np.unique(key, return_inverse=True)
    ends = np.stack(np.divmod(codes, size), axis=1)
    patches, patch_of = np.unique(patch, return_inverse=True)
    both = edge_of.reshape(-1) * max(len(patches), 1) + np.repeat(patch_of.reshape(-1), 3)
    _, first, side = np.unique(both, return_index=True, return_inverse=True)
    there = np.where(
        (start.ravel() < stop.ravel())[:, np.newaxis],
        np.stack([values, np.roll(values, -1, axis=1)], axis=-1).reshape(-1, 2),
        np.stack([np.roll(values, -1, axis=1), values], axis=-1).reshape(-1, 2),
    )
    owner = np.repeat(patch, 3)[first]
    return side.reshape(-1, 3), edge_of.reshape(-1)[first], ends, owner, there[first]


def _ranges(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Return the integers of half-open ranges, and before them the range of each."""
    size = last - first
    owner = np.repeat(np.arange(len(size)), size)
    start = np.cumsum(size) - size
    return owner, np.arange(len(owner)) - start[owner] + first[owner]


def _shares(
    a: Indices,
    b: Indices,
    patch: Indices,
    values: Array,
    level: Array,
    luminance: Luminance | None,
    halvings: int,
) -> Array:
    """Return the fraction of its edge at which each level is crossed."""
    if luminance is None:
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            linear = (level - values[:, 0]) / (values[:, 1] - values[:, 0])
        return np.clip(np.nan_to_num(linear, nan=0.5), 0, 1)
    low, high = np.zeros(len(a)), np.ones(len(a))
    up = values[:, 1] > level
    for _ in range(halvings if len(a) else 0):
        middle = (low + high) / 2
        after = (luminance(a, b, middle, patch) > level) == up
        high = np.where(after, middle, high)
        low = np.where(after, low, middle)
    return (low + high) / 2


def _walk(
    corner: Indices, band: Indices, turn: Indices, side: Indices, edge: Indices, ends: Indices,
    starts: Indices, of_side: Indices, level: Indices, vertex: Indices,
) -> tuple[Indices, Indices, Indices, Indices, Indices]:  # fmt: skip
    """Walk around each triangle, up from its darkest corner and down again.

    Returns columns of triangle, band, position, point and the level crossed there, or -1 without
    a crossing. A point on a contour has two rows, one for each of its bands.
    """
    count = len(corner)
    rows: list[list[Indices]] = []
    for slot in range(3):
        here = corner[:, slot]
        tri = np.arange(count)
        none = np.full(count, -1)
        rows.append([tri, band[:, slot], none + 1 + (slot << 40), here, none])
        i, j = turn[:, slot], turn[:, (slot + 1) % 3]
        # Edge i of a triangle runs from corner i to the next.
        own_side = side[tri, np.where((j - i) % 3 == 1, i, j)]
        of_edge = edge[own_side]
        first, last = starts[of_edge], starts[of_edge + 1]
        tri, index = _ranges(first, last)
        forward = ends[of_edge[tri], 0] == here[tri]
        step = index - first[tri]
        index = np.where(forward, index, last[tri] - 1 - step)
        own = of_side[index] == own_side[tri]
        passed = np.cumsum(own)
        before_first = np.concatenate([[0], passed])[np.searchsorted(tri, tri)]
        passed = passed - before_first
        sign = 1 if slot < 2 else -1
        after = band[tri, slot] + sign * passed
        position = (slot << 40) + 2 * (step + 1)
        none = np.full(len(tri), -1)
        crossed = np.where(own, level[index], none)
        rows.append([tri[own], (after - sign)[own], position[own] - 1, vertex[index][own],
                     none[own]])  # fmt: skip
        rows.append([tri, after, position, vertex[index], crossed])
    columns = [np.concatenate(part) for part in zip(*rows, strict=True)]
    return columns[0], columns[1], columns[2], columns[3], columns[4]


def _polygons(
    triangle: Indices, band: Indices, corner: Indices
) -> tuple[Indices, Indices, Indices]:
    """Return offsets, corners and the first row of polygons with at least three corners."""
    if not len(triangle):
        return np.zeros(1, np.intp), corner, triangle
    new = np.ones(len(triangle), np.bool_)
    new[1:] = (triangle[1:] != triangle[:-1]) | (band[1:] != band[:-1])
    group = np.cumsum(new) - 1
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(new)) - 1
    previous = np.empty_like(corner)
    previous[1:] = corner[:-1]
    previous[first] = corner[last]
    # A point equal to its predecessor around the polygon is left out.
    kept = corner != previous
    size = np.bincount(group[kept], minlength=len(first))
    good = size >= 3
    kept &= good[group]
    offsets = np.concatenate([[0], np.cumsum(size[good])])
    return offsets.astype(np.intp), corner[kept], first[good]


def _lines(triangle: Indices, crossed: Indices, corner: Indices) -> tuple[Indices, Indices]:
    """Return contour segments, one per triangle and level, and the level of each."""
    on = np.flatnonzero(crossed >= 0)
    order = on[np.lexsort((crossed[on], triangle[on]))]
    pairs = corner[order].reshape(-1, 2)
    return pairs, crossed[order][::2]
