"""Recipes of vectors: on a surface, on a sheet, and in a volume."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.looks.recipes.drawing import LIGHTNESS, MISSING, Drawing, Layer, titled, unlit
from vizlight.looks.steps import Step
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from vizlight._types import Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.recipes.drawing import Case

#: Share of the side of a mesh between neighbouring lines, and that of seeds of a volume.
SPACING = 1 / 40
#: Number of streamlines of a volume.
SEEDS = 300


def vectors(case: Case) -> Drawing:
    """Draw vectors on a surface or a sheet: light by their direction, and lines along them."""
    array = case.needed_array
    mesh = case.wishes.joined(case.surface, array)
    camera = case.camera(mesh)
    scene = case.scene(camera)
    if case.contents.flat_axis is not None and case.wishes.question == "auto":
        return _speed(case, mesh, camera)
    light = {"tangents": array.name} | case.wishes.light_of_surface()
    lit = case.lit(mesh, scene, **light)
    other = case.contents.named(str(case.wishes.picture.get("scalars") or ""))
    if other is not None and other.name != array.name:
        # Colours of data take the place of the hues of the light.
        scene = case.wishes.scene("value", camera)
        lit = case.lit(mesh, scene, **light)
        drawn = {"scalars": other.name, "show_scalar_bar": False, **case.wishes.colors}
        layer = Layer(mesh, {"scene": scene, **drawn, **case.wishes.drawn(light)})
        words = f"{other.name} in colours, lit along {array.name}"
        keys = [case.bar(other, case.wishes.colors)]
        return Drawing([layer], camera, scene, lit, words, keys, kind=mesh)
    layers = [Layer(mesh, {"scene": scene, **case.wishes.drawn(light)})]
    lines = _lines_on(mesh, scene, array)
    if lines is not None:
        dark = {"color": "black", "opacity": 0.55, "line_width": case.width, "lighting": False}
        layers.append(Layer(lines, dark, live=False))
    keys = [{"scene": scene, "title": titled(mesh.run(), array.name)}]
    return Drawing(layers, camera, scene, lit, f"direction of {array.name}", keys, kind=mesh)


def _speed(case: Case, mesh: Step, camera: Step) -> Drawing:
    """Draw a sheet in the colours of the lengths of its vectors, with lines along them."""
    array = case.needed_array
    scene = case.wishes.scene("none", camera)
    colors: Keywords = {"cmap": LIGHTNESS, "nan_color": MISSING} | case.wishes.colors
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **colors}
    layers = [Layer(mesh, shown)]
    lines = _lines_on(mesh, case.scene(camera), array)
    if lines is not None:
        white = {"color": "white", "line_width": case.width, "lighting": False}
        layers.append(Layer(lines, white, live=False))
    lengths = np.linalg.norm(np.asarray(mesh.run()[array.name], dtype=np.float64), axis=1)
    finite = lengths[np.isfinite(lengths)]
    title = f"length of {titled(mesh.run(), array.name)}"
    bar: Keywords = {"question": "value", "title": title, "cmap": colors["cmap"], "scene": scene}
    bar["clim"] = colors.get("clim") or (float(finite.min()), float(finite.max()))
    words = f"length of {array.name} in colours, with lines along it"
    return Drawing(layers, camera, scene, case.lit(mesh, scene), words, [bar], kind=mesh)


def flow(case: Case) -> Drawing:
    """Draw streamlines of the vectors in a volume, lit by their heading, in its outline."""
    array = case.needed_array
    mesh = case.wishes.joined(case.data, array)
    if array.of_cells:
        mesh = Step("averaged", ".cell_data_to_point_data", mesh)
    keywords: Keywords = {"vectors": array.name} | dict(case.wishes.light)
    on = mesh
    if "contour" in case.wishes.part:
        on = keywords["surface"] = case.wishes.isosurface(mesh)
    elif "spacing" not in keywords and "seeds" not in keywords:
        keywords["seeds"] = SEEDS
    camera = case.camera(on if keywords.get("confined") else mesh)
    scene = case.scene(camera)
    lit = case.wishes.step("lit", "streamlines", mesh, scene, **keywords)
    # Fewer lines than a number that nobody asked for are no concern of the reader.
    lit.quiet = "seeds" not in case.wishes.light
    lines = Layer(lit, {"scene": scene, "line_width": case.width})
    if "surface" in keywords:
        # The surface that conditions the light of the lines is not drawn with them.
        name = str(keywords.get("name", "luminance"))
        lines = unlit(lit, scene, name, line_width=case.width)
    layers = [
        lines,
        Layer(Step("", ".outline", mesh), {"color": "gray", "line_width": 1}, live=False),
    ]
    words = f"streamlines of {array.name}"
    key = {"scene": scene, "title": titled(mesh.run(), array.name)}
    return Drawing(layers, camera, scene, lit, words, [key])


def _lines_on(mesh: Step, scene: Step, array: Named) -> Step | None:
    """Return the step that lays evenly spaced lines on a surface, None where there is no line."""
    surface = mesh.run()
    if has_lines_only(surface) or not surface.n_cells:
        return None
    spacing = float(f"{surface.length * SPACING:.3g}")
    keywords: Keywords = {"vectors": array.name, "spacing": spacing, "confined": True}
    keywords["feature_angle"] = "auto"
    triangles = Step("triangles", ".triangulate", mesh)
    lines = Step("lines", "vizlight.streamlines", triangles, scene, **keywords)
    try:
        lines.run()
    except ValueError:
        # The light tells the direction by itself where no line can be laid.
        return None
    return lines
