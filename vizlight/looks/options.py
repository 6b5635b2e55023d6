"""The options of ``vizlight.look`` by their purpose, and cuts of the data."""

from __future__ import annotations

import functools
import inspect
import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check, files
from vizlight._words import one_of, value_error
from vizlight.draw import render
from vizlight.draw.ticks import round_length
from vizlight.filters import tint
from vizlight.filters.streamlines import vectors_by_default
from vizlight.looks import cuts, map_parts, views
from vizlight.looks.contents import Contents
from vizlight.looks.steps import DISPLACED, Step
from vizlight.looks.wishes import STYLES, Wishes, direction
from vizlight.mesh import charts, georeference, globes, height_grids, meaning, nspace, stresses
from vizlight.reading import series
from vizlight.scene import Scene
from vizlight.scene.keywords import unknown_option
from vizlight.scene.presets import PRESETS, required_scene
from vizlight.shading.options import LightOptions, with_joined_names
from vizlight.vtk.cells import dimensions
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from vizlight._types import Foreign, Given, Keywords
    from vizlight.looks.wishes import SceneMaker

#: Options of how data are read, of what is taken of them, of the camera, and of the picture.
READ = ("time", "overlay", "at", "nodata")
PART = (
    *READ, "clip", "threshold", "contour", "level", "slice", "warp", "exaggeration", "globe",
)  # fmt: skip
EYE = ("up", "parallel", "zoom")
PICTURE = (
    "background", "line_width", "cmap", "clim", "scalars", "key", "map_parts", "backend",
    "progress", "title", "frames", "fps",
)  # fmt: skip
#: Fields of :class:`.Wishes` by the names of the options in them.
GROUP_OF = (
    dict.fromkeys(PART, "part") | dict.fromkeys(EYE, "eye") | dict.fromkeys(PICTURE, "picture")
)


#: Shares of the size of a solid within which the longest displacement is seen, and the share to
#: which a shorter one is taken.
SEEN, MOVED = (0.02, 0.3), 0.05
#: Height of a layer of points, as a share of its shorter side, fewest points of one, and arrays
#: that every lidar measures beside them.
LAYER_OF_POINTS, FEWEST = 0.5, 100
OF_LIDAR = {"intensity", "classification"}


def checked(options: Mapping[str, Given]) -> Keywords:
    """Return options of the part, the camera and the picture, with their texts read."""
    if options.get("slice") is not None and options.get("contour") is not None:
        raise value_error("slice", "no contour beside it", "both")
    return {
        name: value if value is None or name not in CHECKS else CHECKS[name](name, value)
        for name, value in options.items()
    }


def _color(name: str, value: Foreign) -> Foreign:
    """Return a colour that can be drawn."""
    color = _check.color(name, value)
    return value if isinstance(value, str) else color


def _colors(_name: str, value: Foreign) -> Foreign:
    """Return a map of colours that can be drawn, as it is."""
    tint.color_table([], cmap=value)
    return value


#: Checks of the options that no filter checks.
CHECKS: dict[str, Callable[[str, Foreign], Foreign]] = {
    "clip": functools.partial(cuts.several, read=cuts.plane),
    "threshold": functools.partial(cuts.several, read=cuts.interval),
    "slice": cuts.plane,
    "contour": _check.text,
    "level": _check.number,
    "warp": _check.text,
    "exaggeration": _check.number,
    "globe": _check.boolean,
    "parallel": _check.boolean,
    "zoom": _check.positive,
    "background": _color,
    "line_width": functools.partial(_check.number, low=0.1, high=1000.0),
    "cmap": _colors,
    "clim": _check.limits,
    "key": _check.boolean,
    "map_parts": lambda _, parts: map_parts.named(parts),
    "backend": functools.partial(_check.text, expected="'egl' or 'osmesa'"),
    "progress": _check.boolean,
    "title": functools.partial(_check.text, expected="the words above the picture"),
    "frames": functools.partial(_check.integer, low=1),
    "fps": functools.partial(_check.number, low=0.01, high=100.0),
}


