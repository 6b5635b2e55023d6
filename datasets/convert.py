"""Make the embedded data: ``python datasets/convert.py mayavi.whl dipy.whl etopo20.cdf``.

The command ``pip download --no-deps mayavi==4.9.0 dipy==1.12.1`` fetches the wheels. The relief is
the file ``usr/share/ferret-vis/data/etopo20.cdf`` of Debian's package ferret-datasets: the command
``apt-get download ferret-datasets`` fetches the package, ``dpkg-deb -x`` unpacks it.
"""

from __future__ import annotations

import hashlib
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from scipy.io import netcdf_file

HERE = Path(__file__).parent
DISK = "mayavi/tests/data/disk_out_ref.ex2"
FIBRES = "dipy/data/files/tracks300.trk"


def rotating_disk(wheel: Path) -> Path:
    """Write the volume block of the flow with all its point arrays, in float32."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        blocks: Any = pv.read(archive.extract(DISK, folder))
    volume = blocks[0][0]
    out = volume.copy()
    out.clear_cell_data()
    out.clear_field_data()
    out.points = out.points.astype(np.float32)
    for name in out.point_data:
        out.point_data[name] = out.point_data[name].astype(np.float32)
    path = HERE / "rotating_disk.vtu"
    out.save(path)
    return path


def fibre_bundle(wheel: Path) -> Path:
    """Write the tracks of a TrackVis file as lines, in float32."""
    with zipfile.ZipFile(wheel) as archive:
        content = archive.read(FIBRES)
    scalars, properties, count = (
        int(np.frombuffer(content, kind, 1, offset)[0])
        for kind, offset in (("<i2", 36), ("<i2", 238), ("<i4", 988))
    )
    if (scalars, properties) != (0, 0):
        raise ValueError("wheel: expected tracks without scalars and properties; take dipy 1.12.1")
    points, sizes, offset = [], [], 1000
    for _ in range(count):
        size = int(np.frombuffer(content, "<i4", 1, offset)[0])
        points.append(np.frombuffer(content, "<f4", 3 * size, offset + 4).reshape(-1, 3))
        sizes.append(size)
        offset += 4 + 12 * size
    out = pv.PolyData()
    out.points = np.concatenate(points).astype(np.float32)
    offsets = np.concatenate([[0], np.cumsum(sizes)])
    out.SetLines(pv.CellArray.from_arrays(offsets, np.arange(offsets[-1])))
    path = HERE / "fibre_bundle.vtp"
    out.save(path)
    return path


def earth_relief(source: Path) -> Path:
    """Write the heights of the earth from west to east, to the nearest metre."""
    with netcdf_file(source, "r", mmap=False) as file:
        east, north, heights = (
            np.array(file.variables[name].data) for name in ("ETOPO20X1_1081", "ETOPO20Y", "ROSE")
        )
    # The last column repeats the first; the columns from 180 degrees on become the first ones.
    east, heights = east[:-1], np.rint(heights[:, :-1]).astype(np.int16)
    first = int(np.searchsorted(east, 180))
    heights = np.roll(heights, -first, axis=1)
    out = pv.ImageData(
        dimensions=(len(east), len(north), 1),
        spacing=(1 / 3, 1 / 3, 1.0),
        origin=(-180 + 1 / 6, -90 + 1 / 6, 0.0),
    )
    west = np.sort((east + 180) % 360 - 180)
    grid = [out.origin[axis] + np.arange(out.dimensions[axis]) / 3 for axis in (0, 1)]
    if not (np.allclose(west, grid[0], atol=1e-3) and np.allclose(north, grid[1], atol=1e-3)):
        raise ValueError("source: expected a grid of 20 minutes of arc; take etopo20.cdf")
    out.point_data["elevation"] = heights.ravel()
    path = HERE / "earth_relief.vti"
    out.save(path)
    return path


if __name__ == "__main__":
    for make, source in zip((rotating_disk, fibre_bundle, earth_relief), sys.argv[1:], strict=True):
        made = make(Path(source))
        sys.stdout.write(f"{hashlib.sha256(made.read_bytes()).hexdigest()}  {made.name}\n")
