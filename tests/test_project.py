"""What is imported is declared in pyproject.toml, and what is declared there is used."""

from __future__ import annotations

import ast
import re
import sys
from pathlib import Path

import pytest

import vizlight
from vizlight import doctor

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
#: Packages whose modules have another name.
MODULES = {"pillow": {"PIL"}, "trx-python": {"trx"}, "vtk": {"vtk", "vtkmodules"}}
#: Modules of packages that a declared package brings, and that package.
BROUGHT = {"docutils": "sphinx", "nbformat": "nbclient", "websocket": "pyvista[jupyter]"}
#: Declared packages that no file imports, and what uses them.
REASONS = {
    "check-jsonschema": "command: checks .github/workflows",
    "check-wheel-contents": "command",
    "codespell": "command",
    "distributed": "what vizlight light --scheduler connects to, a client that users bring",
    "hatchling": "builds what tests/test_release.py inspects, in a second process",
    "ipykernel": "kernel of the notebooks that tests/test_gallery.py runs",
    "mypy": "command",
    "netcdf4": "xarray reads netCDF 4 by it",
    "nest-asyncio2": "pyvista imports it to export scenes of the pages",
    "numpydoc": "extension of Sphinx, named in gallery/pages/conf.py",
    "pre-commit": "command",
    "pre-commit-hooks": "commands that .pre-commit-config.yaml names",
    "pydata-sphinx-theme": "theme of Sphinx, named in gallery/pages/conf.py",
    "pytest-pyvista": "plugin of pytest: the fixture that compares pictures",
    "pytest-xdist": "plugin of pytest: its option -n",
    "ruff": "command",
    "scipy-stubs": "types of SciPy, which mypy reads",
    "sphinx-design": "extension of Sphinx, named in gallery/pages/conf.py",
    "twine": "command",
    "vulture": "command",
    "uv": "command: installs the lowest versions",
    "tomli": "read above on Python 3.10 only",
}
#: Extras whose packages the files of a folder may import, besides the dependencies.
ALLOWED = {
    "vizlight": ["fast", "formats", "maps", "movie", "rays", "scale", "solids", "tracts", "test"],
    "tests": ["test", "docs", "tracts", "formats", "maps", "scale"],
    "gallery": ["docs", "scale"],
}


def declared(*extras):
    """Return the names of the dependencies, and of the packages of the extras."""
    names = set()
    for line in [*PROJECT["dependencies"], *(line for e in extras for line in EXTRAS[e])]:
        name, own = re.match(r"([\w-]+)(?:\[([\w,]+)\])?", line).groups()
        names |= declared(*own.split(",")) if name == "vizlight" else {name.replace("_", "-")}
    return names


def modules(packages):
    """Return the names under which packages are imported."""
    return {m for p in packages for m in MODULES.get(p, {p.replace("-", "_")})}


def only_for_types(tree):
    """Return the nodes below ``if TYPE_CHECKING``."""
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING"):
            found |= {inner for statement in node.body for inner in ast.walk(statement)}
    return found


def third_party(text):
    """Yield the modules of other packages that a file imports, and whether for types only."""
    tree = ast.parse(text)
    types = only_for_types(tree)
    for node in ast.walk(tree):
        names = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [node.module]
        for name in names:
            top = name.partition(".")[0]
            if top not in sys.stdlib_module_names | {"vizlight"}:
                yield top, node in types


def sources(folder):
    """Return the text of each file of a folder that Python reads."""
    paths = [p for p in (ROOT / folder).rglob("*.py*") if p.suffix in {".py", ".pyi"}]
    return {path.relative_to(ROOT): path.read_text(encoding="utf-8") for path in paths}


def imported(folder):
    """Return the modules that the files of a folder import."""
    return {module for text in sources(folder).values() for module, _ in third_party(text)}


def undeclared(files, known):
    """Return the files and modules that are imported without being known."""
    return [
        f"{path}: {module}"
        for path, text in files.items()
        for module, types in third_party(text)
        # The standard library's newest types; mypy brings the package.
        if module not in known and not (types and module == "typing_extensions")
    ]


@pytest.mark.parametrize("folder", ALLOWED)
def test_what_is_imported_is_declared(folder):
    files = sources(folder)
    assert files
    known = modules(declared(*ALLOWED[folder])) | {"paraview"}  # which only its own Python has
    if folder != "vizlight":
        # A folder's own files and packages; the pages use the stability suite of the tests, and
        # ParaView runs its scripts of the peers.
        packages = {path.parent.name for path in files}
        known |= {path.stem for path in files} | packages | set(BROUGHT)
        known |= {"stability", "paraview", "tomllib"}  # the last is Python's since 3.11
    assert undeclared(files, known) == []


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("import requests.sessions", ["a.py: requests"]),
        ("def f():\n    from yaml import load", ["a.py: yaml"]),
        ("from typing_extensions import Self", ["a.py: typing_extensions"]),
        ("if TYPE_CHECKING:\n    from typing_extensions import Self", []),
        ("if TYPE_CHECKING:\n    import yaml", ["a.py: yaml"]),
        ("import os, numpy", []),
    ],
)
def test_an_undeclared_import_is_found(text, found):
    assert undeclared({"a.py": text}, modules(declared())) == found


def test_what_is_declared_is_used():
    found = set().union(*map(imported, ALLOWED))
    unused = {package for package in declared(*EXTRAS) if not modules({package}) & found}
    # tomli is imported where this test runs on Python 3.10.
    assert unused | {"tomli"} == set(REASONS)


def test_every_dependency_is_imported_by_the_package():
    found = imported("vizlight")
    assert [p for p in sorted(declared()) if not modules({p}) & found] == []


def test_the_doctor_names_the_packages_and_extras_that_are_declared():
    assert set(doctor.PACKAGES) == declared() | {"vizlight"}
    for _, package, extra in doctor.OPTIONAL:
        # The extra asks for imageio[ffmpeg], which brings imageio-ffmpeg.
        assert package.removesuffix("-ffmpeg") in declared(extra)
    assert {extra for _, _, extra in doctor.OPTIONAL} == set(EXTRAS) - {"all"}


def test_linters_are_for_developers_only():
    assert not declared("test", "docs", "movie", "rays", "all") & {"ruff", "mypy", "pre-commit"}
    assert declared("all") >= declared("test", "docs", "movie", "rays")
    assert declared("dev") >= declared("test") | {"ruff", "mypy", "pre-commit"}


def test_the_version_is_in_one_place():
    assert PROJECT["dynamic"] == ["version"]
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"\n## [{vizlight.__version__}]" in changes
    assert "version:" not in re.sub(
        "cff-version:", "", (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    )


def test_every_licence_is_in_the_folder_of_the_data():
    """The licences that the metadata names are those of the files that the wheel holds."""
    named = {"MIT", "BSD-3-Clause", "Apache-2.0", "LicenseRef-matplotlib", "LicenseRef-MNI"}
    assert set(PROJECT["license"].split(" AND ")) == named
    files = [path for pattern in PROJECT["license-files"] for path in ROOT.glob(pattern)]
    assert len(files) == 7
    readme = (ROOT / "datasets" / "README.md").read_text(encoding="utf-8")
    assert all(f"`{path.name}`" in readme for path in files)
