"""
A flow over an isosurface
=========================

The isosurface Temp = 600 of the gas over a heated, rotating disk, lit by the velocity on it, under
the clamped light of the surface itself. See the swirl: the bright streak lies where the mirror
cone of the flow meets the eye, and turns with it around the axis; a surface's own light shows none
of it.
"""

import vizlight
from vizlight import Light, Material, Scene, View, render

surface = vizlight.load_example().contour([600], scalars="Temp")
surface = surface.compute_normals(cell_normals=False, auto_orient_normals=True)
# Each triangle in 16: a highlight is narrower than the triangles of the simulation.
surface = surface.subdivide(2, "linear")

camera = render.camera_on(surface.bounds, (1, 0.5, 0.45), zoom=1.65)
scene = Scene(
    lights=Light(direction=(1, 0.9, 0.5)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.5, specular=0.4, shininess=20),
)
lit = vizlight.illuminate(surface, scene, tangents="V", conditioned=True)

# %%
# ``luminance`` is a point array like any other, so the highlight can be asked where it is.

bright = lit.threshold(0.6, scalars="luminance")
print(f"{bright.n_points} of {lit.n_points} points are brighter than 0.6;")
print(f"their mean temperature is {bright['Temp'].mean():.0f}")

plotter = render.make_plotter(lit, camera=camera, size=(1000, 700))
plotter.show()
