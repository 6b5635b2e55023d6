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


#: Modules that PyVista imports for its charts alone, half of the time that its plotting takes.
_OF_CHARTS = ("matplotlib.pyplot", "matplotlib.backends.backend_agg")


class _Late(ModuleType):
    """A module that is loaded when something of it is used."""

    def __getattr__(self, name: str) -> Foreign:
        # The import system, and what looks through all modules, asks for names like "__file__".
        if name.startswith("__"):
            raise AttributeError(name)
        for late in _OF_CHARTS:
            if isinstance(sys.modules.get(late), _Late):
                del sys.modules[late]
        return getattr(importlib.import_module(self.__name__), name)

    def FigureCanvasAgg(self, figure: object) -> Foreign:  # noqa: N802 - imported by its name
        """Return a canvas for a figure, by the class that PyVista imports and rarely calls."""
        return self.__getattr__("FigureCanvasAgg")(figure)


def _command_line() -> int:
    # Modules leave no garbage while they load: to look for it takes a quarter of a short job.
    gc.disable()
    for name in _OF_CHARTS:
        sys.modules.setdefault(name, _Late(name))
    try:
        from vizlight import cli
    except KeyboardInterrupt:
        sys.stderr.write("vizlight: interrupted\n")
        return 2
    return cli.main()


if __name__ == "__main__":
    sys.exit(main())
