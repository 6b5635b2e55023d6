"""Corners of the faces around points: normals as means over them, and points split at creases."""

from __future__ import annotations

import functools
import itertools
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from vizlight import _pool
from vizlight._types import Array, Bools, Indices, Raw
from vizlight.geometry.lines.simplices import EDGES, components
from vizlight.model import kernels
from vizlight.vtk.cells import as_numpy, columns_at, connectivity, places, triangles
from vizlight.vtk.topology import BLOCK, double_cover

#: Height of a face, and of a corner, as a share of its longest side, below which its direction is
#: little more than rounding: it counts the less.
FLAT = 1e-3
#: Weight of a corner without an angle, which is at the place of the next one.
LEAST = 1e-12
#: Weight of the right corners of a square of unit sides, as those of its halves are weighted.
RIGHT = np.sqrt(np.pi / 2)
#: Number of corners that are summed at once, and of those whose vectors fit in the cache.
CORNERS, FEW = 1 << 17, 1 << 15


def surface_normals(surface: vtkPolyData) -> Array:
    """Return the normals of a surface as its faces are wound; see :func:`corner_normals`."""
    return corner_normals(places(surface), corners_by_size(surface))


def corners_by_size(surface: vtkPolyData) -> Iterator[Indices]:
    """Yield the corners of the faces that have equally many, shape (m, s)."""
    if surface.GetNumberOfStrips():
        yield triangles(surface)
        return
    size = surface.GetPolys().IsHomogeneous()
    if size > 2:
        yield as_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, size)
        return
    for _, corners in _by_size(*connectivity(surface.GetPolys())):
        yield corners


def _by_size(ids: Indices, ends: Indices) -> Iterator[tuple[Indices, Indices]]:
    """Yield the faces of three corners or more that have equally many, and their corners."""
    size = np.diff(ends)
    # Mostly all faces have equally many corners, which a pass tells that is faster than a sort.
    alike = len(size) > 0 and size.min() == size.max()
    kinds = size[:1] if alike else np.unique(size)
    for s in kinds[kinds > 2]:
        faces = np.flatnonzero(size == s)
        whole = len(faces) == len(size)
        yield faces, ids.reshape(-1, s) if whole else ids[ends[faces, np.newaxis] + np.arange(s)]


