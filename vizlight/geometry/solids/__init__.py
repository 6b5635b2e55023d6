"""Spheres, truncuses and blocks, what combines them, and one closed mesh of the result."""

from vizlight.geometry.solids.tessellation import tessellate

__all__ = ["tessellate"]
