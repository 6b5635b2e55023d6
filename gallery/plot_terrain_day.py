"""
Terrain through a day
=====================

The Jacksboro fault in Tennessee on an autumn day, from after sunrise to before sunset, with the
position of the sun at 36.6 degrees north. Ridges cast their shadows westward in the morning and
eastward in the afternoon. The last panel is the mean of the day: the share of the sunlight that
each slope receives. Heights are doubled.
"""

import numpy as np

import vizlight
from vizlight import render

terrain = vizlight.load_example("jacksboro_fault.vti")
hours = np.array([7.0, 9.0, 12.0, 15.0, 17.0])
day = vizlight.relief_day(
    terrain,
    latitude=36.6,
    day=285,
    hours=hours,
    depth=60,
    elevation="elevation",
    exaggeration=2,
    angular_diameter=0.0093,
)
for column, hour in enumerate(hours):
    day[f"{hour:.0f} h"] = np.asarray(day["t"])[:, column].copy()
day["mean"] = np.asarray(day["t"]).mean(axis=1)

names = [*(f"{hour:.0f} h" for hour in hours), "mean"]
plotter = render.make_plotter(
    [render.Panel(day, name, name) for name in names],
    camera=render.camera_on(terrain.bounds, (0, 0, 1), parallel=True, zoom=1.13),
    rows=2,
    size=(1500, 810),
    cmap="cividis",
    bar="t",
    background="white",
)
plotter.show()
