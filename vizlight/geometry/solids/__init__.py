"""Spheres, frusta and blocks, Boolean combinations of them, and their closed meshes."""

from vizlight.geometry.solids.tessellation import tessellate

__all__ = ["tessellate"]
