"""
Streamlines, free and on a surface
==================================

Streamlines of the flow over a rotating disk, each lit by its own tangents. On the right the same
flow is confined to an isosurface and conditioned by the surface normals. The left panel shows how
the gas falls, turns and leaves along the disk. In the right panel only the near side is bright, so
the dome has a front and a back although only lines are drawn.
"""

import vizlight
from vizlight import Light, Scene, View, render

flow = vizlight.load_example()
camera = render.camera_on(flow.bounds, (1, 0.5, 0.3), zoom=1.1)
scene = Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(camera))
free = vizlight.streamlines(flow, scene, vectors="V", seeds=250)

isosurface = flow.contour([400], scalars="Temp")
near = render.camera_on(isosurface.bounds, (1, 0.5, 0.3), zoom=1.4)
confined = vizlight.streamlines(
    flow,
    Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(near)),
    vectors="V",
    surface=isosurface,
    confined=True,
    seeds=300,
    max_length=20,
)

plotter = render.make_plotter(
    [render.Panel(free, title="free"), render.Panel(confined, title="on Temp = 400")],
    camera=camera,
    size=(1500, 760),
    line_width=1,
)
plotter.subplot(0, 1)
plotter.camera = near
plotter.reset_camera_clipping_range()
plotter.show()
