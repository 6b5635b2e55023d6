"""
A torus in 4-space: brightness in large codimensions
====================================================

The eight panels of illustration 1 of Banks, *Illumination in Diverse Codimensions*: a torus in
4-space (k = 2) and a curve wound on it (k = 1), lit in 4-space before the projection (n = 4) or in
3-space after it (n = 3).

The upper row is not compensated: a larger codimension gives a brighter picture with less contrast,
and the curve in 4-space hardly shows its shape. The lower row is compensated with the exponent
p(k, n): all four means are near 1/2. The contrasts become more similar but not equal: 0.58 for the
surface in 3-space and 0.61 in 4-space, 0.75 and 0.70 for the curve. Means and contrasts are
weighted by length or area.
"""

import numpy as np
import pyvista as pv

from vizlight import render
from vizlight.studies import codimension

panels = codimension.panels()
# The torus below the curves is black, so that their brightness can be compared.
below = panels[2].mesh.copy()
below["luminance"] = np.zeros(below.n_points)
camera = render.camera_on(below.bounds, (0.25, -1, 0.75), aspect=1.05, zoom=1.35)
plotter = render.make_plotter(
    [
        render.Panel(
            p.mesh if p.k == 2 else pv.MultiBlock([below, p.mesh]),
            title=f"{p.title}\nmean {p.mean:.2f}, contrast {p.contrast:.2f}",
        )
        for p in panels
    ],
    camera=camera,
    rows=2,
    size=(1800, 900),
    background="#203048",
    line_diameter=0.036,
)
plotter.show()
