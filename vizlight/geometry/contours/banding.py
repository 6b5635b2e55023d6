"""Bands of luminance, the parts of a surface between contours."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.contours.spacing import Steps

    Luminance = Callable[[Indices, Indices, Array, Indices], Array]

#: Share of an edge that the search for a contour point leaves: the rounding of the luminance moves
#: it by as much.
WIDTH = 2.0**-40
#: Number of places at which a root is estimated before its bracket is divided, and number of
#: brackets in which this is tried.
ESTIMATES, TRIES = 3, 2
#: Number of parts that a round of the search divides all brackets into, and the largest number of
#: parts of one bracket.
PARTS, MOST = 2048, 32
#: Width of a bracket at which the chord gives the crossing to rounding, and at which a jump of the
#: luminance is not searched more closely: a change by more than JUMP of the span of all levels.
NARROW, JUMP = 2.0**-20, 1e-3
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
        # Relative to the extent: squares of tiny lengths underflow, squares of huge ones overflow.
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

        Raises
        ------
        TypeError, ValueError
            If the direction is not one finite vector of 3 components that is not 0.
        """
        size = np.diff(self.offsets)
        lamina = np.repeat(np.arange(len(size)), size)
        depth = self.points @ _check.unit("toward", toward)
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
    known: Crossings | None = None,
) -> tuple[Bands, Indices]:
    """Cut triangles along contours.

    Parameters
    ----------
    points : ndarray, shape (P, 3)
        Positions.
    triangles : ndarray of int, shape (T, 3)
        Indices of corners.
    values : ndarray, shape (T, 3) or (P,)
        Luminance at the corners, which may differ between both sides of a crease, or at the points.
    steps : Steps
        Luminance of contours and bands.
    patch : ndarray of int, shape (T,), optional
        Index of the smooth part that each triangle belongs to. The triangles at an edge that
        belong to one patch share their contour points. Default: one patch.
    place : callable, optional
        Function ``place(a, b, t)`` that returns the points on the surface at the fraction t of the
        edges from a to b. Default: points on the chord.
    luminance : callable, optional
        Function ``luminance(a, b, t, patch)`` that returns the luminance at fractions t, shape
        (N, m), of N edges. With it,
        contour points are found by bracketing, else by linear interpolation.
    known : Crossings, optional
        Crossings of the levels that were found before; new ones are added.

    Returns
    -------
    bands : Bands
        Bands, with NaN as the error.
    triangle : ndarray of int, shape (C,)
        Index of the triangle that each polygon was cut from.

    Notes
    -----
    A value in (edges[k-1], edges[k]] belongs to band k. Brackets keep the order of the levels along
    an edge even where the luminance is not monotone there, so that each triangle is cut into one
    polygon per band. All triangles at an edge have all its contour points as corners, whichever
    side they come from: a closed surface stays closed. Triangles without contour points are taken
    over as they are.
    """
    levels = steps.edges[: max(len(steps.edges) - 1, 1)]
    lowest, touched = _touched(triangles, values, levels, patch)
    rows, whole = np.flatnonzero(touched), np.flatnonzero(~touched)
    patch = np.broadcast_to(np.intp(0), len(triangles)) if patch is None else patch
    pieces, new, lines, line_level = _pieces(
        points, triangles[rows], at_corners(values, triangles, rows), levels, patch[rows], place,
        luminance, Crossings() if known is None else known,
    )  # fmt: skip
    # The triangles that stay whole follow the pieces of the others.
    triangle = np.concatenate([rows[pieces.triangle], whole])
    band = np.concatenate([pieces.band, lowest[whole]])
    offsets = np.empty(len(triangle) + 1, np.intp)
    offsets[: len(pieces.offsets)] = pieces.offsets
    offsets[len(pieces.offsets) :] = pieces.offsets[-1] + 3 * np.arange(1, len(whole) + 1)
    corners = np.empty(offsets[-1], np.intp)
    corners[: pieces.offsets[-1]] = pieces.corners
    np.take(triangles, whole, axis=0, out=corners[pieces.offsets[-1] :].reshape(-1, 3))
    count = len(points)
    used, lookup = _compact(corners, count + len(new))
    old = np.searchsorted(used, count)
    made = np.empty((len(used), points.shape[1]))
    np.take(points, used[:old], axis=0, out=made[:old])
    np.take(new, used[old:] - count, axis=0, out=made[old:])
    lines = lookup[lines]
    kept = np.all(lines >= 0, axis=1) & (lines[:, 0] != lines[:, 1])
    cut_bands = Bands(
        points=made,
        offsets=offsets,
        corners=corners,
        band=band,
        values=steps.values[band],
        patch=np.broadcast_to(patch[:1], len(band)) if patch.strides == (0,) else patch[triangle],
        lines=lines[kept],
        line_levels=levels[line_level[kept]],
        steps=steps,
        error=float("nan"),
    )
    return cut_bands, triangle


