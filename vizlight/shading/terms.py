"""The light of a point: the one list of terms, written as the sources write it.

:func:`light` is a plain function. It asks an algebra ``w`` (:mod:`vizlight.shading.algebra`) for
numbers, inputs and a handful of vector operations; all else is arithmetic and the formulas of
:mod:`vizlight.model.formulas`. Under :class:`vizlight.shading.arrays.Arrays` its values are NumPy
arrays, and the light is there when it returns. Only what a plan needs is asked for: an ``if`` on
the plan is a term that is not computed.

Directions point away from the point: wi to the lamp, wo to the eye; x_T and x_N are the tangential
and the normal part of x. Sources: Banks, *Illumination in Diverse Codimensions* (numbers in
brackets); the Lecture on shading; cos-theta shadows.
"""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, NamedTuple, Protocol

from numpy import absolute, sqrt

from vizlight.model import cylinder_kernels, formulas
from vizlight.model.formulas import where
from vizlight.model.kernels import DEFICIT_FROM
from vizlight.scene.light import NO_ATTENUATION

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from vizlight.shading.algebra import Algebra, Lamp, Total, Value
    from vizlight.shading.plan import Highlight, Plan


def light(w: Algebra, plan: Plan) -> None:
    """Put I = ka Ia + sum of f (kd D + ks S) over the lamps, faded with depth.

    Parameters
    ----------
    w : Algebra
    plan : Plan
    """
    # What all lamps share is taken once: frames, the direction to the eye, the way through fur.
    normal = w.direction("normals") if w.has("normals") else None
    base = w.frame("base_tangents", plan.base) if plan.base else None
    wo, distance_o = w.eye() if plan.needs_eye else (None, None)
    shape = _shape(w, plan, normal, wo)
    eye = shape.split(wo) if plan.splits_eye else None
    # Fur: light crosses the skin's fur twice, down from the lamp and up to the eye.
    height: Value = None
    path: Value = None
    if plan.needs_eye and plan.fur:
        height = w.read("fur_height")
        w.need(height >= 0.0)
        path = formulas.fur_path(height, absolute(w.dot(normal, wo)))
    diffuse, specular = w.total(), w.total()
    for lamp in w.lamps():
        # A lamp at infinity has one direction for all points and neither distance nor attenuation.
        wi, distance = w.toward(lamp.position, lamp.direction, far=lamp.position is None)
        lit = shape.split(wi)
        cosine: Value = None
        # Signed: negative on the side that is averted from the lamp. Frames of tangents have no
        # such sign.
        if normal is not None:
            cosine = lit.up if plan.surface else w.dot(normal, wi)
        # f: what of the lamp's light reaches the point.
        f = w.number(lamp.intensity)
        if distance is not None:
            if lamp.attenuation != NO_ATTENUATION:
                # In float64: d^2 may leave the range of float32.
                fading = formulas.attenuation(distance, *map(w.wide, lamp.attenuation))
                f = f * w.work(fading)
            f = w.present(f, distance)
        # t of the cos-theta shadow takes the place of the cosine.
        shadow = _share(w, "shadow", lamp) if plan.shadowed else None
        if plan.dimmed:
            f = f * _share(w, "transmittance", lamp)
        # Tangents inherit the shade of the surface that they lie in: a fibre on the averted side
        # is dark.
        if plan.conditioned:  # Banks (6)
            f = f * (_side(plan, cosine) if shadow is None else shadow)
        if path is not None:  # Banks (7), (8)
            both = formulas.fur_path(height, absolute(cosine)) + path
            f = f * formulas.fur_passes(both, w.fur_rate())
        # In codimension 2 or more the base has no sides; its own brightness |wi_N|^p takes their
        # place.
        if base is not None:
            f = f * _sine_power(split(w, wi, base), plan.base_exponent)
        # D and S: what the manifold reflects of it.
        passed = shadow if plan.surface else None
        if plan.diffuse:
            # Of a surface in a cos-theta shadow, t is the diffuse term: the cosine is in it
            # already.
            value = shape.diffuse(lit, eye) if passed is None else passed
            diffuse.add(value * f, lamp.color)
        if plan.specular:
            value = shape.specular(lit, eye, lamp.highlight)
            if passed is not None:
                # The highlight has no cosine of its own; it keeps the share t / cos of the light
                # that is left.
                value = formulas.shadowed_highlight(value, passed, _side(plan, cosine))
            specular.add(w.present(value * f, distance_o), lamp.color)
    # Material and depth cue are the same for all lamps, and multiply the sums.
    _put(w, plan, diffuse, specular)


