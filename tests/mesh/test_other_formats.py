"""Formats that no reader takes are known before any reader is loaded."""

import subprocess
import sys

import pytest
from pyvista.core.utilities import reader

from vizlight.mesh import foreign_files, other_formats


def test_no_reader_takes_them():
    ends = {end for group in other_formats.WAYS for end in group}
    assert ends.isdisjoint({*reader.CLASS_READERS, *foreign_files.PACKAGES})


def test_they_are_refused_before_a_reader_is_loaded(tmp_path):
    path = tmp_path / "walk.xtc"
    path.write_bytes(b"something")
    with pytest.raises(ValueError, match=r"no reader takes '.xtc' files; write a state of the mol"):
        other_formats.check(path)
    code = (
        "import sys; from vizlight import cli; code = cli.main([sys.argv[1]]); "
        "sys.exit(code if 'pyvista' not in sys.modules else 1)"
    )
    command = [sys.executable, "-c", code, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2, done.stderr
    assert "as .pdb, .cif or .xyz" in done.stderr


def test_grib_of_any_name_and_other_files_are_left_to_readers(tmp_path):
    for name, data in (("a.txt", b"GRIB 1"), ("b.stl", b"solid"), ("c.gz", b"x")):
        (tmp_path / name).write_bytes(data)
        other_formats.check(tmp_path / name)
    other_formats.check(tmp_path / "absent.xtc")
