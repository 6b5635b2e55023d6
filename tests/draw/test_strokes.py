"""Lines of a diameter are as wide as the projection says, and the light across them is right."""

import numpy as np
import pytest
import pyvista as pv
from lamps import far, shiny
from vectors import unit
from vtkmodules.vtkCommonCore import reference
from vtkmodules.vtkRenderingCore import vtkMapper

import vizlight
from vizlight import Light, Material, Scene, View, render
from vizlight.draw import strokes

pytestmark = pytest.mark.opengl

WHITE = Scene(material=Material(ambient=1, diffuse=0, specular=0), view=View(direction=(0, 0, 1)))
DIAMETER = 0.1


def looking_down(*, parallel):
    camera = pv.Camera()
    camera.position, camera.focal_point, camera.up = (0, 0, 5), (0, 0, 0), (0, 1, 0)
    camera.view_angle, camera.parallel_scale = 30.0, 1.0
    camera.parallel_projection = parallel
    return camera


def shot(mesh, camera, **options):
    plotter = render.make_plotter(mesh, camera=camera, **options)
    return np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255


@pytest.mark.sampled(3)
@pytest.mark.parametrize("light", ["auto", "points"])
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("along", [(1, 0), (0, 1), (1, 1), (2, -1)])
def test_width_at_two_distances_is_that_of_the_projection(along, parallel, light):
    """To half a pixel: samples are a quarter of a pixel, on both sides."""
    way = unit([*along, 0])
    height, radius = 200, 60
    row, column = np.mgrid[:height, :400]
    near_middle = np.hypot(row - 99.5, column - 199.5) < radius
    for z in (0.0, -3.0):
        line = vizlight.illuminate(
            pv.Line((0, 0, z) - 4 * way, (0, 0, z) + 4 * way, resolution=7), WHITE
        )
        picture = shot(line, looking_down(parallel=parallel), size=(400, height),
                       line_diameter=DIAMETER, light=light)  # fmt: skip
        half = 1.0 if parallel else np.tan(np.radians(15)) * (5 - z)
        width = picture[near_middle].sum() / (2 * radius)
        assert width == pytest.approx(DIAMETER * height / 2 / half, abs=0.5)


def test_a_ring_has_no_gaps_where_its_segments_meet():
    """The area of a mitred ring is its perimeter times its width, here to 1 %."""
    turn = np.linspace(0, 2 * np.pi, 25)
    ring = pv.MultipleLines(0.6 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1))
    ring = vizlight.illuminate(ring, WHITE)
    camera = looking_down(parallel=True)
    picture = shot(ring, camera, size=(300, 300), line_diameter=0.4)
    area = picture.sum() * (2 / 300) ** 2
    assert area == pytest.approx(24 * 2 * 0.6 * np.sin(np.pi / 24) * 0.4, rel=0.01)


@pytest.mark.parametrize("seed", range(4))
def test_the_mean_across_a_line_is_the_light_of_its_cylinder(seed):
    """Means over the width are means over the visible half, weighted by projected width."""
    random = np.random.default_rng(seed)
    way, toward = unit(random.normal(size=(2, 3)) * [1, 1, 0.5])
    toward[2] = abs(toward[2])
    scene = far(toward, (0, 0, 1), shiny(specular=0.3, shininess=10))
    line = vizlight.illuminate(pv.Line(-9 * way, 9 * way, resolution=5), scene, model="cylinder")
    picture = shot(line, looking_down(parallel=True), size=(300, 300), line_diameter=0.8,
                   render_lines_as_tubes=True, anti_aliasing=None)  # fmt: skip
    drawn = picture[picture > 0]
    assert drawn.std() > 0.02
    assert drawn.mean() == pytest.approx(line["luminance"][0], abs=0.012)


