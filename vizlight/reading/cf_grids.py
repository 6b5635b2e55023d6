"""Grids of netCDF files and of xarray: which axis is east, north and up, as CF and usage say."""

from __future__ import annotations

import importlib.util
import itertools
import math
import re
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from pathlib import Path
from typing import TypeAlias, TypeVar

import numpy as np
import pyvista as pv

from vizlight._types import Array, Bools, Foreign, Indices, Keywords, Raw
from vizlight.geometry.relief import height_field
from vizlight.mesh import blocks, dates, fills, georeference, globes, meaning, projections, unrolled
from vizlight.mesh.meaning import Meaning
from vizlight.reading import grib_groups, listed, radars, rasters, series, staggered, unstructured

#: File name extensions of netCDF, of GRIB and of Zarr.
NETCDF, GRIB, ZARR = (".nc", ".nc4", ".cdf"), (".grib", ".grib2", ".grb", ".grb2"), (".zarr",)
SUFFIXES = (*NETCDF, *GRIB, *ZARR)

#: Largest deviation from equal steps, as a share of a step, of the axes of an image.
EQUAL = 1e-4
#: Names of the axes for which cf-xarray has criteria: letters of x, y, z and of the time.
_LETTERS = {
    "longitude": "x", "X": "x", "latitude": "y", "Y": "y", "Z": "z", "vertical": "z", "T": "t",
}  # fmt: skip
#: Attributes that say what an axis is, the surest first.
_ATTRIBUTES = (
    "axis", "standard_name", "units", "_CoordinateAxisType", "cartesian_axis", "positive",
)  # fmt: skip
#: Units that say what an axis is, in all spellings.
_UNITS = {
    "x": r"deg(ree)?s?[ _]*e(ast)?",
    "y": r"deg(ree)?s?[ _]*n(orth)?",
    "z": r"k?pa|hpa|mb|mbar|millibars?|bar|dbar|decibars?|(sigma_)?levels?|layers?",
    "t": r".* since .*",
}
#: Units in which times along an axis are read, and their lengths in seconds.
_CLOCK = (("days", 86_400.0), ("hours", 3600.0), ("minutes", 60.0), ("seconds", 1.0))
#: Units of the angles of a scan.
_ANGLES = r"(micro|µ|u)?rad(ian)?s?"
#: Names of longitude and of latitude.
_LONGITUDE = (
    r"(.*[_\W]|geo|[xtuvnrpcg])?(lon|long|longitude)s?(\d*|2d)(vertex|cell|node|edge)?([_\W].*)?"
    r"|glam.*"
)
_LATITUDE = (
    r"(.*[_\W]|geo|[yxtuvnrpcg])?(lat|latitude)s?(\d*|2d)(vertex|cell|node|edge)?([_\W].*)?|gphi.*"
)
#: Names and first words of long names that say what an axis is.
_NAMES = {
    "x": rf"x|x[cthqu]|x[_\d].*|xi(_.*)?|i|n[ix]|{_LONGITUDE}|e|east(ing)?|west_east.*|xaxis"
    r"|col(umn)?s?|across_?track|pixels?",
    "y": rf"y|y[cthqv]|y[_\d].*|eta(_.*)?|j|n[jy]|{_LATITUDE}|n|north(ing)?|south_north.*|yaxis"
    r"|rows?|along_?track|lines?|scan.*",
    "z": r"z|z[_\d].*|k|nz|.*lev.*|depth.*|.*depth|dept[htuvw]|gdep.*|s_(rho|w)|h(ei)?ght.*"
    r"|.*height|alt.*|elevation|pres(sure)?.*|isobaric.*|plev.*|bottom_top.*|sigma.*|hybrid.*"
    r"|lv_.*|vertical.*",
    "t": r"t|.*time.*|(.*_)?(date|day|month|year|hour)s?|t\d+|step|tstep",
}
#: Names of lengths along x and y of the nodes of a mesh.
_NODES = r"(.*_)?[xy](_?(nodes?|vert\w*|coord\w*))?"
_OF_NODES = r".*(node|vert(ex|ices)?|coord)s?_?([xy])"
#: Pressures in hectopascals of other units.
_PRESSURES = {
    "pa": 1e-2, "pascal": 1e-2, "hpa": 1.0, "hectopascal": 1.0, "mb": 1.0, "mbar": 1.0,
    "millibar": 1.0, "kpa": 10.0, "kilopascal": 10.0, "bar": 1e3, "dbar": 100.0, "decibar": 100.0,
}  # fmt: skip
#: Most places along further axes at which data are looked for.
MOST_LOOKED_AT = 1000
#: Standard and other names of what counts downward, though no unit says that it is a pressure.
_DOWN = (
    r"depth.*|dept[htuvw]|gdep.*|.*_depth|atmosphere_(hybrid_)?sigma.*|atmosphere_ln_pressure.*"
    r"|sigma|hybrid|.*pressure.*|pres|plevs?\d*|isobaric.*"
)
#: Names of heights, which are drawn in the unit of the axes, and of depths, which count downward.
_HEIGHTS = (
    r"z|.*altitude.*|.*elevation.*|.*height.*|.*topo.*|.*bathy.*|.*orog.*|dem|.*relief.*|hgt.*|zs"
    r"|.*depth.*"
)
_DEPTHS = r"(sea_floor_depth|depth).*|.*_depth(_below.*)?"
#: Largest step of a map of the ground in degrees, and least difference of its heights in metres:
#: finer maps of one variable without a name are mostly of the ground.
FINE, LEAST_RELIEF = 0.02, 100.0
#: Least difference of heights in metres of a map of z, the name that GMT gives to any datum, where
#: no word of its file is one of heights: gravity and magnetism have smaller numbers.
RELIEF_OF_Z = 1000.0
#: Standard names of levels.
_LEVELS = ("air_pressure", "height", "altitude", "depth")
#: Words of heights in the names and histories of files.
_OF_GROUND = re.compile(r"elev|topo|bathy|terrain|relief|orog|(^|[^a-z])dem([^a-z]|$)")
#: Names of arrays that are no values on a grid: corners of cells and mappings.
_ASIDE = re.compile(r".*(_bnds|_bounds|_vertices)|crs|spatial_ref", re.IGNORECASE)


#: Attribute of cfgrib of values of which every second row of the grid runs back.
_TURNING = "GRIB_alternativeRowScanning"
#: Degrees beyond 360 from which a grid shows a part of the earth twice.
_MORE_THAN_ALL = 10.0
#: Latitude of a pole in degrees, with its rounding.
_MOST_NORTH = 90.5
#: Axes that are no place: of them the first value is taken.
_MEMBERS = (
    r"(ensemble|member|realization|realisation|number|quantile|percentile|band|channel|basin"
    r"|region|transport_reg).*|nf|n?tiles?"
)


#: Axes along which values stand in a list, as those of the nodes of a mesh in a file of its own.
_LISTS = (
    r"(n?mesh\w*_)?n?_?(nod|node|vert|vertex|vertice|cell|elem|element|ele|face|edge|col|point)(e?s)?\d?"
    r"|n(st|sta|stations?|obs|prof|profiles?|cellse?|mesh\w*)|obs|stations?|reports?|profiles?|rgrid"
    r"|traject.*|values"
)

#: Names that programs give to axes without one, and the longest of such axes that can be kinds.
_NAMELESS = r"(ncl|dim_?|phony_dim_|fakeDim)\d+"
_MOST_COLUMNS = 32
#: Dates in texts.
_DATE = r"\d{4}-\d\d-\d\d(T\d\d:\d\d(:\d\d)?)?"
#: Arrays of a mesh for each dimension of a list, and the function that returns their rows.
_RowsOf: TypeAlias = "Mapping[str, tuple[pv.DataSetAttributes, Callable[[Raw], Raw]]]"


@dataclass
class _Axis:
    """One axis of a grid.

    ``ticks`` rise, at the indices ``order`` along the dimension; ``kind`` is that of the unit,
    "degrees", "rotated", "length", "angle" (of a scan, which is no place), "time", "index" or
    empty. ``scale`` has the numbers in the unit in which they are read.
    """

    ticks: Array
    order: Indices
    words: str
    kind: str
    scale: meaning.AxisScale

    @property
    def is_count(self) -> bool:
        """Whether its coordinates are the numbers of its places, from 0 or 1 on."""
        count = self.ticks[0] + np.arange(len(self.ticks))
        return self.ticks[0] in (0, 1) and bool(np.array_equal(self.ticks, count))


def _may_be_ground(name: str, attributes: Mapping[str, str], axes: Sequence[_Axis]) -> bool:
    """Return whether the name of values says nothing: on a fine map in degrees, or z on any."""
    words = {"units", "standard_name"} & attributes.keys()
    text = str(attributes.get("long_name", ""))
    if _is_plain_z(name, attributes):
        return not all(axis.kind == "index" and axis.is_count for axis in axes)
    is_fine = all(
        axis.kind == "degrees" and np.ptp(axis.ticks) < FINE * (len(axis.ticks) - 1)
        for axis in axes
    )
    return (
        is_fine and not words and (not text or "Band Number" in text)  # as GDAL writes it
        and (meaning.is_of_reader(name) or name.lower().startswith("band"))
    )  # fmt: skip


