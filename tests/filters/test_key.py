"""Keys: the colours that the light gives the directions they stand for."""

import numpy as np
import pytest
import pyvista as pv
from lamps import SHINY, shiny
from refusals import refusals

from vizlight import Light, Scene, View, engine, maps, presets
from vizlight.filters.key import BAR, HOLE, question_of
from vizlight.shading.display import displayable

VIEW = View(direction=(2, -1, 0.5))


def found(mesh, x, y):
    """Return the colour of the point next to a place."""
    near = np.argmin(np.hypot(mesh.points[:, 0] - x, mesh.points[:, 1] - y))
    return mesh["rgb"][near].astype(int), mesh.points[near].astype(float)


def light(scene, vector, *, surface=False, **options):
    """Return bytes of the light of a vector in the frame of the eye of VIEW."""
    world = np.asarray([vector]) @ VIEW.axes()
    given = {"normals": world} if surface else {}
    lit = engine.shade(0 * world, None if surface else world, scene, **given, **options)
    rgb = np.broadcast_to(lit.luminance[:, None], (1, 3)) if lit.rgb is None else lit.rgb
    return np.rint(255 * displayable(rgb))[0]


@pytest.mark.parametrize("exponent", ["compensated", 2])
def test_the_disc_shows_tangents_of_the_screen(exponent):
    scene = presets.direction(VIEW)
    disc = presets.key(scene, exponent=exponent)
    radii = np.hypot(*disc.points[:, :2].T)
    assert radii.min() == pytest.approx(HOLE)
    assert radii.max() == pytest.approx(1)
    for x, y in ((1, 0), (0.5, 0.5), (-0.2, 0.7)):
        color, at = found(disc, x, y)
        np.testing.assert_allclose(color, light(scene, at, exponent=exponent), atol=1)
    assert list(disc.field_data["words"]) == ["direction on the screen"]


def test_the_bar_runs_from_across_to_toward_the_eye():
    scene = presets.slope(VIEW)
    bar = presets.key(scene)
    assert bar.bounds == pytest.approx((-1, 1, -BAR, BAR, 0, 0))
    for x in (-1, 0, 1):
        angle = (x + 1) * np.pi / 4
        color, _ = found(bar, x, 0)
        expected = light(scene, (np.cos(angle), 0, np.sin(angle)))
        np.testing.assert_allclose(color, expected, atol=1)


@pytest.mark.parametrize("name", ["heading", "shape"])
def test_the_ball_shows_what_points_outward(name):
    scene = getattr(presets, name)(VIEW)
    ball = presets.key(scene)
    for x, y in ((0, 0), (0.6, -0.3), (-0.9, 0.1)):
        color, (x, y, _) = found(ball, x, y)
        outward = (x, y, np.sqrt(max(1 - x * x - y * y, 0)))
        expected = light(scene, outward, surface=name == "shape")
        np.testing.assert_allclose(color, expected, atol=1)


def test_values_have_their_colours_in_least_and_full_light():
    bar = presets.key(presets.value(), cmap="viridis")
    full, _ = found(bar, 1, BAR)
    least, _ = found(bar, 1, -BAR)
    np.testing.assert_array_equal(full, (253, 231, 36))
    np.testing.assert_allclose(least, 0.3 * full, atol=1)
    assert not np.array_equal(presets.key(presets.value())["rgb"], bar["rgb"])


def test_questions_are_those_of_the_preset():
    for name in ("direction", "slope", "heading", "shape", "value"):
        assert question_of(getattr(presets, name)(VIEW)) == name
    own = Scene(lights=Light(direction=(1, 2, 3)), view=VIEW, material=SHINY)
    assert question_of(own) == "shape"
    assert presets.key(own, question="direction").n_points == presets.key(own).n_points


def test_fixed_lights_and_highlights_are_as_the_eye_has_them():
    scene = Scene(lights=Light(direction=(1, 2, 3)), view=VIEW, material=shiny(shininess=5))
    color, (x, y, _) = found(presets.key(scene), 0.3, -0.4)
    outward = (x, y, np.sqrt(1 - x * x - y * y))
    np.testing.assert_allclose(color, light(scene, outward, surface=True), atol=1)


def test_conditioned_tangents_lie_in_a_surface_that_faces_the_eye():
    scene = Scene(lights=Light(direction=(1, 0, 1), follows_view=True), view=VIEW, material=SHINY)
    free = presets.key(scene, question="direction")["rgb"]
    bound = presets.key(scene, question="direction", conditioned=True)["rgb"]
    assert (bound <= free).all()
    assert (bound < free).any()


test_bad_input = refusals(
    lambda scene, question: presets.key(scene, question=question),
    (Scene(lights=Light(position=(1, 2, 3))), None, "scene: expected lights at infinity for a key"),
    (Scene(), "colour", "question: expected 'direction', 'slope'"),
    (None, None, r"scene: expected a vizlight\.Scene", TypeError),
    (
        Scene(lights=Light(direction=(1, 2, 3)), view=View(position=(1, 2, 3))),
        None,
        "view: expected a view with a direction",
    ),
)


