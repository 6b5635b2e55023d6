"""What tests ask of the cells of lattices."""

import numpy as np

RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
EDGES = {
    4: RING,
    8: [*RING, *[(a + 4, b + 4) for a, b in RING], *[(i, i + 4) for i in range(4)]],
}
FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]


def pieces(cells, groups):
    return np.concatenate([np.sort(cells[:, list(group)], axis=1) for group in groups])


def faces_around(cells):
    """Return the number of cells on each facet: 2 everywhere if there is no boundary."""
    size = cells.shape[1]
    groups = {2: [(0,), (1,)], 4: EDGES.get(size, []), 8: FACES}[size]
    return np.unique(pieces(cells, groups), axis=0, return_counts=True)[1]
