"""The same streamlines as lit lines and as tubes: points, bytes, time to build, time to draw.

The lines are lit by vizlight, the tubes by the same light, also as scalars. The error is that of
the shape: what a tube of so many sides shows, averaged over its width, against the exact light of
a cylinder (:mod:`vizlight.studies.lines`), for the power of a default material.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.data import load_example
from vizlight.filters import illuminate, streamlines
from vizlight.model import cylinder
from vizlight.pictures import render
from vizlight.scene import Light, Material, Scene, View
from vizlight.studies import lines
from vizlight.studies._framework import PIXEL, Row, Study, cheapest, holding, words
from vizlight.studies._measuring import take_turns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

SIDES = (4, 6, 8, 10, 12, 14, 16, 18, 20)
MATERIAL = Material()


def shape_error(sides: int, count: int = 5000) -> float:
    """Return the RMS error of the light of a tube of so many sides, its material included."""
    wi, wo, t = lines.directions(count, headlight=False)
    diffuse, specular = lines.tube(wi, wo, t, sides, shininess=MATERIAL.shininess)
    error = MATERIAL.diffuse * (diffuse - cylinder.diffuse(wi, wo, t)) + MATERIAL.specular * (
        specular - cylinder.specular(wi, wo, t, shininess=MATERIAL.shininess)
    )
    return float(np.sqrt(np.mean(error * error)))


def measure(seeds: int = 300, repeats: int = 5) -> tuple[list[Row], list[Any], Any]:
    """Return the rows of the study, the meshes and the camera."""
    flow = load_example()
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.3))
    scene = Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(camera))
    bare = streamlines(flow, scene, vectors="V", seeds=seeds)
    bare.clear_data()
    radius = float(flow.length) / 800
    ways: dict[int, Callable[[], Any]] = {0: lambda: illuminate(bare, scene, model="cylinder")}
    for sides in SIDES:
        ways[sides] = partial(
            lambda n: illuminate(bare.tube(radius=radius, n_sides=n), scene), sides
        )
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


def time_to_draw(mesh: Any, camera: Any, repeats: int = 5, **options: Any) -> float:
    """Return the best seconds of a frame of 800 x 800 after the first, without anti-aliasing."""
    plotter = render.make_plotter(
        mesh, camera=camera, size=(800, 800), anti_aliasing=None, **options
    )
    try:
        plotter.show(auto_close=False)

        def turn() -> None:
            plotter.camera.azimuth += 1.0
            plotter.render()

        return take_turns({"frame": turn}, repeats)["frame"]
    finally:
        plotter.close()


def verdict(rows: Sequence[Row]) -> str:
    """Return whether lines or tubes are drawn faster, and how many sides a tube needs."""
    (line,), tubes = ([row for row in rows if row.way == way] for way in ("lit lines", "tubes"))
    enough = holding(tubes, coarse=False)
    tube = enough or max(tubes, key=lambda row: int(row.parameter))
    best = cheapest([line, *([enough] if enough else [])])
    fewer = max(
        (int(r.parameter) for r in tubes if int(r.parameter) < int(tube.parameter)), default=0
    )
    needed = (
        f"a tube needs {tube.parameter} sides for an RMS error of 1/255"
        + (f" ({fewer} are too few)" if fewer else "")
        if enough
        else f"tubes of {tube.parameter} sides miss by {tube.error / PIXEL:.2g} of 255"
    )
    size, build = (
        float(tube.more[key]) / float(line.more[key]) for key in ("MB", "build and light, ms")
    )
    use = "lit lines (model='cylinder')" if best is line else f"tubes of {tube.parameter} sides"
    why = "the cheaper to draw" if enough else "the only ones within 1/255"
    return (
        f"for lines thinner than a pixel use {use}, {why}: {needed}, and such a tube takes "
        f"{words(size)} times the memory of a lit line, {words(build)} times the time to build "
        f"and {words(tube.cost / line.cost)} times the time to draw"
    )


STUDY = Study(
    approximates="streamlines of the rotating disk as round cylinders",
    reference="the exact light of a thin cylinder",
    parameter="sides, 0 for a line",
    error="RMS error of luminance",
    cost="ms to draw a frame",
    steps=lambda quick: [lambda: measure(100 if quick else 300, 3 if quick else 5)[0]],
    verdict=verdict,
)
