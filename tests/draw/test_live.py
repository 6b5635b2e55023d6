"""Light in fragments is that of the filters on fine meshes, and right between coarse points."""

import numpy as np
import pytest
import pyvista as pv
import shapes
from fields import swatches
from lamps import NEAR, SHINY, far, shiny
from vectors import parts, unit

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View

pytestmark = pytest.mark.opengl

FAR = Light(direction=(1, 0.9, 0.5), intensity=0.6)
CUE = DepthCue(back_scale=0.3, cue=0.1, color=(0.3, 0.4, 1.0))


def torus():
    """Return a fine surface with a tangent field that has no singular point."""
    mesh = shapes.torus(240)
    mesh.rename_array("n", "Normals")
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def helix(count=12001):
    return shapes.helix(count, turns=6, rise=0.03)


def plotter_of(*size):
    made = pv.Plotter(off_screen=True, window_size=size)
    made.background_color = "black"
    # At the outline samples of a pixel lie outside their triangle, where light is extrapolated.
    made.render_window.SetMultiSamples(0)
    return made


def shot(plotter, camera=None):
    if camera is None:
        plotter.view_vector((1, 0.6, 0.8))
        plotter.camera.zoom(1.3)
    else:
        plotter.camera = camera.copy()
    plotter.render()
    return np.array(plotter.screenshot(None, return_img=True), dtype=np.int16)


def pictures(mesh, scene, **options):
    """Return the pictures with light in fragments and at the points."""
    found, camera = [], None
    for light in ("fragments", "points"):
        plotter = plotter_of(240, 200)
        options["show_scalar_bar"] = False
        plotter.vizlight.add_mesh(mesh, scene=scene, light=light, **options)
        found.append(shot(plotter, camera))
        camera = plotter.camera.copy()
    return found


SHAPES = {
    "surface": (torus, {}),
    "tangents": (torus, {"tangents": "around"}),
    "conditioned": (torus, {"tangents": "around", "conditioned": True}),
    "lines": (helix, {"line_width": 3}),
}
SCENES = {
    "far": Scene(lights=FAR, material=SHINY),
    "near": Scene(lights=NEAR, material=shiny(specular=0.3, shininess=35.5)),
    "two in fog": Scene(
        lights=[FAR, NEAR], depth_cue=CUE, ambient_color=(0.7, 0.8, 1), material=SHINY
    ),
    "headlight": Scene(material=shiny(color="tan", specular_color=(1, 0.9, 0.8))),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("light", ["fragments", "points"])
@pytest.mark.parametrize("lighting", ["light kit", "none"])
def test_without_a_scene_the_material_is_that_of_the_default_scene(light, lighting):
    """The lights are those of the plotter: its kit stands for those of the default scene."""
    scene = Scene() if lighting == "light kit" else Scene(lights=[])
    seen = []
    for given in (scene, None):
        plotter = pv.Plotter(off_screen=True, window_size=(120, 90), lighting=lighting)
        plotter.vizlight.add_mesh(torus(), scene=given, color="white", light=light)
        seen.append(np.asarray(plotter.screenshot(return_img=True)).astype(int))
    assert np.abs(seen[0] - seen[1]).max() <= 1
    drawn = (seen[0] != seen[0][0, 0]).any(axis=2)
    assert seen[0][drawn].min() >= 0.29 * 255


#: A model and a scene: the other scenes with the second model are among the slow tests.
LIT = [
    pytest.param(model, scene, marks=[pytest.mark.slow] * (model == "blinn" and scene != "near"))
    for model in ("phong", "blinn")
    for scene in SCENES
]


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("model", "scene"), LIT)
@pytest.mark.parametrize("shape", SHAPES)
def test_within_four_of_the_light_at_points(shape, model, scene, claim):
    make, options = SHAPES[shape]
    fragments, points = pictures(make(), SCENES[scene], model=model, **options)
    assert points.std() > 5
    claim(np.abs(fragments - points).max(), 4)


@pytest.mark.sampled(2)
@pytest.mark.parametrize("shape", ["surface", "conditioned", "lines"])
def test_colours_of_data_within_four(shape):
    make, options = SHAPES[shape]
    options = {"scalars": "height", "cmap": "viridis", **options}
    fragments, points = pictures(make(), SCENES["two in fog"], **options)
    error = np.abs(fragments - points)
    # Colours are mapped in each fragment too, which is another rounding.
    assert error.max() <= 5
    assert error.mean() < 0.3


