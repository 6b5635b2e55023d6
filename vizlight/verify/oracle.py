"""The light of one point by the formulas of the sources, in any type of real numbers.

:class:`Oracle` writes each formula as its source has it, but for the errata that the pages list,
for one point at a time, and shares no code with kernels, blocks or plans. :data:`FLOATS` computes
in float64; :func:`vizlight.check` compares samples with it. The tests make another oracle, of 50
digits.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple, TypeAlias

from vizlight.scene import DepthCue, Light, Scene, View

#: Number of an oracle's own type, which is float in the package.
Real: TypeAlias = float
Vector: TypeAlias = Sequence[Real]

WHITE = (1.0, 1.0, 1.0)
#: Length below which numbers of float64 lose digits.
TINY = 1e-300


class OracleLight(NamedTuple):
    """Light of one point, in the numbers of the oracle.

    The terms are without the depth cue; ``rgb`` has it and the exposure, and is empty if the scene
    has neither colour nor exposure.
    """

    luminance: Real
    rgb: tuple[Real, ...]
    ambient: Real
    diffuse: Real
    specular: Real


class _Place(NamedTuple):
    """Values that the lights of one point share: unit vectors, exponents and options."""

    normal: Vector | None
    frame: list[Vector]
    base: list[Vector]
    wo: Vector | None
    exponent: Real
    base_exponent: Real
    shininess: float
    model: str
    conditioned: bool
    two_sided: bool
    fur: float
    fur_height: float


@dataclass(frozen=True, kw_only=True)
class Oracle:
    """Formulas of the light of one point in one type of real numbers.

    Vectors are sequences of n numbers of the type, frames are lists of orthonormal vectors.
    ``number`` takes a float to the equal number of the type, and returns its own numbers unchanged;
    ``cosine_integral`` takes an angle from -pi/2 to pi/2 and p >= 0 to the integral of cos(x)^p
    from 0 to the angle.
    """

    number: Callable[[float], Real]
    pi: Real
    dot: Callable[[Vector, Vector], Real]
    hypot: Callable[..., Real]
    sin: Callable[[Real], Real]
    cos: Callable[[Real], Real]
    exp: Callable[[Real], Real]
    log_gamma: Callable[[Real], Real]
    atan2: Callable[[Real, Real], Real]
    cosine_integral: Callable[[Real, Real], Real]
    _exponents: dict[tuple[int, int], Real] = field(default_factory=dict, repr=False)

    def light(
        self,
        point: Vector,
        tangents: Sequence[Vector] | None,
        normal: Vector | None,
        scene: Scene,
        *,
        base_tangents: Sequence[Vector] | None = None,
        fur_height: float = 0.0,
        shadow: Vector | None = None,
        transmittance: Vector | None = None,
        occlusion: float = 1.0,
        model: str = "phong",
        exponent: float | str = "compensated",
        conditioned: bool = True,
        two_sided: bool = False,
        fur: float = 0.0,
        apart: float = 1e-14,
    ) -> OracleLight:
        """Return the light of one point.

        Tangents are of any length, None for a surface; ``apart`` is the share of a tangent's length
        beyond which it is independent of those before it. A depth cue of the scene has both ends,
        and other options are those of :func:`vizlight.shading.engine.shade`, for one point. Light
        is NaN where the point cannot be lit.
        """
        at, n, view = self.vector(point), len(point), scene.view
        frames = self._frames(tangents, base_tangents, normal, apart)
        if frames is None or not _placed(point, scene):
            dark = self.number(math.nan)
            return OracleLight(dark, (dark,) * (3 if scene.colored else 0), dark, dark, dark)
        frame, base, up = frames
        # Without a view the eye is along (1, ..., 1), without a highlight.
        eye = View.isometric(n) if view is None else view
        # A surface of n-space has n - 1 tangents, which its normal stands for.
        place = _Place(
            normal=up[0] if up else None, frame=frame, base=base,
            wo=self.toward(eye, at)[0], exponent=self._power(len(frame) or n - 1, n, exponent),
            # A given exponent belongs to the tangents: the base then has 1.
            base_exponent=self._power(len(base), n, exponent if isinstance(exponent, str) else 1),
            shininess=scene.material.shininess, model=model, conditioned=conditioned,
            two_sided=two_sided, fur=fur, fur_height=fur_height,
        )  # fmt: skip
        parts: list[tuple[Light, Real, Real]] = []
        for i, light in enumerate(light for light in scene.lights if light.intensity > 0):
            wi, distance = self.toward(_seen(light, eye), at)
            # A light at the point itself has no direction, and adds nothing.
            if wi is not None:
                scale = self._arriving(wi, distance, light, place)
                if transmittance is not None:
                    scale *= self.number(transmittance[i])
                passed = None if shadow is None else self.number(shadow[i])
                diffuse, specular = self._reflected(wi, passed, place)
                seen = 0.0 if view is None else 1.0
                parts.append((light, scale * diffuse, scale * seen * specular))
        return self._sum(at, scene, parts, self.number(occlusion))

    def _frames(
        self,
        tangents: Sequence[Vector] | None,
        base_tangents: Sequence[Vector] | None,
        normal: Vector | None,
        apart: float,
    ) -> list[list[Vector]] | None:
        """Return orthonormal frames, empty for None; None if rows are dependent or all are None."""
        normals = None if normal is None else [normal]
        row_sets = [() if rows is None else rows for rows in (tangents, base_tangents, normals)]
        frames = [self.orthonormal(rows, apart) for rows in row_sets]
        whole = list(map(len, frames)) == list(map(len, row_sets))
        return frames if whole and (frames[0] or frames[2]) else None

    def _power(self, k: int, n: int, exponent: float | str) -> Real:
        if isinstance(exponent, str):
            return self.exponent(k, n) if k else self.number(1.0)
        return self.number(exponent)

    def _arriving(self, wi: Vector, distance: Real | None, light: Light, place: _Place) -> Real:
        """Return the intensity after distance, fur and a base's diffuse term."""
        scale = self.number(light.intensity)
        if distance is not None:
            scale *= self.attenuation(distance, light.attenuation)
        # For tangents within a base its diffuse term takes the part of the self-shadow.
        if place.base:
            scale *= self.across(wi, place.base) ** place.base_exponent
        if place.fur and place.normal is not None and place.wo is not None:
            # Light passes the fur on its way in and again on its way out to the eye.
            for way in (wi, place.wo):
                sine = abs(self.dot(place.normal, way))
                scale *= self.fur(place.fur_height, sine, place.fur)
        return scale

    def _reflected(self, wi: Vector, passed: Real | None, place: _Place) -> tuple[Real, Real]:
        """Return the diffuse and the specular term of a light of intensity 1.

        ``passed`` is t of the light's cos-theta shadow, which takes the place of the cosine.
        """
        if place.normal is None:
            # Without a normal there is neither a side nor a self-shadow.
            return self._manifold(wi, place)
        cosine = self.dot(place.normal, wi)
        facing = abs(cosine) if place.two_sided else max(cosine, self.number(0.0))
        # Conditioned tangents inherit the self-shadow of the surface, the cosine to its normal
        # (Banks 6).
        if place.frame:
            terms = self._manifold(wi, place)
            scale = facing if passed is None else passed
            return (scale * terms[0], scale * terms[1]) if place.conditioned else terms
        specular = self._surface_specular(wi, cosine, place.normal, place)
        if passed is None:
            return facing**place.exponent, specular
        # The highlight in a cos-theta shadow keeps min(1, t / cos); a light behind the surface has
        # none.
        return passed, specular * min(passed / facing, self.number(1.0)) if facing else facing

    def _manifold(self, wi: Vector, place: _Place) -> tuple[Real, Real]:
        """Return the diffuse and the specular term of a k-manifold: Banks (1) to (5)."""
        wo, frame, s = place.wo, place.frame, place.shininess
        if place.model == "cylinder":
            none = self.number(0.0)
            return (none, none) if wo is None else self.line_light(wi, wo, frame[0], s)
        specular = self.number(0.0)
        if wo is not None:
            specular = self.specular(wi, wo, frame, s, place.model)
        return self.across(wi, frame) ** place.exponent, specular

    def _surface_specular(self, wi: Vector, cosine: Real, normal: Vector, place: _Place) -> Real:
        """Return a surface's specular term; two-sided, the normal is turned toward the light."""
        wo, two_sided, none = place.wo, place.two_sided, self.number(0.0)
        if wo is None or (cosine <= 0 and not two_sided):
            return none
        if place.model == "blinn":
            half = self.half(wi, wo)
            base = none if half is None else self.dot(normal, half)
            base = abs(base) if two_sided else base
        else:
            # R . E = 2 (N . wi)(N . wo) - wi . wo; without a side it is |wi_N||wo_N| - wi_T . wo_T,
            # as of a manifold (Banks 3).
            both = cosine * self.dot(normal, wo)
            base = (abs(both) if two_sided else both) + both - self.dot(wi, wo)
        value: Real = max(base, none) ** place.shininess
        return value

    def _sum(
        self, at: Vector, scene: Scene, parts: Sequence[tuple[Light, Real, Real]], occlusion: Real
    ) -> OracleLight:
        """Return the sum of the lights, given both terms of each for a white material."""
        material, zero = scene.material, self.number(0.0)
        ambient = self.number(material.ambient) * scene.ambient_intensity * occlusion
        parts = [(lamp, material.diffuse * d, material.specular * s) for lamp, d, s in parts]
        diffuse = sum((d for _, d, _ in parts), zero)
        specular = sum((s for _, _, s in parts), zero)
        rgb: list[Real] = []
        if scene.colored:
            color, gloss = material.color or WHITE, material.specular_color or WHITE
            for i, tint in enumerate(scene.ambient_color or WHITE):
                # The light's own colour tints both terms, and the material has a colour for each.
                terms = ((lamp.color or WHITE, color[i] * d + gloss[i] * s) for lamp, d, s in parts)
                rgb.append(ambient * tint * color[i] + sum(c[i] * value for c, value in terms))
        luminance, *rgb = self._faded([ambient + diffuse + specular, *rgb], at, scene)
        return OracleLight(
            luminance, tuple(self.exposed(rgb, scene.exposure)), ambient, diffuse, specular
        )

    def exposed(self, rgb: Vector, exposure: float | None) -> Vector:
        """Return the colour that is shown: times the exposure, with a knee from 4/5 toward 1."""
        if exposure is None or not rgb:
            return rgb
        most = max(rgb) * exposure
        knee = self.number(4) / 5
        # Light below the knee is multiplied alone.
        bent = 1 - (1 - knee) * self.exp(-(most - knee) / (1 - knee))
        share = bent / most if most > knee else self.number(1.0)
        return [value * exposure * share for value in rgb]

    def _faded(self, values: list[Real], at: Vector, scene: Scene) -> list[Real]:
        """Return luminance, red, green and blue with the depth cue."""
        cue, view = scene.depth_cue, scene.view
        if cue is None or view is None or cue.front is None or cue.back is None:
            return values
        origin = self.vector(view.position or [0.0] * len(at))
        away = [a - b for a, b in zip(origin, at, strict=True)]
        axis = None if view.direction is None else self.unit(self.vector(view.direction))
        # A view without a direction has no axis: depth is the distance from its place.
        depth = self.hypot(*away) if axis is None else self.dot(axis, away)
        grey = (1.0, *(cue.color or WHITE))
        return [self.depth_cue(v, depth, cue, g) for v, g in zip(values, grey, strict=False)]

    def specular(
        self, wi: Vector, wo: Vector, frame: Sequence[Vector], shininess: float, model: str
    ) -> Real:
        """Return max(0, |wi_N||wo_N| - wi_T . wo_T)^s (Banks (2), (3)), or Blinn's |h_N|^s."""
        if model == "blinn":
            half = self.half(wi, wo)
            return self.number(0.0) if half is None else self.across(half, frame) ** shininess
        mirror = self.across(wi, frame) * self.across(wo, frame)
        for t in frame:
            mirror -= self.dot(wi, t) * self.dot(wo, t)
        value: Real = max(mirror, self.number(0.0)) ** shininess
        return value

    def line_light(
        self, wi: Vector, wo: Vector, line: Vector, shininess: float
    ) -> tuple[Real, Real]:
        """Return the means of Lambert's and Blinn's terms over the visible half of a thin cylinder.

        In closed form, with alpha the angle between wi_N and wo_N, beta and gamma the angles of
        their sum with wo_N and with wi_N, and C(x, p) the integral of cos^p from 0 to x:
        ``|wi_N| (sin alpha + (pi - alpha) cos alpha) / 4`` and ``|h_N|^s / 2`` times
        ``cos beta (C(pi/2 - beta, s + 1) + C(pi/2 - gamma, s + 1)) +
        sin beta (sin(beta)^(s+1) - sin(gamma)^(s+1)) / (s + 1)``.
        """
        across_i, across_o = self.rest(wi, [line]), self.rest(wo, [line])
        size = self.hypot(*across_i)
        # Light along the line arrives at no side of the cylinder.
        if not size:
            return self.number(0.0), self.number(0.0)
        if not self.hypot(*across_o):
            return self.end_on(wi, wo, line, shininess)
        alpha = self.angle(across_i, across_o)
        diffuse = size * (self.sin(alpha) + (self.pi - alpha) * self.cos(alpha)) / 4
        half = self.half(wi, wo)
        both = [x + y for x, y in zip(across_i, across_o, strict=True)]
        if half is None or not any(both):
            return diffuse, self.number(0.0)
        beta, gamma = self.angle(both, across_o), self.angle(both, across_i)
        p, quarter = self.number(shininess) + 1, self.pi / 2
        whole = sum(self.cosine_integral(quarter - angle, p) for angle in (beta, gamma))
        ends = self.sin(beta) ** p - self.sin(gamma) ** p
        mean = self.cos(beta) * whole + self.sin(beta) * ends / p
        # This is |h_N|, the length of the part of the half vector across the line.
        scale = self.hypot(*both) / self.hypot(*(x + y for x, y in zip(wi, wo, strict=True)))
        return diffuse, scale**shininess * mean / 2

    def end_on(self, wi: Vector, wo: Vector, line: Vector, shininess: float) -> tuple[Real, Real]:
        """Return both terms of a thin cylinder seen along its line: means over its round."""
        mean = self.cosine_integral(self.pi / 2, self.number(shininess)) / self.pi
        specular = self.specular(wi, wo, [line], shininess, "blinn")
        return self.across(wi, [line]) / self.pi, specular * mean

    def attenuation(self, distance: Real, coefficients: Sequence[float]) -> Real:
        """Return min(1, 1 / (c1 + c2 d + c3 d^2)), of the Lecture."""
        c1, c2, c3 = map(self.number, coefficients)
        return 1 / max(c1 + c2 * distance + c3 * distance * distance, self.number(1.0))

    def fur(self, height: float, sine: Real, density: float) -> Real:
        """Return (1 - rho)^(h / sin a), of Banks (7) and (8): the share that passes once."""
        if height == 0:
            return self.number(1.0)
        # A way along the surface never leaves the fur.
        if sine == 0:
            return self.number(0.0)
        share: Real = (1 - self.number(density)) ** (self.number(height) / sine)
        return share

    def depth_cue(self, light: Real, depth: Real, cue: DepthCue, grey: float = 1.0) -> Real:
        """Return S I + (1 - S) Icue, of the Lecture; ``grey`` is the cue's own colour."""
        low, high, back = map(self.number, (cue.back_scale, cue.front_scale, cue.back or 0.0))
        t = (depth - back) / (self.number(cue.front or 0.0) - back)
        # Before its front and behind its back the cue stays as it is there.
        t = min(max(t, self.number(0.0)), self.number(1.0))
        share = low + (high - low) * (self.smooth(t) if cue.smooth else t)
        return share * light + (1 - share) * cue.cue * grey

    @staticmethod
    def smooth(t: Real) -> Real:
        """Return the smooth step 3 t^2 - 2 t^3."""
        return t * t * (3 - 2 * t)

    def mean_intensity(self, k: int, n: int, p: float) -> Real:
        """Return I(k, n, p) of Banks' appendix, by the gamma functions themselves."""
        c, power, two = n - k, self.number(p), self.number(2.0)
        log = self.log_gamma(n / two) + self.log_gamma((c + power) / 2)
        return self.exp(log - self.log_gamma(c / two) - self.log_gamma((n + power) / 2))

    def exponent(self, k: int, n: int) -> Real:
        """Return the p of a mean brightness of 1/2, by bisection to the last digit."""
        if (k, n) not in self._exponents:
            low, high = self.number(0.0), self.number(1.0)
            # The mean falls as p grows: a bound above is found by doubling, and p lies below it.
            while self.mean_intensity(k, n, high) > 0.5:
                high *= 2
            while low < (middle := (low + high) / 2) < high:
                above = self.mean_intensity(k, n, middle) > 0.5
                low, high = (middle, high) if above else (low, middle)
            self._exponents[k, n] = middle
        return self._exponents[k, n]

    def toward(self, end: Light | View, point: Vector) -> tuple[Vector | None, Real | None]:
        """Return the unit direction to a light or an eye, and its distance, None at infinity.

        At the light's or the eye's own place the direction is None.
        """
        if end.direction is not None and (end.position is None or getattr(end, "parallel", False)):
            return self.unit(self.vector(end.direction)), None
        assert end.position is not None
        way = [a - b for a, b in zip(self.vector(end.position), point, strict=True)]
        return self.unit(way), self.hypot(*way)

    def vector(self, v: Sequence[float]) -> Vector:
        """Return components as numbers of the type."""
        return list(map(self.number, v))

    def unit(self, v: Vector) -> Vector | None:
        """Return a unit vector; None where a vector has no direction."""
        size = self.hypot(*v)
        if not TINY < size < math.inf:
            # The length itself has no digits left, or the vector has no direction.
            largest = max(map(abs, v))
            if not 0 < largest < math.inf or size != size:
                return None
            # Divided by the largest component, the squares are within range.
            v = [x / largest for x in v]
            size = self.hypot(*v)
        return [x / size for x in v]

    def half(self, wi: Vector, wo: Vector) -> Vector | None:
        """Return the half vector of two directions; None where they are opposite."""
        return self.unit([x + y for x, y in zip(wi, wo, strict=True)])

    def angle(self, u: Vector, v: Vector) -> Real:
        """Return the angle between two vectors, without loss where it is near 0 or pi."""
        a, b = self.hypot(*u), self.hypot(*v)
        # The angle is 2 atan2(|a - b|, |a + b|) of vectors of one length; an arc cosine loses
        # digits near 0 and pi.
        pairs = [(x * b, y * a) for x, y in zip(u, v, strict=True)]
        apart, near = (self.hypot(*(x + s * y for x, y in pairs)) for s in (-1, 1))
        return 2 * self.atan2(apart, near)

    def rest(self, v: Vector, frame: Sequence[Vector]) -> Vector:
        """Return the part of a vector that is normal to a frame."""
        for t in frame:
            c = self.dot(v, t)
            v = [x - c * y for x, y in zip(v, t, strict=True)]
        return v

    def across(self, v: Vector, frame: Sequence[Vector]) -> Real:
        """Return the length of the part of a vector that is normal to a frame."""
        return self.hypot(*self.rest(v, frame))

    def orthonormal(self, rows: Sequence[Sequence[float]], apart: float = 0.0) -> list[Vector]:
        """Return an orthonormal frame of rows, without those that depend on the ones before."""
        frame: list[Vector] = []
        for row in rows:
            unit = self.unit(self.vector(row))
            if unit is not None and frame:
                rest = self.rest(unit, frame)
                size = self.hypot(*rest)
                unit = self.unit(rest) if size > apart else None
                if unit is not None and size < 0.5:
                    # A second pass removes what rounding left of the frame.
                    unit = self.unit(self.rest(unit, frame))
            if unit is not None:
                frame.append(unit)
        return frame


