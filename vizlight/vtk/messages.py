"""Messages of VTK in a block of code, each as one line."""

from __future__ import annotations

import contextlib
import logging
import re
import struct
import sys
import threading
from collections.abc import Iterator

from vtkmodules.util.misc import calldata_type
from vtkmodules.util.vtkConstants import VTK_STRING
from vtkmodules.vtkCommonCore import vtkLogger, vtkOutputWindow, vtkStringOutputWindow

from vizlight._types import Foreign

#: Where VTK says that an error or a warning arose, which stands before what it says.
_ORIGIN = re.compile(r"\A[\w ]+: In .*, line \d+\s+(?:\S+ \(\w+\): )?")
#: Where an object of VTK is in memory, and what it was asked for.
_ADDRESS = re.compile(r" \(0x[0-9a-f]+\)| for request: vtkInformation.*| when asked by REQUEST.*")


def first_line(error: Exception | str) -> str:
    """Return the first line with words of a message."""
    return next((line.strip() for line in str(error).splitlines() if line.strip()), "no reason")


#: What Python and NumPy say of words that are no numbers.
_NO_NUMBER = re.compile(
    r"(?:invalid literal for int\(\) with base \d+|could not convert string(?: \S+)? to \w+): (.*)"
)
#: Errors by which readers stop where they do not check what they follow: their words are of code.
_OF_CODE = (
    ArithmeticError, AssertionError, AttributeError, LookupError, RecursionError, TypeError,
    struct.error,
)  # fmt: skip


def reason(error: BaseException) -> str:
    """Return why a reader refuses a file, in words."""
    text = first_line(str(error)) if str(error).strip() else ""
    kind = type(error).__name__
    if isinstance(error, UnicodeDecodeError):
        byte = error.object[error.start]
        return f"a text in it has the byte 0x{byte:02x}, which is not of {error.encoding.upper()}"
    if isinstance(error, MemoryError):
        return "it asks for more memory than there is"
    if isinstance(error, _OF_CODE) or not text:
        return f"its parts do not fit together, by {kind}{text and f': {text}'}"
    if error.__cause__ is not None and "See previous exception" in text:  # of rasterio
        return reason(error.__cause__)
    if word := _NO_NUMBER.match(text):
        return f"a word stands where a number should be: {word[1]}"
    return (isinstance(error, OSError) and error.strerror) or text


class _Messages:
    """Messages of VTK while files are read and written, for each thread its own.

    VTK has one window for the messages of a process. It is replaced while any thread listens;
    messages from other threads are passed on to the earlier window. No stream is redirected.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._heard: dict[int, list[list[str]]] = {}
        self._replaced: tuple[vtkOutputWindow, vtkLogger.Verbosity] | None = None

    @contextlib.contextmanager
    def collected(self) -> Iterator[list[str]]:
        """Collect the errors and warnings of VTK that arise in this thread, each as one line."""
        thread = threading.get_ident()
        errors: list[str] = []
        with self._lock:
            # The first that listens puts its window in place of the user's, and the last one puts
            # that back.
            if self._replaced is None:
                self._replaced = (
                    vtkOutputWindow.GetInstance(),
                    vtkLogger.GetCurrentVerbosityCutoff(),
                )
                listening = vtkStringOutputWindow()
                heard: Foreign = self._note
                for event in ("ErrorEvent", "WarningEvent"):
                    listening.AddObserver(event, heard)  # type: ignore[arg-type]
                vtkOutputWindow.SetInstance(listening)
                # VTK's logger would print each message to standard error beside that.
                vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
                logging.getLogger().addFilter(self._is_of_others)
            # One thread may listen in several contexts: the innermost hears.
            self._heard.setdefault(thread, []).append(errors)
        try:
            yield errors
        finally:
            with self._lock:
                open_lists = self._heard[thread]
                open_lists.pop()
                if not open_lists:
                    del self._heard[thread]
                if not self._heard and self._replaced is not None:
                    window, verbosity = self._replaced
                    self._replaced = None
                    vtkOutputWindow.SetInstance(window)
                    vtkLogger.SetStderrVerbosity(verbosity)
                    logging.getLogger().removeFilter(self._is_of_others)

    def _is_of_others(self, record: logging.LogRecord) -> bool:
        """Return whether a record is none by which PyVista repeats the messages of this thread."""
        return record.module != "observers" or threading.get_ident() not in self._heard

    @calldata_type(VTK_STRING)  # type: ignore[no-untyped-call, untyped-decorator]
    def _note(self, _window: object, event: str, text: str | None) -> None:
        text = text or "words that are no text"
        open_lists, replaced = self._heard.get(threading.get_ident()), self._replaced
        if open_lists:
            open_lists[-1].append(first_line(_ADDRESS.sub("", _ORIGIN.sub("", text))))
        elif replaced is not None:
            sys.stderr.write(text)
            replaced[0].InvokeEvent(event, text)


captured_errors = _Messages().collected
