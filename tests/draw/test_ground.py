"""Shadows of height fields that are cast in each fragment."""

import io

import numpy as np
import pytest
import pyvista as pv
from PIL import Image

import vizlight
from vizlight import Light, Scene
from vizlight.geometry.relief import shadowing

#: Nodes along a side, their distance, and pixels from one to the next, in the middle of one each.
COUNT, STEP, PIXELS = 32, 2.0, 9
ORIGIN = np.array([500_000.0, 4_000_000.0, 30.0])
LAMPS = {
    "far": Light(direction=(1, 0.3, 0.5)),
    "low": Light(direction=(-0.2, 1, 0.12)),
    "along a row": Light(direction=(1, 0, 0.4)),
    "above": Light(direction=(0, 0, 1)),
    "near": Light(position=np.add(ORIGIN, (20, 30, 25))),
}


def field(seed=0, **changes):
    """Return a rough height field, which is drawn flat."""
    y, x = np.mgrid[:COUNT, :COUNT]
    rough = np.random.default_rng(seed).normal(0, 0.5, (COUNT, COUNT))
    options = {"dimensions": (COUNT, COUNT, 1), "spacing": (STEP, STEP, 1), "origin": ORIGIN}
    grid = pv.ImageData(**options | changes)
    grid["height"] = (8 * np.sin(x / 7) * np.cos(y / 9) + rough).ravel()
    return grid


def camera():
    """Return a camera that sees a node in the middle of every ninth pixel."""
    middle = np.add(ORIGIN, (STEP * (COUNT - 1) / 2, STEP * (COUNT - 1) / 2, 0))
    eye = pv.Camera()
    eye.parallel_projection, eye.parallel_scale = True, COUNT * STEP / 2
    eye.focal_point, eye.position, eye.up = middle, np.add(middle, (0, 0, 300)), (0, 1, 0)
    eye.clipping_range = 1, 600
    return eye


def at_nodes(picture):
    """Return the grey levels of a picture at the nodes, without the border of the mesh."""
    places = np.arange(COUNT) * PIXELS + PIXELS // 2
    return np.asarray(picture, int)[::-1][np.ix_(places, places)][1:-1, 1:-1, 0]


def levels(lit):
    """Return the grey levels of the light at the same nodes."""
    light = np.reshape(lit["luminance"], (COUNT, COUNT))[1:-1, 1:-1]
    return np.clip(np.rint(255 * light), 0, 255)


def drawn(mesh, scene, then=None, light="fragments"):
    plotter = pv.Plotter(off_screen=True, window_size=(COUNT * PIXELS,) * 2)
    plotter.disable_anti_aliasing()
    actor = plotter.vizlight.add_mesh(mesh, scene=scene, light=light)
    plotter.camera = camera()
    if then is not None:
        plotter.screenshot(return_img=True)
        plotter.vizlight.set_scene(actor, then)
        plotter.render()
    return plotter.screenshot(return_img=True)


@pytest.mark.parametrize("name", LAMPS)
def test_fragments_have_the_shadow_of_the_nodes(name, seed):
    scene = Scene(lights=[LAMPS[name]])
    lit = vizlight.relief_shadow(field(seed), scene, lit=True)
    assert np.abs(at_nodes(drawn(lit, scene)) - levels(lit)).max() <= 1


def test_a_lamp_that_moves_casts_its_shadow_without_another_walk_at_the_points(monkeypatch):
    first, then = (Scene(lights=[LAMPS[name]]) for name in ("far", "low"))
    lit = vizlight.relief_shadow(field(), first, lit=True)
    expected = levels(vizlight.relief_shadow(field(), then, lit=True))

    def walk(*_, **__):
        raise AssertionError

    monkeypatch.setattr(shadowing, "_follow", walk)
    assert np.abs(at_nodes(drawn(lit, first, then)) - expected).max() <= 1


def test_shadows_at_the_points_are_cast_again_for_another_scene():
    first, then = (Scene(lights=[LAMPS[name]]) for name in ("far", "low"))
    lit = vizlight.relief_shadow(field(), first, lit=True)
    expected = levels(vizlight.relief_shadow(field(), then, lit=True))
    assert np.abs(at_nodes(drawn(lit, first, then, "points")) - expected).max() <= 2


