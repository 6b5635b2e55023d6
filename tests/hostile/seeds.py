"""Small valid files of the kinds that vizlight reads, from which damaged ones are made."""

from __future__ import annotations

import json
import struct

import numpy as np
import pyvista as pv


def ball():
    """Return a small closed surface with a vector and a number for each point."""
    mesh = pv.Sphere(theta_resolution=8, phi_resolution=7)
    mesh.clear_data()
    mesh["V"] = np.cross(mesh.points, [0, 0, 1.0]).astype(np.float32)
    mesh["height"] = np.asarray(mesh.points[:, 2])
    return mesh


def box():
    """Return a small image with a vector for each point."""
    mesh = pv.ImageData(dimensions=(4, 3, 5), spacing=(1, 2, 0.5))
    mesh["V"] = np.asarray(mesh.points, dtype=np.float32) + 1
    return mesh


def tetrahedra():
    """Return a few tetrahedra."""
    mesh = pv.ImageData(dimensions=(3, 3, 2)).to_tetrahedra()
    mesh.clear_data()
    return mesh


def lines(n=5):
    """Return the points of some lines."""
    t = np.linspace(0, 3, 12)
    return [np.stack([np.cos(t + i), np.sin(t), t * i], axis=1).astype("f4") for i in range(n)]


def _vtk(folder):
    box_, ball_ = box(), ball()
    meshes = {
        "poly": ball_,
        "image": box_,
        "grid": tetrahedra(),
        "structured": box_.cast_to_structured_grid(),
        "rectilinear": box_.cast_to_rectilinear_grid(),
    }
    suffixes = {
        "poly": "vtp", "image": "vti", "grid": "vtu", "structured": "vts", "rectilinear": "vtr",
    }  # fmt: skip
    for name, mesh in meshes.items():
        for binary in (True, False):
            form = "binary" if binary else "ascii"
            mesh.save(folder / f"{name}-{form}.vtk", binary=binary)
            mesh.save(folder / f"{name}-{form}.{suffixes[name]}", binary=binary)
    from vtkmodules import vtkIOXML

    writer = vtkIOXML.vtkXMLPolyDataWriter()
    writer.SetInputData(ball_)
    writer.SetFileName(str(folder / "poly-inline.vtp"))
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToLZ4()
    writer.Write()
    try:
        from vtkmodules.vtkIOHDF import vtkHDFWriter
    except ImportError:
        return
    hdf = vtkHDFWriter()
    hdf.SetInputData(tetrahedra())
    hdf.SetFileName(str(folder / "grid.vtkhdf"))
    hdf.Write()


def _surfaces(folder):
    ball_ = ball()
    for binary in (True, False):
        form = "binary" if binary else "ascii"
        for suffix in ("ply", "stl"):
            ball_.save(folder / f"ball-{form}.{suffix}", binary=binary)
    points, faces = np.asarray(ball_.points), ball_.regular_faces
    rows = [f"v {x:g} {y:g} {z:g}" for x, y, z in points]
    rows += [f"f {a} {b} {c}" for a, b, c in faces + 1]
    (folder / "ball.obj").write_text("\n".join(rows) + "\n")
    _gltf(folder, points.astype("<f4"), faces.astype("<u2"))


def _gltf(folder, points, faces):
    """Write a mesh as binary glTF: two accessors on one buffer."""
    data = points.tobytes() + faces.tobytes()
    data += b"\0" * (-len(data) % 4)
    views = [
        {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes, "target": 34962},
        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": faces.nbytes, "target": 34963},
    ]
    numbers = [
        {
            "bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
            "min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist(),
        },
        {"bufferView": 1, "componentType": 5123, "count": faces.size, "type": "SCALAR"},
    ]  # fmt: skip
    text = json.dumps({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": numbers,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }).encode()  # fmt: skip
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(data)
    head = struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON")
    body = struct.pack("<I4s", len(data), b"BIN\0")
    (folder / "ball.glb").write_bytes(head + text + body + data)


def _of_meshio(folder):
    import meshio

    surface, volume = ball(), tetrahedra()
    of_ball = meshio.Mesh(np.asarray(surface.points), [("triangle", surface.regular_faces)])
    cells = volume.cells_dict[pv.CellType.TETRA]
    of_volume = meshio.Mesh(np.asarray(volume.points, dtype=float), [("tetra", cells)])
    of_ball.write(folder / "ball.off")
    of_volume.write(folder / "grid.mesh")
    of_volume.write(folder / "grid.su2")
    of_volume.write(folder / "grid-ascii.msh", file_format="gmsh", binary=False)
    of_volume.write(folder / "grid-binary.msh", file_format="gmsh", binary=True)
    of_volume.write(folder / "grid.e", file_format="exodus")


def _tracts(folder):
    import nibabel

    found = nibabel.streamlines.Tractogram(lines(), affine_to_rasmm=np.eye(4))
    for suffix in ("trk", "tck"):
        nibabel.streamlines.save(found, str(folder / f"lines.{suffix}"))


def _trx(folder):
    from trx import trx_file_memmap

    place = lines()
    trx = trx_file_memmap.TrxFile(nb_vertices=sum(map(len, place)), nb_streamlines=len(place))
    trx.streamlines._data[:] = np.concatenate(place)
    trx.streamlines._offsets[:] = np.cumsum([0, *map(len, place[:-1])])
    trx.streamlines._lengths[:] = [*map(len, place)]
    trx.header["VOXEL_TO_RASMM"] = np.eye(4).tolist()
    trx.header["DIMENSIONS"] = [10, 10, 10]
    trx_file_memmap.save(trx, str(folder / "lines.trx"))
    trx.close()


def _netcdf(folder):
    import xarray

    field = xarray.DataArray(
        np.arange(24.0).reshape(2, 3, 4),
        dims=("z", "y", "x"),
        coords={"z": [0.0, 1], "y": [0.0, 1, 2], "x": [0.0, 1, 2, 3]},
    )
    file = field.to_dataset(name="t")
    file.to_netcdf(folder / "classic.nc", engine="scipy", format="NETCDF3_64BIT")
    file.to_netcdf(folder / "four.nc", engine="netcdf4")


def _dem(folder):
    """Write a digital elevation model of the U.S. Geological Survey, as narrow as VTK reads it."""

    def record(*parts):
        words = {int: "{:6d}", float: "{:24.15E}", str: "{:144}"}
        text = "".join(words[type(part)].format(part) for part in parts)
        # Words of numbers have the exponent of Fortran.
        return text.replace("E", "D").ljust(1024)

    columns, rows, step, low = 100, 4, 30.0, 3000.0
    east, north = low + (columns - 1) * step, low + (rows - 1) * step
    corners = [low, low, low, north, east, north, east, low]
    head = record("hills", 1, 1, 1, 10, *[0.0] * 15, 2, 2, 4, *corners, 0.0, 999.0, 0.0, 0).rstrip()
    head += f"{step:12.6E}{step:12.6E}{1:12.6E}{1:6d}{columns:6d}"
    profiles = [
        record(1, i + 1, rows, 1, low + i * step, low, 0.0, 0.0, 999.0, *range(i, i + rows))
        for i in range(columns)
    ]
    (folder / "hills.dem").write_text(head.ljust(1024) + "".join(profiles))


def write(folder):
    """Write all files whose packages are installed, and return their paths in order."""
    for kind in (_vtk, _surfaces, _dem, _of_meshio, _tracts, _trx, _netcdf):
        try:
            kind(folder)
        except ImportError:
            continue
    return sorted(path for path in folder.iterdir() if path.is_file())
