"""
Terrain through a day
=====================

Mount St. Helens on an autumn day, from after sunrise to before sunset, with the position of the
sun at 46 degrees north. The wall of the crater casts its shadow westward in the morning and
eastward in the afternoon. The last panel is the mean of the day: the share of the sunlight that
each slope receives.

If the terrain cannot be downloaded, the Himalaya of the embedded relief of the earth is used.
"""

import warnings

import numpy as np
import pyvista as pv

import vizlight
from vizlight import render

try:
    terrain = pv.examples.download_st_helens()
    # The border of the data has no heights.
    columns, rows = terrain.dimensions[:2]
    terrain = terrain.extract_subset((12, columns - 13, 12, rows - 13, 0, 0))
    heights = np.array(terrain["Elevation"], dtype=float)
    depth, latitude, shape, size = 60.0, 46.2, 2, (1500, 1000)
except Exception as error:  # noqa: BLE001 (a missing network raises many types)
    print(f"terrain not available ({type(error).__name__}): using the Himalaya")
    earth = vizlight.load_example("earth_relief.vti")
    part = earth.extract_subset((750, 850, 340, 390, 0, 0))
    terrain = pv.ImageData(dimensions=part.dimensions, spacing=(32.1, 37.1, 1.0))
    heights = np.array(part["elevation"], dtype=float) / 100
    depth, latitude, shape, size = 40.0, 30.0, 2, (1500, 560)
terrain.clear_data()
terrain["height"] = heights

hours = np.array([7.0, 9.0, 12.0, 15.0, 17.0])
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # the border has no heights, as expected
    day = vizlight.relief_day(
        terrain,
        latitude=np.radians(latitude),
        day=285,
        hours=hours,
        depth=depth,
        elevation="height",
        angular_diameter=0.0093,
    )
for column, hour in enumerate(hours):
    day[f"{hour:.0f} h"] = np.asarray(day["t"])[:, column].copy()
day["mean"] = np.asarray(day["t"]).mean(axis=1)

names = [*(f"{hour:.0f} h" for hour in hours), "mean"]
plotter = render.make_plotter(
    [render.Panel(day, name, name) for name in names],
    camera=render.camera_on(terrain.bounds, (0, 0, 1), parallel=True, zoom=1.02),
    rows=shape,
    size=size,
    cmap="cividis",
    bar="t",
    background="white",
)
plotter.show()
