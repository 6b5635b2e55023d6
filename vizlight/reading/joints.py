"""Points at one place that are one point of a smooth sheet: triangles without area join them.

Isosurfaces through nodes of a grid have such points. Along sharp edges that were split, and in
separate triangles, nothing joins the points at a place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _pool
from vizlight.model import kernels
from vizlight.reading.cells import connectivity
from vizlight.reading.edges import BLOCK
from vizlight.reading.topology import components

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from vizlight._types import Array, Indices


def joined(surface: vtkPolyData, same: Indices) -> Indices | None:
    """Return the first of the points that triangles without area join with each at its place.

    Parameters
    ----------
    surface : vtkPolyData
    same : ndarray of int, shape (n_points,)
        First point at the place of each point.

    Returns
    -------
    ndarray of int, shape (n_points,), or None
        None where no points are joined.
    """
    ids, offsets = connectivity(surface.GetPolys())
    first = offsets[:-1][np.diff(offsets) == 3]
    if not len(first):
        return None
    lower, upper = [], []
    for block in _pool.blocks(len(first), BLOCK):
        corners = [ids[first[block] + i] for i in range(3)]
        for one, other in zip(corners, corners[-1:] + corners[:-1], strict=True):
            # Most edges of most meshes have a length.
            near = np.flatnonzero(same[one] == same[other])
            near = near[one[near] != other[near]]
            lower.append(np.minimum(one[near], other[near]))
            upper.append(np.maximum(one[near], other[near]))
    if not sum(map(len, lower)):
        return None
    return components(np.concatenate(lower), np.concatenate(upper), len(same))


def common_normals(
    points: NDArray[np.generic], triangles: Indices, normals: Array, first: Indices, least: float
) -> tuple[Array, Indices]:
    """Return normals that points which are joined have in common, where these are nearly the same.

    Parameters
    ----------
    points : ndarray, shape (n_points, 3)
    triangles : ndarray of int, shape (n, 3)
    normals : ndarray, shape (n_points, 3)
        Unit normals of the points, each by its own triangles.
    first : ndarray of int, shape (n_points,)
        First of the points that are joined with each.
    least : float
        Least cosine between a point's own normal and the common one.

    Returns
    -------
    normals : ndarray, shape (n_points, 3)
        With the direction of the sum of the unit normals of all triangles at joined points.
    first : ndarray of int, shape (n_points,)
        First of the points that are joined and got one normal.
    """
    several = np.bincount(first, minlength=len(first))[first] > 1
    rows = triangles[several[triangles].any(axis=1)]
    a, b, c = (points[corner].T.astype(np.float64) for corner in rows.T)
    with np.errstate(invalid="ignore", over="ignore"):
        face = kernels.unit(kernels.cross(b - a, c - a))[0].T
    face[~np.isfinite(face).all(axis=1)] = 0
    total = np.zeros((len(first), 3))
    for corner in rows.T:
        # A triangle counts once at each place.
        np.add.at(total, first[corner], face)
    common = kernels.unit_rows(total)[first]
    cosine = np.einsum("ij,ij->i", normals, common)
    apart = several & ~(cosine >= least) & np.any(normals, axis=1)
    kept = np.ones(len(first), dtype=np.bool_)
    kept[first[apart]] = False
    chosen = several & kept[first]
    found = normals.copy()
    found[chosen] = common[chosen]
    return found, np.where(chosen, first, np.arange(len(first)))
