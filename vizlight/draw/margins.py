"""The margin of a picture: the title above the data, and keys beside or below them."""

from __future__ import annotations

import itertools
import math
import re
import textwrap
from typing import NamedTuple

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import (
    vtkActor2D,
    vtkCoordinate,
    vtkPolyDataMapper2D,
    vtkRenderer,
    vtkTextActor,
    vtkTextRenderer,
)

from vizlight._types import Array, Color
from vizlight.draw.live import in_view, items
from vizlight.draw.scalar_bars import LEAST, LETTER, LINE, wrapped
from vizlight.draw.ticks import along_bar, numerals_of
from vizlight.filters.key import BEYOND, LEVELS, NAMES, RANGE, SCALE, SWATCH, TITLE, WORDS
from vizlight.filters.tint import RGB
from vizlight.vtk.cells import new_points

#: Distance from the edges, and height of letters, as shares of the shorter side of the picture.
MARGIN, LETTERS = 0.025, 0.032
#: Width of a bar as a share of a disc, least height of a single one as a share of its strip, and
#: most numbers for which a bar is made longer.
BAR_WIDE, LEAST_BAR, MOST_NUMBERS = 0.25, 0.4, 5
#: Height of the colour of a kind in a bar that stands, in letters.
KIND = 2.2
#: Most letters in a line of the name of a kind.
COLUMNS = 16
#: Height of a bar that lies, in letters, and length of one without classes, in that of the data.
BAR_HIGH, SHORT_BAR = 0.8, 0.65
#: Letters of the title in those of keys, the least share of them in which a long title is set, and
#: height of its band in letters of keys.
TITLE_SIZE, SMALLEST_TITLE, BAND = 1.1, 0.75, 2.0
#: Width of a whole title that is not broken, in that of its place by letters of usual width.
SHORT = 1.3
#: Least distance of numbers along a bar, in letters.
APART = 1.5
#: Sum of the channels of a background above which words on it are black.
LIGHT_BACKGROUND = 1.2
#: Titles of lengths of vectors, of which the first word stands above a bar, and letters of the
#: longest name that does.
LENGTHS, LONGEST = re.compile("(Speed|Length) of "), 12
#: Name in capitals.
CAPITALS = re.compile("[A-Z][A-Z0-9]*(_[A-Z0-9]+)+")
#: Resolution in which VTK draws letters.
_DPI = 72
#: Share of the length of a bar from its end within which no number stands beside that of the end.
CLOSE = 0.08


class MarginBar(NamedTuple):
    """A bar: its heading, and its colours and words, each with its share of the length."""

    heading: str
    colors: list[tuple[float, list[int]]]
    marks: list[tuple[float, str]]


