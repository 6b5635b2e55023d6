"""The content of a page: meshes, lights and scalar bars of a plotter, as JSON has them."""

from __future__ import annotations

import base64
import dataclasses
import itertools
import json
import zlib
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
import pyvista as pv

from vizlight.draw import dialects, program
from vizlight.draw.fragments import Fragments
from vizlight.draw.live import NORMALS, TANGENTS, items, matrix_of
from vizlight.draw.sources import LEFT_OUT, fixed_colors, lit_colors
from vizlight.filters.key import TEXTS
from vizlight.mesh import blocks, records
from vizlight.scene import DepthCue, Light, Scene, View, presets
from vizlight.scene.conversion import lights_of
from vizlight.scene.light import WHITE
from vizlight.shading.display import NO_DATA_NAME, numerals
from vizlight.shading.plan import decide

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Foreign, Indices, Raw
    from vizlight.draw.live import Live
    from vizlight.filters.relight import Source
    from vizlight.shading.plan import Plan

#: Largest number of colours of a scalar bar.
COLORS = 64
#: Colour maps that the page offers, the default one first.
MAPS = ("viridis", "cividis", "plasma", "coolwarm", "twilight", "gray")
#: Lamps without a place that a reader may add.
MOST_LAMPS = 4
#: Arrays that the page can colour by, and their values over all meshes.
MOST_ARRAYS, MOST_VALUES = 6, 4_000_000
#: Code of a value that is not finite.
NO_VALUE = 65535
#: What the panel calls light by question, and says of it.
LOOKS = {
    "direction": ("Direction", "Hue is the direction on the screen, as the key shows."),
    "heading": ("Heading", "Hue tells the direction and which end is near."),
    "slope": ("Slope", "Bright is across your view, dark is along it."),
    "shape": ("Shape", "Hue and lightness are the normal, as on the ball of the key."),
    "value": ("Value", "Soft light without highlight: colours are read by the bar."),
}
#: Looks that answer a question about a surface without a field.
_OF_SURFACES = ("slope", "shape", "value")
#: Lamps that stand for any of their kind.
_NEAR = Light(position=(0, 0, 1), attenuation=(1, 0.1, 0.1))
_FAR = Light(direction=(0, 0, 1))
_COEFFICIENTS = ("ambient", "diffuse", "specular", "shininess")
#: Kinds of options that the page can write again.
_PLAIN = (str, int, float, bool)
#: Cells by their names in vtk.js and in PyVista.
_CELLS = {"verts": "verts", "lines": "lines", "polys": "faces", "strips": "strips"}
#: Numbers that neither the eye nor a slider changes.
_CONSTANT = ("vizFurRate", "vizTallest", "vizCue", "vizLeastGain", "vizColorGain")


class Shown(NamedTuple):
    """A drawn mesh with live light, its name in the panel, and its frame if it has one."""

    name: str
    live: Live
    actor: vtkActor
    frame: int | None = None


