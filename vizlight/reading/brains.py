"""Surfaces of brains and arrays over them: GIFTI and FreeSurfer by nibabel; .mz3, .tt."""

from __future__ import annotations

import gzip
import io
import re
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np
import pyvista as pv

from vizlight import _check
from vizlight._types import AnyArray, Foreign
from vizlight.mesh import blocks, meaning
from vizlight.mesh.georeference import UNIT
from vizlight.reading import file_parts, series

#: Name of the array of a volume by the end of the name of its file, where that is not NIfTI.
FORMATS = {".mnc": "MINC", ".mgz": "MGH", ".mgh": "MGH", ".head": "AFNI", ".brik": "AFNI"}
#: Most by which the lengths of directions differ from 1, in the median.
UNIT_LENGTH = 0.01
#: Ends of names of surfaces. FreeSurfer's are known by their first bytes.
SURFACES = (".gii", ".gii.gz", ".mz3", ".annot")
#: Ends of names of volumes.
VOLUMES = (
    ".nii", ".nii.gz", ".mgz", ".mgh", ".mnc", ".head", ".brik", ".brik.gz",
)  # fmt: skip
#: Sides of the box of one hemisphere of the cortex in mm, least and largest, and how far it reaches
#: beyond the middle of the brain.
SIDES, BEYOND = ((50.0, 95.0), (130.0, 205.0), (85.0, 150.0)), 15.0
#: Numbers of points of common templates, and words and units of the arrays that FreeSurfer makes.
TEMPLATES = {2562, 10242, 40962, 163842, 32492}
MEASURES = {
    "thickness": ("cortical thickness", "mm"), "thick": ("cortical thickness", "mm"),
    "curv": ("curvature", "1/mm"),
    "area": ("area", "mm2"), "volume": ("volume", "mm3"), "sulc": ("sulcal depth", ""),
}  # fmt: skip
#: Words of names that say the side alone.
_SIDE = re.compile(r"left|right|[lr]h?")
_NAMED_SIDE = re.compile(r"(?i)(?:^|[\W_])([lr])h[\W_]")
#: Largest cosine between axes that are at right angles: affines are in float32.
SQUARE = 1e-5
#: First bytes of a surface of triangles and of quadrangles, and of numbers for its points.
_FREESURFER, _CURV = (b"\xff\xff\xfe", b"\xff\xff\xfd", b"\xff\xff\xff"), b"\xff\xff\xff"
#: Codes of GIFTI for points and for triangles.
_POINTS, _TRIANGLES = 1008, 1009
#: Length of the header of Analyze and of NIfTI-1, with which it begins.
_HEADER = 348
#: Frames of the transforms of GIFTI, by their codes.
_SPACES = {1: "scanner", 2: "another image", 3: "Talairach", 4: "MNI 152"}
#: Contents of a .mz3 file, bit by bit: type and numbers for each face or point.
_MZ3 = {"faces": ("<i4", 3), "points": ("<f4", 3), "rgb": ("u1", 4), "values": ("<f4", 1)}
_MAGIC = b"MZ"
#: Length of a step of a .tt file: coordinates are multiples of this share of a voxel.
_TT = 32
#: Key of GIFTI, and name of a field array, for the part of the brain that a surface is.
STRUCTURE = "AnatomicalStructurePrimary"
#: Ends of names of CIFTI files, whose maps have names of their own.
MAPS = (".dscalar.nii", ".dlabel.nii")
#: Units of time as NIfTI names them.
_SECONDS = {"sec": "s", "msec": "ms", "usec": "µs"}
#: Note on values at the points of a surface, such as its curvature.
NO_SURFACE = "values over a surface, without one: read the surface, and pass this file as overlay="


def is_freesurfer(path: Path) -> bool:
    """Return whether a file begins like FreeSurfer's surfaces and arrays."""
    return file_parts.first_bytes(path, 3) in _FREESURFER


def word_and_unit(name: str) -> tuple[str, str]:
    """Return the word and the unit of an array that FreeSurfer makes, empty for others.

    The name is with the side or without, such as lh.curv.
    """
    words = [word for word in re.split(r"[\W_]+", name.lower()) if not _SIDE.fullmatch(word)]
    return MEASURES.get(words[0], ("", "")) if len(words) == 1 else ("", "")


