"""What data hold: roles of arrays, and what is no datum."""

import numpy as np
import pytest
import pyvista as pv

from vizlight.looks.contents import Contents


def of(**arrays):
    mesh = pv.Sphere(theta_resolution=20, phi_resolution=20)
    for name, values in arrays.items():
        mesh[name] = values(mesh.n_points)
    return Contents(mesh)


def rising(n):
    return np.linspace(0, 1, n)


@pytest.mark.parametrize(
    ("name", "values", "role"),
    [
        ("p", rising, "values"),
        ("surface_height", rising, "heights"),
        ("V", lambda n: np.random.default_rng(0).normal(size=(n, 3)), "vectors"),
        ("skin", lambda n: np.full((n, 3), 9, np.uint8), "colors"),
        ("part", lambda n: np.arange(n) % 3, "kinds"),
        ("counts", np.arange, "values"),
    ],
)
def test_roles(name, values, role):
    (array,) = of(**{name: values}).arrays
    assert (array.name, array.role) == (name, role)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("GlobalNodeId", np.arange),
        ("constant", np.ones),
        ("latitude", rising),
        ("nothing", lambda n: np.full(n, np.nan)),
        ("vtkValidPointMask", lambda n: np.arange(n) % 2),
        ("no flow", lambda n: np.zeros((n, 3))),
    ],
)
def test_what_is_no_datum(name, values):
    assert of(**{name: values}).arrays == ()


def test_labels_are_kinds_and_scans_are_values():
    grid = pv.ImageData(dimensions=(40, 40, 40))
    x, y, z = grid.points.T
    grid["labels"] = (7 * (x // 10) + 31 * (y // 10) + 3 * (z // 20)).astype(np.int16) + 1
    noise = np.random.default_rng(0).integers(-3, 4, grid.n_points)
    grid["scan"] = (100 + 3 * x + noise).astype(np.int16)
    roles = {array.name: array.role for array in Contents(grid).arrays}
    assert roles == {"labels": "kinds", "scan": "values"}


def test_flat_sheets_and_slabs():
    assert Contents(pv.Plane()).flat_axis == 2
    assert Contents(pv.ImageData(dimensions=(200, 1, 150))).flat_axis == 1
    assert Contents(pv.ImageData(dimensions=(300, 400, 2))).flat_axis == 2
    assert Contents(pv.Sphere()).flat_axis is None
    assert Contents(pv.ImageData(dimensions=(9, 9, 9))).flat_axis is None
