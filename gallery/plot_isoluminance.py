"""
Contours of equal luminance on solids
=====================================

The primitives of Conway and Cottingham, *The Isoluminance Contour Model*, in bands of constant
luminance between contours: circles about the direction of the light on the sphere, rulings on the
others. The source leaves set operations, as in the machined part, as an open problem, and
approximates a highlight and a nearby light; here their contours are found by bisection.
"""

import numpy as np

import vizlight
from vizlight import Block, Frustum, Light, Material, Scene, Sphere, View, render

far = Light(direction=(0.8, -1, 1.1))
dull = Scene(lights=far, material=Material(ambient=0.1, diffuse=0.9, specular=0))
camera = render.camera_on((-1, 1, -1, 1, -1, 1), (0.5, -1, 0.6), zoom=1.36)
shiny = Scene(
    lights=far,
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.5, specular=0.4),
)
near = dull.replace(lights=Light(position=(0.9, -1.1, 0.5)))

flange = Frustum((0, 0, -0.5), (0, 0, 0.35), (1, 1))
neck = Frustum((0, 0, 0), (0, 0, 0.9), (0.4, 0.55))
part = (flange | neck) - Frustum((0, 0, 0), (0, 0, 3), (0.25, 0.25))
part = part - Block((0, 0, 0.5), (2, 0.2, 0.3))
for angle in np.arange(6) * np.pi / 3:
    place = (0.77 * np.cos(angle), 0.77 * np.sin(angle), -0.5)
    part = part - Frustum(place, (0, 0, 1), (0.11, 0.11))

shapes = {
    "sphere": (Sphere(), dull),
    "cylinder": (Frustum((0, 0, 0), (0, 0, 1.6), (0.6, 0.6)), dull),
    "cone": (Frustum((0, 0, 0), (0, 0, 1.6), (0, 0.8)), dull),
    "frustum": (Frustum((0, 0, 0), (0, 0, 1.2), (0.4, 0.9)), dull),
    "block": (Block(size=(1.2, 1.2, 1.2)), dull),
    "machined part": (part, dull),
    "sphere with a highlight": (Sphere(), shiny),
    "cylinder, lamp nearby": (Frustum((0, 0, 0), (0, 0, 1.6), (0.5, 0.5)), near),
}
drawn = [vizlight.isoluminance(solid, scene, levels=12) for solid, scene in shapes.values()]
plotter = render.make_plotter(
    [render.Panel(found["bands"], title=name) for name, found in zip(shapes, drawn, strict=True)],
    camera=camera,
    rows=2,
    size=(1900, 960),
    cmap="bone",
    bar="luminance",
    anti_aliasing="ssaa",
)
for number, ((solid, _), found) in enumerate(zip(shapes.values(), drawn, strict=True)):
    plotter.subplot(*divmod(number, 4))
    plotter.add_silhouette(
        vizlight.to_polydata(solid).clean(), color="black", feature_angle=35, line_width=4
    )
    if not found["contours"].n_points:
        continue  # each face of the block is one band
    lines = plotter.add_mesh(found["contours"], color="black", line_width=2.5)
    # The lines lie in the bands: shift them slightly toward the viewer.
    lines.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    lines.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-4, -4)
plotter.show()