def hemisphere(surface: pv.DataSet) -> str:
    """Return which hemisphere of the cortex a surface is, left or right; empty for all else.

    It is known by the name of an array that FreeSurfer makes, with its side, such as lh.curv; else
    by its size in mm, the side of the middle on which it lies, x to the right, a surface without
    handles, and the number of its points or the name of an array.
    """
    if not isinstance(surface, pv.PolyData) or surface.n_cells != 2 * surface.n_points - 4:
        return ""
    measures = [name for name in surface.point_data if word_and_unit(name)[0]]
    if said := _NAMED_SIDE.search(" ".join(measures)):
        return "left" if said[1].lower() == "l" else "right"
    if surface.n_points not in TEMPLATES and not measures:
        return ""
    bounds = np.reshape(surface.bounds, (3, 2))
    if any(
        not low < size < high
        for size, (low, high) in zip(np.ptp(bounds, axis=1), SIDES, strict=True)
    ):
        return ""
    left, right = bounds[0]
    return "left" if right < BEYOND else "right" if left > -BEYOND else ""


def is_pair(path: Path) -> bool:
    """Return whether a file is one of the two of Analyze or NIfTI, of a header and its image."""
    header = path.with_suffix(".hdr")
    if path.suffix.lower() not in (".hdr", ".img") or not header.is_file():
        return False
    size = file_parts.first_bytes(header, 4)
    return _HEADER in (int.from_bytes(size, "little"), int.from_bytes(size, "big"))


def read(path: Path) -> pv.PolyData:
    """Return the surface of a file, with the arrays of its points."""
    import nibabel

    name = path.name.lower()
    arrays: dict[str, AnyArray] = {}
    notes: list[str] = []
    structure = ""
    if name.endswith(".mz3"):
        arrays = _mz3(path)
        points, faces = arrays.pop("points", None), arrays.pop("faces", None)
    elif name.endswith((".gii", ".gii.gz")):
        points, faces, arrays, notes, structure = _gifti(path)
    elif name.endswith(".annot") or path.read_bytes()[:3] == _CURV:
        points = faces = None
    else:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "No volume information|Unknown extension")
            points, faces, header = nibabel.freesurfer.read_geometry(path, read_metadata=True)
        notes = _shift(header.get("cras", (0.0, 0.0, 0.0)))
    if points is None or faces is None:
        raise ValueError(NO_SURFACE)
    # Native float32 stays; all else, such as bytes in another order, becomes float64.
    kind = points.dtype if points.dtype == np.float32 else np.float64
    mesh: pv.PolyData = pv.PolyData.from_regular_faces(points.astype(kind), faces)
    for key, rows in arrays.items():
        mesh.point_data[key] = rows
    if structure:
        mesh.field_data[STRUCTURE] = [structure]
    if notes:
        meaning.attach(mesh, meaning.Meaning(notes=notes))
    return mesh


def _shift(centre: Sequence[float]) -> list[str]:
    """Return the note on a surface of FreeSurfer, which has its origin at a volume's centre."""
    if not np.any(centre):
        return []
    numbers = ", ".join(f"{number:g}" for number in centre)
    return [f"points as in the file; plus its c_ras ({numbers}), not added, they fit its volume"]


