"""Colour times light: PyVista's colours, the law of the light, its record and its scalar bar."""

import matplotlib as mpl
import numpy as np
import pytest
import pyvista as pv
import shapes
from lamps import SHINY, shiny
from refusals import refusals

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.filters.tint import tint, unlit_colors
from vizlight.shading import engine
from vizlight.shading.display import NO_DATA

VIEW = View(direction=(1, 0.3, 0.4))
SCENE = Scene(lights=Light(direction=(1, 1, 1)), view=VIEW, material=SHINY)
#: Light that leaves colours as they are.
WHITE = Scene(
    lights=Light(direction=(1, 1, 1)), material=Material(ambient=1, diffuse=0, specular=0)
)


def ball():
    mesh = shapes.ball()
    mesh["flow"] = np.array(mesh.points) * (1, 2, 3)
    mesh["zone"] = np.digitize(mesh["height"], [-0.3, 0, 0.2])
    return mesh


def with_holes():
    mesh = ball()
    mesh["height"][::7] = np.nan
    return mesh


TABLE = pv.LookupTable("cividis", n_values=12, scalar_range=(-0.2, 0.3))
CONVENTIONS = {
    "default": ("height", {}),
    "name": ("height", {"cmap": "plasma"}),
    "reversed": ("height", {"cmap": "plasma", "flip_scalars": True}),
    "matplotlib": ("height", {"cmap": mpl.colormaps["twilight"]}),
    "colours": ("height", {"cmap": ["red", "white", "blue"]}),
    "table": ("height", {"cmap": TABLE}),
    "few": ("height", {"cmap": "viridis", "n_colors": 5}),
    "clim": ("height", {"cmap": "viridis", "clim": (-0.1, 0.4)}),
    "one end": ("height", {"cmap": "coolwarm", "clim": 0.3}),
    "beyond": (
        "height",
        {"clim": (-0.1, 0.2), "above_color": "red", "below_color": (0.1, 0.9, 0.2)},
    ),
    "nan": ("height", {"nan_color": "magenta", "cmap": "gray"}),
    "vectors": ("flow", {"cmap": "viridis"}),
    "component": ("flow", {"cmap": "viridis", "component": 1}),
    "log": ("flow", {"cmap": "viridis", "log_scale": True, "clim": (0.4, 1.5)}),
}


def drawn_by_pyvista(mesh, name, options):
    """Return the bytes that PyVista's own mapper gives to the points."""
    plotter = pv.Plotter(off_screen=True)
    options = {"cmap": "vizlight.even"} | options
    actor = plotter.add_mesh(mesh.copy(), scalars=name, interpolate_before_map=False, **options)
    mapper = actor.mapper
    values = np.array(mapper.dataset.point_data[mapper.array_name], dtype=float)
    mapped = [mapper.lookup_table.map_value(value) for value in values]
    colors = np.rint(255 * np.array(mapped)).astype(np.uint8)
    return colors[:, :3]


@pytest.mark.opengl
@pytest.mark.parametrize("case", CONVENTIONS)
def test_colours_are_those_of_pyvista(case):
    name, options = CONVENTIONS[case]
    mesh = with_holes() if case == "nan" else ball()
    tinted = tint(vizlight.illuminate(mesh, WHITE), name, **options)
    assert tinted["rgb"].dtype == np.uint8
    np.testing.assert_array_equal(tinted["rgb"], drawn_by_pyvista(mesh, name, options))


def test_the_map_is_the_one_of_data_unless_a_map_or_a_theme_is_chosen(monkeypatch):
    lit = vizlight.illuminate(with_holes(), WHITE)

    def colours(**options):
        return tint(lit, "height", **options)["rgb"]

    even = colours(cmap=vizlight.maps.even)
    np.testing.assert_array_equal(colours(), even)
    assert not np.array_equal(colours(cmap="viridis"), even)
    np.testing.assert_array_equal(even[::7], 128)
    monkeypatch.setattr(pv.global_theme, "cmap", "hot")
    np.testing.assert_array_equal(colours(), colours(cmap="hot"))
    monkeypatch.setattr(pv.global_theme, "nan_color", "red")
    assert {tuple(c) for c in colours()[::7]} == {(255, 0, 0)}


def test_bytes_are_colours():
    mesh = ball()
    mesh["own"] = np.arange(3 * mesh.n_points, dtype=np.uint8).reshape(-1, 3)
    lit = vizlight.illuminate(mesh, WHITE)
    np.testing.assert_array_equal(tint(lit, "own")["rgb"], mesh["own"])
    np.testing.assert_array_equal(tint(lit, np.array(mesh["own"]))["rgb"], mesh["own"])