def _are_months(name: str, ticks: Sequence[float]) -> bool:
    """Return whether the steps of an axis without a unit are months of a year by their numbers."""
    return "month" in name.lower() and len(ticks) > 1 and {*ticks} <= {*range(1, 13)}


def _is_plain_z(name: str, attributes: Mapping[str, str]) -> bool:
    """Return whether an array is called z, as by GMT, and nothing else is said of it."""
    words = {"units", "standard_name"} & attributes.keys()
    return name.lower() == "z" and not words and attributes.get("long_name", "z").lower() == "z"


def is_grid(value: object) -> bool:
    """Return whether a value is a Dataset or a DataArray of xarray."""
    return type(value).__module__.startswith("xarray.") and hasattr(value, "coords")


def read(
    path: Path, time: object, at: Mapping[str, object] | None = None, nodata: float | None = None
) -> pv.DataSet:
    """Return the variables of a file of netCDF, GRIB or Zarr on the grid of its largest variable.

    Arguments are as for :func:`of_dataset`.
    """
    import xarray

    # With all coordinates, corners of cells are none of the variables.
    # Times stay numbers, which every calendar of a climate model has.
    with warnings.catch_warnings():
        # Attributes that name corners or areas which are not there mean nothing for the grid.
        warnings.filterwarnings("ignore", "Variable.s. referenced in")
        warnings.filterwarnings("ignore", ".* has non-conforming '_FillValue'")
        # Variables over one axis twice are on no grid.
        warnings.filterwarnings("ignore", "Duplicate dimension names present")
        # A store of Zarr without a summary of its metadata takes longer to open, no more.
        warnings.filterwarnings("ignore", "Failed to open Zarr store with consolidated")
        if path.suffix.lower() in GRIB:
            warnings.filterwarnings("ignore", category=FutureWarning, module="cfgrib")
            group, along, note = grib_groups.opened(path, at or {})
            with group as file:
                notes = grib_groups.missing_messages(file)
                reader = _Reader(file, nodata, str(path), [*notes, note] if note else notes)
                return reader.grid(time, along)
        options: Keywords = {"engine": _engine(path), "decode_times": False}
        try:
            opened = xarray.open_dataset(path, decode_coords="all", **options)
        except UnicodeDecodeError:
            # The library of netCDF takes names in UTF-8 alone, SciPy those of its older files too.
            if options["engine"] == "zarr" or path.read_bytes()[:3] != b"CDF":
                raise
            options["engine"] = "scipy"
            opened = xarray.open_dataset(path, decode_coords="all", **options)
        except ValueError as error:
            if "cannot decode" not in str(error):
                raise
            # A mapping that is written in another way names no coordinates.
            opened = xarray.open_dataset(path, **options)
    with opened as file:
        if "AMBER" in str(file.attrs.get("Conventions", "")):
            raise ValueError(
                "a trajectory of Amber has no bonds: save a state of it as .pdb, by cpptraj or "
                "MDAnalysis"
            )
        return of_dataset(_of_gmt(file), time, at, nodata, source=str(path))


def _of_gmt(file: Foreign) -> Foreign:
    """Return a grid that GMT wrote before its version 4, in one row, as rows and columns."""
    if {*file.sizes} != {"side", "xysize"}:
        return file
    sizes, coords = file["dimension"].values, {}
    # Values are those of nodes, or of the middles of cells.
    insets = file["z"].attrs.get("node_offset", 0) * file["spacing"].values / 2
    for axis, size, inset, way in zip("xy", sizes, insets, (1, -1), strict=True):
        ends = file[f"{axis}_range"]
        first, last = ends.values[::way] + way * inset * np.array([1, -1])
        words = {"units": ends.attrs.get("units", "").partition("[")[2].rstrip("]")}
        coords[axis] = (axis, np.linspace(first, last, size), words)
    rows = (("y", "x"), file["z"].values.reshape(sizes[::-1]), file["z"].attrs)
    return file.assign(z=rows).assign_coords(coords)[["z"]]


def _engine(path: Path) -> Foreign:
    """Return the engine of xarray for a file: NetCDF4 as a class, since a name loads all."""
    from xarray.backends import NetCDF4BackendEntrypoint as NetCDF4

    if path.suffix.lower() in ZARR:
        return "zarr"
    is_there = importlib.util.find_spec("netCDF4") is not None
    return NetCDF4 if is_there and NetCDF4().guess_can_open(str(path)) else None


def of_dataset(
    data: Foreign,
    time: object = None,
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
    *,
    source: str = "the dataset",
) -> pv.DataSet:
    """Return the variables of a dataset of xarray on the grid of its largest variable.

    East, north and up are those of CF's attributes, else of usual names, else of the order of the
    axes, of which the last is x. Of any axis beside these and the time one value is taken. ``at``
    has this value or its index by the name of the axis; a number within the values of the axis is
    the nearest of them, and the first is the default. ``time`` is as for :func:`.series.chosen`,
    ``nodata`` as for :func:`.fills.without_missing`.

    The grid is an image, a rectilinear grid where steps are unequal, a structured one where each
    point has a longitude and a latitude of its own, or an unstructured one where some have none.
    Faces of a mesh, of cells with bounds and of a grid around a pole are a surface; values in a
    list without cells are points.
    """
    if not hasattr(data, "data_vars"):
        data = data.to_dataset(name=data.name or "values")
    if radars.is_radar(data):
        return radars.grid(_with_numbers(data), at or {}, nodata, source)
    return _Reader(data, nodata, source).grid(time, dict(at or {}))


class Steps:
    """Reader of the steps of a netCDF file, one at a time."""

    def __init__(self, path: Path) -> None:
        self._path, self._time = path, 0.0
        #: Times of the steps.
        self.time_values = series.of(read(path, "first"))

    def set_active_time_value(self, time: float) -> None:
        """Set the time of the step that is read."""
        self._time = time

    def read(self) -> pv.DataSet:
        """Return the grid of the step that was asked for."""
        return read(self._path, self._time)


def add(mesh: pv.DataSet, other: Foreign, path: Path) -> None:
    """Add the arrays of a grid of the same points to a mesh, with their meaning.

    The path is that of the other file, for the message of points that differ.
    """
    same = mesh.n_points == other.n_points
    if not same or not np.allclose(mesh.points, other.points, rtol=1e-5, atol=0):
        raise ValueError(f"its overlay '{path}' is a grid of other points")
    said, more = meaning.of(mesh), meaning.of(other)
    for name, rows in other.point_data.items():
        mesh.point_data[name] = np.asarray(rows)
    said.arrays |= more.arrays
    said.notes += more.notes
    meaning.attach(mesh, said)


_PlacesT = TypeVar("_PlacesT", pv.PolyData, pv.RectilinearGrid)


