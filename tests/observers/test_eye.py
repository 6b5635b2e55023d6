"""The eye keeps what is large, and loses what is fine, chroma before lightness."""

import numpy as np
import pytest

from vizlight.observers import eye
from vizlight.observers.eye import Eye

#: 300 dots per inch at 400 mm.
PRINT = Eye.at(1004, 85.0, 400.0, 2.3)
RED, GREEN = np.array([0.75, 0.45, 0.45]), np.array([0.35, 0.62, 0.35])


def test_black_and_white_have_the_ends_of_lightness():
    np.testing.assert_allclose(eye.lab(np.zeros(3)), 0, atol=1e-12)
    np.testing.assert_allclose(eye.lab(np.ones(3)), [100, 0, 0], atol=0.01)


def test_opponent_channels_lead_back_to_colors():
    rgb = np.random.default_rng(0).uniform(size=(20, 3))
    np.testing.assert_allclose(eye.lab_of_opponent(eye.opponent(rgb)), eye.lab(rgb), atol=1e-9)


def test_a_degree_has_the_pixels_of_its_tangent():
    assert PRINT.pixels_per_degree == pytest.approx(1004 / 85 * 6.981, rel=1e-3)


@pytest.mark.parametrize(
    ("rgb", "expected"),
    [
        ((1, 0, 0), (53.24, 80.09, 67.20)),
        ((0, 1, 0), (87.73, -86.18, 83.18)),
        ((0, 0, 1), (32.30, 79.19, -107.86)),
        ((0.02, 0.02, 0.02), (1.40, 0, 0)),
        ((0.5, 0.5, 0.5), (53.39, 0, 0)),
    ],
)
def test_colors_have_the_published_lightness_and_chroma(rgb, expected):
    np.testing.assert_allclose(eye.lab(np.array(rgb, float)), expected, atol=0.03)


def test_white_has_the_opponent_channels_of_the_published_matrix():
    np.testing.assert_allclose(eye.POIRSON @ eye.WHITE, [0.8687, -0.2206, 0.0373], atol=2e-4)
    np.testing.assert_allclose(eye.opponent(np.ones(3)), [0.8687, 0, 0], atol=2e-4)
    np.testing.assert_allclose(eye.WHITE, [0.9505, 1, 1.089], atol=1e-9)


def test_channels_of_chroma_differ_from_the_published_ones_by_gray_alone():
    """Differences of two colours of one lightness keep their channels."""
    xyz = np.random.default_rng(1).normal(size=(3, 20))
    xyz -= np.linalg.pinv(eye.POIRSON[:1]) @ eye.POIRSON[:1] @ xyz
    np.testing.assert_allclose(eye.OPPONENT @ xyz, eye.POIRSON @ xyz, atol=1e-12)


@pytest.mark.parametrize("kind", ["edge", "ramp", "spot", "noise"])
def test_what_is_gray_stays_gray(kind):
    y, x = np.mgrid[:60, :90]
    gray = {
        "edge": x > 45,
        "ramp": x / 90,
        "spot": (x - 45) ** 2 + (y - 30) ** 2 < 30,
        "noise": np.random.default_rng(2).uniform(size=x.shape),
    }[kind].astype(float)
    seen = PRINT.look(np.repeat(gray[..., np.newaxis], 3, axis=2), np.ones(x.shape, dtype=bool))
    np.testing.assert_allclose(seen.colors[..., 1:], 0, atol=0.02)
    assert np.ptp(seen.colors[..., 0]) > 10


@pytest.mark.parametrize(
    ("cycles", "expected"),
    [(0.05, (1.0436, None, None)), (0.5, (None, 0.8243, 0.8632)), (5, (None, 0.4221, 0.2796)),
     (10, (0.4551, None, None))],
)  # fmt: skip
def test_waves_keep_the_contrast_of_the_published_filters(cycles, expected):
    """Zhang and Wandell 1997, table 1: sums of Gaussians in cycles per degree."""
    wave = np.cos(2 * np.pi * cycles * (np.arange(800) + 0.5) / 40)
    found = Eye(40.0).filtered(np.broadcast_to(wave[:, np.newaxis], (8, 800, 3)))
    for channel, share in enumerate(expected):
        if share is not None:
            np.testing.assert_allclose(found[3, :, channel], share * wave, atol=2e-4)


def test_what_is_drawn_covers_a_share_of_what_is_seen_and_the_rest_is_ground():
    picture, drawn = np.full((40, 40, 3), 0.25), np.zeros((40, 40), dtype=bool)
    picture[:, 20:], drawn[:, 20:] = 0.75, True
    seen = Eye(60.0).look(picture, drawn)
    np.testing.assert_allclose(seen.ground, eye.opponent(np.full(3, 0.25)), atol=1e-12)
    # A title or a key on the background is not the background.
    titled = picture.copy()
    titled[:5, :20] = 0.9
    np.testing.assert_array_equal(Eye(60.0).look(titled, drawn).ground, seen.ground)
    np.testing.assert_allclose(seen.cover[:, 19] + seen.cover[:, 20], 1, atol=1e-9)
    assert np.all(np.diff(seen.cover[5, 12:28, 0]) > 0)
    whole = Eye(60.0).look(picture, np.ones((40, 40), dtype=bool))
    np.testing.assert_allclose(whole.ground, 0)


