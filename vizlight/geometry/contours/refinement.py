"""Contours of any luminance on solids, refined until the measured error is small enough."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Protocol

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from vizlight import _check
from vizlight.geometry.contours import banding, spacing
from vizlight.geometry.solids import exact_surfaces, triangle_mesh

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.contours.banding import Bands
    from vizlight.geometry.contours.spacing import Levels, Steps
    from vizlight.geometry.solids.triangle_mesh import Mesh

    Luminance = Callable[[Array, Array], Array]

#: Largest number of rounds of refinement, and numbers of triangles and polygons that end it.
ROUNDS, ENOUGH, MANY = 20, 1_500_000, 300_000
#: Share of a step that contours drawn as chords may add to the error.
CURVED = 0.1
#: Halvings of an edge during refinement.
ROUGH = 20
#: Share of a triangle's area below which a polygon is not measured: where the luminance is
#: discontinuous, all contours coincide.
SLIVER = 1e-4
#: Fractions of edges at which the error of polygons is measured, and the offset inward.
ALONG, WITHIN = (0.25, 0.5, 0.75), 1e-3
#: Share of an allowed error that a measured one must keep, since the error between the measured
#: points may be slightly larger.
KEPT = 0.98
#: Number of triangles beyond which they are not searched for smaller highlights, and number of
#: points per edge of the search grid.
ASKED, GRID = 3000, 10
#: Largest distance of a crease from a chord between its points, as a share of the chord. Surfaces
#: that nearly coincide cross further away.
BULGE = 0.25
#: Radius of the hole at the apex of a cone, around which each ruling has its own normal.
APEX = 1e-7


def draw(mesh: Mesh, luminance: Luminance, levels: Levels, /, *, low: float | None = None) -> Bands:
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
    Contour points are found by halving edges and lie on the exact surface, at creases on both
    surfaces; contours are chords between them.
    """
    spacing.check(levels)
    if not len(mesh.triangles):
        none = spacing.steps(levels, low or 0.0, low or 0.0)
        empty, _ = banding.cut(mesh.points[:0], mesh.triangles, np.empty((0, 3)), none)
        return dataclasses.replace(empty, error=0.0)
    made = refine(_Lit(open_apexes(mesh), luminance), levels, low=low)
    made = _close_apexes(made, mesh)
    return dataclasses.replace(made, points=mesh.world(made.points))


class LitTriangles(Protocol):
    """Triangles with a luminance that can be cut into bands and refined."""

    @property
    def triangles(self) -> Indices:
        """Indices of the corners of the current triangles."""

    def corners(self) -> Array:
        """Return the luminance at the corners of all triangles."""

    def cut(self, values: Array, steps: Steps, halvings: int) -> tuple[Bands, Indices]:
        """Return the bands, and the triangle that each polygon was cut from."""

    def measure(self, bands: Bands, triangle: Indices) -> Array:
        """Return the largest error of each polygon."""

    def peaks(self, values: Array, bound: float) -> Indices:
        """Return the triangles whose luminance exceeds that of their corners by over ``bound``."""

    def split(self, chosen: Indices) -> None:
        """Halve the edges of chosen triangles, and split their neighbours to match."""


