"""Report on the installation: packages, backends that draw here, and uses of missing packages."""

from __future__ import annotations

import platform
from typing import get_args

from vizlight import _compiled, data
from vizlight.draw import render

#: Packages that vizlight always needs.
PACKAGES = ("vizlight", "numpy", "scipy", "vtk", "pyvista", "cyclopts", "rich", "pillow")
#: Feature, the package that it needs, and the extra that installs the package. Without the package
#: the feature is refused with a remedy, its tests are skipped, and closed meshes take VTK's rays.
OPTIONAL = (
    ("movies in GIF files", "imageio", "movie"),
    ("movies in MP4 files", "imageio-ffmpeg", "movie"),
    ("shadows of closed meshes by nearby lights ten times as fast", "embreex", "rays"),
    ("combined solids", "manifold3d", "solids"),
    ("shadows and sky over terrain some six times as fast", "numba", "fast"),
    ("tractograms in .trk and .tck files", "nibabel", "tracts"),
    ("tractograms in .trx files", "trx-python", "tracts"),
    ("meshes in .off, .mesh, .msh and other files", "meshio", "formats"),
    ("grids in netCDF files", "xarray", "formats"),
    ("heights in GeoTIFF and other rasters", "rasterio", "maps"),
    ("data in pieces on several machines", "distributed", "scale"),
    ("all tests", "pytest", "test"),
    ("tests of pictures", "pytest-pyvista", "test"),
    ("tests with searched inputs", "hypothesis", "test"),
    ("checks against 50 digits", "mpmath", "test"),
    ("figures of the studies", "matplotlib", "test"),
    ("the pages", "sphinx", "docs"),
    ("the test of the wheel", "hatchling", "dev"),
    ("checks of style", "ruff", "dev"),
    ("checks of types", "mypy", "dev"),
)


def findings() -> list[tuple[str, str]]:
    """Return pairs of a part and its state.

    Returns
    -------
    list of tuple of str
        Version of Python; version of each package, or its use and the command that installs it;
        whether code is compiled; path of the embedded data; backends that draw.
    """
    rows = [("python", f"{platform.python_version()}, {platform.platform()}")]
    rows += [
        (package, _compiled.release_of(package) or f"missing (try: pip install {package})")
        for package in PACKAGES
    ]
    for feature, package, extra in OPTIONAL:
        remedy = f"missing; needed for {feature} (try: pip install 'vizlight[{extra}]')"
        rows.append((f"{package} [{extra}]", _compiled.release_of(package) or remedy))
    _compiled.try_out()
    rows.append(("compiled code", _compiled.status()))
    rows.append(("data", str(data.example_path())))
    for backend in get_args(render.Backend):
        rows.append((f"draws by {backend}", render.probe(backend).detail))
    return rows
