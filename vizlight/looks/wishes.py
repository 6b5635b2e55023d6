"""Options of a look beside its question, and the steps that they make."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check
from vizlight._words import AXES, value_error
from vizlight.draw.cameras import VIEW_ANGLE
from vizlight.draw.keywords import LIGHT
from vizlight.draw.margins import LETTERS, data_share
from vizlight.draw.render import KEY_SIZE
from vizlight.looks import levels
from vizlight.looks.steps import Step
from vizlight.mesh import georeference, height_grids, meaning, projections, records
from vizlight.scene.material import Material
from vizlight.scene.presets import PRESETS

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from typing import TypeAlias

    import pyvista as pv

    from vizlight._types import Foreign, Keywords, Vector
    from vizlight.looks.contents import Named
    from vizlight.looks.framing import Inset, Strip, Viewpoint, Views

    #: Function that returns the step of a scene, of a question, the steps of a view and a camera,
    #: and the dimension of space.
    SceneMaker: TypeAlias = Callable[[str, Step, Step, int], Step]

#: Backgrounds of the two styles, and the inks on them.
STYLES = {"paper": "white", "dark": "#14161a"}
#: Directions toward the eye that have a name.
VIEWS: dict[str, Vector] = AXES | {
    "iso": (1.0, 1.0, 1.0), "isometric": (1.0, 1.0, 1.0),
    "front": AXES["-y"], "back": AXES["y"], "left": AXES["-x"], "right": AXES["x"],
    "side": AXES["x"], "top": AXES["z"], "above": AXES["z"], "bottom": AXES["-z"],
    "below": AXES["-z"],
}  # fmt: skip
#: Azimuth and altitude of the sun of maps, in degrees: cartographers' north-west.
SUN = (315.0, 30.0)
#: Lamps of a room in the frame of the eye, and the light from all around: each side of a box has
#: another tone, and none is black. Colours are too faint to look like data: cream from above, and
#: fainter blue and brown, by which normals are read better than by grey alone.
ROOM: Sequence[Keywords] = (
    {"direction": (-0.4, 0.85, 0.6), "color": (1.0, 0.985, 0.93), "intensity": 0.6},
    {"direction": (0.8, 0.1, 0.8), "color": (0.8, 0.9, 1.0), "intensity": 0.28},
    {"direction": (-0.6, -0.3, 0.9), "color": (1.0, 0.9, 0.82), "intensity": 0.26},
)
AROUND = 0.35
#: Degrees of longitude from which on a map is one of the whole earth.
GLOBAL = 340.0
#: Height of letters of numbers around a box, in those of keys.
SMALL = 0.85
#: Factor of letters for which a camera has room: it is farther away with them than without.
SPARE = 1.15
#: Function that makes words and a bar of lengths around meshes.
CAPTIONS = "render.captions"
#: Function that puts views beside each other.
BESIDE = "render.several_views"
#: Bounding box that shows where a camera of n-space looks.
BOX = (-1, 1, -1, 1, -1, 1)


def is_whole_earth(mesh: pv.DataSet) -> bool:
    """Return whether a mesh is a map in degrees around the earth, which can be put on a ball."""
    return georeference.has_degrees(mesh) and float(mesh.bounds_size[0]) >= GLOBAL


def plain_scene(question: str, view: Step, camera: Step, _n: int = 3) -> Step:
    """Return the step of the scene of a question, where a user gives none.

    ``"none"`` is even light, in which colours are those of the map; ``"relief"`` the sun of maps,
    ``"shadow"`` a lamp over the left shoulder, ``"lamp"`` one that follows the eye and leaves
    colours much as they are, ``"room"`` three in which a surface looks like one thing.
    """
    if question == "value":
        # Colours of data are read best where a lamp at the eye dims steep places alone, and little.
        lights = [Step("", "vizlight.Light.headlight")]
        material: Keywords = {"ambient": 0.5, "diffuse": 0.5}
    elif question in PRESETS:
        return Step("scene", f"vizlight.presets.{question}", view)
    elif question == "none":
        lights, material = [], {"ambient": 1.0, "diffuse": 0.0}
    elif question == "relief":
        toward = _of_angles(*SUN)
        lights = [Step("", "vizlight.Light", direction=toward)]
        # The light of level ground becomes 1: neighbouring maps are alike, whatever the slopes are.
        plain = Material()
        exposure = round(1 / (plain.ambient + plain.diffuse * toward[2]), 3)
        return Step("scene", "vizlight.Scene", lights=lights, view=view, exposure=exposure)
    elif question == "lamp":
        lights = [Step("", "vizlight.Light", direction=(-0.6, 0.6, 1.0), follows_view=True)]
        material = {"ambient": 0.55, "diffuse": 0.55, "specular": 0.1, "shininess": 20.0}
    elif question == "room":
        lights = [Step("", "vizlight.Light", **lamp, follows_view=True) for lamp in ROOM]
        material = {"ambient": AROUND, "diffuse": 1.0}
    elif question == "shadow":
        # A shadow is cast by one lamp, where the default of a scene has two.
        lights = [Step("", "vizlight.Light", direction=Step("", "render.over_shoulder", camera))]
        return Step("scene", "vizlight.Scene", lights=lights, view=view)
    else:
        return Step("scene", "vizlight.Scene", view=view)
    shown = Step("", "vizlight.Material", **material)
    return Step("scene", "vizlight.Scene", lights=lights, material=shown, view=view)


def even_light(camera: Step) -> Step:
    """Return the step of a scene of ambient light alone, in which colours are as they are."""
    return plain_scene("none", Step("", "vizlight.View.from_camera", camera), camera)


@dataclass(frozen=True)
class Wishes:
    """Options of a look.

    ``question``, ``array`` and ``view`` are as for :func:`vizlight.look`; ``style`` is "paper" or
    "dark". ``part`` has parts of the data: time, overlay, at, nodata, clip, threshold, contour,
    level, slice, warp, exaggeration; ``light`` the options of the filter that lights; ``eye`` those
    of the camera: up, parallel, zoom; ``picture`` those of the picture: background, line_width,
    cmap, clim, scalars, key, map_parts, backend, title; and of a movie: frames, fps. ``surface``:
    the outer surface is taken, not all points; ``refine`` is the largest error between points.
    Several meshes share the ``frame`` of a camera. ``bar`` is the unit of a bar of lengths below
    the data, which stands where nothing else says lengths, and a map is so ``wide`` that its key
    lies below it. ``steps`` are times of a movie, by default all, and ``source`` is the file, and
    options of the command that shows it alike, which a page copies.
    """

    question: str = "auto"
    array: str | None = None
    view: object = None
    size: tuple[int, int] = (1200, 800)
    style: str = "paper"
    part: Mapping[str, Foreign] = field(default_factory=dict)
    light: Mapping[str, Foreign] = field(default_factory=dict)
    eye: Mapping[str, Foreign] = field(default_factory=dict)
    picture: Mapping[str, Foreign] = field(default_factory=dict)
    make_scene: SceneMaker | None = None
    surface: bool = True
    refine: float | None = None
    frame: Step | None = None
    views: Views | None = None
    strip: Strip | None = None
    bar: str = ""
    wide: bool = False
    steps: Sequence[float] = ()
    source: Sequence[str] = ()

    @property
    def background(self) -> str:
        """Colour behind the data."""
        color = self.picture.get("background")
        return STYLES[self.style] if color is None else color

    def draws(self, map_part: str) -> bool | None:
        """Return whether a part of a map was asked for, None where the data choose."""
        asked: Foreign = self.picture.get("map_parts")
        return None if asked is None else map_part in asked

    def scene(self, question: str, camera: Step) -> Step:
        """Return the step that makes the scene of a question, or the one that was given."""
        view = Step("", "vizlight.View.from_camera", camera)
        return (self.make_scene or plain_scene)(question, view, camera, 3)

    def scene_in(self, n: int) -> Step:
        """Return the step that makes a scene of n-space, seen from infinity."""
        toward: Vector = (1.0, 1.0, 1.0)
        fixed: Foreign = self.view
        if hasattr(fixed, "GetPosition"):
            ends = zip(fixed.GetPosition(), fixed.GetFocalPoint(), strict=True)
            toward = tuple(a - b for a, b in ends)
        elif self.view is not None:
            toward = direction(self.view, n=None)
        if len(toward) not in (3, n):
            expected = "three numbers x,y,z" + f" or {n} numbers" * (n != 3)
            raise value_error("view", expected, repr(toward))
        camera = Step("", "render.camera_on", BOX, toward[:3], **_given(up=self.eye.get("up")))
        view = Step("", "vizlight.View", direction=(*toward, *(0.0,) * (n - len(toward))))
        return (self.make_scene or plain_scene)("none given", view, camera, n)

    def camera(
        self,
        mesh: object,
        eye: Viewpoint,
        *,
        axes: Sequence[str] = (),
        key: float | None = KEY_SIZE,
    ) -> Step:
        """Return the step that sets the camera on a mesh, with room for axes and for a key.

        The eye counts where the user gave no view; ``axes`` are names along the edges of its box,
        and ``key`` is the width of the key as a share of the shorter side, 0 for a title alone,
        None for neither.
        """
        up, zoom = self.eye.get("up"), self.eye.get("zoom", 1.0)
        fixed = self.frame or self.fixed_camera()
        if fixed is not None:
            return fixed
        if self.views is not None:
            return self._camera_on_views(mesh, self.views, key)
        keywords: Keywords = {}
        if self.view is None:
            toward, parallel = eye.toward, eye.parallel
            if up is None and not _usual(eye):
                up = eye.up
        else:
            toward, parallel = direction(self.view), False
        if up is not None:
            keywords["up"] = up
        # In perspective a bar holds at one depth alone, and insets would be seen from aside.
        if self.eye.get("parallel", parallel or bool(self.bar) or self.strip is not None):
            keywords["parallel"] = True
        if zoom != 1:
            keywords["zoom"] = zoom
        width, height = self._room(key)
        aspect = round(width / height, 4)
        step = Step("camera", "render.camera_on", mesh, toward, **keywords, aspect=aspect)
        if axes or self.bar:
            words = self.box_axes(mesh, step, axes) if axes else self.captions(mesh, step, SPARE)
            both = Step("", "pyvista.MultiBlock", [mesh, words])
            step = Step("camera", "render.camera_on", both, toward, **keywords, aspect=aspect)
        step.note = eye.words if self.view is None else ""
        return step

    def box_axes(self, box: object, camera: Step, names: Sequence[str]) -> Step:
        """Return the step that makes the numbers along the edges of a box, and names of axes."""
        words: Keywords = {"size": round(SMALL * LETTERS * min(self.size), 1)}
        if list(names) != ["x", "y", "z"]:
            words["names"] = list(names)
        return Step("axes", "render.box_axes", box, camera, round(self.room[1], 1), **words)

    def captions(
        self, mesh: object, camera: Step, spare: float = 1.0, ends: Sequence[str] = ()
    ) -> Step:
        """Return the step that makes the bar of lengths below a mesh, between words for its ends.

        Letters are larger by the factor ``spare``.
        """
        words: Keywords = {"unit": self.bar, "names": ()}
        if ends:
            words["ends"] = [list(ends)]
        return self.words_around(mesh, camera, spare, **words)

    def names_of(self, blocks: Step, camera: Step, spare: float = 1.0) -> Step:
        """Return the step that makes the words and the bar of lengths around several views."""
        views = self.views
        assert views is not None
        words: Keywords = {"unit": views.unit or self.bar}
        if views.ends:
            words["ends"] = [list(pair) for pair in views.ends]
        return self.words_around(blocks, camera, spare, **words)

    def around_insets(self, blocks: Step, camera: Step, insets: Sequence[Inset]) -> Step:
        """Return the step that makes the words around insets."""
        words: Keywords = {"names": [inset.name for inset in insets]}
        if all(inset.ends for inset in insets):
            words["ends"] = [list(inset.ends) for inset in insets]
        return self.words_around(blocks, camera, 1.0, **words)

    def words_around(self, meshes: object, camera: Step, spare: float, **words: object) -> Step:
        """Return the step that makes words around meshes, as :func:`~vizlight.render.captions`."""
        size = round(spare * SMALL * LETTERS * min(self.size), 1)
        height = round(self.room[1], 1)
        return Step("captions", CAPTIONS, meshes, camera, height, size=size, **words)

    def _camera_on_views(self, mesh: object, views: Views, key: float | None) -> Step:
        """Return the step of the camera on views of a mesh, and on the words around them."""
        alone, (width, height) = replace(self, views=None, view=None, bar=""), self.room
        ups = {"up": list(views.up)} if views.up else {}
        blocks = Step(
            "views", BESIDE, mesh, list(views.toward), **ups, names=list(views.names),
            aspect=round(width / height, 4),
        )  # fmt: skip
        words = self.names_of(blocks, alone.camera(blocks, views.eye, key=key), SPARE)
        return alone.camera(Step("", "pyvista.MultiBlock", [blocks, words]), views.eye, key=key)

    @property
    def room(self) -> tuple[float, float]:
        """Width and height of the place for data in the picture, in pixels."""
        return self._room(KEY_SIZE)

    def _room(self, key: float | None) -> tuple[float, float]:
        share = (1.0, 1.0)
        if self.picture.get("key", True) and key is not None:
            share = data_share(self.size, key, lying=self.wide)
        width, height = self.size[0] * share[0], self.size[1] * share[1]
        if self.strip is None:
            return width, height
        main = self.strip.share
        return (width, main * height) if self.strip.is_below else (main * width, height)

    def fixed_camera(self) -> Step | None:
        """Return the step that sets a camera which was given, None where none was."""
        camera: Foreign = self.view
        if not hasattr(camera, "GetPosition"):
            return None
        zoom = _check.number("zoom", self.eye.get("zoom", 1.0), low=1e-6)
        step = Step("camera", "pyvista.Camera")
        position, focus, up = (
            tuple(float(x) for x in getattr(camera, name)())
            for name in ("GetPosition", "GetFocalPoint", "GetViewUp")
        )
        step.attributes = {
            "position": position, "focal_point": focus, "up": self.eye.get("up") or up,
            "view_angle": float(camera.GetViewAngle()) / zoom,
        }  # fmt: skip
        if camera.GetParallelProjection():
            scale = float(camera.GetParallelScale())
            step.attributes |= {"parallel_projection": True, "parallel_scale": scale / zoom}
        elif self.eye.get("parallel"):
            half = math.dist(position, focus) * math.tan(math.radians(VIEW_ANGLE / 2))
            step.attributes |= {"parallel_projection": True, "parallel_scale": half / zoom}
        return step

    def light_of_surface(self) -> Keywords:
        """Return the options of light of a surface with visible creases."""
        return {"feature_angle": "auto"} | dict(self.light)

    def drawn(self, light: Mapping[str, object]) -> Keywords:
        """Return those options of light that a plotter takes."""
        return {name: value for name, value in light.items() if name in LIGHT}

    def lit(self, mesh: Step, scene: Step, light: Mapping[str, object]) -> Step:
        """Return the step that lights the points of a mesh, or refines it until they suffice."""
        if self.refine is not None:
            return self.step("lit", "refine", mesh, scene, **light, error=self.refine)
        # The lit mesh shares the arrays of the one that was read.
        shared = Step("", ".copy", mesh, deep=False)
        return self.step("lit", "illuminate", shared, scene, **light, inplace=True)

    def step(self, name: str, filter_: str, /, *arguments: object, **keywords: object) -> Step:
        """Return the step that runs a filter, with a progress bar where one is asked for."""
        progress = {"progress_bar": True} if self.picture.get("progress") else {}
        return Step(name, f"vizlight.{filter_}", *arguments, **keywords, **progress)

    @property
    def colors(self) -> Keywords:
        """Colour map and limits of an array, where they are given."""
        names = ("cmap", "clim")
        return {name: self.picture[name] for name in names if self.picture.get(name) is not None}

    def joined(self, mesh: Step, array: Named) -> Step:
        """Return the step that joins components to vectors, or the mesh that has them."""
        data = mesh.run()
        if "," not in array.name or array.name in data.array_names:
            planar = array.name in data.array_names and meaning.is_planar(data[array.name])
            return Step("padded", "files.with_vectors", mesh, array.name) if planar else mesh
        return Step("joined", "files.with_vectors", mesh, array.name)

    def isosurface(self, mesh: Step) -> Step:
        """Return the step that takes the isosurface that is asked for.

        Without a level it is the one through the steepest places, if one crosses them.
        """
        names = ("contour", "level")
        keywords = {name: self.part[name] for name in names if self.part.get(name) is not None}
        volume, name, note = mesh.run(), keywords["contour"], ""
        if "level" not in keywords and isinstance(name, str) and name in volume.array_names:
            is_scalar = np.ndim(volume[name]) == 1 and volume[name].dtype.kind in "iuf"
            is_scan = meaning.ways(volume) == (*meaning.ANATOMY.values(),)
            share = levels.THIN if is_scan else 1.0
            level, contrast = (0.0, 0.0)
            if is_scalar:
                level, contrast = levels.best_level(volume, name, share=share)
            if contrast > 0:
                keywords["level"] = level
                note = f"the level of {name} is {levels.number(level)}, where it is steepest"
        step = Step("surface", "files.surface_of", mesh, **keywords)
        step.note = note
        return step

    def globe(self, mesh: Step) -> Step:
        """Return the step that puts a map of the whole earth on a ball."""
        flat = mesh.run()
        if not is_whole_earth(flat):
            wide = float(flat.bounds_size[0]) if georeference.has_degrees(flat) else None
            got = "no map in degrees" if wide is None else f"one of {wide:.4g} degrees"
            expected = f"a map of the whole earth, of at least {GLOBAL:g} degrees of longitude,"
            raise value_error("globe", f"{expected} for a globe", got, "leave out globe")
        heights = self.part.get("warp")
        if heights is None and self.part.get("exaggeration") is not None:
            heights = height_grids.heights_name(flat)
        if heights is None:
            return Step("ball", "vizlight.cartography.globe", mesh)
        factor, note = self.heightened(flat, heights, side=2 * projections.RADIUS)
        keywords = {"heights": heights, "exaggeration": factor}
        ball = Step("ball", "vizlight.cartography.globe", mesh, **keywords)
        ball.note = note
        return ball

    def section(self, mesh: Step) -> Step:
        """Return the step that takes the section by a plane."""
        normal, origin = self.part["slice"]
        step = Step("section", ".slice", mesh, normal=normal, origin=origin)
        step.asked = ("slice", f"{normal}, {origin}")
        return step

    def heightened(
        self, mesh: pv.DataSet, heights: str, *, side: float | None = None
    ) -> tuple[float, str]:
        """Return the factor with which heights can be seen, and the words that say so."""
        explicit = self.part.get("exaggeration")
        if explicit is not None:
            return float(explicit), ""
        if heights not in records.averaged(mesh, heights).point_data:
            return 1.0, ""
        factor = georeference.exaggeration(mesh, heights, side=side)
        words = f"heights are taken {factor:g} times; exaggeration=1 takes them as they are"
        return factor, words if factor != 1 else ""


def direction(view: object, *, n: int | None = 3) -> Vector:
    """Return the direction toward the eye of a view: a name, or n numbers."""
    if isinstance(view, str):
        if view not in VIEWS:
            expected = f"a direction (x, y, z), a camera, or one of {', '.join(map(repr, VIEWS))}"
            raise value_error("view", expected, repr(view))
        return VIEWS[view]
    return _check.vector("view", view, direction=True, n=n)


def _given(**values: object) -> Keywords:
    return {name: value for name, value in values.items() if value is not None}


def _usual(eye: Viewpoint) -> bool:
    """Return whether the direction up is the one that a camera takes by itself."""
    usual = (0.0, 1.0, 0.0) if abs(eye.toward[2]) > 0.999 else (0.0, 0.0, 1.0)
    return np.allclose(eye.up, usual)


def _of_angles(azimuth: float, altitude: float) -> Vector:
    from vizlight.geometry.relief import sun

    return tuple(sun.toward(azimuth, altitude).round(6).tolist())
