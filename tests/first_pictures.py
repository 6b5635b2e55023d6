"""Draw files with their data and with other data: ``python tests/first_pictures.py FOLDER``.

A first picture of a file should tell something of the data in it. Each file is drawn twice by
``vizlight.look``, with its data and on the same mesh with other data (values reversed within their
range, vectors turned by 90 degrees, kinds permuted), and the two pictures are compared. A picture
that stays the same shows none of the data. Plain PyVista's first picture is measured the same way.
The folder of ``--out`` gets the pictures, a table with a row for each file, and contact sheets.
"""

from __future__ import annotations

import argparse
import contextlib
import csv
import importlib
import multiprocessing
import re
import subprocess
import sys
import time
import warnings
from pathlib import Path

import numpy as np
import pyvista as pv
from PIL import Image, ImageDraw

import vizlight

#: Difference of 255 above which a pixel differs, and share of pixels above which a picture does.
PIXEL, PICTURE = 8, 0.005
#: Largest difference of 255 between a picture and what its script draws.
SCRIPT = 2
#: Names of arrays that are no data.
BOOKKEEPING = re.compile(
    r"^(vtk|TCoords|TEXCOORD|Texture|GroupIds|MaterialIds|vizlight_)|normals?$|^gmsh:(dim|geom)"
    r"|^(point|cell|node|element)?_?ids?$|^Original.*Ids$",
    re.IGNORECASE,
)
#: Most different whole numbers that are kinds.
KINDS = 100
SIZE = (1200, 800)
#: Seconds for one file.
LIMIT = 150
#: Rows of a contact sheet, and size of a picture in it.
ROWS, THUMB = 6, (600, 400)
#: Columns of the table; times are of the processor.
COLUMNS = (
    "file", "question", "shown", "array", "changes", "moved", "pyvista", "script", "read_s",
    "decision_s", "look_s", "pyvista_s", "decision_share", "figures", "reason", "error",
    "script_error",
)  # fmt: skip


def changed(mesh, *, moved=False):
    """Return a mesh with other data, or its own in reverse order, and the number of new arrays."""
    if isinstance(mesh, pv.MultiBlock):
        blocks = pv.MultiBlock()
        counts = 0
        for name in mesh.keys():  # noqa: SIM118 : blocks without a name have a key too
            block, count = (None, 0) if mesh[name] is None else changed(mesh[name], moved=moved)
            blocks.append(block, name)
            counts += count
        return blocks, counts
    other, count = mesh.copy(), 0
    for before, after in ((mesh.point_data, other.point_data), (mesh.cell_data, other.cell_data)):
        active = before.active_scalars_name
        for name in before:
            values = np.asarray(before[name])
            if BOOKKEEPING.search(name) or values.dtype.kind not in "fiub" or not values.size:
                continue
            new = values[::-1].copy() if moved else _other(values, mesh)
            count += not np.array_equal(new, values, equal_nan=values.dtype.kind == "f")
            after[name] = new
        if active is not None:
            after.active_scalars_name = active
    return other, count


def _other(values, mesh):
    """Return other values of the same range, vectors of the same length."""
    if values.ndim == 2 and values.shape[1] == 3 and values.dtype.kind == "f":
        return _turned(values, mesh)
    if values.dtype.kind == "b":
        return ~values
    if values.dtype == np.uint8 and values.ndim == 2:
        return 255 - values
    whole = values.dtype.kind in "iu"
    kinds = np.unique(values) if whole else np.empty(0)
    if values.ndim == 1 and 2 <= len(kinds) <= KINDS:
        return np.roll(kinds, 1)[np.searchsorted(kinds, values)].astype(values.dtype)
    finite = values if whole else values[np.isfinite(values)]
    if not finite.size:
        return values
    low, high = finite.min(), finite.max()
    return (high - (values - low)).astype(values.dtype)


def _turned(vectors, mesh):
    """Return vectors turned by 90 degrees about the normals of a surface, else about z."""
    axes = np.broadcast_to([0.0, 0.0, 1.0], vectors.shape)
    if isinstance(mesh, pv.PolyData) and mesh.faces.size:
        normals = mesh.compute_normals(
            split_vertices=False, consistent_normals=False, auto_orient_normals=False
        )
        of_points = len(vectors) == mesh.n_points
        axes = np.asarray(normals.point_data["Normals"] if of_points else normals["Normals"])
    along = np.sum(axes * vectors, axis=1, keepdims=True) * axes
    return (np.cross(axes, vectors) + along).astype(vectors.dtype)


