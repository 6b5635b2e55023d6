"""Colour times light: the colours of data, lit, as bytes."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._version import __version__
from vizlight.filters import lighting, relight
from vizlight.filters.illuminate import separate_copy
from vizlight.mesh import blocks, point_arrays, records
from vizlight.scene import DepthCue, Scene
from vizlight.shading import formulas
from vizlight.shading.results import DEFAULT_NAME, part_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from vizlight._types import Array, ColorLike
    from vizlight.mesh.blocks import MeshT
    from vizlight.shading import engine
    from vizlight.shading.results import Record

    Bytes = NDArray[np.uint8]
    ColorMap = Any

RGB = "rgb"
#: Largest number of colours of a table.
MOST_COLORS = 1 << 16


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
        Point array whose values are coloured, by its name or as an array. Default: the active
        scalars, if they are not the light. The length of vectors is taken, unless ``component``.
    cmap : str, list, matplotlib colormap or pyvista.LookupTable, optional
        Colour map, as for ``pyvista.Plotter.add_mesh``. Default: that of PyVista's theme.
    clim : (float, float) or float, optional
        Values at the ends of the colour map; one number stands for itself and its negative.
        Default: smallest and largest value, over all blocks.
    n_colors : int, default: 256
        Number of colours.
    categories : bool or int, default: False
        Whether there is one colour for each different value, or the number of colours.
    log_scale : bool, default: False
        Whether colours follow the logarithm of the values.
    flip_scalars : bool, default: False
        Whether the colour map is reversed.
    component : int, optional
        Component of vectors that is coloured.
    nan_color, above_color, below_color : colour, optional
        Colours of NaN and of values beyond ``clim``. Default: that of the theme for NaN, and those
        at the ends of the map.
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
        ``rgb_provenance``, from which :func:`unlit_colors` makes the scalar bar.

    Raises
    ------
    TypeError, ValueError
        If the mesh is not lit or has changed since, an array is missing or is cell data, or an
        option does not fit.

    Notes
    -----
    ``colour (ambient + diffuse) + specular``, brought into range by ``filters.displayable``: the
    highlight keeps the colour of the light.
    Lights with a colour, a specular colour and a depth cue count as in the array ``rgb`` of the
    light; the colours of the data stand for the material's. The light is stored in terms where
    ``components=True`` was given, else it is computed again from its record, which takes about
    twice as long as lighting the mesh.

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
    blocks.check(lit)
    out = lit if _check.boolean("inplace", inplace) else separate_copy(lit)
    every = list(blocks.named_blocks(out))
    meshes = [block for block, _ in every]
    _check.array_name("name", name)
    if not _holds_light(meshes, name):
        records.refuse_overwriting(every, name, [name])
    component = None if component is None else _check.integer("component", component, low=0)
    values = [values_of(mesh, scalars, component) for mesh in meshes]
    table = color_table(
        np.concatenate(values) if values else np.zeros(0),
        cmap=cmap, clim=clim, n_colors=n_colors, categories=categories, log_scale=log_scale,
        flip_scalars=flip_scalars, nan_color=nan_color, above_color=above_color,
        below_color=below_color,
    )  # fmt: skip
    factors = _factors_of(out, meshes, light)
    record = _record(table, scalars, light, component)
    made = [
        times_light(map_colors(table, value)[:, :3], *factor)
        for value, factor in zip(values, factors, strict=True)
    ]
    for mesh, array in zip(meshes, made, strict=True):
        kept = records.read(mesh, light) or {}
        records.attach(mesh, name, {name: array}, record | {"scene": kept.get("scene")})
    return out


def _holds_light(meshes: Sequence[pv.DataSet], name: str) -> bool:
    """Return whether a name is that of a colour that came with the light."""
    return name == RGB and all(
        name not in mesh.point_data or name in records.all_made(mesh) for mesh in meshes
    )


def values_of(
    mesh: pv.DataSet, scalars: str | ArrayLike | None, component: int | None = None
) -> NDArray[np.generic]:
    """Return the values that are coloured, one per point."""
    if scalars is None:
        scalars = mesh.point_data.active_scalars_name
        if scalars is None or scalars in records.all_made(mesh):
            own = [key for key in mesh.point_data if key not in records.all_made(mesh)]
            expected = f"the name of a point array, {_check.one_of(own)}"
            raise ValueError(_check.message("scalars", expected, None))
    if isinstance(scalars, str):
        _check.text("scalars", scalars, expected="the name of a point array")
        if scalars not in mesh.point_data:
            cell = scalars in mesh.cell_data
            there = f"a point array, {_check.one_of(list(mesh.point_data))}"
            got = f"the cell array {scalars!r}" if cell else repr(scalars)
            remedy = "call mesh.cell_data_to_point_data()" if cell else ""
            raise ValueError(_check.message("scalars", there, got, remedy))
        array: NDArray[np.generic] = np.asarray(mesh.point_data[scalars])
    else:
        array = _check.reals("scalars", scalars)
        if array.ndim not in (1, 2) or len(array) != mesh.n_points:
            expected = f"{mesh.n_points} rows, one per point"
            raise ValueError(_check.message("scalars", expected, array))
    if array.ndim == 2:
        if component is None:
            return np.asarray(np.linalg.norm(array.astype(np.float64), axis=1))
        column = _check.integer("component", component, low=0)
        if column >= array.shape[1]:
            raise ValueError(
                _check.message("component", f"one of {array.shape[1]} components", component)
            )
        return array[:, column]
    if array.dtype.kind not in "iubf":
        remedy = "attach numbers, such as np.unique(words, return_inverse=True)[1]"
        raise TypeError(_check.message("scalars", "real numbers", _check.describe(array), remedy))
    return array


def color_table(
    values: NDArray[np.generic],
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
    """Return the lookup table that PyVista would draw values with."""
    finite = np.asarray(values, dtype=np.float64)
    finite = finite[np.isfinite(finite)]
    if clim is None and not isinstance(cmap, pv.LookupTable):
        clim = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if isinstance(clim, int | float):
        clim = (-abs(clim), abs(clim))
    ends = None if clim is None else _check.vector("clim", clim)
    if ends is not None and (len(ends) != 2 or ends[0] > ends[1]):
        raise ValueError(_check.message("clim", "a lower and a higher number", clim))
    if not isinstance(categories, bool):
        categories = _check.integer("categories", categories, low=0, high=MOST_COLORS)
    colors = {"nan_color": nan_color, "above_color": above_color, "below_color": below_color}
    known: dict[str, Any] = {name: _known_color(name, color) for name, color in colors.items()}
    sample = pv.PolyData(np.zeros((max(len(values), 1), 3)))
    given = np.asarray(values) if len(values) else np.zeros(1)
    mapper = pv.DataSetMapper(sample)
    try:
        mapper.set_scalars(
            given,
            "values",
            n_colors=_check.integer("n_colors", n_colors, low=1, high=MOST_COLORS),
            scalar_bar_args={},
            categories=categories,
            clim=ends,
            cmap=cmap,
            flip_scalars=_check.boolean("flip_scalars", flip_scalars),
            log_scale=_check.boolean("log_scale", log_scale),
            **known | {"nan_color": known["nan_color"] or pv.global_theme.nan_color},
        )
    except (KeyError, TypeError, ValueError) as error:
        if "n_colors" in str(error):
            raise
        expected = "a colour map or colours that PyVista knows"
        raise ValueError(_check.message("cmap", expected, f"{cmap!r} ({error})")) from error
    table: pv.LookupTable = mapper.lookup_table
    if ends is not None and not isinstance(cmap, pv.LookupTable):
        low, high = ends
        if log_scale and low <= 0:
            low = float(finite[finite > 0].min(initial=high))
        table.scalar_range = (low, high)
    return table


def _known_color(name: str, color: ColorLike | None) -> pv.Color | None:
    """Return a colour in any form that PyVista knows, None for None."""
    if color is None:
        return None
    try:
        with np.errstate(all="ignore"):
            return pv.Color(color)
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        expected = "a colour that PyVista knows"
        raise ValueError(_check.message(name, expected, _check.describe(color))) from error


def map_colors(table: pv.LookupTable, values: NDArray[np.generic]) -> Bytes:
    """Return the colours of values as bytes of shape (N, 4)."""
    if not len(values):
        return np.zeros((0, 4), np.uint8)
    plain = np.ascontiguousarray(values)
    if plain.dtype == np.bool_:
        plain = plain.astype(np.uint8)
    table.BuildSpecialColors()
    # By default VTK takes unsigned bytes for colours and does not map them.
    mapped = table.MapScalars(pv.convert_array(plain), 1, -1, 4)
    return np.array(pv.convert_array(mapped), np.uint8).reshape(-1, 4)


def times_light(colors: Bytes, factor: Array, rest: Array | float) -> Bytes:
    """Return ``colour factor + rest`` in bytes; colours of any number of components."""
    product = colors[:, :3] * np.asarray(factor) + 255.0 * np.asarray(rest)
    out = colors.copy()
    out[:, :3] = displayable(product, white=255.0) + 0.5
    return out


#: Light that makes any colour white.
_WHITE = 1e30


def displayable(rgb: ArrayLike, /, *, white: float = 1.0) -> Array:
    """Return colours whose light may exceed white, with the same hue in the range of a screen.

    Live light, pages, glTF files and pictures show colours by the same rule.

    Parameters
    ----------
    rgb : array_like, shape (..., 3)
        Red, green and blue, 0 or more, such as the array ``rgb`` of a lit mesh.
    white : float, default: 1.0
        Value of all channels of white.

    Returns
    -------
    ndarray, shape (..., 3)
        Colours with channels up to ``white``. Those without a larger one are equal to the bit; all
        channels are NaN where a brighter colour has one that is.

    Raises
    ------
    TypeError, ValueError
        If ``rgb`` is not an array of three real components, or ``white`` is not positive.

    Notes
    -----
    A colour with a channel above 1 is mixed with the gray of the same luma until that channel is 1.
    Hue and luma stay and saturation is lost; from a luma of 1 on the colour is white. Over colours
    of four maps and four names, with light of 0.4 to 1.4 and highlights up to 0.6, the hue of
    Oklab changes by 1.7 degrees in the mean and its lightness by 0.012. Clipped channels change
    them by 19 degrees and 0.034, division by the largest channel by 0.1 degrees and 0.115, which
    makes highlights flat.

    Examples
    --------
    >>> from vizlight.filters.tint import displayable
    >>> displayable([[0.2, 0.5, 0.9], [1.4, 0.5, 0.2]]).round(3)
    array([[0.2  , 0.5  , 0.9  ],
           [1.   , 0.593, 0.457]])
    """
    colors: Array = np.asarray(_check.reals("rgb", rgb), np.float64)
    if colors.ndim < 1 or colors.shape[-1] != 3:
        raise ValueError(_check.message("rgb", "an array of shape (..., 3)", colors))
    white = _check.positive("white", white)
    found: Array = np.maximum(colors, 0.0, order="C")
    rows = found.reshape(-1, 3)
    largest = np.fmax(np.fmax(rows[:, 0], rows[:, 1]), rows[:, 2])
    over = np.flatnonzero(largest > white)
    if len(over):
        # Whatever is as bright as that is white, and infinite light with it.
        bright = np.minimum(rows[over] / white, _WHITE)
        luma = bright @ formulas.LUMA
        most = np.minimum(largest[over] / white, _WHITE)
        kept = np.asarray(formulas.saturation_kept(luma, most))[:, np.newaxis]
        gray = np.minimum(luma, 1.0)[:, np.newaxis]
        rows[over] = white * np.minimum(gray + (bright - gray) * kept, 1.0)
    return found


def light_factors(
    sources: Sequence[relight.Source], scene: Scene, *, threads: int | None = None
) -> list[tuple[Array, Array | float]]:
    """Return for each source what its colours are multiplied by, and what is added.

    Parameters
    ----------
    sources : sequence of Source
    scene : Scene
        Scene with a view; the colour of its material does not count.
    threads : int, optional
        Number of threads.

    Returns
    -------
    list of (ndarray, ndarray or float)
        Each of shape (N, 1), or (N, 3) where a light, the highlight or the cue has a colour.
    """
    material = scene.material
    bare = dataclasses.replace(material, color=None, specular=0.0)
    parts = [(source.seen_from(scene.view, source.inputs), source.options) for source in sources]
    dark = scene.depth_cue if scene.depth_cue is None else _dark(scene.depth_cue)
    first = scene.replace(material=bare, depth_cue=dark)
    shaded, _ = lighting.light(parts, first, threads=threads, progress_bar=False)
    factors = [_channels(shading) for shading in shaded]
    cued = scene.depth_cue is not None and scene.depth_cue.cue > 0
    if not material.specular and not cued:
        return [(factor, 0.0) for factor in factors]
    shine = dataclasses.replace(material, color=None, ambient=0.0, diffuse=0.0)
    second = scene.replace(material=shine)
    shaded, _ = lighting.light(parts, second, threads=threads, progress_bar=False)
    return [(factor, _channels(shading)) for factor, shading in zip(factors, shaded, strict=True)]


def _dark(cue: DepthCue) -> DepthCue:
    return dataclasses.replace(cue, cue=0.0, color=None)


def _channels(shading: engine.Shading) -> Array:
    return shading.luminance[:, np.newaxis] if shading.rgb is None else shading.rgb


def _factors_of(
    lit: pv.DataSet | pv.MultiBlock, meshes: Sequence[pv.DataSet], light: str
) -> list[tuple[Array, Array | float]]:
    """Return the factors of the light that meshes carry, stored or computed again."""
    _check.text("light", light, expected="the name of the light")
    if not relight.is_lit(lit, light):
        known = "a mesh with the light of a filter and its record"
        remedy = "light it by vizlight.illuminate first"
        raise ValueError(_check.message("lit", known, f"no {light!r} with a record", remedy))
    stored = [_stored_terms(mesh, light) for mesh in meshes]
    terms = [term for term in stored if term is not None]
    if len(terms) == len(meshes):
        return terms
    sources, scene = relight.from_record(lit, name=light)
    return light_factors(sources, scene)


def _stored_terms(mesh: pv.DataSet, light: str) -> tuple[Array, Array | float] | None:
    """Return factor and rest from stored terms; None where they do not suffice."""
    scene = Scene.from_dict((records.read(mesh, light) or {})["scene"])
    white = scene.replace(material=dataclasses.replace(scene.material, color=None))
    names = [part_name(light, part) for part in ("ambient", "diffuse", "specular")]
    ours = records.made(mesh, light)
    if scene.depth_cue is not None or white.colored or not set(names) <= ours:
        return None
    if not all(name in mesh.point_data for name in names):
        return None
    ambient, diffuse, specular = (np.asarray(mesh.point_data[name]) for name in names)
    return (ambient + diffuse)[:, np.newaxis], specular[:, np.newaxis]


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
    for option, color in (
        ("nan_color", table.nan_color),
        ("above_color", table.above_range_color),
        ("below_color", table.below_range_color),
    ):
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
        got = f"that of {record.get('filter')}"
        raise ValueError(_check.message("name", "the result of tint", got))
    options = record["options"]
    table = pv.LookupTable()
    table.values = np.array([list(bytes.fromhex(c[1:])) for c in options["colors"]], np.uint8)
    table.log_scale = options["log_scale"]
    table.scalar_range = tuple(options["clim"])
    for own, option in (
        ("nan_color", "nan_color"),
        ("above_range_color", "above_color"),
        ("below_range_color", "below_color"),
    ):
        if options[option] is not None:
            setattr(table, own, options[option])
    return table


def attach_colors(mesh: pv.DataSet, name: str, colors: Bytes) -> None:
    """Attach colours as a point array."""
    point_arrays.attach_rows(mesh, name, colors)
