"""Killed workers, a cluster that goes away and a full disk: the same result, or nothing."""

import functools
import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
import traces

from vizlight import Scene, View, pieces
from vizlight.files import FileError
from vizlight.pieces.workers import LOST, RetryingMap, repeated

PLAIN = Scene(view=View(direction=(0, 0, 1)))
#: A scheduler and a worker in one process, which prints the address.
CLUSTER = """
import asyncio, distributed
async def main():
    scheduler = await distributed.Scheduler(host="127.0.0.1", port=0, dashboard=False)
    worker = await distributed.Worker(scheduler.address, nthreads=1, dashboard=False)
    print(scheduler.address, flush=True)
    await scheduler.finished()
if __name__ == "__main__":
    asyncio.run(main())
"""
#: A script without a guard, which lights by processes.
SCRIPT = """
import vizlight
scene = vizlight.Scene(view=vizlight.View(direction=(0, 0, 1)))
lit = vizlight.pieces.light(
    "ball*.vtp", scene, ghost=0, map=vizlight.pieces.Processes(2), out="lit.pvtp"
)
print(len(lit.files))
"""


@pytest.fixture
def balls(tmp_path):
    for i in range(12):
        ball = pv.Sphere(center=(i, 0, 0), theta_resolution=10 + 90 * (i == 8), phi_resolution=60)
        ball.clear_data()
        ball.save(tmp_path / f"ball{i:02d}.vtp")
    return tmp_path


def light(folder, **options):
    return pieces.light(
        str(folder / "ball*.vtp"), PLAIN, ghost=0, out=folder / "lit.pvtp", **options
    )


def nothing_is_left(folder):
    return not (folder / "lit.pvtp").exists() and not (folder / "lit").exists()


