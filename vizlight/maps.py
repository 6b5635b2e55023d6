"""Colour maps that stay readable in light.

Light dims a colour along the line to black. Colours of one lightness and one chroma differ in hue
alone, which dimming does not change, so that a value can still be read by the nearest colour.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import LinearSegmentedColormap, ListedColormap, is_color_like, to_rgba

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista as pv

    from vizlight._types import Foreign

__all__ = ["bands", "even", "heights", "kinds", "speed"]

#: Muted colours of kinds that a reader tells apart, also without green cones: of much the same
#: chroma, as far as can be from each other, from the grey of missing values and from paper.
_KINDS = (
    "#5c6d9f", "#e2a78a", "#84b794", "#9a585a", "#6cbcdf", "#7e713f", "#cd99c2", "#197779",
    "#9ba265", "#f8aeb9", "#bbbee3", "#426636", "#a48477", "#907c91", "#585e56", "#90a2a0",
)  # fmt: skip
#: Name of the map of directions, whose ends are alike.
CYCLIC = "vizlight.cyclic"
#: Colour of what is missing in pictures without light.
MISSING = "#d9d9d9"
#: Largest difference between the numbers of kinds.
MOST_SPAN = 1 << 16

#: Hexadecimal digits of 256 colours of sRGB, of CIELAB lightness 70 and chroma 46, hue from 275 to
#: 445 degrees. Steps are even in CIELAB, half as a normal reader and half as one without green
#: cones sees them (Vienot, Brettel and Mollon 1999).
_EVEN = (
    "74adfe76adfe79acfe7cacfe7eabfd81abfd83aafd85aafd87a9fc8aa9fc8ca8fc8ea8fc90a8fb92a7fb94a7fb96a6fa"
    "97a6fa99a6f99ba5f99da5f99ea4f8a0a4f8a2a3f7a3a3f7a5a3f7a6a2f6a8a2f6a9a2f5aba1f5aca1f4aea0f4afa0f3"
    "b0a0f3b29ff2b39ff2b49ff1b59ef1b79ef0b89ef0b99defba9defbc9ceebd9ceebe9cedbf9becc09becc19bebc29aeb"
    "c39aeac49aeac599e9c699e8c799e8c899e7c998e7ca98e6cb98e5cc97e5cd97e4ce97e3cf96e3d096e2d196e2d296e1"
    "d395e0d395e0d495dfd594ded694ded794ddd794dcd893dcd993dbda93dada93dadb92d9dc92d8dd92d8dd92d7de91d6"
    "df91d6df91d5e091d4e190d4e190d3e290d2e390d2e38fd1e48fd0e58fcfe58fcfe68fcee68ecde78ecde78ecce88ecb"
    "e88ecae98dcaea8dc9ea8dc8eb8dc8eb8dc7ec8dc6ec8cc5ed8cc5ed8cc4ed8cc3ee8cc2ee8cc2ef8bc1ef8bc0f08bc0"
    "f08bbff08bbef18bbdf18bbdf28abcf28abbf28abaf38abaf38ab9f38ab8f48ab7f48ab7f48ab6f58ab5f589b4f589b3"
    "f689b3f689b2f689b1f689b0f789b0f789aff789aef789adf889adf889acf889abf889aaf889a9f989a9f989a8f989a7"
    "f989a6f989a6fa89a5fa89a4fa89a3fa89a2fa89a2fa89a1fa89a0fa899ffa899ffb899efb899dfb899cfb899bfb899b"
    "fb899afb8999fb8998fb8997fb8997fb8a96fb8a95fb8a94fb8a94fb8a93fb8a92fb8a91fb8a90fb8a90fb8b8ffb8b8e"
    "fa8b8dfa8b8cfa8b8cfa8b8bfa8b8afa8c89fa8c88fa8c88fa8c87f98c86f98c85f98d85f98d84f98d83f88d82f88d81"
    "f88e81f88e80f78e7ff78e7ef78f7df78f7df68f7cf68f7bf68f7af5907af59079f59078f49177f49176f49176f39175"
    "f39274f29273f29273f29372f19371f19370f09470f0946fef946eef956dee956ded956ced966bec966aec966aeb9769"
    "eb9768ea9767e99867e99866e89965e79965e69a64e69a63e59a63e49b62e39b61e29c61e19c60e19d5fe09d5fdf9e5e"
    "de9e5ddd9f5ddc9f5cdba05cdaa05bd8a15bd7a15ad6a259d5a259d4a359d2a358d1a458cfa457cea557cca657cba656"
)
#: Blue over rose to yellow; once this module is loaded, PyVista and Matplotlib know it by the name
#: ``"vizlight.even"`` too. It is the map of data where none is named.
even = ListedColormap(
    np.frombuffer(bytes.fromhex(_EVEN), np.uint8).reshape(-1, 3) / 255, name="vizlight.even"
)
colormaps.register(even, force=True)
#: Pale yellow over green to blue, no darker than a CIELAB lightness of 34, so that black strokes
#: are seen on all of it: the lighter part of Cynthia Brewer's YlGnBu, named ``"vizlight.speed"``.
#: It is the map of the lengths of vectors in a look.
speed = ListedColormap(colormaps["YlGnBu"](0.8 * np.arange(256) / 255), name="vizlight.speed")
colormaps.register(speed, force=True)
#: Maps of a look that run in lightness too, as most printed ones, yet not so far that light on them
#: is taken for another value: violet over green to yellow on surfaces, indigo over crimson to
#: yellow for temperatures, around all hues for directions, and the parts of viridis and of these
#: that stand out from a white and from a dark ground, with large values standing out most, and hot
#: ones red.
_VIOLET_TO_YELLOW = ["#5a4fb0", "#3f7fc9", "#35a7b8", "#4fc087", "#a5d24a", "#f2dc3c"]
_INDIGO_TO_YELLOW = ["#4a45a6", "#7d40a8", "#bb4380", "#e3624d", "#f4993c", "#f9df74"]
#: Pale over green and yellow to red and violet, as rain on radars is printed, but lighter or darker
#: from step to step: light rain to hail.
_RAIN = [
    "#dfe6ee", "#9fc3de", "#5b9fb5", "#3f9a5f", "#a9c83f", "#f3d23c", "#ef8d2f", "#d4402f",
    "#8e2a86",
]  # fmt: skip
_ALL_AROUND = ["#3b6fb6", "#2fa5a0", "#6db33f", "#e0b030", "#e0603f", "#a34fa3", "#3b6fb6"]
_surface = LinearSegmentedColormap.from_list("vizlight.surface", _VIOLET_TO_YELLOW)
_heat = LinearSegmentedColormap.from_list("vizlight.heat", _INDIGO_TO_YELLOW)
for _map, _name, _on_paper, _on_dark in (
    (colormaps["viridis"], "on", (0.8, 0.0), (0.3, 1.0)),
    (_heat, "heat_on", (0.0, 0.75), (0.15, 1.0)),
):
    for _ground, _ends in (("paper", _on_paper), ("dark", _on_dark)):
        _part = ListedColormap(_map(np.linspace(*_ends, 256)), name=f"vizlight.{_name}_{_ground}")
        colormaps.register(_part, force=True)
colormaps.register(_surface, force=True)
colormaps.register(_heat, force=True)
colormaps.register(LinearSegmentedColormap.from_list("vizlight.rain", _RAIN), force=True)
colormaps.register(LinearSegmentedColormap.from_list(CYCLIC, _ALL_AROUND), force=True)


#: Colours of the sea bed from deep to shallow, and of the ground from low to high.
_SEA = LinearSegmentedColormap.from_list("sea", ["#2f6495", "#78aed3", "#c3e1ee"])
_GROUND = LinearSegmentedColormap.from_list(
    "ground", ["#4a9058", "#a9c36a", "#ecd07a", "#bf8145", "#935f49", "#f8f4f0"]
)


def heights(low: float, high: float, /, *, level_sea: bool = False) -> pv.LookupTable:
    """Return a lookup table for heights: blue below 0, and green over tan to white above.

    No colour is dark, since a shadow on it dims it. The sea is darker where it is deeper.

    Parameters
    ----------
    low, high : float
        Ends of the heights, in the unit of the mesh.
    level_sea : bool, default: False
        Whether the step of colours that holds 0 is blue too, as for heights that are 0 at sea.

    Returns
    -------
    pyvista.LookupTable
        256 colours from ``low`` to ``high``.

    Raises
    ------
    TypeError, ValueError
        If an end is no finite number, or they do not ascend.

    Examples
    --------
    >>> from vizlight import maps
    >>> maps.heights(-50.0, 1200.0).scalar_range
    (-50.0, 1200.0)
    """
    import pyvista as pv

    low, high = _check.number("low", low), _check.number("high", high)
    if not low < high:
        raise _check.value_error("high", f"a number above low={low:g}", high)
    table = pv.LookupTable(n_values=256)
    # The middles of the 256 steps.
    values = low + (high - low) * (np.arange(256) + 0.5) / 256
    level_sea = _check.boolean("level_sea", level_sea)
    coast, sea = max(low, 0.0), values < 0
    if level_sea:
        sea |= values - (high - low) / 512 <= 0
    colors = np.empty((256, 4))
    if sea.any():
        deepest = min(high, 0.0) - low
        colors[sea] = _SEA(np.minimum((values[sea] - low) / deepest, 1.0) if deepest > 0 else 1.0)
    if not sea.all():
        colors[~sea] = _GROUND((values[~sea] - coast) / (high - coast))
    table.values = np.round(255 * colors).astype(np.uint8)
    table.nan_color = MISSING
    table.scalar_range = (low, high)
    return table


#: Violet and blue over pale yellow to red and crimson, with a longer way through CIELAB than most
#: maps, and no darker than a lightness of 40, so that black lines are seen on all of it. It is the
#: map of bands between isolines, named ``"vizlight.bands"``.
_BANDS = LinearSegmentedColormap.from_list("vizlight.bands", [
    "#7e57b5", "#4169cf", "#5fb5dd", "#b9e6cf", "#fdf9b0", "#fdc15c", "#f4743e", "#d63a3a",
    "#b0226a",
])  # fmt: skip
colormaps.register(_BANDS, force=True)
#: Pale to deep blue over green and yellow to red and violet, as on maps of rain: amounts that stand
#: out from a white ground, named ``"vizlight.amounts"``.
_AMOUNTS = LinearSegmentedColormap.from_list("vizlight.amounts", [
    "#b5dcf3", "#6fb1e8", "#3f78d0", "#2f9f8f", "#7cc25a", "#efe05a", "#f79a3c", "#dc4438",
    "#a3256f", "#5b2a86",
])  # fmt: skip
colormaps.register(_AMOUNTS, force=True)
#: Colours of a table of bands.
_FINE = 1024
#: Share of the larger of the ends below and above 0 from which on the smaller makes a map of two
#: sides.
TWO_SIDED = 0.4


def bands(
    levels: Sequence[float],
    limits: Sequence[float],
    cmap: str = "vizlight.bands",
    /,
    *,
    logarithmic: bool = False,
    below: str | None = None,
) -> pv.LookupTable:
    """Return a lookup table with one colour between each level and the next, as between isolines.

    Parameters
    ----------
    levels : sequence of float
        Values at which the colour changes.
    limits : (float, float)
        Values at the ends of the colours, which are levels too. Where they are on both sides of 0,
        and the smaller is at least 0.4 of the larger, the middle of the map is at 0.
    cmap : str, default: "vizlight.bands"
        Colour map; violet over pale yellow to crimson by default, on which black lines are seen.
    logarithmic : bool, default: False
        Whether equal ratios have equal parts of the colours, as classes of rain have.
    below : str, optional
        Colour of values below the limits, such as that of dry ground. Default: the first one.

    Returns
    -------
    pyvista.LookupTable
        1024 colours; missing values are light grey.

    Raises
    ------
    TypeError, ValueError
        If a level is no finite number, the limits do not ascend, or are not positive where colours
        are logarithmic, or no map or colour has the name.

    Examples
    --------
    >>> from vizlight import maps
    >>> maps.bands([280, 290, 300], [272, 305]).scalar_range
    (272.0, 305.0)
    """
    import pyvista as pv

    logarithmic = _check.boolean("logarithmic", logarithmic)
    low, high = _check.limits("limits", limits)
    if not low < high:
        raise _check.value_error("limits", f"a number above {low:g} at the end", high)
    if logarithmic and low <= 0:
        raise _check.value_error("limits", "positive numbers for a logarithm", f"{low:g}")
    ends = low, high
    edges = np.unique(
        [low, *np.clip(_check.coordinates("levels", levels).ravel(), low, high), high]
    )
    if logarithmic:
        edges, (low, high) = np.log(edges), np.log(ends)
    start, end = low, high
    if not logarithmic and min(-low, high) >= TWO_SIDED * max(-low, high):
        start, end = -max(-low, high), max(-low, high)
    # The middles of the steps of the table.
    values = low + (high - low) * (np.arange(_FINE) + 0.5) / _FINE
    middles = (0.5 * (edges[1:] + edges[:-1]))[np.searchsorted(edges[1:-1], values)]
    shares = (middles - start) / (end - start)
    table = pv.LookupTable(n_values=_FINE)
    try:
        # PyVista types names of maps one by one.
        colors: Foreign = pv.plotting.colors.get_cmap_safe(cmap)(shares)  # type: ignore[arg-type]
    except (TypeError, ValueError) as error:
        expected, got = "the name of a colour map", _check.describe(cmap)
        raise _check.value_error("cmap", expected, got) from error
    table.values = np.round(255 * np.asarray(colors)).astype(np.uint8)
    table.nan_color = MISSING
    table.scalar_range, table.log_scale = ends, logarithmic
    if below is not None:
        if not is_color_like(below):
            raise _check.value_error("below", "a colour", _check.describe(below))
        table.below_range_color = below
    return table


def kinds(
    values: Sequence[float] | Mapping[float, str], /, *, colors: Mapping[float, str] | None = None
) -> pv.LookupTable:
    """Return a lookup table that gives each of some whole numbers a colour of its own.

    Parameters
    ----------
    values : sequence of float, or mapping of float to str
        Kinds, such as the materials or labels of a mesh, in any order; of a mapping with their
        names in keys. Colours repeat after 16.
    colors : mapping of float to str, optional
        Colours of kinds, such as those of an atlas. Default: all are chosen.

    Returns
    -------
    pyvista.LookupTable
        Table from half below the least kind to half above the largest; other numbers have the
        colour of missing values, a light grey.

    Raises
    ------
    ValueError
        If none is given, one is no whole number, they are more than 65536 apart, or ``colors`` has
        no colours.

    Examples
    --------
    >>> from vizlight import maps
    >>> maps.kinds([1, 7, 44]).scalar_range
    (0.5, 44.5)
    """
    import pyvista as pv

    names = values if isinstance(values, Mapping) else {}
    rows = np.unique(_check.floats("values", list(values) if names else values))
    whole = rows.size and np.all(rows == np.round(rows)) and np.ptp(rows) < MOST_SPAN
    if not whole:
        expected = f"one whole number or more, less than {MOST_SPAN} apart"
        raise _check.value_error("values", expected, values)
    shades_of = {} if colors is None else colors
    if not isinstance(shades_of, Mapping) or not all(map(is_color_like, shades_of.values())):
        expected = "a mapping of kinds to colours, such as {1: '#ff0000'}"
        raise _check.value_error("colors", expected, colors)
    # VTK gives a table of one colour a second one.
    table = pv.LookupTable(n_values=max(int(np.ptp(rows)) + 1, 2))
    # A table with transparent colours would make all of a mesh translucent.
    shades = np.tile(np.uint8(255 * np.array(to_rgba(MISSING))), (table.n_values, 1))
    for place, value in enumerate(rows):
        color = np.array(to_rgba(shades_of.get(float(value), _KINDS[place % len(_KINDS)])))
        shades[int(value - rows[0])] = np.round(255 * color)
    if len(rows) == 1:
        shades[1] = shades[0]
    table.values = shades
    table.nan_color = table.below_range_color = table.above_range_color = MISSING
    table.scalar_range = (float(rows[0]) - 0.5, float(rows[-1]) + 0.5)
    table.annotations = {float(value): names.get(value, f"{value:g}") for value in rows}
    return table
