"""Imports point one way: tiers, no circles, no private name of another package."""

import ast
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import vizlight

ROOT = Path(vizlight.__file__).parent
#: Each tier imports only those before it and itself; a folder or a file at the top stands for all
#: that it holds.
TIERS = [
    {
        "_check",
        "_cache",
        "_compiled",
        "_pool",
        "_progress",
        "_questions",
        "_supervise",
        "_trials",
        "_types",
        "_version",
        "_words",
        "maps",
    },
    {"model"},
    {"geometry"},
    {"scene"},
    {"shading"},
    {"verify"},
    {"vtk"},
    {"mesh", "data"},
    {"reading"},
    {"writing"},
    {"files", "filters"},
    {"draw", "pieces"},
    {"observers"},
    {"looks"},
    {"accessor", "cartography", "demo", "doctor", "presets", "xarray"},
    {"cli"},
    {"__main__"},
]
#: Names that the package gives by itself are those of all tiers: only what stands last uses them.
USES_ALL = {"accessor", "cli", "demo", "doctor", "looks", "xarray"}
TIER = {part: i for i, tier in enumerate(TIERS) for part in tier}


def sources():
    """Return the text of each module by its dotted name."""
    found = {}
    for path in ROOT.rglob("*.py"):
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        found[".".join(parts).removesuffix(".__init__")] = path.read_text(encoding="utf-8")
    return found


@cache
def imports(text):
    """Return what a module imports, also for types and within functions: module and name."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            found += [(alias.name, "") for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            found += [("." * node.level + (node.module or ""), a.name) for a in node.names]
    return [pair for pair in found if pair[0].startswith((".", "vizlight"))]


def part_of(module):
    return module.split(".")[1] if "." in module else ""


def folder_of(module):
    whole = (ROOT.parent / module.replace(".", "/")).is_dir()
    return module if whole else module.rpartition(".")[0]


def faults(modules):
    """Return what breaks the rules, a line for each."""
    found, graph, rooms = [], {}, {}
    for name, text in modules.items():
        own = part_of(name)
        for home, value in imports(text) if own else ():
            inner = f"{home}.{value}"
            target = inner if inner in modules else home
            other = part_of(target)
            if home.startswith("."):
                found.append(f"{name}: a relative import")
            elif other == "":
                found += [f"{name}: imports the whole package"] * (own not in USES_ALL)
            else:
                if TIER[other] > TIER[own]:
                    found.append(f"{name}: imports {target}, which stands above it")
                found += [f"{name}: imports the private {p}" for p in private(name, home, value)]
                if target != name and not name.startswith(f"{target}."):
                    graph.setdefault(name, set()).add(target)
                folders = name.rpartition(".")[0], folder_of(target)
                if not any(f"{a}.".startswith(f"{b}.") for a, b in (folders, folders[::-1])):
                    rooms.setdefault(folders[0], set()).add(folders[1])
    for edges in (graph, rooms):
        try:
            TopologicalSorter(edges).prepare()
        except CycleError as error:
            found.append(f"a circle: {' -> '.join(error.args[1])}")
    return found


def private(name, home, value):
    """Return the private parts of a dotted name that are not of the importer's own package."""
    parts = f"{home}.{value}".removesuffix(".__version__").rstrip(".").split(".")
    for i, part in enumerate(parts):
        # A module's private names are its package's, a package's those of what it holds.
        above = ".".join(parts[:i])
        above = above if folder_of(above) == above else above.rpartition(".")[0]
        if i > 1 and part.startswith("_") and not f"{name}.".startswith(f"{above}."):
            yield part


def test_imports_point_one_way():
    assert faults(sources()) == []


def test_every_part_has_a_tier():
    assert {part_of(name) for name in sources()} - {""} == set(TIER)


@pytest.mark.parametrize(
    ("module", "line", "fault"),
    [
        ("vizlight.model.frames", "from vizlight.scene import Scene", "above"),
        ("vizlight.shading.engine", "from vizlight.verify import between", "above"),
        ("vizlight.shading.engine", "    from vizlight.verify.oracle import light", "above"),
        ("vizlight.filters.fur", "from vizlight.mesh.records import _plain", "private _plain"),
        ("vizlight.model.frames", "from vizlight.model import reflection", "circle"),
        ("vizlight.geometry.solids.primitives", "from vizlight.geometry import contours", "circle"),
        ("vizlight.mesh.nspace", "import vizlight", "whole package"),
    ],
)
def test_each_rule_can_fail(module, line, fault):
    modules = sources()
    if line.startswith(" "):
        line = f"if TYPE_CHECKING:\n{line}"
    modules[module] += f"\n{line}\n"
    if fault == "circle":
        modules["vizlight.model.reflection"] += "\nfrom vizlight.model import frames\n"
    assert any(fault in line for line in faults(modules))
