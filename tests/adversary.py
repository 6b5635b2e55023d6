"""Every public callable with adversarial values: the judge, and the full walk.

    python tests/adversary.py [--seed N] [--each N] [NAME ...]

``adversary_calls.py`` has one valid call for each callable. One argument at a time is replaced by
values that fit its kind. The call may return, if its numbers are finite or documented as marked,
no warning but vizlight's own was issued and the inputs are unchanged; or it may raise at a
``raise`` of vizlight, in words that name the argument. Each callable runs in a process of its own,
so a crash is one failure.
"""

from __future__ import annotations

import argparse
import ast
import collections
import contextlib
import functools
import inspect
import json
import os
import re
import signal
import sys
import tempfile
import traceback
import typing
import warnings
from pathlib import Path

import adversary_calls as table
import adversary_values as values
import numpy as np
import pyvista as pv

import vizlight
from vizlight import _check

#: Longest processor time of one call, in seconds.
LIMIT = 5.0
ROOT = Path(vizlight.__file__).parent
#: Errors that a `raise` of vizlight may be of, beside its own.
ERRORS = (ValueError, TypeError, OSError, ImportError, KeyError, RuntimeError, AssertionError)


class TooSlow(BaseException):
    """A call that takes too long."""


class Call(typing.NamedTuple):
    """One argument of one callable replaced by one value."""

    name: str
    argument: str
    label: str
    value: object


@contextlib.contextmanager
def new_folder():
    """Work in a new folder, which is deleted after that."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        Path("script.py").write_text("x = 1\n", encoding="utf-8")
        try:
            yield
        finally:
            os.chdir(before)


@functools.cache
def raises(path):
    """Return the lines of a file that belong to `raise` statements."""
    tree = ast.parse(Path(path).read_text(encoding="utf-8"))
    nodes = [node for node in ast.walk(tree) if isinstance(node, ast.Raise)]
    return {line for node in nodes for line in range(node.lineno, node.end_lineno + 1)}


def parameters(function):
    """Return the parameters of a callable with their annotations as text.

    Keywords of a TypedDict, ``**options: Unpack[...]``, are parameters each.
    """
    found = {}
    for name, parameter in inspect.signature(function).parameters.items():
        text = str(parameter.annotation)
        if unpacked := re.search(r"Unpack\[(\w+)\]", text):
            for base in reversed(table.TYPED_DICTS[unpacked[1]]().__mro__):
                for key, value in inspect.get_annotations(base).items():
                    found[key] = getattr(value, "__forward_arg__", str(value))
        elif parameter.kind is not parameter.VAR_KEYWORD and name not in ("self", "cls"):
            found[name] = text
    return found


def bound(function, given):
    """Return positional and keyword arguments of a call from arguments by name."""
    args, rest = [], dict(given)
    for name, parameter in inspect.signature(function).parameters.items():
        if name in rest and parameter.kind is parameter.POSITIONAL_ONLY:
            args.append(rest.pop(name))
        elif name in rest and parameter.kind is parameter.VAR_POSITIONAL:
            value = rest.pop(name)
            args.extend(value if isinstance(value, tuple) else [value])
    return args, rest


def calls(name):
    """Return all calls of one callable, of which the first is the valid one."""
    with new_folder():
        valid = table.arguments(name)
    # A method of the accessor has the arguments of a function that is walked anyway.
    only = ("mesh", "surface", "lit", "scene") if name.startswith("accessor.") else None
    return [Call(name, "", "valid", None)] + [
        Call(name, argument, label, value)
        for argument, text in parameters(table.PUBLIC[name]).items()
        if only is None or argument in only
        for label, value in values.of(table.KINDS.get(argument, text), valid.get(argument))
    ]


def mark(value):
    """Return all data in a value as lists, which are others if any of them changes."""
    if isinstance(value, np.ma.MaskedArray):
        return [mark(np.ma.getmaskarray(value)), mark(value.data)]
    if isinstance(value, np.ndarray):
        form = f"{value.shape}{value.dtype}{value.strides}{value.flags.writeable}"
        small = value.size < 1e7
        return [
            form,
            repr(value.tolist()) if value.dtype.kind == "O" else small and value.tobytes(),
        ]
    if isinstance(value, pv.MultiBlock):
        return [[key, mark(block)] for key, block in zip(value.keys(), value, strict=True)]
    if isinstance(value, pv.DataSet):
        arrays = {
            f"{kind}{key}": np.asarray(part[key])
            for kind, part in enumerate((value.point_data, value.cell_data, value.field_data))
            for key in part
        }
        cells = [np.array(getattr(value, name, 0)) for name in ("faces", "lines", "verts", "cells")]
        what = [str(type(value)), value.n_cells, value.active_scalars_name]
        return [what, mark(arrays), mark(np.array(value.points)), mark(cells)]
    if isinstance(value, list | tuple):
        return [mark(item) for item in value]
    if isinstance(value, dict):
        return [[repr(key), mark(item)] for key, item in value.items()]
    if value is None or isinstance(value, bytes | str | float | complex):
        return repr(value)
    # Texts of numbers of many digits are refused.
    return value if isinstance(value, int) else None


def unfinite(value, path="", depth=0):
    """Return the first place in a result whose numbers are not finite, or an empty text."""
    children = {}
    if isinstance(value, float | np.floating | np.ndarray):
        numbers = np.asarray(value)
        bad = numbers.dtype.kind in "fc" and not np.isfinite(numbers).all()
        return (path or "result") if bad else ""
    if isinstance(value, pv.DataSet):
        children = {"points": value.points}
        children |= {f"point_data[{k}]": np.asarray(v) for k, v in value.point_data.items()}
        children |= {f"cell_data[{k}]": np.asarray(v) for k, v in value.cell_data.items()}
    elif isinstance(value, pv.MultiBlock | list | tuple):
        children = {f"[{i}]": item for i, item in enumerate(value) if i < 50}
    elif isinstance(value, dict):
        children = {f"[{k}]": item for k, item in value.items()}
    elif type(value).__module__.startswith("vizlight") and not isinstance(value, type):
        children = {f".{k}": v for k, v in getattr(value, "__dict__", {}).items()}
    found = (unfinite(child, path + key, depth + 1) for key, child in children.items() if depth < 7)
    return next(filter(None, found), "")


@contextlib.contextmanager
def told():
    """Collect the warnings that are not vizlight's own."""
    own, warn, found = set(), _check.warn, []

    def noted(text, category=UserWarning):
        own.add(str(text))
        warn(text, category)

    _check.warn = noted
    try:
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            with np.errstate(over="warn", divide="warn", invalid="warn"):
                yield found
    finally:
        _check.warn = warn
        found += [item for item in said if str(item.message) not in own]


