"""
Shadows of a mountain ridge
===========================

The Jacksboro fault in Tennessee, 30 km by 32 km, with the sun in the north-west at 12 degrees,
coloured by elevation from 236 m (green) to 1,076 m (white). The light is the cos-theta shadow
``t``: it equals the cosine where the sun is not blocked and is dark where a ridge stands in the
way. The edges of shadows are soft over 60 m, because the light is gathered that far below the
ground. Heights are doubled.
"""

import matplotlib.pyplot as plt
import numpy as np

import vizlight
from vizlight import Light, Material, Scene, render

terrain = vizlight.load_example("jacksboro_fault.vti")
columns, rows, _ = terrain.dimensions
heights = np.asarray(terrain["elevation"], dtype=float)
hues = plt.get_cmap("gist_earth")(np.interp(heights, (236, 1076), (0.35, 1)))[:, :3]
slopes = np.gradient(2 * heights.reshape(rows, columns), *terrain.spacing[1::-1])
normal = np.stack([-slopes[1], -slopes[0], np.ones((rows, columns))], axis=-1).reshape(-1, 3)
normal /= np.linalg.norm(normal, axis=1, keepdims=True)


def shadowed(degrees):
    """Return the terrain in two colours: lit by t, and by the cosine of the classic hillshade."""
    e = np.radians(degrees)
    toward = np.array([-np.cos(e) * 0.8, np.cos(e) * 0.6, np.sin(e)])
    scene = Scene(lights=Light(direction=toward), material=Material(specular=0))
    lit = vizlight.relief_shadow(terrain, scene, depth=60, elevation="elevation", exaggeration=2)
    for name, share in (("shadow", lit["t"]), ("hillshade", np.maximum(normal @ toward, 0))):
        # Level ground has the same brightness under each sun.
        light = 0.1 + 0.45 * np.asarray(share) / np.sin(e)
        lit[name] = np.clip(1.15 * hues * light[:, np.newaxis], 0, 1)
    return lit


ground = shadowed(12).cast_to_structured_grid()
ground.points[:, 2] = 2 * heights
camera = render.camera_on(ground.bounds, (0.35, -1, 0.8), aspect=1.5, zoom=2.1)
plotter = render.make_plotter(
    render.Panel(ground, "shadow"), camera=camera, size=(1500, 1000), background="#e6edf2"
)
plotter.show()

# %%
# The south of it from above with the sun at 10, 25 and 45 degrees. Upper row: the classic
# hillshade, the clamped cosine, in which no ridge casts a shadow: at 10 degrees the hill on the
# right is bright although the ridge stands before the sun. Lower row: ``t``. Where nothing is in
# the way the two agree. Level ground has the same brightness in all panels.

SOUTH = (120, 295, 20, 150, 0, 0)
panels = [
    render.Panel(lit, name, f"{name}, sun {degrees} degrees")
    for name in ("hillshade", "shadow")
    for degrees, lit in (
        (degrees, shadowed(degrees).extract_subset(SOUTH)) for degrees in (10, 25, 45)
    )
]
plotter = render.make_plotter(
    panels,
    camera=render.camera_on(panels[0].mesh.bounds, (0, 0, 1), parallel=True, zoom=1.28),
    rows=2,
    size=(1500, 1000),
    background="white",
)
plotter.show()
