"""One cluster of two processes for all tests of pieces, which kill them."""

import multiprocessing
import os
import sys
import time

import pytest


@pytest.fixture(scope="session")
def _client():
    dask = pytest.importorskip("dask")
    distributed = pytest.importorskip("distributed")
    # Processes begin as copies of one that has imported the package, also in place of killed ones.
    method = "spawn" if sys.platform == "win32" else "forkserver"
    with dask.config.set({"distributed.worker.multiprocessing-method": method}):
        distributed.utils.get_mp_context()  # which chooses what is imported by itself, once
        if method == "forkserver":
            modules = ["distributed", "vizlight.pieces.run"]
            multiprocessing.get_context(method).set_forkserver_preload(modules)
        with (
            distributed.LocalCluster(
                n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None,
                scheduler_kwargs={"dashboard_address": ":0"}, silence_logs=50,
            ) as cluster,
            distributed.Client(cluster) as client,
        ):  # fmt: skip
            yield client


@pytest.fixture
def client(_client):
    """Return a client of two workers; one that a test killed has been started again."""
    # The scheduler may not know yet of one that is gone.
    for _ in range(600):
        if len(_client.run(os.getpid, on_error="ignore")) == 2:
            return _client
        time.sleep(0.05)
    pytest.fail("a worker that was killed has not been started again in 30 seconds")
