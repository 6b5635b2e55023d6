"""From the options of a command to those of a look."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import vizlight
from vizlight._questions import QUESTIONS
from vizlight._words import numbers, value_error
from vizlight.cli import options
from vizlight.cli.options import SurfacePart
from vizlight.looks.steps import Step

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    import pyvista as pv

    from vizlight._types import Foreign, Keywords, Vector
    from vizlight.cli.options import Color, Common, FilePart, Finish, Lights
    from vizlight.looks.wishes import SceneMaker, Wishes
    from vizlight.scene import Scene


def wishes_of(
    common: Common,
    part: FilePart | None = None,
    color: Color | None = None,
    *,
    question: str = "auto",
    light: Mapping[str, object] | None = None,
    material: Mapping[str, float] | None = None,
) -> Wishes:
    """Return the options of the look of a command; those that need no mesh are checked.

    ``--for`` counts before ``question``; ``light`` has options of the filter that lights, and
    ``material`` the coefficients of the command's material where the user names none.
    """
    from vizlight.looks.options import checked
    from vizlight.looks.wishes import Wishes

    lights, eye, out = common.lights, common.eye, common.out
    for name in ("light", "light_position", "headlight"):
        if lights.question is not None and getattr(lights, name):
            got = f"--{name.replace('_', '-')} beside it"
            raise value_error("--for", "lights of its own", got, "leave one out")
    picture: Keywords = given_options(
        background=out.background,
        line_width=None if out.line_width == 1 else out.line_width,
        backend=out.backend,
        key=None if lights.key else False,
        progress=out.progress or None,
        map_parts=out.map_parts,
        title=out.title,
        frames=out.frames,
        fps=out.fps,
    )
    array = None
    if color is not None:
        array = color.array
        picture |= given_options(scalars=color.scalars, cmap=color.cmap)
        preset = QUESTIONS.get(lights.question or "")
        if preset is not None and preset.by_hue and color.scalars is not None:
            expected = "no --scalars beside it, whose hues would hide the hues of the light"
            raise value_error(f"--for {lights.question}", expected, f"--scalars {color.scalars}")
    scene = None if lights.scene is None else _scene_of(lights.scene)
    seen = given_options(
        up=None if eye.up is None else options.vector("up", eye.up),
        parallel=eye.parallel or None,
        zoom=None if eye.zoom == 1 else eye.zoom,
    )
    view = _view_of(eye.view, scene, seen)
    return Wishes(
        question=(lights.question or "auto") if question == "auto" else question,
        array=array,
        view=view,
        size=options.pixels(out.size),
        style=out.style,
        part={} if part is None else _part_of(part),
        light=dict(light or {}),
        eye=seen,
        picture=checked(picture),
        make_scene=_scene_maker(
            lights, common.finish, scene, dict(material or {}), filtered=question != "auto"
        ),
        surface=getattr(part, "surface", True),
    )


def _part_of(part: FilePart) -> Keywords:
    """Return the options of the part of the data, with their texts read."""
    from vizlight.looks.options import checked

    taken = given_options(
        time=part.time, overlay=part.overlay, nodata=part.nodata, contour=part.contour,
        level=part.level, threshold=part.threshold, clip=part.clip,
    )  # fmt: skip
    if part.at:
        taken["at"] = dict(options.place("at", text) for text in part.at)
    if isinstance(part, SurfacePart):
        taken |= given_options(
            warp=part.warp, exaggeration=part.exaggeration, globe=part.globe, slice=part.slice
        )
    return checked(taken)


def times(file: Path, part: FilePart) -> list[float | str | None]:
    """Return the times of the steps of a file that are lit one by one."""
    from vizlight.reading import series

    if part.times is None:
        text = part.time
        number = numbers(text or "", (1,))
        return [*number] if number else [text]
    expected = "all, or indices of steps FIRST:END or FIRST:END:STEP, beside no --time"
    steps = series.of(vizlight.read(file))
    try:
        indices = slice(None)
        if part.times != "all":
            indices = slice(*(int(end) if end else None for end in part.times.split(":")))
        chosen = steps[indices] if part.time is None else []
    except (TypeError, ValueError):
        chosen = []
    if not chosen:
        raise value_error("--times", expected, f"{part.times!r} for {len(steps)} steps")
    return [*chosen]


def given_options(**values: object) -> Keywords:
    """Return the options that are not None."""
    return {name: value for name, value in values.items() if value is not None}


def _scene_maker(
    lights: Lights,
    finish: Finish,
    base: Scene | None,
    material: dict[str, float],
    *,
    filtered: bool,
) -> SceneMaker | None:
    """Return the function that makes the step of the scene of the options, None without any.

    The question of the command is that of a filter where ``filtered``, and --for names the light.
    """
    from vizlight.looks.wishes import plain_scene

    changes = given_options(**vars(finish))
    explicit = bool(lights.light or lights.light_position or lights.headlight)
    named = filtered and lights.question is not None
    if base is None and not (changes or explicit or material or lights.depth_cue or named):
        return None

    def make(question: str, view: Step, camera: Step, n: int) -> Step:
        cue = Step("", "vizlight.DepthCue", back_scale=0.5) if lights.depth_cue else None
        fresh: Keywords = dict(material) if base is None else {}
        if base is not None:
            content = Step("", ".read_text", Step("", "pathlib.Path", lights.scene))
            scene = Step("scene", "vizlight.Scene.from_dict", Step("", "json.loads", content))
            fresh = given_options(**vars(base.material)) if changes else {}
            keep_view = base.view is not None
        else:
            # Lamps that are named light a plain material, not that of a preset.
            plain = "plain" if explicit and question != "relief" else question
            if "color" in changes and plain in QUESTIONS and QUESTIONS[plain].by_hue:
                # Hues of the light would hide the colour.
                plain = "lamp"
            scene = plain_scene(lights.question or plain, view, camera, n)
            keep_view = True
            if changes and not fresh:
                fresh = given_options(**vars(scene.run().material))
        values: Keywords = {}
        if explicit:
            values["lights"] = _lights(lights, n)
        if changes or fresh:
            values["material"] = Step("", "vizlight.Material", **(fresh | changes))
        if not keep_view:
            values["view"] = view
        values |= given_options(depth_cue=cue)
        if not values:
            return scene
        if scene.path == "vizlight.Scene":
            return Step("scene", scene.path, **(scene.keywords | values))
        return Step("scene", ".replace", scene, **values)

    return make


def _lights(lights: Lights, n: int) -> list[Step]:
    """Return the steps of the lamps of the options."""
    lamps = []
    for text in lights.light or ():
        toward = options.vector("light", text, n=n)
        lamps.append(Step("", "vizlight.Light", direction=toward))
    for text in lights.light_position or ():
        place = options.vector("light-position", text, n=n, direction=False)
        lamps.append(Step("", "vizlight.Light", position=place))
    if lights.headlight:
        lamps.append(Step("", "vizlight.Light.headlight"))
    return lamps


def _view_of(view: str | None, scene: Scene | None, seen: Keywords) -> object:
    """Return the direction toward the eye, or a camera, of an option or of the scene's file."""
    from vizlight.looks.wishes import VIEWS

    if view is None:
        return None if scene is None or scene.view is None else _view_of_scene(scene, seen)
    if view.lower().endswith(".json"):
        return _saved_camera(view)
    if view in VIEWS:
        return view
    if (names := view.split(",")) and all(name in VIEWS for name in names):
        return names
    # In n-space the eye has n components.
    toward = numbers(view, tuple(range(3, 100)))
    if not any(toward):
        expected = f"one of {', '.join(VIEWS)}, numbers x,y,z that are not all zero, or a JSON file"
        raise value_error("--view", expected, repr(view))
    return toward


