"""A grid that is read part by part has the normals and the sides of the grid read as a whole."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista as pv

from vizlight import View
from vizlight.reading import grids, normals


def curved(u, v, w, to_space, kind=np.float32):
    axes = np.meshgrid(u, v, w, indexing="ij")
    return pv.StructuredGrid(*(x.astype(kind) for x in to_space(*axes)))


def line(n):
    return np.linspace(-1, 1, n)


def circle(n, more=0):
    """Angles around a circle; the last one is the first, as are as many ``more``."""
    angles = np.linspace(0, 2 * np.pi, n)
    return np.concatenate([angles[:-1], angles[: more + 1]])


def sheet():
    mesh = curved(line(30), line(40), [0], lambda u, v, w: (u, v, w + np.sin(3 * u) * v))
    mesh.points[[0, 1, 2, 600]] = np.nan
    return mesh


def stairs():
    return curved(line(30), line(40), [0], lambda u, v, w: (u, v, w + np.floor(1.6 * u + v) / 3))


def ring(more=0, depth=1):
    """A wrapped grid, whose first and last columns coincide."""
    a, r, z = circle(40, more), np.linspace(1, 2, depth), line(20)
    return curved(a, r, z, lambda a, r, z: (r * np.cos(a), r * np.sin(a), z), np.float64)


def ball():
    def to_space(a, b, w):
        sine = np.where(b < 3.1, np.sin(b), 0)
        return sine * np.cos(a), sine * np.sin(a), w + np.cos(b)

    return curved(circle(30), np.linspace(0, np.pi, 20), [0], to_space)


def torus():
    """A grid that overlaps itself along both axes, so that no border is free."""

    def to_space(a, b, w):
        return (2 + np.cos(b)) * np.cos(a), (2 + np.cos(b)) * np.sin(a), w + np.sin(b)

    return curved(circle(30, 1), circle(20, 1), [0], to_space)


def slit():
    """A sheet one border of which is folded onto itself."""
    return curved(line(41), line(20), [0], lambda u, v, w: (np.abs(u) + v + w, u * (v + 1), v))


GRIDS = {
    "sheet": (sheet, True),
    "stairs": (stairs, True),
    "ring": (ring, True),
    "overlapping ring": (lambda: ring(more=1), True),
    "slit": (slit, True),
    "overlapping torus": (torus, False),
    "ball": (ball, False),
    "thick ring": (lambda: ring(depth=3), False),
    "box": (lambda: curved(line(9), line(8), line(12), lambda u, v, w: (u, v + u * w, w)), False),
    "slab": (lambda: pv.ImageData(dimensions=(40, 2, 30), spacing=(1, 2, 3)), False),
    "image": (lambda: pv.ImageData(dimensions=(1, 40, 30), origin=(5e5, 4e6, 0)), True),
    "rectilinear": (lambda: pv.RectilinearGrid(line(30) ** 3, [2.0], line(20)), True),
}


@pytest.fixture
def small_parts(monkeypatch):
    def apply(part=50):
        monkeypatch.setattr(grids, "PART", part)
        monkeypatch.setattr(grids, "FEW", 0)

    return apply


@pytest.mark.parametrize("name", GRIDS)
@pytest.mark.parametrize(
    "view", [None, View(direction=(1, 2, 3)), View(position=(2, 3, -4))], ids=["", "far", "near"]
)
def test_parts_give_the_normals_of_the_whole(name, view, small_parts):
    make, is_open = GRIDS[name]
    mesh = make()
    assert not grids.in_parts(mesh)
    whole = normals.computed_normals(mesh, view=view)
    small_parts()
    assert grids.in_parts(mesh)
    assert len(list(grids.parts(mesh))) > 5
    found = normals.computed_normals(mesh, view=view)
    np.testing.assert_array_equal(found.vectors, whole.vectors)
    np.testing.assert_array_equal(found.lean, whole.lean)
    assert (found.sharp, found.inside) == (whole.sharp, int(whole.inside))
    assert (found.open > 0) is is_open
    assert np.any(whole.open) == is_open


@pytest.mark.parametrize("name", GRIDS)
def test_parts_give_given_normals_the_sides_of_the_whole(name, small_parts):
    mesh = GRIDS[name][0]()
    given = (np.asarray(mesh.points) - mesh.center) @ np.array([[1, 0, 0], [0, 1, 0], [0.1, 0, 1]])
    for own in (given, -given):
        grids_read = []
        for part in (10_000, 50):
            small_parts(part)
            grids_read.append(normals.sided_normals(mesh, own, 3, "auto"))
        whole, found = grids_read
        np.testing.assert_array_equal(found.vectors, whole.vectors)
        np.testing.assert_array_equal(np.broadcast_to(found.open, len(own)), whole.open)
        np.testing.assert_allclose(found.facts(), whole.facts(), atol=1e-6)


def test_a_part_has_the_faces_around_its_own_points():
    mesh = pv.ImageData(dimensions=(200, 300, 1))
    own = [part.origin[part.side == 0] for part in grids.parts(mesh)]
    assert len(own) > 2
    np.testing.assert_array_equal(np.sort(np.concatenate(own)), np.arange(mesh.n_points))
    assert all(part.surface.GetNumberOfPoints() < 1.2 * grids.PART for part in grids.parts(mesh))


def test_hidden_cells_and_thick_grids_are_read_as_a_whole():
    mesh = pv.ImageData(dimensions=(200, 300, 1))
    assert grids.in_parts(mesh)
    assert not grids.in_parts(pv.ImageData(dimensions=(60_000, 1, 1)))
    assert not grids.in_parts(pv.ImageData(dimensions=(110, 110, 110)))
    mesh.cell_data["vtkGhostType"] = np.zeros(mesh.n_cells, np.uint8)
    assert not grids.in_parts(mesh)
