"""
A field of directions on a torus in 4-space
===========================================

What Banks, *Illumination in Diverse Codimensions*, names as the next step: lines of a field on a
surface in 4-space. The field winds about the torus, 3 turns of one circle for 2 of the other. Left:
the light of the surface alone. Middle: its lines are lit as curves in 4-space, of codimension 3,
wherever they lie. Right: they inherit the light of the surface. In codimension 2 it has no sides:
its own brightness is the factor, and the lines show its shape too.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds

torus = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=256), distance=1.7)
first, second = np.reshape(torus["frame"], (-1, 2, 4)).transpose(1, 0, 2)
# Angles along the circles grow as 3 to 2, lengths by their radii too.
field = 3 * 1.5 * first + 2 * 0.75 * second
torus["field"] = field / np.linalg.norm(field, axis=1, keepdims=True)
scene = Scene(
    lights=Light(direction=(0.7, 0.6, 0.38, 0.0)),
    view=View(direction=(0.25, -1.0, 0.75, 0.3)),
    material=Material(ambient=0.1, diffuse=0.75, specular=0.5, shininess=20),
)
panels = []
for title, options in {
    "the surface, k = 2": {"tangents": "frame"},
    "its lines, k = 1": {"tangents": "field"},
    "lines on the surface": {"tangents": "field", "conditioned": "frame"},
}.items():
    lit = vizlight.illuminate(torus, scene, positions="position", **options)
    panels.append(render.Panel(lit, title=title))
camera = render.camera_on(torus.bounds, (0.25, -1, 0.75), aspect=0.95, zoom=1.2)
plotter = render.make_plotter(panels, camera=camera, size=(1800, 660), background="#203048")
plotter.show()
