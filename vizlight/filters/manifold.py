"""Sampled manifolds as meshes with their positions and frames in n-space."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters.project import ProjectOptions, project
from vizlight.geometry.nspace.parametric import Manifold
from vizlight.mesh.blocks import polydata
from vizlight.mesh.nspace import FRAME, POSITION
from vizlight.shading.options import accepts

if TYPE_CHECKING:
    from typing_extensions import Unpack

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
        Manifold, such as one of :mod:`vizlight.geometry.nspace.manifolds`.
    scene, threads, progress_bar
        As for :func:`project`.
    **options
        Fields of ProjectOptions.

    Returns
    -------
    pyvista.PolyData or pyvista.UnstructuredGrid
        Lines for k = 1, quadrilaterals for k = 2, hexahedra for k = 3, with the point arrays
        ``position`` (n components), ``frame`` (k n) and, for k < 3, ``projected_frame`` (3 k). A
        closed 3-manifold has no outer surface to draw: cut it by ``hyperplane=``, or draw its
        points.

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
    # The projection sets the points.
    points = np.zeros((count, 3))
    if shape.k == 3:
        cells = {pv.CellType.HEXAHEDRON: shape.cells}
        mesh: pv.PolyData | pv.UnstructuredGrid = pv.UnstructuredGrid(cells, points)
    else:
        mesh = polydata(points, shape.cells)
    mesh.point_data[POSITION] = shape.points
    mesh.point_data[FRAME] = shape.frame.reshape(count, shape.k * n)
    return project(mesh, scene=scene, threads=threads, progress_bar=progress_bar, **options)
