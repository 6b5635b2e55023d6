"""Pictures of pieces, composited by depth, equal pictures of the whole."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from vizlight import Scene, View, pieces, render

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
def camera(lit):
    return render.camera_on(pv.Box(lit.bounds), (1, 0.4, 0.7), aspect=1.5)


def test_no_pixel_differs_from_a_picture_of_the_whole(lit, camera):
    options = {"camera": camera, "size": (150, 100)}
    composite = next(pieces.pictures([lit], samples=1, workers=1, **options))
    whole = pv.merge([pv.read(path) for path in lit.files], merge_points=False)
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
