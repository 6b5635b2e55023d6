"""What a point costs in n-space: to light, to turn, to project, in time and memory.

The error is that of float32 work against float64 in the same space.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight.filters import project
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.studies._framework import PIXEL, Curve, Panel, Row, Study, span, words
from vizlight.studies._measuring import peak_memory, take_turns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

SPACES = ((1, 3), (2, 3), (1, 4), (2, 4), (1, 8), (2, 8), (7, 8))


def cost(k: int, n: int, count: int = 500_000, repeats: int = 3) -> list[Row]:
    """Return what a point costs for one k and n."""
    random = np.random.default_rng(0)
    points, tangents = random.standard_normal((count, n)), random.standard_normal((count, k, n))
    scene = Scene(lights=Light(direction=np.arange(1.0, n + 1)), view=View(position=np.ones(n)))
    mesh = pv.PointSet(points[:, :3].copy())
    mesh.point_data["position"], mesh.point_data["frame"] = points, tangents.reshape(count, -1)
    matrix = np.linalg.qr(random.standard_normal((n, n)))[0]
    matrix[0] *= np.sign(np.linalg.det(matrix))
    ways: dict[str, Callable[[], Any]] = {
        "light": partial(engine.shade, points, tangents, scene),
        "light, float32": partial(engine.shade, points, tangents, scene, precision="float32"),
        "turn and project": partial(project, mesh, rotation=matrix),
        "project": partial(project, mesh, distance=100.0),
    }
    seconds = take_turns(ways, repeats)
    # Beyond the result: arrays in n-space if they turn, points and frame in 3-space.
    output = 8 * count * (n + k * n + 3 + (3 * k if k < 3 else 0))
    extra = (peak_memory(ways["turn and project"]) - output) / count
    high, low = (ways[way]().luminance for way in ("light", "light, float32"))
    # Nearly dependent tangents amplify rounding: what 99.9 % of the points stay below.
    errors = {"light, float32": float(np.quantile(np.abs(high - low), 0.999))}
    return [
        Row(
            way, n, errors.get(way, np.nan), 1e9 * taken / count,
            {"k": k, "bytes beyond the result": extra if way == "turn and project" else np.nan},
        )
        for way, taken in seconds.items()
    ]  # fmt: skip


def verdict(rows: Sequence[Row]) -> str:
    """Return where float32 pays and what a surface in 4-space costs."""
    pairs: dict[str, list[Row]] = {}
    for row in rows:
        pairs.setdefault(row.way, []).append(row)
    high, low = pairs["light"], pairs["light, float32"]
    gain = {(a.more["k"], a.parameter): a.cost / b.cost for a, b in zip(high, low, strict=True)}
    pays = [space for space, times in gain.items() if times > 1]
    worst = max(row.error for row in low)
    here = next(r for r in high if (r.more["k"], r.parameter) == (2, 4))
    turn = next(r for r in pairs["turn and project"] if (r.more["k"], r.parameter) == (2, 4))
    if worst > PIXEL or not pays:
        said = f"keep precision='float64': float32 is {span(gain.values())} times as fast"
    elif len(pays) == len(gain):
        said = f"use precision='float32': {span(gain.values())} times as fast"
    else:
        where = ", ".join(f"({k:g}, {n:g})" for k, n in pays)
        rest = (times for space, times in gain.items() if space not in pays)
        said = (
            f"use precision='float32' for (k, n) = {where}: "
            f"{span(gain[space] for space in pays)} times as fast, elsewhere {span(rest)} times"
        )
    return (
        f"at 1/255 of error {said}, off by {worst:.1g}; a surface in 4-space takes "
        f"{words(here.cost)} ns a point to light and {words(turn.cost)} to turn and project"
    )


def curve_of(*ways: str) -> Callable[[Row], Curve | None]:
    """Return what shows these ways, a curve for each k."""
    return lambda row: Curve(row.way, f"k = {row.more['k']:g}") if row.way in ways else None


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return a step for each space."""
    count, repeats = (100_000, 9) if quick else (500_000, 5)
    return [partial(cost, k, n, count, repeats) for k, n in SPACES]


STUDY = Study(
    approximates="light in n-space by float32 work",
    reference="float64 work",
    parameter="n",
    error="error of luminance, 99.9 % of points",
    cost="ns a point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "cost"),
    curve=curve_of("light", "light, float32"),
    beside=(Panel(axes=("parameter", "cost"), curve=curve_of("turn and project", "project")),),
)
