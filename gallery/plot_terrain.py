"""
Islands under a low sun
=======================

Hawaii and the sea floor around it, heights 9 times as they are, under a low sun in the west and the
light of the sky. ``t``, the cos-theta shadow, is the sunlight that arrives: 0 behind a ridge, the
cosine where nothing is in the way. The sky's light is the share of it that each point sees, so that
valleys are dark also out of the sun. One call finds both: ``relief_shadow(..., occlusion="sky")``.
This light tells heights by their shadows; slopes are read better by ``presets.shape``.
"""

import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap

import vizlight
from vizlight import Light, Material, Scene, render

tints = ["#1d3f72", "#2b6a9c", "#6fb0cc", "#d6ecec", "#5f9a52", "#b5965f", "#f4efe6"]
places = [0, 0.3, 0.58, 0.665, 0.67, 0.83, 1]  # of heights from -5800 to 2860 m: 0.67 is the coast
tints = LinearSegmentedColormap.from_list("sea and land", list(zip(places, tints, strict=True)))
relief = vizlight.load_example("hawaii.vti").resample(8.0, interpolation="bspline")
material = Material(ambient=0.65, diffuse=1.25, specular=0)
scene = Scene(lights=Light(direction=(-0.85, 0.25, 0.4)), material=material)
options = {"elevation": "elevation", "exaggeration": 9, "depth": 1500}
lit = vizlight.relief_shadow(relief, scene, lit=True, occlusion="sky", **options)
lit = vizlight.tint(lit, "elevation", cmap=tints, clim=(-5800, 2860))
ground = lit.warp_by_scalar("elevation", factor=9)

islands = (4.1e5, 10e5, 2.2e5, 6.6e5, -4e4, 2e4)
camera = render.camera_on(islands, (0.3, -1, 1.3), aspect=1.5, zoom=1.5)
look = {"size": (1500, 1000), "background": "#1f4a7c"}
plotter = render.make_plotter(render.Panel(ground, "rgb"), camera=camera, **look)
north = pv.Arrow(start=(4.4e5, 2e5, -3.8e4), direction=(0, 1, 0), scale=6e4)
plotter.add_mesh(north + pv.Box((4.6e5, 5.6e5, 2e5, 2.06e5, -3.9e4, -3.8e4)), color="white")
words = {"shape": None, "show_points": False, "text_color": "white", "font_size": 26}
places = [(4.8e5, 2.15e5, -3.8e4), (4.34e5, 2.65e5, -3.8e4)]
plotter.add_point_labels(places, ["100 km", "N"], **words)
plotter.show()
