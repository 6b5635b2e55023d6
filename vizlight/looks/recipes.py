"""How each kind of data is drawn: the steps from a file to what a plotter shows.

A recipe is a function of a :class:`Case` that returns a :class:`Drawing`. Rules name recipes.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import pyvista as pv

from vizlight._words import message, one_of
from vizlight.draw.keywords import array_of
from vizlight.files import FORMATS
from vizlight.filters.fur import LENGTH
from vizlight.filters.tint import RGB
from vizlight.looks import levels
from vizlight.looks.contents import Contents, kinds_of
from vizlight.looks.framing import ISOMETRIC, Eye, eye_of
from vizlight.looks.steps import Step
from vizlight.mesh import blocks, meaning
from vizlight.mesh.nspace import POSITION
from vizlight.shading.results import part_name
from vizlight.vtk.polylines import has_lines_only

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.wishes import Wishes
    from vizlight.scene import Light

#: Share of the side of a mesh between neighbouring lines, and that of seeds of a volume.
SPACING = 1 / 40
#: Name that stands for the direction of lines among the arrays that colour a picture.
DIRECTION = "direction"
#: Colour map where nothing is lit, and the colour of what is missing there.
LIGHTNESS, MISSING = "viridis", "#d9d9d9"
#: Eye above a map.
ABOVE = Eye((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), True, "from above, north up")
#: Fewest voxels along each side of a scan.
VOXELS = 30
#: Number of streamlines of a volume.
SEEDS = 300
#: Points above which a relief has no sky, which would take longer than all the rest.
MOST_SKY = 250_000
#: Least width of a line, in pixels, for each pixel of the width of a picture: 1.5 at 300 dpi where
#: the picture is 85 mm wide.
THIN = 1.5 / (85 / 25.4 * 300)


#: Function that draws a case.
Recipe: TypeAlias = "Callable[[Case], Drawing]"


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
    kind : Step, optional
        Step whose mesh is of the type of the lit mesh. Default: the surface of a mesh.
    parts : sequence of str
        Names of the blocks of the lit mesh that are written to files of their own.
    name : str
        Name of the array of light.
    colors : dict
        Array and colour map of the main mesh, as :func:`vizlight.save_gltf` takes them.
    background : str, optional
        Colour behind the data, where neither a white nor a dark one suits them.
    """

    layers: Sequence[Layer]
    camera: Step
    scene: Step
    lit: Step
    words: str
    keys: Sequence[Keywords] = ()
    notes: Sequence[str] = ()
    kind: Step | None = None
    parts: Sequence[str] = ()
    name: str = "luminance"
    colors: Keywords = dataclasses.field(default_factory=dict)
    background: str | None = None

    def suffix(self) -> str:
        """Return the end of the name of a file that holds the lit mesh."""
        if self.kind is None:
            return ".vtp"
        return FORMATS[type(self.kind.run()).__name__][0]


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
        """Step that takes the outer surface of the mesh."""
        if isinstance(self.data.run(), pv.PolyData) or not self.wishes.surface:
            return self.data
        return Step("surface", "files.surface_of", self.data)

    def eye(self, mesh: Step) -> Eye:
        """Return from where a mesh is seen, if no view is given in its place."""
        return ISOMETRIC if self.wishes.view is not None else eye_of(mesh.run(), self.contents)

    def camera(self, mesh: Step, eye: Eye | None = None) -> Step:
        """Return the step that sets the camera on a mesh, by the options or by what suits it."""
        return self.wishes.camera(mesh, self.eye(mesh) if eye is None else eye)

    def scene(self, camera: Step) -> Step:
        """Return the step that makes the scene of the question."""
        return self.wishes.scene(self.question, camera)

    def lit(self, mesh: Step, scene: Step, **light: object) -> Step:
        """Return the step that lights the points of a mesh."""
        return self.wishes.lit(mesh, scene, light)

    def bar(self, array: Named, colors: Keywords) -> Keywords:
        """Return the keywords of the key of an array that is shown in colours."""
        mesh = self.data.run()
        bar: Keywords = {"question": "value", "title": titled(mesh, array.name)}
        if "cmap" in colors:
            bar["cmap"] = colors["cmap"]
        if array.role != "kinds":
            bar["clim"] = colors.get("clim") or _range(mesh, array.name)
        return bar

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
    if case.question == "none":
        # Nothing is lit: the map may run in lightness, which shows more than hues alone.
        keywords = {"cmap": LIGHTNESS, "nan_color": MISSING} | keywords
    if array.role == "kinds":
        mesh = _kept(mesh, array, case)
        keywords = _kinds(mesh, array, case.wishes.colors)
    elif array.role == "colors":
        keywords = {"rgb": True}
    light = case.wishes.light_of_surface()
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **keywords}
    shown |= case.wishes.drawn(light)
    lit = case.lit(mesh, scene, **light)
    keys = [] if array.role == "colors" else [case.bar(array, keywords)]
    return Drawing([Layer(mesh, shown)], camera, scene, lit, f"{array.name} in colours", keys)


