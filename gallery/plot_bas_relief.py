"""
A bas-relief under one light
============================

The depth map of a figure, flattened onto a plate and lit by one nearby light. Upper row: the light
moves from left to right, the depth stays. Lower row: the light stays, and the depth of the shadow
grows from left to right, which lets more light through, as in the figures of the source on
cos-theta shadows. The single number t contains the direct light, the shadow on the plate and the
light that passes through thin parts.
"""

import vizlight
from vizlight import Light, Material, Scene, render

dog = vizlight.load_example("dog.vtp")
relief = vizlight.bas_relief(
    dog, direction=(0.2, -1, 0.12), up=(0, 0, 1), resolution=700, height=0.06, margin=0.1
)
panels = []
for x, depth in (
    (-0.8, 0.01), (0.0, 0.01), (0.8, 0.01),
    (-0.8, 0.003), (-0.8, 0.02), (-0.8, 0.06),
):  # fmt: skip
    scene = Scene(
        lights=Light(position=(x, 0.7, 0.55)),
        material=Material(ambient=0.03, diffuse=1.1, specular=0.0, color=(1.0, 0.87, 0.7)),
    )
    lit = vizlight.relief_shadow(relief, scene, depth=depth, lit=True)
    panels.append(render.Panel(lit, "rgb", f"light at x = {x}, depth {depth}"))

plotter = render.make_plotter(
    panels,
    camera=render.camera_on(relief.bounds, (0, 0, 1), parallel=True, aspect=1.25, zoom=1.36),
    rows=2,
    size=(1800, 1000),
    background="black",
)
plotter.show()
