"""Phong and Blinn: the printed tables, the bounds that all rests on, the better rule."""

from functools import lru_cache

import numpy as np
import oracles
import pytest
from oracles import mp
from refusals import refusals

from vizlight.model import highlights, reflection

TABLE_1 = {
    5: "4.0038", 20: "4.06", 40: "4.28", 60: "4.82", 80: "6.57", 85: "8.01", 87: "9.19",
    89: "11.98", 89.5: "13.85", 89.9: "18.37",
}  # fmt: skip
# Fisher and Woo's table 2, rows by rho in degrees, columns by r from 5 to 45.
TABLE_2 = {
    10: "0.069 0.128 0.179 0.221 0.255 0.284 0.307 0.325 0.339",
    20: "0.906 1.330 1.466 1.435 1.318 1.161 0.995 0.835 0.690",
    30: "3.252 3.210 2.376 1.564 0.965 0.571 0.329 0.186 0.103",
    40: "6.227 3.437 1.424 0.525 0.181 0.060 0.019 0.006 0.002",
    50: "7.668 1.913 0.360 0.060 0.010 0.001 0.000 0.000 0.000",
    60: "6.391 0.560 0.038 0.002 0.000 0.000 0.000 0.000 0.000",
    70: "3.525 0.082 0.002 0.000 0.000 0.000 0.000 0.000 0.000",
    80: "1.195 0.006 0.000 0.000 0.000 0.000 0.000 0.000 0.000",
    85: "0.573 0.001 0.000 0.000 0.000 0.000 0.000 0.000 0.000",
}
# Its table 3, rows by r, columns by the angle between light and eye from 0 to 180 degrees.
TABLE_3 = {
    10: "-3.63 4.73 25.56 63.75 122.24 198.52 255.00",
    20: "-1.77 5.53 26.23 63.75 121.35 197.23 255.00",
    40: "-0.87 6.00 26.56 63.75 120.91 196.59 255.00",
    60: "-0.58 6.16 26.67 63.75 120.77 196.37 255.00",
    80: "-0.44 6.24 26.73 63.75 120.69 196.27 255.00",
    100: "-0.35 6.29 26.76 63.75 120.65 196.20 255.00",
    200: "-0.18 6.40 26.83 63.75 120.56 196.08 255.00",
    300: "-0.12 6.43 26.86 63.76 120.54 196.03 255.00",
    400: "-0.09 6.45 26.87 63.76 120.52 196.01 255.00",
}
# Where print and mathematics differ in the last digit: row, column from 0.
SLIPS_2 = {(10, j) for j in (2, 3, 5, 6, 7, 8)} | {(20, 5)}
SLIPS_3 = {
    (80, 0), (80, 1), (80, 4), (100, 1), (200, 0), (200, 4), (200, 5), (300, 2), (300, 3),
    (400, 2), (400, 3),
}  # fmt: skip


def numbers(table):
    return {row: [float(x) for x in text.split()] for row, text in table.items()}


def test_table_1_to_its_last_digit():
    for rho, printed in TABLE_1.items():
        digits = len(printed.partition(".")[2])
        assert f"{highlights.required_factor(np.deg2rad(rho)):.{digits}f}" == printed


def test_table_2_to_its_last_digit():
    r = np.arange(5, 46, 5)
    slips = set()
    for rho, row in numbers(TABLE_2).items():
        value = highlights.pixel_error(np.deg2rad(rho), r)
        for j, (got, printed) in enumerate(zip(value, row, strict=True)):
            angle, s = mp.radians(rho), int(r[j])
            exact = 255 * (mp.cos(angle / 2) ** (4 * s) - mp.cos(angle) ** s)
            assert got == pytest.approx(float(exact), abs=1e-11)
            assert abs(got - printed) < 1.5e-3
            if f"{got:.3f}" != f"{printed:.3f}":
                slips.add((rho, j))
    assert slips == SLIPS_2


