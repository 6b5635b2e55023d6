"""The mathematics of light on arrays: NumPy and SciPy only, no mesh, no file.

Conventions: the last axis is the component axis; directions are ``(..., n)``, tangent frames
``(..., k, n)`` with orthonormal rows, results ``(...)``; ``wi`` points from the point toward
the light and ``wo`` toward the eye. A batch equals a loop over its elements up to
rounding.
"""
