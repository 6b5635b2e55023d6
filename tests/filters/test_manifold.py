"""Shapes as meshes: cells by dimension, arrays kept, light on them."""

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from refusals import refusals
from shapes import klein_bottle, sphere3, torus_curve

import vizlight
from vizlight import Light, Scene, View
from vizlight.geometry import manifolds


@pytest.mark.parametrize(
    ("shape", "kind", "cells"),
    [
        (torus_curve(3), pv.PolyData, {pv.CellType.LINE: 50}),
        (manifolds.torus(1.0, resolution=9), pv.PolyData, {pv.CellType.LINE: 9}),
        (klein_bottle(6, 5), pv.PolyData, {pv.CellType.QUAD: 30}),
        (sphere3(2), pv.UnstructuredGrid, {pv.CellType.HEXAHEDRON: 64}),
    ],
)
def test_cells_and_arrays(shape, kind, cells):
    mesh = vizlight.manifold(shape)
    assert isinstance(mesh, kind)
    grid = mesh.cast_to_unstructured_grid()
    kinds, numbers = np.unique(grid.celltypes, return_counts=True)
    assert dict(zip(kinds.tolist(), numbers.tolist(), strict=True)) == cells
    np.testing.assert_array_equal(grid.cells_dict[next(iter(cells))], shape.cells)
    np.testing.assert_array_equal(mesh["position"], shape.points)
    np.testing.assert_array_equal(mesh["frame"], shape.frame.reshape(mesh.n_points, -1))
    assert mesh.n_points == len(shape.points)
    width = min(shape.n, 3)
    np.testing.assert_array_equal(mesh.points[:, :width], shape.points[:, :width])


@pytest.mark.parametrize(
    ("shape", "name"),
    [(klein_bottle(8, 8), "a.vtp"), (sphere3(2), "a.vtu")],
)
def test_every_array_survives_a_file(shape, name, tmp_path):
    mesh = vizlight.manifold(shape, rotation=("xw", 0.4))
    mesh.save(tmp_path / name)
    again = pv.read(tmp_path / name)
    for key in mesh.point_data:
        np.testing.assert_array_equal(again[key], mesh[key])
    assert vizlight.provenance(again, "projection") == vizlight.provenance(mesh, "projection")


def test_every_shape_is_lit_in_its_own_space():
    for shape in (
        torus_curve(3),
        klein_bottle(8, 8),
        sphere3(2),
        manifolds.torus(1.0, 1.0, 1.0, resolution=4),
    ):
        toward = np.arange(1.0, shape.n + 1)
        scene = Scene(lights=Light(direction=toward), view=View(direction=toward[::-1]))
        mesh = vizlight.manifold(shape, scene=scene)
        assert "luminance_valid" not in mesh.point_data
        assert mesh["luminance"].min() >= 0.1
        assert np.ptp(mesh["luminance"]) > 0.05


def test_order_2_in_the_size_of_cells():
    """Light in the middle of a cell, by the mean of its corners, against the exact light there."""
    errors, sizes = [], [32, 64, 128, 256]
    scene = far((0.7, 0.6, 0.38, 0.2), (0, 0.2, 1, 0))
    for size in sizes:
        mesh, fine = (
            vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=n), scene=scene)
            for n in (size, 2 * size)
        )
        between = mesh["luminance"][mesh.regular_faces].mean(axis=1)
        exact = fine["luminance"].reshape(2 * size, 2 * size)[1::2, 1::2].ravel()
        errors.append(np.abs(between - exact).max())
    order = -np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert abs(order - 2) < 0.2


test_not_a_shape = refusals(
    vizlight.manifold,
    (pv.Sphere(), "shape: expected a vizlight.geometry.manifolds.Manifold"),
    (lambda u, v: (u, v, u * v, 0), r"got a function; sample it by manifolds\.parametric\("),
    kind=TypeError,
)