def test_table_3_to_its_last_digit():
    angles = np.deg2rad(np.arange(0, 181, 30))
    slips = set()
    for r, row in numbers(TABLE_3).items():
        value = highlights.max_pixel_error(angles, r).error
        for j, (got, printed) in enumerate(zip(value, row, strict=True)):
            assert abs(got - printed) < 0.0151
            if f"{got:.2f}" != f"{printed:.2f}":
                slips.add((r, j))
    assert slips == SLIPS_3
    # At a right angle the maximum of y - y^2 is 1/4, whatever r: 63.75, where 63.76 is printed.
    assert highlights.max_pixel_error(np.pi / 2, 300).error == pytest.approx(63.75, abs=1e-9)


def cosines(angle, normals):
    """Cosines of R and of H by their definitions, and N.L, of normals in the source's frame."""
    light = np.array([-np.sin(angle), 0, np.cos(angle)])
    eye = np.array([0.0, 0, 1])
    half = (light + eye) / np.linalg.norm(light + eye)
    mirror = 2 * (normals @ light)[..., np.newaxis] * normals - light
    return np.maximum(mirror @ eye, 0), np.maximum(normals @ half, 0), normals @ light


def errors_of_normals(angle, r, factor, normals):
    """Phong minus Blinn of normals, and N.L."""
    mirror, half, facing = cosines(angle, normals)
    return 255 * (mirror**r - half ** (factor * r)), facing


def normal(theta, phi):
    return np.stack(
        [-np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], axis=-1
    )


@pytest.mark.parametrize(("degrees", "r", "printed"), [(120, 40, 7.8), (140, 180, 6.0)])
def test_deviations_of_the_summary(degrees, r, printed):
    """Over a grid of the source's angles, theta and phi in steps of a degree: below 10."""
    theta, phi = np.meshgrid(*[np.linspace(0, np.pi, 181)] * 2)
    errors, _ = errors_of_normals(np.deg2rad(degrees), r, 4.0, normal(theta, phi))
    assert errors.std() == pytest.approx(printed, abs=0.05)


@lru_cache(maxsize=1)
def phong_of_the_grid(degrees, r):
    """Phong's light of a fine grid of normals, the cosine of H, and which are lit."""
    # Light and eye have the other side, theta above a right angle, for a mirror image.
    theta, phi = np.meshgrid(np.linspace(0, np.pi / 2, 361), np.linspace(0, np.pi, 721))
    mirror, half, facing = cosines(np.deg2rad(degrees), normal(theta, phi).reshape(-1, 3))
    # A normal with neither highlight has no error.
    seen = (mirror > 0) | (half > 0)
    return mirror[seen] ** r, half[seen], facing[seen] >= 0


@pytest.mark.sampled(4)
@pytest.mark.parametrize("factor", [1.0, 2.0, 3.0, 4.0, 6.0])
@pytest.mark.parametrize("degrees", [0.0, 1.0, 45.0, 90.0, 135.0, 170.0])
@pytest.mark.parametrize("r", [1.0, 5.0, 30.0])
def test_no_normal_has_a_larger_error(factor, degrees, r, random):
    """Against every normal of a fine grid; the location told has the error told."""
    angle = np.deg2rad(degrees)
    found = highlights.max_pixel_error(angle, r, factor=factor)
    phong, half, facing = phong_of_the_grid(degrees, r)
    every = 255 * (phong - half ** (factor * r))
    largest = float(np.abs(every).max())
    assert largest <= abs(found.error) + 1e-9
    assert largest >= abs(found.error) - 0.2
    there, _ = errors_of_normals(angle, r, factor, normal(found.theta, found.phi))
    assert there == pytest.approx(float(found.error), abs=1e-6)
    lit = highlights.max_pixel_error(angle, r, factor=factor, lit=True)
    largest = float(np.abs(every[facing]).max())
    assert largest == pytest.approx(abs(float(lit.error)), abs=1.0)
    assert largest <= abs(lit.error) + 1e-9


