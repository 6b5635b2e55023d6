"""
Streamlines and fibres
======================

Lines lit by their own tangents. Left: streamlines of the flow over a rotating disk. Middle: the
same flow confined to an isosurface, conditioned by its normals, so that the far side is dark.
Right: a bundle of fibres of a brain; its shape can be seen without tubes.
"""

import vizlight
from vizlight import Light, Scene, View, render

flow = vizlight.load_example()
camera = render.camera_on(flow.bounds, (1, 0.5, 0.3))
scene = Scene(lights=Light(direction=(1, 0.9, 0.5)), view=View.from_camera(camera))
free = vizlight.streamlines(flow, scene, vectors="V", seeds=250)
isosurface = flow.contour([400], scalars="Temp")
confined = vizlight.streamlines(
    flow, scene, vectors="V", surface=isosurface, confined=True, seeds=300, max_length=20
)
bundle = vizlight.load_example("fibre_bundle.vtp")
near = render.camera_on(bundle.bounds, (0.3, -1, 0.4), zoom=1.2)
fibres = vizlight.illuminate(
    bundle, Scene(lights=Light(direction=(-0.5, -1, 1)), view=View.from_camera(near))
)

plotter = render.make_plotter(
    [free, confined, fibres], camera=camera, size=(1650, 560), line_width=2
)
plotter.subplot(0, 2)
plotter.camera = near
plotter.reset_camera_clipping_range()
plotter.show()
