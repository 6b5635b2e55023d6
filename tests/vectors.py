"""What tests do with vectors."""

import numpy as np


def unit(vectors):
    """Return vectors of length 1, as numbers of float64."""
    vectors = np.asarray(vectors, dtype=np.float64)
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def projector(frame):
    """Return the projection on the space of orthonormal rows."""
    return np.einsum("...ki,...kj->...ij", frame, frame)


def areas(corners):
    """Return the areas of triangles from their corners, shape (..., 3, 3)."""
    a, b, c = np.moveaxis(np.asarray(corners, dtype=np.float64), -2, 0)
    return np.linalg.norm(np.cross(b - a, c - a), axis=-1) / 2


def waves(points, frequency, seed):
    """Return a smooth field with saddles and vortices."""
    random = np.random.default_rng(seed)
    return sum(
        np.cos(points @ (frequency * random.normal(size=3)) + 6 * random.random())[:, np.newaxis]
        * random.normal(size=3)
        for _ in range(5)
    )


def parts(lines):
    """Return the points of each line of a mesh."""
    ends = np.cumsum([lines.get_cell(i).n_points for i in range(lines.n_cells)])
    return np.split(np.asarray(lines.points, dtype=np.float64), ends[:-1])
