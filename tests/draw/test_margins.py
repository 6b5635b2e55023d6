"""Words of scalar bars in the picture; keys in the margin: their colours and their places."""

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import View, presets
from vizlight.draw import margins, render

pytestmark = pytest.mark.opengl
SIZE = (400, 300)
NAME = "a rather long name of a field [kg m-2 s-1]"


def picture(size=SIZE, keys=1, **options):
    """Return pictures with and without keys of a plane that fills its part, and the key."""
    seen = []
    for count in (0, keys):
        plotter = pv.Plotter(off_screen=True, window_size=size)
        plotter.background_color = "black"
        scene = presets.shape()
        plotter.vizlight.add_mesh(pv.Plane(i_size=9, j_size=9), scene=scene)
        plotter.view_xy()
        plotter.camera.zoom(4)
        made = [plotter.vizlight.add_key(**options) for _ in range(count)]
        seen.append(np.asarray(plotter.screenshot(return_img=True)).astype(int))
    return seen[1], made[-1]


def margin_of(size, key=0.15):
    """Return the columns and the rows that the margin leaves to the data, without a title."""
    share = margins.data_share(size, key, titled=False)
    return int(size[0] * share[0]), int(size[1] * share[1])


@pytest.mark.parametrize("size", [(400, 300), (300, 400), (900, 600)])
def test_the_key_stands_in_a_margin_and_the_data_in_the_rest(size):
    seen, made = picture(size)
    wide, high = margin_of(size)
    # The plane fills the part of the data; beside it is the ground.
    data = seen[: high - 2, : wide - 2]
    assert data.min() > 60
    plate = seen[:, wide + 2 :] if wide < size[0] else seen[high + 2 :]
    assert plate[2, 2].max() == 0
    # The middle of the ball, which has one colour, the lightest.
    lightest = made["rgb"][np.argmin(np.hypot(*made.points[:, :2].T))].astype(int)
    assert (np.abs(plate - lightest).max(axis=2) <= 3).any()


def test_a_title_alone_leaves_the_data_the_whole_width():
    table = vizlight.maps.kinds({0: " "})
    seen, _ = picture(question="value", cmap=table, title="Cow", lying=True)
    assert (seen[100] > 60).all()
    assert (seen[-1] > 60).all()
    # Above it the title is on the ground of the picture.
    band = seen[: int(margins.band_share(SIZE) * SIZE[1]) - 1]
    assert np.median(band) == 0 < band.max()


def test_a_wide_word_above_a_bar_stays_in_the_picture():
    mesh = pv.Sphere()
    mesh["Wwwmmmmwww"] = mesh.points[:, 2]
    look = vizlight.look(mesh, size=(600, 400))
    plotter = look.plotter()
    seen = plotter.screenshot(return_img=True).astype(int)
    plotter.close()
    assert (np.abs(seen[:, -5:] - 255) < 2).all()


def test_keys_stack_in_the_margin():
    one, _ = picture(keys=1)
    three, _ = picture(keys=3)
    wide, _ = margin_of(SIZE)
    rows = [
        np.ptp(np.nonzero((seen[:, wide + 2 :] > 60).any(axis=(1, 2)))[0]) for seen in (one, three)
    ]
    assert rows[1] > 1.5 * rows[0]


@pytest.mark.parametrize(
    ("title", "parts"),
    [
        ("air_pressure (hPa); lines every 4 hPa", ("Air pressure; lines every 4 hPa", "hPa")),
        ("u,v (m/s)", ("u,v", "m/s")),
        ("T", ("T", "")),
        ("dT_dz (no sign)", ("dT dz", "no sign")),
        ("flow (in) the pipe", ("Flow (in) the pipe", "")),
        ("", ("", "")),
    ],
)
def test_the_unit_of_a_title_stands_apart(title, parts):
    assert margins.parted(title) == parts


