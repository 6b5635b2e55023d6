"""Lines of a plotter as strokes: their visible parts, colours and widths."""

from __future__ import annotations

import itertools
import operator
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkCamera, vtkRenderer

from vizlight._types import Array, Bools, Color, Indices
from vizlight.draw.cameras import pixel_sizes
from vizlight.draw.glsl import Stroke as Style
from vizlight.draw.live import Live, in_view, matrix_of
from vizlight.draw.strokes import LEAST, color_of_halo, line_samples
from vizlight.draw.vector.files import Fill, Polyline, rgb_of
from vizlight.draw.vector.samples import Samples, actors_of
from vizlight.geometry.contours.palette import nearest_colors
from vizlight.geometry.contours.rings import simplified
from vizlight.vtk.polylines import cells_of, has_lines_only

#: Distance of a line behind what is drawn, in its widths, up to which it is what is drawn.
BEHIND = 1.5
#: The same of a line with a halo, whose depth is known.
ALIKE = 0.3
#: Ratio of two widths that are drawn as one, and difference from a halo that is rounding.
EVEN, SAME = 1.12, 2.0
#: More lines than one actor has.
LINES = 1 << 40
#: Share of an error by which colours of a run may differ from their mean; the rest is for runs of
#: one colour.
RUN = 0.75
#: Errors in 1/255, and distances in pixels of lines from their strokes.
LIMITS = (2.0, 16.0), (0.1, 0.25)
#: Width in pixels below which nothing is drawn, and most places on a segment.
THIN, LONGEST = 0.05, 20_000
#: Distance by which lines may be drawn nearer to the eye than they are, as a share of their size.
LIFTED = 1e-3
#: Share of a halo that is drawn where it does not show: other lines end at its border, and those
#: that run together keep most of their width.
NARROW = 0.3
#: Shares of the width at which a line is read; the mean of its colours is that of a round one.
ACROSS = (-0.35, 0.0, 0.35)


class Lines(NamedTuple):
    """Lines that an actor draws.

    ``width`` is in pixels, where they have no diameter; ``colors`` are channels of each point from
    0 to 255, where no light changes them.
    """

    renderer: vtkRenderer
    actor: vtkActor
    style: Style
    width: float
    colors: Array | None


class Course(NamedTuple):
    """Places along lines, at most a pixel apart.

    ``place`` (n, 2) is in pixels from the upper left, ``distance`` from the plane of the eye;
    ``end`` is where a ``line`` ends. ``width`` and ``halo``, the band on each side, 0 where none is
    seen, are in pixels, ``color`` and that of the band, ``around``, from 0 to 255.
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

    ``live_of`` returns the live light of an actor, or None.
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
    if not is_plain or (mapper.GetScalarVisibility() and values is None):
        return None
    if not mapper.GetScalarVisibility():
        return 255 * np.tile(actor.GetProperty().GetColor(), (mesh.n_points, 1))
    plain = pv.convert_array(np.ascontiguousarray(values))
    table = pv.convert_array(mapper.GetLookupTable().MapScalars(plain, mapper.GetColorMode(), -1))
    return np.asarray(table[:, :3], dtype=np.float64)


def course_of(lines: Lines, samples: Samples, bare: Samples, scale: int) -> Course:
    """Return the course of lines in a picture that shows them.

    ``samples`` are of the whole picture, at the size at which the renderer draws now, with
    ``scale`` for each pixel along a side, and ``bare`` ones of the same without lines.
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
    reach = 2 * np.abs(np.diff(distance, prepend=distance[:1]))
    core = distance
    if style.halo:
        # The shader draws it nearer by its width, up to the near plane.
        core = np.maximum(distance - width * footprint, camera.GetClippingRange()[0])
        reach += ALIKE * width * footprint
    else:
        reach += BEHIND * width * footprint + LIFTED * np.linalg.norm(np.ptp(world, axis=0))
    place = np.stack([at[:, 0], samples.depth.shape[0] - at[:, 1]], axis=1)
    across = scale * _across(place, number[start])
    beside = (0.5 + 0.5 * style.halo) * width
    halo = NARROW * style.halo * width
    width = width * at[:, 3]
    # A surface on which a line lies hides part of its width, and must not make it dashed.
    seen = core - _distance(_read(samples.depth, place), camera) <= reach
    band = 255 * np.array(color_of_halo(style, renderer))
    color: Array = np.zeros((len(place), samples.colors.shape[2]))
    counts, is_near = np.zeros(len(place)), np.zeros(len(place), dtype=np.bool_)
    for part in ACROSS:
        side = place + part * width[:, np.newaxis] * across
        drawn = _read(samples.depth, side)
        near = np.abs(core - _distance(drawn, camera)) <= reach
        near &= drawn < _read(bare.depth, side)
        is_near |= near
        if style.halo:
            # A thin part of a line is read beside it.
            near[near] = _differs(samples, side[near], band)
        color[near] += _read(samples.colors, side[near])
        counts += near
    mean = color / np.maximum(counts, 1)[:, np.newaxis]
    # Light changes across a line: a place is read where all of its width is seen, if any is.
    color, colored = _continued(mean, counts > 0, number[start])
    whole, is_whole = _continued(mean, counts == len(ACROSS), number[start])
    color[is_whole] = whole[is_whole]
    color[~colored] = band[: color.shape[1]]
    if lines.colors is not None:
        colors = lines.colors[ids][:, : color.shape[1]]
        color = colors[start] + along[:, np.newaxis] * (colors[start + 1] - colors[start])
    if style.halo:
        seen = is_near
    # Each goes on beneath other lines, so that no ground shows between them.
    clear = core - _distance(_read(bare.depth, place), camera) <= reach
    seen |= clear & _near(seen, number[start], (width + 1) / 2)
    seen &= (colored | is_near) & (width > THIN)
    if style.halo:
        away = beside[seen, np.newaxis] * across[seen]
        is_shown = _has_halo(samples, bare, place[seen], away, band)
        halo[seen] *= np.where(is_shown, 1 / NARROW, 1.0)
    around = np.tile(band, (len(place), 1))
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


