"""A mesh with live light takes the keywords that PyVista takes, and shows what they ask for."""

import numpy as np
import pytest
import pyvista as pv
import shapes

import vizlight
from studies import peak_memory
from vizlight.draw import keywords

pytestmark = pytest.mark.opengl

SIZE = (90, 90)
#: Values of keywords of ``pyvista.Plotter.add_mesh`` as users write them.
EVERYDAY = (
    {"color": "red", "smooth_shading": True}, {"smooth_shading": False}, {"lighting": True},
    {"smooth_shading": True, "split_sharp_edges": True}, {"copy_mesh": True}, {"opacity": 0.5},
    {"scalars": "rgb", "rgb": True}, {"scalars": "rgb", "rgba": True}, {"scalars": "zone"},
    {"scalars": "zone", "preference": "cell"}, {"scalars": "height", "opacity": "linear"},
    {"opacity": "share"}, {"show_edges": True, "edge_color": "k"}, {"style": "wireframe"},
    {"style": "points", "render_points_as_spheres": True}, {"silhouette": True}, {"label": "a"},
    {"scalars": "height", "clim": [0, 1], "below_color": "r", "above_color": "b"},
    {"scalars": "height", "rng": [0, 1], "colormap": "plasma"}, {"culling": "back"},
    {"scalars": "height", "categories": True}, {"metallic": 0.5, "roughness": 0.2},
    {"backface_params": {"color": "blue"}}, {"show_vertices": True, "vertex_color": "r"},
    {"user_matrix": np.eye(4)}, {"static": True}, {"multi_colors": True}, {"pickable": False},
)  # fmt: skip


def ball():
    mesh = shapes.ball(12)
    mesh["rgb"] = np.asarray(mesh.points) + 0.5
    mesh["share"] = np.linspace(0, 1, mesh.n_points)
    mesh.cell_data["zone"] = np.arange(mesh.n_cells)
    return mesh


def cloud():
    points = pv.PolyData(np.eye(3) + 1)
    points["height"] = np.arange(3.0)
    return points


def picture(mesh, *, live=True, prepare=None, **options):
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    add = plotter.vizlight.add_mesh if live else plotter.add_mesh
    add(mesh, **options)
    if prepare is not None:
        prepare(plotter)
    seen = plotter.screenshot(return_img=True)
    return seen[..., :3].astype(int)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("options", EVERYDAY, ids=str)
def test_keywords_of_pyvista_are_taken(options):
    for mesh in (ball(), ball().cast_to_unstructured_grid()):
        plotter = pv.Plotter(off_screen=True)
        plotter.vizlight.add_mesh(mesh, **options)
        assert plotter.vizlight.has_live_light


@pytest.mark.parametrize("wrong", ["tangent", "colour", "scalers", "smoothshading", "line_widht"])
def test_unknown_keywords_name_the_nearest(wrong):
    near = {"tangent": "tangents", "colour": "color", "scalers": "scalars"}
    near |= {"smoothshading": "smooth_shading", "line_widht": "line_width"}
    with pytest.raises(TypeError, match=rf"{wrong}: .* did you mean {near[wrong]}=\?"):
        picture(ball(), **{wrong: 1})


@pytest.mark.parametrize("light", ["points", "fragments"])
def test_colours_are_those_that_were_given(light):
    lines = pv.MultipleLines(np.cumsum(np.tile([[1.0, 0, 0], [0, 1, 0]], (20, 1)), axis=0))
    rgb = vizlight.direction_colors(lines)
    lines["bytes"] = keywords.as_bytes(rgb)
    scene = vizlight.Scene()
    seen = picture(lines, scalars=rgb, rgb=True, scene=scene, light=light)
    same = picture(lines, scalars="bytes", scene=scene, light=light)
    np.testing.assert_array_equal(seen, same)
    assert seen.std() > 5


def test_colours_of_cells_are_averaged_where_light_is_at_points():
    mesh = ball()
    mesh.cell_data["zone"] = np.asarray(mesh.cell_centers().points)[:, 2]
    with pytest.warns(UserWarning, match="'zone' are averaged from cells to points"):
        seen = picture(mesh, scalars="zone", light="points", show_scalar_bar=False)
    apart = np.abs(seen - picture(mesh, scalars="zone", show_scalar_bar=False))
    assert apart.mean() < 8
    assert np.ptp(seen, axis=(0, 1)).max() > 60


