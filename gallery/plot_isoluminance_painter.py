"""
Laminae and bands
=================

The source fills plane polygons, the laminae, from the farthest to the nearest. Left: viewed from
the direction of the light this looks the same as bands. Middle: when the light is perpendicular to
the view, each lamina is seen edge-on, and gaps remain for any order of painting. Right: bands form
a closed surface, which is correct from any view.
"""

import numpy as np
import pyvista as pv

from vizlight import Light, Material, Scene, Sphere, isoluminance, render
from vizlight.geometry.contours.isoluminance import sphere

toward = np.array([1.0, 0, 0])
scene = Scene(lights=Light(direction=toward), material=Material(diffuse=0.9, specular=0))
bands = isoluminance(Sphere(), scene, levels=14)["bands"]
laminae = sphere(
    (0, 0, 0), 1, direction=toward, ambient=0.1, diffuse=0.9, levels=14, form="laminae"
)


def painted(eye):
    """Return the laminae in painter's order, from the farthest to the nearest."""
    order = laminae.order(eye)
    pieces = [np.arange(laminae.offsets[i], laminae.offsets[i + 1]) for i in order]
    faces = np.concatenate([np.insert(piece, 0, len(piece)) for piece in pieces])
    mesh = pv.PolyData(laminae.points, faces=faces)
    mesh.cell_data["luminance"] = laminae.values[order]
    return mesh


along, across = (0.94, -0.3, 0.15), (0.0, -1.0, 0.0)
cameras = [render.camera_on(bands.bounds, eye, zoom=1.3) for eye in (along, across, across)]
plotter = render.make_plotter(
    [
        render.Panel(painted(np.array(along)), title="laminae, from the light"),
        render.Panel(painted(np.array(across)), title="laminae, across"),
        render.Panel(bands, title="bands, across"),
    ],
    size=(1350, 450),
    cmap="cividis",
)
for column, camera in enumerate(cameras):
    plotter.subplot(0, column)
    plotter.camera = camera
    plotter.reset_camera_clipping_range()
plotter.show()
