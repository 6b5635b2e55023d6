"""The meaning of arrays and axes of a grid, and assumptions on its file, kept with the mesh."""

from __future__ import annotations

import itertools
import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import NamedTuple, TypeAlias

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Foreign, Raw
from vizlight.mesh import dates, records
from vizlight.mesh.blocks import DataSetT, MeshT
from vizlight.vtk.arrays import stacked

#: Most distinct values of an array of kinds, such as materials or labels.
MOST_KINDS = 12
#: Name of vectors, names of components, or the two names of a cross field.
Named: TypeAlias = str | tuple[str, str]
#: Field array with the meaning of a mesh, as JSON.
MEANING = "meaning"
#: Axes of brains, and the two ways along each.
ANATOMY = {
    "x to the right": "left, right", "y forward": "back, front", "z up": "down, up",
}  # fmt: skip
#: Axes of an image that has no place on the earth, and of one of depths.
PAGE = ["x to the right", "y up the page"]
CAMERA = ["x to the right", "y away from the camera", "z up"]
#: Attributes of an array of a file that are kept.
KEPT = ("standard_name", "units", "long_name", "cell_methods")


class AxisScale(NamedTuple):
    """Numbers along an axis, and the coordinates at which they stand.

    ``title`` says what they are; degrees of a "longitude" and of a "latitude" have words of their
    own. ``factor`` is the coordinate of 1, below 0 where the numbers fall; with ``is_log``
    coordinates are in proportion to their logarithm, of base 10.
    """

    title: str
    unit: str = ""
    factor: float = 1.0
    is_log: bool = False

    def at(self, coordinate: float) -> str:
        """Return the number at a coordinate with its unit, an empty text without a unit."""
        number = coordinate / self.factor
        # Of a height below a surface its depth is said.
        number = abs(number) if self.unit == "m" else number
        digits = f"{number:.4g}" if abs(number) < 1e4 else f"{number:.0f}"
        return f"{digits} {self.unit}" if self.unit else ""

    def is_of_sea(self, top: float) -> bool:
        """Return whether these are heights in a sea, of which the highest is at its surface.

        ``top`` is the largest coordinate.
        """
        # Levels of a model of the air count down from its top, and are no lengths.
        is_depth = self.unit == "m" or "depth" in self.title.lower() or self.title == "pressure"
        return top <= 0 and self.unit != "hPa" and (is_depth or self.factor > 0)


@dataclass
class Meaning:
    """What a file says of its grid.

    ``axes`` are words for x, y and z, such as "x longitude in degrees by standard_name"; ``arrays``
    has the standard name, unit, long name and flags of each array, as far as the file has them, and
    ``notes`` what is missing, and was assumed or left out. ``time`` is the unit of the times of its
    steps, such as "hours since 1900-01-01", with their calendar if it is not the usual one;
    ``span`` the begin and end of the time that the step stands for; ``level`` the height, depth or
    pressure of a single layer, such as "500 hPa". ``scales`` are of x, y and z of a volume, or of x
    and y of a section.
    """

    axes: list[str] = field(default_factory=list)
    arrays: dict[str, dict[str, str]] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    time: str = ""
    span: list[float] = field(default_factory=list)
    level: str = ""
    scales: list[AxisScale] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.scales = [AxisScale(*scale) for scale in self.scales]

    @property
    def section(self) -> list[AxisScale]:
        """Scales of x and y of a vertical section, none of other grids."""
        return self.scales if len(self.scales) == 2 else []

    def add_array(self, name: str, attributes: Foreign) -> None:
        """Keep what the attributes of an array say."""
        # Models of the weather say in a description what others say in a long name.
        attributes = {"long_name": attributes.get("description")} | dict(attributes)
        kept = {key: str(attributes[key]) for key in KEPT if attributes.get(key)}
        # Flags with masks are bits, of which several may be set.
        numbers = np.ravel(attributes.get("flag_values", ()))
        names = str(attributes.get("flag_meanings", "")).split()
        if 0 < len(numbers) == len(names) and "flag_masks" not in attributes:
            kept["flags"] = " ".join(map("{}:{}".format, numbers, names))
        if kept:
            self.arrays[name] = kept

    def add_kinds(self, name: str, kinds: Sequence[tuple[int, str, Sequence[float]]]) -> None:
        """Keep the number, the name, and the red, green and blue from 0 to 1, if any, of kinds."""
        pairs = [(number, re.sub(r"\s+", "_", text)) for number, text, _ in kinds if text]
        hues = [
            (number, "".join(f"{round(255 * part):02x}" for part in color[:3]))
            for number, _, color in kinds
            if len(color)
        ]
        of_array = self.arrays.setdefault(name, {})
        of_array["flags"] = " ".join(itertools.starmap("{}:{}".format, pairs))
        if hues:
            of_array["colors"] = " ".join(itertools.starmap("{}:#{}".format, hues))