def _view_of_scene(scene: Scene, seen: Keywords) -> object:
    view = scene.view
    assert view is not None
    if view.direction is None:
        remedy = "give the view a direction too, or pass --view"
        raise value_error("--scene", "a view with a direction", view, remedy)
    if view.position is None or view.parallel or len(view.position) != 3:
        if view.parallel:
            seen["parallel"] = True
        return view.direction
    target = tuple(p - d for p, d in zip(view.position, view.direction, strict=True))
    return _camera(view.position, target, None)


def _saved_camera(file: str) -> pv.Camera:
    """Return a camera of a file."""
    from pathlib import Path

    from vizlight import _check

    saved = _json("view", Path(file))
    try:
        position, focus, up = (_check.vector("view", part) for part in saved)
        if {len(position), len(focus), len(up)} != {3} or position == focus or not any(up):
            raise ValueError
    except (TypeError, ValueError) as error:
        expected = "a JSON list of the camera's position, focal point and direction up"
        raise value_error("--view", expected, f"'{file}'") from error
    return _camera(position, focus, up)


def _camera(position: Vector, focus: Vector, up: Vector | None) -> pv.Camera:
    import pyvista as pv

    along_z = not any(p - f for p, f in zip(position[:2], focus[:2], strict=True))
    camera = pv.Camera()  # type: ignore[no-untyped-call]
    camera.position, camera.focal_point = position, focus
    camera.up = up or ((0.0, 1.0, 0.0) if along_z else (0.0, 0.0, 1.0))
    return camera


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
        raise value_error(f"--{option}", "a JSON file", f"'{path}' ({reason})") from error
