"""Colours of rasters: which bands they are made of, and their bytes."""

import numpy as np
import pytest

from vizlight.reading.composites import colors_among, composite

GREY = (217, 217, 217)


@pytest.mark.parametrize(("names", "kinds", "expected"), [
    (["band_1", "band_2", "band_3"], "uint8", [0, 1, 2]),
    (["band_1", "band_2", "band_3", "band_4"], "uint16", [0, 1, 2]),
    # Months or depths are no picture.
    (["band_1", "band_2", "band_3"], "float32", []),
    ([f"band_{i}" for i in range(1, 13)], "uint16", []),
    (["B02", "B03", "B04", "B08"], "uint16", [2, 1, 0]),
    (["SR_B2 (blue)", "SR_B3 (green)", "SR_B4 (red)"], "float32", [2, 1, 0]),
    (["Coastal Blue", "Blue", "Green", "Red", "Red Edge"], "uint16", [3, 2, 1]),
    (["R", "G", "B", "NIR"], "uint8", [0, 1, 2]),
    (["ndvi", "evi", "lai"], "uint8", []),
])  # fmt: skip
def test_bands_are_colours_by_their_names(names, kinds, expected):
    of_file = dict.fromkeys(names, ("undefined", kinds))
    assert colors_among(of_file) == [names[i] for i in expected]


def test_bands_are_colours_by_what_the_file_says():
    kinds = dict(zip("xyzw", ("gray", "blue", "green", "red"), strict=True))
    assert colors_among({name: (kind, "float64") for name, kind in kinds.items()}) == [*"wzy"]


def test_numbers_are_stretched_alike_and_bytes_are_kept():
    ramp = np.linspace(0.1, 0.3, 101).reshape(1, -1)
    colors = composite([ramp, ramp, np.full_like(ramp, 0.2)], as_stored=False)
    assert colors.dtype == np.uint8
    np.testing.assert_allclose(colors[0, 50], 127.5, atol=0.5)
    np.testing.assert_array_equal(colors[0, [0, -1], 0], (0, 255))
    stored = composite([ramp * 100, ramp * 0, ramp], as_stored=True)
    np.testing.assert_array_equal(stored[0, [0, -1]], [(10, 0, 0), (30, 0, 0)])


def test_a_pixel_without_any_band_is_grey():
    rows = np.array([[np.nan, 10.0]])
    colors = composite([rows, rows, np.full((1, 2), np.nan)], as_stored=True)
    np.testing.assert_array_equal(colors[0], [GREY, (10, 10, 0)])
