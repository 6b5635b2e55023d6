"""Cartoons of proteins: their helices and strands, and ribbons swept along the backbone."""

from __future__ import annotations

import numpy as np
import pyvista as pv
import scipy

from vizlight._types import Array, Bools, Indices

#: Kinds of secondary structure: none of the others, a helix, a strand of a sheet.
LOOP, HELIX, STRAND = 0, 1, 2
#: Their names, and colours of which that of loops stands back.
NAMES = "loop", "helix", "strand"
COLORS = (0.78, 0.78, 0.76), (0.82, 0.26, 0.33), (0.22, 0.47, 0.72)
#: Distances in angstroms of a carbon from the second, third and fourth after it, the angle of three
#: and the torsion of four in degrees, each with its tolerance (P-SEA).
_SHAPES = {
    HELIX: ((5.5, 0.5), (5.3, 0.5), (6.4, 0.6), (89, 12), (50, 20)),
    STRAND: ((6.7, 0.6), (9.9, 0.9), (12.4, 1.1), (124, 14), (-170, 45)),
}
#: Least numbers of residues, and of carbons farther along a chain, or of another one, that touch
#: them, and distances in angstroms at which these do.
_LEAST, TOUCHING = {HELIX: (5, 0), STRAND: (4, 3)}, (4.2, 5.2)
#: Half widths and thicknesses of ribbons in angstroms, and half the width of the head of an arrow.
_RIBBONS = {HELIX: (1.35, 0.25), STRAND: (1.1, 0.25)}
_HEAD = 1.9
#: Shares by which a residue moves to its neighbours, so that strands are no zigzag.
_SMOOTHED = {LOOP: 1 / 6, STRAND: 1 / 4}
#: Rings of a round end.
_ROUND = 4


def structure(places: Array, piece: Indices) -> Indices:
    """Return the secondary structure that the trace of a protein alone tells.

    Places are those of the alpha carbons in angstroms, ``piece`` is the number of the piece of a
    chain of each, and the result is ``LOOP``, ``HELIX`` or ``STRAND``.

    Source: Labesse, Colloc'h, Pothier and Mornon, Computer Applications in the Biosciences 13
    (1997), P-SEA. Here a carbon is the second or the third of four whose shape fits, and every
    strand has contacts.
    """
    found = np.full(len(places), LOOP, dtype=np.intp)
    count = len(places) - 4
    if count < 1:
        return found
    one, two, three, four, five = (places[i : count + i] for i in range(5))
    far = [np.linalg.norm(last - one, axis=1) for last in (three, four, five)]
    a, b, c = two - one, three - two, four - three
    bend = np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), -_dot(a, b)))
    first, second = np.cross(a, b), np.cross(b, c)
    turn = np.linalg.norm(b, axis=1) * _dot(a, second), _dot(first, second)
    torsion = np.degrees(np.arctan2(*turn))
    whole = piece[4:] == piece[:count]
    pairs = scipy.spatial.cKDTree(places).query_pairs(TOUCHING[1], output_type="ndarray")
    long = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1) >= TOUCHING[0]
    pairs = pairs[long & (np.abs(np.diff(pairs, axis=1)[:, 0]) > 2)]
    contacts = np.bincount(pairs.ravel(), minlength=len(places))
    for kind, (*lengths, angle, around) in _SHAPES.items():
        near = [np.abs(each - mean) <= off for each, (mean, off) in zip(far, lengths, strict=True)]
        fits = near[1] & near[2] & (near[0] | (kind == HELIX))
        off = np.abs((torsion - around[0] + 180) % 360 - 180)
        fits |= (np.abs(bend - angle[0]) <= angle[1]) & (off <= around[1])
        marked = np.zeros(len(places), dtype=bool)
        marked[1 : count + 1] |= fits & whole
        marked[2 : count + 2] |= fits & whole
        starts, sizes = _runs(marked & (found == LOOP), piece)
        sums = np.concatenate([[0], np.cumsum(contacts)])
        residues, touched = _LEAST[kind]
        kept = (sizes >= residues) & (sums[starts + sizes] - sums[starts] >= touched)
        for start, size in zip(starts[kept].tolist(), sizes[kept].tolist(), strict=True):
            found[start : start + size] = kind
    return found


