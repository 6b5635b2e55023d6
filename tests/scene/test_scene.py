"""Material, view, depth cue and scene: plain values in, plain values out."""

import dataclasses
import json
import math

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from scipy.ndimage import binary_erosion
from vtkmodules.vtkRenderingCore import vtkActor

from vizlight import DepthCue, Light, Material, Scene, View, engine, illuminate
from vizlight.scene import scene as scene_module


def full_scene():
    return Scene(
        lights=[
            Light(direction=(1, 0, 0), color="red"),
            Light.headlight(),
            Light(position=(0, 0, 9)),
        ],
        material=Material(ambient=0.2, color=(1, 0.25, 0.3), specular_color="white"),
        view=View(position=(0, 0, 5), direction=(0, 0, 1)),
        ambient_intensity=0.8,
        ambient_color="navy",
        depth_cue=DepthCue(front=1, back=9, cue=0.3, smooth=True),
    )


def test_defaults_are_those_documented():
    assert Material() == Material(ambient=0.3, diffuse=0.7, specular=0.0, shininess=20.0)
    scene = Scene()
    shoulder, fill = scene.lights
    # Azimuth 125 and altitude 45 degrees in the frame of the eye.
    np.testing.assert_allclose(shoulder.direction, (-0.405580, 0.579228, 0.707107), atol=1e-6)
    assert shoulder.follows_view
    assert fill.is_headlight
    assert (shoulder.intensity, fill.intensity) == pytest.approx((8 / 11, 3 / 11))
    assert (scene.ambient_intensity, scene.view, scene.depth_cue) == (1.0, None, None)
    assert not scene.colored


def test_survives_json():
    scene = full_scene()
    assert Scene.from_dict(json.loads(json.dumps(scene.to_dict()))) == scene


def test_replace_and_dimension():
    scene = full_scene()
    assert scene.n == 3
    assert scene.colored
    assert scene.replace(ambient_intensity=0).ambient_intensity == 0
    assert Scene(lights=[], view=View(direction=(1, 0, 0, 0))).n == 4
    assert Scene().n is None


def test_view_kinds():
    assert not View(position=(0, 0, 5)).parallel
    assert View(direction=(0, 0, 1)).parallel
    assert not View(position=(0, 0, 5), direction=(0, 0, 1)).parallel
    assert View(position=(0, 0, 5), direction=(0, 0, 1), parallel=True).parallel


@pytest.mark.parametrize("parallel", [False, True])
def test_view_from_camera(parallel):
    camera = pv.Camera()
    camera.position, camera.focal_point = (2, 0, 0), (0, 0, 0)
    camera.parallel_projection = parallel
    view = View.from_camera(camera)
    assert view.position == (2.0, 0.0, 0.0)
    np.testing.assert_allclose(view.direction, (1, 0, 0))
    assert view.parallel == parallel


def test_lights_and_cameras_of_pyvista_are_taken_as_they_are():
    camera = pv.Camera()
    camera.position, camera.focal_point = (0, 0, 4), (0, 0, 0)
    sun = pv.Light(position=(1, 2, 3), light_type="scene light", intensity=0.5)
    off = pv.Light(position=(1, 2, 3), light_type="scene light")
    off.on = False
    beside = pv.Light(position=(1, 0, 1), light_type="camera light")
    scene = Scene(lights=[sun, off, Light.headlight(), beside], view=camera)
    assert scene.view == View.from_camera(camera)
    assert [light.intensity for light in scene.lights] == [0.5, 1.0, 1.0]
    assert scene.lights[0] == Light(direction=(1, 2, 3), intensity=0.5)
    assert scene.lights[2] == Light(direction=(1, 0, 1), follows_view=True)
    assert Scene(lights=beside).lights == scene.lights[2:]
    assert scene.replace(lights=sun).lights == scene.lights[:1]
    assert Scene(lights=pv.Light(light_type="headlight")).lights[0].follows_view
    made = Material(specular=0, diffuse=0.5).to_property(lights=sun, view=camera)
    assert made.diffuse == 0.5


LOOK = {"ambient": 0.15, "diffuse": 0.6, "specular": 0.3, "specular_power": 18}


def plotter_of(mesh, lamps, **options):
    made = pv.Plotter(
        off_screen=True,
        window_size=(300, 240),
        lighting="light kit" if lamps == "light kit" else "none",
    )
    made.background_color = "black"
    actor = made.add_mesh(mesh, **options)
    made.camera_position = [(2.5, 1.5, 1), (0, 0, 0), (0, 0, 1)]
    if lamps == "two lights":
        made.add_light(pv.Light(position=(3, 2, 4), light_type="scene light", intensity=0.7))
        made.add_light(pv.Light(light_type="headlight", intensity=0.3))
    elif lamps == "headlight":
        made.add_light(pv.Light(light_type="headlight"))
    return made, actor


