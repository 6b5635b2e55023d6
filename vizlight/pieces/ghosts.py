"""Ghost cells: cells of other pieces that touch a piece, joined to it and cut off again."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pyvista as pv
from vtkmodules.vtkFiltersCore import vtkAppendFilter, vtkAppendPolyData

from vizlight._types import Array, Foreign, Indices
from vizlight.mesh.joining import some_cells
from vizlight.vtk.cells import cell_arrays, connectivity, renumber_corners
from vizlight.vtk.topology import place_numbers

#: Name of the cell array that is 1 on the cells of other pieces.
GHOST = "vizlight_ghost"


def own_cells(mesh: pv.DataSet) -> pv.DataSet:
    """Return a mesh without the cells that are marked as ghosts, and without their points."""
    if GHOST not in mesh.cell_data:
        return mesh
    return some_cells(mesh, np.asarray(mesh.cell_data.pop(GHOST)) == 0)


def with_layer(
    mesh: pv.DataSet, others: Iterable[pv.DataSet], *, keep: bool
) -> tuple[pv.DataSet, list[pv.DataSet]]:
    """Return a mesh with the cells of others that share a place with it, and the rest of those.

    The rest is kept only where it is asked for: others are then in memory one at a time.

    Points of the mesh keep their indices; points of the layer follow, and cells of the layer use
    the mesh's own points where their places are the same bit for bit.
    """
    if GHOST not in mesh.cell_data:
        mesh.cell_data[GHOST] = np.zeros(mesh.n_cells, dtype=np.uint8)
    places = _Places(np.asarray(mesh.points))
    layers, rest = [], []
    for other in others:
        if not isinstance(other, type(mesh)):
            other = other.cast_to_unstructured_grid()
        touched = _touched(other, places.find(np.asarray(other.points)) >= 0)
        if touched.any():
            layer = some_cells(other, touched)
            layer.cell_data[GHOST] = np.ones(layer.n_cells, dtype=np.uint8)
            layers.append(layer)
        if keep:
            rest.append(some_cells(other, ~touched))
    return (_joined(mesh, layers) if layers else mesh), rest


class _Places:
    """Points that are found again by their coordinates, bit for bit."""

    def __init__(self, points: Array) -> None:
        self._points = points
        # Places that are not finite are found by none, and hide no others.
        self._low, self._high = np.fmin.reduce(points, axis=0), np.fmax.reduce(points, axis=0)
        self._keys, self._first = np.unique(place_numbers(points), return_index=True)

    def find(self, others: Array) -> Indices:
        """Return for each of some points the first one at its place, -1 where none is."""
        indices = np.full(len(others), -1)
        near = np.flatnonzero(np.all((others >= self._low) & (others <= self._high), axis=1))
        if len(near):
            wanted = others[near]
            keys = place_numbers(wanted)
            at = self._first[np.minimum(np.searchsorted(self._keys, keys), len(self._keys) - 1)]
            # Two places may have one number: the coordinates decide.
            indices[near] = np.where(np.all(self._points[at] == wanted, axis=1), at, -1)
        return indices


def _touched(mesh: pv.DataSet, touching: Foreign) -> Foreign:
    """Return a mask of the cells that have one of some points."""
    masks = [np.empty(0, dtype=np.bool_)]
    for cells in cell_arrays(mesh):
        ids, starts = connectivity(cells)
        # A cell is touched if the running count of such corners rises along its own.
        sums = np.concatenate([[0], np.cumsum(touching[ids])])
        masks.append(sums[starts[1:]] > sums[starts[:-1]])
    return np.concatenate(masks)


def _joined(mesh: pv.DataSet, layers: Sequence[pv.DataSet]) -> pv.DataSet:
    """Return a mesh and layers around it that share the points at the same places."""
    kind = vtkAppendPolyData if isinstance(mesh, pv.PolyData) else vtkAppendFilter
    together: Foreign = kind()
    for part in (mesh, *layers):
        together.AddInputData(part)
    together.Update()
    joined = pv.wrap(together.GetOutput())
    places = np.asarray(joined.points)
    index = np.arange(joined.n_points)
    same = _Places(places).find(places[mesh.n_points :])
    index[mesh.n_points :] = np.where(same < 0, index[mesh.n_points :], same)
    renumber_corners(joined, index)
    return joined  # type: ignore[no-any-return]
