"""The sky as a filter: kinds of meshes, records, marks, and what the ambient light makes of it."""

import warnings

import numpy as np
import pytest
import pyvista as pv
from fields import step
from lamps import far
from refusals import refusals
from vectors import unit

import vizlight
from vizlight import _compiled
from vizlight.draw import live
from vizlight.filters import relight
from vizlight.geometry.relief import sky as fields
from vizlight.mesh import closed_meshes, sky
from vizlight.shading import engine
from vizlight.shading.options import LightOptions

pytest.importorskip("embreex")
SCENE = far((1, 1, 1), (0, 0, 1), vizlight.Material(ambient=0.5, diffuse=0.4, specular=0.3))


def valley(count=21):
    """Return a flat grid with the heights of a valley along y."""
    grid = pv.ImageData(dimensions=(count, count, 1), origin=(-10, -10, 0))
    grid["height"] = np.abs(grid.points[:, 0])
    return grid


def balls(apart=1.2):
    """Return two balls that hide a part of each other's sky."""
    return [pv.Sphere(center=(x, 0, 0), theta_resolution=16) for x in (0.0, apart)]


def both(apart=1.05):
    """Return them as one mesh."""
    return pv.merge(balls(apart), merge_points=False)


def test_kinds_of_height_fields_agree():
    flat = valley()
    found = vizlight.sky(flat, error=0.02)
    assert found.active_scalars_name == "height"
    assert "sky" not in flat.point_data
    record = vizlight.provenance(found, "sky")
    assert record["method"].startswith("horizons")
    assert record["error"] <= 0.02
    assert record["rays"] == record["directions"] * flat.n_points
    warped = flat.warp_by_scalar("height")
    assert isinstance(warped, pv.StructuredGrid)
    rectilinear = flat.cast_to_rectilinear_grid()
    for other in (warped, rectilinear, flat.cast_to_structured_grid().warp_by_scalar("height")):
        np.testing.assert_allclose(vizlight.sky(other, error=0.02)["sky"], found["sky"], atol=1e-6)
    # The same as a surface below the half space above, whose border is open.
    surface = warped.extract_surface(algorithm="dataset_surface")
    rays = vizlight.sky(surface, error=0.02, up=(0, 0, 1), feature_angle=None)
    inner = (np.abs(surface.points[:, :2]) < 5).all(axis=1)
    same = found["sky"][surface["vtkOriginalPointIds"]]
    assert np.abs(rays["sky"] - same)[inner].mean() < 0.05


def test_more_error_than_requested_is_said(monkeypatch):
    """Both figures, in a warning, the record and the check."""
    monkeypatch.setattr(fields, "MOST", fields.FEWEST)
    rough = pv.ImageData(dimensions=(20, 20, 1))
    rough["height"] = np.random.default_rng(0).normal(size=400)
    words = r"error of the sky is 0\.\d+ .* error=0.001 was requested"
    with pytest.warns(UserWarning, match=words):
        found = vizlight.sky(rough, error=0.001)
    record = vizlight.provenance(found, "sky")
    assert record["error"] > record["requested"] == 0.001
    assert "(0.001 was requested)" in str(vizlight.check(found, name="sky"))


def test_a_curvilinear_grid_is_below_the_sky_of_a_field():
    angle, radius = np.meshgrid(np.linspace(0, 1.5, 20), np.linspace(1, 2, 15))
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    bent = pv.StructuredGrid(x, y, 0 * x)
    found = vizlight.sky(bent)
    assert vizlight.provenance(found, "sky")["method"].startswith("rays")
    assert (found["sky"] == 1).all()


def test_blocks_hide_one_another_and_a_field_sees_itself():
    near, far = (vizlight.sky(pv.MultiBlock(balls(x)), error=0.02) for x in (1.05, 50.0))
    assert near[0]["sky"].min() < 0.3
    assert far[0]["sky"].min() > 0.98
    mixed = vizlight.sky(pv.MultiBlock([valley(), *balls()]), error=0.05)
    alone = vizlight.sky(valley(), error=0.05)
    assert np.array_equal(mixed[0]["sky"], alone["sky"])