class Page:
    """What the page holds, as JSON has it."""

    def __init__(self, renderer: vtkRenderer) -> None:
        self.renderer, self.camera = renderer, renderer.GetActiveCamera()
        self.background = renderer.GetBackground()
        #: Point from which all places are measured, so that float32 has digits for them.
        # Places on Earth have seven digits before the point, more than float32 holds.
        self.origin = np.asarray(self.camera.GetFocalPoint(), dtype=np.float64)
        self.meshes: list[dict[str, object]] = []
        self.lights: list[list[dict[str, object]]] = []
        self.bars: list[dict[str, object]] = []
        self.notices: list[str] = []
        self.arrays: dict[str, list[float]] = {}
        self.recipe: dict[str, object] = {"file": "", "options": {}, "color": ""}
        self._texts: list[list[list[str]]] = []
        self._lines = False

    def content(self) -> dict[str, object]:
        """Return the whole page."""
        camera = self.camera
        # The shaders of all combinations of lamps are much alike and shrink to a few kB.
        texts = zlib.compress(json.dumps(self._texts).encode(), 9)
        maps = {name: pv.LookupTable(name, n_values=256).values for name in MAPS}
        return {
            "background": _hex(self.background),
            "camera": {
                "position": self.moved(camera.GetPosition()),
                "focal": self.moved(camera.GetFocalPoint()),
                "up": list(camera.GetViewUp()),
                "angle": camera.GetViewAngle(),
                "parallel": bool(camera.GetParallelProjection()),
                "scale": camera.GetParallelScale(),
            },
            "origin": self.origin.tolist(),
            "lights": self.lights,
            "most": max((len(rows) for rows in self.lights), default=0),
            "meshes": self.meshes,
            "texts": base64.b64encode(texts).decode(),
            "arrays": self.arrays,
            "maps": {name: _packed(np.asarray(rows)[:, :3], "u1") for name, rows in maps.items()},
            "cmap": next(iter(MAPS)),
            "looks": _looks(lines=self._lines),
            "fade": 0.0,
            "bars": self.bars,
            "texts2d": _words(self.renderer),
            "notices": self.notices,
            "recipe": self.recipe,
        }

    def moved(self, point: Sequence[float]) -> list[float]:
        """Return a point as measured from the origin of the page."""
        found: list[float] = (np.asarray(point, dtype=np.float64) - self.origin).tolist()
        return found

    def add(self, shown: Shown) -> None:
        """Add a mesh with its light."""
        live, actor = shown.live, shown.actor
        # A page has surfaces, lines and points; of a volume its outer surface.
        surface, ids = live.drawn, np.arange(live.drawn.n_points)
        if not isinstance(surface, pv.PolyData):
            surface, ids = blocks.outer_surface(surface)
        prop = actor.GetProperty()
        made: dict[str, object] = {
            "name": shown.name,
            "color": list(prop.GetDiffuseColor()),
            "opacity": prop.GetOpacity(),
            "lineWidth": prop.GetLineWidth(),
            "pointSize": prop.GetPointSize(),
            "representation": prop.GetRepresentation(),
        }
        if shown.frame is not None:
            made["frame"] = shown.frame
        if prop.GetEdgeVisibility():
            made["edgeColor"] = list(prop.GetEdgeColor())
        matrix = matrix_of(actor.GetMatrix())
        with np.errstate(invalid="ignore", over="ignore"):  # points that are not finite
            # Actors are not moved in the page: their matrix is taken into the points.
            points = np.asarray(surface.points, dtype=np.float64) @ matrix[:3, :3].T
            made["points"] = _places(points + matrix[:3, 3] - self.origin)
        for key, name in _CELLS.items():
            cells = np.asarray(getattr(surface, name))
            if len(cells):
                made[key] = _packed(cells, "u4")
        scene = live.scene_of(self.renderer, actor)
        if live.scalars is not None:
            # The actor's own colour is PyVista's, which no one sees.
            made["color"] = list(scene.material.color or WHITE)
        if isinstance(live, Fragments):
            made |= self._followed(live, scene, actor, matrix)
        else:
            made |= self._fixed(shown, scene, ids)
        self.meshes.append(made)

    def add_values(self, every: Sequence[Shown]) -> None:
        """Add the arrays by which the page can colour its meshes."""
        rows = [
            _numbers_of(one.live) if mesh["live"] else {}
            for one, mesh in zip(every, self.meshes, strict=True)
        ]
        names = dict.fromkeys(name for found in rows for name in found)
        left = MOST_VALUES
        for name in [*names][:MOST_ARRAYS]:
            there = [found[name] for found in rows if name in found]
            left -= sum(map(len, there))
            ends = _ends(there)
            if left < 0 or ends is None:
                continue
            self.arrays[name] = list(ends)
            for mesh, found in zip(self.meshes, rows, strict=True):
                if name in found:
                    values = cast("dict[str, object]", mesh.setdefault("values", {}))
                    values[name] = _codes(found[name], ends)

    def _followed(
        self, live: Fragments, scene: Scene, actor: vtkActor, matrix: Array
    ) -> dict[str, object]:
        """Return the light in fragments: texts, numbers, tangents and normals."""
        rows = self._lights_of(live, scene)
        prop = actor.GetProperty()
        texts, constants, plan = self._written(live, scene, rows)
        self._lines |= not plan.surface
        self._remember(live)
        made: dict[str, object] = {
            "live": True,
            "lights": _number_of(rows, self.lights),
            "texts": texts,
            "numbers": constants,
            "surface": plan.surface,
            "sky": plan.occluded,
            "free": any(key.startswith("free ") for key in texts),
            "material": {name: getattr(scene.material, name) for name in _COEFFICIENTS},
            "ambientColor": [scene.ambient_intensity * c for c in scene.ambient_color or WHITE],
            "specularColor": list(prop.GetSpecularColor()),
        }
        cue = scene.depth_cue
        if cue is not None:
            made["cue"] = {
                "front": cue.front, "back": cue.back, "scales": [cue.front_scale, cue.back_scale]
            }  # fmt: skip
        arrays, linear = live.drawn.point_data, matrix[:3, :3]
        mixed = plan.line_exponent is not None
        if TANGENTS in arrays and (plan.occluded or mixed or not plan.surface):
            made["tangents"] = _directions(arrays[TANGENTS], linear.T)
        if NORMALS in arrays and (plan.surface or plan.conditioned or plan.fur):
            made["normals"] = _directions(arrays[NORMALS], np.linalg.inv(linear))
        if live.scalars is not None:
            of_cells = live.scalars not in arrays
            made |= {"colors": _packed(live.mapped(actor), "u1"), "ofCells": of_cells}
            made["colored"] = True
        return made

    def _written(
        self, live: Fragments, scene: Scene, rows: Sequence[dict[str, object]]
    ) -> tuple[dict[str, int], dict[str, list[float]], Plan]:
        """Return the texts for all lamps that the page may have, their constants, and a plan.

        A key is the number of lamps with a place, the number without, and "cue"; "data" before
        it where colours come from data, "free " where the light of conditioned tangents leaves the
        surface out.
        """
        # All numbers of lamps that a reader can reach by the panel have their shader in the page.
        near = sum(bool(row["position"]) for row in rows)
        far = max(MOST_LAMPS, len(rows))
        # Sliders raise what is 0 now, so the texts have all terms.
        whole = dataclasses.replace(scene.material, diffuse=1.0, specular=1.0)
        # The page finds the ends of a depth cue.
        cue = dataclasses.replace(scene.depth_cue or DepthCue(), front=0.0, back=1.0)
        sources, inputs = {"": live.source}, live.source.inputs
        furry = inputs.fur_height is not None
        if live.source.options.conditioned and inputs.normals is not None and not furry:
            sources["free "] = _unconditioned(live.source)
        constants: dict[str, list[float]] = {}
        found: dict[str, int] = {}
        yes_no, counts = (False, True), (range(near + 1), range(far + 1))
        for data, free, ended, i, j in itertools.product(yes_no, sources, yes_no, *counts):
            lamps = [_NEAR] * i + [_FAR] * j
            lit = scene.replace(lights=lamps, material=whole, depth_cue=cue if ended else None)
            plan, source = _plan(lit, sources[free]), sources[free]
            given = program.numbers(lit, lamps, fur=plan.fur, tallest=live.tallest, data=data)
            if plan.occluded:
                given.append(program.Uniform("vizSky", "float", (1.0,)))
            constants |= {n.name: list(n.value) for n in given if n.name in _CONSTANT}
            key = f"{'data ' if data else ''}{free}{i} {j}{' cue' if ended else ''}"
            turned = source.sided is not None
            written = program.write(plan, turned=turned, data=data, sky=plan.occluded)
            text = [list(each) for each in dialects.VTK_JS.replacements(written, given)]
            found[key] = _number_of(text, self._texts)
        plan = _plan(scene.replace(depth_cue=None), live.source)
        return found, constants, plan

    def _remember(self, live: Live) -> None:
        """Keep how the first mesh was lit, for the texts that the page copies."""
        if len(self.meshes) or live.source.named is None:
            return
        self.recipe["options"] = {
            name: ascii(value)
            for name, value in live.source.named.changed().items()
            if name not in ("name", "feature_angle") and isinstance(value, _PLAIN)
        }
        if live.given is not None:
            self.recipe["color"] = f", scalars={live.given!a}"

    def _fixed(self, shown: Shown, scene: Scene, ids: Indices) -> dict[str, object]:
        """Return colours with the light that does not depend on the eye."""
        live, actor = shown.live, shown.actor
        placed = live.source._replace(inputs=live.placed(actor))
        colors = None if live.scalars is None else live.mapped(actor)[ids]
        if live.own_eye:
            lit = lit_colors(placed, scene, colors, ids)
        else:
            lit, seen = fixed_colors(placed, scene, colors, ids)
            why = "" if live.reason == "asked for" else f", because {live.reason}"
            said = f"; {seen} as from the first view" if seen else ""
            self.notices.append(
                f"{shown.name}: the light does not follow the eye{why}; {LEFT_OUT}{said}"
            )
        return {"live": False, "colors": _packed(lit, "u1"), "color": [1.0, 1.0, 1.0]}

    def _lights_of(self, live: Live, scene: Scene) -> list[dict[str, object]]:
        """Return the lights of a mesh, as the page moves them."""
        pairs = [(light, light.follows_view) for light in scene.lights]
        if live.scene is None:
            pairs = [
                (light, light.follows_view or bool(own.LightTypeIsCameraLight()))
                for own in items(self.renderer.GetLights())
                for light in lights_of([own], self.camera)
            ]
        matrix = matrix_of(self.camera.GetViewTransformMatrix())
        rows = []
        for light, follows in pairs:
            if light.intensity <= 0:
                continue
            fixed = light.seen_from(View.from_camera(self.camera))
            at = fixed.position is not None
            value = np.asarray(fixed.position if at else fixed.direction, dtype=np.float64)
            if follows:
                value = matrix[:3, :3] @ value + (matrix[:3, 3] if at else 0.0)
            elif at:
                value = value - self.origin
            rows.append(_lamp(light, value.tolist(), at=at, follows=follows))
        return rows

    def add_bars(self, plotter: pv.BasePlotter, shown: Sequence[Shown]) -> None:
        """Add the scalar bars that the plotter shows."""
        titles = list(plotter.scalar_bars.keys())
        for one in shown:
            if one.live.scalars is None or not titles:
                continue
            table = one.actor.GetMapper().GetLookupTable()
            title = next(
                (t for t in titles if plotter.scalar_bars[t].GetLookupTable() is table), ""
            )
            if title:
                titles.remove(title)
                self.bars.append(_bar(title, table))
                if plotter.scalar_bars[title].GetDrawNanAnnotation():
                    grey = _hex(table.GetNanColor())
                    self.bars.append({"title": NO_DATA_NAME, "colors": [grey, grey], "numbers": []})


