"""Streamlines as lit lines and as tubes: points, memory, time to build, and time to draw.

Lines and tubes are lit by the same scene, as point scalars. The error is that of the shape: the
mean light of a tube over its width, compared with the exact light of a cylinder
(:mod:`studies.lines`), for the default material.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studies import SHINY, Row, Study, lines, take_turns
from vizlight.data import load_example
from vizlight.draw import render
from vizlight.filters.illuminate import illuminate
from vizlight.filters.streamlines import streamlines
from vizlight.model import cylinder
from vizlight.scene import Light, Scene, View

if TYPE_CHECKING:
    from collections.abc import Callable

    import pyvista as pv

SIDES = (4, 6, 8, 10, 12, 14, 16, 18, 20)


def shape_error(sides: int, count: int = 5000) -> float:
    """Return the RMS error of the luminance of a tube with a shiny material."""
    wi, wo, t = lines.directions(count, headlight=False)
    diffuse, specular = lines.tube(wi, wo, t, sides, shininess=SHINY.shininess)
    error = SHINY.diffuse * (diffuse - cylinder.diffuse(wi, wo, t)) + SHINY.specular * (
        specular - cylinder.specular(wi, wo, t, shininess=SHINY.shininess)
    )
    return float(np.sqrt(np.mean(error * error)))


def measure(seeds: int = 300, repeats: int = 5) -> tuple[list[Row], list[pv.PolyData], pv.Camera]:
    """Return the rows of the study, the meshes and the camera."""
    flow = load_example()
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.3))
    lamp = Light(direction=(1, 0.9, 0.5))
    scene = Scene(lights=lamp, view=View.from_camera(camera), material=SHINY)
    bare = streamlines(flow, scene, vectors="V", seeds=seeds)
    bare.clear_data()
    radius = float(flow.length) / 800

    def build_tubes(sides: int) -> pv.PolyData:
        lit: pv.PolyData = illuminate(bare.tube(radius=radius, n_sides=sides), scene)
        return lit

    ways: dict[int, Callable[[], pv.PolyData]] = {
        0: partial(illuminate, bare, scene, model="cylinder"),
        **{sides: partial(build_tubes, sides) for sides in SIDES},
    }
    seconds = take_turns(ways, repeats)
    rows, meshes = [], []
    for sides, build in ways.items():
        mesh = build()
        meshes.append(mesh)
        more = {
            "points": mesh.n_points,
            "MB": mesh.actual_memory_size / 1e3,
            "build and light, ms": 1e3 * seconds[sides],
        }
        draw = 1e3 * time_to_draw(mesh, camera, repeats)
        error = shape_error(sides) if sides else 0.0
        rows.append(Row("tubes" if sides else "lit lines", sides, error, draw, more))
    return rows, meshes, camera


def time_to_draw(mesh: pv.PolyData, camera: pv.Camera, repeats: int = 5) -> float:
    """Return the processor time in seconds of a frame of 800 x 800 pixels after the first one."""
    plotter = render.make_plotter(
        mesh, camera=camera, size=(800, 800), anti_aliasing=None, light="points"
    )
    try:
        plotter.show(auto_close=False)

        def turn() -> None:
            plotter.camera.azimuth += 1.0
            plotter.render()

        return take_turns({"frame": turn}, repeats)["frame"]
    finally:
        plotter.close()


STUDY = Study(
    approximates="streamlines of the rotating disk as round cylinders",
    reference="the exact light of a thin cylinder",
    parameter="sides, 0 for a line",
    error="RMS error of luminance",
    cost="ms per frame",
    steps=lambda quick: [lambda: measure(30 if quick else 300, 3 if quick else 5)[0]],
)
