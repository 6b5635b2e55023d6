"""Bands of luminance, the parts of a surface between contours."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Bools, Indices, Slice
from vizlight.geometry.contours.spacing import LuminanceSteps

Luminance = Callable[[Indices, Indices, Array, Indices], Array]

#: Share of an edge to which a contour point is found, about the rounding of the luminance.
WIDTH = 2.0**-40
#: Luminance below that of a contour that stands for its own where places have no light.
TINY = 2.0**-1000
#: Share of the edge below which a contour point is merged with the corner.
SNAP = 1e-11
#: Number of triangles that are taken at once.
BLOCK = 1 << 15


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
    steps : LuminanceSteps
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
    steps: LuminanceSteps
    error: float

    @property
    def levels(self) -> Array:
        """Luminance of the contours between the lowest and the highest luminance."""
        return self.steps.edges[1:-1]

    def middles(self) -> Array:
        """Return the mean of each polygon's corners."""
        total = np.add.reduceat(self.points[self.corners], self.offsets[:-1])
        return np.asarray(total / np.diff(self.offsets)[:, np.newaxis])

    def normals(self) -> Array:
        """Return the mean unit normal of each polygon, zero where it has no area."""
        corners, owner = self.triangles()
        if not len(corners):
            return np.zeros((len(self.values), 3))
        a, b, c = (self.points[corners[:, i], :3] for i in range(3))
        # Relative to the extent: squares of tiny lengths underflow, squares of huge ones overflow.
        unit = float(np.ptp(self.points[:, :3], axis=0).max(initial=0)) or 1.0
        across = np.cross((b - a) / unit, (c - a) / unit)
        # The sum is twice the vector area, which a polygon that bends has as well.
        total = np.stack([np.bincount(owner, x, len(self.values)) for x in across.T], axis=1)
        size = np.sqrt(np.einsum("ij,ij->i", total, total))[:, np.newaxis]
        return np.asarray(total / np.where(size > 0, size, 1))

    def triangles(self) -> tuple[Indices, Indices]:
        """Return the polygons as fans of triangles, and the polygon of each triangle."""
        size = np.diff(self.offsets)
        # A polygon of n corners is n - 2 triangles about its first corner.
        owner, turn = ranges(np.zeros_like(size), size - 2)
        first = self.offsets[owner]
        parts = [self.corners[first + step] for step in (0 * turn, turn + 1, turn + 2)]
        return np.stack(parts, axis=1), owner


def cut(
    points: Array,
    triangles: Indices,
    values: Array,
    steps: LuminanceSteps,
    /,
    *,
    patch: Indices | None = None,
    place: Callable[[Indices, Indices, Array], Array] | None = None,
    luminance: Luminance | None = None,
) -> tuple[Bands, Indices]:
    """Cut triangles along contours.

    ``values``, of the corners (T, 3) or the points (P,), may differ between both sides of a crease.
    ``patch`` is the smooth part of each triangle; only triangles of one patch share contour points
    at an edge. ``place(a, b, t)`` returns the points on the surface at fractions t of edges,
    default on the chord, and ``luminance(a, b, t, patch)`` their luminance, t of shape (N, m):
    with it contour points are bracketed, else interpolated. The bands have NaN as the error; the
    second result is the triangle each polygon was cut from.

    A value in (edges[k-1], edges[k]] belongs to band k. Contour points keep the order of the levels
    along an edge even where the luminance is not monotone, so that each triangle is cut into
    one polygon per band. All triangles at an edge share all its contour points as corners, from
    whichever side they come: a closed surface stays closed. Triangles without contour points are
    taken over as they are.
    """
    # Nothing is brighter than the last edge of the steps: as a level it would cross nothing.
    levels = steps.edges[: max(len(steps.edges) - 1, 1)]
    # One patch for all needs no memory of its own: an array of stride 0, which the result has too.
    patch = np.broadcast_to(np.intp(0), len(triangles)) if patch is None else patch
    lowest, touched = _touched(triangles, values, levels, patch)
    rows, whole = np.flatnonzero(touched), np.flatnonzero(~touched)
    new, pieces = _pieces(
        len(points), triangles[rows], at_corners(values, triangles, rows), levels, patch[rows],
        place or functools.partial(chord, points), luminance,
    )  # fmt: skip
    size, cut_corners, cut_band, owner, lines, line_level = pieces
    # The triangles that stay whole follow the pieces of the others.
    triangle = np.concatenate([rows[owner], whole])
    band = np.concatenate([cut_band, lowest[whole]])
    size = np.append(size, np.full(len(whole), 3))
    corners = np.concatenate([cut_corners, triangles[whole].ravel()])
    patch = np.broadcast_to(patch[:1], len(band)) if patch.strides == (0,) else patch[triangle]
    bands = assembled(
        (points, new), (size, corners, band, patch), (lines, levels[line_level]), steps
    )
    return bands, triangle


