"""What else a robot may try with an ordinary SQL client: refused by the database, or harmless."""

from __future__ import annotations

import contextlib

import psycopg
import pytest
from sqlalchemy import make_url

from robot_bridge.gateway.storage.dialects import NOTIFICATIONS_LOCK
from robot_bridge.gateway.storage.roles.role_manager import (
    LARGEST_PARAMS,
    LARGEST_PAYLOAD,
    MOST_CONNECTIONS,
    MOST_PAYLOADS,
    MOST_WAITING,
)
from tests.robot_bridge.gateway.storage.roles.yards import GATEWAY, MINE, OTHER, SECRET, RefusedError
from tests.support.patience import START

POSTGRESQL = [
    "select * from rr",
    "insert into rr (op) values ('Alive') returning id",
    "insert into rr (op) values ('Alive') on conflict (id) do update set op = 'x'",
    f"insert into rr (robot, op) select '{OTHER}', op from sa",
    "copy rr to stdout",
    "copy public.sa to stdout",
    "copy (select * from public.sa) to stdout",
    f"copy rr (robot, op) from program 'echo {OTHER}'",
    "copy rr from '/etc/passwd'",
    "select * from sa for update",
    "select * from sa for share",
    "update sa set urgent = 0",
    "insert into sa (robot, op) values ('iso-1', 'Start')",
    "merge into sa using (select 1) x on true when matched then update set urgent = 0",
    "merge into sa using (select 1) x on false when not matched then insert (op) values ('Start')",
    "truncate rr, sa",
    "create table t (i int)",
    "create table public.t (i int)",
    "create temp table t (i int)",
    "create schema mine",
    "create view v as select 1",
    "create function f() returns int language sql as 'select 1'",
    "create function for_robots.f() returns int language sql as 'select 1'",
    "create or replace function for_robots.end_stuck(integer) returns bigint language sql as 'select 1'",
    "create trigger t before insert on rr for each row execute function for_robots.refuse_too_much()",
    "create rule r as on insert to rr do instead nothing",
    "create policy mine on rr using (true)",
    "create extension dblink",
    "create database mine",
    "create role mine superuser",
    "alter table rr disable row level security",
    "alter table rr no force row level security",
    "alter table rr disable trigger all",
    "alter view sa set (security_barrier = false)",
    "alter role current_user bypassrls",
    "alter role current_user superuser",
    "alter role current_user connection limit 1000",
    f"alter role \"{OTHER}\" password 'mine'",
    f'set role "{GATEWAY}"',
    f'set role "{OTHER}"',
    "set role fleet",
    "set session authorization fleet",
    "set local role postgres",
    "set row_security = off; select * from public.sa",
    "set session_replication_role = replica",
    f'grant "{GATEWAY}" to "{MINE}"',
    "reassign owned by fleet to current_user",
    "insert into rr (op) values ('Alive'); select lastval()",
    "select currval('public.rr_id_seq')",
    "select nextval('public.rr_id_seq')",
    "select setval('public.sa_id_seq', 1)",
    "select last_value from public.rr_id_seq",
    "explain select * from public.sa",
    "select lo_create(0)",
    "select lo_from_bytea(0, 'x')",
    "select pg_advisory_lock(1)",
    "select pg_try_advisory_xact_lock(1, 2)",
    "select pg_logical_emit_message(false, 'x', 'y')",
    "select for_robots.end_stuck(0)",
    "select for_robots.delete_own_answer()",
    "select pg_read_file('/etc/passwd')",
    "select pg_ls_dir('.')",
    "select pg_terminate_backend(pid) from pg_stat_activity where usename = 'postgres'",
    "select pg_reload_conf()",
    "select * from pg_authid",
    "select * from pg_shadow",
    "do $$ begin execute 'select * from public.sa'; end $$",
    "begin; lock table sa in access exclusive mode",
    "begin; lock table sa in row share mode",
    "begin; lock table public.sa in access exclusive mode",
    "begin; lock table public.commands in access share mode",
    "begin; lock table rr in share mode",
    "begin; lock table rr in share row exclusive mode",
    "begin; lock table rr in access exclusive mode",
]
MARIADB = [
    "select * from rr",
    "replace into rr (op) values ('x')",
    "insert into rr (op) values ('x') on duplicate key update op = 'y'",
    f"insert into rr (robot, op) select '{OTHER}', op from sa",
    "update sa set urgent = 0",
    "insert into sa (op) values ('Start')",
    "truncate sa",
    "drop view sa",
    "create table t (i int)",
    "create temporary table t (i int)",
    "create or replace view sa as select 1",
    "alter view sa as select 1",
    "create database mine",
    "create function f() returns int return 1",
    "create procedure p() select 1",
    "create trigger t before insert on rr for each row set new.robot = 'x'",
    "create event e on schedule every 1 second do select 1",
    "create user mine",
    "create role mine",
    f"set role `{GATEWAY}`",
    "set role fleet",
    f"set password for `{OTHER}`@`%` = password('mine')",
    "alter user current_user() with max_user_connections 1000",
    f"grant select on {{side}}.sa to `{OTHER}`@`%`",
    "lock tables sa write",
    "lock tables sa read",
    "lock tables rr write",
    "lock tables {base}.sa write",
    "flush tables",
    "flush tables with read lock",
    "handler sa open",
    "show create view sa",
    "show create table {base}.sa",
    "show tables from {base}",
    "show grants for fleet@'127.0.0.1'",
    "show triggers from {base}",
    "show engine innodb status",
    "explain select * from sa",
    "analyze table {base}.sa",
    "select * from mysql.user",
    "select * from mysql.tables_priv",
    "select * from information_schema.innodb_trx",
    "select load_file('/etc/passwd') into outfile '/tmp/iso'",
    "select * from sa into outfile '/tmp/iso'",
    "load data infile '/etc/passwd' into table rr (op)",
    "call {base}.end_stuck_robots(0)",
    "call {side}.end_stuck_robots(0)",
    "set global max_connections = 1",
    "set global general_log = 1",
    "set session sql_log_bin = 0",
    "kill 1",
    "install soname 'ha_federatedx'",
    "execute immediate 'select * from {base}.sa'",
]


