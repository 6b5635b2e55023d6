"""The model of the cost of pieces is found again from times that follow it."""

from __future__ import annotations

import numpy as np
import pytest

from studies import Row
from studies import pieces as study

#: Processor seconds for one node, point, piece or sample.
TRUE = {
    "read": {"nodes read": 2e-9, "pieces": 3e-3},
    "contour": {"nodes read": 4e-8, "points": 1e-6},
    "light": {"points": 6e-7, "pieces": 1e-2},
    "write": {"points": 5e-7, "pieces": 2e-2},
    "client": {"pieces": 5e-3},
    "draw": {"points": 1e-7, "layer samples": 4e-8},
    "composite": {"layer samples": 2e-8},
}


def rows(noise=0.0):
    random = np.random.default_rng(1)
    found = []
    for name, case in study.cases(64).items():
        nodes = case.side**2 * case.height
        counts = {
            "nodes read": nodes * 1.2, "pieces": case.pieces,
            "points": 30 * case.waves * case.side**2 * case.height / case.side,
        }  # fmt: skip
        samples = {"layer samples": case.pieces * np.prod(study.PICTURE)}
        for workers in (1, 2):
            times = study.modelled(TRUE, counts | samples)
            if workers == 2:
                del times["draw"]
            times = {
                key: value * (1 + noise * random.uniform(-1, 1)) for key, value in times.items()
            }
            more = counts | times | {"wall of 1 / this": 0.9 * workers, "disk GB/s": 0.5}
            way = f"{name}, {workers} worker{'s' * (workers > 1)}"
            found.append(Row(way, nodes, 1e-7, 1.0, more))
    return found


def test_the_model_is_found_and_extrapolated():
    exact = rows()
    model = study.fit(exact)
    for stage, terms in TRUE.items():
        assert model[stage] == pytest.approx(terms, rel=1e-6)
    assert np.abs(study.residuals(exact, model)).max() < 1e-9
    assert abs(study.extrapolation(exact)) < 1e-9
    noisy = rows(0.2)
    assert 0.01 < np.abs(study.residuals(noisy, study.fit(noisy))).max() < 0.2
    table = study.with_residuals(noisy)
    assert table[0].more["model / measured - 1"] == study.residuals(noisy, study.fit(noisy))[0]


def test_the_prediction_is_the_sum_of_its_parts():
    found = study.predicted(rows())
    pieces = study.NODES / study.SLAB
    assert found["client"] == pytest.approx(5e-3 * pieces)
    assert found["read"] == pytest.approx((2e-9 * study.NODES + 3e-3 * pieces) / study.WORKERS)
    layers = study.LAYERS * study.WORKERS
    assert found["composite"] == pytest.approx(2e-8 * layers * study.SAMPLES)
    more = study.predicted(rows(), 4.0)["read"] - found["read"]
    assert more == pytest.approx(3 * 2e-9 * study.NODES / study.WORKERS)
    assert "2 workers light a grid 1.8 times as fast as 1" in study.verdict(rows())


def test_the_interval_is_that_of_the_fit():
    """It has no width without noise, a width in proportion to it, and the true value inside."""
    true = sum(study.predicted(rows()).values())
    np.testing.assert_allclose(study.interval(rows()), true, rtol=1e-6)
    widths = []
    for noise in (0.001, 0.01):
        low, high = study.interval(rows(noise))
        assert low < true < high
        widths.append(high - low)
    assert widths[1] / widths[0] == pytest.approx(10, rel=0.1)


def test_bytes_are_moved_at_the_rate_of_the_slowest():
    moved = study.transfers(rows())
    assert moved["read"] == 4e12
    assert study.transfers(rows(), 4.0)["read"] == 1.6e13
    assert moved["layers"] == study.LAYERS * study.WORKERS * study.SAMPLES * 7
    found = study.moving(rows())
    assert found["1 GB/s shared"] == pytest.approx(sum(moved.values()) / 1e9)
    own = (moved["read"] + moved["write"]) / 0.5e12 + moved["layers"] / 1e9
    assert found["disks of the workers"] == pytest.approx(own)
    assert study._disk() > 1e6


def test_a_grid_in_pieces_is_measured(tmp_path):
    case = study.Case(14, 20, 3, 1.0)
    source = study._slabs(case, tmp_path / "s.npy")
    found = study._run(tmp_path, None, source, case, keep=True)
    assert found["pieces"] == 3
    assert study._error(found["meshes"], case) < 1e-6
    assert all(found[stage] >= 0 for stage in ("read", "contour", "light", "write", "client"))
    runs = {("grid", count): [found] for count in (1, 2)}
    same = {"error": 0.0, "composite": study._composite(1), "disk": 1e9}
    row = study._row(case, "grid", 2, runs, same)
    assert (row.way, row.parameter, row.more["wall of 1 / this"]) == ("grid, 2 workers", 3920, 1)
    assert row.more["nodes read"] == 14**2 * (20 + 2 * 3 + 2 - 2)  # shared slices, ghosts, ends
    assert 0 < row.more["composite"] < 1
