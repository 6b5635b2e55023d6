"""The light of a point: the one list of terms, written as the sources write it.

:func:`light` is a plain function. It asks an algebra ``w`` (:mod:`vizlight.shading.algebra`) for
numbers, inputs and a handful of vector operations; all else is arithmetic, the formulas of
:mod:`vizlight.model.formulas`, and the reflection of manifolds (:mod:`vizlight.model.manifolds`).
Under :class:`vizlight.shading.arrays.Arrays` its values are NumPy arrays, and the light is computed
when it returns. Only values that a plan needs are read: an ``if`` on the plan skips a term.

Directions point away from the point: wi to the lamp, wo to the eye; x_T and x_N are the tangential
and the normal part of x. Sources: Banks, *Illumination in Diverse Codimensions* (numbers in
brackets); the Lecture on shading; cos-theta shadows.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import reduce
from operator import add

from numpy import absolute

from vizlight._types import Value
from vizlight.model import formulas
from vizlight.model.formulas import where
from vizlight.model.manifolds import Cylinder, FrameManifold, Highlight, Split, Surface
from vizlight.scene.light import NO_ATTENUATION
from vizlight.shading.algebra import Algebra, Lamp, Total
from vizlight.shading.plan import Plan


def light(w: Algebra, plan: Plan) -> None:
    """Put I = ka Ia + sum of f (kd D + ks S) over the lamps, faded with depth."""
    # Taken once for all lamps: frames, the direction to the eye, the way through fur.
    normal = w.direction("normals") if w.has("normals") else None
    base = None
    if plan.base:
        base = FrameManifold(w, w.frame("base_tangents", plan.base), plan.base_exponent)
    wo, distance_o = w.eye() if plan.needs_eye else (None, None)
    shape = _shape(w, plan, normal, wo)
    # Only for its sides: the cosine that conditions tangents has no exponent.
    side = Surface(w, normal, 1.0, both=plan.two_sided).side
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
        # f: the share of the lamp's light that reaches the point.
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
            f = f * (side(cosine) if shadow is None else shadow)
        if path is not None:  # Banks (7), (8)
            both = formulas.fur_path(height, absolute(cosine)) + path
            f = f * formulas.fur_passes(both, w.fur_rate())
        # In codimension 2 or more the base has no sides; its own brightness |wi_N|^p takes their
        # place.
        if base is not None:
            f = f * base.diffuse(base.split(wi), None)
        # D and S: the shares of it that the manifold reflects.
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
                value = formulas.shadowed_highlight(value, passed, side(cosine))
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
    scale: Value = None
    if cue is not None:
        # S between the scales of front and back: the Lecture, atmospheric attenuation.
        depth, ends = w.depth()
        scale = w.sound(w.work(formulas.depth_scale(depth, *ends, smooth=cue.smooth)), 1.0)

    def whole(ambient: Value, terms: Iterable[Value], grey: Value) -> Value:
        ambient = ambient if occlusion is None else ambient * occlusion
        value = reduce(add, terms, ambient)
        return value if scale is None else formulas.depth_cue(value, scale, grey)

    parts = (("diffuse", diffuse, material.diffuse), ("specular", specular, material.specular))
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
        w.put("rgb", w.exposed(whole(w.color("ambient", plan.ambient), colors, grey)))


def _share(w: Algebra, name: str, lamp: Lamp) -> Value:
    share = w.read(name, lamp)
    w.need(share >= 0.0)
    return share


def _shape(w: Algebra, plan: Plan, normal: Value, wo: Value) -> Surface | FrameManifold:
    """Return the manifold as which a point is lit."""
    if plan.line_exponent is not None:
        return Mixed(w, plan, normal, wo)
    if plan.surface:
        return Surface(w, normal, plan.exponent, both=plan.two_sided)
    rows = w.frame("tangents", plan.k)
    return (Cylinder if plan.model == "cylinder" else FrameManifold)(w, rows, plan.exponent)


class Mixed(Surface):
    """Faces, lines and single points of one mesh; each point is lit by its own dimension.

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
        super().__init__(w, normal, plan.exponent, both=plan.two_sided)
        # 0.99, not 0.5: values interpolated from a line (1) to a face (2) are the line's until the
        # face.
        self.on_line = absolute(dimension - 1.0) < 0.99
        self.line = FrameManifold(w, w.frame("tangents", 1), exponent)

    def split(self, x: Value) -> Split:
        """Split a unit direction."""
        return self.line.split(x)._replace(up=self.w.dot(self.normal, x))

    def diffuse(self, lit: Split, eye: Split | None) -> Value:
        """Return sin(a)^p of a line, else (N.wi)^p."""
        return where(self.on_line, self.line.diffuse(lit, eye), super().diffuse(lit, eye))

    def specular(self, lit: Split, eye: Split | None, h: Highlight) -> Value:
        """Return the highlight of a line or of a surface."""
        return where(self.on_line, self.line.specular(lit, eye, h), super().specular(lit, eye, h))
