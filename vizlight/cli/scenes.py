"""Steps that every command shares: read a file, take a surface, set a camera, make a scene."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import TYPE_CHECKING

import vizlight
from vizlight._words import message, one_of
from vizlight.cli import options
from vizlight.cli.options import Shape
from vizlight.looks.steps import Step

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import TypeAlias

    import pyvista as pv

    from vizlight._types import Foreign, Given, Keywords, Vector
    from vizlight.cli.options import Color, Common, Part
    from vizlight.scene import Scene, View

    #: Position, focal point and direction up of a camera that no mesh changes.
    Fixed: TypeAlias = tuple[Vector, Vector, Vector | None]

#: Direction toward the eye where none is given: of anything, and of a map.
VIEW, MAP = (1.0, 1.0, 1.0), (0.0, 0.0, 1.0)
#: Bounding box that shows where a camera looks.
BOX = (-1, 1, -1, 1, -1, 1)
#: Name of the array of colours times light.
TINT = "tint"
#: Name that stands for the direction of lines among the arrays that colour a picture.
DIRECTION = "direction"
#: Angle of view, in degrees.
ANGLE = 30.0


def check_target(target: Part, *, raised: bool = False) -> None:
    """Check the options of a target that need no mesh, whether or not it has heights."""
    together = [("level", target.level, "contour", target.contour)]
    if isinstance(target, Shape):
        if not raised:
            together.append(("exaggeration", target.exaggeration, "warp", target.warp))
        if target.slice is not None and target.contour is not None:
            raise ValueError(message("--slice", "no --contour beside it", "both"))
    for option, value, needs, given in together:
        if value is not None and given is None:
            raise ValueError(message(f"--{option}", f"--{needs} with it", "it alone"))


def times(file: Path, target: Part) -> list[float | str | None]:
    """Return the times of the steps of a file that are lit one by one.

    Raises
    ------
    ValueError
        If the file has none of them.
    """
    from vizlight.mesh import series

    if target.times is None:
        text = target.time
        number = options.numbers(text or "", (1,))
        return [*number] if number else [text]
    expected = "all, or indices of steps FIRST:END or FIRST:END:STEP, beside no --time"
    there = series.of(vizlight.read(file))
    try:
        asked = slice(None)
        if target.times != "all":
            asked = slice(*(int(end) if end else None for end in target.times.split(":")))
        found = there[asked] if target.time is None else []
    except (TypeError, ValueError):
        found = []
    if not found:
        got = f"{target.times!r} for {len(there)} steps"
        raise ValueError(message("--times", expected, got))
    return [*found]


def data(file: Path, target: Part, time: float | str | None = None) -> Step:
    """Return the step that reads a file, after those that raise and cut what is in it."""
    from vizlight.mesh import series

    mesh = Step("data", "vizlight.read", file, **known(time=time, overlay=target.overlay))
    mesh.note = "" if time is not None else series.note(mesh.run())
    if isinstance(target, Shape) and target.warp is not None:
        mesh = warped("raised", mesh, target.warp, target.exaggeration)
    for text in target.threshold or ():
        mesh = _threshold(mesh, text)
    for text in target.clip or ():
        mesh = _cut("clipped", "clip", mesh, text)
    return _stretched(mesh) if isinstance(target, Shape) and target.slice is None else mesh


def _stretched(mesh: Step) -> Step:
    """Return the step that makes a volume over a map as high as can be seen, where it is needed.

    Planes that cut it are in the coordinates of its file, so they come before.
    """
    from vizlight.mesh import georeference

    factor = georeference.stretch(mesh.run())
    if factor == 1:
        return mesh
    step = Step("stretched", "files.stretched", mesh, factor)
    step.note = f"the volume is in metres over its map, its z taken {factor:g} times"
    return step


def warped(name: str, mesh: Step, heights: str, factor: float | None) -> Step:
    """Return the step that raises a mesh by heights, by a factor with which they can be seen."""
    from vizlight.mesh import georeference, records

    step = Step(name, "files.warped", mesh, heights, 1.0 if factor is None else factor)
    found = records.averaged(mesh.run(), heights)
    if factor is None and heights in found.point_data and found.point_data[heights].ndim == 1:
        factor = georeference.exaggeration(found, heights)
        step.arguments = (mesh, heights, factor)
        step.note = (
            f"heights are taken {factor:g} times; --exaggeration 1 takes them as they are"
            if factor != 1
            else ""
        )
    return step


def joined(mesh: Step, names: object) -> Step:
    """Return the step that joins arrays U,V or U,V,W, one for each component, to vectors."""
    found = mesh.run()
    every = names.split(",") if isinstance(names, str) else []
    if len(every) not in (2, 3) or names in found.array_names:
        return mesh
    there = (*found.point_data, *found.cell_data)
    if unknown := [name for name in every if name not in there]:
        expected = f"the name of an array of vectors, or names U,V of components, {one_of(there)}"
        raise ValueError(message("arrays", expected, ", ".join(map(repr, unknown))))
    return Step("joined", "files.with_vectors", mesh, names)


def check_flow(file: Path, mesh: pv.DataSet, vectors: str | tuple[str, str] | None) -> None:
    """Check that a step has vectors that are not zero everywhere, if another step has them.

    Raises
    ------
    ValueError
        If only others have, which the message lists.
    """
    from vizlight.filters.streamlines import vectors_by_default
    from vizlight.mesh import series

    if vectors is None:
        vectors = vectors_by_default(mesh)
    names = [vectors] if isinstance(vectors, str) else vectors or ()
    times = series.of(mesh)
    if all(_moves(mesh, name) for name in names) or len(times) < 2:
        return
    others = {time: vizlight.read(file, time=time) for time in times}
    having = [time for time, one in others.items() if all(_moves(one, name) for name in names)]
    if having:
        expected = f"a step in which {' and '.join(map(repr, names))} is not zero everywhere"
        remedy = f"pass --time with one of {series.listed(having)}"
        raise ValueError(
            message("--time", expected, f"{mesh.field_data[series.TIME][0]:g}", remedy)
        )


def _moves(mesh: pv.DataSet, name: str) -> bool:
    return any(name in data and data[name].any() for data in (mesh.point_data, mesh.cell_data))


def _threshold(mesh: Step, text: str) -> Step:
    """Return the step that keeps the cells whose values are in a range."""
    name, low, high = options.interval("threshold", text)
    found = mesh.run()
    there = [*found.point_data, *found.cell_data]
    if name not in there:
        expected = f"the name of an array, {one_of(there)}"
        raise ValueError(message("--threshold", expected, repr(name)))
    # PyVista takes two ends, or one value and what of it is kept: the upper side by default.
    ends: object = (low, high)
    if math.isinf(low) or math.isinf(high):
        ends = low if math.isinf(high) else high
    side = {"method": "lower"} if math.isinf(low) else {}
    step = Step("kept", ".threshold", mesh, ends, scalars=name, **side)
    step.asked = ("--threshold", repr(text))
    return step


def _cut(name: str, option: str, mesh: Step, text: str) -> Step:
    """Return the step that cuts a mesh by a plane."""
    normal, offset = options.plane(option, text)
    # The offset is a distance, whatever the length of the normal that was given.
    length = math.hypot(*normal)
    origin = tuple(offset * component / length for component in normal)
    step = Step(name, f".{option}", mesh, normal=normal, origin=origin)
    step.asked = (f"--{option}", repr(text))
    return step


def surface(mesh: Step, target: Part) -> Step:
    """Return the step that takes the surface, an isosurface or a section of a mesh."""
    if isinstance(target, Shape) and target.slice is not None:
        return _stretched(_cut("section", "slice", mesh, target.slice))
    options = known(contour=target.contour, level=target.level)
    return Step("surface", "files.surface_of", mesh, **options)


def known(**options: object) -> Keywords:
    """Return the options that are not None."""
    return {name: value for name, value in options.items() if value is not None}


def tinted(lit: Step, name: str, data: Step, color: Color) -> tuple[Step, str]:
    """Return the step that colours a lit mesh by an array, and the words of the key of its colours.

    The colour is multiplied by the light. There are no words where the values are colours.
    """
    from numpy import isfinite

    from vizlight.shading.display import titled
    from vizlight.vtk.arrays import are_colors

    found = data.run()
    arrays = {**found.cell_data, **found.point_data}
    if color.scalars is not None and color.scalars in arrays:
        named = known(cmap=color.cmap) | {"light": name, "name": TINT}
        shown = Step("shown", "vizlight.tint", lit, color.scalars, **named)
        values = arrays[color.scalars]
        lacking = values.dtype.kind == "f" and not isfinite(values).all()
        return shown, "" if are_colors(values) else titled(color.scalars, lacking=lacking)
    if color.scalars != DIRECTION:
        expected = f"an array, {one_of([*arrays])}, or {DIRECTION!r} for lines"
        raise ValueError(message("--scalars", expected, repr(color.scalars)))
    rgb = Step("", "numpy.multiply", Step("", "vizlight.direction_colors", lit), 255)
    # The type, bytes, sets colours apart from vectors.
    bytes_ = Step("", "numpy.uint8", rgb)
    return Step("shown", "vizlight.tint", lit, bytes_, light=name, name=TINT), ""


class Look:
    """Camera and scene as the options describe them; what needs no mesh is checked first."""

    def __init__(
        self,
        common: Common,
        target: Part | None = None,
        color: Color | None = None,
        *,
        raised: bool = False,
        fill: bool = True,
        material: Mapping[str, float] | None = None,
    ) -> None:
        if target is not None:
            check_target(target, raised=raised)
        if color is not None and color.cmap is not None:
            from vizlight.filters.tint import color_table

            color_table([], cmap=color.cmap)
        self._fill, self._progress = fill, common.out.progress
        self.lights, self._eye = common.lights, common.eye
        question = self.lights.question
        for name in ("light", "light_position", "headlight", "scene"):
            if question is not None and getattr(self.lights, name):
                got = f"--{name.replace('_', '-')} beside it"
                raise ValueError(message("--for", "lights of its own", got, "leave one out"))
        self.size = options.pixels(common.out.size)
        file = common.lights.scene
        self._file = None if file is None else _scene_of(file)
        base = vizlight.Scene() if self._file is None else self._file
        if question is not None:
            base = getattr(vizlight.presets, question)()
        changes = known(**vars(common.finish))
        self._material: Step | None = None
        kept: dict[str, object] = dict(material or {})
        if self._file is not None or question is not None:
            # Who changes one coefficient keeps the others of the file or of the preset.
            kept = known(**vars(base.material)) if changes else {}
        if kept or changes:
            self._material = Step("", "vizlight.Material", **(kept | changes))
            base = base.replace(material=self._material.run())
        #: Whether the light has a colour.
        self.colored = base.colored
        #: View of the scene's file, if the picture has it.
        self._view = base.view if self._eye.view is None else None
        self._toward, self._fixed = (
            _asked_view(self._eye.view) if self._view is None else _file_view(self._view)
        )

    def step(self, name: str, filter_: str, /, *arguments: object, **given: object) -> Step:
        """Return the step that runs a filter, with a progress bar where one is asked for."""
        progress = {"progress_bar": True} if self._progress else {}
        return Step(name, f"vizlight.{filter_}", *arguments, **given, **progress)

    def camera(
        self, mesh: object, *, is_map: bool = False, by: str = "render.camera_on", **more: Given
    ) -> Step:
        """Return the step that sets the camera on a mesh by a function with options of its own."""
        eye = self._eye
        up = None if eye.up is None else options.vector("up", eye.up)
        if self._fixed is not None:
            return self._fixed_camera(self._fixed, up)
        toward = (self._toward or (MAP if is_map else VIEW))[:3]
        # A map is seen from straight above, without perspective.
        parallel = eye.parallel or (is_map and self._toward is None)
        parallel = parallel or (self._view is not None and self._view.parallel)
        given = known(up=up, parallel=parallel or None, zoom=None if eye.zoom == 1 else eye.zoom)
        aspect = self.size[0] / self.size[1]
        return Step("camera", by, mesh, toward, **more, **given, aspect=aspect)

    def _fixed_camera(self, fixed: Fixed, up: Vector | None) -> Step:
        """Return the step that sets a camera where it was saved."""
        from vizlight import _check

        position, focus, saved_up = fixed
        zoom = _check.number("zoom", self._eye.zoom, low=1e-6)
        along_z = not any(p - f for p, f in zip(position[:2], focus[:2], strict=True))
        camera = Step("camera", "pyvista.Camera")
        camera.attributes = {
            "position": position,
            "focal_point": focus,
            "up": up or saved_up or ((0.0, 1.0, 0.0) if along_z else (0.0, 0.0, 1.0)),
            "view_angle": ANGLE / zoom,
        }
        if self._eye.parallel:
            half = math.dist(position, focus) * math.tan(math.radians(ANGLE / 2))
            camera.attributes |= {"parallel_projection": True, "parallel_scale": half / zoom}
        return camera

    def scene(self, camera: Step) -> Step:
        """Return the step that makes the scene, seen by a camera."""
        shoulder = Step("", "render.over_shoulder", camera)
        return self._scene(Step("", "vizlight.View.from_camera", camera), shoulder, 3)

    def scene_in(self, n: int) -> Step:
        """Return the step that makes a scene of n-space, seen from infinity."""
        from vizlight.draw import render

        toward = self._toward or VIEW
        if self._fixed is not None:
            toward = tuple(p - f for p, f in zip(*self._fixed[:2], strict=True))
        if len(toward) not in (3, n):
            expected = "three numbers x,y,z" + f" or {n} numbers" * (n != 3)
            raise ValueError(message("--view", expected, repr(self._eye.view)))
        zeros = (0.0,) * (n - len(toward))
        up = None if self._eye.up is None else options.vector("up", self._eye.up)
        shoulder = render.over_shoulder(render.camera_on(BOX, toward[:3], up=up))
        view = Step("", "vizlight.View", direction=(*toward, *zeros))
        return self._scene(view, (*shoulder, *(0.0,) * (n - 3)), n)

    def _scene(self, view: Step, shoulder: object, n: int) -> Step:
        asked = self.lights
        cue = Step("", "vizlight.DepthCue", back_scale=0.5) if asked.depth_cue else None
        values = known(material=self._material, depth_cue=cue)
        if asked.question is not None:
            made = Step("scene", f"vizlight.presets.{asked.question}", view)
            return Step("scene", ".replace", made, **values) if values else made
        lights = []
        for text in asked.light or ():
            toward = options.vector("light", text, n=n)
            lights.append(Step("", "vizlight.Light", direction=toward))
        for text in asked.light_position or ():
            place = options.vector("light-position", text, n=n, direction=False)
            lights.append(Step("", "vizlight.Light", position=place))
        if asked.headlight:
            lights.append(Step("", "vizlight.Light.headlight"))
        if not lights and self._file is None and not self._fill:
            # The default of a scene has a second lamp at the eye, and a shadow is cast by one.
            lights = [Step("", "vizlight.Light", direction=shoulder)]
        values = known(
            lights=lights or None,
            material=self._material,
            view=view if self._view is None else None,
            depth_cue=cue,
        )
        if asked.scene is None:
            return Step("scene", "vizlight.Scene", **values)
        content = Step("", ".read_text", Step("", "pathlib.Path", asked.scene))
        read = Step("scene", "vizlight.Scene.from_dict", Step("", "json.loads", content))
        return Step("scene", ".replace", read, **values) if values else read


def check_answers(question: str | None, mesh: Step, color: Color, tangents: object) -> None:
    """Check that there is what light for a question tells of.

    Raises
    ------
    ValueError
        If the mesh has none of it, or the colours of data would hide the answer.
    """
    if question is None:
        return
    from vizlight.mesh.blocks import all_blocks

    found = list(all_blocks(mesh.run()))
    asked, needs, remedy = f"--for {question}", "", ""
    if question == "value" and color.scalars is None:
        scalars = [name for one in found for name in (*one.point_data, *one.cell_data)]
        needs = f"--scalars with it, {one_of([*dict.fromkeys(scalars)])}"
    if question in ("direction", "slope", "heading") and tangents is None:
        vectors = [
            name
            for one in found
            for name, values in one.point_data.items()
            if values.ndim == 2 and values.shape[1] == 3
        ]
        if any(one.GetMaxSpatialDimension() != 1 for one in found):
            named = one_of([*dict.fromkeys(vectors)])
            needs = f"--tangents with it where there are no lines, {named}"
            remedy = "for a surface without a flow, such as terrain, take --for shape"
    if needs:
        raise ValueError(message(asked, needs, "none", remedy))
    if question in ("direction", "heading", "shape") and color.scalars is not None:
        expected = "no --scalars beside it, whose hues would hide the hues of the light"
        raise ValueError(message(asked, expected, f"--scalars {color.scalars}"))


def _scene_of(path: Path) -> Scene:
    """Return the scene of a JSON file."""
    values = _json("scene", path)
    try:
        return vizlight.Scene.from_dict(values)
    except (TypeError, ValueError) as error:
        raise ValueError(f"--scene '{path}': {error}") from error


def _json(option: str, path: Path) -> Foreign:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise ValueError(message(f"--{option}", "a JSON file", f"'{path}' ({reason})")) from error


def _asked_view(view: str | None) -> tuple[Vector | None, Fixed | None]:
    """Return the direction toward the eye, or a camera that was saved, from an option."""
    if view is None:
        return None, None
    if view.lower().endswith(".json"):
        return None, _saved_camera(view)
    # In n-space the eye has n components.
    toward = options.numbers(view, tuple(range(4, 100)))
    return toward if any(toward) else options.vector("view", view), None


def _file_view(view: View) -> tuple[Vector | None, Fixed | None]:
    """Return the direction toward the eye, and where the camera stands if that is known."""
    if view.direction is None:
        remedy = "give the view a direction too, or pass --view"
        raise ValueError(message("--scene", "a view with a direction", view, remedy))
    if view.position is None or view.parallel or len(view.position) != 3:
        return view.direction, None
    target = tuple(p - d for p, d in zip(view.position, view.direction, strict=True))
    return view.direction, (view.position, target, None)


def _saved_camera(file: str) -> Fixed:
    """Return the position, the focal point and the direction up of a saved camera."""
    from vizlight import _check

    saved = _json("view", Path(file))
    try:
        position, focus, up = (_check.vector("view", part) for part in saved)
        if {len(position), len(focus), len(up)} != {3} or position == focus or not any(up):
            raise ValueError
    except (TypeError, ValueError) as error:
        expected = "a JSON list of the camera's position, focal point and direction up"
        raise ValueError(message("--view", expected, f"'{file}'")) from error
    return position, focus, up