def at_corners(values: Array, triangles: Indices, rows: slice | Indices) -> Array:
    """Return the values at the corners of some triangles, from values at corners or at points."""
    return np.asarray(values[rows] if values.ndim == 2 else values[triangles[rows]])


class Crossings:
    """The fractions at which levels are crossed along sides, by the edge and patch of a side.

    They hold for one luminance and one sequence of levels. The indices of points must not change;
    points may be added.
    """

    #: Bits of the index of a point and of a patch in a key; of larger indices nothing is kept.
    POINT, PATCH = 24, 14

    def __init__(self) -> None:
        self._keys, self._start = np.empty(0, np.intp), np.empty(0, np.intp)
        self._share = np.empty(0)

    def keys(self, ends: Indices, patch: Indices) -> Indices | None:
        """Return a key for each side, or None if the indices are too large for keys."""
        if max(ends.max(initial=0) >> self.POINT, patch.max(initial=0) >> self.PATCH):
            return None
        return (ends[:, 0] << self.POINT | ends[:, 1]) << self.PATCH | patch

    def find(self, keys: Indices) -> tuple[Bools, Indices]:
        """Return which sides are known, and the place of the first fraction of each."""
        if not len(self._keys):
            return np.zeros(len(keys), np.bool_), np.zeros(len(keys), np.intp)
        place = np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)
        return self._keys[place] == keys, self._start[place]

    def taken(self, places: Indices) -> Array:
        """Return fractions by their places."""
        return self._share[places]

    def add(self, keys: Indices, start: Indices, share: Array) -> None:
        """Add the fractions of sides, which begin at ``start``."""
        keys = np.concatenate([self._keys, keys])
        order = np.argsort(keys, kind="stable")
        self._keys = keys[order]
        self._start = np.concatenate([self._start, start + len(self._share)])[order]
        self._share = np.concatenate([self._share, share])


@dataclass(frozen=True)
class _Pieces:
    """Polygons that triangles are cut into, in the order of the triangles and of the bands."""

    offsets: Indices
    corners: Indices
    band: Indices
    triangle: Indices


