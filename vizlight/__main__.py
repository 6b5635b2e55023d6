"""``python -m vizlight`` and the command ``vizlight``: the command line in a child process."""

from __future__ import annotations

import gc
import signal
import sys

__all__ = ["main"]


def main() -> int:
    """Run the command line and return its exit code."""
    # Until the command line is loaded Ctrl-C ends the process without a traceback.
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from vizlight import _supervise

    return _supervise.run(_command_line)


def _command_line() -> int:
    # Modules leave no garbage while they load: to look for it takes a quarter of a short job.
    gc.disable()
    try:
        from vizlight import cli
    except KeyboardInterrupt:
        sys.stderr.write("vizlight: interrupted\n")
        return 2
    return cli.main()


if __name__ == "__main__":
    sys.exit(main())
