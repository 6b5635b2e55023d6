"""What a plotter shows is read where its actors have placed it."""

import numpy as np
import pytest
import pyvista as pv
from PIL import Image
from sheets import DIRECTION, FLAT, HOW, SHAPE, arrows, from_above, plotter_of, sheet
from vtkmodules.vtkRenderingCore import vtkActor, vtkGlyph3DMapper
from vtkmodules.vtkRenderingLICOpenGL2 import vtkSurfaceLICMapper

import vizlight
from vizlight.draw.cameras import camera_on
from vizlight.observers.samples import moved
from vizlight.observers.whole import read_picture, reading, shown_by
from vizlight.shading.options import LightOptions

pytestmark = pytest.mark.opengl

#: A turn about z, a scale and a step.
MATRIX = np.array([[0.8, -0.9, 0, 3], [0.6, 1.2, 0, 1], [0, 0, 1.3, 0], [0, 0, 0, 1]])


@pytest.mark.sampled(3)
@pytest.mark.parametrize(
    ("question", "how"),
    [("direction", DIRECTION), ("shape", SHAPE), ("value", {"scene": FLAT, "scalars": "height"})],
)
def test_a_moved_actor_is_read_like_a_moved_mesh(question, how):
    mesh = sheet()
    there, options = moved(mesh, LightOptions(tangents="swirl"), MATRIX)
    there["swirl"] = options.tangents
    figures = []
    for shown in (mesh, there):
        plotter, actor = plotter_of(shown, **how)
        if shown is mesh:
            actor.user_matrix = MATRIX
        plotter.camera = camera_on(there, (0.1, 0.05, 1), up=(0, 1, 0), aspect=1.5)
        figures.append(getattr(plotter.vizlight.legibility(**HOW), question))
    assert figures[0].bits > 1
    assert figures[0].bits == pytest.approx(figures[1].bits, abs=0.08)
    assert figures[0].median == pytest.approx(figures[1].median, rel=0.1)


def test_values_without_light_are_left_out():
    mesh = sheet()
    mesh["swirl"][np.asarray(mesh.points)[:, 0] < 0] = 0
    with pytest.warns(UserWarning, match="could not be lit"):
        plotter, _ = plotter_of(mesh, **DIRECTION, scalars="height", show_scalar_bar=False)
    found = plotter.vizlight.legibility(**HOW)
    assert found.value.samples == pytest.approx(HOW["samples"] / 2, rel=0.1)
    assert any("have no value" in note for note in found.notes)


def test_colours_that_were_lit_before_are_read_by_their_record():
    mesh = sheet()
    lit = vizlight.illuminate(mesh, FLAT)
    shown = vizlight.tint(lit, "height", cmap="viridis")
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.add_mesh(shown, scalars="rgb", rgb=True, lighting=False)
    plotter.camera = from_above(mesh)
    read = plotter.vizlight.legibility(**HOW).value
    assert read.median < 0.03
    assert read.samples == HOW["samples"]


def test_position_and_scale_of_plain_colors_are_read():
    mesh = sheet()
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    how = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
    actor = plotter.add_mesh(mesh, scalars="height", **how)
    actor.position, actor.scale = (5, 0, 0), (2, 1, 1)
    plotter.camera = camera_on(actor.bounds, (0, 0, 1), aspect=1.5)
    found = plotter.vizlight.legibility(**HOW).value
    assert found.median < 0.03


def test_normals_stay_across_a_scaled_surface():
    mesh = sheet()
    given = mesh.compute_normals(cell_normals=False).point_data["Normals"]
    there, options = moved(mesh, LightOptions(normals=np.asarray(given)), MATRIX)
    own = there.compute_normals(cell_normals=False).point_data["Normals"]
    rows = options.normals / np.linalg.norm(options.normals, axis=1, keepdims=True)
    inner = np.abs(np.asarray(mesh.points)[:, :2]).max(axis=1) < 0.9
    assert np.abs(np.einsum("ij,ij->i", rows, own))[inner].min() > 0.999
    assert np.array_equal(mesh.points, sheet().points)


