"""The optics as functions of arrays; only NumPy and SciPy are used, no mesh and no file.

Conventions: the last axis is the component axis. Directions have shape ``(..., n)``, tangent
frames shape ``(..., k, n)`` with orthonormal rows, and results shape ``(...)``. ``wi`` points from
the point toward the light, ``wo`` from the point toward the eye. The result for a batch equals
the results for its elements, up to rounding.
"""
