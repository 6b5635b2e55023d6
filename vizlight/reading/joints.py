"""Points at nearly one place that are one point of a smooth sheet: slivers join them.

Isosurfaces through nodes of a grid have such points, at one place or apart by rounding. Along sharp
edges that were split, and in separate triangles, nothing joins the points at a place.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight import _pool
from vizlight.model import kernels
from vizlight.reading.cells import connectivity
from vizlight.reading.corners import corner_normals
from vizlight.reading.edges import BLOCK
from vizlight.reading.topology import components

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    from vizlight._types import Array, Indices

#: Share of the longest side of a triangle up to which another side joins its ends, and of the
#: longest of those up to which all points that are joined lie apart.
NEAR = 1e-3


def joined(points: NDArray[np.generic], surface: vtkPolyData) -> Indices | None:
    """Return the first of the points that slivers join with each.

    A side joins its ends where it is at most :data:`NEAR` of the longest side of its triangle.
    Points that are joined in a chain, as across a row of slivers, stay apart where the chain is
    longer than that.

    Parameters
    ----------
    points : ndarray, shape (n_points, 3)
    surface : vtkPolyData

    Returns
    -------
    ndarray of int, shape (n_points,), or None
        None where no points are joined.
    """
    ids, offsets = connectivity(surface.GetPolys())
    first = offsets[:-1][np.diff(offsets) == 3]
    found: list[tuple[Indices, Indices, Array]] = []
    for block in _pool.blocks(len(first), BLOCK):
        rows = np.stack([ids[first[block] + i] for i in range(3)], axis=1)
        corners = [points.take(corner, axis=0).T.astype(np.float64) for corner in rows.T]
        with np.errstate(invalid="ignore", over="ignore", under="ignore"):
            sides = [corners[i] - corners[i - 1] for i in range(3)]
            squares = [kernels.dot(side, side) for side in sides]
            longest = np.maximum(np.maximum(squares[0], squares[1]), squares[2])
            for i, square in enumerate(squares):
                near = np.flatnonzero(square <= NEAR * NEAR * longest)
                one, other = rows[near, i], rows[near, i - 1]
                found.append((np.minimum(one, other), np.maximum(one, other), longest[near]))
    if not found:
        return None
    lower, upper, longest = (np.concatenate(each) for each in zip(*found, strict=True))
    apart = lower != upper
    lower, upper, longest = lower[apart], upper[apart], longest[apart]
    if not len(lower):
        return None
    # Chains of slivers have one first point; whether they stay near is tested below.
    first = components(lower, upper, len(points))
    reach = np.zeros(len(points))
    np.maximum.at(reach, first[lower], NEAR * np.sqrt(longest))
    ends = np.unique(np.concatenate([lower, upper]))
    low, high = np.full((2, len(points), 3), np.inf)
    places = points[ends].astype(np.float64)
    np.minimum.at(low, first[ends], places)
    # The upper bound as the least of the negative: both arrays start from infinity.
    np.minimum.at(high, first[ends], -places)
    with np.errstate(invalid="ignore"):
        together = (-high - low).max(axis=1) <= reach
    return np.where(together[first], first, np.arange(len(points)))


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
        Of all triangles at joined points but the slivers between these.
    first : ndarray of int, shape (n_points,)
        First of the points that are joined and got one normal.
    """
    several = np.bincount(first, minlength=len(first))[first] > 1
    rows = triangles[several[triangles].any(axis=1)]
    # Slivers have a direction by rounding alone.
    rows = rows[np.all(first[rows] != first[np.roll(rows, 1, axis=1)], axis=1)]
    common = corner_normals(points, [first[rows]])[first]
    normals = np.where(several[:, np.newaxis], corner_normals(points, [rows]), normals)
    cosine = np.einsum("ij,ij->i", normals, common)
    apart = several & ~(cosine >= least) & np.any(normals, axis=1)
    kept = np.ones(len(first), dtype=np.bool_)
    kept[first[apart]] = False
    chosen = several & kept[first]
    found = normals.copy()
    found[chosen] = common[chosen]
    return found, np.where(chosen, first, np.arange(len(first)))
