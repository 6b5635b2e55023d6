"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh."""

from vizlight.filters._bas_relief import relief_from_mesh
from vizlight.filters._fur import fur
from vizlight.filters._illuminate import illuminate
from vizlight.filters._isoluminance import isoluminance
from vizlight.filters._manifold import manifold
from vizlight.filters._project import project
from vizlight.filters._provenance import provenance
from vizlight.filters._relief import relief_day, relief_shadow
from vizlight.filters._satin import satin
from vizlight.filters._streamlines import streamlines

__all__ = [
    "fur",
    "illuminate",
    "isoluminance",
    "manifold",
    "project",
    "provenance",
    "relief_day",
    "relief_from_mesh",
    "relief_shadow",
    "satin",
    "streamlines",
]
