"""Lines of a mesh: colours by direction, where they turn back, and lines from seeds."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import Array, Indices
from vizlight.mesh import blocks, records
from vizlight.vtk.cells import connectivity
from vizlight.vtk.polylines import has_lines_only, line_tangents


def backdrop(meshes: Iterable[pv.DataSet]) -> str:
    """Return the colour before which meshes stand out: lines or points before black, else white."""
    thin = [mesh.n_points > 0 and mesh.max_cell_dimensionality < 2 for mesh in meshes]
    return "black" if all(thin) else "white"


def direction_colors(mesh: pv.DataSet, /) -> Array:
    """Return colours of lines by direction: ``(|x|, |y|, |z|)`` of the unit tangent as r, g, b.

    This is the convention of tractography: in the space of a scanner left and right is red, front
    and back green, up and down blue. It does not depend on the sign of a direction.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of lines, such as a tractogram or the result of :func:`vizlight.streamlines`.

    Returns
    -------
    ndarray, shape (n_points, 3)
        Channels from 0 to 1, zero at points that no line uses.

    Raises
    ------
    TypeError, ValueError
        If it is not a mesh of lines.

    Notes
    -----
    Source: Pajevic and Pierpaoli, Magnetic Resonance in Medicine 42 (1999), the absolute-value
    scheme.
    """
    if not isinstance(mesh, pv.DataSet):
        raise TypeError(_check.message("mesh", "a PyVista mesh of lines", type(mesh).__name__))
    if not has_lines_only(mesh):
        remedy = "take its streamlines, or its edges by extract_all_edges()"
        raise _check.value_error("mesh", "a mesh of lines", type(mesh).__name__, remedy)
    return np.abs(line_tangents(mesh))


def before_turning_back(mesh: pv.PolyData) -> pv.PolyData:
    """Return each line up to the point where it turns back or its last points coincide.

    A line turns back where the angle between two consecutive steps is a right angle or more.
    Lines without a step are left out. Each point must belong to exactly one line.
    """
    ids, offsets = connectivity(mesh.GetLines())
    size = np.diff(offsets)
    line = np.repeat(np.arange(len(size)), size)
    place = np.asarray(mesh.points, dtype=np.float64)[ids]
    step = place[1:] - place[:-1]
    same = line[1:] == line[:-1]
    # Repeated points have no direction: a turn is seen across them.
    moving = np.any(step != 0, axis=1) & same
    # Indices of the steps of non-zero length.
    at = np.flatnonzero(moving)
    back = np.einsum("ij,ij->i", step[at[1:]], step[at[:-1]]) <= 0
    back &= line[at[1:]] == line[at[:-1]]
    last = np.full(len(size), -1)
    # A line goes to the end of its last step that moves, or to the first point where it turns.
    np.maximum.at(last, line[at], at + 1)
    np.minimum.at(last, line[at[1:][back]], at[1:][back])
    keep_line = last >= 0
    kept = (np.arange(len(ids)) <= np.repeat(last, size)) & np.repeat(keep_line, size)
    # Nothing is cut off, and no point is left over.
    if kept.size == mesh.n_points and kept.all():
        return mesh
    if not kept.any():
        return pv.PolyData()
    length = np.bincount(line[kept], minlength=len(size))[keep_line]
    return _taken(mesh, ids[kept], length, np.flatnonzero(keep_line))


def by_end(mesh: pv.PolyData, name: str) -> pv.PolyData:
    """Return the segments of lines, those between two labels cut in half.

    Colours that run from one label to another would show those between them. The lines are not
    changed; the mesh itself is returned where no segment has two labels.
    """
    ids, offsets = connectivity(mesh.GetLines())
    first = np.setdiff1d(np.arange(len(ids)), offsets[1:] - 1)
    start, end = ids[first], ids[first + 1]
    labels, points = np.asarray(mesh.point_data[name]), np.asarray(mesh.points)
    mixed = labels[start] != labels[end]
    if not mixed.any():
        return mesh
    middles = (points[start[mixed]] + points[end[mixed]]) / 2
    far = points[end]
    far[mixed] = middles
    places = np.stack([points[start], far], axis=1).reshape(-1, 3)
    others = np.stack([middles, points[end[mixed]]], axis=1).reshape(-1, 3)
    rows = np.concatenate([np.repeat(start, 2), np.repeat(end[mixed], 2)])
    out = polydata(np.concatenate([places, others]), np.arange(0, len(rows) + 1, 2))
    out.point_data[name] = labels[rows]
    return out


def polydata(points: Array, ends: Indices, /) -> pv.PolyData:
    """Return a mesh of polylines.

    ``ends`` (L + 1,) is the start of each line, followed by the number of points.
    """
    out = pv.PolyData()
    if len(points):
        out.points = points
    out.SetLines(blocks.cell_array(np.arange(len(points)), ends))
    return out


def joined_at_seeds(mesh: pv.PolyData) -> pv.PolyData:
    """Return one line for each seed: VTK's tracer gives one forward and one backward from it.

    The mesh has VTK's cell array SeedIds and point array IntegrationTime, negative backward.
    """
    if not mesh.n_lines:
        return mesh
    ids, offsets = connectivity(mesh.GetLines())
    seed = np.asarray(mesh.cell_data["SeedIds"])
    # VTK marks the half that runs against the vectors by times below 0.
    time = np.asarray(mesh.point_data["IntegrationTime"])[ids]
    back = np.minimum.reduceat(time, offsets[:-1]) < 0
    runs: dict[int, Indices] = {}
    first: dict[int, int] = {}
    # Those that run backward come first, reversed.
    for line in np.lexsort((~back, seed)).tolist():
        run, key = ids[offsets[line] : offsets[line + 1]], int(seed[line])
        run = run[::-1] if back[line] else run
        # Both halves begin at the seed, which the line needs once.
        runs[key] = np.concatenate([runs[key], run[1:]]) if key in runs else run
        first[key] = line
    rows = np.concatenate([*runs.values()])
    return _taken(mesh, rows, [len(run) for run in runs.values()], [*first.values()])


def _taken(
    mesh: pv.PolyData, rows: Indices, sizes: Indices | list[int], lines: Indices | list[int]
) -> pv.PolyData:
    """Return lines of some sizes through points of a mesh, with the data of those of its lines."""
    out = polydata(np.asarray(mesh.points)[rows], np.concatenate([[0], np.cumsum(sizes)]))
    records.carry_rows(mesh, out, rows, np.asarray(lines))
    return out
