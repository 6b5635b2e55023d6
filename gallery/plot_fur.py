"""
The fur of a dog
================

A dog with 400,000 hairs. Each hair is lit as a thin line, inherits the shadow of the skin it
stands on, and is dimmed by the fur above it, on the way in and out: so it is darker at its base,
and single hairs stand out. Its length, the direction in which it lies and its colour are arrays of
points. In a column of print the way of the hair is read with a median error of 9 degrees, that of
PyVista's tubes on the skin of 7.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

dog = vizlight.load_example("dog.vtp").compute_normals(split_vertices=False)
x, y, z = np.asarray(dog.points).T
# No hair grows in the mouth, on the nose and on the lids of the eyes.
mouth = (x > 0.36) & (z < 0.632) & (z > 0.708 - 0.25 * x) & (np.abs(y) < 0.026)
nose = np.linalg.norm(np.subtract(dog.points, (0.467, 0, 0.669)) / (1, 1.2, 1), axis=1) < 0.02
bare = mouth | nose | (np.hypot(np.hypot(x - 0.363, np.abs(y) - 0.024), z - 0.7046) < 0.016)
long = np.interp(x, [-0.7, -0.4, -0.2, 0.15, 0.25, 0.36], [0.06, 0.045, 0.03, 0.045, 0.025, 0.012])
dog["length"] = np.where(bare, 0, long * np.interp(z, [0, 0.45, 0.7, 0.74], [0.3, 1, 1, 0.5]))
# Hair lies back, down along the legs, and up on the ears.
dog["lie"] = np.stack([0 * x - 1, 0.2 * np.sign(y), np.interp(z, [0.7, 0.8], [-0.6, 2])], axis=1)
eyes = pv.merge([pv.Sphere(radius=0.012, center=(0.363, y, 0.7046)) for y in (-0.024, 0.024)])
camera = render.camera_on((0.12, 0.47, -0.1, 0.1, 0.49, 0.81), (1, -1, 0.2), aspect=1.3, zoom=1.4)
lamps = [Light(direction=(1.1, -0.7, 1.2)), Light(direction=(-0.8, 0.9, 0.6), intensity=1.2)]
paint = Material(ambient=0.3, diffuse=1.7, specular=0.5, shininess=14, color="#f4b06a")
scene = Scene(lights=lamps, view=View.from_camera(camera), material=paint)
groomed = {"length": "length", "toward": "lie", "bend": 0.97, "curl": 0.05, "turns": 0.5}
coat = vizlight.fur(dog, scene, fibres=400_000, segments=6, absorption=0.7, **groomed)
# Muzzle, ears and some of the hairs are darker.
x, y, z = np.asarray(coat["fibres"].points).T
dark = np.interp(x, [0.36, 0.43], [1, 0.5]) * np.interp(z, [0.68, 0.78], [1, 0.5])
dark = dark[:, np.newaxis] * np.random.default_rng(0).uniform(0.7, 1.15, (400_000, 1)).repeat(7, 0)
coat["fibres"]["rgb"] = coat["fibres"]["rgb"] * dark
skin = np.select([mouth[:, np.newaxis], nose[:, np.newaxis]], [[0.32, 0.19, 0.21], [0.1] * 3], 0.6)
coat["skin"]["rgb"] = coat["skin"]["rgb"] * skin
coat.append(vizlight.illuminate(eyes, scene.replace(material=Material(specular=1, color="k"))))
look = {"size": (1300, 1000), "background": "#14181d", "scalars": "rgb"}
plotter = render.make_plotter(coat, camera=camera, **look)
plotter.show()
