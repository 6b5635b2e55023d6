"""What tests ask of bands: closed, outward, volume, area, and the error at random places."""

import numpy as np
from vectors import areas


def directed_edges(bands):
    size = np.diff(bands.offsets)
    after = np.arange(1, len(bands.corners) + 1)
    after[bands.offsets[1:] - 1] = bands.offsets[:-1]
    return np.stack([bands.corners, bands.corners[after]], axis=1), np.repeat(
        np.arange(len(size)), size
    )


def is_closed(bands):
    """Each edge has two polygons, which run along it in opposite directions."""
    edges, _ = directed_edges(bands)
    forth, count = np.unique(edges, axis=0, return_counts=True)
    back = np.unique(edges[:, ::-1], axis=0)
    return len(edges) > 0 and np.all(count == 1) and np.array_equal(forth, back)


def corners(bands):
    triangles, owner = bands.triangles()
    return bands.points[triangles], owner


def volume(bands):
    t, _ = corners(bands)
    return np.einsum("ij,ij->i", np.cross(t[:, 0], t[:, 1]), t[:, 2]).sum() / 6


def area(bands):
    return areas(corners(bands)[0]).sum()


def places(bands, random, count=4):
    """Return random places in the polygons, and the polygon of each."""
    t, owner = corners(bands)
    size = areas(t)
    # What has no area to speak of cannot be seen.
    t, owner = t[size > 1e-9 * size.max()], owner[size > 1e-9 * size.max()]
    weight = random.dirichlet([1, 1, 1], (count, len(t)))
    return np.einsum("nti,tij->ntj", weight, t).reshape(-1, 3), np.tile(owner, count)


def spread(bands, random, count):
    """Return random places spread evenly over the area, and the polygon of each."""
    t, owner = corners(bands)
    size = areas(t)
    chosen = random.choice(len(t), count, p=size / size.sum())
    weight = random.dirichlet([1, 1, 1], count)
    return np.einsum("ti,tij->tj", weight, t[chosen]), owner[chosen]


def lambert(points, normal, *, direction=None, position=None, power=1.0, attenuation=(1, 0, 0)):
    """Return ``0.1 + 0.8 cosine^power fading`` of one light, by the law itself."""
    toward = np.asarray(direction) + 0 * points if position is None else position - points
    d = np.linalg.norm(toward, axis=1)
    cosine = np.einsum("ij,ij->i", normal, toward) / d
    c1, c2, c3 = attenuation
    fading = 1 if position is None else np.minimum(1, 1 / (c1 + c2 * d + c3 * d * d))
    return 0.1 + 0.8 * np.maximum(cosine, 0) ** power * (cosine > 0) * fading
