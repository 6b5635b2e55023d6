"""Positions and frames turn, are cut and projected together; light comes before or after."""

import numpy as np
import pytest
import pyvista as pv
from lamps import far
from refusals import refusals
from scipy.stats import special_ortho_group
from shapes import klein_bottle, sphere3
from vectors import unit

import vizlight
from vizlight import Material, engine, illuminate, project
from vizlight.geometry import manifolds, projection

TURN = special_ortho_group.rvs(4, random_state=3)
SCENE4 = far((0.7, 0.6, 0.38, 0.1), (0, 0.3, 1, 0.2))
SCENE3 = far((0.7, 0.6, 0.38), (0, 0.3, 1))


@pytest.fixture
def torus():
    return vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=(24, 16)))


def frames(mesh, name, n):
    return np.asarray(mesh[name]).reshape(mesh.n_points, -1, n)


def test_positions_and_frames_turn_together(torus):
    before = {key: np.array(value) for key, value in torus.point_data.items()}
    points = np.array(torus.points)
    out = project(torus, rotation=TURN)
    np.testing.assert_allclose(out["position"], before["position"] @ TURN.T, atol=1e-14)
    np.testing.assert_allclose(
        frames(out, "frame", 4), frames(torus, "frame", 4) @ TURN.T, atol=1e-14
    )
    np.testing.assert_array_equal(out.points, out["position"][:, :3])
    for key, value in before.items():
        np.testing.assert_array_equal(torus[key], value)
    np.testing.assert_array_equal(torus.points, points)
    np.testing.assert_array_equal(out.faces, torus.faces)


def test_pushed_frame_is_tangent_to_what_is_seen():
    """To the projected mesh's own edges, to first order, and orthonormal."""
    mesh = vizlight.manifold(manifolds.torus(1.0, 1.0, resolution=120), distance=2.0)
    frame = frames(mesh, "projected_frame", 3)
    gram = np.einsum("bki,bli->bkl", frame, frame)
    np.testing.assert_allclose(gram, np.tile(np.eye(2), (mesh.n_points, 1, 1)), atol=1e-14)
    normals = np.cross(frame[:, 0], frame[:, 1])
    computed = mesh.triangulate().compute_normals(cell_normals=False, split_vertices=False)
    along = np.abs(np.sum(normals * computed["Normals"], axis=1))
    assert along.min() > 0.999


def test_light_before_is_the_light_in_four_space(torus):
    lit = project(torus, rotation=TURN, distance=3.0, scene=SCENE4, light="before")
    turned = project(torus, rotation=TURN)
    expected = illuminate(turned, SCENE4, tangents="frame", positions="position")
    np.testing.assert_array_equal(lit["luminance"], expected["luminance"])
    back = far(TURN.T @ SCENE4.lights[0].direction, TURN.T @ SCENE4.view.direction)
    still = illuminate(torus, back, tangents="frame", positions="position")
    np.testing.assert_allclose(lit["luminance"], still["luminance"], atol=1e-12)


def test_light_after_is_the_light_in_three_space(torus):
    lit = project(torus, rotation=TURN, distance=3.0, scene=SCENE3, light="after")
    placed = project(torus, rotation=TURN, distance=3.0)
    frame = frames(placed, "projected_frame", 3)
    normals = np.cross(frame[:, 0], frame[:, 1])
    expected = engine.shade(placed.points, None, SCENE3, normals=normals, two_sided=True)
    np.testing.assert_allclose(lit["luminance"], expected.luminance, atol=1e-12)
    before = project(torus, rotation=TURN, scene=SCENE4)["luminance"]
    assert np.abs(lit["luminance"] - before).max() > 0.1


def test_silhouette_has_the_ambient_light_and_is_marked():
    """A plane seen edge-on in 4-space: its image is a line, of rank 1."""
    mesh = pv.Plane(i_resolution=2, j_resolution=2)
    x, y, _ = np.asarray(mesh.points, float).T
    mesh["position"] = np.stack([x, 0 * x, 0 * x, y], axis=1)
    mesh["frame"] = np.tile([1.0, 0, 0, 0, 0, 0, 0, 1], (9, 1))
    with pytest.warns(UserWarning, match="9 of 9 points could not be lit"):
        out = project(mesh, scene=SCENE3, light="after")
    np.testing.assert_allclose(out["projected_frame"], np.tile([1, 0, 0, 0, 0, 0.0], (9, 1)))
    np.testing.assert_array_equal(out["luminance"], 0.1)
    assert not out["luminance_valid"].any()
    before = project(mesh, scene=SCENE4, light="before")
    assert before["luminance"].min() > 0.11
    assert "luminance_valid" not in before.point_data


