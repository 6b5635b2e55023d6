"""Scalar bars of PyVista, with words that fit in the picture."""

from __future__ import annotations

import re
import textwrap

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

from vizlight._types import Keywords
from vizlight.shading.display import NO_DATA_NAME

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
#: Most digits of a number.
DIGITS = 7


def wrapped(text: str, columns: int) -> list[str]:
    """Return the lines of a text, which may break within a name: after _, before a capital.

    ``columns`` is the number of letters of a line, where its words are no longer.
    """
    if max(map(len, text.split()), default=0) > columns:
        text = re.sub(r"_|(?<=[a-z])(?=[A-Z])", rf"\g<0>{BREAK} ", text)
    lines = textwrap.wrap(text, columns)
    return [line.replace(f"{BREAK} ", "").replace(BREAK, "") for line in lines]


def settle(plotter: pv.BasePlotter, bar: vtkScalarBarActor, options: Keywords) -> None:
    """Leave room for the words of a scalar bar in the picture, and set them apart.

    The plotter has the active renderer and the theme of the bar, which is left as PyVista made it
    where ``options``, the keywords of a user, say how large it is or where it stands.
    """
    wide, high = plotter.renderer.GetSize()
    if options.keys() & PLACED or not (wide and high):
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
    words = wrapped(str(bar.GetTitle()), max(int(room), 1))
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
    """Let a scalar bar name the colour of missing values."""
    bar.SetDrawNanAnnotation(True)
    bar.SetNanAnnotation(NO_DATA_NAME)