def volume(path: Path, time: object) -> pv.ImageData | pv.StructuredGrid:
    """Return a volume by nibabel in its frame: RAS, in millimetres, by the affine of its header.

    The file is one of NIfTI, FreeSurfer (.mgz), AFNI (.head) or MINC (.mnc). If it has several
    steps, as functional images do, that of ``time`` is loaded, as by :func:`.series.chosen`.
    """
    import nibabel

    image: Foreign = nibabel.load(path)
    if getattr(image, "affine", None) is None:
        raise ValueError(
            "values of brain models (CIFTI), without their places: read the surface of one, and "
            "pass this file as overlay="
        )
    affine, shape = np.asarray(image.affine, dtype=np.float64), image.shape
    steps = int(shape[3]) if len(shape) > 3 else 1
    part: Foreign = image.dataobj
    times, index = [], 0
    if time is None and _are_directions(part, shape):
        steps, part = 1, np.asanyarray(part)[:, :, :, np.newaxis]
    if steps > 1:
        zooms = image.header.get_zooms()
        # Headers without a duration have 0, and steps are then counted.
        width = float(zooms[3]) if len(zooms) > 3 and zooms[3] > 0 else 1.0
        times = [width * i for i in range(steps)]
        index = series.chosen(times, time)
    # Slices of the proxy read a single step of the file.
    rows = np.asanyarray(part[..., index] if part.ndim == 4 else part)
    # A vector at each voxel has its components on the fifth axis.
    if rows.ndim == 5 and rows.shape[3] == 1:
        rows = rows[:, :, :, 0]
    if rows.dtype.names:  # colours
        rows = np.stack([rows[name] for name in rows.dtype.names], axis=-1)
    rows = rows.reshape(*rows.shape, *[1] * (3 - rows.ndim))
    if rows.ndim not in (3, 4) or rows.dtype.kind not in "biuf":
        raise ValueError(f"{rows.dtype} numbers of shape {rows.shape} are no volume")
    if np.count_nonzero(np.array(rows.shape[:3]) > 1) == 1:
        raise ValueError(NO_SURFACE)
    grid = turned(rows, affine, FORMATS.get(path.suffix.lower(), "NIFTI"))
    mark_as_body(grid, "affine", affine)
    if steps < 2:
        return grid
    units: Foreign = getattr(image.header, "get_xyzt_units", lambda: ("", ""))
    said = meaning.of(grid)
    said.time = _SECONDS.get(units()[-1], "")
    meaning.attach(grid, said)
    series.marked(grid, times, index)
    return grid


def turned(rows: AnyArray, affine: AnyArray, name: str) -> pv.ImageData | pv.StructuredGrid:
    """Return a grid of values, with axes that run backward turned over, and put in order.

    ``rows``, (I, J, K) or (I, J, K, C), are in the order of a file; ``affine`` takes i, j, k to
    places, which stay.
    """
    order, signs = _axes_of(affine)
    rows = np.transpose(rows, (*order, *range(3, rows.ndim)))
    backward = np.flatnonzero(signs < 0)
    ends = affine[:3, order[backward]] @ (np.array(rows.shape)[backward] - 1)
    rows = np.flip(rows, tuple(backward.tolist()))
    affine = np.column_stack([affine[:, order] * signs, affine[:, 3]])
    affine[:3, 3] += ends
    grid = of_affine(affine, rows.shape[:3])
    kind = np.float32 if rows.dtype == np.float16 else rows.dtype.newbyteorder("=")
    grid.point_data[name] = np.ascontiguousarray(rows, dtype=kind).reshape(
        -1, *rows.shape[3:], order="F"
    )
    return grid


def _axes_of(affine: AnyArray) -> tuple[AnyArray, AnyArray]:
    """Return which axis of storage runs along x, y and z, and whether forward, 1, or back, -1."""
    lengths = np.linalg.norm(affine[:3, :3], axis=0)
    left, _, right = np.linalg.svd(affine[:3, :3] / np.where(lengths > 0, lengths, 1.0))
    # The nearest matrix of axes at right angles, of which each stands for the one it is most along.
    nearest = left @ right
    order, signs = np.zeros(3, dtype=int), np.ones(3)
    sizes = np.abs(nearest)
    # The axis that is most along one of x, y and z first.
    for stored in np.argsort(-sizes.max(axis=0), kind="stable"):
        place = int(np.argmax(sizes[:, stored]))
        order[place], signs[place] = stored, 1.0 if nearest[place, stored] >= 0 else -1.0
        sizes[place] = -1.0
    return order, signs


