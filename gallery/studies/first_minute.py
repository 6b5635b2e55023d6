"""The first minute: what a newcomer waits for, in processor time against the plain way.

Each task is measured in turn with its peer: processes from their start to their end, functions
from their second call on. A task may take some times its peer, and some seconds more.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from functools import cache, partial
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import matplotlib as mpl
import numpy as np
import pyvista as pv

import vizlight
from studies import Row, Study, take_turns
from vizlight import Light, Scene, View

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

SCENE = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)))
#: Numbers of points of the files of which pictures are made.
SIZES = 10_000, 1_000_000, 5_000_000
#: The plain script that draws a file.
PLAIN = """
import sys, pyvista as pv
plotter = pv.Plotter(off_screen=True, window_size=(1200, 800))
plotter.add_mesh(pv.read(sys.argv[1]), smooth_shading=True)
plotter.screenshot(sys.argv[2])
"""
IMPORT = "import pyvista as pv; pv.Sphere()"
FIRST = """
import pyvista as pv, vizlight
scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
pv.Sphere().vizlight.illuminate(scene)
"""
RELIEF = """
import numpy as np, pyvista as pv, vizlight
x, y = np.meshgrid(np.arange(256.0), np.arange(256.0))
field = pv.StructuredGrid(x, y, 5 * np.sin(x / 9) * np.cos(y / 7))
vizlight.relief_shadow(field, vizlight.Scene(lights=vizlight.Light(direction=(1, 0.3, 0.4))))
"""


class Allowed(NamedTuple):
    """What a task may take: some times its peer, and some more of the same unit."""

    times: float
    more: float = 0.0


#: Tasks and what each may take.
TASKS = {
    "picture of a file": Allowed(1.3),
    "normals and light": Allowed(3),
    "first call of the accessor": Allowed(1, 0.3),
    "--help": Allowed(0, 0.35),
    "light --help": Allowed(0, 0.35),
    "first compiled call": Allowed(2),
    "colour times light": Allowed(3),
    "memory of the command line": Allowed(3),
}


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory()


def surface(count: int) -> pv.PolyData:
    """Return waves over a square, of about some number of points."""
    side = round(count**0.5)
    plane = pv.Plane(i_resolution=side - 1, j_resolution=side - 1)
    plane.clear_data()
    x, y, _ = plane.points.T
    plane.points = np.stack([x, y, 0.05 * np.sin(20 * x) * np.cos(25 * y)], axis=1)
    return plane


def seconds(words_: Sequence[str], **environment: str) -> float:
    """Return the processor time of a process and of its children."""
    child = subprocess.Popen(
        [sys.executable, *words_],
        stdout=subprocess.DEVNULL,
        cwd=_folder().name,
        env={**os.environ, **environment},
    )
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise RuntimeError(f"{' '.join(words_[:3])} failed")
    return used.ru_utime + used.ru_stime


def peak(code: str, *words_: str) -> float:
    """Return the largest memory in bytes of a process that runs some code; Linux counts it."""
    code += "\nimport re, pathlib; status = pathlib.Path('/proc/self/status').read_text()"
    code += "\nprint(re.search(r'VmHWM:\\s+(\\d+)', status)[1])"
    command = [sys.executable, "-c", code, *words_]
    run = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, cwd=_folder().name)
    return 1024.0 * float(run.stdout.split()[-1])


def compared(
    task: str, size: float | str, own: Callable[[], float], peer: Callable[[], float], repeats: int
) -> Row:
    """Return a row of the least of some measurements, made in turn with those of the peer."""
    pairs = [(own(), peer()) for _ in range(repeats)]
    mine, others = ([pair[i] for pair in pairs] for i in range(2))
    return row(task, size, min(mine), min(others))


def row(task: str, size: float | str, own: float, peer: float) -> Row:
    """Return a row: the share of what is allowed, and the cost."""
    times, more = TASKS[task]
    return Row(task, size, own / (times * peer + more), own, {"peer": peer})


def picture(count: int, repeats: int) -> list[Row]:
    """Return the row of a picture of a file."""
    file = str(Path(_folder().name, f"{count}.vtp"))
    surface(count).save(file)
    own = ["-m", "vizlight", "light", file, "-o", "own.png"]
    plain = ["-c", PLAIN, file, "plain.png"]
    return [
        compared(
            "picture of a file", count, partial(seconds, own), partial(seconds, plain), repeats
        )
    ]


def starts(repeats: int) -> list[Row]:
    """Return the rows of processes that do little."""
    first, bare = partial(seconds, ["-c", FIRST]), partial(seconds, ["-c", IMPORT])
    rows = [compared("first call of the accessor", 842, first, bare, repeats)]
    for name in ("--help", "light --help"):
        own = partial(seconds, ["-m", "vizlight", *name.split()])
        rows.append(compared(name, 0, own, bare, repeats))
    return rows


def compiled() -> list[Row]:
    """Return the row of a first call where nothing is kept that was compiled before."""
    with tempfile.TemporaryDirectory() as cache_:
        own = partial(seconds, ["-c", RELIEF], XDG_CACHE_HOME=cache_, VIZLIGHT_FAST="")
        plain = partial(seconds, ["-c", RELIEF], VIZLIGHT_FAST="0")
        return [compared("first compiled call", 256**2, own, plain, 1)]


def calls(count: int) -> list[Row]:
    """Return the rows of calls in one process."""
    mesh = surface(count)
    lit = vizlight.illuminate(mesh, SCENE)
    data = lit.points[:, 2] - lit.points[:, 2].min()
    lit["data"], light = data / data.max(), lit["luminance"][:, None]
    table = mpl.colormaps["viridis"]
    times = take_turns(
        {
            "light": lambda: vizlight.illuminate(mesh, SCENE),
            "normals": lambda: mesh.compute_normals(
                cell_normals=False, split_vertices=False, consistent_normals=True
            ),
            "tint": lambda: vizlight.tint(lit, "data", cmap="viridis"),
            "table": lambda: table(lit["data"])[:, :3] * light,
        },
        3,
    )
    return [
        row("normals and light", count, times["light"], times["normals"]),
        row("colour times light", count, times["tint"], times["table"]),
    ]


def memory(side: int) -> list[Row]:
    """Return the row of the memory that a grid with vectors takes, above that of the packages."""
    grid = pv.ImageData(dimensions=(side, side, side)).cast_to_structured_grid()
    grid.points = grid.points.astype(np.float32)
    grid["V"] = np.ones((grid.n_points, 3), np.float32) + grid.points
    file = str(Path(_folder().name, "grid.vts"))
    grid.save(file)
    size = grid.points.nbytes + grid["V"].nbytes
    command = ["light", file, "--no-surface", "--tangents", "V", "-o", "lit.vts"]
    run = "import sys; from vizlight import cli; cli.main(sys.argv[1:])"
    taken = peak(run, *command) - peak(FIRST)
    return [row("memory of the command line", side**3, taken, float(size))]


def steps(quick: bool) -> list[Callable[[], Iterable[Row]]]:
    """Return the steps: quick, the smallest file alone."""
    sizes = SIZES[:1] if quick else SIZES
    return [
        partial(starts, 2),
        *(partial(picture, size, 2 if size < 2e6 else 1) for size in sizes),
        partial(calls, 40_000 if quick else 400_000),
        compiled,
        partial(memory, 160),
    ]


STUDY = Study(
    approximates="nothing: the cost of the first minute, from the start of each process",
    reference="PyVista's own import, normals and pictures, NumPy, and matplotlib's colours",
    parameter="points",
    error="share of what is allowed",
    cost="processor time, s (memory: bytes)",
    steps=steps,
)