def channels(lit):
    """Light in three channels, equal where the scene has no colour."""
    grey = np.asarray(lit["luminance"])[:, np.newaxis]
    return np.asarray(lit["rgb"] if "rgb" in lit.point_data else np.repeat(grey, 3, axis=1))


def off_from_vtk(expected, ball, rgb):
    """Largest difference of a picture of colours at points from VTK's, off the silhouette."""
    shown = ball.copy()
    ours, _ = plotter_of(shown, "none", scalars=np.clip(rgb, 0, 1), rgb=True, lighting=False)
    got = np.array(ours.screenshot(return_img=True)).astype(int)
    inside = binary_erosion(expected.max(axis=2) > 0, iterations=4)
    assert inside.sum() > 5000
    return np.abs(got - expected)[inside].max()


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.parametrize(
    ("lighting", "model"),
    [
        ("light kit", "phong"),
        ("two lights", "phong"),
        ("headlight", "phong"),
        ("headlight", "blinn"),
    ],
)
def test_the_material_of_an_actor_gives_the_picture_of_vtk(lighting, model, claim):
    """Within 3 of 255 under perspective, off the silhouette."""
    ball = pv.Sphere(theta_resolution=300, phi_resolution=300)
    theirs, actor = plotter_of(ball, lighting, color="tan", smooth_shading=True, **LOOK)
    expected = np.array(theirs.screenshot(return_img=True)).astype(int)
    scene = Scene.from_plotter(theirs, actor=actor, model=model)
    with pytest.raises(ValueError, match="material: expected an actor alone, got both"):
        Scene.from_plotter(theirs, actor=actor, material=Material())
    for other in (ball, vtkActor()):  # which draws nothing
        with pytest.raises(TypeError, match=r"actor: expected a pyvista.Actor"):
            Scene.from_plotter(theirs, actor=other)
    seen = View.from_camera(theirs.camera)
    assert scene.view.parallel == (lighting == "headlight")
    assert (scene.view.position, scene.view.direction) == (seen.position, seen.direction)
    assert Scene.from_plotter(theirs, actor=actor, view=seen).view == seen
    claim(off_from_vtk(expected, ball, channels(illuminate(ball, scene, model=model))), 3)


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.parametrize("lighting", ["light kit", "two lights", "headlight"])
def test_colours_of_data_times_the_light_are_the_picture_of_vtk(lighting, claim):
    """The highlight has no part in the product, and lights keep their tints."""
    ball = pv.Sphere(theta_resolution=300, phi_resolution=300)
    heights = np.asarray(ball.points[:, 2])
    theirs, actor = plotter_of(
        ball.copy(), lighting, scalars=heights, cmap="viridis", interpolate_before_map=False,
        smooth_shading=True, show_scalar_bar=False, **LOOK,
    )  # fmt: skip
    expected = np.array(theirs.screenshot(return_img=True)).astype(int)
    scene = Scene.from_plotter(theirs, actor=actor)
    colours = pv.LookupTable("viridis", scalar_range=(heights.min(), heights.max()))(heights)
    material = scene.material
    matt = dataclasses.replace(material, specular=0.0)
    gloss = dataclasses.replace(material, ambient=0.0, diffuse=0.0)
    light, highlight = (
        channels(illuminate(ball, scene.replace(material=part))) for part in (matt, gloss)
    )
    claim(off_from_vtk(expected, ball, colours[:, :3] * light + highlight), 3)


@pytest.mark.opengl
def test_a_highlight_that_is_not_that_of_vtk_is_told_of():
    look = {"diffuse": 0.3, "specular": 1.0, "specular_power": 5.0}
    theirs, actor = plotter_of(pv.Sphere(), "headlight", **look)
    with pytest.warns(UserWarning, match="Blinn model and power 5; .* light by model='blinn'"):
        Scene.from_plotter(theirs, actor=actor)
    Scene.from_plotter(theirs, actor=actor, model="blinn")


@pytest.mark.opengl
def test_an_actor_coloured_by_data_gives_no_colour():
    plotter = pv.Plotter(off_screen=True)
    ball = pv.Sphere()
    actor = plotter.add_mesh(ball, scalars=ball.points[:, 2], diffuse=0.7, ambient=0.2)
    material = Scene.from_plotter(plotter, actor=actor).material
    assert material.color is None
    assert (material.diffuse, material.ambient) == (0.7, 0.2)