def test_the_key_of_a_scene_without_lamps_has_one_colour():
    dark = presets.key(Scene(lights=[], view=VIEW, material=SHINY))["rgb"]
    assert np.unique(dark).size == 1


def test_the_bar_of_a_lookup_table_has_its_ends_and_a_title():
    table = pv.LookupTable("viridis", scalar_range=(-1, 250))
    bar = presets.key(presets.value(VIEW), cmap=table, title="m/s")
    assert list(bar.field_data["words"]) == ["-1", "250"]
    assert bar.field_data["title"][0] == "m/s"
    np.testing.assert_allclose(bar.field_data["range"], (-1, 250))
    np.testing.assert_allclose(found(bar, 1, BAR)[0], (253, 231, 37), atol=1)


def test_the_bar_of_levels_has_steps_there_and_nowhere_else():
    table = maps.bands([1, 2], (0, 4))
    options = {"question": "value", "cmap": table, "clim": (0, 4), "levels": [1, 2]}
    bar = presets.key(presets.value(VIEW), **options)
    assert list(bar.field_data["levels"]) == [1, 2]
    top = bar.points[:, 1] == bar.points[:, 1].max()
    x, rgb = bar.points[top, 0], bar["rgb"][top].astype(int)
    order = np.argsort(x)
    jumps = np.abs(np.diff(rgb[order], axis=0)).sum(axis=1)
    steps = np.sort(x[order][np.argsort(jumps)[-2:]])
    np.testing.assert_allclose(steps, [-0.5, 0], atol=2e-3)
    with pytest.raises(ValueError, match="levels"):
        presets.key(presets.value(VIEW), **options | {"levels": [np.nan]})
    with pytest.raises(ValueError, match="levels: expected numbers that ascend"):
        presets.key(presets.value(VIEW), **options | {"levels": [2, 1]})


@pytest.mark.parametrize("question", ["direction", "slope", "shape"])
def test_the_picture_of_a_key_is_its_mesh(question):
    scene = getattr(presets, question)(VIEW)
    mesh = presets.key(scene)
    seen = presets.key_picture(scene, 64)
    assert seen.shape[1:] == (64, 4)
    tall = seen.shape[0]
    inner = 0
    for row in range(0, tall, 5):
        for column in range(0, 64, 5):
            x, y = (column + 0.5) / 32 - 1, (tall / 2 - row - 0.5) / 32
            if seen[row, column, 3] == 255:
                color, at = found(mesh, x, y)
                assert np.hypot(at[0] - x, at[1] - y) < 0.08
                assert np.abs(seen[row, column, :3] - color).max() <= 24
                inner += 1
            elif question == "shape":
                assert np.hypot(x, y) > 0.95
    assert inner > 20
    assert (seen[tall // 2, 32, 3] == 0) == (question == "direction")


def test_words_may_have_any_letters(tmp_path):
    table = maps.kinds([1, 2])
    table.annotations = {1.0: "Méso", 2.0: "日本"}
    made = presets.key(Scene(), question="value", cmap=table, title="Température (m²/s²)")
    assert str(made.field_data["title"][0]) == "Température (m²/s²)"
    assert [str(name) for name in made.copy().field_data["names"]] == ["Méso", "日本"]
    plane = pv.Plane()
    plane["k"] = np.arange(plane.n_points) % 2 + 1.0
    plotter = pv.Plotter(off_screen=True, window_size=(120, 80))
    plotter.vizlight.add_mesh(plane, scalars="k", cmap=table, show_scalar_bar=False)
    plotter.vizlight.add_key(question="value", cmap=table, title="Température (m²/s²)")
    plotter.screenshot(tmp_path / "a.png")


@pytest.mark.parametrize("options", [{}, {"below_range_color": "gray"}, {"log_scale": True}])
def test_a_bar_says_whether_it_is_logarithmic_and_what_lies_beyond_its_ends(options):
    table = pv.LookupTable("viridis", n_values=16, scalar_range=(0.1, 10.0), **options)
    made = presets.key("value", question="value", cmap=table)
    assert bool(made.field_data["logarithmic"][0]) == ("log_scale" in options)
    assert list(made.field_data["beyond"]) == ["below_range_color" in options, False]


def test_values_below_a_bar_with_a_colour_apart_have_a_swatch():
    table = pv.LookupTable("viridis", scalar_range=(1.0, 4.0))
    plain = presets.key(Scene(), question="value", cmap=table)
    table.below_range_color = "silver"
    apart = presets.key(Scene(), question="value", cmap=table)
    assert plain.bounds[0] == -1
    assert apart.bounds[0] < -1
    swatch = np.asarray(apart.points)[:, 0] < -1
    np.testing.assert_array_equal(np.unique(apart["rgb"][swatch], axis=0), [[192, 192, 192]])
    # One that continues the bar is none.
    table.below_range_color = table.values[0, :3] / 255
    assert presets.key(Scene(), question="value", cmap=table).bounds[0] == -1
