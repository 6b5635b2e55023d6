"""Time, error and memory of the engine compared with a plain NumPy script.

The scene is the most expensive of the common ones: lines, a light with a position, a perspective
view, the compensated diffuse term and the Phong term. The script
(:mod:`vizlight.studies.reference`) works on whole arrays. Script and engine are timed in turn, so a
busy machine slows both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.model import brightness
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.studies import reference
from vizlight.studies._framework import PIXEL, Row, Study, cheapest, words
from vizlight.studies._measuring import peak_memory, take_turns

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

SCENE = Scene(lights=Light(position=(4.0, 5.0, 6.0)), view=View(position=(0.0, 1.0, 9.0)))


def lines(count: int) -> tuple[Array, Array]:
    """Return reproducible random points and tangents of any length, in float32."""
    random = np.random.default_rng(20)
    points, tangents = (random.standard_normal((count, 3)).astype(np.float32) for _ in range(2))
    return points, tangents


def measure(count: int, repeats: int = 5) -> list[Row]:
    """Return the rows of the study: the script, then the engine with several settings."""
    points, tangents = lines(count)
    exponent = brightness.exponent(1, 3)
    exact = np.concatenate(
        [
            reference.light(
                points[i : i + 100_000], tangents[i : i + 100_000], SCENE, exponent=exponent
            )
            for i in range(0, count, 100_000)
        ]
    )

    def script() -> Array:
        return reference.light(points, tangents, SCENE, exponent=exponent, dtype=np.float32)

    def run(**options: Any) -> Callable[[], Array]:
        return lambda: engine.shade(points, tangents, SCENE, **options).luminance

    whole, own = count, engine.plan(SCENE, k=1, dtype=np.float32).block
    ways: dict[tuple[str, int], Callable[[], Array]] = {
        ("NumPy script, float32", whole): script,
        ("engine, float32", own): run(),
        ("engine, float32, 1 thread", own): run(threads=1),
        ("engine, float64", engine.plan(SCENE, k=1).block): run(precision="float64"),
    }
    for block in (1 << 10, 1 << 12, 1 << 15, 1 << 20):
        ways["engine, float32, other blocks", block] = run(block=block)
    seconds = take_turns(ways, repeats)
    rows = []
    for (way, block), work in ways.items():
        result, taken = work(), seconds[way, block]
        more = {
            "times as fast": seconds["NumPy script, float32", whole] / taken,
            "extra MB": (peak_memory(work) - result.nbytes) / 1e6,
        }
        error = float(np.abs(result - exact).max())
        rows.append(Row(way, block, error, 1e9 * taken / count, more))
    return rows


def verdict(rows: Sequence[Row]) -> str:
    """Return which precision and block size to use: the defaults unless they are clearly slower."""
    own = next(row for row in rows if row.way == "engine, float32")
    high = next(row for row in rows if row.way == "engine, float64")
    best = cheapest(rows, usual=own)
    if best is None:
        return f"no method is within 1/255; the error of float64 is {high.error:.1g}"
    kept = "the engine's defaults, " if best is own else ""
    other = min(
        (row for row in rows if row.way.startswith("engine, float32") and row is not best),
        key=lambda row: row.cost,
    )
    return (
        f"for an error of 1/255 use {kept}'{best.way}' with blocks of {best.parameter} points: "
        f"{words(best.cost)} ns per point and an error of {best.error:.1g}, "
        f"{PIXEL / best.error:.0f} times smaller than allowed; float64 costs "
        f"{words(high.cost / best.cost)} times as much, with an error of {high.error:.1g}; the "
        f"next method in float32, '{other.way}' with blocks of {other.parameter} points, costs "
        f"{words(other.cost / best.cost)} times as much"
    )


STUDY = Study(
    approximates="light of lines: light with a position, perspective, compensated diffuse, Phong",
    reference="the formulas as a plain NumPy script in float64",
    parameter="points per block",
    error="largest error of luminance",
    cost="ns per point",
    steps=lambda quick: [lambda: measure(500_000 if quick else 4_000_000, 9)],
    verdict=verdict,
)