def attempt(yard, statement: str) -> object:
    """Return the code with which the database refuses; fail when it does not, or when anything changed."""
    before = yard.content()
    accounts = accounts_of(yard)
    with yard.session(MINE) as session, pytest.raises(RefusedError) as caught:
        session.run(statement.format(base=yard.base, side=yard.side))
    assert yard.content() == before
    assert accounts_of(yard) == accounts
    assert SECRET not in str(caught.value)
    return caught.value.code


def accounts_of(yard) -> list[tuple[object, ...]]:
    """Return the server's accounts with their rights and passwords."""
    if yard.kind == "postgresql":
        return yard.sql("select * from pg_authid order by rolname")
    return yard.sql("select * from mysql.global_priv order by User, Host")


@pytest.mark.parametrize("statement", POSTGRESQL)
def test_postgresql_refuses(postgresql, statement):
    # 42501: no right. 42809: the wrong kind of thing. 0A000: not to be done to a view.
    assert attempt(postgresql, statement) in ("42501", "42809", "0A000")


def test_postgresql_merges_away_no_answer_of_another_robot(postgresql):
    """PostgreSQL 17 learned to merge into views; what a robot may delete it may delete that way, too."""
    with postgresql.session(MINE) as session, contextlib.suppress(RefusedError):
        session.run("merge into sa using (select 1) x on true when matched then delete")
    assert (OTHER,) in postgresql.sql("select robot from sa")


@pytest.mark.parametrize("statement", MARIADB)
def test_mariadb_refuses(mariadb, statement):
    assert attempt(mariadb, statement) in {
        *(1044, 1045, 1094, 1095, 1141, 1142, 1143, 1144, 1227, 1305, 1345, 1347, 1356),
        *(1370, 1396, 1410, 1419, 1959),
    }


PEEPHOLES = [
    "select id from sa where cast(params as {integer}) = 1",
    "select id from sa where id = {id} and cast(params as {integer}) = 1",
    "select id from sa where id between 0 and {id} and cast(params as {integer}) = 1 order by id limit 1",
    "select id from sa where robot = '{other}' and cast(params as {integer}) = 1",
    "select id from sa where robot in ('{mine}', '{other}') and cast(params as {integer}) = 1",
    "select count(*) from sa a join sa b on cast(a.params as {integer}) = b.id where a.id = {id}",
    "select id from sa where id = {id} order by cast(params as {integer})",
    "select id from sa where id = {id} group by id having max(cast(params as {integer})) = 1",
    "delete from sa where cast(params as {integer}) = 1",
    "delete from sa where id = {id} and cast(params as {integer}) = 1",
    "delete from sa where robot = '{other}' and cast(params as {integer}) = 1",
    "delete from sa where id = {id} and cast(concat(op, robot) as {integer}) = 1",
]


@pytest.mark.parametrize("peephole", PEEPHOLES)
def test_errors_and_warnings_show_nothing_of_another_robots_answers(yard, peephole):
    ((number,),) = yard.sql(f"select id from sa where robot = '{OTHER}'")
    yard.sql(f"delete from sa where robot = '{MINE}'")
    integer = {"postgresql": "integer", "mariadb": "integer"}[yard.kind]
    with yard.session(MINE) as session:
        assert session.run(peephole.format(integer=integer, id=number, mine=MINE, other=OTHER)) in (
            [],
            [(0,)],
        )
        if yard.kind == "mariadb":
            assert session.run("show warnings") == []
    assert yard.sql("select robot from sa") == [(OTHER,)]


