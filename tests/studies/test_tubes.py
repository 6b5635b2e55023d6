"""The study measures what it says; no time is asserted."""

from __future__ import annotations

import pytest

from vizlight.studies import tubes

pytestmark = pytest.mark.opengl


def test_tubes_take_twenty_times_the_points():
    (lines, tube), meshes, _ = tubes.measure(10, repeats=1)
    assert 15 * lines.points < tube.points < 25 * lines.points
    assert tube.megabytes > 10 * lines.megabytes
    assert min(lines.build, lines.draw, tube.build, tube.draw) > 0
    assert all("luminance" in mesh.point_data for mesh in meshes)


def test_table_and_picture(tmp_path, capsys):
    tubes.main(5, picture=tmp_path / "both.png")
    assert "lit lines" in capsys.readouterr().out
    assert (tmp_path / "both.png").stat().st_size > 1000


def test_command_line(capsys):
    with pytest.raises(SystemExit) as stop:
        tubes.cyclopts.App(default_command=tubes.main, result_action="return_value")(["--bogus"])
    assert stop.value.code
    assert "bogus" in "".join(capsys.readouterr())
