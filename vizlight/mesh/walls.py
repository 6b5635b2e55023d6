"""Walls of a body in a flow, which the far field of its mesh hides."""

from __future__ import annotations

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import Array, Bools
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
#: Most points of a convex hull and rows of distances from it, and distance of a place that is on
#: it, as a share of the size of the mesh.
SAMPLE, ON_HULL = 1000, 0.01
#: Least share of a convex hull that a mesh with obstacles fills.
FILLED = 0.8
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


def obstacles(surface: pv.PolyData, name: str, /) -> pv.PolyData:
    """Return the outer surface of a volume with values at the walls that stand inside alone.

    Those are inside of its convex hull by 0.01 of its size, of a volume that fills it: on 0.8 of
    the area of the convex hull there are faces.

    Parameters
    ----------
    surface : pyvista.PolyData
        Outer surface, with points of their own on either side of its sharp edges.
    name : str
        Name of a point array of values.

    Returns
    -------
    pyvista.PolyData
        The same surface; elsewhere its values are NaN.

    Raises
    ------
    TypeError, ValueError
        If it is no surface, or has no such array.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import files
    >>> shell = files.surface_of(pv.SolidSphere(inner_radius=1.0, outer_radius=2.0))
    >>> shell["heat"] = [1.0] * shell.n_points
    >>> inner = files.obstacles(shell, "heat").threshold(0.0, scalars="heat")
    >>> round(inner.length, 1)
    3.5
    """
    _check.instance("surface", surface, pv.PolyData, "the surface of a volume")
    if name not in surface.point_data:
        raise _check.value_error("name", "the name of a point array", name)
    walls: pv.PolyData = surface.copy(deep=False)
    values = np.array(surface.point_data[name], dtype=np.float64)
    ids, ends = connectivity(surface.GetPolys())
    of_faces = np.repeat(np.arange(len(ends) - 1), np.diff(ends))
    # Cells of points and lines come before faces.
    first = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
    stands_inside: Bools = np.zeros(surface.n_points, dtype=np.bool_)
    stands_inside[ids] = True
    stands_inside[ids[_are_on_hull(surface)[first + of_faces]]] = False
    walls.point_data[name] = np.where(stands_inside, values, np.nan)
    return walls


def _are_on_hull(surface: pv.PolyData) -> Bools:
    """Return whether faces of a surface are on its convex hull; all are if it does not fill it."""
    every: Bools = np.ones(surface.n_cells, dtype=np.bool_)
    points: Array = np.asarray(surface.points, dtype=np.float64)
    try:
        hull = scipy.spatial.ConvexHull(points[:: max(len(points) // SAMPLE, 1)])
    except (scipy.spatial.QhullError, ValueError):
        return every  # flat, or not finite
    planes = np.unique(np.round(hull.equations, 6), axis=0)
    middles: Array = np.asarray(surface.cell_centers().points, dtype=np.float64)
    depths = [
        (middles[i : i + SAMPLE] @ planes[:, :3].T + planes[:, 3]).max(axis=1)
        for i in range(0, len(middles), SAMPLE)
    ]
    are_on = np.concatenate(depths) > -ON_HULL * surface.length
    areas = surface.compute_cell_sizes(length=False, volume=False)["Area"]
    return are_on if areas[are_on].sum() > FILLED * hull.area else every


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
