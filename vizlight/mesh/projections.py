"""Map projections: from longitude and latitude to a plane in metres, and back.

Cones, rotated poles, equirectangular and Equal Earth maps are on the sphere of the earth's mean
radius; all others are left to PROJ, which comes with rasterio.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from vizlight._types import Array, Foreign

#: Radius of the earth, in metres.
RADIUS = 6_371_008.8
#: Keywords of PROJ for the projections of CF, and for their attributes.
_NAMES = {
    "lambert_conformal_conic": "lcc", "polar_stereographic": "stere", "stereographic": "stere",
    "lambert_azimuthal_equal_area": "laea", "albers_conical_equal_area": "aea",
    "azimuthal_equidistant": "aeqd", "mercator": "merc", "transverse_mercator": "tmerc",
    "lambert_cylindrical_equal_area": "cea", "orthographic": "ortho", "sinusoidal": "sinu",
    "geostationary": "geos",
}  # fmt: skip
_KEYWORDS = {
    "latitude_of_projection_origin": "lat_0", "longitude_of_projection_origin": "lon_0",
    "longitude_of_central_meridian": "lon_0", "straight_vertical_longitude_from_pole": "lon_0",
    "scale_factor_at_projection_origin": "k_0", "scale_factor_at_central_meridian": "k_0",
    "false_easting": "x_0", "false_northing": "y_0", "semi_major_axis": "a",
    "semi_minor_axis": "b", "inverse_flattening": "rf", "earth_radius": "R",
    "perspective_point_height": "h",
}  # fmt: skip
#: Attributes that write a projection out.
_WRITTEN = ("crs_wkt", "spatial_ref", "proj4", "proj4_params", "proj4text")
#: Keywords of the projections on the sphere that need no PROJ.
_ON_SPHERE = {"lcc", "stere", "ob_tran", "eqc", "eqearth", "merc"}
#: Their keywords with numbers, and those that say what is usual. With any other PROJ is needed.
_OF_SPHERE = {"R", "lat_0", "lat_1", "lat_2", "lat_ts", "lon_0", "o_lat_p", "o_lon_p"}
_USUAL = {"no_defs", "type=crs", "units=m", "wktext", "x_0=0", "y_0=0"}
#: Share of the latitudes of a map from its sides to the two parallels that are true to scale.
_INNER = 1 / 6
#: Extents in degrees: of a map that is taken for flat, of one that a cone can hold, and of one
#: around the earth; latitudes of a map's middle, and of its end, from which on it is drawn so.
SMALL, WIDE, AROUND, MIDDLE, POLAR = 5.0, 185.0, 340.0, 25.0, 15.0
#: Largest ratio of the scales of a map on which north is up everywhere.
MOST_SCALES = 1.5
#: Coefficients of the Equal Earth projection, and steps of its inverse.
EQUAL_EARTH, NEWTON = np.array([1.340264, -0.081106, 0.000893, 0.003796]), 12


@dataclass(frozen=True)
class Projection:
    """Pair of functions between the earth and a plane.

    ``forward`` takes longitudes and latitudes in degrees, (N, 2), to x and y in metres, which are
    not finite where a place is not on the map; ``inverse`` takes them back.
    """

    forward: Callable[[Array], Array]
    inverse: Callable[[Array], Array]


def keywords(text: str) -> dict[str, str]:
    """Return the keywords of PROJ in a text and their values, but for those that all texts have."""
    parts = [part.lstrip("+") for part in text.split()]
    return dict(part.partition("=")[::2] for part in parts if part not in _USUAL)


def of_text(text: str) -> Projection | None:
    """Return a projection by its text, None where it is none that can be computed here.

    It is keywords of PROJ, or a reference system that rasterio reads, such as its WKT.
    """
    words = keywords(text)
    kind = words.get("proj", "")
    if kind not in _ON_SPHERE or {*words} - _OF_SPHERE - {"proj", "o_proj"}:
        return _by_proj(text)
    numbers = {key: float(word) for key, word in words.items() if key in _OF_SPHERE}
    middle = (math.radians(numbers.get("lon_0", 0.0)), math.radians(numbers.get("lat_0", 0.0)))
    radius = numbers.get("R", RADIUS)
    if kind == "eqc":
        return _plane(middle, math.cos(math.radians(numbers["lat_ts"])), radius)
    if kind == "merc":
        return _cylinder(middle[0], math.cos(math.radians(numbers.get("lat_ts", 0.0))), radius)
    if kind == "eqearth":
        return _equal_earth(middle[0], radius)
    if kind == "ob_tran" and words.get("o_proj") == "eqc":
        pole = math.radians(numbers["o_lat_p"])
        return _rotated(pole, middle[0], math.radians(numbers.get("o_lon_p", 0.0)), radius)
    if kind == "lcc":
        first = math.radians(numbers["lat_1"])
        return _cone((first, math.radians(numbers.get("lat_2", numbers["lat_1"]))), middle, radius)
    if kind == "stere" and abs(numbers["lat_0"]) == 90 and "lat_ts" not in words:
        return _cone((middle[1], middle[1]), middle, radius)
    return _by_proj(text)


def _by_proj(text: str) -> Projection | None:
    """Return a projection of PROJ, None without rasterio or where it knows none of this text."""
    try:
        from rasterio._err import CPLE_BaseError
        from rasterio.crs import CRS
        from rasterio.errors import CRSError
        from rasterio.warp import transform
    except ImportError:
        return None
    try:
        plane, earth = CRS.from_string(text), CRS.from_epsg(4326)
    except CRSError:
        return None
    if not plane.is_projected:
        return None
    factor: float = plane.linear_units_factor[1]

    def between(start: Foreign, end: Foreign, places: Array) -> Array:
        try:
            return np.column_stack(transform(start, end, places[:, 0], places[:, 1])[:2])
        except CPLE_BaseError:
            # One place beyond the projection takes all others with it.
            if len(places) < 2:
                return np.full((len(places), 2), np.nan)
        return np.concatenate([between(start, end, part) for part in np.array_split(places, 2)])

    return Projection(
        lambda places: factor * between(earth, plane, places),
        lambda places: between(plane, earth, places / factor),
    )


def _plane(middle: tuple[float, float], narrow: float, radius: float) -> Projection:
    """Return the equirectangular projection; ``narrow`` is the length of a degree of longitude."""
    scale = radius * np.array([narrow, 1.0])

    def forward(places: Array) -> Array:
        return scale * (_around(np.radians(places), middle[0]) - middle)

    return Projection(forward, lambda places: np.degrees(places / scale + middle))


def _cylinder(middle: float, narrow: float, radius: float) -> Projection:
    """Return Mercator's projection; ``narrow`` is the cosine of the latitude of true scale.

    Snyder, Map Projections: A Working Manual (1987), equations 7-1, 7-2 and 7-4.
    """
    scale = radius * narrow

    def forward(places: Array) -> Array:
        lon, lat = _around(np.radians(places), middle).T
        return scale * np.column_stack([lon - middle, np.arcsinh(np.tan(lat))])

    def inverse(places: Array) -> Array:
        x, y = places.T / scale
        return np.asarray(np.degrees(np.column_stack([x + middle, np.arctan(np.sinh(y))])))

    return Projection(forward, inverse)


def _around(angles: Array, middle: float) -> Array:
    """Return longitudes and latitudes in radians, with longitudes near a middle one."""
    # Both ends of a whole turn stay where they are, to the digits of files in single precision.
    turns = np.round((angles[:, 0] - middle) / (2 * math.pi) * (1 - 1e-6))
    return angles - 2 * math.pi * np.column_stack([turns, np.zeros_like(turns)])


def _equal_earth(middle: float, radius: float) -> Projection:
    """Return the Equal Earth projection, whose meridians bend and whose areas are true.

    Savric, Patterson and Jenny, The Equal Earth map projection (2019), equations 5 to 8.
    """
    powers = np.array([1, 3, 7, 9])

    def rows(angle: Array) -> tuple[Array, Array]:
        """Return y of the parametric latitude, and its derivative."""
        every = angle[:, np.newaxis] ** (powers - 1)
        return angle * (every @ EQUAL_EARTH), every @ (powers * EQUAL_EARTH)

    def forward(places: Array) -> Array:
        lon, lat = _around(np.radians(places), middle).T
        angle = np.arcsin(math.sqrt(3) / 2 * np.sin(lat))
        y, steep = rows(angle)
        x = 2 / math.sqrt(3) * (lon - middle) * np.cos(angle) / steep
        return radius * np.column_stack([x, y])

    def inverse(places: Array) -> Array:
        x, y = places.T / radius
        angle = np.clip(y, -math.pi / 3, math.pi / 3)
        for _ in range(NEWTON):
            row, steep = rows(angle)
            angle = np.clip(angle - (row - y) / steep, -math.pi / 3, math.pi / 3)
        lon = math.sqrt(3) / 2 * x * rows(angle)[1] / np.cos(angle) + middle
        lat = np.arcsin(np.clip(2 / math.sqrt(3) * np.sin(angle), -1, 1))
        return np.asarray(np.degrees(np.column_stack([lon, lat])))

    return Projection(forward, inverse)


def _rotated(pole: float, meridian: float, start: float, radius: float) -> Projection:
    """Return the equirectangular projection about a pole at a latitude.

    The meridian through it is that of 0 on the map, in degrees east of where ``start`` is 0.
    """
    sin, cos = math.sin(pole), math.cos(pole)
    turn = np.array([[sin, 0.0, cos], [0.0, 1.0, 0.0], [-cos, 0.0, sin]])

    def forward(places: Array) -> Array:
        angles = _angles(_directions(np.radians(places) - (meridian, 0.0)) @ turn.T)
        return radius * _around(angles + np.array([start, 0.0]), 0.0)

    def inverse(places: Array) -> Array:
        angles = _angles(_directions(places / radius - (start, 0.0)) @ turn)
        return np.asarray(np.degrees(angles + np.array([meridian, 0.0])))

    return Projection(forward, inverse)


def _directions(angles: Array) -> Array:
    lon, lat = angles.T
    return np.column_stack([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])


def _angles(ways: Array) -> Array:
    x, y, z = ways.T
    return np.column_stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))])


def _cone(parallels: tuple[float, float], middle: tuple[float, float], radius: float) -> Projection:
    """Return Lambert's conformal conic projection, about a pole the stereographic one.

    Snyder, Map Projections: A Working Manual (1987), equations 15-1 to 15-5 and 14-4.
    """
    first, second = parallels
    if abs(first - second) < 1e-9:
        n = math.sin(first)
    else:
        n = math.log(math.cos(first) / math.cos(second)) / math.log(_half(first) / _half(second))
    side = math.copysign(1.0, n)
    # cos / tan is 1 + sin, which is no quotient of zeros at a pole.
    scale = radius * (1 + math.sin(side * first)) / abs(n) * _half(side * first) ** (1 - abs(n))
    far = scale * _half(side * middle[1]) ** abs(n)

    def forward(places: Array) -> Array:
        lon, lat = _around(np.radians(places), middle[0]).T
        # The other pole is infinitely far.
        lat = side * np.maximum(side * lat, math.radians(-89.9))
        rho = scale * _half(side * lat) ** abs(n)
        turn = abs(n) * (lon - middle[0])
        return np.column_stack([rho * np.sin(turn), side * (far - rho * np.cos(turn))])

    def inverse(places: Array) -> Array:
        x, y = places[:, 0], far - side * places[:, 1]
        half = (np.hypot(x, y) / scale) ** (1 / abs(n))
        lat = side * (math.pi / 2 - 2 * np.arctan(half))
        lon = np.arctan2(x, y) / abs(n) + middle[0]
        return np.asarray(np.degrees(np.column_stack([lon, lat])))

    return Projection(forward, inverse)


def _half(lat: Foreign) -> Foreign:
    """Return the tangent of half the angle from the north pole, 0 there."""
    return np.maximum(np.tan(math.pi / 4 - lat / 2), 0.0)


def of_attributes(attributes: Mapping[str, Foreign]) -> str:
    """Return the text of a projection by the attributes of CF or of WRF, empty for none.

    They are those of a variable with ``grid_mapping_name``, or of a file with ``MAP_PROJ``.
    """
    if "MAP_PROJ" in attributes:
        return _of_wrf(attributes)
    if "grid_north_pole_latitude" in attributes:
        pole = float(attributes["grid_north_pole_latitude"])
        meridian = float(attributes.get("grid_north_pole_longitude", 180.0)) - 180.0
        start = float(attributes.get("north_pole_grid_longitude", 0.0))
        words = f"+o_lat_p={pole:.10g} +o_lon_p={start:.10g} +lon_0={meridian:.10g}"
        return f"+proj=ob_tran +o_proj=eqc {words} +R={RADIUS}"
    for key in _WRITTEN:
        if attributes.get(key):
            return str(attributes[key])
    kind = _NAMES.get(str(attributes.get("grid_mapping_name", "")))
    if kind is None:
        return ""
    numbers = {
        word: float(attributes[key])
        for key, word in _KEYWORDS.items()
        if np.size(attributes.get(key, ())) == 1
    }
    parallels = np.ravel(attributes.get("standard_parallel", ()))
    keys = ("lat_ts",) if kind in ("stere", "merc", "cea") else ("lat_1", "lat_2")
    numbers |= {key: float(value) for key, value in zip(keys, parallels, strict=False)}
    if kind == "stere" and "lat_ts" in numbers:
        numbers.pop("k_0", None)
    parts = [f"+{key}={word:.12g}" for key, word in numbers.items()]
    if kind == "geos":
        # A mirror turns about one axis, and another one about the other.
        fixed = {"x": "y", "y": "x"}.get(str(attributes.get("fixed_angle_axis", "")), "y")
        parts.append(f"+sweep={attributes.get('sweep_angle_axis', fixed)}")
    return " ".join([f"+proj={kind}", *parts])


def _of_wrf(attributes: Mapping[str, Foreign]) -> str:
    """Return the text of the cone of WRF, empty for its other projections."""
    first, second, meridian = (
        float(attributes.get(key, 0.0)) for key in ("TRUELAT1", "TRUELAT2", "STAND_LON")
    )
    if attributes["MAP_PROJ"] == 1 and first:
        middle = float(attributes.get("MOAD_CEN_LAT", first))
        return _text_of_cone(first, second or first, middle, meridian)
    if attributes["MAP_PROJ"] == 2:
        return _text_of_pole(math.copysign(90.0, first), meridian)
    return ""


def _text_of_cone(first: float, second: float, lat: float, lon: float) -> str:
    parallels = f"+lat_1={first:.6g} +lat_2={second:.6g}"
    return f"+proj=lcc {parallels} +lat_0={lat:.6g} +lon_0={lon:.6g} +R={RADIUS}"


def _text_of_pole(lat: float, lon: float) -> str:
    return f"+proj=stere +lat_0={lat:g} +lon_0={lon:.6g} +R={RADIUS}"


def around(lon: float) -> str:
    """Return the text of the projection that suits a map around the earth.

    ``lon`` is the longitude of its middle in degrees.
    """
    return f"+proj=eqearth +lon_0={lon:.9g} +R={RADIUS}"


def suited(bounds: Sequence[float], *, straight: bool = False, north_up: bool = False) -> str:
    """Return the text of the projection that suits a map in degrees, empty for none.

    A small map is equirectangular about its middle. A larger one of the middle latitudes is
    Lambert's conformal cone, or Mercator's where north is to be up and scales differ little, and
    one around a pole is stereographic. Bounds are west, east, south and north in degrees; options
    are as for :func:`vizlight.mesh.charts.suited`.
    """
    west, east, south, north = bounds[:4]
    lon, lat = (west + east) / 2, (south + north) / 2
    wide = east - west
    if not straight and wide > AROUND and max(south, -north) >= POLAR:
        return _text_of_pole(math.copysign(90.0, lat), lon)
    if wide > WIDE or abs(lat) < MIDDLE or max(north, -south) > 90:
        return ""
    if straight or max(wide * math.cos(math.radians(lat)), north - south) < SMALL:
        return f"+proj=eqc +lat_ts={lat:.6g} +lat_0={lat:.6g} +lon_0={lon:.6g} +R={RADIUS}"
    scales = [1 / max(math.cos(math.radians(row)), 1e-6) for row in (south, north)]
    if north_up and south * north > 0 and max(scales) <= MOST_SCALES * min(scales):
        return f"+proj=merc +lat_ts={lat:.6g} +lon_0={lon:.6g} +R={RADIUS}"
    # A cone holds no place beyond the equator that is as far as the pole.
    if south < -POLAR < POLAR < north or max(-south, north) < 0:
        return ""
    inner = _INNER * (north - south)
    first, second = min(south + inner, 85.0), min(north - inner, 85.0)
    return _text_of_cone(max(first, -85.0), max(second, -85.0), lat, lon)