class Margin:
    """Title above the data, and keys in a strip beside them, on the ground of the picture.

    The strip is at the right of a picture that is wider than tall, else below; a bar that lies is
    below. The renderer of the data gives up these parts of its viewport, so that nothing is drawn
    over the data. The colour of the words is ``ink``.
    """

    def __init__(self, renderer: vtkRenderer, ink: Color) -> None:
        self._whole = renderer.GetViewport()
        self._ink, self._keys, self._pixels = ink, list[MarginKey](), (0, 0)
        self._strip, self._band = vtkRenderer(), vtkRenderer()
        for part in (self._strip, self._band):
            part.SetBackground(*renderer.GetBackground())
            part.InteractiveOff()
            renderer.GetRenderWindow().AddRenderer(part)
        #: The title is in its band, or below it where the data leave room there.
        self._titles = [_text("", ink), _text("", ink)]
        for part, title in zip((self._band, renderer), self._titles, strict=True):
            title.GetTextProperty().SetJustificationToLeft()
            part.AddViewProp(title)
        # The renderer holds the observer, and that the margin. VTK's stubs know no names of events.
        renderer.AddObserver("StartEvent", lambda caller, _: self.place(caller))  # type: ignore[arg-type]

    def add(self, mesh: pv.PolyData, size: float, *, lying: bool) -> None:
        """Add a key below the others; a bar lies below the data as long as it is the only key."""
        self._keys.append(MarginKey(mesh, size, self._ink, lying=lying))
        for key in self._keys:
            key.lies = lying and len(self._keys) == 1 and bool(key.size)
        for part in self._keys[-1].props:
            self._strip.AddViewProp(part)
        self._pixels = (0, 0)

    @property
    def title(self) -> str:
        """Title above the data."""
        return "; ".join(dict.fromkeys(key.title for key in self._keys if key.title))

    @property
    def bars(self) -> list[MarginBar]:
        """Bars of the keys, from left to right."""
        return [key.bar(alone=self._has_one_title) for key in self._keys if key.is_bar and key.size]

    @property
    def _has_one_title(self) -> bool:
        # Kinds without a title, such as elements, are none that another could be taken for.
        return sum(bool(key.title) or not key.has_kinds for key in self._keys) == 1

    def place(self, renderer: vtkRenderer) -> None:
        """Put the title in its place, and the keys, if the size of the picture has changed."""
        left, bottom, right, top = self._whole
        wide, high = renderer.GetRenderWindow().GetSize()
        width, height = int(wide * (right - left)), int(high * (top - bottom))
        if not width or not height:
            return
        title = self.title
        if (width, height) != self._pixels:
            self._pixels = (width, height)
            share_x, share_y = data_share(
                (width, height), max(key.size for key in self._keys), titled=bool(title),
                lying=self._keys[0].lies,
            )  # fmt: skip
            head = top - bool(title) * band_share((width, height)) * (top - bottom)
            split = left + share_x * (right - left), head - share_y * (top - bottom)
            # A view without data is that of its keys.
            alone, short = renderer.GetActors().GetNumberOfItems() == 0, min(width, height)
            if alone:
                split, short = (left, bottom), min(wide, high)
            else:
                renderer.SetViewport(left, split[1], split[0], head)
            beside = share_x < 1 or alone
            strip = (split[0], bottom, right, head) if beside else (left, bottom, right, split[1])
            self._strip.SetViewport(*strip)
            self._strip.SetDraw(strip[3] > strip[1])
            self._band.SetViewport(left, head, right, top)
            self._band.SetDraw(bool(title))
            room = (strip[2] - strip[0]) * wide, (strip[3] - strip[1]) * high
            if self._keys[0].lies:
                self._split = split[1]
            elif beside and not alone and len(self._keys) == 1 and self._keys[0].is_bar:
                self._beside(room, short, _box_of(renderer, data=True)[[1, 3]])
            elif self._strip.GetDraw():
                self._stack(room, short, beside=beside)
        self._entitle(renderer, title, (width, height))
        _, bottom, end, upper = self._strip.GetViewport()
        if _is_map(renderer) and upper > bottom and end > renderer.GetViewport()[2]:
            # Keys stand right beside a map, however narrow that is.
            columns = _box_of(renderer, data=False)[2] + 2 * MARGIN * min(width, height)
            x = min(renderer.GetViewport()[2], left + columns / wide)
            self._strip.SetViewport(x, bottom, end, upper)
        if self._keys[0].lies:
            self._below(renderer, min(width, height))

    def _below(self, renderer: vtkRenderer, short: int) -> None:
        """Put a bar below the data, right below a map."""
        left, low, right, _ = _box_of(renderer, data=False)
        wide, high = renderer.GetRenderWindow().GetSize()
        gap = MARGIN * short
        away = gap if self._keys[0].has_classes else 2 * gap
        upper = self._split + max(low - away, 0.0) / high if _is_map(renderer) else self._split
        x, bottom, end, _ = self._strip.GetViewport()
        self._strip.SetViewport(x, bottom, end, upper)
        if _is_map(renderer):
            left, _, right, _ = _box_of(renderer, data=True)
        # Numbers stand below the ends, half of each beyond.
        beyond = gap + self._keys[0].widest(LETTERS * short) / 2
        left, right = max(left, beyond), min(right, (end - x) * wide - beyond)
        if not self._keys[0].has_classes:
            # A bar without steps is read as well where it is shorter.
            left, right = (
                (left + right) / 2 + sign * SHORT_BAR / 2 * (right - left) for sign in (-1, 1)
            )
        if right - left < LEAST_BAR * (end - x) * wide:
            left, right = 0.2 * (end - x) * wide, 0.8 * (end - x) * wide
        self._keys[0].lay((left, right), (upper - bottom) * high, LETTERS * short)

    def _entitle(self, renderer: vtkRenderer, title: str, size: tuple[int, int]) -> None:
        """Put the title into its band, or nearer to a map that leaves room below the band."""
        short = min(size)
        letters, gap = TITLE_SIZE * LETTERS * short, 2 * MARGIN * short
        upper = float(renderer.GetSize()[1])
        if _is_map(renderer):
            # Above the corner of a map.
            left, upper = _box_of(renderer, data=False)[[0, 3]]
            gap = max(float(_box_of(renderer, data=True)[0]), left, MARGIN * short)
        has_room = LETTER * letters * len(title) < renderer.GetSize()[0] - gap
        lowered = has_room and bool(renderer.GetSize()[1] - upper > 1.9 * letters)
        room = (size[0] - gap - MARGIN * short) / (LETTER * letters)
        scale = max(min(room / max(len(title), 1), 1.0), SMALLEST_TITLE)
        lines = textwrap.wrap(title, max(int(room / scale), 1))
        # Lines of a title in two are low enough for its band.
        scale = min(scale, (BAND / TITLE_SIZE - 0.1) / (1.2 * max(len(lines), 1)))
        places = ((0.4 if len(lines) < 2 else 0.1) * letters, upper + 0.7 * letters)
        for text, y, shown in zip(self._titles, places, (not lowered, lowered), strict=True):
            text.GetTextProperty().SetFontSize(max(round(letters * scale), LEAST))
            # Empty and not hidden: who draws the picture without its words hides them himself.
            text.SetInput("\n".join(lines) if shown else "")
            text.SetPosition(gap, y)

    def _beside(self, room: tuple[float, float], short: int, rows: Array) -> None:
        """Put a single bar beside the data, between their rows as far as room allows."""
        (key,) = self._keys
        letters, gap = LETTERS * short, MARGIN * short
        wide = key.fit(short, letters, room[0] - gap, 0.0, True)[0]
        letters *= min((room[0] - gap) / wide, 1.0)
        low, top = np.clip(rows, gap, room[1] - gap)
        least = LEAST_BAR * room[1]
        if top - low < least:
            low, top = np.mean(rows) - least / 2, np.mean(rows) + least / 2
        box = key.fit(short, letters, room[0] - gap, top - low, True)
        # What stands above the bar has to have room too.
        over = max(low - letters / 2 + box[1] - room[1], 0.0)
        high = box[1] - over
        # Kinds stand in the middle, and bars begin where the data do.
        row = (low + top) / 2 if key.has_kinds else low - letters / 2 + high / 2
        key.draw((box[0] / 2, row), (box[0], high), letters)

    def _stack(self, room: tuple[float, float], short: int, *, beside: bool) -> None:
        """Stack the keys in the middle of a strip, smaller where they would not fit."""
        axis = 1 if beside else 0
        alone, scale = self._has_one_title, 1.0
        for _ in range(4):
            letters, gap = LETTERS * short * scale, MARGIN * short * scale
            wide = room[0] - 2 * gap
            boxes = [key.fit(short * scale, letters, wide, 0.0, alone) for key in self._keys]
            total = sum(box[axis] for box in boxes) + gap * (len(boxes) + 1)
            across = max(box[1 - axis] for box in boxes)
            over = max(total / room[axis], across / (room[1 - axis] - 2 * gap))
            if over <= 1:
                break
            scale *= 0.98 / over
        place = (room[axis] - total) / 2 + gap
        for key, box in zip(self._keys, boxes, strict=True):
            if beside:
                key.draw((room[0] / 2, room[1] - place - box[1] / 2), box, letters)
            else:
                key.draw((place + box[0] / 2, room[1] / 2), box, letters)
            place += box[axis] + gap


