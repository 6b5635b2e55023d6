"""Fields of lines and planes without sign: their mean does not depend on how each is oriented."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vizlight.model import kernels

if TYPE_CHECKING:
    from vizlight._types import Array

#: Difference of eigenvalues, as a share of their sum, below which no direction prevails.
ISOTROPIC = 1e-6


def outer(tangents: Array) -> Array:
    """Return the sums of the outer products of tangents, whatever their signs.

    Parameters
    ----------
    tangents : ndarray, shape (..., k, n)
        Tangents of any length. One that is not finite counts as zero.

    Returns
    -------
    ndarray of float64, shape (..., n, n)
        ``t t^T / |t|`` of one tangent over the largest length of all, so that long ones count more;
        of k tangents the projection on the space that they span.
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
    found = np.einsum("kip,kjp,p->pij", frame, frame, weight)
    return np.asarray(found.reshape(*rows.shape[:-2], *found.shape[1:]))


def principal(products: Array, k: int = 1) -> tuple[Array, Array]:
    """Return the space of k dimensions that means of outer products are closest to.

    Parameters
    ----------
    products : ndarray, shape (..., n, n)
        Symmetric matrices, such as means of :func:`outer` or tensors of diffusion.
    k : int, default: 1
        Dimension of the space.

    Returns
    -------
    tangents : ndarray of float64, shape (..., k, n)
        Eigenvectors of the k largest eigenvalues, the largest first, of length 1 and of any sign.
        They are zero where the space is not unique: where the matrix is zero or not finite, or the
        eigenvalues k and k + 1 differ by less than 1e-6 of the sum of all magnitudes.
    anisotropy : ndarray of float64, shape (...)
        Difference of the eigenvalues k and k + 1, as a share of the sum of all magnitudes.
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


def mean(tangents: Array, weights: Array) -> Array:
    """Return weighted means of tangents as lines and planes, whatever their signs.

    Parameters
    ----------
    tangents : ndarray, shape (..., m, k, n)
        Tangents of m places, of any length.
    weights : ndarray, shape (..., m)
        Weights of the places, for example of an interpolation.

    Returns
    -------
    ndarray of float64, shape (..., k, n)
        Orthonormal tangents; a single one has the sign that most of its places have, by weight.
        Zero where no space is closest.
    """
    # t and -t have the same outer product, so opposite tangents do not cancel in the mean.
    products = outer(tangents)
    found, _ = principal(np.einsum("...m,...mij->...ij", weights, products), tangents.shape[-2])
    if tangents.shape[-2] == 1:
        rows = np.where(np.isfinite(tangents), tangents, 0)
        along = np.einsum("...ki,...mki,...m->...", found, rows, weights)
        found = np.where((along < 0)[..., np.newaxis, np.newaxis], -found, found)
    return np.asarray(found)
