"""A mesh from several sides, beside each other as blocks that one eye sees."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Sequence

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Foreign
from vizlight.draw.cameras import Mesh, axes_of, common_bounds, outermost
from vizlight.mesh.blocks import all_blocks

#: Distances between views to the right and upward, as shares of the largest width and height.
APART = (0.08, 0.25)
#: Width over height of the place for views.
ASPECT = 1.6


def several_views(
    mesh: Mesh,
    views: Sequence[Sequence[float]],
    /,
    *,
    up: Sequence[Sequence[float]] | None = None,
    names: Sequence[str],
    around: Mesh | None = None,
    aspect: float = ASPECT,
) -> pv.MultiBlock:
    """Return a mesh once for each view, so that one eye sees all of them in one scale.

    Parameters
    ----------
    mesh : mesh
        Mesh, which is not changed.
    views : sequence of vectors of 3 components
        Directions toward the eye. The first block is the mesh as it is, seen from the first; others
        are turned so that this eye sees them from theirs.
    up : sequence of vectors of 3 components, optional
        Directions up in the picture. Default: z, or y seen along z.
    names : sequence of str
        Names of the blocks.
    around : mesh, optional
        Mesh that fills the room of a view, such as that of which ``mesh`` is a part. Default:
        the mesh itself.
    aspect : float, default: 1.6
        Width over height of the place for all views, by which they stand in rows.

    Returns
    -------
    pyvista.MultiBlock

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.

    Examples
    --------
    >>> import pyvista as pv
    >>> from vizlight import render
    >>> render.several_views(pv.Cone(), [(0, -1, 0), (0, 0, 1)], names=("front", "top")).keys()
    ['front', 'top']
    """
    _check.instance("mesh", mesh, Mesh, "a PyVista mesh")
    turns, words = _turns(views, up), _check.texts("names", names, len(views))
    if len({*words}) < len(words):
        raise _check.value_error("names", "names that differ", _check.describe(names))
    whole = mesh if around is None else around
    _check.instance("around", whole, Mesh, "a PyVista mesh")
    centre = np.reshape(common_bounds("around", [whole]), (3, 2)).mean(axis=1)
    boxes = np.array([_box(whole, axes, centre) for axes in turns])
    places = _places(boxes[:, :, 1] - boxes[:, :, 0], _check.positive("aspect", aspect))
    shifts = places - boxes.mean(axis=2)
    blocks = {}
    for word, axes, shift in zip(words, turns, shifts - shifts[0], strict=True):
        matrix = np.eye(4)
        matrix[:3, :3] = turns[0].T @ axes
        matrix[:3, 3] = centre - matrix[:3, :3] @ centre + shift @ turns[0][:2]
        blocks[word] = mesh.copy(deep=False) if axes is turns[0] else _moved(mesh, matrix)
    return pv.MultiBlock(blocks)


def inset(
    mesh: Mesh,
    camera: pv.Camera,
    direction: Sequence[float],
    place: Sequence[float],
    /,
    *,
    up: Sequence[float] | None = None,
    around: Mesh | None = None,
) -> Mesh:
    """Return a mesh that a parallel camera sees from another side, in a place of its picture.

    Parameters
    ----------
    mesh : mesh
        Mesh, which is not changed.
    camera : pyvista.Camera
        Camera of the picture.
    direction, up : vector of 3 components
        As for :func:`vizlight.draw.render.camera_on`.
    place : (float, float, float, float)
        Middle of the place to the right and up from that of the picture, and its width and height,
        in halves of the height of the picture. The mesh fills it, but is no larger than in the
        picture itself.
    around : mesh, optional
        Mesh that fills the place, such as that of which ``mesh`` is a part. Default: the mesh.

    Returns
    -------
    mesh
        Turned, shifted and smaller mesh, at the depth of the focal point of the camera.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit.
    """
    whole = mesh if around is None else around
    for name, each in (("mesh", mesh), ("around", whole)):
        _check.instance(name, each, Mesh, "a PyVista mesh")
    spot = _check.coordinates("place", place)
    if spot.shape != (4,) or not min(spot[2:]) > 0:
        expected = "a middle, a width and a height above 0"
        raise _check.value_error("place", expected, _check.describe(place))
    eye = axes_of(np.negative(camera.direction).tolist(), camera.up)
    axes, half = axes_of(direction, up), float(camera.parallel_scale)
    centre = np.reshape(common_bounds("around", [whole]), (3, 2)).mean(axis=1)
    box = _box(whole, axes, centre)
    sizes = np.ptp(box, axis=1)
    scale = min([1.0, *(half * spot[2:] / np.where(sizes > 0, sizes, np.inf))])
    matrix = np.eye(4)
    matrix[:3, :3] = scale * eye.T @ axes
    middle = centre + box.mean(axis=1) @ axes[:2]
    target = np.asarray(camera.focal_point) + half * spot[:2] @ eye[:2]
    matrix[:3, 3] = target - matrix[:3, :3] @ middle
    return _moved(mesh, matrix)


def beside(camera: pv.Camera, /, *, right: float = 0.0, below: float = 0.0) -> pv.Camera:
    """Return a parallel camera whose picture has that of another one at its upper left.

    Parameters
    ----------
    camera : pyvista.Camera
        Camera, which is not changed.
    right, below : float
        Width at the right and height below by which the picture is larger, in halves of the height
        of that of ``camera``.

    Raises
    ------
    TypeError, ValueError
        If a number does not fit.
    """
    right, below = (
        _check.number(name, value, low=0.0) for name, value in (("right", right), ("below", below))
    )
    half = float(camera.parallel_scale)
    eye = axes_of(np.negative(camera.direction).tolist(), camera.up)
    shift = half / 2 * (right * eye[0] - below * eye[1])
    wide: pv.Camera = camera.copy()  # type: ignore[no-untyped-call]
    wide.focal_point = tuple(np.asarray(camera.focal_point) + shift)
    wide.position = tuple(np.asarray(camera.position) + shift)
    wide.parallel_projection = True
    wide.parallel_scale = half * (1 + below / 2)
    return wide


def _turns(views: object, up: object) -> list[Array]:
    """Return the axes of the picture of each view: to the right, up and toward the eye."""
    ways: Foreign = views
    if not isinstance(ways, list | tuple) or not ways:
        raise _check.value_error("views", "directions toward the eye", _check.describe(views))
    ups: Foreign = [None] * len(ways) if up is None else up
    if not isinstance(ups, list | tuple) or len(ups) != len(ways):
        raise _check.value_error("up", f"{len(ways)} directions", _check.describe(up))
    ways = [_check.unit("views", way) for way in ways]
    return [axes_of(way, upward) for way, upward in zip(ways, ups, strict=True)]


def _box(mesh: Mesh, axes: Array, centre: Array) -> Array:
    """Return the ends of a mesh to the right and up in a view, from a centre, shape (2, 2)."""
    points = outermost(mesh, axes[2], up=axes[1]) - centre
    flat = points @ axes[:2].T
    return np.stack([flat.min(axis=0), flat.max(axis=0)], axis=1)


def _places(sizes: Array, aspect: float) -> Array:
    """Return the middles of views of some widths and heights, in the rows that are largest."""
    count = len(sizes)
    gaps = np.array(APART) * sizes.max(axis=0)
    best, largest = np.zeros((count, 2)), 0.0
    for columns in range(count, 0, -1):
        rows = math.ceil(count / columns)
        wide = [sizes[i::columns, 0].max() for i in range(columns)]
        tall = [sizes[i * columns : (i + 1) * columns, 1].max() for i in range(rows)]
        width, height = (
            sum(ends) + gap * (len(ends) - 1) for ends, gap in zip((wide, tall), gaps, strict=True)
        )
        scale = min(aspect / (width or 1.0), 1 / (height or 1.0))
        if scale <= largest:
            continue
        largest = scale
        x, y = (
            np.cumsum([0.0, *ends[:-1]]) + np.arange(len(ends)) * gap + np.array(ends) / 2
            for ends, gap in zip((wide, tall), gaps, strict=True)
        )
        cells = itertools.islice(itertools.product(-y, x), count)
        best = np.array([(column, row) for row, column in cells])
    return best


def _moved(mesh: Mesh, matrix: Array) -> Mesh:
    """Return a mesh that is turned, shifted and scaled, with vectors of the same lengths."""
    if isinstance(mesh, pv.MultiBlock):
        return pv.MultiBlock([_moved(block, matrix) for block in all_blocks(mesh)])
    carried = mesh.point_data.active_normals
    if carried is not None and carried.shape[1:] != (3,):
        raise _check.value_error("mesh", "normals of 3 components", _check.describe(carried))
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Integer points, vector")
        # Of a copy, since PyVista changes such arrays of the mesh itself.
        moved: pv.DataSet = mesh.copy(deep=False).transform(
            matrix, transform_all_input_vectors=True, inplace=False
        )
    scale = float(np.cbrt(np.linalg.det(matrix[:3, :3])))
    # Whole numbers are colours and labels, which PyVista takes for vectors if there are three.
    for data, other in (
        (mesh.point_data, moved.point_data), (mesh.cell_data, moved.cell_data)
    ):  # fmt: skip
        for name in data:
            if data[name].dtype.kind != "f":
                other.set_array(data[name], name)
            elif data[name].shape[1:] == (3,) and name != data.active_normals_name:
                # A smaller picture of a flow is as fast.
                other.set_array(other[name] / scale, name)
    return moved
