"""Light that tests name where the default of a scene is not what they are about."""

from __future__ import annotations

from vizlight import Light, Material

#: A material with every term, and one lamp at the eye with it.
SHINY = Material(ambient=0.1, diffuse=0.5, specular=0.4)
HEADLIT = {"lights": Light.headlight(), "material": SHINY}
