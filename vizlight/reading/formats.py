"""The table of formats: the reader of each suffix, its check for damage, the package it needs.

Files of other suffixes are left to PyVista.
"""

from __future__ import annotations

import contextlib
import importlib.util
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO, NamedTuple

import pyvista as pv
from pyvista.core.utilities.reader import CLASS_READERS
from vtkmodules.vtkIOXML import vtkXMLPPolyDataReader

from vizlight.reading import (
    abaqus,
    brains,
    cf_grids,
    containers,
    cubes,
    density_maps,
    dicom,
    ensight,
    file_parts,
    geomview,
    gltf,
    kratos,
    lammps,
    legacy_vtk,
    meshers,
    molecule_files,
    molecules,
    neurons,
    pictures,
    ply,
    point_clouds,
    rasters,
    references,
    scans,
    scene_files,
    seismic,
    series,
    stl,
    studio_3ds,
    su2,
    tables,
    tetgen,
    tracts,
    vtk_xml,
    wavefront,
    xml_scenes,
)

#: Number of bytes at the start of a file that show whether it is one of Abaqus.
_INP_HEAD = 64
#: Extra that installs a package, if one does.
EXTRAS = {
    "nibabel": "tracts", "trx-python": "tracts", "laspy": "formats", "gemmi": "formats",
    "xarray": "formats", "h5py": "formats", "meshio": "formats", "rasterio": "maps",
}  # fmt: skip
#: Name under which a package is imported, where that is another.
MODULES = {"trx-python": "trx.trx_file_memmap"}
#: Modules that a package loads when it reads a file.
_TOGETHER = {"xarray": ("xarray", "cf_xarray", "netCDF4", "dask")}
#: Packages after which PyVista is tried, and in the end another format is proposed.
_MESHERS = ("meshio", "h5py")
#: Ends of names of indices of pieces, all of which are read.
_INDICES = (".vtm", ".pvti", ".pvtp", ".pvtr", ".pvts", ".pvtu")

Mesh = pv.DataSet | pv.MultiBlock


class Format(NamedTuple):
    """A format of files.

    ``suffixes`` are ends of names, ``read`` is None where a file is left to PyVista, and
    ``package`` reads it. ``missing_part`` returns the part that an open file lacks of the size or
    the end that it states, or "": faults that its reader overlooks, ends the process by, or never
    ends on.
    """

    suffixes: tuple[str, ...]
    read: Callable[[Path], Mesh | None] | None = None
    missing_part: Callable[[BinaryIO], str] | None = None
    package: str = ""


def _by_meshio(path: Path) -> Mesh | None:
    return None if missing(path) else meshers.read(path)


def _of_mesh(path: Path) -> Mesh | None:
    return geomview.read_mesh(path) if geomview.is_mesh(path) else _by_meshio(path)


def _of_msh(path: Path) -> Mesh | None:
    """Return a mesh of Fluent or of Abaqus, which may have the suffix of gmsh, or one of meshio."""
    if file_parts.first_bytes(path, _INP_HEAD).lstrip().startswith(b"("):
        zones: Mesh = series.unchecked(
            pv.get_reader(path, force_ext=".cas")  # type: ignore[no-untyped-call]
        )
        return zones
    mesh = _of_inp(path)
    return _by_meshio(path) if mesh is None else mesh


def _of_inp(path: Path) -> Mesh | None:
    """Return a mesh of Abaqus; None for one of AVS, for which PyVista takes both."""
    is_abaqus = file_parts.first_bytes(path, _INP_HEAD).lstrip().startswith(b"*")
    return abaqus.read(path) if is_abaqus else None


def _of_pieces(path: Path) -> Mesh:
    """Return a surface in pieces; PyVista has readers for those of grids alone."""
    reader = vtkXMLPPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    mesh: pv.PolyData = pv.wrap(reader.GetOutput())
    # As its readers do, for arrays of booleans.
    mesh._restore_metadata()
    return mesh


