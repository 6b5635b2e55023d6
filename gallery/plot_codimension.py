"""
A torus in 4-space: brightness in large codimensions
====================================================

The eight panels of illustration 1 of Banks, *Illumination in Diverse Codimensions*: a torus in
4-space and a curve wound on it, lit in 3-space after the projection or in 4-space before it. Above,
a larger codimension gives a brighter picture with less contrast: least for the curve in 4-space.
Below, the exponent p(k, n), here as printed in the paper, brings all means near 1/2, and the
contrast back.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render
from vizlight.geometry import manifolds
from vizlight.model import brightness

# A curve that is wound on the torus.
curve = manifolds.parametric(
    lambda t: [f(w * t) * r for w, r in ((1, 1.5), (51 / 25, 0.75)) for f in (np.cos, np.sin)],
    [(0, 50 * np.pi)], 4, resolution=64 * 120,
)  # fmt: skip
shapes, far = {1: curve, 2: manifolds.torus(1.5, 0.75, resolution=192)}, {"distance": 1.6771}
matte = Material(ambient=0.0, diffuse=1.0, specular=0.0, color="white")
below = vizlight.manifold(shapes[2], **far)
below["rgb"] = np.tile(pv.Color("#2f4664").float_rgb, (below.n_points, 1))
panels = []
for exponent in (1, "compensated"):
    for k, n, when in ((1, 3, "after"), (1, 4, "before"), (2, 3, "after"), (2, 4, "before")):
        scene = Scene(lights=Light(direction=(0.7, 0.6, 0.38, 0.0)[:n]), material=matte)
        mesh = vizlight.manifold(shapes[k], scene=scene, light=when, exponent=exponent, **far)
        p, mean = 1 if exponent == 1 else brightness.exponent(k, n), mesh["luminance"].mean()
        title = f"{'curve' if k == 1 else 'surface'} in {n}-space, exponent {p:.3g}\n"
        title += f"mean {mean:.2f}, contrast {mesh['luminance'].std() / mean:.2f}"
        panels.append(render.Panel(mesh if k == 2 else pv.MultiBlock([below, mesh]), "rgb", title))
camera = render.camera_on(below, (0.25, -1, 0.85), zoom=1.02)
look = {"rows": 2, "size": (1800, 800), "background": "white", "line_diameter": 0.045}
plotter = render.make_plotter(panels, camera=camera, **look)
for place in range(8):
    plotter.subplot(*divmod(place, 4))
    plotter.add_silhouette(below, color="black", line_width=2)
plotter.show()
