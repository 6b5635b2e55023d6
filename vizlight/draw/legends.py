"""What explains the colours: scalar bars whose words fit, and a key in the freest corner."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkRenderingCore import (
    vtkActor2D,
    vtkCoordinate,
    vtkPolyDataMapper2D,
    vtkTextActor,
)

from vizlight.draw.live import items, matrix_of
from vizlight.filters.key import WORDS
from vizlight.filters.tint import RGB
from vizlight.shading.display import NO_DATA_NAME

if TYPE_CHECKING:
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
    from vtkmodules.vtkRenderingCore import vtkRenderer

    from vizlight._types import Array, Color, Keywords

Place: TypeAlias = Literal["lower left", "lower right", "upper left", "upper right"]
Corner: TypeAlias = Place | Literal["auto"]
#: Corners in the order in which they are taken where none is free: 0 is left or lower, 1 the other.
PLACES: dict[Place, tuple[int, int]] = {
    "lower left": (0, 0), "lower right": (1, 0), "upper left": (0, 1), "upper right": (1, 1),
}  # fmt: skip
#: Distance from the edges, and height of letters, as shares of the shorter side of the picture.
MARGIN, LETTERS = 0.025, 0.026
#: Sum of the channels of a background above which words on it are black.
LIGHT_BACKGROUND = 1.2
#: Most points of an actor that are looked at for a free corner.
MOST = 20_000
#: Keywords that say how large a bar is and where it stands: with any of them it is left as asked.
PLACED = {
    "fmt", "height", "label_font_size", "n_labels", "position_x", "position_y", "title_font_size",
    "unconstrained_font_size", "width",
}  # fmt: skip
#: Width of a letter and distance of lines, in heights of letters; letters of the longest number.
LETTER, LINE, LONGEST = 0.57, 1.5, 10
#: Least height of letters, in pixels, and the height of a picture in letters.
LEAST, LETTERS_HIGH = 9, 24
#: Most digits of a number.
DIGITS = 7


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
    words = textwrap.wrap(str(bar.GetTitle()), max(int(room), 1))
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


class CornerKey:
    """A key and its words, drawn over a renderer's picture.

    Parameters
    ----------
    mesh : pyvista.PolyData
        Key, as :func:`vizlight.presets.key` returns it.
    corner : str
        Corner, or ``"auto"`` for the one with the fewest points of data.
    size : float
        Width of the key, as a share of the shorter side of the picture.
    ink : (r, g, b)
        Colour of the words.
    """

    def __init__(self, mesh: pv.PolyData, corner: Corner, size: float, ink: Color) -> None:
        self._mesh, self._size = mesh.copy(), size
        self._corner, self._pixels = corner, (0, 0)
        self._flat = np.asarray(mesh.points, dtype=np.float64)
        mapper, in_pixels = vtkPolyDataMapper2D(), vtkCoordinate()
        in_pixels.SetCoordinateSystemToViewport()
        mapper.SetInputData(self._mesh)
        mapper.SetTransformCoordinate(in_pixels)
        mapper.SetScalarModeToUsePointFieldData()
        mapper.ColorByArrayComponent(RGB, 0)
        mapper.SetColorModeToDirectScalars()
        self.actor = vtkActor2D()
        self.actor.SetMapper(mapper)
        self.words = [_text(str(word), ink) for word in mesh.field_data[WORDS]]
        self._bar = len(self.words) > 1
        if self._bar:
            self.words[0].GetTextProperty().SetJustificationToLeft()
            self.words[-1].GetTextProperty().SetJustificationToRight()

    def show(self, renderer: vtkRenderer) -> None:
        """Draw the key over the pictures of a renderer from now on."""
        for part in (self.actor, *self.words):
            renderer.AddViewProp(part)
        # The renderer holds the observer, and that the key. VTK's stubs know no names of events.
        renderer.AddObserver("StartEvent", lambda caller, _: self.place(caller))  # type: ignore[arg-type]

    def place(self, renderer: vtkRenderer) -> None:
        """Put the key in its corner, if the size of the picture has changed."""
        width, height = renderer.GetSize()
        if (width, height) == self._pixels or not width or not height:
            return
        self._pixels, short = (width, height), min(width, height)
        half, letters, margin = self._size * short / 2, LETTERS * short, MARGIN * short
        # A picture's shorter side is the measure of all: keys look alike in wide and tall windows.
        half *= 1 + self._bar  # A bar is twice as wide, for a word at each end.
        tall = half * np.ptp(self._flat[:, 1]) / 2
        # The words stand below and may be wider than the key.
        words = [len(text.GetInput()) for text in self.words]
        title = len(words) > 2
        below = words[0] + words[-1] + 2 if self._bar else words[0]
        # Letters of Arial are about 0.6 of their height wide, half of that on either side.
        wide = max(half, 0.3 * letters * max(below, *words))
        line = 1.6 * letters
        box = np.array([2 * wide, 2 * tall + line * (1 + title)])
        if self._corner == "auto":
            self._corner = _freest(renderer, box + 2 * margin)
        right, upper = PLACES[self._corner]
        # The pixels of the viewport count from the lower left.
        x = margin + wide if not right else width - margin - wide
        low = margin if not upper else height - margin - box[1]
        moved = vtkPoints()
        y = low + line + tall
        # The key is drawn in pixels of the viewport, over all that the camera sees.
        for point in self._flat * half + (x, y, 0):
            moved.InsertNextPoint(*point)
        self._mesh.SetPoints(moved)
        # The numbers stand below the ends of a bar, and what they are above it.
        places = [(x - half, low), (x + half, low)] if self._bar else [(x, low)]
        if title:
            places.insert(1, (x, y + tall + line - 1.3 * letters))
        for text, at in zip(self.words, places, strict=True):
            text.GetTextProperty().SetFontSize(max(round(letters), 8))
            text.SetPosition(*at)


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


def _freest(renderer: vtkRenderer, box: Array) -> Place:
    """Return the corner whose box of pixels has the fewest points of what is shown."""
    size = np.array(renderer.GetSize(), dtype=np.float64)
    at = _on_screen(renderer)
    counts: dict[Place, int] = {}
    for name, place in PLACES.items():
        low = np.where(place, size - box, 0.0)
        inside = np.all((at >= low) & (at <= low + box), axis=1)
        counts[name] = int(np.count_nonzero(inside))
    return min(counts, key=lambda name: counts[name])


def _on_screen(renderer: vtkRenderer) -> Array:
    """Return the pixels of points of all actors that are shown, at most some of each."""
    width, height = renderer.GetSize()
    camera = renderer.GetActiveCamera()
    matrix = matrix_of(camera.GetCompositeProjectionTransformMatrix(width / height, -1, 1))
    found = [np.empty((0, 2))]
    for actor in items(renderer.GetActors()):
        data = actor.GetMapper().GetInput() if actor.GetMapper() is not None else None
        if not actor.GetVisibility() or data is None or not data.GetNumberOfPoints():
            continue
        points = np.asarray(pv.wrap(data).points, dtype=np.float64)
        # Some thousand points tell a free corner as well as all do.
        points = points[:: max(len(points) // MOST, 1)]
        whole = matrix @ matrix_of(actor.GetMatrix())
        # Homogeneous coordinates: behind the eye the divisor turns negative, which is out of every
        # box.
        seen = np.column_stack([points, np.ones(len(points))]) @ whole.T
        with np.errstate(all="ignore"):
            found.append((seen[:, :2] / seen[:, 3:] + 1) / 2 * (width, height))
    return np.concatenate(found)