class _Reader:
    """Reader of one dataset, which notes what the grid means."""

    def __init__(
        self, data: Foreign, nodata: float | None, source: str, notes: Sequence[str] = ()
    ) -> None:
        self.nodata, self.source, self.said = nodata, source, Meaning(notes=[*notes])
        #: Index along each axis of which a single value is taken.
        self.single: dict[str, int] = {}
        self.file = unstructured.with_nodes(_with_numbers(data))
        if left := [str(name) for name, one in data.data_vars.items() if one.dtype.kind == "c"]:
            words = f"left out, complex numbers: {', '.join(left)}; take numpy.abs or numpy.angle"
            self.said.notes.append(words)
        self.topology = unstructured.topology(self.file, _node_letter)
        self.listed = listed.listed(self.file, _node_letter)
        self.tables = unstructured.tables(self.file)
        #: Letter of the axis of each dimension, or an empty text, and what says so.
        self.letters = {str(dim): self._letter(str(dim)) for dim in data.sizes}

    def _coordinate(self, dim: str) -> Foreign:
        """Return the coordinates along a dimension, None where there are none."""
        file = self.file
        if dim in file.variables:
            return file[dim] if file[dim].dims == (dim,) else None
        # Coordinates may have another name than their dimension.
        others = [
            file[name]
            for name, values in file.variables.items()
            if values.dims == (dim,)
            and values.dtype.kind in "iuf"
            and _letter_of(str(name), values.attrs)[0]
        ]
        dated = [one for one in others if " since " in str(one.attrs.get("units"))]
        return (dated or others)[0] if dated or len(others) == 1 else None

    def _letter(self, dim: str) -> tuple[str, str]:
        """Return x, y, z or t for a dimension, or an empty text, and what says so."""
        if self.topology is not None and dim in (self.topology.nodes, self.topology.faces):
            return "", ""  # a temperature T of the nodes is no time
        if dim.lower().endswith(("bnds", "bounds")):
            return "", ""  # begin and end of a time are no steps
        along = self._coordinate(dim)
        letter = ("", "") if along is None else _letter_of(str(along.name), along.attrs)
        return letter if letter[0] else _letter_of(dim, {})

    def grid(self, time: object, at: dict[str, object]) -> pv.DataSet:
        """Return the grid; see :func:`of_dataset`."""
        self._join_faces(at)
        ticking, step = self._step(time)
        notes = [*self.said.notes]
        self.single |= self._chosen(at)
        clock, letter = ("", "") if time is not None else self._clock_of_section({*at})
        is_drawn = clock != "" and not self._fields()
        if is_drawn:
            self.letters[clock] = letter, self.letters[clock][1]
            self.said.span = []
            del self.single[clock]
        mesh = self._mesh()
        self._say_single_level(mesh)
        if time is None and not at and _is_empty(mesh) and (clocks := self._last_with_data()):
            self.said.notes = notes
            ticking, step = self._step(time, clocks)
            mesh = self._mesh()
        of_track = self.listed is not None and self.letters[self.listed.dim][0] == "t"
        is_step = (len(ticking) > 1 or self.said.time) and not (of_track or is_drawn)
        if is_step and len(ticking) > 1:
            self._say_undated(mesh)
        return series.marked(mesh, ticking, step) if is_step else mesh

    def _clock_of_section(self, chosen: set[str]) -> tuple[str, str]:
        """Return the axis of time of values that have it and one other, and where it is drawn.

        It is x beside heights or latitudes, and y beside longitudes, as in diagrams of Hovmöller;
        empty where there are none, or where one value is chosen along it.
        """
        if self.topology is not None or self.listed is not None:
            return "", ""
        for variable in self.file.data_vars.values():
            sizes = {str(dim): int(size) for dim, size in variable.sizes.items()}
            dims = [dim for dim, size in sizes.items() if size > 1 and dim not in chosen]
            by_letter = {self.letters[dim][0]: dim for dim in dims}
            if len(dims) == len(by_letter) == 2 and "t" in by_letter and "" not in by_letter:
                return by_letter["t"], "y" if "x" in by_letter else "x"
        return "", ""

    def _join_faces(self, at: Mapping[str, object]) -> None:
        """Put the cells on the faces of a cube in one list, if none of the faces is chosen."""
        named = {dim for dim, letter in self.letters.items() if letter[0]}
        file = listed.joined(self.file, _node_letter, {*named, *at})
        if file is not self.file:
            self.file, self.listed = file, listed.listed(file, _node_letter)
            self.letters = {str(dim): self._letter(str(dim)) for dim in file.sizes}

    def _mesh(self) -> pv.DataSet:
        """Return the grid of the single values along axes."""
        mesh: pv.DataSet
        if self.topology is not None:
            mesh = self._surface(self.topology)
        elif self.listed is not None and self.listed.x_bounds:
            mesh = self._cells(self.listed)
        elif fields := self._fields():
            mesh = self._on_axes(fields)
        elif self.listed is not None:
            mesh = self._points(self.listed)
        else:
            reasons = "; ".join([*self.said.notes, *self._without_places()])
            lacking = "no variable on a grid of two or three axes"
            raise ValueError(f"{lacking} ({reasons})" if reasons else lacking)
        return mesh

    def _without_places(self) -> list[str]:
        """Return words for series of times, or for values in a list whose mesh may be elsewhere."""
        times = {dim for dim, (letter, _) in self.letters.items() if letter == "t"}
        series = [name for name, _ in self._of_lists(times)]
        if series and all(self.file[name].ndim == 1 for name in self.file.data_vars):
            count = f"{len(series)} series of times, such as {series[-1]!r}"
            return [f"it has {count}, without places: draw them with matplotlib"]
        dims = [dim for dim in self.letters if re.fullmatch(_LISTS, dim, re.IGNORECASE)]
        return [
            f"{name!r} are values along {dim!r} without places: if another file has their mesh, "
            "read xarray.merge([mesh, values])"
            for dim in dims
            for name, _ in itertools.islice(self._of_lists({dim}), 1)
        ][:1]

    def _on_axes(self, fields: Mapping[str, Foreign]) -> pv.DataSet:
        """Return the grid of the axes of the largest of some variables, with those that fit."""
        middles = self._middles()

        def rank(values: Foreign) -> tuple[bool, int]:
            # A table may be larger than a field, but its axes are not said to be x and y.
            return {"x", "y"} <= {self.letters[dim][0] for dim in values.dims}, int(values.size)

        # One grid has one set of axes, which those of the largest field are.
        largest = max(fields.values(), key=rank)
        named = self._named([middles.get(dim, dim) for dim in largest.dims])
        # A section has its place along x and its height along y.
        dims = [named[letter] for letter in "xyz" if letter in named]
        places, mapped = self._places(dims, self.file[largest.name].dims)
        axes = [self._axis(dim, places) for dim in dims]
        if mapped and places is not None and (straight := _straight(*places)) is not None:
            # Such coordinates are those of rows and columns, written out.
            for axis, ticks in zip(axes, straight, strict=False):
                _set_ticks(axis, ticks, "degrees")
            places, mapped = None, False
        grid: pv.DataSet
        grid, place = (
            _curvilinear(axes, places)
            if mapped and places is not None
            else (_of_axes(axes), np.ones((2, 2), np.bool_))
        )
        words, averaged = [], []
        for name, field in sorted(fields.items(), key=lambda one: {*one[1].dims} != {*dims}):
            values = field
            if {*values.dims} != {*dims}:
                values = staggered.to_middles(values, dims, middles, self.file.sizes)
                if values is None:
                    continue
                averaged.append(name)
            # By NumPy, since texts among the coordinates of a variable cannot be transposed.
            order = [values.dims.index(dim) for dim in reversed(dims)]
            rows = np.transpose(values.values, order)
            rows, missing = fills.without_missing(name, _within(rows, values.attrs), self.nodata)
            words += [missing] if missing else []
            attributes = self._attributes(name, values.attrs, rows, axes, alone=len(fields) == 1)
            self.said.add_array(name, attributes)
            rows = self._heights(name, rows, attributes, flat=len(dims) == 2)
            for i, axis in enumerate(axes):
                rows = np.take(rows, axis.order, axis=rows.ndim - 1 - i)
            grid.point_data[name] = np.ascontiguousarray(rows).ravel()
        self.said.axes = [
            f"{letter} {axis.words}" for letter, axis in zip("xyz", axes, strict=False)
        ]
        is_map = {"x", "y"} <= named.keys() and "time" not in {axis.kind for axis in axes}
        if len(dims) > 2 or not is_map:
            self.said.scales = [axis.scale for axis in axes]
        if is_map:
            self._set_unit(grid, axes, mapped=mapped)
            kind = axes[0].kind
            # Axes by number are those of a model's plane, if each point has a place of its own.
            text = self._projection(kind) if mapped or kind == "length" else ""
            if text and kind == axes[1].kind:
                grid.field_data[georeference.PROJECTION if mapped else "crs"] = [text]
        if averaged:
            text = ", ".join(sorted(averaged))
            self.said.notes.append(f"averaged from the sides of cells to their middles: {text}")
        if left := sorted({*fields} - {*grid.point_data}):
            self.said.notes.append(f"left out, on other axes: {', '.join(left)}")
        self.said.notes += fills.say(self.source, words)
        if places is not None:
            # Components show by the names and units of the arrays.
            meaning.attach(grid, self.said)
            ordered = [
                np.take(np.take(part, axes[1].order, 0), axes[0].order, 1) for part in places
            ]
            self._turn(grid, _angle(*ordered), mapped=mapped)
        if isinstance(grid, pv.StructuredGrid):
            grid = self._with_places(grid, place)
        return meaning.attach(grid, self.said)

    def _middles(self) -> dict[str, str]:
        """Return the dimension of the middles of cells for those of their sides."""
        coordinates = {dim: self._coordinate(dim) for dim in self.letters}
        ticks = {
            dim: along.values.astype(np.float64)
            if along is not None and along.dtype.kind in "iuf"
            else None
            for dim, along in coordinates.items()
        }
        return staggered.alike(self.file, {d: one[0] for d, one in self.letters.items()}, ticks)

    def _with_places(self, grid: pv.StructuredGrid, place: Bools) -> pv.DataSet:
        """Return a grid without the cells at nodes that have no place, whole around a pole."""
        lacking, wide = _astray(grid, place)
        found: pv.DataSet = grid
        left = 0
        # Rows that bend on their way around the earth would show a part of it twice.
        if wide.any() or grid.bounds_size[0] > 360 + _MORE_THAN_ALL:
            found, left = unrolled.of_grid(grid, place)
        elif lacking.any():
            left = int(lacking.sum())
            kept: Foreign = np.flatnonzero(~lacking)
            found = grid.extract_cells(kept, pass_point_ids=False, pass_cell_ids=False)
        if left:
            self.said.notes.append(f"{left} cells without a place are left out")
        return found

    def _surface(self, of: unstructured.Topology) -> pv.PolyData:
        """Return the faces of a mesh in the plane, with the values of its nodes and faces."""
        scale, unit = self._unit(of.x, of.y)
        degrees = unit == georeference.DEGREE
        faces, whole = unstructured.surface(self.file, of, scale, degrees=degrees)
        mesh = faces.mesh()
        words = f"x {of.x!r} and y {of.y!r} of the nodes in {of.table!r} by {of.by}"
        rows_of: _RowsOf = {
            of.nodes: (mesh.point_data, faces.at_points),
            of.faces: (mesh.cell_data, lambda rows: rows[whole][faces.faces]),
        }
        self._with_values(mesh, rows_of, (unit, words))
        if degrees:
            nodes = [np.ravel(self.file[name].values) * scale for name in (of.x, of.y)]
            unrolled.turn_vectors(mesh, faces, np.column_stack(nodes))
        return mesh

    def _cells(self, of: listed.Listed) -> pv.PolyData:
        """Return the cells of a list by their corners, with their values."""
        scale, unit = self._unit(of.x, of.y)
        x, y = (
            scale * np.asarray(self.file[name].values, np.float64)
            for name in (of.x_bounds, of.y_bounds)
        )
        faces, whole = listed.cells(x, y, degrees=unit == georeference.DEGREE)
        mesh = faces.mesh()
        words = f"x and y of the corners of cells, {of.x_bounds!r} and {of.y_bounds!r}, by bounds"
        rows_of: _RowsOf = {of.dim: (mesh.cell_data, lambda rows: rows[whole][faces.faces])}
        return self._with_values(mesh, rows_of, (unit, words))

    def _points(self, of: listed.Listed) -> pv.PolyData | pv.RectilinearGrid:
        """Return the points of a list with their values, as a grid if they stand on one."""
        # The places of a track are those of its times.
        self.single.pop(of.dim, None)
        scale, unit = self._unit(of.x, of.y)
        x, y = (scale * np.asarray(self.file[name].values, np.float64) for name in (of.x, of.y))
        tracks = listed.tracks(self.file, of.dim)
        if tracks is not None and unit and not tracks.any():
            line = self._section(of, x, y, unit)
            if line is not None:
                return line
        mesh, kept = listed.points(x, y, degrees=unit == georeference.DEGREE)
        tracks = tracks if isinstance(mesh, pv.PolyData) else None
        is_earth = isinstance(mesh, pv.PolyData) and unit == georeference.DEGREE and tracks is None
        around = listed.around_earth(x[kept], y[kept]) if is_earth else None
        words = f"x {of.x!r} and y {of.y!r} of each value"
        if around is not None:
            faces = around.faces()
            mesh = faces.mesh()
            self.said.notes.append("triangles between the points, which cover the earth")
            rows_of: _RowsOf = {
                of.dim: (mesh.point_data, lambda rows: faces.at_points(around.rows(rows[kept])))
            }
        else:
            if isinstance(mesh, pv.PolyData) and tracks is not None:
                mesh = listed.with_tracks(mesh, tracks[kept])
                self.said.notes.append(f"{mesh.n_lines} tracks through the points")
            elif isinstance(mesh, pv.PolyData):
                self.said.notes.append(f"points, since no cells of {of.dim!r} are known")
            rows_of = {of.dim: (mesh.point_data, lambda rows: rows[kept])}
        return self._with_values(mesh, rows_of, (unit, words))

    def _section(self, of: listed.Listed, x: Array, y: Array, unit: str) -> pv.PolyData | None:
        """Return the only track with its values in the section along it, None without heights."""
        named = listed.height_of_track(self.file, of.dim)
        if named is None:
            return None
        name, heights = named
        mesh, kept = listed.section(x, y, heights, degrees=unit == georeference.DEGREE)
        if not mesh.bounds_size[0] > 0 or not mesh.bounds_size[1] > 0:
            return None
        is_below = mesh.center[1] < 0
        up = meaning.AxisScale("depth" if is_below else "height", "m", -1.0 if is_below else 1.0)
        self.said.scales = [meaning.AxisScale("distance along the track", "m"), up]
        words = f"x distance in m along the track {of.x!r} and {of.y!r}, y height in m by {name!r}"
        rows_of: _RowsOf = {of.dim: (mesh.point_data, lambda rows: rows[kept])}
        mesh = self._with_values(mesh, rows_of, ("", words))
        # Its heights are those of the axis.
        mesh.point_data.pop(name, None)
        warm = [other for other in mesh.point_data if meaning.is_temperature(mesh, other)]
        # Instruments are listed in any order, and most tracks are those of temperatures.
        mesh.set_active_scalars(next(iter(warm), None))
        return mesh

    def _unit(self, x: str, y: str) -> tuple[float, str]:
        """Return the factor and the unit of coordinates: metre, degree or an empty text."""
        attributes = self.file[x].attrs
        unit = str(attributes.get("units", ""))
        kind = _in_degrees(x, attributes)
        if kind and not unit and np.nanmax(np.abs(self.file[y].values), initial=0) > _MOST_NORTH:
            kind = ""
            self.said.notes.append(f"{x!r} and {y!r} are too large for degrees")
        if kind and not unit and listed.seem_radians(self.file[x].values, self.file[y].values):
            kind = "radians"
            self.said.notes.append("x and y taken for radians by their ranges")
        if kind:
            return math.degrees(1) if kind == "radians" else 1.0, georeference.DEGREE
        metres = meaning.metres(unit)
        return metres or 1.0, "metre" if metres else ""

    def _with_values(self, mesh: _PlacesT, rows_of: _RowsOf, of_axes: tuple[str, str]) -> _PlacesT:
        """Return a mesh with the values along some dimensions.

        ``rows_of`` has where these are kept, and a function of the rows of the file that returns
        those of the mesh. ``of_axes`` is the unit of its coordinates, and words for them.
        """
        words = []
        for name, variable in self._of_lists({*rows_of}):
            dims: list[str] = [str(dim) for dim in variable.dims]
            (along,) = {*dims} & {*rows_of}
            others = {dim: self._index(dim) for dim in dims if dim != along}
            self._say_of_array(name, variable)
            values = _within(np.asarray(variable.isel(others).values), variable.attrs)
            values, missing = fills.without_missing(name, values, self.nodata)
            words += [missing] if missing else []
            if isinstance(mesh, pv.RectilinearGrid) and variable.attrs.get(_TURNING) == 1:
                values = listed.with_turned_rows(values, mesh.dimensions[0])
            data, of_mesh = rows_of[along]
            data[name] = of_mesh(self._heights(name, values, variable.attrs, flat=True))
        unit, axes = of_axes
        self.said.axes = [axes]
        every = {str(name): one.attrs for name, one in self.file.data_vars.items()}
        on_edges = {
            name for name, attributes in every.items() if attributes.get("location") == "edge"
        }
        if left := sorted(on_edges - self.tables):
            self.said.notes.append(f"left out, on edges: {', '.join(left)}")
        self.said.notes += fills.say(self.source, words)
        if unit:
            mesh.field_data[georeference.UNIT] = [unit]
        return meaning.attach(mesh, self.said)

    def _of_lists(self, along: set[str]) -> Iterator[tuple[str, Foreign]]:
        """Yield the variables with one of some dimensions that are data."""
        aside = {*self.tables}
        if self.topology is not None:
            aside |= {self.topology.x, self.topology.y, self.topology.table}
        for key, variable in self.file.data_vars.items():
            name = str(key)
            one = len({*map(str, variable.dims)} & along) == 1
            numbers = variable.dtype.kind in "biuf" and not _ASIDE.fullmatch(name)
            if one and numbers and name not in aside and not _node_letter(name, variable.attrs):
                yield name, variable

    def _index(self, dim: str) -> int:
        """Return the index along a dimension: a chosen one, that of the ground, or the first."""
        along = self._coordinate(dim)
        if dim in self.single:
            return self.single[dim]
        if self.letters[dim][0] != "z" or along is None or along.dtype.kind not in "iuf":
            self._note_first({dim: 0})
            return 0
        ticks: Array = np.array(along.values, dtype=np.float64)
        heights, _, scale = _up(str(along.name), along.attrs, ticks, "")
        sea = scale.is_of_sea(float(heights.max()))
        index = int(heights.argmax() if sea else heights.argmin())
        if (note := f"{dim} {ticks[index] + 0.0:g}") not in self.said.notes:
            self.said.notes.append(note)
            self._say_level(dim, index)
        return index

    def _say_level(self, dim: str, index: int) -> None:
        """Say at which height, depth or pressure a single layer is, if its axis has a unit."""
        along = self._coordinate(dim)
        if self.letters[dim][0] == "z" and along is not None and along.dtype.kind in "iuf":
            self.said.level = _level(along, index)

    def _say_single_level(self, mesh: pv.DataSet) -> None:
        """Say the level of a file of one layer that names it beside its axes, as CF does."""
        said = meaning.of(mesh)
        singles = self._single_numbers(self.file.coords)
        levels = [one for one in singles if one.attrs.get("standard_name") in _LEVELS]
        if said.level or said.section or len(levels) != 1 or len(said.axes) != 2:
            return
        said.level = self.said.level = _level(levels[0], 0)
        meaning.attach(mesh, said)

    def _say_undated(self, mesh: pv.DataSet) -> None:
        """Say of arrays that they are at no time, beside those that change with it."""
        said = meaning.of(mesh)
        for name in {*mesh.array_names} & {*map(str, self.file.data_vars)}:
            if all(self.letters[str(dim)][0] != "t" for dim in self.file[name].dims):
                said.arrays.setdefault(name, {})["date"] = "none"
        meaning.attach(mesh, said)

    def _say_of_array(self, name: str, variable: Foreign) -> None:
        """Say what the attributes of a variable say, and that it is at no level if it is not."""
        self.said.add_array(name, variable.attrs)
        if not any(self.letters[str(dim)][0] == "z" for dim in variable.dims):
            self.said.arrays.setdefault(name, {})["level"] = "none"

    def _note_first(self, dims: Mapping[str, int]) -> None:
        """Note that the first value along some axes is taken, or the first one with data."""
        for dim, index in dims.items():
            note = f"first {'with data ' * bool(index)}of {dim}"
            if note not in self.said.notes:
                self.said.notes.append(note)

    def _last_with_data(self) -> dict[str, int]:
        """Return the index along each axis of time of the last step with data, none without one."""
        is_clock = {dim: letter == "t" for dim, (letter, _) in self.letters.items()}
        every = [one for one in self.file.data_vars.values() if any(map(is_clock.get, one.dims))]
        largest: Foreign = max(every, key=lambda one: int(one.size), default=None)
        if largest is None:
            return {}
        sizes = {str(dim): int(size) for dim, size in largest.sizes.items()}
        grid = self._named([dim for dim in sizes if not is_clock[dim] and sizes[dim] > 1])
        members = dict.fromkeys({dim for dim in sizes if not is_clock[dim]} - {*grid.values()}, 0)
        clocks = sorted(filter(is_clock.get, sizes), key=sizes.__getitem__, reverse=True)
        # Of a forecast the first of the hours, for the last start that has any.
        orders = [reversed(range(sizes[clocks[0]])), *(range(sizes[dim]) for dim in clocks[1:])]
        for indices in itertools.product(*orders):
            step = dict(zip(clocks, indices, strict=True))
            if np.isfinite(largest.isel(members | step).values).any():
                return step
        return {}

    def _step(
        self, time: object, clocks_of: Mapping[str, int] | None = None
    ) -> tuple[list[float], int]:
        """Return the times of the steps and the index of one; take it along each axis of time.

        ``clocks_of`` has indices along axes of time, in place of those that ``time`` tells.
        """
        clocks = [dim for dim, (letter, _) in self.letters.items() if letter == "t"]
        sizes = self.file.sizes
        # A file may have several clocks: the one with most steps tells them.
        clock = max(clocks, key=lambda dim: int(sizes[dim]), default=None)
        self.single = dict.fromkeys(clocks, 0)
        along = self._moment() if clock is None else self._coordinate(clock)
        ticks = np.arange(sizes.get(clock, 1)) if along is None else np.ravel(along.values)
        ticking = [float(tick) for tick in ticks]
        self.said.time = "" if along is None else str(along.attrs.get("units", ""))
        if clock is not None and _are_months(clock, ticking) and not self.said.time:
            self.said.time = dates.MONTHS
        calendar = "" if along is None else str(along.attrs.get("calendar", ""))
        if calendar not in ("", "standard", "gregorian"):
            self.said.time += f", {calendar} calendar"
        if self.said.time and (start := self._start(self.said.time)):
            self.said.time += f" since {start}"
        step = self._dated(ticking, time)
        if clock is not None:
            self.single |= {clock: step} | dict(clocks_of or {})
            step = self.single[clock]
        # xarray moves the name of bounds from the attributes of a file.
        named = {} if along is None else along.attrs | along.encoding
        bounds = self.file.variables.get(named.get("bounds"))
        if bounds is not None and bounds.size == 2 * len(ticking):
            self.said.span = np.reshape(bounds.values, (-1, 2))[step].astype(float).tolist()
        return ticking, step

    def _moment(self) -> Foreign:
        """Return the only time of a file without an axis of time, None without one."""
        singles = self._single_numbers(self.file.variables)
        moments = [one for one in singles if " since " in str(one.attrs.get("units"))]
        # A forecast has the time of its start too.
        return moments[-1] if moments else None

    @staticmethod
    def _single_numbers(variables: Mapping[str, Foreign]) -> list[Foreign]:
        """Return the variables of one number."""
        return [one for one in variables.values() if one.ndim == 0 and one.dtype.kind in "iuf"]

    def _start(self, unit: str) -> str:
        """Return the date of the start of a forecast whose steps are in a unit without one."""
        singles = self._single_numbers(self.file.variables)
        reference = "forecast_reference_time"
        starts = [one for one in singles if one.attrs.get("standard_name") == reference]
        if dates.seconds(unit) is None or " since " in unit or not starts:
            return ""
        return dates.date(float(starts[0].values), str(starts[0].attrs.get("units", "")))

    def _dated(self, ticking: list[float], time: object) -> int:
        """Return the index of a step, by its time or by its date."""
        if isinstance(time, str) and re.match(r"\d{4}-\d", time):
            written = [dates.date(tick, self.said.time) for tick in ticking]
            steps = [i for i, date in enumerate(written) if date.startswith(time.replace("T", " "))]
            if steps:
                return steps[0]
        return series.chosen(ticking, time)

    def _chosen(self, at: dict[str, object]) -> dict[str, int]:
        """Return the index along each axis of which a value is chosen."""
        result = {}
        for name, value in at.items():
            if name not in self.file.sizes:
                raise ValueError(
                    f"at: no axis {name!r}, but {', '.join(map(str, self.file.sizes))}"
                )
            along = self._coordinate(name)
            count = self.file.sizes[name]
            ticks = list(range(count)) if along is None else along.values.tolist()
            texts = [str(tick) for tick in ticks]
            nearest = _nearest(ticks, value)
            if str(value) in texts:
                result[name] = texts.index(str(value))
            elif nearest is not None:
                result[name] = nearest
            else:
                found = [tick if isinstance(tick, int | float) else np.nan for tick in ticks]
                result[name] = series.chosen(found, value, f"at, along {name}")
            index = result[name]
            asked = f", the value nearest to {value}; its index is {index}"
            self.said.notes.append(f"{name} {texts[index]}" + asked * (nearest is not None))
            self._say_level(name, index)
        return result

    def _fields(self) -> dict[str, Foreign]:
        """Return the variables of two or three axes, with one value of every other."""
        fields: dict[str, Foreign] = {}
        for key, variable in self.file.data_vars.items():
            name, dims = str(key), [str(dim) for dim in variable.dims]
            kind = variable.dtype.kind in "biuf" and variable.ndim >= 2 and variable.size
            if not kind or _ASIDE.fullmatch(name) or self._is_place(name, variable):
                continue
            if name in self.tables:
                continue
            # Axes of one value, such as a single level, are none of the grid.
            there = [dim for dim in dims if dim not in self.single and self.file.sizes[dim] > 1]
            named = self._named(there)
            if len(named) not in (2, 3):
                continue
            if len(named) == 3:
                self._refuse_table(variable.isel(dict.fromkeys({*dims} - {*there}, 0)))
            first = {dim: self.single.get(dim, 0) for dim in dims if dim not in named.values()}
            others = [dim for dim in there if dim in first]
            if others and not np.isfinite(variable.isel(first).values).any():
                first |= _with_data(
                    variable.isel({dim: first[dim] for dim in {*first} - {*others}}), others
                )
            self._note_first({dim: first[dim] for dim in others})
            fields[name] = variable.isel(first)
        return fields

    def _refuse_table(self, variable: Foreign) -> None:
        """Raise ValueError for kinds of values along an axis of three of which nothing is said."""
        names = [str(dim) for dim in variable.dims]
        if not all(re.fullmatch(_NAMELESS, name) and not self.letters[name][0] for name in names):
            return
        short = min(names, key=lambda name: int(variable.sizes[name]))
        rows = variable.transpose(short, ...).values.reshape(variable.sizes[short], -1)
        if rows.dtype.kind != "f" or len(rows) > _MOST_COLUMNS:
            return
        low, high = np.nanpercentile(rows, (10, 90), axis=1)
        # Neighbouring planes of a volume have values in common.
        apart = (low[1:] > high[:-1]) | (high[1:] < low[:-1])
        if apart.mean() > 0.5:
            raise ValueError(
                f"{variable.name!r} is a table of {len(rows)} kinds of values along {short!r} "
                f"without words for its axes, {', '.join(names)}: name what are places, such as by "
                f"data.rename({names[-1]}='x', {names[-2]}='y'), or take one kind by "
                f"vizlight.read(..., at={{{short!r}: 0}})"
            )

    def _named(self, dims: Sequence[str]) -> dict[str, str]:
        """Return the dimension of each of x, y and z; what says nothing of itself by its order."""
        named: dict[str, str] = {}
        for dim in dims:
            letter = self.letters[dim][0]
            if letter in ("x", "y", "z"):
                named.setdefault(letter, dim)
        rest = [
            dim
            for dim in dims
            if not self.letters[dim][0]
            and not re.fullmatch(_MEMBERS, dim, re.IGNORECASE)
            and not re.fullmatch(_LISTS, dim, re.IGNORECASE)
        ]
        # Beside a known x or y an unknown axis is no height.
        letters = "xy" if named.keys() & {"x", "y"} else "xyz"
        free = [letter for letter in letters if letter not in named]
        return named | dict(zip(free, reversed(rest), strict=False))

    def _is_place(self, name: str, variable: Foreign) -> bool:
        """Return whether a variable of two axes is a longitude or a latitude."""
        letter, _ = _letter_of(name, variable.attrs)
        return letter in ("x", "y") and _in_degrees(name, variable.attrs, strict=True) != ""

    def _places(
        self, dims: Sequence[str], of_field: Sequence[object]
    ) -> tuple[tuple[Array, Array] | None, bool]:
        """Return the longitude and the latitude of each node, and whether they are its place.

        Where x and y are lengths of a projection they only tell how its axes are turned. A face
        of several, such as those of a cubed sphere, is an index along another axis of the field.
        """
        if [self.letters[dim][0] for dim in dims[:2]].count("z") or len(dims) < 2:
            return None, False
        kinds = [self._axis(dim, None).kind for dim in dims[:2]]
        found: dict[str, Array] = {}
        for key, variable in self.file.variables.items():
            name, rest = str(key), {*variable.dims} - {*dims[:2]}
            inner = len(rest) == variable.ndim - 2 and rest <= {*of_field, *self.single} - {*dims}
            if not inner or variable.dtype.kind not in "iuf":
                continue
            if self._is_place(name, variable):
                letter, _ = _letter_of(name, variable.attrs)
                index = {dim: self.single.get(str(dim), 0) for dim in rest}
                rows: Array = np.asarray(variable.isel(index).transpose(dims[1], dims[0]).values)
                scale = _in_degrees(name, variable.attrs, strict=True) == "radians"
                # Files may have several, of centres and of corners: the first fits the variable.
                found.setdefault(letter, np.degrees(rows) if scale else rows.astype(np.float64))
        # Degrees along the axes may be names of rows and columns, unless no point has its own.
        in_degrees = kinds == ["degrees", "degrees"]
        lacking = in_degrees and np.isnan([*found.values()]).any()
        if len(found) == 2 and not lacking and _on_earth(found["x"], found["y"]).any():
            return (found["x"], found["y"]), kinds != ["length", "length"]
        if kinds == ["rotated", "rotated"]:
            return self._unrotated(dims), True
        return None, False

    def _unrotated(self, dims: Sequence[str]) -> tuple[Array, Array] | None:
        """Return longitudes and latitudes of a grid about a rotated pole, if its pole is named."""
        plane = projections.of_text(self._projection())
        if plane is None:
            return None
        x, y = (np.asarray(self._coordinate(dim).values, np.float64) for dim in dims[:2])
        rotated = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        earth = plane.inverse(np.radians(rotated) * projections.RADIUS).reshape(len(y), len(x), 2)
        return earth[..., 0], earth[..., 1]

    def _projection(self, kind: str = "rotated") -> str:
        """Return the text of the projection of a grid by the kind of its axes, empty for none."""
        tables = [self.file.attrs, *(one.attrs for one in self.file.variables.values())]
        for attributes in tables:
            is_rotated = "grid_north_pole_latitude" in attributes
            is_named = is_rotated or "MAP_PROJ" in attributes or "grid_mapping_name" in attributes
            if is_named and is_rotated == (kind == "rotated"):
                return projections.of_attributes(attributes)
        return ""

    def _since(self, ticks: Array) -> tuple[Array, str]:
        """Return times since the first one, and the unit in which they are read."""
        unit, first = self.said.time, float(ticks.min())
        size, start = dates.seconds(unit) or 1.0, dates.date(first, unit).removesuffix(" 00:00")
        long = size * float(np.ptp(ticks))
        # Months and years have no length of their own.
        name, length = next(
            (one for one in _CLOCK if long >= 3 * one[1] and size <= _CLOCK[0][1]),
            (unit.partition(" ")[0], size),
        )
        return (ticks - first) * size / length, f"{name} since {start}" if start else name

    def _far(self) -> float:
        """Return the height in metres from which a satellite scans the earth, 0 for none."""
        heights = [
            float(variable.attrs["perspective_point_height"])
            for variable in self.file.variables.values()
            if variable.attrs.get("grid_mapping_name") == "geostationary"
        ]
        return heights[0] if heights else 0.0

    def _system(self, ticks: Array, attributes: Foreign) -> str:
        """Return the unit of x and y by the text of the reference system of a grid, if it counts.

        A system of degrees goes before a unit that the coordinates kept from another one.
        """
        tables = [variable.attrs for variable in self.file.variables.values()]
        texts = [str(table.get("crs_wkt") or table.get("spatial_ref", "")) for table in tables]
        text = next(filter(None, texts), "")
        if text.startswith(("GEOGCS", "GEOGCRS", "GEODCRS")) and np.abs(ticks).max() <= 360:
            return "degrees"
        # Of several units the last is that of the axes.
        units = re.findall(r'UNIT\["([^"]+)"', text) if text.startswith("PROJ") else []
        is_length = units and meaning.metres(units[-1]) is not None
        return units[-1].lower() if is_length and not attributes.get("units") else ""

    def _axis(self, dim: str, places: object) -> _Axis:
        """Return the axis along a dimension."""
        letter, reason = self.letters[dim]
        along = self._coordinate(dim)
        by = f" by {reason}" if reason else " by the order of the axes"
        name, attributes = (dim, {}) if along is None else (str(along.name), along.attrs)
        unit = str(attributes.get("units", "")).strip()
        scale = meaning.AxisScale(_titled(name, attributes), _unit_of_axis(unit))
        if along is None or along.dtype.kind not in "iuf":
            count = np.arange(int(self.file.sizes[dim]))
            words = f"{dim!r}{by}" + ("" if places is not None else ", by index")
            return _Axis(count.astype(np.float64), count, words, "index", scale._replace(unit=""))
        ticks: Array = np.array(along.values, dtype=np.float64)
        if letter in ("x", "y") and (system := self._system(ticks, attributes)):
            attributes, unit = attributes | {"units": system}, system
        unit = unit.lower()
        if not unit and re.fullmatch("(east|north)ings?", name.lower()):
            unit = "m"
        axis = _Axis(ticks, np.arange(len(ticks)), f"{name!r}{by}", "", scale)
        if letter == "z":
            ticks, axis.words, axis.scale = _up(name, attributes, ticks, by)
            _set_ticks(axis, ticks, "")
        elif kind := _in_degrees(name, attributes):
            text = {"x": "longitude", "y": "latitude"}.get(letter, name)
            axis.words = f"{text} in degrees{by}"
            rotated = "grid_" in str(attributes.get("standard_name", "")) or name.startswith(
                ("grid_l", "rl")
            )
            if not rotated:
                axis.scale = meaning.AxisScale(text, "degrees")
            axis.words += " about a rotated pole" if rotated and places is None else ""
            degrees: Array = np.degrees(ticks) if kind == "radians" else ticks
            _set_ticks(axis, degrees, "rotated" if rotated else "degrees", around=letter == "x")
        elif (metres := meaning.metres(unit)) is not None:
            axis.words = f"{name!r} in m{by}" + (f", from {unit}" if metres != 1 else "")
            axis.scale = scale._replace(unit="m")
            _set_ticks(axis, metres * ticks, "length")
        elif " since " in unit:
            ticks, unit = self._since(ticks)
            axis.words, calendar = f"time in {unit}{by}", self.said.time.partition(", ")[2]
            unit += f", {calendar}" if calendar and " since " in unit else ""
            axis.scale = meaning.AxisScale("time", unit)
            _set_ticks(axis, ticks, "time")
        elif letter in ("x", "y") and (scanned := re.fullmatch(_ANGLES, unit)):
            # Such an angle times the height of the satellite is a length in PROJ's plane.
            far = self._far() * (1e-6 if scanned[1] else 1.0)
            axis.words = f"{name!r} in {f'm{by}, from {unit}' if far else f'{unit}{by}'}"
            axis.scale = scale._replace(unit="m") if far else scale
            _set_ticks(axis, (far or 1.0) * ticks, "length" if far else "angle")
        else:
            said = unit or attributes.get("standard_name")
            axis.words += f" in {unit}" if unit else ""
            _set_ticks(axis, ticks, "" if said else "index")
        return axis

    def _attributes(
        self, name: str, said: dict[str, str], rows: Raw, axes: Sequence[_Axis], *, alone: bool
    ) -> dict[str, str]:
        """Return the attributes of an array; of one without any that can be heights, their words.

        Only one that is alone on a fine map is taken for the ground.
        """
        if not alone or not _may_be_ground(name, said, axes):
            return said
        low, high = float(np.nanmin(rows)), float(np.nanmax(rows))
        unit = "m" if high < rasters.HIGHEST else "ft"
        scale = meaning.metres(unit) or 1.0
        texts = [Path(self.source).name, *map(str, self.file.attrs.values())]
        words = _OF_GROUND.findall(" ".join(texts).lower())
        least = RELIEF_OF_Z if _is_plain_z(name, said) and not words else LEAST_RELIEF
        is_relief = -rasters.DEEPEST < scale * low < scale * high - least
        if not is_relief or scale * high > rasters.HIGHEST:
            return said
        self.said.notes.append(f"{name!r} has no name or unit, and is taken for heights in {unit}")
        return said | {"long_name": "elevation", "units": unit}

    def _heights(self, name: str, rows: Raw, attributes: Foreign, *, flat: bool) -> Raw:
        """Return heights in metres and up; other values, and all in a volume, as they are."""
        if not (flat and rows.dtype.kind in "iuf" and _named_so(_HEIGHTS, name, attributes)):
            return rows
        unit = str(attributes.get("units", "")).strip()
        scale = meaning.metres(unit)
        values: Array = rows.astype(rows.dtype if rows.dtype.kind == "f" else np.float64)
        if scale is not None and scale != 1:
            rows = values = (scale * values).astype(values.dtype)
            self.said.notes.append(f"{name!r} in m, from {unit}")
            self.said.arrays.setdefault(name, {})["units"] = "m"
        positive = str(attributes.get("positive", "")).lower()
        standard = str(attributes.get("standard_name", ""))
        words = f"{name} {attributes.get('long_name', '')}".lower()
        is_depth = re.fullmatch(_DEPTHS, standard) or (
            # Most of what a map of the sea floor shows is below the sea.
            "bathymetry" in words and np.nanmean(values) > 0
        )
        if positive == "down" or (not positive and is_depth):
            rows = -values
            self.said.notes.append(f"{name!r} counts down, its sign is changed")
        return rows

    def _set_unit(self, grid: pv.DataSet, axes: list[_Axis], *, mapped: bool) -> None:
        """Keep the unit of x and y with the grid."""
        kinds = {axis.kind for axis in axes[:2]}
        if mapped or kinds in ({"degrees"}, {"rotated"}):
            unit = georeference.DEGREE
        elif kinds == {"length"}:
            unit = "metre"
        elif "angle" in kinds:
            self.said.notes.append("angles of a scan without a known projection, no degrees")
            return
        elif (
            "length" not in kinds
            and len(axes) == 2
            and georeference.seem_degrees(grid, next(iter(grid.point_data)))
        ):
            unit = georeference.DEGREE
            self.said.notes.append("x and y taken for degrees by their ranges")
        elif kinds == {"index"} and self.said.arrays.get("z", {}).get("units") == "m":
            unit = "metre"
            self.said.notes.append("x and y taken for metres, as heights are")
        else:
            return
        grid.field_data[georeference.UNIT] = [unit]

    def _turn(self, grid: pv.DataSet, angle: Array, *, mapped: bool) -> None:
        """Attach vectors that point where the grid is drawn, of components along other axes.

        ``angle`` is that from east to the first axis of the grid, in radians.
        """
        volume = grid.n_points // angle.size
        turn = np.tile(np.ravel(angle), volume)
        for group in meaning.components(grid):
            along = meaning.along_grid(self.said.arrays.get(group[0], {}))
            # So are all of WRF, of which only some say it.
            along = True if along is None and "MAP_PROJ" in self.file.attrs else along
            # cfgrib names all winds eastward and northward; the file tells whether they are.
            along = self.file[group[0]].attrs.get("GRIB_uvRelativeToGrid", along)
            # On a map in degrees vectors point east and north, else along the axes.
            if along is None or bool(along) != mapped or group[0] not in grid.point_data:
                continue
            sign = 1.0 if mapped else -1.0
            cos, sin = np.cos(turn), sign * np.sin(turn)
            rows = meaning.vectors(grid, group).astype(np.float64)
            u, v = rows[:, 0].copy(), rows[:, 1].copy()
            rows[:, 0], rows[:, 1] = cos * u - sin * v, sin * u + cos * v
            name = ",".join(group)
            grid.point_data[name] = rows.astype(np.float32)
            most = np.degrees(np.nanmax(np.abs((angle + np.pi) % (2 * np.pi) - np.pi)))
            self.said.notes.append(
                f"{name!r} turned by up to {most:.0f} degrees to where the grid is drawn"
            )


