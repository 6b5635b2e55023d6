"""State of the page as one frozen value, what a file offers for it, and the history for undo."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from vizlight import _check
from vizlight.cli.scenes import FILL, MATERIAL
from vizlight.scene import Material
from vizlight.shading.options import Model

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pyvista as pv

__all__ = ["COLOR_MAPS", "Facts", "History", "Show", "State", "facts_of", "first", "fitted"]

Show = Literal["surface", "isosurface", "streamlines"]
#: Colour maps that the page offers.
COLOR_MAPS = ("viridis", "cividis", "plasma", "coolwarm", "twilight", "gray")
#: Longest sensible range of heights beside the extent of a flat field, and what it is reduced to.
STEEP, GENTLE = 0.25, 0.05
#: Entries that undo keeps.
MOST_UNDONE = 200
#: Fields on which the mesh that is lit depends, for each kind of picture.
BUILT: Mapping[str, tuple[str, ...]] = {
    "surface": ("heights", "factor", "tangents", "conditioned", "model"),
    "isosurface": ("array", "level", "tangents", "conditioned", "model"),
    "streamlines": ("vectors", "lines", "model"),
}
#: Smallest and largest value of each number.
RANGES: Mapping[str, tuple[float, float]] = {
    "azimuth": (0, 360),
    "altitude": (-90, 90),
    "fill": (0, 1),
    "ambient": (0, 1),
    "diffuse": (0, 2),
    "specular": (0, 2),
    "shininess": (1, 200),
    "cue": (0, 1),
    "line_width": (0.5, 10),
    "level": (-math.inf, math.inf),
    "factor": (0, math.inf),
}


@dataclass(frozen=True)
class Facts:
    """What a file offers.

    Parameters
    ----------
    dimension : int
        Largest dimension of a cell: 1 for lines, 3 for a volume.
    flat : bool
        Whether a surface lies in a plane across an axis.
    size : float
        Diagonal of the bounding box.
    scalars : dict of str to (float, float)
        Point arrays of one component and the ends of their ranges, the active one first.
    vectors : tuple of str
        Point arrays of three components, the active one first.
    averaged : bool
        Whether the arrays are those of the cells, averaged at the points.
    """

    dimension: int
    flat: bool
    size: float
    scalars: Mapping[str, tuple[float, float]]
    vectors: tuple[str, ...]
    averaged: bool = False

    @property
    def shows(self) -> tuple[Show, ...]:
        """Kinds of pictures that can be made."""
        known: list[Show] = ["surface"]
        if self.dimension == 3 and self.scalars:
            known.append("isosurface")
        if self.dimension > 1 and self.vectors:
            known.append("streamlines")
        return tuple(known)


@dataclass(frozen=True)
class State:
    """What the page shows, without the camera.

    Parameters
    ----------
    show : {"surface", "isosurface", "streamlines"}
        What of the file is drawn; lines are drawn as they are by "surface".
    array, level : str, float
        Array of the isosurface and its value.
    heights, factor : str, float
        Array that raises a flat field, or an empty string, and its factor.
    tangents : str
        Array of vectors by which a surface is lit, or an empty string.
    conditioned : bool
        Whether such light is conditioned by the surface.
    vectors, lines : str, int
        Array of vectors and number of streamlines.
    model : {"phong", "blinn", "cylinder"}
        Reflection model.
    color, cmap : str
        Array that colours the picture, or an empty string, and its colour map.
    shoulder : bool
        Whether the light follows the eye, above and to the left of it.
    azimuth, altitude : float
        Direction toward the light otherwise, in degrees clockwise from y and above the horizon.
    fill : float
        Intensity of the light from the eye.
    ambient, diffuse, specular, shininess : float
        Material.
    cue : float
        Share of the light that is taken away at the far end.
    line_width : float
        Width of lines in pixels.
    """

    show: Show = "surface"
    array: str = ""
    level: float = 0.0
    heights: str = ""
    factor: float = 1.0
    tangents: str = ""
    conditioned: bool = True
    vectors: str = ""
    lines: int = 200
    model: Model = "phong"
    color: str = ""
    cmap: str = "viridis"
    shoulder: bool = True
    azimuth: float = 315.0
    altitude: float = 45.0
    fill: float = FILL
    ambient: float = MATERIAL["ambient"]
    diffuse: float = MATERIAL["diffuse"]
    specular: float = MATERIAL["specular"]
    shininess: float = Material().shininess
    cue: float = 0.0
    line_width: float = 1.0

    def __post_init__(self) -> None:
        _check.choice("show", self.show, get_args(Show))
        _check.choice("model", self.model, get_args(Model))
        _check.choice("cmap", self.cmap, COLOR_MAPS)
        for name in ("array", "heights", "tangents", "vectors", "color"):
            if not isinstance(getattr(self, name), str):
                got = _check.describe(getattr(self, name))
                raise TypeError(_check.message(name, "the name of an array", got))
        flags = {
            name: _check.boolean(name, getattr(self, name)) for name in ("conditioned", "shoulder")
        }
        numbers = {
            name: _check.number(name, getattr(self, name), low=low, high=high)
            for name, (low, high) in RANGES.items()
        }
        lines = _check.number("lines", self.lines, low=1, high=100_000)
        _check.set_fields(self, **flags, **numbers, lines=round(lines))

    @property
    def built(self) -> tuple[object, ...]:
        """What the mesh that is lit depends on."""
        return (self.show, *(getattr(self, name) for name in BUILT[self.show]))

    @property
    def drawn(self) -> tuple[object, ...]:
        """What the actor depends on beside the mesh; all else is light."""
        return self.color, self.cmap, self.line_width

    def changed(self, **values: Any) -> State:
        """Return the state with other values; a light that is moved no longer follows the eye."""
        if {"azimuth", "altitude"} & set(values):
            values = {"shoulder": False} | values
        return dataclasses.replace(self, **values)


def facts_of(mesh: pv.DataSet) -> Facts:
    """Return what a mesh offers; its cells' arrays where its points have none.

    Parameters
    ----------
    mesh : pyvista.DataSet
        Mesh of the file.
    """
    averaged = bool(len(mesh.cell_data)) and not len(mesh.point_data)
    data = mesh.cell_data_to_point_data().point_data if averaged else mesh.point_data
    scalars = {}
    for name in _active_first(data.active_scalars_name, list(data)):
        values = np.asarray(data[name])
        if values.ndim == 1 and values.dtype.kind in "iubf":
            finite = values[np.isfinite(values)]
            if finite.size:
                scalars[name] = float(finite.min()), float(finite.max())
    vectors = [
        name
        for name in _active_first(data.active_vectors_name, list(data))
        if np.shape(data[name])[1:] == (3,) and name != "Normals" and data[name].dtype.kind == "f"
    ]
    dimension = mesh.GetMaxSpatialDimension() if mesh.n_cells else 0
    flat = dimension == 2 and not min(mesh.bounds_size)
    return Facts(dimension, flat, float(mesh.length), scalars, tuple(vectors), averaged)


def _active_first(active: str | None, names: list[str]) -> list[str]:
    return sorted(names, key=lambda name: name != active)


def first(facts: Facts) -> State:
    """Return the state in which a file is opened.

    It is that of ``vizlight light``, but of a volume an isosurface or streamlines, and a flat field
    raised by its heights.

    Parameters
    ----------
    facts : Facts
        What the file offers.
    """
    array = next(iter(facts.scalars), "")
    low, high = facts.scalars.get(array, (0.0, 0.0))
    vectors = next(iter(facts.vectors), "")
    show: Show = "surface"
    if facts.dimension == 3:
        show = "isosurface" if array else "streamlines" if vectors else "surface"
    state = State(show=show, array=array, level=middle(low, high), vectors=vectors)
    if facts.flat and array:
        steep = high - low > STEEP * facts.size
        factor = GENTLE * facts.size / (high - low) if steep else 1.0
        state = dataclasses.replace(state, heights=array, factor=float(f"{factor:.2g}"))
    return state


def middle(low: float, high: float) -> float:
    """Return the middle of a range, in no more digits than are read."""
    level = (low + high) / 2
    short = float(f"{level:.6g}")
    return short if low <= short <= high else level


def fitted(state: State, before: State, facts: Facts) -> State:
    """Return a state with what depends on its other values put right.

    Another array has another level, only lines are lit as cylinders, and an isosurface is not
    coloured by its own constant.

    Parameters
    ----------
    state, before : State
        State that is asked for, and the one before it.
    facts : Facts
        What the file offers.

    Raises
    ------
    ValueError
        If the file has no such array, or no such picture can be made of it.
    """
    _check.choice("show", state.show, facts.shows)
    for name in ("array", "heights", "tangents", "vectors", "color"):
        value = getattr(state, name)
        known: tuple[str, ...] = facts.vectors
        if name in ("array", "heights"):
            known = tuple(facts.scalars)
        elif name == "color":
            known = (*facts.scalars, *facts.vectors)
        if value and value not in known:
            raise ValueError(_check.message(name, f"an array, {_check.one_of(known)}", repr(value)))
    if state.show == "isosurface":
        low, high = facts.scalars[state.array]
        if state.array != before.array:
            state = dataclasses.replace(state, level=middle(low, high))
        if not low <= state.level <= high:
            expected = f"a value between {low:g} and {high:g}"
            raise ValueError(_check.message("level", expected, f"{state.level:g}"))
        if state.color == state.array:
            state = dataclasses.replace(state, color="")
    if state.model == "cylinder" and not has_lines(state, facts):
        state = dataclasses.replace(state, model="phong")
    return state


def has_lines(state: State, facts: Facts) -> bool:
    """Return whether lines are drawn."""
    return state.show == "streamlines" or facts.dimension == 1


@dataclass(frozen=True)
class History:
    """States of the page: the present one, those before it, and those that were undone."""

    present: State
    past: tuple[State, ...] = ()
    future: tuple[State, ...] = ()

    def with_state(self, state: State, *, merged: bool = False) -> History:
        """Return the history with another present; ``merged`` makes it part of the last step."""
        if state == self.present:
            return self
        if merged and self.past:
            return History(state, self.past)
        return History(state, (*self.past, self.present)[-MOST_UNDONE:])

    def undone(self) -> History:
        """Return the history one step back."""
        if not self.past:
            return self
        return History(self.past[-1], self.past[:-1], (self.present, *self.future))

    def redone(self) -> History:
        """Return the history one step forward again."""
        if not self.future:
            return self
        return History(self.future[0], (*self.past, self.present), self.future[1:])
