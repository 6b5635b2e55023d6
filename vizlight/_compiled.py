"""Functions that numba compiles, where it is installed (extra ``fast``) and where it pays.

A function is declared by :func:`kernel`, which imports nothing. The caller asks :meth:`Kernel.pays`
with the seconds that the compiled function would save, and calls the kernel or else its own NumPy
code. The first call imports numba and compiles the function, or reads it from the disk cache.

The environment variable ``VIZLIGHT_FAST`` is read at each question: 0 switches compiled code off,
1 uses it without regard to its start-up.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import pickle
import platform
import shutil
import threading
import types
import warnings
from collections.abc import Callable
from functools import cache, lru_cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Generic, ParamSpec, TypeVar

from vizlight import _cache, _check

P = ParamSpec("P")
R = TypeVar("R")

#: Oldest release of numba that the kernels are made for.
OLDEST = (0, 59)
#: Rounding that a compiler may change where a bound of a few eps allows it: products and sums in
#: one step, quotients as products, the sign of zero. Sums keep their order.
ROUNDING = frozenset({"contract", "arcp", "nsz"})
#: Seconds of processor time to import numba, to prepare its compiler, and to compile for the first
#: time; the disk keeps the result. A call that saves half of it takes at most twice NumPy's time.
START_UP = 2.4
#: Folder of compiled code among the folders of what is kept.
KERNELS = "kernels"
#: What a damaged file of the cache raises when numba reads it.
_DAMAGED = (pickle.UnpicklingError, EOFError, ValueError, LookupError, AttributeError, ImportError)

_LOCK = threading.RLock()
_BROKEN: list[str] = []


def wanted() -> str:
    """Return the setting of VIZLIGHT_FAST: "0" off, "1" always, "" where it pays."""
    value = os.environ.get("VIZLIGHT_FAST", "")
    if value not in ("", "0", "1"):
        expected = "0 (off), 1 (always) or nothing (where it pays)"
        raise _check.value_error("VIZLIGHT_FAST", expected, repr(value))
    return value


def why_not() -> str:
    """Return why nothing is compiled; an empty text where compiled code is available."""
    if wanted() == "0":
        return "VIZLIGHT_FAST=0 switches it off"
    return _unusable()


def active() -> bool:
    """Return whether compiled code is available: numba is installed and not switched off."""
    return not why_not()


def status() -> str:
    """Return whether compiled code is available and where it is kept, in words."""
    reason = why_not()
    if reason:
        return f"off: {reason}"
    folder = _cache.folder(KERNELS)
    kept = f"kept in {folder}" if folder else "compiled anew in each process: no folder to keep it"
    when = "always" if wanted() == "1" else "where it pays"
    return f"on ({when}), by numba {version('numba')}, {kept}"


def try_out() -> None:
    """Compile and run a small function, after which :func:`status` says whether that works."""
    if active():
        with warnings.catch_warnings(), contextlib.suppress(FailedError):
            warnings.simplefilter("ignore")
            Kernel(_twice)(1.0)


def _twice(x: float) -> float:
    return 2 * x


class FailedError(RuntimeError):
    """Compiled code cannot be used: its caller computes the same by NumPy."""


def _give_up(what: str, error: Exception) -> str:
    """Switch compiled code off in this process, with a warning at the first time; return why."""
    if not _BROKEN:
        words = str(error).strip().splitlines() or [""]
        _BROKEN.append(f"{what}: {type(error).__name__}: {words[0]}")
        text = f"{_BROKEN[0]}. NumPy computes the same, slower for many points."
        warnings.warn(text, RuntimeWarning, stacklevel=3)
    return _BROKEN[0]


def _unusable() -> str:
    """Return why numba cannot be used, whatever the setting; an empty text if it can."""
    return _BROKEN[0] if _BROKEN else _missing()


@cache
def _missing() -> str:
    """Return the fault of the installation of numba; an empty text without one."""
    remedy = "pip install 'vizlight[fast]'"
    release_text = release_of("numba")
    if not release_text:
        return f"numba is not installed (try: {remedy})"
    release = tuple(int(part) for part in release_text.split(".")[:2] if part.isdigit())
    if release < OLDEST:
        return f"numba {release_text} is older than {OLDEST[0]}.{OLDEST[1]} (try: {remedy})"
    return ""


def release_of(package: str) -> str:
    """Return the version of an installed package; an empty text where it is missing."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