def corner_normals(points: Raw, faces: Iterator[Indices] | list[Indices]) -> Array:
    """Return the normals of points, by the corners of the faces around each.

    A corner of a triangle, and of a polygon of more than four sides, has a normal across both its
    sides, and counts by the geometric mean of two weights. By its angle (Thuermer and Wuethrich
    1998) the normals do not depend on how a plane is cut into triangles. By Max's weight (1999),
    the sine of the angle over the product of the sides, they are exact for points on a ball, but
    bend planes beside narrow strips.

    A corner of a quad counts by the cross product of its sides over the power 1.5 of the product of
    their lengths: a right corner as in a triangle. This is exact on balls between even circles and
    meridians. Where the diagonal from the corner, of length d, is shorter than the longest side of
    the quad, of length l, the area vector of the quad takes the share 1 - d^2 / l^2 of the cross
    product: on a sheared grid the far end of the diagonal is a nearer neighbour than that of a
    side. At dents and straight corners it takes all.

    No weights are the best everywhere. The mean error, as a share of that by the best of four
    weights for each surface (equal, area, angle, Max's), is at most 1.05 on isosurfaces through
    even and long voxels, at their borders, on long triangles and on quads sheared by 3; 1.5 on
    grids of triangles, on quads sheared by 1, on random points, also off by 5 % of an edge, on long
    ellipsoids, and on isosurfaces off by 1 % of a voxel; 2.2 on even quads, on obtuse triangles and
    those sheared by 2, at their borders, on steep quads sheared by 2, and at ridges; 3 on
    isosurfaces off by 5 % of an edge; and 10 on quads mostly steeper than 70 degrees. On steep and
    sheared lattices weights by area make central differences, with noise small faces tell least,
    and the corners do not show which it is. Weights by area are exact on planes beside narrow
    strips, Max's on balls.

    As a share of the mean error of VTK's plain means of faces it is at most 0.6 on ellipsoids and
    random points of balls, 0.9 on isosurfaces of a gyroid, random points of the plane, even quads
    and long triangles, 1.1 through long voxels, on grids of triangles and on quads sheared by 1. It
    is up to 1.6 on sheared triangles and with noise, 1.7 on steep quads, and 2.2 on quads sheared
    by 3, steep ones sheared by 2, and planes that end in narrow strips.

    Measured once on 60 kinds of surfaces, no product of powers of the angle, the size and the sides
    of a corner was better by more than 2 % in the geometric mean of these shares. Neither was a
    choice of weights at each point by their error on quadrics, nor weights corrected by it.

    Each item of ``faces`` (m, s) has faces of s corners. Normals are unit vectors in float32, zero
    at points of no face, or of faces without area.
    """
    total = np.zeros((3, len(points)))
    for corners in faces:
        for block in _pool.blocks(len(corners), max(CORNERS // max(corners.shape[1], 1), 1)):
            _add(total, points, corners[block])
    return np.ascontiguousarray(kernels.unit(total)[0].T, dtype=np.float32)


def _add(total: Array, points: Raw, corners: Indices) -> None:
    """Add the weighted normals of all corners of some faces."""
    low, high = int(corners.min()), int(corners.max()) + 1
    used = None
    if high - low > 8 * corners.size:
        # Of faces in no order each block may have points from end to end.
        used, number = np.unique(corners, return_inverse=True)
        low, high = 0, len(used)
        corners = number.reshape(corners.shape)
        points = points[used]
    at = [np.ascontiguousarray(column) for column in corners.T]
    weighted = np.empty((len(at), 3, len(corners)))
    for block in _pool.blocks(len(corners), max(FEW // len(at), 1)):
        places = [columns_at(points, column[block]) for column in at]
        with np.errstate(all="ignore"):
            normals = _of_quads(places) if len(at) == 4 else _of_polygons(places)
        for into, normal in zip(weighted, normals, strict=True):
            into[:, block] = normal
    for ids, normal in zip(at, weighted, strict=True):
        place = ids - low
        for k in range(3):
            # Faster than np.add.at, as long as a block has points near each other.
            sums = np.bincount(place, normal[k], high - low)
            if used is None:
                total[k, low:high] += sums
            else:
                total[k, used] += sums


def _of_quads(places: Sequence[Array]) -> list[Array]:
    """Return the weighted normals of the corners of quads, see :func:`corner_normals`."""
    sides = [places[(i + 1) % 4] - places[i] for i in range(4)]
    squares = [kernels.dot(side, side) for side in sides]
    diagonals = [places[2] - places[0], places[3] - places[1]]
    longest = functools.reduce(np.maximum, squares)
    face, area = kernels.unit(kernels.cross(*diagonals))
    area *= 0.5
    height = RIGHT * np.minimum(2 * area / (FLAT * longest), 1)
    lengths = [np.sqrt(square) for square in squares]
    short = [np.maximum(1 - kernels.dot(side, side) / longest, 0) for side in diagonals]
    weighted: list[Array] = []
    for i in range(4):
        corner = kernels.cross(sides[i - 1], sides[i])
        corner /= area
        # Sides in one line have no plane of their own, and at a dent their product points to the
        # back of the face.
        flat = kernels.dot(corner, face) * area <= FLAT * np.maximum(squares[i], squares[i - 1])
        normal = face - corner
        normal *= np.where(flat, 1, short[i % 2])
        normal += corner
        near = lengths[i] * lengths[i - 1]
        normal *= height * (area / near) / np.sqrt(near)
        # Corners of points that are not finite say nothing, but must not spoil those around them.
        if not np.isfinite(normal).all():
            normal[:, ~np.isfinite(normal).all(axis=0)] = 0
        weighted.append(normal)
    twice = np.flatnonzero(functools.reduce(np.minimum, squares) == 0)
    if len(twice):
        of_triangles = _of_polygons([place[:, twice] for place in places])
        for normals, those in zip(weighted, of_triangles, strict=True):
            normals[:, twice] = those
    return weighted


def _of_polygons(places: Sequence[Array]) -> list[Array]:
    """Return the weighted normals of the corners of polygons, see :func:`corner_normals`."""
    s = len(places)
    sides = [places[(i + 1) % s] - places[i] for i in range(s)]
    squares = [kernels.dot(side, side) for side in sides]
    longest = functools.reduce(np.maximum, squares)
    if s == 3:
        across = kernels.cross(sides[0], sides[1])
    else:
        # Twice the area vector, summed over a fan: right for dented polygons too, and a mean
        # direction of those that are not plane.
        across = np.zeros_like(places[0])
        for i in range(1, s - 1):
            across += kernels.cross(places[i] - places[0], places[i + 1] - places[0])
    face, area = kernels.unit(across)
    # Twice the area over the square of the longest side is the height as a share of that side.
    height = np.minimum(area / (FLAT * longest), 1)
    lengths = [np.sqrt(square) for square in squares]
    before = [[part[i - 1] for i in range(s)] for part in (sides, squares, lengths)]
    if s > 3 and not all(square.all() for square in squares):
        # Of a point that a face names twice in turn the last counts, and the side before both.
        for i in (*range(s), *range(s)):
            same = before[1][i] == 0
            for part in before:
                part[i] = np.where(same, part[i - 1], part[i])
    weighted: list[Array] = []
    for i in range(s):
        ahead, behind = sides[i], before[0][i]
        normal, size = face, area
        if s > 3:
            # A polygon that is not plane has another normal at each corner.
            corner, size = kernels.unit(kernels.cross(behind, ahead))
            inward = kernels.dot(corner, face)
            # Sides in one line have no plane of their own, and at a dent their product points
            # to the back of the face.
            flat = size <= FLAT * np.maximum(squares[i], before[1][i])
            normal = np.where(flat, face, np.where(inward < 0, -corner, corner))
        # The angle of the corner, exact for sharp and for blunt ones.
        weight = np.arctan2(size, -kernels.dot(ahead, behind))
        near = lengths[i] * before[2][i]
        # A straight corner has no sine, but an angle.
        weight *= np.maximum(size, FLAT * near)
        weight = np.sqrt(weight) * height / near
        # A corner at the place of the next has no angle: it counts where nothing else does.
        same = np.flatnonzero(near == 0)
        weight[same] = LEAST * height[same] / np.sqrt(longest[same])
        # Corners of points that are not finite say nothing, but must not spoil those around them.
        np.copyto(weight, 0, where=~np.isfinite(weight))
        weighted.append(normal * weight)
    return weighted


#: Angle in degrees between the normals of two faces above which their common edge is sharp.
SHARP = 30.0
#: Share of sharp edges, of all edges of a mesh, from which a warning names the remedy.
MANY_SHARP = 0.02
#: Sharp edges are creases if at most this many times as many edges are half as sharp or more.
STAND_APART = 0.5
#: They also are if of those above twice the angle, at least MANY_SHARP of all edges, there are more
#: than of those between by this factor: corners stand apart from coarse arcs.
CORNERS_APART = 0.7


def crease_share(counts: Indices) -> Array:
    """Return the share of sharp edges where these are creases, else 0.

    Creases stand apart: few edges are nearly as sharp. A coarse mesh of a smooth shape has more of
    those, and no edge is meant to be seen. ``counts`` are the ``edges`` of a
    :class:`.orientation.SurfaceShape`, and each block has a share of its own.
    """
    beyond, share, nearly = (counts[..., 1:] / np.maximum(counts[..., :1], 1)).T
    apart = (beyond >= MANY_SHARP) & (share - beyond <= CORNERS_APART * beyond)
    return np.where(apart | (nearly - share <= STAND_APART * share), share, 0.0)


#: Degrees by which an angle may be off by rounding: the edges of a cylinder of 12 sides, which are
#: those of 30 degrees, are split together or not at all.
BEYOND = 0.01


def split_faces(
    points: Raw, ids: Indices, ends: Indices, angle: float, twins: Indices | None = None
) -> tuple[Indices, Indices, Bools]:
    """Return the corners of faces at points that are split, and the point that each point was.

    Around a point the faces that edges join which are not sharp have one point. An edge of more
    than two faces joins none of them. Faces need not be wound alike; the last result tells which to
    turn over so that they are wound as the first of their piece, where that has two sides. ``ends``
    (M + 1,) is the place in ``ids`` at which each face begins, and the end of the last; an edge is
    sharp from ``angle`` degrees on. ``twins`` is the first face of the same points as each face;
    others stay with that one.
    """
    unit = _face_normals(points, ids, ends)
    least = np.cos(np.radians(angle + BEYOND))
    count = len(ends) - 1
    root: Indices = np.empty(len(ids), dtype=np.int32 if len(ids) < 2**31 else np.intp)
    # Faces that are there twice have no side, and are not turned over.
    lone = None if twins is None else np.bincount(twins, minlength=count)[twins] == 1

    def sided(a: Indices, b: Indices) -> Bools:
        """Return whether both faces of each pair have sides."""
        return np.ones(len(a), dtype=np.bool_) if lone is None else lone[a] & lone[b]

    alike = True
    for members, this, other, a, b, against, _ in _neighbours(len(points), ids, ends, twins):
        smooth = _cosines(unit, a, b, against) > least
        alike = alike and bool(against[sided(a, b)].all())
        # Both corners of a pair are at the same point, so that each point is split by itself.
        a, b = this[smooth], other[smooth]
        root[members] = members[
            components(np.minimum(a, b), np.maximum(a, b), len(members), kind=root.dtype.type)
        ]
    if twins is not None:
        # A twin may begin at another corner or run the other way round: only the first face of its
        # points and the point itself tell which corner goes with which.
        corner = np.repeat(twins, np.diff(ends)) * len(points) + ids
        _, first, number = np.unique(corner, return_index=True, return_inverse=True)
        # A face that has a point twice joins what is around both of its corners there.
        same = root[first[number.reshape(-1)]]
        low, high = np.minimum(root, same), np.maximum(root, same)
        root = components(low, high, len(root), kind=root.dtype.type)[root]
    turned = np.zeros(count, dtype=np.bool_)
    if not alike:
        edges = []
        for _, _, _, a, b, against, _ in _neighbours(len(points), ids, ends, twins):
            # Each pair is met at both ends of its edge.
            met_once = (a < b) & sided(a, b)
            # The other side of a face has its number beyond those of all faces.
            edges.append((a[met_once], np.where(against, b, b + count)[met_once]))
        this, other = (np.concatenate(each) for each in zip(*edges, strict=True))
        up, down = double_cover(this, other, count)
        # The copies that agree with the first face of their piece as it is have the lower number.
        turned = up > down
    return *numbered(root, ids, len(points)), turned


def sharp_edges(points: Raw, ids: Indices, ends: Indices, angle: float) -> Indices:
    """Return both points of each edge that is sharp, of two faces that may be wound otherwise.

    Arguments are as for :func:`split_faces`.
    """
    unit = _face_normals(points, ids, ends)
    least = np.cos(np.radians(angle + BEYOND))
    edges = [np.empty((0, 2), dtype=np.intp)]
    for members, this, _, a, b, against, toward in _neighbours(len(points), ids, ends, None):
        corner = ids[members[this]]
        # Each edge is met at both of its points.
        sharp = (_cosines(unit, a, b, against) <= least) & (corner < toward)
        edges.append(np.column_stack([corner, toward])[sharp])
    return np.concatenate(edges)


def _cosines(unit: Array, a: Indices, b: Indices, against: Bools) -> Array:
    """Return the cosine of the angle by which the normal turns from one face to the next."""
    cosine: Array = np.einsum("ij,ij->i", unit[a], unit[b])
    # The normal of one of two faces that are wound against each other is turned to compare them.
    return np.where(against, cosine, -cosine)


def _neighbours(
    count: int, ids: Indices, ends: Indices, twins: Indices | None
) -> Iterator[tuple[Indices, Indices, Indices, Indices, Indices, Bools, Indices]]:
    """Yield the corners of some points, and pairs of faces that an edge at these joins.

    Places of the two faces' corners per pair, the two faces, whether these are wound alike, and the
    point at the other end of their edge. By ranges of points: a sort of all edges at once would
    take more memory.
    """
    sizes = np.diff(ends)
    size = int(sizes[0]) if len(sizes) and sizes.min() == sizes.max() else 0
    for block in _pool.blocks(count, EDGES // 16):
        place = np.flatnonzero((ids >= block.start) & (ids < block.stop))
        # With as many corners each, faces begin at regular places.
        face = place // size if size else np.searchsorted(ends, place, side="right") - 1
        begin, end = ends[face], ends[face + 1]
        after = ids[np.where(place + 1 < end, place + 1, begin)]
        before = ids[np.where(place > begin, place, end) - 1]
        # Each corner has an edge ahead of it and one behind it.
        at, toward = np.tile(ids[place], 2), np.concatenate([after, before])
        has_edge = at != toward
        if twins is not None:
            # A face that is there again would make each of its edges one of several faces, which
            # joins none of them.
            has_edge &= np.tile(twins[face] == face, 2)
        rows = np.flatnonzero(has_edge)
        key = at[rows].astype(np.int64) << 32 | toward[rows]
        order = np.argsort(key, kind="stable")
        key, rows = key[order], rows[order]
        new = np.concatenate([[True], key[1:] != key[:-1], [True, True]])
        pair = np.flatnonzero(new[:-3] & ~new[1:-2] & new[2:-1])
        a, b = rows[pair], rows[pair + 1]
        ahead, onward = a < len(place), b < len(place)
        a, b = np.where(ahead, a, a - len(place)), np.where(onward, b, b - len(place))
        # Faces that are wound alike run along their common edge against each other.
        against = ahead != onward
        yield place, a, b, face[a], face[b], against, toward[rows[pair]]


def _face_normals(points: Raw, ids: Indices, ends: Indices) -> Array:
    """Return the unit normals of faces in float32, zero without an area."""
    unit = np.zeros((len(ends) - 1, 3), dtype=np.float32)
    for faces, corners in _by_size(ids, ends):
        for block in _pool.blocks(len(faces), BLOCK):
            at = corners[block].T
            first, *more = (columns_at(points, corner) for corner in at)
            sides = [corner - first for corner in more]
            across = sum(kernels.cross(a, b) for a, b in itertools.pairwise(sides))
            unit[faces[block]] = kernels.unit(np.asarray(across))[0].T
    return unit


def numbered(root: Indices, ids: Indices, count: int) -> tuple[Indices, Indices]:
    """Return the points of corners, one for each root, and the earlier number of each point.

    The first of the roots at a point has that point; others come after all points. ``root`` is the
    first corner that is one with each corner, ``ids`` the point of each before.
    """
    roots = np.flatnonzero(root == np.arange(len(root), dtype=root.dtype))
    of_root = ids[roots]
    # The first root keeps the row of its point, so that arrays of the old points stay valid there.
    first = np.zeros(len(roots), dtype=np.bool_)
    first[np.unique(of_root, return_index=True)[1]] = True
    place = np.empty(len(root), dtype=root.dtype)
    place[roots] = np.where(first, of_root, count - 1 + np.cumsum(~first))
    return place[root], np.concatenate([np.arange(count), of_root[~first]])


#: Share of the longest side of a triangle up to which another side joins its ends, and of the
#: longest of those up to which all points that are joined lie apart.
NEAR = 1e-3


class Slivers(NamedTuple):
    """Short sides of triangles.

    ``squares`` is the square of the longest side of the triangle of each.
    """

    lower: Indices
    upper: Indices
    squares: Array


def slivers_of(rows: Indices, squares: Sequence[Array]) -> Slivers:
    """Return the sides of triangles of at most :data:`NEAR` of the longest.

    ``squares`` are those of the side before each corner.
    """
    longest = functools.reduce(np.maximum, squares)
    limit = NEAR * NEAR * longest
    near = [np.flatnonzero(square <= limit) for square in squares]
    this = np.concatenate([rows[at, i] for i, at in enumerate(near)])
    other = np.concatenate([rows[at, i - 1] for i, at in enumerate(near)])
    return Slivers(np.minimum(this, other), np.maximum(this, other), longest[np.concatenate(near)])


def faces_of_three(surface: vtkPolyData) -> Indices:
    """Return the corners of the polygons of three corners, shape (n, 3)."""
    ids, offsets = connectivity(surface.GetPolys())
    first = offsets[:-1][np.diff(offsets) == 3]
    corners: Indices = ids[first[:, np.newaxis] + np.arange(3)]
    return corners


def all_slivers(points: Raw, triangles: Indices) -> list[Slivers]:
    """Return the slivers among triangles."""
    slivers = []
    for block in _pool.blocks(len(triangles), BLOCK):
        rows = triangles[block]
        corners = [columns_at(points, corner) for corner in rows.T]
        with np.errstate(invalid="ignore", over="ignore", under="ignore"):
            sides = [corners[i] - corners[i - 1] for i in range(3)]
            squares = [kernels.dot(side, side) for side in sides]
            slivers.append(slivers_of(rows, squares))
    return slivers


def joined(points: Raw, slivers: list[Slivers]) -> Indices | None:
    """Return the first of the points that slivers join with each.

    A side joins its ends where it is at most :data:`NEAR` of the longest side of its triangle.
    Points that are joined in a chain, as across a row of slivers, stay apart where the chain is
    longer than that. None is returned where no points are joined.
    """
    if not slivers:
        return None
    lower, upper, longest = (np.concatenate(each) for each in zip(*slivers, strict=True))
    apart = lower != upper
    lower, upper, longest = lower[apart], upper[apart], longest[apart]
    if not len(lower):
        return None
    # Chains of slivers have one first point; whether they stay near is tested below.
    first = components(lower, upper, len(points))
    reach = np.zeros(len(points))
    # A group may extend as far as the longest of its triangles allows.
    np.maximum.at(reach, first[lower], NEAR * np.sqrt(longest))
    ends = np.unique(np.concatenate([lower, upper]))
    low, high = np.full((2, len(points), 3), np.inf)
    places = points[ends].astype(np.float64)
    np.minimum.at(low, first[ends], places)
    # The upper bound as the least of the negative: both arrays start from infinity.
    np.minimum.at(high, first[ends], -places)
    with np.errstate(invalid="ignore"):
        together = (-high - low).max(axis=1) <= reach
    return np.where(together[first], first, np.arange(len(points)))


def common_normals(
    points: Raw, triangles: Indices, normals: Array, first: Indices, least: float
) -> tuple[Array, Indices]:
    """Return normals that points which are joined have in common, where these are nearly the same.

    ``normals`` are those of each point by its own triangles, ``first`` is the first of the points
    that are joined with each, and ``least`` the least cosine between a point's own normal and the
    common one. Common ones are of all triangles at joined points but the slivers between these; the
    second result is ``first`` of those that got one normal.
    """
    several = np.bincount(first, minlength=len(first))[first] > 1
    rows = triangles[several[triangles].any(axis=1)]
    # Slivers have a direction by rounding alone.
    rows = rows[np.all(first[rows] != first[np.roll(rows, 1, axis=1)], axis=1)]
    common = corner_normals(points, [first[rows]])[first]
    # Their own normals without the slivers, by which the common one is judged.
    normals = np.where(several[:, np.newaxis], corner_normals(points, [rows]), normals)
    cosine = np.einsum("ij,ij->i", normals, common)
    # Points of slivers alone have no normal of their own, and so no objection to the common one.
    apart = several & ~(cosine >= least) & np.any(normals, axis=1)
    kept = np.ones(len(first), dtype=np.bool_)
    # One point that differs, as at a sharp edge, leaves its whole group as it was.
    kept[first[apart]] = False
    chosen = several & kept[first]
    shared = normals.copy()
    shared[chosen] = common[chosen]
    return shared, np.where(chosen, first, np.arange(len(first)))