def _is_map(renderer: vtkRenderer) -> bool:
    """Return whether the projection is parallel, as that of maps."""
    return bool(renderer.GetActiveCamera().GetParallelProjection())


def _box_of(renderer: vtkRenderer, *, data: bool) -> Array:
    """Return left, low, right and top in pixels of a drawing, or of its data: what is picked."""
    wide, high = renderer.GetSize()
    corners: list[tuple[float, ...]] = []
    for actor in items(renderer.GetActors()):
        if actor.GetVisibility() and (actor.GetPickable() or not data):
            bounds = np.reshape(actor.GetBounds() or (1, -1) * 3, (3, 2))
            if np.all(bounds[:, 0] <= bounds[:, 1]):
                corners += itertools.product(*bounds)
    if not corners:
        return np.array([0.0, 0.0, wide, high])
    camera, aspect = renderer.GetActiveCamera(), renderer.GetTiledAspectRatio()
    places = (in_view(camera, aspect, np.array(corners))[0][:, :2] + 1) / 2 * (wide, high)
    box: Array = np.clip([*places.min(axis=0), *places.max(axis=0)], 0, [wide, high, wide, high])
    return box


class MarginKey:
    """A key and its words, drawn in pixels.

    The mesh is that of :func:`vizlight.presets.key`, ``size`` the width of a disc, as a share of
    the shorter side of the picture, ``ink`` the colour of the words. A bar that is ``lying`` does
    so as long as it is the only key.
    """

    def __init__(self, mesh: pv.PolyData, size: float, ink: Color, *, lying: bool) -> None:
        self.lies = lying
        self._mesh, self._fading = _with_soft_rims(mesh)
        self._flat = np.array(self._mesh.points, dtype=np.float64)
        # A swatch before a bar is a part of its length.
        start = min(float(self._flat[:, 0].min()), -1.0)
        #: What stands above the data, and above the key: its unit, or all where there are several.
        self._title, self._unit = parted(_first(mesh, TITLE))
        self._whole = written(_first(mesh, TITLE))
        words = [str(word) for word in mesh.field_data[WORDS]]
        #: Words along a bar that stands: numbers or names, and their shares of its height.
        self._marks = [(1 - 2 * (1 - s) / (1 - start), word) for s, word in _marks(mesh, words)]
        ends = mesh.field_data.get(RANGE)
        low, high = (0.0, 1.0) if ends is None else (float(end) for end in ends)
        self._zero = 1 - 2 * (1 + low / ((high - low) or 1.0)) / (1 - start)
        self._flat[:, 0] = 1 - 2 * (1 - self._flat[:, 0]) / (1 - start)
        #: Words of a disc, which stand below it.
        self._below = "" if self._marks else words[0]
        self._lines: list[str] = []
        self._room = 0.0
        mapper, in_pixels = vtkPolyDataMapper2D(), vtkCoordinate()
        in_pixels.SetCoordinateSystemToViewport()
        mapper.SetInputData(self._mesh)
        mapper.SetTransformCoordinate(in_pixels)
        mapper.SetTransformCoordinateUseDouble(True)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.ColorByArrayComponent(RGB, 0)
        mapper.SetColorModeToDirectScalars()
        picture = vtkActor2D()
        picture.SetMapper(mapper)
        #: Kinds without names have no more than a title.
        self._is_title = bool(self._marks) and not any(word.strip() for _, word in self._marks)
        picture.SetVisibility(not self._is_title)
        #: Width of a disc, as a share of the shorter side of the picture.
        self.size = 0.0 if self._is_title else size
        self._heading = _text("", ink)
        self._heading.GetTextProperty().SetLineSpacing(1.3)
        self._labels = [_text(word, ink) for _, word in self._marks]
        self.props = [picture, self._heading, *self._labels]

    @property
    def title(self) -> str:
        """Title above the data, with the unit where that has no place above the key."""
        return self._whole if self.lies else self._title

    @property
    def has_classes(self) -> bool:
        """Whether its colours are classes."""
        return LEVELS in self._mesh.field_data or self.has_kinds

    @property
    def has_kinds(self) -> bool:
        """Whether its colours are those of kinds, which have no order."""
        return NAMES in self._mesh.field_data

    @property
    def is_bar(self) -> bool:
        """Whether it is a bar with words along it, and no disc."""
        return bool(self._marks)

    def fit(
        self, short: float, letters: float, width: float, tall: float, alone: bool
    ) -> tuple[float, float]:
        """Return the width and height in pixels that the key takes at a size of letters.

        ``short`` is the shorter side of the picture, ``width`` the available one, ``tall`` the
        height of a bar, 0 for that of its own; with ``alone`` the title right above the data is
        that of the key.
        """
        self._half, self._room = self.size * short / 2, width
        if self._is_title:
            return 1.0, 1.0
        columns = max(int(width / (LETTER * letters)), 6)
        head = "\n".join(filter(None, [self._head(alone=alone), self._below]))
        longest = max(map(len, head.split()), default=0)
        # Most words are narrower than their number of wide letters: one is not broken for a few.
        columns = max(columns, min(longest, 2 * columns))
        columns = len(head) if len(head) <= SHORT * columns else columns
        # Fewer lines of a little more letters, rather than a line of a short word.
        tries = [
            [line for part in head.splitlines() for line in wrapped(part, most)]
            for most in range(columns, int(1.2 * columns) + 1)
        ]
        self._lines = min(tries, key=len)
        words = LINE * letters * len(self._lines) + (0.5 * letters if self._lines else 0)
        if not self._marks:
            return min(2 * self._half, width), 2 * self._half + words
        rows = max(word.count("\n") + 1 for word in self._written)
        count = rows * len(self._marks) if rows > 1 else min(len(self._marks), MOST_NUMBERS)
        least = 1.3 * LINE * letters * count
        bar = 2 * BAR_WIDE * self._half
        box = bar + 0.6 * letters + self.widest(letters)
        high = tall or max(4.0 * self._half, least)
        if self.has_kinds:
            high = min(high, KIND * letters * len(self._marks) * rows)
        return box, high + letters + words

    def _head(self, *, alone: bool) -> str:
        """Return the words above a bar or a disc: its unit, or its name too."""
        name, _, more = self._title.partition(";")
        if kind := LENGTHS.match(name):
            name = kind[1]
        # A title of one part stands above the data, and is not said twice.
        is_said = alone and (not more or not self.is_bar or len(name) > LONGEST)
        head = self._unit if is_said else f"{name} ({self._unit})" * bool(name)
        return head.replace(" ()", "")

    def bar(self, *, alone: bool) -> MarginBar:
        """Return the bar from left to right, in full light; see :meth:`fit`."""
        top = np.flatnonzero(self._flat[:, 1] >= self._flat[:, 1].max() - 1e-9)
        # At a step two points are at the same place, and the first of them belongs before it.
        places = (self._flat[top, 0] + 1) / 2
        order = np.argsort(places, kind="stable")
        colors = np.asarray(self._mesh[RGB])[top][order].tolist()
        shown = _thinned([share for share, _ in self._marks], self._zero, MOST_NUMBERS)
        marks = self._marks
        if not self.has_kinds:
            marks = [mark for mark, visible in zip(marks, shown, strict=True) if visible]
        return MarginBar(
            self._head(alone=alone), list(zip(places[order].tolist(), colors, strict=True)), marks
        )  # fmt: skip

    def draw(self, middle: tuple[float, float], box: tuple[float, float], letters: float) -> None:
        """Place the key about the middle of its box."""
        if self._is_title:
            return
        x, y = middle
        size = max(round(letters), 8)
        for text in (self._heading, *self._labels):
            text.GetTextProperty().SetFontSize(size)
        self._heading.SetInput("\n".join(self._lines))
        _narrow(self._heading, self._room)
        words = LINE * letters * len(self._lines)
        if not self._marks:
            self._heading.SetPosition(x, y - box[1] / 2)
            top = y + box[1] / 2
            disc = self._flat * self._half + self._fading
            self._move(disc + np.array([x, top - self._half, 0]))
            return
        tall = box[1] - letters - words - (0.5 * letters if self._lines else 0)
        # The title stands above a bar, whose numbers stand at its right.
        low, left = y - box[1] / 2 + letters / 2, x - box[0] / 2
        bar = 2 * BAR_WIDE * self._half
        # A bar stands: its length runs upward.
        flat = self._flat[:, [1, 0, 2]] * (bar / np.ptp(self._flat[:, 1]), tall / 2, 0)
        self._move(flat + np.array([left + bar / 2, low + tall / 2, 0]))
        most = tall / (APART * letters) + 1
        self._write(most)
        for label, (share, _) in zip(self._labels, self._marks, strict=True):
            label.GetTextProperty().SetJustificationToLeft()
            label.GetTextProperty().SetVerticalJustificationToCentered()
            label.SetPosition(left + bar + 0.4 * letters, low + share * tall)
        self._heading.GetTextProperty().SetJustificationToLeft()
        self._heading.SetPosition(left, y + box[1] / 2 - words)

    def widest(self, letters: float) -> float:
        """Return the width of the longest number beside a bar, with letters of a height."""
        return LETTER * letters * max(len(line) for line in "\n".join(self._written).split("\n"))

    @property
    def _written(self) -> list[str]:
        """Words along a bar; long names of kinds are in two lines, of which the second may end."""
        words = [word for _, word in self._marks]
        if not self.has_kinds:
            return words
        lines = [textwrap.wrap(word, COLUMNS, max_lines=2, placeholder="…") for word in words]
        return ["\n".join(each) or word for each, word in zip(lines, words, strict=True)]

    def lay(self, columns: tuple[float, float], upper: float, letters: float) -> None:
        """Lay a bar between two columns, its numbers below it.

        ``upper`` is the row of its upper side.
        """
        (left, right), high = columns, BAR_HIGH * letters
        self._heading.SetInput("")
        flat = self._flat * ((right - left) / 2, high / np.ptp(self._flat[:, 1]), 0)
        self._move(flat + np.array([(left + right) / 2, upper - high / 2, 0]))
        most = (right - left) / (self.widest(letters) + letters) + 1
        self._write(most)
        for label, (share, _) in zip(self._labels, self._marks, strict=True):
            label.GetTextProperty().SetFontSize(max(round(letters), 8))
            label.GetTextProperty().SetJustificationToCentered()
            label.GetTextProperty().SetVerticalJustificationToTop()
            label.SetPosition(left + share * (right - left), upper - high - 0.3 * letters)

    def _write(self, most: float) -> None:
        """Write those words along a bar that fit, without a decimal that is 0 in all of them."""
        shown = _thinned([share for share, _ in self._marks], self._zero, most)
        words = [word for word, visible in zip(self._written, shown, strict=True) if visible]
        end = ".0" if all(word.endswith(".0") for word in words) else ""
        for label, word, visible in zip(self._labels, self._written, shown, strict=True):
            label.SetInput(word.removesuffix(end) if visible else "")

    def _move(self, places: Array) -> None:
        self._mesh.SetPoints(new_points(places.astype(np.float32)))


