"""The cheapest evaluation of a plan whose stated bound is within a tolerance.

Tried in the order of what they save: under headlights, the models of which a cylinder's light is a
multiple; float32 for float64; Blinn's model for Phong's where there is one half vector; whole
powers. Only what was measured to save time is tried. Compiled code is limited by memory, so that
nothing but the first of these saves any; float32 saves none of NumPy's time without a highlight.
"""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _check, _compiled
from vizlight.model import brightness, kernels
from vizlight.shading import bounds
from vizlight.shading.highlight import choose
from vizlight.shading.plan import Choice

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight.shading.plan import Plan


def relax(plan: Plan, tolerance: float, *, asked: bool) -> Plan:
    """Return the plan with cheaper evaluations that are together within the tolerance.

    Parameters
    ----------
    plan : Plan
        Plan of the exact forms.
    tolerance : float
        Tolerance of the luminance, above 0.
    asked : bool
        Whether the precision was asked for. Else float32 may replace float64; float64, which takes
        longer, replaces float32 where the bound of its rounding exceeds the tolerance.

    Raises
    ------
    ValueError
        If float32 is asked for and its rounding is not within the tolerance.
    """
    if plan.dtype == np.float32 and not asked and tolerance < bounds.rounding(plan) < math.inf:
        plan = dataclasses.replace(plan, dtype=np.dtype(np.float64))
    exact = plan
    # By default few points are lit by compiled code, and many cost next to nothing either way.
    compiled = _compiled.active() and _compiled.wanted() == "1"
    notes: list[str] = []
    rejected: list[str] = []
    spent = 0.0

    def offer(error: float, made: Plan, words: str, *, low: bool = False) -> None:
        nonlocal plan, spent
        rounds = bounds.rounding(made)
        if spent + error + (rounds if low else _finite(rounds)) <= tolerance:
            plan, spent = made, spent + error
            notes.append(f"{words}, within {rounds if low else error:.3g}")
        else:
            most = rounds if low else error
            finite = math.isfinite(most)
            why = (
                f"it would differ by up to {most:.3g}" if finite else "no bound holds for all data"
            )
            rejected.append(f"{words}: {why}")

    if plan.model == "cylinder" and (plan.diffuse or plan.specular):
        offer(*_flat_line(plan))
    if plan.dtype == np.float64 and plan.specular and not (asked or compiled):
        single = dataclasses.replace(plan, dtype=np.dtype(np.float32))
        offer(0.0, single, "precision: float32", low=True)
    if plan.model == "phong" and plan.specular and not compiled:
        # Highlights that differ too much are named in the plan, light by light.
        left = 255 * max(tolerance - spent - _finite(bounds.rounding(plan)), 0)
        made = dataclasses.replace(plan, highlights=choose(plan.scene, "phong", left))
        if spent + made.highlight_error / 255 + _finite(bounds.rounding(made)) <= tolerance:
            plan, spent = made, spent + made.highlight_error / 255
    if plan.diffuse and _slow(plan.exponent) and not compiled:
        whole = float(max(round(plan.exponent), 1))
        error = kernels.power_error(plan.exponent, whole)
        error *= bounds.weight(plan, plan.scene.material.diffuse)
        made = dataclasses.replace(plan, exponent=whole)
        offer(error, made, f"diffuse: power {whole:g} for {plan.exponent:.6g}")
    if plan.specular and not compiled:
        _offer_whole_shininess(plan, offer)
    bound = spent + bounds.rounding(plan)
    if bound > tolerance:
        if asked and plan.dtype == np.float32:
            got = f"{tolerance:.3g} with precision='float32', whose rounding "
            got += f"may be {bound:.3g}" if math.isfinite(bound) else "has no bound here"
            remedy = "omit precision=, or pass 'float64'"
            raise ValueError(_check.message("tolerance", "more than rounding", got, remedy))
        bound = math.inf
    cheaper = plan is not exact and (bool(notes) or plan.highlight_error > 0)
    choice = Choice(tolerance, bound, tuple(notes), tuple(rejected), cheaper)
    return dataclasses.replace(plan, choice=choice)


def _finite(bound: float) -> float:
    return bound if math.isfinite(bound) else 0.0


def _offer_whole_shininess(plan: Plan, offer: Callable[[float, Plan, str], None]) -> None:
    """Offer whole powers for the highlights of the model that was asked for."""
    half = 2.0 if plan.model == "blinn" else 1.0
    shininess = plan.scene.material.shininess
    own = [h for h in plan.highlights if h.model == plan.model and not h.error]
    if plan.model == "cylinder" or not own or not _slow(shininess / half):
        return
    whole = half * max(round(shininess / half), 1)
    error = kernels.power_error(shininess, whole) * bounds.weight(
        plan, plan.scene.material.specular
    )
    highlights = tuple(h._replace(shininess=whole) if h in own else h for h in plan.highlights)
    made = dataclasses.replace(plan, highlights=highlights)
    offer(error, made, f"specular: power {whole:g} for {shininess:g}")


def _slow(power: float) -> bool:
    """Return whether a power is not computed by multiplication, but is near one that would be."""
    return power != int(power) and power <= kernels.DEFICIT_FROM


def _flat_line(plan: Plan) -> tuple[float, Plan, str]:
    """Return the error, the plan and the words of Banks' and Blinn's models for the line light.

    For a headlight the exact line light is a multiple of them. For an angle theta between light and
    eye Lambert's mean differs by at most ``pi/2 sin(theta/2)``, since the normal parts are within
    ``2 sin(theta/2)``; Blinn's, of power 1 or more, by ``3 pi/2 sin(theta/4)``, since the normal
    parts of half vector and eye are within ``2 sin(theta/4)`` and the mean changes by no more than
    the angles between them.
    """
    scene, material = plan.scene, plan.scene.material
    error, s = 0.0, material.shininess
    for light in scene.lights:
        theta = bounds.angle(light, scene.view)
        if theta is None or (theta > 0 and s < 1):
            error = math.inf
            break
        each = material.diffuse * math.pi / 2 * math.sin(theta / 2)
        each += material.specular * 1.5 * math.pi * math.sin(theta / 4)
        error += each * light.intensity
    # B(s/2 + 1, 1/2) / 2, in the closed form that keeps its digits for large s.
    factors = math.pi / 4, float(brightness.mean_intensity(1, 3, s))
    made = dataclasses.replace(
        plan,
        model="blinn",
        exponent=1.0,
        factors=factors,
        highlights=choose(scene, "blinn", 0.0),
    )
    words = f"cylinder: Banks' model times {factors[0]:.4g} and Blinn's times {factors[1]:.4g}"
    return error, made, words
