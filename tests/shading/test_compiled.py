"""The light of NumPy and of compiled code is that of the oracle within the stated bounds.

The text of kernels runs as Python for most plans, which takes milliseconds; a few are compiled.
``python tests/differential.py`` compares many more plans, all compiled.
"""

# A formula that is changed in a test is read as in its file.
from __future__ import annotations

import dataclasses
import math

import differential
import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, far, shiny

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, _compiled, engine
from vizlight.model import formulas
from vizlight.shading import loops
from vizlight.shading.arrays import Shading
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.shading.plan import decide

LAMP = Light(position=(0.5, 4, 2), intensity=0.7)
SUN = Light(direction=(1, 2, 0.5))
NEAR = View(position=(0, 1, 6))
SCENE = Scene(lights=LAMP, view=NEAR, material=SHINY)


@pytest.fixture(autouse=True, scope="module")
def home(tmp_path_factory):
    """A folder for caches of this module's own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.mktemp("cache")))
        patch.setenv("VIZLIGHT_FAST", "0")
        yield


@pytest.fixture(scope="module")
def cases():
    """60 random cases of as many forms, with their light in 50 digits."""
    found = []
    for number in range(10_000, 10_060):
        random = np.random.default_rng(number)
        made = differential.case(differential.frame(random), random)
        found.append((made, differential.truth(made)))
    return found


def plan_of(made):
    return decide(made.scene, made.inputs.layout, made.options, made.options.precision)


@pytest.mark.parametrize("light", [differential.by_numpy, differential.by_text])
def test_light_is_that_of_the_oracle_within_the_stated_bounds(cases, light):
    counted = 0
    for made, true in cases:
        if light is differential.by_text and differential.left_to_numpy(plan_of(made)):
            continue
        ratio, points = differential.compare(made, true, light)
        assert ratio <= 1, made
        counted += points
    assert counted > 42 * differential.POINTS * 0.8


@pytest.mark.sampled(5)
@pytest.mark.parametrize("size", [1e-42, 1e-25, 1e15, 1e25, 1e39, 1e120])
@pytest.mark.parametrize("precision", ["float32", "float64"])
def test_lamps_out_of_the_range_of_float32_have_the_light_of_the_oracle(size, precision):
    counted = 0
    for number in range(10):
        random = np.random.default_rng((3, number))
        form = differential.frame(random)
        form = form._replace(options=dataclasses.replace(form.options, precision=precision))
        made = differential.case(form, random)
        place = tuple(size * random.normal(size=form.n))
        lights = [
            light if light.position is None else dataclasses.replace(light, position=place)
            for light in made.scene.lights
        ]
        made = made._replace(scene=made.scene.replace(lights=lights))
        true = differential.truth(made)
        ratio, points = differential.compare(made, true, differential.by_numpy)
        if not differential.left_to_numpy(plan_of(made)):
            again, _ = differential.compare(made, true, differential.by_text)
            ratio = max(ratio, again)
        assert ratio <= 1, made
        counted += points
    assert counted > 10 * differential.POINTS * 0.6


@pytest.mark.sampled(4)
@pytest.mark.parametrize("shininess", [0, 0.3, 1, 2, 5, 7.5])
def test_a_cylinder_of_low_shininess_has_the_light_of_the_oracle(shininess):
    for number in range(6):
        random = np.random.default_rng((4, number))
        form = differential.frame(random)
        while form.kind != "cylinder":
            form = differential.frame(random)
        made = differential.case(form, random)
        material = dataclasses.replace(made.scene.material, shininess=shininess)
        made = made._replace(scene=made.scene.replace(material=material))
        ratio, _ = differential.compare(made, differential.truth(made), differential.by_numpy)
        assert ratio <= 1, made


@pytest.mark.parametrize("seed", [1007, pytest.param(1013, marks=pytest.mark.slow)])
def test_compiled_light_is_that_of_the_oracle_within_the_stated_bounds(seed):
    pytest.importorskip("numba")
    form = differential.frame(np.random.default_rng(seed))
    random = np.random.default_rng(seed)
    with _compiled.setting("1"):
        for _ in range(20):
            made = differential.case(form, random)
            ratio, _ = differential.compare(made, differential.truth(made), differential.by_kernel)
            assert ratio <= 1


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("phong", "sine_i - sine_o", "sine_i + sine_o"),
        ("blinn", "0.5 * shininess", "0.25 * shininess"),
        ("attenuation", "linear + distance", "linear - distance"),
        ("depth_scale", "3.0 - 2.0 * t", "2.0 - t"),
        ("fur_path", "height / sine", "height * sine"),
    ],
)
def test_a_wrong_formula_is_found(name, old, new, cases, monkeypatch):
    """The comparison can fail: one term of one formula is broken."""
    import inspect

    text = inspect.getsource(getattr(formulas, name))
    assert old in text
    scope = dict(vars(formulas))
    exec(text.replace(old, new), scope)
    monkeypatch.setattr(formulas, name, scope[name])
    loops.program.cache_clear()
    try:
        assert worst_of(cases, differential.by_text) > 1
    finally:
        loops.program.cache_clear()


@pytest.mark.parametrize(
    ("old", "new"),
    [("sum0 = sum0 + ", "sum0 = sum0 - "), ("odd = odd | (not ", "odd = odd | ("), ("sqrt(", "(")],
)
def test_a_wrong_statement_of_a_loop_is_found(old, new, cases, monkeypatch):
    right = loops.program_of

    def broken(plan, inputs):
        made = right(plan, inputs)
        head, loop = made.source.split("    for i in range", 1)
        return made._replace(source=f"{head}    for i in range{loop.replace(old, new, 1)}")

    monkeypatch.setattr(loops, "program_of", broken)
    assert worst_of(cases, differential.by_text) > 1


def worst_of(cases, light):
    """Return the largest error of a light in units of the bound, up to the first beyond it.

    It is infinite where points without light are others than those of the oracle.
    """
    worst = 0.0
    for made, true in cases:
        if not loops.why_not(plan_of(made)):
            try:
                worst = max(worst, differential.compare(made, true, light)[0])
            except AssertionError:
                worst = math.inf
        if worst > 1:
            break
    return worst


@pytest.mark.slow
def test_a_loop_with_a_table_is_made_of_vector_instructions(fast, random):
    """It is where the compiler knows that tables and results do not overlap."""
    points, tangents, _ = cloud(random, 64)
    inputs = ShadingInputs(points=points, tangents=tangents)
    plan = decide(SCENE, inputs.layout, ShadingOptions(model="cylinder"), "float32")
    code = loops.program_of(plan, inputs)
    code.shade_block(plan, slice(0, 64), inputs, Shading.of(plan, 64))
    (text,) = code.kernel._dispatcher().inspect_llvm().values()
    assert text.count(" x float>") > 100


def cloud(random, count, dtype=np.float32):
    return tuple(random.standard_normal((count, 3)).astype(dtype) for _ in range(3))


@pytest.fixture
def fast():
    """Compiled code always."""
    pytest.importorskip("numba")
    with _compiled.setting("1"):
        yield


def test_engine_runs_compiled_code(fast, random):
    points, tangents, normals = cloud(random, 1000)
    tangents[100:200] = 0
    points[300] = np.nan
    steps = []
    lit = engine.shade(
        points, tangents, SCENE, normals=normals, components=True, block=128,
        progress=lambda done, of: steps.append((done, of)),
    )  # fmt: skip
    assert steps[-1] == (1000, 1000)
    assert lit.plan.compiled
    assert "code: compiled" in lit.plan.explain()
    with _compiled.setting("0"):
        same = engine.shade(points, tangents, SCENE, normals=normals)
    assert not same.plan.compiled
    assert "skip     compiled code: VIZLIGHT_FAST=0" in same.plan.explain()
    assert lit.invalid == same.invalid == 101
    np.testing.assert_array_equal(lit.valid, same.valid)
    np.testing.assert_allclose(lit.luminance, same.luminance, rtol=0, atol=20 * 1.2e-7)
    # Arrays that are strided or read by slice.
    wide = np.zeros((1000, 8), "f4")
    wide[:, 1:7:2] = points

    class Source:
        shape, dtype = tangents.shape, tangents.dtype

        def __getitem__(self, rows):
            return tangents[rows]

    normals.setflags(write=False)
    other = engine.shade(wide[:, 1:7:2], Source(), SCENE, normals=normals, components=True)
    assert other.plan.compiled
    np.testing.assert_array_equal(other.luminance, lit.luminance)


@pytest.mark.slow
@pytest.mark.parametrize("model", ["phong", "blinn"])
def test_faces_lines_and_vertices_are_lit_by_compiled_code(model, fast, random):
    points, tangents, normals = cloud(random, 1000)
    kinds = random.integers(0, 3, 1000).astype(np.float32)
    tangents[7] = 0
    given = ShadingInputs(points=points, tangents=tangents, normals=normals, dimensions=kinds)
    options = ShadingOptions(model=model, components=True)
    lit = engine.run(given, SCENE, options)
    assert lit.plan.compiled
    with _compiled.setting("0"):
        same = engine.run(given, SCENE, options)
    np.testing.assert_allclose(lit.luminance, same.luminance, rtol=0, atol=20 * 1.2e-7)
    np.testing.assert_allclose(lit.specular, same.specular, rtol=0, atol=40 * 1.2e-7)
    lines = engine.shade(points, tangents, SCENE, model=model).luminance
    faces = engine.shade(points, None, SCENE, normals=normals, model=model).luminance
    np.testing.assert_allclose(lit.luminance[kinds == 1], lines[kinds == 1], atol=1e-5)
    on_face = (kinds == 2) & (np.arange(1000) != 7)
    np.testing.assert_allclose(lit.luminance[on_face], faces[on_face], atol=1e-5)
    eye = SCENE.view.position - points.astype(np.float64)
    alone = engine.shade(points, None, SCENE, normals=eye, model=model).luminance
    np.testing.assert_allclose(lit.luminance[kinds == 0], alone[kinds == 0], atol=1e-5)


def test_arrays_among_the_options_are_lit_by_compiled_code(fast):
    ball = pv.Sphere()
    normals = np.array(ball["Normals"])
    lit = vizlight.illuminate(ball, SCENE, normals=normals, components=True)
    same = vizlight.illuminate(ball, SCENE, normals="Normals", components=True)
    np.testing.assert_array_equal(lit["luminance"], same["luminance"])
    assert "diffuse" in lit.point_data


@pytest.mark.parametrize("fault", [1, 3])
def test_numpy_lights_what_a_kernel_fails_with(fast, random, monkeypatch, fault):
    """Whether it fails at once or in the middle, with one warning and words in the plan."""
    monkeypatch.setenv("VIZLIGHT_THREADS", "1")
    points, tangents, normals = cloud(random, 300)
    options = {"normals": normals, "components": True, "block": 100}
    with _compiled.setting("0"):
        same = engine.shade(points, tangents, SCENE, **options)
    made = engine.shade(points, tangents, SCENE, **options)
    assert made.plan.compiled
    given, calls = _compiled.Kernel.__call__, []

    def broken(*_):
        raise MemoryError("LLVM")

    def call(self, *args):
        calls.append(self)
        if len(calls) == fault:
            patch.setattr(self, "_proven", True)
            patch.setattr(self, "_compiled", broken)
        return given(self, *args)

    with monkeypatch.context() as patch:
        patch.setattr(_compiled, "_BROKEN", [])
        patch.setattr(_compiled.Kernel, "__call__", call)
        with pytest.warns(RuntimeWarning, match="numba failed with light: Memory") as caught:
            lit = engine.shade(points, tangents, SCENE, **options)
        again = engine.shade(points, tangents, SCENE, **options)
    assert len(caught) == 1
    assert not lit.plan.compiled
    assert "compiled code: numba failed with light: MemoryError: LLVM" in lit.plan.explain()
    for name in ("luminance", "diffuse", "specular"):
        numpys = getattr(same, name)
        np.testing.assert_allclose(getattr(lit, name), numpys, rtol=0, atol=2e-6)
        np.testing.assert_array_equal(getattr(again, name), numpys)


def test_calls_add_up_until_a_kernel_pays(random, monkeypatch):
    """Calls that would each save 0.3 s: 0.3 s are shared, and 0.7 s are won back by each form."""
    monkeypatch.setattr(loops, "_MISSED", {})
    monkeypatch.setattr(_compiled, "active", lambda: True)
    monkeypatch.setattr(_compiled, "why_not", lambda: "")
    monkeypatch.setattr(_compiled._Account, "missed", 0.0)
    monkeypatch.setattr(_compiled, "preparation", lambda: 0.3)
    monkeypatch.setattr(_compiled.Kernel, "start_up", lambda self: 0.7)
    monkeypatch.setattr(_compiled.Kernel, "_dispatcher", lambda self: None)
    monkeypatch.setenv("VIZLIGHT_THREADS", "1")
    monkeypatch.setattr(loops, "SAVED", 0.1)
    monkeypatch.setattr(loops, "SAVED_PER_LIGHT", 0.2)
    loops._kernel.cache_clear()
    points, _, normals = cloud(random, 1)
    inputs = ShadingInputs(points=points, normals=normals)
    one, two = (
        engine.plan(SCENE, normals=True, model=model, dtype=np.float32)
        for model in ("phong", "blinn")
    )
    with _compiled.setting(""):
        ran = [
            loops.prepare(plan, inputs)[0] is not None
            for plan in (one, one, two, one, one, two, two, two)
        ]
    assert ran == [False, False, False, True, True, False, True, True]
    loops._kernel.cache_clear()


@pytest.mark.parametrize("block", [1, 7, 64, 100])
def test_light_does_not_depend_on_blocks(fast, random, block):
    points, tangents, normals = cloud(random, 331)
    options = {"normals": normals, "components": True}
    lit = engine.shade(points, tangents, SCENE, **options)
    cut = engine.shade(points, tangents, SCENE, block=block, **options)
    for name in ("luminance", "diffuse", "specular", "valid"):
        np.testing.assert_array_equal(getattr(cut, name), getattr(lit, name))


def test_where_it_does_not_pay_numpy_runs(random):
    points, tangents, _ = cloud(random, 10)
    with _compiled.setting(""):
        lit = engine.shade(
            points, tangents, Scene(lights=SUN, view=NEAR, material=SHINY), model="blinn"
        )
        words = "10 points do not pay" if _compiled.active() else "numba"
    assert not lit.plan.compiled
    assert words in lit.plan.explain()


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"n": 7, "k": 1}, "7 components, more than 6"),
        ({"n": 6, "k": 4}, "4 tangents per point, more than 3"),
        ({"k": 1, "model": "cylinder"}, "a shininess below 8"),
    ],
)
def test_what_has_no_compiled_form_says_why(given, words):
    n = given.get("n", 3)
    scene = far(np.ones(n), np.arange(n) + 1.0, shiny(shininess=5))
    assert words in engine.plan(scene, **given).explain()
    assert "code: where" in engine.plan(SCENE, k=1).explain()


def test_ambient_light_alone_needs_none():
    dark = Material(ambient=0.1, diffuse=0, specular=0)
    words = engine.plan(Scene(material=dark), k=1).explain()
    assert "the ambient term alone" in words
    cue = Scene(material=dark, view=NEAR, depth_cue=DepthCue(front=1, back=2))
    assert not loops.why_not(engine.plan(cue, k=1))


def test_a_text_has_the_terms_of_its_form_and_no_others(random):
    points, _, normals = cloud(random, 4)
    inputs = ShadingInputs(points=points, normals=normals)
    plain = engine.plan(Scene(lights=SUN, view=NEAR, material=SHINY), normals=True)
    text = loops.program_of(plain, inputs).source
    body = text[text.index("def light(") :]
    assert "tangents[" not in body
    assert "shadow[" not in body
    assert "rgb[" not in body
    assert "exp_(" not in body
    assert body.count("sqrt(") == 2


def test_a_power_that_is_not_whole_has_the_digits_of_numpy(random):
    """Near 1 the logarithm is taken of what is missing from 1."""
    normals = random.normal(size=(500, 3)) * 0.05 + (0, 0, 1)
    inputs = ShadingInputs(points=np.zeros((500, 3)), normals=normals)
    view, light = View(direction=(0.1, 0, 1)), Light(direction=(0, 0.1, 1))
    scene = Scene(lights=light, view=view, material=Material(specular=1, shininess=7.5))
    made = decide(scene, inputs.layout, ShadingOptions(model="blinn"), np.float64)
    outputs = [Shading.of(made, 500), Shading.of(made, 500)]
    differential.by_numpy(made, inputs, outputs[0])
    differential.by_text(made, inputs, outputs[1])
    np.testing.assert_allclose(outputs[1].luminance, outputs[0].luminance, rtol=1e-13)
