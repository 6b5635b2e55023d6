"""From where data are seen: maps from above, open patches along their normal, solids from a side.

All is decided from a sample of points and cells.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv
import scipy
from numpy.typing import ArrayLike

from vizlight._types import Array, Bools, Indices, Vector
from vizlight.looks.contents import LAYER, Contents
from vizlight.mesh import georeference, meaning
from vizlight.mesh.creases import creases
from vizlight.vtk.cells import connectivity

if TYPE_CHECKING:
    from collections.abc import Sequence

    from vizlight.looks.steps import Step

#: Most points or cells that are looked at.
SAMPLE = 20_000
#: Length of the sum of the normals of a surface, as a share of its area, from which it is an open
#: patch that is seen along that sum.
OPEN = 0.6
#: Azimuths and altitudes of the eye, in degrees, among which the best one is taken.
AZIMUTHS, ALTITUDES = range(-155, 205, 45), (20.0, 35.0)
#: The same around a surface that its box cuts: near the diagonals of the box, from where it is seen
#: through most of its openings.
DIAGONALS, ABOVE_BOX = range(-130, 230, 90), (30.0,)
#: How much more a view counts in which all creases are seen.
CREASED = 0.3
#: Length of the sum of the normals of a surface, as a share of its area, up to which it is closed.
CLOSED = 0.1
#: Least distance between the distributions of values on two sides that are both shown.
OTHER = 0.15
#: Share of the area of a kind up to which it is not seen.
GLIMPSE = 0.03
#: Power of the length of a body across the picture, over that in space, by which a view counts.
ACROSS = 2
#: How much more a view counts in which vectors run to the right.
RIGHTWARD = 0.1
#: Pixels along each side of the picture in which self-occlusion is counted.
PIXELS = 64
#: Width over height of the place for data in a picture.
ASPECT = 1.2
#: Number of places of triangles that hide others.
SPLATS = 8000
#: Number of triangles by which the light of the visible surface is measured.
SEEN = 1000
#: Turn that takes y to z.
Y_TO_Z = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
#: Shares of the height within which points are a base, even or uneven; least size of one on which a
#: thing stands, as a share of that of its shadow, and largest of the others, as one of this one's.
FEET, STANDS, SMALL_BASE = (0.02, 0.05), 0.25, 0.25
#: Least correlation of temperatures with y, and largest with z, where y is up.
RISING, LEVEL = 0.4, 0.1
#: Formats of models of everyday things, which usually have y up.
MODELS = {".obj", ".off"}
#: Number of places of a surface that are mirrored, largest mean distance between it and its mirror
#: image, in that of neighbouring places, and least of another image, in the distance of this one.
MIRRORED, ALIKE, UNLIKE = 4000, 2.5, 1.5
#: How much more the side of a body counts than other views, and how far the middle of what is on
#: its left is from that of the body, as a share of its width.
NEARLY_AS_LARGE, BESIDE = 1.3, 0.1
#: Words for the sides of a body, x to the right, y forward and z up.
SIDES: dict[Vector, str] = {
    (1.0, 0.0, 0.0): "from the right", (-1.0, 0.0, 0.0): "from the left",
    (0.0, 1.0, 0.0): "from the front", (0.0, 0.0, 1.0): "from above",
}  # fmt: skip
#: Direction from what a camera sees to the right of it and above, where depths are seen too.
BESIDE_CAMERA = (0.2, -1.0, 0.25)
#: Long side over short side from which a flat strip is turned along the picture.
STRIP = 4.0


@dataclass(frozen=True)
class Viewpoint:
    """Direction toward the eye, direction up in the picture, and whether projection is parallel."""

    toward: Vector
    up: Vector
    parallel: bool = False
    words: str = ""


@dataclass(frozen=True)
class Views:
    """Views of a mesh that stand beside each other.

    ``toward`` are the directions toward the eye, ``up`` those up in the picture, by default the
    usual ones, ``names`` the words above the views, and ``ends`` those below the left and the right
    end of each. ``unit`` is that of coordinates, for a bar of lengths, and ``words`` are for the
    eye. The views of the numbers ``shown`` show the mesh, by default all.
    """

    toward: tuple[Vector, ...]
    names: tuple[str, ...]
    up: tuple[Vector, ...] | None = None
    ends: tuple[tuple[str, str], ...] = ()
    unit: str = ""
    words: str = ""
    shown: tuple[int, ...] | None = None

    @property
    def eye(self) -> Viewpoint:
        """Eye that sees all views: that of the first."""
        up: Vector = (0.0, 1.0, 0.0) if abs(self.toward[0][2]) > 0.999 else (0.0, 0.0, 1.0)
        return Viewpoint(self.toward[0], self.up[0] if self.up else up, True, self.words)


@dataclass(frozen=True)
class Inset:
    """Smaller view beside the main one.

    ``name`` stands above it and ``ends`` below its left and its right end. ``mesh`` is a part that
    is shown in it, such as a section, by default what the main view shows.
    """

    toward: Vector
    up: Vector
    name: str
    ends: Sequence[str] = ()
    mesh: Step | None = None


@dataclass(frozen=True)
class Strip:
    """Insets beside or below the main view, from the upper left.

    ``share`` is that of the width or the height of the room that is left for the main view.
    """

    insets: tuple[Inset, ...]
    share: float
    is_below: bool


#: Eye that sees three sides alike.
ISOMETRIC = Viewpoint((1.0, 1.0, 1.0), (0.0, 0.0, 1.0))


def eye_of(
    mesh: pv.DataSet, contents: Contents, shown: str | None = None, *, is_model: bool = False
) -> Viewpoint:
    """Return from where a mesh is seen best.

    ``contents`` are those of the data of which it is drawn, and ``shown`` is the name of an array:
    values, with much of their range to be seen, or the vectors of a volume, which should run across
    the picture. Of a file of ``MODELS`` y is up, unless the surface is mirrored in y and not in z,
    as things are in a plane that stands.
    """
    if contents.flat_axis is not None:
        return _above(mesh, contents.flat_axis)
    if mesh.n_cells and mesh.max_cell_dimensionality == 2 and isinstance(mesh, pv.PolyData):
        array = None if shown is None else contents.named(shown)
        has_kinds = array is not None and array.role == "kinds"
        return _of_surface(mesh, shown, is_model=is_model, has_kinds=has_kinds)
    if meaning.of(mesh).axes == meaning.CAMERA:
        return Viewpoint(BESIDE_CAMERA, (0.0, 0.0, 1.0), False, "from beside the camera")
    points = _finite(mesh.points)
    extent = np.ptp(points, axis=0) if len(points) else points
    if contents.dimension == 3 and len(extent) == 3 and extent.min() < LAYER * np.median(extent):
        # Data in a slab, such as a flow between two plates, are seen across it.
        return _above(mesh, int(np.argmin(extent)))
    rows = _vectors(mesh, shown) if contents.dimension == 3 else None
    if contents.dimension != 3 or not _rises_along_y(mesh):
        return _of_points(points, rows)
    turned = None if rows is None else rows @ Y_TO_Z.T
    return _with_y_up(_of_points(points @ Y_TO_Z.T, turned))


def _rises_along_y(mesh: pv.DataSet) -> bool:
    """Return whether what is warm is high where y is up, and not where z is."""
    data = mesh.point_data
    warm = next((name for name in data if meaning.is_temperature(mesh, name)), None)
    if warm is None or data[warm].ndim != 1:
        return False
    rows = _finite(np.column_stack([data[warm], mesh.points[:, 1:]]))
    if len(rows) < 2 or not np.ptp(rows, axis=0).all():
        return False
    along_y, along_z = np.atleast_2d(np.corrcoef(rows.T))[0, 1:]
    return bool(along_y > RISING and abs(along_z) < LEVEL)


def _with_y_up(eye: Viewpoint) -> Viewpoint:
    """Return the eye of data that were looked at as if y were z."""
    toward = _vector(Y_TO_Z.T @ eye.toward)
    return Viewpoint(toward, (0.0, 1.0, 0.0), False, f"{eye.words}, y up")


def _vectors(mesh: pv.DataSet, shown: str | None) -> Array | None:
    """Return some finite vectors of the points of a mesh, None if it has none."""
    if shown is None or shown not in mesh.point_data or mesh.point_data[shown].ndim != 2:
        return None
    return _finite(mesh.point_data[shown])


def _above(mesh: pv.DataSet, axis: int) -> Viewpoint:
    """Return the eye above a flat mesh, north up; a strip lies along the picture."""
    toward = tuple(float(i == axis) * (-1.0 if axis == 1 else 1.0) for i in range(3))
    up: Vector = (0.0, 1.0, 0.0) if axis == 2 else (0.0, 0.0, 1.0)
    words = "from above, north up" if axis == 2 else f"along {'xyz'[axis]}"
    if section := meaning.of(mesh).section:
        upward = {"time": "time", "latitude": "north"}.get(section[1].title, "height")
        return Viewpoint(toward, up, True, f"with {upward} up")
    right = np.cross(up, toward)
    points = _finite(mesh.points)
    flat = np.stack([points @ right, points @ np.asarray(up)], axis=1)
    if len(flat) > 2:
        # Meridians and parallels are beside a map: it is turned by a right angle if at all.
        is_map = axis == 2 and georeference.is_map(mesh)
        along = flat - flat.mean(axis=0)
        axes = np.eye(2)[::-1] if is_map else np.linalg.svd(along, full_matrices=False)[2]
        sides = np.ptp(flat @ axes.T, axis=0)
        if sides[0] > STRIP * sides[1] and np.ptp(flat[:, 1]) > np.ptp(flat[:, 0]) / STRIP:
            # The long side to the right, and up on the side where up was.
            across = axes[1] * (1.0 if axes[1, 1] >= 0 else -1.0)
            turned = across[0] * right + across[1] * np.asarray(up)
            up, words = _vector(turned), "turned to lie along the picture"
    return Viewpoint(toward, up, True, words)


def _of_surface(
    surface: pv.PolyData, shown: str | None, *, is_model: bool, has_kinds: bool
) -> Viewpoint:
    corner_ids, corners, faces = _triangles(surface)
    if not len(corners):
        return _of_points(_finite(surface.points))
    corners, normals = _with_normals(corners)
    areas = np.linalg.norm(normals, axis=1)
    total = normals.sum(axis=0)
    if np.linalg.norm(total) > OPEN * areas.sum() > 0:
        toward = total / np.linalg.norm(total)
        if toward[2] < -0.5:  # ground is seen from above, however its cells are wound
            toward = -toward
        up = (0.0, 1.0, 0.0) if abs(toward[2]) > 0.9 else (0.0, 0.0, 1.0)
        return Viewpoint(_vector(toward), up, False, "along its mean normal")
    values, edges = _values(surface, shown, corner_ids, faces), _creases(surface)
    if is_model:
        has_z_up = _lies_along_y(corners, areas) or stands_along_y(corners @ Y_TO_Z, areas)
    has_y_up = not has_z_up if is_model else stands_along_y(corners, areas)
    if not has_y_up:
        return _around(corners, normals, edges, _ways(), values, has_kinds=has_kinds)
    # As if y were z, and back.
    corners, normals, edges = (rows @ Y_TO_Z.T for rows in (corners, normals, edges))
    eye = _around(corners, normals, edges, _ways(), values, has_kinds=has_kinds)
    return _with_y_up(eye)


def _with_normals(corners: Array) -> tuple[Array, Array]:
    """Return corners of triangles, the farthest at 1, and normals twice as long as the areas."""
    # No area is beyond the largest number, and no direction depends on lengths.
    corners = corners / (np.abs(corners).max() or 1.0)
    return corners, np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def stands_along_y(corners: Array, areas: Array) -> bool:
    """Return whether a surface stands on its lowest points along y, and on no others.

    It does where its middle is above the hull of these points, which is a large part of the shadow
    that it has along y, and where that of its highest ones, and those along z, are small. Corners
    have the shape (N, 3, 3), and areas, in any unit, (N,).
    """
    kept = np.isfinite(corners).all(axis=(1, 2)) & np.isfinite(areas)
    corners, areas = corners[kept], areas[kept]
    if not areas.sum() > 0:
        return False
    points = corners.reshape(-1, 3)
    middle = np.average(corners.mean(axis=1), axis=0, weights=areas)
    for foot in FEET:
        share = _base(points, middle, 1, 1, foot)
        others = (
            _base(points, None, axis, sign, foot) for axis, sign in ((1, -1), (2, 1), (2, -1))
        )
        if share > STANDS and all(other < SMALL_BASE * share for other in others):
            return True
    return False


def _lies_along_y(corners: Array, areas: Array) -> bool:
    """Return whether a surface is its own mirror image in y and not in z."""
    if not areas.sum() > 0:
        return False
    places = _spread_over(corners, areas, MIRRORED)
    tree = scipy.spatial.cKDTree(places)
    distances: Array = np.asarray(tree.query(places, k=2)[0])
    apart = np.median(distances[:, 1])
    ends = corners.min(axis=(0, 1)) + corners.max(axis=(0, 1))
    across_y, across_z = (
        np.mean(tree.query(np.where(np.arange(3) == axis, ends - places, places))[0])
        for axis in (1, 2)
    )
    return bool(across_y < ALIKE * apart and across_z > UNLIKE * across_y)


def _base(points: Array, middle: Array | None, axis: int, sign: int, foot: float) -> float:
    """Return the hull of the points at an end of an axis over that of all, seen along the axis.

    They are within a share of the height. 0 where a middle is given that is not above their hull,
    or this is too small to stand on.
    """
    heights, flat = sign * points[:, axis], np.delete(points, axis, axis=1)
    low = heights < heights.min() + foot * np.ptp(heights)
    # A hull is at least half of the box around it, and SciPy's hulls take a while to import.
    most = 2 * np.prod(np.ptp(flat[low], axis=0)) / (np.prod(np.ptp(flat, axis=0)) or 1.0)
    if middle is not None and most <= STANDS:
        return 0.0
    try:
        whole, base = scipy.spatial.ConvexHull(flat), scipy.spatial.ConvexHull(flat[low])
    except scipy.spatial.QhullError:
        return 0.0  # fewer than three points, or all in a line
    if middle is not None:
        sides = base.equations @ np.append(np.delete(middle, axis), 1.0)
        if sides.max() > 0:
            return 0.0
    return float(base.volume / whole.volume)


def _creases(surface: pv.PolyData) -> Array:
    """Return the ends of the creases of a surface, (N, 2, 3), with its farthest coordinate at 1."""
    edges = creases(surface)
    if not edges.n_cells:
        return np.empty((0, 2, 3))
    ends: Array = np.asarray(edges.points, dtype=np.float64)[edges.lines.reshape(-1, 3)[:, 1:]]
    return ends / (np.abs(surface.points).max() or 1.0)


def _values(
    surface: pv.PolyData, shown: str | None, corner_ids: Indices, faces: Indices
) -> Array | None:
    """Return the rows of an array at faces, or at their first corners, None without an array."""
    if shown is None:
        return None
    if shown in surface.point_data:
        at_corners: Array = np.asarray(surface.point_data[shown], dtype=np.float64)[
            corner_ids[:, 0]
        ]
        return at_corners
    if shown in surface.cell_data:
        # Cells of points and lines come before faces.
        first = surface.GetNumberOfVerts() + surface.GetNumberOfLines()
        of_cells: Array = np.asarray(surface.cell_data[shown], dtype=np.float64)[first + faces]
        return of_cells
    return None


def eye_around(surface: pv.PolyData, *, cut: bool = False, in_body: bool = False) -> Viewpoint:
    """Return the eye that sees most of a surface of a volume from the side, open or not.

    With ``cut`` its box cuts it. ``in_body`` the eye is at the right, before or above.
    """
    _, corners, _ = _triangles(surface)
    if not len(corners):
        return _of_points(_finite(surface.points))
    corners, normals = _with_normals(corners)
    ways = _ways(DIAGONALS, ABOVE_BOX) if cut else [*np.eye(3)] if in_body else _ways()
    eye = _around(corners, normals, _creases(surface), ways)
    return replace(eye, up=_vector(_plane(np.array(eye.toward))[1])) if in_body else eye


def eye_across(mesh: pv.PolyData) -> Viewpoint:
    """Return the eye for data without a side that is up: long side across, thin one in depth."""
    points = _finite(mesh.points)
    if len(points) < 2:
        return ISOMETRIC
    axes = np.linalg.eigh(np.cov(points.T))[1].T
    # Of both senses the one along its largest part.
    largest = np.argmax(np.abs(axes), axis=1)
    axes *= np.sign(np.take_along_axis(axes, largest[:, None], axis=1))
    return Viewpoint(_vector(axes[0]), _vector(axes[1]), False, "with its long side across")


def eye_on_body(mesh: pv.DataSet) -> Viewpoint:
    """Return the eye for data in the axes of a body: at its right or left, before or above it.

    The data are largest from there; a side is preferred if they are nearly as large from it. x is
    to the right, y forward and z up.
    """
    points = _finite(mesh.points)
    if not len(points):
        return ISOMETRIC
    low, middle, high = np.percentile(points, (5, 50, 95), axis=0)
    seen = np.prod(high - low) / np.maximum(high - low, 1e-30) * (NEARLY_AS_LARGE, 1.0, 1.0)
    axis = int(np.argmax(seen))
    # The outer side of what is on the left is toward the eye.
    sign = -1.0 if axis == 0 and middle[0] < -BESIDE * (high - low)[0] else 1.0
    return side_of_body(_vector(sign * np.eye(3)[axis]))


def side_of_body(toward: Vector) -> Viewpoint:
    """Return the eye on a side of a body, one of ``SIDES``."""
    return Viewpoint(
        toward, (0.0, float(toward[2] > 0), float(toward[2] <= 0)), False, SIDES[toward]
    )


def _around(
    corners: Array,
    normals: Array,
    edges: Array,
    ways: list[Array],
    values: Array | None = None,
    *,
    has_kinds: bool = False,
) -> Viewpoint:
    """Return the eye from which most of some triangles is seen, of their values, and of creases."""
    if values is not None and values.ndim > 1:
        values = None
    places = _places(corners)
    areas = np.linalg.norm(normals, axis=1)
    lengths, middles = np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1), edges.mean(axis=1)
    whole = float(lengths.sum())
    # The same from everywhere.
    spread = np.cov(corners.mean(axis=1).T, aweights=areas) if areas.sum() > 0 else np.eye(3)
    scores = []
    for way in ways:
        score = _seen(corners, places, normals, areas, way, values, has_kinds=has_kinds)
        if whole > 0:
            front = _in_front(np.concatenate([middles, places]), len(middles), way)
            score *= 1 + CREASED * float(lengths[front].sum()) / whole
        scores.append((score * _length_across(spread, way) ** ACROSS, way))
    best = max(scores, key=lambda pair: pair[0])[1]
    return Viewpoint(_vector(best), (0.0, 0.0, 1.0), False, "from where most of it is seen")


def eye_opposite(
    surface: pv.PolyData, eye: Viewpoint, shown: str, *, has_kinds: bool
) -> Viewpoint | None:
    """Return the eye that sees most of what another one does not see of a closed surface.

    ``shown`` is the name of an array. None is returned for open surfaces, and where values, or the
    lengths of vectors, are alike on both sides, or all kinds are seen.
    """
    corner_ids, corners, faces = _triangles(surface)
    if not len(corners):
        return None
    corners, normals = _with_normals(corners)
    areas = np.linalg.norm(normals, axis=1)
    if not areas.sum() > 0 or not _is_closed(normals, areas):
        return None
    places, toward, up = _places(corners), np.asarray(eye.toward), np.asarray(eye.up)
    front = _in_front(places, len(corners), toward)
    values = _values(surface, shown, corner_ids, faces)
    if values is None:
        return None
    values = values if values.ndim == 1 else np.linalg.norm(values, axis=1)
    if has_kinds:
        is_alike = _shares_of_kinds(values, areas * front, areas).min() > GLIMPSE
    else:
        is_alike = apart(values, areas * front, areas * ~front) < OTHER
    if is_alike:
        return None
    toward, up = toward / np.linalg.norm(toward), up / np.linalg.norm(up)
    height = (toward @ up) * up
    ways = {
        "From behind": 2 * height - toward, "From below": toward - 2 * height,
        "From behind, below": -toward,
    }  # fmt: skip
    hidden = areas * ~front
    seen = {word: hidden[_in_front(places, len(corners), way)].sum() for word, way in ways.items()}
    word = max(seen, key=lambda name: float(seen[name]))
    return Viewpoint(_vector(ways[word]), eye.up, True, word)


def _is_closed(normals: Array, areas: Array) -> bool:
    return bool(np.linalg.norm(normals.sum(axis=0)) <= CLOSED * areas.sum())


def apart(values: Array, weights: Array, others: Array) -> float:
    """Return the largest difference of the cumulative distributions of values by two weights.

    All have the shape (N,).
    """
    kept = np.isfinite(values)
    order = np.argsort(values[kept])
    sums = [np.cumsum(each[kept][order]) for each in (weights, others)]
    if not all(len(each) and each[-1] > 0 for each in sums):
        return 0.0
    steps = np.flatnonzero(np.diff(values[kept][order], append=np.inf))
    first, second = (each[steps] / each[-1] for each in sums)
    return float(np.abs(first - second).max())


def _length_across(spread: Array, way: Array) -> float:
    """Return the length across the picture, over that in space, of a surface of a covariance."""
    flat = np.stack(_plane(way))
    across, whole = (np.linalg.eigvalsh(each)[-1] for each in (flat @ spread @ flat.T, spread))
    return float(np.sqrt(across / whole)) if whole > 0 else 1.0


def _of_points(points: Array, vectors: Array | None = None) -> Viewpoint:
    """Return the eye from which points spread most, and vectors run across the picture."""
    if len(points) < 2:
        return ISOMETRIC
    spreads = []
    for way in _ways():
        right, up = _plane(way)
        flat = np.stack([points @ right, points @ up], axis=1)
        wide, tall = np.subtract(*np.percentile(flat, (98, 2), axis=0))
        spread = float(wide * tall) + 1e-3 * float(wide) ** 2
        if vectors is not None:
            across = np.hypot(vectors @ right, vectors @ up).sum()
            whole = np.linalg.norm(vectors, axis=1).sum() or 1.0
            # Flow is read from left to right.
            rightward = float((vectors @ right).sum() / whole)
            spread *= float(across / whole) ** 2 * (1 + RIGHTWARD * rightward)
        spreads.append((spread, way))
    best = max(spreads, key=lambda pair: pair[0])[1]
    return Viewpoint(_vector(best), (0.0, 0.0, 1.0), False, "from where it spreads most")


def _seen(
    corners: Array,
    places: Array,
    normals: Array,
    areas: Array,
    way: Array,
    values: Array | None,
    *,
    has_kinds: bool,
) -> float:
    """Return the area that an eye at infinity sees, by how much of a picture it fills.

    Where the values in the picture spread as much as all do, it counts twice; of kinds it counts by
    the mean share of each that is seen.
    """
    right, up = _plane(way)
    facing = normals @ way / np.where(areas > 0, areas, 1)
    # Open surfaces are seen from both sides, thin walls of kinds from that which faces the eye.
    cosines = facing if has_kinds and _is_closed(normals, areas) else np.abs(facing)
    front = areas * _in_front(places, len(corners), way) * (cosines > 0.15)
    seen = float(front.sum())
    if values is not None:
        # Faces without a value show nothing.
        front = front * np.isfinite(values)
        seen = float(front.sum())
        if has_kinds:
            seen *= float(_shares_of_kinds(values, front, areas).mean())
        else:
            spread = _spread(values, front * cosines) / (_spread(values, areas) or 1.0)
            seen *= 1 + min(spread, 1.0)
    rows = corners.reshape(-1, 3)
    tall = max(np.ptp(rows @ up), np.ptp(rows @ right) / ASPECT)
    return seen * math.sqrt((front * cosines).sum()) / (float(tall) or 1.0)


def _shares_of_kinds(values: Array, front: Array, areas: Array) -> Array:
    """Return the share of the area of each kind that is in front."""
    kinds = np.unique(values, return_inverse=True)[1].reshape(-1)
    shares: Array = np.bincount(kinds, front) / np.maximum(np.bincount(kinds, areas), 1e-300)
    return shares


def _spread(values: Array, weights: Array) -> float:
    """Return the standard deviation of the finite ones of some values."""
    kept = np.isfinite(values)
    values, weights = values[kept], weights[kept]
    total = weights.sum()
    if not total > 0:
        return 0.0
    mean = (weights * values).sum() / total
    return float(np.sqrt((weights * (values - mean) ** 2).sum() / total))


def _places(corners: Array) -> Array:
    """Return the middles of triangles, then places of these that hide others behind them."""
    areas = np.linalg.norm(_with_normals(corners)[1], axis=1)
    # Large triangles hide what is behind more than their middles.
    others = [_spread_over(corners, areas, SPLATS)] if areas.sum() > 0 else []
    return np.concatenate([corners.mean(axis=1), *others])


def _spread_over(corners: Array, areas: Array, count: int) -> Array:
    """Return places of triangles, as many on each as its area is large."""
    random = np.random.default_rng(0)
    chosen = random.choice(len(corners), count, p=areas / areas.sum())
    places: Array = np.einsum("sk,skx->sx", random.dirichlet(np.ones(3), count), corners[chosen])
    return places


def _in_front(places: Array, count: int, way: Array) -> Bools:
    """Return whether an eye at infinity sees the first of some places, which hide one another."""
    flat = [places @ axis for axis in _plane(way)]
    size = max(np.ptp(axis) for axis in flat) or 1.0
    x, y = (
        np.round((axis - axis.min()) / size * (PIXELS - 1)).astype(np.int64) + 1 for axis in flat
    )
    nearest = np.full((PIXELS + 2, PIXELS + 2), -np.inf)
    pixel, depth = x * (PIXELS + 2) + y, places @ way
    np.maximum.at(nearest.reshape(-1), pixel, depth)
    # Pixels that no place fell into are covered by their neighbours.
    nearest[1:-1] = np.maximum(np.maximum(nearest[:-2], nearest[2:]), nearest[1:-1])
    nearest[:, 1:-1] = np.maximum(np.maximum(nearest[:, :-2], nearest[:, 2:]), nearest[:, 1:-1])
    # Cells in neighbouring pixels differ by a slope of up to two.
    front: Bools = depth[:count] >= nearest.reshape(-1)[pixel[:count]] - 4 * size / PIXELS
    return front


def places_on(surface: pv.PolyData) -> Array:
    """Return the points of a surface and others by the area of its triangles, shape (N, 3)."""
    return np.concatenate([surface.points, _places(_triangles(surface)[1])])


def sees(places: Array, place: Array, way: Array) -> bool:
    """Return whether an eye at infinity sees a place on a surface.

    ``places`` are those of the surface, by :func:`places_on`, and ``way`` is the unit vector toward
    the eye.
    """
    return bool(_in_front(np.concatenate([[place], places]), 1, way)[0])


def seen_triangles(surface: pv.PolyData, toward: Vector) -> Indices:
    """Return the corners of some triangles that an eye sees, each by its share of the picture.

    They have the shape (SEEN, 3), or (0, 3) where nothing is seen.
    """
    corner_ids, corners, _ = _triangles(surface)
    way = np.asarray(toward, dtype=np.float64) / np.linalg.norm(toward)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    if not len(corner_ids):
        return corner_ids
    share = np.abs(normals @ way) * _in_front(_places(corners), len(corners), way)
    total = share.sum()
    if not total > 0:
        return corner_ids[:0]
    chosen: Indices = np.random.default_rng(0).choice(len(corner_ids), SEEN, p=share / total)
    return corner_ids[chosen]


def _ways(azimuths: range = AZIMUTHS, altitudes: tuple[float, ...] = ALTITUDES) -> list[Array]:
    """Return directions toward the eye, the usual one of three-quarters first."""
    ways = []
    for altitude, azimuth in itertools.product(altitudes, azimuths):
        a, b = math.radians(azimuth), math.radians(altitude)
        ways.append(np.array([math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b)]))
    return ways


def _plane(way: Array) -> tuple[Array, Array]:
    right = np.cross((0.0, 0.0, 1.0), way)
    if not right.any():
        right = np.array([1.0, 0.0, 0.0])
    right /= np.linalg.norm(right)
    return right, np.cross(way, right)


def _triangles(surface: pv.PolyData) -> tuple[Indices, Array, Indices]:
    """Return three corners of some faces, and the numbers of these, shape (count,).

    The corners are given by their numbers, (count, 3), and places, (count, 3, 3).
    """
    ids, ends = connectivity(surface.GetPolys())
    sizes = np.diff(ends)
    faces = np.flatnonzero(sizes >= 3)
    faces = faces[:: max(len(faces) // SAMPLE, 1)]
    places = ids[ends[faces][:, np.newaxis] + np.arange(3)] if len(faces) else np.empty((0, 3), int)
    corners: Array = np.asarray(surface.points, dtype=np.float64)[places]
    # A corner that is not finite takes its face with it.
    kept = np.isfinite(corners).all(axis=(1, 2))
    return places[kept], corners[kept], faces[kept]


def _finite(values: ArrayLike) -> Array:
    """Return those of some rows, evenly spaced, that are finite."""
    rows: Array = np.asarray(values, dtype=np.float64)
    rows = rows[:: max(len(rows) // SAMPLE, 1)]
    return rows[np.isfinite(rows).all(axis=1)]


def _vector(values: Array) -> Vector:
    """Return a direction in numbers that a script can show."""
    return tuple(round(float(value), 4) for value in values)
