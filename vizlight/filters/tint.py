"""Colour times light: the colours of data, lit, as bytes."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Sequence
from typing import Literal

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike, NDArray

from vizlight import _check
from vizlight._types import Array, Bools, ColorLike, Foreign, Keywords, Raw, Slice
from vizlight._version import __version__
from vizlight.filters import lighting, relight
from vizlight.mesh import blocks, normals, records
from vizlight.mesh.blocks import MeshT
from vizlight.model import kernels
from vizlight.scene import Scene
from vizlight.shading import display
from vizlight.shading.display import Bytes
from vizlight.shading.results import DEFAULT_NAME, VALID, Record, part_name
from vizlight.vtk.arrays import are_colors, at_points, is_of_cells
from vizlight.vtk.cells import has_faces, has_polyhedra

ColorMap = Foreign

RGB = "rgb"
#: Largest number of colours of a table.
MOST_COLORS = 1 << 16
#: Attributes of a lookup table that hold the colours of values outside of its range.
SPECIAL_COLORS = {
    "nan_color": "nan_color",
    "above_color": "above_range_color",
    "below_color": "below_range_color",
}


def tint(
    lit: MeshT,
    /,
    scalars: str | ArrayLike | None = None,
    *,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    n_colors: int = 256,
    categories: bool | int = False,
    log_scale: bool = False,
    flip_scalars: bool = False,
    component: int | None = None,
    nan_color: ColorLike | None = None,
    above_color: ColorLike | None = None,
    below_color: ColorLike | None = None,
    light: str = DEFAULT_NAME,
    name: str = RGB,
    inplace: bool = False,
) -> MeshT:
    """Return a lit mesh with the colours of an array times its light.

    Parameters
    ----------
    lit : pyvista.DataSet or pyvista.MultiBlock
        Mesh with the light of a filter, such as :func:`vizlight.illuminate`; not changed, unless
        ``inplace``.
    scalars : str or array_like, shape (N,) or (N, c), optional
        Array of the coloured values, by its name, or as an array with a row per point. Default:
        the active scalars of the points, if they are not the light. Cells of a PolyData surface
        have one colour each, as in PyVista, and those of an UnstructuredGrid where they have whole
        numbers or colours; other grids with colours of cells become such, unless ``inplace``. Other
        cell arrays are averaged to the points. The length of vectors is
        taken, unless ``component``; three or four unsigned bytes are colours. A block without the
        array has the colour of NaN.
    cmap : str, list, matplotlib colormap or pyvista.LookupTable, optional
        Colour map, as for ``pyvista.Plotter.add_mesh``. Default: the map of PyVista's theme if it
        was changed, otherwise ``vizlight.maps.even``, which can be read in any light.
    clim : (float, float) or float, optional
        Values at the ends of the colour map; one number stands for itself and its negative.
        Default: smallest and largest value, over all blocks.
    n_colors : int, default: 256
        Number of colours.
    categories : bool or int, default: False
        Whether each different value has a colour of its own, or the number of colours.
    log_scale : bool, default: False
        Whether colours follow the logarithm of the values.
    flip_scalars : bool, default: False
        Whether the colour map is reversed.
    component : int, optional
        Component of vectors that is coloured.
    nan_color, above_color, below_color : colour, optional
        Colours of NaN and of values beyond ``clim``. Default: mid grey for NaN, unless the theme's
        was changed, and those at the ends of the map.
    light : str, default: "luminance"
        Name of the light.
    name : str, default: "rgb"
        Name of the result.
    inplace : bool, default: False
        Whether the result is attached to the mesh itself.

    Returns
    -------
    pyvista.DataSet or pyvista.MultiBlock
        The mesh with the point array ``rgb`` of three bytes (active scalars), and the field array
        ``rgb_provenance``, from which :func:`unlit_colors` makes the scalar bar. It shares points,
        cells and the other arrays with ``lit``; for a cell array points are split where cells of
        different values meet, and stand behind the others.

    Raises
    ------
    TypeError, ValueError
        If the mesh is not lit or has changed since, an array is missing, or an option does not
        fit.

    Notes
    -----
    ``colour * min(1, max(ambient, 0.3) * ambient light + diffuse)``, and never less than 0.3 of the
    colour: light keeps the chromaticity of the data, so that values can be read by the scalar bar,
    and the highlight, which would hide them, is left out. Lights of a colour count by their luma;
    the colours of the data stand for the material's. Points without light are mid grey, and those
    without light and value have the colour of NaN.

    The light is taken from the mesh where it was stored in terms, with ``components=True``, or has
    no highlight and ``ambient`` of 0.3 or more; else it is computed again from its record, which
    takes about twice as long as lighting the mesh.

    Examples
    --------
    >>> import pyvista as pv, vizlight
    >>> scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    >>> ball = pv.Sphere()
    >>> ball["height"] = ball.points[:, 2]
    >>> lit = vizlight.illuminate(ball, scene)
    >>> vizlight.tint(lit, "height", cmap="viridis")["rgb"].dtype
    dtype('uint8')
    """
    every = blocks.check(lit)
    inplace = _check.boolean("inplace", inplace)
    lit_blocks = [block for block, _ in every]
    _check.array_name("name", name)
    # Colours that came with the light may be replaced by those of the data under the same name.
    if not _holds_light(lit_blocks, name):
        records.refuse_overwriting(every, name, [name])
    component = None if component is None else _check.integer("component", component, low=0)
    split = [_split(mesh, scalars, inplace) for mesh in lit_blocks]
    meshes = [mesh for mesh, _ in split]
    values = values_of_blocks(meshes, scalars, component)
    # One table for all blocks, so that equal values have equal colours.
    table = color_table(
        values,
        cmap=cmap, clim=clim, n_colors=n_colors, categories=categories, log_scale=log_scale,
        flip_scalars=flip_scalars, nan_color=nan_color, above_color=above_color,
        below_color=below_color,
    )  # fmt: skip
    record = _record(table, scalars, light, component)
    lights = _light_of(lit, lit_blocks, light)
    colors = []
    for value, (share, valid), (_, origin) in zip(values, lights, split, strict=True):
        mapped = map_colors(table, value, components=3)
        # A point that was split off has the light of the point that it was.
        there = None if valid is None else valid[origin]
        tinted = display.on_colors(mapped, share[origin], there)
        if there is not None and value.ndim == 1 and value.dtype.kind == "f":
            # Where no value is, none is dimmed.
            empty = ~there & np.isnan(value)
            tinted[empty] = mapped[empty]
        colors.append(tinted)
    out, meshes = blocks.placed(lit, meshes, inplace=inplace)
    for mesh, array in zip(meshes, colors, strict=True):
        kept = records.read(mesh, light) or {}
        records.attach(mesh, name, {name: array}, record | {"scene": kept.get("scene")})
    return out


def _split(
    mesh: pv.DataSet, scalars: object, inplace: bool
) -> tuple[pv.DataSet, NDArray[np.intp] | Slice]:
    """Return a mesh that colours cells by their own values, and the original point of each."""
    if isinstance(scalars, str) and is_of_cells(mesh, scalars):
        if isinstance(mesh, pv.PolyData) and has_faces(mesh):
            return normals.split_values(mesh, scalars)
        # Labels and colours have nothing in between; of a grid no point is split for other values.
        rows = np.asarray(mesh.cell_data[scalars])
        whole = rows.dtype.kind in "iub"
        if are_colors(rows) and not inplace and not isinstance(mesh, pv.PolyData):
            mesh = mesh.cast_to_unstructured_grid()
        if whole and isinstance(mesh, pv.UnstructuredGrid) and not has_polyhedra(mesh):
            return normals.split_grid(mesh, scalars)
    return mesh.copy(deep=False), slice(None)


def _holds_light(meshes: Sequence[pv.DataSet], name: str) -> bool:
    """Return whether a name belongs to a colour that came with the light."""
    return name == RGB and all(
        name not in mesh.point_data or name in records.all_made(mesh) for mesh in meshes
    )


def values_of(
    mesh: pv.DataSet,
    scalars: str | ArrayLike | None,
    component: int | None = None,
    *,
    flat: bool = False,
) -> Raw:
    """Return the values that are coloured, one per point, or bytes that are colours already.

    Values of cells stay one per cell if they are ``flat``. Else whole numbers, which may be labels,
    are not averaged; see :func:`vizlight.vtk.arrays.at_points`.
    """
    if scalars is None:
        scalars = mesh.point_data.active_scalars_name
        # On a lit mesh the light itself is active, which is no datum to be coloured by.
        if scalars is None or scalars in records.all_made(mesh):
            data_names = [key for key in mesh.point_data if key not in records.all_made(mesh)]
            expected = f"the name of a point array, {_check.one_of(data_names)}"
            raise _check.value_error("scalars", expected, None)
    if isinstance(scalars, str):
        _check.text("scalars", scalars, expected="the name of a point array")
        if scalars in mesh.point_data:
            array: Raw = np.asarray(mesh.point_data[scalars])
        elif scalars in mesh.cell_data:
            of_cells = np.asarray(mesh.cell_data[scalars])
            moved = None if flat else at_points(mesh, of_cells)
            array = of_cells if moved is None else moved
        else:
            names = _check.one_of([*mesh.point_data, *mesh.cell_data])
            expected = f"a point array or a cell array, {names}"
            raise _check.value_error("scalars", expected, repr(scalars))
    else:
        array = _check.reals("scalars", scalars)
        if array.ndim not in (1, 2) or len(array) != mesh.n_points:
            expected = f"{mesh.n_points} rows, one per point"
            raise _check.value_error("scalars", expected, array)
    if array.ndim == 2:
        if component is None and are_colors(array):
            return array
        if component is None:
            # In float64, since squares of integers may overflow.
            return kernels.length_rows(array)
        column = _check.integer("component", component, low=0)
        if column >= array.shape[1]:
            expected = f"one of {array.shape[1]} components"
            raise _check.value_error("component", expected, component)
        return array[:, column]
    if array.dtype.kind not in "iubf":
        way = (
            "np.abs(values)"
            if array.dtype.kind == "c"
            else "np.unique(words, return_inverse=True)[1]"
        )
        raise _check.type_error("scalars", "real numbers", array, f"attach numbers, such as {way}")
    return array


def values_of_blocks(
    meshes: Sequence[pv.DataSet],
    scalars: str | ArrayLike | None,
    component: int | None = None,
    *,
    flat: bool = False,
) -> list[Raw]:
    """Return the values that are coloured of each mesh, NaN for a mesh that lacks their array."""
    if not isinstance(scalars, str):
        return [values_of(mesh, scalars, component) for mesh in meshes]
    having = [scalars in mesh.point_data or scalars in mesh.cell_data for mesh in meshes]
    # Where no mesh has it the error lists the arrays of the first.
    having[:1] = [having[0] or not any(having)] if having else []
    return [
        values_of(mesh, scalars, component, flat=flat) if has else np.full(mesh.n_points, np.nan)
        for mesh, has in zip(meshes, having, strict=True)
    ]


def color_table(
    values: Sequence[Raw],
    *,
    cmap: ColorMap = None,
    clim: Sequence[float] | float | None = None,
    n_colors: int = 256,
    categories: bool | int = False,
    log_scale: bool = False,
    flip_scalars: bool = False,
    nan_color: ColorLike | None = None,
    above_color: ColorLike | None = None,
    below_color: ColorLike | None = None,
) -> pv.LookupTable:
    """Return the lookup table that PyVista would draw the values of all blocks with."""
    cmap, nan_color = default_map(cmap), default_nan_color(nan_color)
    # Rows of several components are colours already.
    values = [part for part in values if part.ndim == 1]
    # The mapper below does not see all values, and the range covers all blocks.
    if clim is None and not isinstance(cmap, pv.LookupTable):
        clim = _range(values)
    ends = None if clim is None else _check.limits("clim", clim)
    if not isinstance(categories, bool):
        categories = _check.integer("categories", categories, low=0, high=MOST_COLORS)
    colors = {"nan_color": nan_color, "above_color": above_color, "below_color": below_color}
    special: Keywords = {name: _known_color(name, color) for name, color in colors.items()}
    # PyVista looks at values to count categories alone.
    sample: Raw = np.zeros(1)
    if categories is True and any(len(part) for part in values):
        sample = np.unique(np.concatenate([np.unique(part) for part in values]))
    # PyVista's own mapper makes the table, so that the colours are those of ``add_mesh``.
    mapper = pv.DataSetMapper(pv.PolyData(np.zeros((len(sample), 3))))
    try:
        mapper.set_scalars(
            sample,
            "values",
            n_colors=_check.integer("n_colors", n_colors, low=1, high=MOST_COLORS),
            scalar_bar_args={},
            categories=categories,
            clim=ends,
            cmap=cmap,
            flip_scalars=_check.boolean("flip_scalars", flip_scalars),
            log_scale=_check.boolean("log_scale", log_scale),
            **special,
        )
    except (KeyError, TypeError, ValueError) as error:
        # The check of this option has said already what is wrong with it.
        if "n_colors" in str(error):
            raise
        expected = "a colour map or colours that PyVista knows"
        raise _check.value_error("cmap", expected, f"{cmap!r} ({error})") from error
    table: pv.LookupTable = mapper.lookup_table
    if ends is not None and not isinstance(cmap, pv.LookupTable):
        low, high = ends
        # A logarithmic bar begins at the least value above 0.
        if log_scale and low <= 0:
            low = min((float(np.min(p, where=p > 0, initial=high)) for p in values), default=high)  # type: ignore[operator]
        table.scalar_range = (low, high)
    return table


def _range(values: Sequence[Raw]) -> tuple[float, float]:
    """Return the smallest and the largest finite value, (0, 1) without any."""
    ends = []
    for part in values:
        # The ends are NaN or infinite where some value is: only then is a mask made of all.
        pair = (part.min(), part.max()) if len(part) else ()
        if not np.all(np.isfinite(pair)):
            finite = part[np.isfinite(part)]
            pair = (finite.min(), finite.max()) if len(finite) else ()
        ends += [float(end) for end in pair]
    return (min(ends), max(ends)) if ends else (0.0, 1.0)


def default_map(cmap: ColorMap) -> ColorMap:
    """Return a colour map, ``vizlight.maps.even`` where neither it nor the theme's is chosen."""
    # Loading the module makes its names known.
    from vizlight import maps

    # A theme that someone has changed is a choice, and PyVista's own default is none.
    chosen = cmap is not None or pv.global_theme.cmap != _own_theme().cmap
    return cmap if chosen else maps.even


