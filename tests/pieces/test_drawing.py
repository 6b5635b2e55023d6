"""Pictures of pieces, composited by depth, equal pictures of the whole."""

from __future__ import annotations

import itertools
import os
import signal
import sys

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

from vizlight import Scene, View, movie, pieces, render

pytestmark = pytest.mark.opengl
SCENE = Scene(view=View(direction=(0, 0, 1)))


@pytest.fixture(scope="module")
def lit(tmp_path_factory):
    folder = tmp_path_factory.mktemp("pieces")
    ball = pv.Sphere(theta_resolution=24, phi_resolution=24)
    ball.clear_data()
    labels = np.random.default_rng(1).integers(0, 3, ball.n_cells)
    for i in range(3):
        part = ball.remove_cells(np.flatnonzero(labels != i))
        part.clear_data()
        part.save(folder / f"part{i}.vtp")
    return pieces.light(str(folder / "*.vtp"), SCENE, out=folder / "lit.pvtp", workers=1)


@pytest.fixture(scope="module")
def lit_lines(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lines")
    turns = np.linspace(0, 6, 60)
    for i in range(3):
        pieces_of_line = [
            pv.lines_from_points(
                np.c_[np.sin(turns + i + k), np.cos(2 * turns + k), np.sin(1.3 * turns + i * k)]
            )
            for k in range(8)
        ]
        pieces_of_line[0].append_polydata(*pieces_of_line[1:]).save(folder / f"part{i}.vtp")
    return pieces.light(str(folder / "*.vtp"), SCENE, out=folder / "lit.pvtp", workers=1)


@pytest.fixture(scope="module")
def camera(lit):
    return render.camera_on(pv.Box(lit.bounds), (1, 0.4, 0.7), aspect=1.5)


@pytest.mark.parametrize(("what", "width"), [("lit", 1.0), ("lit_lines", 1.0), ("lit_lines", 3.0)])
def test_no_pixel_differs_from_a_picture_of_the_whole(request, what, width):
    """Neither do those at edges of lines, whose samples are opaque."""
    shown = request.getfixturevalue(what)
    camera = render.camera_on(pv.Box(shown.bounds), (1, 0.4, 0.7), aspect=1.5)
    options = {"camera": camera, "size": (150, 100), "line_width": width}
    composite = next(pieces.pictures([shown], samples=1, workers=1, **options))
    whole = pv.merge([pv.read(path) for path in shown.files], merge_points=False)
    whole.set_active_scalars("luminance")
    plotter = render.make_plotter(
        whole, anti_aliasing=None, light="points", background="white", **options
    )
    expected = plotter.screenshot(return_img=True)
    plotter.close()
    np.testing.assert_array_equal(composite, expected)
    assert len(np.unique(composite)) > 20


def test_samples_are_averaged_and_indices_are_drawn_as_results(lit, camera, tmp_path):
    options = {"camera": camera, "size": (60, 40), "workers": 1}
    two, one = pieces.pictures([lit, lit.path], **options)
    np.testing.assert_array_equal(one, two)
    fine = next(pieces.pictures([lit], samples=1, **options | {"size": (120, 80)}))
    means = fine.reshape(40, 2, 60, 2, 3).mean(axis=(1, 3))
    assert np.abs(two - means).max() <= 0.5
    path = pieces.save_png(lit, tmp_path / "a.png", **options)
    np.testing.assert_array_equal(pv.read(path).active_scalars.reshape(40, 60, 3)[::-1], two)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"camera": 3}, "camera: expected"),
        ({"size": (0, 3)}, "size: expected"),
        ({"size": (6000, 6000)}, "size: expected at most"),
        ({"samples": 0}, "samples: expected"),
        ({"scalars": "no"}, "piece .*: scalars: expected"),
        ({"colour": 3}, "colour: expected an option of pictures"),
        ({"line_width": -1}, "line_width: expected"),
    ],
    ids=str,
)
def test_bad_input(lit, camera, options, message):
    options = {"camera": camera, "size": (30, 20), "workers": 1} | options
    with pytest.raises((ValueError, TypeError), match=message):
        next(pieces.pictures([lit], **options))


def test_a_series_is_a_movie_a_task_per_step_though_a_worker_is_killed(tmp_path, camera, client):
    for i in range(6):
        pv.Sphere(radius=0.3 + 0.03 * i).save(tmp_path / f"step{i}.vtp")
    steps = pieces.light(
        str(tmp_path / "step*.vtp"), SCENE, ghost=0, out=tmp_path / "lit.pvtp", workers=1
    ).files
    options = {"camera": camera, "size": (60, 40)}
    expected = list(pieces.pictures(steps, workers=1, **options))
    assert len({picture.tobytes() for picture in expected}) == 6
    pids = list(client.run(os.getpid).values())
    taken = []

    def source():
        for step in steps:
            taken.append(step)
            if len(taken) == 3:
                os.kill(pids[0], signal.SIGKILL)
            yield step

    drawn = pieces.pictures(source(), client=client, **options)
    first = next(drawn)
    assert len(taken) <= 4  # no more steps ahead than two for each worker
    movie.save(itertools.chain([first], drawn), tmp_path / "flow.png")
    (tmp_path / "step9.vtp").write_bytes(b"no mesh")
    bad = pieces.pictures([steps[0], tmp_path / "step9.vtp"], client=client, **options)
    with pytest.raises(pieces.PieceError, match=r"piece .*step9\.vtp: "):
        movie.save(bad, tmp_path / "bad.gif")
    assert not list(tmp_path.glob("*bad*"))
    for i, picture in enumerate(expected):
        found = np.asarray(Image.open(tmp_path / f"flow_{i:04d}.png"))
        np.testing.assert_array_equal(found, picture)


def test_no_more_processes_than_processors(lit, camera, monkeypatch):
    """One processor: any number of workers draws in this process."""
    monkeypatch.setattr("vizlight.pieces.drawing._pool.workers", lambda _: 1)
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert next(pieces.pictures([lit], camera=camera, size=(30, 20), workers=10**6)).any()
