"""
A torus in 4-space: brightness in large codimensions
====================================================

The eight panels of illustration 1 of Banks, *Illumination in Diverse Codimensions*: a torus in
4-space (k = 2) and a curve wound on it (k = 1), lit in 4-space before the projection (n = 4) or in
3-space after it (n = 3).

The upper row is not compensated: a larger codimension gives a brighter picture with less contrast,
and the curve in 4-space hardly shows its shape. The lower row is compensated with the exponent
p(k, n): all four means are near 1/2. The contrasts become more similar but not equal: 0.58 for the
surface in 3-space and 0.61 in 4-space, 0.75 and 0.71 for the curve. Means and contrasts are
weighted by length or area.
"""

from vizlight import render
from vizlight.studies import codimension

panels = codimension.panels()
camera = render.camera_on(panels[0].mesh.bounds, (0.25, -1, 0.75), zoom=1.4)
plotter = render.make_plotter(
    [
        render.Panel(p.mesh, title=f"{p.title}\nmean {p.mean:.2f}, contrast {p.contrast:.2f}")
        for p in panels
    ],
    camera=camera,
    rows=2,
    size=(1800, 860),
    background="#203048",
    line_width=0.8,
)
plotter.show()
