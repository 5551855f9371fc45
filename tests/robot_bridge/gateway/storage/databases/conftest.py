"""Databases of each kind, with and without tables."""

from __future__ import annotations

import pytest

from tests.support.databases.database_maker import KINDS


@pytest.fixture(params=KINDS)
def kind(request) -> str:
    """The kind of the database."""
    return request.param


@pytest.fixture
def empty_url(kind, request, tmp_path) -> str:
    """A database without a table; on SQLite not even the file is there."""
    return f"sqlite:///{tmp_path}/fleet.db" if kind == "sqlite" else request.getfixturevalue(f"{kind}_url")


@pytest.fixture
def url(kind, new_database) -> str:
    """A database with the tables and nothing in them."""
    return new_database(kind)
