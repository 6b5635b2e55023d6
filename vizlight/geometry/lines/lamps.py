"""A light inside or near a bundle of lines: depths on a grid that has the light in its centre."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vizlight.geometry.lines import voxels

if TYPE_CHECKING:
    from vizlight._types import Array, Indices, VectorLike

#: Factor of the depth per diameter by which lines shade one another less.
CROWDING = 1 / 4
#: Largest number of parts of a piece near a light, along it and over its width.
MOST_PARTS = 512
#: Largest number of pieces that are added by such cuts.
MOST_PIECES = 2_000_000
#: Largest share of a voxel that a line takes from the light.
WIDEST = 0.99
#: Least width of a voxel near a light, and least distance from it, in voxels.
NARROWEST = 1e-6


def depths(
    middles: Array, vectors: Array, places: Array, lamp: VectorLike, thick: float = 0.0, /
) -> tuple[Array, Array]:
    """Return the optical depth per diameter between points and a light nearby.

    The grid has the light in its centre: on each of the six faces of a cube around it, voxels
    are cones whose width grows with the distance. Near the light they are narrower than a
    line, which is then spread over the width that it shows, and opaque where it covers a cone.

    Parameters
    ----------
    middles, vectors : ndarray of float32, shape (3, M)
        Middle and vector of each piece, in voxels.
    places : ndarray of float32, shape (3, N)
        Places, in voxels.
    lamp : sequence of float, shape (3,)
        Place of the light, inside or outside the bundle, in voxels.
    thick : float, default: 0.0
        Diameter of the lines in voxels; the depth includes its factor for lines in one another's
        shadow.

    Returns
    -------
    depth : ndarray of float32, shape (N,)
        Depths, the point's own line included.
    width : ndarray of float32, shape (N,)
        Width of the voxels at the points, in voxels of the medium.
    """
    centre = np.asarray(lamp, np.float64)[:, np.newaxis]
    at = places - centre
    gone, far = size(middles - centre), size(at)
    out = np.zeros(at.shape[1], np.float32)
    widths: Array = np.ones(at.shape[1], np.float32)
    if not gone.size:
        return out, widths
    width = 1 / max(float(np.median(gone)), 1.0)
    middles, vectors, share = _for_cones(middles - centre, vectors, width, thick)
    gone = size(middles)
    across = share * size(np.cross(vectors, middles, axis=0)) / np.maximum(gone, NARROWEST)
    across *= crowding(thick / np.maximum(width * gone, NARROWEST))
    face = np.argmax(np.abs(at), axis=0)
    for axis in range(3):
        for side in (1, -1):
            rows = np.flatnonzero((face == axis) & (side * at[axis] > 0))
            held = np.flatnonzero(side * middles[axis] > 0)
            if rows.size and held.size:
                part = _Cone(axis, side, width)
                seen = part.seen(at[:, rows])
                out[rows] = part.depth(
                    seen, far[rows], part.seen(middles[:, held]), gone[held], across[held]
                )
                height = side * at[axis, rows]
                widths[rows] = width * height * np.sqrt(height / far[rows])
    return out, widths


class _Cone(NamedTuple):
    """One of the six pyramids around a light, cut into cones of an angular width."""

    axis: int
    side: int
    width: float

    def seen(self, rows: Array) -> Array:
        """Return the tangents of the two angles under which the light sees rows, in widths."""
        height = self.side * rows[self.axis]
        others = [i for i in range(3) if i != self.axis]
        seen: Array = rows[others] / (height * self.width)
        return seen

    def depth(self, seen: Array, far: Array, held: Array, gone: Array, across: Array) -> Array:
        """Return the depth between the light and points at distances, for pieces at distances."""
        reach = far.max()
        low = seen.min(axis=1, keepdims=True) - 2
        high = seen.max(axis=1, keepdims=True) + 2
        inside = ((held > low) & (held < high)).all(axis=0) & (gone < reach + 2)
        if not inside.any():
            return np.zeros(len(far), np.float32)
        held, gone, across = held[:, inside], gone[inside], across[inside]
        # Height over the light of the plane that is divided into squares, in voxels.
        slant = np.sqrt(1 + self.width**2 * (held * held).sum(axis=0))
        area = (self.width * gone) ** 2 / slant**3
        rows = np.concatenate([held, gone[np.newaxis]])
        low, shape = voxels.box(rows)
        grid = voxels.spread((rows - low).astype(np.float32), across / area, shape)
        voxels.summed(grid)
        cells = np.concatenate([seen, far[np.newaxis]]) - low
        limits = np.array(shape, np.float64)[:, np.newaxis] - 2
        return voxels.read(grid, np.clip(cells, 0, limits).astype(np.float32))


def size(rows: Array) -> Array:
    """Return the lengths of vectors in columns."""
    size: Array = np.sqrt((rows * rows).sum(axis=0))
    return size


def crowding(thick: Array) -> Array:
    """Return the factor of the depth in voxels, from the diameter of the lines in voxels.

    It is ``1 + d / 4`` where voxels are much wider than lines, as for a light at infinity: -log(1 -
    d / 2) is the depth that leaves the light which a line of half the width leaves.
    """
    share = np.minimum(2 * CROWDING * thick, WIDEST)
    factor: Array = -np.log1p(-share) / np.maximum(share, NARROWEST)
    return np.where(share > NARROWEST, factor, 1)


def _for_cones(
    middles: Array, vectors: Array, width: float, thick: float
) -> tuple[Array, Array, Array]:
    """Return pieces cut again where cones from a light are narrower, and the share of each.

    A piece is cut along its length, and into parallel pieces over the width of the line.
    """
    parts = _limited(size(vectors) / (width * _nearest(middles, vectors)))
    middles, vectors = voxels.cut(middles, vectors, parts)
    across = np.cross(vectors, middles, axis=0)
    reach = np.maximum(size(across), NARROWEST**2)
    # The two planes that touch a cylinder are farther apart than its diameter where it is near.
    sine = thick * size(vectors) / (2 * reach)
    wider = 1 / np.sqrt(1 - np.minimum(sine, WIDEST) ** 2)
    across *= thick * wider / reach
    parts = _limited(2 * thick * wider / (width * _nearest(middles, vectors)))
    middles, across = voxels.cut(middles, across, parts)
    return middles, np.repeat(vectors, parts, axis=1), np.repeat(wider / parts, parts)


def _nearest(middles: Array, vectors: Array) -> Array:
    """Return the least distances of pieces from the light."""
    square = np.maximum((vectors * vectors).sum(axis=0), NARROWEST**4)
    place = np.clip(-(middles * vectors).sum(axis=0) / square, -0.5, 0.5)
    return np.maximum(size(middles + place * vectors), NARROWEST)


def _limited(parts: Array) -> Indices:
    """Return whole numbers of parts, fewer of the largest where there would be too many pieces."""
    most = MOST_PARTS
    while True:
        number = np.ceil(np.clip(parts, 1, most)).astype(np.intp)
        if most <= 1 or number.sum() <= len(number) + MOST_PIECES:
            return number
        most //= 2
