"""Results that are kept: the names of the arrays, and the record of how they were made."""

from __future__ import annotations

import dataclasses
import zlib
from collections.abc import Mapping
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from vizlight import _check
from vizlight._types import Array, Raw
from vizlight._version import __version__
from vizlight.scene import Scene
from vizlight.shading.engine import Shading
from vizlight.shading.options import Options

#: Contents of a record in JSON: the scene, the options and facts about the result.
Record: TypeAlias = dict[str, object]

#: Largest number of values of an array that is written out in full.
WRITTEN_OUT = 100


DEFAULT_NAME = "luminance"
VALID = "_valid"
PARTS = ("ambient", "diffuse", "specular", "rgb")


def part_name(name: str, part: str) -> str:
    """Return the name of an array that comes with the light."""
    return part if name == DEFAULT_NAME else f"{name}_{part}"


def arrays_of(
    shading: Shading, name: str, *, occlusion: Array | None = None, valid: bool = False
) -> dict[str, Raw]:
    """Return the arrays of a result by their names, the light itself last.

    ``occlusion`` is the share of the ambient light that reaches a point; with ``valid`` the mask of
    lit points is returned even if all points could be lit.
    """
    parts: dict[str, Raw] = {}
    if shading.diffuse is not None and shading.specular is not None:
        # One number for all, but an array of the mesh like the other terms.
        ambient = np.full_like(shading.luminance, shading.plan.ambient)
        if occlusion is not None:
            ambient *= occlusion
        parts = {"ambient": ambient, "diffuse": shading.diffuse, "specular": shading.specular}
    if shading.rgb is not None:
        parts["rgb"] = shading.rgb
    arrays = {part_name(name, part): array for part, array in parts.items()}
    if valid or shading.invalid:
        arrays[name + VALID] = shading.valid
    return arrays | {name: shading.luminance}


def unlit(invalid: int, total: int) -> str:
    """Return how many points could not be lit, and why, for a warning."""
    return (
        f"{invalid} of {total} points could not be lit (a zero, infinite or NaN vector, "
        "dependent tangents, no cell, or no surface normal there): they have the ambient light, "
        "and are grey in pictures"
    )


def record_key(name: str) -> str:
    """Return the name of the field array that holds the record of a point array."""
    return f"{name}_provenance"


def digest(array: Raw) -> str:
    """Return a digest of the shape and the bytes of an array."""
    # The shape is in it, since the same bytes of another shape are another array.
    rows = np.ascontiguousarray(array)
    return f"{'x'.join(map(str, rows.shape))}:{zlib.crc32(rows.view(np.uint8).data):08x}"


def of_light(shading: Shading, filter_name: str, scene: Scene, options: object) -> Record:
    """Return the record of light that the engine computed."""
    plan = shading.plan
    return of_filter(
        filter_name, scene, options,
        precision=plan.dtype.name,
        terms=list(plan.terms),
        exponent=plan.exponent,
        points=int(shading.luminance.size),
        invalid=shading.invalid,
    )  # fmt: skip


def of_filter(filter_name: str, scene: Scene, options: object, **facts: object) -> Record:
    """Return the record of an array that a filter computed."""
    return {
        "vizlight": __version__,
        "filter": filter_name,
        **facts,
        "options": plain(options),
        "scene": scene.to_dict(),
    }


def plain(options: object) -> Record:
    """Return options, a dataclass or a dict, as values that JSON can hold."""
    if not isinstance(options, Mapping):
        names = [field.name for field in dataclasses.fields(options)]  # type: ignore[arg-type]
        # Options that a filter decides by itself could not be passed to it again.
        decided = options.DECIDED if isinstance(options, Options) else ()
        options = {name: getattr(options, name) for name in names if name not in decided}
    return {str(name): _plain(value) for name, value in options.items()}


def _plain(value: object) -> object:
    """Return a value that JSON can hold, with a description of a mesh or a long array."""
    if value is None or isinstance(value, str | bool | int | float):
        return value
    # By VTK's methods: a mesh need not be PyVista's.
    if hasattr(value, "GetNumberOfPoints") or hasattr(value, "GetNumberOfBlocks"):  # a mesh
        return f"{type(value).__name__} of {getattr(value, 'n_points', 0)} points"
    if isinstance(value, Fraction):
        return float(value)
    if isinstance(value, list | tuple) and len(value) <= WRITTEN_OUT:
        return [_plain(part) for part in value]
    if dataclasses.is_dataclass(value):
        return plain(value)
    array: Raw = np.asarray(value)
    if array.size <= WRITTEN_OUT and array.dtype.kind in "biufU":
        # JSON holds at most the digits of float64.
        return (array.astype(np.float64) if array.dtype.kind == "f" else array).tolist()
    return _check.describe(array)
