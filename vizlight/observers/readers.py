"""Readers of a lit picture: ideal observers of direction, slope and shape, and readers of a bar.

They get colours as a screen shows them, in bytes and with noise, and compare them in CIELAB or by
chromaticity.
"""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from vizlight.filters import relight
from vizlight.filters.tint import light_on_colors, map_colors
from vizlight.model.kernels import unit_rows
from vizlight.observers.samples import dots, flattened
from vizlight.shading import display

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array
    from vizlight.observers.samples import Part, Sample

#: CIE XYZ of linear sRGB (IEC 61966-2-1), and of white D65.
_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
_WHITE = _XYZ.sum(axis=1)
#: Variance of rounding to bytes, in units of the range.
ROUNDING = (1 / 255) ** 2 / 12
#: Number of candidates, one for each degree, and of places that are matched at once.
ANGLES, PLACES = 180, 1024
#: Least length of a unit tangent in the picture whose direction there is asked for.
SHORTEST = 0.35
#: Number of classes of steepness, and largest number of classes of lightness, between which
#: information is counted; and of the places for each of the latter. With 128 places in 32 classes
#: noise alone would tell 1.8 bits.
STEEP, LIGHT, EACH = 16, 32, 128
#: Number of candidates for a normal; where there are tangents, fewer, each with some of those. With
#: 24 directions of tangents the bits would be up to 0.8 too many, with 72 at most 0.15.
ALONE, WITH_TANGENTS = (900, 1), (300, 72)
#: Largest number of candidates that are lit where each place has its own, and matched in all.
LIT, MATCHED = 1 << 22, 1 << 25
#: Number of candidates that are matched at once.
BLOCK = 1 << 20


def linear(rgb: Array) -> Array:
    """Return sRGB values, from 0 to 1, in linear light (IEC 61966-2-1)."""
    found: Array = np.where(
        rgb <= 0.04045, rgb / 12.92, ((np.maximum(rgb, 0.0) + 0.055) / 1.055) ** 2.4
    )
    return found


def lab(rgb: Array) -> Array:
    """Return CIELAB of sRGB values, shape (..., 3) from 0 to 1, under white D65 (CIE 15)."""
    ratio = linear(rgb) @ _XYZ.T / _WHITE
    # Near black CIELAB has a straight line in place of the cube root.
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16 / 116)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def chromaticity(rgb: Array) -> Array:
    """Return the share of each channel in the sum of the three; 0 for black."""
    total = rgb.sum(axis=-1, keepdims=True)
    found: Array = rgb / np.maximum(total, 1 / 255)
    return found


def shown(rgb: Array) -> Array:
    """Return the colours of light, 0 or more, in the range of a screen."""
    return display.displayable(np.maximum(rgb, 0.0))


def seen(rgb: Array, random: np.random.Generator, noise: float) -> Array:
    """Return colours of light as a reader gets them: on a screen, with noise, in bytes."""
    colors = shown(rgb)
    noisy = colors + random.normal(0.0, noise, colors.shape)
    found: Array = np.rint(255 * np.clip(noisy, 0.0, 1.0)) / 255
    return found


def posterior(observed: Array, table: Array, noise: float) -> Array:
    """Return the probability of each candidate, equally likely before the pixel is seen.

    Parameters
    ----------
    observed : ndarray, shape (M, 3)
        Colours of pixels, from 0 to 1.
    table : ndarray, shape (A, 3) or (M, A, 3)
        Colours of the candidates without noise, the same for all pixels or separate for each.
    noise : float
        Standard deviation of each channel, to which the deviation of rounding to bytes is added.

    Returns
    -------
    ndarray, shape (M, A)
        Probabilities, with sum 1 in each row.
    """
    if table.ndim == 3:
        square = ((observed[:, np.newaxis] - table) ** 2).sum(axis=-1)
    else:
        # |a - b|^2 = |a|^2 + |b|^2 - 2 a.b: a product of matrices in place of all differences.
        square = (observed**2).sum(axis=-1)[:, np.newaxis] + (table**2).sum(axis=-1)
        square = square - 2 * observed @ table.T
    # The likeliest candidate is then 1 before the division, and no row vanishes by underflow.
    square -= square.min(axis=1, keepdims=True)
    # The noise is Gaussian and alike in all channels, and all candidates are equally likely before,
    # so that the likelihood of the colour is the probability up to its sum.
    found: Array = np.exp(-square / (2 * (noise**2 + ROUNDING)))
    return np.asarray(found / found.sum(axis=1, keepdims=True))


