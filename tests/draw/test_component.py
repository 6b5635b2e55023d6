"""``plotter.vizlight``: light at the points equals the filter's, and nothing stays behind."""

import gc
import warnings
import weakref

import numpy as np
import pytest
import pyvista as pv
from fields import half_known
from lamps import SHINY
from shapes import ball, clifford_torus

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View, presets
from vizlight.draw import component
from vizlight.draw.live import COLORS, LUMINANCE, scene_of
from vizlight.geometry.lines import bundle
from vizlight.shading.display import displayable

pytestmark = pytest.mark.opengl

LAMP = Light(direction=(1, 0.9, 0.5))
SCENE = Scene(lights=LAMP, material=SHINY)


@pytest.fixture
def plotter():
    return plotter_of()


def plotter_of(**options):
    made = pv.Plotter(off_screen=True, window_size=(160, 120), **options)
    made.background_color = "black"
    return made


def picture(plotter):
    plotter.render()
    return np.array(plotter.screenshot(None, return_img=True), dtype=np.int16)


def baked(lit, camera, scalars="luminance", **options):
    """Return PyVista's own picture of an array."""
    other = plotter_of()
    if scalars == "luminance":
        options |= {"cmap": "gray", "clim": (0, 1)}
    else:
        options |= {"rgb": True}
    other.add_mesh(lit, scalars=scalars, lighting=False, show_scalar_bar=False, **options)
    other.camera = camera.copy()
    return picture(other)


def seen_by(plotter, scene=SCENE):
    return scene.replace(view=View.from_camera(plotter.camera))


def turned(plotter, count, seed=5):
    """Yield while the camera goes to random places around the mesh."""
    random = np.random.default_rng(seed)
    plotter.show(auto_close=False)
    for i in range(count):
        plotter.view_vector(random.normal(size=3))
        plotter.camera.zoom(random.uniform(0.8, 1.5))
        plotter.camera.parallel_projection = bool(i % 4 == 3)
        yield


def half():
    mesh = ball().clip(normal="x").extract_surface(algorithm=None)
    mesh.point_data.clear()
    return mesh


COLORED = Scene(
    lights=[LAMP, Light(position=(2, -1, 1), color=(1, 0.6, 0.3))],
    depth_cue=DepthCue(back_scale=0.3, cue=0.2, color=(0.2, 0.3, 1.0)),
    material=SHINY,
)
CONDITIONED = {"tangents": "around", "conditioned": True, "model": "blinn"}
POINTS = {
    "surface": (ball, SCENE, {}, {}),
    "field": (ball, SCENE, {"tangents": "around"}, {}),
    "conditioned": (ball, SCENE, CONDITIONED, {}),
    "cylinder": (ball, SCENE, {"tangents": "around", "model": "cylinder"}, {}),
    "open": (half, SCENE, {"feature_angle": None}, {}),
    "colours and cue": (ball, COLORED, {}, {}),
    "tinted": (ball, SCENE, {}, {"scalars": "height", "cmap": "plasma"}),
}


@pytest.mark.sampled(3)
@pytest.mark.filterwarnings("ignore:.* of the edges are sharper", "ignore:1 of")
@pytest.mark.parametrize("case", POINTS)
def test_light_at_points_is_that_of_the_filter(plotter, case):
    """To the bit, for each new camera: an open surface is lit on the side that is seen."""
    make, scene, options, tinted = POINTS[case]
    mesh = make()
    plotter.vizlight.add_mesh(
        mesh, scene=scene, light="points", show_scalar_bar=False, **options, **tinted
    )
    for _ in turned(plotter, 4):
        lit, name = vizlight.illuminate(mesh, seen_by(plotter, scene), **options), "luminance"
        if tinted:
            lit, name = vizlight.tint(lit, "height", cmap="plasma"), "rgb"
        elif scene.colored:
            lit["rgb"], name = displayable(lit["rgb"]), "rgb"
        np.testing.assert_array_equal(picture(plotter), baked(lit, plotter.camera, name))
    assert "luminance" not in mesh.point_data