def test_live_light_widens_lines_that_come_nearer():
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    line = pv.Line((-2, 0, 0), (2, 0, 0))
    scene = Scene(material=Material(ambient=1, diffuse=0, specular=0))
    plotter.vizlight.add_mesh(line, scene=scene, line_diameter=DIAMETER)
    widths = []
    for distance in (5, 2.5):
        plotter.camera = looking_down(parallel=False)
        plotter.camera.position = (0, 0, distance)
        plotter.reset_camera_clipping_range()
        plotter.render()
        picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255
        widths.append(picture[:, 50:150].sum() / 100)
    assert widths[1] == pytest.approx(2 * widths[0], rel=0.1)


def test_lines_with_light_at_their_points_are_bands():
    """There is no normal across them; the whole width has the light of the line."""
    pictures = []
    for tubes in (False, True):
        plotter = pv.Plotter(off_screen=True, window_size=(120, 120))
        plotter.background_color = "black"
        plotter.vizlight.add_mesh(
            pv.Line(), light="points", scene=WHITE, model="cylinder", line_diameter=DIAMETER,
            render_lines_as_tubes=tubes,
        )  # fmt: skip
        pictures.append(np.asarray(plotter.screenshot(return_img=True)))
    assert pictures[0].std() > 10
    np.testing.assert_array_equal(*pictures)


@pytest.mark.parametrize("option", [{"line_diameter": 0}, {"line_diameter": "wide"}])
def test_bad_input_names_the_option(option):
    line = vizlight.illuminate(pv.Line(), WHITE)
    with pytest.raises((TypeError, ValueError), match="line_diameter: expected"):
        render.make_plotter(line, **option)
    plotter = pv.Plotter(off_screen=True)
    with pytest.raises((TypeError, ValueError), match="line_diameter: expected"):
        plotter.vizlight.add_mesh(line, **option)


def crossing(distance, *, light, ground="white", halo=None, first=0):
    """Picture of a dark line along x that passes in front of one along y, 5 pixels wide each."""
    scene = Scene(material=Material(ambient=0.4, diffuse=0, specular=0))
    lines = [pv.Line((-1, 0, 0), (1, 0, 0)), pv.Line((0, -1, -distance), (0, 1, -distance))]
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = ground
    for line in (lines[first], lines[1 - first]):
        # One size, and so one depth of the halo, for both.
        line.points *= 1.5
        plotter.vizlight.add_mesh(line, scene=scene, line_width=5, halo=halo, light=light)
    plotter.camera = looking_down(parallel=True)
    plotter.reset_camera_clipping_range()
    return np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255


@pytest.mark.sampled(3)
@pytest.mark.parametrize("ground", ["white", "black"])
@pytest.mark.parametrize("light", ["fragments", "points"])
def test_the_line_behind_is_cut_beside_the_one_in_front(light, ground):
    pictures = [crossing(1.0, light=light, ground=ground, first=first) for first in (0, 1)]
    back = 1.0 if ground == "white" else 0.0
    for picture in pictures:
        # The halo is as wide as the line: rows 92 to 96 and 103 to 107 of the line behind.
        column, row = picture[:, 99], picture[99]
        assert np.all(column[[93, 95, 104, 106]] == back)
        assert column[[80, 120]] == pytest.approx(0.4, abs=0.02)
        assert row[[85, 93, 95, 104, 106, 115]] == pytest.approx(0.4, abs=0.02)
    np.testing.assert_array_equal(*pictures)


def test_lines_that_touch_have_no_gap_and_a_halo_can_be_left_out():
    """The gap grows with the distance, up to the width of the halo."""
    gaps = [
        int(np.sum(crossing(distance, light="fragments")[60:140, 99] > 0.9))
        for distance in (0.0, 0.05, 0.1, 0.5)
    ]
    assert gaps[0] == 0
    assert gaps == sorted(gaps)
    assert 0 < gaps[1] < gaps[2] < gaps[3] <= 10
    assert np.all(crossing(0.5, light="fragments", halo=False)[60:140, 99] < 0.9)


