"""The keywords of a record, and an error for any other that names the nearest of them."""

from __future__ import annotations

import difflib
import functools
import inspect
from typing import TYPE_CHECKING

from vizlight import _check

if TYPE_CHECKING:
    from collections.abc import Callable
    from typing import ParamSpec

    P = ParamSpec("P")


def keywords_only(method: Callable[P, None]) -> Callable[P, None]:
    """Let an initialiser that takes keywords alone say which it has.

    Parameters
    ----------
    method : callable
        ``__init__`` of a class whose parameters are keyword-only.

    Returns
    -------
    callable
        The initialiser, which raises TypeError for a positional argument or an unknown keyword.
    """
    kind = method.__qualname__.removesuffix(".__init__")
    known = list(inspect.signature(method).parameters)[1:]
    expected = f"keywords of {kind} ({', '.join(known)})"

    @functools.wraps(method)
    def checked(*arguments: P.args, **given: P.kwargs) -> None:
        if len(arguments) > 1:
            got, remedy = _check.describe(arguments[1]), f"name it, as in {kind}({known[0]}=...)"
            raise TypeError(_check.message(kind, expected, got, remedy))
        for name in given:
            if name not in known:
                near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
                remedy = f"did you mean {near[0]}=?" if near else ""
                raise TypeError(_check.message(kind, expected, f"{name}=", remedy))
        method(*arguments, **given)

    return checked
