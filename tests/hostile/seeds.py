"""Small valid files of the kinds that vizlight reads, from which damaged ones are made."""

import gzip

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


def _texts(folder):
    """Write files of text, and packed ones and scenes of them."""
    rows = [" ".join(f"{x:.4f}" for x in point) for point in lines()[0]]
    (folder / "scan.xyz").write_text("\n".join(rows) + "\n")
    (folder / "scan.pts").write_text("\n".join([str(len(rows)), *rows]) + "\n")
    branch = [f"{i + 1} 3 {row} 0.5 {i or -1}" for i, row in enumerate(rows)]
    (folder / "neuron.swc").write_text("\n".join(branch) + "\n")
    corners = "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n"
    (folder / "four.off").write_text(f"4OFF\n4 2 0\n{corners}3 0 1 2\n3 0 2 3\n")
    place = "point [0 0 0, 1 0 0, 1 1 0, 0 1 0]"
    shape = f"IndexedFaceSet {{ coord Coordinate {{ {place} }} coordIndex [0 1 2 3 -1] }}"
    (folder / "scene.wrl").write_text(f"#VRML V2.0 utf8\nShape {{ geometry {shape} }}\n")
    ball().save(folder / "packed.vtp")
    (folder / "ball.vtp.gz").write_bytes(gzip.compress((folder / "packed.vtp").read_bytes()))
    (folder / "packed.vtp").unlink()
    mixed = pv.Cylinder(resolution=5)
    mixed.clear_data()
    mixed.save(folder / "mixed.ply")


def _scans(folder):
    import laspy
    import nibabel

    cloud = laspy.create(point_format=3, file_version="1.2")
    cloud.x, cloud.y, cloud.z = np.concatenate(lines()).T
    cloud.write(folder / "scan.las")
    image = nibabel.Nifti1Image(np.arange(60, dtype=np.int16).reshape(5, 4, 3), np.eye(4))
    nibabel.save(image, folder / "image.nii")
    surface = ball()
    arrays = [
        nibabel.gifti.GiftiDataArray(np.asarray(surface.points), "NIFTI_INTENT_POINTSET"),
        nibabel.gifti.GiftiDataArray(
            surface.regular_faces.astype(np.int32), "NIFTI_INTENT_TRIANGLE"
        ),
    ]
    nibabel.save(nibabel.gifti.GiftiImage(darrays=arrays), folder / "ball.surf.gii")


def _rasters(folder):
    import rasterio

    heights = np.add.outer(np.arange(9.0), np.arange(7.0) ** 2).astype(np.float32)
    how = {"driver": "GTiff", "width": 7, "height": 9, "count": 1, "dtype": "float32"}
    with rasterio.open(
        folder / "map.tif", "w", crs="EPSG:32633",
        transform=rasterio.Affine(30, 0, 4e5, 0, -30, 5e6), **how,
    ) as file:  # fmt: skip
        file.write(heights, 1)
    head = "ncols 7\nnrows 9\nxllcorner 0\nyllcorner 0\ncellsize 30\n"
    rows = "\n".join(" ".join(f"{x:g}" for x in row) for row in heights)
    (folder / "map.asc").write_text(f"{head}{rows}\n")


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
    for suffix in ("bdf", "med", "vol", "mdpa"):
        of_volume.write(folder / f"grid.{suffix}")
    of_volume.write(folder / "grid.xmf", data_format="XML")
    of_ball.write(folder / "ball.inp", file_format="abaqus")
    of_volume.write(folder / "avs.inp", file_format="avsucd")


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
    for kind in (_vtk, _surfaces, _texts, _of_meshio, _tracts, _trx, _scans, _rasters, _netcdf):
        try:
            kind(folder)
        except ImportError:
            continue
    return sorted(path for path in folder.iterdir() if path.is_file())
