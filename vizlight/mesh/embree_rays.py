"""All hits of many rays by Embree, where the package embreex is installed.

Embree finds the first hit of all rays at once, in float32. Further hits are first hits of rays
that start just behind; which triangle it is decides, the place is taken from it in float64.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from vizlight._types import Array, Indices

#: How far behind a hit the next ray starts, as a share of the mesh: what float32 can tell apart.
STEP = 1e-6
#: Rays that are stopped this often are in a mesh that Embree cannot resolve.
MOST = 10_000


def tree(corners: Array) -> Any | None:
    """Return Embree's search tree of triangles, shape (T, 3, 3), or None without the package."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    scene = EmbreeScene()
    TriangleMesh(scene, np.ascontiguousarray(corners, dtype=np.float32))
    return scene


def hits(
    scene: Any, corner: Array, normal: Array, size: float, start: Array, way: Array, reach: Array
) -> tuple[Indices, Indices]:
    """Return which rays hit which triangles, all of them.

    Parameters
    ----------
    scene : EmbreeScene
    corner, normal : ndarray, shape (T, 3)
        Of each triangle.
    size : float
        Of the mesh.
    start, way : ndarray, shape (N, 3)
    reach : ndarray, shape (N,)
    """
    row = np.arange(len(start))
    s = np.zeros(len(start))
    rays, cells = [], []
    for _ in range(MOST):
        begin = (start[row] + s[row, np.newaxis] * way[row]).astype(np.float32)
        found = scene.run(begin, way[row].astype(np.float32), output=True)
        there = found["primID"] >= 0
        row, cell = row[there], found["primID"][there].astype(np.intp)
        far = found["tfar"][there].astype(np.float64)
        rays.append(row)
        cells.append(cell)
        against = np.einsum("ij,ij->i", way[row], normal[cell])
        gap = np.einsum("ij,ij->i", corner[cell] - start[row], normal[cell])
        # On a triangle seen edge-on the place is Embree's.
        place = np.divide(gap, against, out=s[row] + far, where=against != 0)
        near = np.abs(place - s[row] - far) < 1e-3 * size
        s[row] = np.maximum(np.where(near, place, s[row] + far), s[row]) + STEP * size
        row = row[s[row] < reach[row]]
        if not len(row):
            break
    return np.concatenate(rays), np.concatenate(cells)
