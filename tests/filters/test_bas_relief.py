"""A bas-relief of a surface: its heights, upright, what does not fit."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight import Light, Scene, bas_relief, relief_shadow

BALL = pv.Sphere(theta_resolution=8, phi_resolution=8)


def test_a_bas_relief_of_a_sphere():
    ball = pv.Sphere(theta_resolution=200, phi_resolution=200)
    out = bas_relief(ball, direction=(1, 1, 0.2), resolution=201, margin=0.1)
    assert out.dimensions == (201, 201, 1)
    x, y, _ = np.asarray(out.points).T
    there = x**2 + y**2 < 0.2
    # The plate is where the last node of the ball is seen.
    below = 0.5 - np.sqrt(0.25 - x[there] ** 2 - y[there] ** 2)
    np.testing.assert_allclose(out["height"].max() - out["height"][there], below, atol=1e-3)
    assert not out["height"][x**2 + y**2 > 0.2501].any()
    low = bas_relief(ball, resolution=64, height=0.1)
    assert low["height"].max() == pytest.approx(0.1)
    lit = relief_shadow(low, Scene(lights=Light(position=(1, 1, 0.5))), depth=0.02)
    assert 0 < lit["t"].min() < lit["t"].max() <= 1


def test_bas_relief_is_upright():
    """Seen from -y, x runs to the right and z up."""
    cone = pv.Cone(center=(2, 0, 1), direction=(0, 0, 1), resolution=50).triangulate()
    fruit = pv.Sphere(center=(2.45, 0, 1.4), radius=0.1)
    seen = bas_relief(pv.merge([cone, fruit]), direction=(0, -1, 0), resolution=256)
    x, y, _ = np.asarray(seen.points).T
    high = seen["height"] > 0
    top = x[high & (y > 0.3)]
    assert np.ptp(x[high & (y < -0.3)]) > 0.9 > 0.7 > np.ptp(top)
    assert top.max() > 0.4
    assert top.min() > -0.3


test_bad_input = refusals(
    lambda mesh, options: bas_relief(mesh, **{"direction": (0, 0, 1)} | options),
    (3, {}, "mesh: expected a PyVista surface, got int", TypeError),
    (BALL, {"resolution": 1}, "resolution: expected an integer of at least 2"),
    (BALL, {"up": (0, 0, 2)}, "up: expected a direction across the view"),
    (pv.Plane(direction=(1, 0, 0)), {}, "mesh: expected a surface wider than a node"),
)


def test_a_raised_grid_has_a_relief():
    grid = pv.ImageData(dimensions=(21, 21, 1), spacing=(0.1, 0.1, 1))
    grid["h"] = np.sin(grid.points[:, 0])
    raised = grid.warp_by_scalar("h")
    known = bas_relief(raised.extract_surface(algorithm="geometry"), resolution=30)
    np.testing.assert_array_equal(bas_relief(raised, resolution=30)["height"], known["height"])


def test_a_grid_of_heights_is_raised():
    grid = pv.ImageData(dimensions=(9, 7, 1))
    grid["z"] = np.arange(63.0)
    assert np.ptp(bas_relief(grid, resolution=50)["height"]) > 50