def _nearest(ticks: Sequence[object], value: object) -> int | None:
    """Return the index of the value along an axis that is nearest to a number, if that is one.

    None where it is no whole number that may be an index, or none within the axis.
    """
    numbers: Array = np.array([one if isinstance(one, float) else np.nan for one in ticks])
    is_whole = re.fullmatch(r"[-+]?\d+", str(value)) is not None
    if not is_whole or not np.isfinite(numbers).all() or not 0 <= float(str(value)) < len(numbers):
        return None
    away = np.abs(numbers - float(str(value)))
    # Half a step beyond its ends is within an axis.
    half = np.abs(np.diff(numbers)).max(initial=0.0) / 2
    low, high = numbers.min() - half, numbers.max() + half
    return int(away.argmin()) if low <= float(str(value)) <= high and away.min() > 0 else None


def _is_empty(mesh: pv.DataSet) -> bool:
    """Return whether no array of a mesh has a finite number."""
    arrays = [*mesh.point_data.values(), *mesh.cell_data.values()]
    return not any(np.isfinite(rows).any() for rows in arrays)


def _letter_of(name: str, attributes: Mapping[str, Foreign]) -> tuple[str, str]:
    """Return x, y, z or t for coordinates, or an empty text, and what says so."""
    from cf_xarray.criteria import coordinate_criteria

    texts = {key: str(value).strip() for key, value in attributes.items()}
    for attribute in _ATTRIBUTES:
        text = texts.get(attribute, "").lower()
        if not text:
            continue
        for key, letter in _LETTERS.items():
            allowed = coordinate_criteria[key].get(attribute, ())
            if text in [value.lower() for value in allowed]:
                return letter, attribute
        if attribute == "units":
            for letter, pattern in _UNITS.items():
                if re.fullmatch(pattern, text):
                    return letter, attribute
    words = texts.get("long_name", "").lower()
    sources = [("name", name.lower()), ("long_name", words), ("long_name", words.split(" ")[0])]
    for source, text in sources:
        for letter, pattern in _NAMES.items():
            if text and re.fullmatch(pattern, text):
                return letter, source
    return "", ""


