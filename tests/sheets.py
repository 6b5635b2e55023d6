"""A curved sheet with a field, and small pictures of it, for tests of the meter."""

import numpy as np
import pyvista as pv

from vizlight import Material, Scene, presets
from vizlight.draw.cameras import camera_on

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