def judge(call):
    """Run a call and return what is wrong with it, or an empty text."""
    function = table.PUBLIC[call.name]
    with new_folder():
        given = table.arguments(call.name)
        if call.argument:
            given[call.argument] = values.fresh(call.value)
        args, keywords = bound(function, given)
        if (owner := table.owner(call.name)) is not None:
            args.insert(0, owner)
        before, there = mark([args, keywords]), {*Path().iterdir()}
        error = result = None
        try:
            with told() as leaked, limited(LIMIT):
                result = _called(function, args, keywords)
        except (Exception, TooSlow) as caught:  # noqa: BLE001
            error = caught
        finally:
            pv.close_all()
        left = [path.name for path in Path().iterdir() if path not in there]
        if isinstance(error, TooSlow):
            return f"takes more than {LIMIT:g} s"
        if leaked:
            first = leaked[0]
            place = f"{Path(first.filename).name}:{first.lineno}"
            return f"leaks {first.category.__name__} at {place}: {first.message}"
        if mark([args, keywords]) != before and call.argument != "inplace":
            return "changes its inputs"
        if error is not None:
            return f"raises and leaves {left}" if left else wrong_error(error, call, given)
        place = unfinite(result)
        return f"returns numbers that are not finite at {place}" if _bad(place, call, given) else ""


def names_of(mesh):
    """Return the names of the point arrays of a mesh."""
    if isinstance(mesh, pv.MultiBlock):
        return {name for block in mesh if block is not None for name in names_of(block)}
    return set(mesh.point_data)


def _bad(place, call, given):
    marked, _ = table.MARKED.get(call.name, ("$^", ""))
    # Arrays of the mesh that came in stay.
    if not place or re.search(marked, place):
        return False
    meshes = [value for value in given.values() if isinstance(value, pv.DataSet | pv.MultiBlock)]
    kept = {"points", *(f"point_data[{name}]" for mesh in meshes for name in names_of(mesh))}
    return re.sub(r"^(\[\d+\]|\.mesh)*", "", place) not in (kept if meshes else ())


