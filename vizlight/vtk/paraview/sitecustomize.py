"""Lets ParaView's Python import vizlight, and nothing else from beside it.

Put this folder on PYTHONPATH: Python imports this file at its start. The packages beside vizlight,
which belong to another Python, would stand in the way of ParaView's own NumPy and VTK. Besides,
ParaView 5.11 of Debian calls inspect.getargspec, which its Python 3.11 no longer has.
"""

import importlib.util
import inspect
import sys
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[2]

if not hasattr(inspect, "getargspec"):
    inspect.getargspec = inspect.getfullargspec


class VizlightFinder:
    """Finds vizlight beside this file, where no other is installed."""

    @staticmethod
    def find_spec(name, *_):
        """Return the specification of the package, None for other modules."""
        if name != "vizlight":
            return None
        return importlib.util.spec_from_file_location(name, PACKAGE / "__init__.py")


# Last of all, so that a vizlight which is installed comes first.
sys.meta_path.append(VizlightFinder)
