"""Shapes in n-space: no seams, laws of each shape."""

import itertools
from fractions import Fraction

import numpy as np
import oracles
import pytest
from lattices import EDGES, euler, faces_around
from refusals import refusals
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from vectors import projector

from studies import _shapes as shapes
from vizlight.geometry.nspace import lattice

EVERY = {
    "circle": lambda: shapes.torus(2.0),
    "torus": lambda: shapes.torus(1.5, 0.75, resolution=(24, 16)),
    "3-torus": lambda: shapes.torus(1.0, 2.0, 3.0, resolution=6),
    "Clifford torus": lambda: shapes.clifford_torus(radius=2.0, resolution=16),
    "curve on the torus": lambda: shapes.torus_curve(7, r1=1.5, r2=0.75, resolution=200),
    "open curve": lambda: shapes.torus_curve(2**0.5, turns=3, resolution=200),
    "Hopf fibres": lambda: shapes.hopf_fibres(fibres=9, resolution=12),
    "Klein bottle": lambda: shapes.klein_bottle(resolution=(15, 12)),
    "Veronese surface": lambda: shapes.veronese(resolution=6),
    "complex curve": lambda: shapes.complex_curve(np.exp, resolution=9),
    "3-sphere": lambda: shapes.sphere3(radius=3.0, resolution=3),
}


@pytest.mark.parametrize(
    ("function", "derivative"),
    [
        (lambda z: z**5, lambda z: 5 * z**4),
        (lambda z: z**7, lambda z: 7 * z**6),
        (lambda z: 1 / (z - 1.2), lambda z: -1 / (z - 1.2) ** 2),
        (lambda z: np.exp(8 * z), lambda z: 8 * np.exp(8 * z)),
        (lambda z: 1e100 * z**3 + z, lambda z: 3e100 * z**2 + 1),
        (lambda z: 3.0, lambda z: 0),
        (np.tanh, lambda z: 1 / np.cosh(z) ** 2),
    ],
    ids=["z^5", "z^7", "pole", "exp", "large", "constant", "tanh"],
)
def test_slopes_of_complex_curves_by_differences(function, derivative):
    """Within 1e-12 of the largest of f and f', as is said."""
    found = shapes.complex_curve(function, resolution=10)
    exact = shapes.complex_curve(function, derivative=derivative, resolution=10)
    slope = [(s.frame[:, 0, 2] + 1j * s.frame[:, 0, 3]) / s.frame[:, 0, 0] for s in (found, exact)]
    extent = max(np.abs(slope[1]).max(), np.abs(exact.points[:, 2:]).max())
    assert np.abs(slope[0] - slope[1]).max() <= 1e-12 * extent


def test_slopes_of_a_function_in_single_precision():
    found = shapes.complex_curve(lambda z: z.astype(np.complex64) ** 3, resolution=10)
    exact = shapes.complex_curve(lambda z: z**3, derivative=lambda z: 3 * z**2, resolution=10)
    assert np.abs(projector(found.frame) - projector(exact.frame)).max() < 2e-6


@pytest.mark.parametrize("resolution", [9, 16, 64, (30, 45)])
def test_functions_that_are_not_analytic_are_refused(resolution):
    """Depending on the conjugate however little, or with a cut that no sample lies on."""
    for function in (
        lambda z: z**2 + 0.0099 * np.conj(z),
        lambda z: z**2 + 1e-9 * np.conj(z),
        lambda z: np.exp(8 * z) + np.abs(z),
        np.sqrt,
        lambda z: np.log(z + 0.001),
        lambda z: (z - 0.3j) ** 0.4,
    ):
        with pytest.raises(ValueError, match="function: expected an analytic one"):
            shapes.complex_curve(function, resolution=resolution)
    with pytest.raises(ValueError, match="got one that jumps at z = .*without its branch cut"):
        shapes.complex_curve(np.sqrt, derivative=lambda z: 0.5 / np.sqrt(z), resolution=64)


