"""First pictures of small meshes of twelve kinds change with their data; faults are found."""

import first_pictures
import numpy as np
import pytest
import pyvista as pv
from PIL import Image

SMALL = (240, 160)


def _sheet():
    x, y = np.meshgrid(np.linspace(0, 6, 24), np.linspace(0, 4, 16), indexing="ij")
    mesh = pv.ImageData(dimensions=(24, 16, 1), spacing=(6 / 23, 4 / 15, 1))
    return mesh, np.ravel(x, "F"), np.ravel(y, "F")


def temperatures():
    """Return a regular map of temperatures."""
    mesh, x, y = _sheet()
    mesh["temperature"] = 280 + 15 * np.cos(y) + 3 * np.sin(2 * x)
    return mesh


def curvilinear():
    """Return a curvilinear map of temperatures."""
    mesh, x, y = _sheet()
    mesh["temperature"] = 280 + 15 * np.cos(y) + 3 * np.sin(2 * x)
    grid = mesh.cast_to_structured_grid()
    grid.points[:, 0] += 0.3 * grid.points[:, 1] ** 2
    return grid


def winds():
    """Return a map of winds in components."""
    mesh, x, y = _sheet()
    mesh["u"], mesh["v"] = np.cos(y) + 0.3, np.sin(x)
    return mesh


def heights():
    """Return a raster of heights."""
    mesh, x, y = _sheet()
    mesh["elevation"] = 300 * (np.exp(-((x - 2) ** 2) - (y - 1) ** 2) + 0.3 * np.sin(3 * x))
    return mesh


def classes():
    """Return a raster of classes."""
    mesh, x, y = _sheet()
    mesh["class"] = (x > 3).astype(np.int32) + 2 * (y > 1.5)
    return mesh


def ball_of_values():
    """Return a closed surface with values."""
    mesh = pv.Sphere(theta_resolution=24, phi_resolution=20)
    mesh.clear_data()
    mesh["pressure"] = np.sin(5 * mesh.points[:, 0]) + mesh.points[:, 2]
    return mesh


def ball_of_vectors():
    """Return a closed surface with tangent vectors."""
    mesh = pv.Sphere(theta_resolution=24, phi_resolution=20)
    mesh.clear_data()
    mesh["wind"] = np.cross(mesh.points, [0.3, 0.2, 1.0]).astype(np.float32)
    return mesh


def curved_sheet():
    """Return an open curved surface with values."""
    mesh, x, y = _sheet()
    grid = mesh.cast_to_structured_grid()
    grid.points[:, 2] = np.sin(x)
    grid["thickness"] = 1 + 0.2 * np.cos(3 * y)
    return grid


def _block():
    mesh = pv.ImageData(dimensions=(14, 14, 14), spacing=(1 / 13,) * 3, origin=(-0.5,) * 3)
    return mesh, np.asarray(mesh.points, dtype=float)


def flow():
    """Return a volume with a velocity."""
    mesh, points = _block()
    mesh["velocity"] = np.cross(points + np.array([0.2, 0.1, 0.0]), [0.0, 0.3, 1.0])
    return mesh


def volume():
    """Return a volume with values."""
    mesh, points = _block()
    mesh["density"] = np.exp(-8 * ((points - [0.1, 0.0, -0.1]) ** 2).sum(axis=1))
    return mesh


def materials():
    """Return a solid of a few materials."""
    mesh = _block()[0].cast_to_unstructured_grid()
    centres = mesh.cell_centers().points
    mesh.cell_data["material"] = (centres[:, 0] > 0).astype(np.int32) + 1
    return mesh


def particles():
    """Return points with values."""
    points = np.random.default_rng(0).normal(size=(400, 3))
    mesh = pv.PolyData(points)
    mesh["mass"] = np.abs(points[:, 0])
    return mesh


KINDS = (
    temperatures, curvilinear, classes, ball_of_values, ball_of_vectors, curved_sheet, flow,
    volume, materials, particles,
)  # fmt: skip
#: Kinds whose filters take seconds to compile.
SLOW = [pytest.param(kind, marks=pytest.mark.slow) for kind in (winds, heights)]


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", [*KINDS, *SLOW], ids=lambda kind: kind.__name__)
def test_first_picture_changes_with_data(kind, tmp_path):
    mesh = kind()
    path = tmp_path / "data.vtk"
    mesh.save(path)
    row = dict.fromkeys(first_pictures.COLUMNS, "")
    first_pictures.ours(path, tmp_path / "data", row, size=SMALL)
    assert first_pictures.verdict(row), row


@pytest.mark.slow
@pytest.mark.parametrize("kind", [temperatures, ball_of_vectors], ids=lambda kind: kind.__name__)
def test_script_draws_the_same_picture(kind, tmp_path):
    path = tmp_path / "data.vtk"
    kind().save(path)
    worst = first_pictures.from_script(path, tmp_path / "data", size=SMALL)
    assert worst <= first_pictures.SCRIPT


def test_other_data_keep_range_lengths_and_kinds():
    mesh = ball_of_vectors()
    mesh["pressure"] = np.where(np.arange(mesh.n_points) % 7, mesh.points[:, 2], np.nan)
    mesh["part"] = np.arange(mesh.n_points) % 3
    other, count = first_pictures.changed(mesh)
    assert count == 3
    for name in ("pressure", "part"):
        for bound in (np.nanmin, np.nanmax):
            np.testing.assert_allclose(bound(other[name]), bound(mesh[name]), atol=1e-6)
    np.testing.assert_array_equal(np.isnan(other["pressure"]), np.isnan(mesh["pressure"]))
    assert not np.any(other["part"] == mesh["part"])
    lengths = [np.linalg.norm(each["wind"], axis=1) for each in (mesh, other)]
    np.testing.assert_allclose(lengths[1], lengths[0], atol=1e-6)
    cosines = np.sum(mesh["wind"] * other["wind"], axis=1)
    assert np.abs(cosines).max() < 0.02
    np.testing.assert_array_equal(other.points, mesh.points)


def test_vectors_of_a_map_are_turned_in_its_plane():
    mesh = temperatures()
    mesh["wind"] = np.tile([1.0, 2.0, 0.0], (mesh.n_points, 1))
    np.testing.assert_allclose(first_pictures.changed(mesh)[0]["wind"][0], [-2.0, 1.0, 0.0])


def test_a_picture_that_stays_the_same_fails(tmp_path):
    for name, corner in (("one", 0), ("other", 1)):
        pixels = np.full((100, 100, 3), 200, dtype=np.uint8)
        pixels[:corner, :corner] = 0
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    share = first_pictures.share(tmp_path / "one.png", tmp_path / "other.png")
    assert share == 1e-4
    assert first_pictures.verdict({"changes": str(share)}) is False
    assert first_pictures.verdict({"changes": "0.2"}) is True
    assert first_pictures.verdict({"changes": "no data"}) is None
    assert first_pictures.verdict({"changes": ""}) is False
