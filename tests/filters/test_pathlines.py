"""Pathlines and streaklines against closed forms, and what is refused."""

import numpy as np
import pytest
import pyvista as pv
from refusals import refusals

import vizlight
from vizlight import Scene, View

SCENE = Scene(view=View(direction=(0, 0, 1)))
END = 2.0


def steps(velocity, times, *, kind="image"):
    made = []
    for time in times:
        mesh = pv.ImageData(dimensions=(25, 25, 3), spacing=(0.25, 0.25, 1), origin=(-3, -3, -1))
        if kind == "tetrahedra":
            mesh = mesh.triangulate()
        mesh["V"] = velocity(np.asarray(mesh.points, dtype=float), time)
        made.append(mesh)
    return made


def rotation(points, time):
    return np.stack([-points[:, 1], points[:, 0], 0 * points[:, 0]], axis=1)


def gust(points, time):
    """Uniform and unsteady: u = (1, cos t)."""
    return np.tile([1.0, np.cos(time), 0.0], (len(points), 1))


def last(velocity, count, seeds, *, mesh="image", **options):
    times = np.linspace(0, END, count)
    series = steps(velocity, times, kind=mesh)
    frames = list(
        vizlight.pathlines(series, SCENE, times=times, tangents="V", seeds=seeds, **options)
    )
    assert len(frames) == count - 1
    assert [frame.field_data["TimeValue"][0] for frame in frames] == pytest.approx(times[1:])
    assert all("luminance" in frame.point_data for frame in frames)
    return frames[-1]


@pytest.mark.parametrize("mesh", ["image", "tetrahedra"])
@pytest.mark.parametrize("kind", ["pathlines", "streaklines"])
def test_steady_rotation_gives_circles(kind, mesh):
    lines = last(rotation, 5, [[1.0, 0, 0], [0, 2.0, 0]], mesh=mesh, kind=kind, step=0.2)
    points, age = np.asarray(lines.points), np.asarray(lines["Time"])
    assert lines.n_lines == 2
    radius = np.linalg.norm(points[:, :2], axis=1)
    np.testing.assert_allclose(radius, np.round(radius), atol=1e-5)
    turned = age if kind == "pathlines" else END - age
    angle = np.arctan2(points[:, 1], points[:, 0]) - np.where(radius > 1.5, np.pi / 2, 0)
    np.testing.assert_allclose(np.mod(angle - turned + 1, 2 * np.pi), 1, atol=1e-5)


def test_vectors_of_two_components_are_those_of_a_plane():
    seeds, times = [[1.0, 0, 0]], [0, 1]
    series = steps(rotation, times)
    whole = list(vizlight.pathlines(series, SCENE, times=times, tangents="V", seeds=seeds))
    for mesh in series:
        mesh["V"] = np.asarray(mesh["V"])[:, :2]
    flat = list(vizlight.pathlines(series, SCENE, times=times, seeds=seeds))
    np.testing.assert_array_equal(flat[0].points, whole[0].points)


def _error(kind, count):
    """Error of the line from (-2, 0): y = sin t, and on the streak y = sin T - sin tau."""
    lines = last(gust, count, [[-2.0, 0, 0]], kind=kind)
    points, time = np.asarray(lines.points, dtype=float), np.asarray(lines["Time"])
    if kind == "pathlines":
        x, y = -2 + time, np.sin(time)
    else:
        x, y = -2 + END - time, np.sin(END) - np.sin(time)
    np.testing.assert_allclose(points[:, 0], x, atol=1e-6)
    return np.abs(points[:, 1] - y).max()


@pytest.mark.parametrize("kind", ["pathlines", "streaklines"])
def test_error_is_of_order_2_in_the_time_between_steps(kind):
    coarse, fine = _error(kind, 5), _error(kind, 17)
    assert np.log(coarse / fine) / np.log(4) == pytest.approx(2, abs=0.2)
    assert fine < 2e-3


def test_a_tail_is_as_long_as_asked_and_pathlines_are_lit_by_their_velocity():
    lines = last(gust, 9, [[-2.0, 0, 0]], tail=0.5)
    assert np.ptp(lines["Time"]) == pytest.approx(0.5, abs=0.1)
    np.testing.assert_allclose(lines["V"][:, 1], np.cos(lines["Time"]), atol=0.01)
    np.testing.assert_array_equal(lines["Tangents"], lines["V"])


def test_lines_end_at_the_boundary():
    lines = last(gust, 9, [[2.5, 0, 0]])
    assert 2.8 < lines.points[:, 0].max() <= 3 + 1e-9
    streak = last(gust, 9, [[2.5, 0, 0]], kind="streaklines")
    assert streak.n_lines == 1
    assert 2.8 < streak.points[:, 0].max() <= 3 + 1e-9


def test_a_reader_gives_what_the_list_gives(tmp_path):
    times = np.linspace(0, END, 4)
    series = steps(gust, times)
    rows = ""
    for i, (time, mesh) in enumerate(zip(times, series, strict=True)):
        mesh.save(tmp_path / f"{i}.vti")
        rows += f'<DataSet timestep="{time}" file="{i}.vti"/>'
    file = tmp_path / "flow.pvd"
    file.write_text(f'<VTKFile type="Collection"><Collection>{rows}</Collection></VTKFile>')
    options = {"tangents": "V", "seeds": [[-2.0, 0, 0]]}
    expected = list(vizlight.pathlines(series, SCENE, times=times, **options))[-1]
    for source in (file, pv.get_reader(file)):
        found = list(vizlight.pathlines(source, SCENE, **options))[-1]
        np.testing.assert_array_equal(found.points, expected.points)


