"""Rows of short runs of each study: errors keep to the theory; times are not asserted."""

import re
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import studies
from studies import (
    _readable,
    areas,
    bundle,
    engine,
    fur,
    highlights,
    isoluminance,
    legibility,
    lines,
    normals,
    refinement,
    relief,
    sky,
    strokes,
)
from vizlight import _compiled, render
from vizlight.model import cylinder


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["layered", "along the light"])
def test_rays_among_tubes_and_the_medium_agree(kind):
    """The means over the points have a random error of about 0.005."""
    pytest.importorskip("embreex")
    far, inside = bundle.measure(kind, 10_000, 96, 0)
    (sides,) = bundle.measure(kind, 10_000, 48, 16)
    assert far.error < (0.05 if kind == "along the light" else 0.015)
    assert inside.error < 0.03
    assert sides.error < 0.015
    assert 0.1 < far.more["mean share"] < 0.9


def test_tubes_are_as_wide_as_lines():
    made = bundle.tubes("isotropic", 10)
    own = made.corners[: 2 * bundle.SIDES].reshape(-1, 3) - made.middles[0]
    along = own @ made.tangents[0]
    out = np.linalg.norm(own - along[:, None] * made.tangents[0], axis=1)
    assert np.abs(along) == pytest.approx(bundle.LENGTH / 2)
    assert out == pytest.approx(bundle.DIAMETER / 2, rel=0.03)


@pytest.mark.slow
def test_the_engine_has_the_light_of_the_script():
    rows = engine.measure(40_000, repeats=1)
    first = engine.first_calls([2_000])
    assert all(row.error < (1e-13 if "float64" in row.way else 2e-6) for row in rows + first)
    assert len(rows) == 4
    assert len(first) == 1


@pytest.mark.opengl
def test_more_segments_of_fur_are_nearer():
    (row,) = fur.measure(32, 3, repeats=1)
    few, many = (fur.along_fibres(n) for n in (1, 12))
    assert few > 3 * row.error > 6 * many > 0


def test_a_near_eye_or_lamp_has_errors_below_the_bound_of_its_largest_angle():
    for near in ("eye", "lamp", "eye and lamp"):
        errors = []
        for distance in (2.0, 5.0, np.inf):
            rows = highlights.measure(near, distance, 20_000, repeats=1)
            assert all(row.error < row.more["bound"] for row in rows)
            errors.append([row.error for row in rows])
        assert np.all(np.diff(errors, axis=0) < 0)
        assert errors[-1] == pytest.approx([63.75, 33.05], abs=0.6)


@pytest.mark.parametrize("shape", ["sphere", "cone"])
def test_contours_of_large_images_are_nearer_than_facets(shape):
    small, large = ({row.way: row for row in areas.measure(shape, side, 1)} for side in (60, 240))
    lines, facets = f"contours, {shape}", f"Gouraud, {shape}"
    assert large[lines].error < min(small[lines].error, large[facets].error / 2)
    assert all(row.more["covered"] > 0.89 for row in large.values())
    assert large[f"rays, {shape}"].parameter > 15 * small[f"rays, {shape}"].parameter
    assert large[lines].cost < small[lines].cost


def test_contours_of_smooth_normals_and_of_the_solid_are_circles():
    (ours, coarse), (_, fine) = (isoluminance.measure(side, 1) for side in (16, 64))
    (solid,) = isoluminance.of_solid(1)
    assert ours.error < 1e-5
    assert 1e-3 < fine.error < coarse.error / 3
    assert solid.error < 1e-10


@pytest.mark.opengl
@pytest.mark.slow
def test_presets_are_better_than_the_default_where_they_are_asked(monkeypatch):
    scenes = {way: make() for way, make in legibility.LIGHTS.items()}
    # Of the others it is enough that they are scenes.
    compared = ("default", "presets.direction", "presets.heading", "presets.shape")
    few = {way: lambda way=way: scenes[way] for way in compared}
    monkeypatch.setattr(legibility, "LIGHTS", few)
    rows = {(row.way, row.parameter): row for row in legibility.lights(("nut", "childress"), 1, 64)}
    assert {question for _, question in rows} == set(legibility.ERRORS)
    for question in ("direction", "heading", "shape"):
        row = rows[f"presets.{question}", question]
        assert row.error < 0.8 * row.cost, question
    assert rows["default", "slope"].error == rows["default", "slope"].cost


@pytest.mark.parametrize("name", _readable.known())
def test_a_data_set_has_what_is_asked_for(name):
    mesh, tangents, scalars = _readable.known()[name]()
    assert np.isfinite(mesh.points).all()
    if name not in _readable.LINES:
        assert np.mean(np.linalg.norm(mesh[tangents], axis=1) > 0.99) > 0.9
        assert np.ptp(mesh[scalars]) > 0