def test_categories_have_a_colour_each():
    mesh = ball()
    tinted = tint(vizlight.illuminate(mesh, WHITE), "zone", categories=True, cmap="tab10")
    four = pv.LookupTable("tab10", n_values=4).values[:, :3]
    np.testing.assert_array_equal(tinted["rgb"], four[mesh["zone"]])


MATERIALS = {
    "dark": Material(ambient=0.1, diffuse=0.5, specular=0.9),
    "no ambient": Material(ambient=0, diffuse=0.9, specular=0.2),
    "matte": Material(ambient=0.35, diffuse=0.6, specular=0),
    "bright": Material(ambient=0.4, diffuse=1.2, specular=1),
}


@pytest.mark.parametrize("components", [False, True])
@pytest.mark.parametrize("material", MATERIALS)
def test_colour_times_light(components, material):
    """The law itself: the material's highlight is left out, its ambient light is 0.3 or more."""
    mesh = ball()
    material = MATERIALS[material]
    lit = vizlight.illuminate(mesh, SCENE.replace(material=material), components=components)
    got = tint(lit, "height", cmap="viridis", clim=(-0.5, 0.5))["rgb"]
    colors = mpl.colormaps["viridis"]((mesh["height"] + 0.5).astype(float))[:, :3]
    cosine = np.maximum(np.asarray(mesh["Normals"], float) @ np.full(3, 3**-0.5), 0)
    light = np.minimum(max(material.ambient, 0.3) + material.diffuse * cosine, 1)
    # One step of the map, where Matplotlib and VTK round to different sides.
    assert np.abs(got - 255 * colors * light[:, None]).max() < 3
    assert np.abs(got - 255 * colors * light[:, None]).mean() < 0.6


def test_coloured_lights_and_cue_count_by_their_luma():
    """Light on a colour is a share of it, that of the luma of light on white, in 0.3 to 1."""
    scene = Scene(
        lights=[
            Light(direction=(1, 1, 1), color=(1, 0.7, 0.4)),
            Light(position=(0, 2, 1), intensity=0.4, color="skyblue"),
        ],
        material=shiny(ambient=0.3, specular_color=(0.9, 1, 0.8)),
        view=VIEW,
        ambient_color=(0.8, 0.9, 1),
        depth_cue=DepthCue(back_scale=0.4, cue=0.3, color=(0.2, 0.3, 0.9)),
    )
    mesh = ball()
    mesh["same"] = np.zeros(mesh.n_points)
    matte = scene.replace(material=shiny(ambient=0.3, specular=0))
    light = vizlight.illuminate(mesh, matte)["rgb"] @ (0.2126, 0.7152, 0.0722)
    expected = np.clip(light, 0.3, 1)[:, None] * (51, 153, 204)
    got = tint(vizlight.illuminate(mesh, scene), "same", cmap=["#3399cc"] * 2, clim=(-1, 1))["rgb"]
    assert np.abs(got - expected).max() <= 0.5 + 1e-3
    assert light.min() < 0.3 < 0.6 < light.max()


def test_conditioned_tangents_and_blocks():
    mesh = ball()
    mesh["around"] = np.cross(mesh.points, (0.1, 0.2, 1))
    pair = pv.MultiBlock({"a": mesh, "b": mesh.translate((2, 0, 0))})
    lit = vizlight.illuminate(pair, SCENE, tangents="around", conditioned=True)
    both = tint(lit, "height")
    single = tint(vizlight.illuminate(mesh, SCENE, tangents="around", conditioned=True), "height")
    np.testing.assert_array_equal(both["a"]["rgb"], single["rgb"])
    assert "rgb" not in lit["a"].point_data
    assert mesh.vizlight.illuminate(SCENE).vizlight.tint("height")["rgb"].shape == (530, 3)


def test_range_of_colours_is_common_to_all_blocks():
    low, high = ball(), ball()
    high["height"] = np.array(high["height"]) + 10
    lit = vizlight.illuminate(pv.MultiBlock({"low": low, "high": high}), SCENE)
    tinted = tint(lit, "height")
    assert unlit_colors(tinted["low"]).scalar_range == pytest.approx((-0.5, 10.5), abs=0.01)


