"""Shadows as point scalars: every kind of grid, closed meshes, several lights, a day."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from scipy.interpolate import RegularGridInterpolator

import vizlight
from vizlight import Light, Material, Scene, View, relief_day, relief_from_mesh, relief_shadow
from vizlight.geometry import relief, sun

TOWARD = np.array([0.6, -0.5, 0.4])
SCENE = Scene(lights=Light(direction=TOWARD), material=Material(ambient=0.1, specular=0))
X, Y = np.arange(9.0) * 0.5 + 2, np.arange(7.0) * 0.25 - 1


def bumps(x, y):
    return 0.3 * np.sin(2 * x) * np.cos(3 * y)


Z = bumps(X, Y[:, None])


def grids():
    image = pv.ImageData(dimensions=(9, 7, 1), spacing=(0.5, 0.25, 1), origin=(2, -1, 5))
    image["height"] = Z.ravel().copy()
    rectilinear = pv.RectilinearGrid(X, Y, [5.0])
    rectilinear["height"] = Z.ravel().copy()
    x, y = np.meshgrid(X, Y, indexing="ij")
    warped = pv.StructuredGrid(x, y, bumps(x, y))
    turned = pv.StructuredGrid(x.T[::-1], y.T[::-1], bumps(x, y).T[::-1])
    flat = pv.StructuredGrid(x, y, 0 * x)
    flat["height"] = bumps(x, y).ravel(order="F")
    return {
        "ImageData": (image, {}),
        "RectilinearGrid": (rectilinear, {"elevation": "height"}),
        "warped": (warped, {}),
        "turned": (turned, {}),
        "flat": (flat, {"elevation": "height"}),
    }


@pytest.mark.parametrize("kind", grids())
def test_every_kind_of_grid_has_the_same_shadow(kind):
    grid, options = grids()[kind]
    before = grid.copy()
    out = relief_shadow(grid, SCENE, depth=0.2, method="exact", **options)
    assert grid == before
    assert type(out) is type(grid)
    assert out.active_scalars_name == "t"
    expected = relief.shadow(X, Y, Z, depth=0.2, direction=TOWARD, method="exact")
    i = np.rint((np.asarray(out.points)[:, 0] - X[0]) / 0.5).astype(int)
    j = np.rint((np.asarray(out.points)[:, 1] - Y[0]) / 0.25).astype(int)
    np.testing.assert_allclose(out["t"], expected[j, i], atol=1e-6)
    assert out["t"].min() < 0.3 < 0.6 < out["t"].max()


@pytest.mark.parametrize("angle", [30, 90, 200, -45.5])
@pytest.mark.parametrize("kind", ["ImageData", "StructuredGrid"])
def test_a_turned_grid_has_its_shadow_turned(kind, angle):
    """As the grid lies straight: t, and points, normals and near lights of the engine."""
    x, y = np.arange(30.0), np.arange(20.0)
    z = 2 * np.exp(-((x - 12) ** 2 + (y[:, None] - 9) ** 2) / 9)
    if kind == "ImageData":
        grid = pv.ImageData(dimensions=(30, 20, 1))
        grid["height"] = z.ravel()
    else:
        grid = pv.StructuredGrid(*np.meshgrid(x, y), z)
    a = np.radians(angle)
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    if kind == "ImageData":
        turned = grid.copy()
        turned.direction_matrix = turn
    else:
        turned = grid.copy()
        turned.points = grid.points @ turn.T + [50, -7, 0]
    move = np.zeros(3) if kind == "ImageData" else np.array([50, -7, 0])
    places = np.array([1.0, 2, 0.6]), np.array([20.0, 15, 6])

    def scene(turn, move):
        lights = Light(direction=turn @ places[0]), Light(position=turn @ places[1] + move)
        return Scene(lights=lights, material=Material(specular=0))

    one, other = (
        relief_shadow(mesh, scene(*how), depth=0.4, method="exact", lit=True, components=True)
        for mesh, how in ((grid, (np.eye(3), np.zeros(3))), (turned, (turn, move)))
    )
    assert np.ptp(one["t_0"]) > 0.5
    for name in ("t_0", "t_1", "t", "luminance"):
        np.testing.assert_allclose(other[name], one[name], atol=2e-6)


@pytest.mark.parametrize("angle", [1e-5, 0.05, 0.2, 0.4, 10, 89.9])
@pytest.mark.parametrize("kind", ["ImageData", "StructuredGrid"])
@pytest.mark.parametrize(
    ("size", "spacing", "origin"),
    [((100, 100), 10, (5e5, 5e6)), ((40, 30), 0.5, (5e6, 4e6)), ((2, 500), 0.5, (5e6, 4e6))],
)
def test_a_turned_grid_at_map_coordinates(size, spacing, origin, angle, kind):
    """Flat, so t is the cosine; a ridge along y tells that the rows are turned too."""
    grid = pv.ImageData(dimensions=(*size, 1), spacing=(spacing,) * 3, origin=(*origin, 0))
    a = np.radians(angle)
    turn = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])
    grid.direction_matrix = turn
    if kind == "StructuredGrid":
        grid = grid.cast_to_structured_grid()
    assert np.asarray(grid.points).dtype == np.float64
    straight = pv.ImageData(dimensions=(*size, 1), spacing=(spacing,) * 3)
    ridge = spacing * np.abs(np.arange(size[0]) - size[0] // 2)
    for heights in (np.zeros(size[0]), -ridge):
        straight["h"] = grid["h"] = np.tile(heights, size[1]).astype(float)
        way = np.array([3.0, 1, 4])
        turned = Scene(lights=Light(direction=turn @ way))
        t = relief_shadow(grid, turned, elevation="h", method="exact")["t"]
        expected = relief_shadow(straight, Scene(lights=Light(direction=way)), method="exact")["t"]
        np.testing.assert_allclose(t, expected, atol=1e-6)


def test_grid_in_float32_far_from_the_origin():
    far = pv.StructuredGrid(
        *np.meshgrid(
            np.float32(5e6) + np.arange(9, dtype=np.float32) * 32,
            np.float32(5.1e6) + np.arange(7, dtype=np.float32) * 32,
            np.float32(0),
            indexing="ij",
        )
    )
    far["height"] = 100 * Z.ravel().astype(np.float32)
    t = relief_shadow(far, SCENE, depth=30, elevation="height")["t"]
    expected = relief.shadow(
        np.arange(9) * 32, np.arange(7) * 32, 100 * Z, depth=30, direction=TOWARD
    )
    np.testing.assert_allclose(t, expected.ravel(), atol=1e-5)


def test_factor_and_default_depth():
    grid, _ = grids()["ImageData"]
    tall = grid.copy()
    tall["height"] = 3 * Z.ravel()
    np.testing.assert_allclose(
        relief_shadow(grid, SCENE, factor=3.0)["t"], relief_shadow(tall, SCENE)["t"]
    )
    depth = 0.01 * np.hypot(4, 1.5)
    np.testing.assert_array_equal(
        relief_shadow(grid, SCENE)["t"], relief_shadow(grid, SCENE, depth=depth)["t"]
    )


def test_holes_are_marked():
    grid, _ = grids()["ImageData"]
    grid["height"][[3, 4]] = np.nan
    with pytest.warns(UserWarning, match="2 of 63 points have no height or no normal and t = 0"):
        out = relief_shadow(grid, SCENE, lit=True)
    assert np.flatnonzero(~out["t_valid"].astype(bool)).tolist() == [3, 4]
    assert not out["t"][[3, 4]].any()
    np.testing.assert_allclose(out["luminance"][[3, 4]], 0.1)
    assert np.all(np.isfinite(out["luminance"]))


def test_lit_has_t_in_place_of_the_cosine():
    grid, _ = grids()["ImageData"]
    out = relief_shadow(grid, SCENE, depth=0.2, lit=True)
    np.testing.assert_allclose(out["luminance"], 0.1 + 0.5 * out["t"], atol=1e-12)
    assert out.active_scalars_name == "luminance"
    assert "cos-theta" in vizlight.engine.plan(SCENE, normals=True, shadowed=True).explain()


def test_colours_and_several_lights():
    grid, _ = grids()["ImageData"]
    one = Light(direction=TOWARD, intensity=0.5, color=(1, 0, 0))
    two = Light(position=(4, 0, 6), intensity=1.5, color=(0, 0, 1))
    dark = Light(direction=(0, 0, 1), intensity=0)
    scene = Scene(lights=[one, dark, two], material=Material(ambient=0, diffuse=1, specular=0))
    out = relief_shadow(grid, scene, depth=0.2, lit=True, components=True)
    np.testing.assert_allclose(out["t"], (0.5 * out["t_0"] + 1.5 * out["t_1"]) / 2)
    np.testing.assert_allclose(out["rgb"][:, 0], 0.5 * out["t_0"], atol=1e-12)
    np.testing.assert_allclose(out["rgb"][:, 2], 1.5 * out["t_1"], atol=1e-12)
    single = relief_shadow(grid, scene.replace(lights=[one]), depth=0.2)
    np.testing.assert_array_equal(single["t"], out["t_0"])
    np.testing.assert_allclose(out["diffuse"], 0.5 * out["t_0"] + 1.5 * out["t_1"], atol=1e-12)


def test_highlight_keeps_the_share_that_t_has_of_the_cosine():
    mesh = pv.Sphere(theta_resolution=40, phi_resolution=40)
    scene = Scene(
        lights=Light(direction=(1, 0, 1)),
        material=Material(ambient=0, diffuse=0, specular=1),
        view=View(direction=(1, 0, 1)),
    )
    wall = pv.Cube(center=(2, 0.2, 2), x_length=0.5, y_length=0.4, z_length=0.5).triangulate()
    free = vizlight.illuminate(mesh, scene)["luminance"]
    out = relief_shadow(mesh, scene, depth=0.01, lit=True, occluders=[wall])
    cosine = np.maximum(np.asarray(mesh.point_normals) @ [0.5**0.5, 0, 0.5**0.5], 0)
    share = np.minimum(out["t"] / np.maximum(cosine, 1e-9), 1)
    np.testing.assert_allclose(out["luminance"], free * share, atol=1e-5)
    shaded = (cosine > 0.95) & (out["t"] < 0.1)
    assert shaded.sum() > 5
    assert free[shaded].max() > 0.5


def test_sphere_has_its_closed_form():
    """At every point, light at infinity and near: below 1e-3 with cells of half a degree."""
    mesh = pv.Sphere(radius=1, theta_resolution=360, phi_resolution=181)
    n = np.asarray(mesh.points, dtype=float)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    depth = 0.1
    for light in (Light(direction=(1, 2, 3)), Light(position=(1.2, -0.9, 0.7))):
        out = relief_shadow(mesh, Scene(lights=light), depth=depth)
        start = (1 - depth) * n
        if light.direction is not None:
            way = np.tile(np.array(light.direction) / 14**0.5, (len(n), 1))
        else:
            way = np.array(light.position) - start
            way /= np.linalg.norm(way, axis=1, keepdims=True)
        middle = np.einsum("ij,ij->i", start, way)
        r = -middle + np.sqrt(middle**2 + 1 - (1 - depth) ** 2)
        assert np.abs(out["t"] - depth / np.maximum(r, depth)).max() < 1e-3


@pytest.mark.parametrize("far", [1e20, 1e200, 1e308])
@pytest.mark.parametrize("size", [1, 1e-120])
def test_a_light_far_away_is_a_direction(far, size):
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    mesh = pv.PolyData(np.asarray(ball.points, dtype=float) * size, ball.faces)
    mesh["Normals"] = np.asarray(ball.point_normals)
    mesh.point_data.active_normals_name = "Normals"
    one, other = (
        relief_shadow(mesh, Scene(lights=Light(**where)))["t"]
        for where in ({"direction": TOWARD}, {"position": far * TOWARD})
    )
    np.testing.assert_allclose(other, one, atol=1e-9)


@pytest.mark.parametrize(("scale", "moved"), [(1e-120, 0.0), (1e120, 0.0), (1e3, 4e6)])
def test_closed_mesh_of_any_size_and_place(scale, moved):
    """Far from the origin float32 rounds the points; what it kept has the same shadow."""
    ball = pv.Sphere(theta_resolution=30, phi_resolution=30)
    faces, points = ball.regular_faces, np.asarray(ball.points, dtype=float) * scale
    if moved:
        points = (points + moved).astype(np.float32)
    far = pv.PolyData.from_regular_faces(points, faces)
    near = pv.PolyData.from_regular_faces((points.astype(float) - moved) / scale, faces)
    for mesh in (far, near):
        mesh["Normals"] = np.asarray(ball.point_normals)
        mesh.point_data.active_normals_name = "Normals"
    t = relief_shadow(far, SCENE, depth=0.1 * scale)["t"]
    np.testing.assert_allclose(t, relief_shadow(near, SCENE, depth=0.1)["t"], atol=1e-9)
    assert 0 < t.min() < t.max()


def test_depth_to_zero_on_a_closed_mesh():
    mesh = pv.Sphere(theta_resolution=60, phi_resolution=60)
    normals = np.asarray(mesh.point_normals, dtype=float)
    cosine = np.maximum(normals @ TOWARD / np.linalg.norm(TOWARD), 0)
    t = relief_shadow(mesh, SCENE, depth=0)["t"]
    np.testing.assert_allclose(t[cosine > 0.05], cosine[cosine > 0.05], atol=1e-6)
    assert not t[cosine == 0].any()


def test_field_and_the_same_solid_as_a_mesh_agree():
    """A height field with walls and a base is the closed mesh that it bounds."""
    x = np.linspace(0, 2, 21)
    z = 0.3 * np.maximum(0, 1 - 2 * np.abs(x - 1)) + 0 * x[:, None]
    grid = pv.StructuredGrid(*np.meshgrid(x, x, indexing="ij"), z.T)
    field = relief_shadow(grid, SCENE, depth=0.05, border="wall", base=-0.2, method="exact")
    top = grid.extract_surface(algorithm="geometry").triangulate()
    side = pv.Plane(center=(1, 1, -0.2), direction=(0, 0, 1), i_size=4, j_size=4)
    solid = top.extrude_trim((0, 0, -1), side.triangulate()).triangulate().clean()
    solid = solid.compute_normals(auto_orient_normals=True, split_vertices=False)
    for mesh in (solid,):
        mesh.point_data.pop("Normals")
        start = np.asarray(grid.points, dtype=float)
        inner = (start[:, :2] > 0.3).all(axis=1) & (start[:, :2] < 1.7).all(axis=1)
        nearest = [mesh.find_closest_point(p) for p in start[inner]]
        flat = np.isclose(start[inner][:, 2], 0) & (np.abs(start[inner][:, 0] - 1) > 0.55)
        t = relief_shadow(mesh, SCENE, depth=0.05)["t"][nearest]
        np.testing.assert_allclose(t[flat], field["t"][inner][flat], atol=1e-6)


def test_occluder_in_the_way():
    ball = pv.Sphere(theta_resolution=40, phi_resolution=40)
    screen = pv.Cube(center=(0, 0, 3), x_length=4, y_length=4, z_length=0.5).triangulate()
    scene = Scene(lights=Light(direction=(0, 0, 1)))
    alone = relief_shadow(ball, scene, depth=0.1)["t"]
    behind = relief_shadow(ball, scene, depth=0.1, occluders=[screen])["t"]
    lit = alone < 1
    np.testing.assert_allclose(0.1 / behind[lit], 0.1 / alone[lit] + 0.5, atol=1e-9)


def test_one_occluder_needs_no_list():
    ball = pv.Sphere(theta_resolution=20, phi_resolution=20)
    moon = pv.Sphere(radius=0.3, center=(2, 0, 0))
    scene = Scene(lights=Light(direction=(1, 0, 0)))
    one, many = (relief_shadow(ball, scene, occluders=o)["t"] for o in (moon, [moon]))
    np.testing.assert_array_equal(one, many)
    assert one[ball.points[:, 0].argmax()] < 0.1


def test_open_surface_with_thickness():
    plane = pv.Plane(i_size=2, j_size=2, i_resolution=20, j_resolution=20)
    scene = Scene(lights=Light(direction=(0, 3, 4)))
    with pytest.raises(ValueError, match="mesh: expected a closed surface.*thickness="):
        relief_shadow(plane, scene)
    out = relief_shadow(plane, scene, depth=0.1, thickness=0.3)
    inner = (np.abs(np.asarray(plane.points)[:, :2]) < [0.95, 0.5]).all(axis=1)
    np.testing.assert_allclose(out["t"][inner], 0.8, atol=1e-6)


def terrains():
    """Real terrain: the Himalaya in kilometres, times 10, and a volcano where it is at hand."""
    part = vizlight.load_example("earth_relief.vti").extract_subset((750, 850, 340, 390, 0, 0))
    himalaya = pv.ImageData(dimensions=part.dimensions, spacing=(32.1, 37.1, 1))
    himalaya["height"] = np.asarray(part["elevation"], dtype=float) / 100
    yield "himalaya", himalaya
    path = Path(os.environ.get("PYVISTA_DATA", ".")) / "Data" / "SainteHelens.dem"
    if path.is_file():
        volcano = pv.read(path).extract_subset((20, 300, 20, 440, 0, 0), rate=(2, 2, 1))
        volcano["height"] = np.asarray(volcano["Elevation"], dtype=float)
        yield "volcano", volcano


@pytest.mark.parametrize(("name", "terrain"), list(terrains()))
def test_hard_shadows_of_real_terrain_are_those_of_the_horizon(name, terrain):
    """The highest angle on the way to the sun, sampled: no cells, no rays."""
    columns, rows = terrain.dimensions[:2]
    z = np.asarray(terrain["height"]).reshape(rows, columns)
    x, y = (np.arange(n) * s for n, s in zip((columns, rows), terrain.spacing, strict=False))
    surface = RegularGridInterpolator((y, x), z)
    gx, gy = np.meshgrid(x, y)
    across = np.array([-1.0, 0.7]) / np.hypot(1, 0.7)
    horizon = np.full(z.shape, -np.inf)
    for k in np.arange(0.02, 1.5 * max(columns, rows), 0.25) * terrain.spacing[0]:
        place = [np.clip(gy + k * across[1], 0, y[-1]), np.clip(gx + k * across[0], 0, x[-1])]
        horizon = np.maximum(horizon, (surface(np.stack(place, axis=-1)) - z) / k)
    down, right = np.gradient(z, y, x)
    for elevation in (8, 15, 30):
        rise = np.tan(np.radians(elevation))
        scene = Scene(lights=Light(direction=(*across, rise)))
        options = {"elevation": "height", "method": "exact"}
        t = relief_shadow(terrain, scene, depth=0, **options)["t"].reshape(z.shape)
        facing = rise > right * across[0] + down * across[1]
        expected = (horizon < rise) & facing
        assert np.mean((t > 0) != expected) < 2e-3
        # Softened over a depth the dark is dark still, the light the cosine.
        soft = relief_shadow(terrain, scene, depth=0.02 * terrain.spacing[0], **options)
        deep = horizon > np.tan(np.radians(elevation + 10))
        assert np.all(soft["t"].reshape(z.shape)[deep] < 0.2)


def test_a_disc_softens_the_edge_and_keeps_the_middle():
    x = np.linspace(0, 4, 401)
    grid = pv.ImageData(dimensions=(401, 3, 1), spacing=(0.01, 1, 1))
    grid["height"] = np.tile(np.where(x > 3, 1.0, 0.0), 3)
    scene = Scene(lights=Light(direction=(1, 0, 0.5)))
    row = slice(401, 802)
    hard = relief_shadow(grid, scene, depth=0.001)["t"][row]
    soft = relief_shadow(grid, scene, depth=0.001, angular_diameter=0.1, samples=64)["t"][row]
    far = x < 0.5
    np.testing.assert_allclose(soft[far], hard[far], rtol=1e-2)
    width = [np.ptp(x[(t > 0.05) & (t < 0.4) & (x < 2.5)]) for t in (hard, soft)]
    # The edge is 2 from the wall's foot, its height 1: 0.1 radians are 0.5 wide there.
    assert width[0] < 0.06
    assert 0.3 < width[1] < 0.6
    assert abs(sun.DIAMETER - 0.00925) < 1e-5


def test_hours_of_a_day():
    grid, _ = grids()["ImageData"]
    out = relief_day(grid, latitude=np.radians(46.2), day=172, hours=[0, 6, 12, 18], depth=0.1)
    assert out["t"].shape == (63, 4)
    assert not out["t"][:, 0].any()
    noon = sun.directions(np.radians(46.2), 172, 12)
    single = relief_shadow(grid, Scene(lights=Light(direction=noon)), depth=0.1)
    np.testing.assert_array_equal(out["t"][:, 2], single["t"])
    np.testing.assert_allclose(out["t_mean"], out["t"].mean(axis=1))
    given = relief_day(grid, directions=[[0, 0, -1], noon], depth=0.1)
    np.testing.assert_array_equal(given["t"][:, 1], single["t"])
    assert set(given.point_data) == {"height", "t", "t_mean"}


def test_one_hour_of_a_day():
    grid, _ = grids()["ImageData"]
    when = {"latitude": 0.7, "day": 172}
    one, many = (relief_day(grid, hours=hours, **when) for hours in (12, [12]))
    np.testing.assert_array_equal(one["t"], many["t"])
    assert one["t_mean"].shape == (63,)


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"directions": [[[0, 0, 1]]]}, ValueError, "directions: expected a list of one or more"),
        ({"directions": np.zeros((0, 3))}, ValueError, "directions: expected a list of one"),
        ({"directions": ()}, ValueError, "directions: expected vectors"),
        (
            {"directions": [(0, 0, 0)]},
            ValueError,
            r"directions\[0\]: expected a direction of non-z",
        ),
        ({"directions": [(0, 0, 1), (0, 0, np.nan)]}, ValueError, r"directions\[1\]: expected fin"),
        ({"directions": [(0, 0, -1)]}, ValueError, "directions: expected the sun above the hor"),
        ({"latitude": 0, "day": 9, "hours": [[12]]}, ValueError, "hours: expected a list of one"),
        ({"latitude": 0, "day": 9, "hours": []}, ValueError, "hours: expected a list of one"),
        (
            {"directions": (0, 0, 1), "scene": SCENE},
            TypeError,
            "scene: expected an option of",
        ),
        (
            {"directions": (0, 0, 1), "lit": True},
            TypeError,
            "lit: expected an option of",
        ),
    ],
)
def test_bad_days(options, error, words):
    with pytest.raises(error, match=words):
        relief_day(image(), **options)


def test_a_bas_relief_of_a_sphere():
    ball = pv.Sphere(theta_resolution=200, phi_resolution=200)
    out = relief_from_mesh(ball, direction=(1, 1, 0.2), resolution=201, margin=0.1)
    assert out.dimensions == (201, 201, 1)
    x, y, _ = np.asarray(out.points).T
    there = x**2 + y**2 < 0.2
    # The plate is where the last node of the ball is seen.
    below = 0.5 - np.sqrt(0.25 - x[there] ** 2 - y[there] ** 2)
    np.testing.assert_allclose(out["height"].max() - out["height"][there], below, atol=1e-3)
    assert not out["height"][x**2 + y**2 > 0.2501].any()
    low = relief_from_mesh(ball, resolution=64, height=0.1)
    assert low["height"].max() == pytest.approx(0.1)
    lit = relief_shadow(low, Scene(lights=Light(position=(1, 1, 0.5))), depth=0.02)
    assert 0 < lit["t"].min() < lit["t"].max() <= 1


def test_bas_relief_is_upright():
    """Seen from -y, x runs to the right and z up."""
    cone = pv.Cone(center=(2, 0, 1), direction=(0, 0, 1), resolution=50).triangulate()
    fruit = pv.Sphere(center=(2.45, 0, 1.4), radius=0.1)
    seen = relief_from_mesh(pv.merge([cone, fruit]), direction=(0, -1, 0), resolution=256)
    x, y, _ = np.asarray(seen.points).T
    high = seen["height"] > 0
    top = x[high & (y > 0.3)]
    assert np.ptp(x[high & (y < -0.3)]) > 0.9 > 0.7 > np.ptp(top)
    assert top.max() > 0.4
    assert top.min() > -0.3


def test_in_place_again_and_the_users_own_array():
    grid, _ = grids()["ImageData"]
    assert relief_shadow(grid, SCENE, inplace=True) is grid
    first = np.array(grid["t"])
    relief_shadow(grid, SCENE, depth=0.5, elevation="height", inplace=True)
    assert not np.array_equal(first, grid["t"])
    told = vizlight.provenance(grid, "t")
    assert told["filter"] == "relief_shadow"
    assert (told["depth"], told["options"]["depth"]) == (0.5, 0.5)
    again = relief_shadow(grid, Scene.from_dict(told["scene"]), depth=0.5, elevation="height")
    np.testing.assert_array_equal(again["t"], grid["t"])
    own, _ = grids()["ImageData"]
    own["t"] = np.zeros(63)
    with pytest.raises(ValueError, match="name: expected one under which the mesh has no array"):
        relief_shadow(own, SCENE, elevation="height")
    method = own.vizlight.relief_shadow(SCENE, elevation="height", name="shadow")
    assert "shadow_provenance" in method.field_data


def test_loose_points_have_no_shadow():
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12)
    points = np.vstack([ball.points, [[9, 9, 9]]])
    mesh = pv.PolyData.from_regular_faces(points, ball.regular_faces)
    with pytest.warns(UserWarning, match="1 of .* points have no height or no normal"):
        out = relief_shadow(mesh, SCENE)
    assert out["t"][-1] == 0


@pytest.mark.parametrize("loose", [np.nan, np.inf, 9.0])
@pytest.mark.parametrize("thickness", [None, 0.3])
def test_a_loose_point_changes_no_other(loose, thickness):
    ball = pv.Icosphere(nsub=2)
    mesh = pv.PolyData(np.vstack([ball.points, [[loose] * 3]]), ball.faces)
    with pytest.warns(UserWarning, match="1 of 163 points have no height or no normal"):
        out = relief_shadow(mesh, SCENE, thickness=thickness)
    t = relief_shadow(ball, SCENE, thickness=thickness)["t"]
    np.testing.assert_allclose(out["t"], np.append(t, 0), atol=1e-6)
    assert np.flatnonzero(~out["t_valid"].astype(bool)).tolist() == [162]


def image(**changes):
    grid = pv.ImageData(dimensions=(4, 4, 1))
    grid["height"] = np.zeros(16)
    for name, value in changes.items():
        grid[name] = value
    return grid


def layers():
    grid = pv.ImageData(dimensions=(3, 3, 3))
    grid["height"] = np.zeros(27)
    return grid


def row():
    grid = pv.ImageData(dimensions=(4, 1, 1))
    grid["height"] = np.zeros(4)
    return grid


def curved():
    r, a = np.meshgrid(np.linspace(1, 2, 5), np.linspace(0, 1, 6), indexing="ij")
    return pv.StructuredGrid(r * np.cos(a), r * np.sin(a), 0 * r)


def tilted(angle, axis):
    grid = image()
    c, s = np.cos(angle), np.sin(angle)
    about_x = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    grid.direction_matrix = np.roll(about_x, axis, axis=(0, 1))
    return grid


BALL = pv.Sphere(theta_resolution=8, phi_resolution=8)


@pytest.mark.parametrize(
    ("mesh", "options", "error", "words"),
    [
        (image(), {"depth": -1}, ValueError, "depth: expected a finite number of at least 0"),
        (image(), {"elevation": "z"}, ValueError, r"elevation: .*one of \['height'\], got 'z'"),
        (pv.ImageData(dimensions=(3, 3, 1)), {}, ValueError, "elevation: expected a point array"),
        (image(height=np.full(16, np.nan)), {}, ValueError, "z: expected heights, got NaN"),
        (layers(), {}, ValueError, "mesh: expected a grid of one layer, nx x ny x 1, got 3 x 3"),
        (row(), {}, ValueError, "y: expected two nodes or more.*repeat the row"),
        (curved(), {}, ValueError, "mesh: expected rows and columns that are straight"),
        (tilted(0.3, 0), {}, ValueError, "mesh: expected a grid that lies level.*thickness="),
        (tilted(-1e-3, 1), {}, ValueError, "mesh: expected a grid that lies level"),
        (tilted(np.pi / 2, 0), {}, ValueError, "mesh: expected a grid that lies level"),
        (
            tilted(np.pi / 2, 1).cast_to_structured_grid(),
            {"elevation": "height"},
            ValueError,
            "mesh: expected a grid that lies level",
        ),
        (pv.ImageData(), {}, ValueError, "mesh: expected a grid of points, got an empty one"),
        (image(), {"thickness": 1}, ValueError, "thickness: expected none on a height field"),
        (image(), {"border": "x"}, ValueError, "border: expected 'extend' or 'wall'"),
        (image(), {"method": "x"}, ValueError, "method: expected 'fast' or 'exact'"),
        (image(), {"samples": 0}, ValueError, "samples: expected an integer of at least 1"),
        (image(), {"angular_diameter": -1}, ValueError, "angular_diameter: expected a number"),
        (image(), {"name": ""}, ValueError, "name: expected a name for the point array"),
        (BALL, {"depth": -1}, ValueError, "depth: expected a finite number of at least 0"),
        (BALL, {"elevation": "z"}, ValueError, "elevation: expected none on a surface"),
        (BALL, {"factor": 2}, ValueError, "factor: expected none on a surface, got 2"),
        (BALL, {"base": 0}, ValueError, "base: expected none on a surface, got 0"),
        (BALL, {"border": "wall"}, ValueError, "border: expected none on a surface, got 'wall'"),
        (BALL, {"method": "exact"}, ValueError, "method: expected none on a surface, got 'exact'"),
        (BALL, {"thickness": 0}, ValueError, "thickness: expected more than 0"),
        (BALL, {"occluders": [pv.Plane()]}, ValueError, r"occluders\[0\]: expected a closed"),
        (pv.Line(), {}, ValueError, "mesh: expected a surface with faces"),
        (pv.UnstructuredGrid(), {}, TypeError, "mesh: expected a height field"),
        (None, {}, TypeError, "mesh: expected a height field"),
    ],
)
def test_bad_input(mesh, options, error, words):
    before = None if mesh is None else mesh.copy()
    with pytest.raises(error, match=words):
        relief_shadow(mesh, SCENE, **options)
    assert mesh == before


def test_bad_lights():
    for mesh, place in ((image(), (1, 1, -2)), (BALL, (0.1, 0, 0))):
        inside = Scene(lights=Light(position=place))
        with pytest.raises(ValueError, match="position: expected a light outside the solid"):
            relief_shadow(mesh, inside)
        with pytest.raises(ValueError, match="scene: expected a light of intensity above 0"):
            relief_shadow(mesh, Scene(lights=[]))
    with pytest.raises(TypeError, match=r"scene: expected a vizlight\.Scene, got None"):
        relief_shadow(image(), None)
    with pytest.raises(ValueError, match="view: expected a View, which the headlight follows"):
        relief_shadow(image(), Scene())
    with pytest.raises(ValueError, match="latitude, day: expected both, or directions="):
        relief_day(image(), latitude=0.5)
    with pytest.raises(ValueError, match="hours: expected the sun above the horizon, got night"):
        relief_day(image(), latitude=0.5, day=1, hours=[0])
    with pytest.raises(ValueError, match="directions: expected directions alone"):
        relief_day(image(), directions=[(0, 0, 1)], day=4)


def test_bad_bas_relief():
    with pytest.raises(TypeError, match=r"mesh: expected a pyvista\.PolyData surface"):
        relief_from_mesh(image())
    with pytest.raises(ValueError, match="resolution: expected an integer of at least 2"):
        relief_from_mesh(BALL, resolution=1)
    with pytest.raises(ValueError, match="up: expected a direction across the view"):
        relief_from_mesh(BALL, direction=(0, 0, 1), up=(0, 0, 2))
    edge = pv.Plane(direction=(1, 0, 0))
    with pytest.raises(ValueError, match="mesh: expected a surface wider than a node"):
        relief_from_mesh(edge, direction=(0, 0, 1))


def test_a_shadow_is_made_again_from_what_is_told():
    ball = pv.Sphere()
    told = vizlight.provenance(relief_shadow(ball, SCENE, samples=2), "t")
    assert told["options"]["occluders"] == []
    again = relief_shadow(ball, Scene.from_dict(told["scene"]), **told["options"])
    np.testing.assert_array_equal(again["t"], relief_shadow(ball, SCENE, samples=2)["t"])
    other = pv.Sphere(center=TOWARD)
    told = vizlight.provenance(relief_shadow(ball, SCENE, occluders=(o for o in [other])), "t")
    assert told["options"]["occluders"] == [f"PolyData of {other.n_points} points"]
    for wrong in (0, told["options"]["occluders"]):
        with pytest.raises(TypeError, match="occluders.*: expected .*surface"):
            relief_shadow(ball, SCENE, occluders=wrong)


@pytest.mark.parametrize(
    "when",
    [
        {"latitude": 0.7, "day": 172, "hours": np.array([3.0, 9, 12])},
        {"directions": [(0, 1, 1), (1, 0, -1)]},
    ],
)
def test_a_day_is_made_again_from_what_is_told(when):
    grid, _ = grids()["warped"]
    day = relief_day(grid, depth=0.2, name="sunlit", **when)
    told = vizlight.provenance(day, "sunlit")
    assert told["filter"] == "relief_day"
    again = relief_day(grid, **told["options"])
    np.testing.assert_array_equal(again["sunlit"], day["sunlit"])
    assert vizlight.provenance(again, "sunlit") == told
