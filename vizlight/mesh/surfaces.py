"""The closest point on a surface, and the interpolated normal there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight.mesh import blocks, normals
from vizlight.model import kernels
from vizlight.reading.cells import faces_only

if TYPE_CHECKING:
    from vizlight._types import Array, Foreign
    from vizlight.scene import View
    from vizlight.shading.options import FeatureAngle


#: Name of the point array of normals, chosen not to clash with a user's array.
NORMALS = "vizlight normals"


def with_normals(
    surface: object, view: View | None, angle: FeatureAngle = None, name: str = "surface"
) -> pv.PolyData:
    """Return the triangles of a surface as a new mesh with the unit point normals ``NORMALS``.

    Points are split at edges sharper than the angle; without one a warning is given if normals
    were averaged across many sharp edges.

    Raises
    ------
    TypeError
        If it is not a PolyData mesh.
    ValueError
        If it has no faces.
    """
    own = normals.split_where_computed(blocks.surface(surface, name), angle)
    # Vertices and lines are left out, because every cell must be a triangle.
    triangles = pv.PolyData(faces_only(own))
    for key, array in own.point_data.items():
        if np.asarray(array).dtype.kind in "biuf":
            triangles.point_data[key] = np.asarray(array)
    found = normals.normals_of(own, None, 3, view, warn=angle is None)
    kind = np.result_type(found.dtype, np.float32)
    triangles.point_data[NORMALS] = kernels.unit_rows(found).astype(kind, copy=False)
    return triangles if triangles.is_all_triangles else triangles.triangulate()


def closest(surface: pv.PolyData, points: Array) -> tuple[Array, Array]:
    """Return the closest points on a mesh of triangles, and its interpolated normals there."""
    if not len(points):
        return np.empty((0, 3)), np.empty((0, 3))
    nearest: Foreign = surface.find_closest_cell(points, return_closest_point=True)  # type: ignore[arg-type]
    corners = surface.regular_faces[np.atleast_1d(nearest[0])]
    places: Array = np.atleast_2d(nearest[1])
    a, b, c = (np.asarray(surface.points, dtype=np.float64)[corners[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    area = np.einsum("ij,ij->i", normal, normal)
    area = np.where(area > 0, area, 1)[:, np.newaxis]
    weights = [
        np.einsum("ij,ij->i", np.cross(q - p, places - p), normal)[:, np.newaxis] / area
        for p, q in ((b, c), (c, a), (a, b))
    ]
    normals = np.asarray(surface.point_data[NORMALS], dtype=np.float64)
    found = sum(w * normals[corners[:, i]] for i, w in enumerate(weights))
    return places, np.asarray(found)
