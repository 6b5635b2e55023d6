"""Light that tests name where the default of a scene is not what they are about."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyvista as pv

from vizlight import Light, Material, Scene, View


def shiny(**changes: Any) -> Material:
    """Return a material with every term, but for what is given."""
    return Material(**({"ambient": 0.1, "diffuse": 0.5, "specular": 0.4} | changes))


#: Direction of the default lamp over the shoulder in PyVista's isometric view, in which
#: (-1, 1, 0), (-1, -1, 2) and (1, 1, 1) point to the right, up and toward the eye.
SHOULDER = (
    -0.405580 * np.array((-1, 1, 0)) / 2**0.5
    + 0.579228 * np.array((-1, -1, 2)) / 6**0.5
    + 0.707107 * np.array((1, 1, 1)) / 3**0.5
)
#: The lamps of the default scene there.
DEFAULT = [
    Light(direction=SHOULDER, intensity=8 / 11), Light(direction=(1, 1, 1), intensity=3 / 11)
]  # fmt: skip
#: A material with every term, and one lamp at the eye with it.
SHINY = shiny()
HEADLIT = {"lights": Light.headlight(), "material": SHINY}
#: A coloured lamp whose light falls off.
NEAR = Light(position=(3, 4, 5), intensity=0.5, attenuation=(0.5, 0.1, 0.01), color=(1, 0.8, 0.5))


def far(light: Any, eye: Any, material: Material = SHINY) -> Scene:
    """Return a scene with a lamp at infinity, and the eye there too or at a camera."""
    view = View.from_camera(eye) if isinstance(eye, pv.Camera) else View(direction=eye)
    return Scene(lights=Light(direction=light), view=view, material=material)
