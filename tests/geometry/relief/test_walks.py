"""Compiled lengths through squares of cells against the NumPy walk, cell by cell."""

from __future__ import annotations

import numpy as np
import pytest
from fields import by_cells, hills, places, sun

from vizlight import _compiled
from vizlight.geometry import relief
from vizlight.geometry.relief import height_field, strips, walks

pytestmark = pytest.mark.skipif(not _compiled.active(), reason="numba is not available")


@pytest.fixture(autouse=True)
def _compile(monkeypatch):
    monkeypatch.setenv("VIZLIGHT_FAST", "1")


@pytest.mark.parametrize("way", [sun(0.01, 12), sun(90, 0), sun(88, 40), sun(-30, 250)])
@pytest.mark.parametrize("border", ["extend", "wall"])
def test_squares_are_the_cells(way, border, random):
    x, y, z = hills(37, 28)
    field = height_field.make(x, y, z, border=border)
    start = (places(x, y, z, 500, random) - field.origin).T.copy()
    found = np.empty(500)
    ways = np.repeat(way[:, None], 500, axis=1)
    walks.walk(
        start, ways, np.full(500, walks.FAR), *field.edges, field.corners,
        walks.levels(field.bounds), field.top, border == "wall", found,
    )  # fmt: skip
    np.testing.assert_allclose(found, by_cells(field, start, way), atol=1e-11)


@pytest.mark.parametrize("light", [{"direction": sun(15, 70)}, {"position": (0, 0, 90)}])
def test_numpy_follows_the_rays_that_a_kernel_fails_with(light, monkeypatch):
    def broken(*_):
        raise RuntimeError("LLVM ERROR")

    x, y, z = hills(20, 15)
    with _compiled.setting("0"):
        numpys = relief.shadow(x, y, z, depth=0.1, **light)
    monkeypatch.setattr(_compiled, "_BROKEN", [])
    for kernel in (walks.walk, strips.lengths):
        monkeypatch.setattr(kernel, "_proven", True)
        monkeypatch.setattr(kernel, "_compiled", broken)
    with pytest.warns(RuntimeWarning, match="LLVM ERROR") as caught:
        found = relief.shadow(x, y, z, depth=0.1, **light)
    assert len(caught) == 1
    np.testing.assert_array_equal(found, numpys)
