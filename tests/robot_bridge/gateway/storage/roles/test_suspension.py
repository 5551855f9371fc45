"""An account that keeps the others waiting again and again loses its connections for a while."""

from __future__ import annotations

import asyncio
import contextlib
import statistics
import threading
import time
import uuid

import psycopg
import pymysql
import pytest
import sqlalchemy

from robot_bridge.core.clock import ManualClock
from robot_bridge.gateway.fleet import link_supervision
from robot_bridge.gateway.fleet.link_supervision import AccountSuspensions
from robot_bridge.gateway.storage.database import Database, run_once
from robot_bridge.gateway.storage.roles import blocking_sessions
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from robot_bridge.gateway.storage.wakeups import GATEWAY_CHANNEL
from tests.robot_bridge.gateway.storage.roles.yards import GATEWAY, MINE, OTHER, RefusedError
from tests.support.bridge.bridge_programs import Bridge, wait_until
from tests.support.processes import Processes

FLOOD = "select count(pg_notify('rr', n::text)) from generate_series(1, 2000) n"


class Desks:
    """Notes what desks are told."""

    def __init__(self):
        self.reported = []

    def announce(self, method, _key, params):
        assert method == "suspensions"
        self.reported.append([(one["robot"], one.get("until") is not None) for one in params["robots"]])


class Commands:
    """Knows the robots to which an Abort is on its way."""

    def __init__(self, *awaiting):
        self.awaiting = set(awaiting)

    def awaits_any_abort(self, robot):
        return robot in self.awaiting


@pytest.fixture(autouse=True)
def connections_are_new(postgresql_yard, mariadb_yard):
    """What other tests left open is ended here: they open it anew."""
    yield
    postgresql_yard.close()
    mariadb_yard.close()


@pytest.fixture
async def database(yard):
    database = Database(yard.address(GATEWAY))
    yield database
    for robot in (MINE, OTHER):
        await database.run_aside(blocking_sessions.set_suspended, robot, False)
    await database.run(blocking_sessions.store_suspensions, {})
    await database.close()


def can_connect(yard, robot=MINE):
    try:
        with yard.session(robot) as session:
            return session.run("select 1") == [(1,)]
    except (psycopg.Error, pymysql.Error):
        return False


@pytest.mark.parametrize("times", [2, 3])
async def test_who_blocks_three_times_in_a_minute_is_locked_out_and_let_in_again(yard, database, times):
    clock, desks = ManualClock(), Desks()
    suspensions = AccountSuspensions(database, Commands(), desks, clock)
    with yard.session(MINE) as mine, yard.session(OTHER) as other:
        for _ in range(times):
            database.offences.add_blocking([MINE])
            clock.advance(29)
            await suspensions.update()
        assert can_connect(yard, OTHER) and other.run("select 1")
        if times == 2:
            assert desks.reported == [] and mine.run("select 1")
            return
        with pytest.raises(RefusedError):
            mine.run("select 1")
    assert desks.reported == [[(MINE, True)]] and not can_connect(yard)
    # The gateway is killed meanwhile, and the next one lets the robot in again.
    after = AccountSuspensions(database, Commands(), desks, clock)
    await after.restore()
    clock.advance(link_supervision.FIRST_S - 1)
    await after.update()
    assert desks.reported[1:] == [[(MINE, True)]] and not can_connect(yard)
    clock.advance(2)
    await after.update()
    assert desks.reported[2:] == [[]] and can_connect(yard)
    assert await database.read(blocking_sessions.stored_suspensions) == {}


async def test_an_account_is_locked_out_while_a_command_waits_for_its_rows(yard, database):
    waits, over = threading.Event(), threading.Event()

    def work(_connection):
        waits.set()
        assert over.wait(60)

    suspensions = AccountSuspensions(database, Commands(), Desks(), ManualClock())
    waiting = asyncio.create_task(database.run(work))
    try:
        assert await asyncio.to_thread(waits.wait, 60)
        database.offences.add_blocking([MINE] * 3)
        async with asyncio.timeout(30):
            await suspensions.update()
        assert not can_connect(yard) and not waiting.done()
    finally:
        over.set()
        await waiting


