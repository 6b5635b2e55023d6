"""The nearest place on a surface, and its normal there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.mesh import normals

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.scene import View


#: The array that :func:`with_normals` adds, under a name that no user's array has.
NORMALS = "vizlight normals"


def with_normals(surface: Any, view: View | None, name: str = "surface") -> pv.PolyData:
    """Return the triangles of a surface with point normals; it shares nothing that is changed.

    Normals stand under the name NORMALS, so that an array of the user's is not lost.

    Raises
    ------
    TypeError
        If it is not a PolyData mesh.
    ValueError
        If it has no faces.
    """
    if not isinstance(surface, pv.PolyData):
        raise TypeError(
            _check.message(
                name,
                "a pyvista.PolyData surface",
                type(surface).__name__,
                "take the mesh's extract_surface() or a contour",
            )
        )
    if not (surface.GetNumberOfPolys() or surface.GetNumberOfStrips()):
        raise ValueError(_check.message(name, "a surface with faces", "a mesh without"))
    # Faces alone: with loose points or lines beside them, cells would not be triangles.
    triangles = pv.PolyData()
    triangles.SetPoints(surface.GetPoints())
    triangles.SetPolys(surface.GetPolys())
    triangles.SetStrips(surface.GetStrips())
    for key, array in surface.point_data.items():
        if np.asarray(array).dtype.kind in "biuf":
            triangles.point_data[key] = np.asarray(array)
    triangles.point_data[NORMALS] = normals.normals_of(surface, None, 3, view)
    return triangles if triangles.is_all_triangles else triangles.triangulate()


def closest(surface: pv.PolyData, points: Array) -> tuple[Array, Array]:
    """Return the points of a triangle mesh closest to some points, and its normals there."""
    if not len(points):
        return np.empty((0, 3)), np.empty((0, 3))
    nearest: Any = surface.find_closest_cell(points, return_closest_point=True)  # type: ignore[arg-type]
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
