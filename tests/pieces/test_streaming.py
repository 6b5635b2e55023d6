"""A grid is lit slab by slab in less memory than it takes."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap

import numpy as np
import pytest

resource = pytest.importorskip("resource")
SIDE = 300
#: Memory in MB beyond that of the imported packages: the grid takes 108.
LIMIT = 80

CODE = """
    import re, resource, sys
    import numpy as np, pyvista as pv, vizlight
    from pathlib import Path
    from vizlight import pieces

    scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
    step = 2 / ({side} - 1)
    small = pv.ImageData(dimensions=(9, 9, 9))
    small["s"] = np.arange(729.0)
    vizlight.illuminate(small.contour([300.0], scalars="s"), scene, threads=1)  # all is imported
    array = np.load("s.npy", mmap_mode="r")
    used = int(re.search(r"VmData:\\s+(\\d+)", Path("/proc/self/status").read_text())[1]) * 1024
    resource.setrlimit(resource.RLIMIT_DATA, (used + {limit} * 10**6,) * 2)
    {work}
"""
SLABS = """lit = pieces.light(
        pieces.Slabs({"s": array}, spacing=(step,) * 3, origin=(-1, -1, -1)), scene, contour="s",
        level=0.5, slab=2, threads=1, workers=1, out="lit.pvtp")
    print(lit.points, len(lit.files))"""
WHOLE = """grid = pv.ImageData(dimensions=array.shape, spacing=(step,) * 3, origin=(-1, -1, -1))
    grid["s"] = np.array(array).ravel()
    print(vizlight.illuminate(grid.contour([0.5], scalars="s"), scene, threads=1).n_points, 1)"""


@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_slabs_fit_where_the_whole_does_not(tmp_path):
    axis = np.linspace(-1, 1, SIDE, dtype=np.float32)
    squares = axis[:, None, None] ** 2 + axis[:, None] ** 2 + axis**2
    np.save(tmp_path / "s.npy", squares)

    def run(work):
        code = textwrap.dedent(CODE.format(side=SIDE, limit=LIMIT, work=work))
        # Dask leaves settings of the C library behind, which a process reads when it starts.
        kept = {name: value for name, value in os.environ.items() if not name.startswith("MALLOC_")}
        return subprocess.run(
            [sys.executable, "-c", code], cwd=tmp_path, env=kept, capture_output=True, text=True,
            check=False,
        )  # fmt: skip

    slabs = run(SLABS)
    assert slabs.returncode == 0, slabs.stderr
    points, files = map(int, slabs.stdout.split())
    assert points > 100_000
    assert files > 20
    assert run(WHOLE).returncode != 0
