"""Ranges of bars: all values, most of them, or decades."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight.looks.ranges import (
    Range,
    range_of_turn,
    range_shown,
    share_beyond,
    with_regions,
)

RANDOM = np.random.default_rng(3)


@pytest.mark.parametrize("values", [
    RANDOM.normal(size=4000), RANDOM.uniform(size=4000), np.ones(5), np.array([0.0, 0, 0, 5.0]),
    np.array([2.0]),
])  # fmt: skip
@pytest.mark.parametrize("lengths", [True, False])
def test_values_without_outliers_take_all_of_the_bar(values, lengths):
    values = np.abs(values) if lengths else values
    shown = range_shown(values, lengths=lengths)
    assert shown.low <= values.min() <= values.max() <= shown.high
    # Round ends waste little of the bar.
    assert shown.high - shown.low <= 1.1 * np.ptp(values)
    assert shown == Range(shown.low, shown.high)


def test_few_values_far_outside_lie_beyond_the_ends():
    values = np.concatenate([RANDOM.uniform(10, 11, 4000), [-80.0, -70.0, -60.0]])
    shown = range_shown(values)
    assert shown.clipped == (True, False)
    assert not shown.apart
    assert 8.5 < shown.low < 10
    assert values.max() <= shown.high < values.max() + 0.1
    assert f"from {shown.low:g} to" in shown.words("t")


def test_a_long_tail_of_many_values_is_seen_to_its_end():
    # As grades of minerals are: those that are sought are far above most others.
    values = np.random.default_rng(0).lognormal(-0.5, 0.8, 4000)
    assert np.mean(values > 3) > 0.02
    shown = range_shown(values)
    assert shown.high >= values.max()
    assert not any(shown.clipped)


def test_peaks_of_lengths_lie_beyond_the_end():
    lengths = np.append(RANDOM.uniform(0, 1, 4000), RANDOM.uniform(1.5, 2, 10))
    shown = range_shown(lengths, lengths=True)
    assert 1 <= shown.high < 1.5
    assert shown.clipped == (False, True)
    # An engineer looks for the peaks of a stress.
    assert range_shown(lengths).high >= lengths.max()


def test_long_tails_on_both_sides_lie_beyond_the_ends():
    """As derivatives have near a sharp edge: Student's distribution of one degree of freedom."""
    values = np.random.default_rng(0).standard_t(1, 4000)
    shown = range_shown(values)
    inner = np.ptp(np.percentile(values, (5, 95)))
    assert inner <= shown.high - shown.low < 1.3 * inner
    assert shown.clipped == (True, True)
    assert "where most values are" in shown.words("adjoint")
    # Tails of many values that end soon are seen to their ends.
    short = np.concatenate([RANDOM.normal(0, 1, 3000), RANDOM.uniform(-12, 12, 1000)])
    assert not any(range_shown(short).clipped)


def test_properties_of_rock_over_decades_have_a_logarithmic_bar():
    values = np.random.default_rng(0).lognormal(4, 2, 4000)
    shown = range_shown(values, decades=True)
    assert shown.logarithmic
    assert shown.high >= values.max()
    assert shown.low <= np.percentile(values, 2)
    assert not range_shown(values).logarithmic
    assert not range_shown(np.linspace(3, 9, 50), decades=True).logarithmic


def test_one_repeated_value_far_outside_is_a_region_apart():
    values = np.concatenate([RANDOM.normal(2.4, 0.4, 4000), np.zeros(200)])
    shown = range_shown(values)
    assert shown.apart
    assert 0.5 < shown.low < 1.5
    assert "grey" in shown.words("thickness")
    many = np.concatenate([values, np.zeros(2000)])
    assert not any(range_shown(many).clipped)


def test_lengths_that_are_skewed_have_decades():
    values = RANDOM.lognormal(0, 1.3, 4000)
    shown = range_shown(values, lengths=True)
    assert shown.logarithmic
    assert shown.high / shown.low == pytest.approx(100, rel=0.2)
    assert shown.clipped == (True, False)
    assert not range_shown(values).logarithmic
    assert "logarithmic" in shown.words("speed")
    assert Range(0, 1).words("x") == ""


