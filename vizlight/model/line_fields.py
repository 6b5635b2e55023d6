"""Fields of lines and planes without sign: their mean does not depend on how each is oriented."""

from __future__ import annotations

import numpy as np

from vizlight._types import Array
from vizlight.model import kernels

#: Difference of eigenvalues, as a share of their sum, below which no direction prevails.
ISOTROPIC = 1e-6


def outer(tangents: Array) -> Array:
    """Return the sums of the outer products of tangents, whatever their signs.

    One tangent (..., 1, n) gives ``t t^T / |t|`` over the largest length of all, so that long ones
    count more; k of any length give the projection on the space that they span. One that is not
    finite counts as zero.
    """
    rows = np.array(tangents, dtype=np.float64)
    rows[~np.all(np.isfinite(rows), axis=-1)] = 0
    k = rows.shape[-2]
    # Kernels have the components first.
    columns = np.ascontiguousarray(np.moveaxis(rows.reshape(-1, *rows.shape[-2:]), 0, -1))
    if k == 1:
        unit, length = kernels.unit(columns[0])
        frame, weight = unit[np.newaxis], length / (length.max(initial=0) or 1.0)
    else:
        frame = kernels.orthonormalize(columns, 1e-12)[0]
        weight = np.ones(columns.shape[-1])
    products = np.einsum("kip,kjp,p->pij", frame, frame, weight)
    return np.asarray(products.reshape(*rows.shape[:-2], *products.shape[1:]))


def principal(products: Array, k: int = 1) -> tuple[Array, Array]:
    """Return the space of k dimensions that means of outer products are closest to.

    Matrices (..., n, n) are symmetric, such as means of :func:`outer` or tensors of diffusion.
    Tangents (..., k, n) are eigenvectors of the k largest eigenvalues, the largest first, of length
    1 and of any sign. They are zero where the space is not unique: where the matrix is zero or not
    finite, or the eigenvalues k and k + 1 differ by less than 1e-6 of the sum of all magnitudes.
    The anisotropy (...) is their difference as a share of that sum.
    """
    matrices = np.asarray(products, dtype=np.float64)
    good = np.all(np.isfinite(matrices), axis=(-1, -2))
    # Scaled, because products of tiny numbers underflow and of huge ones overflow.
    matrices = np.where(good[..., np.newaxis, np.newaxis], matrices, 0)
    size = np.abs(matrices).max(axis=(-1, -2), initial=0)
    matrices = matrices / np.where(size > 0, size, 1)[..., np.newaxis, np.newaxis]
    values, vectors = np.linalg.eigh(matrices)
    total = np.abs(values).sum(axis=-1)
    gap = (values[..., -k] - values[..., -k - 1]) / np.where(total > 0, total, 1)
    unique = gap > ISOTROPIC
    # eigh sorts eigenvalues upward, with the eigenvectors as columns.
    tangents = np.swapaxes(vectors[..., ::-1][..., :k], -1, -2)
    return np.where(unique[..., np.newaxis, np.newaxis], tangents, 0), np.where(unique, gap, 0)
