"""Form of the studies: found by name, run, shown as table, CSV file, figure and verdict."""

from __future__ import annotations

import csv
import dataclasses
import re

import numpy as np
import pytest
import pyvista as pv

import studies
from studies import Curve, Panel, Row, Study, __main__, _figure


@pytest.fixture
def toy():
    def steps(quick):
        sizes = (10, 20) if quick else (10, 20, 40, 80)
        return [lambda n=n: [Row("rough", n, n**-2.0, 3.0 * n, {"memory": n})] for n in sizes] + [
            lambda: [Row("exact", "none", 0.0, 500.0)]
        ]

    def verdict(rows):
        best = studies.cheapest(rows)
        return f"at 1/255 use {best.way}, {best.parameter}"

    return Study(
        approximates="a toy",
        reference="itself",
        parameter="points",
        error="error",
        cost="ns",
        steps=steps,
        verdict=verdict,
        axes=("parameter", "error"),
    )


@pytest.mark.parametrize("name", studies.names())
def test_every_study_has_the_shape(name):
    study = studies.load(name)
    assert isinstance(study, Study)
    for text in (study.approximates, study.reference, study.parameter, study.error, study.cost):
        assert text
    assert set(study.axes) <= {"parameter", "error", "cost"}
    assert 0 < len(study.steps(True)) <= len(study.steps(False))


def test_names():
    assert {"engine", "frames", "highlights", "lines", "fur", "relief"} <= set(studies.names())
    assert {"mesh", "scaling", "streamlines", "tubes"} <= set(studies.names())
    with pytest.raises(ValueError, match=r"study: expected one of bundle, .*, got 'nothing'"):
        studies.load("nothing")


def test_run(toy):
    result = studies.run("toy", toy, quick=True)
    assert len(result.rows) == 3
    assert result.verdict == "at 1/255 use rough, 20"
    assert len(studies.run("toy", toy).rows) == 5


def test_csv_keeps_all_digits(toy, tmp_path):
    result = studies.run("toy", toy)
    path = result.write_csv(tmp_path / "toy.csv")
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["method", "points", "error", "ns", "memory"]
    assert float(rows[1][2]) == 1 / 400
    assert rows[-1] == ["exact", "none", "0.0", "500.0", ""]


def test_figure_is_logarithmic(toy, tmp_path):
    result = studies.run("toy", toy)
    picture = pv.read(result.draw(tmp_path / "toy.png"))
    assert picture.dimensions == (960, 720, 1)
    pixels = np.asarray(picture.active_scalars).reshape(720, 960, -1)[..., :3].astype(int)
    blue = np.argwhere(np.abs(pixels - (0, 0x72, 0xB2)).sum(axis=-1) < 30)
    # A power law is a straight line: its pixels, the legend's left out, lie along one.
    line = blue[blue[:, 0] > 150]
    fit = np.polyfit(line[:, 1], line[:, 0], 1)
    assert np.abs(np.polyval(fit, line[:, 1]) - line[:, 0]).max() < 6


def test_panels_show_the_curves_they_ask_for(toy):
    """Colour by name, line style by kind; coincident exact ways are one line."""
    from matplotlib.figure import Figure

    rows = [
        Row(f"{name}, {kind}", n, 1 / n, n, {}) for n in (1, 2) for name in "ab" for kind in "cd"
    ]
    rows += [Row(way, "none", 0.0, 5.0) for way in ("one", "two", "hidden")]
    panel = Panel(
        curve=lambda row: None if row.way == "hidden" else Curve(*row.way.split(", ")),
        diagonal="x = y", x="other name",
    )  # fmt: skip
    axes = Figure().add_subplot()
    _figure.draw_panel(studies.Result("toy", toy, rows, ""), panel, axes)
    lines = {line.get_label(): line for line in axes.lines}
    assert set(lines) == {"a, c", "a, d", "b, c", "b, d", "no error: one, two", "x = y"}
    assert lines["a, c"].get_color() == lines["a, d"].get_color() != lines["b, c"].get_color()
    assert lines["a, c"].get_linestyle() == lines["b, c"].get_linestyle() == "-"
    assert lines["a, d"].get_linestyle() == "--"
    assert axes.get_xlabel() == "other name"
    shown = lines["x = y"].get_transform().transform([(0, 0), (1, 1)])
    x, y = axes.transData.inverted().transform(shown).T
    np.testing.assert_allclose(x, y)
    assert x[0] != x[1]


