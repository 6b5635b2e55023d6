"""The light of one block of points: a plan's terms on component-first arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from vizlight.model import cylinder_kernels, falloff, frames, kernels
from vizlight.scene import View
from vizlight.scene.light import NO_ATTENUATION, WHITE, Light

if TYPE_CHECKING:
    from numpy.typing import DTypeLike, NDArray

    from vizlight._types import Array, Bools, Vector
    from vizlight.shading.plan import Highlight, Plan


class Rows(Protocol):
    """Anything that gives rows by slice: an array, or points made on the fly."""

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape; the first axis is that of the points."""

    @property
    def dtype(self) -> np.dtype[Any]:
        """The type of the numbers."""

    def __getitem__(self, rows: slice, /) -> NDArray[Any]:
        """Return some rows."""


class Output:
    """The arrays that a plan fills."""

    def __init__(self, plan: Plan, count: int) -> None:
        self.luminance: Array = np.empty(count, plan.dtype)
        self.valid = np.empty(count, np.bool_)
        parts = plan.components
        self.diffuse: Array | None = np.empty(count, plan.dtype) if parts else None
        self.specular: Array | None = np.empty(count, plan.dtype) if parts else None
        self.rgb: Array | None = np.empty((count, 3), plan.dtype) if plan.colored else None


class _Split(NamedTuple):
    """A direction as the manifold sees it: the vector, its tangential and its normal part."""

    vector: Array
    along: Array
    across: Array


class _Pair(NamedTuple):
    """A light and the eye as the manifold sees them; no eye where nothing needs its split."""

    lit: _Split
    eye: Any
    met: Any = None


class _Tangents:
    """A k-manifold given by its tangents, good where these are independent; it has no sides."""

    def __init__(self, frame: Array, good: Bools) -> None:
        self.frame, self.good = frame, good

    def split(self, x: Array) -> _Split:
        return _Split(x, *kernels.split(x, self.frame))

    def pair(self, lit: _Split, eye: _Split | None) -> _Pair:
        return _Pair(lit, eye)

    def diffuse(self, pair: _Pair, exponent: float) -> Array:
        return kernels.diffuse(pair.lit.across, exponent, pair.lit.along)

    def specular(self, pair: _Pair, highlight: Highlight) -> Array:
        lit, eye, shininess = pair.lit, pair.eye, highlight.shininess
        if highlight.half is not None:
            along = kernels.coefficients(_column(highlight.half, self.frame), self.frame)
            return kernels.blinn_of_unit(kernels.dot(along, along), shininess)
        if highlight.model == "phong":
            along = lit.along + eye.along
            return kernels.phong(kernels.dot(along, along), lit.across, eye.across, shininess)
        along, across = kernels.split(lit.vector + eye.vector, self.frame)
        return kernels.blinn(kernels.dot(along, along), across * across, shininess)


class _Line:
    """A line in 3-space as a thin cylinder; the vector of a split is its normal part."""

    def __init__(self, frame: Array, good: Bools) -> None:
        self.tangent, self.good = frame[0], good

    def split(self, x: Array) -> _Split:
        along, rest, across = cylinder_kernels.across(x, self.tangent)
        return _Split(rest, along, across)

    def pair(self, lit: _Split, eye: _Split) -> _Pair:
        met = cylinder_kernels.meet(lit.vector, lit.across, eye.vector, eye.across, self.tangent)
        return _Pair(lit, eye, met)

    def diffuse(self, pair: _Pair, _: float) -> Array:
        return cylinder_kernels.diffuse(pair.met)

    def specular(self, pair: _Pair, highlight: Highlight) -> Array:
        along = pair.lit.along + pair.eye.along
        return cylinder_kernels.specular(pair.met, along * along, highlight.shininess)


