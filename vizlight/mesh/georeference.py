"""Maps: grids in degrees of longitude and latitude in metres, and the exaggeration of heights."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight.mesh import blocks

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight.mesh.blocks import DataSetT

__all__ = [
    "DEGREE", "UNIT", "exaggeration", "in_metres", "is_degrees", "seem_degrees", "stretch",
]  # fmt: skip

#: Field array with the unit of x and y, and its value for longitude and latitude.
UNIT, DEGREE = "unit", "degree"
#: Length of a degree of latitude on the sphere of the earth's mean radius, in metres.
METRES = math.radians(6_371_008.8)
#: Range of heights, as a share of the side of a map, that needs no exaggeration.
ENOUGH = (0.05, 0.5)
#: Percentiles of the heights that bound their range, so that single wrong heights do not matter.
RANGE = (1.0, 99.0)


def is_degrees(mesh: pv.DataSet) -> bool:
    """Return whether the x and y of a mesh are said to be in degrees."""
    return UNIT in mesh.field_data and mesh.field_data[UNIT][0] == DEGREE


def in_metres(mesh: DataSetT) -> DataSetT:
    """Return a map in metres east and north of its centre, if it is in degrees.

    A degree of latitude has 111,195 m, one of longitude ``cos(latitude)`` of that, for the
    latitude of the centre: lengths agree with the ellipsoid's to 0.6 % there, and east to west
    farther north or south to the ratio of the cosines.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh, which is in degrees if its field array ``unit`` says so.

    Returns
    -------
    pyvista.DataSet
        Copy that shares the arrays, or the mesh itself where it is not in degrees.
    """
    if not is_degrees(mesh):
        return mesh
    x, y, _ = mesh.center
    across = METRES * math.cos(math.radians(min(max(y, -89.0), 89.0)))
    moved = blocks.moved(mesh, np.array([-x, -y, 0.0]), np.array([across, METRES, 1.0]))
    moved.field_data[UNIT] = ["metre"]
    return moved


def seem_degrees(grid: pv.DataSet, heights: str) -> bool:
    """Return whether a grid of unknown unit is in degrees.

    Its x and y can be longitude and latitude, and its heights range over more than its sides,
    as no terrain does whose x and y are in the unit of its heights.

    Parameters
    ----------
    grid : pyvista.DataSet
        Grid of one layer.
    heights : str
        Name of a point array.
    """
    bounds = grid.bounds
    places = bounds.x_min >= -180 and bounds.x_max <= 360 and abs(grid.center[1]) <= 90
    degrees = places and max(abs(bounds.y_min), abs(bounds.y_max)) <= 90
    # Pixels of an image that has no place are one apart.
    fine = max(getattr(grid, "spacing", (0.0, 0.0))[:2]) < 1
    return degrees and fine and _spread(grid, heights) > max(grid.bounds_size[:2])


def exaggeration(mesh: pv.DataSet, heights: str) -> float:
    """Return the factor of heights with which the relief of a map can be seen.

    It is 1 where they range over a twentieth of the side of the map to half of it; else the 1, 2
    or 5 with zeros that comes next to that.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh whose points the heights raise; one in degrees is taken in metres.
    heights : str
        Name of a point array of one component.
    """
    sides = sorted(in_metres(mesh).bounds_size)
    return _factor(_spread(mesh, heights), math.sqrt(sides[1] * sides[2]) or sides[2])


def stretch(mesh: pv.DataSet) -> float:
    """Return the factor of z with which a volume over a map in degrees can be seen, 1 for others.

    Air and sea are thin beside their maps, and levels are often numbers; see :func:`exaggeration`.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh.
    """
    x, y, z = in_metres(mesh).bounds_size
    return _factor(z, math.sqrt(x * y)) if is_degrees(mesh) else 1.0


def _factor(spread: float, side: float) -> float:
    if not (spread > 0 and side > 0) or ENOUGH[0] <= spread / side <= ENOUGH[1]:
        return 1.0
    wanted = min(max(spread / side, ENOUGH[0]), ENOUGH[1]) * side / spread
    power = 10.0 ** math.floor(math.log10(wanted))
    steps = [float(f"{step * power:.3g}") for step in (1, 2, 5, 10)]
    return min(steps, key=lambda step: abs(math.log(step / wanted)))


def _spread(mesh: pv.DataSet, heights: str) -> float:
    values = np.asarray(mesh.point_data[heights], dtype=np.float64)
    values = values[np.isfinite(values)]
    return float(np.ptp(np.percentile(values, RANGE))) if values.size else 0.0
