"""One closed mesh of solids combined by union, intersection and difference.

Coarse meshes of the primitives are combined by manifold3d, which keeps the exact surface that each
triangle came from. The points are then moved onto their exact surfaces.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from vizlight import _check
from vizlight._types import Array, Bools, Indices
from vizlight.geometry.solids import triangle_mesh
from vizlight.geometry.solids.exact_surfaces import Surfaces, onto
from vizlight.geometry.solids.polyhedra import HalfSpace
from vizlight.geometry.solids.primitives import EXPECTED, Boolean, Primitive, Solid, Sphere
from vizlight.geometry.solids.triangle_mesh import Mesh

if TYPE_CHECKING:
    import manifold3d

#: Largest number of points of all primitives together.
MOST = 400_000
#: That number where finer facets are tried, which keep thin walls between surfaces: the points
#: of a unit sphere whose facets are 5e-5 from it.
PATIENCE = 60_000
#: Fewest segments of a circle.
FEWEST = 24
#: Grid of coordinates before a Boolean operation, so that equal places have equal coordinates.
GRID = 2.0**36
#: Distance by which coordinates are rounded, with a margin for the points where surfaces cross.
ROUNDING = 4 / GRID
#: Inverse of the distance below which surfaces are one surface.
EQUAL = 1e10
#: Largest share of the volume that may be missing between triangles and exact surfaces, in units of
#: the tolerance: a ball of radius r misses the share 3 / r of the distance of its facets, and a
#: primitive may be smaller than the whole. The divisor of the tolerance where more is missing.
SHARE, FINER = 8.0, 4.0
#: Missing volume, in units of the tolerance, that never needs a finer one: the scaled solid is
#: about as large as the unit ball.
NEGLIGIBLE = 1e-3


def tessellate(solid: Solid, /, *, tolerance: float = 3e-3) -> Mesh:
    """Return a closed mesh of a solid.

    Parameters
    ----------
    solid : Solid
        Primitive, or a combination of primitives by ``|``, ``&`` and ``-``.
    tolerance : float, default: 3e-3
        Largest distance of triangles from curves and surfaces, as a share of the radius of a ball
        that contains all primitives, from 1e-6 to 0.1.

    Returns
    -------
    Mesh
        Mesh with points on the exact surfaces, except as described below; points of an edge are on
        both surfaces to rounding, unless these touch without crossing. An empty solid has no
        triangles.

    Raises
    ------
    ImportError
        If a combined solid is given and manifold3d is not installed.
    TypeError, ValueError
        If an argument is not valid, if the tolerance needs more than 400,000 points, or if a thin
        wall or gap needs more than 60,000.

    Notes
    -----
    Coincident faces count once: shared faces of joined solids are removed, and the difference of
    equal solids is empty. Solids bounded by planes are exact to rounding. Points are about ``sqrt(2
    tolerance r)`` apart on a surface of radius r. The volume between the triangles and their exact
    surfaces is measured; where it is more than ``8 tolerance`` of the volume of the solid, points
    stay on the facets of the primitives, which keep thin walls, or the mesh is made again with a
    finer tolerance. Points also stay on facets, within the tolerance of their surfaces, where
    moving them would flip a triangle. Volume and area converge with the tolerance. The area has no
    bound, since points near a surface do not bound its slope (Schwarz's lantern), and a crease
    between surfaces that nearly touch may lie anywhere near them; for 30 closed forms its relative
    error was at most 4 times the tolerance, from 5e-4 to 2e-2. Source: Isoluminance, Further Work.
    """
    _check.instance("solid", solid, Solid, EXPECTED)
    tolerance = _check.number("tolerance", tolerance, low=1e-6, high=0.1)
    if isinstance(solid, HalfSpace):
        expected, remedy = "a bounded solid", "intersect it with a bounded one"
        raise _check.value_error("solid", expected, solid, remedy)
    if isinstance(solid, Primitive):
        # A chord of the angle 2 pi / n is r (1 - cos(pi / n)) away from its circle.
        segments = max(FEWEST, math.ceil(math.pi / math.acos(1 - tolerance)))
        return triangle_mesh.mesh(solid, segments)
    if importlib.util.find_spec("manifold3d") is None:
        expected = "a single primitive, as the package manifold3d is not installed"
        remedy = "run pip install 'vizlight[solids]'"
        raise ImportError(_check.message("solid", expected, "a combined solid", remedy))
    tree = _Tree(solid, tolerance)
    fine, most = tolerance, float(MOST)
    while True:
        chosen = tree.segments(fine)
        count = tree.points(chosen)
        if fine == tolerance and count <= most:
            # Thin walls between surfaces need facets finer than the wall.
            chosen, most = tree.finer(chosen), max(PATIENCE, count)
            count = tree.points(chosen)
        if count > most:
            break
        mesh = tree.mesh(chosen, fine)
        # Else facets have cut through a wall: once more, finer.
        if mesh.volume_missing <= tree.allowed(mesh):
            return mesh
        fine, most = fine / FINER, PATIENCE
    expected = f"a value that needs at most {most:.0f} points"
    got = f"{tolerance:g}, which needs {count:.0f}"
    remedy = "raise it, or separate or join surfaces that nearly touch"
    raise _check.value_error("tolerance", expected, got, remedy)


@dataclass
class _Tree:
    """A combined solid, scaled to about the unit ball."""

    solid: Solid
    tolerance: float

    def __post_init__(self) -> None:
        self.primitives = list(self.solid.primitives())
        self.shift, self.scale = _frame(self.primitives)
        # Empty parts keep their places, so that the numbers of surfaces agree; they get no mesh.
        moved = [p if p.empty else p.moved(self.shift, self.scale) for p in self.primitives]
        self.parts = [part.block() if isinstance(part, HalfSpace) else part for part in moved]
        each = [part.surfaces() for part in self.parts]
        self.surfaces = Surfaces(np.concatenate([surfaces.rows for surfaces in each]))
        owned = [len(surfaces) for surfaces in each]
        self.first = np.cumsum(owned) - owned
        self.signs = np.repeat(_signs(self.solid, 1.0), owned)
        # Faces that coincide must have one number, or they count as two.
        keys = np.round(self.surfaces.keys(self.signs) * EQUAL)
        _, first, which = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        #: Index of the first surface that is equal to each.
        self.equal = first[which.ravel()]

    def segments(self, tolerance: float) -> list[int]:
        """Return the number of segments of a circle of each primitive, a multiple of 4."""
        return [
            # The inverse of the sagitta r (1 - cos(pi / n)), for a quarter of the tolerance.
            4 * math.ceil(max(FEWEST, math.pi / math.acos(max(1 - tolerance / (4 * r), 0))) / 4)
            if r > 0 else FEWEST
            for r in (part.roundness for part in self.parts)
        ]  # fmt: skip

    def allowed(self, mesh: Mesh) -> float:
        """Return the volume that may be missing between a mesh and its exact surfaces."""
        return self.tolerance * max(SHARE * mesh.volume, NEGLIGIBLE)

    def points(self, segments: list[int]) -> float:
        """Return the approximate number of points of all primitives."""
        return sum(part.count(n) for part, n in zip(self.parts, segments, strict=True))

    def finer(self, segments: list[int]) -> list[int]:
        """Return the segments that keep the facets of a primitive clear of balls inside it.

        The gap to a ball of radius r about c inside a surface with the signed distance D is
        ``-D(c) - r``. Between alike spheres the facets are parallel, and any gap is kept.
        """
        counts = list(segments)
        balls = [(k, p) for k, p in enumerate(self.parts) if isinstance(p, Sphere) and not p.empty]
        for i, part in enumerate(self.parts):
            radius = part.roundness
            # The facets of planes are exact: none of them cuts into a ball inside.
            if part.empty or radius == 0:
                continue
            side = part.surfaces()
            for k, ball in balls:
                gap = -float(side.distance(ball.center, 0)) - ball.radius
                alike = isinstance(part, Sphere) and segments[i] == segments[k]
                sagitta = radius * (1 - math.cos(math.pi / segments[i]))
                # A facet cuts as deep into the solid as its sagitta. Balls that touch their surface
                # can be kept clear by no number of facets.
                if 10 / EQUAL < gap < sagitta and not alike:
                    # The number with half the gap as its sagitta.
                    fine = math.pi / math.acos(1 - gap / 2 / radius)
                    counts[i] = max(counts[i], 4 * math.ceil(fine / 4))
        return counts

    def combined(self, segments: list[int]) -> tuple[manifold3d.Manifold, float]:
        """Return the combination of faceted primitives, and a bound of its missing volume."""
        from manifold3d import Manifold

        leaves: list[manifold3d.Manifold] = []
        total = 0.0
        for part, count, first in zip(self.parts, segments, self.first, strict=True):
            if part.empty:
                leaves.append(Manifold())
                continue
            # Volume between facets and exact surfaces adds up over the primitives, and bounds the
            # error.
            leaves.append(_leaf(part, count, self.equal[first:]))
            total += part.missed(count, leaves[-1].volume())
            total += ROUNDING * leaves[-1].surface_area()
        return _combine(self.solid, iter(leaves)), total

    def mesh(self, segments: list[int], tolerance: float) -> Mesh:
        """Return the mesh, with the bound of its volume."""
        whole, bound = self.combined(segments)
        facets = whole.to_mesh64()
        triangles = np.asarray(facets.tri_verts, np.intp)
        points = np.asarray(facets.vert_properties, np.float64)
        # The number of the exact surface that each triangle came from survives the operation.
        patch = np.asarray(facets.face_id, np.intp)
        self._check_bounded(patch)
        shared = self.surfaces, self.signs, self.shift, self.scale
        mesh = Mesh(points, triangles, patch, *shared)
        placed = place(mesh, tolerance)
        fits = mesh.volume_missing <= self.allowed(mesh)
        if fits and placed.volume_missing > self.allowed(placed):
            # Facets of walls thinner than their distance from the surfaces stay parallel.
            placed = mesh
        # The facets are within the sum of the primitives' errors; moving the points adds to it.
        bound += abs(placed.volume - whole.volume())
        return dataclasses.replace(placed, volume_error=bound)

    def _check_bounded(self, patch: Indices) -> None:
        """Raise an error if the solid reaches the end of the block in place of a half-space."""
        for part, first in zip(self.primitives, self.first, strict=True):
            # Faces 1 to 5 are the block's own; face 0 is the plane.
            ends = self.equal[first + 1 : first + 6]
            if isinstance(part, HalfSpace) and np.any(np.isin(patch, ends)):
                expected = "a bounded combination of a half-space with others"
                remedy = "intersect it with a bounded solid, or subtract it from one"
                raise _check.value_error("solid", expected, part, remedy)


def _frame(parts: list[Primitive]) -> tuple[Array, float]:
    """Return the centre of all primitives and the length that becomes the unit."""
    # A half-space is infinite, and an empty part may be anywhere: neither tells the size.
    boxes = [part.box() for part in parts if not (part.empty or isinstance(part, HalfSpace))]
    if not boxes:
        return np.asarray(parts[0].box()[0]), 1.0
    low = np.min([center - radius for center, radius in boxes], axis=0)
    high = np.max([center + radius for center, radius in boxes], axis=0)
    shift = low + (high - low) / 2
    largest = max(radius for _, radius in boxes)
    # The distance of primitives counts too: all of them stay near the unit ball.
    apart = max(float(np.abs(center - shift).max()) for center, _ in boxes)
    return shift, max(largest, apart)


def _signs(solid: Solid, sign: float) -> list[float]:
    """Return for each primitive 1, or -1 if the solid lies outside of its surfaces."""
    if not isinstance(solid, Boolean):
        return [sign]
    # What is subtracted turns its surfaces inside out, and a difference within it back.
    second = -sign if solid.operation == "difference" else sign
    return _signs(solid.first, sign) + _signs(solid.second, second)


def _leaf(part: Primitive, segments: int, number: Indices) -> manifold3d.Manifold:
    """Return the mesh of a primitive, with the number of the surface of each triangle."""
    from manifold3d import Error, Manifold, Mesh64

    points, triangles, patch = part.facets(segments)
    used, triangles = triangle_mesh.compact(triangles)
    # On a grid of powers of two, so that faces of two solids that coincide do so in every bit.
    leaf = Manifold(
        Mesh64(
            vert_properties=np.round(points[used] * GRID) / GRID,
            tri_verts=triangles.astype(np.uint64),
            face_id=number[patch].astype(np.uint64),
        )
    )
    if leaf.status() != Error.NoError:
        remedy = "leave it out, or make it thicker"
        raise _check.value_error("solid", "parts that are not flat", part, remedy)
    return leaf


def _combine(solid: Solid, leaves: Iterator[manifold3d.Manifold]) -> manifold3d.Manifold:
    if not isinstance(solid, Boolean):
        return next(leaves)
    first, second = _combine(solid.first, leaves), _combine(solid.second, leaves)
    if solid.operation == "union":
        # manifold3d writes + for the union, ^ for the intersection and - for the difference.
        return first + second
    return first ^ second if solid.operation == "intersection" else first - second


#: Length of the part of a normal that is independent of other normals at a point: below it two
#: surfaces count as touching.
LEAN = 0.02
#: Largest distance that a point is moved, in units of the tolerance.
REACH = 20
#: Rounds of Newton's method.
ROUNDS = 8
#: Distance below which neighbouring points are one point.
SAME = 1e-9
#: Twice the area below which a triangle has no side, to rounding of normalised points.
FLAT = 1e-14


def place(mesh: Mesh, tolerance: float) -> Mesh:
    """Return a mesh with its points on all the exact surfaces that meet in them.

    Points come within about the tolerance, the largest distance of the surfaces from the triangles,
    and end on one surface, on two at a crease or on three at a corner, to rounding. Where two
    surfaces touch, a point is on one of them. Points that would flip a triangle stay where they
    are.
    """
    which = _meeting(mesh)
    points = onto(mesh.surfaces, mesh.points, which, ROUNDS)
    moved = points - mesh.points
    # Surfaces that are nearly parallel meet far from here: such a point stays on one of them.
    far = np.einsum("ij,ij->i", moved, moved) > (REACH * tolerance) ** 2
    points[far] = onto(mesh.surfaces, mesh.points[far], which[far][:, :1], ROUNDS)
    # The normal of a cone jumps at its apex, so points within rounding of it are put there.
    for _, apex in mesh.surfaces.apexes:
        points[np.abs(points - apex).max(axis=1) < SAME] = apex
    merged = _merge(mesh.replace(points, mesh.triangles, mesh.patch))
    return _kept(mesh, points) if flipped(merged).any() else merged


def _kept(mesh: Mesh, points: Array) -> Mesh:
    """Return a mesh with moved points, except at corners of triangles that they would flip."""
    while True:
        trial = mesh.replace(points, mesh.triangles, mesh.patch)
        corners = np.unique(mesh.triangles[flipped(trial)])
        moved = corners[np.any(points[corners] != mesh.points[corners], axis=1)]
        if not len(moved):
            return trial
        # Points that are put back may flip triangles that were right: repeated until none is left.
        points[moved] = mesh.points[moved]


def flipped(mesh: Mesh) -> Bools:
    """Return a mask of the triangles with a normal that points into the solid."""
    corners = mesh.points[mesh.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # At the middle of a triangle, where the surface is most nearly parallel to it.
    normal = triangle_mesh.normals_of(mesh, corners.mean(axis=1), mesh.patch)
    return np.asarray(np.einsum("ij,ij->i", across, normal) < -FLAT)


def _meeting(mesh: Mesh) -> Indices:
    """Return up to three independent surfaces of each point; fewer are repeated."""
    count = len(mesh.points)
    sides = len(mesh.surfaces)
    # Each pair of a point and a surface that has a triangle there, once, sorted by points.
    codes = np.unique(mesh.triangles * sides + mesh.patch[:, np.newaxis])
    pairs = np.stack(np.divmod(codes, sides), axis=1)
    start = np.searchsorted(pairs[:, 0], np.arange(count + 1))
    several = np.diff(start)
    # A surface that is repeated counts once in Newton's method.
    which = np.repeat(pairs[start[:-1], 1][:, np.newaxis], 3, axis=1)
    counts = np.zeros(count, np.intp)
    basis = np.zeros((count, 3, 3))
    for k in range(several.max(initial=0)):
        rows = np.flatnonzero((several > k) & (counts < 3))
        patch = pairs[start[rows] + k, 1]
        normal = triangle_mesh.normals_of(mesh, mesh.points[rows], patch)
        # Gram and Schmidt: what is left of a normal without its parts along those taken before.
        along = np.einsum("nij,nj->ni", basis[rows], normal)
        rest = normal - np.einsum("ni,nij->nj", along, basis[rows])
        size = np.sqrt(np.einsum("ij,ij->i", rest, rest))
        new = size > LEAN
        rows, slot = rows[new], counts[rows[new]]
        which[rows, slot] = patch[new]
        basis[rows, slot] = rest[new] / size[new][:, np.newaxis]
        counts[rows] += 1
    return which


def _merge(mesh: Mesh) -> Mesh:
    """Return the mesh with equal neighbouring points merged, where it stays closed."""
    ends = np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=-1)
    gap = np.abs(np.diff(mesh.points[ends], axis=2)).max(axis=(2, 3))
    short = ends[gap < SAME]
    if not len(short):
        return mesh
    count = len(mesh.points)
    graph = scipy.sparse.coo_array((np.ones(len(short)), tuple(short.T)), (count, count))
    _, group = scipy.sparse.csgraph.connected_components(graph, directed=False)
    # Of each group of points the first stays.
    number = np.unique(group, return_index=True)[1][group]
    triangles = number[mesh.triangles]
    # Triangles between merged points have become edges.
    kept = np.all(triangles != np.roll(triangles, 1, axis=1), axis=1)
    triangles = triangles[kept]
    edges = triangles * count + np.roll(triangles, -1, axis=1)
    # Merging would have made two sheets meet in one edge: it is left undone.
    if len(np.unique(edges)) < edges.size:
        return mesh
    used, triangles = triangle_mesh.compact(triangles)
    return mesh.replace(mesh.points[used], triangles, mesh.patch[kept])
