"""Input and result of a recipe: one mesh with the wishes for it, and a drawing."""

from __future__ import annotations

import calendar
import dataclasses
import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import pyvista as pv
from matplotlib.colors import to_hex
from pyvista.plotting.colors import get_cmap_safe

from vizlight._words import message, one_of
from vizlight.draw.keywords import array_of
from vizlight.draw.margins import ink_on, parted
from vizlight.draw.render import KEY_SIZE
from vizlight.draw.ticks import numerals_of
from vizlight.looks import levels, map_parts
from vizlight.looks.contents import VELOCITY, Contents, kinds_of
from vizlight.looks.exposure import exposure_seen
from vizlight.looks.framing import ISOMETRIC, MODELS, Viewpoint, eye_around, eye_of
from vizlight.looks.ranges import (
    range_of_scan,
    range_of_turn,
    range_shown,
    share_beyond,
    with_regions,
)  # fmt: skip
from vizlight.looks.steps import DISPLACED, Step
from vizlight.maps import CYCLIC, MISSING
from vizlight.mesh import dates, georeference, globes, meaning
from vizlight.reading import brains, series
from vizlight.shading.results import part_name
from vizlight.writing import FORMATS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Foreign, Keywords
    from vizlight.looks.contents import Named
    from vizlight.looks.ranges import Range
    from vizlight.looks.wishes import Wishes

#: Colour map where nothing is lit, and that of values on lit surfaces.
LIGHTNESS, ON_SURFACES = "viridis", "vizlight.surface"
#: Least share of heights that are 0 where they are those of a sea.
LEVEL_SEA = 0.1
#: Colour maps of bands, and of amounts on a ground, and the colour of this.
ON_BANDS, ON_GROUND, GROUND = "vizlight.bands", "vizlight.amounts", "#fbfbf8"
#: Those of values around 0 in place of these; on lit surfaces one without dark ends, by Moreland,
#: Diverging color maps for scientific visualization (2009).
AROUND_ZERO = {LIGHTNESS: ON_BANDS, ON_SURFACES: "coolwarm"}
#: Those of temperatures in place of these and of maps for thin lines.
OF_HEAT = {LIGHTNESS: "vizlight.heat", ON_SURFACES: "vizlight.heat"} | {
    f"vizlight.on_{ground}": f"vizlight.heat_on_{ground}" for ground in ("paper", "dark")
}
#: That of rain on a radar, its steps in decibels, and the percentage of places within it.
RAIN, DECIBELS, RAINY = "vizlight.rain", 5.0, 99.9
#: Colour of missing values where 0 is light grey.
DARK_MISSING = "#7a7a7a"
#: Light of a room at the place that is as bright as white paper in other light: a surface without
#: data stands out from paper.
IN_ROOM = 0.75
#: Least width of a line, in pixels, for each pixel of the width of a picture: 1.5 at 300 dpi where
#: the picture is 85 mm wide.
THIN = 1.5 / (85 / 25.4 * 300)

#: Most kinds that have a key: more of them share colours.
MOST_IN_KEY = 16
#: Colour of a value that is the only one.
ONLY = "#5c6d9f"
#: Colour of the borders of surfaces, and keywords of what stands beside the data.
DARK, BESIDE = "#333333", {"pickable": False}
#: Most letters of a short form, such as SST, which stays in capitals.
LONGEST_SHORT = 3
#: Fewest and most days between steps that are months.
MONTH = (27.5, 31.5)
#: Most hours between steps of which a date says the hour.
MOST_HOURS = 47.0
#: Keywords of the edges of a box, and of what it cuts.
BOX_EDGES: Keywords = {"color": "gray", "line_width": 1}
#: Function that makes classes of colours.
BANDS = "vizlight.maps.bands"
#: Distance from a side of its box, as a share of the size of a surface, at which a point is on it,
#: and share of the points of borders that are on sides where a box cuts a surface.
ON_BOX, CUT = 1e-3, 0.95

#: Functions that make letters that face the eye of the picture.
FACING = ("render.box_axes", "render.captions")
#: Name of the step of a place beside which such letters stand.
PLACE = "place"
#: Least cosine between an axis and a side of the picture along which it runs.
ALONG = 0.99

#: Methods of CF over the time of a step.
OVER_TIME = re.compile(r"\btime: (mean|maximum|minimum|median|sum|variance)\b(?! within)")
#: Names of displacements, in lower case, which are alike over a part of a solid at most.
DISPLACEMENT = re.compile(
    r"(.*[^a-z])?[xyz]?(d(e?pl|i?spl?|isplacements?)|deformation)[xyz]?(,.*)?"
)
#: Start of dates that are no dates, and words of means of many years, whose steps are of no year.
NO_DATE = ("0000-", "0001-")
OF_MANY_YEARS = re.compile(r"long[ -]?term mean|climatolog")
#: First day of times of no year, and days of a year.
NO_YEAR, YEAR = re.compile("0{1,4}[01]?-0?1-0?1"), 365.25
#: Width over height of a map from which a key takes less room below it, in that of the picture.
WIDE = 1.08
#: Questions whose pictures of maps have north up, whatever their shape is.
NORTH_UP = ("relief", "sky")

