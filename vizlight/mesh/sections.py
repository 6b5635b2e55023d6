"""Vertical sections: places along x and heights along y, in a shape that can be seen."""

from __future__ import annotations

import numpy as np
import pyvista as pv

from vizlight.mesh import blocks, meaning
from vizlight.mesh.blocks import DataSetT

#: Width over height of a section whose axes have different units.
SHAPE = 1.6
#: Width over height up to which a section of lengths, or of numbers of cells, keeps its shape.
LONGEST = 4.0
#: Ratio of pressures from which on they are drawn by their logarithm.
DECADES = 100.0
#: Deviation from the shape that needs no factor.
ENOUGH = 0.02


def stretch(mesh: pv.DataSet) -> float:
    """Return the factor of the heights of a section with which it can be seen."""
    flat, up = meaning.of(mesh).section
    x, y, _ = stretched(mesh, 1.0).bounds_size
    if not min(x, y) > 0 or (flat.unit == up.unit in ("m", "") and 1 <= x / y <= LONGEST):
        return 1.0
    factor = float(f"{x / (SHAPE * y):.4g}")
    return 1.0 if abs(factor - 1) < ENOUGH and not _is_deep(mesh) else factor


def stretched(mesh: DataSetT, factor: float) -> DataSetT:
    """Return a section with its heights times a factor; pressures far apart by their logarithm.

    The section is not changed.
    """
    said = meaning.of(mesh)
    flat, up = said.section
    if _is_deep(mesh):
        mesh = mesh.cast_to_rectilinear_grid() if isinstance(mesh, pv.ImageData) else mesh
        mesh = mesh.copy(deep=False)
        mesh.y = -np.log10(np.asarray(mesh.y, dtype=np.float64) / up.factor)
        up = up._replace(factor=-1.0, is_log=True)
    out = blocks.moved(mesh, np.zeros(3), np.array([1.0, factor, 1.0]))
    said.scales = [flat, up._replace(factor=factor * up.factor)]
    return meaning.attach(out, said)


def _is_deep(mesh: pv.DataSet) -> bool:
    """Return whether the heights of a section are pressures that are far apart."""
    up = meaning.of(mesh).section[1]
    is_grid = isinstance(mesh, pv.ImageData | pv.RectilinearGrid)
    if up.unit != "hPa" or up.is_log or not is_grid:
        return False
    high, low = np.array(mesh.bounds[2:4]) / up.factor
    return bool(0 < DECADES * low <= high)
