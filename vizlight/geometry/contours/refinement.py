"""Contours of any luminance on solids, refined until the measured error is small enough."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from vizlight import _check
from vizlight._types import Array, Bools, Indices
from vizlight.geometry.contours import banding, spacing
from vizlight.geometry.contours.banding import Bands
from vizlight.geometry.contours.spacing import Levels, LuminanceSteps
from vizlight.geometry.solids import exact_surfaces, triangle_mesh
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
#: Share of the allowed error by which the highest luminance may be missed.
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

    The mesh is split where the luminance is not linear. ``luminance(points, normals)`` takes points
    on the exact surfaces, in the unit of the solid, and their outward normals; ``low`` is that of
    points without light, by default the lowest. ``progress`` takes the share of triangles that keep
    the error after each round. Bands are closed if the mesh is; their error is measured on the
    exact surface, at the centre of each polygon and at three points of each of its edges. A warning
    is given where an allowed error is not kept within 20 rounds of refinement, 1.5 million
    triangles and 300 thousand polygons.

    Contour points are found by bracketing and lie on the exact surface, at creases on both
    surfaces; contours are chords between them.
    """
    if not len(mesh.triangles):
        # A solid without volume has no luminance; its steps still have to be valid.
        return banding.none(spacing.steps(levels, low or 0.0, low or 0.0))
    bands = refine(LitSolid(open_apexes(mesh), luminance), levels, low=low, progress=progress)
    bands = _close_apexes(bands, mesh)
    return dataclasses.replace(bands, points=mesh.world(bands.points))


def refine(
    surface: LitTriangles, levels: Levels, /, *, low: float | None = None,
    progress: Progress | None = None,
) -> Bands:  # fmt: skip
    """Return the bands of a lit surface, refined until they keep the allowed error.

    Arguments are those of :func:`draw`; the error of the bands is measured.
    """
    steps = _settled(surface, levels, low)
    error, pieces = np.empty(0), np.empty(0, np.intp)
    for turn in range(ROUNDS + 1):
        limit = _allowed(levels, steps)
        # Triangles that stay as they were come first, with the error that they have.
        count, measured = len(surface.triangles), len(error)
        bands, triangle = surface.cut(steps, measured)
        pieces = np.append(pieces, np.bincount(triangle, minlength=count)[measured:])
        error = np.append(error, np.zeros(count - measured))
        np.maximum.at(error, triangle, surface.measure(bands, triangle, limit))
        chosen = np.flatnonzero(error > limit)
        if progress is not None:
            progress(1 - len(chosen) / count)
        if not len(chosen) or turn == ROUNDS or count > ENOUGH or pieces.sum() > MANY:
            break
        same = surface.split(chosen)
        # The first of the triangles are those that stay, in the order of these indices.
        error, pieces = error[same], pieces[same]
        edges = _steps(surface, levels, low).edges
        share = STILL * steps.error
        if len(edges) != len(steps.edges) or np.abs(steps.edges - edges).max() > share:
            # New points are brighter than all before: the steps change, and with them all errors.
            steps = _settled(surface, levels, low)
            error, pieces = error[:0], pieces[:0]
    # The last cut was of the new triangles only.
    if measured:
        bands, _ = surface.cut(steps)
    worst, bound = float(error.max(initial=0)), spacing.allowed(levels)
    if bound is not None and worst > bound:
        _check.warn(f"levels={bound:g} is not kept everywhere: the largest error is {worst:.3g}")
    return dataclasses.replace(bands, error=worst)


def _allowed(levels: Levels, steps: LuminanceSteps) -> float:
    """Return the error beyond which a triangle is split."""
    bound = spacing.allowed(levels)
    if bound is None:
        return (1 + CURVED) * steps.error
    return steps.error + KEPT * (bound - steps.error)


def _steps(surface: LitTriangles, levels: Levels, low: float | None) -> LuminanceSteps:
    """Return the steps between the lowest and the highest luminance at the points."""
    values = surface.values
    bottom = float(values.min()) if low is None else low
    return spacing.steps(levels, bottom, float(values.max()))