def surface(case: Case) -> Drawing:
    """Draw a surface in the light of a question about its shape."""
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = case.wishes.light_of_surface()
    lit = case.lit(mesh, scene, **light)
    name = case.wishes.part.get("contour")
    words = f"isosurface of {name}" if name else "surface"
    drawn = {"scene": scene, "color": "white", **case.wishes.drawn(light)}
    key: Keywords = {"scene": scene}
    if name and case.wishes.part.get("level") is not None:
        key["title"] = f"{name} = {levels.number(case.wishes.part['level'])}"
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, [key], kind=mesh)


def relief(case: Case) -> Drawing:
    """Draw heights in colours, times the light of a sun in the north-west and of the sky."""
    array, data = _array(case), case.data
    camera = case.camera(data, ABOVE)
    scene = case.wishes.scene("relief", camera)
    raised, note = _raised(case, array)
    keywords: Keywords = {"lit": True, **raised}
    if isinstance(data.run(), pv.StructuredGrid) and "raster" not in keywords:
        # Rows and columns that are not at right angles are sampled on an even grid.
        keywords["raster"] = 0.0
    if keywords["lit"] and "occlusion" not in keywords and data.run().n_points <= MOST_SKY:
        keywords["occlusion"] = "sky"
    lit = case.wishes.step("lit", "relief_shadow", data, scene, **keywords)
    notes = [note] if note else []
    if not keywords["lit"]:
        return _share(case, lit, camera, scene, f"shadow on {array.name}", "t", notes)
    colors = {"cmap": "gist_earth"} | case.wishes.colors
    shown = Step("tinted", "vizlight.tint", lit, array.name, **colors)
    keys = [case.bar(array, colors)]
    layer = Layer(shown, {"show_scalar_bar": False})
    return Drawing(
        [layer], camera, scene, lit, f"relief of {array.name}", keys, notes, kind=data, name="t",
        colors=_colors_of(array, colors),
    )  # fmt: skip


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
    is_map = case.array is not None and case.contents.flat_axis == 2
    mesh = case.data if is_map or has_lines_only(case.data.run()) else case.surface
    camera = case.camera(mesh, ABOVE if is_map else None)
    scene = case.wishes.scene("none", camera)
    lit = case.wishes.step("skylit", "sky", mesh, **case.wishes.light)
    name = str(case.wishes.light.get("name", "sky"))
    drawing = _share(case, lit, camera, scene, "share of the sky", name)
    return replace(drawing, kind=mesh)


def fur(case: Case) -> Drawing:
    """Draw a surface covered with fibres."""
    mesh = case.surface
    keywords: Keywords = {"feature_angle": "auto"} | dict(case.wishes.light)
    camera = case.camera(_tips(mesh, keywords.get("length")), case.eye(mesh))
    scene = case.wishes.scene("fur", camera)
    lit = case.wishes.step("furry", "fur", mesh, scene, **keywords)
    return Drawing(
        [Layer(lit)], camera, scene, lit, "surface with fur", parts=("fibres", "skin"),
        name=str(keywords.get("name", "luminance")),
    )  # fmt: skip