@pytest.mark.parametrize(("k", "n"), [(1, 2), (2, 3), (1, 3), (3, 4), (2, 4), (1, 4), (3, 6)])
def test_phong_lies_between_two_of_blinn_in_every_codimension(k, n, random):
    frame = oracles.frames(random, 4000, k, n, float)
    wi, wo = random.standard_normal((2, 4000, n))
    wi /= np.linalg.norm(wi, axis=1, keepdims=True)
    wo /= np.linalg.norm(wo, axis=1, keepdims=True)
    phong = reflection.specular(wi, wo, frame, shininess=1)
    x = 1 - reflection.specular(wi, wo, frame, shininess=2, model="blinn")
    cos2 = (1 + np.sum(wi * wo, axis=1)) / 2
    assert np.all(phong <= np.maximum(1 - 2 * cos2 * x, 0) + 1e-14)
    assert np.all(phong >= 1 - 2 * x - 1e-14)
    angle = np.arccos(np.clip(np.sum(wi * wo, axis=1), -1, 1))
    for r, factor in ((3.0, 4.0), (20.0, 2.5)):
        bound = np.abs(highlights.max_pixel_error(angle, r, factor=factor).error)
        error = phong**r - reflection.specular(wi, wo, frame, shininess=factor * r, model="blinn")
        assert np.all(255 * np.abs(error) <= bound + 1e-9)


@pytest.mark.parametrize("r", [5.0, 40.0, 1e4])
def test_the_better_rule_is_better(r):
    """The best factor by the worst error is no worse than 4 and 4 cos(beta), and these agree."""
    angle = np.deg2rad([0.0, 30, 60, 90, 120, 150])
    best = highlights.best_factor(angle, r)
    simple = highlights.simple_factor(angle)

    def worst(factor):
        return np.abs(highlights.max_pixel_error(angle, r, factor=factor, lit=True).error)

    for other in (4.0, simple, 1.01 * best, 0.99 * best):
        assert np.all(worst(best) <= worst(other) + 1e-6)
    if r == 1e4:
        np.testing.assert_allclose(best, simple, rtol=2e-3)
        # The limits that the docstrings tell, of both rules.
        for factor, c in ((4.0, np.cos(angle / 2) ** 2), (simple, np.cos(angle / 2))):
            c = np.where(c == 1, 0.5, c)
            limit = np.where(angle > 0, 255 * (1 - c) * c ** (c / (1 - c)), 0)
            np.testing.assert_allclose(worst(factor), limit, atol=0.1)


def test_the_rule_for_small_powers():
    angle = np.deg2rad(np.arange(0, 121, 5))
    for r in (10.0, 20.0, 50.0, 300.0):
        factors = (highlights.simple_factor(angle, r), 4.0, highlights.best_factor(angle, r))
        ours, four, best = (
            np.abs(highlights.max_pixel_error(angle, r, factor=f, lit=True).error) for f in factors
        )
        assert np.all(ours <= np.maximum(1.1 * best, best + 0.5) + 1e-9)
        assert np.all(ours <= four + 0.1)


@pytest.mark.parametrize("by", ["rms", "volume"])
def test_best_factor_by_the_sphere(by):
    for degrees, r in ((30.0, 10.0), (90.0, 20.0), (120.0, 40.0)):
        angle = np.deg2rad(degrees)
        best = float(highlights.best_factor(angle, r, by=by))
        least = highlights.sphere_error(angle, r, factor=best, by=by)
        for other in (4.0, 0.98 * best, 1.02 * best):
            assert least <= highlights.sphere_error(angle, r, factor=other, by=by) + 1e-9
    worst = highlights.sphere_error(np.pi / 2, 10, by="worst")
    assert worst == pytest.approx(63.75, abs=1e-9)


@pytest.mark.parametrize(
    ("k", "n", "rule"),
    [
        (2, 3, lambda c: 4 * c),
        (1, 2, lambda c: 4 + 0 * c),
        (1, 3, lambda c: (4 * c / (1 + c)) ** 2),
        (3, 4, lambda c: 4 * c ** (4 / 3)),
    ],
)
def test_exchange_rate_in_closed_form(k, n, rule):
    angle = np.linspace(0, np.deg2rad(170), 18)
    value = highlights.exchange_rate(angle, k=k, n=n)
    np.testing.assert_allclose(value, rule(np.cos(angle / 2)), rtol=1e-11)


@pytest.mark.parametrize(("k", "n"), [(1, 3), (2, 4), (3, 5), (1, 4), (2, 5), (3, 6)])
def test_exchange_rate_by_random_tangent_spaces(k, n, random):
    """The mean over the bright set, by tangent spaces drawn across the half vector."""
    angle = np.deg2rad(80.0)
    spaces = np.linalg.qr(random.standard_normal((60_000, n - 1, k)))[0]
    share = np.sum(spaces[:, 0, :] ** 2, axis=1)
    logs = np.log1p(-share * np.sin(angle / 2) ** 2)
    mean, error = -np.mean(logs) / k, np.std(logs) / k / np.sqrt(len(logs))
    value = np.log(highlights.exchange_rate(angle, k=k, n=n) / (4 * np.cos(angle / 2) ** 2))
    assert abs(value - mean) < 4 * error


