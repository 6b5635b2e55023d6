"""Type aliases that the annotations of the package share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import pyvista as pv
    from vtkmodules.vtkCommonDataModel import vtkDataSet

# What a type checker cannot know has one of these names; no other module says Any.
#: A dataset of VTK, which one of PyVista is too; what reads it needs VTK alone.
Dataset: TypeAlias = "vtkDataSet | pv.DataSet"
#: What a library without types returns: objects of VTK and PyVista, readers of files.
Foreign: TypeAlias = Any
#: Sparse matrix of SciPy: shares of points in other points.
Sparse: TypeAlias = Any
#: A number or a vector of an algebra: whatever NumPy's functions and operators accept.
Value: TypeAlias = Any
#: Value of an option on its way to the function that checks it.
Given: TypeAlias = Any
#: Options on their way, by name.
Keywords: TypeAlias = dict[str, Any]
#: Values of any type.
AnyArray: TypeAlias = NDArray[Any]
#: Numbers as they are stored, before they are checked, and their type.
Raw: TypeAlias = NDArray[np.generic]
RawType: TypeAlias = np.dtype[np.generic]
#: Rows that follow each other, and whatever picks rows of an array.
Slice: TypeAlias = "slice[int, int, int | None]"
Rows: TypeAlias = Any
#: A function that takes what it is given.
Function: TypeAlias = Callable[..., object]

#: Real numbers, float32 or float64, and their type.
Array: TypeAlias = NDArray[np.floating]
FloatType: TypeAlias = np.dtype[np.floating]
Bools: TypeAlias = NDArray[np.bool_]
Indices: TypeAlias = NDArray[np.intp]
#: Real or complex numbers; complex ones appear in derivatives by the complex step.
Numbers: TypeAlias = NDArray[np.number]

Vector: TypeAlias = tuple[float, ...]
VectorLike: TypeAlias = Sequence[float] | Array
Color: TypeAlias = tuple[float, float, float]
ColorLike: TypeAlias = "str | VectorLike | pv.Color"

# Options of light.
Model = Literal["phong", "blinn", "cylinder"]
Precision = Literal["float32", "float64"]
Exponent: TypeAlias = float | Literal["compensated"]
FeatureAngle: TypeAlias = float | Literal["auto"] | None
Facing = Literal["auto", "eye", "outward", "as given"]
