"""An error for a keyword that a function or a record does not have, which names the nearest."""

from __future__ import annotations

import difflib
import functools
import inspect
from typing import TYPE_CHECKING

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import ParamSpec, TypeVar

    P = ParamSpec("P")
    R = TypeVar("R")


def named(function: Callable[P, R]) -> Callable[P, R]:
    """Let the error for a keyword that a function does not have name the nearest that it has.

    An initialiser that takes keywords alone also says so of a value without a name.
    """
    parameters = inspect.signature(function).parameters
    known = list(parameters)
    owner = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]
    kinds = {parameters[name].kind for name in known[1:]}
    keywords_only = function.__name__ == "__init__" and kinds == {inspect.Parameter.KEYWORD_ONLY}

    @functools.wraps(function)
    def method(*arguments: P.args, **keywords: P.kwargs) -> R:
        if keywords_only and len(arguments) > 1:
            expected = f"keywords of {owner} ({', '.join(known[1:])})"
            got, remedy = _check.describe(arguments[1]), f"name it, as in {owner}({known[1]}=...)"
            raise TypeError(_check.message(owner, expected, got, remedy))
        for name in keywords:
            if name not in known:
                raise TypeError(unknown_option(owner, name, known))
        return function(*arguments, **keywords)

    return method


def unknown_option(function: str, name: str, known: list[str]) -> str:
    """Return the message for a keyword that a function does not have."""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    remedy = f"did you mean {near[0]}=?" if near else f"it has {', '.join(known[1:])}"
    return _check.message(name, f"an option of {function}", "a name that it does not have", remedy)
