"""Growth of time and memory with the number of points, up to 1e8 points from files on disk.

The scene has lines, a light and an eye with positions, and float32 arrays. The first call of a
process also imports numba and compiles a kernel, or reads it from the disk. The largest run reads
points and tangents block by block from memory-mapped files. It is skipped if the disk or the memory
is too small.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from studies import PIXEL, Row, Study, note_spread, peak_memory, slope, words
from studies.engine import SCENE
from vizlight import _compiled
from vizlight.shading import engine
from vizlight.verify import reference

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

#: Points written to the files at a time, and points compared with the script.
CHUNK, CHECKED = 1_000_000, 10_000
#: Largest number of calls with few points per call with the largest number of points.
MOST = 5
#: Number of points above which processor times decide the verdict.
LEAST = 1e6
#: Bytes per point: points and tangents on disk, light and validity in memory.
ON_DISK, IN_MEMORY = 24, 5
#: Lights so many points in a process of its own; prints wall time, processor time and error.
FIRST_CALL = """
import sys, time
import numpy as np
from vizlight.shading import engine
from vizlight.verify import reference
from studies.engine import SCENE
random = np.random.default_rng(7)
vectors = [random.standard_normal((int(sys.argv[1]), 3), dtype=np.float32) for _ in range(2)]
start = time.perf_counter(), time.process_time()
lit = engine.shade(*vectors, SCENE)
print(time.perf_counter() - start[0], time.process_time() - start[1])
exact = reference.light(*(v[:1000] for v in vectors), SCENE, exponent=lit.plan.exponent)
print(abs(lit.luminance[:1000] - exact).max())
"""


def random_vectors(count: int, seed: int = 7) -> Array:
    """Return reproducible random vectors in float32."""
    return np.random.default_rng(seed).standard_normal((count, 3), dtype=np.float32)


def measure(
    points: Array, tangents: Array, counts: Sequence[int], way: str, seconds: float
) -> list[Row]:
    """Return one row for each number of points, with the shortest times, memory and error.

    The numbers of points are timed in turn until the given seconds have passed, so a busy machine
    slows all of them. Small numbers are lit several times per turn, so each takes a similar part
    of the time. The processor time excludes other programs.
    """
    times: dict[int, list[Array]] = {count: [] for count in counts}
    end = time.perf_counter() + seconds
    while not times[counts[-1]] or time.perf_counter() < end:
        for count in counts:
            work = partial(engine.shade, points[:count], tangents[:count], SCENE)
            for _ in range(min(max(counts) // count, MOST)):
                start = _clocks()
                work()
                times[count].append(_clocks() - start)
    for count, each in times.items():
        if count > LEAST:
            note_spread([float(processor) for _, processor in each])
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
        taken, processor = map(float, np.min(times[count], axis=0))
        more = {"s": taken, "processor s": processor, "MB beyond the output": extra / 1e6}
        rows.append(Row(way, count, error, 1e9 * taken / count, more))
    return rows


def _clocks() -> Array:
    """Return the wall clock and the processor time of this process, in seconds."""
    return np.array([time.perf_counter(), time.process_time()])


def in_memory(counts: Sequence[int], seconds: float) -> list[Row]:
    """Return the rows of points in memory, measured for the given number of seconds."""
    largest = max(counts)
    points, tangents = random_vectors(largest), random_vectors(largest, 8)
    return measure(points, tangents, counts, "in memory", seconds)


def from_disk(count: int) -> list[Row]:
    """Return the row of points in files, or no row if the disk or the memory is too small."""
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
                file[i : i + size] = random_vectors(size, seed + 2 * i)
            file.flush()
            files.append(file)
        rows = measure(files[0], files[1], [count], "in blocks from disk", 0.0)
        del files, file
    return rows


def first_call(count: int, folder: str, way: str, fast: str) -> list[Row]:
    """Return the row of a process's first call, with import and preparation of compiled code.

    ``fast`` is the setting of VIZLIGHT_FAST; compiled code is kept in the folder.
    """
    script = Path(folder, "first_call.py")
    script.write_text(FIRST_CALL, encoding="utf-8")
    environment = {**os.environ, "VIZLIGHT_FAST": fast, "XDG_CACHE_HOME": folder}
    environment["PYTHONPATH"] = str(Path(__file__).parents[1])
    run = subprocess.run(
        [sys.executable, str(script), str(count)],
        env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    taken, processor, error = map(float, run.stdout.split())
    more = {"s": taken, "processor s": processor}
    return [Row(way, count, error, 1e9 * taken / count, more)]


def first_calls(counts: Sequence[int]) -> list[Row]:
    """Return the rows of first calls: by NumPy, and by compiled code made and read from disk."""
    rows: list[Row] = []
    for count in counts:
        with tempfile.TemporaryDirectory(prefix="vizlight-") as folder:
            rows += first_call(count, folder, "first call, NumPy", "0")
            if _compiled.active():
                rows += first_call(count, folder, "first call, compiled", "1")
                rows += first_call(count, folder, "first call, compiled before", "1")
    return rows


def steps(quick: bool) -> list[Callable[[], list[Row]]]:
    """Return the steps: points in memory, then points on disk."""
    counts = [10_000, 100_000, 1_000_000, 2_000_000, 5_000_000, 10_000_000]
    if not quick:
        counts.append(20_000_000)
    return [
        partial(in_memory, counts, 9.0 if quick else 60.0),
        partial(first_calls, [10_000] if quick else [10**i for i in range(3, 9)]),
        partial(from_disk, 2_000_000 if quick else 100_000_000),
    ]


def exponent(rows: Sequence[Row], least: float = LEAST) -> float:
    """Return the exponent of the growth of processor time with the number of points.

    Only rows in memory with more than ``least`` points are taken.
    """
    large = [row for row in rows if float(row.parameter) > least and row.way == "in memory"]
    times = [float(row.more["processor s"]) for row in large]
    return slope([float(row.parameter) for row in large], times)


def verdict(rows: Sequence[Row]) -> str:
    """Return the exponent of the time, and the cost of the largest mesh."""
    largest = rows[-1]
    lasting = [row for row in rows if "MB beyond the output" in row.more]
    extra = max(float(row.more["MB beyond the output"]) for row in lasting)
    grows = exponent(rows)
    expect = "expect" if abs(grows - 1) <= 0.05 else "do not expect"
    right = "within" if max(row.error for row in rows) <= PIXEL else "not within"
    return (
        f"{expect} time proportional to the number of points: above 1e6 points the processor time "
        f"grows with the power {grows:.3f}, in theory 1; {largest.parameter:.1g} points "
        f"{largest.way} take {words(float(largest.more['s']))} s with an error {right} 1/255; "
        f"memory beyond the output is at most {words(extra)} MB for any number of points"
    )


STUDY = Study(
    approximates="light of many lines in float32 and in blocks",
    reference="the formulas as a plain NumPy script in float64, for the first points",
    parameter="points",
    error="largest error of luminance",
    cost="ns per point",
    steps=steps,
    verdict=verdict,
    axes=("parameter", "cost"),
)
