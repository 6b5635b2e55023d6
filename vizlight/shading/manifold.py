"""The manifold at a block of points: how it splits directions, its diffuse and specular factor."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from vizlight.model import cylinder_kernels, kernels

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Vector
    from vizlight.shading.plan import Highlight


class Split(NamedTuple):
    """A direction at the manifold: the vector, its tangential and its normal part."""

    vector: Array
    along: Array
    across: Array


class Pair(NamedTuple):
    """Light and eye at the manifold; no eye where no term needs its split."""

    lit: Split
    eye: Split | None
    met: cylinder_kernels.NormalParts | None = None


class Manifold(Protocol):
    """What a block of points is lit as."""

    good: Bools

    def split(self, x: Array) -> Split:
        """Split a unit direction."""

    def pair(self, lit: Split, eye: Split | None) -> Pair:
        """Return light and eye together, with what both terms need of them."""

    def diffuse(self, pair: Pair, exponent: float) -> Array:
        """Return the diffuse factor."""

    def specular(self, pair: Pair, highlight: Highlight) -> Array:
        """Return the specular factor."""


class Tangents:
    """A k-manifold given by its tangents, good where they are independent; it has no sides."""

    def __init__(self, frame: Array, good: Bools) -> None:
        self.frame, self.good = frame, good

    def split(self, x: Array) -> Split:
        """Split a unit direction."""
        return Split(x, *kernels.split(x, self.frame))

    def pair(self, lit: Split, eye: Split | None) -> Pair:
        """Return light and eye together."""
        return Pair(lit, eye)

    def diffuse(self, pair: Pair, exponent: float) -> Array:
        """Return the diffuse factor."""
        return kernels.diffuse(pair.lit.across, exponent, pair.lit.along)

    def specular(self, pair: Pair, highlight: Highlight) -> Array:
        """Return the specular factor."""
        lit, eye, shininess = pair.lit, pair.eye, highlight.shininess
        if highlight.half is not None:
            along = kernels.coefficients(column(highlight.half, self.frame), self.frame)
            return kernels.blinn_of_unit(kernels.dot(along, along), shininess)
        assert eye is not None
        if highlight.model == "phong":
            along = lit.along + eye.along
            return kernels.phong(kernels.dot(along, along), lit.across, eye.across, shininess)
        assert highlight.model == "blinn", highlight.model
        along, across = kernels.split(lit.vector + eye.vector, self.frame)
        return kernels.blinn(kernels.dot(along, along), across * across, shininess)


class Line:
    """A line in 3-space as a thin cylinder; the vector of a split is its normal part."""

    def __init__(self, frame: Array, good: Bools) -> None:
        self.tangent, self.good = frame[0], good

    def split(self, x: Array) -> Split:
        """Split a unit direction."""
        along, rest, across = cylinder_kernels.across(x, self.tangent)
        return Split(rest, along, across)

    def pair(self, lit: Split, eye: Split | None) -> Pair:
        """Return light and eye together, as the plane across the line shows them."""
        assert eye is not None
        met = cylinder_kernels.meet(lit.vector, lit.across, eye.vector, eye.across, self.tangent)
        return Pair(lit, eye, met)

    def diffuse(self, pair: Pair, exponent: float) -> Array:  # noqa: ARG002 - it has none
        """Return the diffuse factor."""
        assert pair.met is not None
        return cylinder_kernels.diffuse(pair.met)

    def specular(self, pair: Pair, highlight: Highlight) -> Array:
        """Return the specular factor."""
        assert pair.eye is not None
        assert pair.met is not None
        along = pair.lit.along + pair.eye.along
        return cylinder_kernels.specular(pair.met, along * along, highlight.shininess)


class Surface:
    """An (n - 1)-manifold given by its unit normals, lit on one side or on both.

    The tangential part is kept as the rest of the vector, and only where it is needed.
    """

    def __init__(self, normal: Array, good: Bools, *, two_sided: bool) -> None:
        self.normal, self.good = normal, good
        self.two_sided = two_sided

    def side(self, cosine: Array) -> Array:
        """Return the cosine clamped to the lit side or sides."""
        return np.abs(cosine) if self.two_sided else np.maximum(cosine, 0)

    def split(self, x: Array) -> Split:
        """Split a unit direction."""
        return Split(x, x, kernels.dot(self.normal, x))

    def pair(self, lit: Split, eye: Split | None) -> Pair:
        """Return light and eye together."""
        return Pair(lit, eye)

    def cosine(self, x: Array) -> Array:
        """Return the cosine of a unit direction to the normal."""
        return kernels.dot(self.normal, x)

    def diffuse(self, pair: Pair, exponent: float) -> Array:
        """Return the diffuse factor."""
        return kernels.power(self.side(pair.lit.across), exponent)

    def specular(self, pair: Pair, highlight: Highlight) -> Array:
        """Return the specular factor."""
        lit, eye, shininess = pair.lit, pair.eye, highlight.shininess
        if highlight.half is not None:
            return self._cut(lit, self._fixed_half(highlight.half, shininess))
        assert eye is not None
        tangential, up = self._half(lit, eye)
        if highlight.model == "phong":
            cosines = (lit.across, eye.across)
            if self.two_sided:
                cosines = (np.abs(lit.across), np.abs(eye.across))
            return self._cut(lit, kernels.phong(tangential, *cosines, shininess))
        assert highlight.model == "blinn", highlight.model
        up = self.side(up)
        return self._cut(lit, kernels.blinn(tangential, up * up, shininess))

    def _fixed_half(self, half: Vector, shininess: float) -> Array:
        vector = column(half, self.normal)
        cosine = kernels.dot(self.normal, vector)
        if shininess <= kernels.DEFICIT_FROM:
            return kernels.power(self.side(cosine), shininess)
        rest = vector - cosine * self.normal
        value = kernels.blinn_of_unit(kernels.dot(rest, rest), shininess)
        return value if self.two_sided else value * (cosine > 0)

    def _half(self, lit: Split, eye: Split) -> tuple[Array, Array]:
        """Return |(wi + wo)_T|^2 and (wi + wo) . N."""
        half = lit.vector + eye.vector
        up = kernels.dot(self.normal, half)
        rest = half - up * self.normal
        return kernels.dot(rest, rest), up

    def _cut(self, lit: Split, value: Array) -> Array:
        """Remove the highlight from the side that the light does not reach."""
        return value if self.two_sided else value * (lit.across > 0)


def column(vector: Vector, like: Array) -> Array:
    """Return one vector as a batch of one that broadcasts, in the precision of another array."""
    return np.array(vector, dtype=like.dtype)[:, np.newaxis]