def sorted_out(
    question: str,
    *,
    array: str | None,
    view: object,
    size: tuple[int, int],
    style: str,
    options: dict[str, Given],
) -> Wishes:
    """Return the options of a look, each in its group."""
    _check.choice("style", style, tuple(STYLES))
    if array is not None:
        _check.text("array", array, expected="the name of an array")
    if view is not None and not hasattr(view, "GetPosition") and not views.are_several(view):
        direction(view, n=None)
    columns, rows = render.pixels_of(size)
    light_names = {*inspect.signature(LightOptions).parameters}
    groups: dict[str, Keywords] = {"part": {}, "light": {}, "eye": {}, "picture": {}}
    scene = options.pop("scene", None)
    for name, value in checked(options).items():
        group = GROUP_OF.get(name, "light")
        if group == "light" and name not in light_names and question in ("auto", *PRESETS):
            allowed = [*GROUP_OF, "scene", *sorted(light_names)]
            raise TypeError(unknown_option("look", name, allowed))
        groups[group][name] = value
    part, light, eye, picture = groups.values()
    light, maker, pixels = with_joined_names(light), scene_maker(scene), (columns, rows)
    return Wishes(question, array, view, pixels, style, part, light, eye, picture, maker)


def scene_maker(scene: Foreign) -> SceneMaker | None:
    """Return the function that makes the step of a scene that was given: a value or a preset."""
    if scene is None:
        return None
    if isinstance(scene, str):
        required_scene(scene)
        return lambda _question, view, _camera, _n: Step("scene", f"vizlight.presets.{scene}", view)
    _check.instance("scene", scene, Scene)
    return lambda *_: Step("scene", "vizlight.Scene.from_dict", scene.to_dict())


def cut(mesh: Step, contents: Contents, wishes: Wishes) -> tuple[Step, Contents]:
    """Return the steps that raise, clip and choose cells of a mesh after it was read, and contents.

    The contents are those of the mesh and of its layer; the next steps are not looked at.
    """
    part = wishes.part
    if part.get("warp") is not None and not part.get("globe"):
        factor, note = wishes.heightened(mesh.run(), part["warp"])
        mesh = Step("raised", "files.warped", mesh, part["warp"], factor)
        mesh.note = note
    mesh, contents = layer(mesh, contents, wishes)
    for name, low, high in part.get("threshold") or ():
        mesh = _kept(mesh, name, low, high)
    for normal, origin in part.get("clip") or ():
        mesh = Step("clipped", ".clip", mesh, normal=normal, origin=origin)
        mesh.asked = ("clip", f"{normal}, {origin}")
    return mesh, contents


def layer(mesh: Step, contents: Contents, wishes: Wishes) -> tuple[Step, Contents]:
    """Return the step that takes one layer of a volume that is seen from above, and its contents.

    Over a map it is the lowest layer, of a sea the highest, as of any volume that is thin enough to
    be drawn as a map. A volume is left as it is where a question or a part of it was asked for.
    """
    grid, part = mesh.run(), wishes.part
    of_volume = ("contour", "slice", "clip", "threshold")
    if wishes.question != "auto" or any(part.get(name) for name in of_volume):
        return mesh, contents
    is_map, is_thin = georeference.is_map(grid), contents.dimension == 3 and contents.flat_axis == 2
    count = files.layers(grid) if is_map or is_thin else 0
    if not is_map and count <= 2:
        return mesh, contents
    scales, top = meaning.of(grid).scales[2:], grid.bounds[5]
    from_top = not is_map or (scales[0].is_of_sea(top) if scales else top <= 0)
    order = range(count - 1, -1, -1) if from_top else range(count)
    for at in order:
        taken = Step("layer", "files.layer_of", mesh, at)
        contents = replace(contents, mesh=taken.run())
        # The wind across the ground is 0: a layer without data shows nothing.
        if contents.arrays:
            break
    else:
        return mesh, replace(contents, mesh=grid)
    height = abs(float(np.nanmean(taken.run().points[:, 2])))
    which = ("highest" if from_top else "lowest") + " with data" * (at != order[0])
    taken.note = f"the {which} of {count} layers is shown, at {height:g} along z"
    return taken, contents


#: Parts of a map, and questions, for which it stays in degrees.
IN_DEGREES = ("globe", "slice", "contour", "warp", "clip")
RELIEFS = ("relief", "sky", "shadow")
#: Most points of a map whose rows may bend.
MOST_BENT = 4_000_000