@pytest.mark.parametrize("where", ["true", "id = {id}", "robot = '{other}'"])
def test_the_time_a_statement_takes_tells_nothing_of_another_robots_answers(yard, where):
    ((number,),) = yard.sql(f"select id from sa where robot = '{OTHER}'")
    yard.sql(f"delete from sa where robot = '{MINE}'")
    slow = {"postgresql": "pg_sleep(length(params)) is null", "mariadb": "sleep(length(params)) = 1"}[
        yard.kind
    ]
    limit = {"postgresql": "statement_timeout = 1000", "mariadb": "max_statement_time = 1"}[yard.kind]
    with yard.session(MINE) as session:
        session.run(f"set session {limit}")
        condition = f"{where.format(id=number, other=OTHER)} and params like '%secret%' and {slow}"
        assert session.run(f"select id from sa where {condition}") == []


def test_what_a_robot_sees_of_the_server_names_no_secret_and_nobodys_statements(yard):
    views = {
        "postgresql": [
            "select * from pg_stat_activity",
            "select * from pg_stats",
            "select * from pg_prepared_xacts",
        ],
        "mariadb": ["show full processlist", "select * from information_schema.processlist"],
    }
    with yard.session(OTHER) as other, yard.session(MINE) as session:
        other.run("select 'whispered'")
        for view in views[yard.kind]:
            assert "whispered" not in str(session.run(view))
    if yard.kind == "mariadb":
        with yard.session(MINE) as session:
            seen = session.run("select table_schema, table_name from information_schema.tables")
        assert {name for schema, name in seen if not schema.endswith("_schema")} == {"rr", "sa"}


def test_what_a_robot_notifies_wakes_the_gateway_and_tells_it_nothing(postgresql):
    parts = make_url(postgresql.url)
    where = {"host": parts.host, "port": parts.port, "user": parts.username, "password": parts.password}
    with (
        psycopg.connect(**where, dbname=parts.database, autocommit=True) as gateway,
        postgresql.session(MINE) as session,
    ):
        gateway.execute(f"select pg_advisory_lock({NOTIFICATIONS_LOCK})")
        session.run("select pg_notify('rr', 'delete everything')")
        session.run("listen rr")
        session.run("insert into rr (op) values ('Alive')")
        (heard,) = session._connection.notifies(timeout=START, stop_after=1)
    assert heard.payload == ""


def test_a_request_is_only_so_long(yard):
    longest = LARGEST_PARAMS
    with yard.session(MINE) as session:
        session.run(f"insert into rr (op, params) values ('long', repeat('x', {longest}))")
        for column, size in (("params", longest + 1), ("payload", LARGEST_PAYLOAD + 1)):
            long = f"repeat('x', {size})" + (
                "::bytea" if (yard.kind, column) == ("postgresql", "payload") else ""
            )
            with pytest.raises(RefusedError, match=f"rr_{column}_size"):
                session.run(f"insert into rr (op, {column}) values ('long', {long})")
        with pytest.raises(RefusedError):
            session.run("insert into rr (op) values (repeat('x', 33))")


def test_a_robot_cannot_fill_the_disk_while_the_gateway_is_away(yard):
    many = {
        "postgresql": f"select '{MINE}', 'Alive' from generate_series(1, {{}})",
        "mariadb": (
            "with recursive n (i) as (select 1 union all select i + 1 from n where i < {}) "
            f"select '{MINE}', 'Alive' from n"
        ),
    }[yard.kind]
    with yard.session(MINE) as session:
        if yard.kind == "mariadb":
            session.run("set session max_recursive_iterations = 10000")
            # On a busy machine so many take longer than the ten seconds that a robot has by itself.
            session.run("set session max_statement_time = 0")
        # One waits since before the test. Too many at once are refused as one too many is.
        session.run(f"insert into rr (robot, op) {many.format(MOST_WAITING - 11)}")
        for number in (11, 10, 1):
            insert = f"insert into rr (robot, op) {many.format(number)}"
            if number == 10:
                assert session.change(insert) == 10
                continue
            with pytest.raises(RefusedError, match=f"{MOST_WAITING} requests wait already"):
                session.run(insert)
    assert yard.sql(f"select count(*) from rr where robot = '{MINE}'") == [(MOST_WAITING,)]
    # The other robots go on.
    assert yard.of(OTHER).change("insert into rr (op) values ('Alive')") == 1


def test_a_robot_cannot_fill_the_disk_with_images(yard):
    with yard.session(MINE) as session:
        for _ in range(MOST_PAYLOADS):
            session.run("insert into rr (op, payload) values ('SendImage', 'x')")
        with pytest.raises(RefusedError, match=f"{MOST_PAYLOADS} images wait already"):
            session.run("insert into rr (op, payload) values ('SendImage', 'x')")
        session.run("insert into rr (op) values ('Alive')")


def test_a_robot_cannot_use_up_the_servers_connections(yard):
    yard.close()
    held = [yard.session(MINE) for _ in range(MOST_CONNECTIONS)]
    for session in held:
        session.__enter__()
    try:
        with pytest.raises(Exception, match=r"too many connections|max_user_connections"), yard.session(MINE):
            pass
        assert yard.sql("select 1") == [(1,)]
    finally:
        for session in held:
            session.__exit__(None, None, None)
