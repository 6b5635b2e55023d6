"""Solids: sphere, frustum and block, and their union, intersection and difference.

A solid is the region inside all of its surfaces, or a combination of two solids.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from vizlight import _check
from vizlight.geometry import axial
from vizlight.geometry.solids.exact_surfaces import Ball, Cone, Plane

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, VectorLike
    from vizlight.geometry.solids.exact_surfaces import Surface


__all__ = ["Block", "Boolean", "Frustum", "Primitive", "Solid", "Sphere", "Truncus"]

#: Description of a solid in error messages.
EXPECTED = "a vizlight.Sphere, Frustum, Block or a combination of them"


class Solid:
    """Base class of solids, which combine by ``a | b``, ``a & b`` and ``a - b`` to any depth."""

    def __or__(self, other: Solid) -> Boolean:
        """Return the union."""
        return Boolean("union", self, other)

    def __and__(self, other: Solid) -> Boolean:
        """Return the intersection."""
        return Boolean("intersection", self, other)

    def __sub__(self, other: Solid) -> Boolean:
        """Return the difference."""
        return Boolean("difference", self, other)

    def primitives(self) -> Iterator[Primitive]:
        """Yield the spheres, frusta and blocks from left to right."""
        raise NotImplementedError

    def combine(self, inside: Iterator[Bools]) -> Bools:
        """Return which points are inside, given the same for each primitive in their order."""
        raise NotImplementedError

    def contains(self, points: ArrayLike, /) -> Bools:
        """Return which points are inside the solid.

        Parameters
        ----------
        points : array_like, shape (N, 3)
            Positions, in the unit of the solid.

        Returns
        -------
        ndarray of bool, shape (N,)
            Results of analytic tests; for a point on a surface either value is possible.
        """
        places = np.asarray(_check.vectors("points", points, n=3), dtype=np.float64)
        return self.combine(iter([solid.inside(places) for solid in self.primitives()]))


class Primitive(Solid):
    """A convex solid: the region inside all of its surfaces."""

    def surfaces(self) -> tuple[Surface, ...]:
        """Return the surfaces that bound the solid."""
        raise NotImplementedError

    @functools.cached_property
    def _faces(self) -> tuple[Surface, ...]:
        return self.surfaces()

    def moved(self, shift: Array, scale: float) -> Primitive:
        """Return the solid ``(x - shift) / scale``."""
        raise NotImplementedError

    def box(self) -> tuple[Array, float]:
        """Return the centre of the solid and the radius of a ball around it that contains it."""
        raise NotImplementedError

    @property
    def empty(self) -> bool:
        """Whether the solid has no volume."""
        raise NotImplementedError

    @property
    def volume(self) -> float:
        """The volume."""
        raise NotImplementedError

    def primitives(self) -> Iterator[Primitive]:
        """Yield the primitive itself."""
        yield self

    def combine(self, inside: Iterator[Bools]) -> Bools:
        """Return the next item."""
        return next(inside)

    def inside(self, points: Array) -> Bools:
        """Return which points are inside all surfaces."""
        if self.empty:
            return np.zeros(len(points), np.bool_)
        found = np.ones(len(points), np.bool_)
        for surface in self._faces:
            found &= surface.distance(points) < 0
        return found


@dataclass(frozen=True)
class Boolean(Solid):
    """A combination of two solids.

    Parameters
    ----------
    operation : {"union", "intersection", "difference"}
        Set operation; a difference is the first solid without the second.
    first, second : Solid
        Solids to combine.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    operation: Literal["union", "intersection", "difference"]
    first: Solid
    second: Solid

    def __post_init__(self) -> None:
        if self.operation not in ("union", "intersection", "difference"):
            expected = "'union', 'intersection' or 'difference'"
            raise ValueError(_check.message("operation", expected, repr(self.operation)))
        for name, solid in (("first", self.first), ("second", self.second)):
            if not isinstance(solid, Solid):
                raise TypeError(_check.message(name, EXPECTED, _check.describe(solid)))

    def primitives(self) -> Iterator[Primitive]:
        """Yield the primitives of both solids."""
        yield from self.first.primitives()
        yield from self.second.primitives()

    def combine(self, inside: Iterator[Bools]) -> Bools:
        """Combine the results of both solids."""
        first, second = self.first.combine(inside), self.second.combine(inside)
        if self.operation == "union":
            return first | second
        if self.operation == "intersection":
            return first & second
        return first & ~second


class Sphere(Primitive):
    """A ball.

    Parameters
    ----------
    center : vector of 3 components, default: (0, 0, 0)
        Centre.
    radius : float, default: 1.0
        Radius, 0 or more; a sphere of radius 0 is empty.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    def __init__(self, center: VectorLike = (0.0, 0.0, 0.0), radius: float = 1.0) -> None:
        self.center = axial.triple("center", center)
        self.radius = _check.number("radius", radius, low=0.0)

    def __repr__(self) -> str:
        return f"Sphere({tuple(map(float, self.center))}, {self.radius:g})"

    @property
    def empty(self) -> bool:
        """Whether the solid has no volume."""
        return self.radius == 0

    @property
    def volume(self) -> float:
        """The volume."""
        return 4 * math.pi / 3 * self.radius**3

    def surfaces(self) -> tuple[Surface, ...]:
        """Return the surface of the ball."""
        return (Ball(self.center, self.radius),)

    def moved(self, shift: Array, scale: float) -> Sphere:
        """Return the solid ``(x - shift) / scale``."""
        return Sphere((self.center - shift) / scale, self.radius / scale)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius."""
        return self.center, self.radius


