"""Stated bounds of the terms, in float32 and float64."""

import math


def weight(plan, coefficient):
    """Return a coefficient times the intensities of all lights."""
    return float(coefficient * sum(light.intensity for light in plan.scene.lights))


def diffuse_bound(p, eps):
    """Return the absolute error of :func:`vizlight.model.reflection.diffuse`."""
    if p < 1:
        return float((8 * eps) ** p)
    return (4 + 2 * p if p <= 128 else 8 + math.sqrt(p)) * eps


def specular_bound(s, eps):
    """Return the absolute error of :func:`vizlight.model.reflection.specular`, |wi + wo| >= 1."""
    if s < 1:
        return float((8 * eps) ** s)
    return (4 + s if s <= 128 else 8 + 3 * math.sqrt(s)) * eps
