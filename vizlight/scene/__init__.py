"""Scenes: the lights, the material, the view and the depth cue of a picture, as plain values.

Directions point away from the lit point: toward the light, toward the eye.
"""

from vizlight.scene.light import Light
from vizlight.scene.material import Material
from vizlight.scene.scene import Scene
from vizlight.scene.view import DepthCue, View

__all__ = ["DepthCue", "Light", "Material", "Scene", "View"]
