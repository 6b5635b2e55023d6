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


def light(
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
    apart: float = 1e-14,
    **_: Any,
) -> list[float]:
    """Return the luminance of one point, and its colour if the scene has one.

    Parameters
    ----------
    point : sequence of n floats
    tangents : sequence of k vectors, or None for a surface
    normal : vector or None
    scene : Scene
        Its depth cue with both ends.
    carrier, depth, shadow, model, compensate, conditioned, two_sided, terminator, fur
        As :func:`vizlight.engine.shade` takes them, for one point.
    apart : float
        The share of a tangent's length beyond which it is independent of those before it.

    Returns
    -------
    list of 1 or 4 floats
        Luminance, red, green and blue; NaN where the point cannot be lit.
    """
    dark = [math.nan] * (4 if scene.colored else 1)
    material, n = scene.material, len(point)
    up = None if normal is None else _unit(normal)
    frame = None if tangents is None else _orthonormal(tangents, apart)
    sheet = None if carrier is None else _orthonormal(carrier, apart)
    missing = (normal is not None and up is None) or (up is None and frame is None)
    for given, made in ((tangents, frame), (carrier, sheet)):
        missing |= given is not None and (made is None or len(made) < len(given))
    places = [owner.position for owner in (*scene.lights, scene.view) if owner is not None]
    nowhere = not all(map(math.isfinite, point)) and any(p is not None for p in places)
    if missing or nowhere:
        return dark
    ambient = material.ambient * scene.ambient_intensity
    power = 1.0
    if compensate and model != "cylinder" and frame is not None:
        power = _exponent(len(frame), n)
    elif compensate and frame is None:
        power = _exponent(n - 1, n)
    view = scene.view
    eye = None if view is None else _toward(view, point)
    lit, number = 0.0, -1
    white = (1.0, 1.0, 1.0)
    rgb = [
        ambient * a * b
        for a, b in zip(material.color or white, scene.ambient_color or white, strict=True)
    ]
    for lamp in scene.lights:
        if lamp.intensity <= 0:
            continue
        number += 1
        wi, away = _toward(lamp.seen_from(view), point)
        if wi is None:
            continue
        scale = lamp.intensity
        if away is not None:
            c1, c2, c3 = lamp.attenuation
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
        diffuse, specular = (
            scale * material.diffuse * diffuse, scale * material.specular * specular
        )  # fmt: skip
        lit += diffuse + specular
        for i, tint in enumerate(lamp.color or white):
            own = (material.color or white)[i] * diffuse
            rgb[i] += tint * (own + (material.specular_color or white)[i] * specular)
    cue = scene.depth_cue
    grey = [1.0, *((cue.color if cue is not None else None) or white)]
    values = [ambient + lit, *rgb] if scene.colored else [ambient + lit]
    return [_cued(value, g, point, scene) for value, g in zip(values, grey, strict=False)]


def relief_ratio(
    x: Any, y: Any, z: Any, place: Any, normal: Any, depth: float, *, way: Numbers | None,
    end: Numbers | None = None, base: float = -math.inf, wall: bool = False,
) -> float:  # fmt: skip
    """Return t of a point of a height field, by many samples along its ray.

    Parameters
    ----------
    x, y, z : ndarray, shapes (nx,), (ny,), (ny, nx)
    place, normal : ndarray, shape (3,)
    depth : float
        Above 0.
    way : vector of 3 components or None
        Toward the light, above the horizon.
    end : vector of 3 components, optional
        Where the light is, in place of a way.
    base : float
        Where the solid ends below.
    wall : bool
        Whether it ends at its border, else it goes on.

    Returns
    -------
    float
        To 1/20,000 of the ray over the depth.
    """
    start = place - depth * normal
    rise = max(float(np.nanmax(z) - start[2]), 0.0)
    if end is not None:
        along = np.asarray(end, dtype=np.float64) - start
        if along @ normal <= depth:
            return 0.0
        # Above the highest there is no solid.
        along = along * min(rise / along[2], 1.0) if along[2] > 0 else along
    else:
        toward = np.asarray(_unit(() if way is None else list(way)))
        along = rise / toward[2] * toward
    places = start + (np.arange(SAMPLES)[:, np.newaxis] + 0.5) / SAMPLES * along
    across, up = (np.clip(p, a[0], a[-1]) for p, a in ((places[:, 0], x), (places[:, 1], y)))
    i, j = (np.clip(np.searchsorted(a, p) - 1, 0, len(a) - 2) for a, p in ((x, across), (y, up)))
    u, v = (across - x[i]) / (x[i + 1] - x[i]), (up - y[j]) / (y[j + 1] - y[j])
    low = (1 - u) * z[j, i] + u * z[j, i + 1]
    high = (1 - u) * z[j + 1, i] + u * z[j + 1, i + 1]
    within = (places[:, 2] < (1 - v) * low + v * high) & (places[:, 2] > base)
    if wall:
        within &= (across == places[:, 0]) & (up == places[:, 1])
    inside = float(np.mean(within)) * math.hypot(*along)
    return float(depth / max(inside, depth))


def solid_ratio(
    bodies: Sequence[Any], place: Any, normal: Any, depth: float, way: Any, reach: float
) -> float:
    """Return t of a point of closed surfaces: its ray against every triangle.

    Parameters
    ----------
    bodies : sequence of ndarray, shape (T, 3, 3)
        Corners of triangles, turned outward.
    place, normal : ndarray, shape (3,)
    depth : float
        Above 0.
    way : ndarray, shape (3,)
        Unit, toward the light.
    reach : float
        How far the light is.

    Returns
    -------
    float
        NaN where the ray meets an edge.
    """
    start = place - depth * normal
    inside: list[tuple[float, int]] = []
    for corners in bodies:
        a, e, f = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        p = np.cross(way, f)
        scale = np.einsum("ij,ij->i", e, p)
        with np.errstate(all="ignore"):
            u = np.einsum("ij,ij->i", start - a, p) / scale
            q = np.cross(start - a, e)
            v = q @ way / scale
            s = np.einsum("ij,ij->i", f, q) / scale
            near = np.minimum(np.minimum(u, v), 1 - u - v)
        ahead = (s > 0) & (s < reach)
        if np.any(ahead & (np.abs(near) < 1e-9)):
            return math.nan
        # The ray leaves where it runs with the outward normal e x f, of which scale is the inverse.
        hit = ahead & (near > 0)
        inside += [
            (float(at), 1 if side < 0 else -1) for at, side in zip(s[hit], scale[hit], strict=True)
        ]
    length, depth_in, far = 0.0, 0, reach
    for at, change in sorted(inside, reverse=True):
        length += far - at if depth_in > 0 else 0.0
        depth_in, far = depth_in + change, at
    length += far if depth_in > 0 else 0.0
    return float(depth / max(length, depth))


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


def _cued(light: float, grey: float, point: Numbers, scene: Scene) -> float:
    """Return the light faded with depth toward a share of the cue's."""
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
    return scale * light + (1 - scale) * cue.cue * grey


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


def _orthonormal(rows: Sequence[Numbers], apart: float) -> list[list[float]] | None:
    """Return an orthonormal frame of the rows; fewer rows where some depend on the others."""
    frame: list[list[float]] = []
    for row in rows:
        own = _unit(row)
        rest = None if own is None else _unit(_rest(own, frame))
        if own is not None and rest is not None and math.hypot(*_rest(own, frame)) > apart:
            again = _unit(_rest(rest, frame))
            if again is not None:
                frame.append(again)
    return frame or None