def test_functions_that_are_steep_but_analytic_are_taken():
    """Steps that the slopes at both ends do not foresee need not be jumps."""
    for function in (
        lambda z: np.exp(40 * z),
        lambda z: 1 / z,
        lambda z: 1 / (z - 1.03),
        lambda z: np.sin(20 * z),
        lambda z: 1e17 + z,
    ):
        shapes.complex_curve(function, resolution=16)
    half = ((0.01, 1), (-1, 1))
    assert shapes.complex_curve(np.sqrt, domain=half, resolution=9).k == 2


@pytest.mark.parametrize("name", EVERY)
def test_frames_are_orthonormal_and_points_stand_apart(name):
    shape = EVERY[name]()
    gram = np.einsum("bki,bli->bkl", shape.frame, shape.frame)
    assert np.abs(gram - np.eye(shape.k)).max() < 8 * oracles.eps(float)
    assert shape.points.dtype == shape.frame.dtype == np.float64
    assert shape.cells.shape[1] == 2**shape.k
    np.testing.assert_array_equal(np.unique(shape.cells), np.arange(len(shape.points)))
    # Nothing stands twice at a place: a seam would.
    assert len(np.unique(np.round(shape.points, 9), axis=0)) == len(shape.points)


@pytest.mark.parametrize("name", sorted(set(EVERY) - {"open curve", "complex curve"}))
def test_closed_shapes_have_no_boundary(name):
    assert set(faces_around(EVERY[name]().cells)) == {2}


@pytest.mark.parametrize("name", EVERY)
def test_cells_are_small(name):
    """No cell reaches across the shape, as one over a wrong seam would."""
    shape = EVERY[name]()
    ends = shape.points[shape.cells]
    step = np.linalg.norm(ends - np.roll(ends, 1, axis=1), axis=2)
    assert step.max() < 2.5 * np.sqrt((step**2).mean()) + 1e-12


@pytest.mark.parametrize("name", EVERY)
def test_cells_are_along_the_frame(name):
    """The step to a neighbour lies in the tangent space, to first order."""
    shape = EVERY[name]()
    a, b = shape.cells[:, 0], shape.cells[:, 1]
    step = shape.points[b] - shape.points[a]
    unit = step / np.linalg.norm(step, axis=1, keepdims=True)
    along = np.linalg.norm(np.einsum("bki,bi->bk", shape.frame[a], unit), axis=1)
    assert along.min() > 0.8


def test_clifford_torus_lies_in_the_sphere():
    points = shapes.clifford_torus(radius=2.0).points
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 2, rtol=1e-15)


def test_veronese_surface_is_the_projective_plane():
    """V - E + F = 1, and the metric is that of a map that takes opposite points to one."""
    assert euler(shapes.veronese(resolution=5).cells) == 1


def test_klein_bottle_is_closed_and_has_no_orientation():
    cells = shapes.klein_bottle(resolution=(6, 5)).cells
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == 0
    assert not orientable(cells)
    assert orientable(lattice.cells((6, 5), (True, True)))


