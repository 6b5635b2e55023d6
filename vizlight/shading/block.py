"""The light of one block of points: the terms of a plan on component-first arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.model import falloff, frames, kernels
from vizlight.scene import View
from vizlight.scene.light import NO_ATTENUATION, WHITE, Light
from vizlight.shading.manifold import Line, Pair, Split, Surface, Tangents

if TYPE_CHECKING:
    from numpy.typing import DTypeLike

    from vizlight._types import Array, Bools
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.manifold import Manifold
    from vizlight.shading.plan import Plan


#: Coordinates below this leave no room in float32 for the rest beyond its digits.
SMALLEST_HELD = 1e-30


class Output:
    """The arrays that a plan fills."""

    def __init__(self, plan: Plan, count: int) -> None:
        self.luminance: Array = np.empty(count, plan.dtype)
        self.valid = np.empty(count, np.bool_)
        parts = plan.components
        self.diffuse: Array | None = np.empty(count, plan.dtype) if parts else None
        self.specular: Array | None = np.empty(count, plan.dtype) if parts else None
        self.rgb: Array | None = np.empty((count, 3), plan.dtype) if plan.colored else None


class _Lit(NamedTuple):
    """The direction toward a light, split, how far it is (None at infinity), and what it meets.

    ``cosine`` is N . wi of the normals, ``based`` that of the base tangents.
    """

    split: Split
    distance: Array | None
    cosine: Array | None
    based: Array | None


class _Shape:
    """The manifold at some rows, with the split directions toward lights at infinity."""

    def __init__(
        self,
        plan: Plan,
        surface: Surface | None,
        sheet: Tangents | None,
        tangents: ArraySource | None,
        rows: slice,
    ) -> None:
        self.plan, self.surface, self.sheet = plan, surface, sheet
        masks = [part.good for part in (surface, sheet) if part is not None]
        if tangents is not None:
            kind = Line if plan.model == "cylinder" else Tangents
            self.manifold: Manifold = kind(*_spanned(plan, plan.k, tangents, rows))
            masks.append(self.manifold.good)
        else:
            assert surface is not None
            self.manifold = surface
        self.good: Bools = np.logical_and.reduce(masks)
        self._distant: dict[int, _Lit] = {}

    def toward(self, number: int, position: Array | None) -> _Lit:
        """Return the direction toward a light; that of a light at infinity is computed once."""
        if number in self._distant:
            return self._distant[number]
        vector, distance = _toward(self.plan.scene.lights[number], position, self.plan.dtype)
        split, cosine, based = self.manifold.split(vector), None, None
        if self.surface is self.manifold:
            cosine = split.across
        elif self.surface is not None:
            cosine = self.surface.cosine(vector)
        if self.sheet is not None:
            pair = Pair(self.sheet.split(vector), None)
            based = self.sheet.diffuse(pair, self.plan.base_exponent)
        lit = _Lit(split, distance, cosine, based)
        if distance is None:
            self._distant[number] = lit
        return lit


def shade_block(plan: Plan, rows: slice, inputs: ShadingInputs, output: Output) -> None:
    """Light the points of some rows of normals or tangents.

    Overflow and underflow are handled; the caller silences NumPy's warnings about them.
    """
    surface = sheet = shape = None
    tangents, repeat = inputs.tangents, inputs.repeat
    if inputs.normals is not None:
        normal, length = kernels.unit(columns(inputs.normals, rows, plan.dtype))
        normal = normal.astype(plan.dtype, copy=False)
        surface = Surface(normal, length > 0, two_sided=plan.two_sided)
    if inputs.base_tangents is not None:
        sheet = Tangents(*_spanned(plan, plan.base, inputs.base_tangents, rows))
    each = tangents is not None and tangents.shape[0] == inputs.points.shape[0]
    for j in range(repeat):
        at = rows if repeat == 1 else slice(rows.start * repeat + j, rows.stop * repeat, repeat)
        if shape is None or each:
            shape = _Shape(plan, surface, sheet, tangents, at if each else rows)
        _shade_points(plan, shape, at, inputs, output)


class _Sight(NamedTuple):
    """The eye at the points of a block.

    ``split`` is None where no term needs it, ``seen`` where the eye is at infinity, ``height`` and
    ``path`` (through the fur, on the way out) without fur.
    """

    split: Split | None = None
    seen: Bools | None = None
    height: Array | None = None
    path: Array | None = None


def _look(
    plan: Plan, shape: _Shape, position: Array | None, block: slice, inputs: ShadingInputs,
    valid: Bools,
) -> _Sight:  # fmt: skip
    """Return the eye at the points of a block, and mark those where it has no direction."""
    view = plan.scene.view
    if not plan.needs_eye or view is None:
        return _Sight()
    toward_eye, distance = _toward(view, position, plan.dtype)
    split = shape.manifold.split(toward_eye) if plan.splits_eye else None
    height = path = seen = None
    if plan.fur and inputs.fur_height is not None and shape.surface is not None:
        height = np.asarray(inputs.fur_height[block]).astype(plan.dtype, copy=False)
        valid &= height >= 0
        path = falloff.fur_path(height, np.abs(shape.surface.cosine(toward_eye)))
    if distance is not None:
        valid &= distance >= 0
        seen = distance > 0
    return _Sight(split, seen, height, path)


def _shade_points(
    plan: Plan, shape: _Shape, block: slice, inputs: ShadingInputs, output: Output
) -> None:
    """Light one point of each row of a shape and write it to the output."""
    valid = shape.good.copy()
    position = columns(inputs.points, block) if plan.needs_points else None
    sight = _look(plan, shape, position, block, inputs, valid)
    sums = _Sums(plan)
    lights = zip(plan.scene.lights, plan.highlights, strict=True)
    for number, (light, highlight) in enumerate(lights):
        lit = shape.toward(number, position)
        passed: Array | None = None
        if inputs.shadow is not None:
            passed = np.asarray(inputs.shadow[block])[:, number].astype(plan.dtype, copy=False)
            valid &= passed >= 0
        if lit.distance is not None:
            valid &= lit.distance >= 0
        scale = _scale(plan, light, lit, shape.surface, passed, sight)
        if plan.dimmed and inputs.transmittance is not None:
            share = np.asarray(inputs.transmittance[block])[:, number].astype(plan.dtype)
            valid &= share >= 0
            scale = scale * share
        pair = shape.manifold.pair(lit.split, sight.split)
        if plan.diffuse:
            if passed is not None and plan.surface:
                value = passed
            else:
                value = shape.manifold.diffuse(pair, plan.exponent)
            sums.add("diffuse", value * scale, light)
        if plan.specular:
            value = shape.manifold.specular(pair, highlight) * scale
            if passed is not None and plan.surface and shape.surface is not None:
                value = value * _kept(passed, shape.surface.side(lit.split.across))
            if sight.seen is not None and not sight.seen.all():
                value = value * sight.seen
            sums.add("specular", value, light)
    occlusion = None
    if inputs.occlusion is not None:
        occlusion = np.asarray(inputs.occlusion[block]).astype(plan.dtype)
        known = occlusion >= 0
        valid &= known
        occlusion[~known] = 1
    _store(plan, sums, position, valid, block, output, occlusion)


def _scale(
    plan: Plan, light: Light, lit: _Lit, surface: Surface | None, passed: Array | None,
    sight: _Sight,
) -> Array | np.floating:  # fmt: skip
    """Return what multiplies both terms of a light: intensity, distance, self-shadow, fur, base."""
    scale: Array | np.floating = plan.dtype.type(light.intensity)
    if lit.distance is not None:
        if light.attenuation != NO_ATTENUATION:
            fading = falloff.fading(lit.distance, light.attenuation)
            scale = scale * fading.astype(plan.dtype, copy=False)
        if not lit.distance.all():
            # A light on the point has no direction to come from.
            scale = scale * (lit.distance > 0)
    if surface is not None and lit.cosine is not None:
        if plan.conditioned:
            scale = scale * (surface.side(lit.cosine) if passed is None else passed)
        if sight.height is not None and sight.path is not None:
            path = falloff.fur_path(sight.height, np.abs(lit.cosine)) + sight.path
            scale = scale * falloff.fur_passes(path, plan.fur)
    return scale if lit.based is None else scale * lit.based


def _kept(passed: Array, side: Array) -> Array:
    """Return the share that t has of the cosine which it stands for, for the highlight."""
    share = np.divide(passed, side, out=np.zeros_like(passed), where=side > 0)
    return np.minimum(share, 1)


def _spanned(plan: Plan, k: int, tangents: ArraySource, rows: slice) -> tuple[Array, Bools]:
    """Return an orthonormal frame of the span of k tangents per point, and where its rank is k."""
    vectors = columns(tangents, rows, plan.dtype)
    vectors = vectors.reshape(k, plan.n, vectors.shape[1])
    rtol = frames.default_rtol(plan.n, vectors.dtype)
    frame, rank = kernels.orthonormalize(vectors, rtol)
    return frame.astype(plan.dtype, copy=False), rank == k


def columns(rows: ArraySource, block: slice, work: DTypeLike = np.float32) -> Array:
    """Return a block of rows component by component, in the wider precision of rows and work.

    Float64 vectors are thus normalised before float32 work rounds them.
    """
    part = rows[block]
    narrow = work == np.float32 and part.dtype in (np.float16, np.float32)
    dtype = np.float32 if narrow else np.float64
    return np.ascontiguousarray(part.reshape(len(part), -1).T, dtype=dtype)


def _toward(
    owner: Light | View, points: Array | None, dtype: np.dtype[np.floating]
) -> tuple[Array, Array | None]:
    """Return unit directions toward a light or eye, and distances: None at infinity.

    Distances stay in float64, whose range they may need. float32 points in float32 work: the
    target is split into two float32 numbers, whose differences lose nothing to the distance from
    the origin.
    """
    parallel = owner.parallel if isinstance(owner, View) else owner.position is None
    if parallel:
        assert owner.direction is not None
        column, _ = kernels.unit(np.array(owner.direction, dtype=np.float64)[:, np.newaxis])
        return column.astype(dtype), None
    assert points is not None
    assert owner.position is not None
    at = np.array(owner.position, dtype=np.float64)[:, np.newaxis]
    high = at.astype(np.float32)
    held = np.isfinite(high) & ((np.abs(high) > SMALLEST_HELD) | (at == 0))
    if dtype == np.float32 and points.dtype == np.float32 and held.all():
        low = (at - high).astype(np.float32)
        difference = high - points
        if low.any():
            difference += low
        return kernels.unit(difference)
    direction, distance = kernels.unit(at - points)
    return direction.astype(dtype, copy=False), distance


class _Sums:
    """The diffuse and specular light of a block, added up over lights: white and by channel."""

    def __init__(self, plan: Plan) -> None:
        self.dtype = plan.dtype
        self.tinted = plan.colored and any(light.color is not None for light in plan.scene.lights)
        self.white: dict[str, Array] = {}
        self.channels: dict[str, Array] = {}

    def add(self, term: str, value: Array, light: Light) -> None:
        _accumulate(self.white, term, value)
        if self.tinted:
            tint = np.array(light.color or WHITE, self.dtype)[:, np.newaxis]
            _accumulate(self.channels, term, tint * value)


def _accumulate(sums: dict[str, Array], term: str, value: Array) -> None:
    if term in sums:
        sums[term] += value
    else:
        sums[term] = value


def _store(
    plan: Plan,
    sums: _Sums,
    points: Array | None,
    valid: Bools,
    block: slice,
    output: Output,
    occlusion: Array | None = None,
) -> None:
    """Multiply the sums by the material, fade them with depth, write them to the output."""
    fade = _fade(plan, points, valid)
    spoiled = None if valid.all() else ~valid
    for group in (sums.white, sums.channels):
        for term, value in group.items():
            value *= plan.dtype.type(getattr(plan.scene.material, term))
            if spoiled is not None:
                value[..., spoiled] = 0
    light = output.luminance[block]
    light[:] = plan.dtype.type(plan.ambient)
    if occlusion is not None:
        light *= occlusion
    for value in sums.white.values():
        light += value
    cue = plan.scene.depth_cue
    if cue is not None and fade is not None:
        light *= fade
        light += (1 - fade) * plan.dtype.type(cue.cue)
    output.valid[block] = valid
    for name, array in (("diffuse", output.diffuse), ("specular", output.specular)):
        if array is not None:
            array[block] = sums.white.get(name, 0)
    if output.rgb is not None:
        output.rgb[block] = _rgb(plan, sums, fade, len(valid), occlusion).T


def _fade(plan: Plan, points: Array | None, valid: Bools) -> Array | None:
    """Return the scale of the depth cue, and mark points that have no depth."""
    cue = plan.scene.depth_cue
    if cue is None:
        return None
    assert points is not None
    assert cue.front is not None
    assert cue.back is not None
    fade = falloff.depth_scale(
        view_depth(plan.scene.view, points),
        front=cue.front,
        back=cue.back,
        front_scale=cue.front_scale,
        back_scale=cue.back_scale,
        smooth=cue.smooth,
    ).astype(plan.dtype)
    valid &= np.isfinite(fade)
    fade[~valid] = 1
    return fade


def _rgb(plan: Plan, sums: _Sums, fade: Array | None, count: int, occlusion: Array | None) -> Array:
    """Return the colour, channel by channel."""
    scene, material, cue = plan.scene, plan.scene.material, plan.scene.depth_cue
    colors = {
        "ambient": np.multiply(material.color or WHITE, scene.ambient_color or WHITE),
        "diffuse": material.color or WHITE,
        "specular": material.specular_color or WHITE,
    }
    column = {name: np.array(c, plan.dtype)[:, np.newaxis] for name, c in colors.items()}
    rgb: Array = np.repeat(plan.dtype.type(plan.ambient) * column["ambient"], count, axis=1)
    if occlusion is not None:
        rgb *= occlusion
    for term, value in (sums.channels or sums.white).items():
        rgb += column[term] * value
    if cue is not None and fade is not None:
        rgb *= fade
        rgb += (1 - fade) * np.array(cue.color or WHITE, plan.dtype)[:, np.newaxis] * cue.cue
    return rgb


def view_depth(view: View | None, points: Array) -> Array:
    """Return the depth of points: along the axis of the view, or from the eye without an axis."""
    assert view is not None
    origin = np.array(view.position or np.zeros(len(points)), dtype=np.float64)[:, np.newaxis]
    if view.direction is None:
        return kernels.length(points - origin)
    axis, _ = kernels.unit(np.array(view.direction, dtype=np.float64)[:, np.newaxis])
    return kernels.dot(axis, origin - points)
