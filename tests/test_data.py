"""The embedded data are those whose provenance is told, and small."""

import hashlib
from pathlib import Path

import numpy as np
import pytest

import vizlight

DATASETS = Path(__file__).parent.parent / "datasets"
#: Number of points, an array, and its smallest and largest value, or length of a vector.
KNOWN = {
    "brain.vti": (587_520, "matter", 20, 80),
    "carotid.vti": (167_580, "brightness", 0, 580),
    "coasts.vtp": (5128, None, 0, 0),
    "dog.vtp": (16_952, None, 0, 0),
    "earth_relief.vti": (583_200, "elevation", -9027, 6229),
    "fibre_bundle.vtp": (14_576, None, 0, 0),
    "hawaii.vti": (17_113, "elevation", -5831, 2804),
    "jacksboro_fault.vti": (138_632, "elevation", 236, 1076),
    "rotating_disk.vtu": (8499, "Pres", 0, 0),
    "winds_of_july.vtp": (10_226, "wind", 0, 0),
}


def test_every_file_has_the_hash_that_the_readme_tells():
    told = (DATASETS / "README.md").read_text()
    files = sorted(DATASETS.glob("*.vt?"))
    assert {path.name for path in files} == set(KNOWN)
    for path in files:
        assert f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}" in told
    assert sum(path.stat().st_size for path in DATASETS.iterdir() if path.is_file()) < 2.5e6


@pytest.mark.parametrize("name", KNOWN)
def test_a_file_is_what_the_readme_tells(name):
    mesh = vizlight.load_example(name)
    points, array, low, high = KNOWN[name]
    assert mesh.n_points == points
    if low != high:
        assert (mesh[array].min(), mesh[array].max()) == (low, high)
    elif array:
        assert array in mesh.point_data


def place(name, function):
    """Return the place where an array is smallest or largest."""
    earth = vizlight.load_example(name)
    return earth.points[function(earth["elevation"])], earth.spacing


def test_the_highest_and_deepest_places_are_where_they_are():
    """In the Himalaya and in the Mariana trench; Mauna Loa is at 19.48 N, 155.61 W."""
    top, bottom = (place("earth_relief.vti", f)[0] for f in (np.argmax, np.argmin))
    assert np.all(np.abs(top[:2] - (87.5, 33.5)) < (17.5, 6.5))
    assert np.all(np.abs(bottom[:2] - (143.5, 26)) < (3.5, 16))
    loa, spacing = place("hawaii.vti", np.argmax)
    assert (loa / spacing / 12 + (-164, 16, 0))[:2] == pytest.approx((-155.61, 19.48), abs=1 / 4)


def test_the_winds_are_tangent_to_the_sphere_and_the_somali_jet_blows_north_east():
    air = vizlight.load_example("winds_of_july.vtp")
    at, wind = np.asarray(air.points, dtype=float), np.asarray(air["wind"], dtype=float)
    assert np.linalg.norm(at, axis=1) == pytest.approx(1, abs=1e-6)
    assert np.abs(np.sum(at * wind, axis=1)).max() < 1e-5
    longitude, latitude = np.radians([52.5, 10.0])
    east = np.array([-np.sin(longitude), np.cos(longitude), 0])
    up = np.array([*(np.cos(latitude) * np.array([east[1], -east[0]])), np.sin(latitude)])
    jet = wind[np.argmax(at @ up)]
    assert jet @ east > 5
    assert jet @ np.cross(up, east) > 5


def test_closed_surfaces_are_closed():
    """So that the length of a ray inside the dog is defined."""
    for name in ("dog.vtp", "winds_of_july.vtp"):
        assert vizlight.load_example(name).n_open_edges == 0


def test_unknown_data():
    with pytest.raises(ValueError, match=r"name: expected one of \['brain.vti', .*, got 'x'"):
        vizlight.example_path("x")