def test_record_makes_the_unlit_colours_again(tmp_path):
    lit = vizlight.illuminate(ball(), SCENE)
    options = {"clim": (-0.1, 0.2), "above_color": "red", "nan_color": "black", "n_colors": 9}
    tinted = tint(lit, "height", cmap="magma", **options)
    tinted.save(tmp_path / "tinted.vtp")
    read = pv.read(tmp_path / "tinted.vtp")
    np.testing.assert_array_equal(read["rgb"], tinted["rgb"])
    record = vizlight.provenance(read, "rgb")
    assert (record["filter"], record["options"]["scalars"]) == ("tint", "height")
    table = unlit_colors(read)
    np.testing.assert_array_equal(table.values, pv.LookupTable("magma", n_values=9).values)
    assert table.scalar_range == (-0.1, 0.2)
    assert table.above_range_color == pv.Color("red")
    assert table.below_range_color is None
    assert table.nan_color == pv.Color("black")
    assert read["luminance"].shape == (read.n_points,)


def test_result_replaces_the_one_before_and_no_array_of_the_user():
    lit = vizlight.illuminate(ball(), SCENE)
    first = tint(lit, "height", cmap="viridis")
    again = tint(first, "height", cmap="hot", inplace=True)
    assert again is first
    assert not np.array_equal(again["rgb"], tint(lit, "height", cmap="viridis")["rgb"])
    mine = lit.copy()
    mine["rgb"] = np.zeros((mine.n_points, 3))
    with pytest.raises(ValueError, match="name: expected one under which the mesh has no array"):
        tint(mine, "height")
    assert "shade" in tint(mine, "height", name="shade").point_data


@pytest.mark.parametrize(
    ("material", "components", "runs"), [("matte", False, 0), ("dark", True, 0), ("dark", False, 1)]
)
def test_light_is_computed_at_most_once(material, components, runs, calls_of):
    """Not at all where the mesh carries it."""
    scene = SCENE.replace(material=MATERIALS[material])
    lit = vizlight.illuminate(ball(), scene, components=components)
    calls = calls_of(engine, "run")
    tint(lit, "height")
    assert len(calls) == runs


@pytest.mark.parametrize("components", [False, True])
def test_points_without_light_have_the_colour_of_no_data(components):
    mesh = ball()
    mesh["V"] = np.array(mesh.points)
    mesh["V"][:10] = 0
    with pytest.warns(UserWarning, match="10 of 530"):
        lit = vizlight.illuminate(mesh, SCENE, tangents="V", components=components)
    got = tint(lit, "height", cmap=["white", "white"])["rgb"]
    np.testing.assert_array_equal(got[:10], np.rint(np.multiply(NO_DATA, 255))[None].repeat(10, 0))
    assert not np.any(got[10:] == 128)


def test_the_result_shares_all_else():
    lit = vizlight.illuminate(ball(), SCENE)
    tinted = tint(lit, "height")
    assert np.shares_memory(tinted.points, lit.points)
    assert np.shares_memory(tinted["luminance"], lit["luminance"])
    assert "rgb" not in lit.point_data
    assert lit.point_data.active_scalars_name == "luminance"


def test_empty_mesh():
    lit = vizlight.illuminate(pv.PolyData(), SCENE, tangents=np.zeros((0, 3)), components=True)
    assert tint(lit, np.zeros(0))["rgb"].shape == (0, 3)


def lit_ball(**options):
    mesh = ball()
    mesh["word"] = np.array(["a"] * mesh.n_points)
    mesh["wave"] = np.exp(1j * mesh.points[:, 0])
    return vizlight.illuminate(mesh, SCENE, **options)


def moved():
    mesh = lit_ball()
    mesh["Normals"][:] = mesh["Normals"][::-1].copy()
    return mesh


test_bad_input = refusals(
    lambda make, scalars, options: tint(make(), scalars, **options),
    (ball, "height", {}, "lit: expected a mesh with the light of a filter"),
    (lit_ball, "hight", {}, "scalars: expected a point array"),
    (lit_ball, None, {}, "scalars: expected the name of a point array"),
    (lit_ball, np.zeros(3), {}, "scalars: expected 530 rows"),
    (lit_ball, "height", {"cmap": "viridi"}, "cmap: expected a colour map"),
    (lit_ball, "height", {"clim": (1, 0)}, "clim: expected a lower and a higher number"),
    (lit_ball, "height", {"n_colors": 0}, "n_colors: expected an integer of at least 1"),
    (lit_ball, "flow", {"component": 3}, "component: expected one of 3 components"),
    (lit_ball, "height", {"name": ""}, "name: expected a name"),
    (lit_ball, "height", {"light": "glow"}, "lit: expected a mesh with the light"),
    (lambda: "ball.vtp", "height", {}, "mesh: expected a PyVista mesh", TypeError),
    (lit_ball, "word", {}, "scalars: expected real numbers", TypeError),
    (lit_ball, "wave", {}, r"real numbers.*attach numbers, such as np\.abs\(values\)", TypeError),
    (
        lambda: lit_ball(tangents=np.array(ball().points)),
        "height",
        {},
        "attach the array and name it by tangents=",
    ),
    (moved, "height", {}, "light it again"),
)