def test_near_a_silhouette_light_is_defined_and_continuous_along_the_frame():
    """The frame is known to eps over the angle: 1e-6 from edge-on loses 10 digits at most."""
    for tilt in (1e-2, 1e-6):
        mesh = pv.PolyData(np.zeros((1, 3)))
        mesh["position"] = np.zeros((1, 4))
        mesh["frame"] = [[1.0, 0, 0, 0, 0, np.sin(tilt), 0, np.cos(tilt)]]
        out = project(mesh, scene=SCENE3, light="after", exponent=1)
        flat = illuminate(out, SCENE3, tangents=np.array([[1.0, 0, 0, 0, 1, 0]]), exponent=1)
        np.testing.assert_allclose(out["luminance"], flat["luminance"], atol=1e-9)


def test_a_sphere_cut_by_a_hyperplane():
    sphere = vizlight.manifold(sphere3(10))
    assert isinstance(sphere, pv.UnstructuredGrid)
    assert "projected_frame" not in sphere.point_data
    cut = project(sphere, rotation=TURN, hyperplane=((1, 1, 0, 2), 0.4))
    x, normal = np.asarray(cut["position"]), np.array([1, 1, 0, 2]) / np.sqrt(6)
    np.testing.assert_allclose(x @ normal, 0.4, atol=1e-14)
    assert np.abs(np.linalg.norm(x, axis=1) - 1).max() < 0.02
    frame = frames(cut, "frame", 4)
    assert frame.shape[1] == 2
    assert np.abs(frame @ normal).max() < 1e-13
    # A 2-sphere: closed, V - E + F = 2, of radius sqrt(1 - 0.4^2).
    flat = pv.PolyData(x @ np.linalg.svd(normal[None])[2][1:].T, cut.faces)
    assert flat.n_open_edges == 0
    assert cut.n_points - 3 * cut.n_cells // 2 + cut.n_cells == 2
    flat = flat.compute_normals(consistent_normals=True, auto_orient_normals=True)
    assert flat.volume == pytest.approx(4 / 3 * np.pi * 0.84**1.5, rel=0.02)
    # Its normals in the hyperplane are along the radius.
    centre = unit(x - 0.4 * normal)
    assert np.abs(np.einsum("bki,bi->bk", frame, centre)).max() < 0.05


PLANE = ((0.3, -0.2, 0.5, 1), 0.05)


def test_tangents_of_a_cut_are_along_it():
    """Also where the surface is not orientable and neighbours' frames differ in sign."""
    curve = vizlight.manifold(klein_bottle(), hyperplane=PLANE)
    x, ends = np.asarray(curve["position"]), curve.lines.reshape(-1, 3)[:, 1:]
    step = x[ends[:, 1]] - x[ends[:, 0]]
    size = np.linalg.norm(step, axis=1)
    long = size > 1e-6 * size.max()
    for end in (0, 1):
        along = np.sum(unit(step[long]) * curve["frame"][ends[long, end]], axis=1)
        assert np.abs(along).min() > 0.99


def test_a_point_without_tangents_leaves_none_in_the_cut(torus):
    frame = np.array(torus["frame"])
    frame[np.asarray(torus["position"])[:, 0] > 1] = np.nan
    torus["frame"] = frame
    with pytest.warns(UserWarning, match="could not be lit"):
        cut = project(torus, hyperplane=PLANE, scene=SCENE4)
    bad = np.asarray(cut["luminance_valid"]) == 0
    assert np.asarray(cut["position"])[bad, 0].min() > 0.7
    assert 0 < bad.sum() < cut.n_points


