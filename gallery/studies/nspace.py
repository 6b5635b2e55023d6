"""Time and memory per point in n-space for lighting, rotation and projection.

The error is that of float32 relative to float64.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from studies import PIXEL, SHINY, Curve, Panel, Row, Study, peak_memory, span, take_turns, words
from vizlight.filters.project import project
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

SPACES = ((1, 3), (2, 3), (1, 4), (2, 4), (1, 8), (2, 8), (7, 8))
ROTATE = "rotate and project"


def cost(k: int, n: int, count: int = 500_000, repeats: int = 3) -> list[Row]:
    """Return one row for each operation, for one k and n."""
    random = np.random.default_rng(0)
    points, tangents = random.standard_normal((count, n)), random.standard_normal((count, k, n))
    lamp, view = Light(direction=np.arange(1.0, n + 1)), View(position=np.ones(n))
    scene = Scene(lights=lamp, view=view, material=SHINY)
    mesh = pv.PointSet(points[:, :3].copy())
    mesh.point_data["position"], mesh.point_data["frame"] = points, tangents.reshape(count, -1)
    matrix = np.linalg.qr(random.standard_normal((n, n)))[0]
    matrix[0] *= np.sign(np.linalg.det(matrix))
    light = partial(engine.shade, points, tangents, scene)
    single = partial(light, precision="float32")
    rotate = partial(project, mesh, rotation=matrix)
    ways: dict[str, Callable[[], object]] = {
        "light": light,
        "light, float32": single,
        ROTATE: rotate,
        "project": partial(project, mesh, distance=100.0),
    }
    seconds = take_turns(ways, repeats)
    # The result holds rotated arrays in n-space, and points and frames in 3-space.
    output = 8 * count * (n + k * n + 3 + (3 * k if k < 3 else 0))
    extra = (peak_memory(rotate) - output) / count
    # A quantile, because nearly dependent tangents of a few points amplify rounding.
    difference = np.abs(light().luminance - single().luminance)
    errors = {"light, float32": float(np.quantile(difference, 0.999))}
    return [
        Row(
            way, n, errors.get(way, np.nan), 1e9 * taken / count,
            {"k": k, "bytes beyond the result": extra if way == ROTATE else np.nan},
        )
        for way, taken in seconds.items()
    ]  # fmt: skip


def verdict(rows: Sequence[Row]) -> str:
    """Return for which spaces to use float32, and the cost of a surface in 4-space."""
    costs = {(row.way, row.more["k"], row.parameter): row.cost for row in rows}
    gain = {
        (k, n): cost / costs["light, float32", k, n]
        for (way, k, n), cost in costs.items()
        if way == "light"
    }
    worst = max(row.error for row in rows if row.way == "light, float32")
    return (
        f"for an error of 1/255 {_precision(gain, worst)}, with an error of {worst:.1g}; a surface "
        f"in 4-space takes {words(costs['light', 2, 4])} ns per point to light and "
        f"{words(costs[ROTATE, 2, 4])} to rotate and project"
    )


def _precision(gain: Mapping[tuple[float | str, float | str], float], error: float) -> str:
    """Return which precision to use where, from the speed of float32 relative to float64."""
    faster = [space for space, times in gain.items() if times > 1]
    if error > PIXEL or not faster:
        return f"keep precision='float64': float32 is {span(gain.values())} times as fast"
    if len(faster) == len(gain):
        return f"use precision='float32': {span(gain.values())} times as fast"
    where = ", ".join(f"({k:g}, {n:g})" for k, n in faster)
    rest = (times for space, times in gain.items() if space not in faster)
    return (
        f"use precision='float32' for (k, n) = {where}: "
        f"{span(gain[space] for space in faster)} times as fast, elsewhere {span(rest)} times"
    )


def curve_of(*ways: str) -> Callable[[Row], Curve | None]:
    """Return the function from a row of these methods to its curve, one for each k."""
    return lambda row: Curve(row.way, f"k = {row.more['k']:g}") if row.way in ways else None


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return one step for each space."""
    count, repeats = (100_000, 9) if quick else (500_000, 5)
    return [partial(cost, k, n, count, repeats) for k, n in SPACES]


STUDY = Study(
    approximates="light in n-space by computation in float32",
    reference="computation in float64",
    parameter="n",
    error="error of luminance, 99.9 % of points",
    cost="ns per point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "cost"),
    curve=curve_of("light", "light, float32"),
    beside=(Panel(axes=("parameter", "cost"), curve=curve_of(ROTATE, "project")),),
)