def contours(case: Case) -> Drawing:
    """Draw the bands of equal luminance of a surface."""
    mesh = case.surface
    camera = case.camera(mesh)
    scene = case.wishes.scene("contours", camera)
    keywords: Keywords = {"feature_angle": "auto"} | dict(case.wishes.light)
    lit = case.wishes.step("lit", "isoluminance", mesh, scene, **keywords)
    name = str(keywords.get("name", "luminance"))
    bands = _unlit(Step("", "[]", lit, "bands"), scene, name)
    words = "bands of equal luminance"
    return Drawing(
        [bands], camera, scene, lit, words, parts=("bands", "contours"), name=name
    )  # fmt: skip


def projection(case: Case) -> Drawing:
    """Draw a mesh of n-space, projected to 3-space and lit there or before."""
    mesh, light = case.data, dict(case.wishes.light)
    rows = mesh.run().point_data.get(light.get("positions", POSITION))
    # Light after the projection is in the space of the picture.
    n = 3 if light.get("light") == "after" or rows is None or rows.ndim == 1 else rows.shape[1]
    scene = case.wishes.scene_in(n)
    lit = case.wishes.step("projected", "project", mesh, **light, scene=scene)
    camera = case.camera(lit)
    name = str(light.get("name", "luminance"))
    layer = _unlit(lit, scene, name)
    return Drawing([layer], camera, scene, lit, "projection", kind=lit, name=name)


def _unlit(lit: Step, scene: Step, name: str, **drawing: object) -> Layer:
    """Return the layer of a light that was computed at the points, drawn as it is."""
    drawn: Keywords = {"lighting": False, "show_scalar_bar": False, **drawing}
    if scene.run().colored:
        return Layer(lit, {"scalars": part_name(name, "rgb"), "rgb": True, **drawn}, live=False)
    return Layer(lit, {"scalars": name, "cmap": "gray", "clim": (0.0, 1.0), **drawn}, live=False)


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
    fixed = [light for light in lights if not light.follows_view]
    ways = [np.asarray(light.direction) for light in fixed if light.direction is not None]
    sines = [float(way[2] / np.linalg.norm(way)) for way in ways]
    return max((sine for sine in sines if sine > 0), default=1.0)


def _raised(case: Case, array: Named) -> tuple[Keywords, str]:
    """Return the options of a shadow on heights, and what to say of their factor."""
    keywords: Keywords = {"elevation": array.name} | dict(case.wishes.light)
    factor, note = case.wishes.heightened(case.data.run(), array.name)
    return (keywords | {"exaggeration": factor} if factor != 1 else keywords), note


def _tips(mesh: Step, length: object) -> Step:
    """Return the step that moves the points of a surface to where straight fur ends."""
    skin: pv.PolyData = blocks.surface(mesh.run(), "mesh")
    tip = LENGTH * skin.length
    if isinstance(length, str):
        known = length in skin.point_data and skin.n_points
        tip = float(skin.point_data[length].max()) if known else 0.0
    elif isinstance(length, int | float):
        tip = float(length)
    normals = Step("", ".compute_normals", mesh, auto_orient_normals=True, cell_normals=False)
    return Step("tips", ".warp_by_vector", normals, "Normals", factor=tip)


def _colors_of(array: Named, colors: Keywords) -> Keywords:
    """Return the array and the colour map of a mesh, as a glTF file takes them."""
    names = ("cmap", "clim")
    return {"scalars": array.name} | {name: colors[name] for name in names if name in colors}


