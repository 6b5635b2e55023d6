"""Random trees of solids with degenerate positions, and what must hold for each of them."""

import banded
import numpy as np

from vizlight.geometry import solids
from vizlight.geometry.contours import refinement
from vizlight.geometry.solids import tessellation
from vizlight.geometry.solids.primitives import Block, Frustum, Sphere

TOWARD = np.array([1.0, -0.6, 0.8]) / np.linalg.norm([1.0, -0.6, 0.8])


def lambert(points, normals):
    return 0.1 + 0.9 * np.maximum(normals @ TOWARD, 0)


def rotation(random):
    """Return a random rotation matrix."""
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    return turn * np.linalg.det(turn)


def combined(random, parts):
    """Combine parts one after the other by random operations."""
    solid = parts[0]
    for part in parts[1:]:
        solid = (solid | part, solid & part, solid - part, part | solid)[random.integers(4)]
    return solid


def grid_part(random, turn=None):
    """Return a primitive with faces and axes on a grid of half units, some moved by 1e-6."""
    turn = np.eye(3) if turn is None else turn
    center = random.integers(-2, 3, 3) / 2 + 1e-6 * random.integers(-1, 2, 3) * random.integers(2)
    axis = np.eye(3)[random.integers(3)] * random.choice([-1, 1])
    a, b = random.choice([0.5, 1.0], 2)
    height = random.integers(1, 5) / 2
    size = random.integers(1, 4, 3) / 2
    center, axis = center @ turn, axis @ turn
    return (
        Sphere(center, a), Block(center, size, axes=turn),
        Frustum(center, axis, (a, a), height=height),
        Frustum(center, axis, (0, a), height=height),
        Frustum(center, axis, (a, b), height=height),
    )[random.integers(5)]  # fmt: skip


def free_part(random):
    """Return a primitive of any position, size and orientation."""
    center, axis = random.uniform(-1, 1, 3), random.standard_normal(3)
    a, b = random.uniform(0.2, 0.9, 2)
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    return (
        Sphere(center, a), Block(center, random.uniform(0.5, 1.6, 3), axes=turn),
        Frustum(center, axis, (a, a), height=b), Frustum(center, axis, (0, a), height=2 * b),
        Frustum(center, axis, (a, b), height=1),
    )[random.integers(5)]  # fmt: skip


def grid(random):
    """Return parts on a grid of half units."""
    return combined(random, [grid_part(random) for _ in range(random.integers(2, 8))])


def free(random):
    """Return parts of any position."""
    return combined(random, [free_part(random) for _ in range(random.integers(2, 8))])


def turned(random):
    """Return parts on a rotated grid, whose faces coincide to rounding only."""
    turn = rotation(random)
    return combined(random, [grid_part(random, turn) for _ in range(random.integers(2, 8))])


def tangent(random):
    """Return spheres of which each touches the one before, from outside or inside."""
    radius = random.uniform(0.3, 1)
    center, solid = np.zeros(3), Sphere(radius=radius)
    for _ in range(random.integers(1, 6)):
        way = rotation(random)[0]
        other = random.uniform(0.2, 0.9) * radius
        inside = random.integers(2)
        center = center + way * (radius - other if inside else radius + other)
        part, radius = Sphere(center, other), other
        solid = (solid | part, solid - part, part | solid)[random.integers(3)]
    return solid


def crossing(random):
    """Return cylinders of equal radius through one point, at angles of 15 to 90 degrees."""
    turn, radius, parts = rotation(random), random.uniform(0.2, 0.6), []
    for _ in range(random.integers(2, 4)):
        angle = np.pi / 12 * random.integers(1, 7) * len(parts)
        axis = np.array([np.cos(angle), np.sin(angle), 0]) @ turn
        parts.append(Frustum((0, 0, 0), axis, (radius, radius), height=random.uniform(1.5, 3)))
    return combined(random, parts)


def coaxial(random):
    """Return frusta about one axis that share ends and radii."""
    axis = rotation(random)[0]
    parts = []
    for _ in range(random.integers(2, 7)):
        low, high = np.sort(random.choice(np.arange(-4, 5), 2, replace=False)) / 4
        radii = random.choice([0.25, 0.5, 0.75, 1.0], 2)
        if random.integers(2):
            radii[1] = radii[0]
        parts.append(Frustum((low + high) / 2 * axis, axis, radii, height=high - low))
    return combined(random, parts)


def shifted(random):
    """Return copies of one part that are moved by 1e-6, 1e-9 or not at all."""
    part = (grid_part, free_part)[random.integers(2)](random)
    copies = [part]
    for _ in range(random.integers(1, 4)):
        copies.append(moved(part, random.choice([0, 1e-9, 1e-6]) * rotation(random)[0]))
    return combined(random, [*copies, free_part(random)])


