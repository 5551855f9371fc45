"""One database of each kind with accounts in it; every test finds one row of each robot in RR and in SA."""

from __future__ import annotations

import pytest

from tests.robot_bridge.gateway.storage.roles.yards import make_yard, remove_accounts


@pytest.fixture(scope="session")
def postgresql_yard(postgresql_server):
    yard = make_yard(postgresql_server)
    yield yard
    yard.close()
    remove_accounts(yard)


@pytest.fixture(scope="session")
def mariadb_yard(mariadb_server):
    yard = make_yard(mariadb_server)
    yield yard
    yard.close()
    remove_accounts(yard)


@pytest.fixture
def filled():
    """Fill a yard anew."""

    def fill(yard):
        yard.empty()
        yard.fill()
        return yard

    return fill


@pytest.fixture(params=["postgresql", "mariadb"])
def yard(request, filled):
    """A database of each kind in turn."""
    return filled(request.getfixturevalue(f"{request.param}_yard"))


@pytest.fixture
def postgresql(postgresql_yard, filled):
    """PostgreSQL alone."""
    return filled(postgresql_yard)


@pytest.fixture
def mariadb(mariadb_yard, filled):
    """MariaDB alone."""
    return filled(mariadb_yard)