def test_bundles_and_data_stay():
    times = np.linspace(0, 1, 3)
    series = steps(rotation, times)
    before = [mesh.copy() for mesh in series]
    frames = list(vizlight.pathlines(series, SCENE, times=times, tangents="V", bundle=True))
    assert "transmittance" in frames[-1].point_data
    assert frames[-1].n_lines > 150
    assert all(a == b for a, b in zip(series, before, strict=True))


TIMES = [0.0, 1.0, 2.0]


def other_points():
    meshes = steps(gust, TIMES)
    meshes[1].origin = (0, 0, 0)
    return meshes


def lacking():
    meshes = steps(gust, TIMES)
    del meshes[2].point_data["V"]
    return meshes


def series():
    return steps(gust, TIMES)


test_bad_input = refusals(
    lambda make, options: list(
        vizlight.pathlines(make(), SCENE, **{"times": TIMES, "tangents": "V", **options})
    ),
    (series, {"times": [0, 2, 1]}, "times: .*rise.*2 before"),
    (series, {"times": [0, 1]}, "times: expected 3 times"),
    (series, {"times": None}, "times: .*TimeValue"),
    (lambda: steps(gust, [0]), {"times": [0]}, "series: expected two steps"),
    (other_points, {}, r"series\[1\] \(time 1\): expected the 1875 points of"),
    (lacking, {}, r"series\[2\] \(time 2\): expected the point array 'V'"),
    (lambda: [1, 2, 3], {}, r"series\[0\] .*a mesh with cells"),
    (lambda: 3, {}, "series: expected meshes, a reader"),
    (series, {"seeds": [[9.0, 9, 9]]}, "seeds: expected points ins"),
    (series, {"kind": "timelines"}, "kind: expected"),
    (series, {"tail": 0}, "tail: expected"),
    (series, {"step": -1}, "step: expected"),
    (lambda: steps(lambda p, t: 0 * p, TIMES), {}, "seeds: .*not zero"),
    kind=(TypeError, ValueError),
)


def test_a_flow_too_fast_for_its_times_is_told():
    """A streak is carried in 100 steps at most between two times, however long these are."""

    def fast(points, time):
        return 10 * rotation(points, time)

    with pytest.warns(UserWarning, match="crosses up to .* cells between two times: streaklines"):
        last(fast, 2, [[1.0, 0, 0]], kind="streaklines")


@pytest.mark.parametrize(("unit", "size"), [("m/s", 1), ("cm/s", 0.01)])
def test_particles_on_a_map_go_metres_of_the_place(tmp_path, unit, size):
    """A wind of 10 m/s for 12 hours at 60 degrees north, where a degree of longitude is 55.6 km."""
    xr = pytest.importorskip("xarray")
    shape = (3, 9, 21)
    wind = {
        name: (("time", "lat", "lon"), np.full(shape, speed / size), {"units": unit})
        for name, speed in (("u", 10), ("v", 5))
    }
    axes = {
        "time": ("time", [0.0, 6, 12], {"units": "hours since 2000-01-01"}),
        "lat": np.linspace(56, 64, 9), "lon": np.linspace(-10, 10, 21),
    }  # fmt: skip
    xr.Dataset(wind, axes).to_netcdf(tmp_path / "w.nc")
    seeds = [[0.0, 60, 0]]
    *_, last = vizlight.pathlines(tmp_path / "w.nc", seeds=seeds, tangents=("u", "v"))
    end = np.asarray(last.points)[np.argmax(last["Time"])]
    degree = 6_371_008.8 * np.pi / 180
    north = 5 * 43_200 / degree
    np.testing.assert_allclose(end[1], 60 + north, rtol=1e-6)
    middle = np.radians(60 + north / 2)
    np.testing.assert_allclose(end[0], 10 * 43_200 / degree / np.cos(middle), rtol=1e-3)
    np.testing.assert_allclose(last["u,v"] * size, np.tile([10, 5, 0], (last.n_points, 1)), 1e-6)


@pytest.mark.sampled(4)
@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("kind", ["image", "rectilinear", "structured"])
def test_a_rotation_in_any_plane_gives_circles(axis, kind):
    mesh = pv.ImageData(dimensions=[1 if i == axis else 21 for i in range(3)])
    mesh = mesh if kind == "image" else getattr(mesh, f"cast_to_{kind}_grid")()
    mesh["V"] = np.cross(np.eye(3)[axis], np.asarray(mesh.points) - mesh.center)
    seeds = np.array([mesh.center]) + 7 * np.eye(3)[(axis + 1) % 3]
    *_, lines = vizlight.pathlines([mesh, mesh.copy()], times=[0, np.pi], tangents="V", seeds=seeds)
    radii = np.linalg.norm(np.asarray(lines.points) - mesh.center, axis=1)
    np.testing.assert_allclose(radii, 7, rtol=1e-6)
