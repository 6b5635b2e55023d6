"""
A bas-relief under one light
============================

The depth map of a figure, flattened onto a plate and lit by one nearby light. Upper row: the light
moves from left to right, the depth stays. Lower row: the light stays, and the depth of the shadow
grows from left to right, which lets more light through, as in the figures of the source on
cos-theta shadows. The single number t contains the direct light, the shadow on the plate and the
light that passes through thin parts.
"""

import matplotlib.pyplot as plt
import numpy as np

import vizlight
from vizlight import Light, Material, Scene, render

dog = vizlight.load_example("dog.vtp")
relief = vizlight.bas_relief(
    dog, direction=(0.2, -1, 0.12), up=(0, 0, 1), resolution=700, height=0.06, margin=0.1
)
panels = []
for x, depth in (
    (-0.8, 0.01), (0.0, 0.01), (0.8, 0.01),
    (-0.8, 0.003), (-0.8, 0.02), (-0.8, 0.06),
):  # fmt: skip
    scene = Scene(
        lights=Light(position=(x, 0.7, 0.55)),
        material=Material(ambient=0.03, diffuse=1.1, specular=0.0, color=(1.0, 0.87, 0.7)),
    )
    lit = vizlight.relief_shadow(relief, scene, depth=depth, lit=True)
    panels.append(render.Panel(lit, "rgb", f"light at x = {x}, depth {depth}"))

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(relief.bounds, (0, 0, 1), parallel=True, aspect=1.25, zoom=1.36),
    rows=2,
    size=(1800, 1000),
    background="black",
)
plotter.show()

# %%
# Left: t itself, one number from 0 to 1, on the last relief. Right: how it is made. From the point
# p' a depth d below the surface the way to the lamp is inside the solid for two lengths, r1 below
# the surface itself and r2 through another part; t is d / (r1 + r2).

figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.6), width_ratios=(1, 1.2))
columns, rows = relief.dimensions[:2]
image = left.imshow(lit["t"].reshape(rows, columns), origin="lower", cmap="gray", vmin=0, vmax=1)
left.set_axis_off()
figure.colorbar(image, ax=left, label="t", shrink=0.75)
x = np.linspace(0, 10, 501)
z = np.interp(x, [0, 3.5, 5, 6, 6.5, 7.5, 8, 10], [2, 2, 0.5, 0.5, 3.4, 3.4, 0.5, 0.5])
surface, start, lamp = np.array([2.2, 2.0]), np.array([2.2, 1.4]), np.array([9.5, 4.3])
right.fill_between(x, z, color="0.85")
along = np.linspace(start, lamp, 2001)
inside = along[:, 1] < np.interp(along[:, 0], x, z)
length = np.hypot(*(lamp - start)) * np.mean(inside)
right.plot(*along.T, color="0.6", lw=1)
for part, name in ((along[:, 0] < 5, "r1"), (along[:, 0] >= 5, "r2")):
    piece = along[inside & part]
    right.plot(*piece.T, color="tab:orange", lw=3)
    right.annotate(name, np.add(piece.mean(axis=0), (0.1, -0.5)))
right.plot(*np.transpose([surface, start]), "k:", *start, "k.", *lamp, "y*", ms=9)
right.annotate("p'", np.add(start, (-0.5, -0.15)))
right.set(title=f"t = d / (r1 + r2) = {0.6 / length:.2f}", aspect="equal", xticks=[], yticks=[])
plt.show()