def _has_halo(samples: Samples, bare: Samples, place: Array, away: Array, band: Array) -> Bools:
    """Return where the colour of a halo, on either side of a line, covers another."""
    shown = np.zeros(len(place), dtype=np.bool_)
    for side in (place - away, place + away):
        shown |= ~_differs(samples, side, band) & _differs(bare, side, band)
    return shown


def _differs(samples: Samples, place: Array, band: Array) -> Bools:
    """Return where samples have another colour than a halo."""
    away = np.abs(_read(samples.colors, place) - band[: samples.colors.shape[2]])
    return np.asarray(away.max(axis=1) >= SAME)


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

    They have the corner before each, and the share of the way to the next corner.
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
    """Return colours, between places of a line that have one, and where a line has any."""
    at = np.arange(len(full))
    before = np.maximum.accumulate(np.where(full, at, 0))
    after = np.minimum.accumulate(np.where(full, at, len(full) - 1)[::-1])[::-1]
    ahead = full[before] & (line[before] == line)
    behind = full[after] & (line[after] == line)
    first, last = np.where(ahead, before, after), np.where(behind, after, before)
    share = (at - first) / np.maximum(last - first, 1)
    mixed: Array = color[first] + share[:, np.newaxis] * (color[last] - color[first])
    return mixed, ahead | behind


def _read(picture: Array, place: Array) -> Array:
    """Return the samples of a picture at places, those at the border for places beyond."""
    rows, columns = picture.shape[:2]
    at = np.floor(place).astype(np.intp)
    return picture[np.clip(at[:, 1], 0, rows - 1), np.clip(at[:, 0], 0, columns - 1)]


def strokes_of(courses: Sequence[Course], error: float) -> tuple[list[Polyline | Fill], float]:
    """Return strokes from the farthest to the nearest, and the largest error of their colours.

    A visible piece of a line has one halo, and over it a stroke for each run of like colours; those
    of several widths are outlines. Pieces of a layer that look alike are one path. The error is the
    largest difference of a colour, in 1/255.
    """
    if not any(np.any(each.seen) for each in courses):
        return [], 0.0
    lines = [
        each._replace(
            line=each.line + i * LINES, color=np.broadcast_to(each.color, (len(each.color), 3))
        )
        for i, each in enumerate(courses)
    ]
    every = Course(*(np.concatenate(part) for part in zip(*lines, strict=True)))
    rows = np.flatnonzero(every.seen)
    every = Course._make(part[rows] for part in every)
    is_first = np.append(True, (np.diff(rows) != 1) | (np.diff(every.line) != 0))
    pieces = np.append(np.flatnonzero(is_first), len(rows))
    runs = _runs(every.color, pieces, RUN * error)
    low, high = (each.reduceat(every.color, runs[:-1]) for each in (np.minimum, np.maximum))
    colors, label = nearest_colors((low + high) / 2, (1 - RUN) * error)
    # Edges are written in whole steps of colours.
    color = np.rint(colors[label])
    away = np.abs(every.color - np.repeat(color, np.diff(runs), axis=0))
    style = operator.itemgetter(slice(-1))
    limit = float(np.interp(error, *LIMITS))
    parts = sorted(_parts(every, pieces, runs, color, limit), key=style)
    items: list[Polyline | Fill] = []
    for (_, _, rgb, width, ends), alike in itertools.groupby(parts, style):
        paths = [part.corners for part in alike]
        items.append(Polyline(rgb, paths, width, ends) if width else Fill(rgb, paths))
    return items, float(away.max())


