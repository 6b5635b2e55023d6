"""Cos-theta shadows on height fields: speed against error, and how both grow with the field.

``python -m vizlight.studies.relief`` lights fields of random hills, whose power falls with the
frequency as that of terrain does, and a hemisphere on a plane, whose shadow is known in closed
form. Times are those of one processor, which a busy machine changes little.
"""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import cyclopts
import numpy as np

from vizlight.geometry import relief
from vizlight.studies._measure import peak_memory, print_table

if TYPE_CHECKING:
    from collections.abc import Callable

#: Of random hills: how fast the amplitude falls with the frequency, and the highest, both as of
#: rough mountains of 15 km.
FALL, HIGH = 1.8, 0.15
DEPTH = 0.005


@dataclass(frozen=True)
class Row:
    """Seconds of one processor by method on side^2 points, errors in t, bytes a point."""

    side: int
    fast: float
    exact: float
    mean: float
    largest: float
    memory: float


def hills(side: int, seed: int = 0) -> Any:
    """Return heights over a unit square; more points show finer hills."""
    random = np.random.default_rng(seed)
    k = np.fft.fftfreq(side)
    frequency = np.hypot(*np.meshgrid(k, k))
    frequency[0, 0] = 1
    phase = 2j * np.pi * random.random((side, side))
    z = np.fft.ifft2(frequency**-FALL * np.exp(phase)).real
    return (z - z.min()) * (HIGH / np.ptp(z))


def sun(height: float, azimuth: float = 40.0) -> Any:
    """Return a direction from angles in degrees."""
    e, a = np.radians([height, azimuth])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def processor_seconds(work: Callable[[], Any], repeats: int) -> float:
    """Return the median seconds that this process computes."""
    taken = []
    for _ in range(repeats):
        start = time.process_time()
        work()
        taken.append(time.process_time() - start)
    return statistics.median(taken)


def measure(side: int, height: float = 20.0, repeats: int = 3) -> Row:
    """Return one row of the first table."""
    x, z = np.linspace(0, 1, side), hills(side)

    def light(method: relief.Method) -> Any:
        return relief.shadow(x, x, z, depth=DEPTH, direction=sun(height), method=method, threads=1)

    fast = processor_seconds(lambda: light("fast"), repeats)
    exact = processor_seconds(lambda: light("exact"), repeats)
    error = np.abs(light("fast") - light("exact"))
    memory = peak_memory(lambda: light("fast")) / side**2
    return Row(side, fast, exact, float(error.mean()), float(error.max()), memory)


def hemisphere(side: int, method: relief.Method, depth: float = 0.1) -> tuple[float, float]:
    """Return mean and largest error in t of a unit hemisphere on a plane of 6 x 6."""
    x = np.linspace(-3, 3, side)
    z = np.sqrt(np.maximum(1 - x**2 - x[:, None] ** 2, 0))
    places = np.stack([*np.meshgrid(x, x), z], axis=-1)
    normal = np.where(z[..., None] > 0, places, [0, 0, 1.0])
    start, way = places - depth * normal, sun(35, 20)
    middle = -(start @ way)
    half = np.sqrt(np.maximum(1 - np.einsum("ijk,ijk->ij", start, start) + middle**2, 0))
    ground = np.maximum(-start[..., 2] / way[2], 0)
    low = np.maximum(middle - half, ground)
    length = ground + np.maximum(middle + half - low, 0) * (half > 0)
    expected = depth / np.maximum(length, depth)
    t = relief.shadow(x, x, z, depth=depth, direction=way, normals=normal, method=method)
    error = np.abs(t - expected)
    return float(error.mean()), float(error.max())


def day(columns: int = 550, rows: int = 505, heights: int = 25) -> float:
    """Return one processor's seconds for so many heights of the sun over one field, fast."""
    z = hills(max(columns, rows))[:rows, :columns]
    x, y = np.arange(columns) / columns, np.arange(rows) / columns

    def work() -> None:
        for height in np.linspace(4, 76, heights):
            relief.shadow(x, y, z, depth=DEPTH, direction=sun(height), threads=1)

    return processor_seconds(work, 1)


def main(sides: tuple[int, ...] = (512, 1024, 2048), repeats: int = 3, heights: int = 25) -> None:
    """Print the tables.

    Parameters
    ----------
    sides
        Of the fields, in points.
    repeats
        Of which the median is told.
    heights
        Of the sun over one field.
    """
    table, before = [], None
    for side in sides:
        row = measure(side, repeats=repeats)
        grows = f"{row.fast / before.fast:.2f}" if before else ""
        before = row
        table.append(
            (
                f"{side} x {side}", f"{row.fast:.2f}", f"{1e9 * row.fast / side**2:.0f}", grows,
                f"{row.exact:.2f}", f"{row.mean:.1e}", f"{row.largest:.2f}", f"{row.memory:.0f}",
            )
        )  # fmt: skip
    print_table(
        "Random hills, sun at 20 degrees",
        (
            "field", "fast, s", "ns a point", "times the one before", "exact, s",
            "mean error of t", "largest", "bytes a point",
        ),
        table,
    )  # fmt: skip
    ways: tuple[relief.Method, ...] = ("fast", "exact")
    print_table(
        "Hemisphere on a plane against its closed form: error of t, mean and largest",
        ("field", *ways),
        [
            (f"{n} x {n}", *("{:.1e}, {:.2f}".format(*hemisphere(n, way)) for way in ways))
            for n in (151, 301, 601)
        ],
    )
    print_table(
        f"{heights} heights of the sun over 550 x 505 points",
        ("way", "s"),
        [("fast", f"{day(heights=heights):.1f}")],
    )


if __name__ == "__main__":
    cyclopts.run(main)