def test_amounts_that_are_mostly_none_have_a_ground():
    wet = RANDOM.lognormal(0, 1.3, 1000)
    rain = np.concatenate([np.zeros(3000), wet])
    shown = range_shown(rain, amounts=True)
    assert shown.logarithmic
    assert shown.ground
    assert np.mean(rain < shown.low) > 0.7
    ratios = np.divide(shown.classes[1:], shown.classes[:-1])
    assert (ratios > 1.3).all()
    assert (ratios < 1.7).all()
    assert shown.classes[0] == shown.low
    assert "white" in shown.words("rain")
    ice = np.concatenate([np.zeros(3000), RANDOM.uniform(0.8, 1.0, 1000)])
    shown = range_shown(ice, amounts=True)
    assert shown[:3] == (0.05, 1.0, False)
    assert shown.ground
    # Salinity on land is 0, which is far from all others.
    salt = range_shown(np.where(ice > 0, 30 + 8 * ice, 0), amounts=True)
    assert (salt.apart, salt.ground) == (True, False)
    assert 36 <= salt.low < 38 <= salt.high
    # Rounding below 0 changes nothing, and what is nowhere 0 has no ground.
    assert range_shown(np.append(rain, -1e-9), amounts=True).ground
    assert not range_shown(ice + 0.1, amounts=True).ground


def test_values_on_both_sides_of_0_have_it_in_their_middle():
    values = np.linspace(-1.0, 2.0, 100)
    shown = range_shown(values)
    assert shown.is_signed
    assert shown.around_zero(values) == Range(-2, 2)
    assert not range_shown(np.linspace(-0.5, 2, 100)).is_signed
    assert not range_shown(values[values > 0]).is_signed
    # Beyond the ends that were clipped there may be none now.
    outside = np.concatenate([RANDOM.normal(size=4000), [-50.0], np.full(20, 6.0)])
    around = range_shown(outside).around_zero(outside)
    assert around.low == -around.high
    assert around.clipped == (True, outside.max() > around.high)


@pytest.mark.parametrize(
    ("low", "high", "ends"),
    [(1, 359, (0, 360)), (-170, 175, (-180, 180)), (0, 100, None), (-90, 300, None)],
)
def test_directions_have_a_whole_turn(low, high, ends):
    turn = range_of_turn(np.array([low, high], dtype=float))
    assert (turn and turn[:2]) == ends


def test_one_value_is_apart_only_where_none_is_near():
    """As recharges in zones, of which one is the least of a smooth range."""
    zones = np.repeat([168.0, 170, 171, 172, 175, 178], [60, 150, 150, 250, 100, 60])
    near = np.concatenate([zones, np.linspace(168, 178, 90)])
    assert range_shown(near) == Range(168, 178)


def test_a_value_farther_than_all_others_reach_is_apart_however_many_have_it():
    values = np.concatenate([np.full(3000, -99900.0), RANDOM.uniform(-7, 60, 1000)])
    shown = range_shown(values)
    assert (shown.apart, shown.clipped) == (True, (True, False))
    assert -10 <= shown.low <= -6
    assert 59 <= shown.high <= 65


def test_the_range_is_not_that_of_rounding():
    values = np.concatenate([1 + 1e-15 * RANDOM.normal(size=4000), RANDOM.uniform(0.6, 1.5, 700)])
    shown = range_shown(values)
    assert shown.low <= values.min() <= values.max() <= shown.high


@pytest.mark.parametrize("of_cells", [False, True])
def test_the_range_is_clipped_of_noise_and_not_of_a_region(of_cells):
    sheet = pv.ImageData(dimensions=(101, 101, 1))
    size = sheet.n_cells if of_cells else sheet.n_points
    places = sheet.cell_centers().points if of_cells else sheet.points
    is_bump = np.linalg.norm(places - (50, 50, 0), axis=1) < 14
    bump = RANDOM.normal(0, 0.1, size) + 5 * is_bump
    noise = np.where(is_bump[RANDOM.permutation(size)], bump.max(), bump - 5 * is_bump)
    for values, clipped in ((bump, False), (noise, True)):
        shown = range_shown(values)
        assert any(shown.clipped)

        def beyond(ends, values=values):
            outside = (values < ends.low) | (values > ends.high)
            return share_beyond(sheet, outside, of_cells=of_cells)

        assert any(with_regions(shown, values, beyond).clipped) == clipped


def test_a_region_on_a_lit_surface_is_seen_to_its_largest_value():
    plane = pv.Plane(i_resolution=60, j_resolution=60)
    plane.points[:, 2] = -np.sum(plane.points[:, :2] ** 2, axis=1)
    is_patch = np.linalg.norm(plane.points[:, :2], axis=1) < 0.12
    plane["stress"] = np.random.default_rng(1).normal(0, 0.1, plane.n_points) + 5 * is_patch
    look = vizlight.look(plane, "value", array="stress", size=(300, 200))
    assert look.drawing.keys[0]["clim"][1] == pytest.approx(plane["stress"].max())
