"""
A bas-relief under one light
============================

The depth map of a statue, flattened onto a plate and lit by one nearby light. From left to right
the light has three positions and the shadow three depths. The single number t contains the direct
light, the shadow on the plate and the light that passes through thin parts. A larger depth lets
more light through, as in the figures of the source on cos-theta shadows.

The statue is Lucy if it can be downloaded, otherwise the ant that comes with PyVista.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render

try:
    statue, toward, up = pv.examples.download_lucy(), (0, -1, 0), (0, 0, 1)
except Exception:  # noqa: BLE001 (a missing network raises many types)
    statue = pv.examples.load_ant().subdivide(2, "butterfly")
    toward, up = (0.25, 1, 0.3), (0, 0, 1)
side = max(np.diff(np.reshape(statue.bounds, (3, 2))))[0]
relief = vizlight.bas_relief(
    statue.triangulate(), direction=toward, up=up, resolution=500, height=0.12 * side, margin=0.12
)

panels = []
for x, depth in ((-0.6, 0.005), (0.0, 0.02), (0.7, 0.06)):
    scene = Scene(
        lights=Light(position=(x * side, 0.5 * side, 0.45 * side)),
        material=Material(ambient=0.0, diffuse=1.0, specular=0.0, color=(1.0, 0.87, 0.7)),
    )
    lit = vizlight.relief_shadow(relief, scene, depth=depth * side, lit=True)
    panels.append(render.Panel(lit, "rgb", f"light at x = {x}, depth {depth}"))

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(relief.bounds, (0, 0, 1), parallel=True, zoom=1.3),
    size=(1800, 700),
    background="black",
)
plotter.show()
