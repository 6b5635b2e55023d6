"""Small datasets that are lit as one have the light that they have one by one."""

import itertools

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View
from vizlight.filters import lighting
from vizlight.mesh import blocks
from vizlight.vtk.batches import MOST, batches

RNG = np.random.default_rng(0)
LAMPS = [Light(direction=(1, 1, 1)), Light(position=(2, 1, 9), color=(1, 0.5, 0.2))]
SCENES = [None, Scene(lights=LAMPS, view=View(position=(3, 2, 9)))]


def bare(mesh):
    mesh.clear_data()
    return mesh


def ball(x, **options):
    return pv.Sphere(center=(x, 0, 0), theta_resolution=9, phi_resolution=9, **options)


def balls(**options):
    return [bare(ball(x, **options)) for x in range(4)]


def box(x):
    return bare(pv.Cube(center=(x, 0, 0)).clean().triangulate().subdivide(2))


def sheet(angle):
    """Return a height field, seen from above or below by its angle."""
    mesh = bare(pv.Plane(i_resolution=9, j_resolution=9))
    mesh.points[:, 2] += 0.2 * np.sin(6 * mesh.points[:, 0])
    return mesh.rotate_x(angle)


def flipped(mesh):
    mesh.point_data.active_normals[:] *= -1
    return mesh


def grid(x):
    return pv.ImageData(dimensions=(4, 4, 4), origin=(x, 0, 0)).cast_to_unstructured_grid()


def with_arrays(mesh):
    for name, width in (("t", 3), ("places", 4), ("frame", 8)):
        mesh[name] = RNG.normal(size=(mesh.n_points, width))
    mesh["n"] = mesh.points - np.float32(mesh.center)
    mesh["open"] = RNG.random(mesh.n_points)
    return mesh


def mobius():
    return bare(pv.ParametricMobius(u_res=10, v_res=4, w_res=4).clean())


def boy():
    return bare(pv.ParametricBoy(u_res=10, v_res=10, w_res=10).clean())


def with_twin(mesh):
    """Return a surface that has some of its faces again."""
    mesh.faces = np.concatenate([mesh.faces, mesh.faces[:40]])
    return mesh


#: Blocks, and how many of them are lit as one.
KINDS = {
    "balls": (balls(), 4),
    # Boxes that touch stay closed pieces of their own.
    "boxes that touch": ([box(x) for x in range(4)], 4),
    "open and closed": ([*balls(), *balls(end_phi=90)], 8),
    "height fields": ([sheet(angle) for angle in (0, 100, 180, 290)], 4),
    "normals": ([ball(x) for x in range(3)] + [flipped(ball(3))], 4),
    "open with normals": ([ball(x, end_phi=90) for x in range(3)] + [ball(5)], 4),
    "a normal of no length": ([ball(0), ball(1)], 2),
    "creases": ([box(0), *balls()], 5),
    "lines": ([pv.Spline(RNG.normal(size=(6, 3)), 20 + i) for i in range(4)], 4),
    "segments": ([pv.Line((0, 0, i), (1, 2, i), resolution=7) for i in range(3)], 3),
    "hexahedra": ([grid(x) for x in range(3)], 3),
    "no sides": ([mobius(), boy(), *balls()], 6),
    "twins": ([with_twin(balls()[0]), *balls()], 5),
    "many points": ([bare(pv.Sphere(end_phi=end)) for end in (180, 120)], 2),
    "several kinds": ([*balls(), pv.PolyData(), grid(0), pv.Line(), grid(3)], 6),
    "one with a hole": (balls(), 0),
    "too small": ([*balls(), bare(pv.Sphere(radius=1e-31))], 0),
}
KINDS["a normal of no length"][0][1].point_data.active_normals[3] = 0
KINDS["a normal of no length"] = KINDS["a normal of no length"][0], 0
KINDS["one with a hole"][0][1].points[3] = np.nan


def light_both_ways(mesh, scene, monkeypatch, **options):
    """Return the number of blocks that are lit as one, and the light as one and one by one."""
    joint = []

    def noted(*given):
        joint.extend(batches(*given))
        return joint

    with monkeypatch.context() as patch:
        patch.setattr(lighting, "batches", noted)
        as_one = vizlight.illuminate(mesh, scene, **options)
        patch.setattr(lighting, "batches", lambda *_: [])
        apart = vizlight.illuminate(mesh, scene, **options)
    return sum(len(batch.numbers) for batch in joint), as_one, apart