async def test_who_does_it_again_is_locked_out_for_twice_as_long(yard, database):
    clock, desks = ManualClock(), Desks()
    suspensions = AccountSuspensions(database, Commands(), desks, clock)
    for seconds in (60, 120, 240):
        database.offences.add_blocking([MINE] * 3)
        await suspensions.update()
        (one,) = suspensions.report().robots
        assert one.until == clock.wall + seconds
        clock.advance(seconds)
        await suspensions.update()
        assert suspensions.report().robots == [] and can_connect(yard)


async def test_the_next_gateway_to_lead_unlocks_what_the_former_one_has_locked(yard, database):
    clock, desks = ManualClock(), Desks()
    former, following = (AccountSuspensions(database, Commands(), at, clock) for at in (Desks(), desks))
    await following.follow()
    database.offences.add_blocking([MINE] * 3)
    await former.update()
    await following.follow()
    await following.follow()
    assert desks.reported == [[(MINE, True)]] and not can_connect(yard)
    # The former one is killed.
    clock.advance(61)
    await following.follow()
    await following.update()
    assert desks.reported[1:] == [[]] and can_connect(yard)


async def test_no_account_is_locked_while_its_robot_awaits_an_abort(yard, database):
    clock, desks, commands = ManualClock(), Desks(), Commands()
    suspensions = AccountSuspensions(database, commands, desks, clock)
    database.offences.add_blocking([MINE] * 3)
    await suspensions.update()
    assert not can_connect(yard)
    commands.awaiting.add(MINE)
    await suspensions.update()
    assert can_connect(yard) and suspensions.report().robots == []
    database.offences.add_blocking([MINE] * 3)
    await suspensions.update()
    assert can_connect(yard)
    commands.awaiting.clear()
    database.offences.add_blocking([MINE] * 3)
    await suspensions.update()
    assert not can_connect(yard)


async def test_a_gateway_that_dies_before_the_lock_is_set_unlocks_all_the_same(yard, database):
    clock, desks = ManualClock(), Desks()
    await database.run(blocking_sessions.store_suspensions, {MINE: (clock.wall + 60, "blocks")})
    suspensions = AccountSuspensions(database, Commands(), desks, clock)
    await suspensions.restore()
    clock.advance(61)
    await suspensions.update()
    assert desks.reported == [[(MINE, True)], []] and can_connect(yard)


async def test_nobody_but_a_robot_of_this_database_is_locked_out(yard, database):
    for name in (GATEWAY, "postgres", "root", "nobody'; --", "nobody\"'"):
        await database.run_aside(blocking_sessions.set_suspended, name, True)
    assert can_connect(yard, GATEWAY) and can_connect(yard) and can_connect(yard, "admin")
    for session in (yard.of(MINE), yard.of(OTHER)):
        call = (
            "select for_robots.suspend_robot"
            if yard.kind == "postgresql"
            else f"call {yard.name}.suspend_robot"
        )
        with pytest.raises(RefusedError):
            session.run(f"{call}('{OTHER}', true)")


async def test_who_only_reads_for_long_is_no_blocker(yard, database):
    isolation = "serializable" if yard.kind == "postgresql" else "repeatable read"
    with yard.session(MINE) as reads, yard.session(OTHER) as writes:
        for session in (reads, writes):
            session.run(
                f"set session {'characteristics as ' if yard.kind == 'postgresql' else ''}"
                f"transaction isolation level {isolation}"
            )
            session.run("begin")
        reads.run("select * from sa")
        writes.run("delete from sa")
        time.sleep(2.1)
        assert await database.read(blocking_sessions.blocking_robots, 1) == [OTHER]


async def test_an_older_set_up_is_said_and_an_upgrade_mends_it(yard, database, caplog):
    routine = "function for_robots.suspend_robot" if yard.kind == "postgresql" else "procedure suspend_robot"
    comment = {
        "postgresql": "comment on schema for_robots is '{}'",
        "mariadb": f"alter database {yard.side} comment '{{}}'",
    }[yard.kind]
    yard.sql(f"drop {routine}")
    yard.sql(comment.format("robots'' side of the fleet, version 1"))
    clock, desks = ManualClock(), Desks()
    suspensions = AccountSuspensions(database, Commands(), desks, clock)
    database.offences.add_blocking([MINE] * 3)
    await suspensions.update()
    assert desks.reported == [[(MINE, False)]] and can_connect(yard)
    assert "cannot be locked: have an administrator run: robot-bridge database upgrade" in caplog.text
    await asyncio.to_thread(
        run_once, yard.admin, lambda connection: role_manager_on(connection).renew_rights()
    )
    assert await database.run_aside(blocking_sessions.set_suspended, MINE, True)
    assert not can_connect(yard)