def information(probability: Array) -> Array:
    """Return the bits that each pixel tells of candidates that were equally likely before."""
    # The entropy of equally likely candidates, less what is left of it.
    bits = probability * np.log2(np.maximum(probability, 1e-300))
    found: Array = np.log2(probability.shape[1]) + bits.sum(axis=1)
    return found


class Found(NamedTuple):
    """Errors in degrees and bits of each place; of an ideal observer."""

    error: Array
    bits: Array


def find_direction(sample: Sample, random: np.random.Generator, noise: float) -> Found:
    """Return the errors of an observer who knows lamps, material and normal.

    The candidates are the tangent turned about the normal, or about the line of sight for a
    point without one, by each degree from a random angle.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    Found
        Angle in degrees, from 0 to 90, between the tangent and the likeliest candidate, and the
        bits that the colour tells of the 180 candidates.
    """
    own, axis = sample, sample.eye
    if sample.normals is not None:
        # Interpolation leaves a tangent a little off the surface.
        tangent, axis = _single(sample), sample.normals
        flat = unit_rows(flattened(tangent, axis))
        own = dataclasses.replace(sample, tangents=flat[:, np.newaxis])
    return _find_turned(own, axis, random, noise)


def _find_turned(sample: Sample, axes: Array, random: np.random.Generator, noise: float) -> Found:
    """Return the errors of an observer to whom tangents may be turned about axes."""
    errors: list[Array] = [np.empty(0)]
    bits: list[Array] = [np.empty(0)]
    for start in range(0, len(sample), PLACES):
        rows = slice(start, start + PLACES)
        own, axis = sample.take(rows), axes[rows]
        tangent = _single(own)
        # Rodrigues' rotation: what is along the axis stays.
        along = dots(tangent, axis)[:, np.newaxis] * axis
        flat = tangent - along
        # Candidates start anywhere: ties must not favour the true one.
        offset = random.uniform(0.0, 180.0, len(own))
        turn = np.radians(np.arange(ANGLES) + offset[:, np.newaxis])[..., np.newaxis]
        side = np.cross(axis, flat)[:, np.newaxis]
        every = np.cos(turn) * flat[:, np.newaxis] + np.sin(turn) * side + along[:, np.newaxis]
        likely = posterior(seen(own.own_light(), random, noise), _lit(own, every), noise)
        # The first candidate is turned by the offset from the true one, and lines repeat after 180
        # degrees.
        off = (likely.argmax(axis=1) + offset) % 180
        errors.append(np.minimum(off, 180 - off))
        bits.append(information(likely))
    return Found(np.concatenate(errors), np.concatenate(bits))


def _single(sample: Sample) -> Array:
    assert sample.tangents is not None
    return sample.tangents[:, 0]


def _lit(sample: Sample, tangents: Array) -> Array:
    """Return the colours of places for each of several tangents, shape (M, A, 3)."""
    m, a, _ = tangents.shape
    normals = None if sample.normals is None else np.repeat(sample.normals, a, axis=0)
    return shown(sample.light(tangents.reshape(-1, 1, 3), normals, a)).reshape(m, a, 3)


def by_key(sample: Sample, middle: Array, random: np.random.Generator, noise: float) -> Array:
    """Return the errors of a reader who knows no normal and matches hues to a key.

    The key is a small disc at ``middle`` that faces the eye, with tangents in all directions.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    middle : ndarray, shape (3,)
        Place of the key.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    ndarray
        Angle in degrees, from 0 to 90, between the directions in the picture, of the tangents
        that have a length there.
    """
    tangent = _single(sample)
    x, y = (dots(tangent, axis) for axis in (sample.right, sample.up))
    long = np.hypot(x, y) > SHORTEST
    own = sample.take(long)
    if not len(own):
        return np.empty(0)
    start = random.uniform(0.0, 180.0)
    disc = key(own, middle, np.radians(start + np.arange(ANGLES)))
    hues = _hue(shown(disc), random)
    found = _hue(seen(own.own_light(), random, noise), random) @ hues.T
    off = start + found.argmax(axis=1) - np.degrees(np.arctan2(y, x))[long]
    # Lines have no sign, so that directions repeat after 180 degrees.
    return np.asarray(np.abs((off + 90) % 180 - 90))


