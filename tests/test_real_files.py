"""The first picture on files that others made, or tools of their fields."""

from __future__ import annotations

import contextlib
import gzip
import io
import os
import shlex
from pathlib import Path
from typing import NamedTuple

import foam
import numpy as np
import pytest
import pyvista as pv
from PIL import Image

from vizlight import cli


class Real(NamedTuple):
    """A file, the package that carries it, and the command after ``vizlight``."""

    package: str
    path: str
    command: str = "light FILE"


def slow(real: Real):
    """Mark a file whose picture takes seconds."""
    return pytest.param(real, marks=pytest.mark.slow)


#: Endings of a part that PyVista and meshio write.
DRAWN = (".stl", ".vtp", ".obj", ".wrl", ".glb")
MESHIO = (".msh", ".off", ".inp", ".mesh", ".vtu", ".bdf")
FILES = [
    *(Real("pyvista", f"examples/{name}") for name in ("airplane.ply", "ant.ply", "nut.ply")),
    Real("pyvista", "examples/sphere.ply", "contours FILE"),
    Real("pyvista", "examples/globe.vtk"),
    Real("pyvista", "examples/hexbeam.vtk", "light FILE --scalars sample_cell_scalars"),
    Real("pyvista", "examples/uniform.vtk", "light FILE --scalars 'Spatial Cell Data'"),
    Real("pyvista", "examples/rectilinear.vtk"),
    slow(Real("pyvista", "examples/channels.vti", "light FILE --contour facies --level 2.5")),
    slow(
        Real("pyvista", "examples/frog_tissues.vti", "light FILE --contour MetaImage --level 14.5")
    ),
    *(
        Real("nibabel", f"tests/data/{name}")
        for name in ("standard.trk", "standard.LPS.trk", "standard.tck")
    ),
    Real("nibabel", "gifti/tests/data/ascii.gii"),
    slow(Real("data", "Data/carotid.vtk", "streamlines FILE --tangents vectors")),
    slow(Real("data", "Data/SainteHelens.dem", "relief FILE --light 315,20")),
    Real("made", "int16.tif", "relief FILE"),
    Real("made", "tiled.tif", "relief FILE"),
    Real("made", "degrees.tif", "relief FILE"),
    Real("made", "degrees.tif", "light FILE --warp elevation"),
    Real("made", "rotated.tif", "relief FILE"),
    Real("made", "bands.tif", "relief FILE"),
    Real("made", "grid.asc", "relief FILE"),
    Real("made", "ascii.gii.gz"),
    Real("made", "lh.pial"),
    slow(Real("made", "case/case.foam", "streamlines FILE")),
    Real("made", "scan.ply"),
    *(Real("made", f"part{suffix}") for suffix in (*DRAWN, *MESHIO)),
    Real("made", "part.stl", "fur FILE --fibres 2000"),
    Real("made", "map.nc", "relief FILE"),
]


def make(folder: Path) -> None:
    """Make files with the tools of their fields, as far as these are installed."""
    y, x = 2 * np.mgrid[:45, :60]
    heights = 600 + 200 * np.sin(x / 17) * np.cos(y / 23) + 40 * np.sin((x + 2 * y) / 7)
    with contextlib.suppress(ImportError):
        _rasters(folder, heights)
    with contextlib.suppress(ImportError):
        import xarray

        axes = {"lat": 47 - np.arange(45) / 1200, "lon": 11 + np.arange(60) / 1200}
        grid = xarray.Dataset({"height": (("lat", "lon"), heights)}, coords=axes)
        grid.to_netcdf(folder / "map.nc", engine="scipy")
    with contextlib.suppress(ImportError):
        import nibabel

        ball = pv.Sphere()
        small = Path(nibabel.__file__).parent / "gifti/tests/data/ascii.gii"
        (folder / "ascii.gii.gz").write_bytes(gzip.compress(small.read_bytes()))
        nibabel.freesurfer.write_geometry(folder / "lh.pial", ball.points, ball.regular_faces)

    foam.write(
        folder / "case", [0, 1], lambda t, p: {"U": t * np.cross(p - 0.5, (0.2, 0.1, 1))}, n=8
    )
    pv.PolyData(np.asarray(pv.Sphere().points)).save(folder / "scan.ply")
    _parts(folder)


