"""From a state to the steps that make its picture, which are run or written as a script."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from vizlight.cli import arguments, scenes
from vizlight.cli.script import Step, source
from vizlight.view.state import has_lines

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Vector
    from vizlight.view.state import Facts, State

__all__ = ["Eye", "any_scene", "data", "lit", "picture", "scene", "script"]


@dataclass(frozen=True)
class Eye:
    """Camera of the page.

    Parameters
    ----------
    position, focal_point, up : tuple of float
        As those of ``pyvista.Camera``.
    view_angle : float
        Opening angle in degrees.
    """

    position: Vector
    focal_point: Vector
    up: Vector
    view_angle: float

    @classmethod
    def of(cls, camera: pv.Camera) -> Eye:
        """Return the values of a camera, in as many digits as a picture shows."""
        position, focus = tuple(camera.position), tuple(camera.focal_point)
        digits = "{:.9g}".format
        places = [tuple(float(digits(x)) for x in v) for v in (position, focus, camera.up)]
        return cls(places[0], places[1], places[2], float(camera.view_angle))

    def step(self) -> Step:
        """Return the step that makes the camera."""
        made = Step("camera", "pyvista.Camera")
        made.attributes = {
            "position": self.position,
            "focal_point": self.focal_point,
            "up": self.up,
            "view_angle": self.view_angle,
        }
        return made


def data(read: Step, facts: Facts) -> Step:
    """Return the step whose mesh has the arrays at its points, after the one that reads it.

    Parameters
    ----------
    read : Step
        Step that reads the file.
    facts : Facts
        What the file offers.
    """
    return Step("averaged", ".cell_data_to_point_data", read) if facts.averaged else read


def scene(state: State, camera: Step) -> Step:
    """Return the step that makes the scene as a camera sees it.

    Parameters
    ----------
    state : State
        State of the page.
    camera : Step
        Step that makes the camera.
    """
    toward: object = Step("", "render.over_shoulder", camera)
    if not state.shoulder:
        toward = arguments.toward(state.azimuth, state.altitude)
    lights = [Step("", "vizlight.Light", direction=toward, intensity=scenes.KEY)]
    if state.fill:
        lights.append(Step("", "vizlight.Light.headlight", intensity=state.fill))
    names = ("ambient", "diffuse", "specular", "shininess")
    values: dict[str, object] = {
        "lights": lights,
        "material": Step("", "vizlight.Material", **{name: getattr(state, name) for name in names}),
        "view": Step("", "vizlight.View.from_camera", camera),
    }
    if state.cue:
        values["depth_cue"] = Step("", "vizlight.DepthCue", back_scale=1 - state.cue)
    return Step("scene", "vizlight.Scene", **values)


def any_scene() -> Step:
    """Return the step that makes a scene for a mesh whose light is to follow the camera."""
    return Step("", "vizlight.Scene", view=Step("", "vizlight.View", direction=scenes.VIEW))


def lit(state: State, facts: Facts, mesh: Step, seen: Step) -> Step:
    """Return the step that lights what is shown of a mesh.

    Parameters
    ----------
    state, facts
        State of the page, and what the file offers.
    mesh, seen : Step
        Steps that make the mesh and the scene.
    """
    given: dict[str, object] = {} if state.model == "phong" else {"model": state.model}
    if state.show == "streamlines":
        given = {"vectors": state.vectors, "seeds": state.lines} | given
        return Step("lit", "vizlight.streamlines", mesh, seen, **given)
    if state.show == "isosurface":
        options = {"contour": state.array, "level": state.level}
        surface = Step("surface", "files.surface_of", mesh, **options)
    else:
        if facts.flat and state.heights:
            mesh = Step("raised", "files.warped", mesh, state.heights, state.factor)
        surface = Step("surface", "files.surface_of", mesh)
    if state.tangents:
        given["tangents"] = state.tangents
        if state.conditioned and not has_lines(state, facts):
            given["conditioned"] = True
    # In a picture a crease is seen as one.
    return Step("lit", "vizlight.illuminate", surface, seen, feature_angle="auto", **given)


def picture(
    state: State, facts: Facts, mesh: Step, eye: Eye, size: tuple[int, int], path: Path
) -> list[Step]:
    """Return the steps that light a mesh and save its picture.

    Parameters
    ----------
    state, facts
        State of the page, and what the file offers.
    mesh : Step
        Step that makes the mesh.
    eye : Eye
        Camera.
    size : (int, int)
        Width and height in pixels.
    path : pathlib.Path
        Path of the picture.
    """
    camera = eye.step()
    light = lit(state, facts, mesh, scene(state, camera))
    shown, scalars = light, "luminance"
    if state.color:
        shown = Step("tinted", "vizlight.tint", light, state.color, cmap=state.cmap)
        scalars = "rgb"
    options = {} if state.line_width == 1 else {"line_width": state.line_width}
    panel = Step("", "render.Panel", shown, scalars)
    return [light, Step("", "render.save_png", panel, path, camera=camera, size=size, **options)]


def script(state: State, facts: Facts, file: Path, eye: Eye, size: tuple[int, int]) -> str:
    """Return the Python script that makes the picture of a state.

    Parameters
    ----------
    state : State
    facts : Facts
        What the file offers.
    file : pathlib.Path
        File that is read; the picture has its name and ``.png``, in the current folder.
    eye : Eye
        Camera.
    size : (int, int)
        Width and height of the picture in pixels.
    """
    mesh = data(Step("data", "vizlight.read", file), facts)
    return source([picture(state, facts, mesh, eye, size, Path(f"{file.stem}.png"))])
