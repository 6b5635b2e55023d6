"""The share of a picture that shows data: measured in its pixels, before it is handed out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from vtkmodules.vtkRenderingCore import vtkProp3D

from vizlight import _check

if TYPE_CHECKING:
    from pathlib import Path

    import pyvista as pv
    from numpy.typing import NDArray

#: Share of a picture below which data are hardly seen: a line as long as the picture is 1 / 800.
HARDLY = 1e-3
#: Share of pixels unlike the background from which no key and no text can account for them.
PLAINLY = 0.25


def share_of_data(plotter: pv.Plotter, /) -> float:
    """Return the share of the pixels of a plotter's picture that data change.

    Parameters
    ----------
    plotter : pyvista.Plotter
        Plotter that draws offscreen; it is rendered with and without its actors in space. Keys,
        bars, texts and surfaces of the colour of the background behind them do not count.

    Returns
    -------
    float
        Share from 0 to 1.
    """
    return _share(plotter, _picture(plotter))


def save_seen(plotter: pv.Plotter, path: Path, draft: str) -> None:
    """Save the picture of a plotter to a draft of a file, and warn where it hardly shows data.

    Parameters
    ----------
    plotter : pyvista.Plotter
    path : pathlib.Path
        Path of the picture, for the warning.
    draft : str
        Path to which it is written first.
    """
    picture = np.asarray(plotter.screenshot(draft, return_img=True))
    corner = picture[0, 0].astype(np.int16)
    # A picture without any data is rendered only where there can be few of them in this one.
    if np.mean(np.any(picture != corner, axis=2)) >= PLAINLY:
        return
    share = _share(plotter, picture)
    if share < HARDLY:
        _check.warn(
            f"data are hardly seen in '{path.name}': they change {share:.2%} of its pixels; they "
            "may be thin, narrow, seen along their plane, of the colour of the background, or "
            "beside the camera: take another view or zoom, or scale an axis of a long mesh"
        )


def _picture(plotter: pv.Plotter) -> NDArray[np.uint8]:
    return np.array(plotter.screenshot(return_img=True))


def _share(plotter: pv.Plotter, picture: NDArray[np.uint8]) -> float:
    """Return the share of the pixels of a picture that are others without the data."""
    shown = [
        actor
        for renderer in plotter.renderers
        for actor in renderer.actors.values()
        # Keys, bars and texts have places on the screen, not in space.
        if isinstance(actor, vtkProp3D) and actor.GetVisibility()
    ]
    for actor in shown:
        actor.SetVisibility(False)
    try:
        plotter.render()
        bare = _picture(plotter)
    finally:
        for actor in shown:
            actor.SetVisibility(True)
    return float(np.mean(np.any(picture != bare, axis=2)))
