"""Databases for tests; those of PostgreSQL are given again: as new, or not at all."""

from __future__ import annotations

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.databases.database_client import DatabaseClient
from tests.support.databases.database_maker import DatabaseMaker

CHANGES = [
    "alter table rr add column seen boolean",
    "alter table sa rename to sa_away",
    "grant select on rr to public",
    "alter table robots enable row level security",
    "create function f() returns int language sql as 'select 1'",
    "alter table sa add check (op <> 'Abort')",
    "alter table sa disable trigger user",
]


@pytest.fixture
def client(new_database):
    client = DatabaseClient(new_database("postgresql"))
    yield client
    client.close()


async def test_tests_with_a_running_loop_are_given_one(tmp_path):
    client = DatabaseClient(DatabaseMaker(tmp_path, None)("sqlite"))
    assert client.sql("select count(*) from rr") == [(0,)]
    client.close()


def say(client):
    client.sql("insert into rr (robot, op) values ('r1', 'Ready')")
    return client.sql("select id, robot from rr")


def leave(client, new_database):
    """Close the connection and wait until the server has ended it: a loaded server does so later."""
    ((backend,),) = client.sql("select pg_backend_pid()")
    client.close()
    other = DatabaseClient(new_database.another("postgresql"))
    has_ended = "select not exists (select 1 from pg_stat_activity where pid = ?)"
    wait_until(lambda: other.sql(has_ended, backend) == [(True,)], what="the end of the connection")
    other.close()


def test_it_is_given_again_with_no_row_and_counts_from_one(client, new_database):
    assert say(client) == [(1, "r1")]
    leave(client, new_database)
    assert new_database("postgresql") == client.url.render_as_string(hide_password=False)
    assert say(client) == [(1, "r1")]


def test_nobody_is_given_what_another_is_connected_to(client, new_database):
    say(client)
    other = DatabaseClient(new_database("postgresql"))
    assert other.url != client.url
    assert other.sql("select id from rr") == []
    other.close()


@pytest.mark.parametrize("change", CHANGES)
def test_what_was_made_otherwise_is_not_given_again(client, new_database, change):
    client.sql(change)
    leave(client, new_database)
    assert new_database("postgresql") != client.url.render_as_string(hide_password=False)
