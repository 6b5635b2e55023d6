"""Densities of electrons, by crystallography and electron microscopy: MRC and CCP4 files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyvista as pv

from vizlight._types import Foreign
from vizlight.mesh import meaning
from vizlight.reading import file_parts
from vizlight.reading.brains import of_affine

SUFFIXES = (".mrc", ".ccp4", ".map")
#: Name of the densities in words.
WORDS = "density map"
#: Words of the header, counted from 1: first node along the axes, nodes along the edges of the
#: cell, and place of the first node.
_FIRST, _NODES, _PLACE = (5, 6, 7), (8, 9, 10), (50, 51, 52)


def read(path: Path) -> pv.ImageData | pv.StructuredGrid:
    """Return the densities of a map at their places, in the unit of the file, mostly angstrom.

    gemmi reads the file; the grid is structured where the edges of the cell are not at right
    angles.
    """
    import gemmi

    with file_parts.errors_of_gemmi(path):
        chart: Foreign = gemmi.read_ccp4_map(str(path))
        # Columns, rows and sections may be any axes.
        chart.setup(float("nan"), gemmi.MapSetup.ReorderOnly)
    values = np.asarray(chart.grid.array, dtype=np.float32)
    nodes = np.array([chart.header_i32(word) for word in _NODES])
    edges = np.array(chart.grid.unit_cell.orth.mat.tolist()) / np.maximum(nodes, 1)
    first = edges @ [chart.header_i32(word) for word in _FIRST]
    if not first.any():
        # Microscopes say the place itself.
        first = np.array([chart.header_float(word) for word in _PLACE])
    grid = of_affine(np.column_stack([edges, first]), values.shape)
    grid.point_data["density"] = values.ravel(order="F")
    return meaning.attach(grid, meaning.Meaning(arrays={"density": {"long_name": WORDS}}))
