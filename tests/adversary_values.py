"""Adversarial values by the kind of an argument, which its annotation states."""

import re

import numpy as np
import pyvista as pv
from vtkmodules.vtkCommonCore import vtkFloatArray

import vizlight

#: Kinds of arguments by what their annotations contain, as regular expressions.
KINDS = {
    "array": r"Array|VectorLike|Indices|Bools|Sequence\[|ColorLike|object|Levels|csr_array|tuple\[|"
    r"Picture\b",
    "number": r"\b(int|float)\b|FeatureAngle|Levels|object|Fraction|LightAt",
    "flag": r"\bbool\b",
    "text": r"\bstr\b|Model|Measure|Border|Method|Form\b|Facing|Precision|LightWhen|Literal|"
    r"ColorMap|ColorLike|FeatureAngle|Tangents\b|Backend|AntiAliasing|PictureLight|LightAt|DTypeLike|"
    r"Picture\b|Lights|AnyView|object",
    "mesh": r"pv\.(PolyData|DataSet|DataObject|MultiBlock)|MeshT|\bMesh\b|Picture\b",
    "path": r"\bPath\b",
    "callable": r"Callable|Function|Progress|Observer",
    "other": r"Scene|Material|\bView\b|Light\b|Lights|AnyView|Solid|Camera|Plotter|DepthCue|Actor|"
    r"vtkProperty|Bundle|Manifold|Mapping|Panel|Study|Result|Row|ShadingInputs|ShadingOptions|Iterable",
}
#: More elements than any memory holds, though the view of one number takes 8 bytes.
HUGE = 2**45


def kinds(text):
    """Return the kinds of an annotation; those of a function's arguments do not count."""
    text = re.sub(r"Callable\[.*\]", "Callable", text)
    return [kind for kind, pattern in KINDS.items() if re.search(pattern, text)]


def of(text, valid):
    """Return labels and adversarial values for an argument, given its valid value or None."""
    found = {}
    for kind in kinds(text):
        found.update({f"{kind}:{label}": value for label, value in MAKERS[kind](valid).items()})
    return list(found.items())


def fresh(value):
    """Return a value of which a call may change nothing that another call sees."""
    if isinstance(value, Maker):
        return value.make()
    if (
        type(value) is np.ndarray
        and value.dtype.kind != "O"
        and 0 < value.size < 1e7
        and 0 not in value.strides
    ):
        copied = np.array(value, order="K")
        if copied.strides == value.strides:
            copied.flags.writeable = value.flags.writeable
            return copied
    return value


class Maker:
    """A value that is made anew for each call, such as a mesh."""

    def __init__(self, make):
        self.make = make