def _settled(surface: LitTriangles, levels: Levels, low: float | None) -> LuminanceSteps:
    """Split the triangles with a highlight inside that their corners miss; return the steps.

    If there are many triangles, only the brightest are searched. The highest luminance of all,
    which determines the steps, is found more exactly.
    """
    searched = 0
    for _ in range(ROUNDS + 1):
        count = len(surface.triangles)
        top = banding.at_corners(surface.values, surface.triangles, slice(None)).max(axis=1)
        steps = _steps(surface, levels, low)
        allowed = _allowed(levels, steps)
        ceiling = top.max() + STILL * allowed
        few = count <= ASKED
        rows = np.arange(searched, count) if few else np.argpartition(top, -BRIGHTEST)[-BRIGHTEST:]
        # Within one triangle a miss below the allowed error does no harm, but the highest luminance
        # of all sets the steps of every band.
        above = surface.peaks(rows) > np.minimum(top[rows] + allowed if few else ceiling, ceiling)
        if not above.any():
            break
        same = surface.split(rows[above])
        # The errors of the triangles that stay as they were still hold.
        searched = len(same) if few else 0
    return steps


class LitTriangles:
    """Triangles with a luminance that can be cut into bands and refined.

    ``points`` (P, 6 or more) are positions, unit normals and other values, interpolated linearly
    along edges; ``luminance(points, normals)`` accepts normals of any length. The luminance of
    points that are not ``lit`` is discontinuous, and their triangles are not refined.
    """

    #: Smooth part that each triangle belongs to.
    patch: Indices
    #: Columns of points on which the luminance depends.
    columns = 6

    def __init__(self, points: Array, triangles: Indices, luminance: Luminance, lit: Bools) -> None:
        self.points, self.triangles, self.luminance, self.lit = points, triangles, luminance, lit
        self.patch = np.broadcast_to(np.intp(0), len(triangles))
        used = np.zeros(len(points), np.bool_)
        used[triangles] = True
        brightness = self.light(points[used])
        # Points that no triangle uses must not take part in the lowest and the highest luminance.
        #: Luminance at the points, or at the corners of triangles.
        self.values = np.full(len(points), brightness.min(initial=np.inf))
        self.values[used] = brightness

    def light(self, places: Array, patch: Indices | None = None) -> Array:  # noqa: ARG002
        """Return the luminance of places, which are rows of points, on given patches."""
        return np.asarray(self.luminance(places[:, :3], places[:, 3:6]), dtype=np.float64)

    def place(self, a: Indices, b: Indices, share: Array) -> Array:
        """Return points at fractions of edges."""
        return banding.chord(self.points, a, b, share)

    def on_edges(self, a: Indices, b: Indices, share: Array, patch: Indices) -> Array:
        """Return the luminance at fractions (N, m) of edges, with the normals of one side."""
        count = share.shape[1]
        places = self.place(np.repeat(a, count), np.repeat(b, count), share.ravel())
        return self.light(places, np.repeat(patch, count)).reshape(share.shape)

    def cut(self, steps: LuminanceSteps, first: int = 0) -> tuple[Bands, Indices]:
        """Return the bands of the triangles from an index on, and the triangle of each polygon."""
        bands, triangle = banding.cut(
            self.points, self.triangles[first:],
            self.values[first:] if self.values.ndim == 2 else self.values, steps,
            patch=self.patch[first:], place=self.place, luminance=self.on_edges,
        )  # fmt: skip
        return bands, first + triangle

    def split(self, chosen: Indices) -> Indices:
        """Halve the edges of chosen triangles, and split their neighbours to match.

        Returns the earlier indices of the triangles that stay as they were; they become the first.
        """
        count = len(self.points)
        codes = banding.edge_codes(self.triangles, count)
        # Each halved edge has one midpoint, whichever of its triangles asked for it.
        marked = np.unique(codes[chosen])
        a, b = np.divmod(marked, count)
        # Edges beyond the last one that is halved have no rank of their own.
        rank = np.minimum(np.searchsorted(marked, codes), len(marked) - 1)
        number = np.where(marked[rank] == codes, count + rank, -1)
        new = self.place(a, b, np.full(len(a), 0.5))
        triangles, owner = triangle_mesh.split(self.triangles, number)
        # Halfway to a point without light there may be none.
        self.lit = np.append(self.lit, self.lit[a] & self.lit[b])
        self.points, self.triangles = np.concatenate([self.points, new]), triangles
        self.patch = self.patch[owner]
        self._extend(new)
        return owner[: np.count_nonzero(np.all(number < 0, axis=1))]

    def _extend(self, new: Array) -> None:
        """Find the luminance of new points."""
        self.values = np.append(self.values, self.light(new))

    def peaks(self, rows: Indices) -> Array:
        """Return the highest luminance found at a grid of points inside some triangles.

        A highlight may be smaller than a triangle.
        """
        # Half steps: no point of the grid is on an edge, which the neighbour would search as well.
        steps = np.array([(i, j) for i in range(GRID) for j in range(GRID - i)]) + 0.5
        weights = np.column_stack([steps, GRID + 0.5 - steps.sum(axis=1)]) / (GRID + 0.5)
        places = weights @ self.points[self.triangles[rows]]
        brightness = self.near(places.reshape(-1, places.shape[-1]), np.repeat(rows, len(steps)))
        lit = np.all(self.lit[self.triangles[rows]], axis=1)
        return np.where(lit, brightness.reshape(len(rows), -1).max(axis=1), -np.inf)

    def near(self, places: Array, triangle: Indices) -> Array:  # noqa: ARG002
        """Return the luminance on the exact surface at places near some triangles."""
        return self.light(places)

    def measure(self, bands: Bands, triangle: Indices, allowed: float) -> Array:
        """Return the largest error of each polygon at its centre and at points of its edges.

        Slivers, polygons with a negligible share of the area of their triangle, have no error
        above ``allowed``.
        """
        worst, area = np.zeros(len(bands.values)), np.zeros(len(bands.values))
        # Squares of tiny lengths underflow, squares of huge ones overflow.
        unit = float(np.ptp(bands.points[:, :3], axis=0).max(initial=0)) or 1.0
        first = 0
        while first < len(worst):
            # As many polygons as have BLOCK corners together, but at least one.
            last = int(np.searchsorted(bands.offsets, bands.offsets[first] + BLOCK, side="right"))
            last = max(last - 1, first + 1)
            start = bands.offsets[first:last]
            size, offsets = bands.offsets[first + 1 : last + 1] - start, start - start[0]
            after = np.arange(1, size.sum() + 1)
            # The last corner of a polygon is followed by its first.
            after[offsets + size - 1] = offsets
            corner = bands.points[bands.corners[start[0] :][: len(after)], : self.columns]
            edge = corner[after] - corner
            middle = np.add.reduceat(corner, offsets) / size[:, np.newaxis]
            toward = np.repeat(middle, size, axis=0) - corner
            across = np.cross(edge[:, :3] / unit, toward[:, :3] / unit)
            # Twice the area, as triangles about the middle.
            area[first:last] = np.add.reduceat(np.linalg.norm(across, axis=1), offsets)
            # The points are just inside the polygon: on a contour both bands are right.
            corner = corner + WITHIN * toward
            inside = [corner + share * (1 - WITHIN) * edge for share in ALONG]
            rows = np.arange(first, last)
            polygon = np.concatenate([rows, np.tile(np.repeat(rows, size), len(ALONG))])
            brightness = self.near(np.concatenate([middle, *inside]), triangle[polygon])
            miss = np.abs(brightness - bands.values[polygon])
            sides = miss[len(rows) :].reshape(len(ALONG), -1).max(axis=0)
            worst[rows] = np.maximum(miss[: len(rows)], np.maximum.reduceat(sides, offsets))
            first = last
        sliver = area <= SLIVER * np.bincount(triangle, area, len(self.triangles))[triangle]
        worst[sliver & (worst > allowed)] = 0
        worst[~np.all(self.lit[self.triangles], axis=1)[triangle]] = 0
        return worst