def _put(w: Algebra, plan: Plan, diffuse: Total, specular: Total) -> None:
    """Multiply by the material, add up, fade, and put the results."""
    material, cue = plan.scene.material, plan.scene.depth_cue
    occlusion = None
    if plan.occluded:
        occlusion = w.read("occlusion")
        w.need(occlusion >= 0.0)
        # NaN is not >= 0: such a point is marked by `need` and keeps the whole ambient light.
        occlusion = where(occlusion >= 0.0, occlusion, 1.0)
    scale = None if cue is None else w.sound(_depth_scale(w, plan), 1.0)

    def whole(ambient: Value, terms: Iterable[Value], grey: Value) -> Value:
        ambient = ambient if occlusion is None else ambient * occlusion
        value = reduce(add, terms, ambient)
        return value if scale is None else formulas.depth_cue(value, scale, grey)

    parts = (
        ("diffuse", diffuse, material.diffuse),
        ("specular", specular, material.specular),
    )
    # A point without light has 0 here, so that the ambient term alone is left of it.
    terms = {name: w.sound(total.white * w.number(k), 0.0) for name, total, k in parts if total}
    grey = 0.0 if cue is None else w.number(cue.cue)
    w.put("luminance", whole(w.number(plan.ambient), terms.values(), grey))
    if plan.components:
        for name, _, _ in parts:
            w.put(name, terms.get(name, 0.0))
    if w.colored:
        # Colours of lamps multiply those of the material by channel; luminance above stays white
        # light, so that it does not depend on the colour of the data.
        colors = [w.sound(total.rgb, 0.0) * w.color(name, k) for name, total, k in parts if total]
        if cue is not None:
            grey = w.cue_color()
        w.put("rgb", whole(w.color("ambient", plan.ambient), colors, grey))


class Split(NamedTuple):
    """A direction at a manifold: itself, its tangential coefficients, its normal part and size.

    ``up`` is N.x of a surface.
    """

    vector: Value
    along: Sequence[Value] = ()
    rest: Value = None
    size: Value = None
    up: Value = None


def split(w: Algebra, x: Value, frame: Sequence[Value]) -> Split:
    """Return x = x_T + x_N; |x_N| comes from the residual, as sqrt(1 - |x_T|^2) loses digits."""
    # Coefficients first, from the same x: rows are orthonormal, so the order does not matter.
    along, rest = [w.dot(t, x) for t in frame], x
    for a, t in zip(along, frame, strict=True):
        rest = rest - a * t
    return Split(x, along, rest, sqrt(w.dot(rest, rest)))


def _square(numbers: Iterable[Value]) -> Value:
    return reduce(add, (a * a for a in numbers))


def _share(w: Algebra, name: str, lamp: Lamp) -> Value:
    share = w.read(name, lamp)
    w.need(share >= 0.0)
    return share


def _side(plan: Plan, cosine: Value) -> Value:
    """Return N.wi on the lit side or sides."""
    return formulas.both_sides(cosine) if plan.two_sided else formulas.one_side(cosine)


def _sine_power(lit: Split, p: float) -> Value:
    """Return sin(a)^p = |wi_N|^p: Banks (1), and (5) with the exponent of Table 1."""
    return lit.size if p == 1 else formulas.diffuse(lit.size, _square(lit.along), p)


def _depth_scale(w: Algebra, plan: Plan) -> Value:
    """Return S between the scales of front and back: the Lecture, atmospheric attenuation."""
    cue = plan.scene.depth_cue
    assert cue is not None
    scale = formulas.smooth_depth_scale if cue.smooth else formulas.depth_scale
    depth, ends = w.depth()
    return w.work(scale(depth, *ends))


