"""The error between points: its places, its reference, and the resolution that it takes."""

import warnings

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, shiny
from vectors import unit

import vizlight
from vizlight import Light, Material, Scene, View, engine, illuminate, refine
from vizlight.observers.check import Run, unseen
from vizlight.shading.inputs import ShadingInputs
from vizlight.shading.options import ShadingOptions
from vizlight.verify import between
from vizlight.verify.between import Between, Places

LIGHT, EYE = np.array([0.7, 0.6, 0.38]), np.array([0.1, 0.3, 0.9])
SCENE = Scene(lights=Light(direction=LIGHT), view=View(direction=EYE), material=SHINY)


@pytest.fixture(scope="module")
def ball():
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40)
    mesh.clear_data()
    mesh["normal"] = unit(np.asarray(mesh.points, dtype=np.float64))
    return mesh


def test_the_error_is_that_of_many_places(ball):
    """Against the textbook's formula at 200 thousand places, drawn and weighted by other means."""
    lit = illuminate(ball, SCENE, normals="normal")
    (run,) = vizlight.check(lit).runs
    random = np.random.default_rng(5)
    faces = ball.regular_faces
    size = ball.compute_cell_sizes(length=False, volume=False)["Area"]
    chosen = faces[random.choice(len(faces), 200_000, p=size / size.sum())]
    weights = -np.log(random.random((len(chosen), 3)))
    weights /= weights.sum(axis=1, keepdims=True)
    n = unit(np.einsum("mc,mcn->mn", weights, ball["normal"][chosen]))
    wi, wo = unit(LIGHT), unit(EYE)
    cosine = n @ wi
    mirror = np.maximum((2 * cosine[:, None] * n - wi) @ wo, 0) * (cosine > 0)
    true = 0.1 + 0.5 * np.maximum(cosine, 0) + 0.4 * mirror**20
    light = lit["luminance"]
    off = np.abs(true - np.einsum("mc,mc->m", weights, light[chosen]))
    assert run.places == 4096
    assert run.between_rms == pytest.approx(np.sqrt(np.mean(off * off)), rel=0.05)
    assert run.visible == pytest.approx(np.mean(off > 1 / 255), abs=0.01)
    assert 0.7 * off.max() < run.between <= off.max() * 1.01
    assert np.mean(off > run.between) < unseen(run.places)


def test_words(ball):
    lit = illuminate(ball, SCENE, normals="normal")
    words = str(vizlight.check(lit))
    assert "rounding error" in words
    assert "all 1522 points computed again one by one in float64" in words
    assert "at 4096 random places; 95 %: fewer than 0.08 % of the places are worse" in words
    assert "are off by more than 1/255; vizlight.refine to 1/255 leaves only places where" in words
    fine = str(vizlight.check(refine(ball, SCENE, normals="normal")))
    assert "vizlight.refine" not in fine
    part = str(vizlight.check(lit, sample=100))
    assert "100 points computed again" in part
    assert "95 %: fewer than 3 % of the points are worse" in part


@pytest.mark.parametrize("count", [1, 10, 300, 4096])
def test_the_confidence_is_95_percent(count):
    """A fault in a share p of the points is missed by a sample with probability (1 - p)^n."""
    assert (1 - unseen(count)) ** count == pytest.approx(0.05)
    assert unseen(3000) < 1e-3 < unseen(2990)
    assert unseen(0) == 1


def test_a_fault_in_one_of_a_thousand_points_is_found(monkeypatch):
    mesh = pv.Sphere(theta_resolution=200, phi_resolution=200)
    right = engine.shade_block

    def wrong(plan, rows, inputs, output):
        right(plan, rows, inputs, output)
        output.luminance[rows][7::1000] += 0.01

    monkeypatch.setattr(engine, "shade_block", wrong)
    lit = illuminate(mesh, SCENE)
    for seed in range(3):
        report = vizlight.check(lit, seed=seed)
        assert report.error == pytest.approx(0.01, rel=1e-3)
    run = report.runs[0]
    assert (run.sample, run.missed) == (4096, unseen(4096))


def test_lines_surfaces_and_volumes_have_an_error_and_clouds_have_none():
    flow = vizlight.load_example()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        meshes = [
            vizlight.streamlines(flow, SCENE, tangents="V", seeds=5),
            illuminate(flow.contour([600.0], scalars="Temp"), SCENE, tangents="V"),
            illuminate(flow, SCENE),
            illuminate(pv.PolyData(np.eye(3)), SCENE, tangents=np.eye(3)),
            vizlight.fur(pv.Sphere(), SCENE, density=0.3, fibres=20),
        ]
        runs = [run for mesh in meshes for run in vizlight.check(mesh).runs]
    assert [run.places for run in runs] == [4096, 4096, 4096, 0, 0, 0]
    assert all(0 < run.between < 1 for run in runs[:3])
    assert np.isnan(runs[3].between)
    words = [run.unmeasured.partition(",")[0] for run in runs]
    cloud = "points without cells between them"
    assert words == ["", "", "", cloud, "fur", "fur"]


