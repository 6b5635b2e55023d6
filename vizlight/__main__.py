"""``python -m vizlight`` and the command ``vizlight``: the command line in a child process."""

from __future__ import annotations

import gc
import importlib
import signal
import sys
from types import ModuleType

__all__ = ["main"]


def main() -> int:
    """Run the command line and return its exit code."""
    # Until the command line is loaded Ctrl-C ends the process without a traceback.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from vizlight import _supervise

    return _supervise.run(_command_line)


class _Late(ModuleType):
    """A module that is loaded when something of it is used."""

    def __getattr__(self, name: str) -> object:
        # The import system, and what looks through all modules, asks for names like "__file__".
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(self.__name__) is self:
            del sys.modules[self.__name__]
        value: object = getattr(importlib.import_module(self.__name__), name)
        return value


def _command_line() -> int:
    # Modules leave no garbage while they load: to look for it takes a quarter of a short job.
    gc.disable()
    # PyVista imports it for its charts alone, a third of the time that its plotting takes to load.
    sys.modules.setdefault("matplotlib.pyplot", _Late("matplotlib.pyplot"))
    try:
        from vizlight import cli
    except KeyboardInterrupt:
        sys.stderr.write("vizlight: interrupted\n")
        return 2
    return cli.main()


if __name__ == "__main__":
    sys.exit(main())
