"""Every pair of account, table and statement of the paper's text: own allowed, everything else refused.

"On the robots requests table (RR) only robots are allowed to write, while the server may perform read and
delete operations ... secondary tables ... not accessible from the robots ... The server answer table, SA, can
only be written by the server while robots can only perform read and delete operation on it" (section IV). The
server also reads and deletes in SA here: it delivers what lies there to robots on WebSocket, and takes back
what is void.
"""

from __future__ import annotations

import pytest

from robot_bridge.gateway.storage.schema import metadata
from tests.robot_bridge.gateway.storage.roles.yards import GATEWAY, MINE, OTHER, RefusedError

SECONDARY = sorted(set(metadata.tables) - {"rr", "sa"})
STATEMENTS = ("select", "insert", "update", "delete", "truncate")
ALLOWED = {
    ("robot", "rr"): {"insert"},
    ("robot", "sa"): {"select", "delete"},
    ("server", "rr"): {"select", "delete"},
    ("server", "sa"): {"select", "insert", "delete"},
}
DENIED = {"42501", "42809", 1142, 1143, 1044, 1227}
"""No right; on PostgreSQL also: a view cannot be truncated. On MariaDB: denied on table, column, database."""

EVERY_PAIR = [
    (account, table, statement)
    for account in ("robot", "server")
    for table in ("rr", "sa")
    for statement in STATEMENTS
]


def text(table: str, statement: str) -> str:
    return {
        "select": f"select op, params from {table}",
        "insert": f"insert into {table} (robot, op, params) values ('{MINE}', 'Alive', 'new')",
        "update": f"update {table} set op = 'Ready'",
        "delete": f"delete from {table}",
        "truncate": f"truncate table {table}",
    }[statement]


def refused(yard, account: str, statement: str) -> object:
    """Return the code with which the database refused, after seeing that nothing changed."""
    before = yard.content()
    with pytest.raises(RefusedError) as caught:
        yard.of(account).run(statement)
    assert yard.content() == before
    return caught.value.code


@pytest.mark.parametrize(("who", "table", "statement"), EVERY_PAIR)
def test_rr_and_sa_are_open_to_each_account_for_its_own_statements_only(yard, who, table, statement):
    account = {"robot": MINE, "server": GATEWAY}[who]
    if statement not in ALLOWED[who, table]:
        assert refused(yard, account, text(table, statement)) in DENIED
        return
    with yard.session(account) as session:
        if statement == "select":
            found = session.run(text(table, statement))
            assert len(found) == (1 if who == "robot" else 2)
            assert who == "server" or found[0][1].startswith(MINE)
        else:
            assert session.change(text(table, statement)) == (
                1 if who == "robot" or statement == "insert" else 2
            )
    left = {("robot", "insert"): 3, ("server", "insert"): 3, ("robot", "delete"): 1, ("server", "delete"): 0}
    rows = yard.sql(f"select robot from {table}")
    assert len(rows) == left.get((who, statement), 2)
    assert (who, statement) != ("robot", "delete") or rows == [(OTHER,)]


@pytest.mark.parametrize("statement", STATEMENTS)
@pytest.mark.parametrize("table", ["rr", "sa"])
def test_the_tables_behind_what_robots_see_are_no_way_around(yard, table, statement):
    if yard.kind == "postgresql" and (table, statement) == ("rr", "insert"):
        # On PostgreSQL that is the table that robots write themselves.
        assert yard.of(MINE).change(text("public.rr", "insert")) == 1
        return
    assert refused(yard, MINE, text(f"{yard.base}.{table}", statement)) in DENIED


@pytest.mark.parametrize("table", [*SECONDARY, "alembic_version"])
def test_a_robot_reaches_no_secondary_table(yard, table):
    column = {"alembic_version": "version_num"}.get(table) or next(iter(metadata.tables[table].columns)).name
    for statement in (
        f"select * from {yard.base}.{table}",
        f"select count(*) from {yard.base}.{table}",
        f"insert into {yard.base}.{table} ({column}) values (null)",
        f"update {yard.base}.{table} set {column} = null",
        f"delete from {yard.base}.{table}",
        f"truncate table {yard.base}.{table}",
        f"drop table {yard.base}.{table}",
        f"alter table {yard.base}.{table} add column mine int",
    ):
        assert refused(yard, MINE, statement) in DENIED, statement


def test_the_gateway_works_on_every_secondary_table(yard):
    with yard.session(GATEWAY) as session:
        for table in SECONDARY:
            session.run(f"select * from {table}")
        session.run("insert into bridge (name, value) values ('isolation', 'a')")
        session.run("update bridge set value = 'b' where name = 'isolation'")
        assert session.change("delete from bridge where name = 'isolation' and value = 'b'") == 1


@pytest.mark.parametrize(
    "statement",
    [
        "create table t (i int)",
        "drop table commands",
        "alter table rr add column mine int",
        "create view v as select 1",
        "create function f() returns int return 1",
        "create index i on commands (op)",
    ],
)
def test_the_gateway_changes_no_table(yard, statement):
    with yard.session(GATEWAY) as session, pytest.raises(RefusedError) as caught:
        session.run(statement)
    # 42501 on PostgreSQL, for drop and alter with "must be owner".
    assert caught.value.code in DENIED


@pytest.mark.parametrize("name", [OTHER, GATEWAY, MINE.upper(), f"{MINE} ", f" {MINE}", "", "iso-%", "іso-1"])
def test_nobody_writes_under_another_name(yard, name):
    assert refused(yard, MINE, f"insert into rr (robot, op) values ('{name}', 'Stopped')") in DENIED


def test_a_request_without_a_name_gets_the_robots_own(yard):
    with yard.session(MINE) as session:
        session.run("insert into rr (op, params) values ('Alive', 'nameless')")
    assert yard.sql("select robot from rr where params = 'nameless'") == [(MINE,)]


NO_SUCH_COLUMN = 1054
"""what MariaDB says of a column that a view does not have, where it does not look at the rights first."""


@pytest.mark.parametrize("column", ["id", "created_at"])
def test_a_robot_gives_a_request_neither_number_nor_time(yard, column):
    value = {"id": "1", "created_at": "'2001-01-01 00:00:00'"}[column]
    error = refused(yard, MINE, f"insert into rr (op, {column}) values ('Alive', {value})")
    assert error in DENIED | {NO_SUCH_COLUMN}


def test_a_robot_cannot_delete_or_read_anothers_answer_by_its_number(yard):
    ((number,),) = yard.sql(f"select id from sa where robot = '{OTHER}'")
    with yard.session(MINE) as session:
        assert session.run(f"select * from sa where id = {number}") == []
        assert session.change(f"delete from sa where id = {number}") == 0
        assert session.change(f"delete from sa where robot = '{OTHER}' or 1 = 1") == 1
    assert yard.sql("select robot from sa") == [(OTHER,)]