def test_colours_that_cannot_be_found_again_are_said_to_be_missing(plotter):
    mesh = ball()
    lit = vizlight.tint(vizlight.illuminate(mesh, seen_by(plotter)), np.arange(mesh.n_points))
    with pytest.warns(UserWarning, match="without colours: they are those of an array of shape"):
        plotter.vizlight.add_mesh(lit)


@pytest.mark.parametrize("light", ["points", "fragments"])
def test_another_scene_is_that_of_a_new_mesh(plotter, light):
    dark = SCENE.replace(material=Material(ambient=0.0, diffuse=0.0, specular=0.3))
    bright = SCENE.replace(
        lights=[LAMP, Light(direction=(-1, 0, 0.2))],
        material=Material(ambient=0.2, diffuse=0.5, specular=0.3, shininess=40),
        depth_cue=DepthCue(back_scale=0.5),
    )
    actor = plotter.vizlight.add_mesh(ball(), scene=dark, light=light)
    plotter.show(auto_close=False)
    before = picture(plotter)
    plotter.vizlight.set_scene(actor, bright)
    after = picture(plotter)
    plotter.remove_actor(actor)
    plotter.vizlight.add_mesh(ball(), scene=bright, light=light)
    np.testing.assert_array_equal(after, picture(plotter))
    assert np.abs(after.astype(int) - before).max() > 50
    with pytest.raises(ValueError, match="scene: expected"):
        plotter.vizlight.set_scene(actor, "bright")
    bare = plotter.add_mesh(pv.Sphere())
    with pytest.raises(ValueError, match="actor: expected one of plotter.vizlight.add_mesh"):
        plotter.vizlight.set_scene(bare, bright)


VIEWED = Scene(lights=LAMP, view=View(direction=(1, 1, 1)), material=SHINY)
LIT = {
    "illuminate": lambda: vizlight.illuminate(ball(), VIEWED, tangents="around", conditioned=True),
    "streamlines": lambda: vizlight.streamlines(
        vizlight.load_example(), VIEWED, tangents="V", seeds=20
    ),
    "confined": lambda: vizlight.streamlines(
        ball(), VIEWED, tangents="around", seeds=20, conditioned=True
    ),
    "after": lambda: vizlight.manifold(
        clifford_torus(24), scene=VIEWED, distance=2.0, light="after"
    ),
    "shadow": lambda: vizlight.relief_shadow(ball(16).triangulate(), VIEWED, lit=True),
}


@pytest.mark.sampled(2)
@pytest.mark.filterwarnings("ignore:.* points could not be lit")
@pytest.mark.parametrize("kind", LIT)
def test_light_of_filters_is_lit_again_from_its_record(plotter, kind):
    lit = LIT[kind]()
    bare = lit.copy()
    plotter.vizlight.add_mesh(bare, light="points", halo=False)
    for _ in turned(plotter, 2):
        (again,), scene = component.relight.from_record(lit)
        inputs, options = again.inputs, again.options
        shading = vizlight.engine.run(inputs, seen_by(plotter, scene), options)
        expected = lit.copy()
        expected["luminance"] = shading.luminance
        np.testing.assert_array_equal(picture(plotter), baked(expected, plotter.camera))
    np.testing.assert_array_equal(bare["luminance"], lit["luminance"])


def test_a_field_in_coloured_light_is_drawn_with_colours_of_data(plotter):
    """The colours of data are not those of the light, and stand under one name."""
    field = pv.ImageData(dimensions=(9, 9, 1))
    field["height"] = np.random.default_rng(1).uniform(size=81)
    scene = Scene(lights=Light(direction=(1, 1, 1), color="gold"), material=SHINY)
    lit = vizlight.relief_shadow(field, scene, elevation="height", lit=True)
    plotter.vizlight.add_mesh(vizlight.tint(lit, "height", cmap="viridis", clim=(0, 1)))
    coloured = picture(plotter)
    plotter.clear_actors()
    plotter.vizlight.add_mesh(lit, scalars="height", cmap="viridis", clim=(0, 1))
    np.testing.assert_array_equal(coloured, picture(plotter))