def key(sample: Sample, middle: Array, angles: Array) -> Array:
    """Return the light of a disc that faces the eye at a place, for tangents at some angles."""
    nearest = np.argmin(((sample.points - middle) ** 2).sum(axis=1))
    one = sample.take(np.full(len(angles), nearest))
    across = np.cos(angles)[:, np.newaxis] * one.right + np.sin(angles)[:, np.newaxis] * one.up
    return one.light(across[:, np.newaxis], one.eye)


def _hue(rgb: Array, random: np.random.Generator) -> Array:
    """Return hues as unit vectors in the plane of CIELAB's a and b; gray has a random one."""
    plane = lab(rgb)[:, 1:]
    return unit_rows(plane + random.normal(0.0, 1e-6, plane.shape))


def steepness(sample: Sample) -> Array:
    """Return the cosine, 0 or more, of the angle between tangents and the line of sight."""
    return np.abs(dots(_single(sample), sample.eye))


def rank_correlation(a: Array, b: Array) -> float:
    """Return Spearman's rank correlation; 0 where one of the two is constant."""
    if np.ptp(a) == 0 or np.ptp(b) == 0:
        return 0.0
    from scipy.stats import rankdata

    return float(np.corrcoef(rankdata(a), rankdata(b))[0, 1])


def mutual_information(steep: Array, light: Array) -> float:
    """Return the bits that lightness tells of steepness, both in classes of equal count.

    Fewer than 4096 places tell less than there is: of n, classes of lightness are ``n / 128``. The
    bias of a sample of n is taken off: ``(joint - rows - columns + 1) / (2 n ln 2)``, of the
    numbers of classes that occur (Miller 1955).
    """
    rows, columns = (
        # Quantiles that coincide, as of many equal values, bound one class.
        np.searchsorted(np.unique(np.quantile(x, np.linspace(0, 1, k + 1)[1:-1])), x)
        for x, k in ((steep, STEEP), (light, min(LIGHT, max(2, len(light) // EACH))))
    )
    joint = np.bincount(rows * LIGHT + columns, minlength=STEEP * LIGHT)
    share = joint.reshape(STEEP, LIGHT) / len(steep)
    alone = share.sum(axis=1, keepdims=True) * share.sum(axis=0, keepdims=True)
    there = share > 0
    bits = float((share[there] * np.log2(share[there] / alone[there])).sum())
    classes = int(there.sum()) - int(there.any(axis=1).sum()) - int(there.any(axis=0).sum()) + 1
    return max(0.0, bits - classes / (2 * len(steep) * math.log(2)))


def find_slope(sample: Sample, random: np.random.Generator, noise: float) -> Array:
    """Return the errors of an observer who knows the course of lines in the picture.

    Parameters
    ----------
    sample : Sample
        Places with one tangent each.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    ndarray
        Angle in degrees, from 0 to 90, between the tangent and the likeliest of 180 directions
        with the same course; of tangents that are not along the line of sight.
    """
    tangent = _single(sample)
    apart = steepness(sample) < 1 - 1e-9
    own = sample.take(apart)
    # A turn about what stands across the line of sight leaves the course as it is.
    return _find_turned(own, unit_rows(np.cross(tangent[apart], own.eye)), random, noise).error


def most(sample: Sample) -> int:
    """Return the largest number of places that are asked for."""
    each, turns = ALONE if sample.tangents is None else WITH_TANGENTS
    return max(64, (LIT if sample.local else MATCHED) // (each * turns))


def find_normal(sample: Sample, random: np.random.Generator, noise: float) -> Found:
    """Return the errors of an observer who knows lamps and material.

    The candidates are even on the disc that a smooth body shows, so that each is as likely as it
    is large in a picture of all normals. Tangents, if there are any, may have any direction.

    Parameters
    ----------
    sample : Sample
        Places with normals.
    random : numpy.random.Generator
    noise : float
        Standard deviation of each channel.

    Returns
    -------
    Found
        Angle in degrees between the side of the surface that is seen and the mean of the
        candidates by their probability, and the bits that the colour tells of the candidates. The
        likeliest one would be worse than no look at the picture where the colour tells little.
    """
    assert sample.normals is not None
    count, turns = ALONE if sample.tangents is None else WITH_TANGENTS
    disc, along = _disc(count, turns, random.uniform(0.0, 2 * np.pi))
    observed = seen(sample.own_light(), random, noise)
    facing = np.einsum("ij,ij->i", sample.normals, sample.eye)[:, np.newaxis]
    truth = np.where(facing < 0, -sample.normals, sample.normals)
    errors, bits = [], []
    step = max(1, BLOCK // len(disc))
    table: Array | None = None
    for start in range(0, len(sample), step):
        own = sample.take(slice(start, start + step))
        # Far lamps and a far eye light all places alike: one table of candidates serves them.
        if sample.local or table is None:
            lit = own if sample.local else own.take(np.zeros(1, dtype=np.intp))
            table = _table(lit, disc, along)
            table = table if sample.local else table[0]
        likely = posterior(observed[start : start + step], table, noise)
        # The tangent is unknown: a normal is as likely as all of its tangents together.
        normal = likely.reshape(len(own), turns, count).sum(axis=1)
        best = unit_rows(normal @ disc[:count])
        cosine = np.einsum("ij,ij->i", _in_space(own, best), truth[start : start + step])
        errors.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
        bits.append(information(normal))
    return Found(np.concatenate(errors), np.concatenate(bits))


def _disc(count: int, turns: int, phase: float) -> tuple[Array, Array]:
    """Return candidates in the frame of the eye: normals and tangents, shape (turns count, 3)."""
    i = np.arange(count) + 0.5
    # Fibonacci's spiral, even in area.
    radius, angle = np.sqrt(i / count), i * np.pi * (3 - 5**0.5) + phase
    height = np.sqrt(1 - radius * radius)
    normals = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], axis=1)
    # Any direction that is nowhere along a normal: the edge of the disc is not a candidate.
    first = unit_rows(np.cross(normals, [np.cos(phase), np.sin(phase), 0.0]))
    second = np.cross(normals, first)
    turn = (np.pi * np.arange(turns) / turns)[:, np.newaxis, np.newaxis]
    tangents = np.cos(turn) * first + np.sin(turn) * second
    return np.tile(normals, (turns, 1)), tangents.reshape(-1, 3)


def _in_space(sample: Sample, local: Array) -> Array:
    """Return vectors in the frame of the eye, one for each place, in space."""
    axes = np.stack([sample.right, sample.up, sample.eye], axis=1)
    return np.asarray(np.einsum("ij,ijk->ik", local, axes))


def _table(sample: Sample, normals: Array, tangents: Array) -> Array:
    """Return the colours of candidates, shape (M, A, 3)."""
    m, a = len(sample), len(normals)
    axes = np.stack([sample.right, sample.up, sample.eye], axis=1)
    every = np.einsum("aj,ijk->iak", normals, axes).reshape(-1, 3)
    frames = None
    if sample.tangents is not None:
        frames = np.einsum("aj,ijk->iak", tangents, axes).reshape(-1, 1, 3)
        # Of a plane of tangents the second is across the first.
        if sample.tangents.shape[1] == 2:
            frames = np.concatenate([frames, np.cross(every, frames[:, 0])[:, np.newaxis]], axis=1)
    return shown(sample.light(frames, every, a)).reshape(m, a, 3)


def decode(colors: Array, positions: Array, bar: Array) -> tuple[Array, Array]:
    """Return the errors of a reader who looks colours up on a bar.

    Parameters
    ----------
    colors : ndarray, shape (M, 3)
        Colours of the picture, from 0 to 1.
    positions : ndarray, shape (M,)
        Places of the values on the bar, from 0 to 1.
    bar : ndarray, shape (B, 3)
        Colours of the bar, from one end to the other.

    Returns
    -------
    nearest, chromatic : ndarray, shape (M,)
        Distances on the bar between the value and the nearest colour, in CIELAB and by
        chromaticity, as shares of the range.
    """
    # A colour of the bar stands for the middle of its step.
    middle = (np.arange(len(bar)) + 0.5) / len(bar)

    def missed(known: Array, given: Array) -> Array:
        nearest = cKDTree(known).query(given)[1]
        return np.asarray(np.abs(middle[nearest] - positions))

    return missed(lab(bar), lab(colors)), missed(chromaticity(bar), chromaticity(colors))


def lit_colors(part: Part, sample: Sample, table: pv.LookupTable) -> Array:
    """Return the colours of values times light, as :func:`vizlight.tint` makes them."""
    assert sample.values is not None
    inputs = sample.given(sample.tangents, sample.normals)
    source = relight.Source(part.mesh, inputs, sample.options, None)
    ((light, _),) = light_on_colors([source], sample.scene)
    colors = display.on_colors(map_colors(table, sample.values, components=3), light)
    return np.asarray(colors / 255.0)
