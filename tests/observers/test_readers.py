"""The meter gives the answers that are known."""

import numpy as np
import pytest
from closed_cases import CASES

from vizlight.observers import readers


@pytest.mark.parametrize("name", CASES)
def test_known_answer(name):
    CASES[name]()


def test_black_and_white_have_the_ends_of_lightness():
    np.testing.assert_allclose(readers.lab(np.zeros(3)), 0, atol=1e-12)
    np.testing.assert_allclose(readers.lab(np.ones(3)), [100, 0, 0], atol=0.01)


def test_candidates_of_tangents_are_turned_evenly():
    normals, tangents = readers._disc(5, 8, 0.3)
    tangents = tangents.reshape(8, 5, 3)
    np.testing.assert_allclose(
        np.einsum("ij,ij->i", normals, tangents.reshape(-1, 3)), 0, atol=1e-12
    )
    turned = np.einsum("tij,tij->ti", tangents[:-1], tangents[1:])
    np.testing.assert_allclose(turned, np.cos(np.pi / 8))
