"""Points of a faceted solid moved onto its exact surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.solids import repair, triangle_mesh
from vizlight.geometry.solids.exact_surfaces import Plane, onto

if TYPE_CHECKING:
    from vizlight._types import Array, Indices
    from vizlight.geometry.solids.triangle_mesh import Mesh

#: Length of the part of a normal that is independent of other normals at a point: below it two
#: surfaces count as touching.
LEAN = 0.02
#: Largest distance that a point is moved, in units of the tolerance.
REACH = 20
#: Rounds of Newton's method, and more of them where surfaces nearly touch.
ROUNDS, MORE = 8, 40
#: Distance below which neighbouring points are one point.
SAME = 1e-9
#: Distance from a surface above which a point has not converged.
NEAR = 1e-13
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
        flip are removed by changes of their edges. Long edges of curved surfaces are halved.
    """
    which = _meeting(mesh)
    points = onto(mesh.surfaces, mesh.points, which, ROUNDS)
    off = np.flatnonzero(_residual(mesh, points, which) > NEAR)
    points[off] = onto(mesh.surfaces, points[off], which[off], MORE)
    moved = points - mesh.points
    far = np.einsum("ij,ij->i", moved, moved) > (REACH * tolerance) ** 2
    far[off] |= _residual(mesh, points[off], which[off]) > SAME
    points[far] = onto(mesh.surfaces, mesh.points[far], which[far][:, :1], ROUNDS)
    for surface in mesh.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is not None:
            points[np.abs(points - apex).max(axis=1) < SAME] = apex
    mesh = repair.upright(_merge(mesh.replace(points, mesh.triangles, mesh.patch)))
    return _shorten(mesh, LONGEST * tolerance**0.5)


def _residual(mesh: Mesh, points: Array, which: Indices) -> Array:
    """Return the largest distance of points from the surfaces that each row names."""
    found = np.zeros(len(points))
    for i, surface in enumerate(mesh.surfaces):
        on = np.flatnonzero(np.any(which == i, axis=1))
        if len(on):
            found[on] = np.maximum(found[on], np.abs(surface.distance(points[on])))
    return found


def _meeting(mesh: Mesh) -> Indices:
    """Return up to three independent surfaces of each point; fewer are repeated."""
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
    return which


def _incidence(mesh: Mesh) -> Indices:
    """Return the sorted codes ``point * number of surfaces + surface`` of all triangles."""
    return np.unique(mesh.triangles * len(mesh.surfaces) + mesh.patch[:, np.newaxis])


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
