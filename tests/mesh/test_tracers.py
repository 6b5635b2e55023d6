"""Vectors that are traced through a mesh."""

import numpy as np

from vizlight.mesh import tracers


def test_six_components_are_the_tensor_of_nine(random):
    tensors = random.normal(size=(20, 3, 3))
    tensors = tensors + np.swapaxes(tensors, 1, 2)
    six = tensors[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
    found, expected = map(tracers.principal_directions, (six, tensors.reshape(-1, 9)))
    np.testing.assert_allclose(np.abs(np.einsum("ij,ij->i", found, expected)), 1)
