"""Adaptive refinement needs a third of the points of a uniform one, on real meshes."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from studies import refinement


@pytest.mark.parametrize("name", ["isosurface", "flow on it", "fibres", "aeroplane", "globe"])
def test_a_third_of_the_points(name):
    rows = refinement.measure(name, (0.02, 0.01), (1, 2, 3, 4, 6, 8, 12, 16, 24))
    fine = [row for row in rows if row.way.endswith(refinement.ADAPTIVE)]
    even = [row for row in rows if row.way.endswith(refinement.UNIFORM)]
    assert all(row.error < 1.6 * row.parameter for row in fine)
    assert fine[0].cost <= fine[1].cost
    assert fine[1].cost < min(row.cost for row in even if row.error <= fine[1].error) / 3


def test_the_points_of_a_uniform_refinement_are_counted():
    mesh = pv.Icosphere(nsub=1)
    for times in (1, 2, 4):
        fine = mesh.subdivide(int(np.log2(times)), "linear") if times > 1 else mesh
        assert refinement.uniform_size(mesh.regular_faces, times) == fine.n_points
    segments = np.array([[0, 1], [1, 2]])
    assert refinement.uniform_size(segments, 4) == 9


@pytest.mark.parametrize("s", [2, 3])
@pytest.mark.parametrize("factor", [1, 2, 5])
def test_smaller_cells_hold_the_places(s, factor, random):
    weights = random.dirichlet(np.ones(s), 500)
    within, share = refinement.sub_cells(weights, factor)
    assert np.min(share) > -1e-12
    np.testing.assert_allclose(share.sum(axis=1), 1)
    np.testing.assert_allclose(within.sum(axis=2), 1)
    np.testing.assert_allclose(np.einsum("ms,msr->mr", share, within), weights)
    np.testing.assert_allclose(within * factor, np.rint(within * factor), atol=1e-9)