def test_conversions_there_and_back():
    s = np.array([0.0, 1, 20, 1e6])
    np.testing.assert_array_equal(highlights.blinn_from_phong(s), 4 * s)
    for angle in (None, 0.0, 1.0, 3.0):
        there = highlights.blinn_from_phong(s, light_eye_angle=angle)
        np.testing.assert_allclose(
            highlights.phong_from_blinn(there, light_eye_angle=angle), s, rtol=1e-15
        )
    assert highlights.blinn_from_phong(10, factor=3.5) == 35


@pytest.mark.parametrize("r", [0.0, 0.3, 1.0, 2.0, 1e6, 1e9])
def test_extreme_powers(r):
    value = highlights.max_pixel_error(np.linspace(0, np.pi, 7), r)
    assert np.isfinite(value.error).all()
    assert np.abs(value.error).max() <= 255
    if r == 0:
        assert not np.any(value.error)
    if r == 1e9:
        assert value.error[3] == pytest.approx(63.75, abs=1e-4)


@pytest.mark.parametrize(
    ("rho", "r", "factor"), [(np.pi, 0.1, 1), (3.14, 0.1, 1), (3.0, 2, 0.5), (1.0, 1, 1)]
)
def test_pixel_error_near_the_far_side(rho, r, factor):
    """Where cos(rho / 2) is small it is not 1 - sin^2."""
    with mp.workdps(50):
        blinn = mp.cos(mp.mpf(rho) / 2) ** (mp.mpf(factor) * mp.mpf(r))
        expected = 255 * (blinn - max(mp.mpf(0), mp.cos(mp.mpf(rho))) ** mp.mpf(r))
        assert abs(highlights.pixel_error(rho, r, factor=factor) - expected) < 1e-11


test_bad_input = refusals(
    lambda call: call(),
    (lambda: highlights.required_factor(-1), "rho: expected angles from 0 to pi"),
    (lambda: highlights.required_factor("x"), "rho: expected real numbers", TypeError),
    (lambda: highlights.pixel_error(1, -1), "r: expected numbers from 0"),
    (lambda: highlights.max_pixel_error(4, 10), "light_eye_angle: expected"),
    (lambda: highlights.max_pixel_error(np.nan, 10), "light_eye_angle: expected"),
    (lambda: highlights.max_pixel_error(1, 1, factor=-4), "factor: expected"),
    (lambda: highlights.best_factor(1, 10, by="mean"), "by: expected 'worst'"),
    (lambda: highlights.best_factor(1, 0), "r: expected numbers from 0.5"),
    (lambda: highlights.sphere_error(1, 10, by="mean"), "by: expected 'worst'"),
    (
        lambda: highlights.phong_from_blinn(10, light_eye_angle=np.pi),
        "light_eye_angle: expected an angle below pi",
    ),
    (lambda: highlights.exchange_rate(1, k=3, n=3), "k: expected a dimension less than n"),
)


def test_shapes_that_do_not_fit_are_told_by_name():
    with pytest.raises(
        ValueError, match=r"rho, r, factor: expected shapes that broadcast, got \(3"
    ):
        highlights.pixel_error([0.1, 0.2, 0.3], [1, 2])
    with pytest.raises(ValueError, match="shininess, light_eye_angle: expected shapes that"):
        highlights.blinn_from_phong([1, 2, 3], light_eye_angle=[1, 2])
    with pytest.raises(
        ValueError, match="light_eye_angle, r, factor: expected shapes that broadcast"
    ):
        highlights.max_pixel_error([1, 2, 3], [1, 2])
    with pytest.raises(ValueError, match="light_eye_angle, r: expected shapes that broadcast"):
        highlights.simple_factor([1, 2], [1, 2, 3])
    assert highlights.phong_from_blinn(highlights.blinn_from_phong(1e9)) == 1e9
