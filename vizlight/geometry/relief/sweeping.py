"""A light at infinity: the field is resampled once in profiles along the light's azimuth.

In a profile the ray's own rise is taken from the heights, so that every ray toward the light
becomes level and what is inside the solid is what stands above it. Bounds over 2^l steps of a
profile then decide most of it at once, and the highest of all that is still to come ends it.
Profiles are made in bands, one after the other, so that memory does not grow with the field and
the bounds of a band stay in the cache.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from vizlight.geometry.relief.height_field import locate

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices
    from vizlight.geometry.relief.height_field import Field

#: Rays that leave the relief within so many columns are quicker to follow cell by cell.
STEEP = 3.0
#: More profiles than this many times the rows are not made, however uneven the rows.
PROFILES = 4
#: Rays of a band, about.
BAND = 1 << 16
#: Columns that are looked at one by one are 2^LEAF: fewer have no bounds.
LEAF = 3
#: Profiles of a band, at least: the last is made again for the next one.
NARROW = 8
#: Heights that differ by less are the same.
LEVEL = 1e-300
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
        self._field, self._solid = field, field.border == "extend"
        nodes = [field.x, field.y]
        size = [abs(way[a]) / np.mean(np.diff(nodes[a])) for a in (0, 1)]
        #: The axis that profiles step along, and the other.
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
        #: Levels are in this unit, so that they fit float32 whatever the field's size.
        self.unit = field.top + below + self.rise * float(np.ptp(self.columns))
        # At most as many columns as a ray crosses from as deep as this below level ground.
        run = below / (self.rise * float(np.mean(np.diff(columns))))
        self.first_scale = max(int(np.log2(max(run, 1.0))) - LEAF, 0)

    def _padded(
        self, columns: Array, rows: Array, relief: float, below: float
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
            np.append(after, last)
            if self._solid
            else columns[-1] + np.array([step, below + 2 * step])
        )
        inner = slice(len(before), len(before) + len(columns))
        return np.concatenate([before, columns, after]), inner

    def beside(self, start: Array) -> Array:
        """Return between which profiles places are, in profiles from the first."""
        across = start[self.side] - self.slope * self.sign * start[self.main]
        return np.asarray((across - self.first) / self.spacing)

    def surface(self, start: Array) -> Array:
        """Return the height of the field itself at places."""
        return np.asarray(self._field.height(start[0], start[1]))

    def width(self, rays: int) -> int:
        """Return of how many profiles a band for some of so many rays is."""
        return max(NARROW, -(-BAND * self.count // max(rays, 1)))

    def band(self, first: int, width: int) -> _Band:
        """Return the profiles for rays beside the first or up to so many more."""
        return _Band(self, self._level(first, min(width, self.count - 1 - first) + 1), first)

    def _level(self, first: int, count: int) -> Array:
        """Return heights less the ray's rise, in units, shape (columns, count)."""
        rows, nodes = self._rows, len(self._rows)
        offsets = self.first + self.spacing * np.arange(first, first + count)
        place = offsets + self.slope * self.columns[:, np.newaxis]
        share = np.interp(place, rows, np.arange(float(nodes)))
        row = share.astype(np.intp)
        share -= row
        own = np.arange(len(self.columns)) - self._inner.start
        held = np.clip(own, 0, len(self._heights) - 1)
        at = held[:, np.newaxis] * nodes + row
        flat = self._heights.ravel()
        low = flat[at]
        # At a node its neighbour does not matter, which may be a hole or not there.
        between = share > 0
        at += between
        level = np.where(between, low + share * (flat[at] - low), low)
        level -= self.rise * self.columns[:, np.newaxis]
        level /= self.unit
        if not self._solid:
            level[own != held] = NO_SOLID
            np.copyto(level, NO_SOLID, where=(place < rows[0]) | (place > rows[-1]))
            np.copyto(level, NO_SOLID, where=np.isnan(level))
        return np.asarray(level)


