"""The visible cells of a picture against rays through its pixels."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.draw.cameras import camera_on
from vizlight.observers import pixels
from vizlight.observers.pixels import Cells
from vizlight.observers.samples import rays, weights

pytestmark = pytest.mark.opengl


def seen(meshes, camera, size=(300, 200)):
    parts = [Cells(mesh.GetPoints(), mesh.regular_faces, 1.0) for mesh in meshes]
    return pixels.visible(parts, camera, size)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("offset", [0.0, 5e6])
def test_a_pixel_shows_the_cell_that_its_ray_meets_first(parallel, offset):
    ball = pv.Icosphere(nsub=3, center=(offset, 0, 0))
    ball.points = ball.points.astype(np.float64)
    small = pv.Icosphere(nsub=1, radius=0.4, center=(offset + 1, 1, 1))
    small.points = small.points.astype(np.float64)
    meshes = [ball, small]
    camera = camera_on(pv.MultiBlock(meshes), (1, 0.8, 1), parallel=parallel)
    found = seen(meshes, camera)
    pick = np.random.default_rng(0).permutation(len(found.part))[:200]
    sight = rays(camera, found.at[pick])
    right = 0
    for i, origin, way in zip(pick, *sight, strict=True):
        hits = []
        for number, mesh in enumerate(meshes):
            places, cells = mesh.ray_trace(origin, origin + 20 * way)
            hits += [
                (float((place - origin) @ way), number, cell)
                for place, cell in zip(places, cells, strict=True)
            ]
        right += bool(hits) and min(hits)[1:] == (found.part[i], found.cell[i])
    # Rounding to pixels may give a neighbour at an edge.
    assert right > 190


def test_places_lie_on_the_lines_of_sight():
    random = np.random.default_rng(1)
    camera = camera_on((-1, 1, -1, 1, -1, 1), (1, 2, 3))
    at = random.uniform(-0.3, 0.3, (500, 2))
    origin, way = rays(camera, at)
    share = random.dirichlet(np.ones(3), 500)
    middle = origin + random.uniform(2, 6, (500, 1)) * way
    corners = random.normal(size=(500, 3, 3))
    corners += (middle - np.einsum("ms,msn->mn", share, corners))[:, np.newaxis]
    np.testing.assert_allclose(weights(corners, origin, way), share, atol=1e-8)
    ends = corners[:, :2]
    found = weights(ends, origin, way)
    assert np.all(found >= 0)
    place = np.einsum("ms,msn->mn", found, ends) - origin
    off = np.linalg.norm(np.cross(place, way), axis=1)
    for share in (0.2, 0.5, 0.9):  # no other place on the segment is nearer
        other = share * ends[:, 0] + (1 - share) * ends[:, 1] - origin
        assert np.all(off <= np.linalg.norm(np.cross(other, way), axis=1) + 1e-12)


def test_more_cells_than_colors_take_several_pictures(monkeypatch):
    ball = pv.Icosphere(nsub=3)
    camera = camera_on(ball)
    whole = seen([ball], camera)
    monkeypatch.setattr(pixels, "BITS", 8)
    parts = seen([ball], camera)
    np.testing.assert_array_equal(whole.cell, parts.cell)
    assert len(np.unique(whole.cell)) > 300
