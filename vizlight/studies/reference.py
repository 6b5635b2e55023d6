"""The same light as a plain NumPy script would write it: the yardstick of speed and error.

Nothing here is shared with the engine: whole arrays, one formula after the other, as a careful
user writes them, in the precision of the arrays that come in. In float64 it is the reference
for the error of float32 work; in float32 it is the baseline for its speed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.scene import Scene


def light(
    points: Array,
    tangents: Array | None,
    scene: Scene,
    /,
    *,
    normals: Array | None = None,
    exponent: float = 1.0,
    dtype: Any = np.float64,
) -> Array:
    """Return the luminance of lines, of a surface, or of lines conditioned by a surface.

    Ambient, diffuse and Phong's term: Banks (1), (2), (3), (5), (6).

    Parameters
    ----------
    points : ndarray, shape (N, n)
    tangents : ndarray, shape (N, n), or None
        Of any length but 0. None: the surface of the normals is lit, on its outer side.
    scene : Scene
        Lights without attenuation; a view.
    normals : ndarray, shape (N, n), optional
        Outward, of any length but 0.
    exponent : float, default: 1.0
        Of the diffuse term of lines.
    dtype : dtype, default: float64
        Of all arrays that are made.

    Returns
    -------
    ndarray, shape (N,)
    """
    kind, material = np.dtype(dtype).type, scene.material
    points = points.astype(dtype, copy=False)
    tangent = None if tangents is None else _unit(tangents.astype(dtype, copy=False))
    normal = None if normals is None else _unit(normals.astype(dtype, copy=False))
    wo = _directions(scene.view, points)
    total = np.full(len(points), material.ambient * scene.ambient_intensity, dtype=dtype)
    for lamp in (light.seen_from(scene.view) for light in scene.lights):
        wi = _directions(lamp, points)
        facing = None if normal is None else np.maximum(np.einsum("ij,ij->i", wi, normal), 0)
        if tangent is not None:
            wi_t = np.einsum("ij,ij->i", wi, tangent)
            wo_t = np.einsum("ij,ij->i", wo, tangent)
            wi_n = np.linalg.norm(wi - wi_t[:, np.newaxis] * tangent, axis=1)
            wo_n = np.linalg.norm(wo - wo_t[:, np.newaxis] * tangent, axis=1)
            diffuse = wi_n ** kind(exponent)
            mirror = wi_n * wo_n - wi_t * wo_t
            shadow = kind(1) if facing is None else facing
        else:
            assert normal is not None
            assert facing is not None
            reflected = 2 * facing[:, np.newaxis] * normal - wi
            diffuse = facing
            mirror = np.einsum("ij,ij->i", reflected, wo)
            shadow = (facing > 0).astype(dtype)
        specular = np.maximum(mirror, 0) ** kind(material.shininess)
        part = kind(material.diffuse) * diffuse + kind(material.specular) * specular
        total += kind(lamp.intensity) * shadow * part
    return total


def _unit(vectors: Array) -> Array:
    result: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return result


def _directions(owner: Any, points: Array) -> Array:
    if owner.position is None or getattr(owner, "parallel", False):
        toward = np.asarray(owner.direction, dtype=points.dtype)
        return np.broadcast_to(toward / np.linalg.norm(toward), points.shape)
    return _unit(np.asarray(owner.position, dtype=points.dtype) - points)