def _number_of(item: Foreign, known: list[Foreign]) -> int:
    """Return the number by which equal items, which are stored once, are named."""
    if item not in known:
        known.append(item)
    return known.index(item)


def _plan(scene: Scene, source: Source) -> Plan:
    options = dataclasses.replace(source.options, components=False)
    return decide(scene, source.inputs.layout, options)


def _unconditioned(source: Source) -> Source:
    """Return tangents that are lit as lines, wherever their surface is."""
    inputs = dataclasses.replace(source.inputs, normals=None, sides=None)
    options = dataclasses.replace(source.options, conditioned=False)
    return source._replace(inputs=inputs, options=options, sided=None)


def _lamp(light: Light, value: list[float], *, at: bool, follows: bool) -> dict[str, object]:
    """Return a light as the page has it: at a place or in a direction, of the eye or of space."""
    return {
        "value": value, "position": at, "eye": follows, "intensity": light.intensity,
        "color": list(light.color or WHITE), "attenuation": list(light.attenuation),
    }  # fmt: skip


def _looks(*, lines: bool) -> dict[str, object]:
    """Return light by question: lamps of the eye, material, and the words of the key."""
    found: dict[str, object] = {}
    for name, (title, says) in LOOKS.items():
        if not (lines or name in _OF_SURFACES):
            continue
        scene: Scene = getattr(presets, name)()
        lamps = [
            _lamp(light, list(light.direction or (0.0, 0.0, 1.0)), at=False, follows=True)
            for light in scene.lights
        ]
        material = {key: getattr(scene.material, key) for key in _COEFFICIENTS}
        words = [] if name == "value" else list(TEXTS[name])
        found[name] = {
            "title": title, "says": says, "lamps": lamps, "material": material, "key": words,
            "colored": name == "value", "free": name not in ("shape", "value"),
        }  # fmt: skip
    return found


