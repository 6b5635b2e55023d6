"""The questions that light answers, one row each: a preset has its row here. It needs no NumPy."""

from __future__ import annotations

from typing import Literal, NamedTuple


class Question(NamedTuple):
    """Facts on a question, from which its key, its chip on a page and its look are made.

    ``title`` is its name on a page, which ``says`` more of it; ``words`` stand beside its key:
    below it, or at the two ends of a bar. ``key`` is its form: a ``"ball"`` of normals, a
    ``"disc"`` of tangents across the view, a ``"hemisphere"`` of tangents to the near side, a
    ``"bar"`` of tangents from across the view to the eye, or the ``"colors"`` of data as a bar.
    Lines have tangents by themselves, surfaces have not; hues of the light that are the answer
    would be hidden by the colours of data.
    """

    title: str
    says: str
    words: tuple[str, ...]
    key: Literal["ball", "disc", "hemisphere", "bar", "colors"] = "ball"
    of_tangents: bool = False
    by_hue: bool = False

    @property
    def is_bar(self) -> bool:
        """Whether its key is a bar."""
        return self.key in ("bar", "colors")


#: The table: each question has a function of its name in ``vizlight/scene/presets.py``.
QUESTIONS = {
    "direction": Question(
        "Direction", "Hue is the direction on the screen, as the key shows.",
        ("direction on the screen",), "disc", of_tangents=True, by_hue=True,
    ),
    "slope": Question(
        "Slope", "Bright is across your view, dark is along it.",
        ("across view", "along view"), "bar", of_tangents=True,
    ),
    "heading": Question(
        "Heading", "Hue tells the direction and which end is near.",
        ("where the near end points",), "hemisphere", of_tangents=True, by_hue=True,
    ),
    "shape": Question(
        "Shape", "Hue and lightness are the normal, as on the ball of the key.",
        ("the way it faces",), by_hue=True,
    ),
    "value": Question(
        "Value", "Soft light without highlight: colours are read by the bar.",
        ("low", "high"), "colors",
    ),
}  # fmt: skip