def _node_letter(name: str, attributes: Mapping[str, Foreign]) -> str:
    """Return x or y for coordinates of the nodes of a mesh, else an empty text."""
    letter, _ = _letter_of(name, attributes)
    plain = re.fullmatch(_NODES, name.lower()) or attributes.get("axis")
    if not letter and (of_nodes := re.fullmatch(_OF_NODES, name.lower())):
        return of_nodes[3]
    earth = _in_degrees(name, attributes, strict=True)
    return letter if letter in ("x", "y") and (plain or earth) else ""


def _in_degrees(name: str, attributes: Mapping[str, Foreign], *, strict: bool = False) -> str:
    """Return "degrees" or "radians" for coordinates that are angles, else an empty text.

    Strict: those that are not only in degrees, but said to be a longitude or a latitude.
    """
    unit = str(attributes.get("units", "")).strip().lower()
    earth = _named_so(f"{_LONGITUDE}|{_LATITUDE}", name, attributes)
    earth |= re.fullmatch(f"{_UNITS['x']}|{_UNITS['y']}", unit) is not None
    if re.fullmatch(r"deg.*|°.*|o", unit):
        return "degrees" if earth or not strict else ""
    if re.fullmatch(r"rad(ian)?s?", unit):
        return "radians" if earth else ""
    return "degrees" if earth and unit in ("", "1") else ""