def test_words_of_a_key_take_few_lines():
    key = margins.MarginKey(presets.key(presets.shape()), 0.15, (0, 0, 0), lying=False)
    # Of a picture of 1200 by 800 pixels.
    key.fit(800, margins.LETTERS * 800, 120, 0, alone=True)
    assert key._lines == ["the way", "it faces"]
    # In a narrow column no word is broken: its letters become smaller.
    key = margins.MarginKey(presets.key(presets.direction()), 0.15, (0, 0, 0), lying=False)
    key.fit(1200, margins.LETTERS * 1200, 130, 0, alone=True)
    assert " ".join(key._lines) == "direction on the screen"


def test_long_names_of_kinds_are_in_two_lines_within_the_picture():
    long = {0: "shale", 1: "a group of some sandstones and of many other rocks beside them"}
    sizes = []
    for names in (long, {0: "shale", 1: "a group of some"}):
        plotter = pv.Plotter(off_screen=True, window_size=(1200, 800))
        plotter.vizlight.add_mesh(pv.Plane(), scene=presets.shape())
        plotter.vizlight.add_key(question="value", cmap=vizlight.maps.kinds(names))
        seen = plotter.screenshot(return_img=True)
        assert (seen[:, -1] == 255).all()
        texts = [actor for actor in plotter.renderer.GetViewProps() if actor.IsA("vtkTextActor")]
        sizes.append(max(actor.GetTextProperty().GetFontSize() for actor in texts))
    # Letters beside a long name are nearly as large as beside a short one.
    assert sizes[0] > 0.8 * sizes[1]


def test_words_of_a_bar_that_do_not_fit_are_left_out_evenly():
    places = [0.1 * i for i in range(11)]
    assert all(margins._thinned(places, 0.0, 11))
    # Zero is at 0.3.
    kept = margins._thinned(places, 0.3, 6)
    assert [i for i, shown in enumerate(kept) if shown] == [1, 3, 5, 7, 9]


def test_decimals_that_are_0_in_all_words_of_a_bar_are_left_out():
    bar = presets.key(vizlight.Scene(), cmap="Reds", clim=(0, 2), levels=[0, 0.5, 1, 1.5, 2])
    key = margins.MarginKey(bar, 0.15, (0, 0, 0), lying=True)
    for width, words in ((300, "0.0 0.5 1.0 1.5 2.0"), (60, "0 1 2")):
        key.lay((0, width), 50, 12)
        assert " ".join(filter(None, (label.GetInput() for label in key._labels))) == words


@pytest.mark.parametrize("size", [(300, 200), (900, 600)])
def test_the_title_is_above_a_map_and_its_bar_as_tall(size):
    plotter = pv.Plotter(off_screen=True, window_size=size)
    plotter.vizlight.add_mesh(pv.Plane(i_size=3, j_size=1), color="blue", lighting=False)
    bar = {"question": "value", "cmap": "Reds", "clim": (0, 3), "levels": [1, 2]}
    plotter.vizlight.add_key(presets.shape(), title="rise (m)", **bar)
    share = margins.data_share(size, 0.15)
    aspect = size[0] * share[0] / (size[1] * share[1])
    plotter.camera = render.camera_on(plotter.meshes[0], (0, 0, 1), parallel=True, aspect=aspect)
    seen = plotter.screenshot(return_img=True).astype(int)
    wide = int(size[0] * share[0])
    blue = np.flatnonzero((seen[:, :wide, 2] - seen[:, :wide, 0] > 60).any(axis=1))
    red = np.flatnonzero((seen[:, wide:, 0] - seen[:, wide:, 2] > 40).any(axis=1))
    ink = np.flatnonzero((seen[:, :wide].max(axis=2) < 90).any(axis=1))
    # Words end above the map, not far from it; the lightest red of the bar counts as none.
    assert ink.max() < blue.min() < ink.max() + 2.2 * margins.LETTERS * min(size)
    assert abs(red.min() - blue.min()) <= 2
    assert red.max() <= blue.max() + 2