def vectors(case: Case) -> Drawing:
    """Draw vectors on a surface or a sheet: light by their direction, and lines along them."""
    array = _array(case)
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
    array = _array(case)
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
    array = _array(case)
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
        lines = _unlit(lit, scene, name, line_width=case.width)
    layers = [
        lines,
        Layer(Step("", ".outline", mesh), {"color": "gray", "line_width": 1}, live=False),
    ]
    words = f"streamlines of {array.name}"
    key = {"scene": scene, "title": titled(mesh.run(), array.name)}
    return Drawing(layers, camera, scene, lit, words, [key])


def isosurface(case: Case) -> Drawing:
    """Draw the isosurface through the steepest places, or three slices where none is good."""
    array = _array(case)
    notes = []
    if _is_scan(case, array):
        # The edge of a mask would be a staircase of voxels.
        smooth = Step("smooth", ".gaussian_smooth", case.data, std_dev=1.0, scalars=array.name)
        case = replace(case, data=smooth)
        notes = ["the values are smoothed by one voxel"]
    level, contrast = levels.best_level(case.data.run(), array.name)
    if contrast < levels.GOOD:
        return slices(case, contrast)
    part = dict(case.wishes.part) | {"contour": array.name, "level": level}
    mesh = replace(case.wishes, part=part).isosurface(case.data)
    contents = Contents(mesh.run())
    words = f"isosurface {array.name} = {levels.number(level)}"
    second = contents.first("values", "kinds")
    if second is None or case.wishes.question == "shape":
        wishes = replace(case.wishes, part=part)
        shape = replace(case, data=mesh, contents=contents, question="shape", wishes=wishes)
        drawing = surface(shape)
    else:
        shown = replace(case, data=mesh, contents=contents, question="value", array=second)
        drawing = values(shown)
        words += f" in the colours of {second.name}"
    if notes:
        return replace(drawing, words=words, notes=[*drawing.notes, *notes])
    box = Layer(Step("", ".outline", case.data), {"color": "gray", "line_width": 1}, live=False)
    return replace(drawing, layers=[*drawing.layers, box], words=words)


def _is_scan(case: Case, array: Named) -> bool:
    """Return whether a volume is a scan: one array of an image, of many voxels each way."""
    mesh = case.data.run()
    return (
        isinstance(mesh, pv.ImageData)
        and not array.of_cells
        and len(case.contents.arrays) == 1
        and min(mesh.dimensions) > VOXELS
    )


def slices(case: Case, contrast: float) -> Drawing:
    """Draw three slices through the middle of a volume, in the colours of its values."""
    array = _array(case)
    mesh = Step("slices", ".slice_orthogonal", case.data)
    mesh = Step("joined", ".combine", mesh)
    mesh = Step("slices", ".extract_surface", mesh, algorithm="dataset_surface")
    camera = case.camera(mesh)
    scene = case.wishes.scene("none", camera)
    colors = {"cmap": LIGHTNESS, "nan_color": MISSING} | case.wishes.colors
    shown = {"scene": scene, "scalars": array.name, "show_scalar_bar": False, **colors}
    lit = case.lit(mesh, scene)
    words = (
        f"three slices of {array.name}; no isosurface stands out "
        f"(the steepest is {contrast:.1f} times the mean)"
    )
    return Drawing([Layer(mesh, shown)], camera, scene, lit, words, [case.bar(array, colors)])


def lines(case: Case) -> Drawing:
    """Draw lines, lit by their heading or in the colours of values."""
    mesh = case.data
    camera = case.camera(mesh)
    scene = case.scene(camera)
    light = dict(case.wishes.light)
    drawn: Keywords = {"scene": scene, "line_width": case.width, **case.wishes.drawn(light)}
    keys: list[Keywords] = [{"scene": scene}]
    words = "lines by their heading"
    if case.wishes.picture.get("scalars") == DIRECTION:
        lit = case.lit(mesh, scene, **light)
        shown = _by_direction(lit)
        by_direction = {"scalars": RGB, "rgb": True, "lighting": False, "line_width": case.width}
        layers = [Layer(shown, by_direction, live=False)]
        return Drawing(layers, camera, scene, lit, "lines by their direction", kind=mesh)
    if case.question == "value":
        array = _array(case)
        colors = case.wishes.colors
        if array.role == "kinds":
            colors = _kinds(mesh, array, colors)
        drawn |= {"scalars": array.name, "show_scalar_bar": False, **colors}
        keys = [case.bar(array, colors)]
        words = f"lines in the colours of {array.name}"
    lit = case.lit(mesh, scene, **light)
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, keys, kind=mesh)


