"""Contents of data: their dimension, and the part that each array can have in a picture."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
import pyvista as pv

from vizlight.maps import MOST_SPAN
from vizlight.mesh import blocks, georeference, meaning, records, stresses
from vizlight.reading import molecules
from vizlight.vtk.arrays import are_colors
from vizlight.vtk.cells import dimensions

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vizlight._types import AnyArray, Array, Foreign, Raw

Role: TypeAlias = Literal["vectors", "heights", "values", "kinds", "colors"]

#: Name of VTK's marks of points and cells that are not drawn.
GHOSTS = "vtkGhostType"
#: Most rows of an array, and most cells, that are looked at.
SAMPLE = 20_000
#: Share of the rows of an array of kinds that is nearly all of them.
NEARLY_ALL = 0.95
#: Least rows of a run of equal labels, in the mean: regions are larger than that, while the edges
#: of a scan pass through all its values.
LEAST_RUN = 3.0
#: Most runs of the numbers of parts, in the number of parts, and least cells of one in the mean.
MOST_RUNS, LEAST_PART = 1.5, 30
#: Extent across a flat surface, across a slab that is taken for one, and across a slab that is seen
#: from above, as a share of the second side.
FLAT, SLAB, LAYER = 1e-6, 0.01, 0.15
#: Words that end the names of what is no datum: numbers of nodes and cells, normals, coordinates,
#: bounds, masks.
_NO_DATUM = {
    "id", "ids", "gid", "gids", "origid", "index", "indices", "rank", "num", "number", "mask",
    "ghost", "ghosts",
    "valid", "normal", "normals", "bnds", "bounds", "begin", "end", "point", "points", "coord",
    "coords", "coordinate", "coordinates", "tcoord", "tcoords", "uv", "uvs", "crs", "lon", "lons",
    "lat", "lats", "longitude", "longitudes", "latitude", "latitudes", "xlong", "xlat",
}  # fmt: skip
#: Words anywhere in the names of numbers of nodes and cells, such as ``NumIdCell``.
_NUMBERS = {"id", "ids", "gid"}
#: Words that names of coordinates of nodes, and of tables of which belongs to which, consist of.
_TABLE_WORDS = {
    "x", "y", "z", "lon", "lat", "node", "nodes", "nod", "cell", "cells", "face", "faces", "edge",
    "edges", "vertex", "vertices", "elem", "center", "centre", "centroid", "mesh", "in", "on",
    "of", "d", "connectivity", "links",
}  # fmt: skip
#: Names of the components of normals.
_NORMALS = {"nx", "ny", "nz"}
#: Least share of the rows of an array that are one more than the row before, where it counts rows
#: of tables joined one below the other, and fewest rows.
COUNTED, FEWEST_COUNTED = 0.9, 10
#: Names of other tables: the tangents of glTF belong to textures, PyVista's splines have their
#: length, and glyphs are arrows along their vectors.
_TABLES = {"TANGENT", "arc_length", "gmsh:bounding_entities", "gmsh:dim_tags", "GlyphVector"}
#: Array by which lines are those that VTK's tracer followed, and others that it makes.
TRACED = "IntegrationTime"
_OF_TRACER = {TRACED, "Vorticity", "Rotation", "AngularVelocity"}
#: Numbers that stand for white in images of 8 and 16 bits.
WHITE = (2**8 - 1, 2**16 - 1)
#: Deviation of greys, as a share of white, below which those of a surface in space are no picture.
SHADES = 0.12
#: Steps of a type of numbers through which a constant varies, and size of the values of both signs,
#: as a share of those of other arrays, at most 1, below which they are taken for rounding.
ROUNDED, NOISE = 8, 1e-11
#: Words in the names of kinds, whose numbers may be many.
_KIND_WORDS = {
    "block", "body", "chain", "class", "classes", "domain", "group", "groups", "label", "labels",
    "geometrical", "layer", "mat", "material", "materials", "part", "parts", "phase", "physical",
    "region", "regions",
    "segment", "zone",
}  # fmt: skip
#: Words in the names of colours.
_COLOR_WORDS = {"rgb", "color", "colors", "colour", "colours"}
#: Names of velocities, in lower case; those of Fluent begin with "SV_".
VELOCITY = re.compile(
    r"(sv_)?(u|v)|vel|(sv_)?u,(sv_)?v(,(sv_)?w)?|uvw?|vectors?"
    "|.*(veloc|vitesse|wi?nd|flow|current).*"
)
#: Words in the names of vectors that are no flow: what moves or loads a solid.
_LOAD_WORDS = {
    "deformation", "depl", "disp", "displ", "displacement", "displacements", "force", "forces",
    "load", "loads", "mode", "modes", "moment", "moments", "reaction", "rotation", "rotations",
    "traction",
    "xdisp", "xdispl", "xdsp",
}  # fmt: skip
#: Most points of a solid whose surface is looked at, and the share of its points on its surface
#: from which that shows what is inside as well.
MOST_ON_SURFACE, OUTSIDE = 300_000, 0.3
#: Share of its volume by which a mesh and its box differ at most where it fills it, and share of
#: the spread of values on the sides of the box below which the others are hidden inside.
SAME, HIDDEN = 0.01, 0.3
#: Points or cells that are looked at for arrays that tell the place, fewest of a mesh for that, and
#: largest difference from such an array as a share of the range of its values.
PLACES, FEWEST_PLACES, ROUNDING = 100, 30, 1e-4
#: Words of a name: runs of letters, of which a capital begins another.
_WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|[0-9]+")
#: What else has heights and depths that are no ground: clouds, waves, layers, snow, trees.
_NO_GROUND = re.compile(
    r"cloud|wave|swell|layer|snow|canop|tree|tropopause|mixing|mixed|optical|melt|penetration|mld|pbl"
    r"|(?<!surface[ _])geopotential(?!.*(surface|orog))|sea[ _]surface|free[ _-]surface|tid(e|al)"
    r"|anomaly|dynamic[ _]topography|flood|water[ _]table|isotherm|thermocline|soil|freezing"
    r"|condensation|irradiance|euphotic|secchi"
)
#: What describes the grid of a model, and changes with none of its steps, and flags of its values.
_OF_GRID = re.compile(
    r"(^|[^a-z])(mask|flags?($|[^a-z])|mapfac\w*|map (scale )?factor|coriolis|(sin|cos)alpha"
    r"|cell[ _]area"
    r"|area[ _]of[ _]grid[ _]cell|angle between|angle of (the )?grid|grid_angle\w*|grid angle)"
)
#: Words for how a vehicle with instruments moves.
_OF_PLATFORM = re.compile(r"(^|[^a-z])(platform_|profile_(index|direction)|distance_over_ground)")
#: Words of names of errors of other arrays, and names of the ends of parts of drill holes.
_OF_ERRORS = {"error", "errors", "err", "stderr", "uncertainty", "residual", "residuals"}
_OF_PARTS = {"from", "to"}
#: Names of numbers of dates.
_OF_DATES = {"year", "month", "day", "hour", "minute", "second"}
#: Names of heights: of terrain, of the sea bed, of a surface of pressure.
_HEIGHTS = re.compile(
    r"(^|[^a-z])(elev\w*|dems?|topo\w*|heights?|altitudes?|orog\w*|bathy\w*|relief|hgt|depths?)"
    r"($|[^a-z])"
)


@dataclass(frozen=True)
class Named:
    """One array, or several that are the components of one vector.

    ``name`` of components has their names, separated by commas; ``role`` is the part that it can
    have in a picture, ``distinct``, ``low`` and ``high`` are of a sample.
    """

    name: str
    role: Role
    of_cells: bool = False
    distinct: int = 0
    low: float = 0.0
    high: float = 0.0

    @property
    def is_load(self) -> bool:
        """Whether its name says that it moves or loads a solid."""
        return not _LOAD_WORDS.isdisjoint(_words(self.name))


@dataclass(frozen=True)
class Contents:
    """Contents of a mesh, from a sample of its points and cells.

    A ``raster`` comes from a file of one, with heights as its only band, or is a terrain by its
    shape, laid flat. Arrays of ``without`` are used for the light, such as normals, and are not
    shown.
    """

    mesh: pv.DataSet
    raster: bool = False
    without: tuple[str, ...] = ()

    @cached_property
    def dimension(self) -> int:
        """Highest dimension of the cells, 0 without cells."""
        return int(self.mesh.max_cell_dimensionality) if self.mesh.n_cells else 0

    @cached_property
    def sides(self) -> Array:
        """Extents along the axes."""
        sizes: Array = np.asarray(self.mesh.bounds_size, dtype=np.float64)
        return sizes

    @cached_property
    def flat_axis(self) -> int | None:
        """Axis across which points, lines, a surface or a slab have no extent, None for others.

        A slab of one layer of cells, as of a flow in two dimensions, may be thicker.
        """
        share = LAYER if self.dimension == 3 else FLAT
        thin = np.flatnonzero(self.sides <= share * np.sort(self.sides)[1])
        if not len(thin):
            return None
        axis = int(thin[-1])
        if self.dimension != 3 or self.sides[axis] <= SLAB * np.sort(self.sides)[1]:
            return axis
        along: Array = np.asarray(self.mesh.points)[:, axis].astype(np.float64)
        low, high = np.nanmin(along), np.nanmax(along)
        between = (along > low + FLAT * (high - low)) & (along < high - FLAT * (high - low))
        return None if between.any() else axis

    @cached_property
    def flow(self) -> Named | None:
        """The best array of vectors, None for those that displace or load a solid.

        Those of a mesh with stresses are such whatever their names are.
        """
        vectors = self.first("vectors")
        return None if vectors is None or vectors.is_load or self.is_strained else vectors

    @cached_property
    def is_strained(self) -> bool:
        """Whether it has stresses."""
        return stresses.are_in(self.mesh)

    @cached_property
    def is_part(self) -> bool:
        """Whether most points of a solid are on its surface: a part that is no box of air."""
        if self.dimension != 3 or self.flow is not None:
            return False
        if isinstance(self.mesh, pv.ImageData | pv.RectilinearGrid):
            return False
        if self.mesh.n_points > MOST_ON_SURFACE:
            return False
        on_surface = len(blocks.outer_surface(self.mesh)[1]) >= OUTSIDE * self.mesh.n_points
        return on_surface and not self._is_hidden_in_box

    @property
    def _is_hidden_in_box(self) -> bool:
        """Whether the mesh fills its box, on whose sides the values of the best array are alike.

        Where cells share no points, or have smaller neighbours, most points are on faces of one.
        """
        mesh, array = self.mesh, next(iter(self.arrays), None)
        box = float(np.prod(mesh.bounds_size))
        if array is None or array.role != "values" or abs(mesh.volume - box) > SAME * box:
            return False
        rows = mesh.cell_data_to_point_data() if array.of_cells else mesh
        values = np.asarray(rows.point_data[array.name], dtype=np.float64)
        ends = np.reshape(mesh.bounds, (3, 2))
        places = np.asarray(mesh.points, dtype=np.float64)[..., np.newaxis]
        on_box = (np.abs(places - ends) < SAME / 100 * mesh.length).any(axis=(1, 2))
        spreads = [np.ptp(np.nanpercentile(part, (1, 99))) for part in (values[on_box], values)]
        return bool(spreads[0] < HIDDEN * spreads[1])

    @cached_property
    def arrays(self) -> tuple[Named, ...]:
        """Arrays that are data, the best for a picture first; see :func:`sorted_arrays`."""
        every = sorted_arrays(self.mesh, raster=self.raster)
        return tuple(array for array in every if array.name not in self.without)

    def words_on_none(self) -> str:
        """Return why arrays of one number a point or a cell are not shown, empty if one is."""
        if self.arrays:
            return ""
        return ", ".join(
            f"{name} has no number" if value is None else f"{name} is {value:g} everywhere"
            for name, value in self.constants.items()
        )

    @cached_property
    def constants(self) -> dict[str, float | None]:
        """Arrays with one value by their names, and None for those without a finite one."""
        single: dict[str, float | None] = {}
        for name, finite in self._numbers:
            if not len(finite):
                single[name] = None
            elif finite.min() == finite.max():
                single[name] = float(finite[0])
        return single

    @property
    def _numbers(self) -> Iterator[tuple[str, Raw]]:
        """Names and finite values of arrays of one number a point or a cell, but for counts."""
        for name, rows in self._every:
            values = np.asarray(rows)
            is_one_number = values.ndim == 1 and values.dtype.kind in "fiu" and len(values)
            if is_one_number and not _are_numbers(_words(name)):
                yield name, values[np.isfinite(values)]

    @property
    def _every(self) -> list[tuple[str, AnyArray]]:
        """All arrays of points and of cells with their names."""
        return [*self.mesh.point_data.items(), *self.mesh.cell_data.items()]

    def words_on_rounding(self) -> str:
        """Return which arrays vary by no more than the rounding of their numbers, empty if none."""
        words = [
            f"{name} is {finite[0]:g} everywhere, but for rounding"
            for name, finite in self._numbers
            if len(finite) and finite.min() < finite.max() and _is_rounded(finite)
        ]
        noise = _noise(self.mesh, [array.name for array in self.arrays]).items()
        words += [f"{name}, up to {size:.1g}, is taken for rounding of 0" for name, size in noise]
        return ", ".join(words)

    def words_on_complex(self) -> str:
        """Return which arrays hold complex numbers, which have no place on a bar; empty if none."""
        names = ", ".join(name for name, rows in self._every if np.iscomplexobj(rows))
        return names and f"{names}: complex numbers are not shown; take numpy.abs or numpy.angle"

    def first(self, *roles: Role) -> Named | None:
        """Return the best array of some roles, None if no array has one."""
        return next((array for array in self.arrays if array.role in roles), None)

    def named(self, name: str) -> Named | None:
        """Return the description of an array by its name, also of one that is no datum."""
        datum = next((array for array in self.arrays if array.name == name), None)
        if datum is not None or not name:
            return datum
        places = ((self.mesh.point_data, False), (self.mesh.cell_data, True))
        for data, of_cells in places:
            if name in data:
                return _described(name, np.asarray(data[name]), of_cells=of_cells, named=False)
        parts = name.split(",")
        every = [*self.mesh.point_data, *self.mesh.cell_data]
        if len(parts) in (2, 3) and all(part in every for part in parts):
            return Named(name, "vectors", parts[0] not in self.mesh.point_data)
        return None


def is_of_kinds(name: str) -> bool:
    """Return whether the name of an array says that its numbers are those of kinds, as of parts."""
    return not _KIND_WORDS.isdisjoint(_words(name))


def says_heights(mesh: pv.DataSet, name: str) -> bool:
    """Return whether an array is one of heights by its name or words, and not as an only band."""
    return _HEIGHTS.search(f"{name.lower()} {_words_of(mesh, name)}") is not None


def may_be_ground(contents: Contents, array: Named) -> bool:
    """Return whether values of a grid, of no unit or one of a length, can be those of a ground."""
    mesh = contents.mesh
    words = f"{array.name.lower()} {_words_of(mesh, array.name)}"
    is_grid = contents.flat_axis == 2 and sum(size > 1 for size in dimensions(mesh)) == 2
    is_length = array.role in ("values", "heights") and _is_length(mesh, array.name)
    return is_grid and is_length and not array.of_cells and not _NO_GROUND.search(words)


def sorted_arrays(mesh: pv.DataSet, *, raster: bool = False) -> tuple[Named, ...]:
    """Return the arrays that are data, the best for a picture first.

    The active array comes first, of kinds if these have colours of their own, then numbers in
    floating point, components of vectors last, those of points before those of cells, those that
    describe the grid of a model, or tell the place, last; then kinds, those of cells first, which
    are materials more often than those of points; each in the order of the mesh. Last are those
    that are 0 but for rounding. Arrays made by filters of light are left out.
    """
    outputs = records.all_made(mesh)
    described, texture = [], mesh.point_data.active_texture_coordinates_name
    for data, of_cells in ((mesh.point_data, False), (mesh.cell_data, True)):
        for name in data:
            # A name stands for the array of points where both have it.
            if name in outputs or (of_cells and name in mesh.point_data):
                continue
            values = np.asarray(data[name])
            if of_cells and GHOSTS in data:
                # Cells that are hidden, such as those that others refine.
                values = values[np.asarray(data[GHOSTS]) == 0]
            # A kind that its file names is a datum, though it be the only one, as are the regions
            # of a map that has no other array.
            regions = mesh.n_arrays == len(mesh.field_data) + 1 and _are_regions(mesh, values)
            named = not meaning.flags(mesh, name) and not regions
            if named and _is_beside(mesh, name, values):
                continue
            array = _described(name, values, of_cells=of_cells, named=named)
            said = _words_of(mesh, name)
            if array is not None:
                array = replace(array, role=_stated_role(mesh, array))
            if array is not None and array.role == "colors" and _is_shade(mesh, values):
                continue
            if meaning.is_planar(values) and (name == texture or mesh.bounds_size[2]):
                # Two components are vectors in a plane alone.
                continue
            if array is not None and array.high in WHITE and meaning.is_photograph(mesh):
                # Few tones are those of a drawing, or of two that were told apart.
                array, raster = replace(array, role="values"), False
            if array is not None and array.role == "values" and _HEIGHTS.search(said):
                array = replace(array, role="heights")
            if array is not None and array.role == "heights" and _NO_GROUND.search(said):
                array = replace(array, role="values")
            if array is not None:
                described.append(array)
    if raster and len(described) == 1 and described[0].role == "values":
        only = described[0]
        described = [Named(only.name, "heights", only.of_cells, only.distinct, only.low, only.high)]
    is_section = bool(meaning.of(mesh).section)
    described = [
        replace(array, role="values")
        if array.role == "heights" and (is_section or not _is_length(mesh, array.name))
        else array
        for array in described
    ]
    joined = [
        Named(",".join(names), "vectors", names[0] not in mesh.point_data)
        # On a vertical section one of them points out of the picture.
        for names in ([] if is_section else meaning.components(mesh))
        if ",".join(names) not in mesh.array_names
        and not all(map(_is_table, names))
        and not _NORMALS.issuperset(map(str.lower, names))
        # Coordinates and numbers of cells along the axes are no vectors.
        and set(names) != _affine(mesh, names)
    ]
    active = _active(mesh)
    parts = {name for vector in joined for name in vector.name.split(",")}
    of_place = _affine(mesh, [array.name for array in described if array.role != "kinds"])

    noise = _noise(mesh, [array.name for array in described])

    def rank(array: Named) -> tuple[bool, ...]:
        # An active array of kinds with names, such as elements, is the best.
        own = array.name in active and bool(meaning.flags(mesh, array.name))
        kinds = array.role == "kinds" and not own
        # Heights of points that are active are shown as data.
        is_height = array.role == "heights" and array.name in active
        static = (array.name in of_place and not is_height) or _is_secondary(mesh, array)
        is_inactive = array.name not in active
        is_noise = noise.keys() >= {*array.name.split(",")}
        of_few = _is_of_few(mesh, array)
        is_part = array.name in parts
        is_slow = array.role == "vectors" and VELOCITY.fullmatch(array.name.lower()) is None
        of_last = is_part, is_slow, array.of_cells != kinds
        return (is_noise, kinds, of_few, static, is_inactive, *of_last)

    return tuple(sorted([*described, *joined], key=rank))


def _active(mesh: pv.DataSet) -> Sequence[str | None]:
    """Return the names of the active arrays, else those of von Mises stress."""
    active = [mesh.active_scalars_name, mesh.active_vectors_name]
    stressed = [name for name in mesh.array_names if stresses.is_von_mises(name)]
    return stressed if active == [None, None] else active


def _is_of_few(mesh: pv.DataSet, array: Named) -> bool:
    """Return whether an array is part of a date, or nearly one value, or few of a cloud have it."""
    if array.role not in ("values", "heights"):
        return array.name.lower() in _OF_DATES
    rows = np.asarray((mesh.cell_data if array.of_cells else mesh.point_data)[array.name])
    is_cloud = mesh.max_cell_dimensionality < 1
    is_missing = is_cloud and rows.dtype.kind == "f" and np.isnan(rows).sum() > len(rows) / 2
    sample = rows[:: max(len(rows) // SAMPLE, 1)]
    _, counts = np.unique(sample, return_counts=True)
    is_even = counts.max() > NEARLY_ALL * len(sample)
    return bool(is_missing or is_even) or array.name.lower() in _OF_DATES


def _is_secondary(mesh: pv.DataSet, array: Named) -> bool:
    """Return whether an array is shown if no other is: of a grid, a platform, a place or an error.

    Directions are such too, since 0 and 360 degrees are one, and heights of stations on a map.
    """
    words = f"{array.name.lower()} {_words_of(mesh, array.name)}"
    is_of_station = array.role == "heights" and mesh.max_cell_dimensionality < 2
    return (
        array.name.startswith("_")
        or array.name.lower() in _OF_PARTS
        or (array.name in _OF_TRACER and TRACED in mesh.point_data)
        or not _OF_ERRORS.isdisjoint(_words(array.name))
        or (meaning.MEANING in mesh.field_data and _OF_GRID.search(words) is not None)
        or meaning.is_direction(mesh, array.name)
        or _OF_PLATFORM.search(words) is not None
        or (is_of_station and georeference.has_degrees(mesh))
    )


def _affine(mesh: pv.DataSet, names: Sequence[str]) -> set[str]:
    """Return which arrays are sums of multiples of the coordinates: they tell the place alone."""
    result: set[str] = set()
    for of_cells, data in enumerate((mesh.point_data, mesh.cell_data)):
        rows = [name for name in names if name in data and np.ndim(data[name]) == 1]
        count = mesh.n_cells if of_cells else mesh.n_points
        if not rows or count <= FEWEST_PLACES:
            continue
        ids = np.linspace(0, count - 1, PLACES).astype(int).tolist()
        # One by one, since an image would compute all of its points.
        places = np.array([mesh.get_cell(i).center if of_cells else mesh.GetPoint(i) for i in ids])
        design = np.column_stack([places - places.mean(axis=0), np.ones(len(ids))])
        for name in rows:
            values = np.asarray(data[name])[ids].astype(np.float64)
            if not np.isfinite(values).all() or not np.ptp(values):
                continue
            left = values - design @ np.linalg.lstsq(design, values)[0]
            if np.abs(left).max() < ROUNDING * np.ptp(values):
                result.add(name)
    return result


def _is_length(mesh: pv.DataSet, name: str) -> bool:
    """Return whether the unit of an array, if its file has one, is that of a length."""
    unit = meaning.of(mesh).arrays.get(name, {}).get("units", "")
    return not unit or meaning.metres(unit) is not None


def _words_of(mesh: pv.DataSet, name: str) -> str:
    """Return the standard name and the long name of an array, as far as its file has them."""
    attributes = meaning.of(mesh).arrays.get(name, {})
    standard = attributes.get("standard_name", "")
    return f"{standard} {'' if standard else attributes.get('long_name', '')}".lower()


def _stated_role(mesh: pv.DataSet, array: Named) -> Role:
    """Return the role of an array by the words of its file: flags are kinds, shares are none."""
    if meaning.flags(mesh, array.name):
        return "kinds" if array.role == "values" else array.role
    units = meaning.of(mesh).arrays.get(array.name, {}).get("units", "")
    is_share = array.role == "kinds" and array.distinct > 1 and units in ("%", "percent")
    return "values" if is_share else array.role


def _described(name: str, values: Raw, *, of_cells: bool, named: bool) -> Named | None:
    """Return the role of an array, None where it is no datum; ``named`` says whether by its name.

    Constants are none, but for those with holes, nor are arrays of text.
    """
    words = _words(name)
    # VTK numbers the groups of an .obj file, most of which are drawing aids.
    of_kinds = name != "GroupIds" and is_of_kinds(name)
    if named and (words[0] == "vtk" or (_are_numbers(words) and not of_kinds)):
        return None
    if named and (_is_table(name) or name in _TABLES):
        return None
    lower = name.lower()
    if are_colors(values):
        # A file whose colours are all alike has none to show.
        plain = named and not np.any(values != values[:1])
        return None if plain else Named(name, "colors", of_cells)
    if named and _are_shares(words, values):
        return None
    if values.dtype.kind not in "fiub" or values.ndim > 2 or not len(values):
        return None
    sample = np.asarray(values[:: max(len(values) // SAMPLE, 1)], dtype=np.float64)
    finite = sample[np.isfinite(sample.reshape(len(sample), -1)).all(axis=1)]
    if not len(finite):
        return None
    if values.ndim == 2 and values.shape[1] > 1:
        is_vector = values.shape[1] in (2, 3) and values.dtype.kind == "f" and np.any(finite)
        return Named(name, "vectors", of_cells) if is_vector else None
    low, high = float(finite.min()), float(finite.max())
    if named and low < high and _is_rounded(finite.astype(values.dtype)):
        return None
    if low == high and named:
        # Where it is missing it shows where there is something.
        return Named(name, "kinds", of_cells, 1, low, high) if len(finite) < len(sample) else None
    distinct = len(np.unique(finite))
    whole = high - low < MOST_SPAN and _are_whole(finite)
    of_kinds |= of_cells and _are_of_parts(values, distinct)
    ground = _HEIGHTS.search(lower) and not _NO_GROUND.search(lower)
    few = distinct <= meaning.MOST_KINDS and not (named and ground)
    if whole and (few or of_kinds or _are_labels(values)):
        role: Role = "kinds"
    else:
        role = "heights" if ground else "values"
    return Named(name, role, of_cells, distinct, low, high)


def _is_rounded(values: Raw) -> bool:
    """Return whether finite values are one number but for the rounding of their type."""
    kind: Foreign = values.dtype
    if kind.kind != "f":
        return False
    low, high = float(values.min()), float(values.max())
    return high - low <= ROUNDED * float(np.finfo(kind).eps) * max(abs(low), abs(high))


def _noise(mesh: pv.DataSet, names: Sequence[str]) -> dict[str, float]:
    """Return the sizes of those of some arrays that are around 0 and tiny beside the others."""
    low, high = dict[str, float](), dict[str, float]()
    for data in (mesh.cell_data, mesh.point_data):
        for name in {*names} & {*data}:
            values = np.asarray(data[name])
            sample = values[:: max(len(values) // SAMPLE, 1)]
            finite = sample[np.isfinite(sample)] if values.dtype.kind == "f" else sample
            if len(finite):
                low[name], high[name] = float(finite.min()), float(finite.max())
    sizes = {name: max(-low[name], high[name]) for name in low}
    usual = max(sizes.values(), default=0.0)
    return {
        name: size
        for name, size in sizes.items()
        if low[name] < 0 < high[name] and size < NOISE * min(usual, 1.0)
    }


def _is_beside(mesh: pv.DataSet, name: str, values: Raw) -> bool:
    """Return whether an array is a component of normals, or counts rows without a name or points.

    Numbers of cells may show an order.
    """
    if name.lower() in _NORMALS:
        return _NORMALS.issubset(map(str.lower, mesh.array_names))
    # Residues of one atom each are numbered too.
    is_cloud = mesh.max_cell_dimensionality < 1 and not molecules.is_polymer(mesh)
    return (is_cloud or _words(name)[0] == "unnamed") and _count_rows(values)


def _count_rows(values: Raw) -> bool:
    """Return whether whole numbers rise by 1 from row to row, but for a few new beginnings."""
    if values.ndim != 1 or values.dtype.kind not in "fiu" or len(values) < FEWEST_COUNTED:
        return False
    steps = np.diff(values.astype(np.float64))
    new = steps != 1
    return bool(values[0] == np.round(values[0]) and new.mean() <= 1 - COUNTED)


def _are_numbers(words: list[str]) -> bool:
    """Return whether the words of a name are those of numbers or places, which are no data."""
    return words[-1] in _NO_DATUM or not _NUMBERS.isdisjoint(words)


def _are_shares(words: list[str], values: Raw) -> bool:
    """Return whether rows are colours in numbers from 0 to 1, which are no vectors."""
    if _COLOR_WORDS.isdisjoint(words) or values.ndim != 2 or values.dtype.kind != "f":
        return False
    rows: Array = np.asarray(values, dtype=np.float64)
    return bool(np.all((rows >= 0) & (rows <= 1)))


def _words(name: str) -> list[str]:
    return [word.lower() for word in _WORDS.findall(name)] or [""]


def _is_table(name: str) -> bool:
    """Return whether a name is that of a table of a mesh, such as ``node_x``, ``cellsOnCell``."""
    words = [word for word in _words(name) if not word.isdigit()]
    return len(words) > 1 and _TABLE_WORDS.issuperset(words)


def _is_shade(mesh: pv.DataSet, colors: AnyArray) -> bool:
    """Return whether colours of a surface in space are much the same grey: light of a program."""
    rgb = colors[:, :3] / (1.0 if colors.dtype.kind == "f" else WHITE[0])
    in_space = (
        isinstance(mesh, pv.PolyData) and mesh.GetNumberOfPolys() > 0 and mesh.bounds_size[2] > 0
    )
    return in_space and bool(np.all(rgb == rgb[:, :1])) and float(rgb[:, 0].std()) < SHADES


def _are_whole(values: AnyArray) -> bool:
    """Return whether finite values are whole numbers, one at least."""
    return len(values) > 0 and bool(np.all(values == np.round(values)))


def _are_labels(values: Raw) -> bool:
    """Return whether whole numbers are labels: neighbours mostly equal, else far apart."""
    # The middle of the image may be ground, 0.
    inner = np.flatnonzero(values)
    middle = int(inner[len(inner) // 2]) if len(inner) else 0
    run = np.asarray(values[max(middle - SAMPLE, 0) : middle + SAMPLE])
    run = run[np.isfinite(run)].astype(np.int64)
    inside = (run[1:] != 0) & (run[:-1] != 0)
    steps = np.abs(np.diff(run))[inside]
    changes = np.flatnonzero(np.diff(run))
    lengths = np.diff(changes)[run[changes[1:]] != 0]
    if len(lengths) and np.mean(lengths) < LEAST_RUN:
        return False
    jumps = steps[steps > 0]
    return len(jumps) > 0 and float(np.median(jumps)) > 1


def _are_of_parts(values: Raw, distinct: int) -> bool:
    """Return whether whole numbers of cells are those of parts that follow one another."""
    runs = 1 + int(np.count_nonzero(np.diff(values))) if values.dtype.kind in "iu" else math.inf
    return runs <= MOST_RUNS * distinct and LEAST_PART * runs <= len(values)


def _are_regions(mesh: pv.DataSet, values: Raw) -> bool:
    """Return whether an array of a flat mesh has whole numbers that are labels."""
    if values.ndim != 1 or values.dtype.kind not in "fiu" or mesh.bounds_size[2]:
        return False
    return _are_whole(values[np.isfinite(values)]) and _are_labels(values)


def kinds_of(mesh: pv.DataSet, name: str, most: int | None = None) -> Sequence[float]:
    """Return the distinct values of an array of kinds, of all its rows.

    From ``most`` kinds on the largest alone are returned, if these fill nearly all.
    """
    values = np.asarray(mesh.point_data[name] if name in mesh.point_data else mesh.cell_data[name])
    is_finite = np.isfinite(values)
    kinds, place = np.unique(values[is_finite], return_inverse=True)
    if most is not None and len(kinds) > most:
        areas = None
        if isinstance(mesh, pv.PolyData) and name not in mesh.point_data:
            areas = mesh.compute_cell_sizes(length=False, volume=False)["Area"][is_finite]
        # Lines have no area.
        sizes = np.bincount(place.reshape(-1), areas if areas is not None and areas.any() else None)
        largest = np.sort(np.argsort(-sizes, kind="stable")[:most])
        if sizes[largest].sum() >= NEARLY_ALL * sizes.sum():
            kinds = kinds[largest]
    every: list[float] = kinds.tolist()
    return every
