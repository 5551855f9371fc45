"""Tables in memory."""

from __future__ import annotations

import pytest
from sqlalchemy import create_engine
from sqlalchemy.pool import StaticPool

from robot_bridge.gateway.storage.schema import metadata


@pytest.fixture
def connection():
    """A transaction on a new database with every table."""
    engine = create_engine("sqlite://", poolclass=StaticPool)
    metadata.create_all(engine)
    with engine.begin() as connection:
        yield connection
