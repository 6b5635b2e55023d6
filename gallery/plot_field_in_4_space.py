"""
A tangent field on a surface in 4-space
=======================================

A Clifford torus in 4-space with a field on it, unit vectors along curves that wind around both
circles. Left: the surface's own light (k = 2). Middle: the field's light alone (k = 1), which knows
nothing of the surface. Right: the field's light times the surface's brightness.

In codimension 1 a field inherits the self-shadow of its surface, for the surface has an outside. A
surface in 4-space has codimension 2: its unit normals at a point are a circle, no part of which is
outside, so there is no shadow side to inherit. Its own brightness is the factor instead, which in
codimension 1 is the two-sided form of the same law.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds

torus = vizlight.manifold(
    manifolds.clifford_torus(resolution=256), rotation=("xw", 0.15), distance=1.6
)
frame = np.asarray(torus["frame"]).reshape(-1, 2, 4)
torus["field"] = frame[:, 0] + frame[:, 1]
scene = Scene(
    lights=Light(direction=(0.5, -0.7, 0.6, 0.2)),
    view=View(direction=(0.3, -1, 0.8, 0)),
    material=Material(ambient=0.05, diffuse=0.55, specular=0.35),
)
where = {"positions": "position"}
panels = [
    render.Panel(vizlight.illuminate(torus, scene, **where, **options), title=title)
    for title, options in {
        "surface": {"tangents": "frame"},
        "field": {"tangents": "field"},
        "field, conditioned by the surface": {"tangents": "field", "conditioned": "frame"},
    }.items()
]

camera = render.camera_on(torus.bounds, (0.3, -1, 0.8), zoom=1.5)
plotter = render.make_plotter(panels, camera=camera, size=(1650, 480), background="#203048")
plotter.show()
