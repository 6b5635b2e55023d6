"""The stability suite: it passes, its claims are tight, and it can fail."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import oracles
import pytest
from hypothesis import given, settings, target
from hypothesis import strategies as st

from vizlight import _tolerance
from vizlight.model import falloff, reflection
from vizlight.studies import _digits, _hard, stability

COUNT = 120


@pytest.mark.parametrize("kernel", stability.KERNELS)
def test_claims_hold(kernel, monkeypatch):
    # The reference of large and broken powers takes half a second each.
    monkeypatch.setattr(stability, "CYLINDER_SLOW", (7.5,))
    _, types = stability.KERNELS[kernel]
    for dtype in types:
        rows = stability.measure(kernel, dtype, COUNT)
        for row in rows:
            assert row.more[""] == "pass", (row.more["case"], row.error, row.parameter)
        assert any(row.error > 0 for row in rows)


def test_a_kernel_that_loses_digits_fails(monkeypatch):
    """sqrt(1 - cos^2) in place of the residual is found out along the tangent, and only there."""

    def careless(wi, frame, *, exponent):
        w = wi / np.abs(wi).max(axis=-1, keepdims=True)
        w = w / np.linalg.norm(w, axis=-1, keepdims=True)
        cosine = np.einsum("bkn,bn->bk", np.broadcast_to(frame, (len(w), *frame.shape[-2:])), w)
        return np.sqrt(np.maximum(1 - np.sum(cosine**2, axis=-1), 0)) ** w.dtype.type(exponent)

    monkeypatch.setattr(stability.reflection, "diffuse", careless)
    with np.errstate(all="ignore"):
        checks = list(stability.diffuse(np.float32, 600, np.random.default_rng(1)))[:-1]
    rows = {row.more["case"]: row for row in stability.rows_of("careless", np.float32, checks)}
    assert rows["along the tangent"].more[""] == "FAIL"
    assert rows["across"].more[""] == "pass"
    said = stability.verdict(list(rows.values()))
    assert said.startswith("do not rely on the claims of careless, float32 (")


def test_not_a_number_fails():
    check = stability.Check("a", np.array([1.0, np.nan]), [1, 2], np.array(5.0), 1.0)
    (row,) = stability.rows_of("kernel", np.float64, iter([check]))
    assert row.error == np.inf
    assert row.more[""] == "FAIL"


def test_every_kernel_has_ten_thousand_inputs():
    """Counted without the oracle: how many inputs each case would have."""
    rows = stability.measure("falloff.fur", np.float32, stability.INPUTS)
    assert sum(row.more["inputs"] for row in rows) >= 10_000
    assert len(stability.steps(True)) == sum(len(t) for _, t in stability.KERNELS.values())


def test_loose_claims_are_named():
    check = stability.Check("a", np.array([1.0]), [1 - 1e-15], np.array(500.0), 1.0)
    rows = stability.rows_of("slack", np.float64, iter([check]))
    assert stability.loosest(rows)["slack"] > 8
    assert "claims more than 8 times what is seen: slack" in stability.verdict(rows)


def test_hard_directions_are_where_they_say(random):
    frame = _hard.frames(random, 200, 2, 4, np.float32)
    for kind, low, high in (("along the tangent", 0, 1e-6), ("one ulp off it", 1e-9, 1e-6)):
        x = _hard.directions(random, frame, kind).astype(float)
        x /= np.linalg.norm(x, axis=1, keepdims=True)
        sine = np.linalg.norm(
            x - np.einsum("bkn,bk->bn", frame, np.einsum("bkn,bn->bk", frame, x)), axis=1
        )
        assert low <= np.median(sine) < high
    wi = _hard.directions(random, frame, "random")
    mirror = _hard.eyes(random, wi, frame, "at the mirror")
    value = reflection.specular(wi, mirror, frame, shininess=50)
    np.testing.assert_allclose(value, 1, atol=1e-4)


@pytest.mark.parametrize("s", [0.0, 1.0, 5.0, 20.0, 20.5, 100.0])
def test_the_cylinder_s_closed_form_is_its_quadrature(s, random):
    for wi, wo, t in random.standard_normal((4, 3, 3)):
        light, shine, *_ = _digits.cylinder(wi, wo, t, s)
        exact = oracles.line_light(wi, wo, t, s)
        assert abs(light - exact[0]) < 1e-25
        assert abs(shine - exact[1]) < 1e-12 * max(1, exact[1])


small = st.floats(-40, 0)


@settings(max_examples=300)
@given(small, st.floats(0, 6.28), st.sampled_from([1.0, 4.7635, 65.0, 1e4]))
def test_a_search_for_the_worst_diffuse(power, turn, exponent):
    """Hypothesis climbs toward the largest error; the claim holds on its way."""
    wi = np.array([np.cos(turn), np.sin(turn), 2.0**power])
    frame = np.array([[np.cos(turn), np.sin(turn), 0]])
    frame /= np.linalg.norm(frame)
    value = reflection.diffuse(wi, frame, exponent=exponent)
    error = oracles.units(value, oracles.diffuse(wi, frame, exponent), np.float64)
    eps = oracles.eps(np.float64)
    claim = _tolerance.diffuse_bound(exponent, eps) / eps
    target(error / claim)
    assert error <= claim


@settings(max_examples=300)
@given(st.floats(0, 1e3), st.floats(0, 1), st.floats(0, 1))
def test_a_search_for_the_worst_fur(height, sine, density):
    value = falloff.fur(height, sine, density)
    if height == 0 or density == 0:
        assert value == 1
        return
    if sine == 0 or density == 1:
        assert value == 0
        return
    path = oracles.exact(height) / oracles.exact(sine)
    true = oracles.mp.exp(path * oracles.mp.log1p(-oracles.exact(density)))
    error = oracles.units(value, true, np.float64)
    target(error)
    assert error <= 3


def test_without_mpmath_it_says_how_to_get_it():
    code = (
        "import sys; sys.modules['mpmath'] = None; from vizlight import cli; "
        "sys.exit(cli.main(['study', 'stability', '-o', sys.argv[1]]))"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, "unused"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 1
    assert "pip install 'vizlight[test]'" in run.stderr