class Kernel(Generic[P, R]):
    """A function of numbers and arrays that numba compiles at its first call.

    Other kernels that it uses by name are compiled with it; mark small ones by ``inline=True``. An
    ``inline`` kernel becomes part of each function that calls it; ``rounding`` are changes of
    rounding that the compiler may make, such as ``ROUNDING``.
    """

    def __init__(
        self,
        function: Callable[P, R],
        *,
        inline: bool = False,
        rounding: frozenset[str] = frozenset(),
    ) -> None:
        self.function, self.inline, self.rounding = function, inline, rounding
        self.missed = 0.0
        self._compiled: Callable[P, R] | None = None
        self._proven = False
        self.__doc__ = function.__doc__

    def pays(self, saved: float) -> bool:
        """Return whether to call the kernel rather than NumPy code.

        It does once the seconds ``saved`` by this call, the start-up apart, and missed by earlier
        ones exceed half of the start-up.
        """
        if not active():
            return False
        self.missed += saved
        return wanted() == "1" or self.missed >= START_UP / 2

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call the compiled function.

        FailedError is raised if numba is not installed, or fails to compile or to run the function.
        A warning says so once, and no other function is compiled in this process: call NumPy code
        instead.
        """
        name = self.function.__name__
        if _unusable():
            raise FailedError(_check.message(name, "numba, see Kernel.pays", _unusable()))
        try:
            # A function that has run once is called without the lock, so that threads run it at the
            # same time.
            if self._proven and self._compiled is not None:
                return self._compiled(*args, **kwargs)
            # Others wait, in place of compiling the same function again.
            with _LOCK:
                result = self._first(*args, **kwargs)
                self._proven = True
        except Exception as error:
            reason = _give_up(f"numba failed with {name}", error)
            raise FailedError(
                _check.message(name, "a function that numba compiles", reason)
            ) from error
        return result

    def _first(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Compile the function, or read it from the disk, and call it."""
        try:
            return self._dispatcher()(*args, **kwargs)
        except _DAMAGED:
            # A file of the cache is damaged, or the function itself fails, which it does again.
            if (folder := self._folder()) is not None:
                # What is damaged goes, and the function is compiled anew.
                shutil.rmtree(folder, ignore_errors=True)
            self._compiled = None
            return self._dispatcher()(*args, **kwargs)
        except OSError:
            # The disk is full or cannot be read: the code stays in memory.
            self._compiled = self._compile(None)
            return self._compiled(*args, **kwargs)

    def _dispatcher(self) -> Callable[P, R]:
        """Return numba's own function."""
        with _LOCK:
            if self._compiled is None:
                self._compiled = self._compile(self._folder())
            return self._compiled

    def _compile(self, folder: Path | None) -> Callable[P, R]:
        """Return numba's own function, kept in a folder; None keeps it in memory alone."""
        import numba

        plain = self.function
        names = plain.__globals__ | {name: k._dispatcher() for name, k in self._helpers().items()}
        # numba reads names from the globals of the function, where kernels are not yet compiled.
        copy = types.FunctionType(
            plain.__code__, names, plain.__name__, plain.__defaults__, plain.__closure__
        )
        copy.__module__, copy.__qualname__ = plain.__module__, plain.__qualname__
        options = {
            # Threads run a kernel at the same time.
            "nogil": True,
            # Divisions by 0 give infinity or NaN, as in NumPy, and no exception.
            "error_model": "numpy",
            "fastmath": set(self.rounding),
            "forceinline": self.inline,
            # An inlined function is kept as a part of those that call it.
            "cache": folder is not None and not self.inline,
        }
        # numba takes its folder from a setting of the process, which the user's own functions need
        # back.
        before = numba.config.CACHE_DIR
        numba.config.CACHE_DIR = "" if folder is None else str(folder)
        try:
            result: Callable[P, R] = numba.njit(**options)(copy)
        finally:
            numba.config.CACHE_DIR = before
        return result

    def _helpers(self) -> dict[str, Kernel[..., object]]:
        """Return the kernels that the function calls, by name."""
        function = self.function
        values = {name: function.__globals__.get(name) for name in function.__code__.co_names}
        return {name: k for name, k in values.items() if isinstance(k, Kernel)}

    def _folder(self) -> Path | None:
        """Return the folder of this function's code as it stands, or None where none is kept."""
        # numba finds what it keeps by the file of a function, and keeps nothing of one without a
        # file.
        if not Path(self.function.__code__.co_filename).is_file():
            return None
        return _cache.folder(KERNELS, _key(self._sources()))

    def _sources(self) -> tuple[str, ...]:
        """Return the texts that make the code: its own file and its helpers' texts."""
        # numba itself looks at the function's own file alone, and would keep code with old kernels
        # inside.
        texts = [_text(self.function.__code__.co_filename), str(sorted(self.rounding))]
        for helper in self._helpers().values():
            texts += helper._sources()
        return tuple(dict.fromkeys(texts))


def kernel(
    *, inline: bool = False, rounding: frozenset[str] = frozenset()
) -> Callable[[Callable[P, R]], Kernel[P, R]]:
    """Return a decorator that makes a :class:`Kernel` of a function; see that class."""
    return lambda function: Kernel(function, inline=inline, rounding=rounding)


@lru_cache(maxsize=64)
def _text(path: str) -> str:
    """Return the text of a file."""
    return Path(path).read_text(encoding="utf-8")


@lru_cache(maxsize=64)
def _key(texts: tuple[str, ...]) -> str:
    """Return a name for code made of some texts, on this release of Python and numba."""
    about = [platform.python_version(), version("numba"), version("llvmlite"), *texts]
    return hashlib.sha256("\0".join(about).encode()).hexdigest()[:16]
