"""Rasters, and where on the Earth they lie."""

from __future__ import annotations

import math
import re

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign, Raw
from vizlight.mesh import blocks, meaning, sections
from vizlight.mesh.blocks import DataSetT

#: Field array with the unit of x and y, and its value for longitude and latitude.
UNIT, DEGREE = "unit", "degree"
#: Field array with the text of a projection: of a map in degrees that in which its grid is
#: straight, of one in metres that of its x and y.
PROJECTION = "projection"
#: Degrees around the earth.
AROUND = 360.0
#: Field array with the latitude of the centre of a map that was in degrees and is in metres.
LATITUDE = "latitude"
#: Latitude beyond which a parallel is taken for that of this latitude.
NEAR_POLE = 89.0
#: Length of a degree of latitude on the sphere of the earth's mean radius, in metres.
METRES = math.radians(6_371_008.8)
#: Radii of what is taken for the earth, in metres.
RADII = (6.3e6, 6.45e6)
#: Length of a kilometre in metres.
KILOMETRE = 1e3
#: Range of heights, as a share of the side of a map, that needs no exaggeration.
ENOUGH = (0.05, 0.5)
#: Percentiles of the heights that bound their range, so that single wrong heights do not matter.
RANGE = (1.0, 99.0)


def has_degrees(mesh: pv.DataSet) -> bool:
    """Return whether the x and y of a mesh are said to be in degrees."""
    return unit_of(mesh) == DEGREE


def unit_of(mesh: pv.DataSet) -> str:
    """Return the unit of the x and y of a mesh, empty where nothing is said of it."""
    return str(mesh.field_data[UNIT][0]) if UNIT in mesh.field_data else ""


def in_metres(mesh: DataSetT) -> DataSetT:
    """Return a map in metres east and north of its centre, if it is in degrees.

    A degree of latitude has 111,195 m, one of longitude ``cos(latitude)`` of that, for the latitude
    of the centre: lengths agree with the ellipsoid's to 0.6 % there, up to 88.9 degrees north or
    south, and east to west farther from the centre to the ratio of the cosines. The copy shares the
    arrays; a mesh whose field array ``unit`` names no degrees is returned itself.
    """
    if not has_degrees(mesh):
        return mesh
    x, y, _ = mesh.center
    # At a pole all meridians meet: a degree of longitude would have no length.
    across = METRES * float(_parallel(y))
    # An equirectangular map that is true to scale at its centre; heights stay as they are.
    moved = blocks.moved(mesh, np.array([-x, -y, 0.0]), np.array([across, METRES, 1.0]))
    moved.field_data[UNIT] = ["metre"]
    moved.field_data[LATITUDE] = [float(y)]
    return moved


def rates(mesh: pv.DataSet, places: Array) -> Array:
    """Return the factors that take motion in metres to the coordinates of a map, at places of it.

    A degree of longitude is as long as its latitude says: on a map in degrees, or one that was, a
    wind of equal parts east and north crosses more degrees of longitude than of latitude. A mesh
    that is no map has factors of 1.
    """
    result: Array = np.ones((len(places), 3))
    latitudes, scale = places[:, 1], 1.0
    if has_degrees(mesh):
        result[:, :2] = scale = 1 / METRES
    elif LATITUDE in mesh.field_data:
        middle = float(mesh.field_data[LATITUDE][0])
        latitudes, scale = middle + latitudes / METRES, _parallel(middle)
    else:
        return result
    # At a pole all meridians meet: motion along a circle about it never ends.
    result[:, 0] = scale / _parallel(latitudes)
    return result


def _parallel(latitude: float | Array) -> Foreign:
    """Return the length of a parallel as a share of the equator's, not 0 at the poles."""
    return np.cos(np.radians(np.clip(latitude, -NEAR_POLE, NEAR_POLE)))


def scale_to_one(mesh: pv.DataSet, traced: pv.DataSet) -> Array:
    """Return the scale of each axis by which a mesh has size 1.

    A volume over a map gets one of its own along z: heights in metres or hPa beside degrees would
    make its cells columns or discs. The scale is that of the mesh for ``traced``, the mesh itself
    or a surface in its coordinates.
    """
    x, y, z = traced.bounds_size
    if is_map(mesh) and traced.GetMaxSpatialDimension() == 3 and min(max(x, y), z) > 0:
        side = max(x, y)
        return np.array([1 / side, 1 / side, 1 / z])
    return np.full(3, 1 / blocks.box(traced)[1])


def motion(mesh: pv.DataSet, traced: pv.DataSet, vectors: Array, scale: Array) -> Array:
    """Return vectors at the points of a mesh in its coordinates, times the scale of each axis.

    Vectors (N, 3 k) of a map are in metres east and north; the scale is a share of that of x, and
    meshes are as for :func:`scale_to_one`.
    """
    factors = scale / scale[0]
    if is_map(mesh):
        factors = factors * rates(mesh, np.asarray(traced.points, dtype=np.float64))
    elif np.all(factors == 1):
        return vectors
    rows = vectors.reshape(len(vectors), -1, 3)
    return np.asarray(rows * np.reshape(factors, (-1, 1, 3))).reshape(vectors.shape)


