"""Shapes as arrays: NumPy and SciPy only, no mesh, no file."""