def refine(surface: LitTriangles, levels: Levels, /, *, low: float | None = None) -> Bands:
    """Return the bands of a lit surface, refined until they keep the allowed error.

    Parameters
    ----------
    surface : LitTriangles
        Lit triangles of a solid, or :class:`vizlight.geometry.contours.facets.Facets`. They are
        split in place.
    levels, low
        Steps of luminance and the luminance without light, as for :func:`draw`.

    Returns
    -------
    Bands
        Bands with the measured error.
    """
    bound = spacing.allowed(levels)
    worst: float | None = None
    for last in (*range(ROUNDS), None):
        values = surface.corners()
        bottom = float(values.min()) if low is None else low
        steps = spacing.steps(levels, bottom, float(values.max()))
        if last is None or len(surface.triangles) > ENOUGH:
            break
        allowed = (1 + CURVED) * steps.error if bound is None else KEPT * bound
        rough, triangle = surface.cut(values, steps, ROUGH)
        if len(rough.values) > MANY:
            break
        error = surface.measure(rough, triangle)
        bad = np.unique(np.concatenate([triangle[error > allowed], surface.peaks(values, allowed)]))
        if not len(bad):
            worst = float(error.max(initial=0))
            break
        surface.split(bad)
    made, triangle = surface.cut(values, steps, banding.HALVINGS)
    if worst is None:
        worst = float(surface.measure(made, triangle).max(initial=0))
    if bound is not None and worst > bound:
        _check.warn(f"levels={bound:g} is not kept everywhere: the largest error is {worst:.3g}")
    return dataclasses.replace(made, error=worst)


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
        """Return the luminance at fractions of edges, with the normals of one side."""
        return self.light(self.place(a, b, share), patch)

    def cut(self, values: Array, steps: Steps, halvings: int) -> tuple[Bands, Indices]:
        """Return the bands, and the triangle that each polygon was cut from."""
        return banding.cut(
            self.mesh.points, self.mesh.triangles, values, steps, patch=self.mesh.patch,
            place=self.place, luminance=self.at, halvings=halvings,
        )  # fmt: skip

    def split(self, chosen: Indices) -> None:
        """Halve the edges of chosen triangles, and split their neighbours to match."""
        marked = np.zeros(len(self.codes), np.bool_)
        marked[self.edge[chosen].ravel()] = True
        a, b = np.divmod(self.codes[marked], self.size)
        new = self.place(a, b, np.full(len(a), 0.5))
        number = np.full(len(self.codes), -1)
        number[marked] = self.size + np.arange(len(a))
        triangles, owner = triangle_mesh.split(self.mesh.triangles, number[self.edge])
        self._set(
            self.mesh.replace(
                points=np.concatenate([self.mesh.points, new]),
                triangles=triangles,
                patch=self.mesh.patch[owner],
            )
        )

    def peaks(self, values: Array, bound: float) -> Indices:
        """Return the triangles whose luminance exceeds that of their corners by over ``bound``.

        A highlight may be smaller than a triangle, so each is searched at a grid of points. If
        there are many triangles, these are small and are not searched.
        """
        triangles, patch = self.mesh.triangles, self.mesh.patch
        if len(triangles) > ASKED:
            return np.empty(0, np.intp)
        top = values.max(axis=1) + bound
        found = np.zeros(len(triangles), np.bool_)
        for row in grid():
            places = np.einsum("i,tij->tj", row, self.mesh.points[triangles])
            found |= (
                self.light(
                    exact_surfaces.onto(self.mesh.surfaces, places, patch[:, None], 2), patch
                )
                > top
            )
        return np.flatnonzero(found)

    def measure(self, bands: Bands, triangle: Indices) -> Array:
        """Return the largest error of each polygon at its centre and along its edges."""
        worst = np.zeros(len(bands.values))
        for places, of in within(bands):
            patch = bands.patch[of]
            on = exact_surfaces.onto(self.mesh.surfaces, places, patch[:, np.newaxis])
            miss = np.abs(self.light(on, patch) - bands.values[of])
            worst = np.maximum(worst, largest(bands, miss))
        worst[slivers(bands, triangle, len(self.mesh.triangles))] = 0
        return worst


def grid() -> Array:
    """Return barycentric weights of points inside a triangle, one point per row."""
    steps = np.array([(i, j) for i in range(GRID) for j in range(GRID - i)]) + 0.5
    return np.column_stack([steps, GRID + 0.5 - steps.sum(axis=1)]) / (GRID + 0.5)


def within(bands: Bands) -> Iterator[tuple[Array, Indices]]:
    """Yield the points at which the error of polygons is measured, and the polygon of each."""
    middle = bands.middles()
    yield middle, np.arange(len(middle))
    size = np.diff(bands.offsets)
    owner = np.repeat(np.arange(len(size)), size)
    corner, after = bands.points[bands.corners], bands.points[bands.corners[_next(bands)]]
    for share in ALONG:
        # The points are just inside the polygon: on a contour both bands are right.
        places = corner + share * (after - corner)
        yield places + WITHIN * (middle[owner] - places), owner


def largest(bands: Bands, miss: Array) -> Array:
    """Return the largest value of each polygon, from one value per polygon or per corner."""
    if len(miss) == len(bands.values):
        return miss
    return np.asarray(np.maximum.reduceat(miss, bands.offsets[:-1]))


def slivers(bands: Bands, triangle: Indices, count: int) -> Bools:
    """Return which polygons have a negligible share of the area of their triangle."""
    owner = np.repeat(np.arange(len(bands.values)), np.diff(bands.offsets))
    # Relative to the extent: squares of tiny lengths underflow and those of huge ones overflow.
    unit = float(np.ptp(bands.points[:, :3], axis=0).max(initial=0)) or 1.0
    middle = bands.middles()[owner, :3] / unit
    corner = bands.points[bands.corners, :3] / unit
    across = np.cross(corner - middle, corner[_next(bands)] - middle)
    area = np.bincount(owner, np.sqrt(np.einsum("ij,ij->i", across, across)), len(bands.values))
    whole = np.bincount(triangle, area, count)
    return np.asarray(area <= SLIVER * whole[triangle])


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
            graph = coo_array((np.ones(around.shape[1]), tuple(around)), shape=(count, count))
            _, hole = connected_components(graph, directed=False)
            _, first, which = np.unique(hole[near], return_index=True, return_inverse=True)
            first = np.flatnonzero(near)[first]
            clusters[near] = first[which]
            points[first] = apex
    return banding.weld(bands, clusters)
