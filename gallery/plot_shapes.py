"""
Shapes in 4-space
=================

Shapes from ``vizlight.geometry.manifolds``, lit in 4-space and projected to 3-space. From left to
right: the Klein bottle and the Veronese surface (a projective plane), neither of which intersects
itself in 4-space although its projection does; the graph of w = z^2; fibres of the Hopf map, which
are disjoint circles of the 3-sphere; and the section of the 3-sphere by a hyperplane. Colours show
the fourth coordinate: where surfaces of different colours cross, they are apart in 4-space.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.geometry import manifolds

camera = render.camera_on((-1, 1, -1, 1, -1, 1), (0.4, -1, 0.5), zoom=1.35)
scene = Scene(
    lights=Light(direction=(0.3, -0.6, 0.8, 0.5)),
    view=View(direction=(0.4, -1, 0.5, 0)),
    material=Material(ambient=0.1, diffuse=0.6, specular=0.3),
)
slanted = ("xw", 0.08)
# The fibres over three circles of latitude cover three nested tori.
t = np.linspace(0, 2 * np.pi, 36, endpoint=False)
base = np.concatenate([np.stack([np.cos(t), np.sin(t), z + 0 * t], 1) for z in (0.4, 1.2, 5)])
shapes = {
    "Klein bottle": (
        manifolds.klein_bottle(major=0.75, minor=0.35, resolution=(240, 120)),
        {"rotation": [("zw", 0.6), ("xw", 0.3)]},
    ),
    "Veronese surface": (
        manifolds.veronese(radius=1.35, resolution=96),
        {"rotation": [("zw", 0.9), ("xw", 0.4)]},
    ),
    "w = z^2": (
        manifolds.complex_curve(np.square, domain=((-0.72, 0.72),) * 2, resolution=160),
        {"rotation": [("xw", 0.7), ("yz", 0.5)]},
    ),
    "Hopf fibres": (
        manifolds.hopf_fibres(base, radius=0.62, resolution=160),
        {"distance": 0.62, "rotation": slanted},
    ),
    "3-sphere, cut": (
        manifolds.sphere3(radius=1.0, resolution=32),
        {"hyperplane": ((0.2, 0, 0.5, 1), 0.3)},
    ),
}


def coloured(lit):
    """Return a shape in the colours of its fourth coordinate, times its light."""
    return vizlight.tint(lit, np.asarray(lit["position"])[:, 3], cmap="RdYlBu_r")


plotter = render.make_plotter(
    [
        render.Panel(coloured(vizlight.manifold(shape, scene=scene, **options)), "rgb", title)
        for title, (shape, options) in shapes.items()
    ],
    camera=camera,
    size=(2000, 420),
    background="#203048",
    line_width=0.75,
)
plotter.show()
