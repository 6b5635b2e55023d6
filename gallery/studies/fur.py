"""Number of fibres and segments that fur needs, and their cost compared with VTK's glyphs.

A torus of 128 x 128 points carries 2,408,448 segments, 147 per point, like that of Banks in 1994
(22 s to generate and light, 16 s to draw), in fibres of 1 to 12 segments. Light is interpolated
between the points of a fibre, with an error that falls with the number of segments. Light over the
surface is sampled, with an error that falls with the number of fibres. VTK's glyph filter generates
the geometry of the same fibres without light. Both are timed in turn.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from studies import PIXEL, Row, Study, holding, peak_memory, span, take_turns
from studies.tubes import time_to_draw
from vizlight.filters.fur import fur
from vizlight.pictures import render
from vizlight.scene import Light, Material, Scene, View

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from vizlight._types import Array

SEGMENTS_PER_POINT = 147
#: Number of patches along each circle of the torus, whose mean light is compared.
PATCHES = 8
#: Segments per fibre and number of fibres of the references.
FINE, MANY = 48, 400_000
#: Names of the two series of measurements.
SEGMENTS, FIBRES = "segments per fibre", "fibres per patch"


def torus(n: int = 128, r1: float = 1.5, r2: float = 0.75) -> pv.PolyData:
    """Return a torus of n x n points with exact normals, in float32."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    u, v = np.meshgrid(angle, angle, indexing="ij")
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
    points = r1 * np.stack([np.cos(u), np.sin(u), 0 * u], axis=-1) + r2 * normals
    i = np.arange(n * n).reshape(n, n)
    right, up = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
    across = np.roll(right, -1, axis=1)
    faces = np.concatenate([np.stack([i, right, across], -1), np.stack([i, across, up], -1)])
    # PyVista's type excludes arrays of float32.
    vertices: Any = points.reshape(-1, 3).astype(np.float32)
    mesh: pv.PolyData = pv.PolyData.from_regular_faces(vertices, faces.reshape(-1, 3))
    mesh.point_data["Normals"] = normals.reshape(-1, 3).astype(np.float32)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def scene_of(mesh: pv.PolyData) -> tuple[Scene, pv.Camera]:
    """Return the scene of the study and the camera of its view."""
    camera = render.camera_on(mesh.bounds, (0.3, -1, 0.8))
    scene = Scene(
        lights=Light(direction=(-1, -0.6, 0.9)),
        view=View.from_camera(camera),
        material=Material(ambient=0.1, diffuse=0.9, specular=0.1),
    )
    return scene, camera


def fibres_of(coat: pv.MultiBlock) -> pv.PolyData:
    """Return the fibres of a mesh with fur."""
    fibres = coat["fibres"]
    assert isinstance(fibres, pv.PolyData)
    return fibres


def along_fibres(segments: int) -> float:
    """Return the RMS error of interpolated light along fibres of a number of segments."""
    mesh = torus(32)
    scene, _ = scene_of(mesh)

    def light(count: int) -> Array:
        coat = fur(
            mesh,
            scene,
            density=0.02,
            fibres=2000,
            length=0.3,
            segments=count,
            toward=(0, 0, -1),
            bend=0.5,
        )
        light = np.asarray(fibres_of(coat)["luminance"], dtype=np.float64)
        return light.reshape(-1, count + 1)

    at, fine, rough = np.linspace(0, 1, FINE + 1), light(FINE), light(segments)
    nodes = np.linspace(0, 1, segments + 1)
    between = np.stack([np.interp(at, nodes, row) for row in rough])
    return float(np.sqrt(np.mean((between - fine) ** 2)))


def over_patches(fibres: int, seed: int = 0) -> Array:
    """Return the mean light of the fibres on each patch of the torus."""
    mesh = torus(64)
    scene, _ = scene_of(mesh)
    coat = fibres_of(
        fur(mesh, scene, density=0.02, fibres=fibres, length=0.3, segments=3, seed=seed)
    )
    light = np.asarray(coat["luminance"], dtype=np.float64).reshape(-1, 4).mean(axis=1)
    x, y, z = np.asarray(coat.points)[::4].T
    u, v = np.arctan2(y, x), np.arctan2(z, np.hypot(x, y) - 1.5)
    patch = [np.floor((a / (2 * np.pi) + 0.5) * PATCHES).astype(int) % PATCHES for a in (u, v)]
    number = patch[0] * PATCHES + patch[1]
    count = np.bincount(number, minlength=PATCHES**2)
    return np.asarray(np.bincount(number, light, minlength=PATCHES**2) / np.maximum(count, 1))