def charted(step: Step, contents: Contents, wishes: Wishes) -> tuple[Step, Contents]:
    """Return the step that draws a flat map in degrees on a projection that suits it, and contents.

    Other data, maps seen at a slant and maps cut by planes in degrees stay as they are.
    """
    mesh = contents.mesh
    is_sheet = contents.flat_axis == 2 and contents.dimension in (0, 2)
    is_asked = wishes.view is not None or any(wishes.part.get(name) for name in IN_DEGREES)
    if not is_sheet or is_asked or not georeference.has_degrees(mesh):
        return step, contents
    array = contents.named(wishes.array or "") or next(iter(contents.arrays), None)
    is_relief = array is not None and array.role == "heights" and bool(dimensions(mesh))
    # Shadows are followed over straight rows; a relief of the whole earth is bent once it is lit.
    is_lit_first = wishes.question in ("auto", "relief") and globes.middle_of(mesh) is not None
    of_rows = (is_relief or wishes.question in RELIEFS) and not is_lit_first
    straight = of_rows or mesh.n_points > MOST_BENT
    # A stroke says its course where north is up on the whole map.
    flows = contents.first("vectors") is not None
    text = charts.suited(mesh, straight=straight, north_up=flows)
    if not text:
        return step, contents
    own = [text] if (straight or flows) and text != charts.suited(mesh) else []
    chart = Step("chart", "vizlight.cartography.chart", step, *own)
    if charts.is_torn(chart.run()):
        return step, contents
    return chart, replace(contents, mesh=chart.run())


def strained(step: Step, wishes: Wishes) -> Step:
    """Return the step that gives a solid with stresses that of von Mises, and displaces it."""
    mesh = step.run()
    if not stresses.are_in(mesh):
        return step
    if not any(map(stresses.is_von_mises, mesh.array_names)):
        step = Step("strained", "files.with_von_mises", step, stresses.tensors_of(mesh))
    longest = stresses.displacement(mesh)
    if longest is None or wishes.part.get("warp") is not None:
        return step
    name, length = longest
    if length > SEEN[1] * mesh.length:
        return step
    factor = 1.0 if length > SEEN[0] * mesh.length else round_length(MOVED * mesh.length / length)
    if meaning.is_planar(mesh[name]):
        step = Step("padded", "files.with_vectors", step, name)
    moved = Step(DISPLACED, "files.warped", step, name, factor)
    moved.note = f"the solid is displaced by {factor:g} times {name}; warp= takes other vectors"
    return moved


def in_space(
    step: Step, contents: Contents, wishes: Wishes
) -> tuple[Step, Contents, Wishes, list[str]]:
    """Return the step that shows the last of n coordinates, its contents, wishes and notes.

    Where the others alone would put sheets onto each other it is a perspective projection. The
    coordinate has colours where a mesh has no other data and nobody asks for other light. Other
    data, and meshes that are projected already, are only coloured.
    """
    mesh = contents.mesh
    if contents.dimension not in (1, 2) or wishes.question not in ("auto", "value", "shape"):
        return step, contents, wishes, []
    rows = mesh.point_data.get(nspace.POSITION)
    if rows is None or rows.ndim != 2 or rows.shape[1] < 4 or not np.isfinite(rows).all():
        return step, contents, wishes, []
    n, notes = rows.shape[1], list[str]()
    if nspace.is_dropped(mesh) and nspace.covers_itself(mesh):
        distance = nspace.eye_distance(mesh)
        step = Step("projected", "vizlight.project", step, distance=distance)
        notes = [f"perspective from {distance:.4g} along axis {n}; project(mesh, distance=...) "
                 "takes another"]  # fmt: skip
    elif nspace.is_dropped(mesh):
        notes = [f"coordinates 1 to 3 of {n}; project(mesh, distance=...) shows all by perspective"]
    is_free = not wishes.light and wishes.make_scene is None and wishes.question != "shape"
    ends = float(rows[:, -1].min()), float(rows[:, -1].max())
    name = "w" if n == len("xyzw") else f"x{n}"
    if is_free and not contents.arrays and ends[0] < ends[1] and name not in mesh.array_names:
        step = Step("colored", "files.with_last_coordinate", step, name)
        size = max(map(abs, ends))
        # Of both signs 0 is in the middle; there are no outliers.
        clim = (-size, size) if ends[0] < 0 < ends[1] else ends
        wishes = replace(wishes, picture={"clim": clim} | dict(wishes.picture))
    contents = contents if step.run() is mesh else replace(contents, mesh=step.run())
    return step, contents, wishes, notes