def arrays(valid):
    """Return arrays and what is none, derived from a valid array."""
    try:
        base = np.array([0.0, 0.0, 1.0] if valid is None else valid)
    except ValueError:
        base = np.array(0)
    base = base if base.dtype.kind in "iufb" and base.ndim else np.array([0.0, 0.0, 1.0])
    base = base.astype(np.int64) if base.dtype == np.uint8 else base
    real = base.astype(np.float64)
    found = {
        "None": None,
        "string": "x",
        "object": np.array([None, "x", {}], dtype=object),
        "ragged": [[1.0, 2.0], [3.0]],
        "empty": np.zeros(0),
        "no rows": np.zeros((0, 3)),
        "0-d": np.array(0.5),
        "4-d": np.ones((2, 1, 2, 3)),
        "complex": real * (1 + 1j),
        "int8": np.clip(real, -100, 100).astype(np.int8),
        "datetime": np.full(real.shape, np.datetime64("2026-01-01")),
        "dict": {"a": 1},
        "masked": np.ma.masked_array(real, np.arange(real.size).reshape(real.shape) == 0),
        "float16": real.astype(np.float16),
        "longdouble": real.astype(np.longdouble),
        "zeros": np.zeros(real.shape),
        "huge": np.broadcast_to(real[:1], (HUGE, *real.shape[1:])),
        "huge number": [10**400, 0, 0],
        "record": np.zeros(3, dtype=[("x", float), ("y", float)]),
        "swapped bytes": real.astype(">f8"),
        "negative": -base if base.dtype.kind in "if" else real,
        "short last axis": base[..., :-1],
        "long last axis": np.concatenate([base, base[..., :1]], axis=-1),
        "short first axis": base[1:],
        "one more axis": base[None],
        "read-only": base.copy(),
        "Fortran": np.asfortranarray(base),
        "strided": np.repeat(base, 2, axis=0)[::-2],
        "list": base.tolist(),
    }
    found["read-only"].flags.writeable = False
    for name, number in ("NaN", np.nan), ("1e308", 1e308), ("5e-324", 5e-324):
        found[f"all {name}"] = np.full(real.shape, number)
    for name, number in ("NaN", np.nan), ("inf", np.inf), ("-inf", -np.inf), ("1e200", 1e200):
        if real.size:
            found[name] = real.copy()
            found[name].flat[real.size // 2] = number
    if base.dtype.kind in "iu":
        found |= {"beyond": base + 10**6, "below": base - 10**6, "halves": base + 0.5}
    return found


def numbers(valid):
    """Return numbers and what is none."""
    base = float(valid) if isinstance(valid, int | float | np.number) else 1.0
    found = [None, "x", "", -1, -0.5, 0, 10**400, 2**62, 1e300, 5e-324, True, 1j, {}, b"1"]
    found += [np.nan, np.inf, -np.inf, np.float32(base), np.int8(min(base, 100)), np.ma.masked]
    found += [np.array(base), np.array([base]), np.array([base, base]), [base]]
    return {f"{number!r:.20}": number for number in [*found, np.datetime64("2026-01-01")]}


def flags(valid):
    """Return what is and is not a truth value."""
    found = [None, "no", 2, np.nan, 0, 1, True, np.True_, np.array([True, False]), [], object()]
    return {f"{value!r:.20}": value for value in found}


def texts(valid):
    """Return unknown names and what is none."""
    found = [None, "no such name", "", b"phong", 3, 0.5, np.nan, ["x"], [], {}, {"x"}, Ellipsis]
    found += [np.array(["x", "y"]), np.str_("x"), "a\0b", "a\nb", "x" * 10_000, "\ud800"]
    return {f"{value!r:.20}": value for value in found}


def callables(valid):
    """Return functions that raise or return what they must not, and what is no function."""
    return {
        "3": 3,
        "string": "x",
        "returns None": lambda *a: None,
        "returns text": lambda *a: "x",
        "returns NaN": lambda *a: np.nan,
        "returns ragged": lambda *a: [[1.0], [1.0, 2.0]],
        "returns complex": lambda *a: a[0] * 1j,
        "returns inf": lambda *a: np.asarray(a[0]) * np.inf,
    }


def others(valid):
    """Return objects of the wrong class."""
    found = [None, "x", {}, {"lights": 3}, 3, [], (None,), np.ones(3), vizlight.Scene, object()]
    found += [vizlight.Light(direction=(0, 0, 1)), vizlight.View(direction=(0, 0, 1)), SCENE_4]
    found += [vizlight.Material(), vizlight.Sphere(), vizlight.Bundle()]
    made = {f"{value!r:.30}": value for value in found}
    return made | {"mesh": Maker(pv.Sphere), "camera": Maker(pv.Camera)}


def paths(valid):
    """Return paths that cannot be read or written."""
    suffix = getattr(valid, "suffix", "") or ".vtp"
    return {
        "None": None, "3": 3, "missing folder": f"no/such/folder/a{suffix}", "folder": ".",
        "empty": "", "NUL": f"a\0b{suffix}", "no suffix": "file", "unknown suffix": "a.unknown",
        "bytes": b"a.vtp", "long": "x" * 300 + suffix, "only suffix": suffix, "list": ["a"],
        "under a file": f"script.py/a{suffix}", "device": "/dev/full",
        "surrogate": f"\ud800{suffix}",
        "not there": f"missing{suffix}", "a script": "script.py",
    }  # fmt: skip


def meshes(valid):
    """Return meshes that lack something, and what is none."""
    found = {
        "None": None, "str": "mesh.vtp", "array": np.zeros((3, 3)), "list": [], "dict": {}, "3": 3,
        "class": pv.PolyData, "table": Maker(lambda: pv.Table({"x": np.arange(3.0)})),
        "empty": Maker(pv.PolyData), "empty grid": Maker(pv.UnstructuredGrid),
        "empty image": Maker(pv.ImageData), "empty structured": Maker(pv.StructuredGrid),
        "empty rectilinear": Maker(pv.RectilinearGrid), "empty blocks": Maker(pv.MultiBlock),
        "image": Maker(lambda: pv.ImageData(dimensions=(3, 3, 3))),
        "flat image": Maker(lambda: pv.ImageData(dimensions=(3, 3, 1))),
        "None blocks": Maker(lambda: pv.MultiBlock([None, None])),
        "nested blocks": Maker(lambda: pv.MultiBlock([pv.MultiBlock([None, pv.PolyData()]), None])),
        "block and None": Maker(lambda: pv.MultiBlock([pv.Sphere(), None])),
        "points only": Maker(lambda: pv.PolyData(np.random.default_rng(0).random((5, 3)))),
        "one point": Maker(lambda: pv.PolyData(np.zeros((1, 3)))),
        "line": Maker(pv.Line),
        "one triangle": Maker(pv.Triangle),
        "loose points": Maker(lambda: pv.PolyData(np.zeros((4, 3)), faces=[3, 0, 1, 2])),
        "strips": Maker(lambda: pv.Sphere(theta_resolution=6, phi_resolution=6).strip()),
        "quadratic": Maker(pv.examples.cells.QuadraticTriangle),
        "bad ids": Maker(lambda: _raw_faces([3, 0, 1, 99])),
        "negative ids": Maker(lambda: _raw_faces([3, 0, 1, -5])),
        "explicit": Maker(lambda: pv.examples.load_explicit_structured((2, 2, 2))),
    }  # fmt: skip
    if isinstance(valid, pv.DataSet) and valid.n_points:
        for label, number in ("NaN", np.nan), ("inf", np.inf), ("huge", 1e300), ("one place", 0.0):
            found[f"{label} points"] = Maker(lambda number=number: _with_points(valid, number))
        found["no arrays"] = Maker(lambda: _without_arrays(valid))
        for name in valid.point_data:
            for label, change in CHANGES.items():
                key = f"{name} {label}"
                found[key] = Maker(lambda name=name, change=change: _changed(valid, name, change))
        found["array of no tuples"] = Maker(lambda: _with_short_array(valid))
        found["as a block"] = Maker(lambda: pv.MultiBlock([valid.copy(), None]))
    return found


CHANGES = {
    "NaN": lambda a: np.full(a.shape, np.nan),
    "one inf": lambda a: np.where(np.arange(a.size).reshape(a.shape) == 1, np.inf, a),
    "zero": np.zeros_like,
    "1e300": lambda a: np.full(a.shape, 1e300),
    "string": lambda a: np.array(["x"] * len(a)),
    "of 2": lambda a: np.ones((len(a), 2)),
    "of 7": lambda a: np.ones((len(a), 7)),
    "uint8": lambda a: np.ones(a.shape, np.uint8),
    "bool": lambda a: np.ones(len(a), bool),
}


def _raw_faces(cells):
    mesh = pv.PolyData()
    mesh.points = np.random.default_rng(0).random((4, 3)).astype(np.float32)
    mesh.faces = np.array([3, 0, 1, 2])
    mesh.GetPolys().GetConnectivityArray().SetValue(2, cells[3])
    return mesh


def _with_points(valid, number):
    mesh = valid.copy()
    if not isinstance(mesh, pv.PolyData | pv.UnstructuredGrid | pv.StructuredGrid):
        mesh = mesh.cast_to_unstructured_grid()
    points = np.array(mesh.points, dtype=np.float64)
    points[: len(points) if number == 0 else 2] = number
    mesh.points = points
    return mesh


def _without_arrays(valid):
    mesh = valid.copy()
    mesh.clear_data()
    return mesh


def _changed(valid, name, change):
    mesh = valid.copy()
    mesh.point_data[name] = change(np.asarray(valid.point_data[name]))
    return mesh


def _with_short_array(valid):
    mesh = valid.copy()
    for name in valid.point_data:
        short = vtkFloatArray()
        short.SetName(name)
        short.SetNumberOfComponents(3)
        mesh.GetPointData().AddArray(short)
    return mesh


SCENE_4 = vizlight.Scene(
    lights=vizlight.Light(direction=(0, 0, 0, 1)), view=vizlight.View(direction=(0, 0, 0, 1))
)
MAKERS = {
    "array": arrays, "number": numbers, "flag": flags, "text": texts, "mesh": meshes,
    "path": paths, "callable": callables, "other": others,
}  # fmt: skip
