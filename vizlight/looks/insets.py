"""Smaller views beside the main one: sections through solids and flows, and their other sides."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.draw.cameras import axes_of, outermost
from vizlight.draw.margins import LETTERS
from vizlight.looks import levels
from vizlight.looks.contents import kinds_of
from vizlight.looks.framing import (
    OTHER,
    SIDES,
    Inset,
    Strip,
    apart,
    eye_on_body,
    eye_opposite,
    side_of_body,
)
from vizlight.looks.recipes import fields, lines, surfaces
from vizlight.looks.recipes.drawing import FACING, Layer
from vizlight.looks.steps import Step
from vizlight.looks.wishes import SMALL, even_light
from vizlight.mesh import georeference, meaning
from vizlight.reading import brains, molecules

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Keywords, Vector
    from vizlight.looks.contents import Named
    from vizlight.looks.framing import Viewpoint
    from vizlight.looks.recipes.drawing import Case, Drawing, Recipe

#: Most points and cells of a mesh that is drawn once more, and fewest of one with an inside.
MOST, FEWEST = 300_000, 100
#: Least size of the shorter side of a picture with insets, in pixels.
LEAST_SIZE = 480
#: Shares of the room that are left for the main view, and how much the size of insets counts.
SHARES, WEIGHT = (0.58, 0.64, 0.7), 0.4
#: Room between views as a share of the shorter side of the room, and for words above and below an
#: inset in their height.
GAP, ABOVE, BELOW = 0.03, 2.2, 2.6
#: Least area of a section as a share of that of the box around the volume, and least diagonal of
#: its box in that of this one.
LEAST_AREA, LEAST_LONG = 0.15, 0.4
#: Share of the largest speed in a section up to which a flow stands still.
STILL = 0.02
#: Size of an inset in that of the main view below which strokes of this one would be crowded in it.
CROWDED = 0.6
#: Least width of lines in an inset, and what a section takes of the drawing of the main view.
THINNEST = 1.0
COLORS = ("scalars", "cmap", "clim", "nan_color", "log_scale")
#: Function that puts a mesh in its place in a picture.
INSET = "render.inset"


def of_case(recipe: Recipe, case: Case) -> Case:
    """Return a case with room for insets, where a part of the data is not seen in one view.

    A view that is asked for stands alone.
    """
    wishes = case.wishes
    is_free = all(each is None for each in (wishes.view, wishes.views, wishes.frame))
    mesh = case.data.run()
    is_small = FEWEST <= max(mesh.n_points, mesh.n_cells) <= MOST
    is_small &= min(wishes.size) >= LEAST_SIZE
    if not is_free or not is_small or case.contents.flat_axis is not None or case.on_globe:
        return case
    if wishes.question != "auto" or wishes.part.get("slice") or wishes.make_scene is not None:
        return case
    insets = _insets(recipe, case)
    if not insets:
        return case
    if recipe is lines.lines:
        eye = eye_on_body(mesh)
    else:
        eye = case.eye(case.data if recipe is fields.flow else case.surface)
    return replace(case, wishes=replace(wishes, strip=_strip(case, eye, insets)))


def _insets(recipe: Recipe, case: Case) -> list[Inset]:
    """Return the insets that suit a case: other sides of a body, a section, or its far side."""
    if recipe is lines.lines:
        return _other_sides(case) if case.is_of_body else []
    if recipe is fields.flow:
        return _section(case, of_flow=True)
    if recipe not in (surfaces.values, fields.lengths, fields.vectors) or case.array is None:
        return []
    if case.contents.dimension == 2:
        return _far_side(case)
    # Where one kind is around all others, they are drawn without it.
    is_around = (
        case.array.role == "kinds" and len(kinds_of(case.surface.run(), case.array.name)) < 2
    )
    return [] if case.array.role == "vectors" or is_around else _section(case)


def _other_sides(case: Case) -> list[Inset]:
    main = np.abs(eye_on_body(case.data.run()).toward)
    eyes = [side_of_body(way) for way in SIDES if way[0] >= 0]
    return [
        Inset(eye.toward, eye.up, eye.words.capitalize(), case.ends_of_body(eye.toward, eye.up))
        for eye in eyes
        if not np.array_equal(eye.toward, main)
    ]


def _far_side(case: Case) -> list[Inset]:
    """Return the side of a closed surface that the main view does not show, if it has others."""
    array, mesh = case.needed_array, case.wishes.joined(case.surface, case.needed_array)
    surface = mesh.run()
    if array.role not in ("values", "kinds", "vectors") or not isinstance(surface, pv.PolyData):
        return []
    if brains.hemisphere(surface) or case.is_isosurface or molecules.PLACES in surface.field_data:
        return []
    has_kinds = array.role == "kinds"
    eye = eye_opposite(surface, case.eye(case.surface), array.name, has_kinds=has_kinds)
    return [] if eye is None else [Inset(eye.toward, eye.up, eye.words)]


def _section(case: Case, *, of_flow: bool = False) -> list[Inset]:
    """Return the section through the middle of a volume that is large and shows most of its values.

    That of a solid shows other values than its surface.
    """
    array, volume = case.needed_array, case.data.run()
    if array.role == "colors" or georeference.has_degrees(volume):
        return []
    joined = case.wishes.joined(case.data, array)
    origin = [float(f"{x:.6g}") for x in volume.center]
    sizes, best, largest = np.array(volume.bounds_size), None, 0.0
    for axis in range(3):
        normal = tuple(float(i == axis) for i in range(3))
        section = Step("section", ".slice", joined, normal, origin=origin)
        cut = section.run()
        if not cut.n_cells or cut.length < LEAST_LONG * volume.length:
            continue
        values = _values(cut, array)
        # What stands still around a flow, as around vessels, shows nothing.
        moves = values > STILL * np.nanmax(values, initial=0.0)
        area = cut.area * (float(np.mean(moves)) if of_flow else 1.0)
        if area < LEAST_AREA * np.delete(sizes, axis).prod():
            continue
        score = float(np.nanstd(values)) * math.sqrt(cut.area)
        if of_flow:
            rows = np.nan_to_num(np.asarray(cut[array.name], dtype=np.float64))
            along = np.linalg.norm(rows, axis=1).sum() or 1.0
            score *= 1 - float(np.abs(rows[:, axis]).sum() / along)
        elif not _differ(cut, case.wishes.joined(case.surface, array).run(), array):
            continue
        if score > largest:
            best, largest = (axis, normal, section), score
    if best is None:
        return []
    axis, normal, section = best
    toward: Vector = tuple(-part or 0.0 for part in normal) if axis == 1 else normal
    unit = meaning.written(georeference.unit_of(volume))
    name = f"Section {'xyz'[axis]} = {levels.number(origin[axis])} {unit}".rstrip()
    up: Vector = (0.0, 1.0, 0.0) if axis == 2 else (0.0, 0.0, 1.0)
    return [Inset(toward, up, name, mesh=section)]


def _differ(section: pv.PolyData, surface: pv.DataSet, array: Named) -> bool:
    """Return whether a section through a solid has other values than its surface."""
    areas, values = [], []
    for mesh in (section, surface):
        cells = mesh if array.of_cells else mesh.point_data_to_cell_data()
        areas.append(mesh.compute_cell_sizes(length=False, volume=False).cell_data["Area"])
        values.append(_values(cells, array))
    counts = len(values[0]), len(values[1])
    inside, outside = np.repeat([1.0, 0.0], counts), np.repeat([0.0, 1.0], counts)
    every = np.concatenate(areas)
    return apart(np.concatenate(values), every * inside, every * outside) > OTHER


def _values(mesh: pv.DataSet, array: Named) -> Array:
    rows: Array = np.asarray(mesh[array.name], dtype=np.float64)
    return rows if rows.ndim == 1 else np.linalg.norm(rows, axis=1)


def _strip(case: Case, eye: Viewpoint, insets: Sequence[Inset]) -> Strip:
    """Return the place of insets in which the main view and they are largest."""
    room, mesh = np.array(case.wishes.room), case.data.run()
    main = _size(mesh, eye)
    others = [_size(mesh if it.mesh is None else it.mesh.run(), it) for it in insets]
    best, largest = None, -np.inf
    for share, is_below in itertools.product(SHARES, (False, True)):
        scale = float(np.min(room * ((1.0, share) if is_below else (share, 1.0)) / main))
        _, place, _ = _cell(case, room, share, len(insets), is_below=is_below)
        sizes = [min(scale, float(np.min(place / size))) for size in others]
        score = math.log(scale) + WEIGHT * float(np.mean(np.log(sizes)))
        if score > largest:
            best, largest = Strip(tuple(insets), share, is_below), score
    assert best is not None
    return best


def _cell(
    case: Case, room: Array, share: float, count: int, *, is_below: bool
) -> tuple[Array, Array, float]:
    """Return the sizes of the place of an inset with its words and without, and room above it."""
    cell = room * ((1 / count, 1 - share) if is_below else (1 - share, 1 / count))
    gap, letters = GAP * room.min(), SMALL * LETTERS * min(case.wishes.size)
    above = gap / 2 + ABOVE * letters
    below = gap / 2 + BELOW * letters * case.is_of_body
    return cell, np.maximum(cell - (2 * gap, above + below), 1.0), above


def _size(mesh: pv.DataSet, view: Viewpoint | Inset) -> Array:
    """Return the width and the height of a mesh in a view, above 0."""
    flat = outermost(mesh, view.toward, up=view.up) @ axes_of(view.toward, view.up)[:2].T
    size: Array = np.maximum(np.ptp(flat, axis=0), 1e-6 * mesh.length)
    return size


def drawn(case: Case, drawing: Drawing) -> Drawing:
    """Return a drawing with the insets of a case, for which its camera has room."""
    strip = case.wishes.strip
    if strip is None:
        return drawing
    whole = replace(case.wishes, strip=None)
    room, main, camera = np.array(whole.room), np.array(case.wishes.room), drawing.camera
    # Places are in halves of the height of the main view.
    unit = main[1] / 2
    cell, size, above = _cell(case, room, strip.share, len(strip.insets), is_below=strip.is_below)
    first = main * ((-0.5, -0.5) if strip.is_below else (0.5, 0.5))
    step = cell * ((1, 0) if strip.is_below else (0, -1))
    pixel = 2 * float(camera.run().parallel_scale) / main[1]
    layers, blocks = list[Layer](), list[Step]()
    for i, inset in enumerate(strip.insets):
        middle = first + i * step + (cell[0] / 2, -above - size[1] / 2)
        place = [round(float(x), 3) for x in (*middle / unit, *size / unit)]
        around = drawing.layers[0].mesh if inset.mesh is None else inset.mesh
        scale = min(1.0, pixel * float(np.min(size / _size(around.run(), inset))))
        parts = drawing.layers
        if inset.mesh is not None:
            parts = _of_section(case, drawing, inset.mesh, pixel / scale)
        for layer in parts:
            is_crowded = inset.mesh is None and "width" in layer.keywords and scale < CROWDED
            if layer.mesh.path in (*FACING, "render.box_edges") or is_crowded:
                continue
            seen: Keywords = {"up": inset.up}
            if layer.mesh is not around:
                seen["around"] = around
            moved = Step("inset", INSET, layer.mesh, camera, inset.toward, place, **seen)
            layers.append(replace(layer, mesh=moved, keywords=_thinner(layer.keywords, scale)))
            if layer.mesh is around:
                blocks.append(moved)
    away = np.round((room - main) / unit, 3).tolist()
    wide = Step("camera", "render.beside", camera, right=away[0], below=away[1])
    words = whole.around_insets(Step("", "pyvista.MultiBlock", blocks), wide, strip.insets)
    return replace(drawing, insets=[*layers, case.inked(words)], picture_camera=wide)


def _thinner(keywords: Keywords, scale: float) -> Keywords:
    """Return the drawing of a layer with thinner lines where it is smaller."""
    if "line_width" not in keywords:
        return keywords
    width = float(keywords["line_width"]) * math.sqrt(scale)
    return keywords | {"line_width": round(max(width, THINNEST), 1)}


def _of_section(case: Case, drawing: Drawing, section: Step, pixel: float) -> list[Layer]:
    """Return the layers of a section in the colours of the main view, with isolines or strokes."""
    array, shown = case.needed_array, dict[str, object](color=surfaces.LIGHT_GREY)
    for layer in drawing.layers:
        if "scalars" in layer.keywords:
            shown = {name: layer.keywords[name] for name in COLORS if name in layer.keywords}
            if shown["scalars"] not in section.run().array_names:
                # Lines have a speed of their own, which a plotter takes from vectors.
                shown["scalars"] = array.name
            break
    scene = even_light(drawing.camera)
    layers = [Layer(section, shown | {"scene": scene, "show_scalar_bar": False})]
    for layer in drawing.layers:
        if layer.mesh.name == "isolines":
            lines = Step("", ".contour", section, *layer.mesh.arguments[1:], **layer.mesh.keywords)
            layers.append(replace(layer, mesh=lines))
    rim = Step("rim", "files.borders", section)
    if case.question == "heading":
        strokes = fields.strokes_on(case, section, drawing.camera, pixel)
        layers += [strokes] if strokes is not None else []
    return [*layers, *case.strokes([rim] if rim.run().n_cells else [])]
