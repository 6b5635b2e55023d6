"""Points of a faceted solid moved onto its exact surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.solids import triangle_mesh
from vizlight.geometry.solids.exact_surfaces import Plane, onto

if TYPE_CHECKING:
    from vizlight._types import Bools, Indices
    from vizlight.geometry.solids.triangle_mesh import Mesh

#: Length of the part of a normal that is independent of other normals at a point: below it two
#: surfaces count as touching.
LEAN = 0.02
#: Largest distance that a point is moved, in units of the tolerance.
REACH = 20
#: Rounds in which the points of flipped triangles are moved between their neighbours.
ROUNDS = 12
#: Distance below which neighbouring points are one point.
SAME = 1e-9
#: Longest edge of curved surfaces, in units of the square root of the tolerance.
LONGEST = 2.5
#: Largest number of times that an edge is halved.
HALVINGS = 8


def place(mesh: Mesh, tolerance: float) -> Mesh:
    """Return a mesh with its points on all the exact surfaces that meet in them.

    Parameters
    ----------
    mesh : Mesh
        Closed mesh whose points are within about the tolerance of their surfaces.
    tolerance : float
        Largest distance of the surfaces from the triangles.

    Returns
    -------
    Mesh
        Mesh with each point on one surface, on two at a crease or on three at a corner, to
        rounding. Where two surfaces touch, a point is on one of them. Triangles that this would
        flip are made upright by moving their points along their surfaces and creases. Long edges
        of curved surfaces are halved.
    """
    which, fixed = _meeting(mesh)
    points = onto(mesh.surfaces, mesh.points, which, 8)
    moved = points - mesh.points
    far = np.einsum("ij,ij->i", moved, moved) > (REACH * tolerance) ** 2
    which[far] = which[far][:, :1]
    fixed |= far
    points[far] = onto(mesh.surfaces, mesh.points[far], which[far], 8)
    for surface in mesh.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is not None:
            points[np.abs(points - apex).max(axis=1) < SAME] = apex
    mesh = _upright(mesh.replace(points, mesh.triangles, mesh.patch), which, fixed)
    return _shorten(_merge(mesh), LONGEST * tolerance**0.5)


def _meeting(mesh: Mesh) -> tuple[Indices, Bools]:
    """Return up to three independent surfaces of each point, and which points have others too.

    Fewer than three surfaces are repeated.
    """
    count = len(mesh.points)
    pairs = np.stack(np.divmod(_incidence(mesh), len(mesh.surfaces)), axis=1)
    start = np.searchsorted(pairs[:, 0], np.arange(count + 1))
    several = np.diff(start)
    which = np.repeat(pairs[start[:-1], 1][:, np.newaxis], 3, axis=1)
    found = np.zeros(count, np.intp)
    basis = np.zeros((count, 3, 3))
    for k in range(several.max(initial=0)):
        rows = np.flatnonzero((several > k) & (found < 3))
        patch = pairs[start[rows] + k, 1]
        normal = triangle_mesh.normals_of(mesh, mesh.points[rows], patch)
        along = np.einsum("nij,nj->ni", basis[rows], normal)
        rest = normal - np.einsum("ni,nij->nj", along, basis[rows])
        size = np.sqrt(np.einsum("ij,ij->i", rest, rest))
        new = size > LEAN
        rows, slot = rows[new], found[rows[new]]
        which[rows, slot] = patch[new]
        basis[rows, slot] = rest[new] / size[new][:, np.newaxis]
        found[rows] += 1
    return which, found < several


def _incidence(mesh: Mesh) -> Indices:
    """Return the sorted codes ``point * number of surfaces + surface`` of all triangles."""
    return np.unique(mesh.triangles * len(mesh.surfaces) + mesh.patch[:, np.newaxis])


def flipped(mesh: Mesh) -> Bools:
    """Return the triangles whose normal points into the solid."""
    corners = mesh.points[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = triangle_mesh.normals_of(mesh, corners.mean(axis=1), mesh.patch)
    return np.asarray(np.einsum("ij,ij->i", across, normal) < 0)


def _upright(mesh: Mesh, which: Indices, fixed: Bools) -> Mesh:
    """Move points of flipped triangles between their neighbours, along surfaces and creases."""
    count, surfaces = len(mesh.points), len(mesh.surfaces)
    known = _incidence(mesh)
    start, stop = mesh.triangles.ravel(), np.roll(mesh.triangles, -1, axis=1).ravel()
    # A point of a crease stays on it: only neighbours on the same surfaces count.
    alike = np.ones(len(start), np.bool_)
    for k in range(3):
        alike &= np.isin(stop * surfaces + which[start, k], known)
    start, stop = start[alike], stop[alike]
    neighbours = np.bincount(start, minlength=count)
    free = (which[:, 2] == which[:, 0]) & (neighbours > 1) & ~fixed
    best, fewest = mesh, count
    for _ in range(ROUNDS):
        bad = flipped(mesh)
        if np.count_nonzero(bad) < fewest:
            best, fewest = mesh, int(np.count_nonzero(bad))
        if not fewest:
            break
        corners = np.unique(mesh.triangles[bad])
        moving = corners[free[corners]]
        total = [np.bincount(start, x, count)[moving] for x in mesh.points[stop].T]
        middle = np.stack(total, axis=1) / neighbours[moving][:, np.newaxis]
        points = mesh.points.copy()
        points[moving] = onto(mesh.surfaces, middle, which[moving], 8)
        mesh = mesh.replace(points, mesh.triangles, mesh.patch)
    return best


def _merge(mesh: Mesh) -> Mesh:
    """Return the mesh with equal neighbouring points merged, where it stays closed."""
    ends = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1)
    gap = np.abs(np.diff(mesh.points[ends], axis=2)).max(axis=(2, 3))
    short = ends[gap < SAME]
    if not len(short):
        return mesh
    number = np.arange(len(mesh.points))
    for _ in range(len(short)):
        low = np.minimum(*number[short].T)
        before = number.copy()
        np.minimum.at(number, number[short].ravel(), np.repeat(low, 2))
        number = number[number]
        if np.array_equal(number, before):
            break
    triangles = number[mesh.triangles]
    kept = np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)
    triangles = triangles[kept]
    edges = triangles * len(number) + np.roll(triangles, -1, axis=1)
    if len(np.unique(edges)) < edges.size:
        return mesh
    used, triangles = np.unique(triangles, return_inverse=True)
    return mesh.replace(mesh.points[used], triangles.reshape(-1, 3), mesh.patch[kept])


def _shorten(mesh: Mesh, longest: float) -> Mesh:
    """Halve the rulings of cones and cylinders that are longer than ``longest``.

    The middle of a ruling is on the surface: the triangles keep their shape.
    """
    curved = np.array([not isinstance(surface, Plane) for surface in mesh.surfaces])
    for _ in range(HALVINGS):
        count = len(mesh.points)
        start, stop = mesh.triangles, np.roll(mesh.triangles, -1, axis=1)
        code = np.minimum(start, stop) * count + np.maximum(start, stop)
        gap = mesh.points[start] - mesh.points[stop]
        far = np.einsum("ijk,ijk->ij", gap, gap) > longest**2
        row, slot = np.nonzero(far & curved[mesh.patch][:, np.newaxis])
        middle = (mesh.points[start[row, slot]] + mesh.points[stop[row, slot]]) / 2
        on = np.zeros(len(row), np.bool_)
        for patch in np.unique(mesh.patch[row]):
            mine = mesh.patch[row] == patch
            on[mine] = np.abs(mesh.surfaces[patch].distance(middle[mine])) < SAME
        marked, first = np.unique(code[row[on], slot[on]], return_index=True)
        if not len(marked):
            break
        place = np.minimum(np.searchsorted(marked, code), len(marked) - 1)
        number = np.where(marked[place] == code, count + place, -1)
        triangles, of = triangle_mesh.split(mesh.triangles, number)
        patch = mesh.patch[row[on][first]][:, np.newaxis]
        new = onto(mesh.surfaces, middle[on][first], patch)
        mesh = mesh.replace(np.concatenate([mesh.points, new]), triangles, mesh.patch[of])
    return mesh
