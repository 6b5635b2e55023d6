"""Values as they are read off the colour bar beside a lit picture."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from vizlight.filters import relight
from vizlight.filters.tint import light_on_colors, map_colors
from vizlight.observers.colors import chromaticity, lab
from vizlight.shading import display

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array
    from vizlight.observers.samples import Part, Sample


class Read(NamedTuple):
    """Errors of values as shares of the range, by the nearest colour and by chromaticity."""

    nearest: Array
    chromatic: Array


def decode(colors: Array, positions: Array, bar: Array) -> Read:
    """Return the errors of a reader who looks colours up on a bar.

    Parameters
    ----------
    colors : ndarray, shape (M, 3)
        Colours of the picture, from 0 to 1.
    positions : ndarray, shape (M,)
        Places of the values on the bar, from 0 to 1.
    bar : ndarray, shape (B, 3)
        Colours of the bar, from one end to the other.

    Returns
    -------
    Read
        Distances on the bar between the value and the nearest colour, in CIELAB and by
        chromaticity.
    """
    middle = (np.arange(len(bar)) + 0.5) / len(bar)
    found = []
    for key in (lab, chromaticity):
        nearest = cKDTree(key(bar)).query(key(colors))[1]
        found.append(np.abs(middle[nearest] - positions))
    return Read(*found)


def lit_colors(part: Part, sample: Sample, table: pv.LookupTable) -> Array:
    """Return the colours of values times light, as :func:`vizlight.tint` makes them."""
    assert sample.values is not None
    inputs = sample.given(sample.tangents, sample.normals)
    source = relight.Source(part.mesh, inputs, sample.options, None)
    ((light, _),) = light_on_colors([source], sample.scene)
    colors = display.on_colors(map_colors(table, sample.values, components=3), light)
    return np.asarray(colors / 255.0)
