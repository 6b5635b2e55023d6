"""
The winds of July
=================

The mean wind of July over the earth: evenly spaced lines, coloured by speed and lit by their own
directions. In the middle the monsoon: trade winds from the south-east cross the equator, turn, and
blow past the Horn of Africa toward India, the strongest wind of this picture. Lines are bright
where they run across the light, so bends and eddies stand out even where the colour is the same.

The colours have one lightness and one chroma, and light dims them to half at most: hue is speed,
lightness is direction. The winds are measured ones, the mean of eleven years; the heights of the
relief are multiplied by 25. In the interactive scene the light follows the eye.
"""

import matplotlib.colors as colors
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

relief = vizlight.load_example("earth_relief.vti").extract_subset(
    (0, 1079, 0, 539, 0, 0), (3, 3, 1)
)
columns, rows, _ = relief.dimensions
height = np.asarray(relief["elevation"], dtype=float).reshape(rows, columns)
height = np.concatenate([height, height[:, :1]], axis=1)
east, north = np.radians(np.meshgrid(np.arange(columns + 1) - 179.83, np.arange(rows) - 89.83))
ball = np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)
radius = 1 + 25 * height / 6_371_000
earth = pv.StructuredGrid(*((radius * x)[..., np.newaxis] for x in ball))
earth["metres"] = height.ravel(order="F")
earth = earth.extract_surface(algorithm="geometry").clean(tolerance=1e-7)
earth = earth.compute_normals(split_vertices=False, auto_orient_normals=True)

camera = render.camera_on((-1, 1, -1, 1, -1, 1), (0.42, 1, 0.2), aspect=1.25, zoom=1.65)
scene = Scene(
    lights=[Light(direction=(0.3, 1, 0.8), intensity=0.5), Light.headlight(intensity=0.6)],
    view=View.from_camera(camera),
    material=Material(ambient=0.4, diffuse=0.6, specular=0),
)
air = vizlight.load_example("winds_of_july.vtp").scale(1.022)
wind = vizlight.streamlines(air, scene, vectors="wind", spacing=0.023)
wind["m/s"] = np.linalg.norm(wind["wind"], axis=1)

# The ground is neutral, so that hue belongs to the winds alone.
ground = [(0, "#0a0b0d"), (0.46, "#24282d"), (0.48, "#4c4a47"), (1, "#b5b2ae")]
ground = colors.LinearSegmentedColormap.from_list("ground", ground)
plotter = pv.Plotter(off_screen=True, window_size=(1400, 1120))
plotter.background_color = "black"
plotter.enable_anti_aliasing("ssaa")
plotter.vizlight.add_mesh(
    earth, scene=scene.replace(material=Material(ambient=0.2, diffuse=0.8, specular=0)),
    scalars="metres", cmap=ground, clim=(-6000, 7000), show_scalar_bar=False,
)  # fmt: skip
bar = {"title": "m/s\n", "color": "white", "n_labels": 3, "fmt": "%.0f", "vertical": True}
plotter.vizlight.add_mesh(
    wind, scalars="m/s", clim=(0, 12), line_diameter=0.008, scalar_bar_args=bar
)
plotter.camera = camera
plotter.show()