def _with_data(variable: Foreign, dims: Sequence[str]) -> dict[str, int]:
    """Return the first place along some axes of a variable where it has data, or the very first."""
    every = itertools.product(*(range(variable.sizes[dim]) for dim in dims))
    for indices in itertools.islice(every, MOST_LOOKED_AT):
        place = dict(zip(dims, indices, strict=True))
        if np.isfinite(variable.isel(place).values).any():
            return place
    return {}


def _named_so(pattern: str, name: str, attributes: Mapping[str, Foreign]) -> bool:
    """Return whether a name, a standard name or a long name follows a pattern."""
    texts = (name, attributes.get("standard_name", ""), attributes.get("long_name", ""))
    return any(re.fullmatch(pattern, str(text).lower()) for text in texts)


def _titled(name: str, attributes: Mapping[str, Foreign]) -> str:
    """Return what the numbers along an axis are, in words."""
    return str(attributes.get("long_name", "")).strip() or name


def _unit_of_axis(unit: str) -> str:
    """Return the unit of the numbers along an axis as it is printed."""
    return "" if unit == "1" else meaning.written(unit)


def _level(along: Foreign, index: int) -> str:
    """Return the height, depth or pressure at an index of an axis with its unit."""
    ticks: Array = np.array(along.values, dtype=np.float64, ndmin=1)
    heights, _, scale = _up(str(along.name), along.attrs, ticks, "")
    return scale.at(float(heights[index]))


