"""Solids of planes and rings, moved and turned, and closed meshes as operands."""

import banded
import numpy as np
import pytest
import pyvista as pv
import solid_trees
from refusals import refusals
from scipy.spatial.transform import Rotation

import vizlight
from vizlight import Block, Frustum, HalfSpace, Polyhedron, Prism, Sphere, Torus
from vizlight.geometry import solids
from vizlight.geometry.contours import refinement

PI = np.pi
STAR = [
    (r * np.cos(a), r * np.sin(a))
    for a, r in zip(np.arange(10) * PI / 5, [1, 0.4] * 5, strict=True)
]
RING = 2 * PI**2 * 0.5 * 0.25**2
CLOSED_FORMS = {
    "torus": (Torus(), RING),
    "half of a torus": (Torus() - Block((0, 0.75, 0), (3, 1.5, 3)), RING / 2),
    "torus cut level": (Torus() & HalfSpace(), RING / 2),
    "cap": (Sphere() & HalfSpace((0, 0, 0.5), (0, 0, -1)), PI * 0.25 * 2.5 / 3),
    "ball without a half-space": (Sphere() - HalfSpace((0, 0, 0), (1, 2, 3)), 2 * PI / 3),
    "wedge": (Block() & HalfSpace((0, 0, 0), (1, 1, 0)), 0.5),
    "star": (Prism(STAR, 0.5), 0.5 * 10 * 0.5 * 0.4 * np.sin(PI / 5)),
    "bored star": (
        Prism(STAR, 0.5) - Frustum(axis=(0, 0, 2), radii=(0.2, 0.2)),
        0.5 * (10 * 0.5 * 0.4 * np.sin(PI / 5) - PI * 0.04),
    ),
}


@pytest.mark.sampled(3)
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_volume_against_closed_forms(name):
    solid, volume = CLOSED_FORMS[name]
    mesh = solids.tessellate(solid)
    scale = mesh.scale**3
    assert abs(mesh.volume * scale - volume) <= mesh.volume_error * scale
    assert mesh.volume * scale == pytest.approx(volume, rel=1.6e-2)
    bands = refinement.draw(mesh, solid_trees.lambert, 6, low=0.1)
    assert banded.is_closed(bands)
    assert bands.error <= 1.1 * bands.steps.error


def test_the_torus_has_exact_normals(random):
    surface = Torus((1, 2, 3), (1, 1, 0), 0.7, 0.2).surfaces()
    points = random.uniform(0, 4, (50, 3))
    slope = [
        (surface.distance(points + h, 0) - surface.distance(points - h, 0)) / 2e-6
        for h in 1e-6 * np.eye(3)
    ]
    np.testing.assert_allclose(surface.normal(points, 0), np.transpose(slope), atol=1e-8)


def test_a_mesh_contains_what_vtk_says(random):
    mesh = pv.Icosphere(nsub=3)
    mesh.points *= 1 + 0.6 * np.sin(5 * mesh.points[:, :1]) * np.cos(4 * mesh.points[:, 1:2])
    solid = Polyhedron(mesh)
    points = random.uniform(-1, 1, (2000, 3)) * np.abs(mesh.points).max(axis=0)
    enclosed = pv.PolyData(points).select_interior_points(mesh)
    expected = np.asarray(enclosed["selected_points"], bool)
    assert expected.any()
    np.testing.assert_array_equal(solid.contains(points), expected)
    # Rays through corners and edges, too.
    cube = Polyhedron(pv.Cube())
    grid = np.stack(np.meshgrid(*[np.linspace(-0.75, 0.75, 7)] * 3), axis=-1).reshape(-1, 3)
    reach = np.abs(grid).max(axis=1)
    off = np.abs(reach - 0.5) > 1e-9
    np.testing.assert_array_equal(cube.contains(grid[off]), reach[off] < 0.5)


