"""Light the hostile files in unusual environments: ``python tests/environments.py [NAME ...]``.

Python without assertions, warnings as errors, the C locale, and a home that cannot be written: in
each of them the command line gives the same exit codes and lines.
"""

import sys
import tempfile
from pathlib import Path

from hostile import corpus

ENVIRONMENTS = {
    "optimised": {"options": ("-O",)},
    "warnings": {"environment": {"PYTHONWARNINGS": "error"}},
    "locale": {"environment": {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}},
    "home": {"environment": {"HOME": "/proc/none", "XDG_CACHE_HOME": "/proc/none/cache"}},
}


def main(names):
    """Light the files in the environments of some names; the exit code is 1 if one is wrong."""
    failed = 0
    for name in names or ENVIRONMENTS:
        with tempfile.TemporaryDirectory() as folder:
            wrong = corpus.faults(Path(folder), **ENVIRONMENTS[name])
        lines = "".join(f"  {line}\n" for line in wrong)
        sys.stdout.write(f"{name}: {len(corpus.CASES)} files, {len(wrong)} wrong\n{lines}")
        failed += len(wrong)
    return int(bool(failed))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
