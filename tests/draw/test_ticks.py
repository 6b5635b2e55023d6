"""Round numbers along bars and axes."""

import numpy as np
import pytest

from vizlight.draw import ticks


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (-1, 1, ["-1.0", "-0.5", "0.0", "0.5", "1.0"]),
        (236, 1080, ["400", "600", "800", "1000"]),
        (-6.08e-7, 4.5, ["0", "1", "2", "3", "4"]),
        (0, 3.2e6, ["0", "1e6", "2e6", "3e6"]),
        (5, 5, ["5"]),
        (6808412, 6809312, ["6,808,600", "6,808,800", "6,809,000", "6,809,200"]),
        (9000, 45000, ["10,000", "20,000", "30,000", "40,000"]),
        (-5e4, -5e4, ["-50,000"]),
    ],
)
def test_the_numbers_of_a_bar_are_few_and_round(low, high, words):
    assert [word for _, word in ticks.even_numbers(low, high)] == words


def test_ends_of_a_bar_that_rounding_alone_tells_apart():
    low = np.sqrt(2)
    assert ticks.even_ends(low, np.nextafter(low, 2)) == pytest.approx((low, low))
