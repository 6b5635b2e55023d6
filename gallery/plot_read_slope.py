"""
How steeply do lines run toward you?
====================================

300 fibres of a brain's white matter. Left: PyVista's tubes under its light. Right: under one lamp
at the eye (``vizlight.presets.slope``) a fibre is pale where it runs across the view and brown
where it runs toward you or away, as the bar tells: a branch before the arch points at you. The rank
correlation of lightness with slope in the picture is printed below. Which of its ends is near is
not told; the example of heading tells that too.
"""

import pyvista as pv

import vizlight
from vizlight import Material, presets, render

fibres = vizlight.load_example("fibre_bundle.vtp")
scene = presets.slope().replace(
    material=Material(ambient=0.25, diffuse=0.75, specular=0, color="#ffdca8")
)
look = {"line_diameter": 0.2, "exponent": 2, "halo": 0.4}

sheet = {"window_size": (1900, 700), "shape": (1, 3), "col_weights": (1, 1, 0.36)}
plotter = pv.Plotter(off_screen=True, border=False, **sheet)
plotter.set_background("#14181d", all_renderers=True)
words = {"position": "upper_edge", "color": "white", "font_size": 14}
camera = render.camera_on(fibres, (1, -0.5, 0.3), aspect=1.12, zoom=1.04)
camera.SetWindowCenter(0, 0.05)
plotter.add_mesh(fibres.tube(radius=0.1), color="tan", smooth_shading=True)
plotter.add_text("\nPyVista: tubes in its light", **words)
plotter.camera = camera
plotter.enable_anti_aliasing("ssaa")
plotter.subplot(0, 2)
plotter.vizlight.add_key(scene, question="slope", exponent=2, size=0.3)
plotter.subplot(0, 1)
plotter.vizlight.add_mesh(fibres, scene=scene, **look)
plotter.add_text("\nvizlight: one lamp at the eye", **words)
plotter.camera = camera
plotter.enable_anti_aliasing("ssaa")
plotter.show(auto_close=False)

# %%
# What can be read in this light:

print(vizlight.legibility(fibres, scene, view=plotter.camera, **look))
