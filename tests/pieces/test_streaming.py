"""Data are lit slab by slab, and piece by piece, in less memory than they take."""

import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest
import pyvista as pv

resource = pytest.importorskip("resource")
SIDE, SURFACES, WIDTH = 300, 16, 100
#: Memory in MB beyond that of the imported packages: the grid takes 108, the surfaces 90,
#: most of it in an array, because normals of so many points would take longer.
LIMIT = 80

CODE = """
    import os, re, resource
    import numpy as np, pyvista as pv, vizlight
    from pathlib import Path
    from vizlight import pieces

    scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    grid = {"contour": "s", "level": 0.5, "slab": 2}

    def slab_by_slab(kind):
        source = {
            "slabs": lambda: pieces.Slabs({"s": np.load("s.npy", mmap_mode="r")}),
            "surfaces": lambda: "surface*.vtp",
        }.get(kind, lambda: f"grid.{kind}")()
        lit = pieces.light(source, scene, out=f"{kind}.pvtp",
                           **({} if kind == "surfaces" else grid))
        assert len(lit.files) > 15 and lit.points > 80_000, lit
        return lit.points

    def whole(kind):
        if kind == "slabs":
            mesh = pv.ImageData(dimensions=(%d,) * 3)
            mesh["s"] = np.load("s.npy").ravel()
        elif kind == "surfaces":
            mesh = pv.merge([pv.read(path) for path in sorted(Path().glob("surface*.vtp"))])
        else:
            mesh = pv.read(f"grid.{kind}")
        mesh = mesh.contour([0.5], scalars="s") if kind != "surfaces" else mesh
        assert vizlight.illuminate(mesh, scene).n_points > 80_000

    small = pv.ImageData(dimensions=(9, 9, 9))
    small["s"] = np.arange(729.0)
    vizlight.illuminate(small.contour([300.0], scalars="s"), scene)  # all is imported
    used = int(re.search(r"VmData:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (used + %d * 10**6,) * 2)
    for kind in %s:
        child = os.fork()
        if not child:
            try:
                whole(kind)
                os._exit(0)
            except BaseException:
                os._exit(1)
        fails = os.waitpid(child, 0)[1] != 0
        print(kind, slab_by_slab(kind), fails)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_pieces_fit_where_the_whole_does_not(tmp_path):
    from vtkmodules.vtkIOHDF import vtkHDFWriter
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter

    axis = np.linspace(0, 1, SIDE, dtype=np.float32)
    squares = axis[:, None, None] + axis[:, None] ** 2 + axis**2
    np.save(tmp_path / "s.npy", squares)
    grid = pv.ImageData(dimensions=squares.shape)
    grid["s"] = squares.ravel()
    xml = vtkXMLImageDataWriter()
    xml.SetInputDataObject(grid)
    xml.SetFileName(str(tmp_path / "grid.vti"))
    xml.SetCompressorTypeToLZ4()  # a tenth of the time of the default
    xml.Write()
    hdf = vtkHDFWriter()
    hdf.SetInputDataObject(grid)
    hdf.SetFileName(str(tmp_path / "grid.vtkhdf"))
    hdf.Write()
    kinds = ["slabs", "vti", "vtkhdf", "surfaces"]
    if pv.vtk_version_info < (9, 7):  # which writes no images
        kinds.remove("vtkhdf")
    for i in range(SURFACES):
        plane = pv.Plane(center=(0, 0, i), i_resolution=WIDTH, j_resolution=WIDTH)
        plane.clear_data()
        plane["more"] = np.zeros((plane.n_points, 130), dtype=np.float32)
        plane.save(tmp_path / f"surface{i:02d}.vtp")
    # Dask leaves settings of the C library behind, which a process reads when it starts.
    kept = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}
    kept["VIZLIGHT_THREADS"] = "1"
    code = textwrap.dedent(CODE % (SIDE, LIMIT, kinds))
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, env=kept,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    lines = [line.split() for line in run.stdout.splitlines()]
    assert [(kind, fails) for kind, _, fails in lines] == [(kind, "True") for kind in kinds]
    assert len({points for kind, points, _ in lines if kind != "surfaces"}) == 1
