"""
Depth cue and ambient light
===========================

Light that fades with depth tells which of two lines is the nearer one. A thread wound on a ball,
without a depth cue and with one by a smooth step, which keeps the light of the nearer half and lets
the farther half sink into the background. The formulas are those of lectures on illumination.
"""

# sphinx_gallery_thumbnail_number = 1
import numpy as np
import pyvista as pv

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render

# Thread wound on a ball: great circles, inclined to the equator, that go around the axis.
turn = np.linspace(0, 2 * np.pi, 8000)
x, y, z = np.cos(21 * turn), 0.5 * np.sin(21 * turn), 0.87 * np.sin(21 * turn)
thread = np.stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn), z])
# Threads that climb lie over those that descend.
thread = pv.MultipleLines((thread * (1 + 0.03 * x)).T)
camera = render.camera_on(thread, (1, 0.5, 0.6), aspect=0.95, zoom=0.94)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.8)),
    view=View.from_camera(camera),
    material=Material(ambient=0.4, diffuse=0.6, color=(1.0, 0.86, 0.6)),
)
dark, far = "#14181d", camera.distance
fog = DepthCue(front=far - 0.8, back=far + 0.8, cue=0.8, color=dark, smooth=True)
panels = []
for title, cue in (("without depth cue", None), ("with depth cue", fog)):
    lit = vizlight.illuminate(thread, scene.replace(depth_cue=cue))
    panels.append(render.Panel(lit, "rgb", title))
look = {"camera": camera, "background": dark, "line_diameter": 0.03, "halo": 0.5}
plotter = render.make_plotter(panels, size=(1400, 740), **look)
plotter.show()

# %%
# Ambient light reaches all points alike: I is that of the scene, and k the share of it that the
# material reflects.

ball = pv.Sphere(radius=1, theta_resolution=300, phi_resolution=300)
lamp, view = Light(direction=(-0.7, 0.8, 0.9)), View(direction=(0, 0, 1))
balls, labels = pv.MultiBlock(), {}
for column, ka in enumerate((0.3, 0.45, 0.6)):
    labels[2.3 * column, 1.42, 1] = f"share reflected\nk = {ka}"
    for row, intensity in enumerate((1.0, 0.7, 0.4)):
        labels[-1.95, -2.3 * row, 1] = f"ambient light\nI = {intensity}"
        red = Material(ambient=ka, diffuse=0.4, specular=0.4, color="#ff7a58")
        scene = Scene(lights=lamp, view=view, ambient_intensity=intensity, material=red)
        balls.append(vizlight.illuminate(ball, scene).translate((2.3 * column, -2.3 * row, 0)))
camera = render.camera_on((-2.9, 5.5, -5.7, 1.9, -1, 1), (0, 0, 1), parallel=True, zoom=1.42)
look = {"camera": camera, "background": "white", "anti_aliasing": "ssaa"}
plotter = render.make_plotter(render.Panel(balls, "rgb"), size=(1130, 1000), **look)
plotter.add_point_labels(
    np.array([*labels]), [*labels.values()], always_visible=True, font_size=28, shape=None,
    bold=False, text_color="black", show_points=False, justification_horizontal="center",
    justification_vertical="center",
)  # fmt: skip
plotter.show()