def test_a_panel_without_rows(toy, tmp_path):
    study = dataclasses.replace(toy, curve=lambda _: None, beside=(Panel(diagonal="x = y"),))
    picture = pv.read(studies.run("toy", study).draw(tmp_path / "toy.png"))
    assert picture.dimensions == (1440, 720, 1)


def test_more_curves_than_colours_differ_in_style(toy):
    from matplotlib.figure import Figure

    rows = [Row(f"way {i}", n, 1 / n, n) for i in range(10) for n in (1, 2)]
    axes = Figure().add_subplot()
    _figure.draw_panel(studies.Result("toy", toy, rows, ""), Panel(), axes)
    assert len({(line.get_color(), line.get_linestyle()) for line in axes.lines}) == 10


def test_usual_and_holding():
    rows = [Row("a", n, 1 / n, cost) for n, cost in ((1, 1.0), (2, 9.0), (4, 8.0), (8, 10.0))]
    assert studies.cheapest(rows, 0.5, usual=rows[1]) is rows[1]
    assert studies.cheapest(rows, 0.5, usual=rows[3]) is rows[2]
    assert studies.cheapest(rows, 0.5, usual=rows[0]) is rows[2]
    assert studies.holding(rows, 0.5, coarse=False) is rows[1]
    assert studies.holding(rows, 0.1, coarse=False) is None
    by_step = [row._replace(parameter=1 / row.parameter) for row in rows]
    assert studies.holding(by_step, 0.5) is by_step[1]
    gap = [rows[0], rows[1], rows[2]._replace(error=2.0), rows[3]]
    assert studies.holding(gap, 0.5, coarse=False) is gap[3]


def test_order_and_cheapest():
    rows = [Row("a", h, 3 * h**2.5, 1 / h) for h in (0.1, 0.2, 0.4)]
    assert studies.order(rows) == pytest.approx(2.5)
    assert studies.cheapest(rows, 0.1) is rows[1]
    assert studies.cheapest(rows, 1e-9) is None
    assert studies.cheapest([*rows, Row("b", 1, 0.0, np.nan)], 0.1) is rows[1]


def test_command_line(tmp_path, capsys):
    __main__.main([])
    listed = capsys.readouterr().out
    assert all(name in listed for name in studies.names())
    out = tmp_path / "deep" / "folder"
    __main__.main(["frames", "--quick", "-o", str(out)])
    printed, err = capsys.readouterr()
    assert re.search(r"verdict: \w+", printed)
    assert "frames" in err
    assert {p.name for p in out.iterdir()} == {"frames.csv", "frames.png"}
    with pytest.raises(SystemExit):
        __main__.main(["nothing"])


def test_no_verdict_where_repeats_spread(toy, monkeypatch):
    taken = iter([1.0, 1.1, 3.0, 1.0, 2.0, 2.0, 2.0, 2.0, 1.2])
    clock = (t for each in taken for t in (0.0, each))
    monkeypatch.setattr(studies.time, "process_time", lambda: next(clock))

    def timed(quick):
        def step():
            seconds = studies.take_turns({"rough": lambda: None}, 3)["rough"]
            return [Row("rough", 1, 1e-3, seconds)]

        return [step] if quick else [step, step]

    study = dataclasses.replace(toy, steps=timed)
    assert studies.run("toy", study, quick=True).verdict == "at 1/255 use rough, 1"
    result = studies.run("toy", study, quick=True)
    assert result.verdict.startswith("none, because repeats of one time differ by 20%")
    assert result.rows[0].cost == 1.0
    assert next(taken, None) is None


def test_spread_of_repeats():
    assert studies.spread([2.0, 5.0, 1.0]) == 1.0
    assert studies.spread([1.0, 1.0]) == 0.0
    assert studies.spread([0.0, 0.0, 0.0]) == 0.0
