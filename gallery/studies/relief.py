"""Cos-theta shadows on height fields: compiled code beside NumPy, and a closed form.

Hills have a power spectrum like that of terrain; NumPy and, where the extra ``fast`` is installed,
compiled code are timed in turn; in fragments the picture has a pixel for each node. The shadow of a
hemisphere on a plane has a closed form; the error is there that of the nodes, which falls with
their spacing. Of hard shadows, with a depth of nearly 0, the error is the share of nodes that are
on the wrong side, from rays in small steps.

Real ground is shaded by the usual formulas and by this package. It is smoothed by a Gaussian, so
that its slopes have a closed form and its heights are no whole metres; then these are rounded to
metres, and tiles of the ground are shaded each by itself.
"""

from __future__ import annotations

import os
from functools import partial
from unittest import mock

import numpy as np
import pyvista as pv
from matplotlib.colors import LightSource
from scipy import ndimage

import vizlight
from studies import Row, Study, peak_memory, take_turns
from vizlight import Light, Material, Scene, View, _compiled
from vizlight.geometry.relief import shadowing

#: Exponent by which the amplitude of the hills falls with the frequency, and their height. Both
#: are those of rough mountains 15 km wide.
FALL, HIGH = 1.8, 0.15
DEPTH = 0.005
#: Elevation of the sun in degrees, and others for fields of at most so many points per side.
HEIGHT, HEIGHTS, SMALL = 20.0, (5.0, 40.0), 1024
#: Material whose luminance is t, the cosine where nothing casts a shadow.
PLAIN = Material(ambient=0.0, diffuse=1.0, specular=0.0)
#: Width of the Gaussian in nodes of the real ground; nodes along a side of a tile; the usual sun.
WIDTH, TILE, USUAL = 1.5, 100, {"azdeg": 315, "altdeg": 45}


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
    scene = Scene(lights=Light(direction=sun(HEIGHT)), material=PLAIN)
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


def real_ground(times):
    """Return heights of smooth real ground, its slopes along both axes, and its spacing, in metres.

    The ground is a sum of Gaussians at the nodes of the data, here at ``times`` as many nodes each
    way.
    """
    grid = vizlight.load_example("jacksboro_fault.vti")
    columns, rows, _ = grid.dimensions
    peaks = np.zeros((rows * times, columns * times))
    peaks[::times, ::times] = np.reshape(grid["elevation"], (rows, columns))
    peaks *= times * times
    spacing = np.array(grid.spacing[:2]) / times
    z, along, across = (
        ndimage.gaussian_filter(peaks, WIDTH * times, order, truncate=6)
        for order in ((0, 0), (0, 1), (1, 0))
    )
    return z, along / spacing[0], across / spacing[1], spacing


def cosines(along, across):
    """Return the light of the usual sun on ground of some slopes."""
    x, y, z = LightSource(**USUAL).direction
    return np.maximum(z - x * along - y * across, 0) / np.sqrt(1 + along**2 + across**2)


def by_gdal(z, spacing):
    """Return light by GDAL's formula, which is Horn's; the border's slopes go on beyond it."""
    z = np.pad(z, 1, mode="reflect", reflect_type="odd")
    inner = slice(1, -1)
    sums = [ndimage.convolve1d(z, [1, 2, 1], axis=axis) for axis in (0, 1)]
    along, across = (
        np.roll(total, -1, axis) - np.roll(total, 1, axis)
        for total, axis in zip(sums, (1, 0), strict=True)
    )
    return cosines(
        along[inner, inner] / (8 * spacing[0]), across[inner, inner] / (8 * spacing[1])
    )  # fmt: skip


def by_matplotlib(z, spacing):
    """Return light by the normals of matplotlib's ``LightSource``, before it is stretched."""
    across, along = np.gradient(z, *spacing[::-1])
    return cosines(along, across)


def _usual():
    """Return the scene of the usual sun, seen from above."""
    light = Light(direction=LightSource(**USUAL).direction)
    return Scene(lights=light, material=PLAIN, view=View(direction=(0, 0, 1)))


def _map(z, spacing):
    grid = pv.ImageData(dimensions=(*z.shape[::-1], 1), spacing=(*spacing, 1))
    grid["height"] = z.ravel()
    return grid


def by_illuminate(z, spacing):
    """Return light by ``illuminate`` on the raised ground."""
    ground = _map(z, spacing).warp_by_scalar("height")
    ground.clear_data()
    return np.reshape(vizlight.illuminate(ground, _usual())["luminance"], z.shape)


def by_shadow(z, spacing):
    """Return light by ``relief_shadow``."""
    return np.reshape(vizlight.relief_shadow(_map(z, spacing), _usual())["t"], z.shape)


#: Ways to shade ground.
SHADED = {
    "GDAL's formula": by_gdal, "matplotlib's LightSource": by_matplotlib,
    "illuminate": by_illuminate, "relief_shadow": by_shadow,
}  # fmt: skip


def root_mean_square(differences):
    """Return the root mean square in grey levels."""
    return float(255 * np.sqrt(np.mean(np.square(differences))))


def shaded(times, repeats=3):
    """Return the rows of shaded real ground: error, noise of whole metres, seams of tiles.

    All but the mean error are root mean squares in grey levels.
    """
    z, along, across, spacing = real_ground(times)
    exact = cosines(along, across)
    tiles = [
        (slice(j, j + TILE), slice(i, i + TILE))
        for j in range(0, len(z) - TILE + 1, TILE)
        for i in range(0, z.shape[1] - TILE + 1, TILE)
    ]
    border = np.pad(np.zeros((TILE - 2, TILE - 2), dtype=bool), 1, constant_values=True)
    seconds = take_turns({way: partial(f, z, spacing) for way, f in SHADED.items()}, repeats)
    rows = []
    # The border of the data is left out: there the Gaussian repeats heights.
    inner = (slice(4 * times, -4 * times),) * 2
    for way, light in SHADED.items():
        whole = light(z, spacing)
        off = (whole - exact)[inner]
        more = {
            "rms of 255": root_mean_square(off),
            "noise of metres, rms of 255": root_mean_square(
                (light(np.rint(z), spacing) - whole)[inner]
            ),
            "at borders of tiles, rms of 255": root_mean_square(
                [(light(z[tile], spacing) - whole[tile])[border] for tile in tiles]
            ),
        }
        cost = 1e9 * seconds[way] / z.size
        rows.append(Row(f"real ground, {way}", len(z), float(np.abs(off).mean()), cost, more))
    return rows


def steps(quick):
    """Return the steps: hills in two ways, other suns, hemispheres, hard shadows, real ground."""
    sides = (128, 256) if quick else (256, 512, 1024, 2048)
    small = [side for side in sides if side <= SMALL]
    made = [partial(measure, side, repeats=1 if quick else 3) for side in sides]
    made += [partial(measure, side, height, repeats=1) for height in HEIGHTS for side in small]
    made += [partial(hemisphere, side) for side in (76, 151, 301)]
    made += [partial(fragments, side, repeats=1 if quick else 3) for side in small]
    made += [partial(shaded, times, repeats=1 if quick else 3) for times in (1, 3)]
    return made + [partial(hard, side) for side in small]


STUDY = Study(
    approximates="t of the cos-theta shadow of height fields, sun at 20 degrees unless stated",
    reference="for hills, the light by NumPy; for a hemisphere and real ground, the closed form",
    parameter="points per side",
    error="mean error of t",
    cost="ns per point",
    steps=steps,
)