def default_nan_color(color: ColorLike | None) -> ColorLike:
    """Return a colour of NaN: the theme's if it was changed and none is given, else mid grey."""
    if color is None and pv.global_theme.nan_color != _own_theme().nan_color:
        return pv.global_theme.nan_color
    return display.NO_DATA if color is None else color


@functools.cache
def _own_theme() -> pv.themes.Theme:
    """Return PyVista's theme before anyone changed it."""
    return pv.themes.Theme()


def _known_color(name: str, color: ColorLike | None) -> pv.Color | None:
    """Return a colour in any form that PyVista knows, None for None."""
    if color is None:
        return None
    try:
        with np.errstate(all="ignore"):
            return pv.Color(color)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        expected = "a colour that PyVista knows"
        raise _check.value_error(name, expected, _check.describe(color)) from error


def map_colors(table: pv.LookupTable, values: Raw, *, components: Literal[3, 4] = 4) -> Bytes:
    """Return the colours of values, or colours as they are, as bytes of 3 or 4 components."""
    if not len(values):
        return np.zeros((0, components), np.uint8)
    # Bytes that are colours are not mapped, and are opaque where they have no opacity.
    if values.ndim == 2:
        opaque = np.full((len(values), 1), 255, np.uint8)
        return np.hstack([values, opaque])[:, :components].astype(np.uint8)
    plain = np.ascontiguousarray(values)
    if plain.dtype == np.bool_:
        plain = plain.astype(np.uint8)
    # VTK keeps the colours of NaN and of values out of range behind the table, where only this puts
    # them.
    table.BuildSpecialColors()
    # By default VTK takes unsigned bytes for colours and does not map them.
    mapped = table.MapScalars(pv.convert_array(plain), 1, -1, components)
    return np.array(pv.convert_array(mapped), np.uint8).reshape(-1, components)