def _with_soft_rims(key: pv.PolyData) -> tuple[pv.PolyData, Array]:
    """Return a key whose round rims end in rings that fade, and vectors across these of length 1.

    The rings are as wide as a pixel: a window that supersamples its data does not smooth rims.
    """
    places, colors = np.asarray(key.points, dtype=np.float64), np.asarray(key[RGB])
    radius = np.hypot(*places.T[:2])
    rims = [] if WORDS not in key.field_data or len(key.field_data[WORDS]) > 1 else [1.0, -1.0]
    faces, count = [key.faces], len(places)
    index, across = np.arange(count), [0 * places]
    for side in rims:
        ring = np.flatnonzero(np.isclose(radius, (side * radius).max() * side, atol=1e-6))
        if radius[ring[0]] < 1e-6:
            continue
        beyond = len(index) + np.arange(len(ring))
        quads = [ring, np.roll(ring, -1), np.roll(beyond, -1), beyond]
        faces.append(np.column_stack([np.full(len(ring), 4), *quads]).ravel())
        index = np.append(index, ring)
        across.append(side * places[ring] / radius[ring, np.newaxis])
    soft = pv.PolyData(places[index], np.concatenate(faces))
    soft[RGB] = np.column_stack([colors[index], np.where(np.arange(len(index)) < count, 255, 0)])
    soft[RGB] = soft[RGB].astype(np.uint8)
    soft.GetFieldData().ShallowCopy(key.GetFieldData())
    return soft, np.concatenate(across)


