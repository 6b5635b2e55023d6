"""Numbers along edges of a box, and words around blocks, as meshes of letters that face the eye."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Given, Indices
from vizlight.draw.cameras import Mesh, common_bounds, footprint, outermost
from vizlight.draw.map_frames import rectangle
from vizlight.draw.ticks import even_numbers, round_length
from vizlight.mesh import blocks
from vizlight.vtk import letters
from vizlight.vtk.letters import DIGIT

#: Length of ticks, their width, and distance of words from them, in heights of letters.
TICK, LINE, GAP = 0.4, 0.07, 0.25
#: Least length of an edge, and of the distance between its numbers, in heights of letters.
SHORTEST, APART = 3.0, 4.0
#: Most numbers along an edge.
MOST = 5
#: Longest bar of lengths, in the width of a block, and its width in heights of letters.
BAR, THICK = 0.4, 0.2
#: Distance of a bar from words above it, between which it has no room, in heights of letters.
LOWER = 1.3


def box_axes(
    mesh: pv.DataSet,
    camera: pv.Camera,
    /,
    height: float,
    *,
    size: float,
    names: Sequence[str] = ("x", "y", "z"),
) -> pv.PolyData:
    """Return ticks, numbers and names along three edges of the box of a mesh.

    The edges are those between a side that is seen and one that is not, so that nothing stands
    before or behind the data: the lower ones of x and y, and one of z beside the box.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, whose bounding box counts.
    camera : pyvista.Camera
        Camera of the picture.
    height : float
        Height of the part of the picture that shows the data, in pixels.
    size : float
        Height of letters in pixels.
    names : sequence of str, default: ("x", "y", "z")
        Names of the three axes, such as ``"x (mm)"``.

    Returns
    -------
    pyvista.PolyData
        Triangles; empty where the box has no extent.

    Raises
    ------
    TypeError, ValueError
        If the mesh has no finite box, the camera is none, a height is not positive, or the names
        are not three texts.
    """
    box = _box_of(mesh)
    names = _check.texts("names", names, 3)
    height, size = _check.positive("height", height), _check.positive("size", size)
    eye = _Eye(camera, height)
    parts = [part for axis in range(3) for part in _along(box, axis, names[axis], eye, size)]
    if not parts:
        return pv.PolyData()
    return blocks.polydata(*letters.union(parts))


def box_edges(mesh: pv.DataSet, camera: pv.Camera, /) -> pv.PolyData:
    """Return the edges of the box of a mesh that do not stand before it.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, whose bounding box counts.
    camera : pyvista.Camera
        Camera of the picture.

    Returns
    -------
    pyvista.PolyData
        Lines of two points.

    Raises
    ------
    TypeError, ValueError
        If the mesh has no finite box, or the camera is none.
    """
    box, eye = _box_of(mesh), _Eye(camera, 1.0)
    ends = [
        edge
        for axis in range(3)
        for edge in _edges(box, axis)
        if not all(_sides_seen(box, axis, edge, eye))
    ]
    return blocks.polydata(np.concatenate(ends), np.arange(2 * len(ends)).reshape(-1, 2))


def captions(
    meshes: Mesh,
    camera: pv.Camera,
    /,
    height: float,
    *,
    size: float,
    ends: Sequence[Sequence[str]] = (),
    unit: str = "",
    names: Sequence[str] | None = None,
) -> pv.PolyData:
    """Return words around blocks: their names above them, their ends below, and a bar of lengths.

    Parameters
    ----------
    meshes : mesh
        Blocks; another mesh has no name.
    camera, height, size
        As for :func:`box_axes`.
    ends : sequence of (str, str), optional
        Words below the left and the right end of each block.
    unit : str, optional
        Unit of the coordinates, with which a bar of a round length stands below the last block. In
        perspective it is that of lengths at the middle of the block.
    names : sequence of str, optional
        Names of the blocks; without any all of them are taken for one mesh. Default: their own.

    Returns
    -------
    pyvista.PolyData
        Triangles.

    Raises
    ------
    TypeError, ValueError
        If a block has no finite box, a height is not positive, or a block has no two ends.
    """
    _check.instance("meshes", meshes, Mesh, "a PyVista mesh")
    blocks_of = [("", meshes)]
    if isinstance(meshes, pv.MultiBlock) and names != ():
        words = _check.texts("names", meshes.keys() if names is None else names, len(meshes))
        blocks_of = [*zip(words, meshes, strict=True)]
    height, size = _check.positive("height", height), _check.positive("size", size)
    unit = _check.text("unit", unit)
    expected = f"two words for each of the {len(blocks_of)} blocks"
    pairs: object = ends
    if not isinstance(pairs, list | tuple) or len(pairs) not in (0, len(blocks_of)):
        raise _check.value_error("ends", expected, _check.describe(ends))
    ends = [_check.texts("ends", pair, 2) for pair in pairs]
    eye = _Eye(camera, height)
    parts = list[tuple["Array", "Indices"]]()
    for i, (name, mesh) in enumerate(blocks_of):
        below = ends[i] if ends else ()
        is_last = i == len(blocks_of) - 1
        parts += _around(mesh, str(name), below, unit * is_last, eye, size)
    return blocks.polydata(*letters.union(parts)) if parts else pv.PolyData()


def _around(
    mesh: Given, name: str, ends: Sequence[str], unit: str, eye: _Eye, size: float
) -> list[tuple[Array, Indices]]:
    """Return a name above a mesh, and words and a bar of lengths below it, in parts."""
    middle = _box_of(mesh).mean(axis=1)
    spots = eye.seen(np.array([middle, *outermost(mesh, (-eye.away).tolist(), up=eye.up.tolist())]))
    spots = (spots - spots[0]) / size
    (left, low), (right, high) = spots.min(axis=0), spots.max(axis=0)
    below = low - 2 * GAP - DIGIT / 2
    words = [(name, 0.0, high + GAP + DIGIT / 2)] if name else []
    for word, column, side in zip(ends, (left, right), (0.5, -0.5), strict=False):
        words.append((word, column + side * letters.width(word), below))
    parts = []
    if unit:
        letter = size * float(eye.pixel(middle)[0])
        length = round_length(BAR * (right - left) * letter)
        long, word = length / letter, f"{length:g} {unit}"
        wide = long + 2 * GAP + letters.width(word)
        start = (left + right - wide) / 2
        if wide + sum(letters.width(end) + 4 * GAP for end in ends) > right - left:
            below -= LOWER * bool(ends)
        words.append((word, start + long + 2 * GAP + letters.width(word) / 2, below))
        bar, ids = rectangle(start, start + long, below - THICK / 2, below + THICK / 2)
        parts.append((_facing(middle, bar * size, eye), ids))
    parts += [_written(word, middle, np.array([x, y]), eye, size) for word, x, y in words]
    return parts


def _box_of(mesh: Given) -> Array:
    """Return the ends of the box of a mesh along x, y and z."""
    _check.instance("mesh", mesh, Mesh, "a mesh")
    return _check.coordinates("mesh", common_bounds("mesh", [mesh])).reshape(3, 2)


class _Eye:
    """Where points are in a picture of a height in pixels, and what is right and up in it."""

    def __init__(self, camera: pv.Camera, height: float) -> None:
        _check.instance("camera", camera, pv.Camera, "a camera")
        self._camera, self._height = camera, height
        self.place = np.array(camera.position, dtype=np.float64)
        self.away = np.array(camera.GetDirectionOfProjection())
        right = np.cross(self.away, np.array(camera.up, dtype=np.float64))
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.away)

    def pixel(self, points: Array) -> Array:
        """Return the size of a pixel at points, in the unit of the mesh."""
        return footprint(self._camera, np.atleast_2d(points), self._height)

    def seen(self, points: Array) -> Array:
        """Return columns and rows of points in pixels, from the middle of the picture."""
        flat = np.stack([(points - self.place) @ self.right, (points - self.place) @ self.up], -1)
        return np.asarray(flat / self.pixel(points).reshape(*flat.shape[:-1], 1))

    def sees(self, place: Array, normal: Array) -> bool:
        """Return whether a flat side is seen from its front."""
        toward = -self.away if self._camera.parallel_projection else self.place - place
        return bool(toward @ normal > 0)


def _along(box: Array, axis: int, name: str, eye: _Eye, size: float) -> list[tuple[Array, Indices]]:
    """Return the ticks, numbers and the name along the best edge of an axis, in parts."""
    edge = _edge(box, axis, eye)
    if edge is None:
        return []
    length, out = _outward(box, edge, eye)
    if length < SHORTEST * size:
        return []
    most = int(np.clip(length / (APART * size) + 1, 2, MOST))
    numbers = even_numbers(float(box[axis, 0]), float(box[axis, 1]), most)
    parts, reach = list[tuple["Array", "Indices"]](), 0.0
    for value, word in numbers:
        place = edge[0].copy()
        place[axis] = value
        parts += [_tick(place, out, eye, size), _word(place, out, TICK + GAP, word, eye, size)]
        reach = max(reach, _extent(word, out))
    middle = edge.mean(axis=0)
    parts.append(_word(middle, out, TICK + 3 * GAP + reach, name, eye, size))
    return parts


def _edge(box: Array, axis: int, eye: _Eye) -> Array | None:
    """Return the best edge along an axis: the lower one for x and y, one beside the box for z.

    Numbers along z stand where they are farthest from those of the edge that meets it, rather left.
    """
    edges = [edge for edge in _edges(box, axis) if len({*_sides_seen(box, axis, edge, eye)}) == 2]
    if not edges:
        return None
    if axis < 2:
        return min(edges, key=lambda ends: float(eye.seen(ends).mean(axis=0)[1]))
    lower = [edge for edge in (_edge(box, other, eye) for other in range(2)) if edge is not None]

    def crowded(edge: Array) -> tuple[float, float]:
        way = _outward(box, edge, eye)[1]
        beside = [
            float(way @ _outward(box, other, eye)[1]) for other in lower
            if np.any(np.all(edge[:, np.newaxis] == other, axis=2))
        ]  # fmt: skip
        return round(max(beside, default=0.0), 1), float(eye.seen(edge).mean(axis=0)[0])

    return min(edges, key=crowded)


def _outward(box: Array, edge: Array, eye: _Eye) -> tuple[float, Array]:
    """Return the length of an edge in pixels, and the direction in the picture out of the box."""
    first, last = eye.seen(edge)
    along = last - first
    length = float(np.hypot(*along)) or 1.0
    out = np.array([-along[1], along[0]]) / length
    inward = out @ ((first + last) / 2 - eye.seen(box.mean(axis=1))) < 0
    return length, -out if inward else out


def _edges(box: Array, axis: int) -> list[Array]:
    """Return the ends of the four edges along an axis."""
    ends: list[Array] = []
    for sides in itertools.product((0, 1), repeat=2):
        edge = np.empty((2, 3))
        for other, side in zip(_others(axis), sides, strict=True):
            edge[:, other] = box[other, side]
        edge[:, axis] = box[axis]
        ends.append(edge)
    return ends


def _others(axis: int) -> tuple[int, int]:
    first, second = (other for other in range(3) if other != axis)
    return first, second


def _sides_seen(box: Array, axis: int, edge: Array, eye: _Eye) -> list[bool]:
    """Return which of the two sides that meet at an edge are seen from outside."""
    seen = []
    for other in _others(axis):
        normal = np.zeros(3)
        normal[other] = 1.0 if edge[0, other] == box[other, 1] else -1.0
        seen.append(eye.sees(edge[0], normal))
    return seen


def _tick(place: Array, out: Array, eye: _Eye, size: float) -> tuple[Array, Indices]:
    """Return the two triangles of a tick."""
    across = np.array([-out[1], out[0]]) * LINE / 2
    corners = np.array([-across, across, TICK * out + across, TICK * out - across])
    return _facing(place, corners * size, eye), np.array([[0, 1, 2], [0, 2, 3]])


def _extent(word: str, out: Array) -> float:
    """Return the extent of a word along a direction, in heights of letters."""
    return float(abs(out[0]) * letters.width(word) + abs(out[1]) * DIGIT)


def _word(
    place: Array, out: Array, away: float, word: str, eye: _Eye, size: float
) -> tuple[Array, Indices]:  # fmt: skip
    """Return a word with its nearest side at a distance from a place, in heights of letters."""
    return _written(word, place, out * (away + _extent(word, out) / 2), eye, size)


def _written(
    word: str, place: Array, middle: Array, eye: _Eye, size: float
) -> tuple[Array, Indices]:
    """Return a word about a middle beside a place, in heights of letters."""
    flat, ids = letters.triangles(word)
    flat = flat - (letters.width(word) / 2, DIGIT / 2) + middle
    return _facing(place, flat * size, eye), ids


def _facing(place: Array, pixels: Array, eye: _Eye) -> Array:
    """Return places by their pixels from one place, in the plane through it that faces the eye."""
    step = eye.pixel(place) * pixels
    return np.asarray(place + step[:, :1] * eye.right + step[:, 1:] * eye.up)