def test_ghost_cells_hide_the_sky_and_hidden_ones_do_not():
    piece = both()
    first = piece.n_cells // 2
    whole = vizlight.sky(piece, error=0.02)["sky"]
    ghosts = np.zeros(piece.n_cells, np.uint8)
    for mark, hides in ((1, True), (32, False)):
        ghosts[first:] = mark
        piece.cell_data["vtkGhostType"] = ghosts
        with warnings.catch_warnings():
            # Points of hidden cells alone have no sky.
            warnings.filterwarnings("ignore", message=".* points have no sky")
            found = vizlight.sky(piece, error=0.02)["sky"]
        side = np.abs(piece.points[:, 0]) < 0.6
        assert (found[side].min() < 0.3) == hides
        if hides:
            np.testing.assert_allclose(found, whole, atol=0.05)


def test_volumes_and_lines():
    box = pv.ImageData(dimensions=(6, 6, 6)).cast_to_unstructured_grid()
    with (
        pytest.warns(UserWarning, match="64 of 216 points have no sky"),
        pytest.warns(UserWarning, match=r"edges are sharper .* take the extract_surface\(\)"),
    ):
        found = vizlight.sky(box)
    assert found["sky"].min() > 0.98
    assert np.count_nonzero(~found["sky_valid"]) == 64
    turn = np.linspace(0, 40, 800)
    spiral = pv.lines_from_points(np.stack([np.cos(turn), np.sin(turn), 0.02 * turn], axis=1))
    thin, thick = (vizlight.sky(spiral, error=0.05, diameter=d)["sky"].mean() for d in (1e-3, 0.1))
    assert thin > 0.9
    assert thick < 0.75
    record = vizlight.provenance(vizlight.sky(spiral, error=0.2), "sky")
    assert record["method"] == "voxels"
    assert record["error"] <= 0.2


def test_points_without_a_sky_are_marked_and_have_that_of_the_nearest():
    with pytest.warns(UserWarning, match="have no sky"):
        found = vizlight.sky(both(0.4), error=0.05)
    # The points of each ball that lie inside the other.
    first, second = np.split(np.asarray(found.points), 2)
    inside = np.concatenate([np.linalg.norm(first - (0.4, 0, 0), axis=1) < 0.48,
                             np.linalg.norm(second, axis=1) < 0.48])  # fmt: skip
    assert not found["sky_valid"][inside].any()
    assert found["sky"].min() > 0.5
    hole = valley()
    hole["height"][30:33] = np.nan
    with pytest.warns(UserWarning, match="3 of 441 points have no sky"):
        found = vizlight.sky(hole, error=0.05)
    assert np.isfinite(found["sky"]).all()
    assert np.flatnonzero(~found["sky_valid"]).tolist() == [30, 31, 32]


def test_points_of_creases_see_the_sky_of_each_side():
    part = step()
    split = vizlight.mesh.normals.split_edges(part, "auto")
    assert split.n_points == 36
    found = vizlight.sky(split, feature_angle=None)
    assert "sky_valid" not in found.point_data
    # Beside the end of the inner edge something between a half and three quarters is free.
    inner = (found.points[:, :2] == [2, 1]).all(axis=1)
    assert np.sort(found["sky"][inner]).tolist() == pytest.approx([0.63] * 4 + [1] * 2, abs=0.05)
    assert found["sky"][~inner].min() > 0.9


