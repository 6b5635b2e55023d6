"""What is drawn on and around a map, whatever recipe draws its data."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyvista as pv

from vizlight.draw.isolines import LEVEL
from vizlight.draw.legends import ink_on
from vizlight.looks import map_parts
from vizlight.looks.recipes.drawing import LIGHTNESS, Drawing, Layer, range_of
from vizlight.looks.steps import Step
from vizlight.looks.wishes import even_light
from vizlight.mesh import georeference

if TYPE_CHECKING:
    from vizlight._types import Keywords
    from vizlight.looks.recipes.drawing import Case


#: Width of the band beside coasts that sets them apart from dark colours, in widths of the line.
BAND = 0.5
#: Colour of the ball where a globe has no data, which hides its far side.
BALL = "whitesmoke"
#: Colour of coasts below black strokes: a brown, unlike the blues and greens of the ground.
UNDER_STROKES = "#9a4f1f"


def furnished(case: Case, drawing: Drawing) -> Drawing:
    """Return the drawing of a map with its coasts and its frame; of other data as it is."""
    layers = list(drawing.layers)
    # What cannot be picked is no data, neither to a reader nor to the meter.
    beside: Keywords = {"scene": even_light(drawing.camera), "pickable": False}
    ink = ink_on(pv.Color(drawing.background or case.wishes.background))
    coasts = map_parts.coasts(case.data) if _has_coasts(case) else None
    if case.on_globe:
        coasts = map_parts.shore()
        layers.append(Layer(map_parts.ball(), {**beside, "color": BALL}))
    if coasts is not None:
        lines: Keywords = {"color": ink, "line_width": case.width, "halo": BAND}
        if len(drawing.layers) > 1:
            # Below strokes, and unlike them.
            lines |= {"color": UNDER_STROKES, "halo": False}
        layers.insert(1, Layer(coasts, {**beside, **lines}))
    layers[1:1] = _isolines(case, beside)
    if case.frame is not None:
        layers.append(Layer(case.frame, {**beside, "color": ink}))
    return replace(drawing, layers=layers)


def _isolines(case: Case, beside: Keywords) -> list[Layer]:
    """Return the layers of isolines and of their numbers, of a smooth field that nothing lights."""
    array = case.array
    colors: Keywords = {"cmap": LIGHTNESS} | case.wishes.colors
    is_field = array is not None and array.role == "values" and not array.of_cells
    is_field = is_field and case.question == "none" and case.contents.dimension == 2
    if case.frame is None or array is None or not is_field:
        return []
    size = case.frame.keywords["letters"]
    assert isinstance(size, float)
    ends = colors.get("clim") or range_of(case.data.run(), array.name)
    lines = map_parts.isolines(case.data, array, ends, size)
    if lines is None:
        return []
    inks: Keywords = {"scalars": LEVEL, "clim": ends, "show_scalar_bar": False}
    inks["cmap"] = map_parts.inks(colors["cmap"])
    thin = {"line_width": round(case.width / 1.5, 1), "halo": False}
    parts = [("lines", thin), ("numbers", {})]
    return [
        Layer(Step("", "[]", lines, name), {**beside, **inks, **keywords})
        for name, keywords in parts
        if lines.run()[name].n_points
    ]


def _has_coasts(case: Case) -> bool:
    """Return whether the data are a flat map in degrees that shows no coast of its own: heights."""
    heights = case.array is not None and case.array.role == "heights"
    is_sheet = case.contents.flat_axis == 2 and case.wishes.frame is None
    mesh = case.contents.mesh
    return (
        is_sheet and not heights and georeference.has_degrees(mesh) and georeference.on_earth(mesh)
    )
