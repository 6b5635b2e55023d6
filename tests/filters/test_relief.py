"""Shadows as point scalars: every kind of grid, several lights, real terrain."""

import warnings

import numpy as np
import pytest
import pyvista as pv
import scipy
from fields import X, Y, Z, grids, level, step
from lamps import DEFAULT, SHINY, shiny
from refusals import refusals

import vizlight
from studies.relief import hills
from vizlight import Light, Material, Scene, cartography, relief_day, relief_shadow
from vizlight.filters import relight
from vizlight.filters.relief_shadow import Shadows
from vizlight.geometry import relief, sun
from vizlight.geometry.relief import height_field
from vizlight.mesh import georeference

TOWARD = np.array([0.6, -0.5, 0.4])
SCENE = Scene(lights=Light(direction=TOWARD), material=shiny(ambient=0.1, specular=0))


def continued_shadow(x, y, z, **options):
    """Return the shadow of a field whose slopes go on for a cell beyond its border."""
    return relief.shadow(*height_field.continued(x, y, z), **options)[1:-1, 1:-1]


@pytest.mark.parametrize("kind", grids())
def test_every_kind_of_grid_has_the_same_shadow(kind):
    grid, options = grids()[kind]
    before = grid.copy()
    out = relief_shadow(grid, SCENE, depth=0.2, **options)
    assert grid == before
    assert type(out) is type(grid)
    assert out.active_scalars_name == "t"
    expected = continued_shadow(X, Y, Z, depth=0.2, direction=TOWARD)
    i = np.rint((np.asarray(out.points)[:, 0] - X[0]) / 0.5).astype(int)
    j = np.rint((np.asarray(out.points)[:, 1] - Y[0]) / 0.25).astype(int)
    np.testing.assert_allclose(out["t"], expected[j, i], atol=1e-6)
    assert out["t"].min() < 0.3 < 0.6 < out["t"].max()


def about_z(degrees):
    a = np.radians(degrees)
    return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])


@pytest.mark.parametrize("angle", [30, 90, 200, -45.5])
@pytest.mark.parametrize("kind", ["ImageData", "StructuredGrid"])
def test_a_turned_grid_has_its_shadow_turned(kind, angle):
    """As the grid lies straight: t, and points, normals and near lights of the engine."""
    x, y = np.arange(30.0), np.arange(20.0)
    z = 2 * np.exp(-((x - 12) ** 2 + (y[:, None] - 9) ** 2) / 9)
    turn, move = about_z(angle), np.zeros(3)
    if kind == "ImageData":
        grid = pv.ImageData(dimensions=(30, 20, 1))
        grid["height"] = z.ravel()
        turned = grid.copy()
        turned.direction_matrix = turn
    else:
        move = np.array([50, -7, 0])
        grid = pv.StructuredGrid(*np.meshgrid(x, y), z)
        turned = grid.copy()
        turned.points = grid.points @ turn.T + move
    one, other = (
        relief_shadow(
            mesh,
            Scene(
                lights=[Light(direction=way), Light(position=place)], material=shiny(specular=0)
            ),
            depth=0.4, lit=True, components=True,
        )
        for mesh, way, place in (
            (grid, (1, 2, 0.6), (20, 15, 6)),
            (turned, turn @ (1, 2, 0.6), turn @ (20, 15, 6) + move),
        )
    )  # fmt: skip
    assert np.ptp(one["t_0"]) > 0.5
    for name in ("t_0", "t_1", "t", "luminance"):
        np.testing.assert_allclose(other[name], one[name], atol=2e-6)


