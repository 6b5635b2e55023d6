"""A bas-relief: the side of a mesh that an eye at infinity sees, as a height field."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight import _check, _progress
from vizlight._types import Array, VectorLike
from vizlight.geometry.relief.depth_map import depth_map
from vizlight.mesh import closed_meshes, height_grids


def bas_relief(
    mesh: pv.DataSet | pv.MultiBlock,
    /,
    *,
    direction: VectorLike = (0.0, 0.0, 1.0),
    up: VectorLike | None = None,
    resolution: int = 512,
    height: float | None = None,
    margin: float = 0.05,
    name: str = "height",
    progress_bar: bool = False,
) -> pv.ImageData:
    """Return the bas-relief of a mesh: its depth map, flattened, on a plate.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Surface, closed or open; of another mesh the outer surface is taken; a level grid is raised
        by its active scalars. Not changed.
    direction : vector of 3 components, default: (0, 0, 1)
        Direction toward the eye, which is at infinity.
    up : vector of 3 components, optional
        Direction that is up in the picture. Default: z, or y if the eye looks along z.
    resolution : int, default: 512
        Number of nodes along the longer side of the plate, 2 or more.
    height : float, optional
        Height of the relief above the plate, in the unit of the mesh. Default: the depth of the
        visible side.
    margin : float, default: 0.05
        Width of the plate around the mesh, as a share of the longer side of the mesh.
    name : str, default: "height"
        Name of the point array of heights.
    progress_bar : bool, default: False
        Whether progress is shown on standard error.

    Returns
    -------
    pyvista.ImageData
        Height field for :func:`vizlight.relief_shadow`, centred, with x to the right and y up.
        Heights are 0 on the plate. ``vizlight.files.write_mesh(relief, "relief.stl")`` writes the
        solid below it, for a printer.

    Raises
    ------
    TypeError, ValueError
        If an argument does not fit, or nothing of the mesh is visible.

    Notes
    -----
    The depth is sampled at the nodes by :func:`vizlight.geometry.relief.depth_map.depth_map`,
    without OpenGL. Source: cos-theta, figure 1, lights a bas-relief of a statue.
    """
    if isinstance(mesh, height_grids.Grid):
        mesh = height_grids.raised(mesh)
    vertices, triangles = closed_meshes.triangles_of(mesh, "mesh")
    frame = _eye_frame(direction, up)
    resolution = _check.integer("resolution", resolution, low=2)
    _check.holds("resolution", (resolution, resolution))
    margin = _check.number("margin", margin, low=0.0, high=10.0)
    if height is not None:
        height = _check.number("height", height, low=0.0)
    _check.array_name("name", name)

    # Points that no face uses are not seen, and do not count for the extent.
    used = np.unique(triangles)
    if not len(used):
        raise _check.value_error("mesh", "faces of some area", "none")
    centre = (vertices[used].min(axis=0) + vertices[used].max(axis=0)) / 2
    # From here on x is to the right, y up and z toward the eye.
    places = (vertices - centre) @ frame.T
    low, high = places[used].min(axis=0), places[used].max(axis=0)
    side = float((high - low)[:2].max())
    if not side > 0:
        expected, remedy = "an extent across the view", "turn direction"
        raise _check.value_error("mesh", expected, "none", remedy)
    step = side * (1 + 2 * margin) / (resolution - 1)
    # The tolerance prevents an additional node by rounding.
    count = np.ceil(((high - low)[:2] + 2 * margin * side) / step - 1e-6).astype(int) + 1
    count = np.maximum(count, 2)
    # The nodes stand evenly about the middle of the extent.
    first = ((low + high)[:2] - (count - 1) * step) / 2
    x, y = (first[k] + step * np.arange(count[k]) for k in (0, 1))
    with _progress.progress("depth", 100, show=progress_bar) as report:
        depth = depth_map(
            x, y, places, triangles, progress=lambda done, total: report(100 * done // total)
        )
    there = np.isfinite(depth)
    if not there.any():
        expected, got = "a surface wider than a node", "a thinner one"
        raise _check.value_error("mesh", expected, got, "raise resolution")
    # The farthest place that is seen has height 0, level with the ground beside the shape.
    depth -= depth[there].min()
    depth[~there] = 0
    tall = float(depth.max())
    if height is not None and tall > 0:
        depth *= height / tall
    out = pv.ImageData(dimensions=(*count, 1), spacing=(step, step, step), origin=(*first, 0.0))
    out.point_data[name] = depth.ravel()
    out.point_data.active_scalars_name = name
    return out


def _eye_frame(direction: VectorLike, up: VectorLike | None) -> Array:
    """Return the unit vectors to the right, up and toward the eye as rows."""
    toward = _check.unit("direction", direction)
    if up is None:
        # Straight along z the z axis has no direction on the screen.
        up = (0.0, 1.0, 0.0) if abs(toward[2]) > 0.999 else (0.0, 0.0, 1.0)
    right = np.cross(_check.unit("up", up), toward)
    if np.linalg.norm(right) < 1e-6:
        remedy = "name another direction than the eye's"
        raise _check.value_error("up", "a direction across the view", tuple(up), remedy)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(toward, right), toward])
