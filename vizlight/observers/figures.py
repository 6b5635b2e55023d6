"""The figures of each question, from the places of a picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.observers import direction, shape, slope, value
from vizlight.observers.colors import lab, seen
from vizlight.observers.record import Direction, Shape, Slope, Value

if TYPE_CHECKING:
    import pyvista as pv

    from vizlight._types import Array
    from vizlight.observers.parts import Part
    from vizlight.observers.samples import Sample


def of_direction(
    samples: list[Sample], seed: int, noise: float, notes: list[str]
) -> Direction | None:
    """Return the figures of direction; what has none, or was left out, is added to the notes."""
    asked = direction.directed(samples)
    own = _with_data(asked, "direction", "tangents or normals", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    found = [direction.ideal(one, random, noise) for one in own]
    middle = np.concatenate([one.points for one in own]).mean(axis=0)
    by_key = np.concatenate([direction.by_key(one, middle, random, noise) for one in own])
    error = np.concatenate([each.error for each in found])
    return Direction(
        within_10=float((error <= 10).mean()),
        median=float(np.median(error)),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        legend_median=float(np.median(by_key)) if len(by_key) else None,
        samples=len(error),
    )


def _with_data(samples: list[Sample], question: str, what: str, notes: list[str]) -> list[Sample]:
    """Return the places where vectors have a direction, and note how many were left out."""
    kept = [one.take(one.valid) for one in samples]
    total, left = sum(map(len, samples)), sum(map(len, kept))
    if left < total:
        notes.append(f"{question}: {total - left} of {total} places have zero {what}, left out")
    return [one for one in kept if len(one)]


def of_slope(samples: list[Sample], seed: int, noise: float, notes: list[str]) -> Slope | None:
    """Return the figures of slope; what has none, or was left out, is added to the notes."""
    asked = [
        one
        for one in samples
        if one.kind == "line" and one.tangents is not None and one.tangents.shape[1] == 1
    ]
    own = _with_data(asked, "slope", "tangents", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    steep: list[Array] = []
    light: list[Array] = []
    for one in own:
        steep.append(slope.steepness(one))
        light.append(lab(seen(one.own_light(), random, noise))[:, 0])
    error = np.concatenate([slope.in_space(one, random, noise) for one in own])
    steepness, lightness = np.concatenate(steep), np.concatenate(light)
    return Slope(
        spearman=slope.rank_correlation(lightness, steepness),
        bits=slope.mutual_information(steepness, lightness),
        within_10=float((error <= 10).mean()) if len(error) else None,
        median=float(np.median(error)) if len(error) else None,
        samples=len(steepness),
    )


def of_shape(samples: list[Sample], seed: int, noise: float, notes: list[str]) -> Shape | None:
    """Return the figures of shape; what has none, or was left out, is added to the notes."""
    asked = [one for one in samples if one.kind != "line" and one.normals is not None]
    own = _with_data(asked, "shape", "tangents or normals", notes)
    if not own:
        return None
    random = np.random.default_rng(seed)
    found = []
    for one in own:
        few = random.permutation(len(one))[: shape.most(one)]
        found.append(shape.ideal(one.take(np.sort(few)), random, noise))
    error = np.concatenate([each.error for each in found])
    return Shape(
        median=float(np.median(error)),
        bits=float(np.concatenate([each.bits for each in found]).mean()),
        samples=len(error),
    )


def of_value(
    taken: list[tuple[Sample, Part]], table: pv.LookupTable, notes: list[str]
) -> Value | None:
    """Return the figures of value; what has none, or was left out, is added to the notes."""
    low, high = table.scalar_range
    bar = np.asarray(table.values)[:, :3] / 255.0
    if not low < high:
        notes.append(f"value: the scalars are constant, {low:g}, and have one colour")
        return None
    if not np.ptp(bar, axis=0).any():
        notes.append("value: the colour map has one colour")
        return None
    read = []
    left = 0
    for one, part in taken:
        assert one.values is not None
        # Points without light have the colour of what is not data.
        known = np.isfinite(one.values) & one.valid
        left += int(np.count_nonzero(~known))
        own = one.take(known)
        if len(own):
            assert own.values is not None
            positions = np.clip((own.values - low) / (high - low), 0.0, 1.0)
            read.append(value.decode(value.lit_colors(part, own, table), positions, bar))
    if left:
        total = sum(len(one) for one, _ in taken)
        notes.append(f"value: {left} of {total} places have no value, left out")
    if not read:
        return None
    nearest = np.concatenate([each.nearest for each in read])
    chromatic = np.concatenate([each.chromatic for each in read])
    return Value(
        median=float(np.median(nearest)),
        p95=float(np.quantile(nearest, 0.95)),
        largest=float(nearest.max()),
        median_chromaticity=float(np.median(chromatic)),
        p95_chromaticity=float(np.quantile(chromatic, 0.95)),
        largest_chromaticity=float(chromatic.max()),
        samples=len(nearest),
    )