def contrast(first, second, width):
    """Return the difference in CIELAB of stripes of some pixels, seen by the eye."""
    stripe = (np.arange(480) // width % 2)[np.newaxis, :, np.newaxis]
    picture = np.broadcast_to(np.where(stripe, first, second), (16, 480, 3))
    seen = PRINT.look(picture, np.ones((16, 480), dtype=bool)).colors[8, 120:360]
    return np.ptp(seen[:, 0]), float(np.hypot(*np.ptp(seen[:, 1:], axis=0)))


@pytest.mark.parametrize("kind", ["lightness", "chroma"])
def test_finer_stripes_have_less_contrast(kind):
    pair = (np.ones(3), np.zeros(3)) if kind == "lightness" else (RED, GREEN)
    found = [contrast(*pair, width)[kind == "chroma"] for width in (60, 12, 4, 2, 1)]
    assert found == sorted(found, reverse=True)
    assert found[-1] < 1 < 0.5 * found[0]


def test_chroma_goes_before_lightness():
    light, hue = (contrast(np.ones(3), np.zeros(3), w)[0] for w in (60, 4))
    of_light = hue / light
    wide, fine = (contrast(RED, GREEN, w)[1] for w in (60, 4))
    assert fine / wide < 0.7 * of_light


def test_the_filter_is_the_sum_of_gaussians():
    spot = np.zeros((65, 65, 3))
    spot[32, 32] = 1
    found = Eye(40.0).filtered(spot)
    y, x = (np.mgrid[:65, :65] - 32) / 40.0
    for channel, gaussians in enumerate(eye.FILTERS[1:], 1):
        expected = np.zeros((65, 65))
        for weight, spread in gaussians:
            expected += weight * np.exp(-(x**2 + y**2) / spread**2) / (np.pi * (40 * spread) ** 2)
        expected /= sum(weight for weight, _ in gaussians)
        assert found[32, 32, channel] == pytest.approx(expected[32, 32], rel=0.02)
        assert found[32, 35, channel] == pytest.approx(expected[32, 35], rel=0.05)


def test_a_line_that_is_mixed_with_the_background_is_unmixed():
    from vizlight.observers.readers import colors_at

    picture, drawn = np.ones((60, 60, 3)), np.zeros((60, 60), dtype=bool)
    picture[:, 30:33], drawn[:, 30:33] = RED, True
    seen = PRINT.look(picture, drawn)
    at = np.array([30]), np.array([31])
    colors = colors_at(seen, *at, np.random.default_rng(0), 0.0)
    np.testing.assert_allclose(colors.lab[0], eye.lab(RED), atol=1)
    assert np.linalg.norm(seen.colors[30, 31] - eye.lab(RED)) > 10
    assert colors.deviation[0, 1] > 1.2 * colors.deviation[0, 0] > 0.3


def test_dark_colours_on_a_bright_background_differ():
    from vizlight.observers.readers import colors_at

    shades = np.linspace(0.02, 0.3, 6)
    picture, drawn = np.ones((200, 240, 3)), np.zeros((200, 240), dtype=bool)
    picture[60:140, 60:180] = np.repeat(shades, 20)[:, np.newaxis]
    drawn[60:140, 60:180] = True
    seen = PRINT.look(picture, drawn)
    at = np.full(6, 100), np.arange(70, 190, 20)
    # The filter alone leaves less than no light of half of them.
    assert (seen.colors_at(*at)[:, 0] == 0).sum() >= 3
    colors = colors_at(seen, *at, np.random.default_rng(0), 0.0)
    expected = eye.lab(np.repeat(shades[:, np.newaxis], 3, axis=1))
    np.testing.assert_allclose(colors.lab[:, 0], expected[:, 0], atol=2.5)


def test_a_disc_has_the_share_of_the_filter_over_it():
    looking = Eye.at(400, 60, 400, 0)
    y, x = np.mgrid[:401, :401] - 200.0
    for width in (4.0, 21.0, 120.0):
        disc = np.repeat((np.hypot(x, y) <= width / 2)[..., np.newaxis].astype(float), 3, axis=2)
        found = looking.filtered(disc)[200, 200]
        np.testing.assert_allclose(looking.share(width), found, atol=0.03)


def test_pixels_of_a_group_have_their_mean_in_linear_light():
    picture = np.zeros((6, 8, 3))
    picture[:, 4:] = 1.0
    seen = Eye.at(8, 60, 400, 0).look(picture, np.ones((6, 8), dtype=bool))
    row, column = np.nonzero(np.ones((6, 8)))
    found = seen.pooled(row[:16], column[:16], np.repeat([0, 1], 8))
    before = eye.xyz_of_lab(seen.colors)
    for line in (0, 1):
        after = eye.xyz_of_lab(found.colors[line])
        np.testing.assert_allclose(after, np.tile(before[line].mean(axis=0), (8, 1)), atol=1e-9)
    assert np.array_equal(found.colors[2:], seen.colors[2:])
