"""Accounts are made, changed and taken away whole, by whoever may, and leave nothing behind."""

from __future__ import annotations

import contextlib
import urllib.parse

import pytest

from robot_bridge.core.errors import StoreError
from robot_bridge.gateway.model.robots import Robot
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.repositories import robots as stored_robots
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from robot_bridge.gateway.storage.roles.role_manager import AccountError
from robot_bridge.gateway.storage.schema import metadata
from tests.robot_bridge.gateway.storage.roles.yards import GATEWAY, MINE, OTHER, ROBOTS, RefusedError, Yard
from tests.support.bridge.command_line import run_command

NAME = "Iso.3-x_1"


def run(yard, *arguments: str):
    return run_command(*arguments, "--database", yard.admin)


@pytest.fixture
def added(yard):
    """The yard with one robot more, which is taken away again."""
    done = run(yard, "robots", "add", NAME)
    assert done.returncode == 0, done.stderr
    yard.passwords[NAME] = done.stdout.strip()
    yield yard
    with contextlib.suppress(Exception):
        run_once(yard.admin, lambda connection: role_manager_on(connection).remove_robot(NAME))


def test_the_password_is_printed_once_and_alone_and_stands_in_no_log(added):
    assert len(added.passwords[NAME]) == 32
    assert added.passwords[NAME] not in (added.server.folder / "server.log").read_text(errors="replace")
    listed = run(added, "robots", "list").stdout.splitlines()
    assert [line.split("\t") for line in listed] == [[n, "database account"] for n in sorted((*ROBOTS, NAME))]


def test_a_second_robot_of_that_name_is_refused_with_what_to_do(added):
    done = run(added, "robots", "add", NAME)
    assert (done.returncode, done.stdout) == (1, "")
    assert f"robots rotate {NAME}" in done.stderr
    assert f"robots remove {NAME}" in done.stderr


def test_removing_a_robot_ends_its_connection_and_takes_everything_of_it(added):
    with added.session(NAME) as session:
        session.run("insert into rr (op) values ('Alive')")
        added.sql(f"insert into sa (robot, op) values ('{NAME}', 'Start')")
        session.run("begin")
        session.run("select * from sa")
        done = run(added, "robots", "remove", NAME)
        assert done.returncode == 0, done.stderr
        with pytest.raises(RefusedError):
            session.run("select 1")
    with pytest.raises(Exception, match=r"authentication failed|Access denied"), added.session(NAME):
        pass
    for table in ("rr", "sa"):
        assert added.sql(f"select robot from {table} order by robot") == [(name,) for name in ROBOTS]
    again = run(added, "robots", "add", NAME)
    assert again.returncode == 0, again.stderr


def test_rotating_ends_the_connection_and_the_old_password(added):
    with added.session(NAME) as session:
        done = run(added, "robots", "rotate", NAME)
        assert done.returncode == 0, done.stderr
        with pytest.raises(RefusedError):
            session.run("select 1")
    with pytest.raises(Exception, match=r"authentication failed|Access denied"), added.session(NAME):
        pass
    added.passwords[NAME] = done.stdout.strip()
    with added.session(NAME) as session:
        assert session.run("select op from sa") == []


def test_a_password_of_ones_own_choice_comes_out_of_a_file(added, tmp_path):
    file = tmp_path / "password"
    file.write_text('it\'s a "pass" \\ word; -- %s\n', encoding="utf-8")
    file.chmod(0o600)
    done = run(added, "robots", "rotate", NAME, "--password-file", str(file))
    assert (done.returncode, done.stdout) == (0, "")
    added.passwords[NAME] = urllib.parse.quote('it\'s a "pass" \\ word; -- %s', safe="")
    with added.session(NAME) as session:
        assert session.run("select op from sa") == []
    file.chmod(0o644)
    assert "chmod 600" in run(added, "robots", "rotate", NAME, "--password-file", str(file)).stderr


