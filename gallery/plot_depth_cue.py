"""
Depth cue
=========

Streamlines over a heated, rotating disk, coloured by temperature: without a depth cue on the left,
then fading with depth by ``S I + (1 - S) Icue``, where the scale S falls from 1 at the front to 0
at the back. With the cue it is clear which lines pass in front of which; without it, near and far
lines look alike. The smooth step on the right changes less near the front and near the back than
the linear ramp in the middle.
"""

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, render

flow = vizlight.load_example()
camera = render.camera_on(flow.bounds, (1, 0.5, 0.55), aspect=0.62, zoom=1.12)
cues = {
    "none": None,
    "linear": DepthCue(back_scale=0.0),
    "smooth": DepthCue(back_scale=0.0, smooth=True),
}
panels = []
for title, cue in cues.items():
    scene = Scene(
        lights=Light(direction=(1, 0.9, 0.5)),
        view=View.from_camera(camera),
        material=Material(ambient=0.1, diffuse=1.1, specular=0.5),
        depth_cue=cue,
    )
    lines = vizlight.streamlines(flow, scene, vectors="V", seeds=90, max_length=25)
    panels.append(render.Panel(vizlight.tint(lines, "Temp", cmap="plasma"), "rgb", title))

plotter = render.make_plotter(
    panels, camera=camera, size=(1500, 820), background="black", line_diameter=0.09
)
plotter.show()
