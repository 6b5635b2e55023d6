"""Number of segments that fur needs, and their cost compared with VTK's glyphs.

A torus of 128 x 128 points carries 2,408,448 segments, 147 per point, like that of Banks in 1994
(22 s to generate and light, 16 s to draw), in fibres of 1 to 12 segments. Light is interpolated
between the points of a fibre, with an error that falls with the number of segments. VTK's glyph
filter generates the geometry of the same fibres without light. Both are timed in turn.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista as pv

from studies import Row, Study, peak_memory, take_turns
from vizlight.draw import render
from vizlight.filters.fur import fur
from vizlight.scene import Light, Material, Scene, View

SEGMENTS_PER_POINT = 147
#: Segments per fibre of the reference.
FINE = 48


def torus(n=128, r1=1.5, r2=0.75):
    """Return a torus of n x n points with exact normals, in float32."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    u, v = np.meshgrid(angle, angle, indexing="ij")
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
    points = r1 * np.stack([np.cos(u), np.sin(u), 0 * u], axis=-1) + r2 * normals
    i = np.arange(n * n).reshape(n, n)
    right, up = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
    across = np.roll(right, -1, axis=1)
    faces = np.concatenate([np.stack([i, right, across], -1), np.stack([i, across, up], -1)])
    vertices = points.reshape(-1, 3).astype(np.float32)
    mesh = pv.PolyData.from_regular_faces(vertices, faces.reshape(-1, 3))
    mesh.point_data["Normals"] = normals.reshape(-1, 3).astype(np.float32)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def scene_of(mesh):
    """Return the scene of the study."""
    view = View.from_camera(render.camera_on(mesh.bounds, (0.3, -1, 0.8)))
    material = Material(ambient=0.1, diffuse=0.9, specular=0.1)
    return Scene(lights=Light(direction=(-1, -0.6, 0.9)), view=view, material=material)


def along_fibres(segments):
    """Return the RMS error of interpolated light along fibres of a number of segments."""
    mesh = torus(32)
    cover = partial(fur, mesh, scene_of(mesh), density=0.02, fibres=2000, length=0.3)

    def light(count):
        coat = cover(segments=count, toward=(0, 0, -1), bend=0.5)["fibres"]
        return np.asarray(coat["luminance"], dtype=np.float64).reshape(-1, count + 1)

    at, fine, rough = np.linspace(0, 1, FINE + 1), light(FINE), light(segments)
    nodes = np.linspace(0, 1, segments + 1)
    between = np.stack([np.interp(at, nodes, row) for row in rough])
    return float(np.sqrt(np.mean((between - fine) ** 2)))


def measure(n, segments, repeats=5):
    """Return the row for a number of segments per fibre, with 147 segments per point."""
    mesh, count = torus(n), n * n * SEGMENTS_PER_POINT // segments
    scene = scene_of(mesh)
    cover = partial(fur, mesh, scene, density=0.02, fibres=count, length=0.3, segments=segments)
    coat = cover()["fibres"]
    roots = pv.PolyData(np.asarray(coat.points)[:: segments + 1].copy())
    roots["direction"] = np.asarray(coat.points)[segments :: segments + 1] - roots.points
    fibre = pv.MultipleLines(np.outer(np.linspace(0, 0.3, segments + 1), [1, 0, 0]))
    glyph = partial(roots.glyph, orient="direction", scale=False, geom=fibre)
    seconds = take_turns({"fur": cover, "glyph": glyph}, repeats)
    output = 1024 * sum(block.actual_memory_size for block in cover())
    more = {
        "fibres": count,
        "s": seconds["fur"],
        "VTK glyphs without light, s": seconds["glyph"],
        "peak memory / output": peak_memory(cover) / output,
    }
    cost = 1e9 * seconds["fur"] / (count * (segments + 1))
    return [Row("segments per fibre", segments, along_fibres(segments), cost, more)]


STUDY = Study(
    approximates="light along fibres of fur by segments",
    reference=f"fibres of {FINE} segments",
    parameter="segments per fibre",
    error="RMS error of luminance",
    cost="ns per point",
    steps=lambda quick: [
        partial(measure, 48 if quick else 128, segments, 3 if quick else 5)
        for segments in ((1, 3, 7) if quick else (1, 2, 3, 5, 7, 12))
    ],
)
