"""Cos-theta shadows of height fields, the sun that casts them, and depth maps."""

from vizlight.geometry.relief.shadowing import inside_length, shadow

__all__ = ["inside_length", "shadow"]
