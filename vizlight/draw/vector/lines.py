"""Lines of a plotter as strokes: their visible parts, colours and widths."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkCamera, vtkRenderer

from vizlight._types import Array, Bools, Indices
from vizlight.draw.cameras import pixel_sizes
from vizlight.draw.glsl import Stroke as Style
from vizlight.draw.live import Live, in_view, matrix_of
from vizlight.draw.strokes import LEAST, color_of_halo, line_samples
from vizlight.draw.vector.files import Fill, Polyline
from vizlight.draw.vector.samples import Samples, actors_of
from vizlight.geometry.contours.palette import nearest_colors
from vizlight.geometry.contours.rings import SEEN, simplified
from vizlight.vtk.polylines import cells_of, has_lines_only

#: Distance of a line behind what is drawn, in its widths, up to which it is what is drawn.
BEHIND = 1.5
#: Ratio of two widths that are drawn as one, and difference from the ground that is rounding.
ALIKE, SAME = 1.12, 2.0
#: Width in pixels above which a line is its outline, so that its parts join without a wedge, and
#: more lines than one actor has.
BROAD, LINES = 3.0, 1 << 40
#: Places by which they overlap.
EARLIER = 2
#: Width in pixels below which nothing is drawn, and most places on a segment.
THIN, LONGEST = 0.05, 20_000
#: Distance by which lines may be drawn nearer to the eye than they are, as a share of their size.
LIFTED = 1e-3
#: Share of a halo that is drawn where it covers no surface: other lines end at its border, and
#: those that run together keep most of their width.
NARROW = 0.3
#: Shares of the width at which the colour of a line is read; its mean is that of a round one.
ACROSS = (-0.25, 0.0, 0.25)


class Lines(NamedTuple):
    """Lines that an actor draws.

    Attributes
    ----------
    renderer : vtkRenderer
    actor : vtkActor
    style : Style
        How they are drawn.
    width : float
        Width in pixels, where they have no diameter.
    colors : ndarray, shape (N, 3), or None
        Channels of each point from 0 to 255, where no light changes them.
    """

    renderer: vtkRenderer
    actor: vtkActor
    style: Style
    width: float
    colors: Array | None


class Course(NamedTuple):
    """Places along lines, at most a pixel apart.

    Attributes
    ----------
    place : ndarray, shape (n, 2)
        Pixels from the upper left.
    distance : ndarray, shape (n,)
        Distance from the plane of the eye.
    line : ndarray of int, shape (n,)
        Number of the line.
    end : ndarray of bool, shape (n,)
        Whether the line ends at the point.
    width : ndarray, shape (n,)
        Width in pixels.
    seen : ndarray of bool, shape (n,)
    color : ndarray, shape (n, c)
        Channels from 0 to 255.
    halo : ndarray, shape (n,)
        Width of the band on each side in pixels; 0 where none is seen.
    around : ndarray, shape (n, 3)
        Colour of the band, from 0 to 1.
    """

    place: Array
    distance: Array
    line: Indices
    end: Bools
    width: Array
    seen: Bools
    color: Array
    halo: Array
    around: Array


def lines_of(plotter: pv.BasePlotter, live_of: Callable[[vtkActor], Live | None]) -> list[Lines]:
    """Return the lines of a plotter that can be strokes: all that shaders of others do not widen.

    Parameters
    ----------
    plotter : pyvista.Plotter
    live_of : callable
        Function that returns the live light of an actor, or None.
    """
    lines = []
    for renderer in plotter.renderers:
        for actor in actors_of(renderer):
            mesh = actor.GetMapper().GetInputDataObject(0, 0)
            style = actor.GetProperty()
            is_mesh = mesh is not None and mesh.IsA("vtkPolyData") and mesh.GetNumberOfPoints()
            if not is_mesh or style.GetOpacity() < 1 or not has_lines_only(mesh):
                continue
            live = live_of(actor)
            shaded = actor.GetShaderProperty().GetNumberOfShaderReplacements()
            if live is None and (shaded or style.GetRenderLinesAsTubes()):
                continue
            how = Style() if live is None else live.stroke
            colors = _unlit_colors(actor, pv.wrap(mesh), live)
            # VTK's own lines are wider in a larger picture, which is shrunk.
            wide = line_samples(renderer) if how == Style() else 1.0
            width = float(style.GetLineWidth()) / wide
            lines.append(Lines(renderer, actor, how, width, colors))
    return lines


def _unlit_colors(actor: vtkActor, mesh: pv.PolyData, live: Live | None) -> Array | None:
    """Return the colours of points, from 0 to 255, None where light or cells may change them."""
    if live is None:
        is_plain = not actor.GetProperty().GetLighting()
    else:
        scene = live.scene
        is_plain = scene is not None and not scene.lights and scene.depth_cue is None
        is_plain = is_plain and scene is not None and scene.material.ambient == 1
    mapper = actor.GetMapper()
    values = mesh.point_data.get(mapper.GetArrayName()) if is_plain else None
    if not is_plain or (mapper.GetScalarVisibility() and (values is None or values.ndim > 1)):
        return None
    if not mapper.GetScalarVisibility():
        return 255 * np.tile(actor.GetProperty().GetColor(), (mesh.n_points, 1))
    plain = pv.convert_array(np.ascontiguousarray(values))
    table = pv.convert_array(mapper.GetLookupTable().MapScalars(plain, 1, -1))
    return np.asarray(table[:, :3], dtype=np.float64)


def course_of(lines: Lines, samples: Samples, bare: Samples, scale: int) -> Course:
    """Return the course of lines in a picture that shows them.

    Parameters
    ----------
    lines : Lines
    samples : Samples
        The whole picture, at the size at which the renderer draws now.
    bare : Samples
        The same without lines.
    scale : int
        Samples for each pixel, along a side.
    """
    renderer, style = lines.renderer, lines.style
    camera = renderer.GetActiveCamera()
    mesh = pv.wrap(lines.actor.GetMapper().GetInputDataObject(0, 0))
    points, ids, offsets = cells_of(mesh)
    matrix = matrix_of(lines.actor.GetMatrix())
    world = points[ids] @ matrix[:3, :3].T + matrix[:3, 3]
    corners = _projected(world, renderer)
    share = np.ones((len(ids), 1))
    if style.width is not None:
        widths = np.asarray(mesh.point_data[style.width], dtype=np.float64)
        share[:, 0] = np.clip(np.nan_to_num(widths[ids]), 0, 1)
    number = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    start, along, ends = _places(corners, number, scale)
    rows = np.concatenate([corners[:, :3], share], axis=1)
    at = rows[start] + along[:, np.newaxis] * (rows[start + 1] - rows[start])
    distance = _distance(at[:, 2], camera)
    footprint = scale * pixel_sizes(camera, distance, renderer.GetSize()[1])
    width = np.full(len(at), lines.width)
    if style.diameter is not None:
        width = np.maximum(style.diameter / footprint, LEAST)
    # The depth of a stroke is nearer by its width, and changes along a line that is seen end on.
    reach = BEHIND * width * footprint + 2 * np.abs(np.diff(distance, prepend=distance[:1]))
    reach += LIFTED * np.linalg.norm(np.ptp(world, axis=0))
    place = np.stack([at[:, 0], samples.depth.shape[0] - at[:, 1]], axis=1)
    across = scale * _across(place, number[start])
    beside = (0.5 + 0.5 * style.halo) * width
    covers = _over_surface(samples, bare, place, beside, across, renderer)
    halo = style.halo * width * np.where(covers, 1.0, NARROW)
    width = width * at[:, 3]
    # A surface on which a line lies hides part of its width, and must not make it dashed.
    seen = distance - _distance(_read(samples.depth, place), camera) <= reach
    color: Array = np.zeros((len(place), samples.colors.shape[2]))
    counts = np.zeros(len(place))
    for part in ACROSS:
        side = place + part * width[:, np.newaxis] * across
        drawn = _read(samples.depth, side)
        near = np.abs(distance - _distance(drawn, camera)) <= reach
        near &= drawn < _read(bare.depth, side)
        color[near] += _read(samples.colors, side)[near]
        counts += near
    mean = color / np.maximum(counts, 1)[:, np.newaxis]
    color, colored = _continued(mean, counts > 0, number[start])
    if lines.colors is not None:
        colors = lines.colors[ids][:, : color.shape[1]]
        color = colors[start] + along[:, np.newaxis] * (colors[start + 1] - colors[start])
    seen &= colored & (width > THIN)
    # Beneath other lines a wide one goes on: where its middle is hidden its border may be seen.
    clear = distance - _distance(_read(bare.depth, place), camera) <= reach
    clear &= colored & (width > BROAD)
    seen |= clear & _near(seen, number[start], width + 1)
    around = np.tile(color_of_halo(style, renderer), (len(place), 1))
    return Course(place / scale, distance, number[start], ends, width, seen, color, halo, around)


def _near(seen: Bools, line: Indices, count: Array) -> Bools:
    """Return which places have one that is seen within some places before or behind."""
    at = np.arange(len(seen))
    # Lines are as far from each other as no place of a line is.
    place = at + line * len(seen)
    before = np.maximum.accumulate(np.where(seen, place, -2 * len(seen)))
    after = np.minimum.accumulate(np.where(seen, place, 1 << 60)[::-1])[::-1]
    near: Bools = np.minimum(place - before, after - place) <= count
    return near


def _over_surface(
    samples: Samples, bare: Samples, place: Array, away: Array, across: Array, renderer: vtkRenderer
) -> Bools:
    """Return where the colour of the ground beside a line covers a surface."""
    ground = 255 * np.array(renderer.GetBackground())[: samples.colors.shape[2]]
    hides = np.zeros(len(place), dtype=np.bool_)
    for sign in (-1, 1):
        side = place + sign * away[:, np.newaxis] * across
        color, other = _read(samples.colors, side), _read(bare.colors, side)
        covers = np.all(np.abs(color - ground) < SAME, axis=1)
        hides |= covers & np.any(np.abs(other - ground) >= SAME, axis=1)
    return hides


def _projected(points: Array, renderer: vtkRenderer) -> Array:
    """Return places in samples from the lower left, depths from 0 to 1, and whether in front."""
    shown, front = in_view(renderer.GetActiveCamera(), renderer.GetTiledAspectRatio(), points)
    size, origin = np.array(renderer.GetSize()), np.array(renderer.GetOrigin())
    places = origin + (shown[:, :2] + 1) / 2 * size
    return np.column_stack([places, (shown[:, 2] + 1) / 2, front])


def _distance(depth: Array, camera: vtkCamera) -> Array:
    """Return the distances from the plane of the eye of some depths."""
    near, far = camera.GetClippingRange()
    if camera.GetParallelProjection():
        return np.asarray(near + depth * (far - near))
    return np.asarray(near * far / (far - depth * (far - near)))


def _places(corners: Array, number: Indices, scale: int) -> tuple[Indices, Array, Bools]:
    """Return places along lines at most a pixel apart, and which of them are ends.

    Returns
    -------
    start : ndarray of int
        Corner before each place.
    along : ndarray
        Share of the way to the next corner.
    ends : ndarray of bool
    """
    joined = (number[:-1] == number[1:]) & (corners[:-1, 3] > 0) & (corners[1:, 3] > 0)
    segment = np.flatnonzero(joined)
    length = np.hypot(*(corners[segment + 1, :2] - corners[segment, :2]).T) / scale
    count = np.clip(np.ceil(length), 1, LONGEST).astype(np.intp)
    # The last corner of a line, and one before what is behind the eye, is a place too.
    last = np.append(np.diff(segment) != 1, True)[: len(segment)]
    last[:-1] |= number[segment[1:]] != number[segment[:-1]]
    count += last
    first = np.repeat(np.cumsum(count) - count, count)
    parts = np.repeat(count - last, count)
    along = (np.arange(len(first)) - first) / parts
    ends = np.zeros(len(first), dtype=np.bool_)
    finish = np.cumsum(count)[last] - 1
    ends[finish] = ends[np.append(0, finish[:-1] + 1)[: len(finish)]] = True
    return np.repeat(segment, count), along, ends


def _across(place: Array, line: Indices) -> Array:
    """Return the unit vectors across lines at their places."""
    way = np.zeros_like(place)
    same = line[1:] == line[:-1]
    step = np.diff(place, axis=0) * same[:, np.newaxis]
    way[:-1] += step
    way[1:] += step
    length = np.hypot(*way.T)[:, np.newaxis]
    across: Array = np.stack([-way[:, 1], way[:, 0]], axis=1) / np.maximum(length, 1e-9)
    return across


def _continued(color: Array, full: Bools, line: Indices) -> tuple[Array, Bools]:
    """Return colours with those of the place before, or of the first after, where none is found."""
    where = np.where(full, np.arange(len(full)), -1)
    before = np.maximum.accumulate(where) if len(where) else where
    first = np.append(np.flatnonzero(full), -1)
    after = first[np.minimum(np.searchsorted(first[:-1], np.arange(len(full))), len(first) - 1)]
    same = (before >= 0) & (line[before] == line)
    chosen = np.where(same, before, after)
    valid = (chosen >= 0) & (line[chosen] == line)
    return color[chosen], valid


def _read(picture: Array, place: Array) -> Array:
    """Return the samples of a picture at places, those at the border for places beyond."""
    rows, columns = picture.shape[:2]
    at = np.floor(place).astype(np.intp)
    return picture[np.clip(at[:, 1], 0, rows - 1), np.clip(at[:, 0], 0, columns - 1)]


def strokes_of(courses: Sequence[Course], error: float) -> Iterator[Polyline | Fill]:
    """Yield strokes from the farthest to the nearest, each after its halo.

    Those of several widths are their outlines.

    Parameters
    ----------
    courses : sequence of Course
    error : float
        Largest difference of a colour, in 1/255.
    """
    if not any(np.any(course.seen) for course in courses):
        return
    every = Course(*(np.concatenate(part) for part in zip(*courses, strict=True)))
    line = np.repeat(np.arange(len(courses)), [len(course.line) for course in courses])
    centres, label = nearest_colors(every.color[every.seen].astype(np.float32), error)
    kind = np.full((len(line), 3), -1)
    kind[every.seen, 0] = label
    kind[:, 1], kind[:, 2] = line, every.line
    begins = np.flatnonzero(np.append(True, np.any(np.diff(kind, axis=0) != 0, axis=1)))
    begins = begins[every.seen[begins]]
    changes = np.append(np.flatnonzero(np.any(np.diff(kind, axis=0) != 0, axis=1)), len(line) - 1)
    finishes = changes[np.searchsorted(changes, begins)]
    # Each reaches to the first place of the next, so that they join.
    following = np.minimum(finishes + 1, len(line) - 1)
    joined = np.all(kind[following, 1:3] == kind[begins, 1:3], axis=1) & every.seen[following]
    joined &= following > finishes
    finishes = np.where(joined, following, finishes)
    kept = finishes > begins
    begins, finishes = begins[kept], finishes[kept]
    # One of one colour stays a stroke.
    same = np.all(kind[begins - 1, 1:] == kind[begins, 1:], axis=1) & every.seen[begins - 1]
    same &= begins > 0
    wide = (every.width[begins] > BROAD) & (joined[kept] | same)
    # Wide ones begin earlier, beneath the one before, so that no seam shows.
    firsts = begins.copy()
    for _ in range(EARLIER):
        before = np.maximum(firsts - 1, 0)
        same = every.seen[before] & np.all(kind[before, 1:] == kind[begins, 1:], axis=1)
        firsts = np.where(wide & same, before, firsts)
    spans = [np.arange(a, b + 1) for a, b in zip(firsts, finishes, strict=True)]
    if not spans:
        return
    rows = np.concatenate(spans)
    across = _across(every.place, LINES * line + every.line)
    starts = np.append(0, np.cumsum(finishes - firsts + 1))
    limit = np.full(len(rows), SEEN)
    limit[starts[1:] - 1] = 1e-9
    corners = simplified(np.column_stack([every.place, every.width / 2])[rows], starts, limit)
    mean = np.add.reduceat(every.distance[rows], starts[:-1]) / np.diff(starts)
    for run in np.argsort(-mean, kind="stable"):
        span = slice(starts[run], starts[run + 1])
        here = rows[span]
        kept = here[corners[span]]
        points, width = every.place[kept], every.width[kept]
        red, green, blue = (centres[kind[begins[run], 0]] / 255).tolist()
        # NumPy's own median takes longer than all else for a short stroke.
        halo = float(np.sort(every.halo[here])[len(here) // 2])
        around = tuple(every.around[here[0]].tolist())
        side = across[kept]
        if not wide[run] and width.max() <= ALIKE * width.min():
            mean_width = float(every.width[here].sum() / len(here))
            whole = bool(every.end[here[0]] and every.end[here[-1]])
            if halo > 0:
                yield Polyline(around, points, mean_width + 2 * halo)
            yield Polyline((red, green, blue), points, mean_width, whole)
        else:
            if halo > 0:
                yield Fill(around, [_outline(points, side, width + 2 * halo)])
            yield Fill((red, green, blue), [_outline(points, side, width)])


def _outline(points: Array, across: Array, width: Array) -> Array:
    """Return the ring around a line of some widths, from the unit vectors across it."""
    side = across * (width / 2)[:, np.newaxis]
    return np.concatenate([points + side, (points - side)[::-1]])
