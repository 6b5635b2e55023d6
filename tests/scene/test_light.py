"""Lights: what they accept, where they stand, how VTK's are read."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from vectors import unit

from vizlight import Light, Material, Scene, View
from vizlight.model import falloff
from vizlight.scene.conversion import lights_of
from vizlight.shading.engine import shade


def test_plain_values():
    light = Light(position=np.array([1, 2, 3]), intensity=2, attenuation=[1, 0.5, 0], color="red")
    assert light.position == (1.0, 2.0, 3.0)
    assert light.direction is None
    assert light.intensity == 2.0
    assert light.attenuation == (1.0, 0.5, 0.0)
    assert light.color == (1.0, 0.0, 0.0)
    assert light == Light(position=(1, 2, 3), intensity=2, attenuation=(1, 0.5, 0), color="#ff0000")


def test_repr_tells_what_is_not_the_default():
    assert repr(Light.headlight(intensity=2)) == "Light.headlight(intensity=2)"
    assert repr(Light(direction=(0, 0, 1))) == "Light(direction=(0.0, 0.0, 1.0))"
    near = Light(position=(0, 0, 1), color="red", attenuation=(1, 1, 0))
    assert eval(repr(near)) == near


test_bad_values = refusals(
    lambda arguments: Light(**arguments),
    ({}, "Light: expected either direction=.* or position=, got neither"),
    ({"direction": (1, 0, 0), "position": (1, 0, 0)}, "got both"),
    (
        {"position": (1, 0, 0), "follows_view": True},
        "position: expected no position with follows_view=True",
    ),
    (
        {"direction": (1, 0, 0, 0), "follows_view": True},
        "direction: expected 3 components with follows_view=True",
    ),
    ({"direction": (0, 0, 0)}, "direction: expected a direction of non-zero"),
    ({"position": (np.inf, 0, 0)}, "position: .*direction="),
    ({"direction": (1, 0, 0), "intensity": -1}, "intensity: expected"),
    ({"direction": (1, 0, 0), "intensity": 1e39}, "from 0 to 1e\\+09"),
    ({"position": (1, 0, 0), "attenuation": (0, 0, 0)}, "attenuation: expected"),
    ({"direction": (1, 0, 0), "attenuation": (1, 1, 0)}, "has no distance"),
    ({"direction": (1, 0, 0), "color": "nothing"}, "color: expected"),
    ({"direction": "up"}, "direction: expected real numbers", TypeError),
)


def test_headlight_follows_the_view():
    headlight = Light.headlight(intensity=0.5)
    near = headlight.seen_from(View(position=(1, 2, 3)))
    assert (near.position, near.direction, near.intensity) == ((1.0, 2.0, 3.0), None, 0.5)
    far = headlight.seen_from(View(direction=(0, 0, 1)))
    assert (far.position, far.direction) == (None, (0.0, 0.0, 1.0))
    along = headlight.seen_from(View(position=(1, 2, 3), direction=(0, 1, 0)))
    assert (along.position, along.direction) == (None, (0.0, 1.0, 0.0))
    unseen = headlight.seen_from(None, n=4)
    assert (unseen.position, unseen.direction) == (None, (1.0, 1.0, 1.0, 1.0))
    fixed = Light(direction=(1, 0, 0))
    assert fixed.seen_from(None) is fixed


@pytest.mark.parametrize(
    ("law", "most"), [((0, 0, 1), 1000.0), ((0.2, 0.1, 0), 5.0), ((3, 1, 0), 2.0)]
)
def test_a_lamp_without_the_clamp_is_its_law_up_to_a_bound(law, most):
    light = Light.unclamped(position=(0, 0, 0), intensity=0.5, attenuation=law, most=most)
    d = np.geomspace(1e-3, 1e3, 61)
    value = light.intensity * falloff.distance(d, *light.attenuation)
    expected = 0.5 * np.minimum(most, 1 / (law[0] + law[1] * d + law[2] * d * d))
    np.testing.assert_allclose(value, expected, rtol=1e-14)


test_bad_bounds = refusals(
    lambda arguments: Light.unclamped(position=(1, 0, 0), **arguments),
    ({"most": 0}, "most: expected a number above 0"),
    ({"intensity": 2e6}, "intensity: expected"),
    ({"attenuation": (0, 0, -1)}, "attenuation: expected"),
)


@pytest.mark.opengl
@pytest.mark.parametrize("law", [(0, 0, 1), (0.5, 0.2, 0.1), (1, 0.2, 0.1)])
def test_a_near_lamp_of_a_plotter_has_the_light_of_vtk(law):
    plotter = pv.Plotter(off_screen=True, lighting="none", window_size=(100, 100))
    lamp = pv.Light(position=(0, 0, 0.6), light_type="scene light", intensity=0.2)
    lamp.positional, lamp.cone_angle, lamp.attenuation_values = True, 90, law
    plotter.add_light(lamp)
    plane = pv.Plane(i_size=2, j_size=2, i_resolution=100, j_resolution=100)
    plotter.add_mesh(plane, ambient=0, diffuse=1.0, specular=0, color="white")
    plotter.view_xy()
    middle = plotter.screenshot(return_img=True)[50, 50, 0]
    lit = plane.vizlight.illuminate(
        Scene.from_plotter(plotter).replace(material=Material(ambient=0, diffuse=1, specular=0))
    )
    light = lit["luminance"][plane.find_closest_point((0, 0, 0))]
    assert 255 * light == pytest.approx(middle, abs=2)


def camera():
    made = pv.Camera()
    made.position, made.focal_point, made.up = (3, -2, 4), (1, 0, 0.5), (0, 0, 1)
    return made


@pytest.mark.opengl
def test_camera_lights_stand_where_vtk_has_them():
    seen = camera()
    light = pv.Light(position=(0.3, 0.4, 1.0), focal_point=(0, 0, 0), light_type="camera light")
    renderer = pv.Plotter(lighting="none", off_screen=True).renderer
    renderer.camera = seen
    renderer.add_light(light)
    renderer.UpdateLightsGeometryToFollowCamera()
    toward = np.subtract(light.GetTransformedPosition(), light.GetTransformedFocalPoint())
    (read,) = lights_of([light], seen)
    assert read == Light(direction=(0.3, 0.4, 1.0), follows_view=True)
    placed = read.seen_from(View.from_camera(seen))
    np.testing.assert_allclose(unit(placed.direction), unit(toward), atol=1e-12)


def test_a_light_beside_the_eye_is_in_its_frame(random):
    """Right, up and toward the eye by another form: dot products with the placed direction."""
    for view, up in (
        (View(direction=(3.0, -2, 1)), (0, 0, 1)),
        (View(direction=(0.1, 0.2, -5)), (0, 1, 0)),
        (View(position=(1, 2, 3), direction=(1e-150, 2e-150, 0), up=(1, 1, 1e3)), (1, 1, 1e3)),
    ):
        e = unit(view.direction / np.abs(view.direction).max())
        for xyz in random.standard_normal((5, 3)):
            light = Light(direction=1e100 * xyz, follows_view=True, intensity=0.3, color="red")
            placed = light.seen_from(view)
            assert (placed.follows_view, placed.intensity) == (False, 0.3)
            assert placed.color == light.color
            d = np.linalg.norm(xyz) * unit(placed.direction / np.abs(placed.direction).max())
            assert d @ e == pytest.approx(xyz[2], abs=1e-13)
            # The screen's up is what is left of up across the eye.
            screen = np.array(up) - (np.array(up) @ e) * e
            assert d @ unit(screen) == pytest.approx(xyz[1], abs=1e-12)
            assert d @ unit(np.cross(up, e)) == pytest.approx(xyz[0], abs=1e-12)


def test_a_light_toward_the_eye_is_a_headlight():
    assert Light(direction=(0, 0, 7), follows_view=True) == Light.headlight()
    behind = Light(direction=(0, 0, -7), follows_view=True)
    assert not behind.is_headlight
    assert behind.seen_from(View(direction=(1, 0, 0))).direction == (-1.0, 0.0, 0.0)
    shoulder = Light(direction=(-1, 1, 1), follows_view=True)
    assert eval(repr(shoulder), {"Light": Light}) == shoulder
    assert shoulder.seen_from(None) == shoulder.seen_from(View(direction=(1, 1, 1)))
    with pytest.raises(ValueError, match="view: expected a view with a direction"):
        shoulder.seen_from(View(position=(1, 2, 3)))


def test_scene_lights_keep_position_attenuation_colour_and_transform():
    light = pv.Light(position=(1, 2, 3), color="blue", intensity=0.7, light_type="scene light")
    light.positional = True
    light.cone_angle = 90
    light.attenuation_values = (1, 0.2, 0.1)
    light.transform_matrix = np.diag([1.0, 1, 1, 1]) + np.eye(4, k=3) * 5
    (read,) = lights_of([light], camera())
    assert read.position == (6.0, 2.0, 3.0)
    assert read.attenuation == (1.0, 0.2, 0.1)
    assert read.color == (0.0, 0.0, 1.0)
    assert read.intensity == 0.7


def test_a_headlight_with_a_position_stands_in_the_eye():
    light = pv.Light(light_type="headlight")
    light.positional, light.cone_angle = True, 90
    light.attenuation_values = (1, 0.2, 0.1)
    (read,) = lights_of([light], camera())
    assert read.position == (3.0, -2.0, 4.0)
    assert read.attenuation == (1.0, 0.2, 0.1)


def test_a_light_without_direction_warns_and_is_left_out():
    light = pv.Light(position=(1, 2, 3), focal_point=(1, 2, 3), light_type="scene light")
    with pytest.warns(UserWarning, match="left out, because its focal point is its position"):
        assert list(lights_of([light], camera())) == []


def test_a_spotlight_warns():
    spot = pv.Light(position=(1, 2, 3), light_type="scene light")
    spot.positional, spot.cone_angle = True, 20
    with pytest.warns(UserWarning, match="spotlight of cone angle 20 degrees"):
        (read,) = lights_of([spot], camera())
    assert read.position == (1.0, 2.0, 3.0)


def mean_cosine(start, end, place, normal):
    """Return the mean over a segment of the cosine toward it where it is above the horizon.

    n . (x - p) is linear along the segment: its two parts, across the line and along it, over the
    distance have an inverse hyperbolic sine and the distance itself for integrals.
    """
    length = np.linalg.norm(end - start)
    way = (end - start) / length
    low, high = normal @ (start - place), normal @ (end - place)
    if max(low, high) <= 0:
        return 0.0
    cut = length * low / (low - high) if min(low, high) < 0 else 0.0
    ends = np.array([cut if low < 0 else 0.0, cut if high < 0 else length])
    nearest = (place - start) @ way
    foot = start + nearest * way - place
    off = np.linalg.norm(foot)
    whole = (normal @ foot) * np.arcsinh((ends - nearest) / off)
    whole += (normal @ way) * np.hypot(ends - nearest, off)
    return np.diff(whole)[0] / length


def test_linear_light_is_its_integral(seed):
    random = np.random.default_rng(seed)
    start, end = np.array([-1.0, 0, 0]), np.array([1.0, 0, 0])
    lamps = Light.linear(start, end, color="red")
    assert sum(lamp.intensity for lamp in lamps) == pytest.approx(1)
    scene = Scene(lights=lamps, material=Material(ambient=0, diffuse=1, specular=0))
    places, normals = random.uniform(-3, 3, (4000, 3)), unit(random.normal(size=(4000, 3)))
    along = np.clip(places[:, 0], -1, 1)
    far = np.hypot(np.hypot(places[:, 0] - along, places[:, 1]), places[:, 2]) >= 1
    places, normals = places[far], normals[far]
    lit = shade(places, None, scene, normals=normals).luminance
    exact = [mean_cosine(start, end, *pair) for pair in zip(places, normals, strict=True)]
    ends = [np.einsum("ij,ij->i", normals, tip - places) > 0 for tip in (start, end)]
    error, cut = np.abs(lit - exact), ends[0] != ends[1]
    assert error[~cut].max() < 1e-5
    assert error[cut].max() < 0.01
    assert cut.any()


test_bad_linear_lights = refusals(
    lambda arguments: Light.linear(*arguments[0], **arguments[1]),
    ((((0, 0, 0), (1, 0)), {}), "end: expected 3 components, as start has, got 2"),
    ((((0, 0, 0), (1, 0, 0)), {"lamps": 0}), "lamps: expected"),
    ((((0, 0, np.inf), (1, 0, 0)), {}), "start: expected finite"),
    ((((0, 0, 0), (1, 0, 0)), {"intensity": -1}), "intensity: expected"),
)
