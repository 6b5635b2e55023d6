"""The meter on pictures of meshes: laws, kinds of data, views, and input that does not fit."""

import dataclasses
import json

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals
from shapes import straws
from sheets import sheet

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, presets
from vizlight.draw.cameras import camera_on
from vizlight.observers.samples import moved
from vizlight.shading.options import LightOptions

pytestmark = pytest.mark.opengl

MATTE = Material(ambient=0.08, diffuse=0.9, specular=0)
#: A small picture with few places; the eye is as far away as that of the default.
FEW = {"size_mm": 40, "samples": 1024}
HEAD = Scene(lights=Light.headlight(), material=MATTE)
ABOVE = View(direction=(0, 0, 1))


def read(mesh, scene, **how):
    return vizlight.legibility(mesh, scene, **({"view": ABOVE} | FEW | how))


def eddies(count):
    """Return a ball with a field that turns as often as asked."""
    ball = pv.Icosphere(nsub=6)
    x, y, z = count * np.asarray(ball.points, np.float64).T
    slope = [
        np.cos(x) * np.cos(y) - np.sin(z) * np.sin(x),
        np.cos(y) * np.cos(z) - np.sin(x) * np.sin(y),
        np.cos(z) * np.cos(x) - np.sin(y) * np.sin(z),
    ]
    ball["v"] = np.cross(ball.points, np.stack(slope, axis=1))
    return ball


def test_finer_eddies_are_read_worse_until_chance():
    found = [read(eddies(k), presets.direction(), tangents="v", exponent=2) for k in (2, 16, 80)]
    bits = [one.direction.bits for one in found]
    medians = [one.direction.median for one in found]
    assert bits == sorted(bits, reverse=True)
    assert medians == sorted(medians)
    assert medians[0] < 10
    assert medians[-1] == 45
    assert found[-1].direction.readable == 0
    assert "turn within" in found[-1].unreadable["direction"]
    assert "direction is unreadable: the data turn" in str(found[-1])
    assert found[0].scale.pixels is not None
    assert found[0].scale.median > 4 * found[-1].scale.median


def test_an_empty_picture_says_chance_and_why_of_all_questions():
    random = np.random.default_rng(5)
    start = random.uniform(-1, 1, (40, 1, 3))
    way = random.normal(size=(40, 1, 3))
    points = start + np.linspace(-1, 1, 20)[:, np.newaxis] * way
    strokes = pv.PolyData(
        points.reshape(-1, 3),
        lines=np.insert(np.arange(800).reshape(40, 20), 0, 20, axis=1).ravel(),
    )
    strokes["v"] = np.repeat(way * random.uniform(0.2, 1, (40, 1, 1)), 20, axis=1).reshape(-1, 3)
    ball = pv.Icosphere(nsub=3)
    ball["s"] = np.asarray(ball.points)[:, 0]
    gray, found = np.full((220, 330, 3), 0.5), {}
    for mesh, key, how in (
        (strokes, "heading", {"tangents": "v", "line_width": 3}),
        (ball, ["shape", ("viridis", (-0.5, 0.5))], {"scalars": "s"}),
    ):
        read_of = vizlight.legibility(
            mesh, picture=gray, camera=camera_on(mesh, (0, 0, 1), aspect=1.5), key=key, **FEW, **how
        )
        text, record = str(read_of), read_of.to_dict()
        for name, reason in read_of.unreadable.items():
            found[name] = getattr(read_of, name)
            assert {figure for _, figure, _ in found[name].rows()[:-2]} == {"chance"}
            assert f"{name} is unreadable: {reason}" in text
            assert record[name]["chance"] == found[name].chance
            assert found[name].bits < 0.3
        assert read_of.scale is None or read_of.scale.pixels is None
    assert set(found) == {
        "direction", "slope", "heading", "sense", "order", "shape", "value", "speed",
    }  # fmt: skip
    for name in ("direction", "heading", "shape", "value"):
        assert found[name].median == found[name].chance
    assert found["slope"].spearman == found["speed"].spearman == 0
    for figure in (found["order"], found["sense"]):
        assert figure.told == figure.wrongly == figure.chance


@pytest.mark.sampled(3)
@pytest.mark.parametrize("tilt", [0, 15, 30, 45, 60, 75])
def test_a_plane_in_constant_light_has_no_shape(tilt):
    a = np.radians(tilt)
    plane = pv.Plane(direction=(np.sin(a), 0, np.cos(a)), i_resolution=4, j_resolution=4)
    flat = Scene(lights=[], material=Material(ambient=0.7, diffuse=0, specular=0))
    shape = read(plane, flat).shape
    assert shape.bits < 0.05
    assert shape.median == 45
    assert shape.unreadable
    # A narrow band has borders above all.
    assert "differ by less than an eye" in shape.reason or tilt == 75
    assert shape.readable == 0


