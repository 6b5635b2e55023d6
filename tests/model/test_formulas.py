"""Scalar formulas at the ends of their ranges.

Elsewhere they are the oracle's: see ``shading/test_terms.py``.
"""

import numpy as np

from vizlight.model import formulas
from vizlight.model.manifolds import ArrayAlgebra, Surface

W = ArrayAlgebra(np.dtype(float))


def test_highlights_of_a_surface():
    cosine = np.array([-0.5, 0.0, 0.05, 0.1, 0.5])
    side = Surface(W, None, 1.0).side(cosine)
    np.testing.assert_array_equal(side, [0, 0, 0.05, 0.1, 0.5])
    both = Surface(W, None, 1.0, both=True).side(cosine)
    np.testing.assert_array_equal(both, [0.5, 0, 0.05, 0.1, 0.5])
    shadowed = formulas.shadowed_highlight(0.7, 0.25, side)
    np.testing.assert_allclose(shadowed, [0, 0, 0.7, 0.7, 0.35], atol=1e-15)


def test_plain_numbers():
    assert formulas.phong(0.0, 0.6, 0.6, 20.0) == 1
    assert formulas.power(0.0, 1.0, 0.0) == 1
    assert formulas.power(0.0, 1.0, 2.0) == 0
    assert formulas.blinn(0.0, 0.0, 5.0) == 0
