"""What a robot locks holds up the gateway for a moment only, whatever limits the robot sets itself."""

from __future__ import annotations

import asyncio
import contextlib
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from robot_bridge.core.messages.robots import Abort, OpAck, SetMap
from robot_bridge.gateway.fleet import emergency_persistence, robot_outboxes
from robot_bridge.gateway.fleet.robot_outboxes import RequestOutcome
from robot_bridge.gateway.storage.database import Database, run_once
from robot_bridge.gateway.storage.repositories import requests
from robot_bridge.gateway.storage.repositories import requests as answers
from robot_bridge.gateway.storage.roles.blocking_sessions import end_blocking_sessions
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from tests.robot_bridge.gateway.storage.roles.yards import GATEWAY, MINE, OTHER, RefusedError
from tests.support.bridge.bridge_programs import wait_until

NO_LIMITS = {
    "postgresql": [
        "set statement_timeout = 0",
        "set lock_timeout = 0",
        "set idle_in_transaction_session_timeout = 0",
        "set session characteristics as transaction isolation level serializable",
    ],
    "mariadb": [
        "set session max_statement_time = 0",
        "set session idle_transaction_timeout = 0",
        "set session transaction isolation level serializable",
    ],
}
AT_ONCE = {
    "postgresql": "set lock_timeout = '100ms'",
    "mariadb": "set session innodb_lock_wait_timeout = 0",
}
"""Has a session be refused what it would have to wait for."""


@pytest.fixture
def greedy(yard):
    """A robot's connection without any limits, in a transaction."""
    with yard.session(MINE) as session:
        for statement in NO_LIMITS[yard.kind]:
            session.run(statement)
        session.run("begin")
        yield session


async def gateways_turn(yard) -> float:
    """Do what the gateway does, as it does it; return the seconds it took."""
    database = Database(yard.address(GATEWAY))
    began = time.monotonic()
    try:
        await database.run(requests.read_requests)
        for robot in (MINE, OTHER):
            await database.run(answers.remove_kinds, [robot], ["Start"])
            await database.run(answers.add, robot, Abort())
        return time.monotonic() - began
    finally:
        await database.close()


@pytest.mark.parametrize(
    "statement",
    [
        "delete from sa",
        "delete from sa where op = 'nothing like this'",
        "insert into rr (op) values ('Alive')",
        "select * from sa",
    ],
)
async def test_an_open_transaction_holds_up_the_gateway_for_two_seconds_at_most(yard, greedy, statement):
    greedy.run(statement)
    await asyncio.sleep(1.1)
    assert await gateways_turn(yard) < 9
    waiting = yard.sql("select robot, op from sa order by robot")
    assert [row for row in waiting if row[1] == "Abort"] == [(MINE, "Abort"), (OTHER, "Abort")]


def test_what_a_robot_has_not_committed_holds_up_no_other_robots_requests(yard):
    with yard.session("admin") as admin, yard.session(MINE) as hesitant, yard.session(OTHER) as other:
        # Whoever still looks at an older state keeps deleted rows there, which look like many to the server.
        admin.run("begin")
        admin.run("select * from rr")
        for _ in range(50):
            other.run("insert into rr (op) values ('Alive')")
        yard.empty()
        hesitant.run("begin")
        hesitant.run("insert into rr (op) values ('Alive')")
        hesitant.run("insert into rr (op, payload) values ('SendImage', 'x')")
        other.run(AT_ONCE[yard.kind])
        other.run("insert into rr (op) values ('Alive')")
        other.run("insert into rr (op, payload) values ('SendImage', 'x')")
        hesitant.run("rollback")
    assert yard.sql("select robot, op from rr order by id") == [(OTHER, "Alive"), (OTHER, "SendImage")]


@contextlib.contextmanager
def hesitating(yard):
    """A robot's connection in a transaction, on either database with the locks of READ COMMITTED."""
    with yard.session(MINE) as session:
        if yard.kind == "mariadb":
            session.run("set session transaction isolation level read committed")
        session.run("begin")
        yield session


def answer_at_once(connection):
    """Deal with the other robot's requests, and stop everybody, as the gateway does; fail where it waits."""
    connection.exec_driver_sql(AT_ONCE["mariadb" if connection.dialect.name == "mariadb" else "postgresql"])
    rows, _ = robot_outboxes.read_requests(connection, [])
    done = [RequestOutcome(row.robot, OpAck(id=row.id), SetMap(b"")) for row in rows if row.robot == OTHER]
    told = [message for outcome in done for message in outcome.rows(acks=True)]
    robot_outboxes.finish_requests(connection, done, told, [row.id for row in rows if row.robot == OTHER], [])
    answers.remove_everywhere(connection, ["SetPath"])


@pytest.mark.parametrize("number", [1, 2, 12, 300])
def test_what_a_robot_has_not_committed_holds_up_no_other_robots_answers(yard, number):
    yard.sql(f"insert into sa (robot, op) values ('{OTHER}', 'SetPath'), ('{OTHER}', 'SetMap')")
    with hesitating(yard) as hesitant:
        hesitant.run("insert into rr (op) values ('Alive')")
        hesitant.run("delete from sa")
        for _ in range(number - 1):
            yard.of(OTHER).run("insert into rr (op) values ('Alive')")
        run_once(yard.address(GATEWAY), answer_at_once)
        hesitant.run("commit")
    assert [robot for (robot,) in yard.sql("select robot from rr")] == [MINE, MINE]
    told = [op for _, op in yard.sql("select robot, op from sa order by id") if op != "Start"]
    assert told == ["OpAck", "SetMap"] * number


