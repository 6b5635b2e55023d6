"""Curves on triangles and tetrahedra: places stay in cells, order of the error, line fields."""

import dataclasses

import numpy as np
import pytest
import pyvista as pv

from vizlight.geometry.lines.simplices import CellPlaces, Simplices
from vizlight.geometry.lines.tracing import Flow, Tracing, trace

RANDOM = np.random.default_rng(7)
HOW = Tracing(step=0.3, max_length=100.0, max_steps=10_000, seed=0)


def square(n=9):
    mesh = pv.Plane(i_resolution=n, j_resolution=n).triangulate()
    return Simplices(mesh.points, mesh.regular_faces)


def cube(n=5):
    mesh = pv.ImageData(dimensions=(n, n, n), spacing=(1 / (n - 1),) * 3).triangulate()
    return Simplices(mesh.points, mesh.cells_dict[pv.CellType.TETRA])


def box():
    """The surface of a cube of side 1, of triangles that share no vertex."""
    mesh = pv.Cube().triangulate()
    corners = np.asarray(mesh.points)[mesh.regular_faces]
    return Simplices(corners.reshape(-1, 3), np.arange(36).reshape(-1, 3))


@pytest.mark.parametrize(("make", "measure"), [(square, 1.0), (cube, 1.0), (box, 6.0)])
def test_random_places_are_uniform_and_walks_are_straight(make, measure):
    mesh = make()
    assert mesh.extent == pytest.approx(measure, rel=1e-6)
    places = mesh.random(4000, np.random.default_rng(0))
    np.testing.assert_allclose(places.weights.sum(axis=1), 1)
    if mesh.k == 3:
        np.testing.assert_allclose(mesh.positions(places).mean(axis=0), 0.5, atol=0.02)
    steps = RANDOM.normal(size=(4000, 3)) * 0.2
    if make is square:
        steps[:, 2] = 0
    ends, inside = mesh.walk(places, steps)
    assert np.all(ends.weights >= 0)
    np.testing.assert_allclose(ends.weights.sum(axis=1), 1)
    if make is not box:
        moved = mesh.positions(ends) - mesh.positions(places)
        np.testing.assert_allclose(moved[inside], steps[inside], atol=1e-7)
        low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
        there = mesh.positions(places) + steps
        np.testing.assert_array_equal(inside, np.all((there >= low) & (there <= high), axis=1))
    else:
        assert inside.all()


def test_a_walk_around_a_box_comes_back():
    """Unfolded, four faces are a strip of length 4, whose ends meet."""
    mesh = box()
    middle = mesh.positions(CellPlaces(np.arange(12), np.full((12, 3), 1 / 3)))
    cell = int(np.argmax(middle[:, 0]))
    start = CellPlaces(np.array([cell]), np.array([[0.2, 0.3, 0.5]]))
    end, inside = mesh.walk(start, np.array([[0.0, 4.0, 0.0]]))
    assert inside.all()
    np.testing.assert_allclose(mesh.positions(end), mesh.positions(start), atol=1e-12)


def test_a_border_is_where_no_cell_is_beyond():
    border = square(3).border
    assert len(border) == 12
    np.testing.assert_array_equal(np.abs(border).max(axis=2), 0.5)
    assert np.linalg.norm(np.diff(border, axis=1), axis=2).sum() == pytest.approx(4)
    assert len(box().border) == 0


def test_cells_without_extent_and_sides_of_three_cells_end_a_walk():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [2, 0, 0]], float)
    fan = Simplices(points, np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4], [0, 1, 5]]))
    assert np.all(fan.neighbours[:3, 2] == -1)
    assert np.all(fan.neighbours[3] == -1)
    start = CellPlaces(np.array([0]), np.full((1, 3), 1 / 3))
    end, inside = fan.walk(start, np.array([[0.0, -5.0, 0.0]]))
    assert not inside.any()
    np.testing.assert_allclose(fan.positions(end)[0], [1 / 3, 0, 0], atol=1e-12)


def orbit_error(make, step):
    """Return how far the circles of a rotation are from closing, for a step."""
    mesh = make()
    middle = mesh.points.mean(axis=0)
    flow = Flow(mesh, np.cross([0, 0, 1.0], mesh.points - middle))
    cell = np.arange(len(mesh.cells))
    radius = np.linalg.norm((mesh.points[mesh.cells].mean(axis=1) - middle)[:, :2], axis=1)
    cell = cell[np.abs(radius - 0.3) < 0.1][:20]
    seeds = CellPlaces(cell, np.full((len(cell), mesh.k + 1), 1 / (mesh.k + 1)))
    curves = trace(flow, seeds, dataclasses.replace(HOW, step=step, max_length=1.0))
    away = (mesh.positions(curves.places) - middle)[:, :2]
    radius = np.linalg.norm(away, axis=1)
    return max(
        np.ptp(radius[a:b]) for a, b in zip(curves.offsets, curves.offsets[1:], strict=False)
    )


@pytest.mark.parametrize("make", [square, cube])
def test_circles_close_with_order_two_or_better(make):
    """The field is linear, so that interpolation adds no error."""
    errors = [orbit_error(make, step) for step in (0.8, 0.4, 0.2)]
    order = -np.polyfit(np.log([1, 2, 4]), np.log(errors), 1)[0]
    assert order > 1.8
    assert errors[-1] < 3e-3


@pytest.mark.parametrize("make", [square, cube])
def test_a_line_field_has_no_sign(make):
    mesh = make()
    vectors = np.stack([1 + 0 * mesh.points[:, 0], mesh.points[:, 0], 0 * mesh.points[:, 0]], 1)
    signs = RANDOM.choice([-1.0, 1.0], size=(len(vectors), 1))
    seeds = mesh.random(12, np.random.default_rng(3))
    found = [
        trace(Flow(mesh, v, line_field=field), seeds, HOW)
        for v, field in ((vectors, False), (vectors, True), (signs * vectors, True))
    ]
    for other in found[1:]:
        for a, b, c, d in zip(
            found[0].offsets, found[0].offsets[1:], other.offsets, other.offsets[1:], strict=False
        ):
            one = mesh.positions(found[0].places)[a:b]
            two = mesh.positions(other.places)[c:d]
            if np.linalg.norm(one[0] - two[0]) > np.linalg.norm(one[0] - two[-1]):
                two = two[::-1]
            np.testing.assert_allclose(one, two, atol=1e-9)
        assert found[0].places.cell.shape == other.places.cell.shape


def test_curves_end_where_the_field_rests_or_turns_back():
    mesh = square(20)
    x = mesh.points[:, 0]
    rests = np.stack([np.where(x < 0, 1.0, 0.0), 0 * x, 0 * x], axis=1)
    seeds = mesh.random(30, np.random.default_rng(1))
    seeds = seeds[mesh.positions(seeds)[:, 0] < -0.1]
    curves = trace(Flow(mesh, rests), seeds, HOW)
    assert mesh.positions(curves.places)[:, 0].max() < 0.051
    meets = np.stack([-np.sign(x), 0 * x, 0 * x], axis=1)
    curves = trace(Flow(mesh, meets), seeds, HOW)
    assert np.abs(mesh.positions(curves.places)[curves.offsets[1:] - 1, 0]).max() < 0.06
    nothing = trace(Flow(mesh, 0 * rests), seeds, HOW)
    assert len(nothing.offsets) == 1
