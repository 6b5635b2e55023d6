"""
A flow in a volume
==================

The gas over a heated, rotating disk, coloured from cold (blue) to hot (orange). It falls from
above, turns, leaves along the disk, and below it swirls on; in the middle a ring of gas keeps
turning on itself. Left: streamlines as they are usually drawn. Right: each is lit as a thin
cylinder, and together they dim the light on its way in. Now the ring is round and hollow, and the
lines that pass in front of it are in front.

The lines start on two circles, so that they lie side by side like the threads of a fabric.
"""

import numpy as np

import vizlight
from vizlight import Bundle, Light, Material, Scene, View, render

flow = vizlight.load_example()


def circle(count, radius, height):
    """Return points on a circle around the axis of the disk."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.stack([radius * np.cos(turn), radius * np.sin(turn), 0 * turn + height], axis=1)


camera = render.camera_on((-4.6, 4.6, -4.6, 4.6, -9.5, 8.5), (1, 0.5, 0.42), aspect=0.8, zoom=1.28)
scene = Scene(
    lights=Light(direction=(1, -0.6, 0.9)),
    view=View.from_camera(camera),
    material=Material(ambient=0.45, diffuse=1.0, specular=0.4, shininess=25),
)
lit = vizlight.streamlines(
    flow, scene, vectors="V", seeds=np.concatenate([circle(60, 2.75, 3.4), circle(90, 2.2, 9.5)]),
    max_length=90, model="cylinder", bundle=Bundle(depth=1.2), occlusion="sky", components=True,
)  # fmt: skip

heat = np.clip((lit["Temp"] - 300) / 600, 0, 1)
hues = np.array([[0.20, 0.42, 0.78], [0.33, 0.70, 0.84], [0.92, 0.66, 0.28], [0.95, 0.42, 0.12]])
flat = lit.copy()
flat["rgb"] = np.stack([np.interp(heat, [0, 0.2, 0.5, 1], hue) for hue in hues.T], axis=1)
light = np.minimum(1.3 * (lit["ambient"] + lit["diffuse"]), 1.0)
lit["rgb"] = flat["rgb"] * light[:, np.newaxis] + lit["specular"][:, np.newaxis]

panels = [render.Panel(flat, "rgb"), render.Panel(lit, "rgb")]
options = {"camera": camera, "size": (1600, 1000), "line_width": 1.4}
plotter = render.make_plotter(panels, background="black", **options)
plotter.show()

# %%
# The same on white paper.

plotter = render.make_plotter(panels, background="white", **options)
plotter.show()