def slabs(folder):
    """Return a grid in a memory-mapped array."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, 20)] * 3, indexing="ij")
    np.save(folder / "s.npy", (x**2 + 2 * y**2 + z**2).astype(np.float32))
    return pieces.Slabs({"s": np.load(folder / "s.npy", mmap_mode="r")})


GYROID = {"contour": "s", "level": 0.5, "normals": "gradient", "slab": 0.005}


def same(lit, expected):
    """Return whether the files of two results are the same, byte for byte."""
    pairs = zip(lit.files, expected.files, strict=True)
    return all(one.read_bytes() == other.read_bytes() for one, other in pairs)


def ends_after(count):
    """Return what makes a worker kill its process once so many pieces are written."""

    def arm():
        from vizlight.pieces import task

        light = task.light

        def fatal(piece, job, target, told):
            if len(list(target.parent.glob("*.vtp"))) >= count:
                os.kill(os.getpid(), signal.SIGKILL)
            return light(piece, job, target, told)

        task.light = fatal

    return arm


def test_a_killed_worker_leaves_nothing_and_the_result_is_the_same(tmp_path, client):
    source = slabs(tmp_path)
    expected = pieces.light(source, PLAIN, out=tmp_path / "one.pvtp", **GYROID)
    worker, pid = next(iter(client.run(os.getpid).items()))
    client.run(ends_after(1), workers=[worker])
    lit = pieces.light(source, PLAIN, out=tmp_path / "two.pvtp", map=client, **GYROID)
    assert pid not in client.run(os.getpid, on_error="ignore").values()
    with pytest.raises(pieces.PieceError, match=r"slices \[0:.*tangents: expected the name"):
        pieces.light(source, PLAIN, out=tmp_path / "three.pvtp", map=client.map, tangents="W")
    assert same(lit, expected)
    assert not list((tmp_path / "two").glob(".*"))


def killing(arguments):
    """Return a number by a process that is killed the first time."""
    number, mark = arguments
    if not Path(mark).exists():
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return number


def always_killed(_):
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="kills by a signal")
def test_calls_of_a_process_that_is_killed_are_made_again(tmp_path):
    work = pieces.Processes(2)
    calls = [(i, str(tmp_path / f"mark{i % 2}")) for i in range(6)]
    assert list(work(killing, calls)) == list(range(6))
    assert len(list(tmp_path.iterdir())) == 2
    del work
    work = pieces.Processes(1)
    one = pieces.sources.pieces_of(slabs(tmp_path), 64.0)[0]
    with pytest.raises(pieces.PieceError, match=r"piece slices \[0:19\]: workers ended while"):
        RetryingMap(work, 0, False).each(always_killed, [(one,)], "light")
    assert list(work(abs, [-1])) == [1], f"after {LOST} losses others start"


@pytest.mark.slow
def test_processes_and_their_threads_have_ended_with_the_object():
    for count in (0, "two"):
        with pytest.raises((ValueError, TypeError), match="count: expected an integer"):
            pieces.Processes(count)
    before = {*threading.enumerate(), *multiprocessing.active_children()}
    work = pieces.Processes(2)
    assert list(work(abs, [-1, 2])) == [1, 2]
    made = {*threading.enumerate(), *multiprocessing.active_children()} - before
    assert {type(one).__name__ for one in made} >= {"_ExecutorManagerThread", "SpawnProcess"}
    del work
    assert not any(one.is_alive() for one in made)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
def test_no_process_listens_and_a_script_needs_no_guard(balls):
    (balls / "script.py").write_text(SCRIPT, encoding="utf-8")
    seen = traces.watched([sys.executable, "script.py"], [], cwd=balls)
    assert seen.out == "12\n"
    assert seen.processes >= 3, "a parent and two processes"
    assert not seen.sockets


def test_executors_light_the_same(balls):
    expected = pieces.light(str(balls / "ball*.vtp"), PLAIN, ghost=0, out=balls / "one.pvtp")
    with ProcessPoolExecutor(1, multiprocessing.get_context("spawn")) as pool:
        for work in (pool, pool.map):
            assert same(light(balls, map=work), expected)


@pytest.mark.slow
def test_a_cluster_that_goes_away_is_named_and_nothing_is_left(balls):
    distributed = pytest.importorskip("distributed")
    quiet = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True}
    with subprocess.Popen([sys.executable, "-c", CLUSTER], **quiet) as cluster:
        assert cluster.stdout
        try:
            with distributed.Client(cluster.stdout.readline().strip(), timeout=10) as client:
                client.run(ends_after(3))
                with pytest.raises(pieces.PieceError, match=r"piece .*: its workers went away"):
                    light(balls, map=client)
        finally:
            cluster.kill()
    assert nothing_is_left(balls)


def test_a_disk_that_is_full_names_the_piece_and_nothing_is_left(balls, client):
    resource = pytest.importorskip("resource")
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    limit = functools.partial(resource.setrlimit, resource.RLIMIT_FSIZE)
    client.run(limit, (1 << 18, unlimited[1]))
    try:
        with pytest.raises(pieces.PieceError, match=r"piece .*ball08\.vtp: output: .* free disk"):
            light(balls, map=client)
    finally:
        client.run(limit, unlimited)
    # A task whose result nobody wants any more goes on.
    while any(client.run(lambda dask_worker: dask_worker.state.executing_count).values()):
        time.sleep(0.01)
    assert nothing_is_left(balls)
    assert len(light(balls, map=client).files) == 12


def test_errors_of_the_system_are_tried_again():
    calls = []

    def work(cause):
        calls.append(cause)
        if len(calls) < 3:
            error = FileError("not read")
            error.__cause__ = cause
            raise pieces.PieceError("piece a: not read") from error
        return len(calls)

    assert repeated(work, 2, (OSError("stale"),)) == 3
    for retries, cause in ((1, OSError("stale")), (2, None)):
        calls.clear()
        with pytest.raises(pieces.PieceError, match="not read"):
            repeated(work, retries, (cause,))
        assert len(calls) == (2 if cause else 1)
