"""Spheres, frusta and blocks, Boolean combinations of them, and their closed meshes."""

from vizlight.geometry.solids.tessellation import tessellate, volume_bounds

__all__ = ["tessellate", "volume_bounds"]
