"""How bright a surface is in a picture: the exposure of the light that a camera sees on it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pyvista as pv

from vizlight._types import Foreign, Indices, Keywords
from vizlight.filters.illuminate import illuminate
from vizlight.looks.framing import seen_triangles
from vizlight.mesh import blocks, records
from vizlight.scene import Scene
from vizlight.shading.display import exposure_of
from vizlight.shading.results import part_name

#: Name of the light of the triangles that are measured.
LIGHT = "seen"


def exposure_seen(
    mesh: pv.DataSet, scene: Scene, camera: pv.Camera, light: Mapping[str, object]
) -> float:
    """Return the exposure at which the 70th percentile of the light that is seen becomes 1.

    It has two digits, by the light of a thousand triangles of a surface, and is 1 for other meshes
    and where none is seen; ``light`` has options of :func:`vizlight.illuminate`.
    """
    if not isinstance(mesh, pv.PolyData):
        return 1.0
    toward = np.subtract(camera.position, camera.focal_point)
    triangles = seen_triangles(mesh, tuple(toward.tolist()))
    if not len(triangles):
        return 1.0
    # Two copies of a triangle would be a closed surface.
    single, copies = np.unique(triangles, axis=0, return_inverse=True)
    corners = single.ravel()
    # No corner is shared: each triangle has the light of its own plane.
    faces = np.arange(len(corners)).reshape(-1, 3)
    seen = blocks.polydata(np.asarray(mesh.points)[corners], faces)
    options: Keywords = {}
    for name, value in light.items():
        options[name] = _of_corners(mesh, value, corners)
        if isinstance(value, str) and value in mesh.array_names:
            seen.point_data[value] = options[name]
            options[name] = value
    options.pop("feature_angle", None)
    lit = illuminate(seen, scene, **options, name=LIGHT)
    rgb = part_name(LIGHT, "rgb")
    luminance = np.asarray(lit[rgb if rgb in lit.point_data else LIGHT])
    of_corners = luminance.reshape(len(single), 3, -1)[copies.ravel()]
    return float(f"{exposure_of(of_corners.reshape(-1, *luminance.shape[1:])):.2g}")


def _of_corners(mesh: pv.DataSet, value: Foreign, corners: Indices) -> Foreign:
    """Return the rows of an array, or of an array of the mesh by its name, at some points."""
    if isinstance(value, str) and value in mesh.array_names:
        value = records.averaged(mesh, value).point_data[value]
    is_rows = isinstance(value, list | tuple | np.ndarray) and len(value) == mesh.n_points
    return np.asarray(value)[corners] if is_rows else value
