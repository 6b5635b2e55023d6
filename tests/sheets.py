"""A curved sheet with a field, and small pictures of it, for tests of the meter."""

import re

import numpy as np
import pyvista as pv

from vizlight import Material, Scene, presets
from vizlight.draw.cameras import camera_on
from vizlight.observers.eye import OPPONENT, SeenPicture, xyz_of_lab

SIZE = (360, 240)
HOW = {"samples": 768, "size_mm": 30}
FLAT = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
DIRECTION = {"scene": presets.direction(), "tangents": "swirl", "exponent": 2}
SHAPE = {"scene": presets.shape()}


def sheet(n=60):
    """Return a curved sheet with a swirl, its speed, and heights."""
    x, y = np.meshgrid(np.linspace(-1, 1, n), np.linspace(-1, 1, n))
    z = 0.2 * np.sin(3 * x) * np.cos(2 * y)
    mesh = pv.StructuredGrid(x, y, z).extract_surface(algorithm="dataset_surface").triangulate()
    x, y, z = np.asarray(mesh.points, np.float64).T
    slopes = 0.6 * np.cos(3 * x) * np.cos(2 * y), -0.4 * np.sin(3 * x) * np.sin(2 * y)
    mesh["swirl"] = np.stack([-y, x, -y * slopes[0] + x * slopes[1]], axis=1)
    mesh["speed"], mesh["height"] = np.hypot(x, y), z
    return mesh


def plotter_of(mesh, **how):
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "white"
    actor = plotter.vizlight.add_mesh(mesh, **how)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    return plotter, actor


def from_above(mesh):
    """Return the camera that sees a sheet along z, in parallel."""
    return camera_on(mesh, (0, 0, 1), up=(0, 1, 0), aspect=SIZE[0] / SIZE[1], parallel=True)


def rings(mesh, wavelength=8.0, contrast=0.8):
    """Return a picture of rings, along which the swirl of a sheet runs, and its camera."""
    camera = from_above(mesh)
    right, down = np.meshgrid(*(np.arange(n) + 0.5 - n / 2 for n in SIZE))
    gray = 0.5 + contrast / 2 * np.cos(2 * np.pi / wavelength * np.hypot(right, down))
    return np.repeat(gray[..., np.newaxis], 3, axis=2), camera


def arrows(mesh, geom=None, **how):
    """Return glyphs of the swirl about all points: arrows of PyVista, or others."""
    geom = pv.Arrow(start=(-0.5, 0, 0)) if geom is None else geom
    return mesh.glyph(orient="swirl", geom=geom, **{"scale": False, "factor": 0.22} | how)


def drawn_plain(mesh, **how):
    """Return a picture of a mesh, from 0 to 1, by PyVista, on white, and its camera."""
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    plotter.background_color = "white"
    plotter.add_mesh(mesh, **{"color": "black", "show_scalar_bar": False} | how)
    plotter.camera = from_above(sheet(20))
    picture, camera = plotter.screenshot(return_img=True) / 255, plotter.camera.copy()
    return picture, camera


def seen_as(colors):
    """Return a picture that is seen in colours of CIELAB, all of which is drawn."""
    return SeenPicture(xyz_of_lab(colors) @ OPPONENT.T, np.ones_like(colors), np.zeros(3))


def counts(found):
    """Return how many answers of two sides are right and wrong, also where they are chance."""
    if found.unreadable:
        return tuple(map(int, re.search(r"(\d+) right and (\d+) wrong", found.reason).groups()))
    return round(found.told * found.samples), round(found.wrongly * found.samples)
