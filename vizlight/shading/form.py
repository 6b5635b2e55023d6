"""What the text of a compiled kernel depends on."""

from __future__ import annotations

from typing import NamedTuple

#: Up to this many lights are written out; more are grouped by kind, each kind in a loop.
UNROLLED = 4
#: Bits of the powers that are computed by multiplication.
BITS = 6


class LightForm(NamedTuple):
    """Kind of a light: near or at infinity, with attenuation or not, and its highlight.

    ``whole`` says that the highlight is an integer power below 2^BITS.
    """

    near: bool
    faded: bool
    highlight: str
    whole: bool


class Form(NamedTuple):
    """What the text of a kernel depends on; types are "f4", "f8", or empty for what is not read."""

    work: str
    n: int
    k: int
    base: int
    points: str
    tangents: str
    normals: str
    base_tangents: str
    surface: bool
    cylinder: bool
    two_sided: bool
    conditioned: bool
    shadowed: bool
    fur: bool
    occluded: bool
    diffuse: str
    based: str
    specular: bool
    eye: str
    splits_eye: bool
    cue: str
    axis: bool
    tinted: bool
    colored: bool
    components: bool
    lights: tuple[LightForm, ...]
