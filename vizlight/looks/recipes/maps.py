"""Parts drawn on and around a map, whatever recipe draws its data."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.draw.margins import ink_on
from vizlight.draw.ticks import even_levels
from vizlight.looks import map_parts
from vizlight.looks.recipes.drawing import (
    BANDS,
    LIGHTNESS,
    OF_HEAT,
    Drawing,
    Layer,
    lines_every,
    range_of,
)
from vizlight.looks.steps import Step
from vizlight.looks.wishes import even_light
from vizlight.mesh import charts, georeference, meaning

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Keywords
    from vizlight.looks.recipes.drawing import Case


#: Width of the band beside coasts that sets them apart from dark colours, in widths of the line.
BAND = 0.5
#: Note on a map with coasts that are not drawn.
TOO_COARSE = (
    f"coasts are too coarse for maps under {map_parts.COASTS * 111:.0f} km; map_parts= draws them"
)
#: Colour of the ball where a globe has no data, which hides its far side.
BALL = "whitesmoke"
#: Colour of coasts below black strokes: a brown, unlike the blues and greens of the ground.
UNDER_STROKES = "#9a4f1f"
#: Colour map of bands of temperatures beside land without any.
ON_WARM_SEA = OF_HEAT[LIGHTNESS]
#: Colour of meridians and parallels.
GRATICULE = "#555555"
#: Colour of isolines and their numbers, which is seen on all colours of bands, and on those of the
#: ground, where lines are brown on maps.
INK, INK_ON_RELIEF = "#1a1a1a", "#3d2610"
#: Least distance between isolines of heights, in heights of their letters.
SPARSE_ON_RELIEF = 0.5
#: Most round numbers between classes of lengths of vectors, before they are halved.
MOST_CLASSES = 16
#: Most isolines between which colours change too.
FEW_LINES = 13


def furnished(case: Case, drawing: Drawing) -> Drawing:
    """Return the drawing of a map with its coasts and its frame; of other data as it is."""
    # What cannot be picked is no data, neither to a reader nor to the meter.
    beside: Keywords = {"scene": even_light(drawing.camera), "pickable": False}
    ink = ink_on(pv.Color(drawing.background or case.wishes.background))
    asked = case.wishes.draws("coasts")
    # Coasts that are asked for are drawn on a small map too.
    least = {"least": 0.0} if asked else {}
    coasts = map_parts.coasts(case.data, **least) if _has_coasts(case, asked=asked) else None
    is_fine = coasts is None and asked is None and _has_coasts(case, asked=None)
    plain = _with_classes(case, drawing)
    drawing = _with_isolines(case, plain, beside, coasts)
    drawn = {"frame": case.frame, "isolines": len(drawing.layers) > len(plain.layers)}
    layers = list(drawing.layers)
    if case.on_globe:
        coasts = None if asked is False else map_parts.shore()
        layers.append(Layer(map_parts.ball(), {**beside, "color": BALL}))
    if coasts is not None:
        lines: Keywords = {"color": ink, "line_width": case.width, "halo": BAND}
        if "width" in drawing.layers[-1].keywords:
            # Below strokes, and unlike them.
            lines |= {"color": UNDER_STROKES, "halo": False}
        layers.insert(1, Layer(coasts, {**beside, **lines}))
    graticule = None if case.frame is None else map_parts.graticule(case.frame)
    if graticule is not None:
        thin = {"line_width": round(case.width / 2, 1), "halo": False, "opacity": 0.5}
        layers.insert(1, Layer(graticule, {**beside, "color": GRATICULE, **thin}))
    if case.frame is not None:
        layers.append(Layer(case.frame, {**beside, "color": ink}))
    drawn["coasts"] = coasts
    lacking = [name for name in map_parts.PARTS if case.wishes.draws(name) and not drawn[name]]
    notes = [f"not drawn on these data: {', '.join(lacking)}"] if lacking else []
    if is_fine and map_parts.coasts(case.data, least=0.0) is not None:
        notes.append(TOO_COARSE)
    return replace(drawing, layers=layers, notes=[*drawing.notes, *notes])


def _with_isolines(case: Case, drawing: Drawing, beside: Keywords, coasts: Step | None) -> Drawing:
    """Return the drawing of a smooth field with isolines, in bands of colours if nothing lights it.

    Other drawings are returned as they are.
    """
    array, cmap = case.array, case.wishes.colors.get("cmap")
    flat = map_parts.flat(case.data) if case.on_globe else case.data
    if array is None or array.of_cells or case.contents.dimension != 2:
        return drawing
    table = drawing.layers[0].keywords.get("cmap")
    # Bands of all values would take back a range that ends where most of them do.
    if isinstance(table, Step) or getattr(table, "log_scale", False):
        return drawing
    asked = case.wishes.draws("isolines")
    if table == "gray" and not asked:  # an image, whose tones are no steps
        return drawing
    if flat is None or not (case.map_frame or case.on_globe) or asked is False:
        return drawing
    is_relief = case.question == "relief" and case.wishes.light.get("lit", True)
    if not is_relief and (case.question != "none" or array.role != "values"):
        return drawing
    frame = case.map_frame
    size = frame.keywords["letters"] if frame else map_parts.degrees(case.wishes)
    assert isinstance(size, float)
    clim = case.wishes.colors.get("clim")
    ends = clim or range_of(case.data.run(), array.name)
    # Lines of a relief are as fine as its ground.
    sparse = {"sparse": SPARSE_ON_RELIEF} if is_relief else {}
    smooth = None if is_relief else map_parts.smoothed(flat, array)
    ground = flat if smooth is None else smooth
    unit, _ = meaning.usual_unit(flat.run(), array.name, max(map(abs, ends)))
    edges: Sequence[float] = ()
    if clim is not None and not is_relief:
        # The same at all steps of a movie, whatever lines fit into each.
        shown = ends[0] / unit, ends[1] / unit
        edges = classes(even_levels(*shown, map_parts.LEVELS[0]), shown)
    contoured = map_parts.isolines(
        ground, array, ends, size, coasts, always=bool(asked), edges=edges, **sparse
    )
    if contoured is None:
        return drawing
    lines, levels, factor = contoured
    inks: Keywords = {"scalars": None, "color": INK_ON_RELIEF if is_relief else INK}
    thin = {"line_width": round(case.width / (2.0 if is_relief else 1.5), 1), "halo": False}
    if not is_relief:
        # Bands of colours show them too: coasts are darker.
        thin["opacity"] = 0.5
    layers = [
        # A line of one point has no light, and no place in the picture.
        Layer(Step("", "[]", lines, name), {**beside, **inks, **keywords}, quiet=True)
        for name, keywords in (("lines", thin), ("numbers", {}), ("extremes", {}))
        if lines.run()[name].n_points
    ]
    first, *others = drawing.layers
    if case.on_globe:
        smooth = Step("smooth", map_parts.GLOBE, ground)
        curves = map_parts.curves(smooth, array, [factor * level for level in levels])
        layers = [Layer(curves, {**beside, **inks, **thin}, quiet=True)]
    if smooth is not None:
        first = replace(first, mesh=smooth)
    keys = [key | {"title": lines_every(key["title"], levels)} for key in drawing.keys]
    if not is_relief and (cmap is None or isinstance(cmap, str)):
        shown = ends[0] / factor, ends[1] / factor
        edges = edges or classes(levels, shown)
        first_end, *inner, last_end = (float(f"{factor * edge:.12g}") for edge in edges)
        if meaning.is_temperature(flat.run(), array.name) and _lacks_values(flat, array.name):
            # The pale middle of other bands is like the grey of land.
            cmap = cmap or ON_WARM_SEA
        table = Step("", BANDS, inner, (first_end, last_end), *filter(None, [cmap]))
        return _in_classes(replace(drawing, keys=keys), [first, *layers, *others], table, edges)
    return replace(drawing, layers=[first, *layers, *others], keys=keys)


def _lacks_values(mesh: Step, name: str) -> bool:
    return not np.isfinite(mesh.run().point_data[name]).all()


def _in_classes(
    drawing: Drawing, layers: Sequence[Layer], table: Step, edges: Sequence[float]
) -> Drawing:
    """Return a drawing of layers, the first of them in classes of colours, as in the keys."""
    first, *others = layers
    # Those that a table replaces.
    kept = {key: value for key, value in first.keywords.items() if key not in ("clim", "nan_color")}
    first = replace(first, keywords={**kept, "cmap": table})
    of_bar: Keywords = {"cmap": table, "levels": edges, "clim": (edges[0], edges[-1])}
    keys = [key | of_bar for key in drawing.keys]
    return replace(drawing, layers=[first, *others], keys=keys)


def _with_classes(case: Case, drawing: Drawing) -> Drawing:
    """Return the drawing of vectors on a map with their lengths in classes of colours."""
    cmap, clim = (drawing.layers[0].keywords.get(name) for name in ("cmap", "clim"))
    is_field = (
        case.map_frame is not None and case.array is not None and case.array.role == "vectors"
    )
    if not is_field or not isinstance(cmap, str) or clim is None:
        return drawing
    low, high = clim
    edges = classes(even_levels(low, high, MOST_CLASSES), (low, high))
    table = Step("", BANDS, edges[1:-1], (edges[0], edges[-1]), cmap)
    return _in_classes(drawing, drawing.layers, table, edges)


def classes(levels: Sequence[float], ends: tuple[float, float]) -> list[float]:
    """Return the values at which the classes of colours between isolines begin and end.

    Levels are in even steps; where they are few, classes end halfway too. The first and the last
    class, as wide as the others, hold the ``ends`` of the values.
    """
    if len(levels) < 2:
        return [ends[0], *levels, ends[1]]
    step = (levels[1] - levels[0]) / (2 if len(levels) <= FEW_LINES else 1)
    first, last = math.floor(ends[0] / step + 1e-9), math.ceil(ends[1] / step - 1e-9)
    return [float(f"{i * step:.12g}") for i in range(first, last + 1)]


def _has_coasts(case: Case, *, asked: bool | None) -> bool:
    """Return whether the data are a flat map of the earth that shows no coast of its own: heights.

    Heights that are 0 at sea show none. Its projection, if it is not in degrees, is known.
    ``asked`` is whether coasts are asked for, on heights too, None where the data choose.
    """
    heights = not asked and case.array is not None and case.array.role == "heights"
    # Those of stations show no coast either.
    heights = heights and not case.has_level_sea and case.contents.dimension > 0
    is_sheet = case.contents.flat_axis == 2 and case.wishes.frame is None
    mesh = case.contents.mesh
    if asked is False or not is_sheet or heights or not georeference.on_earth(mesh):
        return False
    return georeference.has_degrees(mesh) or charts.sheet(mesh) is not None
