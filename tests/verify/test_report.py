"""What light cost and how wrong it is: of every filter, by formulas that share no code with it."""

import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, far, shiny

import vizlight
from vizlight import (
    DepthCue,
    Frustum,
    Light,
    Material,
    Scene,
    Sphere,
    View,
    engine,
    fur,
    illuminate,
    project,
    relief_shadow,
    satin,
    streamlines,
)
from vizlight.geometry import manifolds
from vizlight.mesh import casters
from vizlight.shading import algebra
from vizlight.verify import oracle
from vizlight.verify import report as reports

SCENE = Scene(
    lights=[Light(direction=(1, 1, 1)), Light(position=(2, 3, 4), attenuation=(1, 0.1, 0.01))],
    view=View(position=(5, 4, 6)),
    depth_cue=DepthCue(back_scale=0.5, smooth=True),
    material=SHINY,
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


SCENE_4 = far((0.7, 0.6, 0.38, 0), (0, -1, 0.5, 0))
SUN = PLAIN.replace(lights=Light(direction=(1, 0.5, 1)))
FILTERS = {
    "surface": lambda s: illuminate(s, SCENE),
    "facing the eye": lambda s: illuminate(s, SCENE, facing="eye", model="blinn"),
    "conditioned": lambda s: illuminate(s, SCENE, tangents="V", conditioned=True, components=True),
    "uncompensated": lambda s: illuminate(s, SCENE, tangents="V", exponent=1),
    "cylinder": lambda s: illuminate(s, SCENE, tangents="V", model="cylinder"),
    "streamlines": lambda _: streamlines(vizlight.load_example(), SCENE, tangents="V", seeds=9),
    "satin": lambda s: satin(s, SCENE, tangents="V", seeds=5),
    "fur": lambda _: fur(pv.Sphere().compute_normals(), PLAIN, density=0.3, fibres=300),
    "4-space": lambda _: illuminate(torus(), SCENE_4, tangents="frame", positions="position"),
    "carrier": lambda _: illuminate(
        torus(), SCENE_4, tangents="frame", positions="position", conditioned="frame"
    ),
    "project": lambda _: project(torus(), rotation=("xw", 0.5), distance=3.0, scene=SCENE_4),
    "relief": lambda _: relief_shadow(terrain(), SUN, elevation="z", depth=0.5, lit=True),
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
    assert "computed again one by one in float64" in said


SHADOWS = {
    "two lights": (terrain, {"elevation": "z"}),
    "walls": (terrain, {"elevation": "z", "border": "wall"}),
    "sun's disc": (terrain, {"elevation": "z", "angular_diameter": 0.1}),
    "ball": (pv.Sphere, {"occluders": pv.Cube(center=(1, 1, 1)).triangulate()}),
    "ball, disc": (pv.Sphere, {"angular_diameter": 0.2}),
    "shell": (pv.Plane, {"thickness": 0.1}),
}


@pytest.mark.parametrize("name", SHADOWS)
def test_every_shadow_of_every_light(name, monkeypatch):
    make, options = SHADOWS[name]
    lights = [Light(direction=(1, 0.5, 1)), Light(position=(20, 90, 50), intensity=0.5)]
    scene = SUN.replace(lights=lights)
    with vizlight.report() as told:
        mesh = relief_shadow(make(), scene, depth=0.5 if make is terrain else 0.05, **options)
    (run,) = told.runs
    assert (run.points, run.terms, run.invalid) == (mesh.n_points, ("t",), 0)
    assert not run.tinted
    assert run.bytes == mesh["t"].nbytes
    assert run.sample > 30
    assert run.error < (4e-3 if make is terrain else 1e-9)
    right = casters.FieldCaster.ratios if make is terrain else casters.SolidCaster.ratios
    worse = lambda self, light, show: right(self, light, show) * (0.9 if light.position else 1)  # noqa: E731
    caster = casters.FieldCaster if make is terrain else casters.SolidCaster
    monkeypatch.setattr(caster, "ratios", worse)
    with vizlight.report() as told:
        relief_shadow(make(), scene, depth=0.5 if make is terrain else 0.05, **options)
    assert told.error > 0.02


def test_a_day_is_told_whole():
    with vizlight.report() as told:
        day = vizlight.relief_day(terrain(), latitude=46, day=172, hours=[9, 12, 15], depth=0.5)
    assert told.points == day.n_points
    assert told.bytes == day["t"].nbytes + day["t_mean"].nbytes
    assert told.error < 4e-3


def test_points_of_a_lit_shadow_count_once():
    with vizlight.report() as told:
        lit = relief_shadow(terrain(), SUN, depth=0.5, lit=True)
    assert len(told.runs) == 2
    assert told.points == lit.n_points


@pytest.mark.parametrize("levels", [12, 0.02])
@pytest.mark.parametrize("specular", [0.0, 0.4])
@pytest.mark.parametrize("what", [Sphere(), Sphere() - Frustum(axis=(0, 0, 4)), pv.Sphere()])
def test_bands_are_one_run(what, specular, levels):
    material = shiny(diffuse=0.5, specular=specular, color="tomato")
    scene = far((1, 1, 1), (0, 0, 1), material)
    with vizlight.report() as told:
        found = vizlight.isoluminance(what, scene, levels=levels)
    (run,) = told.runs
    assert run.points == found["bands"].n_points
    assert run.bound == found["bands"].field_data["luminance_error"][0]
    assert run.sample > 50
    assert 0.1 * run.bound < run.error <= run.bound * 1.001


def test_colours_are_checked_too(surface, monkeypatch):
    scene = PLAIN.replace(
        lights=[Light(direction=(1, 1, 1), color="gold"), Light(position=(9, 8, 7))],
        material=shiny(color="tomato", specular_color=(0.2, 1, 0.5)),
        depth_cue=DepthCue(back_scale=0.3, color="navy", cue=0.4),
        ambient_color="green",
    )
    with vizlight.report() as told:
        illuminate(surface, scene, tangents="V")
    assert told.error < 3e-6
    monkeypatch.setattr(algebra, "WHITE", (1.0, 0.9, 1.0))
    with vizlight.report() as told:
        illuminate(surface, scene, tangents="V")
    assert told.error > 1e-2


def test_the_oracle_agrees_on_what_can_be_lit(random):
    """Tangents nearly dependent are lit by both; points nowhere by neither."""
    line = random.standard_normal((60, 1, 3))
    near = np.concatenate([line, line + 3e-9 * random.standard_normal((60, 1, 3))], axis=1)
    points = random.standard_normal((60, 3))
    points[3], points[5, 1] = np.nan, np.inf
    with vizlight.report() as told:
        engine.shade(points, near, PLAIN)
    (run,) = told.runs
    assert (run.disagreed, run.sample, run.invalid) == (0, 58, 2)
    assert run.error < 1e-5


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
    monkeypatch.setattr(oracle, "light", lambda *_a, **_o: pytest.fail("sampled"))
    illuminate(surface, SCENE)
    with vizlight.report(sample=0) as told:
        illuminate(surface, SCENE)
    assert np.isnan(told.error)
    assert "no sample: error unknown" in str(told)


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


def test_light_above_one_is_counted():
    sphere = pv.Sphere(theta_resolution=40, phi_resolution=40)
    bright = SCENE.replace(material=Material(ambient=0.4, diffuse=0.7, specular=0.4))
    red = SCENE.replace(material=shiny(ambient=0.3, specular=0), lights=Light(direction=(1, 0, 0)))
    with vizlight.report() as found:
        lit = illuminate(sphere, bright)
        illuminate(sphere, red)
    above = int(np.count_nonzero(lit["luminance"] > 1))
    assert 0 < above < sphere.n_points
    assert [run.bright for run in found.runs] == [above, 0]
    assert found.bright == above
    assert f"{above} points are brighter than 1, which a picture shows as 1" in str(found)


def test_a_shadow_and_bands_say_what_they_are_compared_with():
    scene = Scene(view=View(direction=(1, 1, 1)))
    with vizlight.report() as shadow:
        relief_shadow(terrain(), SUN, depth=0.5)
    assert "error of t" in str(shadow)
    assert "each ray against all cells" in str(shadow)
    assert shadow.runs[0].error < 1e-12
    with vizlight.report() as bands:
        vizlight.isoluminance(pv.Sphere(), scene)
    assert "difference" in str(bands)
    assert "places from their band; stated bound" in str(bands)
    assert "not measured between points: a band has one light" in str(bands)
    assert "rounding error" not in str(shadow) + str(bands)


def test_light_inside_a_bundle_is_not_measured_between_points_and_the_report_says_why():
    line = pv.Spline(np.random.default_rng(1).random((9, 3)), 60)
    with vizlight.report() as found:
        illuminate(line, SCENE, bundle=True)
    assert "light inside a bundle" in found.runs[0].unmeasured


@pytest.mark.parametrize(
    ("scene", "again"),
    [(Scene(view=View(direction=(0, 0, 1))), "stored"), (PLAIN, "diffuse"), (SCENE, "diffuse")],
)
def test_points_on_whose_colours_light_is_put_count_once(scene, again):
    sphere = pv.Sphere()
    sphere["height"] = sphere.points[:, 2].copy()
    lit = illuminate(sphere, scene)
    with vizlight.report() as alone:
        vizlight.tint(lit, "height")
    assert [run.tinted for run in alone.runs] == [True]
    assert alone.points == sphere.n_points
    assert again in alone.terms
    with vizlight.report() as both:
        vizlight.tint(illuminate(sphere, scene), "height")
    assert [run.tinted for run in both.runs] == [False, True]
    assert both.points == sphere.n_points
    assert "842 points on whose colours light was put" in str(both)


def test_points_that_workers_light_are_counted_as_not_measured(tmp_path):
    pv.Sphere().save(tmp_path / "a.vtp")
    scene = Scene(view=View(direction=(0, 0, 1)))
    with ThreadPoolExecutor(1) as pool, vizlight.report() as found:
        vizlight.pieces.light(tmp_path / "a.vtp", scene, out=tmp_path / "lit.pvtp", map=pool)
    assert found.runs == []
    assert found.elsewhere == 842
    assert "842 points lit by workers, which record nothing" in str(found)
    with vizlight.report() as found:
        vizlight.pieces.light(tmp_path / "a.vtp", scene, out=tmp_path / "lit.pvtp")
    assert (found.points, found.elsewhere) == (842, 0)


@pytest.mark.parametrize(
    ("share", "words"), [(1.0, "100 %"), (0.95, "100 %"), (0.2501, "30 %"), (0.0031, "0.4 %")]
)
def test_a_bound_of_a_share_is_rounded_up_to_one_digit(share, words):
    assert reports._confident(share) == f"95 %: fewer than {words}"