#: Formats by their suffixes; of two rows with one suffix the first counts.
TABLE = (
    # Lines, points and surfaces
    Format((".trk", ".tck"), tracts.read, package="nibabel"),
    Format((".trx",), tracts.read_trx, containers.missing_of_zip, "trx-python"),
    Format((".swc",), neurons.read),
    Format((".pts", ".xyz"), point_clouds.read_scan),
    Format((".las", ".laz"), point_clouds.read_las, point_clouds.missing_of_las, "laspy"),
    Format((".pcd",), point_clouds.read_pcd),
    Format(tables.SUFFIXES, tables.read),
    Format((".obj",), wavefront.read, wavefront.missing_part),
    Format((".off",), geomview.read_off),
    Format((".ply",), ply.read),
    Format((".stl",), None, stl.missing_part),
    Format((".tri",), brains.read_tri),
    Format((".3ds",), studio_3ds.read),
    Format((".dae",), xml_scenes.read_collada),
    Format((".3mf",), xml_scenes.read_3mf),
    Format((".glb", ".gltf"), None, gltf.missing_part),
    Format(scene_files.SUFFIXES, scene_files.read),
    # Bodies, whose surfaces and volumes are known by more than a suffix: see _of_brain
    Format((".gii",), None, brains.missing_of_gifti, "nibabel"),
    Format((".nii", ".img"), package="nibabel"),
    Format((".mgz",), None, containers.missing_of_gzip, "nibabel"),
    Format((".gz",), None, containers.missing_of_gzip),
    Format((".nrrd", ".nhdr"), scans.read_nrrd, scans.missing_of_nrrd),
    Format((".mha", ".mhd"), scans.read_meta, scans.missing_of_meta),
    Format((".dcm",), dicom.read),
    # Molecules and crystals
    Format((".pdb", ".ent"), molecules.of_pdb),
    Format((".cif", ".mmcif", ".pdbx"), molecules.of_cif, package="gemmi"),
    Format((".lammpstrj", ".dump"), lammps.read),
    Format((".gro",), molecule_files.of_gro),
    Format((".mol2",), molecule_files.of_mol2),
    Format((".mol", ".sdf"), molecule_files.of_mol),
    Format((".cube",), cubes.read),
    Format((".dx",), cubes.read_dx),
    Format(density_maps.SUFFIXES, density_maps.read, package="gemmi"),
    # Grids and images; options of read choose among their contents
    Format(cf_grids.NETCDF, None, containers.missing_of_netcdf, "xarray"),
    Format(cf_grids.GRIB, None, containers.missing_of_grib, "cfgrib"),
    Format(cf_grids.ZARR, package="zarr"),
    Format((".grd",), None, containers.missing_of_netcdf, "rasterio"),
    Format(rasters.SUFFIXES, package="rasterio"),
    Format((".dem",), rasters.read_dem),
    Format(seismic.SUFFIXES, seismic.read),
    Format((".png",), None, pictures.missing_of_png),
    Format((".bmp",), None, pictures.missing_of_bmp),
    Format((".pnm", ".pgm", ".ppm"), None, pictures.missing_of_pnm),
    # Cells of meshers and solvers
    Format(tetgen.SUFFIXES, tetgen.read),
    Format((".su2",), su2.read),
    Format((".inp",), _of_inp, meshers.missing_of_avs),
    Format((".ucd",), meshers.read_avs, meshers.missing_of_avs),
    Format((".avs",), _by_meshio, meshers.missing_of_avs, "meshio"),
    Format((".mdpa",), kratos.read, kratos.missing_part),
    Format((".tec",), _by_meshio, meshers.missing_of_tecplot, "meshio"),
    Format((".dat",), None, meshers.missing_of_tecplot),
    Format((".mesh",), _of_mesh, package="meshio"),
    Format((".msh",), _of_msh, package="meshio"),
    Format(
        (".bdf", ".f3grid", ".fem", ".meshb", ".nas", ".post", ".ugrid", ".vol", ".wkt", ".xmf"),
        _by_meshio, package="meshio",
    ),
    Format((".h5m", ".med", ".mmed"), _by_meshio, package="h5py"),
    Format((".case",), None, ensight.missing_part),
    Format((".foam",), None, series.missing_of_foam),
    Format((".e", ".ex2", ".exo", ".exii"), None, containers.missing_of_netcdf),
    # Formats of VTK
    Format((".vtk",), None, legacy_vtk.missing_part),
    Format((".hdf", ".vtkhdf"), None, containers.missing_of_vtkhdf),
    Format((".vtm",), None, vtk_xml.missing_block),
    Format((".vti", ".vtr", ".vts"), None, vtk_xml.missing_piece),
    Format((".pvtp",), _of_pieces, vtk_xml.missing_part),
    Format((".vtp", ".vtu", ".pvti", ".pvtr", ".pvts", ".pvtu"), None, vtk_xml.missing_part),
)  # fmt: skip
#: Files that are whole, but of another format than their name says.
OTHERS = {meshers.NO_TECPLOT: "a file of Tecplot", containers.NO_VTKHDF: "a mesh of VTK in HDF5"}
_BY_SUFFIX = {suffix: row for row in reversed(TABLE) for suffix in row.suffixes}


