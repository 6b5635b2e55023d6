"""Creases of a surface as lines."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Indices
from vizlight.vtk.cells import check_whole, connectivity
from vizlight.vtk.corners import SHARP, sharp_edges
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
    ids, ends = connectivity(surface.GetPolys())
    pairs = sharp_edges(surface.points, ids, ends, SHARP)
    if not len(pairs):
        return pv.PolyData()
    edges = pv.PolyData(surface.points, lines=np.insert(pairs, 0, 2, axis=1).ravel()).clean()
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
