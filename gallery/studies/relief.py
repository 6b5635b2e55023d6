"""Cos-theta shadows on height fields: compiled code beside NumPy, and a closed form.

The fields are random hills with a power spectrum like that of terrain, and a hemisphere on a plane.
The shadow of the hemisphere is known in closed form; the error is there the discretisation error of
the field, which falls with its spacing. Hills are timed by NumPy alone and, where the extra
``fast`` is installed, as compiled code.
Beside them stand the hard shadows of RVT's ``shadow_horizon`` where that is installed: the share of
nodes that are on the wrong side, as of vizlight with a depth of nearly 0, from rays in small steps.
"""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from scipy import ndimage

from studies import Row, Study, foreign, peak_memory, take_turns
from vizlight import _compiled
from vizlight.geometry.relief import shadowing

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from vizlight._types import Array, Bools, Indices

    Errors = tuple[float, float, float]

#: Exponent by which the amplitude of the hills falls with the frequency, and their height. Both
#: are those of rough mountains 15 km wide.
FALL, HIGH = 1.8, 0.15
DEPTH = 0.005
#: Elevation of the sun in degrees, and others for fields of at most so many points per side.
HEIGHT, HEIGHTS, SMALL = 20.0, (5.0, 40.0), 1024
#: Distance from the edges at which the hemisphere is smooth.
MARGIN = 0.2


def hills(side: int, seed: int = 0) -> Array:
    """Return heights over a unit square on side x side points; more points add finer hills."""
    random = np.random.default_rng(seed)
    k = np.fft.fftfreq(side)
    frequency = np.hypot(*np.meshgrid(k, k))
    frequency[0, 0] = 1
    phase = 2j * np.pi * random.random((side, side))
    z = np.fft.ifft2(frequency**-FALL * np.exp(phase)).real
    return np.asarray((z - z.min()) * (HIGH / np.ptp(z)))


def sun(height: float, azimuth: float = 40.0) -> Array:
    """Return the direction toward the sun from its elevation and azimuth in degrees."""
    e, a = np.radians([height, azimuth])
    toward: Array = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    return toward


def measure(side: int, height: float = HEIGHT, repeats: int = 3) -> list[Row]:
    """Return the rows of one field of hills, with NumPy's light as the reference.

    A sun at another height than HEIGHT degrees is named in the rows.
    """
    at = "" if height == HEIGHT else f", sun at {height:g}"
    x, z = np.linspace(0, 1, side), hills(side)

    def light(setting: str) -> Array:
        with _compiled.setting(setting):
            t: Array = shadowing.shadow(x, x, z, depth=DEPTH, direction=sun(height))
        return t

    ways: dict[str, Callable[[], Array]] = {"NumPy": lambda: light("0")}
    if _compiled.active():
        light("1")
        ways["compiled"] = lambda: light("1")
    seconds = take_turns(ways, repeats)
    right, rows = light("0"), []
    for way, work in ways.items():
        error = np.abs(work() - right)
        more = {
            "largest error": float(error.max()),
            "bytes per point": peak_memory(work) / side**2,
        }
        cost = 1e9 * seconds[way] / side**2
        rows.append(Row(f"hills, {way}{at}", side, float(error.mean()), cost, more))
    return rows


def lit_places(z: Array, at: Indices, toward: Array, step: float = 0.05) -> Bools:
    """Return whether nodes of a field of spacing 1 see a light: rays in steps of a share of a cell.

    Heights between the nodes are bilinear; beyond the border there is nothing.
    """
    (flat,) = np.hypot(toward[:1], toward[1:2])
    way, rise = toward[:2] / flat, toward[2] / flat
    seen = np.ones(len(at), dtype=bool)
    for s in np.arange(step, (z.max() - z.min()) / rise, step):
        y, x = (at + s * way[::-1]).T
        inside = (x >= 0) & (y >= 0) & (x <= z.shape[1] - 1) & (y <= len(z) - 1)
        if not inside.any():
            break
        above = z[tuple(at[inside].T)] + s * rise
        heights = ndimage.map_coordinates(z, [y[inside], x[inside]], order=1)
        seen[inside] &= heights <= above
    return seen


