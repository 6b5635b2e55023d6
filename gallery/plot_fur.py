"""
A furry torus
=============

Fibres on a torus of radii 1.5 and 0.75: the three panels of illustration 3 of Banks, *Illumination
in Diverse Codimensions*, with its coefficients.

A: the fibres alone are lit. B: the light is conditioned by the normals of the torus. C: the light
is also attenuated by the fur on its way in and out, so that the base of a fibre is darker than its
tip and single fibres can be distinguished near the edge of the shadow. All panels use the plain
cosine law of the paper (``compensate=False``). Fur of density 0.02 per unit of the torus would
hardly be visible at a length of 0.3, so lengths are counted in hundredths here.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

angle = np.linspace(0, 2 * np.pi, 128, endpoint=False)
u, v = np.meshgrid(angle, angle, indexing="ij")
normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=-1)
points = 1.5 * np.stack([np.cos(u), np.sin(u), 0 * u], axis=-1) + 0.75 * normals
i = np.arange(128 * 128).reshape(128, 128)
right, up = np.roll(i, -1, axis=0), np.roll(i, -1, axis=1)
across = np.roll(right, -1, axis=1)
faces = np.concatenate([np.stack([i, right, across], -1), np.stack([i, across, up], -1)])
torus = pv.PolyData.from_regular_faces(
    points.reshape(-1, 3).astype(np.float32), faces.reshape(-1, 3)
)
torus["Normals"] = normals.reshape(-1, 3).astype(np.float32)
torus.point_data.active_normals_name = "Normals"

camera = render.camera_on(torus.bounds, (0.3, -1, 0.8), zoom=1.12)
scene = Scene(
    lights=Light(direction=(-1, -0.6, 0.9)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.9, specular=0.1),
)
hair = {"fibres": 401_408, "length": 0.3, "segments": 6, "toward": (0, 0, -1), "bend": 0.8}
hair["compensate"] = False
density = 1 - (1 - 0.02) ** 100
bare = vizlight.fur(torus, scene, density=density, conditioned=False, attenuated=False, **hair)
shadowed = vizlight.fur(torus, scene, density=density, attenuated=False, **hair)
furry = vizlight.fur(torus, scene, density=density, **hair)

plotter = render.make_plotter(
    [
        render.Panel(coat, title=title)
        for coat, title in zip((bare, shadowed, furry), "ABC", strict=True)
    ],
    camera=camera,
    size=(1650, 560),
    background="#5a6570",
    line_width=0.45,
)
plotter.show()
