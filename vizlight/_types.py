"""Type aliases that the annotations of the package share."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkCommonDataModel import vtkDataSet

    #: A dataset of VTK, which one of PyVista is too; what reads it needs VTK alone.
    Dataset: TypeAlias = vtkDataSet | pv.DataSet

# What a type checker cannot know has one of these names; no other module says Any.
#: What a library without types returns: objects of VTK and PyVista, readers of files.
Foreign: TypeAlias = Any
#: Value of an option on its way to the function that checks it.
Given: TypeAlias = Any
#: Options on their way, by name.
Keywords: TypeAlias = dict[str, Any]
#: Values of any type.
AnyArray: TypeAlias = NDArray[Any]

#: Real numbers, float32 or float64.
Array: TypeAlias = NDArray[np.floating]
Bools: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.intp]
#: Real or complex numbers; complex ones appear in derivatives by the complex step.
Numbers: TypeAlias = NDArray[np.number]

Vector: TypeAlias = tuple[float, ...]
VectorLike: TypeAlias = Sequence[float] | Array
Color: TypeAlias = tuple[float, float, float]
ColorLike: TypeAlias = "str | VectorLike | pv.Color"
