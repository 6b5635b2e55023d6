"""Several meshes in one picture: each is drawn by its own rule, and all share the camera."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.looks.recipes.drawing import file_named, range_of, titled
from vizlight.looks.steps import Step
from vizlight.mesh import meaning
from vizlight.scene.presets import preset_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Keywords
    from vizlight.looks.contents import Contents, Named
    from vizlight.looks.recipes.drawing import Case, Drawing
    from vizlight.looks.wishes import Wishes

#: Options of a look that name an array, which not all parts need to have.
_NAMING = ("tangents", "elevation")
#: Share of the points of a mesh inside a surface that make it see-through, the number of points
#: that are looked at, and the drawing of such a surface.
MOSTLY, SAMPLE, CLEAR = 0.5, 500, {"opacity": 0.3, "culling": "back"}


def wishes_of(wishes: Wishes, contents: Contents) -> Wishes:
    """Return the wishes for one part, without arrays that it lacks."""
    has = contents.named
    light: Keywords = {
        name: value
        for name, value in wishes.light.items()
        if name not in _NAMING or not isinstance(value, str) or has(value)
    }
    picture: Keywords = dict(wishes.picture)
    scalars = picture.get("scalars")
    if isinstance(scalars, str) and not has(scalars):
        del picture["scalars"]
    array = wishes.array if wishes.array is None or has(wishes.array) else None
    return replace(wishes, array=array, light=light, picture=picture)


def shared(cases: Sequence[Case]) -> list[Case]:
    """Return the cases with one camera and one range for each array.

    The camera looks as suits the case of the highest dimension, beside which the others stand.
    Arrays to which a reader gave one name are others where their titles differ.
    """
    first = max(cases, key=lambda case: case.contents.dimension)
    whole = Step("whole", "pyvista.MultiBlock", [case.data for case in cases])
    camera = first.wishes.camera(whole, first.eye(first.data))
    ranges: dict[str, list[tuple[float, float]]] = {}
    for case in cases:
        if case.array is not None and case.array.role in ("values", "heights"):
            ends = range_of(case.data.run(), case.array.name)
            ranges.setdefault(_identity(case, case.array), []).append(ends)
    of_cases = []
    for case in cases:
        every = ranges.get(_identity(case, case.array), []) if case.array is not None else []
        picture: Keywords = dict(case.wishes.picture)
        if len(every) > 1:
            picture = {
                "clim": (min(low for low, _ in every), max(high for _, high in every))
            } | picture
        is_beside = case.contents.dimension < first.contents.dimension
        wishes = replace(case.wishes, picture=picture, frame=camera)
        of_cases.append(replace(case, wishes=wishes, is_beside=is_beside))
    return of_cases


def _identity(case: Case, array: Named) -> str:
    """Return the name of an array, or its title where the name is one of readers."""
    name = array.name
    return titled(case.data.run(), name) if meaning.is_of_reader(name) else name


def seen_through(cases: Sequence[Case], drawings: Sequence[Drawing]) -> list[Drawing]:
    """Return drawings in which closed surfaces around other data are see-through."""
    seen = []
    for outer, drawing in zip(cases, drawings, strict=True):
        surface = outer.surface.run() if outer.contents.dimension == 2 else None
        if isinstance(surface, pv.PolyData) and any(
            _is_around(surface, case.data.run()) for case in cases if case is not outer
        ):
            layers = [
                replace(layer, keywords=layer.keywords | CLEAR) if layer.live else layer
                for layer in drawing.layers
            ]
            note = f"{file_named(outer.data) or 'a surface'} is see-through: data lie inside it"
            drawing = replace(drawing, layers=layers, notes=[*drawing.notes, note])
        seen.append(drawing)
    return seen


def _is_around(surface: pv.PolyData, mesh: pv.DataSet) -> bool:
    """Return whether a surface is closed and most points of a mesh are inside it."""
    rows = np.asarray(mesh.points)[:: mesh.n_points // SAMPLE + 1]
    low, high = np.reshape(surface.bounds, (3, 2)).T
    rows = rows[np.all((low < rows) & (rows < high), axis=1)]
    if len(rows) < MOSTLY * min(SAMPLE, mesh.n_points) / 2:
        return False
    # The lids of a cylinder have points of their own.
    closed = surface.clean() if surface.n_open_edges else surface
    if closed.n_open_edges:
        return False
    inside = pv.PolyData(rows).select_interior_points(closed.triangulate())
    return bool(np.mean(inside["selected_points"]) > MOSTLY)


def joined(drawings: Sequence[Drawing]) -> Drawing:
    """Return one drawing of several: all layers, and each key once."""
    lit = Step("lit", "pyvista.MultiBlock", [drawing.lit for drawing in drawings])
    keys: dict[str, Keywords] = {}
    for drawing in drawings:
        for key in drawing.keys:
            scene = key.get("scene")
            question = key.get("question") or (scene and preset_of(scene.run()))
            # Words behind a semicolon are on how the values are drawn.
            title = str(key.get("title")).partition(";")[0] if question == "value" else ""
            keys.setdefault(repr((question, title, key.get("clim"))), key)
    every = [layer for drawing in drawings for layer in drawing.layers]
    # Words around views are those of all meshes.
    words_around = [layer for layer in every if layer.mesh.path == "render.captions"]
    layers = [layer for layer in every if layer not in words_around]
    words = dict.fromkeys(drawing.words for drawing in drawings)
    return replace(
        drawings[0],
        layers=[*layers, *words_around[:1]],
        lit=lit,
        words=f"{len(drawings)} meshes: {', '.join(words)}",
        keys=list(keys.values()),
        notes=list(dict.fromkeys(note for drawing in drawings for note in drawing.notes)),
        kind=lit,
        parts=(),
        background=next((each.background for each in drawings if each.background), None),
    )
