"""Diffuse and specular reflection of a k-manifold in n-space."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from vizlight import _check
from vizlight._types import Array, Bools
from vizlight.model import frames, kernels
from vizlight.model.manifolds import ArrayAlgebra, FrameManifold, Highlight

__all__ = ["diffuse", "specular"]

SpecularModel = Literal["phong", "blinn"]


def diffuse(wi: ArrayLike, frame: ArrayLike, /, *, exponent: float = 1.0) -> Array:
    """Return the diffuse factor sin(a)^p, where a is the angle between wi and the tangent space.

    Parameters
    ----------
    wi : array_like, shape (..., n)
        Directions from the point toward the light; normalised here. The factor is 0 where one is
        zero.
    frame : array_like, shape (..., k, n)
        Frames of orthonormal tangents, k < n.
    exponent : float, default: 1.0
        Exponent p from 0 to 1e9, unitless: 1 is the plain reflection model,
        :func:`vizlight.model.brightness.exponent` returns the compensated one.

    Returns
    -------
    ndarray, shape (...)
        Factor in [0, 1] up to rounding, to be multiplied by kd and the intensity of the light.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If the shapes do not broadcast, the rows are not orthonormal or the exponent is negative.

    Notes
    -----
    ``sin(a)^p`` with ``sin(a) = |wi_N|``; in codimension 1 with p = 1 this is two-sided Lambert.
    Source: Banks (1) and (5). For n up to 8 the absolute error is at most ``(4 + 2 p) eps`` for p
    from 1 to 128 and ``(8 + sqrt(p)) eps`` above; for p < 1, where the slope at sin(a) = 0 is
    infinite, ``(8 eps)^p``. The deviation of the rows from orthonormality adds to it.
    """
    exponent = _check.number("exponent", exponent, low=0.0, high=_check.LARGEST)
    met = Met("frame", frames.as_frame(frame), wi=wi)
    manifold = FrameManifold(met.algebra, list(met.rows), exponent)
    (light,) = met.directions
    return met.finish(manifold.diffuse(manifold.split(light), None))


def specular(
    wi: ArrayLike,
    wo: ArrayLike,
    frame: ArrayLike,
    /,
    *,
    shininess: float,
    model: SpecularModel = "phong",
) -> Array:
    """Return the specular factor of a k-manifold by Phong or Blinn, in any codimension.

    Parameters
    ----------
    wi, wo : array_like, shape (..., n)
        Directions from the point toward the light and toward the eye; normalised here. The
        factor is 0 where one of them is zero.
    frame : array_like, shape (..., k, n)
        Frames of orthonormal tangents, k < n.
    shininess : float
        Exponent s (Phong) or q (Blinn), from 0 to 1e9, unitless. ``0^0`` is 1.
    model : {"phong", "blinn"}
        Reflection model: ``max(0, V.R)^s`` or ``|h_N|^q``.

    Returns
    -------
    ndarray, shape (...)
        Factor in [0, 1] up to rounding, to be multiplied by ks and the intensity of the light.

    Raises
    ------
    TypeError
        If an argument does not hold real numbers.
    ValueError
        If the shapes do not broadcast, the rows are not orthonormal, shininess is negative or the
        model is unknown.

    Notes
    -----
    Phong: ``V.R = |wi_N| |wo_N| - wi_T . wo_T``, where R is the reflection nearest to the eye.
    Banks (2) prints ``V_T . L_T - |V_N| |L_N|`` with L = -wi, the direction in which the light
    travels: its first term is the second term here, and the sign of ``|V_N| |L_N|`` is wrong for
    a V that points toward the eye. The value is computed as
    ``1 - (|wi_T + wo_T|^2 + (|wi_N| - |wo_N|)^2) / 2``, which is equal for unit vectors and keeps
    its digits near the highlight.
    Blinn: ``|h_N|`` of the normalised h = wi + wo; 0 where wi = -wo and no half vector exists.

    For n up to 8 the absolute error is at most ``(4 + s) eps`` for s from 1 to 128 and
    ``(8 + 3 sqrt(s)) eps`` above; for s < 1, where the slope at V.R = 0 is infinite, ``(8 eps)^s``.
    For Blinn, eps is divided by ``|wi + wo|`` where that is less than 1.
    Source: Banks (2) and (3); Fisher and Woo's N.H, generalised.
    """
    _check.choice("model", model, get_args(SpecularModel))
    shininess = _check.number("shininess", shininess, low=0.0, high=_check.LARGEST)
    met = Met("frame", frames.as_frame(frame), wi=wi, wo=wo)
    manifold = FrameManifold(met.algebra, list(met.rows))
    lit, eye = (manifold.split(way) for way in met.directions)
    return met.finish(manifold.specular(lit, eye, Highlight(model, shininess)))


class Met:
    """Unit directions at frames, component-first, with the shape and mask of their light."""

    def __init__(self, name: str, rows: Array, **directions: ArrayLike) -> None:
        n = rows.shape[-1]
        vectors = {key: _check.vectors(key, value, n=n) for key, value in directions.items()}
        self.shape, self.rows, columns = frames.batch(name, rows, **vectors)
        units = [kernels.unit(column) for column in columns]
        self.directions, self.sizes = [unit for unit, _ in units], [size for _, size in units]
        # NaN, the length of a vector that is not finite, is not greater than 0 either.
        self.valid: Bools = np.all(np.greater(self.sizes, 0), axis=0)
        self.algebra = ArrayAlgebra(self.rows.dtype)

    def finish(self, value: Array) -> Array:
        """Return numbers in the shape of the batch, 0 where a direction has no length."""
        kept = np.where(self.valid, value, 0).astype(self.rows.dtype, copy=False)
        return kept.reshape(self.shape)
