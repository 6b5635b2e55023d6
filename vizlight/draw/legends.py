"""What explains the colours: scalar bars whose words fit, and keys in a margin of their own."""

from __future__ import annotations

import math
import re
import textwrap
from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkRenderingCore import (
    vtkActor2D,
    vtkCoordinate,
    vtkPolyDataMapper2D,
    vtkRenderer,
    vtkTextActor,
)

from vizlight.filters.key import BEYOND, NAMES, RANGE, SCALE, TITLE, WORDS
from vizlight.filters.tint import RGB
from vizlight.shading.display import NO_DATA_NAME

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    from vizlight._types import Array, Color, Keywords

#: Distance from the edges, and height of letters, as shares of the shorter side of the picture.
MARGIN, LETTERS = 0.025, 0.032
#: Share of the ink in the colour of the plate below keys, and width of a bar as a share of a disc.
PLATE, BAR_WIDE = 0.05, 0.25
#: Sum of the channels of a background above which words on it are black.
LIGHT_BACKGROUND = 1.2
#: Keywords that say how large a bar is and where it stands: with any of them it is left as asked.
PLACED = {
    "fmt", "height", "label_font_size", "n_labels", "position_x", "position_y", "title_font_size",
    "unconstrained_font_size", "width",
}  # fmt: skip
#: Width of a letter and distance of lines, in heights of letters; letters of the longest number.
LETTER, LINE, LONGEST = 0.57, 1.5, 10
#: Least height of letters, in pixels, and the height of a picture in letters.
LEAST, LETTERS_HIGH = 9, 24
#: Mark of a place where a name may break.
BREAK = "\x1f"
#: Share of the length of a bar from its end within which no number stands beside that of the end.
CLOSE = 0.06
#: Most digits of a number.
DIGITS = 7


def _wrapped(text: str, columns: int) -> list[str]:
    """Return the lines of a text, which may break within a name: after _, before a capital."""
    if max(map(len, text.split()), default=0) > columns:
        text = re.sub(r"_|(?<=[a-z])(?=[A-Z])", rf"\g<0>{BREAK} ", text)
    lines = textwrap.wrap(text, columns)
    return [line.replace(f"{BREAK} ", "").replace(BREAK, "") for line in lines]


