"""Stated bounds hold against formulas, quadrature and rays that share nothing with the package."""

from __future__ import annotations

import csv

import promises
import pytest

SLOW = {promises.brightnesses, promises.bundles}


@pytest.mark.parametrize(
    "group",
    [
        pytest.param(group, marks=pytest.mark.slow if group in SLOW else (), id=group.__name__)
        for group in promises.GROUPS
    ],
)
def test_errors_are_within_the_stated_bound(group):
    found = list(promises.rows(1, [group]))
    assert found
    for promise in found:
        assert promise.cases > 0
        assert promise.worst <= 1, promise


def test_a_bound_that_does_not_hold_is_found(monkeypatch):
    wrong = promises.falloff.distance
    monkeypatch.setattr(promises.falloff, "distance", lambda d, *c: wrong(d * (1 + 1e-5), *c))
    assert max(promise.worst for promise in promises.rows(1, [promises.falloffs])) > 1


def test_the_page_has_every_promise():
    with promises.PAGE.open(newline="") as file:
        table = list(csv.DictReader(file))
    assert len(table) >= 20
    assert all(float(row["of the bound"]) <= 1 for row in table)
