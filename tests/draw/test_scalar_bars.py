"""Words of scalar bars in the picture; keys in the margin: their colours and their places."""

import numpy as np
import pytest
import pyvista as pv

pytestmark = pytest.mark.opengl
SIZE = (400, 300)
NAME = "a rather long name of a field [kg m-2 s-1]"


def inked(size, values, name=NAME, columns=1, **asked):
    """Return which pixels of a picture a scalar bar covers, and the bar."""
    ball = pv.Sphere()
    ball[name] = values(ball.points[:, 2])
    plotter = pv.Plotter(off_screen=True, window_size=size, shape=(1, columns), border=False)
    actor = plotter.vizlight.add_mesh(ball, scalars=name, scalar_bar_args=asked or None)
    plotter.render()
    actor.SetVisibility(False)
    picture = plotter.screenshot(return_img=True)
    bar = plotter.scalar_bars[name]
    return np.any(picture < 200, axis=2), bar


def groups(rows):
    """Return the number of runs of rows with ink."""
    return int(np.count_nonzero(np.diff(np.concatenate([[0], rows])) == 1))


def holed(heights):
    return np.where(heights > 0.3, np.nan, heights)


def far(heights):
    return 8e5 + 1000 * heights


@pytest.mark.sampled(5)
@pytest.mark.parametrize("values", [holed, far, lambda heights: -1e-7 * (heights + 1)])
@pytest.mark.parametrize("size", [(900, 600), (400, 300)])
@pytest.mark.parametrize("vertical", [False, True])
def test_no_word_of_a_bar_leaves_the_picture(values, size, vertical):
    ink, _ = inked(size, values, vertical=vertical)
    assert ink.any()
    assert not np.any(ink[:, [0, -1]])
    assert not np.any(ink[[0, -1]])


@pytest.mark.parametrize("size", [(900, 600), (400, 300), (1024, 768)])
def test_title_numbers_and_bar_stand_apart(size):
    ink, _ = inked(size, far)
    assert groups(ink.any(axis=1)) == 3
    numbers = ink.any(axis=1).nonzero()[0]
    first = numbers[np.flatnonzero(np.diff(numbers) > 1)[0] + 1]
    assert groups(ink[first : first + 6].any(axis=0)) >= 3


def test_bars_stand_above_one_another():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    for name in (NAME, f"another {NAME}"):
        ball = pv.Sphere()
        ball[name] = ball.points[:, 2]
        plotter.vizlight.add_mesh(ball, scalars=name)
    low, high = (bar.GetPosition()[1] for bar in plotter.scalar_bars.values())
    assert high >= low + plotter.scalar_bars[NAME].GetHeight()


def test_a_bar_fits_its_subplot():
    ink, _ = inked((800, 300), holed, columns=2)
    assert not ink[:, 399:].any()


def test_numbers_of_a_narrow_range_differ():
    _, bar = inked((900, 600), far, "t")
    assert bar.GetLabelFormat() == "%-#6.4g"


def test_what_is_asked_for_stays():
    asked = {"position_x": 0.1, "width": 0.3, "n_labels": 2, "fmt": "%.1f"}
    _, bar = inked((400, 300), far, **asked)
    assert (bar.GetPosition()[0], bar.GetWidth(), bar.GetNumberOfLabels()) == (0.1, 0.3, 2)
    assert (bar.GetLabelFormat(), bar.GetTitle()) == ("%.1f", NAME)


def test_names_break_before_capitals_and_after_underscores():
    from vizlight.draw.scalar_bars import wrapped

    assert wrapped("MaximumInscribedRadius", 12) == ["Maximum", "Inscribed", "Radius"]
    assert wrapped("sample_cell_scalars", 14) == ["sample_", "cell_scalars"]
    assert wrapped("two words", 12) == ["two words"]
