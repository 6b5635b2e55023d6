"""The embedded data are those whose provenance is told, and small."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

import vizlight

DATASETS = Path(__file__).parent.parent / "datasets"


def test_every_file_has_the_hash_that_the_readme_tells():
    told = (DATASETS / "README.md").read_text()
    files = sorted(DATASETS.glob("*.vt?"))
    assert files
    for path in files:
        assert f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}" in told
    assert sum(path.stat().st_size for path in DATASETS.iterdir() if path.is_file()) < 2.5e6


def test_the_flow_is_what_the_readme_tells():
    flow = vizlight.load_example()
    assert (flow.n_points, flow.n_cells) == (8499, 7472)
    assert set(flow.point_data) == {"V", "Pres", "Temp", "H2", "AsH3", "CH4", "GaMe3"}


def test_the_fibres_are_what_the_readme_tells():
    fibres = vizlight.load_example("fibre_bundle.vtp")
    assert (fibres.n_points, fibres.n_lines) == (14576, 300)
    scene = vizlight.Scene(view=vizlight.View(direction=(1, 1, 1)))
    lit = vizlight.illuminate(fibres, scene)
    assert "luminance_valid" not in lit.point_data
    assert 0.1 <= lit["luminance"].min() < lit["luminance"].max() <= 1.0


def test_the_relief_is_what_the_readme_tells():
    """The highest is in the Himalaya, the deepest in the Mariana trench."""
    earth = vizlight.load_example("earth_relief.vti")
    assert earth.dimensions == (1080, 540, 1)
    height = earth["elevation"]
    assert (height.min(), height.max()) == (-9027, 6229)
    top, bottom = (earth.points[i, :2] for i in (height.argmax(), height.argmin()))
    assert 27 < top[1] < 40
    assert 70 < top[0] < 105
    assert 10 < bottom[1] < 42
    assert 140 < bottom[0] < 147
    assert earth.bounds[:4] == pytest.approx((-179.8333, 179.8333, -89.8333, 89.8333), abs=1e-3)


def test_the_dog_is_what_the_readme_tells():
    """It is closed, so that the length of a ray inside it is defined."""
    dog = vizlight.load_example("dog.vtp")
    assert (dog.n_points, dog.n_cells, dog.n_open_edges) == (16952, 33900, 0)
    assert dog.is_manifold


def test_the_fault_is_what_the_readme_tells():
    fault = vizlight.load_example("jacksboro_fault.vti")
    assert fault.dimensions == (403, 344, 1)
    assert fault.spacing[:2] == pytest.approx((74.40, 92.66), abs=0.01)
    assert (fault["elevation"].min(), fault["elevation"].max()) == (236, 1076)


def test_the_winds_are_what_the_readme_tells():
    """They are tangent to the sphere; in July the Somali jet blows toward the north-east."""
    air = vizlight.load_example("winds_of_july.vtp")
    assert (air.n_points, air.n_cells, air.n_open_edges) == (10226, 20448, 0)
    place, wind = np.asarray(air.points, dtype=float), np.asarray(air["wind"], dtype=float)
    assert np.linalg.norm(place, axis=1) == pytest.approx(1, abs=1e-6)
    assert np.abs(np.sum(place * wind, axis=1)).max() < 1e-5
    longitude, latitude = np.radians([52.5, 10.0])
    east = np.array([-np.sin(longitude), np.cos(longitude), 0])
    up = np.array([*(np.cos(latitude) * np.array([east[1], -east[0]])), np.sin(latitude)])
    here = np.argmax(place @ up)
    assert wind[here] @ east > 5
    assert wind[here] @ np.cross(up, east) > 5
    outward = np.sum(
        air.compute_normals(cell_normals=False, auto_orient_normals=False)["Normals"] * place,
        axis=1,
    )
    assert outward.min() > 0.9


def test_hawaii_is_what_the_readme_tells():
    """Its highest point is Mauna Loa, at 19.48 degrees north and 155.61 west, to three cells."""
    ground = vizlight.load_example("hawaii.vti")
    assert ground.dimensions == (157, 109, 1)
    height = np.asarray(ground["elevation"])
    assert (height.min(), height.max()) == (-5831, 2804)
    top = ground.points[height.argmax()] / ground.spacing / 12 + (-164, 16, 0)
    assert top[:2] == pytest.approx((-155.61, 19.48), abs=1 / 4)


def test_the_scan_is_what_the_readme_tells():
    scan = vizlight.load_example("carotid.vti")
    assert scan.dimensions == (76, 49, 45)
    assert (scan["brightness"].min(), scan["brightness"].max()) == (0, 580)
    assert np.array_equal(32 * scan["velocity"], np.rint(32 * scan["velocity"]))


def test_the_brain_is_what_the_readme_tells():
    """Its left half ends in the middle, and its surface is where the head is widest and longest."""
    brain = vizlight.load_example("brain.vti")
    assert brain.dimensions == (48, 120, 102)
    assert (brain["matter"].min(), brain["matter"].max()) == (20, 80)
    bounds = brain.contour([50.5]).bounds
    assert bounds[:4] == pytest.approx((-70, -0.5, -105.5, 72), abs=1)


def test_unknown_data():
    with pytest.raises(
        ValueError,
        match=r"name: expected one of \['brain.vti', 'carotid.vti', 'dog.vtp', 'earth_relief.vti', "
        r"'fibre_bundle.vtp', 'hawaii.vti', 'jacksboro_fault.vti', 'rotating_disk.vtu', "
        r"'winds_of_july.vtp'\], got 'x'",
    ):
        vizlight.example_path("x")