def light_on_colors(sources: Sequence[relight.Source], scene: Scene) -> list[tuple[Array, Bools]]:
    """Return for each source the light on colours of data, and a mask of the lit points.

    Both have the shape (N,), as :func:`vizlight.shading.display.on_colors` takes them.
    """
    plain = display.for_colors(scene)
    parts = [(source.seen_from(scene.view, source.inputs), source.options) for source in sources]
    shaded, _ = lighting.light(parts, plain, progress_bar=False)
    exposure = scene.exposure
    return [(display.exposed(shading.luminance, exposure), shading.valid) for shading in shaded]


def _light_of(
    lit: pv.DataSet | pv.MultiBlock, meshes: Sequence[pv.DataSet], light: str
) -> list[tuple[Array, Bools | None]]:
    """Return the light on colours of the meshes, as they carry it or computed again."""
    _check.text("light", light, expected="the name of the light")
    if not relight.is_lit(lit, light):
        expected = "a mesh with the light of a filter and its record"
        remedy = "light it by vizlight.illuminate first"
        raise _check.value_error("lit", expected, f"no {light!r} with a record", remedy)
    stored = [_stored(mesh, light) for mesh in meshes]
    carried = [entry for entry in stored if entry is not None]
    if len(carried) == len(meshes):
        return carried
    scene = Scene.from_dict(records.provenance(lit, light)["scene"])
    # A cue fades the whole sum, and light of a colour counts by its luma: both are computed as a
    # whole for colours of data.
    if scene.depth_cue is not None or _colored(scene):
        again = relight.lit_again(lit, light)
        return [*light_on_colors([part.source for part in again], scene)]
    again = relight.lit_again(lit, light, components=True)
    # Colours of data never have less ambient light, so that they can be read in the shade.
    least = max(scene.material.ambient, display.LEAST) * scene.ambient_intensity
    lights: list[tuple[Array, Bools | None]] = []
    for part in again:
        share, shading = part.inputs.occlusion, part.shading
        # Anything that hides the sky from a point dims the ambient light alone.
        ambient = least if share is None else least * np.asarray(share[:])
        valid = shading.valid if shading.invalid else None
        light_here = ambient + np.asarray(shading.diffuse)
        lights.append((display.exposed(light_here, scene.exposure), valid))
    return lights


