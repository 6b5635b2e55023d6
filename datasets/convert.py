"""Make the embedded data: ``python datasets/convert.py SOURCE ...``, in the order of the functions.

The command ``pip download --no-deps mayavi==4.9.0 dipy==1.12.1 dm_control==1.0.50
matplotlib==3.11.2 nilearn==0.14.1 geopandas==0.14.4`` fetches the wheels. Reliefs and winds are
the files
``etopo20.cdf``, ``etopo5.cdf`` and ``monthly_navy_winds.cdf`` in ``usr/share/ferret-vis/data`` of
Debian's package ferret-datasets: the command ``apt-get download ferret-datasets`` fetches the
package, ``dpkg-deb -x`` unpacks it. ``carotid.vtk`` is in the data of VTK, which PyVista downloads
by ``pyvista.examples.download_carotid()``.
"""

from __future__ import annotations

import gzip
import hashlib
import io
import itertools
import sys
import tempfile
import zipfile
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pyvista as pv
from scipy import ndimage
from scipy.io import netcdf_file
from vtkmodules.vtkIOXML import (
    vtkXMLImageDataWriter,
    vtkXMLPolyDataWriter,
    vtkXMLUnstructuredGridWriter,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

HERE = Path(__file__).parent
#: Length of a degree of latitude in metres.
DEGREE = 111_195
DISK = "mayavi/tests/data/disk_out_ref.ex2"
FIBRES = "dipy/data/files/tracks300.trk"
DOG = "dm_control/suite/dog_assets/SKINbody.stl"
FAULT = "matplotlib/mpl-data/sample_data/jacksboro_fault_dem.npz"
BRAIN = "nilearn/datasets/data/mni_icbm152_{}_tal_nlin_sym_09a_converted.nii.gz"
COUNTRIES = "geopandas/datasets/naturalearth_lowres/naturalearth_lowres.shp"
#: Steps of a degree to which coasts are rounded.
STEPS = 200
#: West, east, south and north of the islands of Hawaii, in degrees east and north.
HAWAII = (196.0, 209.0, 16.0, 25.0)


def _saved(mesh: Any, name: str) -> Path:
    """Write a mesh as small as VTK can: LZMA keeps half of what its usual compression does."""
    kinds = {".vti": vtkXMLImageDataWriter, ".vtp": vtkXMLPolyDataWriter}
    path = HERE / name
    writer: Any = kinds.get(path.suffix, vtkXMLUnstructuredGridWriter)()
    writer.SetInputData(mesh)
    writer.SetFileName(str(path))
    writer.SetCompressorTypeToLZMA()
    writer.SetCompressionLevel(9)
    writer.SetBlockSize(1 << 24)
    writer.EncodeAppendedDataOff()
    writer.Write()
    return path


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
    return _saved(out, "rotating_disk.vtu")


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
    return _saved(out, "fibre_bundle.vtp")


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
    return _saved(out, "earth_relief.vti")


def dog(wheel: Path) -> Path:
    """Write the skin of the dog with its equal points merged."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        skin: Any = pv.read(archive.extract(DOG, folder))
    return _saved(skin.clean(), "dog.vtp")


def jacksboro_fault(wheel: Path) -> Path:
    """Write the heights of the Jacksboro fault on a grid in metres, from south to north."""
    with zipfile.ZipFile(wheel) as archive, np.load(io.BytesIO(archive.read(FAULT))) as source:
        heights = source["elevation"][::-1]
        latitude = np.radians(float(source["ymin"] + source["ymax"]) / 2)
        degrees = float(source["dx"]), float(source["dy"])
    out = pv.ImageData(
        dimensions=(heights.shape[1], heights.shape[0], 1),
        spacing=(DEGREE * np.cos(latitude) * degrees[0], DEGREE * degrees[1], 1.0),
    )
    out.point_data["elevation"] = heights.ravel()
    return _saved(out, "jacksboro_fault.vti")


def winds_of_july(source: Path) -> Path:
    """Write the mean wind of July on the unit sphere, as vectors in space."""
    with netcdf_file(source, "r", mmap=False) as file:
        east, north, *wind = (
            np.array(file.variables[name].data) for name in ("FNOCX", "FNOCY", "UWND", "VWND")
        )
    # The first of the 132 months is January 1982.
    wind = np.mean([part[6::12].astype(float) for part in wind], axis=1)
    longitude, latitude = np.radians(np.meshgrid(east, north))
    c, s = np.cos(longitude), np.sin(longitude)
    up = np.stack([np.cos(latitude) * c, np.cos(latitude) * s, np.sin(latitude)], axis=-1)
    eastward = np.stack([-s, c, 0 * s], axis=-1)
    vectors = wind[0][..., np.newaxis] * eastward + wind[1][..., np.newaxis] * np.cross(
        up, eastward
    )
    # One point at each pole, where the source has a row of them.
    up[[0, -1]], vectors[[0, -1]] = up[[0, -1], :1], vectors[[0, -1]].mean(axis=1, keepdims=True)
    rows, columns = longitude.shape
    here = np.arange(rows * columns).reshape(rows, columns)
    here[0], here[-1] = here[0, 0], here[-1, 0]
    right = np.roll(here, -1, axis=1)
    lower = np.stack([here[:-1], right[:-1], right[1:]], axis=-1)[1:]
    upper = np.stack([here[:-1], right[1:], here[1:]], axis=-1)[:-1]
    faces = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)])
    out: Any = pv.PolyData.from_regular_faces(up.reshape(-1, 3), faces)
    out.points = out.points.astype(np.float32)
    out.point_data["wind"] = vectors.reshape(-1, 3).astype(np.float32)
    return _saved(out.clean(tolerance=0), "winds_of_july.vtp")


def hawaii(source: Path) -> Path:
    """Write the heights of the islands and the sea floor, every 5 minutes of arc, in metres."""
    with netcdf_file(source, "r", mmap=False) as file:
        east, north, heights = (
            np.array(file.variables[name].data) for name in ("ETOPO05_X", "ETOPO05_Y", "ROSE")
        )
    west, last, south, top = HAWAII
    columns = (east >= west - 0.01) & (east <= last + 0.01)
    rows = (north >= south - 0.01) & (north <= top + 0.01)
    heights = np.rint(heights[np.ix_(rows, columns)]).astype(np.int16)
    latitude = np.radians((south + top) / 2)
    out = pv.ImageData(
        dimensions=(heights.shape[1], heights.shape[0], 1),
        spacing=(DEGREE / 12 * np.cos(latitude), DEGREE / 12, 1.0),
    )
    out.point_data["elevation"] = heights.ravel()
    return _saved(out, "hawaii.vti")


def carotid(source: Path) -> Path:
    """Write the flow in arteries of the neck, speed to 1 and velocity to 1 / 32."""
    scan: Any = pv.read(source)
    out = pv.ImageData(dimensions=scan.dimensions, spacing=scan.spacing)
    out.point_data["brightness"] = np.rint(scan["scalars"]).astype(np.int16)
    out.point_data["velocity"] = (np.rint(32 * scan["vectors"]) / 32).astype(np.float32)
    return _saved(out, "carotid.vti")


def brain(wheel: Path) -> Path:
    """Write the left half of the mean brain of 152 people: white and half of gray matter."""
    parts = []
    with zipfile.ZipFile(wheel) as archive:
        for kind in ("wm", "gm"):
            content = gzip.decompress(archive.read(BRAIN.format(kind)))
            data = np.frombuffer(content, np.uint8, 197 * 233 * 189, 352)
            parts.append(data.reshape((197, 233, 189), order="F") / 255)
    # The middle is 98 mm from the left.
    matter = ndimage.gaussian_filter((parts[0] + 0.5 * parts[1])[:99], 0.7)
    places = np.stack(np.meshgrid(*(np.arange(0, n, 1.5) for n in matter.shape), indexing="ij"))
    matter = ndimage.map_coordinates(matter, places, order=3, mode="nearest")
    matter = np.clip(np.rint(100 * matter), 20, 80).astype(np.uint8)
    used = np.argwhere(matter > 20)
    first, last = used.min(axis=0), used.max(axis=0) + 1
    matter = matter[tuple(map(slice, first, last))]
    corner = np.array([-98.0, -134.0, -72.0]) + 1.5 * first
    out = pv.ImageData(dimensions=matter.shape, spacing=(1.5,) * 3, origin=corner)
    out.point_data["matter"] = matter.ravel(order="F")
    return _saved(out, "brain.vti")


def coasts(wheel: Path) -> Path:
    """Write the coasts of countries as lines in degrees, to the nearest 0.005 degrees."""
    with zipfile.ZipFile(wheel) as archive:
        content = archive.read(COUNTRIES)
    # Sides of countries in steps of 0.005 degrees. A border is a side of two of them.
    count: Counter[tuple[tuple[int, int], ...]] = Counter()
    at = 100
    while at < len(content):
        parts, points = np.frombuffer(content, "<i4", 2, at + 44)
        starts = [*np.frombuffer(content, "<i4", parts, at + 52), points]
        flat = np.frombuffer(content, "<f8", 2 * points, at + 52 + 4 * parts).reshape(-1, 2)
        places = [(int(x), int(y)) for x, y in np.rint(STEPS * flat)]
        for first, last in itertools.pairwise(starts):
            for side in itertools.pairwise(places[first:last]):
                count[tuple(sorted(side))] += 1
        at += 8 + 2 * int.from_bytes(content[at + 4 : at + 8], "big")
    # Nor are cuts coasts: along the date line, and along the bottom of the map.
    sides = [
        (a, b)
        for (a, b), times in count.items()
        if a != b
        and times == 1
        and not (abs(a[0]) == abs(b[0]) == 180 * STEPS or a[1] == -90 * STEPS)
    ]
    lines = _followed(sides)
    out = pv.PolyData()
    out.points = np.array(
        [(x / STEPS, y / STEPS, 0) for line in lines for x, y in line], np.float32
    )
    ends = np.cumsum([0, *map(len, lines)])
    out.SetLines(pv.CellArray.from_arrays(ends, np.arange(ends[-1])))
    return _saved(out, "coasts.vtp")


def _followed(sides: Sequence[tuple[tuple[int, int], ...]]) -> list[list[tuple[int, int]]]:
    """Return the lines along some sides, those that end at the date line first, then rings."""
    beside: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for a, b in sides:
        beside.setdefault(a, []).append(b)
        beside.setdefault(b, []).append(a)
    lines = []
    for start in sorted(beside, key=lambda place: (len(beside[place]), place)):
        line = [start]
        while beside[line[-1]]:
            line.append(beside[line[-1]].pop())
            beside[line[-1]].remove(line[-2])
        if len(line) > 1:
            lines.append(line)
    return lines


if __name__ == "__main__":
    makers = (
        rotating_disk, fibre_bundle, earth_relief, dog, jacksboro_fault, winds_of_july,
        hawaii, carotid, brain, coasts,
    )  # fmt: skip
    for make, source in zip(makers, sys.argv[1:], strict=True):
        made = make(Path(source))
        sys.stdout.write(f"{hashlib.sha256(made.read_bytes()).hexdigest()}  {made.name}\n")
