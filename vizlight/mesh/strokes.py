"""Lines as strokes: lengths along them, without the short ones, and cut into tapered pieces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import pyvista as pv

from vizlight.vtk import polylines

if TYPE_CHECKING:
    from vizlight._types import AnyArray, Array, Bools, Indices

#: Width of the thin end of a stroke, as a share of its largest width.
TAIL = 0.3


class Segments(NamedTuple):
    """Segments of the lines of a mesh, line after line.

    Attributes
    ----------
    starts, ends : ndarray of int, shape (n,)
        Points at both ends.
    lines : ndarray of int, shape (n,)
        Numbers of their lines.
    before : ndarray of float, shape (n,)
        Length of the line before the segment.
    lengths : ndarray of float, shape (n,)
        Lengths.
    """

    starts: Indices
    ends: Indices
    lines: Indices
    before: Array
    lengths: Array

    def totals(self) -> Array:
        """Return the lengths of the lines."""
        return np.asarray(np.bincount(self.lines, weights=self.lengths), dtype=np.float64)


def segments_of(mesh: pv.PolyData) -> Segments:
    """Return the segments of the lines of a mesh, of lines of two points or more."""
    points, ids, offsets = polylines.cells_of(mesh)
    number = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    inner = np.flatnonzero(number[1:] == number[:-1])
    starts, ends, lines = ids[inner], ids[inner + 1], number[inner]
    lengths = np.linalg.norm(points[ends].astype(np.float64) - points[starts], axis=1)
    sums = np.cumsum(lengths) - lengths
    first = np.flatnonzero(np.diff(lines, prepend=-1))
    before = sums - np.repeat(sums[first], np.diff(first, append=len(lines)))
    return Segments(starts, ends, lines, before, lengths)


def against(mesh: pv.PolyData, segments: Segments, tangents: AnyArray) -> Bools:
    """Return whether each line runs against the tangents at its points."""
    points = np.asarray(mesh.points, dtype=np.float64)
    ways = points[segments.ends] - points[segments.starts]
    both = np.asarray(tangents)[segments.starts] + np.asarray(tangents)[segments.ends]
    dots = np.einsum("ij,ij->i", ways, both)
    return np.bincount(segments.lines, weights=dots) < 0


def ages(mesh: pv.PolyData, tangents: AnyArray) -> Array:
    """Return the length of the line from its start to each point, along the tangents.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Lines.
    tangents : array_like, shape (n_points, 3)
        Directions in which the lines are run through.

    Returns
    -------
    ndarray of float64, shape (n_points,)
        Lengths in the unit of the mesh; the first point of a closed line has the length 0.
    """
    segments = segments_of(mesh)
    after = segments.before + segments.lengths
    turned = against(mesh, segments, tangents)[segments.lines]
    totals = segments.totals()[segments.lines]
    found = np.zeros(mesh.n_points)
    found[segments.ends] = np.where(turned, totals - after, after)
    found[segments.starts] = np.where(turned, totals - segments.before, segments.before)
    return found


def without_short(mesh: pv.PolyData, least: float) -> pv.PolyData:
    """Return the lines of a mesh that have a length or more."""
    segments = segments_of(mesh)
    return _rebuilt(mesh, segments, (segments.totals() >= least)[segments.lines], segments.lines)


def cut(mesh: pv.PolyData, length: float, tangents: str, *, signed: bool) -> pv.PolyData:
    """Return lines cut at their points into strokes of one length, with their widths.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Lines.
    length : float
        Length of a stroke; those of a line are equally long, as far as its points allow.
    tangents : str
        Name of the point array of the directions of the strokes.
    signed : bool
        Whether the directions have a sense: strokes grow from a thin tail to their head. Otherwise
        both ends are thin.

    Returns
    -------
    pyvista.PolyData
        Strokes with the arrays of the mesh, and the point array ``width``: from 0.3 to 1.
    """
    segments = segments_of(mesh)
    totals = segments.totals()
    own = totals / np.maximum(np.round(totals / length), 1)
    share = (segments.before + segments.lengths / 2) / np.maximum(own[segments.lines], 1e-300)
    places = np.stack([segments.lines, np.floor(share)])
    pieces = np.cumsum(np.any(np.diff(places, prepend=0.0), axis=0))
    strokes = _rebuilt(mesh, segments, np.ones(len(pieces), dtype=np.bool_), pieces)
    run = ages(strokes, strokes.point_data[tangents])
    parts = segments_of(strokes)
    whole = np.ones(strokes.n_points)
    for ends in (parts.starts, parts.ends):
        whole[ends] = parts.totals()[parts.lines]
    place = run / np.where(whole > 0, whole, 1.0)
    full = place if signed else 1 - np.abs(2 * place - 1)
    strokes.point_data["width"] = (TAIL + (1 - TAIL) * full).astype(np.float32)
    return strokes


def _rebuilt(mesh: pv.PolyData, segments: Segments, kept: Bools, pieces: Indices) -> pv.PolyData:
    """Return polylines of the segments that are kept, one for each run of equal pieces.

    Each has points of its own. Arrays of points and fields are those of the mesh.
    """
    starts, ends, pieces = segments.starts[kept], segments.ends[kept], pieces[kept]
    first = np.flatnonzero(np.diff(pieces, prepend=-1))
    counts = np.diff(first, append=len(pieces))
    # A run of m segments has m starts, and the end of the last one.
    rows = np.insert(starts, first + counts, ends[first + counts - 1])
    offsets = np.concatenate([[0], np.cumsum(counts + 1)])
    rebuilt = pv.PolyData()
    rebuilt.points = np.asarray(mesh.points)[rows]
    rebuilt.lines = np.insert(np.arange(len(rows)), offsets[:-1], counts + 1)
    # PyVista refuses arrays without rows.
    for name in mesh.point_data if len(rows) else ():
        rebuilt.point_data[name] = np.asarray(mesh.point_data[name])[rows]
    for name in mesh.field_data:
        rebuilt.field_data[name] = mesh.field_data[name]
    return rebuilt
