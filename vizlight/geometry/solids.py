"""One closed mesh of solids combined by union, intersection and difference.

Points are put on corners, on the curves where surfaces meet, and on the surfaces; their Delaunay
tetrahedra are inside or outside by analytic tests, and where inside meets outside is the mesh. It
is closed by construction, whatever touches or coincides.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from vizlight import _check
from vizlight.geometry import contours, meshes, primitives
from vizlight.geometry.meshes import Mesh
from vizlight.geometry.primitives import Primitive
from vizlight.geometry.surfaces import Plane, fibonacci

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight.geometry.primitives import Solid
    from vizlight.geometry.surfaces import Surface

    Array = NDArray[np.floating[Any]]
    Index = NDArray[np.intp]
    Bools = NDArray[np.bool_]

#: How far from a surface a point is asked whether it is inside; lengths are of a unit solid.
PROBE = 1e-6
#: Points farther from a surface than this are not on it.
ON = 1e-9
#: The most points: beyond, tetrahedra fill gigabytes.
MOST = 400_000


def tessellate(solid: Any, /, *, tolerance: float = 1e-3) -> Mesh:
    """Return a closed mesh of a solid.

    Parameters
    ----------
    solid : Solid
        Primitives, or what ``|``, ``&`` and ``-`` made of them.
    tolerance : float, default: 1e-3
        How far chords may be from curves and surfaces, as a share of the radius of a ball that
        holds all primitives, from 1e-6 to 0.1.

    Returns
    -------
    Mesh
        Its points are on the exact surfaces, those of edges on both to rounding. Without
        triangles if nothing is left.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, the tolerance asks for more than 400,000 points, or
        something is too thin for it: two surfaces closer than about the spacing of the points,
        ``sqrt(8 tolerance r)`` for the smallest radius r.

    Notes
    -----
    Coincident faces count once: a point is on the solid if one side of it is inside and the
    other is not, so that faces glued together vanish and faces that cancel leave nothing.
    Surfaces that touch in a point or along a line meet there. Volume and area converge with
    the tolerance. Source: Isoluminance, Further Work.
    """
    if not isinstance(solid, primitives.Solid):
        expected = "a vizlight.Sphere, Truncus, Block or what was made of them"
        raise TypeError(_check.message("solid", expected, _check.describe(solid)))
    tolerance = _check.number("tolerance", tolerance, low=1e-6, high=0.1)
    if isinstance(solid, Primitive):
        segments = max(24, math.ceil(math.pi / math.acos(1 - tolerance)))
        return meshes.mesh(solid, segments)
    parts = list(solid.primitives())
    shift, scale = _frame(parts)
    unit = _Unit(solid, [part.moved(shift, scale) for part in parts if not part.empty], parts)
    if not unit.surfaces:
        return _empty(shift, scale)
    spacing = _spacing(unit.surfaces, tolerance)
    for _ in range(3):
        found = _mesh(unit, spacing)
        if found is not None:
            triangles, patch, points = found
            signs = np.ones(len(unit.surfaces))
            mesh = Mesh(points, triangles, patch, tuple(unit.surfaces), signs, shift, scale)
            return _signed(mesh)
        spacing /= 1.7
    raise ValueError(
        _check.message(
            "tolerance", "one fine enough for the thinnest part of the solid", f"{tolerance:g}",
            "lower it, or move surfaces that nearly touch apart or onto each other",
        )
    )  # fmt: skip


class _Unit:
    """A solid in a unit ball: its surfaces, and what is inside."""

    def __init__(self, solid: Solid, parts: list[Primitive], given: list[Primitive]) -> None:
        self.solid = solid
        moved = iter(parts)
        self.parts = [None if part.empty else next(moved) for part in given]
        self.surfaces: list[Surface] = []
        self.owners: list[Primitive] = []
        for part in parts:
            for surface in part.surfaces():
                # A face of no size, as at a cone's apex, has no points.
                if not (isinstance(surface, Plane) and max(surface.extent) == 0):
                    self.surfaces.append(surface)
                    self.owners.append(part)

    def inside(self, points: Array) -> Bools:
        """Return which points are inside the solid."""
        none = np.zeros(len(points), np.bool_)
        tests = [none if part is None else part.inside(points) for part in self.parts]
        return np.asarray(self.solid.combine(iter(tests)))

    def edge(self, points: Array, which: Index) -> Bools:
        """Return which points on k surfaces each have inside and outside around them.

        Each is asked in the 2^k sectors that its surfaces make.
        """
        k = which.shape[1]
        normal = np.zeros((len(points), k, 3))
        for j in range(k):
            for i in np.unique(which[:, j]):
                on = which[:, j] == i
                normal[on, j] = self.surfaces[i].normal(points[on])
        gram = normal @ normal.transpose(0, 2, 1) + 1e-9 * np.eye(k)
        some, every = np.zeros(len(points), np.bool_), np.ones(len(points), np.bool_)
        for signs in itertools.product((-1.0, 1.0), repeat=k):
            weight = np.linalg.solve(gram, np.tile(np.array(signs)[:, None], (len(points), 1, 1)))
            step = np.einsum("nji,nj->ni", normal, weight[:, :, 0])
            step /= np.sqrt(np.einsum("ij,ij->i", step, step))[:, None]
            inside = self.inside(points + PROBE * step)
            some |= inside
            every &= inside
        return some & ~every


def _frame(parts: list[Primitive]) -> tuple[Array, float]:
    """Return the middle of all primitives, and the radius of a ball that holds them."""
    boxes = [part.box() for part in parts if not part.empty]
    if not boxes:
        return np.asarray(parts[0].box()[0]), 1.0
    low = np.min([center - radius for center, radius in boxes], axis=0)
    high = np.max([center + radius for center, radius in boxes], axis=0)
    shift = low + (high - low) / 2
    largest = max(radius for _, radius in boxes)
    # Far apart, but not so far that a primitive is lost in rounding.
    apart = max(float(np.abs(center - shift).max()) for center, _ in boxes)
    return shift, max(largest, apart)


def _spacing(surfaces: list[Surface], tolerance: float) -> float:
    """Return the distance of points that keeps chords within the tolerance of all surfaces."""
    sizes = []
    for surface in surfaces:
        if isinstance(surface, Plane):
            sizes.append(min(0.7 * min(surface.extent), 0.35))
            continue
        radius = getattr(surface, "radius", None) or max(surface.radii)  # type: ignore[union-attr]
        sizes.append(min(math.sqrt(8 * tolerance * radius), 0.6 * radius))
        height = getattr(surface, "height", None)
        if height is not None:
            sizes.append(0.7 * height)
    return min(sizes)


def _mesh(unit: _Unit, spacing: float) -> tuple[Index, Index, Array] | None:
    """Return triangles, their surfaces and points; None where they do not fit the surfaces."""
    points, on = _points(unit, spacing)
    if len(points) < 5:
        return np.empty((0, 3), np.intp), np.empty(0, np.intp), np.empty((0, 3))
    # Points on planes, circles and spheres are degenerate for Delaunay; moved by a little at
    # random they are not, and any choice among tetrahedra without volume is as good.
    random = np.random.default_rng(1990)
    moved = points + 1e-4 * spacing * random.standard_normal(points.shape)
    tetrahedra = Delaunay(moved)
    cells = tetrahedra.simplices.astype(np.intp)
    inside = _inside(unit, points[cells], spacing)
    beyond = tetrahedra.neighbors
    open_face = inside[:, np.newaxis] & ((beyond < 0) | ~inside[beyond])
    cell, slot = np.nonzero(open_face)
    faces = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    triangles = cells[cell[:, np.newaxis], faces[slot]]
    a, b, c = (moved[cells[:, i]] - moved[cells[:, 3]] for i in range(3))
    turned = (np.einsum("ij,ij->i", np.cross(a, b), c) < 0)[cell]
    triangles[turned] = triangles[turned][:, ::-1]
    # Corner 3 is where the determinant looks from: positive means faces as listed look inward.
    triangles = triangles[:, ::-1]
    patch, fits = _patches(unit, points, triangles, on, spacing)
    if not fits:
        return None
    used, triangles = np.unique(triangles, return_inverse=True)
    return triangles.reshape(-1, 3).astype(np.intp), patch, points[used]


def _inside(unit: _Unit, corners: Array, spacing: float) -> Bools:
    """Return which tetrahedra are inside."""
    center = corners.mean(axis=1)
    inside = unit.inside(center)
    a, b, c = (corners[:, i] - corners[:, 3] for i in range(3))
    flat = np.abs(np.einsum("ij,ij->i", np.cross(a, b), c)) < 1e-7 * spacing**3
    # One without volume may lie in a face: it is inside only if both its sides are.
    a, b, c, center = a[flat], b[flat], c[flat], center[flat]
    sides = np.stack([np.cross(a, b), np.cross(b, c), np.cross(c, a)], axis=1)
    size = np.einsum("ijk,ijk->ij", sides, sides)
    widest = sides[np.arange(len(sides)), size.argmax(axis=1)]
    widest /= np.sqrt(np.maximum(size.max(axis=1, initial=0), 1e-300))[:, np.newaxis]
    inside[flat] = unit.inside(center + PROBE * widest) & unit.inside(center - PROBE * widest)
    return inside


def _points(unit: _Unit, spacing: float) -> tuple[Array, Bools]:
    """Return points on the solid: corners, edges and faces; and which surfaces each is on."""
    fine = [surface.samples(spacing / 2) for surface in unit.surfaces]
    if sum(map(len, fine)) > 4 * MOST:
        raise ValueError(
            _check.message(
                "tolerance", f"one that {MOST} points can keep",
                f"a spacing of {spacing:g} of the solid's size", "raise it",
            )
        )  # fmt: skip
    edges, pairs = _meetings(unit, fine, spacing)
    corners = _corners(unit, edges, pairs, spacing)
    for surface in unit.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is None:
            continue
        ring = apex + PROBE * fibonacci(26)
        inside = unit.inside(ring)
        if inside.any() and not inside.all():
            corners = np.concatenate([corners, apex[np.newaxis]])
    corners = _thin(corners, 1e-5)
    lines = _thin(_away(edges, corners, 0.5 * spacing), 0.5 * spacing)
    faces: list[Array] = []
    for i, surface in enumerate(unit.surfaces):
        found = surface.samples(spacing)
        found = found[unit.edge(found, np.full((len(found), 1), i))]
        faces.append(_away(_away(found, edges, 0.7 * spacing), corners, 0.7 * spacing))
    # Where faces of two primitives coincide their points come twice.
    points = np.concatenate([corners, lines, _thin(np.concatenate(faces), 0.6 * spacing)])
    on = np.stack([np.abs(s.distance(points)) < 1e3 * ON for s in unit.surfaces], axis=1)
    return points, on


def _meetings(unit: _Unit, fine: list[Array], spacing: float) -> tuple[Array, Index]:
    """Return points of the curves where two surfaces meet, densely, and which two."""
    found: list[Array] = [np.empty((0, 3))]
    pairs: list[Index] = [np.empty((0, 2), np.intp)]
    for i, j in itertools.permutations(range(len(unit.surfaces)), 2):
        first, second = unit.surfaces[i], unit.surfaces[j]
        start = fine[i][np.abs(second.distance(fine[i])) < spacing]
        if not len(start):
            continue
        both = np.tile([0, 1], (len(start), 1))
        places = contours.onto((first, second), start, both, rounds=8)
        step = places - start
        good = np.abs(first.distance(places)) + np.abs(second.distance(places)) < ON
        good &= np.einsum("ij,ij->i", step, step) < (3 * spacing) ** 2
        # Surfaces that coincide do not cross: no curve.
        cross = np.cross(first.normal(places), second.normal(places))
        good &= np.einsum("ij,ij->i", cross, cross) > 1e-12
        places = places[good]
        both = np.tile([i, j], (len(places), 1))
        real = unit.edge(places, both)
        found.append(places[real])
        pairs.append(both[real])
    return np.concatenate(found), np.concatenate(pairs).astype(np.intp)


def _corners(unit: _Unit, edges: Array, pairs: Index, spacing: float) -> Array:
    """Return the points where three surfaces meet."""
    found = [np.empty((0, 3))]
    for k, third in enumerate(unit.surfaces):
        near = (np.abs(third.distance(edges)) < 1.5 * spacing) & ~np.any(pairs == k, axis=1)
        start = edges[near]
        which = np.column_stack([pairs[near], np.full(len(start), k)])
        if not len(start):
            continue
        places = contours.onto(tuple(unit.surfaces), start, which, rounds=12)
        step = places - start
        good = np.einsum("ij,ij->i", step, step) < (4 * spacing) ** 2
        missing = np.zeros(len(places))
        normal = np.zeros((len(places), 3, 3))
        for j in range(3):
            for i in np.unique(which[:, j]):
                rows = which[:, j] == i
                missing[rows] += np.abs(unit.surfaces[i].distance(places[rows]))
                normal[rows, j] = unit.surfaces[i].normal(places[rows])
        good &= (missing < ON) & (np.abs(np.linalg.det(normal)) > 1e-3)
        places, which = places[good], which[good]
        found.append(places[unit.edge(places, which)])
    return np.concatenate(found)


def _away(points: Array, others: Array, radius: float) -> Array:
    """Return the points that are farther than a radius from all others."""
    if not len(points) or not len(others):
        return points
    gap, _ = cKDTree(others).query(points, distance_upper_bound=radius)
    return np.asarray(points[np.isinf(gap)])


def _thin(points: Array, radius: float) -> Array:
    """Return points no two of which are within a radius, and none of which could be added."""
    if not len(points):
        return points
    points = points[np.unique(np.round(points / (1e-3 * radius)), axis=0, return_index=True)[1]]
    pairs = cKDTree(points).query_pairs(radius, output_type="ndarray")
    rank = np.random.default_rng(1990).permutation(len(points))
    state = np.zeros(len(points), np.int8)
    while np.any(state == 0):
        # Of the points left, those that come before all their neighbours stay.
        live = (state[pairs] == 0).all(axis=1)
        pairs = pairs[live]
        a, b = pairs.T
        beaten = np.zeros(len(points), np.bool_)
        beaten[np.where(rank[a] > rank[b], a, b)] = True
        state[(state == 0) & ~beaten] = 1
        lost = state[pairs] == 1
        state[pairs[lost[:, 0], 1]] = 2
        state[pairs[lost[:, 1], 0]] = 2
    return np.asarray(points[state == 1])


def _patches(
    unit: _Unit, points: Array, triangles: Index, on: Bools, spacing: float
) -> tuple[Index, bool]:
    """Return the surface of each triangle, and whether all triangles fit theirs."""
    corners = points[triangles]
    center = corners.mean(axis=1)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.sqrt(np.einsum("ij,ij->i", across, across))
    across /= np.where(size > 0, size, 1)[:, np.newaxis]
    best = np.full(len(triangles), np.inf)
    patch = np.zeros(len(triangles), np.intp)
    for i, surface in enumerate(unit.surfaces):
        lean = 1 - np.abs(np.einsum("ij,ij->i", surface.normal(center), across))
        # Corners on a surface decide, then the middle, then the way it faces; what has no area
        # faces nowhere.
        off = 3 - np.count_nonzero(on[triangles, i], axis=1)
        score = 10.0 * off + np.abs(surface.distance(center)) / spacing
        score += 0.1 * np.where(size > 1e-4 * spacing**2, lean, 0)
        patch = np.where(score < best, i, patch)
        best = np.minimum(score, best)
    # Where two surfaces touch, triangles across both are as close to each as any other.
    stray = np.count_nonzero((best > 9) & (best % 10 > 0.05) & (size > 1e-4 * spacing**2))
    return patch, bool(stray <= 0.002 * len(triangles))


def _signed(mesh: Mesh) -> Mesh:
    """Return the mesh with the sign of each surface; one used from both sides becomes two."""
    corners = mesh.points[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = contours.normals_of(mesh, corners.mean(axis=1), mesh.patch)
    outward = np.einsum("ij,ij->i", normal, across) >= 0
    # A triangle without area faces as its surface mostly does.
    area = np.sqrt(np.einsum("ij,ij->i", across, across))
    weight = np.where(outward, area, -area)
    total = np.bincount(mesh.patch, weight, len(mesh.surfaces))
    flat = area < 1e-9
    outward[flat] = total[mesh.patch[flat]] >= 0
    count = len(mesh.surfaces)
    return mesh.replace(
        patch=np.where(outward, mesh.patch, mesh.patch + count),
        surfaces=(*mesh.surfaces, *mesh.surfaces),
        signs=np.concatenate([np.ones(count), -np.ones(count)]),
    )


def _empty(shift: Array, scale: float) -> Mesh:
    none = np.empty(0, np.intp)
    return Mesh(np.empty((0, 3)), np.empty((0, 3), np.intp), none, (), np.empty(0), shift, scale)
