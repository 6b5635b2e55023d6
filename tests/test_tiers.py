"""Imports point one way: tiers, no circles, no private name of another package."""

from __future__ import annotations

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
        "_supervise",
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
    {"files", "filters"},
    {"draw", "pieces"},
    {"observers"},
    {"accessor", "demo", "doctor", "presets"},
    {"cli"},
    {"__main__"},
]
#: Names that the package gives by itself are those of all tiers: only what stands last uses them.
USES_ALL = {"accessor", "cli", "demo", "doctor"}
TIER = {part: i for i, tier in enumerate(TIERS) for part in tier}


@cache
def texts():
    """Return the text of each module by its dotted name."""
    found = {}
    for path in ROOT.rglob("*.py"):
        parts = path.relative_to(ROOT.parent).with_suffix("").parts
        found[".".join(parts).removesuffix(".__init__")] = path.read_text(encoding="utf-8")
    return found


def sources():
    return dict(texts())


@cache
def import_statements(text):
    """Return the import statements of a module, also those for types and within functions."""
    return [
        node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Import | ast.ImportFrom)
    ]


def imports(name, text, modules):
    """Yield what a module imports: module and name."""
    for node in import_statements(text):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.partition(".")[0] == "vizlight":
                    yield alias.name, None
        else:
            assert node.level == 0, f"{name}: a relative import"
            if (node.module or "").partition(".")[0] == "vizlight":
                for alias in node.names:
                    inner = f"{node.module}.{alias.name}"
                    yield (inner, None) if inner in modules else (node.module, alias.name)


def is_folder(module):
    return (ROOT.parent / module.replace(".", "/")).is_dir()


def part_of(module):
    return module.split(".")[1] if "." in module else ""


def faults(modules):
    """Return what breaks the rules, a line for each."""
    found, graph, rooms = [], {}, {}
    for name, text in modules.items():
        own = part_of(name)
        for target, value in imports(name, text, modules):
            if own == "":
                continue
            other = part_of(target)
            if other == "":
                if own not in USES_ALL:
                    found.append(f"{name}: imports the whole package")
                continue
            if TIER[other] > TIER[own]:
                found.append(f"{name}: imports {target}, which stands above it")
            full = target if value is None else f"{target}.{value}"
            parts = full.removesuffix(".__version__").split(".")
            for i, part in enumerate(parts):
                # A module's private names are its package's, a package's those of what it holds.
                home = ".".join(parts[:i])
                home = home if home not in modules or value is None else home.rpartition(".")[0]
                if i > 1 and part.startswith("_") and not f"{name}.".startswith(f"{home}."):
                    found.append(f"{name}: imports the private {part} of {home}")
            if target != name and not name.startswith(f"{target}."):
                graph.setdefault(name, set()).add(target)
            folders = (
                name.rpartition(".")[0],
                target if is_folder(target) else target.rpartition(".")[0],
            )
            if not any(f"{a}.".startswith(f"{b}.") for a, b in (folders, folders[::-1])):
                rooms.setdefault(folders[0], set()).add(folders[1])
    for edges in (graph, rooms):
        try:
            TopologicalSorter(edges).prepare()
        except CycleError as error:
            found.append(f"a circle: {' -> '.join(error.args[1])}")
    return found


def test_imports_point_one_way():
    assert faults(sources()) == []


def test_every_part_has_a_tier():
    assert {part_of(name) for name in sources()} - {""} == set(TIER)


@pytest.mark.parametrize(
    ("module", "line", "fault"),
    [
        ("vizlight.model.frames", "from vizlight.scene import Scene", "above"),
        ("vizlight.shading.engine", "from vizlight.verify import report", "above"),
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