test_bad_values = refusals(
    lambda make, options: make(**options),
    (Material, {"diffuse": -0.1}, "diffuse: expected"),
    (Material, {"shininess": np.inf}, "shininess: expected a number from 0"),
    (Material, {"color": (1, 2)}, "color: expected three channels"),
    (View, {}, "View: expected position= .* or direction="),
    (View, {"position": (0, 0, 1), "parallel": True}, "direction: expected"),
    (View, {"direction": (0, 0, 1), "parallel": False}, "position: expected the eye"),
    (View, {"position": (0, 0, 1), "direction": (0, 1)}, "direction: expected 3 components"),
    (DepthCue, {"front": 1, "back": 1}, "front: expected a depth other than back"),
    (DepthCue, {"back_scale": 1.5}, "back_scale: expected a number from 0 to 1"),
    (
        Scene,
        {"lights": pv.Light(light_type="camera light", positional=True)},
        r"lights: expected a pyvista.Camera as view= .*from_plotter\(plotter\)",
    ),
    (
        Scene,
        {"lights": (1, 1, 1)},
        r"lights: expected a vizlight.Light, got 1; Light\(direction=\(1, 1, 1\)\) makes one",
        TypeError,
    ),
    (Scene, {"lights": np.array(3.0)}, r"lights: expected a vizlight\.Light", TypeError),
    (Scene, {"lights": np.array(Light.headlight())}, "lights: expected a vizlight.L", TypeError),
    (Scene, {"lights": ["sun"]}, "lights: expected a vizlight.Light, got 'sun'", TypeError),
    (
        Scene,
        {"lights": 3},
        "lights: expected a vizlight.Light, a pyvista.Light or a sequence of them, got 3",
        TypeError,
    ),
    (Scene, {"view": (0, 0, 1)}, "view: expected a vizlight.View, a camera or None", TypeError),
    (Scene, {"material": 0.5}, "material: expected a vizlight.Material", TypeError),
    (Scene, {"depth_cue": True}, "depth_cue: expected a vizlight.DepthCue", TypeError),
    (
        Scene,
        {"lights": Light(direction=(1, 0)), "view": View(direction=(1, 0, 0))},
        r"Scene: expected vectors of one space, got \[2, 3\] components",
    ),
)
test_what_is_no_camera_or_plotter = refusals(
    lambda make: make(),
    (lambda: View.from_camera("camera"), "camera: expected a pyvista.Camera"),
    (
        lambda: View.from_camera(pv.Plotter(off_screen=True)),
        "camera: expected .*; pass its .camera",
    ),
    (lambda: Scene(view=pv.Plotter(off_screen=True)), "view: expected .*; pass its .camera"),
    (lambda: Scene.from_plotter("plotter"), "plotter: expected a pyvista.Plotter"),
    kind=TypeError,
)


def test_a_moved_scene_lights_moved_points_the_same(random):
    points, tangents = random.standard_normal((2, 50, 3))
    offset = np.array([3.0, -2, 1])
    for view in (View(direction=(0, 1, 2)), View(position=(0, 5, 2), direction=(0, 5, 2))):
        scene = Scene(
            lights=[Light(position=(1, 1, 4)), Light(direction=(1, 0, 0)), Light.headlight()],
            view=view,
            depth_cue=DepthCue(front=-2, back=5),
        )
        found = engine.shade(points + offset, tangents, scene.moved(offset)).luminance
        np.testing.assert_allclose(
            found, engine.shade(points, tangents, scene).luminance, rtol=1e-12
        )


test_a_dict_of_another_kind_is_refused = refusals(
    Scene.from_dict,
    (None, "values: expected a dict of lights"),
    ({"light": []}, "values: expected a dict of lights.* got 'light'"),
    ({"lights": 5}, "lights: expected a list of dicts, got 5"),
    ({"lights": [5]}, "lights: expected a dict of direction"),
    ({"material": 3}, "material: expected a dict of ambient"),
    kind=(TypeError, ValueError),
)


def test_the_typed_keywords_are_those_of_the_scene():
    fields = {field.name for field in dataclasses.fields(Scene)}
    assert set(scene_module.SceneKeywords.__annotations__) == fields


def test_an_exposure_is_recorded_and_shows_colours():
    scene = Scene(exposure=1.5)
    assert scene.colored
    assert Scene.from_dict(scene.to_dict()) == scene
    for wrong in (0, -1.0, math.inf, 1e10):
        with pytest.raises(ValueError, match="exposure: expected"):
            Scene(exposure=wrong)
