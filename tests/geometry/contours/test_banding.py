"""The cutter: polygons tile their triangles, contours join, closed stays closed."""

import banded
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from vectors import areas

from vizlight.geometry.contours import banding, refinement, spacing
from vizlight.geometry.solids import triangle_mesh
from vizlight.geometry.solids.primitives import Block, Frustum, Sphere


def soup(seed, count=12):
    """Return a closed triangulation with random values at its points."""
    random = np.random.default_rng(seed)
    mesh = triangle_mesh.mesh(Sphere(), count)
    return mesh.points, mesh.triangles, random.uniform(0, 1, len(mesh.points))


@pytest.mark.slow
@given(st.integers(0, 2**32 - 1), st.integers(1, 30))
def test_polygons_tile_the_triangles(seed, count):
    points, triangles, values = soup(seed)
    steps = spacing.steps(count, 0.0, 1.0)
    made, owner = banding.cut(points, triangles, values[triangles], steps)
    assert banded.is_closed(made)
    t, polygon = banded.corners(made)
    tiled = np.bincount(owner[polygon], areas(t), len(triangles))
    np.testing.assert_allclose(tiled, areas(points[triangles]), rtol=1e-9)


@pytest.mark.slow
@given(st.integers(0, 2**32 - 1), st.integers(2, 20))
def test_bands_hold_what_linear_interpolation_says(seed, count):
    points, triangles, values = soup(seed)
    steps = spacing.steps(count, 0.0, 1.0)
    made, owner = banding.cut(points, triangles, values[triangles], steps)
    place, polygon = banded.places(made, np.random.default_rng(seed), 2)
    corner = points[triangles[owner[polygon]]]
    weight = np.einsum("tij,ti->tj", np.linalg.pinv(corner), place)
    linear = np.einsum("ti,ti->t", weight, values[triangles[owner[polygon]]])
    assert np.abs(linear - made.values[polygon]).max() <= steps.error + 1e-7


def test_contour_lines_are_closed_curves():
    points, triangles, values = soup(5)
    made, _ = banding.cut(points, triangles, values[triangles], spacing.steps(6, 0.0, 1.0))
    for level in made.levels:
        ends = made.lines[made.line_levels == level]
        assert len(ends) > 2
        np.testing.assert_array_equal(np.unique(ends.ravel(), return_counts=True)[1] % 2, 0)


def test_corners_on_a_level_make_no_empty_polygons():
    points, triangles, values = soup(6)
    values = np.round(values * 4) / 4
    made, _ = banding.cut(points, triangles, values[triangles], spacing.steps(4, 0.0, 1.0))
    assert banded.is_closed(made)
    t, owner = banded.corners(made)
    size = areas(t)
    assert np.bincount(owner, size).min() > 1e-3 * size.mean()


def test_one_value_everywhere():
    points, triangles, _ = soup(7)
    made, _ = banding.cut(
        points, triangles, np.full(triangles.shape, 0.3), spacing.steps(4, 0.3, 0.3)
    )
    assert len(made.values) == len(triangles)
    assert np.all(made.values == 0.3)
    assert len(made.lines) == 0


def test_a_luminance_that_is_not_monotone_along_an_edge():
    """Brackets keep the order of the levels: still one polygon a band, and closed."""
    points, triangles, _ = soup(8, 8)

    def wave(p):
        return 0.5 + 0.5 * np.sin(9 * p[:, 0]) * np.cos(7 * p[:, 1])

    def along(a, b, t, _):
        places = points[a][:, None] * (1 - t[..., None]) + points[b][:, None] * t[..., None]
        return wave(places.reshape(-1, 3)).reshape(t.shape)

    values = wave(points)
    made, _ = banding.cut(
        points, triangles, values[triangles], spacing.steps(12, 0.0, 1.0), luminance=along
    )
    assert banded.is_closed(made)
    on = np.unique(made.lines)
    gap = np.abs(wave(made.points[on])[:, None] - made.steps.edges).min(axis=1)
    assert np.quantile(gap, 0.99) < 1e-10


@pytest.mark.parametrize("pattern", range(8))
def test_split_of_each_pattern(pattern):
    corners = np.array([[0.0, 0], [1, 0], [0, 1]])
    ends = [(0, 1), (1, 2), (2, 0)]
    middles = np.array([[3 + i if pattern >> i & 1 else -1 for i in range(3)]])
    points = np.concatenate([corners, [(corners[a] + corners[b]) / 2 for a, b in ends]])
    made, owner = triangle_mesh.split(np.array([[0, 1, 2]]), middles)
    a, b, c = (points[made[:, i]] for i in range(3))
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    assert np.all(area > 0)
    assert area.sum() == pytest.approx(1)
    assert len(made) == 1 + bin(pattern).count("1")
    assert np.all(owner == 0)


def spot(points, normals):
    """A diffuse term, and a highlight by R . E."""
    light, eye = np.array([0.6, 0, 0.8]), np.array([0, 0.6, 0.8])
    cosine = normals @ light
    mirror = np.maximum(2 * cosine * (normals @ eye) - light @ eye, 0)
    return 0.1 + 0.5 * np.maximum(cosine, 0) + 0.4 * mirror**30 * (cosine > 0)


@pytest.mark.parametrize("levels_", [10, 0.03, [0.2, 0.5, 0.8]])
def test_diffuse_and_specular_together(levels_, random):
    """Contours found by roots, against the law at random places of the true sphere."""
    made = refinement.draw(triangle_mesh.mesh(Sphere(), 24), spot, levels_, low=0.1)
    assert banded.is_closed(made)
    place, polygon = banded.places(made, random, 6)
    normal = place / np.linalg.norm(place, axis=1, keepdims=True)
    error = np.abs(spot(place, normal) - made.values[polygon])
    allowed = levels_ if isinstance(levels_, float) else 1.15 * made.steps.error
    assert np.quantile(error, 0.999) <= allowed
    assert made.error <= allowed
    on = np.unique(made.lines)
    normal = made.points[on] / np.linalg.norm(made.points[on], axis=1, keepdims=True)
    gap = np.abs(spot(None, normal)[:, None] - made.steps.edges).min(axis=1)
    # At the terminator the highlight is cut off: there its contours meet in a jump.
    assert np.quantile(gap, 0.9) < 1e-12


def test_empty_shapes():
    for solid in (Sphere(radius=0), Frustum(radii=(0, 0)), Block(size=(0, 0, 1))):
        made = refinement.draw(triangle_mesh.mesh(solid, 24), spot, 5, low=0.1)
        assert len(made.values) == len(made.normals()) == 0
        assert made.error == 0