class _Shape(Protocol):
    """What a point is lit as."""

    def split(self, x: Value) -> Split:
        """Split a unit direction."""

    def diffuse(self, lit: Split, eye: Split | None) -> Value:
        """Return D."""

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return S."""


def _shape(w: Algebra, plan: Plan, normal: Value, wo: Value) -> _Shape:
    if plan.line_exponent is not None:
        return Mixed(w, plan, normal, wo)
    if plan.surface:
        return Surface(w, plan, normal)
    rows = w.frame("tangents", plan.k)
    return (Cylinder if plan.model == "cylinder" else Frame)(w, plan, rows, plan.exponent)


class Surface:
    """An (n - 1)-manifold by its normal, with sides."""

    def __init__(self, w: Algebra, plan: Plan, normal: Value) -> None:
        self.w, self.plan, self.normal = w, plan, normal

    def split(self, x: Value) -> Split:
        """Split a unit direction."""
        return Split(x, up=self.w.dot(self.normal, x))

    def diffuse(self, lit: Split, eye: Split | None) -> Value:  # noqa: ARG002 - it has no part
        """Return (N.wi)^p."""
        side, p = _side(self.plan, lit.up), self.plan.exponent
        return side if p == 1 else formulas.surface_diffuse(side, p)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return the highlight on the side that the light reaches."""
        w, plan = self.w, self.plan
        if h.half is not None:
            # Lamp and eye at infinity: one half vector for all points, a constant of the plan.
            half = w.way(h.half)
            up = w.dot(self.normal, half)
            if h.shininess <= DEFICIT_FROM:
                # Up to this shininess N.H to the power s loses no digits that matter; above, 1 -
                # (N.H)^2 is taken from the tangential residual, since near 1 the cosine itself has
                # lost them.
                value = formulas.power(_side(plan, up), None, h.shininess)
            else:
                value = formulas.blinn_of_unit(self._along(half, up), h.shininess)
                value = value if plan.two_sided else formulas.lit_highlight(value, up)
        else:
            assert eye is not None
            # Not normalised: Phong and Blinn need ratios of its parts alone, and its length may
            # vanish.
            half = lit.vector + eye.vector
            up = w.dot(self.normal, half)
            along = self._along(half, up)
            if h.model == "phong":
                sides = (lit.up, eye.up)
                if plan.two_sided:
                    sides = (formulas.both_sides(lit.up), formulas.both_sides(eye.up))
                value = formulas.phong(along, *sides, h.shininess)
            else:
                up = _side(plan, up)
                value = formulas.blinn(along, up * up, h.shininess)
        # No highlight where the lamp is below the horizon, whatever the half vector says.
        return value if plan.two_sided else formulas.lit_highlight(value, lit.up)

    def _along(self, half: Value, up: Value) -> Value:
        """Return the squared length of the tangential part, which is a residual."""
        rest = half - up * self.normal
        return self.w.dot(rest, rest)


