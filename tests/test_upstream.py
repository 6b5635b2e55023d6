"""The patches for PyVista apply to the one that is installed, and their tests pass there."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import pyvista as pv

PATCHES = sorted((Path(__file__).parents[1] / "gallery/pages/upstream").glob("*.patch"))


@pytest.mark.slow
@pytest.mark.opengl
@pytest.mark.skipif(shutil.which("git") is None, reason="git is not installed")
@pytest.mark.skipif(pv.version_info[:2] != (0, 49), reason="the patches are for PyVista 0.49")
def test_the_patches_apply_and_their_tests_pass(tmp_path):
    home = Path(pv.__file__).parent
    shutil.copytree(home, tmp_path / "pyvista", ignore=shutil.ignore_patterns("__pycache__"))
    # Of no repository around the folder.
    environment = os.environ | {"GIT_CEILING_DIRECTORIES": str(tmp_path.parent)}
    environment |= {"PYTHONPATH": str(tmp_path), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    assert len(PATCHES) == 4
    for check in (["--check"], []):  # each by itself, then all of them
        for patch in PATCHES:
            command = ["git", "apply", *check, str(patch)]
            subprocess.run(command, cwd=tmp_path, env=environment, check=True)
    found = [sys.executable, "-c", "import pyvista; print(pyvista.__file__)"]
    run = subprocess.run(found, cwd=tmp_path, env=environment, capture_output=True, check=True)
    assert run.stdout.decode().strip() == str(tmp_path / "pyvista" / "__init__.py")
    tests = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "tests"]
    run = subprocess.run(tests, cwd=tmp_path, env=environment, capture_output=True, check=False)
    assert run.returncode == 0, run.stdout.decode()
    assert b"10 passed" in run.stdout
