"""Neurons of SWC files: the branches of a tree, and how far from its root each point is."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pyvista as pv
import scipy

from vizlight import _check
from vizlight._types import Array

#: Name of the array of path lengths, and type of the points of a cell body.
PATH_LENGTH, SOMA = "path length from the root", 1


def read(path: Path) -> pv.PolyData:
    """Read the branches of a neuron as polylines with data of each point.

    These are the path length from the root of its tree, the radius and the type. The file is an
    SWC.
    """
    with path.open(encoding="latin-1") as file, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "loadtxt: input contained no data")
        rows = np.loadtxt(file, ndmin=2, comments="#")
    if rows.shape[1] != 7:
        raise ValueError(f"{rows.shape[1]} columns, not the 7 of a neuron")
    row_of = {number: row for row, number in enumerate(rows[:, 0].tolist())}
    parents = [row_of.get(number, -1) for number in rows[:, 6].tolist()]
    if lost := np.count_nonzero((np.array(parents) < 0) & (rows[:, 6] >= 0)):
        _check.warn(f"file: '{path}': {lost} points follow others that are not there")
    children: dict[int, list[int]] = {}
    for row, parent in enumerate(parents):
        if parent not in (-1, row):
            children.setdefault(parent, []).append(row)
    lines = []
    for parent, heads in children.items():
        if len(heads) == 1 and parents[parent] != -1:
            continue  # inside of a branch
        for head in heads:
            line = [parent, head]
            while len(further := children.get(line[-1], ())) == 1:
                line += further
            lines.append(line)
    mesh = pv.PolyData(rows[:, 2:5].copy())
    if lines:
        mesh = pv.PolyData(
            mesh.points, lines=np.concatenate([[len(line), *line] for line in lines])
        )
    mesh.point_data[PATH_LENGTH] = _path_lengths(rows[:, 2:5], parents)
    mesh.point_data["radius"], mesh.point_data["type"] = rows[:, 5], rows[:, 1].astype(np.int32)
    return mesh


def _path_lengths(places: Array, parents: Sequence[int]) -> Array:
    """Return the length of the way from each point of a tree to its root, NaN in circles."""
    edges = [(parent, row) for row, parent in enumerate(parents) if parent not in (-1, row)]
    ups, rows = np.reshape(np.array(edges, np.intp), (-1, 2)).T
    roots = np.setdiff1d(np.arange(len(places)), rows)
    if not len(roots):
        return np.full(len(places), np.nan)
    # Points at one place are connected too.
    steps = np.maximum(np.linalg.norm(places[rows] - places[ups], axis=1), np.finfo(float).tiny)
    tree = scipy.sparse.csr_matrix((steps, (ups, rows)), (len(places),) * 2)
    ways = scipy.sparse.csgraph.dijkstra(tree, indices=roots, min_only=True)
    return np.where(np.isfinite(ways), ways, np.nan)