def test_manifolds_of_four_space_keep_their_eye_or_follow_the_camera(plotter):
    view = View(direction=(0, 0, 1, 1))
    scene = Scene(lights=Light(direction=(1, 1, 1, 0)), view=view, material=SHINY)
    torus = clifford_torus(24)
    lit = vizlight.manifold(torus, scene=scene, distance=2.0)
    actor = plotter.vizlight.add_mesh(lit)
    assert "4-space" in plotter.vizlight.explain(actor)
    for _ in turned(plotter, 2):
        np.testing.assert_array_equal(picture(plotter), baked(lit, plotter.camera))
    plotter.clear_actors()
    # A light of 3-space stands in the hyperplane of the first three axes.
    names = {"positions": "position", "tangents": "frame"}
    plotter.vizlight.add_mesh(lit, scene=SCENE, **names)
    for _ in turned(plotter, 2):
        camera = View.from_camera(plotter.camera)
        lifted = Scene(
            lights=Light(direction=(*LAMP.direction, 0)),
            view=View(
                position=(*camera.position, 0),
                direction=(*camera.direction, 0),
                parallel=camera.parallel,
            ),
            material=SHINY,
        )
        expected = vizlight.illuminate(lit, lifted, **names)
        np.testing.assert_array_equal(picture(plotter), baked(expected, plotter.camera))


def test_a_plotter_as_pyvista_makes_it_has_the_default_light(plotter):
    mesh = ball()
    plotter.vizlight.add_mesh(mesh, light="points", color="tan")
    for _ in turned(plotter, 2):
        view = View.from_camera(plotter.camera)
        lamps = [
            Light(direction=(-0.405580, 0.579228, 0.707107), follows_view=True, intensity=8 / 11),
            Light.headlight(intensity=3 / 11),
        ]
        material = Material(ambient=0.3, diffuse=0.7, specular=0, color="tan")
        lit = vizlight.illuminate(mesh, Scene(lights=lamps, material=material, view=view))
        default = vizlight.illuminate(mesh, Scene(view=view, material=Material(color="tan")))
        np.testing.assert_allclose(default["rgb"], lit["rgb"], atol=1e-6)
        assert np.abs(picture(plotter) - baked(lit, plotter.camera, "rgb")).max() <= 1
    plotter.renderer.lights[0].intensity += 0.1
    changed = Scene.from_plotter(plotter, material=material)
    lit = vizlight.illuminate(mesh, changed)
    lit["rgb"] = np.clip(lit["rgb"], 0, 1)
    assert np.abs(picture(plotter) - baked(lit, plotter.camera, "rgb")).max() <= 1


def test_without_a_scene_the_light_is_that_of_the_plotter(plotter):
    plotter.add_light(pv.Light(position=(1, 2, 3), light_type="scene light", intensity=0.2))
    mesh = ball()
    actor = plotter.vizlight.add_mesh(mesh, light="points", specular=0.4, color="tan")
    for _ in turned(plotter, 2):
        material = Material.from_property(
            actor.prop,
            lights=Scene.from_plotter(plotter).lights,
            view=View.from_camera(plotter.camera),
        )
        scene = Scene.from_plotter(plotter, material=material)
        lit = vizlight.illuminate(mesh, scene)
        lit["rgb"] = np.clip(lit["rgb"], 0, 1)
        np.testing.assert_array_equal(picture(plotter), baked(lit, plotter.camera, "rgb"))
    before = picture(plotter)
    actor.prop.specular, actor.prop.diffuse = 0.0, 0.9
    assert np.abs(picture(plotter) - before).max() > 10
    plotter.remove_all_lights()
    assert picture(plotter).max() <= 1


def test_actor_behaves_as_those_of_pyvista(plotter):
    mesh = ball()
    actor = plotter.vizlight.add_mesh(
        mesh, scene=SCENE, name="ball", opacity=0.5, line_width=3, pickable=False, style="wireframe"
    )
    assert isinstance(actor, pv.Actor)
    assert plotter.actors["ball"] is actor
    assert (actor.prop.opacity, actor.prop.line_width, actor.GetPickable()) == (0.5, 3, 0)
    again = plotter.vizlight.add_mesh(mesh, scene=SCENE, name="ball")
    assert plotter.actors["ball"] is again
    assert len(plotter.actors) == 1