def test_a_bar_that_lies_is_below_a_map_and_as_wide():
    size, plotter = (600, 400), pv.Plotter(off_screen=True, window_size=(600, 400))
    plotter.vizlight.add_mesh(pv.Plane(i_size=6, j_size=2), color="blue", lighting=False)
    bar = {"question": "value", "cmap": "Reds", "clim": (0, 3), "levels": [0, 1, 2, 3]}
    plotter.vizlight.add_key(presets.shape(), title="rise (m)", lying=True, **bar)
    share = margins.data_share(size, 0.15, lying=True)
    assert share[0] == 1
    aspect = size[0] / (size[1] * share[1])
    plotter.camera = render.camera_on(plotter.meshes[0], (0, 0, 1), parallel=True, aspect=aspect)
    seen = plotter.screenshot(return_img=True).astype(int)
    blue = np.argwhere(seen[..., 2] - seen[..., 0] > 60)
    red = np.argwhere(seen[..., 0] - seen[..., 2] > 40)
    # The map leaves room below it, which the bar takes; the lightest red counts as none.
    letters = margins.LETTERS * min(size)
    assert blue[:, 0].max() < red[:, 0].min() < blue[:, 0].max() + 2 * letters
    assert red[:, 1].max() == pytest.approx(blue[:, 1].max(), abs=2)
    assert np.ptp(red[:, 0]) < letters
    # A second key stands at the right, with the first.
    plotter.vizlight.add_key(presets.shape(), **bar)
    plotter.render()
    seen = plotter.screenshot(return_img=True).astype(int)
    red = np.argwhere(seen[..., 0] - seen[..., 2] > 40)
    assert red[:, 1].min() > size[0] * margins.data_share(size, 0.15)[0]


