"""The options of light: one list for filters, command line and plan."""

from __future__ import annotations

from typing import Literal

Model = Literal["phong", "blinn", "cylinder"]
Precision = Literal["float32", "float64"]


def surface_model(model: Model) -> Model:
    """Return the model of a surface's highlight beside lines of a model: Blinn's for a cylinder."""
    return "blinn" if model == "cylinder" else model
