"""How each kind of data is drawn: the steps from a file to what a plotter shows.

A recipe is a function of a :class:`Case` that returns a :class:`Drawing`. Rules name recipes.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import pyvista as pv

from vizlight._words import message, one_of
from vizlight.looks import levels
from vizlight.looks.contents import Contents, kinds_of
from vizlight.looks.framing import Eye, eye_of
from vizlight.looks.steps import Step
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight._types import Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.wishes import Wishes

#: Share of the side of a mesh between neighbouring lines, and that of seeds of a volume.
SPACING = 1 / 40
#: Number of streamlines of a volume.
SEEDS = 300
#: Points above which a relief has no sky, which would take longer than all the rest.
MOST_SKY = 250_000
#: Least width of a line, in pixels, for each pixel of the width of a picture: 1.5 at 300 dpi where
#: the picture is 85 mm wide.
THIN = 1.5 / (85 / 25.4 * 300)


@dataclass(frozen=True)
class Layer:
    """One mesh of the picture.

    Parameters
    ----------
    mesh : Step
        Step that makes the mesh.
    keywords : dict
        Keywords of ``add_mesh``.
    live : bool
        Whether the plotter's component for light adds it, or PyVista itself.
    """

    mesh: Step
    keywords: Keywords = dataclasses.field(default_factory=dict)
    live: bool = True

    def added(self, plotter: Step) -> Step:
        """Return the step that adds the layer to a plotter."""
        way = ".vizlight.add_mesh" if self.live else ".add_mesh"
        return Step("", way, plotter, self.mesh, **self.keywords)


@dataclass(frozen=True)
class Drawing:
    """What a recipe makes of a case.

    Parameters
    ----------
    layers : sequence of Layer
        Meshes of the picture, the main one first.
    camera : Step
        Step that makes the camera.
    scene : Step
        Step that makes the scene.
    lit : Step
        Step that makes the main mesh with its light as point arrays.
    words : str
        What is shown, as the end of "shown ...".
    keys : sequence of dict
        Keywords of ``plotter.vizlight.add_key``, for each key.
    notes : sequence of str
        What a reader should know.
    """

    layers: Sequence[Layer]
    camera: Step
    scene: Step
    lit: Step
    words: str
    keys: Sequence[Keywords] = ()
    notes: Sequence[str] = ()


@dataclass(frozen=True)
class Case:
    """One mesh, what is asked of it, and the question that a rule or a user chose.

    Parameters
    ----------
    data : Step
        Step that reads the mesh.
    contents : Contents
        What it holds.
    wishes : Wishes
        Options that were given.
    question : str
        Question of the light.
    array : Named, optional
        Array that is shown.
    """

    data: Step
    contents: Contents
    wishes: Wishes
    question: str
    array: Named | None = None

    @cached_property
    def surface(self) -> Step:
        """Step that takes the surface of the mesh, or an isosurface or a section of it."""
        part = self.wishes.part
        if part.get("slice") is not None:
            return self.wishes.section(self.data)
        keywords = {name: part[name] for name in ("contour", "level") if part.get(name) is not None}
        if not keywords and (isinstance(self.data.run(), pv.PolyData) or not self.wishes.surface):
            return self.data
        return Step("surface", "files.surface_of", self.data, **keywords)

    def eye(self, mesh: Step) -> Eye:
        """Return from where a mesh is seen."""
        return eye_of(mesh.run(), self.contents)

    def camera(self, mesh: Step, eye: Eye | None = None) -> Step:
        """Return the step that sets the camera on a mesh, by the options or by what suits it."""
        return self.wishes.camera(mesh, self.eye(mesh) if eye is None else eye)

    def scene(self, camera: Step) -> Step:
        """Return the step that makes the scene of the question."""
        return self.wishes.scene(self.question, camera)

    def lit(self, mesh: Step, scene: Step, **light: object) -> Step:
        """Return the step that lights the points of a mesh."""
        return self.wishes.lit(mesh, scene, light)

    @property
    def width(self) -> float:
        """Least width of lines, in pixels."""
        given = self.wishes.picture.get("line_width")
        return float(given) if given else round(max(1.5, THIN * max(self.wishes.size)), 1)


def values(case: Case) -> Drawing:
    """Draw a sheet or a surface in the colours of values, with their bar."""
    array = _array(case)
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.scene(camera)
    keywords = case.wishes.colors
    if array.role == "kinds":
        keywords = _kinds(mesh, array, keywords)
    elif array.role == "colors":
        keywords = {"rgb": True}
    light = case.wishes.light_of_surface()
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **keywords, **light}
    lit = case.lit(mesh, scene, **light)
    keys = [] if array.role == "colors" else [{"question": "value"}]
    return Drawing([Layer(mesh, shown)], camera, scene, lit, f"{array.name} in colours", keys)


def surface(case: Case) -> Drawing:
    """Draw a surface in the light of a question about its shape."""
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = case.wishes.light_of_surface()
    lit = case.lit(mesh, scene, **light)
    level = case.wishes.part.get("contour")
    words = f"isosurface of {level}" if level else "surface"
    drawn = {"scene": scene, "color": "white", **light}
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, [{"scene": scene}])


def relief(case: Case) -> Drawing:
    """Draw heights in colours, times the light of a sun in the north-west and of the sky."""
    array = _array(case)
    data = case.data
    mesh = data.run()
    eye = Eye((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), True, "from above, north up")
    camera = case.camera(data, eye)
    scene = case.wishes.scene("relief", camera)
    keywords: Keywords = {"elevation": array.name, "lit": True} | dict(case.wishes.light)
    if "occlusion" not in keywords and mesh.n_points <= MOST_SKY:
        keywords["occlusion"] = "sky"
    factor, note = case.wishes.heightened(mesh, array.name)
    if factor != 1:
        keywords["exaggeration"] = factor
    lit = Step("lit", "vizlight.relief_shadow", data, scene, **keywords)
    colors = {"cmap": "gist_earth"} | case.wishes.colors
    shown = Step("tinted", "vizlight.tint", lit, array.name, **colors)
    return Drawing(
        [Layer(shown, {"show_scalar_bar": False})], camera, scene, shown,
        f"relief of {array.name}", [{"question": "value"}], [note] if note else [],
    )  # fmt: skip


def vectors(case: Case) -> Drawing:
    """Draw vectors on a surface or a sheet: light by their direction, and lines along them."""
    array = _array(case)
    mesh = case.wishes.joined(case.surface, array)
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = {"tangents": array.name} | case.wishes.light_of_surface()
    lit = case.lit(mesh, scene, **light)
    layers = [Layer(mesh, {"scene": scene, **light})]
    lines = _lines_on(mesh, scene, array)
    if lines is not None:
        dark = {"color": "black", "opacity": 0.55, "line_width": case.width, "lighting": False}
        layers.append(Layer(lines, dark, live=False))
    keys = [{"scene": scene}]
    return Drawing(layers, camera, scene, lit, f"direction of {array.name}", keys)


def flow(case: Case) -> Drawing:
    """Draw streamlines of the vectors in a volume, lit by their heading, in its outline."""
    array = _array(case)
    mesh = case.wishes.joined(case.data, array)
    if array.of_cells:
        mesh = Step("averaged", ".cell_data_to_point_data", mesh)
    camera = case.camera(mesh)
    scene = case.scene(camera)
    keywords: Keywords = {"vectors": array.name, "seeds": SEEDS} | dict(case.wishes.light)
    lit = Step("lit", "vizlight.streamlines", mesh, scene, **keywords)
    layers = [
        Layer(lit, {"scene": scene, "line_width": case.width}),
        Layer(Step("", ".outline", mesh), {"color": "gray", "line_width": 1}, live=False),
    ]
    words = f"streamlines of {array.name}"
    return Drawing(layers, camera, scene, lit, words, [{"scene": scene}])


def isosurface(case: Case) -> Drawing:
    """Draw the isosurface through the steepest places, or three slices where none is good."""
    array = _array(case)
    mesh = case.data.run()
    if case.wishes.part.get("contour") is None:
        level, contrast = levels.best_level(mesh, array.name)
        if contrast < levels.GOOD:
            return slices(case, contrast)
        part = dict(case.wishes.part) | {"contour": array.name, "level": level}
        case = replace(case, wishes=replace(case.wishes, part=part))
    drawing = surface(case)
    value = case.wishes.part.get("level")
    words = drawing.words if value is None else f"{array.name} = {levels.number(value)}"
    box = Layer(Step("", ".outline", case.data), {"color": "gray", "line_width": 1}, live=False)
    return replace(drawing, layers=[*drawing.layers, box], words=f"isosurface {words}")


def slices(case: Case, contrast: float) -> Drawing:
    """Draw three slices through the middle of a volume, in the colours of its values."""
    array = _array(case)
    mesh = Step("slices", ".slice_orthogonal", case.data)
    mesh = Step("joined", ".combine", mesh)
    mesh = Step("slices", ".extract_surface", mesh, algorithm="dataset_surface")
    camera = case.camera(mesh)
    scene = case.wishes.scene("none", camera)
    shown = {
        "scene": scene, "scalars": array.name, "show_scalar_bar": False,
        **case.wishes.colors,
    }  # fmt: skip
    lit = case.lit(mesh, scene)
    words = (
        f"three slices of {array.name}; no isosurface stands out "
        f"(the steepest is {contrast:.1f} times the mean)"
    )
    return Drawing([Layer(mesh, shown)], camera, scene, lit, words, [{"question": "value"}])


def lines(case: Case) -> Drawing:
    """Draw lines, lit by their heading or in the colours of values."""
    mesh = case.data
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = dict(case.wishes.light)
    drawn: Keywords = {"scene": scene, "line_width": case.width, **light}
    keys: list[Keywords] = [{"scene": scene}]
    words = "lines by their heading"
    if case.question == "value":
        array = _array(case)
        drawn |= {"scalars": array.name, "show_scalar_bar": False} | case.wishes.colors
        keys, words = [{"question": "value"}], f"lines in the colours of {array.name}"
    lit = case.lit(mesh, scene, **light)
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, keys)


def points(case: Case) -> Drawing:
    """Draw points as small balls, in the colours of values where there are some."""
    mesh = case.data
    camera = case.camera(mesh)
    scene = case.scene(camera)
    drawn: Keywords = {"render_points_as_spheres": True, "point_size": 6.0}
    keys: list[Keywords] = []
    words = "points"
    if case.array is not None and case.array.role != "vectors":
        drawn |= {"scalars": case.array.name, "show_scalar_bar": False}
        drawn |= case.wishes.colors
        keys, words = [{"question": "value"}], f"points in the colours of {case.array.name}"
    lit = case.lit(mesh, scene)
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, keys)


def _array(case: Case) -> Named:
    if case.array is None:
        known = [array.name for array in case.contents.arrays]
        expected = f"the name of an array, {one_of(known)}"
        raise ValueError(message("array", expected, None))
    return case.array


def _kinds(mesh: Step, array: Named, keywords: Keywords) -> Keywords:
    """Return the keywords that give each kind a colour of its own."""
    kinds = kinds_of(mesh.run(), array.name)
    if "cmap" in keywords:
        return keywords
    table = Step("", "vizlight.maps.kinds", list(kinds))
    return keywords | {"cmap": table}


def _lines_on(mesh: Step, scene: Step, array: Named) -> Step | None:
    """Return the step that lays evenly spaced lines on a surface, None where there is no line."""
    surface = mesh.run()
    if has_lines_only(surface) or not surface.n_cells:
        return None
    spacing = float(f"{surface.length * SPACING:.3g}")
    keywords: Keywords = {"vectors": array.name, "spacing": spacing, "confined": True}
    triangles = Step("triangles", ".triangulate", mesh)
    lines = Step("lines", "vizlight.streamlines", triangles, scene, **keywords)
    try:
        lines.run()
    except ValueError:
        # The light tells the direction by itself where no line can be laid.
        return None
    return lines
