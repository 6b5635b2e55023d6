"""What is released: the same bytes from every build, all that runs, and nothing twice."""

import os
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from test_project import PROJECT

import vizlight

ROOT = Path(__file__).parents[1]
INFO = f"vizlight-{vizlight.__version__}.dist-info"


def build(source, target):
    """Build the source distribution and the wheel of a folder; return their paths."""
    code = "from hatchling.build import build_sdist, build_wheel; import sys"
    code += "; build_sdist(sys.argv[1]); build_wheel(sys.argv[1])"
    # A time of its own would be the one of the commit, where a packager sets it.
    env = {k: v for k, v in os.environ.items() if k != "SOURCE_DATE_EPOCH"}
    command = [sys.executable, "-c", code, str(target)]
    subprocess.run(command, cwd=source, env=env, capture_output=True, check=True)
    (sdist,), (wheel,) = target.glob("*.tar.gz"), target.glob("*.whl")
    return sdist, wheel


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """The two distributions, built here."""
    pytest.importorskip("hatchling", reason="pip install 'vizlight[dev]' for hatchling")
    return build(ROOT, tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="module")
def wheel(built):
    return zipfile.ZipFile(built[1])


@pytest.mark.slow
def test_a_build_of_the_source_distribution_has_the_same_bytes(built, tmp_path):
    """Built elsewhere, later, from files of another age and other modes, without git."""
    with tarfile.open(built[0]) as archive:
        archive.extractall(tmp_path)
    (source,) = tmp_path.iterdir()
    for path in source.rglob("*"):
        os.utime(path, (1e9, 1e9))
        path.chmod(path.stat().st_mode & 0o700)
    again = build(source, tmp_path / "dist")
    for first, second in zip(built, again, strict=True):
        assert first.read_bytes() == second.read_bytes(), first.name


def test_the_wheel_holds_what_runs(wheel):
    names = set(wheel.namelist())
    data = {f"vizlight/datasets/{p.name}" for p in (ROOT / "datasets").glob("*.vt?")}
    web = {f"vizlight/draw/web/{name}" for name in ("gl.js", "app.js", "page.css", "page.html")}
    shaders = {f"vizlight/draw/{name}.glsl" for name in ("power", "shadow")}
    assert data | web | shaders | {"vizlight/py.typed"} <= names
    code = {p.relative_to(ROOT).as_posix() for p in (ROOT / "vizlight").rglob("*.py")}
    assert {name for name in names if name.endswith(".py")} == code
    assert {name.partition("/")[0] for name in names} == {"vizlight", INFO}


def test_the_wheel_is_small_and_holds_nothing_twice(built, wheel):
    assert built[1].stat().st_size < 6e6
    full = [name for name in wheel.namelist() if wheel.getinfo(name).file_size]
    assert len({wheel.read(name) for name in full}) == len(full)


def test_the_metadata_are_complete(wheel):
    for name in ("LICENSE", "datasets/LICENSE-dipy.txt", "datasets/LICENSE-mayavi.txt"):
        assert f"{INFO}/licenses/{name}" in wheel.namelist()
    head, _, _ = wheel.read(f"{INFO}/METADATA").decode().partition("\n\n")
    fields = {line.partition(": ")[0] for line in head.splitlines()}
    assert {"Summary", "Author", "Keywords", "Classifier", "Requires-Python"} <= fields
    assert f"License-Expression: {PROJECT['license']}" in head.splitlines()
    assert "Description-Content-Type: text/markdown" in head.splitlines()
    urls = set(re.findall(r"^Project-URL: (\w+), https://", head, re.MULTILINE))
    assert urls >= {"Documentation", "Source", "Issues", "Changelog"}


def test_the_recipe_for_conda_says_what_the_metadata_say():
    """Version, dependencies and licences are those of pyproject.toml."""
    text = (ROOT / "conda" / "recipe.yaml").read_text(encoding="utf-8")

    def field(name):
        (found,) = re.findall(rf'^ +{name}: "?([^"\n]+)"?$', text, re.MULTILINE)
        return found

    def rows(name):
        (found,) = re.findall(rf"^  {name}:\n((?:    - .*\n)+)", text, re.MULTILINE)
        return {line.removeprefix("    - ").replace(" ", "") for line in found.splitlines()}

    assert re.findall(r'^  version: "(.*)"$', text, re.MULTILINE) == [vizlight.__version__]
    assert f">={field('python_min')}" == PROJECT["requires-python"]
    wanted = set(PROJECT["dependencies"])
    assert rows("run") == wanted | {"python>=${{python_min}}"}
    assert field("license") == PROJECT["license"]
    assert field("summary") == PROJECT["description"]
    files = {path for pattern in PROJECT["license-files"] for path in ROOT.glob(pattern)}
    assert {ROOT / name for name in rows("license_file")} == files
