"""Sides of a surface that is read part by part: facts of each part, decisions of the whole."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from vizlight import _pool
from vizlight._types import Array, Bools, Dataset, Indices
from vizlight.model import kernels
from vizlight.scene import View
from vizlight.vtk.corners import crease_share
from vizlight.vtk.normals import Sided, Vote, facing_of, given_normals, wound_normals
from vizlight.vtk.orientation import middles, sides_of
from vizlight.vtk.topology import BLOCK, double_cover, place_numbers

#: Number of directions in which the outermost normals of a piece are searched for, and number of
#: normals up to which all are taken.
AROUND = 64
#: Number of normals of which the least far tells what is too near, and rounding of that.
SOME, ROUNDED = 1024, 1e-9
#: Share of what normals at common points say that is enough to tell that two pieces agree.
CLEAR = 0.8


class PartFacts(NamedTuple):
    """Facts of a part of a surface; its pieces are those of :class:`.orientation.SurfaceShape`.

    ``open`` pieces have a border, or faces that have no common side. ``far`` (count, 6, 2) is the
    coordinate of the outermost point of each piece along x, -x, y and so on, minus infinity without
    one, and that component of its normal; ``shown`` the sum of
    :func:`~vizlight.vtk.normals.facing_of`, ``total`` that of the normals, and ``field`` says that
    a piece is a height field, as far as the part knows. ``normals`` are the outermost ones ``of``
    each piece; ``places``, ``at`` and ``along`` the numbers of the places of points that other
    parts have too, their pieces and normals. ``edges`` are those of SurfaceShape.
    """

    open: Bools
    far: Array
    shown: Array
    total: Array
    field: Bools
    normals: Array
    of: Indices
    places: NDArray[np.uint64]
    at: Indices
    along: Array
    edges: Indices


class Undecided(NamedTuple):
    """Normals of a part on sides that the whole has yet to decide.

    ``vectors`` and ``lean`` are as of :class:`.normals.Sided`; ``sharp`` is the share of edges that
    are creases.
    """

    vectors: Array
    lean: Array
    piece: Indices
    sharp: float

    def decided(self, vote: Vote) -> Sided:
        """Return the normals on the sides that the whole has decided."""
        sign = vote.sign[self.piece].astype(np.float32)
        return Sided(
            self.vectors * sign[:, np.newaxis], self.lean * sign, vote.number[self.piece],
            float(self.sharp), kept=True, computed=True, averted=vote.averted,
        )  # fmt: skip


def side_of(ghosts: Array) -> NDArray[np.int8]:
    """Return :attr:`.orientation.SurfaceShape.side` of a part with ``ghosts`` of :func:`look`."""
    return np.where(ghosts < 1, 0, -1).astype(np.int8)


def look(
    mesh: Dataset,
    ghosts: Array,
    value: object,
    view: View | None,
    keep: Callable[[Undecided], None] | None = None,
) -> PartFacts | None:
    """Return the facts of a part of a surface, None where it has no surface.

    The mesh has the cells of other parts that share a point with it, and ``ghosts`` is the share of
    the cells around each point that belong to these. With a name of normals, or with normals that
    the mesh has, the surface is one piece; ``keep`` takes the normals of a surface.
    """
    vectors_in = given_normals(mesh, value, 3)
    wound = wound_normals(mesh, side=side_of(ghosts))
    if wound is None:
        return None
    shape, vectors, first, origin = wound
    if keep is not None:
        lean = shape.survey(vectors)[1]
        lean = lean if first is None else lean[first]
        keep(Undecided(vectors, lean, shape.piece, float(crease_share(shape.edges))))
    piece, border = shape.piece, shape.open | shape.inside_out
    of_mesh = np.arange(len(piece)) if origin is None else origin
    if vectors_in is not None:
        # The index -1 takes the normal of the last point, and is left out below.
        vectors = vectors_in[of_mesh]
        piece, border = np.zeros_like(piece), np.array([shape.open.any()])
    has = np.isfinite(vectors).all(axis=1) & vectors.any(axis=1) & shape.finite
    # Points that are only in cells of other parts are theirs to tell of.
    has &= (of_mesh >= 0) & (ghosts[of_mesh] < 1)
    inner, joint = np.flatnonzero(has), np.flatnonzero(has & (ghosts[of_mesh] > 0))
    points, at, count = shape.points[inner], piece[inner], len(border)
    normals = vectors[inner].astype(np.float64)
    far = np.tile([-np.inf, 0.0], (count, 6, 1))
    # The outermost point along each half axis, and whether the normal there points outward.
    for i in range(6):
        sign = 1 - 2 * (i % 2)
        along = sign * points[:, i // 2].astype(np.float64)
        np.maximum.at(far[:, i, 0], at, along)
        last = np.flatnonzero(along == far[at, i, 0])
        far[at[last], i, 1] = sign * normals[last, i // 2]
    # A point that parts have in common counts once, in shares.
    share = 1 - ghosts[of_mesh[inner]].astype(np.float64)
    shown, total = np.zeros(count), np.zeros((count, 3))
    np.add.at(shown, at, share * facing_of(normals, points, view))
    np.add.at(total, at, share[:, np.newaxis] * normals)
    field = sides_of(normals, at, np.ones(count, dtype=np.bool_)) > 1
    outermost, of = _outermost(normals, at, count)
    common = place_numbers(shape.points[joint]), piece[joint], vectors[joint].astype(np.float64)
    if vectors_in is not None:
        # A place of all parts, with no opinion of its side: what does not touch is one piece too.
        common = np.zeros(1, dtype=np.uint64), np.zeros(1, dtype=np.intp), np.zeros((1, 3))
    return PartFacts(border, far, shown, total, field, outermost, of, *common, shape.edges)


def _outermost(normals: Array, piece: Indices, count: int) -> tuple[Array, Indices]:
    """Return the normals of each piece that lean most from their middle, and their pieces.

    Of a piece that is no height field one of its normals and the opposite one are returned.
    """
    middle = middles(normals, piece, np.ones(count, dtype=np.bool_))
    order = np.argsort(piece, kind="stable")
    size = np.bincount(piece, minlength=count)
    first = np.concatenate([[0], np.cumsum(size)])
    few = order[(size <= AROUND)[piece[order]]]
    extremes, of = [normals[few]], [piece[few]]
    angles = 2 * np.pi * np.arange(AROUND) / AROUND
    directions = np.cos(angles), np.sin(angles)
    for i in np.flatnonzero(size > AROUND):
        rows = order[first[i] : first[i + 1]]
        # A piece is a height field if its normals fit in a half space; those that lean most decide
        # that.
        along = np.empty((4, len(rows)))
        along[:3] = normals[rows].T
        cosine = np.matmul(middle[i], along[:3], out=along[3])
        if cosine.min() <= 0:
            normal = normals[rows[:1]]
            extremes += [normal, -normal]
            of.append(np.full(2, i))
            continue
        # With the middle, two directions across it: the rows of a singular value decomposition are
        # orthonormal.
        _, u, v = np.linalg.svd(middle[i][np.newaxis])[2]
        # A central projection on the plane across the middle, where the normals furthest out in
        # each direction stand for all within their hull.
        x, y = np.stack([u, v]) @ along[:3] / cosine
        most, which = np.full(AROUND, -np.inf), np.zeros(AROUND, dtype=np.intp)
        # What is nearer than the least far of some is the furthest in no direction.
        some = slice(None, None, max(len(rows) // SOME, 1))
        bound = np.max(np.outer(directions[0], x[some]) + np.outer(directions[1], y[some]), axis=1)
        far = np.flatnonzero(x * x + y * y >= (1 - ROUNDED) * max(bound.min(), 0.0) ** 2)
        for block in _pool.blocks(len(far), BLOCK):
            at = far[block]
            leaning = np.outer(directions[0], x[at]) + np.outer(directions[1], y[at])
            best = leaning.argmax(axis=1)
            top = leaning[np.arange(AROUND), best]
            which = np.where(top > most, at[best], which)
            most = np.maximum(top, most)
        kept = np.unique([*which, *along.argmin(axis=1), *along.argmax(axis=1)])
        extremes.append(normals[rows[kept]])
        of.append(np.full(len(kept), i))
    return np.concatenate(extremes), np.concatenate(of)


def decided(looks: Sequence[PartFacts]) -> list[Vote]:
    """Return for each part the decision of the whole about its pieces."""
    count = [len(each.open) for each in looks]
    start = np.cumsum([0, *count])
    # Pieces that touch across parts are one piece of the whole, with signs that make them agree.
    group, sign, torn = _joined(looks, start[:-1], int(start[-1]))
    whole = int(group.max(initial=-1)) + 1
    border = np.zeros(whole, dtype=np.bool_)
    # One open part makes its whole piece open.
    border[group[np.concatenate([each.open for each in looks]) | torn]] = True
    far = np.concatenate([each.far for each in looks])
    # Closed pieces: turned by the outermost of the outermost points.
    outward = np.zeros(whole)
    for i in range(6):
        most = np.full(whole, -np.inf)
        np.maximum.at(most, group, far[:, i, 0])
        # Where several pieces reach equally far, as at a point in common, the last one decides.
        there = np.flatnonzero(np.isfinite(far[:, i, 0]) & (far[:, i, 0] == most[group]))
        component = np.zeros(whole)
        component[group[there]] = sign[there] * far[there, i, 1]
        outward += component
    sign = sign * np.where(~border & (outward < 0), -1, 1)[group]
    of = np.concatenate([each.of + first for each, first in zip(looks, start[:-1], strict=True)])
    normals = np.concatenate([each.normals for each in looks]) * sign[of][:, np.newaxis]
    sums = sign[:, np.newaxis] * np.concatenate([each.total for each in looks])
    total = np.zeros((whole, 3))
    np.add.at(total, group, sums)
    # What lies in one part is known there, of others no part may know better.
    fields = sides_of(normals, group[of], border, total) > 1
    field = (np.bincount(group, minlength=whole) == 1) | fields
    np.logical_and.at(field, group, np.concatenate([each.field for each in looks]))
    field &= border
    number: Indices = border.astype(np.intp)
    number[field] = 2 + np.arange(np.count_nonzero(field))
    shown = np.bincount(group, sign * np.concatenate([each.shown for each in looks]), whole)
    averted = np.zeros(int(number.max(initial=0)) + 1, dtype=np.bool_)
    averted[number[number > 1]] = shown[number > 1] < 0
    numbers = number[group]
    return [
        Vote(sign[first : first + n], numbers[first : first + n], averted)
        for first, n in zip(start[:-1], count, strict=True)
    ]


def _joined(looks: Sequence[PartFacts], start: Indices, total: int) -> tuple[Indices, Array, Bools]:
    """Return the piece of the whole that each piece of a part belongs to, and its sign.

    The last is a mask of those that no signs bring to one side, as in a Klein bottle.
    """
    places = np.concatenate([this.places for this in looks])
    at = np.concatenate([this.at + first for this, first in zip(looks, start, strict=True)])
    along = np.concatenate([this.along for this in looks])
    # Of a place in more than two parts each is compared with the next one.
    order = np.argsort(places, kind="stable")
    twice = np.flatnonzero(places[order[1:]] == places[order[:-1]])
    this, other = order[twice], order[twice + 1]
    pairs, number = np.unique(at[this] * total + at[other], return_inverse=True)
    # Normals of length 0 have no opinion and join their pieces as they are.
    cosines = kernels.dot(along[this].T, along[other].T)
    alike, most = (np.bincount(number, of, len(pairs)) for of in (cosines, CLEAR * abs(cosines)))
    a, b = np.divmod(pairs, max(total, 1))
    # Two pieces that meet at several borders may agree at one and not at another.
    same, turned = alike >= -most, alike < most
    this, other = np.append(a[same], a[turned]), np.append(b[same], b[turned] + total)
    up, down = double_cover(this, other, total)
    group = np.unique(np.minimum(up, down), return_inverse=True)[1].reshape(-1)
    return group, np.where(up <= down, 1.0, -1.0), up == down


def creases(looks: Sequence[PartFacts]) -> bool:
    """Return whether the sharp edges of the whole are creases."""
    return bool(crease_share(np.sum([each.edges for each in looks], axis=0)) > 0)
