"""Colours by PyVista's names, from the table of VTK."""

from __future__ import annotations

import functools
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vizlight._types import Color

#: Names that VTK's table lacks or spells otherwise.
_OTHERS = {
    "gray": "808080", "rebeccapurple": "663399",
    "paraviewbackground": "54596d", "paraviewbackgroundwarm": "625d5a",
    "deepcadmiumred": "e3170d", "deepcobaltviolet": "91219e", "deepnaplesyellow": "ffa812",
    "lightcadmiumred": "ff030d", "lightcadmiumyellow": "ffb00f", "lightslateblue": "8470ff",
    "lightviridian": "6eff70",
    "tab:blue": "1f77b4", "tab:orange": "ff7f0e", "tab:green": "2ca02c", "tab:red": "d62728",
    "tab:purple": "9467bd", "tab:brown": "8c564b", "tab:pink": "e377c2", "tab:gray": "7f7f7f",
    "tab:olive": "bcbd22", "tab:cyan": "17becf",
    "b": "0000ff", "g": "008000", "r": "ff0000", "c": "00ffff", "m": "ff00ff", "y": "ffff00",
    "k": "000000", "w": "ffffff",
    "pv": "54596d", "paraview": "54596d", "paraviewwarm": "625d5a", "lightgoldenrod": "fafad2",
}  # fmt: skip


def named(text: str) -> Color:
    """Return the channels of a colour, from 0 to 1, by its name or by hexadecimal digits.

    Case, underscores, hyphens and spaces of a name are ignored. Digits are ``#rrggbb``, without
    the ``#``, with ``0x`` in its place, or followed by two of an opacity, which is ignored.

    Raises
    ------
    ValueError
        If no colour has that name.
    """
    name = _plain(text)
    digits = _OTHERS.get(name, name.lstrip("#").removeprefix("0x"))
    if name not in _OTHERS and (spelled := _names().get(name)) is not None:
        from vtkmodules.vtkCommonColor import vtkNamedColors

        red, green, blue = vtkNamedColors().GetColor3d(spelled)
        return float(red), float(green), float(blue)
    if not re.fullmatch(r"[0-9a-f]{6}([0-9a-f]{2})?", digits):
        raise ValueError(f"no colour {text!r}")
    red, green, blue = (int(digits[i : i + 2], 16) / 255 for i in (0, 2, 4))
    return red, green, blue


def _plain(name: str) -> str:
    return re.sub("[-_ ]", "", name.lower()).replace("grey", "gray")


@functools.cache
def _names() -> dict[str, str]:
    """Return VTK's spelling of each of its names."""
    from vtkmodules.vtkCommonColor import vtkNamedColors

    return {_plain(name): name for name in vtkNamedColors().GetColorNames().split("\n")}
