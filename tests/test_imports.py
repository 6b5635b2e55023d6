"""What an import loads: the mathematics needs no PyVista, and the package is quick to import."""

import ast
import importlib
import inspect
import operator
import re
import subprocess
import sys
from pathlib import Path

import pytest
import pyvista as pv

import vizlight

ROOT = Path(vizlight.__file__).parent
HEAVY = ("pyvista", "vtk", "scipy", "rich", "vizlight.verify")
#: Runs lines of code in one process and prints what is loaded after each.
PROBE = """
import sys
for line in {lines}:
    exec(line)
    print(*(name for name in sys.modules if name.startswith({heavy})))
"""


def loaded(*lines):
    """Return what is loaded after each line of code, in a process of its own."""
    code = PROBE.format(lines=lines, heavy=HEAVY)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    found = [set(line.split()) for line in run.stdout.splitlines()]
    assert len(found) == len(lines)
    return found


def module_of(path):
    """Return the dotted name of a file of the package."""
    parts = path.relative_to(ROOT.parent).with_suffix("").parts
    return ".".join(parts).removesuffix(".__init__")


def test_filters_load_no_part_of_scipy_that_few_of_them_need():
    """They take longer to load than all filters."""
    names = sorted(path.stem for path in (ROOT / "filters").glob("[a-z]*.py"))
    found = loaded(f"from vizlight.filters import {', '.join(names)}")[0]
    parts = ("interpolate", "ndimage", "optimize", "sparse", "spatial", "special")
    assert not {f"scipy.{name}" for name in parts} & found


def test_mathematics_and_engine_load_no_pyvista_and_no_report():
    folders = [ROOT / name for name in ("shading", "scene", "model", "geometry")]
    modules = [module_of(path) for folder in folders for path in folder.rglob("*.py")]
    for module, names in zip(modules, loaded(*(f"import {m}" for m in modules)), strict=True):
        assert not names & {"pyvista", "vtk", "vtkmodules"}, module
        assert not {name for name in names if "verify" in name}, module


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("engine", "shading.engine"),
        ("movie", "draw.movie"),
        ("paraview", "draw.paraview"),
        ("render", "draw.render"),
        ("testing", "draw.testing"),
        ("geometry.isoluminance", "geometry.contours.isoluminance"),
        ("geometry.manifolds", "geometry.nspace.manifolds"),
        ("geometry.relief", "geometry.relief"),
        ("geometry.sun", "geometry.relief.sun"),
    ],
)
def test_attributes_of_the_package_are_the_modules(name, place):
    found = operator.attrgetter(name)(vizlight)
    assert found is sys.modules[f"vizlight.{place}"]
    owner, _, own = f"vizlight.{name}".rpartition(".")
    assert own in dir(sys.modules[owner])


def test_a_picture_loads_nothing_that_it_does_not_need(tmp_path):
    """Parts of SciPy, and libraries of VTK that few meshes need, take a tenth of a small picture's
    time to load; figures of matplotlib, for charts, half of that of PyVista's plotting.
    """
    path = tmp_path / "mesh.vtp"
    pv.Plane(i_resolution=9, j_resolution=9).elevation().save(path)
    picture = tmp_path / "x.png"
    few = "scipy.", "numba", "xarray", "vtkmodules.vtkIOParallel", "vtkmodules.vtkIOXdmf2"
    few += ("vtkmodules.vtkFiltersExtraction", "vtkmodules.vtkFiltersPoints", "xml.sax")
    few += ("matplotlib.figure", "matplotlib.text")
    code = f"""
import sys
from vizlight import __main__
sys.argv = ["vizlight", {str(path)!r}, "-o", {str(picture)!r}]
__main__._command_line()
print("LOADED", *(name for name in sys.modules if name.startswith({few})))
import matplotlib.pyplot as late
import pyvista
chart = pyvista.ChartMPL()
import matplotlib.pyplot as plt
from matplotlib.backends import backend_agg
from pyvista.plotting import colors
print("LOADED", late.Figure is plt.Figure is colors.plt.Figure, hasattr(late, "__file__"))
print("LOADED", isinstance(chart._canvas, backend_agg.FigureCanvasAgg))
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert picture.exists()
    loaded, *figures = [line for line in run.stdout.splitlines() if line.startswith("LOADED")]
    # SciPy itself loads its parts when they are used.
    private = ("LOADED", "scipy._", "scipy.version")
    assert [name for name in loaded.split() if not name.startswith(private)] == []
    assert figures == ["LOADED True False", "LOADED True"]


def test_the_probe_can_fail():
    (after,) = loaded("import vizlight.filters.isoluminance")
    assert {"pyvista", "vtkmodules", "vizlight.verify.between"} <= after


def test_import_of_the_package_loads_next_to_nothing():
    bare, listed, light = loaded(
        "import vizlight",
        "vizlight.__version__; dir(vizlight)",
        "vizlight.Light(direction=(0, 0, 1))",
    )
    assert bare == listed == set()
    assert "pyvista" not in light


def test_what_types_cannot_say_is_named():
    """``Any`` has a name that says why, and none of the mathematics needs one."""
    found = set()
    for path in sorted(ROOT.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "Any" not in text and path.parent.name != "model":
            continue
        tree = ast.parse(text)
        names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
        quoted = {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
        if "Any" in names | quoted:
            found.add(path.relative_to(ROOT).as_posix())
        assert path.parent.name != "model" or not names & {"Foreign", "Given", "Keywords"}
    assert found == {"_types.py"}


def test_every_public_name_is_there():
    for name in (*vizlight.__all__, "__version__", "engine", "model", "render"):
        assert getattr(vizlight, name) is not None
    assert set(vizlight.__all__) <= set(dir(vizlight))
    with pytest.raises(AttributeError, match="no attribute 'illuminated'"):
        vizlight.illuminated  # noqa: B018
    with pytest.raises(AttributeError, match="'hillshade': take relief_shadow"):
        vizlight.hillshade  # noqa: B018


API = Path(__file__).parents[1] / "gallery" / "pages" / "api.rst"


def public_modules():
    """Yield the modules of the pages, and any other that declares public names."""
    yield from re.findall(r"^   (vizlight[.\w]*)$", API.read_text(encoding="utf-8"), re.MULTILINE)
    for path in ROOT.rglob("*.py"):
        if re.search(r"^__all__", path.read_text(encoding="utf-8"), re.MULTILINE):
            yield module_of(path)


@pytest.mark.parametrize("name", sorted(set(public_modules())))
def test_public_names_are_declared_and_described(name):
    module = importlib.import_module(name)
    assert module.__doc__
    assert sorted(module.__all__) == sorted(set(module.__all__))
    for public in module.__all__:
        value = getattr(module, public)
        if inspect.isfunction(value) or inspect.isclass(value):
            assert inspect.getdoc(value), public
        if inspect.isfunction(value) and inspect.signature(value).parameters:
            assert "Parameters\n---" in inspect.getdoc(value), public


@pytest.mark.slow
def test_windows_of_qt_find_the_component():
    """Their class looks attributes up by itself, so that it never asks PyVista for components."""
    lines = [
        "sys.modules['pyvistaqt'] = type(sys)('pyvistaqt')",
        "import pyvista, vizlight",
        "assert 'vizlight' in vars(pyvista.BasePlotter)",
    ]
    for order in (lines, [lines[1], lines[0], "vizlight.Scene", lines[2]]):
        subprocess.run([sys.executable, "-c", "\n".join(["import sys", *order])], check=True)