def test_values_of_a_mesh_in_4_space_are_read():
    mesh = sheet()
    mesh["place"] = np.insert(np.asarray(mesh.points, np.float64), 3, mesh["speed"], axis=1)
    mesh["along"] = np.insert(mesh["swirl"], 3, 0.0, axis=1)
    how = {"positions": "place", "tangents": "along", "scalars": "height", "cmap": "coolwarm"}
    plotter, _ = plotter_of(mesh, show_scalar_bar=False, **how)
    found = plotter.vizlight.legibility(**HOW)
    assert found.value.median < 0.04
    assert found.direction is None


def test_a_direction_up_near_the_line_of_sight_turns_no_answer():
    medians = []
    for up in ((0, 1, 0), (0, 0, 1)):
        plotter, _ = plotter_of(sheet(), **DIRECTION)
        plotter.camera = camera_on(sheet(), (0.1, 0.05, 1), up=up, aspect=1.5)
        medians.append(plotter.vizlight.legibility(**HOW).direction.median)
    assert max(medians) < 6


def test_pictures_are_read_upright_and_without_their_opacity(tmp_path):
    picture = np.random.default_rng(0).integers(0, 256, (9, 12, 4), dtype=np.uint8)
    Image.fromarray(picture[..., :3]).save(tmp_path / "picture.png")
    expected = picture[..., :3] / 255
    for given in (picture, picture / 255, expected, tmp_path / "picture.png"):
        np.testing.assert_allclose(read_picture(given), expected)
    assert read_picture(np.zeros((8, 8, 3))).shape == (8, 8, 3)
    for given in (picture[..., :2], picture[..., 0], picture[:7], picture[:, :7]):
        with pytest.raises(ValueError, match="picture: expected"):
            read_picture(given)


def test_values_beyond_a_picture_are_rounding_or_named():
    gray = np.full((9, 9, 3), 0.5)
    gray[0, 0, 0], gray[1, 1, 1] = 1 + 2e-10, -1e-5
    read = read_picture(gray)
    assert (read.min(), read.max()) == (0, 1)
    np.testing.assert_array_equal(read, np.clip(gray, 0, 1))
    words_of = {
        1.0001: "from -1e-05 to 1.0001; clip", -2e-5: "from -2e-05 to 1", np.nan: "not finite",
        np.inf: "not finite", 200.0: "to 200",
    }  # fmt: skip
    for value, words in words_of.items():
        gray[2, 2, 2] = value
        with pytest.raises(ValueError, match=f"picture: expected bytes.* {words}"):
            read_picture(gray)


@pytest.mark.parametrize(
    ("given", "expected"),
    [((None, None, None), (85, 400)), ((50, None, None), (50, 400)), ((None, 250, None), (85, 250)),
     ((None, None, 96), (254, 600)), ((None, 500, 96), (254, 500))],
)  # fmt: skip
def test_a_picture_has_the_size_of_a_column_or_of_a_screen(given, expected):
    found = reading(960, *given, 2.3, 10, 3)
    assert (found["size_mm"], found["distance_mm"]) == pytest.approx(expected)
    assert (found["noise"], found["samples"], found["seed"]) == (2.3, 10, 3)


def test_the_active_part_of_a_window_is_read_alone():
    plotter = pv.Plotter(off_screen=True, shape=(2, 2), window_size=(240, 160), border=False)
    plotter.add_mesh(pv.Plane(), color="black")
    for row, column in ((1, 0), (0, 1)):
        plotter.subplot(row, column)
        how = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
        plotter.add_mesh(sheet(30), scalars="height", **how)
        plotter.camera = camera_on(sheet(30), (0, 0, 1), aspect=1.5)
        found = plotter.vizlight.legibility(size_mm=20, samples=256)
        assert found.size == (120, 80)
        assert found.value.median < 0.03
        assert (found.size_mm, found.noise, found.seed) == (20, 2.3, 0)


def test_a_plotter_without_a_camera_is_read_from_where_pyvista_shows_it():
    figures = []
    for placed in (False, True):
        plotter, _ = plotter_of(sheet(30), **SHAPE)
        plotter.camera_set = False
        if placed:
            plotter.view_isometric(render=False)
        figures.append(plotter.vizlight.legibility(**HOW))
    assert figures[0] == figures[1]
    assert figures[0].toward_eye == pytest.approx([3**-0.5] * 3)


