"""Writing of meshes: whole or not at all, by a draft beside the file that is moved to its place."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import shutil
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray

from vizlight import _check, _supervise
from vizlight.mesh import blocks, height_grids
from vizlight.mesh.blocks import DataSetT
from vizlight.mesh.derived import check_dataset, warped
from vizlight.reading import formats
from vizlight.reading.paths import checked_path, no_file, wrong
from vizlight.reading.reader import FINE, shortest
from vizlight.vtk import messages

try:
    import fcntl
except ImportError:  # on Windows
    fcntl = None  # type: ignore[assignment]

#: File formats that keep point and field arrays, by type of mesh.
FORMATS: dict[str, tuple[str, ...]] = {
    "PolyData": (".vtp", ".vtk", ".vtu", ".stl"),
    "UnstructuredGrid": (".vtu", ".vtk"),
    "StructuredGrid": (".vts", ".vtk"),
    "RectilinearGrid": (".vtr", ".vtk"),
    "ImageData": (".vti", ".vtk", ".stl"),
    "MultiBlock": (".vtm",),
}
#: Thickness of the base of a solid below a height field, as a share of its longer side.
BASE = 0.02
SUFFIXES = tuple(dict.fromkeys(suffix for kind in FORMATS.values() for suffix in kind))
#: Begin of the names of temporary folders, of those without a lock yet, and the time in seconds
#: after which one of these is swept.
DRAFTS, FRESH, ABANDONED = ".vizlight-file-", ".vizlight-new-", 60.0


def check_output(path: str | Path, /, formats: tuple[str, ...], *, name: str = "path") -> Path:
    """Return the path of an output file, if the file can be written.

    ``formats`` are the allowed file name extensions, each with its dot, and ``name`` is that of the
    argument in messages.
    """
    path = checked_path(name, path)
    try:
        path.absolute()
    except FileNotFoundError as error:
        got = f"'{path}' in a working folder that is gone"
        raise wrong(name, "a folder that exists", got) from error
    if path.suffix.lower() not in formats:
        raise wrong(name, f"a name that ends in {', '.join(formats)}", f"'{path}'")
    if not path.parent.is_dir():
        raise wrong(name, "a folder that exists", f"'{path.parent}'", "make it first")
    _refuse_others(name, path)
    if not os.access(path.parent, os.W_OK):
        raise wrong(name, "a writable folder", f"'{path.parent}', which is read-only")
    return path


def check_format(mesh: pv.DataSet | pv.MultiBlock, path: str | Path, /) -> Path:
    """Return the path, if its extension belongs to a format for this type of mesh."""
    for block in blocks.all_blocks(mesh) if isinstance(mesh, pv.MultiBlock) else [mesh]:
        check_dataset(block)
    path, kind = checked_path("output", path), type(mesh).__name__
    if kind not in FORMATS:
        raise wrong("mesh", f"one of {', '.join(FORMATS)}", kind, "cast it to one of them")
    formats = FORMATS[kind]
    if path.suffix.lower() not in formats:
        expected = f"a name that ends in {', '.join(formats)} for {kind}"
        remedy = "it is one mesh, which has no blocks" if path.suffix.lower() == ".vtm" else ""
        raise wrong("output", expected, f"'{path.name}'", remedy)
    return path


def write_mesh(mesh: pv.DataSet | pv.MultiBlock, path: str | Path, /) -> Path:
    """Write a mesh with its arrays; no partial file is left.

    Parameters
    ----------
    mesh : pyvista.DataSet or pyvista.MultiBlock
        Mesh to write.
    path : path
        Path of the file, in an existing folder. Its extension, one of .vtp, .vtu, .vtk, .vts,
        .vti and .vtr, or .vtm for several blocks, determines the format; .stl has no arrays, and
        of an image the solid below its active heights; far from the origin it is moved there, with
        a warning. An existing file is replaced. The blocks are in a folder beside the .vtm file,
        which has its name without the extension.

    Returns
    -------
    pathlib.Path
        Path of the file.

    Raises
    ------
    FileError
        If the format does not support the type of mesh, or the file cannot be written.
    """
    path = check_format(mesh, path)
    for block in blocks.all_blocks(mesh):
        _check_names(block, legacy=path.suffix.lower() == ".vtk")
    if path.suffix.lower() == ".vtu" and isinstance(mesh, pv.PolyData):
        mesh = mesh.cast_to_unstructured_grid()
    # STL has no cells but triangles.
    if path.suffix.lower() == ".stl":
        mesh = _resolved(mesh if isinstance(mesh, pv.ImageData) else mesh.triangulate())
        mesh = _solid(mesh) if isinstance(mesh, pv.ImageData) else mesh

    # Files of blocks are moved there when all of them are whole.
    folder = path.with_suffix("")

    def save(draft: str) -> None:
        _reserve(Path(draft), blocks.all_blocks(mesh))
        copies = blocks.like(mesh, map(_to_save, blocks.all_blocks(mesh)))
        with messages.captured_errors() as errors:
            copies.save(draft)
        # VTK writes the files of the blocks to a folder that has the name of the draft.
        files = sorted(Path(draft).with_suffix("").glob("*"))
        _check_drafts([Path(draft), *files], errors)
        for file in files:
            file.replace(folder / file.name)

    if not isinstance(mesh, pv.MultiBlock):
        return replace_file(path, save)
    make_folder("output", folder)
    try:
        return replace_file(path, save)
    finally:
        with contextlib.suppress(OSError):  # it is removed if nothing is in it
            folder.rmdir()


def _resolved(mesh: DataSetT) -> DataSetT:
    """Return a mesh moved to the origin if float32, which .stl has, does not resolve its points."""
    origin = np.array(blocks.near_origin(mesh))
    if np.finfo(np.float32).eps * np.abs(origin).max() < FINE * shortest(mesh):
        return mesh
    words = ", ".join(f"{-part:.9g}" for part in origin)
    _check.warn(
        f"output: the mesh is moved by ({words}), since the float32 numbers of .stl do not "
        "resolve its points where it is"
    )
    return blocks.moved(mesh, -origin)


def _solid(field: pv.ImageData) -> pv.PolyData:
    """Return the closed surface of a height field above a level base."""
    name = height_grids.heights_name(field)
    if name is None or min(field.dimensions[:2]) < 2 or field.dimensions[2] != 1:
        expected = "an image of one layer with an active array of heights, for .stl"
        raise wrong("mesh", expected, _check.describe(field))
    top = warped(field, name, 1.0).extract_surface(algorithm="dataset_surface")
    base = top.bounds.z_min - BASE * max(field.bounds_size[:2])
    middle = (top.center[0], top.center[1], base)
    # The plane is larger than the field on all sides, so that all walls end at it.
    plane = pv.Plane(center=middle, i_size=3 * top.length, j_size=3 * top.length)
    solid: pv.PolyData = top.extrude_trim((0, 0, -1), plane).clean().triangulate()
    return solid


def _to_save(mesh: pv.DataSet) -> pv.DataSet:
    """Return a copy, because PyVista notes the types of arrays in the mesh that it saves."""
    copy = mesh.copy(deep=False)
    if isinstance(copy, pv.UnstructuredGrid) and copy.GetCells() is None:
        copy.SetCells(vtkUnsignedCharArray(), pv.CellArray())  # VTK's writer ends the process
    for data in (copy.GetPointData(), copy.GetCellData()):
        for kind in range(data.NUM_ATTRIBUTES):
            # VTK ends the process where the active normals or vectors are text.
            if data.GetAbstractAttribute(kind) is not None and data.GetAttribute(kind) is None:
                data.SetActiveAttribute(-1, kind)
    return copy


def _check_names(mesh: pv.DataSet, *, legacy: bool) -> None:
    """Check that a file can hold the names of the arrays.

    VTK's writers of XML do not escape them; its writer of legacy files ends the process at braces.
    """
    odd, signs = '[<&"\x00-\x1f]', "<, &, quotation marks and control characters"
    other = "a .vtk file"
    if legacy:
        odd, signs, other = "[{}]", "braces in a legacy file", "a file of XML, such as .vtp"
    for data in (mesh.point_data, mesh.cell_data, mesh.field_data):
        for name in data:
            if re.search(odd, name):
                expected = f"array names without {signs}"
                raise wrong("output", expected, repr(name), f"rename the array, or write {other}")


def _reserve(draft: Path, meshes: Iterable[pv.DataSet]) -> None:
    """Check that the disk, a quota and the limit of file sizes leave room for meshes.

    VTK's writers end the process where they do not. Space that is reserved and released tells of
    all three.
    """
    # Text of base64 has 4 bytes for 3.
    size = sum(mesh.actual_memory_size for mesh in meshes) * 1024 * 4 // 3 + 65536
    if hasattr(os, "posix_fallocate"):
        with draft.open("wb") as file:
            try:
                os.posix_fallocate(file.fileno(), 0, size)
            except OSError as error:
                # By these errors a file system says that it cannot reserve space; the free space is
                # asked for below.
                if error.errno not in (errno.EINVAL, errno.EOPNOTSUPP, errno.ENOSYS):
                    expected = f"{size / 1e6:.1f} MB of free disk"
                    got = f"'{draft.parent.parent}' ({error.strerror})"
                    raise wrong("output", expected, got) from error
        draft.unlink()
    free = shutil.disk_usage(draft.parent).free
    if size > free:
        got = f"{free / 1e6:.1f} MB in '{draft.parent.parent}'"
        raise wrong("output", f"{size / 1e6:.1f} MB of free disk", got)


def _check_drafts(drafts: Iterable[Path], errors: list[str]) -> None:
    """Check that written files are whole, by the messages of the writer and by their ends."""
    reasons = [formats.missing_part(draft) if draft.is_file() else "none" for draft in drafts]
    for reason in (*errors, *filter(None, reasons)):
        raise wrong("output", "a file that can be written", reason)


def _refuse_others(name: str, path: Path) -> None:
    """Raise FileError where a path is no regular file, such as a folder or a pipe, but exists."""
    if path.exists() and (what := no_file(path)):
        raise wrong(name, "a file", f"'{path}' ({what})")


def _sweep(place: Path) -> None:
    """Remove the temporary folders of writers that were killed: those still at work lock theirs."""
    for folder in [*place.glob(f"{DRAFTS}*"), *place.glob(f"{FRESH}*")] if fcntl else ():
        with contextlib.suppress(OSError), _opened(folder) as opened:
            # An error says that it is locked, another's, or gone.
            fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
            # A fresh one may belong to a writer that has just made it.
            age = time.time() - os.fstat(opened).st_mtime
            if folder.name.startswith(DRAFTS) or age > ABANDONED:
                shutil.rmtree(folder)


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[None]:
    """Hold the lock of a temporary folder, where the system has such locks."""
    if not fcntl:
        yield
        return
    with _opened(folder) as opened:
        # Who sweeps asks for the lock that excludes others, which is refused while a writer holds
        # this one.
        with contextlib.suppress(OSError):  # the file system has none
            fcntl.flock(opened, fcntl.LOCK_SH)
        yield


@contextlib.contextmanager
def _opened(folder: Path) -> Iterator[int]:
    opened = os.open(folder, os.O_RDONLY)
    try:
        yield opened
    finally:
        os.close(opened)


def make_folder(name: str, path: Path, /) -> None:
    """Make a folder and those above it; ``name`` is the argument in the error message."""
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise wrong(name, "a folder that can be made", f"'{path}' ({error.strerror})") from error


def replace_file(
    path: Path, write: Callable[[str], object], *, doing: _supervise.Doing = "write"
) -> Path:
    """Write a file in a temporary folder and move it to its path, so that no partial file is left.

    An existing file is replaced. ``write`` takes a path as a string; ``doing`` is its work, for the
    message if it ends the process.
    """
    path = checked_path("output", path)
    _refuse_others("output", path)
    target = path.resolve()  # a symbolic link stays, and what it points to is replaced
    _sweep(target.parent)
    # A parent knows of the folder before it is there and until it is gone. It has its name from the
    # time of its lock on: others sweep folders of that name without one.
    number = uuid.uuid4().hex[:12]
    fresh, folder = (target.parent / f"{begin}{number}" for begin in (FRESH, DRAFTS))
    try:
        with (
            _supervise.stage(doing, path, temporary=str(fresh)),
            _supervise.stage(doing, path, temporary=str(folder)),
        ):
            fresh.mkdir(mode=0o700)
            try:
                with _locked(fresh):
                    fresh.rename(folder)
                    draft = folder / f"{path.stem}{path.suffix.lower()}"
                    write(str(draft))
                    # A file that is replaced hands on its permissions.
                    if target.exists():
                        draft.chmod(target.stat().st_mode)
                    # Within a file system a file is moved at once: readers see the old one or the
                    # new one.
                    draft.replace(target)
            finally:
                # Without its lock another writer may sweep it at the same time.
                shutil.rmtree(folder if folder.exists() else fresh, ignore_errors=True)
    except OSError as error:
        got = f"'{path}' ({error.strerror})"
        raise wrong("output", "a file that can be written", got) from error
    return path
