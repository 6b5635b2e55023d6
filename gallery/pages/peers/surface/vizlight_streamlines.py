"""vizlight: evenly spaced streamlines on the surface."""

import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View

surface = pv.read("surface.vtp")
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.5)),
    view=View(direction=(1, 0.5, 0.45)),
    material=Material(ambient=0.3, diffuse=1, specular=0.5, shininess=20),
)
lines = vizlight.streamlines(
    surface, scene, tangents="V", surface=surface, spacing=0.15, conditioned=True, components=True
)
lines = vizlight.tint(lines, "speed", cmap="coolwarm")
plotter = pv.Plotter()
plotter.add_mesh(lines, scalars="rgb", rgb=True, lighting=False, line_width=7)
below = surface.warp_by_vector("Normals", factor=-0.02)
plotter.add_mesh(below, color="#303030", lighting=False)
