"""A database of the test's own with accounts in it, and gateways whose site has other limits."""

from __future__ import annotations

import time

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.gateway.storage.database import Database
from tests.support.patience import BUSY


@pytest.fixture(params=["sqlite", "postgresql", "mariadb"])
def database_url(request, new_database):
    return new_database(request.param)


@pytest.fixture
async def database(database_url):
    database = Database(database_url)
    await database.open()
    yield database
    await database.close()


@pytest.fixture
def clock():
    """A clock that the test moves."""
    return ManualClock(wall=1_000_000.0)


@pytest.fixture(scope="session")
def close_code():
    """Wait for the end of a connection: ``close_code(wire)`` is (code, reason, seconds it took)."""
    from websockets.exceptions import ConnectionClosed

    def wait(wire, seconds: float = 5.0):
        began = time.monotonic()
        with pytest.raises(ConnectionClosed) as caught:
            while True:
                wire.connection.recv(began + BUSY * seconds - time.monotonic())
        received = caught.value.rcvd
        return (
            received.code if received else None,
            received.reason if received else "",
            time.monotonic() - began,
        )

    return wait


@pytest.fixture(scope="session")
def refused():
    """Return the status and the text with which a WebSocket was not opened."""
    from websockets.exceptions import InvalidStatus

    def attempt(connect):
        with pytest.raises(InvalidStatus) as caught:
            connect()
        response = caught.value.response
        return response.status_code, bytes(response.body).decode()

    return attempt
