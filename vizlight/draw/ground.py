"""The cos-theta shadow of a height field in each fragment: a walk over the cells of its texture."""

from __future__ import annotations

import numpy as np
import pyvista as pv
from vtkmodules.vtkRenderingCore import vtkActor, vtkTexture

from vizlight._types import Array
from vizlight.draw.glsl import HEIGHTS, Uniform
from vizlight.mesh.casters import EvenField


def attach(actor: vtkActor, field: EvenField) -> None:
    """Give an actor the heights of a field as a texture."""
    rows, columns = field.heights.shape
    image = pv.ImageData(dimensions=(columns, rows, 1))
    # VTK keeps the numbers of textures of three channels as they are, but not those of one.
    image.point_data["heights"] = np.repeat(field.heights.astype(np.float32).reshape(-1, 1), 3, 1)
    texture = vtkTexture()
    texture.SetInputData(image)
    texture.SetColorModeToDirectScalars()
    texture.InterpolateOff()
    texture.MipmapOff()
    actor.GetProperty().SetTexture(HEIGHTS, texture)


def numbers(field: EvenField, matrix: Array) -> list[Uniform]:
    """Return the numbers of the walk for a field that is moved by a matrix."""
    # A place less the origin times a row is a number of cells, or a height.
    across = field.axes @ np.linalg.inv(matrix[:3, :3])
    origin = matrix[:3, :3] @ field.origin + matrix[:3, 3]
    sizes = np.linalg.norm(across, axis=1)
    rows, columns = field.heights.shape
    return [
        Uniform("vizFieldFrom", "vec3", tuple(origin.tolist()), "position"),
        *(
            Uniform(f"vizField{axis}", "vec4", (*(row / size).tolist(), float(size)), "direction")
            for axis, row, size in zip("XYZ", across, sizes, strict=True)
        ),
        Uniform("vizFieldSize", "vec3", (columns, rows, float(field.heights.max()))),
        Uniform("vizDepth", "float", (field.depth,)),
    ]
