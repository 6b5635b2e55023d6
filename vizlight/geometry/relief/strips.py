"""Exact lengths inside a height field for a light at infinity, by compiled code, strip by strip.

The rise of the light's rays is subtracted from the heights, so that each ray is level. The rays of
one strip along the light's azimuth are sorted by their levels, and the columns of the strip are
gone through once, in the direction of the light. In a column, rays below all of its heights are
inside, rays above all of them are outside, and the rays between cross its cells: the closed form of
:mod:`walks` gives their lengths, for several rays at once.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from vizlight import _compiled

if TYPE_CHECKING:
    from vizlight._types import Array, Indices
    from vizlight.geometry.relief.height_field import Field


#: Smallest range of values that is divided into buckets.
LEAST = 1e-300


@_compiled.kernel()
def group(key: Indices, ends: Indices, order: Indices) -> None:
    """Write the order of rays by their integer keys, the first ray of each key, and the end."""
    for k in range(len(ends)):
        ends[k] = 0
    for k in range(len(key)):
        ends[key[k]] += 1
    total = 0
    for k in range(len(ends)):
        total += ends[k]
        ends[k] = total
    for k in range(len(key) - 1, -1, -1):
        ends[key[k]] -= 1
        order[ends[key[k]]] = k


@_compiled.kernel()
def sort(values: Array, key: Array, order: Indices, ends: Indices) -> float:
    """Write values in rising order, their old indices, and the first index of each bucket.

    There are as many buckets of equal width as values; return their number per unit of the values.
    Inside the buckets values are sorted by gaps that are less than the fullest of them.
    """
    count = len(values)
    low, high = math.inf, -math.inf
    for k in range(count):
        low, high = min(low, values[k]), max(high, values[k])
    rate = (count - 1) / (high - low) if high - low > LEAST else 0.0
    for bucket in range(count + 1):
        ends[bucket] = 0
    for k in range(count):
        ends[int((values[k] - low) * rate)] += 1
    total, fullest = 0, 0
    for bucket in range(count + 1):
        fullest = max(fullest, ends[bucket])
        total += ends[bucket]
        ends[bucket] = total
    for k in range(count - 1, -1, -1):
        bucket = int((values[k] - low) * rate)
        ends[bucket] -= 1
        order[ends[bucket]], key[ends[bucket]] = k, values[k]
    gap = 1
    while 3 * gap + 1 < fullest:
        gap = 3 * gap + 1
    while gap > 0:
        for k in range(gap, count):
            i, value, j = order[k], key[k], k
            while j >= gap and key[j - gap] > value:
                order[j], key[j] = order[j - gap], key[j - gap]
                j -= gap
            order[j], key[j] = i, value
        gap //= 3
    return rate


@_compiled.kernel(inline=True)
def below(key: Array, ends: Indices, rate: float, value: float) -> int:
    """Return how many of the values that :func:`sort` has written are less than another one."""
    count = len(key)
    if value <= key[0]:
        return 0
    if value > key[count - 1]:
        return count
    bucket = int((value - key[0]) * rate)
    low, high = int(ends[bucket]), int(ends[bucket + 1])
    while low < high:
        middle = (low + high) >> 1
        if key[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


Triple = tuple[float, float, float]
#: Heights, sides and columns at which rays start, and their lengths.
Rays = tuple["Array", "Array", "Array", "Array"]
#: Heights of the corners, edges of columns and 1 / widths, edges of rows and 1 / widths, and the
#: highest corner beyond the last column from each row on.
Grid = tuple["Array", "Array", "Array", "Array", "Array", "Array"]

#: Width of a strip, in mean rows of the field.
WIDTH = 4.0
#: Least horizontal share of a unit direction: steeper rays leave the relief soon.
ACROSS = 0.1
#: Least rise of a ray per unit of length.
RISE = 1e-6
#: Approximate number of rays in a band of strips, and largest number of columns of all strips per
#: ray.
BAND, COLUMNS_PER_RAY = 1 << 15, 12
#: Number of rays whose lengths in a cell are computed at once, the widest that processors have.
LANES = 8
#: Stands for 1 / 0 and for infinite rows; finite, so that a product with 0 is 0.
HUGE = 1e300


@_compiled.kernel(inline=True)
def positive(f0: float, f1: float, f2: float, end: float) -> float:
    """Return the length of the part of [0, end] where f0 + f1 s + f2 s^2 > 0, without branches."""
    square = f1 * f1 - 4 * f0 * f2
    # Both roots without cancellation; where f2 is 0 one of them is infinite. The sum makes -0 to 0.
    q = -0.5 * (f1 + math.copysign(math.sqrt(max(square, 0.0)), f1))
    one, other = min(max(f0 / q, 0.0), end), min(max(q / (f2 + 0.0), 0.0), end)
    between = abs(one - other)
    part = end - between if f2 >= 0 else between
    whole = end if max(f0, f0 + f2) > 0 else 0.0
    return whole if (square < 0) | (q == 0) else part


@_compiled.kernel()
def in_cell(
    side: Array, level: Array, begin: Array, count: int, sides: Triple,
    heights: tuple[float, float, float, float], per_column: float, way: Triple, width: float,
    length: Array,
) -> None:  # fmt: skip
    """Add the lengths of rays inside the solid in one cell of a column.

    ``side`` and ``level`` are position and height of the rays where the column begins, ``begin``
    the distances along it from which they count. ``sides`` are the two edges of the cell and the
    inverse of their distance; ``heights`` are z00, dz/du, dz/dv and d2z/du dv, u and v being the
    relative positions along the column and aside; ``way`` is the slope aside of a ray per unit of
    the column, its inverse, and its rise.
    """
    z, a, b, c = heights
    slope, inverse, rise = way
    low, high, per_row = sides
    dv = slope * per_row
    f2 = per_column * dv * c
    for k in range(count):
        enter = max(min((low - side[k]) * inverse, width), begin[k])
        leave = max(min((high - side[k]) * inverse, width), enter)
        u, v = enter * per_column, (side[k] + slope * enter - low) * per_row
        # In the level frame of the ray, height less level is a quadratic along the way in the
        # cell.
        f0 = (z - level[k] - rise * enter) + u * a + v * (b + u * c)
        f1 = per_column * (a + v * c) + dv * (b + u * c) - rise
        length[k] += positive(f0, f1, f2, leave - enter)


@_compiled.kernel(inline=True)
def rows_of(low: float, high: float, rows: Array, first: int, last: int) -> tuple[int, int]:
    """Return the nodes around a range of sides, found from others near them."""
    end = len(rows) - 1
    while first > 0 and rows[first] > low:
        first -= 1
    while first < end and rows[first + 1] <= low:
        first += 1
    last = max(last, first)
    while last > 0 and rows[last - 1] >= high:
        last -= 1
    while last < end and rows[last] < high:
        last += 1
    return first, last


@_compiled.kernel()
def fill(now: int, before: int, place: float, begin: Array, since: Array, length: Array) -> None:
    """Let the rays up to an index be inside from a column on, and no longer those after it.

    Rays that begin later are left as they are: their ``since`` is at or after their ``begin``.
    """
    # Levels are sorted, so the rays inside a column are the first ones: only the change is
    # handled.
    for k in range(before, now):
        since[k] = max(place, begin[k])
    for k in range(now, before):
        length[k] += max(place - since[k], 0.0)


@_compiled.kernel()
def cross(
    corners: Array, column: tuple[int, int, float, float, float], rows: Array, per_row: Array,
    row: int, way: Triple, some: tuple[int, int], rays: Rays, own: Rays, own_index: Indices,
) -> None:  # fmt: skip
    """Add the lengths of some rays in the cells of one column."""
    node, right, place, width, per_column = column
    slope, _, rise = way
    height, side, begin, length = rays
    own_level, own_side, own_begin, own_length = own
    count = 0
    for k in range(some[0], some[1]):
        own_index[count] = k
        count += 1 if begin[k] < place + width else 0
    if count == 0:
        return
    low, high = math.inf, -math.inf
    for n in range(count):
        k = own_index[n]
        # Near its start a ray is known best from there.
        # LANES rays at once, without branches: the compiler makes vector instructions of it.
        aside = side[k] + slope * (place - begin[k])
        low, high = min(low, aside), max(high, aside)
        own_side[n], own_level[n] = aside, height[k] + rise * (place - begin[k])
        own_begin[n] = max(begin[k] - place, 0.0)
    # Rays are handled several at a time: the last ones are repeated, without effect.
    padded = -(-count // LANES) * LANES
    for n in range(count, padded):
        own_side[n], own_level[n], own_begin[n] = own_side[0], own_level[0], own_begin[0]
    for n in range(padded):
        own_length[n] = 0.0
    end = len(rows) - 2
    # Rows that any of the rays meets in this column.
    while row < end and rows[row + 1] <= low:
        row += 1
    while row <= end and rows[row] <= high + slope * width:
        z, right_z = corners[row, node], corners[row, right]
        b = corners[row + 1, node] - z
        heights = z, right_z - z, b, (corners[row + 1, right] - right_z) - b
        sides = max(rows[row], -HUGE), min(rows[row + 1], HUGE), per_row[row]
        in_cell(
            own_side, own_level, own_begin, padded, sides, heights, per_column, way, width,
            own_length,
        )  # fmt: skip
        row += 1
    for n in range(count):
        length[own_index[n]] += own_length[n]


@_compiled.kernel()
def follow(
    grid: Grid, way: Triple, slack: float, aside: tuple[float, float], rays: Rays, level: Array,
    since: Array, buckets: tuple[Indices, float], own: Rays, own_index: Indices,
) -> None:  # fmt: skip
    """Add the lengths, along the columns, of the sorted rays of one strip.

    ``aside`` is the range of the sides of the rays at column 0.
    """
    corners, columns, per_column, rows, per_row, ahead = grid
    _, _, begin, length = rays
    ends, rate = buckets
    slope, _, rise = way
    last, inner = len(columns) - 1, corners.shape[1] - 1
    first = last
    for k in range(len(level)):
        # The first column that a ray of the strip begins in.
        while first > 0 and columns[first] > begin[k]:
            first -= 1
    inside, from_row, to_row, row = 0, 0, 0, 0
    high, low = -math.inf, math.inf
    for c in range(first, last + 1):
        row = from_row
        from_row, to_row = rows_of(
            aside[0] + slope * columns[max(c - 1, 0)],
            aside[1] + slope * columns[min(c + 1, last)], rows, from_row, to_row,
        )  # fmt: skip
        # Highest and lowest node that the strip covers here, in the frame in which rays are level.
        up, down = -math.inf, math.inf
        for r in range(from_row, to_row + 1):
            height = corners[r, min(c, inner)]
            up, down = max(up, height), min(down, height)
        up, down = up - rise * columns[c], down - rise * columns[c]
        if c > first:
            # The column between this line of nodes and the one before it.
            place, node = columns[c - 1], min(c - 1, inner)
            # Below all nodes by more than rounding: inside. Above all: outside. Between: cells are
            # crossed.
            now = below(level, ends, rate, min(down, low) - slack)
            to = below(level, ends, rate, max(up, high) + slack)
            fill(now, inside, place, begin, since, length)
            inside = now
            if to > now:
                right = node + (1 if per_column[c - 1] > 0 else 0)
                column = node, right, place, columns[c] - place, per_column[c - 1]
                cross(
                    corners, column, rows, per_row, min(row, from_row), way, (now, to), rays, own,
                    own_index,
                )  # fmt: skip
            # Beyond the last node heights change no more: once the lowest ray is above them all
            # are out.
            if c >= inner - 1 and ahead[from_row] - rise * columns[c] + slack <= level[0]:
                last = c
                break
        high, low = up, down
    fill(0, inside, columns[last], begin, since, length)


@_compiled.kernel(seconds=4.2)
def lengths(
    grid: Grid, way: Triple, per_step: float, slack: float, spacing: float, start: Array,
    rays: Indices, out: Array,
) -> None:  # fmt: skip
    """Write the lengths of rays that start at (3, N) to their places in the result.

    ``per_step`` is the length of a ray per unit of the columns, ``spacing`` the width of a strip.
    """
    slope, _, rise = way
    x, y, z = start[0], start[1], start[2]
    least, largest = math.inf, -math.inf
    for k in range(len(rays)):
        # A ray's offset across the light's direction tells its strip; it is the same all along the
        # ray.
        aside = y[k] - slope * x[k]
        least, largest = min(least, aside), max(largest, aside)
    strip: Indices = np.empty(len(rays), np.int32)
    for k in range(len(rays)):
        strip[k] = int((y[k] - slope * x[k] - least) / spacing)
    strips = int((largest - least) / spacing) + 1
    ends: Indices = np.empty(strips + 1, np.int64)
    order: Indices = np.empty(len(rays), np.int32)
    found = np.empty(len(rays))
    group(strip, ends, order)
    most = 0
    for one in range(strips):
        most = max(most, ends[one + 1] - ends[one])
    keys, level = np.empty(most), np.empty(most)
    height, side = np.empty(most), np.empty(most)
    begin, length, since = np.empty(most), np.empty(most), np.empty(most)
    own_level, own_side = np.empty(most + LANES), np.empty(most + LANES)
    own_begin, own_length = np.empty(most + LANES), np.empty(most + LANES)
    own = own_level, own_side, own_begin, own_length
    index: Indices = np.empty(most, np.int32)
    buckets: Indices = np.empty(most + 1, np.int32)
    own_index: Indices = np.empty(most + 1, np.int32)
    for one in range(strips):
        at, count = ends[one], ends[one + 1] - ends[one]
        if count == 0:
            continue
        for k in range(count):
            i = order[at + k]
            # The level of a ray where the columns begin: with the rise taken off it is constant.
            keys[k] = z[i] - rise * x[i]
        # Buckets make the search for a level one step for the usual, even spread.
        rate = sort(keys[:count], level[:count], index, buckets)
        low, high = math.inf, -math.inf
        for k in range(count):
            i = order[at + index[k]]
            aside = y[i] - slope * x[i]
            low, high = min(low, aside), max(high, aside)
            height[k], side[k], length[k] = z[i], y[i], 0.0
            begin[k] = since[k] = x[i]
        some = height[:count], side[:count], begin[:count], length[:count]
        follow(
            grid,
            way,
            slack,
            (low, high),
            some,
            level[:count],
            since[:count],
            (buckets, rate),
            own,
            own_index,
        )
        for k in range(count):
            found[order[at + index[k]]] = per_step * length[k]
    for k in range(len(rays)):
        out[rays[k]] = found[k]


@_compiled.kernel()
def inset(
    rays: Indices, x: Array, y: Array, heights: Array, normals: Array, depth: float, out: Array
) -> None:
    """Write the positions, shape (3, N), of nodes that are moved against their normals."""
    one, other, third = out[0], out[1], out[2]
    columns = len(x)
    for k in range(len(rays)):
        at = rays[k]
        row = at // columns
        one[k] = x[at - row * columns] - depth * normals[3 * at]
        other[k] = y[row] - depth * normals[3 * at + 1]
        third[k] = heights[at] - depth * normals[3 * at + 2]


class Strips:
    """A field along the azimuth of one light, for rays that start at a distance ``below`` from it.

    Positions are (along the light's main axis, along the other one, height), both axes in the
    direction of the light.

    A ray takes 0.2 to 0.6 microseconds of processor time over 1024 x 1024 nodes with the sun from
    40 to 5 degrees high. The time of a field grows by more than 4 for each doubling of its side,
    since on rough hills the number of crossings per ray grows with the resolution.
    """

    def __init__(self, field: Field, way: Array, below: float) -> None:
        nodes = [field.x, field.y]
        size = [abs(way[a]) / np.mean(np.diff(nodes[a])) for a in (0, 1)]
        self.main, self.side = (0, 1) if size[0] >= size[1] else (1, 0)
        self.signs = [1.0 if way[a] >= 0 else -1.0 for a in (self.main, self.side)]
        self.per_step = 1 / abs(float(way[self.main]))
        self.slope = abs(float(way[self.side])) * self.per_step
        self.rise = float(way[2]) * self.per_step
        corners = field.corners if self.main == 0 else field.corners.T
        # Mirrored so that the light goes toward rising columns and rows: one case in place of
        # eight.
        corners = np.ascontiguousarray(corners[:: int(self.signs[1]), :: int(self.signs[0])])
        columns = np.sort(self.signs[0] * nodes[self.main])
        rows = np.sort(self.signs[1] * field.edges[self.side])
        before, after = self._beyond(columns, rows[1:-1], field.top, below)
        self.columns = np.concatenate([[before], columns, after])
        per_column = 1 / np.diff(self.columns)
        # Beyond the border heights change from row to row alone.
        per_column[0] = 0
        per_column[len(columns) :] = 0
        # The highest of the nodes beyond the last column from each row on.
        ahead = np.maximum.accumulate(corners[::-1, -1])[::-1].copy()
        self.grid = corners, self.columns, per_column, rows, 1 / np.diff(rows), ahead

        self.spacing = WIDTH * (rows[-2] - rows[1]) / (len(rows) - 3)
        self.first = rows[1] - below - self.slope * (columns[-1] + below) - self.spacing
        most = rows[-2] + below - self.slope * (columns[0] - below)
        self.count = int((most - self.first) / self.spacing) + 2
        # Levels are rounded, so bounds are a little wider.
        reach = float(np.abs(self.columns).max())
        # 16 eps of the largest number that enters a level.
        self.slack = 16 * np.finfo(float).eps * float(field.top + self.rise * reach)

    def _beyond(
        self, columns: Array, rows: Array, relief: float, below: float
    ) -> tuple[float, Array]:
        """Return edges of columns beyond the border, as far as a ray is below the highest level."""
        step, far = float(np.mean(np.diff(columns))), (relief + below) / self.rise
        last = columns[-1] + below + far
        if self.slope:
            far = min(far, (float(np.ptp(rows)) + 2 * below) / self.slope)
        # There heights change from row to row alone: one column per row is enough.
        stride = max(far / len(rows), step)
        after = columns[-1] + stride * np.arange(1, int(np.ceil(far / stride)) + 1)
        end = max(last, after[-1]) + 2 * stride
        return columns[0] - below - step, np.append(after, end)

    def turned(self, start: Array) -> Array:
        """Return positions (3, N) along the axes of the strips."""
        return np.stack(
            [self.signs[0] * start[self.main], self.signs[1] * start[self.side], start[2]]
        )

    def band(self, start: Array, width: int) -> Indices:
        """Return the index of a band of ``width`` strips at each position (3, N)."""
        along, aside = self.signs[0] * start[self.main], self.signs[1] * start[self.side]
        share = (aside - self.slope * along - self.first) / (width * self.spacing)
        found: Indices = share.astype(np.int32)
        return found

    def width(self, rays: int) -> int:
        """Return the number of strips per band for a total number of rays."""
        return max(1, BAND * self.count // max(rays, 1))

    def order(self, band: Indices, width: int) -> tuple[Indices, Indices]:
        """Return the order of rays by bands, and the first ray of each band and the end.

        The rays of a band keep their order, so that their data are read in long pieces.
        """
        ends = np.empty(self.count // width + 2, np.int64)
        short = np.int32 if len(band) < 1 << 31 else np.int64
        order: Indices = np.empty(len(band), short)
        group(band, ends, order)
        return order, np.unique(ends)

    def write(self, start: Array, rays: Indices, length: Array) -> None:
        """Write the lengths inside the solid of some rays, which start at (3, N)."""
        way = self.slope, 1 / max(self.slope, 1 / HUGE), self.rise
        lengths(
            self.grid, way, self.per_step, self.slack, self.spacing, self.turned(start), rays,
            length,
        )  # fmt: skip


def strips(field: Field, way: Array, below: float, count: int) -> Strips | None:
    """Return the strips of a field for a number of rays, or None where they do not apply."""
    if field.border != "extend" or way[2] <= 0:
        return None
    across = float(np.hypot(way[0], way[1]))
    if across < ACROSS or way[2] < RISE * across:
        return None
    made = Strips(field, way, below)
    return made if made.count * len(made.columns) <= COLUMNS_PER_RAY * count else None
