"""The outer surface of a mesh as a mesh of PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pyvista as pv

from vizlight.reading import hull

if TYPE_CHECKING:
    from vizlight._types import Indices


def outer_surface(mesh: pv.DataSet) -> tuple[pv.PolyData, Indices]:
    """Return the outer surface; see :func:`vizlight.reading.hull.outer_surface`."""
    surface, ids = hull.outer_surface(mesh)
    return pv.PolyData(surface), ids