@contextlib.contextmanager
def limited(seconds):
    """Raise TooSlow after some processor time."""

    def stop(number, frame):
        raise TooSlow

    old = signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, old)


def _called(function, args, keywords):
    result = function(*args, **keywords)
    if inspect.isgenerator(result):
        return next(result, None)
    if isinstance(result, contextlib.AbstractContextManager) and not isinstance(result, Path):
        with result as entered:
            return entered
    return result


def place_of(error):
    """Return where in vizlight an exception comes from, and whether a `raise` there raised it."""
    frames = traceback.extract_tb(error.__traceback__)
    inside = [f for f in frames if Path(f.filename).is_relative_to(ROOT)]
    if not inside:
        return "call", False
    last = inside[-1]
    place = f"{Path(last.filename).relative_to(ROOT)}:{last.lineno}"
    return place, last is frames[-1] and last.lineno in raises(last.filename)


def wrong_error(error, call, given):
    """Return what is wrong with an exception, or an empty text."""
    if not call.argument:
        return f"the valid call raises {type(error).__name__}: {error}"
    text = " ".join(str(error).split())
    kind = type(error).__name__
    place, own = place_of(error)
    if not own:
        return f"raw {kind} at {place}: {text[:90]}"
    if not isinstance(error, ERRORS):
        return f"raises {kind} at {place}"
    names = {call.argument} | table.ALIASES.get(call.argument, set())
    if call.label.startswith(("mesh:", "other:")) or call.argument == "inputs":
        # Where a mesh lacks what other arguments ask for, the error names these; a height field
        # names its coordinates.
        mesh = given.get(call.argument)
        names |= {"mesh", "z", *inspect.signature(table.PUBLIC[call.name]).parameters}
        names |= {str(key) for key in mesh.point_data} if isinstance(mesh, pv.DataSet) else set()
    if not any(re.search(rf"(?<!\w){re.escape(name)}(?!\w)", str(error)) for name in names):
        return f"does not name the argument at {place}: {text[:90]}"
    return ""


def sample(name, each, seed):
    """Return some calls of a callable, the same ones for a seed."""
    every = calls(name)
    random = np.random.default_rng([seed, *name.encode()])
    chosen = random.permutation(len(every))[:each] if each else range(len(every))
    return [every[i] for i in sorted(chosen)]


def forked(work):
    """Run a function of a file in a fork of this process; return what it wrote, and the exit code.

    What is written arrives line by line, so that a crash loses the last line alone.
    """
    reading, writing = os.pipe()
    child = os.fork()
    if not child:
        code = 1
        try:
            with os.fdopen(writing, "w", encoding="utf-8", buffering=1) as file:
                work(file)
            code = 0
        finally:
            os._exit(code)
    os.close(writing)
    with os.fdopen(reading, encoding="utf-8") as file:
        text = file.read()
    return text, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def walk(name, each, seed):
    """Judge the calls of one callable in child processes; yield each with what is wrong."""
    todo = sample(name, each, seed)
    while todo:
        text, code = forked(functools.partial(_judged, todo))
        for line in text.splitlines():
            yield todo.pop(0), json.loads(line)
        if todo:
            yield todo.pop(0), f"crashes the process ({code})"


def _judged(todo, file):
    quiet = os.open(os.devnull, os.O_WRONLY)
    os.dup2(quiet, 2)
    os.dup2(quiet, 1)
    for call in todo:
        file.write(json.dumps(judge(call)) + "\n")


def main():
    """Walk all callables, or those that are named, and print what is wrong by cause."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("names", nargs="*", help="callables, or beginnings of their names")
    parser.add_argument("--seed", type=int, default=0, help="seed of the sample")
    parser.add_argument("--each", type=int, default=0, help="calls of each callable; 0: all")
    asked = parser.parse_args()
    names = [name for name in table.PUBLIC if name.startswith(tuple(asked.names or [""]))]
    tried, failed = 0, collections.Counter()
    for name in names:
        for call, wrong in walk(name, asked.each, asked.seed):
            tried += 1
            if wrong:
                failed[name] += 1
                print(ascii(f"{name}({call.argument}={call.label}): {wrong}")[1:-1], flush=True)
    bad = len(failed)
    print(f"{tried} calls of {len(names)} callables: {failed.total()} fail, of {bad} callables")
    return bool(failed)


if __name__ == "__main__":
    sys.exit(main())