def _up(
    name: str, attributes: Mapping[str, Foreign], ticks: Array, by: str
) -> tuple[Array, str, meaning.AxisScale]:
    """Return heights that rise, of pressures, depths or heights, their words and their scale."""
    unit = str(attributes.get("units", "")).strip()
    pressure, length = _PRESSURES.get(unit.lower().removesuffix("s")), meaning.metres(unit)
    positive = str(attributes.get("positive", "")).lower()
    if pressure is not None:
        # In the sea a pressure is a depth in decibars.
        in_sea = unit.lower().startswith("d")
        scale = meaning.AxisScale("pressure", *((unit, -pressure) if in_sea else ("hPa", -1.0)))
        return -pressure * ticks, f"height, pressure in hPa that falls upward{by}", scale
    text, title, unit = f"height {name!r}", _titled(name, attributes), _unit_of_axis(unit)
    # Depths below 0 rise already.
    down = _named_so(_DOWN, name, attributes) and bool(np.nanmean(ticks) > 0)
    down = positive == "down" or (not positive and down)
    if length is not None:
        ticks, text, unit = length * ticks, f"{text} in m", "m"
        title = "depth" if down else "height" if np.nanmin(ticks) >= 0 else name
    scale = meaning.AxisScale(title, unit, -1.0 if down else 1.0)
    return (-ticks, f"{text} that counts down{by}", scale) if down else (ticks, text + by, scale)


