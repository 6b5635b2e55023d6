"""Frames by differences against exact ones, cells against light, and what n-space costs.

``python -m vizlight.studies.manifolds`` prints three tables: the error of tangents and of light by
the step of differences; the error of light between points by the size of cells, with its order; and
nanoseconds and bytes a point for n = 3, 4 and 8, of light, of turning and of projecting.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import cyclopts
import numpy as np
import pyvista as pv

from vizlight import engine
from vizlight.filters import project
from vizlight.geometry import manifolds
from vizlight.light import Light
from vizlight.scene import Scene, View
from vizlight.studies._measure import peak_memory, print_table, take_turns

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight.geometry.manifolds import Manifold

R1, R2 = 1.5, 0.75
DOMAIN = [(0.0, 2 * np.pi)] * 2
SCENE = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38, 0.2)), view=View(direction=(0.1, 0.3, 0.9, -0.2))
)


@dataclass(frozen=True)
class Frames:
    """One way to the tangents: largest error of the tangent space and of the light, and time."""

    way: str
    step: float
    space: float
    light: float
    nanoseconds: float


@dataclass(frozen=True)
class Cells:
    """Cells of one size: largest error of light in their middles, and the order since the last."""

    points: int
    error: float
    order: float


@dataclass(frozen=True)
class Cost:
    """What one point costs: nanoseconds and bytes beyond the output of three pieces of work."""

    k: int
    n: int
    light: float
    turn: float
    project: float
    memory: float


def wavy(t: Any, f: Any) -> tuple[Any, ...]:
    """Return a torus in 4-space with waves on it, whose differences are not exact."""
    r = R2 * (1 + 0.2 * np.cos(3 * t))
    return R1 * np.cos(t), R1 * np.sin(t), r * np.cos(f), r * np.sin(f)


def wavy_tangents(t: Any, f: Any) -> tuple[tuple[Any, ...], ...]:
    """Return the tangents of :func:`wavy`."""
    r, slope = R2 * (1 + 0.2 * np.cos(3 * t)), -0.6 * R2 * np.sin(3 * t)
    return (
        (-R1 * np.sin(t), R1 * np.cos(t), slope * np.cos(f), slope * np.sin(f)),
        (0.0, 0.0, -r * np.sin(f), r * np.cos(f)),
    )


def frame_errors(resolution: int = 128, repeats: int = 3) -> list[Frames]:
    """Return the error of frames by the way they are made."""

    def sample(**options: Any) -> Manifold:
        return manifolds.parametric(wavy, DOMAIN, 4, resolution=resolution, closed=True, **options)

    exact = sample(tangents=wavy_tangents)
    ways: dict[str, dict[str, Any]] = {"exact": {"tangents": wavy_tangents}}
    for step in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 7.6e-7, 1e-8, 1e-10, 1e-12):
        ways[f"central, {step:g}"] = {"step": step}
    for step in (1e-4, 1e-8, 1e-30):
        ways[f"complex, {step:g}"] = {"tangents": "complex", "step": step}
    seconds = take_turns({w: partial(sample, **o) for w, o in ways.items()}, repeats)
    truth = engine.shade(exact.points, exact.frame, SCENE).luminance
    found = []
    for way, options in ways.items():
        shape = sample(**options)
        space = np.abs(_projector(shape) - _projector(exact)).max()
        light = np.abs(engine.shade(shape.points, shape.frame, SCENE).luminance - truth).max()
        cost = 1e9 * seconds[way] / len(shape.points)
        found.append(Frames(way, options.get("step", 0.0), float(space), float(light), cost))
    return found


def _projector(shape: Manifold) -> Any:
    return np.einsum("bki,bkj->bij", shape.frame, shape.frame)


def cell_errors(sizes: tuple[int, ...] = (64, 128, 256, 512)) -> list[Cells]:
    """Return the error of light in the middle of cells, as the mean of their corners."""
    found: list[Cells] = []
    for size in sizes:
        coarse, fine = (manifolds.torus(R1, R2, resolution=r) for r in (size, 2 * size))
        light = engine.shade(coarse.points, coarse.frame, SCENE).luminance
        exact = engine.shade(fine.points, fine.frame, SCENE).luminance.reshape(2 * size, -1)
        error = float(np.abs(light[coarse.cells].mean(axis=1) - exact[1::2, 1::2].ravel()).max())
        order = np.nan
        if found:
            order = np.log(found[-1].error / error) / np.log(size / found[-1].points)
        found.append(Cells(size, error, float(order)))
    return found


def costs(count: int = 500_000, repeats: int = 3) -> list[Cost]:
    """Return what a point costs for some dimensions."""
    random, found = np.random.default_rng(0), []
    for k, n in ((1, 3), (2, 3), (1, 4), (2, 4), (1, 8), (2, 8), (7, 8)):
        points, tangents = random.standard_normal((count, n)), random.standard_normal((count, k, n))
        scene = Scene(lights=Light(direction=np.arange(1.0, n + 1)), view=View(position=np.ones(n)))
        mesh = pv.PointSet(points[:, :3].copy())
        mesh.point_data["position"], mesh.point_data["frame"] = points, tangents.reshape(count, -1)
        matrix = np.linalg.qr(random.standard_normal((n, n)))[0]
        matrix[0] *= np.sign(np.linalg.det(matrix))
        ways: dict[str, Callable[[], Any]] = {
            "light": partial(engine.shade, points, tangents, scene),
            "turn": partial(project, mesh, rotation=matrix),
            "project": partial(project, mesh, distance=100.0),
        }
        seconds = take_turns(ways, repeats)
        # Beyond the result: arrays in n-space if they turn, points and frame in 3-space.
        output = 8 * count * (n + k * n + 3 + (3 * k if k < 3 else 0))
        extra = peak_memory(ways["turn"]) - output
        light, turn, projection = (1e9 * s / count for s in seconds.values())
        found.append(Cost(k, n, light, turn, projection, extra / count))
    return found


def main(resolution: int = 128, count: int = 500_000) -> None:
    """Print the tables.

    Parameters
    ----------
    resolution
        Of the torus whose frames are compared, on each circle.
    count
        Points whose cost is measured.
    """
    print_table(
        f"Frames of a wavy torus in 4-space, {resolution} x {resolution} points",
        ("tangents, step / domain", "error of the space", "error of luminance", "ns a point"),
        [
            (row.way, f"{row.space:.1e}", f"{row.light:.1e}", f"{row.nanoseconds:.0f}")
            for row in frame_errors(resolution)
        ],
    )
    print_table(
        "Light between the points of a torus in 4-space",
        ("points on a circle", "error of luminance", "order"),
        [
            (
                str(row.points),
                f"{row.error:.1e}",
                "" if np.isnan(row.order) else f"{row.order:.2f}",
            )
            for row in cell_errors()
        ],
    )
    print_table(
        f"Cost of a point, {count} points, float64",
        ("k, n", "light, ns", "turn + project, ns", "project, ns", "bytes beyond the result"),
        [
            (
                f"{row.k}, {row.n}",
                f"{row.light:.0f}",
                f"{row.turn:.0f}",
                f"{row.project:.0f}",
                f"{row.memory:.0f}",
            )
            for row in costs(count)
        ],
    )


if __name__ == "__main__":
    cyclopts.run(main)
