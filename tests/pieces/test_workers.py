"""Killed workers, a cluster that goes away and a full disk: nothing is lost or done again."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import pyvista as pv

from vizlight import Scene, View, pieces
from vizlight.files import FileError
from vizlight.pieces.workers import tried

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


def kept(folder):
    """Return how many pieces are finished; each file there is whole."""
    assert not (folder / "lit.pvtp").exists()
    found = list((folder / "lit").iterdir())
    assert {path.suffix for path in found} <= {".vtp", ".json"}
    assert all("luminance" in pv.read(path).point_data for path in found if path.suffix == ".vtp")
    return sum(path.suffix == ".json" for path in found)


def slabs(folder):
    """Return a grid in a memory-mapped array."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, 20)] * 3, indexing="ij")
    np.save(folder / "s.npy", (x**2 + 2 * y**2 + z**2).astype(np.float32))
    return pieces.Slabs({"s": np.load(folder / "s.npy", mmap_mode="r")})


def test_a_killed_worker_leaves_nothing_and_the_result_is_the_same(tmp_path, client):
    source = slabs(tmp_path)
    options = {"contour": "s", "level": 0.5, "normals": "gradient", "slab": 0.02}
    expected = pieces.light(source, PLAIN, out=tmp_path / "one.pvtp", workers=1, **options)
    pids = list(client.run(os.getpid).values())

    def kill():
        while len(list((tmp_path / "two").glob("*.vtp"))) < 2:
            time.sleep(0.01)
        os.kill(pids[0], signal.SIGKILL)

    killer = threading.Thread(target=kill)
    killer.start()
    lit = pieces.light(source, PLAIN, out=tmp_path / "two.pvtp", client=client, **options)
    killer.join()
    assert pids[0] not in client.run(os.getpid, on_error="ignore").values()
    with pytest.raises(pieces.PieceError, match=r"slices \[0:.*tangents: expected the name"):
        pieces.light(source, PLAIN, out=tmp_path / "three.pvtp", client=client, tangents="W")
    for one, other in zip(lit.files, expected.files, strict=True):
        assert one.read_bytes() == other.read_bytes()
    assert not list((tmp_path / "two").glob(".*"))


def test_a_cluster_that_goes_away_is_named_and_finished_pieces_are_kept(balls):
    pytest.importorskip("distributed")
    quiet = {"stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL, "text": True}
    with subprocess.Popen([sys.executable, "-c", CLUSTER], **quiet) as cluster:
        assert cluster.stdout
        address = cluster.stdout.readline().strip()

        def kill():
            while len(list((balls / "lit").glob("*.json"))) < 3:
                time.sleep(0.002)
            cluster.kill()

        killer = threading.Thread(target=kill)
        killer.start()
        with pytest.raises(
            pieces.PieceError, match=r"piece .*ball\d\d\.vtp: the cluster went away"
        ):
            light(balls, client=address)
        killer.join()
    finished = kept(balls)
    assert finished >= 3
    lit = light(balls, workers=1)
    assert (lit.reused, len(lit.files)) == (finished, 12)


def test_a_disk_that_is_full_names_the_piece_and_the_rest_is_kept(balls, client):
    resource = pytest.importorskip("resource")
    unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
    limit = functools.partial(resource.setrlimit, resource.RLIMIT_FSIZE)
    client.run(limit, (1 << 18, unlimited[1]))
    try:
        with pytest.raises(pieces.PieceError, match=r"piece .*ball08\.vtp: output: .* free disk"):
            light(balls, client=client)
    finally:
        client.run(limit, unlimited)
    # A task whose result nobody wants any more goes on.
    while any(client.run(lambda dask_worker: dask_worker.state.executing_count).values()):
        time.sleep(0.01)
    finished = kept(balls)
    assert 8 <= finished < 12
    lit = light(balls, client=client)
    assert (lit.reused, len(lit.files)) == (finished, 12)


def test_errors_of_the_system_are_tried_again():
    calls = []

    def work(cause):
        calls.append(cause)
        if len(calls) < 3:
            error = FileError("not read")
            error.__cause__ = cause
            raise pieces.PieceError("piece a: not read") from error
        return len(calls)

    assert tried(work, 2, OSError("stale")) == 3
    for retries, cause in ((1, OSError("stale")), (2, None)):
        calls.clear()
        with pytest.raises(pieces.PieceError, match="not read"):
            tried(work, retries, cause)
        assert len(calls) == (2 if cause else 1)
