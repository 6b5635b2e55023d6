"""Tangents of any function: the complex step, central differences, closed directions."""

import numpy as np
import pytest
from lattices import faces_around
from refusals import refusals
from vectors import projector, unit

from vizlight.geometry.nspace import manifolds
from vizlight.geometry.nspace.manifolds import EPS, central_step, parametric

TURN = (0, 2 * np.pi)


def torus(t, f):
    return 1.5 * np.cos(t), 1.5 * np.sin(t), 0.75 * np.cos(f), 0.75 * np.sin(f)


def error(shape, exact):
    return np.abs(projector(shape.frame) - projector(exact.frame)).max()


def test_each_way_to_the_tangents():
    exact = manifolds.torus(1.5, 0.75, resolution=(20, 12))
    for tangents, bound in (("complex", 1e-15), ("central", 2e-10)):
        shape = parametric(torus, [TURN, TURN], 4, resolution=(20, 12), tangents=tangents)
        np.testing.assert_allclose(shape.points, exact.points, atol=1e-14)
        np.testing.assert_array_equal(shape.cells, exact.cells)
        assert error(shape, exact) < bound
    given = parametric(
        torus,
        [TURN, TURN],
        4,
        resolution=(20, 12),
        tangents=lambda t, f: (
            (-1.5 * np.sin(t), 1.5 * np.cos(t), 0, 0),
            (0, 0, -0.75 * np.sin(f), 0.75 * np.cos(f)),
        ),
    )
    assert error(given, exact) < 1e-15


def test_central_differences_are_of_order_2_and_within_the_bound():
    steps, errors = np.array([1e-1, 3e-2, 1e-2, 3e-3, 1e-3]), []

    def wavy(t):
        return np.cos(t), np.sin(t), np.sin(3 * t) / 3

    def slope(t):
        return ((-np.sin(t), np.cos(t), np.cos(3 * t)),)

    true = parametric(wavy, [TURN], 3, resolution=50, tangents=slope)
    for h in steps:
        found = parametric(wavy, [TURN], 3, resolution=50, step=h / (2 * np.pi))
        errors.append(error(found, true))
        # At the ends of the domain the parabola's bound; between them half of it.
        assert errors[-1] < 9 * h**2 / 3 + 4e-13 / h
    assert abs(np.polyfit(np.log(steps), np.log(errors), 1)[0] - 2) < 0.2
    assert error(parametric(wavy, [TURN], 3, resolution=50), true) < 1e-9
    assert central_step(EPS) * 2 * np.pi == pytest.approx(np.finfo(float).eps ** (1 / 3), rel=0.3)


def test_closed_directions_are_found():
    def shapes(u, v):
        return np.cos(u) * (2 + np.cos(v)), np.sin(u) * (2 + np.cos(v)), np.sin(v)

    assert len(parametric(shapes, [TURN, TURN], 3, resolution=9).cells) == 81
    assert len(parametric(shapes, [TURN, (0, 3)], 3, resolution=9).cells) == 72
    assert len(parametric(shapes, [(0, 3), (0, 3)], 3, resolution=9).cells) == 64

    # A drop comes back to its tip with another tangent: its ends stay two points.
    def drop(t):
        return np.sin(2 * t), np.sin(t)

    assert len(parametric(drop, [(0, np.pi)], 2, resolution=9).cells) == 8
    assert len(parametric(drop, [(0, np.pi)], 2, resolution=9, closed=True).cells) == 9


def test_a_twisted_band_keeps_two_points_at_each_place_of_its_seam():
    def band(u, v):
        out = 1 + v * np.cos(u / 2)
        return out * np.cos(u), out * np.sin(u), v * np.sin(u / 2)

    shape = parametric(band, [TURN, (-0.4, 0.4)], 3, resolution=(30, 5))
    seam = shape.points.reshape(30, 5, 3)
    np.testing.assert_allclose(seam[0], seam[-1, ::-1], atol=1e-15)
    spaces = projector(shape.frame).reshape(30, 5, 3, 3)
    np.testing.assert_allclose(spaces[0], spaces[-1, ::-1], atol=1e-9)