def assembled(
    points: Sequence[Array], cells: tuple[Indices, ...], lines: tuple[Indices, Array],
    steps: LuminanceSteps, error: float = float("nan"),
) -> Bands:  # fmt: skip
    """Return bands with those of the points that polygons use.

    ``cells`` has the number of corners of each polygon, all corners, which are numbered anew in
    place, and the band and the patch of each; ``lines`` the ends (S, 2) of segments and their
    luminance.
    """
    size, corners, band, patch = cells
    counts = [len(part) for part in points]
    used = np.zeros(sum(counts), np.bool_)
    used[corners] = True
    number = np.where(used, np.cumsum(used) - 1, -1)
    for start in range(0, len(corners), BLOCK):
        rows = slice(start, start + BLOCK)
        corners[rows] = number[corners[rows]]
    parts = np.split(used, np.cumsum(counts)[:-1])
    ends, levels = number[lines[0]], lines[1]
    # A segment from a point to itself, or one with an end that no polygon uses, is none.
    kept = np.all(ends >= 0, axis=1) & (ends[:, 0] != ends[:, 1])
    return Bands(
        points=np.concatenate([part[rows] for part, rows in zip(points, parts, strict=True)]),
        offsets=np.cumsum(np.append(0, size)),
        corners=corners,
        band=band,
        values=steps.values[band],
        patch=patch,
        lines=ends[kept],
        line_levels=levels[kept],
        steps=steps,
        error=error,
    )


def none(steps: LuminanceSteps, error: float = 0.0) -> Bands:
    """Return the bands of a surface without polygons."""
    empty = np.empty(0, np.intp)
    lines = empty.reshape(0, 2), np.empty(0)
    return assembled([np.empty((0, 3))], (empty,) * 4, lines, steps, error)


def edge_codes(triangles: Indices, count: int) -> Indices:
    """Return a number for the edge that begins at each corner, the same in both directions."""
    after = np.roll(triangles, -1, axis=1)
    return np.minimum(triangles, after) * count + np.maximum(triangles, after)


def chord(points: Array, a: Indices, b: Indices, share: Array) -> Array:
    """Return points at fractions of straight edges."""
    t = share[:, np.newaxis]
    return np.asarray(points[a] * (1 - t) + points[b] * t)


def at_corners(values: Array, triangles: Indices, rows: Slice | Indices) -> Array:
    """Return the values at the corners of some triangles, from values at corners or at points."""
    return np.asarray(values[rows] if values.ndim == 2 else values[triangles[rows]])


def _pieces(
    count: int, triangles: Indices, values: Array, levels: Array, patch: Indices,
    place: Callable[[Indices, Indices, Array], Array], luminance: Luminance | None,
) -> tuple[Array, list[Indices]]:  # fmt: skip
    """Return the contour points, which follow as many given ones, and the pieces of triangles.

    Of the pieces: sizes, corners, bands and triangles, in the order of the triangles and of the
    bands; then the contours and their levels.
    """
    side, edge, ends, owner, side_values = _sides(triangles, values, patch)
    at = np.searchsorted(levels, side_values, side="left")
    first, last = at.min(axis=1), at.max(axis=1)
    of_side, level = ranges(first, last)
    if luminance is None:
        share = _linear(side_values[of_side], levels[level])
    else:
        share = _crossed(ends[edge], owner, side_values, levels, of_side, level, luminance)
    # A contour point within rounding of a corner would leave a sliver between them.
    share[share < SNAP] = 0
    share[share > 1 - SNAP] = 1

    # Along each edge: by fraction, and for equal fractions in the order of a side's levels.
    # An edge runs from its lower to its higher index; where the luminance falls on the way, the
    # levels are met from the highest down.
    down = at[of_side, 0] > at[of_side, 1]
    order = np.lexsort((np.where(down, -level, level), share, edge[of_side]))
    of_side, level, share = of_side[order], level[order], share[order]
    a, b = ends[edge[of_side]].T
    # A contour through a corner of the mesh has no point of its own there.
    between = (share > 0) & (share < 1)
    number = count + np.cumsum(between) - 1
    vertex = np.where(between, number, np.where(share > 0.5, b, a))
    new = place(a[between], b[between], share[between])
    starts = np.searchsorted(edge[of_side], np.arange(len(ends) + 1))

    parts = []
    for begin in range(0, max(len(triangles), 1), BLOCK):
        block = slice(begin, begin + BLOCK)
        bands = np.searchsorted(levels, values[block], side="left")
        triangle, band, position, corner, crossed = _walk(
            triangles[block], bands, side[block], edge, ends, starts, of_side, level, vertex
        )
        # By triangle, band and position; no two are equal, and the numbers are below 2^60.
        many, places = band.max(initial=0) + 1, position.max(initial=0) + 1
        order = np.argsort((triangle * many + band) * places + position)
        size, corners, first_row = polygons(triangle[order], band[order], corner[order])
        which = order[first_row]
        pieces = size, corners, band[which], begin + triangle[which]
        parts.append((*pieces, *_lines(triangle, crossed, corner)))
    return new, [np.concatenate(part) for part in zip(*parts, strict=True)]


