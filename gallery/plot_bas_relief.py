"""
A bas-relief under one light
============================

The depth map of a dog, flattened onto a plate and lit by one nearby lamp. Above, the lamp moves
from the left to the right. Below it stays at the left, and the shadow reaches deeper into the
solid, which lets more light through thin parts, as in the figures of the source on cos-theta
shadows. One number t has the direct light, the shadow on the plate and the light that passes. The
dog is 1.2 long.
"""

# sphinx_gallery_thumbnail_number = 1
import matplotlib.pyplot as plt
import numpy as np

import vizlight
from vizlight import Light, Material, Scene, render

dog = vizlight.load_example("dog.vtp")
view = {"direction": (0.2, -1, 0.12), "up": (0, 0, 1)}
relief = vizlight.bas_relief(dog, resolution=3000, height=0.06, margin=0.1, **view)
# A cast has no edges as sharp as a step of the depth map.
relief = relief.gaussian_smooth(scalars="height", std_dev=10).resample(1 / 3)
plaster = Material(ambient=0.12, diffuse=0.85, specular=0.0, color=(1.0, 0.9, 0.76))
panels = []
for side, x, depth in (
    ("left", -0.9, 0.005), ("right", 0.9, 0.005), ("left", -0.9, 0.01), ("left", -0.9, 0.02),
):  # fmt: skip
    scene = Scene(lights=Light(position=(x, 0.8, 1.0), intensity=1.08), material=plaster)
    lit = vizlight.relief_shadow(relief, scene, depth=depth, lit=True)
    panels.append(render.Panel(lit, "rgb", f"lamp at the {side}, depth d = {depth}"))

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(relief, (0, 0, 1), parallel=True, aspect=1.2, zoom=0.96),
    rows=2,
    size=(1640, 1370),
    background="white",
)
plotter.show()

# %%
# How t is made. From the point p', a depth d below the surface, the way to the lamp is inside the
# solid for two lengths, r1 below the surface itself and r2 through another part; t is
# d / (r1 + r2).

x = np.linspace(0, 10, 501)
z = np.interp(x, [0, 3.5, 5, 6, 6.5, 7.5, 8, 10], [2, 2, 0.5, 0.5, 3.4, 3.4, 0.5, 0.5])
surface, start, lamp = np.array([2.2, 2.0]), np.array([2.2, 1.4]), np.array([9.5, 4.3])
figure, axes = plt.subplots(figsize=(10, 4.6), layout="constrained")
axes.fill_between(x, z, color="#e8d9c0")
axes.plot(x, z, color="#6b5b45", lw=1.5)
along = np.linspace(start, lamp, 2001)
inside = along[:, 1] < np.interp(along[:, 0], x, z)
length = np.hypot(*(lamp - start)) * np.mean(inside)
axes.plot(*along.T, color="0.5", lw=1.5)
text = {"fontsize": 18, "ha": "center", "va": "center"}
for part, name in ((along[:, 0] < 5, "$r_1$"), (along[:, 0] >= 5, "$r_2$")):
    piece = along[inside & part]
    axes.plot(*piece.T, color="#d1661b", lw=5, solid_capstyle="butt")
    axes.text(*np.add(piece.mean(axis=0), (0.1, -0.32)), name, color="#d1661b", **text)
axes.plot(*np.transpose([surface, start]), "k:", lw=2)
axes.plot(*start, "ko", ms=8)
axes.plot(*lamp, "*", color="#e8a800", ms=20)
axes.text(*np.add(start, (-0.32, 0.0)), "$p'$", **text)
axes.text(*np.add(surface, (-0.25, -0.25)), "$d$", **text)
axes.text(*np.add(lamp, (0, -0.45)), "lamp", **text)
axes.text(2.2, 3.6, f"$t = d / (r_1 + r_2) = {0.6 / length:.2f}$", fontsize=20, ha="center")
axes.set(aspect="equal", xlim=(0, 10), ylim=(0, 4.7))
axes.set_axis_off()
plt.show()