def points(case: Case) -> Drawing:
    """Draw points as small balls, in the colours of values where there are some."""
    mesh = case.data
    camera = case.camera(mesh)
    scene = case.scene(camera)
    drawn: Keywords = {"render_points_as_spheres": True, "point_size": 6.0}
    keys: list[Keywords] = []
    words = "points"
    array = case.array
    if array is not None and array.role != "vectors":
        drawn |= {"scalars": array.name, "show_scalar_bar": False}
        words = f"points in the colours of {array.name}"
        if array.role == "colors":
            drawn["rgb"] = True
        else:
            colors = {"cmap": LIGHTNESS} | case.wishes.colors
            if array.role == "kinds":
                colors = _kinds(mesh, array, case.wishes.colors)
            drawn |= colors
            # No light follows these points, so the key is that of the scene and its colours.
            keys = [case.bar(array, colors) | {"scene": scene}]
    lit = case.lit(mesh, scene)
    return Drawing([Layer(mesh, drawn)], camera, scene, lit, words, keys, kind=mesh)


def _by_direction(lit: Step) -> Step:
    """Return the step that colours lines by the size of the components of their direction."""
    rgb = Step("", "numpy.multiply", Step("", "vizlight.direction_colors", lit), 255)
    # The type, bytes, sets colours apart from vectors.
    return Step("shown", "vizlight.tint", lit, Step("", "numpy.uint8", rgb))


def _array(case: Case) -> Named:
    if case.array is None:
        known = [array.name for array in case.contents.arrays]
        expected = f"the name of an array, {one_of(known)}"
        raise ValueError(message("array", expected, None))
    return case.array


def titled(mesh: pv.DataSet, name: str) -> str:
    """Return the name of an array with its unit, where the mesh says it."""
    attributes = meaning.of(mesh).arrays.get(name.partition(",")[0], {})
    unit = attributes.get("units", "")
    title = name if "," in name else attributes.get("long_name") or name
    return f"{title} [{unit}]" if unit not in ("", "1") else title


def _range(mesh: pv.DataSet, name: str) -> tuple[float, float]:
    """Return the ends of the finite values of an array."""
    values = array_of(mesh, name)
    assert values is not None
    finite = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    return float(finite.min()), float(finite.max())


def _kept(mesh: Step, array: Named, case: Case) -> Step:
    """Return the step that leaves out the ground of a volume of kinds, which is 0."""
    if case.contents.dimension < 3 or case.contents.flat_axis is not None or array.low != 0:
        return mesh
    kept = Step("kept", ".threshold", case.data, 0.5, scalars=array.name)
    if not kept.run().n_cells:
        return mesh
    return Step("surface", "files.surface_of", kept)


def _kinds(mesh: Step, array: Named, keywords: Keywords) -> Keywords:
    """Return the keywords that give each kind a colour of its own."""
    kinds = kinds_of(mesh.run(), array.name)
    # Numbers of parts that are no whole numbers have no colours of their own.
    if "cmap" in keywords or any(kind != round(kind) for kind in kinds):
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
    keywords["feature_angle"] = "auto"
    triangles = Step("triangles", ".triangulate", mesh)
    lines = Step("lines", "vizlight.streamlines", triangles, scene, **keywords)
    try:
        lines.run()
    except ValueError:
        # The light tells the direction by itself where no line can be laid.
        return None
    return lines