BRIGHT = Material(ambient=0.4, diffuse=1.0, specular=0.5, shininess=3)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("cmap", ["turbo", "coolwarm"])
def test_colours_of_data_in_bright_light_are_the_same_baked_and_live(cmap, tmp_path):
    """One rule for light on data: tint, both kinds of live light, and pictures."""
    mesh = swatches()
    camera = vizlight.render.camera_on(mesh, (0, 0, 1))
    camera.parallel_projection = True
    scene = far((0.3, 0.2, 1), camera, BRIGHT)
    lit = vizlight.tint(vizlight.illuminate(mesh, scene), "value", cmap=cmap)
    found = []
    for light in ("fragments", "points"):
        plotter = plotter_of(320, 240)
        plotter.vizlight.add_mesh(
            mesh, scene=scene, light=light, scalars="value", cmap=cmap, show_scalar_bar=False
        )
        found.append(shot(plotter, camera))
    path = vizlight.render.save_png(
        lit, tmp_path / "lit.png", camera=camera, size=(320, 240), anti_aliasing=None,
        background="black",
    )  # fmt: skip
    found.append(np.array(pv.read(path).active_scalars).reshape(240, 320, -1)[::-1, :, :3])
    expected = lit["rgb"][::4].astype(int)
    assert len(np.unique(expected, axis=0)) > 40
    for picture in found:
        shown = np.unique(picture.reshape(-1, 3).astype(int), axis=0)
        apart = np.abs(shown[:, None] - expected).max(axis=-1)
        assert apart.min(axis=0).max() <= 1, "a colour of tint that is not shown"
        known = apart.min(axis=1) <= 1
        assert known.sum() >= len(shown) - 1, "a colour that tint does not have"


@pytest.mark.filterwarnings("ignore:light='fragments'")
def test_fur_within_four():
    scene = far((1, 0.5, 0.3), (1, 0, 0))
    coat = vizlight.fur(
        pv.Sphere(theta_resolution=90, phi_resolution=90), scene, density=0.6, fibres=300,
        length=0.2, segments=40,
    )  # fmt: skip
    fragments, points = pictures(coat, None, line_width=3, halo=False)
    assert points.std() > 10
    assert np.quantile(np.abs(fragments - points), 0.999) <= 4


def test_grids_have_their_light_too():
    mesh = torus()
    grid = mesh.cast_to_unstructured_grid()
    a, _ = pictures(grid, SCENES["near"], tangents="around", conditioned=True)
    b, _ = pictures(mesh, SCENES["near"], tangents="around", conditioned=True)
    np.testing.assert_array_equal(a, b)


@pytest.mark.sampled(3)
@pytest.mark.parametrize("kind", ["surface", "volume", "image", "explicit"])
def test_creases_are_sharp_and_round_shapes_are_left_whole(kind):
    box = pv.ImageData(dimensions=(5, 5, 5))
    box["value"] = np.arange(box.n_points) * 1.0
    if kind == "surface":
        box = box.extract_surface(algorithm=None)
    elif kind == "volume":
        box = box.cast_to_unstructured_grid()
    elif kind == "explicit":
        box = box.cast_to_structured_grid().cast_to_explicit_structured_grid()
    options = {"scene": Scene(), "scalars": "value", "cmap": ["white", "white"]}
    colors = []
    for angle in ("auto", None):
        plotter = pv.Plotter(off_screen=True, window_size=(160, 120))
        actor = plotter.vizlight.add_mesh(
            box, feature_angle=angle, show_scalar_bar=False, **options
        )
        seen = shot(plotter, plotter.camera)
        colors.append(len(np.unique(seen.reshape(-1, 3), axis=0)))
        if angle is None:
            assert actor.mapper.dataset.n_points == len(box.extract_surface(algorithm=None).points)
    # Three flat faces, their edges, and the background; and shades from edge to edge.
    assert colors[0] < 40 < 60 < colors[1]
    ball = torus()
    ball.point_data.clear()
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.vizlight.add_mesh(ball)
    assert actor.mapper.dataset.n_points == ball.n_points


@pytest.mark.slow
def test_volumes_are_lit_by_the_normals_of_their_surface():
    grid = pv.ImageData(dimensions=(41, 41, 41), origin=(-1, -1, -1), spacing=(0.05,) * 3)
    grid["r"] = np.linalg.norm(grid.points, axis=1)
    volume = grid.threshold(0.9, scalars="r", invert=True)
    for mesh in (volume, grid):
        fragments, points = pictures(mesh, SCENES["near"], feature_angle=None)
        surface = mesh.extract_surface(algorithm="geometry")
        of_surface, _ = pictures(surface, SCENES["near"], feature_angle=None)
        assert points.std() > 10
        assert np.abs(fragments - of_surface).mean() < 0.1


@pytest.mark.slow
def test_coarse_data_are_as_if_they_were_split():
    """Light in fragments is that at the points of split segments, which share no code with it."""
    coarse, split = [], []
    for points in parts(vizlight.load_example("fibre_bundle.vtp")):
        line = pv.MultipleLines(points[::4])
        if line.n_points < 3:
            continue
        line["t"] = unit(np.gradient(points[::4], axis=0))
        at = np.arange(line.n_points)
        fine = np.linspace(0, at[-1], 24 * at[-1] + 1)
        places, tangents = (
            np.stack([np.interp(fine, at, axis) for axis in values.T], axis=1)
            for values in (points[::4], line["t"])
        )
        split.append(pv.MultipleLines(places))
        split[-1]["t"] = tangents
        coarse.append(line)
    scene = Scene(lights=FAR, material=shiny(shininess=40))
    options = {"tangents": "t", "line_width": 2, "halo": False}
    fragments, at_points = pictures(pv.merge(coarse, merge_points=False), scene, **options)
    _, expected = pictures(pv.merge(split, merge_points=False), scene, **options)
    covered = np.all([p.max(axis=-1) > 0 for p in (fragments, at_points, expected)], axis=0)
    error, coarse_error = (np.abs(p - expected)[covered] for p in (fragments, at_points))
    assert error.mean() < 0.5 * coarse_error.mean()
    assert np.quantile(error, 0.98) < 0.2 * np.quantile(coarse_error, 0.98)