def _words(renderer: vtkRenderer) -> list[list[str]]:
    """Return the texts in the corners of a picture, each with its place."""
    corners = ("bottom left", "bottom right", "top left", "top right")
    return [
        [corner, actor.GetText(i)]
        for actor in items(renderer.GetViewProps())
        if actor.IsA("vtkCornerAnnotation")
        for i, corner in enumerate(corners)
        if actor.GetText(i)
    ]


def _hex(color: Sequence[float]) -> str:
    return "#" + bytes(round(255 * c) for c in color[:3]).hex()


def _numbers_of(live: Live) -> dict[str, Raw]:
    """Return the arrays of a drawn mesh that can be coloured, one number per point or cell."""
    of_cells = live.scalars is not None and live.scalars not in live.drawn.point_data
    data = live.drawn.cell_data if of_cells else live.drawn.point_data
    made = records.all_made(live.source.mesh)
    found: dict[str, Raw] = {}
    for name in data:
        array = np.asarray(data[name])
        own = name.startswith("vizlight ") or name in made or name == "Normals"
        if own or array.dtype.kind not in "iufb" or not len(array):
            continue
        if array.ndim == 1:
            found[name] = array
        elif array.shape[1] == 3 and array.dtype.kind == "f":
            found[f"|{name}|"] = np.linalg.norm(array.astype(np.float64), axis=1)
    return found


