"""A material in VTK: the pixels that it renders against the light computed here."""

import warnings
from functools import cache

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

from vizlight import Light, Material, Scene, View, illuminate
from vizlight.scene.conversion import vtk_model

AXIS = View(direction=(0, 0, 1))


def turned(degrees, intensity=1.0):
    """A light so far from the eye on +z."""
    angle = np.deg2rad(degrees)
    direction = (np.sin(angle) * 0.6, np.sin(angle) * 0.8, np.cos(angle))
    return Light(direction=direction, intensity=intensity)


@cache
def ball():
    # The poles, where triangles are smaller than a pixel, lie at the rim.
    made = pv.Sphere(radius=1, theta_resolution=300, phi_resolution=300, direction=(0, 1, 0))
    made.point_data["Normals"] = np.asarray(made.points).copy()
    made.point_data.active_normals_name = "Normals"
    return made


def pictures(lights, model, shininess, *, parallel, specular=1.0):
    """Red channels of a fine sphere as VTK lights it and as vizlight does, and the disk."""
    material = Material(ambient=0.0, diffuse=0.0, specular=specular, shininess=shininess)
    images = []
    for by_vtk in (True, False):
        plotter = pv.Plotter(off_screen=True, window_size=(300, 300), lighting="none")
        plotter.background_color = "black"
        plotter.camera.position, plotter.camera.focal_point = (0, 0, 8), (0, 0, 0)
        plotter.camera.up, plotter.camera.view_angle = (0, 1, 0), 16
        if parallel:
            plotter.enable_parallel_projection()
            plotter.camera.parallel_scale = 1.1
        view = View.from_camera(plotter.camera)
        if by_vtk:
            for light in lights:
                plotter.add_light(as_vtk(light))
            shown = material.to_property(lights=lights, view=view, model=model)
            mapper = pv.DataSetMapper(ball())
            plotter.add_actor(pv.Actor(mapper=mapper, prop=shown))
        else:
            scene = Scene(lights=lights, material=material, view=view)
            lit = illuminate(ball(), scene, model=model)
            # As bytes: a colour table would round a second time.
            grey = np.rint(255 * np.clip(lit["luminance"], 0, 1)).astype(np.uint8)
            lit["grey"] = np.repeat(grey[:, np.newaxis], 3, axis=1)
            plotter.add_mesh(lit, scalars="grey", rgb=True, lighting=False)
        images.append(plotter.screenshot(return_img=True)[:, :, 0].astype(float))
    return images


def as_vtk(light):
    if light.follows_view:
        return pv.Light(light_type="headlight", intensity=light.intensity)
    made = pv.Light(light_type="scene light", intensity=light.intensity)
    made.positional = False
    made.position, made.focal_point = [1000 * x for x in light.direction], (0, 0, 0)
    return made


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.parametrize(
    ("lights", "model", "shininess", "parallel"),
    [
        # VTK's own model, so that nothing is exchanged.
        ([turned(40)], "phong", 12.0, False),
        ([turned(75, 0.5), turned(20, 0.5)], "phong", 30.0, False),
        ([Light.headlight()], "blinn", 20.0, True),
        # A dark light beside the headlight changes its model.
        ([Light.headlight(), Light(direction=(1, 0, 0), intensity=0)], "phong", 20.0, False),
        # Exchanged: Phong asked for under one headlight, Blinn under a light near the eye.
        ([Light.headlight()], "phong", 20.0, True),
        ([Light.headlight()], "phong", 30.0, True),
        ([turned(8)], "blinn", 80.0, False),
        ([turned(0)], "blinn", 80.0, False),
    ],
)
def test_pixels_of_vtk(lights, model, shininess, parallel, claim):
    """Within 2 of 255 wherever the highlight is; away from the rim, where a pixel is half bare."""
    theirs, ours = pictures(lights, model, shininess, parallel=parallel)
    y, x = np.mgrid[-1:1:300j, -1:1:300j]
    inside = np.hypot(x, y) < 0.86
    assert ours[inside].max() > 120
    claim(np.abs(theirs - ours)[inside].max(), 2)
    assert np.count_nonzero(theirs[inside] > 64) > 200


def test_the_reflection_model_of_vtk():
    head = Light.headlight()
    assert vtk_model([head]) == "blinn"
    for lights in ([head, head], [turned(0)], [head, turned(30)], []):
        assert vtk_model(lights) == "phong"


