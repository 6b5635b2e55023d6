"""Settings that hold while a context is entered."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import contextvars
    from collections.abc import Iterator

T = TypeVar("T")


@contextlib.contextmanager
def assigned(variable: contextvars.ContextVar[T], value: T) -> Iterator[None]:
    """Give a variable a value while this context is entered."""
    token = variable.set(value)
    try:
        yield
    finally:
        variable.reset(token)
