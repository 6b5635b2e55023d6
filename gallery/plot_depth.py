"""
Depth cue and ambient light
===========================

Light that fades with depth tells which of two lines is the nearer one. Streamlines of a flow over
a heated disk, without a depth cue and with one by a smooth step, which keeps the light of the
nearer half and lets the farther half sink into the background. The formulas are those of lectures
on illumination.
"""

# sphinx_gallery_thumbnail_number = 1
import numpy as np
import pyvista as pv

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render

flow = vizlight.load_example()
camera = render.camera_on(flow, (1, 0.5, 0.75), aspect=0.62, zoom=1.0)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.8)),
    view=View.from_camera(camera),
    material=Material(ambient=0.4, diffuse=0.6, color=(1.0, 0.86, 0.6)),
)
dark = "#14181d"
fog = DepthCue(front=42, back=56, cue=1.0, color=dark, smooth=True)
panels = []
for title, cue in (("without depth cue", None), ("with depth cue", fog)):
    lines = vizlight.streamlines(
        flow, scene.replace(depth_cue=cue), tangents="V", seeds=flow.points[::220], max_length=60
    )
    panels.append(render.Panel(lines, "rgb", title))
look = {"camera": camera, "background": dark, "line_diameter": 0.11, "halo": 0.5}
plotter = render.make_plotter(panels, size=(1300, 1000), **look)
plotter.show()

# %%
# Ambient light reaches all points alike: :math:`I_a` is that of the scene, and :math:`k_a` the
# share of it that the material reflects.

ball = pv.Sphere(radius=1, theta_resolution=120, phi_resolution=120)
lamp, view = Light(direction=(-0.7, 0.8, 0.9), intensity=1.1), View(direction=(0, 0, 1))
balls, labels = pv.MultiBlock(), {}
for column, ka in enumerate((0.2, 0.4, 0.6)):
    labels[2.3 * column, 1.35, 1] = f"$k_a = {ka}$"
    for row, intensity in enumerate((1.0, 0.6, 0.3)):
        labels[-1.9, -2.3 * row, 1] = f"$I_a = {intensity}$"
        red = Material(ambient=ka, diffuse=0.5, specular=0.4, color=(0.95, 0.2, 0.14))
        scene = Scene(lights=lamp, view=view, ambient_intensity=intensity, material=red)
        balls.append(vizlight.illuminate(ball, scene).translate((2.3 * column, -2.3 * row, 0)))
camera = render.camera_on((-2.8, 5.8, -5.8, 1.7, -1, 1), (0, 0, 1), parallel=True, zoom=1.4)
plotter = render.make_plotter(
    render.Panel(balls, "rgb"), camera=camera, size=(1150, 1000), background="white"
)
plotter.add_point_labels(
    np.array([*labels]), [*labels.values()], always_visible=True, font_size=26, shape=None,
    text_color="black", show_points=False, justification_horizontal="center",
    justification_vertical="center",
)  # fmt: skip
plotter.show()