def mark_as_body(grid: pv.DataSet, word: str, affine: AnyArray) -> None:
    """Say of a grid that its axes are those of a body, in mm.

    ``word`` is the part of the header that says so, ``affine`` the matrix by which the file stores
    it.
    """
    grid.field_data[UNIT] = ["millimetre"]
    said = meaning.of(grid)
    said.axes = [*meaning.ANATOMY]
    order, signs = _axes_of(affine)
    letters = np.where(signs > 0, ("R", "A", "S"), ("L", "P", "I"))
    stored = "".join(letters[np.argsort(order)])
    said.axes[-1] += f", in mm by the {word} of the header (stored {stored})"
    meaning.attach(grid, said)


def _are_directions(part: Foreign, shape: Sequence[int]) -> bool:
    """Return whether three volumes are components of vectors, which are of length 1 or 0."""
    if len(shape) != 4 or shape[3] != 3 or part.dtype.kind != "f":
        return False
    lengths = np.linalg.norm(np.asanyarray(part), axis=3)
    lengths = lengths[lengths > 0]
    return len(lengths) > 0 and float(np.median(np.abs(lengths - 1))) < UNIT_LENGTH


def of_affine(affine: AnyArray, counts: Sequence[int]) -> pv.ImageData | pv.StructuredGrid:
    """Return a grid with its point i, j, k at the affine times these."""
    spacing = np.linalg.norm(affine[:3, :3], axis=0)
    axes = affine[:3, :3] / np.where(spacing > 0, spacing, 1)
    if np.allclose(axes.T @ axes, np.eye(3), atol=SQUARE):
        image = pv.ImageData(dimensions=counts, spacing=spacing, origin=affine[:3, 3])
        if not np.allclose(axes, np.eye(3), atol=1e-7):
            image.direction_matrix = axes
        return image
    # Sheared: no axes at right angles.
    ijk = np.stack(np.meshgrid(*map(np.arange, counts), indexing="ij"), axis=-1).reshape(
        -1, 3, order="F"
    )
    points = np.asarray(ijk @ affine[:3, :3].T + affine[:3, 3], np.float64)
    return blocks.structured(points, counts)


def overlay(path: Path, surface: pv.DataSet) -> tuple[dict[str, AnyArray], meaning.Meaning]:
    """Return the arrays of a file for the points of a surface, by the name of the file.

    The meaning has the names and colours of regions, as .annot, GIFTI and CIFTI have them.
    """
    import nibabel

    count = surface.n_points
    name = re.sub(r"\.gz$", "", path.name)
    stem = name.removesuffix(".gii")
    regions: list[tuple[int, str, Sequence[float]]] = []
    if name.endswith(".mz3"):
        # Such a file may have a surface beside its values.
        arrays = {key: rows for key, rows in _mz3(path).items() if key in ("values", "rgb")}
    elif name.endswith(".gii"):
        arrays = _gifti(path)[2]
        labels: Foreign = nibabel.load(path)
        regions = [(one.key, one.label or "", one.rgba) for one in labels.labeltable.labels]
    elif name.endswith(".annot"):
        # Indices of regions in the table of colours, -1 for none.
        values, colors, names = nibabel.freesurfer.read_annot(path)
        arrays = {"values": values}
        regions = [(i, names[i].decode(), row[:3] / 255) for i, row in enumerate(colors)]
    elif path.name.lower().endswith(VOLUMES):
        volume: Foreign = nibabel.load(path)
        if isinstance(volume, nibabel.Cifti2Image):
            arrays, regions = _of_models(volume, path, surface)
        else:
            # Values of a surface in the form of a volume, mostly of N x 1 x 1 voxels.
            arrays = {"values": np.asarray(volume.dataobj).reshape(-1)}
    else:
        arrays = {"values": nibabel.freesurfer.read_morph_data(path)}
    other = {len(rows) for rows in arrays.values()} - {count}
    if other or not arrays:
        got = f"{min(other)} values" if other else "no values"
        raise ValueError(f"its overlay '{path}' has {got} for a surface of {count} points")
    single = len(arrays) == 1
    if not name.endswith(MAPS):
        arrays = {stem if single else f"{stem}_{key}": rows for key, rows in arrays.items()}
    said = meaning.Meaning()
    if regions:
        for key, rows in arrays.items():
            if rows.dtype.kind in "iu":
                said.add_kinds(key, regions)
    return arrays, said


