"""Cases whose answers are known: each function raises AssertionError if the meter errs."""

import numpy as np
from vectors import unit

from vizlight import Light, Material, Scene, View
from vizlight.observers import readers
from vizlight.observers.readers import lab, seen
from vizlight.observers.samples import Sample
from vizlight.shading.options import ShadingOptions

MATTE = Material(ambient=0.1, diffuse=0.8, specular=0)
NOISE = 2 / 255
EYE = View(direction=(0, 0, 1))
CASES = {}


def case(function):
    CASES[function.__name__] = function
    return function


def near(got, want, slack):
    assert abs(got - want) <= slack, f"{got:.4f}, expected {want:.4f} within {slack:g}"


def scene_of(lights, material=MATTE):
    return Scene(lights=lights, material=material, view=EYE)


def places(scene, tangents=None, normals=None, *, kind="surface", cls=Sample, model="phong"):
    """Return places at the origin that are seen along z."""
    m = len(normals if tangents is None else tangents)
    axes = [np.tile(axis, (m, 1)) for axis in np.eye(3)]
    return cls(
        kind=kind, points=np.zeros((m, 3)), right=axes[0], up=axes[1], eye=axes[2],
        tangents=None if tangents is None else tangents[:, np.newaxis], normals=normals,
        values=None, valid=np.ones(m, dtype=bool), scene=scene, shares={},
        options=ShadingOptions(conditioned=False, precision="float64", model=model),
    )  # fmt: skip


def plane(lights, **how):
    """Return places of a plane that faces the eye, with tangents in all directions."""
    turn = np.random.default_rng(1).uniform(0, np.pi, 4000)
    tangents = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    return places(scene_of(lights), tangents, np.tile([0, 0, 1.0], (4000, 1)), **how)


def lines(lights, material=MATTE, **how):
    """Return places of lines in all directions of space."""
    tangents = unit(np.random.default_rng(2).normal(size=(20000, 3)))
    return places(scene_of(lights, material), tangents, kind="line", **how)


def read_direction(sample, noise=NOISE):
    return readers.find_direction(sample, np.random.default_rng(0), noise)


def within_10(error):
    return float((error <= 10).mean())


def color(angle, name):
    a = np.radians(angle)
    return Light(direction=(np.cos(a), np.sin(a), 1), color=name)


# One lamp: light is even about its azimuth, so that half of the answers are the mirror image. Its
# error is min(2 t, 180 - 2 t) for t even in 0..90: within 10 degrees for a share of 1/9.
@case
def one_lamp_leaves_the_mirror_image():
    found = read_direction(plane(Light(direction=(1, 0, 1))), 1e-4)
    near(within_10(found.error), 0.5 + 0.5 / 9, 0.06)


@case
def two_colors_60_degrees_apart_resolve_it():
    found = read_direction(plane([color(0, "red"), color(60, "blue")]))
    near(within_10(found.error), 1, 0.02)


@case
def two_colors_90_degrees_apart_do_not():
    found = read_direction(plane([color(0, "red"), color(90, "blue")]))
    near(within_10(found.error), 0.5 + 0.5 / 9, 0.06)


class OfSurface(Sample):
    """Places whose light does not depend on tangents."""

    def light(self, tangents, normals, repeat=1):
        return super().light(None, normals, repeat)


def _chance(found):
    return {
        "median": (np.median(found.error), 45, 2.5),
        "share": (within_10(found.error), 1 / 9, 0.02),
        "bits": (found.bits.mean(), 0, 0.02),
    }


for what in ("median", "share", "bits"):

    def headlight(what=what):
        near(*_chance(read_direction(plane(Light.headlight())))[what])

    def surface(what=what):
        sample = plane(Light(direction=(1, 0, 1)), cls=OfSurface)
        near(*_chance(read_direction(sample))[what])

    CASES[f"headlight_on_a_plane_is_chance_{what}"] = headlight
    CASES[f"light_of_a_surface_is_chance_{what}"] = surface


@case
def key_reads_a_plane_that_is_the_key():
    sample = plane([color(0, "red"), color(60, "lime"), color(120, "blue")])
    error = readers.by_key(sample, np.zeros(3), np.random.default_rng(0), 0.0)
    near(np.median(error), 0, 1)


@case
def key_of_white_lamps_is_chance():
    sample = plane([color(0, "white"), color(60, "white")])
    error = readers.by_key(sample, np.zeros(3), np.random.default_rng(0), NOISE)
    # 180 grays have hues at random, some of which stand alone.
    near(np.median(error), 45, 5)


# Two grays that are 2 standard deviations apart are the binary channel with Gaussian noise, whose
# information is 1 - E[log2(1 + exp(-2 (1 + z)))], z normal.
@case
def two_grays_tell_what_the_binary_channel_does():
    random, noise = np.random.default_rng(7), 0.1
    table = 0.5 + noise / np.sqrt(3) * np.array([[-1.0] * 3, [1.0] * 3])
    observed = table[random.integers(0, 2, 100_000)] + random.normal(0, noise, (100_000, 3))
    z, weight = np.polynomial.hermite_e.hermegauss(60)
    lost = (weight * np.log2(1 + np.exp(-2 * (1 + z)))).sum() / np.sqrt(2 * np.pi)
    bits = readers.information(readers.posterior(observed, table, noise)).mean()
    near(bits, 1 - lost, 0.005)