class LitSolid(LitTriangles):
    """Triangles of a solid, lit at places on its exact surfaces."""

    columns = 3

    def __init__(self, mesh: Mesh, luminance: Luminance) -> None:
        self.luminance, self.mesh = luminance, mesh
        self.points, self.triangles, self.patch = mesh.points, mesh.triangles, mesh.patch
        self.lit = np.ones(len(mesh.points), np.bool_)
        self._extend(self.points)

    def _extend(self, new: Array) -> None:  # noqa: ARG002
        """Find the surfaces on both sides of each edge, and the luminance on both sides."""
        code = banding.edge_codes(self.triangles, len(self.points))
        self.codes, edge = np.unique(code, return_inverse=True)
        edge, owner = edge.ravel(), np.repeat(self.patch, 3)
        self.both = np.empty((len(self.codes), 2), np.intp)
        # Whichever of its triangles is written last; a triangle of another surface is then the
        # second.
        self.both[edge] = owner[:, np.newaxis]
        other = owner != self.both[edge, 0]
        self.both[edge[other], 1] = owner[other]
        # The surfaces are equal at a smooth edge. Chords are on one of two surfaces where these
        # do not cross near them.
        crease = np.flatnonzero(self.both[:, 0] != self.both[:, 1])
        a, b = (self.points[ends] for ends in np.divmod(self.codes[crease], len(self.points)))
        size = BULGE**2 * np.einsum("ij,ij->i", b - a, b - a)
        for share in ALONG:
            chord = a + share * (b - a)
            moved = exact_surfaces.onto(self.mesh.surfaces, chord, self.both[crease]) - chord
            far = np.einsum("ij,ij->i", moved, moved) > size
            self.both[crease[far], 1] = self.both[crease[far], 0]
        # At a crease each side has its own luminance.
        patches = len(self.mesh.surfaces)
        key = self.triangles * patches + self.patch[:, np.newaxis]
        codes, rank = np.unique(key, return_inverse=True)
        point, patch = np.divmod(codes, patches)
        self.values = self.light(self.points[point], patch)[rank.reshape(-1, 3)]

    def light(self, places: Array, patch: Indices | None = None) -> Array:
        """Return the luminance of places on given surfaces."""
        assert patch is not None
        normals = triangle_mesh.normals_of(self.mesh, places, patch)
        return np.asarray(self.luminance(self.mesh.world(places), normals), dtype=np.float64)

    def near(self, places: Array, triangle: Indices) -> Array:
        """Return the luminance on the exact surface at places near some triangles."""
        patch = self.patch[triangle]
        on = exact_surfaces.onto(self.mesh.surfaces, places, patch[:, np.newaxis])
        return self.light(on, patch)

    def place(self, a: Indices, b: Indices, share: Array) -> Array:
        """Return points at fractions of edges, on the surfaces of both sides."""
        count = len(self.points)
        edge = np.searchsorted(self.codes, np.minimum(a, b) * count + np.maximum(a, b))
        return exact_surfaces.onto(self.mesh.surfaces, super().place(a, b, share), self.both[edge])