@pytest.mark.parametrize(
    "name",
    [
        "x'; drop table rr; --",
        'x"; drop table rr; --',
        "x`",
        "a@b",
        "%",
        "",
        "ö",
        "a b",
        "a\\",
        "a" * 64,
        "-x",
    ],
)
def test_hostile_names_are_refused(yard, name):
    before = yard.content()
    for make in ("add_robot", "add_gateway"):
        with pytest.raises(Exception, match="cannot be used"):
            run_once(
                yard.admin,
                lambda connection, make=make: getattr(role_manager_on(connection), make)(name, "x"),
            )
    for change in (("remove_robot",), ("rotate_robot", "x")):
        with pytest.raises(AccountError, match="has no account"):
            run_once(
                yard.admin, lambda c, change=change: getattr(role_manager_on(c), change[0])(name, *change[1:])
            )
    assert yard.content() == before


@pytest.mark.parametrize(
    "name", [GATEWAY, "fleet", "postgres", "root", "mysql", "public", "pg_monitor", "none"]
)
def test_names_that_are_somebody_elses_are_refused_and_cannot_be_removed(yard, name):
    own = {"postgresql": {"root", "mysql"}, "mariadb": {"postgres", "pg_monitor"}}[yard.kind]
    if name not in own:
        with pytest.raises(AccountError, match=r"another (name|one)"):
            run_once(yard.admin, lambda connection: role_manager_on(connection).add_robot(name, "x"))
    with pytest.raises(AccountError, match="has no account"):
        run_once(yard.admin, lambda connection: role_manager_on(connection).remove_robot(name))
    assert yard.of(GATEWAY).run("select 1") == [(1,)]


def test_names_that_mariadb_takes_for_the_same_are_refused(mariadb):
    with pytest.raises(AccountError, match="capital"):
        run_once(mariadb.admin, lambda connection: role_manager_on(connection).add_robot(MINE.upper(), "x"))


def test_only_an_administrator_makes_accounts(yard):
    for account in (MINE, GATEWAY):
        done = run_command("robots", "add", "iso-9", "--database", yard.address(account))
        assert done.returncode == 1
        assert done.stderr.startswith("robot-bridge: ")
        assert "Traceback" not in done.stderr
        assert yard.passwords[account] not in done.stderr
        for work in (
            lambda keeper: keeper.remove_robot(OTHER),
            lambda keeper: keeper.add_gateway("iso-8", "x"),
        ):
            with pytest.raises((StoreError, AccountError), match=r"denied|must be|no account"):
                run_once(
                    yard.address(account), lambda connection, work=work: work(role_manager_on(connection))
                )
    assert run_once(yard.admin, lambda connection: role_manager_on(connection).robots()) == sorted(ROBOTS)


def test_a_failure_on_the_way_leaves_no_half_account(yard, monkeypatch):
    from robot_bridge.gateway.storage.roles import mariadb, postgresql

    kind = {"postgresql": postgresql.PostgreSqlRoles, "mariadb": mariadb.MariaDbRoles}[yard.kind]
    original = kind._do

    def failing(self, statement):
        if statement.startswith("grant select, delete on"):
            raise AccountError("the power went")
        original(self, statement)

    monkeypatch.setattr(kind, "_do", failing)
    with pytest.raises(AccountError, match="the power went"):
        run_once(yard.admin, lambda connection: role_manager_on(connection).add_robot("iso-7", "x"))
    monkeypatch.undo()
    assert run_once(yard.admin, lambda connection: role_manager_on(connection)._exists("iso-7")) is False


def test_two_databases_of_one_server_know_nothing_of_each_other(yard):
    url = yard.server.new_database()
    run_once(url, revisions.create)
    other = Yard(yard.server, url, {})
    with pytest.raises(AccountError, match="no robot of this database"):
        run_once(other.admin, lambda connection: role_manager_on(connection).add_robot(MINE, "x"))
    done = run(other, "robots", "add", "iso-6")
    assert done.returncode == 0, done.stderr
    try:
        address = yard.server.url(yard.side, "iso-6", done.stdout.strip())
        with pytest.raises(Exception, match=r"denied"):
            run_once(address, revisions.current)
    finally:
        assert run(other, "robots", "remove", "iso-6").returncode == 0


