"""
Terrain through a day
=====================

The Jacksboro fault in Tennessee on an autumn day, from after sunrise to before sunset, with the
position of the sun at 36.6 degrees north. Ridges cast their shadows westward in the morning and
eastward in the afternoon. The last panel is the mean of the five hours: the share of the sunlight
that each slope receives. Heights are doubled.
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
    day[f"{hour:.0f}:00"] = np.asarray(day["t"])[:, column].copy()
day["mean of the five"] = np.asarray(day["t"]).mean(axis=1)

names = [*(f"{hour:.0f}:00" for hour in hours), "mean of the five"]
plotter = render.make_plotter(
    [render.Panel(day, name, name) for name in names],
    camera=render.camera_on(terrain, (0, 0, 1), parallel=True, aspect=0.83, zoom=0.82),
    rows=2,
    size=(1140, 912),
    cmap="bone",
    background="white",
)
plotter.add_scalar_bar(
    title="share of the direct sunlight\n", color="black", n_labels=3, fmt="%.1f",
    position_x=0.1, position_y=0.01, width=0.8, height=0.06, title_font_size=14,
)  # fmt: skip
plotter.show()
