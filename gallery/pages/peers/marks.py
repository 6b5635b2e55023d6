"""Marks of three fields as the meter reads them: ``python gallery/pages/peers/marks.py``.

A street of vortices on a plane, a flow along a gyroid and the winds of July on a globe are drawn in
a column of print by PyVista's glyphs and streamlines, VTK's LIC and ``vizlight.look``, each with
one setting, which was not tuned. It writes the table to ``marks.csv`` beside this file.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

import vizlight
from vizlight.draw.cameras import camera_on

HERE = Path(__file__).resolve().parent
sys.path.append(str(HERE.parents[1]))
from studies.people import make  # noqa: E402

#: Size of the pictures in pixels: a column of 85 mm at 300 pixels per inch.
SIZE = (1004, 669)
COLUMNS = ("field", "marks", "bits of direction", "median", "sense", "bits of speed")


def street():
    """Return a plane with two rows of vortices in a wind, and its view."""
    grid = pv.ImageData(dimensions=(300, 200, 1), spacing=(0.02, 0.02, 1), origin=(-3, -2, 0))
    mesh = grid.extract_surface(algorithm="dataset_surface").triangulate()
    x, y, _ = np.asarray(mesh.points, np.float64).T
    right, up = np.full(len(x), 0.6), np.zeros(len(x))
    for i in range(-6, 7):
        for turn, height, shift in ((1, -0.45, 0.0), (-1, 0.45, 0.8)):
            east, north = x - (1.6 * i + shift), y - height
            strength = turn / (east**2 + north**2 + 0.1)
            right, up = right - strength * north, up + strength * east
    mesh["flow"] = np.stack([right, up, 0 * x], axis=1)
    return mesh, "flow", (0, 0, 1)


FIELDS = {
    "vortex street": street,
    "gyroid": lambda: (*make.gyroid()[:2], make.gyroid()[3]),
    "winds": lambda: (*make.winds()[:2], make.winds()[3]),
}


def glyphs(plotter, mesh, name):
    """Draw arrows as long as the field is fast."""
    size = 0.06 * mesh.length / np.linalg.norm(mesh[name], axis=1).max()
    arrows = mesh.glyph(orient=name, scale=name, factor=size, tolerance=0.025)
    plotter.add_mesh(mesh, color="lightsteelblue")
    plotter.add_mesh(arrows, color="black")


def streamlines(plotter, mesh, name):
    """Draw lines from 200 random places on the surface."""
    places = np.random.default_rng(0).choice(mesh.n_points, 200, replace=False)
    source = pv.PolyData(np.asarray(mesh.points)[places])
    lines = mesh.streamlines_from_source(
        source, vectors=name, surface_streamlines=True, max_length=mesh.length / 5
    )
    plotter.add_mesh(mesh, color="lightsteelblue")
    plotter.add_mesh(lines, color="black", line_width=3)


def lic(plotter, mesh, name):
    """Smear noise along the field by VTK's line integral convolution."""
    mesh.set_active_vectors(name)
    mapper = vtkSurfaceLICMapper(input_data_object=mesh, scalar_visibility=False)
    plotter.add_actor(pv.Actor(mapper=mapper))


def plotter_of(fill, mesh, name, view):
    """Return a plotter with what a function adds."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE, border=False)
    plotter.background_color = "white"
    fill(plotter, mesh, name)
    plotter.camera = camera_on(mesh, view, aspect=SIZE[0] / SIZE[1])
    return plotter


def in_bits(figure):
    """Return the bits of a figure beside the most."""
    return f"{figure.bits:.2f} of {figure.most:.1f}"


def rows():
    """Yield the rows of the table."""
    for field, load in FIELDS.items():
        mesh, name, view = load()
        looked = vizlight.look(mesh, array=name, view=view, size=SIZE, key=False)
        for marks, plotter in (
            ("PyVista's glyphs", plotter_of(glyphs, mesh, name, view)),
            ("PyVista's streamlines", plotter_of(streamlines, mesh, name, view)),
            ("VTK's LIC", plotter_of(lic, mesh, name, view)),
            ("``vizlight.look``", looked.plotter()),
        ):
            read = plotter.vizlight.legibility()
            plotter.close()
            way, sense, speed = read.direction, read.sense, read.value or read.speed
            told = "none"
            if sense is not None:
                right = f"{sense.told:.0%} and {sense.wrongly:.0%}"
                told = "chance" if sense.unreadable else right
            yield (
                field, marks, in_bits(way), f"{way.median:.1f}°", told,
                "none" if speed is None else in_bits(speed),
            )  # fmt: skip


def main():
    """Do what the docstring of this file says."""
    with (HERE / "marks.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *rows()])


if __name__ == "__main__":
    main()
