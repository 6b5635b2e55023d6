"""Meshes of solids for PyVista and its file formats."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight.geometry.solids import tessellation
from vizlight.geometry.solids.primitives import Solid


def to_polydata(solid: Solid, /, *, tolerance: float = 3e-3) -> pv.PolyData:
    """Return the closed surface of a solid as a mesh of triangles.

    Parameters
    ----------
    solid : Solid
        :class:`vizlight.Sphere`, :class:`~vizlight.Frustum`, :class:`~vizlight.Block` or another
        solid, or a combination of them by ``|``, ``&`` and ``-``.
    tolerance : float, default: 3e-3
        Largest distance of triangles from the curves and surfaces, as a share of the size of the
        solid, from 1e-6 to 0.1.

    Returns
    -------
    pyvista.PolyData
        Triangles, counter-clockwise seen from outside, with the cell array ``patch``: the index of
        the exact surface of each. Field data ``volume_error`` is a bound of the difference between
        this volume and the exact solid's, in the cubed unit of the solid.

    Raises
    ------
    ImportError
        If a combined solid is given and manifold3d is not installed.
    TypeError, ValueError
        If an argument is not valid, or as for
        :func:`vizlight.geometry.solids.tessellate`.

    Notes
    -----
    The mesh's own ``save`` writes STL, PLY, OBJ and VTK's formats. For 3MF, the package trimesh
    writes ``trimesh.Trimesh(mesh.points, mesh.regular_faces).export("part.3mf")``; it needs the
    packages lxml and networkx.
    """
    facets = tessellation.tessellate(solid, tolerance=tolerance)
    if not len(facets.triangles):
        mesh = pv.PolyData()
    else:
        points = np.asarray(facets.world(facets.points), dtype=float)
        triangles = np.asarray(facets.triangles, dtype=int)
        mesh = pv.PolyData.from_regular_faces(points, triangles)
        mesh.cell_data["patch"] = np.asarray(facets.patch)
    # The bound is in the unit of the tessellation, which is ``scale`` units of the solid.
    mesh.field_data["volume_error"] = [facets.volume_error * facets.scale**3]
    return mesh