def assert_equal(as_one, apart):
    for one, other in zip(*map(blocks.all_blocks, (as_one, apart)), strict=True):
        assert one.point_data.keys() == other.point_data.keys()
        assert one.active_scalars_name == other.active_scalars_name
        for name in one.point_data:
            kind = one[name].dtype
            assert kind == other[name].dtype
            # Compiled code, which many points pay for, rounds otherwise than NumPy.
            limit = 8 * np.finfo(kind).eps if kind.kind == "f" else 0
            np.testing.assert_allclose(one[name], other[name], rtol=0, atol=limit)


@pytest.mark.filterwarnings("ignore::UserWarning")
@pytest.mark.parametrize("kind", KINDS)
def test_blocks_of_one_kind_have_the_light_of_each(kind, monkeypatch):
    meshes, expected = KINDS[kind]
    sides = (
        ["auto"] if kind in ("lines", "segments", "several kinds") else ["auto", "eye", "outward"]
    )
    for scene, facing in itertools.product(SCENES, sides):
        count, *lit = light_both_ways(
            pv.MultiBlock(meshes), scene, monkeypatch, facing=facing, components=True
        )
        assert count == expected
        assert_equal(*lit)


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"tangents": "t"}, 4),
        ({"tangents": "t", "conditioned": True}, 4),
        ({"tangents": "frame", "positions": "places", "conditioned": "frame"}, 4),
        ({"normals": "n"}, 4),
        ({"occlusion": "open"}, 4),
        ({"normals": ball(0).points}, 0),
        ({"feature_angle": 30}, 0),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, dict) else str(value),
)
def test_arrays_are_those_of_each_block(options, expected, monkeypatch):
    mesh = pv.MultiBlock([with_arrays(mesh) for mesh in balls()])
    scene = None if "positions" in options else SCENES[1]
    count, *lit = light_both_ways(mesh, scene, monkeypatch, **options)
    assert count == expected
    assert_equal(*lit)


def test_an_error_and_a_warning_are_those_of_a_block(monkeypatch):
    first, second, *rest = (with_arrays(mesh) for mesh in balls())
    second["n"] = np.zeros((second.n_points, 4))
    inner = pv.MultiBlock({"bad": second, "none": None})
    mesh = pv.MultiBlock({"good": first, "inner": inner, "more": rest[0], "last": rest[1]})
    with pytest.raises(ValueError, match="block /inner/bad: normals: expected 3 components"):
        light_both_ways(mesh, None, monkeypatch, normals="n")
    # The share of sharp edges is that of a block, not of all.
    boxes = pv.MultiBlock([*balls(), box(9)])
    with pytest.warns(UserWarning, match="17% of the edges are sharper") as given:
        light_both_ways(boxes, None, monkeypatch)
    assert len({str(warning.message) for warning in given}) == 1


def test_nested_blocks_keep_their_places_and_memory(monkeypatch):
    first, second, third, fourth = balls()
    mesh = pv.MultiBlock({"a": first, "none": None, "in": pv.MultiBlock([second, third])})
    count, as_one, apart = light_both_ways(mesh, SCENES[1], monkeypatch)
    assert count == 3
    assert as_one["none"] is None
    assert as_one["in"].n_blocks == 2
    assert_equal(as_one, apart)
    assert not np.shares_memory(as_one["a"].points, first.points)
    assert "luminance" not in first.point_data
    vizlight.illuminate(mesh, SCENES[1], inplace=True)
    assert "luminance" in third.point_data
    # Light is that of the points, not of the block that a record may be asked for.
    assert vizlight.provenance(as_one)["points"] == first.n_points
    fourth["luminance"] = np.zeros(fourth.n_points)
    with pytest.raises(ValueError, match="no array of its own"):
        vizlight.illuminate(pv.MultiBlock([first, fourth]))


def test_a_batch_has_no_more_points_than_are_searched_for_sides():
    mesh = pv.Sphere(theta_resolution=50, phi_resolution=50)
    found = list(batches(dict.fromkeys(range(39), mesh), []))
    assert [number for batch in found for number in batch.numbers] == list(range(39))
    assert all(batch.mesh.GetNumberOfPoints() <= MOST for batch in found)


def test_truth_values_stay_so_in_a_copy():
    mesh = ball(0)
    mesh["on"] = mesh.points[:, 0] > 0
    mesh["pair"] = mesh.points[:, 0] + 1j * mesh.points[:, 1]
    lit = vizlight.illuminate(pv.MultiBlock([mesh, ball(1)]))
    assert lit[0]["on"].dtype == bool
    assert lit[0]["pair"].dtype.kind == "c"
    assert lit[1].active_scalars_name == "luminance"
