"""The report's time is that of the light, not of the check of it."""

import time

import numpy as np
import pytest
import pyvista as pv

import vizlight
from vizlight import Light, Scene, View
from vizlight.verify import oracle, rays

SCENE = Scene(lights=Light(direction=(1, 2, 3)), view=View(direction=(0, 0, 1)))
SLOW = 0.02


def slowed(function):
    """Return a check that takes its time."""

    def check(*arguments, **options):
        time.sleep(SLOW)
        return function(*arguments, **options)

    return check


def grid():
    field = pv.ImageData(dimensions=(9, 9, 1))
    field["height"] = np.zeros(81)
    return field


@pytest.mark.slow
def test_the_check_is_no_cost_of_the_light(monkeypatch):
    for module, name in ((oracle, "light"), (rays, "relief_ratio")):
        monkeypatch.setattr(module, name, slowed(getattr(module, name)))
    for work in (
        lambda: vizlight.illuminate(pv.Sphere(), SCENE),
        lambda: vizlight.isoluminance(pv.Sphere(), SCENE, levels=4),
        lambda: vizlight.relief_shadow(grid(), SCENE),
    ):
        work()
        start = time.perf_counter()
        with vizlight.report(sample=50) as told:
            work()
        elapsed = time.perf_counter() - start
        (run,) = told.runs
        checked = SLOW * run.sample
        assert run.sample == 50
        assert elapsed > checked
        assert run.seconds <= told.seconds <= elapsed - checked
