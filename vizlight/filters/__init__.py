"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh."""

from vizlight.filters._illuminate import illuminate
from vizlight.filters._provenance import provenance

__all__ = ["illuminate", "provenance"]
