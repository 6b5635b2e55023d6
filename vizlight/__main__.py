"""``python -m vizlight`` and the command ``vizlight``: the command line in a child process."""

from __future__ import annotations

import gc
import importlib
import signal
import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from vizlight._types import Foreign

__all__ = ["main"]


def main() -> int:
    """Run the command line and return its exit code."""
    # Until the command line is loaded Ctrl-C ends the process without a traceback.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from vizlight import _supervise

    return _supervise.run(_command_line)


class _Late(ModuleType):
    """A module that is loaded when something of it is used, but for a class that is only named."""

    def __init__(self, name: str, *classes: str) -> None:
        super().__init__(name)
        for cls in classes:
            setattr(self, cls, lambda *values, cls=cls: self.__getattr__(cls)(*values))

    def __getattr__(self, name: str) -> Foreign:
        # The import system, and what looks through all modules, asks for names like "__file__".
        if name.startswith("__"):
            raise AttributeError(name)
        for late in _LATE:
            if sys.modules.get(late.__name__) is late:
                del sys.modules[late.__name__]
        return getattr(importlib.import_module(self.__name__), name)


#: Modules that PyVista imports for its charts alone, half of the time that its plotting takes.
_LATE = (
    _Late("matplotlib.pyplot"),
    _Late("matplotlib.backends.backend_agg", "FigureCanvasAgg"),
)


def _command_line() -> int:
    # Modules leave no garbage while they load: to look for it takes a quarter of a short job.
    gc.disable()
    for late in _LATE:
        sys.modules.setdefault(late.__name__, late)
    try:
        from vizlight import cli
    except KeyboardInterrupt:
        sys.stderr.write("vizlight: interrupted\n")
        return 2
    return cli.main()


if __name__ == "__main__":
    sys.exit(main())
