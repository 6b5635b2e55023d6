"""Solids with surfaces in closed form: sphere, frustum, block and torus, and their combinations.

Each has its exact surfaces and coarse closed facets, of which each is on one of the surfaces.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Bools, Indices, VectorLike
from vizlight.geometry import axial
from vizlight.geometry.solids.exact_surfaces import Surfaces

if TYPE_CHECKING:
    from typing_extensions import Self


__all__ = ["Block", "Boolean", "Frustum", "Primitive", "Solid", "Sphere", "Torus"]

#: Description of a solid in error messages.
EXPECTED = "a vizlight.Sphere, Frustum, Block or another solid, or a combination of them"


#: Points of facets, indices of their corners, counter-clockwise seen from outside, and the index of
#: the surface of each.
Facets: TypeAlias = tuple[Array, Indices, Indices]


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

    def inside(self, points: Array) -> Bools:
        """Return which points are inside the solid."""
        raise NotImplementedError

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Self:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        raise NotImplementedError

    def translate(self, xyz: VectorLike, /) -> Solid:
        """Return the solid moved by a vector.

        Parameters
        ----------
        xyz : vector of 3 components
            Displacement, in the unit of the solid.
        """
        # The frame of `moved` goes the other way than the solid.
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
        # The point becomes the origin, about which the solid is scaled, and is then put back.
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
        from scipy.spatial.transform import Rotation

        turned = math.radians(_check.number("angle", angle)) * _check.unit("vector", vector)
        turn = Rotation.from_rotvec(turned).as_matrix()
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
            raise _check.value_error("points", "shape (N, 3)", places)
        return self.inside(places)


class Primitive(Solid):
    """A solid that is not a combination of others."""

    @property
    def roundness(self) -> float:
        """Largest radius of its curved surfaces; 0 if all are planes."""
        return 0.0

    def __repr__(self) -> str:
        parts = (f"{name}={np.asarray(value).tolist()}" for name, value in vars(self).items())
        return f"{type(self).__name__}({', '.join(parts)})"

    def surfaces(self) -> Surfaces:
        """Return the surfaces that bound the solid."""
        raise NotImplementedError

    def facets(self, segments: int) -> Facets:
        """Return coarse closed facets, with so many segments to a circle."""
        raise NotImplementedError

    def count(self, segments: int) -> float:
        """Return the largest number of points of the facets, approximately."""
        return 2 * segments

    def missed(self, segments: int, volume: float) -> float:  # noqa: ARG002
        """Return a bound of the volume between the surfaces and facets of a given volume."""
        # The number added covers the rounding of sums, in a solid of about unit size.
        return abs(self.volume - volume) + 1e-14

    def box(self) -> tuple[Array, float]:
        """Return the centre of the solid and the radius of a ball around it that contains it."""
        raise NotImplementedError

    @property
    def empty(self) -> bool:
        """Whether the solid has no volume."""
        middle, size = self.box()
        # Of about unit size no volume is below the smallest number.
        return size == 0 or self.moved(middle, size).volume == 0

    @property
    def volume(self) -> float:
        """The volume."""
        raise NotImplementedError

    def primitives(self) -> Iterator[Primitive]:
        """Yield the primitive itself."""
        yield self

    def inside(self, points: Array) -> Bools:
        """Return which points are inside all surfaces, as for a convex solid."""
        if self.empty:
            return np.zeros(len(points), np.bool_)
        # Surfaces go on beyond their faces: the planes of its ends bound the cone of a frustum.
        surfaces = self.surfaces()
        sides = [surfaces.distance(points, i) < 0 for i in range(len(surfaces))]
        return np.asarray(np.all(sides, axis=0))


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
        remedy = "make a solid of a closed mesh by vizlight.Polyhedron(mesh)"
        for name, solid in (("first", self.first), ("second", self.second)):
            _check.instance(name, solid, Solid, EXPECTED, remedy=remedy)

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Boolean:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        first, second = (x.moved(shift, scale, turn) for x in (self.first, self.second))
        return Boolean(self.operation, first, second)

    def primitives(self) -> Iterator[Primitive]:
        """Yield the primitives of both solids."""
        yield from self.first.primitives()
        yield from self.second.primitives()

    def inside(self, points: Array) -> Bools:
        """Return which points are inside the combination."""
        first, second = self.first.inside(points), self.second.inside(points)
        if self.operation == "union":
            return first | second
        return first & (second if self.operation == "intersection" else ~second)


def place(points: Array, shift: Array, scale: float, turn: Array | None) -> Array:
    """Return ``turn @ (x - shift) / scale`` of points, with an optional rotation matrix."""
    moved = (points - shift) / scale
    return np.asarray(moved if turn is None else moved @ turn.T)


def _turned(profile: Array, axis: Array, segments: int, *, closed: bool) -> Facets:
    """Return the facets of a profile of radii and heights that turns about an axis.

    The number of the profile's segment takes the place of the surface of each.
    """
    ring = axial.circle(2 * np.pi * np.arange(segments) / segments, *axial.frame(axis))
    radius, height = profile.T[:, :, np.newaxis, np.newaxis]
    points = radius * ring + height * axis
    number = np.arange(points[..., 0].size).reshape(points.shape[:2])
    # A place on the axis is one point, and places of the profile that are equal have the same ones.
    number[profile[:, 0] == 0] = number[profile[:, 0] == 0][:, :1]
    for i in range(1, len(profile)):
        if np.array_equal(profile[i], profile[i - 1]):
            number[i] = number[i - 1]
    below = np.roll(number, -1, axis=0)
    if not closed:
        number, below = number[:-1], below[:-1]
    beside, across = np.roll(number, -1, axis=1), np.roll(below, -1, axis=1)
    corners = np.array([[number, below, across], [number, across, beside]])
    triangles = np.moveaxis(corners, 1, -1).reshape(-1, 3)
    part = np.broadcast_to(np.arange(len(number))[:, np.newaxis], corners[:, 0].shape).ravel()
    # On the axis one of the two triangles of each segment has no area.
    there = np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)
    return points.reshape(-1, 3), triangles[there], part[there]


#: Corners of the faces of a block, x before y before z, the side of larger coordinates first.
_FACES = (
    (7, 5, 4, 6), (2, 0, 1, 3), (7, 6, 2, 3), (1, 0, 4, 5), (7, 3, 1, 5), (4, 0, 2, 6),
)  # fmt: skip


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

    @property
    def roundness(self) -> float:
        """The radius."""
        return self.radius

    @property
    def volume(self) -> float:
        """The volume."""
        return 4 * math.pi / 3 * self.radius**3

    def surfaces(self) -> Surfaces:
        """Return the surface of the ball."""
        return Surfaces.round(self.center, np.array([0.0, 0, 1]), 0.0, self.radius)

    def count(self, segments: int) -> float:
        """Return the number of points of the facets: one on 0.85 of a segment's square."""
        return max(4 * math.pi / (0.85 * (2 * math.pi / segments) ** 2), 12.0)

    def facets(self, segments: int) -> Facets:
        """Return the hull of points that are spread evenly along a spiral of the golden angle."""
        from scipy.spatial import ConvexHull

        count = int(self.count(segments))
        i = np.arange(count) + 0.5
        # Equal steps of the height are equal areas of a sphere; half steps leave the poles free.
        z = 1 - 2 * i / count
        ring = axial.circle(i * np.pi * (3 - math.sqrt(5)), *np.eye(3)[:2])
        points = np.sqrt(1 - z * z)[:, np.newaxis] * ring + np.outer(z, [0, 0, 1])
        # The hull of points on a sphere is their Delaunay triangulation.
        triangles = ConvexHull(points).simplices.astype(np.intp)
        # Qhull gives the corners of its triangles in any order.
        inward = np.linalg.det(points[triangles]) < 0
        triangles[inward] = triangles[inward][:, ::-1]
        return self.center + self.radius * points, triangles, np.zeros(len(triangles), np.intp)

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Sphere:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        return Sphere(place(self.center, shift, scale, turn), self.radius / scale)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius."""
        return self.center, self.radius


class Frustum(Primitive):
    """A conical frustum with both ends, or its limits: cone, cylinder, disc and rod.

    The source calls this shape a truncus.

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
            raise _check.value_error("axis", "a vector of non-zero length", along, remedy)
        self.axis = _check.unit("axis", axis)
        self.height = (
            math.hypot(*along) if height is None else _check.number("height", height, low=0.0)
        )
        ends = _check.floats("radii", radii)
        if ends.shape != (2,):
            raise _check.value_error("radii", "two radii (R1, R2)", _check.describe(radii))
        first, second = (_check.number("radii", float(x), low=0.0) for x in ends)
        self.radii = (first, second)

    @property
    def roundness(self) -> float:
        """The larger radius."""
        return max(self.radii)

    @property
    def volume(self) -> float:
        """The volume."""
        a, b = self.radii
        return math.pi / 3 * self.height * (a * a + a * b + b * b)

    def surfaces(self) -> Surfaces:
        """Return the side, the first end and the second end."""
        side = Surfaces.cone(self.center, self.axis, self.height, self.radii)
        ways = np.outer([1, -1], self.axis)
        ends = Surfaces.planes(self.center + self.height / 2 * ways, ways)
        return Surfaces(np.concatenate([side.rows, ends.rows]))

    def facets(self, segments: int) -> Facets:
        """Return the ends as fans about their middles, and the side between them."""
        radius, height = [0, *self.radii, 0], self.height / 2 * np.array([1, 1, -1, -1])
        profile = np.stack([radius, height], axis=1)
        points, triangles, part = _turned(profile, self.axis, segments, closed=False)
        return self.center + points, triangles, np.array([1, 0, 2])[part]

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Frustum:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        radii = np.array(self.radii) / scale
        center = place(self.center, shift, scale, turn)
        axis = self.axis if turn is None else turn @ self.axis
        return Frustum(center, axis, radii, height=self.height / scale)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of the smallest ball around it."""
        return self.center, math.hypot(self.height / 2, max(self.radii))


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
            raise _check.value_error("size", "lengths of 0 or more", _check.describe(size))
        rows = np.asarray(_check.vectors("axes", np.eye(3) if axes is None else axes, n=3), float)
        # Rows that were computed in float32 pass.
        if rows.shape != (3, 3) or not np.allclose(rows @ rows.T, np.eye(3), atol=1e-6):
            expected, remedy = "3 orthonormal rows", "orthonormalise them"
            raise _check.value_error("axes", expected, _check.describe(axes), remedy)
        self.axes = rows

    @property
    def volume(self) -> float:
        """The volume."""
        return float(np.prod(self.size))

    def surfaces(self) -> Surfaces:
        """Return the six faces, two across each axis."""
        ways = np.repeat(self.axes, 2, axis=0) * np.tile([[1.0], [-1.0]], (3, 1))
        return Surfaces.planes(
            self.center + np.repeat(self.size / 2, 2)[:, np.newaxis] * ways, ways
        )

    def facets(self, segments: int) -> Facets:  # noqa: ARG002
        """Return two triangles for each face."""
        signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
        faces = np.array(_FACES, np.intp)
        # Left-handed axes are a mirror image, which turns all faces inward.
        if np.linalg.det(self.axes) < 0:
            faces = faces[:, ::-1]
        triangles = faces[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
        points = self.center + (signs * self.size / 2) @ self.axes
        return points, triangles, np.repeat(np.arange(6), 2)

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Block:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        axes = self.axes if turn is None else self.axes @ turn.T
        return Block(place(self.center, shift, scale, turn), self.size / scale, axes=axes)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of the smallest ball around it."""
        return self.center, math.hypot(*self.size) / 2


