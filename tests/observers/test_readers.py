"""Readers give the answers that are known beforehand."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.special import softmax
from vectors import unit

from vizlight import Light, Material, Scene, View, presets
from vizlight.observers import eye, readers
from vizlight.observers.eye import XYZ, lab, lab_of_xyz, linear, xyz_of_lab
from vizlight.observers.readers import Colors
from vizlight.observers.samples import Sample
from vizlight.shading.options import ShadingOptions

MATTE = Material(ambient=0.1, diffuse=0.8, specular=0)
EYE = View(direction=(0, 0, 1))
NOISE = 2.3
RANDOM = np.random.default_rng(0)


def places(scene, tangents=None, normals=None, kind="surface"):
    """Return places at the origin that are seen along z."""
    m = len(normals if tangents is None else tangents)
    axes = [np.tile(axis, (m, 1)) for axis in np.eye(3)]
    return Sample(
        kind=kind, points=np.zeros((m, 3)), right=axes[0], up=axes[1], eye=axes[2],
        tangents=None if tangents is None else tangents[:, np.newaxis], normals=normals,
        values=None, valid=np.ones(m, dtype=bool), scene=scene.replace(view=EYE),
        options=ShadingOptions(conditioned=False, precision="float64", exponent=2.0),
    )  # fmt: skip


def colors(sample, noise=NOISE, change=lambda c: c):
    """Return what a reader sees of the light of places themselves."""
    seen = change(lab(readers.shown(sample.light(sample.tangents, sample.normals))))
    return Colors(seen + RANDOM.normal(0, noise, seen.shape), np.full(seen.shape, max(noise, 0.3)))


def plane():
    """Return tangents in all directions of a plane that faces the eye."""
    turn = np.random.default_rng(1).uniform(0, np.pi, 1000)
    return np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)


def direction(scene, noise=NOISE, change=lambda c: c):
    sample = places(scene, plane(), np.tile([0, 0, 1.0], (1000, 1)))
    reading = readers.read_direction(sample, np.zeros(3), colors(sample, noise, change), 7.3)
    return float(np.median(reading.error)), readers.information([reading])


def test_hues_of_a_plane_are_read_by_the_disc():
    error, bits = direction(presets.direction(), 0)
    assert error < 1
    assert bits > 5
    error, bits = direction(presets.direction())
    assert 1 < error < 6
    assert 1.5 < bits < 5


@pytest.mark.parametrize(
    ("scene", "change"),
    [
        (Scene(lights=Light.headlight(), material=MATTE), lambda c: c),
        (Scene(lights=Light(direction=(1, 0, 1)), material=MATTE), lambda c: c),
        (presets.direction(), lambda c: c * [1, 0, 0]),
        (presets.direction(), lambda c: c[::-1]),
        (presets.direction(), lambda c: c * 0.001),
    ],
    ids=["headlight", "one white lamp", "no hue", "another mesh", "no contrast"],
)
def test_what_tells_no_direction_is_chance(scene, change):
    error, bits = direction(scene, change=change)
    assert abs(error - 45) < 4
    assert bits < 0.05


def test_less_contrast_is_read_worse():
    found = [direction(presets.direction(), change=lambda c, s=s: c * s) for s in (1, 0.3, 0.1, 0)]
    bits = [each for _, each in found]
    assert bits == sorted(bits, reverse=True)


@pytest.mark.parametrize("noise", [0.0, NOISE])
def test_a_ball_is_read_by_the_ball(noise):
    ways = unit(np.random.default_rng(5).normal(size=(400, 3)))
    ways[:, 2] = np.abs(ways[:, 2])
    sample = places(presets.shape(), normals=ways)
    reading = readers.read_normal(sample, np.zeros(3), colors(sample, noise), 0.4)
    # The 900 candidates are up to some 4 degrees apart.
    assert np.median(reading.error) < (4 if noise == 0 else 15)
    assert readers.information([reading]) > 2


def test_the_light_of_one_gray_tells_no_normal():
    ways = unit(np.random.default_rng(6).normal(size=(400, 3)))
    dark = Scene(lights=[], material=Material(ambient=0.5, diffuse=0, specular=0))
    sample = places(dark, normals=ways)
    reading = readers.read_normal(sample, np.zeros(3), colors(sample), 0.4)
    assert readers.information([reading]) < 0.01


@pytest.mark.parametrize("turned", [1, -1])
def test_lines_in_space_are_read_by_their_key_whichever_way_they_run(turned):
    ways = turned * unit(np.random.default_rng(2).normal(size=(1000, 3)))
    sample = places(presets.heading(), ways, kind="line")
    (reading,) = readers.read_heading(sample, np.zeros(3), colors(sample, 0.0), (1.0,))
    assert np.median(reading.error) < 3
    assert readers.information([reading]) > 3


def test_lines_darker_than_their_key_are_read_by_a_share_of_its_light():
    ways = unit(np.random.default_rng(2).normal(size=(1000, 3)))
    sample = places(presets.heading(), ways, kind="line")
    light = linear(readers.shown(sample.light(sample.tangents, None)))
    dark = Colors(lab_of_xyz(0.5 * light @ XYZ.T), np.full((1000, 3), 0.5))
    whole, half = readers.read_heading(sample, np.zeros(3), dark, (1.0, 0.5))
    assert np.median(half.error) < 3 < 0.3 * np.median(whole.error)
    assert readers.information([half]) > 3


def test_a_headlight_leaves_the_near_end_of_a_line_open():
    ways = unit(np.random.default_rng(2).normal(size=(1000, 3)))
    sample = places(presets.slope(), ways, kind="line")
    (reading,) = readers.read_heading(sample, np.zeros(3), colors(sample, 0.0), (1.0,))
    toward = np.degrees(np.arcsin(np.abs(ways[:, 2])))
    mirrored = np.minimum(2 * toward, 180 - 2 * toward)
    near = np.minimum(reading.error, np.abs(reading.error - mirrored))
    assert np.median(near) < 2
    assert 0.3 < np.mean(reading.error < 10) < 0.8


def bar(*ends, count=256):
    import pyvista as pv

    share = np.linspace(0, 1, count)[:, np.newaxis]
    table = pv.LookupTable()
    rgb = np.rint((1 - share) * ends[0] + share * np.array(ends[1])).astype(np.uint8)
    table.values = np.column_stack([rgb, np.full(count, 255, np.uint8)])
    return table


@pytest.mark.parametrize("lit", [False, True])
@pytest.mark.parametrize("dim", [1.0, 0.5])
def test_a_reader_who_allows_for_light_reads_dimmed_hues(lit, dim):
    table = bar([230, 60, 60], [60, 60, 230])
    at = np.random.default_rng(3).uniform(size=500)
    rgb = np.asarray(table.values)[(256 * at).astype(int), :3] / 255 * dim
    seen = Colors(lab(rgb), np.full((500, 3), NOISE))
    reading = readers.read_value(seen, at, table, lit=lit)
    assert (np.quantile(reading.error, 0.95) < 0.04) == (lit or dim == 1)
    gray = readers.light_of(seen, table).lab
    np.testing.assert_allclose(gray[:, 0], lab(np.full(3, dim))[0], atol=3)
    # No light makes colours brighter than they are.
    white = Colors(np.array([[100.0, 0, 0]]), seen.deviation[:1])
    gray = readers.light_of(white, bar([200, 200, 200], [100, 100, 100])).lab
    np.testing.assert_allclose(gray, [[100, 0, 0]], atol=0.1)


def test_light_on_a_gray_bar_leaves_the_value_open():
    table = bar([0, 0, 0], [255, 255, 255])
    at = np.random.default_rng(3).uniform(size=500)
    dim = np.random.default_rng(4).uniform(0.3, 1, 500)
    seen = Colors(lab(np.repeat((at * dim)[:, np.newaxis], 3, 1)), np.full((500, 3), NOISE))
    found = [readers.read_value(seen, at, table, lit=lit) for lit in (False, True)]
    assert all(np.median(one.error) > 0.08 for one in found)
    assert readers.information([found[1]]) < 2


def reading_of(logarithms, right):
    truth, other = readers.of_truth(logarithms, right, right[readers.elsewhere(len(right))])
    return readers.Reading(np.zeros(len(right)), truth, 8, np.zeros(len(right)), other)


def test_what_all_places_have_in_common_is_not_told():
    right = np.arange(64) % 8
    sure = np.where(np.eye(8)[right] > 0, 0.0, -50.0)
    assert abs(readers.bits_told([reading_of(sure, right)]) - 3) < 0.1
    alike = np.zeros(64, dtype=int)
    assert readers.bits_told([reading_of(sure[:1].repeat(64, 0), alike)]) == 0
    assert readers.information([reading_of(sure[:1].repeat(64, 0), alike)]) > 2.9
    assert readers.most_told([reading_of(sure, right)]) == 3
    assert [readers.most_ranked(n) for n in (8, 128, 1 << 12)] == [1, 2, 4]


def test_wrong_belief_tells_nothing_and_a_coin_one_bit_less():
    right = np.arange(64) % 8
    sure = np.where(np.eye(8)[right] > 0, 0.0, -50.0)
    reading = reading_of(sure, right)
    assert abs(readers.information([reading]) - 3) < 0.05
    wrong = reading_of(sure, (right + 1) % 8)
    assert readers.information([wrong]) == 0
    coin = np.where(np.eye(8)[right] + np.eye(8)[right ^ 1] > 0, 0.0, -50.0)
    half = reading_of(coin, right)
    assert abs(readers.information([half]) - 2) < 0.05


def test_ranks_order_and_noise_does_not():
    random = np.random.default_rng(0)
    x, other = random.uniform(size=(2, 4096))
    assert readers.rank_correlation(x, np.exp(x)) == pytest.approx(1)
    assert readers.rank_correlation(x, np.zeros(4096)) == 0
    assert readers.mutual_information(x, -x) > 3.9
    assert readers.mutual_information(x, other) < 0.03
    assert np.mean(readers.ranked_error(x, x) < 0.02) > 0.9
    assert abs(np.median(readers.ranked_error(x, other)) - 0.25) < 0.02
    few = [
        readers.mutual_information(x[i : i + 256], other[i : i + 256]) for i in range(0, 4096, 256)
    ]
    # Below the floor of what is readable.
    assert max(few) < 0.3


def test_the_colors_of_a_bar_have_no_error_in_the_middle_of_its_classes():
    table = bar([230, 60, 60], [60, 60, 230])
    at = (np.arange(128) + 0.5) / 128
    rgb = np.asarray(table.values)[(256 * at).astype(int), :3] / 255
    seen = Colors(lab(rgb), np.full((128, 3), 0.3))
    reading = readers.read_value(seen, at, table, lit=False)
    assert reading.error.max() < 1e-9
    assert reading.candidates == 128
    ends = readers.read_value(seen, np.clip(2 * at - 0.5, 0, 1), table, lit=False)
    np.testing.assert_allclose(ends.error, np.abs(at - np.clip(2 * at - 0.5, 0, 1)), atol=1e-9)


def test_a_disc_is_read_without_error_whatever_its_first_candidate():
    turn = np.radians(np.arange(0, 180, 4.5) + 0.2)
    tangents = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    sample = places(presets.direction(), tangents, np.tile([0, 0, 1.0], (40, 1)))
    exact = Colors(lab(readers.shown(sample.light(sample.tangents, sample.normals))),
                   np.full((40, 3), 0.01))  # fmt: skip
    for start in (0.2, 100.2):
        reading = readers.read_direction(sample, np.zeros(3), exact, start)
        # Candidates are a degree apart.
        assert reading.error.max() < 0.51
        assert reading.error[::2].max() < 1e-6
        assert reading.truth[0, ::2].min() > 0.5
    np.testing.assert_allclose(np.degrees(readers.course(sample)) % 180, np.degrees(turn))
    np.testing.assert_allclose(readers.in_picture(sample), 1)


def test_the_mean_normal_is_that_of_all_candidates_however_unlikely_each_is():
    """Colours 60 away from the ball, in 40 deviations: weights of a Gaussian, by scipy."""
    normals = np.array([[0, 0, 1.0], [0.6, 0, 0.8], [0, -0.8, 0.6]])
    sample = places(presets.shape(), None, normals)
    seen = Colors(lab(readers.shown(sample.light(None, normals))) + 60, np.full((3, 3), 1.5))
    disc, along = readers.candidates(*readers.ALONE, 0.3)
    table = lab(readers.shown(readers._ball(sample[np.zeros(900, int)], disc, along)))
    off = ((seen.lab[:, np.newaxis] - table) / 1.5) ** 2
    mean = softmax(-off.sum(axis=2) / 2, axis=1) @ disc
    cosine = (mean * normals).sum(axis=1) / np.linalg.norm(mean, axis=1)
    found = readers.read_normal(sample, np.zeros(3), seen, 0.3)
    np.testing.assert_allclose(found.error, np.degrees(np.arccos(cosine)), atol=1e-3)
    assert off.sum(axis=2).min() > 1500


def test_a_hue_has_the_mean_noise_of_both_of_its_components():
    """Red and green have 1 and blue and yellow 7 of it, or both the root of their mean square."""
    tangents = np.tile([np.cos(0.4), np.sin(0.4), 0.0], (2, 1))
    sample = places(presets.direction(), tangents, np.tile([0, 0, 1.0], (2, 1)))
    colors = lab(readers.shown(sample.light(sample.tangents, sample.normals)))
    apart, alike = (
        readers.read_direction(
            sample, np.zeros(3), Colors(colors, np.tile([1.0, a, b], (2, 1))), 0.2
        )
        for a, b in ((1.0, 7.0), (5.0, 5.0))
    )
    np.testing.assert_allclose(apart.truth, alike.truth)
    assert 1 / 180 < apart.truth[0, 0] < 0.1


def test_likelihoods_are_those_of_a_gaussian():
    random = np.random.default_rng(0)
    seen = Colors(random.normal(size=(5, 3)), random.uniform(0.5, 2, (5, 3)))
    table = random.normal(size=(7, 3))
    off = (seen.lab[:, np.newaxis] - table) / seen.deviation[:, np.newaxis]
    found = readers.likelihood(seen, table[np.newaxis])
    np.testing.assert_allclose(found, -0.5 * (off**2).sum(axis=2), atol=1e-12)
    first, last = readers.of_truth(found, np.zeros(5, dtype=int), np.full(5, 6))
    expected = np.exp(0.4 * found)
    expected /= expected.sum(axis=1, keepdims=True)
    np.testing.assert_allclose([first[1], last[1]], expected[:, [0, 6]].T)
    several = readers.likelihood(seen, np.stack([table, table + 0.3]))
    other = readers.likelihood(seen, table[np.newaxis] + 0.3)
    np.testing.assert_allclose(several, np.logaddexp(found, other), atol=1e-12)


def test_of_answers_that_are_alike_the_middle_one_is_taken():
    rows = np.array([[0, 5, 5, 5, 0.0], [1, 0, 0, 0, 0], [0, 3, 3, 3, 3], [2, 2, 2, 2, 2]])
    np.testing.assert_array_equal(readers._drawn(rows), [2, 0, 2, 2])


def test_colors_lead_back_to_light_also_in_the_dark():
    rgb = np.random.default_rng(0).uniform(size=(50, 3)) ** 4
    rgb = np.vstack([rgb, np.linspace(0, 0.12, 60)[:, np.newaxis].repeat(3, axis=1)])
    found = xyz_of_lab(lab(rgb))
    np.testing.assert_allclose(found, linear(rgb) @ XYZ.T, atol=1e-6)


def test_candidates_of_a_normal_are_even_on_a_disc_and_have_their_tangents():
    normals, tangents = readers.candidates(300, 4, 0.7)
    assert normals.shape == tangents.shape == (1200, 3)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1)
    np.testing.assert_allclose(np.linalg.norm(tangents, axis=1), 1)
    np.testing.assert_allclose((normals * tangents).sum(axis=1), 0, atol=1e-12)
    square = (normals[:300, :2] ** 2).sum(axis=1)
    np.testing.assert_allclose(square, (np.arange(300) + 0.5) / 300)
    # The mean of points that are even on a disc is its middle.
    np.testing.assert_allclose(normals[:300, :2].mean(axis=0), 0, atol=0.005)
    # One after the other turns by the golden angle, (3 - sqrt(5)) pi.
    turn = np.unwrap(np.arctan2(normals[:300, 1], normals[:300, 0]))
    np.testing.assert_allclose(np.diff(turn), 2.399963229728653)
    assert turn[0] == pytest.approx(0.7 + 2.399963229728653 / 2)
    turned = tangents.reshape(4, 300, 3)
    cosine = np.abs((turned[0] * turned[1:]).sum(axis=2))
    expected = np.abs(np.cos(np.pi * np.arange(1, 4) / 4))
    np.testing.assert_allclose(cosine, np.repeat(expected[:, np.newaxis], 300, axis=1), atol=1e-9)


def test_a_channel_of_halves_tells_a_bit_and_equal_ranks_are_shared():
    np.testing.assert_allclose(readers.ranks(np.array([3.0, 1, 3, 0])), [3.5, 2, 3.5, 1])
    assert readers.rank_correlation(np.arange(9.0), np.arange(9.0) % 3) == pytest.approx(
        0.3162, 1e-3
    )
    x = np.arange(4096) / 4096
    half = readers.mutual_information(x, (x > 0.5).astype(float))
    # Of 16 classes and 2: a bit, less 1 or 2 of 16 + 2 classes by the bias of the sample.
    assert half == pytest.approx(1, abs=0.01)
    assert readers.mutual_information(x, np.zeros(4096)) == 0
    error = readers.ranked_error(x, (x >= 0.5).astype(float))
    # The answer of either half is its median.
    np.testing.assert_allclose(error, np.abs(x % 0.5 - 0.25), atol=2e-4)


def test_candidates_of_planes_have_two_tangents_across_the_normal():
    normals, tangents = readers.candidates(30, 2, 0.3)
    axes = dict(zip(("right", "up", "eye"), np.eye(3)[:, np.newaxis].repeat(60, 1), strict=True))
    place = SimpleNamespace(tangents=np.zeros((60, 2, 3)), light=lambda *given: given, **axes)
    frames, facing = readers._ball(place, normals, tangents)
    whole = np.concatenate([frames, facing[:, np.newaxis]], axis=1)
    np.testing.assert_allclose(whole @ whole.transpose(0, 2, 1), [np.eye(3)] * 60, atol=1e-12)


def test_lines_along_the_axes_are_read_whichever_way_they_run():
    turn, slope = np.radians([0.0, 179.9, 90.0, 45.0]), np.radians([30.5, -20.5, 89.5, 0.5])
    ways = np.stack(
        [np.cos(slope) * np.cos(turn), np.cos(slope) * np.sin(turn), np.sin(slope)], axis=1
    )
    sample = places(presets.heading(), np.vstack([ways, -ways]), kind="line")
    exact = Colors(lab(readers.shown(sample.light(sample.tangents, None))), np.full((8, 3), 0.1))
    (reading,) = readers.read_heading(sample, np.zeros(3), exact, (1.0,))
    assert reading.error.max() < 1e-4
    assert reading.truth[0].min() > 0.2
    np.testing.assert_allclose(readers.steepness(sample)[:4], np.abs(np.sin(slope)))
    toward = places(presets.heading(), np.array([[0, 0, 1.0], [0, 0, -1.0]]), kind="line")
    exact = Colors(lab(readers.shown(toward.light(toward.tangents, None))), np.full((2, 3), 0.1))
    (reading,) = readers.read_heading(toward, np.zeros(3), exact, (1.0,))
    assert reading.error.max() < 2


def test_conditioned_light_of_a_key_leaves_what_faces_away_dark():
    scene = Scene(lights=Light(direction=(0, 0, 1)), material=MATTE)
    normals, tangents = np.array([[0, 0, 1.0], [0, 0, -1]]), np.tile([1.0, 0, 0], (2, 1))
    sample = places(scene, tangents, normals)
    given = sample.inputs(sample.tangents, normals)
    assert given.normals is None
    np.testing.assert_allclose(sample.light(sample.tangents, normals), 0.9)
    options = dataclasses.replace(sample.options, conditioned=True)
    lit = dataclasses.replace(sample, options=options).light(sample.tangents, normals)
    np.testing.assert_allclose(lit, [[0.9] * 3, [0.1] * 3])
    bare = dataclasses.replace(sample, tangents=None)
    np.testing.assert_allclose(bare.light(None, normals), [[0.9] * 3, [0.1] * 3])


def test_a_grain_is_read_as_far_as_it_is_one():
    random = np.random.default_rng(0)
    angle = random.uniform(-180, 180, 2000)
    share = {"sure": 1.0, "half": 0.3, "none": 0.0}
    found = {
        name: readers.read_grain(c * np.exp(2j * np.radians(angle)), angle, 0.3)
        for name, c in share.items()
    }
    # Candidates are a degree apart; the height of a Gaussian of 3.7 degrees is 4.28 bits above 180.
    assert found["sure"].error.max() < 0.51
    assert readers.bits_told([found["sure"]]) == pytest.approx(4.25, abs=0.02)
    assert 3 < readers.bits_told([found["half"]]) < 3.5
    assert readers.bits_told([found["none"]]) < 0.01
    across = readers.read_grain(-np.exp(2j * np.radians(angle)), angle, 0.3)
    assert across.error.min() > 89
    assert readers.bits_told([across]) == 0


def test_dark_colours_are_known_less_than_the_bright_ones_around_them():
    white, gray = (eye.opponent(np.full((1, 2, 3), value)) for value in (1.0, 0.9))
    # Two pixels, half of each covered.
    seen = eye.SeenPicture(gray, np.full((1, 2, 3), 0.5), white[0, 0])
    at = np.zeros(2, dtype=int), np.arange(2)
    found = readers.colors_at(seen, *at, np.random.default_rng(0), 0.0)
    # Half of the light is the background's, so that the thing itself has 2 Y - 1.
    y = 2 * linear(np.array(0.9)) - 1
    np.testing.assert_allclose(found.lab[:, 0], 116 * np.cbrt(y) - 16, atol=1e-6)
    steeper = ((lab(np.full(3, 0.9))[0] + 16) / (116 * np.cbrt(y))) ** 2
    np.testing.assert_allclose(found.deviation, eye.ROUNDING / 0.5 * steeper, rtol=1e-6)
    # What is beside a point that has an eighth of the light adds 3/4 of what colours differ.
    channels = eye.opponent(np.array([[[0.9] * 3, [0.8] * 3]]))
    seen = eye.SeenPicture(channels, seen.cover, seen.ground)
    found, some = (
        readers.colors_at(seen, *at, np.random.default_rng(0), 0.0, share)
        for share in (None, np.full(3, 0.125))
    )
    own = found.deviation**2 + (0.75 * found.lab.std(axis=0)) ** 2
    np.testing.assert_allclose(some.deviation**2, own, rtol=1e-6)
