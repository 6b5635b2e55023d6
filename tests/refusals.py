"""Tests that what does not fit is refused, in words that name it."""

import pytest


def refusals(call, *rows, kind=ValueError):
    """Return a test for rows of the arguments of a call and the words of its error.

    A row ends with the error's type where it is another than ``kind``.
    """

    @pytest.mark.parametrize("row", rows)
    def test(row):
        own = kind
        if isinstance(row[-1], type):
            *row, own = row
        *arguments, words = row
        with pytest.raises(own, match=words):
            call(*arguments)

    return test
