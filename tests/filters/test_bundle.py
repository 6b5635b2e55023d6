"""Light inside a bundle as a filter: what multiplies what, what is used again, surfaces, errors."""

import dataclasses

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, shiny
from refusals import refusals
from shapes import straws as lines

import vizlight
from vizlight import _pool
from vizlight.draw import live
from vizlight.filters import relight
from vizlight.geometry.lines import bundle as geometry
from vizlight.mesh import bundles
from vizlight.shading import engine
from vizlight.shading.options import LightOptions

FAR = vizlight.Light(direction=(0, 0, 1))
NEAR = vizlight.Light(position=(0.2, 0.1, 3.0), intensity=0.5)
OFF = vizlight.Light(direction=(1, 0, 0), intensity=0.0)
SCENE = vizlight.Scene(
    lights=[FAR, OFF, NEAR], view=vizlight.View(direction=(0, -1, 0.3)), material=SHINY
)
ABOVE = vizlight.Light(direction=(0.0, 0.6, 0.8))
QUICK = vizlight.Bundle(grid=24)


@pytest.fixture(scope="module")
def skylit():
    """Return lines whose colour comes by their material, under the sky."""
    scene = SCENE.replace(material=shiny(color=(1.0, 0.3, 0.2)))
    return vizlight.illuminate(lines(150), scene, bundle=QUICK, occlusion="sky", components=True)


def test_the_shares_multiply_each_light_and_the_ambient_term(skylit):
    """Against lighting by one light at a time, without a bundle."""
    mesh, lit = lines(150), skylit
    share, open_ = np.asarray(lit["transmittance"]), np.asarray(lit["sky"])
    assert share.shape == (mesh.n_points, 2)
    assert share.min() >= 0
    assert share.max() <= 1
    assert 0.02 < share.mean() < 0.98
    alone = [
        vizlight.illuminate(mesh, SCENE.replace(lights=[light]), components=True)
        for light in (FAR, NEAR)
    ]
    for term in ("diffuse", "specular"):
        expected = share[:, 0] * alone[0][term] + share[:, 1] * alone[1][term]
        np.testing.assert_allclose(lit[term], expected, atol=1e-6)
    np.testing.assert_allclose(lit["ambient"], open_ * alone[0]["ambient"], atol=1e-7)
    total = lit["ambient"] + lit["diffuse"] + lit["specular"]
    np.testing.assert_allclose(lit["luminance"], total, atol=1e-6)


def test_points_deep_inside_are_darker_and_the_outermost_are_not():
    mesh = lines(900)
    thick = dataclasses.replace(QUICK, diameter=mesh.length / 350)
    lit = vizlight.illuminate(mesh, SCENE.replace(lights=[FAR]), bundle=thick, occlusion="sky")
    height, share = np.asarray(mesh.points)[:, 2], np.asarray(lit["transmittance"])
    assert share[height > 0.8].mean() > 0.9
    assert share[height < -0.5].mean() < 0.3
    radius = np.abs(mesh.points).max(axis=1)
    assert lit["sky"][radius < 0.2].mean() < 0.6 * lit["sky"][radius > 0.8].mean()


def test_the_reference_of_a_check_takes_the_shares_too(skylit):
    report = vizlight.check(skylit, sample=60)
    assert report.error < 2e-6
    assert report.runs[0].sample == 60


def test_what_has_not_changed_is_not_computed_again(calls_of):
    calls = calls_of(geometry.Medium, "dimmed")
    lit = vizlight.illuminate(lines(), SCENE, bundle=QUICK)
    turned = vizlight.illuminate(
        lit, SCENE.replace(view=vizlight.View(direction=(1, 0, 0))), bundle=QUICK
    )
    assert np.array_equal(turned["transmittance"], lit["transmittance"])
    assert not np.array_equal(turned["luminance"], lit["luminance"])
    head = SCENE.replace(lights=[NEAR, vizlight.Light.headlight()])
    other = vizlight.illuminate(turned, head, bundle=QUICK)
    assert np.array_equal(other["transmittance"][:, 0], lit["transmittance"][:, 1])
    other.points[0, 0] += 0.1
    vizlight.illuminate(other, head, bundle=QUICK)
    vizlight.illuminate(lit, SCENE, bundle=dataclasses.replace(QUICK, depth=1.0))
    assert [len(lights) for _, _, _, lights in calls] == [2, 1, 2, 2]
    bare = vizlight.illuminate(lit, SCENE)
    assert "transmittance" not in bare.point_data


@pytest.mark.slow
def test_the_same_with_any_number_of_threads():
    mesh = lines(60)
    with _pool.threads(1):
        one = vizlight.illuminate(mesh, SCENE, bundle=QUICK, occlusion="sky")
    with _pool.threads(2):
        two = vizlight.illuminate(mesh, SCENE, bundle=QUICK, occlusion="sky")
    assert np.array_equal(one["transmittance"], two["transmittance"])
    assert np.array_equal(one["sky"], two["sky"])


