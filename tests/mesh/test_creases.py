"""Creases of surfaces as lines."""

import numpy as np
import pytest
import pyvista as pv

from vizlight import files


def test_creases_of_a_box_are_its_edges_and_a_ball_has_none():
    block = pv.Box().triangulate().subdivide(2, subfilter="linear")
    edges = files.creases(block)
    assert edges.n_cells == 12 * 4
    assert np.isclose(np.abs(edges.points), 1.0).sum(axis=1).min() == 2
    assert not files.creases(pv.Sphere()).n_cells
    # Faces that are wound against their neighbours make no crease.
    faces = block.regular_faces.copy()
    faces[::3] = faces[::3, ::-1]
    assert files.creases(pv.PolyData.from_regular_faces(block.points, faces)).n_cells == 12 * 4
    # Polylines beside the faces count for nothing.
    lines = np.insert(np.arange(180).reshape(-1, 3) % block.n_points, 0, 3, axis=1).ravel()
    beside = pv.PolyData(block.points, faces=np.insert(faces, 0, 3, axis=1).ravel(), lines=lines)
    assert files.creases(beside).n_cells == 12 * 4
    # Faces that are there twice have no edge between two faces alone.
    twice = pv.PolyData(block.points, np.concatenate([block.faces, block.faces]))
    assert not files.creases(twice).n_cells


def test_points_are_put_in_order_only_where_some_are_stored_twice(calls_of):
    """Indices of a sort of all points take six times as long as to see that all places differ."""
    calls = calls_of(np, "unique")
    block = pv.Box().triangulate().subdivide(3, subfilter="linear")
    edges = files.creases(block)
    assert max((len(values) for values, *_ in calls), default=0) < block.n_points
    apart = block.compute_normals(split_vertices=True, feature_angle=30)
    assert apart.n_points > block.n_points
    again = files.creases(apart)
    assert apart.n_points in [len(values) for values, *_ in calls]
    assert edges.n_cells == again.n_cells == 12 * 8
    assert {*map(tuple, edges.points)} == {*map(tuple, again.points)}


def test_a_strip_with_one_side_has_no_crease_where_its_faces_turn_over():
    turn, across = np.meshgrid(np.arange(60) * np.pi / 30, [-0.3, 0, 0.3], indexing="ij")
    far = 1 + across * np.cos(turn / 2)
    rows = [far * np.cos(turn), far * np.sin(turn), across * np.sin(turn / 2)]
    points = np.stack(rows, axis=-1).reshape(-1, 3)
    here = np.arange(180).reshape(60, 3)
    # The end is joined to the start upside down.
    there = np.vstack([here[1:], here[:1, ::-1]])
    faces = np.stack([here[:, :-1], there[:, :-1], there[:, 1:], here[:, 1:]], axis=-1)
    strip = pv.PolyData.from_regular_faces(points, faces.reshape(-1, 4))
    assert not files.creases(strip).n_cells
    bent = strip.copy()
    bent.points[30 * 3 : 31 * 3] *= 0.8
    assert files.creases(bent).n_cells == 2 * 3


def test_edges_that_connect_to_no_length_are_roughness():
    ground = pv.Plane(i_resolution=40, j_resolution=40).triangulate()
    points = ground.points.copy()
    points[:, 2] = np.abs(points[:, 0])
    # One tip, whose edges are as long as two cells.
    points[41 * 20 + 10, 2] += 0.03
    ground.points = points
    edges = files.creases(ground)
    assert edges.n_cells == 40
    assert np.abs(edges.points[:, 0]).max() < 1e-6


def test_small_holes_and_creases_between_points_stored_twice_are_drawn():
    """A plate with a small hole: its rim, 24 edges, is much shorter than the plate."""
    plate = pv.Disc(inner=0.02, outer=1.0, c_res=24, r_res=1).extrude((0, 0, 0.1), capping=True)
    plate = plate.triangulate().clean()
    edges = files.creases(plate)
    assert edges.n_cells == 4 * 24
    assert np.linalg.norm(edges.points[:, :2], axis=1).min() < 0.021
    split = plate.compute_normals(feature_angle=30, split_vertices=True)
    assert split.n_points > plate.n_points
    assert files.creases(split).n_cells == 4 * 24


def test_borders_are_those_of_holes_and_not_of_cracks():
    ball = pv.Sphere(theta_resolution=90, phi_resolution=90)
    assert not files.borders(ball).n_cells
    heights = np.asarray(ball.cell_centers().points)[:, 2]
    keep = heights < 0.45
    open_ball = ball.extract_cells(keep).extract_surface(algorithm="dataset_surface")
    edges = files.borders(open_ball)
    assert edges.n_cells == 90
    # A face that is missing is a crack.
    keep[np.flatnonzero(np.abs(heights) < 0.01)[0]] = False
    cracked = ball.extract_cells(keep).extract_surface(algorithm="dataset_surface")
    np.testing.assert_allclose(files.borders(cracked).points, edges.points)
    # Faces that share no points have seams for borders.
    assert not files.borders(pv.Cube()).n_cells


@pytest.mark.parametrize("function", [files.creases, files.borders])
def test_other_meshes_are_refused(function):
    with pytest.raises(TypeError, match=r"^surface: expected a pyvista\.PolyData, got"):
        function(pv.ImageData(dimensions=(2, 2, 2)))