def test_triangles_inside_of_which_the_sky_changes_are_split():
    part = step(20)
    part["place"] = part.points
    part["label"] = np.arange(part.n_points)
    with pytest.warns(UserWarning, match="sky changes inside .*; feature_angle=30 splits") as told:
        coarse = vizlight.sky(part, feature_angle=None)
    assert coarse.n_points == part.n_points == 12
    between = vizlight.provenance(coarse, "sky")["between"]
    assert f"off by {between:.2f} or more" in str(told[0].message)
    fine = vizlight.sky(part)
    assert vizlight.provenance(fine, "sky")["between"] < 0.1
    assert fine.volume == pytest.approx(part.volume)
    assert fine.area == pytest.approx(part.area)
    np.testing.assert_allclose(fine["place"], fine.points, atol=1e-5)
    assert set(fine["label"]) == set(range(12))
    sides = fine.extract_all_edges().compute_cell_sizes()["Length"]
    assert sides.max() <= part.length / 32 + 1e-6
    # It is lit as it was: its creases stay, and new points have the normals of their faces.
    lit = vizlight.illuminate(fine, SCENE, occlusion="sky", components=True)
    np.testing.assert_allclose(lit["ambient"], 0.5 * fine["sky"], atol=1e-6)
    plain = vizlight.illuminate(part, SCENE, feature_angle="auto", components=True)
    assert len(np.unique(lit["diffuse"].round(4))) == len(np.unique(plain["diffuse"].round(4)))
    for made in (
        vizlight.illuminate(part, SCENE, occlusion="sky", feature_angle="auto"),
        vizlight.sky(part, inplace=True),
    ):
        assert made.n_points == fine.n_points
    assert part.n_points == fine.n_points


def test_a_coarse_ball_stays_round_where_its_triangles_are_split():
    """New points have normals between those of the corners, not of the flat faces."""
    ball = pv.Sphere(theta_resolution=12, phi_resolution=12).triangulate()
    floor = pv.Plane(center=(0, 0, -0.5), i_size=4, j_size=4, i_resolution=1, j_resolution=1)
    mesh = ball + floor
    mesh.clear_data()
    lit = vizlight.illuminate(mesh, SCENE, occlusion="sky", feature_angle=80, components=True)
    round_ = lit.points[:, 2] > -0.4
    assert np.count_nonzero(round_) > 2 * ball.n_points
    cosine = (lit["vizlight_normals"][round_, :3] * unit(lit.points[round_])).sum(axis=1)
    assert cosine.min() > np.cos(np.radians(5))


def test_points_that_see_nothing_are_counted():
    cave = pv.Sphere(theta_resolution=8, phi_resolution=8)
    cave["Normals"] *= -1
    cave.flip_faces(inplace=True)
    with pytest.warns(UserWarning, match=f"{cave.n_points} of {cave.n_points} points see nothing"):
        found = vizlight.sky(cave)
    assert not found["sky"].any()


def test_a_sky_that_is_older_than_the_mesh_is_told():
    known = vizlight.sky(both(1.2), error=0.05)
    for same in (known, known.triangulate(), known.clip("z")):
        vizlight.illuminate(same, SCENE, occlusion="sky")
    moved, fewer = known.copy(), known.copy()
    moved.points[0] *= 1.1
    fewer.faces = known.faces[:-4]
    for stale in (moved, fewer):
        with pytest.warns(UserWarning, match=r"have changed since .* vizlight.sky\(mesh\) finds"):
            vizlight.illuminate(stale, SCENE, occlusion="sky")
    part = pv.Box().clean()
    named = vizlight.sky(part, name="view", feature_angle=None)
    vizlight.illuminate(named, SCENE, occlusion="view", feature_angle="auto")


def test_a_check_states_the_errors():
    skylit = vizlight.sky(pv.MultiBlock([valley(), *balls()]), error=0.05)
    lines = str(vizlight.check(skylit, name="sky")).splitlines()
    assert [line.partition(",")[0] for line in lines] == [
        f"sky of {block.n_points} points: error {vizlight.provenance(block, 'sky')['error']:.2g} "
        "or less at 95 of 100 points"
        for block in skylit
    ]
    assert [";" in line for line in lines] == [False, True, True]
    lit = vizlight.illuminate(skylit, SCENE, occlusion="sky")
    assert str(vizlight.check(lit, sample=9)).splitlines()[:3] == lines


def test_lines_have_a_default_of_their_own():
    line = pv.lines_from_points(np.random.default_rng(0).random((200, 3)))
    default, asked = (vizlight.sky(line, error=error) for error in (None, 0.1))
    assert np.array_equal(default["sky"], asked["sky"])
    assert vizlight.provenance(vizlight.sky(balls()[0]), "sky")["error"] <= 0.01