def sides(places: Array, oxygens: Array, piece: Indices) -> Array:
    """Return the direction across the ribbon at each residue, turned as little as can be.

    Places are those of the alpha carbons, and of the oxygens of their residues, NaN for none.

    Source: Carson and Bugg, Journal of Molecular Graphics 4 (1986): along the oxygen of a peptide,
    which points along helices, and across strands in the plane of their sheet. Without one the
    bisector of the neighbours of a carbon is normal to the ribbon.
    """
    before, after = _neighbours(piece)
    steps = places[after] - places
    along = places[after] - places[before]
    across: Array = np.cross(along, 2 * places - places[before] - places[after])
    peptides = oxygens - places
    peptides -= steps * (_dot(peptides, steps) / np.maximum(_dot(steps, steps), 1e-9))[:, None]
    known = np.isfinite(peptides).all(axis=1) & (after != np.arange(len(places)))
    across = _unit(np.where(known[:, None], peptides, across))
    # Where all is straight, any direction across it does.
    straight = ~across.any(axis=1)
    axis = np.eye(3)[np.argmin(np.abs(along[straight]), axis=1)]
    across[straight] = _unit(np.cross(along[straight], axis))
    turned = np.concatenate([[1.0], np.where(_dot(across[1:], across[:-1]) < 0, -1.0, 1.0)])
    across *= np.cumprod(turned)[:, None]
    for _ in range(2):
        across = _unit(2 * across + across[before] + across[after])
    return across


def swept(
    places: Array, across: Array, kinds: Indices, piece: Indices, radii: Array, *, fine: bool
) -> tuple[pv.PolyData, Array]:
    """Return closed surfaces along pieces of chains: ribbons, arrows and tubes.

    Each piece has two residues at least. ``fine`` is for few residues, which are seen large. The
    surface has point normals; the second result is the place of each of its points along the
    residues, of which the first is at 0.
    """
    rows, around = (8, 20) if fine else (3, 10)
    before, after = _neighbours(piece)
    is_end = (before == np.arange(len(piece))) | (after == np.arange(len(piece)))
    kinds = np.where(is_end, LOOP, kinds)
    shares = np.select([kinds == kind for kind in _SMOOTHED], list(_SMOOTHED.values()), 0.0)
    shares[is_end] = 0
    curve = places + shares[:, None] * (places[before] - 2 * places + places[after])
    widths, heights = radii.copy(), radii.copy()
    for kind, (width, height) in _RIBBONS.items():
        widths[kinds == kind], heights[kinds == kind] = width, height
    # An arrow has its head along the last step of its strand.
    starts, sizes = _runs(kinds == STRAND, piece)
    tips = (starts + sizes - 1)[sizes > 1]
    is_head = np.zeros(len(piece), dtype=bool)
    is_head[tips - 1] = True
    tips = np.concatenate([tips, starts[sizes == 1]])
    widths[tips], heights[tips] = radii[tips], radii[tips]

    # Rings from each residue to the next, two where a head begins, and one at the end of a piece.
    counts = np.where(after == np.arange(len(piece)), 1, rows + is_head)
    of_ring = np.repeat(np.arange(len(piece)), counts)
    step = np.arange(len(of_ring)) - (np.cumsum(counts) - counts)[of_ring]
    on_head = is_head[of_ring] & (step > 0)
    share = np.maximum(step - is_head[of_ring], 0) / rows
    eased = np.where(on_head, share, share**2 * (3 - 2 * share))
    following = after[of_ring]
    first = np.where(on_head, _HEAD, widths[of_ring])
    width = first + eased * (widths[following] - first)
    height = heights[of_ring] + eased * (heights[following] - heights[of_ring])
    center, tangent = _splined(curve, piece, of_ring, share)
    side = across[of_ring] + share[:, None] * (across[following] - across[of_ring])
    side = _unit(side - _dot(side, tangent)[:, None] * tangent)
    normal = np.cross(tangent, side)

    # Round ends: rings that grow from a point, and shrink to one.
    ring_piece = piece[of_ring]
    is_first = np.concatenate([[True], ring_piece[1:] != ring_piece[:-1]])
    is_last = np.concatenate([is_first[1:], [True]])
    repeats = np.where(is_first | is_last, _ROUND + 1, 1)
    ring = np.repeat(np.arange(len(of_ring)), repeats)
    turn = np.arange(len(ring)) - (np.cumsum(repeats) - repeats)[ring]
    turn = np.where(is_first[ring], turn - _ROUND, turn) * (np.pi / 2 / _ROUND)
    # Nothing of a ring is left at a pole.
    shrunk = np.where(np.abs(turn) > 1.57, 0.0, np.cos(turn))
    center = center[ring] + (width[ring] * np.sin(turn))[:, None] * tangent[ring]
    side, normal, tangent = side[ring], normal[ring], tangent[ring]
    width, height = width[ring], height[ring]

    # Points of an ellipse are denser where it bends.
    angle = np.arange(around) * (2 * np.pi / around)
    flat = np.sqrt(height / width)[:, None]
    cosine, sine = np.cos(angle), flat * np.sin(angle)
    length = np.hypot(cosine, sine)
    cosine, sine = cosine / length, sine / length
    x, y = (width * shrunk)[:, None] * cosine, (height * shrunk)[:, None] * sine
    points = center[:, None] + x[..., None] * side[:, None] + y[..., None] * normal[:, None]
    x, y = cosine / width[:, None], sine / height[:, None]
    length = np.hypot(x, y)
    x, y = x / length, y / length
    outward = x[..., None] * side[:, None] + y[..., None] * normal[:, None]
    # Where a ribbon widens, thins or turns its sides lean.
    lean = np.zeros((len(ring), around))
    moved = points[2:] - points[:-2]
    ahead = np.einsum("ijk,ik->ij", moved, tangent[1:-1])
    lean[1:-1] = np.einsum("ijk,ijk->ij", moved, outward[1:-1]) / np.maximum(ahead, 1e-3)
    lean = np.clip(lean, -1, 1)
    lean[turn != 0] = 0
    outward = outward * shrunk[:, None, None] + (
        (np.sin(turn)[:, None] - lean * shrunk[:, None])[..., None] * tangent[:, None]
    )

    inner = np.flatnonzero(np.diff(ring_piece[ring]) == 0)
    low = inner[:, None] * around + np.arange(around)
    high = inner[:, None] * around + (np.arange(around) + 1) % around
    corners = np.stack([low, high, high + around, low, high + around, low + around], axis=-1)
    # A pole is one point.
    is_pole = shrunk == 0
    kept = ~is_pole[:, None] | (np.arange(around) == 0)
    number = (np.cumsum(kept) - 1).reshape(kept.shape)
    number[is_pole] = number[is_pole][:, :1]
    corners = number.ravel()[corners.reshape(-1, 3)]
    corners = corners[(corners != np.roll(corners, 1, axis=1)).all(axis=1)]
    surface = pv.PolyData.from_regular_faces(points[kept], corners)
    surface.point_data.active_normals = _unit(outward[kept])
    return surface, np.repeat((of_ring + share)[ring], kept.sum(axis=1))