def is_map(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a map in degrees, or was one."""
    return has_degrees(mesh) or LATITUDE in mesh.field_data or PROJECTION in mesh.field_data


def seem_degrees(grid: pv.DataSet, heights: str) -> bool:
    """Return whether a grid of unknown unit is in degrees.

    Its x and y can be longitude and latitude, and its heights range over more than its sides,
    as no terrain does whose x and y are in the unit of its heights.
    """
    bounds = grid.bounds
    # Longitudes run from -180 to 180 or from 0 to 360.
    places = bounds.x_min >= -180 and bounds.x_max <= 360 and abs(grid.center[1]) <= 90
    degrees = places and max(abs(bounds.y_min), abs(bounds.y_max)) <= 90
    # Pixels of an image that has no place are one apart.
    fine = max(getattr(grid, "spacing", (0.0, 0.0))[:2]) < 1
    return degrees and fine and range_of(grid.point_data[heights]) > max(grid.bounds_size[:2])


def is_earth(mesh: pv.DataSet) -> bool:
    """Return whether x and y of a mesh of unknown unit are those of the whole earth in degrees."""
    west, east, south, north, low, high = mesh.bounds
    is_around = 340 < east - west < 361 and min(abs(west), abs(west + 180)) < 10
    from_pole_to_pole = south >= -90 and north <= 90 and north - south > 150
    return UNIT not in mesh.field_data and is_around and from_pole_to_pole and low == high


def on_earth(mesh: pv.DataSet) -> bool:
    """Return whether no reference system of a mesh says that it is of another planet."""
    system = str(mesh.field_data["crs"][0]) if "crs" in mesh.field_data else ""
    radius = re.search(r'(?:SPHEROID|ELLIPSOID)\["[^"]*",\s*([\d.]+)', system)
    return radius is None or RADII[0] < float(radius[1]) < RADII[1]


def in_degrees(mesh: DataSetT, /) -> DataSetT:
    """Return a mesh that says that its x and y are degrees of longitude and of latitude.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Map whose x and y are degrees east and north.

    Returns
    -------
    pyvista.DataSet
        Copy that shares the arrays, with the field array ``unit``.

    Raises
    ------
    TypeError, ValueError
        If it is no mesh, or its latitudes are none.

    Examples
    --------
    >>> import vizlight
    >>> from vizlight import cartography
    >>> earth = cartography.in_degrees(vizlight.load_example("earth_relief.vti"))
    >>> str(earth.field_data["unit"][0])
    'degree'
    """
    _check.instance("mesh", mesh, pv.DataSet, "a mesh")
    _, _, south, north, _, _ = _check.coordinates("mesh", mesh.bounds)
    if mesh.n_points and not -90 <= south <= north <= 90:
        expected = "a mesh whose y is a latitude, from -90 to 90"
        raise _check.value_error("mesh", expected, f"y from {south:g} to {north:g}")
    named = mesh.copy(deep=False)
    named.field_data[UNIT] = [DEGREE]
    return named


def exaggeration(mesh: pv.DataSet, heights: str, *, side: float | None = None) -> float:
    """Return the factor of heights with which the relief of a map can be seen.

    It is 1 where they range over a twentieth of the side of the map to half of it; else the 1, 2 or
    5 with zeros that comes next to that. A mesh in degrees is taken in metres; ``side`` is the
    length beside which heights are seen.
    """
    if side is not None:
        return _factor(range_of(mesh.point_data[heights]), side)
    sides = sorted(in_metres(mesh).bounds_size)
    # The two longer sides are those of the map. One row of points has no area.
    side = math.sqrt(sides[1] * sides[2]) or sides[2]
    return _factor(range_of(mesh.point_data[heights]), side)


def stretch(mesh: pv.DataSet) -> float:
    """Return the factor of z with which a volume over a map in degrees can be seen, 1 for others.

    Air and sea are thin beside their maps, and levels are often numbers; see :func:`exaggeration`.
    Of a vertical section it is that of y.
    """
    if meaning.of(mesh).section:
        return sections.stretch(mesh)
    x, y, z = in_metres(mesh).bounds_size
    return _factor(z, math.sqrt(x * y) or max(x, y)) if has_degrees(mesh) else 1.0


def _factor(spread: float, side: float) -> float:
    if not (spread > 0 and side > 0) or ENOUGH[0] <= spread / side <= ENOUGH[1]:
        return 1.0
    # The factor that takes the share just to the nearer end of the range.
    wanted = min(max(spread / side, ENOUGH[0]), ENOUGH[1]) * side / spread
    power = 10.0 ** math.floor(math.log10(wanted))
    # By way of text: 5 times 1e-6 is 4.9999999999999996e-06, which a message would show.
    steps = [float(f"{step * power:.3g}") for step in (1, 2, 5, 10)]
    # Nearest by ratio: 1 and 10 are equally far from 3.16.
    return min(steps, key=lambda step: abs(math.log(step / wanted)))


def range_of(heights: Raw) -> float:
    """Return the range of heights, without that of single wrong ones."""
    values = np.asarray(heights, dtype=np.float64)
    values = values[np.isfinite(values)]
    return float(np.ptp(np.percentile(values, RANGE))) if values.size else 0.0


def place_alike(lines: pv.DataSet, mesh: pv.DataSet) -> None:
    """Say of lines that they lie on the map, and in the frame, of the mesh they are made from."""
    for key in (UNIT, PROJECTION, meaning.MEANING):
        if key in mesh.field_data:
            lines.field_data[key] = mesh.field_data[key]
