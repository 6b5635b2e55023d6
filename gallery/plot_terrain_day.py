"""
Terrain through a day
=====================

The Jacksboro fault in Tennessee on an autumn day, from morning to afternoon, with the
position of the sun at 36.6 degrees north. Ridges cast their shadows westward in the morning and
eastward in the afternoon. The last panel is the mean of the five hours: the share of the sunlight
that each slope receives. Heights are doubled.
"""

import numpy as np

import vizlight
from vizlight import render

terrain = vizlight.load_example("jacksboro_fault.vti")
terrain = terrain.extract_subset((100, 230, 80, 210, 0, 0)).resample(3.0, interpolation="bspline")
hours = np.array([8.0, 10.0, 12.0, 14.0, 16.0])
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
ways = ("east", "southeast", "south", "southwest", "west")
names = [f"{hour:.0f}:00, sun in the {way}" for hour, way in zip(hours, ways, strict=True)]
for column, name in enumerate(names):
    day[name] = np.asarray(day["t"])[:, column].copy()
names.append("mean of the five")
day[names[-1]] = np.asarray(day["t"]).mean(axis=1)

plotter = render.make_plotter(
    [render.Panel(day, name, name) for name in names],
    camera=render.camera_on(terrain, (0, 0, 1), parallel=True, aspect=0.9, zoom=0.87),
    rows=2,
    size=(1440, 1000),
    cmap="bone",
    background="white",
    bar="sunlight",
)
plotter.show()
