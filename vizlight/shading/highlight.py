"""How the highlight of each light is computed: by the model asked for, or a cheaper one near it.

The half vector is the same at all points where light and eye are at infinity. Blinn's model then
needs only the tangents of a point: no split of the eye, no reflection.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from vizlight.model import highlights, kernels
from vizlight.model.extremes import PEAK
from vizlight.model.kernels import DEFICIT_FROM
from vizlight.shading.plan import Highlight

if TYPE_CHECKING:
    from collections.abc import Callable

    from vizlight._types import Vector
    from vizlight.scene import Scene
    from vizlight.shading.options import Model

#: Least power at which |h_N|^q may be computed from the tangential part alone: a lower one is too
#: steep at 0.
LEAST_POWER = 2.0
#: Least power of Phong's model for which a factor is searched.
LEAST_SHININESS = 0.5


def choose(
    scene: Scene,
    model: Model,
    allowed: float,
    rounding: Callable[[float], float] = lambda _: 0.0,
) -> tuple[Highlight, ...]:
    """Return a highlight for each light; Blinn's for Phong's while errors add up to ``allowed``.

    ``rounding`` gives the error of a computed highlight by its power. Default: none, for a caller
    that counts it.

    Notes
    -----
    The power is the best of several near :func:`vizlight.model.highlights.simple_factor`. The
    bound is :func:`~vizlight.model.highlights.max_pixel_error`, which holds in every codimension.
    Lights with small errors come first.
    """
    material = scene.material
    asked = Highlight(model, material.shininess)
    chosen = [asked] * len(scene.lights)
    halves = [_half(scene, i) for i in range(len(scene.lights))]
    if model == "blinn" and material.shininess >= LEAST_POWER:
        return tuple(asked if half is None else asked._replace(half=half[0]) for half in halves)
    if model != "phong" or allowed == 0 or material.shininess < LEAST_SHININESS:
        return tuple(chosen)
    offers = []
    for i, half in enumerate(halves):
        if half is None:
            continue
        vector, angle = half
        power, worst = _nearest(angle, material.shininess)
        # The highlight that was asked for is rounded as well.
        worst += PEAK * (rounding(material.shininess) + rounding(power))
        error = worst * material.specular * scene.lights[i].intensity
        if power >= LEAST_POWER:
            offers.append((error, i, Highlight("blinn", power, vector, error)))
    left = allowed
    for error, i, offer in sorted(offers, key=lambda offer: offer[:2]):
        if error <= left:
            left -= error
            chosen[i] = offer
        else:
            chosen[i] = asked._replace(rejected=error)
    return tuple(chosen)


@lru_cache(maxsize=64)
def _nearest(angle: float, shininess: float) -> tuple[float, float]:
    """Return Blinn's power for Phong's shininess, and the largest error, of 255.

    Up to 128 only even powers are tried, which are computed by multiplication. This hardly changes
    the error, which is exact for the chosen power.
    """
    power = float(highlights.simple_factor(angle)) * shininess
    # The excess of the best factor over the simple one is nearly inverse to the shininess.
    tried = power * (1 + np.linspace(0, 0.4, 9) / shininess)
    if power <= 2 * DEFICIT_FROM:
        tried = 2 * np.round(tried / 2)
    tried = tried[tried >= LEAST_POWER]
    if not tried.size:
        return 0.0, 0.0
    factors = tried / shininess
    errors = np.abs(highlights.max_pixel_error(angle, shininess, factor=factors).error)
    best = int(np.argmin(errors))
    return float(tried[best]), float(errors[best])


def _half(scene: Scene, index: int) -> tuple[Vector, float] | None:
    """Return the half vector that all points share, and the angle from light to eye; or None."""
    light, view = scene.lights[index], scene.view
    if view is None or not view.parallel or light.direction is None or view.direction is None:
        return None
    columns = np.array([light.direction, view.direction], dtype=np.float64).T
    unit, _ = kernels.unit(columns)
    both, apart = unit[:, 0] + unit[:, 1], unit[:, 0] - unit[:, 1]
    size = float(np.linalg.norm(both))
    # Of nearly opposite directions the half vector is mere rounding.
    if size < 1e-6:
        return None
    return tuple((both / size).tolist()), 2 * float(np.arctan2(np.linalg.norm(apart), size))
