"""What is imported is declared in pyproject.toml, and what is declared there is used."""

import ast
import re
import sys
from collections import Counter
from functools import cache
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
    "h5py": "meshio reads .med by it",
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
#: Names of locals and parameters that tell how a value came about, not what it is, and the largest
#: share of them in the package, in per cent.
ORIGINS = {"found", "own", "given", "made", "one", "told", "known", "asked"}
MOST_ORIGINS = 0.5
#: Largest number of words that make a reader stumble, per 10,000 words of docstrings.
STUMBLES = {"what": 6, "whose": 4, "there": 4}
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


def third_party(text):
    """Return the modules of other packages that lines of a text import."""
    lines = re.findall(r"^ *(?:from ([\w.]+) import|import (\w[\w., ]*))", text, re.MULTILINE)
    names = [name.split()[0] for lists in lines for name in ",".join(lists).split(",") if name]
    return {name.partition(".")[0] for name in names} - sys.stdlib_module_names - {"vizlight"}


@cache
def imported(folder):
    """Return the modules that each file of a folder imports."""
    paths = (ROOT / folder).rglob("*.py")
    return {path: third_party(path.read_text(encoding="utf-8")) for path in paths}


@pytest.mark.parametrize("folder", ALLOWED)
def test_what_is_imported_is_declared(folder):
    files = imported(folder)
    # Only ParaView's own Python has its package and our file; PyVista brings the newest types.
    known = modules(declared(*ALLOWED[folder])) | {"paraview", "vizlight_eye", "typing_extensions"}
    if folder != "vizlight":
        # A folder's own files and packages; the pages use the stability suite of the tests.
        known |= {path.stem for path in files} | {path.parent.name for path in files}
        # Python has tomllib since 3.11, and a test writes the module of the last name.
        known |= {*BROUGHT, "stability", "tomllib", "doubled"}
    assert {path.name: found - known for path, found in files.items() if found - known} == {}


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("import requests.sessions", {"requests"}),
        ("def f():\n    from yaml import load", {"yaml"}),
        ("if TYPE_CHECKING:\n    import yaml", {"yaml"}),
        ("import os, vizlight", set()),
    ],
)
def test_an_undeclared_import_is_found(text, found):
    assert third_party(text) == found


def test_what_is_declared_is_used():
    by_folder = {folder: set().union(*imported(folder).values()) for folder in ALLOWED}
    every = set().union(*by_folder.values())
    unused = {package for package in declared(*EXTRAS) if not modules({package}) & every}
    # tomli is imported where this test runs on Python 3.10.
    assert unused | {"tomli"} == set(REASONS)
    assert [p for p in declared() if not modules({p}) & by_folder["vizlight"]] == []


def test_the_doctor_names_the_packages_and_extras_that_are_declared():
    assert set(doctor.PACKAGES) == declared() | {"vizlight"}
    for _, package, extra in doctor.OPTIONAL:
        # The extra asks for imageio[ffmpeg], which brings imageio-ffmpeg.
        assert package.removesuffix("-ffmpeg") in declared(extra)
    assert {extra for _, _, extra in doctor.OPTIONAL} == set(EXTRAS) - {"all"}


def test_linters_are_for_developers_only():
    assert not declared("test", "docs", "all") & {"ruff", "mypy", "pre-commit"}
    assert declared("all") >= declared("test", "docs", "movie", "rays")


def test_the_version_is_in_one_place():
    assert PROJECT["dynamic"] == ["version"]
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"\n## [{vizlight.__version__}]" in changes
    assert "\nversion:" not in (ROOT / "CITATION.cff").read_text(encoding="utf-8")


def test_every_licence_is_in_the_folder_of_the_data():
    """The licences that the metadata names are those of the files that the wheel holds."""
    named = {"MIT", "BSD-3-Clause", "Apache-2.0", "LicenseRef-matplotlib", "LicenseRef-MNI"}
    assert set(PROJECT["license"].split(" AND ")) == named
    files = [path for pattern in PROJECT["license-files"] for path in ROOT.glob(pattern)]
    assert len(files) == 7
    readme = (ROOT / "datasets" / "README.md").read_text(encoding="utf-8")
    assert all(f"`{path.name}`" in readme for path in files)


def local_names(function):
    """Return the names that a function binds, without those of functions inside of it."""
    names = {node.arg for node in ast.walk(function.args) if isinstance(node, ast.arg)}
    left = [*function.body] if isinstance(function.body, list) else [function.body]
    while left:
        node = left.pop()
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        if not isinstance(node, (*FUNCTIONS, ast.ClassDef)):
            left += ast.iter_child_nodes(node)
    return names


FUNCTIONS = ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda


@pytest.fixture(scope="module")
def nodes():
    """Return all nodes of the syntax trees of the package."""
    texts = [path.read_text(encoding="utf-8") for path in (ROOT / "vizlight").rglob("*.py")]
    return [node for text in texts for node in ast.walk(ast.parse(text))]


def test_a_local_is_of_its_own_function():
    outer = ast.parse("def f(a, *b):\n    c = [d for d in a]\n    def g(e): h = e").body[0]
    assert local_names(outer) == {"a", "b", "c", "d"}


def test_names_say_what_a_value_is(nodes):
    names = [name for node in nodes if isinstance(node, FUNCTIONS) for name in local_names(node)]
    assert 100 * sum(name in ORIGINS for name in names) <= MOST_ORIGINS * len(names)


def test_docstrings_are_read_once(nodes):
    kinds = ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Module
    texts = [ast.get_docstring(node) or "" for node in nodes if isinstance(node, kinds)]
    words = re.findall(r"[a-z']+", " ".join(texts).lower())
    count = Counter(words)
    shares = {word: 10_000 * count[word] / len(words) for word in STUMBLES}
    assert {word: share for word, share in shares.items() if share > STUMBLES[word]} == {}


def test_a_class_name_stands_for_one_thing(nodes):
    names = Counter(node.name for node in nodes if isinstance(node, ast.ClassDef))
    assert [name for name, count in names.items() if count > 1] == []
