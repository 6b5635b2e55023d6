"""Rasters, and where on the Earth they lie."""

from __future__ import annotations

import math
import re
import warnings
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign, Raw, Slice
from vizlight.mesh import blocks, composites, fills, meaning, sections
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
    """Return whether the x and y of a mesh are said to be in degrees.

    Parameters
    ----------
    mesh : pyvista.DataSet
    """
    return unit_of(mesh) == DEGREE


def unit_of(mesh: pv.DataSet) -> str:
    """Return the unit of the x and y of a mesh, empty where nothing is said of it.

    Parameters
    ----------
    mesh : pyvista.DataSet
    """
    return str(mesh.field_data[UNIT][0]) if UNIT in mesh.field_data else ""


def in_metres(mesh: DataSetT) -> DataSetT:
    """Return a map in metres east and north of its centre, if it is in degrees.

    A degree of latitude has 111,195 m, one of longitude ``cos(latitude)`` of that, for the
    latitude of the centre: lengths agree with the ellipsoid's to 0.6 % there, up to 88.9 degrees
    north or south, and east to west farther from the centre to the ratio of the cosines.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is in degrees if its field array ``unit`` says so.

    Returns
    -------
    pyvista.DataSet
        Copy that shares the arrays, or the mesh itself where it is not in degrees.
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
    wind of equal parts east and north crosses more degrees of longitude than of latitude.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh; one that is no map has factors of 1.
    places : ndarray, shape (N, 3)
        Places in the coordinates of the mesh.

    Returns
    -------
    ndarray, shape (N, 3)
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
    make its cells columns or discs.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which may be a map.
    traced : pyvista.DataSet
        The mesh itself, or a surface in its coordinates.

    Returns
    -------
    ndarray, shape (3,)
    """
    x, y, z = traced.bounds_size
    if is_map(mesh) and traced.GetMaxSpatialDimension() == 3 and min(max(x, y), z) > 0:
        side = max(x, y)
        return np.array([1 / side, 1 / side, 1 / z])
    return np.full(3, 1 / blocks.box(traced)[1])


def motion(mesh: pv.DataSet, traced: pv.DataSet, vectors: Array, scale: Array) -> Array:
    """Return vectors at the points of a mesh in its coordinates, times the scale of each axis.

    Parameters
    ----------
    mesh, traced
        As for :func:`scale_to_one`.
    vectors : ndarray, shape (N, 3 k)
        Vectors, of a map in metres east and north.
    scale : ndarray, shape (3,)
        Scale of each axis, as a share of that of x.
    """
    factors = scale / scale[0]
    if is_map(mesh):
        factors = factors * rates(mesh, np.asarray(traced.points, dtype=np.float64))
    elif np.all(factors == 1):
        return vectors
    rows = vectors.reshape(len(vectors), -1, 3)
    return np.asarray(rows * np.reshape(factors, (-1, 1, 3))).reshape(vectors.shape)


