"""Pictures of samples, and what faces paint over them."""

import numpy as np
from matplotlib.path import Path

SCALE = 3
GROUND = np.array([300.0])


def grid(width=120, height=100):
    """Return the places of samples in pixels."""
    y, x = (np.mgrid[: height * SCALE, : width * SCALE] + 0.5) / SCALE
    return x, y


def ball(radius=40.0):
    """Return the light of a ball in the light of the eye, in the middle of a picture."""
    x, y = grid()
    square = ((x - 60) ** 2 + (y - 50) ** 2) / radius**2
    light = 255 * np.sqrt(np.maximum(1 - square, 0))
    return np.where(square < 1, light, GROUND)[..., np.newaxis].astype(np.float32)


def painted(samples, found, ground):
    """Return the colours that faces paint at the middles of samples, -1 where none does."""
    x, y = grid()
    places = np.stack([x.ravel(), y.ravel()], axis=1)
    colors = np.full((len(places), samples.shape[2]), -1.0)
    for face in found:
        rings = [np.concatenate([ring, ring[:1]]) for ring in face.rings]
        winding = sum(
            Path(ring, closed=True).contains_points(places) * np.sign(area(ring)) for ring in rings
        )
        colors[winding != 0] = face.color
    return colors.reshape(samples.shape)


def area(ring):
    x, y = ring.T
    return 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
