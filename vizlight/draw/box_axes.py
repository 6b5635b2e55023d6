"""Numbers along three edges of a box, as a mesh with letters that face the eye."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.draw.cameras import footprint
from vizlight.draw.ticks import even_numbers
from vizlight.mesh import blocks
from vizlight.vtk import letters
from vizlight.vtk.letters import DIGIT

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

__all__ = ["box_axes", "box_edges", "names_above"]

#: Length of ticks, their width, and distance of words from them, in heights of letters.
TICK, LINE, GAP = 0.4, 0.07, 0.25
#: Least length of an edge, and of the distance between its numbers, in heights of letters.
SHORTEST, APART = 3.0, 4.0
#: Most numbers along an edge.
MOST = 5


def box_axes(mesh: pv.DataSet, camera: pv.Camera, /, height: float, *, size: float) -> pv.PolyData:
    """Return ticks, numbers and names x, y, z along three edges of the box of a mesh.

    The edges are those between a side that is seen and one that is not, so that nothing stands
    before or behind the data: the lower ones of x and y, and the left one of z.

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

    Returns
    -------
    pyvista.PolyData
        Triangles; empty where the box has no extent.

    Raises
    ------
    TypeError, ValueError
        If the mesh has no finite box, the camera is none, or a height is not positive.
    """
    box = _box_of(mesh)
    height, size = _check.positive("height", height), _check.positive("size", size)
    eye = _Eye(camera, height)
    parts = [part for axis in range(3) for part in _along(box, axis, eye, size)]
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


def names_above(
    meshes: pv.MultiBlock, camera: pv.Camera, /, height: float, *, size: float
) -> pv.PolyData:
    """Return the names of blocks as words above them.

    Parameters
    ----------
    meshes : pyvista.MultiBlock
        Meshes with names.
    camera, height, size
        As for :func:`box_axes`.

    Returns
    -------
    pyvista.PolyData
        Triangles.

    Raises
    ------
    TypeError, ValueError
        If a block has no finite box, or a height is not positive.
    """
    if not isinstance(meshes, pv.MultiBlock):
        raise TypeError(_check.message("meshes", "a MultiBlock", _check.describe(meshes)))
    height, size = _check.positive("height", height), _check.positive("size", size)
    eye = _Eye(camera, height)
    parts = []
    for i, name in enumerate(meshes.keys()):
        box = _box_of(meshes[i])
        middle = box.mean(axis=1)
        rows = eye.seen(np.array([middle, *itertools.product(*box)]))[:, 1]
        place = middle + (rows.max() - rows[0]) * eye.pixel(middle) * eye.up
        parts.append(_word(place, np.array([0.0, 1.0]), GAP, str(name), eye, size))
    return blocks.polydata(*letters.union(parts)) if parts else pv.PolyData()


def _box_of(mesh: object) -> Array:
    """Return the ends of the box of a mesh along x, y and z."""
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message("mesh", "a mesh", _check.describe(mesh)))
    box: Array = _check.coordinates("mesh", mesh.bounds).reshape(3, 2)
    return box


class _Eye:
    """Where points are in a picture, and the directions right and up in it.

    Parameters
    ----------
    camera : pyvista.Camera
        Camera.
    height : float
        Height of the picture in pixels.
    """

    def __init__(self, camera: pv.Camera, height: float) -> None:
        if not isinstance(camera, pv.Camera):
            raise TypeError(_check.message("camera", "a camera", _check.describe(camera)))
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


def _along(box: Array, axis: int, eye: _Eye, size: float) -> list[tuple[Array, Indices]]:
    """Return the ticks, numbers and the name along the best edge of an axis, in parts."""
    edges = [edge for edge in _edges(box, axis) if len({*_sides_seen(box, axis, edge, eye)}) == 2]
    if not edges:
        return []
    # The left one of z, and the lower ones of x and y.
    edge = min(edges, key=lambda ends: float(eye.seen(ends).mean(axis=0)[0 if axis == 2 else 1]))
    first, last = eye.seen(edge)
    along = last - first
    length = float(np.hypot(*along))
    if length < SHORTEST * size:
        return []
    out = np.array([-along[1], along[0]]) / length
    if out @ ((first + last) / 2 - eye.seen(box.mean(axis=1))) < 0:
        out = -out
    most = int(np.clip(length / (APART * size) + 1, 2, MOST))
    numbers = even_numbers(float(box[axis, 0]), float(box[axis, 1]), most)
    parts, reach = list[tuple["Array", "Indices"]](), 0.0
    for value, word in numbers:
        place = edge[0].copy()
        place[axis] = value
        parts += [_tick(place, out, eye, size), _word(place, out, TICK + GAP, word, eye, size)]
        reach = max(reach, _extent(word, out))
    middle = edge.mean(axis=0)
    parts.append(_word(middle, out, TICK + 3 * GAP + reach, "xyz"[axis], eye, size))
    return parts


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
    flat, ids = letters.triangles(word)
    middle = out * (away + _extent(word, out) / 2)
    flat = flat - (letters.width(word) / 2, DIGIT / 2) + middle
    return _facing(place, flat * size, eye), ids


def _facing(place: Array, pixels: Array, eye: _Eye) -> Array:
    """Return places by their pixels from one place, in the plane through it that faces the eye."""
    step = eye.pixel(place) * pixels
    return np.asarray(place + step[:, :1] * eye.right + step[:, 1:] * eye.up)
