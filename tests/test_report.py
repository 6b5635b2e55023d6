"""What light cost and how wrong it is: of every filter, by formulas that share no code with it."""

from __future__ import annotations

import warnings

import numpy as np
import oracles
import pytest
import pyvista as pv

import vizlight
from vizlight import (
    DepthCue,
    Light,
    Material,
    Scene,
    View,
    _block,
    _oracle,
    cli,
    engine,
    fur,
    illuminate,
    project,
    relief_shadow,
    satin,
    streamlines,
)
from vizlight.geometry import manifolds

SCENE = Scene(
    lights=[Light(direction=(1, 1, 1)), Light(position=(2, 3, 4), attenuation=(1, 0.1, 0.01))],
    view=View(position=(5, 4, 6)),
    depth_cue=DepthCue(back_scale=0.5, smooth=True),
)
PLAIN = SCENE.replace(depth_cue=None)


@pytest.fixture(scope="module")
def surface():
    return vizlight.load_example().contour([600], scalars="Temp")


def terrain():
    grid = pv.ImageData(dimensions=(60, 50, 1))
    x, y, _ = grid.points.T
    grid["z"] = 3 * np.sin(x / 5) * np.cos(y / 7)
    return grid


def torus():
    return vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=24))


SCENE_4 = Scene(lights=Light(direction=(0.7, 0.6, 0.38, 0)), view=View(direction=(0, -1, 0.5, 0)))
SUN = PLAIN.replace(lights=Light(direction=(1, 0.5, 1)))
FILTERS = {
    "surface": lambda s: illuminate(s, SCENE),
    "two-sided": lambda s: illuminate(s, SCENE, two_sided=True, model="blinn"),
    "terminator": lambda s: illuminate(s, SCENE, terminator=0.3),
    "conditioned": lambda s: illuminate(s, SCENE, tangents="V", conditioned=True, components=True),
    "uncompensated": lambda s: illuminate(s, SCENE, tangents="V", compensate=False),
    "cylinder": lambda s: illuminate(s, SCENE, tangents="V", model="cylinder"),
    "streamlines": lambda _: streamlines(vizlight.load_example(), SCENE, vectors="V", seeds=9),
    "satin": lambda s: satin(s, SCENE, tangents="V", seeds=5),
    "fur": lambda _: fur(pv.Sphere().compute_normals(), PLAIN, density=0.3, fibres=300),
    "4-space": lambda _: illuminate(torus(), SCENE_4, tangents="frame", positions="position"),
    "carrier": lambda _: illuminate(
        torus(), SCENE_4, tangents="frame", positions="position", conditioned="frame"
    ),
    "project": lambda _: project(torus(), rotation=("xw", 0.5), distance=3.0, scene=SCENE_4),
    "relief": lambda _: relief_shadow(
        terrain(), SUN, elevation="z", method="exact", depth=0.5, lit=True
    ),
}


@pytest.mark.parametrize("name", FILTERS)
def test_every_filter(name, surface):
    with vizlight.report(sample=40) as told:
        FILTERS[name](surface)
    assert told.runs
    assert told.points > 0
    assert told.bytes > 0
    assert told.seconds > 0
    limit = 3e-3 if name == "relief" else 3e-6
    for run in told.runs:
        assert run.sample > 0
        assert 0 <= run.rms <= run.error < limit
        assert run.disagreed == 0
        assert run.nanoseconds > 0
    said = str(told)
    assert f"{told.points} points lit in {len(told.runs)} run(s)" in said
    assert "lit again one by one in float64" in said


def test_a_wrong_engine_is_found_out(surface, monkeypatch):
    right = _block._kernels.diffuse
    monkeypatch.setattr(_block._kernels, "diffuse", lambda *a: 1.01 * right(*a))
    with vizlight.report() as told:
        illuminate(surface, SCENE, tangents="V")
    assert told.error > 1e-3


def test_the_error_includes_what_a_tolerance_chose(surface):
    with vizlight.report() as told:
        illuminate(surface, PLAIN, tangents="V", tolerance=0.05)
    (run,) = told.runs
    assert 1e-4 < run.error <= run.bound <= 0.05
    assert "bound of what was chosen" in str(told)