class _Surface:
    """A (n - 1)-manifold given by its unit normals; one-sided unless asked otherwise.

    The tangential part is kept as what is left of the vector, and only where it is needed.
    """

    def __init__(self, normal: Array, good: Bools, *, two_sided: bool, terminator: float) -> None:
        self.normal, self.good = normal, good
        self.two_sided, self.terminator = two_sided, terminator

    def side(self, cosine: Array) -> Array:
        """Return the cosine clamped to the lit side or sides."""
        return np.abs(cosine) if self.two_sided else np.maximum(cosine, 0)

    def split(self, x: Array) -> _Split:
        return _Split(x, x, kernels.dot(self.normal, x))

    def pair(self, lit: _Split, eye: _Split | None) -> _Pair:
        return _Pair(lit, eye)

    def cosine(self, x: Array) -> Array:
        """Return the cosine of a unit direction to the normal."""
        return kernels.dot(self.normal, x)

    def diffuse(self, pair: _Pair, exponent: float) -> Array:
        return kernels.power(self.side(pair.lit.across), exponent)

    def specular(self, pair: _Pair, highlight: Highlight) -> Array:
        lit, eye, shininess = pair.lit, pair.eye, highlight.shininess
        if highlight.half is not None:
            return self._cut(lit, self._fixed_half(highlight.half, shininess))
        tangential, up = self._half(lit, eye)
        if highlight.model == "phong":
            cosines = (lit.across, eye.across)
            if self.two_sided:
                cosines = (np.abs(lit.across), np.abs(eye.across))
            return self._cut(lit, kernels.phong(tangential, *cosines, shininess))
        up = self.side(up)
        return self._cut(lit, kernels.blinn(tangential, up * up, shininess))

    def _fixed_half(self, half: Vector, shininess: float) -> Array:
        column = _column(half, self.normal)
        cosine = kernels.dot(self.normal, column)
        if shininess <= kernels.DEFICIT_FROM:
            return kernels.power(self.side(cosine), shininess)
        rest = column - cosine * self.normal
        value = kernels.blinn_of_unit(kernels.dot(rest, rest), shininess)
        return value if self.two_sided else value * (cosine > 0)

    def _half(self, lit: _Split, eye: _Split) -> tuple[Array, Array]:
        """Return |(wi + wo)_T|^2 and (wi + wo) . N."""
        half = lit.vector + eye.vector
        up = kernels.dot(self.normal, half)
        rest = half - up * self.normal
        return kernels.dot(rest, rest), up

    def _cut(self, lit: _Split, value: Array) -> Array:
        """Take the highlight from the side that the light does not reach, sharply or smoothly."""
        if self.two_sided:
            return value
        if self.terminator:
            return value * kernels.smooth_step(lit.across / value.dtype.type(self.terminator))
        return value * (lit.across > 0)


def _column(vector: Vector, like: Array) -> Array:
    """Return one vector as a batch of one that broadcasts, in the precision of another array."""
    return np.array(vector, dtype=like.dtype)[:, np.newaxis]


class Given(NamedTuple):
    """The rows that are lit; normals, carrier and perhaps tangents serve ``repeat`` points each."""

    points: Rows
    tangents: Rows | None
    normals: Rows | None
    carrier: Rows | None
    depth: Rows | None
    shadow: Rows | None
    repeat: int


class _Lit(NamedTuple):
    """The direction toward a light, split, how far it is (None at infinity), and what it meets.

    ``cosine`` is N . wi of the normals, ``carried`` the brightness of the carrier.
    """

    split: _Split
    distance: Array | None
    cosine: Array | None
    carried: Array | None


class _Shape:
    """The manifold at some rows, and the directions toward lights at infinity that it has split."""

    def __init__(
        self,
        plan: Plan,
        surface: _Surface | None,
        sheet: _Tangents | None,
        tangents: Rows | None,
        rows: slice,
    ) -> None:
        self.plan, self.surface, self.sheet = plan, surface, sheet
        self.manifold: Any = surface
        masks = [part.good for part in (surface, sheet) if part is not None]
        if tangents is not None:
            kind = _Line if plan.model == "cylinder" else _Tangents
            self.manifold = kind(*_spanned(plan, plan.k, tangents, rows))
            masks.append(self.manifold.good)
        self.good: Bools = np.logical_and.reduce(masks)
        self._distant: dict[int, _Lit] = {}

    def toward(self, number: int, position: Array | None) -> _Lit:
        """Return the direction toward a light, found once for a light at infinity."""
        if number in self._distant:
            return self._distant[number]
        vector, distance = _toward(self.plan.scene.lights[number], position, self.plan.dtype)
        split, cosine, carried = self.manifold.split(vector), None, None
        if self.surface is self.manifold:
            cosine = split.across
        elif self.surface is not None:
            cosine = self.surface.cosine(vector)
        if self.sheet is not None:
            pair = _Pair(self.sheet.split(vector), None)
            carried = self.sheet.diffuse(pair, self.plan.carrier_exponent)
        lit = _Lit(split, distance, cosine, carried)
        if distance is None:
            self._distant[number] = lit
        return lit


