"""Drift of streamlines due to the step of the tracer, the cell size, and a triangulated surface.

The velocity of a rigid rotation is linear, so interpolation in cells is exact and the drift from
the circles is due to the tracer alone. In a flow whose speed grows with the radius, and in a flow
on a triangulated sphere, the drift falls with the square of the cell size. The lines make more than
one turn.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from studies import SHINY, Curve, Panel, Row, Study, holding, order, take_turns, words
from vizlight.filters.streamlines import streamlines
from vizlight.scene import Light, Scene, View

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

#: Largest drift allowed, relative to the radius, and step of the tracer for varied cell sizes.
ALLOWED, FINE = 1e-3, 0.1
SCENE = Scene(lights=Light(direction=(1, 1, 1)), view=View(direction=(0, 0, 1)), material=SHINY)
#: Radii at which lines start, some cells from the centre and within the grid.
RADII, HEIGHT = (0.3, 0.5, 0.7), 0.4
STEP, CELL, SPHERE = "rigid rotation, step", "swirl, cell size", "sphere, cell size"


def turning(size: int = 11) -> pv.ImageData:
    """Return the flow of a rigid rotation about the z-axis."""
    grid = pv.ImageData(
        dimensions=(size, size, 5),
        spacing=(2 / (size - 1),) * 3,
        origin=(-1, -1, HEIGHT - 4 / (size - 1)),
    )
    x, y, _ = grid.points.T
    grid["V"] = np.stack([-y, x, 0 * x], axis=1)
    return grid


def swirling(cells: int) -> pv.ImageData:
    """Return a rotating flow whose angular speed grows with the distance from the z-axis."""
    grid = turning(cells + 1)
    x, y, _ = grid.points.T
    grid["V"] = np.asarray(grid["V"]) * np.exp(4 * (x * x + x * y + y * y) / 2)[:, np.newaxis]
    return grid


def sphere(cells: int) -> pv.PolyData:
    """Return a triangulated sphere with a flow about the z-axis, ``cells`` triangles around.

    The axis of the triangulation differs from z, so the triangles do not repeat along the flow.
    """
    mesh: pv.PolyData = pv.Sphere(
        radius=1.0, theta_resolution=cells, phi_resolution=cells // 2 + 1, direction=(1.0, 0.3, 0.2)
    )
    x, y, _ = mesh.points.T
    mesh["V"] = np.stack([-y, x, 0 * x], axis=1)
    return mesh


def measure(way: str, parameter: float, flow: pv.DataSet, step: float, repeats: int) -> list[Row]:
    """Return the row of one flow and step, with the drift from circles relative to the radius."""
    seeds = np.array([[r, 0.0, (1 - r * r) ** 0.5 if way == SPHERE else HEIGHT] for r in RADII])
    trace = partial(streamlines, flow, SCENE, vectors="V", seeds=seeds, step=step, max_length=8.0)
    taken, lines = take_turns({"": trace}, repeats)[""], trace()
    drift = 0.0
    for i in range(lines.n_cells):
        at = np.asarray(lines.get_cell(i).points, dtype=np.float64)
        if way == SPHERE:
            # The latitude does not depend on the distance of a chord from the centre.
            height = at[:, 2] / np.linalg.norm(at, axis=1)
            drift = max(drift, float(np.ptp(height)))
        else:
            radius = np.hypot(at[:, 0], at[:, 1])
            drift = max(drift, float(np.ptp(radius) / radius[0]))
    return [Row(way, parameter, drift, 1e9 * taken / lines.n_points, {"s": taken})]


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return one step of the study for each step of the tracer and each cell size."""
    sizes = (2.0, 1.0, 0.5, 0.3) if quick else (2.0, 1.4, 1.0, 0.7, 0.5, 0.3, 0.2, 0.1)
    cells, round_it = (8, 16, 32, 64), (24, 48, 96, 192)
    repeats = 3 if quick else 5
    return [
        *(partial(measure, STEP, size, turning(), size, repeats) for size in sizes),
        *(partial(measure, CELL, 1 / n, swirling(n), FINE, repeats) for n in cells),
        *(partial(measure, SPHERE, 1 / n, sphere(n), FINE, repeats) for n in round_it),
    ]


def curve_of(*ways: str) -> Callable[[Row], Curve | None]:
    """Return the curves of some methods, whose steps have one unit."""
    return lambda row: Curve(row.way) if row.way in ways else None


def verdict(rows: Sequence[Row]) -> str:
    """Return the largest suitable step, whether step or cells matter more, and the orders."""
    ways = {way: [row for row in rows if row.way == way] for way in (STEP, CELL, SPHERE)}
    steps = sorted(ways[STEP], key=lambda row: float(row.parameter))
    best = holding(steps, ALLOWED)
    if best is None:
        step = (
            f"use a step below {steps[0].parameter:g} cell lengths, whose drift is "
            f"{words(steps[0].error)} of the radius"
        )
    else:
        largest = ", the largest measured" if best is steps[-1] else ""
        step = (
            f"for a drift of 1/1000 of the radius use step={best.parameter:g} cell "
            f"lengths{largest}, with a drift of {words(best.error)}"
        )
    tracer = (best or steps[0]).error
    finest = max(min(row.error for row in ways[way]) for way in (CELL, SPHERE))
    refine = (
        f"refine the cells rather than the step, because the drift of the smallest cells is "
        f"{words(finest)}"
        if finest > tracer
        else f"refine the step before the cells, because the drift of the smallest cells is only "
        f"{words(finest)}"
    )
    return (
        f"{step}; {refine}; the drift falls with the cell size to the power "
        f"{order(ways[CELL]):.2f} in a volume and {order(ways[SPHERE]):.2f} on a surface, in "
        "theory 2"
    )


STUDY = Study(
    approximates="streamlines of rotating flows",
    reference="circles",
    parameter="step / cell size, or cell size / domain",
    error="drift / radius",
    cost="ns per point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "error"),
    curve=curve_of(STEP),
    x="step / cell size",
    beside=(
        Panel(
            axes=("parameter", "error"),
            curve=curve_of(CELL, SPHERE),
            x="cell size / domain",
        ),
    ),
)
