"""Error of highlights that are drawn by a virtual light, instead of the half vector."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from vizlight.geometry.contours.isoluminance import virtual_light
from vizlight.geometry.solids.exact_surfaces import fibonacci


@dataclass(frozen=True)
class Highlight:
    """Errors of the highlight of a virtual light on a sphere of radius 1."""

    distance: float
    angle: float
    half: float
    mirror: float
    shift: float


def highlight(distance: float, angle: float, power: float = 20.0) -> Highlight:
    """Return the errors of the highlight of a virtual light.

    Parameters
    ----------
    distance : float
        Distance of the light from the centre in radii, infinite for a light at infinity.
    angle : float
        Angle between light and eye in degrees, at the centre. The eye is at infinity.
    power : float, default: 20.0
        Power s of ``R . E``; the power of ``N . H`` is 4 times as large (Fisher-Woo).

    Returns
    -------
    Highlight
        ``half`` and ``mirror`` are the largest differences from ``(N . H)^(4 s)`` and
        ``(R . E)^s`` for the light at its position. ``shift`` is the angle in degrees by which
        the exact peak is displaced toward the light from the peak of the virtual light. The
        source states a displacement toward the eye, which is true for a near eye but not for a
        near light.
    """
    eye = np.array([0.0, 0.0, 1.0])
    light = np.array([math.sin(math.radians(angle)), 0.0, math.cos(math.radians(angle))])
    toward = virtual_light((0, 0, 0), light=light, eye=eye)
    normal = fibonacci(200_000)
    wi = np.broadcast_to(light, normal.shape)
    if math.isfinite(distance):
        wi = distance * light - normal
        wi = wi / np.linalg.norm(wi, axis=1, keepdims=True)
    cosine = np.einsum("ij,ij->i", normal, wi)
    seen = (cosine > 0) & (normal[:, 2] > 0)
    half = wi + eye
    half = half / np.linalg.norm(half, axis=1, keepdims=True)
    blinn = np.maximum(np.einsum("ij,ij->i", normal, half), 0)
    phong = np.maximum(2 * cosine * normal[:, 2] - wi[:, 2], 0)
    drawn = np.maximum(normal @ toward, 0) ** (4 * power)
    # The peak, by bisection in the plane of light and eye: N is halfway between them.
    low, high = 0.0, math.radians(angle)
    for _ in range(60):
        middle = (low + high) / 2
        n = np.array([math.sin(middle), 0.0, math.cos(middle)])
        ray = light if math.isinf(distance) else distance * light - n
        to_light = math.atan2(ray[0], ray[2]) - middle
        low, high = (middle, high) if to_light > middle else (low, middle)
    return Highlight(
        distance,
        angle,
        float(np.abs(drawn - blinn ** (4 * power))[seen].max()),
        float(np.abs(drawn - phong**power)[seen].max()),
        math.degrees(low) - angle / 2,
    )
