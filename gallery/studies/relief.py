"""Cos-theta shadows on height fields: compiled code beside NumPy, and a closed form.

Hills have a power spectrum like that of terrain; NumPy and, where the extra ``fast`` is installed,
compiled code are timed in turn; in fragments the picture has a pixel for each node. The shadow of a
hemisphere on a plane has a closed form; the error is there that of the nodes, which falls with
their spacing. Of hard shadows, with a depth of nearly 0, the error is the share of nodes that are
on the wrong side, from rays in small steps.
"""

from __future__ import annotations

import os
from functools import partial
from unittest import mock

import numpy as np
import pyvista as pv
from scipy import ndimage

import vizlight
from studies import Row, Study, peak_memory, take_turns
from vizlight import Light, Material, Scene, _compiled
from vizlight.geometry.relief import shadowing

#: Exponent by which the amplitude of the hills falls with the frequency, and their height. Both
#: are those of rough mountains 15 km wide.
FALL, HIGH = 1.8, 0.15
DEPTH = 0.005
#: Elevation of the sun in degrees, and others for fields of at most so many points per side.
HEIGHT, HEIGHTS, SMALL = 20.0, (5.0, 40.0), 1024


def hills(side, seed=0):
    """Return heights over a unit square on side x side points; more points add finer hills."""
    random = np.random.default_rng(seed)
    k = np.fft.fftfreq(side)
    frequency = np.hypot(*np.meshgrid(k, k))
    frequency[0, 0] = 1
    phase = 2j * np.pi * random.random((side, side))
    z = np.fft.ifft2(frequency**-FALL * np.exp(phase)).real
    return np.asarray((z - z.min()) * (HIGH / np.ptp(z)))


def sun(height, azimuth=40.0):
    """Return the direction toward the sun from its elevation and azimuth in degrees."""
    e, a = np.radians([height, azimuth])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def measure(side, height=HEIGHT, repeats=3):
    """Return the rows of one field of hills, with NumPy's light as the reference.

    A sun at another height than HEIGHT degrees is named in the rows.
    """
    at = "" if height == HEIGHT else f", sun at {height:g}"
    x, z = np.linspace(0, 1, side), hills(side)

    def light(setting):
        with mock.patch.dict(os.environ, VIZLIGHT_FAST=setting):
            return shadowing.shadow(x, x, z, depth=DEPTH, direction=sun(height))

    ways = {"NumPy": partial(light, "0")}
    if _compiled.active():
        ways["compiled"] = partial(light, "1")
        ways["compiled"]()
    seconds, exact, rows = take_turns(ways, repeats), light("0"), []
    for way, work in ways.items():
        error = np.abs(work() - exact)
        more = {"largest error": float(error.max())}
        more["bytes per point"] = peak_memory(work) / side**2
        cost = 1e9 * seconds[way] / side**2
        rows.append(Row(f"hills, {way}{at}", side, float(error.mean()), cost, more))
    return rows


def lit_places(z, at, toward, step=0.05):
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


def hard(side, repeats=3, places=2000):
    """Return the rows of hard shadows on hills, with rays in small steps as the reference."""
    x, z = np.arange(float(side)), hills(side) * (side - 1)
    at = np.random.default_rng(3).integers(0, side, (places, 2))
    toward = sun(HEIGHT)
    true = lit_places(z, at, toward)

    def ours():
        # In the shadow t is the depth over a length of the order of a cell.
        return shadowing.shadow(x, x, z, depth=1e-6, direction=toward) > 1e-3

    error = float(np.mean(ours()[tuple(at.T)] != true))
    cost = 1e9 * take_turns({"": ours}, repeats)[""] / side**2
    return [Row("hard shadow, depth 1e-6", side, error, cost)]


def hemisphere(side, depth=0.1):
    """Return the row of t for a unit hemisphere on a plane of 6 x 6."""
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
    light = partial(shadowing.shadow, x, x, z, depth=depth, direction=way, normals=normal)
    cost = 1e9 * take_turns({"": light}, 1)[""] / side**2
    error = np.abs(light() - depth / np.maximum(length, depth))
    return [Row("hemisphere", side, float(error.mean()), cost, {"largest error": error.max()})]


def fragments(side, repeats=3):
    """Return the row of hills whose shadow each fragment casts, one pixel for each node."""
    grid = pv.ImageData(dimensions=(side, side, 1), spacing=(1 / (side - 1),) * 3)
    grid["height"] = hills(side).ravel()
    # Of diffuse light alone the grey level is t.
    plain = Material(ambient=0.0, diffuse=1.0, specular=0.0)
    scene = Scene(lights=Light(direction=sun(HEIGHT)), material=plain)
    lit = vizlight.relief_shadow(grid, scene, lit=True, depth=DEPTH)
    plotter = pv.Plotter(off_screen=True, window_size=(side, side))
    plotter.disable_anti_aliasing()
    plotter.vizlight.add_mesh(lit, light="fragments")
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.parallel_scale = 0.5 * side / (side - 1)
    shown = plotter.screenshot(return_img=True)[::-1, :, 0] / 255
    cost = 1e9 * take_turns({"": plotter.render}, repeats)[""] / side**2
    plotter.close()
    # The outermost nodes are on the border of the mesh, which may show the ground behind it.
    error = np.abs(shown - np.reshape(lit["t"], (side, side)))[1:-1, 1:-1]
    return [
        Row("hills, in fragments", side, float(error.mean()), cost, {"largest error": error.max()})
    ]


def steps(quick):
    """Return the steps: hills in two ways, under other suns, hemispheres, hard shadows."""
    sides = (128, 256) if quick else (256, 512, 1024, 2048)
    small = [side for side in sides if side <= SMALL]
    made = [partial(measure, side, repeats=1 if quick else 3) for side in sides]
    made += [partial(measure, side, height, repeats=1) for height in HEIGHTS for side in small]
    made += [partial(hemisphere, side) for side in (76, 151, 301)]
    made += [partial(fragments, side, repeats=1 if quick else 3) for side in small]
    return made + [partial(hard, side) for side in small]


STUDY = Study(
    approximates="t of the cos-theta shadow of height fields, sun at 20 degrees unless stated",
    reference="for hills, the light by NumPy; for a hemisphere on a plane, the closed form",
    parameter="points per side",
    error="mean error of t",
    cost="ns per point",
    steps=steps,
)
