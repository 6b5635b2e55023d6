"""Form of the studies: found by name, run, shown as table, CSV file and figure."""

import csv
import itertools
import time
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv

import studies
from studies import Curve, Result, Row, Study, __main__, _figure


def toy(rows=(), **options):
    rows = list(rows) or [Row("rough", n, n**-2.0, 3.0 * n, {"memory": n}) for n in (10, 20)]
    study = Study(
        approximates="a toy", reference="itself", parameter="points", error="error", cost="ns",
        steps=lambda quick: [lambda: rows[:1]] * (2 - quick), **options,
    )  # fmt: skip
    return Result("toy", study, rows)


@pytest.mark.parametrize("name", studies.names())
def test_every_study_has_a_form_and_a_test(name):
    study = studies.load(name)
    assert study.approximates
    assert study.reference
    assert 0 < len(study.steps(True)) <= len(study.steps(False))
    assert f"{name}." in Path(__file__).with_name("test_rows.py").read_text("utf-8")


def test_run():
    study = toy().study
    assert [len(studies.run("toy", study, quick=quick).rows) for quick in (True, False)] == [1, 2]


def test_csv_keeps_all_digits(tmp_path):
    path = toy([*toy().rows, Row("exact", "none", 0.0, 500.0)]).write_csv(tmp_path / "toy.csv")
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["method", "points", "error", "ns", "memory"]
    assert float(rows[1][2]) == 1 / 400
    assert rows[-1] == ["exact", "none", "0.0", "500.0", ""]


def test_the_figure_shows_the_curves_it_is_asked_for(tmp_path):
    """Colour by name, line style by kind; logarithmic axes show no zeros."""
    rows = [Row(f"{a}, {b}", n, 1 / n, n) for n in (1, 2) for a in "ab" for b in "cd"]
    result = toy(
        [*rows, Row("hidden", 1, 1.0, 1.0), Row("exact, e", 1, 0.0, 5.0)], diagonal="x = y",
        curve=lambda row: None if row.way == "hidden" else Curve(*row.way.split(", ")),
    )  # fmt: skip
    (axes,) = _figure.draw(result).axes
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    lines = {line.get_label(): line for line in axes.lines}
    assert set(lines) == {"a, c", "a, d", "b, c", "b, d", "x = y"}
    assert lines["a, c"].get_color() == lines["a, d"].get_color() != lines["b, c"].get_color()
    assert lines["a, c"].get_linestyle() == lines["b, c"].get_linestyle() == "-"
    assert lines["a, d"].get_linestyle() == "--"
    assert pv.read(result.draw(tmp_path / "toy.png")).dimensions == (960, 720, 1)


@pytest.mark.slow
def test_command_line(tmp_path, capsys):
    __main__.main([])
    listed = capsys.readouterr().out
    assert all(f"{name}: " in listed for name in studies.names())
    out = tmp_path / "deep" / "folder"
    __main__.main(["isoluminance", "--quick", "-o", str(out)])
    assert "contours of the light" in capsys.readouterr().out
    assert {p.name for p in out.iterdir()} == {"isoluminance.csv", "isoluminance.png"}
    with pytest.raises(SystemExit):
        __main__.main(["nothing"])


def test_peak_memory_counts_numpy():
    assert studies.peak_memory(lambda: np.ones(100_000)) >= 800_000


def test_turns(monkeypatch):
    """The first time, which is slower, does not count."""
    clock = itertools.chain.from_iterable((0.0, each) for each in (9.0, 1.0, 2.0, 3.0, 4.0, 0.5))
    monkeypatch.setattr(time, "process_time", lambda: next(clock))
    seen = []
    ways = {name: lambda name=name: seen.append(name) for name in "ab"}
    assert studies.take_turns(ways, 3) == {"a": 2.0, "b": 0.5}
    assert seen == ["a", "b"] * 3
