"""
Streamlines in the carotid
==========================

Measured blood flow in the carotid arteries: 400 streamlines, coloured by speed from slow (blue) to
fast (yellow) and shaded by their own tangents. The strands wind around one another where a vessel
bends, on the right like a coil, and run straight and fast where it is narrow.

The data are downloaded. If they are not available, the flow over a rotating disk is used instead.
"""

import matplotlib as mpl
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

try:
    flow = pv.examples.download_carotid()
    name, least, seen = "vectors", 0.5, (0.2, -1, 0.25)
except Exception as error:  # noqa: BLE001 (a missing network raises many types)
    print(f"carotid not available ({type(error).__name__}): using a rotating disk")
    flow = vizlight.load_example()
    name, least, seen = "V", 0.0, (1, 0.5, 0.3)

# Noise outside the vessel is slower than the blood: setting it to zero ends the lines there.
speed = np.linalg.norm(flow[name], axis=1)
flow[name] = np.where(speed[:, np.newaxis] > least, flow[name], 0)
inside = flow.points[speed > 4 * least]
seeds = np.random.default_rng(0).choice(inside, 400, replace=False)
camera = render.camera_on(flow.bounds, seen, zoom=1.36)
scene = Scene(
    lights=Light(direction=(-0.6, -1, 0.8)),
    view=View.from_camera(camera),
    material=Material(ambient=0.25, diffuse=1.1, specular=0.35, shininess=30),
)
lines = vizlight.streamlines(flow, scene, vectors=name, seeds=seeds)

# Colour shows speed and light shows direction: their product shows both. In the interactive scene
# the light follows the eye.
lines["speed"] = np.linalg.norm(lines[name], axis=1)
plotter = pv.Plotter(off_screen=True, window_size=(1000, 800))
plotter.background_color = "black"
plotter.vizlight.add_mesh(
    lines,
    scene=scene,
    tangents="Tangents",
    scalars="speed",
    cmap=mpl.colors.ListedColormap(mpl.colormaps["viridis"](np.linspace(0.25, 1, 256))),
    clim=(0, float(np.percentile(lines["speed"], 99))),
    line_width=1,
    show_scalar_bar=False,
)
plotter.camera = camera
plotter.show()
