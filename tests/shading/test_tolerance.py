"""Choosing by error: the light is within the bound, the bound within the tolerance."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, _compiled, engine
from vizlight.model import cylinder
from vizlight.shading import bounds
from vizlight.shading.plan import EXACT

PARALLEL, NEAR = View(direction=(0, 0, 1)), View(position=(0, 1, 9))
LIGHTS = {
    "headlight": [Light.headlight()],
    "near the eye": [Light(direction=(0.002, 0, 1))],
    "apart": [Light(direction=(0.05, 0, 1)), Light(direction=(1, 1, 1), intensity=0.5)],
    "positional": [Light(position=(3, 4, 5), attenuation=(1, 0.1, 0.01))],
}
CASES = [
    case
    for case in itertools.product(LIGHTS, ("line", "surface", "conditioned"), engine.Model.__args__)
    if case[1:] != ("surface", "cylinder")
]


@pytest.fixture(autouse=True)
def by_numpy(monkeypatch):
    """NumPy's code, for which more is cheaper than for compiled code."""
    monkeypatch.setenv("VIZLIGHT_FAST", "0")


@pytest.mark.parametrize("view", [PARALLEL, NEAR], ids=["parallel", "perspective"])
@pytest.mark.parametrize(("lights", "what", "model"), CASES)
def test_the_bound_holds(lights, what, model, view, random):
    points, lines, normals = random.standard_normal((3, 3000, 3))
    tangents = None if what == "surface" else lines
    options = {"normals": None if what == "line" else normals, "model": model}
    for shininess, tolerance in itertools.product(
        (0.5, 20, 20.5, 200), (1e-12, 1e-5, 1 / 255, 0.1)
    ):
        scene = Scene(lights=LIGHTS[lights], view=view, material=Material(shininess=shininess))
        exact = engine.shade(points, tangents, scene, **options).luminance
        made = engine.shade(points, tangents, scene, tolerance=tolerance, **options)
        choice, error = made.plan.choice, np.abs(made.luminance - exact).max()
        assert choice.tolerance == tolerance
        if np.isfinite(choice.bound):
            assert error <= choice.bound <= tolerance
        else:
            assert error <= tolerance + 1e-14


def lines_of(scene, **options):
    return engine.plan(scene, k=1, **options)


def test_default_is_exact():
    scene = Scene(lights=Light(direction=(1, 0, 1)), view=PARALLEL)
    made = lines_of(scene)
    assert made.choice is EXACT
    assert made.dtype == np.float64
    assert "tolerance" not in made.explain()


def test_what_is_chosen_at_which_tolerance():
    scene = Scene(lights=Light.headlight(), view=PARALLEL)
    tight, pixel, loose = (lines_of(scene, tolerance=t) for t in (1e-9, 1 / 255, 0.05))
    assert tight.dtype == np.float64
    assert [h.model for h in tight.highlights] == ["phong"]
    assert pixel.dtype == np.float32
    assert [h.model for h in pixel.highlights] == ["blinn"]
    assert pixel.exponent == pytest.approx(4.7635, abs=1e-4)
    assert loose.exponent == 5
    for made, words in (
        (tight, "skip     precision: float32: it would differ by up to"),
        (pixel, "compute  precision: float32, within"),
        (pixel, "skip     diffuse: power 5 for 4.7635: it would differ by up to 0.00891"),
        (loose, "compute  diffuse: power 5 for 4.7635, within 0.00891"),
        (loose, "compute  tolerance: 0.05 of luminance, the bound of all is"),
    ):
        assert words in made.explain()


def test_whole_powers_of_the_highlight():
    scene = Scene(lights=Light(position=(1, 2, 3)), view=NEAR, material=Material(shininess=20.01))
    made = lines_of(scene, tolerance=0.01)
    assert [h.shininess for h in made.highlights] == [20]
    assert "specular: power 20 for 20.01" in made.explain()
    assert "specular: phong, shininess 20 by multiplication" in made.explain()


def test_a_headlight_s_cylinder_is_a_multiple_of_the_cheap_laws():
    scene = Scene(lights=Light.headlight(), view=NEAR, material=Material(shininess=33.3))
    made = lines_of(scene, model="cylinder", tolerance=1e-6, dtype=np.float64)
    assert made.model == "blinn"
    assert made.factors[0] == pytest.approx(np.pi / 4)
    assert made.choice.bound < 1e-13
    far = scene.replace(lights=Light(position=(9, 1, 9)))
    assert lines_of(far, model="cylinder", tolerance=0.1).model == "cylinder"


