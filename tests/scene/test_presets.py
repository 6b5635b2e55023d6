"""Presets: no brighter than white, of equal luma, and the same from all sides."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest
import pyvista as pv
from vectors import unit

import vizlight
from vizlight import Material, Scene, View, engine, presets
from vizlight.scene.presets import LUMA, PRESETS, brightest_normal, brightest_tangent, hues

COUNT = 200_000


def lamps_of(scene):
    """Return directions and channels of lamps in the frame of the eye."""
    found = []
    for light in scene.lights:
        color = np.ones(3) if light.color is None else np.array(light.color)
        found.append((unit(light.direction or (0, 0, 1.0)), light.intensity * color))
    return found


def rays(random, count=COUNT):
    return unit(random.standard_normal((count, 3)))


@pytest.mark.sampled(2)
@pytest.mark.parametrize("name", PRESETS)
def test_no_tangent_and_no_normal_is_brighter_than_white(name, random):
    """By the law itself, and by the engine; the brightest normal is white to 1 in 1000."""
    scene = PRESETS[name]()
    lamps, material = lamps_of(scene), scene.material
    across = rays(random)
    normals = material.ambient + material.diffuse * sum(
        np.maximum(across @ d, 0)[:, np.newaxis] * w for d, w in lamps
    )
    assert normals.max() <= 1 + 1e-12
    if name == "shape":
        assert normals.max() > 0.999
    else:
        for p in (1.0, 1.3, 2.0, vizlight.model.brightness.exponent(1, 3), 9.0):
            sines = [np.sqrt(np.maximum(1 - (across @ d) ** 2, 0)) for d, _ in lamps]
            light = sum(s[:, np.newaxis] ** p * w for s, (_, w) in zip(sines, lamps, strict=True))
            assert (material.ambient + material.diffuse * light).max() <= 1 + 1e-12
    seen = scene.replace(view=View(direction=(3, -2, 1)))
    options = {"normals": across[:1000], "conditioned": True}
    given = across[1000:2000] if name in ("shape", "value") else across[:1000]
    lit = engine.shade(np.zeros((1000, 3)), given, seen, **options)
    assert (lit.luminance if lit.rgb is None else lit.rgb).max() <= 1 + 1e-6


def test_bounds_are_the_largest_light_or_near_it(random):
    across = rays(random)
    for _ in range(5):
        lamps = [(d, w) for d, w in zip(rays(random, 4), random.random((4, 3)), strict=True)]
        normals = sum(np.maximum(across @ d, 0)[:, np.newaxis] * w for d, w in lamps).max()
        assert 0.999 * brightest_normal(lamps) < normals <= brightest_normal(lamps)
        sines = sum(np.sqrt(1 - (across @ d) ** 2)[:, np.newaxis] * w for d, w in lamps).max()
        assert 0.93 * brightest_tangent(lamps) < sines <= brightest_tangent(lamps)
    one = [(np.array([0, 0, 1.0]), np.ones(3))]
    assert brightest_tangent(one) == brightest_normal(one) == 1


def test_hues_have_one_luma_and_a_white_mean():
    for saturation in (0.3, 1.0):
        colors = hues(3, saturation)
        np.testing.assert_allclose(colors @ LUMA, 1, atol=1e-14)
        np.testing.assert_allclose(colors.mean(axis=0), 1, atol=1e-14)
    assert hues(360, 1.0).min() == pytest.approx(0, abs=1e-14)
    ring = [w for _, w in lamps_of(presets.direction())]
    np.testing.assert_allclose(np.array(ring[:3]) @ LUMA, ring[0] @ LUMA, rtol=1e-12)
    assert np.ptp(ring[3]) == 0


@pytest.mark.parametrize("name", PRESETS)
def test_the_light_turns_with_the_eye(name, random):
    """A tangent and a normal given in the frame of the eye are lit alike in all views."""
    preset = PRESETS[name]
    local = rays(random, 50)
    found = []
    for view in (View(direction=(0, 0, 1)), View(direction=(1, 2, -3)), View(direction=(0, 1, 0))):
        world = local @ view.axes()
        normals = world if name in ("shape", "value") else None
        tangents = None if normals is not None else world
        lit = engine.shade(0 * world, tangents, preset(view), normals=normals)
        found.append(lit.luminance if lit.rgb is None else lit.rgb)
    np.testing.assert_allclose(found[1:], [found[0]] * 2, atol=1e-12)


def test_direction_is_hue_alone_under_exponent_2(random):
    """In the picture plane luma is constant and hue turns twice as fast as the tangent."""
    angles = np.linspace(0, np.pi, 200, endpoint=False)
    tangents = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    scene = presets.direction(View(direction=(0, 0, 1)))
    rgb = engine.shade(0 * tangents, tangents, scene, exponent=2).rgb
    np.testing.assert_allclose(rgb @ LUMA, (rgb @ LUMA)[0], atol=1e-12)
    blue = unit([0, -LUMA[2], LUMA[1]])
    grey = rgb - (rgb @ LUMA)[:, np.newaxis]
    hue = np.unwrap(np.arctan2(grey @ blue, grey @ np.cross(blue, unit(LUMA))))
    np.testing.assert_allclose(np.abs(hue - hue[0]), 2 * angles, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(grey, axis=1), np.linalg.norm(grey[0]), atol=1e-12)


def test_slope_and_heading_read_as_they_say():
    view = View(direction=(0, 0, 1))
    slopes = np.radians(np.arange(0, 91, 10))
    lines = np.stack([np.cos(slopes), 0 * slopes, np.sin(slopes)], axis=1)
    steep = engine.shade(0 * lines, lines, presets.slope(view)).luminance
    assert (np.diff(steep) < 0).all()
    assert steep[0] == pytest.approx(1)
    assert steep[-1] == pytest.approx(0.08)
    near, far = lines[3], lines[3] * [1, 1, -1]
    both = np.array([near, far])
    colors = engine.shade(0 * both, both, presets.heading(view)).rgb
    assert np.abs(colors[0] - colors[1]).max() > 0.05
    alike = engine.shade(0 * both, both, presets.slope(view)).luminance
    assert alike[0] == pytest.approx(alike[1])


def test_value_keeps_three_tenths_of_the_light(random):
    normals = rays(random, 2000)
    light = engine.shade(0 * normals, None, presets.value(), normals=normals).luminance
    assert light.min() == pytest.approx(0.3)
    assert presets.value().material == Material(ambient=0.3, diffuse=0.7, specular=0)


@pytest.mark.parametrize("name", PRESETS)
def test_views_cameras_plotters_and_records(name):
    preset = getattr(presets, name)
    assert preset is PRESETS[name]
    camera = pv.Camera()
    camera.position, camera.up = (3, 1, 2), (0, 1, 0)
    plotter = pv.Plotter(off_screen=True)
    plotter.camera = camera
    view = View.from_camera(camera)
    assert preset(camera) == preset(plotter) == preset(view) == preset().replace(view=view)
    assert preset().view is None
    assert Scene.from_dict(preset(view).to_dict()) == preset(view)
    with pytest.raises(TypeError, match="view: expected a vizlight.View, a pyvista.Camera, a py"):
        preset((0, 0, 1))


def test_the_lamps_of_the_ring_go_round_from_above_as_hues_do():
    """The first lamp is above the picture's centre; hues follow counter-clockwise."""
    ring = lamps_of(presets.direction(View(direction=(0, 0, 1))))[:3]
    azimuths = [np.degrees(np.arctan2(d[1], d[0])) % 360 for d, _ in ring]
    np.testing.assert_allclose(azimuths, [90, 210, 330], atol=1e-9)
    for (_, own), color in zip(ring, hues(3, 0.6), strict=True):
        np.testing.assert_allclose(own / own.sum(), color / color.sum(), atol=1e-12)


