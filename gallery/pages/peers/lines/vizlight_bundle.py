"""vizlight: lines that dim one another."""

import pyvista as pv

from vizlight import Bundle, Light, Material, Scene

lines = pv.read("lines.vtp")
scene = Scene(
    lights=Light(direction=(1, -0.6, 0.9)),
    material=Material(ambient=0.5, diffuse=1, specular=0.4, shininess=25),
)
plotter = pv.Plotter()
plotter.vizlight.add_mesh(
    lines, scene=scene, model="cylinder", bundle=Bundle(depth=1.2), scalars="Temp",
    cmap="coolwarm", line_width=4, show_scalar_bar=False,
)  # fmt: skip
