"""Maps of few points, drawn as smooth as their values are between them."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array
from vizlight.mesh import blocks, records

#: Types of grids that may have one layer.
Grid = pv.ImageData | pv.RectilinearGrid | pv.StructuredGrid

#: Name of the share of values that are known, which the result does not keep.
SHARE = "share"


def smoothed(mesh: Grid, name: str, factor: int, /) -> pv.PolyData:
    """Return a grid of one layer with more points, between which values run smoothly.

    Places and values are interpolated along the rows, then along the columns, by cubic polynomials
    that keep the order of neighbours (Fritsch and Butland 1984), so that no new high or low
    appears. The points of the grid keep their values. Where values are missing, they are so up to
    halfway to the points with one, as each value stands for the area around its point; from there
    they run from the mean of those next to the missing one.

    Parameters
    ----------
    mesh : pyvista.ImageData, pyvista.RectilinearGrid or pyvista.StructuredGrid
        Grid of one layer.
    name : str
        Name of an array of one component at its points; values that are not finite are missing.
    factor : int
        Steps from each point to the next, from 1 to 64.

    Returns
    -------
    pyvista.PolyData
        Triangles, with the array and the field data of the grid.

    Raises
    ------
    TypeError, ValueError
        If it is no such grid, a place is not finite, or all values are missing.

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
    values: Array = records.scalars_of(mesh, "name", name).astype(np.float64)
    is_known = np.isfinite(values)
    places = np.asarray(mesh.points, dtype=np.float64)
    if not np.isfinite(places).all() or not is_known.any():
        raise _check.value_error("mesh", "finite places and values", "others")
    # VTK counts columns first.
    shape = sizes[::-1]
    weights = is_known.reshape(shape).astype(np.float64)
    known = np.where(is_known, values, 0.0).reshape(shape)
    around = _around(known) / np.maximum(_around(weights), 1.0)
    known = np.where(weights > 0, known, around)
    table: Array = np.concatenate(
        [places.reshape(*shape, 3), known[..., np.newaxis], weights[..., np.newaxis]], axis=-1
    )
    for _ in range(2):
        table = _finer(table, factor).swapaxes(0, 1)
    high, wide = table.shape[:2]
    ids = np.arange(high * wide).reshape(high, wide)
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    faces = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    points = table[..., :3].reshape(-1, 3)
    smooth = blocks.polydata(points, faces)
    smooth.point_data[name] = table[..., 3].ravel()
    if not is_known.all():
        smooth.point_data[SHARE] = table[..., 4].ravel()
        missing, smooth = smooth.clip_scalar(scalars=SHARE, value=0.5, both=True)
        missing.point_data[name] = np.full(missing.n_points, np.nan)
        smooth = smooth.append_polydata(missing)
        del smooth.point_data[SHARE]
    smooth.field_data.update(mesh.field_data)
    return smooth


def _around(table: Array) -> Array:
    """Return the sums of each entry of a table and its eight neighbours."""
    wide = np.pad(table, 1)
    wide = wide[:-2] + wide[1:-1] + wide[2:]
    return np.asarray(wide[:, :-2] + wide[:, 1:-1] + wide[:, 2:])


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
