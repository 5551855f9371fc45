"""A database of the tests' own PostgreSQL, and a NATS server."""

from __future__ import annotations

import pytest

from tests.support.errors import StageError


@pytest.fixture(scope="module")
def fleet_url(postgresql_server, new_database):
    """A PostgreSQL database with the tables, for the tests of one module."""
    return new_database("postgresql")


@pytest.fixture(scope="module")
def nats(tmp_path_factory):
    """A NATS server that can be killed and comes back."""
    from tests.support.nats_server import NatsServer

    try:
        server = NatsServer(tmp_path_factory.mktemp("nats"))
    except StageError as error:
        pytest.skip(str(error))
    with server:
        yield server