def open_apexes(mesh: Mesh) -> Mesh:
    """Return the mesh with a small hole at the apex of each cone, with one point per ruling.

    Where a solid touches itself at an apex, each of its points at the apex gets its own hole.
    """
    for patch, apex in mesh.surfaces.apexes:
        count = len(mesh.points)
        gap = mesh.points - apex
        # Within 1e-10 of the apex, in normalised lengths.
        at = np.einsum("ij,ij->i", gap, gap) < 1e-20
        # Other surfaces may pass through the apex without ending there.
        at &= np.isin(np.arange(count), mesh.triangles[mesh.patch == patch])
        start = at[mesh.triangles]
        rows, slot = np.nonzero(start)
        tip, b, c = (mesh.triangles[rows, (slot + i) % 3] for i in range(3))
        # One point of the rim for each edge that leaves the apex, shared by the triangles on both
        # sides.
        key = np.concatenate([tip * count + b, tip * count + c])
        ends, place = np.unique(key, return_inverse=True)
        new = count + place.reshape(2, -1)
        way = mesh.points[ends % count] - apex
        rim = apex + APEX * way / np.sqrt(np.einsum("ij,ij->i", way, way))[:, np.newaxis]
        # A triangle without its tip has four corners, and becomes two triangles.
        halves = np.stack([new[0], b, c], axis=1), np.stack([new[0], c, new[1]], axis=1)
        kept = ~start.any(axis=1)
        owner = mesh.patch[rows]
        mesh = mesh.replace(
            points=np.concatenate([mesh.points, rim]),
            triangles=np.concatenate([mesh.triangles[kept], *halves]),
            patch=np.concatenate([mesh.patch[kept], owner, owner]),
        )
    return mesh


def _close_apexes(bands: Bands, mesh: Mesh) -> Bands:
    """Return bands with each hole that was opened at an apex merged to one point."""
    clusters, points = np.arange(len(bands.points)), bands.points
    for _, apex in mesh.surfaces.apexes:
        gap = points - apex
        # Contours may have put more points on the rim since, and close to it.
        near = np.flatnonzero(np.einsum("ij,ij->i", gap, gap) < (4 * APEX) ** 2)
        clusters[near] = near[:1]
        points[near[:1]] = apex
    size = np.diff(bands.offsets)
    owner = np.repeat(np.arange(len(size)), size)
    # Polygons that lose their area are left out.
    size, corners, first = banding.polygons(owner, owner, clusters[bands.corners])
    cells = size, corners, bands.band[owner[first]], bands.patch[owner[first]]
    lines = clusters[bands.lines], bands.line_levels
    return banding.assembled([points], cells, lines, bands.steps, bands.error)