def difference(one, other):
    """Return the largest difference of each pixel of two pictures, from 0 to 255."""
    pictures = [np.asarray(Image.open(path).convert("RGB"), dtype=int) for path in (one, other)]
    if pictures[0].shape != pictures[1].shape:
        return np.full((1, 1), 255)
    return np.abs(pictures[0] - pictures[1]).max(axis=2)


def share(one, other):
    """Return the share of pixels in which two pictures differ."""
    return float((difference(one, other) > PIXEL).mean())


@contextlib.contextmanager
def _clock(row, name):
    start = time.process_time()
    yield
    row[name] = f"{time.process_time() - start:.2f}"


def plain(mesh, path):
    """Draw a mesh as ``pyvista.plot`` does."""
    mesh.plot(off_screen=True, screenshot=path, window_size=SIZE)


def ours(path, stem, row, *, figures=False, scripts=False, size=SIZE):
    """Draw a file with its data and with other data by ``vizlight.look``."""
    with _clock(row, "read_s"):
        mesh = vizlight.read(path)
    with _clock(row, "decision_s"):
        look = vizlight.look(mesh, size=size)
    row |= {"question": look.question, "shown": look.shown, "array": look.array or ""}
    row["reason"] = " ".join(look.reason.split())
    with _clock(row, "look_s"):
        look.save(f"{stem}.ours.png")
    job = sum(float(row[name]) for name in ("read_s", "decision_s", "look_s"))
    row["decision_share"] = f"{float(row['decision_s']) / max(job, 0.01):.2f}"
    other, count = changed(mesh)
    if count:
        vizlight.look(other, size=size).save(f"{stem}.other.png")
        row["changes"] = f"{share(f'{stem}.ours.png', f'{stem}.other.png'):.4f}"
        if not verdict(row):
            # The surface of a value stays where it is when values are reversed.
            vizlight.look(changed(mesh, moved=True)[0], size=size).save(f"{stem}.moved.png")
            row["moved"] = f"{share(f'{stem}.ours.png', f'{stem}.moved.png'):.4f}"
    else:
        row["changes"] = "no data"
    if figures:
        row["figures"] = " ".join(repr(look.figures()).split())
    if scripts:
        try:
            row["script"] = f"{from_script(path, stem, size=size)}"
        except (ValueError, RuntimeError, NotImplementedError, subprocess.SubprocessError) as error:
            row["script_error"] = " ".join(str(error).split())[-300:]


def from_script(path, stem, *, size=SIZE):
    """Return the largest difference between a picture of a file and what its script draws."""
    expected, script = Path(f"{stem}.expected.png"), Path(f"{stem}.script.py")
    picture = Path(f"{stem}.script.png")
    look = vizlight.look(path, size=size)
    look.save(expected)
    script.write_text(look.script(picture))
    run = subprocess.run(
        [sys.executable, script], check=False, capture_output=True, text=True, timeout=LIMIT
    )
    if run.returncode:
        raise RuntimeError(run.stderr)
    return int(difference(expected, picture).max())


def pyvistas(path, stem, row):
    """Draw a file with its data and with other data by plain PyVista, as far as it can."""
    with _clock(row, "pyvista_s"):
        mesh = pv.read(path)
        plain(mesh, f"{stem}.pyvista.png")
    other, count = changed(mesh)
    row["pyvista"] = "no data"
    if count:
        plain(other, f"{stem}.pyvista-other.png")
        row["pyvista"] = f"{share(f'{stem}.pyvista.png', f'{stem}.pyvista-other.png'):.4f}"


def alone(path, stem, arguments):
    """Draw a file in this process, and write its row."""
    row = dict.fromkeys(COLUMNS, "") | {"file": Path(path).name}
    warnings.simplefilter("ignore")
    # A file that cannot be drawn is a row that says so.
    try:
        ours(path, stem, row, figures=arguments.figures, scripts=arguments.scripts)
    except Exception as error:  # noqa: BLE001
        row["error"] = " ".join(f"{type(error).__name__}: {error}".split())[:300]
    _keep(stem, row)
    if arguments.ours:
        return
    try:
        pyvistas(path, stem, row)
    except Exception as error:  # noqa: BLE001
        row["pyvista"] = f"cannot: {type(error).__name__}"
    _keep(stem, row)


