"""Time, error and memory of the engine, compared with a plain NumPy script and with one pass.

The scene is the most expensive of the common ones: lines on a surface, a light with a position, a
perspective view, the compensated diffuse term, the Phong term and the self-shadow of the surface.
The script (:mod:`studies.reference`) works on whole arrays. The engine runs its NumPy code
in blocks and, where numba is installed, compiled code. One pass is ``O = P + T; O += N`` into an
output that is there already: the arrays are read once and little is computed. All are timed in
turn, so a busy machine slows all of them.
"""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from studies import PIXEL, SHINY, Row, Study, cheapest, note_spread, peak_memory, words
from vizlight import _compiled, _pool
from vizlight.model import brightness
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine
from vizlight.verify import reference

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

SCENE = Scene(
    lights=Light(position=(4.0, 5.0, 6.0)), view=View(position=(0.0, 1.0, 9.0)), material=SHINY
)
KINDS: dict[str, type[np.float32] | type[np.float64]] = {
    "float32": np.float32,
    "float64": np.float64,
}


def lines(count: int) -> tuple[Array, Array, Array]:
    """Return reproducible random points, tangents and normals of any length, in float32."""
    random = np.random.default_rng(20)
    points, tangents, normals = (
        random.standard_normal((count, 3)).astype(np.float32) for _ in range(3)
    )
    return points, tangents, normals


def measure(count: int, repeats: int = 5) -> list[Row]:
    """Return the rows of the study: the script, one pass, and the engine with several settings."""
    exponent = brightness.exponent(1, 3)
    single = lines(count)
    exact = np.concatenate(
        [
            reference.light(p, t, SCENE, normals=m, exponent=exponent)
            for i in range(0, count, 100_000)
            for p, t, m in [tuple(array[i : i + 100_000] for array in single)]
        ]
    )
    ways: dict[tuple[str, int], Callable[[], Array]] = {}
    for name, kind in KINDS.items():
        dtype: np.dtype[np.floating] = np.dtype(kind)
        points, tangents, normals = (array.astype(dtype) for array in single)
        ways[f"NumPy script, {name}", count] = partial(
            reference.light, points, tangents, SCENE, normals=normals, exponent=exponent, dtype=kind
        )
        ways[f"one pass, {name}", count] = partial(
            _pass, points, tangents, normals, np.empty_like(points)
        )
        light = partial(engine.shade, points, tangents, SCENE, normals=normals)
        block = engine.plan(SCENE, k=1, dtype=dtype).block
        for code, fast in (("NumPy blocks", "0"), ("compiled", "1")):
            if fast == "1" and not _compiled.active():
                continue
            ways[f"{code}, {name}", block] = partial(_run, light, fast)
            if name == "float32":
                ways[f"{code}, {name}, 1 thread", block] = partial(_alone, light, fast)
                for other in (1 << 12, 1 << 15, 1 << 20):
                    way = f"{code}, {name}, other blocks"
                    ways[way, other] = partial(_run, light, fast, block=other)
    seconds = _take_turns(ways, repeats)
    rows = []
    for (way, block), work in ways.items():
        result, name = work(), way.split(", ")[1]
        taken, processor = seconds[way, block]
        passing = "one pass" in way
        error = float("nan") if passing else float(np.abs(result - exact).max())
        more = {
            "wall ns": 1e9 * taken / count,
            "script / this": seconds[f"NumPy script, {name}", count][1] / processor,
            "this / pass": processor / seconds[f"one pass, {name}", count][1],
            "extra MB": 0.0 if passing else (peak_memory(work) - result.nbytes) / 1e6,
        }
        rows.append(Row(way, block, error, 1e9 * processor / count, more))
    return rows


def _pass(points: Array, tangents: Array, normals: Array, output: Array) -> Array:
    """Read three arrays once and write one."""
    np.add(points, tangents, out=output)
    output += normals
    return output


def _run(light: Callable[..., engine.Shading], fast: str, **options: int) -> Array:
    """Return the luminance by compiled code ("1") or by NumPy ("0")."""
    with _compiled.setting(fast):
        return light(**options).luminance


def _alone(light: Callable[..., engine.Shading], fast: str) -> Array:
    """Return the luminance by one thread."""
    with _pool.threads(1):
        return _run(light, fast)


def _take_turns(
    ways: dict[tuple[str, int], Callable[[], Array]], repeats: int
) -> dict[tuple[str, int], tuple[float, float]]:
    """Return the shortest wall time and processor time of each function, called in turn.

    The scripts, which take most of the time, are called three times at most.
    """
    times: dict[tuple[str, int], list[tuple[float, float]]] = {way: [] for way in ways}
    for i in range(repeats):
        for way, work in ways.items():
            if i < 3 or "script" not in way[0]:
                start = time.perf_counter(), time.process_time()
                work()
                taken = time.perf_counter() - start[0], time.process_time() - start[1]
                times[way].append(taken)
    for (name, _), each in times.items():
        if "other" not in name:
            note_spread([processor for _, processor in each])
    return {
        way: (min(wall for wall, _ in each), min(processor for _, processor in each))
        for way, each in times.items()
    }


def verdict(rows: Sequence[Row]) -> str:
    """Return which code, precision and block size to use, by processor time.

    The engine's defaults are kept unless another choice is clearly faster.
    """
    found = {row.way: row for row in rows if "other" not in row.way}
    usual = found.get("compiled, float32", found["NumPy blocks, float32"])
    high = found[usual.way.replace("float32", "float64")]
    best = cheapest([row for row in rows if "one pass" not in row.way], usual=usual)
    if best is None:
        return f"no method is within 1/255; the error of float64 is {high.error:.1g}"
    kept = "the engine's defaults, " if best is usual else ""
    blocks = found["NumPy blocks, float32"]
    return (
        f"for an error of 1/255 use {kept}'{best.way}' with blocks of {best.parameter} points: "
        f"{words(best.cost)} ns of processor time per point and an error of {best.error:.1g}, "
        f"{PIXEL / best.error:.0f} times smaller than allowed; that is "
        f"{words(float(best.more['script / this']))} times as fast as the script and takes "
        f"{words(float(best.more['this / pass']))} times as long as one pass over the arrays; "
        f"NumPy blocks cost {words(blocks.cost / best.cost)} times as much; float64 costs "
        f"{words(high.cost / best.cost)} times as much, with an error of {high.error:.1g}"
    )


STUDY = Study(
    approximates=(
        "light of lines on a surface: light and eye with positions, compensated diffuse, Phong"
    ),
    reference="the formulas as a plain NumPy script in float64",
    parameter="points per block",
    error="largest error of luminance",
    cost="processor ns per point",
    steps=lambda quick: [lambda: measure(*(200_000, 4) if quick else (4_000_000, 9))],
    verdict=verdict,
)
