"""What N.H and R.E refuse; every relation is in the stability suite."""

import numpy as np
import pytest

from vizlight.model import half_vector, reflection


def test_bad_input():
    with pytest.raises(ValueError, match="wi: expected vectors of shape"):
        half_vector.reflection([1, 0], [1, 0, 0], [1, 0, 0])
    with pytest.raises(TypeError, match="n_h: expected real numbers"):
        half_vector.reflection_from_half("x")
    with pytest.raises(TypeError, match="theta: expected real numbers"):
        half_vector.reflection_cosine(0, beta=0, theta=None)


def test_where_one_angle_says_nothing_of_the_other():
    """The two sets of extreme conditions of Fisher and Woo, N in the plane across the eye."""
    eye, turn = np.array([0.0, 0, 1]), np.linspace(0, np.pi / 2, 50)
    normals = np.stack([-np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    behind, beside = np.array([-1e-6, 0, -1]), np.array([-1.0, 0, 0])
    assert half_vector.reflection(behind, eye, normals).min() > 1 - 1e-11
    assert half_vector.reflection(beside, eye, normals) == pytest.approx(0, abs=1e-15)
    half = [
        reflection.specular(light, eye, across(normals), shininess=1, model="blinn")
        for light in (behind, beside)
    ]
    assert np.degrees(np.arccos(half[0][[0, -1]])) == pytest.approx([0, 90], abs=1e-3)
    assert np.degrees(np.arccos(half[1][[0, -1]])) == pytest.approx([45, 90])
    assert round(255 * half[1].max() ** 10) == 8


def across(normals):
    """Return frames of tangents across normals in the xy plane."""
    up = np.broadcast_to([0.0, 0, 1], normals.shape)
    return np.stack([np.cross(up, normals), up], axis=1)