def test_the_record_has_the_errors_of_each_light_and_a_check_prints_them(calls_of):
    lit = vizlight.illuminate(lines(), SCENE, bundle=QUICK)
    record = vizlight.provenance(lit)["bundle"]
    assert all(0.02 < mean < error < 1 for mean, error in zip(*errors_of(record), strict=True))
    text = f"error {max(record['error']):.2g} or less at 95 of 100 points, of the mean share"
    assert text in str(vizlight.check(lit, sample=5))
    measured = calls_of(bundles, "missed")
    other = vizlight.illuminate(lit, SCENE.replace(lights=[NEAR, FAR, ABOVE]), bundle=QUICK)
    assert [values[3] for values in measured] == [ABOVE.direction]
    again = vizlight.provenance(other)["bundle"]
    for kept, first in zip(errors_of(again), errors_of(record), strict=True):
        assert kept[:2] == first[::-1]
    assert len(again["error"]) == 3


def errors_of(record):
    return record["mean_error"], record["error"]


def in_one_light(mesh):
    scene = SCENE.replace(lights=[FAR])
    return vizlight.illuminate(mesh, scene, bundle=QUICK, occlusion="sky")


@pytest.fixture(scope="module")
def unmoved():
    return in_one_light(lines(24))


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", [np.float32, np.float64])
@pytest.mark.parametrize(("scale", "far"), [(1e-20, 0.0), (1e12, 0.0), (1.0, 1e4)])
def test_neither_the_unit_nor_the_place_matters(kind, scale, far, unmoved):
    moved = lines(24)
    moved.points = (np.asarray(moved.points, np.float64) * scale + far).astype(kind)
    found, other = unmoved, in_one_light(moved)
    off = 2e-2 if far and kind is np.float32 else 2e-3
    np.testing.assert_allclose(other["transmittance"], found["transmittance"], atol=off)
    assert abs(other["sky"] - found["sky"]).mean() < off


def test_the_default_diameter_has_the_depth_asked_for_or_a_share_of_the_size():
    ball = lines(6000)
    dense = vizlight.illuminate(ball, SCENE.replace(lights=[FAR]), bundle=QUICK)
    record = vizlight.provenance(dense)["bundle"]
    assert record["diameter"] < ball.length / 500
    half = dataclasses.replace(QUICK, depth=0.5)
    thin = vizlight.illuminate(ball, SCENE.replace(lights=[FAR]), bundle=half)
    ratio = vizlight.provenance(thin)["bundle"]["diameter"] / record["diameter"]
    assert ratio == pytest.approx(0.25)
    few = vizlight.illuminate(lines(20), SCENE, bundle=QUICK)
    record = vizlight.provenance(few)["bundle"]
    assert record["diameter"] == pytest.approx(lines(20).length / 500, rel=1e-6)
    assert vizlight.sky(lines(20), error=0.2)["sky"].min() > 0.7


def test_a_surface_is_dimmed_by_the_lines_above_it():
    """Lines above a plate: dark below their middle, bright beside, like the lines' own medium."""
    mesh = lines(3000)
    plate = pv.Plane(center=(0, 0, -1.2), i_size=6, j_size=6, i_resolution=30, j_resolution=30)
    scene = vizlight.Scene(lights=[FAR], view=vizlight.View(direction=(0, 0, 1)), material=SHINY)
    lit = vizlight.illuminate(plate, scene, bundle=dataclasses.replace(QUICK, lines=mesh))
    away = np.abs(plate.points[:, :2]).max(axis=1)
    assert lit["transmittance"][away < 0.3].max() < 0.3
    assert (lit["transmittance"][away > 1.3] == 1).all()
    both = vizlight.illuminate(pv.MultiBlock({"l": mesh, "p": plate}), scene, bundle=QUICK)
    np.testing.assert_allclose(both["p"]["transmittance"], lit["transmittance"], atol=1e-6)
    alone = vizlight.illuminate(mesh, scene, bundle=QUICK)
    np.testing.assert_allclose(both["l"]["transmittance"], alone["transmittance"], atol=1e-6)
    below = plate.copy()
    below.points[:, 2] = 1.2
    clear = vizlight.illuminate(below, scene, bundle=dataclasses.replace(QUICK, lines=mesh))
    assert clear["transmittance"].min() > 1 - 1e-6


