"""Walls of a body in a flow, which the far field of its mesh hides."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Bools
from vizlight.mesh import blocks, joining
from vizlight.vtk.cells import connectivity
from vizlight.vtk.corners import SHARP
from vizlight.vtk.topology import place_numbers

#: Size of a mesh in that of a boundary inside of it, and in that of a wall that meets the rest,
#: whose faces have to be as much shorter than those of the far field.
ENCLOSED, ATTACHED = 5.0, 20.0
#: Distance of points that are one, as a share of the size of the mesh: blocks have points of their
#: own where they meet.
ROUNDING = 1e-9
#: Name of the temporary array of ways from the middle of a cell to that of its face.
_OUTWARD = "vizlight outward"


def walls(volume: pv.DataSet, /) -> pv.PolyData:
    """Return the walls of a body inside of a mesh of cells that reaches far around it.

    The outer surface is parted at edges between faces that turn by more than 30 degrees. Walls are
    parts around which the cells lie, and of which none is larger than 0.2 times the mesh; where
    they meet the rest, as a wing meets a plane of symmetry, all of them together are at most 0.05
    times the mesh, and so are the sides of their faces of those of the far field.

    Parameters
    ----------
    volume : pyvista.DataSet
        Mesh of cells that fill a volume, which is not changed.

    Returns
    -------
    pyvista.PolyData
        Faces of the walls, without cells where a mesh has none.

    Raises
    ------
    TypeError
        If it is no mesh.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> shell = pv.SolidSphere(inner_radius=1.0, outer_radius=20.0)
    >>> round(files.walls(shell).length)
    3
    >>> files.walls(pv.SolidSphere()).n_cells
    0
    """
    _check.instance("volume", volume, pv.DataSet, "a mesh of cells")
    if not isinstance(volume, pv.UnstructuredGrid | pv.StructuredGrid):
        return pv.PolyData()
    surface = _joined(volume)
    if not surface.n_cells:
        return pv.PolyData()
    apart = surface.compute_normals(
        feature_angle=SHARP, split_vertices=True, consistent_normals=False, point_normals=True
    ).connectivity("all")
    part = np.asarray(apart.cell_data["RegionId"])
    of_points = np.asarray(apart.point_data["RegionId"])
    places = np.asarray(apart.points, dtype=np.float64)
    low, high = np.full((2, part.max() + 1, 3), [[[np.inf]], [[-np.inf]]])
    np.minimum.at(low, of_points, places)
    np.maximum.at(high, of_points, places)
    # In a hole the cells lie around, so that outward is toward the middle of a part.
    away = np.asarray(apart.cell_centers().points) - ((low + high) / 2)[part]
    outward = np.bincount(part, np.sum(away * apart.cell_data[_OUTWARD], axis=1))
    is_small = np.linalg.norm(high - low, axis=1) * ENCLOSED <= surface.length
    inner = (is_small & (outward < 0))[part]
    if not inner.any() or inner.all() or not _are_far(surface, inner):
        return pv.PolyData()
    walls = _faces(surface, inner)
    walls.clear_data()
    return walls


def _joined(volume: pv.DataSet) -> pv.PolyData:
    """Return the outer surface without faces between blocks, with the way out of each cell.

    Points at one place are one.
    """
    cells = volume.copy(deep=False)
    cells.clear_data()
    # VTK numbers the cells of an inner step where some are quadratic; arrays go along.
    cells.cell_data[_OUTWARD] = volume.cell_centers().points
    surface = blocks.plain_surface(cells)
    if not surface.n_cells or surface.n_cells > surface.GetNumberOfPolys():
        return pv.PolyData()
    surface.cell_data[_OUTWARD] = surface.cell_centers().points - surface.cell_data[_OUTWARD]
    # Faces without an area are left out below, and are no lines, which would be numbered before.
    tolerance = ROUNDING * surface.length
    surface = surface.clean(tolerance=tolerance, absolute=True, polys_to_lines=False)
    ids, ends = connectivity(surface.GetPolys())
    # The sum of random numbers of its corners, in any order, stands for a face.
    numbers = np.random.default_rng(0).integers(1 << 62, size=surface.n_points)
    sums = np.add.reduceat(numbers[ids], ends[:-1])
    _, first, counts = np.unique(sums, return_inverse=True, return_counts=True)
    return _faces(surface, (counts[first] == 1) & (np.diff(ends) > 2))


def _faces(surface: pv.PolyData, which: Bools) -> pv.PolyData:
    """Return some faces of a surface."""
    cells = joining.some_cells(surface, which)
    faces: pv.PolyData = cells.extract_surface(algorithm="dataset_surface")
    return faces


def _are_far(surface: pv.PolyData, inner: Bools) -> bool:
    """Return whether the rest of a surface is far from its inner faces, which may meet it."""
    faces, rest = (joining.some_cells(surface, which) for which in (inner, ~inner))
    places, others = (place_numbers(np.asarray(part.points)) for part in (faces, rest))
    if not np.isin(places, others).any():
        return True
    sides = np.sqrt(np.asarray(surface.compute_cell_sizes(volume=False)["Area"]))
    is_fine = np.median(sides[inner]) * ATTACHED <= sides[~inner].max()
    return bool(is_fine and faces.length * ATTACHED <= surface.length)