def moved(part, offset):
    return part.moved(-offset, 1.0)


def drilled(random):
    """Return a plate with up to 30 holes that may touch or overlap."""
    solid = Block(size=(2, 2, random.uniform(0.05, 0.6)))
    for _ in range(random.integers(4, 31)):
        place = (*random.integers(-8, 9, 2) / 8, 0.0)
        radius = random.choice([0.0625, 0.08, 0.125])
        solid = solid - Frustum(place, (0, 0, 2), (radius, radius))
    return solid


def thin(random):
    """Return a shell, tube or box with walls of 0.1 to 1e-4, concentric or not."""
    wall = 10 ** random.uniform(-4, -1)
    center = random.uniform(-1, 1, 3) * random.integers(2) * wall / 2
    axis = rotation(random)[0]
    ends = (1 - wall, 1 - wall)
    other = random.uniform(0.3, 0.9)
    kind = random.integers(5)
    if kind == 0:
        return Sphere() - Sphere(center, 1 - wall)
    if kind == 1:
        return Frustum(axis=axis, radii=(1, 1)) - Frustum(
            np.linalg.norm(center) * np.cross(axis, rotation(random)[0]), 2 * axis, ends
        )
    if kind == 2:
        return Block() - Block(center, np.full(3, 1 - 2 * wall))
    if kind == 3:
        return Frustum(axis=axis, radii=(1, other)) - Frustum(
            axis=axis, radii=(1 - wall, other - wall)
        )
    return Block() - Frustum(center, (0, 0, 2), (wall, wall))


def deep(random):
    """Return many small parts joined and taken away."""
    solid = Block(size=(2, 2, 2))
    for _ in range(random.integers(15, 40)):
        center = random.uniform(-1, 1, 3)
        radius = random.uniform(0.1, 0.4)
        part = (
            Sphere(center, radius), Block(center, np.full(3, radius), axes=rotation(random)),
            Frustum(center, random.standard_normal(3), (radius, radius / 2), height=1),
        )[random.integers(3)]  # fmt: skip
        solid = solid | part if random.integers(2) else solid - part
    return solid


KINDS = {
    f.__name__: f
    for f in (grid, free, turned, tangent, crossing, coaxial, shifted, drilled, thin, deep)
}


def tree(kind, seed, series=1990):
    """Return one random tree."""
    return KINDS[kind](np.random.default_rng([series, list(KINDS).index(kind), seed]))


def sampled_volume(solid, random, count):
    """Return the volume by points inside, and its standard deviation."""
    boxes = [part.box() for part in solid.primitives() if not part.empty]
    low = np.min([center - radius for center, radius in boxes], axis=0)
    high = np.max([center + radius for center, radius in boxes], axis=0)
    share = solid.contains(random.uniform(low, high, (count, 3))).mean()
    whole = float(np.prod(high - low))
    return share * whole, np.sqrt(max(share * (1 - share), 1 / count) / count) * whole


def problems(solid, *, tolerance=3e-3, count=100_000, levels=8, seed=0):
    """Return what is wrong with the mesh and the bands of a solid, and its mesh."""
    random = np.random.default_rng(seed)
    found = []
    mesh = solids.tessellate(solid, tolerance=tolerance)
    first, after = mesh.triangles, np.roll(mesh.triangles, -1, axis=1)
    forth, back = first * len(mesh.points) + after, after * len(mesh.points) + first
    if len(np.unique(forth)) != forth.size or not np.array_equal(np.unique(forth), np.unique(back)):
        found.append("open")
    volume = mesh.volume * mesh.scale**3
    expected, sigma = sampled_volume(solid, random, count)
    if abs(volume - expected) > 4.5 * sigma + 1e-2 * volume:
        found.append(f"volume {volume:.6g}, sampled {expected:.6g} +- {sigma:.2g}")
    error = mesh.volume_error * mesh.scale**3
    if abs(volume - expected) > error + 4.5 * sigma:
        found.append(f"bound {error:.3g}: volume {volume:.6g}, sampled {expected:.6g}")
    flips = int(np.count_nonzero(tessellation.flipped(mesh)))
    if flips:
        found.append(f"{flips} of {len(mesh.triangles)} flipped")
    if levels and len(mesh.triangles):
        bands = refinement.draw(mesh, lambert, levels, low=0.1)
        if not banded.is_closed(bands):
            found.append("open bands")
        if bands.error > 1.1 * bands.steps.error:
            found.append(f"error of {bands.error / bands.steps.error:.3f} half steps")
    return found, mesh
