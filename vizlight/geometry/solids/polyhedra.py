"""Solids bounded by planes: half-space, prism, and any closed mesh of triangles."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Bools, Dataset, Foreign, Indices, VectorLike
from vizlight.geometry import axial
from vizlight.geometry.solids import parallel_rays
from vizlight.geometry.solids.exact_surfaces import Surfaces
from vizlight.geometry.solids.primitives import Block, Facets, Primitive, place

__all__ = ["HalfSpace", "Polyhedron", "Prism"]

#: Share of the size below which two facets are on one plane.
SAME_PLANE = 1e-10


class HalfSpace(Primitive):
    """All points behind a plane. A combination with it must be bounded.

    Parameters
    ----------
    point : vector of 3 components, default: (0, 0, 0)
        Point of the plane.
    normal : vector of 3 components, default: (0, 0, 1)
        Direction out of the solid.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid.
    """

    #: Size of the block in place of the half-space, in units of the size of the other primitives.
    REACH = 16.0

    def __init__(
        self, point: VectorLike = (0.0, 0.0, 0.0), normal: VectorLike = (0.0, 0.0, 1.0)
    ) -> None:
        self.point = axial.triple("point", point)
        self.normal = _check.unit("normal", normal)

    @property
    def volume(self) -> float:
        """The volume, which is infinite."""
        return float("inf")

    def block(self) -> Block:
        """Return a large block about the origin with one face in the plane."""
        away = float(self.point @ self.normal)
        # The deeper, the farther its plane is from the origin: the other faces stay clear of the
        # other solids, which are scaled to about the unit ball.
        size = self.REACH + 2 * abs(away)
        axes = np.stack([self.normal, *axial.frame(self.normal)])
        return Block((away - size / 2) * self.normal, (size, size, size), axes=axes)

    def surfaces(self) -> Surfaces:
        """Return the plane, and the other faces of the block in place of the half-space."""
        # The first face of a block is outward along its first axis, which is the normal here.
        return self.block().surfaces()

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> HalfSpace:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        normal = self.normal if turn is None else turn @ self.normal
        return HalfSpace(place(self.point, shift, scale, turn), normal)

    def box(self) -> tuple[Array, float]:
        """Return the point of the plane and an infinite radius."""
        return self.point, float("inf")

    def inside(self, points: Array) -> Bools:
        """Return a mask of the points behind the plane."""
        return np.asarray((points - self.point) @ self.normal < 0)


class Polyhedron(Primitive):
    """A solid bounded by triangles, which are its exact surface.

    Parameters
    ----------
    points : pyvista.PolyData or array_like, shape (P, 3)
        Closed surface, or corners of its triangles.
    triangles : array_like of int, shape (T, 3), optional
        Indices of corners, all counter-clockwise or all clockwise seen from outside. Not used
        with a PyVista mesh, which has its own; faces with more corners are triangulated.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, or if the surface is not closed and consistently oriented.

    Notes
    -----
    Equal points are merged. Triangles must not cross each other, which is not checked.
    """

    def __init__(self, points: ArrayLike | Dataset, triangles: ArrayLike | None = None, /) -> None:
        mesh: Foreign = points
        if triangles is None and hasattr(mesh, "regular_faces"):
            mesh = mesh.triangulate()
            points, triangles = mesh.points, mesh.regular_faces
        elif triangles is None:
            expected = "a pyvista.PolyData, or an array of points and one of triangles"
            remedy = "pass mesh.extract_surface()"
            raise _check.type_error("points", expected, points, remedy)
        _check.vectors("points", points, n=3)
        places = _check.coordinates("points", points)
        if places.ndim != 2:
            raise _check.value_error("points", "shape (P, 3)", places)
        corners = _check.cells("triangles", triangles, len(places), (3,))
        # Many files, as STL, hold a point for each corner of a face, and none of their edges meet
        # before equal points are one.
        unique, which = np.unique(places, axis=0, return_inverse=True)
        faces = which.ravel()[corners].astype(np.intp)
        # Triangles that lost their area by the merging go; the edges beside them then meet.
        faces = faces[np.all(faces != np.roll(faces, 1, axis=1), axis=1)]
        after = np.roll(faces, -1, axis=1)
        # An edge in its direction, and in the other one, as one number each.
        edges, back = faces * len(unique) + after, after * len(unique) + faces
        # Closed and oriented: each directed edge is there once, and once in the other direction.
        if not np.array_equal(np.unique(edges), np.sort(back, axis=None)):
            remedy = "fill its holes, and run mesh.clean() and mesh.compute_normals()"
            expected = "a closed surface with consistently oriented triangles"
            raise _check.value_error("triangles", expected, "another", remedy)
        self.points, self.triangles = unique, faces
        # All triangles are clockwise seen from outside.
        if self.volume < 0:
            self.triangles = np.ascontiguousarray(faces[:, ::-1])

    def __repr__(self) -> str:
        return f"Polyhedron({len(self.points)} points, {len(self.triangles)} triangles)"

    @property
    def volume(self) -> float:
        """The volume."""
        # Tetrahedra from the middle: from an origin far away, huge volumes would cancel.
        corners = self.points[self.triangles] - self.box()[0]
        return float(np.linalg.det(corners).sum()) / 6

    @functools.cached_property
    def _planes(self) -> tuple[Surfaces, Indices]:
        """Return the different planes of the triangles, and the one of each triangle."""
        middle, size = self.box()
        corners = self.points[self.triangles]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = np.linalg.norm(across, axis=1)
        normal = across / np.where(area > 0, area, 1)[:, np.newaxis]
        # In units of the size, as the normal is, so that one threshold serves both.
        offset = np.einsum("ij,ij->i", corners[:, 0] - middle, normal) / (size or 1.0)
        keys = np.round(np.column_stack([normal, offset]) / SAME_PLANE)
        _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        # Any triangle of a plane gives the point on it.
        planes = Surfaces.planes(corners[first, 0], normal[first])
        return planes, which.ravel().astype(np.intp)

    def surfaces(self) -> Surfaces:
        """Return the planes of the triangles."""
        return self._planes[0]

    def facets(self, segments: int) -> Facets:  # noqa: ARG002
        """Return the triangles."""
        return self.points, self.triangles, self._planes[1]

    def count(self, segments: int) -> float:  # noqa: ARG002
        """Return the number of points."""
        return len(self.points)

    def moved(self, shift: Array, scale: float, turn: Array | None = None) -> Polyhedron:
        """Return the solid ``turn @ (x - shift) / scale``, with an optional rotation matrix."""
        # Without the checks: a solid that is moved is as closed and as oriented as it was.
        solid = Polyhedron.__new__(Polyhedron)
        solid.points, solid.triangles = place(self.points, shift, scale, turn), self.triangles
        return solid

    def box(self) -> tuple[Array, float]:
        """Return the centre and the radius of a ball that contains it."""
        if not len(self.points):
            return np.zeros(3), 0.0
        middle = self.points.min(axis=0) / 2 + self.points.max(axis=0) / 2
        return middle, float(np.linalg.norm(self.points - middle, axis=1).max())

    def inside(self, points: Array) -> Bools:
        """Return which points are inside, by the triangles that a ray in z direction crosses.

        Equal corners are one point and each edge is evaluated from its lower corner, so that a ray
        through an edge crosses one of its two triangles.
        """
        up = np.array([0.0, 0.0, 1.0])
        # Without a limit of pairs there is no point at which the search gives up.
        hits = parallel_rays.hits(self.points, self.triangles, points, up, np.inf)
        assert hits is not None
        ray, cell = hits
        a, b, c = self.points[self.triangles[cell]].transpose(1, 0, 2)
        normal = np.cross(b - a, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            # Height above the point at which the upward ray meets the plane of the triangle. One
            # that is vertical has none, and counts as 0 below.
            above = np.einsum("ij,ij->i", a - points[ray], normal) / normal[:, 2] > 0
        # A ray leaves through a face that looks up and enters through one that looks down: the sum
        # is the number of times that the point is enclosed.
        turns = np.bincount(ray[above], np.sign(normal[above, 2]), len(points))
        return np.asarray(turns > 0)


class Prism(Polyhedron):
    """A polygon extruded along the z axis, from z = 0 to its height.

    Parameters
    ----------
    outline : array_like, shape (N, 2)
        Corners of a simple polygon in order, convex or not, without the first corner at the end.
    height : float, default: 1.0
        Height, above 0.

    Raises
    ------
    TypeError, ValueError
        If an argument is not valid, or if the polygon crosses itself.
    """

    def __init__(self, outline: ArrayLike, height: float = 1.0) -> None:
        _check.vectors("outline", outline, n=2)
        corners = _check.coordinates("outline", outline)
        height = _check.number("height", height, low=0.0, high=_check.FARTHEST)
        if corners.ndim != 2 or len(corners) < 3 or not height > 0:
            got = f"{len(corners)} corners and a height of {height:g}"
            raise _check.value_error("outline", "3 corners or more, and a height above 0", got)
        if _crosses(corners):
            remedy = "remove repeated corners and crossings"
            raise _check.value_error("outline", "a simple polygon", "another", remedy)
        # Twice the signed area of the polygon.
        x, y = (corners - corners.mean(axis=0)).T
        if x @ np.roll(y, -1) - y @ np.roll(x, -1) < 0:
            corners = corners[::-1]
        cap = _ears(corners)
        count = len(corners)
        low, after = np.arange(count), np.roll(np.arange(count), -1)
        sides = [
            # Each wall is two triangles.
            np.stack([low, after, after + count], 1),
            np.stack([low, after + count, low + count], 1),
        ]
        points = np.column_stack([np.tile(corners, (2, 1)), np.repeat([0.0, height], count)])
        # The lower cap is seen from below, and runs the other way.
        super().__init__(points, np.concatenate([cap[:, ::-1], cap + count, *sides]))


def _crosses(corners: Array) -> bool:
    """Return whether edges of a polygon cross each other, or a corner is repeated."""
    after = np.roll(corners, -1, axis=0)
    side = [np.array([np.sign(_left(a, b, p)) for a, b in zip(corners, after, strict=True)])
            for p in (corners, after)]  # fmt: skip
    # Row i, column j: whether the ends of edge j are on different sides of the line of edge i.
    apart = side[0] * side[1] < 0
    repeated = len(np.unique(corners, axis=0)) < len(corners)
    return repeated or bool(np.any(apart & apart.T))


def _ears(corners: Array) -> Indices:
    """Return triangles of a counter-clockwise polygon, cut off corner by corner."""
    ring = list(range(len(corners)))
    ears = []
    while len(ring) > 3:
        for i, b in enumerate(ring):
            a, c = ring[i - 1], ring[(i + 1) % len(ring)]
            others = corners[[j for j in ring if j not in (a, b, c)]]
            # At a corner that bends inward, or not at all, there is no ear to cut off.
            if _left(corners[a], corners[b], corners[c][np.newaxis])[0] <= 0:
                continue
            inside = np.ones(len(others), np.bool_)
            # An ear that holds another corner, also on its edge, would cut through the polygon.
            for p, q in ((a, b), (b, c), (c, a)):
                inside &= _left(corners[p], corners[q], others) >= 0
            if not inside.any():
                ears.append((a, b, c))
                del ring[i]
                break
        else:
            remedy = "remove corners in the middle of straight edges"
            raise _check.value_error("outline", "a polygon with an area", "none", remedy)
    return np.array([*ears, tuple(ring)], np.intp)


def _left(start: Array, stop: Array, points: Array) -> Array:
    """Return twice the signed areas of triangles of an edge and points to its left."""
    (x, y), rel = stop - start, points - start
    return np.asarray(x * rel[:, 1] - y * rel[:, 0])
