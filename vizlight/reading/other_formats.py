"""Ways to files of formats that no reader takes; nothing here needs NumPy."""

from __future__ import annotations

import re
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
    (".hdf5", ".he5"):
        "look at an array of it by xarray: vizlight.look(xarray.open_dataset('{name}', "
        "group='...'))",
    (".e57",):
        "CloudCompare makes a .las of it: "
        "CloudCompare -SILENT -O '{name}' -C_EXPORT_FMT LAS -SAVE_CLOUDS",
    (".par", ".rec"): "dcm2niix makes a .nii of it: dcm2niix '{name}'",
    (".geo",): "gmsh makes a mesh of it: gmsh -3 -format msh2 '{name}'",
    (".step", ".stp", ".iges", ".igs", ".brep"):
        "gmsh of pip makes a mesh of it: gmsh -2 -bin -clcurv 48 '{name}' -o '{stem}.stl'",
    (".dcd", ".trr", ".xtc", ".psf", ".prmtop", ".tpr", ".pdbqt", ".mmtf", ".bcif"):
        "write a state of the molecule as .pdb, .cif or .xyz, for example by MDAnalysis or VMD",
    (".geojson", ".topojson", ".gpkg", ".shp", ".kml"):
        "GDAL makes a raster of a number of its features: "
        "gdal_rasterize -a NAME -ts 1000 1000 '{name}' '{stem}.tif'",
    (".cdb",):
        "ansys-mapdl-reader makes a .vtu of it: "
        "ansys.mapdl.reader.Archive('{name}').grid.save('{stem}.vtu')",
    (".blend", ".fbx", ".ifc", ".x3d"):
        "Assimp makes a .glb of it: assimp export '{name}' '{stem}.glb'",
}  # fmt: skip
USUAL_WAY = (
    "convert it to .vtu, .vti, .ply, .stl, .glb, .tif or .nc, or save a mesh of its numbers by "
    "PyVista: PolyData(points, faces) of a surface, ImageData of an image or a volume"
)
#: Formats that share the end of a name with one that is read, by their first bytes.
CONTENTS: dict[tuple[str, ...], tuple[tuple[re.Pattern[bytes], str], ...]] = {
    (".mesh",): ((
        re.compile(rb"MFEM (NC |NURBS |INLINE )?mesh"),
        "a mesh of MFEM; MFEM and GLVis write a .vtu or .vtk file of it",
    ),),
    (".asc",): ((
        re.compile(rb"\s*(;[^\n]*\s+)*\("),
        "a neuron of Neurolucida; morph-tool makes a .swc of it: "
        "morph-tool convert file '{name}' '{stem}.swc'",
    ),),
    (".xml",): ((
        re.compile(rb"(?s)(?!.*<dolfin)"),
        "no mesh of DOLFIN, of which files of this name are read; write its numbers as .csv",
    ),),
    (".cdf",): ((
        re.compile(rb"\xcd\xf3\0\x01|\xcd\xf2\x60\x02"),
        "CDF of NASA; cdflib makes a dataset of it: "
        "vizlight.look(cdflib.xarray.cdf_to_xarray('{name}'))",
    ),),
    (".msh",): ((
        re.compile(rb"(?i)(\s*#[^\n]*\n)*\s*mesh\b"),
        "a mesh of GiD; the program that computes on it writes .vtk, as Kratos by its "
        "vtk_output_process",
    ),),
    (".hdf", ".h5", ".nc"): ((
        re.compile(rb"\x0e\x03\x13\x01"),
        "HDF4, as of MODIS; GDAL names its grids and makes a raster of one: gdalinfo '{name}', "
        "gdal_translate NAME_OF_GRID '{stem}.tif'",
    ),),
    (".dat", ".tec"): (
        (re.compile(rb"\s*(ASCII|BINARY) [^\n]*\n!File started"),
         "a result of Elmer; ElmerSolver writes .vtu by ResultOutputSolve"),
        (re.compile(rb"\xec\x2b\x08\0|\0\x08\x2b\xec"),
         "a restart of SU2; SU2_SOL writes a .vtu of it"),
    ),
}  # fmt: skip
#: Bytes of a file that are looked at.
_HEAD = 1 << 12


def of_content(path: Path) -> str:
    """Return the name of a format that no reader takes, by the content of a file, and a way."""
    suffix = path.suffix.lower()
    heads = next((heads for ends, heads in CONTENTS.items() if suffix in ends), ())
    if not heads or not path.is_file():
        return ""
    with path.open("rb") as file:
        begin = file.read(_HEAD)
    way = next((way for pattern, way in heads if pattern.match(begin)), "")
    return way.replace("{name}", path.name).replace("{stem}", path.stem)


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
