"""The Blinn model as a substitute for the Phong model: its power and its error.

Rules for the Blinn power are compared over the lit and visible normals of a sphere. Errors are
pixel values from 0 to 255.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from studies import Curve, Row, Study
from vizlight.model import highlights

DEGREES = (10.0, 30.0, 60.0, 90.0, 120.0, 150.0)
POWERS = (10.0, 40.0, 200.0)
#: Power whose rules are drawn.
DRAWN = 40.0


def rules(degrees: float, r: float) -> list[Row]:
    """Return the errors of each rule for one angle between light and eye, and one Phong power."""
    angle = float(np.deg2rad(degrees))
    factors = {
        "4": 4.0,
        "4 cos(beta)": float(highlights.simple_factor(angle)),
        "4 cos(beta) corrected for r": float(highlights.simple_factor(angle, r)),
        "best by worst": float(highlights.best_factor(angle, r)),
        "best by RMS": float(highlights.best_factor(angle, r, by="rms")),
        "best by volume": float(highlights.best_factor(angle, r, by="volume")),
    }
    rows = []
    for rule, factor in factors.items():
        error = partial(highlights.sphere_error, angle, r, factor=factor)
        more = {"power": r, "factor": factor, "RMS": float(error(by="rms"))}
        more["mean size"] = float(error(by="volume"))
        rows.append(Row(f"rule {rule}", degrees, float(error(by="worst")), np.nan, more))
    return rows


STUDY = Study(
    approximates="highlight of the Phong model by the Blinn model",
    reference="the Phong model with the same light",
    parameter="angle between light and eye, degrees",
    error="largest error, of 255",
    cost="none: the two cost the same",
    steps=lambda quick: [
        partial(rules, degrees, r)
        for degrees in DEGREES
        for r in (POWERS[1:2] if quick else POWERS)
    ],
    axes=("parameter", "error"),
    curve=lambda row: Curve(row.way) if row.more["power"] == DRAWN else None,
)