def shade_block(plan: Plan, rows: slice, given: Given, output: Output) -> None:
    """Light the points of some rows of normals or tangents.

    Overflow and underflow are taken care of; the caller silences NumPy's warnings of them.
    """
    surface = sheet = shape = None
    tangents, repeat = given.tangents, given.repeat
    if given.normals is not None:
        normal, length = kernels.unit(columns(given.normals, rows, plan.dtype))
        normal = normal.astype(plan.dtype, copy=False)
        surface = _Surface(normal, length > 0, two_sided=plan.two_sided, terminator=plan.terminator)
    if given.carrier is not None:
        sheet = _Tangents(*_spanned(plan, plan.carrier, given.carrier, rows))
    each = tangents is not None and tangents.shape[0] == given.points.shape[0]
    for j in range(repeat):
        at = rows if repeat == 1 else slice(rows.start * repeat + j, rows.stop * repeat, repeat)
        if shape is None or each:
            shape = _Shape(plan, surface, sheet, tangents, at if each else rows)
        _shade_points(plan, shape, at, given, output)


def _shade_points(plan: Plan, shape: _Shape, block: slice, given: Given, output: Output) -> None:
    """Light one point of each row of a shape and write it to the output."""
    scene, dtype = plan.scene, plan.dtype
    manifold, surface = shape.manifold, shape.surface
    valid = shape.good.copy()
    position = columns(given.points, block) if plan.needs_points else None
    eye: _Split | None = None
    seen: Bools | None = None
    under: Array | None = None
    path_out: Any = 0
    if plan.needs_eye:
        assert scene.view is not None
        toward_eye, distance = _toward(scene.view, position, dtype)
        if plan.splits_eye:
            eye = manifold.split(toward_eye)
        if plan.fur and given.depth is not None and surface is not None:
            under = np.asarray(given.depth[block]).astype(dtype, copy=False)
            valid &= under >= 0
            path_out = falloff.fur_path(under, np.abs(surface.cosine(toward_eye)))
        if distance is not None:
            valid &= distance >= 0
            seen = distance > 0

    sums = _Sums(plan)
    for number, (light, highlight) in enumerate(zip(scene.lights, plan.highlights, strict=True)):
        lit, distance, cosine, carried = shape.toward(number, position)
        pair = manifold.pair(lit, eye)
        scale: Any = dtype.type(light.intensity)
        if distance is not None:
            valid &= distance >= 0
            if light.attenuation != NO_ATTENUATION:
                scale = scale * falloff.fading(distance, light.attenuation)
            if not distance.all():
                # A light on the point has no direction to come from.
                scale = scale * (distance > 0)
        passed: Array | None = None
        if given.shadow is not None:
            passed = np.asarray(given.shadow[block])[:, number].astype(dtype, copy=False)
            valid &= passed >= 0
        if surface is not None and cosine is not None:
            if plan.conditioned:
                scale = scale * (surface.side(cosine) if passed is None else passed)
            if under is not None:
                path = falloff.fur_path(under, np.abs(cosine)) + path_out
                scale = scale * falloff.fur_passes(path, plan.fur)
        if carried is not None:
            scale = scale * carried
        if plan.diffuse:
            if plan.surface and passed is not None:
                value = passed
            else:
                value = manifold.diffuse(pair, plan.exponent)
            sums.add("diffuse", value * scale, light)
        if plan.specular:
            value = manifold.specular(pair, highlight) * scale
            if passed is not None and surface is not None and plan.surface:
                # A highlight keeps the share that t has of the cosine which it stands for.
                side = surface.side(lit.across)
                kept = np.divide(passed, side, out=np.zeros_like(passed), where=side > 0)
                value = value * np.minimum(kept, 1)
            if seen is not None and not seen.all():
                value = value * seen
            sums.add("specular", value, light)
    _store(plan, sums, position, valid, block, output)


