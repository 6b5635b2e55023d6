"""Keywords of PyVista for a lit mesh: its own, those of the light, and colours."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Iterable, Iterator

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike, NDArray
from pyvista.plotting.colors import get_cycler

from vizlight import _check
from vizlight._types import FeatureAngle, Keywords, Raw
from vizlight.filters import relight
from vizlight.mesh import blocks, records
from vizlight.scene import Scene
from vizlight.scene.keywords import unknown_option
from vizlight.shading.options import LightOptions

#: Options of light that a live light takes; an actor has a name of its own.
LIGHT = {*inspect.signature(LightOptions).parameters} - {"name", "components"}
#: Coefficients that a scene has and PyVista takes as keywords.
MATERIAL = {"ambient", "diffuse", "specular", "specular_power"}
#: Other names that PyVista knows for its keywords.
ALIASES = {
    "rng": "clim", "colormap": "cmap", "backface_culling": "culling", "rgba": "rgb",
}  # fmt: skip
#: Keywords of ``add_mesh`` that its signature does not name.
_MORE = {"vertex_color", "vertex_style", "vertex_opacity", "theme"}
#: Names of the arrays that hold colours given as an array, and colours as bytes.
GIVEN, BYTES = "Data", "vizlight rgb"


def sorted_out(
    function: str, options: Keywords, scene: Scene | None, more: Iterable[str] = ()
) -> tuple[Keywords, Keywords]:
    """Return options of light, and keywords of ``pyvista.Plotter.add_mesh`` by their own names."""
    drawn = {*inspect.signature(pv.Plotter.add_mesh).parameters, *ALIASES, *_MORE}
    drawn -= {"self", "mesh", "kwargs"}
    for name, value in options.items():
        if name not in drawn | LIGHT:
            names = [*sorted(LIGHT), *sorted({*drawn, *more} - LIGHT)]
            raise TypeError(unknown_option(function, name, names))
        if name in MATERIAL and scene is not None and value is not None:
            remedy = "pass Scene(material=Material(...))"
            expected = "the material of the scene, or no scene"
            raise _check.value_error(name, expected, f"both ({value})", remedy)
    light = {name: value for name, value in options.items() if name in LIGHT}
    drawing = {ALIASES.get(name, name): options[name] for name in options if name not in LIGHT}
    return light, drawing


def shading_of(drawing: Keywords) -> FeatureAngle:
    """Take from keywords how round a surface looks: the angle at which its points are split."""
    smooth, split = drawing.pop("smooth_shading", None), drawing.pop("split_sharp_edges", None)
    if smooth is False:
        return 0.0
    if split is None:
        return "auto"
    return float(pv.global_theme.sharp_edges_feature_angle) if split else None


def left_to_pyvista(drawing: Keywords) -> str | None:
    """Return why PyVista draws a mesh with its own light: None if not, empty if that was asked."""
    if drawing.get("lighting") is False:
        return ""
    if drawing.get("pbr"):
        return "pbr=True is a material that only PyVista's light has"
    if drawing.get("style") == "points_gaussian":
        return "style='points_gaussian' draws splats, which have no normals"
    return None


def is_cloud(mesh: pv.DataSet, options: Keywords) -> bool:
    """Return whether a mesh is points alone, for which no light is asked and that have none."""
    light_names = options.keys() & {"tangents", "normals", "facing"}
    if light_names or mesh.point_data.active_normals is not None or relight.is_lit(mesh):
        return False
    kinds = pv.PolyData | pv.PointSet | pv.UnstructuredGrid
    return isinstance(mesh, kinds) and mesh.n_points > 0 and mesh.max_cell_dimensionality == 0


def block_colors(drawing: Keywords) -> Iterator[Keywords]:
    """Take ``multi_colors`` from keywords, and yield each block's after another."""
    if not drawing.pop("multi_colors", False):
        return itertools.repeat({})
    return ({"color": row["color"]} for row in itertools.cycle(get_cycler("default")))  # type: ignore[no-untyped-call]


def active_scalars(mesh: pv.DataSet | pv.MultiBlock) -> str | None:
    """Return the active scalars that all blocks share, unless a filter of light made them."""
    names = set()
    for block in blocks.all_blocks(mesh):
        if not block.n_points:
            continue
        kind, name = block.active_scalars_info
        if name is None:
            return None
        data = block.point_data if kind == pv.FieldAssociation.POINT else block.cell_data
        if name in records.all_made(block) or np.asarray(data[name]).dtype.kind not in "iubf":
            return None
        names.add(name)
    return names.pop() if len(names) == 1 else None