class Torus(Primitive):
    """A ring with a circular cross-section.

    Parameters
    ----------
    center : vector of 3 components, default: (0, 0, 0)
        Centre.
    axis : vector of 3 components, default: (0, 0, 1)
        Direction of the axis of rotation.
    ring_radius : float, default: 0.5
        Distance of the centre of the cross-section from the axis.
    tube_radius : float, default: 0.25
        Radius of the cross-section, below ``ring_radius``; a torus of tube radius 0 is empty.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    def __init__(
        self,
        center: VectorLike = (0.0, 0.0, 0.0),
        axis: VectorLike = (0.0, 0.0, 1.0),
        ring_radius: float = 0.5,
        tube_radius: float = 0.25,
    ) -> None:
        self.center = axial.triple("center", center)
        self.axis = _check.unit("axis", axis)
        self.ring_radius = _check.number("ring_radius", ring_radius, low=0.0)
        self.tube_radius = _check.number("tube_radius", tube_radius, low=0.0)
        # A tube as wide as its ring would meet itself on the axis.
        if self.tube_radius >= self.ring_radius:
            expected = f"a radius below ring_radius={self.ring_radius:g}"
            raise _check.value_error("tube_radius", expected, self.tube_radius)

    @property
    def roundness(self) -> float:
        """The largest radius of the ring."""
        return self.ring_radius + self.tube_radius

    @property
    def volume(self) -> float:
        """The volume."""
        return 2 * math.pi**2 * self.ring_radius * self.tube_radius**2

    def surfaces(self) -> Surfaces:
        """Return the surface of the ring."""
        return Surfaces.round(self.center, self.axis, self.ring_radius, self.tube_radius)

    def count(self, segments: int) -> float:
        """Return the largest number of points of the facets."""
        return segments**2

    def _across(self, segments: int) -> int:
        """Return the number of segments of the cross-section."""
        # The sagitta is r / n^2 but for a factor: it becomes the same around the tube as around
        # the ring.
        return max(12, math.ceil(segments * math.sqrt(self.tube_radius / self.roundness)))

    def facets(self, segments: int) -> Facets:
        """Return rows of triangles around the ring and the tube."""
        rows = self._across(segments)
        # The outside is at the left hand of the profile.
        angle = -2 * np.pi * np.arange(rows) / rows
        profile = self.tube_radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        profile[:, 0] += self.ring_radius
        points, triangles, part = _turned(profile, self.axis, segments, closed=True)
        return self.center + points, triangles, np.zeros_like(part)

    def missed(self, segments: int, volume: float) -> float:  # noqa: ARG002
        """Return the volume of a shell about the surface that holds all facets.

        Linear interpolation of a function of two angles u and v misses at most
        ``(u^2 |f_uu| + 2 u v |f_uv| + v^2 |f_vv|) / 8`` for steps u and v.
        """
        u, v = 2 * math.pi / segments, 2 * math.pi / self._across(segments)
        error = (u * u * self.roundness + (2 * u * v + v * v) * self.tube_radius) / 8
        # On both sides of the area 4 pi^2 R r.
        return 8 * math.pi**2 * self.ring_radius * self.tube_radius * error

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Torus:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        axis = self.axis if turn is None else turn @ self.axis
        center = place(self.center, shift, scale, turn)
        return Torus(center, axis, self.ring_radius / scale, self.tube_radius / scale)

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of the smallest ball around it."""
        return self.center, self.roundness