def test_openness_and_names():
    found = vizlight.sky(valley(), openness=True, name="view", error=0.02)
    assert {"view", "view_openness"} <= set(found.point_data)
    middle = found["view_openness"].reshape(21, 21)[10, 10]
    assert np.pi / 4 < middle < np.pi / 2
    again = vizlight.sky(found, name="view", error=0.02, inplace=True)
    assert again is found
    assert "view_openness" not in found.point_data
    taken = valley()
    taken["sky"] = np.zeros(taken.n_points)
    with pytest.raises(ValueError, match="name: expected one under which"):
        vizlight.sky(taken)


@pytest.mark.parametrize("fast", ["0", "1"])
@pytest.mark.parametrize("color", [None, (1.0, 0.5, 0.2)])
def test_it_multiplies_the_ambient_term_alone(fast, color, monkeypatch):
    monkeypatch.setenv("VIZLIGHT_FAST", fast if not _compiled._missing() else "0")
    scene = SCENE.replace(material=vizlight.Material(ambient=0.5, diffuse=0.4, color=color))
    plain = vizlight.illuminate(both(), scene, components=True)
    lit = vizlight.illuminate(both(), scene, components=True, occlusion="sky")
    assert vizlight.check(lit, sample=40).error < 2e-6
    np.testing.assert_allclose(lit["ambient"], lit["sky"] * plain["ambient"], atol=1e-6)
    np.testing.assert_allclose(lit["diffuse"], plain["diffuse"], atol=1e-6)
    darker = plain["luminance"] - (1 - lit["sky"]) * plain["ambient"]
    np.testing.assert_allclose(lit["luminance"], darker, atol=1e-6)
    again = vizlight.illuminate(lit, scene, occlusion="sky")
    assert np.array_equal(again["luminance"], lit["luminance"])
    assert vizlight.provenance(lit)["options"]["occlusion"] == "sky"


def test_an_array_of_any_name_and_marked_points():
    ball = pv.Sphere()
    ball["shade"] = np.full(ball.n_points, 0.25)
    ball["shade"][3] = np.nan
    with pytest.warns(UserWarning, match="1 of .* could not be lit"):
        lit = vizlight.illuminate(ball, SCENE, occlusion="shade", components=True)
    assert not lit["luminance_valid"][3]
    assert lit["ambient"][5] == pytest.approx(0.125)
    for name, words in (("none", "'none'"), ("Normals", "3 components")):
        with pytest.raises(ValueError, match=f"occlusion: expected .*{words}"):
            vizlight.illuminate(ball, SCENE, occlusion=name)
    with pytest.raises(TypeError, match="occlusion: expected the name"):
        vizlight.illuminate(ball, SCENE, occlusion=3)


def test_refined_and_many_small_meshes():
    lit = vizlight.refine(pv.Sphere(), SCENE, occlusion="sky", error=0.02)
    assert lit["sky"].shape == (lit.n_points,)
    many = pv.MultiBlock(balls(1.05))
    found = vizlight.illuminate(many, SCENE, occlusion="sky")
    assert all(block["sky"].min() < 0.3 for block in found)
    assert "sky" not in many[0].point_data


def test_live_light_has_the_sky_of_the_mesh():
    mesh = both()
    (source,) = relight.from_options(mesh, SCENE, LightOptions(occlusion="sky"))
    assert source.mesh is mesh
    assert "sky" not in mesh.point_data
    assert live.unfit(source) == ""
    lit = vizlight.illuminate(mesh, SCENE, occlusion="sky")
    shading = engine.run(source.inputs, SCENE, source.options)
    np.testing.assert_allclose(shading.luminance, lit["luminance"], atol=1e-6)
    (again,), scene = relight.from_record(lit)
    assert np.array_equal(again.inputs.occlusion, lit["sky"])
    assert scene == SCENE


