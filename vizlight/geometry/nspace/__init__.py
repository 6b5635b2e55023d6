"""Shapes in n-space as arrays: manifolds with exact tangents, projections, cuts."""