def test_models_of_lines_are_exact_where_it_is_said():
    rows = {(row.way, row.parameter): row for row in lines.measure(2000, repeats=1)}
    worst, plain = "largest error with the best factor", "RMS error without factor"
    for way in ("Banks, p = 1, diffuse", "Blinn, specular"):
        assert rows[f"{way}, headlight", 0].more[worst] < 1e-13
        assert rows[f"{way}, random", 0].more[worst] > 0.1
    assert rows["Banks, p(1, 3), diffuse, headlight", 0].error > 0.1
    for term in ("diffuse", "specular"):
        assert rows[f"exact, {term}, random", 0].error == 0
        rough, fine = (rows[f"tube, {term}, random", n].more[plain] for n in (8, 40))
        assert np.log(rough / fine) / np.log(5) == pytest.approx(2, abs=0.2)


def test_a_tube_of_many_sides_is_the_cylinder():
    wi, wo, t = lines.directions(50, headlight=False)
    diffuse, specular = lines.tube(wi, wo, t, 300, shininess=10.0)
    np.testing.assert_allclose(diffuse, cylinder.diffuse(wi, wo, t), atol=2e-4)
    exact = cylinder.specular(wi, wo, t, shininess=10.0)
    np.testing.assert_allclose(specular, exact, atol=2e-4)


@pytest.mark.opengl
def test_tubes_take_twenty_times_the_points():
    lit, tubes = (row.more for row in lines.drawn(10, repeats=1))
    assert 15 * lit["points"] < tubes["points"] < 25 * lit["points"]
    assert tubes["MB"] > 10 * lit["MB"]


@pytest.mark.parametrize("name", normals.SURFACES)
def test_normals_by_corners_converge(name):
    coarse, fine = (normals.normal_errors(name, n, repeats=1)[1].error for n in (20, 40))
    assert fine < (1.2 if "off by" in name else 0.75) * coarse


def test_gradients_are_those_of_the_functions(random):
    points = random.uniform(-2, 2, (20, 3))
    exact = points * (2, 2, 1)
    np.testing.assert_allclose(normals.gradient(normals.ellipsoid, points) / 2e-5, exact, atol=1e-8)


@pytest.mark.slow
@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", ["isosurface", "flow on it", "fibres", "aeroplane", "globe"])
def test_refinement_takes_a_third_of_the_points(name):
    rows = refinement.measure(name, (0.02, 0.01), (1, 2, 3, 4, 6, 8, 12, 16, 24))
    fine = [row for row in rows if row.way.endswith(refinement.ADAPTIVE)]
    even = [row for row in rows if row.way.endswith(refinement.UNIFORM)]
    assert all(row.error < 1.6 * row.parameter for row in fine)
    assert fine[0].cost <= fine[1].cost
    assert fine[1].cost < min(row.cost for row in even if row.error <= fine[1].error) / 3