def band_share(size: tuple[int, int]) -> float:
    """Return the share of the height of a picture that its title takes."""
    return BAND * LETTERS * min(size) / size[1]


def data_share(
    size: tuple[int, int], key: float, *, titled: bool = True, lying: bool = False
) -> tuple[float, float]:
    """Return the shares of the width and of the height of a picture that the margin leaves.

    ``size`` is in pixels, and ``key`` is the width of a key, as a share of the shorter side, 0 for
    none; with ``titled`` a title stands above the data, with ``lying`` a single bar below them.
    """
    width, height = size
    tall = 1 - titled * band_share(size)
    if lying and key:
        return 1.0, tall - (BAR_HIGH + 1.5) * LETTERS * min(size) / height
    if not key:
        return 1.0, tall
    strip = (key + 2 * MARGIN) * min(width, height)
    # Numbers of a bar need as much room as the key.
    strip = min(0.95 * strip, 0.5 * max(width, height))
    return (1 - strip / width, tall) if width >= height else (1.0, tall - 1.7 * strip / height)


def written(name: str) -> str:
    """Return a name in words: without underscores, and with a capital where it is a word."""
    # Capitals within a name begin words, such as those of velocityField.
    apart = re.sub(r"(?<=[a-z]{2})(?=[A-Z][a-z]{2})", " ", name)
    # Names of files and data in capitals, such as CT_AVM, are as they are.
    words = " ".join(
        word if CAPITALS.fullmatch(word) else word.replace("_", " ").strip()
        for word in apart.split()
    )
    words = re.sub(r"\bvon mises\b", "von Mises", words)
    # Symbols such as dT or u,v are no words.
    is_word = re.match(r"[a-z]{3,}(?=[ ;,.]|$)", words)
    return words[:1].upper() + words[1:] if is_word else words


