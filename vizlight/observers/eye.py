"""The eye of the meter: which contrasts of a picture are left at a size and a distance.

S-CIELAB (Zhang and Wandell 1997): linear light in an opponent space, where each channel passes the
filter of its contrast sensitivity, and CIELAB after that. Gray stays gray.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from scipy import fft

if TYPE_CHECKING:
    from vizlight._types import Array, Bools, Indices

#: CIE XYZ of linear sRGB (IEC 61966-2-1), and of white D65.
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ.sum(axis=1)
#: Opponent channels of XYZ: light and dark, red and green, blue and yellow (Poirson and Wandell
#: 1993, as Zhang and Wandell 1997 use them).
POIRSON = np.array([[0.279, 0.72, -0.107], [-0.449, 0.29, -0.077], [0.086, -0.59, 0.501]])
#: The same with gray taken out of both channels of chroma, whose other filters would give gray
#: edges a hue (Johnson, Song, Montag and Fairchild, Color Res. Appl. 35, 2010).
OPPONENT = POIRSON - np.outer([0, *(POIRSON[1:] @ WHITE)], POIRSON[0]) / (POIRSON[0] @ WHITE)
#: Weights and spreads in degrees of the Gaussians whose sum filters each channel (Zhang and Wandell
#: 1997, table 1).
FILTERS = (
    ((0.921, 0.0283), (0.105, 0.133), (-0.108, 4.336)),
    ((0.531, 0.0392), (0.330, 0.494)),
    ((0.488, 0.0536), (0.371, 0.386)),
)
#: Least difference in CIELAB that an eye tells apart (Mahy, Van Eycken and Oosterlinck 1994): the
#: standard deviation of the noise of a reader.
NOISE = 2.3
#: Standard deviation of rounding to bytes, in CIELAB.
ROUNDING = 0.3
MM_PER_INCH = 25.4


def linear(rgb: Array) -> Array:
    """Return sRGB values, from 0 to 1, in linear light (IEC 61966-2-1)."""
    return np.asarray(
        np.where(rgb <= 0.04045, rgb / 12.92, ((np.maximum(rgb, 0.0) + 0.055) / 1.055) ** 2.4)
    )


def lab_of_xyz(xyz: Array) -> Array:
    """Return CIELAB of XYZ, shape (..., 3), under white D65 (CIE 15)."""
    ratio = xyz / WHITE
    # Near black CIELAB has a straight line in place of the cube root.
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16 / 116)
    x, y, z = f[..., 0], f[..., 1], f[..., 2]
    return np.stack([116 * y - 16, 500 * (x - y), 200 * (y - z)], axis=-1)


def xyz_of_lab(colors: Array) -> Array:
    """Return XYZ of CIELAB, the inverse of :func:`lab_of_xyz`."""
    y = (colors[..., 0] + 16) / 116
    f = np.stack([y + colors[..., 1] / 500, y, y - colors[..., 2] / 200], axis=-1)
    ratio = np.where(f > 0.008856 ** (1 / 3), f**3, (f - 16 / 116) / 7.787)
    return np.asarray(ratio * WHITE)


def lab(rgb: Array) -> Array:
    """Return CIELAB of sRGB values, shape (..., 3) from 0 to 1, under white D65."""
    return lab_of_xyz(linear(rgb) @ XYZ.T)


def opponent(rgb: Array) -> Array:
    """Return the opponent channels of sRGB values, shape (..., 3) from 0 to 1."""
    return np.asarray(linear(rgb) @ (OPPONENT @ XYZ).T)


def lab_of_opponent(channels: Array) -> Array:
    """Return CIELAB of opponent channels, shape (..., 3)."""
    # A filter may leave a little less than no light beside a bright place.
    return lab_of_xyz(np.maximum(channels @ np.linalg.inv(OPPONENT).T, 0.0))


@dataclass(frozen=True)
class Eye:
    """An eye that looks at a picture from some distance.

    ``pixels_per_degree`` counts pixels of the picture in a degree of the visual field; ``noise`` is
    the standard deviation of the noise of the reader in CIELAB.
    """

    pixels_per_degree: float
    noise: float = NOISE

    @classmethod
    def at(cls, pixels: int, size_mm: float, distance_mm: float, noise: float) -> Eye:
        """Return the eye at a distance from a picture of some width in pixels and in mm."""
        degree = 2 * distance_mm * math.tan(math.radians(0.5))
        return cls(pixels / size_mm * degree, noise)

    def filtered(self, channels: Array) -> Array:
        """Return opponent channels of a picture, shape (H, W, 3), as the eye resolves them.

        Of shape (H, W, 1) all channels are alike.

        Each channel is convolved with ``sum(w k exp(-(x^2 + y^2) / s^2)) / sum(w)``, k such that
        each Gaussian sums to 1 (Zhang and Wandell 1997, eq. 2). The picture is mirrored at its
        borders.
        """
        spectra = [fft.dctn(channel, norm="ortho") for channel in np.moveaxis(channels, 2, 0)]
        passed = [spectra[i % len(spectra)] * self._transfer(channels.shape, i) for i in range(3)]
        return np.stack([fft.idctn(spectrum, norm="ortho") for spectrum in passed], axis=2)

    def _transfer(self, shape: tuple[int, ...], channel: int) -> Array:
        """Return the share of each frequency of a cosine transform that a channel passes."""
        # The k-th cosine of n pixels has k / (2 n) cycles per pixel.
        weight, spread = np.array(FILTERS[channel]).T
        frequencies = (self.pixels_per_degree * np.arange(n) / (2 * n) for n in shape[:2])
        rows, columns = (np.exp(-((np.pi * np.outer(f, spread)) ** 2)) for f in frequencies)
        return np.asarray((rows * weight / weight.sum()) @ columns.T)

    def share(self, width: float) -> Array:
        """Return how much of each channel at the middle of a disc is from the disc itself.

        It is the integral of the filter of :meth:`filtered` over a disc of some pixels.
        """
        shares = []
        for channel in FILTERS:
            squares = ((width / 2 / self.pixels_per_degree / spread) ** 2 for _, spread in channel)
            share = sum(-w * math.expm1(-x) for (w, _), x in zip(channel, squares, strict=True))
            shares.append(share / sum(weight for weight, _ in channel))
        return np.array(shares)

    def look(self, picture: Array, drawn: Bools) -> SeenPicture:
        """Return a picture as the eye sees it.

        The picture (H, W, 3) has sRGB values from 0 to 1, and ``drawn`` masks pixels that show
        anything but the background.
        """
        channels = opponent(picture)
        ground = np.zeros(3) if drawn.all() else np.median(channels[~drawn], axis=0)
        return SeenPicture(
            channels=self.filtered(channels),
            cover=self.filtered(drawn[..., np.newaxis].astype(np.float64)),
            ground=ground,
        )


@dataclass(frozen=True)
class SeenPicture:
    """A picture as an eye sees it.

    ``channels`` (H, W, 3) are opponent channels of the filtered picture, ``cover`` is the share of
    the drawing in each of them, the rest is background, and ``ground`` has the opponent channels of
    that.
    """

    channels: Array
    cover: Array
    ground: Array

    @cached_property
    def colors(self) -> Array:
        """CIELAB of the filtered picture, shape (H, W, 3)."""
        return lab_of_opponent(self.channels)

    def colors_at(self, row: Indices, column: Indices) -> Array:
        """Return CIELAB of some pixels, shape (M, 3)."""
        return lab_of_opponent(self.channels[row, column])

    def pooled(self, row: Indices, column: Indices, group: Indices) -> SeenPicture:
        """Return the picture with the mean of each group of pixels in place of its colours.

        Groups have numbers of 0 or more.
        """
        channels, cover = self.channels.copy(), self.cover.copy()
        # The eye sees no less than no light.
        light = np.maximum(channels[row, column] @ np.linalg.inv(OPPONENT).T, 0.0)
        channels[row, column] = (means(light, group) @ OPPONENT.T)[group]
        cover[row, column] = means(cover[row, column], group)[group]
        return dataclasses.replace(self, channels=channels, cover=cover)


def means(rows: Array, group: Indices, count: int = 0) -> Array:
    """Return the means of the rows of groups, by the numbers of the groups, ``count`` at least."""
    number = np.maximum(np.bincount(group, minlength=count), 1)[:, np.newaxis]
    sums = [np.bincount(group, column, len(number)) for column in rows.T]
    return np.asarray(np.stack(sums, axis=1) / number)