def test_values_of_the_property():
    material = Material(
        ambient=0.2, diffuse=0.6, specular=0.3, shininess=25.0, color="red", specular_color="gold"
    )
    made = material.to_property(lights=[turned(30)])
    assert (made.ambient, made.diffuse, made.specular) == (0.2, 0.6, 0.3)
    assert made.specular_power == 25
    assert made.diffuse_color == made.ambient_color == "red"
    assert made.specular_color == "gold"
    assert made.interpolation.name == "PHONG"
    exchanged = material.to_property(lights=Light.headlight())
    assert exchanged.specular_power == pytest.approx(4 * 25, rel=0.02)
    dark = [Light.headlight(), Light(direction=(1, 0, 0), intensity=0)]
    assert material.to_property(lights=dark).specular_power == 25


@pytest.mark.parametrize("lights", [None, [turned(30)], [turned(30), Light.headlight()]])
@pytest.mark.parametrize("model", ["phong", "blinn"])
@pytest.mark.parametrize("color", [None, "tomato"])
def test_there_and_back(lights, model, color):
    material = Material(ambient=0.2, diffuse=0.6, specular=0.01, shininess=21.5, color=color)
    options = {"lights": lights, "view": AXIS, "model": model}
    back = Material.from_property(material.to_property(**options), **options)
    assert back.shininess == pytest.approx(21.5, rel=1e-6)
    for name in ("ambient", "diffuse", "specular", "specular_color"):
        assert getattr(back, name) == getattr(material, name)
    assert back.color == (None if color is None else pytest.approx(material.color))


@pytest.mark.parametrize("shininess", [0.0, 0.3, 1.0])
def test_small_powers(shininess):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        made = Material(shininess=shininess).to_property()
        back = Material.from_property(made)
    assert back.shininess == pytest.approx(shininess, rel=1e-6)


@pytest.mark.parametrize("degrees", [0, 60, 120])
def test_a_property_there_and_back(degrees):
    """The exchange rises with the power and is its own inverse, from the smallest on."""
    options = {"lights": None if degrees == 0 else [turned(degrees)], "view": AXIS}
    model = "phong" if degrees == 0 else "blinn"
    powers = [0.1, 0.5, 0.99, 1.0, 4, 5, 6, 20, 120]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        read = [
            Material.from_property(pv.Property(specular_power=p), model=model, **options)
            for p in powers
        ]
        again = [material.to_property(model=model, **options).specular_power for material in read]
    np.testing.assert_allclose(again, powers, rtol=1e-12)
    assert np.all(np.diff([material.shininess for material in read]) > 0)


def test_colours_are_not_rounded():
    made = Material(color=(0.1, 0.2, 0.3), specular_color=(0.7, 0.05, 1)).to_property()
    back = Material.from_property(made, lights=[Light(direction=(0, 0, 1))])
    assert back.color == (0.1, 0.2, 0.3)
    assert back.specular_color == (0.7, 0.05, 1)


def test_warnings_tell_what_vtk_cannot():
    shiny = Material(specular=1.0, shininess=100.0)
    with pytest.warns(
        UserWarning, match=r"the Blinn model and power 128; .* exactly one light is switched on"
    ):
        assert shiny.to_property(lights=Light.headlight()).specular_power == 128
    with pytest.warns(
        UserWarning, match=r"the Phong model and power 128; .* Phong model with power 500"
    ):
        Material(specular=1.0, shininess=500.0).to_property(lights=[turned(30)])
    with pytest.warns(
        UserWarning,
        match=r"can differ by 33\.\d of 255 from the highlight of the Blinn model",
    ):
        Material(specular=1.0, shininess=40.0).to_property(
            lights=[turned(90)], view=AXIS, model="blinn"
        )
    odd = pv.Property(color="red")
    odd.ambient_color = "blue"
    with pytest.warns(UserWarning, match="ambient colour of the property differs from its diffuse"):
        Material.from_property(odd)


test_bad_input = refusals(
    lambda material, options: material.to_property(**options),
    (Material(diffuse=2), {}, "diffuse: expected at most 1"),
    (Material(), {"model": "cylinder"}, "model: expected 'phong' or 'blinn'"),
    (Material(), {"lights": 3}, "lights: expected a vizlight.Light, a pyvista.Light or", TypeError),
    (Material(), {"lights": "sun"}, "lights: expected a vizlight.Light, a pyvista.L", TypeError),
    (Material(), {"lights": ["sun"]}, "lights: expected a vizlight", TypeError),
    (Material(), {"lights": Light(direction=(1, 0, 0, 0))}, "lights: expected vectors of 3 compon"),
    (Material(), {"view": (0, 0, 1)}, "view: expected a vizlight.Vi", TypeError),
)


def test_what_is_no_property():
    with pytest.raises(TypeError, match="source: expected a pyvista.Property or vtkProperty"):
        Material.from_property("red")
