"""
The winds of July
=================

The mean wind of July around the Indian Ocean. Hue is the direction of the wind on the screen: find
it on the disc. The trade winds of the south cross the equator, turn, and blow past the Horn of
Africa toward India; where hue changes at once, winds meet. A hue stands for a direction and its
opposite alike: the heads of the arrows tell which of the two it is. Under the white light of
``Scene()`` the direction is unreadable.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Material, Scene, presets, render

air = vizlight.load_example("winds_of_july.vtp")
air = air.compute_normals(cell_normals=False, auto_orient_normals=True)
coast = vizlight.load_example("earth_relief.vti").contour([0.5], scalars="elevation")
east, north = np.radians(np.asarray(coast.points, dtype=float)[:, :2].T)
ball = np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)
coast.points = 1.003 * np.stack(ball, axis=1)
evenly = {"spacing": 0.06, "stroke_length": 0.26, "min_length": 0.1}
lines, eye = vizlight.streamlines(air, tangents="wind", **evenly).scale(1.005), (0.42, 1, 0.1)
# Arrows at the limb are crowded.
lines, coast = (x.clip(eye, origin=np.multiply(eye, 0.5), invert=False) for x in (lines, coast))
scene, even = presets.direction(), Scene(material=Material(ambient=1, diffuse=0, specular=0))

plotter = pv.Plotter(off_screen=True, window_size=(1400, 1060))
plotter.set_background("#14181d")
plotter.vizlight.add_mesh(air, scene=scene, tangents="wind", exponent=2)
plotter.vizlight.add_mesh(coast, scene=even, color="white", line_diameter=0.006, halo=False)
strokes = {"width": "width", "line_width": 12, "halo": False}
plotter.vizlight.add_mesh(lines, scene=even, color="#20222a", **strokes)
plotter.vizlight.add_key(scene, exponent=2, size=0.22)
plotter.camera = render.camera_on(air.bounds, eye, zoom=1.6)
places = np.array([[0.9, 0.42, 0.02], [0.18, 0.93, 0.34]])
look = {"shape": None, "show_points": False, "font_size": 30, "text_color": "white"}
plotter.add_point_labels(places, ["AFRICA", "INDIA"], always_visible=True, shadow=True, **look)
plotter.enable_anti_aliasing("ssaa")
plotter.show()

# %%
# What can be read of the direction in this light, and in white light:

for light in (scene, Scene()):
    print(vizlight.legibility(air, light, tangents="wind", exponent=2, view=plotter.camera))