def is_map(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a map in degrees, or was one.

    Parameters
    ----------
    mesh : pyvista.DataSet
    """
    return has_degrees(mesh) or LATITUDE in mesh.field_data or PROJECTION in mesh.field_data


def seem_degrees(grid: pv.DataSet, heights: str) -> bool:
    """Return whether a grid of unknown unit is in degrees.

    Its x and y can be longitude and latitude, and its heights range over more than its sides,
    as no terrain does whose x and y are in the unit of its heights.

    Parameters
    ----------
    grid : pyvista.DataSet
        Grid of one layer.
    heights : str
        Name of a point array.
    """
    bounds = grid.bounds
    # Longitudes run from -180 to 180 or from 0 to 360.
    places = bounds.x_min >= -180 and bounds.x_max <= 360 and abs(grid.center[1]) <= 90
    degrees = places and max(abs(bounds.y_min), abs(bounds.y_max)) <= 90
    # Pixels of an image that has no place are one apart.
    fine = max(getattr(grid, "spacing", (0.0, 0.0))[:2]) < 1
    return degrees and fine and _spread(grid, heights) > max(grid.bounds_size[:2])


def is_earth(mesh: pv.DataSet) -> bool:
    """Return whether the x and y of a mesh of unknown unit are those of the whole earth in degrees.

    Parameters
    ----------
    mesh : pyvista.DataSet
    """
    west, east, south, north, low, high = mesh.bounds
    is_around = 340 < east - west < 361 and min(abs(west), abs(west + 180)) < 10
    from_pole_to_pole = south >= -90 and north <= 90 and north - south > 150
    return UNIT not in mesh.field_data and is_around and from_pole_to_pole and low == high


def on_earth(mesh: pv.DataSet) -> bool:
    """Return whether no reference system of a mesh says that it is of another planet.

    Parameters
    ----------
    mesh : pyvista.DataSet
    """
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

    It is 1 where they range over a twentieth of the side of the map to half of it; else the 1, 2
    or 5 with zeros that comes next to that.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh whose points the heights raise; one in degrees is taken in metres.
    heights : str
        Name of a point array of one component.
    side : float, optional
        Length beside which the heights are seen. Default: the side of the map.
    """
    if side is not None:
        return _factor(_spread(mesh, heights), side)
    sides = sorted(in_metres(mesh).bounds_size)
    # The two longer sides are those of the map. One row of points has no area.
    return _factor(_spread(mesh, heights), math.sqrt(sides[1] * sides[2]) or sides[2])


def stretch(mesh: pv.DataSet) -> float:
    """Return the factor of z with which a volume over a map in degrees can be seen, 1 for others.

    Air and sea are thin beside their maps, and levels are often numbers; see :func:`exaggeration`.
    Of a vertical section it is that of y.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh.
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


def _spread(mesh: pv.DataSet, heights: str) -> float:
    return _range_of(mesh.point_data[heights])


def _range_of(heights: Raw) -> float:
    """Return the range of heights, without that of single wrong ones."""
    values = np.asarray(heights, dtype=np.float64)
    values = values[np.isfinite(values)]
    return float(np.ptp(np.percentile(values, RANGE))) if values.size else 0.0


#: File name extensions of the rasters that are read by rasterio.
SUFFIXES = (
    ".tif", ".tiff", ".gtiff", ".asc", ".hgt", ".bil", ".dt0", ".dt1", ".dt2", ".adf", ".vrt",
    ".flt", ".grd", ".kea",
)  # fmt: skip
#: Pixels whose values are looked at.
SAMPLE = 100_000
#: Range of values, and as a share of the side of their map, below which they are no heights of it:
#: indices, shares, balances of ice.
SLIGHT, FLATTEST = 10.0, 1e-3
#: Highest and deepest ground of the earth in metres, with some to spare.
HIGHEST, DEEPEST = 9000, 12_000
#: Names of bands of satellites, of indices of them, and of other quantities that are no heights, in
#: lower case.
_NO_HEIGHTS = re.compile(
    r"(^|[^a-z])(b(and)?_?\d{1,2}a?|nd[vwsb]i|evi|refl\w*|toa|swir\d?|nir|pan|albedo|radiation|solar"
    r"|popul\w*|densit\w*|temp\w*|precip\w*|rain\w*|wind\w*|humidity|bio_?\d+|slopes?|aspect|twi"
    r"|hillshade|flow_?(acc\w*|dir\w*)|prob\w*|conc\w*|soil\w*|risk|hazard|land_?(cover|use))"
    r"($|[^a-z0-9])"
)
#: Channels of a picture in colour.
_COLORS = ("red", "green", "blue")
#: Interpretations and types of bands by name.
Kinds: TypeAlias = "dict[str, tuple[str, str]]"


def read(path: Path, nodata: float | None = None) -> pv.ImageData | pv.StructuredGrid:
    """Return the bands of a raster at the centres of its pixels, x east and y north.

    A band is a point array of its description, or ``elevation`` where it is the only one, else
    ``band_1``, ``band_2``, ...; red, green and blue are ``rgb`` as bytes, beside their bands where
    these are no picture: by what the file or their names say, else the first of 3 or 4 bands of
    whole numbers. A single band that can be no heights is named like its file: its unit is no
    length, it has a few whole numbers, or a range of a few units on a map a thousand times wider,
    or it is a gray picture, of bytes, or of numbers without a sign and a place. What the file marks
    as missing is NaN. The field data have its reference system as ``crs``, and its unit.

    Parameters
    ----------
    path : pathlib.Path
        Path of the file.
    nodata : float, optional
        Value that stands for none, as for :func:`.fills.without_missing`.

    Returns
    -------
    pyvista.ImageData or pyvista.StructuredGrid
        A structured grid where rows and columns are not along the axes.

    Raises
    ------
    ValueError, rasterio.errors.RasterioError
        If there is no band of numbers, or a part of the file is missing.
    """
    import rasterio

    with warnings.catch_warnings():
        # A raster without a place is a grid of pixels.
        warnings.simplefilter("ignore", rasterio.errors.NotGeoreferencedWarning)
        with rasterio.open(path) as file:
            if (stack := _stack(file, path, nodata)) is not None:
                return stack
            arrays, units, kinds = _bands(file, path.name.split(".")[0])
            grid, turned = _grid(file)
            # A picture with a model of its camera has a system, but its pixels have no place.
            crs = None if file.transform.is_identity else file.crs
            on_page = _has_no_place(file)
            axes = meaning.PAGE if on_page else ["x east", "y north"]
    words, said = [], meaning.Meaning(axes=axes)
    for name, rows in arrays.items():
        # Heights without a unit on a map are taken for metres, as lengths are.
        metres = "m" if name == "elevation" and crs is not None else None
        said.add_array(name, {"units": units.get(name) or metres})
        arrays[name], missing = fills.without_missing(name, rows, nodata)
        words += [missing] if missing else []
    arrays = _colored(arrays, kinds, said)
    for name, rows in arrays.items():
        # Copied, since the arrays of a mesh are in the order of its points.
        shape = (grid.n_points, *rows.shape[2:])
        grid.point_data[name] = np.ascontiguousarray(rows[turned]).reshape(shape)
    grid.set_active_scalars(next(iter(arrays)))
    said.notes += fills.say(path, words)
    if crs is not None:
        # PyVista keeps words in ASCII alone; other letters stand in names, which mean nothing.
        grid.field_data["crs"] = [crs.to_wkt().encode("ascii", "replace").decode("ascii")]
        # A projected system has a unit of length, which it names.
        unit = DEGREE if crs.is_geographic else crs.linear_units
        if not crs.is_geographic and meaning.metres(unit) == KILOMETRE:
            # Heights are in metres, and so are then lengths.
            grid, unit = (
                blocks.moved(grid, np.zeros(3), np.array([KILOMETRE, KILOMETRE, 1])),
                "metre",
            )
            said.notes.append("lengths in m, from km")
        grid.field_data[UNIT] = [unit]
        said.axes = [f"{axis} in {unit} by the reference system" for axis in said.axes]
    # Many files of elevations name no system: then only the numbers tell of degrees.
    elif seem_degrees(grid, next(iter(arrays))):
        grid.field_data[UNIT] = [DEGREE]
        said.notes.append("taken for degrees by their ranges")
    elif "elevation" in arrays and not on_page and not units.get("elevation"):
        # Coordinates and heights of one unit, which it mostly is.
        grid.field_data[UNIT] = ["metre"]
        said.add_array("elevation", {"units": "m"})
        said.notes.append("lengths and heights taken for metres")
    meaning.attach(grid, said)
    return grid


def place_alike(lines: pv.DataSet, mesh: pv.DataSet) -> None:
    """Say of lines that they lie on the map, and in the frame, of the mesh that they are made from.

    Parameters
    ----------
    lines, mesh : pyvista.DataSet
    """
    for key in (UNIT, PROJECTION, meaning.MEANING):
        if key in mesh.field_data:
            lines.field_data[key] = mesh.field_data[key]


def _stack(file: Foreign, path: Path, nodata: float | None) -> pv.ImageData | None:
    """Return the pages of a file of images without a place as a volume, None where it has one.

    The first page is on top, as that of a pile of paper, which mirrors nothing.
    """
    import rasterio

    # They are listed in the order of the alphabet, by names such as GTIFF_DIR:10:path.
    listed = file.subdatasets if file.driver == "GTiff" else ()
    names = sorted(listed, key=lambda name: int(name.split(":")[1]))
    if len(names) < 2 or not _has_no_place(file):
        return None
    pages: list[Raw] = []
    for name in names:
        with rasterio.open(name) as page:
            pages.append(_band(page, 0))
    if {page.shape for page in pages} != {pages[0].shape} or file.count > 1:
        words = "pages of several sizes or colours are no volume"
        _check.warn(f"file: '{path}': the first of {len(pages)} pages is read: {words}")
        return None
    name = path.name.split(".")[0]
    values, missing = fills.without_missing(name, np.stack(pages[::-1])[:, ::-1], nodata)
    tags = file.tags()
    size = float(tags.get("TIFFTAG_XRESOLUTION", 0))
    # ImageJ's description has the distance of pages, and the unit in which pixels are counted.
    said = dict(re.findall(r"(?m)^(unit|spacing)=(.*)$", tags.get("TIFFTAG_IMAGEDESCRIPTION", "")))
    pixel = 1 / size if "unit" in said and size > 0 else 1.0
    apart = float(said.get("spacing", pixel))
    volume = pv.ImageData(dimensions=values.shape[::-1], spacing=(pixel, pixel, apart))
    volume.point_data[name] = values.ravel()
    notes = [f"{len(pages)} pages as a volume, the first on top"]
    notes += fills.say(path, [missing] if missing else [])
    if "spacing" not in said:
        notes.append("pages are taken to be as far apart as pixels")
    meaning.attach(volume, meaning.Meaning(axes=[*meaning.PAGE, "z up"], notes=notes))
    return volume


def _bands(file: Foreign, stem: str) -> tuple[dict[str, Raw], dict[str, str], Kinds]:
    """Return the bands by name, (rows, columns) each, their units, kinds and types."""
    count = file.count
    found: dict[str, Raw] = {}
    units: dict[str, str] = {}
    kinds: Kinds = {}
    for i in range(count):
        kind = file.colorinterp[i].name
        # Complex numbers, as of radar, are no heights; NumPy has no name for some of them. Opacity
        # is in the mask of the other bands.
        if file.dtypes[i].startswith("complex") or (kind == "alpha" and found):
            continue
        rows = _band(file, i)
        name = file.descriptions[i] or file.tags(i + 1).get("NETCDF_VARNAME") or f"band_{i + 1}"
        unit = _unit(file, i)
        if count == 1 and name == "band_1":
            # What a camera or a satellite counts, and a density, have the unit of no length.
            is_counted = _is_picture(file) or _has_no_heights(file, stem, rows)
            unit = unit or ("1" if is_counted else "")
            is_length = not unit or meaning.metres(unit) is not None
            name = "elevation" if is_length and not _of_classes(rows) else stem
        palette = file.colormap(i + 1) if kind == "palette" and rows.dtype == np.uint8 else {}
        if len(palette) > meaning.MOST_KINDS and not _of_classes(rows):
            # Numbers of colours, as of a picture.
            of_number: Raw = np.zeros((256, 3), np.uint8)
            of_number[[*palette]] = [color[:3] for color in palette.values()]
            name, unit, rows = "rgb", "", of_number[rows]
        # Two bands may have one description.
        name = f"{name}_{i + 1}" if name in found else name
        found[name], units[name] = rows, unit
        kinds[name] = kind, file.dtypes[i]
    if not found:
        raise ValueError("no band of numbers that are not complex")
    return found, units, kinds


def _colored(arrays: dict[str, Raw], kinds: Kinds, said: meaning.Meaning) -> dict[str, Raw]:
    """Return bands with the colours of three of them first, where three are red, green and blue.

    Bytes that the file itself calls so are a picture, whose bands are left out.
    """
    names = composites.colors_among(kinds)
    if not names:
        return arrays
    is_picture = all(
        kinds[name] == (color, "uint8") for name, color in zip(names, _COLORS, strict=True)
    )
    if not is_picture and any(_of_classes(arrays[name]) for name in names):
        return arrays
    as_stored = all(kinds[name][1] == "uint8" for name in names)
    rgb = composites.composite([arrays[name] for name in names], as_stored=as_stored)
    if is_picture:
        return {"rgb": rgb} | {name: arrays[name] for name in arrays if name not in names}
    said.add_array("rgb", {"long_name": ", ".join(names)})
    if not as_stored:
        low, high = composites.ENDS
        said.notes.append(f"colours run from their percentile {low} to {high}")
    return {"rgb": rgb} | arrays


def _unit(file: Foreign, i: int) -> str:
    """Return the unit of a band, empty without one."""
    return str(file.units[i] or file.tags(i + 1).get("units", ""))


def _is_picture(file: Foreign) -> bool:
    """Return whether the first band is in the numbers of a camera, which heights seldom are in."""
    kind = file.dtypes[0]
    as_stored = file.scales[0] == 1 and file.offsets[0] == 0
    return as_stored and (kind == "uint8" or (kind == "uint16" and _has_no_place(file)))


def _has_no_heights(file: Foreign, stem: str, rows: Raw) -> bool:
    """Return whether a band is no heights by its name, by counts beyond them, or its flatness."""
    counts = file.dtypes[0] == "uint16" and float(np.nanmax(rows, initial=0)) > HIGHEST
    if counts or _NO_HEIGHTS.search(stem.lower()) is not None:
        return True
    degrees = file.crs is not None and file.crs.is_geographic
    area = abs(file.transform.determinant) * file.width * file.height
    side = math.sqrt(area) * (METRES if degrees else 1.0)
    return 0 < _range_of(rows) < min(SLIGHT, FLATTEST * side)


def _has_no_place(file: Foreign) -> bool:
    """Return whether the pixels of a file have no place on the ground."""
    return bool(file.transform.is_identity) and file.crs is None


def _of_classes(rows: Raw) -> bool:
    """Return whether a band has a few whole numbers alone, as classes have."""
    sample = rows.ravel()[:: max(rows.size // SAMPLE, 1)]
    known = np.unique(sample[np.isfinite(sample)]).astype(np.float64)
    few = len(known) <= meaning.MOST_KINDS < len(sample) / 100
    return few and bool(np.all(known == np.round(known)))


#: Name of the tags of a file that say how its numbers are stored.
_STRUCTURE = "IMAGE_STRUCTURE"


def _band(file: Foreign, i: int) -> Raw:
    """Return the values of a band in the file's unit, NaN where they are missing."""
    rows = file.read(i + 1, masked=True)
    if file.tags(ns=_STRUCTURE).get("MINISWHITE") == "YES" and _has_no_place(file):
        # The numbers of an image count up from white, as those of paper that was scanned.
        bits = int(file.tags(i + 1, ns=_STRUCTURE).get("NBITS", 8 * rows.dtype.itemsize))
        rows = rows.dtype.type(2**bits - 1) - rows
    scale, offset = file.scales[i], file.offsets[i]
    holes = np.ma.getmaskarray(rows)
    # Labels and colours without a hole stay integers, in a half or a quarter of the memory.
    if scale == 1 and offset == 0 and not holes.any():
        return np.asarray(rows.data)
    # 24 bits hold integers of 16, not of 32.
    wide = rows.dtype.itemsize > (4 if rows.dtype.kind == "f" else 2)
    values = rows.data.astype(np.float64 if wide else np.float32) * scale + offset
    values[holes] = np.nan
    return np.asarray(values)


def _grid(file: Foreign) -> tuple[pv.ImageData | pv.StructuredGrid, tuple[Slice, Slice]]:
    """Return the grid of a raster, and the order of rows and columns along which x and y rise."""
    # Column u and row v of a raster are at x = a u + b v + c and y = d u + e v + f.
    a, b, c, d, e, f = tuple(file.transform)[:6]
    if file.transform.is_identity:
        e, f = -1.0, float(file.height)  # a picture, whose first row is its top
    # Values are those of the middle of a pixel, half of one from the corner that is mapped.
    columns, rows = np.arange(file.width) + 0.5, np.arange(file.height) + 0.5
    if b == d == 0:
        # Axes of VTK rise. Rows mostly run from north to south, so they are turned over.
        turned = slice(None, None, -1 if e < 0 else 1), slice(None, None, -1 if a < 0 else 1)
        x: Array = (c + a * columns)[turned[1]]
        y: Array = (f + e * rows)[turned[0]]
        image = pv.ImageData(
            dimensions=(file.width, file.height, 1),
            spacing=(abs(a), abs(e), 1.0),
            origin=(x[0], y[0], 0.0),
        )
        return image, turned
    # Rows that are turned or sheared: each point has a place of its own.
    u, v = np.meshgrid(columns, rows)
    points = np.stack([a * u + b * v + c, d * u + e * v + f, np.zeros_like(u)], axis=-1)
    grid = pv.StructuredGrid()
    grid.dimensions = (file.width, file.height, 1)
    grid.points = points.reshape(-1, 3)
    return grid, (slice(None), slice(None))
