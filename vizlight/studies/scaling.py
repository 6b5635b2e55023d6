"""How time and memory grow with the number of points, up to 1e8 from a file on disk.

Lines, a light and an eye nearby, float32. The largest run reads points and tangents block by block
from memory-mapped files and is left out where disk or memory do not hold it.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from vizlight.shading import engine
from vizlight.studies import reference
from vizlight.studies._framework import PIXEL, Row, Study, words
from vizlight.studies._measuring import peak_memory
from vizlight.studies.engine import SCENE

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

#: Points written to the files at a time, and checked against the script.
CHUNK, CHECKED = 1_000_000, 10_000
#: Times that the smallest numbers of points are lit while the largest is once.
MOST = 5
#: Bytes a point: points and tangents on disk, light and validity in memory.
ON_DISK, IN_MEMORY = 24, 5


def made(count: int, seed: int = 7) -> Array:
    """Return vectors in float32, seeded."""
    return np.random.default_rng(seed).standard_normal((count, 3), dtype=np.float32)


def measure(
    points: Array, tangents: Array, counts: Sequence[int], way: str, seconds: float
) -> list[Row]:
    """Return a row for the first so many points: best times, peak beyond the output, error.

    The counts take turns until so many seconds are over, so that a busy machine slows all, and in
    a turn each takes the same time, so that each is as likely to be left alone. Processor time
    leaves out what other programs take.
    """
    best = {count: np.full(2, np.inf) for count in counts}
    end = time.perf_counter() + seconds
    while np.inf in best[counts[-1]] or time.perf_counter() < end:
        for count in counts:
            work = partial(engine.shade, points[:count], tangents[:count], SCENE)
            for _again in range(min(max(counts) // count, MOST)):
                start = _clocks()
                work()
                best[count] = np.minimum(best[count], _clocks() - start)
    at = slice(0, min([*counts, CHECKED]))
    lit = engine.shade(points[at], tangents[at], SCENE)
    exact = reference.light(
        np.asarray(points[at]), np.asarray(tangents[at]), SCENE, exponent=lit.plan.exponent
    )
    error = float(np.abs(lit.luminance - exact).max())
    rows = []
    for count in counts:
        work = partial(engine.shade, points[:count], tangents[:count], SCENE)
        extra = peak_memory(work) - IN_MEMORY * count
        taken, processor = map(float, best[count])
        more = {"s": taken, "processor s": processor, "MB beyond the output": extra / 1e6}
        rows.append(Row(way, count, error, 1e9 * taken / count, more))
    return rows


def _clocks() -> Array:
    """Return the seconds now, and those that the processors have worked."""
    return np.array([time.perf_counter(), time.process_time()])


def in_memory(counts: Sequence[int], seconds: float) -> list[Row]:
    """Return the rows of points in memory, for which so many seconds are taken."""
    largest = max(counts)
    return measure(made(largest), made(largest, 8), counts, "in memory", seconds)


def from_disk(count: int) -> list[Row]:
    """Return the row of points in files, or none where disk or memory do not hold them."""
    folder = Path(tempfile.gettempdir())
    free = 0
    if hasattr(os, "sysconf"):
        free = os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    if shutil.disk_usage(folder).free < 2 * ON_DISK * count or free < 4 * IN_MEMORY * count:
        return []
    with tempfile.TemporaryDirectory(prefix="vizlight-", dir=folder) as place:
        files = []
        for seed, name in enumerate(("points", "tangents")):
            file = np.memmap(Path(place) / name, np.float32, "w+", shape=(count, 3))
            for i in range(0, count, CHUNK):
                size = min(CHUNK, count - i)
                file[i : i + size] = made(size, seed + 2 * i)
            file.flush()
            files.append(file)
        rows = measure(files[0], files[1], [count], "in blocks from disk", 0.0)
        del files, file
    return rows


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return a step for each number of points."""
    counts = [10_000, 100_000, 1_000_000, 2_000_000, 5_000_000, 10_000_000]
    if not quick:
        counts.append(20_000_000)
    return [
        partial(in_memory, counts, 9.0 if quick else 60.0),
        partial(from_disk, 2_000_000 if quick else 100_000_000),
    ]


def exponent(rows: Sequence[Row], least: float = 1e6) -> float:
    """Return the power of the number of points with which work grows, above so many."""
    large = [row for row in rows if float(row.parameter) > least and row.way == "in memory"]
    x, y = np.log([(float(row.parameter), float(row.more["processor s"])) for row in large]).T
    return float((x - x.mean()) @ (y - y.mean()) / ((x - x.mean()) @ (x - x.mean())))


def verdict(rows: Sequence[Row]) -> str:
    """Return the exponent, and how large a mesh may be."""
    largest = rows[-1]
    extra = max(float(row.more["MB beyond the output"]) for row in rows)
    grows = exponent(rows)
    plan = "count on" if abs(grows - 1) <= 0.05 else "do not count on"
    right = "within" if max(row.error for row in rows) <= PIXEL else "not within"
    return (
        f"{plan} time in step with the number of points: above 1e6 the processors' time grows "
        f"with the power {grows:.3f}, in theory 1; {largest.parameter:.1g} points {largest.way} "
        f"take {words(float(largest.more['s']))} s, {right} 1/255, and {words(extra)} MB beyond "
        "the output are enough for any mesh"
    )


STUDY = Study(
    approximates="the light of many lines, in float32 and in blocks",
    reference="the formulas as a plain NumPy script in float64, of the first points",
    parameter="points",
    error="largest error of luminance",
    cost="ns a point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "cost"),
)
