"""The embedded data are those whose provenance is told, and small."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest

import vizlight

DATASETS = Path(__file__).parent.parent / "datasets"


def test_every_file_has_the_hash_that_the_readme_tells():
    told = (DATASETS / "README.md").read_text()
    files = sorted(DATASETS.glob("*.vt?"))
    assert files
    for path in files:
        assert f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}" in told
    assert sum(path.stat().st_size for path in DATASETS.iterdir() if path.is_file()) < 5e6


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


def test_unknown_data():
    with pytest.raises(
        ValueError,
        match=r"name: expected one of \['earth_relief.vti', 'fibre_bundle.vtp', "
        r"'rotating_disk.vtu'\], got 'x'",
    ):
        vizlight.example_path("x")
