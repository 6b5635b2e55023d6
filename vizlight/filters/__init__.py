"""PyVista in, PyVista out: arrays are taken from a mesh, lit, and attached to a new mesh."""

from vizlight.filters.bas_relief import bas_relief
from vizlight.filters.bas_relief import relief_from_mesh as relief_from_mesh
from vizlight.filters.fur import fur
from vizlight.filters.illuminate import illuminate
from vizlight.filters.isoluminance import isoluminance
from vizlight.filters.manifold import manifold
from vizlight.filters.pathlines import pathlines
from vizlight.filters.project import project
from vizlight.filters.refine import refine
from vizlight.filters.relief_day import relief_day
from vizlight.filters.relief_shadow import relief_shadow
from vizlight.filters.satin import satin
from vizlight.filters.solids import to_polydata
from vizlight.filters.streamlines import streamlines
from vizlight.filters.tint import displayable as displayable
from vizlight.filters.tint import tint
from vizlight.filters.tint import unlit_colors as unlit_colors
from vizlight.mesh.records import provenance

__all__ = [
    "bas_relief",
    "fur",
    "illuminate",
    "isoluminance",
    "manifold",
    "pathlines",
    "project",
    "provenance",
    "refine",
    "relief_day",
    "relief_shadow",
    "satin",
    "streamlines",
    "tint",
    "to_polydata",
]
