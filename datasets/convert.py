"""Make the embedded data from their sources: ``python datasets/convert.py mayavi.whl``.

The wheel is fetched by ``pip download --no-deps mayavi==4.9.0``.
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

HERE = Path(__file__).parent
SOURCE = "mayavi/tests/data/disk_out_ref.ex2"


def rotating_disk(wheel: Path) -> Path:
    """Write the volume block of the CFD solution with all its fields, in float32."""
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        blocks: Any = pv.read(archive.extract(SOURCE, folder))
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


if __name__ == "__main__":
    made = rotating_disk(Path(sys.argv[1]))
    sys.stdout.write(f"{hashlib.sha256(made.read_bytes()).hexdigest()}  {made.name}\n")