@pytest.mark.filterwarnings("ignore:.* of the edges are sharper")
def test_open_surface_faces_the_eye_in_each_fragment():
    half = torus().clip(normal="x", origin=(0.2, 0, 0)).extract_surface(algorithm=None)
    half.point_data.clear()
    for facing in ("auto", "eye"):
        fragments, points = pictures(half, SCENES["near"], facing=facing)
        assert points.std() > 5
        # Where it turns away, light at the points is a mean of that on both sides.
        assert np.quantile(np.abs(fragments - points), 0.99) <= 4


def test_camera_light_and_moved_actor_are_followed():
    mesh = torus()
    plotter = plotter_of(240, 200)
    actor = plotter.vizlight.add_mesh(mesh, scene=SCENES["two in fog"], tangents="around")
    assert plotter.vizlight.explain(actor).startswith("light in each fragment")
    plotter.show(auto_close=False)
    actor.user_matrix = np.diag([1.0, 0.6, 1.5, 1.0])
    for step in range(3):
        plotter.camera.azimuth += 70
        plotter.camera.parallel_projection = step == 1
        got = shot(plotter, plotter.camera)
        moved = mesh.transform(actor.user_matrix, inplace=False, transform_all_input_vectors=False)
        moved["around"] = np.asarray(mesh["around"]) * (1.0, 0.6, 1.5)
        scene = SCENES["two in fog"].replace(view=View.from_camera(plotter.camera))
        lit = vizlight.illuminate(moved, scene, tangents="around")
        lit["rgb"] = np.clip(lit["rgb"], 0, 1)
        other = plotter_of(240, 200)
        other.add_mesh(lit, scalars="rgb", rgb=True, lighting=False)
        expected = shot(other, plotter.camera)
        assert np.quantile(np.abs(got - expected), 0.9995) <= 4


def test_lights_of_the_plotter_may_come_and_go():
    plotter = plotter_of(120, 100)
    plotter.vizlight.add_mesh(torus(), light="fragments", color="white", ambient=0.2)
    lit = shot(plotter)
    plotter.remove_all_lights()
    dark = shot(plotter, plotter.camera)
    assert lit.max() > 100
    assert set(np.unique(dark)) == {0, 51}
    plotter.add_light(pv.Light(position=(5, 5, 5), light_type="scene light", positional=True))
    assert shot(plotter, plotter.camera).max() > 100


@pytest.mark.parametrize("open_", [False, True])
def test_lights_of_a_scene_do_not_need_those_of_the_plotter(open_):
    mesh = pv.Plane(i_resolution=9, j_resolution=9) if open_ else torus()
    plotter = plotter_of(120, 100)
    plotter.vizlight.add_mesh(mesh, scene=SCENES["far"], light="fragments")
    lit = shot(plotter)
    plotter.remove_all_lights()
    without = shot(plotter, plotter.camera)
    assert lit.max() > 40
    np.testing.assert_array_equal(without, lit)


def reversing():
    mesh = torus()
    signs = np.random.default_rng(3).choice([-1.0, 1.0], mesh.n_points)
    mesh["around"] = np.asarray(mesh["around"]) * signs[:, np.newaxis]
    return mesh


def strands():
    mesh = helix(100)
    mesh["Normals"] = np.array(mesh.points)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def manifold():
    return vizlight.manifold(shapes.clifford_torus(12), distance=2.0)


FALLBACKS = {
    "2 tangents per point": (manifold, {"tangents": "projected_frame"}),
    "4-space": (manifold, {"tangents": "frame", "positions": "position"}),
    "cylinder": (helix, {"model": "cylinder"}),
    "sign is arbitrary": (reversing, {"tangents": "around"}),
    "spheres and tubes": (torus, {"render_lines_as_tubes": True}),
    "alone can be round": (
        strands, {"render_lines_as_tubes": True, "line_width": 3, "conditioned": True}
    ),
}  # fmt: skip


@pytest.mark.parametrize("reason", FALLBACKS)
def test_what_fragments_cannot_do_is_done_at_points_with_the_reason(reason):
    mesh, options = FALLBACKS[reason]
    options = {"scene": SCENES["far"], **options}
    plotter = pv.Plotter(off_screen=True, window_size=(60, 50))
    actor = plotter.vizlight.add_mesh(mesh(), **options)
    assert reason in plotter.vizlight.explain(actor).splitlines()[0]
    with pytest.warns(UserWarning, match=f"computed at the points, because .*{reason}"):
        plotter.vizlight.add_mesh(mesh(), light="fragments", **options)
