"""Calls that can be run or written as a Python script: the work of a look, defined once."""

from __future__ import annotations

import functools
import importlib
import json
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import vizlight
from vizlight import _words
from vizlight._words import value_error

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from vizlight._types import Foreign

#: First names of paths: modules in groups, and modules of vizlight.
MODULES = (("json", "pathlib"), ("distributed", "numpy", "pyvista"), ("vizlight", "vizlight.maps"))
OWN = ("files", "film", "movie", "paraview", "render")
INDENT, WIDTH = 4, 88
#: Name of the step that moves a solid by its displacements.
DISPLACED = "displaced"
#: Indentation at which nothing is broken.
ONE_LINE = -(10**6)


class Step:
    """One call, whose arguments may be results of other steps.

    ``name`` is the variable that holds the result; without one the call stands where it is used.
    ``path`` is that of a public function; ``.name`` is a method of the first argument, ``.name=``
    an attribute of it that is set, ``[]`` an item of it, and ``-`` a value that a script has.
    Arguments are plain values, steps, or lists and tuples of them.
    """

    def __init__(self, name: str, path: str, /, *arguments: object, **keywords: object) -> None:
        self.name, self.path = name, path
        self.arguments, self.keywords = arguments, keywords
        #: Attributes that the result is given.
        self.attributes: dict[str, object] = {}
        #: Option and value of a user, with which the result must have points.
        self.asked = ("", "")
        #: What a reader should know of what was decided by itself.
        self.note = ""
        #: Whether its warnings are of choices that nobody asked for.
        self.quiet = False
        self._next: dict[str, Step] = {}

    def run(self) -> Foreign:
        """Return the result; the call is made once."""
        return self._result

    def then(self, name: str, path: str) -> Step:
        """Return the step that calls a function with this one's result, the same each time."""
        return self._next.setdefault(path, Step(name, path, self))

    def hold(self, result: object) -> None:
        """Take a result that is known, so that no call is made."""
        vars(self)["_result"] = result

    @property
    def made(self) -> bool:
        """Whether the call was made."""
        return "_result" in vars(self)

    @functools.cached_property
    def _result(self) -> Foreign:
        with warnings.catch_warnings():
            if self.quiet:
                warnings.simplefilter("ignore")
            result = self._called()
        if self.asked[0] and not result.n_points:
            expected, remedy = "a value that leaves points", ""
            if self.path in {".slice", ".clip"}:
                mesh: Foreign = run(self.arguments[0])
                bounds: Sequence[float] = mesh.bounds
                ends = zip("xyz", bounds[::2], bounds[1::2], strict=True)
                runs = ", ".join(f"{axis} from {low:.4g} to {high:.4g}" for axis, low, high in ends)
                remedy = f"the mesh has {runs}"
            raise value_error(self.asked[0], expected, self.asked[1], remedy)
        for key, value in self.attributes.items():
            setattr(result, key, value)
        return result

    def _called(self) -> Foreign:
        arguments: list[Foreign] = [run(value) for value in self.arguments]
        keywords = {key: run(value) for key, value in self.keywords.items()}
        if self.path == "[]":
            return arguments[0][arguments[1]]
        if self.path == "-":
            return arguments[0]
        if self.path.startswith("."):
            return self._of_first(arguments, keywords)
        head, *names = self.path.split(".")
        function: Foreign = (
            getattr(vizlight, head) if head in OWN else importlib.import_module(head)
        )
        for name in names:
            function = getattr(function, name)
        return function(*arguments, **keywords)

    def _of_first(self, arguments: list[Foreign], keywords: dict[str, object]) -> Foreign:
        """Return the result of a method of the first argument, or set an attribute of it."""
        *owners, last = self.path[1:].split(".")
        owner = functools.reduce(getattr, owners, arguments[0])
        if last.endswith("="):
            return setattr(owner, last[:-1], arguments[1])
        return getattr(owner, last)(*arguments[1:], **keywords)

    def chain(self) -> Iterator[object]:
        """Yield the step, that of its first argument and so on, to the value they begin with."""
        value: object = self
        while isinstance(value, Step):
            yield value
            if not value.arguments:
                return
            value = value.arguments[0]
        yield value

    def parts(self) -> Iterator[object]:
        """Yield the arguments and keywords."""
        yield from self.arguments
        yield from self.keywords.values()


def run(value: object) -> object:
    """Return a value with the results of the steps in it."""
    if isinstance(value, Step):
        return value.run()
    if isinstance(value, list | tuple):
        return type(value)(run(part) for part in value)
    return str(value) if isinstance(value, Path) else value