class Frame:
    """A k-manifold by an orthonormal frame: |wi_N| stands for N.wi, and it has no sides."""

    def __init__(self, w: Algebra, plan: Plan, rows: Sequence[Value], exponent: float) -> None:
        self.w, self.plan, self.rows, self.exponent = w, plan, rows, exponent

    def split(self, x: Value) -> Split:
        """Split a unit direction."""
        return split(self.w, x, self.rows)

    def diffuse(self, lit: Split, eye: Split | None) -> Value:  # noqa: ARG002 - it has no part
        """Return sin(a)^p."""
        return _sine_power(lit, self.exponent)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return max(0, V.R)^s or |h_N|^s."""
        w = self.w
        if h.half is not None:
            half = w.way(h.half)
            return formulas.blinn_of_unit(_square(w.dot(t, half) for t in self.rows), h.shininess)
        assert eye is not None
        if h.model == "phong":
            # V.R is |wi_N||wo_N| - wi_T.wo_T. Its distance from 1 comes from |wi_T + wo_T|, which
            # vanishes at the peak: nothing cancels there.
            along = _square(a + b for a, b in zip(lit.along, eye.along, strict=True))
            return formulas.phong(along, lit.size, eye.size, h.shininess)
        # The half vector is split anew: the sum of two normal parts would lose digits where they
        # cancel.
        both = split(w, lit.vector + eye.vector, self.rows)
        return formulas.blinn(_square(both.along), w.dot(both.rest, both.rest), h.shininess)


class Mixed(Surface):
    """Faces, lines and single points of one mesh, by the dimension of what each point is lit as.

    A fragment between a point of a line and one of a face is the line's.
    """

    def __init__(self, w: Algebra, plan: Plan, normal: Value, wo: Value) -> None:
        dimension, exponent = w.read("dimensions"), plan.line_exponent
        assert exponent is not None
        if wo is not None:
            # A single point has neither normal nor tangent: it is lit as a surface that faces the
            # eye.
            alone = where(dimension < 0.5, 1.0, 0.0)
            normal = normal + alone * (wo - normal)
        super().__init__(w, plan, normal)
        # 0.99, not 0.5: values interpolated from a line (1) to a face (2) are the line's until the
        # face.
        self.on_line = absolute(dimension - 1.0) < 0.99
        self.line = Frame(w, plan, w.frame("tangents", 1), exponent)

    def split(self, x: Value) -> Split:
        """Split a unit direction."""
        return self.line.split(x)._replace(up=self.w.dot(self.normal, x))

    def diffuse(self, lit: Split, eye: Split | None) -> Value:
        """Return sin(a)^p of a line, else (N.wi)^p."""
        return where(self.on_line, self.line.diffuse(lit, eye), super().diffuse(lit, eye))

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return the highlight of a line or of a surface."""
        return where(self.on_line, self.line.specular(lit, eye, h), super().specular(lit, eye, h))


class Cylinder(Frame):
    """A line in 3-space as a thin cylinder: Lambert and Blinn averaged over its visible half.

    The closed forms stand in :mod:`vizlight.model.cylinder_kernels`.
    """

    _met: tuple[Split | None, Value] = (None, None)

    def _cross(self, lit: Split, eye: Split) -> Value:
        """Return |wi_N x wo_N|, which both terms need."""
        if self._met[0] is not lit:
            self._met = (lit, absolute(self.w.triple(lit.rest, eye.rest, self.rows[0])))
        return self._met[1]

    def diffuse(self, lit: Split, eye: Split | None) -> Value:
        """Return Lambert's mean."""
        assert eye is not None
        # Across the line both directions are seen in a plane: their angle there is atan2(cross,
        # dot).
        dot, cross = self.w.dot(lit.rest, eye.rest), self._cross(lit, eye)
        return formulas.cylinder_diffuse(lit.size, eye.size, dot, cross, self.w.least)

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return Blinn's mean."""
        assert eye is not None
        w, s, cross = self.w, h.shininess, self._cross(lit, eye)
        # Seen along the line: b and c are the angles from the half vector to the eye and to the
        # lamp.
        whole = lit.rest + eye.rest
        square = w.dot(whole, whole)
        normal = sqrt(square)
        to_eye, to_lamp = eye.size * normal, lit.size * normal
        cos_b = formulas.cylinder_cosine(w.dot(eye.rest, whole), to_eye)
        cos_c = formulas.cylinder_cosine(w.dot(lit.rest, whole), to_lamp)
        sin_b, sin_c = (formulas.cylinder_sine(cross, size) for size in (to_eye, to_lamp))
        # Along the line Blinn's lobe is that of a frame; the integral G over the arc is the mean
        # across.
        along = _square(a + b for a, b in zip(lit.along, eye.along, strict=True))
        return formulas.cylinder_specular(
            formulas.blinn(along, square, s),
            cos_b,
            w.integral(cos_b, s) + w.integral(cos_c, s),
            formulas.cylinder_ends(sin_b, sin_c, s) / w.number(s + 1),
            lit.size,
            eye.size,
            normal,
            w.least,
            w.number(cylinder_kernels.round_mean(s)),
        )