def parted(title: str) -> tuple[str, str]:
    """Return a title in words without its unit, and the unit, which is in parentheses.

    A title is such as "air_pressure (hPa); lines every 4 hPa".
    """
    match = re.fullmatch(r"(.*?)(?: \(([^()]*)\))?((?:; .*)?)", title, re.DOTALL)
    assert match is not None
    return written(match[1] + match[3]), match[2] or ""


def _first(mesh: pv.PolyData, name: str) -> str:
    return str(mesh.field_data[name][0]) if name in mesh.field_data else ""


def _marks(mesh: pv.PolyData, words: list[str]) -> list[tuple[float, str]]:
    """Return the words along a bar with their shares of its height; none of a disc."""
    if len(words) == 1:
        return []
    if NAMES in mesh.field_data:
        names = [str(name) for name in mesh.field_data[NAMES]]
        return [((i + 0.5) / len(names), written(name)) for i, name in enumerate(names)]
    if RANGE not in mesh.field_data:
        return [(0.0, words[0]), (1.0, words[-1])]
    low, high = (float(value) for value in mesh.field_data[RANGE])
    ticks = along_bar(low, high)
    if LEVELS in mesh.field_data:
        levels = [float(level) for level in mesh.field_data[LEVELS]]
        ticks = list(zip(levels, numerals_of(levels), strict=True))
    spread = (high - low) or 1.0
    marks = [((tick - low) / spread, word) for tick, word in ticks]
    if SCALE in mesh.field_data and mesh.field_data[SCALE][0]:
        marks = _of_logarithm(low, high, mesh.field_data.get(LEVELS))
    if BEYOND in mesh.field_data:
        below, above = mesh.field_data[BEYOND]
        # The end of a bar, or the middle of the swatch before it.
        start = (min(mesh.points[:, 0].min() + SWATCH / 2, -1.0) + 1) / 2
        marks = _with_beyond(
            marks, (start, f"< {low:g}" * bool(below)), (1.0, f"> {high:g}" * bool(above))
        )
    return marks


