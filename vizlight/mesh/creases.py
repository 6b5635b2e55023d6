"""Creases of a surface as lines."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Indices
from vizlight.vtk.cells import check_whole, connectivity
from vizlight.vtk.corners import SHARP
from vizlight.vtk.memory import once
from vizlight.vtk.normals import creases as share_of_creases

__all__ = ["creases"]

#: Size of connected edges, as a share of that of the surface, below which they are roughness.
SHORT = 0.1


def creases(surface: pv.PolyData, /) -> pv.PolyData:
    """Return the creases of a surface as lines.

    Parameters
    ----------
    surface : pyvista.PolyData
        Surface, which is not changed.

    Returns
    -------
    pyvista.PolyData
        Edges between faces that turn by more than 30 degrees, where those that connect have at
        least 0.1 of the size of the surface, the diagonal of its box; without cells where it is
        smooth, or so rough that no edges stand out.

    Raises
    ------
    TypeError, ValueError
        If it is no surface, or a cell of it is damaged.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> files.creases(pv.Box()).n_cells
    12
    >>> files.creases(pv.Sphere()).n_cells
    0
    """
    if not isinstance(surface, pv.PolyData):
        raise TypeError(_check.message("surface", "a pyvista.PolyData", _check.describe(surface)))
    check_whole(surface, "surface")
    carried = surface.point_data.active_normals_name is not None
    edges = once(surface, f"creases {carried}", lambda: _creases(surface, carried=carried))
    return edges.copy()


def _creases(surface: pv.PolyData, *, carried: bool) -> pv.PolyData:
    if not share_of_creases(surface, has_normals=carried):
        return pv.PolyData()
    if not _are_wound_alike(surface):
        # VTK takes the edge between a face and one wound the other way for a crease, and winds the
        # wrong faces where there are polylines too.
        surface = pv.PolyData(surface.points, surface.faces).compute_normals(
            point_normals=False, split_vertices=False, consistent_normals=True
        )
    edges = surface.extract_feature_edges(
        SHARP, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )
    if not edges.n_cells:
        # Faces that are there twice have no edge between two alone.
        return pv.PolyData()
    edges = edges.connectivity("all")
    part: Indices = np.asarray(edges.point_data["RegionId"])
    low, high = np.full((2, part.max() + 1, 3), [[[np.inf]], [[-np.inf]]])
    np.minimum.at(low, part, edges.points)
    np.maximum.at(high, part, edges.points)
    long = np.linalg.norm(high - low, axis=1) >= SHORT * surface.length
    ends = edges.lines.reshape(-1, 3)[:, 1:]
    ends = ends[long[part[ends[:, 0]]]]
    lines = np.insert(ends, 0, 2, axis=1)
    kept: pv.PolyData = pv.PolyData(edges.points, lines=lines.ravel()).clean()
    return kept


def _are_wound_alike(surface: pv.PolyData) -> bool:
    """Return whether no two faces run along an edge the same way."""
    ids, ends = connectivity(surface.GetPolys())
    ahead = np.roll(ids, -1)
    ahead[ends[1:] - 1] = ids[ends[:-1]]
    ways = ids.astype(np.int64) * surface.n_points + ahead
    return len(np.unique(ways)) == len(ways)
