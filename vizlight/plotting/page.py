"""The content of a page: meshes, lights and scalar bars of a plotter, as JSON has them."""

from __future__ import annotations

import base64
import dataclasses
import zlib
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv

from vizlight.filters.tint import map_colors
from vizlight.mesh import hull
from vizlight.plotting import dialects, program
from vizlight.plotting.fixed import LEFT_OUT, fixed_colors, lit_colors
from vizlight.plotting.fragments import Fragments, exact_plan, without_highlight
from vizlight.plotting.live import NORMALS, TANGENTS, items
from vizlight.scene import DepthCue, Light, Scene, View
from vizlight.scene.light import WHITE
from vizlight.scene.vtk import lights_of
from vizlight.shading.display import NO_DATA_NAME

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from vtkmodules.vtkRenderingCore import vtkActor, vtkRenderer

    from vizlight._types import Array, Indices
    from vizlight.plotting.live import Live

#: Largest number of colours of a scalar bar.
COLORS = 64
#: Cells by their names in vtk.js and in PyVista.
_CELLS = {"verts": "verts", "lines": "lines", "polys": "faces", "strips": "strips"}
#: Numbers that neither the eye nor a slider changes.
_CONSTANT = ("vizFurRate", "vizTallest", "vizCue", "vizLeastGain", "vizColorGain")


class Shown(NamedTuple):
    """A drawn mesh with live light, and its name in the panel of the page."""

    name: str
    live: Live
    actor: vtkActor


