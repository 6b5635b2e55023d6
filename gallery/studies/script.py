"""Light computed by a plain NumPy script, as the reference for speed and error.

The script shares no code with the engine. It applies one formula after the other to whole arrays,
as a careful user would write it. In float64 it is the reference for the error of float32; in
float32 it is the baseline for the speed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from vizlight._types import Array
    from vizlight.scene import Light, Scene, View


def light(
    points: Array,
    tangents: Array | None,
    scene: Scene,
    /,
    *,
    normals: Array | None = None,
    exponent: float = 1.0,
    dtype: type[np.float32] | type[np.float64] = np.float64,
) -> Array:
    """Return the luminance of lines, of a surface, or of lines conditioned by a surface.

    The terms are the ambient, the diffuse and the Phong term: Banks (1), (2), (3), (5), (6).

    Parameters
    ----------
    points : ndarray, shape (N, n)
        Positions of the points.
    tangents : ndarray, shape (N, n), or None
        Tangents of lines, of any length except 0. If None, the surface with the normals is lit
        on its outer side.
    scene : Scene
        Scene with a view and with lights without attenuation.
    normals : ndarray, shape (N, n), optional
        Outward normals, of any length except 0.
    exponent : float, default: 1.0
        Exponent of the diffuse term of lines.
    dtype : {float64, float32}, default: float64
        Floating type of the computation.

    Returns
    -------
    ndarray, shape (N,)
        Luminance.
    """
    material = scene.material
    points = points.astype(dtype, copy=False)
    tangent = None if tangents is None else _unit(tangents.astype(dtype, copy=False))
    normal = None if normals is None else _unit(normals.astype(dtype, copy=False))
    assert scene.view is not None
    wo = _directions(scene.view, points)
    total = np.full(len(points), material.ambient * scene.ambient_intensity, dtype=dtype)
    for source in (light.seen_from(scene.view) for light in scene.lights):
        wi = _directions(source, points)
        facing = None if normal is None else np.maximum(np.einsum("ij,ij->i", wi, normal), 0)
        if tangent is not None:
            wi_t = np.einsum("ij,ij->i", wi, tangent)
            wo_t = np.einsum("ij,ij->i", wo, tangent)
            wi_n = np.linalg.norm(wi - wi_t[:, np.newaxis] * tangent, axis=1)
            wo_n = np.linalg.norm(wo - wo_t[:, np.newaxis] * tangent, axis=1)
            diffuse = wi_n ** dtype(exponent)
            mirror = wi_n * wo_n - wi_t * wo_t
            shadow = dtype(1) if facing is None else facing
        else:
            assert normal is not None
            assert facing is not None
            reflected = 2 * facing[:, np.newaxis] * normal - wi
            diffuse = facing
            mirror = np.einsum("ij,ij->i", reflected, wo)
            shadow = (facing > 0).astype(dtype)
        specular = np.maximum(mirror, 0) ** dtype(material.shininess)
        part = dtype(material.diffuse) * diffuse + dtype(material.specular) * specular
        total += dtype(source.intensity) * shadow * part
    return total


def _unit(vectors: Array) -> Array:
    result: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return result


def _directions(owner: Light | View, points: Array) -> Array:
    """Return the unit directions from the points toward a light or an eye."""
    if owner.position is None or getattr(owner, "parallel", False):
        toward = np.asarray(owner.direction, dtype=points.dtype)
        return np.broadcast_to(toward / np.linalg.norm(toward), points.shape)
    return _unit(np.asarray(owner.position, dtype=points.dtype) - points)
