"""Creases and borders of a surface as lines."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Indices
from vizlight.mesh import blocks
from vizlight.vtk.cells import check_whole, connectivity
from vizlight.vtk.corners import SHARP, sharp_edges
from vizlight.vtk.memory import once
from vizlight.vtk.normals import creases as share_of_creases
from vizlight.vtk.topology import are_closed, coincident

#: Size of connected edges, as a share of that of the surface, below which they are roughness.
SHORT = 0.1
#: Number of connected edges without a loose end from which they are no roughness.
LOOP = 12
#: The same of borders, below which they are cracks.
CRACK = 0.03
#: Largest number of borders as a share of that of the cells, and distance of places that are one,
#: as a share of the size of the surface.
MOST_BORDERS, SEAM = 0.3, 1e-6


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
        least 0.1 of the size of the surface, the diagonal of its box, or are at least 12 without a
        loose end, as around a hole or a letter; without cells where it is smooth, or so rough that
        no edges stand out.

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
    _check_surface(surface)
    carried = surface.point_data.active_normals_name is not None
    edges = once(surface, f"creases {carried}", lambda: _creases(surface, carried=carried))
    return edges.copy()


def _creases(surface: pv.PolyData, *, carried: bool) -> pv.PolyData:
    ids, ends = connectivity(surface.GetPolys())
    same = coincident(surface.points)
    if same is not None:
        # Files with normals store a point once for each side of a crease.
        kept = same == np.arange(len(same))
        ids = (np.cumsum(kept) - 1)[same][ids]
        surface = pv.PolyData(surface.points[kept], faces=blocks.cell_array(ids, ends))
    if not share_of_creases(surface, has_normals=carried):
        return pv.PolyData()
    pairs = sharp_edges(surface.points, ids, ends, SHARP)
    if not len(pairs):
        return pv.PolyData()
    edges = pv.PolyData(surface.points, lines=np.insert(pairs, 0, 2, axis=1).ravel())
    return _long(edges, SHORT * surface.length, loops=True)


def borders(surface: pv.PolyData, /) -> pv.PolyData:
    """Return the borders of an open surface as lines.

    Parameters
    ----------
    surface : pyvista.PolyData
        Surface, which is not changed.

    Returns
    -------
    pyvista.PolyData
        Edges of one face, where those that connect have at least 0.03 of the size of the surface,
        the diagonal of its box: shorter ones are cracks; without cells where the surface is closed,
        or in pieces, or has seams, at which points are stored twice.

    Raises
    ------
    TypeError, ValueError
        If it is no surface, or a cell of it is damaged.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> files.borders(pv.Plane(i_resolution=20, j_resolution=20)).n_cells
    80
    """
    _check_surface(surface)
    if are_closed(surface)[0].all():
        return pv.PolyData()
    edges = surface.extract_feature_edges(
        boundary_edges=True, feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    if not edges.n_cells or edges.n_cells > MOST_BORDERS * surface.n_cells:
        return pv.PolyData()
    middles = np.asarray(edges.points, dtype=np.float64)[edges.lines.reshape(-1, 3)[:, 1:]].mean(1)
    places = np.rint(middles / (SEAM * surface.length)).astype(np.int64)
    if len(np.unique(places, axis=0)) < edges.n_cells:
        return pv.PolyData()
    return _long(edges, CRACK * surface.length)


def _check_surface(surface: object) -> None:
    """Raise TypeError or ValueError unless a value is a surface without damaged cells."""
    _check.instance("surface", surface, pv.PolyData, "a pyvista.PolyData")
    check_whole(surface, "surface")


def _long(edges: pv.PolyData, least: float, *, loops: bool = False) -> pv.PolyData:
    """Return the edges of a mesh where those that connect have a least size, or are loops."""
    edges = edges.clean().connectivity("all")
    part: Indices = np.asarray(edges.point_data["RegionId"])
    low, high = np.full((2, part.max() + 1, 3), [[[np.inf]], [[-np.inf]]])
    np.minimum.at(low, part, edges.points)
    np.maximum.at(high, part, edges.points)
    long = np.linalg.norm(high - low, axis=1) >= least
    ends = edges.lines.reshape(-1, 3)[:, 1:]
    if loops:
        count = np.bincount(part[ends[:, 0]], minlength=len(long))
        loose = part[np.bincount(ends.ravel(), minlength=edges.n_points) < 2]
        long |= (count >= LOOP) & (np.bincount(loose, minlength=len(long)) == 0)
    ends = ends[long[part[ends[:, 0]]]]
    lines = np.insert(ends, 0, 2, axis=1)
    kept: pv.PolyData = pv.PolyData(edges.points, lines=lines.ravel()).clean()
    return kept