class Frustum(Primitive):
    """A conical frustum with both ends, or its limits: cone, cylinder, disc and rod.

    The source calls this shape a truncus; ``Truncus`` is another name of this class.

    Parameters
    ----------
    center : vector of 3 components, default: (0, 0, 0)
        Midpoint of the axis.
    axis : vector of 3 components, default: (0, 0, 1)
        Direction from the second end to the first. Its length is the height unless ``height``
        is given.
    radii : (float, float), default: (0.5, 0.5)
        Radii R1 at ``center + axis / 2`` and R2 at ``center - axis / 2``, 0 or more.
    height : float, optional
        Height, 0 or more; a frustum of height 0 is empty.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    def __init__(
        self,
        center: VectorLike = (0.0, 0.0, 0.0),
        axis: VectorLike = (0.0, 0.0, 1.0),
        radii: VectorLike = (0.5, 0.5),
        *,
        height: float | None = None,
    ) -> None:
        self.center = axial.triple("center", center)
        along = axial.triple("axis", axis)
        if not np.any(along):
            remedy = "pass its direction, and height=0 for a disc without thickness"
            raise ValueError(_check.message("axis", "a vector of non-zero length", along, remedy))
        self.axis = axial.unit("axis", axis)
        self.height = (
            axial.length(along) if height is None else _check.number("height", height, low=0.0)
        )
        given = _check.floats("radii", radii)
        if given.shape != (2,):
            raise ValueError(_check.message("radii", "two radii (R1, R2)", _check.describe(radii)))
        first, second = (_check.number("radii", float(x), low=0.0) for x in given)
        self.radii = (first, second)

    def __repr__(self) -> str:
        middle, axis = (tuple(map(float, v)) for v in (self.center, self.axis))
        return f"Frustum({middle}, {axis}, {self.radii}, height={self.height:g})"

    @property
    def empty(self) -> bool:
        """Whether the solid has no volume."""
        return self.height == 0 or max(self.radii) == 0

    @property
    def volume(self) -> float:
        """The volume."""
        a, b = self.radii
        return math.pi / 3 * self.height * (a * a + a * b + b * b)

    def surfaces(self) -> tuple[Surface, ...]:
        """Return the side, the first end and the second end."""
        side = Cone(self.center, self.axis, self.height, self.radii)
        ends = (
            Plane(self.center + s / 2 * self.height * self.axis, s * self.axis) for s in (1, -1)
        )
        return (side, *ends)

    def moved(self, shift: Array, scale: float) -> Frustum:
        """Return the solid ``(x - shift) / scale``."""
        radii = np.array(self.radii) / scale
        return Frustum((self.center - shift) / scale, self.axis, radii, height=self.height / scale)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of the smallest ball around it."""
        return self.center, math.hypot(self.height / 2, max(self.radii))


#: The source's word for :class:`Frustum`.
Truncus = Frustum


class Block(Primitive):
    """A rectangular block.

    Parameters
    ----------
    center : vector of 3 components, default: (0, 0, 0)
        Centre.
    size : vector of 3 components, default: (1, 1, 1)
        Lengths of the edges, 0 or more; a block with an edge of length 0 is empty.
    axes : array_like, shape (3, 3), optional
        Orthonormal rows along the edges. Default: the x, y and z axes.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    def __init__(
        self,
        center: VectorLike = (0.0, 0.0, 0.0),
        size: VectorLike = (1.0, 1.0, 1.0),
        *,
        axes: ArrayLike | None = None,
    ) -> None:
        self.center = axial.triple("center", center)
        self.size = axial.triple("size", size)
        if np.any(self.size < 0):
            raise ValueError(_check.message("size", "lengths of 0 or more", _check.describe(size)))
        self.axes = (
            np.eye(3) if axes is None else np.asarray(_check.vectors("axes", axes, n=3), float)
        )
        if self.axes.shape != (3, 3) or not np.allclose(
            self.axes @ self.axes.T, np.eye(3), atol=1e-6
        ):
            remedy = "orthonormalise them"
            raise ValueError(
                _check.message("axes", "3 orthonormal rows", _check.describe(axes), remedy)
            )

    def __repr__(self) -> str:
        middle, size = (tuple(map(float, v)) for v in (self.center, self.size))
        return f"Block({middle}, {size})"

    @property
    def empty(self) -> bool:
        """Whether the solid has no volume."""
        return bool(np.any(self.size == 0))

    @property
    def volume(self) -> float:
        """The volume."""
        return float(np.prod(self.size))

    def surfaces(self) -> tuple[Surface, ...]:
        """Return the six faces."""
        found = []
        for i in range(3):
            for sign in (1, -1):
                center = self.center + sign * self.size[i] / 2 * self.axes[i]
                found.append(Plane(center, sign * self.axes[i]))
        return tuple(found)

    def moved(self, shift: Array, scale: float) -> Block:
        """Return the solid ``(x - shift) / scale``."""
        return Block((self.center - shift) / scale, self.size / scale, axes=self.axes)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of the smallest ball around it."""
        return self.center, axial.length(self.size) / 2
