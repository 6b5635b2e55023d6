"""An error for a keyword that a function or a record does not have, which names the nearest."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from vizlight import _check

P = ParamSpec("P")
R = TypeVar("R")


def named(function: Callable[P, R]) -> Callable[P, R]:
    """Make errors for unknown keywords of a function, and for values without a keyword, helpful.

    They name the nearest keyword of the function, or the keyword that fits the class of the value.
    """
    parameters = inspect.signature(function).parameters.values()
    names = [parameter.name for parameter in parameters]
    by_name = [
        parameter.name
        for parameter in parameters
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY
    ]
    # A function that hands further keywords on checks them itself.
    hands_on = any(parameter.kind is inspect.Parameter.VAR_KEYWORD for parameter in parameters)
    # Arguments that may come without a name, ``self`` among them.
    places = len(names) - len(by_name) - hands_on
    owner = function.__qualname__.removesuffix(".__init__").rpartition(".")[2]

    @functools.wraps(function)
    def method(*arguments: P.args, **keywords: P.kwargs) -> R:
        if by_name and len(arguments) > places:
            value: object = arguments[places]
            kind = type(value).__name__.lower()
            # A Material is most likely meant for material=: the class of a value tells its keyword.
            keyword = kind if kind in by_name else by_name[0]
            expected, got = f"keywords of {owner} ({', '.join(by_name)})", _check.describe(value)
            raise TypeError(
                _check.message(owner, expected, got, f"name it, as in {owner}({keyword}=...)")
            )
        for name in keywords:
            if name not in names and not hands_on:
                raise TypeError(unknown_option(owner, name, names))
        return function(*arguments, **keywords)

    return method


def unknown_option(function: str, name: str, options: list[str]) -> str:
    """Return the message for a keyword that a function does not have."""
    begun = [option for option in options if option.startswith(name)]
    near = begun or difflib.get_close_matches(name, options, n=1)
    remedy = f"did you mean {near[0]}=?" if near else f"it has {', '.join(options[1:])}"
    return _check.message(name, f"an option of {function}", "a name that it does not have", remedy)