def _of_logarithm(low: float, high: float, levels: Array | None) -> list[tuple[float, str]]:
    """Return the words along a logarithmic bar: levels, or one, two or three in each decade."""
    first, last = math.floor(math.log10(low)), math.floor(math.log10(high))
    digits = (1, 2, 5) if high < 30 * low else (1, 3) if high < 1000 * low else (1,)
    ticks = [d * 10.0**power for power in range(first, last + 1) for d in digits]
    ticks = ticks if levels is None else [float(level) for level in levels]
    spread = math.log(high / low)
    shares = [(math.log(tick / low) / spread, f"{tick:.6g}") for tick in ticks]
    return [(share, word) for share, word in shares if -1e-9 <= share <= 1 + 1e-9]


def _with_beyond(
    marks: list[tuple[float, str]], *ends: tuple[float, str]
) -> list[tuple[float, str]]:
    """Return the words along a bar with those at ends that values lie beyond."""
    shown = [(share, word) for share, word in ends if word]
    near = [
        (share, word) for share, word in marks if all(abs(share - end) > CLOSE for end, _ in shown)
    ]
    return sorted(near + shown)


def _thinned(places: list[float], zero: float, most: float) -> list[bool]:
    """Return which places, shares of a bar, have words if ``most`` fit, from that of zero."""
    if len(places) <= most:
        return [True] * len(places)
    every = next((n for n in (2, 5, 10, 20) if len(places) / n <= most), 50)
    step = places[1] - places[0]
    if not np.allclose(np.diff(places), step, rtol=0.01):
        return [place % every == 0 for place in range(len(places))]
    return [round((place - zero) / step) % every == 0 for place in places]


def ink_on(background: pv.Color) -> Color:
    """Return the colour of words on a background: black or white."""
    return (0.0, 0.0, 0.0) if sum(background.float_rgb) > LIGHT_BACKGROUND else (1.0, 1.0, 1.0)


def _narrow(actor: vtkTextActor, room: float) -> None:
    """Make the letters of an actor smaller, where its words are wider than their room in pixels."""
    style, box = actor.GetTextProperty(), [0, 0, 0, 0]
    vtkTextRenderer.GetInstance().GetBoundingBox(style, actor.GetInput(), box, _DPI)
    if (width := box[1] - box[0] + 1) > room:
        style.SetFontSize(int(style.GetFontSize() * room / width))


def _text(word: str, ink: Color) -> vtkTextActor:
    actor = vtkTextActor()
    actor.SetInput(word)
    style = actor.GetTextProperty()
    style.SetColor(*ink)
    style.SetFontFamilyToArial()
    style.SetJustificationToCentered()
    style.SetVerticalJustificationToBottom()
    return actor
