"""Words of error messages, docstrings and directions; nothing here needs NumPy."""

from __future__ import annotations

import inspect
import math
import re
import sys
from numbers import Number
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Container, Sequence

    from vizlight._types import Vector

#: Directions of the axes by name.
AXES: dict[str, Vector] = {
    "x": (1.0, 0.0, 0.0), "-x": (-1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "-y": (0.0, -1.0, 0.0),
    "z": (0.0, 0.0, 1.0), "-z": (0.0, 0.0, -1.0),
}  # fmt: skip


def message(name: str, expected: str, got: object, remedy: str = "") -> str:
    """Return ``name: expected ..., got ...; remedy`` on one line, with arrays described."""
    got = describe(got) if _is_array(got) else got
    text = f"{name}: expected {expected}, got {got}"
    return f"{text}; {remedy}" if remedy else text


def value_error(name: str, expected: str, got: object, remedy: str = "") -> ValueError:
    """Return the error of a wrong value, with a :func:`message`."""
    return ValueError(message(name, expected, got, remedy))


def type_error(name: str, expected: str, value: object, remedy: str = "") -> TypeError:
    """Return the error of a value of a wrong type, which the :func:`message` describes."""
    return TypeError(message(name, expected, describe(value), remedy))


def one_of(names: Sequence[str]) -> str:
    """Return the names that the user may choose from, as part of an error message."""
    return f"one of {list(names)}" if names else "but the mesh has none"


def describe(value: object) -> str:
    """Return a short description of a value for an error message."""
    if _is_array(value):
        return f"an array of shape {value.shape} and type {value.dtype}"  # type: ignore[attr-defined]
    if isinstance(value, Number) and hasattr(value, "item"):
        value = value.item()  # NumPy prints the type of a number
    try:
        # A file or a terminal may take no half of a surrogate pair.
        text = " ".join(repr(value).encode("utf-8", "backslashreplace").decode().split())
    except ValueError:  # Python does not print integers of more than 4300 digits
        kind = "an integer" if isinstance(value, int) else "a number"
        text = f"{kind} of more digits than Python prints"
    return text if len(text) <= 60 else f"{text[:57]}..."


def numbers(text: str, counts: Container[int] = (3,)) -> tuple[float, ...]:
    """Return numbers separated by commas, none where the text is not that."""
    try:
        values = tuple(float(part) for part in text.split(","))
    except ValueError:
        return ()
    return values if len(values) in counts and all(map(math.isfinite, values)) else ()


def printable(text: str, /) -> str:
    """Return a text in which what a terminal or an editor acts on is written by its number.

    Names of files may hold control characters and marks that turn the direction of writing. Line
    breaks stay.
    """
    if text.replace("\n", "").isprintable():
        return text
    return "".join(
        char if char == "\n" or char.isprintable() else ascii(char)[1:-1] for char in text
    )


def _is_array(value: object) -> bool:
    """Return whether a value is an array; none exists before NumPy is loaded."""
    numpy = sys.modules.get("numpy")
    return numpy is not None and isinstance(value, numpy.ndarray)


def parameters(docstring: str | None) -> dict[str, str]:
    """Return the entry of each parameter in the first section Parameters of a docstring.

    An entry of several parameters stands at the first of them; the others have an empty one.
    """
    text = inspect.cleandoc(docstring or "")
    section = re.search(r"^Parameters\n-+\n(.*?)(?:\n\n[A-Z]|\Z)", text, re.S | re.M)
    entries: dict[str, str] = {}
    for entry in re.split(r"\n(?=[\w*])", section[1]) if section else ():
        first, *others = entry.partition("\n")[0].partition(" :")[0].split(", ")
        entries.setdefault(first, entry.rstrip())
        entries.update(dict.fromkeys(others, ""))
    return entries