def _of_models(
    image: Foreign, path: Path, surface: pv.DataSet
) -> tuple[dict[str, AnyArray], list[tuple[int, str, Sequence[float]]]]:
    """Return the maps of a CIFTI file over one surface, and the names and colours of regions.

    Points of which the file has no value, such as those of the medial wall, have NaN or label 0.
    """
    maps, models = (image.header.get_axis(i) for i in (0, 1))
    said = surface.field_data.get(STRUCTURE, None)
    side = (f"cortex{hemisphere(surface)}" if said is None else str(said[0])).lower()
    parts = [
        (part, model.vertex)
        for name, part, model in models.iter_structures()
        if name.removeprefix("CIFTI_STRUCTURE_").replace("_", "").lower() == side
        and models.nvertices.get(name) == surface.n_points
    ]
    if not parts:
        names = ", ".join(f"{name} of {count}" for name, count in models.nvertices.items())
        expected = f"values at the points of {names or 'no surface'}"
        got = f"for a surface of {surface.n_points} points, {side}"
        raise ValueError(f"its overlay '{path}' has {expected} {got}")
    (part, points), labels = parts[0], getattr(maps, "label", None)
    # The steps of a series have no names; slices of the proxy read the last one alone.
    is_series = not hasattr(maps, "name")
    rows = np.asarray(image.dataobj[-1:, part] if is_series else image.dataobj[:, part])
    kind, absent = (np.int32, 0) if labels is not None else (np.float32, np.nan)
    whole = np.full((len(rows), surface.n_points), absent, dtype=kind)
    whole[:, points] = rows
    if is_series:
        if len(maps) > 1:
            _check.warn(f"overlay: '{path}': the last of its {len(maps)} steps is taken")
        return {"values": whole[-1]}, []
    named = {str(name): row for name, row in zip(maps.name, whole, strict=True)}
    regions = [] if labels is None else [(key, *one) for key, one in labels[0].items()]
    return named, regions


def _gifti(path: Path) -> tuple[Foreign, Foreign, dict[str, AnyArray], list[str], str]:
    """Return points, triangles, other arrays, the note on the frame, and the part of the brain."""
    import nibabel

    image: Foreign = nibabel.load(path)
    parts: dict[int, Foreign] = {}
    arrays: dict[str, AnyArray] = {}
    notes: list[str] = []
    structure = str(image.meta.get(STRUCTURE, ""))
    for i, part in enumerate(image.darrays):
        if part.intent in (_POINTS, _TRIANGLES):
            parts[part.intent] = np.asarray(part.data)
            if part.intent == _POINTS:
                notes = _transform(part)
                structure = str(part.meta.get(STRUCTURE, structure))
        else:
            kind = nibabel.nifti1.intent_codes.label[part.intent]
            name = part.meta.get("Name") or kind.removeprefix("NIFTI_INTENT_").lower()
            arrays[name if name not in arrays else f"{name}_{i}"] = np.asarray(part.data)
    points = parts.get(_POINTS)
    if points is not None:
        # Arrays of another length are those of faces, or of another surface.
        arrays = {key: rows for key, rows in arrays.items() if len(rows) == len(points)}
    return points, parts.get(_TRIANGLES), arrays, notes, structure


def _transform(part: Foreign) -> list[str]:
    """Return the note on a frame in which a GIFTI file says that its points can be put."""
    system = part.coordsys
    turn = np.eye(4) if system is None or system.xform is None else np.reshape(system.xform, (4, 4))
    if np.allclose(turn, np.eye(4)):
        return _shift([float(part.meta.get(f"VolGeomC_{axis}", 0)) for axis in "RAS"])
    space = _SPACES.get(int(system.xformspace), "another frame")
    rows = "; ".join(" ".join(f"{number:g}" for number in row) for row in turn[:3])
    return [f"points as in the file; its transform to {space}, not applied, is [{rows}]"]


