"""Shadows of a light at infinity, from profiles of the field along the azimuth of the light.

The rise of the light's rays is subtracted from the heights of a profile, so every ray toward the
light becomes level and is inside the solid where the profile is higher. Bounds over 2^l steps of a
profile then decide most of it at once, and a ray ends where nothing higher is ahead. Profiles are
made in bands, one after the other, so that memory does not grow with the field and the bounds of a
band stay in the cache.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.geometry.relief.height_field import locate

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.relief.height_field import Field

#: Rays that leave the relief within this number of columns are faster to follow cell by cell.
STEEP = 3.0
#: Largest number of profiles per row of the field, for rows of any spacing.
PROFILES = 4
#: Approximate number of rays in a band.
BAND = 1 << 16
#: The finest bounds cover 2^LEAF columns; inside them columns are tested one by one.
LEAF = 3
#: Smallest number of profiles in a band; the last one is computed again for the next band.
NARROW = 8
#: Smallest difference of heights that counts.
LEVEL = 1e-300
#: Level where there is no solid; finite, so that a weight of 0 does not make it NaN.
NO_SOLID = -1e6


def profiles(field: Field, way: Array, below: float) -> Profiles | None:
    """Return the profiles of a field, or None where rays are faster to follow without them.

    That is so where rays leave the relief within few columns or hardly rise at all, and where the
    rays start far outside the solid.
    """
    across = float(np.hypot(way[0], way[1]))
    size = max(field.x[-1], field.y[-1])
    steps = [len(field.x) / field.x[-1], len(field.y) / field.y[-1]]
    columns = max(abs(way[a]) * steps[a] for a in (0, 1)) * (field.top + below)
    if not across * 1e-6 < way[2] < columns / STEEP:
        return None
    if below > size:
        return None
    return Profiles(field, way, below)


class Profiles:
    """A field along the azimuth of one light, prepared for rays that start anywhere.

    Parameters
    ----------
    field : Field
        Height field.
    way : ndarray, shape (3,)
        Unit direction toward the light, above the horizon.
    below : float
        Largest distance beside and below the surface at which rays start.
    """

    def __init__(self, field: Field, way: Array, below: float) -> None:
        self._field, self._solid = field, field.border == "extend"
        nodes = [field.x, field.y]
        size = [abs(way[a]) / np.mean(np.diff(nodes[a])) for a in (0, 1)]
        #: The axis along which profiles step, and the other axis.
        self.main, self.side = (0, 1) if size[0] >= size[1] else (1, 0)
        self.sign = 1.0 if way[self.main] > 0 else -1.0
        along = self.sign * way[self.main]
        self.slope, self.rise = way[self.side] / along, way[2] / along
        self.per_step = 1 / along
        columns = np.sort(self.sign * nodes[self.main])
        self._rows = rows = nodes[self.side]
        heights = field.heights if self.main == 1 else field.heights.T
        self._heights = np.ascontiguousarray(heights[:: int(self.sign)])
        self.columns, self._inner = self._padded(columns, rows, field.top + below, below)

        step = max(np.diff(rows).min(), (rows[-1] - rows[0]) / (PROFILES * len(rows)))
        reach = np.sort(self.slope * np.array([self.columns[0], columns[-1] + below]))
        self.first = rows[0] - reach[1] - below - step
        self.spacing = step
        self.count = int(np.ceil((rows[-1] - reach[0] + below + step - self.first) / step)) + 2
        #: Unit of levels, with which they fit float32 for a field of any size.
        self.unit = field.top + below + self.rise * float(np.ptp(self.columns))
        # Number of columns that a ray crosses from a depth of ``below`` under level ground.
        run = below / (self.rise * float(np.mean(np.diff(columns))))
        self.first_scale = max(int(np.log2(max(run, 1.0))) - LEAF, 0)

    def _padded(
        self, columns: Array, rows: Array, relief: float, below: float
    ) -> tuple[Array, slice]:
        """Return the columns extended beyond the border, and the slice of the field's own."""
        step = float(np.mean(np.diff(columns)))
        before = columns[0] - step * np.arange(int(np.ceil(below / step)) + 1, 0, -1)
        far = relief / self.rise
        if self.slope:
            far = min(far, (np.ptp(rows) + below) / abs(self.slope))
        # Beyond the border the heights change from row to row alone: one column per row is enough.
        stride = max(far / len(rows), step)
        after = columns[-1] + stride * np.arange(1, int(np.ceil(far / stride)) + 1)
        last = columns[-1] + below + relief / self.rise + 2 * stride
        after = (
            np.append(after, last)
            if self._solid
            else columns[-1] + np.array([step, below + 2 * step])
        )
        inner = slice(len(before), len(before) + len(columns))
        return np.concatenate([before, columns, after]), inner

    def profile_index(self, start: Array) -> Array:
        """Return the fractional index of the profile at each position."""
        across = start[self.side] - self.slope * self.sign * start[self.main]
        return np.asarray((across - self.first) / self.spacing)

    def surface(self, start: Array) -> Array:
        """Return the height of the field itself at each position."""
        return np.asarray(self._field.height(start[0], start[1]))

    def width(self, rays: int) -> int:
        """Return the number of profiles per band for a total number of rays."""
        return max(NARROW, -(-BAND * self.count // max(rays, 1)))

    def band(self, first: int, width: int) -> _Band:
        """Return the band of ``width`` profiles from the first, and the one after them."""
        return _Band(self, self._level(first, min(width, self.count - 1 - first) + 1), first)

    def _level(self, first: int, count: int) -> Array:
        """Return heights minus the ray's rise, in units, shape (columns, count)."""
        rows, nodes = self._rows, len(self._rows)
        offsets = self.first + self.spacing * np.arange(first, first + count)
        place = offsets + self.slope * self.columns[:, np.newaxis]
        # Heights of the profile are those of the field along one line aside of the columns.
        share = np.interp(place, rows, np.arange(float(nodes)))
        row = share.astype(np.intp)
        share -= row
        own = np.arange(len(self.columns)) - self._inner.start
        held = np.clip(own, 0, len(self._heights) - 1)
        at = held[:, np.newaxis] * nodes + row
        flat = self._heights.ravel()
        low = flat[at]
        # At a node its neighbour does not matter; it may be a hole or missing.
        between = share > 0
        at += between
        level = np.where(between, low + share * (flat[at] - low), low)
        # The rise of the light is taken off, so that every ray is level and a bound tells at once.
        level -= self.rise * self.columns[:, np.newaxis]
        # In units near 1 the bounds lose nothing in float32.
        level /= self.unit
        if not self._solid:
            level[own != held] = NO_SOLID
            np.copyto(level, NO_SOLID, where=(place < rows[0]) | (place > rows[-1]))
            np.copyto(level, NO_SOLID, where=np.isnan(level))
        return np.asarray(level)


class _Band:
    """Adjacent profiles: heights, bounds on every scale, and the highest level ahead."""

    def __init__(self, profiles: Profiles, level: Array, first: int) -> None:
        self.profiles, self.columns, self.first = profiles, profiles.columns, first
        # The two profiles of a ray are adjacent in memory.
        self.steps, self.count = len(level) - 1, level.shape[1]
        self.level = level.ravel()
        # Bounds are rounded outward to float32, which halves the memory without loss of accuracy.
        up, down = _rounded(level, np.inf), _rounded(level, -np.inf)
        # The highest level from each column on; nothing is ahead of the last one.
        coming = np.maximum.accumulate(up[::-1], axis=0)[::-1]
        coming[-1] = NO_SOLID
        self.coming = coming.ravel()
        # A pyramid over columns: bounds of 2^l steps, from 2^LEAF on.
        largest, least = np.maximum(up[:-1], up[1:]), np.minimum(down[:-1], down[1:])
        bounds: list[tuple[Array, Array]] = []
        while len(bounds) < LEAF + 1 or len(largest) > 1:
            bounds.append((largest, least))
            if len(largest) % 2:
                largest, least = (
                    np.pad(a, [(0, 1), (0, 0)], constant_values=NO_SOLID) for a in (largest, least)
                )
            largest = np.maximum(largest[::2], largest[1::2])
            least = np.minimum(least[::2], least[1::2])
        bounds.append((largest, least))
        bounds = bounds[LEAF:]
        self.offsets = np.cumsum([0] + [a.size for a, _ in bounds])
        self.largest = np.concatenate([a.ravel() for a, _ in bounds])
        self.least = np.concatenate([a.ravel() for _, a in bounds])
        self.top = len(bounds) - 1
        self.first_scale = min(profiles.first_scale, self.top)

    def lengths(self, start: Array) -> Array:
        """Return the length inside the solid of rays that start at positions (3, N)."""
        world = self.profiles
        x = world.sign * start[world.main]
        index = world.profile_index(start) - self.first
        rays = _Level(self, x, index, (start[2] - world.rise * x) / world.unit)
        length = np.zeros(len(x))
        row = np.arange(len(x))
        # The field itself gives the surface at the start, which matters for a shallow start.
        surface = world.surface(start) - world.rise * x
        # The first step is partial, from the place of the ray to the next column.
        length += rays.begin(surface / world.unit)
        while True:
            going = np.flatnonzero(rays.going())
            if len(going) < len(row):
                rays.keep(going)
                row = row.take(going)
            if not len(row):
                return np.asarray(length * world.per_step)
            # Each ray has its own row, so no addition is lost.
            length[row] += rays.step()


class _Level:
    """Level rays, each between two profiles; every step advances all of them."""

    def __init__(self, world: _Band, x: Array, index: Array, z: Array) -> None:
        self.world, self.x, self.z = world, x, z
        self.profile = np.floor(index).astype(np.intp)
        self.share = index - self.profile
        #: Column of each ray, and scale l of its next step, which leads to the end of the
        #: 2^(LEAF + l) columns that contain it; the ray need not be at their beginning.
        self.at = locate(world.columns, x) - 1
        self.scale = np.full(len(x), world.first_scale, np.intp)

    def keep(self, going: Indices) -> None:
        """Drop the rays that have reached their end."""
        for name in ("z", "profile", "share", "at", "scale"):
            setattr(self, name, getattr(self, name).take(going))

    def begin(self, surface: Array) -> Array:
        """Return the length inside on the first, partial step, with the exact surface there."""
        columns = self.world.columns
        first, last = columns[self.at], columns[self.at + 1]
        low, high = self._height(self.at), self._height(self.at + 1)
        part = (self.x - first) / (last - first)
        low = low + part * (high - low)
        shift = low - surface
        self.z += np.where(np.abs(shift) < 1, shift, 0.0)
        self.at += 1
        return _above(low, high, self.z) * (last - self.x)

    def going(self) -> Bools:
        """Return a mask of the rays that have a higher level ahead."""
        world = self.world
        return self._mix(world.coming, self.at * world.count + self.profile) > self.z

    def step(self) -> Array:
        """Move each ray to the end of its columns, or halve them; return the length inside."""
        world, at, scale = self.world, self.at, self.scale
        square = at >> (scale + LEAF)
        place = world.offsets[scale] + square * world.count + self.profile
        below = self._mix(world.least, place) >= self.z
        clear = below | (self._mix(world.largest, place) <= self.z)
        descend = ~clear & (scale > 0)
        square += 1
        last = np.minimum(square << (scale + LEAF), world.steps)
        inside = np.where(below, world.columns[last] - world.columns[at], 0.0)
        leaf = np.flatnonzero(~clear & (scale == 0))
        inside[leaf] = self._leaf(leaf)
        np.copyto(at, last, where=~descend)
        scale += ~descend & (square & 1 == 0) & (scale < world.top)
        scale -= descend
        return inside

    def _leaf(self, which: Indices) -> Array:
        """Return the length inside as far as the next multiple of 2^LEAF columns."""
        at = self.at[which]
        # Columns behind the ray or beyond the last one get a width of 0.
        nodes = (at >> LEAF << LEAF) + np.arange((1 << LEAF) + 1)[:, np.newaxis]
        nodes = np.minimum(np.maximum(nodes, at), self.world.steps)
        heights = self._height(nodes, which)
        part = _above(heights[:-1], heights[1:], self.z[which])
        part *= np.diff(self.world.columns.take(nodes), axis=0)
        result: Array = np.sum(part, axis=0)
        return result

    def _height(self, at: Indices, which: Indices | slice = slice(None)) -> Array:
        place = at * self.world.count + self.profile[which]
        low, high = self.world.level.take(place), self.world.level.take(place + 1)
        result: Array = low + self.share[which] * (high - low)
        return result

    def _mix(self, values: Array, place: Indices) -> Array:
        """Return the values at rays, interpolated between their two profiles."""
        low = values.take(place)
        result: Array = low + self.share * (values.take(place + 1) - low)
        return result


def _rounded(values: Array, toward: float) -> Array:
    """Return float32 bounds of values: upper ones toward infinity, lower ones toward -infinity."""
    return np.asarray(np.nextafter(values.astype(np.float32), np.float32(toward)))


def _above(low: Array, high: Array, z: Array) -> Array:
    """Return the share of a straight line from low to high that is above z."""
    share = np.maximum(low, high)
    share -= z
    # For a level line the share is 0 or 1.
    share /= np.maximum(np.abs(high - low), LEVEL)
    return np.asarray(np.clip(share, 0.0, 1.0, out=share))
