"""One cluster of two processes for all tests of pieces, which kill them."""

from __future__ import annotations

import pytest

from vizlight.pieces.workers import local_cluster


@pytest.fixture(scope="session")
def _client():
    distributed = pytest.importorskip("distributed")
    with local_cluster(2) as cluster, distributed.Client(cluster) as client:
        yield client


@pytest.fixture
def client(_client):
    """Return a client of two workers; one that a test killed has been started again."""
    _client.wait_for_workers(2)
    return _client
