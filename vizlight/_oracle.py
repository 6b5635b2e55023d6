"""The light of one point by the sources' formulas: plain Python numbers, nothing of the engine.

What :func:`vizlight.report` recomputes a sample by. Each formula is written as its source has it,
one point at a time in float64, with no code shared with kernels, blocks or plans.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.scene import Scene

    Numbers = Sequence[float]

#: Places on a ray through a height field.
SAMPLES = 20_000


def luminance(
    point: Numbers,
    tangents: Sequence[Numbers] | None,
    normal: Numbers | None,
    scene: Scene,
    *,
    carrier: Sequence[Numbers] | None = None,
    depth: float | None = None,
    shadow: Numbers | None = None,
    model: str = "phong",
    compensate: bool = True,
    conditioned: bool = True,
    two_sided: bool = False,
    terminator: float = 0.0,
    fur: float = 0.0,
    **_: Any,
) -> float:
    """Return the luminance of one point; NaN where it cannot be lit.

    Parameters
    ----------
    point : sequence of n floats
    tangents : sequence of k vectors, or None for a surface
    normal : vector or None
    scene : Scene
        Its depth cue with both ends.
    carrier, depth, shadow, model, compensate, conditioned, two_sided, terminator, fur
        As :func:`vizlight.engine.shade` takes them, for one point.

    Returns
    -------
    float
    """
    material, n = scene.material, len(point)
    up = None if normal is None else _unit(normal)
    frame = None if tangents is None else _orthonormal(tangents)
    sheet = None if carrier is None else _orthonormal(carrier)
    missing = (normal is not None and up is None) or (up is None and frame is None)
    for given, made in ((tangents, frame), (carrier, sheet)):
        missing |= given is not None and (made is None or len(made) < len(given))
    if missing:
        return math.nan
    ambient = material.ambient * scene.ambient_intensity
    power = 1.0
    if compensate and model != "cylinder" and frame is not None:
        power = _exponent(len(frame), n)
    elif compensate and frame is None:
        power = _exponent(n - 1, n)
    view = scene.view
    eye = None if view is None else _toward(view, point)
    lit, number = 0.0, -1
    for light in scene.lights:
        if light.intensity <= 0:
            continue
        number += 1
        wi, away = _toward(light.seen_from(view), point)
        if wi is None:
            continue
        scale = light.intensity
        if away is not None:
            c1, c2, c3 = light.attenuation
            scale *= min(1.0, 1 / max(c1 + c2 * away + c3 * away * away, 1e-300))
        facing = None
        if up is not None:
            cosine = _dot(up, wi)
            facing = abs(cosine) if two_sided else max(cosine, 0.0)
            passed = None if shadow is None else float(shadow[number])
            if frame is not None and conditioned:
                scale *= facing if passed is None else passed
            if fur and depth is not None and eye is not None and eye[0] is not None:
                path = _path(depth, abs(cosine)) + _path(depth, abs(_dot(up, eye[0])))
                scale *= (1 - fur) ** path if path < math.inf else 0.0
        if sheet is not None:
            scale *= _across(wi, sheet) ** (_exponent(len(sheet), n) if compensate else 1.0)
        diffuse, specular = _terms(
            wi, None if eye is None else eye[0], up, frame, facing, power,
            material.shininess, model, two_sided=two_sided, terminator=terminator,
        )  # fmt: skip
        if shadow is not None and frame is None and facing is not None:
            specular *= min(float(shadow[number]) / facing, 1.0) if facing else 0.0
            diffuse = float(shadow[number])
        lit += scale * (material.diffuse * diffuse + material.specular * specular)
    return _cued(ambient + lit, point, scene)


def relief_ratio(
    x: Any, y: Any, z: Any, place: Any, normal: Any, depth: float, way: Numbers
) -> float:
    """Return t of a point of a height field that ends nowhere, by many samples along its ray.

    Parameters
    ----------
    x, y, z : ndarray, shapes (nx,), (ny,), (ny, nx)
    place, normal : ndarray, shape (3,)
    depth : float
        Above 0.
    way : vector of 3 components
        Toward the light, above the horizon.

    Returns
    -------
    float
        To 1/20,000 of the ray over the depth.
    """
    toward = np.asarray(_unit(way))
    start = place - depth * normal
    reach = max(float(z.max() - start[2]), 0.0) / toward[2]
    places = start + (np.arange(SAMPLES)[:, np.newaxis] + 0.5) * (reach / SAMPLES) * toward
    across, up = (np.clip(p, a[0], a[-1]) for p, a in ((places[:, 0], x), (places[:, 1], y)))
    i, j = (np.clip(np.searchsorted(a, p) - 1, 0, len(a) - 2) for a, p in ((x, across), (y, up)))
    u, v = (across - x[i]) / (x[i + 1] - x[i]), (up - y[j]) / (y[j + 1] - y[j])
    low = (1 - u) * z[j, i] + u * z[j, i + 1]
    high = (1 - u) * z[j + 1, i] + u * z[j + 1, i + 1]
    inside = float(np.mean(places[:, 2] < (1 - v) * low + v * high)) * reach
    return float(depth / max(inside, depth))


def _terms(
    wi: Numbers,
    wo: Numbers | None,
    up: Numbers | None,
    frame: list[list[float]] | None,
    facing: float | None,
    power: float,
    shininess: float,
    model: str,
    *,
    two_sided: bool,
    terminator: float,
) -> tuple[float, float]:
    """Return the diffuse and the specular factor of one light."""
    half = None if wo is None else _unit([a + b for a, b in zip(wi, wo, strict=True)])
    if frame is not None:
        sine = _across(wi, frame)
        if model == "cylinder":
            return _line_light(wi, wo, frame[0], half, shininess) if wo is not None else (0.0, 0.0)
        if wo is None:
            return sine**power, 0.0
        if model == "blinn":
            return sine**power, 0.0 if half is None else _across(half, frame) ** shininess
        along = sum(_dot(wi, t) * _dot(wo, t) for t in frame)
        mirror = sine * _across(wo, frame) - along
        return sine**power, max(mirror, 0.0) ** shininess
    assert up is not None
    assert facing is not None
    cosine = _dot(up, wi)
    if wo is None or (not two_sided and cosine <= 0):
        return facing**power, 0.0
    if model == "blinn":
        base = 0.0 if half is None else _dot(up, half)
        base = abs(base) if two_sided else base
    else:
        seen = _dot(up, wo)
        base = 2 * cosine * seen - _dot(wi, wo)
        if two_sided:
            base = abs(cosine * seen) + cosine * seen - _dot(wi, wo)
    value = max(base, 0.0) ** shininess
    if terminator and not two_sided:
        t = min(cosine / terminator, 1.0)
        value *= t * t * (3 - 2 * t)
    return facing**power, value


def _line_light(
    wi: Numbers, wo: Numbers, line: Numbers, half: list[float] | None, shininess: float
) -> tuple[float, float]:
    """Return Lambert's and Blinn's means over the visible half of a cylinder, by quadrature."""
    from scipy import integrate

    eye = _unit([x - _dot(wo, line) * t for x, t in zip(wo, line, strict=True)])
    if eye is None:
        return 0.0, 0.0
    side = [
        line[1] * eye[2] - line[2] * eye[1],
        line[2] * eye[0] - line[0] * eye[2],
        line[0] * eye[1] - line[1] * eye[0],
    ]
    x, y = _dot(wi, eye), _dot(wi, side)
    at = math.atan2(y, x)
    low, high = max(-math.pi / 2, at - math.pi / 2), min(math.pi / 2, at + math.pi / 2)
    hx, hy = (0.0, 0.0) if half is None else (_dot(half, eye), _dot(half, side))

    def lambert(a: float) -> float:
        return (x * math.cos(a) + y * math.sin(a)) * math.cos(a) / 2

    def blinn(a: float) -> float:
        base = max(hx * math.cos(a) + hy * math.sin(a), 0.0)
        return float(base**shininess) * math.cos(a) / 2

    peak, width = math.atan2(hy, hx), 1 / math.sqrt(1 + shininess)
    marks = [peak + j * width for j in (-8, -4, -2, -1, 0, 1, 2, 4, 8)]
    cuts = [low, *(a for a in marks if low < a < high), high]
    pieces = itertools.pairwise(cuts)
    shine = sum(integrate.quad(blinn, a, b, epsabs=1e-13)[0] for a, b in pieces)
    return integrate.quad(lambert, low, high, epsabs=1e-13)[0], shine


def _exponent(k: int, n: int) -> float:
    """Return the p whose mean brightness is 1/2: bisection of the gamma functions themselves."""
    from scipy import special

    if (k, n) in _EXPONENTS:
        return _EXPONENTS[k, n]

    def mean(p: float) -> float:
        c = n - k
        return math.exp(
            float(
                special.gammaln(n / 2) + special.gammaln((c + p) / 2)
                - special.gammaln(c / 2) - special.gammaln((n + p) / 2)
            )
        )  # fmt: skip

    low, high = 0.0, 1.0
    while mean(high) > 0.5:
        high *= 2
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (middle, high) if mean(middle) > 0.5 else (low, middle)
    _EXPONENTS[k, n] = (low + high) / 2
    return _EXPONENTS[k, n]


_EXPONENTS: dict[tuple[int, int], float] = {}


def _cued(light: float, point: Numbers, scene: Scene) -> float:
    """Return the light faded with depth."""
    cue, view = scene.depth_cue, scene.view
    if cue is None or view is None or cue.front is None or cue.back is None:
        return light
    origin = view.position or [0.0] * len(point)
    away = [a - b for a, b in zip(origin, point, strict=True)]
    axis = None if view.direction is None else _unit(view.direction)
    depth = math.hypot(*away) if axis is None else _dot(axis, away)
    t = min(max((depth - cue.back) / (cue.front - cue.back), 0.0), 1.0)
    t = t * t * (3 - 2 * t) if cue.smooth else t
    scale = cue.back_scale + (cue.front_scale - cue.back_scale) * t
    return scale * light + (1 - scale) * cue.cue


def _toward(owner: Any, point: Numbers) -> tuple[list[float] | None, float | None]:
    """Return the unit direction to a light or an eye, and how far it is; None at infinity."""
    if owner.position is None or getattr(owner, "parallel", False):
        return _unit(owner.direction), None
    way = [a - b for a, b in zip(owner.position, point, strict=True)]
    return _unit(way), math.hypot(*way)


def _path(depth: float, sine: float) -> float:
    if depth == 0:
        return 0.0
    return depth / sine if sine else math.inf


def _dot(a: Numbers, b: Numbers) -> float:
    return math.fsum(x * y for x, y in zip(a, b, strict=True))


def _unit(v: Numbers) -> list[float] | None:
    """Return a unit vector; None where it has no direction."""
    largest = max(abs(x) for x in v)
    if not (0 < largest < math.inf) or any(math.isnan(x) for x in v):
        return None
    scaled = [x / largest for x in v]
    size = math.hypot(*scaled)
    return [x / size for x in scaled]


def _rest(v: Numbers, frame: list[list[float]]) -> list[float]:
    rest = list(v)
    for t in frame:
        c = _dot(rest, t)
        rest = [x - c * y for x, y in zip(rest, t, strict=True)]
    return rest


def _across(v: Numbers, frame: list[list[float]]) -> float:
    return math.hypot(*_rest(v, frame))


def _orthonormal(rows: Sequence[Numbers]) -> list[list[float]] | None:
    """Return an orthonormal frame of the rows; fewer rows where some depend on the others."""
    frame: list[list[float]] = []
    for row in rows:
        own = _unit(row)
        rest = None if own is None else _unit(_rest(own, frame))
        if own is not None and rest is not None and math.hypot(*_rest(own, frame)) > 1e-7:
            again = _unit(_rest(rest, frame))
            if again is not None:
                frame.append(again)
    return frame or None
