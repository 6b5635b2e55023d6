"""A light at infinity: the field is resampled once in profiles along the light's azimuth.

In a profile the ray's own rise is taken from the heights, so that every ray toward the light
becomes level and what is inside the solid is what stands above it. Bounds over 2^l steps of a
profile then decide most of it at once, and the highest of all that is still to come ends it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from vizlight.geometry._field import Field

    Array = NDArray[np.floating[Any]]
    Index = NDArray[np.intp]

#: Rays that leave the relief within so many columns are quicker to follow cell by cell.
STEEP = 3.0
#: More profiles than this many times the rows are not made, however uneven the rows.
PROFILES = 4
#: Stands for a level without solid: weighed by a rounded 0 it stays a number.
NO_SOLID = -1e6


def profiles(field: Field, way: Array, below: float) -> Profiles | None:
    """Return the profiles of a field, or None where rays are quicker to follow without.

    They are so where they leave the relief within few columns or hardly rise at all, and where
    the solid has a base or they start far outside of it.
    """
    across = float(np.hypot(way[0], way[1]))
    size = max(field.x[-1], field.y[-1])
    steps = [len(field.x) / field.x[-1], len(field.y) / field.y[-1]]
    columns = max(abs(way[a]) * steps[a] for a in (0, 1)) * (field.top + below)
    if not across * 1e-6 < way[2] < columns / STEEP:
        return None
    if field.base != -np.inf or below > size:
        return None
    return Profiles(field, way, below)


class Profiles:
    """A field along the azimuth of one light, ready for rays that start anywhere.

    Parameters
    ----------
    field : Field
    way : ndarray, shape (3,)
        Unit direction toward the light, above the horizon.
    below : float
        How far beside and below the surface rays may start.
    """

    def __init__(self, field: Field, way: Array, below: float) -> None:
        self._field = field
        nodes = [field.x, field.y]
        size = [abs(way[a]) / np.mean(np.diff(nodes[a])) for a in (0, 1)]
        #: The axis that profiles step along, and the other.
        self.main, self.side = (0, 1) if size[0] >= size[1] else (1, 0)
        self.sign = 1.0 if way[self.main] > 0 else -1.0
        along = self.sign * way[self.main]
        self.slope, self.rise = way[self.side] / along, way[2] / along
        self.per_step = 1 / along
        columns = np.sort(self.sign * nodes[self.main])
        rows = nodes[self.side]
        heights = field.heights if self.main == 1 else field.heights.T
        heights = np.ascontiguousarray(heights[:: int(self.sign)])
        solid = field.border == "extend"
        self.columns, inner = self._padded(columns, rows, field.top + below, below, solid=solid)

        step = max(np.diff(rows).min(), (rows[-1] - rows[0]) / (PROFILES * len(rows)))
        reach = np.sort(self.slope * np.array([self.columns[0], columns[-1] + below]))
        self.first = rows[0] - reach[1] - below - step
        self.spacing = step
        count = int(np.ceil((rows[-1] - reach[0] + below + step - self.first) / step)) + 2
        #: Levels are in this unit, so that they fit float32 whatever the field's size.
        self.unit = field.top + below + self.rise * float(np.ptp(self.columns))
        self._bounds(self._level(heights, rows, inner, count, solid=solid))

    def _padded(
        self, columns: Array, rows: Array, relief: float, below: float, *, solid: bool
    ) -> tuple[Array, slice]:
        """Return the columns with those beyond the border, and which are the field's own."""
        step = float(np.mean(np.diff(columns)))
        before = columns[0] - step * np.arange(int(np.ceil(below / step)) + 1, 0, -1)
        far = relief / self.rise
        if self.slope:
            far = min(far, (np.ptp(rows) + below) / abs(self.slope))
        # Beyond the border only the rows change: one column a row is enough of them.
        stride = max(far / len(rows), step)
        after = columns[-1] + stride * np.arange(1, int(np.ceil(far / stride)) + 1)
        last = columns[-1] + below + relief / self.rise + 2 * stride
        after = (
            np.append(after, last) if solid else columns[-1] + np.array([step, below + 2 * step])
        )
        inner = slice(len(before), len(before) + len(columns))
        return np.concatenate([before, columns, after]), inner

    def _level(
        self, heights: Array, rows: Array, inner: slice, count: int, *, solid: bool
    ) -> Array:
        """Return heights less the ray's rise, in units, shape (columns, count)."""
        offsets = self.first + self.spacing * np.arange(count)
        result = np.full((len(self.columns), count), NO_SOLID)
        for k, column in enumerate(self.columns):
            own = min(max(k - inner.start, 0), len(heights) - 1)
            if not solid and own != k - inner.start:
                continue
            beyond = {} if solid else {"left": np.nan, "right": np.nan}
            result[k] = np.interp(offsets + self.slope * column, rows, heights[own], **beyond)
            result[k] -= self.rise * column
            result[k] /= self.unit
        np.copyto(result, NO_SOLID, where=np.isnan(result))
        return result

    def _bounds(self, level: Array) -> None:
        """Keep what the steps ask for: heights, bounds by level, the highest still to come."""
        # The two profiles of a ray stand side by side in memory.
        self.steps, self.count = len(level) - 1, level.shape[1]
        self.level = level.ravel()
        # Bounds are rounded outward to float32, which costs no accuracy and half the memory.
        up, down = _rounded(level, np.inf), _rounded(level, -np.inf)
        self.coming = np.maximum.accumulate(up[::-1], axis=0)[::-1].ravel()
        largest, least = np.maximum(up[:-1], up[1:]), np.minimum(down[:-1], down[1:])
        bounds = [(largest, least)]
        while len(largest) > 1:
            if len(largest) % 2:
                largest, least = (
                    np.pad(a, [(0, 1), (0, 0)], constant_values=NO_SOLID) for a in (largest, least)
                )
            largest = np.maximum(largest[::2], largest[1::2])
            least = np.minimum(least[::2], least[1::2])
            bounds.append((largest, least))
        self.offsets = np.cumsum([0] + [a.size for a, _ in bounds])
        self.largest = np.concatenate([a.ravel() for a, _ in bounds])
        self.least = np.concatenate([a.ravel() for _, a in bounds])
        self.top = len(bounds) - 1

    def lengths(self, start: Array) -> Array:
        """Return the length inside the solid of rays that start at places, shape (3, N)."""
        x = self.sign * start[self.main]
        beside = (start[self.side] - self.slope * x - self.first) / self.spacing
        rays = _Level(self, x, beside, (start[2] - self.rise * x) / self.unit)
        length = np.zeros(len(x))
        row = np.arange(len(x))
        # The surface at the start is the field's own, however shallow the start is below it.
        surface = self._field.height(start[0], start[1]) - self.rise * x
        length += rays.begin(surface / self.unit)
        while True:
            going = rays.going()
            if not np.all(going):
                rays.keep(going)
                row = row[going]
            if not len(row):
                return np.asarray(length * self.per_step)
            # Rays have rows of their own, so none is added twice.
            length[row] += rays.step()


