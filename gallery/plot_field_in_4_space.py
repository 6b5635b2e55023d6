"""
A tangent field on a surface in 4-space
=======================================

A Clifford torus in 4-space with a tangent field on it: unit vectors along curves that wind around
both circles. Left: the light of the surface (k = 2). Middle: the light of the field alone (k = 1),
which does not depend on the surface. Right: the light of the field times the brightness of the
surface. The colour is the fourth coordinate.

In codimension 1 a field inherits the self-shadow of its surface, because the surface has an outer
side. A surface in 4-space has codimension 2: its unit normals at a point form a circle, so there
is neither an outer side nor a shadow side to inherit. The brightness of the surface is the factor
instead. In codimension 1 this factor is the two-sided form of the same formula.
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
    material=Material(ambient=0.05, diffuse=0.75, specular=0.35),
)
where = {"positions": "position"}
panels = [
    render.Panel(
        vizlight.tint(
            vizlight.illuminate(torus, scene, **where, **options),
            np.asarray(torus["position"])[:, 3],
            cmap="RdYlBu_r",
        ),
        "rgb",
        title,
    )
    for title, options in {
        "surface": {"tangents": "frame"},
        "field": {"tangents": "field"},
        "field, conditioned by the surface": {"tangents": "field", "conditioned": "frame"},
    }.items()
]

camera = render.camera_on(torus.bounds, (0.3, -1, 0.8), zoom=1.5)
plotter = render.make_plotter(panels, camera=camera, size=(1650, 480), background="#203048")
plotter.show()