class _StyledPath(NamedTuple):
    """Line or, without a width, outline in a layer, over its halo or as one."""

    layer: int
    over: int
    color: Color
    width: float
    round: bool
    corners: Array


def _parts(
    every: Course, pieces: Indices, runs: Indices, color: Array, limit: float
) -> Iterator[_StyledPath]:
    """Yield the halos of pieces and the strokes of runs."""
    layer = _layers(every, pieces)
    piece = np.repeat(np.arange(len(layer)), np.diff(pieces))
    across = _across(every.place, piece)
    bent = np.column_stack([every.place, every.width / 2])
    kept = simplified(bent, pieces, np.full(len(bent), limit))
    for over, starts in enumerate((pieces, runs)):
        for run, (begin, end) in enumerate(itertools.pairwise(starts.tolist())):
            at = piece[begin]
            # Runs reach beneath those beside them, so that no seam shows.
            first, last = max(begin - over, pieces[at]), min(end - 1 + over, pieces[at + 1] - 1)
            # NumPy's own median takes longer than all else for a short stroke.
            halo = 0.0 if over else float(np.sort(every.halo[begin:end])[(end - begin) // 2])
            if last == first or not (over or halo):
                continue
            inner = first + 1 + np.flatnonzero(kept[first + 1 : last])
            corners = np.concatenate([[first], inner, [last]])
            width = every.width[corners] + 2 * halo
            rgb = rgb_of(color[run] if over else every.around[begin])
            points, mean = every.place[corners], 0.0
            if width.max() > EVEN * width.min():
                points = _outline(points, across[corners], width)
            else:
                mean = float(np.mean(every.width[first : last + 1])) + 2 * halo
                mean = round(mean, 1 if mean > 1 else 2)
            is_whole = bool(over and mean and every.end[first] and every.end[last])
            yield _StyledPath(int(layer[at]), over, rgb, mean, is_whole, points)


def _runs(color: Array, starts: Indices, error: float) -> Indices:
    """Return where runs of colours begin that are within an error of one, and the end of all."""
    runs = []
    for begin, end in itertools.pairwise(starts.tolist()):
        while begin < end:
            part = color[begin:end]
            span = (np.maximum.accumulate(part) - np.minimum.accumulate(part)).max(axis=1)
            runs.append(begin)
            begin += int(np.searchsorted(span, 2 * error, "right"))
    return np.array([*runs, starts[-1]])


def _layers(every: Course, starts: Indices) -> Indices:
    """Return the layers of pieces: those that may touch are in the order of their distances."""
    reach = every.width / 2 + every.halo
    side = max(float(reach.max()), 1.0)
    corners = np.stack(np.meshgrid(*2 * [[-1, 0, 1]]), -1).reshape(-1, 1, 2)
    cells = np.floor((every.place + corners * reach[:, np.newaxis]) / side).astype(np.int64)
    cells -= cells.min(axis=(0, 1))
    code = cells[..., 1] * (cells[..., 0].max() + 1) + cells[..., 0]
    top = np.zeros(code.max() + 1, dtype=np.intp)
    mean = np.add.reduceat(every.distance, starts[:-1]) / np.diff(starts)
    layers = np.zeros(len(mean), dtype=np.intp)
    for i in np.argsort(-mean, kind="stable"):
        at = code[:, starts[i] : starts[i + 1]]
        layers[i] = top[at].max() + 1
        top[at] = layers[i]
    return layers


def _outline(points: Array, across: Array, width: Array) -> Array:
    """Return the ring around a line of some widths, from the unit vectors across it."""
    side = across * (width / 2)[:, np.newaxis]
    return np.concatenate([points + side, (points - side)[::-1]])