#: Function that draws a case.
Recipe: TypeAlias = "Callable[[Case], Drawing]"


@dataclass(frozen=True)
class Layer:
    """One mesh of the picture.

    ``keywords`` are those of ``add_mesh``. With ``live`` the plotter's component for light adds it,
    not PyVista itself; of a ``quiet`` one points that cannot be lit are reported elsewhere.
    """

    mesh: Step
    keywords: Keywords = dataclasses.field(default_factory=dict)
    live: bool = True
    quiet: bool = False

    def added(self, plotter: Step) -> Step:
        """Return the step that adds the layer to a plotter."""
        way = ".vizlight.add_mesh" if self.live else ".add_mesh"
        step = Step("", way, plotter, self.mesh, **self.keywords)
        step.quiet = self.quiet
        return step


@dataclass(frozen=True)
class Doubt:
    """Questions that a picture must answer before it is chosen.

    The picture must have the ``figures`` of legibility; ``instead`` makes another drawing where one
    of them is unreadable.
    """

    figures: Sequence[str]
    instead: Callable[[], Drawing]


@dataclass(frozen=True)
class Drawing:
    """Drawing that a recipe makes of a case.

    The main one of the ``layers`` is the first; ``lit`` makes it with its light as point arrays of
    the ``name``. ``words`` are the subject, as the end of "shown ...", ``keys`` the keywords of
    ``plotter.vizlight.add_key`` for each key, and ``notes`` are for a reader. ``kind`` has a mesh
    of the type of the lit mesh, by default the surface of a mesh; ``parts`` are the names of the
    blocks of the lit mesh that are written to files of their own, and ``alone`` is the lit mesh for
    files that hold one mesh. ``colors`` are array and colour map of the main mesh, as
    :func:`vizlight.save_gltf` takes them, and ``background`` is for data that neither a white nor a
    dark one suits. ``doubt`` has questions that the picture may fail to answer, ``insets`` are of
    smaller views beside the main one, which pages and movies leave out, and ``picture_camera`` is
    the camera of a picture with them.
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
    alone: Step | None = None
    name: str = "luminance"
    colors: Keywords = dataclasses.field(default_factory=dict)
    background: str | None = None
    doubt: Doubt | None = None
    insets: Sequence[Layer] = ()
    picture_camera: Step | None = None

    @property
    def is_flat(self) -> bool:
        """Whether all that is drawn is a flat map, or another flat sheet seen face on."""
        return Contents(self.layers[0].mesh.run()).flat_axis is not None

    @property
    def of_turns(self) -> Drawing:
        """Drawing that is turned: with whole boxes, one side, and no words that face one eye."""
        kept, camera = list[Layer](), self.camera
        for layer in self.layers:
            step = layer.mesh
            first = step.arguments[0] if step.arguments else None
            if step.path == "render.box_edges" and isinstance(first, Step):
                layer = dataclasses.replace(layer, mesh=first)
            if isinstance(first, Step) and first.path == "render.several_views":
                if step.arguments[1:] != (0,):
                    continue
                surface, eyes = first.arguments
                assert isinstance(surface, Step)
                assert isinstance(eyes, list | tuple)
                toward = eyes[0]
                framed = first.keywords.get("around", surface)
                camera = Step("camera", camera.path, framed, toward, **camera.keywords)
                layer = dataclasses.replace(layer, mesh=surface)
            if step.path not in FACING and step.name != PLACE:
                kept.append(layer)
        return dataclasses.replace(self, layers=kept, camera=camera, insets=(), picture_camera=None)

    @property
    def turning(self) -> Drawing:
        """Drawing of a turn, which stays in the picture all around."""
        drawing = self.of_turns
        camera = drawing.camera
        if camera.path == "render.camera_on":
            keywords = {**camera.keywords, "turning": True}
            camera = Step(camera.name, camera.path, *camera.arguments, **keywords)
        return dataclasses.replace(drawing, camera=camera)

    def suffix(self) -> str:
        """Return the end of the name of a file that holds the lit mesh."""
        if self.kind is None:
            return ".vtp"
        return FORMATS[type(self.kind.run()).__name__][0]


@dataclass(frozen=True)
class Case:
    """One mesh, the wishes for it, and the question that a rule or a user chose.

    ``question`` is that of the light, ``viewpoint`` a better place to see it from than that of any
    mesh, ``is_beside`` says that a mesh of a higher dimension is in the picture, and ``eyes`` are
    those that were chosen, by the steps of the meshes that they see and the arrays shown.
    """

    data: Step
    contents: Contents
    wishes: Wishes
    question: str
    array: Named | None = None
    viewpoint: Viewpoint | None = None
    is_beside: bool = False
    eyes: dict[tuple[Step, str | None], Viewpoint] = dataclasses.field(default_factory=dict)

    @cached_property
    def surface(self) -> Step:
        """Step that takes the outer surface of the mesh."""
        if isinstance(self.data.run(), pv.PolyData) or not self.wishes.surface:
            return self.data
        return self.data.then("surface", "files.surface_of")

    @property
    def is_isosurface(self) -> bool:
        """Whether the mesh is an isosurface of a volume."""
        return self.wishes.part.get("contour") is not None

    @cached_property
    def borders(self) -> Step | None:
        """Step that takes the borders of an open surface that bends, None where it has none."""
        surface = self.surface.run()
        if self.contents.dimension != 2 or self.contents.flat_axis is not None or self.on_globe:
            return None
        if not isinstance(surface, pv.PolyData):
            return None
        edges = self.surface.then("borders", "files.borders")
        return edges if edges.run().n_cells else None

    @cached_property
    def creases(self) -> Step | None:
        """Step that takes the creases of a surface, None where it has none that are meant.

        Those of an isosurface come of noise, or of the size of its cells, and those of a flat mesh
        of cells that lie over others, as at the seam of a grid of an ocean.
        """
        is_sheet = self.contents.dimension == 2 and self.contents.flat_axis is not None
        if self.is_isosurface or is_sheet or not isinstance(self.surface.run(), pv.PolyData):
            return None
        edges = self.surface.then("creases", "files.creases")
        return edges if edges.run().n_cells else None

    @cached_property
    def box(self) -> Step | None:
        """Step that makes the box that cuts the surface, None where none does."""
        edges = self.borders
        if edges is None or not _is_cut_by_box(self.surface.run(), edges.run()):
            return None
        return Step("", ".outline", self.surface)

    def edges(self, camera: Step) -> list[Layer]:
        """Return the layers of the borders and creases of the surface, and of its box."""
        # Borders of an isosurface are where the box of the volume cuts it, no part of its shape.
        drawn = BOX_EDGES if self.is_isosurface else {}
        layers = self.strokes([self.borders, self.creases], **drawn)
        return layers if self.box is None else [*layers, *self.boxed(self.box, camera)]

    def strokes(self, lines: Sequence[Step | None], **drawn: object) -> list[Layer]:
        """Return the layers of dark lines; None stands for no lines."""
        ink: Keywords = {"color": DARK, "line_width": self.width, "lighting": False, **BESIDE}
        return [Layer(step, ink | drawn, live=False) for step in lines if step is not None]

    def boxed(self, box: Step, camera: Step) -> list[Layer]:
        """Return the layers of a box and of the numbers along its edges.

        The camera is set by :meth:`camera` on the data in the box.
        """
        edges = Step("", "render.box_edges", box, camera)
        layers = [Layer(edges, BOX_EDGES | BESIDE, live=False)]
        if self.wishes.frame is None and self.wishes.views is None:
            layers.append(self.inked(self.wishes.box_axes(box, camera, self.axes)))
        return layers

    def inked(self, mesh: Step) -> Layer:
        """Return the layer of a mesh in the colour of ink, such as letters."""
        ink: Keywords = {"color": ink_on(pv.Color(self.wishes.background)), "lighting": False}
        return Layer(mesh, ink | BESIDE, live=False)

    def eye(self, mesh: Step) -> Viewpoint:
        """Return from where a mesh is seen, if no view is given in its place."""
        if self.wishes.view is not None or self.wishes.frame is not None:
            return ISOMETRIC
        if self.wishes.views is not None:
            return self.wishes.views.eye
        if self.viewpoint is not None:
            return self.viewpoint
        if self.box is not None:
            return eye_around(self.surface.run(), cut=True)
        array = self.array
        shown = None if array is None or array.role == "colors" else array.name
        if (mesh, shown) not in self.eyes:
            is_model = not MODELS.isdisjoint(map(str.lower, path_of(self.data).suffixes))
            eye = eye_of(mesh.run(), self.contents, shown, is_model=is_model)
            self.eyes[mesh, shown] = eye
        return self.eyes[mesh, shown]

    @cached_property
    def map_frame(self) -> Step | None:
        """Step that makes the frame of a map, None for other data and for a map seen at a slant."""
        is_map = self._is_above and not self.is_of_body
        return map_parts.frame(self.data, self.wishes, self._up) if is_map else None

    def place_of_cut(self, camera: Step) -> str:
        """Return words for the plane that cuts the mesh, and for the axes that lie in it.

        They are empty where none does, for a plane that is across no axis, and on a map, whose
        frame tells them. Letters of axes of a body are those of their ends: right, front, up.
        """
        plane, mesh = self.wishes.part.get("slice"), self.data.run()
        if plane is None or meaning.of(mesh).scales or georeference.has_degrees(mesh):
            return ""
        normal, origin = (np.asarray(row, dtype=np.float64) for row in plane)
        across, *others = np.flatnonzero(normal)
        if others:
            return ""
        unit, eye = meaning.written(georeference.unit_of(mesh)), camera.run()
        place = f"{'xyz'[across]} = {levels.number(origin[across])} {unit}".rstrip()
        right = np.cross(eye.direction, eye.up)
        letters = "RAS" if self.is_of_body else "xyz"
        words = [
            f"{letters[axis]} {more if way[axis] > 0 else less}"
            for way, more, less in ((right, "to the right", "to the left"), (eye.up, "up", "down"))
            for axis in np.flatnonzero(np.abs(way) > ALONG)
        ]
        return ", ".join([place, *words])

    def ends_of_body(self, toward: Sequence[float] | Array, up: Sequence[float]) -> Sequence[str]:
        """Return the letters of the sides of a body at the left and the right of a view.

        They are L, R, P, A, I and S; none where no axis runs across the picture, and of
        other data.
        """
        right = np.cross(up, toward)
        across = np.flatnonzero(np.abs(right) > ALONG)
        if not self.is_of_body or not len(across):
            return ()
        ends = ("LR", "PA", "IS")[across[0]]
        return ends if right[across[0]] > 0 else ends[::-1]

    @property
    def is_of_body(self) -> bool:
        """Whether a file says that axes are those of a body."""
        return meaning.ways(self.data.run()) == (*meaning.ANATOMY.values(),)

    @property
    def frame(self) -> Step | None:
        """Step of the frame that is drawn: that of the map, unless it is left out."""
        return None if self.wishes.draws("frame") is False else self.map_frame

    @property
    def _is_above(self) -> bool:
        """Whether a map fills the picture from above."""
        wishes = self.wishes
        return self.contents.flat_axis == 2 and wishes.view is None and wishes.frame is None

    @property
    def _up(self) -> tuple[float, float]:
        """Direction on a map, east and north, that points up in the picture."""
        x, y = (0.0, 1.0) if self.question in NORTH_UP else self.eye(self.data).up[:2]
        return x, y

    @property
    def is_wide(self) -> bool:
        """Whether it is a map so wide, or two sides, that are larger with their key below them."""
        wide, tall = self.wishes.size
        if not self.wishes.picture.get("key", True) or wide < tall:
            return False
        if self.wishes.views is not None:
            return True
        if not self._is_above:
            return False
        x, y, _ = self.data.run().bounds_size
        right, up = np.abs(self._up)[::-1], np.abs(self._up)
        return bool(right @ (x, y) > WIDE * wide / tall * (up @ (x, y)))

    @property
    def is_of_earth(self) -> bool:
        """Whether the mesh is a map of places on the earth that are known, or such a ball."""
        mesh = self.data.run()
        is_placed = not {"crs", georeference.PROJECTION}.isdisjoint(mesh.field_data.keys())
        return self.on_globe or is_placed or georeference.has_degrees(mesh)

    @property
    def colors_of_heights(self) -> Keywords:
        """Colours of a ground, where no others are asked for."""
        colors, name = self.wishes.colors, self.needed_array.name
        if "cmap" in colors:
            return colors
        ends = colors.get("clim") or range_of(self.data.run(), name)
        level: Keywords = {"level_sea": True} if self.has_level_sea else {}
        return {"cmap": Step("", "vizlight.maps.heights", *ends, **level)}

    @cached_property
    def has_level_sea(self) -> bool:
        """Whether heights on the earth are 0 at sea, which has no depths."""
        array = self.array
        if array is None or array.role != "heights" or not self.is_of_earth:
            return False
        values = array_of(self.data.run(), array.name)
        return values is not None and float(np.mean(values == 0)) > LEVEL_SEA

    @cached_property
    def on_globe(self) -> bool:
        """Whether the mesh lies on the earth as a ball, and is alone in the picture."""
        return self.wishes.frame is None and globes.is_globe(self.contents.mesh)

    def camera(self, mesh: Step, eye: Viewpoint | None = None, *, boxed: bool = False) -> Step:
        """Return the step that sets the camera on a mesh, by the options or as suits it.

        ``boxed`` is for a box with numbers along its edges.
        """
        eye = self.eye(mesh) if eye is None else eye
        if self.frame is not None:
            # There is room for what stands around the map.
            mesh, boxed = Step("", "pyvista.MultiBlock", [mesh, self.frame]), False
        elif self.on_globe:
            # The ball is seen whole, wherever there are data.
            mesh = map_parts.ball()
        elif self.box is not None:
            mesh, boxed = self.box, True
        axes = self.axes if boxed else ()
        key: float | None = KEY_SIZE
        if self.in_room:
            # A room needs no key.
            key = 0.0
        elif self.question == "none" and self.array is None:
            # Nor does a plane without data, which may have a title.
            names = file_named(self.data), self.wishes.picture.get("title")
            key = 0.0 if any([*names, *self.contents.constants]) else None
        return self.wishes.camera(mesh, eye, axes=axes, key=key)

    @cached_property
    def axes(self) -> Sequence[str]:
        """Names of the axes, with their unit where it is one of lengths."""
        unit = georeference.unit_of(self.data.run())
        words = f" ({meaning.written(unit)})" if meaning.metres(unit) else ""
        return [f"{letter}{words}" for letter in "xyz"]

    def scene(self, camera: Step) -> Step:
        """Return the step that makes the scene of the question."""
        return self.wishes.scene(self._light, camera)

    @property
    def in_room(self) -> bool:
        """Whether the lamps are those of a room: where nobody asks for the shape that is shown.

        To an eye that is not told so, hues that tell normals look like data.
        """
        wishes = self.wishes
        return self.question == "shape" and wishes.question == "auto" and wishes.make_scene is None

    @property
    def _light(self) -> str:
        """The question of the light."""
        return "room" if self.in_room else self.question

    def exposed(self, mesh: Step, camera: Step, question: str = "", **light: object) -> Step:
        """Return the step that makes the scene of a question, exposed for the seen part of a mesh.

        A scene that was given is not exposed.
        """
        scene = self.wishes.scene(question or self._light, camera)
        if self.wishes.make_scene is not None:
            return scene
        exposure = exposure_seen(mesh.run(), scene.run(), camera.run(), light)
        exposure = round(IN_ROOM * exposure, 3) if self.in_room else exposure
        return scene if exposure == 1 else Step("scene", ".replace", scene, exposure=exposure)

    @property
    def map_on_ground(self) -> str:
        """Colour map of thin lines, on which large values stand out from the ground."""
        return f"vizlight.on_{self.wishes.style}"

    def ranged(
        self,
        values: Array,
        name: str,
        cmap: str,
        *,
        unit: float = 1.0,
        scan: bool = False,
        beyond: Callable[[Range], float] | None = None,
        **kind: bool,
    ) -> tuple[Keywords, str]:
        """Return the colours of values in the range that suits them, and words if it is not all.

        Values that are finite count; ``cmap`` is for users who name none, ``unit`` is that in which
        values are read, in that of theirs, and ``scan`` is for those of a scan in grey. ``beyond``
        returns the share of regions of the mesh that lie beyond the ends of a range, and ``kind``
        is as for :func:`vizlight.looks.ranges.range_shown`.
        """
        values = values[np.isfinite(values)] / unit
        # Points in the pale colour of 0 would not be seen on paper.
        is_plain = cmap in AROUND_ZERO and self.contents.dimension > 0
        limits: Foreign = self.wishes.colors.get("clim")
        if limits is not None or not values.size:
            is_even = limits is not None and limits[0] == -limits[1]
            cmap = AROUND_ZERO[cmap] if is_even and is_plain else cmap
            return {"cmap": cmap, "nan_color": MISSING} | self.wishes.colors, ""
        kind["decades"] = meaning.is_in_decades(self.data.run(), name)
        shown = range_of_scan(values) if scan else range_shown(values, **kind)
        if beyond is not None and not scan:
            shown = with_regions(shown, values, beyond)
        turn = range_of_turn(values) if meaning.is_direction(self.data.run(), name) else None
        if turn is not None:
            shown, cmap = turn, CYCLIC
        elif meaning.is_reflectivity(self.data.run(), name) and is_plain:
            return colors_of_rain(values) | self.wishes.colors, ""
        elif shown.is_signed and is_plain:
            shown, cmap = shown.around_zero(values), AROUND_ZERO[cmap]
        elif meaning.is_temperature(self.data.run(), name):
            cmap = OF_HEAT.get(cmap, cmap)
        missing = DARK_MISSING if cmap == AROUND_ZERO[ON_SURFACES] else MISSING
        colors = {"cmap": ON_GROUND if shown.ground else cmap, "nan_color": missing}
        colors |= self.wishes.colors
        return colors | colors_in(shown, colors["cmap"], unit), shown.words(name)

    def ranged_of(self, mesh: Step, array: Named, cmap: str, **kind: bool) -> tuple[Keywords, str]:
        """Return the colours of an array as :meth:`ranged` does, in the unit in which it is read.

        Only an array of values has a range of its own.
        """
        if array.role != "values":
            return {"cmap": cmap, "nan_color": MISSING} | self.wishes.colors, ""
        rows = np.asarray(mesh.run()[array.name], dtype=np.float64)
        unit, _ = meaning.usual_unit(mesh.run(), array.name, float(np.nanmax(np.abs(rows))))

        def beyond(shown: Range) -> float:
            outside = (rows < shown.low * unit) | (rows > shown.high * unit)
            return share_beyond(mesh.run(), outside, of_cells=array.of_cells)

        return self.ranged(rows, array.name, cmap, unit=unit, beyond=beyond, **kind)

    def lit(self, mesh: Step, scene: Step, **light: object) -> Step:
        """Return the step that lights the points of a mesh."""
        return self.wishes.lit(mesh, scene, light)

    def bar(self, array: Named, colors: Keywords) -> Keywords:
        """Return the keywords of the key of an array that is shown in colours."""
        mesh, table = self.data.run(), colors.get("cmap")
        bar: Keywords = {"question": "value", "title": titled(mesh, array.name)}
        if "cmap" in colors:
            bar["cmap"] = colors["cmap"]
        if array.role != "kinds":
            low, high = colors.get("clim") or range_of(mesh, array.name)
            bar["clim"] = (low, high)
            factor, unit = meaning.usual_unit(mesh, array.name, max(abs(low), abs(high)))
            bar["clim"] = _in_unit((low, high), 1 / factor)
            if factor != 1:
                bar["title"] = f"{bar['title'].rpartition(' (')[0]} ({unit})"
            if isinstance(table, Step) and table.path == BANDS:
                arguments: tuple[Foreign, ...] = table.arguments
                inner, (first, last) = arguments[:2]
                bar["levels"] = _in_unit([first, *inner, last], 1 / factor)
        # A region of one value below all others, such as thickness 0, is where there is no cortex.
        has_grey = isinstance(table, Step) and table.keywords.get("below_range_color") == MISSING
        if has_grey and brains.hemisphere(mesh):
            bar["title"] += "; grey: medial wall"
        return bar | {"title": bar["title"] + self._exaggeration}

    @property
    def _exaggeration(self) -> str:
        """Words in a title that say by how much points are moved, if they are."""
        step = self.moved
        if step is None:
            return ""
        factor = float(step.arguments[2])  # type: ignore[arg-type]
        if step.name == DISPLACED:
            return f"; displaced{', true to scale' if factor == 1 else f' {factor:g} times'}"
        return times_as_high(factor)

    @property
    def moved(self) -> Step | None:
        """Step that moves the points of the mesh, None where they are as they were read."""
        steps = (step for step in self.data.chain() if isinstance(step, Step))
        return next((step for step in steps if step.path == "files.warped"), None)

    @property
    def second(self) -> Named | None:
        """Array that only colours what is drawn of the other one, None for the usual colours."""
        array = self.contents.named(str(self.wishes.picture.get("scalars") or ""))
        return None if array == self.array else array

    @property
    def needed_array(self) -> Named:
        """Array that is shown, of a recipe that cannot do without."""
        if self.array is None:
            names = [array.name for array in self.contents.arrays]
            expected = f"the name of an array, {one_of(names)}"
            raise ValueError(message("array", expected, None))
        return self.array

    @property
    def width(self) -> float:
        """Least width of lines, in pixels."""
        width = self.wishes.picture.get("line_width")
        return float(width) if width else round(max(1.5, THIN * max(self.wishes.size)), 1)


def _is_cut_by_box(surface: pv.PolyData, edges: pv.PolyData) -> bool:
    """Return whether all borders of a surface are on its box, and on all of its sides."""
    ends = np.reshape(surface.bounds, (3, 2))
    places = np.asarray(edges.points, dtype=np.float64)[..., np.newaxis]
    on = np.abs(places - ends) < ON_BOX * surface.length
    return bool(np.mean(on.any(axis=(1, 2))) > CUT and np.all(on.any(axis=0)))


def colors_of_rain(values: Array) -> Keywords:
    """Return the colours of rain in steps of decibels above 0, below which there is hardly any.

    Values are finite, one at least.
    """
    # Single places reflect more than any rain.
    high = float(DECIBELS * max(np.ceil(np.percentile(values, RAINY) / DECIBELS), 2))
    inner = np.arange(DECIBELS, high, DECIBELS).tolist()
    table = Step("", BANDS, inner, [0.0, high], RAIN, below=GROUND)
    return {"cmap": table, "clim": [0.0, high], "nan_color": MISSING}


def colors_in(shown: Range, cmap: Foreign, unit: float = 1.0) -> Keywords:
    """Return the colours of a range, with those of values outside of it.

    ``unit`` is that of the range, in that of the values.
    """
    ends = _in_unit([shown.low, shown.high], unit)
    if shown.logarithmic and shown.ground:
        inner = _in_unit(shown.classes[1:-1], unit)
        table = Step("", BANDS, inner, ends, cmap, logarithmic=True, below=GROUND)
        return {"cmap": table, "clim": ends}
    if not shown.logarithmic and not any(shown.clipped):
        return {"cmap": cmap, "clim": ends}
    outer = [to_hex(get_cmap_safe(cmap)(end)) for end in (0.0, 1.0)]
    if shown.apart or shown.ground:
        outer[0] = MISSING if shown.apart else GROUND
    names = ("below_range_color", "above_range_color")
    options: Keywords = {
        name: color for name, color, cut in zip(names, outer, shown.clipped, strict=True) if cut
    }
    if shown.logarithmic:
        options["log_scale"] = True
    table = Step(
        "", "pyvista.LookupTable", cmap, n_values=256, scalar_range=ends, nan_color=MISSING,
        **options,
    )  # fmt: skip
    return {"cmap": table, "clim": ends}


def _in_unit(values: Sequence[float], unit: float) -> tuple[float, ...]:
    """Return round numbers in another unit, without the rest of rounding."""
    return tuple(float(f"{unit * value:.12g}") for value in values)


def file_named(mesh: Step) -> str:
    """Return the name, without its suffixes, of the file that a step begins with, if it does."""
    return path_of(mesh).name.partition(".")[0]


def path_of(mesh: Step) -> Path:
    """Return the path of the file that a step begins with, one without a name if it does not."""
    *_, source = mesh.chain()
    return Path(source) if isinstance(source, str | Path) else Path()


def named(name: str, title: str) -> str:
    """Return a title after a name that is not empty."""
    return f"{name}, {title}" if name else title


def titled(
    mesh: pv.DataSet,
    name: str,
    *,
    course: bool = False,
    value: float | None = None,
    sign: str = " =",
) -> str:
    """Return the name of an array with its date and its unit, where the mesh says them.

    The course of a vector has no unit; that of a value stands after its number.
    """
    attributes = meaning.of(mesh).arrays.get(name.partition(",")[0], {})
    word, of_brains = brains.word_and_unit(name) if brains.hemisphere(mesh) else ("", "")
    unit = attributes.get("units", "").strip() or of_brains
    title = attributes.get("long_name") or attributes.get("standard_name") or word
    title = title or ("values" if meaning.is_of_reader(name) else name)
    if "," in name:
        title = _in_common(mesh, name.split(",")) or name
    is_word = title != name and not meaning.is_of_reader(name)
    if is_word and title.isupper() and len(title) > LONGEST_SHORT:
        title = title.lower()
    unit = "" if unit == "1" else meaning.written(unit)
    if value is not None:
        title = f"{title}{sign} {levels.number(value)} {unit}".rstrip()
    if (text := meaning.of(mesh).level) and attributes.get("level") != "none":
        title += f" at {text}"
    if series.TIME in mesh.field_data and attributes.get("date") != "none":
        many = OF_MANY_YEARS.search(title.lower()) is not None
        date = _dated(mesh, attributes.get("cell_methods", ""), of_many_years=many)
        title += f", {date}" * bool(date)
    return f"{title} ({unit})" if unit and not course and value is None else title


def _dated(mesh: pv.DataSet, methods: str, *, of_many_years: bool = False) -> str:
    """Return the date of a step, with what a value sums up of the time for which it stands."""
    said = meaning.of(mesh)
    times = [float(np.ravel(mesh.field_data[series.TIME])[0]), *said.span]
    date, *ends = (dates.date(time, said.time).removesuffix(" 00:00") for time in times)
    steps = series.of(mesh)
    if said.time == dates.MONTHS:
        return calendar.month_name[int(times[0])]
    if len(steps) < 2 and date.startswith(NO_DATE):
        # The first year of a calendar counts from a start that is none.
        return ""
    apart = _days_apart(steps, said.time)
    if len(apart) and apart.min() > MOST_HOURS / 24:
        date = date[: len("2000-01-01")]
    if len(apart) and np.all((apart > MONTH[0]) & (apart < MONTH[1])):
        date = date[: len("2000-01")] or _month(times[0], said.time)
        if of_many_years and len(date) == len("2000-01"):
            date = calendar.month_name[int(date[-2:])]
    if not date and len(steps) > 1:
        unit = said.time.partition(", ")[0].partition(" since ")[0]
        # One month is a name, many are a time.
        named = unit in ("year", "month", "day", "hour")
        text = f"{unit} {times[0]:g}" if named else f"t = {times[0]:g} {meaning.written(unit)}"
        date = text.rstrip()
    method = OVER_TIME.search(methods)
    if not date or method is None:
        return date
    return (
        f"{method[1]} of {ends[0]} to {ends[1]}" if all(ends) and ends else f"{method[1]} at {date}"
    )


def _month(time: float, unit: str) -> str:
    """Return the name of the month of a climatology, which is that of no year; else empty."""
    name, _, start = unit.partition(" since ")
    size = dates.seconds(name)
    if size is None or not NO_YEAR.match(start):
        return ""
    return calendar.month_name[int(time * size / (YEAR * 86400) * 12) % 12 + 1]


def _days_apart(times: Sequence[float], unit: str) -> Array:
    """Return the days from step to step, 0 where their unit is none of time."""
    seconds = dates.seconds(unit.partition(" since ")[0])
    days: Array = np.diff(np.asarray(times, dtype=np.float64)) * (seconds or 0.0) / 86400
    return days


def _in_common(mesh: pv.DataSet, names: Sequence[str]) -> str:
    """Return the words that the names of the components of a vector have in common."""
    arrays = meaning.of(mesh).arrays
    every = [(name, arrays.get(name, {})) for name in names]
    texts = [array.get("standard_name") or array.get("long_name") or name for name, array in every]
    # The letter of an axis may be a part of a word, as in u-momentum.
    first, *others = (re.split(r"[_ ]+", re.sub(r"\b[u-z]-", "", text)) for text in texts)
    left = " ".join(word for word in first if all(word in words for words in others))
    left = left.replace("component of ", "").replace(" component", "")
    return "" if left in ("component", "momentum") else left


def times_as_high(factor: float) -> str:
    """Return the words in a title that say the factor of heights."""
    return "" if factor == 1 else f"; relief {factor:g} times as high"


def titled_length(mesh: pv.DataSet, name: str) -> str:
    """Return the title of the lengths of vectors: their speed, if their unit or name is of one.

    The length of a displacement is a displacement.
    """
    title = titled(mesh, name)
    if DISPLACEMENT.fullmatch(name.lower()):
        return f"displacement{title.removeprefix(name)}" if title.startswith(name) else title
    is_speed = title.lower().endswith("/s)") or VELOCITY.fullmatch(name.lower())
    # The speed of a velocity is a speed, and that of a wind velocity a wind speed.
    of_what = re.match(r"(?i)(\w+)[ -]velocity\b", title)
    if is_speed and of_what and "," not in title.partition(" at ")[0]:
        return f"{of_what[1]} speed{title[of_what.end() :]}"
    words = re.sub(r"(?i)^of (velocity|vectors?|sv)(?= \(|$)", "", f"of {title}").strip()
    return f"speed {words}".strip() if is_speed else f"length of {title}"


def range_of(mesh: pv.DataSet, name: str) -> tuple[float, float]:
    """Return the ends of the finite values of an array."""
    values = array_of(mesh, name)
    assert values is not None
    finite = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    return float(finite.min()), float(finite.max())


def colors_of_kinds(mesh: Step, array: Named, keywords: Keywords) -> Keywords:
    """Return the keywords that give each kind a colour of its own."""
    kinds = kinds_of(mesh.run(), array.name, MOST_IN_KEY)
    names = meaning.flags(mesh.run(), array.name)
    if "cmap" not in keywords and len(kinds) == 1 and kinds[0] not in names:
        return keywords | {"cmap": _of_one(kinds[0])}
    # Numbers of parts that are no whole numbers have no colours of their own.
    if "cmap" in keywords or any(kind != round(kind) for kind in kinds):
        return keywords
    named = {kind: names.get(kind, f"{kind:g}") for kind in kinds}
    colors = meaning.flags(mesh.run(), array.name, "colors")
    of_file = {kind: colors[kind] for kind in kinds if kind in colors}
    own: Keywords = {"colors": of_file} if of_file else {}
    table = Step("", "vizlight.maps.kinds", named if names else list(kinds), **own)
    return keywords | {"cmap": table}


def _of_one(value: float) -> Step:
    """Return the step that makes the colours of a single value, whole or not."""
    return Step(
        "", "pyvista.LookupTable", [ONLY, ONLY], scalar_range=(value - 0.5, value + 0.5),
        annotations={value: f"{value:.6g}"}, nan_color=MISSING,
    )  # fmt: skip


def unlit(lit: Step, scene: Step, name: str, **drawing: object) -> Layer:
    """Return the layer of a light that was computed at the points, drawn as it is."""
    drawn: Keywords = {"lighting": False, "show_scalar_bar": False, **drawing}
    if scene.run().colored:
        return Layer(lit, {"scalars": part_name(name, "rgb"), "rgb": True, **drawn}, live=False)
    return Layer(lit, {"scalars": name, "cmap": "gray", "clim": (0.0, 1.0), **drawn}, live=False)


def colors_of(array: Named, colors: Keywords) -> Keywords:
    """Return the array and the colour map of a mesh, as a glTF file takes them."""
    names = ("cmap", "clim")
    return {"scalars": array.name} | {name: colors[name] for name in names if name in colors}


def lines_every(title: str, levels: Sequence[float]) -> str:
    """Return the title of a bar with the step of isolines.

    The title has a unit, and levels are in even steps.
    """
    if len(levels) < 2:
        return title
    _, unit = parted(title)
    step = numerals_of([levels[1] - levels[0]])[0]
    return f"{title}; lines every {step} {unit}".rstrip()
