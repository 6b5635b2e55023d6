"""
Light that passes through thin parts
====================================

The figure of a dog with the light behind it. Left: with the clamped cosine, what faces the eye is
dark. Middle and right: with ``t = d / r`` for two depths ``d``, against the length ``r`` of the way
through the figure to the light: ears and tongue glow as if of wax, and the body stays dark.
"""

# sphinx_gallery_thumbnail_number = 1
import matplotlib.pyplot as plt
import numpy as np

import vizlight
from vizlight import Light, Material, Scene, render

dog = vizlight.load_example("dog.vtp").compute_normals(split_vertices=False)
head = (0.1, 0.5, -0.1, 0.1, 0.47, 0.8)
camera = render.camera_on(head, (1.0, -0.85, 0.12), aspect=0.75, zoom=1.35)
panels = []
for title, depth in (("cosine", 0.0), ("d = 0.006", 0.006), ("d = 0.02", 0.02)):
    scene = Scene(
        lights=Light(direction=(-0.9, 0.75, 0.35)),
        material=Material(ambient=0.025, diffuse=1.0, specular=0.0, color=(1.0, 0.5, 0.22)),
    )
    lit = vizlight.relief_shadow(dog, scene, depth=depth, lit=True)
    lit["rgb"] = np.sqrt(lit["rgb"])
    panels.append(render.Panel(lit, "rgb", title))

plotter = render.make_plotter(panels, camera=camera, size=(1800, 800), background="#0c1016")
plotter.show()

# %%
# The ratio beside light that is scattered, ``exp(-a r)``: both fall as the way r through the solid
# grows, at first the ratio faster, later the exponential. The source on cos-theta shadows calls
# them qualitatively alike.

r = np.geomspace(0.002, 1, 200)
for depth in (0.006, 0.02):
    plt.semilogx(r, np.minimum(depth / r, 1), label=f"d / r, d = {depth}")
    plt.semilogx(
        r, np.exp(-np.log(2) * r / (2 * depth)), "--", label=f"exp(-a r), a = ln 2 / {2 * depth}"
    )
plt.gca().set(xlabel="length r inside of the solid", ylabel="light")
plt.legend()
plt.show()