def test_poles_have_rows_of_zero():
    def sphere(u, v):
        return np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)

    shape = parametric(sphere, [TURN, (0, np.pi)], 3, resolution=8, tangents="complex")
    frame = shape.frame.reshape(8, 8, 2, 3)
    assert np.all(np.linalg.norm(frame[:, 0], axis=2).sum(axis=1) == pytest.approx(1))
    assert np.all(np.linalg.norm(frame[:, 1:-1], axis=3) == pytest.approx(1))


def test_differences_stay_within_the_domain():
    """A function that is nothing outside, and whose slope at an end is infinite or is not."""

    def arc(t):
        return t, np.sqrt(t), np.sqrt(1 - t) ** 3

    shape = parametric(arc, [(0, 1)], 3, resolution=33)
    t = shape.points[1:-1, 0]
    exact = unit(np.stack([0 * t + 1, 0.5 / np.sqrt(t), -1.5 * np.sqrt(1 - t)], axis=1))
    np.testing.assert_allclose(shape.frame[1:-1, 0], exact, atol=1e-8)
    np.testing.assert_allclose(shape.frame[0, 0], [0, 1, 0], atol=2e-3)
    np.testing.assert_allclose(shape.frame[-1, 0] * np.sqrt(1.25), [1, 0.5, 0], atol=2e-3)

    def wavy(t):
        return t, np.exp(t)

    slope = parametric(wavy, [(0, 1)], 2, resolution=5).frame[:, 0]
    np.testing.assert_allclose(slope[:, 1] / slope[:, 0], np.exp(np.linspace(0, 1, 5)), rtol=1e-9)
    with pytest.raises(ValueError, match=r"function: .* the first at \(0\)"):
        parametric(lambda t: (t, np.sqrt(t - 0.1)), [(0, 1)], 2)


def test_the_step_follows_what_the_function_computes_in():
    """A step made for float64 leaves float32 no digits: errors of 4e-3, and no closed circle."""

    def circle(t):
        return np.cos(t.astype(np.float32)), np.sin(t.astype(np.float32)), 0

    shape = parametric(circle, [(0, 6)], 3)
    t = np.linspace(0, 6, 64)
    exact = np.stack([-np.sin(t), np.cos(t), 0 * t], axis=1)
    assert np.abs(shape.frame[:, 0] - exact).max() < 3e-4
    assert len(parametric(circle, [TURN], 3).cells) == 64
    half = parametric(lambda t: (t, (t**2).astype(np.float16)), [(0, 1)], 2, resolution=9)
    assert np.abs(half.frame[:, 0, 1] / half.frame[:, 0, 0] - np.linspace(0, 2, 9)).max() < 0.2


@pytest.mark.parametrize(
    "function",
    [
        lambda u, v: (1e6 * u, v, np.abs(v)),
        lambda u, v: (u, v, np.exp(20 * u) + np.abs(v)),
        lambda u, v: (u, 1e-9 * v, 1e-9 * np.real(v)),
    ],
    ids=["axes of other scales", "within one axis", "small"],
)
def test_what_is_not_analytic_is_found_on_every_axis_and_at_every_point(function):
    with pytest.raises(ValueError, match="function: expected one that is analytic"):
        parametric(function, [(0, 1), (0.5, 1)], 3, tangents="complex")


@pytest.mark.parametrize(
    "function",
    [
        lambda t: (np.cos(1000 * t), 1000 * t + np.sin(1000 * t), 0 * t),
        lambda t: (t, t**7, np.exp(30 * t)),
        lambda t: (1 / (t + 0.01), np.sqrt(t + 0.01), 1e-150 * t**3),
        lambda t: (1e8 + t, 1e150 * t**2, np.cos(t)),
    ],
)
def test_what_is_analytic_is_taken(function):
    assert parametric(function, [(0, 1)], 3, tangents="complex").k == 1


def test_closed_by_any_truth_value():
    def circle(t):
        return np.cos(t), np.sin(t)

    for closed in (True, 1, np.True_, [1], np.array([True])):
        assert len(parametric(circle, [TURN], 2, closed=closed).cells) == 64
    assert len(parametric(circle, [TURN], 2, closed=0).cells) == 63


