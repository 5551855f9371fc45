"""The tables are those that the program works with, whatever version made them, with all that was in them."""

from __future__ import annotations

import json

import pytest
from alembic.script import ScriptDirectory
from sqlalchemy import Engine, event

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.errors import StoreError
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import Database, run_once
from tests.robot_bridge.gateway.storage.databases.old_database import make_old
from tests.support.databases.database_client import DatabaseClient


@pytest.fixture
def old_url(tmp_path) -> str:
    """A database of version 0.1.0 with a command under way."""
    make_old(tmp_path / "fleet.db")
    return f"sqlite:///{tmp_path}/fleet.db"


def opened(url):
    async def work():
        database = Database(url)
        try:
            await database.open()
        finally:
            await database.close()

    import asyncio

    asyncio.run(work())


def test_the_migrations_make_the_tables_that_the_program_works_with(empty_url):
    run_once(empty_url, revisions.create)
    assert run_once(empty_url, revisions.current) == revisions.NEEDED
    assert run_once(empty_url, revisions.differences) == []


def test_the_newest_migration_is_the_one_that_the_program_needs():
    assert ScriptDirectory(str(revisions.MIGRATIONS)).get_heads() == [revisions.NEEDED]


class DiedError(Exception):
    """The program ended in the middle of its work."""


def dies_after(statements, url):
    """Make or upgrade the tables, dying after so many changes; tell whether it did die."""
    left = statements

    def count(_connection, _cursor, statement, *_):
        nonlocal left
        left -= statement.split(maxsplit=1)[0].upper() in ("CREATE", "ALTER", "DROP", "INSERT", "UPDATE")
        if left == 0:
            raise DiedError(statement)

    event.listen(Engine, "after_cursor_execute", count)
    try:
        found = run_once(url, revisions.current)
        run_once(url, revisions.create if found is None else revisions.upgrade)
    except DiedError:
        return True
    finally:
        event.remove(Engine, "after_cursor_execute", count)
    return False


def test_what_was_cut_short_after_any_change_is_done_by_the_next_attempt(empty_url, kind, request):
    # Each attempt on a server that undoes what was cut short does all of it again.
    step, after = (10 if request.config.getoption("--release") else 35), 1
    while dies_after(after, empty_url):
        if kind == "mariadb":  # what was done stays, so that each attempt has less to do than the one before
            after += 1
        else:
            after += step
            assert run_once(empty_url, revisions.current) is None
    assert after > 15
    assert run_once(empty_url, revisions.differences) == []


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ("drop table audit", "add table: audit"),
        ("alter table commands drop column expires_at", "add column: commands, expires_at"),
        ("alter table commands add column colour varchar(9)", "remove column: commands, colour"),
        ("drop index ix_commands_state", "add index: ix_commands_state"),
    ],
)
def test_a_table_that_differs_is_named(url, kind, change, said):
    client = DatabaseClient(url)
    client.sql(f"{change} on commands" if kind == "mariadb" and "drop index" in change else change)
    client.close()
    assert any(said in difference for difference in run_once(url, revisions.differences))
    if kind == "mariadb":
        DatabaseClient(url).sql("drop table alembic_version")  # so that the next test makes another


def test_tables_of_others_in_the_same_database_are_no_difference(url, kind):
    client = DatabaseClient(url)
    client.sql("create table cafeteria (dish varchar(9))")
    client.close()
    assert run_once(url, revisions.differences) == []


def test_tables_are_not_made_twice(url):
    with pytest.raises(StoreError, match=f"the tables are there already, at revision {revisions.NEEDED}"):
        run_once(url, revisions.create)


def test_a_gateway_makes_only_a_missing_sqlite_database(empty_url, kind):
    if kind == "sqlite":
        opened(empty_url)
        assert run_once(empty_url, revisions.differences) == []
    else:
        with pytest.raises(StoreError, match=r"no tables of the bridge; make the tables with: robot-bridge"):
            opened(empty_url)
        assert run_once(empty_url, revisions.current) is None


def test_a_database_of_version_0_1_0_is_refused_with_the_command_that_upgrades_it(old_url):
    advice = f"revision 0001, .* needs {revisions.NEEDED}; back it up, then run: robot-bridge"
    with pytest.raises(StoreError, match=advice):
        opened(old_url)
    assert run_once(old_url, revisions.current) == "0001"


def test_a_database_of_version_0_1_0_is_upgraded_with_all_that_is_in_it(old_url):
    before = {table: rows(old_url, table) for table in ("robots", "sa", "commands", "command_steps")}
    assert run_once(old_url, revisions.upgrade) == "0001"
    assert run_once(old_url, revisions.differences) == []
    for table, old in before.items():
        new = rows(old_url, table)
        assert [row[: len(old[0])] for row in new] == old, table
    opened(old_url)


def test_ids_go_on_after_an_upgrade_where_they_were(old_url):
    run_once(old_url, revisions.upgrade)
    client = DatabaseClient(old_url)
    client.sql("insert into sa (robot, op) values ('r1', 'Start')")
    assert client.sql("select max(id) from sa") == [(901,)]


async def test_a_gateway_goes_on_with_the_commands_of_version_0_1_0(old_url, sample_site):
    import asyncio

    from robot_bridge.core.messages.robots import Ready
    from robot_bridge.core.sites.site import read_site
    from robot_bridge.gateway.fleet.service import Fleet
    from robot_bridge.gateway.site.site_maps import SiteMaps

    await asyncio.to_thread(run_once, old_url, revisions.upgrade)
    database = Database(old_url)
    await database.open()
    fleet = Fleet(SiteMaps(read_site(sample_site)), database, clock=ManualClock(wall=1001.0))
    await fleet.start()
    await fleet.outboxes.finish([await fleet.receive("r1", "websocket", Ready(7), 1)], [], acks=False)
    told = {row.op: row for row in await fleet.outboxes.outbox("r1", 0)}
    await database.close()
    assert told["SetPosEnd"].id == 41
    assert json.loads(told["SetPosEnd"].params)["x"] == 5


def test_a_database_of_a_newer_version_is_refused_and_left_alone(url):
    client = DatabaseClient(url)
    client.sql("update alembic_version set version_num = '9999'")
    try:
        for work in (opened, lambda url: run_once(url, revisions.upgrade)):
            with pytest.raises(StoreError, match=r"revision 9999.* belongs to a newer robot-bridge"):
                work(url)
        assert run_once(url, revisions.current) == "9999"
    finally:
        client.sql(f"update alembic_version set version_num = '{revisions.NEEDED}'")


def test_an_empty_database_has_nothing_to_upgrade(empty_url):
    with pytest.raises(StoreError, match="no tables to upgrade; make the tables with: robot-bridge"):
        run_once(empty_url, revisions.upgrade)


def rows(url, table):
    client = DatabaseClient(url)
    try:
        return client.sql(f"select * from {table} order by 1")
    finally:
        client.close()
