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

from fractions import Fraction

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, render
from vizlight.geometry import manifolds
from vizlight.model import brightness

R1, R2 = 1.5, 0.75
SHAPES = {
    1: manifolds.torus_curve(Fraction(81, 40), r1=R1, r2=R2, resolution=64 * 192),
    2: manifolds.torus(R1, R2, resolution=192),
}
MATTE = Material(ambient=0.0, diffuse=1.0, specular=0.0)


def sizes(points, cells):
    """Return the length or area at each point; each cell is shared equally by its corners."""
    corners = points[cells]
    u, v = corners[:, 1] - corners[:, 0], corners[:, -1] - corners[:, 0]
    size = np.linalg.norm(u, axis=1)
    if cells.shape[1] == 4:
        # The height of v over u: the quadrilaterals are nearly parallelograms.
        along = np.sum(u * v, axis=1) / size**2
        size = size * np.linalg.norm(v - along[:, np.newaxis] * u, axis=1)
    return np.bincount(cells.ravel(), np.repeat(size, cells.shape[1]), minlength=len(points))


panels = []
for compensated in (False, True):
    for k, n in ((1, 3), (1, 4), (2, 3), (2, 4)):
        toward = (0.7, 0.6, 0.38) if n == 3 else (0.7, 0.6, 0.38, 0.0)
        mesh = vizlight.manifold(
            SHAPES[k],
            distance=np.hypot(R1, R2),
            scene=Scene(lights=Light(direction=toward), material=MATTE),
            light="after" if n == 3 else "before",
            exponent="compensated" if compensated else 1,
        )
        light = mesh["luminance"]
        size = sizes(mesh.points if n == 3 else SHAPES[k].points, SHAPES[k].cells)
        mean = np.average(light, weights=size)
        contrast = np.sqrt(np.average((light - mean) ** 2, weights=size)) / mean
        p = brightness.exponent(k, n) if compensated else 1.0
        title = f"k = {k}, n = {n}, p = {p:.5g}\nmean {mean:.2f}, contrast {contrast:.2f}"
        panels.append((k, mesh, title))
# The torus below the curves is black, so that their brightness can be compared.
below = panels[2][1].copy()
below["luminance"] = np.zeros(below.n_points)
camera = render.camera_on(below.bounds, (0.25, -1, 0.75), aspect=1.05, zoom=1.35)
plotter = render.make_plotter(
    [
        render.Panel(mesh if k == 2 else pv.MultiBlock([below, mesh]), title=title)
        for k, mesh, title in panels
    ],
    camera=camera,
    rows=2,
    size=(1800, 900),
    background="#203048",
    line_diameter=0.036,
)
plotter.show()
