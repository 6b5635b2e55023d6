"""The same streamlines as lit lines and as tubes: points, bytes, time to build, time to draw.

``python -m vizlight.studies.tubes [SEEDS] [--picture FILE]`` prints the table and draws both side
by side: the lines lit by vizlight, the tubes of 20 sides by the same light, also as scalars.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path  # noqa: TC003 - read by the command line at run time
from typing import TYPE_CHECKING, Any

import cyclopts

from vizlight import render
from vizlight.data import load_example
from vizlight.filters import illuminate, streamlines
from vizlight.light import Light
from vizlight.scene import Scene, View
from vizlight.studies._measure import print_table, take_turns

if TYPE_CHECKING:
    from collections.abc import Callable

SIDES = 20


@dataclass(frozen=True)
class Row:
    """One way to show streamlines."""

    way: str
    points: int
    megabytes: float
    build: float
    draw: float


def measure(seeds: int = 300, repeats: int = 5) -> tuple[list[Row], list[Any], Any]:
    """Return the rows of the study, the meshes and the camera."""
    flow = load_example()
    camera = render.camera_on(flow.bounds, (1, 0.5, 0.3))
    scene = Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(camera))
    bare = streamlines(flow, scene, vectors="V", seeds=seeds)
    bare.clear_data()
    radius = float(flow.length) / 800
    ways: dict[str, Callable[[], Any]] = {
        "lit lines": lambda: illuminate(bare, scene),
        f"tubes, {SIDES} sides": lambda: illuminate(bare.tube(radius=radius, n_sides=SIDES), scene),
    }
    seconds = take_turns(ways, repeats)
    rows, meshes = [], []
    for way, build in ways.items():
        mesh = build()
        meshes.append(mesh)
        size = mesh.actual_memory_size / 1e3
        draw = time_to_draw(mesh, camera, repeats)
        rows.append(Row(way, mesh.n_points, size, seconds[way], draw))
    return rows, meshes, camera


def time_to_draw(mesh: Any, camera: Any, repeats: int = 5, **options: Any) -> float:
    """Return the median seconds of a frame of 800 x 800 after the first, without anti-aliasing."""
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


def main(seeds: int = 300, *, picture: Path | None = None) -> None:
    """Print the table and draw the picture.

    Parameters
    ----------
    seeds
        How many streamlines are started.
    picture
        A .png file for both ways side by side.
    """
    rows, meshes, camera = measure(seeds)
    print_table(
        f"{seeds} streamlines of the rotating disk",
        ("way", "points", "MB", "build and light, ms", "draw a frame, ms"),
        [
            (
                row.way,
                f"{row.points}",
                f"{row.megabytes:.1f}",
                f"{1e3 * row.build:.0f}",
                f"{1e3 * row.draw:.0f}",
            )
            for row in rows
        ],
    )
    if picture is not None:
        panels = [render.Panel(mesh, title=row.way) for mesh, row in zip(meshes, rows, strict=True)]
        render.save_png(
            panels, picture, camera=camera, size=(1600, 800), line_width=2, background="black"
        )


if __name__ == "__main__":
    cyclopts.run(main)
