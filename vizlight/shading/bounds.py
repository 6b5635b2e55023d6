"""What rounding can change: bounds of a plan's luminance, in float32 and float64."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight.scene.light import NO_ATTENUATION

if TYPE_CHECKING:
    from vizlight.scene import Light, View
    from vizlight.shading.plan import Plan


def weight(plan: Plan, coefficient: float) -> float:
    """Return a coefficient times the intensities of all lights."""
    return float(coefficient * sum(light.intensity for light in plan.scene.lights))


def rounding(plan: Plan) -> float:
    """Return a bound of the effect of rounding on the luminance; infinity where none holds.

    Notes
    -----
    It uses the bounds of :mod:`vizlight.model.reflection`, with 8 eps more for each factor of the
    scene, and 4 eps of the brightest light and of the cue for a depth cue. No bound holds for k
    tangents near each other, near opposite directions under Blinn's model, near the line of a
    cylinder, and for t and fur, whose rounding is that of the data.
    """
    eps = float(np.finfo(plan.dtype).eps)
    scene, material = plan.scene, plan.scene.material
    faded = 0.0
    if scene.depth_cue is not None:
        brightest = plan.ambient + weight(plan, material.diffuse + material.specular)
        faded = 4 * eps * (scene.depth_cue.cue + brightest)
    if not (plan.diffuse or plan.specular):
        return 4 * eps * plan.ambient + faded
    if plan.model == "cylinder" or plan.shadowed or plan.fur or plan.base:
        return math.inf
    if not plan.surface and plan.k > 1:
        return math.inf
    factors = 8.0 * (
        1 + plan.conditioned + any(x.attenuation != NO_ATTENUATION for x in scene.lights)
    )
    total = faded + 4 * eps * (plan.ambient + weight(plan, material.diffuse + material.specular))
    if plan.factors != (1.0, 1.0):
        # The mean brightness I of a line has an error of 9 (1 + |ln I|) eps, largest at I = 1.
        total += 10 * eps * weight(plan, material.diffuse + material.specular)
    if plan.diffuse:
        term = diffuse_bound(plan.exponent, eps) + factors * eps
        total += plan.factors[0] * term * weight(plan, material.diffuse)
    if plan.specular:
        if plan.options.terminator:
            factors += 6 / plan.options.terminator
        for light, highlight in zip(scene.lights, plan.highlights, strict=True):
            own = highlight.model == "blinn" and highlight.half is None
            if own and angle(light, scene.view) != 0:
                # |wi + wo| may be as small as its rounding, except for a headlight.
                return math.inf
            term = specular_bound(highlight.shininess, eps) + factors * eps
            total += plan.factors[1] * term * material.specular * light.intensity
    return total


def diffuse_bound(p: float, eps: float) -> float:
    """Return the absolute error of :func:`vizlight.model.reflection.diffuse`."""
    if p < 1:
        return float((8 * eps) ** p)
    return (4 + 2 * p if p <= 128 else 8 + math.sqrt(p)) * eps


def specular_bound(s: float, eps: float) -> float:
    """Return the absolute error of :func:`vizlight.model.reflection.specular`, |wi + wo| >= 1."""
    if s < 1:
        return float((8 * eps) ** s)
    return (4 + s if s <= 128 else 8 + 3 * math.sqrt(s)) * eps


def angle(light: Light, view: View | None) -> float | None:
    """Return the angle from light to eye if all points share it, else None; 0 for a headlight."""
    if view is None:
        return None
    if light.position is not None:
        same = not view.parallel and light.position == view.position
        return 0.0 if same else None
    if not view.parallel or light.direction is None or view.direction is None:
        return None
    a, b = (np.array(v) / np.linalg.norm(v) for v in (light.direction, view.direction))
    return 2 * math.atan2(float(np.linalg.norm(a - b)), float(np.linalg.norm(a + b)))