def test_tangents_whose_length_in_the_picture_is_a_third_are_not_asked():
    plane = pv.Plane(i_size=3, j_size=2).triangulate()
    samples = []
    for length in (0.34, 0.36):
        plane["t"] = np.tile([length, 0, np.sqrt(1 - length**2)], (plane.n_points, 1))
        from_above = View(direction=(0, 0, 1), parallel=True)
        found = read(plane, presets.direction(), tangents="t", view=from_above, samples=64)
        samples.append(0 if found.direction is None else found.direction.samples)
    assert samples == [0, 64]


def test_thin_lines_are_read_worse_than_wide_ones():
    lines = straws(40, 8)
    thin, wide = (read(lines, presets.heading(), line_width=w).heading for w in (1, 6))
    assert thin.bits < 0.85 * wide.bits
    assert wide.median < 0.75 * thin.median < 15


def test_a_good_light_is_read_and_a_headlight_is_not():
    good = read(sheet(), presets.direction(), tangents="swirl", exponent=2)
    assert good.direction.within_10 > 0.6
    assert good.direction.median < 8
    bad = read(sheet(), HEAD, tangents="swirl")
    assert bad.direction.median == 45
    assert "do not follow" in bad.direction.reason
    assert good.slope is None
    assert good.value is None


def test_hues_that_show_values_tell_no_direction():
    found = read(sheet(), presets.direction(), tangents="swirl", scalars="height")
    assert "colours show values" in found.direction.reason
    assert found.value.median < 0.05


def test_a_diverging_map_is_read_under_a_lamp_and_a_gray_one_is_not():
    ball = pv.Sphere(theta_resolution=80, phi_resolution=80)
    ball["s"] = np.asarray(ball.points)[:, 2]
    side = View(direction=(1, 0.2, 0.1))
    belt, gray = (
        read(ball, Scene(), view=side, scalars="s", cmap=m).value for m in ("coolwarm", "gray")
    )
    assert belt.median < 0.04
    assert belt.readable > 0.7
    assert gray.median > 2 * belt.median
    assert gray.bits < 0.6 * belt.bits


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    "options",
    [{"occlusion": "sky"}, {"feature_angle": 30.0}, {"feature_angle": "auto"}],
)
def test_pictures_with_sky_and_sharp_edges_are_read(options):
    box = pv.Cube().triangulate().subdivide(3)
    found = read(box, presets.shape(), view=View(direction=(1, 0.7, 0.5)), **options).shape
    assert found.median < 30


@pytest.mark.sampled(2)
@pytest.mark.parametrize("angle", ["auto", 30.0, None])
def test_a_picture_of_sharp_edges_is_read_like_its_plotter(angle):
    """Flat sides of a box have one normal each; smooth ones none that is of a side."""
    box = pv.Cube().triangulate().subdivide(3).clean()
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.background_color = "white"
    how = {} if angle == "auto" else {"feature_angle": angle}
    plotter.vizlight.add_mesh(box, scene=presets.shape(), **how)
    plotter.camera = camera_on(box, (1, 0.7, 0.5), aspect=1.5)
    whole = plotter.vizlight.legibility(**FEW).shape
    picture, camera = plotter.screenshot(return_img=True), plotter.camera.copy()
    read = {"picture": picture, "camera": camera, "key": presets.shape()} | FEW
    assert vizlight.legibility(box, **read, **how).shape == whole
    assert whole.median < 20
    if angle is not None:
        assert vizlight.legibility(box, **read, feature_angle=None).shape.bits < whole.bits / 2


@pytest.mark.slow
def test_lines_of_a_diameter_are_as_wide_in_any_picture():
    lines = straws(60)
    picture, camera = shot(lines.tube(radius=0.02), color="red", lighting=False)
    how = {"picture": picture, "camera": camera, "key": HEAD, "samples": 64}
    thin, wide = (vizlight.legibility(lines, **how, line_diameter=d) for d in (None, 0.04))
    assert wide.pixels == pytest.approx(int((picture[..., 2] < 128).sum()), rel=0.1)
    assert thin.pixels < wide.pixels / 2


@pytest.mark.slow
def test_pictures_with_bundles_are_read():
    fixed = Scene(lights=Light(direction=(0, 0.3, 1)), material=MATTE)
    alone, inside = (read(straws(), fixed, bundle=b, line_width=3).slope for b in (False, True))
    assert alone.bits != inside.bits