def test_numbers_below_the_ends_of_a_bar_are_whole():
    size, plotter = (600, 400), pv.Plotter(off_screen=True, window_size=(600, 400))
    plotter.vizlight.add_mesh(pv.Plane(i_size=6, j_size=2), color="blue", lighting=False)
    bar = {"question": "value", "cmap": "Reds", "clim": (0, 3e5), "levels": [0, 1e5, 2e5, 3e5]}
    plotter.vizlight.add_key(presets.shape(), title="rise (m)", lying=True, **bar)
    aspect = size[0] / (size[1] * margins.data_share(size, 0.15, lying=True)[1])
    plotter.camera = render.camera_on(plotter.meshes[0], (0, 0, 1), parallel=True, aspect=aspect)
    seen = plotter.screenshot(return_img=True)
    ink = np.flatnonzero((seen[size[1] // 2 :].max(axis=2) < 90).any(axis=0))
    assert 4 < ink.min() < ink.max() < size[0] - 4


def test_a_bar_stands_right_beside_a_narrow_map():
    size, plotter = (600, 400), pv.Plotter(off_screen=True, window_size=(600, 400))
    plotter.vizlight.add_mesh(pv.Plane(i_size=1, j_size=3), color="blue", lighting=False)
    bar = {"question": "value", "cmap": "Reds", "clim": (0, 3)}
    plotter.vizlight.add_key(presets.shape(), title="rise (m)", **bar)
    plotter.camera = render.camera_on(plotter.meshes[0], (0, 0, 1), parallel=True, aspect=1.4)
    seen = plotter.screenshot(return_img=True).astype(int)
    blue = np.argwhere(seen[..., 2] - seen[..., 0] > 60)
    red = np.argwhere(seen[..., 0] - seen[..., 2] > 40)
    assert blue[:, 1].max() < red[:, 1].min() < blue[:, 1].max() + 0.1 * size[0]


def test_a_disc_does_not_lie():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    with pytest.raises(ValueError, match="lying: expected False for a key that is a disc"):
        plotter.vizlight.add_key(presets.shape(), lying=True)
    plotter.close()


def test_the_key_of_the_live_light_has_its_exponent():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    line = pv.Line(resolution=4)
    with pytest.raises(ValueError, match="scene: expected a scene, or a mesh with live light"):
        plotter.vizlight.add_key()
    plotter.vizlight.add_mesh(line, scene=presets.direction(), exponent=2)
    made = plotter.vizlight.add_key()
    expected = presets.key(presets.direction(View(direction=(1, 1, 1))), exponent=2)
    np.testing.assert_array_equal(made["rgb"], expected["rgb"])
    assert (made["rgb"] != presets.key(presets.direction())["rgb"]).any()


@pytest.mark.parametrize("valued", [True, False])
def test_the_default_light_has_the_key_of_what_it_shows(valued):
    ball = pv.Sphere()
    ball["speed"] = np.linspace(2, 5, ball.n_points)
    ball["speed"][7] = np.nan
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    given = {"scalars": "speed", "cmap": "viridis"} if valued else {"color": "white"}
    plotter.vizlight.add_mesh(ball, show_scalar_bar=False, **given)
    made = plotter.vizlight.add_key()
    words = ["2", "5"] if valued else ["the way it faces"]
    assert list(made.field_data["words"]) == words
    if valued:
        assert made.field_data["title"][0] == "speed (grey: no data)"
        expected = presets.key(vizlight.Scene(), cmap="viridis", clim=(2, 5))
        np.testing.assert_array_equal(made["rgb"], expected["rgb"])


def test_pictures_have_keys():
    ball = vizlight.illuminate(pv.Sphere(), presets.shape())
    key = presets.key(presets.shape())
    options = {"size": SIZE, "scalars": "rgb", "background": "black"}
    plain, keyed = (next(iter(render.pictures([ball], key=one, **options))) for one in (None, key))
    wide, _ = margin_of(SIZE)
    # The data have moved to the left of the plate, on which the key stands.
    assert (plain[:, wide + 2 :] == 0).all() or (plain != keyed).any()
    assert (keyed[:, wide + 2 :].astype(int).max(axis=2) > 100).sum() > 0.8 * np.pi * 22**2


@pytest.mark.parametrize(
    ("name", "words"),
    [("CT_AVM = 64", "CT_AVM = 64"), ("P_XPM_0331", "P_XPM_0331"), ("air_temp", "Air temp"),
     ("U_mean", "U mean"), ("_x_", "x"), ("von_mises", "Von Mises")],
)  # fmt: skip
def test_names_in_capitals_are_as_they_are(name, words):
    assert margins.written(name) == words


def test_a_key_in_a_view_without_data_stands_in_its_middle():
    plotter = pv.Plotter(off_screen=True, shape=(1, 2), window_size=(600, 300), border=False)
    plotter.set_background("black", all_renderers=True)
    plotter.add_mesh(pv.Sphere(), color="black", lighting=False)
    plotter.subplot(0, 1)
    plotter.vizlight.add_key(presets.shape(), size=0.5)
    picture = plotter.screenshot(return_img=True).max(axis=2)
    plotter.close()
    columns, rows = np.flatnonzero(picture.any(axis=0)), np.flatnonzero(picture.any(axis=1))
    assert columns[0] > 300
    assert abs(columns[[0, -1]].mean() - 450) < 3
    # The disc has its words below it.
    assert abs(rows[[0, -1]].mean() - 150) < 12


def test_the_rim_of_a_disc_is_a_smooth_circle():
    plotter = pv.Plotter(off_screen=True, window_size=(300, 300), border=False)
    plotter.set_background("black")
    white = vizlight.Scene(material=vizlight.Material(ambient=1, diffuse=0, specular=0))
    plotter.vizlight.add_key(white, question="shape", size=0.5)
    picture = plotter.screenshot(return_img=True)[:, :, 0] / 255
    plotter.close()
    top = np.flatnonzero(picture.max(axis=1))[0]
    disc = picture[top : top + 153]
    # Half of the pixel in which it fades belongs to it.
    assert disc.sum() == pytest.approx(np.pi * 75.5**2, rel=0.003)
    assert np.sum((disc > 0.05) & (disc < 0.95)) > 300
