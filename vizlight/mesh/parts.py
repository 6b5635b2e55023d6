"""What a mesh of PyVista is lit by: its arrays, and what earlier results kept of it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

from vizlight.mesh import normals, splitting
from vizlight.reading import parts as reading

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Indices
    from vizlight.reading.normals import Sided, Told
    from vizlight.reading.parts import Part
    from vizlight.scene import Scene
    from vizlight.shading.inputs import ShadingInputs
    from vizlight.shading.options import LightOptions

_KEPT = reading.Kept(normals.kept, splitting.kept_tangents)


def inputs_of(mesh: pv.DataSet, path: str, scene: Scene, options: LightOptions) -> ShadingInputs:
    """Return the inputs of the engine from one mesh; see :func:`part_of`."""
    return part_of(mesh, path, scene, options).inputs


def part_of(
    mesh: pv.DataSet,
    path: str,
    scene: Scene,
    options: LightOptions,
    starts: Indices | None = None,
    known: Sided | None = None,
    told: Told | None = None,
) -> Part:
    """Return what one mesh is lit by; see :func:`vizlight.reading.parts.part_of`.

    ``known`` are normals of its surface that were computed already, and ``told`` is what a whole
    decides of its sides.
    """
    kept = _KEPT if known is None else _KEPT._replace(normals=lambda _: known)
    part = reading.part_of(mesh, path, scene, options, kept=kept, starts=starts, told=told)
    cells = lambda: splitting.simplices(mesh)  # noqa: E731
    return part._replace(inputs=dataclasses.replace(part.inputs, cells=cells))
