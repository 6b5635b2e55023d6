"""Filters with an error, run in one process in an order: ``python tests/orders.py OUT sky refine``.

Each case writes its numbers to a file of its name; :data:`ERRORS` has the error of each.
"""

import sys
from pathlib import Path

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Bundle, Scene, View

SCENE = Scene(view=View(direction=(0, 0.3, 1)))
#: Most by which the numbers of a case may differ from those of another process: rounding, and
#: where the way of computing may differ the error that is asked for.
ROUNDING, SKY = 1e-6, 0.03


def ground(count=60):
    x, y = np.meshgrid(np.linspace(0, 6, count), np.linspace(0, 5, count))
    grid = pv.ImageData(dimensions=(count, count, 1), spacing=(0.1, 0.1, 1))
    grid["heights"] = (np.sin(2 * x) * np.cos(3 * y) + 0.2 * np.sin(9 * x * y)).ravel()
    return grid


def torus():
    mesh = pv.ParametricTorus(u_res=20, v_res=20).triangulate()
    x, y, _ = np.asarray(mesh.points).T
    mesh["V"] = np.column_stack([-y, x, np.sin(3 * x)])
    return mesh


def lines(count=120):
    random = np.random.default_rng(3)
    starts, ways = random.uniform(-1, 1, (count, 1, 3)), random.normal(size=(count, 1, 3))
    points = starts + np.linspace(0, 0.6, 8)[:, np.newaxis] * ways
    cells = np.insert(np.arange(8 * count).reshape(count, 8), 0, 8, axis=1)
    return pv.PolyData(points.reshape(-1, 3), lines=cells.ravel())


def lit(mesh, *fields):
    return [mesh.points, *(mesh.field_data[name] for name in fields), mesh["luminance"]]


def figures(mesh):
    report = vizlight.check(mesh)
    return [[run.error, run.rms, run.between, run.between_rms] for run in report.runs]


CASES = {
    "refine": lambda: lit(vizlight.refine(torus(), SCENE, error=0.02)),
    "streamlines": lambda: lit(
        vizlight.streamlines(torus(), SCENE, tangents="V", spacing=0.3), "largest_gap"
    ),
    "steps": lambda: lit(vizlight.streamlines(torus(), SCENE, tangents="V", seeds=9, step=0.1)),
    "isoluminance": lambda: [vizlight.isoluminance(torus(), SCENE, levels=0.1)["bands"].points],
    "bundle": lambda: lit(vizlight.illuminate(lines(), SCENE, bundle=Bundle(diameter=0.02))),
    "sky": lambda: [vizlight.sky(ground(), error=SKY)["sky"]],
    "sky_of_surface": lambda: [vizlight.sky(torus(), error=SKY)["sky"]],
    "relief_shadow": lambda: [vizlight.relief_shadow(ground(), sun=(310, 20))["t"]],
    "relief_day": lambda: [vizlight.relief_day(ground(30), latitude=47, day=100)["t"]],
    "check": lambda: figures(vizlight.illuminate(torus(), SCENE, tangents="V")),
}
ERRORS = {name: SKY if name.startswith("sky") else ROUNDING for name in CASES}


def main():
    folder, *names = sys.argv[1:]
    for name in names:
        rows = [np.asarray(array, dtype=np.float64).ravel() for array in CASES[name]()]
        np.save(Path(folder) / f"{name}.npy", np.concatenate(rows))


if __name__ == "__main__":
    main()