@pytest.mark.parametrize("size", [1, 50])
def test_the_gap_of_a_halo_follows_the_width_of_the_line_and_not_the_size_of_the_mesh(size):
    """A coil close to its core has gaps, however long both are: 6 widths behind the whole of it."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    for mesh in (pv.Line((-1, 0, 0), (1, 0, 0)), pv.Line((0, -size, -0.3), (0, size, -0.3))):
        plotter.vizlight.add_mesh(mesh, scene=WHITE, line_width=5)
    plotter.camera = looking_down(parallel=True)
    plotter.reset_camera_clipping_range()
    column = np.asarray(plotter.screenshot(return_img=True))[:, 99, 0]
    # The halo ends in the middle of rows 92 and 107, as the line does in those of 97 and 102.
    assert np.flatnonzero(column[80:120] == 0).tolist() == [13, 14, 15, 16, 23, 24, 25, 26]


@pytest.mark.parametrize("light", ["fragments", "points"])
def test_a_line_as_light_as_its_ground_has_a_darker_rim(light):
    """Where its contrast with a light ground is 0.4 or more, and on black, it is as it was."""
    pictures = {}
    for ground, bright in (("white", 1.0), ("white", 0.55), ("black", 1.0)):
        scene = Scene(material=Material(ambient=bright, diffuse=0, specular=0))
        plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
        plotter.background_color = ground
        plotter.vizlight.add_mesh(pv.Line(), scene=scene, line_width=10, light=light)
        plotter.camera = looking_down(parallel=True)
        plotter.reset_camera_clipping_range()
        column = np.asarray(plotter.screenshot(return_img=True))[:, 50, 0] / 255
        pictures[ground, bright] = column[45:55]
    assert pictures["white", 1.0][4:6] == pytest.approx(1.0, abs=0.01)
    assert pictures["white", 1.0][[0, -1]].max() < 0.6
    assert pictures["white", 0.55] == pytest.approx(0.55, abs=0.02)
    assert pictures["black", 1.0] == pytest.approx(1.0, abs=0.01)


def test_colours_of_data_have_no_darker_rim():
    line = pv.Line()
    line["v"] = [0.0, 1.0]
    plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
    plotter.background_color = "white"
    scene = Scene(material=Material(ambient=1, diffuse=0, specular=0))
    plotter.vizlight.add_mesh(line, scene=scene, scalars="v", cmap=["yellow"], line_width=10)
    plotter.camera = looking_down(parallel=True)
    plotter.reset_camera_clipping_range()
    column = np.asarray(plotter.screenshot(return_img=True))[45:55, 50]
    assert np.abs(column.astype(int) - (255, 255, 0)).max() <= 3


@pytest.mark.parametrize("parallel", [False, True])
def test_lines_on_a_steep_surface_are_whole(parallel):
    """Half of each line is behind the surface where it is not drawn nearer to the eye."""
    slope = np.tan(np.radians(50))
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    plane = pv.Plane(i_size=4, j_size=4, i_resolution=1, j_resolution=1)
    plane.points[:, 2] = slope * plane.points[:, 1]
    plotter.add_mesh(plane, color="black", lighting=False)
    plotter.vizlight.add_mesh(pv.Line((-2, 0, 0), (2, 0, 0)), scene=WHITE, line_width=6)
    plotter.camera = looking_down(parallel=parallel)
    plotter.reset_camera_clipping_range()
    picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, 50:150, 0] / 255
    assert picture.sum(axis=0) == pytest.approx(6, abs=0.3)


@pytest.mark.parametrize("light", ["fragments", "points"])
def test_ends_and_sharp_bends_are_round(light):
    """Areas, to half a percent: a capsule, and two of them that have a disc in common."""
    width, length = 20.0, 60.0
    half = length / 100
    bent = pv.MultipleLines([(-half, 0, 0), (0, 0, 0), (0, -half, 0)])
    straight = pv.MultipleLines([(0, half / 2, 0), (0, -half / 2, 0)])
    disc = np.pi * width**2 / 4
    # What two capsules at a right angle share: the disc, and a quarter of it filled to a square.
    shared = 3 / 4 * disc + width**2 / 4
    for line, area in (
        (straight, length * width + disc),
        (bent, 2 * length * width + 2 * disc - shared),
    ):
        plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
        plotter.background_color = "black"
        plotter.vizlight.add_mesh(line, scene=WHITE, line_width=width, halo=0.3, light=light)
        plotter.camera = looking_down(parallel=True)
        plotter.reset_camera_clipping_range()
        picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255
        assert picture.sum() == pytest.approx(area, rel=0.005)


def test_ends_are_told_by_the_length_of_directions_and_closed_lines_have_none():
    turn = np.linspace(0, 2 * np.pi, 13)
    ring = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    ring[-1] = ring[0]
    lines = pv.MultipleLines(ring).merge(pv.Line(resolution=3))
    lengths = np.linalg.norm(strokes.directions(lines), axis=1)
    np.testing.assert_allclose(lengths, [*[1] * 12, 2, 1, 1, 2])


def test_translucent_lines_have_no_halo_unless_it_is_asked_for():
    line, pictures = pv.Line((-1, 0, 0), (1, 0, 0)), []
    for halo in (None, False, 2.0):
        plotter = pv.Plotter(off_screen=True, window_size=(100, 100))
        plotter.background_color = "black"
        plotter.add_mesh(
            pv.Plane(center=(0, 0, -1), i_size=9, j_size=9), color="red", lighting=False
        )
        plotter.vizlight.add_mesh(line, scene=WHITE, line_width=5, opacity=0.5, halo=halo)
        plotter.camera = looking_down(parallel=True)
        plotter.reset_camera_clipping_range()
        pictures.append(np.asarray(plotter.screenshot(return_img=True)))
    np.testing.assert_array_equal(pictures[0], pictures[1])
    assert np.any(pictures[2] != pictures[1])


@pytest.mark.parametrize("light", ["fragments", "points"])
def test_a_halo_in_a_colour_is_narrower(light):
    column = crossing(1.0, light=light, ground="white", halo="black")[:, 99]
    # 0.45 of 5 pixels on each side of rows 97 to 102.
    assert column[[96, 103]] == pytest.approx(0, abs=0.02)
    assert column[[80, 93, 106, 120]] == pytest.approx(0.4, abs=0.02)


def lit_in_fragments(actor):
    """Return whether the shader of fragments of an actor computes light."""
    shader = actor.GetShaderProperty()
    for i in range(shader.GetNumberOfShaderReplacements()):
        mark, text, first, every = reference(""), reference(""), reference(0), reference(0)
        shader.GetNthShaderReplacement(i, mark, first, text, every)
        if "Fragment" in shader.GetNthShaderReplacementTypeAsString(i) and "vizLight0" in text:
            return True
    return False


def turning(degrees):
    """Return a line of segments that turn by an angle, with an array and tangents."""
    turns = np.radians(np.arange(0, 540, degrees))
    points = (1.2 - 0.2 * turns / np.pi) * np.array([np.cos(turns), np.sin(turns), turns / 9])
    line = pv.lines_from_points(points.T)
    line["height"] = line.points[:, 1] - 0.2 * line.points[:, 0]
    line["course"] = unit(np.gradient(line.points, axis=0))
    return line


def shown(line, lights, *, parallel, **options):
    """Return the picture of a line with a halo, and whether its light is in fragments."""
    plotter = pv.Plotter(off_screen=True, window_size=(300, 300))
    scene = Scene(lights=lights, material=shiny(specular=0.0))
    actor = plotter.vizlight.add_mesh(
        line, scene=scene, line_width=7, show_scalar_bar=False, **options
    )
    plotter.camera = looking_down(parallel=parallel)
    plotter.reset_camera_clipping_range()
    picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)
    return picture, lit_in_fragments(actor)


LAMPS = [Light(direction=(1, 0.4, 0.6)), Light.headlight(intensity=0.4)]


@pytest.mark.sampled(2)
@pytest.mark.parametrize("option", [{}, {"scalars": "height"}, {"tangents": "course"}])
@pytest.mark.parametrize("parallel", [False, True])
def test_light_at_three_places_of_segments_is_that_in_each_fragment(option, parallel):
    """A lamp at a place, which has it in each fragment, is too weak to show."""
    weak = Light(position=(9, 9, 9), intensity=1e-9)
    three, in_fragments = shown(turning(15), LAMPS, parallel=parallel, **option)
    assert not in_fragments
    each, in_fragments = shown(turning(15), [*LAMPS, weak], parallel=parallel, **option)
    assert in_fragments
    assert np.min(np.ptp(three, axis=(0, 1))) > 100
    assert np.percentile(np.abs(three - each), 99.99) <= 2


def test_highlights_of_lines_with_halos_are_in_each_fragment():
    scene = Scene(material=shiny(specular=0.5))
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.vizlight.add_mesh(turning(15), scene=scene, halo=1.0)
    plotter.show(auto_close=False)
    assert lit_in_fragments(actor)
    assert plotter.vizlight.explain(actor).startswith("light in each fragment")
    plotter.vizlight.set_scene(actor, Scene())
    plotter.render()
    assert not lit_in_fragments(actor)
    assert plotter.vizlight.explain(actor).startswith("light at three places of each segment")


def test_points_without_a_direction_have_the_colour_of_missing_data():
    """Their segments are lit in each fragment: a parabola would reach far from them."""
    lines = turning(15)
    lines["course"][5:8] = 0.0
    plotter = pv.Plotter(off_screen=True)
    with pytest.warns(UserWarning, match="3 of"):
        actor = plotter.vizlight.add_mesh(lines, scene=Scene(), tangents="course", halo=1.0)
    plotter.show(auto_close=False)
    assert lit_in_fragments(actor)


@pytest.mark.parametrize("halo", [-1, "wide", np.nan])
def test_a_halo_is_a_width_or_a_colour(halo):
    plotter = pv.Plotter(off_screen=True)
    with pytest.raises((TypeError, ValueError), match="halo: expected"):
        plotter.vizlight.add_mesh(pv.Line(), scene=WHITE, halo=halo)


@pytest.mark.parametrize("light", ["auto", "points"])
def test_pictures_have_halos_where_they_are_asked_for(light):
    scene = Scene(material=Material(ambient=0.4, diffuse=0, specular=0), view=WHITE.view)
    back, front = pv.Line((0, -1, -1), (0, 1, -1)), pv.Line((-1, 0, 0), (1, 0, 0))
    lines = [vizlight.illuminate(line, scene) for line in (front, back)]
    columns = []
    for halo in (False, True):
        picture = shot(
            pv.MultiBlock(lines), looking_down(parallel=True), size=(200, 200), line_width=5,
            halo=halo, light=light, background="white",
        )  # fmt: skip
        columns.append(picture[[80, 93, 95, 104, 106, 120], 99])
    assert columns[0] == pytest.approx(0.4, abs=0.02)
    assert columns[1] == pytest.approx([0.4, 1, 1, 1, 1, 0.4], abs=0.02)


def drawn(line, *, ssaa=False, camera=None, **options):
    """Picture of white lines on black, 200 pixels wide and high for 2 units."""
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    if ssaa:
        plotter.enable_anti_aliasing("ssaa")
    plotter.vizlight.add_mesh(line, scene=WHITE, **options)
    plotter.camera = looking_down(parallel=True) if camera is None else camera
    plotter.reset_camera_clipping_range()
    return np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255


@pytest.mark.parametrize("light", ["fragments", "points"])
@pytest.mark.parametrize("halo", [None, False])
def test_widths_hold_under_supersampling(light, halo):
    picture = drawn(pv.Line((-2, 0, 0), (2, 0, 0)), ssaa=True, line_width=6, light=light, halo=halo)
    width = picture[:, 50:150].sum(axis=0)
    assert width == pytest.approx(6, abs=0.3)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("light", ["fragments", "points"])
@pytest.mark.parametrize("halo", [None, False, 1.0])
@pytest.mark.parametrize("option", [{"line_width": 20}, {"line_diameter": 0.2}])
def test_lines_have_the_widths_of_their_points(light, halo, option):
    line = pv.Line((-1.5, 0, 0), (1.5, 0, 0), resolution=3)
    line["share"] = [0.0, 0.25, 0.75, np.nan]
    picture = drawn(line, width="share", light=light, halo=halo, **option)
    widths = picture.sum(axis=0)[[5, 25, 50, 75, 100, 125, 150, 175, 195]]
    shares = np.interp(np.array([5, 25, 50, 75, 100, 125, 150, 175, 195]) / 100 - 0.995,
                       line.points[:, 0], [0, 0.25, 0.75, 0])  # fmt: skip
    assert widths == pytest.approx(20 * shares, abs=0.8)


def test_widths_of_lines_that_are_lit_by_normals_are_drawn_with_light_at_the_points():
    line = pv.Line((-2, 0, 0), (2, 0, 0), resolution=2)
    line["share"], line["Normals"] = [0.5, 0.5, 0.5], np.tile([0.0, 0.0, 1.0], (3, 1))
    picture = drawn(line, width="share", normals="Normals", conditioned=True, line_width=8)
    assert picture[:, 50:150].sum(axis=0) == pytest.approx(4, abs=0.2)


@pytest.mark.parametrize("name", ["missing", "vectors", 3])
def test_widths_are_one_number_per_point(name):
    line = pv.Line()
    line["vectors"] = line.points
    with pytest.raises((TypeError, ValueError), match="width: expected"):
        drawn(line, width=name)


def test_lines_that_pass_the_eye_are_cut_at_the_near_plane():
    """A segment from before the eye to behind it runs to the border of the picture, not across."""
    camera = looking_down(parallel=False)
    line = pv.Line((0.3, 0, -5), (0.3, 0, 15), resolution=1)
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.background_color = "black"
    plotter.vizlight.add_mesh(line, scene=WHITE, line_width=4)
    plotter.camera = camera
    plotter.camera.clipping_range = (0.1, 100)
    picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)[:, :, 0] / 255
    assert np.all(picture[:, :105] == 0)
    assert picture[:, 130:195].sum(axis=0) == pytest.approx(4, abs=0.3)


def test_plain_lines_are_whole_on_the_surface_that_they_lie_on():
    """The switch of VTK for that, which is one for a process, is as before after a frame."""
    before = vtkMapper.GetResolveCoincidentTopology()
    plane = pv.Plane(i_resolution=8, j_resolution=8)
    dark = []
    for opacity in (1.0, 0.0):
        plotter = render.canvas((200, 200))
        plotter.add_mesh(plane, color="white", lighting=False, opacity=opacity)
        plotter.add_mesh(plane.extract_all_edges(), color="black", lighting=False, line_width=3)
        plotter.camera = render.camera_on(plane, (0.3, 0.4, 1.0))
        front = np.asarray(plotter.screenshot(return_img=True), dtype=float)
        dark.append((255 - front).sum())
        assert vtkMapper.GetResolveCoincidentTopology() == before
    assert dark[0] > 0.95 * dark[1]


@pytest.mark.parametrize("lighting", [True, False])
def test_points_are_as_large_as_asked(lighting):
    plotter = render.canvas((60, 60))
    point = pv.PolyData(np.zeros((1, 3)))
    plotter.vizlight.add_mesh(point, color="black", point_size=20, lighting=lighting)
    picture = np.asarray(plotter.screenshot(return_img=True), dtype=float)
    # A square, or a disc where the driver rounds points.
    assert 0.95 * np.pi * 100 < (1 - picture[:, :, 0] / 255).sum() < 410


def test_colours_that_hide_nearly_all_are_opaque():
    """VTK would draw the far side of the ball over its near side."""
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    ball["RGBA"] = np.full((ball.n_points, 4), 254, np.uint8)
    ball["glass"] = np.full((ball.n_points, 4), 100, np.uint8)
    plotter = render.canvas((60, 60))
    opaque, glass = (plotter.vizlight.add_mesh(ball, scalars=name) for name in ("RGBA", "glass"))
    assert opaque.GetForceOpaque()
    assert not glass.GetForceOpaque()