def test_sun_and_sky_of_a_map_in_one_call():
    flat = valley()
    sun = vizlight.Scene(lights=vizlight.Light(direction=(-1, 0, 0.5)), material=SCENE.material)
    bare = vizlight.relief_shadow(flat, sun, lit=True)
    lit = vizlight.relief_shadow(flat, sun, lit=True, occlusion="sky", exaggeration=2.0)
    steeper = flat.copy()
    steeper["height"] *= 2
    share = vizlight.sky(steeper, error=0.02)["sky"]
    plain = vizlight.relief_shadow(flat, sun, lit=True, exaggeration=2.0)
    dimmed = plain["luminance"] - 0.5 * (1 - share)
    np.testing.assert_allclose(lit["luminance"], dimmed, atol=1e-6)
    assert bare["luminance"].max() > lit["luminance"].max()
    with pytest.raises(ValueError, match="occlusion: expected lit=True"):
        vizlight.relief_shadow(flat, sun, occlusion="sky")


test_bad_input = refusals(
    lambda make, options: vizlight.sky(make(), **options),
    (lambda: pv.PolyData(np.zeros((3, 3))), {}, "mesh: expected a mesh with faces or lines"),
    (pv.PolyData, {}, "mesh: expected a mesh with faces or lines"),
    (pv.Sphere, {"error": 0}, "error"),
    (pv.Sphere, {"error": 1}, "error"),
    (pv.Sphere, {"up": (0, 0, 0)}, "up: expected a direction"),
    (pv.Sphere, {"up": (0, 1)}, "up: expected 3 components"),
    (pv.Sphere, {"diameter": 1.0}, "diameter: expected a mesh of lines"),
    (pv.Line, {"diameter": 0.0}, "diameter"),
    (pv.Sphere, {"openness": True}, "openness: expected a height field"),
    (valley, {"up": (1, 0, 0)}, "up: expected"),
    kind=(TypeError, ValueError),
)


def test_a_map_in_degrees_has_the_sky_of_one_in_metres():
    x, y = np.meshgrid(np.linspace(7, 7.1, 30), np.linspace(45, 45.1, 30))
    heights = 300 * np.sin(200 * x) * np.cos(150 * y)
    degrees = pv.StructuredGrid(x, y, 0 * x)
    metres = pv.StructuredGrid(
        111_195 * np.cos(np.radians(45.05)) * (x - 7.05), 111_195 * (y - 45.05), 0 * x
    )
    for grid in (degrees, metres):
        grid["height"] = heights.ravel(order="F")
    degrees.field_data["unit"] = ["degree"]
    found, expected = (vizlight.sky(grid)["sky"] for grid in (degrees, metres))
    assert expected.min() < 0.95
    np.testing.assert_allclose(found, expected, atol=2e-3)


def test_constant_heights_missing_heights_and_faces_of_no_size():
    flat = valley()
    flat["height"][:] = 3.0
    assert (vizlight.sky(flat)["sky"] == 1).all()
    flat["height"][:] = np.nan
    with pytest.raises(ValueError, match="NaN everywhere"):
        vizlight.sky(flat)
    none = pv.PolyData.from_regular_faces(np.zeros((3, 3)), [[0, 1, 2]])
    with pytest.warns(UserWarning, match="3 of 3 points have no sky"):
        assert (vizlight.sky(none)["sky"] == 1).all()


def test_without_embree_it_works_and_says_that_it_is_slow(monkeypatch):
    fast = vizlight.sky(both(), error=0.05)["sky"]
    monkeypatch.setattr(closed_meshes, "embree_tree", lambda _: None)
    monkeypatch.setattr(sky, "SLOW", 10)
    with pytest.warns(UserWarning, match="20 times as long without embreex"):
        slow = vizlight.sky(both(), error=0.05)["sky"]
    np.testing.assert_allclose(slow, fast, atol=0.05)


def test_a_piece_needs_the_sky_of_the_whole(tmp_path):
    def light(parts):
        for i, ball in enumerate(parts):
            ball.save(tmp_path / f"part{i}.vtp")
        files, out = f"{tmp_path}/part*.vtp", tmp_path / "lit.pvtp"
        vizlight.pieces.light(files, SCENE, out=out, occlusion="sky")

    with pytest.raises(vizlight.pieces.PieceError, match="occlusion: expected a point array"):
        light(balls())
    light(vizlight.sky(pv.MultiBlock(balls()), error=0.05))
