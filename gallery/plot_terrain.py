"""
Islands under a low sun
=======================

Hawaii and the sea floor around it, heights 9 times as they are, under a low warm sun in the west, a
blue light from the other side, and the light of the sky. The two hues tell which way a slope faces.
Cast shadows tell heights, and valleys are dark out of the sun too, by the share of the sky
that each point sees. One call finds both: ``relief_shadow(..., occlusion="sky")``.
"""

import pyvista as pv
from matplotlib.colors import LinearSegmentedColormap

from vizlight import Light, Material, Scene, legibility, load_example, relief_shadow, render, tint

tints = ["#27558f", "#3a80b4", "#7cbcd6", "#b2dce4", "#5f9a52", "#b5965f", "#f4efe6"]
places = [0, 0.3, 0.58, 0.6667, 0.6706, 0.83, 1]  # of heights from -6000 to 3000 m
tints = LinearSegmentedColormap.from_list("sea and land", list(zip(places, tints, strict=True)))
relief = load_example("hawaii.vti").resample(6.0, interpolation="bspline")
relief = relief.gaussian_smooth(std_dev=4)
sun = Light(direction=(-0.87, 0.25, 0.42), color="#ffc080", intensity=1.25)
blue = Light(direction=(0.48, -0.14, 0.87), color="#80b8ff", intensity=0.6)
scene = Scene(lights=[sun, blue], material=Material(ambient=0.4, diffuse=0.85, specular=0))
options = {"elevation": "elevation", "exaggeration": 9, "depth": 1500, "samples": 8}
lit = relief_shadow(relief, scene, angular_diameter=0.06, lit=True, occlusion="sky", **options)
lit = tint(lit, "elevation", cmap=tints, clim=(-6000, 3000))
ground = lit.warp_by_scalar("elevation", factor=9)

plotter = pv.Plotter(off_screen=True, window_size=(1500, 1000))
plotter.background_color = "#14181d"
bar = {"title": "height, m\n", "color": "white", "fmt": "%.0f", "n_labels": 4, "vertical": True}
bar |= {"position_x": 0.88, "width": 0.09, "title_font_size": 26, "label_font_size": 24}
plotter.vizlight.add_mesh(ground, scalar_bar_args={**bar, "position_y": 0.5})
coast = ground.contour([0], scalars="elevation").translate((0, 0, 900))
plotter.add_mesh(coast, color="#26422f", line_width=7)
plotter.enable_anti_aliasing("ssaa")
plotter.camera = render.camera_on((3.9e5, 9.9e5, 2.1e5, 6.5e5, 0, 0), (0.3, -1, 1.3), zoom=1.64)
north = pv.Arrow(start=(4.4e5, 2e5, -3.8e4), direction=(0, 1, 0), scale=6e4)
plotter.add_mesh(north + pv.Box((4.6e5, 5.6e5, 2e5, 2.06e5, -3.9e4, -3.8e4)), color="white")
places = [(4.8e5, 2.15e5, -3.8e4), (4.34e5, 2.65e5, -3.8e4)]
words = {"shape": None, "show_points": False, "text_color": "white", "font_size": 26, "bold": False}
plotter.add_point_labels(places, ["100 km", "N"], always_visible=True, **words)
plotter.show(auto_close=False)

# %%
# What can be read of the shape in this light, but for its shadows:

print(legibility(ground, scene, view=plotter.camera))
