"""
Which way does the field run?
=============================

The winds of July in six ways, with the median error with which the direction is read at a place;
45 degrees is chance. Arrows, line integral convolution (LIC) and lines are read by a machine that
follows strokes, the lights by their keys: the study *strokes* measures all six. LIC and evenly
spaced lines are read better than the light of ``presets.direction``, in which every place reads on
its own, also where no line runs; white light has no key to the direction. Both together are in the
example *The winds of July*.
"""

import pyvista as pv
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

from vizlight import Scene, load_example, presets, render, streamlines

wind, field = load_example("winds_of_july.vtp"), {"tangents": "wind", "exponent": 2}
# Strokes at the limb are crowded.
limb = {"normal": (0.42, 1, 0.1), "origin": (0.15, 0.36, 0.036), "invert": False}
evenly = {"orient": "wind", "scale": False, "factor": 0.09, "tolerance": 0.045}
bold = pv.Arrow(tip_length=0.4, tip_radius=0.16, shaft_radius=0.05)
arrows = wind.glyph(geom=bold, **evenly).clip(**limb)
lines = streamlines(wind, tangents="wind", spacing=0.06).scale(1.01).clip(**limb)
lic = vtkSurfaceLICMapper(input_data_object=wind, scalar_visibility=False)
lic = pv.Actor(mapper=lic, prop=pv.Property(ambient=0.6))
hues, black = presets.direction(), {"color": "black", "line_width": 3}

sheet = {"shape": (2, 4), "col_weights": (1, 1, 1, 0.4), "groups": [((0, 1), 3)]}
# A white ring around each ball, as VTK draws the edge of LIC in steps.
ring = pv.Disc(inner=0.995, outer=1.3, normal=limb["normal"], c_res=300)
ring = ring.translate(limb["normal"])
plotter = pv.Plotter(off_screen=True, window_size=(1800, 1200), border=False, **sheet)
ways = {
    "shading alone\nmedian error 42": lambda: None,
    "arrows\nmedian error 18": lambda: plotter.add_mesh(arrows, **black),
    "line integral convolution\nmedian error 3.4": lambda: plotter.add_actor(lic),
    "evenly spaced lines\nmedian error 2.6": lambda: plotter.add_mesh(lines, **black),
    "white light\nmedian error 45": lambda: plotter.vizlight.add_mesh(wind, scene=Scene(), **field),
    "hues of the direction\nmedian error 4.5": lambda: plotter.vizlight.add_mesh(
        wind, scene=hues, **field
    ),
}
for number, (title, draw) in enumerate(ways.items()):
    plotter.subplot(*divmod(number, 3))
    plotter.add_mesh(wind.scale(0.995), color="lightsteelblue", smooth_shading=True)
    draw()
    plotter.add_mesh(ring, color="white", lighting=False)
    text = plotter.add_text(f"{title}°", position="upper_edge", color="black", font_size=13)
    text.GetTextProperty().SetLineOffset(10)
    text.GetTextProperty().SetLineSpacing(1.2)
    plotter.camera = render.camera_on(wind, limb["normal"], aspect=1, zoom=0.83, parallel=True)
    plotter.camera.SetWindowCenter(0, 0.08)
plotter.subplot(0, 3)
plotter.vizlight.add_key("direction", exponent=2)
plotter.show()