def written(steps: Sequence[Step]) -> Path:
    """Run the steps that write a file, and return its path, the first of a sequence's."""
    try:
        result: str | Path | list[Path] = [step.run() for step in steps][-1]
    finally:
        for step in in_order(steps):
            if step.path == "render.canvas" and step.made:
                step.run().close()
    return result[0] if isinstance(result, list) else Path(result)


def source(jobs: Sequence[Sequence[Step]]) -> str:
    """Return the script that runs the steps of each job in order."""
    lines: list[str] = []
    heads: set[str] = set()
    holders: dict[str, Step] = {}
    for job in jobs:
        for step in in_order(job):
            _keep_apart(step, holders)
            heads.add(step.path.partition(".")[0])
            if step.path == "-":
                lines.append(f"# {step.name}: the {type(step.arguments[0]).__name__} of the look")
            elif step.name or any(step is last for last in job):
                lines += _statement(step)
    if any('"vizlight.' in line for line in lines):
        # Its colour maps have names as soon as their module is loaded.
        heads = heads - {"vizlight"} | {"vizlight.maps"}
    groups = [[f"import {head}" for head in group if head in heads] for group in MODULES]
    if names := [head for head in OWN if head in heads]:
        groups[-1].append(f"from vizlight import {', '.join(names)}")
    return "\n\n".join("\n".join(group) for group in (*groups, lines) if group)


def _keep_apart(step: Step, holders: dict[str, Step]) -> None:
    """Give a step a name of its own, unless it is made of the one that has its name."""
    name, count = step.name, 1
    while name and (other := holders.get(name, step)) is not step:
        if any(part is other for part in step.parts()):
            break
        count += 1
        name = f"{step.name}_{count}"
    step.name = name
    if name:
        holders[name] = step


def in_order(steps: Sequence[Step]) -> list[Step]:
    """Return the steps and all that they need, each once and after those that it needs."""
    ordered: list[Step] = []

    def visit(value: object) -> None:
        if isinstance(value, Step):
            if not any(value is step for step in ordered):
                for part in value.parts():
                    visit(part)
                ordered.append(value)
        elif isinstance(value, list | tuple):
            for part in value:
                visit(part)

    visit(list(steps))
    return ordered


def _statement(step: Step) -> list[str]:
    head = f"{step.name} = " if step.name else ""
    lines = [f"{head}{_call(step, 0, len(head))}"]
    return lines + [f"{step.name}.{key} = {_text(value)}" for key, value in step.attributes.items()]


def _text(value: object, indent: int = 0, taken: int = 0) -> str:
    """Return a value as Python source, on several lines where one is too short for it."""
    if isinstance(value, Step):
        return value.name or _call(value, indent, taken)
    if isinstance(value, list | tuple):
        ends = "[]" if isinstance(value, list) else "()"
        comma = len(value) == 1 and isinstance(value, tuple)
        return _joined(ends[0], [("", part) for part in value], ends[1], indent, taken, comma=comma)
    if isinstance(value, str | Path):
        # Double quotes, as formatters of Python write.
        return _words.printable(json.dumps(str(value), ensure_ascii=False))
    return repr(value)


def _call(step: Step, indent: int, taken: int) -> str:
    arguments = list(step.arguments)
    if step.path.endswith("="):
        return f"{_text(arguments[0])}{step.path[:-1]} = {_text(arguments[1], indent, taken)}"
    if step.path == "[]":
        return f"{_text(arguments[0])}[{_text(arguments[1])}]"
    head = step.path
    if head.startswith("."):
        head = f"{_text(arguments.pop(0))}{head}"
    parts = [("", value) for value in arguments]
    parts += [(f"{key}=", value) for key, value in step.keywords.items()]
    return _joined(f"{head}(", parts, ")", indent, taken)


def _joined(
    head: str,
    parts: list[tuple[str, object]],
    tail: str,
    indent: int,
    taken: int,
    *,
    comma: bool = False,
) -> str:
    line = head + ", ".join(key + _text(part, ONE_LINE) for key, part in parts) + "," * comma + tail
    if indent + taken + len(line) <= WIDTH or not parts:
        return line
    inner = indent + INDENT
    rows = [f"{' ' * inner}{key}{_text(part, inner, len(key) + 1)},\n" for key, part in parts]
    return f"{head}\n{''.join(rows)}{' ' * indent}{tail}"
