"""
Light that passes through thin parts
====================================

The figure of a dog with a lamp behind it, and a weak one beside. With the clamped cosine, what
faces the eye has the weak light alone. With ``t = d / r``, for a depth ``d`` of 0.005 against the
length ``r`` of the way through the figure to the lamp, ears and tongue glow as if of wax, and the
body stays dark. The dog is 1.2 long.
"""

# sphinx_gallery_thumbnail_number = 1
import matplotlib.pyplot as plt
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

dog = vizlight.load_example("dog.vtp").subdivide(2, "loop")
dog = dog.compute_normals(split_vertices=False)
eyes = [pv.Sphere(radius=0.012, center=(0.363, side * 0.024, 0.7046)) for side in (-1, 1)]
head = (0.12, 0.46, -0.1, 0.1, 0.47, 0.82)
camera = render.camera_on(head, (1.0, -0.85, 0.12), aspect=1.0, zoom=1.27)
behind = Light(direction=(-0.9, 0.75, 0.35), intensity=0.9)
beside = Light(direction=(0.2, -1, 0.9), intensity=0.4)
panels = []
for title, depth in (("no light passes", 0.0), ("light passes thin parts", 0.005)):
    scene = Scene(
        lights=[behind, beside],
        material=Material(ambient=0.06, diffuse=0.9, specular=0.0, color=(1.0, 0.5, 0.22)),
    )
    lit = vizlight.relief_shadow(dog, scene, depth=depth, lit=True)
    lit["rgb"] = lit["rgb"] ** 0.6
    # A bust: the cut runs from the nape to the chest.
    lit = lit.clip(normal=(1, 0, 0.9), origin=(0.16, 0, 0.5), invert=False)
    dark = Material(specular=3, shininess=12, color="#38200f")
    dark = scene.replace(view=View.from_camera(camera), material=dark)
    both = pv.MultiBlock([lit, *(vizlight.illuminate(eye, dark) for eye in eyes)])
    panels.append(render.Panel(both, "rgb", title))

plotter = render.make_plotter(panels, camera=camera, size=(1600, 800), background="#14181d")
plotter.show()

# %%
# The ratio beside light that is scattered, ``exp(-a r)``: both fall as the way r through the solid
# grows, at first the ratio faster, later the exponential. The source on cos-theta shadows calls
# them qualitatively alike.

r = np.linspace(0.01, 10, 400)  # in depths d
figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
text = {"fontsize": 15, "va": "bottom"}
axes.plot(r, np.minimum(1 / r, 1), color="#c8641e", lw=3)
axes.text(1.35, 0.8, "$t = d / r$", color="#c8641e", **text)
axes.plot(r, np.exp(-np.log(2) * r / 2), "--", color="#1f6f9f", lw=3)
axes.text(4.0, 0.26, "$e^{-a r}$, $a = \\ln 2 / (2 d)$", color="#1f6f9f", **text)
axes.set_xlabel("way through the solid over the depth, $r / d$", fontsize=13)
axes.set_ylabel("share of light that passes", fontsize=13)
axes.tick_params(labelsize=12)
axes.set(xlim=(0, 10), ylim=(0, 1.05))
axes.spines[["top", "right"]].set_visible(False)
plt.show()