#: Names that readers and programs give to an array without one, in lower case.
_OF_READERS = re.compile(
    r"\w*image([ _]?(file|scalars|data))?|(\w+ )?scalars_?|minc|mgh|afni|nifti|values|data"
    r"|__xarray_dataarray_variable__"
)


def is_of_reader(name: str) -> bool:
    """Return whether the name of an array is a word of a reader, such as ``ImageScalars``."""
    return _OF_READERS.fullmatch(name.lower()) is not None


def name_by_file(mesh: pv.DataSet, path: Path) -> None:
    """Keep the name of a file as the title of the only array that has a name of its reader."""
    names = [name for data in (mesh.point_data, mesh.cell_data) for name in data]
    names = [name for name in names if is_of_reader(name)]
    said = of(mesh)
    attributes = said.arrays.setdefault(names[0], {}) if len(names) == 1 else {"long_name": ""}
    if "long_name" not in attributes and "standard_name" not in attributes:
        attributes["long_name"] = path.name.partition(".")[0]
        attach(mesh, said)


def flags(mesh: pv.DataSet, name: str, key: str = "flags") -> dict[float, str]:
    """Return the names of the kinds of an array by their numbers, none where its file has none.

    ``key`` "colors" gives colours such as "#ff0000".
    """
    words = [word.partition(":") for word in of(mesh).arrays.get(name, {}).get(key, "").split()]
    return {float(number): text.replace("_", " ") for number, _, text in words}


def attach(mesh: MeshT, meaning: Meaning) -> MeshT:
    """Keep the meaning of a grid with its mesh, and return the mesh.

    It is the field array ``meaning``.
    """
    mesh.field_data[MEANING] = [json.dumps(asdict(meaning))]
    return mesh


def of(mesh: pv.DataSet) -> Meaning:
    """Return the meaning of a mesh; an empty one where no reader of grids has made it."""
    if MEANING not in mesh.field_data:
        return Meaning()
    try:
        table: Foreign = json.loads(str(mesh.field_data[MEANING][0]))
        return Meaning(**table)
    # An array of this name may be another program's.
    except (TypeError, ValueError):
        return Meaning()


def ways(mesh: pv.DataSet) -> tuple[str, ...]:
    """Return words for the two ways along each axis: x, y and z where the mesh says no more."""
    starts = [axis.partition(",")[0] for axis in of(mesh).axes]
    return tuple(ANATOMY.values()) if starts == list(ANATOMY) else ("x", "y", "z")


