"""Distance and depth at the ends of their ranges; elsewhere see the stability suite."""

import numpy as np
import pytest
from refusals import refusals

from vizlight.model import falloff


def test_distance_at_its_ends():
    assert falloff.distance(0.0, 0, 0, 1) == 1
    assert falloff.distance(0.0, 4, 0, 0) == 0.25
    assert falloff.distance(np.inf, 1, 0, 1) == 0
    assert falloff.distance(np.inf, 2, 0, 0) == 0.5
    assert falloff.distance(1e200, 1, 0, 1) == 0
    far = falloff.distance(np.array([np.inf, 1e30], dtype=np.float32), 0, 0, 1e-50)
    np.testing.assert_allclose(far, [0, 1e-10], rtol=1e-6)


test_bad_distance = refusals(
    lambda arguments: falloff.distance(*arguments),
    ((-1.0, 1, 0, 0), "d: expected distances of 0 or more"),
    ((np.nan, 1, 0, 0), "d: expected distances of 0 or more"),
    ((1.0, 0, 0, 0), "c1, c2, c3: expected three coefficients.*not all 0"),
    ((1.0, 1, -1, 0), "c1, c2, c3: expected three coefficients"),
)


def test_depth_cue_at_its_ends():
    z = np.array([-5.0, 0, 1, 2, 9])
    faded = falloff.depth_cue(1.0, z, front=2, back=0, front_scale=0.9, back_scale=0.1, cue=0.5)
    np.testing.assert_allclose(faded, [0.55, 0.55, 0.75, 0.95, 0.95])
    turned = falloff.depth_cue(1.0, -z, front=-2, back=0, front_scale=0.9, back_scale=0.1, cue=0.5)
    np.testing.assert_allclose(turned, faded)


def test_smooth_step_is_flat_at_both_ends():
    h = 1e-6
    ends = [falloff.depth_cue(1.0, z, front=1, back=0, smooth=True) for z in (h, 1 - h)]
    assert ends[0] < 10 * h * h
    assert 1 - ends[1] < 10 * h * h
    assert falloff.depth_cue(1.0, 0.5, front=1, back=0, smooth=True) == 0.5


def test_depth_cue_with_ends_out_of_range_of_the_type():
    z = np.array([0.0, 1e30], dtype=np.float32)
    assert falloff.depth_cue(np.float32(1), z, front=0, back=1e300).tolist() == [1, 1]


def test_bad_depth_cue():
    with pytest.raises(ValueError, match="z: expected depths without NaN"):
        falloff.depth_cue(1.0, np.nan, front=1, back=0)
    with pytest.raises(ValueError, match="intensity: expected finite light"):
        falloff.depth_cue(np.inf, 0.0, front=1, back=0)
    with pytest.raises(ValueError, match="front: expected a depth other than back"):
        falloff.depth_cue(1.0, 0.0, front=1, back=1)
    with pytest.raises(ValueError, match="back_scale: expected a number from 0 to 1, got 2"):
        falloff.depth_cue(1.0, 0.0, front=1, back=0, back_scale=2)


def test_fur_at_its_ends(dtype):
    assert falloff.fur(dtype(1e30), dtype(1e-30), 0.02) == 0
    assert falloff.fur(dtype(1), dtype(0), 1e-50) == 0
    assert falloff.fur(dtype(1), dtype(1), 1e-50) == 1
    assert falloff.fur(dtype(np.finfo(dtype).tiny), dtype(1), 1.0) == 0


test_bad_fur = refusals(
    lambda arguments: falloff.fur(*arguments),
    ((-1.0, 1.0, 0.5), "height: expected heights of 0 or more"),
    ((np.nan, 1.0, 0.5), "height: expected heights"),
    ((1.0, 1.5, 0.5), "sin_alpha: expected sines from 0 to 1"),
    ((1.0, -0.5, 0.5), "sin_alpha: expected sines"),
    ((1.0, 1.0, 1.5), "density: expected a number from 0 to 1"),
)
