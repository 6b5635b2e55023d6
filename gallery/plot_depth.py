"""
Depth cue, ambient light and distance
=====================================

Light that fades with depth tells which of two lines is the nearer one: streamlines of a heated flow
without a depth cue, with a linear one, and with one by a smooth step, which keeps more of the light
in front. The formulas are those of lectures on illumination.
"""

# sphinx_gallery_thumbnail_number = 1
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render
from vizlight.model import falloff

flow = vizlight.load_example()
camera = render.camera_on(flow.bounds, (1, 0.5, 0.55), zoom=1.05)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.5)),
    view=View.from_camera(camera),
    material=Material(ambient=0.35, diffuse=0.65, color=(1.0, 0.9, 0.7)),
)
panels = []
for title, cue in (
    ("no depth cue", None), ("linear", DepthCue()), ("smooth step", DepthCue(smooth=True)),
):  # fmt: skip
    lines = vizlight.streamlines(
        flow, scene.replace(depth_cue=cue), tangents="V", seeds=flow.points[::120], max_length=60
    )
    panels.append(render.Panel(lines, "rgb", title))
look = {"camera": camera, "background": "black", "line_width": 3}
plotter = render.make_plotter(panels, size=(1650, 720), **look)
plotter.show()

# %%
# Ambient light reaches all points alike. From left to right the material reflects more of it, from
# bottom to top the scene has more: with ka = 0 nothing changes.

ball = pv.Sphere(radius=1, theta_resolution=90, phi_resolution=90)
balls = pv.MultiBlock()
for row, around in enumerate((0.0, 0.3, 0.6, 1.0)):
    for column, ka in enumerate((0.0, 0.2, 0.4, 0.6)):
        red = Material(ambient=ka, diffuse=0.5, specular=0.4, color=(0.9, 0.12, 0.1))
        lamp = Light(direction=(-0.7, 0.8, 0.9), intensity=0.8)
        view = View(direction=(0, 0, 1))
        lit = vizlight.illuminate(
            ball, Scene(lights=lamp, view=view, ambient_intensity=around, material=red)
        )
        balls.append(lit.translate((2.2 * column, 2.2 * row, 0)))
camera = render.camera_on(balls.bounds, (0, 0, 1), parallel=True, aspect=1, zoom=1.3)
plotter = render.make_plotter(
    render.Panel(balls, "rgb"), camera=camera, size=(800, 800), background="#203040"
)
plotter.show()

# %%
# A lamp of intensity 1 at a distance. Its light is at most 1 by ``attenuation=``, which the
# formula ``min(1, 1 / d^2)`` of the lecture means; ``Light.unclamped`` is ``1 / d^2`` itself.

d = np.geomspace(0.1, 10, 200)
lamps = {
    "Light.unclamped": Light.unclamped(position=(0, 0, 0)),
    "attenuation=(0, 0, 1)": Light(position=(0, 0, 0), attenuation=(0, 0, 1)),
    "attenuation=(0.5, 0.5, 0.5)": Light(position=(0, 0, 0), attenuation=(0.5, 0.5, 0.5)),
}
for label, lamp in lamps.items():
    plt.loglog(d, lamp.intensity * falloff.distance(d, *lamp.attenuation), label=label)
plt.gca().set(xlabel="distance from the lamp", ylabel="light")
plt.legend()
plt.show()
