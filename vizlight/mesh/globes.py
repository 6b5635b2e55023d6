"""Maps in degrees on the unit sphere: closed at their seam, whole at the poles, winds tangent."""

from __future__ import annotations

import math

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.mesh import blocks, georeference, meaning, polylines, projections, records
from vizlight.vtk.cells import connectivity, dimensions

#: Field array that says that a mesh is the earth as a ball around 0, with its radius.
GLOBE = "globe"
#: Degrees of a side of a line at most.
FINE = 1.0
#: Degrees from a pole within which an edge of a map is closed to it, and those of a circle.
NEAR_POLE = 15.0
#: Latitude from which on a map is one of the whole earth, and degrees that are none.
WHOLE, SLIGHT = 60.0, 1e-3


def globe(
    mesh: pv.DataSet, /, *, heights: str | None = None, exaggeration: float = 1.0
) -> pv.PolyData:
    """Return a flat map in degrees on the unit sphere: x toward 0 degrees east, z toward north.

    Columns that begin anew after 360 degrees are one; a map that ends one step before that is
    closed, and one that ends near a pole is closed there by the mean of its last row. Vectors,
    and components of vectors such as those of a wind, are turned from east, north and up to where
    these directions point. Lines are divided into steps of at most 1 degree.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Flat map, whose field array ``unit`` says ``degree``.
    heights : str, optional
        Name of a point array of heights in metres, by which points are farther from the centre;
        none where they are missing. Default: all are on the sphere.
    exaggeration : float, default: 1.0
        Factor of the heights.

    Returns
    -------
    pyvista.PolyData
        Surface, or lines, with the arrays of the map.

    Raises
    ------
    TypeError, ValueError
        If it is no flat map in degrees.

    Examples
    --------
    >>> import vizlight
    >>> from vizlight import cartography
    >>> earth = cartography.in_degrees(vizlight.load_example("earth_relief.vti"))
    >>> cartography.globe(earth).n_open_edges
    0
    """
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    if not georeference.has_degrees(mesh):
        remedy = "pass it through vizlight.cartography.in_degrees"
        raise _check.value_error("mesh", "a map in degrees", "no such unit", remedy)
    _check.coordinates("mesh", mesh.bounds)
    if not np.isfinite(np.asarray(mesh.points)).all():
        raise _check.value_error("mesh", "points that are finite", "NaN")
    if mesh.bounds_size[2] > 0:
        expected, got = "a flat map", f"one of {mesh.bounds_size[2]:g} along z"
        raise _check.value_error("mesh", expected, got)
    lines = mesh if isinstance(mesh, pv.PolyData) and mesh.n_lines else None
    flat = blocks.plain_surface(closed(mesh)) if lines is None else divided(lines)
    flat = meaning.with_components(flat)
    axes = directions(np.asarray(flat.points, dtype=np.float64))
    turned = flat.copy(deep=False)
    turned.points = axes[:, 2].copy()
    for name, rows in flat.point_data.items():
        if meaning.are_vectors(rows):
            turned.point_data[name] = _turned(np.asarray(rows), axes)
    middles = directions(np.asarray(flat.cell_centers().points, dtype=np.float64))
    for name, rows in flat.cell_data.items():
        if meaning.are_vectors(rows):
            turned.cell_data[name] = _turned(np.asarray(rows), middles)
    ball = _whole(turned) if lines is None else turned
    if heights is not None:
        ball.points = _raised(ball, heights, _check.number("exaggeration", exaggeration))
    ball.field_data.pop(georeference.UNIT, None)
    ball.field_data[GLOBE] = [1.0]
    return ball


def _raised(ball: pv.PolyData, name: str, factor: float) -> Array:
    """Return the points of a ball farther from its centre by heights in metres, times a factor."""
    rows = np.nan_to_num(records.scalars_of(ball, "heights", name))
    return np.asarray(ball.points) * (1 + factor * rows / projections.RADIUS)[:, np.newaxis]