def test_silhouettes_are_found_beyond_rounding():
    """Where the exact tangent would vanish, that of rounded numbers is noise, not a direction."""
    cells = np.stack([np.arange(5), np.arange(1, 6)], axis=1)
    points = np.c_[np.zeros((6, 3)), np.linspace(-1, 1, 6)]
    line = manifolds.Manifold(points, np.tile([[0, 0, 0, 1.0]], (6, 1, 1)), cells)
    there_and_back = [("xw", 0.7), ("xw", -0.7), ("yw", 0.2), ("yw", -0.2)]
    with pytest.warns(UserWarning, match="6 of 6 points could not be lit"):
        out = vizlight.manifold(line, rotation=there_and_back, scene=SCENE3, light="after")
    np.testing.assert_array_equal(out["projected_frame"], 0)
    np.testing.assert_array_equal(out["luminance"], 0.1)
    shape = manifolds.torus(1.5, 0.75, resolution=64)
    out = vizlight.manifold(shape, scene=SCENE3, light="after")
    edge = np.linalg.svd(shape.frame[..., :3], compute_uv=False)[:, 1] < 1e-15
    lost = ~np.any(frames(out, "projected_frame", 3)[:, 1], axis=1)
    np.testing.assert_array_equal(lost, edge)
    assert edge.sum() == 128


def test_a_fold_is_lit_by_the_limit_of_the_light(dtype):
    """The projected torus is a cylinder, lit as one up to the circles where it is folded."""
    shape = manifolds.torus(1.5, 0.75, resolution=64)
    mesh = vizlight.manifold(shape)
    for name in ("position", "frame"):
        mesh[name] = np.asarray(mesh[name]).astype(dtype)
    out = project(mesh, scene=SCENE3, light="after", components=True)
    edge = np.linalg.svd(shape.frame[..., :3], compute_uv=False)[:, 1] < 1e-15
    assert edge.sum() == 128
    outward = np.asarray(out.points, dtype=float) * (1, 1, 0)
    expected = engine.shade(
        out.points, None, SCENE3, normals=outward, two_sided=True, components=True
    )
    for name in ("diffuse", "specular", "luminance"):
        error = np.abs(out[name] - getattr(expected, name))
        assert error.max() < (2e-5 if dtype == np.float32 else 1e-12)
    assert "luminance_valid" not in out.point_data
    assert out["luminance"][edge].max() > 0.2


