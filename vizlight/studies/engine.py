"""The engine against a plain NumPy script: time, error and memory, measured in one run.

``python -m vizlight.studies.engine [POINTS]`` prints the table. The scene is the costly one of
everyday work: lines lit by a positional light under a perspective view, compensated diffuse and
Phong's term. The script (:mod:`vizlight.studies.reference`) works on whole arrays; script and
engine take turns, so that a busy machine slows both.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import cyclopts
import numpy as np

from vizlight import engine
from vizlight.light import Light
from vizlight.model import brightness
from vizlight.scene import Scene, View
from vizlight.studies import reference
from vizlight.studies._measure import peak_memory, print_table, take_turns

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Array = NDArray[np.floating[Any]]

SCENE = Scene(lights=Light(position=(4.0, 5.0, 6.0)), view=View(position=(0.0, 1.0, 9.0)))


@dataclass(frozen=True)
class Row:
    """One way to light the points."""

    way: str
    seconds: float
    error: float
    extra_bytes: int


def lines(count: int, dtype: Any = np.float32) -> tuple[Array, Array]:
    """Return points around the origin and tangents of any length, seeded."""
    random = np.random.default_rng(20)
    return tuple(random.standard_normal((count, 3)).astype(dtype) for _ in range(2))  # type: ignore[return-value]


def measure(count: int, repeats: int = 5) -> list[Row]:
    """Return the rows of the study: the script first, then the engine's settings."""
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

    ways: dict[str, Callable[[], Array]] = {
        "NumPy script, float32": script,
        "engine, float32": run(),
        "engine, float32, 1 thread": run(threads=1),
        "engine, float64": run(precision="float64"),
    }
    for block in (1 << 12, 1 << 15, 1 << 20):
        ways[f"engine, float32, blocks of {block}"] = run(block=block)
    seconds = take_turns(ways, repeats)
    rows = []
    for way, work in ways.items():
        result = work()
        error = float(np.abs(result - exact).max())
        rows.append(Row(way, seconds[way], error, peak_memory(work) - result.nbytes))
    return rows


def main(count: int = 4_000_000) -> None:
    """Print the table.

    Parameters
    ----------
    count
        How many points are lit.
    """
    rows = measure(count)
    print_table(
        f"{count} float32 points, positional light, perspective, Phong",
        ("way", "median, s", "ns a point", "times as fast", "largest error", "extra MB"),
        [
            (
                row.way,
                f"{row.seconds:.3f}",
                f"{1e9 * row.seconds / count:.1f}",
                f"{rows[0].seconds / row.seconds:.1f}",
                f"{row.error:.1e}",
                f"{row.extra_bytes / 1e6:.1f}",
            )
            for row in rows
        ],
    )


if __name__ == "__main__":
    cyclopts.run(main)
