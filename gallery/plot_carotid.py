"""
Streamlines in the carotid
==========================

Measured blood flow in the carotid arteries: 400 streamlines, coloured by speed from slow (blue) to
fast (yellow) and shaded by their own tangents. See how the strands wind around one another where a
vessel bends, on the right as in a coil, and run straight and fast where it is narrow.

The data are downloaded; where they cannot be had, the flow over a rotating disk stands in.
"""

import matplotlib as mpl
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

try:
    flow = pv.examples.download_carotid()
    name, least, seen = "vectors", 0.5, (0.2, -1, 0.25)
except Exception as error:  # noqa: BLE001 (no network has many names)
    print(f"no carotid here ({type(error).__name__}): a rotating disk in its place")
    flow = vizlight.load_example()
    name, least, seen = "V", 0.0, (1, 0.5, 0.3)

# Outside the vessel is noise, slower than all blood: lines end where there is no flow.
speed = np.linalg.norm(flow[name], axis=1)
flow[name] = np.where(speed[:, np.newaxis] > least, flow[name], 0)
inside = flow.points[speed > 4 * least]
seeds = np.random.default_rng(0).choice(inside, 400, replace=False)
camera = render.camera_on(flow.bounds, seen, zoom=1.36)
scene = Scene(
    lights=Light(direction=(-0.6, -1, 0.8)),
    view=View.from_camera(camera),
    material=Material(ambient=0.15, diffuse=0.75, specular=0.35, shininess=30),
)
lines = vizlight.streamlines(flow, scene, vectors=name, seeds=seeds, model="cylinder")

# Colour tells speed, light tells direction: their product tells both.
speed = np.linalg.norm(lines[name], axis=1)
top = float(np.percentile(speed, 99))
colour = mpl.colormaps["viridis"](np.clip(0.25 + 0.75 * speed / top, 0, 1))[:, :3]
luminance = np.asarray(lines["luminance"])[:, np.newaxis]
lines["rgb"] = np.clip(colour * 1.6 * luminance, 0, 1)

plotter = render.make_plotter(
    render.Panel(lines, "rgb"), camera=camera, size=(1000, 800), line_width=2, background="black"
)
plotter.show()