def test_invalid_points_are_counted(random):
    vectors = random.standard_normal((50, 3))
    vectors[:7] = 0
    vectors[7:9] = np.nan
    mesh = pv.PolyData(random.standard_normal((50, 3)))
    mesh["V"] = vectors
    with vizlight.report() as told, warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        illuminate(mesh, PLAIN, tangents="V")
    assert told.invalid == 9
    assert told.runs[0].sample == 41
    assert told.runs[0].disagreed == 0
    assert "9 invalid" in str(told)


def test_no_report_no_work(surface, monkeypatch):
    monkeypatch.setattr(_oracle, "luminance", lambda *_a, **_o: pytest.fail("sampled"))
    illuminate(surface, SCENE)
    with vizlight.report(sample=0) as told:
        illuminate(surface, SCENE)
    assert np.isnan(told.error)
    assert "no point to light again" in str(told)


def test_nested_and_empty(surface):
    with vizlight.report() as outer:
        with vizlight.report() as inner:
            illuminate(surface, SCENE)
        illuminate(surface, SCENE)
        engine.shade(np.empty((0, 3)), np.empty((0, 3)), PLAIN)
    assert (len(inner.runs), len(outer.runs)) == (1, 2)
    assert outer.runs[1].points == 0
    assert np.isnan(outer.runs[1].nanoseconds)
    assert outer.terms == ("ambient", "diffuse", "specular")


def test_bad_samples():
    with pytest.raises(ValueError, match="sample: expected an integer of at least 0"):
        vizlight.report(sample=-1).__enter__()
    with pytest.raises(TypeError, match="seed: expected an integer"):
        vizlight.report(seed=0.5).__enter__()


@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize("what", ["line", "surface", "conditioned"])
def test_the_scalar_formulas_against_50_digits(model, what, random):
    scene = PLAIN.replace(depth_cue=DepthCue(front=3.0, back=9.0, back_scale=0.2))
    for point, tangent, normal in random.standard_normal((20, 3, 3)):
        lines = None if what == "surface" else [tangent]
        up = None if what == "line" else normal
        found = _oracle.luminance(point, lines, up, scene, model=model)
        exponent = 1.0 if what == "surface" else _oracle._exponent(1, 3)
        true = oracles.shade(point, lines, up, scene, exponent=exponent, model=model)[3]
        assert abs(found - float(true)) < 1e-13


def test_the_scalar_cylinder_against_50_digits(random):
    scene = Scene(
        lights=Light(direction=(1, 2, 3)),
        view=View(direction=(0, -1, 2)),
        material=Material(ambient=0, diffuse=1, specular=1, shininess=17.5),
    )
    for line in random.standard_normal((5, 3)):
        found = _oracle.luminance((0, 0, 0), [line], None, scene, model="cylinder")
        true = sum(oracles.line_light((1, 2, 3), (0, -1, 2), line, 17.5))
        assert abs(found - float(true)) < 1e-12


def test_a_flat_field_has_the_cosine():
    x, z = np.arange(9.0), np.zeros((9, 9))
    way = (0.6, 0, 0.8)
    t = _oracle.relief_ratio(x, x, z, np.array([4.0, 4, 0]), np.array([0, 0, 1.0]), 0.5, way)
    assert t == pytest.approx(0.8, abs=1e-4)


def test_command_line(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    pv.Sphere().save("ball.vtp")
    assert (
        cli.main(
            ["light", "ball.vtp", "-o", "lit.vtp", "--report", "--tolerance", "1/255", "--explain"]
        )
        == 0
    )
    said = capfd.readouterr().out
    assert "842 points lit in 1 run(s)" in said
    assert "ns a point" in said
    assert "error" in said
    assert "tolerance: 0.00392 of luminance, the bound of all is" in said
    assert cli.main(["light", "ball.vtp", "-o", "lit.vtp", "--tolerance", "much"]) == 2
    assert "--tolerance: expected a number or a fraction such as 1/255" in capfd.readouterr().err
