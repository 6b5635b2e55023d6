"""The first picture on files that others made: those that need no download."""

from __future__ import annotations

import pytest
import real_files


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("real")
    real_files.made(folder / "made")
    return folder


@pytest.mark.opengl
@pytest.mark.parametrize(
    "real",
    [real for real in real_files.FILES if real.package in real_files.HERE],
    ids=lambda real: f"{real.path.rpartition('/')[2]} {real.command.partition(' ')[0]}",
)
def test_the_first_command_shows_the_file(real, folder, tmp_path):
    path = real_files.place(real, folder)
    if path is None:
        pytest.skip(f"{real.package} is not installed")
    code, said = real_files.run(real, path, tmp_path / "a.png")
    assert code == 0, said
    share, _ = real_files.share_of_mesh(tmp_path / "a.png")
    assert 0.03 < share < 0.9


def test_there_are_40_files_of_25_formats():
    ends = {real.path.rpartition("/")[2].partition(".")[2] for real in real_files.FILES}
    assert len({(real.path, real.command) for real in real_files.FILES}) >= 40
    assert len(ends) >= 25