def test_what_is_not_measured_is_named():
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)), material=SHINY)
    report = vizlight.check(vizlight.relief_shadow(pv.Sphere(), scene, lit=True))
    words = "not measured between points: cast shadows"
    assert str(report).count(words) == len(report.runs) == 2
    ball = pv.Sphere()
    ball["pair"] = np.concatenate([ball.points, np.roll(ball.points, 1, axis=1)], axis=1)
    report = vizlight.check(illuminate(ball, scene, tangents="pair"))
    assert report.runs[0].places
    assert "not measured between points: the peaks of highlights" in str(report)
    dull = scene.replace(material=shiny(specular=0))
    between = "not measured between points"
    assert between not in str(vizlight.check(illuminate(ball, dull, tangents="pair")))
    words = str(vizlight.check(illuminate(ball, scene)))
    assert between not in words
    assert words.endswith("not measured: what a reader can read back, see vizlight.legibility")


def test_no_sample_no_places(ball):
    report = vizlight.check(illuminate(ball, SCENE), sample=0)
    assert report.runs[0].places == 0
    assert np.isnan(report.between)
    empty = Run(points=0, terms=(), precision="float32", bytes=0, invalid=0)
    assert empty.missed == 0


def test_places_are_uniform_in_area(random):
    points = np.array([[0.0, 0], [1, 0], [0, 1], [9, 0], [0, 9]])
    cells = np.array([[0, 1, 2], [0, 3, 4]])
    places, cell = between.random_places(points, cells, 5000, random)
    assert np.mean(cell == 1) == pytest.approx(81 / 82, abs=0.001)
    where = between.interpolated(points, places)[cell == 1]
    np.testing.assert_allclose(where.mean(axis=0), 3, atol=0.1)
    assert np.mean(where.sum(axis=1) < 4.5) == pytest.approx(0.25, abs=0.03)
    np.testing.assert_allclose(places.weights.sum(axis=1), 1)
    segments = np.array([[0, 1], [0, 3]])
    _, cell = between.random_places(points, segments, 1000, random)
    assert np.mean(cell) == pytest.approx(0.9, abs=0.002)
    for none in (cells[:0], np.array([[1, 1, 1]])):
        places, _ = between.random_places(points, none, 10, random)
        assert len(places.weights) == 0


@pytest.mark.parametrize("k", [1, 2, 3])
def test_a_mean_of_spaces_depends_on_no_basis(k, random):
    n = 5
    base = random.standard_normal((1, k, n))
    frames = base + 0.3 * random.standard_normal((40, k, n))
    frames = np.linalg.qr(frames.swapaxes(1, 2))[0].swapaxes(1, 2)
    places = Places(random.integers(0, 40, (30, 3)), random.dirichlet(np.ones(3), 30))
    turned = np.linalg.qr(random.standard_normal((40, k, k)))[0] @ frames
    turned *= random.choice([-1, 1], (40, 1, 1))
    a, b = (unit_space(between.mean_spaces(rows, places)) for rows in (frames, turned))
    np.testing.assert_allclose(a, b, atol=1e-10)
    corner = Places(np.array([[3, 4, 5]]), np.array([[0.0, 1, 0]]))
    np.testing.assert_allclose(
        unit_space(between.mean_spaces(frames, corner))[0], unit_space(frames[4:5])[0], atol=1e-10
    )


def unit_space(frames):
    """Return the projections on the spaces of frames."""
    rows = np.linalg.qr(frames.swapaxes(1, 2))[0]
    return rows @ rows.swapaxes(1, 2)


@pytest.mark.parametrize("near", [False, True])
@pytest.mark.parametrize("lines", [False, True])
def test_the_peak_of_a_highlight_is_found(lines, near, random):
    """The best of many places in each cell is not brighter than the one in closed form."""
    points = random.standard_normal((300, 3)) * 0.05
    half = unit(unit(LIGHT) + unit(EYE))
    aside = 0.2 * random.standard_normal((300, 3))
    rows = unit(np.cross(half, aside) + 0.1 * aside) if lines else unit(half + aside)
    material = Material(ambient=0, diffuse=0, specular=1, shininess=300)
    ends = {"position": 9 * unit(LIGHT)} if near else {"direction": LIGHT}
    eye = {"position": 9 * unit(EYE)} if near else {"direction": EYE}
    scene = Scene(lights=Light(**ends), view=View(**eye), material=material)
    given = {"tangents": rows} if lines else {"normals": rows}
    field = Between(ShadingInputs(points=points, **given), scene, ShadingOptions(exponent=1))
    cells = np.arange(300).reshape(-1, 2 if lines else 3)
    (peak,) = field.peaks(cells)
    best = field.light(Places(cells, peak))[:, 0]
    assert np.mean(best > 0.99) > 0.2
    for weights in random.dirichlet(np.ones(cells.shape[1]), 200):
        other = field.light(Places(cells, np.tile(weights, (len(cells), 1))))[:, 0]
        inside = best > 0.95
        assert np.max(other[inside] - best[inside]) < 0.02


def test_rows_of_no_length_are_no_unit_vectors():
    rows = np.zeros((3, 3))
    assert not between.are_unit(rows)
    rows[1, 2] = 1
    assert between.are_unit(rows)
    rows[2, 0] = 2
    assert not between.are_unit(rows)
