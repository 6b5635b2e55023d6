"""The figure of a plotter as vector graphics, as accurate as its size allows."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor

from vizlight import _check
from vizlight._types import Array, Bools, Color, Slice
from vizlight.draw.live import Live
from vizlight.draw.vector import VECTORS
from vizlight.draw.vector.files import Fill, Item, Picture, Plate, Sheet, pdf_of, rgb_of, svg_of
from vizlight.draw.vector.lines import Course, course_of, lines_of, strokes_of
from vizlight.draw.vector.samples import Samples, enlarged, samples_of, without
from vizlight.draw.vector.words import words_of
from vizlight.geometry.contours.faces import faces
from vizlight.geometry.contours.levels import levels
from vizlight.geometry.contours.palette import FEWER, nearest_colors, palette_of
from vizlight.geometry.contours.steady import steadied
from vizlight.writing import check_output, replace_file

#: Largest file in bytes that is made where no error is asked for.
LARGEST = 500_000
#: Errors in 1/255: the finest and the coarsest of which one is chosen, and the largest that is not
#: worth a warning.
FINEST, COARSEST, UNSAID = 2.0, 16.0, 4.0
#: Bytes of a figure of an error of 1 for each sample and difference of neighbouring ones by 1, as
#: measured, the largest difference that counts, and bytes for each pixel along a line.
BYTES, EDGE, ALONG = 1.6, 32.0, 40.0
#: Colours up to which those of three channels are faces in SVG files, and plates above.
FEW = 128
#: Error that would be needed above which no coarser figure is tried.
HOPELESS = 24.0
#: Power of the error to which the size falls, as measured, and share of the largest size that is
#: aimed at.
POWER, AIM = 1.5, 0.9
#: Pixels in place of paths, until they fit: how many along each of the picture's own, and the
#: quality of JPEG, None for PNG.
PIXELS = ((2, None), (2, 92), (1, 92))
#: Shares of an error by which samples may move, and at which borders may lie off their place.
STEADY, LOOSE = 0.08, 0.12
#: Difference that is rounding.
EXACT = 0.1
#: Most samples of a picture, and most along a side of a pixel.
SAMPLES, FINE = 12_000_000, 4


def save_graphic(
    plotter: pv.BasePlotter,
    path: str | Path,
    live_of: Callable[[vtkActor], Live | None],
    /,
    *,
    error: float | None = None,
) -> Path:
    """Write the picture of a plotter as an SVG or PDF file; see ``plotter.vizlight.save_graphic``.

    ``live_of`` returns the live light of an actor, or None.
    """
    path = check_output(path, VECTORS)
    if error is not None:
        error = _check.number("error", error, low=0.1, high=128.0)
    drawn = _Drawn.of(plotter, live_of)
    first = drawn.likely_error() if error is None else error
    suffix = path.suffix.lower()
    plates = suffix == ".svg" and drawn.has_more_colors(FEW, first)
    best = drawn.attempt(suffix, first, plates=plates)
    if error is None:
        best = _fitting(drawn, suffix, best, plates=plates)
    _note(path, best, error=error)
    return replace_file(path, lambda draft: Path(draft).write_bytes(best.data))


class _Attempt(NamedTuple):
    """A file, and the largest error of its colours in 1/255; infinite where it holds pixels."""

    data: bytes
    asked: float
    error: float


@dataclasses.dataclass(frozen=True)
class _Drawn:
    """Drawing of a plotter: samples of its surfaces, and the lines and words over them."""

    size: tuple[int, int]
    background: Color
    scale: int
    samples: Samples
    shown: Bools
    place: tuple[int, int]
    courses: list[Course]
    words: list[Item]

    @classmethod
    def of(cls, plotter: pv.BasePlotter, live_of: Callable[[vtkActor], Live | None]) -> _Drawn:
        """Draw a plotter, and put it back as it was."""
        plotter.reset_camera_clipping_range()
        # PyVista sets the camera with the first picture.
        plotter.screenshot(return_img=True)
        width, height = plotter.window_size
        scale = int(min(max((SAMPLES / (width * height)) ** 0.5, 1), FINE))
        words, props = words_of(plotter)
        lines = lines_of(plotter, live_of)
        with enlarged(plotter, scale, props):
            for each in lines:
                each.actor.GetProperty().SetLineWidth(scale * each.width)
            whole = samples = samples_of(plotter, fine=not lines)
            if lines:
                with without([each.actor for each in lines]):
                    samples = samples_of(plotter)
            courses = [course_of(each, whole, samples, scale) for each in lines]
        red, green, blue = pv.Color(plotter.background_color).float_rgb
        ground = np.rint(255 * np.array((red, green, blue)))
        shown = np.any(samples.colors != ground[: samples.colors.shape[2]], axis=2)
        rows, columns = (_span(shown.any(axis=axis), scale) for axis in (1, 0))
        samples = Samples(samples.colors[rows, columns], samples.depth[rows, columns])
        shown = shown[rows, columns]
        place = columns.start // scale, rows.start // scale
        size = (width, height)
        return cls(size, (red, green, blue), scale, samples, shown, place, courses, words)

    def likely_error(self) -> float:
        """Return the error with which the figure is likely to have its largest size."""
        colors, shown, total = self.samples.colors, self.shown, 0.0
        for near, far in ((np.s_[:-1], np.s_[1:]), (np.s_[:, :-1], np.s_[:, 1:])):
            step = np.minimum(np.abs(colors[near] - colors[far]), np.float32(EDGE))
            total += float(np.sum(step[shown[near] & shown[far]], dtype=np.float64))
        along = sum(np.count_nonzero(each.seen) for each in self.courses)
        size = BYTES * total / self.scale + ALONG * along
        return float(np.clip((size / (AIM * LARGEST)) ** (1 / POWER), FINEST, COARSEST))

    def has_more_colors(self, count: int, error: float) -> bool:
        """Return whether three channels have more colours than some number, within an error."""
        colors = self.samples.colors[self.shown][::FEWER]
        return colors.shape[1] > 1 and len(nearest_colors(colors, error)[0]) > count

    def attempt(self, suffix: str, error: float, *, plates: bool) -> _Attempt:
        """Return the figure with an error that is asked, of three channels as plates if asked."""
        if plates:
            parts = [self._faces(slice(i, i + 1), error) for i in range(3)]
            under: Item = Fill((0, 0, 0), [_page(self.size)])
            fills = [under, *(Plate(faces) for _, _, faces in parts)]
        else:
            parts = [self._faces(slice(None), error)]
            fills = [*parts[0][2]]
        lines, away = strokes_of(self.courses, error)
        count = sum(part[0] for part in parts)
        reached = max(away, *(part[1] for part in parts))
        kind = "levels of red, green and blue" if plates else "colours"
        words = f"{count} {kind}, each within {reached:.1f} of 255 of the light"
        return _Attempt(self.written(suffix, fills, lines, words), error, reached)

    def _faces(self, channels: Slice, error: float) -> tuple[int, float, list[Fill]]:
        """Return the number of colours of channels, their largest error, and their faces.

        Faces are in the order of painting, the background last, all around what reaches beneath it.
        """
        colors = self.samples.colors[..., channels]
        ground = np.rint(255 * np.array(self.background))[channels][: colors.shape[2]]
        moved = steadied(colors, self.shown, self.scale, STEADY * error)
        half = (1 - STEADY - LOOSE) * error
        single = colors.shape[2] == 1
        palette = palette_of(moved, ground, half, self.scale, self.shown)
        fills: list[Fill] = []
        for face in (levels if single else faces)(palette, moved, self.scale, LOOSE * error):
            color = np.zeros(3)
            color[channels] = face.color
            rings = [ring + self.place for ring in face.rings]
            fills.append(Fill(rgb_of(color), rings))
        page = _page(self.size)
        last = fills.pop() if fills else Fill(self.background, [page])
        fills.append(Fill(last.color, [page, *last.rings[1:]]))
        # Colours that are exact have no borders within a surface that may be off.
        loose = (STEADY + LOOSE) * error if palette.error > EXACT else 0.0
        return len(palette.colors), palette.error + loose, fills

    def pixels(
        self, suffix: str, along: int, quality: int | None, lines: Sequence[Item]
    ) -> _Attempt:
        """Return the figure with so many pixels along each of the picture's own, as PNG or JPEG."""
        step = max(self.scale // along, 1)
        colors = np.clip(np.rint(self.samples.colors), 0, 255).astype(np.uint8)
        rows, columns = (side // step * step for side in colors.shape[:2])
        parts = colors[:rows, :columns].reshape(rows // step, step, columns // step, step, -1)
        mean = np.rint(parts.mean(axis=(1, 3))).astype(np.uint8)
        shown = np.broadcast_to(mean, (*mean.shape[:2], 3))
        size = (columns / self.scale, rows / self.scale)
        picture: list[Item] = [Picture(np.ascontiguousarray(shown), self.place, size, quality)]
        data = self.written(suffix, picture, lines, "pixels, strokes and words")
        return _Attempt(data, 0.0, np.inf)

    def written(self, suffix: str, faces: list[Item], lines: Sequence[Item], words: str) -> bytes:
        """Return a file of faces, with strokes and words over them."""
        groups = {"faces": faces, "lines": [*lines], "words": self.words}
        sheet = Sheet(self.size, self.background, groups, words)
        return svg_of(sheet).encode() if suffix == ".svg" else pdf_of(sheet)


def _span(shown: Bools, scale: int) -> Slice:
    """Return the whole pixels that hold all samples that are shown, and one on each side."""
    where = np.flatnonzero(shown)
    if not len(where):
        return slice(0, scale)
    first, last = where[0] // scale - 1, where[-1] // scale + 2
    return slice(max(first, 0) * scale, min(last * scale, len(shown)))


def _page(size: tuple[int, int]) -> Array:
    """Return the ring around a picture."""
    width, height = size
    return np.array([(0, 0), (width, 0), (width, height), (0, height)], dtype=np.float64)


def _fitting(drawn: _Drawn, suffix: str, attempt: _Attempt, *, plates: bool) -> _Attempt:
    """Return the most accurate figure that is not too large, from a first attempt."""
    best, power = None, POWER
    for _ in range(4):
        size = len(attempt.data)
        if size <= LARGEST and (best is None or attempt.asked < best.asked):
            best = attempt
        error = attempt.asked * (size / (AIM * LARGEST)) ** (1 / power)
        if error > HOPELESS:
            break
        error = float(np.clip(error, FINEST, COARSEST))
        # A finer one is worth its time once, a coarser one until it fits.
        fine = attempt.error <= FINEST or error > 0.8 * attempt.asked
        if best is not None and (best is not attempt or fine):
            return best
        if attempt.asked == COARSEST:
            break
        before, attempt = attempt, drawn.attempt(suffix, error, plates=plates)
        if attempt.asked > before.asked:
            # Sizes of noise fall more slowly: two of them tell how, and whether any error helps.
            fall = math.log(size / len(attempt.data)) / math.log(attempt.asked / before.asked)
            power = float(np.clip(fall, POWER / 8, POWER))
    if best is not None:
        return best
    lines, _ = strokes_of(drawn.courses, COARSEST)
    # Pixels in place of faces help nothing where it is the strokes that are many.
    few = len(drawn.written(suffix, [], lines, "")) <= LARGEST
    # A PDF file has no JPEG, and a large picture no more pixels than its own.
    ways = dict.fromkeys(
        (min(along, drawn.scale), quality if suffix == ".svg" else None)
        for along, quality in PIXELS
    )
    others = list[_Attempt]()
    for along, quality in ways if few else ():
        others.append(drawn.pixels(suffix, along, quality, lines))
        if len(others[-1].data) <= LARGEST:
            return others[-1]
    if attempt.asked < COARSEST:
        attempt = drawn.attempt(suffix, COARSEST, plates=plates)
    # Colours of pixels are exact, which is worth twice the size.
    return min(attempt, *others, key=lambda each: len(each.data) * (1 + math.isfinite(each.error)))


def _note(path: Path, best: _Attempt, *, error: float | None) -> None:
    """Say where a figure is larger or less accurate than is usual."""
    size = f"{len(best.data) / 1000:.0f} kB"
    if not np.isfinite(best.error):
        _check.warn(
            f"'{path.name}' holds pixels and words, in {size}: as paths it would be larger than "
            f"{LARGEST // 1000} kB at an error of {COARSEST:g} of 255; save_graphic(error=) of a "
            "plotter makes paths"
        )
    elif len(best.data) > LARGEST:
        _check.warn(
            f"'{path.name}' has {size} at an error of {best.error:.1f} of 255, more than "
            f"{LARGEST // 1000} kB: fewer lines or details make it smaller, and so does a larger "
            "save_graphic(error=) of a plotter"
        )
    elif error is None and best.error > UNSAID:
        _check.warn(
            f"colours of '{path.name}' are within {best.error:.1f} of 255, so that it has at most "
            f"{LARGEST // 1000} kB ({size}); save_graphic(error={UNSAID:g}) makes a larger one"
        )