def test_a_pinch_point_has_no_limit():
    """Whitney's umbrella (u v, u, v^2): tangent planes turn around its pinch point."""
    u, v = np.meshgrid(np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    u, v = u.ravel(), v.ravel()
    none = np.zeros_like(u)
    grid = pv.Plane(i_resolution=20, j_resolution=20)
    grid.clear_data()
    grid["position"] = np.stack([u * v, u, v * v, v], axis=1)
    tangents = [np.stack([v, none + 1, none, none], 1), np.stack([u, none, 2 * v, none + 1], 1)]
    grid["frame"] = np.concatenate(tangents, axis=1)
    with pytest.warns(UserWarning, match="1 of 441 points could not be lit"):
        out = project(grid, scene=SCENE3, light="after")
    (dark,) = np.flatnonzero(np.asarray(out["luminance_valid"]) == 0)
    assert (u[dark], v[dark]) == (0, 0)
    assert out["luminance"][dark] == pytest.approx(0.1)


def test_silhouettes_in_float32(random):
    """The rounding of the arrays counts, not that of the work."""
    points = random.uniform(-0.5, 0.5, (200, 4))
    toward = [0, 0, 0, 1.7] - points
    frame = np.stack([toward, random.standard_normal((200, 4))], axis=1)
    mesh = pv.PointSet(np.zeros((200, 3)))
    mesh["position"] = points.astype(np.float32)
    mesh["frame"] = np.linalg.qr(frame.swapaxes(1, 2))[0].swapaxes(1, 2).reshape(200, 8)
    mesh["frame"] = np.asarray(mesh["frame"]).astype(np.float32)
    out = project(mesh, distance=1.7)
    np.testing.assert_array_equal(out["projected_frame"][:, 3:], 0)


def test_sheets_that_fall_on_each_other_stay_apart_in_a_cut():
    """Both halves of the 3-sphere project to one ball: places in 3-space must join nothing."""
    shape = sphere3(4)
    for height in (0.3, -0.3):
        cut = vizlight.manifold(shape, hyperplane=((0, 0, 1, 0), height))
        assert len(np.unique(np.round(np.asarray(cut["position"]), 9), axis=0)) == cut.n_points
        assert cut.n_points - 3 * cut.n_cells // 2 + cut.n_cells == 2
        w = np.asarray(cut["position"])[:, 3]
        assert w.min() < -0.8
        assert w.max() > 0.8


def test_a_cut_of_a_surface_is_a_curve_and_of_a_curve_points(torus):
    curve = project(torus, hyperplane=((1, 0, 0, 0.3), 0.2))
    assert curve.n_lines
    assert curve["frame"].shape[1] == 4
    assert "projected_frame" in curve.point_data
    _, count = np.unique(curve.lines.reshape(-1, 3)[:, 1:], return_counts=True)
    assert set(count) == {2}
    lit = project(torus, hyperplane=((1, 0, 0, 0.3), 0.2), scene=SCENE4)
    np.testing.assert_allclose(
        lit["luminance"],
        illuminate(curve, SCENE4, tangents="frame", positions="position")["luminance"],
    )
    points = project(curve, hyperplane=((0, 0, 0, 1), 0.0))
    assert points.n_verts == points.n_points > 0
    assert "frame" not in points.point_data
    with pytest.raises(ValueError, match="scene: expected a mesh that can be lit"):
        project(curve, hyperplane=((0, 0, 0, 1), 0.0), scene=SCENE4)


def test_points_behind_the_eye_are_an_error_or_left_out(torus):
    torus["number"] = np.arange(torus.n_points)
    w = np.asarray(torus["position"])[:, 3]
    with pytest.raises(ValueError, match=f"{np.sum(w >= 0.5)} of 384 points.*cut=True"):
        project(torus, distance=0.5)
    words = f"{np.sum(w >= 0.5)} points cannot be projected"
    with pytest.warns(UserWarning, match=words) as caught:
        out = project(torus, distance=0.5, cut=True)
    assert len(caught) == 1
    assert isinstance(out, pv.PolyData)
    np.testing.assert_array_equal(np.sort(out["number"]), np.flatnonzero(w < 0.5))
    assert np.all(np.isfinite(out.points))
    expected = projection.perspective(np.asarray(out["position"]), distance=0.5)
    np.testing.assert_allclose(out.points, expected)
    assert not {key for key in out.point_data if key.startswith("vtk")}
    faces = out.regular_faces
    assert np.asarray(out["position"])[faces][..., 3].max() < 0.5


def test_all_points_behind_the_eye(torus):
    torus["position"] = np.add(torus["position"], (0, 0, 0, 9.0))
    with pytest.warns(UserWarning, match="384 points cannot be projected"):
        out = project(torus, distance=0.5, cut=True)
    assert out.n_points == 0


def test_points_that_are_not_finite(torus):
    position = np.array(torus["position"])
    position[3], position[50] = np.nan, np.inf
    torus["position"] = position
    for options in ({}, {"distance": 4.0}, {"rotation": TURN}):
        with pytest.raises(ValueError, match="2 of 384 points"):
            project(torus, **options)
        with pytest.warns(UserWarning, match="2 points cannot be projected"):
            out = project(torus, cut=True, **options)
        assert out.n_points == 382
    plane = {"hyperplane": ((1, 0, 0, 0), 0.1)}
    words = "mesh: expected finite points, got 2 of 384[^;]*; drop them by cut=True"
    with pytest.raises(ValueError, match=words):
        project(torus, **plane)
    with pytest.warns(UserWarning, match="2 points cannot be projected"):
        cut = project(torus, cut=True, **plane)
    assert np.all(np.isfinite(cut["position"]))


def test_vectors_turn_and_are_pushed_forward(torus):
    torus["V"] = torus["frame"][:, :4]
    out = project(torus, rotation=TURN, distance=3.0, turned="V")
    np.testing.assert_allclose(out["V"], np.asarray(torus["V"]) @ TURN.T, atol=1e-14)
    expected = projection.push_forward(
        np.asarray(out["V"])[:, None], np.asarray(out["position"]), distance=3.0
    )
    np.testing.assert_allclose(out["projected_V"], expected[:, 0], atol=1e-14)
    # The first row of the frame is along it.
    along = unit(out["projected_V"])
    np.testing.assert_allclose(frames(out, "projected_frame", 3)[:, 0], along, atol=1e-14)


def test_a_field_on_a_surface_in_four_space(torus):
    """Codimension 2 has no sides: the surface's own brightness is the factor."""
    torus["V"] = torus["frame"][:, :4]
    torus["short"] = torus["frame"][:, :6]
    options = {"tangents": "V", "positions": "position"}
    free = illuminate(torus, SCENE4, **options)
    lit = illuminate(torus, SCENE4, conditioned="frame", **options)
    white = SCENE4.replace(material=Material(ambient=0, diffuse=1, specular=0))
    own = illuminate(torus, white, tangents="frame", positions="position")
    expected = (free["luminance"] - 0.1) * own["luminance"]
    np.testing.assert_allclose(lit["luminance"] - 0.1, expected, atol=1e-14)
    again = project(torus, scene=SCENE4, tangents="V", conditioned="frame")
    np.testing.assert_array_equal(again["luminance"], lit["luminance"])
    for more, words in (
        ({"conditioned": True}, "normals: .*conditioned by the name of the surface's tan"),
        ({"conditioned": "farme"}, "conditioned: expected the name of a point array"),
        ({"conditioned": "short"}, "conditioned: expected a point array of 4 or 8"),
        ({"conditioned": "frame", "facing": "eye"}, "facing: expected no facing beside tangents"),
    ):
        with pytest.raises(ValueError, match=words):
            illuminate(torus, SCENE4, **options, **more)


def test_provenance(torus):
    one = project(torus, rotation=("xw", 0.3), distance=4.0)
    two = project(one, hyperplane=((0, 0, 0, 1), 0.1), scene=SCENE4)
    told = vizlight.provenance(two, "projection")
    assert told["hyperplane"] == [[0, 0, 0, 1], 0.1]
    assert told["earlier"]["distance"] == 4.0
    np.testing.assert_allclose(told["earlier"]["rotation"], projection.rotation(4, ("xw", 0.3)))
    assert vizlight.provenance(two)["options"]["tangents"] == "frame"
    again = project(torus, rotation=told["earlier"]["rotation"], distance=4.0)
    np.testing.assert_array_equal(again.points, one.points)


def test_blocks_grids_and_points(torus):
    grid = pv.ImageData(dimensions=(4, 3, 1))
    grid["position"] = np.pad(grid.points, [(0, 0), (0, 1)])
    cloud = pv.PointSet(np.zeros((5, 3)))
    cloud["position"] = np.arange(20.0).reshape(5, 4)
    blocks = pv.MultiBlock({"grid": grid, "cloud": cloud, "none": None})
    blocks = pv.MultiBlock({"inner": blocks, "torus": torus})
    out = blocks.vizlight.project(rotation=("xw", np.pi / 2), frame=None)
    assert out.keys() == ["inner", "torus"]
    assert isinstance(out["inner"]["grid"], pv.StructuredGrid)
    np.testing.assert_allclose(out["inner"]["grid"].points[:, 0], 0, atol=1e-15)
    np.testing.assert_allclose(out["inner"]["cloud"].points[:, 0], -cloud["position"][:, 3])
    assert out["inner"][2] is None
    assert isinstance(grid, pv.ImageData)
    with pytest.raises(ValueError, match="block /inner/cloud: frame: expected the name of a point"):
        project(blocks)


def test_types_are_kept(torus, dtype):
    for name in ("position", "frame"):
        torus[name] = np.asarray(torus[name]).astype(dtype)
    out = project(torus, rotation=TURN, distance=3.0)
    for name in ("position", "frame", "projected_frame"):
        assert out[name].dtype == dtype
    assert out.points.dtype == dtype
    exact = np.asarray(torus["position"]).astype(float) @ TURN.T
    np.testing.assert_allclose(out["position"], exact, atol=2 * np.finfo(dtype).eps)
    torus["position"] = np.round(np.asarray(torus["position"]) * 10).astype(np.int16)
    assert project(torus)["position"].dtype == np.float64


def test_far_from_the_origin():
    """A perspective far away in float32: the eye's distance is the same size."""
    mesh = pv.PointSet(np.zeros((2, 3)))
    mesh["position"] = np.float32([[5e6, 5e6, 5e6, 1], [5e6 + 0.5, 5e6, 5e6, 2]])
    out = project(mesh, frame=None, distance=1e7)
    assert np.abs(np.diff(out.points[:, 0])) == pytest.approx(1.0, abs=0.6)


def test_normals_that_were_active_are_not_those_of_the_result():
    sphere = pv.Sphere()
    sphere["position"] = np.pad(np.asarray(sphere.points, float), [(0, 0), (0, 1)])
    out = project(sphere, rotation=("xw", 1.0), frame=None)
    assert out.point_data.active_normals_name is None
    assert sphere.point_data.active_normals_name == "Normals"
    assert "Normals" in out.point_data


def test_surfaces_in_three_space_turn_too():
    sphere = pv.Sphere()
    sphere["position"] = sphere.points
    out = project(sphere, rotation=("xz", np.pi / 2), frame=None, distance=5.0)
    np.testing.assert_allclose(out.points[:, 2], sphere.points[:, 0], atol=1e-6)


def test_empty_mesh():
    mesh = pv.PolyData()
    mesh.points = np.empty((0, 3))
    mesh.GetPointData().AddArray(pv.convert_array(np.empty((0, 4)), "position"))
    assert project(mesh, frame=None, rotation=TURN, distance=2.0).n_points == 0


def odd_torus():
    mesh = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=(24, 16)))
    mesh.cell_data["cells"] = np.ones((mesh.n_cells, 4))
    for name, size in (("odd", 5), ("full", 16), ("number", 1)):
        mesh[name] = np.ones((mesh.n_points, size))
    return mesh


