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
#: A material with every term, and one lamp at the eye with it.
SHINY = shiny()
HEADLIT = {"lights": Light.headlight(), "material": SHINY}


#: The lamps of a plotter, as an eye along (1, 1, 1) has them.
KIT = (
    Light(direction=SHOULDER, intensity=8 / 11), Light(direction=(1, 1, 1), intensity=3 / 11)
)  # fmt: skip


def far(light: Any, eye: Any, material: Material = SHINY) -> Scene:
    """Return a scene with a lamp at infinity, and the eye there too or at a camera."""
    view = View.from_camera(eye) if isinstance(eye, pv.Camera) else View(direction=eye)
    return Scene(lights=Light(direction=light), view=view, material=material)
