"""Fur against VTK's glyph filter: time to make and light, time to draw, memory.

``python -m vizlight.studies.fur`` covers a torus of 128 x 128 points with 2,408,448 segments, 147 a
point, as Banks did in 1994 (22 s to light and generate, 16 s to draw). The glyph
filter makes the same fibres' geometry alone, unlit. Both take turns in one run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import cyclopts
import numpy as np
import pyvista as pv

from vizlight import render
from vizlight.filters import fur
from vizlight.light import Light
from vizlight.scene import Material, Scene, View
from vizlight.studies._measure import peak_memory, print_table, take_turns
from vizlight.studies.tubes import time_to_draw

SEGMENTS_A_POINT = 147


@dataclass(frozen=True)
class Row:
    """Fibres of so many segments: seconds, and peak memory as a multiple of the output."""

    segments: int
    fibres: int
    fur: float
    glyph: float
    draw: float
    memory: float


def torus(n: int = 128, r1: float = 1.5, r2: float = 0.75) -> Any:
    """Return a torus of n x n points with its exact normals, in float32."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    u, v = np.meshgrid(angle, angle, indexing="ij")
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
    points = r1 * np.stack([np.cos(u), np.sin(u), 0 * u], axis=-1) + r2 * normals
    i = np.arange(n * n).reshape(n, n)
    right, up = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
    across = np.roll(right, -1, axis=1)
    faces = np.concatenate([np.stack([i, right, across], -1), np.stack([i, across, up], -1)])
    vertices: Any = points.reshape(-1, 3).astype(np.float32)
    mesh = pv.PolyData.from_regular_faces(vertices, faces.reshape(-1, 3))
    mesh.point_data["Normals"] = normals.reshape(-1, 3).astype(np.float32)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def measure(n: int, segments: int, repeats: int = 5) -> Row:
    """Return one row of the study."""
    mesh, count = torus(n), n * n * SEGMENTS_A_POINT // segments
    camera = render.camera_on(mesh.bounds, (0.3, -1, 0.8))
    scene = Scene(
        lights=Light(direction=(-1, -0.6, 0.9)),
        view=View.from_camera(camera),
        material=Material(ambient=0.1, diffuse=0.9, specular=0.1),
    )

    def cover() -> Any:
        return fur(mesh, scene, density=0.02, fibres=count, length=0.3, segments=segments)

    coat = cover()["fibres"]
    roots = pv.PolyData(np.asarray(coat.points)[:: segments + 1].copy())
    roots["way"] = np.asarray(coat.points)[segments :: segments + 1] - roots.points
    fibre = pv.MultipleLines(np.outer(np.linspace(0, 0.3, segments + 1), [1, 0, 0]))
    seconds = take_turns(
        {"fur": cover, "glyph": lambda: roots.glyph(orient="way", scale=False, geom=fibre)}, repeats
    )
    output = 1024 * sum(block.actual_memory_size for block in cover())
    draw = time_to_draw(coat, camera, repeats)
    memory = peak_memory(cover) / output
    return Row(segments, count, seconds["fur"], seconds["glyph"], draw, memory)


def main(n: int = 128) -> None:
    """Print the table.

    Parameters
    ----------
    n
        The torus has n x n points.
    """
    rows = [measure(n, segments) for segments in (1, 3, 7)]
    print_table(
        f"Fur of {n * n * SEGMENTS_A_POINT} segments",
        (
            "segments a fibre", "fibres", "make and light, s", "VTK glyphs unlit, s",
            "times as fast", "draw a frame, s", "peak memory / output",
        ),
        [
            (
                f"{row.segments}",
                f"{row.fibres}",
                f"{row.fur:.2f}",
                f"{row.glyph:.2f}",
                f"{row.glyph / row.fur:.1f}",
                f"{row.draw:.2f}",
                f"{row.memory:.2f}",
            )
            for row in rows
        ],
    )  # fmt: skip


if __name__ == "__main__":
    cyclopts.run(main)