test_bad_arguments = refusals(
    lambda options: project(odd_torus(), **options),
    ({"positions": None}, "positions: expected the name of a point array", TypeError),
    ({"positions": "x"}, "positions: expected the name of a point array"),
    ({"positions": "odd"}, "frame: expected a point array of 5 k components"),
    ({"positions": "number"}, "positions: expected vectors"),
    ({"frame": "x"}, "frame: expected the name of a point array"),
    ({"frame": "odd"}, "frame: expected a point array of 4 k components"),
    ({"frame": "full"}, "frame: expected a point array of 4 k components"),
    ({"frame": 3}, "frame: expected the name of a point array", TypeError),
    ({"turned": "odd"}, "turned: expected a point array of 4 k components"),
    ({"turned": ("V",)}, "turned: expected the name of a point array"),
    ({"rotation": 2 * np.eye(4)}, "rotation: expected an orthogonal matrix"),
    ({"distance": 0}, "distance: expected a number above 0"),
    ({"hyperplane": (0, 0, 0, 1)}, "hyperplane: expected", TypeError),
    ({"hyperplane": ((0, 0, 1), 0)}, "hyperplane: expected .*a normal of 3"),
    ({"hyperplane": ((0, 0, 0, 0), 0)}, "hyperplane: expected a direction"),
    ({"hyperplane": ((0, 0, 0, 1), np.nan)}, "hyperplane: expected a finite"),
    ({"light": "during"}, "light: expected 'before' or 'after'"),
    ({"scene": "sun"}, "scene: expected a vizlight.Scene, or 'direction'"),
    ({"positions": "cells"}, "the cell array 'cells'; call mesh.cell_data_to_po"),
    ({"turned": 3}, "turned: expected the name of a point array, or a list", TypeError),
    ({"scene": SCENE4, "rotate": 1}, "rotate: expected an option of project", TypeError),
    ({"rotate": 1}, "rotate: .* did you mean rotation=", TypeError),
    ({"exponent": 1}, "exponent: expected an option of project, or", TypeError),
    ({"scene": SCENE3}, "scene: expected vectors of 4 .*, got 3; .* light='after'"),
    ({"scene": SCENE4, "light": "after"}, "scene: .* 3 .*, got 4; pass light='before'"),
    ({"scene": SCENE4, "frame": None}, "frame: expected tangents to light by"),
)