def test_streamlines_and_segments_of_a_grid():
    flow = vizlight.load_example()
    lit = vizlight.streamlines(flow, SCENE, tangents="V", seeds=20, bundle=QUICK)
    assert lit["transmittance"].shape == (lit.n_points, 2)
    mesh = lines(60)
    grid = mesh.cast_to_unstructured_grid()
    found, same = (vizlight.illuminate(each, SCENE, bundle=QUICK) for each in (grid, mesh))
    np.testing.assert_allclose(found["transmittance"], same["transmittance"], atol=1e-6)
    pieces = mesh.copy()
    ids = mesh.lines.reshape(60, -1)[:, 1:]
    ends = np.stack([ids[:, :-1].ravel(), ids[:, 1:].ravel()], axis=1)
    pieces.lines = np.insert(ends, 0, 2, axis=1).ravel()
    cut = vizlight.illuminate(pieces, SCENE, bundle=QUICK)
    np.testing.assert_allclose(cut["transmittance"], same["transmittance"], atol=1e-5)


def test_a_bundle_alone_leaves_the_ambient_term_as_it_is():
    lit = vizlight.illuminate(lines(50), SCENE, bundle=vizlight.Bundle(grid=8), components=True)
    assert np.ptp(lit["ambient"]) == 0


def test_points_that_are_not_finite_and_lines_of_no_length():
    mesh = lines(40)
    mesh.points[5] = np.nan
    mesh.points[12:24] = mesh.points[12]
    with pytest.warns(UserWarning, match="could not be lit"):
        lit = vizlight.illuminate(mesh, SCENE, bundle=QUICK)
    assert np.isfinite(lit["luminance"]).all()
    assert lit["transmittance"][5].tolist() == [1, 1]
    one = pv.Line((0, 0, 0), (0, 0, 0))
    with pytest.warns(UserWarning, match="could not be lit"):
        assert np.isfinite(vizlight.illuminate(one, SCENE, bundle=True)["luminance"]).all()
    straight = vizlight.illuminate(pv.Line(resolution=50), SCENE, bundle=True)
    assert straight["transmittance"].min() > 0.99


def test_a_plan_says_that_light_is_dimmed():
    mesh = lines(3)
    share = np.full((mesh.n_points, 2), 0.5)
    given = engine.ShadingInputs(
        points=mesh.points, tangents=mesh.points, transmittance=share, occlusion=share[:, 0]
    )
    text = engine.run(given, SCENE, engine.ShadingOptions()).plan.explain()
    assert "transmittance: a share of each light for each point" in text
    assert "times the share of each point" in text
    whole = engine.shade(mesh.points, mesh.points, SCENE)
    half = engine.shade(mesh.points, mesh.points, SCENE, transmittance=share, occlusion=share[:, 0])
    np.testing.assert_allclose(half.luminance, whole.luminance / 2, rtol=1e-6)
    assert "transmittance" not in whole.plan.explain()
    share[0] = np.nan
    bad = engine.shade(mesh.points, mesh.points, SCENE, transmittance=share, occlusion=share[:, 0])
    assert bad.invalid == 1
    assert np.isfinite(bad.luminance).all()


test_bad_bundles = refusals(
    lambda keywords: vizlight.Bundle(**keywords),
    ({"diameter": 0.0}, "diameter"),
    ({"diameter": np.nan}, "diameter"),
    ({"grid": 2}, "grid"),
    ({"grid": 4096}, "grid"),
    ({"depth": 0}, "depth"),
    ({"lines": 3}, r"Bundle\(lines=\)", TypeError),
)
test_bad_input = refusals(
    lambda mesh, bundle: vizlight.illuminate(mesh, SCENE, bundle=bundle),
    (lines(5), "yes", "bundle: expected True, False or a vizlight.Bundle", TypeError),
    (pv.Sphere(), True, "bundle: expected a mesh with lines"),
    (lines(5), vizlight.Bundle(lines=pv.Sphere()), r"Bundle\(lines=\): expected a mesh of lines"),
)


def test_arrays_of_shares_that_do_not_fit():
    mesh = lines(5)
    mesh["transmittance"] = np.zeros(mesh.n_points)
    with pytest.raises(ValueError, match="'transmittance'"):
        vizlight.illuminate(mesh, SCENE, bundle=True)
    with pytest.raises(ValueError, match="transmittance: expected shape"):
        engine.shade(mesh.points, mesh.points, SCENE, transmittance=np.ones(mesh.n_points))


def test_live_light_takes_the_shares_or_says_why_not():
    mesh = lines(80)
    scene = SCENE.replace(lights=[FAR])
    lit = vizlight.illuminate(mesh, scene, bundle=QUICK)
    sources, used = relight.from_record(lit)
    again = engine.run(sources[0].inputs, used, sources[0].options)
    np.testing.assert_allclose(again.luminance, lit["luminance"], atol=1e-6)
    assert "bundle" in live.unfit(sources[0])
    head = SCENE.replace(lights=[vizlight.Light.headlight()])
    with pytest.raises(ValueError, match="bundle: expected lights that stay"):
        relight.from_options(mesh, head, LightOptions(bundle=QUICK))