class _Level:
    """Level rays, each between two profiles; all change in every step."""

    def __init__(self, world: Profiles, x: Array, beside: Array, z: Array) -> None:
        self.world, self.x, self.z = world, x, z
        self.profile = np.floor(beside).astype(np.intp)
        self.share = beside - self.profile
        self.at = np.searchsorted(world.columns, x, side="right") - 1
        self.scale = np.zeros(len(x), np.intp)

    def keep(self, going: NDArray[np.bool_]) -> None:
        """Forget the rays that are at their end."""
        for name in ("x", "z", "profile", "share", "at", "scale"):
            setattr(self, name, getattr(self, name)[going])

    def begin(self, surface: Array) -> Array:
        """Return what is inside of the first, partial step; the surface there is known better."""
        columns = self.world.columns
        first, last = columns[self.at], columns[self.at + 1]
        low, high = self._height(self.at), self._height(self.at + 1)
        part = (self.x - first) / (last - first)
        low = low + part * (high - low)
        shift = low - surface
        self.z += np.where(np.abs(shift) < 1, shift, 0.0)
        self.at += 1
        return _above(low, high, self.z) * (last - self.x)

    def going(self) -> NDArray[np.bool_]:
        """Return which rays have something above them still to come."""
        at = self.at << self.scale
        inner = at < self.world.steps
        place = np.minimum(at, self.world.steps) * self.world.count + self.profile
        return inner & (self._mix(self.world.coming, place) > self.z)

    def step(self) -> Array:
        """Take each ray through 2^l steps, or into the first half of them."""
        world, at, scale = self.world, self.at, self.scale
        place = world.offsets[scale] + at * world.count + self.profile
        below = self._mix(world.least, place) >= self.z
        clear = below | (self._mix(world.largest, place) <= self.z)
        inside = np.zeros(len(at))
        whole = np.flatnonzero(below)
        first, last = (np.minimum((at[whole] + k) << scale[whole], world.steps) for k in (0, 1))
        inside[whole] = world.columns[last] - world.columns[first]
        leaf = np.flatnonzero(~clear & (scale == 0))
        inside[leaf] = self._leaf(leaf)
        descend = ~clear & (scale > 0)
        at += ~descend
        ascend = ~descend & (at % 2 == 0) & (scale < world.top)
        at >>= ascend
        at <<= descend
        scale += ascend
        scale -= descend
        return inside

    def _leaf(self, which: Index) -> Array:
        at = self.at[which]
        low, high = self._height(at, which), self._height(at + 1, which)
        columns = self.world.columns
        return _above(low, high, self.z[which]) * (columns[at + 1] - columns[at])

    def _height(self, at: Index, which: Any = slice(None)) -> Array:
        place = at * self.world.count + self.profile[which]
        low, high = self.world.level[place], self.world.level[place + 1]
        result: Array = low + self.share[which] * (high - low)
        return result

    def _mix(self, values: Array, place: Index) -> Array:
        """Return values of two profiles, each weighed by how near the ray is to it."""
        low = values[place]
        result: Array = low + self.share * (values[place + 1] - low)
        return result


def _rounded(values: Array, toward: float) -> Array:
    """Return float32 values, not below or not above those given."""
    return np.asarray(np.nextafter(values.astype(np.float32), np.float32(toward)))


def _above(low: Array, high: Array, z: Array) -> Array:
    """Return the share of a straight line from low to high that is above z."""
    least, most = np.minimum(low, high), np.maximum(low, high)
    run = most - least
    share = np.divide(most - z, run, out=np.where(most > z, 1.0, 0.0), where=run > 0)
    return np.asarray(np.clip(share, 0.0, 1.0))
