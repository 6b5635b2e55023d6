"""
The relief of the earth in morning light
========================================

The embedded relief of the earth, land and sea floor, with heights multiplied by 60. The light
comes from the west-north-west at 19 degrees, and ``t`` replaces the cosine: trenches and the edges
of plateaus cast shadows, and ridges on the sea floor stand out. Above the shadow depth is
small; below it is twenty times as large, which smooths small features.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, render

earth = vizlight.load_example("earth_relief.vti")
e = np.radians(20)
scene = Scene(
    lights=Light(direction=(-np.cos(e), 0.3 * np.cos(e), np.sin(e))),
    material=Material(ambient=0.05, diffuse=1.5, specular=0),
)
# x and y are in degrees of 111.195 km.
metre = 60 / 111_195
panels = []
for depth in (0.1, 2.0):
    lit = vizlight.relief_shadow(
        earth, scene, depth=depth, elevation="elevation", exaggeration=metre, lit=True
    )
    height = np.array(lit["elevation"], dtype=float)
    land = np.clip(height / 5000, 0, 1)[:, np.newaxis]
    sea = np.clip(-height / 6000, 0, 1)[:, np.newaxis]
    colour = np.where(
        height[:, np.newaxis] > 0,
        (1 - land) * [0.55, 0.65, 0.4] + land * [0.95, 0.93, 0.9],
        (1 - sea) * [0.45, 0.65, 0.8] + sea * [0.12, 0.2, 0.45],
    )
    lit["rgb"] = 1.5 * colour * np.asarray(lit["luminance"])[:, np.newaxis]
    panels.append(render.Panel(lit, "rgb", f"depth {depth} degrees"))

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(earth.bounds, (0, 0, 1), parallel=True, zoom=1.95),
    rows=2,
    size=(1400, 1480),
    background="white",
)
plotter.show()
