"""The comparison of pictures sees wrong light and is blind to how edges are drawn."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image, ImageDraw

import vizlight
from vizlight import Light, Material, Scene, View, render, testing


def lines(grey=200, shift=0.0, width=1, scale=1):
    """Draw thin grey lines on black, once as they are or from a larger picture."""
    image = Image.new("L", (300 * scale, 200 * scale))
    draw = ImageDraw.Draw(image)
    for i in range(40):
        ends = [(7.3 * i + shift, 3), (300 - 7.1 * i + shift, 195)]
        draw.line([(x * scale, y * scale) for x, y in ends], fill=round(grey), width=width * scale)
    image = image.resize((300, 200), Image.Resampling.BOX)
    return np.repeat(np.asarray(image)[..., np.newaxis], 3, axis=2)


def disc(moved=0.0, radius=70.0, bright=200.0):
    y, x = np.mgrid[:200, :300]
    shade = bright * np.exp(-((x - 130 - moved) ** 2 + (y - 80) ** 2) / 1500)
    inside = np.clip(radius + 0.5 - np.hypot(x - 150, y - 100), 0, 1)
    grey = inside * (40 + shade) + (1 - inside) * 255
    return np.repeat(np.clip(grey, 0, 255).astype(np.uint8)[..., np.newaxis], 3, axis=2)


def test_the_same_picture_passes_and_measures_nothing():
    assert testing.assert_same_picture(lines(), lines()) == testing.Difference(0, 0, 0)


@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_thin_lines_5_percent_off_fail(factor):
    with pytest.raises(AssertionError, match=r"brightness 0\.05"):
        testing.assert_same_picture(lines(200 * factor), lines())


@pytest.mark.sampled(2)
@pytest.mark.opengl
@pytest.mark.parametrize("background", ["white", "black", "gray"])
@pytest.mark.parametrize("factor", [0.95, 1.05])
def test_a_surface_5_percent_off_fails_on_any_background(factor, background):
    ball = pv.Sphere()
    pictures = []
    for bright in (1.0, factor):
        material = Material(ambient=0.1 * bright, diffuse=0.5 * bright, specular=0)
        lit = vizlight.illuminate(
            ball, Scene(lights=Light(direction=(1, -1, 1)), material=material)
        )
        plotter = render.make_plotter(lit, size=(300, 300), background=background)
        pictures.append(plotter.screenshot(return_img=True))
    with pytest.raises(AssertionError, match=r"brightness 0\.0[456]"):
        testing.assert_same_picture(pictures[1], pictures[0])


def test_thin_lines_a_third_of_a_pixel_away_pass():
    testing.assert_same_picture(lines(scale=8, shift=0.33), lines(scale=8))


@pytest.mark.parametrize("options", [{"moved": 8}, {"bright": 185}, {"radius": 78}])
def test_a_moved_or_dimmer_highlight_or_another_outline_fails(options):
    with pytest.raises(AssertionError, match="at most"):
        testing.assert_same_picture(disc(**options), disc())


def test_one_grey_level_below_0_does_not_wrap_around():
    """In unsigned bytes 9 - 10 is 255."""
    dark, less = (np.full((50, 60, 3), grey, dtype=np.uint8) for grey in (10, 9))
    dark[10:40, 10:40] = less[10:40, 10:40] = 200
    found = testing.difference(less, dark, background=(0, 0, 0))
    assert found.block == pytest.approx(1)
    assert found.pixels == 0
    assert found.brightness < 0.02


def test_nothing_drawn_fails_and_nothing_expected_passes():
    empty = np.zeros((200, 300, 3), dtype=np.uint8)
    with pytest.raises(AssertionError, match="brightness 1"):
        testing.assert_same_picture(empty, lines())
    testing.assert_same_picture(empty, empty)
    with pytest.raises(AssertionError, match="brightness"):
        testing.assert_same_picture(lines(), empty)


def test_a_failure_leaves_got_expected_and_difference(tmp_path):
    Image.fromarray(lines()).save(tmp_path / "a.png")
    with pytest.raises(AssertionError, match=r"^a: brightness .*see .*a-\*\.png"):
        testing.assert_same_picture(lines(220), tmp_path / "a.png", failed=tmp_path / "failed")
    kept = {p.name: np.asarray(Image.open(p)) for p in (tmp_path / "failed").iterdir()}
    assert set(kept) == {"a-got.png", "a-expected.png", "a-difference.png"}
    np.testing.assert_array_equal(kept["a-got.png"], lines(220))
    assert kept["a-difference.png"].max() == 12 * 20


def test_a_missing_picture_fails_unless_it_may_be_added(tmp_path):
    path = tmp_path / "new.png"
    with pytest.raises(AssertionError, match="add_missing=True"):
        testing.assert_same_picture(lines(), path)
    testing.assert_same_picture(lines(), path, add_missing=True)
    testing.assert_same_picture(lines(), str(path))


@pytest.mark.parametrize("bad", [np.zeros((3, 3)), np.zeros((3, 3, 3)), 7, None])
def test_what_is_not_a_picture(bad):
    with pytest.raises(TypeError, match="got: expected a plotter, a path or bytes"):
        testing.difference(bad, lines())


def test_a_file_that_is_no_picture(tmp_path):
    (tmp_path / "a.png").write_text("no")
    with pytest.raises(ValueError, match="expected: expected a picture"):
        testing.difference(lines(), tmp_path / "a.png")
    with pytest.raises(ValueError, match="brightness"):
        testing.assert_same_picture(lines(), lines(), brightness=-1)
    with pytest.raises(ValueError, match="background"):
        testing.difference(lines(), lines(), background="no colour")


@pytest.mark.opengl
def test_two_drivers_and_two_kinds_of_smooth_edges_pass():
    """EGL and OSMesa, and edges of several samples and of a larger picture."""
    other = "osmesa" if render.probe("osmesa").works else "egl"
    expected, got = ball("egl", "msaa"), [ball(other, "msaa"), ball("egl", "ssaa")]
    for picture in got:
        testing.assert_same_picture(picture, expected)


@pytest.mark.opengl
def test_a_lamp_5_degrees_elsewhere_fails():
    with pytest.raises(AssertionError, match="^picture: block 4[.]88, at most"):
        testing.assert_same_picture(ball("egl", "msaa", turned=5), ball("egl", "msaa"))


@pytest.mark.sampled(3)
@pytest.mark.opengl
@pytest.mark.parametrize("draw", ["pyvista", "vizlight"])
@pytest.mark.parametrize("size", [(300, 200), (600, 400)])
def test_a_highlight_of_another_strength_on_thin_tubes_fails(draw, size):
    """A specular coefficient of 0.35 in place of 0.2: highlights that are two pixels wide."""
    weak, strong, again = (tubes(draw, size, specular) for specular in (0.2, 0.35, 0.2))
    testing.assert_same_picture(again, weak)
    with pytest.raises(AssertionError, match="^picture: pixels 0[.]0[^;]* at most 0.006$"):
        testing.assert_same_picture(strong, weak, background="white")


def ball(backend, smooth, turned=0.0):
    """Draw a sphere by a driver, with a lamp that is turned by some degrees about the axis z."""
    mesh = pv.Sphere(radius=1, theta_resolution=72, phi_resolution=72)
    mesh["Normals"] = np.array(mesh.points)
    toward = pv.Transform().rotate_z(turned).apply_to_points([[1, 0.9, 0.5]])[0]
    material = Material(ambient=0.1, diffuse=0.5, specular=0.2)
    camera = render.camera_on(mesh.bounds, (1, 0.5, 0.45))
    scene = Scene(lights=Light(direction=toward), view=View.from_camera(camera), material=material)
    lit = vizlight.illuminate(mesh, scene)
    options = {"backend": backend, "anti_aliasing": smooth, "background": "white"}
    plotter = render.make_plotter(lit, camera=camera, size=(300, 200), **options)
    return plotter.screenshot(return_img=True)


def tubes(draw, size, specular):
    """Draw tubes with PyVista's light or vizlight's."""
    chance = np.random.default_rng(2)
    paths = [chance.normal(size=(6, 3)).cumsum(axis=0) for _ in range(12)]
    mesh = pv.merge([pv.Spline(path, 200).tube(radius=0.12, n_sides=24) for path in paths])
    camera = render.camera_on(mesh.bounds, (1, 0.5, 0.45))
    plotter = pv.Plotter(off_screen=True, window_size=size, lighting="none")
    plotter.background_color, plotter.camera = "white", camera
    plotter.enable_anti_aliasing("msaa")
    kinds = {"ambient": 0.1, "diffuse": 0.5, "specular": specular}
    if draw == "vizlight":
        scene = Scene(
            lights=Light(direction=(1, 0.9, 0.5)),
            view=View.from_camera(camera),
            material=Material(**kinds),
        )
        plotter.vizlight.add_mesh(mesh, scene=scene)
    else:
        plotter.add_light(pv.Light(light_type="scene light", position=(10, 9, 5)))
        plotter.add_mesh(mesh, color="white", specular_power=20, smooth_shading=True, **kinds)
    return plotter.screenshot(return_img=True)


@pytest.mark.opengl
def test_a_closed_plotter_has_no_picture():
    plotter = render.make_plotter(vizlight.illuminate(pv.Line()))
    plotter.close()
    with pytest.raises(ValueError, match="an open plotter"):
        testing.assert_same_picture(plotter, lines())
