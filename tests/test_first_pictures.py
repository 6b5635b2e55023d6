"""First pictures of small meshes of twelve kinds change with their data; faults are found."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import vizlight

SIZE = (240, 160)
#: Difference of 255 above which a pixel differs, and share of pixels above which a picture does.
PIXEL, PICTURE = 8, 0.005
#: Most different whole numbers that are kinds.
MOST = 100


def changed(mesh, *, moved=False):
    """Return a mesh with other data, or its own in reverse order."""
    other = mesh.copy()
    for before, after in ((mesh.point_data, other.point_data), (mesh.cell_data, other.cell_data)):
        active = before.active_scalars_name
        for name in before:
            values = np.asarray(before[name])
            after[name] = values[::-1].copy() if moved else _other(values, mesh)
        if active is not None:
            after.active_scalars_name = active
    return other


def _other(values, mesh):
    """Return other values of the same range, vectors of the same length."""
    if values.ndim == 2:
        return _turned(values, mesh)
    if values.dtype.kind in "iu" and len(kinds := np.unique(values)) <= MOST:
        return np.roll(kinds, 1)[np.searchsorted(kinds, values)].astype(values.dtype)
    low, high = np.nanmin(values), np.nanmax(values)
    return (high - (values - low)).astype(values.dtype)


def _turned(vectors, mesh):
    """Return vectors turned by 90 degrees about the normals of a surface, else about z."""
    axes = np.broadcast_to([0.0, 0.0, 1.0], vectors.shape)
    if isinstance(mesh, pv.PolyData) and mesh.faces.size:
        normals = mesh.compute_normals(
            split_vertices=False, consistent_normals=False, auto_orient_normals=False
        )
        of_points = len(vectors) == mesh.n_points
        axes = np.asarray(normals.point_data["Normals"] if of_points else normals["Normals"])
    along = np.sum(axes * vectors, axis=1, keepdims=True) * axes
    return (np.cross(axes, vectors) + along).astype(vectors.dtype)


def share(one, other):
    """Return the share of pixels in which two pictures differ."""
    pictures = [np.asarray(Image.open(path).convert("RGB"), dtype=int) for path in (one, other)]
    return float((np.abs(pictures[0] - pictures[1]).max(axis=2) > PIXEL).mean())


def shows_data(path):
    """Return whether the picture of a file changes with its data.

    The surface of a value may stay when values are reversed within their range, but not when they
    are moved.
    """
    mesh = vizlight.read(path)
    vizlight.look(mesh, size=SIZE).save(f"{path}.png")
    for moved in (False, True):
        vizlight.look(changed(mesh, moved=moved), size=SIZE).save(f"{path}.other.png")
        if share(f"{path}.png", f"{path}.other.png") > PICTURE:
            return True
    return False


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
    assert shows_data(path)


def test_other_data_keep_range_lengths_and_kinds():
    mesh = ball_of_vectors()
    mesh["pressure"] = np.where(np.arange(mesh.n_points) % 7, mesh.points[:, 2], np.nan)
    mesh["part"] = np.arange(mesh.n_points) % 3
    other = changed(mesh)
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
    np.testing.assert_allclose(changed(mesh)["wind"][0], [-2.0, 1.0, 0.0])


def test_a_picture_that_stays_the_same_fails(tmp_path):
    for name, corner in (("one", 0), ("other", 1)):
        pixels = np.full((100, 100, 3), 200, dtype=np.uint8)
        pixels[:corner, :corner] = 0
        Image.fromarray(pixels).save(tmp_path / f"{name}.png")
    assert share(tmp_path / "one.png", tmp_path / "other.png") == 1e-4 < PICTURE
