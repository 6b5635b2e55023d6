"""Contours of any luminance on solids, refined until the measured error is small enough."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

import numpy as np
import scipy

from vizlight import _check
from vizlight.geometry.contours import banding, spacing
from vizlight.geometry.solids import exact_surfaces, triangle_mesh

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.contours.banding import Bands, Crossings
    from vizlight.geometry.contours.spacing import Levels, Steps
    from vizlight.geometry.solids.triangle_mesh import Mesh

    Luminance = Callable[[Array, Array], Array]
    Progress = Callable[[float], None]


#: Largest number of rounds of refinement, and numbers of triangles and polygons that end it.
ROUNDS, ENOUGH, MANY = 20, 1_500_000, 300_000
#: Share of a step that contours drawn as chords may add to the error.
CURVED = 0.1
#: Share of a triangle's area below which a polygon is not measured: where the luminance is
#: discontinuous, all contours coincide.
SLIVER = 1e-4
#: Fractions of edges at which the error of polygons is measured, and the offset inward.
ALONG, WITHIN = (0.25, 0.5, 0.75), 1e-3
#: Share of an allowed error beyond half a step that a measured one must keep, since the error
#: between the measured points may be slightly larger.
KEPT = 0.7
#: Number of corners that are measured at once.
BLOCK = 1 << 15
#: Number of triangles beyond which only the brightest ones are searched for smaller highlights, the
#: number of these, and the number of points per edge of the search grid.
ASKED, BRIGHTEST, GRID = 3000, 64, 10
#: Share of the allowed error by which steps may move without a new cut.
STILL = 1e-2
#: Largest distance of a crease from a chord between its points, as a share of the chord. Surfaces
#: that nearly coincide cross further away.
BULGE = 0.25
#: Radius of the hole at the apex of a cone, around which each ruling has its own normal.
APEX = 1e-7


def draw(
    mesh: Mesh, luminance: Luminance, levels: Levels, /, *, low: float | None = None,
    progress: Progress | None = None,
) -> Bands:  # fmt: skip
    """Return the bands of a luminance on the surfaces of a solid.

    Parameters
    ----------
    mesh : Mesh
        Mesh of a solid. Its triangles are split where the luminance is not linear.
    luminance : callable
        Function ``luminance(points, normals)`` of points on the exact surfaces, in the unit of the
        solid, and their exact outward normals.
    levels : int, float or sequence of float
        Steps of luminance, as for :func:`vizlight.geometry.contours.spacing.steps`.
    low : float, optional
        Luminance of points without light. Default: the lowest luminance found.
    progress : callable, optional
        Function that is called after each round with the share of triangles that keep the error.

    Returns
    -------
    Bands
        Bands, closed if the mesh is. ``error`` is measured on the exact surface, at the centre of
        each polygon and at three points of each of its edges.

    Warns
    -----
    UserWarning
        If an allowed error is not kept within 20 rounds of refinement, 1.5 million triangles and
        300 thousand polygons.

    Notes
    -----
    Contour points are found by bracketing and lie on the exact surface, at creases on both
    surfaces; contours are chords between them.
    """
    spacing.check(levels)
    if not len(mesh.triangles):
        none = spacing.steps(levels, low or 0.0, low or 0.0)
        empty, _ = banding.cut(mesh.points[:0], mesh.triangles, np.empty((0, 3)), none)
        return dataclasses.replace(empty, error=0.0)
    made = refine(_Lit(open_apexes(mesh), luminance), levels, low=low, progress=progress)
    made = _close_apexes(made, mesh)
    return dataclasses.replace(made, points=mesh.world(made.points))


class LitTriangles(Protocol):
    """Triangles with a luminance that can be cut into bands and refined."""

    @property
    def triangles(self) -> Indices:
        """Indices of the corners of the current triangles."""

    def corners(self) -> Array:
        """Return the luminance at the corners of all triangles, or at their points."""

    def cut(
        self, values: Array, steps: Steps, known: Crossings, rows: Indices | None
    ) -> tuple[Bands, Indices]:
        """Return the bands of some triangles, or of all, and the triangle of each polygon.

        Triangles that share a crease with these may be among them.
        """

    def measure(self, bands: Bands, triangle: Indices, allowed: float) -> Array:
        """Return the largest error of each polygon; up to ``allowed`` also of slivers."""

    def peaks(self, rows: Indices) -> Array:
        """Return the highest luminance found at a grid of points inside some triangles."""

    def split(self, chosen: Indices) -> Indices:
        """Halve the edges of chosen triangles, and split their neighbours to match.

        Returns the earlier indices of the triangles that stay as they were; they become the first.
        """


def refine(
    surface: LitTriangles, levels: Levels, /, *, low: float | None = None,
    progress: Progress | None = None,
) -> Bands:  # fmt: skip
    """Return the bands of a lit surface, refined until they keep the allowed error.

    Parameters
    ----------
    surface : LitTriangles
        Lit triangles of a solid, or :class:`vizlight.geometry.contours.refinement.Facets`. They are
        split in place.
    levels, low, progress
        Steps of luminance, luminance without light, and function of the progress, as for
        :func:`draw`.

    Returns
    -------
    Bands
        Bands with the measured error.
    """
    values, steps, keep = _settled(surface, levels, low, _Found())
    for turn in range(ROUNDS + 1):
        count = len(surface.triangles)
        known = len(keep.error)
        fresh = np.arange(known, count) if known else None
        bands, triangle = surface.cut(values, steps, keep.crossings, fresh)
        pieces = np.bincount(triangle, minlength=count)
        limit = _allowed(levels, steps)
        error = np.zeros(count)
        np.maximum.at(error, triangle, surface.measure(bands, triangle, limit))
        error[:known], pieces[:known] = keep.error, keep.pieces
        chosen = np.flatnonzero(error > limit)
        if progress is not None:
            progress(1 - len(chosen) / count)
        if not len(chosen) or turn == ROUNDS or count > ENOUGH or pieces.sum() > MANY:
            break
        keep = dataclasses.replace(keep, error=error, pieces=pieces).of(surface.split(chosen))
        values, found, keep = _settled(surface, levels, low, keep)
        if _moved(steps, found):
            steps, keep = found, _Found(keep.highest)
    if fresh is not None:
        bands, _ = surface.cut(values, steps, keep.crossings, None)
    worst, bound = float(error.max(initial=0)), spacing.allowed(levels)
    if bound is not None and worst > bound:
        _check.warn(f"levels={bound:g} is not kept everywhere: the largest error is {worst:.3g}")
    return dataclasses.replace(bands, error=worst)


@dataclass(frozen=True)
class _Found:
    """What was found of the first triangles, which stay as they were.

    The highest luminance inside each, and under the same steps its error, the number of its
    polygons, and the crossings of its edges.
    """

    highest: Array = field(default_factory=lambda: np.zeros(0))
    error: Array = field(default_factory=lambda: np.zeros(0))
    pieces: Indices = field(default_factory=lambda: np.zeros(0, np.intp))
    crossings: Crossings = field(default_factory=banding.Crossings)

    def of(self, same: Indices) -> _Found:
        """Return what is known of triangles by their earlier indices."""
        known = same[same < len(self.error)]
        highest = self.highest[same[same < len(self.highest)]]
        return _Found(highest, self.error[known], self.pieces[known], self.crossings)


def _allowed(levels: Levels, steps: Steps) -> float:
    """Return the error beyond which a triangle is split."""
    bound = spacing.allowed(levels)
    if bound is None:
        return (1 + CURVED) * steps.error
    return steps.error + KEPT * (bound - steps.error)


def _settled(
    surface: LitTriangles, levels: Levels, low: float | None, keep: _Found
) -> tuple[Array, Steps, _Found]:
    """Split the triangles with a highlight inside; return the values at corners and the steps."""
    for turn in range(ROUNDS + 1):
        values = surface.corners()
        bottom = float(values.min()) if low is None else low
        steps = spacing.steps(levels, bottom, float(values.max()))
        bad, highest = _peaks(surface, values, _allowed(levels, steps), keep.highest)
        keep = dataclasses.replace(keep, highest=highest)
        if not len(bad) or turn == ROUNDS:
            break
        keep = keep.of(surface.split(bad))
    return values, steps, keep


def _peaks(
    surface: LitTriangles, values: Array, allowed: float, highest: Array
) -> tuple[Indices, Array]:
    """Return the triangles with a highlight inside that their corners miss.

    If there are many triangles, only the brightest are searched. The highest luminance of all,
    which determines the steps, is found more exactly. ``highest`` holds the highest luminance of
    the first triangles, as far as it is known; it is returned for all that are searched.
    """
    count = len(surface.triangles)
    top = np.empty(count)
    for start in range(0, count, BLOCK):
        block = slice(start, start + BLOCK)
        top[block] = banding.at_corners(values, surface.triangles, block).max(axis=1)
    ceiling = top.max(initial=-np.inf) + STILL * allowed
    if count > ASKED:
        rows = np.argpartition(top, -BRIGHTEST)[-BRIGHTEST:]
        return rows[surface.peaks(rows) > ceiling], highest[:0]
    highest = np.concatenate([highest, surface.peaks(np.arange(len(highest), count))])
    return np.flatnonzero(highest > np.minimum(top + allowed, ceiling)), highest


def _moved(steps: Steps, found: Steps) -> bool:
    """Return whether the steps have changed by more than a negligible share of a step."""
    if len(steps.edges) != len(found.edges):
        return True
    return float(np.abs(steps.edges - found.edges).max()) > STILL * steps.error


class _Lit:
    """A mesh on exact surfaces with a luminance."""

    def __init__(self, mesh: Mesh, luminance: Luminance) -> None:
        self.luminance = luminance
        self._set(mesh)

    def _set(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.size = len(mesh.points)
        start, stop = mesh.triangles, np.roll(mesh.triangles, -1, axis=1)
        code = np.minimum(start, stop) * self.size + np.maximum(start, stop)
        self.codes, edge = np.unique(code, return_inverse=True)
        self.edge = edge.reshape(-1, 3)
        # The surfaces on both sides of each edge, which are equal at a smooth edge.
        self.both = np.full((len(self.codes), 2), -1)
        owner = np.repeat(mesh.patch, 3)
        self.both[self.edge.ravel(), 0] = owner
        other = owner != self.both[self.edge.ravel(), 0]
        self.both[:, 1] = self.both[:, 0]
        self.both[self.edge.ravel()[other], 1] = owner[other]
        self._check_creases()

    def _check_creases(self) -> None:
        """Leave chords on one of their two surfaces where these do not cross near them."""
        crease = np.flatnonzero(self.both[:, 0] != self.both[:, 1])
        a, b = (self.mesh.points[ends] for ends in np.divmod(self.codes[crease], self.size))
        way = b - a
        size = BULGE**2 * np.einsum("ij,ij->i", way, way)
        for share in ALONG:
            chord = a + share * way
            moved = exact_surfaces.onto(self.mesh.surfaces, chord, self.both[crease]) - chord
            far = np.einsum("ij,ij->i", moved, moved) > size
            self.both[crease[far], 1] = self.both[crease[far], 0]

    @property
    def triangles(self) -> Indices:
        """Indices of the corners of the current triangles."""
        return self.mesh.triangles

    def light(self, points: Array, patch: Indices) -> Array:
        """Return the luminance of points on given surfaces."""
        found = triangle_mesh.normals_of(self.mesh, points, patch)
        return np.asarray(self.luminance(self.mesh.world(points), found), dtype=np.float64)

    def corners(self) -> Array:
        """Return the luminance at the corners of all triangles."""
        patches = len(self.mesh.surfaces)
        key = self.mesh.triangles * patches + self.mesh.patch[:, np.newaxis]
        codes, place = np.unique(key, return_inverse=True)
        point, patch = np.divmod(codes, patches)
        return np.asarray(self.light(self.mesh.points[point], patch)[place.reshape(-1, 3)])

    def place(self, a: Indices, b: Indices, share: Array) -> Array:
        """Return points at fractions of edges, on the surfaces of both sides."""
        edge = np.searchsorted(self.codes, np.minimum(a, b) * self.size + np.maximum(a, b))
        points = self.mesh.points
        t = share[:, np.newaxis]
        return exact_surfaces.onto(
            self.mesh.surfaces, points[a] * (1 - t) + points[b] * t, self.both[edge]
        )

    def at(self, a: Indices, b: Indices, share: Array, patch: Indices) -> Array:
        """Return the luminance at fractions (N, m) of edges, with the normals of one side."""
        count = share.shape[1]
        places = self.place(np.repeat(a, count), np.repeat(b, count), share.ravel())
        return self.light(places, np.repeat(patch, count)).reshape(share.shape)

    def cut(
        self, values: Array, steps: Steps, known: Crossings, rows: Indices | None
    ) -> tuple[Bands, Indices]:
        """Return the bands of some triangles, or of all, and the triangle of each polygon.

        Triangles that share a crease with these are among them, as they share its points.
        """
        if rows is None:
            rows = np.arange(len(self.mesh.triangles))
        else:
            crease = np.zeros(len(self.codes), np.bool_)
            crease[self.edge[rows].ravel()] = True
            crease &= self.both[:, 0] != self.both[:, 1]
            here = np.asarray(crease[self.edge].any(axis=1))
            here[rows] = True
            rows = np.flatnonzero(here)
        made, triangle = banding.cut(
            self.mesh.points, self.mesh.triangles[rows], values[rows], steps,
            patch=self.mesh.patch[rows], place=self.place, luminance=self.at, known=known,
        )  # fmt: skip
        return made, rows[triangle]

    def split(self, chosen: Indices) -> Indices:
        """Halve the edges of chosen triangles, and split their neighbours to match."""
        marked = np.zeros(len(self.codes), np.bool_)
        marked[self.edge[chosen].ravel()] = True
        a, b = np.divmod(self.codes[marked], self.size)
        new = self.place(a, b, np.full(len(a), 0.5))
        number = np.full(len(self.codes), -1)
        number[marked] = self.size + np.arange(len(a))
        triangles, owner = triangle_mesh.split(self.mesh.triangles, number[self.edge])
        same = owner[: np.count_nonzero(~marked[self.edge].any(axis=1))]
        self._set(
            self.mesh.replace(
                points=np.concatenate([self.mesh.points, new]),
                triangles=triangles,
                patch=self.mesh.patch[owner],
            )
        )
        return same

    def peaks(self, rows: Indices) -> Array:
        """Return the highest luminance found at a grid of points inside some triangles.

        A highlight may be smaller than a triangle.
        """
        places = searched(self.mesh.points[self.mesh.triangles[rows]])
        patch = np.repeat(self.mesh.patch[rows], places.shape[1])
        on = exact_surfaces.onto(self.mesh.surfaces, places.reshape(-1, 3), patch[:, np.newaxis], 2)
        return np.asarray(self.light(on, patch).reshape(len(rows), -1).max(axis=1))

    def measure(self, bands: Bands, triangle: Indices, allowed: float) -> Array:
        """Return the largest error of each polygon at its centre and along its edges."""

        def light(places: Array, of: Indices) -> Array:
            patch = bands.patch[of]
            on = exact_surfaces.onto(self.mesh.surfaces, places, patch[:, np.newaxis])
            return self.light(on, patch)

        return measured(bands, triangle, light, allowed)


def along(start: Array, way: Array, share: Array) -> Array:
    """Return points at fractions (N, m) of N edges, one after the other."""
    places = start[:, np.newaxis] + share[:, :, np.newaxis] * way[:, np.newaxis]
    return np.asarray(places.reshape(-1, start.shape[1]))


def searched(corners: Array) -> Array:
    """Return the points of a grid inside each triangle, shape (T, number of points, columns)."""
    steps = np.array([(i, j) for i in range(GRID) for j in range(GRID - i)]) + 0.5
    weights = np.column_stack([steps, GRID + 0.5 - steps.sum(axis=1)]) / (GRID + 0.5)
    return np.asarray(weights @ corners)


def measured(
    bands: Bands, triangle: Indices, light: Callable[[Array, Indices], Array], allowed: float,
    columns: slice = slice(0, 3),
) -> Array:  # fmt: skip
    """Return the largest error of each polygon at its centre and at points of its edges.

    Parameters
    ----------
    bands : Bands
        Bands whose values are compared.
    triangle : ndarray of int, shape (C,)
        Triangle of each polygon. Polygons with a negligible share of its area have no error.
    light : callable
        Function ``light(points, polygons)`` that returns the luminance of points on polygons.
    allowed : float
        Error up to which the area of a polygon does not matter.
    columns : slice, default: slice(0, 3)
        Columns of points that ``light`` takes.
    """
    worst = np.zeros(len(bands.values))
    taken = bands.points[:, columns].T
    first = 0
    while first < len(worst):
        last = int(np.searchsorted(bands.offsets, bands.offsets[first] + BLOCK, side="right")) - 1
        last = max(last, first + 1)
        corner, edge, middle, size, offsets = _fans(bands, slice(first, last), taken)
        # The points are just inside the polygon: on a contour both bands are right.
        corner *= 1 - WITHIN
        corner += WITHIN * np.repeat(middle, size, axis=1)
        edge *= (1 - WITHIN) * (ALONG[1] - ALONG[0])
        count, each = middle.shape[1], corner.shape[1]
        places = np.empty((len(corner), count + len(ALONG) * each))
        places[:, :count] = middle
        for i in range(len(ALONG)):
            corner += edge
            places[:, count + i * each : count + (i + 1) * each] = corner
        rows = np.arange(first, last)
        of = np.concatenate([rows, np.tile(np.repeat(rows, size), len(ALONG))])
        miss = light(places.T, of)
        miss -= bands.values[of]
        np.abs(miss, out=miss)
        sides = miss[count:].reshape(len(ALONG), -1).max(axis=0)
        worst[first:last] = np.maximum(miss[:count], np.maximum.reduceat(sides, offsets))
        first = last
    return _without_slivers(worst, bands, triangle, allowed)


def _fans(
    bands: Bands, rows: slice, columns: Array
) -> tuple[Array, Array, Array, Indices, Indices]:
    """Return the corners of polygons, the edges that begin there, and the middles.

    They have the given columns of points as rows. The number and the place of the first corner of
    each polygon follow.
    """
    start, end = bands.offsets[rows], bands.offsets[rows.start + 1 : rows.stop + 1]
    size, offsets = end - start, start - start[0]
    corner = columns[:, bands.corners[start[0] : end[-1]]]
    edge = np.empty_like(corner)
    edge[:, :-1] = corner[:, 1:]
    edge[:, end - start[0] - 1] = corner[:, offsets]
    edge -= corner
    return corner, edge, np.add.reduceat(corner, offsets, axis=1) / size, size, offsets


def _without_slivers(worst: Array, bands: Bands, triangle: Indices, allowed: float) -> Array:
    """Return the errors of polygons, 0 for the slivers among those beyond the allowed error."""
    beyond = np.zeros(triangle.max(initial=-1) + 1, np.bool_)
    beyond[triangle[worst > allowed]] = True
    rows = np.flatnonzero(beyond[triangle])
    if not len(rows):
        return worst
    size = np.diff(bands.offsets)[rows]
    start = np.cumsum(size) - size
    places = np.repeat(bands.offsets[rows] - start, size) + np.arange(size.sum())
    columns = bands.points[:, :3].T
    # Relative to the extent: squares of tiny lengths underflow, squares of huge ones overflow.
    unit = float(np.ptp(columns, axis=1).max()) or 1.0
    few = dataclasses.replace(
        bands, offsets=np.append(start, size.sum()), corners=bands.corners[places]
    )
    corner, edge, middle, size, offsets = _fans(few, slice(0, len(rows)), columns / unit)
    inward = np.repeat(middle, size, axis=1) - corner
    parts = [edge[i] * inward[j] - edge[j] * inward[i] for i, j in ((1, 2), (2, 0), (0, 1))]
    area = np.add.reduceat(np.sqrt(sum(part * part for part in parts)), offsets)
    whole = np.bincount(triangle[rows], area)
    worst[rows[area <= SLIVER * whole[triangle[rows]]]] = 0
    return worst


def _next(bands: Bands) -> Indices:
    """Return for each corner of a polygon the position of the next one in ``corners``."""
    after = np.arange(1, len(bands.corners) + 1)
    after[bands.offsets[1:] - 1] = bands.offsets[:-1]
    return after


def open_apexes(mesh: Mesh) -> Mesh:
    """Return the mesh with a small hole at the apex of each cone, with one point per ruling.

    Where a solid touches itself there, each of its points at the apex gets its own hole.
    """
    for patch, surface in enumerate(mesh.surfaces):
        apex = getattr(surface, "apex", None)
        if apex is None:
            continue
        count = len(mesh.points)
        gap = mesh.points - apex
        at = np.einsum("ij,ij->i", gap, gap) < 1e-20
        at &= np.isin(np.arange(count), mesh.triangles[mesh.patch == patch])
        start = at[mesh.triangles]
        rows, slot = np.nonzero(start)
        if not len(rows):
            continue
        tip, b, c = (mesh.triangles[rows, (slot + i) % 3] for i in range(3))
        key = np.concatenate([tip * count + b, tip * count + c])
        ends, place = np.unique(key, return_inverse=True)
        new = count + place.reshape(2, -1)
        way = mesh.points[ends % count] - apex
        rim = apex + APEX * way / np.sqrt(np.einsum("ij,ij->i", way, way))[:, np.newaxis]
        kept = ~start.any(axis=1)
        owner = mesh.patch[rows]
        mesh = mesh.replace(
            points=np.concatenate([mesh.points, rim]),
            triangles=np.concatenate(
                [
                    mesh.triangles[kept],
                    np.stack([new[0], b, c], 1),
                    np.stack([new[0], c, new[1]], 1),
                ]
            ),
            patch=np.concatenate([mesh.patch[kept], owner, owner]),
        )
    return mesh


def _close_apexes(bands: Bands, mesh: Mesh) -> Bands:
    count = len(bands.points)
    clusters, points = np.arange(count), bands.points
    ends = np.stack([bands.corners, bands.corners[_next(bands)]])
    for surface in mesh.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is not None:
            gap = points - apex
            near = np.einsum("ij,ij->i", gap, gap) < (4 * APEX) ** 2
            around = ends[:, near[ends].all(axis=0)]
            graph = scipy.sparse.coo_array(
                (np.ones(around.shape[1]), tuple(around)), shape=(count, count)
            )
            _, hole = scipy.sparse.csgraph.connected_components(graph, directed=False)
            _, first, which = np.unique(hole[near], return_index=True, return_inverse=True)
            first = np.flatnonzero(near)[first]
            clusters[near] = first[which]
            points[first] = apex
    return banding.weld(bands, clusters)


class Facets:
    """Lit triangles for :func:`vizlight.geometry.contours.refinement.refine`.

    Parameters
    ----------
    points : ndarray, shape (P, 6) or (P, more)
        Positions, unit normals and other values, all interpolated linearly along edges.
    triangles : ndarray of int, shape (T, 3)
        Indices of corners.
    luminance : callable
        Function ``luminance(points, normals)``, which accepts normals of any length.
    lit : ndarray of bool, shape (P,)
        Mask of the points that could be lit. The luminance of other points is discontinuous, and
        their triangles are not refined.
    placed : bool, default: True
        Whether the luminance depends on the positions.
    """

    def __init__(
        self, points: Array, triangles: Indices, luminance: Luminance, lit: Bools,
        placed: bool = True,
    ) -> None:  # fmt: skip
        self.points, self.triangles, self.lit = points, triangles, lit
        self._light = luminance
        self._first = 0 if placed else 3
        used = np.zeros(len(points), np.bool_)
        used[triangles] = True
        found = self.light(points[used])
        self._values = np.full(len(points), found.min(initial=np.inf))
        self._values[used] = found

    def light(self, points: Array) -> Array:
        """Return the luminance of rows of points."""
        return self._lit(points[:, self._first : 6])

    def _lit(self, rows: Array) -> Array:
        """Return the luminance of rows of positions and normals, or of normals alone."""
        normals = rows[:, -3:]
        places = np.broadcast_to(0.0, normals.shape) if self._first else rows[:, :3]
        return np.asarray(self._light(places, normals), dtype=np.float64)

    def corners(self) -> Array:
        """Return the luminance at the points."""
        return self._values

    def cut(
        self, values: Array, steps: Steps, known: Crossings, rows: Indices | None
    ) -> tuple[Bands, Indices]:
        """Return the bands, and the triangle that each polygon was cut from."""
        rows_of = self.points[:, self._first : 6]

        def between(a: Indices, b: Indices, share: Array, _: Indices) -> Array:
            start = rows_of[a]
            places = along(start, rows_of[b] - start, share)
            return self._lit(places).reshape(share.shape)

        if rows is None:
            return banding.cut(
                self.points, self.triangles, values, steps, luminance=between, known=known
            )
        made, triangle = banding.cut(
            self.points, self.triangles[rows], values, steps, luminance=between, known=known
        )
        return made, rows[triangle]

    def measure(self, bands: Bands, triangle: Indices, allowed: float) -> Array:
        """Return the largest error of each polygon at its centre and along its edges."""
        worst = measured(
            bands, triangle, lambda places, _: self._lit(places), allowed, slice(self._first, 6)
        )
        worst[~np.all(self.lit[self.triangles], axis=1)[triangle]] = 0
        return worst

    def peaks(self, rows: Indices) -> Array:
        """Return the highest luminance found at a grid of points inside some triangles."""
        places = searched(self.points[self.triangles[rows]])
        found = self.light(places.reshape(-1, places.shape[-1])).reshape(len(rows), -1)
        lit = np.all(self.lit[self.triangles[rows]], axis=1)
        return np.where(lit, found.max(axis=1), -np.inf)

    def split(self, chosen: Indices) -> Indices:
        """Halve the edges of chosen triangles, and split their neighbours to match."""
        start, stop = self.triangles, np.roll(self.triangles, -1, axis=1)
        count = len(self.points)
        codes = np.minimum(start, stop) * count + np.maximum(start, stop)
        marked = np.unique(codes[chosen])
        a, b = np.divmod(marked, count)
        place = np.minimum(np.searchsorted(marked, codes), len(marked) - 1)
        number = np.where(marked[place] == codes, count + place, -1)
        self.triangles, owner = triangle_mesh.split(self.triangles, number)
        new = self.points[a] / 2 + self.points[b] / 2
        self.points = np.concatenate([self.points, new])
        self._values = np.concatenate([self._values, self.light(new)])
        self.lit = np.concatenate([self.lit, self.lit[a] & self.lit[b]])
        return owner[: np.count_nonzero(np.all(number < 0, axis=1))]