def _set_ticks(axis: _Axis, ticks: Array, kind: str, *, around: bool = False) -> None:
    """Set the coordinates of an axis so that they rise, its order of values, and its kind."""
    axis.kind, written = kind, ticks
    if around and np.all(np.isfinite(ticks)):
        # Across the meridian at which counting begins anew longitudes go on.
        ticks = np.unwrap(ticks, period=360.0)
        middle = (ticks.min() + ticks.max()) / 2
        ticks = ticks - 360.0 * np.ceil((middle - 180.0) / 360.0)
    order = np.argsort(ticks, kind="stable")
    if around and len(ticks) > 2:
        order = _once_around(ticks, order, written)
    ticks = ticks[order]
    if not np.all(np.diff(ticks) > 0):
        raise ValueError(f"the axis of {axis.words} has coordinates twice, or none")
    if around and len(ticks) > 2:
        step = (ticks[-1] - ticks[0]) / (len(ticks) - 1)
        if _even(ticks, step) and abs(step * len(ticks) - 360.0) < EQUAL * 360:
            # Around the earth the last cell ends where the first begins.
            ticks, order = np.append(ticks, ticks[0] + 360.0), np.append(order, order[0])
            axis.words += ", closed around the earth"
    axis.ticks, axis.order = ticks, order


def _once_around(ticks: Array, order: Indices, written: Array) -> Indices:
    """Return the order of longitudes without those that begin a second turn, or stand twice.

    ``written`` are the longitudes of the file, of which -180 and 180 are one.
    """
    rising = ticks[order]
    step = EQUAL * (rising[-1] - rising[0]) / (len(rising) - 1)
    again = np.append(False, (np.diff(rising) < step) & (np.diff(written[order]) != 0))
    kept: Indices = order[~again & (rising <= rising[0] + 360.0 + step)]
    return kept


def _straight(lon: Array, lat: Array) -> tuple[Array, Array] | None:
    """Return the longitudes of columns and the latitudes of rows, if they are those."""
    if not (np.isfinite(lon).all() and np.isfinite(lat).all()):
        return None
    bend = max(np.abs(lon - lon[:1]).max(), np.abs(lat - lat[:, :1]).max())
    # Rounded to float32 a longitude of 180 is off by 1.5e-5.
    step = min(float(np.ptp(lon[0])) / lon.shape[1], float(np.ptp(lat[:, 0])) / lat.shape[0])
    return (lon[0], lat[:, 0]) if bend < 1e-2 * step else None


def _angle(lon: Array, lat: Array) -> Array:
    """Return the angle in radians from east to the rows of a grid, shape (ny, nx)."""
    # Steps on the sphere have a direction near the poles too.
    axes = globes.directions(np.column_stack([lon.ravel(), lat.ravel()])).reshape(*lon.shape, 3, 3)
    steps = np.diff(axes[..., 2, :], axis=1)
    steps = np.pad(steps, ((0, 0), (1, 1), (0, 0)), mode="reflect", reflect_type="odd")
    along = np.nan_to_num(steps[:, 1:]) + np.nan_to_num(steps[:, :-1])
    east, north = np.einsum("...ij,...j->i...", axes[..., :2, :], along)
    return np.asarray(np.arctan2(north, east))


def _within(rows: Raw, attributes: Mapping[str, Foreign]) -> Raw:
    """Return values with NaN outside of the range that a variable states for those that count."""
    low, high = np.ravel(attributes.get("valid_range", (-np.inf, np.inf))).astype(float)[:2]
    low = max(low, float(np.ravel(attributes.get("valid_min", -np.inf))[0]))
    high = min(high, float(np.ravel(attributes.get("valid_max", np.inf))[0]))
    # xarray has unpacked integers of two bytes, whose range is that of the packed ones.
    if rows.dtype.kind != "f" or "scale_factor" in attributes or low >= high:
        return rows
    outside = (rows < low) | (rows > high)
    return np.where(outside, rows.dtype.type(np.nan), rows) if outside.any() else rows


def _with_numbers(data: Foreign) -> Foreign:
    """Return a dataset with times in numbers, as they are in files, of types that VTK has.

    Places that say that they are fake, for programs that know no others, are left out.
    """
    import xarray

    fake = [
        name
        for name, one in data.coords.items()
        if one.dims == (name,) and str(one.attrs.get("long_name", "")).lower().startswith("fake")
    ]
    data, numbers = data.drop_vars(fake), {}
    for name, variable in data.variables.items():
        one = _with_dates(variable)
        if one.dtype.kind in "mM" or (one.dtype.kind == "O" and one.dims == (name,)):
            # Attributes that say the unit of a date would be overwritten, which xarray refuses.
            kept = {key: one.attrs[key] for key in one.attrs if key not in ("units", "calendar")}
            numbers[name] = xarray.conventions.encode_cf_variable(
                xarray.Variable(one.dims, one.data, kept, one.encoding), name=name
            )
        elif one.dtype in (np.float16, np.longdouble) and one.dtype != np.float64:
            numbers[name] = one.astype(np.float32 if one.dtype == np.float16 else np.float64)
        elif one.dtype.kind == "O" and all(isinstance(value, Real) for value in one.values.flat):
            numbers[name] = one.astype(np.float64)
    places = {name: one for name, one in numbers.items() if name in data.coords}
    values = {name: one for name, one in numbers.items() if name not in places}
    return data.assign_coords(places).assign(values) if numbers else data


def _with_dates(variable: Foreign) -> Foreign:
    """Return a variable of texts that are all dates, as those of WRF, with dates for them."""
    if variable.dtype.kind not in "SU" or variable.ndim > 1:
        return variable
    texts = np.char.replace(np.asarray(variable.values, "U"), "_", "T")
    if not texts.size or not all(re.fullmatch(_DATE, text) for text in texts.flat):
        return variable
    try:
        return variable.copy(data=texts.astype("datetime64[ns]"))
    except ValueError:  # such as month 0, of what has no time
        return variable


def _curvilinear(axes: list[_Axis], places: tuple[Array, Array]) -> tuple[pv.StructuredGrid, Bools]:
    """Return a grid with a place for each node, and a mask of the nodes that have one."""
    lon, lat = places
    missing = ~_on_earth(lon, lat)
    # So do those of models where they compute nothing, far from where their neighbours are.
    empty = (lon == 0) & (lat == 0)
    if 1 < empty.sum() < empty.size:
        missing |= empty & ~_between(np.where(empty, np.nan, lon), np.where(empty, np.nan, lat))
    # Files fill the places that they have not with one number, such as -999.
    lon, lat = (height_field.filled(np.where(missing, np.nan, part)) for part in (lon, lat))
    for along in (1, 0):
        lon = np.unwrap(lon, period=360.0, axis=along)
    lon = lon - 360.0 * np.ceil(((lon.min() + lon.max()) / 2 - 180.0) / 360.0)
    heights = axes[2].ticks if len(axes) > 2 else np.zeros(1)
    # The order of rows and columns of the file is kept: they follow no axis.
    for axis, count in zip(axes, reversed(lon.shape), strict=False):
        axis.order = np.arange(count)
    points = np.stack(np.broadcast_arrays(lon, lat, heights[:, np.newaxis, np.newaxis]), axis=-1)
    return blocks.structured(points.reshape(-1, 3), points.shape[2::-1]), ~missing


def _on_earth(lon: Array, lat: Array) -> Bools:
    """Return whether numbers are a longitude and a latitude, not what fills their place."""
    return np.isfinite(lon) & np.isfinite(lat) & (np.abs(lat) <= 90) & (np.abs(lon) <= 720)


def _between(lon: Array, lat: Array) -> Bools:
    """Return the nodes at which neighbours around a hole leave room for (0, 0)."""
    near: Bools = np.ones(lon.shape, dtype=np.bool_)
    for part in ((lon + 180.0) % 360.0 - 180.0, lat):
        filled = height_field.filled(part)
        steps = [np.abs(np.diff(filled, axis=axis)) for axis in (0, 1)]
        near &= np.abs(filled) <= 2 * max(float(np.nanmedian(step)) for step in steps)
    return near


def _astray(grid: pv.StructuredGrid, place: Bools) -> tuple[Bools, Bools]:
    """Return the cells at a node without a place, and those with sides around half of the earth."""
    lon = np.asarray(grid.points)[: place.size, 0].reshape(place.shape)
    parts = [(slice(i, i - 1 or None), slice(j, j - 1 or None)) for i in (0, 1) for j in (0, 1)]
    lacking = np.any([~place[part] for part in parts], axis=0)
    wide = ~lacking & (np.ptp([lon[part] for part in parts], axis=0) > 180)
    return np.tile(np.ravel(lacking), max(grid.dimensions[2] - 1, 1)), wide


def _of_axes(axes: list[_Axis]) -> pv.ImageData | pv.RectilinearGrid:
    """Return a grid on axes x, y and perhaps z; an image where their steps are equal."""
    ticks = [axis.ticks for axis in axes] + [np.zeros(1)] * (3 - len(axes))
    # An axis of one value has no step: any but 0 will do.
    steps = [(axis[-1] - axis[0]) / max(len(axis) - 1, 1) or 1.0 for axis in ticks]
    if all(_even(axis, step) for axis, step in zip(ticks, steps, strict=True)):
        counts = tuple(len(axis) for axis in ticks)
        return pv.ImageData(dimensions=counts, spacing=steps, origin=[axis[0] for axis in ticks])
    return pv.RectilinearGrid(*ticks)


def _even(axis: Array, step: float) -> bool:
    return bool(np.all(np.abs(np.diff(axis) - step) <= EQUAL * step))