def orientable(cells):
    """Return whether the two sides of all faces are apart where neighbours' sides are joined."""
    ends = cells[:, EDGES[4]]
    way = (ends[..., 0] < ends[..., 1]).ravel()
    _, edge = np.unique(np.sort(ends.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    one, other = np.argsort(edge.ravel()).reshape(-1, 2).T
    a, b, turned = one // 4, other // 4, way[one] == way[other]
    count = len(cells)
    rows = np.concatenate([a, a + count]), np.concatenate([b + count * turned, b + count * ~turned])
    links = coo_array((np.ones(len(rows[0])), rows), shape=(2 * count, 2 * count))
    return connected_components(links, directed=False)[0] == 2


@pytest.mark.parametrize(("dimension", "size"), [(3, 1), (3, 4), (4, 1), (4, 3)])
def test_skin_of_a_cube(dimension, size):
    points, cells = shapes.cube_skin(dimension, size)
    assert np.all(np.abs(points).max(axis=1) == size)
    assert len(cells) == 2 * dimension * size ** (dimension - 1)
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == (2 if dimension == 3 else 0)


@pytest.mark.parametrize("size", [2, 3, 6])
def test_opposite_points_of_a_skin_are_one(size):
    points, cells = shapes.cube_skin(3, size, opposite=True)
    assert len(cells) == 3 * size**2
    assert set(faces_around(cells)) == {2}
    assert euler(cells) == 1
    assert not orientable(cells)
    both = {tuple(p) for p in points} & {tuple(-p) for p in points}
    assert not both


def test_cells_are_boxes_of_neighbours():
    """Corners in VTK's order: along an edge of a cell one coordinate steps."""
    points, cells = shapes.cube_skin(4, 3)
    for a, b in EDGES[8]:
        step = np.abs(points[cells[:, a]] - points[cells[:, b]])
        assert np.all(np.sort(step, axis=1) == [0, 0, 0, 2])
    for a, b in itertools.combinations(range(8), 2):
        assert np.all(cells[:, a] != cells[:, b])


def test_winding_numbers():
    assert len(shapes.torus_curve(3, resolution=50).cells) == 50
    single = (np.float32(0.5), 2), (np.array(0.25), 4)
    ratios = (Fraction(2, 7), 7), (0.2, 5), (5 / 49, 49), (1 / 3, 3), (0, 1), *single
    for ratio, turns in ratios:
        shape = shapes.torus_curve(ratio, resolution=1000)
        assert len(shape.cells) == len(shape.points) == 1000
        t = np.unwrap(np.arctan2(shape.points[:, 1], shape.points[:, 0]))
        assert t[-1] == pytest.approx(2 * np.pi * turns * 0.999, rel=1e-9)
    open_curve = shapes.torus_curve(0.3, turns=2, resolution=100)
    assert len(open_curve.cells) == 99


test_bad_shapes = refusals(
    lambda call: call(),
    (shapes.torus, "radii: expected 1 to 3 radii, got 0"),
    (lambda: shapes.torus(1, 0), r"radii\[1\]: expected a number above 0"),
    (lambda: shapes.torus(1, 1, resolution=(9, 2)), "resolution"),
    (lambda: shapes.torus_curve(np.pi), "ratio: .* pass turns="),
    (lambda: shapes.torus_curve(np.inf), "ratio: expected a finite number"),
    (
        lambda: shapes.complex_curve(lambda z: z[:3]),
        "function: expected one that returns numbers in the shape",
    ),
    (
        lambda: shapes.complex_curve(np.exp, derivative=lambda z: None),
        "derivative: expected one that returns numbers",
        TypeError,
    ),
    (
        lambda: shapes.complex_curve(lambda z: np.where(z.real > 1, np.nan, z)),
        "function: expected finite values on its domain .* outside it.*pass derivative=",
    ),
    (lambda: shapes.klein_bottle(minor=3.0), "minor: expected less than major"),
    (lambda: shapes.hopf_fibres([[0, 0, 0.0]]), "base: expected points of"),
    (lambda: shapes.hopf_fibres([[0, 1.0]]), "base: expected vectors"),
    (lambda: shapes.sphere3(radius=1e200), "radius: expected a number from"),
    (lambda: shapes.complex_curve(np.conj), "function: expected an analytic"),
    (lambda: shapes.complex_curve(lambda z: 1 / z, resolution=5), "finite"),
    (lambda: shapes.complex_curve(np.sqrt, resolution=9), "function: expected an analytic"),
    (lambda: shapes.complex_curve(lambda z: "w"), "function: expected one that", TypeError),
    (lambda: shapes.complex_curve(np.exp, domain=[0, 1]), "domain: expected two"),
)


@pytest.mark.parametrize("scale", [1e-150, 1e149])
def test_any_scale(scale):
    for shape in (
        shapes.torus(scale, scale / 2, resolution=8),
        shapes.klein_bottle(major=scale, minor=scale / 2, resolution=8),
        shapes.sphere3(radius=scale, resolution=2),
        shapes.torus_curve(3, r1=scale, r2=scale, resolution=20),
        shapes.veronese(radius=scale**0.5, resolution=3),
    ):
        assert np.all(np.isfinite(shape.points))
        gram = np.einsum("bki,bli->bkl", shape.frame, shape.frame)
        assert np.abs(gram - np.eye(shape.k)).max() < 1e-14