def test_scalar_bar_shows_the_unlit_colours_and_goes_with_its_actor(plotter):
    mesh = ball()
    actor = plotter.vizlight.add_mesh(
        mesh, scene=SCENE, light="points", scalars="height", cmap="hot"
    )
    (title,) = plotter.scalar_bars.keys()
    assert title == "height"
    table = plotter.scalar_bars[title].GetLookupTable()
    values = pv.convert_array(table.GetTable())
    np.testing.assert_array_equal(values, pv.LookupTable("hot", n_values=256).values)
    assert table.GetRange() == pytest.approx((mesh["height"].min(), mesh["height"].max()))
    assert not plotter.scalar_bars[title].GetDrawNanAnnotation()
    plotter.remove_actor(actor)
    assert not plotter.scalar_bars.keys()


def test_views_side_by_side_and_linked():
    plotter = plotter_of(shape=(1, 2))
    mesh = ball()
    for column in (0, 1):
        plotter.subplot(0, column)
        plotter.background_color = "black"
        plotter.vizlight.add_mesh(mesh, scene=SCENE, light="points")
        plotter.view_vector((1, column, 0.2))
    apart = picture(plotter)
    assert np.abs(apart[:, :80] - apart[:, 80:]).max() > 10
    plotter.link_views()
    plotter.subplot(0, 0)
    plotter.camera.azimuth += 40
    linked = picture(plotter)
    inner = slice(4, 76)
    # Viewports at different places may round the same triangle differently.
    assert np.abs(linked[4:-4, inner] - linked[4:-4, 80:][:, inner]).max() <= 1


def observers(plotter):
    return sum(bool(renderer.HasObserver("StartEvent")) for renderer in plotter.renderers)


