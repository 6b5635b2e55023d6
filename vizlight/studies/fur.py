"""How many fibres and how many segments fur needs, and what they cost beside VTK's glyphs.

A torus of 128 x 128 points carries 2,408,448 segments, 147 a point, as Banks' did in 1994 (22 s to
light and generate, 16 s to draw), in fibres of 1, 3 or 7, or fewer fibres of 3. Light between the
points of a fibre is interpolated: its error is what more segments lessen. Light over the surface is
sampled: its error is what more fibres lessen. The glyph filter makes the same fibres' geometry
alone, unlit. Both take turns in one run.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight.filters import fur
from vizlight.pictures import render
from vizlight.scene import Light, Material, Scene, View
from vizlight.studies._framework import PIXEL, Row, Study, holding, span, words
from vizlight.studies._measuring import peak_memory, take_turns
from vizlight.studies.tubes import time_to_draw

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

SEGMENTS_A_POINT = 147
#: Patches of the torus, on each circle, whose mean light is compared.
PATCHES = 8
#: Segments of a fibre that stand for infinitely many, and fibres of which the mean is taken.
FINE, MANY = 48, 400_000


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


def scene_of(mesh: Any) -> tuple[Scene, Any]:
    """Return the scene of the study and the camera that sees it."""
    camera = render.camera_on(mesh.bounds, (0.3, -1, 0.8))
    scene = Scene(
        lights=Light(direction=(-1, -0.6, 0.9)),
        view=View.from_camera(camera),
        material=Material(ambient=0.1, diffuse=0.9, specular=0.1),
    )
    return scene, camera


def along_fibres(segments: int) -> float:
    """Return the RMS error of light that is interpolated along fibres of so many segments."""
    mesh = torus(32)
    scene, _ = scene_of(mesh)

    def light(count: int) -> Any:
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
        return np.asarray(fibres_of(coat)["luminance"], dtype=np.float64).reshape(-1, count + 1)

    at, fine, rough = np.linspace(0, 1, FINE + 1), light(FINE), light(segments)
    nodes = np.linspace(0, 1, segments + 1)
    between = np.stack([np.interp(at, nodes, row) for row in rough])
    return float(np.sqrt(np.mean((between - fine) ** 2)))


def fibres_of(coat: pv.MultiBlock) -> pv.PolyData:
    """Return the fibres of fur as lines."""
    fibres = coat["fibres"]
    assert isinstance(fibres, pv.PolyData)
    return fibres


def over_patches(fibres: int, seed: int = 0) -> Any:
    """Return the mean light of the fibres that stand on each patch of the torus."""
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
    return np.bincount(number, light, minlength=PATCHES**2) / np.maximum(count, 1)


def measure(n: int, segments: int, repeats: int = 5) -> Row:
    """Return a row of the study: 147 segments a point of the torus, so many a fibre."""
    mesh, count = torus(n), n * n * SEGMENTS_A_POINT // segments
    scene, camera = scene_of(mesh)

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
    more = {
        "fibres": count,
        "s": seconds["fur"],
        "VTK glyphs unlit, s": seconds["glyph"],
        "draw a frame, s": time_to_draw(coat, camera, repeats),
        "peak memory / output": peak_memory(cover) / output,
    }
    cost = 1e9 * seconds["fur"] / (count * (segments + 1))
    return Row("segments of a fibre", segments, along_fibres(segments), cost, more)


def count_fibres(fibres: int, exact: Any) -> Row:
    """Return a row of the study: so many fibres on the torus, of 3 segments."""
    seconds = take_turns({"fur": partial(over_patches, fibres)}, 1)["fur"]
    errors = [over_patches(fibres, seed) - exact for seed in range(1, 4)]
    error = float(np.sqrt(np.mean(np.square(errors))))
    a_patch = fibres / PATCHES**2
    more = {"fibres": fibres, "s": seconds}
    return Row("fibres a patch", a_patch, error, 1e9 * seconds / (4 * fibres), more)


def steps(quick: bool) -> list[Callable[[], Iterable[Row]]]:
    """Return the steps: segments of a fibre, then numbers of fibres."""
    n, repeats = (48, 3) if quick else (128, 5)
    found: list[Callable[[], Iterable[Row]]] = [
        lambda segments=segments: [measure(n, segments, repeats)]  # type: ignore[misc]
        for segments in ((1, 3, 7) if quick else (1, 2, 3, 5, 7, 12))
    ]
    counts = [PATCHES**2 * size for size in (8, 32, 128, 512)]

    def counted() -> list[Row]:
        exact = over_patches(MANY // 4 if quick else MANY)
        return [count_fibres(count, exact) for count in counts]

    return [*found, counted]


def verdict(rows: Sequence[Row]) -> str:
    """Return how many segments and fibres are enough, and the speed beside VTK's glyphs."""
    own, many = (
        [row for row in rows if row.way == way] for way in ("segments of a fibre", "fibres a patch")
    )
    best, few = holding(own, coarse=False), holding(many, coarse=False)
    least, most = own[-1], many[-1]
    said = (
        f"at an RMS error of 1/255 use {best.parameter} segments a fibre (error "
        f"{best.error:.1g})" if best
        else f"{least.parameter} segments a fibre leave {least.error / PIXEL:.2g} of 255"
    )  # fmt: skip
    said += (
        f", and {words(few.parameter)} fibres or more where a patch's mean is to be that near"
        if few
        else f"; {words(most.parameter)} fibres a patch leave {most.error / PIXEL:.2g} of 255"
    )
    speed = (float(row.more["VTK glyphs unlit, s"]) / float(row.more["s"]) for row in own)
    return (
        f"{said}; fur is grown and lit {span(speed)} times as fast as VTK's glyph filter grows it "
        "unlit"
    )


STUDY = Study(
    approximates="light along fibres by segments, and over a furry surface by a number of fibres",
    reference=f"fibres of {FINE} segments; {MANY} fibres",
    parameter="segments, or fibres a patch",
    error="RMS error of luminance",
    cost="ns a point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
)
