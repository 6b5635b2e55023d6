"""Meshes from files, parts of meshes, and files from meshes: one place for scripts.

Readers are in ``vizlight/reading/``, the rest in ``vizlight/mesh/`` and ``vizlight/writing.py``.
"""

from __future__ import annotations

from vizlight.mesh.creases import borders, creases
from vizlight.mesh.cutaways import cut_open, without_corner
from vizlight.mesh.derived import layer_of, layers, stretched, surface_of, warped, with_vectors
from vizlight.mesh.fills import without_fills
from vizlight.mesh.montages import side_by_side
from vizlight.mesh.nspace import with_last_coordinate
from vizlight.mesh.stresses import with_von_mises
from vizlight.mesh.walls import obstacles, walls
from vizlight.reading.molecules import atoms_in, backbone, ligands
from vizlight.reading.paths import FileError
from vizlight.reading.reader import read, read_parts
from vizlight.writing import write_mesh

__all__ = [
    "FileError", "atoms_in", "backbone", "borders", "creases", "cut_open", "layer_of", "layers",
    "ligands", "obstacles", "read", "read_parts", "side_by_side", "stretched", "surface_of",
    "walls", "warped", "with_last_coordinate", "with_vectors", "with_von_mises", "without_corner",
    "without_fills", "write_mesh",
]  # fmt: skip
