"""Points at one place that triangles without area join have one light; others keep their own."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv
from scipy.spatial import cKDTree

import vizlight
from vizlight.mesh.normals import split_edges
from vizlight.reading import joints
from vizlight.reading.normals import computed_normals


def ball(dtype, *, image=True, n=21, level=49):
    """Return an isosurface through nodes of a grid, which stands there up to three times."""
    half = (n - 1) // 2
    grid = pv.ImageData(dimensions=(n, n, n), origin=3 * (-half,))
    grid["f"] = np.sum(np.asarray(grid.points) ** 2, axis=1).astype(dtype)
    grid = grid if image else grid.cast_to_unstructured_grid()
    method = "flying_edges" if image else "contour"
    surface = grid.contour([level], scalars="f", compute_normals=False, method=method)
    surface.clear_data()
    return surface


def spread(points, values):
    """Return how many points stand at a place again, and how far values at one place differ."""
    places, number = np.unique(points, axis=0, return_inverse=True)
    low, high = np.full((2, len(places)), np.inf)
    np.minimum.at(low, number.ravel(), values)
    np.minimum.at(high, number.ravel(), -values)
    return len(points) - len(places), (-high - low).max()


@pytest.mark.parametrize("image", [True, False])
@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_an_isosurface_through_nodes_has_one_light_at_a_place(dtype, image):
    surface = ball(dtype, image=image)
    lit = vizlight.illuminate(surface)
    again, difference = spread(np.asarray(lit.points), np.asarray(lit["luminance"]))
    assert again > 50
    assert difference < 1e-6


@pytest.mark.parametrize("image", [True, False])
@pytest.mark.parametrize("ulps", [1, 4, 100])
def test_points_that_lie_apart_by_rounding_have_one_light(ulps, image):
    """Rounding of the field moves the points off the node, each along its own edge."""
    worst = 0.0
    for seed in range(6):
        random = np.random.default_rng(seed)
        n, level = ((41, 144), (21, 49))[seed % 2]
        grid = pv.ImageData(dimensions=(n, n, n), origin=3 * (-(n // 2),))
        values = np.sum(np.asarray(grid.points) ** 2, axis=1).astype("f4")
        grid["f"] = values + ulps * np.spacing(values) * random.integers(-1, 2, len(values)).astype(
            "f4"
        )
        grid = grid if image else grid.cast_to_unstructured_grid()
        method = "flying_edges" if image else "contour"
        surface = grid.contour([level], scalars="f", compute_normals=False, method=method)
        surface.clear_data()
        lit = np.asarray(vizlight.illuminate(surface)["luminance"])
        near = cKDTree(surface.points).query_pairs(1e-3, output_type="ndarray")
        assert len(near) > 50
        worst = max(worst, np.abs(lit[near[:, 0]] - lit[near[:, 1]]).max())
    assert worst < 1e-3


def test_points_along_a_row_of_slivers_keep_their_own_normals():
    """Facets of a fan are as thin as slivers, but the points of the row are not at one place."""
    angle = np.linspace(0, 0.5, 2001)
    rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    points = np.concatenate([rim, np.add(rim, (0, 0, 1.0))])
    i = np.arange(2000)
    lower = np.stack([i, i + 1, i + 2001], axis=1)
    faces = np.concatenate([lower, np.stack([i + 1, i + 2002, i + 2001], axis=1)])
    fan = pv.PolyData.from_regular_faces(points, faces)
    assert joints.joined(fan.points, fan) is not None
    found = computed_normals(fan).vectors[:2001]
    assert np.einsum("ij,ij->i", np.abs(found), np.abs(rim)).min() > 1 - 1e-6


def test_normals_are_those_of_the_clean_surface():
    surface = ball("f8")
    clean = surface.clean()
    assert clean.n_points < surface.n_points
    row = cKDTree(clean.points).query(surface.points)[1]
    found, expected = computed_normals(surface), computed_normals(clean)
    np.testing.assert_allclose(found.vectors, expected.vectors[row], atol=2e-3)
    assert not found.any_open


def test_an_open_isosurface_shows_one_side_at_a_place():
    whole = ball("f4")
    faces = whole.regular_faces
    bowl = pv.PolyData.from_regular_faces(
        whole.points, faces[whole.points[faces][..., 2].min(axis=1) >= 0]
    ).remove_unused_points()
    lit = vizlight.illuminate(bowl, vizlight.Scene(view=vizlight.View(direction=(1, 0.2, 0.1))))
    again, difference = spread(np.asarray(lit.points), np.asarray(lit["luminance"]))
    assert again > 20
    assert difference < 1e-6


def test_several_meshes_at_one_place_keep_their_own():
    lit = vizlight.illuminate(pv.MultiBlock([ball("f4"), ball("f4", level=81)]))
    alone = vizlight.illuminate(ball("f4", level=81))
    np.testing.assert_allclose(lit[1]["luminance"], alone["luminance"], atol=1e-6)


def test_separate_triangles_and_split_edges_stay_apart():
    sphere = pv.Sphere()
    corners = sphere.points[sphere.regular_faces].reshape(-1, 3)
    soup = pv.PolyData.from_regular_faces(corners, np.arange(len(corners)).reshape(-1, 3))
    found = computed_normals(soup).vectors
    np.testing.assert_allclose(np.abs(found[::3]), np.abs(soup.face_normals), atol=1e-5)
    cube = split_edges(pv.Cube().triangulate().clean(), 30)
    cube.clear_data()
    found = computed_normals(cube).vectors
    np.testing.assert_allclose(np.sort(np.abs(found), axis=1), [[0, 0, 1]] * 24, atol=1e-6)


def test_the_tip_of_a_cone_keeps_the_normals_of_its_sides():
    """Triangles without area join its points too, but no normal would fit all of them."""
    angle, height = np.meshgrid(np.linspace(0, 2 * np.pi, 25), [0.0, 0.5, 1.0])
    x, y = height * np.cos(angle), height * np.sin(angle)
    x[0] = y[0] = 0
    cone = pv.StructuredGrid(x, y, height).extract_surface(algorithm="geometry").triangulate()
    cone.clear_data()
    tip = ~np.any(cone.points, axis=1)
    assert tip.sum() == 25
    found = computed_normals(cone).vectors[tip]
    lit = np.any(found, axis=1)
    assert lit.sum() >= 24
    np.testing.assert_allclose(np.abs(found[lit, 2]), 0.5**0.5, atol=0.05)
