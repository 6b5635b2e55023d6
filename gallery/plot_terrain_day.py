"""
Terrain through a day
=====================

The Jacksboro fault in Tennessee on an autumn day, from morning to afternoon, with the
position of the sun at 36.6 degrees north. Ridges cast their shadows westward in the morning and
eastward in the afternoon. The last panel is the mean of every half hour: the share of the sunlight
that each slope receives. Heights are doubled, and north is up.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import render

terrain = vizlight.load_example("jacksboro_fault.vti")
terrain = terrain.extract_subset((100, 230, 80, 210, 0, 0)).resample(3.0, interpolation="bspline")
hours = np.arange(8, 16.1, 0.5)
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
names = [f"{hour:.0f}:00, sun in the {way}" for hour, way in zip(hours[::4], ways, strict=True)]
for column, name in enumerate(names):
    day[name] = np.asarray(day["t"])[:, 4 * column].copy()
names.append("mean from 8:00 to 16:00")
day[names[-1]] = np.asarray(day["t"]).mean(axis=1)

plotter = render.make_plotter(
    [render.Panel(day, name, name) for name in names],
    camera=render.camera_on(terrain, (0, 0, 1), parallel=True, aspect=0.9, zoom=0.88),
    rows=2,
    size=(1340, 1000),
    cmap="cividis",
    background="white",
    bar="share\nof full\nsunlight",
)
east, south = terrain.bounds[1], terrain.bounds[2]
scale = pv.Box((east - 3000, east, south - 500, south - 300, 0, 1))
plotter.subplot(0, 0)
plotter.add_mesh(scale, color="black", lighting=False)
plotter.add_point_labels(
    [(east - 4700, south - 400, 0)], ["3 km"], shape=None, show_points=False, bold=False,
    text_color="black", font_size=24, justification_vertical="center", always_visible=True,
)  # fmt: skip
plotter.show()