@pytest.mark.parametrize("degrees", [0.1, 1.0, 10.0, 60.0])
def test_the_bound_of_the_flat_line_holds_for_all_tangents(degrees, random):
    angle = np.deg2rad(degrees)
    wi, wo = np.array([np.sin(angle), 0, np.cos(angle)]), np.array([0, 0, 1.0])
    t = random.standard_normal((100_000, 3))
    # Lines near light and eye, where the angle between their normal parts is large.
    t[::2] = wo + angle * t[::2]
    for s in (2.0, 6.0, 50.0):
        for diffuse, specular in ((1.0, 0.0), (0.0, 1.0)):
            material = Material(ambient=0, diffuse=diffuse, specular=specular, shininess=s)
            scene = Scene(lights=Light(direction=wi), view=View(direction=wo), material=material)
            made = lines_of(scene, model="cylinder", tolerance=1e9, dtype=np.float64)
            assert made.model == "blinn"
            exact = (
                cylinder.diffuse(wi, wo, t) if diffuse
                else cylinder.specular(wi, wo, t, shininess=s)
            )  # fmt: skip
            cheap = engine.shade(np.zeros_like(t), t, scene, model="cylinder", tolerance=1e9)
            assert np.abs(cheap.luminance - exact).max() <= made.choice.bound
            assert made.choice.bound < 6 * angle


def test_where_no_bound_holds_the_exact_forms_stay(random):
    points = random.standard_normal((50, 3))
    scene = Scene(lights=Light(position=(3, 4, 5)), view=NEAR)
    made = engine.shade(points, random.standard_normal((50, 2, 3)), scene, tolerance=0.5)
    assert made.plan.dtype == np.float64
    assert made.plan.choice.bound == np.inf
    assert "no bound within it" in made.plan.explain()


@pytest.mark.parametrize("tolerance", [1e-3, 1 / 255])
@pytest.mark.parametrize("options", [{"model": "cylinder"}, {"k": 2}, {"model": "blinn"}])
def test_float32_data_without_a_bound_stay_in_float32(options, tolerance, random):
    """Float64 would take longer than no tolerance at all."""
    k = options.get("k", 1)
    model = {key: value for key, value in options.items() if key != "k"}
    scene = Scene(lights=Light(position=(3, 4, 5)), view=NEAR)
    points, *lines = random.standard_normal((1 + k, 50, 3)).astype("f4")
    lines = np.stack(lines, axis=1)
    exact = engine.shade(points, lines, scene, **model)
    made = engine.shade(points, lines, scene, tolerance=tolerance, **model)
    assert made.luminance.dtype == np.float32
    assert np.array_equal(made.luminance, exact.luminance)
    assert made.plan.choice.bound == np.inf
    assert "nothing is cheaper than the exact forms" in made.plan.explain()


def test_float32_data_whose_rounding_exceeds_the_tolerance_are_lit_in_float64(random):
    points, normals = random.standard_normal((2, 50, 3)).astype("f4")
    scene = Scene(lights=Light(position=(3, 4, 5)), view=NEAR)
    made = engine.shade(points, None, scene, normals=normals, tolerance=1e-9)
    assert made.luminance.dtype == np.float64
    assert made.plan.choice.bound < 1e-9


def test_float32_saves_nothing_without_a_highlight():
    scene = Scene(lights=Light(position=(1, 2, 3)), view=NEAR, material=Material(specular=0))
    made = lines_of(scene, tolerance=1 / 255)
    assert made.dtype == np.float64
    assert not made.choice.cheaper
    assert lines_of(scene.replace(material=Material()), tolerance=1 / 255).choice.cheaper


@pytest.mark.parametrize("shininess", [20, 20.01])
def test_what_compiled_code_saves(shininess, monkeypatch):
    """Of all that is cheaper for NumPy, the models of which the cylinder is a multiple."""
    monkeypatch.setattr(_compiled, "why_not", lambda: "")
    monkeypatch.setenv("VIZLIGHT_FAST", "1")
    scene = Scene(lights=Light.headlight(), view=PARALLEL, material=Material(shininess=shininess))
    for options in ({}, {"model": "blinn"}):
        made, exact = lines_of(scene, tolerance=0.05, **options), lines_of(scene, **options)
        assert made.dtype == np.float64
        assert made.highlights == exact.highlights
        assert made.exponent == exact.exponent
        assert "nothing is cheaper" in made.explain()
    made = lines_of(scene, tolerance=0.05, model="cylinder")
    assert made.model == "blinn"
    assert made.choice.cheaper


def test_a_precision_that_is_asked_for_stays(random):
    points, lines = random.standard_normal((2, 50, 3))
    scene = Scene(lights=Light(position=(3, 4, 5)), view=NEAR)
    for precision in ("float32", "float64"):
        made = engine.shade(points, lines, scene, tolerance=0.5, precision=precision)
        assert made.luminance.dtype == precision
    assert engine.shade(points, lines, scene, tolerance=0.5).luminance.dtype == np.float32


def test_float32_that_cannot_keep_the_tolerance_is_refused():
    scene = Scene(lights=Light(direction=(1, 0, 1)), view=PARALLEL)
    assert lines_of(scene, tolerance=1e-4, dtype=np.float32).choice.bound < 1e-4
    with pytest.raises(ValueError, match=r"tolerance: expected .* rounding may be .*e-06; omit"):
        lines_of(scene, tolerance=1e-7, dtype=np.float32)
    for options in ({"model": "cylinder"}, {"k": 2, "n": 4}):
        asked = {"k": 1, "tolerance": 0.1} | options
        still = scene if asked["k"] == 1 else Scene(view=View(direction=(0, 0, 0, 1)))
        with pytest.raises(ValueError, match="rounding has no bound here; omit precision="):
            engine.plan(still, dtype=np.float32, **asked)
        assert engine.plan(still, dtype=np.float64, **asked).choice.bound == np.inf
        assert "no bound holds for all data" in engine.plan(still, **asked).explain()


