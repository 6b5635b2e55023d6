"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh."""

from vizlight.filters._fur import fur
from vizlight.filters._illuminate import illuminate
from vizlight.filters._isoluminance import isoluminance
from vizlight.filters._provenance import provenance
from vizlight.filters._satin import satin
from vizlight.filters._streamlines import streamlines

__all__ = ["fur", "illuminate", "isoluminance", "provenance", "satin", "streamlines"]
