"""
A tract of the brain
====================

Three hundred nerve fibres from diffusion imaging, coloured by their direction. Left: as lines are
usually drawn, without light. The tract is a blot in which no fibre can be followed. Right: each
fibre is lit as a thin cylinder, and with ``bundle=True`` they are together a medium that dims the
light on its way in: sheets, gaps and single strands can be told apart, and front from back.
"""

# sphinx_gallery_thumbnail_number = 1
import numpy as np

import vizlight
from vizlight import Bundle, Light, Material, Scene, View, render

tract = vizlight.load_example("fibre_bundle.vtp")
camera = render.camera_on(tract, (1, -0.55, 0.2), aspect=1.1, zoom=1.07)
scene = Scene(
    lights=Light(direction=(1.2, -0.1, 1)),
    view=View.from_camera(camera),
    material=Material(ambient=0.55, diffuse=1.0, specular=0.3, shininess=25),
)
lit = vizlight.illuminate(
    tract, scene, bundle=Bundle(depth=1.2), occlusion="sky", model="cylinder", components=True
)

# The usual colours of directions, red, green and blue, in hues that go together.
share = np.asarray(vizlight.direction_colors(tract), dtype=float) ** 2
share /= share.sum(axis=1, keepdims=True)
flat = tract.copy()
flat["rgb"] = share @ [[0.93, 0.38, 0.22], [0.98, 0.76, 0.30], [0.22, 0.52, 0.86]]
# A strand that stands alone gets all the light, but not more than its colour.
light = np.minimum(1.35 * (lit["ambient"] + lit["diffuse"]), 1.1)
lit["rgb"] = flat["rgb"] * light[:, np.newaxis] + lit["specular"][:, np.newaxis]

panels = [render.Panel(flat, "rgb"), render.Panel(lit, "rgb")]
options = {"camera": camera, "size": (1600, 760), "line_width": 1.4}
plotter = render.make_plotter(panels, background="black", **options)
plotter.show()

# %%
# The same on white paper.

plotter = render.make_plotter(panels, background="white", **options)
plotter.show()

# %%
# The shares of light are point arrays: ``transmittance`` for each light and ``sky`` for light
# from all sides, here on their own. They are computed again only where lines or lights have
# changed, not where the eye has moved.

shares = [render.Panel(lit, name, name) for name in ("transmittance", "sky")]
plotter = render.make_plotter(shares, background="black", **options)
plotter.show()