def test_what_hides_a_mesh_and_what_is_nearly_clear():
    flat = {"cmap": "coolwarm", "lighting": False, "show_scalar_bar": False}
    pixels = []
    for opacity in (0.4, 0.6, 0.0):
        plotter = pv.Plotter(off_screen=True, window_size=(120, 80))
        plotter.add_mesh(sheet(20), scalars="height", **flat)
        front = plotter.add_mesh(pv.Plane(center=(0.5, 0, 1), j_size=2), opacity=opacity or 1.0)
        front.SetVisibility(opacity > 0)
        plotter.camera = camera_on(sheet(20), (0, 0, 1), aspect=1.5, parallel=True)
        pixels.append(plotter.vizlight.legibility(size_mm=20, samples=64).pixels)
    assert pixels[0] == pixels[2]
    assert pixels[1] == pytest.approx(pixels[0] / 2, rel=0.03)


def test_walls_without_their_near_sides_hide_nothing():
    mesh = sheet()
    box = pv.Cube(center=mesh.center, x_length=9, y_length=9, z_length=3)
    plotter, _ = plotter_of(mesh, **DIRECTION)
    plotter.camera = from_above(mesh)
    bare = plotter.vizlight.legibility(**HOW).pixels
    walls = plotter.add_mesh(box, culling="front", lighting=False, pickable=False)
    assert plotter.vizlight.legibility(**HOW).pixels == bare
    walls.prop.BackfaceCullingOn()
    walls.prop.FrontfaceCullingOff()
    with pytest.raises(ValueError, match="a point that the eye sees"):
        plotter.vizlight.legibility(**HOW)


def test_strokes_are_read_where_they_are_as_wide_as_they_are_drawn():
    line = pv.MultipleLines([[x, 0, 0] for x in np.linspace(-1, 1, 41)])
    line["width"] = np.linspace(0.1, 1, 41)
    plotter = pv.Plotter(off_screen=True, window_size=(400, 100), lighting="none")
    plotter.vizlight.add_mesh(
        line,
        scene=FLAT,
        color="black",
        width="width",
        line_width=24,
        halo=False,
        show_scalar_bar=False,
    )
    plotter.background_color = "white"
    plotter.camera = camera_on(line, (0, 0, 1), up=(0, 1, 0), aspect=4)
    read = plotter.vizlight.legibility(**HOW)
    dark = np.asarray(plotter.screenshot(return_img=True))[..., 0] < 128
    assert read.pixels == pytest.approx(dark.sum(), rel=0.15)


def test_speeds_are_told_by_the_bar_of_lines_whose_tangents_have_one_length():
    grid = pv.ImageData(dimensions=(21, 21, 3), origin=(-1, -1, 0), spacing=(0.1, 0.1, 0.1))
    x, y, z = np.asarray(grid.points).T
    grid["v"] = np.column_stack([1.1 + y, 0 * x, 0 * z])
    lines = vizlight.streamlines(grid, tangents="v", spacing=0.15)
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240), lighting="none")
    # This map rises and falls in lightness.
    plotter.vizlight.add_mesh(
        lines, scene=FLAT, scalars="speed", cmap="turbo", line_width=6, show_scalar_bar=False
    )
    plotter.camera = from_above(grid)
    read = plotter.vizlight.legibility(**HOW)
    assert read.speed.spearman > 0.85


def test_a_point_hides_as_much_as_it_covers():
    plotter, _ = plotter_of(sheet(20), **SHAPE)
    bare = plotter.vizlight.legibility(samples=16).pixels
    plotter.add_mesh(pv.PolyData([0.0, 0, 1]), color="black", point_size=20)
    hidden = bare - plotter.vizlight.legibility(samples=16).pixels
    assert hidden == pytest.approx(400, rel=0.1)


def read_plain(mesh, way=(0, 0, 1), **drawing):
    """Return what is read of a mesh in PyVista's plain colours, seen along a direction."""
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.add_mesh(mesh, lighting=False, show_scalar_bar=False, **drawing)
    plotter.camera = camera_on(mesh, way, aspect=1.5)
    return plotter.vizlight.legibility(**HOW)