def _keep(stem, row):
    with Path(f"{stem}.tsv").open("w", newline="") as file:
        csv.DictWriter(file, COLUMNS, delimiter="\t").writerow(row)


def kept(stem):
    """Return the row of a file, or what of it there is."""
    with contextlib.suppress(FileNotFoundError), Path(f"{stem}.tsv").open(newline="") as file:
        for row in csv.DictReader(file, COLUMNS, delimiter="\t"):
            return row
    return dict.fromkeys(COLUMNS, "") | {"error": "the process ended"}


def verdict(row):
    """Return whether the picture of a file changes with its data; None where there are none."""
    if row["changes"] == "no data":
        return None
    return bool(row["changes"]) and float(row["changes"]) > PICTURE


def contact_sheet(stems, rows, path):
    """Write pictures of files in three columns: ours, ours with other data, plain PyVista's."""
    width, height = THUMB
    sheet = Image.new("RGB", (3 * width, len(stems) * (height + 18)), "white")
    pen = ImageDraw.Draw(sheet)
    for number, (stem, row) in enumerate(zip(stems, rows, strict=True)):
        top = number * (height + 18)
        words = f"{row['file']}: {row['question']}, {row['shown']}, {row['array']} {row['error']}"
        pen.text((4, top + 3), words, "black")
        for column, name in enumerate(("ours", "other", "pyvista")):
            with contextlib.suppress(FileNotFoundError):
                picture = Image.open(f"{stem}.{name}.png").convert("RGB")
                picture.thumbnail(THUMB)
                sheet.paste(picture, (column * width, top + 18))
    sheet.save(path)


def _forked(function, *values):
    """Call a function in a fork of this process, and return what went wrong, in words."""
    process = multiprocessing.get_context("fork").Process(target=function, args=values)
    process.start()
    process.join(LIMIT)
    if process.exitcode is None:
        process.kill()
        process.join()
        return f"more than {LIMIT} s"
    return f"exit code {process.exitcode}" if process.exitcode else ""


def _arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("files", nargs="+", type=Path, help="files, or folders of files")
    parser.add_argument("--out", type=Path, default=Path("first_pictures"))
    parser.add_argument("--ours", action="store_true", help="leave plain PyVista out")
    parser.add_argument("--figures", action="store_true", help="what a reader reads back")
    parser.add_argument("--scripts", action="store_true", help="run the script of each picture")
    return parser.parse_args()


def main():
    """Draw the files that are named, each in a fork of this process."""
    arguments = _arguments()
    # What every file needs is imported once, before the forks.
    for name in ("xarray", "meshio", "scipy.spatial", "vizlight.looks.look", "vizlight.draw.live"):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    arguments.out.mkdir(parents=True, exist_ok=True)
    files = [
        path
        for given in arguments.files
        for path in (sorted(given.iterdir()) if given.is_dir() else [given])
        if path.is_file()
    ]
    stems, rows = [], []
    for path in files:
        stem = str(arguments.out / path.name)
        for old in arguments.out.glob(f"{path.name}.*"):
            old.unlink()
        code = _forked(alone, path, stem, arguments)
        row = kept(stem) | {"file": path.name}
        if code:
            row["error"] = f"{row['error']} ({code})".strip()
        stems.append(stem)
        rows.append(row)
        state = {True: "changes", False: "FAILS", None: "no data"}[verdict(row)]
        facts = [row[name] for name in COLUMNS[1:7]]
        print(f"{path.name}: {state}: {', '.join(facts)} {row['error']}", flush=True)
    with (arguments.out / "first_pictures.tsv").open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, delimiter="\t")
        writer.writeheader()
        writer.writerows(rows)
    for start in range(0, len(stems), ROWS):
        part = slice(start, start + ROWS)
        contact_sheet(stems[part], rows[part], arguments.out / f"sheet-{start // ROWS + 1:02d}.png")
    verdicts = [verdict(row) for row in rows if verdict(row) is not None]
    print(f"{sum(verdicts)} of {len(verdicts)} pictures change with their data")


if __name__ == "__main__":
    main()
