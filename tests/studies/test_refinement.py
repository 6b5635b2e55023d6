"""Adaptive refinement needs a third of the points of a uniform one, on real meshes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import pyvista as pv

from studies import refinement


@cache
def rows_of(name):
    return refinement.measure(name, (0.02, 0.01), (1, 2, 3, 4, 6, 8, 12, 16, 24))


@pytest.mark.parametrize("name", ["isosurface", "flow on it", "fibres", "aeroplane", "globe"])
def test_a_third_of_the_points(name):
    rows = rows_of(name)
    assert refinement.share(rows, name) < 1 / 3
    fine = [row for row in rows if row.way.endswith(refinement.ADAPTIVE)]
    assert all(row.error < 1.6 * row.parameter for row in fine)
    assert fine[0].cost <= fine[1].cost


def test_the_points_of_a_uniform_refinement_are_counted():
    mesh = pv.Icosphere(nsub=1)
    for times in (1, 2, 4):
        fine = mesh.subdivide(int(np.log2(times)), "linear") if times > 1 else mesh
        assert refinement.uniform_size(mesh.regular_faces, times) == fine.n_points
    segments = np.array([[0, 1], [1, 2]])
    assert refinement.uniform_size(segments, 4) == 9


def test_the_verdict_names_the_range_and_what_is_not_reached():
    rows = [*rows_of("globe"), *rows_of("isosurface")]
    shares = [100 * refinement.share(rows, name) for name in ("globe", "isosurface")]
    said = refinement.verdict(rows)
    assert refinement.span(shares) in said
    assert "does not reach" not in said
    coarse = [row for row in rows if row.way != "globe, uniform" or row.parameter < 4]
    assert said.split(" % ")[0] != refinement.verdict(coarse).split(" % ")[0]
    assert "does not reach that for: globe" in refinement.verdict(coarse)
