"""Maps of few points, drawn as smooth as their values are between them."""

from __future__ import annotations

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight.mesh import blocks

__all__ = ["smoothed"]


#: Types of grids that may have one layer.
Grid = pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid


def smoothed(mesh: Grid, name: str, factor: int, /) -> pv.PolyData:
    """Return a grid of one layer with more points, between which values run smoothly.

    Places and values are interpolated along the rows, then along the columns, by cubic polynomials
    that keep the order of neighbours (Fritsch and Butland 1984), so that no new high or low
    appears. The points of the grid keep their values.

    Parameters
    ----------
    mesh : pyvista.ImageData, pyvista.RectilinearGrid or pyvista.StructuredGrid
        Grid of one layer.
    name : str
        Name of an array of one component at its points, all finite.
    factor : int
        Steps from each point to the next, from 1 to 64.

    Returns
    -------
    pyvista.PolyData
        Triangles, with the array and the field data of the grid.

    Raises
    ------
    TypeError, ValueError
        If it is no such grid, or a value is missing.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import cartography
    >>> hill = pv.ImageData(dimensions=(3, 3, 1))
    >>> hill["height"] = [0, 0, 0, 0, 1, 0, 0, 0, 0]
    >>> cartography.smoothed(hill, "height", 4).n_points
    81

    Notes
    -----
    Isolines of the triangles are the borders between colours on them, since both are straight in
    each triangle.
    """
    if not isinstance(mesh, Grid):
        raise TypeError(_check.message("mesh", "a grid", _check.describe(mesh)))
    factor = _check.integer("factor", factor, low=1, high=64)
    sizes = tuple(size for size in mesh.dimensions if size > 1)
    if len(sizes) != 2:
        raise ValueError(_check.message("mesh", "a grid of one layer", mesh.dimensions))
    _check.text("name", name, expected="the name of an array")
    if name not in mesh.point_data or np.ndim(mesh.point_data[name]) != 1:
        expected = "the name of an array of one component at points"
        raise ValueError(_check.message("name", expected, repr(name)))
    rows = np.column_stack([mesh.points, mesh.point_data[name]]).astype(np.float64)
    if not np.isfinite(rows).all():
        raise ValueError(_check.message("mesh", "finite places and values", "others"))
    # VTK counts columns first.
    table = rows.reshape(sizes[1], sizes[0], 4)
    for axis in (0, 1):
        at = np.arange(table.shape[axis])
        finer = np.linspace(0, at[-1], factor * at[-1] + 1)
        table = scipy.interpolate.PchipInterpolator(at, table, axis=axis)(finer)
    high, wide = table.shape[:2]
    ids = np.arange(high * wide).reshape(high, wide)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    points = table[..., :3].reshape(-1, 3)
    smooth = blocks.polydata(points, faces)
    smooth.point_data[name] = table[..., 3].ravel()
    for key in mesh.field_data:
        smooth.field_data[key] = mesh.field_data[key]
    return smooth