def laid_flat(step: Step, contents: Contents, wishes: Wishes) -> tuple[Step, Contents]:
    """Return the step that draws a surface that is a terrain by its shape as a map, and contents.

    Surfaces with data, those that are seen at a slant or lit by options, and all others stay.
    """
    is_asked = wishes.question not in ("auto", "relief") or wishes.view is not None or wishes.light
    mesh = contents.mesh
    if is_asked or wishes.part.get("warp") or contents.arrays or not height_grids.is_terrain(mesh):
        return step, contents
    heights = Step("heights", ".elevation", step)
    flat = Step("flat", map_parts.FLAT, heights, origin=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    return flat, replace(contents, mesh=flat.run(), raster=True)


def with_heights(step: Step, contents: Contents, wishes: Wishes) -> tuple[Step, Contents]:
    """Return the step that gives points of a layer their heights, and contents.

    Points with data other than those of every lidar, and those that options light, stay.
    """
    sizes = contents.sides
    is_layer = 0 < sizes[2] < LAYER_OF_POINTS * sizes[:2].min()
    is_free = wishes.question == "auto" and not wishes.light and wishes.make_scene is None
    names = {array.name for array in contents.arrays}
    if contents.dimension or contents.flat_axis is not None or not (is_free and is_layer):
        return step, contents
    if wishes.array is not None or not names <= OF_LIDAR or contents.mesh.n_points < FEWEST:
        return step, contents
    heights = Step("heights", ".elevation", step)
    return heights, replace(contents, mesh=heights.run())


def check_flow(file: object, mesh: pv.DataSet, name: str | None) -> None:
    """Check that a step of a file has vectors that are not zero, if another step has them."""
    times = series.of(mesh)
    name = vectors_by_default(mesh) if name is None else name
    if not isinstance(file, str | Path) or len(times) < 2 or _moves(mesh, name):
        return
    having = [time for time in times if _moves(files.read(file, time=time), name)]
    if having:
        expected = f"a step in which {name!r} is not zero everywhere"
        remedy = f"pass --time with one of {series.listed(having)}"
        raise value_error("time", expected, f"{mesh.field_data[series.TIME][0]:g}", remedy)


def _moves(mesh: pv.DataSet, name: str | None) -> bool:
    """Return whether vectors of a mesh are not zero everywhere."""
    every = (mesh.point_data, mesh.cell_data)
    return name is not None and any(name in data and np.any(data[name]) for data in every)


def _kept(mesh: Step, name: str, low: float, high: float) -> Step:
    """Return the step that keeps the cells with values in a range, at all of their corners.

    Labels of the points of an image are those of the pixels or voxels around them.
    """
    grid = mesh.run()
    present = [*grid.point_data, *grid.cell_data]
    if name not in present:
        raise value_error("threshold", f"the name of an array, {one_of(present)}", repr(name))
    # PyVista takes two ends, or one value and the side to keep: the upper one by default.
    ends: object = (low, high)
    if math.isinf(low) or math.isinf(high):
        ends = low if math.isinf(high) else high
    side: Keywords = {"method": "lower"} if math.isinf(low) else {}
    array = Contents(grid).named(name)
    if name in grid.point_data:
        has_labels = array is not None and array.role == "kinds"
        if has_labels and isinstance(grid, pv.ImageData) and not grid.cell_data:
            mesh = Step("voxels", ".points_to_cells", mesh)
        else:
            side["all_scalars"] = True
    step = Step("kept", ".threshold", mesh, ends, scalars=name, **side)
    step.asked = ("threshold", f"{name}, {low:g} to {high:g}")
    if has_lines_only(grid):
        # Lines among cells of any kind would have no width by their spacing.
        step = Step("lines", ".extract_surface", step, algorithm="dataset_surface")
    return step