def measure(n: int, segments: int, repeats: int = 5) -> list[Row]:
    """Return the row for a number of segments per fibre, with 147 segments per point."""
    mesh, count = torus(n), n * n * SEGMENTS_PER_POINT // segments
    scene, camera = scene_of(mesh)
    cover = partial(fur, mesh, scene, density=0.02, fibres=count, length=0.3, segments=segments)
    coat = fibres_of(cover())
    roots = pv.PolyData(np.asarray(coat.points)[:: segments + 1].copy())
    roots["direction"] = np.asarray(coat.points)[segments :: segments + 1] - roots.points
    fibre = pv.MultipleLines(np.outer(np.linspace(0, 0.3, segments + 1), [1, 0, 0]))
    seconds = take_turns(
        {
            "fur": cover,
            "glyph": partial(roots.glyph, orient="direction", scale=False, geom=fibre),
        },
        repeats,
    )
    output = 1024 * sum(block.actual_memory_size for block in cover())
    more = {
        "fibres": count,
        "s": seconds["fur"],
        "VTK glyphs without light, s": seconds["glyph"],
        "draw a frame, s": time_to_draw(coat, camera, repeats),
        "peak memory / output": peak_memory(cover) / output,
    }
    cost = 1e9 * seconds["fur"] / (count * (segments + 1))
    return [Row(SEGMENTS, segments, along_fibres(segments), cost, more)]


def count_fibres(fibres: int, exact: Array) -> Row:
    """Return the row for a number of fibres of 3 segments on the torus."""
    seconds = take_turns({"fur": partial(over_patches, fibres)}, 1)["fur"]
    errors = [over_patches(fibres, seed) - exact for seed in range(1, 4)]
    error = float(np.sqrt(np.mean(np.square(errors))))
    more = {"fibres": fibres, "s": seconds}
    return Row(FIBRES, fibres / PATCHES**2, error, 1e9 * seconds / (4 * fibres), more)


def steps(quick: bool) -> list[Callable[[], Iterable[Row]]]:
    """Return the steps: numbers of segments, then numbers of fibres."""
    n, repeats = (48, 3) if quick else (128, 5)
    counts = [PATCHES**2 * size for size in (8, 32, 128, 512)]

    def counted() -> list[Row]:
        exact = over_patches(MANY // 4 if quick else MANY)
        return [count_fibres(count, exact) for count in counts]

    sizes = (1, 3, 7) if quick else (1, 2, 3, 5, 7, 12)
    return [*(partial(measure, n, segments, repeats) for segments in sizes), counted]


def verdict(rows: Sequence[Row]) -> str:
    """Return the sufficient numbers of segments and fibres, and the speed relative to glyphs."""
    own, many = ([row for row in rows if row.way == way] for way in (SEGMENTS, FIBRES))
    best, few = holding(own, coarse=False), holding(many, coarse=False)
    segments = (
        f"for an RMS error of 1/255 use {best.parameter} segments per fibre (error "
        f"{best.error:.1g})" if best
        else f"the error of {own[-1].parameter} segments per fibre is "
        f"{own[-1].error / PIXEL:.2g} of 255"
    )  # fmt: skip
    fibres = (
        f"for the same error of the mean over a patch use {few.parameter:.3g} fibres per patch"
        if few
        else f"the error of the mean over a patch of {many[-1].parameter:.3g} fibres is "
        f"{many[-1].error / PIXEL:.2g} of 255"
    )
    speed = (float(row.more["VTK glyphs without light, s"]) / float(row.more["s"]) for row in own)
    return (
        f"{segments}; {fibres}; generating and lighting the fibres is {span(speed)} times as fast "
        "as generating them without light by VTK's glyph filter"
    )


STUDY = Study(
    approximates="light along fibres by segments, and over a surface with fur by fibres",
    reference=f"fibres of {FINE} segments; {MANY} fibres",
    parameter="segments per fibre, or fibres per patch",
    error="RMS error of luminance",
    cost="ns per point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
)
