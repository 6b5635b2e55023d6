"""The sky of height fields: closed forms, every crossing as the truth, odd fields, both codes."""

import numpy as np
import pytest

from studies.sky import ground
from vizlight import _compiled, _pool
from vizlight.geometry.relief import sky as module
from vizlight.geometry.relief.sky import sky

#: NumPy's way takes long.
FAST = pytest.mark.parametrize("fast", [pytest.param("0", marks=pytest.mark.slow), "1"])


@pytest.fixture(autouse=True)
def code(request, monkeypatch):
    """Run by NumPy or by compiled code, as the test asks."""
    fast = getattr(request.node, "callspec", None)
    fast = fast.params.get("fast", "1") if fast else "1"
    monkeypatch.setenv("VIZLIGHT_FAST", fast if not _compiled._missing() else "0")


def height(x, y, z, px, py):
    """Return the bilinear height at places, those beyond the border at the border."""
    px, py = np.clip(px, x[0], x[-1]), np.clip(py, y[0], y[-1])
    i = np.clip(np.searchsorted(x, px, "right") - 1, 0, len(x) - 2)
    j = np.clip(np.searchsorted(y, py, "right") - 1, 0, len(y) - 2)
    u, v = (px - x[i]) / (x[i + 1] - x[i]), (py - y[j]) / (y[j + 1] - y[j])
    low = z[j, i] + u * (z[j, i + 1] - z[j, i])
    return low + v * (z[j + 1, i] + u * (z[j + 1, i + 1] - z[j + 1, i]) - low)


def truth(x, y, z, j, i, count=512):
    """Return the sky of a node from heights at dense distances, for many azimuths."""
    q, p = np.gradient(z, y, x)
    p, q = p[j, i], q[j, i]
    turn = 2 * np.pi * (np.arange(count) + 0.5) / count
    reach = np.hypot(np.ptp(x), np.ptp(y))
    step = np.diff(x).min()
    s = np.concatenate([np.arange(1, 200) * step / 25, np.arange(8 * step, reach, step / 4)])
    places = height(x, y, z, x[i] + s * np.cos(turn)[:, None], y[j] + s * np.sin(turn)[:, None])
    slope = ((places - z[j, i]) / s).max(axis=1)
    rise = p * np.cos(turn) + q * np.sin(turn)
    t = np.maximum(np.maximum(slope, 0), rise)
    part = 1 / (1 + t * t) - rise * (np.arctan2(1, t) - t / (1 + t * t))
    return np.mean(part) / np.sqrt(1 + p * p + q * q)


@FAST
@pytest.mark.parametrize(("angle", "turn"), [(0.0, 0.0), (0.3, 2.0), (0.8, 0.5), (1.3, 2.0)])
def test_an_endless_slope(angle, turn, fast):
    x, y = np.linspace(0, 400, 41), np.linspace(0, 300, 21)
    z = np.tan(angle) * (x * np.cos(turn) + y[:, None] * np.sin(turn))
    found = sky(x, y, z, error=0.01)
    assert found.error <= 0.01
    wanted = (1 + np.cos(angle)) / 2
    # Beyond the border heights are those of the border, which a steep slope's side sees.
    assert found.share[10, 20] == pytest.approx(wanted, abs=0.01 if angle < 1 else 0.02)


@FAST
def test_a_step(fast):
    """At the foot of an endless wall half of the sky is left; above it all."""
    x = np.sort(np.concatenate([np.linspace(-500, 500, 41), [-1e-3, 1e-3]]))
    z = np.where(x > 0, 1e5, 0.0) * np.ones((41, 1))
    y = np.linspace(-500, 500, 41)
    found = sky(x, y, z, error=0.02)
    left = np.flatnonzero(x < 0)[:-3]
    assert np.abs(found.share[20, left] - 0.5).max() < 0.04
    assert found.share[20, 30] == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("width", [1e-6, 1.0, 5000.0])
def test_a_trench(width):
    """Between walls of height h, w apart, the middle sees sin(atan(w / 2h))."""
    x = np.array([-400, -200, -100, -60, -50.01, -50, -20, -1, 0, 1, 20, 50, 50.01, 60, 100.0, 400])
    z = np.where(np.abs(x) > 50.005, 50.0, 0.0) * np.ones((61, 1))
    y = np.linspace(-3000, 3000, 61)
    found = sky(width * x, width * y, width * z, error=0.005)
    assert found.share[30, 8] == pytest.approx(np.sqrt(0.5), abs=0.008)


def test_a_bowl():
    """Each point of a half ball's inside sees the rim the same: half of the sky."""
    x = np.linspace(-1.5, 1.5, 301)
    square = np.minimum(x * x + x[:, None] ** 2, 1)
    found = sky(x, x, -np.sqrt(1 - square), error=0.005)
    inner = x * x + x[:, None] ** 2 < 0.6
    assert np.abs(found.share[inner] - 0.5).max() < 0.02
    assert np.abs(found.share[inner] - 0.5).mean() < 0.005


