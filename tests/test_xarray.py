"""The accessor of data of xarray does what the functions do."""

import inspect

import numpy as np
import pytest

import vizlight

xr = pytest.importorskip("xarray", reason="pip install 'vizlight[formats]'")
pytest.importorskip("cf_xarray", reason="pip install 'vizlight[formats]'")


@pytest.fixture(scope="module")
def waves():
    import vizlight.xarray  # noqa: F401

    lat, lon = np.linspace(40, 50, 6), np.linspace(0, 20, 9)
    height = np.array([1, 2, 3])[:, np.newaxis, np.newaxis] * np.sin(lat)[:, np.newaxis] + lon
    axes = {"number": [0, 5, 9], "lat": lat, "lon": lon}
    return xr.Dataset({"height": (("number", "lat", "lon"), height)}, axes)


@pytest.mark.parametrize("of", [lambda ds: ds, lambda ds: ds["height"]], ids=["dataset", "array"])
def test_the_accessor_reads_and_looks(waves, of):
    data = of(waves)
    mesh = data.vizlight.read(at={"number": 9})
    np.testing.assert_array_equal(mesh["height"], waves["height"][2].values.ravel())
    look = data.vizlight.look("auto", at={"number": 9}, size=(90, 60))
    assert (look.shown, look.array) == ("sheet", "height")
    np.testing.assert_array_equal(look.mesh["height"], mesh["height"])
    assert next(iter(inspect.signature(data.vizlight.look).parameters)) == "question"


def test_what_reads_is_refused_beside_a_mesh(waves):
    mesh = waves.vizlight.read()
    with pytest.raises(ValueError, match="at: expected no such option beside a mesh, which is"):
        vizlight.look(mesh, at={"number": 9})
    with pytest.raises(ValueError, match="at, along number: expected a value, 0, 5, 9, an index"):
        vizlight.look(waves, at={"number": 70})
