"""Recipes of shadows: heights under a sun, the shadows of a solid, the share of the sky."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.draw.ticks import round_length
from vizlight.looks import map_parts
from vizlight.looks.contents import says_heights
from vizlight.looks.framing import Viewpoint
from vizlight.looks.recipes.drawing import Drawing, Layer, colors_of, times_as_high
from vizlight.looks.steps import Step
from vizlight.mesh import height_grids
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Array, Foreign, Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes.drawing import Case
    from vizlight.scene import Light

#: Eye above a map.
ABOVE = Viewpoint((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), True, "from above, north up")
#: Points above which a relief has no sky, which would take longer than all the rest, and those of a
#: map so wide that each row has metres of its own, which take eight times as long.
MOST_SKY, MOST_WIDE = 250_000, 4_000
#: Factor of the heights of a map with gentle slopes.
GENTLE = 2.0
#: Share of a map that is no steeper than the light, so that half of the rest has its back to it.
LIT = 0.8


def relief(case: Case) -> Drawing:
    """Draw heights in colours, times the light of a sun in the north-west and of the sky."""
    array, data = case.needed_array, case.data
    camera = case.camera(data, ABOVE)
    scene = case.wishes.scene("relief", camera)
    raised, note = _raised(case, array, scene.run().lights)
    keywords: Keywords = {"lit": True, **raised}
    straight = map_parts.before_chart(data)
    if isinstance(straight.run(), pv.StructuredGrid | pv.PolyData) and "raster" not in keywords:
        # Rows and columns that are not at right angles, and faces, are sampled on an even grid.
        keywords["raster"] = 0.0
    most = MOST_SKY if straight is data else MOST_WIDE
    if keywords["lit"] and "occlusion" not in keywords and data.run().n_points <= most:
        keywords["occlusion"] = "sky"
    lit = case.wishes.step("lit", "relief_shadow", straight, scene, **keywords)
    notes = [note] if note else []
    if case.wishes.question == "auto" and not says_heights(data.run(), array.name):
        notes.append(f"{array.name} is taken for heights; question='value' shows its colours alone")
    if case.wishes.make_scene is not None:
        notes += _places_of(scene.run().lights)
    if data.path == map_parts.FLAT:
        notes.append("a terrain by its shape; question='shape' shows the surface as it stands")
    if not keywords["lit"]:
        bent = lit if straight is data else _drawn_as(data, lit)
        return _share(case, bent, camera, scene, f"shadow on {array.name}", "t", notes)
    colors = case.colors_of_heights
    has_holes = not np.isfinite(data.run()[array.name]).all()
    shown = Step("tinted", "vizlight.tint", lit, array.name, **colors)
    drawn: Keywords = {"show_scalar_bar": False}
    # Light in fragments has another grey for what is missing, which is far from that of paper.
    live = straight is data and not has_holes
    if straight is not data:
        shown = _drawn_as(data, shown)
    if not live:
        drawn |= {"scalars": "rgb", "rgb": True, "lighting": False}
    bar = case.bar(array, colors)
    factor: Foreign = keywords.get("exaggeration", 1.0)
    keys = [bar | {"title": bar["title"] + times_as_high(factor)}]
    # The filter has said how many points have no height.
    layer = Layer(shown, drawn, quiet=True, live=live)
    return Drawing(
        [layer], camera, scene, lit, f"relief of {array.name}", keys, notes, kind=straight,
        name="t", colors=colors_of(array, colors),
    )  # fmt: skip


def _drawn_as(data: Step, lit: Step) -> Step:
    """Return the step that bends or lays flat a lit mesh, as another step does the data."""
    return Step(data.name, data.path, lit, *data.arguments[1:], **data.keywords)


def shadow(case: Case) -> Drawing:
    """Draw the shadows that a closed surface casts on itself."""
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.wishes.scene("shadow", camera)
    keywords: Keywords = {"lit": True} | dict(case.wishes.light)
    if "raster" not in keywords:
        keywords = {"feature_angle": "auto"} | keywords
    lit = case.wishes.step("lit", "relief_shadow", mesh, scene, **keywords)
    if keywords["lit"]:
        return Drawing([Layer(lit)], camera, scene, lit, "surface with its shadows", name="t")
    return _share(case, lit, camera, scene, "shadow", "t")


def sky(case: Case) -> Drawing:
    """Draw the share of a uniform sky that each point sees."""
    # The filter takes the only array for heights, whatever its values look like.
    has_heights = case.array is not None or bool(height_grids.heights_name(case.data.run()))
    is_map = has_heights and case.contents.flat_axis == 2
    mesh = case.data if is_map or has_lines_only(case.data.run()) else case.surface
    camera = case.camera(mesh, ABOVE if is_map else None)
    scene = case.wishes.scene("none", camera)
    lit = case.wishes.step("skylit", "sky", mesh, **case.wishes.light)
    name = str(case.wishes.light.get("name", "sky"))
    drawing = _share(case, lit, camera, scene, "share of the sky", name)
    return replace(drawing, kind=mesh)


def _share(
    case: Case, lit: Step, camera: Step, scene: Step, words: str, name: str,
    notes: Sequence[str] = (),
) -> Drawing:  # fmt: skip
    """Return the drawing of a share of light at the points, from black to white."""
    white, notes = 1.0, list(notes)
    if name == "t" and case.contents.flat_axis == 2:
        white = min(1.0, round(3 * _level_light(scene.run().lights), 3))
        if white < 1:
            notes.append(f"white in the picture is t = {white:.2f}, 3 times the t of level ground")
    drawn = {
        "scalars": name, "cmap": "gray", "clim": (0.0, white), "lighting": False,
        "show_scalar_bar": False,
    }  # fmt: skip
    layer = Layer(lit, drawn, live=False)
    # A share that is 1 at most points is white, as paper is.
    return Drawing(
        [layer], camera, scene, lit, words, (), notes, case.data, name=name, background="gray"
    )


def _level_light(lights: Sequence[Light]) -> float:
    """Return the sine of the altitude of the highest light at infinity; 1 without one above."""
    sines = [float(way[2] / np.linalg.norm(way)) for way in _ways(lights)]
    return max((sine for sine in sines if sine > 0), default=1.0)


def _ways(lights: Sequence[Light]) -> list[Array]:
    """Return the directions toward the lights at infinity that do not follow the view."""
    fixed = [light for light in lights if not light.follows_view]
    return [np.asarray(light.direction) for light in fixed if light.direction is not None]


def _places_of(lights: Sequence[Light]) -> list[str]:
    """Return the note on where the lights at infinity stand, none without one."""
    places = [
        f"{np.degrees(np.arctan2(east, north)) % 360:.4g},"
        f"{np.degrees(np.arctan2(up, np.hypot(east, north))):.3g}"
        for east, north, up in _ways(lights)
    ]
    return [f"light from azimuth and altitude {' and '.join(places)} degrees"] if places else []


def _raised(case: Case, array: Named, lights: Sequence[Light]) -> tuple[Keywords, str]:
    """Return the options of a shadow on heights, and the note on their factor.

    A low sun needs less of it: beyond the tangent of its altitude a slope has its back to it.
    """
    keywords: Keywords = {"elevation": array.name} | dict(case.wishes.light)
    mesh = case.data.run()
    factor, note = case.wishes.heightened(mesh, array.name)
    wanted = factor
    if factor >= 1 and case.wishes.part.get("exaggeration") is None:
        sine = _level_light(lights)
        steep = height_grids.steep(mesh, array.name, LIT) * np.sqrt(1 - sine**2)
        most = max(1.0, round_length(sine / steep)) if steep > 0 else factor
        factor = min(most, max(factor, GENTLE))
    times = "as they are" if factor == 1 else f"{factor:g} times"
    if factor < wanted:
        note = (
            f"heights are taken {times}, since much of the map would lie in the shadow of this "
            f"light at {wanted:g} times; exaggeration= sets it"
        )
    elif factor > wanted:
        note = f"heights are taken {times}, since slopes are gentle; exaggeration= sets it"
    return (keywords | {"exaggeration": factor} if factor != 1 else keywords), note