def settle(plotter: pv.BasePlotter, bar: vtkScalarBarActor, asked: Keywords) -> None:
    """Leave room for the words of a scalar bar in the picture, and set them apart.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter, whose active renderer and theme are used.
    bar : vtkScalarBarActor
        Bar as PyVista made it; left so where ``asked`` says how large it is or where it stands.
    asked : dict
        Keywords of ``pyvista.Plotter.add_scalar_bar`` that a user gave.
    """
    wide, high = plotter.renderer.GetSize()
    if asked.keys() & PLACED or not (wide and high):
        return
    font = plotter.theme.font
    letters = int(max(min(font.label_size, high / LETTERS_HIGH), LEAST))
    number = LONGEST * LETTER * letters
    left = bar.GetPosition()[0] * wide
    right = left + bar.GetWidth() * wide
    if bar.GetOrientation():
        # The numbers stand at its right.
        left = max(min(left, wide - number - 2.5 * letters), 0)
        bar.SetVerticalTitleSeparation(letters // 2)
    else:
        right = max(min(right, wide - 0.5 * number - 4), left + 1)
    middle = (left + right) / 2
    room = 2 * min(middle, wide - middle) / (LETTER * letters)
    words = _wrapped(str(bar.GetTitle()), max(int(room), 1))
    bar.SetTitle("\n".join(words))
    bar.SetPosition(left / wide, bar.GetPosition()[1])
    bar.SetWidth((right - left) / wide)
    bar.SetUnconstrainedFontSize(True)
    for text in ("Label", "Title", "Annotation"):
        getattr(bar, f"Get{text}TextProperty")().SetFontSize(letters)
    bar.SetAnnotationLeaderPadding(2)
    if not bar.GetOrientation():
        bar.SetHeight(max(bar.GetHeight(), (len(words) + 2) * LINE * letters / high))
        # PyVista stacks bars by the height that its theme has for them.
        place, y = plotter.theme.colorbar_horizontal, bar.GetPosition()[1]
        above = (y - place.position_y) / place.height * bar.GetHeight()
        bar.SetPosition(left / wide, place.position_y + above)
        # VTK puts the title of a bar that lies so near to the numbers that they touch.
        bar.GetTitleTextProperty().SetLineOffset(-0.4 * letters)
        bar.SetBarRatio(letters / (bar.GetHeight() * high))
        bar.SetNumberOfLabels(min(bar.GetNumberOfLabels(), max(int((right - left) / number), 2)))
    if not font.fmt:
        low, top = bar.GetLookupTable().GetRange()
        ticks = np.linspace(low, top, bar.GetNumberOfLabels())
        # The fewest digits that tell the numbers of the bar apart.
        for digits in range(3, DIGITS + 1):
            if len({f"{tick:.{digits}g}" for tick in ticks}) == len(ticks):
                bar.SetLabelFormat(f"%-#6.{digits}g")
                break


def name_no_data(bar: vtkScalarBarActor) -> None:
    """Let a scalar bar name the colour of what is not data."""
    bar.SetDrawNanAnnotation(True)
    bar.SetNanAnnotation(NO_DATA_NAME)


class Margin:
    """Strip beside the data with the keys of a picture on a plate.

    It is at the right of a picture that is wider than tall, else below. The renderer of the data
    gives up that part of its viewport, so that nothing is drawn over the data.

    Parameters
    ----------
    renderer : vtkRenderer
        Renderer of the data.
    ink : (r, g, b)
        Colour of the words.
    """

    def __init__(self, renderer: vtkRenderer, ink: Color) -> None:
        self._whole = renderer.GetViewport()
        self._ink, self._keys, self._pixels = ink, list[MarginKey](), (0, 0)
        self._plate = vtkRenderer()
        ground = np.array(renderer.GetBackground())
        self._plate.SetBackground(*(ground + PLATE * (np.array(ink) - ground)))
        self._plate.InteractiveOff()
        renderer.GetRenderWindow().AddRenderer(self._plate)
        # The renderer holds the observer, and that the margin. VTK's stubs know no names of events.
        renderer.AddObserver("StartEvent", lambda caller, _: self.place(caller))  # type: ignore[arg-type]

    def add(self, mesh: pv.PolyData, size: float) -> None:
        """Add a key below the others."""
        self._keys.append(MarginKey(mesh, size, self._ink))
        for part in self._keys[-1].props:
            self._plate.AddViewProp(part)
        self._pixels = (0, 0)

    def place(self, renderer: vtkRenderer) -> None:
        """Put the keys in their places, if the size of the picture has changed."""
        left, bottom, right, top = self._whole
        wide, high = renderer.GetRenderWindow().GetSize()
        width, height = int(wide * (right - left)), int(high * (top - bottom))
        if (width, height) == self._pixels or not width or not height:
            return
        self._pixels = (width, height)
        size = max(key.size for key in self._keys)
        share_x, share_y = data_share((width, height), size)
        split = left + share_x * (right - left), top - share_y * (top - bottom)
        renderer.SetViewport(left, split[1], split[0], top)
        plate = (split[0], bottom, right, top) if share_x < 1 else (left, bottom, right, split[1])
        self._plate.SetViewport(*plate)
        room = width * (1 - share_x) or width, height * (1 - share_y) or height
        self._lay_out(room, min(width, height), beside=share_x < 1)

    def _lay_out(self, room: tuple[float, float], short: int, *, beside: bool) -> None:
        """Stack the keys in the middle of a strip, smaller where they would not fit."""
        axis = 1 if beside else 0
        scale = 1.0
        for _ in range(4):
            letters, gap = LETTERS * short * scale, MARGIN * short * scale
            boxes = [key.fit(short * scale, letters, room[0] - 2 * gap) for key in self._keys]
            total = sum(box[axis] for box in boxes) + gap * (len(boxes) + 1)
            if total <= room[axis]:
                break
            scale *= 0.98 * room[axis] / total
        place = (room[axis] - total) / 2 + gap
        for key, box in zip(self._keys, boxes, strict=True):
            if beside:
                key.draw((room[0] / 2, room[1] - place - box[1] / 2), box, letters)
            else:
                key.draw((place + box[0] / 2, room[1] / 2), box, letters)
            place += box[axis] + gap


class MarginKey:
    """A key and its words, drawn in pixels.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Key, as :func:`vizlight.presets.key` returns it.
    size : float
        Width of a disc, as a share of the shorter side of the picture.
    ink : (r, g, b)
        Colour of the words.
    """

    def __init__(self, mesh: pv.PolyData, size: float, ink: Color) -> None:
        self.size = size
        self._mesh = mesh.copy()
        self._flat = np.asarray(mesh.points, dtype=np.float64)
        words = [str(word) for word in mesh.field_data[WORDS]]
        #: Words along a bar that stands: numbers or names, and their shares of its height.
        self._marks, self._title = _marks(mesh, words)
        if self._marks:
            # A bar stands: its length runs upward.
            self._flat = self._flat[:, [1, 0, 2]] * (1, 1, 1)
        self._lines: list[str] = []
        mapper, in_pixels = vtkPolyDataMapper2D(), vtkCoordinate()
        in_pixels.SetCoordinateSystemToViewport()
        mapper.SetInputData(self._mesh)
        mapper.SetTransformCoordinate(in_pixels)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.ColorByArrayComponent(RGB, 0)
        mapper.SetColorModeToDirectScalars()
        picture = vtkActor2D()
        picture.SetMapper(mapper)
        self._heading = _text("", ink)
        self._labels = [_text(word, ink) for _, word in self._marks]
        for label in self._labels:
            style = label.GetTextProperty()
            style.SetJustificationToLeft()
            style.SetVerticalJustificationToCentered()
        self.props = [picture, self._heading, *self._labels]

    def fit(self, short: float, letters: float, width: float) -> tuple[float, float]:
        """Return the width and height in pixels that the key takes at a size of letters."""
        self._half = self.size * short / 2
        columns = max(int(width / (LETTER * letters)), 6)
        longest = max(map(len, self._title.replace("_", " ").split()), default=0)
        # Most words are narrower than their number of wide letters: one is not broken for a few.
        columns = max(columns, min(longest, int(1.2 * columns)))
        parts = [_wrapped(part, columns) for part in self._title.splitlines()]
        self._lines = [line for part in parts for line in part]
        below = LINE * letters * len(self._lines) + (0.5 * letters if self._lines else 0)
        if not self._marks:
            return min(2 * self._half, width), 2 * self._half + below
        widest = max(len(word) for _, word in self._marks)
        tall = max(4.0 * self._half, 1.3 * LINE * letters * len(self._marks))
        bar = 2 * BAR_WIDE * self._half
        return bar + (0.6 + LETTER * widest) * letters, tall + letters + below

    def draw(self, middle: tuple[float, float], box: tuple[float, float], letters: float) -> None:
        """Place the key about the middle of its box."""
        x, y = middle
        size = max(round(letters), 8)
        for text in (self._heading, *self._labels):
            text.GetTextProperty().SetFontSize(size)
        self._heading.SetInput("\n".join(self._lines))
        words = LINE * letters * len(self._lines)
        if self._marks:
            tall = box[1] - letters - words - (0.5 * letters if self._lines else 0)
            # The title stands above a bar, whose numbers stand at its right.
            low, left = y - box[1] / 2 + letters / 2, x - box[0] / 2
            bar = 2 * BAR_WIDE * self._half
            flat = self._flat * (bar / np.ptp(self._flat[:, 0]), tall / 2, 0)
            self._move(flat + np.array([left + bar / 2, low + tall / 2, 0]))
            for label, (share, _) in zip(self._labels, self._marks, strict=True):
                label.SetPosition(left + bar + 0.4 * letters, low + share * tall)
            self._heading.SetPosition(x, y + box[1] / 2 - words)
            return
        self._heading.SetPosition(x, y - box[1] / 2)
        top = y + box[1] / 2
        self._move(self._flat * self._half + np.array([x, top - self._half, 0]))

    def _move(self, places: Array) -> None:
        moved = vtkPoints()
        for point in places:
            moved.InsertNextPoint(*point)
        self._mesh.SetPoints(moved)


def data_share(size: tuple[int, int], key: float) -> tuple[float, float]:
    """Return the shares of the width and of the height of a picture that the margin leaves.

    Parameters
    ----------
    size : (int, int)
        Width and height in pixels.
    key : float
        Width of a key, as a share of the shorter side.
    """
    width, height = size
    strip = (key + 2 * MARGIN) * min(width, height)
    # Numbers of a bar need as much room as the key.
    strip = min(1.15 * strip, 0.5 * max(width, height))
    return (1 - strip / width, 1.0) if width >= height else (1.0, 1 - 1.7 * strip / height)


def _marks(mesh: pv.PolyData, words: list[str]) -> tuple[list[tuple[float, str]], str]:
    """Return the words along a bar with their shares of its height, and the title of a key."""
    title = str(mesh.field_data[TITLE][0]) if TITLE in mesh.field_data else ""
    if len(words) == 1:
        return [], f"{title}\n{words[0]}" if title else words[0]
    if NAMES in mesh.field_data:
        names = [str(name) for name in mesh.field_data[NAMES]]
        return [((i + 0.5) / len(names), name) for i, name in enumerate(names)], title
    if RANGE not in mesh.field_data:
        return [(0.0, words[0]), (1.0, words[-1])], title
    low, high = (float(value) for value in mesh.field_data[RANGE])
    ticks = even_numbers(low, high)
    spread = (high - low) or 1.0
    marks = [((tick - low) / spread, word) for tick, word in ticks]
    if SCALE in mesh.field_data and mesh.field_data[SCALE][0]:
        marks = _of_logarithm(low, high)
    if BEYOND in mesh.field_data:
        below, above = mesh.field_data[BEYOND]
        marks = _with_beyond(marks, f"< {low:g}" * bool(below), f"> {high:g}" * bool(above))
    return marks, title


def _of_logarithm(low: float, high: float) -> list[tuple[float, str]]:
    """Return the words along a logarithmic bar: one, two or three in each decade."""
    first, last = math.floor(math.log10(low)), math.floor(math.log10(high))
    digits = (1, 2, 5) if high < 30 * low else (1, 3) if high < 1000 * low else (1,)
    ticks = [d * 10.0**power for power in range(first, last + 1) for d in digits]
    spread = math.log(high / low)
    shares = [(math.log(tick / low) / spread, f"{tick:.6g}") for tick in ticks]
    return [(share, word) for share, word in shares if -1e-9 <= share <= 1 + 1e-9]


def _with_beyond(marks: list[tuple[float, str]], below: str, above: str) -> list[tuple[float, str]]:
    """Return the words along a bar with those at ends beyond which there are values."""
    ends = [(share, word) for share, word in ((0.0, below), (1.0, above)) if word]
    near = [
        (share, word) for share, word in marks if all(abs(share - end) > CLOSE for end, _ in ends)
    ]
    return sorted(near + ends)


def even_numbers(low: float, high: float, most: int = 5) -> list[tuple[float, str]]:
    """Return at most some round numbers within a range, and their digits.

    Parameters
    ----------
    low, high : float
        Ends of the range.
    most : int, default: 5
        Largest number of numbers.
    """
    if not low < high:
        return [(low, f"{low:.4g}")]
    rough = (high - low) / max(most - 1, 1)
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(s * power for s in (1, 2, 2.5, 5, 10, 20) if _count(low, high, s * power) <= most)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    # A whole multiple of the step: zero is 0 and not a rest of rounding.
    values = [i * step for i in range(first, last + 1)]
    size = max(abs(low), abs(high))
    places = max(-math.floor(math.log10(step) + 1e-9), 0) + (step / power == 2.5)
    if size >= 1e6 or size < 1e-3:
        return [(value, _power(value)) for value in values]
    return [(value, f"{value:.{places}f}") for value in values]


def _count(low: float, high: float, step: float) -> int:
    return math.floor(high / step + 1e-9) - math.ceil(low / step - 1e-9) + 1


def _power(value: float) -> str:
    """Return a large or small number in few digits: 2e5, 0."""
    if value == 0:
        return "0"
    digits, power = f"{value:.3e}".split("e")
    return f"{float(digits):g}e{int(power)}"


def ink_on(background: pv.Color) -> Color:
    """Return the colour of words on a background: black or white."""
    return (0.0, 0.0, 0.0) if sum(background.float_rgb) > LIGHT_BACKGROUND else (1.0, 1.0, 1.0)


def _text(word: str, ink: Color) -> vtkTextActor:
    made = vtkTextActor()
    made.SetInput(word)
    style = made.GetTextProperty()
    style.SetColor(*ink)
    style.SetFontFamilyToArial()
    style.SetJustificationToCentered()
    style.SetVerticalJustificationToBottom()
    return made