def _colored(scene: Scene) -> bool:
    """Return whether light has a colour, on a material that has none."""
    # Colours of the data stand for the material's, which has no part in this.
    white = dataclasses.replace(scene.material, color=None)
    return scene.replace(material=white, exposure=None).colored


def _stored(mesh: pv.DataSet, light: str) -> tuple[Array, Bools | None] | None:
    """Return the light on colours from stored arrays; None where they do not suffice."""
    scene = Scene.from_dict((records.read(mesh, light) or {})["scene"])
    material, ours = scene.material, records.made(mesh, light)
    valid = np.asarray(mesh[light + VALID], np.bool_) if light + VALID in ours else None
    if _colored(scene):
        return None
    # Without a highlight, and with enough ambient light, colours need the luminance alone.
    if light in ours and not material.specular and material.ambient >= display.LEAST:
        return display.exposed(np.asarray(mesh.point_data[light]), scene.exposure), valid
    names = [part_name(light, part) for part in ("ambient", "diffuse")]
    # Terms are stored without the cue, and where they are not stored the highlight stays in the
    # sum.
    if scene.depth_cue is not None or not material.ambient or not set(names) <= ours:
        return None
    ambient, diffuse = (np.asarray(mesh.point_data[name]) for name in names)
    # The ambient light that is stored is raised to the least that colours of data have.
    raised = max(material.ambient, display.LEAST) / material.ambient
    return display.exposed(raised * ambient + diffuse, scene.exposure), valid