def hard(side: int, repeats: int = 3, places: int = 2000) -> list[Row]:
    """Return the rows of hard shadows on hills, with rays in small steps as the reference."""
    x, z = np.arange(float(side)), hills(side) * (side - 1)
    at = np.random.default_rng(3).integers(0, side, (places, 2))
    toward = sun(HEIGHT)
    true = lit_places(z, at, toward)

    def ours() -> Bools:
        # In the shadow t is the depth over a length of the order of a cell.
        t: Array = shadowing.shadow(x, x, z, depth=1e-6, direction=toward)
        return np.asarray(t > 1e-3)

    found: dict[str, Callable[[], Bools]] = {"hard shadow, depth 1e-6": ours}
    vis = foreign("rvt.vis")
    if vis is not None:
        # Rows run southward there, and azimuths clockwise from north.
        def theirs() -> Bools:
            made = vis.shadow_horizon(z[::-1], 1, shadow_az=50, shadow_el=HEIGHT)
            return np.asarray(np.asarray(made["shadow"])[::-1] > 0.5)

        found["hard shadow, RVT"] = theirs
    ours()
    seconds = take_turns(found, repeats)
    return [
        Row(
            way, side, float(np.mean(work()[tuple(at.T)] != true)),
            1e9 * seconds[way] / side**2,
        )
        for way, work in found.items()
    ]  # fmt: skip


def hemisphere(side: int, depth: float = 0.1) -> Errors:
    """Return errors of t for a unit hemisphere on a plane of 6 x 6.

    The errors are the mean error, the largest error, and the mean error at distances greater than
    MARGIN from the edges of the hemisphere and of its shadow.
    """
    x = np.linspace(-3, 3, side)
    z = np.sqrt(np.maximum(1 - x**2 - x[:, None] ** 2, 0))
    places = np.stack([*np.meshgrid(x, x), z], axis=-1)
    normal = np.where(z[..., None] > 0, places, [0, 0, 1.0])
    start, way = places - depth * normal, sun(35, 20)
    middle = -(start @ way)
    half = np.sqrt(np.maximum(1 - np.einsum("ijk,ijk->ij", start, start) + middle**2, 0))
    ground = np.maximum(-start[..., 2] / way[2], 0)
    low = np.maximum(middle - half, ground)
    length = ground + np.maximum(middle + half - low, 0) * (half > 0)
    expected = depth / np.maximum(length, depth)
    with _compiled.setting("0"):
        t = shadowing.shadow(x, x, z, depth=depth, direction=way, normals=normal)
    error = np.abs(t - expected)
    kind = 2 * (z > 0) + (np.maximum(middle + half - low, 0) * (half > 0) > 0)
    near = 2 * math.ceil(MARGIN / (x[1] - x[0])) + 1
    smooth = ndimage.maximum_filter(kind, near) == ndimage.minimum_filter(kind, near)
    return float(error.mean()), float(error.max()), float(error[smooth].mean())


def of_hemisphere(side: int, repeats: int = 1) -> list[Row]:
    """Return the rows of one hemisphere, with the closed form as the reference."""
    found: list[Errors] = []
    taken = take_turns({"": lambda: found.append(hemisphere(side))}, repeats)[""]
    mean, worst, smooth = found[-1]
    more = {"largest error": worst, "mean off the edges": smooth}
    return [Row("hemisphere", side, mean, 1e9 * taken / side**2, more)]


def steps(quick: bool) -> list[Callable[[], Iterable[Row]]]:
    """Return the steps: hills, hills under other suns, then hemispheres."""
    hilly = (128, 256) if quick else (256, 512, 1024, 2048)
    round_ones = (76, 151, 301) if quick else (76, 151, 301, 601)
    repeats = 1 if quick else 3
    return [
        *(partial(measure, side, repeats=repeats) for side in hilly),
        *(
            partial(measure, side, height, repeats=1)
            for height in HEIGHTS
            for side in hilly
            if side <= SMALL
        ),
        *(partial(of_hemisphere, side) for side in round_ones),
        *(partial(hard, side) for side in hilly if side <= SMALL),
    ]


STUDY = Study(
    approximates="t of the cos-theta shadow of height fields, sun at 20 degrees unless stated",
    reference="for hills, the light by NumPy; for a hemisphere on a plane, the closed form",
    parameter="points per side",
    error="mean error of t",
    cost="ns per point",
    steps=steps,
    axes=("cost", "error"),
)
