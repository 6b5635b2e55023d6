"""What N.H and R.E refuse; every relation is in the stability suite."""

import pytest

from vizlight.model import half_vector


def test_bad_input():
    with pytest.raises(ValueError, match="wi: expected vectors of shape"):
        half_vector.reflection([1, 0], [1, 0, 0], [1, 0, 0])
    with pytest.raises(TypeError, match="n_h: expected real numbers"):
        half_vector.reflection_from_half("x")
    with pytest.raises(TypeError, match="theta: expected real numbers"):
        half_vector.reflection_cosine(0, beta=0, theta=None)