def test_fields_that_are_turned_about_the_vertical_and_of_unequal_steps():
    turn, scene = np.radians(30), Scene(lights=[LAMPS["far"]])
    x, y = np.meshgrid(np.arange(20.0), 0.7 * np.arange(15.0), indexing="ij")
    z = 1.5 * np.sin(x / 2) * np.cos(y / 3)
    across, up = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
    lit = vizlight.relief_shadow(pv.StructuredGrid(across, up, z), scene, lit=True)
    plotter = pv.Plotter(off_screen=True, window_size=(301, 301))
    plotter.disable_anti_aliasing()
    plotter.vizlight.add_mesh(lit, scene=scene, light="fragments")
    for i in (21, 57, 163, 278):
        place = np.asarray(lit.points[i], float)
        eye = pv.Camera()
        eye.parallel_projection, eye.parallel_scale, eye.clipping_range = True, 0.5, (1, 100)
        eye.focal_point, eye.position, eye.up = place, np.add(place, (0, 0, 50)), (0, 1, 0)
        plotter.camera = eye
        plotter.render()
        level = int(plotter.screenshot(return_img=True)[150, 150, 0])
        assert abs(level - 255 * lit["luminance"][i]) <= 1.5


def test_a_field_that_is_moved_takes_its_walk_with_it():
    scene = Scene(lights=[Light(direction=(1, 0.3, 0.5))])
    lit = vizlight.relief_shadow(field(), scene, lit=True)
    plotter = pv.Plotter(off_screen=True, window_size=(COUNT * PIXELS,) * 2)
    plotter.disable_anti_aliasing()
    actor = plotter.vizlight.add_mesh(lit, scene=scene, light="fragments")
    plotter.camera = camera()
    shift = (3.0, -5.0, 7.0)
    actor.position = shift
    plotter.camera.focal_point = np.add(plotter.camera.focal_point, shift)
    plotter.camera.position = np.add(plotter.camera.position, shift)
    picture = plotter.screenshot(return_img=True)
    assert np.abs(at_nodes(picture) - levels(lit)).max() <= 1


@pytest.mark.parametrize(
    ("mesh", "options", "reason"),
    [
        (field(), {"border": "wall"}, "walls"),
        (field(), {"depth": 0.0}, "depth 0"),
        (field(), {"angular_diameter": 0.01, "samples": 4}, "discs"),
        (pv.Sphere(), {}, "closed surface"),
        (
            field().extract_surface(algorithm=None).warp_by_scalar("height"),
            {"raster": 0},
            "sampled",
        ),
        (
            pv.RectilinearGrid([0.0, 1, 3, 4], [0.0, 1, 2], [0.0]).elevation(),
            {"elevation": "Elevation"},
            "uneven",
        ),
    ],
)
def test_other_shadows_stay_at_the_points_and_say_why(mesh, options, reason):
    scene = Scene(lights=[Light(direction=(1, 0.3, 0.5))])
    lit = vizlight.relief_shadow(mesh, scene, lit=True, **options)
    plotter = pv.Plotter(off_screen=True)
    with pytest.warns(UserWarning, match=f"at the points, because .*{reason}"):
        actor = plotter.vizlight.add_mesh(lit, scene=scene, light="fragments")
    assert "at the points" in plotter.vizlight.explain(actor)


def test_shadows_are_at_the_points_where_nothing_is_asked():
    scene = Scene(lights=[LAMPS["far"]])
    plotter = pv.Plotter(off_screen=True)
    actor = plotter.vizlight.add_mesh(vizlight.relief_shadow(field(), scene, lit=True), scene=scene)
    assert "at the points" in plotter.vizlight.explain(actor)


def test_a_page_casts_the_shadow_of_a_lamp_that_its_reader_moves(opened, tmp_path):
    scenes = [Scene(lights=[LAMPS[name]]) for name in ("far", "low")]
    first, then = (vizlight.relief_shadow(field(), scene, lit=True) for scene in scenes)
    path = vizlight.live_html(
        first, tmp_path / "a.html", light="fragments", camera=camera(), panel=False, key=False
    )
    side = COUNT * PIXELS
    page, _ = opened(path, viewport={"width": side, "height": side})
    way = list(scenes[1].lights[0].direction)
    for lit, move in ((first, "0"), (then, f"vizlight.lamps[0].value = {way}")):
        page.evaluate(f"() => {{ {move}; vizlight.draw(); }}")
        shown = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
        assert np.abs(at_nodes(shown) - levels(lit)).max() <= 2