def _parts(folder: Path) -> None:
    """Write a nut in the formats of CAD, of scenes and of solvers."""
    part = pv.examples.load_nut().triangulate()
    part.clear_data()
    part.save(folder / "part.stl")
    part.save(folder / "part.vtp")
    plotter = pv.Plotter(off_screen=True)
    plotter.add_mesh(part)
    plotter.export_obj(folder / "part.obj")
    plotter.export_vrml(folder / "part.wrl")
    plotter.export_gltf(folder / "part.glb")
    with contextlib.suppress(ImportError):
        import meshio

        faces = meshio.Mesh(part.points, [("triangle", part.regular_faces)])
        for suffix in MESHIO:
            with contextlib.redirect_stdout(io.StringIO()):
                kind = {".msh": "gmsh", ".inp": "abaqus"}.get(suffix)
                faces.write(folder / f"part{suffix}", file_format=kind)


def _rasters(folder: Path, heights: np.ndarray) -> None:
    import rasterio
    from rasterio.crs import CRS
    from rasterio.transform import Affine

    utm = Affine(30, 0, 4e5, 0, -30, 5.3e6), CRS.from_epsg(32633)
    turned = Affine(28, 10, 4e5, 10, -28, 5.3e6), utm[1]
    degrees = Affine(1 / 1200, 0, 11, 0, -1 / 1200, 60), CRS.from_epsg(4326)
    tiles = {"tiled": True, "blockxsize": 32, "blockysize": 32, "compress": "lzw"}
    holed = np.where(heights > 750, -9999, heights).astype("f4")
    for name, bands, (transform, crs), more in (
        ("int16.tif", [heights.astype("i2")], utm, {}),
        ("tiled.tif", [holed], utm, {**tiles, "nodata": -9999}),
        ("degrees.tif", [heights.astype("i2")], degrees, {"compress": "deflate"}),
        ("rotated.tif", [heights.astype("f4")], turned, {}),
        ("bands.tif", [heights.astype("f4"), (heights / 2).astype("f4")], utm, {}),
        ("grid.asc", [holed], (utm[0], None), {"driver": "AAIGrid", "nodata": -9999}),
    ):
        with rasterio.open(
            folder / name, "w", height=45, width=60, count=len(bands), dtype=bands[0].dtype,
            transform=transform, crs=crs, **more,
        ) as file:  # fmt: skip
            file.write(np.stack(bands))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("real")
    make(folder)
    return folder


@pytest.mark.sampled(5)
@pytest.mark.opengl
@pytest.mark.parametrize(
    "real",
    FILES,
    ids=lambda real: f"{real.path.rpartition('/')[2]} {real.command.partition(' ')[0]}",
)
def test_the_first_command_shows_the_file(real, folder, tmp_path, capsys):
    # "data" is where PyVista finds its examples without a download.
    homes = {"made": folder, "data": Path(os.environ.get("PYVISTA_DATA", "none"))}
    if real.package not in homes:
        homes[real.package] = Path(pytest.importorskip(real.package).__file__).parent
    path = homes[real.package] / real.path
    if not path.exists():
        pytest.skip(f"{real.package} is not installed")
    words = [word.replace("FILE", str(path)) for word in shlex.split(real.command)]
    picture = tmp_path / "a.png"
    code = cli.main([*words, "-o", str(picture), "--size", "300x200"])
    assert code == 0, capsys.readouterr().err
    pixels = np.asarray(Image.open(picture).convert("L"))
    assert 0.03 < np.mean(pixels != pixels[0, 0]) < 0.9
