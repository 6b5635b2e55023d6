"""Brightness and contrast of curves and surfaces in 3-space and 4-space: Banks' illustration 1.

Eight panels show the torus of Banks' section 3 and a curve on it: k = 1 and 2, n = 3 and 4, plain
and compensated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pyvista as pv

from studies import Curve, Row, Study, take_turns
from vizlight.filters.manifold import manifold
from vizlight.geometry.nspace import manifolds
from vizlight.model import brightness
from vizlight.scene import Light, Material, Scene

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: Light of illustration 1. Its coefficients are not given; these are those of Banks' section 3:
#: kd = Isource = 1, no other term, no colour.
LIGHT = (0.7, 0.6, 0.38)
MATTE = Material(ambient=0.0, diffuse=1.0, specular=0.0)
#: The radii are not given either; these are those of illustration 3. The curve advances as fast
#: along one circle as along the other, so its tangents have many directions.
R1, R2 = 1.5, 0.75
WINDING = Fraction(81, 40)
#: At this distance of the eye the projection is stereographic, and the torus has circular sections.
DISTANCE = math.hypot(R1, R2)


@dataclass(frozen=True)
class Panel:
    """One panel: a lit mesh, its mean luminance, and its contrast, standard deviation over mean."""

    k: int
    n: int
    compensated: bool
    mesh: pv.PolyData
    mean: float
    contrast: float


def panels(resolution: int = 192) -> list[Panel]:
    """Return the eight panels, first the plain ones, then the compensated ones.

    Parameters
    ----------
    resolution : int, default: 192
        Number of points on each circle of the torus. The curve has 64 times as many points.

    Notes
    -----
    For n = 4 the light is computed before the projection, with the direction
    (0.7, 0.6, 0.38, 0); for n = 3 after it.
    """
    shapes = {
        1: manifolds.torus_curve(WINDING, r1=R1, r2=R2, resolution=64 * resolution),
        2: manifolds.torus(R1, R2, resolution=resolution),
    }
    found = []
    for compensated in (False, True):
        for k, n in ((1, 3), (1, 4), (2, 3), (2, 4)):
            light = Light(direction=LIGHT if n == 3 else (*LIGHT, 0.0))
            mesh = manifold(
                shapes[k],
                distance=DISTANCE,
                scene=Scene(lights=light, material=MATTE),
                light="after" if n == 3 else "before",
                exponent="compensated" if compensated else 1,
            )
            assert isinstance(mesh, pv.PolyData)
            places = np.asarray(mesh.points) if n == 3 else shapes[k].points
            size = measures(places, shapes[k].cells)
            mean, contrast = statistics(np.asarray(mesh["luminance"]), size)
            found.append(Panel(k, n, compensated, mesh, mean, contrast))
    return found


def statistics(values: Array, weights: Array) -> tuple[float, float]:
    """Return the weighted mean of values, and their contrast (standard deviation over mean)."""
    mean = float(np.average(values, weights=weights))
    return mean, math.sqrt(np.average((values - mean) ** 2, weights=weights)) / mean


def measures(points: Array, cells: Indices) -> Array:
    """Return the length or area at each point; each cell is shared equally by its corners.

    Parameters
    ----------
    points : ndarray, shape (N, n)
        Positions of the points.
    cells : ndarray of int, shape (M, 2) or (M, 4)
        Indices of the points of segments or quadrilaterals. A quadrilateral is measured as two
        triangles.
    """
    corners = points[cells]
    if cells.shape[1] == 2:
        size = np.linalg.norm(corners[:, 1] - corners[:, 0], axis=1)
    else:
        size = np.zeros(len(cells))
        for b, c in ((1, 2), (2, 3)):
            u, v = corners[:, b] - corners[:, 0], corners[:, c] - corners[:, 0]
            uu, vv, uv = (np.einsum("ij,ij->i", *pair) for pair in ((u, u), (v, v), (u, v)))
            size += 0.5 * np.sqrt(np.maximum(uu * vv - uv**2, 0))
    share = np.repeat(size / cells.shape[1], cells.shape[1])
    return np.asarray(np.bincount(cells.ravel(), share, minlength=len(points)), dtype=np.float64)


def rows_of_panels(resolution: int) -> list[Row]:
    """Return one row for each panel."""
    found: list[Panel] = []
    seconds = take_turns({"panels": lambda: found.extend(panels(resolution))}, 1)["panels"]
    points = sum(panel.mesh.n_points for panel in found)
    return [
        Row(
            f"torus and curve, {'compensated' if p.compensated else 'plain'}",
            p.n - p.k,
            abs(p.mean - brightness.STANDARD),
            1e9 * seconds / points,
            {"k": p.k, "n": p.n, "mean": p.mean, "contrast (std / mean)": p.contrast},
        )
        for p in found
    ]


STUDY = Study(
    approximates="brightness 1/2 of a surface in 3-space by manifolds of any codimension",
    reference="1/2, the mean over all directions of light",
    parameter="codimension",
    error="difference of the mean from 1/2",
    cost="ns per point",
    steps=lambda quick: [partial(rows_of_panels, 48 if quick else 192)],
    axes=("parameter", "error"),
    curve=lambda row: Curve(row.way, f"k = {row.more['k']:g}"),
)
