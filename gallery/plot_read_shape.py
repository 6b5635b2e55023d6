"""
What is the shape?
==================

The left half of the mean brain of 152 people. Left: PyVista's light. Right: three coloured lamps
half way between the eye and the picture plane (``vizlight.presets.shape``): each slope has a
colour, which the ball shows at the place of the same slope. The light of the sky
(``vizlight.sky``) darkens the folds. How well the normal is read in either light is printed below:
in a column of print the folds are nearly too fine for hues.
"""

import pyvista as pv

import vizlight
from vizlight import Material, Scene, presets, render

cortex = vizlight.load_example("brain.vti").contour([55.5]).connectivity("largest")
# Some points deep in folds see nothing of the sky: a warning says how many.
cortex = vizlight.sky(cortex, error=0.05)
scene = presets.shape().replace(material=Material(ambient=0.3, diffuse=0.6, specular=0))

size = {"window_size": (2000, 820), "shape": (1, 3), "col_weights": (1, 1, 0.27)}
plotter = pv.Plotter(off_screen=True, border=False, **size)
plotter.set_background("#14181d", all_renderers=True)
words = {"position": "upper_edge", "color": "white", "font_size": 14}
plotter.add_text("\nPyVista: smooth shading", **words)
plain = plotter.add_mesh(cortex, color="white", smooth_shading=True, show_scalar_bar=False)
plotter.camera = camera = render.camera_on(cortex, (-1, 0.25, 0.3), aspect=1.1, zoom=0.96)
plain = Scene.from_plotter(plotter, actor=plain)
plotter.enable_anti_aliasing("ssaa")
plotter.subplot(0, 1)
plotter.add_text("\nvizlight: hues of slopes, light of the sky", **words)
lit = cortex.vizlight.illuminate(scene, occlusion="sky")
plotter.vizlight.add_mesh(lit)
plotter.camera = camera
plotter.enable_anti_aliasing("ssaa")
plotter.subplot(0, 2)
plotter.vizlight.add_key(scene, size=0.24)
plotter.subplot(0, 1)
plotter.show(auto_close=False)

# %%
# What can be read in this light, and in PyVista's:

for mesh, light in ((lit, scene), (cortex, plain)):
    print(vizlight.legibility(mesh, light, view=camera))
