"""The study of light inside bundles measures what it says; no time is asserted."""

from __future__ import annotations

import numpy as np
import pytest

from studies import bundle
from vizlight.mesh import closed_meshes


@pytest.mark.parametrize("kind", ["layered", "along the light"])
def test_rays_among_tubes_and_the_medium_agree(kind):
    """The means over the points have a random error of about 0.005."""
    pytest.importorskip("embreex")
    far, inside = bundle.measure(kind, 10_000, 96, 0)
    (sides,) = bundle.measure(kind, 10_000, 48, 16)
    assert [row.way for row in (far, inside, sides)] == [
        f"{kind}, far light", f"{kind}, light inside", f"{kind}, all sides"
    ]  # fmt: skip
    along = kind == "along the light"
    assert far.error < (0.05 if along else 0.015)
    assert inside.error < 0.03
    assert sides.error < 0.015
    assert 0.1 < far.more["mean share"] < (0.9 if along else 0.6)


def test_tubes_are_as_wide_as_lines():
    made = bundle.tubes("isotropic", 10)
    assert len(made.corners) == 2 * bundle.SIDES * bundle.TUBES
    own = made.corners[: 2 * bundle.SIDES].reshape(-1, 3) - made.middles[0]
    along = own @ made.tangents[0]
    assert np.abs(along) == pytest.approx(bundle.LENGTH / 2)
    out = np.linalg.norm(own - along[:, None] * made.tangents[0], axis=1)
    assert out == pytest.approx(bundle.DIAMETER / 2, rel=0.03)
    assert out.min() > bundle.DIAMETER / 2


def test_without_embree_the_study_names_the_extra(monkeypatch):
    monkeypatch.setattr(closed_meshes, "embree_tree", lambda _: None)
    bundle.truth.cache_clear()
    with pytest.raises(ImportError, match=r"vizlight\[rays\]"):
        bundle.truth("isotropic", 5)
