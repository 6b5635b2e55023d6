"""One HTML file that shows lit meshes, with light in each fragment that follows the eye."""

from __future__ import annotations

import base64
import contextlib
import dataclasses
import functools
import html
import io
import itertools
import json
import re
import string
import zlib
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Literal, NamedTuple, cast

import numpy as np
import pyvista as pv
from PIL import Image
from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

from vizlight import _check
from vizlight._questions import QUESTIONS, Question
from vizlight._types import Array, ColorLike, Foreign, Given, Indices, Keywords, Raw
from vizlight.draw import backends, dialects, glsl, ground
from vizlight.draw.glsl import Stroke
from vizlight.draw.keywords import is_cloud
from vizlight.draw.live import NORMALS, TANGENTS, Fragments, LightAt, Live, items, matrix_of
from vizlight.draw.margins import MarginBar
from vizlight.draw.sources import LEFT_OUT, fixed_colors, lit_colors
from vizlight.draw.strokes import DEPTH, line_samples, shares_of
from vizlight.filters import relight
from vizlight.filters.key import annotated
from vizlight.filters.relight import Source
from vizlight.filters.tint import map_colors
from vizlight.mesh import blocks, records, strokes
from vizlight.mesh.casters import EvenField
from vizlight.mesh.polylines import backdrop
from vizlight.model import kernels
from vizlight.scene import DepthCue, Light, Scene, View
from vizlight.scene.conversion import lights_of
from vizlight.scene.light import WHITE
from vizlight.scene.presets import PRESETS, AnyScene, optional_scene, preset_of
from vizlight.shading.display import NO_DATA_NAME, numerals
from vizlight.shading.plan import Plan, decide
from vizlight.shading.results import DEFAULT_NAME
from vizlight.vtk.normals import is_scan
from vizlight.writing import check_output, replace_file

#: Largest number of colours of a scalar bar, and of those that have each a part of it.
COLORS, CLASSES = 64, 32
#: Colour maps that the page offers, the default one first.
MAPS = ("viridis", "cividis", "plasma", "coolwarm", "twilight", "gray")
#: Lamps without a place that a reader may add.
MOST_LAMPS = 4
#: Arrays that the page can colour by, and their values over all meshes.
MOST_ARRAYS, MOST_VALUES = 6, 4_000_000
#: Code of a value that is not finite.
NO_VALUE = 65535
#: Seconds in which a page shows a period of strokes that move, as a movie of 72 frames does.
SECONDS = 3.0
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


class PageMesh(NamedTuple):
    """A drawn mesh, its name in the panel, its live light if it has any, and its frame."""

    name: str
    live: Live | None
    actor: vtkActor
    frame: int | None = None


