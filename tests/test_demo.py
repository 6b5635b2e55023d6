"""The demo: its light is right, and its picture can be read where a white lamp's cannot."""

import numpy as np
import pytest

from vizlight import demo


@pytest.fixture(scope="module")
def made():
    """Return the demo with fewer lines than it draws."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demo, "SPACING", 0.3)
        return demo.light_winds()


def test_errors_of_the_table(made):
    assert [row[0] for row in made.rows] == ["a white lamp at the eye", "presets.direction"]
    for _, terms, _, error, _ in made.rows:
        assert "diffuse" in terms
        assert 0 < error < 2e-6
    assert made.globe.n_points == 10226


def test_the_direction_is_read_in_its_own_light_alone(made):
    white, colours = (row[-1] for row in made.rows)
    assert white.unreadable
    assert white.median == 45
    assert colours.within_10 > 0.6
    assert colours.median < 8


def test_hue_follows_the_direction_and_lightness_does_not(made):
    """With the exponent 2 the luma of lamps of equal luma depends on the slope alone."""
    globe = made.globe
    wind = np.asarray(globe["wind"], float)
    along = wind / np.linalg.norm(wind, axis=1, keepdims=True)
    eye = np.array(made.scene.view.position) - globe.points
    front = np.einsum("ij,ij->i", eye, globe["Normals"]) > 0
    toward = np.array(made.scene.view.direction) / np.linalg.norm(made.scene.view.direction)
    slope = np.abs(along @ toward)
    luma = np.asarray(globe["rgb"]) @ [0.2126, 0.7152, 0.0722]
    # 3 + 0.4 lamps less 1.5 cos(slope)^2 and 0.4 sin(slope)^2 of them, in the preset's unit.
    expected = 1.9 + 1.1 * slope**2
    ratio = (luma - 0.08)[front] / expected[front]
    assert np.ptp(ratio) < 1e-5 * ratio.mean()
    channels = np.asarray(globe["rgb"])[front & (slope < 0.1)]
    assert np.ptp(channels, axis=0).max() > 0.25


def test_lines_lie_above_the_globe(made):
    radius = np.linalg.norm(made.lines.points, axis=1)
    assert radius.min() > 1.0
