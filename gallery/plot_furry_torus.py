"""
A furry torus
=============

Illustration 3 of Banks, *Illumination in Diverse Codimensions*, with its numbers: a torus with the
radii 1.5 and 0.75 and 2,408,448 segments, seen around the edge of its shadow. A: fibres lit as
lines. B: with the self-shadow of the torus. C: dimmed by the fur above them too, so that single
fibres stand out. The density of the paper, 0.02, has no unit;
here it is that of each of 34 layers of the fur, which together absorb half of the light.
"""

import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

torus = pv.ParametricTorus(1.5, 0.75, u_res=128, v_res=128, w_res=128)
torus = torus.compute_normals(split_vertices=False, auto_orient_normals=True)
camera = render.camera_on((0.5, 2.2, -2.0, -0.3, -0.5, 1.1), (0.3, -1, 0.8), aspect=0.75, zoom=1.5)
scene = Scene(
    lights=Light(direction=(-1, -0.6, 0.9)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.9, specular=0.1, color=(1.0, 0.8, 0.5)),
)
panels = []
for title, options in {
    "A": {"conditioned": False, "absorption": 0},
    "B": {"absorption": 0},
    "C": {"absorption": 1 - (1 - 0.02) ** 34},
}.items():
    coat = vizlight.fur(
        torus, scene, fibres=802_816, segments=3, length=0.25, curl=0.15, exponent=1, **options
    )
    panels.append(render.Panel(coat, "rgb", title))
look = {"size": (1320, 600), "background": "#1b252e", "line_width": 1}
plotter = render.make_plotter(panels, camera=camera, **look)
plotter.show()
