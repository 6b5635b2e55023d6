"""The same light as a plain NumPy script would write it: the yardstick of speed and error.

Nothing here is shared with the engine: whole arrays, one formula after the other, as a careful
user writes them, in the precision of the arrays that come in. In float64 it is the reference
for the error of float32 work; in float32 it is the baseline for its speed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight.scene import Scene

    Array = NDArray[np.floating[Any]]


def line_light(points: Array, tangents: Array, scene: Scene, /, *, exponent: float) -> Array:
    """Return the luminance of lines: ambient, diffuse and Phong's term (Banks 1, 2, 3, 5).

    Parameters
    ----------
    points, tangents : ndarray, shape (N, n)
        Positions, and tangents of any length but 0, of one floating type.
    scene : Scene
        Lights without attenuation; a view.
    exponent : float
        Of the diffuse term.

    Returns
    -------
    ndarray, shape (N,)
        Of the type of the points.
    """
    kind, material = points.dtype.type, scene.material
    tangent = tangents / np.linalg.norm(tangents, axis=1, keepdims=True)
    wo = _directions(scene.view, points)
    wo_t = np.einsum("ij,ij->i", wo, tangent)
    wo_n = np.linalg.norm(wo - wo_t[:, np.newaxis] * tangent, axis=1)
    total = np.full(len(points), material.ambient * scene.ambient_intensity, dtype=kind)
    for light in scene.lights:
        wi = _directions(light, points)
        wi_t = np.einsum("ij,ij->i", wi, tangent)
        wi_n = np.linalg.norm(wi - wi_t[:, np.newaxis] * tangent, axis=1)
        mirror = np.maximum(wi_n * wo_n - wi_t * wo_t, 0)
        total += kind(light.intensity * material.diffuse) * wi_n ** kind(exponent)
        total += kind(light.intensity * material.specular) * mirror ** kind(material.shininess)
    return total


def _directions(owner: Any, points: Array) -> Array:
    if owner.position is None or getattr(owner, "parallel", False):
        toward = np.asarray(owner.direction, dtype=points.dtype)
        return np.broadcast_to(toward / np.linalg.norm(toward), points.shape)
    toward = np.asarray(owner.position, dtype=points.dtype) - points
    result: Array = toward / np.linalg.norm(toward, axis=1, keepdims=True)
    return result
