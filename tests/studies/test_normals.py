"""The study of normals measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np
import pytest

from studies import normals


@pytest.mark.parametrize("function", [normals.ellipsoid, normals.gyroid, normals.hills])
def test_normals_by_corners_are_closer_and_both_converge(function):
    coarse, fine = (normals.normal_errors(function, n, repeats=1) for n in (20, 40))
    for rows in (coarse, fine):
        vtk, own = rows
        assert [row.way.split(", ")[1] for row in rows] == ["VTK", "by corners"]
        assert own.error < 0.75 * vtk.error
        assert own.error < own.more["99 %"]
    for before, after in zip(coarse, fine, strict=True):
        assert after.error < 0.6 * before.error


def test_gradients_are_those_of_the_functions(random):
    points = random.uniform(-2, 2, (20, 3))
    exact = points * (2, 2, 1)
    np.testing.assert_allclose(normals.gradient(normals.ellipsoid, points) / 2e-5, exact, atol=1e-8)
    turned = np.cross(exact, points) + exact
    angle = np.degrees(np.arctan2(np.linalg.norm(np.cross(exact, turned), axis=1),
                                  np.einsum("ij,ij->i", exact, turned)))  # fmt: skip
    np.testing.assert_allclose(normals.angles(exact, -turned), angle, atol=1e-9)