@pytest.mark.slow
def test_active_scalars_are_coloured_unless_the_light_is_looked_at():
    mesh = ball()
    mesh.set_active_scalars("height")
    colored = picture(mesh, show_scalar_bar=False)
    np.testing.assert_array_equal(colored, picture(mesh, scalars="height", show_scalar_bar=False))
    plain = mesh.copy()
    plain.set_active_scalars(None)
    white = picture(plain, color="white")
    np.testing.assert_array_equal(white, picture(mesh, color="white"))
    scene = vizlight.presets.shape()
    np.testing.assert_array_equal(picture(mesh, scene=scene), picture(plain, scene=scene))


def test_points_alone_and_blocks_without_the_array_are_drawn():
    bare = pv.Sphere(center=(-1, 0, 0))
    blocks = pv.MultiBlock({"bare": bare, "ball": ball(), "points": cloud()})
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    actors = plotter.vizlight.add_mesh(blocks, scalars="height", cmap="viridis")
    assert [actor.mapper.scalar_visibility for actor in actors] == [False, True, True]
    assert [*plotter.scalar_bars.keys()] == ["height"]
    options = {"cmap": "viridis", "scalars": "height", "point_size": 9}
    with pytest.raises(ValueError, match="scalars: expected a point array or a cell array"):
        picture(cloud(), scalars="nope")
    same = picture(cloud(), live=False, **options)
    np.testing.assert_array_equal(picture(cloud(), **options), same)
    with pytest.raises(ValueError, match="scalars: expected a point array"):
        picture(ball(), scalars="depth")


@pytest.mark.slow
def test_what_pyvista_draws_itself_is_its_picture():
    mesh, options = ball(), {"lighting": False, "color": "red"}
    np.testing.assert_array_equal(picture(mesh, **options), picture(mesh, live=False, **options))
    for options in ({"pbr": True}, {"style": "points_gaussian"}):
        with pytest.warns(UserWarning, match="has PyVista's light in place of vizlight's"):
            seen = picture(mesh, **options)
        np.testing.assert_array_equal(seen, picture(mesh, live=False, **options))


@pytest.mark.parametrize("light", ["points", "fragments"])
@pytest.mark.parametrize("mesh", [pv.Cube(), pv.Cube(clean=False), pv.Cube().triangulate()])
def test_faces_of_a_solid_with_creases_are_flat(mesh, light):
    # The normals of a cleaned cube are means over its corners.
    seen = picture(mesh, color="white", light=light, prepare=lambda p: p.disable_anti_aliasing())
    inside = seen[(seen < 250).any(axis=2)]
    assert len(np.unique(inside, axis=0)) <= 12


def test_flat_faces_where_asked():
    options = {"color": "white", "prepare": lambda p: p.disable_anti_aliasing()}
    shades = [
        len(np.unique(picture(ball(), smooth_shading=smooth, **options).reshape(-1, 3), axis=0))
        for smooth in (False, True)
    ]
    assert shades[0] < 0.7 * shades[1]


def test_a_volume_costs_its_surface():
    grid = pv.ImageData(dimensions=(90, 90, 90))
    grid["height"] = np.zeros(grid.n_points, np.float32)
    plotter = pv.Plotter(off_screen=True)
    plotter.vizlight.add_mesh(ball())
    most = peak_memory(lambda: plotter.vizlight.add_mesh(grid, scalars="height"))
    assert most < 60 * grid.n_points


@pytest.mark.parametrize("effect", ["shadows", "ssao"])
def test_effects_that_do_not_show_are_said(effect):
    name = {"shadows": "shadows", "ssao": "ambient occlusions"}[effect]
    with pytest.warns(UserWarning, match=f"the {name} .*do not show"):
        picture(ball(), color="white", prepare=lambda p: getattr(p, f"enable_{effect}")())


def test_a_copy_of_an_actor_is_said_to_stay():
    plotter = pv.Plotter(off_screen=True, window_size=SIZE)
    actor = plotter.vizlight.add_mesh(ball(), color="white")
    plotter.add_actor(actor.copy(deep=True))
    with pytest.warns(UserWarning, match="a copy of an actor has light that does not follow"):
        plotter.screenshot(return_img=True)


def test_colours_of_as_many_cells_as_points_are_those_of_cells():
    faces = [3, 0, 2, 1, 3, 0, 1, 3, 3, 1, 2, 3, 3, 0, 3, 2]
    mesh = pv.PolyData(np.vstack([np.zeros(3), np.eye(3)]), faces)
    mesh.cell_data["red"] = np.tile(np.array([255, 0, 0], np.uint8), (4, 1))
    for of_cells in (False, True):
        colored, name = keywords.colored(
            mesh, "red", {"rgb": True, "preference": "cell" if of_cells else "point"}
        )
        assert name in colored.cell_data
        assert name not in colored.point_data
