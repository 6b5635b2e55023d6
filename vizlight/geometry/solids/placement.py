"""Points of a faceted solid moved onto its exact surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.solids import triangle_mesh
from vizlight.geometry.solids.exact_surfaces import onto

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.solids.triangle_mesh import Mesh

#: Length of the part of a normal that is independent of other normals at a point: below it two
#: surfaces count as touching.
LEAN = 0.02
#: Largest distance that a point is moved, in units of the tolerance.
REACH = 20
#: Rounds of Newton's method.
ROUNDS = 8
#: Distance below which neighbouring points are one point.
SAME = 1e-9
#: Twice the area below which a triangle has no side, to rounding of normalised points.
FLAT = 1e-14


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
        rounding. Where two surfaces touch, a point is on one of them. Points that would flip a
        triangle stay where they are.
    """
    points = _placed(mesh, tolerance)
    found = _merge(mesh.replace(points, mesh.triangles, mesh.patch))
    return _kept(mesh, points) if flipped(found).any() else found


def _placed(mesh: Mesh, tolerance: float) -> Array:
    """Return the points on their surfaces."""
    which = _meeting(mesh)
    points = onto(mesh.surfaces, mesh.points, which, ROUNDS)
    moved = points - mesh.points
    far = np.einsum("ij,ij->i", moved, moved) > (REACH * tolerance) ** 2
    points[far] = onto(mesh.surfaces, mesh.points[far], which[far][:, :1], ROUNDS)
    for surface in mesh.surfaces:
        apex = getattr(surface, "apex", None)
        if apex is not None:
            points[np.abs(points - apex).max(axis=1) < SAME] = apex
    return points


def _kept(mesh: Mesh, points: Array) -> Mesh:
    """Return a mesh with moved points, except at corners of triangles that they would flip."""
    points = points.copy()
    while True:
        found = mesh.replace(points, mesh.triangles, mesh.patch)
        corners = np.unique(mesh.triangles[flipped(found)])
        moved = corners[np.any(points[corners] != mesh.points[corners], axis=1)]
        if not len(moved):
            return found
        points[moved] = mesh.points[moved]


def flipped(mesh: Mesh) -> Bools:
    """Return the triangles whose normal points into the solid."""
    corners = mesh.points[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal = triangle_mesh.normals_of(mesh, corners.mean(axis=1), mesh.patch)
    return np.asarray(np.einsum("ij,ij->i", across, normal) < -FLAT)


def _meeting(mesh: Mesh) -> Indices:
    """Return up to three independent surfaces of each point; fewer are repeated."""
    count = len(mesh.points)
    sides = len(mesh.surfaces)
    codes = np.unique(mesh.triangles * sides + mesh.patch[:, np.newaxis])
    pairs = np.stack(np.divmod(codes, sides), axis=1)
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
