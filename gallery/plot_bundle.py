"""
Light inside a bundle
=====================

Lines that are lit one by one are as bright deep inside a bundle as on its rim: the bundle is flat,
and where many lines face the light it is a blot. With ``bundle=True`` the lines are a medium of
thin cylinders that dims the light on its way, and the ambient light of points that are closed in:
front and back, and single strands, can be told apart.
"""

import vizlight
from vizlight import Light, Material, Scene, View, render

tract = vizlight.load_example("fibre_bundle.vtp")
camera = render.camera_on(tract, (0.3, -1, 0.4), aspect=1.5)
scene = Scene(
    lights=Light(direction=(-0.5, -0.6, 1)),
    view=View.from_camera(camera),
    material=Material(ambient=0.25, diffuse=0.8, specular=0.5, shininess=30),
)
alone = vizlight.illuminate(tract, scene)
bundle = vizlight.illuminate(tract, scene, bundle=True)
panels = [render.Panel(alone, title="each line alone"), render.Panel(bundle, title="as a bundle")]

plotter = render.make_plotter(panels, camera=camera, size=(1500, 500), line_width=1.5)
plotter.show()

# %%
# On white paper what was white is lost, and what is dimmed stays.

plotter = render.make_plotter(
    panels, camera=camera, size=(1500, 500), line_width=1.5, background="white"
)
plotter.show()

# %%
# The shares of light are point arrays: ``transmittance`` for each light and ``occlusion`` for light
# from all sides, here on their own. They are computed again only where lines or lights have
# changed, not where the eye has moved.

plotter = render.make_plotter(
    [
        render.Panel(bundle, scalars="transmittance", title="transmittance"),
        render.Panel(bundle, scalars="occlusion", title="occlusion"),
    ],
    camera=camera,
    size=(1500, 500),
    line_width=1.5,
)
plotter.show()
