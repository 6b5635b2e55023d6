"""Cos-theta shadows of height fields, directions toward the sun, and depth maps."""

from vizlight.geometry.relief.shadowing import inside_length, shadow

__all__ = ["inside_length", "shadow"]
