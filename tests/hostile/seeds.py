"""Small valid files of the kinds that vizlight reads, from which damaged ones are made."""

import numpy as np
import pyvista as pv

import vizlight
from vizlight import Light, Material, Scene


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


def without_vectors(mesh):
    """Return a mesh with pairs of numbers in place of vectors, whose lines take time to trace."""
    mesh["pair"] = mesh["V"][:, :2].copy()
    del mesh.point_data["V"]
    return mesh


def _vtk(folder):
    box_, ball_ = without_vectors(box()), without_vectors(ball())
    meshes = {
        "vtp": ball_,
        "vti": box_,
        "vtu": tetrahedra(),
        "vts": box_.cast_to_structured_grid(),
        "vtr": box_.cast_to_rectilinear_grid(),
    }
    for suffix, mesh in meshes.items():
        for binary, form in (True, "binary"), (False, "ascii"):
            mesh.save(folder / f"{suffix}-{form}.vtk", binary=binary)
            mesh.save(folder / f"{form}.{suffix}", binary=binary)
    box().save(folder / "binary.vti")
    ball().save(folder / "binary.vtp")
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
    scene = Scene(lights=Light(direction=(0, 0, 1)), material=Material(specular=0))
    vizlight.save_gltf(ball_, folder / "ball.glb", scene=scene)


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


def write(folder):
    """Write all files whose packages are installed, and return their paths in order."""
    for kind in (_vtk, _surfaces, _of_meshio, _tracts, _trx, _netcdf):
        try:
            kind(folder)
        except ImportError:
            continue
    return sorted(path for path in folder.iterdir() if path.is_file())
