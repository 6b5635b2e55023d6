"""Several views in one picture: those that were asked for, and both sides of a cortex."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._words import value_error
from vizlight.draw.margins import written
from vizlight.looks.framing import Views
from vizlight.looks.recipes import lines
from vizlight.looks.recipes.drawing import FACING, Layer
from vizlight.looks.steps import Step, in_order
from vizlight.looks.wishes import BESIDE, CAPTIONS, direction
from vizlight.mesh import georeference, meaning
from vizlight.reading import brains, molecules

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Foreign, Keywords
    from vizlight.looks.recipes.drawing import Case, Drawing
    from vizlight.looks.wishes import Wishes

#: Words of the ends of a left hemisphere that is seen from the left.
ENDS = ("anterior", "posterior")


def arranged(case: Case, drawing: Drawing) -> Drawing:
    """Return a drawing with each of its layers in each view of a case, or the drawing as it is."""
    every = case.wishes.views
    views = next((step for step in in_order([drawing.camera]) if step.path == BESIDE), None)
    if every is None or views is None:
        return drawing
    mesh, *rest = views.arguments
    layers = list[Layer]()
    for layer in drawing.layers:
        if layer.mesh.path in FACING:
            continue
        blocks = views
        if layer.mesh is not mesh:
            around: Keywords = {**views.keywords, "around": mesh}
            blocks = Step("views", BESIDE, layer.mesh, *rest, **around)
        layers += [
            replace(layer, mesh=Step("", "[]", blocks, i))
            for i in every.shown or range(len(every.toward))
        ]
    layers.append(case.inked(case.wishes.names_of(views, drawing.camera)))
    return replace(drawing, layers=layers)


def with_bar(case: Case, drawing: Drawing) -> Drawing:
    """Return a drawing with the bar of lengths for which its camera has room, if it has any."""
    first = drawing.camera.arguments[0] if drawing.camera.arguments else None
    blocks = first.arguments[0] if isinstance(first, Step) and first.arguments else None
    has_bar = isinstance(blocks, list) and getattr(blocks[-1], "path", "") == CAPTIONS
    if not isinstance(blocks, list) or not has_bar or case.wishes.views is not None:
        return drawing
    eye = drawing.camera.run()
    ends = case.ends_of_body(np.negative(eye.direction), eye.up)
    bar = case.wishes.captions(blocks[0], drawing.camera, ends=ends)
    return replace(drawing, layers=[*drawing.layers, case.inked(bar)])


def unit_of_bar(case: Case) -> str:
    """Return the unit of a bar of lengths, empty for flat maps and where no unit is known."""
    mesh = case.data.run()
    if case.contents.flat_axis is not None or case.on_globe or georeference.has_degrees(mesh):
        return ""
    is_chain = molecules.is_polymer(mesh)
    if is_chain or lines.is_molecule(mesh) or molecules.PLACES in mesh.field_data:
        return "Å"
    unit = georeference.unit_of(mesh)
    return meaning.written(unit) if meaning.metres(unit) else ""


def asked(wishes: Wishes) -> Wishes:
    """Return the wishes with the views that were asked for, where these are several."""
    if not are_several(wishes.view):
        return wishes
    every: Foreign = wishes.view
    toward = tuple(direction(view) for view in every)
    names = tuple(view if isinstance(view, str) else f"From {_numbers(view)}" for view in every)
    names = tuple(written(name) for name in names)
    if len({*toward}) < len(toward):
        raise value_error("view", "views that differ", _check.describe(every))
    up = wishes.eye.get("up")
    ups = None if up is None else (up,) * len(toward)
    return replace(wishes, views=Views(toward, names, ups))


def are_several(view: object) -> bool:
    """Return whether a view is a sequence of views, and not one direction."""
    return isinstance(view, list | tuple) and any(
        isinstance(part, str | list | tuple) for part in view
    )


def _numbers(view: Sequence[float]) -> str:
    return f"({', '.join(f'{part:g}' for part in view)})"


def of_case(case: Case) -> Case:
    """Return a case with both sides of a hemisphere of the cortex that has values."""
    array, wishes = case.array, case.wishes
    is_free = all(each is None for each in (wishes.view, wishes.views, wishes.frame))
    has_values = array is not None and array.role in ("values", "heights")
    is_surface = case.contents.dimension == 2 and case.contents.flat_axis is None
    if not (is_free and has_values and is_surface) or case.on_globe:
        return case
    surface = case.surface.run()
    side = brains.hemisphere(surface) if isinstance(surface, pv.PolyData) else ""
    if not side:
        return case
    return replace(case, wishes=replace(wishes, views=of_hemispheres([side])[0]))


def of_pair(meshes: Sequence[pv.DataSet], wishes: Wishes) -> list[Views]:
    """Return the views of the two hemispheres of a cortex, none of other meshes."""
    sides = [brains.hemisphere(mesh) for mesh in meshes]
    is_free = wishes.view is None and wishes.frame is None
    return of_hemispheres(sides) if is_free and sorted(sides) == ["left", "right"] else []


def of_hemispheres(sides: Sequence[str]) -> list[Views]:
    """Return the views of hemispheres of the cortex: the lateral ones, then the medial ones.

    The eye sees the lateral side of a hemisphere on the side of its name.
    """
    left, right = (-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)
    toward, names, ends = list[tuple[float, ...]](), list[str](), list[tuple[str, str]]()
    for word in ("lateral", "medial"):
        for side in sides:
            from_left = (side == "left") == (word == "lateral")
            toward.append(left if from_left else right)
            names.append(f"{side.title()} hemisphere, {word}")
            # Seen from the right, the front is at the right.
            ends.append(ENDS if from_left else (ENDS[1], ENDS[0]))
    up = ((0.0, 0.0, 1.0),) * len(toward)
    every = Views(tuple(toward), tuple(names), up, tuple(ends), "mm", "from both sides")
    count = len(sides)
    return [replace(every, shown=(i, i + count) if count > 1 else None) for i in range(count)]