def taken():
    mesh = vizlight.manifold(manifolds.torus(1.5, 0.75, resolution=4))
    del mesh.point_data["projected_frame"], mesh.field_data["projection_provenance"]
    mesh["projected_frame"] = np.zeros((mesh.n_points, 6))
    return mesh


def of_dimension_3():
    return vizlight.manifold(manifolds.torus(1.0, 1.0, 1.0, resolution=4))


AFTER = {"scene": SCENE3, "light": "after"}
test_meshes_that_do_not_fit = refusals(
    lambda make, options: project(make(), **options),
    (lambda: np.zeros((3, 4)), {}, "mesh: expected a PyVista mesh", TypeError),
    (pv.Sphere, {}, r"positions: expected places .* vizlight\.manifold makes"),
    (of_dimension_3, AFTER, "light: expected a curve or a surface, got a 3-manifold"),
    (taken, {}, "mesh: expected a mesh without an array"),
)


@pytest.mark.parametrize("light", ["before", "after"])
def test_without_a_frame_it_is_that_of_the_cells(torus, light):
    scene = SCENE4 if light == "before" else SCENE3
    expected = project(torus, scene=scene, light=light)
    del torus.point_data["frame"]
    result = project(torus, scene=scene, light=light)
    assert "frame" not in torus.point_data
    np.testing.assert_allclose(result["luminance"], expected["luminance"], atol=1e-6)
