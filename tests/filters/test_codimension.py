"""Illustration 1 of Banks as numbers: what compensation does to brightness and contrast."""

import math

import numpy as np
import pytest
from shapes import torus_curve

import vizlight
from vizlight import Light, Material, Scene
from vizlight.geometry import manifolds

LIGHT = np.array([0.7, 0.6, 0.38, 0.0])
#: The curve advances as fast along one circle as along the other.
SHAPES = {
    1: torus_curve(2.025, 40, (1.5, 0.75), 6000),
    2: manifolds.torus(1.5, 0.75, resolution=96),
}


def panel(k, n, exponent):
    """Return mean and contrast of light in 4-space, or after the projection to 3-space."""
    scene = Scene(
        lights=Light(direction=LIGHT[:n]), material=Material(ambient=0, diffuse=1, specular=0)
    )
    # From this distance the projection is stereographic: the torus has circular sections.
    mesh = vizlight.manifold(
        SHAPES[k], distance=math.hypot(1.5, 0.75), scene=scene,
        light="after" if n == 3 else "before", exponent=exponent,
    )  # fmt: skip
    # In 4-space all points have the same share of length or area.
    share = np.ones(mesh.n_points)
    if n == 3:
        sizes = mesh.compute_cell_sizes()["Area" if k == 2 else "Length"]
        share = np.bincount(SHAPES[k].cells.ravel(), np.repeat(sizes, 2 * k), mesh.n_points)
    light = np.asarray(mesh["luminance"], float)
    mean = np.average(light, weights=share)
    return mean, math.sqrt(np.average((light - mean) ** 2, weights=share)) / mean


def test_plain_light_grows_brighter_and_flatter_with_codimension_and_compensation_mends_it():
    panels = (2, 3), (2, 4), (1, 3), (1, 4)
    plain = np.array([panel(k, n, 1) for k, n in panels])
    mended = np.array([panel(k, n, "compensated") for k, n in panels])
    assert np.all(np.diff(plain[:, 0]) > 0)
    assert np.all(np.diff(plain[:, 1]) < 0)
    assert plain[-1, 1] < 0.2
    assert np.abs(mended[:, 0] - 0.5).max() < 0.05
    assert np.ptp(mended[:, 0]) < 0.12 * np.ptp(plain[:, 0])
    assert np.ptp(mended[:, 1]) < 0.45 * np.ptp(plain[:, 1])


def test_the_torus_in_four_space_by_hand():
    """sin^2(a) = |l1|^2 cos^2 t + |l2|^2 cos^2 f, l1 and l2 the light in the planes of the circles.

    Its mean is 1/2 whatever the light.
    """
    l1, l2 = LIGHT[:2] @ LIGHT[:2], LIGHT[2:] @ LIGHT[2:]
    mean, contrast = panel(2, 4, "compensated")
    assert mean == pytest.approx(0.5, abs=1e-12)
    expected = 2 * math.sqrt((l1**2 + l2**2) / 8) / (l1 + l2)
    assert contrast == pytest.approx(expected, abs=1e-12)
