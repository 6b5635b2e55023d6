"""Maps of densities: values at their places, whatever the order of the axes."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refused, saved

import vizlight

gemmi = pytest.importorskip("gemmi")


def density_map(path, values, *angles, first=(0, 0, 0)):
    """Write a map whose cell has edges of 8, 9 and 10 and as many nodes as there are values."""
    chart = gemmi.Ccp4Map()
    chart.grid = gemmi.FloatGrid(values)
    chart.grid.set_unit_cell(gemmi.UnitCell(8, 9, 10, *angles))
    chart.update_ccp4_header()
    for word, start in zip((5, 6, 7), first, strict=True):
        chart.set_header_i32(word, start)
    chart.write_ccp4_map(str(path))


@pytest.mark.parametrize("name", ["a.mrc", "a.map", "a.ccp4"])
def test_values_are_at_their_places(tmp_path, name):
    values = np.arange(24, dtype=np.float32).reshape(4, 3, 2)
    path = tmp_path / name
    density_map(path, values, 90, 90, 90, first=(1, 0, -1))
    grid = vizlight.read(path)
    assert isinstance(grid, pv.ImageData)
    np.testing.assert_allclose(grid.spacing, [2, 3, 5])
    np.testing.assert_allclose(grid.origin, [2, 0, -5])
    x, y, z = np.round((grid.points - grid.origin) / grid.spacing).astype(int).T
    np.testing.assert_array_equal(grid["density"], values[x, y, z])


def test_cells_without_right_angles_are_slanted(tmp_path):
    values = np.arange(24, dtype=np.float32).reshape(4, 3, 2)
    density_map(tmp_path / "a.mrc", values, 90, 90, 120)
    grid = vizlight.read(tmp_path / "a.mrc")
    assert isinstance(grid, pv.StructuredGrid)
    place = [2 + 3 * np.cos(np.radians(120)), 3 * np.sin(np.radians(120)), 5]
    at = np.argmin(np.linalg.norm(grid.points - place, axis=1))
    np.testing.assert_allclose(grid.points[at], place, atol=1e-4)
    assert grid["density"][at] == values[1, 1, 1]


def test_short_maps_are_refused(tmp_path):
    density_map(tmp_path / "a.mrc", np.ones((4, 3, 2), np.float32), 90, 90, 90)
    data = (tmp_path / "a.mrc").read_bytes()
    refused(saved(tmp_path / "a.mrc", data[:-8]), r"a\.mrc")