def test_a_mesh_is_an_operand():
    ball = pv.Sphere(theta_resolution=24, phi_resolution=24)
    solid = Polyhedron(ball) - Frustum(axis=(0, 0, 3), radii=(0.2, 0.2))
    found, mesh = solid_trees.problems(solid)
    assert not found
    assert mesh.volume * mesh.scale**3 < ball.volume
    whole = solids.tessellate(Polyhedron(ball) | Block((2, 0, 0)))
    assert whole.volume * whole.scale**3 == pytest.approx(ball.volume + 1, rel=1e-6)
    inside_out = Polyhedron(ball.flip_faces())
    assert inside_out.volume == pytest.approx(ball.volume, rel=1e-6)


TURN = Rotation.from_rotvec(np.radians(25) * np.array([1, 2, 3]) / np.sqrt(14))
MOVES = {
    "translate": (lambda s: s.translate((1, -2, 3)), lambda p: np.add(p, [1, -2, 3])),
    "scale": (lambda s: s.scale(2.5, point=(1, 0, 0)), lambda p: 2.5 * (p - [1, 0, 0]) + [1, 0, 0]),
    "rotate_x": (lambda s: s.rotate_x(40), Rotation.from_euler("x", 40, degrees=True).apply),
    "rotate_y": (lambda s: s.rotate_y(40), Rotation.from_euler("y", 40, degrees=True).apply),
    "rotate_z": (lambda s: s.rotate_z(40), Rotation.from_euler("z", 40, degrees=True).apply),
    "rotate_vector": (
        lambda s: s.rotate_vector((1, 2, 3), 25, point=(0, 1, 0)),
        lambda p: np.add(TURN.apply(p - [0, 1, 0]), [0, 1, 0]),
    ),
}


@pytest.mark.parametrize("name", MOVES)
def test_what_is_moved_contains_the_moved_points(name, random):
    move, apply = MOVES[name]
    points = random.uniform(-1.2, 1.2, (3000, 3))
    parts = [
        Sphere((0.2, 0, 0), 0.7), Frustum((0, 0.1, 0), (1, 2, 1), (0.3, 0.6)), Torus(),
        Block((0, 0, 0.2), (1, 0.5, 1.2)), HalfSpace((0, 0, 0.1), (1, 1, 1)), Prism(STAR),
    ]  # fmt: skip
    for solid in (*parts, (parts[0] | parts[3]) - parts[1]):
        np.testing.assert_array_equal(move(solid).contains(apply(points)), solid.contains(points))


def test_meshes_for_pyvista(tmp_path):
    solid = Sphere() - Frustum(axis=(0, 0, 3), radii=(0.5, 0.5))
    mesh = vizlight.to_polydata(solid)
    volume = PI * 3**1.5 / 6
    assert mesh.n_open_edges == 0
    assert mesh.is_manifold
    assert abs(mesh.volume - volume) <= mesh.field_data["volume_error"][0]
    assert set(np.unique(mesh["patch"])) == {0, 1}
    mesh.save(tmp_path / "part.stl")
    assert pv.read(tmp_path / "part.stl").clean().volume == pytest.approx(mesh.volume, rel=1e-5)
    assert not vizlight.to_polydata(Block() - Block()).n_points
    with pytest.raises(TypeError, match="solid: expected a vizlight"):
        vizlight.to_polydata(mesh)


test_bad_input = refusals(
    lambda call: call(),
    (lambda: Torus(tube_radius=0.5), "tube_radius: expected a radius below"),
    (lambda: Prism([(0, 0), (1, 0)]), "outline: expected 3 corners"),
    (lambda: Prism([(0, 0), (1, 1), (1, 0), (0, 1)]), "outline: expected a simple"),
    (lambda: Polyhedron(pv.Plane()), "triangles: expected a closed surface"),
    (lambda: Polyhedron(pv.ImageData()), r"points: .*extract_surface\(\)", TypeError),
    (lambda: Polyhedron(np.eye(3), [[0, 1, 3]]), "triangles: expected indices"),
    (lambda: Sphere() | pv.Sphere(), r"second: .*vizlight.Polyhedron\(mesh\)", TypeError),
    (lambda: Sphere().scale(0), "factor: expected a number above 0"),
    (lambda: solids.tessellate(HalfSpace()), "expected a bounded solid"),
    (lambda: solids.tessellate(Sphere() | HalfSpace()), "a bounded combination"),
)