def is_photograph(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is an image that has no place on the earth."""
    return of(mesh).axes == PAGE


def line(mesh: pv.DataSet) -> str:
    """Return the meaning of a mesh in one line; an empty text where there is none."""
    meaning = of(mesh)
    axes = meaning.axes
    if axes[1:] == ["y", "z"] and axes[0].startswith("x in "):
        axes = [f"x, y, z{axes[0][1:]}"]
    return ", ".join((*axes, *meaning.notes))


#: Parts of standard names by which components of one vector differ.
_STANDARD = (
    ("grid_east", "grid_north", "grid_up"),
    ("east", "north", "up"),
    ("zonal", "meridional"),
    ("x_", "y_", "z_"),
    ("u_", "v_", "w_"),
)
#: Names such as urot, with whatever word, of which both must have one unit; uv is u times v.
_ANY = r"(|.*[_\-. ])([uvw])([a-tx-z]\w+)"
#: Usual names of components, and their words in the order x, y, z. The rest of a name, before and
#: after, is the same for all components.
_USUAL = (
    # Velocity_x, vx, B_z, VelX
    (r"(.+)([xyz])()", "x y z"),
    # x_wind, xwind, and xdsp of a solid
    (r"()([xyz])([_\-. ].+|wind|vel\w*|curr\w*|comp\w*|dsp|disp\w*)", "x y z"),
    # 10u, tauu, siu, ssu, sivelu, windu, tauuo
    (r"(\d+|.*tau|si|ss|sivel|w(?:i?nd|spd)|vel|curr?|current|mean)([uv])(o?)", "u v"),
    # u, u10, um, uo, uas, UGRD_10m, water_u, 10m_u_component_of_wind
    (
        r"(|.*[_\-. ])([uvw])(|[\d_\-. @(].*|[oasgbtem]|as|os|si|ice|bar|surf|sfc"
        r"|(?:st|cur|vel|comp|wi?nd|grd|g[eo]o|gos|gust|flx|tau|tot|tide|true|mean|av|sp(?:ee)?d).*)",
        "u v w",
    ),
    # sustr and svstr of ROMS
    (r"([sb])([uv])(str)", "u v"),
    # NEMO's vozocrtx and vomecrty
    (r"(vo|so)(zo|me)(.*)[xy]", "zo me"),
    (r"(.*)(zonal|meridional)(.*)", "zonal meridional"),
    # ulon and ulat, of models on a sphere
    (r"([uv]_?)(lon|lat)()", "lon lat"),
    # velocity_0, velocity_1 and velocity_2, columns of one array
    (
        r"((?:.*[_\W])?(?:vel\w*?|vectors?|wi?nd|curr\w*?|displ\w*?|forces?|flow)[_:.\- ]?)(\d)()",
        "0 1 2",
    ),
    # uEast and v_northward
    (r"()[uv]_?(east|north)(.*)", "east north"),
    (r"(.*)(east|north)(.*)", "east north"),
    # ewind, E_wind, vel_e, windE, ve
    (r"()([enu])(_?(?:wind|vel\w*|curr\w*))", "e n u"),
    (r"((?:.*_)?(?:[vw]|wi?nd|vel\w*|curr\w*)_?)([enu])()", "e n u"),
    # ewss and inss, stresses of ECMWF
    (r"(i?)(ew|ns)(ss?)", "ew ns"),
    # Numbers of GRIB's tables, which cdo writes where it has no name: var165 and var166
    *((rf"(var|param|code)({n}|{n + 1})()", f"{n} {n + 1}") for n in (131, 165, 180, 229, 246)),
    (_ANY, "u v w"),
)
#: Names of places, of sizes of cells and of properties of rock along axes, which end as components.
_NO_COMPONENT = (
    r"ma[xy]|(perm\w*|tran\w*|mult|k)[_\W]?[xyz]"
    r"|(.*[_\W])?([xyzh][_\W]|(x?lat|x?long?|mask|mapfac|angle|area|depth)[_\W]?)[muv][xy]?"
)
#: A knot in metres a second.
_KNOT = 1852 / 3600
#: Letters of axes that stand anywhere in names, if their unit is one of motion or of stress.
_LETTERS = ("u v w", "x y z", "e n u")


def components(mesh: pv.DataSet, /) -> list[tuple[str, ...]]:
    """Return the arrays of a mesh that are components of one vector.

    Standard names are taken first, such as ``eastward_wind`` and ``northward_wind``, then usual
    names, such as ``u`` and ``v``, ``u10`` and ``v10``, ``vx``, ``vy`` and ``vz``, ``x_wind`` and
    ``y_wind``. Half a pair is no vector. Arrays have one component each, all of points or all of
    cells, in the order x, y, z.
    """
    result: list[tuple[str, ...]] = []
    table = of(mesh).arrays
    for data in (mesh.point_data, mesh.cell_data):
        names = [
            name
            for name in data
            if np.ndim(data[name]) == 1 and np.asarray(data[name]).dtype.kind in "iuf"
        ]
        used: set[str] = set()
        for group in (*_by_standard(names, table), *_by_usual(names, table)):
            # An array is a component of one vector.
            if not used.intersection(group):
                used.update(group)
                result.append(group)
    return result


def _by_standard(
    names: Sequence[str], table: dict[str, dict[str, str]]
) -> Iterator[tuple[str, ...]]:
    """Yield groups of names by their standard names, or their long names where they have none."""
    standard = {name: _described(table.get(name, {})) for name in names}
    counts = Counter(standard.values())
    # Winds at several heights have one standard name: their own names tell them apart.
    by_name = {value: name for name, value in standard.items() if value and counts[value] == 1}
    for value, name in by_name.items():
        for first, *others in _STANDARD:
            found = re.search(rf"(?:(?<=_)|^){first}", value)
            if found is None:
                continue
            like = [value[: found.start()] + word + value[found.end() :] for word in others]
            if like[0] in by_name:
                yield (name, *(by_name[one] for one in like if one in by_name))
                break


def _described(attributes: Mapping[str, str]) -> str:
    """Return the standard name of an array, else its long name in the form of one."""
    text = attributes.get("standard_name") or attributes.get("long_name", "")
    if "coordinate" in text:
        return ""
    return re.sub(r"[^a-z0-9]+", "_", text.lower())


def _by_usual(names: Sequence[str], table: dict[str, dict[str, str]]) -> Iterator[tuple[str, ...]]:
    """Yield groups of names that differ by the letter of their axis alone."""
    units = {name: table.get(name, {}).get("units", "") for name in names}
    names = [name for name in names if not re.fullmatch(_NO_COMPONENT, name, re.IGNORECASE)]
    for pattern, parts in _USUAL:
        groups: dict[tuple[str, ...], dict[str, str]] = {}
        for name in names:
            match = re.fullmatch(pattern, name, re.IGNORECASE)
            if match is not None:
                head, part, tail = match.groups()
                # The case of the letter counts: "U" and "v" are no pair.
                key = (head, tail, str(part[0].isupper()), units[name])
                if key[-1] or pattern != _ANY:
                    groups.setdefault(key, {})[part.lower()] = name
        for group in groups.values():
            every = [group[word] for word in parts.split() if word in group]
            # With a fourth number these are no axes, but layers or kinds.
            if set(parts.split()[:2]) <= set(group) <= set(parts.split()):
                yield tuple(every)
    yield from _by_letters([name for name in names if _is_of_motion(units[name])], units)


def _by_letters(names: Sequence[str], units: Mapping[str, str]) -> Iterator[tuple[str, ...]]:
    """Yield groups of names of one unit that differ by a letter, wherever it stands in them."""
    for name in names:
        for letters in (*_LETTERS, *map(str.upper, _LETTERS)):
            first, *others = letters.split()
            places = [found.span() for found in re.finditer(first, name)]
            groups = [[name[:i] + letter + name[j:] for letter in others] for i, j in places]
            # Of uu and vv every letter differs; beside them uv makes all three products.
            if len(places) > 1:
                groups.append([name.replace(first, letter) for letter in others])
            there = [group for group in groups if units.get(group[0]) == units[name]]
            if len(there) == 1:
                yield (name, *(one for one in there[0] if one in names))


def _is_of_motion(unit: str) -> bool:
    """Return whether a unit is that of a velocity or of a stress."""
    return _speed(unit) is not None or re.fullmatch(r"pa|n.*m.*2", unit, re.I) is not None


def _speed(unit: str) -> float | None:
    """Return a unit of speed in metres a second, None where it is none."""
    parts = re.fullmatch(r"(\w+?)(?: */ *|[ .*]+)([a-z]+?)(?:(?:\^|\*\*)?-1)?", unit, re.IGNORECASE)
    if parts is not None and (length := metres(parts[1])) is not None:
        time = dates.seconds(parts[2])
        return None if time is None else length / time
    if re.fullmatch(r"kn|kts?|knots?", unit, re.IGNORECASE):
        return _KNOT
    return 1.0 if unit.lower() == "ms-1" else None


def speed(mesh: pv.DataSet, named: str) -> float:
    """Return the unit of vectors in metres a second, 1 where nothing is said of it.

    ``named`` is the name of vectors, or names of their components separated by commas.
    """
    unit = of(mesh).arrays.get(named.partition(",")[0], {}).get("units", "")
    return _speed(unit) or 1.0


def vectors(mesh: pv.DataSet, names: Sequence[str]) -> Raw:
    """Return vectors of the components that two or three point arrays are.

    A third component that is missing is 0; where one is missing in the data all are NaN.
    """
    return stacked([np.asarray(mesh.point_data[name]) for name in names])


def only_vectors(mesh: pv.DataSet) -> str | None:
    """Return the names of the only components of a mesh, None where it has other vectors or none.

    Several that could be meant raise ValueError.
    """
    data = (mesh.point_data, mesh.cell_data)
    if any(np.shape(part[key])[1:] == (3,) for part in data for key in part):
        return None
    names = [*(",".join(group) for group in components(mesh)), *_planar(mesh)]
    if len(names) > 1:
        expected = f"the name of an array, or names of components ({' or '.join(names)})"
        raise _check.value_error("tangents", expected, None)
    return names[0] if names else None


def _planar(mesh: pv.DataSet) -> list[str]:
    """Return the names of the vectors of two components, as those of a flow in a plane."""
    texture = mesh.point_data.active_texture_coordinates_name
    return [
        name
        for data in (mesh.point_data, mesh.cell_data)
        for name in data
        if is_planar(data[name]) and name != texture
    ]


def are_vectors(rows: Raw) -> bool:
    """Return whether rows are real vectors of three components."""
    return np.shape(rows)[1:] == (3,) and np.asarray(rows).dtype.kind == "f"


def with_components(mesh: DataSetT) -> DataSetT:
    """Return a mesh with vectors of the points, also those of its components."""
    named = mesh.copy(deep=False)
    for group in components(mesh):
        if ",".join(group) not in mesh.array_names and group[0] in mesh.point_data:
            named.point_data[",".join(group)] = vectors(mesh, group)
    return named


def is_planar(rows: Raw) -> bool:
    """Return whether rows are vectors of two components."""
    return np.shape(rows)[1:] == (2,) and np.asarray(rows).dtype.kind == "f"


def with_named(mesh: DataSetT, named: Named | None) -> tuple[DataSetT, Named | None]:
    """Return a mesh with the vectors that are named by their components, and their name.

    Names are those of vectors, or of their components separated by commas. None takes the only
    components of the mesh, if it has no array of three components. Vectors of two components get 0
    as the third. The mesh is not changed: a copy shares its arrays and has the vectors too; a name
    of no components is returned as it is.
    """
    if named is None:
        named = only_vectors(mesh)
    if isinstance(named, str) and named in mesh.array_names and is_planar(mesh[named]):
        mesh = records.averaged(mesh, named).copy(deep=False)
        flat = np.asarray(mesh.point_data[named])
        mesh.point_data[named] = np.pad(flat, ((0, 0), (0, 1)))
        return mesh, named
    if not isinstance(named, str) or "," not in named or named in mesh.array_names:
        return mesh, named
    group = tuple(named.split(","))
    there = {name: np.ndim(mesh[name]) for name in group if name in mesh.array_names}
    if len(group) == 2 and set(there.values()) == {2}:
        expected, remedy = "True for two arrays, a cross field", "pass line_field=True"
        raise _check.value_error("line_field", expected, False, remedy)
    if len(there) != len(group) or len(group) not in (2, 3) or set(there.values()) != {1}:
        expected = "the names of two or three arrays of one component"
        known = [",".join(one) for one in components(mesh)]
        remedy = f"there are {' and '.join(known)}" if known else ""
        raise _check.value_error("tangents", expected, repr(named), remedy)
    # Arrays of cells are averaged to the points.
    mesh = records.averaged(mesh, *group).copy(deep=False)
    mesh.point_data[named] = vectors(mesh, group)
    return mesh, named


#: Lengths in metres of other units.
_METRES = {
    "m": 1.0, "metre": 1.0, "meter": 1.0, "km": 1e3, "kilometre": 1e3, "kilometer": 1e3,
    "dam": 10.0, "decametre": 10.0, "decameter": 10.0, "dm": 0.1, "decimetre": 0.1,
    "decimeter": 0.1, "cm": 1e-2, "centimetre": 1e-2, "centimeter": 1e-2, "mm": 1e-3,
    "millimetre": 1e-3, "millimeter": 1e-3, "ft": 0.3048, "foot": 0.3048, "feet": 0.3048,
    "us survey foot": 1200 / 3937, "us_survey_foot": 1200 / 3937,
}  # fmt: skip


#: Words after a unit of length for where heights begin.
_ABOVE_SEA = re.compile(r" \(?(msl|a\.?m?\.?s\.?l\.?|above (mean )?sea[ -]level)\)?$")


def metres(unit: str) -> float | None:
    """Return the length of a unit in metres, None where it is no length.

    Units are in singular or plural.
    """
    name = _ABOVE_SEA.sub("", unit.strip().lower())
    return _METRES.get(name, _METRES.get(name.removesuffix("s")))


#: Units in which air has numbers of five digits and more, and the usual ones, with their sizes.
_USUAL_UNITS = {"Pa": (100.0, "hPa")}
#: Number from which on a unit is replaced by the usual one.
SILLY = 1e4
#: Units of rates of rain, in the forms of files, and their sizes in that of maps.
_OF_RAIN, OF_RAIN = {"kg m-2 s-1": 1.0, "mm s-1": 1.0, "m s-1": 1e-3}, "mm/day"


def usual_unit(mesh: pv.DataSet, name: str, size: float) -> tuple[float, str]:
    """Return the unit in which people read an array, and its size in that of the array.

    Pressures of air in Pa are read in hPa, where their numbers have five digits and more, and rates
    of rain in millimetres a day. ``size`` is the largest of its values, without sign.
    """
    attributes = of(mesh).arrays.get(name, {})
    given = attributes.get("units", "")
    words = " ".join(attributes.values()).lower().replace("_", " ")
    is_of_air = re.search(r"air pressure|sea level|surface pressure|\bmsl\b", words) is not None
    if size >= SILLY and is_of_air and "pressure" in words:
        return _USUAL_UNITS.get(given, (1.0, given))
    plain = re.sub(r"\*\*|\^", "", given)
    if plain in _OF_RAIN and re.search(r"precipitation|rain|snowfall", words):
        return _OF_RAIN[plain] / 86400, OF_RAIN
    return 1.0, given


#: Names of degrees Celsius, in lower case and in the singular.
_CELSIUS = {"degree_c", "degree_celsius", "degc", "celsius", "deg_c", "degree celsius", "deg c"}
#: Names of temperatures, in lower case.
_TEMPERATURE = re.compile(r"t|theta|(.*[^a-z])?temp(erature)?s?([^a-z].*)?|(.*[^a-z])?(sst|tas)")
#: Words of differences of temperatures, in lower case.
_DIFFERENCE = re.compile("anomal|bias|change|departure|differ|trend")
#: Names of directions, in lower case.
_DIRECTION = re.compile(r".*(heading|azimuth|direction|orientation|bearing|course).*|aspect")
#: Names of properties of rock that differ by decades, in lower case.
_IN_DECADES = re.compile(r"perm[_ ]?[xyz\d]*|(.*[^a-z])?(permeab|conductiv|resistiv|transmiss).*")
#: Symbols of units that are written out, and of their prefixes.
_PREFIXES = {"": "", "kilo": "k", "hecto": "h", "centi": "c", "milli": "m"}
_SYMBOLS = {"meter": "m", "metre": "m", "second": "s", "gram": "g", "pascal": "Pa", "kelvin": "K"}
_WRITTEN_OUT = re.compile("(kilo|hecto|centi|milli)?(meter|metre|second|gram|pascal|kelvin)s?")
#: A factor of a unit, such as m, s-1, s**-1, m^2 or m+2.
_FACTOR = re.compile(r"([A-Za-z%]+)(?:\*\*|\^)?([-+]?[1-3])?")


def is_in_decades(mesh: pv.DataSet, name: str) -> bool:
    """Return whether an array is one of permeabilities, conductivities or resistivities."""
    return _is_called(mesh, name, _IN_DECADES)


def is_temperature(mesh: pv.DataSet, name: str) -> bool:
    """Return whether an array is one of temperatures, by its name or the words of its file."""
    is_difference = any(_DIFFERENCE.search(word) for word in _words_of(mesh, name))
    return not is_difference and _is_called(mesh, name, _TEMPERATURE)


def is_reflectivity(mesh: pv.DataSet, name: str) -> bool:
    """Return whether an array is one of how much rain reflects, by its unit."""
    return of(mesh).arrays.get(name, {}).get("units", "").lower() == "dbz"


def is_direction(mesh: pv.DataSet, name: str) -> bool:
    """Return whether an array is one of directions in degrees, or in no unit that is said."""
    unit = of(mesh).arrays.get(name, {}).get("units", "").lower()
    return (not unit or unit.startswith("deg")) and _is_called(mesh, name, _DIRECTION)


def _is_called(mesh: pv.DataSet, name: str, pattern: re.Pattern[str]) -> bool:
    """Return whether a pattern is that of the name of an array, or of words of its file for it."""
    return any(pattern.fullmatch(word) for word in _words_of(mesh, name))


def _words_of(mesh: pv.DataSet, name: str) -> list[str]:
    """Return the name of an array and the words of its file for it, in lower case."""
    attributes = of(mesh).arrays.get(name, {})
    words = (name, attributes.get("standard_name", ""), attributes.get("long_name", ""))
    return [word.lower() for word in words]


def _symbol(name: str) -> str:
    """Return the symbol of a unit that is written out, such as cm for centimeters."""
    found = _WRITTEN_OUT.fullmatch(name.lower())
    return _PREFIXES[found[1] or ""] + _SYMBOLS[found[2]] if found is not None else name


#: Units in capitals that mean nothing else.
_CAPITALS = {"M/S", "CM/S", "KM/H", "METERS", "METRES", "MM/DAY", "PERCENT"}


def written(unit: str) -> str:
    """Return a unit as it is printed: m/s for "m s**-1"; what is no product of factors as it is.

    Units in files are those of UDUNITS.
    """
    if unit.lower().replace("degrees", "degree") in _CELSIUS:
        return "°C"
    if unit in _CAPITALS:
        unit = unit.lower()
    if "/" in unit and not re.search(r"[\s()*^.\d]", unit):
        return "/".join(map(_symbol, unit.split("/")))
    factors = [_FACTOR.fullmatch(word) for word in unit.split()]
    known = [(_symbol(found[1]), int(found[2] or 1)) for found in factors if found is not None]
    below = [name + " ²³"[-power - 1].strip() for name, power in known if power < 0]
    above = [name + " ²³"[power - 1].strip() for name, power in known if power > 0]
    # Without a factor above or with several below no shorter form is usual.
    if len(known) < len(factors) or not above or len(below) > 1:
        return unit
    return " ".join(above) + "".join(f"/{name}" for name in below)


def along_grid(attributes: Mapping[str, str]) -> bool | None:
    """Return whether a component is along the axes of its grid, not east or north.

    None where the attributes of its array do not tell. They are the standard name and the long
    name, as :class:`Meaning` has them.
    """
    standard = attributes.get("standard_name", "").lower()
    words = f"{standard} {attributes.get('long_name', '').lower()}"
    if re.search(r"(?<![a-z])[xyij][_ -]|grid|_i_|_j_", words):
        return True
    return False if re.search(r"east|north|zonal|meridional", words) else None