def shot(mesh, **how):
    """Return a picture of PyVista's, and its camera."""
    plotter = pv.Plotter(off_screen=True, window_size=(480, 320))
    plotter.add_mesh(mesh, show_scalar_bar=False, **how)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    picture, camera = plotter.screenshot(return_img=True), plotter.camera.copy()
    return picture, camera


@pytest.mark.slow
def test_any_picture_is_read_by_its_key(tmp_path):
    mesh = sheet()
    picture, camera = shot(mesh, scalars="height", cmap="coolwarm", lighting=False)
    ends = float(mesh["height"].min()), float(mesh["height"].max())
    how = {"scalars": "height", "key": ("coolwarm", ends), "camera": camera, "samples": 1024}
    value = vizlight.legibility(mesh, picture=picture, **how).value
    assert value.median < 0.03
    path = tmp_path / "picture.png"
    from PIL import Image

    Image.fromarray(picture).save(path)
    assert vizlight.legibility(mesh, picture=path, **how).value == value
    Image.fromarray(picture).save(path.with_suffix(".jpg"), quality=30)
    jpeg = vizlight.legibility(mesh, picture=path.with_suffix(".jpg"), **how).value
    assert value.bits >= jpeg.bits > 0.6 * value.bits
    gray = np.repeat(picture.mean(axis=2, keepdims=True) / 255, 3, axis=2)
    assert vizlight.legibility(mesh, picture=gray, **how).value.bits < 0.7 * value.bits
    other = np.roll(picture[:, ::-1], 90, axis=1)
    assert vizlight.legibility(mesh, picture=other, **how).value.bits < 0.5 * value.bits
    both = vizlight.legibility(mesh, picture=picture, **(how | {"key": [HEAD, how["key"]]}))
    assert both.shape is not None


def test_a_mesh_that_an_actor_has_moved_keeps_vectors_of_whole_numbers():
    mesh = pv.Sphere(theta_resolution=6, phi_resolution=6)
    mesh["v"] = np.ones((mesh.n_points, 3), np.uint8)
    mesh.set_active_vectors("v")
    placed, _ = moved(mesh, LightOptions(), np.diag([1.0, 2, 1, 1]))
    assert mesh["v"].dtype == np.uint8
    np.testing.assert_allclose(placed.bounds_size[1], 2 * mesh.bounds_size[1], rtol=1e-6)


def test_a_whole_plotter_is_read():
    mesh = sheet()
    plotter = pv.Plotter(off_screen=True, window_size=(480, 320))
    plotter.vizlight.add_mesh(mesh, scene=presets.direction(), tangents="swirl", exponent=2)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    bare = plotter.vizlight.legibility(samples=1024)
    plotter.add_mesh(pv.Plane(center=(0.5, 0, 1), i_size=1, j_size=2), color="black")
    plotter.vizlight.add_key()
    half = plotter.vizlight.legibility(samples=1024)
    assert half.pixels < 0.7 * bare.pixels
    assert abs(half.direction.median - bare.direction.median) < 4


def test_speed_is_ranked_by_lightness():
    mesh = sheet()
    mesh["speed"] = np.linalg.norm(mesh["swirl"], axis=1)
    flat = Scene(lights=[], material=Material(ambient=1, diffuse=0, specular=0))
    how = {"tangents": "swirl", "scalars": "speed"}
    rising = read(mesh, flat, cmap="viridis", **how).speed
    assert rising.spearman > 0.95
    assert rising.bits > 1.5
    constant = read(mesh, flat, cmap=["gray", "gray"], **how).speed
    assert constant.unreadable
    assert constant.spearman == 0


@pytest.mark.slow
def test_a_smaller_picture_is_read_worse_and_a_screen_is_a_size():
    how = {"tangents": "v", "exponent": 2}
    small, large = (
        read(eddies(20), presets.direction(), size_mm=mm, **how).direction for mm in (20, 85)
    )
    assert small.bits < large.bits
    screen = vizlight.legibility(sheet(), HEAD, screen=96, samples=256)
    assert screen.size == (1200, 800)
    assert screen.distance_mm == 600
    assert screen.size_mm == pytest.approx(25.4 * 1200 / 96)


def test_a_seed_repeats_and_another_one_does_not():
    runs = [read(sheet(), presets.shape(), seed=seed) for seed in (3, 3, 4)]
    assert runs[0] == runs[1]
    assert runs[0].shape != runs[2].shape


@pytest.mark.slow
def test_more_noise_is_read_worse():
    how = {"tangents": "swirl", "exponent": 2}
    bits = [
        read(sheet(), presets.direction(), noise=n, **how).direction.bits for n in (0.5, 2.3, 10)
    ]
    assert bits == sorted(bits, reverse=True)


