"""One closed mesh of solids combined by union, intersection and difference.

Points are placed at corners, on the curves where surfaces meet, and on the surfaces. Analytic
tests decide which of their Delaunay tetrahedra are inside; the mesh is the boundary between inside
and outside. It is closed by construction, also where surfaces touch or coincide.
"""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from vizlight import _check
from vizlight.geometry.contours import refinement
from vizlight.geometry.solids import sampling, triangle_mesh
from vizlight.geometry.solids.exact_surfaces import Ball, Plane
from vizlight.geometry.solids.primitives import EXPECTED, Block, Frustum, Solid, Sphere
from vizlight.geometry.solids.sampling import PROBE, Size, Unit
from vizlight.geometry.solids.triangle_mesh import Mesh

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.solids.exact_surfaces import Surface
    from vizlight.geometry.solids.primitives import Primitive


__all__ = ["tessellate"]

#: Divisors of the spacing that are tried where a thin wall or gap is not resolved, and the
#: largest number of points of such a trial.
FINER, PATIENCE = (1.7, 2.9, 5.0, 8.5, 14.0, 24.0), 60_000
#: Largest number of points with one spacing for all surfaces.
PLENTY = 15_000
#: Smallest spacing that narrow faces ask for, as a share of the solid's size; finer ones are
#: tried if it does not suffice.
NARROW = 0.05
#: Random displacement of points before the Delaunay tetrahedralisation, in units of spacing.
JOGGLE = 1e-7
#: Height, in units of spacing, below which a tetrahedron takes the side of its neighbours.
FLAT = 1e-3
#: Distance from a surface, in units of the tolerance, below which corners decide the side.
HUG = 1


def tessellate(solid: Solid, /, *, tolerance: float = 3e-3) -> Mesh:
    """Return a closed mesh of a solid.

    Parameters
    ----------
    solid : Solid
        Primitive, or a combination of primitives by ``|``, ``&`` and ``-``.
    tolerance : float, default: 3e-3
        Largest distance of triangles from curves and surfaces, as a share of the radius of a ball
        that contains all primitives, from 1e-6 to 0.1.

    Returns
    -------
    Mesh
        Mesh with points on the exact surfaces; points of an edge are on both surfaces to
        rounding. An empty solid has no triangles.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, if the tolerance needs more than 400,000 points, or if a wall
        or gap is too thin to be resolved by any spacing that needs fewer than 60,000 points.

    Notes
    -----
    A point belongs to the surface of the solid if one side of it is inside and the other is not.
    Coincident faces therefore count once: shared faces of joined solids are removed, and the
    difference of equal solids is empty. Surfaces that touch in a point or along a line meet
    there. Points are ``sqrt(2 tolerance r)`` apart on a surface of radius r; the spacing grows
    with the distance from a small surface. Finer points are tried for thin walls and gaps. Volume
    and area converge with the tolerance. Source: Isoluminance, Further Work.
    """
    if not isinstance(solid, Solid):
        raise TypeError(_check.message("solid", EXPECTED, _check.describe(solid)))
    tolerance = _check.number("tolerance", tolerance, low=1e-6, high=0.1)
    if isinstance(solid, Sphere | Frustum | Block):
        segments = max(24, math.ceil(math.pi / math.acos(1 - tolerance)))
        return triangle_mesh.mesh(solid, segments)
    parts = list(solid.primitives())
    shift, scale = _frame(parts)
    unit = Unit(solid, [part.moved(shift, scale) for part in parts if not part.empty], parts)
    if not unit.surfaces:
        return _empty(shift, scale)
    need = np.array([_spacing(surface, tolerance) for surface in unit.surfaces])
    # A spacing that would need too many points is used only near the surfaces that need it.
    area = sum(surface.area for surface in unit.surfaces)
    coarse = max(float(need.min()), math.sqrt(area / PLENTY))
    for attempt, finer in enumerate((1.0, 1.0, *FINER)):
        if attempt > 1 and sampling.estimate(unit.surfaces, coarse / finer) > PATIENCE:
            break
        size = Size(unit, coarse / finer, need)
        found = _mesh(unit, size, tolerance, attempt)
        if found is not None:
            triangles, patch, points = found
            signs = np.ones(len(unit.surfaces))
            mesh = Mesh(points, triangles, patch, tuple(unit.surfaces), signs, shift, scale)
            return _signed(mesh)
    raise ValueError(
        _check.message(
            "tolerance", "a value small enough for the thinnest part of the solid",
            f"{tolerance:g}", "lower it, or separate or join surfaces that nearly touch",
        )
    )  # fmt: skip


