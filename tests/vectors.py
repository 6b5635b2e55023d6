"""What tests do with vectors."""

import numpy as np


def unit(vectors):
    """Return vectors of length 1, as numbers of float64."""
    vectors = np.asarray(vectors, dtype=np.float64)
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
