"""Light interpolated between the points of a mesh, compared with light at every pixel.

The meshes are a torus in 3-space and one in 4-space, with exact frames. At the centre of each cell,
the mean of the light at its corners, which a picture shows there, is compared with the light of the
surface. Interpolation of smooth light is of order 2. At the terminator, where Lambert's law has a
kink, the order is 1.
"""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studies import PIXEL, SHINY, Row, Study, holding, order, span, take_turns, words
from vizlight.geometry.nspace import manifolds
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array, Bools

R1, R2 = 1.5, 0.75
#: Pixels of a picture with light at every pixel.
PIXELS = 1_000_000
SHININESS = (5.0, 20.0, 100.0)
#: Name of the method that lights every pixel.
AT_PIXELS = "one point per pixel"


def ring(size: int) -> tuple[Array, Array]:
    """Return the points of a torus of revolution, size x size, and their two tangents."""
    angle = 2 * np.pi * np.arange(size) / size
    u, v = (a.ravel() for a in np.meshgrid(angle, angle, indexing="ij"))
    across = R1 + R2 * np.cos(v)
    points = np.stack([across * np.cos(u), across * np.sin(u), R2 * np.sin(v)], axis=-1)
    along = np.stack([-np.sin(u), np.cos(u), 0 * u], axis=-1)
    up = np.stack([-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v)], axis=-1)
    return points, np.stack([along, up], axis=1)


def flat_torus(size: int) -> tuple[Array, Array]:
    """Return the points of a torus in 4-space, size x size, and their two tangents."""
    shape = manifolds.torus(R1, R2, resolution=size)
    return shape.points, shape.frame


def scene(n: int, shininess: float) -> Scene:
    """Return the scene of the study in n-space."""
    return Scene(
        lights=Light(direction=(0.7, 0.6, 0.38, 0.2)[:n]),
        view=View(direction=(0.1, 0.3, 0.9, -0.2)[:n]),
        material=dataclasses.replace(SHINY, shininess=shininess),
    )


def smooth_cells(points: Array, frame: Array, size: int, shininess: float) -> Bools:
    """Return the cells that the terminator does not cross; in 4-space these are all cells."""
    if points.shape[1] > 3:
        return np.ones((size, size), dtype=np.bool_)
    normal = np.cross(frame[:, 0], frame[:, 1])
    lit = (normal @ np.asarray(scene(3, shininess).lights[0].direction) > 0).reshape(size, size)
    down = np.roll(lit, -1, axis=0)
    corners = lit.astype(int) + down + np.roll(lit, -1, axis=1) + np.roll(down, -1, axis=1)
    return np.asarray(corners % 4 == 0)


def error(
    shape: Callable[[int], tuple[Array, Array]], size: int, shininess: float
) -> tuple[float, float, float]:
    """Return the largest error, the RMS error, and the largest error off the terminator.

    The errors are those at the centres of the cells.
    """

    def light(count: int) -> Array:
        points, frame = shape(count)
        lit = engine.shade(points, frame, scene(points.shape[1], shininess))
        return np.asarray(lit.luminance).reshape(count, count)

    corners, fine = light(size), light(2 * size)
    down = np.roll(corners, -1, axis=0)
    mean = (corners + down + np.roll(corners, -1, axis=1) + np.roll(down, -1, axis=1)) / 4
    off = np.abs(mean - fine[1::2, 1::2])
    smooth = smooth_cells(*shape(size), size, shininess)
    return float(off.max()), float(np.sqrt(np.mean(off * off))), float(off[smooth].max())


def measure(n: int, shininess: float, sizes: Sequence[int]) -> list[Row]:
    """Return the rows of one shape and shininess; the cost is that of lighting the whole mesh."""
    shape = ring if n == 3 else flat_torus
    rows = []
    for size in sizes:
        points, frame = shape(size)
        work = partial(engine.shade, points, frame, scene(n, shininess))
        taken = take_turns({"": work}, 3)[""]
        worst, rms, smooth = error(shape, size, shininess)
        more = {
            "n": n,
            "power": shininess,
            "points": size * size,
            "RMS error": rms,
            "off the terminator": smooth,
        }
        rows.append(Row(f"{n}-space, power {shininess:g}", size, worst, 1e3 * taken, more))
    return rows


def every_pixel(shininess: float = 20.0) -> list[Row]:
    """Return the row of one lit point per pixel."""
    points, frame = ring(int(PIXELS**0.5))
    work = partial(engine.shade, points, frame, scene(3, shininess))
    taken = take_turns({"": work}, 3)[""]
    more = {"n": 3, "power": shininess, "RMS error": 0.0, "points": PIXELS}
    return [Row(AT_PIXELS, int(PIXELS**0.5), 0.0, 1e3 * taken, more)]


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return one step for each shape and shininess, and one for light at every pixel."""
    sizes = (64, 128, 256, 512) if quick else (64, 128, 256, 512, 1024)
    found = [partial(measure, 3, s, sizes) for s in SHININESS]
    return [*found, partial(measure, 4, 20.0, sizes), every_pixel]


def verdict(rows: Sequence[Row]) -> str:
    """Return the mesh size that each power needs, its relative cost, and the orders."""
    ways: dict[str, list[Row]] = {}
    for row in rows:
        ways.setdefault(row.way, []).append(row)
    (pixel,) = ways.pop(AT_PIXELS)
    in_3 = sorted(
        (own for own in ways.values() if own[0].more["n"] == 3),
        key=lambda own: float(own[0].more["power"]),
    )
    sizes, costs = [], []
    for own in in_3:
        power, finest = own[0].more["power"], max(own, key=lambda row: int(row.parameter))
        best = holding(own, coarse=False)
        if best is None:
            sizes.append(
                f"more than {finest.parameter} for power {power:g} (whose error is "
                f"{words(finest.error / PIXEL)} of 255)"
            )
        else:
            sizes.append(f"{best.parameter} for power {power:g}")
            costs.append(best.cost / pixel.cost)
    saved = f", at {span(costs)} times the cost of one point per pixel" if costs else ""
    smooth = [
        -order([row._replace(error=float(row.more["off the terminator"])) for row in own][-3:])
        for own in ways.values()
    ]
    # The highlight of the smallest power disturbs the kink at the terminator least.
    kink = -order(in_3[0][-3:])
    return (
        "for an error of 1/255 light a mesh with at least this number of points per turn of the "
        f"normals: {', '.join(sizes)}{saved}; the order of convergence is {min(smooth):.2f} to "
        f"{max(smooth):.2f} off the terminator, in theory 2, and {kink:.2f} at the terminator, in "
        "theory 1"
    )


STUDY = Study(
    approximates="light between the points of a mesh by interpolation",
    reference="the light of the surface itself, as computed at every pixel",
    parameter="points per circle",
    error="largest error of luminance",
    cost="ms to light the mesh",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
)
