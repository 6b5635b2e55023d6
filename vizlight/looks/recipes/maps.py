"""What is drawn on and around a map, whatever recipe draws its data."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pyvista as pv

from vizlight.draw.legends import ink_on
from vizlight.looks import map_parts
from vizlight.looks.recipes.drawing import Drawing, Layer
from vizlight.looks.wishes import even_light
from vizlight.mesh import georeference

if TYPE_CHECKING:
    from vizlight.looks.recipes.drawing import Case


#: Width of the band beside coasts that sets them apart from dark colours, in widths of the line.
BAND = 0.5


def furnished(case: Case, drawing: Drawing) -> Drawing:
    """Return the drawing of a map with its coasts and its frame; of other data as it is."""
    layers = list(drawing.layers)
    scene = even_light(drawing.camera)
    ink = ink_on(pv.Color(drawing.background or case.wishes.background))
    coasts = map_parts.coasts(case.data) if _has_coasts(case) else None
    if coasts is not None:
        lines = {"color": ink, "line_width": case.width, "halo": BAND}
        layers.append(Layer(coasts, {"scene": scene, **lines}))
    if case.frame is not None:
        layers.append(Layer(case.frame, {"scene": scene, "color": ink}))
    return replace(drawing, layers=layers)


def _has_coasts(case: Case) -> bool:
    """Return whether the data are a flat map in degrees that shows no coast of its own: heights."""
    heights = case.array is not None and case.array.role == "heights"
    is_sheet = case.contents.flat_axis == 2 and case.wishes.frame is None
    mesh = case.contents.mesh
    return (
        is_sheet and not heights and georeference.has_degrees(mesh) and georeference.on_earth(mesh)
    )
