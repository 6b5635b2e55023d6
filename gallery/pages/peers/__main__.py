"""Draw the pictures of the page on peers, and measure what each took.

``python gallery/pages/peers`` runs each script of the folders beside this file in a process of its
own, ``--repeats`` times, and writes the pictures beside them and ``measurements.csv``. It needs
ParaView's ``pvpython`` and ``xvfb-run``, and the terrain that PyVista downloads. With names of
scripts, as in ``lines/pyvista_lines.py``, only these are done again.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import matplotlib
import pyvista as pv
from PIL import Image
from vtkmodules.vtkCommonCore import vtkVersion

import vizlight

HERE = Path(__file__).resolve().parent
# Python puts the folder of this file first: its modules are a package of the one above.
sys.path[0] = str(HERE.parent)
from peers import data, kept  # noqa: E402

LARGEST = 150_000
#: ParaView under Xvfb now and then aborts before it draws.
TRIES = 4


def run(script, scene, folder, picture):
    """Run a script in a process of its own; return what :mod:`measure` has printed."""
    command = [sys.executable]
    space = os.environ | {"PYVISTA_OFF_SCREEN": "true", "PYTHONPATH": str(HERE.parents[2])}
    if kept.tool(script) == "paraview":
        command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1280x24", "pvpython"]
        del space["PYTHONPATH"]
    command += [str(HERE / "measure.py"), str(script), scene, str(picture)]
    for _ in range(TRIES):
        start = time.perf_counter()
        done = subprocess.run(
            command, cwd=folder, env=space, text=True, check=False,
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
        )  # fmt: skip
        if done.returncode == 0:
            row = json.loads(done.stderr.strip().splitlines()[-1])
            return row | {"wall": time.perf_counter() - start}
    raise RuntimeError(f"{script}: exit code {done.returncode}\n{done.stderr[-3000:]}")


def keep(picture, path):
    """Halve a picture, which smooths its edges, and keep it in at most 150 kB."""
    with Image.open(picture) as drawn:
        drawn.convert("RGB").reduce(2).save(path, quality=82, method=6)
    if path.stat().st_size > LARGEST:
        raise RuntimeError(f"{path.name}: {path.stat().st_size} bytes, at most {LARGEST} are kept")


def tools():
    """Return the versions of the tools by the first word of the names of scripts."""
    vtk = vtkVersion.GetVTKVersion()
    asked = subprocess.run(["pvpython", "--version"], text=True, capture_output=True, check=True)
    return {
        "paraview": f"ParaView {(asked.stdout + asked.stderr).split()[-1]}",
        "pyvista": f"PyVista {pv.__version__}, VTK {vtk}",
        "vizlight": f"vizlight {vizlight.__version__}, PyVista {pv.__version__}, VTK {vtk}",
        "matplotlib": f"matplotlib {matplotlib.__version__}",
    }


def measure(scene, script, folder, repeats):
    """Draw a picture, keep it, and return its row of the table."""
    drawn = folder / "picture.png"
    rows = [run(script, scene, folder, drawn) for _ in range(repeats)]
    keep(drawn, kept.picture(scene, script))
    frames = [row["frame"] for row in rows if "frame" in row]
    return {
        "scene": scene,
        "script": script.relative_to(HERE).as_posix(),
        "code_lines": kept.code_lines(script),
        "points": rows[0]["points"],
        "pieces": rows[0]["pieces"],
        "cpu_s": f"{min(row['cpu'] for row in rows):.2f}",
        "wall_s": f"{min(row['wall'] for row in rows):.2f}",
        "frame_cpu_s": f"{min(frames):.3f}" if frames else "",
        "memory_mb": round(statistics.median(row["memory"] for row in rows)),
        "tool": tools()[kept.tool(script)],
        "date": datetime.datetime.now(tz=datetime.timezone.utc).date().isoformat(),
        "system": f"{platform.system()} {platform.machine()}, Mesa, no graphics card",
    }


def main():
    """Do what the docstring of this file says."""
    parser = argparse.ArgumentParser(prog="gallery/pages/peers", description=__doc__)
    parser.add_argument("scripts", nargs="*", help="scripts to run again; default: all")
    parser.add_argument("--repeats", type=int, default=1, help="runs of each script")
    options = parser.parse_args()
    order = [(scene, path.relative_to(HERE).as_posix()) for scene, path in kept.todo()]
    rows = kept.read() if options.scripts else {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        data.prepare(folder)
        for key, (scene, script) in zip(order, kept.todo(), strict=True):
            if not options.scripts or key[1] in options.scripts:
                rows[key] = measure(scene, script, folder, options.repeats)
                print(*list(rows[key].values())[:9], flush=True)
    with kept.TABLE.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, kept.COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows[key] for key in order if key in rows)


if __name__ == "__main__":
    main()