def _frame(parts: list[Primitive]) -> tuple[Array, float]:
    """Return the centre of all primitives and the length that becomes the unit."""
    boxes = [part.box() for part in parts if not part.empty]
    if not boxes:
        return np.asarray(parts[0].box()[0]), 1.0
    low = np.min([center - radius for center, radius in boxes], axis=0)
    high = np.max([center + radius for center, radius in boxes], axis=0)
    shift = low + (high - low) / 2
    largest = max(radius for _, radius in boxes)
    # The distance of primitives counts too: all of them stay near the unit ball.
    apart = max(float(np.abs(center - shift).max()) for center, _ in boxes)
    return shift, max(largest, apart)


def _spacing(surface: Surface, tolerance: float) -> float:
    """Return the spacing of points that keeps chords within the tolerance of a surface."""
    if isinstance(surface, Plane):
        return min(max(0.7 * min(surface.extent), NARROW), 6.4 * math.sqrt(tolerance))
    radius = surface.radius if isinstance(surface, Ball) else max(surface.radii)
    found = min(math.sqrt(2 * tolerance * radius), 0.6 * radius)
    return found if isinstance(surface, Ball) else min(found, max(0.7 * surface.height, NARROW))


def _mesh(
    unit: Unit, size: Size, tolerance: float, attempt: int
) -> tuple[Indices, Indices, Array] | None:
    """Return triangles, their surfaces and points; None if they do not fit the surfaces."""
    random = np.random.default_rng([1990, attempt])
    points, on = sampling.points(unit, size, random)
    if len(points) < 5:
        return np.empty((0, 3), np.intp), np.empty(0, np.intp), np.empty((0, 3))
    # Points on planes, circles and spheres are degenerate for Delaunay; small random displacements
    # avoid this, and any choice among tetrahedra without volume is equally good.
    moved = points + JOGGLE * size.of(points)[:, np.newaxis] * random.standard_normal(points.shape)
    tetrahedra = Delaunay(moved)
    cells = tetrahedra.simplices.astype(np.intp)
    spacing = size.of(points[cells].mean(axis=1))
    inside = _inside(unit, points, on, cells, spacing, tolerance, random)
    beyond = np.asarray(tetrahedra.neighbors, dtype=np.intp)
    _smooth(inside, points[cells], beyond, spacing, random)
    open_face = inside[:, np.newaxis] & ((beyond < 0) | ~inside[beyond])
    cell, slot = np.nonzero(open_face)
    faces = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    triangles = cells[cell[:, np.newaxis], faces[slot]]
    a, b, c = (moved[cells[:, i]] - moved[cells[:, 3]] for i in range(3))
    turned = (np.einsum("ij,ij->i", np.cross(a, b), c) < 0)[cell]
    triangles[turned] = triangles[turned][:, ::-1]
    # Seen from corner 3: with a positive determinant the faces as listed are oriented inward.
    triangles = triangles[:, ::-1]
    patch, fits = _patches(unit, points, triangles, on, size, tolerance)
    # A point without triangles belongs to a wall or gap that tetrahedra cross.
    lost = len(points) - len(np.unique(triangles))
    if not fits or lost > max(2, 0.003 * len(points)):
        return None
    partner = _partners(cells, beyond, inside, cell, slot, triangles)
    corner = _sheets(partner)
    _, first = np.unique(corner, return_index=True)
    places = points[triangles.ravel()[first]]
    # A pair of points may still have two edges, each with its own two triangles: all but the
    # first edge get a point in the middle.
    ends = np.sort(np.stack([corner, np.roll(corner, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    own = np.minimum(np.arange(corner.size), partner.ravel())
    edge, one, which = np.unique(own, return_index=True, return_inverse=True)
    _, once = np.unique(ends[one], axis=0, return_index=True)
    again = np.setdiff1d(np.arange(len(edge)), once)
    number = np.full(len(edge), -1)
    number[again] = len(places) + np.arange(len(again))
    middle = places[ends[one][again]].mean(axis=1)
    both = np.stack([patch[one[again] // 3], patch[partner.ravel()[one[again]] // 3]], axis=1)
    middle = refinement.onto(tuple(unit.surfaces), middle, both)
    corner, owner = refinement.split(corner, number[which.reshape(-1, 3)])
    return _thick(corner, patch[owner], np.concatenate([places, middle]), size)


def _thick(
    triangles: Indices, patch: Indices, points: Array, size: Size
) -> tuple[Indices, Indices, Array]:
    """Return a mesh without connected parts of negligible height, as tetrahedra along a line."""
    a, b, c = triangles.T
    links = np.concatenate([np.stack([a, b]), np.stack([b, c])], axis=1)
    graph = coo_array((np.ones(links.shape[1], np.bool_), tuple(links)), shape=(len(points),) * 2)
    count, part = connected_components(graph, directed=False)
    if count > 1:
        corners = points[triangles] - points.mean(axis=0)
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.sqrt(np.einsum("ij,ij->i", across, across))
        volume = np.einsum("ij,ij->i", across, corners[:, 0])
        height = FLAT * area * size.of(points[a])
        volume, height = (np.bincount(part[a], x, count) for x in (volume, height))
        kept = (np.abs(volume) > height)[part[a]]
        used, place = np.unique(triangles[kept], return_inverse=True)
        triangles, patch, points = place.reshape(-1, 3).astype(np.intp), patch[kept], points[used]
    return triangles, patch, points


def _partners(
    cells: Indices, beyond: Indices, inside: Bools, cell: Indices, slot: Indices, triangles: Indices
) -> Indices:
    """Return the partner of the edge that begins at each corner, as 3 triangle + corner.

    The partner is the edge of the triangle that bounds the same wedge of the inside, so that
    exactly two triangles share an edge, also where a solid touches itself.
    """
    face = np.full(cells.size, -1)
    face[cell * 4 + slot] = np.arange(len(cell))
    partners = np.empty((len(cell), 3), np.intp)
    for start in range(3):
        # Rotate about the edge through the inside, from tetrahedron to tetrahedron.
        third = triangles[:, (start + 2) % 3]
        tetrahedron, left = cell.copy(), slot.copy()
        over = np.argmax(cells[tetrahedron] == third[:, np.newaxis], axis=1)
        going = np.arange(len(cell))
        while len(going):
            ahead = beyond[tetrahedron[going], over[going]]
            going = going[(ahead >= 0) & inside[ahead]]
            at = tetrahedron[going]
            ahead, kept = beyond[at, over[going]], cells[at, left[going]]
            over[going] = np.argmax(cells[ahead] == kept[:, np.newaxis], axis=1)
            left[going] = np.argmax(beyond[ahead] == at[:, np.newaxis], axis=1)
            tetrahedron[going] = ahead
        other = face[tetrahedron * 4 + over]
        # The partner runs in the opposite direction: it begins where this edge ends.
        end = triangles[:, (start + 1) % 3]
        begins = np.argmax(triangles[other] == end[:, np.newaxis], axis=1)
        partners[:, start] = 3 * other + begins
    return partners


def _sheets(partners: Indices) -> Indices:
    """Return triangles with corners renumbered by connection across partner edges.

    Where a solid touches itself in an edge or a corner, each part gets its own copy of the points.
    """
    here = np.arange(partners.size)
    there = partners.ravel()
    after, beyond = (3 * (i // 3) + (i + 1) % 3 for i in (here, there))
    links = np.concatenate([np.stack([here, beyond]), np.stack([after, there])], axis=1)
    graph = coo_array((np.ones(links.shape[1], np.bool_), tuple(links)), shape=(len(here),) * 2)
    _, number = connected_components(graph, directed=False)
    return np.asarray(number, dtype=np.intp).reshape(-1, 3)


def _inside(
    unit: Unit,
    points: Array,
    on: Bools,
    cells: Indices,
    spacing: Array,
    tolerance: float,
    random: np.random.Generator,
) -> Bools:
    """Return which tetrahedra are inside.

    Each is tested at a random interior point: the mean of corners that lie symmetrically about a
    face would be on that face. Where that point is close to a surface the corners decide, because
    the space between surfaces that touch is thinner than the error of chords.
    """
    weight = 1 + random.uniform(-0.2, 0.2, cells.shape)
    corners = points[cells]
    center = np.einsum("ij,ijk->ik", weight / weight.sum(axis=1)[:, np.newaxis], corners)
    found: list[Bools] = []
    for i, surface in enumerate(unit.surfaces):
        side = surface.distance(center)
        gap = surface.distance(points)
        gap[on[:, i]] = 0
        low, high = gap[cells].min(axis=1), gap[cells].max(axis=1)
        hug = np.abs(side) < HUG * tolerance
        side[hug & (low < 0) & (high <= 0)] = -1
        side[hug & (low >= 0) & (high > 0)] = 1
        found.append(side < 0)
    inside = unit.combine(found)
    a, b, c = (corners[:, i] - corners[:, 3] for i in range(3))
    flat = np.abs(np.einsum("ij,ij->i", np.cross(a, b), c)) < 1e-7 * spacing**3
    # A tetrahedron without volume may lie in a face: it is inside only if both sides are.
    a, b, c, center = a[flat], b[flat], c[flat], center[flat]
    sides = np.stack([np.cross(a, b), np.cross(b, c), np.cross(c, a)], axis=1)
    size = np.einsum("ijk,ijk->ij", sides, sides)
    widest = sides[np.arange(len(sides)), size.argmax(axis=1)]
    widest /= np.sqrt(np.maximum(size.max(axis=1, initial=0), 1e-300))[:, np.newaxis]
    inside[flat] = unit.inside(center + PROBE * widest) & unit.inside(center - PROBE * widest)
    return inside


def _smooth(
    inside: Bools, corners: Array, beyond: Indices, spacing: Array, random: np.random.Generator
) -> None:
    """Assign flat tetrahedra in place to the side that most of their face area borders on.

    They lie on a surface, and either side is correct, but a mixture of both would be folded.
    """
    opposite = np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])
    a, b, c = (corners[:, opposite[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    area = np.sqrt(np.einsum("ijk,ijk->ij", across, across))
    volume = np.abs(np.einsum("ij,ij->i", across[:, 0], corners[:, 0] - corners[:, 1]))
    thin = np.flatnonzero(volume < FLAT * spacing * area.max(axis=1))
    for _ in range(40):
        side = (beyond[thin] >= 0) & inside[beyond[thin]]
        wanted = (area[thin] * np.where(side, 1, -1)).sum(axis=1)
        turn = np.where(inside[thin], wanted < 0, wanted > 0)
        if not np.any(turn):
            break
        # Only a random half changes at a time: neighbours would alternate for ever.
        turn &= random.random(len(thin)) < 0.5
        inside[thin[turn]] ^= True


def _patches(
    unit: Unit, points: Array, triangles: Indices, on: Bools, size: Size, tolerance: float
) -> tuple[Indices, bool]:
    """Return the surface of each triangle, and whether the triangles fit their surfaces."""
    corners = points[triangles]
    center = corners.mean(axis=1)
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = np.sqrt(np.einsum("ij,ij->i", across, across))
    across /= np.where(area > 0, area, 1)[:, np.newaxis]
    spacing = size.of(center)
    best = np.full(len(triangles), np.inf)
    patch = np.zeros(len(triangles), np.intp)
    for i, surface in enumerate(unit.surfaces):
        lean = 1 - np.abs(np.einsum("ij,ij->i", surface.normal(center), across))
        # Corners on a surface decide, then the distance of the centre, then the orientation,
        # which a triangle without area lacks.
        off = 3 - np.count_nonzero(on[triangles, i], axis=1)
        score = 10.0 * off + np.abs(surface.distance(center)) / spacing
        score += 0.1 * np.where(area > 1e-4 * spacing**2, lean, 0)
        patch = np.where(score < best, i, patch)
        best = np.minimum(score, best)
    # A triangle whose corners share no surface cuts off an edge or crosses a wall or gap; a few
    # occur where two surfaces touch.
    stray = np.flatnonzero(best > 9)
    stray = stray[~_tangent(unit, corners[stray], across[stray], on[triangles[stray]], tolerance)]
    return patch, bool(area[stray].sum() <= 0.004 * area.sum())


def _tangent(unit: Unit, corners: Array, across: Array, on: Bools, tolerance: float) -> Bools:
    """Return which triangles lie where surfaces touch: within the tolerance of one of them.

    The solid is on the same side at all three corners, which is not so in a thin wall.
    """
    near = np.zeros(len(corners), np.bool_)
    alike = np.zeros(corners.shape[:2], np.bool_)
    flat = corners.reshape(-1, 3)
    for i, surface in enumerate(unit.surfaces):
        near |= (np.abs(surface.distance(flat)).reshape(-1, 3) < tolerance).all(axis=1)
        normal = surface.normal(flat)
        beyond, before = unit.inside(flat + PROBE * normal), unit.inside(flat - PROBE * normal)
        outward = (before.astype(int) - beyond).reshape(-1, 3)
        lean = np.einsum("ijk,ik->ij", normal.reshape(-1, 3, 3), across)
        alike |= on[:, :, i] & (outward * lean > 0.5)
    return near & alike.all(axis=1)


def _signed(mesh: Mesh) -> Mesh:
    """Return the mesh with surface signs; a surface that is used from both sides is doubled."""
    corners = mesh.points[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = refinement.normals_of(mesh, corners.mean(axis=1), mesh.patch)
    outward = np.einsum("ij,ij->i", normal, across) >= 0
    # A triangle without area takes the orientation of most of its surface.
    area = np.sqrt(np.einsum("ij,ij->i", across, across))
    weight = np.where(outward, area, -area)
    total = np.bincount(mesh.patch, weight, len(mesh.surfaces))
    flat = area < 1e-9
    outward[flat] = total[mesh.patch[flat]] >= 0
    count = len(mesh.surfaces)
    return dataclasses.replace(
        mesh,
        patch=np.where(outward, mesh.patch, mesh.patch + count),
        surfaces=(*mesh.surfaces, *mesh.surfaces),
        signs=np.concatenate([np.ones(count), -np.ones(count)]),
    )


def _empty(shift: Array, scale: float) -> Mesh:
    none = np.empty(0, np.intp)
    return Mesh(np.empty((0, 3)), np.empty((0, 3), np.intp), none, (), np.empty(0), shift, scale)