@lru_cache(maxsize=64)
def _seen(light: Light, eye: View) -> Light:
    """Return a light in a view, which all points of a scene share."""
    return light.seen_from(eye)


def _placed(point: Vector, scene: Scene) -> bool:
    """Return whether a point is finite, or no direction depends on it."""
    ends = (*scene.lights, scene.view)
    near = any(end is not None and end.position is not None for end in ends)
    return not (near or scene.depth_cue) or all(map(math.isfinite, point))


def _dot(u: Vector, v: Vector) -> float:
    return math.fsum(map(operator.mul, u, v))


def _cosine_integral(angle: float, power: float) -> float:
    """Return the integral of cos(x)^p from 0 to an angle, by quadrature."""
    from scipy import integrate

    # Beyond 9 widths of the peak cos(x)^p <= exp(-p x^2 / 2) is below all rounding.
    end = min(abs(angle), 9 / math.sqrt(1 + power))
    value = integrate.quad(lambda x: math.cos(x) ** power, 0.0, end, epsabs=1e-15, epsrel=1e-13)
    return math.copysign(value[0], angle)


#: The oracle in float64.
FLOATS = Oracle(
    number=float, pi=math.pi, dot=_dot, hypot=math.hypot, sin=math.sin, cos=math.cos,
    exp=math.exp, log_gamma=math.lgamma, atan2=math.atan2, cosine_integral=_cosine_integral,
)  # fmt: skip
light = FLOATS.light
