"""Cartoons of proteins: kinds told by ideal places, and closed surfaces swept along them."""

import numpy as np
import pytest

from vizlight.reading import ribbons

N = 16


def helix(count=N):
    """Return places on an ideal alpha helix: 100 degrees and 1.5 angstroms for each residue."""
    turn = np.radians(100) * np.arange(count)
    return np.column_stack([2.3 * np.cos(turn), 2.3 * np.sin(turn), 1.5 * np.arange(count)])


def sheet(strands=2, count=N):
    """Return places on ideal strands 4.8 angstroms apart: a zigzag of 3.3 angstroms a residue."""
    i = np.arange(count)
    one = np.column_stack([3.3 * i, 0 * i, 0.9 * (-1.0) ** i])
    return np.concatenate([one + np.array([0, 4.8 * k, 0]) for k in range(strands)])


def test_ideal_helices_and_strands_are_told():
    piece = np.zeros(N, dtype=int)
    kinds = ribbons.structure(helix(), piece)
    assert kinds[1:-3].tolist() == [ribbons.HELIX] * (N - 4)
    # Neither a turn nor two that meet are one.
    parts = np.arange(N) // 4
    assert not ribbons.structure(helix(), parts).any()
    assert not ribbons.structure(helix(5), piece[:5]).any()
    kinds = ribbons.structure(sheet(), np.repeat([0, 1], N))
    assert kinds.reshape(2, N)[:, 1:-3].tolist() == [[ribbons.STRAND] * (N - 4)] * 2
    # A strand has others beside it.
    assert not ribbons.structure(sheet(1), piece).any()
    assert not ribbons.structure(helix(3), piece[:3]).any()


def swept(places, kinds, piece, oxygens=None, *, fine=True):
    oxygens = np.full(places.shape, np.nan) if oxygens is None else oxygens
    across = ribbons.sides(places, oxygens, piece)
    radii = np.full(len(places), 0.4)
    return ribbons.swept(places, across, kinds, piece, radii, fine=fine)


CASES = {
    "helix": (helix(), ribbons.HELIX, [0] * N),
    "sheet": (sheet(), ribbons.STRAND, [0] * N + [1] * N),
    "straight": (np.outer(np.arange(6), (0, 3.8, 0)), ribbons.STRAND, [0, 0, 1, 1, 1, 1]),
}


@pytest.mark.parametrize("fine", [True, False])
@pytest.mark.parametrize("name", CASES)
def test_a_surface_is_closed_with_outward_normals(name, fine):
    places, kind, piece = CASES[name]
    kinds, piece = np.full(len(places), kind), np.array(piece)
    surface, at = swept(places, kinds, piece, fine=fine)
    assert surface.is_manifold
    assert surface.n_open_edges == 0
    assert len({*surface.connectivity()["RegionId"]}) == piece[-1] + 1
    assert (at.min(), at.max()) == (0, len(places) - 1)
    # The volume inside of faces that turn outward is positive.
    corners = surface.points[surface.regular_faces].astype(float)
    assert np.linalg.det(corners).sum() > 0
    normals = surface.point_data["Normals"]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-5)
    area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(area, axis=1)
    towards = np.einsum("ij,ij->i", area, normals[surface.regular_faces].mean(axis=1))
    big = length > 1e-3 * length.max()
    # But for the flat back of an arrow they are those of the faces, as far as these are small.
    assert np.mean(towards[big] > (0.8 if fine else 0.6) * length[big]) > 0.95
    assert (towards[big] > 0).mean() > 0.98


def test_ribbons_lie_along_helices_and_in_sheets():
    piece = np.zeros(N, dtype=int)
    surface, at = swept(helix(), np.full(N, ribbons.HELIX), piece)
    middle = (at > 5) & (at < 10)
    points, normals = surface.points[middle], surface.point_data["Normals"][middle]
    np.testing.assert_allclose(np.hypot(*points[:, :2].T), 2.3, atol=0.45)
    flat = np.abs(np.hypot(*points[:, :2].T) - 2.3) > 0.2
    radial = points[flat, :2] / np.hypot(*points[flat, :2].T)[:, None]
    assert (np.abs((radial * normals[flat, :2]).sum(axis=1)) > 0.9).all()
    # Oxygens along the axis tell the same.
    other, _ = swept(helix(), np.full(N, ribbons.HELIX), piece, helix() + np.array([0, 0, 2.4]))
    np.testing.assert_allclose(other.points[middle], points, atol=0.5)

    places = sheet(1)
    in_turn = np.where(np.arange(N) % 2, 1, -1)[:, None] * [0, 2.4, 0]
    for oxygens in (None, places + in_turn):
        surface, at = swept(places, np.full(N, ribbons.STRAND), piece, oxygens)
        x, y, z = surface.points[(at > 5) & (at < 10)].T
        # Smooth, flat, and as wide as a ribbon.
        assert np.abs(z).max() < 0.3
        assert np.abs(y).max() == pytest.approx(1.1, abs=0.02)
        # Its head is at the last step before the end.
        x, y, _ = surface.points.T
        head = 3.3 * (N - 3)
        assert x[np.abs(y) > 1.5].min() == pytest.approx(head, abs=0.1)
        assert np.abs(y[x > head + 3.4]).max() < 0.45
