"""The satin ball, as numbers: terminator, brightest point, dark side."""

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from refusals import refusals
from vectors import unit

import vizlight
from vizlight import Material
from vizlight.filters import relight

TOWARD, EYE = unit([(1.0, -1, 0.6), (0, -1, 0.3)])
SCENE = far(TOWARD, EYE, Material(ambient=0.1, diffuse=0.5, specular=1.0, color=(1.0, 0.25, 0.30)))


@pytest.fixture(scope="module")
def made():
    # An odd number of rings puts no point on a pole's degenerate field but the poles themselves.
    sphere = pv.Sphere(radius=1, theta_resolution=90, phi_resolution=91, start_phi=2, end_phi=178)
    normals = np.asarray(sphere.points, dtype=float)
    sphere["Normals"] = normals
    sphere.point_data.active_normals_name = "Normals"
    sphere["V"] = np.array([0, 0, 1.0]) - normals[:, 2:] * normals
    return sphere, vizlight.satin(sphere, SCENE, tangents="V", seeds=80, facing="outward")


def test_four_panels(made):
    sphere, panels = made
    assert panels.keys() == ["curves", "surface", "field", "conditioned"]
    assert all({"luminance", "rgb"} <= set(panel.point_data) for panel in panels)
    assert "luminance" not in sphere.point_data


def test_dark_side_is_exactly_ambient_in_d_and_not_in_c(made):
    sphere, panels = made
    cosine = np.asarray(sphere.points, float) @ TOWARD
    dark = cosine < -1e-6
    assert np.all(panels["conditioned"]["luminance"][dark] == 0.1)
    assert np.all(panels["surface"]["luminance"][dark] == 0.1)
    # The terminator is where the cosine vanishes.
    lit = panels["conditioned"]["luminance"] > 0.1
    assert cosine[~lit].max() < 1e-6 + cosine[lit].min() + 0.05
    assert panels["field"]["luminance"][dark].max() > 0.5
    np.testing.assert_allclose(
        panels["conditioned"]["rgb"][dark], np.tile([0.1, 0.025, 0.03], (dark.sum(), 1))
    )


def test_brightest_point_is_on_the_cone_of_reflection(made):
    sphere, panels = made
    tangent = unit(sphere["V"])
    miss = np.abs(np.arccos(tangent @ TOWARD) + np.arccos(tangent @ EYE) - np.pi)
    parts = vizlight.illuminate(sphere, SCENE, tangents="V", components=True)
    assert miss[np.argmax(parts["specular"])] < 0.05
    assert np.corrcoef(miss, parts["specular"])[0, 1] < -0.5
    # The satin's highlight is a band along latitudes, the plain ball's a spot.
    band = parts["specular"] > 0.5
    assert np.ptp(np.arctan2(*np.asarray(sphere.points)[band, 1::-1].T)) > 3
    assert panels["field"]["luminance"].max() > 1


def test_curves_have_the_light_of_the_field(made):
    curves = made[1]["curves"]
    outward = unit(np.asarray(curves.points, float))
    tangent = np.array([0, 0, 1.0]) - outward[:, 2:] * outward
    mesh = pv.PolyData(np.asarray(curves.points))
    mesh["T"] = tangent
    expected = vizlight.illuminate(mesh, SCENE, tangents="T")["luminance"]
    near_pole = np.abs(outward[:, 2]) > 0.98
    difference = np.abs(curves["luminance"] - expected)[~near_pole]
    assert np.median(difference) < 0.02
    assert np.quantile(difference, 0.99) < 0.1


def test_every_panel_can_be_lit_again_by_its_record(made):
    for panel in made[1]:
        # It is compared with the light that the panel has.
        relight.from_record(panel)


def test_satin_of_thin_cylinders(made):
    panels = vizlight.satin(made[0], SCENE, tangents="V", seeds=5, model="cylinder")
    told = [vizlight.provenance(panel)["options"]["model"] for panel in panels]
    assert told == ["cylinder", "blinn", "cylinder", "cylinder"]


def test_options_go_to_the_panels_that_they_fit():
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20, start_phi=5, end_phi=175)
    ball["way"] = np.array([0, 0, 1.0]) - 4 * ball.points[:, 2:] * ball.points
    options = {"facing": "as given", "components": True, "max_length": 0.5, "name": "x"}
    ball.point_data["Normals"] = -2 * np.asarray(ball.points)
    ball.point_data.active_normals_name = "Normals"
    panels = vizlight.satin(ball, SCENE, tangents="way", seeds=5, **options)
    for panel in panels:
        assert "x_diffuse" in panel.point_data
    away = np.asarray(ball.points) @ (1, -1, 0.8) < -0.1
    assert panels["surface"]["x_diffuse"][away].max() > 0.1
    assert panels["conditioned"]["x_diffuse"][away].max() > 0.1
    with pytest.raises(TypeError, match="conditioned: expected an option of satin, got a name"):
        vizlight.satin(ball, SCENE, tangents="way", conditioned=True)


def errors_name_the_argument(tangents):
    ball = pv.Sphere()
    ball["one"] = np.ones(ball.n_points)
    vizlight.satin(ball, SCENE, tangents=tangents)


test_errors_name_the_argument = refusals(
    errors_name_the_argument,
    ("T", "tangents: expected the name of a point array .*, got 'T'"),
    (np.ones((842, 3)), "tangents: expected the name of a point array, got an arr", TypeError),
    ("one", "tangents: expected vectors"),
)


@pytest.mark.filterwarnings("ignore:2 of 3482 points could not be lit")
@pytest.mark.filterwarnings("ignore:tangents. the cell array 'C' is averaged")
def test_vectors_of_cells_are_averaged():
    """Whatever their signs, the panels are those of the field at the points, nearly."""
    mesh = pv.Sphere(theta_resolution=60, phi_resolution=60)
    centres = np.asarray(mesh.cell_centers().points)
    across = np.cross(centres, (0, 0, 1))
    signs = np.random.default_rng(1).choice([-1.0, 1.0], size=(len(across), 1))
    mesh.cell_data["C"] = signs * across
    mesh.point_data["T"] = np.cross(mesh.points, (0, 0, 1)) + 1e-9
    found = vizlight.satin(mesh, SCENE, tangents="C", seeds=20)
    expected = vizlight.satin(mesh, SCENE, tangents="T", seeds=20)
    away = np.abs(np.asarray(mesh.points)[:, 2]) < 0.45
    for panel in ("surface", "field", "conditioned"):
        off = np.abs(found[panel]["luminance"] - expected[panel]["luminance"])[away]
        assert off.max() < 0.02
    assert found["curves"].n_lines == expected["curves"].n_lines == 20
    assert "C" not in mesh.point_data


def test_components_are_the_vectors_of_all_panels(made):
    sphere, panels = made
    apart = sphere.copy()
    del apart.point_data["V"]
    apart["u"], apart["v"], apart["w"] = np.asarray(sphere["V"]).T
    options = {"seeds": 80, "facing": "outward"}
    for names in (("u", "v", "w"), "u,v,w"):
        same = vizlight.satin(apart, SCENE, tangents=names, **options)
        for name in ("curves", "surface", "field", "conditioned"):
            np.testing.assert_allclose(
                same[name]["luminance"], panels[name]["luminance"], atol=1e-6
            )