def stop_at_once(connection):
    # Not 0 as above, for which MariaDB's "skip locked" has no answer but an error.
    limits = {**AT_ONCE, "mariadb": "set session innodb_lock_wait_timeout = 1"}
    connection.exec_driver_sql(limits[connection.dialect.name])
    emergency_persistence._write_bare(connection, [MINE, OTHER])


def aborted(yard):
    return [robot for (robot,) in yard.sql("select robot from sa where op = 'Abort' order by robot")]


def test_what_a_robot_is_just_reading_keeps_no_stop_from_the_others(yard):
    yard.sql(f"insert into sa (robot, op) values ('{MINE}', 'SetPosEnd'), ('{OTHER}', 'SetPosEnd')")
    with hesitating(yard) as hesitant:
        hesitant.run("delete from sa where op = 'SetPosEnd'")
        run_once(yard.address(GATEWAY), stop_at_once)
        assert yard.sql("select robot from sa where op = 'SetPosEnd'") == [(MINE,)]
        assert aborted(yard) == [MINE, OTHER]
        hesitant.run("rollback")


def test_a_gateway_that_may_lock_no_rows_stops_all_the_same_and_an_upgrade_lets_it(postgresql, caplog):
    postgresql.sql(f'revoke update (urgent) on sa from "{GATEWAY}"')
    for times in (1, 2):
        caplog.clear()
        postgresql.sql(f"insert into sa (robot, op) values ('{MINE}', 'SetPosEnd')")
        run_once(postgresql.address(GATEWAY), stop_at_once)
        assert postgresql.sql("select robot from sa where op = 'SetPosEnd'") == []
        assert aborted(postgresql) == [MINE] * times + [OTHER] * times
        assert caplog.text.count("robot-bridge database upgrade") == 1
    run_once(postgresql.admin, lambda connection: role_manager_on(connection).renew_rights())
    caplog.clear()
    run_once(postgresql.address(GATEWAY), stop_at_once)
    assert "database upgrade" not in caplog.text


def test_a_gateway_changes_no_answer_of_a_robot(postgresql):
    with postgresql.session(GATEWAY) as gateway, pytest.raises(RefusedError, match="row-level security"):
        gateway.run("update sa set urgent = 1")


async def test_a_lock_for_update_holds_it_up_no_longer(mariadb):
    with mariadb.session(MINE) as session:
        for statement in [*NO_LIMITS["mariadb"], "begin", "select * from sa for update"]:
            session.run(statement)
        await asyncio.sleep(1.1)
        assert await gateways_turn(mariadb) < 9
        with pytest.raises(RefusedError):
            session.run("select 1")


async def test_a_forsaken_xa_transaction_holds_it_up_no_longer(mariadb):
    with mariadb.session(MINE) as session:
        for statement in [
            *NO_LIMITS["mariadb"],
            "xa start 'a'",
            "delete from sa",
            "xa end 'a'",
            "xa prepare 'a'",
        ]:
            session.run(statement)
    await asyncio.sleep(1.1)
    assert await gateways_turn(mariadb) < 9
    assert mariadb.sql("xa recover") == []


def test_a_robot_that_sets_itself_no_limits_has_ten_seconds(yard):
    limits = {
        "postgresql": ["statement_timeout", "lock_timeout", "idle_in_transaction_session_timeout"],
        "mariadb": ["max_statement_time"],
    }[yard.kind]
    for limit in limits:
        show = f"show {limit}" if yard.kind == "postgresql" else f"select @@{limit}"
        assert yard.of(MINE).run(show) in ([("10s",)], [(10.0,)])


def test_a_robots_transaction_ends_when_it_takes_too_long(yard, greedy):
    greedy.run("select * from sa")
    time.sleep(1.1)
    with yard.session("admin") as admin:
        admin.run(
            "select for_robots.end_stuck(30)" if yard.kind == "postgresql" else "call end_stuck_robots(30)"
        )
        assert len(greedy.run("select 1")) == 1
        admin.run(
            "select for_robots.end_stuck(1)" if yard.kind == "postgresql" else "call end_stuck_robots(1)"
        )
    with pytest.raises(RefusedError):
        greedy.run("select 1")


def test_a_robots_statement_ends_when_it_takes_too_long(yard):
    sleep = {"postgresql": "select pg_sleep(60)", "mariadb": "select sleep(60)"}[yard.kind]
    with yard.session(MINE) as session, ThreadPoolExecutor(1) as thread:
        for statement in NO_LIMITS[yard.kind]:
            session.run(statement)
        sleeping = thread.submit(session.run, sleep)

        def has_ended():
            run_once(yard.address(GATEWAY), end_blocking_sessions, 2)
            return sleeping.done()

        wait_until(has_ended)
        with pytest.raises(RefusedError):
            sleeping.result()


def test_others_transactions_are_left_alone(yard):
    with yard.session("admin") as admin, yard.session(GATEWAY) as gateway:
        gateway.run("begin")
        gateway.run("select * from rr")
        admin.run("begin")
        admin.run("insert into bridge (name, value) values ('blocking', 'x')")
        time.sleep(1.1)
        run_once(yard.address(GATEWAY), end_blocking_sessions, 1)
        assert gateway.run("select 1") == admin.run("select 1") == [(1,)]
        admin.run("rollback")
