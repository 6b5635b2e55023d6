"""
Choosing by tolerance
=====================

Say how wrong the light may be, and the cheapest evaluation whose stated bound is within that is
taken: left the exact law, middle what one step of a picture of 8 bits allows, which is Blinn's
highlight for Phong's, in float32. Right how far they differ: nowhere as much as was allowed.

Below, what each tolerance took and what it left, with the bounds.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, engine, render

bundle = vizlight.load_example("fibre_bundle.vtp")
camera = render.camera_on(bundle, (0.3, -1, 0.4), aspect=1.2)
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
worst = f"they differ, black 0, white 1 of 255:\nat most {off.max():.2f}, bound {bound:.2f}"

plotter = render.make_plotter(
    [
        render.Panel(exact, title="exact"),
        render.Panel(near, title="within 1/255"),
        render.Panel(difference, title=worst),
    ],
    camera=camera,
    size=(1800, 560),
    line_width=2,
)
plotter.show()

# %%
# Without a tolerance the exact forms are computed. With one:

for tolerance in (1e-6, 1e-4, 1 / 255, 0.05):
    plan = engine.plan(scene, k=1, tolerance=tolerance)
    told = plan.explain().splitlines()
    kept = [
        line for line in told if any(word in line for word in ("tolerance", "within", "differ"))
    ]
    print(*kept, "", sep="\n")