def of(path: Path) -> Format:
    """Return the format of a file by the end of its name."""
    suffix = path.suffix.lower()
    return _BY_SUFFIX.get(suffix, Format((suffix,)))


def missing_part(path: Path, /) -> str:
    """Return the part that a file lacks of the size or the end that it states.

    It is the reason why the file cannot be whole, empty if it may be, or is of another format.
    """
    check = of(path).missing_part
    if check is None:
        return ""
    with path.open("rb") as file:
        try:
            lacking = check(file)
            if not lacking and path.suffix.lower() in _INDICES:
                pieces = [piece for piece in references.named(path) if piece != path]
                parts = ((at.name, missing_part(at)) for at in pieces if at.is_file())
                lacking = next((f"'{name}': {reason}" for name, reason in parts if reason), "")
        except Exception as error:  # noqa: BLE001 - of any type, by what is damaged
            return f"its header cannot be read: {error}"
    return lacking


def missing(path: Path) -> str:
    """Return the remedy for a file that needs a missing package, else an empty text."""
    package = of(path).package
    if not package:
        return ""
    # By an import, since a package that is installed may still fail to load.
    try:
        importlib.import_module(MODULES.get(package, package))
    except ImportError:
        name = f"vizlight[{EXTRAS[package]}]" if package in EXTRAS else package
        return f"{path.suffix.lower()} files are read by {package}: run pip install '{name}'"
    return ""


def load(path: Path) -> None:
    """Load the packages that read a file, which forks of this process then need not do again."""
    package = of(path).package
    for name in _TOGETHER.get(package, (MODULES.get(package, package),) if package else ()):
        with contextlib.suppress(Exception):  # whoever reads the file says that it is missing
            importlib.import_module(name)


def way_out(path: Path) -> str:
    """Return the remedy for a file that no reader takes: a package, or another format."""
    if of(path).package not in _MESHERS:
        return missing(path)
    return missing(path) or "save it as .vtu, .vtk or .stl by the program that wrote it"


def has_reader(path: Path) -> bool:
    """Return whether a file can be read by the end of its name."""
    # Packed files have their kind before the suffix of the packer.
    suffixes = {suffix.lower() for suffix in path.suffixes[-2:]}
    ours = {suffix for suffix, row in _BY_SUFFIX.items() if row.read or row.package}
    return not suffixes.isdisjoint({*CLASS_READERS, *ours}) and path.is_file()


def read(
    path: Path,
    time: object = None,
    *,
    at: Mapping[str, object] | None = None,
    nodata: float | None = None,
) -> Mesh | None:
    """Return the mesh of a file that PyVista cannot read; None where it is left to PyVista."""
    suffix = path.suffix.lower()
    # GMT's grids are netCDF mostly, and those of other programs rasters.
    if suffix in cf_grids.SUFFIXES or (
        suffix == ".grd" and file_parts.first_bytes(path, 4)[:3] in (b"CDF", b"\x89HD")
    ):
        return cf_grids.read(path, time, at, nodata)
    if at:
        raise ValueError(f"at: expected a netCDF file beside it, got a {suffix} file; leave it out")
    if nodata is not None and suffix not in rasters.SUFFIXES:
        expected = "expected a netCDF file or a raster beside it"
        raise ValueError(f"nodata: {expected}, got a {suffix} file; leave it out")
    reader = of(path).read
    mesh = reader(path) if reader else _of_brain(path, time)
    if mesh is None and suffix in rasters.SUFFIXES:
        mesh = rasters.read(path, nodata)
    if mesh is not None and series.TIME not in mesh.field_data:
        series.check_single(path, time)
    return mesh


def _of_brain(path: Path, time: object) -> Mesh | None:
    """Return the mesh of a file that its whole name tells to be of a brain."""
    name = path.name.lower()
    if name.endswith((".tt", ".tt.gz")):
        return tracts.read_tt(path)
    if name.endswith(brains.SURFACES) or brains.is_freesurfer(path):
        return brains.read(path)
    if name.endswith(brains.VOLUMES) or brains.is_pair(path):
        return brains.volume(path, time)
    return None
