"""Height fields, places on them, directions to the sun; swatches; cells of several kinds."""

import numpy as np
import pyvista as pv

from vizlight.geometry.relief import height_field, shadowing

X, Y = np.arange(9.0) * 0.5 + 2, np.arange(7.0) * 0.25 - 1


def sun(elevation, azimuth):
    """Return a direction from angles in degrees, azimuth from x toward y."""
    e, a = np.radians([elevation, azimuth])
    return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])


def hills(n=60, ny=None, seed=3, size=10.0):
    """Return a smooth random field on uneven nodes."""
    random = np.random.default_rng(seed)
    x = np.sort(np.append(random.uniform(0, size, n - 2), [0, size]))
    y = np.sort(np.append(random.uniform(0, size, (ny or n) - 2), [0, size]))
    z = np.zeros((len(y), len(x)))
    for _ in range(12):
        a, b = random.uniform(0, size, 2)
        z += random.uniform(0.2, 1) * np.exp(-((x - a) ** 2 + (y[:, None] - b) ** 2))
    return x, y, z


def places(x, y, z, count, random, below=0.4):
    i, j = random.integers(0, len(x), count), random.integers(0, len(y), count)
    jitter = random.uniform(-0.3, 0.3, (count, 2))
    return np.column_stack([x[i], y[j], z[j, i] - random.uniform(0, below, count)]) + np.pad(
        jitter, [(0, 0), (0, 1)]
    )


def bumps(x, y):
    return 0.3 * np.sin(2 * x) * np.cos(3 * y)


Z = bumps(X, Y[:, None])


def grids():
    image = pv.ImageData(dimensions=(9, 7, 1), spacing=(0.5, 0.25, 1), origin=(2, -1, 5))
    image["height"] = Z.ravel().copy()
    rectilinear = pv.RectilinearGrid(X, Y, [5.0])
    rectilinear["height"] = Z.ravel().copy()
    x, y = np.meshgrid(X, Y, indexing="ij")
    warped = pv.StructuredGrid(x, y, bumps(x, y))
    turned = pv.StructuredGrid(x.T[::-1], y.T[::-1], bumps(x, y).T[::-1])
    flat = pv.StructuredGrid(x, y, 0 * x)
    flat["height"] = bumps(x, y).ravel(order="F")
    return {
        "ImageData": (image, {}),
        "RectilinearGrid": (rectilinear, {"elevation": "height"}),
        "warped": (warped, {}),
        "turned": (turned, {}),
        "flat": (flat, {"elevation": "height"}),
    }


def level(**changes):
    """Return a flat field of 4 x 4 points."""
    grid = pv.ImageData(dimensions=(4, 4, 1))
    grid["height"] = np.zeros(16)
    for name, value in changes.items():
        grid[name] = value
    return grid


def by_cells(field, start, way):
    """Return lengths by NumPy, through every cell."""
    largest, least, _, columns = field.bounds
    size = field.corners[1:, 1:].size
    # The last bound is that of the whole field, above which no ray is followed.
    bounds = height_field.Bounds(
        np.append(largest[:size], largest[-1]), least[:size], np.zeros(1, int), columns[:1]
    )
    return followed(shadowing.march, field, start, way, bounds)


def followed(follow, field, start, way, bounds=None):
    """Return lengths of parallel rays by one of the two codes."""
    count = start.shape[1]
    found, ways = np.empty(count), np.repeat(way[:, None], count, axis=1)
    follow(
        start, ways, np.full(count, shadowing.FAR), *field.edges, field.corners,
        field.bounds if bounds is None else bounds, field.border == "wall", found,
    )  # fmt: skip
    return found


def swatches(rows=6, columns=8):
    """Return a square for each of many colours, on which far light is the same everywhere."""
    squares = [
        pv.Plane(center=(x, y, 0), i_resolution=1, j_resolution=1)
        for y in range(rows)
        for x in range(columns)
    ]
    mesh = pv.merge(squares, merge_points=False)
    mesh.clear_data()
    mesh["value"] = np.repeat(np.linspace(0, 1, rows * columns), 4)
    return mesh


def half_known():
    """Return a square: left tangents along y and heights, right tangents of zero; NaN above."""
    mesh = pv.Plane(i_resolution=20, j_resolution=20)
    mesh.clear_data()
    x, y, _ = np.asarray(mesh.points, dtype=float).T
    mesh["V"] = np.stack([0 * x, (x <= 0.05) * 1.0, 0 * x], axis=1)
    mesh["height"] = np.where(y <= 0.05, x + y, np.nan)
    return mesh


def step(length=4):
    """Return a step of a length: a prism whose section is an L."""
    corners = [[0, 0, 0], [length, 0, 0], [length, 1, 0], [2, 1, 0], [2, 3, 0], [0, 3, 0]]
    section = pv.PolyData(np.array(corners, float), faces=[6, 0, 1, 2, 3, 4, 5])
    return section.triangulate().extrude((0, 0, 3), capping=True).triangulate().clean()


def several_kinds(fine=8):
    """Return faces, a line that starts on them and vertices in one mesh, and each by itself."""
    ball = pv.Sphere(theta_resolution=fine, phi_resolution=fine)
    faces = pv.PolyData(ball.points, faces=ball.faces)
    t = np.linspace(0, 1, 10 * fine)[:, None]
    start = faces.points[-1].astype(np.float64)
    around = np.hstack([np.sin(12 * t), 1 - np.cos(12 * t), t - 0.3 * t**2])
    lines = pv.MultipleLines(start + 0.5 * around)
    vertices = pv.PolyData(start + np.array([[0.5, -0.6, -0.2], [-0.6, 0.5, 0.3], [0.2, 1.3, -1]]))
    points = np.concatenate([faces.points, lines.points[1:], vertices.points])
    mixed, own, count = pv.PolyData(points, faces=faces.faces), faces.n_points - 1, lines.n_points
    mixed.SetLines(pv.CellArray(np.r_[count, own + np.arange(count)]))
    mixed.SetVerts(pv.CellArray(np.c_[np.ones(3, int), own + count + np.arange(3)].ravel()))
    return mixed, (faces, lines, vertices)
