"""Marks of a picture: segments of lines, glyphs, the grain of both, and which way is ahead."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter

from vizlight import _pool
from vizlight.model.kernels import unit_rows
from vizlight.observers.eye import means
from vizlight.observers.pixels import in_pixels, visible, with_own_points
from vizlight.observers.samples import dots

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    import pyvista as pv
    from vtkmodules.vtkRenderingCore import vtkActor

    from vizlight._types import Array, Bools, Indices
    from vizlight.observers.eye import Eye, SeenPicture
    from vizlight.observers.pixels import Cells, Pixels
    from vizlight.observers.samples import SeenMesh

#: Number of deviations of noise by which a difference is seen (Rose, J. Opt. Soc. Am. 38, 1948: 3
#: at least).
SEEN = 3.0
#: Distance in pixels, in ``Segments.along``, between different lines, so that no two are near.
JUMP = 1e6
#: Width in arc minutes of the window in which a reader sees a mark and the ground beside it.
WINDOW = 8.0
#: Number of channels of marks, fine and coarse.
CHANNELS = 2
#: Least number of pixels of both ends of a stroke whose sense is read.
END = 3
#: Number of segments whose places are found at once.
BLOCK = 1 << 16


class Segments(NamedTuple):
    """Segments of lines that a picture shows, in pixels from the upper left corner.

    ``number`` (H, W) is the segment that each pixel shows, -1 without one. ``start`` and ``way``
    (S, 2) are the beginning of each, to the right and down, and the vector to its end; ``along`` is
    the length of the line before it, with different lines far apart, and ``width`` that of the line
    in pixels. ``ahead`` is 1 where the sense of the data is that of the segment, -1 against it, 0
    without a sense; ``lean`` is 1 where lines are wider ahead of their middle, as the segment runs,
    -1 behind it, else 0. ``course`` has all segments of the lines, if these are those that are
    seen.
    """

    number: Indices
    start: Array
    way: Array
    along: Array
    line: Indices
    width: Array
    ahead: Array
    course: AllSegments | None = None
    lean: Array | None = None

    @property
    def shown(self) -> Indices:
        """Line that each pixel shows, -1 without one, shape (H, W)."""
        return np.where(self.number >= 0, self.line[self.number], -1)

    def ways_at(self, along: Array) -> Array:
        """Return the vectors of the segments at places along the lines, also of hidden ones."""
        if self.course is not None:
            return self.course.ways_at(along)
        return self.way[_last(self.along, along)]

    def places(self, row: Indices, column: Indices) -> tuple[Indices, Array]:
        """Return the segments that pixels show, and how far along the lines the pixels are."""
        segment = self.number[row, column]
        way = self.way[segment]
        here = np.column_stack([column + 0.5, row + 0.5]) - self.start[segment]
        square = np.einsum("ij,ij->i", way, way)
        share = np.clip(np.einsum("ij,ij->i", here, way) / np.maximum(square, 1e-12), 0.0, 1.0)
        return segment, self.along[segment] + share * np.sqrt(square)


def segments_of(parts: Sequence[SeenMesh], pixels: Pixels, camera: pv.Camera) -> Segments | None:
    """Return the segments of the lines of a picture, None without lines."""
    width, height = pixels.size
    number = np.full((height, width), -1, dtype=np.intp)
    widths: list[Array] = []
    ahead: list[Array] = []
    lean: list[Array] = []
    seen: dict[int, Indices] = {}
    count = 0
    for i, part in enumerate(parts):
        if part.kind == "line":
            shows = pixels.part == i
            seen[i], which = np.unique(pixels.cell[shows], return_inverse=True)
            number[pixels.row[shows], pixels.column[shows]] = count + which
            widths.append(part.drawn.widths(seen[i], camera, height))
            ahead.append(part.ahead(seen[i]))
            lean.append(part.lean(seen[i]))
            count += len(seen[i])
    if not seen:
        return None
    course = AllSegments(parts, pixels.size, camera)
    columns = zip(*course.rows(seen), strict=True)
    start, way, along, line = (np.concatenate(column) for column in columns)
    width_of, sense, leans = (np.concatenate(column) for column in (widths, ahead, lean))
    return Segments(number, start, way, along, line, width_of, sense, course, leans)


class _Rows(NamedTuple):
    """Some rows of the arrays of :class:`Segments`."""

    start: Array
    way: Array
    along: Array
    line: Indices


class AllSegments:
    """All segments of the lines of a picture, made in blocks and not stored.

    ``size`` is the width and height of the picture.
    """

    def __init__(self, parts: Sequence[SeenMesh], size: tuple[int, int], camera: pv.Camera) -> None:
        self._parts, self._size, self._camera = parts, size, camera
        self._blocks = [
            (i, rows)
            for i, part in enumerate(parts)
            if part.kind == "line"
            for rows in _pool.blocks(len(part.cells), BLOCK)
        ]
        #: Number of the last line, and length of all segments, before each block that is known.
        self._before = [(-1, 0.0)]
        self._begin: Array = np.zeros(0)

    def rows(self, seen: Mapping[int, Indices]) -> Iterator[_Rows]:
        """Yield the rows of some segments of each part, by their rising numbers."""
        begin = []
        for block, (i, rows) in enumerate(self._blocks):
            all_of_block = self._made(block)
            begin.append(all_of_block.along[0])
            first, last = np.searchsorted(seen[i], (rows.start, rows.stop))
            chosen = seen[i][first:last] - rows.start
            start, way, along, line = all_of_block
            yield _Rows(start[chosen], way[chosen], along[chosen], line[chosen])
        self._begin = np.array(begin)

    def ways_at(self, along: Array) -> Array:
        """Return the vectors of the segments at places along the lines, after ``rows``."""
        ways = np.empty((len(along), 2))
        of_place = _last(self._begin, along)
        for block in np.unique(of_place):
            here = np.flatnonzero(of_place == block)
            rows = self._made(int(block))
            ways[here] = rows.way[_last(rows.along, along[here])]
        return ways

    def _made(self, block: int) -> _Rows:
        """Return all rows of a block; those of the one before were made already."""
        i, rows = self._blocks[block]
        part, (line, length) = self._parts[i], self._before[block]
        cells = np.asarray(part.cells[rows])
        points, corners = with_own_points(part.inputs.points, cells)
        places = in_pixels(self._camera, self._size, points)
        start = places[corners[:, 0]]
        way = places[corners[:, 1]] - start
        # A segment that does not begin where the one before ends is of another line.
        end = part.cells[rows.start - 1 : rows.start][:, 1] if rows.start else [-1]
        lines = line + np.cumsum(cells[:, 0] != np.append(end, cells[:-1, 1]))
        along = np.cumsum(np.append(length, np.nan_to_num(np.hypot(way[:, 0], way[:, 1]))))
        if block + 1 == len(self._before):
            self._before.append((int(lines[-1]), float(along[-1])))
        return _Rows(start, way, along[:-1] + JUMP * lines, lines)


def _last(rising: Array, values: Array) -> Indices:
    """Return the last of rising numbers that is not above each of some values, else the first."""
    return np.clip(np.searchsorted(rising, values, side="right") - 1, 0, None)


class Strokes(NamedTuple):
    """Strokes as a reader sees them, of data that have a sense.

    ``light`` is the lightness above the ground, in CIELAB: the end of a stroke that is ahead less
    the other. ``form`` is the sense by the widths of the stroke, :func:`ahead_of`, and ``pixels``
    the number of pixels that show it.
    """

    light: Array
    form: Array
    pixels: Indices


def turned_lines(
    parts: Sequence[SeenMesh], pixels: Pixels, camera: pv.Camera, occluders: Sequence[vtkActor]
) -> Indices:
    """Return the line that each pixel would show if the widths of lines ran the other way.

    Numbers (H, W) of the lines are as in ``Segments.shown``, arguments as for :func:`segments_of`;
    ``occluders`` hide the meshes.
    """
    if any(part.shares is not None for part in parts):
        pixels = visible([part.turned for part in parts], camera, pixels.size, occluders)
    lines = segments_of(parts, pixels, camera)
    return np.full(pixels.size[::-1], -1) if lines is None else lines.shown


def strokes_of(lines: Segments, turned: Indices, seen: SeenPicture, eye: Eye) -> Strokes:
    """Return how the third ahead differs from the third behind, of each stroke that is seen.

    ``turned`` is that of :func:`turned_lines`.
    """
    row, column = np.nonzero(lines.number >= 0)
    keep = lines.ahead[lines.number[row, column]] != 0
    row, column = row[keep], column[keep]
    segment, along = lines.places(row, column)
    # Lines by their numbers among those with a sense that are seen.
    names, line = np.unique(lines.line[segment], return_inverse=True)
    low, high = np.full(len(names), np.inf), np.full(len(names), -np.inf)
    np.minimum.at(low, line, along)
    np.maximum.at(high, line, along)
    at = (along - low[line]) / np.maximum(high - low, 1e-9)[line]
    sign = np.sign(np.bincount(line, lines.ahead[segment], len(names)))
    at = np.where(sign[line] < 0, 1 - at, at)
    bare = lines.number < 0
    # Ground is where no mark would be either if it were turned.
    above = above_ground(seen, ~bare | (turned >= 0), eye)
    form = np.zeros(len(names))
    if lines.lean is not None:
        ink = np.linalg.norm(above, axis=2)
        lean = np.bincount(line, (lines.ahead * lines.lean)[segment], len(names))
        form = np.sign(lean) * ahead_of(lines.shown, turned, ink, bare, eye)[names]
    light = above[row, column, :1]
    first, last = at < 1 / 3, at > 2 / 3
    enough = np.ones(len(names), dtype=np.bool_)
    for third in (first, last):
        enough &= np.bincount(line[third], minlength=len(names)) >= END
    behind, ahead = (means(light[third], line[third], len(names)) for third in (first, last))
    return Strokes((ahead - behind)[enough, 0], form[enough], np.bincount(line)[enough])


def above_ground(seen: SeenPicture, covered: Bools, eye: Eye) -> Array:
    """Return how colours differ from the bare ground beside them.

    It is the mean of a Gaussian of the variance of the window, so that a ground of changing colours
    is none of its marks. Differences are in CIELAB; ``covered`` masks pixels of lines and glyphs.
    """
    spread, bare = _window(eye) / math.sqrt(12), ~covered * 1.0
    colors = gaussian_filter(bare[..., np.newaxis] * seen.colors, (spread, spread, 0.0))
    ground = colors / np.maximum(gaussian_filter(bare, spread), 1e-9)[..., np.newaxis]
    # The middle of a wide mark is far from the ground.
    row, column = distance_transform_edt(covered, return_distances=False, return_indices=True)
    return np.asarray(seen.colors - ground[row, column])


def _window(eye: Eye) -> float:
    """Return the width in pixels of the window of a reader, 1 at least."""
    return max(1.0, WINDOW / 60 * eye.pixels_per_degree)


def grain_of(seen: SeenPicture, eye: Eye, seed: int) -> Array:
    """Return the structure that a reader sees around each pixel: the grain of marks and textures.

    It is the structure tensor of a window of 8 arc minutes (Bigun and Granlund 1987): the grain is
    across the direction in which the colours change most. Changes over more than the window, such
    as shading, are no grain. The eye has channels for fine and for coarse marks: changes are those
    of a pixel, and of half of the variance of the window, in which the noise of pixels is less. The
    result (H, W, CHANNELS, 3) has mean products of the changes to the right and down in each
    channel: xx, xy, yy. The noise of the eye is added to each pixel.
    """
    random = np.random.default_rng(seed)
    noisy = seen.colors + random.normal(0.0, eye.noise, seen.colors.shape)
    # A Gaussian of the variance of the window.
    spread = _window(eye) / math.sqrt(12)
    # Derivatives of Gaussians are alike in all directions, unlike differences of pixels.
    orders = (1, 0, 0), (0, 1, 0)
    shading = [gaussian_filter(noisy, (spread, spread, 0.0), order) for order in orders]
    channels = np.empty((*noisy.shape[:2], CHANNELS, 3))
    for channel, fine in enumerate((1.0, max(1.0, spread / math.sqrt(2)))):
        down, right = (
            gaussian_filter(noisy, (fine, fine, 0.0), order) - wide
            for order, wide in zip(orders, shading, strict=True)
        )
        for column, (a, b) in enumerate(((right, right), (right, down), (down, down))):
            channels[..., channel, column] = gaussian_filter((a * b).sum(axis=2), spread)
    return channels


def along_grain(tensor: Array) -> Array:
    """Return the grain of structure tensors, shape (..., 3), as ``c exp(2 i a)``.

    c is the share of all change that is across the grain, from 0 to 1, and a the angle from right
    toward up.
    """
    xx, xy, yy = np.moveaxis(tensor, -1, 0)
    return np.asarray((yy - xx + 2j * xy) / np.maximum(xx + yy, 1e-12))


class Glyphs(NamedTuple):
    """Glyphs of a picture, in pixels from the upper left corner, to the right and down.

    ``number`` and ``turned`` (H, W) are the glyph that each pixel shows, and would show if each
    were turned round about its middle, -1 without one; ``way`` is the unit course of its vector,
    and ``reach`` half of the length of the glyph along that.
    """

    number: Indices
    turned: Indices
    middle: Array
    way: Array
    reach: Array


def glyphs_of(parts: Sequence[SeenMesh], pixels: Pixels, camera: pv.Camera) -> Glyphs | None:
    """Return the glyphs of a picture, None without glyphs; as for :func:`segments_of`."""
    cells: list[Cells] = []
    numbers: list[Indices] = []
    middles: list[Array] = []
    ends: list[Array] = []
    for part in parts:
        number = np.zeros(0, dtype=np.intp)
        if part.glyph is not None:
            number = part.glyph + sum(map(len, middles))
            turned, middle, end = _turned(part)
            cells.append(turned)
            middles.append(middle)
            ends.append(end)
        numbers.append(number)
    if not cells:
        return None
    shown = _numbered(pixels, numbers)
    round_about = visible(cells, camera, pixels.size)
    turned_shown = _numbered(round_about, [number for number in numbers if len(number)])
    middle, end = (in_pixels(camera, pixels.size, np.concatenate(each)) for each in (middles, ends))
    way = np.nan_to_num(end - middle)
    reach = np.linalg.norm(way, axis=1)
    return Glyphs(shown, turned_shown, np.nan_to_num(middle), unit_rows(way), reach)


def _turned(part: SeenMesh) -> tuple[Cells, Array, Array]:
    """Return glyphs turned round about their middles, the middles, and the ends ahead of them."""
    assert part.glyph is not None
    assert part.inputs.tangents is not None
    points, vectors = (
        np.asarray(rows[:], dtype=np.float64) for rows in (part.inputs.points, part.inputs.tangents)
    )
    glyph = np.full(len(points), -1)
    glyph[part.cells[:]] = part.glyph[:, np.newaxis]
    used = glyph >= 0
    number, ways = glyph[used], unit_rows(vectors[used])
    mean, way = means(points[used], number), means(ways, number)
    along = dots(points[used] - mean[number], ways)
    low, high = np.full(len(mean), np.inf), np.full(len(mean), -np.inf)
    np.minimum.at(low, number, along)
    np.maximum.at(high, number, along)
    middle = mean + ((low + high) / 2)[:, np.newaxis] * way
    end = middle + ((high - low) / 2)[:, np.newaxis] * way
    return part.drawn._replace(points=2 * middle[glyph] - points), middle, end


def _numbered(pixels: Pixels, numbers: list[Indices]) -> Indices:
    """Return the number of the cell of a part that each pixel of a picture shows, else -1."""
    width, height = pixels.size
    shown = np.full((height, width), -1, dtype=np.intp)
    for part, number in enumerate(numbers):
        if len(number):
            shows = pixels.part == part
            shown[pixels.row[shows], pixels.column[shows]] = number[pixels.cell[shows]]
    return shown


def ahead_of(number: Indices, turned: Indices, ink: Array, bare: Bools, eye: Eye) -> Array:
    """Return whether marks look as they are or as if turned round, by the pixels that differ.

    This is the contrast of the pixels that a mark has and would not have if it were turned, less
    that of the bare pixels that it would have then. It is seen if it is the noise of the eye at
    least, and 3 deviations of the means over as many square arc minutes (Rose 1948). Where a
    surface hides all of one side, the other one is compared with half of the contrast of the mark.
    ``number`` and ``turned`` are as for :class:`Glyphs`, ``ink`` is the contrast with the
    surroundings, and ``bare`` masks pixels without marks. The result is 1 as they are, -1 turned, 0
    for neither, and NaN for marks without a pixel.
    """
    count = 1 + int(max(number.max(), turned.max()))

    def seen_in(marks: Indices, there: Bools) -> tuple[Array, Indices]:
        there = there & (marks >= 0)
        mean = means(ink[there][:, np.newaxis], marks[there], count)[:, 0]
        return mean, np.bincount(marks[there], minlength=count)

    apart = number != turned
    half = seen_in(number, ~apart)[0] / 2
    as_it_is, pixels = seen_in(number, apart)
    round_about, others = seen_in(turned, apart & bare)
    without, hidden = pixels == 0, seen_in(turned, apart)[1] == 0
    more = np.where(without, half, as_it_is) - np.where(hidden, half, round_about)
    fewest = np.where(without, others, np.where(hidden, pixels, np.minimum(pixels, others)))
    minutes = fewest / (eye.pixels_per_degree / 60) ** 2
    least = eye.noise * np.maximum(1.0, SEEN * np.sqrt(2 / np.maximum(minutes, 1e-3)))
    # What stands out is not what is hidden.
    tells = (np.abs(more) >= least) & (minutes > 0) & ~np.where(more > 0, without, hidden)
    shown = np.bincount(number[number >= 0], minlength=count) > 0
    return np.where(shown, np.sign(more) * tells, np.nan)


def lengths_of(glyphs: Glyphs, ink: Array, least: float) -> Array:
    """Return the lengths in pixels at which glyphs are seen along their course from their middle.

    A glyph ends where its contrast is less than half of that in its middle, or than ``least``.
    """
    far = math.ceil(1.5 * float(glyphs.reach.max(initial=0.0)))
    steps = np.arange(-far, far + 1)[:, np.newaxis]
    height, width = ink.shape
    lengths = np.zeros(len(glyphs.way))
    for i in np.flatnonzero(glyphs.reach > 0):
        column, row = np.floor(glyphs.middle[i] + steps * glyphs.way[i]).astype(np.intp).T
        inside = (column >= 0) & (row >= 0) & (column < width) & (row < height)
        profile = np.where(inside, ink[row.clip(0, height - 1), column.clip(0, width - 1)], 0.0)
        ends = np.flatnonzero(profile < max(least, profile[far] / 2))
        before, after = ends[ends <= far], ends[ends >= far]
        lengths[i] = after.min(initial=2 * far + 1) - before.max(initial=-1) - 1
    return np.maximum(lengths, 0.0)


def two_sides(right: float, wrong: float, total: int) -> float:
    """Return the bits that answers give of a question of two sides.

    It is the information of a channel that is silent at some places and wrong at others, ``(t + w)
    / n (1 - H(t / (t + w)))``, less the bias of a sample, ``1 / (2 n ln 2)`` (Miller 1955); 0 where
    as many answers are wrong as right. Numbers of answers may be sums of weights, 1 in the mean.
    """
    if right <= wrong:
        return 0.0
    share = right / (right + wrong)
    entropy = sum(-p * np.log2(p) for p in (share, 1 - share) if p > 0)
    return max(0.0, float((right + wrong) / total * (1 - entropy) - 1 / (2 * total * np.log(2))))
