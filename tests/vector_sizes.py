"""Sizes, seconds and errors of vector figures, as a table: ``python tests/vector_sizes.py``.

The pictures are drawn again by ``rsvg-convert`` of Debian's ``librsvg2-bin`` and compared with
those of the plotters.
"""

import re
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Block, Frustum, Scene, Sphere


def plain(mesh, **options):
    """Return a plotter with grey light on a mesh."""
    plotter = pv.Plotter(off_screen=True, window_size=(1200, 800))
    plotter.background_color = "white"
    plotter.enable_anti_aliasing("msaa", multi_samples=8)
    plotter.vizlight.add_mesh(mesh, scene=Scene(), **options)
    return plotter


def solid():
    """Return a solid of primitives."""
    return vizlight.to_polydata(
        (Sphere() | Block((0, 0, -1), (1.6, 1.6, 1))) - Frustum(axis=(0, 0, 4), radii=(0.4, 0.4))
    )


def look(name, *question):
    return vizlight.look(vizlight.load_example(name), *question).plotter()


SCENES = {
    "solid of primitives, grey light": lambda: plain(solid()),
    "dog, grey light": lambda: plain(vizlight.load_example("dog.vtp")),
    "ball of 10^6 triangles, grey light": lambda: plain(
        pv.Sphere(theta_resolution=708, phi_resolution=708)
    ),
    "dog, coloured light": lambda: look("dog.vtp"),
    "brain, coloured light": lambda: look("brain.vti"),
    "fault, relief": lambda: look("jacksboro_fault.vti"),
    "earth, map of heights": lambda: look("earth_relief.vti"),
    "winds, values and strokes": lambda: look("winds_of_july.vtp"),
    "fibres, lines with halos": lambda: look("fibre_bundle.vtp"),
}


def row(name, folder):
    """Return size, seconds, error, share of pixels within the error, and what holds the faces."""
    plotter = SCENES[name]()
    picture = np.asarray(plotter.screenshot(return_img=True)).astype(int)
    path = folder / "figure.svg"
    begin = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        plotter.vizlight.save_graphic(path)
    seconds = time.perf_counter() - begin
    plotter.close()
    png = path.with_suffix(".png")
    subprocess.run(["rsvg-convert", path, "-o", png], check=True)
    away = np.abs(np.asarray(Image.open(png).convert("RGB")).astype(int) - picture).max(axis=2)
    found = re.search(r"within ([\d.]+) of", path.read_text())
    error = float(found.group(1)) if found else 0.0
    within = np.mean(away <= error + 1)
    size = path.stat().st_size / 1000
    return (
        f"{size:.0f} kB",
        f"{seconds:.1f} s",
        f"{error:.1f}" if found else "pixels",
        f"{within:.2%}",
    )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as made:
        for name in sys.argv[1:] or SCENES:
            print(name, *row(name, Path(made)), sep=" | ", flush=True)