@pytest.mark.sampled(5)
@pytest.mark.parametrize("angle", [1e-5, 0.2, 89.9])
@pytest.mark.parametrize("kind", ["ImageData", "StructuredGrid"])
@pytest.mark.parametrize(
    ("size", "spacing", "origin"),
    [((100, 100), 10, (5e5, 5e6)), ((40, 30), 0.5, (5e6, 4e6)), ((2, 500), 0.5, (5e6, 4e6))],
)
def test_a_turned_grid_at_map_coordinates(size, spacing, origin, angle, kind):
    """Flat, so t is the cosine; a ridge along y tells that the rows are turned too."""
    grid = pv.ImageData(dimensions=(*size, 1), spacing=(spacing,) * 3, origin=(*origin, 0))
    turn = about_z(angle)
    grid.direction_matrix = turn
    if kind == "StructuredGrid":
        grid = grid.cast_to_structured_grid()
    assert np.asarray(grid.points).dtype == np.float64
    straight = pv.ImageData(dimensions=(*size, 1), spacing=(spacing,) * 3)
    ridge = spacing * np.abs(np.arange(size[0]) - size[0] // 2)
    for heights in (np.zeros(size[0]), -ridge):
        straight["h"] = grid["h"] = np.tile(heights, size[1]).astype(float)
        way = np.array([3.0, 1, 4])
        turned = Scene(lights=Light(direction=turn @ way), material=SHINY)
        t = relief_shadow(grid, turned, elevation="h")["t"]
        expected = relief_shadow(straight, Scene(lights=Light(direction=way), material=SHINY))["t"]
        np.testing.assert_allclose(t, expected, atol=1e-6)


def test_grid_in_float32_far_from_the_origin():
    x, y = np.arange(9) * 32, np.arange(7) * 32
    places = np.meshgrid(5e6 + x, 5.1e6 + y, 0.0, indexing="ij")
    far = pv.StructuredGrid(*np.float32(places))
    far["height"] = 100 * Z.ravel().astype(np.float32)
    t = relief_shadow(far, SCENE, depth=30, elevation="height")["t"]
    expected = continued_shadow(x, y, 100 * Z, depth=30, direction=TOWARD)
    np.testing.assert_allclose(t, expected.ravel(), atol=1e-5)


def test_factor_and_default_depth():
    grid, _ = grids()["ImageData"]
    tall = grid.copy()
    tall["height"] = 3 * Z.ravel()
    np.testing.assert_allclose(
        relief_shadow(grid, SCENE, exaggeration=3.0)["t"], relief_shadow(tall, SCENE)["t"]
    )
    step = (np.abs(np.diff(Z, axis=0)).mean() + np.abs(np.diff(Z, axis=1)).mean()) / 2
    for factor, depth in ((1.0, 0.25 / 8), (0.2, 0.1 * step)):
        out = relief_shadow(grid, SCENE, exaggeration=factor)
        assert vizlight.provenance(out, "t")["depth"] == pytest.approx(depth, rel=1e-12)
        given = relief_shadow(grid, SCENE, exaggeration=factor, depth=depth)
        np.testing.assert_allclose(out["t"], given["t"], atol=1e-12)


def test_sun_in_degrees():
    grid, _ = grids()["ImageData"]
    for azimuth, altitude, way in (
        (0, 30, (0, 3**0.5, 1)), (90, 45, (1, 0, 1)), (-90, 60, (-1, 0, 3**0.5)),
        (225, 20, (-1, -1, np.sqrt(2) * np.tan(np.radians(20)))),
    ):  # fmt: skip
        scene = SCENE.replace(lights=Light(direction=way))
        expected = relief_shadow(grid, scene, lit=True)
        found = relief_shadow(grid, SCENE, sun=(azimuth, altitude), lit=True)
        np.testing.assert_allclose(found["t"], expected["t"], atol=1e-12)
        np.testing.assert_allclose(found["luminance"], expected["luminance"], atol=1e-12)
        day = relief_day(grid, sun=[(azimuth, altitude), (10, -5)])
        np.testing.assert_allclose(day["t"][:, 0], expected["t"], atol=1e-12)
        assert not day["t"][:, 1].any()
    found, expected = relief_shadow(grid)["t"], relief_shadow(grid, Scene(lights=DEFAULT))["t"]
    np.testing.assert_allclose(found, expected, atol=1e-5)


def test_a_surface_is_sampled_on_request():
    """The same terrain as a grid of even rows, as bent rows, and as triangles."""
    x = np.linspace(-3, 3, 121)
    u, v = np.meshgrid(x, x)
    height = lambda x, y: np.exp(-(x**2) - y**2)  # noqa: E731
    square = relief_shadow(pv.StructuredGrid(u, v, height(u, v)), sun=(70, 15), depth=0.05)
    bent_u, bent_v = u + 0.3 * np.sin(v), v + 0.2 * np.sin(u)
    bent = pv.StructuredGrid(bent_u, bent_v, height(bent_u, bent_v))
    before = bent.copy()
    tin = bent.extract_surface(algorithm="geometry").triangulate()
    own = square.find_closest_point
    for mesh in (bent, tin):
        with pytest.raises(ValueError, match="raster="):
            relief_shadow(mesh, sun=(70, 15), depth=0.05)
        out = relief_shadow(mesh, sun=(70, 15), depth=0.05, raster=0.03, lit=True)
        assert type(out) is type(mesh)
        assert out.n_points == mesh.n_points
        assert vizlight.provenance(out, "t")["options"]["raster"] == 0.03
        inner = np.flatnonzero(np.abs(np.asarray(mesh.points)[:, :2]).max(axis=1) < 2.4)[::7]
        nearest = [own(p) for p in np.asarray(mesh.points)[inner]]
        error = np.abs(out["t"][inner] - square["t"][nearest])
        # The nearest point of the other grid is up to half a cell of 0.05 away.
        assert error.mean() < 0.02
        assert out["t"].min() < 0.1
        np.testing.assert_allclose(out["luminance"], 0.3 + 0.7 * out["t"], atol=1e-9)
    assert bent == before


def test_holes_are_marked():
    grid, _ = grids()["ImageData"]
    grid["height"][[3, 4]] = np.nan
    with pytest.warns(UserWarning, match="2 of 63 points have no height and t = 0"):
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


def shapes():
    """Terrain as it is, exaggerated, flattened, coarse, as triangles of bent rows, and real."""
    x, z = np.linspace(0, 1, 120), hills(120)
    flat = pv.ImageData(dimensions=(120, 120, 1), spacing=(1 / 119, 1 / 119, 1))
    flat["height"] = z.ravel()
    coarse = flat.extract_subset((0, 119, 0, 119, 0, 0), rate=(3, 3, 1))
    u, v = np.meshgrid(x, x)
    bent = pv.StructuredGrid(u + 0.1 * v * v + 0.2 * u * u, v + 0.1 * np.sin(2 * u), z)
    part = vizlight.load_example("earth_relief.vti").extract_subset((750, 850, 340, 390, 0, 0))
    himalaya = pv.ImageData(dimensions=part.dimensions, spacing=(32.1, 37.1, 1))
    himalaya["height"] = np.asarray(part["elevation"], dtype=float) / 100
    return {
        "hills": (flat, {}),
        "exaggerated": (flat, {"exaggeration": 10.0}),
        "flattened": (flat, {"exaggeration": 0.4}),
        "coarse": (coarse, {}),
        "TIN": (bent.extract_surface(algorithm="geometry").triangulate(), {"raster": 0}),
        "himalaya": (himalaya, {"elevation": "height"}),
    }


@pytest.mark.sampled(2)
@pytest.mark.parametrize("kind", shapes())
def test_shadows_of_the_default_depth_are_as_large_as_hard_ones(kind):
    grid, options = shapes()[kind]
    for azimuth in (50, 200):
        # Below half the light of level ground is dark.
        soft, hard = (
            np.mean(relief_shadow(grid, sun=(azimuth, 10), **options, **depth)["t"] < 0.0868)
            for depth in ({}, {"depth": 0})
        )
        assert hard > 0.05
        assert soft == pytest.approx(hard, rel=0.2)


def test_a_disc_softens_the_edge_and_keeps_the_middle():
    x = np.linspace(0, 4, 401)
    grid = pv.ImageData(dimensions=(401, 3, 1), spacing=(0.01, 1, 1))
    grid["height"] = np.tile(np.where(x > 3, 1.0, 0.0), 3)
    scene = Scene(lights=Light(direction=(1, 0, 0.5)), material=SHINY)
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


def test_in_place_again_and_the_users_own_array():
    grid, _ = grids()["ImageData"]
    assert relief_shadow(grid, SCENE, inplace=True) is grid
    several = pv.MultiBlock([grid, grid.copy()])
    assert relief_shadow(several, SCENE, inplace=True) is several
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


def flat(*dimensions):
    grid = pv.ImageData(dimensions=dimensions)
    grid["height"] = np.zeros(grid.n_points)
    return grid


def curved():
    r, a = np.meshgrid(np.linspace(1, 2, 5), np.linspace(0, 1, 6), indexing="ij")
    return pv.StructuredGrid(r * np.cos(a), r * np.sin(a), 0 * r)


def tilted(angle, axis):
    grid = level()
    c, s = np.cos(angle), np.sin(angle)
    about_x = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    grid.direction_matrix = np.roll(about_x, axis, axis=(0, 1))
    return grid


BALL = pv.Sphere(theta_resolution=8, phi_resolution=8)


def bad_input(mesh, options):
    before = None if mesh is None else mesh.copy()
    try:
        relief_shadow(mesh, SCENE, **options)
    finally:
        assert mesh == before


test_bad_input = refusals(
    bad_input,
    (level(), {"depth": -1}, "depth: expected a finite number of at least 0"),
    (level(), {"elevation": "z"}, r"elevation: .*one of \['height'\], got 'z'"),
    (pv.ImageData(dimensions=(3, 3, 1)), {}, "elevation: expected a point array"),
    (level(height=np.full(16, np.nan)), {}, "z: expected heights, got NaN"),
    (flat(3, 3, 3), {}, "mesh: expected a grid of one layer, nx x ny x 1, got 3 x 3"),
    (flat(4, 1, 1), {}, "y: expected two nodes or more.*repeat the row"),
    (curved(), {}, "mesh: expected rows and columns that are straight"),
    (tilted(0.3, 0), {}, "mesh: expected a grid that lies level.*thickness="),
    (tilted(-1e-3, 1), {}, "mesh: expected a grid that lies level"),
    (tilted(np.pi / 2, 0), {}, "mesh: expected a grid that lies level"),
    (
        tilted(np.pi / 2, 1).cast_to_structured_grid(),
        {"elevation": "height"},
        "mesh: expected a grid that lies level",
    ),
    (pv.ImageData(), {}, "mesh: expected a grid of points, got an empty one"),
    (level(), {"sun": (1, 2, 3)}, "sun: expected two angles in degrees"),
    (level(), {"sun": (0, 91)}, "sun: expected .* -90 to 90 degrees, got [(]0.0, 91.0[)]"),
    (BALL, {"sun": (70, 15), "raster": -1}, "raster: expected"),
    (BALL, {"sun": (70, 15), "raster": 7.0}, "raster: expected"),
    (BALL, {"sun": (70, 15), "raster": np.nan}, "raster: expected"),
    (BALL, {"sun": (70, 15), "raster": 1e-6}, "raster: expected a raster of at most"),
    (pv.UnstructuredGrid(), {"sun": (70, 15), "raster": 0}, "mesh: expected a surface with faces"),
    (level(), {"thickness": 1}, "thickness: expected none on a height field"),
    (level(), {"border": "x"}, "border: expected 'extend' or 'wall'"),
    (level(), {"samples": 0}, "samples: expected an integer of at least 1"),
    (level(), {"angular_diameter": -1}, "angular_diameter: expected a number"),
    (level(), {"name": ""}, "name: expected a name for the point array"),
    (BALL, {"depth": -1}, "depth: expected a finite number of at least 0"),
    (BALL, {"elevation": "z"}, "elevation: expected none on a surface"),
    (BALL, {"exaggeration": 2}, "exaggeration: expected none on a surface, got 2"),
    (BALL, {"border": "wall"}, "border: expected none on a surface, got 'wall'"),
    (BALL, {"thickness": 0}, "thickness: expected a number above 0"),
    (BALL, {"occluders": [pv.Plane()]}, r"occluders\[0\]: expected a closed"),
    (pv.Line(), {}, "mesh: expected a surface with faces"),
    (pv.UnstructuredGrid(), {}, "mesh: expected a surface with faces"),
    (None, {}, "mesh: expected a height field", TypeError),
)


def test_bad_lights():
    for mesh, place in ((level(), (1, 1, -2)), (BALL, (0.1, 0, 0))):
        inside = Scene(lights=Light(position=place), material=SHINY)
        with pytest.raises(ValueError, match="position: expected a light outside the solid"):
            relief_shadow(mesh, inside)
        with pytest.raises(ValueError, match="scene: expected a light of intensity above 0"):
            relief_shadow(mesh, Scene(lights=[], material=SHINY))


@pytest.mark.parametrize(
    ("name", "options"),
    [("luminance", {}), ("diffuse", {"components": True}), ("luminance_valid", {})],
)
def test_the_shadow_does_not_replace_the_light(name, options):
    field = pv.ImageData(dimensions=(4, 4, 1))
    field["h"] = np.zeros(16)
    with pytest.raises(ValueError, match="name: expected a name that the light does not use"):
        vizlight.relief_shadow(field, SCENE, lit=True, name=name, **options)
    assert field.array_names == ["h"]


def test_shadows_that_end_within_large_triangles_are_told():
    part = step(20)
    scene = Scene(lights=Light(direction=(-2, 1, 0.2)))
    with pytest.warns(UserWarning, match=r"shadows end within triangles .*subdivide\(3"):
        relief_shadow(part, scene, feature_angle=30)
    fine = relief_shadow(part.subdivide(3, "linear"), scene, feature_angle=30)
    assert 0 < fine["t"].mean() < 1
    # A shadow ends on the long triangles beside a ridge, whose own are as small as the raster.
    x = np.array([0, 1, 1.1, 1.2, 1.3, 8])
    grid = pv.StructuredGrid(*np.meshgrid(x, [0, 4.0, 8.0], indexing="ij"), np.zeros((6, 3)))
    grid.points[:, 2] = np.where(np.isclose(grid.points[:, 0], 1.1), 0.4, 0)
    open_ = grid.extract_surface(algorithm=None).triangulate()
    with pytest.warns(UserWarning, match="shadows end within triangles"):
        relief_shadow(open_, Scene(lights=Light(direction=(-1, 0, 1))), raster=0.1)


@pytest.mark.parametrize("kind", ["image", "raised flat"])
def test_a_lit_field_whose_heights_were_active_can_be_lit_again(kind):
    field = pv.ImageData(dimensions=(9, 8, 1))
    field["h"] = np.sin(np.arange(72.0))
    field = field if kind == "image" else field.cast_to_structured_grid()
    lit = relief_shadow(field, sun=(315, 30), lit=True)
    assert lit.point_data.active_scalars_name != "h"
    relight.from_record(lit)


@pytest.mark.parametrize("hole", [False, True])
def test_a_plane_is_lit_alike_at_its_border_and_beside_a_hole(hole):
    y, x = np.mgrid[:30, :40]
    grid = pv.ImageData(dimensions=(40, 30, 1))
    z = 0.6 * x - 0.1 * y
    if hole:
        z[10:14, 8:20] = np.nan
    grid["h"] = z.ravel()
    normal = np.array([-0.6, 0.1, 1]) / np.linalg.norm([0.6, 0.1, 1])
    there = np.isfinite(grid["h"])
    for azimuth in (90, 270, 30, 135):
        cosine = float(normal @ sun.toward(azimuth, 40))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            t = relief_shadow(grid, sun=(azimuth, 40))["t"]
        np.testing.assert_allclose(t[there], max(cosine, 0), atol=0.01 if cosine > 0 else 0.05)


def test_a_shadow_is_cast_once_for_a_field_and_its_picture_as_is_its_sky(calls_of, monkeypatch):
    field = pv.ImageData(dimensions=(12, 12, 1))
    field["height"] = 2 * np.sin(np.arange(144.0))
    shadowed = relief_shadow(field, sun=(315, 40), lit=True, occlusion="sky")
    cast = calls_of(Shadows, "ratios")
    monkeypatch.setattr("vizlight.filters.sky.skies", lambda *_, **__: cast.append(1))
    (source,), _ = relight.from_record(shadowed)
    assert not cast
    np.testing.assert_array_equal(source.inputs.shadow[:, 0], shadowed["t"])
    np.testing.assert_array_equal(source.inputs.occlusion, shadowed["sky"])
    # Another light, or an array of another call, does not fit.
    other = Scene(lights=Light(direction=(1, 0, 1)))
    relight.from_record(shadowed, other)
    relief_shadow(shadowed, other, inplace=True, elevation="height")
    relight.from_record(shadowed)
    assert len(cast) == 3
    shadowed["height"][50:90] += 3
    with pytest.raises(ValueError, match="matches its record"):
        relight.from_record(shadowed)


@pytest.mark.parametrize("kind", ["field", "ball"])
def test_shadows_of_several_lights_are_kept_with_their_components(kind, calls_of):
    mesh = pv.Sphere()
    if kind == "field":
        mesh = pv.ImageData(dimensions=(12, 12, 1))
        mesh["height"] = 2 * np.sin(np.arange(144.0))
    lights = [Light(direction=(1, 0, 1)), Light(direction=(0, 1, 1), intensity=0.5)]
    lit = relief_shadow(mesh, Scene(lights=lights), lit=True, components=True)
    moved = lit.translate((1.0, 0, 0)) if kind == "ball" else lit.copy()
    moved["t_0"] = np.array(moved["t_0"]) if kind == "ball" else 0.5 * moved["t_0"]
    cast = calls_of(Shadows, "ratios")
    (source,), _ = relight.from_record(lit)
    np.testing.assert_array_equal(source.inputs.shadow, np.stack([lit["t_0"], lit["t_1"]], axis=1))
    assert not cast
    relight.from_record(moved)
    assert cast


def lit_on_a_sphere(longitudes, latitudes, heights, azimuth, altitude):
    """Return t at depth 0 by rays in geocentric coordinates, through ground that is bilinear."""
    radius = georeference.METRES * 180 / np.pi
    east, north = np.meshgrid(*np.radians([longitudes, latitudes]))
    zenith = np.stack([np.cos(north) * np.cos(east), np.cos(north) * np.sin(east), np.sin(north)])
    places = (radius + heights) * zenith
    right = np.stack([-np.sin(east), np.cos(east), 0 * east])
    level = np.sin(azimuth) * right + np.cos(azimuth) * np.cross(zenith, right, axis=0)
    way = np.cos(altitude) * level + np.sin(altitude) * zenith
    sides = (np.gradient(places, edge_order=2, axis=axis) for axis in (2, 1))
    normals = np.cross(*sides, axis=0)
    cosine = np.einsum("i...,i...", normals, way) / np.linalg.norm(normals, axis=0)
    steps = np.diff(np.radians(latitudes))[0], np.diff(np.radians(longitudes))[0]
    lit = cosine > 0
    step = radius * steps[0] * np.cos(north).min() / 8
    for distance in np.arange(step, np.ptp(heights) / np.tan(altitude), step):
        x, y, z = places + distance * way
        far = np.sqrt(x * x + y * y + z * z)
        rows = (np.arcsin(z / far) - north[0, 0]) / steps[0]
        columns = (np.arctan2(y, x) - east[0, 0]) / steps[1]
        ground = scipy.ndimage.map_coordinates(heights, [rows, columns], order=1, mode="nearest")
        lit &= far - radius > ground - 1
    return np.where(lit, cosine, 0)


@pytest.mark.parametrize(
    ("span", "middle", "most"), [(1, 60, 0.004), (10, 60, 0.008), (60, 50, 0.03), (150, 0, 0.03)]
)
def test_maps_in_degrees_have_the_shadows_of_a_sphere(span, middle, most, random):
    """From the equator to 80 degrees north, heights such that some third is in shadow."""
    count = 60
    waves = np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(count)])) + 1 / count
    rough = np.fft.ifft2(np.fft.fft2(random.normal(size=2 * (count,))) / waves**1.2 * (waves < 0.2))
    heights = 0.2 * span / count * georeference.METRES * rough.real / np.diff(rough.real).std()
    longitudes = np.linspace(0, span, count)
    latitudes = middle + np.linspace(-span / 2, span / 2, count)
    grid = cartography.in_degrees(pv.RectilinearGrid(longitudes, latitudes, [0.0]))
    grid["height"] = heights.ravel()
    t = np.asarray(relief_shadow(grid, sun=(250, 12), depth=0)["t"]).reshape(heights.shape)
    expected = lit_on_a_sphere(longitudes, latitudes, heights, *np.radians([250, 12]))
    assert 0.2 < np.mean(expected == 0) < 0.6
    assert np.abs(t - expected)[4:-4, 4:-4].mean() < most