# The light of a cylinder under a headlight is ka + kd pi/4 sin(angle to the eye).
@case
def cylinder_under_a_headlight_has_its_formula():
    sample = lines(Light.headlight(), model="cylinder")
    sine = np.sqrt(1 - sample.tangents[:, 0, 2] ** 2)
    expected = 0.1 + 0.8 * np.pi / 4 * sine
    near(np.abs(sample.own_light() - expected[:, np.newaxis]).max(), 0, 1e-6)


def _steepness(sample, noise):
    light = lab(seen(sample.own_light(), np.random.default_rng(0), noise))[:, 0]
    return readers.steepness(sample), light


@case
def cylinder_under_a_headlight_orders_slopes():
    steep, light = _steepness(lines(Light.headlight(), model="cylinder"), 1e-6)
    near(readers.rank_correlation(light, steep), -1, 1e-3)


@case
def sign_of_slope_is_a_coin():
    sample = lines(Light.headlight(), model="cylinder")
    error = readers.find_slope(sample, np.random.default_rng(0), 1e-6)
    toward = np.degrees(np.arcsin(np.abs(sample.tangents[:, 0, 2])))
    near(within_10(error), 0.5 + 0.5 * np.mean(2 * toward % 180 <= 10), 0.06)


DARK = Material(ambient=0.5, diffuse=0, specular=0)


@case
def no_light_orders_nothing():
    steep, light = _steepness(lines(Light.headlight(), DARK), NOISE)
    near(readers.rank_correlation(light, steep), 0, 0.03)


@case
def no_light_tells_no_slope():
    near(readers.mutual_information(*_steepness(lines(Light.headlight(), DARK), NOISE)), 0, 0.03)


@case
def few_places_tell_no_slope_either():
    dark = lines(Light.headlight(), DARK)
    found = []
    for start in range(0, len(dark) - 256, 256):
        some = dark.take(slice(start, start + 256))
        found.append(readers.mutual_information(*_steepness(some, NOISE)))
    near(np.mean(found), 0, 0.05)


def _ball(material):
    """Return places of a ball that three lamps at right angles reach, and the light of those."""
    ways = np.linalg.qr(np.random.default_rng(6).normal(size=(3, 3)))[0]
    ways *= np.sign(ways[:, 2:])
    normals = unit(np.random.default_rng(5).normal(size=(20000, 3)))
    normals[:, 2] = np.abs(normals[:, 2])
    normals = normals[(normals @ ways.T > 0.05).all(axis=1)]
    lamps = [
        Light(direction=way, color=name)
        for way, name in zip(ways, ("red", "lime", "blue"), strict=True)
    ]
    return places(scene_of(lamps, material), normals=normals)


@case
def of_a_dark_ball_the_eye_is_the_best_guess():
    random = np.random.default_rng(7)
    radius, angle = np.sqrt(random.uniform(size=4000)), random.uniform(0, 2 * np.pi, 4000)
    height = np.sqrt(1 - radius**2)
    normals = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    found = readers.find_normal(places(scene_of([], DARK), normals=normals), random, NOISE)
    near(np.median(found.error), 45, 2)
    near(found.bits.mean(), 0, 1e-9)


@case
def three_lamps_solve_for_the_normal():
    sample = _ball(Material(ambient=0, diffuse=1, specular=0))
    found = readers.find_normal(sample, np.random.default_rng(0), NOISE)
    # The 900 candidates are up to some 4 degrees apart.
    near(np.median(found.error), 0, 3)


@case
def one_gray_tells_no_normal():
    near(readers.find_normal(_ball(DARK), np.random.default_rng(0), NOISE).bits.mean(), 0, 0.01)


BAR = np.stack([np.linspace(0, 1, 256), np.linspace(1, 0, 256), np.full(256, 0.5)], axis=1)


def _values():
    v = np.random.default_rng(3).uniform(size=20000)
    return v, BAR[np.minimum((256 * v).astype(int), 255)]


@case
def unlit_colors_are_read_to_half_a_step():
    v, colors = _values()
    near(np.max(readers.decode(colors, v, BAR)), 0, 0.501 / 256)


@case
def colors_of_other_values_are_chance():
    v, colors = _values()
    near(np.median(readers.decode(colors[::-1], v, BAR)[1]), 1 - 0.5**0.5, 0.01)


@case
def dimmed_colors_keep_their_chromaticity():
    v, colors = _values()
    factor = np.random.default_rng(4).uniform(0.3, 1, (len(v), 1))
    near(np.abs(readers.decode(colors * factor, v, BAR)[1]).max(), 0, 0.501 / 256)
