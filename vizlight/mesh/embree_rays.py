"""All hits of many rays by Embree, if the package embreex is installed.

Embree finds the first hit of all rays in one call, in float32. The next hits are the first hits
of rays that start just behind the previous ones. Embree gives the triangle that is hit; the
distance is computed from the triangle in float64.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from embreex.rtcore_scene import EmbreeScene

    from vizlight._types import Array, Indices

#: Distance from a hit to the start of the next ray, as a share of the size of the mesh: what
#: float32 resolves.
STEP = 1e-6
#: Largest number of hits of a ray: a ray with more is in a mesh that Embree cannot resolve.
MOST = 10_000


def tree(corners: Array) -> EmbreeScene | None:
    """Return Embree's search tree of triangles, shape (T, 3, 3); None without embreex."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    scene = EmbreeScene()
    TriangleMesh(scene, np.ascontiguousarray(corners, dtype=np.float32))
    return scene


def hits(
    scene: EmbreeScene,
    corner: Array,
    normal: Array,
    size: float,
    start: Array,
    way: Array,
    reach: Array,
) -> tuple[Indices, Indices]:
    """Return the ray and the triangle of every hit.

    Parameters
    ----------
    scene : EmbreeScene
    corner, normal : ndarray, shape (T, 3)
        One corner and the normal of each triangle.
    size : float
        Size of the mesh.
    start, way : ndarray, shape (N, 3)
        Starting points and unit directions of the rays.
    reach : ndarray, shape (N,)
        Lengths of the rays.
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
        # Along the plane of a triangle there is no such distance, so Embree's is used.
        place = np.divide(gap, against, out=s[row] + far, where=against != 0)
        near = np.abs(place - s[row] - far) < 1e-3 * size
        s[row] = np.maximum(np.where(near, place, s[row] + far), s[row]) + STEP * size
        row = row[s[row] < reach[row]]
        if not len(row):
            break
    return np.concatenate(rays), np.concatenate(cells)