def _pieces(
    points: Array, triangles: Indices, values: Array, levels: Array, patch: Indices,
    place: Callable[[Indices, Indices, Array], Array] | None, luminance: Luminance | None,
    known: Crossings,
) -> tuple[_Pieces, Array, Indices, Indices]:  # fmt: skip
    """Return the pieces of triangles, the contour points, and the contours with their levels.

    The contour points follow the given points.
    """
    side, edge, ends, owner, side_values = _sides(triangles, values, patch)
    at = np.searchsorted(levels, side_values, side="left")
    first, last = at.min(axis=1), at.max(axis=1)
    of_side, level = _ranges(first, last)
    if luminance is None:
        share = _linear(side_values[of_side], levels[level])
    else:
        share = _crossings(ends[edge], owner, side_values, levels, first, last, luminance, known)
    share[share < SNAP] = 0
    share[share > 1 - SNAP] = 1

    # Along each edge: by fraction, and for equal fractions in the order of a side's levels.
    down = at[of_side, 0] > at[of_side, 1]
    after = np.cumsum(last - first)
    row = np.arange(len(level))
    order = np.where(down, (2 * after - (last - first) - 1)[of_side] - row, row)
    same = np.diff(edge[of_side]) == 0
    if np.any(same & (np.diff(share[order]) < 0)):
        order = np.lexsort((np.where(down, -level, level), share, edge[of_side]))
    of_side, level, share = of_side[order], level[order], share[order]
    a, b = ends[edge[of_side]].T
    between = (share > 0) & (share < 1)
    number = len(points) + np.cumsum(between) - 1
    vertex = np.where(between, number, np.where(share > 0.5, b, a))
    if place is None:
        t = share[between, np.newaxis]
        new = points[a[between]] * (1 - t) + points[b[between]] * t
    else:
        new = place(a[between], b[between], share[between])
    starts = np.searchsorted(edge[of_side], np.arange(len(ends) + 1))

    parts = []
    for begin in range(0, max(len(triangles), 1), BLOCK):
        block = slice(begin, begin + BLOCK)
        bands = np.searchsorted(levels, values[block], side="left")
        turn = np.argsort(bands, axis=1, kind="stable")
        rows = np.arange(len(bands))[:, np.newaxis]
        flipped = ((turn[:, 1] - turn[:, 0]) % 3) == 2
        triangle, band, position, corner, crossed = _walk(
            triangles[block][rows, turn], bands[rows, turn], turn, side[block], edge, ends, starts,
            of_side, level, vertex,
        )  # fmt: skip
        position = np.where(flipped[triangle], -position, position)
        # By triangle, band and position; no two are equal, and the numbers are below 2^60.
        low, many = position.min(initial=0), band.max(initial=0) + 1
        places = position.max(initial=0) - low + 1
        order = np.argsort((triangle * many + band) * places + position - low)
        size, corners, first_row = _polygons(triangle[order], band[order], corner[order])
        which = order[first_row]
        parts.append(
            (
                size,
                corners,
                band[which],
                begin + triangle[which],
                *_lines(triangle, crossed, corner),
            )
        )
    size, corners, band, triangle, lines, line_level = (
        np.concatenate(part) for part in zip(*parts, strict=True)
    )
    offsets = np.concatenate([[0], np.cumsum(size)])
    return _Pieces(offsets, corners, band, triangle), new, lines, line_level


def _touched(
    triangles: Indices, values: Array, levels: Array, patch: Indices | None
) -> tuple[Indices, Bools]:
    """Return the band of each triangle's first corner, and which triangles are not left whole.

    These have contour points on their edges, or too few corners.
    """
    lowest = np.empty(len(triangles), np.intp)
    own = np.empty((len(triangles), 3), np.bool_)
    touched = np.empty(len(triangles), np.bool_)
    for start in range(0, len(triangles), BLOCK):
        rows = slice(start, start + BLOCK)
        bands = np.searchsorted(levels, at_corners(values, triangles, rows), side="left")
        lowest[rows] = bands[:, 0]
        own[rows] = bands != np.roll(bands, -1, axis=1)
        a, b, c = triangles[rows].T
        touched[rows] = (a == b) | (b == c) | (c == a) | own[rows].any(axis=1)
    if patch is not None and np.any(patch != patch[:1]) and np.any(own):
        # At a crease the contour points of one side are corners on the other one, too.
        stop = np.roll(triangles, -1, axis=1)
        size = int(triangles.max(initial=0)) + 1
        codes = np.minimum(triangles, stop) * size + np.maximum(triangles, stop)
        touched |= np.isin(codes, codes[own]).any(axis=1)
    return lowest, touched