def _record(table: pv.LookupTable, scalars: object, light: str, component: int | None) -> Record:
    """Return the record of colours: the whole table, so that the scalar bar can be drawn again."""
    values = np.asarray(table.values, dtype=np.uint8)
    options = {
        "scalars": scalars if isinstance(scalars, str | None) else _check.describe(scalars),
        "component": component,
        "light": light,
        "colors": ["#" + row.tobytes().hex() for row in values],
        "clim": [float(x) for x in table.scalar_range],
        "log_scale": bool(table.log_scale),
    }
    for option, attribute in SPECIAL_COLORS.items():
        color = getattr(table, attribute)
        options[option] = None if color is None else pv.Color(color).hex_rgba
    return {"vizlight": __version__, "filter": "tint", "options": options}


def unlit_colors(mesh: pv.DataSet | pv.MultiBlock, /, name: str = RGB) -> pv.LookupTable:
    """Return the lookup table of the colours before they were lit, for a scalar bar.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh that :func:`tint` returned, or one read from a file of such a mesh.
    name : str, default: "rgb"
        Name of the colours.

    Returns
    -------
    pyvista.LookupTable

    Raises
    ------
    TypeError, ValueError
        If the mesh has no record of such colours.
    """
    record = records.provenance(mesh, name)
    if record.get("filter") != "tint":
        got = f"the result of {record.get('filter')}"
        raise _check.value_error("name", "the result of tint", got)
    options = record["options"]
    table = pv.LookupTable()
    table.values = np.array([list(bytes.fromhex(c[1:])) for c in options["colors"]], np.uint8)
    table.log_scale = options["log_scale"]
    table.scalar_range = tuple(options["clim"])
    for option, attribute in SPECIAL_COLORS.items():
        if options[option] is not None:
            setattr(table, attribute, options[option])
    return table