REMOVALS = {
    "remove_actor": lambda plotter, actor: plotter.remove_actor(actor),
    "by name": lambda plotter, _: plotter.remove_actor("it"),
    "replaced": lambda plotter, _: plotter.add_mesh(pv.Cube(), name="it"),
    "clear_actors": lambda plotter, _: plotter.clear_actors(),
    "clear": lambda plotter, _: plotter.clear(),
    "deep_clean": lambda plotter, _: plotter.deep_clean(),
    "close": lambda plotter, _: plotter.close(),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("light", ["points", "fragments"])
@pytest.mark.parametrize("how", REMOVALS)
def test_nothing_stays_behind(how, light):
    plotter = plotter_of()
    mesh = ball()
    actor = plotter.vizlight.add_mesh(mesh, scene=SCENE, light=light, name="it")
    plotter.show(auto_close=False)
    assert observers(plotter) == 1
    live = plotter.vizlight._live_of(actor)
    left = [weakref.ref(thing) for thing in (live, live.drawn, mesh)]
    REMOVALS[how](plotter, actor)
    del live, actor, mesh
    plotter.mesh = plotter.mapper = None
    gc.collect()
    # What is left of an actor that is gone goes with the next frame, or the next question.
    assert not plotter.vizlight.has_live_light
    gc.collect()
    assert [ref() for ref in left] == [None] * 3


def test_plotter_itself_is_released():
    plotter = plotter_of()
    plotter.vizlight.add_mesh(ball(), scene=SCENE)
    plotter.show(auto_close=False)
    ref = weakref.ref(plotter)
    plotter.close()
    del plotter
    gc.collect()
    assert ref() is None


def test_light_follows_where_nobody_holds_the_actor(plotter):
    plotter.vizlight.add_mesh(ball(), scene=SCENE, light="points")
    plotter.show(auto_close=False)
    gc.collect()
    before = picture(plotter)
    plotter.camera.azimuth += 60
    lit = vizlight.illuminate(ball(), seen_by(plotter))
    after = picture(plotter)
    np.testing.assert_array_equal(after, baked(lit, plotter.camera))
    assert np.abs(after - before).max() > 10


@pytest.mark.parametrize("light", ["points", "fragments"])
def test_mesh_changed_in_place_is_lit_anew(plotter, light):
    mesh = ball(96)
    mesh.point_data.active_normals_name = None
    del mesh.point_data["Normals"]
    plotter.vizlight.add_mesh(
        mesh, scene=SCENE, light=light, scalars="height", clim=(-1, 1), show_scalar_bar=False
    )
    plotter.show(auto_close=False)
    mesh.points[:] = mesh.points * (1.0, 0.5, 0.8)
    mesh["height"][:] = np.array(mesh.points[:, 0])
    lit = vizlight.illuminate(mesh, seen_by(plotter))
    expected = baked(vizlight.tint(lit, "height", clim=(-1, 1)), plotter.camera, "rgb")
    error = np.abs(picture(plotter) - expected)
    # Light in fragments differs from that at points where triangles are seen edge on.
    assert np.quantile(error, 0.999) <= (0 if light == "points" else 4)
    assert error.mean() < 0.1


def test_actor_that_is_moved_is_lit_where_it_stands(plotter):
    mesh = ball()
    actor = plotter.vizlight.add_mesh(mesh, scene=SCENE, light="points")
    plotter.show(auto_close=False)
    actor.user_matrix = np.diag([1.0, 0.5, 2.0, 1.0])
    stretched = mesh.transform(actor.user_matrix, inplace=False)
    normals = np.asarray(mesh.point_data["Normals"]) / (1.0, 0.5, 2.0)
    lit = vizlight.illuminate(stretched, seen_by(plotter), normals=normals)
    assert np.abs(picture(plotter) - baked(lit, plotter.camera)).max() <= 1


def test_camera_at_the_centre_and_tiny_windows():
    plotter = plotter_of()
    mesh = ball()
    for light in ("points", "fragments"):
        plotter.vizlight.add_mesh(mesh, scene=SCENE, light=light)
    plotter.show(auto_close=False)
    plotter.camera.position = plotter.camera.focal_point = (0.0, 0.0, 0.0)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        picture(plotter)
    plotter.view_xy()
    plotter.window_size = [1, 1]
    assert picture(plotter).shape == (1, 1, 3)


def test_bad_arguments(plotter):
    mesh = ball()
    add = plotter.vizlight.add_mesh
    flat = Scene(lights=Light(direction=(1, 0, 0, 0)))
    for given, options, text in (
        (mesh, {"light": "pixels"}, "light: expected 'auto', 'points' or 'fragments'"),
        (mesh, {"scalars": "hight"}, "scalars: expected a point array"),
        (mesh, {"ambient": 0.2}, "ambient: expected the material of the scene, or no scene"),
        (mesh, {"tangents": "height"}, "tangents: expected vectors"),
        (mesh, {"linewidth": 3}, "linewidth"),
        (mesh, {"scene": "day"}, "scene: expected a vizlight.Scene"),
        (mesh, {"scene": flat}, "scene: expected vectors of 3 components"),
        ("ball.vtp", {}, "mesh: expected a PyVista mesh"),
    ):
        with pytest.raises((TypeError, ValueError), match=text):
            add(given, **{"scene": SCENE} | options)
    assert not plotter.actors
    changed = vizlight.illuminate(mesh, SCENE.replace(view=View(direction=(1, 1, 1))))
    changed["Normals"][:] = np.array(changed["Normals"])[:, ::-1]
    with pytest.raises(ValueError, match="other light at"):
        add(changed)


def test_closed_plotter_is_refused():
    plotter = plotter_of()
    own = plotter.vizlight
    plotter.close()
    with pytest.raises(RuntimeError, match="plotter: expected an open plotter, got a closed one"):
        own.add_mesh(ball(), scene=SCENE)


def two_frames(plotter):
    """Return the first of two pictures, the second from another place."""
    seen = picture(plotter)
    plotter.camera.azimuth += 10
    picture(plotter)
    plotter.camera.azimuth -= 10
    return seen


@pytest.mark.parametrize("light", ["points", "fragments"])
def test_mesh_that_loses_its_colours_or_its_points_stays_as_it_was(plotter, light):
    mesh = ball()
    plotter.vizlight.add_mesh(
        mesh, scene=SCENE, light=light, scalars="height", show_scalar_bar=False
    )
    before = picture(plotter)
    for _ in range(2):
        del mesh.point_data["height"]
        with pytest.warns(UserWarning, match="keeps the light.*'height'") as caught:
            seen = two_frames(plotter)
        np.testing.assert_array_equal(seen, before)
        assert len(caught) == 1
        mesh["height"] = np.array(mesh.points[:, 2])
        np.testing.assert_array_equal(picture(plotter), before)
    full = mesh.copy()
    mesh.copy_from(pv.PolyData())
    with pytest.warns(UserWarning, match="keeps the light"):
        np.testing.assert_array_equal(picture(plotter), before)
    mesh.copy_from(full)
    np.testing.assert_array_equal(picture(plotter), before)


FEW = vizlight.Bundle(grid=16)


def tangle():
    points = np.random.default_rng(1).normal(size=(60, 3))
    return pv.MultipleLines(points).compute_arc_length()


def test_shares_of_light_inside_a_bundle_are_kept_when_the_eye_moves(plotter, monkeypatch):
    asked = []
    dimmed = bundle.Medium.dimmed

    def counted(self, *args, **options):
        asked.append(args)
        return dimmed(self, *args, **options)

    monkeypatch.setattr(bundle.Medium, "dimmed", counted)
    lines = tangle()
    plotter.vizlight.add_mesh(lines, scene=SCENE, bundle=FEW)
    picture(plotter)
    first = np.array(plotter.camera.position)
    plotter.camera.azimuth = 60
    picture(plotter)
    assert not np.allclose(plotter.camera.position, first)
    assert len(asked) == 1
    lines.points[0] += 0.5
    lines.Modified()
    picture(plotter)
    assert len(asked) == 2


DRAWN = {
    "thin": {},
    "wide": {"line_width": 4},
    "tubes": {"line_width": 4, "render_lines_as_tubes": True},
    "diameter": {"line_diameter": 0.05},
}


@pytest.mark.parametrize(
    ("drawn", "model", "lights"),
    list(zip(DRAWN, ["phong", "cylinder"] * 2, ["kit", "none", "one", "two"], strict=True)),
)
def test_a_bundle_dims_the_lights_of_the_plotter_where_they_are_now(drawn, lights, model):
    """Against the filter by the scene of the plotter, before and after everything has moved."""
    plotter = pv.Plotter(
        off_screen=True, window_size=(60, 60), lighting="light kit" if lights == "kit" else "none"
    )
    given = [pv.Light(position=(0, 3, 4), light_type="scene light") for _ in range(2)]
    for lamp in given[: {"one": 1, "two": 2}.get(lights, 0)]:
        plotter.add_light(lamp)
    given[1].positional, given[1].position, given[1].cone_angle = True, (5, 3, 4), 90
    lines = tangle()
    actor = plotter.vizlight.add_mesh(lines, model=model, bundle=FEW, **DRAWN[drawn])

    def check():
        picture(plotter)
        scene = scene_of(plotter.renderer, actor, model)
        lit = vizlight.illuminate(lines, scene, model=model, bundle=FEW)
        light = lit["rgb"] if "rgb" in lit.point_data else lit["luminance"][:, np.newaxis]
        shown = np.asarray(actor.mapper.dataset.point_data[COLORS])
        np.testing.assert_allclose(shown, displayable(light * np.ones(3)), atol=1e-6)

    check()
    plotter.camera.azimuth = 60
    given[0].position = (4, -1, 0)
    check()
    lines.points[0] += 0.5
    lines.Modified()
    check()
    plotter.add_light(pv.Light(position=(0, -3, 4), light_type="scene light"))
    check()


def test_a_bundle_dims_the_lights_of_another_scene(plotter):
    lines = tangle()
    actor = plotter.vizlight.add_mesh(lines, scene=SCENE, bundle=FEW)
    two = SCENE.replace(lights=[Light(direction=(1, 0, 1)), Light(direction=(0, 1, 1))])
    plotter.vizlight.set_scene(actor, two)
    picture(plotter)
    lit = vizlight.illuminate(lines, seen_by(plotter, two), bundle=FEW)["luminance"]
    shown = np.asarray(actor.mapper.dataset.point_data[LUMINANCE])
    np.testing.assert_allclose(shown, lit, atol=1e-6)


@pytest.mark.parametrize("light", ["points", "fragments"])
@pytest.mark.parametrize("scalars", [None, "height"])
def test_what_is_not_data_is_grey_and_the_bar_names_it(light, scalars):
    plotter = pv.Plotter(off_screen=True, window_size=(200, 200))
    plotter.disable_anti_aliasing()
    scene = Scene(lights=Light(direction=(1, 0, 1)), material=SHINY)
    with pytest.warns(UserWarning, match="210 of 441"):
        plotter.vizlight.add_mesh(
            half_known(), scene=scene, light=light, tangents="V", scalars=scalars
        )
    plotter.view_xy()
    plotter.camera.parallel_projection, plotter.camera.parallel_scale = True, 0.5
    picture = plotter.screenshot(return_img=True)
    np.testing.assert_array_equal(picture[60:140, 120:180], 128)
    assert not np.any(np.all(picture[60:140, 20:90] == 128, axis=2))
    for bar in plotter.scalar_bars.values():
        assert (bar.GetDrawNanAnnotation(), bar.GetNanAnnotation()) == (1, "no data")
        np.testing.assert_allclose(bar.GetLookupTable().nan_color.float_rgb, 128 / 255)
    assert len(plotter.scalar_bars) == (scalars is not None)
    if scalars:
        missing, known = picture[20:80, 20:90].astype(int), picture[120:140, 20:90].astype(int)
        assert np.ptp(missing, axis=2).max() == 0
        assert np.ptp(known, axis=2).min() > 10


def test_colours_of_a_solid_have_the_range_of_all_its_values():
    """On the surface of a ball cut from a volume the distance is one number, and rounding."""
    box = pv.ImageData(dimensions=(16, 16, 16), origin=(-7.5, -7.5, -7.5))
    box["distance"] = np.linalg.norm(box.points, axis=1)
    ball = box.clip_scalar(scalars="distance", value=6.0)
    ranges = []
    for mesh, options in ((ball, {}), (box, {}), (ball, {"clim": (1, 2)})):
        plotter = pv.Plotter(off_screen=True)
        actor = plotter.vizlight.add_mesh(mesh, scalars="distance", **options)
        ranges.append(actor.mapper.scalar_range)
    expected = [[f(m["distance"]) for f in (np.min, np.max)] for m in (ball, box)] + [(1, 2)]
    np.testing.assert_allclose(ranges, expected, rtol=1e-6)


def test_an_infinite_value_leaves_the_colours_to_the_others(plotter):
    mesh = ball()
    mesh["height"] = mesh.points[:, 2].copy()
    known = mesh["height"][1:]
    mesh["height"][0] = np.inf
    actor = plotter.vizlight.add_mesh(mesh, scalars="height")
    assert actor.mapper.scalar_range == pytest.approx((known.min(), known.max()))


def test_a_question_stands_for_its_scene_and_surfaces_need_tangents_for_directions(plotter):
    mesh = pv.Sphere(theta_resolution=12, phi_resolution=12)
    actor = plotter.vizlight.add_mesh(mesh, scene="shape")
    plotter.show(auto_close=False)
    by_name = picture(plotter)
    plotter.vizlight.set_scene(actor, presets.shape())
    np.testing.assert_array_equal(picture(plotter), by_name)
    for question in ("direction", "slope", "heading"):
        with pytest.raises(ValueError, match=f"tangents: expected vectors, whose {question} this"):
            plotter.vizlight.add_mesh(mesh, scene=question)
    # Lines have tangents of their own.
    assert plotter.vizlight.add_mesh(pv.Line(), scene="direction") is not None
    np.testing.assert_array_equal(presets.key("value")["rgb"], presets.key(presets.value())["rgb"])