class _Band:
    """Some profiles side by side: heights, bounds by level, the highest still to come."""

    def __init__(self, profiles: Profiles, level: Array, first: int) -> None:
        self.profiles, self.columns, self.first = profiles, profiles.columns, first
        # The two profiles of a ray stand side by side in memory.
        self.steps, self.count = len(level) - 1, level.shape[1]
        self.level = level.ravel()
        # Bounds are rounded outward to float32, which costs no accuracy and half the memory.
        up, down = _rounded(level, np.inf), _rounded(level, -np.inf)
        # The highest from each column on; at the last one nothing is still to come.
        coming = np.maximum.accumulate(up[::-1], axis=0)[::-1]
        coming[-1] = NO_SOLID
        self.coming = coming.ravel()
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
        """Return the length inside the solid of rays that start at places, shape (3, N)."""
        world = self.profiles
        x = world.sign * start[world.main]
        beside = world.beside(start) - self.first
        rays = _Level(self, x, beside, (start[2] - world.rise * x) / world.unit)
        length = np.zeros(len(x))
        row = np.arange(len(x))
        # The surface at the start is the field's own, however shallow the start is below it.
        surface = world.surface(start) - world.rise * x
        length += rays.begin(surface / world.unit)
        while True:
            going = np.flatnonzero(rays.going())
            if len(going) < len(row):
                rays.keep(going)
                row = row.take(going)
            if not len(row):
                return np.asarray(length * world.per_step)
            # Rays have rows of their own, so none is added twice.
            length[row] += rays.step()


class _Level:
    """Level rays, each between two profiles; all change in every step."""

    def __init__(self, world: _Band, x: Array, beside: Array, z: Array) -> None:
        self.world, self.x, self.z = world, x, z
        self.profile = np.floor(beside).astype(np.intp)
        self.share = beside - self.profile
        #: The column that a ray is at, and the scale l of its next step, to the end of the
        #: 2^(LEAF + l) columns that hold it: it need not be at their beginning.
        self.at = locate(world.columns, x) - 1
        self.scale = np.full(len(x), world.first_scale, np.intp)

    def keep(self, going: Indices) -> None:
        """Forget the rays that are at their end."""
        for name in ("z", "profile", "share", "at", "scale"):
            setattr(self, name, getattr(self, name).take(going))

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

    def going(self) -> Bools:
        """Return which rays have something above them still to come."""
        world = self.world
        return self._mix(world.coming, self.at * world.count + self.profile) > self.z

    def step(self) -> Array:
        """Take each ray to the end of its columns, or halve them; return the length inside."""
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
        """Return the length inside up to the next multiple of 2^LEAF columns."""
        at = self.at[which]
        # Columns that are behind or beyond have no width.
        nodes = (at >> LEAF << LEAF) + np.arange((1 << LEAF) + 1)[:, np.newaxis]
        nodes = np.minimum(np.maximum(nodes, at), self.world.steps)
        heights = self._height(nodes, which)
        part = _above(heights[:-1], heights[1:], self.z[which])
        part *= np.diff(self.world.columns.take(nodes), axis=0)
        result: Array = np.sum(part, axis=0)
        return result

    def _height(self, at: Indices, which: Any = slice(None)) -> Array:
        place = at * self.world.count + self.profile[which]
        low, high = self.world.level.take(place), self.world.level.take(place + 1)
        result: Array = low + self.share[which] * (high - low)
        return result

    def _mix(self, values: Array, place: Indices) -> Array:
        """Return values of two profiles, each weighed by how near the ray is to it."""
        low = values.take(place)
        result: Array = low + self.share * (values.take(place + 1) - low)
        return result


def _rounded(values: Array, toward: float) -> Array:
    """Return float32 values, not below or not above those given."""
    return np.asarray(np.nextafter(values.astype(np.float32), np.float32(toward)))


def _above(low: Array, high: Array, z: Array) -> Array:
    """Return the share of a straight line from low to high that is above z."""
    share = np.maximum(low, high)
    share -= z
    # A level one is above z or not.
    share /= np.maximum(np.abs(high - low), LEVEL)
    return np.asarray(np.clip(share, 0.0, 1.0, out=share))
