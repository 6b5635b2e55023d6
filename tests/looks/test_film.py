"""Movies of the steps of a series."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import film

if TYPE_CHECKING:
    from pathlib import Path

Sides = tuple[int, int, int]

SIZE = (160, 120)
#: Points of a sheet and of a volume.
SHEET: Sides = (9, 7, 1)
VOLUME: Sides = (25, 25, 25)


def _series(
    folder: Path, arrays: list[dict[str, np.ndarray]], sides: Sides = SHEET, thickness: float = 1.0
) -> Path:
    """Write the steps of a grid as a collection, and return its path."""
    rows = []
    for i, step in enumerate(arrays):
        grid = pv.ImageData(dimensions=sides, spacing=(1.0, 1.0, thickness))
        for name, values in step.items():
            grid.point_data[name] = values
        grid.cast_to_structured_grid().save(folder / f"step{i}.vts")
        rows.append(f'<DataSet timestep="{i / 2}" part="0" file="step{i}.vts"/>')
    path = folder / "series.pvd"
    collection = f"<Collection>{''.join(rows)}</Collection>"
    path.write_text(f'<VTKFile type="Collection" version="0.1">{collection}</VTKFile>')
    return path


def _values(offset: float) -> np.ndarray:
    x, y, _ = pv.ImageData(dimensions=SHEET).points.T
    return np.sin(x / 3 + offset) + 0.1 * y + offset


@pytest.fixture
def warming(tmp_path: Path) -> Path:
    return _series(tmp_path, [{"T": _values(k / 2.0)} for k in range(3)])


@pytest.fixture
def turning(tmp_path: Path) -> Path:
    """Return the path of a wind that turns by a right angle in three steps."""
    ways = [(1.0, 0.0, 0.0), (0.7, 0.7, 0.0), (0.0, 1.0, 0.0)]
    x = pv.ImageData(dimensions=SHEET).points[:, :1]
    return _series(tmp_path, [{"U": (1 + x / 8) * np.array(way)} for way in ways])


def _options(look: vizlight.Look, path: Path) -> dict[str, object]:
    (step,) = look.steps(path)[0]
    assert step.path == "film.save"
    return step.keywords


def test_all_steps_have_the_range_of_all(warming: Path, tmp_path: Path) -> None:
    look = vizlight.look(warming, size=SIZE)
    options = _options(look, tmp_path / "x.gif")
    low, high = options["clim"]
    every = np.concatenate([_values(k / 2.0) for k in range(3)])
    # Round numbers, not far outside.
    spare = 0.1 * np.ptp(every)
    assert every.min() - spare <= low <= every.min()
    assert every.max() <= high <= every.max() + spare
    assert options["array"] == "T"


@pytest.mark.usefixtures("few_strokes")
def test_a_movie_of_vectors_has_the_colours_of_a_picture(tmp_path: Path) -> None:
    sides = (41, 31, 1)
    speeds = 0.2 + 0.1 * pv.ImageData(dimensions=sides).points[:, :1] / 40
    speeds[:4] *= 8
    path = _series(tmp_path, [{"U": speeds * [1.0, 0.1 * k, 0.0]} for k in range(2)], sides)
    look = vizlight.look(path, size=SIZE)
    colors = _options(look, tmp_path / "x.gif")["cmap"]
    assert colors.path == "pyvista.LookupTable"
    assert colors.arguments == look.drawing.layers[0].keywords["cmap"].arguments


def test_the_range_of_all_steps_is_that_of_the_layer_that_is_shown(tmp_path: Path) -> None:
    x, _, z = pv.ImageData(dimensions=(9, 7, 3)).points.T
    steps = [{"T": 20.0 + k + x / 8 + 100 * (z - 2)} for k in range(3)]
    look = vizlight.look(_series(tmp_path, steps, (9, 7, 3), 0.01), size=SIZE)
    assert _options(look, tmp_path / "x.gif")["clim"] == (20, 23)


def test_a_movie_has_one_picture_for_each_step_of_values(warming: Path, tmp_path: Path) -> None:
    pytest.importorskip("imageio")
    vizlight.look(warming, size=SIZE).save(tmp_path / "x.gif")
    with Image.open(tmp_path / "x.gif") as movie:
        assert movie.n_frames == 3
        assert movie.size == SIZE


@pytest.mark.slow
def test_the_script_draws_the_same(warming: Path, tmp_path: Path) -> None:
    pytest.importorskip("imageio")
    look = vizlight.look(warming, size=SIZE)
    look.save(tmp_path / "a.gif")
    script = look.script(tmp_path / "b.gif")
    assert "look(" not in script
    exec(script, {})
    with Image.open(tmp_path / "a.gif") as a, Image.open(tmp_path / "b.gif") as b:
        for i in range(3):
            a.seek(i)
            b.seek(i)
            np.testing.assert_array_equal(a.convert("RGB"), b.convert("RGB"))


def test_a_time_that_was_asked_for_is_no_series(warming: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="a map on which nothing moves"):
        vizlight.look(warming, time=0.5).save(tmp_path / "x.gif")


@pytest.mark.slow
def test_strokes_move_between_the_steps(turning: Path, tmp_path: Path) -> None:
    look = vizlight.look(turning, size=SIZE)
    assert _options(look, tmp_path / "x.mp4")["per_step"] > 1
    paths = film.save(turning, tmp_path / "x.png", array="U", per_step=2, size=SIZE, key=False)
    assert len(paths) == 2 * 2 + 1
    pictures = [np.asarray(Image.open(path), dtype=float) for path in paths]
    for one, other in itertools.pairwise(pictures):
        assert np.abs(one - other).max() > 30


@pytest.mark.usefixtures("few_strokes")
def test_steps_that_cannot_be_drawn_are_left_out_with_a_warning(tmp_path: Path) -> None:
    still = np.zeros((63, 3))
    way = np.array([1.0, 0.5, 0.0]) * (1 + pv.ImageData(dimensions=SHEET).points[:, :1] / 8)
    path = _series(tmp_path, [{"U": still}, {"U": way}, {"U": 2 * way}])
    with pytest.warns(UserWarning, match="steps are left out, at 0: array"):
        paths = film.save(path, tmp_path / "x.png", array="U", size=SIZE)
    assert len(paths) == 2


def test_a_volume_keeps_its_level_and_its_camera(tmp_path: Path) -> None:
    x, y, z = pv.ImageData(dimensions=VOLUME).points.T
    steps = [
        {"T": np.tanh(4 - np.sqrt((x - 12 - k / 2) ** 2 + (y - 12) ** 2 + (z - 12) ** 2))}
        for k in range(2)
    ]
    look = vizlight.look(_series(tmp_path, steps, VOLUME), size=SIZE)
    options = _options(look, tmp_path / "x.gif")
    assert options["array"] == "T"
    assert isinstance(options["level"], float)
    assert options["view"] is look.drawing.camera


def test_bad_input(warming: Path, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="time: expected none beside a movie of all steps"):
        film.save(warming, tmp_path / "x.gif", time=0)
    with pytest.raises(ValueError, match="per_step: expected"):
        film.save(warming, tmp_path / "x.gif", per_step=0)
    with pytest.raises(ValueError, match="fps: expected"):
        film.save(warming, tmp_path / "x.gif", fps=0)
    single = tmp_path / "single.vti"
    pv.ImageData(dimensions=(3, 3, 1)).save(single)
    with pytest.raises(ValueError, match="data: expected a series of steps"):
        film.save(single, tmp_path / "x.gif")
    assert not (tmp_path / "x.gif").exists()


def test_some_steps_are_shown_in_the_bands_of_all_of_them(tmp_path: Path) -> None:
    steps = [{"T": _values(k / 2.0)} for k in range(4)]
    xr = pytest.importorskip("xarray")
    rows = np.stack([step["T"].reshape(SHEET[1::-1]) for step in steps])
    coords = {
        "time": ("time", [0, 5, 10, 15], {"units": "days since 2000-01-01 12:00"}),
        "lat": ("lat", np.arange(7.0), {"units": "degrees_north"}),
        "lon": ("lon", np.arange(9.0), {"units": "degrees_east"}),
    }
    path = tmp_path / "a.nc"
    xr.Dataset({"T": (("time", "lat", "lon"), rows)}, coords).to_netcdf(path)
    look = vizlight.look(path, size=(480, 360))
    chosen = replace(look, wishes=replace(look.wishes, steps=[5.0, 10.0]))
    options = _options(chosen, tmp_path / "x.gif")
    assert options["times"] == [5.0, 10.0]
    low, high = options["clim"]
    assert low <= rows[1:3].min() < rows[1:3].max() <= high
    options.pop("times")
    edges = []
    for time in (5.0, 10.0):
        frame = vizlight.look(path, time=time, **options)
        assert "12:00" not in frame.drawing.keys[0]["title"]
        (lines,) = {
            layer.mesh.arguments[0] for layer in frame.drawing.layers if layer.mesh.path == "[]"
        }
        edges.append(frame.drawing.keys[0]["levels"])
        assert {*lines.arguments[2]} <= {*edges[-1]}
    assert edges[0] == edges[1]
    with pytest.raises(ValueError, match="times: expected some of 0, 5, 10, 15"):
        film.save(path, tmp_path / "x.gif", times=[1.5])