@pytest.mark.sampled(2)
@pytest.mark.parametrize("slope", [0.2, 1.0])
@pytest.mark.parametrize("error", [0.02, pytest.param(0.0015, marks=pytest.mark.slow)])
def test_the_error_holds_on_rough_ground(slope, error):
    z = ground(96, slope, seed=int(10 * slope))
    x = np.arange(96.0)
    found = sky(x, x, z, error=error)
    at = np.random.default_rng(3).integers(0, 96, (40, 2))
    inside = (at > 0).all(axis=1) & (at < 95).all(axis=1)
    missed = [abs(found.share[j, i] - truth(x, x, z, j, i)) for j, i in at[inside]]
    # The quantile of 40 nodes is not that of all.
    assert found.error <= error
    assert np.quantile(missed, 0.9) <= error
    assert np.mean(missed) < error / 2


def posts(count):
    z = np.zeros((count, count))
    z[np.random.default_rng(5).random(z.shape) < 1 / 60] = 0.6
    return z


def city(count):
    random, z = np.random.default_rng(6), np.zeros((count, count))
    for j, i, b, a in random.integers((0, 0, 2, 2), (count, count, 7, 7), (count * count // 80, 4)):
        z[j : j + b, i : i + a] = random.uniform(1, 12)
    return z


@FAST
@pytest.mark.parametrize("field", [posts, pytest.param(city, marks=pytest.mark.slow)])
def test_what_is_asked_is_kept(field, fast):
    """Where horizons are narrow, by both codes."""
    z, x = field(48), np.arange(48.0)
    found = sky(x, x, z, error=0.01)
    assert found.error <= 0.01
    at = np.random.default_rng(3).integers(1, 47, (30, 2))
    missed = [abs(found.share[j, i] - truth(x, x, z, j, i)) for j, i in at]
    assert np.quantile(missed, 0.9) <= 0.01


@pytest.mark.parametrize(
    ("seed", "fast"), [pytest.param(1, "0", marks=pytest.mark.slow), (1, "1"), (2, "1")]
)
def test_very_uneven_cells(seed, fast):
    """From the foot of an endless wall of elevation b, (1 + cos b) / 2 is seen."""
    random = np.random.default_rng(seed)
    x = np.cumsum(10 ** random.uniform(-6, 3.7, 40))
    y = np.cumsum(10 ** random.uniform(-2, 2, 13))
    high = 0.3 * x[-1]
    found = sky(x, y, np.where(np.arange(40) > 20, high, 0.0) * np.ones((13, 1)), error=0.003)
    wanted = (1 + np.cos(np.arctan2(high, x[21] - x[:20]))) / 2
    assert np.quantile(np.abs(found.share[:, :20] - wanted), 0.95) <= max(found.error, 0.003)


@pytest.mark.slow
def test_the_way_depends_on_the_field_and_the_error_alone(monkeypatch):
    """Not on what ran before, nor on the number of threads."""
    monkeypatch.delenv("VIZLIGHT_FAST")
    z, x = city(32), np.arange(32.0)
    first = sky(x, x, z)
    assert first.method == "horizons through every cell"
    for threads in (1, 3):
        for _ in range(2):
            sky(x, x, ground(32, 1.0), error=0.03)
        with _pool.threads(threads):
            assert np.array_equal(sky(x, x, z).share, first.share)


@pytest.mark.slow
def test_steps_of_numpy_give_way_to_every_cell(monkeypatch):
    """Where they miss more than is asked."""
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    z, x = 4 * city(48), np.arange(48.0)
    exact = sky(x, x, z, error=0.02)
    monkeypatch.setattr(module, "SMALL", 100)
    steps = sky(x, x, z, error=0.04)
    assert steps.method == "horizons by steps"
    assert np.quantile(np.abs(steps.share - exact.share), 0.95) <= 0.06
    monkeypatch.setattr(module, "NEAR_BY_STEPS", (1,))
    assert sky(x, x, z, error=0.02).method == "horizons through every cell"


@pytest.mark.slow
def test_by_numpy_the_error_holds_too(monkeypatch):
    monkeypatch.setenv("VIZLIGHT_FAST", "0")
    z, x = ground(64, 0.5), np.arange(64.0)
    found = sky(x, x, z, error=0.01)
    assert found.method == "horizons through every cell"
    missed = [
        abs(found.share[j, i] - truth(x, x, z, j, i)) for j, i in ((9, 20), (30, 31), (50, 7))
    ]
    assert max(missed) < 0.02


@pytest.mark.slow
def test_unequal_spacing_and_the_number_of_threads():
    random = np.random.default_rng(2)
    x, y = (np.cumsum(random.uniform(0.3, 3, n)) for n in (50, 60))
    z = 3 * np.sin(x / 5) * np.cos(y[:, None] / 7) + 0.5 * np.sin(x / 1.7 + y[:, None])
    with _pool.threads(1):
        one = sky(x, y, z, error=0.01)
    with _pool.threads(2):
        two = sky(x, y, z, error=0.01)
    assert np.array_equal(one.share, two.share)
    at = random.integers(1, 49, (10, 2))
    missed = [abs(one.share[j, i] - truth(x, y, z, j, i)) for j, i in at]
    assert np.quantile(missed, 0.8) <= one.error


@pytest.mark.sampled(3)
@FAST
@pytest.mark.parametrize("openness", [False, True])
def test_rows_of_other_lengths_see_a_field_of_their_own(openness, fast):
    """Each row as if all had its length of a unit of x, as degrees of longitude have."""
    x, y, z = np.arange(16.0), np.arange(14.0), ground(16, 0.6)[:14]
    stretch = np.linspace(0.3, 1.2, len(y))
    shares = sky(x, y, z, error=0.05, stretch=stretch, openness=openness)
    assert shares.error <= 0.05
    rows = [2, 7, 12]
    expected = [
        sky(stretch[row] * x, y, z, error=0.02, openness=openness).share[row] for row in rows
    ]
    assert np.quantile(np.abs(shares.share[rows] - expected), 0.95) <= shares.error + 0.02


@FAST
def test_a_mirrored_field_has_the_mirrored_sky(fast):
    z, x = ground(28, 0.6), np.arange(28.0)
    found = sky(x, x, z, error=0.01).share
    for turned, back in (
        (z[::-1], np.s_[::-1]), (z[:, ::-1], np.s_[:, ::-1]), (z.T, None)
    ):  # fmt: skip
        other = sky(x, x, turned, error=0.01).share
        other = other.T if back is None else other[back]
        assert np.abs(other - found).mean() < 0.01


@FAST
def test_holes_hide_nothing_and_have_no_sky(fast):
    x = np.arange(30.0)
    z = np.zeros((30, 30))
    z[10:20, 18:] = 50.0
    walled = sky(x, x, z, error=0.02).share[15, 12]
    z[10:20, 18:] = np.nan
    found = sky(x, x, z, error=0.02)
    assert np.isnan(found.share[15, 25])
    assert found.share[15, 12] == pytest.approx(1.0, abs=1e-6)
    assert walled < 0.8
    z[:] = np.nan
    z[3, 3] = 1.0
    assert sky(x, x, z).share[3, 3] == 1.0


@FAST
def test_openness(fast):
    """Level ground is a right angle open; a valley is less by the slope in each azimuth."""
    x = np.linspace(-100, 100, 81)
    level = sky(x, x, np.zeros((81, 81)), openness=True)
    assert np.abs(level.share - np.pi / 2).max() < 1e-6
    found = sky(x, x, np.abs(x) * np.ones((81, 1)), openness=True, error=0.01)
    turn = np.linspace(0, 2 * np.pi, 1001)[:-1]
    wanted = np.mean(np.pi / 2 - np.arctan(np.abs(np.cos(turn))))
    assert found.share[40, 40] == pytest.approx(wanted, abs=0.01)


def test_bisection_on_a_long_hull():
    """A dome behind a hole: the hull of its arc is not shortened by points before it."""
    x = np.arange(400.0)
    arc = np.sqrt(np.maximum(150.0**2 - (x - 250) ** 2, 0))
    z = np.tile(arc, (30, 1))
    z[:, 5:110] = np.nan
    found = sky(x, np.arange(30.0) * 50, z, error=0.02)
    # Toward a cylinder across y the tangent is at asin(r / d).
    j, wanted = 15, (1 + np.cos(np.arcsin(150 / 250))) / 2
    assert found.share[j, 0] == pytest.approx(wanted, abs=0.03)


def test_constant_and_tilted_by_units():
    x = np.arange(20.0)
    z = ground(20, 0.5)
    found = sky(x, x, z).share
    for unit in (1e-20, 1e20):
        assert np.abs(sky(unit * x, unit * x, unit * z).share - found).max() < 1e-5
    assert (sky(x, x, np.full((20, 20), 7.0)).share == 1).all()


@pytest.mark.parametrize("error", [0, 1, -1, np.nan, "x"])
def test_bad_errors(error):
    with pytest.raises((TypeError, ValueError), match="error: expected a number"):
        sky([0, 1], [0, 1], np.zeros((2, 2)), error=error)


def test_bad_fields():
    for stretch in (1.0, [1.0, -1.0], [1.0, np.nan]):
        with pytest.raises(ValueError, match="stretch: expected 2 positive numbers"):
            sky([0, 1], [0, 1], np.zeros((2, 2)), stretch=stretch)
    x = np.arange(3.0)
    with pytest.raises(ValueError, match="z: expected heights, got NaN everywhere"):
        sky(x, x, np.full((3, 3), np.nan))
    with pytest.raises(ValueError, match="two nodes or more"):
        sky([0.0], x, np.zeros((3, 1)))


@pytest.mark.slow
def test_the_effort_grows_with_what_is_asked():
    z, x = ground(64, 1.0), np.arange(64.0)
    coarse, fine = sky(x, x, z, error=0.03), sky(x, x, z, error=0.0005)
    assert coarse.azimuths == module.FEWEST
    assert fine.azimuths > 4 * coarse.azimuths
    assert fine.error < coarse.error
