"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh."""

from vizlight.filters._provenance import provenance
from vizlight.filters.illuminate import illuminate

__all__ = ["illuminate", "provenance"]