@pytest.mark.parametrize("place", ["point_data", "cell_data"])
def test_quadrilaterals_are_read_as_they_are_drawn(place):
    # Values of neighbours have nothing in common, so that the wrong diagonal would be read wrongly.
    mesh = pv.Plane(i_resolution=6, j_resolution=4)
    data = getattr(mesh, place)
    data["v"] = np.random.default_rng(0).random(mesh.n_points if "p" in place else mesh.n_cells)
    # Grays, which the eye mixes with those beside them less than hues.
    how = {"scalars": "v", "cmap": "gray"}
    for shown in (mesh, mesh.cast_to_unstructured_grid()):
        assert read_plain(shown, **how).value.median < 0.04
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.add_mesh(mesh, lighting=False, show_scalar_bar=False, **how)
    plotter.camera = camera_on(mesh, (0, 0, 1), aspect=1.5)
    picture = plotter.screenshot()
    key = ("gray", mesh.get_data_range("v"))
    found = vizlight.legibility(
        mesh, picture=picture, camera=plotter.camera, scalars="v", key=key, **HOW
    )
    assert found.value.median < 0.04


def test_a_component_is_read_as_it_is_drawn():
    mesh = pv.Plane(i_resolution=40, j_resolution=40)
    x, y = np.asarray(mesh.points)[:, :2].T
    mesh["V"] = np.stack([np.sin(5 * x), 2 * np.cos(4 * y), 0 * x], axis=1)
    mesh["x"] = mesh["V"][:, 0].copy()
    found = []
    for how in ({"scalars": "V", "component": 0}, {"scalars": "x"}):
        plotter, _ = plotter_of(mesh, scene=vizlight.presets.shape(), **how)
        found.append(plotter.vizlight.legibility(**HOW).value)
    assert found[0].bits == pytest.approx(found[1].bits, rel=0.01)
    assert found[0].median < 0.05


def test_colours_that_were_averaged_to_points_are_read_there():
    mesh = pv.Plane(i_resolution=6, j_resolution=4)
    mesh.cell_data["v"] = np.random.default_rng(0).random(mesh.n_cells)
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    with pytest.warns(UserWarning, match="averaged from cells to points"):
        plotter.vizlight.add_mesh(mesh, scene=vizlight.presets.shape(), scalars="v", light="points")
    part = shown_by(plotter.renderer, plotter.vizlight._live_of).parts[0]
    assert not part.flat
    np.testing.assert_allclose(part.values, mesh.cell_data_to_point_data()["v"], rtol=1e-6)


def test_a_point_is_as_wide_as_it_is_drawn():
    random = np.random.default_rng(0)
    across = np.stack(np.meshgrid(np.arange(6.0), np.arange(4.0)), axis=-1).reshape(-1, 2)
    mesh = pv.PolyData(np.insert(across, 2, 0.0, axis=1))
    mesh["v"] = random.random(mesh.n_points)
    found = [
        read_plain(mesh, scalars="v", point_size=size, render_points_as_spheres=ball)
        for size, ball in ((24, False), (24, True), (2, True))
    ]
    assert found[0].pixels == pytest.approx(24 * 24**2, rel=0.05)
    assert found[1].pixels == pytest.approx(24 * 24**2 * np.pi / 4, rel=0.1)
    assert max(one.value.median for one in found[:2]) < 0.04
    assert found[2].value.bits < found[1].value.bits / 2


def spokes():
    """Return straight lines from one point into half of all directions."""
    i = np.arange(60) + 0.5
    turn, height = i * np.pi * (3 - 5**0.5), 1 - 2 * i / 60
    radius = np.sqrt(1 - height**2)
    ends = np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=1)
    points = np.concatenate([ends * 0.25, ends])
    cells = np.stack([np.full(60, 2), np.arange(60), np.arange(60) + 60], axis=1)
    return pv.PolyData(points, lines=cells.ravel())