def _ends(rows: Sequence[Raw]) -> tuple[float, float] | None:
    """Return the least and the largest finite value, None if there are not two."""
    values = np.concatenate(rows, dtype=np.float64)
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    return (low, high) if low < high and np.isfinite(high - low) else None


def _codes(values: Raw, ends: tuple[float, float]) -> dict[str, object]:
    """Return values in 16 bits between the ends of a range."""
    rows = np.asarray(values, dtype=np.float64)
    known = np.isfinite(rows)
    codes = np.rint(
        (NO_VALUE - 1) * (np.where(known, rows, ends[0]) - ends[0]) / (ends[1] - ends[0])
    )
    return _packed(np.where(known, codes, NO_VALUE), "u2")


def _packed(values: Raw, kind: str) -> dict[str, object]:
    """Return whole numbers, compressed and as text.

    Numbers of several bytes are kept as differences from row to row, signed numbers as differences
    of those differences. The sign is in the last bit, and bytes of equal rank stand together. This
    compresses to about half.
    """
    rows = np.ascontiguousarray(values, f"<{kind}")
    made: dict[str, object] = {"kind": kind}
    data = rows.tobytes()
    if rows.itemsize > 1:
        columns, order = 1 if rows.ndim == 1 else rows.shape[1], 2 if rows.dtype.kind == "i" else 1
        signed = np.dtype(f"<i{rows.itemsize}")
        steps = rows.view(signed).reshape(-1, columns)
        for _ in range(order):
            steps = np.diff(steps, axis=0, prepend=signed.type(0))
        folded = np.ascontiguousarray(((steps << 1) ^ (steps >> (8 * rows.itemsize - 1))).T)
        data = folded.view(np.uint8).reshape(-1, rows.itemsize).T.tobytes()
        made |= {"columns": columns, "order": order}
    return made | {"data": base64.b64encode(zlib.compress(data, 9)).decode()}


def _places(points: Array) -> dict[str, object]:
    """Return points as multiples of the rounding of float32 at the farthest of them.

    Coordinates that are not finite in float32 become the least number, which the viewer takes for
    NaN: cells with them are not drawn.
    """
    good = np.abs(points) < 1e38
    scale = float(np.abs(points[good]).max(initial=0.0) or 1.0) / (1 << 23)
    whole = np.rint(np.where(good, points, 0.0) / scale)
    return _packed(np.where(good, whole, -(2.0**31)), "i4") | {"scale": scale}


def _directions(rows: Array, linear: Array) -> dict[str, object]:
    """Return vectors turned by a matrix and of the length that they had, in 16 bits."""
    given = np.asarray(rows, dtype=np.float64)
    sizes, turned = np.linalg.norm(given, axis=1), given @ linear
    new = np.linalg.norm(turned, axis=1)
    turned *= (sizes / np.where(new > 0, new, 1.0))[:, np.newaxis]
    scale = float(np.abs(turned).max(initial=0.0) or 1.0) / 32767
    return _packed(np.rint(turned / scale), "i2") | {"scale": scale}


def _bar(title: str, table: pv.LookupTable) -> dict[str, object]:
    """Return a scalar bar: its colours from left to right, and three numbers."""
    low, high = table.GetTableRange()
    logarithmic = bool(table.GetScale())
    middle = float(np.sqrt(low * high)) if logarithmic else (low + high) / 2
    every = np.asarray(table.values)[:, :3]
    chosen = every[np.linspace(0, len(every) - 1, min(COLORS, len(every))).astype(int)]
    return {
        "title": title,
        "colors": ["#" + bytes(color).hex() for color in chosen.astype(np.uint8)],
        "numbers": numerals((low, middle, high)),
    }
