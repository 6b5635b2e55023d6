"""Ways to files of formats that no reader takes; nothing here needs NumPy."""

from __future__ import annotations

from pathlib import Path

from vizlight._words import message

#: Ends of names of packed files, which are read if the file in them is.
PACKED = (".gz", ".bz2", ".xz", ".zip")
#: Ways to files of other formats, by the ends of their names.
WAYS: dict[tuple[str, ...], str] = {
    PACKED: "unpack it first",
    (".pqr", ".fchk", ".molden"):
        "Open Babel makes a .pdb of it: obabel '{name}' -O '{stem}.pdb'",
    (".txt", ".xlsx", ".parquet", ".npy", ".npz"):
        "read its columns by NumPy or pandas, and look at a mesh of them: "
        "mesh = pyvista.PolyData(rows of x, y, z), mesh['name'] = values",
    (".fits", ".fit", ".fts"):
        "read its array by astropy, and look at an image of it: "
        "mesh = pyvista.ImageData(dimensions=(nx, ny, nz)), mesh['name'] = values.ravel()",
    (".geo",): "gmsh makes a mesh of it: gmsh -3 -format msh2 '{name}'",
    (".step", ".stp", ".iges", ".igs", ".brep"):
        "gmsh makes a mesh of it: gmsh -2 -clcurv 20 '{name}' -o '{stem}.stl'",
    (".dcd", ".trr", ".xtc", ".psf", ".prmtop", ".tpr", ".pdbqt", ".mmtf", ".bcif"):
        "write a state of the molecule as .pdb, .cif or .xyz, for example by MDAnalysis or VMD",
    (".blend", ".fbx", ".ifc", ".x3d"):
        "Assimp makes a .glb of it: assimp export '{name}' '{stem}.glb'",
}  # fmt: skip
USUAL_WAY = (
    "convert it to .vtu, .vti, .ply, .stl, .glb, .tif or .nc, or save a mesh of its numbers by "
    "PyVista: PolyData(points, faces) of a surface, ImageData of an image or a volume"
)


def reason(path: Path) -> str:
    """Return why no reader takes a file by the end of its name, and the way to one that is read."""
    suffix = path.suffix.lower()
    way = next((way for ends, way in WAYS.items() if suffix in ends), USUAL_WAY)
    way = way.replace("{name}", path.name).replace("{stem}", path.stem)
    return f"no reader takes '{path.suffix}' files; {way}"


def check(path: Path) -> None:
    """Raise ValueError for a file of a known format that no reader takes, before any is loaded."""
    suffix = path.suffix.lower()
    is_other = suffix not in PACKED and any(suffix in ends for ends in WAYS)
    if not is_other or not path.is_file():
        return
    with path.open("rb") as file:
        if file.read(4) == b"GRIB":  # whose names have any end
            return
    got = f"'{path}' ({reason(path)})"
    raise ValueError(message("file", "a mesh that PyVista reads", got))