def test_colours_of_the_axes_tell_the_direction_of_lines():
    lines = spokes()
    lines["axes"] = (255 * vizlight.direction_colors(lines)).astype(np.uint8)
    found = read_plain(lines, (1, 0.6, 0.4), scalars="axes", rgb=True, line_width=6)
    assert found.heading.median < 15
    assert found.heading.bits > 0.8
    # PyVista draws shares as it draws bytes.
    lines["shares"] = lines["axes"] / 255
    shares = read_plain(lines, (1, 0.6, 0.4), scalars="shares", rgb=True, line_width=6)
    assert (shares.heading, shares.value) == (found.heading, None)
    # Other colours mean nothing.
    lines["axes"] = lines["axes"][::-1].copy()
    assert read_plain(lines, (1, 0.6, 0.4), scalars="axes", rgb=True, line_width=6).heading is None


def test_strokes_tell_the_direction_until_they_are_too_thin():
    lines = spokes()
    found = [read_plain(lines, color="black", line_width=w).direction for w in (6, 2)]
    assert max(one.median for one in found) < 4
    # Read from afar the strokes are grey.
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.add_mesh(lines, color="black", line_width=1)
    far = plotter.vizlight.legibility(**HOW | {"size_mm": 4.0}).direction
    assert far.unreadable
    assert far.median == 45


def test_a_ball_tells_normals_in_its_own_frame_wherever_the_eye_is():
    ball = pv.Sphere(theta_resolution=60, phi_resolution=60)
    medians = []
    for angle in (5.0, 60.0):
        plotter, _ = plotter_of(ball, scene=vizlight.presets.shape())
        plotter.camera = camera_on(ball, (1, 0.4, 0.3), aspect=1.5)
        plotter.camera.view_angle = angle
        plotter.camera.position = np.array([1, 0.4, 0.3]) * 0.65 / np.sin(np.radians(angle / 2))
        plotter.renderer.reset_camera_clipping_range()
        medians.append(plotter.vizlight.legibility(**HOW).shape.median)
    assert max(medians) < 7


def test_what_has_no_key_is_not_read_and_said_so():
    plotter = pv.Plotter(off_screen=True, window_size=(90, 60))
    plotter.add_mesh(pv.PolyData(np.eye(3)), color="red")
    # What cannot be picked is no data.
    plotter.add_mesh(sheet(9), scalars="height", pickable=False, show_scalar_bar=False)
    found = plotter.vizlight.legibility()
    assert found.pixels == 0
    assert found.notes == ("nothing that is shown has a key by which it could be read",)
    assert "nothing that is shown" in str(found)


def read_marks(add):
    """Return what is read of what a function adds to a plotter, seen from above."""
    plotter = pv.Plotter(off_screen=True, window_size=(360, 240))
    plotter.background_color = "white"
    add(plotter)
    plotter.camera = from_above(sheet(9))
    return plotter.vizlight.legibility(**HOW)


def mapped(plotter, *, scaled=False):
    """Add arrows that VTK's mapper draws at the points of a sheet."""
    mesh = sheet(9)
    mapper = vtkGlyph3DMapper()
    mapper.SetInputData(mesh)
    mapper.SetSourceData(pv.Arrow(start=(-0.5, 0, 0)))
    mapper.SetOrientationArray("swirl")
    mapper.SetScaleModeToNoDataScaling()
    mapper.SetScaleFactor(0.22)
    mapper.SetScaleArray("speed")
    if scaled:
        mapper.SetScaleModeToScaleByMagnitude()
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0, 0, 0)
    plotter.renderer.AddActor(actor)


@pytest.mark.slow
def test_glyphs_are_read_alike_whoever_draws_them():
    glyphs = arrows(sheet(9))

    plain, mapper, lit = (
        read_marks(add)
        for add in (
            lambda p: p.add_mesh(glyphs, color="black", lighting=False),
            mapped,
            lambda p: p.vizlight.add_mesh(glyphs, scene=vizlight.Scene(), color="black"),
        )
    )
    assert plain.direction.median < 3
    assert plain.sense.told > 0.7
    assert plain.shape is None
    assert mapper.pixels == plain.pixels
    for found in (mapper, lit):
        assert found.direction.median == pytest.approx(plain.direction.median, abs=0.5)
        assert found.sense.told == pytest.approx(plain.sense.told, abs=0.1)
    scaled = read_marks(lambda p: mapped(p, scaled=True))
    sized = arrows(sheet(9), scale="speed")
    assert scaled.speed.spearman > 0.9
    assert scaled.pixels == read_marks(lambda p: p.add_mesh(sized, color="black")).pixels


