"""Scalar bars whose words fit into the picture."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

import numpy as np

from vizlight.shading.display import NO_DATA_NAME

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor

    from vizlight._types import Keywords

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


def fitted(plotter: pv.BasePlotter, title: str, asked: Keywords) -> Keywords:
    """Return keywords of a scalar bar that leave room for its words in the picture.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter, whose active renderer and theme are used.
    title : str
        Title, where none is asked for.
    asked : dict
        Keywords of ``pyvista.Plotter.add_scalar_bar`` that a user gave.

    Returns
    -------
    dict
    """
    asked = {"title": title, **asked}
    wide, high = plotter.renderer.GetSize()
    if asked.keys() & PLACED or not (wide and high):
        return asked
    theme = plotter.theme
    upright = asked.get("vertical") or theme.colorbar_orientation == "vertical"
    place = theme.colorbar_vertical if upright else theme.colorbar_horizontal
    letters = int(max(min(theme.font.label_size, high / LETTERS_HIGH), LEAST))
    number = LONGEST * LETTER * letters
    left, right = place.position_x * wide, (place.position_x + place.width) * wide
    fonts = {"label_font_size": letters, "title_font_size": letters}
    made: Keywords = {"unconstrained_font_size": True} | fonts
    if upright:
        # The numbers stand at its right.
        left = max(min(left, wide - number - 2.5 * letters), 0)
    else:
        right = max(min(right, wide - 0.5 * number - 4), left + 1)
        lines = len(_lines(str(asked["title"]), left, right, wide, letters))
        made["height"] = max(place.height, (lines + 2) * LINE * letters / high)
    return made | {"position_x": left / wide, "width": (right - left) / wide} | asked


def settle(plotter: pv.BasePlotter, bar: vtkScalarBarActor, asked: Keywords) -> None:
    """Set the words of a scalar bar that :func:`fitted` made apart, where nothing else is asked."""
    wide, high = plotter.renderer.GetSize()
    if asked.keys() & PLACED or not (wide and high):
        return
    letters = bar.GetLabelTextProperty().GetFontSize()
    left = bar.GetPosition()[0] * wide
    words = _lines(str(bar.GetTitle()), left, left + bar.GetWidth() * wide, wide, letters)
    bar.SetTitle("\n".join(words))
    bar.SetAnnotationLeaderPadding(2)
    if bar.GetOrientation():
        bar.SetVerticalTitleSeparation(letters // 2)
    else:
        # VTK puts the title of a bar that lies so near to the numbers that they touch.
        bar.GetTitleTextProperty().SetLineOffset(-0.4 * letters)
        bar.SetBarRatio(letters / (bar.GetHeight() * high))
        room = bar.GetWidth() * wide / (LONGEST * LETTER * letters)
        bar.SetNumberOfLabels(min(bar.GetNumberOfLabels(), max(int(room), 2)))
    if not plotter.theme.font.fmt:
        low, top = bar.GetLookupTable().GetRange()
        ticks = np.linspace(low, top, bar.GetNumberOfLabels())
        for digits in range(3, DIGITS + 1):
            if len({f"{tick:.{digits}g}" for tick in ticks}) == len(ticks):
                bar.SetLabelFormat(f"%-#6.{digits}g")
                break


def _lines(title: str, left: float, right: float, wide: float, letters: float) -> list[str]:
    """Return the lines of a title that is centred above a bar."""
    middle = (left + right) / 2
    room = 2 * min(middle, wide - middle) / (LETTER * letters)
    return textwrap.wrap(title, max(int(room), 1))


def name_no_data(bar: vtkScalarBarActor) -> None:
    """Let a scalar bar name the colour of what is not data."""
    bar.SetDrawNanAnnotation(True)
    bar.SetNanAnnotation(NO_DATA_NAME)
