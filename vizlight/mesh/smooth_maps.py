"""Maps of few points, drawn as smooth as their values are between them."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array
from vizlight.mesh import blocks

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
    _check.instance("mesh", mesh, Grid, "a grid")
    factor = _check.integer("factor", factor, low=1, high=64)
    sizes = tuple(size for size in mesh.dimensions if size > 1)
    if len(sizes) != 2:
        raise _check.value_error("mesh", "a grid of one layer", mesh.dimensions)
    _check.text("name", name, expected="the name of an array")
    if name not in mesh.point_data or np.ndim(mesh.point_data[name]) != 1:
        expected = "the name of an array of one component at points"
        raise _check.value_error("name", expected, repr(name))
    rows = np.column_stack([mesh.points, mesh.point_data[name]]).astype(np.float64)
    if not np.isfinite(rows).all():
        raise _check.value_error("mesh", "finite places and values", "others")
    # VTK counts columns first.
    table: Array = rows.reshape(sizes[1], sizes[0], 4)
    for _ in range(2):
        table = _finer(table, factor).swapaxes(0, 1)
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


def _finer(rows: Array, factor: int) -> Array:
    """Return rows of a table with others between them, on the cubic polynomials of each column.

    As ``scipy.interpolate.PchipInterpolator`` of equal steps; to import it takes longer than a map.
    """
    step = np.diff(rows, axis=0)
    slope = np.empty_like(rows)
    if len(step) == 1:
        slope[:] = step
    else:
        before, after = step[:-1], step[1:]
        # The harmonic mean of the steps, 0 at a high or low.
        alike = np.sign(before) * np.sign(after) > 0
        total = np.where(alike, before + after, 1.0)
        slope[1:-1] = np.where(alike, before * (2 * after / total), 0.0)
        for end, first, second in ((0, step[0], step[1]), (-1, step[-1], step[-2])):
            through = (3 * first - second) / 2
            back = np.sign(through) != np.sign(first)
            steep = (np.sign(first) != np.sign(second)) & (np.abs(through) > 3 * np.abs(first))
            slope[end] = np.where(back, 0.0, np.where(steep, 3 * first, through))
    finer = np.empty((factor * len(step) + 1, *rows.shape[1:]))
    finer[-1] = rows[-1]
    for i in range(factor):
        t = i / factor
        # The polynomials of Hermite.
        finer[i:-1:factor] = (
            rows[:-1] + t * t * (3 - 2 * t) * step
            + t * (1 - t) * ((1 - t) * slope[:-1] - t * slope[1:])
        )  # fmt: skip
    return finer
