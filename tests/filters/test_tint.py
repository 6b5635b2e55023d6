"""Colour times light: PyVista's colours, the law of the light, its record and its scalar bar."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import DepthCue, Light, Material, Scene, View
from vizlight.filters.tint import displayable, tint, unlit_colors
from vizlight.shading import formulas

VIEW = View(direction=(1, 0.3, 0.4))
SCENE = Scene(lights=Light(direction=(1, 1, 1)), view=VIEW)
#: Light that leaves colours as they are.
WHITE = Scene(
    lights=Light(direction=(1, 1, 1)), material=Material(ambient=1, diffuse=0, specular=0)
)


def ball(count=24):
    mesh = pv.Sphere(theta_resolution=count, phi_resolution=count)
    mesh["height"] = np.array(mesh.points[:, 2])
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
    actor = plotter.add_mesh(mesh.copy(), scalars=name, interpolate_before_map=False, **options)
    mapper = actor.mapper
    values = np.array(mapper.dataset.point_data[mapper.array_name], dtype=float)
    mapped = [mapper.lookup_table.map_value(value) for value in values]
    colors = np.rint(255 * np.array(mapped)).astype(np.uint8)
    plotter.close()
    return colors[:, :3]


@pytest.mark.opengl
@pytest.mark.parametrize("case", CONVENTIONS)
def test_colours_are_those_of_pyvista(case):
    name, options = CONVENTIONS[case]
    mesh = with_holes() if case == "nan" else ball()
    tinted = tint(vizlight.illuminate(mesh, WHITE), name, **options)
    assert tinted["rgb"].dtype == np.uint8
    np.testing.assert_array_equal(tinted["rgb"], drawn_by_pyvista(mesh, name, options))


def test_categories_have_a_colour_each():
    mesh = ball()
    tinted = tint(vizlight.illuminate(mesh, WHITE), "zone", categories=True, cmap="tab10")
    four = pv.LookupTable("tab10", n_values=4).values[:, :3]
    np.testing.assert_array_equal(tinted["rgb"], four[mesh["zone"]])


@pytest.mark.parametrize("components", [False, True])
def test_colour_times_light(components):
    mesh = ball()
    terms = vizlight.illuminate(mesh, SCENE, components=True)
    lit = terms if components else vizlight.illuminate(mesh, SCENE)
    got = tint(lit, "height", cmap="viridis", clim=(-0.5, 0.5))["rgb"]
    colors = mpl.colormaps["viridis"]((mesh["height"] + 0.5).astype(float))[:, :3]
    light = (terms["ambient"] + terms["diffuse"])[:, None]
    expected = 255 * displayable(colors * light + terms["specular"][:, None])
    # One step of the map, where Matplotlib and VTK round to different sides.
    assert np.abs(got - expected).max() < 3
    assert np.abs(got - expected).mean() < 0.6


def test_coloured_lights_and_cue_are_those_of_the_engine():
    """Light on a constant colour is the array rgb of a material of that colour."""
    scene = Scene(
        lights=[
            Light(direction=(1, 1, 1), color=(1, 0.7, 0.4)),
            Light(position=(0, 2, 1), intensity=0.4, color="skyblue"),
        ],
        material=Material(specular_color=(0.9, 1, 0.8)),
        view=VIEW,
        ambient_color=(0.8, 0.9, 1),
        depth_cue=DepthCue(back_scale=0.4, cue=0.3, color=(0.2, 0.3, 0.9)),
    )
    mesh = ball()
    mesh["same"] = np.zeros(mesh.n_points)
    own = (51 / 255, 153 / 255, 204 / 255)
    painted = scene.replace(material=Material(color=own, specular_color=(0.9, 1, 0.8)))
    expected = vizlight.illuminate(mesh, painted)["rgb"]
    got = tint(vizlight.illuminate(mesh, scene), "same", cmap=["#3399cc"] * 2, clim=(-1, 1))["rgb"]
    assert np.abs(got - 255 * displayable(expected)).max() <= 0.5 + 1e-3


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


def test_points_without_light_have_the_ambient_one():
    mesh = ball()
    mesh["V"] = np.array(mesh.points)
    mesh["V"][:10] = 0
    with pytest.warns(UserWarning, match="10 of 530"):
        lit = vizlight.illuminate(mesh, SCENE, tangents="V")
    tinted = tint(lit, "height", cmap=["white", "white"])
    assert set(np.unique(tinted["rgb"][:10])) == {26}


def test_empty_mesh():
    lit = vizlight.illuminate(pv.PolyData(), SCENE, tangents=np.zeros((0, 3)), components=True)
    assert tint(lit, np.zeros(0))["rgb"].shape == (0, 3)


def test_bad_input():
    mesh = ball()
    lit = vizlight.illuminate(mesh, SCENE)
    for arguments, options, text in (
        ((mesh, "height"), {}, "lit: expected a mesh with the light of a filter"),
        ((lit, "hight"), {}, "scalars: expected a point array"),
        ((lit,), {}, "scalars: expected the name of a point array"),
        ((lit, np.zeros(3)), {}, "scalars: expected 530 rows"),
        ((lit, "height"), {"cmap": "viridi"}, "cmap: expected a colour map"),
        ((lit, "height"), {"clim": (1, 0)}, "clim: expected a lower and a higher number"),
        ((lit, "height"), {"n_colors": 0}, "n_colors: expected an integer of at least 1"),
        ((lit, "flow"), {"component": 3}, "component: expected one of 3 components"),
        ((lit, "height"), {"name": ""}, "name: expected a name"),
        ((lit, "height"), {"light": "glow"}, "lit: expected a mesh with the light"),
    ):
        with pytest.raises(ValueError, match=text):
            tint(*arguments, **options)
    with pytest.raises(TypeError, match="mesh: expected a PyVista mesh"):
        tint("ball.vtp", "height")
    words = lit.copy()
    words["word"] = np.array(["a"] * words.n_points)
    with pytest.raises(TypeError, match="scalars: expected real numbers"):
        tint(words, "word")
    lit.cell_data["face"] = np.arange(lit.n_cells)
    with pytest.raises(ValueError, match="cell_data_to_point_data"):
        tint(lit, "face")
    given = vizlight.illuminate(mesh, SCENE, tangents=np.array(mesh.points))
    with pytest.raises(ValueError, match="attach the array and name it by tangents="):
        tint(given, "height")
    moved = lit.copy()
    moved["Normals"][:] = moved["Normals"][::-1].copy()
    with pytest.raises(ValueError, match="light it again"):
        tint(moved, "height")
    with pytest.raises(ValueError, match="expected the result of tint"):
        unlit_colors(vizlight.illuminate(mesh, SCENE, name="rgb"))


def in_oklab(rgb):
    """Return colours of sRGB, which may exceed 1, in the space Oklab of Ottosson (2020)."""
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    cones = linear @ np.transpose([
        [0.4122214708, 0.5363325363, 0.0514459929],
        [0.2119034982, 0.6806995451, 0.1073969566],
        [0.0883024619, 0.2817188376, 0.6299787005],
    ])  # fmt: skip
    return np.cbrt(cones) @ np.transpose([
        [0.2104542553, 0.7936177850, -0.0040720468],
        [1.9779984951, -2.4285922050, 0.4505937099],
        [0.0259040371, 0.7827717662, -0.8086757660],
    ])  # fmt: skip


def test_colours_above_white_keep_hue_and_luma(random):
    rgb = random.uniform(0, 1.8, (4000, 3))
    got = displayable(rgb)
    inside = rgb.max(axis=1) <= 1
    np.testing.assert_array_equal(got[inside], rgb[inside])
    luma, white = rgb @ formulas.LUMA, rgb @ formulas.LUMA >= 1
    np.testing.assert_array_equal(got[white], 1)
    mixed = ~inside & ~white
    np.testing.assert_allclose(got[mixed].max(axis=1), 1, atol=1e-12)
    np.testing.assert_allclose((got @ formulas.LUMA)[mixed], luma[mixed], atol=1e-12)
    hues = [rgb - rgb.mean(axis=1, keepdims=True) for rgb in (rgb[mixed], got[mixed])]
    np.testing.assert_allclose(np.cross(*hues), 0, atol=1e-12)
    assert np.all(np.einsum("ij,ij->i", *hues) >= 0)


def test_hue_of_bright_colours_is_that_of_the_eye(random):
    """The figures of the docstring: hue and lightness before and after, in Oklab."""
    maps = ("viridis", "turbo", "coolwarm", "plasma")
    names = ("tan", "orange", "tomato", "royalblue")
    colors = [mpl.colormaps[name](random.uniform(0, 1, 2000))[:, :3] for name in maps]
    colors += [np.tile(mpl.colors.to_rgb(name), (2000, 1)) for name in names]
    rgb = np.concatenate(colors)
    rgb = rgb * random.uniform(0.4, 1.4, (len(rgb), 1)) + random.uniform(0, 0.6, (len(rgb), 1))
    rgb = rgb[rgb.max(axis=1) > 1]

    def changes(shown):
        a, b = in_oklab(rgb), in_oklab(shown)
        hues = [x[:, 1] + 1j * x[:, 2] for x in (a, b)]
        seen = np.minimum(*np.abs(hues)) > 0.03
        degrees = np.degrees(np.abs(np.angle(hues[0] * np.conj(hues[1]))))[seen]
        return degrees.mean(), np.abs(np.minimum(a[:, 0], 1) - b[:, 0]).mean()

    ours, clipped = changes(displayable(rgb)), changes(np.clip(rgb, 0, 1))
    scaled = changes(rgb / rgb.max(axis=1, keepdims=True))
    stated = [(1.7, 0.012), (19, 0.034), (0.07, 0.115)]
    np.testing.assert_allclose(np.array([ours, clipped, scaled]) / stated, 1, atol=0.3)


def test_colours_are_brought_into_range_in_any_layout_and_however_bright():
    rgb = np.random.default_rng(0).random((4, 5, 3)) * 3
    expected = displayable(rgb)
    assert expected.max() == 1
    np.testing.assert_array_equal(displayable(np.asfortranarray(rgb)), expected)
    turned = displayable(rgb.transpose(1, 0, 2))
    np.testing.assert_array_equal(turned, expected.transpose(1, 0, 2))
    np.testing.assert_array_equal(displayable([[np.inf, 1, 0], [0, 0, 1e300]]), 1)
    assert np.isnan(displayable([np.nan, 2, 0])).all()
    for white in (0, -1, np.nan):
        with pytest.raises(ValueError, match="white: expected"):
            displayable(rgb, white=white)


def test_colours_to_bring_into_range_are_of_three_components():
    with pytest.raises(ValueError, match=r"rgb: expected an array of shape"):
        displayable([1.0, 2.0])
    with pytest.raises(TypeError, match="rgb"):
        displayable("red")
