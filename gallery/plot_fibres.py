"""
A bundle of brain fibres
========================

Three hundred nerve fibres from diffusion imaging of a brain. On the left they are drawn in one
colour and form a blot. On the right they are lit by their own tangents: the sheets of the bundle
can be told apart, and so can a strand that crosses over it.
"""

# sphinx_gallery_thumbnail_number = 2
import numpy as np

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render

bundle = vizlight.load_example("fibre_bundle.vtp")
camera = render.camera_on(bundle, (0.3, -1, 0.4), aspect=1.2)
scene = Scene(
    lights=Light(direction=(-0.5, -1, 1)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.9, specular=0.4, shininess=30),
    depth_cue=DepthCue(back_scale=0.5),
)
lit = vizlight.illuminate(bundle, scene)
flat = bundle.copy()
flat["luminance"] = np.full(flat.n_points, 0.7)

plotter = render.make_plotter(
    [render.Panel(flat, title="one colour"), render.Panel(lit, title="lit, fading with depth")],
    camera=camera,
    size=(1500, 600),
    line_width=1,
)
plotter.show()

# %%
# The lit bundle as an interactive scene, in which the light follows the eye.

plotter = render.make_plotter(lit, camera=camera, size=(1000, 700), line_width=1)
plotter.show()
