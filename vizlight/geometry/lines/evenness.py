"""How even curves are: the largest gap between them, bounded all over, and the narrowest ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from vizlight.geometry.lines.even import CROSSING, embedded, parallel
from vizlight.geometry.lines.simplices import CellPlaces, Columns

if TYPE_CHECKING:
    from collections.abc import Iterable

    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.lines.tracing import Curves, Flow

#: Tolerance of a gap, in spacings.
TOLERANCE = 0.005
#: Side of the boxes, in spacings, in which one cell's distance bounds the distances of all.
BOX = 0.25
#: Number of parts of cells that are halved at once: at least so many, and one of so many, since the
#: others are copied each time.
BATCH, SHARE = 256, 4
#: Most halves that are smaller than boxes: along each axis per spacing, but at least so many.
MOST_PARTS, LEAST_PARTS = 4, 4000
#: Number of places from which the first distances are measured exactly.
FIRST = 64
#: Points of curves by whose segments a distance is measured, and most that are looked at for it.
NEIGHBOURS, MOST_NEIGHBOURS = 8, 4096
#: Number of places on curves at which the distance to others is measured.
ON_CURVES = 1000


class Distances:
    """Distances from curves, as :func:`~vizlight.geometry.lines.even.embedded`.

    Parameters
    ----------
    flow : Flow
    spacing : float
    curves : Curves
    """

    def __init__(self, flow: Flow, spacing: float, curves: Curves) -> None:
        self.flow, self.spacing = flow, spacing
        self.there, self.along = embedded(flow, spacing, curves.places), curves.along
        self.curve = np.repeat(np.arange(len(curves.offsets) - 1), np.diff(curves.offsets))
        self._tree = scipy.spatial.cKDTree(self.there)
        #: Whether there are two families of curves, each with gaps of its own.
        self.crossing = flow.mesh.sheets is not None

    def of_points(
        self, at: Array, along: Array, curve: Indices | None, count: int
    ) -> tuple[Array, Indices]:
        """Return distances from points of other curves of the same family, and these points.

        Parameters
        ----------
        at, along : ndarray, shape (N, m) and (N, 3)
            Embedded places, and directions at them.
        curve : ndarray of int, shape (N,), or None
            Curve of each place, whose points do not count.
        count : int
            Number of points that are looked at first.

        Returns
        -------
        distance : ndarray, shape (N, K)
            Infinite for points that do not count, and where no point is found.
        row : ndarray of int, shape (N, K)
        """
        count = min(count, len(self.there))
        distance = np.full((len(at), count), np.inf)
        row = np.zeros((len(at), count), dtype=np.intp)
        left, looked = np.arange(len(at)), count
        # Neighbours are looked for in larger and larger sets until one is of such a curve.
        while len(left) and looked:
            # A list of ranks, since for a single neighbour by number the tree drops an axis.
            neighbours = self._tree.query(at[left], k=np.arange(1, looked + 1))
            far, near = np.asarray(neighbours[0]), np.asarray(neighbours[1])
            if curve is not None:
                far[self.curve[near] == curve[left][:, np.newaxis]] = np.inf
            if self.crossing:
                far[~parallel(self.along[near], along[left][:, np.newaxis])] = np.inf
            # Of a larger set only the nearest are kept, so that all rows have one width.
            if looked > count:
                order = np.argsort(far, axis=1)[:, :count]
                far = np.take_along_axis(far, order, axis=1)
                near = np.take_along_axis(near, order, axis=1)
            distance[left], row[left] = far, near
            left = left[~np.isfinite(far.min(axis=1))]
            more = looked < min(len(self.there), MOST_NEIGHBOURS)
            looked = min(4 * looked, len(self.there), MOST_NEIGHBOURS) if more else 0
        return distance, row

    def of_lines(self, at: Array, along: Array) -> Array:
        """Return distances from the lines, segments between points; infinite if none is found."""
        count = NEIGHBOURS + (CROSSING if self.crossing else 0)
        distance, row = self.of_points(at, along, None, count)
        nearest = distance.min(axis=1)
        a = self.there[row]
        away = at[:, np.newaxis] - a
        for step in (-1, 1):
            # The segments on both sides of a point; at an end of the array it is its own neighbour.
            other = np.clip(row + step, 0, len(self.there) - 1)
            u = self.there[other] - a
            size = np.einsum("nki,nki->nk", u, u)
            share = np.einsum("nki,nki->nk", away, u) / np.where(size > 0, size, 1)
            # From the foot of the perpendicular, which is kept on the segment.
            rest = away - np.clip(share, 0, 1)[..., np.newaxis] * u
            # The next point in the array may begin another curve: no line runs there.
            counted = np.isfinite(distance) & (self.curve[other] == self.curve[row])
            far = np.where(counted, np.einsum("nki,nki->nk", rest, rest), np.inf)
            nearest = np.minimum(nearest, np.sqrt(far.min(axis=1)))
        return np.asarray(nearest)


@dataclass
class Parts(Columns):
    """Parts of cells: simplices in them, which are halved.

    Attributes
    ----------
    cell : ndarray of int, shape (N,)
        Cell of each.
    weights : ndarray, shape (N, k + 1, k + 1)
        Barycentric coordinates of its corners.
    corners : ndarray, shape (N, k + 1, m)
        Embedded corners.
    far, radius : ndarray, shape (N,)
        Distance of its middle from the curves, and largest distance of its places from its middle.
    """

    cell: Indices
    weights: Array
    corners: Array
    far: Array
    radius: Array

    def halved(self, distances: Distances) -> tuple[Parts, Bools]:
        """Return both halves of each part, cut across its longest side, and which have curves.

        The field has no curve where it has no direction.
        """
        first, second = np.triu_indices(self.weights.shape[1], 1)
        side = self.corners[:, first] - self.corners[:, second]
        longest = np.einsum("nei,nei->ne", side, side).argmax(axis=1)
        count = len(self.cell)
        # Each part twice; in one copy one end of its longest side moves, in the other the other.
        both = self.joined(self)
        cell, weights, corners = both.cell, both.weights, both.corners
        rows, ends = np.arange(2 * count), np.concatenate([first[longest], second[longest]])
        # The two ends of a side are so many rows apart.
        opposite = np.roll(ends, count)
        weights[rows, ends] = (weights[rows, ends] + weights[rows, opposite]) / 2
        flow, spacing = distances.flow, distances.spacing
        # Embedded anew, since normals of length 1 are not linear along a side.
        corners[rows, ends] = embedded(flow, spacing, CellPlaces(cell, weights[rows, ends]))
        middles = CellPlaces(cell, weights.mean(axis=1))
        at = embedded(flow, spacing, middles)
        along, moving = flow.directions(middles)
        far = distances.of_lines(at, along)
        return Parts(cell, weights, corners, far, radii(np.swapaxes(corners, 0, 1), at)), moving


def radii(corners: Iterable[Array], middles: Array) -> Array:
    """Return the largest distance of corners, each of shape (N, m), from middles, shape (N, m)."""
    position, normal = np.zeros((2, len(middles)))
    for corner in corners:
        away = corner - middles
        # Farthest by position and by normal can be two different corners.
        np.maximum(position, np.einsum("ni,ni->n", away[:, :3], away[:, :3]), out=position)
        np.maximum(normal, np.einsum("ni,ni->n", away[:, 3:], away[:, 3:]), out=normal)
    return np.sqrt(position + normal)


def largest_gap(distances: Distances) -> float:
    """Return the largest distance of a place from the nearest curve.

    Notes
    -----
    Branch and bound: no place of a part of a cell is farther than its middle is, and its radius.
    Parts that can hold a place farther by :data:`TOLERANCE` than the farthest one found so far are
    halved, the farthest first. The search ends after :data:`MOST_PARTS`, between very many parallel
    lines of one distance, with the gap found so far. In a cross field, where the lines that count
    change with the direction, the bound is not strict.
    """
    if not len(distances.there):
        return np.inf
    spacing, mesh = distances.spacing, distances.flow.mesh
    tolerance = TOLERANCE * spacing
    parts, gap = _first_parts(distances)
    # In squares of the spacing, or cubes.
    room = max(LEAST_PARTS, int(MOST_PARTS**mesh.k * (mesh.extent / spacing**mesh.k)))
    while len(parts.cell) and room > 0:
        # Large parts come first and are not counted: their contents are not measured yet.
        large = parts.radius > BOX * spacing
        first = np.where(large, np.inf, parts.far)
        batch = min(max(BATCH, len(first) // SHARE), len(first))
        order = np.argpartition(-first, batch - 1)
        halves, moving = parts[order[:batch]].halved(distances)
        room -= 0 if large.any() else len(halves.cell)
        # No curve passes where the field has no direction, and such a middle is no gap.
        gap = max(gap, float(halves.far[moving].max(initial=0)))
        # All places of a smaller part are as far as its middle, within the tolerance of the gap.
        parts = parts[order[batch:]].joined(halves[halves.radius > tolerance])
        parts = parts[parts.far + parts.radius > gap + tolerance]
    return gap


def _first_parts(distances: Distances) -> tuple[Parts, float]:
    """Return the cells that can hold the largest gap, and a lower bound of the gap."""
    flow, mesh, spacing = distances.flow, distances.flow.mesh, distances.spacing
    vertices, used = embedded(flow, spacing), mesh.measures > 0
    resting = ~np.any(flow.vectors, axis=1)
    if resting.any():
        # A cell at whose vertices nothing moves has no curves to be filled with.
        used &= ~resting[mesh.cells].all(axis=1)
    cell = np.flatnonzero(used)
    corners = [vertices[corner] for corner in mesh.cells[cell].T]
    middle = np.add(corners[0], corners[1])
    for corner in corners[2:]:
        middle += corner
    middle /= len(corners)
    radius = radii(corners, middle)
    # One cell of each box bounds the distances of the others.
    number = np.zeros(len(middle))
    for axis in middle[:, :3].T:
        # One number for each box, as for cells of a grid.
        box = np.floor((axis - axis.min(initial=0)) / (BOX * spacing))
        number = number * (box.max(initial=0) + 1) + box
    _, first, same = np.unique(number, return_index=True, return_inverse=True)
    share = np.full((len(first), mesh.k + 1), 1 / (mesh.k + 1))
    along, there = flow.directions(CellPlaces(cell[first], share))
    near = distances.of_points(middle[first], along, None, 1)[0].min(axis=1)
    away = middle - middle[first[same]]
    # The triangle inequality: no middle is farther than that of its box's first cell and the way.
    far = near[same] + np.sqrt(np.einsum("ni,ni->n", away, away))
    rows = np.flatnonzero(there)
    rows = rows[np.argsort(-near[rows], kind="stable")[:FIRST]]
    # The farthest few, measured exactly, set a bound that rules out most cells at once.
    gap = float(distances.of_lines(middle[first[rows]], along[rows]).max(initial=0))
    # Cells that cannot hold a larger gap than the one found are not halved at all.
    kept = np.flatnonzero(far + radius > gap + TOLERANCE * spacing)
    # The corners of a whole cell have the weight 1 at one vertex each.
    whole = np.tile(np.eye(mesh.k + 1), (len(kept), 1, 1))
    cell_corners = np.stack([corner[kept] for corner in corners], axis=1)
    return Parts(cell[kept], whole, cell_corners, far[kept], radius[kept]), gap


def evenness(flow: Flow, spacing: float, curves: Curves, /) -> tuple[float, float]:
    """Return how even curves are.

    Returns
    -------
    gap : float
        Largest distance of a place from the nearest curve, in spacings; see :func:`largest_gap`.
    near : float
        Distance of a curve's place to the nearest other curve that 5 % of the places fall below, in
        spacings; infinite for a single curve.
    """
    distances = Distances(flow, spacing, curves)
    gap = largest_gap(distances)
    random, count = np.random.default_rng(1), len(distances.there)
    # The generator has a fixed seed, so the same curves have the same number.
    picked = random.choice(count, min(count, ON_CURVES), replace=False)
    nearest = distances.of_points(
        distances.there[picked], curves.along[picked], distances.curve[picked], 32
    )[0].min(axis=1, initial=np.inf)
    nearest = nearest[np.isfinite(nearest)]
    near = float(np.percentile(nearest, 5)) if len(nearest) else np.inf
    return gap / spacing, near / spacing