def is_globe(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is said to be the earth as a ball of radius 1: by us or by GeoVista."""
    if not mesh.n_points or not ({GLOBE, "gvCRS"} & set(mesh.field_data)):
        return False
    sample = np.asarray(mesh.points, dtype=np.float64)[:: max(mesh.n_points // 1000, 1)]
    return bool(np.allclose(np.linalg.norm(sample, axis=1), 1, atol=1e-3))


def directions(places: Array) -> Array:
    """Return the directions east, north and up at places.

    Places (N, 2 or more) are longitudes and latitudes in degrees; unit vectors (N, 3, 3) are east
    in ``[:, 0]``, north in ``[:, 1]`` and up in ``[:, 2]``.
    """
    east, north = np.radians(places[:, 0]), np.radians(places[:, 1])
    zero = np.zeros_like(east)
    sin, cos, high, low = np.sin(east), np.cos(east), np.sin(north), np.cos(north)
    rows = ((-sin, cos, zero), (-high * cos, -high * sin, low), (low * cos, low * sin, high))
    return np.moveaxis(np.array(rows), 2, 0)


def _turned(rows: Array, axes: Array) -> Array:
    return np.asarray(np.einsum("ij,ijk->ik", rows, axes).astype(rows.dtype))


def divided(lines: pv.PolyData) -> pv.PolyData:
    """Return lines with sides that are at most a degree long."""
    ids, ends = connectivity(lines.GetLines())
    flat = np.asarray(lines.points, dtype=np.float64)[ids]
    parts: list[Array] = []
    for piece in np.split(flat, ends[1:-1]):
        steps = np.maximum(np.ceil(np.abs(np.diff(piece, axis=0)).max(axis=1) / FINE), 1)
        at = np.concatenate([[0.0], np.cumsum(steps)])
        places = np.arange(at[-1] + 1)
        parts.append(np.column_stack([np.interp(places, at, column) for column in piece.T]))
    new_ends: Indices = np.cumsum([0, *map(len, parts)])
    return polylines.polydata(np.concatenate([np.empty((0, 3)), *parts]), new_ends)


def closed(mesh: pv.DataSet) -> pv.DataSet:
    """Return a map with its first column as the last one, 360 degrees on, if it ends before that.

    The map is in degrees; one that is no grid of one layer is copied as it is.
    """
    columns, rows = (*dimensions(mesh), 0, 0)[:2]
    if columns < 3 or rows < 2 or mesh.n_points != columns * rows:
        return mesh.copy(deep=False)
    is_curved = isinstance(mesh, pv.StructuredGrid)
    grid = mesh if is_curved else mesh.cast_to_structured_grid()
    points = np.asarray(grid.points, dtype=np.float64).reshape(rows, columns, 3)
    step = (points[0, -1, 0] - points[0, 0, 0]) / (columns - 1)
    if abs(points[0, 0, 0] + georeference.AROUND - points[0, -1, 0] - step) > 0.01 * abs(step):
        return mesh.copy(deep=False)
    wide = np.concatenate([points, points[:, :1] + (georeference.AROUND, 0.0, 0.0)], axis=1)
    return _of_columns(grid, wide, np.append(np.arange(columns), 0))


def _of_columns(
    mesh: pv.DataSet, points: Array, columns: Indices, cells: Indices | None = None
) -> pv.StructuredGrid:
    """Return a grid of columns of another, with their data, at points of shape (rows, M, 3)."""
    rows = len(points)
    grid = blocks.structured(points.reshape(-1, 3), (len(columns), rows, 1))
    layers = [(mesh.point_data, grid.point_data, rows, columns)]
    if cells is not None:
        layers.append((mesh.cell_data, grid.cell_data, rows - 1, cells))
    for data, own, count, order in layers:
        for name, values in data.items():
            table = np.asarray(values).reshape(count, -1, *np.shape(values)[1:])[:, order]
            own[name] = table.reshape(-1, *table.shape[2:])
    grid.field_data.update(mesh.field_data)
    return grid


def middle_of(mesh: pv.DataSet) -> float | None:
    """Return the middle longitude of a map of the whole earth, None for all else.

    It is in degrees: a grid whose columns are meridians, or a surface that ends at one.
    """
    west, east, south, north = mesh.bounds[:4]
    if not south < -WHOLE or not north > WHOLE:
        return None
    if isinstance(mesh, pv.PolyData):
        is_around = abs(east - west - georeference.AROUND) < SLIGHT
        return round((west + east) / 2, 6) if is_around else None
    lon = _meridians(mesh)
    if lon is None:
        return None
    return round(float(_first(lon).min()) + georeference.AROUND / 2, 6)


def _first(lon: Array, west: float = -georeference.AROUND / 2) -> Array:
    """Return longitudes of columns from a western end on, without that of a second turn."""
    return (lon[:-1] - west + SLIGHT) % georeference.AROUND - SLIGHT + west


def _meridians(mesh: pv.DataSet) -> Array | None:
    """Return the longitudes of the columns of a grid that is closed, None for all else."""
    columns, rows = (*dimensions(mesh), 0, 0)[:2]
    if columns < 3 or rows < 2 or mesh.n_points != columns * rows:
        return None
    points = np.asarray(mesh.points).reshape(rows, columns, -1)
    lon = np.asarray(points[0, :, 0], dtype=np.float64)
    if not np.allclose(points[:, :, 0], lon, rtol=0, atol=SLIGHT) or not np.diff(lon).min() > 0:
        return None
    if not len(mesh.cell_data):
        step = (lon[-1] - lon[0]) / (columns - 1)
        if abs(lon[0] + georeference.AROUND - lon[-1] - step) < 0.01 * step:
            lon = np.append(lon, lon[0] + georeference.AROUND)
    return lon if abs(lon[-1] - lon[0] - georeference.AROUND) < SLIGHT else None


def centred(mesh: pv.DataSet, middle: float) -> pv.DataSet:
    """Return a grid around the earth with its columns from half a turn west of a longitude on.

    A map that is no grid around the earth is copied as it is; the first column lies half a turn
    away from the middle.
    """
    lon = _meridians(mesh)
    if lon is None:
        return mesh.copy(deep=False)
    columns, rows = mesh.dimensions[:2]
    first = _first(lon, middle - georeference.AROUND / 2)
    order = np.argsort(first)
    taken = np.append(order, order[0])
    points = np.asarray(mesh.points, dtype=np.float64).reshape(rows, columns, 3)[:, taken]
    points[..., 0] = np.append(first[order], first[order[0]] + georeference.AROUND)
    return _of_columns(mesh, points, taken, order)


def _whole(ball: pv.PolyData) -> pv.PolyData:
    """Return the surface of a map on a ball with one point at each place, closed at its poles."""
    surface: pv.PolyData = ball.triangulate().clean(
        tolerance=1e-6, absolute=True, polys_to_lines=False
    )
    edges = surface.extract_feature_edges(
        feature_edges=False, manifold_edges=False, non_manifold_edges=False
    )
    if not edges.n_lines:
        return surface
    ends = edges.lines.reshape(-1, 3)[:, 1:]
    _, nearest = scipy.spatial.cKDTree(np.asarray(surface.points)).query(np.asarray(edges.points))
    at: Indices = np.asarray(nearest)
    for side in (1.0, -1.0):
        high = side * np.asarray(edges.points)[:, 2] > math.cos(math.radians(NEAR_POLE))
        sides = at[ends[high[ends].all(axis=1)]]
        if len(sides):
            surface = _capped(surface, sides, side)
    return surface


def _capped(surface: pv.PolyData, sides: Indices, side: float) -> pv.PolyData:
    """Return a surface with a pole, which has the mean of the points around it."""
    around = np.unique(sides)
    points = np.concatenate([np.asarray(surface.points), [[0.0, 0.0, side]]])
    fan = np.column_stack([np.full((len(sides), 2), (3, surface.n_points)), sides])
    faces = np.concatenate([surface.faces.reshape(-1, 4), fan])
    whole = pv.PolyData(points, faces.ravel())
    for name, values in surface.point_data.items():
        rows = np.asarray(values)
        mean = rows[around].astype(np.float64).mean(axis=0, keepdims=True)
        kept = mean if rows.dtype.kind == "f" else rows[around[:1]]
        whole.point_data[name] = np.concatenate([rows, kept.astype(rows.dtype)])
    for name, values in surface.cell_data.items():
        rows = np.asarray(values)
        whole.cell_data[name] = np.concatenate([rows, np.repeat(rows[-1:], len(fan), axis=0)])
    whole.field_data.update(surface.field_data)
    return whole