def _compact(corners: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the points that are used and the new indices, which the corners get in place."""
    there = np.zeros(count, np.bool_)
    there[corners] = True
    lookup = np.where(there, np.cumsum(there) - 1, -1)
    for start in range(0, len(corners), BLOCK):
        rows = slice(start, start + BLOCK)
        corners[rows] = lookup[corners[rows]]
    return np.flatnonzero(there), lookup


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
    size, corners, first = _polygons(owner, owner, clusters[bands.corners])
    cell = owner[first]
    used, lookup = _compact(corners, len(bands.points))
    lines = lookup[clusters[bands.lines]]
    kept = lines[:, 0] != lines[:, 1]
    return dataclasses.replace(
        bands,
        points=bands.points[used],
        offsets=np.concatenate([[0], np.cumsum(size)]),
        corners=corners,
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

    A side is an edge as part of one patch; edge i of a triangle begins at corner i. Ends are given
    for each edge, patches and values for each side.
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


def _linear(values: Array, level: Array) -> Array:
    """Return the fraction of an edge at which a luminance that is linear crosses each level."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        linear = (level - values[:, 0]) / (values[:, 1] - values[:, 0])
    return np.clip(np.nan_to_num(linear, nan=0.5), 0, 1)


def _crossings(
    ends: Indices, patch: Indices, values: Array, levels: Array, first: Indices, last: Indices,
    luminance: Luminance, known: Crossings,
) -> Array:  # fmt: skip
    """Return the fraction of its side at which each level is crossed, as :func:`_bracketed`."""
    keys = known.keys(ends, patch)
    if keys is None:
        return _bracketed(ends, patch, values, levels, first, last, luminance)
    crossed = first < last
    there, start = known.find(keys)
    new = np.flatnonzero(crossed & ~there)
    found = _bracketed(ends[new], patch[new], values[new], levels, first[new], last[new], luminance)
    size = (last - first)[new]
    known.add(keys[new], np.cumsum(size) - size, found)
    _, start = known.find(keys)
    _, places = _ranges(start, start + last - first)
    return known.taken(places)


def _bracketed(
    ends: Indices, patch: Indices, values: Array, levels: Array, first: Indices, last: Indices,
    luminance: Luminance,
) -> Array:  # fmt: skip
    """Return the fraction of its side at which each level is crossed.

    The levels of a side run from ``first`` to ``last``; the result has all levels of one side, then
    all levels of the next.

    Notes
    -----
    A bracket is an interval of a side with all levels that are crossed there. Where one level is
    left, its crossing is estimated from all places found so far, see :func:`_estimated`. In each
    round the luminance is found at places inside all other brackets, which divides each bracket and
    its levels. Brackets do not overlap, so the levels stay in order.
    """
    size = last - first
    start = np.cumsum(size) - size - first
    share = np.empty(int(size.sum()))
    rising = values[:, 0] < values[:, 1]
    side = np.flatnonzero(size)
    lower, upper = first[side], last[side]
    place = np.tile([0.0, 1.0], (len(side), 1))
    light = values[side]
    tries = np.zeros(len(side), np.intp)
    span = float(levels[-1] - levels[0]) or 1.0
    while len(side):
        gap = light - levels[lower][:, np.newaxis]
        single = (upper - lower == 1) & (tries < TRIES) & np.all(gap != 0, axis=1)
        tries[single] += 1
        if len(one := np.flatnonzero(single)):
            own, level = side[one], lower[one]
            root = _estimated(ends[own], patch[own], place[one], gap[one], levels[level], luminance)
            good = np.isfinite(root)
            share[(start[own] + level)[good]] = root[good]
            kept = np.ones(len(side), np.bool_)
            kept[one[good]] = False
            side, lower, upper, tries = side[kept], lower[kept], upper[kept], tries[kept]
            place, light = place[kept], light[kept]
            if not len(side):
                break
        # Fewer brackets are divided into more parts, as a round has a cost of its own.
        parts = min(max(PARTS // len(side), 3), MOST)
        t = place[:, :1] + np.arange(1, parts) / parts * np.diff(place, axis=1)
        found = luminance(ends[side, 0], ends[side, 1], t, patch[side])
        place = np.column_stack([place[:, 0], t, place[:, 1]])
        light = np.column_stack([light[:, 0], found, light[:, 1]])
        # Levels that are crossed before each place: the lowest ones where the luminance rises.
        split = np.clip(np.searchsorted(levels, light), lower[:, np.newaxis], upper[:, np.newaxis])
        up = rising[side]
        split = np.where(up[:, np.newaxis], split, (lower + upper)[:, np.newaxis] - split)
        split[:, 0], split[:, -1] = lower, upper
        split = np.maximum.accumulate(split, axis=1)
        bracket, part = np.nonzero(np.diff(split, axis=1))
        begin, end = split[bracket, part], split[bracket, part + 1]
        turned = lower[bracket] + upper[bracket]
        up = up[bracket]
        lower, upper = np.where(up, begin, turned - end), np.where(up, end, turned - begin)
        both = np.stack([part, part + 1], axis=1)
        rows = bracket[:, np.newaxis]
        place, light = place[rows, both], light[rows, both]
        side, tries = side[bracket], tries[bracket]
        width = place[:, 1] - place[:, 0]
        gap = light - levels[lower][:, np.newaxis]
        smooth = np.all(gap != 0, axis=1) & (upper - lower == 1)
        jump = np.abs(light[:, 1] - light[:, 0]) > JUMP * span
        done = width <= np.where(smooth | jump, NARROW, WIDTH)
        which, level = _ranges(lower[done], upper[done])
        # A jump as near to a corner as it is searched is at the corner.
        middle = np.where(place[:, 0] == 0, 0.0, np.where(place[:, 1] == 1, 1.0, 0.5))
        part = np.where(smooth & ~jump, _root(gap), middle)[done]
        share[start[side[done]][which] + level] = (place[done, 0] + part * width[done])[which]
        kept = ~done
        side, lower, upper, tries = side[kept], lower[kept], upper[kept], tries[kept]
        place, light = place[kept], light[kept]
    return share


def _estimated(
    ends: Indices, patch: Indices, place: Array, gap: Array, level: Array, luminance: Luminance
) -> Array:  # fmt: skip
    """Return where in each bracket a level is crossed, NaN where that is not found soon.

    The place is interpolated as a polynomial of the luminance through the ends of the bracket and
    all places found, by Neville's scheme. An estimate is taken where the next one would differ from
    it by less than WIDTH, judged by the last two changes.
    """
    (low, high), (first, found) = place.T, gap.T
    root, result = high, np.full(len(place), np.nan)
    # Values of the polynomials through the last place, the last two, and so on.
    through, off, change = [low], [first], high - low
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for turn in range(ESTIMATES + 1):
            off.append(found)
            last = [root]
            for i, value in enumerate(through):
                other = off[-2 - i]
                last.append((found * value - other * last[-1]) / (found - other))
            through, earlier, root = last, root, last[-1]
            inside = (root >= low) & (root <= high)
            before, change = change, np.abs(root - earlier)
            # The next change is smaller by more than this one was.
            near = change * change <= WIDTH * before
            result = np.where(inside & near & (turn > 0) & np.isnan(result), root, result)
            root = np.where(inside, root, (low + high) / 2)
            if turn < ESTIMATES:
                found = luminance(ends[:, 0], ends[:, 1], root[:, np.newaxis], patch)[:, 0] - level
    return result


def _root(gap: Array) -> Array:
    """Return where in [0, 1] a chord crosses 0, from its values at both ends."""
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        root = gap[:, 0] / (gap[:, 0] - gap[:, 1])
    return np.asarray(np.clip(np.where(np.isfinite(root), root, 0.5), 0, 1))


def _walk(
    corner: Indices, band: Indices, turn: Indices, side: Indices, edge: Indices, ends: Indices,
    starts: Indices, of_side: Indices, level: Indices, vertex: Indices,
) -> tuple[Indices, Indices, Indices, Indices, Indices]:  # fmt: skip
    """Walk around each triangle, up from its darkest corner and down again.

    Returns columns of triangle, band, position, point and the level crossed there, or -1 without
    a crossing. A point on a contour has two rows, one for each of its bands.
    """
    count = len(corner)
    # More than the positions of one side.
    span = 2 * int(np.diff(starts).max(initial=0)) + 3
    rows: list[list[Indices]] = []
    for slot in range(3):
        here = corner[:, slot]
        tri = np.arange(count)
        none = np.full(count, -1)
        rows.append([tri, band[:, slot], none + 1 + slot * span, here, none])
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
        position = slot * span + 2 * (step + 1)
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
    """Return size, corners and the first row of polygons with at least three corners."""
    if not len(triangle):
        return triangle, corner, triangle
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
    return size[good], corner[kept], first[good]


def _lines(triangle: Indices, crossed: Indices, corner: Indices) -> tuple[Indices, Indices]:
    """Return contour segments, one per triangle and level, and the level of each."""
    on = np.flatnonzero(crossed >= 0)
    order = on[np.lexsort((crossed[on], triangle[on]))]
    pairs = corner[order].reshape(-1, 2)
    return pairs, crossed[order][::2]