@pytest.mark.parametrize(
    "change",
    [
        {"view": None},
        {"view": View(position=(0, 0, 4))},
        {"scene": presets.direction().replace(depth_cue=DepthCue(back_scale=0.5))},
    ],
    ids=["none", "perspective", "cue"],
)
def test_views_and_lamps(change):
    how = {"scene": presets.direction(), "tangents": "swirl", "exponent": 2} | change
    found = read(sheet(), how.pop("scene"), **how)
    assert found.direction.median < 15


def test_records_print_and_become_dicts():
    found = read(sheet(), presets.shape(), scalars="height")
    text = str(found)
    assert "nearest colour of the bar" in text
    assert "seen from 400 mm" in text
    assert found._repr_html_().count("<tr>") == 1 + len(found._rows())
    assert json.loads(json.dumps(found.to_dict()))["value"]["samples"] > 500
    with pytest.raises(dataclasses.FrozenInstanceError):
        found.seed = 1


def test_what_has_no_answer_is_noted():
    mesh = sheet()
    mesh["one"] = np.full(mesh.n_points, 3.0)
    found = read(mesh, HEAD, scalars="one")
    assert found.value is None
    assert "constant" in found.notes[0]
    mesh["part"] = np.where(mesh.points[:, 0] > 0, np.nan, mesh["height"])
    found = read(mesh, HEAD, scalars="part")
    assert 300 < found.value.samples < 700
    assert any("have no value" in note for note in found.notes)


def bad_input(change):
    how = {"mesh": sheet(12), "scene": HEAD, **FEW} | change
    mesh, scene = how.pop("mesh"), how.pop("scene")
    vizlight.legibility(mesh, scene, **how)


PICTURE = np.zeros((32, 48, 3))

test_bad_input = refusals(
    bad_input,
    ({"scene": None}, "scene: expected a vizlight.Scene", TypeError),
    ({"scene": Scene(view=View(direction=(1, 0, 0, 0)))}, "project the mesh"),
    ({"mesh": 3}, "mesh: expected a PyVista mesh", TypeError),
    ({"mesh": pv.PolyData()}, "expected a mesh with points"),
    ({"conditioned": "frame"}, "conditioned: expected True or False", TypeError),
    ({"cmap": "viridis"}, "cmap: expected scalars= beside it"),
    ({"clim": (0, 1)}, "clim: expected scalars= beside it"),
    ({"noise": -1}, "noise: expected a number from 0 to 100"),
    ({"samples": 0}, "samples: expected an integer of at least 1"),
    ({"seed": 0.5}, "seed: expected an integer", TypeError),
    ({"size_mm": 0}, "size_mm: expected"),
    ({"dpi": 2400.5}, "dpi: expected a number from 10 to 2400"),
    ({"dpi": 9.5}, "dpi: expected a number from 10 to 2400"),
    ({"screen": 96, "size_mm": 85}, "screen: expected a picture in print or on a screen"),
    ({"view": View(direction=(1, 0, 0, 0))}, "view: expected vectors of 3 components"),
    ({"view": "top"}, "view: expected a vizlight.View", TypeError),
    ({"key": HEAD}, "key: expected picture= beside it"),
    ({"picture": PICTURE}, "camera: expected a pyvista.Camera", TypeError),
    ({"picture": PICTURE[0]}, "picture: expected an array of shape"),
    ({"picture": 2 + PICTURE}, "picture: expected bytes, or numbers from 0 to 1"),
    ({"picture": "none.png"}, "picture: expected an array or an existing file"),
    ({"picture": PICTURE, "camera": pv.Camera(), "key": 3}, "key: expected", TypeError),
    (
        {"picture": PICTURE, "camera": pv.Camera(), "key": ("gray", (0, 1))},
        "scalars: expected the array",
    ),
)


@pytest.mark.slow
@pytest.mark.opengl
def test_a_relief_with_cast_shadows_is_read():
    """Its record has an attached shadow, which needs no tangents."""
    ground = pv.ImageData(dimensions=(30, 24, 1))
    x, y, _ = ground.points.T
    ground["height"] = 2 * np.sin(x / 3) * np.cos(y / 4)
    scene = vizlight.Scene(lights=vizlight.Light(direction=(-1, 1, 1)))
    lit, eye = vizlight.relief_shadow(ground, scene, lit=True), View(direction=(1, -1, 1))
    assert "shape" in str(vizlight.legibility(lit.warp_by_scalar("height"), scene, view=eye))
