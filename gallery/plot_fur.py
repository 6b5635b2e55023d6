"""
The fur of a dog
================

A dog with 400,000 hairs. Each hair is lit as a thin line, inherits the shadow of the skin it
stands on, and is attenuated by the fur above it, on the way in and out: so it is darker at its
base, and single hairs stand out. Its length and the direction in which it lies are point arrays of
the skin.

Below are the three panels of illustration 3 of Banks, *Illumination in Diverse Codimensions*, with
its coefficients, on a torus of radii 1.5 and 0.75. A: the fibres alone are lit. B: the light is
conditioned by the normals of the torus. C: it is also attenuated by the fur.
"""

# sphinx_gallery_thumbnail_number = 1
import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene, View, render

dog = vizlight.load_example("dog.vtp").compute_normals(split_vertices=False)
x, y, z = np.asarray(dog.points).T
length = np.interp(x, [-0.7, -0.4, -0.2, 0.15, 0.3, 0.46], [0.05, 0.035, 0.022, 0.034, 0.02, 0.004])
dog["length"] = length * np.interp(
    z, [0.0, 0.05, 0.3, 0.45, 0.68, 0.78], [0.1, 0.3, 0.4, 1, 1, 0.4]
)
# Hair lies back, and down along the legs.
dog["lie"] = np.stack([-1.0 + 0 * x, 0.2 * np.sign(y), -0.6 + 0 * x], axis=1)
camera = render.camera_on((0.02, 0.5, -0.1, 0.1, 0.42, 0.8), (1, -1, 0.25), aspect=1.5, zoom=1.5)
scene = Scene(
    lights=[Light(direction=(1.1, -0.6, 1.2)), Light(direction=(-0.8, 0.8, 0.6), intensity=0.8)],
    view=View.from_camera(camera),
    material=Material(
        ambient=0.25, diffuse=1.15, specular=0.3, shininess=14, color=(0.93, 0.62, 0.30)
    ),
)
coat = vizlight.fur(
    dog, scene, fibres=400_000, length="length", segments=5, toward="lie", bend=0.92,
    curl=0.1, turns=0.5, absorption=0.6,
)  # fmt: skip
plotter = render.make_plotter(
    render.Panel(coat, "rgb"), camera=camera, size=(1500, 1000), background="#26303a",
    line_width=0.8,
)  # fmt: skip
plotter.show()

# %%
# All panels use the plain cosine law of the paper (``exponent=1``), and 0.9 of the
# luminance: in A the fibres that face the light would be brighter than white. Fur of density 0.02
# per unit of the torus would hardly be visible at a length of 0.3, so lengths are counted in
# hundredths here.

torus = pv.ParametricTorus(ringradius=1.5, crosssectionradius=0.75, u_res=128, v_res=128)
camera = render.camera_on(torus.bounds, (0.3, -1, 0.8), zoom=1.12)
scene = Scene(
    lights=Light(direction=(-1, -0.6, 0.9)),
    view=View.from_camera(camera),
    material=Material(ambient=0.1, diffuse=0.9, specular=0.1),
)
hair = {"fibres": 401_408, "length": 0.3, "segments": 6, "toward": (0, 0, -1), "bend": 0.8}
hair |= {"exponent": 1, "absorption": 0}
dense = {"absorption": None, "density": 1 - (1 - 0.02) ** 100}
coats = {
    "A: fibres alone": vizlight.fur(torus, scene, conditioned=False, **hair),
    "B: and the normals": vizlight.fur(torus, scene, **hair),
    "C: and the way through the fur": vizlight.fur(torus, scene, **hair | dense),
}
plotter = render.make_plotter(
    [render.Panel(coat, title=title) for title, coat in coats.items()],
    camera=camera, size=(1650, 560), background="#5a6570", line_width=0.45, clim=(0, 1.1),
)  # fmt: skip
plotter.show()
