"""The meshes of a picture as a meter needs them: what lights them, and cells that are drawn."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight.filters.tint import values_of
from vizlight.mesh import blocks, records, splitting
from vizlight.mesh.parts import part_of
from vizlight.observers.visible import Drawn
from vizlight.shading.results import DEFAULT_NAME

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import TypeAlias

    from numpy.typing import ArrayLike, NDArray

    from vizlight._types import Array, Indices
    from vizlight.scene import Scene
    from vizlight.shading.inputs import ArraySource, ShadingInputs
    from vizlight.shading.options import LightOptions

    Kind: TypeAlias = Literal["surface", "line", "point"]

#: Rows that are read at once of what has no rows by number.
BLOCK = 1 << 17


class Shares(NamedTuple):
    """Shares of light that reach points, None where all of it does.

    Attributes
    ----------
    transmittance : ndarray, shape (N, L), or None
        Share of each light of intensity above 0.
    occlusion : ndarray, shape (N,), or None
        Share of the ambient light.
    """

    transmittance: Array | None
    occlusion: Array | None

    def each(self, function: Callable[[Array], Array]) -> Shares:
        """Return what a function gives for each array."""
        return Shares(*(None if rows is None else function(rows) for rows in self))


@dataclass(frozen=True)
class Part:
    """One mesh of the picture.

    Attributes
    ----------
    kind : {"surface", "line", "point"}
        What its cells are.
    cells : ndarray of int, shape (C, s)
        Triangles, segments or points.
    inputs : ShadingInputs
        Points, tangents and normals. A surface has normals also where its light does not depend
        on them: they are what a reader sees as its shape.
    options : LightOptions
        How the mesh is lit.
    shares : Shares
        Shares of the light that reach the points.
    values : ndarray, shape (N,), or None
        Values of the points that colours show.
    """

    kind: Kind
    mesh: pv.DataSet
    cells: Indices
    inputs: ShadingInputs
    options: LightOptions
    shares: Shares
    values: NDArray[np.generic] | None

    @property
    def drawn(self) -> Drawn:
        """Points and cells to draw."""
        if isinstance(self.mesh, pv.PolyData | pv.PointSet | pv.UnstructuredGrid):
            return Drawn(self.mesh.GetPoints(), self.cells)
        return Drawn(pv.vtk_points(np.asarray(self.inputs.points[:])), self.cells)


def parts_of(
    mesh: pv.DataSet | pv.MultiBlock,
    scene: Scene,
    options: LightOptions,
    scalars: str | ArrayLike | None,
) -> list[Part]:
    """Return the meshes of a picture that have points; an error names the block.

    Raises
    ------
    TypeError, ValueError
        If an array is missing or does not fit, as :func:`vizlight.illuminate`.
    """
    return [
        _part(block, path, scene, options, scalars)
        for block, path in blocks.check(mesh)
        if block.n_points
    ]


def _part(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    scalars: str | ArrayLike | None,
) -> Part:
    cells = splitting.simplices(mesh)
    kind: Kind = "surface" if cells.shape[1] == 3 else "line"
    if not len(cells):
        kind, cells = "point", np.arange(mesh.n_points)[:, np.newaxis]
    known = options
    if kind == "surface" and options.tangents is not None:
        known = dataclasses.replace(options, conditioned=True)
    made = part_of(mesh, path, scene, known)
    return Part(
        kind,
        mesh,
        cells,
        made.inputs.of_faces(),
        options,
        _shares(mesh, sum(light.intensity > 0 for light in scene.lights)),
        None if scalars is None else values_of(mesh, scalars),
    )


def _shares(mesh: pv.DataSet, lights: int) -> Shares:
    """Return the shares of light that a filter found to reach the points of a mesh."""
    made = records.made(mesh, DEFAULT_NAME)
    found = Shares(
        *(np.asarray(mesh.point_data[name]) if name in made else None for name in Shares._fields)
    )
    name = (records.read(mesh, DEFAULT_NAME) or {}).get("options", {}).get("occlusion")
    if isinstance(name, str) and name in mesh.point_data:
        found = found._replace(occlusion=np.asarray(mesh.point_data[name]))
    if found.transmittance is None:
        return found
    columns = found.transmittance.reshape(mesh.n_points, -1)
    if columns.shape[1] != lights:
        expected = f"one column for each of the {lights} lights of the scene"
        remedy = "light the mesh by this scene first, or delete the array"
        got = f"{columns.shape[1]} in 'transmittance'"
        raise ValueError(_check.message("mesh", expected, got, remedy))
    return found._replace(transmittance=columns)


def rows_of(source: ArraySource, ids: Indices) -> NDArray[np.generic]:
    """Return rows of points or of an array by their numbers."""
    if isinstance(source, np.ndarray):
        return np.asarray(source[ids])
    found = np.empty((len(ids), *source.shape[1:]), source.dtype)
    for start in range(0, source.shape[0], BLOCK):
        own = (ids >= start) & (ids < start + BLOCK)
        if own.any():
            found[own] = source[start : start + BLOCK][ids[own] - start]
    return found