@pytest.mark.parametrize(
    "radii", [(2.0,), (1.5, 0.75), (1, 2, 3), (1e-150, 5e-151), (1e149, 5e148)]
)
def test_tori_have_no_seam_and_orthonormal_frames_along_their_cells(radii):
    shape = manifolds.torus(*radii, resolution=[24, 16, 9][: len(radii)])
    gram = np.einsum("bki,bli->bkl", shape.frame, shape.frame)
    assert np.abs(gram - np.eye(shape.k)).max() < 8 * EPS
    assert set(faces_around(shape.cells)) == {2}
    places = shape.points / max(radii)
    # Nothing stands twice at a place: a seam would.
    assert len(np.unique(np.round(places, 9), axis=0)) == len(places)
    ends = shape.cells[:, 0], shape.cells[:, 1]
    step = unit(places[ends[1]] - places[ends[0]])
    along = np.linalg.norm(np.einsum("bki,bi->bk", shape.frame[ends[0]], step), axis=1)
    assert along.min() > 0.8


test_bad_frames = refusals(
    lambda k: manifolds.Manifold(np.zeros((8, 3)), np.zeros((8, k, 3)), np.zeros((1, 2**k), int)),
    (0, r"frame: expected shape \(8, k, 3\) with k < 3"),
    (3, r"frame: expected shape \(8, k, 3\) with k < 3"),
)


test_bad_radii = refusals(
    lambda radii: manifolds.torus(*radii),
    ((), "radii: expected 1 to 3 radii, got 0"),
    ((1, 0), r"radii\[1\]: expected a number above 0"),
    ((1e200,), r"radii\[0\]: expected a number from"),
)


def test_constants_and_volumes():
    cube = parametric(lambda x, y, z: (x, y, z, 0.5), [(0, 1)] * 3, 4, resolution=3)
    assert cube.cells.shape == (8, 8)
    np.testing.assert_allclose(np.abs(cube.frame), np.tile(np.eye(3, 4), (27, 1, 1)), atol=1e-9)


def bad_arguments(options):
    given = {"function": lambda t: (t, t**2, t**3), "domain": [(0.0, 1.0)], "n": 3, **options}
    function, domain, n = given.pop("function"), given.pop("domain"), given.pop("n")
    parametric(function, domain, n, **given)


test_bad_arguments = refusals(
    bad_arguments,
    ({"function": lambda t: (t, t)}, "function: expected one that returns 3"),
    ({"function": lambda t: 1.0}, "function: expected one that returns 3", TypeError),
    ({"function": lambda t: (t[:2], 0, 0)}, "function: expected one that returns", TypeError),
    ({"function": lambda t: ("x", t, t)}, "function: .*real numbers", TypeError),
    ({"function": lambda t: (t, 1j * t, t)}, "function: .*real numbers", TypeError),
    ({"function": lambda t: (t, t, np.where(t > 0.5, np.nan, t))}, "finite coord"),
    ({"function": lambda t: (1 / t, np.log(t), t)}, "finite coordinates"),
    ({"domain": [(1, 0)]}, "domain: expected finite pairs"),
    ({"domain": [(0, np.inf)]}, "domain: expected finite pairs"),
    ({"domain": (0, 1)}, "domain: expected 1 to 3 pairs"),
    ({"tangents": "forward"}, "tangents: expected 'central', 'complex'"),
    ({"tangents": lambda t: ((1, 2, 3), (1, 2, 3))}, "tangents: expected 1 rows"),
    ({"tangents": lambda t: ((1, 2),)}, "tangents: expected one that returns 3"),
    ({"tangents": np.ones((3, 3))}, "tangents: expected 'central'.*an array of"),
    ({"tangents": lambda t: None}, "tangents: expected 1 rows of 3, got None", TypeError),
    ({"step": 1e-20}, "step: expected one that rounding of the parameters does"),
    ({"domain": [(1e16, 1e16 + 1e4)]}, "domain: expected one in which rounding"),
    ({"domain": [(0, 1e-300)], "tangents": "complex"}, "domain: expected one in which rounding"),
    ({"closed": "yes"}, "closed: expected a bool or 1 of them", TypeError),
    ({"closed": (True, True)}, "closed: expected a bool or 1 of them"),
    ({"closed": True}, "closed: expected a function that returns to its start"),
    (
        {"function": lambda t: (np.abs(t), t, t), "tangents": "complex"},
        "function: expected one that is analytic.*pass tangents='central'",
    ),
    (
        {"function": lambda t: (np.arctan2(t, 1), t, t), "tangents": "complex"},
        "function: expected one that takes complex parameters",
        TypeError,
    ),
)