@pytest.mark.slow
def test_a_preset_added_by_the_recipe_is_taken_by_looks_pages_and_the_command_line(tmp_path):
    """In a copy of the package, by the three steps of the page of recipes."""
    package = tmp_path / "vizlight"
    shutil.copytree(vizlight.__path__[0], package, ignore=shutil.ignore_patterns("__pycache__"))
    preset = "def dusk(view=None, /):\n    return Scene(view=_view(view))"
    row = '    "dusk": Question("Dusk", "Light of dusk.", ("low",)),'
    for name, before, step in (
        ("scene/presets.py", "#: The presets by", preset),
        ("_questions.py", "}  # fmt: skip", row),
        ("presets.py", "__all__ = [", "from vizlight.scene.presets import dusk"),
    ):
        text = (package / name).read_text("utf-8")
        assert text.count(before) == 1
        (package / name).write_text(text.replace(before, f"{step}\n{before}"), "utf-8")
    pv.Sphere().save(tmp_path / "ball.vtp")
    code = f"""
import vizlight
from vizlight import cli
from vizlight.draw import html
assert vizlight.__path__ == [{str(package)!r}]
assert vizlight.look("ball.vtp", "dusk").question == "dusk"
assert html._looks(lines=False, values=False)["dusk"]["title"] == "Dusk"
assert vizlight.presets.key("dusk", question="dusk").field_data["words"] == ["low"]
raise SystemExit(cli.main(["light", "ball.vtp", "--for", "dusk", "-o", "lit.vtp"]))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False,
        env=os.environ | {"PYTHONPATH": str(tmp_path)},
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert pv.read(tmp_path / "lit.vtp")["luminance"].size
