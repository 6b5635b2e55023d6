"""Base classes of solids: what combines, moves and contains points."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from vizlight import _check
from vizlight.geometry import axial

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import ArrayLike

    from vizlight._types import Array, Bools, VectorLike
    from vizlight.geometry.solids.exact_surfaces import Surface


#: Description of a solid in error messages.
EXPECTED = "a vizlight.Sphere, Frustum, Block or another solid, or a combination of them"


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
        """Yield the primitives from left to right."""
        raise NotImplementedError

    def combine(self, inside: Iterator[Bools]) -> Bools:
        """Return which points are inside, given the same for each primitive in their order."""
        raise NotImplementedError

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Solid:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        raise NotImplementedError

    def translate(self, xyz: VectorLike, /) -> Solid:
        """Return the solid moved by a vector.

        Parameters
        ----------
        xyz : vector of 3 components
            Displacement, in the unit of the solid.
        """
        return self.moved(-axial.triple("xyz", xyz), 1.0)

    def scale(self, factor: float, /, *, point: VectorLike = (0.0, 0.0, 0.0)) -> Solid:
        """Return the solid scaled uniformly about a point.

        Parameters
        ----------
        factor : float
            Ratio of new lengths to old ones, from 1e-100 to 1e100.
        point : vector of 3 components, default: (0, 0, 0)
            Point that stays where it is.
        """
        factor = _check.positive("factor", factor, high=_check.FARTHEST)
        factor = _check.number("factor", factor, low=1 / _check.FARTHEST)
        middle = _check.coordinates("point", axial.triple("point", point))
        return self.moved(middle, 1 / factor).moved(-middle, 1.0)

    def rotate_vector(
        self, vector: VectorLike, angle: float, /, *, point: VectorLike = (0.0, 0.0, 0.0)
    ) -> Solid:
        """Return the solid rotated about an axis.

        Parameters
        ----------
        vector : vector of 3 components
            Direction of the axis.
        angle : float
            Angle in degrees, as in PyVista; counter-clockwise seen against the direction.
        point : vector of 3 components, default: (0, 0, 0)
            Point of the axis.
        """
        axis = _check.unit("vector", vector)
        angle = math.radians(_check.number("angle", angle))
        cross = np.cross(np.eye(3), axis)
        turn = np.eye(3) + math.sin(angle) * cross + 2 * math.sin(angle / 2) ** 2 * cross @ cross
        middle = _check.coordinates("point", axial.triple("point", point))
        return self.moved(middle, 1.0, turn).moved(-middle, 1.0)

    def rotate_x(self, angle: float, /, *, point: VectorLike = (0.0, 0.0, 0.0)) -> Solid:
        """Return the solid rotated about the x direction, by an angle in degrees."""
        return self.rotate_vector((1.0, 0.0, 0.0), angle, point=point)

    def rotate_y(self, angle: float, /, *, point: VectorLike = (0.0, 0.0, 0.0)) -> Solid:
        """Return the solid rotated about the y direction, by an angle in degrees."""
        return self.rotate_vector((0.0, 1.0, 0.0), angle, point=point)

    def rotate_z(self, angle: float, /, *, point: VectorLike = (0.0, 0.0, 0.0)) -> Solid:
        """Return the solid rotated about the z direction, by an angle in degrees."""
        return self.rotate_vector((0.0, 0.0, 1.0), angle, point=point)

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
        if places.ndim != 2:
            raise ValueError(_check.message("points", "shape (N, 3)", places))
        return self.combine(iter([solid.inside(places) for solid in self.primitives()]))


class Primitive(Solid):
    """A solid that is not a combination of others."""

    #: Largest radius of its curved surfaces; 0 if all are planes.
    roundness: float = 0.0

    def surfaces(self) -> tuple[Surface, ...]:
        """Return the surfaces that bound the solid."""
        raise NotImplementedError

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Primitive:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
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
        """Return which points are inside all surfaces, as for a convex solid."""
        if self.empty:
            return np.zeros(len(points), np.bool_)
        found = np.ones(len(points), np.bool_)
        for surface in self.surfaces():
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
        _check.choice("operation", self.operation, ("union", "intersection", "difference"))
        given: tuple[tuple[str, object], ...] = (("first", self.first), ("second", self.second))
        for name, solid in given:
            if not isinstance(solid, Solid):
                remedy = "make a solid of a closed mesh by vizlight.Polyhedron(mesh)"
                raise TypeError(_check.message(name, EXPECTED, _check.describe(solid), remedy))

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Boolean:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        first, second = (x.moved(shift, scale, turn) for x in (self.first, self.second))
        return Boolean(self.operation, first, second)

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


def place(points: Array, shift: Array, scale: float, turn: Array | None) -> Array:
    """Return ``turn @ (x - shift) / scale`` of points, with an optional rotation matrix."""
    moved = (points - shift) / scale
    return np.asarray(moved if turn is None else moved @ turn.T)
