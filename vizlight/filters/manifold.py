"""Sampled manifolds as meshes that carry where they are in n-space and how they lie there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters.project import ProjectOptions, project
from vizlight.geometry.nspace.parametric import Manifold
from vizlight.mesh.nspace import FRAME, POSITION
from vizlight.shading.options import accepts

if TYPE_CHECKING:
    from numpy.typing import ArrayLike
    from typing_extensions import Unpack

    from vizlight._types import Indices
    from vizlight.filters.project import ProjectKeywords
    from vizlight.scene import Scene


@accepts(ProjectOptions)
def manifold(
    shape: Manifold,
    /,
    *,
    scene: Scene | None = None,
    threads: int | None = None,
    progress_bar: bool = False,
    **options: Unpack[ProjectKeywords],
) -> pv.DataSet | pv.MultiBlock:
    """Return a sampled manifold as a mesh in 3-space.

    Parameters
    ----------
    shape : Manifold
        From :mod:`vizlight.geometry.manifolds`.
    scene, threads, progress_bar
        As for :func:`project`.
    **options
        Fields of ProjectOptions.

    Returns
    -------
    pyvista.PolyData or pyvista.UnstructuredGrid
        Lines or quadrilaterals; hexahedra for k = 3. A closed 3-manifold has no outside to
        draw: cut it by ``hyperplane=``, or draw its points. With the point arrays ``position``
        (n components), ``frame`` (k n) and, for k < 3, ``projected_frame`` (3 k).

    Raises
    ------
    TypeError, ValueError
        As :func:`project`.

    Examples
    --------
    >>> import vizlight
    >>> from vizlight.geometry import manifolds
    >>> mesh = vizlight.manifold(manifolds.clifford_torus(resolution=16), distance=2.0)
    >>> mesh["position"].shape, mesh["frame"].shape
    ((256, 4), (256, 8))
    """
    _check.instance("shape", shape, Manifold, home="geometry.manifolds")
    count, n = shape.points.shape
    # Places are put in by the projection; until then the points only have to be there.
    points = np.zeros((count, 3))
    if shape.k == 3:
        cells = {pv.CellType.HEXAHEDRON: shape.cells}
        mesh: pv.PolyData | pv.UnstructuredGrid = pv.UnstructuredGrid(cells, points)
    else:
        mesh = polydata(points, shape.cells)
    mesh.point_data[POSITION] = shape.points
    mesh.point_data[FRAME] = shape.frame.reshape(count, shape.k * n)
    return project(mesh, scene=scene, threads=threads, progress_bar=progress_bar, **options)


def polydata(points: ArrayLike, cells: Indices) -> pv.PolyData:
    """Return a mesh of points, segments, triangles or quadrilaterals, by the corners of a cell."""
    mesh = pv.PolyData()
    mesh.points = points
    corners = cells.shape[1]
    made = pv.CellArray.from_regular_cells(np.asarray(cells, dtype=int))
    (mesh.SetVerts, mesh.SetLines, mesh.SetPolys, mesh.SetPolys)[corners - 1](made)
    return mesh