@pytest.mark.parametrize("lit", [False, True])
def test_a_moved_actor_of_glyphs_is_read_where_it_is(lit):
    """Glyphs that are turned by 70 degrees before they become data, and back by their actor."""
    glyphs = arrows(sheet(9))
    turned = glyphs.rotate_z(70, inplace=False, transform_all_input_vectors=True)
    # VTK turns active vectors by itself.
    turned.set_active_vectors(None)

    def add(plotter):
        how = {"scene": vizlight.Scene()} if lit else {}
        (plotter.vizlight if lit else plotter).add_mesh(turned, color="black", **how).rotate_z(-70)

    found = read_marks(add)
    assert found.direction.median < 3
    assert found.sense.told > 0.7


@pytest.mark.slow
def test_line_integral_convolution_of_vtk_tells_the_course():
    mesh = sheet(40)

    def add(plotter):
        mapper = vtkSurfaceLICMapper(input_data_object=mesh, scalar_visibility=False)
        mapper.SetInputArrayToProcess(0, 0, 0, 0, "swirl")
        plotter.add_actor(pv.Actor(mapper=mapper))

    found = read_marks(add)
    assert found.direction.median < 13
    assert found.direction.readable > 0.4
    assert found.sense is None
    assert found.scale.question == "direction"


def read_texture(pattern, *, vectors="swirl", turn=0.0):
    """Return what is read of a sheet on which a pattern of x and y is painted as a texture."""
    mesh = sheet(40)
    # A swirl about the middle of a side looks different when it is turned.
    mesh["aside"] = mesh["swirl"] - (0, 1, 0)
    corners = {"origin": (-1, -1, 0), "point_u": (1, -1, 0), "point_v": (-1, 1, 0)}
    mesh.texture_map_to_plane(**corners, inplace=True)
    mesh.point_data.active_vectors_name = vectors
    right, up = np.meshgrid(*2 * [np.linspace(-1, 1, 512)])
    gray = (127 + 100 * pattern(right, up)).astype(np.uint8)
    texture = pv.Texture(np.repeat(gray[..., np.newaxis], 3, axis=2))

    def add(plotter):
        plotter.add_mesh(mesh, texture=texture, lighting=False).rotate_z(turn)

    return read_marks(add)


@pytest.mark.parametrize(("vectors", "middle", "turn"), [("swirl", 0, 0), ("aside", 1, 70)])
def test_a_texture_tells_the_course_of_vectors_that_it_runs_along(vectors, middle, turn):
    rings = read_texture(
        lambda x, y: np.cos(80 * np.hypot(x - middle, y)), vectors=vectors, turn=turn
    )
    assert rings.direction.median < 1
    assert rings.direction.readable > 0.95
    assert rings.direction.most == pytest.approx(np.log2(180))
    assert rings.shape is None


def test_faint_wide_rings_are_read_in_the_channel_of_coarse_marks():
    figures = read_texture(lambda x, y: 0.03 * np.cos(60 * np.hypot(x, y))).direction
    # In the fine channel alone it is half of that.
    assert figures.bits > 0.5


@pytest.mark.parametrize("waves", [60, 0])
def test_a_texture_across_vectors_or_of_one_colour_tells_no_course(waves):
    found = read_texture(lambda x, y: np.cos(waves * np.arctan2(y, x))).direction
    assert found.unreadable
    assert found.median == 45


def test_a_texture_tells_speed_by_its_lightness_and_nothing_without_vectors():
    found = read_texture(lambda x, y: np.hypot(x, y) - 0.7)
    assert found.speed.spearman > 0.97
    assert found.speed.most == 4
    assert found.speed.bits > 2
    assert found.direction.unreadable
    bare = read_texture(np.hypot, vectors=None)
    assert bare.notes == ("nothing that is shown has a key by which it could be read",)