def attacked(yard, over):
    """Do what keeps the others waiting, again after each connection that is lost, until it is ``over``."""
    url = sqlalchemy.make_url(yard.address(MINE))
    where = {"host": url.host, "port": url.port, "user": url.username, "password": url.password}
    while not over.is_set():
        try:
            if yard.kind == "postgresql":
                with psycopg.connect(**where, dbname=url.database, autocommit=True) as connection:
                    while not over.is_set():
                        connection.execute(FLOOD)
            else:
                with contextlib.closing(pymysql.connect(**where, database=url.database)) as connection:
                    cursor = connection.cursor()
                    cursor.execute("set session transaction isolation level serializable")
                    cursor.execute("delete from sa")
                    while not over.wait(0.02):
                        cursor.execute("select 1")
        except (psycopg.Error, pymysql.Error):
            over.wait(0.02)


def test_operators_are_told_who_it_is_and_send_as_before(yard, sample_site, tmp_path):
    yard.empty()
    yard.sql(f"insert into sa (robot, op) values ('{MINE}', 'Start')")
    over = threading.Event()
    attackers = [threading.Thread(target=attacked, args=(yard, over)) for _ in range(3)]
    with Processes(tmp_path / "logs") as processes:
        bridge = Bridge(processes, sample_site, yard.address(GATEWAY))
        bridge.start_gateway()
        try:
            bridge.robot("on-websocket").plug_in(1)
            desk = bridge.desk()
            yard.of(OTHER).run("""insert into rr (op, params) values ('Ready', '{"magic": 1}')""")
            wait_until(lambda: yard.of(OTHER).run("select 1 from sa where op = 'OpAck'"))
            for attacker in attackers:
                attacker.start()
            took = []

            def send():
                # Its answers come to lie beside the rows that are locked.
                with contextlib.suppress(RefusedError):
                    yard.of(OTHER).run("delete from sa")
                    yard.of(OTHER).run("insert into rr (op) values ('GetPath')")
                began = time.monotonic()
                place = {"x": 20.0 + len(took) % 50, "y": 50.0}
                desk.send(str(uuid.uuid4()), "on-websocket", "SetPosEnd", **place)
                took.append(time.monotonic() - began)
                return desk.suspended

            wait_until(send, 20)
            assert [one["robot"] for one in desk.suspended] == [MINE]
            assert desk.suspended[0]["until"] > time.time()
            assert not can_connect(yard)
            took.clear()
            for _ in range(20):
                send()
            # On a machine four times as slow; without the lock it is more than a second on MariaDB.
            assert statistics.median(took) < 0.4
            bob = bridge.desk("Bob")
            assert bob.until(lambda: bob.suspended)[0]["robot"] == MINE
        finally:
            over.set()
            for attacker in attackers:
                attacker.join()
            bridge.end()
            run_once(yard.admin, unlock)
        assert "Traceback" not in bridge.output()


def unlock(connection):
    with contextlib.suppress(Exception):
        blocking_sessions.store_suspensions(connection, {})
    keeper = role_manager_on(connection)
    keeper._do(
        f'alter role "{MINE}" login'
        if connection.dialect.name == "postgresql"
        else f"alter user '{MINE}'@'%' account unlock"
    )


async def test_a_flood_of_notifications_is_named_and_costs_the_reader_few_looks(postgresql):
    database = Database(postgresql.address(GATEWAY))
    wakeup = database.wakeup(GATEWAY_CHANNEL)
    over = threading.Event()
    attacker = threading.Thread(target=attacked, args=(postgresql, over))
    try:
        await wakeup.enable_notifications()
        await wakeup.wait(found=False)
        attacker.start()
        looks, backends, began = 0, [], time.monotonic()
        while time.monotonic() - began < 1.0 or not backends:
            assert time.monotonic() - began < 60
            await wakeup.enable_notifications()
            await wakeup.wait(found=False)
            looks += 1
            backends += database.offences.drain()[1]
        # One look in 20 ms, but for the first few: it was one for each notification that came.
        assert looks < 80 * (time.monotonic() - began)
        assert await database.read(blocking_sessions.robots_of_backends, backends) == [MINE]
        assert len(backends) == 1
    finally:
        over.set()
        attacker.join()
        await wakeup.close()
        await database.close()
