"""Cross fields against closed forms: order and signs do not matter, also around singularities."""

import dataclasses

import numpy as np
import pytest

from vizlight.geometry.lines.tracing import Flow, Tracing, double_cover, trace

HOW = Tracing(step=0.3, max_length=3.0, max_steps=10_000, seed=0)
MINOR = 0.4


def lattice(n, m, *, around):
    """Return the indices of a lattice, and its triangles, closed or with a boundary."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    if not around:
        inner = (i < n - 1) & (j < m - 1)
        a, b = i[inner], j[inner]
    else:
        a, b = i, j
    at = [((a + p) % n) * m + (b + q) % m for p, q in ((0, 0), (1, 0), (1, 1), (0, 1))]
    return (
        i,
        j,
        np.concatenate([np.stack([at[k] for k in t], axis=1) for t in ([0, 1, 2], [0, 2, 3])]),
    )


def mixed(u, v, random):
    """Return pairs in random order with random signs."""
    pairs = np.stack([u, v], axis=1)
    swap = random.random(len(u)) < 0.5
    pairs[swap] = pairs[swap][:, ::-1]
    return pairs * random.choice([-1.0, 1.0], size=(len(u), 2, 1))


def torus(n):
    """Return a torus with its principal directions; no edge runs along a meridian or parallel.

    No two triangles share a vertex, so that the order differs from triangle to triangle.
    """
    i, j, cells = lattice(n, n // 2, around=True)
    phi = 2 * np.pi * i / n
    theta = 2 * np.pi * (2 * j / n + i / n)
    ring = 1 + MINOR * np.cos(theta)
    points = np.stack([ring * np.cos(phi), ring * np.sin(phi), MINOR * np.sin(theta)], axis=1)
    u = [-np.sin(theta) * np.cos(phi), -np.sin(theta) * np.sin(phi), np.cos(theta)]
    v = [-np.sin(phi), np.cos(phi), 0 * phi]
    u, v = (np.stack(each, axis=1)[cells.ravel()] for each in (u, v))
    return points[cells].reshape(-1, 3), np.arange(cells.size).reshape(-1, 3), u, v


def test_lines_of_a_torus_are_meridians_and_parallels_of_second_order(random):
    errors = []
    for n in (48, 96):
        points, cells, u, v = torus(n)
        mesh, lines = double_cover(points, cells, mixed(u, v, random))
        assert np.all(mesh.neighbours >= 0)
        one = mesh.random(10, np.random.default_rng(1))
        both = type(one)(one.cell % len(cells), one.weights)
        other = type(one)(both.cell + len(cells), one.weights)
        flow = Flow(mesh, lines, line_field=True)
        curves = trace(flow, both.joined(other), HOW)
        x, y, z = mesh.positions(curves.places).T
        phi, theta = np.arctan2(y, x), np.arctan2(z, np.hypot(x, y) - 1)
        parallels, worst = [], 0.0
        for start, end in zip(curves.offsets[:-1], curves.offsets[1:], strict=True):
            turn = [
                size * np.abs(np.angle(np.exp(1j * (a[start:end] - a[start])))).max()
                for a, size in ((phi, 1.4), (theta, MINOR))
            ]
            parallels.append(turn[1] < turn[0])
            worst = max(worst, min(turn))
        # One of each family starts at each place.
        np.testing.assert_array_equal(np.array(parallels[:10]), ~np.array(parallels[10:]))
        errors.append(worst)
    assert errors[1] < 0.04
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.3)


@pytest.mark.parametrize("index", [0.25, -0.25, 0.5])
def test_lines_go_around_a_singularity(index, random):
    """Directions of angle ``index * phi``: curves on which Re or Im of z^(1 - index) is constant.

    With index 1/4 the two directions have changed places after one turn.
    """
    n = 81
    i, j, cells = lattice(n, n, around=False)
    # No vertex at the singularity.
    x, y = 2 * i / (n - 1) - 1.0 + 0.007, 2 * j / (n - 1) - 1.0 + 0.004
    points = np.stack([x, y, 0 * x], axis=1)
    angle = index * np.arctan2(y, x)
    u = np.stack([np.cos(angle), np.sin(angle), 0 * x], axis=1)
    mesh, lines = double_cover(points, cells, mixed(u, np.cross([0, 0, 1.0], u), random))
    far = np.flatnonzero(np.hypot(*points[cells].mean(axis=1)[:, :2].T) > 0.2)
    cell = random.choice(far, 20)
    share = np.full((40, 3), 1 / 3)
    seeds = type(mesh.one_each())(np.concatenate([cell, cell + len(cells)]), share)
    how = dataclasses.replace(HOW, max_length=9.0)
    curves = trace(Flow(mesh, lines, line_field=True), seeds, how)
    found = mesh.positions(curves.places)
    errors, turns = [], []
    for start, end in zip(curves.offsets[:-1], curves.offsets[1:], strict=True):
        x, y, _ = found[start:end].T
        r, phi = np.hypot(x, y), np.unwrap(np.arctan2(y, x))
        if r.min() < 0.1:
            continue
        power = r ** (1 - index) * np.exp(1j * (1 - index) * phi)
        slope = (1 - index) * r**-index
        errors.append(min(np.abs((f - f[0]) / slope).max() for f in (power.real, power.imag)))
        turns.append(np.ptp(np.floor((phi + np.pi) / (2 * np.pi))))
        assert max(abs(x[0]), abs(y[0])) > 0.97
        assert max(abs(x[-1]), abs(y[-1])) > 0.97
    assert len(errors) > 20
    assert max(errors) < 2e-3
    # Some cross the ray at which the formula for the angle jumps.
    assert sum(turns) >= 3
