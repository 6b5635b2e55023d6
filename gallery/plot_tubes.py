"""
Lit lines beside tubes
======================

The same streamlines over the rotating disk drawn in three ways. Left: in one colour, as a tracer
returns them. Middle: as lines, lit as thin cylinders. Right: as tubes with 20 sides under the same
light, both coloured by temperature. At this width the last two look almost the same, but the lines
need a twentieth of the points. Use tubes for lines that must be wider or hide one another.

The study ``tubes`` measures the errors and the times to build and to draw.
"""

import numpy as np

import vizlight
from vizlight import Light, Material, Scene, View, render

flow = vizlight.load_example()
camera = render.camera_on(flow.bounds, (1, 0.35, 0.1), aspect=0.62, zoom=1.08)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.7)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=1.1, specular=0.5, shininess=15),
)
lines = vizlight.streamlines(flow, scene, vectors="V", seeds=45, model="cylinder")

flat = lines.copy()
flat["rgb"] = np.full((flat.n_points, 3), 0.6)
bare = lines.copy()
bare.clear_data()
bare["Temp"] = lines["Temp"]
tubes = vizlight.illuminate(bare.tube(radius=0.035, n_sides=20), scene)
print(f"lines: {lines.n_points} points, {lines.actual_memory_size} kB")
print(f"tubes: {tubes.n_points} points, {tubes.actual_memory_size} kB")


def coloured(mesh):
    """Return the mesh in the colours of its temperature, times its light."""
    return vizlight.tint(mesh, "Temp", cmap="plasma")


plotter = render.make_plotter(
    [
        render.Panel(flat, "rgb", "one colour"),
        render.Panel(coloured(lines), "rgb", f"lit lines: {lines.n_points} points"),
        render.Panel(coloured(tubes), "rgb", f"tubes: {tubes.n_points} points"),
    ],
    camera=camera,
    size=(1800, 900),
    background="black",
    line_diameter=0.07,
    render_lines_as_tubes=True,
)
plotter.show()