def _mz3(path: Path) -> dict[str, AnyArray]:
    """Return the parts of a .mz3 file. No package for Python reads it."""
    data = path.read_bytes()
    # Most are packed by gzip, and their names do not say so.
    if not data.startswith(_MAGIC):
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError) as error:
            raise ValueError(f"no .mz3 file: {error}") from error
    if not data.startswith(_MAGIC):
        raise ValueError("no .mz3 file")
    # The header: two bytes of magic, bits of what is there, then the numbers of faces, of points
    # and of bytes to skip before the first part.
    parts = int.from_bytes(data[2:4], "little")
    faces, points, skip = (int(number) for number in np.frombuffer(data, "<u4", 3, 4))
    at, arrays = 16 + skip, {}
    # Parts stand in the order of their bits.
    for bit, (name, (kind, width)) in enumerate(_MZ3.items()):
        if parts >> bit & 1:
            rows = faces if name == "faces" else points
            array = np.frombuffer(data, kind, rows * width, at)
            at += array.nbytes
            arrays[name] = array.reshape(rows, width) if width > 1 else array
    # The fourth is the opacity.
    if "rgb" in arrays:
        arrays["rgb"] = arrays["rgb"][:, :3]
    return arrays


def tracks_of_tt(path: Path) -> tuple[AnyArray, AnyArray, AnyArray]:
    """Return the points of tracts of DSI Studio, where each begins, and their numbers of points.

    The file is one of MATLAB 4; a tract is its number of coordinates, its first point in 32nds of
    a voxel, and steps of a byte for each further coordinate. Points are in mm, by ``trans_to_mni``
    if the file has it.
    """
    from scipy.io import loadmat

    data = path.read_bytes()
    whole: Foreign = io.BytesIO(gzip.decompress(data) if path.suffix.lower() == ".gz" else data)
    parts = loadmat(whole)
    blob = np.ascontiguousarray(parts["track"]).tobytes()
    lines, at = [], 0
    while at < len(blob):
        # The first three coordinates have four bytes each, all others are steps of one byte.
        size = int.from_bytes(blob[at : at + 4], "little") - 3
        first = np.frombuffer(blob, "<i4", 3, at + 4)
        # In int64, for a running sum of bytes would overflow.
        steps = np.frombuffer(blob, "i1", size, at + 16).reshape(-1, 3).astype(np.int64)
        lines.append(np.cumsum(np.concatenate([first[np.newaxis], steps]), axis=0))
        at += 16 + size
    counts = np.array([len(line) for line in lines], dtype=np.intp)
    places = np.concatenate(lines) / _TT if lines else np.empty((0, 3))
    if "trans_to_mni" in parts:
        turn = np.reshape(parts["trans_to_mni"], (4, 4))
        points = places @ turn[:3, :3].T + turn[:3, 3]
    else:
        # In mm along the axes of the image, from its first voxel.
        points = places * np.ravel(parts["voxel_size"])
    return points, np.cumsum(counts) - counts, counts


def read_tri(path: Path) -> pv.PolyData | None:
    """Return the surface of a .tri file in text, of brains; None for one of marching cubes.

    A number of points stands before these and their normals, and three of triangles before theirs.
    """
    if file_parts.first_bytes(path, 2) != b"- ":
        return None
    words = path.read_bytes().split()
    n_points = int(words[1])
    end = 2 + 6 * n_points
    rows = np.array(words[2:end], dtype=np.float64).reshape(n_points, 6)
    faces = np.array(words[end + 4 :], dtype=int).reshape(-1, 3)
    # The normals point in or out, by the program, and are left out.
    surface: pv.PolyData = pv.PolyData.from_regular_faces(rows[:, :3].copy(), faces)
    return surface


def missing_of_gifti(file: BinaryIO) -> str:
    """Check the numbers of axes, to which nibabel counts."""
    data = file.read()
    stated = re.search(rb'NumberOfDataArrays="(\d+)"', data)
    if stated and int(stated[1]) != (there := data.count(b"<DataArray")):
        return f"{there} of {int(stated[1])} arrays are there"
    numbers = re.findall(rb'Dimensionality="([^"]*)"', data)
    wrong = [number.decode("latin-1") for number in numbers if number not in _AXES]
    return f"an array of {wrong[0]} axes" if wrong else ""


_AXES = [b"%d" % number for number in range(1, 7)]
