"""Display lists written as SVG and PDF."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from vizlight._types import Array, Color

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Steps of a coordinate in a pixel.
STEPS = 10
#: Families of letters that look like those of VTK.
FAMILY = "Arial, Helvetica, sans-serif"
#: Height of the letters above the line, and distance of lines, as shares of their size.
ASCENT, DESCENT, LINE = 0.74, 0.22, 1.15
#: Pixels of an inch of the page: one for each point, as short numbers make small files.
DPI = 72


@dataclass(frozen=True)
class Fill:
    """Area of one colour: rings of corners in pixels, holes the other way round."""

    color: Color
    rings: Sequence[Array]


@dataclass(frozen=True)
class Polyline:
    """Lines of one colour through points in pixels, of a width in pixels."""

    color: Color
    lines: Sequence[Array]
    width: float
    round: bool = False


@dataclass(frozen=True)
class Words:
    """Lines of text.

    The place is in pixels from the upper left, ``size`` that of the letters in pixels; ``across``
    and ``above``, 0, 0.5 or 1, are the shares of the text at the left of the place and above it.
    """

    lines: Sequence[str]
    place: tuple[float, float]
    size: float
    color: Color
    across: float = 0.0
    above: float = 1.0

    def baselines(self) -> list[tuple[str, float]]:
        """Return each line with the height of its base, in pixels from the top."""
        step = LINE * self.size
        height = (ASCENT + DESCENT) * self.size + step * (len(self.lines) - 1)
        top = self.place[1] - self.above * height
        return [(line, top + ASCENT * self.size + i * step) for i, line in enumerate(self.lines)]


@dataclass(frozen=True)
class Picture:
    """Pixels, ndarray of uint8 of shape (rows, columns, 3), from a place over a size in pixels.

    In SVG they are a JPEG of a quality from 1 to 95, or for None a PNG.
    """

    pixels: NDArray[np.uint8]
    place: tuple[float, float]
    size: tuple[float, float]
    quality: int | None = None


@dataclass(frozen=True)
class Plate:
    """Faces of one channel: a picture has the lightest of its plates in each."""

    items: Sequence[Fill]


Item: TypeAlias = "Fill | Polyline | Words | Picture | Plate"


@dataclass(frozen=True)
class Sheet:
    """Items in the order of painting.

    The size is in pixels, the background from 0 to 1; ``groups`` has items by the name of each, and
    ``words`` are notes for a reader of the figure.
    """

    size: tuple[int, int]
    background: Color
    groups: dict[str, list[Item]]
    words: str


def rgb_of(color: Array) -> Color:
    """Return a colour of one or three channels from 0 to 255 as three from 0 to 1."""
    red, green, blue = np.broadcast_to(color, 3) / 255
    return float(red), float(green), float(blue)


def svg_of(sheet: Sheet) -> str:
    """Return a sheet as the text of an SVG file."""
    width, height = sheet.size
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}">\n<desc>{escape(sheet.words, quote=False)}</desc>\n'
        f'<rect width="100%" height="100%" fill="{_hex(sheet.background)}"/>\n'
    )
    parts = [head]
    for name, every in sheet.groups.items():
        if every:
            parts.append(f'<g id="{escape(name)}">\n')
            parts += _drawn(every)
            parts.append("</g>\n")
    return "".join([*parts, "</svg>\n"])


def _drawn(every: Iterable[Item]) -> Iterable[str]:
    """Yield the elements of items; paths are in tenths of pixels, in whole numbers."""
    small = False
    for item in every:
        if small != isinstance(item, Fill | Polyline):
            small = not small
            yield (
                f'<g transform="scale({1 / STEPS:g})" fill="none" stroke-linejoin="round">\n'
                if small
                else "</g>\n"
            )
        if isinstance(item, Fill):
            if path := _path(item.rings):
                yield f'<path fill="{_hex(item.color)}" d="{path}"/>\n'
        elif isinstance(item, Polyline):
            cap = ' stroke-linecap="round"' if item.round else ""
            yield (
                f'<path stroke="{_hex(item.color)}" stroke-width="{STEPS * item.width:.3g}"{cap} '
                f'd="{_path(item.lines, closed=False)}"/>\n'
            )
        elif isinstance(item, Words):
            yield from _text(item)
        elif isinstance(item, Plate):
            yield '<g style="mix-blend-mode:lighten">\n'
            yield from _drawn(item.items)
            yield "</g>\n"
        else:
            yield _image(item)
    if small:
        yield "</g>\n"


def _path(rings: Sequence[Array], *, closed: bool = True) -> str:
    """Return a path in whole numbers, each from the one before."""
    whole = np.rint(STEPS * np.concatenate(rings)).astype(np.int64)
    steps = np.diff(whole, axis=0, append=whole[-1:])
    moved = np.any(steps != 0, axis=1).tolist()
    texts = [f"{x}{y}" if y < 0 else f"{x} {y}" for x, y in steps.tolist()]
    starts = whole.tolist()
    parts, first = [], 0
    for ring in rings:
        last = first + len(ring) - 1
        lines = [texts[i] for i in range(first, last) if moved[i]]
        if len(lines) > closed:
            body = "".join(line if line[0] == "-" else f" {line}" for line in lines).lstrip()
            x, y = starts[first]
            parts.append(f"M{x} {y}l{body}{'z' * closed}")
        first = last + 1
    return "".join(parts)


def _text(item: Words) -> Iterable[str]:
    anchor = {0.0: "start", 0.5: "middle", 1.0: "end"}[item.across]
    spans = "".join(
        f'<tspan x="{item.place[0]:.1f}" y="{y:.1f}">{escape(line, quote=False)}</tspan>'
        for line, y in item.baselines()
    )
    yield (
        f'<text font-family="{FAMILY}" font-size="{item.size:.3g}" fill="{_hex(item.color)}" '
        f'text-anchor="{anchor}">{spans}</text>\n'
    )


def _image(item: Picture) -> str:
    data = io.BytesIO()
    picture, kind = Image.fromarray(item.pixels), "png" if item.quality is None else "jpeg"
    if item.quality is None:
        picture.save(data, "PNG", optimize=True)
    else:
        # Colours are as fine as their light.
        picture.save(data, "JPEG", quality=item.quality, optimize=True, subsampling=0)
    text = base64.b64encode(data.getvalue()).decode()
    (x, y), (width, height) = item.place, item.size
    return (
        f'<image x="{x}" y="{y}" width="{width:g}" height="{height:g}" preserveAspectRatio="none" '
        f'href="data:image/{kind};base64,{text}"/>\n'
    )


def _hex(color: Color) -> str:
    red, green, blue = (min(max(round(255 * channel), 0), 255) for channel in color)
    return f"#{red:02x}{green:02x}{blue:02x}"


def figure_of(sheet: Sheet) -> Figure:
    """Return a sheet as a figure of matplotlib, of the same size in inches."""
    from matplotlib.figure import Figure
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path
    from matplotlib.transforms import Affine2D

    width, height = sheet.size
    figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor=sheet.background)
    whole = Affine2D().scale(1 / width, -1 / height).translate(0, 1) + figure.transFigure
    for order, item in enumerate(item for every in sheet.groups.values() for item in every):
        if isinstance(item, Fill):
            path = Path.make_compound_path(*(Path(ring, closed=False) for ring in _closed(item)))
            # Between colours of a table rounding can end beyond 1.
            patch = PathPatch(path, facecolor=_hex(item.color), linewidth=0)
        elif isinstance(item, Polyline):
            cap = "round" if item.round else "butt"
            patch = PathPatch(
                Path.make_compound_path(*map(Path, item.lines)), fill=False, capstyle=cap,
                edgecolor=item.color, linewidth=item.width * 72 / DPI, joinstyle="round",
            )  # fmt: skip
        elif isinstance(item, Words):
            for line, y in item.baselines():
                figure.text(
                    item.place[0] / width, 1 - y / height, line, color=item.color, zorder=order,
                    size=item.size * 72 / DPI, va="baseline", parse_math=False,
                    ha={0.0: "left", 0.5: "center", 1.0: "right"}[item.across],
                )  # fmt: skip
            continue
        elif isinstance(item, Plate):
            raise TypeError("figures of matplotlib have no plates")
        else:
            (x, y), (wide, high) = item.place, item.size
            low = 1 - (y + high) / height
            rect = x / width, low, wide / width, high / height
            axes = figure.add_axes(rect, zorder=order)
            axes.set_axis_off()
            axes.imshow(item.pixels, aspect="auto", interpolation="none")
            continue
        patch.set_transform(whole)
        patch.set_zorder(order)
        figure.add_artist(patch)
    return figure


def _closed(item: Fill) -> list[Array]:
    rings = [np.round(STEPS * ring) / STEPS for ring in item.rings]
    return [np.concatenate([ring, ring[:1]]) for ring in rings]


def pdf_of(sheet: Sheet) -> bytes:
    """Return a sheet as the bytes of a PDF file, with its words as text."""
    from matplotlib import rc_context

    data = io.BytesIO()
    with rc_context({"pdf.fonttype": 42, "path.simplify": False, "font.family": "DejaVu Sans"}):
        figure_of(sheet).savefig(
            data, format="pdf", facecolor=sheet.background,
            metadata={"CreationDate": None, "Creator": "vizlight", "Subject": sheet.words},
        )  # fmt: skip
    return data.getvalue()
