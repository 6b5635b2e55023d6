"""What light cost and how wrong it is: of every filter, by formulas that share no code with it."""

import time
import warnings

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
from vizlight.observers import check as checks
from vizlight.shading import algebra
from vizlight.verify import oracle

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
    report = vizlight.check(FILTERS[name](surface), sample=40)
    assert report.runs
    assert report.points > 0
    assert report.bytes > 0
    assert report.seconds > 0
    for run in report.runs:
        shadow = run.terms == ("t",)
        limit = 3e-3 if shadow else 3e-6
        assert run.sample > 0
        assert 0 <= run.rms <= run.error < limit
        assert run.disagreed == 0
        assert shadow or run.nanoseconds > 0
    words = str(report)
    assert f"{report.points} points lit in {len(report.runs)} run(s)" in words
    assert "computed again one by one in float64" in words


SHADOWS = {
    "two lights": (terrain, {"elevation": "z"}),
    "walls": (terrain, {"elevation": "z", "border": "wall"}),
    "sun's disc": (terrain, {"elevation": "z", "angular_diameter": 0.1}),
    "ball": (pv.Sphere, {}),
    "ball, disc": (pv.Sphere, {"angular_diameter": 0.2}),
    "shell": (pv.Plane, {"thickness": 0.1}),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("name", SHADOWS)
def test_every_shadow_of_every_light(name, monkeypatch):
    make, options = SHADOWS[name]
    lights = [Light(direction=(1, 0.5, 1)), Light(position=(20, 90, 50), intensity=0.5)]
    scene = SUN.replace(lights=lights)
    mesh = relief_shadow(make(), scene, depth=0.5 if make is terrain else 0.05, **options)
    (run,) = vizlight.check(mesh, name="t").runs
    assert (run.points, run.terms, run.invalid) == (mesh.n_points, ("t",), 0)
    assert run.bytes == mesh["t"].nbytes
    assert run.sample > 30
    assert run.error < (4e-3 if make is terrain else 1e-9)
    right = casters.FieldCaster.ratios if make is terrain else casters.SolidCaster.ratios
    worse = lambda self, light, show: right(self, light, show) * (0.9 if light.position else 1)  # noqa: E731
    caster = casters.FieldCaster if make is terrain else casters.SolidCaster
    monkeypatch.setattr(caster, "ratios", worse)
    for components in (False, True):
        depth = 0.5 if make is terrain else 0.05
        mesh = relief_shadow(make(), scene, depth=depth, components=components, **options)
        assert vizlight.check(mesh, name="t").error > (0.02 if components else 0.005)


def test_a_day_is_told_whole():
    day = vizlight.relief_day(terrain(), latitude=46, day=172, hours=[2, 9, 12, 15], depth=0.5)
    report = vizlight.check(day, name="t")
    assert report.points == day.n_points
    assert report.bytes == day["t"].nbytes + day["t_mean"].nbytes
    assert report.error < 4e-3


def test_points_of_a_lit_shadow_count_once():
    lit = relief_shadow(terrain(), SUN, depth=0.5, lit=True)
    report = vizlight.check(lit)
    assert len(report.runs) == 2
    assert report.points == lit.n_points


@pytest.mark.sampled(3)
@pytest.mark.parametrize("levels", [12, 0.02])
@pytest.mark.parametrize("specular", [0.0, 0.4])
@pytest.mark.parametrize("what", [Sphere(), Sphere() - Frustum(axis=(0, 0, 4)), pv.Sphere()])
def test_bands_are_one_run(what, specular, levels):
    material = shiny(diffuse=0.5, specular=specular, color="tomato")
    scene = far((1, 1, 1), (0, 0, 1), material)
    contours = vizlight.isoluminance(what, scene, levels=levels)
    (run,) = vizlight.check(contours).runs
    assert run.points == contours["bands"].n_points
    assert run.bound == contours["bands"].field_data["luminance_error"][0]
    assert f"stated bound of the error {run.bound:.2g}; 0 invalid" in str(vizlight.check(contours))


def test_colours_are_checked_too(surface, monkeypatch):
    scene = PLAIN.replace(
        lights=[Light(direction=(1, 1, 1), color="gold"), Light(position=(9, 8, 7))],
        material=shiny(color="tomato", specular_color=(0.2, 1, 0.5)),
        depth_cue=DepthCue(back_scale=0.3, color="navy", cue=0.4),
        ambient_color="green",
    )
    assert vizlight.check(illuminate(surface, scene, tangents="V")).error < 3e-6
    monkeypatch.setattr(algebra, "WHITE", (1.0, 0.9, 1.0))
    assert vizlight.check(illuminate(surface, scene, tangents="V")).error > 1e-2


def test_the_oracle_agrees_on_what_can_be_lit(random):
    """Tangents nearly dependent are lit by both; points nowhere by neither."""
    line = random.standard_normal((60, 1, 3))
    near = np.concatenate([line, line + 3e-9 * random.standard_normal((60, 1, 3))], axis=1)
    points = random.standard_normal((60, 3))
    points[3], points[5, 1] = np.nan, np.inf
    inputs = engine.ShadingInputs(points=points, tangents=near.reshape(60, 6))
    options = engine.ShadingOptions()
    shading = engine.run(inputs, PLAIN, options)
    off, disagreed = checks.errors_at(np.arange(60), inputs, PLAIN, shading, options)
    assert (disagreed, len(off), shading.invalid) == (0, 58, 2)
    assert off.max() < 1e-5


def test_invalid_points_are_counted(random):
    vectors = random.standard_normal((50, 3))
    vectors[:7] = 0
    vectors[7:9] = np.nan
    mesh = pv.PolyData(random.standard_normal((50, 3)))
    mesh["V"] = vectors
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        lit = illuminate(mesh, PLAIN, tangents="V")
    report = vizlight.check(lit)
    assert report.invalid == 9
    assert report.runs[0].sample == 41
    assert report.runs[0].disagreed == 0
    assert "9 invalid" in str(report)


def test_blocks_without_points_or_a_sample(surface):
    lit = illuminate(pv.MultiBlock({"surface": surface, "empty": pv.PolyData()}), SCENE)
    report = vizlight.check(lit, sample=0)
    assert [run.points for run in report.runs] == [surface.n_points, 0]
    assert np.isnan(report.error)
    assert np.isnan(report.runs[1].nanoseconds)
    assert report.terms == ("ambient", "diffuse", "specular")
    assert "no sample: error unknown" in str(report)


def test_bad_samples():
    lit = illuminate(pv.Sphere(), SCENE)
    with pytest.raises(ValueError, match="sample: expected an integer of at least 0"):
        vizlight.check(lit, sample=-1)
    with pytest.raises(TypeError, match="seed: expected an integer"):
        vizlight.check(lit, seed=0.5)


def test_a_record_that_does_not_hold_its_arrays_or_meshes_is_refused():
    ball = pv.Sphere()
    lit = illuminate(ball, SCENE, normals=np.array(ball.points))
    with pytest.raises(ValueError, match="a record of illuminate that holds normals, got an arr"):
        vizlight.check(lit)
    cube = pv.Cube(center=(1, 1, 1)).triangulate()
    shadowed = relief_shadow(ball, SUN, occluders=cube)
    with pytest.raises(ValueError, match="a record of relief_shadow that holds occluders"):
        vizlight.check(shadowed, name="t")


def test_a_mesh_that_has_changed_is_refused():
    lit = illuminate(pv.Sphere(), SCENE)
    lit["luminance"][:400] *= 0.5
    with pytest.raises(ValueError, match="a mesh whose 'luminance' matches its record"):
        vizlight.check(lit)
    lit = illuminate(pv.Sphere(), SCENE)
    lit["luminance"][7] += 0.01
    assert vizlight.check(lit).error == pytest.approx(0.01, rel=1e-3)


def test_a_lamp_near_a_mesh_far_from_the_origin():
    """What is lit between the points moves with the lamp."""
    away = np.array([5e6, -3e6, 1e6])
    ball = pv.Sphere()
    ball.points = np.asarray(ball.points, dtype=np.float64)
    here, there = (
        vizlight.check(
            illuminate(
                ball.translate(shift),
                Scene(
                    lights=Light(position=shift + np.array((0.5, 1, 2))),
                    view=View(position=shift + np.array((0, 0, 3))), material=SHINY,
                ),
            )
        )
        for shift in (0 * away, away)
    )  # fmt: skip
    assert there.error < 1e-6
    assert there.between == pytest.approx(here.between, rel=0.02)


def test_the_time_is_that_of_the_light(monkeypatch):
    lit = illuminate(pv.Sphere(), SCENE)
    light = oracle.light
    monkeypatch.setattr(oracle, "light", lambda *a, **k: time.sleep(2e-3) or light(*a, **k))
    start = time.perf_counter()
    report = vizlight.check(lit, sample=50)
    assert report.seconds < time.perf_counter() - start - 0.1


def test_light_above_one_is_counted():
    sphere = pv.Sphere(theta_resolution=40, phi_resolution=40)
    bright = SCENE.replace(material=Material(ambient=0.4, diffuse=0.7, specular=0.4))
    red = SCENE.replace(material=shiny(ambient=0.3, specular=0), lights=Light(direction=(1, 0, 0)))
    lit = illuminate(sphere, bright)
    above = int(np.count_nonzero(lit["luminance"] > 1))
    assert 0 < above < sphere.n_points
    report = vizlight.check(pv.MultiBlock([lit, illuminate(sphere, red)]))
    assert [run.bright for run in report.runs] == [above, 0]
    assert report.bright == above
    assert f"{above} points are brighter than 1, which a picture shows as 1" in str(report)


def test_a_shadow_and_bands_say_what_they_are_compared_with():
    scene = Scene(view=View(direction=(1, 1, 1)))
    shadow = vizlight.check(relief_shadow(terrain(), SUN, depth=0.5), name="t")
    assert "error of t" in str(shadow)
    assert "each ray against all cells" in str(shadow)
    assert shadow.error < 1e-12
    assert np.isnan(shadow.seconds)
    bands = vizlight.check(vizlight.isoluminance(pv.Sphere(), scene))
    assert "not measured between points: a band has one light" in str(bands)
    assert "rounding error" not in str(shadow) + str(bands)


def test_light_inside_a_bundle_is_not_measured_between_points_and_the_report_says_why():
    line = pv.Spline(np.random.default_rng(1).random((9, 3)), 60)
    follows = Scene(
        lights=Light(direction=(1, 1, 1), follows_view=True), view=View(direction=(1, 0, 0))
    )
    for scene in (SCENE, follows):
        (run,) = vizlight.check(illuminate(line, scene, bundle=True)).runs
        assert "light inside a bundle" in run.unmeasured
        assert run.error < 1e-5


def test_colours_have_the_light_that_they_were_made_with():
    sphere = pv.Sphere()
    sphere["height"] = sphere.points[:, 2].copy()
    lit = illuminate(sphere, SCENE, name="light")
    report = vizlight.check(vizlight.tint(lit, "height", light="light"), name="rgb")
    assert report.error == vizlight.check(lit, name="light").error < 1e-6


def test_files_and_pieces_are_checked_as_meshes_are(tmp_path):
    pv.Sphere().save(tmp_path / "a.vtp")
    scene = Scene(view=View(direction=(0, 0, 1)))
    vizlight.pieces.light(tmp_path / "a.vtp", scene, out=tmp_path / "lit.pvtp")
    report = vizlight.check(vizlight.read(tmp_path / "lit.pvtp"))
    assert report.points == 842
    assert report.error < 1e-6


@pytest.mark.parametrize(
    ("share", "words"), [(1.0, "100 %"), (0.95, "100 %"), (0.2501, "30 %"), (0.0031, "0.4 %")]
)
def test_a_bound_of_a_share_is_rounded_up_to_one_digit(share, words):
    assert checks._confident(share) == f"95 %: fewer than {words}"
