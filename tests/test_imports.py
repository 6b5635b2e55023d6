"""What an import loads: the mathematics needs no PyVista, and the package is quick to import."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import subprocess
import sys

import pytest

import vizlight

PROBE = """
import sys
{code}
heavy = {{"pyvista", "vtk", "vtkmodules", "scipy", "rich"}}
print(sorted({{name.partition(".")[0] for name in sys.modules}} & heavy))
"""


def loaded(code):
    run = subprocess.run(
        [sys.executable, "-c", PROBE.format(code=code)], capture_output=True, text=True, check=True
    )
    return run.stdout.strip()


@pytest.mark.parametrize(
    "module",
    [
        "vizlight.model",
        "vizlight.model.frames",
        "vizlight.model.reflection",
        "vizlight.model.brightness",
        "vizlight.model.cylinder",
        "vizlight.model.half_vector",
        "vizlight.model.highlights",
        "vizlight.model.falloff",
        "vizlight.geometry.manifolds",
        "vizlight.geometry.projection",
        "vizlight.geometry.slices",
        "vizlight.geometry.relief",
        "vizlight.geometry.isoluminance",
        "vizlight.geometry.solids",
        "vizlight.engine",
        "vizlight.studies",
        "vizlight.scene",
    ],
)
def test_mathematics_and_engine_load_no_pyvista(module):
    assert "pyvista" not in loaded(f"import {module}")
    assert "vtk" not in loaded(f"import {module}")


def test_the_probe_can_fail():
    assert "pyvista" in loaded("import vizlight.filters")


def test_import_of_the_package_loads_next_to_nothing():
    assert loaded("import vizlight") == "[]"
    assert loaded("import vizlight; vizlight.__version__; dir(vizlight)") == "[]"
    assert "pyvista" not in loaded("import vizlight; vizlight.Light(direction=(0, 0, 1))")


def test_every_public_name_is_there():
    import vizlight

    for name in (*vizlight.__all__, "__version__", "engine", "model", "render"):
        assert getattr(vizlight, name) is not None
    assert set(vizlight.__all__) <= set(dir(vizlight))
    with pytest.raises(AttributeError, match="no attribute 'illuminated'"):
        vizlight.illuminated  # noqa: B018


#: The command line and what it runs; the plan's names are the engine's.
NOT_FOR_IMPORT = ("cli", "demo", "doctor", "plan")


def public_modules():
    found = (name for _, name, _ in pkgutil.walk_packages(vizlight.__path__, "vizlight."))
    for name in found:
        inner = name.split(".")[1:]
        studies = inner[0] == "studies" and len(inner) > 1
        if not any(part[0] == "_" or part in NOT_FOR_IMPORT for part in inner) and not studies:
            yield name


@pytest.mark.parametrize("name", sorted(public_modules()))
def test_public_names_are_declared_and_described(name):
    module = importlib.import_module(name)
    if not module.__file__.endswith("__init__.py") or hasattr(module, "__all__"):
        assert sorted(module.__all__) == sorted(set(module.__all__))
    for public in getattr(module, "__all__", ()):
        value = getattr(module, public)
        if inspect.isfunction(value) or inspect.isclass(value):
            assert inspect.getdoc(value), public
        if inspect.isfunction(value) and inspect.signature(value).parameters:
            assert "Parameters\n---" in inspect.getdoc(value), public
