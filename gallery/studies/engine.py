"""Time, error and memory of the engine, compared with a plain NumPy script.

The scene is the most expensive of the common ones: lines on a surface, a light with a position, a
perspective view, the compensated diffuse term, the Phong term and the self-shadow of the surface.
The script (:mod:`studies._script`) works on whole arrays, the engine in blocks. Both are timed
in turn, so a busy machine slows both. A first call is that of a process of its own, with imports.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import partial
from pathlib import Path

import numpy as np

from studies import SHINY, Row, Study, peak_memory, take_turns
from studies import _script as reference
from vizlight.model import brightness
from vizlight.scene import Light, Scene, View
from vizlight.shading import engine

SCENE = Scene(
    lights=Light(position=(4.0, 5.0, 6.0)), view=View(position=(0.0, 1.0, 9.0)), material=SHINY
)
#: Lights so many points in a process of its own; prints processor time and error.
FIRST_CALL = """
import sys, time
import numpy as np
from vizlight.shading import engine
from studies import _script as reference
from studies.engine import SCENE
random = np.random.default_rng(7)
vectors = [random.standard_normal((int(sys.argv[1]), 3), dtype=np.float32) for _ in range(2)]
start = time.process_time()
lit = engine.shade(*vectors, SCENE)
print(time.process_time() - start)
exact = reference.light(*(v[:1000] for v in vectors), SCENE, exponent=lit.plan.exponent)
print(abs(lit.luminance[:1000] - exact).max())
"""


def measure(count, repeats=5):
    """Return the rows of the script and of the engine, in float32 and float64."""
    exponent = brightness.exponent(1, 3)
    random = np.random.default_rng(20)
    single = [random.standard_normal((count, 3), np.float32) for _ in "ptn"]
    exact = reference.light(single[0], single[1], SCENE, normals=single[2], exponent=exponent)
    ways = {}
    for kind in (np.float32, np.float64):
        name = kind.__name__
        points, tangents, normals = (array.astype(kind) for array in single)
        ways[f"NumPy script, {name}"] = partial(
            reference.light, points, tangents, SCENE, normals=normals, exponent=exponent, dtype=kind
        )
        ways[f"blocks, {name}"] = partial(_run, points, tangents, normals)
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


def _run(points, tangents, normals):
    return engine.shade(points, tangents, SCENE, normals=normals).luminance


def first_calls(counts):
    """Return the rows of first calls."""
    rows = []
    for count in counts:
        run = subprocess.run(
            [sys.executable, "-c", FIRST_CALL, str(count)],
            env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[1])},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        seconds, error = map(float, run.stdout.split())
        rows.append(Row("first call", count, error, 1e9 * seconds / count))
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