def _spanned(plan: Plan, k: int, tangents: Rows, rows: slice) -> tuple[Array, Bools]:
    """Return an orthonormal frame of what k tangents a point span, and where these are k."""
    vectors = columns(tangents, rows, plan.dtype)
    vectors = vectors.reshape(k, plan.n, vectors.shape[1])
    rtol = frames.default_rtol(plan.n, vectors.dtype)
    frame, rank = kernels.orthonormalize(vectors, rtol)
    return frame.astype(plan.dtype, copy=False), rank == k


def columns(rows: Rows, block: slice, work: DTypeLike = np.float32) -> Array:
    """Return a block of rows component by component, in their precision or the work's, the wider.

    Float64 vectors are thus made unit before float32 work rounds them.
    """
    part = rows[block]
    narrow = work == np.float32 and part.dtype in (np.float16, np.float32)
    dtype = np.float32 if narrow else np.float64
    return np.ascontiguousarray(part.reshape(len(part), -1).T, dtype=dtype)


def _toward(
    owner: Light | View, points: Array | None, dtype: np.dtype[Any]
) -> tuple[Array, Array | None]:
    """Return unit directions toward a light or eye, and distances: None at infinity.

    float32 points in float32 work: the target is split into two float32 numbers, whose
    differences lose nothing to the distance from the origin.
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
    if dtype == np.float32 and points.dtype == np.float32 and np.isfinite(high).all():
        low = (at - high).astype(np.float32)
        difference = high - points
        if low.any():
            difference += low
        return kernels.unit(difference)
    direction, distance = kernels.unit(at - points)
    return direction.astype(dtype, copy=False), distance.astype(dtype, copy=False)


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
) -> None:
    """Weigh the sums by the material, fade them with depth, write them to the output."""
    scene, number = plan.scene, plan.dtype.type
    material, cue = scene.material, scene.depth_cue
    diffuse, specular = plan.factors
    weights = {
        "diffuse": number(material.diffuse * diffuse),
        "specular": number(material.specular * specular),
    }
    fade: Array | None = None
    if cue is not None:
        assert points is not None
        assert cue.front is not None
        assert cue.back is not None
        fade = falloff.depth_scale(
            view_depth(scene.view, points),
            front=cue.front,
            back=cue.back,
            front_scale=cue.front_scale,
            back_scale=cue.back_scale,
            smooth=cue.smooth,
        ).astype(plan.dtype)
        valid &= np.isfinite(fade)
        fade[~valid] = 1
    spoiled = None if valid.all() else ~valid
    for group in (sums.white, sums.channels):
        for term, value in group.items():
            value *= weights[term]
            if spoiled is not None:
                value[..., spoiled] = 0

    light = output.luminance[block]
    light[:] = number(plan.ambient)
    for value in sums.white.values():
        light += value
    if cue is not None and fade is not None:
        light *= fade
        light += (1 - fade) * number(cue.cue)
    output.valid[block] = valid
    for name, array in (("diffuse", output.diffuse), ("specular", output.specular)):
        if array is not None:
            array[block] = sums.white.get(name, 0)
    if output.rgb is not None:
        parts = sums.channels or sums.white
        colors = {
            "ambient": np.multiply(material.color or WHITE, scene.ambient_color or WHITE),
            "diffuse": material.color or WHITE,
            "specular": material.specular_color or WHITE,
        }
        column = {name: np.array(c, plan.dtype)[:, np.newaxis] for name, c in colors.items()}
        rgb = np.repeat(number(plan.ambient) * column["ambient"], len(valid), axis=1)
        for term, value in parts.items():
            rgb += column[term] * value
        if cue is not None and fade is not None:
            rgb *= fade
            rgb += (1 - fade) * np.array(cue.color or WHITE, plan.dtype)[:, np.newaxis] * cue.cue
        output.rgb[block] = rgb.T


def view_depth(view: View | None, points: Array) -> Array:
    """Return the depth of points: along the view's axis, or from the eye where it has none."""
    assert view is not None
    origin = np.array(view.position or np.zeros(len(points)), dtype=np.float64)[:, np.newaxis]
    if view.direction is None:
        return kernels.length(points - origin)
    axis, _ = kernels.unit(np.array(view.direction, dtype=np.float64)[:, np.newaxis])
    return kernels.dot(axis, origin - points)
