"""Colours of a raster of several bands: which of them are red, green and blue, and how bright."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.colors import to_rgb

from vizlight._types import Array, Bools, Raw
from vizlight.maps import MISSING

#: Interpretations of bands by their files, and patterns of names: words, letters, and the numbers
#: of Sentinel-2 and Landsat 8.
_COLORS = ("red", "green", "blue")
_NAMES = (("red(?![ _-]?edge)", *_COLORS[1:]), ("r", "g", "b"), ("b0?4", "b0?3", "b0?2"))
#: Numbers of bands without names that are a picture, with transparency or infrared as the fourth.
_PICTURES = (3, 4)
#: Percentiles of the bands that are black and white, and most pixels that are looked at.
ENDS, SAMPLE = (2, 98), 100_000


def colors_among(kinds: Mapping[str, tuple[str, str]]) -> list[str]:
    """Return the names of the bands that are red, green and blue, none where no three are.

    ``kinds`` has the interpretation of each band by its file, such as ``"red"``, ``"gray"`` or
    ``"undefined"``, and its type, by its name; this is ``band_1`` and so on where the file has
    none.
    """
    by_file = {kind: name for name, (kind, _) in kinds.items()}
    if by_file.keys() >= {*_COLORS}:
        return [by_file[color] for color in _COLORS]
    for patterns in _NAMES:
        matches = [
            [name for name in kinds if re.search(rf"(?<![a-z\d]){word}(?![a-z\d])", name.lower())]
            for word in patterns
        ]
        if all(matches):
            # "blue" rather than "coastal blue".
            return [min(group, key=len) for group in matches]
    unnamed = [f"band_{i + 1}" for i in range(len(kinds))]
    types = {dtype for _, dtype in kinds.values()}
    is_picture = len(kinds) in _PICTURES and types in ({"uint8"}, {"uint16"})
    return unnamed[:3] if is_picture and unnamed == [*kinds] else []


def composite(bands: Sequence[Raw], *, as_stored: bool) -> Raw:
    """Return the colours of three bands as bytes, grey where all of them are missing.

    ``as_stored`` takes bytes of a picture as they are. Other bands, NaN where they are missing, run
    from the 2nd to the 98th percentile of all three, which keeps hues, without the pixels at which
    all are 0, which lie outside of a satellite's swath.
    """
    stack: Array = np.stack([band.astype(np.float64) for band in bands], axis=-1)
    # Where 0 is missing, a dark pixel may lack one of them.
    known: Bools = np.asarray(np.isfinite(stack).any(axis=-1))
    shown = np.nan_to_num(stack)
    if not as_stored:
        seen = stack[known & shown.any(axis=-1)]
        seen = seen[:: max(len(seen) // SAMPLE, 1)] if len(seen) else np.zeros((1, 3))
        low, high = np.nanpercentile(seen, ENDS)
        shown = np.rint(255 * np.clip((shown - low) / ((high - low) or 1), 0, 1))
    missing = np.rint(255 * np.array(to_rgb(MISSING)))
    return np.where(known[..., np.newaxis], shown, missing).astype(np.uint8)