def _touched(
    triangles: Indices, values: Array, levels: Array, patch: Indices
) -> tuple[Indices, Bools]:
    """Return the band of each triangle's first corner, and a mask of the triangles that are cut.

    Those have contour points on their edges, or repeated corners.
    """
    bands = np.searchsorted(levels, at_corners(values, triangles, slice(None)), side="left")
    crossed_sides = bands != np.roll(bands, -1, axis=1)
    touched = np.any(crossed_sides | (triangles == np.roll(triangles, -1, axis=1)), axis=1)
    if np.any(patch != patch[:1]) and np.any(crossed_sides):
        # At a crease the contour points of one side are corners on the other one, too.
        codes = edge_codes(triangles, int(triangles.max(initial=0)) + 1)
        touched |= np.isin(codes, codes[crossed_sides]).any(axis=1)
    return bands[:, 0].copy(), touched


def _sides(
    triangles: Indices, values: Array, patch: Indices
) -> tuple[Indices, Indices, Indices, Indices, Array]:
    """Return the sides of each triangle, the edge of each side, and ends, patches and values.

    A side is an edge as part of one patch; edge i of a triangle begins at corner i. Ends are given
    for each edge, patches and values for each side.
    """
    size = int(triangles.max(initial=0)) + 1
    codes, edge_of = np.unique(edge_codes(triangles, size), return_inverse=True)
    ends = np.stack(np.divmod(codes, size), axis=1)
    patches, patch_of = np.unique(patch, return_inverse=True)
    both = edge_of.reshape(-1) * len(patches) + np.repeat(patch_of.reshape(-1), 3)
    _, first, side = np.unique(both, return_index=True, return_inverse=True)
    # The two values of a side are in the order of the ends of its edge, whichever way the triangle
    # that was found first runs through it.
    forward = (triangles < np.roll(triangles, -1, axis=1)).reshape(-1, 1)[first]
    there = np.stack([values, np.roll(values, -1, axis=1)], axis=-1).reshape(-1, 2)[first]
    there = np.where(forward, there, there[:, ::-1])
    return side.reshape(-1, 3), edge_of.reshape(-1)[first], ends, np.repeat(patch, 3)[first], there


def ranges(first: Indices, last: Indices) -> tuple[Indices, Indices]:
    """Return the integers of half-open ranges, and before them the range of each."""
    size = last - first
    owner = np.repeat(np.arange(len(size)), size)
    start = np.cumsum(size) - size
    return owner, np.arange(len(owner)) - start[owner] + first[owner]


