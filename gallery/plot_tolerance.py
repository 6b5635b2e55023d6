"""
Choosing by tolerance
=====================

With ``tolerance=`` you state the largest acceptable error, and the cheapest evaluation whose error
bound is within it is used. Above: the exact model. Middle: one step of an 8-bit picture is allowed,
which selects Blinn's highlight in place of Phong's, in float32. Below: the difference of the two,
which is below the tolerance everywhere.

The output below lists what each tolerance selected and what it rejected, with the error bounds.
Where numba is installed (extra ``fast``) the exact forms cost so little that nothing is cheaper,
and they are kept; NumPy lights the points here.
"""

import os

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, engine, render

os.environ["VIZLIGHT_FAST"] = "0"
bundle = vizlight.load_example("fibre_bundle.vtp")
camera = render.camera_on(bundle, (0.3, -1, 0.4), aspect=2.5, zoom=1.15)
scene = Scene(
    lights=Light.headlight(),
    view=View(direction=(0.3, -1, 0.4)),
    material=Material(ambient=0.1, diffuse=0.9, specular=0.6, shininess=20.4),
)
exact = vizlight.illuminate(bundle, scene)
near = vizlight.illuminate(bundle, scene, tolerance=1 / 255)

off = 255 * np.abs(near["luminance"] - exact["luminance"])
bound = 255 * vizlight.provenance(near)["error_bound"]
difference = bundle.copy()
difference["luminance"] = off
worst = f"difference, black 0, white 1 of 255: at most {off.max():.2f}, bound {bound:.2f}"

plotter = render.make_plotter(
    [
        render.Panel(exact, title="exact"),
        render.Panel(near, title="within 1/255"),
        render.Panel(difference, title=worst),
    ],
    camera=camera,
    rows=3,
    size=(1100, 1320),
    line_width=1.2,
)
plotter.show()

# %%
# Without a tolerance the exact forms are computed. With a tolerance:

for tolerance in (1e-6, 1e-4, 1 / 255, 0.05):
    plan = engine.plan(scene, k=1, tolerance=tolerance)
    for line in plan.explain().splitlines():
        if any(word in line for word in ("tolerance", "within", "differ")):
            print(line)
    print()
del os.environ["VIZLIGHT_FAST"]