class Page:
    """What the page holds, as JSON has it."""

    def __init__(self, renderer: vtkRenderer) -> None:
        self.renderer, self.camera = renderer, renderer.GetActiveCamera()
        self.background = list(renderer.GetBackground())
        #: Point from which all places are measured, so that float32 has digits for them.
        self.origin = np.asarray(self.camera.GetFocalPoint(), dtype=np.float64)
        self.meshes: list[dict[str, object]] = []
        self.lights: list[list[dict[str, object]]] = []
        self.bars: list[dict[str, object]] = []
        self.notices: list[str] = []

    def content(self) -> dict[str, object]:
        """Return the whole page."""
        camera = self.camera
        return {
            "background": self.background,
            "camera": {
                "position": self.moved(camera.GetPosition()),
                "focal": self.moved(camera.GetFocalPoint()),
                "up": list(camera.GetViewUp()),
                "angle": camera.GetViewAngle(),
                "parallel": bool(camera.GetParallelProjection()),
                "scale": camera.GetParallelScale(),
            },
            "lights": self.lights,
            "meshes": self.meshes,
            "bars": self.bars,
            "notices": self.notices,
        }

    def moved(self, point: Sequence[float]) -> list[float]:
        """Return a point as measured from the origin of the page."""
        found: list[float] = (np.asarray(point, dtype=np.float64) - self.origin).tolist()
        return found

    def add(self, shown: Shown) -> None:
        """Add a mesh with its light."""
        live, actor = shown.live, shown.actor
        surface, ids = _surface(live)
        prop = actor.GetProperty()
        made: dict[str, object] = {
            "name": shown.name,
            "color": list(prop.GetDiffuseColor()),
            "opacity": prop.GetOpacity(),
            "lineWidth": prop.GetLineWidth(),
            "pointSize": prop.GetPointSize(),
            "representation": prop.GetRepresentation(),
        }
        if prop.GetEdgeVisibility():
            self.notices.append(f"{shown.name}: the page does not draw the edges of cells")
        matrix: Array = np.asarray(pv.array_from_vtkmatrix(actor.GetMatrix()), np.float64)
        with np.errstate(invalid="ignore", over="ignore"):  # points that are not finite
            points = np.asarray(surface.points, dtype=np.float64) @ matrix[:3, :3].T
            made["points"] = _places(points + matrix[:3, 3] - self.origin)
        for key, name in _CELLS.items():
            cells = np.asarray(getattr(surface, name))
            if len(cells):
                made[key] = _packed(cells, "u4")
        scene = live.scene_of(self.renderer, actor)
        if isinstance(live.painter, Fragments):
            made |= self._followed(live, live.painter, scene, actor, matrix)
        else:
            made |= self._fixed(shown, scene, ids)
        self.meshes.append(made)

    def _followed(
        self, live: Live, painter: Fragments, scene: Scene, actor: vtkActor, matrix: Array
    ) -> dict[str, object]:
        """Return the light in fragments: text, numbers, tangents and normals."""
        lights, rows = self._lights_of(live, scene)
        prop = actor.GetProperty()
        whole = dataclasses.replace(scene.material, diffuse=1.0, specular=1.0)
        # Sliders raise what is 0 now, so the text has all terms.
        scene = scene.replace(lights=lights, material=whole, depth_cue=_ended(scene.depth_cue))
        data = live.scalars is not None
        if data:
            scene = without_highlight(scene)
        plan = exact_plan(scene, live.source)
        shown = program.Shown(specular_color=prop.GetSpecularColor())
        fixed = [light.seen_from(scene.view) for light in scene.lights]
        given = program.numbers(
            scene, fixed, shown=shown, fur=plan.fur, tallest=painter.tallest, data=data
        )
        written = program.write(plan, turned=live.source.sided is not None, data=data)
        shader = dialects.VTK_JS.replacements(written, given)
        made: dict[str, object] = {
            "live": True,
            "lights": self._set_of(rows),
            "shader": [list(replacement) for replacement in shader],
            "numbers": {n.name: list(n.value) for n in given if n.name in _CONSTANT},
            "material": {
                name: getattr(live.scene_of(self.renderer, actor).material, name)
                for name in ("ambient", "diffuse", "specular", "shininess")
            },
            "ambientColor": [scene.ambient_intensity * c for c in scene.ambient_color or WHITE],
            "specularColor": list(prop.GetSpecularColor()),
        }
        cue = live.scene_of(self.renderer, actor).depth_cue
        if cue is not None:
            made["cue"] = {
                "front": cue.front, "back": cue.back, "scales": [cue.front_scale, cue.back_scale]
            }  # fmt: skip
        arrays, linear = live.drawn.point_data, matrix[:3, :3]
        if TANGENTS in arrays and (plan.occluded or not plan.surface):
            made["tangents"] = _directions(arrays[TANGENTS], linear.T)
        if NORMALS in arrays and (plan.surface or plan.conditioned or plan.fur):
            made["normals"] = _directions(arrays[NORMALS], np.linalg.inv(linear))
        if live.scalars is not None:
            of_cells = live.scalars not in arrays
            values = live.drawn.cell_data[live.scalars] if of_cells else arrays[live.scalars]
            made |= {"colors": _packed(_mapped(values, actor), "u1"), "ofCells": of_cells}
        return made

    def _fixed(self, shown: Shown, scene: Scene, ids: Indices) -> dict[str, object]:
        """Return colours with the light that does not depend on the eye."""
        live, actor = shown.live, shown.actor
        placed = live.source._replace(inputs=live.placed(actor))
        colors = None
        if live.scalars is not None:
            colors = _mapped(live.drawn.point_data[live.scalars], actor)
        if live.own_eye:
            whole = lit_colors(placed, scene, colors)[ids]
            return {"live": False, "colors": _packed(whole, "u1"), "color": [1.0, 1.0, 1.0]}
        lit, seen = fixed_colors(placed, scene, colors)
        lit = lit[ids]
        lit[ids < 0] = 0
        reason = getattr(live.painter, "reason", "")
        why = "" if reason == "asked for" else f", because {reason}"
        said = f"; {seen} as from the first view" if seen else ""
        self.notices.append(
            f"{shown.name}: the light does not follow the eye{why}; {LEFT_OUT}{said}"
        )
        return {"live": False, "colors": _packed(lit, "u1"), "color": [1.0, 1.0, 1.0]}

    def _lights_of(self, live: Live, scene: Scene) -> tuple[list[Light], list[dict[str, object]]]:
        """Return the lights of a mesh, and what the page moves them by."""
        pairs = [(light, light.follows_view) for light in scene.lights]
        if live.scene is None:
            pairs = [
                (light, light.follows_view or bool(own.LightTypeIsCameraLight()))
                for own in items(self.renderer.GetLights())
                for light in lights_of([own], self.camera)
            ]
        own = self.camera.GetViewTransformMatrix()
        matrix: Array = np.asarray(pv.array_from_vtkmatrix(own), np.float64)
        lights, rows = [], []
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
            lights.append(light)
            rows.append({
                "value": value.tolist(), "position": at, "eye": follows,
                "intensity": light.intensity, "color": list(light.color or WHITE),
                "attenuation": list(light.attenuation),
            })  # fmt: skip
        return lights, rows

    def _set_of(self, rows: list[dict[str, object]]) -> int:
        """Return the index of a set of lights, which meshes share."""
        if rows not in self.lights:
            self.lights.append(rows)
        return self.lights.index(rows)

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
                    grey = "#" + bytes(round(255 * c) for c in table.GetNanColor()[:3]).hex()
                    self.bars.append({"title": NO_DATA_NAME, "colors": [grey, grey], "numbers": []})


def _surface(live: Live) -> tuple[pv.PolyData, Indices]:
    """Return what is drawn as cells of PolyData, and the index of each of its points."""
    if isinstance(live.drawn, pv.PolyData):
        return live.drawn, np.arange(live.drawn.n_points)
    return hull.outer_surface(live.drawn)


def _ended(cue: DepthCue | None) -> DepthCue | None:
    """Return a depth cue with ends; the page finds those that are not given."""
    if cue is None or (cue.front is not None and cue.back is not None):
        return cue
    return dataclasses.replace(cue, front=0.0, back=1.0)


def _packed(values: NDArray[np.generic], kind: str) -> dict[str, object]:
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


def _mapped(values: NDArray[np.generic], actor: vtkActor) -> NDArray[np.uint8]:
    """Return the colours of values, as the mapper has them."""
    if np.ndim(values) == 2:
        # PyVista keeps colours of its own for an opacity of each point.
        return np.asarray(values, dtype=np.uint8)
    return map_colors(actor.GetMapper().GetLookupTable(), values)


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
        "numbers": [f"{x:.3g}" for x in (low, middle, high)],
    }
