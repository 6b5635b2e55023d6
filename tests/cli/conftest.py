"""The command line as the tests call it."""

import shutil

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import cli
from vizlight.geometry import manifolds


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch, request):
    """Work in a new folder, with few strokes in what is drawn."""
    request.getfixturevalue("few_strokes")
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def run(capfd):
    """Return what runs words, of which a string may have several: exit code, output, errors."""

    def call(*arguments):
        code = cli.main([word for each in arguments for word in str(each).split()])
        return (code, *capfd.readouterr())

    return call


@pytest.fixture
def done(run):
    """Return what runs words that end well without a word of complaint: the output."""

    def call(*words):
        code, out, err = run(*words)
        assert (code, err) == (0, "")
        return out

    return call


@pytest.fixture
def refused(run):
    """Return what runs words that are refused: the errors."""

    def call(*words):
        code, out, err = run(*words)
        assert (code, out) == (2, ""), err
        return err

    return call


def flow():
    """Return a volume with a distance, vectors, and vectors of its cells."""
    grid = pv.ImageData(dimensions=(12, 12, 12))
    x, y, z = (grid.points - 5.5).T
    grid["r"] = np.sqrt(x * x + y * y + z * z)
    grid["V"] = np.stack([-y - 0.1, x + 0.1, 0.2 * z + 1], axis=1).astype(np.float32)
    grid.cell_data["C"] = np.ones((grid.n_cells, 3))
    grid["W"] = np.cross(grid["V"], (1, 0, 0)).astype(np.float32)
    return grid


@pytest.fixture
def volume(written):
    """Return the name of the one file of the current folder: a volume."""
    return shutil.copy(written / "flow.vti", "flow.vti")


@pytest.fixture(scope="session")
def written(tmp_path_factory):
    """Return a folder, which no test works in, with a volume, a terrain and a torus in 4-space."""
    home = tmp_path_factory.mktemp("files")
    flow().save(home / "flow.vti")
    terrain = pv.ImageData(dimensions=(20, 16, 1))
    terrain["height"] = 3 * np.sin(terrain.points[:, 0] / 3) * np.cos(terrain.points[:, 1] / 4)
    terrain.save(home / "terrain.vti")
    tract = pv.Line((0, 0, 0), (3, 4, 0), resolution=4)
    tract = tract + pv.Line((0, 0, 1), (2, 0, 3), resolution=3)
    tract.cell_data["bundle"] = np.arange(float(tract.n_cells))
    tract.save(home / "tract.vtp")
    vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=12)).save(home / "torus.vtp")
    return home


@pytest.fixture
def folder(written, tmp_path, monkeypatch):
    """Return a copy of the folder, made the current one."""
    home = shutil.copytree(written, tmp_path / "first")
    monkeypatch.chdir(home)
    return home
