"""Texts, keys and scalar bars of a plotter as words and areas of colour."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingAnnotation import vtkCornerAnnotation, vtkScalarBarActor
from vtkmodules.vtkRenderingCore import vtkProp, vtkRenderer, vtkTextActor, vtkTextProperty

from vizlight._types import Array, Color
from vizlight.draw.live import items
from vizlight.draw.vector.files import ASCENT, DESCENT, LINE, Fill, Item, Words

#: Shares of the width and of the height of a picture at which VTK writes texts, in its order.
CORNERS = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.5, 0.0), (1.0, 0.5), (0.0, 0.5),
           (0.5, 1.0))  # fmt: skip
#: Colours of a scalar bar, and its distance from its numbers in sizes of letters.
SHADES, GAP = 64, 0.2
#: Letters that reach below the line.
LOW = frozenset("gjpqy,;()[]{}Q_/|@")


def words_of(plotter: pv.BasePlotter) -> tuple[list[Item], list[vtkProp]]:
    """Return the words of a plotter, with the bars that they belong to.

    The plotter was drawn at its size; the props are those that they stand for.
    """
    words: list[Item] = []
    props: list[vtkProp] = []
    height = plotter.window_size[1]
    for renderer in plotter.render_window.GetRenderers():  # type: ignore[union-attr]
        for prop in items(renderer.GetViewProps()):
            if not prop.GetVisibility():
                continue
            if isinstance(prop, vtkTextActor) and not prop.GetOrientation():
                every: Iterable[Item] = _text(prop, renderer, height)
            elif isinstance(prop, vtkScalarBarActor):
                every = _bar(prop, renderer, height)
            elif isinstance(prop, vtkCornerAnnotation):
                every = _corners(prop, plotter)
            else:
                continue
            props.append(prop)
            words += every
    return words, props


def _text(actor: vtkTextActor, renderer: vtkRenderer, height: int) -> Iterator[Words]:
    """Yield the text of an actor at its place."""
    lines = (actor.GetInput() or "").splitlines()
    if not any(lines):
        return
    style = actor.GetTextProperty()
    x, y = actor.GetPositionCoordinate().GetComputedDoubleDisplayValue(renderer)[:2]
    across = (0.0, 0.5, 1.0)[style.GetJustification()]
    above = (1.0, 0.5, 0.0)[style.GetVerticalJustification()]
    size = style.GetFontSize() * renderer.GetRenderWindow().GetDPI() / 72
    yield Words(lines, (x, height - y), size, _color(style), across, above)


def _color(style: vtkTextProperty) -> Color:
    red, green, blue = style.GetColor()
    return red, green, blue


def _bar(bar: vtkScalarBarActor, renderer: vtkRenderer, height: int) -> Iterator[Item]:
    """Yield the colours, the numbers and the title of a scalar bar."""
    rect = [0, 0, 0, 0]
    bar.GetScalarBarRect(rect, renderer)
    corner = renderer.GetOrigin()
    left, low, wide, high = rect[0] + corner[0], rect[1] + corner[1], rect[2], rect[3]
    stands = bool(bar.GetOrientation())
    table = bar.GetLookupTable()
    first, last = table.GetRange()
    count = min(int(table.GetNumberOfAvailableColors()) or SHADES, SHADES)
    for i in range(count):
        # Each reaches to the end of the bar, below the next.
        share = i / count
        value = first + (i + 0.5) / count * (last - first)
        color = [0.0, 0.0, 0.0]
        table.GetColor(value, color)
        x, y = (left, low + share * high) if stands else (left + share * wide, low)
        box = _box(x, y, left + wide, low + high, height)
        yield Fill((color[0], color[1], color[2]), [box])
    size = float(bar.GetLabelTextProperty().GetFontSize())
    ink = _color(bar.GetLabelTextProperty())
    beyond = bar.GetTextPosition() == vtkScalarBarActor.SucceedScalarBar
    for share, word in _labels(bar, first, last):
        if stands:
            x = left + wide + GAP * size if beyond else left - GAP * size
            across, place = (0.0 if beyond else 1.0), (x, height - low - share * high)
            yield Words([word], place, size, ink, across, 0.5)
        else:
            y = low + high + GAP * size if beyond else low - GAP * size
            yield Words([word], (left + share * wide, height - y), size, ink, 0.5, float(beyond))
    if bar.GetDrawNanAnnotation():
        nan = table.GetNanColor()[:3]
        box = _box(left, low - 1.5 * size, left + wide, low - 0.5 * size, height)
        yield Fill(nan, [box])
        place = (left + wide + GAP * size, height - low + size)
        yield Words([bar.GetNanAnnotation()], place, size, ink, 0.0, 0.5)
    if title := bar.GetTitle():
        style = bar.GetTitleTextProperty()
        size = float(style.GetFontSize())
        top = low + high + (GAP + (0 if stands or not beyond else LINE)) * size
        place = (left + wide / 2, height - top - 0.4 * size * stands)
        yield Words(title.splitlines(), place, size, _color(style), 0.5, 1.0)


def _box(left: float, low: float, right: float, top: float, height: float) -> Array:
    corners = [(left, low), (left, top), (right, top), (right, low)]
    return np.array([(x, height - y) for x, y in corners], dtype=np.float64)


def _labels(bar: vtkScalarBarActor, first: float, last: float) -> Iterator[tuple[float, str]]:
    """Yield the shares of the length of a bar at which it has words, and these."""
    table, span = bar.GetLookupTable(), (last - first) or 1.0
    notes = table.GetNumberOfAnnotatedValues() if bar.GetDrawAnnotations() else 0
    for i in range(notes):
        share = (table.GetAnnotatedValue(i).ToDouble() - first) / span
        if 0 <= share <= 1:
            yield share, table.GetAnnotation(i)
    if not bar.GetDrawTickLabels() or notes:
        return
    count = bar.GetNumberOfLabels()
    form = bar.GetLabelFormat()
    for i in range(count):
        share = i / max(count - 1, 1)
        value = first + share * (last - first)
        word = form % value if "%" in form else form.format(value)
        yield share, word.strip()


def _corners(actor: vtkCornerAnnotation, plotter: pv.BasePlotter) -> Iterator[Words]:
    """Yield the texts in the corners, in the sizes that they have in the picture."""
    texts = [actor.GetText(i) or "" for i in range(len(CORNERS))]
    shown = [i for i, text in enumerate(texts) if text.strip()]
    if not shown:
        return
    whole = _picture(plotter)
    actor.SetVisibility(False)
    changed = np.any(whole != _picture(plotter), axis=2)
    actor.SetVisibility(True)
    for i in shown:
        across, up = CORNERS[i]
        pixels = changed.copy()
        if len(shown) > 1:
            # Each has the third of the picture in which it stands.
            for axis, share in enumerate((1 - up, across)):
                third = (np.arange(changed.shape[axis]) * 3 // changed.shape[axis]) == 2 * share
                pixels &= third[:, np.newaxis] if axis == 0 else third
        if pixels.any():
            yield _fitted(texts[i].strip().splitlines(), pixels, across, actor.GetTextProperty())


def _picture(plotter: pv.BasePlotter) -> Array:
    plotter.render()
    return np.array(plotter.screenshot(return_img=True))


def _fitted(lines: list[str], changed: Array, across: float, style: vtkTextProperty) -> Words:
    """Return a text that fills the pixels that it has changed."""
    rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
    x = columns[0] + across * (columns[-1] + 1 - columns[0])
    # Of letters of size 1: from the top of capitals to the line, and below it where letters are.
    low = DESCENT if LOW & set(lines[-1]) else 0.0
    size = (rows[-1] + 1 - rows[0]) / (ASCENT + low + LINE * (len(lines) - 1))
    bottom = rows[-1] + 1 + (DESCENT - low) * size
    return Words(lines, (float(x), float(bottom)), size, _color(style), across, 1.0)