def test_after_an_upgrade_the_gateway_may_use_the_new_tables(yard):
    yard.sql("create table novelty (i int)")
    try:
        with pytest.raises(RefusedError):
            yard.of(GATEWAY).run("select * from novelty")
        done = run(yard, "database", "upgrade")
        assert done.returncode == 0, done.stderr
        assert yard.of(GATEWAY).run("select * from novelty") == []
        for name in metadata.tables:
            yard.of(GATEWAY).run(f"select 1 from {name}")
        with pytest.raises(RefusedError):
            yard.of(GATEWAY).run(f"insert into rr (robot, op) values ('{MINE}', 'Alive')")
        with pytest.raises(RefusedError):
            yard.of(MINE).run(f"select * from {yard.base}.novelty")
    finally:
        yard.sql("drop table novelty")


def robots_side(mariadb: Yard) -> set[tuple[str, ...]]:
    """Return of which version what robots meet on MariaDB is, and what it is."""
    side = f"'{mariadb.side}'"
    return {
        *mariadb.sql(f"select schema_comment from information_schema.schemata where schema_name = {side}"),
        *mariadb.sql(f"select view_definition from information_schema.views where table_schema = {side}"),
        *mariadb.sql(
            "select action_statement from information_schema.triggers "
            f"where trigger_schema = '{mariadb.name}' and trigger_name = 'rr_of_whom'"
        ),
    }


@pytest.mark.parametrize("words", [("database", "upgrade"), ("robots", "add", NAME)])
def test_what_robots_meet_is_replaced_where_an_older_version_made_it(mariadb, words):
    made = robots_side(mariadb)
    keeper = f"'{mariadb.name}_keeper'@'localhost'"
    mariadb.sql(
        f"create or replace definer = {keeper} sql security definer view {mariadb.side}.sa as "
        f"select id, robot, op, params, payload, created_at, urgent from {mariadb.name}.sa "
        "force index (ix_sa_robot) where robot = substring_index(user(), '@', 1)"
    )
    mariadb.sql(
        f"create or replace definer = {keeper} trigger {mariadb.name}.rr_of_whom before insert "
        f"on {mariadb.name}.rr for each row set new.robot = substring_index(user(), '@', 1)"
    )
    mariadb.sql(f"alter database {mariadb.side} comment 'robots'' side of the fleet, version 1'")
    assert len(made - robots_side(mariadb)) == len(["version", "view", "trigger"])
    done = run(mariadb, *words)
    assert done.returncode == 0, done.stderr
    assert robots_side(mariadb) == made
    assert mariadb.of(MINE).run("select robot from sa") == [(MINE,)]
    if "add" in words:
        run_once(mariadb.admin, lambda connection: role_manager_on(connection).remove_robot(NAME))


def test_on_sqlite_a_robot_gets_a_token_and_no_password(tmp_path):
    url = f"sqlite:///{tmp_path / 'fleet.db'}"
    run_once(url, revisions.create)

    def sqlite(*arguments):
        return run_command(*arguments, "--database", url)

    made = sqlite("robots", "add", "r1")
    assert made.stdout.startswith("fleet_robot_")
    assert "robots rotate r1" in sqlite("robots", "add", "r1").stderr
    assert sqlite("robots", "list").stdout == "r1\ttoken\n"
    assert sqlite("robots", "rotate", "r1").stdout != made.stdout
    assert "leave --password-file out" in sqlite("robots", "add", "r2", "--password-file", "x").stderr
    assert sqlite("robots", "remove", "r1").returncode == 0
    assert sqlite("robots", "list").stdout == ""
    assert "SQLite has no accounts" in sqlite("database", "account", "gateway").stderr


def test_on_sqlite_a_robot_that_was_never_given_a_token_is_removed(tmp_path):
    url = f"sqlite:///{tmp_path / 'fleet.db'}"
    run_once(url, revisions.create)
    gone, stays = (stored_robots.row(Robot(name, 1, "websocket", 1.0)) for name in ("r1", "r2"))
    run_once(url, lambda connection: stored_robots.save(connection, [gone, stays]))
    assert run_command("robots", "remove", "r1", "--database", url).returncode == 0
    assert run_once(url, stored_robots.names) == ["r2"]
    assert "'r1' is not known" in run_command("robots", "remove", "r1", "--database", url).stderr
