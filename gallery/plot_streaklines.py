"""
Smoke in a flow that changes with time
======================================

Vortices of alternating sign drift to the right, as behind a pillar in the wind. Smoke leaves a row
of points all the time: streaklines, carried from step to step by ``vizlight.pathlines`` and lit by
their own directions at each. Old smoke is blue, fades, and keeps the shape of vortices that it has
met; streamlines of one step do not show what has happened before.
``vizlight.movie.save(frames, "smoke.mp4")`` writes such frames as a movie.
"""

from pathlib import Path
from tempfile import mkdtemp

import numpy as np
import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap

import vizlight
from vizlight import Light, Material, Scene, View, render

times = np.linspace(0, 6, 136)
steps = []
for time in times:
    step = pv.ImageData(dimensions=(141, 61, 3), spacing=(0.05, 0.05, 0.05), origin=(0, -1.5, 0))
    x, y, _ = np.asarray(step.points).T
    velocity = np.stack([1 + 0 * x, 0 * x, 0 * x], axis=1)
    for number in range(-11, 8):
        sign = 1 - 2 * (number % 2)
        right, up = x - 0.8 * number - 0.8 * time, y + 0.22 * sign
        square = right**2 + up**2 + 1e-12
        # A vortex with a core of 0.2, which grows as it drifts away from the pillar.
        turn = -sign * 0.15 * (1 - np.exp(-square / 0.04)) / square * np.clip(x / 1.5, 0, 1)
        velocity += np.stack([-turn * up, turn * right, 0 * x], axis=1)
    step["velocity"] = velocity
    steps.append(step)

seeds = np.linspace((0.05, -0.32, 0.05), (0.05, 0.32, 0.05), 26)
camera = render.camera_on((0.4, 5.2, -1, 1, 0, 0.1), (0, -0.3, 1), aspect=2.27, zoom=2.22)
camera.SetWindowCenter(0, -0.2)
scene = Scene(
    lights=Light(direction=(-0.7, 0.6, 0.6)),
    view=View.from_camera(camera),
    material=Material(ambient=0.7, diffuse=0.6, specular=0.4, shininess=25),
)
frames = vizlight.pathlines(
    steps, scene, times=times, tangents="velocity", kind="streaklines", seeds=seeds,
    model="cylinder", step=0.6, tail=4,
)  # fmt: skip

plotter = pv.Plotter(off_screen=True, window_size=(880, 387))
plotter.background_color = "#14181d"
plotter.enable_anti_aliasing("ssaa")
plotter.camera = camera
tints = ["#ff6a4d", "#ffc27a", "#f7f0d0", "#9ad4ee", "#5a8fe8", "#2c4474"]
aged = {"cmap": LinearSegmentedColormap.from_list("age", tints), "clim": (0, 4)}
plotter.open_gif(Path(mkdtemp()) / "smoke.gif", fps=8)
bar = {"n_labels": 5, "fmt": "%.0f", "color": "white", "width": 0.5, "height": 0.16}
bar |= {"position_x": 0.25, "position_y": 0.02, "title_font_size": 20, "label_font_size": 18}
for number, lines in enumerate(frames):
    lines["age"] = lines.field_data["TimeValue"][0] - lines["Time"]
    lit = vizlight.tint(lines, "age", **aged)
    actor = plotter.add_mesh(
        lit, scalars="rgb", rgb=True, lighting=False, line_width=2.8, name="smoke", render=False
    )
    if not number:
        table = pv.LookupTable(aged["cmap"], scalar_range=aged["clim"])
        actor.mapper.lookup_table, actor.mapper.scalar_range = table, table.scalar_range
        plotter.add_scalar_bar("age of the smoke, s\n", mapper=actor.mapper, **bar)
    if number > 89 and number % 3 == 0:  # a period of the vortices
        plotter.write_frame()
plotter.show()
