"""Lines as strokes: lengths along them, without short ones, cut into pieces; moving strokes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import pyvista as pv
import scipy

from vizlight._types import AnyArray, Array, Bools, Indices
from vizlight.model import kernels
from vizlight.vtk import polylines

#: Width of both ends of a stroke without a sense as a share of its largest width.
ENDS = 0.3
#: Largest length of a head as a share of that of a short stroke, and the way in lengths of a head
#: on which the width rises at its base.
MOST_HEAD, BASE = 0.4, 0.05
#: Distance from a border below which strokes run along it, in distances between lines.
RIM = 0.3
#: Steps from point to point in a head that moves.
STEPS = 4
#: Share of the distance from one moving stroke to the next that is bare, and share of it in which
#: a stroke grows at the start of its line, or shrinks at the end.
BARE, FADE = 0.25, 0.5
#: Names of the point arrays of moving strokes: the place in the distance between strokes at the
#: start, the number of strokes that pass in a period, and how far a stroke is grown; and of widths.
PHASE, PASSING, GROWN, WIDTH = "phase", "passing", "grown", "width"
#: Turns by which strokes of one line are ahead of those of the line before it.
GOLDEN = 0.6180339887
#: Length within which a line has no right angle, as a share of the least length of a line.
KINK = 1 / 7
#: Share of the median speed below which vectors move a stroke no slower, as at the end of a line.
SLOWEST = 1e-3


class Arrow(NamedTuple):
    """Shape of a stroke with a sense.

    Widths at the ``tail``, before the head (``neck``) and at the ``tip`` are shares of the largest
    one, ``head`` is a share of the length of the stroke.
    """

    tail: float
    neck: float
    head: float
    tip: float = 0.0


#: Strokes that lie on a surface or move, and those in space, which are drawn as tubes with cones,
#: and go on from one to the next without a break.
FLAT, TUBE = Arrow(0.1, 0.3, 0.15), Arrow(0.25, 0.5, 0.1, 0.1)


class LineSegments(NamedTuple):
    """Segments of the lines of a mesh, line after line.

    ``starts`` and ``ends`` are the points at both ends, and ``before`` is the length of the line
    before the segment.
    """

    starts: Indices
    ends: Indices
    lines: Indices
    before: Array
    lengths: Array

    def totals(self) -> Array:
        """Return the lengths of the lines."""
        return np.asarray(np.bincount(self.lines, weights=self.lengths), dtype=np.float64)


def segments_of(mesh: pv.PolyData) -> LineSegments:
    """Return the segments of the lines of a mesh, of lines of two points or more."""
    points, ids, offsets = polylines.cells_of(mesh)
    number = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    inner = np.flatnonzero(number[1:] == number[:-1])
    starts, ends, lines = ids[inner], ids[inner + 1], number[inner]
    steps = points[ends].astype(np.float64) - points[starts]
    # Squares of the largest coordinates would overflow.
    lengths = np.hypot(np.hypot(steps[:, 0], steps[:, 1]), steps[:, 2])
    sums = np.cumsum(lengths) - lengths
    first = np.flatnonzero(np.diff(lines, prepend=-1))
    before = sums - np.repeat(sums[first], np.diff(first, append=len(lines)))
    return LineSegments(starts, ends, lines, before, lengths)


def against(mesh: pv.PolyData, segments: LineSegments, tangents: AnyArray) -> Bools:
    """Return whether each line runs against the tangents at its points."""
    points = np.asarray(mesh.points, dtype=np.float64)
    ways = points[segments.ends] - points[segments.starts]
    both = np.asarray(tangents)[segments.starts] + np.asarray(tangents)[segments.ends]
    dots = np.einsum("ij,ij->i", ways, both)
    return np.bincount(segments.lines, weights=dots) < 0


def ages(mesh: pv.PolyData, tangents: AnyArray) -> Array:
    """Return the length of the line from its start to each point, along the tangents.

    Lengths are in the unit of the mesh; the first point of a closed line has the length 0.
    """
    segments = segments_of(mesh)
    return _run_through(mesh, segments, against(mesh, segments, tangents))


def turned(mesh: pv.PolyData, values: Array) -> Array:
    """Return values at the points of lines as if each line ran from its end to its start."""
    segments = segments_of(mesh)
    totals, line = segments.totals(), np.zeros(mesh.n_points, dtype=np.intp)
    line[segments.starts] = line[segments.ends] = segments.lines
    along = _run_through(mesh, segments, np.zeros(len(totals), dtype=np.bool_))
    # One line after another, with as much room between two as the longest is long.
    first = np.cumsum(totals + totals.max(initial=0.0)) - totals
    points = np.unique([segments.starts, segments.ends])
    place = first[line[points]] + along[points]
    order = np.argsort(place)
    mirrored = np.array(values, dtype=np.float64)
    mirrored[points] = np.interp(
        (2 * first + totals)[line[points]] - place, place[order], mirrored[points[order]]
    )
    return mirrored


def leaning(mesh: pv.PolyData, values: Array) -> Array:
    """Return 1 at the points of lines that have larger values beyond their middle, -1 before it."""
    segments = segments_of(mesh)
    beyond = segments.before + (segments.lengths - segments.totals()[segments.lines]) / 2
    both = values[segments.starts] + values[segments.ends]
    moments = np.bincount(segments.lines, segments.lengths * beyond * both)
    leans = np.zeros(mesh.n_points)
    leans[segments.starts] = leans[segments.ends] = np.sign(moments)[segments.lines]
    return leans


def _run_through(mesh: pv.PolyData, segments: LineSegments, turned: Bools) -> Array:
    """Return the length or time of lines before each point, some counted from their ends."""
    after = segments.before + segments.lengths
    turned = turned[segments.lines]
    totals = segments.totals()[segments.lines]
    lengths = np.zeros(mesh.n_points)
    lengths[segments.ends] = np.where(turned, totals - after, after)
    lengths[segments.starts] = np.where(turned, totals - segments.before, segments.before)
    return lengths


def without_short(mesh: pv.PolyData, least: float) -> pv.PolyData:
    """Return the parts of the lines of a mesh that have a length or more, and no kinks.

    At a kink a line turns by more than a right angle within a seventh of the least length: it turns
    on the spot, as at a point of stagnation, or follows noise, and is two lines. The field array
    ``left_out`` is the number of lines no part of which is left.
    """
    segments = segments_of(mesh)
    kinked = _turns(mesh, segments, KINK * least) > math.pi / 2
    parts = _numbered(segments.lines, kinked)
    kept = ~kinked & (np.bincount(parts, segments.lengths) >= least)[parts]
    whole = _rebuilt(mesh, segments, kept, parts)
    whole.field_data["left_out"] = [mesh.n_lines - len(np.unique(segments.lines[kept]))]
    return whole


def inside(mesh: pv.PolyData, border: Array, spacing: float) -> pv.PolyData:
    """Return the lines of a mesh without their parts along a border, if others are left.

    ``border`` (N, 2, 3) has the ends of the sides of a surface at its border; a part runs along it
    if it is longer than the spacing between lines, and nearer to it than 0.3 of that.
    """
    segments, least = segments_of(mesh), RIM * spacing
    if not len(border) or not len(segments.lines):
        return mesh
    first, ways = border[:, 0], border[:, 1] - border[:, 0]
    # Points on the border that are near enough to stand for it.
    counts = np.ceil(2 * kernels.length_rows(ways) / least).astype(np.intp) + 1
    side = np.repeat(np.arange(len(border)), counts)
    rank = np.arange(len(side)) - np.repeat(np.cumsum(counts) - counts, counts)
    points = first[side] + (rank / counts[side])[:, np.newaxis] * ways[side]
    distances = scipy.spatial.cKDTree(points).query(mesh.points, distance_upper_bound=least)[0]
    near = np.asarray(distances < least)
    near = near[segments.starts] & near[segments.ends]
    parts = _numbered(segments.lines, near)
    kept: Bools = ~near | (np.bincount(parts, segments.lengths) <= spacing)[parts]
    if kept.all() or not kept.any():
        return mesh
    return _rebuilt(mesh, segments, kept, _numbered(segments.lines, kept))


def _numbered(lines: Indices, mark: Bools) -> Indices:
    """Return numbers of the parts of lines whose segments have one mark."""
    return np.cumsum(np.any(np.diff([lines, mark], prepend=-1), axis=0))


def _turns(mesh: pv.PolyData, segments: LineSegments, within: float) -> Array:
    """Return by how many radians each line turns within a length around each of its segments."""
    points = np.asarray(mesh.points, dtype=np.float64)
    ways, _ = kernels.unit((points[segments.ends] - points[segments.starts]).T)
    same = segments.lines[1:] == segments.lines[:-1]
    angles = np.arccos(np.clip(kernels.dot(ways[:, 1:], ways[:, :-1]), -1, 1))
    turned_by = np.cumsum(np.append(0.0, np.where(same, angles, 0.0)))
    # One line after another, with room between them.
    first = (segments.totals() + within).cumsum()[segments.lines]
    joint = first + segments.before - segments.totals()[segments.lines]
    middle = joint + segments.lengths / 2
    low, high = (np.searchsorted(joint[1:], middle + side * within / 2) for side in (-1, 1))
    return np.asarray(turned_by[high] - turned_by[low])


def cut(mesh: pv.PolyData, length: float, tangents: str, arrow: Arrow | None) -> pv.PolyData:
    """Return lines cut at their points into strokes of one length, with their widths.

    Strokes with a sense get points of their own at the base of their heads. Those of a line are
    equally long, as far as its points allow. The point array ``width`` is as the arrow says, with 1
    at the base of a head; without an arrow it goes from 0.3 at both ends to 1. ``tangents`` names
    the directions of the strokes.
    """
    segments = segments_of(mesh)
    totals = segments.totals()
    sizes = totals / np.maximum(np.round(totals / length), 1)
    share = (segments.before + segments.lengths / 2) / np.maximum(sizes[segments.lines], 1e-300)
    places = np.stack([segments.lines, np.floor(share)])
    pieces = np.cumsum(np.any(np.diff(places, prepend=0.0), axis=0))
    strokes = _rebuilt(mesh, segments, np.ones(len(pieces), dtype=np.bool_), pieces)
    run, whole = _runs(strokes, tangents)
    if arrow is None:
        thick = 1 - np.abs(2 * run / np.where(whole > 0, whole, 1.0) - 1)
        strokes.point_data[WIDTH] = (ENDS + (1 - ENDS) * thick).astype(np.float32)
        return strokes
    heads = np.minimum(arrow.head * length, MOST_HEAD * whole)
    bases = [_crossings(strokes, run - whole + start * heads) for start in (1 + BASE, 1.0)]
    strokes = _divided(strokes, np.concatenate(bases))
    run, whole = _runs(strokes, tangents)
    heads = np.minimum(arrow.head * length, MOST_HEAD * whole)
    place, head = (part / np.where(whole > 0, whole, 1.0) for part in (run, heads))
    strokes.point_data[WIDTH] = _profile(place, arrow, head)
    return strokes


def set_widths(lines: pv.PolyData, times: str, duration: float, arrow: Arrow) -> None:
    """Give lines the widths of one stroke each, thin as long as it is short.

    They are the point array ``width``; ``times`` names the times at which a particle passes, rising
    along a line, and ``duration`` is the time that a stroke which is grown shows.
    """
    _, ids, offsets = polylines.cells_of(lines)
    when = np.asarray(lines.point_data[times], dtype=np.float64)[ids]
    counts = np.diff(offsets)
    first = np.repeat(when[offsets[:-1]], counts)
    shown = np.repeat(when[offsets[1:] - 1], counts) - first
    place = (when - first) / np.where(shown > 0, shown, 1.0)
    head = np.minimum(arrow.head * duration / np.where(shown > 0, shown, 1.0), MOST_HEAD)
    widths = np.zeros(lines.n_points, dtype=np.float32)
    widths[ids] = _profile(place, arrow, head) * np.clip(shown / (FADE * duration), 0, 1)
    lines.point_data[WIDTH] = widths


def _runs(strokes: pv.PolyData, tangents: str) -> tuple[Array, Array]:
    """Return the length of its line before each point along tangents, and of the whole line."""
    segments = segments_of(strokes)
    whole = np.zeros(strokes.n_points)
    for ends in (segments.starts, segments.ends):
        whole[ends] = segments.totals()[segments.lines]
    return ages(strokes, strokes.point_data[tangents]), whole


def _profile(place: Array, arrow: Arrow, head: Array | float) -> Array:
    """Return the widths of strokes at places from 0 to 1, with heads of a share of their length."""
    from_base = (place - 1) / np.maximum(head, 1e-9) + 1
    shaft = arrow.tail + (arrow.neck - arrow.tail) * place / np.maximum(1 - head, 1e-9)
    rising = shaft + (1 - shaft) * np.clip(1 + from_base / BASE, 0, 1)
    return np.asarray(
        np.where(from_base > 0, np.maximum(1 - from_base, arrow.tip), rising), dtype=np.float32
    )


def _crossings(lines: pv.PolyData, level: Array) -> Array:
    """Return where a number at the points of lines is zero, in numbers of points."""
    segments = segments_of(lines)
    here, there = level[segments.starts], level[segments.ends]
    crossed = here * there < 0
    return np.asarray(
        segments.starts[crossed] + (here / np.where(crossed, here - there, 1))[crossed]
    )


def _divided(lines: pv.PolyData, places: Array) -> pv.PolyData:
    """Return lines with ordered points, with new points at fractions of their numbers."""
    _, _, offsets = polylines.cells_of(lines)
    rows = np.sort(np.concatenate([np.arange(lines.n_points), places]))
    before = np.floor(rows).astype(np.intp)
    share, after = rows - before, np.minimum(before + 1, lines.n_points - 1)

    def between(values: AnyArray) -> AnyArray:
        if values.dtype.kind != "f":
            return np.asarray(values[np.where(share < 0.5, before, after)])
        part = share.reshape(-1, *(1,) * (values.ndim - 1))
        # A point keeps its value beside one that is not finite.
        with np.errstate(invalid="ignore"):
            mixed = (1 - part) * values[before] + part * values[after]
        return np.asarray(np.where(part > 0, mixed, values[before]), dtype=values.dtype)

    ends = np.searchsorted(rows, offsets[1:] - 1, side="right")
    return _polylines(lines, between, np.diff(ends, prepend=0))


def fine(mesh: pv.PolyData, length: float) -> pv.PolyData:
    """Return lines with points that are near enough to show heads of strokes that move.

    ``length`` is the distance from one stroke to the next.
    """
    segments = segments_of(mesh)
    lines = _rebuilt(mesh, segments, np.ones(len(segments.lines), dtype=np.bool_), segments.lines)
    segments = segments_of(lines)
    parts = np.maximum(np.ceil(segments.lengths * STEPS / (FLAT.head * length)), 1).astype(np.intp)
    first = np.repeat(np.cumsum(parts) - parts, parts)
    share = (np.arange(len(first)) - first) / np.repeat(parts, parts)
    return _divided(lines, (np.repeat(segments.starts, parts) + share)[share > 0])


def set_moving(mesh: pv.PolyData, length: float, velocities: AnyArray, travel: float) -> None:
    """Give lines the point arrays of strokes that move along them with the vectors.

    Each line has a whole number of strokes that pass in a period, so that a movie can be repeated.
    Strokes are as long as the way moved in that time: longer where the vectors are. The arrays are
    ``phase``, ``passing``, ``grown``, and ``width`` at the start; the field array ``period`` is in
    the unit of lengths over that of the velocities. ``length`` is the distance from one stroke to
    the next on a line of any speed, as far as the whole number of strokes allows, and ``travel``
    the number of these distances that the 90th percentile of the speeds moves in a period.
    """
    segments = segments_of(mesh)
    speed = kernels.length_rows(velocities)
    least = SLOWEST * float(np.median(speed[speed > 0])) if speed.any() else 1.0
    speed = np.maximum(speed, least)
    # The mean of the times by both ends of a step, which is exact where the speed is even.
    slow = (1 / speed[segments.starts] + 1 / speed[segments.ends]) / 2
    times = segments.lengths * slow
    sums = np.cumsum(times) - times
    first = np.flatnonzero(np.diff(segments.lines, prepend=-1))
    before = sums - np.repeat(sums[first], np.diff(first, append=len(times)))
    timed = segments._replace(before=before, lengths=times)
    totals, period = timed.totals(), travel * length / float(np.percentile(speed, 90))
    mean = segments.totals() / np.maximum(totals, 1e-300)
    passing = np.maximum(np.round(period * mean / length), 1)
    elapsed = _run_through(mesh, timed, against(mesh, segments, velocities))
    line = np.zeros(mesh.n_points, dtype=np.intp)
    line[segments.starts], line[segments.ends] = segments.lines, segments.lines
    apart = period / passing[line]
    # Neighbours are out of step, by a ratio that repeats last.
    phase = elapsed / apart + np.arange(len(totals))[line] * GOLDEN
    near = np.minimum(elapsed, totals[line] - elapsed)
    arrays = {PHASE: phase, PASSING: passing[line], GROWN: np.clip(near / (FADE * apart), 0, 1)}
    for name, values in arrays.items():
        mesh.point_data[name] = values.astype(np.float32)
    mesh.field_data["period"] = [period]
    mesh.point_data[WIDTH] = moved_widths(mesh, 0.0)


def moved_widths(mesh: pv.PolyData, share: float) -> Array:
    """Return the widths of strokes that have moved for a share of their period.

    The lines have the arrays of :func:`set_moving`. Widths are 0 between strokes, 0.3 behind the
    head of one, which is 1 at its base, less where it grows.
    """
    phase, passing, grown = (
        np.asarray(mesh.point_data[name], dtype=np.float64) for name in (PHASE, PASSING, GROWN)
    )
    place = (phase - passing * share) % 1.0
    width = _profile((place - BARE) / (1 - BARE), FLAT, FLAT.head)
    return np.asarray(np.where(place < BARE, 0.0, grown * width), dtype=np.float32)


def _rebuilt(
    mesh: pv.PolyData, segments: LineSegments, kept: Bools, pieces: Indices
) -> pv.PolyData:
    """Return polylines of the segments that are kept, one for each run of equal pieces.

    Each has points of its own. Arrays of points and fields are those of the mesh.
    """
    starts, ends, pieces = segments.starts[kept], segments.ends[kept], pieces[kept]
    first = np.flatnonzero(np.diff(pieces, prepend=-1))
    counts = np.diff(first, append=len(pieces))
    # A run of m segments has m starts, and the end of the last one.
    rows = np.insert(starts, first + counts, ends[first + counts - 1])
    return _polylines(mesh, lambda values: values[rows], counts + 1)


def _polylines(
    mesh: pv.PolyData, at_points: Callable[[AnyArray], AnyArray], counts: Indices
) -> pv.PolyData:
    """Return polylines of numbers of points, with points and arrays that a function makes."""
    rebuilt = pv.PolyData()
    rebuilt.points = at_points(np.asarray(mesh.points))
    offsets = np.cumsum(counts) - counts
    rebuilt.lines = np.insert(np.arange(rebuilt.n_points), offsets, counts)
    # PyVista refuses arrays without rows.
    for name in mesh.point_data if rebuilt.n_points else ():
        rebuilt.point_data[name] = at_points(np.asarray(mesh.point_data[name]))
    rebuilt.field_data.update(mesh.field_data)
    return rebuilt