class Page:
    """Content of the page, as JSON."""

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
            "high": min(self.renderer.GetRenderWindow().GetSize()),
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
            "looks": _looks(lines=self._lines, values=bool(self.arrays or self.bars)),
            "fade": 0.0,
            "bars": self.bars,
            "texts2d": _words(self.renderer),
            "notices": self.notices,
            "recipe": self.recipe,
        }

    def moved(self, point: Sequence[float]) -> list[float]:
        """Return a point as measured from the origin of the page."""
        place: list[float] = (np.asarray(point, dtype=np.float64) - self.origin).tolist()
        return place

    def add(self, shown: PageMesh) -> None:
        """Add a mesh with its light, or in the colours that PyVista draws it in."""
        live, actor = shown.live, shown.actor
        # A page has surfaces, lines and points; of a volume its outer surface.
        surface = drawn_mesh(actor) if live is None else live.drawn
        ids = np.arange(surface.n_points)
        if not isinstance(surface, pv.PolyData):
            surface, ids = blocks.outer_surface(surface)
        prop = actor.GetProperty()
        # As drawn in a picture of more pixels, which is shrunk.
        thicker = (
            1.0 if live is not None and live.stroke != Stroke() else line_samples(self.renderer)
        )
        entry: dict[str, object] = {
            "name": shown.name,
            "color": list(prop.GetDiffuseColor()),
            "opacity": prop.GetOpacity(),
            "lineWidth": prop.GetLineWidth() / thicker,
            "pointSize": prop.GetPointSize() / min(thicker, 2.0),
            "representation": prop.GetRepresentation(),
            # Faces toward the eye that are left out, or those away from it.
            "culled": int(prop.GetFrontfaceCulling()) - int(prop.GetBackfaceCulling()),
        }
        if live is not None:
            entry |= _stroked(live, actor)
        if shown.frame is not None:
            entry["frame"] = shown.frame
        if prop.GetEdgeVisibility():
            entry["edgeColor"] = list(prop.GetEdgeColor())
        matrix = matrix_of(actor.GetMatrix())
        with np.errstate(invalid="ignore", over="ignore"):  # points that are not finite
            # Actors are not moved in the page: their matrix is taken into the points.
            points = np.asarray(surface.points, dtype=np.float64) @ matrix[:3, :3].T
            entry["points"] = _places(points + matrix[:3, 3] - self.origin)
        for key, name in _CELLS.items():
            cells = np.asarray(getattr(surface, name))
            if len(cells):
                entry[key] = _packed(cells, "u4")
        if live is None:
            entry |= self._unlit(actor, surface)
        else:
            self._light(entry, shown._replace(live=live), live, matrix, ids)
        self.meshes.append(entry)

    def _light(
        self, entry: dict[str, object], shown: PageMesh, live: Live, matrix: Array, ids: Indices
    ) -> None:
        """Add the light of a mesh to its entry."""
        scene = live.scene_of(self.renderer, shown.actor)
        if live.scalars is not None:
            # The actor's own colour is PyVista's, which no one sees.
            entry["color"] = list(scene.material.color or WHITE)
        if isinstance(live, Fragments):
            entry |= self._followed(live, scene, shown.actor, matrix)
        else:
            entry |= self._fixed(shown.name, live, shown.actor, scene, ids)
        if live.stroke.outline is not None:
            numbers = cast("dict[str, object]", entry.setdefault("numbers", {}))
            numbers["ownGround"] = list(pv.Color(live.stroke.outline).float_rgb)

    def _unlit(self, actor: vtkActor, surface: pv.PolyData) -> dict[str, object]:
        """Return the colours of a mesh that PyVista draws without light, and the lamps of balls."""
        mapper, prop = actor.GetMapper(), actor.GetProperty()
        entry: dict[str, object] = {"live": False}
        kind, name = surface.active_scalars_info
        if mapper.GetScalarVisibility() and name is not None:
            of_cells = kind == pv.FieldAssociation.CELL
            values = np.asarray((surface.cell_data if of_cells else surface.point_data)[name])
            colors = map_colors(mapper.GetLookupTable(), values)
            entry |= {"colors": _packed(colors, "u1"), "ofCells": of_cells}
        if prop.GetRenderPointsAsSpheres():
            lit = prop.GetLighting()
            lamps = self._lamps(lights_of_plotter(self.renderer)) if lit else []
            entry["ball"] = [prop.GetAmbient(), prop.GetDiffuse()] if lit else [1.0, 0.0]
            entry["lamps"] = lamps
        return entry

    def add_values(self, every: Sequence[PageMesh]) -> None:
        """Add the arrays by which the page can colour its meshes."""
        rows = [
            _numbers_of(each.live) if each.live is not None and mesh["live"] else {}
            for each, mesh in zip(every, self.meshes, strict=True)
        ]
        names = dict.fromkeys(name for of_mesh in rows for name in of_mesh)
        # All arrays of all meshes share one limit, as the page holds them all.
        left = MOST_VALUES
        for name in [*names][:MOST_ARRAYS]:
            there = [of_mesh[name] for of_mesh in rows if name in of_mesh]
            left -= sum(map(len, there))
            ends = _ends(there)
            if left < 0 or ends is None:
                continue
            self.arrays[name] = list(ends)
            for mesh, of_mesh in zip(self.meshes, rows, strict=True):
                if name in of_mesh:
                    values = cast("dict[str, object]", mesh.setdefault("values", {}))
                    values[name] = _codes(of_mesh[name], ends)

    def _followed(
        self, live: Fragments, scene: Scene, actor: vtkActor, matrix: Array
    ) -> dict[str, object]:
        """Return the light in fragments: texts, numbers, tangents and normals."""
        pairs = [(light, light.follows_view) for light in scene.lights]
        rows = self._lamps(lights_of_plotter(self.renderer) if live.scene is None else pairs)
        prop = actor.GetProperty()
        texts, constants, plan = self._written(live, scene, rows)
        self._lines |= not plan.surface
        self._remember(live)
        entry: dict[str, object] = {
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
        field = live.source.field
        if field is not None:
            entry["field"] = self._field(field, matrix)
        if scene.exposure is not None:
            entry["exposure"] = scene.exposure
        cue = scene.depth_cue
        if cue is not None:
            entry["cue"] = {
                "front": cue.front, "back": cue.back, "scales": [cue.front_scale, cue.back_scale]
            }  # fmt: skip
        arrays, linear = live.drawn.point_data, matrix[:3, :3]
        mixed = plan.line_exponent is not None
        if TANGENTS in arrays and (plan.occluded or mixed or not plan.surface):
            entry["tangents"] = _directions(arrays[TANGENTS], linear.T)
        if NORMALS in arrays and (plan.surface or plan.conditioned or plan.fur):
            # Rows on the left of the inverse turn as normals do, by its transpose.
            entry["normals"] = _directions(arrays[NORMALS], np.linalg.inv(linear))
        if live.scalars is not None:
            of_cells = live.scalars not in arrays
            entry |= {"colors": _packed(live.mapped(actor), "u1"), "ofCells": of_cells}
            entry["colored"] = True
        return entry

    def _field(self, field: EvenField, matrix: Array) -> dict[str, object]:
        """Return the height field that casts a shadow, and its numbers in the page's space."""
        every = ground.numbers(field, matrix)
        values = {
            n.name: self.moved(n.value) if n.space == "position" else list(n.value) for n in every
        }
        return {"heights": _places(field.heights.reshape(-1, 1)), "numbers": values}

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
        on_surface = inputs.normals is not None and inputs.tangents is not None
        if live.source.options.conditioned and on_surface and inputs.fur_height is None:
            # Tangents that are lit as lines, wherever their surface is.
            lines = dataclasses.replace(inputs, normals=None, sides=None)
            options = dataclasses.replace(live.source.options, conditioned=False)
            sources["free "] = live.source._replace(inputs=lines, options=options, sided=None)
        constants: dict[str, list[float]] = {}
        places: dict[str, int] = {}
        yes_no, counts = (False, True), (range(near + 1), range(far + 1))
        for data, free, ended, i, j in itertools.product(yes_no, sources, yes_no, *counts):
            lamps = [_NEAR] * i + [_FAR] * j
            lit = scene.replace(lights=lamps, material=whole, depth_cue=cue if ended else None)
            plan, source = _plan(lit, sources[free]), sources[free]
            uniforms = glsl.numbers(lit, lamps, fur=plan.fur, tallest=live.tallest, data=data)
            if source.field is not None:
                uniforms += ground.numbers(source.field, np.eye(4))
            if plan.occluded:
                uniforms.append(glsl.Uniform("vizSky", "float", (1.0,)))
            constants |= {n.name: list(n.value) for n in uniforms if n.name in _CONSTANT}
            key = f"{'data ' if data else ''}{free}{i} {j}{' cue' if ended else ''}"
            turned = source.sided is not None
            written = glsl.write(plan, turned=turned, data=data, sky=plan.occluded)
            text = [list(each) for each in dialects.VTK_JS.replacements(written, uniforms)]
            places[key] = _number_of(text, self._texts)
        plan = _plan(scene.replace(depth_cue=None), live.source)
        return places, constants, plan

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

    def _fixed(
        self, name: str, live: Live, actor: vtkActor, scene: Scene, ids: Indices
    ) -> dict[str, object]:
        """Return colours with the light that does not depend on the eye."""
        placed = live.source._replace(inputs=live.placed(actor))
        colors = None if live.scalars is None else live.mapped(actor)[ids]
        if live.own_eye:
            lit = lit_colors(placed, scene, colors, ids)
        else:
            lit, seen = fixed_colors(placed, scene, colors, ids)
            why = "" if live.reason == "asked for" else f", because {live.reason}"
            said = f"; {seen} as from the first view" if seen else ""
            shines = scene.material.specular > 0 or scene.depth_cue is not None
            # Of ambient light, and of diffuse light from fixed lamps, nothing depends on the eye.
            if scene.lights and (shines or any(light.follows_view for light in scene.lights)):
                self.notices.append(
                    f"{name}: the light does not follow the eye{why}; {LEFT_OUT}{said}"
                )
        return {"live": False, "colors": _packed(lit, "u1"), "color": [1.0, 1.0, 1.0]}

    def _lamps(self, pairs: Sequence[tuple[Light, bool]]) -> list[dict[str, object]]:
        """Return lights as the page moves them, from each and whether it follows the eye."""
        matrix = matrix_of(self.camera.GetViewTransformMatrix())
        rows = []
        for light, follows in pairs:
            if light.intensity <= 0:
                continue
            fixed = light.seen_from(View.from_camera(self.camera))
            at = fixed.position is not None
            value = np.asarray(fixed.position if at else fixed.direction, dtype=np.float64)
            if follows:
                # In view coordinates, in which it stays where it is while the eye moves.
                value = matrix[:3, :3] @ value + (matrix[:3, 3] if at else 0.0)
            elif at:
                value = value - self.origin
            rows.append(_lamp(light, value.tolist(), at=at, follows=follows))
        return rows

    def add_bars(self, plotter: pv.BasePlotter, shown: Sequence[PageMesh]) -> None:
        """Add the scalar bars that the plotter shows."""
        tables = [mesh.actor.GetMapper().GetLookupTable() for mesh in shown]
        for title, bar in plotter.scalar_bars.items():
            table = bar.GetLookupTable()
            if any(table is own_table for own_table in tables):
                self.bars.append(_bar(title, table))
                if bar.GetDrawNanAnnotation():
                    grey = _hex(table.GetNanColor())
                    self.bars.append({"title": NO_DATA_NAME, "colors": [grey, grey], "marks": []})


def drawn_mesh(actor: vtkActor) -> pv.DataSet:
    """Return the mesh that an actor draws."""
    mesh: pv.DataSet = pv.wrap(actor.GetMapper().GetInputDataObject(0, 0))
    return mesh


def lights_of_plotter(renderer: vtkRenderer) -> list[tuple[Light, bool]]:
    """Return the lights of a renderer, and whether each follows the eye."""
    return [
        (light, light.follows_view or bool(lamp.LightTypeIsCameraLight()))
        for lamp in items(renderer.GetLights())
        for light in lights_of([lamp], renderer.GetActiveCamera())
    ]


def _stroked(live: Live, actor: vtkActor) -> dict[str, object]:
    """Return the halos of lines, their widths, and how they move."""
    entry: dict[str, object] = {}
    if live.stroke.halo:
        entry |= {"halo": live.stroke.halo, "depth": DEPTH}
    if live.stroke.width is None:
        return entry
    shares = live.picked(shares_of(live.source.mesh, live.stroke.width))
    entry["widths"] = _packed((255 * shares)[:, np.newaxis], "u1")
    if "Normals" in live.source.mesh.point_data:
        # Of the surface on which the strokes lie, from 0 to 255.
        leans = live.picked(np.asarray(live.source.mesh["Normals"])) @ np.linalg.inv(
            matrix_of(actor.GetMatrix())[:3, :3]
        )
        leans /= np.maximum(np.linalg.norm(leans, axis=1, keepdims=True), 1e-30)
        entry["leans"] = _packed(np.rint(127.5 * (leans + 1)), "u1")
    if strokes.PHASE in live.source.mesh.point_data:
        phase, passing, grown = (
            live.picked(np.asarray(live.source.mesh.point_data[name], dtype=np.float64))
            for name in (strokes.PHASE, strokes.PASSING, strokes.GROWN)
        )
        # The arrays by which the page moves strokes, and the shape of a stroke.
        entry["moving"] = {
            "phase": _packed(np.rint(phase % 1.0 * NO_VALUE), "u2"),
            "passing": _packed(np.minimum(passing, NO_VALUE), "u2"),
            "grown": _packed(np.rint(255 * grown), "u1"),
            **strokes.FLAT._asdict(),
            "bare": strokes.BARE, "base": strokes.BASE, "seconds": SECONDS,
        }  # fmt: skip
    return entry


def _number_of(item: Foreign, items_stored: list[Foreign]) -> int:
    """Return the number by which equal items, which are stored once, are named."""
    if item not in items_stored:
        items_stored.append(item)
    return items_stored.index(item)


def _plan(scene: Scene, source: Source) -> Plan:
    options = dataclasses.replace(source.options, components=False)
    return decide(scene, source.inputs.layout, options)


def _lamp(light: Light, value: list[float], *, at: bool, follows: bool) -> dict[str, object]:
    """Return a light as the page has it: at a place or in a direction, of the eye or of space."""
    return {
        "value": value, "position": at, "eye": follows, "intensity": light.intensity,
        "color": list(light.color or WHITE), "attenuation": list(light.attenuation),
    }  # fmt: skip


def _looks(*, lines: bool, values: bool) -> dict[str, object]:
    """Return light by question: lamps of the eye, material, and the words of the key."""
    by_name: dict[str, object] = {}
    for name, question in QUESTIONS.items():
        # Light answers nothing about tangents or values that the meshes do not have.
        if (question.of_tangents and not lines) or (question.key == "colors" and not values):
            continue
        scene: Scene = PRESETS[name]()
        lamps = [
            _lamp(light, list(light.direction or (0.0, 0.0, 1.0)), at=False, follows=True)
            for light in scene.lights
        ]
        material = {key: getattr(scene.material, key) for key in _COEFFICIENTS}
        is_colored = question.key == "colors"
        words = [] if is_colored else list(question.words)
        by_name[name] = {
            "title": question.title, "says": question.says, "lamps": lamps, "material": material,
            "key": words, "form": "ball" if is_colored else question.key, "colored": is_colored,
            "free": question.of_tangents,
        }  # fmt: skip
    return by_name


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
    outputs = records.all_made(live.source.mesh)
    numbers: dict[str, Raw] = {}
    for name in data:
        array = np.asarray(data[name])
        is_made = name.startswith("vizlight ") or name in outputs or name == "Normals"
        if is_made or array.dtype.kind not in "iufb" or not len(array):
            continue
        if array.ndim == 1:
            numbers[name] = array
        elif array.shape[1] == 3 and array.dtype.kind == "f":
            numbers[f"|{name}|"] = kernels.length_rows(array)
    return numbers


def _ends(rows: Sequence[Raw]) -> tuple[float, float] | None:
    """Return the least and the largest finite value, None if they do not differ."""
    values = np.concatenate(rows, dtype=np.float64)
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    return (low, high) if low < high and np.isfinite(high - low) else None


def _codes(values: Raw, ends: tuple[float, float]) -> dict[str, object]:
    """Return values in 16 bits between the ends of a range."""
    rows = np.asarray(values, dtype=np.float64)
    finite = np.isfinite(rows)
    # The largest code stands for places without a value.
    codes = np.rint(
        (NO_VALUE - 1) * (np.where(finite, rows, ends[0]) - ends[0]) / (ends[1] - ends[0])
    )
    return _packed(np.where(finite, codes, NO_VALUE), "u2")


def _packed(values: Raw, kind: str) -> dict[str, object]:
    """Return whole numbers, compressed and as text.

    Numbers of several bytes are kept as differences from row to row, signed numbers as differences
    of those differences. The sign is in the last bit, and bytes of equal rank stand together. This
    compresses to about half.
    """
    rows = np.ascontiguousarray(values, f"<{kind}")
    packed: dict[str, object] = {"kind": kind}
    data = rows.tobytes()
    if rows.itemsize > 1:
        columns, order = 1 if rows.ndim == 1 else rows.shape[1], 2 if rows.dtype.kind == "i" else 1
        signed = np.dtype(f"<i{rows.itemsize}")
        steps = rows.view(signed).reshape(-1, columns)
        for _ in range(order):
            steps = np.diff(steps, axis=0, prepend=signed.type(0))
        # Small differences of either sign then have high bytes of 0, which compress to little.
        folded = np.ascontiguousarray(((steps << 1) ^ (steps >> (8 * rows.itemsize - 1))).T)
        data = folded.view(np.uint8).reshape(-1, rows.itemsize).T.tobytes()
        packed |= {"columns": columns, "order": order}
    return packed | {"data": base64.b64encode(zlib.compress(data, 9)).decode()}


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
    vectors = np.asarray(rows, dtype=np.float64)
    sizes, turned = np.linalg.norm(vectors, axis=1), vectors @ linear
    new = np.linalg.norm(turned, axis=1)
    # Lengths carry shares, heights and leans, which the scale of an actor must not change.
    turned *= (sizes / np.where(new > 0, new, 1.0))[:, np.newaxis]
    scale = float(np.abs(turned).max(initial=0.0) or 1.0) / 32767
    return _packed(np.rint(turned / scale), "i2") | {"scale": scale}


def _bar(title: str, table: pv.LookupTable) -> dict[str, object]:
    """Return a scalar bar: its colours from left to right, and three numbers, or names of kinds."""
    low, high = table.GetTableRange()
    logarithmic = bool(table.GetScale())
    # Halfway along a logarithmic bar is the geometric mean.
    middle = float(np.sqrt(low * high)) if logarithmic else (low + high) / 2
    every = np.asarray(table.values)[:, :3]
    # A bar on a page is a gradient, which needs fewer colours than a table has.
    count = len(every)
    chosen = every[np.linspace(0, count - 1, min(COLORS, count)).astype(int)]
    colors = ["#" + bytes(color).hex() for color in chosen.astype(np.uint8)]
    marks = list(zip((0.0, 0.5, 1.0), numerals((low, middle, high)), strict=True))
    if count <= CLASSES:
        # Classes have each a part of the bar, and kinds, from half below the first, a number.
        ends = [f"{100 * i / count:g}%" for i in range(count + 1)]
        colors = [
            f"{color} {a} {b}"
            for color, (a, b) in zip(colors, itertools.pairwise(ends), strict=True)
        ]
        if count == high - low and low % 1 == 0.5:
            kinds = [low + 0.5 + i for i in range(count)]
            names = dict(annotated(table))
            words = [names.get(*each) for each in zip(kinds, numerals(kinds), strict=True)]
            marks = [((i + 0.5) / count, word) for i, word in enumerate(words)]
    return {"title": title, "colors": colors, "marks": marks}


def _gradient(bar: MarginBar) -> dict[str, object]:
    """Return a bar of the margin as the page has it."""
    colors = [f"#{bytes(color).hex()} {100 * place:.4g}%" for place, color in bar.colors]
    # Of neighbours of one colour the first and the last are a gradient.
    kept = [
        stop
        for i, stop in enumerate(colors)
        if not 0 < i < len(colors) - 1 or bar.colors[i - 1][1] != bar.colors[i + 1][1]
    ]
    return {"title": bar.heading, "colors": kept, "marks": bar.marks}


__all__ = ["live_html"]

#: File name extensions of a page.
SUFFIXES = (".html", ".htm")
#: Parts of the script, in their order, and the name of its file beside a page.
SCRIPTS, SCRIPT = ("gl.js", "app.js", "copied.js", "panel.js"), "viewer.js"


def live_html(
    mesh: pv.DataSet | pv.MultiBlock | Mapping[float, pv.DataSet | pv.MultiBlock],
    /,
    path: str | Path,
    *,
    scene: AnyScene | None = None,
    title: str = "",
    light: LightAt = "auto",
    scalars: str | None = None,
    camera: pv.Camera | None = None,
    background: ColorLike | None = None,
    panel: bool = True,
    key: bool = True,
    frames: str = "frame",
    files: Literal[1, 2] = 1,
    source: Sequence[str] = (),
    **options: Given,
) -> Path:
    """Write one HTML file that shows a mesh in light that follows the eye of the reader.

    The file opens from disk and makes no network request. The light of each fragment is computed
    in the browser, by the same text as in a plotter. A panel drags lamps over a lit ball, takes
    light by question, moves material, colours and a cut, goes back, and copies the picture as
    Python or as a command. The page turns by mouse, touch and arrow keys.

    Parameters
    ----------
    mesh : pyvista.DataSet, pyvista.MultiBlock or mapping
        Mesh, which is not changed. Each block has a name in the page and can be switched off. A
        mapping has a mesh for each number, such as the levels of an isosurface or the steps of a
        time: a slider shows one of them.
    path : path
        Path of the file, which ends in .html or .htm. An existing file is replaced.
    scene : Scene or str, optional
        Lights, material and depth cue; the reader's eye takes the place of its view. Default: the
        record of a lit mesh, otherwise PyVista's lights.
    title : str, default: ""
        Title of the page.
    light : {"auto", "points", "fragments"}
        Place where the light is computed. Where the light of a fragment cannot be computed, and
        with "points", the colours of the points have ambient and diffuse light, which does not
        depend on the eye; a notice on the page and a warning say so. For an eye in *n*-space, which
        is not the reader's, they have the whole light.
    scalars : str, optional
        Name of the array that gives the colours, as for ``plotter.vizlight.add_mesh``.
    camera : pyvista.Camera, optional
        First camera. Default: the view of the scene or of the mesh's record, otherwise one that
        shows the whole mesh.
    background : colour, optional
        Background colour. Default: black for lines or points alone, otherwise white.
    panel : bool, default: True
        Whether the panel is open at first.
    key : bool, default: True
        Whether the key is shown where the light comes from a preset; scalar bars are shown always.
    frames : str, default: "frame"
        Name of the numbers of a mapping, such as ``"time in s"``.
    files : {1, 2}
        2 writes the script to ``viewer.js`` beside the page, for servers with the policy
        ``script-src 'self'``.
    source : sequence of str, optional
        File that the mesh was read from and options of ``vizlight light`` that light it as here,
        for the texts that the page copies.
    **options
        As for ``plotter.vizlight.add_mesh``: options of :func:`vizlight.illuminate`, such as
        ``tangents=`` and ``conditioned=``, and keywords of ``pyvista.Plotter.add_mesh``, such as
        ``cmap``, ``clim``, ``opacity`` and ``line_width``.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, as for :func:`vizlight.illuminate`.
    FileError
        If the file cannot be written.

    Warns
    -----
    UserWarning
        If the light of a mesh does not follow the eye, with the reason.

    See Also
    --------
    vizlight.draw.component.Component.export_html : The same for the meshes of a plotter.

    Notes
    -----
    The page is 80 kB and, before compression, 40 bytes for each point with position, normal,
    tangent and colour: positions in 24 bits from the centre of the scene, with a rounding of 6e-8
    of their largest coordinate, directions in 16 bits, with a rounding of 3e-5, and up to six
    arrays in 16 bits of their range. Differences from point to point are compressed, to about a
    third. In Chromium the picture is within a mean of 1 of 255 of the light of the engine, 99 % of
    it within 4. Where something draws, the page has a picture for browsers without WebGL 2.
    """
    path = check_output(path, SUFFIXES)
    _check.instance("camera", camera, pv.Camera | None, "a pyvista.Camera")
    _check.integer("files", files, low=1, high=2)
    _check.text("frames", frames)
    steps: dict[float, Foreign] = dict(mesh) if isinstance(mesh, Mapping) else {0.0: mesh}
    if not steps:
        raise _check.value_error("mesh", "one mesh or more", "an empty mapping")
    values = [_check.number("mesh", value) for value in steps]
    plotter: Foreign = pv.Plotter(off_screen=True, notebook=False)
    with contextlib.closing(plotter):
        chosen = _check.color("background", background)
        owners: list[int | None] = []
        for number, step in enumerate(steps.values()):
            actors = plotter.vizlight.add_mesh(
                step, scene=scene, light=light, scalars=scalars, render=False,
                **_lit_points(step) | options,
            )  # fmt: skip
            count = len(actors) if isinstance(actors, list) else 1
            owners += [number if len(steps) > 1 else None] * count
        every = [block for step in steps.values() for block in blocks.all_blocks(step)]
        plotter.background_color = chosen or backdrop(every)
        if camera is None:
            _look(plotter, next(iter(steps.values())), scene)
        else:
            plotter.camera = camera.copy()  # type: ignore[no-untyped-call]
        shown = plotter.vizlight.shown()
        if len(owners) == len(shown):
            shown = [item._replace(frame=frame) for item, frame in zip(shown, owners, strict=True)]
        label = (frames, values) if len(steps) > 1 else None
        return write_page(
            path, shown, plotter, title=title, panel=panel, key=key, frames=label, files=files,
            source=source, auto=chosen is None and plotter.background_color == "white",
        )  # fmt: skip


def _lit_points(mesh: pv.DataSet | pv.MultiBlock) -> Keywords:
    """Return an option of light, its default, for points that PyVista alone would draw."""
    every = [*blocks.all_blocks(mesh)]
    clouds = [block for block in every if is_cloud(block, {})]
    alone = len(clouds) == len(every)
    return {"facing": "auto"} if clouds and (alone or all(map(is_scan, clouds))) else {}


def _look(plotter: Foreign, mesh: pv.DataSet | pv.MultiBlock, scene: AnyScene | None) -> None:
    """See all that is drawn from where the view of a scene, or of the mesh's record, is."""
    scene = optional_scene(scene)
    if scene is None and relight.is_lit(mesh):
        scene = Scene.from_dict(records.provenance(mesh, DEFAULT_NAME)["scene"])
    view = None if scene is None or scene.n not in (None, 3) else scene.view
    if view is None:
        plotter.view_isometric(render=False)
        return
    middle = np.reshape(plotter.bounds, (3, 2)).mean(axis=1)
    toward = view.direction or np.subtract(view.position or middle, middle).tolist()
    up = view.up or ((0.0, 1.0, 0.0) if not np.any(toward[:2]) else (0.0, 0.0, 1.0))
    plotter.camera.parallel_projection = view.parallel
    plotter.view_vector(toward, up, render=False)
    if view.position is not None:
        plotter.camera.position, plotter.camera.focal_point = view.position, middle.tolist()


def write_page(
    path: str | Path,
    shown: Sequence[PageMesh],
    plotter: pv.BasePlotter,
    *,
    files: Literal[1, 2] = 1,
    **content: Given,
) -> Path:
    """Write the page of meshes with live light; see :func:`page_text`."""
    path = check_output(path, SUFFIXES)
    beside = path.with_name(SCRIPT)
    text = page_text(shown, plotter, stem=path.stem, script=SCRIPT if files == 2 else "", **content)
    if files == 2:
        replace_file(beside, lambda draft: Path(draft).write_text(viewer(), "utf-8"))
    return replace_file(path, lambda draft: Path(draft).write_text(text, "utf-8"))


def page_text(
    shown: Sequence[PageMesh],
    plotter: pv.BasePlotter,
    *,
    stem: str = "scene",
    title: str = "",
    panel: bool = True,
    key: bool = True,
    frames: tuple[str, Sequence[float] | Sequence[str]] | None = None,
    source: Sequence[str] = (),
    auto: bool = False,
    script: str = "",
) -> str:
    """Return the text of a page of meshes with live light.

    ``stem`` is the name of the pictures that a reader saves. ``panel`` and ``key`` say whether the
    panel is open at first, and whether the key of a preset's light is shown. ``frames`` is the name
    of the numbers of the frames, and the numbers; two names in their place are frames that are seen
    at once, left and right of a divider, on a page without a panel. ``source`` is the file, and
    options of the command that lights it alike. With ``auto`` nobody chose the background, which is
    dark then on dark pages. ``script`` is the file of the script; empty for one within the page.
    """
    _check.text("title", title)
    panel, key = _check.boolean("panel", panel), _check.boolean("key", key)
    _check.instance("source", source, list | tuple, "a list of the words of a command")
    page = Page(plotter.renderer)
    for each in shown:
        page.add(each)
    split = frames is not None and isinstance(frames[1][0], str)
    if not split:
        page.add_values(shown)  # for the panel
    page.add_bars(plotter, shown)
    margin = plotter.vizlight.margin
    if margin is not None and key:
        title = title or margin.title
        page.bars += [_gradient(bar) for bar in margin.bars]
    if source:
        file, *words = [str(word) for word in source]
        # The vectors that a file has are not lit where the page lights a surface.
        tangents = any(word.startswith("--tangents") for word in words)
        meshes = [each.live.drawn for each in shown if each.live is not None]
        faces = all(mesh.n_cells and mesh.max_cell_dimensionality > 1 for mesh in meshes)
        plain = faces and not tangents
        page.recipe |= {"file": file, "command": words, "plain": plain}
    first = next((each.live for each in shown if each.live is not None), None)
    question = None if first is None or not key else _question_of(first)
    content = page.content() | {
        "name": title or stem, "stem": stem, "panel": panel, "frame": 0,
        "frames": None if frames is None else {"label": frames[0], "values": list(frames[1])},
        "key": None if question is None else list(question.words),
        "form": None if question is None else question.key, "auto": auto,
    }  # fmt: skip
    text = string.Template(_web("page.html")).substitute(
        title=html.escape(title or "vizlight"),
        heading=html.escape(title or "Scene"),
        # For readers of the screen alone.
        unseen="" if title else ' class="unseen"',
        label=html.escape(title or "Scene", quote=True),
        policy="'self'" if script else "'unsafe-inline'",
        picture=_picture(plotter, shown, split=split),
        # A tag within the text would end the script.
        scene=json.dumps(content, allow_nan=False).replace("<", "\\u003c"),
        script=f'<script src="{script}"></script>' if script else f"<script>{viewer()}</script>",
    )
    for notice in page.notices:
        _check.warn(notice)
    return text


@functools.cache
def viewer() -> str:
    """Return the script of all pages, without comments and indentation."""
    # Spaces after marks are for who reads the style.
    style = (
        re.sub(r"\s*([{};,>])\s*", r"\1", _web("page.css")).replace(": ", ":").replace(";}", "}")
    )
    parts = [f"const STYLE = {json.dumps(style)};", *map(_web, SCRIPTS)]
    text = _bare("\n".join(parts)).replace("</script", "<\\/script")
    return f"'use strict';\n(() => {{\n{text}\n}})();\n"


#: Words of the script that stay as they are, and signs with the spaces around them.
_PARTS = re.compile(
    r"""('(?:\\.|[^'\\])*'|"(?:\\.|[^"\\])*"|`(?:[^`$]|\$(?!{)|\${(?:[^`}]|`[^`]*`)*})*`"""
    r"""|(?<=\()/(?:\\.|[^/\\\n])+/)"""
    r"""|[ ]*// [^\n]*|[ ]*(=>|[-+*/]=|[=!]==|&&|\|\||\?\?|[<>=]=|[-+*/%=<>?:,;{}()&|])[ ]*"""
)


def _bare(text: str) -> str:
    """Return a script without comments of whole lines, indentation and spaces around signs."""
    lines = (line.strip() for line in text.splitlines())
    kept = "\n".join(line for line in lines if line and not line.startswith("// "))
    return _PARTS.sub(lambda part: part[1] or part[2] or "", kept)


def _picture(plotter: pv.BasePlotter, shown: Sequence[PageMesh], *, split: bool) -> str:
    """Return an element with the picture of a plotter, empty where nothing draws yet."""
    try:
        backends.choose_backend()
        seen = np.asarray(plotter.screenshot(None, return_img=True))[..., :3]
        if split:
            middle = seen.shape[1] // 2
            left, right = (_picture_of(plotter, shown, frame) for frame in (0, 1))
            seen = np.hstack([left[:, :middle], right[:, middle:]])
    except (backends.BackendError, AttributeError):
        # A plotter with a window on a screen has no picture before it is shown.
        return ""
    file = io.BytesIO()
    Image.fromarray(seen).convert("RGB").save(file, "JPEG", quality=70)
    data = base64.b64encode(file.getvalue()).decode()
    return f'<img id="picture" alt="The scene" src="data:image/jpeg;base64,{data}">'


def _picture_of(plotter: pv.BasePlotter, shown: Sequence[PageMesh], frame: int) -> Raw:
    """Return the picture of one frame, without bars, which a page has at its border."""
    hidden = [each.actor for each in shown if each.frame not in (None, frame)]
    hidden += plotter.scalar_bars.values()
    try:
        for actor in hidden:
            actor.SetVisibility(False)
        plotter.render()
        return np.array(plotter.screenshot(None, return_img=True))[..., :3]
    finally:
        for actor in hidden:
            actor.SetVisibility(True)


def _question_of(live: Live) -> Question | None:
    """Return the question of the key that is shown, where the light comes from a preset."""
    if live.scene is None or live.scalars is not None:
        return None
    question = QUESTIONS.get(preset_of(live.scene) or "")
    return None if question is None or question.key == "colors" else question


def _web(name: str) -> str:
    return resources.files("vizlight.draw").joinpath("web", name).read_text("utf-8")
