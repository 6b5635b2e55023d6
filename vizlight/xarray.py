"""The accessor ``ds.vizlight`` of data of xarray, which ``import vizlight.xarray`` adds."""

from __future__ import annotations

import functools

import pyvista as pv
import xarray

import vizlight
from vizlight._types import Foreign


@xarray.register_dataset_accessor("vizlight")
@xarray.register_dataarray_accessor("vizlight")
class GridAccessor:
    """Methods of datasets and arrays of xarray: their data as a mesh, and its picture.

    Parameters
    ----------
    data : xarray.Dataset or xarray.DataArray
    """

    def __init__(self, data: Foreign) -> None:
        self._data = data

    @functools.wraps(vizlight.look)
    def look(self, *args: Foreign, **options: Foreign) -> vizlight.Look:  # noqa: D102
        return vizlight.look(self._data, *args, **options)

    @functools.wraps(vizlight.read)
    def read(self, **options: Foreign) -> pv.DataSet:  # noqa: D102
        return vizlight.read(self._data, **options)
