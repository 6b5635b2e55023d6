"""Planes and ranges that cut data: a text, as the command line has it, or numbers."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

from vizlight import _check
from vizlight._types import Vector
from vizlight._words import AXES, describe, numbers, type_error, value_error

T = TypeVar("T")

PLANE = "NORMAL:OFFSET, 3 numbers and one, such as 0,0,1:2.5 or z:2.5"
RANGE = "NAME:LOW:HIGH, such as Temp:300:600 or Temp:300:"


def plane(name: str, value: object) -> tuple[Vector, Vector]:
    """Return the normal and the origin of a plane.

    The value is ``NORMAL:OFFSET``, a direction or the name of an axis and the distance of the plane
    from the origin along it, or the normal and a point of the plane.
    """
    if not isinstance(value, str):
        expected = f"{PLANE}, or a normal and an origin"
        normal, origin = _parts(name, value, 2, expected)
        return (_check.vector(name, normal, direction=True, n=3), _check.vector(name, origin, n=3))
    text, _, offset = value.rpartition(":")
    normal = AXES.get(text.lower()) or numbers(text)
    distance = numbers(offset, (1,))
    if not (any(normal) and distance):
        raise value_error(name, PLANE, describe(value))
    # The offset is a distance, whatever the length of the normal.
    length = math.hypot(*normal)
    return normal, tuple(distance[0] * component / length for component in normal)


def interval(name: str, value: object) -> tuple[str, float, float]:
    """Return the name of an array and the ends of a range, infinite where one is empty.

    The value is ``NAME:LOW:HIGH``, of which one end may be empty, or the three.
    """
    if not isinstance(value, str):
        array, *ends = _parts(name, value, 3, f"{RANGE}, or a name and two numbers")
        low, high = (
            math.copysign(math.inf, end)
            if end in (math.inf, -math.inf)
            else _check.number(name, end)
            for end in ends
        )
        if low > high:
            raise value_error(name, "a lower and a higher number", describe(value))
        return _check.text(name, array, expected="the name of an array"), low, high
    # From the right, as the name of an array may have colons of its own.
    array, *texts = value.rsplit(":", 2)
    bounds = [
        numbers(text, (1,)) if text else (empty,)
        for text, empty in zip(texts, (-math.inf, math.inf), strict=False)
    ]
    if not (len(bounds) == 2 and all(bounds) and any(texts) and bounds[0] <= bounds[1]):
        raise value_error(name, RANGE, describe(value))
    return array, bounds[0][0], bounds[1][0]


def several(name: str, value: object, read: Callable[[str, object], T]) -> list[T]:
    """Return each of several cuts; one alone needs no list.

    ``read`` is :func:`plane` or :func:`interval`.
    """
    return [read(name, each) for each in (value if isinstance(value, list) else [value])]


def _parts(name: str, value: object, count: int, expected: str) -> tuple[object, ...]:
    """Return the parts of a tuple or a list of some length."""
    if not isinstance(value, tuple | list):
        raise type_error(name, expected, value)
    if len(value) != count:
        raise value_error(name, expected, describe(value))
    return tuple(value)
