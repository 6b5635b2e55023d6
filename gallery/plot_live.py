"""
Light that follows the camera
=============================

The winds of July, coloured by speed and lit by one lamp, while the camera goes around the earth.
``plotter.vizlight.add_mesh`` keeps the light right for each frame: lines shine where lamp and eye
make them shine, and do not carry their highlights along. Colours, nan colours and the scalar bar
are those of ``plotter.add_mesh``. In a window or a notebook the same code follows the mouse;
``mesh.vizlight.plot(scalars="m/s")`` is its short form.

The light is computed in each fragment, from normals and tangents that the graphics card
interpolates. ``light="points"`` computes it at the points, for every manifold, bit by bit as the
filters do.
"""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View

scene = Scene(
    lights=[Light(direction=(1.2, 0.7, 0.8)), Light.headlight(intensity=0.4)],
    view=View(direction=(0.42, 1, 0.3)),
    material=Material(ambient=0.3, diffuse=1.0, specular=0.6, shininess=30),
)
air = vizlight.load_example("winds_of_july.vtp")
wind = vizlight.streamlines(air, scene, vectors="wind", spacing=0.045, conditioned=False)
wind["m/s"] = np.linalg.norm(wind["wind"], axis=1)

plotter = pv.Plotter(off_screen=True, window_size=(480, 440))
plotter.background_color = "black"
plotter.add_mesh(pv.Sphere(radius=0.99, theta_resolution=120, phi_resolution=120), color="#0b1626",
                 lighting=False)  # fmt: skip
plotter.vizlight.add_mesh(
    wind, scene=scene, tangents="Tangents", scalars="m/s", cmap="coolwarm", clim=(0, 12),
    line_diameter=0.018, render_lines_as_tubes=True,
    scalar_bar_args={"color": "white", "n_labels": 3, "fmt": "%.0f", "vertical": True},
)  # fmt: skip
plotter.view_vector((0.42, 1, 0.3))
plotter.camera.zoom(1.35)
plotter.open_gif(Path(mkdtemp()) / "turning.gif", fps=12)
for _ in range(36):
    plotter.camera.azimuth += 10
    plotter.write_frame()
plotter.show()
