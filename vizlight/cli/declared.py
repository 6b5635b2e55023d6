"""The options of a filter as its source declares them, read without an import of the filter.

A filter loads PyVista, which takes longer than the help of a command.
"""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

from vizlight import _words

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[1]


class Option(NamedTuple):
    """Keyword of a filter; if it is required, its default is that of a parameter without one."""

    annotation: str
    required: bool
    default: object
    #: Name of the module that has the annotation.
    module: str


class Filter(NamedTuple):
    """Keywords of a public filter by name, and its documentation of each."""

    options: dict[str, Option]
    texts: dict[str, str]


@functools.cache
def filter_(name: str) -> Filter:
    """Return the declaration of a public filter.

    Parameters
    ----------
    name : str
        Name of the filter, which its module has too.
    """
    return function(f"vizlight.filters.{name}", name)


def function(module: str, name: str) -> Filter:
    """Return the declaration of a function."""
    node, module = _find(module, name)
    if not isinstance(node, ast.FunctionDef):
        raise LookupError(f"{name} is no function of {module}")
    own = {
        argument.arg: Option(
            _text(argument.annotation), default is None, _value(default, module), module
        )
        for argument, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True)
    }
    texts = _words.parameters(ast.get_docstring(node))
    return Filter(own, texts)


def choices(option: Option, name: str) -> object | None:
    """Return the type ``Literal`` that a name in the annotation of an option stands for, or None.

    A name that no module of the package defines stands for none.
    """
    try:
        node, _ = _find(option.module, name)
    except LookupError:
        return None
    value = getattr(node, "value", None)
    if isinstance(value, ast.Subscript) and _text(value.value) == "Literal":
        return Literal[ast.literal_eval(value.slice)]
    return None


@functools.cache
def _parts(module: str) -> list[str]:
    """Return the parts of a module of the package between two blank lines."""
    path = ROOT.joinpath(*module.split(".")[1:])
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    if not path.is_file():
        raise LookupError(f"no file of {module}")
    return path.read_text(encoding="utf-8").split("\n\n\n")


@functools.cache
def _find(module: str, name: str) -> tuple[ast.stmt, str]:
    """Return the statement that defines a name, and the module in which it stands."""
    for part in _parts(module):
        # Only few parts are parsed, since most of a module are functions of other names.
        own = re.search(r"^(?:def|class) (\w+)", part, re.M)
        if name not in part or (own and own[1] != name):
            continue
        for node in _statements(ast.parse(part)):
            if isinstance(node, ast.ImportFrom):
                for alias in node.names:
                    if (alias.asname or alias.name) == name:
                        return _find(node.module or "", alias.name)
            elif name in _defined(node):
                return node, module
    raise LookupError(f"{module} defines no {name}")


def _statements(tree: ast.Module) -> Iterator[ast.stmt]:
    """Yield the statements of a part, also those for types alone."""
    for node in tree.body:
        if isinstance(node, ast.If):
            yield from node.body
        else:
            yield node


def _defined(node: ast.stmt) -> list[str]:
    """Return the names that a statement defines."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return [node.name]
    targets = [node.target] if isinstance(node, ast.AnnAssign) else getattr(node, "targets", [])
    return [name for target in targets for name in _text(target).strip("()").split(", ")]


def _text(node: ast.expr | None) -> str:
    return "" if node is None else ast.unparse(node)


def _value(node: ast.expr | None, module: str) -> object:
    """Return the value of an expression of constants and of names that stand for constants."""
    if node is None:
        return None
    known: dict[str, object] = {}
    for name in {inner.id for inner in ast.walk(node) if isinstance(inner, ast.Name)}:
        found, home = _find(module, name)
        value, names = _value(getattr(found, "value", None), home), _defined(found)
        known[name] = value[names.index(name)] if len(names) > 1 else value  # type: ignore[index]
    return eval(ast.unparse(node), {"__builtins__": {}}, known)