def _linear(values: Array, level: Array) -> Array:
    """Return the fraction of an edge at which a luminance that is linear crosses each level."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        # Without a slope the place is 0/0: half way is as good as any other.
        linear = (level - values[:, 0]) / (values[:, 1] - values[:, 0])
    return np.clip(np.nan_to_num(linear, nan=0.5), 0, 1)


def _crossed(
    ends: Indices, patch: Indices, values: Array, levels: Array, of_side: Indices, level: Indices,
    luminance: Luminance,
) -> Array:  # fmt: skip
    """Return the fraction of its side at which each level is crossed, in the order of the levels.

    The levels of a side follow each other, the sides follow each other.
    """
    known = values[of_side] - levels[level, np.newaxis]

    def above(share: Array, row: Indices) -> Array:
        side, corner = of_side[row], known[row]
        found = luminance(ends[side, 0], ends[side, 1], share[:, np.newaxis], patch[side])[:, 0]
        found = np.select([share == 0, share == 1], corner.T, found - levels[level[row]])
        # The lowest luminance is that of all places without light, which are below their contour.
        return np.where(found > 0, found, np.minimum(found, -TINY))

    share = _roots(above, len(level))
    # Where the luminance is not monotone the levels stay in order.
    rising = (values[:, 0] < values[:, 1])[of_side]
    return np.asarray(share[np.lexsort((np.where(rising, share, -share), of_side))])


def _roots(above: Callable[[Array, Indices], Array], count: int) -> Array:
    """Return where functions change their sign from 0 to 1, by Chandrupatla's method.

    SciPy has it since 1.15. The method takes inverse quadratic interpolation where it is safe, else
    it halves the bracket.
    """
    roots, which = np.empty(count), np.arange(count)
    # The last place, the other end of the bracket, and later the place before; with their values.
    x1: Array = np.zeros(count)
    x2: Array = np.ones(count)
    t: Array = np.full(count, 0.5)
    f1, f2 = above(x1, which), above(x2, which)
    while len(which):
        x = x1 + t * (x2 - x1)
        f = above(x, which)
        # The new place replaces the end of the bracket whose value has the same sign.
        same = (f > 0) == (f1 > 0)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        width = np.abs(x2 - x1)
        done = width <= WIDTH
        roots[which[done]] = np.where(np.abs(f1) <= np.abs(f2), x1, x2)[done]
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
            is_safe = (phi * phi < xi) & ((1 - phi) ** 2 < 1 - xi)
            ahead = f1 / (f2 - f1) * f3 / (f2 - f3)
            ahead += (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
            least = 0.5 * WIDTH / width
            t = np.where(is_safe, np.clip(ahead, least, 1 - least), 0.5)
        which = which[~done]
        x1, x2, f1, f2, t = (rows[~done] for rows in (x1, x2, f1, f2, t))
    return roots


def _walk(
    corner: Indices, band: Indices, side: Indices, edge: Indices, ends: Indices, starts: Indices,
    of_side: Indices, level: Indices, vertex: Indices,
) -> tuple[Indices, ...]:  # fmt: skip
    """Walk around each triangle; the points of one band are a polygon in the order of the walk.

    Returns columns of triangle, band, position, point and the crossed level, -1 for no crossing. A
    point on a contour has two rows, one for each of its bands.
    """
    rows = []
    every, nothing = np.arange(len(corner)), np.full(len(corner), -1)
    # More than the positions of one side.
    span = 2 * int(np.diff(starts).max(initial=0)) + 3
    for slot in range(3):
        rows.append([every, band[:, slot], nothing + 1 + slot * span, corner[:, slot], nothing])
        # Edge i of a triangle runs from corner i to the next.
        of_edge = edge[side[:, slot]]
        first, last = starts[of_edge], starts[of_edge + 1]
        tri, index = ranges(first, last)
        step = index - first[tri]
        forward = ends[of_edge[tri], 0] == corner[tri, slot]
        # Contour points are stored once per edge, and its other triangle meets them in the other
        # order.
        index = np.where(forward, index, last[tri] - 1 - step)
        # Only the contours of the triangle's own side of a crease lead to another band.
        same_side = of_side[index] == side[tri, slot]
        passed = np.cumsum(same_side)
        # The sum runs through all triangles: that before each one's points is subtracted.
        passed -= np.append(0, passed)[np.searchsorted(tri, tri)]
        sign = np.where(band[tri, (slot + 1) % 3] > band[tri, slot], 1, -1)
        after = band[tri, slot] + sign * passed
        position = slot * span + 2 * (step + 1)
        crossed = np.where(same_side, level[index], -1)
        rows.append([tri, after, position, vertex[index], crossed])
        # A contour point is the last of the band that it ends and the first of the one that it
        # begins.
        before = [tri, after - sign, position - 1, vertex[index], np.full(len(tri), -1)]
        rows.append([column[same_side] for column in before])
    return tuple(np.concatenate(part) for part in zip(*rows, strict=True))


def polygons(triangle: Indices, band: Indices, corner: Indices) -> tuple[Indices, Indices, Indices]:
    """Return size, corners and the first row of polygons with at least three corners."""
    new = np.ones(len(triangle), np.bool_)
    new[1:] = (triangle[1:] != triangle[:-1]) | (band[1:] != band[:-1])
    group = np.cumsum(new) - 1
    first = np.flatnonzero(new)
    previous = np.roll(corner, 1)
    # Before the first corner of a polygon comes its last one.
    previous[first] = corner[np.roll(first, -1) - 1]
    # A point equal to its predecessor around the polygon is left out.
    kept = corner != previous
    size = np.bincount(group[kept], minlength=len(first))
    good = size >= 3
    kept &= good[group]
    return size[good], corner[kept], first[good]


def _lines(triangle: Indices, crossed: Indices, corner: Indices) -> tuple[Indices, Indices]:
    """Return contour segments, one per triangle and level, and the level of each."""
    on = np.flatnonzero(crossed >= 0)
    order = on[np.lexsort((crossed[on], triangle[on]))]
    # A contour that enters a triangle leaves it, so the points of each level are two.
    pairs = corner[order].reshape(-1, 2)
    return pairs, crossed[order][::2]