def _splined(places: Array, piece: Indices, of_ring: Indices, share: Array) -> tuple[Array, Array]:
    """Return places and directions on smooth curves through those of pieces."""
    center = np.empty((len(of_ring), 3))
    tangent = np.empty((len(of_ring), 3))
    ends = np.concatenate([[0], np.flatnonzero(np.diff(piece)) + 1, [len(piece)]])
    rings = np.searchsorted(of_ring, ends)
    along = of_ring + share
    for i in range(len(ends) - 1):
        knots = np.arange(ends[i], ends[i + 1])
        spline = scipy.interpolate.CubicSpline(knots, places[knots], bc_type="natural")
        part = slice(rings[i], rings[i + 1])
        center[part], tangent[part] = spline(along[part]), spline(along[part], 1)
    return center, _unit(tangent)


def _neighbours(piece: Indices) -> tuple[Indices, Indices]:
    """Return the one before and after each in its piece, at the ends of which it is itself."""
    rows = np.arange(len(piece))
    joined = np.diff(piece) == 0
    before = rows - np.concatenate([[False], joined])
    return before, rows + np.concatenate([joined, [False]])


def _unit(rows: Array) -> Array:
    lengths = np.linalg.norm(rows, axis=-1, keepdims=True)
    return rows / np.where(lengths > 0, lengths, 1.0)


def _dot(a: Array, b: Array) -> Array:
    dot: Array = np.einsum("ij,ij->i", a, b)
    return dot


def _runs(marked: Bools, piece: Indices) -> tuple[Indices, Indices]:
    """Return the first of each run of marked places in one piece, and how many it has."""
    joined = marked[1:] & marked[:-1] & (np.diff(piece) == 0)
    starts = np.flatnonzero(marked & ~np.concatenate([[False], joined]))
    last = np.flatnonzero(marked & ~np.concatenate([joined, [False]]))
    return starts, last - starts + 1
