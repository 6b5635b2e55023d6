"""Time, error and memory of the engine, compared with a plain NumPy script.

The scene is the most expensive of the common ones: lines on a surface, a light with a position, a
perspective view, the compensated diffuse term, the Phong term and the self-shadow of the surface.
The script (:mod:`studies.script`) works on whole arrays. The engine runs its NumPy code
in blocks and, where numba is installed, compiled code. All are timed in turn, so a busy machine
slows all of them. A first call is that of a process of its own, with imports and the preparation
of compiled code.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from studies import SHINY, Row, Study, peak_memory, take_turns
from studies import script as reference
from vizlight import _compiled
from vizlight.model import brightness
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from vizlight._types import Array

SCENE = Scene(
    lights=Light(position=(4.0, 5.0, 6.0)), view=View(position=(0.0, 1.0, 9.0)), material=SHINY
)
#: Lights so many points in a process of its own; prints processor time and error.
FIRST_CALL = """
import sys, time
import numpy as np
from vizlight.shading import engine
from studies import script as reference
from studies.engine import SCENE
random = np.random.default_rng(7)
vectors = [random.standard_normal((int(sys.argv[1]), 3), dtype=np.float32) for _ in range(2)]
start = time.process_time()
lit = engine.shade(*vectors, SCENE)
print(time.process_time() - start)
exact = reference.light(*(v[:1000] for v in vectors), SCENE, exponent=lit.plan.exponent)
print(abs(lit.luminance[:1000] - exact).max())
"""


def measure(count: int, repeats: int = 5) -> list[Row]:
    """Return the rows of the script and of the engine, in float32 and float64."""
    exponent = brightness.exponent(1, 3)
    random = np.random.default_rng(20)
    single: list[Array] = [random.standard_normal((count, 3), np.float32) for _ in "ptn"]
    exact = reference.light(single[0], single[1], SCENE, normals=single[2], exponent=exponent)
    ways: dict[str, Callable[[], Array]] = {}
    kinds: tuple[type[np.float32] | type[np.float64], ...] = (np.float32, np.float64)
    for kind in kinds:
        name = kind.__name__
        dtype: np.dtype[np.floating] = np.dtype(kind)
        points, tangents, normals = (array.astype(dtype) for array in single)
        ways[f"NumPy script, {name}"] = partial(
            reference.light, points, tangents, SCENE, normals=normals, exponent=exponent, dtype=kind
        )
        light = partial(engine.shade, points, tangents, SCENE, normals=normals)
        ways[f"NumPy blocks, {name}"] = partial(_run, light, "0")
        if _compiled.active():
            ways[f"compiled, {name}"] = partial(_run, light, "1")
    seconds, rows = take_turns(ways, repeats), []
    for way, work in ways.items():
        result, script = work(), seconds[f"NumPy script, {way.split(', ')[1]}"]
        more = {
            "script / this": script / seconds[way],
            "extra MB": (peak_memory(work) - result.nbytes) / 1e6,
        }
        error, cost = float(np.abs(result - exact).max()), 1e9 * seconds[way] / count
        rows.append(Row(way, count, error, cost, more))
    return rows


def _run(light: Callable[[], engine.Shading], fast: str) -> Array:
    """Return the luminance by compiled code ("1") or by NumPy ("0")."""
    with _compiled.setting(fast):
        return light().luminance


def first_calls(counts: Sequence[int]) -> list[Row]:
    """Return the rows of first calls: by NumPy, and by compiled code made and read from disk."""
    rows = []
    compiled = [("first call, compiled", "1"), ("first call, compiled before", "1")]
    for count in counts:
        with tempfile.TemporaryDirectory(prefix="vizlight-") as folder:
            environment = {**os.environ, "XDG_CACHE_HOME": folder}
            environment["PYTHONPATH"] = str(Path(__file__).parents[1])
            for way, fast in [("first call, NumPy", "0"), *compiled * _compiled.active()]:
                environment["VIZLIGHT_FAST"] = fast
                run = subprocess.run(
                    [sys.executable, "-c", FIRST_CALL, str(count)],
                    env=environment, capture_output=True, text=True, check=True,
                )  # fmt: skip
                seconds, error = map(float, run.stdout.split())
                rows.append(Row(way, count, error, 1e9 * seconds / count))
    return rows


STUDY = Study(
    approximates=(
        "light of lines on a surface: light and eye with positions, compensated diffuse, Phong"
    ),
    reference="the formulas as a plain NumPy script in float64",
    parameter="points",
    error="largest error of luminance",
    cost="processor ns per point",
    steps=lambda quick: [
        lambda: measure(*(200_000, 4) if quick else (4_000_000, 9)),
        partial(first_calls, [10_000] if quick else [10**i for i in range(3, 8)]),
    ],
)
