"""
A volcano at three heights of the sun
=====================================

Mount St. Helens from above, with the sun in the north-west at 10, 25 and 45 degrees. Each pair
shows the cos-theta shadow ``t`` on the left and the classic hillshade, the clamped cosine, on the
right. The hillshade has no cast shadows. ``t`` equals the cosine where the light is not blocked
and is dark where the mountain stands in the way. Its edges are soft over 60 m, because the light
is gathered that far below the ground.

The border of the data has no heights; these points are holes. If the terrain cannot be downloaded,
the Himalaya of the embedded relief of the earth is used, in kilometres and with heights multiplied
by 10.
"""

import warnings

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render

try:
    terrain = pv.examples.download_st_helens()
    heights = np.array(terrain["Elevation"], dtype=float)
    heights[heights == heights.min()] = np.nan
    depth = 60.0
except Exception:  # noqa: BLE001 (a missing network raises many types)
    earth = vizlight.load_example("earth_relief.vti")
    part = earth.extract_subset((750, 850, 340, 390, 0, 0))
    # At 30 degrees north a degree of longitude is 87 % as long as a degree of latitude.
    terrain = pv.ImageData(dimensions=part.dimensions, spacing=(32.1, 37.1, 1.0))
    heights = np.array(part["elevation"], dtype=float) / 100
    depth = 40.0
terrain.clear_data()
terrain["height"] = heights

there = np.isfinite(heights)
panels = []
for height in (10, 25, 45):
    e = np.radians(height)
    toward = (-np.cos(e) / 2**0.5, np.cos(e) / 2**0.5, np.sin(e))
    scene = Scene(lights=Light(direction=toward), material=Material(specular=0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # the holes are expected
        lit = vizlight.relief_shadow(terrain, scene, depth=depth, elevation="height")
    columns, rows = terrain.dimensions[:2]
    x, y = (np.arange(n) * s for n, s in zip((columns, rows), terrain.spacing, strict=False))
    slopes = np.gradient(heights.reshape(rows, columns), y, x)
    normal = np.stack([-slopes[1], -slopes[0], np.ones((rows, columns))], axis=-1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    lit["hillshade"] = np.nan_to_num(np.maximum(normal @ np.array(toward), 0)).ravel()
    panels += [
        render.Panel(lit, "t", f"t, sun {height} degrees"),
        render.Panel(lit, "hillshade", "hillshade"),
    ]

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(terrain.bounds, (0, 0, 1), parallel=True, zoom=1.02),
    size=(2100, 560) if rows > columns else (2400, 300),
    background="white",
)
plotter.show()