def test_colours_of_no_data_have_no_table():
    with pytest.raises(ValueError, match="expected the result of tint"):
        unlit_colors(vizlight.illuminate(ball(), SCENE, name="rgb"))


@pytest.mark.parametrize("strips", [False, True])
def test_cells_have_one_colour_each_under_smooth_light(strips):
    mesh = ball()
    mesh = mesh.strip() if strips else mesh
    mesh.cell_data["rank"] = np.arange(mesh.n_cells) * 10 // mesh.n_cells
    lit = vizlight.illuminate(mesh, SCENE)
    colored = tint(lit, "rank", cmap="viridis")
    table = unlit_colors(colored)
    # Points are shared within a rank.
    assert mesh.n_points < colored.n_points < 1.7 * mesh.n_points
    assert table.scalar_range == (0, mesh.cell_data["rank"].max())
    assert "luminance" in vizlight.mesh.records.made(colored, "luminance")
    faces = colored.regular_faces
    unlit = table.map_value(3, opacity=False)
    inside = np.unique(faces[colored.cell_data["rank"] == 3])
    share = colored["rgb"][inside] / (255 * np.array(unlit[:3]))
    np.testing.assert_allclose(share, share[:, :1].repeat(3, axis=1), atol=0.03)
    # The light is that of the smooth surface, which is lit again without its highlight.
    mesh["one"] = np.full(mesh.n_points, 3.0)
    even = tint(vizlight.illuminate(mesh, SCENE), "one", cmap="viridis", clim=table.scalar_range)
    own = inside[inside < mesh.n_points]
    assert np.array_equal(colored["rgb"][own], even["rgb"][own])
    del mesh.point_data["Normals"]
    rough = tint(vizlight.illuminate(mesh, SCENE), "rank", cmap="viridis")
    again = vizlight.illuminate(rough, SCENE)
    np.testing.assert_allclose(again["luminance"], rough["luminance"], atol=1e-5)
    place = lit.copy(deep=False)
    tint(place, "rank", cmap="viridis", inplace=True)
    assert np.array_equal(place["rgb"], colored["rgb"])


@pytest.mark.filterwarnings("ignore:.*sharper than")
@pytest.mark.parametrize("kind", ["surface", "grid", "image"])
def test_colours_of_cells_are_no_values(kind):
    mesh = ball() if kind == "surface" else pv.ImageData(dimensions=(4, 4, 2))
    mesh = mesh.cast_to_unstructured_grid() if kind == "grid" else mesh
    mesh.cell_data["red"] = np.tile(np.array([255, 0, 0], np.uint8), (mesh.n_cells, 1))
    rgb = tint(vizlight.illuminate(mesh, SCENE), "red")["rgb"]
    assert rgb[:, 0].min() >= 76
    assert rgb[:, 1:].max() == 0


@pytest.mark.filterwarnings("ignore:.*sharper than")
@pytest.mark.parametrize("kind", [pv.ImageData, pv.UnstructuredGrid])
def test_labels_of_cells_have_nothing_in_between(kind):
    mesh = pv.ImageData(dimensions=(5, 3, 2))
    mesh.cell_data["label"] = np.where(mesh.cell_centers().points[:, 0] < 2, 1, 3)
    mesh = mesh.cast_to_unstructured_grid() if kind is pv.UnstructuredGrid else mesh
    lit = vizlight.illuminate(mesh, SCENE)
    colored = tint(lit, "label", cmap=["red", "lime", "blue"], clim=(1, 3))
    # Averages would be lime, which is 2.
    assert colored["rgb"][:, 1].max() == 0
    assert colored.n_points == mesh.n_points + 6 * (kind is pv.UnstructuredGrid)
    assert np.array_equal(colored.points[: mesh.n_points], mesh.points)


@pytest.mark.parametrize("kind", ["image", "structured_grid", "rectilinear_grid"])
def test_colours_of_cells_of_grids_stay_apart(kind):
    grid = pv.ImageData(dimensions=(4, 3, 1))
    grid = grid if kind == "image" else getattr(grid, f"cast_to_{kind}")()
    colors = np.zeros((6, 3), np.uint8)
    colors[::2, 0] = colors[1::2, 2] = 255
    grid.cell_data["ground"] = colors
    tinted = tint(vizlight.illuminate(grid, WHITE), "ground")
    assert {*map(tuple, np.asarray(tinted["rgb"]))} == {(255, 0, 0), (0, 0, 255)}
    assert type(tint(vizlight.illuminate(grid, WHITE), "ground", inplace=True)) is type(grid)
