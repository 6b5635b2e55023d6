"""Rasters: images of values on the earth or on a plane, by rasterio."""

from __future__ import annotations

import importlib.util
import math
import re
import warnings
from pathlib import Path
from typing import TypeAlias

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign, Raw, Slice
from vizlight.mesh import blocks, fills, meaning
from vizlight.mesh.georeference import DEGREE, KILOMETRE, METRES, UNIT, range_of, seem_degrees
from vizlight.reading import composites, file_parts

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
#: Name of the tags of a file that say how its numbers are stored.
_STRUCTURE = "IMAGE_STRUCTURE"
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
    as missing is NaN. The field data have its reference system as ``crs``, and its unit. ``nodata``
    is as for :func:`.fills.without_missing`; the grid is structured where rows and columns are not
    along the axes.
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
            on_page = _has_no_place(file)
            crs = None if on_page else file.crs
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
    else:
        in_metres = "elevation" in arrays and not on_page and not units.get("elevation")
        if in_metres:
            said.add_array("elevation", {"units": "m"})
        if seem_degrees(grid, next(iter(arrays))):
            grid.field_data[UNIT] = [DEGREE]
            heights = ", heights for metres" * in_metres
            said.notes.append(f"taken for degrees by their ranges{heights}")
        elif in_metres:
            # Coordinates and heights of one unit, which it mostly is.
            grid.field_data[UNIT] = ["metre"]
            said.notes.append("lengths and heights taken for metres")
    return meaning.attach(grid, said)


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
    return meaning.attach(volume, meaning.Meaning(axes=[*meaning.PAGE, "z up"], notes=notes))


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
    counts = file.dtypes[0].startswith("uint") and float(np.nanmax(rows, initial=0)) > HIGHEST
    if counts or _NO_HEIGHTS.search(stem.lower()) is not None:
        return True
    degrees = file.crs is not None and file.crs.is_geographic
    area = abs(file.transform.determinant) * file.width * file.height
    side = math.sqrt(area) * (METRES if degrees else 1.0)
    return 0 < range_of(rows) < min(SLIGHT, FLATTEST * side)


def _has_no_place(file: Foreign) -> bool:
    """Return whether the pixels of a file have no place on the ground."""
    # A picture with a model of its camera has a system of reference, but no place in it.
    return bool(file.transform.is_identity)


def _of_classes(rows: Raw) -> bool:
    """Return whether a band has a few whole numbers alone, as classes have."""
    sample = rows.ravel()[:: max(rows.size // SAMPLE, 1)]
    known = np.unique(sample[np.isfinite(sample)]).astype(np.float64)
    few = len(known) <= meaning.MOST_KINDS < len(sample) / 100
    return few and bool(np.all(known == np.round(known)))


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
    if file.driver == "AAIGrid":
        c, f = c + _left_out(file, "x"), f + _left_out(file, "y")
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
    grid = blocks.structured(points.reshape(-1, 3), (file.width, file.height, 1))
    return grid, (slice(None), slice(None))


#: A corner of a grid in text in degrees, minutes and seconds, such as 12°40'E.
_CORNER = re.compile(
    r"(?im)^(?P<axis>[xy])ll(?:corner|center)\s+(?P<degrees>[+-]?\d+)\s*°"
    r"(?:\s*(?P<minutes>[\d.]+)\s*['′])?(?:\s*(?P<seconds>[\d.]+)\s*[\"″])?\s*(?P<side>[NSEW]?)"
)


def _left_out(file: Foreign, axis: str) -> float:
    """Return the degrees by which a corner in words is off its first number, which GDAL reads."""
    with Path(file.name).open(encoding="utf-8", errors="replace") as text:
        corners = _CORNER.finditer(text.read(1 << 10))
    for corner in corners:
        if corner["axis"].lower() == axis:
            whole = float(corner["degrees"])
            parts = float(corner["minutes"] or 0) / 60 + float(corner["seconds"] or 0) / 3600
            angle = math.copysign(abs(whole) + parts, whole)
            return (-angle if corner["side"].upper() in ("S", "W") else angle) - whole
    return 0.0


#: Place of the number of columns in the header of an elevation model, and the least that VTK reads.
_DEM_COLUMNS, _DEM_LEAST = slice(858, 864), 100


def read_dem(path: Path) -> pv.ImageData | pv.StructuredGrid | None:
    """Return an elevation model of the USGS; None where rasterio is missing, for VTK to read it.

    VTK's reader leaves out a row, says nothing of what is missing, and divides by zero where there
    are few columns.
    """
    if importlib.util.find_spec("rasterio") is not None:
        return read(path)
    number = file_parts.first_bytes(path, _DEM_COLUMNS.stop)[_DEM_COLUMNS].strip()
    if not number.isdigit() or int(number) < _DEM_LEAST:
        got = ascii(number.decode("latin-1"))
        raise ValueError(f"{got} columns in the header, VTK reads {_DEM_LEAST} or more")
    return None
