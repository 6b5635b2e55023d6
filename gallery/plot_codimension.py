"""
A torus in 4-space: brightness in large codimensions
====================================================

The eight panels of illustration 1 of Banks, *Illumination in Diverse Codimensions*: a torus in
4-space (k = 2) and a curve wound on it (k = 1), lit in 4-space before the projection (n = 4) or in
3-space after it (n = 3). Upper row: a larger codimension gives a brighter picture with less
contrast; the curve in 4-space has a contrast of 0.18. Lower row: the exponent p(k, n), here as
printed in the paper, brings all means near 1/2, and this contrast to 0.70.
"""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render
from vizlight.geometry import manifolds
from vizlight.model import brightness

# A curve that is wound on the torus.
curve = manifolds.parametric(
    lambda t: [f(w * t) * r for w, r in ((1, 1.5), (81 / 40, 0.75)) for f in (np.cos, np.sin)],
    [(0, 80 * np.pi)], 4, resolution=64 * 192,
)  # fmt: skip
shapes = {1: curve, 2: manifolds.torus(1.5, 0.75, resolution=192)}
matte = Material(ambient=0.0, diffuse=1.0, specular=0.0)
# The torus below the curves is black, so that their brightness can be compared.
below = vizlight.manifold(shapes[2], distance=np.hypot(1.5, 0.75))
below["luminance"] = np.zeros(below.n_points)
panels = []
for exponent in (1, "compensated"):
    for k, n in ((1, 3), (1, 4), (2, 3), (2, 4)):
        scene = Scene(lights=Light(direction=(0.7, 0.6, 0.38, 0.0)[:n]), material=matte)
        options = {"light": "after" if n == 3 else "before", "exponent": exponent}
        mesh = vizlight.manifold(shapes[k], distance=np.hypot(1.5, 0.75), scene=scene, **options)
        p = 1 if exponent == 1 else brightness.exponent(k, n)
        mesh = mesh if k == 2 else pv.MultiBlock([below, mesh])
        panels.append(render.Panel(mesh, title=f"k = {k}, n = {n}, p = {p:.5g}"))
camera = render.camera_on(below.bounds, (0.25, -1, 0.75), aspect=1.05, zoom=1.4)
look = {"rows": 2, "size": (1800, 860), "background": "#203048", "line_diameter": 0.036}
plotter = render.make_plotter(panels, camera=camera, **look)
plotter.show()
