"""vizlight: lines rendered as tubes."""

import pyvista as pv

from vizlight import Light, Material, Scene

lines = pv.read("lines.vtp")
scene = Scene(
    lights=Light(direction=(1, -0.6, 0.9)),
    material=Material(ambient=0.2, diffuse=1, specular=0.4, shininess=25),
)
plotter = pv.Plotter()
plotter.vizlight.add_mesh(
    lines, scene=scene, scalars="Temp", cmap="coolwarm", line_diameter=0.05,
    render_lines_as_tubes=True, show_scalar_bar=False,
)  # fmt: skip