@pytest.mark.parametrize("shininess", [20.5, 2596.16, 42125.18, 1e6])
def test_the_bound_of_a_headlight_s_cylinder_holds_at_50_digits(shininess):
    mp = pytest.importorskip("mpmath").mp
    scene = Scene(
        lights=Light.headlight(),
        view=PARALLEL,
        material=Material(ambient=0, diffuse=0, specular=1, shininess=shininess),
    )
    tangents = np.array([[1.0, 0, 0], [1, 0, 1e-4], [1, 0, 0.3]])
    made = engine.shade(
        np.zeros((3, 3)), tangents, scene, model="cylinder", tolerance=1e-7, precision="float64"
    )
    with mp.workdps(50):
        for value, (x, _, z) in zip(made.luminance, tangents, strict=True):
            sine = mp.mpf(x) / mp.sqrt(mp.mpf(x) ** 2 + mp.mpf(z) ** 2)
            true = mp.beta(mp.mpf(shininess) / 2 + 1, mp.mpf(1) / 2) / 2 * sine ** mp.mpf(shininess)
            assert abs(mp.mpf(float(value)) - true) <= made.plan.choice.bound


def test_filter_and_provenance():
    surface = vizlight.load_example().contour([600], scalars="Temp")
    scene = Scene(lights=Light(direction=(1, 1, 1)), view=View(direction=(1, 0, 1)))
    exact = vizlight.illuminate(surface, scene, tangents="V", precision="float64")
    near = vizlight.illuminate(surface, scene, tangents="V", tolerance=1 / 255)
    assert np.abs(exact["luminance"] - near["luminance"]).max() <= 1 / 255
    told = vizlight.provenance(near)
    assert told["options"]["tolerance"] == 1 / 255
    assert told["error_bound"] <= 1 / 255
    assert vizlight.provenance(exact)["error_bound"] is None
    lines = vizlight.streamlines(
        vizlight.load_example(), scene, vectors="V", seeds=5, tolerance=0.1
    )
    assert "luminance" in lines.point_data


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"tolerance": -1}, ValueError, "tolerance: expected a finite number of at least 0"),
        ({"tolerance": "1/255"}, TypeError, "tolerance: expected a number"),
        ({"tolerance": float("nan")}, ValueError, "tolerance: expected"),
        (
            {"tolerance": 0.1, "highlight_error": 1},
            ValueError,
            "tolerance: expected no highlight_error beside it",
        ),
    ],
)
def test_bad_tolerances(options, error, words):
    with pytest.raises(error, match=words):
        lines_of(Scene(lights=Light(direction=(1, 0, 1)), view=PARALLEL), **options)


def test_no_bound_holds_where_light_and_eye_are_opposite(random):
    """Rounding decides where the half vector points; the diffuse term is chosen without it."""
    points, lines = random.standard_normal((2, 3000, 3))
    scene = Scene(lights=Light(direction=(0, 0, -1)), view=PARALLEL)
    exact = engine.shade(points, lines, scene, model="blinn")
    made = engine.shade(points, lines, scene, model="blinn", tolerance=0.05)
    assert exact.plan.exponent == pytest.approx(4.7635, abs=1e-4)
    assert made.plan.exponent == 5
    assert made.plan.dtype == np.float64
    assert made.plan.choice.bound == np.inf
    assert np.abs(made.luminance - exact.luminance).max() < 0.05
    headlight = lines_of(Scene(lights=Light.headlight(), view=NEAR), model="blinn", tolerance=0.05)
    assert headlight.dtype == np.float32
    assert headlight.choice.bound < 0.05


@pytest.mark.parametrize("cue", [0.0, 0.5, 30.0, 1e5])
@pytest.mark.parametrize("dull", [False, True])
def test_the_depth_cue_is_in_the_bound(cue, dull, random):
    points = random.standard_normal((2000, 3)).astype(np.float32)
    normals = random.standard_normal((2000, 3)).astype(np.float32)
    scene = Scene(
        lights=Light(direction=(1, 2, 3)),
        material=Material(diffuse=0.0, specular=0.0) if dull else Material(),
        view=View(direction=(0, 0, 1)),
        depth_cue=DepthCue(front=2, back=-2, cue=cue, smooth=True),
    )
    exact = engine.shade(points, None, scene, normals=normals, precision="float64").luminance
    made = engine.shade(points, None, scene, normals=normals, precision="float32")
    off = np.abs(made.luminance - exact).max()
    assert off <= bounds.rounding(made.plan)
    # The bound is of use: within a factor of 20 of what is seen where the cue is bright.
    assert cue < 1 or off > bounds.rounding(made.plan) / 20
    chosen = engine.shade(points, None, scene, normals=normals, tolerance=1e-3)
    assert np.abs(chosen.luminance - exact).max() <= 1e-3