@pytest.mark.parametrize("times", [1, 2, 4])
def test_the_points_of_a_uniform_refinement_are_counted(times):
    mesh = pv.Icosphere(nsub=1)
    fine = mesh.subdivide(times // 2, "linear") if times > 1 else mesh
    assert refinement.uniform_size(mesh.regular_faces, times) == fine.n_points
    assert refinement.uniform_size(np.array([[0, 1], [1, 2]]), times) == 2 * times + 1


@pytest.mark.parametrize("s", [2, 3])
@pytest.mark.parametrize("factor", [1, 2, 5])
def test_smaller_cells_hold_the_places(s, factor, random):
    weights = random.dirichlet(np.ones(s), 500)
    within, share = refinement.sub_cells(weights, factor)
    assert np.min(share) > -1e-12
    np.testing.assert_allclose(share.sum(axis=1), 1)
    np.testing.assert_allclose(within.sum(axis=2), 1)
    np.testing.assert_allclose(np.einsum("ms,msr->mr", share, within), weights)
    np.testing.assert_allclose(within * factor, np.rint(within * factor), atol=1e-9)


@pytest.mark.slow
def test_shadows_of_hills_and_of_a_hemisphere():
    rows = relief.measure(128, repeats=1)
    assert len(rows) == 1 + _compiled.active()
    assert all(row.error < 1e-12 for row in rows)
    # What is worked on at a time has a fixed size; the rest grows with the field.
    assert rows[0].more["bytes per point"] * 128**2 < 50e6 + 100 * 128**2
    coarse, fine = (relief.hemisphere(n)[0].error for n in (151, 601))
    assert fine < min(1e-3, coarse / 4)
    # Within its own four cells a node's ground is its tangent plane: nodes at the edge of their own
    # shadow differ from rays over the facets.
    assert relief.hard(96)[0].error < 0.07


def test_rays_in_small_steps_see_a_wall():
    """A wall of height 10 under a sun at 45 degrees shades the 9 nodes behind it."""
    z = np.zeros((30, 60))
    z[:, 40:] = 10.0
    at = np.stack([np.full(60, 15), np.arange(60)], axis=1)
    seen = relief.lit_places(z, at, np.array([1.0, 0.0, 1.0]) / np.sqrt(2))
    np.testing.assert_array_equal(seen, (np.arange(60) <= 30) | (np.arange(60) >= 40))


@pytest.mark.parametrize("way", relief.SHADED)
def test_a_slope_has_its_cosine_up_to_the_border(way, random):
    along, across = random.uniform(-0.5, 0.5, 2)
    x, y = np.meshgrid(3.0 * np.arange(12), 2.0 * np.arange(9))
    light = relief.SHADED[way](along * x + across * y + 500, np.array([3.0, 2.0]))
    np.testing.assert_allclose(light, relief.cosines(along, across), atol=1e-5)


def test_slopes_of_real_ground_are_those_of_its_heights():
    z, along, across, spacing = relief.real_ground(2)
    for slope, axis, step in ((along, 1, spacing[0]), (across, 0, spacing[1])):
        # A closed form at twice the nodes, beside differences of the fourth order.
        near, far = (np.roll(z, -k, axis) - np.roll(z, k, axis) for k in (1, 2))
        off = ((8 * near - far) / (12 * step) - slope)[8:-8, 8:-8]
        assert np.sqrt(np.mean(off**2)) < 0.01 * np.std(slope)


@pytest.mark.slow
def test_noise_of_whole_metres_is_that_of_the_differences():
    """Rounding has the variance 1/12; Horn's weights leave 3/8 of that of central differences."""
    coarse, fine = ({row.way: row for row in relief.shaded(n, 1)} for n in (1, 2))
    for rows in (coarse, fine):
        gdal, plain, *ours = (row.more["noise of metres, rms of 255"] for row in rows.values())
        assert gdal / plain == pytest.approx(np.sqrt(3 / 8), rel=0.03)
        assert ours == pytest.approx([plain, plain], rel=0.01)
        assert (
            rows["real ground, relief_shadow"].error
            < 0.8 * rows["real ground, GDAL's formula"].error
        )
    for way, row in coarse.items():
        assert row.error / fine[way].error == pytest.approx(4, rel=0.1)
        seams = (rows[way].more["at borders of tiles, rms of 255"] for rows in (coarse, fine))
        # A one-sided slope is off by the spacing times half the curvature.
        assert next(seams) / next(seams) == pytest.approx(2, rel=0.25)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:the sky changes inside of triangles")
def test_the_sky_keeps_to_the_error_that_is_asked():
    (field,) = sky.of_field(48, 0.3, 0.02)
    assert 0 < field.error <= 0.02 >= field.more["stated"]
    pytest.importorskip("embreex")
    (ball,) = sky.of_surface(400, 0.04)
    assert 0 < ball.error <= 0.04


@pytest.mark.opengl
@pytest.mark.parametrize("degrees", [0, 20, 90, 135])
def test_stripes_are_read_along_not_across(degrees):
    right, up = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    mesh = pv.Plane(i_size=2, j_size=2)
    mesh["way along"] = np.tile([right, up, 0], (mesh.n_points, 1))
    camera = render.camera_on(mesh.bounds, (0, 0, 1), parallel=True)
    true = strokes.ways(mesh, "way along", camera, (96, 96))
    shown = np.isfinite(true[..., 0])
    assert 0.2 < shown.mean() < 1
    assert np.allclose(true[shown], [right, up], atol=0.02)
    y, x = np.mgrid[:96, :96]
    stripes = np.repeat(127 + 120 * np.sin(0.4 * (x * up + y * right))[..., None], 3, axis=2)
    assert strokes.read_off(stripes, true, 5) < 2
    turned = np.stack([-true[..., 1], true[..., 0]], axis=-1)
    assert strokes.read_off(stripes, turned, 5) > 88


@pytest.mark.opengl
@pytest.mark.slow
def test_the_example_prints_the_figures_of_the_study():
    # The example has no lines from seeds at random.
    steps = [step for step in strokes.steps(True) if "streamlines at random, VTK" not in step.args]
    found = {row.way: row.error for step in steps for row in step()}
    script = Path(studies.__file__).parents[1] / "plot_read_direction.py"
    titles = re.findall(r"median error ([\d.]+)", script.read_text(encoding="utf-8"))
    for (way, error), figure in zip(found.items(), titles, strict=True):
        assert error == pytest.approx(float(figure), rel=0.1), way
