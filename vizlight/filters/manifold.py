"""Sampled manifolds as meshes with their positions and frames in n-space."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pyvista as pv
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Exponent, Facing, Model, Precision, VectorLike
from vizlight.filters.project import LightWhen, ProjectOptions, project
from vizlight.geometry.nspace.manifolds import Manifold
from vizlight.mesh.blocks import polydata
from vizlight.mesh.nspace import FRAME, POSITION
from vizlight.scene.keywords import named
from vizlight.scene.presets import AnyScene


@named
def manifold(
    shape: Manifold,
    /,
    *,
    scene: AnyScene | None = None,
    rotation: object = None,
    hyperplane: tuple[VectorLike, float] | None = None,
    distance: float | None = None,
    positions: str | None = "position",
    frame: str | None = "frame",
    turned: str | Sequence[str] | None = None,
    cut: bool = False,
    light: LightWhen = "before",
    tangents: str | ArrayLike | None = None,
    normals: str | ArrayLike | None = None,
    facing: Facing = "auto",
    conditioned: bool | str | None = False,
    line_field: bool = False,
    occlusion: str | None = None,
    name: str = "luminance",
    exponent: Exponent = "compensated",
    model: Model = "phong",
    components: bool = False,
    precision: Precision | None = None,
    progress_bar: bool = False,
) -> pv.DataSet | pv.MultiBlock:
    """Return a sampled manifold as a mesh in 3-space.

    Parameters
    ----------
    shape : Manifold
        Manifold, such as one of :mod:`vizlight.geometry.nspace.manifolds`.
    scene, progress_bar
        As for :func:`project`.
    rotation, hyperplane, distance, positions, frame, turned, cut, light
        As for :func:`vizlight.project`.
    tangents, normals, facing, conditioned, line_field, occlusion, name, exponent, model, components
        As for :func:`vizlight.illuminate`.
    precision
        As for :func:`vizlight.illuminate`.

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
    >>> mesh = vizlight.manifold(manifolds.torus(1.0, 1.0, resolution=16), distance=2.0)
    >>> mesh["position"].shape, mesh["frame"].shape
    ((256, 4), (256, 8))
    """
    options = ProjectOptions.of(locals()).changed()
    if callable(shape):
        expected, got = "a vizlight.geometry.manifolds.Manifold", "a function"
        remedy = "sample it by manifolds.parametric(function, domain, n)"
        raise TypeError(_check.message("shape", expected, got, remedy))
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
    # Rows of a frame stand one behind the other, since an array of VTK has one axis of components.
    mesh.point_data[FRAME] = shape.frame.reshape(count, shape.k * n)
    return project(mesh, scene=scene, progress_bar=progress_bar, **options)