def colored(
    mesh: pv.DataSet | pv.MultiBlock, scalars: str | ArrayLike | None, drawing: Keywords
) -> tuple[pv.DataSet | pv.MultiBlock, str | None]:
    """Return a mesh with its colours as an array by name, and the name.

    Colours that are given as an array, or as numbers of ``rgb=True``, or as cell data beside point
    data of the same name, are attached to a shallow copy.
    """
    if scalars is None:
        return mesh, None
    rgb = bool(drawing.pop("rgb", False))
    of_cells = drawing.pop("preference", "point") == "cell"
    if not isinstance(scalars, str):
        if isinstance(mesh, pv.MultiBlock):
            remedy = "attach it to the blocks"
            expected, got = "the name of an array for a MultiBlock", _check.describe(scalars)
            raise TypeError(_check.message("scalars", expected, got, remedy))
        return _attached(mesh, GIVEN, scalars, rgb=rgb, of_cells=of_cells), GIVEN
    _check.text("scalars", scalars, expected="the name of an array")
    every = list(blocks.all_blocks(mesh))
    at = [array_of(block, scalars, of_cells=of_cells) for block in every]
    both = any(scalars in block.point_data and scalars in block.cell_data for block in every)
    if not (rgb or (both and of_cells)):
        return mesh, scalars
    name = BYTES if rgb else GIVEN
    result = (
        block
        if values is None
        else _attached(
            block, name, values, rgb=rgb,
            of_cells=scalars in block.cell_data and (of_cells or scalars not in block.point_data),
        )
        for block, values in zip(every, at, strict=True)
    )  # fmt: skip
    return blocks.like(mesh, result), name


def whole_range(mesh: pv.DataSet, name: str | None, drawing: Keywords) -> Keywords:
    """Return the limits of the colours of a grid, of which its surface alone is drawn.

    They are those of all its values, as in PyVista, unless limits are given. Infinite values, which
    leave no colour to the others, are none of them, also on a surface.
    """
    if name is None or drawing.get("clim") is not None:
        return {}
    values = array_of(mesh, name)
    if values is None or values.ndim != 1:
        return {}
    real = values.dtype.kind == "f"
    if isinstance(mesh, pv.PolyData) and not (real and np.isinf(values).any()):
        return {}
    finite = values[np.isfinite(values)] if real else values
    if drawing.get("log_scale") or values.dtype.kind not in "iuf" or not finite.size:
        return {}
    return {"clim": (float(finite.min()), float(finite.max()))}


def array_of(mesh: pv.DataSet, name: str, *, of_cells: bool = False) -> Raw | None:
    """Return an array of a mesh, of its points or else of its cells, or the other way round."""
    places = (mesh.cell_data, mesh.point_data) if of_cells else (mesh.point_data, mesh.cell_data)
    return next((np.asarray(data[name]) for data in places if name in data), None)


def _attached(
    mesh: pv.DataSet, name: str, values: ArrayLike, *, rgb: bool, of_cells: bool
) -> pv.DataSet:
    """Return a shallow copy of a mesh with an array, colours as bytes."""
    rows = _check.reals("scalars", values)
    if rgb:
        rows = as_bytes(rows)
    counts = [mesh.n_cells, mesh.n_points] if of_cells else [mesh.n_points, mesh.n_cells]
    if rows.ndim not in (1, 2) or len(rows) not in counts:
        expected = f"{mesh.n_points} rows, one per point, or {mesh.n_cells}, one per cell"
        raise _check.value_error("scalars", expected, rows)
    copy = mesh.copy(deep=False)
    # Where there are as many cells as points, the rows are the points' unless cells are asked for.
    at_cells = len(rows) == mesh.n_cells and (of_cells or len(rows) != mesh.n_points)
    (copy.cell_data if at_cells else copy.point_data)[name] = rows
    return copy


def as_bytes(colors: Raw) -> NDArray[np.uint8]:
    """Return colours as bytes: those given as bytes as they are, others from 0 to 1 as shares."""
    if colors.ndim != 2 or colors.shape[1] not in (3, 4):
        raise _check.value_error("scalars", "colours of 3 or 4 components for rgb=True", colors)
    if colors.dtype == np.uint8:
        return np.asarray(colors)
    shares = np.asarray(colors, dtype=np.float64)
    scale = 255.0 if np.nanmax(shares, initial=0.0) <= 1.0 else 1.0
    return np.asarray(np.clip(np.nan_to_num(shares) * scale, 0, 255), dtype=np.uint8)
